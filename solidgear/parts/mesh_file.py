"""A volume mesh from a file of any of the formats of :mod:`solidgear.parts.decks`: soundness,
groups and surface.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from skfem import Mesh, MeshHex1, MeshHex2, MeshTet1

from solidgear.core import listed, nearest, show
from solidgear.core.meshing.curving import ten_nodes, with_middles, with_nodes
from solidgear.core.meshing.geometry import moments_of_groups
from solidgear.core.meshing.placing import Placing
from solidgear.core.meshing.quality import MeshError, check_mesh, element_volumes, outward
from solidgear.core.scene.file_materials import FileMaterial
from solidgear.parts.decks import Deck, read
from solidgear.parts.decks.deck import KINDS, Group

#: groups that a sentence names
MOST_NAMED = 12
#: sine of the angle by which two faces must turn to be no smooth surface
TURN = 0.1
#: corners between which the middle nodes of VTK's cells lie, in its order
_TET_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_HEX_EDGES = (
    *((0, 1), (1, 2), (2, 3), (3, 0)),
    *((4, 5), (5, 6), (6, 7), (7, 4)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
)
_HEX_CORNERS = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
)


@dataclass(frozen=True)
class FileMesh:
    """A mesh from a file, in the scene."""

    mesh: Mesh  #: m
    element: str  #: ``tet4``, ``tet10``, ``hex8`` or ``hex20``
    volume: float  #: m^3
    #: (ne,) place of the group of each element among those that were named; one more for the rest
    owner: np.ndarray
    unnamed_groups: tuple[str, ...] = ()  #: groups with elements of the rest
    material_groups: tuple[str, ...] = ()  #: groups that stand for materials, where several do
    remarks: tuple[str, ...] = ()  #: oddities of the file
    #: facets of the mesh in named groups of surfaces
    patches: Mapping[str, np.ndarray] = field(default_factory=dict)
    materials: tuple[FileMaterial, ...] = ()  #: that the file gives to its groups

    def faces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the surface and the faces between groups: (3, n) points, m, (3, t) triangles, into
        which quadrilaterals are cut, and (2, t) owners on both sides, -1 outside.
        """
        f2t = self.mesh.f2t
        sides = np.where(f2t >= 0, self.owner[f2t], -1)
        facets = np.flatnonzero(sides[0] != sides[1])
        corners, sides = self.mesh.facets[:, facets], sides[:, facets]
        if len(corners) == 3:
            return self.mesh.p, corners, sides
        # scikit-fem numbers the corners of a facet by rows: 0 1 2 around, 3 across
        around = _around(self.mesh.p, corners)
        triangles = np.hstack([around[[0, 1, 2]], around[[0, 2, 3]]])
        return self.mesh.p, triangles, np.hstack([sides, sides])

    def volumes(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the volume (count,) of each of `count` groups, m^3, and its first moment (count, 3),
        m^4.
        """
        places = self.mesh.doflocs[:, self.mesh.dofs.element_dofs]
        whole = moments_of_groups(self.mesh.elem(), places, self.owner, np.zeros(count))
        volumes = np.bincount(self.owner, weights=element_volumes(self.mesh), minlength=count)
        return volumes, whole[:, 0, 1:]


def _around(p, quads) -> np.ndarray:
    """Return corners of quadrilaterals in the order around them."""
    middle = p[:, quads].mean(axis=1, keepdims=True)
    spokes = p[:, quads] - middle
    first = spokes[:, 0] / np.linalg.norm(spokes[:, 0], axis=0)
    normal = np.cross(spokes[:, 0].T, spokes[:, 1].T).T
    normal_across = np.cross(spokes[:, 0].T, spokes[:, 2].T).T
    longer = np.linalg.norm(normal, axis=0) > np.linalg.norm(normal_across, axis=0)
    normal = np.where(longer, normal, normal_across)
    second = np.cross(normal.T, first.T).T
    second /= np.linalg.norm(second, axis=0)
    angle = np.arctan2(
        np.einsum("ikq,iq->kq", spokes, second), np.einsum("ikq,iq->kq", spokes, first)
    )
    return np.take_along_axis(quads, np.argsort(angle, axis=0), axis=0)


def mesh_from(path: str, place: Placing, names: tuple[str, ...] = ()) -> FileMesh:
    """Read the volume mesh of a file, in which the groups of some names have materials of their
    own.

    MeshError for a file that cannot be read, a surface mesh, several kinds of elements, elements
    that are not assembled here or are inverted, a mesh in pieces or with a hole where an element is
    missing, and groups that are not there or share elements.
    """
    deck = read(path)
    points = place.to_scene(deck.points)
    hexes = deck.kind.startswith("hex")
    _refuse_unsound(deck, points, len(_HEX_CORNERS) if hexes else 4)
    owner, unnamed_groups = owners(deck, names)
    mesh = _hexes(points, deck.cells) if hexes else _tets(points, deck.cells)
    file_mesh = FileMesh(
        mesh,
        element=KINDS[deck.kind],
        volume=check_mesh(mesh).volume,
        owner=owner,
        unnamed_groups=unnamed_groups,
        material_groups=_material_groups(deck),
        remarks=deck.remarks,
        patches=_patches(mesh, deck),
        materials=deck.materials,
    )
    _refuse_holes(file_mesh)
    return replace(file_mesh, remarks=(*file_mesh.remarks, *_pit_remarks(file_mesh, deck)))


def _patches(mesh: Mesh, deck: Deck) -> dict[str, np.ndarray]:
    """Return the facets of named groups of surfaces, those that lie on the surface of the mesh."""
    used = np.unique(deck.cells[: len(mesh.t)])
    outside = mesh.boundary_facets()
    facet_of = {
        tuple(corners): facet
        for corners, facet in zip(np.sort(mesh.facets[:, outside], 0).T, outside)
    }
    out = {}
    for name, corners in deck.patches.items():
        places = np.sort(np.searchsorted(used, corners), axis=0).T
        facets = [facet_of[tuple(face)] for face in places if tuple(face) in facet_of]
        if facets:
            out[name] = np.unique(facets)
    return out


def _refuse_unsound(deck: Deck, points, corners: int) -> None:
    """Refuse a deck whose mesh is not that of one part."""
    cells = deck.cells
    if cells.min() < 0 or cells.max() >= points.shape[1]:
        raise MeshError("an element names a node that is not there")
    if not np.isfinite(points[:, cells]).all():
        raise MeshError("a node has a coordinate that is no number")
    nodes = np.sort(cells, axis=0)
    twice = np.flatnonzero((nodes[1:] == nodes[:-1]).any(axis=0))
    if len(twice):
        raise MeshError(f"{deck.label(twice[0])} has a node twice")
    _, first, original = np.unique(nodes, axis=1, return_index=True, return_inverse=True)
    if len(first) < nodes.shape[1]:
        copy = int(np.flatnonzero(first[original.ravel()] != np.arange(nodes.shape[1]))[0])
        groups = [f'"{g.name}"' for g in deck.groups if copy in g.elements]
        location = f"{deck.label(copy)}: " if deck.lines is not None else ""
        more = f", as an element of {groups[0]} too: its groups overlap" if groups else ""
        raise MeshError(f"{location}an element is there twice{more}")
    label = _labels(cells[:corners], points.shape[1])
    pieces, count = np.unique(label, return_counts=True)
    if len(pieces) > 1:
        least = pieces[np.argmin(count)]
        cell = int(np.flatnonzero(label == least)[0])
        x, y, z = 1e3 * points[:, cells[:corners, cell]].mean(axis=1)
        place = f"({x:.4g}, {y:.4g}, {z:.4g}) mm"
        raise MeshError(
            f"falls into {len(pieces)} pieces that share no node, one near {place} in the scene: "
            "merge nodes at one place, or leave all but one piece out"
        )


def _labels(cells: np.ndarray, nodes: int) -> np.ndarray:
    """Return (n,) the number of the piece that each cell or face (corners, n) belongs to, of all
    that share nodes.
    """
    first = np.repeat(cells[:1], len(cells) - 1, axis=0).ravel()
    joined = sp.coo_matrix((np.ones(len(first)), (first, cells[1:].ravel())), shape=(nodes, nodes))
    return connected_components(joined, directed=False)[1][cells[0]]


#: faces around a hole up to which it is one that elements are missing from, and none of the part
FEW_FACES = 12


def _refuse_holes(file_mesh: FileMesh) -> None:
    """Refuse holes inside that a few lost elements leave."""
    points, faces = file_mesh.mesh.p, file_mesh.mesh.facets[:, file_mesh.mesh.boundary_facets()]
    label = _labels(faces, points.shape[1])
    holes, count = np.unique(label, return_counts=True)
    for hole, faces_around in zip(holes, count):
        if len(holes) > 1 and faces_around <= FEW_FACES:
            place = 1e3 * points[:, np.unique(faces[:, label == hole])].mean(axis=1)
            raise MeshError(
                "has a hole of {} faces inside, near ({:.4g}, {:.4g}, {:.4g}) mm in the scene: an "
                "element is missing there".format(faces_around, *place)
                + "".join(f", for {remark}" for remark in file_mesh.remarks)
            )


def _pit_remarks(file_mesh: FileMesh, deck: Deck) -> Iterator[str]:
    """Yield a remark on a surface that lost elements have left."""
    if not file_mesh.element.startswith("tet"):
        return
    places = 1e3 * lost_elements(file_mesh.mesh)
    if places.shape[1]:
        x, y, z = places[:, 0]
        last = f" (the last one is in line {deck.lines[-1]})" if deck.lines is not None else ""
        yield (
            f"the surface has pits as large as an element, the first near ({x:.4g}, {y:.4g}, "
            f"{z:.4g}) mm in the scene: unless left out on purpose, elements are missing there or "
            f"their list ends early{last}; compare with the mass of the part (mass_check)"
        )


def _tets(points, cells) -> Mesh:
    if len(cells) == 10:
        return ten_nodes(points, cells[:4], *_middles(points, cells, _TET_EDGES))
    used, small = np.unique(cells, return_inverse=True)
    return MeshTet1(
        np.ascontiguousarray(points[:, used]),
        np.ascontiguousarray(small.reshape(4, -1).astype(np.int32)),
    )


def _middles(points, cells, edges) -> tuple[np.ndarray, np.ndarray]:
    """Return ends (2, k) and middle nodes (3, k) of all edges, edge by edge."""
    ends = np.moveaxis(cells[np.array(edges)], 1, 0).reshape(2, -1)
    count = cells.shape[0] - len(edges)
    return ends, points[:, cells[count:]].reshape(3, -1)


def _hexes(points, cells) -> Mesh:
    used, small = np.unique(cells[:8], return_inverse=True)
    corners = small.reshape(8, -1)
    order = [
        int(np.flatnonzero((_HEX_CORNERS == c).all(axis=1))[0])
        for c in MeshHex1.elem().doflocs.round().astype(int)
    ]
    mesh = MeshHex1(
        np.ascontiguousarray(points[:, used]),
        np.ascontiguousarray(corners[order].astype(np.int32)),
    )
    if len(cells) == 8:
        return mesh
    ends, middles = _middles(points, cells, _HEX_EDGES)
    return _serendipity(
        with_middles(MeshHex2.from_mesh(mesh), np.searchsorted(used, ends), middles)
    )


def _serendipity(mesh: Any) -> Any:
    """Return the mesh with the middles of faces and cells where twenty nodes put them."""
    doflocs = mesh.doflocs.copy()
    element = mesh.elem()
    nodes = mesh.doflocs[:, mesh.dofs.element_dofs]  # (3, 27, ne)
    corners, edges = nodes[:, :8], nodes[:, 8:20]
    places = element.doflocs
    for local in range(20, 26):
        axis = int(np.flatnonzero(places[local] != 0.5)[0])
        side = places[local, axis]
        near_corners = np.flatnonzero(places[:8, axis] == side)
        near_edges = np.flatnonzero(places[8:20, axis] == side)
        value = 0.5 * edges[:, near_edges].sum(axis=1) - 0.25 * corners[:, near_corners].sum(axis=1)
        doflocs[:, mesh.dofs.element_dofs[local]] = value
    doflocs[:, mesh.dofs.element_dofs[26]] = 0.25 * (edges.sum(axis=1) - corners.sum(axis=1))
    return with_nodes(mesh, doflocs)


def there_are(names: Sequence[str]) -> str:
    """Return a clause that lists the groups of a file.

    Examples
    --------
    >>> there_are(["core", "sleeve"])
    'there are "core", "sleeve"'
    """
    if not names:
        return "there are no groups of volume elements in it"
    quoted = [show(name) for name in names[:MOST_NAMED]]
    more = [f"{len(names) - MOST_NAMED} more"] if len(names) > MOST_NAMED else []
    return f"there are {listed([*quoted, *more])}"


def _name_in_file(name: str, file_names: Sequence[str]) -> str | None:
    """Return the name of a group as the file writes it, which the scene may write in letters of
    either size; None where there is none.
    """
    if name in file_names:
        return name
    matches = [file_name for file_name in file_names if file_name.lower() == name.lower()]
    return matches[0] if len(matches) == 1 else None


def owners(deck: Deck, names: Sequence[str]) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the place (ne,) of the group of each element among those with materials of their own,
    one more for the rest; and the groups with elements of the rest. MeshError for a group that is
    not there, or two that share elements.
    """
    by_name = {group.name: group for group in deck.groups}
    owner = np.full(deck.cells.shape[1], len(names))
    for place, name in enumerate(names):
        file_name = _name_in_file(name, list(by_name))
        if file_name is None:
            raise MeshError(
                f"has no group {show(name)}{nearest(name, by_name)}; {there_are(list(by_name))}"
            )
        elements = by_name[file_name].elements
        shared = np.flatnonzero(owner[elements] != len(names))
        if len(shared):
            first_name = names[owner[elements[shared[0]]]]
            which = "element is" if len(shared) == 1 else "elements are"
            raise MeshError(
                f"{len(shared)} {which} in both {show(first_name)} and {show(name)}, one of them "
                f"{_short(deck, int(elements[shared[0]]))}: groups with materials must not "
                f"overlap; {there_are(list(by_name))}"
            )
        owner[elements] = place
    return owner, tuple(g.name for g in deck.groups if (owner[g.elements] == len(names)).any())


def _short(deck: Deck, place: int) -> str:
    return f"in {deck.label(place)}" if deck.lines is not None else deck.label(place)


def _material_groups(deck: Deck) -> tuple[str, ...]:
    """Return the groups that stand for materials, where there are at least two that share no
    element.
    """
    groups: list[Group] = [g for g in deck.groups if g.of_material]
    parts = [g for g in groups if len(g.elements) < deck.cells.shape[1]]
    return tuple(g.name for g in parts) if len(parts) > 1 else ()


def lost_elements(mesh: Any) -> np.ndarray:
    """Return points (3, n), m, where the surface is as if an element were lost; an element with
    three free faces gives three.

    A lost element at the surface leaves two or three faces that meet in a re-entrant edge, while
    the two nodes across that edge are still joined, by an edge of the elements beside it. In a
    sound mesh they are not: re-entrant edges of a part have air between their two sides. But for
    the corner of a pocket, where a third wall may join them; there the walls go on beyond the three
    faces, where a lost element leaves a rim.
    """
    p, outside = mesh.p, mesh.boundary_facets()
    faces, normal = mesh.facets[:, outside], outward(mesh, outside)
    normal /= np.linalg.norm(normal, axis=0)
    # every edge of the surface with the face on either side, and the corner across
    corners = np.array([(0, 1, 2), (0, 2, 1), (1, 2, 0)])
    pairs = np.sort(faces[corners[:, :2]], axis=1)
    total = p.shape[1]
    key = (pairs[:, 0].astype(np.int64) * total + pairs[:, 1]).ravel()
    across, face = faces[corners[:, 2]].ravel(), np.tile(np.arange(faces.shape[1]), 3)
    order = np.argsort(key, kind="stable")
    first = np.flatnonzero(np.r_[True, np.diff(key[order]) != 0])
    two = first[np.diff(np.r_[first, len(order)]) == 2]
    a_side, b_side = order[two], order[two + 1]
    a, b = np.divmod(key[a_side], total)
    along = (p[:, b] - p[:, a]) / np.linalg.norm(p[:, b] - p[:, a], axis=0)
    reach = p[:, across[b_side]] - p[:, a]
    wide = np.linalg.norm(reach - along * (reach * along).sum(axis=0), axis=0)
    turn = np.zeros(len(key))  # above zero where re-entrant
    turn[a_side] = turn[b_side] = (normal[:, face[a_side]] * reach).sum(axis=0) / wide
    lo, hi = np.sort([across[a_side], across[b_side]], axis=0)
    edges = np.sort(mesh.edges.astype(np.int64), axis=0)
    joined = np.isin(lo.astype(np.int64) * total + hi, edges[0] * total + edges[1])
    rim = np.abs(turn.reshape(3, -1)).min(axis=0) > TURN
    lost = (turn[a_side] > TURN) & joined & rim[face[a_side]] & rim[face[b_side]]
    return (p[:, a[lost]] + p[:, b[lost]]) / 2
