"""Tables of the report: results of every model, the evidence for them, and the run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

from solidgear.core import BEAM, COMPLIANCE, STIFFNESS, Quantity, Record
from solidgear.core.judge.correlation import FOREIGN
from solidgear.core.judge.record import (
    DeviationRecord,
    EvidenceRecord,
    LumpedVariant,
    ModelRecord,
    ModeRecord,
    PartnerRecord,
    PointRecord,
    matrix_of,
    relative_change,
)
from solidgear.core.judge.ties import SCENE
from solidgear.core.ladder.model import LUMPED
from solidgear.core.quantity import C_ZZ, FIRST_BENDING, FREQUENCY, K_ZZ
from solidgear.show.matrices import block, entry
from solidgear.show.run_tables import pairs_of
from solidgear.show.table import Cell, Column, Table, quantity, text, word
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.words import (
    DASH,
    bar_percent,
    by_plane,
    engineering,
    grouped,
    hertz,
    percent,
    plus_minus,
    seconds,
    short_percent,
    small,
    whole,
)

Value = str | float | Cell | None
Row = list[Value]

unsigned = partial(percent, signed=False)

#: a frequency of a motion without strain
RIGID = "0 (rigid)"
#: of a difference smaller than the error bars, in a narrow column
NOT_RESOLVED = "n.r."
#: validity -> cell
WORTH = {
    "yes": Cell("yes", "good"),
    "no": Cell("no", "bad"),
    "open": Cell("not judged", "quiet"),
    "unknown": Cell(None),
}
#: quantities shown of causes and attachments -> how a column calls them
SHOWN = {C_ZZ: C_ZZ, K_ZZ: K_ZZ, FIRST_BENDING: "first bending"}
#: what the summary shows of every point
SUMMED = (C_ZZ, Quantity("C_yy"), Quantity("C_thx"))
#: the order of the kinds of quantities
RANKS = (COMPLIANCE, STIFFNESS, FREQUENCY)
#: stages of work that a reader knows by another word than the record does
STAGES = {"band": "error bars"}


# ------------------------------------------------------------------------------------------ results
def models(record: Record) -> Table:
    """Return models that may be used, and why others may not, a model a row."""
    tolerance = short_percent(record.verdict.tolerance)
    columns = [
        "model",
        f"within {tolerance}" if tolerance else "valid",
        Column("first bending, Hz", write=hertz),
        "first bending off",
        "C_zz off",
        Column("time, s", write=seconds),
        text("why not"),
    ]
    rows = [
        [
            record.title(key),
            WORTH[model.validity],
            model.first_frequency("bending"),
            apart(record, key, FIRST_BENDING),
            apart(record, key, C_ZZ),
            model.answer_seconds,
            model.why_not or "",
        ]
        for key, model in record.models.items()
    ]
    return Table("Models of this scene", columns, rows)


def apart(record: Record, key: str, name: Quantity, narrow: bool = False) -> Cell | None:
    """Return the deviation of a model from the reference, weaker where error bars do not resolve
    it; `narrow` in few characters.
    """
    if key == record.reference:
        return Cell("ref." if narrow else "reference", "quiet")
    deviation = record.headline(key, name)
    if deviation is None:
        return None
    difference = percent(deviation.relative)
    if deviation.resolved:
        return Cell(difference)
    return Cell(NOT_RESOLVED if narrow else f"not resolved ({difference})", "quiet")


def summary(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the results of every model in short."""
    each = record.models.values()
    rows: list[Row] = [["valid for this scene", *(WORTH[m.validity] for m in each)]]
    rows += [_values(record, name, name, units) for name in (K_ZZ, C_ZZ, *map(Quantity, OTHERS))]
    for name, called in ((C_ZZ, C_ZZ), (FIRST_BENDING, "first bending")):
        cells = [apart(record, key, name) for key in record.models]
        rows.append([f"{called} against reference", *cells])
    worst = [m.band.compliance if m.band else None for m in each]
    first = [m.bars.get(FIRST_BENDING) for m in each]
    rows.append(["error bar, worst compliance", *map(_bar, each, worst)])
    rows.append(["error bar, first bending", *map(_bar, each, first)])
    rows.append(["degrees of freedom", *(grouped(m.dofs) for m in each)])
    note = (
        "“Against reference” compares beams like for like, with section ties on both sides, where "
        "that is known, and solids as the scene is tied."
    )
    return _across(record, "Results at the lumped point, attachments of the scene", rows, note)


