"""A part from a STEP file: looked at, and meshed with curved tetrahedra.

What is in here runs in a process of its own (:mod:`solidgear.machine.isolated`): the kernel that reads
the file ends the process at some that are broken. It reads lengths in metres, whatever the unit of
the file, and turns and shifts without a change of the kind of a face; a change of scale would make
every face a spline.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any

import numpy as np

from solidgear.meshing.bisecting import bisected
from solidgear.meshing.curving import Filling, relaxed
from solidgear.meshing.element_size import set_size
from solidgear.meshing.enclosed import volumes_of
from solidgear.meshing.gmsh_session import Session, import_gmsh
from solidgear.meshing.placing import Placing
from solidgear.meshing.quality import MeshError
from solidgear.meshing.solids import fragmented, mm, read_solids, solid_owners
from solidgear.meshing.tetrahedra import to_skfem

#: sides of a turn in the triangles that a part is looked at by
SIDES = 32
#: width of a face over the size of the part below which it is a sliver
SLIVER = 2e-6
#: between the volume inside the triangles and that of the kernel
OPEN = 0.1
#: an edge is concave where the material around it takes more than this of a turn
CONCAVE = 0.55
#: growth of elements with the distance from a small face or a concave edge
GROWTH = 0.5


@dataclass(frozen=True)
class Seen:
    """Look of a part."""

    points: np.ndarray  #: (3, n) on its surface and between its solids, m, in the axes of the scene
    triangles: np.ndarray  #: (3, t)
    sides: np.ndarray  #: (2, t) owner of the solid on each side, -1 outside
    volumes: np.ndarray  #: (n + 1,) of the solids that were named and of the rest, m^3
    rest: tuple[str, ...]  #: solids of the rest
    faces: int

    @property
    def volume(self) -> float:
        """Of the part, m^3."""
        return float(self.volumes.sum())


def look(path: str, place: Placing, named: tuple[str, ...] = ()) -> Seen:
    """Triangles on the surface of the part in a STEP file, in the unit that it names.

    `named` are numbers of solids with materials of their own; without any, one solid is wanted.
    MeshError where there is no part, several without names, solids that overlap or do not touch, an
    open one, or faces that cannot be meshed.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        solids = read_solids(gmsh, path, place, several=bool(named))
        owner, rest = solid_owners(gmsh, solids, named)
        pieces = fragmented(gmsh, solids, [])
        drawn = sum(gmsh.model.occ.getMass(3, tag) for tags in pieces for tag in tags)
        extent = _extent(gmsh)
        faces = [tag for _, tag in gmsh.model.getEntities(2)]
        _no_slivers(gmsh, faces, extent, place)
        gmsh.option.setNumber("Mesh.ElementOrder", 1)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", SIDES)
        gmsh.option.setNumber("Mesh.MeshSizeMax", extent / 20)
        gmsh.option.setNumber("Mesh.MeshSizeMin", extent / 2000)
        try:
            gmsh.model.mesh.generate(2)
        except Exception as error:
            bad = _unmeshed(gmsh, faces, place)
            raise MeshError(f"{bad} cannot be covered with triangles ({error})") from error
        points, triangles, sides = _triangles(gmsh, faces, owner, pieces)
        _closed(points, triangles[:, (sides < 0).any(axis=0)], drawn)
        owners = np.repeat(owner, [len(tags) for tags in pieces])
        volumes = np.bincount(owners, volumes_of(gmsh, sum(pieces, [])), len(named) + 1)
    return Seen(points, triangles, sides, volumes, rest, len(faces))


def _closed(points: np.ndarray, triangles: np.ndarray, drawn: float) -> None:
    """Refuse faces that do not enclose what the kernel says that they do, m^3."""
    if not len(points[0]) or not np.isfinite(points).all():
        raise MeshError("its faces have no area")
    a, b, c = (points[:, corner] for corner in triangles)
    inside = abs(np.einsum("it,it->", a, np.cross(b.T, c.T).T)) / 6
    if not abs(inside - drawn) <= OPEN * drawn:
        raise MeshError(
            f"its faces enclose {1e6 * inside:.4g} cm^3 where the solid is said to have "
            f"{1e6 * drawn:.4g} cm^3: faces are missing, turned inside out or intersect"
        )


