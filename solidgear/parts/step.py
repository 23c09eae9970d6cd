"""A part from a STEP file: surveyed, and meshed with curved tetrahedra.

All of this file runs in a process of its own (:mod:`solidgear.core.machine.isolated`): the kernel that
reads the file ends the process at some that are broken. It reads lengths in metres, whatever the
unit of the file, and turns and shifts without a change of the kind of a face; a change of scale
would make every face a spline.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos, pi, sin
from typing import Any

import numpy as np

from solidgear.core import listed, show
from solidgear.core.meshing.bisecting import bisected
from solidgear.core.meshing.curving import Filling, relaxed
from solidgear.core.meshing.element_size import set_size
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.meshing.placing import Placing
from solidgear.core.meshing.quality import MeshError
from solidgear.core.meshing.tetrahedra import to_skfem

#: sides of a turn in the triangles that a part is looked at by
SIDES = 32
#: size of a part over the least edge of these triangles: roots of teeth and threads, which are long and
#: narrow, would have ten times as many as all else
LEAST_EDGE = 500
#: width of a face over the size of the part below which it is a sliver
SLIVER = 2e-6
#: between the volume inside the triangles and that of the kernel
OPEN = 0.1
#: an edge is concave where the material around it takes more than this of a turn
CONCAVE = 0.55
#: growth of elements with the distance from a small face or a concave edge
GROWTH = 0.5
#: solids that a sentence names
MOST_NAMED = 8
#: relative difference from the kernel that triangles of second order explain: with 32 sides to a turn
#: they lack some 3e-6 of a full section
CONFIRMED_BY = 2e-5
#: order of triangles where the kernel is not confirmed, with a tenth of that error, and how many of them
#: it is made for, some seconds of nodes on splines
FINE_ORDER, MOST_FINE = 4, 4_000
#: difference from the kernel, over that of second order, that triangles of this order explain
EXPLAINED = 0.25


@dataclass(frozen=True)
class Survey:
    """Surface and volumes of a part."""

    points: np.ndarray  #: (3, n) on its surface and between its solids, m, in the axes of the scene
    triangles: np.ndarray  #: (3, t)
    sides: np.ndarray  #: (2, t) owner of the solid on each side, -1 outside
    volumes: np.ndarray  #: (n + 1,) of the named solids and of all others, m^3
    moments: np.ndarray  #: (n + 1, 3) first moments of these, m^4
    unnamed: tuple[str, ...]  #: the others
    faces: int

    @property
    def volume(self) -> float:
        """Volume of the part, m^3."""
        return float(self.volumes.sum())


def survey(path: str, place: Placing, names: tuple[str, ...] = ()) -> Survey:
    """Cover the surface of the part in a STEP file with triangles, in the unit that it names.

    `names` are numbers of solids with materials of their own; without any, one solid is wanted.
    MeshError where there is no part, several without names, solids that overlap or do not touch, an
    open one, or faces that cannot be meshed.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        solids = read_solids(gmsh, path, place, several=bool(names))
        owner, unnamed = solid_owners(gmsh, solids, names)
        pieces = fragment(gmsh, solids, [])
        drawn = sum(gmsh.model.occ.getMass(3, tag) for tags in pieces for tag in tags)
        extent = _extent(gmsh)
        faces = [tag for _, tag in gmsh.model.getEntities(2)]
        _refuse_slivers(gmsh, faces, extent, place)
        gmsh.option.setNumber("Mesh.ElementOrder", 1)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", SIDES)
        gmsh.option.setNumber("Mesh.MeshSizeMax", extent / 20)
        gmsh.option.setNumber("Mesh.MeshSizeMin", extent / LEAST_EDGE)
        try:
            gmsh.model.mesh.generate(2)
        except Exception as error:
            face = _unmeshed(gmsh, faces, place)
            raise MeshError(f"{face} cannot be covered with triangles ({error})") from error
        points, triangles, sides = _triangles(gmsh, faces, owner, pieces)
        _refuse_open(points, triangles[:, (sides < 0).any(axis=0)], drawn)
        owners = np.repeat(owner, [len(tags) for tags in pieces])
        tags = sum(pieces, [])
        centres = np.array([gmsh.model.occ.getCenterOfMass(3, tag) for tag in tags])
        of_pieces = volumes_of(gmsh, tags)
        volumes = np.bincount(owners, of_pieces, len(names) + 1)
        moments = np.zeros((len(volumes), 3))
        np.add.at(moments, owners, of_pieces[:, None] * centres)
    return Survey(points, triangles, sides, volumes, moments, unnamed, len(faces))


