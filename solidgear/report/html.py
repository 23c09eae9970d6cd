"""One self-contained HTML page about one run.

`write_report` turns the record of a run into tables and charts and fills ``report.html``, the
template beside this file. The page needs no network and no other file; its one script turns the mode
shapes, and without it pictures stand there.
"""

from __future__ import annotations

import base64
import functools
import logging
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from solidgear.evidence.record import Record, VerdictRecord
from solidgear.machine.whole_file import whole
from solidgear.report import (
    charts,
    evidence_tables,
    input_tables,
    race_tables,
    result_tables,
    run_tables,
)
from solidgear.report.border import as_record
from solidgear.report.cells import DASH, capital, short_percent
from solidgear.report.lumped import lumped_tables
from solidgear.report.reading import model_name, reference_of, validity
from solidgear.report.words import percent, seconds

log = logging.getLogger(__name__)


#: a picture: PNG, JPEG or SVG, in bytes or as a path
Picture = bytes | str | os.PathLike


def write_report(
    found: Record | Mapping[str, Any],
    folder: str | os.PathLike,
    images: Mapping[str, Picture] | None = None,
) -> Path:
    """Write ``report.html`` into `folder`.

    Parameters
    ----------
    found : Record or mapping
        What a run found; parts that are missing are said to be missing.
    folder : path
        Made if it is not there.
    images : mapping, optional
        Renders by model key: PNG, JPEG or SVG, as bytes or as a path. Without it the files that
        the record names are taken from `folder`.

    Returns
    -------
    Path
        Of the page. It appears whole or not at all: an earlier one is replaced in one step.

    Raises
    ------
    SolidgearError
        For plain data that is no record of this version.
    """
    record = as_record(found)
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / "report.html"
    with whole(target) as partial:
        partial.write_text(render_page(record, folder, images), encoding="utf-8")
    return target


def render_page(
    found: Record | Mapping[str, Any],
    folder: str | os.PathLike | None = None,
    images: Mapping[str, Picture] | None = None,
) -> str:
    """The page as text; parameters and errors are those of `write_report`."""
    from markupsafe import Markup

    record = as_record(found)
    warnings = list(record.warnings)
    drawn = _drawn(record, warnings)
    return template("report.html").render(
        **_opening(record),
        warnings=warnings,
        charts={name: Markup(svg.decode()) if svg else None for name, svg in drawn.items()},
        viewer=_viewer(record, folder),
        renders=_renders(record, folder, images),
        race=race_tables.section(folder, record.scene),
        **_tables(record),
    )


def _drawn(record: Record, warnings: list[str]) -> dict[str, bytes | None]:
    """The charts by name; what could not be drawn is added to the warnings."""
    drawn = {}
    for name, chart in charts.CHARTS.items():
        try:
            drawn[name] = chart(record)
        except Exception as error:  # a picture must never cost the reader the numbers
            log.warning("chart %s: %s", name, error, exc_info=True)
            warnings.append(f"the chart of {name} could not be drawn: {error}")
            drawn[name] = None
    return drawn


def _opening(record: Record) -> dict[str, Any]:
    """What the head of the page says: the scene, the verdict, and which models are out."""
    scene, verdict = record.scene, record.verdict
    return {
        "title": scene.get("title") or scene.get("name") or "shaft",
        "scene": scene,
        "verdict": None if verdict == VerdictRecord() else verdict,
        "free": record.port.free if record.port else [],
        "where": _where(record),
        "complete": record.complete,
        "missing": record.missing,
        "trusted": _name_or_none(record, verdict.trust),
        "cheapest": _name_or_none(record, verdict.cheapest),
        "tolerance": short_percent(verdict.tolerance),
        "reference": _name_or_none(record, reference_of(record)),
        "distrusted": _reasons(record, "no", "not valid for this scene"),
        "undecided": _reasons(record, "open", "not judged"),
    }


