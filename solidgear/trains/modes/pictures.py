"""Modes of a train drawn with all shafts in place: several phases a picture, or to be turned."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from math import cos, radians
from pathlib import Path

import numpy as np

from solidgear.core import LADDER, Body, SolidgearError, Surface, System, listed
from solidgear.core.system.modes import SystemModes
from solidgear.show.folder import prepare
from solidgear.show.page_parts import data_uri
from solidgear.show.render import RenderJob, RenderResult, render_modes
from solidgear.show.turning import Member, Turned, together
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import mix_label
from solidgear.trains.modes.naming import mode_names
from solidgear.trains.modes.pairing import BEYOND, modes_and_motions, partners

#: phases of a vibration that a picture shows, degrees
PHASES = (0, 60, 120, 180)
#: s of processor time that a picture of four frames may take
PATIENCE = 60.0


def system_surface(assembly: Assembly, system: System, models: Sequence[str], shape) -> Surface:
    """Return the surface of all shafts by models with a shape, in the axes of the first one's
    scene, moved by coordinates (N,) of the system.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
    >>> system = assembly.system("euler", "euler")
    >>> drawn = system_surface(assembly, system, ("euler", "euler"), system.elastic[1][:, 2])
    >>> drawn.points.shape == drawn.displacement.shape
    True
    """
    points, moved, faces, triangles, lines = [], [], [], [], []
    start = 0
    for side, (body, turn, origin) in _bodies(assembly, system, models).items():
        drawn = body.surface(system.expand(side, shape))
        points.append(drawn.points @ turn.T + origin)
        moved.append(drawn.displacement @ turn.T)
        faces.append(drawn.faces + start)
        triangles.append(drawn.triangles + start)
        lines.append(drawn.lines + start)
        start += len(drawn.points)
    return Surface(*(np.vstack(parts) for parts in (points, moved, faces, triangles, lines)))


def _bodies(
    assembly: Assembly, system: System, models: Sequence[str]
) -> dict[str, tuple[Body, np.ndarray, np.ndarray]]:
    """Return body, rotation and origin of all shafts, in the axes of the first one's scene."""
    out = {}
    for side, model in assembly.models_by_shaft(models).items():
        if model not in LADDER.bodies:
            raise SolidgearError(
                f"the model {model} of the {side} has no shape to draw; "
                f"use one of {', '.join(LADDER.bodies)}"
            )
        part = system.parts[side]
        turn, origin = getattr(part, "rotation", np.eye(3)), getattr(part, "origin", np.zeros(3))
        out[side] = assembly.shaft_model(side, model).body, turn, origin
    return out


def turning_modes(assembly: Assembly, *models: str, highest_hz: float | None = None) -> Turned:
    """Return all shafts in their places with the modes of the train up to a frequency, Hz, by
    default that of the file, to be turned in a page; the first elastic mode is always there.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
    >>> drawn = turning_modes(assembly, "euler", "euler", highest_hz=700.0)
    >>> drawn.title, len(drawn.along), [shape.name for shape in drawn.shapes][:2]
    ('both shafts euler', 1, ['load torsion 1', 'gear torsion 1'])
    """
    system = assembly.system(*models)
    modes, _ = modes_and_motions(assembly, system, highest_hz or assembly.train.ask.max_frequency)
    names = mode_names(assembly, system, modes)
    elastic = range(modes.rigid, len(modes.frequency_hz))
    return _turning(assembly, models, system, modes, [(k, names[k]) for k in elastic])


