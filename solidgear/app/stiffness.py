"""The command that tells stiffness and compliance at one lumped point, or between several."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations_with_replacement
from typing import Annotated

import numpy as np
import typer

from solidgear.core import (
    COMPLIANCE,
    DOF_NAMES,
    STIFFNESS,
    Port,
    Quantity,
    Scene,
    SolidgearError,
    number_cautions,
)
from solidgear.core.body import as_supports
from solidgear.core.errors import NoBounds
from solidgear.core.judge.bounded import static_bars
from solidgear.core.machine.memory import NoRoom
from solidgear.core.plain import plain
from solidgear.core.scene.rules import no_such_point
from solidgear.core.solve.condensed import Condensed, Coupled
from solidgear.core.solve.statics import condense
from solidgear.show.command import Progress, caution, command
from solidgear.show.open_words import table as open_table
from solidgear.show.options import CaseName, SceneFile, Shown, Solved
from solidgear.show.remarks import cautions, load, open_ranges
from solidgear.show.settled import Judged, bar_lines, largest_bar, source_of_bars
from solidgear.show.sheet import Sheet, Terminal, present
from solidgear.show.table import Column, Table
from solidgear.show.terminal import matrix_table
from solidgear.show.units import Units, units_named
from solidgear.show.words import plus_minus


@command
def stiffness(
    scene: SceneFile,
    *,
    model: Solved,
    port: Annotated[
        str | None,
        typer.Option(
            help="Lumped point, by name; several with commas for the stiffness between them. By "
            "default the main point."
        ),
    ] = None,
    attachment: Annotated[
        str | None,
        typer.Option(
            help="average, rigid or section for every port; by default as the scene says."
        ),
    ] = None,
    case: CaseName = None,
    run: Shown,
) -> None:
    loaded = load(scene, case)
    if attachment:
        loaded = loaded.with_attachment(attachment)
    names = _points(loaded, port)
    loaded = loaded.with_main_port(names[0])
    units = units_named(run.units)

    def study(progress: Progress) -> Sheet:
        body, settled = model.body(loaded, "stiffness", progress, names[1:])
        bars = settled.bars if settled is not None else {}
        reason = model.without_bars(settled)
        if settled is None and not reason:
            try:
                bars = static_bars(loaded, body, as_supports(loaded), names)
            except (NoBounds, NoRoom) as error:
                reason = str(error)
        statics = condense(body, loaded, names if len(names) > 1 else names[0])
        open_ = open_ranges(loaded, body)
        said = [*cautions(loaded, body), *number_cautions(loaded, model=body.fidelity)]
        judged = Judged(loaded, body, settled, bars, reason, said, open_)
        return stiffness_sheet(statics, judged, units)

    present(study, run)


def _points(scene: Scene, port: str | None) -> tuple[str, ...]:
    """Return the names in ``--port``; by default the main point."""
    points = [point.name for point in scene.ports]
    if port is None:
        return (scene.port.name,)
    # a name may have a comma of its own
    names = [port] if port in points else [part.strip() for part in port.split(",")]
    for name in names:
        if name not in points:
            raise SolidgearError(f"--port: {no_such_point(name, points)}")
        if names.count(name) > 1:
            raise SolidgearError(f"--port {port}: {name} is named twice; name each point once")
    return tuple(names)


def stiffness_sheet(statics: Condensed | Coupled, judged: Judged, units: Units) -> Sheet:
    """Return the sheet of one lumped point, or of several."""
    settled, bars = judged.settled, judged.bars
    data = {"scene": judged.scene.name, "model": judged.body.fidelity} | plain(statics)
    data |= {"unknowns": judged.body.size, "evidence": plain(statics.evidence)}
    data |= {"cautions": judged.cautions} | ({"bars": bars} if settled is None else plain(settled))
    data |= {"why_without_bar": judged.reason, "open": plain(judged.open)}
    head = judged.heading
    closing: list[str | Table] = []
    if isinstance(statics, Condensed):
        place = _at(judged.scene.port, units)
        head += f", port {statics.port!r} at {place} ({statics.attachment})"
        tables = [
            matrix_table(statics.stiffness, STIFFNESS, units),
            matrix_table(statics.compliance, COMPLIANCE, units),
        ]
        closing += _free(statics)
        point = statics.port
    else:
        places = {port.name: _at(port, units) for port in judged.scene.ports}
        ports = (
            f"{name!r} at {places[name]} ({kind})"
            for name, kind in zip(statics.ports, statics.attachments)
        )
        head += f", ports {', '.join(ports)}"
        tables = _between(statics, units)
        closing += [*_free_together(statics), *([_bars(bars, statics)] if bars else [])]
        point = statics.ports[0]
    if judged.open.inputs:
        closing.append(open_table(judged.open, bars, units))
    if settled is not None:
        closing += bar_lines(settled)
    elif judged.reason:
        closing.append(f"No error bars: {judged.reason}.")
    else:
        closing += [*largest_bar(bars, point), source_of_bars(judged.body.fidelity)]
    return Sheet(
        name="stiffness",
        title=head,
        lead="",
        tables=tables,
        data=data,
        cautions=judged.cautions,
        reached=judged.reached,
        terminal=Terminal(closing=[*closing, *map(caution, judged.cautions)]),
    )


def _at(port: Port, units: Units) -> str:
    """Return the place of a lumped point."""
    unit = units.unit("m")
    decimals = 3 if unit == "mm" else 4
    place = (port.y,) if port.patch is None else port.patch.point
    numbers = ", ".join(f"{units.value(v, 'm'):.{decimals}f}" for v in place)
    return f"y = {numbers} {unit}" if port.patch is None else f"({numbers}) {unit}"


def _free(condensed: Condensed) -> Iterator[str]:
    """Yield sentences on motions that nothing resists."""
    if condensed.free_names:
        yield f"Free: {', '.join(condensed.free_names)} (stiffness exactly zero)."
    for motion in condensed.oblique.T:
        moved = [(v, n) for v, n in zip(motion, DOF_NAMES) if abs(v) > 1e-9]
        parts = ", ".join(f"{v:.4g} {n}" for v, n in moved)
        names = " and ".join(n for _, n in moved)
        yield f"Free: the motion ({parts}), m and rad; {names} have no compliance."


def _between(coupled: Coupled, units: Units) -> list[Table]:
    """Return the blocks of every pair of points."""
    kinds = {STIFFNESS: ("load on", "motion of"), COMPLIANCE: ("motion of", "load on")}
    if not np.isfinite(coupled.stiffness).all():
        del kinds[STIFFNESS]
    tables = []
    for kind, (rows, columns) in kinds.items():
        for a, b in combinations_with_replacement(coupled.ports, 2):
            sizes = [np.diag(coupled.between(end, end, kind)).tolist() for end in (a, b)]
            title = f"{kind}: {rows} {a}, {columns} {b}"
            matrix = coupled.between(a, b, kind)
            tables.append(matrix_table(matrix, kind, units, title, sizes))
    return tables


def _free_together(coupled: Coupled) -> Iterator[str]:
    """Yield sentences on what the blocks hold, and on motions that nothing resists."""
    several = "both points" if len(coupled.ports) == 2 else "all points"
    if np.isfinite(coupled.stiffness).all():
        yield (
            f"Stiffness is with {several} held but for one motion. Blocks left out are the "
            "transposed ones."
        )
    else:
        yield "The points move almost as one, so that a stiffness between them has no digits."
    if coupled.free_names:
        yield (
            f"Free: {', '.join(coupled.free_names)} of {several} together; only their relative "
            "motion is resisted, and has no entry in the compliance."
        )


def _bars(bars: Mapping[Quantity, float], coupled: Coupled) -> Table:
    """Return the largest error bar of every block."""
    largest: dict[tuple[str, ...], float] = {}
    for name, bar in bars.items():
        if name.pair or name.kind == COMPLIANCE:  # what one point resists alone is not told here
            point = next(iter(name.points), coupled.ports[0])
            key = (name.kind, *sorted(name.pair or (point, point), key=coupled.ports.index))
            largest[key] = max(bar, largest.get(key, 0.0))
    columns = [
        Column(
            "largest error bar of a block",
            lambda pair: (
                "{} itself".format(*pair)
                if pair[0] == pair[1]
                else "between {} and {}".format(*pair)
            ),
        ),
        Column(STIFFNESS, lambda pair: largest.get((STIFFNESS, *pair)), plus_minus),
        Column(COMPLIANCE, lambda pair: largest.get((COMPLIANCE, *pair)), plus_minus),
    ]
    note = "couplings: relative to the geometric mean of both diagonal entries"
    return Table("", columns, list(combinations_with_replacement(coupled.ports, 2)), note)
