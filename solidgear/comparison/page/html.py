"""One self-contained HTML page about one run.

`write_report` turns the record of a run into tables and charts and fills ``report.html``: page one
with the answer, a part for the customer, an appendix for the engineer. The page needs no network
and no other file; its one script turns the mode shapes, and without it pictures stand there.
"""

from __future__ import annotations

import hashlib
import json
import logging
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from solidgear.comparison.page import charts, tables
from solidgear.comparison.race.race import race_of
from solidgear.comparison.race.sheet import section
from solidgear.core import BEAM, COMPLIANCE, ModeName, Quantity, Record, whole
from solidgear.core.judge.record import ModelRecord, VerdictRecord, relative_change
from solidgear.core.judge.ties import SCENE
from solidgear.core.ladder.model import LUMPED
from solidgear.core.quantity import AT, FIRST_BENDING
from solidgear.show import input_tables, open_words
from solidgear.show.matrices import entry
from solidgear.show.page_parts import Contents, data_uri, template
from solidgear.show.plot import page_svg
from solidgear.show.run_tables import pairs_of
from solidgear.show.table import Cell, Table
from solidgear.show.units import Units, digits_for, units_named
from solidgear.show.viewer import TURNED, fragment_of
from solidgear.show.words import DASH, bar_percent, percent, plus_minus, seconds, short_percent

log = logging.getLogger(__name__)


def write_report(record: Record, folder: Path, drawn: Drawn | None = None) -> Path:
    """Write ``report.html``, whole or not at all, in the units of the record; `drawn` are charts
    drawn before.
    """
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / "report.html"
    with whole(target) as half:
        half.write_text(render_page(record, folder, drawn), encoding="utf-8")
    return target


def render_page(record: Record, folder: Path, drawn: Drawn | None = None) -> str:
    """Return the page as text; parameters and errors are those of `write_report`."""
    from markupsafe import Markup

    units, verdict, where = units_named(record.shown_in), record.verdict, record.where
    scene = record.scene
    drawn = drawn or drawn_charts(record, folder)
    race, shown = race_of(folder, scene), shown_model(record)
    matrices = tables.matrices(record, units)
    # inside the folder only
    pictures = {
        key: (record.title(key), data_uri(key, folder / Path(name).name))
        for key, name in record.images.items()
    }
    viewer = ""
    if TURNED in (record.files or ()):
        viewer = fragment_of(folder / TURNED, still=not any(uri for _, uri in pictures.values()))
    return page_template().render(
        record=record,
        customer=Contents(),
        appendix=Contents("A{}"),
        charts={name: Markup(svg.decode()) if svg else None for name, svg in drawn.svg.items()},
        race=section(race) if race else None,
        viewer=Markup(viewer),
        warnings=[*record.warnings, *drawn.failed],
        own_renders=[picture for key, picture in pictures.items() if key == shown],
        other_renders=[picture for key, picture in pictures.items() if key != shown],
        title=scene.get("title") or scene.get("name") or "shaft",
        stamp=stamp(record),
        numbers=numbers(record, units),
        reasons=reasons(record),
        verdict=None if verdict == VerdictRecord() else verdict,
        free=record.port.free if record.port else [],
        trusted=record.name(verdict.trust) if verdict.trust else None,
        reference=record.name(record.reference) if record.reference else None,
        scene_facts=input_tables.scene_facts(record, units),
        segments=input_tables.segments(scene, units),
        features=input_tables.features(scene, units),
        bearings=input_tables.bearings(scene, units),
        masses=input_tables.masses(scene, units),
        budget=open_words.budget(record.open),
        own_matrices=matrices.get(shown or "", []),
        own_frequencies=tables.own_frequencies(record, shown),
        models=tables.models(record),
        summary=tables.summary(record, units),
        # a compliance is the inverse of what is shown
        other_matrices=[both[0] for key, both in matrices.items() if key != shown],
        points=tables.further_points(record, units),
        point_matrices=tables.further_matrices(record, units),
        frequencies=tables.frequencies(record),
        deviations=tables.deviations(record, units),
        causes=tables.causes(record),
        lumped=tables.lumped_tables(record, units),
        attachments=tables.attachments(record, units),
        where=where,
        where_model=record.name(where.model) if where else "solid",
        where_total=percent(where.total, signed=False) if where else "",
        where_solid=_in_solid(record),
        where_picture=_picture_in_solid(record, folder),
        levels=tables.levels(record, units),
        orders=tables.orders(record),
        algebra=tables.algebra(record),
        pairs=tables.pairs(record),
        cost=tables.cost(record),
        total=seconds(record.seconds_total),
        provenance=tables.provenance(record),
        environment=pairs_of(record.environment, "Environment of the run"),
        mesh=tables.mesh(record),
    )


def page_template() -> Any:
    """Return the template of the page, which is compiled at the first call."""
    return template("report.html", Path(__file__).parent)


def _in_solid(record: Record) -> str:
    """Return the sentence on where the error of a 3D solid arises; empty without one."""
    where = record.where_solid
    if where is None:
        return ""
    total = percent(where.total, signed=False)
    return f"{where.sentence} (a bound in one order more, {total}, on the mesh of the {record.name(where.model)})."


def _picture_in_solid(record: Record, folder: Path) -> str | None:
    """Return the picture of the cells that the error of a 3D solid arises in, from the folder."""
    where = record.where_solid
    if where is None or not where.picture:
        return None
    return data_uri(f"the error of {where.model}", folder / Path(where.picture).name)


class Drawn(NamedTuple):
    """The charts of a page by name, None where there is nothing to draw, and a sentence for every
    one that could not be drawn.
    """

    svg: dict[str, bytes | None]
    failed: list[str]