def turning_pair(
    assembly: Assembly,
    first: tuple[str, ...],
    second: tuple[str, ...],
    highest_hz: float | None = None,
) -> list[Turned]:
    """Return two mixes of models of a train, to be turned side by side: modes of the second, up to
    a frequency, Hz, and partners beyond it, are named like their partners of the first, paired
    by the motions of all ports, and drawn with their sign; one without a partner says so in its
    name.
    """
    limit = highest_hz or assembly.train.ask.max_frequency
    system_a, system_b = assembly.system(*first), assembly.system(*second)
    modes_a, motions_a = modes_and_motions(assembly, system_a, limit)
    names_a = mode_names(assembly, system_a, modes_a)
    elastic = range(modes_a.rigid, len(modes_a.frequency_hz))
    base = _turning(assembly, first, system_a, modes_a, [(k, names_a[k]) for k in elastic])
    modes_b, motions_b = modes_and_motions(assembly, system_b, BEYOND * limit)
    hz_a, hz_b = modes_a.frequency_hz[modes_a.rigid :], modes_b.frequency_hz[modes_b.rigid :]
    partner = {j: k for k, j in partners(hz_a, motions_a, hz_b, motions_b).items()}
    names_b = mode_names(assembly, system_b, modes_b)
    chosen = []
    for j, frequency in enumerate(hz_b):
        k = modes_b.rigid + j
        if j in partner:
            chosen.append((k, names_a[modes_a.rigid + partner[j]]))
        elif frequency <= limit:
            chosen.append((k, f"{names_b[k]}, {_title(assembly, second)} alone"))
    return [base, _turning(assembly, second, system_b, modes_b, chosen, [base])]


def _title(assembly: Assembly, models: Sequence[str]) -> str:
    equal = len({*models}) == 1
    return (
        f"{assembly.train.every} shafts {models[0]}"
        if equal
        else mix_label(assembly.models_by_shaft(models))
    )


def _turning(
    assembly: Assembly,
    models: tuple[str, ...],
    system: System,
    system_modes: SystemModes,
    chosen: Sequence[tuple[int, str]],
    like: Sequence[Turned] = (),
) -> Turned:
    """Return a mix with modes of these numbers and names, in the signs of others."""
    members = [
        Member(
            body,
            turn,
            origin,
            [[system.expand(side, system_modes.shapes[:, k])] for k, _ in chosen],
        )
        for side, (body, turn, origin) in _bodies(assembly, system, models).items()
    ]
    modes = [(name, float(system_modes.frequency_hz[k])) for k, name in chosen]
    return together(_title(assembly, models), modes, members, like)


def draw_modes(
    assembly: Assembly,
    *models: str,
    folder: str | os.PathLike,
    numbers: Sequence[int],
) -> dict[str, RenderResult]:
    """Draw a picture a mode, ``system_mode_03.png`` and so on, with numbers from 1 as system-modes
    lists them; return the results by name and frequency, also of pictures that could not be
    drawn.
    """
    system = assembly.system(*models)
    most = system.free.shape[1] + len(system.elastic[0])
    wrong = [str(n) for n in numbers if not 1 <= n <= most]
    if wrong:
        raise SolidgearError(f"there is no mode {listed(wrong)}; modes are numbered 1 to {most}")
    modes = system.modes(max(1, max(numbers) - system.free.shape[1]))
    names = mode_names(assembly, system, modes)
    frames = [(cos(radians(phase)), f"phase {phase}°") for phase in PHASES]
    equal = len({*models}) == 1
    by_shaft = assembly.models_by_shaft(models).items()
    label = models[0] if equal else ", ".join(f"{model} {side}" for side, model in by_shaft)
    jobs = {}
    for n in numbers:
        surface = system_surface(assembly, system, models, modes.shapes[:, n - 1])
        caption = f"{names[n - 1]}, {modes.frequency_hz[n - 1]:.1f} Hz"
        path = Path(folder) / f"system_mode_{n:02d}.png"
        jobs[caption] = RenderJob(surface, f"{caption} ({label})", path, frames, along=False)
    prepare(folder)
    return dict(zip(jobs, render_modes(jobs.values(), timeout=PATIENCE * len(jobs))))


def still_picture(assembly: Assembly, *models: str, number: int) -> tuple[str, str]:
    """Return a picture of a mode, from 1, for a page: the data URI, and else the reason why there
    is none.
    """
    with tempfile.TemporaryDirectory(prefix="solidgear-turn-") as folder:
        (picture,) = draw_modes(assembly, *models, folder=folder, numbers=[number]).values()
        if not picture.ok:
            return "", f"no picture for print: {picture.reason}"
        return data_uri("mode", picture.path) or "", ""