def _extent(gmsh) -> float:
    """Size of the part by its vertices and the middles of its faces, m."""
    places = [gmsh.model.getValue(0, tag, []) for _, tag in gmsh.model.getEntities(0)]
    places += [gmsh.model.occ.getCenterOfMass(2, tag) for _, tag in gmsh.model.getEntities(2)]
    return float(np.linalg.norm(np.ptp(np.array(places), axis=0)))


def _no_slivers(gmsh, faces: list[int], extent: float, place: Placing) -> None:
    for tag in faces:
        width = _width(gmsh, tag)
        if not width > SLIVER * extent:
            raise MeshError(
                f"{_face(gmsh, tag, place)} is a sliver, {1e3 * width:.2g} mm wide: heal the part "
                "in the CAD program"
            )


def _width(gmsh, face: int) -> float:
    """Twice the area of a face over the length of its edges, m."""
    edges = gmsh.model.getBoundary([(2, face)], oriented=False)
    around = sum(gmsh.model.occ.getMass(1, tag) for _, tag in edges)
    return float(2 * gmsh.model.occ.getMass(2, face) / around) if around > 0 else np.inf


def _face(gmsh, tag: int, place: Placing) -> str:
    at = np.array(gmsh.model.occ.getCenterOfMass(2, tag))[:, None]
    return f"face {tag} at {mm(place.back(at)[:, 0])}"


def _unmeshed(gmsh, faces: list[int], place: Placing) -> str:
    empty = [tag for tag in faces if not len(gmsh.model.mesh.getElements(2, tag)[1])]
    return _face(gmsh, empty[0], place) if empty else "its surface"


def _triangles(gmsh, faces: list[int], owner: list[int], pieces: list[list[int]]):
    """Triangles of the surface and of what lies between solids with different owners."""
    tags, places, _ = gmsh.model.mesh.getNodes()
    at = np.zeros(int(tags.max(initial=0)) + 1, int)
    at[tags] = np.arange(len(tags))
    of = {tag: own for own, tags in zip(owner, pieces) for tag in tags}
    corners, sides = [], []
    for face in faces:
        around = [of[int(tag)] for tag in gmsh.model.getAdjacencies(2, face)[0]]
        own = (around + [-1])[:2]
        if own[0] == own[1]:
            continue
        types, _, nodes = gmsh.model.mesh.getElements(2, face)
        for kind, numbers in zip(types, nodes):
            if kind == 2:
                corners.append(numbers.reshape(-1, 3))
                sides.append(np.tile(own, (len(corners[-1]), 1)))
    if not corners:
        return np.zeros((3, 0)), np.zeros((3, 0), int), np.zeros((2, 0), int)
    # points that belong to no face are none of the part
    used, triangles = np.unique(at[np.concatenate(corners)].T, return_inverse=True)
    return places.reshape(-1, 3).T[:, used], triangles.reshape(3, -1), np.concatenate(sides).T


