"""Tables of the run itself: what it cost, where its numbers come from, meshes and machine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.report.cells import DASH, capital, megabytes
from solidgear.report.table import Table
from solidgear.report.words import model_name, reference_of, seconds


def cost(r: Mapping) -> Table:
    """Seconds of every stage and peak memory."""
    stages: list[str] = []
    for m in r["models"].values():
        stages += [s for s in m.get("seconds") or {} if s not in stages and s != "total"]
    rows = [
        [
            capital(model_name(k)),
            *_times(m, [*stages, "total"]),
            megabytes(m.get("peak_mb")),
            (str(m.get("backend") or DASH), "text"),
        ]
        for k, m in r["models"].items()
    ]
    return Table(
        "Wall time in s and peak memory",
        ["model", *stages, "total", "peak MB", "linear algebra"],
        rows,
        "Times of a single run on the machine named below: good for orders of magnitude.",
    )


def _times(model: Mapping, stages: list[str]) -> list[str]:
    spent = model.get("seconds") or {}
    return [seconds(spent.get(stage), DASH) for stage in stages]


def provenance(r: Mapping) -> Table:
    """Where each class of number comes from."""
    models, reference = r["models"], model_name(reference_of(r))
    ran = ", ".join(model_name(k) for k in models) or "no model"
    rows: list[list[Any]] = [
        [
            "geometry, material, bearings",
            f"input: {r['scene'].get('source') or 'source not given'}; each bearing carries its status, section 1",
        ],
        ["stiffness, compliance, frequencies, mode shapes", f"computed in this run, by: {ran}"],
        [
            "differences",
            f"this run against another model of this run ({reference}); a model-form comparison, not an error against reality",
        ],
        ["mode correlation", f"this run; partners in the {reference}"],
        ["causes, attachments", "this run; the same model solved again with one thing switched"],
        [
            "bands, observed orders",
            "this run; solution verification on similar meshes of the same model",
        ],
        [
            "expected orders",
            "closed form: the corner singularities of the geometry and the element order",
        ],
        ["free motions", "closed form: exact zeros of the formulation, not small computed numbers"],
        ["times, memory", "measured in this run"],
        ["experiment", ("none: nothing in this report is validated against experiment", "strong")],
    ]
    return Table(
        "Where each class of number comes from",
        ["class", "origin"],
        [[a, b if isinstance(b, tuple) else (b, "text")] for a, b in rows],
        css="facts",
    )


def _flat(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{k} {_flat(v)}" for k, v in value.items())
    if isinstance(value, list):
        return ", ".join(_flat(v) for v in value)
    if value is None:
        return DASH
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def pairs_of(mapping: Mapping | None, caption: str) -> Table:
    """A table of a mapping, an entry a row."""
    rows = [[str(k), (_flat(v), "text")] for k, v in (mapping or {}).items()]
    return Table(caption, ["item", "value"], rows, css="facts")


def mesh(r: Mapping) -> list[Table]:
    """One table for each model, of what is known of its mesh."""
    captions = {key: f"{capital(model_name(key))}: mesh" for key in r["models"]}
    tables = [pairs_of(model.get("mesh"), captions[key]) for key, model in r["models"].items()]
    return [table for table in tables if table]
