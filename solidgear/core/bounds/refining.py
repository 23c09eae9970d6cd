"""Meshes of a harmonic solid that are refined where their error bars come from.

The first mesh has one cell a band and strip and no cut at all. Where the local problems show that a
corner decides the error bar, the cells around it are cut towards it, as often as theory says that
it takes: a cut of ratio q leaves the share ``q^(2 a)`` of the cost of a corner of exponent a, and
orders from p to p + k leave ``(p / (p + k))^(4 a)`` of it (Szabo and Babuska 1991, ch. 10). The
error away from corners falls with the order of the elements.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body
from solidgear.core.bounds.harmonic import richer_space
from solidgear.core.bounds.lines import Lines, place_of
from solidgear.core.meshing.cells import ENDS
from solidgear.core.meshing.meeting import least_side
from solidgear.core.meshing.meridian import CUT_RATIO, Meridian
from solidgear.core.scene.coned import coned

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: order of the first mesh, and the highest
FIRST, HIGHEST = 3, 8
#: meshes that are tried at most
MOST_MESHES = 10
#: share of the tolerance that a refined mesh is made for: error bars of several places add up
AIM = 0.7
#: cells beside a corner that was cut leave about this share of its cost before, and an order more a
#: ninth of the remaining error: neither decides an error bar, both how many meshes are tried
BY_CUT, BY_ORDER = 0.08, 9.0
#: largest power of the order in what it leaves of the cost of a corner: beyond it cells as large as those
#: of a first mesh are not yet near enough
POWER = 2.0
#: share of what is aimed at that the error away from corners may take before orders are raised
SMOOTH = 1 / 3
#: cuts that one step may add to a corner as sharp as a crack or less, and orders to the mesh
CUTS, ORDERS = 4, 2
#: exponent of displacement at a crack
CRACK = 0.5
#: largest cell of the first mesh, in local outer radii
SIZE = 4.0
#: orders that left more than this each of an error bar are no longer the cure
SLOW = 0.5


@dataclass(frozen=True)
class Meshed:
    """A mesh of a harmonic solid as options of the builder."""

    order: int = FIRST
    size: float = SIZE  #: of the largest cells, in local outer radii
    #: corner, y and r in m, to cuts
    cuts: Mapping[tuple[float, float], int] = field(default_factory=dict)
    across: tuple[tuple[float, float], ...] = ()  #: points that further lines pass, y and r in m
    fixed: Mapping[str, Any] = field(default_factory=dict)  #: options that are not about the mesh
    #: error away from corners when this mesh was chosen; zero at the start
    smooth: float = 0.0
    raised: int = 0  #: by how many orders it was raised since

    def options(self) -> dict[str, Any]:
        """Return the options of the builder."""
        return {
            "order": self.order,
            "layers": 0,
            "edge_layers": 0,
            "relative_size": self.size,
            "plain": True,
            "across": self.across,
            "cuts": tuple((y, r, count) for (y, r), count in sorted(self.cuts.items())),
            **self.fixed,
        }


class Corners:
    """Corners of a mesh and what cells beside them leave of a result while these are being cut and the
    order is raised.
    """

    def __init__(self, scene: Scene, body: Body, score: np.ndarray, order: int):
        self._order = order
        self.raised = 0  #: orders that the mesh is raised by
        cells = body.geometry.meridian.cells  # type: ignore[union-attr]
        corners = richer_space(coned(scene), body).corners
        self.exponents = {v: place.exponent for v, place in corners.items()}
        flat = body.geometry.meridian  # type: ignore[union-attr]
        #: cuts that corners have room for, and those of one step: more where each leaves more
        self.room = {v: _cuts_to(least_side(scene.length), flat, v) for v in corners}
        self._most = {
            v: min(math.ceil(CUTS * max(1.0, CRACK / a)), self.room[v])
            for v, a in self.exponents.items()
        }
        self.beside = {v: (cells == v).any(axis=0) for v in corners}
        at_corner = np.any([np.zeros(len(score), bool), *self.beside.values()], axis=0)
        self.away = np.where(at_corner, 0.0, score)  #: (ne,) what cells away from corners leave
        self.near = score - self.away  #: (ne,) what cells beside corners leave without any cut
        self.cuts = dict.fromkeys(corners, 0)
        self._sharpest = np.full(len(score), np.inf)
        for vertex, around in self.beside.items():
            self._sharpest[around] = np.minimum(self._sharpest[around], self.exponents[vertex])

    @property
    def left(self) -> np.ndarray:
        """(ne,) what cells beside corners leave: as much as the least cut of their corners does."""
        return np.max([np.zeros(len(self.near)), *map(self._beside, self.exponents)], axis=0)

    @property
    def least(self) -> float:
        """What cells beside corners leave once all of them are cut as often as there is room."""
        beside = [self._beside(v, self.room[v]) for v in self.exponents]
        return float(np.max([np.zeros(len(self.near)), *beside], axis=0).sum())

    def _beside(self, vertex: int, cuts: int | None = None) -> np.ndarray:
        """Return (ne,) what cells beside one corner leave by it after so many cuts: beside a sharper one
        between all, and as much as if they had been cut once.
        """
        exponent = self.exponents[vertex]
        cut = CUT_RATIO ** (2 * exponent * (self.cuts[vertex] if cuts is None else cuts))
        by_order = self._order / (self._order + self.raised)
        left = cut * by_order ** min(4 * exponent, POWER)
        dull = CUT_RATIO ** (exponent - self._sharpest)
        return np.where(self.beside[vertex], left * dull, 0.0) * self.near

    def worst(self) -> tuple[int | None, float]:
        """Return the corner that leaves most and may still be cut, and how much it leaves; None where all
        are cut.
        """
        left = self.left
        leaves = {
            v: float(left[self.beside[v] & (self._beside(v) >= left)].sum())
            for v in self.exponents
            if self.cuts[v] < self._most[v]
        }
        return max(leaves.items(), key=itemgetter(1), default=(None, 0.0))

    def cut(self, vertex: int) -> None:
        """Cut the cells beside a corner once more."""
        self.cuts[vertex] += 1

    def smooth(self) -> float:
        """Return what an order more reduces: the error away from corners and beside those cut."""
        touched = [self.beside[v] for v, count in self.cuts.items() if count]
        beside_cut = np.any([np.zeros(len(self.near), bool), *touched], axis=0)
        return float(self.away.sum() + BY_CUT * self.near[beside_cut].sum())


def _cuts_to(least: float, flat: Meridian, vertex: int) -> int:
    """Return how often cells at a vertex may be cut until a side there is as short as the least, m."""
    sides = flat.cells[np.array(ENDS)].transpose(1, 0, 2).reshape(2, -1)
    first, second = flat.points[:, sides[:, (sides == vertex).any(axis=0)]].transpose(1, 0, 2)
    shortest = float(np.linalg.norm(second - first, axis=0).min())
    return max(0, math.floor(math.log(shortest / least) / -math.log(CUT_RATIO)))


def refined(scene: Scene, body: Body, mesh: Meshed, score: np.ndarray, tol: float) -> Meshed | None:
    """Return the next mesh after the one that the body was built on, from the share of every cell
    (ne,) in the relative error bar of the result that needs it most, and a relative tolerance: what
    leaves most is cut, or the order raised, until what is left is predicted within the tolerance, or
    next to what corners leave that have no room for more cuts; None where no order is left to raise.
    """
    mesh_of = body.geometry
    lines = Lines(mesh_of.uncut, mesh.across)  # type: ignore[union-attr]
    corners = Corners(scene, body, score, mesh.order)
    rate, cure = _rate(mesh, corners.smooth())
    floor = corners.least
    if floor > max(tol, AIM * score.sum()):
        # what is smooth in the cells beside such a corner costs as well
        higher = min(mesh.order + ORDERS, HIGHEST)
        return replace(mesh, order=higher) if higher > mesh.order else None
    aim, most_orders = max(AIM * tol, floor / AIM), min(ORDERS, HIGHEST - mesh.order) if cure else 0
    while (smooth := corners.smooth() / rate**corners.raised) + corners.left.sum() > aim:
        vertex, leaves = corners.worst()
        if corners.raised < most_orders and (vertex is None or smooth > SMOOTH * aim):
            corners.raised += 1
        elif vertex is not None and (smooth <= SMOOTH * aim or leaves >= smooth):
            corners.cut(vertex)
        else:
            lines.halve(np.bincount(mesh_of.parent, corners.away))  # type: ignore[union-attr]
            break
    cuts = dict(mesh.cuts)
    for vertex in (vertex for vertex, count in corners.cuts.items() if count):
        place = place_of(mesh_of.meridian.points[:, vertex])  # type: ignore[union-attr]
        if place not in cuts:
            lines.cut_slender(place)
        cuts[place] = cuts.get(place, 0) + corners.cuts[vertex]
    cut = (cuts, lines.points) != (dict(mesh.cuts), list(mesh.across))
    orders = corners.raised if cut else max(corners.raised, 1)
    return replace(
        mesh,
        order=mesh.order + orders,
        cuts=cuts,
        across=tuple(lines.points),
        smooth=corners.smooth(),
        raised=orders,
    )


def _rate(mesh: Meshed, smooth: float) -> tuple[float, bool]:
    """Return the factor by which an order more reduces an error away from corners, as the last orders
    did, and whether this is a cure.
    """
    if not mesh.raised or not smooth:
        return BY_ORDER, True
    fallen = (mesh.smooth / smooth) ** (1 / mesh.raised)
    return min(max(fallen, 1 / SLOW), BY_ORDER), fallen >= 1 / SLOW