def mesh(
    path: str, place: Placing, plan: dict[str, Any], named: tuple[str, ...] = ()
) -> tuple[Filling, np.ndarray]:
    """Curved tetrahedra in the part of a STEP file.

    Parameters
    ----------
    plan : dict
        ``circles`` and ``planes``, (y, radius) of cuts into the surface and across the part, m;
        ``formulas`` of the size of elements, the largest ``size`` and the ``graded`` one at concave
        edges, m; ``around``, elements to a turn.
    named : tuple of str
        As for :func:`look`.

    Returns
    -------
    filling : Filling
        Solids share the nodes of the faces between them.
    owner : (ne,) ndarray of int
        Place of the solid of each element among those that were named, one more for the rest.

    Raises
    ------
    MeshError
        As :func:`look`, or if the inside cannot be meshed.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        solids = read_solids(gmsh, path, place, several=bool(named))
        owner, _ = solid_owners(gmsh, solids, named)
        pieces = _cut(gmsh, solids, plan)
        formulas = plan["formulas"]
        set_size(gmsh, formulas, plan["size"])
        _grade(gmsh, plan)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", plan["around"])
        gmsh.option.setNumber("Mesh.MeshSizeMin", plan["graded"] / 4)
        try:
            for dimension in (1, 2, 3):
                gmsh.model.mesh.generate(dimension)
            filling = relaxed(bisected(to_skfem(gmsh)))
        except MeshError:
            raise
        except Exception as error:
            raise MeshError(
                f"cannot be filled with tetrahedra ({error}): change refinement a little, or look "
                "for faces that intersect or all but touch"
            ) from error
    of = {tag: own for own, tags in zip(owner, pieces) for tag in tags}
    return filling, np.array([of[tag] for tag in filling.volume])


def _cut(gmsh, solids: list[int], plan) -> list[list[int]]:
    """Imprint circles on the surface, and cut across at planes; the pieces of each solid."""
    occ = gmsh.model.occ
    tools = [
        (1, occ.addCircle(0.0, y, 0.0, r, zAxis=[0, 1, 0], xAxis=[0, 0, 1]))
        for y, r in plan["circles"]
    ]
    tools += [(2, occ.addDisk(0.0, y, 0.0, r, r, zAxis=[0, 1, 0])) for y, r in plan["planes"]]
    return fragmented(gmsh, solids, tools)


def _grade(gmsh, plan) -> None:
    """Smaller elements at concave edges and on faces narrower than they are."""
    field = gmsh.model.mesh.field
    rules: dict[float, list[int]] = {}
    for _, edge in gmsh.model.getEntities(1):
        if plan["graded"] < plan["size"] and _concave(gmsh, edge):
            rules.setdefault(plan["graded"], []).append(edge)
    for _, face in gmsh.model.getEntities(2):
        width = _width(gmsh, face)
        if width < plan["size"]:
            least = max(width, plan["graded"] / 2)
            edges = [tag for _, tag in gmsh.model.getBoundary([(2, face)], oriented=False)]
            rules.setdefault(round(least, 5), []).extend(edges)
    # the least of all fields is the last one that was made
    before = field.list()[-1]
    made = []
    for least, edges in rules.items():
        near = field.add("Distance")
        field.setNumbers(near, "CurvesList", sorted(set(edges)))
        field.setNumber(near, "Sampling", 40)
        law = field.add("MathEval")
        field.setString(law, "F", f"({float(least)!r})+({GROWTH!r})*F{near}")
        made.append(law)
    least_of_all = field.add("Min")
    field.setNumbers(least_of_all, "FieldsList", [int(before), *made])
    field.setAsBackgroundMesh(least_of_all)


def _concave(gmsh, edge: int) -> bool:
    """True where the material around the middle of an edge takes clearly more than half of a turn."""
    faces, _ = gmsh.model.getAdjacencies(1, edge)
    if len(faces) < 2:
        return False
    (low,), (high,) = gmsh.model.getParametrizationBounds(1, edge)
    middle = [0.53 * low + 0.47 * high]
    at = np.array(gmsh.model.getValue(1, edge, middle))
    along = np.array(gmsh.model.getDerivative(1, edge, middle))
    length = np.linalg.norm(along)
    if not length > 0:
        return False
    along /= length
    first = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    first /= np.linalg.norm(first)
    second = np.cross(along, first)
    step = 1e-3 * min(gmsh.model.occ.getMass(1, edge), *(_width(gmsh, f) for f in faces))
    turns = 2 * pi * (np.arange(24) + 0.31) / 24
    ring = [at + step * (cos(t) * first + sin(t) * second) for t in turns]
    inside = 0
    for _, solid in gmsh.model.getEntities(3):
        inside += sum(gmsh.model.isInside(3, solid, list(p)) for p in ring)
    # deep inside there is no edge of the part
    return CONCAVE * len(ring) < inside < len(ring)
