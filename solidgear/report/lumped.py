"""Tables of the lumped models for the report."""

from __future__ import annotations

from collections.abc import Mapping

from solidgear.report.table import Table
from solidgear.report.words import (
    engineering,
    hertz,
    is_number,
    model_name,
    percent,
)

DASH = "\u2013"


def lumped_tables(results: Mapping) -> list[Table]:
    """One table of first bending side by side, one of the synthesis in detail per body."""
    lumped = {k: v for k, v in (results.get("lumped") or {}).items() if v.get("variants")}
    if not lumped:
        return []
    methods = list(next(iter(lumped.values()))["variants"])
    rows = []
    for key, entry in lumped.items():
        cells = [_first(entry["variants"].get(m) or {}) for m in methods]
        rows.append([f"from the {model_name(key)}", hertz(entry.get("first_bending_hz")), *cells])
    out = [
        Table(
            "First bending, Hz: each body and the lumped models made from it",
            ["source", "body itself", *methods],
            rows,
        )
    ]
    for key, entry in lumped.items():
        out.append(_detail(model_name(key), entry))
    return out


def _first(variant: Mapping) -> str:
    if not variant.get("feasible"):
        return "no solution"
    text = hertz(variant.get("frequency_hz"))
    error = variant.get("frequency_error")
    return f"{text} ({percent(error)})" if is_number(error) else text


def _detail(name: str, entry: Mapping) -> Table:
    rows = []
    for method, v in entry["variants"].items():
        mass = v.get("mass")
        values = [
            engineering(mass[i][j], nothing=DASH) if mass else DASH
            for i, j in ((0, 0), (1, 1), (0, 1))
        ]
        share = [
            percent(v[k]) if is_number(v.get(k)) else DASH for k in ("slope_error", "kinetic_error")
        ]
        rows.append(
            [
                method,
                *values,
                *share,
                hertz(v.get("valid_to_hz")) if is_number(v.get("valid_to_hz")) else DASH,
                (str(v.get("verdict", "")), "text"),
            ]
        )
    note = f"Share of the mode's strain energy that a static shape with the same lumped-point motion holds: {entry['static_share']:.4f}; equations 52 and 53 need exactly 1."
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
