"""Motions of measuring points that modes above a list leave: static compliance less what the list has of
it (the residual term of Ewins 2000, Modal Testing, section 4.3).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from solidgear.body import FURTHER, SINE, Body, as_supports
from solidgear.scene import Scene
from solidgear.solve.coupling import decoupled, groups
from solidgear.solve.modes import Mode
from solidgear.solve.supported import Supported
from solidgear.studies.measured.shapes import SurfacePoints

#: waves around of a body of revolution that a force at a point counts with, at least
WAVES = 8
#: share of an eigenvalue by which bearing terms between families may be left out
COUPLING = 1e-9


class Stiffer(NamedTuple):
    """Static motions (e, e) at points under forces at them, m/N, without motions that nothing holds;
    the rest that a list of modes has not, and the most waves around that count, 0 of a 3D mesh.
    """

    static: np.ndarray
    rest: np.ndarray
    waves: int


def left_out(
    scene: Scene, places: SurfacePoints, ends: Sequence[tuple[int, int]], modes: Iterable[Mode]
) -> Stiffer | None:
    """Static compliance that a list of modes has not; None of a body whose surface tells no forces.
    The ends are places of points among those of `places`, and directions -3 to 3 along x, y, z.
    """
    body = places.body
    if not hasattr(body.geometry, "rows"):
        return None
    elastic = [mode for mode in modes if mode.frequency_hz > 0]
    waves = max([WAVES, *(mode.waves for mode in elastic)]) if body.further is not None else 0
    static = np.zeros((len(ends), len(ends)))
    for supported, forces in _forces(scene, places, ends, waves):
        free = forces - supported.mass(supported.free) @ (supported.free.T @ forces)
        static += forces.T @ supported.static(free)
    rest = static.copy()
    for mode in elastic:
        for vector in mode.vectors:
            moved = places.of(vector)
            along = [np.sign(way) * moved[at, abs(way) - 1] for at, way in ends]
            rest -= np.outer(along, along) / (2 * np.pi * mode.frequency_hz) ** 2
    return Stiffer(static, rest, waves)


def _forces(
    scene: Scene, places: SurfacePoints, ends: Sequence[tuple[int, int]], waves: int
) -> Iterator[tuple[Supported, np.ndarray]]:
    """Groups of blocks, and unit forces (n, e) at the ends on each."""
    body, supports = places.body, as_supports(scene)
    spring, _ = decoupled(body, supports, COUPLING)
    for group in groups(body, supports, spring):
        own = [_on_block(body, places, ends, b) for b in group]
        yield Supported(body, supports, spring, group), np.vstack(own)
    none = as_supports(())
    for n in range(2, waves + 1):
        family = Supported(body.family(n), none, np.zeros((0, 0)), [0])
        for index in (FURTHER + n, SINE + n):
            yield family, _on_block(body, places, ends, index)


def _on_block(
    body: Body, places: SurfacePoints, ends: Sequence[tuple[int, int]], index: int
) -> np.ndarray:
    """(n, e) unit forces at the ends in the unknowns of a block."""
    block = body.block(index)
    corners = places.corners[[at for at, _ in ends]]
    rows = body.geometry.rows(block.name, corners.ravel())  # type: ignore[union-attr]
    rows = rows.reshape(*corners.shape, 3, -1)
    way = np.array([abs(way) - 1 for _, way in ends])
    sign = np.sign([way for _, way in ends])
    along = np.einsum(
        "ecn,ec->en", rows[np.arange(len(ends)), :, way], places.weights[[at for at, _ in ends]]
    )
    along = sign[:, None] * along
    return (along if block.expand is None else along @ block.expand).T
