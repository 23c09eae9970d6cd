"""One self-contained HTML page about one run.

`write_report` turns the record of a run into tables and charts and fills ``report.html``, the
template beside this file: page one with the answer, a part for the customer, an appendix for the
engineer. The page needs no network and no other
file; its one script turns the mode shapes, and without it pictures stand there.
"""

from __future__ import annotations

import hashlib
import json
import logging
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from solidgear.comparison.page import charts, evidence_tables, result_tables
from solidgear.comparison.page.result_tables import across, apart
from solidgear.comparison.race import tables as race_tables
from solidgear.core import (
    C_ZZ,
    COMPLIANCE,
    FIRST_BENDING,
    SCENE,
    STIFFNESS,
    ModeName,
    Quantity,
    Record,
    whole,
)
from solidgear.core.judge.record import LumpedRecord, LumpedVariant, ModelRecord, VerdictRecord
from solidgear.core.quantity import AT
from solidgear.show import open_words, run_tables
from solidgear.show.matrices import block as matrix
from solidgear.show.page_parts import Contents, data_uri, template
from solidgear.show.reading import (
    BEAM,
    LUMPED,
    block,
    entry,
    first_frequency,
    is_resolved,
    mode_of,
    model_name,
    model_of,
    reference_of,
    relative_change,
    validity,
    value_of,
)
from solidgear.show.table import Cell, Column, Table, text
from solidgear.show.units import ENGINEERING, Units, digits_for, units_named
from solidgear.show.viewer import TURNED, fragment_of
from solidgear.show.words import (
    DASH,
    bar_percent,
    capital,
    engineering,
    hertz,
    percent,
    plus_minus,
    seconds,
    short_percent,
)
from solidgear.trains.page import input_tables

log = logging.getLogger(__name__)


def write_report(record: Record, folder: Path, drawn: Drawn | None = None) -> Path:
    """Write ``report.html``, whole or not at all, in the units of the record; `drawn` are charts
    drawn before.
    """
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / "report.html"
    with whole(target) as partial:
        partial.write_text(render_page(record, folder, drawn), encoding="utf-8")
    return target


def render_page(record: Record, folder: Path, drawn: Drawn | None = None) -> str:
    """Return the page as text; parameters and errors are those of `write_report`."""
    from markupsafe import Markup

    chosen = units_named(record.shown_in)
    drawn = drawn or drawn_charts(record, folder)
    pictures = _pictures(record, folder)
    has_pictures = any(uri for several in pictures.values() for _, uri in several)
    viewer = (
        fragment_of(folder / TURNED, still=not has_pictures)
        if TURNED in (record.files or ())
        else ""
    )
    return template("report.html").render(
        **_opening(record, chosen),
        **_tables(record, chosen),
        **pictures,
        customer=Contents(),
        appendix=Contents("A{}"),
        charts={name: Markup(svg.decode()) if svg else None for name, svg in drawn.svg.items()},
        race=race_tables.section(folder, record.scene),
        viewer=Markup(viewer),
        warnings=[*record.warnings, *drawn.failed],
    )


class Drawn(NamedTuple):
    """The charts of a page by name, None where there is nothing to draw, and a sentence for every
    one that could not be drawn.
    """

    svg: dict[str, bytes | None]
    failed: list[str]


def drawn_charts(record: Record, folder: Path) -> Drawn:
    """Draw all charts of the page of a record; a race may have left its rows in the folder."""
    out = Drawn({}, [])
    for name, chart in {
        **charts.CHARTS,
        "speed": lambda race: race_tables.chart(folder, race.scene),
    }.items():
        try:
            out.svg[name] = chart(record)
        except Exception as error:  # a picture must never cost the reader the numbers
            log.warning("chart %s: %s", name, error, exc_info=True)
            out.failed.append(f"the chart of {name} could not be drawn: {error}")
            out.svg[name] = None
    return out


def _opening(record: Record, units: Units) -> dict[str, Any]:
    """Return contents of page one: the numbers, their model, and why it is trusted."""
    scene, verdict = record.scene, record.verdict
    return {
        "title": scene.get("title") or scene.get("name") or "shaft",
        "stamp": stamp(record),
        "numbers": numbers(record, units),
        "reasons": reasons(record),
        "verdict": None if verdict == VerdictRecord() else verdict,
        "free": record.port.free if record.port else [],
        "complete": record.complete,
        "missing": record.missing,
        "trusted": model_name(record, verdict.trust) if verdict.trust else None,
        "reference": model_name(record, reference_of(record)) if reference_of(record) else None,
    }


def _where(record: Record) -> dict[str, Any] | None:
    """Return contents of the section on the places where the error comes from."""
    where_record = record.where
    if where_record is None:
        return None
    return {
        "sentence": where_record.sentence,
        "quantity": where_record.quantity,
        "order": where_record.order,
        "name": model_name(record, where_record.model),
        "total": percent(where_record.total, signed=False),
    }


