"""Curved second-order tetrahedra in a shaft of revolution, by gmsh.

Second-order tetrahedra on straight edges lose 0.3 to 0.7 % of the volume. With mid-edge nodes on
the true surface the loss is a^4/30, where an edge spans the angle 2a: 5e-5 with 16 elements around.
So they are moved beyond it (:mod:`solidgear.core.meshing.curving`), and some 2e-6 is left.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np
from skfem import MeshTet2

from solidgear.core.machine.interruptible import call
from solidgear.core.meshing.bisecting import bisected
from solidgear.core.meshing.curving import Filling, relaxed, ten_nodes, volume_preserved
from solidgear.core.meshing.edge_places import edge_places
from solidgear.core.meshing.element_size import set_size, size_formulas
from solidgear.core.meshing.geometry import (
    geometry_error,
    misshapen,
    moments_of,
    most_misshapen,
    refuse_misshapen,
)
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.meshing.quality import MeshError, MeshQuality, check_mesh
from solidgear.core.meshing.revolved import draw_revolved, graded_corners, tolerance_of
from solidgear.core.scene.closed_form import moments_of_parts, volume_of
from solidgear.core.scene.outline import Outline, Shape

_TET10 = 11  # gmsh's number for the ten-node tetrahedron
#: how many times smaller elements are at shoulders and seat ends where a segment is misshapen: edges
#: between the two circles of a small step fold where they are long, and have to be straightened
FINER = (1.0, 1.5, 2.0, 3.0)


@dataclass(frozen=True)
class TetMesh:
    """A meshed shaft."""

    mesh: MeshTet2  #: with mid-edge nodes so near to the true surface that its volume is kept
    segment: np.ndarray  #: index of the segment each element lies in
    quality: MeshQuality


def tetrahedra(
    outline: Outline,
    planes=(),
    circles=(),
    *,
    size,
    graded_size=None,
    reach=None,
    around=16,
    convex=True,
    progress=None,
):
    """Mesh a shaft of revolution about y with curved ten-node tetrahedra; the same arrays for the
    same input. MeshError for geometry that cannot be meshed, gmsh missing or failing, inverted
    elements, or wrong volumes and second moments of segments.

    `planes` are positions y of cross-sections to be made of element faces, `circles` those at which
    the outer surface is split along a circle (ends of seats), m. `size` is the target length of an
    element edge in the bulk, m, which gmsh keeps below about a tenth of the shaft's diagonal;
    `graded_size` that at `circles` and at every kink of the outline (shoulders, cone ends,
    corners), of which `convex` ones may be left out, the same everywhere when None; `reach` the
    distance over which the edge grows from the one to the other, m, the local radius when None.
    `around` is the least number of elements around a circle. Where a segment lacks volume or second
    moments, as edges that would fold are straight, elements are made smaller at `graded_size`;
    `progress` is called as progress(fraction, message) between the stages.
    """
    segments = outline.segments
    planes, circles = [float(y) for y in planes], [float(y) for y in circles]
    _refuse_impossible(segments, planes, circles, size, graded_size, reach, around)
    gmsh = import_gmsh()
    report = progress or (lambda fraction, message: None)

    limit, exact, trials = most_misshapen(around), moments_of_parts(outline), []
    for finer in FINER:
        with Session(gmsh):
            report(0.0, "drawing the meridian")
            draw_revolved(gmsh, outline, planes, circles)
            corners = graded_corners(outline, planes, circles, convex)
            least = (graded_size or size) / finer
            formulas = size_formulas(outline, corners, size, least, reach, around)
            set_size(gmsh, formulas, size)
            filling = filled(
                gmsh,
                "gmsh could not mesh the shaft ({}): change size or graded_size a little, "
                "or look for segments much thinner than size",
                report,
            )
        owner = segment_of_elements(filling.mesh, segments)
        shapes = misshapen(moments_of(filling.mesh, owner, outline), exact)
        trials.append((max(shape.error for shape in shapes), finer, filling, owner, shapes))
        if trials[-1][0] <= limit:
            break
    _, _, filling, owner, shapes = min(trials, key=lambda trial: trial[:2])
    refuse_misshapen(shapes, outline)

    report(0.9, "checking the mesh")
    quality = check_filling(filling, volume=volume_of(outline), rtol=lost_by_arcs(around))
    report(1.0, f"{quality.n_elements} elements")
    return TetMesh(filling.mesh, owner, replace(quality, geometry=geometry_error(shapes)))


def check_filling(filling: Filling, **limits: float) -> MeshQuality:
    """Return the quality of a mesh by :func:`~solidgear.core.meshing.quality.check_mesh`, with the error
    of straightened edges.
    """
    worst = max(filling.straightened.values(), default=0.0)
    return replace(check_mesh(filling.mesh, **limits), geometry=worst)


def lost_by_arcs(around: int) -> float:
    """Return the share of the volume that a mesh may lack with a number of elements around, four
    times the loss of the arcs by themselves: a lost part is far larger.
    """
    return max(1e-3, 4.0 * (pi / around) ** 4 / 30.0)


def segment_of_elements(mesh: MeshTet2, segments: Sequence[Shape]) -> np.ndarray:
    """Return the segment that each element lies in: interfaces are planes of element faces, so the
    mean of its corners decides.
    """
    y = mesh.p[1][mesh.t].mean(axis=0)
    return np.searchsorted([s.y1 for s in segments[:-1]], y)


def filled(gmsh, refusal: str, report=lambda fraction, message: None) -> Filling:
    """Return curved tetrahedra in all drawn volumes of a model with sizes; `refusal` is the
    MeshError where they cannot be made, in which the mesher's own words take the place of ``{}``.
    """
    try:
        for dimension, fraction in ((1, 0.05), (2, 0.1), (3, 0.3)):
            report(fraction, f"meshing dimension {dimension}")
            call(gmsh.model.mesh.generate, dimension)
        _move_onto_cones(gmsh)
        filling = to_skfem(gmsh)
        return relaxed(bisected(replace(filling, mesh=volume_preserved(filling.mesh))))
    except MeshError:
        raise
    except Exception as error:
        raise MeshError(refusal.format(error)) from error


def _move_onto_cones(gmsh):
    """Move nodes on shallow cones, which OCC turns into cylinders where their radius changes by
    less than a tenth of a millimetre, to the cone through the ends.
    """
    for _, face in gmsh.model.getEntities(2):
        if gmsh.model.getType(2, face) != "Cylinder":
            continue
        edges = gmsh.model.getBoundary([(2, face)], oriented=False, recursive=False)
        rim = [gmsh.model.mesh.getNodes(1, edge, includeBoundary=True)[1] for _, edge in edges]
        x, y, z = np.concatenate(rim).reshape(-1, 3).T
        radius = np.hypot(x, z)
        if not np.ptp(y) > 0 or np.ptp(radius) <= 1e-8 * radius.max():
            continue
        slope, first = np.polyfit(y - y[0], radius, 1)
        if np.abs(first + slope * (y - y[0]) - radius).max() > 1e-8 * radius.max():
            continue  # of another axis
        tags, places, _ = gmsh.model.mesh.getNodes(2, face)
        for tag, (a, b, c) in zip(tags, places.reshape(-1, 3)):
            share = float((first + slope * (b - y[0])) / np.hypot(a, c))
            gmsh.model.mesh.setNode(tag, [share * a, b, share * c], [])


def _refuse_impossible(segments, planes, circles, size, graded_size, reach, around):
    if not segments:
        raise MeshError("there is no segment to mesh: give at least one")
    for i, s in enumerate(segments):
        if not s.y1 > s.y0:
            raise MeshError(
                f"segment {i} ends at y = {s.y1:g} m, not after its start {s.y0:g} m: "
                "order it along y"
            )
        in_order = s.outer0 >= s.inner0 >= 0.0 and s.outer1 >= s.inner1 >= 0.0
        if not (in_order and s.outer0 + s.outer1 > s.inner0 + s.inner1):
            raise MeshError(f"segment {i} has no wall everywhere: keep 0 <= inner < outer")
    tolerance = tolerance_of(segments)
    for i, (a, b) in enumerate(zip(segments, segments[1:])):
        if abs(a.y1 - b.y0) > tolerance:
            raise MeshError(
                f"segment {i} ends at y = {a.y1:g} m but segment {i + 1} starts at {b.y0:g} m: "
                "put the segments end to end"
            )
        if min(a.outer1, b.outer0) <= max(a.inner1, b.inner0) + tolerance:
            raise MeshError(
                f"segments {i} and {i + 1} share no material at y = {a.y1:g} m: "
                "make their walls overlap"
            )
    for name, positions in (("plane", planes), ("circle", circles)):
        for y in positions:
            if not segments[0].y0 - tolerance <= y <= segments[-1].y1 + tolerance:
                raise MeshError(
                    f"the {name} at y = {y:g} m lies outside the shaft "
                    f"({segments[0].y0:g} to {segments[-1].y1:g} m): move it inside"
                )
    for name, value in (("size", size), ("graded_size", graded_size), ("reach", reach)):
        if value is not None and not value > 0.0:
            raise MeshError(f"{name} is {value:g} m: give a positive length")
    if around < 6:
        raise MeshError(f"around is {around}: at least 6 elements are needed around a circle")


def to_skfem(gmsh) -> Filling:
    """Return the gmsh mesh as a scikit-fem one, mid-edge nodes matched by the pair of corners they
    lie between.
    """
    types, volume, cells = [], [], []
    for _, tag in gmsh.model.getEntities(3):
        kinds, _, nodes = gmsh.model.mesh.getElements(3, tag)
        types += list(kinds)
        if list(kinds) == [_TET10]:
            cells.append(nodes[0].reshape(-1, 10).astype(np.int64))
            volume.append(np.full(len(nodes[0]) // 10, tag))
    if set(types) != {_TET10}:
        raise MeshError(
            "gmsh made no second-order tetrahedra: look for a gap in the meridian, "
            "or finalize gmsh if an earlier mesh failed in the same session"
        )
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    position = np.empty((int(tags.max()) + 1, 3))
    position[tags] = coordinates.reshape(-1, 3)
    nodes = np.concatenate(cells)
    corners, middles = nodes[:, :4].T, nodes[:, 4:].reshape(-1)
    ends = nodes[:, _mid_node_corners(gmsh)].reshape(-1, 2).T
    mesh = ten_nodes(position.T, corners, ends, position[middles].T)
    is_inner = np.zeros(len(position), bool)
    is_inner[gmsh.model.mesh.getNodes(3)[0]] = True
    inside = np.zeros(mesh.edges.shape[1], bool)
    inside[edge_places(mesh.edges, np.searchsorted(np.unique(corners), ends))] = is_inner[middles]
    return Filling(mesh, np.concatenate(volume), inside)


def _mid_node_corners(gmsh):
    """Return the local corners (6, 2) between which each mid node lies, read from gmsh, which has
    an order of its own.
    """
    reference = np.array(gmsh.model.mesh.getElementProperties(_TET10)[4]).reshape(10, 3)
    pairs = [(a, b) for a in range(4) for b in range(a + 1, 4)]
    halves = np.array([(reference[a] + reference[b]) / 2.0 for a, b in pairs])
    return np.array([pairs[np.abs(halves - node).sum(axis=1).argmin()] for node in reference[4:]])
