"""Tables of the evidence: deviations, causes, attachments, bands, algebraic checks, modes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from solidgear.evidence.record import (
    BandRecord,
    DeviationRecord,
    EvidenceRecord,
    ModelRecord,
    PartnerRecord,
    Record,
)
from solidgear.evidence.ties import SCENE, SECTION
from solidgear.report.cells import DASH, capital, eng, mm, pct, short_percent, small, whole_number
from solidgear.report.reading import is_beam, is_resolved, model_name, relative_change
from solidgear.report.table import Table
from solidgear.report.words import band_percent, engineering, hertz

#: rank of a frequency among the quantities
FREQUENCY = 2
#: whether a difference is within the tolerance -> cell
INSIDE = {True: ("yes", "good"), False: ("no", "bad"), None: DASH}
#: quantities shown of causes and attachments -> how each is written
SHOWN: dict[str, Callable[..., str]] = {
    "C_zz": engineering,
    "K_zz": engineering,
    "bending 1": hertz,
}


def _rank(quantity: str) -> int:
    """Compliances first, then stiffnesses, then frequencies."""
    if quantity.startswith("C_"):
        return 0
    return 1 if quantity.startswith("K_") else FREQUENCY


def _named(record: Record, key: str) -> str:
    """The name of a model at the beginning of a cell."""
    return capital(model_name(record, key))


def deviations(record: Record) -> list[Table]:
    """One table for each (model, attachment), compliances first."""
    tolerance = record.verdict.tolerance
    groups: dict[tuple[str, str, str], list[DeviationRecord]] = {}
    for row in record.deviations:
        groups.setdefault((row.model, row.reference, row.attachment), []).append(row)
    tables = []
    for (model, reference, attachment), rows in groups.items():
        one, other = model_name(record, model), model_name(record, reference)
        head = [
            "quantity",
            "unit",
            one,
            other,
            "difference",
            "band",
            "resolved?",
            f"within {short_percent(tolerance) or 'tolerance'}",
        ]
        ties = _ties(attachment, is_beam(record, model))
        table = Table(f"{capital(one)} against {other}, {ties}", head)
        for row in sorted(rows, key=lambda r: _rank(r.quantity)):
            table.rows.append(_deviation(row, tolerance))
        tables.append(table)
    return tables


def _ties(attachment: str, beam: bool) -> str:
    """How two models were held when they were compared."""
    if attachment == SCENE:
        return "attachments as in the scene"
    like = ", like for like" if attachment == SECTION and beam else ""
    return f"{attachment} ties on both sides{like}"


def _deviation(row: DeviationRecord, tolerance: float | None) -> list:
    """The cells of one quantity."""
    is_frequency = _rank(row.quantity) == FREQUENCY
    figure = hertz if is_frequency else engineering
    resolved = ("not resolved", "word text unresolved")
    if is_resolved(row):
        resolved = (row.verdict or "resolved", "word text")
    inside = None
    if row.relative is not None and tolerance is not None:
        inside = abs(row.relative) <= tolerance
    return [
        row.quantity,
        (row.unit or ("Hz" if is_frequency else ""), "word text"),
        figure(row.value, nothing=DASH),
        figure(row.reference_value, nothing=DASH),
        pct(row.relative),
        pct(row.band, signed=False),
        resolved,
        INSIDE[inside],
    ]


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
        ["cause", "what is switched", "in", "C_zz", "K_zz", "first bending"],
        rows,
    )


def attachments(record: Record) -> Table:
    """What the way of holding the seats changes."""
    rows = []
    for key, ties in record.attachments.items():
        average = ties["average"].quantities if "average" in ties else {}
        for tie, variant in ties.items():
            cells: list[Any] = [f"{_named(record, key)}, {tie}"]
            for name, figure in SHOWN.items():
                value = variant.quantities.get(name)
                cells.append(figure(value, nothing=DASH))
                cells.append(pct(relative_change(value, average.get(name))))
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


def levels(record: Record) -> Table:
    """The meshes that the bands come from."""
    rows = []
    for key, model in record.models.items():
        meshes = model.convergence.levels if model.convergence else []
        for n, level in enumerate(meshes, start=1):
            bending = level.quantities.get("bending 1")
            rows.append(
                [
                    f"{_named(record, key)}, {n}",
                    whole_number(level.dofs),
                    mm(level.h),
                    str(level.order or DASH),
                    eng(level.quantities.get("C_zz"), 7),
                    DASH if bending is None else f"{bending:.3f}",
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


def orders(record: Record) -> Table:
    """Changes from mesh to mesh, and the bands made of them."""
    rows = []
    for key, model in record.models.items():
        bands = model.convergence.quantities if model.convergence else {}
        for name, band in bands.items():
            label = f"{name}, Hz" if _rank(name) == FREQUENCY else name
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
        "Layers: every mesh adds layers towards corners as well as order or cells, so errors "
        "shrink by a nearly fixed share; the factor is measured on random shafts. A coupling's "
        "numbers are shares of the geometric mean of its two diagonal entries.",
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
        str(band.factor or DASH),
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


def pairs(record: Record) -> list[Table]:
    """One table for each model, its modes beside those of the reference."""
    if record.mac is None:
        return []
    reference = model_name(record, record.mac.reference)
    head = ["mode", "partner", "MAC", "frequency, Hz", f"{reference}, Hz", "difference"]
    tables = []
    for key, table in record.mac.models.items():
        caption = f"{_named(record, key)}: modes and their partners in the {reference}"
        rows = [_pair(pair) for pair in table.pairs]
        if rows:
            tables.append(Table(caption, head, rows))
    return tables


def _pair(pair: PartnerRecord) -> list:
    """The cells of one mode and its partner."""
    return [
        pair.mode,
        (pair.partner or "none", "text"),
        DASH if pair.mac is None else f"{pair.mac:.4f}",
        hertz(pair.frequency_hz, DASH),
        hertz(pair.reference_hz, DASH),
        pct(pair.relative),
    ]