def _tables(record: Record, units: Units) -> dict[str, Any]:
    """Return all tables of the page, by their names in the template."""
    scene, shown_key = record.scene, shown_model(record)
    matrices = result_tables.matrices(record, units)
    return {
        "scene_facts": input_tables.scene_facts(record, units),
        "segments": input_tables.segments(scene, units),
        "features": input_tables.features(scene, units),
        "bearings": input_tables.bearings(scene, units),
        "budget": open_words.budget(record.open),
        "masses": input_tables.masses(scene, units),
        "own_matrices": matrices.get(shown_key or "", []),
        "own_frequencies": result_tables.own_frequencies(record, shown_key),
        "models": result_tables.models(record),
        "summary": result_tables.summary(record, units),
        # a compliance is the inverse of what is shown
        "other_matrices": [both[0] for key, both in matrices.items() if key != shown_key],
        "points": further_points(record, units),
        "point_matrices": further_matrices(record, units),
        "frequencies": result_tables.frequencies(record),
        "deviations": evidence_tables.deviations(record, units),
        "causes": evidence_tables.causes(record),
        "lumped": lumped_tables(record, units),
        "attachments": evidence_tables.attachments(record, units),
        "where": _where(record),
        "levels": evidence_tables.levels(record, units),
        "orders": evidence_tables.orders(record),
        "algebra": evidence_tables.algebra(record),
        "pairs": evidence_tables.pairs(record),
        "cost": run_tables.cost(record),
        "provenance": run_tables.provenance(record),
        "environment": run_tables.pairs_of(record.environment, "Environment of the run"),
        "mesh": run_tables.mesh(record),
        "total": seconds(record.seconds_total),
    }


def _pictures(record: Record, folder: Path) -> dict[str, list[tuple[str, str | None]]]:
    """Return (caption, data URI or None) of the model on page one and of the others, inside the
    folder only.
    """
    shown_key = shown_model(record)
    renders: dict[str, list[tuple[str, str | None]]] = {"own_renders": [], "other_renders": []}
    for key, name in record.images.items():
        picture = capital(model_name(record, key)), data_uri(key, folder / Path(name).name)
        renders["own_renders" if key == shown_key else "other_renders"].append(picture)
    return renders


#: quantities of page one -> in words
ROWS: dict[str, str] = {
    "bending 1": "First bending mode",
    "axial 1": "First axial mode",
    "K_zz": "Stiffness across the shaft",
    "K_yy": "Stiffness along the shaft",
    "K_thx": "Stiffness against tilting",
    "C_zz": "Compliance across the shaft",
    "C_yy": "Compliance along the shaft",
    "C_thx": "Compliance against tilting",
}
#: told only where the scene asks for them; one without words by its symbol
ON_REQUEST: dict[str, str] = {
    "K_z,thx": "Stiffness, motion across with tilting",
    "C_z,thx": "Compliance, motion across with tilting",
    "bending 2": "Second bending mode",
    "torsion 1": "First torsion mode",
}
#: the two directions across a shaft are told apart from here on
ALIKE = 0.01
#: figures of the hash that page and customer compare
HASH_DIGITS = 12


def shown_model(record: Record) -> str | None:
    """Return the model on page one: the trusted one, else the reference, else the last solved."""
    solved = [key for key, model in record.models.items() if model.stiffness or model.modes]
    for key in (record.verdict.trust, reference_of(record)):
        if key in solved:
            return key
    return solved[-1] if solved else None


def scene_hash(scene: Mapping[str, Any]) -> str:
    """Return the first figures of the SHA-256 of a scene's data."""
    if not scene:
        return ""
    text = json.dumps(scene, sort_keys=True, ensure_ascii=True)
    return hashlib.sha256(text.encode()).hexdigest()[:HASH_DIGITS]


def numbers(record: Record, units: Units) -> Table:
    """Return the numbers asked for, each with its error bar, from the model shown."""
    key = shown_model(record)
    model = model_of(record, key)
    quantities = (record.scene.get("ask") or {}).get("quantities") or []
    names = [Quantity(q) for q in (*ROWS, *(q for q in quantities if AT not in q))]
    # by the names that results have: a scene may write those of points in another way
    names += [q for q in (record.verdict.judged if quantities else ()) if q.points]
    cells = [_number(record, model, name, _label(name), units) for name in dict.fromkeys(names)]
    cells += _other_direction(record, model, units)
    caption = f"At the lumped point {(record.scene.get('port') or {}).get('name', '')}".strip()
    if key:
        caption += f", by the {model_name(record, key)}"
    remark = open_words.remark(record.open)
    end = remark or "open data of bearings or load are not included."
    return Table(
        caption,
        ["quantity", "value", "error bar"],
        [row for row in cells if row],
        "K: all other motions held; C: left free. The error bar holds the error of mesh and "
        f"solver{'. ' if remark else '; '}{end}",
        style="numbers",
    )


