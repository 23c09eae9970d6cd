"""What validation scripts share: tables to the terminal, to pages and to CSV, and results with
what they were made with.
"""

from __future__ import annotations

import csv
import json
import math
import os
import platform
import subprocess
from collections.abc import Iterable, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from solidgear.core.machine.environment import environment
from solidgear.core.machine.threads import pin

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "validation" / "results"
#: letters of a row on one line at most
LINE = 1500
pin()


def results_folder(name: str) -> Path:
    """Ignored folder for the output of one case."""
    folder = RESULTS / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def read_result(name: str) -> dict[str, Any]:
    """What `kept` wrote; nothing where there is none."""
    path = RESULTS / f"{name}.json"
    return json.loads(path.read_text()) if path.exists() else {}


def kept(name: str, records: dict[str, Any]) -> None:
    """Records by key to `validation/results/NAME.json`; those of other keys stay there.

    Numbers of numpy become those of Python, and those that are not finite become nothing.
    """
    path = RESULTS / f"{name}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    records = read_result(name) | plain(records)
    path.write_text(by_lines(records) + "\n", encoding="utf-8")


def by_lines(value: Any, before: str = "") -> str:
    """JSON with a row of a table, or a list of numbers, on one line.

    Examples
    --------
    >>> print(by_lines({"rows": [{"hz": 1.0, "parts": [2, 3]}, {"hz": 4.0, "parts": []}]}))
    {
     "rows": [
      {"hz": 1.0, "parts": [2, 3]},
      {"hz": 4.0, "parts": []}
     ]
    }
    """
    line = json.dumps(value, ensure_ascii=False, allow_nan=False)
    inner = value.values() if isinstance(value, dict) else value
    if not isinstance(value, dict | list) or not any(isinstance(v, dict | list) for v in inner):
        return line
    if len(line) <= LINE and "{" not in line[1:]:
        return line
    more = before + " "
    if isinstance(value, dict):
        rows = [
            f"{json.dumps(k, ensure_ascii=False)}: {by_lines(v, more)}" for k, v in value.items()
        ]
    else:
        rows = [by_lines(v, more) for v in value]
    begin, end = "{}" if isinstance(value, dict) else "[]"
    return f"{begin}\n{more}" + f",\n{more}".join(rows) + f"\n{before}{end}"


def plain(value: Any) -> Any:
    """What JSON can hold of a value."""
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if value is None or isinstance(value, str | bool | int):
        return value
    number = float(value)
    return number if math.isfinite(number) else None


def toml(value: Any) -> str:
    """A value as a file of a scene has it; tables are inline."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(own)}" for key, own in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def stamp() -> dict[str, Any]:
    """Date, commit and machine of a result; a changed source is marked with a plus."""
    machine = environment() | {
        "mkl": _version("mkl"),
        "system": _system(),
        "memory_gb": _memory_gb(),
    }
    commit = _git("describe", "--always", "--exclude=*")
    # results that a run writes as it goes on are no change of the source
    changed = _git("status", "--porcelain", "-uno", "--", ".", ":(exclude)validation/results")
    return {"date": machine.pop("date"), "commit": commit + "+" * bool(changed), "machine": machine}


def _git(*words: str) -> str:
    """Return what git prints of this checkout; empty where there is none."""
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip()


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _system() -> str:
    """Return the operating system by name and release."""
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except (OSError, KeyError):
        return f"{platform.system()} {platform.release()}"


def _memory_gb() -> float:
    """Return the memory of the machine, GB."""
    return round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9, 1)


def write_rows(path: Path, rows: list[dict]) -> None:
    """Rows to CSV; columns in order of first appearance."""
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with path.open("w", newline="") as f:
        writer = csv.DictWriter(f, columns)
        writer.writeheader()
        writer.writerows(rows)


def markdown(head: Sequence[str], rows: Iterable[Sequence[object]]) -> list[str]:
    """Lines of a table for a page."""
    lines = [head, ["---"] * len(head), *rows]
    return ["| " + " | ".join(map(str, cells)).rstrip() + " |" for cells in lines]


def show(title: str, rows: list[dict]) -> None:
    """Print rows as a table."""
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    table = Table(title=title, title_justify="left")
    columns = list(
        dict.fromkeys(key for row in rows for key, v in row.items() if v not in (None, ""))
    )
    for column in columns:
        justify = "right" if column != columns[0] else "left"
        table.add_column(column, justify=justify, overflow="fold")
    for row in rows:
        table.add_row(*(escape(_cell(row.get(column))) for column in columns))
    Console(width=140).print(table)


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)
