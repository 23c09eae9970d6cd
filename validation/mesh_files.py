"""Writes meshes with groups as files of every format that is read: for tests and for broken files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.meshing.gmsh_session import Session, import_gmsh

#: by kind of cell in meshio's words: type in Abaqus, card in Nastran, descriptor in a universal
#: file, number in gmsh
NAMES: dict[str, tuple[str, str, int, int]] = {
    "tetra": ("C3D4", "CTETRA", 111, 4),
    "tetra10": ("C3D10", "CTETRA", 118, 11),
    "hexahedron": ("C3D8", "CHEXA", 115, 5),
}
#: nodes of second-order tetrahedra: around each edge in a universal file; the last two exchanged in
#: gmsh
UNIVERSAL = (0, 4, 1, 5, 2, 6, 7, 8, 9, 3)
GMSH = (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)

Groups = Mapping[str, Sequence[int]]


def write_mesh(path: Path, points: Any, kind: str, cells: Any, groups: Groups) -> None:
    """Write a mesh in the format that its file ends in.

    Parameters
    ----------
    path : path
        That ends in .inp, .bdf, .unv, .msh or .vtu.
    points : (n, 3) array
        In the unit of the file.
    kind : {'tetra', 'tetra10', 'hexahedron'}
    cells : (ne, nodes) array of int
        In VTK's order.
    groups : dict of str to list of int
        Elements by name. Formats that know numbers only take 1, 2 and so on in their order.
    """
    writer = {".inp": _abaqus, ".bdf": _nastran, ".unv": _universal, ".msh": _gmsh, ".vtu": _vtk}
    text = writer[path.suffix](np.asarray(points, float), kind, np.asarray(cells), groups)
    path.write_text(text)


def numbers(count: int, groups: Groups) -> np.ndarray:
    """Number of the group of each element, 0 for none."""
    out = np.zeros(count, int)
    for k, members in enumerate(groups.values(), 1):
        out[np.asarray(members, int)] = k
    return out


def _abaqus(points, kind, cells, groups) -> str:
    out = ["*HEADING", "a part", "*NODE"]
    out += [f"{k}, " + ", ".join(f"{v:.9g}" for v in p) for k, p in enumerate(points, 1)]
    out.append(f"*ELEMENT, TYPE={NAMES[kind][0]}, ELSET=EALL")
    out += [f"{k}, " + ", ".join(str(n + 1) for n in row) for k, row in enumerate(cells, 1)]
    for name, members in groups.items():
        out.append(f"*ELSET, ELSET={name}")
        rows = [members[i : i + 12] for i in range(0, len(members), 12)]
        out += [", ".join(str(m + 1) for m in row) for row in rows]
    for name in groups:
        out += [f"*MATERIAL, NAME=of_{name}", "*ELASTIC", "210000., 0.3"]
        out.append(f"*SOLID SECTION, ELSET={name}, MATERIAL=of_{name}")
    return "\n".join(out) + "\n"


def _nastran(points, kind, cells, groups) -> str:
    out = ["$ a part", "BEGIN BULK"]
    for k, (x, y, z) in enumerate(points, 1):
        out.append(f"GRID*   {k:<16d}{'':16s}{x:16.9g}{y:16.9g}")
        out.append(f"*       {z:16.9g}")
    of = numbers(len(cells), groups)
    for k, row in enumerate(cells, 1):
        fields = [f"{n + 1:<8d}" for n in row]
        lines = [fields[:6], *(fields[i : i + 8] for i in range(6, len(fields), 8))]
        out.append(f"{NAMES[kind][1]:<8s}{k:<8d}{of[k - 1]:<8d}" + "".join(lines[0]))
        out += [" " * 8 + "".join(line) for line in lines[1:]]
    return "\n".join([*out, "ENDDATA", ""])


def _universal(points, kind, cells, groups) -> str:
    out = ["    -1", "  2411"]
    for k, p in enumerate(points, 1):
        out += [f"{k:10d}{1:10d}{1:10d}{11:10d}", "".join(f"{v:25.16E}" for v in p)]
    out += ["    -1", "    -1", "  2412"]
    of = numbers(len(cells), groups)
    for k, row in enumerate(cells, 1):
        nodes = row[list(UNIVERSAL)] if kind == "tetra10" else row
        head = (k, NAMES[kind][2], 1, int(of[k - 1]), 7, len(nodes))
        out.append("".join(f"{v:10d}" for v in head))
        out += ["".join(f"{n + 1:10d}" for n in nodes[i : i + 8]) for i in range(0, len(nodes), 8)]
    return "\n".join([*out, "    -1", ""])


def _gmsh(points, kind, cells, groups) -> str:
    out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    out += [f'3 {k} "{name}"' for k, name in enumerate(groups, 1)]
    out += ["$EndPhysicalNames", "$Nodes", str(len(points))]
    out += [f"{k} " + " ".join(f"{v:.9g}" for v in p) for k, p in enumerate(points, 1)]
    out += ["$EndNodes", "$Elements", str(len(cells))]
    of = numbers(len(cells), groups)
    for k, row in enumerate(cells, 1):
        nodes = row[list(GMSH)] if kind == "tetra10" else row
        tags = f"{NAMES[kind][3]} 2 {of[k - 1]} {of[k - 1] + 1}"
        out.append(f"{k} {tags} " + " ".join(str(n + 1) for n in nodes))
    return "\n".join([*out, "$EndElements", ""])


def _vtk(points, kind, cells, groups) -> str:
    import tempfile

    import meshio

    data = {"material": [numbers(len(cells), groups)]}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.vtu"
        mesh = meshio.Mesh(np.round(points, 9) + 0.0, [(kind, cells)], cell_data=data)
        meshio.write(path, mesh, binary=False)
        return path.read_text()


def write_boxes(
    path: Path,
    lines: Sequence[np.ndarray],
    patches: Mapping[str, Callable[[np.ndarray], np.ndarray]],
    hollow: Callable[[np.ndarray], np.ndarray] | None = None,
    bricks: bool = False,
    parts: Mapping[str, Callable[[np.ndarray], np.ndarray]] | None = None,
) -> None:
    """Write boxes between lines as a gmsh file, mm, with patches of the surface.

    Parameters
    ----------
    lines : sequence of ndarray
        Along x, y and z, m.
    patches : dict of str to callable
        Which of the middles (3, n) of faces of the surface are of a patch.
    hollow : callable, optional
        Which of the middles of cells are none.
    bricks : bool
        In place of tetrahedra, into which boxes are cut.
    parts : dict of str to callable, optional
        Which of the middles of cells are of a group, in place of one group of all.
    """
    import meshio
    from skfem import MeshHex, MeshTet

    mesh = (MeshHex if bricks else MeshTet).init_tensor(*lines)
    if hollow is not None:
        mesh = mesh.remove_elements(np.flatnonzero(hollow(mesh.p[:, mesh.t].mean(axis=1))))
    if bricks:
        cells = _in_order(mesh)
    else:
        turned = np.linalg.det(np.diff(mesh.p[:, mesh.t], axis=1).transpose(2, 0, 1)) < 0
        mesh.t[:2, turned] = mesh.t[1::-1, turned]
        cells = mesh.t.T
    outside = mesh.boundary_facets()
    middle = mesh.p[:, mesh.facets[:, outside]].mean(axis=1)
    blocks, tags, names = [], [], {}
    inside = mesh.p[:, mesh.t].mean(axis=1)
    for tag, (name, of) in enumerate((parts or {"body": lambda m: m[0] < np.inf}).items(), 1):
        members = cells[of(inside)]
        blocks.append(("hexahedron" if bricks else "tetra", members))
        tags.append(np.full(len(members), tag))
        names[name] = np.array([tag, 3])
    for tag, (name, on) in enumerate(patches.items(), len(names) + 1):
        faces = mesh.facets[:, outside[on(middle)]].T
        blocks.append(("quad" if bricks else "triangle", faces))
        tags.append(np.full(len(faces), tag))
        names[name] = np.array([tag, 2])
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    out = meshio.Mesh(1e3 * mesh.p.T, blocks, cell_data=data, field_data=names)
    meshio.write(path, out, file_format="gmsh22")


def _in_order(mesh: Any) -> np.ndarray:
    """Corners (ne, 8) of boxes in VTK's order, from the place of each in its box."""
    corners = mesh.p[:, mesh.t]
    above = corners > corners.mean(axis=1, keepdims=True)
    places = (above * np.array([1, 2, 4])[:, None, None]).sum(axis=0)
    order = np.argsort(places, axis=0)[[0, 1, 3, 2, 4, 5, 7, 6]]
    return np.take_along_axis(mesh.t, order, axis=0).T


