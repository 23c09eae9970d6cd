"""Modes of a train drawn with both shafts in place: several phases a picture, or to be turned."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from math import cos, radians
from pathlib import Path

import numpy as np

from solidgear.body import Body
from solidgear.body.surface import Surface
from solidgear.errors import SolidgearError, listed
from solidgear.ladder.registry import LADDER
from solidgear.report.folder import prepare
from solidgear.report.page_parts import data_uri
from solidgear.report.render import RenderJob, RenderResult, render_modes
from solidgear.report.turning import Member, Turned, together
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.naming import mode_names
from solidgear.studies.train.pairing import BEYOND, partners, seen_modes
from solidgear.studies.train.shaft import told_mix
from solidgear.system.modes import SystemModes
from solidgear.system.system import System

#: phases of a vibration that a picture shows, degrees
PHASES = (0, 60, 120, 180)
#: s of processor time that a picture of four frames may take
PATIENCE = 60.0


def system_surface(workshop: Workshop, system: System, rungs: Sequence[str], shape) -> Surface:
    """Surface of all shafts in the axes of the first one's scene, moved by coordinates of the system.

    Parameters
    ----------
    system : System
        Of these models.
    rungs : (str, str)
        One for each shaft, or one for all.
    shape : (N,) ndarray

    Raises
    ------
    SolidgearError
        For a model without a shape, such as a lumped one.

    Examples
    --------
    >>> import solidgear as sg
    >>> shop = Workshop(sg.load_train("geometry/axle_overhung.toml"))
    >>> system = shop.system("euler", "euler")
    >>> drawn = system_surface(shop, system, ("euler", "euler"), system.elastic[1][:, 2])
    >>> drawn.points.shape == drawn.displacement.shape
    True
    """
    pieces = []
    for side, (body, turn, origin) in _bodies(workshop, system, rungs).items():
        drawn = body.surface(system.expand(side, shape))
        points, moved = drawn.points @ turn.T + origin, drawn.displacement @ turn.T
        pieces.append((points, moved, drawn.faces, drawn.triangles, drawn.lines))
    starts = np.cumsum([0, *(len(points) for points, *_ in pieces[:-1])])
    points, moved, *cells = zip(*pieces)
    whole = [np.vstack([own + begin for own, begin in zip(one, starts)]) for one in cells]
    return Surface(np.vstack(points), np.vstack(moved), *whole)


def _bodies(
    workshop: Workshop, system: System, rungs: Sequence[str]
) -> dict[str, tuple[Body, np.ndarray, np.ndarray]]:
    """Body, rotation and origin of all shafts, in the axes of the first one's scene."""
    out = {}
    for side, rung in workshop.mix(rungs).items():
        if rung not in LADDER.bodies:
            raise SolidgearError(
                f"the model {rung} of the {side} has no shape to draw; "
                f"use one of {', '.join(LADDER.bodies)}"
            )
        part = system.parts[side]
        turn, origin = getattr(part, "rotation", np.eye(3)), getattr(part, "origin", np.zeros(3))
        out[side] = workshop.shaft(side, rung).body, turn, origin
    return out


def turned_modes(workshop: Workshop, *models: str, highest_hz: float | None = None) -> Turned:
    """All shafts in their places with the modes of the train, to be turned in a page.

    Parameters
    ----------
    highest_hz : float, optional
        Of the modes; that of the file by default. The first elastic mode is always there.

    Raises
    ------
    SolidgearError
        For a model without a shape.

    Examples
    --------
    >>> import solidgear as sg
    >>> shop = Workshop(sg.load_train("geometry/axle_overhung.toml"))
    >>> drawn = turned_modes(shop, "euler", "euler", highest_hz=700.0)
    >>> drawn.title, len(drawn.along), [shape.name for shape in drawn.shapes][:2]
    ('both shafts euler', 1, ['load torsion 1', 'gear torsion 1'])
    """
    system = workshop.system(*models)
    found, _ = seen_modes(workshop, system, highest_hz or workshop.train.ask.max_frequency)
    names = mode_names(workshop, system, found)
    elastic = range(found.rigid, len(found.frequency_hz))
    return _turned(workshop, models, system, found, [(k, names[k]) for k in elastic])