def _refuse_open(points: np.ndarray, triangles: np.ndarray, drawn: float) -> None:
    """Refuse faces that do not enclose the volume that the kernel gives the solids, m^3."""
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
    """Return the size of the part by the vertices and the middles of the faces, m."""
    places = [gmsh.model.getValue(0, tag, []) for _, tag in gmsh.model.getEntities(0)]
    places += [gmsh.model.occ.getCenterOfMass(2, tag) for _, tag in gmsh.model.getEntities(2)]
    return float(np.linalg.norm(np.ptp(np.array(places), axis=0)))


def _refuse_slivers(gmsh, faces: list[int], extent: float, place: Placing) -> None:
    for tag in faces:
        width = _width(gmsh, tag)
        if not width > SLIVER * extent:
            raise MeshError(
                f"{_face(gmsh, tag, place)} is a sliver, {1e3 * width:.2g} mm wide: heal the part "
                "in the CAD program"
            )


def _width(gmsh, face: int) -> float:
    """Return twice the area of a face over the length of the edges, m."""
    edges = gmsh.model.getBoundary([(2, face)], oriented=False)
    around = sum(gmsh.model.occ.getMass(1, tag) for _, tag in edges)
    return float(2 * gmsh.model.occ.getMass(2, face) / around) if around > 0 else np.inf


def _face(gmsh, tag: int, place: Placing) -> str:
    centre = np.array(gmsh.model.occ.getCenterOfMass(2, tag))[:, None]
    return f"face {tag} at {mm(place.to_file(centre)[:, 0])}"


def _unmeshed(gmsh, faces: list[int], place: Placing) -> str:
    empty = [tag for tag in faces if not len(gmsh.model.mesh.getElements(2, tag)[1])]
    return _face(gmsh, empty[0], place) if empty else "its surface"


def _triangles(gmsh, faces: list[int], owner: list[int], pieces: list[list[int]]):
    """Return triangles of the surface and of the faces between solids with different owners."""
    tags, places, _ = gmsh.model.mesh.getNodes()
    place_of = np.zeros(int(tags.max(initial=0)) + 1, int)
    place_of[tags] = np.arange(len(tags))
    owner_of = {tag: owners for owners, tags in zip(owner, pieces) for tag in tags}
    corners, sides = [], []
    for face in faces:
        around = [owner_of[int(tag)] for tag in gmsh.model.getAdjacencies(2, face)[0]]
        owners = (around + [-1])[:2]
        if owners[0] == owners[1]:
            continue
        types, _, nodes = gmsh.model.mesh.getElements(2, face)
        for kind, numbers in zip(types, nodes):
            if kind == 2:
                corners.append(numbers.reshape(-1, 3))
                sides.append(np.tile(owners, (len(corners[-1]), 1)))
    if not corners:
        return np.zeros((3, 0)), np.zeros((3, 0), int), np.zeros((2, 0), int)
    # points that belong to no face are none of the part
    used, triangles = np.unique(place_of[np.concatenate(corners)].T, return_inverse=True)
    return places.reshape(-1, 3).T[:, used], triangles.reshape(3, -1), np.concatenate(sides).T


