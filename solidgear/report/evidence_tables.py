"""Tables of the evidence: deviations, causes, attachments, bands, algebraic checks, modes."""

from __future__ import annotations

from typing import Any

from solidgear.judge.correlation import FOREIGN
from solidgear.judge.record import (
    BandRecord,
    DeviationRecord,
    EvidenceRecord,
    ModelRecord,
    PartnerRecord,
    Record,
)
from solidgear.judge.ties import SCENE
from solidgear.quantity import (
    C_ZZ,
    COMPLIANCE,
    FIRST_BENDING,
    FREQUENCY,
    K_ZZ,
    STIFFNESS,
    Quantity,
)
from solidgear.report.cells import DASH, capital, pct, short_percent, small, whole_number
from solidgear.report.reading import is_resolved, model_name, reference_of, relative_change
from solidgear.report.table import Table
from solidgear.report.units import ENGINEERING, Units
from solidgear.report.words import band_percent, hertz

#: quantities shown of causes and attachments -> how a column calls them
SHOWN = {C_ZZ: C_ZZ, K_ZZ: K_ZZ, FIRST_BENDING: "first bending"}
#: the order of the kinds of quantities
RANKS = (COMPLIANCE, STIFFNESS, FREQUENCY)


def _named(record: Record, key: str) -> str:
    """The name of a model at the beginning of a cell."""
    return capital(model_name(record, key))


def deviations(record: Record, units: Units = ENGINEERING) -> Table:
    """All models against the reference, a quantity a row: as the scene is tied, and like for like."""
    reference, tolerance = reference_of(record), record.verdict.tolerance
    pairs = list(dict.fromkeys((r.model, r.attachment) for r in record.deviations))
    found = {(r.model, r.attachment, r.quantity): r for r in record.deviations}
    rows = []
    for quantity in sorted(
        dict.fromkeys(r.quantity for r in record.deviations), key=lambda q: RANKS.index(q.kind)
    ):
        own = [found.get((*pair, quantity)) for pair in pairs]
        first = next(r for r in own if r is not None)
        si = quantity.unit
        scene = next((r for r in own if r and r.attachment == SCENE), first)
        value = scene.reference_value
        figure = hertz(value, DASH) if si == "Hz" else units.number(value, si, nothing=DASH)
        cells: list[Any] = [quantity, (units.unit(si), "word text"), figure]
        rows.append(cells + [_deviation(row, tolerance) for row in own])
    names = [f"{_named(record, model)}, {_ties(tie)}" for model, tie in pairs]
    within = f" Bold: beyond the {short_percent(tolerance)} asked for." if tolerance else ""
    return Table(
        f"Differences from the {model_name(record, reference)}",
        ["quantity", "unit", model_name(record, reference), *names],
        rows,
        "In brackets and cursive: not resolved, smaller than the bands of the two models." + within,
    )


def _ties(attachment: str) -> str:
    """How two models were held when they were compared."""
    return "as tied" if attachment == SCENE else f"{attachment} ties"


def _deviation(row: DeviationRecord | None, tolerance: float | None) -> Any:
    """The cell of one difference."""
    if row is None:
        return DASH
    text = pct(row.relative)
    if not is_resolved(row):
        return (f"not resolved ({text})", "unresolved")
    beyond = tolerance is not None and row.relative is not None and abs(row.relative) > tolerance
    return (text, "bad") if beyond else text


def causes(record: Record) -> Table:
    """What each assumption alone changes."""
    rows = []
    for cause in record.causes:
        rows.append(
            [
                cause.cause,
                (cause.change, "text"),
                (model_name(record, cause.model), "text"),
                *(pct(cause.quantities.get(name)) for name in SHOWN),
            ]
        )
    return Table(
        "One assumption switched at a time",
        ["cause", "what is switched", "in", *SHOWN.values()],
        rows,
    )


def attachments(record: Record, units: Units = ENGINEERING) -> Table:
    """What the way of holding the seats changes."""
    rows = []
    for key, ties in record.attachments.items():
        average = ties["average"].quantities if "average" in ties else {}
        for tie, variant in ties.items():
            cells: list[Any] = [f"{_named(record, key)}, {tie}"]
            for name in SHOWN:
                value = variant.quantities.get(name)
                cells.append(_figure(value, name.unit, units))
                change = relative_change(value, average.get(name))
                cells.append(DASH if tie == "average" else pct(change))
            rows.append(cells)
    head = ["model, ties"]
    for name, called in SHOWN.items():
        head += [f"{called}, {units.unit(name.unit)}", "change"]
    return Table("Three ways to hold the same surfaces", head, rows)


def _figure(value: float | None, si: str, units: Units, digits: int = 5) -> str:
    """A value for a column that names its unit."""
    return hertz(value, DASH) if si == "Hz" else units.number(value, si, digits, DASH)