def _where(record: Record) -> dict[str, Any] | None:
    """What is said of where the error of the judge sits."""
    found = record.where
    if found is None:
        return None
    return {
        "sentence": found.sentence,
        "order": found.order,
        "name": model_name(record, found.model),
        "total": percent(found.total, signed=False),
    }


def _name_or_none(record: Record, key: str | None) -> str | None:
    return model_name(record, key) if key else None


def _reasons(record: Record, worth: str, default: str) -> list[tuple[str, str]]:
    """Names of the models of one worth (see `validity`), each with the reason."""
    chosen = {key: model for key, model in record.models.items() if validity(model) == worth}
    return [(model_name(record, key), m.why_not or default) for key, m in chosen.items()]


def _tables(record: Record) -> dict[str, Any]:
    """All tables of the page, by their names in the template."""
    return {
        "scene_facts": input_tables.scene_facts(record),
        "segments": input_tables.segments(record.scene),
        "bearings": input_tables.bearings(record.scene),
        "bearing_range": input_tables.bearing_range(record.bearing_range),
        "masses": input_tables.masses(record.scene),
        "summary": result_tables.summary(record),
        "matrices": result_tables.matrices(record),
        "frequencies": result_tables.frequencies(record),
        "deviations": evidence_tables.deviations(record),
        "causes": evidence_tables.causes(record),
        "lumped": lumped_tables(record),
        "attachments": evidence_tables.attachments(record),
        "levels": evidence_tables.levels(record),
        "orders": evidence_tables.orders(record),
        "algebra": evidence_tables.algebra(record),
        "pairs": evidence_tables.pairs(record),
        "cost": run_tables.cost(record),
        "provenance": run_tables.provenance(record),
        "environment": run_tables.pairs_of(record.environment, "Environment of the run"),
        "mesh": run_tables.mesh(record),
        "total": seconds(record.seconds_total, DASH),
    }


@functools.cache
def template(name: str):
    """A page beside this file, ready to be filled."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(Path(__file__).parent)
    return Environment(
        loader=loader,
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    ).get_template(name)


def _renders(
    record: Record, folder: str | os.PathLike | None, images: Mapping[str, Picture] | None
) -> list[tuple[str, str | None]]:
    """(caption, data URI or None when the picture could not be had)."""
    if images is None:
        images = _named_images(record, folder)
    renders = []
    for key, image in images.items():
        renders.append((capital(model_name(record, key)), data_uri(key, image)))
    return renders


def _viewer(record: Record, folder: str | os.PathLike | None) -> Any:
    """The mode shapes to be turned, from the page that the run has written beside this one."""
    from markupsafe import Markup

    from solidgear.report.viewer import TURNED, fragment_of

    here = folder is not None and TURNED in (record.files or ())
    return Markup(fragment_of(Path(folder) / TURNED)) if folder is not None and here else ""


def _named_images(record: Record, folder: str | os.PathLike | None) -> dict[str, Picture]:
    """The files that a record names, only those inside the folder of the report: results must not
    pull in others.
    """
    if folder is None:
        return {}
    return {key: Path(folder) / Path(name).name for key, name in record.images.items()}


def data_uri(key: str, image: Any) -> str | None:
    """A picture in bytes or in a file as a data URI; None if it cannot be had or is none."""
    try:
        in_memory = isinstance(image, (bytes, bytearray, memoryview))
        data = bytes(image) if in_memory else Path(image).read_bytes()
    except OSError as error:
        log.warning("render of %s: %s", key, error)
        return None
    kind = _picture_kind(data)
    if kind is None:
        return None
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


def _picture_kind(data: bytes) -> str | None:
    """The kind of a picture by its first bytes."""
    if data[:4] == b"\x89PNG":
        return "png"
    if data[:2] == b"\xff\xd8":
        return "jpeg"
    return "svg+xml" if b"<svg" in data[:1000] else None