def mesh(
    path: str, place: Placing, plan: dict[str, Any], names: tuple[str, ...] = ()
) -> tuple[Filling, np.ndarray]:
    """Fill the part of a STEP file with curved tetrahedra; return them, solids sharing the nodes of
    the faces between them, and the place (ne,) of the solid of each element among the named ones,
    one more for the others. MeshError as from :func:`survey`, or if the inside cannot be meshed.

    `plan` has ``circles`` and ``planes``, (y, radius) of cuts into the surface and across the part,
    m; ``formulas`` of the size of elements, the largest ``size`` and the ``graded`` one at concave
    edges, m; ``around``, elements to a turn. `names` is as for :func:`survey`.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        solids = read_solids(gmsh, path, place, several=bool(names))
        owner, _ = solid_owners(gmsh, solids, names)
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
                "for faces that intersect or almost touch"
            ) from error
    owner_of = {tag: number for number, tags in zip(owner, pieces) for tag in tags}
    return filling, np.array([owner_of[tag] for tag in filling.volume])


def _cut(gmsh, solids: list[int], plan) -> list[list[int]]:
    """Imprint circles on the surface, and cut across at planes; return the pieces of each solid."""
    occ = gmsh.model.occ
    tools = [
        (1, occ.addCircle(0.0, y, 0.0, r, zAxis=[0, 1, 0], xAxis=[0, 0, 1]))
        for y, r in plan["circles"]
    ]
    tools += [(2, occ.addDisk(0.0, y, 0.0, r, r, zAxis=[0, 1, 0])) for y, r in plan["planes"]]
    return fragment(gmsh, solids, tools)


def _grade(gmsh, plan) -> None:
    """Make elements smaller at concave edges and on faces narrower than they are."""
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
    # the least of all fields is the last one
    least_before = field.list()[-1]
    laws = []
    for least, edges in rules.items():
        near = field.add("Distance")
        field.setNumbers(near, "CurvesList", sorted(set(edges)))
        field.setNumber(near, "Sampling", 40)
        law = field.add("MathEval")
        field.setString(law, "F", f"({float(least)!r})+({GROWTH!r})*F{near}")
        laws.append(law)
    least_of_all = field.add("Min")
    field.setNumbers(least_of_all, "FieldsList", [int(least_before), *laws])
    field.setAsBackgroundMesh(least_of_all)


def _concave(gmsh, edge: int) -> bool:
    """Return whether the material around the middle of an edge takes clearly more than half of a
    turn.
    """
    faces, _ = gmsh.model.getAdjacencies(1, edge)
    if len(faces) != 2:  # of three it is deep inside, where there is no edge of the part
        return False
    (low,), (high,) = gmsh.model.getParametrizationBounds(1, edge)
    middle = [0.53 * low + 0.47 * high]
    point = np.array(gmsh.model.getValue(1, edge, middle))
    first, second = (_normal(gmsh, edge, middle, face) for face in faces)
    # sides of a face are not known to the kernel by normals, so that a smooth edge may be a slit
    if not np.linalg.norm(np.cross(first, second)) > sin(2 * pi * (CONCAVE - 0.5)):
        return False
    step = 1e-3 * min(gmsh.model.occ.getMass(1, edge), *(_width(gmsh, f) for f in faces))
    # between both faces' planes: of four such places a wedge holds one, its complement three
    outside = 0
    for way in (first + second, first - second, -first - second, second - first):
        place = list(point + step * way / np.linalg.norm(way))
        outside += not any(gmsh.model.isInside(3, s, place) for _, s in gmsh.model.getEntities(3))
        if outside > 1:
            return False
    return outside == 1


def _normal(gmsh, edge: int, place: list[float], face: int) -> np.ndarray:
    """Return a unit normal of a face at a place on one of its edges."""
    on_face = gmsh.model.reparametrizeOnSurface(1, edge, place, face)
    return np.array(gmsh.model.getNormal(face, on_face))


def read_solids(gmsh: Any, path: str, place: Placing, *, several: bool) -> list[int]:
    """Read the solids of a file in the order of the file, turned and shifted, in metres; MeshError
    where it cannot be read, or has no solid, or several where one is wanted.
    """
    gmsh.option.setString("Geometry.OCCTargetUnit", "M")
    occ = gmsh.model.occ
    try:
        occ.importShapes(path, highestDimOnly=False)
        occ.synchronize()
    except Exception as error:
        raise MeshError("cannot be read as STEP: it is broken or cut off") from error
    solids = [tag for _, tag in gmsh.model.getEntities(3)]
    if not solids or (len(solids) > 1 and not several):
        raise MeshError(_why_not_one(gmsh, solids))
    for tag in solids:
        # measured before anything is meshed: without a size, nothing below makes sense
        volume, label = occ.getMass(3, tag), (f" {tag}" if len(solids) > 1 else "")
        if not np.isfinite(volume) or abs(volume) < 1e-18:
            raise MeshError(f"its solid{label} has a volume of {volume:.3g} m^3")
        if volume < 0:
            raise MeshError(f"its solid{label} is turned inside out, with a volume below zero")
    entities = [(3, tag) for tag in solids]
    x, y, z = (-v for v in place.foot)
    occ.translate(entities, x, y, z)
    axis, angle = axis_angle(np.array(place.turn))
    if angle:
        occ.rotate(entities, 0.0, 0.0, 0.0, *axis, angle)
    occ.synchronize()
    return solids


def axis_angle(turn: np.ndarray) -> tuple[tuple[float, float, float], float]:
    """Return the axis and the angle (rad, 0 to pi) of a (3, 3) rotation.

    Examples
    --------
    >>> from math import pi
    >>> from solidgear.core.meshing.placing import TURNS
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


