"""Meshes of a harmonic solid that are refined where their error bars come from.

The first mesh has one cell a band and strip and no cut at all. Where the local problems show that a
corner decides the error bar, the cells around it are cut towards it, as often as theory says that
it takes: a cut of ratio q leaves the share ``q^(2 a)`` of the cost of a corner of exponent a. The
error away from corners falls with the order of the elements.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body
from solidgear.core.bounds.harmonic import richer_space
from solidgear.core.bounds.lines import Lines, place_of
from solidgear.core.meshing.corners import corner_exponent
from solidgear.core.meshing.meridian import CUT_RATIO
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
#: cuts that one step may add to a corner, and orders to the mesh
CUTS, ORDERS = 4, 2
#: largest cell of the first mesh, in local outer radii
SIZE = 4.0
#: orders that left more than this each of an error bar are no longer the cure
SLOW = 0.5

#: exponents of displacement at the ends of rigid and of averaged seats, planes and joined materials
EXPONENT = {"rigid": 0.5, "load": 1.0, "section": 1.0, "material": 0.7}


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


def refined(scene: Scene, body: Body, mesh: Meshed, score: np.ndarray, tol: float) -> Meshed:
    """Return the next mesh after the one that the body was built on, from the share of every cell
    (ne,) in the relative error bar of the result that needs it most, and a relative tolerance.
    """
    corners, mesh_of = richer_space(coned(scene), body).corners, body.geometry
    cells, uncut = mesh_of.meridian.cells, mesh_of.uncut  # type: ignore[union-attr]
    away = score.copy()
    needs: dict[int, tuple[float, float]] = {}
    for vertex, (kind, angle) in corners.items():
        around = (cells == vertex).any(axis=0)
        needs[vertex] = float(score[around].sum()), corner_strength(kind, angle)
        away[around] = 0.0
    aim = AIM * tol
    most = aim / 2 / max(1, sum(share > aim / 8 for share, _ in needs.values()))
    cuts, lines, near_cuts = dict(mesh.cuts), Lines(uncut, mesh.across), 0.0
    for vertex, (share, exponent) in needs.items():
        if share <= most:
            continue
        place = place_of(mesh_of.meridian.points[:, vertex])  # type: ignore[union-attr]
        more = math.ceil(math.log(share / most) / (2 * exponent * math.log(1 / CUT_RATIO)))
        if place not in cuts:
            lines.cut_slender(place)
        cuts[place] = min(cuts.get(place, 0) + min(max(more, 1), CUTS), 12)
        near_cuts += BY_CUT * share
    smooth = max(float(away.sum()), near_cuts)
    order = mesh.order
    if smooth > aim / 2:
        slow = mesh.raised > 0 and smooth > SLOW**mesh.raised * mesh.smooth
        if order >= HIGHEST or slow and not near_cuts:
            lines.halve(np.bincount(mesh_of.parent, away))  # type: ignore[union-attr]
        else:
            rate = BY_ORDER
            if mesh.raised and not near_cuts:  # as orders did before
                rate = min(max((mesh.smooth / smooth) ** (1 / mesh.raised), 1 / SLOW), BY_ORDER)
            more = math.ceil(math.log(2 * smooth / aim) / math.log(rate))
            if order + more > HIGHEST:
                lines.halve(np.bincount(mesh_of.parent, away))  # type: ignore[union-attr]
            order = min(order + min(max(more, 1), ORDERS), HIGHEST)
    if (cuts, lines.points, order) == (dict(mesh.cuts), list(mesh.across), mesh.order):
        order = order + 1
    return replace(
        mesh,
        order=order,
        cuts=cuts,
        across=tuple(lines.points),
        smooth=smooth,
        raised=order - mesh.order,
    )


def corner_strength(kind: str, angle: float) -> float:
    """Return the exponent of displacement at a corner (Williams 1952) of a kind of
    :func:`solidgear.core.bounds.richer_space.singular_vertices` and an angle of material, rad: the less, the
    sharper.

    Examples
    --------
    >>> round(corner_strength("re-entrant", 3 * math.pi / 2), 3)
    0.544
    """
    exponent = EXPONENT.get(kind, 1.0)
    if kind == "rigid" and angle > math.pi + 0.02:
        return 1 / 3
    return min(exponent, corner_exponent(angle)) if angle > math.pi else exponent
