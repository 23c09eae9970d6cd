"""What one order more finds of the error at seats, and gaps between them, narrower than cells.

Far from a seat that is narrow, displacements go with the logarithm of the distance, as under a load
on a line; only nearer than its width with the exponent a of its ends.  Order p of cells of a depth h
resolves a distance of about ``h / p^2``, so that the energy that it does not see goes as

    L(p) = ln(1 + (c h / (p^2 w))^(2 a)),

with the width w: p^(-4 a) where the seat is resolved, and as slowly as a logarithm where it is not.
One order more takes ``(L(p) - L(p + 1)) / L(p)`` of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.bounds.safety import REACH
from solidgear.core.models.solid.mesh import SolidMesh
from solidgear.core.scene.shaft import without_axis

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.scene import Scene

#: exponents of displacement at the ends of averaged and rigid seats on a smooth surface
AVERAGED, RIGID = 1.0, 1 / 2


def narrow_share(scene: Scene, body: Body, order: int) -> float:
    """Return the largest energy of an error over that which one order more finds of it, at the seats of
    a body on a mesh of some order; one where nothing is known of its seats.
    """
    if without_axis(scene) or not isinstance(body.geometry, SolidMesh):
        return 1.0
    places = _places(scene, body, body.geometry)
    return max((share_of(order, slimness, a) for slimness, a in places), default=1.0)


def share_of(order: int, slimness: float, exponent: float) -> float:
    """Return the energy of an error over that which one order more finds of it, where cells are so many
    times deeper than a seat is wide.

    Examples
    --------
    >>> [round(share_of(2, slimness, 1.0), 2) for slimness in (0.01, 1.0, 100.0)]
    [1.25, 1.34, 5.61]
    """
    missing, left = (
        np.log1p((REACH * slimness / p**2) ** (2 * exponent)) for p in (order, order + 1)
    )
    return float(missing / (missing - left))


def _places(scene: Scene, body: Body, mesh: SolidMesh) -> Iterator[tuple[float, float]]:
    """Yield depths of cells over widths of seats, and of gaps between rigid ones, with the exponent at
    their ends.
    """
    stations = {station.name: station for station in scene.stations}
    rigid: list[tuple[float, float, float]] = []
    for port in body.ports:
        station = stations.get(port.name)
        if station is None or port.attachment not in ("average", "rigid"):
            continue
        facets = mesh.seat(station, scene.segments, 1e-7 * scene.length)
        if not len(facets):
            continue
        depth = _depth(mesh, facets)
        held = port.attachment == "rigid"
        yield depth / (station.hi - station.lo), RIGID if held else AVERAGED
        if held:
            rigid.append((station.lo, station.hi, depth))
    for before, after in pairwise(sorted(rigid)):
        if after[0] > before[1]:
            yield max(before[2], after[2]) / (after[0] - before[1]), RIGID


def _depth(mesh: SolidMesh, facets: np.ndarray) -> float:
    """Return the mean depth of the cells under some facets, m, from their volume."""
    area = sum(weights.sum() for *_, weights in mesh.quadrature_on(facets))
    cells = np.unique(mesh.mesh.f2t[0, facets])
    volume = sum(weights.sum() for _, _, weights, _ in mesh.over_cells(cells))
    return float((3 if mesh.name.startswith("tet") else 1) * volume / area)
