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

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.bounds.layers import Layers
from solidgear.core.bounds.seat_facets import rim_of, seat_facets, unit_normals
from solidgear.core.bounds.singular_places import end_exponent
from solidgear.core.models.solid.mesh import SolidMesh
from solidgear.core.safety import ALONG, GAP, LOAD_EDGE, REACH
from solidgear.core.scene.shaft import on_face

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.scene import Scene


@dataclass(frozen=True)
class _Seat:
    """A seat on a mesh."""

    facets: np.ndarray
    ends: tuple[float, float] | None  #: along the shaft, m; None of a patch
    width: float  #: m; infinite of a patch that ends at edges of the body alone
    depth: float  #: mean one of the cells below, m
    exponent: float  #: at its ends


def narrow_share(scene: Scene, body: Body, order: int, layers: Layers | None = None) -> float:
    """Return the largest energy of an error over that which one order more finds of it, at the seats of
    a body on a mesh of some order; one where nothing is known of its seats.
    """
    mesh = mesh_of(body)
    if mesh is None:
        return 1.0
    seats = list(_seats(scene, body, mesh, layers))
    ending = [seat for seat in seats if np.isfinite(seat.width)]
    shares = [share_of(order, seat.depth / seat.width, seat.exponent) for seat in ending]
    rigid = [seat for seat in seats if seat.exponent < LOAD_EDGE]
    for one, other in combinations(rigid, 2):
        gap = _gap(mesh, one, other)
        if 0 < gap < np.inf:
            shares.append(share_of_gap(order, max(one.depth, other.depth) / gap))
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


def _seats(scene: Scene, body: Body, mesh: SolidMesh, layers: Layers | None) -> Iterator[_Seat]:
    """Yield the seats of a body, averaged and rigid ones."""
    stations = {station.name: station for station in scene.stations}
    rigid = [stations[p.name] for p in body.ports if p.attachment == "rigid" and p.name in stations]
    for port in body.ports:
        station = stations.get(port.name)
        if station is None or on_face(station):
            continue
        if port.attachment not in ("average", "rigid"):
            continue
        facets = seat_facets(scene, body, mesh, station)
        if not len(facets):
            continue
        on_patch = getattr(station, "patch", None) is not None
        ends = None if on_patch else (station.lo, station.hi)
        width = _width(mesh, facets) if ends is None else ends[1] - ends[0]
        exponent = LOAD_EDGE
        if port.attachment == "rigid" and on_patch:
            sharp = (layers or Layers.of(scene, body, mesh)).sharp
            exponent = float(sharp.exponents_on(rim_of(mesh, facets)).min(initial=LOAD_EDGE))
        elif port.attachment == "rigid":
            exponent = end_exponent(scene, station, rigid)
        yield _Seat(facets, ends, width, _depth(mesh, facets), exponent)


def _gap(mesh: SolidMesh, one: _Seat, other: _Seat) -> float:
    """Return the distance between two seats side by side, m; infinite of patches on opposite sides of
    the body, zero of seats that touch.
    """
    if one.ends is not None and other.ends is not None:
        return max(one.ends[0], other.ends[0]) - min(one.ends[1], other.ends[1])
    a, b = (_normal(mesh, seat.facets) for seat in (one, other))
    if a @ b < -ALONG:
        return np.inf
    rims = [mesh.mesh.p[:, mesh.mesh.edges[:, rim_of(mesh, s.facets)]] for s in (one, other)]
    return min(_distance(*rims), _distance(*reversed(rims)))


def _distance(ends: np.ndarray, edges: np.ndarray) -> float:
    """Return the least distance of the ends (3, 2, k) of some edges from other edges (3, 2, l), m."""
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    to = ends.reshape(3, -1, 1) - start[:, None]
    place = (to * along[:, None]).sum(axis=0) / (along**2).sum(axis=0)
    return float(np.linalg.norm(to - np.clip(place, 0, 1) * along[:, None], axis=0).min())


def _normal(mesh: SolidMesh, facets: np.ndarray) -> np.ndarray:
    """Return the mean normal (3,) of facets, out of the body: of one around a hole it is near zero."""
    return unit_normals(mesh.mesh, facets, mesh.mesh.f2t[0, facets]).mean(axis=1)


def _width(mesh: SolidMesh, facets: np.ndarray) -> float:
    """Return the lesser side of a rectangle that spreads as wide as some facets, m: infinite where they
    end at edges of the body alone, beyond which nothing is there to be strained.
    """
    m = mesh.mesh
    beside = np.setdiff1d(mesh.boundary, facets)
    rim = rim_of(mesh, facets)
    # the facet on either side of every edge of the rim
    inner, outer = np.full(m.edges.shape[1], -1), np.full(m.edges.shape[1], -1)
    inner[m.f2e[:, facets]], outer[m.f2e[:, beside]] = facets, beside
    both = inner[rim], outer[rim]
    if (both[1] < 0).all():
        return np.inf
    a, b = (unit_normals(m, f, m.f2t[0, f]) for f in (part[both[1] >= 0] for part in both))
    if ((a * b).sum(axis=0) < ALONG).all():
        return np.inf
    parts = list(mesh.quadrature_on(facets))
    x = np.concatenate([x.reshape(3, -1) for *_, x, _ in parts], axis=1)
    area = np.concatenate([weights.ravel() for *_, weights in parts])
    x = x - (x @ area / area.sum())[:, None]
    return float(np.sqrt(12 * np.linalg.eigvalsh((x * area) @ x.T / area.sum())[1]))


def _depth(mesh: SolidMesh, facets: np.ndarray) -> float:
    """Return the mean depth of the cells under some facets, m, from their volume."""
    area = sum(weights.sum() for *_, weights in mesh.quadrature_on(facets))
    cells = np.unique(mesh.mesh.f2t[0, facets])
    volume = sum(weights.sum() for _, _, weights, _ in mesh.over_cells(cells))
    return float((3 if mesh.name.startswith("tet") else 1) * volume / area)
