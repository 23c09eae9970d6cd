"""The command that answers a question from the cheapest model."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import LADDER, OpenNumbers, Scene, SolidgearError, WhereRecord
from solidgear.core.judge.answer import Answered, Step
from solidgear.core.judge.answer import answer as solve
from solidgear.core.judge.steps import ABOVE, BELOW
from solidgear.core.judge.where import error_places
from solidgear.core.models.kinds import PARTS
from solidgear.show.command import NOT_REACHED, caution, command, say
from solidgear.show.open_words import columns as ranges
from solidgear.show.open_words import remark
from solidgear.show.options import SceneFile, Shown, relative
from solidgear.show.plot import check_ending
from solidgear.show.remarks import bearing_cautions, load, open_ranges
from solidgear.show.settled import sentences
from solidgear.show.table import Column, Table, text
from solidgear.show.units import units_named
from solidgear.show.where_chart import draw_where, worth_naming
from solidgear.show.words import bar_of, count, percent, seconds


@command
def answer(
    scene: SceneFile,
    *,
    tol: Annotated[
        float | None,
        relative("--tol", "Relative error allowed, such as 1e-3; else the scene's own."),
    ] = None,
    ask: Annotated[
        str,
        typer.Option(
            "--ask",
            help="Comma-separated: C_zz, K_thx, bending, f1 (the lowest), ..., C_zz@gear at "
            "another point, C_zz@wheel@pinion between two points; by default what the scene "
            "asks for.",
        ),
    ] = "",
    where: Annotated[
        bool,
        typer.Option(
            "--where", help="Also show where in the shaft the error of the answer comes from."
        ),
    ] = False,
    picture: Annotated[
        Path | None,
        typer.Option(
            "--picture",
            help="Picture of where the error comes from: a file that ends in .png or .svg.",
        ),
    ] = None,
    run: Shown,
) -> None:
    if picture is not None:
        check_ending(picture)  # before anything is solved
    loaded = load(scene)
    for sentence in bearing_cautions(loaded):
        print(caution(sentence), file=sys.stderr)
    places: WhereRecord | None = None
    unplaced = ""
    with run.progress() as progress:
        answered = solve(loaded, tol, ask, progress=progress)
        progress("what the data leave open")
        open_ = open_ranges(loaded)
        if where or picture is not None:
            progress("where the error comes from")
            try:
                places = _places(loaded, answered)
            except SolidgearError as error:
                unplaced = str(error)
    if places is not None and picture is not None:
        _draw(places, picture)
    if run.as_json:
        out = answered.as_dict() | {"open": open_.model_dump(mode="json")}
        if where or picture is not None:
            out["where"] = {"error": unplaced}
            if places is not None:  # without the mesh and its cells
                cells = {"model", "points", "cells", "shares"}
                out["where"] = places.model_dump(exclude=cells)
        print(json.dumps(out, allow_nan=False))
    else:
        say(_values(answered, run.units, open_), _path(answered))
        say(*sentences(answered), *_of_round_part(loaded, answered))
        if places is not None:
            say(_where_table(places), _sentence(places))
        if unplaced:
            say(f"Where the error comes from is not known: {unplaced}.")
        if places is not None and picture is not None:
            say(f"Picture: {picture}")
    # the usual question is of what there is; one that names a number wants that number
    if not answered.reached or answered.missing and (ask or loaded.ask.quantities):
        raise typer.Exit(NOT_REACHED)


def _values(answered: Answered, units: str, open_: OpenNumbers) -> Table:
    chosen = units_named(units)
    notes = []
    if any(row.side in (ABOVE, BELOW) for row in answered.values):
        notes.append("error bar with one sign: the exact value lies on that side only")
    if any(row.quantity.diagonals for row in answered.values):
        notes.append(
            "error bars of couplings: relative to the geometric mean of both diagonal entries"
        )
    columns = [
        text("quantity", lambda row: row.quantity),
        Column("value", lambda row: "0" if row.zero else chosen.number(row.value, row.unit, 6)),
        text("unit", lambda row: chosen.unit(row.unit)),
        Column("error bar", bar_of),
        *ranges(open_, lambda row: row.quantity),
        text("error bar by", lambda row: row.how),
    ]
    notes += filter(None, [remark(open_)])
    return Table("", columns, answered.values, "\n".join(notes))


def _path(answered: Answered) -> Table:
    columns = [
        text("model", lambda step: f"{step.rung}, chosen" if step.chosen else step.rung),
        text("mesh", lambda step: step.setting),
        Column("unknowns", lambda step: step.unknowns, count),
        Column("error bar", lambda step: percent(step.bar, signed=False)),
        Column("time, s", lambda step: step.seconds, seconds),
    ]
    return Table("", columns, _solved(answered))


def _solved(answered: Answered) -> list[Step]:
    return [step for step in answered.steps if step.unknowns is not None]


def _of_round_part(scene: Scene, answered: Answered) -> list[str]:
    """Return a remark where numbers of a mesh file are for its round part."""
    body = scene.body
    if body is None or not body.one_mesh or PARTS in LADDER[answered.rung].holds:
        return []
    return [
        f"These numbers are for the round part of {body.name}, whose volume differs by "
        f"{percent(body.round_volume - 1)} from the mesh; the mesh itself is solved by stiffness "
        f"and modes with -f solid, {'and judged by compare' if body.coarser else 'without an error bar'}."
    ]


def _places(scene: Scene, answered: Answered) -> WhereRecord:
    """Return places of the error of the number with the widest bar, on the finest mesh it was
    solved on.

    Raises
    ------
    SolidgearError
        For the answer of another model than the harmonic solid, or where nothing was answered.
    """
    if answered.rung != "harmonic":
        raise SolidgearError(
            "only the harmonic solid shows it, and this answer is by the "
            f"{LADDER[answered.rung].title}"
        )
    if not answered.values:
        raise SolidgearError("nothing that was asked for exists in this scene")
    widest = max(answered.values, key=lambda value: value.bar)
    solved = [step for step in _solved(answered) if not step.only or widest.quantity in step.only]
    places = error_places(scene, widest.quantity, solved[-1].options)
    return places.model_copy(update={"total": widest.bar})


def _where_table(places: WhereRecord) -> Table:
    """Return places of the error with their shares of it, the largest first."""

    def millimetres(value: float) -> str:
        return f"{1e3 * value:.4g}"

    columns = [
        Column(f"error of {places.quantity}", lambda row: row.what),
        Column("y, mm", lambda row: row.y, millimetres),
        Column("r, mm", lambda row: "" if row.r is None else row.r, millimetres),
        Column("within, mm", lambda row: "" if row.reach is None else row.reach, millimetres),
        Column("share", lambda row: row.share, lambda share: f"{100 * share:.1f} %"),
    ]
    return Table("", columns, worth_naming(places.rows))


def _sentence(places: WhereRecord) -> str:
    """Return the sentence on the places with most of the error."""
    total = percent(places.total, signed=False)
    return f"{places.sentence} (a bound by local problems, {total}; {seconds(places.seconds)} s)."


def _draw(places: WhereRecord, picture: Path) -> None:
    """Write a picture of the mesh, every cell with its share of the error."""
    title = f"Error bar of {places.quantity} by cells, order {places.order}"
    draw_where(picture, places, title)