def drawn_charts(record: Record, folder: Path) -> Drawn:
    """Draw all charts of the page of a record; a race may have left its rows in the folder."""
    out = Drawn({}, [])
    make = {name: partial(chart, record) for name, chart in charts.CHARTS.items()}
    if race := race_of(folder, record.scene):
        make |= {
            name: partial(page_svg, name, chart) for name, chart in section(race).charts.items()
        }
    for name, draw in make.items():
        try:
            out.svg[name] = draw()
        except Exception as error:  # a picture must never cost the reader the numbers
            log.warning("chart %s: %s", name, error, exc_info=True)
            out.failed.append(f"the chart of {name} could not be drawn: {error}")
            out.svg[name] = None
    return out


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
    for key in (record.verdict.trust, record.reference):
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
    model = record.model(key)
    quantities = (record.scene.get("ask") or {}).get("quantities") or []
    names = [Quantity(q) for q in (*ROWS, *(q for q in quantities if AT not in q))]
    # by the names that results have: a scene may write those of points in another way
    names += [q for q in (record.verdict.judged if quantities else ()) if q.points]
    labels = {name: _label(name) for name in names}
    k_zz, k_xx = (entry(model.stiffness, i, i) for i in (2, 0))
    if abs(relative_change(k_xx, k_zz) or 0.0) > ALIKE:
        labels[Quantity("K_xx")] = "Stiffness across, other direction, K_xx"
    cells = [_number(record, model, name, label, units) for name, label in labels.items()]
    caption = f"At the lumped point {(record.scene.get('port') or {}).get('name', '')}".strip()
    if key:
        caption += f", by the {record.name(key)}"
    case = f"{record.load_case} " if record.load_case else ""
    remark = open_words.remark(record.open)
    end = remark or "open data of bearings or load are not included."
    return Table(
        caption,
        ["quantity", "value", "error bar"],
        [row for row in cells if row],
        f"{case}K: all other motions held; C: left free. The error bar holds the error of mesh and "
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
) -> tables.Row:
    """Return the cells of one quantity; none where there is no such number."""
    value = _frequency(model, name) if name.is_frequency else model.value(name)
    if value is None or value == 0:
        return []
    bar = model.bars.get(name)
    written = units.text(value, name.unit, digits_for(bar))
    ranges = open_words.parts(record.open, name)
    mesh = "no error bar" if bar is None else plus_minus(bar)
    if ranges:
        mesh = "\n".join([mesh if bar is None else f"mesh {mesh}", *map(" ".join, ranges)])
    return [label, Cell(written, "strong"), mesh]


def _frequency(model: ModelRecord, name: Quantity) -> float | None:
    mode, named = model.mode(name), ModeName(name)
    exact = mode.frequency_hz if mode else None
    return exact if exact is not None or named.number != 1 else model.first_frequency(named.family)


def reasons(record: Record) -> list[str]:
    """Return three sentences on why to trust the model shown, or why there is no verdict."""
    verdict = record.verdict
    if verdict == VerdictRecord():
        return ["The run was interrupted before the verdict."]
    if not verdict.trust:
        return list(verdict.sentences[:3])
    return [_trusted_model(record), _second_solid(record), _cheaper_models(record)]


def _trusted_model(record: Record) -> str:
    """Return the sentence on the trusted model's own error bars."""
    trust = record.verdict.trust
    model = record.model(trust)
    solves = f", which solves {model.theory}," if model.theory else ""
    bars, judged = model.bars, record.verdict.judged or list(map(Quantity, model.bars))
    c = max((bars[q] or 0.0 for q in judged if q.kind == COMPLIANCE and q in bars), default=None)
    sure = [(c, "compliance"), (bars.get(FIRST_BENDING), "first bending")]
    errors = [f"{bar_percent(bar)} in {kind}" for bar, kind in sure if bar is not None]
    tolerance = short_percent(record.verdict.tolerance)
    end = f"; {tolerance} was asked for" if tolerance else ""
    claim = f" has an own error of {' and '.join(errors)}" if errors else " judges the others"
    return f"The {record.name(trust)}{solves}{claim}{end}."


def _second_solid(record: Record) -> str:
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
            f"The {record.name(key)}, solved independently, differs from it by at most "
            f"{percent(worst, False)} in any judged number"
        )
        inside = not any(r.resolved for r in rows)
        sentences.append(text + (", less than both error bars." if inside else "."))
    return " ".join(sentences) or "No second solid was solved to confirm it."


def _cheaper_models(record: Record) -> str:
    """Return the sentence on cheaper models, those that are enough and those that are not."""
    verdict = record.verdict
    tolerance = short_percent(verdict.tolerance) or "the tolerance"
    out = [record.name(k) for k, m in record.models.items() if m.validity == "no"]
    names = " or ".join(filter(None, (", ".join(out[:-1]), *out[-1:])))
    keep = f"do not use the {names} here" if out else ""
    cheapest = verdict.cheapest
    if cheapest and cheapest != verdict.trust:
        only = " for first bending and below" if record.model(cheapest).family == LUMPED else ""
        enough = f"The {record.name(cheapest)} is enough within {tolerance}{only}"
        return f"{enough}; {keep}." if keep else f"{enough}."
    none = f"No cheaper model was shown to be within {tolerance}"
    return f"{none}: {keep}." if keep else f"{none}."


def stamp(record: Record) -> list[tuple[str, str]]:
    """Return date, version and scene of the run as (name, value)."""
    facts = {
        "scene": record.scene.get("name"),
        "scene hash": scene_hash(record.scene),
        "date": record.environment.get("date"),
        "solidgear": record.environment.get("solidgear"),
    }
    return [(fact, str(value or DASH)) for fact, value in facts.items()]