def rod(
    rings: Sequence[float], planes: Sequence[float], around: int = 12
) -> tuple[np.ndarray, np.ndarray]:
    """Tetrahedra in a prism along y, whose sides are flat: points (n, 3) and cells (ne, 4).

    Parameters
    ----------
    rings : sequence of float
        Radii of circles of nodes; the first one is the bore, or 0.
    planes : sequence of float
        Places of nodes along y.
    around : int
        Sides.
    """
    turn = 2 * np.pi * np.arange(around) / around
    circle = np.column_stack([np.sin(turn), np.cos(turn)])
    full = rings[0] == 0.0
    section = [[0.0, 0.0]] if full else []
    section += [list(r * c) for r in rings[full:] for c in circle]
    here, there = np.arange(around), (np.arange(around) + 1) % around
    triangles = [np.column_stack([0 * here, 1 + here, 1 + there])] if full else []
    for k in range(len(rings) - 1 - full):
        a, b = full + k * around, full + (k + 1) * around
        triangles += [
            np.column_stack([a + here, b + here, b + there]),
            np.column_stack([a + here, b + there, a + there]),
        ]
    # sorted corners make neighbours cut their common side alike
    lower = np.sort(np.concatenate(triangles), axis=1)
    count = len(section)
    points = np.array([[x, y, z] for y in planes for x, z in section])
    cells = []
    for level in range(len(planes) - 1):
        a, b, c = (lower + level * count).T
        up = count
        for four in ((a, b, c, c + up), (a, b, b + up, c + up), (a, a + up, b + up, c + up)):
            cells.append(np.column_stack(four))
    every = np.concatenate(cells)
    p = points[every]
    volume = np.linalg.det(p[:, 1:] - p[:, :1])
    every[volume < 0] = every[volume < 0][:, [0, 2, 1, 3]]
    return points, every


