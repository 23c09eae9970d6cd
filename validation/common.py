"""Small helpers of the validation scripts: rows to CSV, a table on the terminal, where results go."""

from __future__ import annotations

import csv
from pathlib import Path

from solidgear.machine.threads import pin

ROOT = Path(__file__).resolve().parent.parent
pin()


def results_folder(name: str) -> Path:
    """Ignored folder for the output of one case."""
    folder = ROOT / "validation" / "results" / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def write_rows(path: Path, rows: list[dict]) -> None:
    """Rows to CSV; columns in order of first appearance."""
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with path.open("w", newline="") as f:
        writer = csv.DictWriter(f, columns)
        writer.writeheader()
        writer.writerows(rows)


def show(title: str, rows: list[dict]) -> None:
    """Print rows as a table."""
    from rich.console import Console
    from rich.table import Table

    table = Table(title=title, title_justify="left")
    columns = list(dict.fromkeys(key for row in rows for key in row))
    for column in columns:
        table.add_column(
            column, justify="right" if column != columns[0] else "left", overflow="fold"
        )
    for row in rows:
        table.add_row(
            *(
                ""
                if row.get(c) is None
                else f"{row[c]:.4g}"
                if isinstance(row[c], float)
                else str(row[c])
                for c in columns
            )
        )
    Console(width=140).print(table)