def levels(record: Record, units: Units = ENGINEERING) -> Table:
    """The meshes that the bands come from."""
    rows = []
    for key, model in record.models.items():
        meshes = model.convergence.levels if model.convergence else []
        for n, level in enumerate(meshes, start=1):
            bending = level.quantities.get(FIRST_BENDING)
            rows.append(
                [
                    f"{_named(record, key)}, {n}",
                    whole_number(level.dofs),
                    units.number(level.h, "m", 4, DASH),
                    str(level.order or DASH),
                    units.number(level.quantities.get(C_ZZ), "m/N", 7, DASH),
                    DASH if bending is None else f"{bending:.3f}",
                ]
            )
    return Table(
        "The discretisations",
        [
            "model",
            "degrees of freedom",
            f"element size h, {units.unit('m')}",
            "element order",
            f"C_zz, {units.unit('m/N')}",
            "first bending, Hz",
        ],
        rows,
    )


def orders(record: Record) -> Table:
    """Changes from mesh to mesh, and the bands made of them, of what models are judged by."""
    rows = []
    for key, model in record.models.items():
        bands = model.convergence.quantities if model.convergence else {}
        judged = record.verdict.judged
        for name, band in bands.items():
            if judged and name not in judged:
                continue
            label = f"{name}, Hz" if Quantity(name).is_frequency else name
            rows.append([f"{_named(record, key)}: {label}", *_band(band)])
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
        "Layers: errors shrink by a nearly fixed share, and the factor is measured on random "
        "shafts. Of a coupling: shares of the geometric mean of its two diagonal entries.",
    )


def _band(band: BandRecord) -> list:
    """The cells of the band of one quantity."""
    orders = DASH
    if band.observed_order is not None and band.expected_order is not None:
        orders = f"{band.observed_order:.2f} of {band.expected_order:.2f}"
    return [
        (band.method or DASH, "word text"),
        pct(band.change, signed=False),
        small(band.reduction),
        orders,
        small(band.factor),
        pct(band.solver, signed=False),
        band_percent(band.gci, DASH),
    ]


def algebra(record: Record) -> Table:
    """Residuals and counts that need no second mesh."""
    rows = []
    for key, model in record.models.items():
        if model.evidence != EvidenceRecord():
            rows.append([_named(record, key), *_checks(model)])
    head = [
        "model",
        "asymmetry of the flexibility",
        "rigid motion, residual",
        "modes, residual",
        "modes, M-orthogonality",
        "rigid modes found",
        "eigensolver",
        "no mode missed below, Hz",
    ]
    return Table(
        "Algebraic checks of this run (relative; the smaller the better, but for the counts)",
        head,
        rows,
        "No mode missed: as many eigenvalues lie below as were found, by the inertia of a second "
        "factor (Sylvester).",
    )


def _checks(model: ModelRecord) -> list:
    """The cells of the algebraic checks of one model."""
    evidence = model.evidence
    return [
        small(evidence.asymmetry),
        small(evidence.rigid_residual),
        small(evidence.modal_residual),
        small(evidence.orthogonality),
        small(evidence.rigid_modes),
        (evidence.eigensolver or DASH, "text"),
        _counted_below(evidence),
    ]


def _counted_below(evidence: EvidenceRecord) -> str:
    """The frequency up to which the inertia of a factor confirms that every mode was found."""
    parts = evidence.mode_count
    if not parts or not all(part.get("checked") for part in parts):
        return "not counted"
    return f"{min(part['below_hz'] for part in parts):.0f}"


def pairs(record: Record) -> Table:
    """Modes of every model beside those of the reference, a mode a row."""
    if record.mac is None:
        return Table("", [])
    reference = model_name(record, record.mac.reference)
    own = {
        key: {pair.mode: pair for pair in table.pairs}
        for key, table in record.mac.models.items()
        if table.pairs
    }
    names = dict.fromkeys(name for found in own.values() for name in found)
    rows = [[name, *(_pair(found.get(name)) for found in own.values())] for name in names]
    return Table(
        f"MAC of every mode with its partner in the {reference}",
        ["mode", *(_named(record, key) for key in own)],
        rows,
        "In brackets: the partner, where it has another name; less alike than "
        f"{FOREIGN:g} is none.",
    )


def _pair(pair: PartnerRecord | None) -> str:
    """How like its partner a mode is."""
    if pair is None or pair.mac is None:
        return DASH
    if pair.mac < FOREIGN:
        return f"{pair.mac:.4f} (none)"
    other = "" if pair.partner == pair.mode else f" ({pair.partner or 'none'})"
    return f"{pair.mac:.4f}{other}"