def written_by_gmsh(stem: str, hexes: bool) -> None:
    """A quarter of a tube on another, with groups "core" and "sleeve", as gmsh itself writes them.

    Parameters
    ----------
    stem : str
        Of files that end in .msh, .inp, .bdf and .unv, mm.
    hexes : bool
        Bricks in place of tetrahedra; both of second order.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        for radius, wide, tag in ((6.0, 6.0, 5), (12.0, 8.0, 7)):
            line = gmsh.model.occ.addLine(
                gmsh.model.occ.addPoint(radius, 0, 0), gmsh.model.occ.addPoint(radius + wide, 0, 0)
            )
            layers = {"numElements": [4], "recombine": hexes}
            face = gmsh.model.occ.extrude([(1, line)], 0, 30, 0, **layers)[1]
            turned = gmsh.model.occ.revolve(
                [face], 0, 0, 0, 0, 1, 0, -np.pi / 2, numElements=[6], recombine=hexes
            )
            (tube,) = (t for d, t in turned if d == 3)
            gmsh.model.occ.synchronize()
            gmsh.model.addPhysicalGroup(3, [tube], tag, "sleeve" if tag == 7 else "core")
        for _, curve in gmsh.model.getEntities(1):
            gmsh.model.mesh.setTransfiniteCurve(curve, 5)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.option.setNumber("Mesh.SaveGroupsOfElements", 1)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        gmsh.model.mesh.removeDuplicateNodes()
        for ending in (".msh", ".inp", ".bdf", ".unv"):
            gmsh.write(stem + ending)
