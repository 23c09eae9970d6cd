"""A part from a STEP file: looked at, and meshed with curved tetrahedra.

What is in here runs in a process of its own (:mod:`solidgear.machine.apart`): the kernel that reads
the file ends the process at some that are broken. It reads lengths in metres, whatever the unit of
the file, and turns and shifts without a change of the kind of a face; a change of scale would make
every face a spline.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, cos, pi, sin
from typing import Any

import numpy as np

from solidgear.meshing.element_size import set_size
from solidgear.meshing.gmsh_session import Session, import_gmsh
from solidgear.meshing.placing import Placing
from solidgear.meshing.quality import MeshError
from solidgear.meshing.tetrahedra import relaxed, to_skfem

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
    """What a part looks like.

    Attributes
    ----------
    points : (3, n) ndarray
        On its surface, m, in the axes of the scene.
    triangles : (3, t) ndarray of int
        Closed.
    volume : float
        m^3.
    faces : int
    """

    points: np.ndarray
    triangles: np.ndarray
    volume: float
    faces: int


def look(path: str, place: Placing) -> Seen:
    """Triangles on the surface of the part in a STEP file.

    Parameters
    ----------
    path : str
    place : Placing
        Its unit is not used: STEP files name their own.

    Returns
    -------
    Seen

    Raises
    ------
    MeshError
        No part, several, an open one, or faces that cannot be meshed.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        solid = _read(gmsh, path, place)
        volume = float(gmsh.model.occ.getMass(3, solid))
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
        points, triangles = _triangles(gmsh)
    if not len(points[0]) or not np.isfinite(points).all():
        raise MeshError("its faces have no area")
    a, b, c = (points[:, corner] for corner in triangles)
    inside = abs(np.einsum("it,it->", a, np.cross(b.T, c.T).T)) / 6
    if not abs(inside - volume) <= OPEN * volume:
        raise MeshError(
            f"its faces enclose {1e6 * inside:.4g} cm^3 where the solid is told to have "
            f"{1e6 * volume:.4g} cm^3: faces are missing, turned inside out or intersect"
        )
    return Seen(points, triangles, volume, len(faces))


def _read(gmsh, path: str, place: Placing) -> int:
    """The one solid of a file, turned and shifted; lengths are metres."""
    gmsh.option.setString("Geometry.OCCTargetUnit", "M")
    occ = gmsh.model.occ
    try:
        occ.importShapes(path, highestDimOnly=False)
        occ.synchronize()
    except Exception as error:
        raise MeshError("cannot be read as STEP: it is broken or cut off") from error
    solids = [tag for _, tag in gmsh.model.getEntities(3)]
    if len(solids) != 1:
        raise MeshError(_no_solid(gmsh, solids))
    # measured before anything is meshed: without a size, nothing below makes sense
    volume = occ.getMass(3, solids[0])
    if not np.isfinite(volume) or abs(volume) < 1e-18:
        raise MeshError(f"its solid has a volume of {volume:.3g} m^3")
    if volume < 0:
        raise MeshError("its solid is turned inside out, with a volume below zero")
    x, y, z = (-v for v in place.foot)
    occ.translate([(3, solids[0])], x, y, z)
    axis, angle = axis_angle(np.array(place.turn))
    if angle:
        occ.rotate([(3, solids[0])], 0.0, 0.0, 0.0, *axis, angle)
    occ.synchronize()
    return solids[0]


def axis_angle(turn: np.ndarray) -> tuple[tuple[float, float, float], float]:
    """Axis and angle of a rotation.

    Parameters
    ----------
    turn : (3, 3) ndarray

    Returns
    -------
    axis : tuple of float
    angle : float
        rad, 0 to pi.

    Examples
    --------
    >>> from solidgear.meshing.placing import TURNS
    >>> axis_angle(np.array(TURNS["x"]))[1] == pi / 2
    True
    """
    angle = acos(float(np.clip((np.trace(turn) - 1) / 2, -1.0, 1.0)))
    w, v = np.linalg.eigh((turn + turn.T) / 2)
    axis = v[:, int(np.argmax(w))]
    skew = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    if skew @ axis < 0:
        axis = -axis
    x, y, z = (float(v) for v in axis)
    return (x, y, z), angle