#: stiffnesses in the summary besides that across the shaft
OTHERS = ("K_yy", "K_thx")


def _across(record: Record, title: str, rows: list[Row], note: str) -> Table:
    """Return a table with quantities down and models across."""
    names = [record.title(key) for key in record.models]
    return Table(title, ["quantity", *names], rows if names else [], note, "summary")


def _values(record: Record, name: Quantity, called: str, units: Units) -> Row:
    """Return an entry of a matrix by every model."""
    values = [units.number(m.value(name), name.unit) for m in record.models.values()]
    return [f"{called}, {units.unit(name.unit)}", *values]


def _bar(model: ModelRecord, bar: float | None) -> Value:
    if model.band is None:
        # beams cannot show their own error
        return Cell("none given", "quiet") if model.family == BEAM else None
    return bar_percent(bar)


def matrices(record: Record, units: Units = ENGINEERING) -> dict[str, list[Table]]:
    """Return the matrices of every model but the lumped one, which has another's."""
    free = record.port.free if record.port else []
    tables = {
        key: _matrices(record.title(key), model, "", units, free)
        for key, model in record.models.items()
        if model.family != LUMPED
    }
    return {key: both for key, both in tables.items() if both}


def _matrices(
    name: str, statics: ModelRecord | PointRecord, place: str, units: Units, free: Sequence[str]
) -> list[Table]:
    """Return the stiffness and the compliance at a point, those that are there."""
    both = ((kind, matrix_of(statics, kind)) for kind in (STIFFNESS, COMPLIANCE))
    return [block(rows, kind, units, f"{name}: {kind}{place}", free) for kind, rows in both if rows]


