"""The command that answers a question from the cheapest model."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from solidgear.core import LADDER, OpenNumbers, Scene, SolidgearError
from solidgear.core.judge.answer import Answered, Step
from solidgear.core.judge.answer import answer as solve
from solidgear.core.judge.refinement import Interrupted
from solidgear.core.judge.steps import ABOVE, BELOW
from solidgear.core.models.kinds import PARTS
from solidgear.core.plain import plain
from solidgear.show.command import Progress, caution, command
from solidgear.show.open_words import columns as ranges
from solidgear.show.open_words import remark
from solidgear.show.options import CaseName, SceneFile, Shown, relative
from solidgear.show.remarks import bearing_cautions, load, open_ranges
from solidgear.show.settled import sentences
from solidgear.show.sheet import Sheet, Terminal, present
from solidgear.show.table import Column, Table, text
from solidgear.show.units import Units, units_named
from solidgear.show.words import bar_of, count, percent, seconds

if TYPE_CHECKING:
    from solidgear.core.judge.record import WhereRecord
    from solidgear.core.judge.where import ErrorMap


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
    case: CaseName = None,
    run: Shown,
) -> None:
    if picture is not None:
        from solidgear.show.plot import check_ending  # start-up: for --picture alone

        check_ending(picture)  # before anything is solved
    loaded = load(scene, case)
    for sentence in bearing_cautions(loaded):
        print(caution(sentence), file=sys.stderr)
    units = units_named(run.units)

    def study(progress: Progress) -> Sheet:
        try:
            answered = solve(loaded, tol, ask, progress=progress)
        except Interrupted as stop:  # what a coarser mesh gave is shown
            answered = stop.result
        progress("what the data leave open")
        open_ = open_ranges(loaded)
        places: WhereRecord | str = ""
        drawn = ""
        if where or picture is not None:
            progress("where the error comes from")
            try:
                error_map, bar = _mapped(loaded, answered)
            except SolidgearError as error:
                places = str(error)
            else:
                places = error_map.record.model_copy(update={"total": bar})
                if picture is not None:
                    drawn = _drawn(error_map, picture)
        sheet = answer_sheet(loaded, answered, open_, places, drawn, units)
        # the usual question is of what there is; one that names a number wants that number
        wanted = bool(ask or loaded.ask.quantities)
        return replace(sheet, reached=answered.reached and not (answered.missing and wanted))

    present(study, run)


def answer_sheet(
    scene: Scene,
    answered: Answered,
    open_: OpenNumbers,
    places: WhereRecord | str,
    drawn: str,
    units: Units,
) -> Sheet:
    """Return the sheet of an answer, with the places of its error, or the reason why they are not
    known, and a sentence on their picture; both empty where nobody asked.
    """
    data = answered.as_dict() | {"open": plain(open_)}
    closing: list[str | Table] = [*sentences(answered), *_of_round_part(scene, answered)]
    closing += map(caution, answered.cautions)
    if isinstance(places, str):
        if places:
            data["where"] = {"error": places}
            closing.append(f"Where the error comes from is not known: {places}.")
    else:
        # without the mesh and its cells
        cells = {"model", "points", "cells", "shares"}
        data["where"] = places.model_dump(exclude=cells)
        total, time = percent(places.total, signed=False), seconds(places.seconds)
        by = "by local problems" if places.cells else "in one order more"
        sentence = f"{places.sentence} (a bound {by}, {total}; {time} s)."
        closing += [_where_table(places, units), sentence]
        if drawn:
            closing.append(drawn)
    return Sheet(
        name="answer",
        title=scene.title or scene.name,
        lead="",
        tables=[_values(answered, units, open_), _path(answered)],
        data=data,
        cautions=answered.cautions,
        terminal=Terminal(heading=[], closing=closing),
    )


def _values(answered: Answered, units: Units, open_: OpenNumbers) -> Table:
    notes = []
    if any(row.side in (ABOVE, BELOW) for row in answered.values):
        notes.append("error bar with one sign: the exact value lies on that side only")
    if any(row.quantity.diagonals for row in answered.values):
        notes.append(
            "error bars of couplings: relative to the geometric mean of both diagonal entries"
        )
    columns = [
        text("quantity", lambda row: row.quantity),
        Column("value", lambda row: "0" if row.zero else units.number(row.value, row.unit, 6)),
        text("unit", lambda row: units.unit(row.unit)),
        Column("error bar", bar_of),
        *ranges(open_, lambda row: row.quantity),
        text("error bar by", lambda row: row.how),
    ]
    notes += filter(None, [remark(open_, [row.quantity for row in answered.values])])
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


def _mapped(scene: Scene, answered: Answered) -> tuple[ErrorMap, float]:
    """Return places of the error of the number with the widest bar, on the finest mesh it was
    solved on, and that bar.

    Raises
    ------
    SolidgearError
        Where nothing was answered, or the answer has no error bar by cells.
    """
    from solidgear.core.judge.where import map_error  # start-up: for --where alone

    if not answered.values:
        raise SolidgearError("nothing that was asked for exists in this scene")
    widest = max(answered.values, key=lambda value: value.bar)
    solved = [step for step in _solved(answered) if not step.only or widest.quantity in step.only]
    return map_error(scene, widest.quantity, solved[-1].options, answered.rung), widest.bar


def _drawn(error_map: ErrorMap, picture: Path) -> str:
    """Draw the cells of a meridian, or of the surface of a 3D solid, and return where they are, or
    why they could not be drawn.
    """
    # start-up: for --picture alone
    from solidgear.show.where_chart import draw_where
    from solidgear.show.where_surface import draw_surface

    places = error_map.record
    title = f"Error bar of {places.quantity} by cells, order {places.order}"
    if places.cells:
        draw_where(picture, places, title)
        return f"Picture: {picture}"
    reason = draw_surface(error_map.body, error_map.by_cells, title, picture)
    return f"No picture: {reason}." if reason else f"Picture: {picture}"


def _where_table(places: WhereRecord, units: Units) -> Table:
    """Return places of the error with their shares of it, the largest first."""
    from solidgear.show.where_chart import worth_naming  # start-up: for --where alone

    def length(value: float) -> str:
        return f"{units.value(value, 'm'):.4g}"

    unit = units.unit("m")

    columns = [
        Column(f"error of {places.quantity}", lambda row: row.what),
        Column(f"y, {unit}", lambda row: row.y, length),
        Column(f"r, {unit}", lambda row: "" if row.r is None else row.r, length),
        Column(f"within, {unit}", lambda row: "" if row.reach is None else row.reach, length),
        Column("share", lambda row: row.share, lambda share: f"{100 * share:.1f} %"),
    ]
    return Table("", columns, worth_naming(places.rows))
