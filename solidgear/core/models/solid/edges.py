"""Edges of a volume mesh along which stress is singular, each with the exponent of what meets there.

Of the surface: concave edges, borders of what a rigid body holds, ends of joints of materials.  Inside:
where joints of materials turn or meet.  Angles are those of the curved surface in the middle of an edge,
materials those of the cells around it, and the exponent is that of wedges side by side
(:mod:`solidgear.core.meshing.wedge`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.meeting import Meeting, merged
from solidgear.core.meshing.wedge import wedge_exponent
from solidgear.core.safety import ROUGH, TURNED

if TYPE_CHECKING:
    from solidgear.core.models.solid.mesh import SolidMesh
    from solidgear.core.scene.parts import Material


@dataclass(frozen=True)
class SharpEdges:
    """Edges of a mesh at which displacement goes with a power below one of the distance."""

    numbers: np.ndarray  #: (k,) of edges of the mesh
    exponents: np.ndarray  #: (k,)
    joined: np.ndarray  #: (k,) whether several materials meet

    @property
    def sharpest(self) -> float:
        """The least exponent, one without any edge."""
        return float(self.exponents.min(initial=1.0))

    def at_sharpest(self, mesh: SolidMesh) -> str:
        """Return where the sharpest edge is, in words."""
        if not len(self.numbers):
            return ""
        ends = mesh.mesh.edges[:, self.numbers[self.exponents.argmin()]]
        x, y, z = 1e3 * mesh.mesh.p[:, ends].mean(axis=1) + 0.0
        return f"edge at x = {x:.4g}, y = {y:.4g}, z = {z:.4g} mm"

    def exponents_on(self, edges: np.ndarray) -> np.ndarray:
        """Return the exponents at edges of the mesh (n,), one where stress is not singular."""
        out = np.ones(1 + max(edges.max(initial=0), self.numbers.max(initial=0)))
        out[self.numbers] = self.exponents
        return out[edges]


def sharp_edges(
    mesh: SolidMesh,
    materials: Sequence[Material],
    held: np.ndarray,
    surface: np.ndarray | None = None,
) -> SharpEdges:
    """Return the edges of a mesh along which stress is singular.

    Parameters
    ----------
    mesh : SolidMesh
        Whose cells name materials by their numbers.
    materials : sequence of Material
    held : (h,) array of int
        Facets that rigid bodies hold.
    surface : (f,) array of int, optional
        Facets of the surface where others are cuts, beyond which the body goes on.
    """
    m = mesh.mesh
    kinds = list(dict.fromkeys((material.E, material.nu) for material in materials))
    kind = np.array([kinds.index((material.E, material.nu)) for material in materials])
    mesh = replace(mesh, segment=kind[mesh.segment])
    materials = [materials[int(np.flatnonzero(kind == k)[0])] for k in range(len(kinds))]
    facets = mesh.boundary if surface is None else surface
    is_held = np.zeros(m.facets.shape[1], bool)
    is_held[held] = True
    edge, sides, turn = _turns(mesh, facets)
    turned = ROUGH * np.round(turn / ROUGH)
    joints = _joints(mesh)
    on_joint = np.unique(m.f2e[:, joints])
    ends = np.isin(edge, on_joint)
    border = is_held[sides[0]] != is_held[sides[1]]
    found: list[tuple[int, float, bool]] = []
    for k in np.flatnonzero(((turned > (TURNED - 0.5) * ROUGH) | border) & ~ends):
        wedge = (max(ROUGH, pi + float(turned[k])), materials[mesh.segment[m.f2t[0, sides[0, k]]]])
        first, last = (bool(is_held[side]) for side in sides[:, k])
        found.append((int(edge[k]), Meeting((wedge,), (first, last)).exponent, False))
    around = _Around(mesh, materials, np.concatenate([edge[ends], _inner_corners(mesh, joints)]))
    for k in np.flatnonzero(ends):
        row = around.wedges(int(edge[k]), int(sides[0, k]), pi + float(turn[k]))
        first, last = (bool(is_held[side]) for side in sides[:, k])
        found.append((int(edge[k]), Meeting(tuple(row), (first, last)).exponent, len(row) > 1))
    for number in around.numbers[len(edge[ends]) :]:
        row = around.wedges(int(number), None, 2 * pi)
        found.append((int(number), wedge_exponent(row, closed=True), True))
    sharp = [entry for entry in found if entry[1] < 1]
    numbers, exponents, joined = zip(*sharp) if sharp else ((), (), ())
    return SharpEdges(np.array(numbers, int), np.array(exponents), np.array(joined, bool))


def _turns(mesh: SolidMesh, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the edges (n,) between two of some facets of the surface, these (2, n), and by how much
    the surface turns in the middle of the edge, rad, into the material above zero.
    """
    m, refdom = mesh.mesh, mesh.mesh.refdom
    ends = [frozenset(pair) for pair in refdom.edges]
    edges, sides, normals = [], [], []
    for place, cells in mesh.local_facets(facets):
        corners = refdom.facets[place]
        coordinates = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])[: len(corners)]
        if len(corners) == 3:
            coordinates = np.array([(0, 0), (1, 0), (0, 1)])
        middles = (coordinates + np.roll(coordinates, -1, axis=0)) / 2
        points, s, t = mesh.on_facet(place, middles.T)
        tangent = mesh.tabulate(points, cells).tangent
        normal = np.cross(tangent @ s, tangent @ t)
        inwards = m.p[:, m.t[:, cells]].mean(axis=1) - m.p[:, m.t[corners][:, cells]].mean(axis=1)
        normal *= -np.sign(np.einsum("eqx,xe->eq", normal, inwards))[..., None]
        around = zip(corners, np.roll(corners, -1))
        local = [ends.index(frozenset(pair)) for pair in around]
        edges.append(m.t2e[local][:, cells].T.ravel())
        sides.append(np.repeat(m.t2f[place, cells], len(local)))
        normals.append((normal / np.linalg.norm(normal, axis=2)[..., None]).reshape(-1, 3))
    edge, side, out = (np.concatenate(part) for part in (edges, sides, normals))
    _, first, count = np.unique(np.sort(edge), return_index=True, return_counts=True)
    order = np.argsort(edge, kind="stable")
    pairs = np.array([order[first[count == 2]], order[first[count == 2] + 1]])
    one, other = out[pairs]
    turn = np.arccos(np.clip((one * other).sum(axis=1), -1.0, 1.0))
    number, faces = edge[pairs[0]], side[pairs]
    rising = (one.T * _away(mesh, number, faces[1])).sum(axis=0) > 0
    return number, faces, np.where(rising, turn, -turn)


