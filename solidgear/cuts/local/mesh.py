"""Tetrahedra in a piece of a cylinder around a cut, whose corners are rounded as a cutter leaves
them.

Planes of symmetry of the cut divide the piece: one half, a quarter or an eighth of it is meshed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core import SolidgearError
from solidgear.core.meshing.element_size import _num, set_size
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.meshing.tetrahedra import check_filling, filled
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric
from solidgear.cuts.features.cross_hole import CrossHole
from solidgear.cuts.features.cut import Frame
from solidgear.cuts.features.keyway import Keyway
from solidgear.cuts.solid.cuts import OVERHANG

if TYPE_CHECKING:
    from solidgear.cuts.features.cut import Cut

#: edges of elements: of the largest, in outer radii, and on the bore in its own; at a hole and at
#: the root of a keyway, in their radii; at the ends of a keyway, in half its width
BULK, AT_HOLE, AT_ROOT, AT_END = 0.5, 0.5, 1.5, 0.5
#: growth of edges per distance from a hole or an end, from a root, and from places of large stress
GROWTH, FROM_ROOT, NEAR_PEAK = 0.6, 1.0, 0.5
#: gmsh's number of the mesher of volumes: at steep changes of size along a thin root the usual one
#: has been seen to look for a boundary without end
HXT = 10
#: share of the volume that a mesh may be off by
VOLUME = 1e-3


@dataclass(frozen=True)
class LocalShape:
    """A cut in a cylinder, looking to +z."""

    cut: Cut  #: at the angle 0
    #: outer, inner: radii of the cylinder, m
    outer: float
    inner: float
    reach: float  #: how far the piece goes on beyond the cut, m

    @property
    def radius(self) -> float:
        """Radius of the edges at the floor, m; 0 of sharp ones, and of a hole, which has none."""
        return (isinstance(self.cut, Keyway) and self.cut.radius) or 0.0

    @property
    def mill(self) -> float:
        """Radius of the disc mill that runs out beyond square ends, m; 0 without."""
        return ((isinstance(self.cut, Keyway) and self.cut.mill) or 0.0) / 2

    @property
    def middle(self) -> float:
        """Place of the middle of the cut along the shaft, m."""
        low, high = self.cut.reach(self.outer)
        return (low + high) / 2

    @property
    def half(self) -> float:
        """Half of the length of the piece, m."""
        low, high = self.cut.reach(self.outer)
        return (high - low) / 2 + self.run_out + self.reach

    @property
    def run_out(self) -> float:
        """Length of the run-out of a disc mill, m."""
        if not self.mill:
            return 0.0
        return math.sqrt(self.mill**2 - (self.mill - self.cut.depth) ** 2)

    @property
    def planes(self) -> tuple[int, ...]:
        """Axes at right angles to the planes of symmetry through the middle."""
        cut = self.cut
        leans = isinstance(cut, CrossHole) and bool(cut.inclination)
        symmetric = (cut.mirrored(False), not leans, isinstance(cut, CrossHole) and not leans)
        return tuple(axis for axis, is_plane in enumerate(symmetric) if is_plane)

    @property
    def size(self) -> float:
        """Extent of the notch that its stress varies over, m."""
        return self.cut.diameter / 2 if isinstance(self.cut, CrossHole) else self.radius


Places = tuple[np.ndarray, float]
"""Places (3, m) of large stress, m from the middle, and the edge of elements there, m."""


def local_mesh(shape: LocalShape, places: Sequence[Places] = ()) -> SolidMesh:
    """Mesh the piece around a cut, about its middle, with smaller elements at some places."""
    gmsh = import_gmsh()
    with Session(gmsh):
        occ = gmsh.model.occ
        piece = _drawn(occ, shape)
        tags = [_points(occ, *group, shape.middle) for group in places]
        occ.synchronize()
        volume = occ.getMass(3, piece)
        sizes = _sizes(shape)
        for points, (_, edge) in zip(tags, places):
            distance = gmsh.model.mesh.field.add("Distance")
            gmsh.model.mesh.field.setNumbers(distance, "PointsList", points)
            sizes.append(f"{_num(edge)}+{_num(NEAR_PEAK)}*F{distance}")
        # an arc must not bulge through a thin wall: height edge^2 / 8r
        thin = math.sqrt(1 - shape.inner / shape.outer)
        set_size(gmsh, sizes, min(BULK, thin) * shape.outer)
        gmsh.option.setNumber("Mesh.Algorithm3D", HXT)
        filling = filled(
            gmsh,
            f'gmsh could not mesh the shaft around "{shape.cut.name}" ({{}}): change its size a '
            "little",
        )
    check_filling(filling, volume=volume, rtol=VOLUME)
    mesh = filling.mesh
    mesh.doflocs[1] -= shape.middle
    return _isoparametric(mesh, "tet10", np.zeros(mesh.t.shape[1], int))


def _points(occ: Any, places: np.ndarray, edge: float, middle: float) -> list[int]:
    """Draw one point in every cube of an edge that some places (3, m) lie in; return their tags."""
    _, first = np.unique(np.round(places / edge), axis=1, return_index=True)
    return [occ.addPoint(x, y + middle, z) for x, y, z in places[:, first].T]


def _drawn(occ: Any, shape: LocalShape) -> int:
    """Draw the part of the piece between planes of symmetry and return its tag."""
    outer, start, length = shape.outer, shape.middle - shape.half, 2 * shape.half
    body = [(3, occ.addCylinder(0, start, 0, 0, length, 0, outer))]
    if shape.inner:
        bore = [(3, occ.addCylinder(0, start, 0, 0, length, 0, shape.inner))]
        body, _ = occ.cut(body, bore)
    tool = [(3, _tool(occ, shape))]
    body, _ = occ.cut(body, tool)
    low = [-2 * outer, start - outer, -2 * outer]
    extent = [4 * outer, length + 2 * outer, 4 * outer]
    for axis in shape.planes:
        at = shape.middle if axis == 1 else 0.0
        extent[axis] += low[axis] - at
        low[axis] = at
    body, _ = occ.intersect(body, [(3, occ.addBox(*low, *extent))])
    if len(body) != 1:
        raise SolidgearError(f'"{shape.cut.name}" leaves no single piece of the shaft around it')
    return body[0][1]


def _tool(occ: Any, shape: LocalShape) -> int:
    """Draw the solid that is cut out, with round edges at the floor, and return its tag."""
    if shape.mill:
        solid = _milled(occ, shape)
    else:
        solid = shape.cut.tool(occ, shape.outer, OVERHANG * shape.outer)
    if not shape.radius:
        return solid
    edges = [edge for face in _lowest_faces(occ, solid, shape) for edge in _edges(occ, face)]
    # those between two of these faces turn smoothly
    rim = [edge for edge in dict.fromkeys(edges) if edges.count(edge) == 1]
    if shape.mill:
        half = shape.cut.width / 2
        rim = [e for e in rim if abs(abs(occ.getCenterOfMass(1, e)[0]) - half) < 1e-6 * half]
    return occ.fillet([solid], rim, [shape.radius])[0][1]


def _milled(occ: Any, shape: LocalShape) -> int:
    """Draw what a disc mill cuts out and return its tag."""
    low, high = shape.cut.reach(shape.outer)
    floor, away, half = shape.outer - shape.cut.depth, shape.run_out, shape.cut.width / 2
    top, mill = shape.outer + OVERHANG * shape.outer, shape.mill

    def point(y: float, z: float) -> int:
        return occ.addPoint(-half, y, z)

    # an arc goes on beyond the crown, so that what leaves the shaft has no end face in it
    over = math.sqrt(mill**2 - (floor + mill - top) ** 2) if top < floor + mill else mill
    top = min(top, floor + mill)
    corners = [
        point(low - over, top),
        point(low, floor),
        point(high, floor),
        point(high + over, top),
    ]
    middles = [point(low, floor + mill), point(high, floor + mill)]
    lines = [
        occ.addCircleArc(corners[0], middles[0], corners[1]),
        occ.addLine(corners[1], corners[2]),
        occ.addCircleArc(corners[2], middles[1], corners[3]),
        occ.addLine(corners[3], corners[0]),
    ]
    assert over >= away
    drawn = occ.extrude([(2, occ.addPlaneSurface([occ.addCurveLoop(lines)]))], 2 * half, 0, 0)
    return next(tag for dim, tag in drawn if dim == 3)


def _lowest_faces(occ: Any, solid: int, shape: LocalShape) -> list[int]:
    """Return the floor of a solid, and the run-outs beside it."""
    _, loops = occ.getSurfaceLoops(solid)
    faces = [int(face) for loop in loops for face in loop]
    floor = shape.outer - shape.cut.depth
    lowest = min(faces, key=lambda face: abs(occ.getCenterOfMass(2, face)[2] - floor))
    if not shape.mill:
        return [lowest]
    beside = set(_edges(occ, lowest))
    # sides of the slot share long edges with the floor, run-outs the short ones across
    half = shape.cut.width / 2
    return [
        face
        for face in faces
        if face == lowest
        or (beside & set(_edges(occ, face)) and abs(occ.getCenterOfMass(2, face)[0]) < 0.5 * half)
    ]


def _edges(occ: Any, face: int) -> list[int]:
    """Return the edges of a face."""
    _, loops = occ.getCurveLoops(face)
    return [int(edge) for loop in loops for edge in loop]


def _sizes(shape: LocalShape) -> list[str]:
    """Return formulas of the element edge at the cut."""
    cut, frame = shape.cut, Frame("x", "z", _num)
    if isinstance(cut, Keyway):
        away, _ = cut.from_edges(shape.outer, frame)
        if shape.mill:
            away = f"Min({away},{_from_run_out(shape)})"
        # the root lies inside the sharp edge by up to its radius
        formulas = [
            f"{_num(AT_ROOT * shape.radius)}+{_num(FROM_ROOT)}*Max(0,{away}-{_num(shape.radius)})"
        ]
        around = AT_END * cut.width / 2
    else:
        formulas, around = [], AT_HOLE * shape.size
    formulas.append(f"{_num(around)}+{_num(GROWTH)}*{cut.distance(shape.outer, frame)}")
    if shape.inner:
        away = f"Sqrt((Sqrt(x^2+z^2)-{_num(shape.inner)})^2)"
        formulas.append(f"{_num(BULK * shape.inner)}+{_num(GROWTH)}*{away}")
    return formulas


def _from_run_out(shape: LocalShape) -> str:
    """Return the formula of the distance from the edges of the run-outs of a disc mill, m."""
    low, high = shape.cut.reach(shape.outer)
    middle = shape.outer - shape.cut.depth + shape.mill
    along = f"Max(0,Max({_num(low)}-y,y-{_num(high)}))"
    off = f"(Sqrt({along}^2+(z-{_num(middle)})^2)-{_num(shape.mill)})"
    return f"Sqrt((Sqrt(x^2)-{_num(shape.cut.width / 2)})^2+{off}^2)"