def solid_owners(
    gmsh: Any, solids: list[int], names: Sequence[str]
) -> tuple[list[int], tuple[str, ...]]:
    """Return the place of each solid among the numbers (from 1, in the order of the file) of those
    with materials of their own, one more than the last place for the rest; and the numbers of the
    rest. MeshError for a number that is not there, or twice.
    """
    numbers = [str(k) for k in range(1, len(solids) + 1)]
    for name in names:
        if name not in numbers:
            sizes = [f"{n} {_size(gmsh, tag)}" for n, tag in zip(numbers, solids)]
            raise MeshError(f"has no solid {show(name)}; there are {listed(sizes, MOST_NAMED)}")
    owner = [names.index(n) if n in names else len(names) for n in numbers]
    return owner, tuple(n for n in numbers if n not in names)


def _size(gmsh, tag: int) -> str:
    """Return a clause with volume and place of a solid."""
    occ = gmsh.model.occ
    return f"of {1e6 * occ.getMass(3, tag):.4g} cm^3 at {mm(occ.getCenterOfMass(3, tag))}"


def fragment(gmsh: Any, solids: list[int], tools: list[tuple[int, int]]) -> list[list[int]]:
    """Cut solids by circles and discs (dimension and tag) and by each other, so that they share the
    faces where they touch, and return the pieces of each; MeshError where they cannot be cut,
    overlap or do not touch.
    """
    occ = gmsh.model.occ
    if len(solids) == 1 and not tools:
        return [solids]
    further = [(3, tag) for tag in solids[1:]]
    try:
        _, parts = occ.fragment([(3, solids[0])], [*further, *tools])
    except Exception as error:
        fault = "the ends of seats cannot be cut into the surface"
        if further:
            fault = "its solids cannot be joined"
        raise MeshError(f"{fault} ({error})") from error
    occ.synchronize()
    for dimension in (2, 1):
        loose = [
            (dimension, tag)
            for _, tag in gmsh.model.getEntities(dimension)
            if not len(gmsh.model.getAdjacencies(dimension, tag)[0])
        ]
        occ.remove(loose, recursive=True)
        occ.synchronize()
    pieces = [[tag for d, tag in entities if d == 3] for entities in parts[: len(solids)]]
    _refuse_overlaps(gmsh, pieces)
    _refuse_loose(gmsh, pieces)
    return pieces


def _refuse_overlaps(gmsh, pieces: list[list[int]]) -> None:
    """Refuse solids that share a piece."""
    for j, tags in enumerate(pieces):
        for i, tags_before in enumerate(pieces[:j]):
            shared = sum(gmsh.model.occ.getMass(3, tag) for tag in set(tags) & set(tags_before))
            if shared > 0:
                raise MeshError(
                    f"its solids {i + 1} and {j + 1} overlap in {1e9 * shared:.4g} mm^3: draw them "
                    "with faces that touch, an interference fit too"
                )


