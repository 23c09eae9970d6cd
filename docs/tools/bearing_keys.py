"""The page of all keys of a bearing, from the typed models and their docstrings.

    python docs/tools/bearing_keys.py

Writes `docs/guide/bearing_keys.md`.
"""

from __future__ import annotations

import inspect
import re
from pathlib import Path

from solidgear.bearings.catalogue import Catalogue
from solidgear.core.scene.stations import Bearing
from solidgear.core.scene.typed import Model

PAGE = Path(__file__).parent.parent / "guide" / "bearing_keys.md"
#: SI units by the types of the models
UNITS = {
    "Position": "m",
    "PositiveLength": "m",
    "Length": "m",
    "Angle": "rad",
    "PositiveLoad": "N",
    "AxialSpring": "N/m",
    "Speed": "rad/s",
    "TemperatureRise": "K",
}
#: fields that a file calls otherwise
IN_A_FILE = {"y": "position"}
TABLES: dict[str, type[Model]] = {"`[[bearing]]`": Bearing, "`[bearing.catalogue]`": Catalogue}
HEAD = """# All keys of a bearing

Plain numbers are SI; a text may have any unit. A dash is a key without default: needed, or \
[worked out](bearings.md). `arrangement` of two bearings stands [above all tables](arrangements.md). \
Made by `docs/tools/bearing_keys.py` from the typed models.
"""


def meanings(model: type[Model]) -> dict[str, str]:
    """Attributes of a docstring: one text each, its lines joined; several names share one."""
    text = inspect.cleandoc(model.__doc__ or "").split("Attributes\n----------\n")[1]
    text = re.split(r"\n\n\w+\n-+\n", text)[0]
    found: dict[str, str] = {}
    entry = r"^(\S[^:\n]*?)(?: : [^\n]*)?$\n?((?:^    [^\n]*\n?)*)"
    for names, lines in re.findall(entry, text, re.MULTILINE):
        for name in names.split(", "):
            found[name] = " ".join(lines.split())
    return found


def rows(model: type[Model]) -> list[tuple[str, ...]]:
    """Keys, unit, default and meaning of every entry; fields with one meaning share a row."""
    out: dict[str, list[str]] = {}
    for name, meaning in meanings(model).items():
        field, words = model.model_fields[name], re.findall(r"\w+", model.__annotations__[name])
        unit = next((UNITS[word] for word in words if word in UNITS), "")
        default = "-" if field.is_required() or field.default in (None, "", ()) else field.default
        row = out.setdefault(f"{unit} | {default} | {meaning.replace('``', '`')}", [])
        row.append(f"`{IN_A_FILE.get(name, name)}`")
    return [(", ".join(keys), *rest.split(" | ", 2)) for rest, keys in out.items()]


def page() -> str:
    """The page as it has to be."""
    parts = [HEAD]
    for title, model in TABLES.items():
        lines = [" | ".join(row) for row in rows(model)]
        table = ["| key | unit | default | meaning |", "| --- | --- | --- | --- |"]
        parts.append("\n".join([f"## {title}\n", *table, *(f"| {line} |" for line in lines), ""]))
    return "\n".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page())