def _label(name: Quantity) -> str:
    """Return a quantity in words, with its points, and its symbol."""
    words = {**ROWS, **ON_REQUEST}.get(name.symbol, "")
    places = " under loads on ".join(name.points)
    symbol = "" if words and name.is_frequency else name.symbol
    return ", ".join(filter(None, (words, places, symbol)))


def _number(
    record: Record, model: ModelRecord, name: Quantity, label: str, units: Units
) -> list[Any]:
    """Return the cells of one quantity; none where there is no such number."""
    value = _frequency(model, name) if name.is_frequency else value_of(model, name)
    if value is None or value == 0:
        return []
    bar = model.band.each.get(name) if model.band else None
    written = units.text(value, name.unit, digits_for(bar))
    ranges = open_words.parts(record.open, name)
    mesh = "no error bar" if bar is None else plus_minus(bar)
    if ranges:
        mesh = "\n".join([mesh if bar is None else f"mesh {mesh}", *map(" ".join, ranges)])
    return [label, Cell(written, "strong"), mesh]


def _frequency(model: ModelRecord, name: Quantity) -> float | None:
    mode, named = mode_of(model, name), ModeName(name)
    exact = mode.frequency_hz if mode else None
    return exact if exact is not None or named.number != 1 else first_frequency(model, named.family)


def _other_direction(record: Record, model: ModelRecord, units: Units) -> Iterable[list[Any]]:
    """Return the stiffness in the other direction across the shaft, where it differs."""
    k_zz, k_xx = (entry(model.stiffness, i, i) for i in (2, 0))
    change = relative_change(k_xx, k_zz)
    if change is None or abs(change) <= ALIKE:
        return []
    return [
        _number(record, model, Quantity("K_xx"), "Stiffness across, other direction, K_xx", units)
    ]


def reasons(record: Record) -> list[str]:
    """Return three sentences on why to trust the model shown, or why there is no verdict."""
    verdict = record.verdict
    if verdict == VerdictRecord():
        return ["The run was interrupted before the verdict."]
    if not verdict.trust:
        return list(verdict.sentences[:3])
    return [_own(record), _second(record), _others(record)]


def _own(record: Record) -> str:
    """Return the sentence on the trusted model's own error bars."""
    trust = record.verdict.trust
    model = model_of(record, trust)
    solves = f", which solves {model.theory}," if model.theory else ""
    bars = model.band.each if model.band else {}
    judged = record.verdict.judged or list(map(Quantity, bars))
    c = max((bars[q] or 0.0 for q in judged if q.kind == COMPLIANCE and q in bars), default=None)
    sure = [(c, "compliance"), (bars.get(FIRST_BENDING), "first bending")]
    errors = [f"{bar_percent(bar)} in {kind}" for bar, kind in sure if bar is not None]
    tolerance = short_percent(record.verdict.tolerance)
    end = f"; {tolerance} was asked for" if tolerance else ""
    claim = f" has an own error of {' and '.join(errors)}" if errors else " judges the others"
    return f"The {model_name(record, trust)}{solves}{claim}{end}."


def _second(record: Record) -> str:
    """Return the sentence on the distance of a second solid from the trusted one."""
    trust, judged = record.verdict.trust, record.verdict.judged
    sentences = []
    for key, model in record.models.items():
        rows = [
            r
            for r in record.deviations
            if r.model == key
            and r.reference == trust
            and r.attachment == SCENE
            and (r.quantity in judged or not judged)
            and r.relative is not None
        ]
        if model.family in (BEAM, LUMPED) or key == trust or not rows:
            continue
        worst = max(abs(r.relative or 0.0) for r in rows)
        text = (
            f"The {model_name(record, key)}, solved independently, differs from it by at most "
            f"{percent(worst, False)} in any judged number"
        )
        inside = not any(is_resolved(r) for r in rows)
        sentences.append(text + (", less than both error bars." if inside else "."))
    return " ".join(sentences) or "No second solid was solved to confirm it."


def _others(record: Record) -> str:
    """Return the sentence on cheaper models, those that are enough and those that are not."""
    verdict = record.verdict
    tolerance = short_percent(verdict.tolerance) or "the tolerance"
    out = [model_name(record, k) for k, m in record.models.items() if validity(m) == "no"]
    keep = f"do not use the {_listed(out)} here" if out else ""
    cheapest = verdict.cheapest
    if cheapest and cheapest != verdict.trust:
        only = " for first bending and below" if model_of(record, cheapest).family == LUMPED else ""
        text = f"The {model_name(record, cheapest)} is enough within {tolerance}{only}"
        return f"{text}; {keep}." if keep else f"{text}."
    text = f"No cheaper model was shown to be within {tolerance}"
    return f"{text}: {keep}." if keep else f"{text}."


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"