def turned_beside(
    workshop: Workshop,
    first: tuple[str, ...],
    second: tuple[str, ...],
    highest_hz: float | None = None,
) -> list[Turned]:
    """Two mixes of models of a train, to be turned side by side.

    Modes of the second are called like their partners of the first, paired by the motions of all
    ports, and drawn with their sign. One without a partner says so in its name.

    Parameters
    ----------
    first, second : tuple of str
        Models of the shafts.
    highest_hz : float, optional
        Of the modes of both; a partner may lie beyond it.

    Raises
    ------
    SolidgearError
        For a model without a shape.
    """
    limit = highest_hz or workshop.train.ask.max_frequency
    one, other = workshop.system(*first), workshop.system(*second)
    found, seen = seen_modes(workshop, one, limit)
    names = mode_names(workshop, one, found)
    elastic = range(found.rigid, len(found.frequency_hz))
    base = _turned(workshop, first, one, found, [(k, names[k]) for k in elastic])
    its, its_seen = seen_modes(workshop, other, BEYOND * limit)
    hz, its_hz = found.frequency_hz[found.rigid :], its.frequency_hz[its.rigid :]
    partner = {j: k for k, j in partners(hz, seen, its_hz, its_seen).items()}
    own = mode_names(workshop, other, its)
    kept = []
    for j, frequency in enumerate(its_hz):
        if j in partner:
            kept.append((its.rigid + j, names[found.rigid + partner[j]]))
        elif frequency <= limit:
            kept.append((its.rigid + j, f"{own[its.rigid + j]}, {_title(workshop, second)} alone"))
    return [base, _turned(workshop, second, other, its, kept, [base])]


def _title(workshop: Workshop, models: Sequence[str]) -> str:
    alike = len({*models}) == 1
    return f"{workshop.train.every} shafts {models[0]}" if alike else told_mix(workshop.mix(models))


def _turned(
    workshop: Workshop,
    rungs: tuple[str, ...],
    system: System,
    found: SystemModes,
    kept: Sequence[tuple[int, str]],
    like: Sequence[Turned] = (),
) -> Turned:
    """One mix with modes of these numbers and names, in the signs of others."""
    members = [
        Member(body, turn, origin, [[system.expand(side, found.shapes[:, k])] for k, _ in kept])
        for side, (body, turn, origin) in _bodies(workshop, system, rungs).items()
    ]
    modes = [(name, float(found.frequency_hz[k])) for k, name in kept]
    return together(_title(workshop, rungs), modes, members, like)


def draw_modes(
    workshop: Workshop,
    *models: str,
    folder: str | os.PathLike,
    numbers: Sequence[int],
) -> dict[str, RenderResult]:
    """One picture a mode, ``system_mode_03.png`` and so on.

    Parameters
    ----------
    numbers : sequence of int
        Of modes as system-modes lists them, from 1.

    Returns
    -------
    dict of str to RenderResult
        By name and frequency; nothing is raised for a picture that could not be drawn.

    Raises
    ------
    SolidgearError
        For a model without a shape, a number that there is not, or a folder that cannot be written.
    """
    system = workshop.system(*models)
    most = system.free.shape[1] + len(system.elastic[0])
    wrong = [str(n) for n in numbers if not 1 <= n <= most]
    if wrong:
        raise SolidgearError(f"there is no mode {listed(wrong)}; modes are numbered 1 to {most}")
    found = system.modes(max(1, max(numbers) - system.free.shape[1]))
    names = mode_names(workshop, system, found)
    frames = [(cos(radians(phase)), f"phase {phase}°") for phase in PHASES]
    alike = len({*models}) == 1
    mix = workshop.mix(models).items()
    both = models[0] if alike else ", ".join(f"{rung} {side}" for side, rung in mix)
    jobs = {}
    for n in numbers:
        surface = system_surface(workshop, system, models, found.shapes[:, n - 1])
        told = f"{names[n - 1]}, {found.frequency_hz[n - 1]:.1f} Hz"
        path = Path(folder) / f"system_mode_{n:02d}.png"
        jobs[told] = RenderJob(surface, f"{told} ({both})", path, frames, along=False)
    prepare(folder)
    return dict(zip(jobs, render_modes(jobs.values(), timeout=PATIENCE * len(jobs))))


def still_of(workshop: Workshop, *models: str, number: int) -> tuple[str, str]:
    """A picture of one mode for a page: its data URI, and else why there is none.

    Parameters
    ----------
    workshop, models
        As of :func:`draw_modes`.
    number : int
        Of the mode, from 1.
    """
    with tempfile.TemporaryDirectory(prefix="solidgear-turn-") as folder:
        (one,) = draw_modes(workshop, *models, folder=folder, numbers=[number]).values()
        if not one.ok:
            return "", f"no picture for print: {one.reason}"
        return data_uri("mode", one.path) or "", ""
