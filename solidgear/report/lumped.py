"""Tables of the lumped models for the report, where a scene asks for them."""

from __future__ import annotations

from solidgear.judge.record import LumpedRecord, LumpedVariant, Record
from solidgear.report.cells import DASH
from solidgear.report.reading import entry, model_name
from solidgear.report.table import Table
from solidgear.report.words import engineering, hertz, percent


def lumped_tables(record: Record) -> list[Table]:
    """One table of first bending side by side, one of the synthesis in detail per body; none where
    the scene does not ask for lumped synthesis.
    """
    lumped = {key: found for key, found in record.lumped.items() if found.variants}
    if not lumped or not (record.scene.get("ask") or {}).get("lumped"):
        return []
    methods = list(next(iter(lumped.values())).variants)
    rows = []
    for key, found in lumped.items():
        cells = [_first(found.variants.get(method)) for method in methods]
        rows.append([f"from the {model_name(record, key)}", hertz(found.frequency_hz), *cells])
    out = [
        Table(
            "First bending, Hz: each body and the lumped models made from it",
            ["source", "body itself", *methods],
            rows,
        )
    ]
    for key, found in lumped.items():
        out.append(_detail(model_name(record, key), found))
    return out


def _first(variant: LumpedVariant | None) -> str:
    """First bending of a variant, and its error."""
    if variant is None or not variant.feasible:
        return "no solution"
    text = hertz(variant.frequency_hz)
    if variant.frequency_error is None:
        return text
    return f"{text} ({percent(variant.frequency_error)})"


def _detail(name: str, found: LumpedRecord) -> Table:
    """The synthesis from one body, a method a row."""
    rows = []
    for method, variant in found.variants.items():
        mass = [entry(variant.mass, i, j) for i, j in ((0, 0), (1, 1), (0, 1))]
        rows.append(
            [
                method,
                *(engineering(value, nothing=DASH) for value in mass),
                percent(variant.slope_error, nothing=DASH),
                percent(variant.kinetic_error, nothing=DASH),
                hertz(variant.valid_to_hz, DASH),
                (variant.verdict, "text"),
            ]
        )
    share = DASH if found.static_share is None else f"{found.static_share:.4f}"
    note = (
        "Share of the mode's strain energy that a static shape with the same lumped-point motion "
        f"holds: {share}; equations 52 and 53 need exactly 1."
    )
    head = [
        "mass matrix",
        "M, kg",
        "I, kg m\u00b2",
        "coupling, kg m",
        "slope phi/z",
        "kinetic energy",
        "valid to, Hz",
        "verdict",
    ]
    return Table(
        f"Lumped from the {name}: slope and kinetic energy against its first bending mode",
        head,
        rows,
        note,
    )