def stamp(record: Record) -> list[tuple[str, str]]:
    """Return date, version and scene of the run as (name, value)."""
    environment = record.environment
    facts = [
        ("scene", str(record.scene.get("name") or "")),
        ("scene hash", scene_hash(record.scene)),
        ("date", str(environment.get("date") or "")),
        ("solidgear", str(environment.get("solidgear") or "")),
    ]
    return [(fact, value or DASH) for fact, value in facts]


#: a method and what it made
Item = tuple[str, LumpedVariant]


def lumped_tables(record: Record, units: Units) -> list[Table]:
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
    details = [_detail(model_name(record, key), lumped[key], units) for key in lumped]
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


def _detail(name: str, synthesis: LumpedRecord, units: Units) -> Table:
    """Return the synthesis from one body, a method a row."""

    def mass(head: str, si: str, i: int, j: int) -> Column:
        return Column(
            f"{head}, {units.unit(si)}",
            lambda item: units.value(entry(item[1].mass, i, j), si),
            engineering,
        )

    columns = [
        Column("mass matrix", lambda item: item[0]),
        mass("M", "kg", 0, 0),
        mass("I", "kg m²", 1, 1),
        mass("coupling", "kg m", 0, 1),
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


#: what is told of every point in the summary
SUMMED = (C_ZZ, Quantity("C_yy"), Quantity("C_thx"))


def further_points(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the further points in short: quantities down, models across."""
    rows: list[list[Any]] = []
    main = record.port.name if record.port else ""
    models = record.models.values()

    def add(quantity: Quantity, label: str) -> None:
        cells = [units.number(value_of(m, quantity), quantity.unit) for m in models]
        rows.append([f"{label}, {units.unit(quantity.unit)}", *cells])
        rows.append(["against reference", *(apart(record, k, quantity) for k in record.models)])
        bars = [m.band.each.get(quantity) if m.band else None for m in models]
        rows.append(["error bar", *(None if bar is None else plus_minus(bar) for bar in bars)])

    for port in record.further_ports:
        for name in SUMMED:
            add(name.at(port.name), f"{name} at {port.name}")
    for a, b in _pairs(record):
        for name in SUMMED:
            load = "a moment" if any(name.loads[1][3:]) else "a load"
            add(name.at(a, b), f"{name}, {a} for {load} on {b}")
    note = (
        f"Headlines, lumped models and attachments above are for {main}, the main point; "
        "compliances of every point are judged unless the scene asks for others. Error bars and "
        "differences between points are relative to the geometric mean of the two points' own "
        "entries."
    )
    return across(record, "Further lumped points", rows, note, "quantity")


def further_matrices(record: Record, units: Units = ENGINEERING) -> list[tuple[str, list[Table]]]:
    """Return the matrices of every further point and between points, a heading and its matrices."""
    out: list[tuple[str, list[Table]]] = []
    models = {k: m for k, m in record.models.items() if m.family != LUMPED and m.coupled}
    for port in record.further_ports:
        blocks = []
        for key, model in models.items():
            point = model.points.get(port.name)
            for kind in (STIFFNESS, COMPLIANCE) if point else ():
                values = getattr(point, kind)
                if values:
                    caption = f"{model_name(record, key)}: {kind} at {port.name}"
                    blocks.append(matrix(values, kind, units, capital(caption), port.free))
        out.append((f"At {port.name}", blocks))
    for a, b in _pairs(record):
        blocks = []
        for key, model in models.items():
            for kind in (STIFFNESS, COMPLIANCE):
                between = block(model.coupled, a, b, kind)
                diagonals = [block(model.coupled, name, name, kind) for name in (a, b)]
                sizes = [[entry(name, k, k) for k in range(6)] for name in diagonals]
                words = ["load on", "motion of"]
                first, second = words if kind == STIFFNESS else reversed(words)
                caption = f"{model_name(record, key)}: {kind}, {first} {a}, {second} {b}"
                if between and any(v is not None for row in between for v in row):
                    blocks.append(matrix(between, kind, units, capital(caption), sizes=sizes))
        out.append((f"Between {a} and {b}", blocks))
    return out


def _pairs(record: Record) -> list[tuple[str, str]]:
    """Return names of points, two by two."""
    names = [port.name for port in (record.port, *record.further_ports) if port is not None]
    return [(a, b) for k, a in enumerate(names) for b in names[k + 1 :]]
