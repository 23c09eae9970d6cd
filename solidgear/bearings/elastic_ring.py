"""Ring of a planetary stage as an elastic body of revolution, pushed on where planets mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from solidgear.core import Scene, SolidgearError, build, rotation, rubin
from solidgear.core.models.harmonic.patch import Patch, PatchMotion
from solidgear.core.reduction.waves import with_waves
from solidgear.core.scene.planetary_teeth import PlanetaryTeeth
from solidgear.core.system.parts import Part, Placed


def elastic_ring(
    scene: Scene,
    teeth: PlanetaryTeeth,
    face_width: float,
    waves: Sequence[int] = (2, 3),
    **options: Any,
) -> Part:
    """Harmonic solid of a ring with a port at every planet, to be the ring of a stage.

    Each tooth pushes on one pitch of the inner surface.  Harmonics n = 0 and 1 follow the port of the
    scene, which is ``centre``; harmonics from 2 on are the ring's own waves.  Bearings of the scene
    are left out: give the support of the ring to the stage, where it holds the centre, so that
    waves are those of a free rim.

    Parameters
    ----------
    scene : Scene
        Hollow, of smooth bore; its port in the middle of the face.
    teeth : PlanetaryTeeth
        For azimuths, pitch circle and pitch.
    face_width : float
        m.
    waves : sequence of int
        From 2 on.
    **options
        Options of the harmonic model, such as ``order``.

    Returns
    -------
    Part
        For :meth:`solidgear.trains.system.planetary_members.CentralMember.of`; the middle of the face at
        its origin.

    Raises
    ------
    SolidgearError
        For a seat that is tied rigidly, which has no waves, or a face beyond the bore.

    Examples
    --------
    >>> import solidgear as sg
    >>> rim = sg.Segment.cylinder("rim", length=0.03, diameter=0.25, bore=0.22)
    >>> scene = sg.Scene.from_parts([rim])
    >>> teeth = sg.PlanetaryTeeth(17, 34, 85, module=2.5e-3)
    >>> part = sg.elastic_ring(scene, teeth, face_width=0.025, order=3)
    >>> ring = sg.CentralMember.of(part, teeth.base_radii[2], turning=1e7)
    >>> list(part.ports), round(ring.mass, 2)
    (['centre', 'planet 1', 'planet 2', 'planet 3'], 2.61)
    """
    few = [n for n in waves if n < 2]
    if few:
        raise SolidgearError(f"waves = {few[0]}: give numbers of waves around the ring from 2 on")
    name, y = scene.port.name, scene.port.y
    if any(station.attachment == "rigid" for station in scene.stations):
        raise SolidgearError(
            "a seat of the ring is tied rigidly, which suppresses all waves around it; use "
            "attachment average or section"
        )
    first, last = y - face_width / 2, y + face_width / 2
    if not 0 <= first < last <= scene.length:
        raise SolidgearError(
            f"a face of {1e3 * face_width:.4g} mm around y = {1e3 * y:.4g} mm is not on a ring of "
            f"{1e3 * scene.length:.4g} mm"
        )
    body = build(scene, "harmonic", **options)
    patch = Patch(first, last, 0.0, 2 * np.pi / teeth.ring, inside=True)
    motion = PatchMotion(scene, body, patch)
    rows = {n: motion.rows(n) for n in waves}
    part = rubin(body, ports=[name])
    for k, azimuth in enumerate(teeth.azimuths, 1):
        # angles of patches count from z, azimuths from x
        planet_patch = replace(patch, angle=azimuth + np.pi / 2)
        point = rotation(1, azimuth)[:3, 0] * teeth.module * teeth.ring / 2
        part = with_waves(part, body, name, point[:3], planet_patch.axes, rows, f"planet {k}")
    ports = {"centre" if key == name else key: port for key, port in part.ports.items()}
    return Placed(replace(part, ports=ports), origin=np.array([0.0, -y, 0.0]))
