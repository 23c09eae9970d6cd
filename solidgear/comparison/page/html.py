"""One self-contained HTML page about one run.

`write_report` turns the record of a run into tables and charts and fills ``report.html``, the
template beside this file: page one with the answer, a part for the customer, an appendix for the
engineer. The page needs no network and no other
file; its one script turns the mode shapes, and without it pictures stand there.
"""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any, NamedTuple

from solidgear.comparison.page import charts, evidence_tables, front, point_tables, result_tables
from solidgear.comparison.page.lumped import lumped_tables
from solidgear.comparison.race import tables as race_tables
from solidgear.core import Record, whole
from solidgear.core.judge.record import VerdictRecord
from solidgear.show import open_words, run_tables
from solidgear.show.page_parts import Contents, data_uri, template
from solidgear.show.reading import model_name, reference_of
from solidgear.show.units import Units, units_named
from solidgear.show.viewer import TURNED, fragment_of
from solidgear.show.words import capital, percent, seconds
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
        "stamp": front.stamp(record),
        "numbers": front.numbers(record, units),
        "reasons": front.reasons(record),
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
    scene, shown_key = record.scene, front.shown_model(record)
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
        "points": point_tables.points(record, units),
        "point_matrices": point_tables.matrices(record, units),
        "frequencies": result_tables.frequencies(record),
        "deviations": evidence_tables.deviations(record, units),
        "causes": evidence_tables.causes(record),
        "lumped": lumped_tables(record),
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
    shown_key = front.shown_model(record)
    renders: dict[str, list[tuple[str, str | None]]] = {"own_renders": [], "other_renders": []}
    for key, name in record.images.items():
        picture = capital(model_name(record, key)), data_uri(key, folder / Path(name).name)
        renders["own_renders" if key == shown_key else "other_renders"].append(picture)
    return renders
