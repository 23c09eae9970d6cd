"""Tables of the lumped models for the report, where a scene asks for them."""

from __future__ import annotations

from collections.abc import Callable

from solidgear.core import Record
from solidgear.core.judge.record import LumpedRecord, LumpedVariant
from solidgear.show.reading import entry, model_name
from solidgear.show.table import Column, Table, text
from solidgear.show.words import DASH, engineering, hertz, percent

#: a method and what it made
Item = tuple[str, LumpedVariant]


def lumped_tables(record: Record) -> list[Table]:
    """Return first bending side by side and one table of synthesis per body, where the scene asks
    for it.
    """
    lumped = {key: synthesis for key, synthesis in record.lumped.items() if synthesis.variants}
    if not lumped or not (record.scene.get("ask") or {}).get("lumped"):
        return []
    methods = list(next(iter(lumped.values())).variants)
    columns = [
        Column("source", lambda item: f"from the {model_name(record, item[0])}"),
        Column("body itself", lambda item: item[1].frequency_hz, hertz),
        *(_method(method) for method in methods),
    ]
    title = "First bending, Hz: each body and the lumped models made from it"
    details = [_detail(model_name(record, key), synthesis) for key, synthesis in lumped.items()]
    return [Table(title, columns, list(lumped.items())), *details]


def _method(name: str) -> Column:
    return Column(name, lambda item: _first(item[1].variants.get(name)))


def _first(variant: LumpedVariant | None) -> str:
    """Return the first bending of a variant, and its error."""
    if variant is None or not variant.feasible:
        return "no solution"
    text = hertz(variant.frequency_hz)
    if variant.frequency_error is None:
        return text
    return f"{text} ({percent(variant.frequency_error)})"


def _detail(name: str, synthesis: LumpedRecord) -> Table:
    """Return the synthesis from one body, a method a row."""

    def mass(i: int, j: int) -> Callable[[Item], float | None]:
        return lambda item: entry(item[1].mass, i, j)

    columns = [
        Column("mass matrix", lambda item: item[0]),
        Column("M, kg", mass(0, 0), engineering),
        Column("I, kg m²", mass(1, 1), engineering),
        Column("coupling, kg m", mass(0, 1), engineering),
        Column("slope phi/z", lambda item: item[1].slope_error, percent),
        Column("kinetic energy", lambda item: item[1].kinetic_error, percent),
        Column("valid to, Hz", lambda item: item[1].valid_to_hz, hertz),
        text("verdict", lambda item: item[1].verdict),
    ]
    share = DASH if synthesis.static_share is None else f"{synthesis.static_share:.4f}"
    return Table(
        f"Lumped from the {name}: slope and kinetic energy against its first bending mode",
        columns,
        list(synthesis.variants.items()),
        "Strain energy of the static shape with the mode's lumped-point motion, as a share of the "
        f"mode's: {share}; equations 52 and 53 need exactly 1.",
    )
