"""The page of all keys of a bearing, from the typed models and their docstrings.

    python docs/tools/bearing_keys.py

Writes `docs/guide/bearing_keys.md`.
"""

from __future__ import annotations

from pathlib import Path

from solidgear.bearings.catalogue import Catalogue
from solidgear.core.scene.stations import Bearing
from solidgear.core.scene.typed import Model
from solidgear.show.schema.tables import of_model
from solidgear.show.schema.units import words_on_unit

PAGE = Path(__file__).parent.parent / "guide" / "bearing_keys.md"
TABLES: dict[str, type[Model]] = {"`[[bearing]]`": Bearing, "`[bearing.catalogue]`": Catalogue}
HEAD = """# All keys of a bearing

Plain numbers are SI; a text may have any unit. A dash is a key without default: needed, or \
[worked out](bearings.md). `arrangement` of two bearings stands [above all tables](arrangements.md). \
Made by `docs/tools/bearing_keys.py` from the typed models.
"""


def rows(model: type[Model]) -> list[tuple[str, ...]]:
    """Keys, unit, default and meaning of every entry; keys with one meaning share a row."""
    out: dict[tuple[str, ...], list[str]] = {}
    for key, node in of_model(model)["properties"].items():
        unit, default = node.get("x-unit", ""), str(node.get("default", "-"))
        meaning = node["description"].removesuffix(words_on_unit(unit)).strip()
        out.setdefault((unit, default, meaning), []).append(f"`{key}`")
    return [(", ".join(keys), *rest) for rest, keys in out.items()]


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
