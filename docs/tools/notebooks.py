"""Run the code of notebooks without Jupyter, and store what it shows.

    python docs/tools/notebooks.py examples/notebooks/*.ipynb             # do they still show it?
    python docs/tools/notebooks.py --write examples/notebooks/*.ipynb     # store it anew

A cell shows what it prints, and the value of its last expression as a notebook would: text, a table
in HTML, a figure as PNG.  Cells run in the folder of the notebook, in one name space.
"""

from __future__ import annotations

import argparse
import ast
import base64
import contextlib
import io
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import console
from PIL import Image

DPI = 70


def read(path: Path) -> dict[str, Any]:
    """A notebook of format 4."""
    return json.loads(path.read_text(encoding="utf-8"))


def code_cells(book: dict[str, Any]) -> list[dict[str, Any]]:
    """Its cells of code, in order."""
    return [cell for cell in book["cells"] if cell["cell_type"] == "code"]


def run(
    book: dict[str, Any], folder: Path
) -> Iterator[tuple[dict[str, Any], list[dict[str, Any]]]]:
    """Run all cells.

    Parameters
    ----------
    book : dict
    folder : Path
        Where the cells run; files that they name are looked for there.

    Yields
    ------
    cell : dict
        A cell of code.
    outputs : list of dict
        What it shows, as a notebook stores it.

    Raises
    ------
    Exception
        Whatever a cell raises, with a note of the cell.
    """
    names: dict[str, Any] = {"__name__": "__main__"}
    before = Path.cwd()
    os.chdir(folder)
    try:
        for number, cell in enumerate(code_cells(book), 1):
            try:
                yield cell, _outputs("".join(cell["source"]), names, number)
            except Exception as error:
                error.add_note(f"in cell {number}:\n{''.join(cell['source'])}")
                raise
    finally:
        os.chdir(before)


def _outputs(source: str, names: dict[str, Any], number: int) -> list[dict[str, Any]]:
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    quiet = source.rstrip().endswith(";")
    said, value = io.StringIO(), None
    with contextlib.redirect_stdout(said):
        exec(compile(tree, f"<cell {number}>", "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), f"<cell {number}>", "eval"), names)
    out: list[dict[str, Any]] = []
    if said.getvalue():
        out.append({"name": "stdout", "output_type": "stream", "text": _lines(said.getvalue())})
    if value is not None and not quiet:
        result = {"data": _data(value), "execution_count": number, "metadata": {}}
        out.append({**result, "output_type": "execute_result"})
    return out


def _data(value: Any) -> dict[str, Any]:
    """A value in the forms that it has."""
    if hasattr(value, "savefig"):
        picture = io.BytesIO()
        value.savefig(picture, format="png", dpi=DPI)
        return {
            "image/png": base64.b64encode(picture.getvalue()).decode(),
            "text/plain": ["<Figure>"],
        }
    if hasattr(value, "_repr_png_"):
        # in few colours and a size that a page shows, a tenth of the bytes
        with Image.open(io.BytesIO(value._repr_png_())) as drawn:
            small = drawn.convert("RGB").reduce(2).quantize(64)
        picture = io.BytesIO()
        small.save(picture, format="png", optimize=True)
        pixels = base64.b64encode(picture.getvalue()).decode()
        return {"image/png": pixels, "text/plain": _lines(repr(value))}
    data: dict[str, Any] = {"text/plain": _lines(repr(value))}
    if hasattr(value, "_repr_html_"):
        data["text/html"] = _lines(value._repr_html_())
    return data


def _lines(text: str) -> list[str]:
    return text.splitlines(keepends=True)


def shown(outputs: list[dict[str, Any]]) -> str:
    """The text of what a cell shows."""
    parts = [o["text"] if "text" in o else o["data"]["text/plain"] for o in outputs]
    return "".join(line for part in parts for line in part)


def pictures(outputs: list[dict[str, Any]]) -> int:
    """How many pictures a cell shows."""
    return sum("image/png" in o.get("data", {}) for o in outputs)


def check(path: Path) -> list[str]:
    """What a notebook no longer shows, one sentence a cell; see :func:`console.same` for what makes
    a difference.
    """
    told = []
    for number, (cell, outputs) in enumerate(run(read(path), path.parent), 1):
        was = cell["outputs"]
        if pictures(was) != pictures(outputs):
            told.append(f"{path.name}, cell {number}: {pictures(outputs)} pictures")
        difference = console.same(shown(was), shown(outputs))
        if difference:
            told.append(f"{path.name}, cell {number}: {difference}")
    return told


def write(path: Path) -> None:
    """Run a notebook and store what it shows."""
    book = read(path)
    for number, (cell, outputs) in enumerate(run(book, path.parent), 1):
        cell["outputs"], cell["execution_count"] = outputs, number
    text = json.dumps(book, indent=1, ensure_ascii=False, sort_keys=True)
    path.write_text(text + "\n", encoding="utf-8")


def main() -> int:
    """Write, or tell what differs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("notebooks", nargs="+", type=Path)
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    told = []
    for path in asked.notebooks:
        told += [] if asked.write else check(path.resolve())
        if asked.write:
            write(path.resolve())
    print("\n".join(told) or f"{len(asked.notebooks)} notebooks")
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main())
