"""Tables of the run itself: what it cost, where its numbers come from, meshes and machine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.core import Record
from solidgear.show.reading import model_name, reference_of
from solidgear.show.table import Cell, Column, Table, text
from solidgear.show.words import DASH, capital, seconds, whole

#: stages of work that a reader knows by another word than the record does
STAGES = {"band": "error bars"}


def cost(record: Record) -> Table:
    """Return seconds of every stage and peak memory."""
    stages = dict.fromkeys(s for m in record.models.values() for s in m.seconds if s != "total")
    columns = [
        Column("model", lambda item: capital(model_name(record, item[0]))),
        *(_stage(stage) for stage in (*stages, "total")),
        Column("peak MB", lambda item: item[1].peak_mb, whole),
        text("linear algebra", lambda item: item[1].backend or None),
    ]
    return Table(
        "Wall time in s and peak memory",
        columns,
        list(record.models.items()),
        "Times of a single run on the machine named below: orders of magnitude only.",
    )


def _stage(name: str) -> Column:
    return Column(STAGES.get(name, name), lambda item: item[1].seconds.get(name), seconds)


def provenance(record: Record) -> Table:
    """Return the table of the origin of each class of number."""
    reference = model_name(record, reference_of(record))
    ran = ", ".join(model_name(record, key) for key in record.models) or "no model"
    source = record.scene.get("source") or "source not given"
    rows: list[list[Any]] = [
        ["geometry, material, bearings", f"input: {source}; each bearing carries its status"],
        ["stiffness, compliance, modes", f"this run, by: {ran}"],
        [
            "differences, correlation",
            f"this run, against its {reference}, not against reality",
        ],
        ["causes, attachments", "this run: the same model solved again with one thing switched"],
        ["error bars", "this run: solution verification on related meshes of the same model"],
        ["expected orders, free motions", "closed form"],
        [
            "experiment",
            Cell(
                "free solids against measured resonances; not bearings, seats, cuts and teeth",
                "strong",
            ),
        ],
    ]
    return Table(
        "Where each class of number comes from", ["class", text("origin")], rows, style="facts"
    )


def _flat(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{k} {_flat(v)}" for k, v in value.items())
    if isinstance(value, list):
        return ", ".join(_flat(v) for v in value)
    if value is None:
        return DASH
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def pairs_of(mapping: Mapping[str, Any], caption: str) -> Table:
    """Return a table of a mapping, an entry a row."""
    rows = [[str(key), _flat(value)] for key, value in mapping.items()]
    return Table(caption, ["item", text("value")], rows, style="facts")


def mesh(record: Record) -> Table:
    """Return facts of every mesh, a model a row."""
    rows = [
        [capital(model_name(record, key)), _flat(model.mesh)]
        for key, model in record.models.items()
        if model.mesh
    ]
    return Table("Meshes", ["model", text("mesh")], rows, style="facts")
