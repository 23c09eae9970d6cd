"""The command that tells stiffness and compliance at one lumped point, or between several."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
import typer

from solidgear.core import COMPLIANCE, DOF_NAMES, STIFFNESS, Port, Quantity, Scene, SolidgearError
from solidgear.core.judge.coarser_mesh import static_bars
from solidgear.core.plain import plain
from solidgear.core.scene.rules import no_such_point
from solidgear.core.solve.condensed import Condensed, Coupled
from solidgear.core.solve.statics import condense
from solidgear.show.command import caution, command, say
from solidgear.show.open_words import table as open_table
from solidgear.show.options import SceneFile, Shown, Solved, options
from solidgear.show.remarks import cautions, load, open_ranges
from solidgear.show.settled import SECOND_MESH, bar_lines, ended, heading, largest_bar
from solidgear.show.table import Column, Table
from solidgear.show.terminal import matrix_table
from solidgear.show.units import units_named
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
    run: Shown,
) -> None:
    loaded = load(scene)
    if attachment:
        loaded = loaded.with_attachment(attachment)
    names = _points(loaded, port)
    loaded = loaded.with_main_port(names[0])
    body, settled = model.body(loaded, "stiffness", names[1:])
    condensed = condense(body, loaded, names[0])
    coupled = condense(body, loaded, names) if len(names) > 1 else None
    bars = settled.bars if settled is not None else {}
    if settled is None and model.on_two_meshes:
        bars = static_bars(loaded, body, names, options(model.pairs))
    reason = model.without_bars(bars, settled, loaded, body)
    warnings = cautions(loaded, body)
    open_ = open_ranges(loaded, body)

    if run.as_json:
        record: dict[str, Any] = {"scene": loaded.name, "fidelity": body.fidelity}
        at_points = condensed if coupled is None else coupled
        record |= plain(at_points)
        record |= {"dofs": body.size, "evidence": at_points.evidence, "cautions": warnings}
        record |= {"bars": bars} if settled is None else plain(settled)
        record |= {"why_without_bar": reason}
        print(json.dumps(record | {"open": open_.model_dump(mode="json")}))
        ended(settled)
        return
    head = heading(loaded, body, settled)
    if coupled is None:
        _tell(head, loaded, condensed, run.units)
    else:
        _tell_coupled(head, loaded, coupled, run.units)
        if bars:
            say(_bars(bars, coupled))
    if open_.inputs:
        say(open_table(open_, bars, units_named(run.units)))
    if settled is None:
        lines = [f"No error bars: {reason}."] if reason else largest_bar(bars, names[0])
        say(*lines, *([] if reason else [SECOND_MESH]))
    say(*bar_lines(settled))
    say(*map(caution, warnings), soft_wrap=False)
    ended(settled)


def _points(scene: Scene, port: str | None) -> tuple[str, ...]:
    """Return the names in ``--port``; by default the main point."""
    points = [point.name for point in scene.ports]
    if port is None:
        return (points[0],)
    # a name may have a comma of its own
    names = [port] if port in points else [part.strip() for part in port.split(",")]
    for name in names:
        if name not in points:
            raise SolidgearError(f"--port: {no_such_point(name, points)}")
        if names.count(name) > 1:
            raise SolidgearError(f"--port {port}: {name} is named twice; name each point once")
    return tuple(names)


def _at(port: Port) -> str:
    """Return the place of a lumped point, mm."""
    if port.patch is None:
        return f"y = {1e3 * port.y:.3f}"
    return "({})".format(", ".join(f"{1e3 * v:.3f}" for v in port.patch.point))


def _tell(head: str, scene: Scene, condensed: Condensed, units: str) -> None:
    say(
        f"{head}, port {condensed.port!r} at {_at(scene.port)} mm ({condensed.attachment})",
        matrix_table(condensed.stiffness, "stiffness", units),
        matrix_table(condensed.compliance, "compliance", units),
        soft_wrap=False,
    )
    if condensed.free_names:
        say(f"Free: {', '.join(condensed.free_names)} (stiffness exactly zero).")
    for motion in condensed.oblique.T:
        moved = [(v, n) for v, n in zip(motion, DOF_NAMES) if abs(v) > 1e-9]
        parts = ", ".join(f"{v:.4g} {n}" for v, n in moved)
        names = " and ".join(n for _, n in moved)
        line = f"Free: the motion ({parts}), m and rad; {names} have no compliance."
        say(line)


def _bars(bars: Mapping[Quantity, float], coupled: Coupled) -> Table:
    """Return the largest error bar of every block."""
    largest: dict[tuple[str, ...], float] = {}
    for name, bar in bars.items():
        if name.pair or name.kind == COMPLIANCE:  # what one point resists alone is not told here
            point = next(iter(name.points), coupled.ports[0])
            key = (name.kind, *sorted(name.pair or (point, point), key=coupled.ports.index))
            largest[key] = max(bar, largest.get(key, 0.0))
    pairs = [(a, b) for k, a in enumerate(coupled.ports) for b in coupled.ports[k:]]
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
    return Table("", columns, pairs, note)


def _tell_coupled(head: str, scene: Scene, coupled: Coupled, units: str) -> None:
    places = {port.name: _at(port) for port in scene.ports}
    ports = ", ".join(
        f"{name!r} at {places[name]} mm ({kind})"
        for name, kind in zip(coupled.ports, coupled.attachments)
    )
    say(f"{head}, ports {ports}", soft_wrap=False)
    pairs = [(a, b) for k, a in enumerate(coupled.ports) for b in coupled.ports[k:]]
    stiff = bool(np.isfinite(coupled.stiffness).all())
    for kind in ("stiffness", "compliance") if stiff else ("compliance",):
        for a, b in pairs:
            rows = {"stiffness": "load on", "compliance": "motion of"}[kind]
            columns = {"stiffness": "motion of", "compliance": "load on"}[kind]
            caption = f"{kind}: {rows} {a}, {columns} {b}"
            diagonals = [np.diag(coupled.between(point, point, kind)).tolist() for point in (a, b)]
            say(matrix_table(coupled.between(a, b, kind), kind, units, caption, diagonals))
    several = "both points" if len(coupled.ports) == 2 else "all points"
    if stiff:
        line = (
            f"Stiffness is with {several} held but for one motion. Blocks left out are the "
            "transposed ones."
        )
    else:
        line = "The points move almost as one, so that a stiffness between them has no digits."
    say(line)
    if coupled.free_names:
        names = ", ".join(coupled.free_names)
        line = (
            f"Free: {names} of {several} together; only their relative motion is resisted, and "
            "has no entry in the compliance."
        )
        say(line)
