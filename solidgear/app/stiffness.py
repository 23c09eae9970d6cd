"""The command that tells stiffness and compliance at one lumped point, or between several."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
import typer

from solidgear.core.errors import SolidgearError
from solidgear.core.frames import DOF_NAMES
from solidgear.core.judge.coarser_mesh import static_bars
from solidgear.core.quantity import COMPLIANCE, STIFFNESS, Quantity
from solidgear.core.scene import Port, Scene
from solidgear.core.scene.rules import no_such_point
from solidgear.core.solve.condensed import Condensed, Coupled
from solidgear.core.solve.statics import condense
from solidgear.guards.check import cautions
from solidgear.show.arguments import load
from solidgear.show.command import caution, command, say
from solidgear.show.open_words import table as open_table
from solidgear.show.options import SceneFile, Shown, Solved, options
from solidgear.show.settled import SECOND_MESH, bar_lines, ended, heading, largest_bar
from solidgear.show.table import Column, Table
from solidgear.show.terminal import matrix_table
from solidgear.show.units import units_named
from solidgear.show.words import plus_minus
from solidgear.variants.budget.budget import beside


@command
def stiffness(
    scene: SceneFile,
    *,
    model: Solved,
    port: Annotated[
        str | None,
        typer.Option(
            help="Lumped point, by name; several with commas for the stiffness between them. By default the main one."
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
    found = condense(body, loaded, names[0])
    coupled = condense(body, loaded, names) if len(names) > 1 else None
    bars = settled.bars if settled is not None else {}
    if settled is None and model.on_two_meshes:
        bars = static_bars(loaded, body, names, options(model.pairs))
    why = model.without_bars(bars, settled, loaded, body)
    said = cautions(loaded, body)
    open_ = beside(loaded, body)

    if run.as_json:
        record: dict[str, Any] = {"scene": loaded.name, "fidelity": body.fidelity}
        record |= _plain(found) if coupled is None else _plain_coupled(coupled)
        evidence = {"evidence": record.pop("evidence")}
        record |= {"dofs": body.size, **evidence, "cautions": said}
        record |= {"bars": bars} if settled is None else settled.as_dict()
        record |= {"why_without_bar": why}
        print(json.dumps(record | {"open": open_.model_dump(mode="json")}))
        ended(settled)
        return
    head = heading(loaded, body, settled)
    if coupled is None:
        _tell(head, loaded, found, run.units)
    else:
        _tell_coupled(head, loaded, coupled, run.units)
        if bars:
            say(_bars(bars, coupled))
    if open_.inputs:
        say(open_table(open_, bars, units_named(run.units)))
    if settled is None:
        lines = [f"No bars: {why}."] if why else largest_bar(bars, names[0])
        say(*lines, *([] if why else [SECOND_MESH]))
    say(*bar_lines(settled))
    say(*map(caution, said), soft_wrap=False)
    ended(settled)


def _points(scene: Scene, port: str | None) -> tuple[str, ...]:
    """Names given with ``--port``; that of the main point where there are none."""
    known = [one.name for one in scene.ports]
    if port is None:
        return (known[0],)
    # a name may have a comma of its own
    names = [port] if port in known else [part.strip() for part in port.split(",")]
    for name in names:
        if name not in known:
            raise SolidgearError(f"--port: {no_such_point(name, known)}")
        if names.count(name) > 1:
            raise SolidgearError(f"--port {port}: {name} is named twice; name each point once")
    return tuple(names)


def _numbers(matrix) -> list[list[float | None]]:
    return [[float(v) if np.isfinite(v) else None for v in row] for row in matrix]


def _plain(found: Condensed) -> dict[str, Any]:
    return {
        "port": found.port,
        "attachment": found.attachment,
        "order": DOF_NAMES,
        "stiffness": _numbers(found.stiffness),
        "compliance": _numbers(found.compliance),
        "free": found.free_names,
        "free_oblique": found.oblique.T.tolist(),
        "evidence": found.evidence,
    }


def _plain_coupled(found: Coupled) -> dict[str, Any]:
    return {
        "ports": found.ports,
        "attachments": found.attachments,
        "order": [f"{port} {name}" for port in found.ports for name in DOF_NAMES],
        "stiffness": _numbers(found.stiffness),
        "compliance": _numbers(found.compliance),
        "free": found.free_names,
        "evidence": found.evidence,
    }


def _at(port: Port) -> str:
    """Place of a lumped point, mm."""
    if port.patch is None:
        return f"y = {1e3 * port.y:.3f}"
    return "({})".format(", ".join(f"{1e3 * v:.3f}" for v in port.patch.point))


def _tell(head: str, scene: Scene, found: Condensed, units: str) -> None:
    say(
        f"{head}, port {found.port!r} at {_at(scene.port)} mm ({found.attachment})",
        matrix_table(found.stiffness, "stiffness", units),
        matrix_table(found.compliance, "compliance", units),
        soft_wrap=False,
    )
    if found.free_names:
        say(f"Free: {', '.join(found.free_names)} (stiffness exactly zero).")
    for motion in found.oblique.T:
        moved = [(v, n) for v, n in zip(motion, DOF_NAMES) if abs(v) > 1e-9]
        parts = ", ".join(f"{v:.4g} {n}" for v, n in moved)
        names = " and ".join(n for _, n in moved)
        line = f"Free: the motion ({parts}), m and rad; a compliance of {names} does not exist."
        say(line)


def _bars(bars: Mapping[Quantity, float], found: Coupled) -> Table:
    """The largest mesh bar of every block."""
    largest: dict[tuple[str, ...], float] = {}
    for name, bar in bars.items():
        if name.pair or name.kind == COMPLIANCE:  # what one point resists alone is not told here
            point = next(iter(name.points), found.ports[0])
            key = (name.kind, *sorted(name.pair or (point, point), key=found.ports.index))
            largest[key] = max(bar, largest.get(key, 0.0))
    pairs = [(a, b) for k, a in enumerate(found.ports) for b in found.ports[k:]]
    columns = [
        Column(
            "largest mesh bar of a block",
            lambda pair: (
                "{} itself".format(*pair)
                if pair[0] == pair[1]
                else "between {} and {}".format(*pair)
            ),
        ),
        Column(STIFFNESS, lambda pair: largest.get((STIFFNESS, *pair)), plus_minus),
        Column(COMPLIANCE, lambda pair: largest.get((COMPLIANCE, *pair)), plus_minus),
    ]
    note = "couplings: relative to the geometric mean of what both motions have of their own"
    return Table("", columns, pairs, note)


def _tell_coupled(head: str, scene: Scene, found: Coupled, units: str) -> None:
    places = {port.name: _at(port) for port in scene.ports}
    at = ", ".join(
        f"{name!r} at {places[name]} mm ({kind})"
        for name, kind in zip(found.ports, found.attachments)
    )
    say(f"{head}, ports {at}", soft_wrap=False)
    pairs = [(a, b) for k, a in enumerate(found.ports) for b in found.ports[k:]]
    stiff = bool(np.isfinite(found.stiffness).all())
    for kind in ("stiffness", "compliance") if stiff else ("compliance",):
        for a, b in pairs:
            words = {"stiffness": "load on", "compliance": "motion of"}[kind]
            other = {"stiffness": "motion of", "compliance": "load on"}[kind]
            caption = f"{kind}: {words} {a}, {other} {b}"
            own = [np.diag(found.between(one, one, kind)).tolist() for one in (a, b)]
            say(matrix_table(found.between(a, b, kind), kind, units, caption, own))
    several = "both points" if len(found.ports) == 2 else "all points"
    if stiff:
        line = f"Stiffness holds {several}: one moves, all else is held. The blocks left out are the transposed ones."
    else:
        line = (
            "The points all but move as one: a stiffness between them does not exist to any digits."
        )
    say(line)
    if found.free_names:
        names = ", ".join(found.free_names)
        line = (
            f"Free: {names} of {several} together; only what the points do against each other is "
            "resisted, and has no entry of its own in the compliance."
        )
        say(line)
