"""One self-contained HTML page about one run.

`write_report` turns the results of a run (the dict that is also ``results.json``) into tables and
charts and fills ``report.html``, the template beside this file. The page needs no network, no
script and no other file.
"""

from __future__ import annotations

import base64
import functools
import logging
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from solidgear.fidelity.ladder import LADDER
from solidgear.machine.whole_file import whole
from solidgear.report import (
    charts,
    evidence_tables,
    input_tables,
    race_tables,
    result_tables,
    run_tables,
)
from solidgear.report.cells import DASH, capital, short_percent
from solidgear.report.lumped import lumped_tables
from solidgear.report.words import model_name, plain, reference_of, seconds, validity

log = logging.getLogger(__name__)


def write_report(
    results: Mapping,
    folder: str | os.PathLike,
    images: Mapping[str, bytes | str | os.PathLike] | None = None,
) -> Path:
    """Write ``report.html`` into `folder`.

    Parameters
    ----------
    results : mapping
        What a run found, as in ``results.json``; parts that are missing are said to be missing.
    folder : path
        Made if it is not there.
    images : mapping, optional
        Renders by model key: PNG, JPEG or SVG, as bytes or as a path. Without it the files that
        ``results["images"]`` names are taken from `folder`.

    Returns
    -------
    Path
        Of the page. It appears whole or not at all: an earlier one is replaced in one step.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / "report.html"
    with whole(target) as partial:
        partial.write_text(render_page(results, folder, images), encoding="utf-8")
    return target


def render_page(
    results: Mapping,
    folder: str | os.PathLike | None = None,
    images: Mapping[str, bytes | str | os.PathLike] | None = None,
) -> str:
    """The page as text; the parameters are those of `write_report`."""
    from markupsafe import Markup

    r = plain(results)
    for part in ("models", "scene", "verdict"):
        r[part] = r.get(part) or {}
    warnings = [str(w) for w in r.get("warnings") or []]
    drawn = _drawn(r, warnings)
    return _template().render(
        **_opening(r),
        warnings=warnings,
        charts={name: Markup(svg.decode()) if svg else None for name, svg in drawn.items()},
        renders=_renders(r, folder, images),
        race=race_tables.section(folder, r["scene"]),
        **_tables(r),
    )


def _drawn(r: Mapping, warnings: list[str]) -> dict[str, bytes | None]:
    """The charts by name; what could not be drawn is added to the warnings."""
    drawn = {}
    for name, chart in charts.CHARTS.items():
        try:
            drawn[name] = chart(r)
        except Exception as error:  # a picture must never cost the reader the numbers
            log.warning("chart %s: %s", name, error, exc_info=True)
            warnings.append(f"the chart of {name} could not be drawn: {error}")
            drawn[name] = None
    return drawn


def _opening(r: Mapping) -> dict[str, Any]:
    """What the head of the page says: the scene, the verdict, and which models are out."""
    scene, verdict, models = r["scene"], r["verdict"], r["models"]
    return {
        "title": scene.get("title") or scene.get("name") or "shaft",
        "scene": scene,
        "verdict": verdict,
        "port": r.get("port") or scene.get("port") or {},
        "complete": r.get("complete", True),
        "missing": [model_name(k) for k in LADDER.bodies if k not in models],
        "trusted": _name_or_none(verdict.get("trust")),
        "cheapest": _name_or_none(verdict.get("cheapest")),
        "tolerance": short_percent(verdict.get("tolerance")),
        "reference": _name_or_none(reference_of(r)),
        "distrusted": _reasons(models, "no", "not valid for this scene"),
        "undecided": _reasons(models, "open", "it cannot be told"),
    }


def _name_or_none(key: str | None) -> str | None:
    return model_name(key) if key else None


def _reasons(models: Mapping, worth: str, default: str) -> list[tuple[str, str]]:
    """Names of the models of one worth (see `validity`), each with the reason."""
    chosen = {k: m for k, m in models.items() if validity(m) == worth}
    return [(model_name(k), m.get("why_not") or default) for k, m in chosen.items()]


def _tables(r: Mapping) -> dict[str, Any]:
    """All tables of the page, by their names in the template."""
    return {
        "scene_facts": input_tables.scene_facts(r),
        "segments": input_tables.segments(r["scene"]),
        "bearings": input_tables.bearings(r["scene"]),
        "summary": result_tables.summary(r),
        "matrices": result_tables.matrices(r),
        "frequencies": result_tables.frequencies(r),
        "deviations": evidence_tables.deviations(r),
        "causes": evidence_tables.causes(r),
        "lumped": lumped_tables(r),
        "attachments": evidence_tables.attachments(r),
        "levels": evidence_tables.levels(r),
        "orders": evidence_tables.orders(r),
        "algebra": evidence_tables.algebra(r),
        "pairs": evidence_tables.pairs(r),
        "cost": run_tables.cost(r),
        "provenance": run_tables.provenance(r),
        "environment": run_tables.pairs_of(r.get("environment"), "Environment of the run"),
        "mesh": run_tables.mesh(r),
        "total": seconds(r.get("seconds_total"), DASH),
    }


@functools.cache
def _template():
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(Path(__file__).parent)
    return Environment(
        loader=loader,
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    ).get_template("report.html")


def _renders(r: Mapping, folder: Any, images: Mapping | None) -> list[tuple[str, str | None]]:
    """(caption, data URI or None when the picture could not be had)."""
    if images is None:
        images = _named_images(r, folder)
    return [(capital(model_name(key)), _data_uri(key, image)) for key, image in images.items()]


def _named_images(r: Mapping, folder: Any) -> dict[str, Path]:
    """The files that a run names, only those inside the folder of the report: a results file must
    not pull in others.
    """
    if folder is None:
        return {}
    named = r.get("images") or {}
    return {key: Path(folder) / Path(str(name)).name for key, name in named.items()}


def _data_uri(key: str, image: Any) -> str | None:
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
