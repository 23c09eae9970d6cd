"""Tables of what was solved: the summary of all models, 6x6 matrices and natural frequencies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.rung import LUMPED
from solidgear.frames import DOF_NAMES
from solidgear.report.cells import DASH, capital, eng, megabytes, pct, whole_number
from solidgear.report.table import Table
from solidgear.report.words import (
    BLOCK_UNITS,
    answer_seconds,
    band_percent,
    entry,
    first_mode,
    headline,
    hertz,
    is_beam,
    is_number,
    is_resolved,
    model_name,
    reference_of,
    seconds,
    validity,
)

#: below this share of the geometric mean of its diagonal entries a coupling is printed faint
FAINT = 1e-6


#: validity -> cell
WORTH = {
    "yes": ("yes", "good"),
    "no": ("no", "bad"),
    "open": ("not judged", "quiet"),
    "unknown": DASH,
}


def summary(r: Mapping) -> Table:
    """Quantities down, models across: four models fit a page, thirteen columns do not."""
    models, reference = r["models"], reference_of(r)

    def row(label, cell):
        return [label, *(cell(k, m) for k, m in models.items())]

    def frequency(family):
        return lambda k, m: hertz((first_mode(m, family) or {}).get("frequency_hz"), DASH)

    def apart(quantity):
        def cell(key, m):
            if key == reference:
                return ("reference", "quiet")
            found = headline(r, key, quantity)
            if found is None:
                return DASH
            difference = pct(found.get("relative"))
            return difference if is_resolved(found) else (f"not resolved ({difference})", "quiet")

        return cell

    def band(name):
        def cell(key, m):
            if m.get("band"):
                return band_percent(m["band"].get(name), DASH)
            return ("none given", "quiet") if is_beam(key) else DASH

        return cell

    rows = [
        row("valid for this scene", lambda k, m: WORTH[validity(m)]),
        row("K_zz, N/m", lambda k, m: eng(entry(m, "stiffness", 2, 2))),
        row("C_zz, m/N", lambda k, m: eng(entry(m, "compliance", 2, 2))),
        row("K_yy, N/m", lambda k, m: eng(entry(m, "stiffness", 1, 1))),
        row("K_thx, N m/rad", lambda k, m: eng(entry(m, "stiffness", 3, 3))),
        row("first bending, Hz", frequency("bending")),
        row("first axial, Hz", frequency("axial")),
        row("first torsion, Hz", frequency("torsion")),
        row("C_zz against reference", apart("C_zz")),
        row("first bending against reference", apart("bending 1")),
        row("band of the worst compliance (mesh)", band("compliance")),
        row("band of first bending (mesh)", band("bending_1")),
        row("degrees of freedom", lambda k, m: whole_number(m.get("dofs"))),
        row("building and solving, s", lambda k, m: seconds(answer_seconds(m), DASH)),
        row("peak memory, MB", lambda k, m: megabytes(m.get("peak_mb"))),
    ]
    note = "Stiffness and compliance with the attachments of the scene. “Against reference” compares beams with section ties on both sides, where they have a like-for-like partner, and solids as the scene has them."
    return Table(
        "Results at the lumped point",
        ["quantity", *(capital(model_name(k)) for k in models)],
        rows if models else [],
        note,
        css="summary",
    )


def matrices(r: Mapping) -> list[tuple[str, list[dict]]]:
    """The matrices of every model; the lumped model stands on those of another model, shown there."""
    out = []
    for key, model in r["models"].items():
        kinds = [kind for kind in BLOCK_UNITS if model.get(kind)]
        if key not in LADDER.of(LUMPED):
            out.append((model_name(key), [_matrix(r, key, model, kind) for kind in kinds]))
    return out


def _matrix(r: Mapping, key: str, model: Mapping, kind: str) -> dict:
    """A 6x6 with a unit over each of its four blocks."""
    free = (r.get("port") or {}).get("free") or []
    values = model[kind]
    rows = []
    for i, name in enumerate(DOF_NAMES):
        cells = []
        for j, other in enumerate(DOF_NAMES):
            value = entry(model, kind, i, j)
            if value is None or name in free or other in free:
                cells.append((DASH, "quiet"))
                continue
            faint = i != j and _is_faint(value, values[i][i], values[j][j])
            cells.append((eng(value), "faint" if faint else ""))
        rows.append((name, cells))
    same, mixed, turn = BLOCK_UNITS[kind]
    return {
        "caption": f"{capital(model_name(key))}: {kind}",
        "names": DOF_NAMES,
        "blocks": [((same, mixed), rows[:3]), ((mixed, turn), rows[3:])],
    }


def _is_faint(coupling: float, first: Any, second: Any) -> bool:
    """Whether a coupling is next to nothing beside its two diagonal entries."""
    if not (is_number(first) and is_number(second)):
        return False
    return abs(coupling) <= FAINT * abs(first * second) ** 0.5


def frequencies(r: Mapping) -> Table:
    """Natural frequencies, a mode a row and a model a column."""
    models, reference = r["models"], reference_of(r)
    by_name = {key: _modes_by_name(model) for key, model in models.items()}
    # a mode stands where the reference has it, else where the first model that has it does
    ordered: dict[str, Mapping] = {}
    for key in sorted(models, key=lambda k: k != reference):
        for name, mode in by_name[key].items():
            ordered.setdefault(name, mode)
    rows = []
    for name, mode in sorted(ordered.items(), key=lambda item: item[1].get("frequency_hz") or 0.0):
        cells: list[Any] = [
            name,
            (mode.get("family", DASH), "word text"),
            str(mode.get("multiplicity") or 1),
        ]
        base = (by_name.get(reference, {}).get(name) or {}).get("frequency_hz")
        for key in models:
            f = (by_name[key].get(name) or {}).get("frequency_hz")
            apart = f" ({pct(f / base - 1)})" if key != reference and is_number(f) and base else ""
            cells.append("0 (rigid)" if f == 0 else hertz(f, DASH) + apart)
        rows.append(cells)
    note = ""
    if reference:
        note = f"In brackets: against the {model_name(reference)}. Two shapes: a pair of the same frequency in two planes. A dash: not among the modes asked for."
    return Table(
        "Natural frequencies in Hz, attachments as in the scene",
        ["mode", "family", "shapes", *(capital(model_name(k)) for k in models)],
        rows,
        note,
    )


def _modes_by_name(model: Mapping) -> dict[str, Mapping]:
    return {str(mode.get("name")): mode for mode in model.get("modes") or []}