def _away(mesh: SolidMesh, edges: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Return unit vectors (3, n) along facets away from edges of theirs."""
    m = mesh.mesh
    start, end = m.p[:, m.edges[:, edges]].transpose(1, 0, 2)
    along = (end - start) / np.linalg.norm(end - start, axis=0)
    away = m.p[:, m.facets[:, facets]].mean(axis=1) - (start + end) / 2
    away -= along * (along * away).sum(axis=0)
    return away / np.linalg.norm(away, axis=0)


def _joints(mesh: SolidMesh) -> np.ndarray:
    """Return the facets between cells of two kinds."""
    inner = np.flatnonzero(mesh.mesh.f2t[1] >= 0)
    low, high = mesh.segment[mesh.mesh.f2t[:, inner]]
    return inner[low != high]


def _inner_corners(mesh: SolidMesh, joints: np.ndarray) -> np.ndarray:
    """Return the edges inside a mesh at which joints of materials, given as facets, turn or meet."""
    m = mesh.mesh
    edges, facets = m.f2e[:, joints].ravel(), np.tile(joints, len(m.f2e))
    order = np.argsort(edges, kind="stable")
    numbers, first, count = np.unique(edges[order], return_index=True, return_counts=True)
    outside = np.isin(numbers, m.f2e[:, mesh.boundary])
    two = ~outside & (count == 2)
    one, other = (_away(mesh, numbers[two], facets[order[first[two] + k]]) for k in (0, 1))
    turn = pi - np.arccos(np.clip((one * other).sum(axis=0), -1.0, 1.0))
    turns = turn > (TURNED - 0.5) * ROUGH
    return np.concatenate([numbers[two][turns], numbers[~outside & (count > 2)]])


class _Around:
    """Cells around some edges of a mesh."""

    def __init__(self, mesh: SolidMesh, materials: Sequence[Material], numbers: np.ndarray):
        self.mesh, self.materials, self.numbers = mesh, materials, numbers
        m = mesh.mesh
        row, facets = np.nonzero(np.isin(m.f2e, numbers))
        edges = m.f2e[row, facets]
        away = _away(mesh, edges, facets).T
        #: by edges their facets, with the direction away from the edge
        self.facets: dict[int, dict[int, np.ndarray]] = {int(number): {} for number in numbers}
        for edge, facet, vector in zip(edges, facets, away):
            self.facets[int(edge)][int(facet)] = vector

    def wedges(self, edge: int, start: int | None, angle: float) -> list[tuple[float, Material]]:
        """Return the wedges side by side around an edge, from a facet of the surface on or all around,
        which make up an angle, rad.
        """
        facets = self.facets[edge]
        facet = self._joint(facets) if start is None else start
        row: list[tuple[float, Material]] = []
        total = 0.0
        for cell, before, after in self._walk(facets, facet):
            part = float(np.arccos(np.clip(facets[before] @ facets[after], -1.0, 1.0)))
            row.append((part, self.materials[self.mesh.segment[cell]]))
            total += part
        return [
            (ROUGH * max(1, round(angle * part / total / ROUGH)), material)
            for part, material in merged(row)
        ]

    def _joint(self, facets: dict[int, np.ndarray]) -> int:
        """Return a facet between two materials."""
        m = self.mesh
        kinds = {facet: m.segment[m.mesh.f2t[:, facet]] for facet in facets}
        return next(facet for facet, (low, high) in kinds.items() if low != high)

    def _walk(self, facets: dict[int, np.ndarray], facet: int) -> Iterator[tuple[int, int, int]]:
        """Yield cells around an edge, each with its two facets there, from a facet on."""
        f2t, start = self.mesh.mesh.f2t, facet
        cell = int(f2t[0, facet])
        while cell >= 0:
            after = next(k for k in facets if k != facet and cell in f2t[:, k])
            yield cell, facet, after
            facet = after
            if facet == start:
                return
            cell = int(f2t[:, facet].sum() - cell)
