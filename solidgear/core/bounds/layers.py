"""Layers that stiff bodies hold on both sides: rigid seats, or joints with a stiffer material.

A layer of rubber between plates gives way at its free rim, in a zone as wide as the layer is thick, and
the more so the less it can change its volume.  Cells that are wider than that see little of it, and one
order more little of what they miss: of cells of a width w at the rim of a layer of a thickness t the
energy of the error over that in one order more rises by

    c (2 nu)^4 (w / t)^2,

which is measured, as is c.  What is one cell thick and hardly changes its volume locks in both orders,
so that nothing is known of its error. A few such cells among others are enough, the fewer the more the
bulk modulus outweighs the shear modulus: they lock with the one, the rest gives way with the other.

Rigid seats side by side on a surface, with a gap between them, are no layer: see
:mod:`solidgear.core.bounds.narrow`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from solidgear.core.bounds.seat_facets import seat_facets, unit_normals
from solidgear.core.errors import NoBounds
from solidgear.core.models.solid.edges import SharpEdges, sharp_edges
from solidgear.core.safety import ALONG, LOCKING, RIM
from solidgear.core.scene.shaft import without_axis

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.models.solid.mesh import SolidMesh
    from solidgear.core.scene import Scene
    from solidgear.core.scene.parts import Material

#: distances of a face that are none, in lengths of the mesh
HAIR = 1e-9


@dataclass(frozen=True)
class Rims:
    """Edges at which held faces of a body end at its free surface."""

    place: np.ndarray  #: (3, k) middles, m
    out: np.ndarray  #: (3, k) unit normals of the held face, out of what it holds
    face: np.ndarray  #: (k,) number of the held face
    width: np.ndarray  #: (k,) of the cell there, from the free surface inwards, m
    material: np.ndarray  #: (k,) number of that which is held

    @property
    def across(self) -> np.ndarray:
        """Distance (k,) of the nearest rim of a face opposite, with the material between, m; infinite
        without any.
        """
        distance = np.full(self.face.shape, np.inf)
        for face in np.unique(self.face):
            mine = np.flatnonzero(self.face == face)
            of_material = self.material == self.material[mine[0]]
            others = np.flatnonzero(of_material & (self.face != face))
            for part in np.array_split(mine, max(1, len(mine) * len(others) // 500_000)):
                to = self.place[:, None, others] - self.place[:, part, None]
                far = np.linalg.norm(to, axis=0)
                turn = self.out[:, part].T @ self.out[:, others]
                inwards = -np.einsum("ik,ikl->kl", self.out[:, part], to)
                seen = (turn < -ALONG) & (inwards > ALONG * far)
                far[~seen] = np.inf
                distance[part] = far.min(axis=1, initial=np.inf)
        return distance


@dataclass(frozen=True)
class Layers:
    """What holds the materials of a body on a mesh."""

    mesh: SolidMesh  #: whose cells name materials by their numbers here
    materials: tuple[Material, ...]
    names: tuple[str, ...]  #: of a part made of each, in words
    rigid: tuple[np.ndarray, ...]  #: facets of every rigid seat
    held: Held
    with_axis: bool

    @classmethod
    def of(cls, scene: Scene, body: Body, mesh: SolidMesh) -> Layers:
        """Find what holds the materials of the body of a scene."""
        parts, names = _parts(scene)
        materials = tuple(dict.fromkeys(parts))
        kinds = np.array([materials.index(material) for material in parts])
        mesh = replace(mesh, segment=kinds[mesh.segment])
        firsts = tuple(names[parts.index(material)] for material in materials)
        rigid = tuple(_rigid(scene, body, mesh))
        held = _held(mesh, materials, rigid)
        return cls(mesh, materials, firsts, rigid, held, not without_axis(scene))

    @cached_property
    def sharp(self) -> SharpEdges:
        """Edges along which stress is singular."""
        return sharp_edges(self.mesh, self.materials, np.concatenate([*self.rigid, []]).astype(int))

    def refuse_locked(self) -> None:
        """Refuse a mesh with one cell across much of a layer that is held on both sides and hardly
        changes its volume: it locks, and in one order more too, so that most of the error remains
        unseen.
        """
        held = self.held
        for number, (material, name) in enumerate(zip(self.materials, self.names)):
            mine = self.mesh.segment[held.cells] == number
            if material.nu <= LOCKING or not mine.any():
                continue
            cells = np.unique(held.cells[mine])
            share = _spanning(self.mesh.mesh, cells, held.facets[mine], held.out[:, mine]).mean()
            if share * _bulk(material.nu) > _bulk(LOCKING):
                raise NoBounds(
                    f"{name}, of Poisson's ratio {material.nu:g}, is held on both sides and "
                    f"{'' if share > 0.5 else 'in places '}one cell thick, and such a layer locks "
                    "unseen: use smaller cells there",
                    finer_helps=True,
                )

    @property
    def added_share(self) -> float:
        """What rims add to the energy of an error over that which one order more finds of it."""
        rims = _rims(self.mesh, self.held, self.with_axis)
        nu = np.array([material.nu for material in self.materials])[rims.material]
        added = RIM * (2 * nu) ** 4 * (rims.width / rims.across) ** 2
        # cells along a rim differ, and all of it gives way
        means = [added[(rims.face == face) & (added > 0)] for face in np.unique(rims.face)]
        return max((float(mean.mean()) for mean in means if len(mean)), default=0.0)


def _bulk(nu: float) -> float:
    """Return the bulk modulus over the shear modulus."""
    return 2 * (1 + nu) / (3 * (1 - 2 * nu))


def _spanning(m: Any, cells: np.ndarray, facets: np.ndarray, out: np.ndarray) -> np.ndarray:
    """Return which cells (k,) have all of their corners on held facets (f,), some on one that is opposite
    to another by the normals (3, f), and not beside it in a corner of what holds them.
    """
    normal = np.zeros((3, m.p.shape[1]))
    for corners in m.facets[:, facets]:
        np.add.at(normal.T, corners, out.T)
    size = np.linalg.norm(normal, axis=0)
    of_cells = (normal / np.where(size > 0, size, 1.0))[:, m.t[:, cells]]
    opposite = np.einsum("xik,xjk->ijk", of_cells, of_cells).min(axis=(0, 1)) < -ALONG
    return opposite & (size[m.t[:, cells]] > 0).all(axis=0)


def _parts(scene: Scene) -> tuple[list[Material], list[str]]:
    """Return the materials that the cells of a mesh of a scene name by their numbers, and what is made
    of each, in words.
    """
    file = scene.body
    if file is not None and file.groups:
        return list(file.materials(scene.material)), [repr(group.label) for group in file.groups]
    names = ["the body"] if without_axis(scene) else [repr(s.name) for s in scene.segments]
    return [segment.material for segment in scene.segments], names


@dataclass(frozen=True)
class Held:
    """Facets of cells that something much stiffer holds."""

    facets: np.ndarray  #: (k,)
    cells: np.ndarray  #: (k,) that they hold
    out: np.ndarray  #: (3, k) unit normals, out of these
    face: np.ndarray  #: (k,) number of the face that they make with others


def _held(mesh: SolidMesh, materials: Sequence[Material], rigid: Sequence[np.ndarray]) -> Held:
    """Return the facets of rigid seats, and of joints seen from the softer material."""
    m = mesh.mesh
    joints, softer = _joints(mesh, materials)
    kinds = [joints, *rigid]
    facets = np.concatenate(kinds).astype(int)
    cells = np.concatenate([softer, *(m.f2t[0, seat] for seat in kinds[1:])]).astype(int)
    kind = np.repeat(np.arange(len(kinds)), [len(part) for part in kinds])
    out = unit_normals(m, facets, cells)
    kind = len(materials) * kind + mesh.segment[cells]
    return Held(facets, cells, out, _faces(m, facets, out, kind))


def _joints(mesh: SolidMesh, materials: Sequence[Material]) -> tuple[np.ndarray, np.ndarray]:
    """Return the facets between materials of unlike stiffness, and the cells on the softer side."""
    stiffness = np.array([material.E for material in materials])[mesh.segment]
    inner = np.flatnonzero(mesh.mesh.f2t[1] >= 0)
    low, high = mesh.mesh.f2t[:, inner]
    unlike = stiffness[low] != stiffness[high]
    softer = np.where(stiffness[low] < stiffness[high], low, high)
    return inner[unlike], softer[unlike]


def _rigid(scene: Scene, body: Body, mesh: SolidMesh) -> Iterator[np.ndarray]:
    """Yield the facets of every rigid seat."""
    stations = {station.name: station for station in scene.stations}
    for port in body.ports:
        station = stations.get(port.name)
        if station is not None and port.attachment == "rigid":
            yield seat_facets(scene, body, mesh, station)


def _rims(mesh: SolidMesh, held: Held, with_axis: bool) -> Rims:
    """Return the edges of held facets that are those of free ones of the same material."""
    m = mesh.mesh
    free = np.setdiff1d(mesh.boundary, held.facets)
    normals = unit_normals(m, free, m.f2t[0, free])
    if with_axis:
        # planes through the axis are cuts of halves and sectors, beyond which the body goes on
        middle = m.p[:, m.facets[:, free]].mean(axis=1)
        off = np.abs((normals * middle)[[0, 2]].sum(axis=0)) + np.abs(normals[1]) * np.ptp(m.p)
        kept = off > HAIR * np.ptp(m.p)
        free, normals = free[kept], normals[:, kept]
    # of every edge of the mesh the free facet beside it, one of each material
    edges, kinds = m.f2e[:, held.facets], mesh.segment[held.cells]
    kind_of_free = mesh.segment[m.f2t[0, free]]
    rows: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for kind in np.unique(kinds):
        facet_of = np.full(m.edges.shape[1], -1)
        own = np.flatnonzero(kind_of_free == kind)
        facet_of[m.f2e[:, free[own]]] = own
        side, which = np.nonzero((facet_of[edges] >= 0) & (kinds == kind))
        rows.append((edges[side, which], which, facet_of[edges[side, which]]))
    if not rows:
        none, no_numbers = np.zeros(0), np.zeros(0, int)
        return Rims(np.zeros((3, 0)), np.zeros((3, 0)), no_numbers, none, no_numbers)
    edge, which, beside = (np.concatenate(column) for column in zip(*rows))
    return Rims(
        m.p[:, m.edges[:, edge]].mean(axis=1),
        held.out[:, which],
        held.face[which],
        _depth(m, free[beside], m.f2t[0, free[beside]], normals[:, beside]),
        kinds[which],
    )


def _depth(m: Any, facets: np.ndarray, cells: np.ndarray, out: np.ndarray) -> np.ndarray:
    """Return how far cells reach inwards from facets, m: the middle of a tetrahedron lies at a quarter
    of its height, that of a hexahedron at half.
    """
    inside = m.p[:, m.t[:, cells]].mean(axis=1) - m.p[:, m.facets[:, facets]].mean(axis=1)
    return -(4 if len(m.facets) == 3 else 2) * (inside * out).sum(axis=0)


def _faces(m: Any, facets: np.ndarray, out: np.ndarray, kind: np.ndarray) -> np.ndarray:
    """Return numbers (k,) of the faces that facets of some kinds make with those beside them that do
    not turn away.
    """
    edges = m.f2e[:, facets]
    order = np.argsort(edges.ravel(), kind="stable")
    edge, owner = edges.ravel()[order], np.tile(np.arange(len(facets)), len(edges))[order]
    same = edge[1:] == edge[:-1]
    a, b = owner[:-1][same], owner[1:][same]
    joined = (kind[a] == kind[b]) & ((out[:, a] * out[:, b]).sum(axis=0) > ALONG)
    graph = coo_matrix((np.ones(joined.sum()), (a[joined], b[joined])), shape=2 * (len(facets),))
    return connected_components(graph, directed=False)[1]