def further_points(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the further points in short: quantities down, models across."""
    main = record.port.name if record.port else ""
    names = [(q.at(p.name), f"{q} at {p.name}") for p in record.further_ports for q in SUMMED]
    for a, b in _pairs_of_points(record):
        for q in SUMMED:
            load = "a moment" if any(q.loads[1][3:]) else "a load"
            names.append((q.at(a, b), f"{q}, {a} for {load} on {b}"))
    rows: list[Row] = []
    for name, label in names:
        bars = [m.bars.get(name) for m in record.models.values()]
        rows.append(_values(record, name, label, units))
        rows.append(["against reference", *(apart(record, k, name) for k in record.models)])
        rows.append(["error bar", *(None if bar is None else plus_minus(bar) for bar in bars)])
    note = (
        f"Headlines, lumped models and attachments above are for {main}, the main point; "
        "compliances of every point are judged unless the scene asks for others. Error bars and "
        "differences between points are relative to the geometric mean of the two points' own "
        "entries."
    )
    return _across(record, "Further lumped points", rows, note)


def further_matrices(record: Record, units: Units = ENGINEERING) -> list[tuple[str, list[Table]]]:
    """Return the matrices of every further point and between points, a heading and its matrices."""
    solved = {k: m for k, m in record.models.items() if m.family != LUMPED and m.coupled}
    out: list[tuple[str, list[Table]]] = []
    for port in record.further_ports:
        tables = []
        for key, model in solved.items():
            if point := model.points.get(port.name):
                place = f" at {port.name}"
                tables += _matrices(record.title(key), point, place, units, port.free)
        out.append((f"At {port.name}", tables))
    for a, b in _pairs_of_points(record):
        tables = []
        for key, model in solved.items():
            tables += _between(record.title(key), model, a, b, units)
        out.append((f"Between {a} and {b}", tables))
    return out


def _between(name: str, model: ModelRecord, a: str, b: str, units: Units) -> list[Table]:
    """Return the stiffness and the compliance between two points, those that are there."""
    tables = []
    for kind, first, second in (
        (STIFFNESS, "load on", "motion of"),
        (COMPLIANCE, "motion of", "load on"),
    ):
        between, at_a, at_b = (
            model.coupled.block(*pair, kind) if model.coupled else None
            for pair in ((a, b), (a, a), (b, b))
        )
        sizes = [[entry(diagonal, k, k) for k in range(6)] for diagonal in (at_a, at_b)]
        if between and any(value is not None for row in between for value in row):
            title = f"{name}: {kind}, {first} {a}, {second} {b}"
            tables.append(block(between, kind, units, title, sizes=sizes))
    return tables


def _pairs_of_points(record: Record) -> list[tuple[str, str]]:
    """Return names of points, two by two."""
    names = [port.name for port in (record.port, *record.further_ports) if port is not None]
    return [(a, b) for k, a in enumerate(names) for b in names[k + 1 :]]


def own_frequencies(record: Record, key: str | None) -> Table:
    """Return natural frequencies of one model with their error bars."""
    model = record.model(key)
    # in two planes that differ, the first ones of both are judged
    judged = {id(model.mode(name)): name for name in model.bars}
    rows = [
        [
            mode.name,
            RIGID if mode.frequency_hz == 0 else mode.frequency_hz,
            mode.multiplicity,
            model.bars.get(judged.get(id(mode), mode.name)),
        ]
        for mode in in_order(model.modes)
    ]
    note = "Two shapes: a pair of the same frequency in two planes."
    if any(bar is None and hz != RIGID for _, hz, _, bar in rows):
        note += " A dash: no error bar; higher modes need finer meshes."
    columns = ["mode", Column("Hz", write=hertz), "shapes", Column("error bar", write=plus_minus)]
    title = f"Natural frequencies of the {record.name(key)}"
    return Table(title, columns, rows, note + by_plane(mode.name for mode in model.modes))


def in_order(modes: Iterable[ModeRecord]) -> list[ModeRecord]:
    """Return modes from the lowest up."""
    return sorted(modes, key=lambda m: m.frequency_hz or 0.0)


def frequencies(record: Record) -> Table:
    """Return the natural frequencies, a mode a row and a model a column."""
    reference = record.reference
    modes = {key: {m.name: m for m in model.modes} for key, model in record.models.items()}
    # a mode stands where the reference has it, else where the first model that has it does
    ordered: dict[str, ModeRecord] = {}
    for key in sorted(modes, key=lambda k: k != reference):
        for name, mode in modes[key].items():
            ordered.setdefault(name, mode)
    rows = []
    for mode in in_order(ordered.values()):
        base = modes.get(reference or "", {}).get(mode.name)
        cells = [
            _frequency(by_name.get(mode.name), None if key == reference else base)
            for key, by_name in modes.items()
        ]
        rows.append([mode.name, mode.family or None, mode.multiplicity, *cells])
    note = ""
    if reference:
        note = (
            f"In brackets: against the {record.name(reference)}. Two shapes: a pair of the "
            "same frequency in two planes. A dash: not among the modes asked for."
        )
        note += by_plane(ordered)
    columns = ["mode", word("family"), "shapes", *map(record.title, modes)]
    return Table("Natural frequencies in Hz, attachments as in the scene", columns, rows, note)


def _frequency(mode: ModeRecord | None, base: ModeRecord | None) -> str | None:
    """Return the frequency of a mode, and in brackets its difference from `base`."""
    if mode is None:
        return None
    if mode.frequency_hz == 0:
        return RIGID
    change = relative_change(mode.frequency_hz, base.frequency_hz if base else None)
    return hertz(mode.frequency_hz) + ("" if change is None else f" ({percent(change)})")


#: entries of a lumped mass matrix: head, unit and place
MASSES = (("M", "kg", (0, 0)), ("I", "kg m²", (1, 1)), ("coupling", "kg m", (0, 1)))


def lumped_tables(record: Record, units: Units = ENGINEERING) -> list[Table]:
    """Return first bending side by side and one table of synthesis per body, where the scene asks
    for it.
    """
    lumped = {key: synthesis for key, synthesis in record.lumped.items() if synthesis.variants}
    if not lumped or not (record.scene.get("ask") or {}).get("lumped"):
        return []
    methods = list(next(iter(lumped.values())).variants)
    sources = [
        [
            f"from the {record.name(key)}",
            synthesis.frequency_hz,
            *(_first(synthesis.variants.get(method)) for method in methods),
        ]
        for key, synthesis in lumped.items()
    ]
    title = "First bending, Hz: each body and the lumped models made from it"
    tables = [Table(title, ["source", Column("body itself", write=hertz), *methods], sources)]
    columns = [
        "mass matrix",
        *(Column(f"{head}, {units.unit(si)}", write=engineering) for head, si, _ in MASSES),
        Column("slope phi/z", write=percent),
        Column("kinetic energy", write=percent),
        Column("valid to, Hz", write=hertz),
        text("verdict"),
    ]
    for key, synthesis in lumped.items():
        rows = [
            [
                method,
                *(units.value(entry(variant.mass, *place), si) for _, si, place in MASSES),
                variant.slope_error,
                variant.kinetic_error,
                variant.valid_to_hz,
                variant.verdict,
            ]
            for method, variant in synthesis.variants.items()
        ]
        share = DASH if synthesis.static_share is None else f"{synthesis.static_share:.4f}"
        note = (
            "Strain energy of the static shape with the mode's lumped-point motion, as a share of "
            f"the mode's: {share}; equations 52 and 53 need exactly 1."
        )
        title = (
            f"Lumped from the {record.name(key)}: slope and kinetic energy against its first "
            "bending mode"
        )
        tables.append(Table(title, columns, rows, note))
    return tables


def _first(variant: LumpedVariant | None) -> str:
    """Return the first bending of a variant, and its error."""
    if variant is None or not variant.feasible:
        return "no solution"
    error = variant.frequency_error
    return hertz(variant.frequency_hz) + ("" if error is None else f" ({percent(error)})")


# ----------------------------------------------------------------------------------------- evidence
def deviations(record: Record, units: Units = ENGINEERING) -> Table:
    """Return all models against the reference, a quantity a row, as tied and like for like."""
    tolerance = record.verdict.tolerance
    by_name: dict[Quantity, dict[tuple[str, str], DeviationRecord]] = {}
    for row in record.deviations:
        by_name.setdefault(row.quantity, {})[row.model, row.attachment] = row
    pairs = list(dict.fromkeys((r.model, r.attachment) for r in record.deviations))
    rows = []
    for name in sorted(by_name, key=lambda q: RANKS.index(q.kind)):
        known = list(by_name[name].values())
        first = next((r for r in known if r.attachment == SCENE), known[0])
        value = _figure(first.reference_value, name.unit, units)
        cells = [_deviation(by_name[name].get(pair), tolerance) for pair in pairs]
        rows.append([name, units.unit(name.unit), value, *cells])
    reference = record.name(record.reference)
    columns = ["quantity", word("unit"), reference]
    for key, tie in pairs:
        ties = "as tied" if tie == SCENE else f"{tie} ties"
        columns.append(Column(f"{record.title(key)}, {ties}", write=percent))
    note = "In brackets and italics: not resolved, smaller than the error bars of both models."
    if tolerance:
        note += f" Bold: beyond the {short_percent(tolerance)} asked for."
    return Table(f"Differences from the {reference}", columns, rows, note)


def _deviation(row: DeviationRecord | None, tolerance: float | None) -> Cell | None:
    """Return the cell of one difference."""
    if row is None:
        return None
    if not row.resolved:
        return Cell(f"not resolved ({percent(row.relative)})", "unresolved")
    beyond = tolerance is not None and row.relative is not None and abs(row.relative) > tolerance
    return Cell(row.relative, "bad" if beyond else "")


def _figure(value: float | None, si: str, units: Units) -> str:
    """Return a value for a column that names its unit."""
    return hertz(value) if si == "Hz" else units.number(value, si)


def causes(record: Record) -> Table:
    """Return the table of causes: the change by each assumption alone."""
    columns = ["cause", text("what is switched"), text("in")]
    columns += [Column(called, write=percent) for called in SHOWN.values()]
    rows = [
        [cause.cause, cause.change, record.name(cause.model), *map(cause.quantities.get, SHOWN)]
        for cause in record.causes
    ]
    return Table("One assumption switched at a time", columns, rows)


def attachments(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the table of attachments: the change by each way of holding the seats."""
    columns: list[Column | str] = ["model, ties"]
    for name, called in SHOWN.items():
        figure = partial(_figure, si=name.unit, units=units)
        columns += [Column(f"{called}, {units.unit(name.unit)}", write=figure)]
        columns += [Column("change", write=percent)]
    rows = []
    for key, ties in record.attachments.items():
        average = ties["average"].quantities if "average" in ties else {}
        for tie, variant in ties.items():
            row: Row = [f"{record.title(key)}, {tie}"]
            base = {} if tie == "average" else average
            for name in SHOWN:
                value = variant.quantities.get(name)
                row += [value, relative_change(value, base.get(name))]
            rows.append(row)
    return Table("Three ways to hold the same surfaces", columns, rows)


def levels(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the table of the meshes that the error bars come from."""
    columns = [
        "model",
        Column("degrees of freedom", write=grouped),
        quantity("element size h", "m", units, digits=4),
        "element order",
        quantity("C_zz", "m/N", units, digits=7),
        Column("first bending, Hz", write=lambda hz: f"{hz:.3f}"),
    ]
    rows = []
    for key, model in record.models.items():
        for n, level in enumerate(model.convergence.levels if model.convergence else [], start=1):
            values = [level.quantities.get(name) for name in (C_ZZ, FIRST_BENDING)]
            label = f"{record.title(key)}, {n}"
            rows.append([label, level.dofs, level.h, level.order or None, *values])
    return Table("The discretisations", columns, rows)


def orders(record: Record) -> Table:
    """Return the error bars of the last mesh of every solid, and what they are made of."""
    columns = [
        "quantity",
        word("error bar from"),
        Column("other end of the bounds", write=unsigned),
        Column("safety in it", write=small),
        Column("of the solver", write=unsigned),
        Column("error bar", write=bar_percent),
    ]
    judged = record.verdict.judged
    rows = []
    for key, model in record.models.items():
        bars = model.convergence.quantities if model.convergence else {}
        for name, bar in bars.items():
            if judged and name not in judged:
                continue
            label = f"{name}, Hz" if Quantity(name).is_frequency else name
            widths = [bar.change, bar.factor, bar.solver, bar.gci]
            rows.append([f"{record.title(key)}: {label}", bar.method or None, *widths])
    return Table(
        "Error bars",
        columns,
        rows,
        "The exact number lies between that of the mesh and the other end, in the safety that is "
        "measured on drawn bodies. Couplings: relative to the geometric mean of both diagonal "
        "entries.",
    )


def algebra(record: Record) -> Table:
    """Return residuals and counts of the solution itself."""
    columns = [
        "model",
        Column("asymmetry of the flexibility", write=small),
        Column("rigid motion, residual", write=small),
        Column("modes, residual", write=small),
        Column("modes, M-orthogonality", write=small),
        Column("rigid modes found", write=small),
        text("eigensolver"),
        "no mode missed below, Hz",
    ]
    rows = [
        [
            record.title(key),
            model.evidence.asymmetry,
            model.evidence.rigid_residual,
            model.evidence.modal_residual,
            model.evidence.orthogonality,
            model.evidence.rigid_modes,
            model.evidence.eigensolver or None,
            _counted_below(model.evidence),
        ]
        for key, model in record.models.items()
        if model.evidence != EvidenceRecord()
    ]
    return Table(
        "Algebraic checks of this run (relative, smaller is better, except for counts)",
        columns,
        rows,
        "No mode missed: a second factorisation (Sylvester) counts as many eigenvalues below as "
        "were found, less the error bars of modes above.",
    )


def _counted_below(evidence: EvidenceRecord) -> str:
    """Return the frequency below which no mode is missed, of the body or else of its mesh."""
    parts = evidence.mode_count
    if not parts or not all(part.get("checked") for part in parts):
        return "not counted"
    if evidence.complete_below_hz is not None:
        return f"{evidence.complete_below_hz:.0f}"
    return f"{min(part['below_hz'] for part in parts):.0f} (of this mesh)"


def pairs(record: Record) -> Table:
    """Return modes of every model beside those of the reference, a mode a row."""
    if record.mac is None:
        return Table("", [])
    partners = {
        key: {pair.mode: pair for pair in table.pairs}
        for key, table in record.mac.models.items()
        if table.pairs
    }
    names = dict.fromkeys(name for by_name in partners.values() for name in by_name)
    rows = [[name, *(_pair(by_name.get(name)) for by_name in partners.values())] for name in names]
    return Table(
        f"MAC of every mode with its partner in the {record.name(record.mac.reference)}",
        ["mode", *map(record.title, partners)],
        rows,
        f"In brackets: the partner, where it has another name; a MAC below {FOREIGN:g} makes none.",
    )


def _pair(pair: PartnerRecord | None) -> str | None:
    """Return the MAC of a mode and its partner, with the partner's name where it differs."""
    if pair is None or pair.mac is None:
        return None
    if pair.mac < FOREIGN:
        return f"{pair.mac:.4f} (none)"
    partner = "" if pair.partner == pair.mode else f" ({pair.partner or 'none'})"
    return f"{pair.mac:.4f}{partner}"


# ------------------------------------------------------------------------------------------ the run
def cost(record: Record) -> Table:
    """Return seconds of every stage and peak memory."""
    stages = dict.fromkeys(s for m in record.models.values() for s in m.seconds if s != "total")
    stages["total"] = None
    columns = [
        "model",
        *(Column(STAGES.get(stage, stage), write=seconds) for stage in stages),
        Column("peak MB", write=whole),
        text("linear algebra"),
    ]
    rows = [
        [record.title(key), *map(model.seconds.get, stages), model.peak_mb, model.backend or None]
        for key, model in record.models.items()
    ]
    note = "Times of a single run on the machine named below: orders of magnitude only."
    return Table("Wall time in s and peak memory", columns, rows, note)


def provenance(record: Record) -> Table:
    """Return the table of the origin of each class of number."""
    reference = record.name(record.reference)
    ran = ", ".join(map(record.name, record.models)) or "no model"
    source = record.scene.get("source") or "source not given"
    experiment = "free solids against measured resonances; not bearings, seats, cuts and teeth"
    rows: list[Row] = [
        ["geometry, material, bearings", f"input: {source}; each bearing carries its status"],
        ["stiffness, compliance, modes", f"this run, by: {ran}"],
        ["differences, correlation", f"this run, against its {reference}, not against reality"],
        ["causes, attachments", "this run: the same model solved again with one thing switched"],
        ["error bars", "this run: solution verification on related meshes of the same model"],
        ["expected orders, free motions", "closed form"],
        ["experiment", Cell(experiment, "strong")],
    ]
    return Table(
        "Where each class of number comes from", ["class", text("origin")], rows, style="facts"
    )


def mesh(record: Record) -> Table:
    """Return facts of every mesh, a model a row."""
    facts = {record.title(key): model.mesh for key, model in record.models.items() if model.mesh}
    return pairs_of(facts, "Meshes", ("model", "mesh"))
