"""A volume mesh from a file: gmsh, Abaqus, Nastran or VTK, as meshio reads them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from skfem import Mesh, MeshHex1, MeshHex2, MeshTet1, MeshTet2

from solidgear.meshing.placing import Placing
from solidgear.meshing.quality import MeshError, check_mesh

#: how a file ends, and the module of meshio that reads it
FORMATS = {".msh": "gmsh", ".inp": "abaqus", ".bdf": "nastran", ".nas": "nastran", ".vtu": "vtu"}
#: meshio's kinds of cells that are assembled here, and what they are called
KINDS = {
    "tetra": "tet4",
    "tetra10": "tet10",
    "hexahedron": "hex8",
    "hexahedron20": "hex20",
}
#: kinds of cells of a volume that are not
OTHERS = ("wedge", "pyramid", "hexahedron", "tetra", "polyhedron", "VTK_LAGRANGE")
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
    """A mesh from a file, in the scene.

    Attributes
    ----------
    mesh : skfem mesh
        m.
    element : str
        ``tet4``, ``tet10``, ``hex8`` or ``hex20``.
    volume : float
        m^3.
    """

    mesh: Mesh
    element: str
    volume: float

    def skin(self) -> tuple[np.ndarray, np.ndarray]:
        """Points (3, n) and triangles (3, t) of its surface; quadrilaterals are cut in two."""
        corners = self.mesh.facets[:, self.mesh.boundary_facets()]
        if len(corners) == 3:
            return self.mesh.p, corners
        # scikit-fem numbers the corners of a facet by rows: 0 1 2 around, 3 across
        around = _around(self.mesh.p, corners)
        return self.mesh.p, np.hstack([around[[0, 1, 2]], around[[0, 2, 3]]])


def _around(p, quads) -> np.ndarray:
    """Corners of quadrilaterals in the order around them."""
    middle = p[:, quads].mean(axis=1, keepdims=True)
    spokes = p[:, quads] - middle
    first = spokes[:, 0] / np.linalg.norm(spokes[:, 0], axis=0)
    normal = np.cross(spokes[:, 0].T, spokes[:, 1].T).T
    other = np.cross(spokes[:, 0].T, spokes[:, 2].T).T
    longer = np.linalg.norm(normal, axis=0) > np.linalg.norm(other, axis=0)
    normal = np.where(longer, normal, other)
    second = np.cross(normal.T, first.T).T
    second /= np.linalg.norm(second, axis=0)
    angle = np.arctan2(
        np.einsum("ikq,iq->kq", spokes, second), np.einsum("ikq,iq->kq", spokes, first)
    )
    return np.take_along_axis(quads, np.argsort(angle, axis=0), axis=0)


def mesh_from(path: str, place: Placing) -> FileMesh:
    """The volume mesh of a file.

    Parameters
    ----------
    path : str
    place : Placing

    Returns
    -------
    FileMesh

    Raises
    ------
    MeshError
        A file that cannot be read, a surface mesh, several kinds of elements, elements that are not
        assembled here or are inverted, or a mesh in pieces.
    """
    points, kind, cells = _read(path)
    points = place.of(points)
    _sound(points, cells, len(_HEX_CORNERS) if kind.startswith("hex") else 4)
    mesh = _tets(points, cells) if kind.startswith("tetra") else _hexes(points, cells)
    return FileMesh(mesh, KINDS[kind], check_mesh(mesh).volume)


def _read(path: str) -> tuple[np.ndarray, str, np.ndarray]:
    """Points (3, n), kind of cells and cells (nodes, ne) of a file."""
    ending = Path(path).suffix.lower()
    if ending == ".unv":
        raise MeshError(
            "universal files (.unv) cannot be read here: write the mesh as .msh, .inp, .bdf or .vtu"
        )
    if ending not in FORMATS:
        raise MeshError(
            f"a mesh file that ends in {ending or 'nothing'} is unknown; known are "
            f"{', '.join(FORMATS)}"
        )
    found = _parsed(path, ending)
    points = np.asarray(found.points, float)
    if points.ndim != 2 or points.shape[1] != 3:
        raise MeshError("its nodes are not points in space")
    by_kind: dict[str, list[np.ndarray]] = {}
    for block in found.cells:
        if len(block.data):
            by_kind.setdefault(block.type, []).append(np.asarray(block.data, np.int64))
    volumes = [kind for kind in by_kind if kind.startswith(OTHERS)]
    if not volumes:
        counts = ", ".join(f"{sum(map(len, v))} {kind}" for kind, v in by_kind.items())
        raise MeshError(
            f"holds no volume elements ({counts or 'no elements at all'}): mesh the inside too"
        )
    unknown = [kind for kind in volumes if kind not in KINDS]
    if unknown or len(volumes) > 1:
        counts = ", ".join(f"{sum(map(len, by_kind[kind]))} {kind}" for kind in volumes)
        raise MeshError(
            f"holds {counts}; wanted is one kind of {', '.join(KINDS)}, for no other is assembled"
        )
    return points.T, volumes[0], np.concatenate(by_kind[volumes[0]]).T


def _parsed(path: str, ending: str) -> Any:
    import importlib

    import meshio

    read: Callable = importlib.import_module(f"meshio.{FORMATS[ending]}").read
    try:
        return read(path)
    except OSError as error:
        raise MeshError(f"cannot be read ({error.strerror or error})") from error
    except (Exception, SystemExit) as error:  # whatever a parser meets in a file that is none
        said = str(error) if isinstance(error, (ValueError, meshio.ReadError)) else ""
        what = f" ({' '.join(said.split())[:120]})" if said else ": it is broken or cut off"
        raise MeshError(f"cannot be read as {FORMATS[ending]}{what}") from error


def _sound(points, cells, corners: int) -> None:
    """Refuse what is no mesh of one part."""
    if cells.min() < 0 or cells.max() >= points.shape[1]:
        raise MeshError("an element names a node that is not there")
    if not np.isfinite(points[:, cells]).all():
        raise MeshError("a node has a coordinate that is no number")
    own = np.sort(cells, axis=0)
    twice = np.flatnonzero((own[1:] == own[:-1]).any(axis=0))
    if len(twice):
        raise MeshError(f"element {twice[0] + 1} has a node twice")
    if (
        len(np.unique(own[:corners], axis=1).T) < own.shape[1]
        and len(np.unique(own, axis=1).T) < (own.shape[1])
    ):
        raise MeshError("an element is there twice")
    n = points.shape[1]
    first = np.repeat(cells[:1], corners - 1, axis=0).ravel()
    joined = sp.coo_matrix((np.ones(len(first)), (first, cells[1:corners].ravel())), shape=(n, n))
    _, label = connected_components(joined, directed=False)
    pieces, count = np.unique(label[cells[0]], return_counts=True)
    if len(pieces) > 1:
        small = cells[0, label[cells[0]] == pieces[np.argmin(count)]]
        at = "({:.4g}, {:.4g}, {:.4g})".format(*points[:, small].mean(axis=1))
        raise MeshError(
            f"falls into {len(pieces)} pieces that share no node, one near {at} m in the scene: "
            "merge nodes at one place, or leave all but one piece out"
        )


def _tets(points, cells) -> Mesh:
    used, small = np.unique(cells[:4], return_inverse=True)
    corners = small.reshape(4, -1)
    mesh = MeshTet1(
        np.ascontiguousarray(points[:, used]), np.ascontiguousarray(corners.astype(np.int32))
    )
    if len(cells) == 4:
        return mesh
    return _with_middles(MeshTet2.from_mesh(mesh), corners, _TET_EDGES, points[:, cells[4:]])


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
    curved = _with_middles(MeshHex2.from_mesh(mesh), corners, _HEX_EDGES, points[:, cells[8:20]])
    return _serendipity(curved)


def _with_middles(mesh: Any, corners, edges, middles) -> Any:
    """A second-order mesh with its middle nodes where the file has them."""
    pairs = corners[np.array(edges)]  # (edge, 2, ne)
    total = mesh.p.shape[1]
    key = pairs.min(axis=1).astype(np.int64) * total + pairs.max(axis=1)
    key, first = np.unique(key.ravel(), return_index=True)
    own = np.sort(mesh.edges.astype(np.int64), axis=0)
    doflocs = mesh.doflocs.copy()
    at = first[np.searchsorted(key, own[0] * total + own[1])]
    # nodes are listed cell by cell for each edge
    doflocs[:, mesh.dofs.edge_dofs[0]] = middles.reshape(3, -1)[:, at]
    return replace(mesh, doflocs=doflocs)


def _serendipity(mesh: Any) -> Any:
    """Middles of faces and cells as twenty nodes make them."""
    doflocs = mesh.doflocs.copy()
    element = mesh.elem()
    nodes = mesh.doflocs[:, mesh.dofs.element_dofs]  # (3, 27, ne)
    corners, edges = nodes[:, :8], nodes[:, 8:20]
    places = element.doflocs
    for local in range(20, 26):
        axis = int(np.flatnonzero(places[local] != 0.5)[0])
        side = places[local, axis]
        on = [np.flatnonzero(places[part, axis] == side) for part in (range(8), range(8, 20))]
        value = 0.5 * edges[:, on[1]].sum(axis=1) - 0.25 * corners[:, on[0]].sum(axis=1)
        doflocs[:, mesh.dofs.element_dofs[local]] = value
    doflocs[:, mesh.dofs.element_dofs[26]] = 0.25 * (edges.sum(axis=1) - corners.sum(axis=1))
    return replace(mesh, doflocs=doflocs)
