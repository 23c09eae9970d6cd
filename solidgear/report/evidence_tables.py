"""Tables of the evidence: deviations, causes, attachments, bands, algebraic checks, paired modes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from solidgear.report.cells import DASH, capital, eng, mm, pct, short_percent, small, whole_number
from solidgear.report.table import Table
from solidgear.report.words import (
    band_percent,
    engineering,
    hertz,
    is_beam,
    is_number,
    is_resolved,
    model_name,
)

#: rank of a frequency among the quantities
FREQUENCY = 2
#: whether a difference is within the tolerance -> cell
INSIDE = {True: ("yes", "good"), False: ("no", "bad"), None: DASH}
#: what an attachment changes -> how it is written
TIED: dict[str, Callable[..., str]] = {
    "c_zz": engineering,
    "k_zz": engineering,
    "bending_1_hz": hertz,
}


def _unit(quantity: str) -> str:
    return "Hz" if not quantity.startswith(("C_", "K_")) else ""


def _rank(quantity: str) -> int:
    """Compliances first, then stiffnesses, then frequencies."""
    if quantity.startswith("C_"):
        return 0
    return 1 if quantity.startswith("K_") else FREQUENCY


def deviations(r: Mapping) -> list[Table]:
    """One table for each (model, attachment), compliances first."""
    tolerance = r["verdict"].get("tolerance")
    groups: dict[tuple, list] = {}
    for row in r.get("deviations") or []:
        group = row.get("model"), row.get("reference"), row.get("attachment")
        groups.setdefault(group, []).append(row)
    tables = []
    for (model, reference, attachment), rows in groups.items():
        head = [
            "quantity",
            "unit",
            model_name(model),
            model_name(reference),
            "difference",
            "band",
            "resolved?",
            f"within {short_percent(tolerance) or 'tolerance'}",
        ]
        ties = _ties(model, attachment)
        caption = f"{capital(model_name(model))} against {model_name(reference)}, {ties}"
        table = Table(caption, head)
        for row in sorted(rows, key=lambda q: _rank(str(q.get("quantity", "")))):
            table.rows.append(_deviation(row, tolerance))
        tables.append(table)
    return tables


def _ties(model: str, attachment: str) -> str:
    """How two models were held when they were compared."""
    if attachment == "as scene":
        return "attachments as in the scene"
    like = ", like for like" if attachment == "section" and is_beam(model) else ""
    return f"{attachment} ties on both sides{like}"


def _deviation(row: Mapping, tolerance: Any) -> list:
    """The cells of one quantity."""
    quantity = str(row.get("quantity", ""))
    figure = hertz if _rank(quantity) == FREQUENCY else engineering
    resolved = ("not resolved", "word text unresolved")
    if is_resolved(row):
        resolved = (str(row.get("verdict") or "resolved"), "word text")
    inside = None
    if is_number(row.get("relative")) and is_number(tolerance):
        inside = abs(row["relative"]) <= tolerance
    return [
        quantity,
        (str(row.get("unit") or _unit(quantity)), "word text"),
        figure(row.get("value"), nothing=DASH),
        figure(row.get("reference_value"), nothing=DASH),
        pct(row.get("relative")),
        pct(row.get("band"), signed=False),
        resolved,
        INSIDE[inside],
    ]


def causes(r: Mapping) -> Table:
    """What each assumption alone changes."""
    rows = []
    for c in r.get("causes") or []:
        model = c.get("model")
        rows.append(
            [
                str(c.get("cause", "")),
                (str(c.get("change", "")), "text"),
                (model if model == "beam" else model_name(model), "text"),
                *(pct(c.get(q)) for q in ("c_zz", "k_zz", "bending_1")),
            ]
        )
    return Table(
        "One assumption switched at a time",
        ["cause", "what is switched", "in", "C_zz", "K_zz", "first bending"],
        rows,
    )


def attachments(r: Mapping) -> Table:
    """What the way of holding the seats changes."""
    rows = []
    for key, ties in (r.get("attachments") or {}).items():
        average = (ties or {}).get("average") or {}
        for tie, v in (ties or {}).items():
            if not v:
                continue
            cells: list[Any] = [f"{capital(model_name(key))}, {tie}"]
            for name, figure in TIED.items():
                value, base = v.get(name), average.get(name)
                comparable = is_number(value) and is_number(base) and base
                cells.append(figure(value, nothing=DASH))
                cells.append(pct(value / base - 1) if comparable else DASH)
            rows.append(cells)
    return Table(
        "Three ways to hold the same surfaces",
        [
            "model, ties",
            "C_zz, m/N",
            "against average",
            "K_zz, N/m",
            "against average",
            "first bending, Hz",
            "against average",
        ],
        rows,
    )


def levels(r: Mapping) -> Table:
    """The meshes that the bands come from."""
    rows = []
    for key, model in r["models"].items():
        for n, v in enumerate((model.get("convergence") or {}).get("levels") or [], start=1):
            rows.append(
                [
                    f"{capital(model_name(key))}, {n}",
                    whole_number(v.get("dofs")),
                    mm(v.get("h")),
                    str(v.get("order") or DASH),
                    eng(v.get("c_zz"), 7),
                    f"{v['bending_1_hz']:.3f}" if is_number(v.get("bending_1_hz")) else DASH,
                ]
            )
    return Table(
        "The discretisations",
        [
            "model",
            "degrees of freedom",
            "element size h, mm",
            "element order",
            "C_zz, m/N",
            "first bending, Hz",
        ],
        rows,
    )


def orders(r: Mapping) -> Table:
    """Changes from mesh to mesh, and the bands made of them."""
    rows = []
    for key, model in r["models"].items():
        for name, e in (model.get("convergence") or {}).items():
            if name == "levels" or not e:
                continue
            stiff = name.startswith(("c_", "k_"))
            label = capital(name) if stiff else f"{name.replace('_', ' ')}, Hz"
            observed, expected = e.get("observed_order"), e.get("expected_order")
            both = is_number(observed) and is_number(expected)
            rows.append(
                [
                    f"{capital(model_name(key))}: {label}",
                    (str(e.get("method") or DASH), "word text"),
                    pct(e.get("change"), signed=False),
                    small(e.get("reduction")),
                    f"{observed:.2f} of {expected:.2f}" if both else DASH,
                    str(e.get("factor") or DASH),
                    pct(e.get("solver"), signed=False),
                    band_percent(e.get("gci"), DASH),
                ]
            )
    return Table(
        "Changes and bands",
        [
            "quantity",
            "band from",
            "last change",
            "over the one before",
            "order observed, expected",
            "factor",
            "of the solver",
            "band",
        ],
        rows,
        "Layers: every mesh adds layers towards corners as well as order or cells, so errors shrink by a nearly fixed share; the factor is measured on random shafts. "
        "A coupling's numbers are shares of the geometric mean of its two diagonal entries.",
    )


def algebra(r: Mapping) -> Table:
    """Residuals and counts that need no second mesh."""
    names = {
        "asymmetry": "asymmetry of the flexibility",
        "rigid_residual": "rigid motion, residual",
        "modal_residual": "modes, residual",
        "orthogonality": "modes, M-orthogonality",
        "rigid_modes": "rigid modes found",
    }
    rows = []
    for key, model in r["models"].items():
        evidence = model.get("evidence")
        if evidence:
            figures = [small(evidence.get(name)) for name in names]
            rows.append([capital(model_name(key)), *figures, *_counted(evidence)])
    return Table(
        "Algebraic checks of this run (relative; the smaller the better, but for the counts)",
        ["model", *names.values(), "eigensolver", "no mode missed below, Hz"],
        rows,
        "No mode missed: as many eigenvalues lie below as were found, by the inertia of a second factor (Sylvester).",
    )


def _counted(e: Mapping) -> list:
    """Eigensolver, and the frequency up to which the inertia of a factor confirms that every mode
    was found.
    """
    parts = e.get("mode_count") or []
    sure = parts and all(p.get("checked") for p in parts)
    below = f"{min(p['below_hz'] for p in parts):.0f}" if sure else "not counted"
    return [(str(e.get("eigensolver") or DASH), "text"), below]


def pairs(r: Mapping) -> list[Table]:
    """One table for each model, its modes beside those of the reference."""
    mac = r.get("mac") or {}
    reference = model_name(mac.get("reference"))
    tables = []
    for key, m in (mac.get("models") or {}).items():
        rows = [_pair(p) for p in m.get("pairs") or []]
        caption = f"{capital(model_name(key))}: modes and their partners in the {reference}"
        head = ["mode", "partner", "MAC", "frequency, Hz", f"{reference}, Hz", "difference"]
        if rows:
            tables.append(Table(caption, head, rows))
    return tables


def _pair(p: Mapping) -> list:
    """The cells of one mode and its partner."""
    return [
        str(p.get("mode", "")),
        (str(p.get("partner") or "none"), "text"),
        f"{p['mac']:.4f}" if is_number(p.get("mac")) else DASH,
        hertz(p.get("frequency_hz"), DASH),
        hertz(p.get("reference_hz"), DASH),
        pct(p.get("relative")),
    ]
