"""What one order more finds of the error at seats, and gaps between them, narrower than cells.

Far from a seat that is narrow, displacements go with the logarithm of the distance, as under a load
on a line; only nearer than its width with the exponent a of its ends.  Order p of cells of a depth h
resolves a distance of about ``h / p^2``, so that the energy that it does not see goes as

    L(p) = ln(1 + (c h / (p^2 w))^(2 a)),

with the width w: p^(-4 a) where the seat is resolved, and as slowly as a logarithm where it is not.
One order more takes ``(L(p) - L(p + 1)) / L(p)`` of it.

Cells between two rigid seats are strained evenly across the gap g as deep as order p lets them be, which
makes them too stiff by a factor ``1 + q``, ``q = b h / (p^2 g)``, and all but locks what is deeper
than the gap is wide.  Of the flexibility that they lack, ``q / (1 + q)``, one order more takes

    (1 - t) / (1 + t q),      t = (p / (p + 1))^2.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.bounds.singular_places import end_exponent
from solidgear.core.models.solid.mesh import SolidMesh
from solidgear.core.safety import GAP, LOAD_EDGE, REACH
from solidgear.core.scene.shaft import on_face, without_axis

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.scene import Scene

#: ends along the shaft, depth of the cells below, m, and the exponent at the ends
Seat = tuple[float, float, float, float]


def narrow_share(scene: Scene, body: Body, order: int) -> float:
    """Return the largest energy of an error over that which one order more finds of it, at the seats of
    a body on a mesh of some order; one where nothing is known of its seats.
    """
    mesh = mesh_of(body)
    if without_axis(scene) or mesh is None:
        return 1.0
    seats = _seats(scene, body, mesh)
    shares = [share_of(order, depth / (hi - lo), a) for lo, hi, depth, a in seats]
    rigid = sorted(seat for seat in seats if seat[3] < LOAD_EDGE)
    for (_, end, *before), (start, _, *after) in pairwise(rigid):
        if start > end:
            depth = max(before[0], after[0])
            shares.append(share_of_gap(order, depth / (start - end)))
    return max(shares, default=1.0)


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


def share_of_gap(order: int, slimness: float) -> float:
    """Return the same where cells are so many times deeper than a gap between two rigid seats is wide.

    Examples
    --------
    >>> [round(share_of_gap(2, slimness), 2) for slimness in (0.01, 1.0, 100.0)]
    [1.8, 1.9, 11.8]
    """
    taken = (order / (order + 1)) ** 2
    stiffer = GAP * slimness / order**2
    return (1 + taken * stiffer) / (1 - taken)


def mesh_of(body: Body) -> SolidMesh | None:
    """Return the mesh of a body, of half a part that of its half; None of a body without one."""
    geometry = body.geometry
    candidates = (geometry, getattr(geometry, "mesh", None))
    return next((mesh for mesh in candidates if isinstance(mesh, SolidMesh)), None)


def _seats(scene: Scene, body: Body, mesh: SolidMesh) -> list[Seat]:
    """Return the seats of a body, averaged and rigid ones."""
    stations = {station.name: station for station in scene.stations}
    rigid = [stations[p.name] for p in body.ports if p.attachment == "rigid" and p.name in stations]
    seats: list[Seat] = []
    for port in body.ports:
        station = stations.get(port.name)
        if station is None or on_face(station):
            continue
        if port.attachment not in ("average", "rigid"):
            continue
        facets = mesh.seat(station, scene.segments, 1e-7 * scene.length)
        if len(facets):
            exponent = end_exponent(scene, station, rigid) if station in rigid else LOAD_EDGE
            seats.append((station.lo, station.hi, _depth(mesh, facets), exponent))
    return seats


def _depth(mesh: SolidMesh, facets: np.ndarray) -> float:
    """Return the mean depth of the cells under some facets, m, from their volume."""
    area = sum(weights.sum() for *_, weights in mesh.quadrature_on(facets))
    cells = np.unique(mesh.mesh.f2t[0, facets])
    volume = sum(weights.sum() for _, _, weights, _ in mesh.over_cells(cells))
    return float((3 if mesh.name.startswith("tet") else 1) * volume / area)