def _no_solid(gmsh, solids: list[int]) -> str:
    """Why a file does not hold one solid."""
    if solids:
        each = [gmsh.model.occ.getCenterOfMass(3, tag) for tag in solids[:4]]
        places = "; ".join(f"at {_mm(at)}" for at in each)
        return (
            f"holds {len(solids)} separate solids ({places}) where one is wanted: join them in the "
            "CAD program"
        )
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    if not faces:
        return "holds no solid, and no faces either"
    loose = [
        int(gmsh.model.getAdjacencies(1, edge)[0][0])
        for _, edge in gmsh.model.getEntities(1)
        if len(gmsh.model.getAdjacencies(1, edge)[0]) == 1
    ]
    at = loose[0] if loose else faces[0]
    return (
        f"holds {len(faces)} faces that enclose no solid; the shell is open at face {at} at "
        f"{_mm(gmsh.model.occ.getCenterOfMass(2, at))}"
    )


def _mm(at) -> str:
    return "({:.4g}, {:.4g}, {:.4g}) mm".format(*(round(1e3 * float(v), 6) + 0.0 for v in at))


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
    return f"face {tag} at {_mm(place.back(at)[:, 0])}"


def _unmeshed(gmsh, faces: list[int], place: Placing) -> str:
    empty = [tag for tag in faces if not len(gmsh.model.mesh.getElements(2, tag)[1])]
    return _face(gmsh, empty[0], place) if empty else "its surface"


def _triangles(gmsh) -> tuple[np.ndarray, np.ndarray]:
    tags, places, _ = gmsh.model.mesh.getNodes()
    at = np.zeros(int(tags.max(initial=0)) + 1, int)
    at[tags] = np.arange(len(tags))
    types, _, nodes = gmsh.model.mesh.getElements(2)
    corners = [n.reshape(-1, 3) for kind, n in zip(types, nodes) if kind == 2]
    if not corners:
        return np.zeros((3, 0)), np.zeros((3, 0), int)
    # points that belong to no face are none of the part
    used, triangles = np.unique(at[np.concatenate(corners)].T, return_inverse=True)
    return places.reshape(-1, 3).T[:, used], triangles.reshape(3, -1)


def mesh(path: str, place: Placing, plan: dict[str, Any]):
    """Curved tetrahedra in the part of a STEP file.

    Parameters
    ----------
    path : str
    place : Placing
    plan : dict
        ``circles`` and ``planes``, (y, radius) of cuts into the surface and across the part, m;
        ``formulas`` of the size of elements, the largest ``size`` and the ``graded`` one at concave
        edges, m; ``around``, elements to a turn.

    Returns
    -------
    skfem.MeshTet2

    Raises
    ------
    MeshError
        As :func:`look`, or if the inside cannot be meshed.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        solid = _read(gmsh, path, place)
        _cut(gmsh, solid, plan)
        formulas = plan["formulas"]
        set_size(gmsh, formulas, plan["size"])
        _grade(gmsh, plan)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", plan["around"])
        gmsh.option.setNumber("Mesh.MeshSizeMin", plan["graded"] / 4)
        try:
            for dimension in (1, 2, 3):
                gmsh.model.mesh.generate(dimension)
            return relaxed(to_skfem(gmsh))
        except MeshError:
            raise
        except Exception as error:
            raise MeshError(
                f"cannot be filled with tetrahedra ({error}): change refinement a little, or look "
                "for faces that intersect or all but touch"
            ) from error


def _cut(gmsh, solid: int, plan) -> None:
    """Imprint circles on the surface, and cut across at planes."""
    occ = gmsh.model.occ
    tools = [
        (1, occ.addCircle(0.0, y, 0.0, r, zAxis=[0, 1, 0], xAxis=[0, 0, 1]))
        for y, r in plan["circles"]
    ]
    tools += [(2, occ.addDisk(0.0, y, 0.0, r, r, zAxis=[0, 1, 0])) for y, r in plan["planes"]]
    if not tools:
        return
    try:
        occ.fragment([(3, solid)], tools)
    except Exception as error:
        raise MeshError(f"the ends of seats cannot be cut into the surface ({error})") from error
    occ.synchronize()
    for dimension in (2, 1):
        loose = [
            (dimension, tag)
            for _, tag in gmsh.model.getEntities(dimension)
            if not len(gmsh.model.getAdjacencies(dimension, tag)[0])
        ]
        occ.remove(loose, recursive=True)
        occ.synchronize()


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
    """Whether the material around the middle of an edge takes clearly more than half of a turn."""
    faces, _ = gmsh.model.getAdjacencies(1, edge)
    if len(faces) != 2:
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
    return inside > CONCAVE * len(ring)