def _refuse_loose(gmsh, pieces: list[list[int]]) -> None:
    """Refuse solids that hang together by no face."""
    solid_of = {tag: k for k, tags in enumerate(pieces) for tag in tags}
    group = list(range(len(pieces)))
    for _, face in gmsh.model.getEntities(2):
        around = [solid_of[int(tag)] for tag in gmsh.model.getAdjacencies(2, face)[0]]
        if len(around) == 2:
            a, b = (group[k] for k in around)
            group = [a if g == b else g for g in group]
    loose = [k + 1 for k, g in enumerate(group) if g != group[0]]
    if loose:
        tag = pieces[loose[0] - 1][0]
        raise MeshError(
            f"its solid {loose[0]} {_size(gmsh, tag)} touches no face of solid 1 or of what holds "
            "on to it: move them together in the CAD program, or leave one out"
        )


def _why_not_one(gmsh, solids: list[int]) -> str:
    """Return the reason why a file does not hold one solid."""
    if solids:
        centres = [gmsh.model.occ.getCenterOfMass(3, tag) for tag in solids[:4]]
        places = "; ".join(f"at {mm(centre)}" for centre in centres)
        return (
            f"holds {len(solids)} separate solids ({places}) where one is wanted: join them in "
            "the CAD program, or give solids that touch a material each, by number under materials"
        )
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    if not faces:
        return "holds no solid, and no faces either"
    loose = [
        int(gmsh.model.getAdjacencies(1, edge)[0][0])
        for _, edge in gmsh.model.getEntities(1)
        if len(gmsh.model.getAdjacencies(1, edge)[0]) == 1
    ]
    face = loose[0] if loose else faces[0]
    return (
        f"holds {len(faces)} faces that enclose no solid; the shell is open at face {face} at "
        f"{mm(gmsh.model.occ.getCenterOfMass(2, face))}"
    )


def mm(point) -> str:
    return "({:.4g}, {:.4g}, {:.4g}) mm".format(*(round(1e3 * float(v), 6) + 0.0 for v in point))


def volumes_of(gmsh: Any, solids: Sequence[int]) -> np.ndarray:
    """Return the volumes of solids whose faces carry triangles, m^3; the order of these changes.

    The kernel integrates over each face with few points, which is exact on planes, cylinders and
    cones and 0.9 % off on splines. So it is compared with curved triangles on the same faces, and
    where they differ, triangles of a higher order decide.
    """
    drawn = np.array([gmsh.model.occ.getMass(3, tag) for tag in solids])
    triangles = sum(len(tags) for tags in gmsh.model.mesh.getElements(2)[1])
    second = _volumes_inside(gmsh, solids, 2)
    if (np.abs(drawn - second) <= CONFIRMED_BY * np.abs(second)).all():
        return drawn
    if triangles > MOST_FINE:
        return second
    finest = _volumes_inside(gmsh, solids, FINE_ORDER)
    confirmed = np.abs(drawn - finest) <= EXPLAINED * np.abs(second - finest)
    return np.where(confirmed, drawn, finest)


def _volumes_inside(gmsh, solids: Sequence[int], order: int) -> np.ndarray:
    """Return the volumes inside triangles of an order, m^3, by the divergence theorem."""
    gmsh.model.mesh.setOrder(order)
    volumes = []
    for tag in solids:
        gmsh.model.mesh.setOutwardOrientation(tag)
        faces = gmsh.model.getBoundary([(3, tag)], oriented=False)
        volumes.append(sum(_flux(gmsh, face) for _, face in faces) / 3)
    return np.array(volumes)


def _flux(gmsh, face: int) -> float:
    """Return the integral of the place times the normal over the triangles of a face, m^3."""
    total = 0.0
    for kind in gmsh.model.mesh.getElementTypes(2, face):
        order = gmsh.model.mesh.getElementProperties(kind)[2]
        points, weights = gmsh.model.mesh.getIntegrationPoints(kind, f"Gauss{3 * order}")
        tangents, _, places = gmsh.model.mesh.getJacobians(kind, points, face)
        tangents = tangents.reshape(-1, len(weights), 3, 3)
        normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
        place = places.reshape(-1, len(weights), 3)
        total += float(np.einsum("eqi,eqi,q->", normal, place, weights))
    return total
