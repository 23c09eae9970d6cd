"""One sector of a shaft that repeats itself around the axis, in curved tetrahedra.

The sector lies between two half planes through the axis, at half its angle to either side of +z.
Segments of revolution are drawn as wedges, toothed ones as polyhedra whose sections are homothetic,
so that all of their faces are planes. Both cut faces carry the same mesh (`setPeriodic` of gmsh),
and their nodes are matched by place. Spiral teeth are the straight ones twisted about the axis:
``theta(y) = tan(beta) int dy / (r cos(delta))`` turns every section rigidly, so that cut faces stay
each other's image and volumes stay the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, gcd, pi, sin
from typing import Any

import numpy as np
from scipy.spatial import cKDTree
from skfem import MeshTet2

from solidgear.core import Outline, rotation
from solidgear.core.meshing.curving import ten_nodes, with_nodes
from solidgear.core.meshing.element_size import set_size, size_formulas
from solidgear.core.meshing.geometry import (
    Misshapen,
    geometry_error,
    misshapen,
    moments_of,
    most_misshapen,
    refuse_misshapen,
    whole_moments,
)
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.meshing.quality import MeshError, MeshQuality, check_mesh
from solidgear.core.meshing.revolved import graded_corners
from solidgear.core.meshing.tetrahedra import (
    FINER,
    check_filling,
    filled,
    lost_by_arcs,
    segment_of_elements,
)
from solidgear.core.scene.closed_form import (
    integrals_along,
    moments_about,
    moments_of_parts,
    parts_of,
    volume_of,
)
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.around import middle, mirror_angle, no_common_sector
from solidgear.cuts.sector.drawing import draw_sector, drill, pair_faces
from solidgear.cuts.sector.teeth import section_area, section_polar, tooth_size, turn_at
from solidgear.cuts.solid.holes import Hole, hole_of, hole_places, hole_size

#: of the length of the shaft: cut faces whose nodes match no better than this do not match
MATCH = 1e-9


@dataclass(frozen=True)
class SectorMesh:
    """A meshed sector, or the half of one that is even about the middle."""

    #: twisted as its teeth are; a half has its middle plane in x = 0, whatever ``turn`` is
    mesh: MeshTet2
    segment: np.ndarray  #: (ne,) segment each element lies in
    count: int  #: sectors around
    straight: np.ndarray  #: (3, nv) vertices before they were twisted, m
    quality: MeshQuality  #: of the twisted mesh
    drawn: float  #: volume of the sector (of a half, of that half) that OCC has drawn, m^3
    turn: float = 0.0  #: angle of the middle of the sector at the start of the shaft, rad
    half: bool = False

    @property
    def parts(self) -> int:
        """Number of such meshes around the shaft."""
        return self.count * (2 if self.half else 1)


def sectors_of(features: Iterable[Any]) -> int:
    """Return the number of equal sectors of a shaft with cyclic features, the greatest common
    divisor of their counts; 0 without any.

    Examples
    --------
    >>> from solidgear.cuts.features import BoltCircle, Teeth
    >>> teeth = Teeth(name="teeth", segment="rim", count=42)
    >>> sectors_of([teeth, BoltCircle(name="b", segment="web", count=6, diameter=0.01, circle=0.1)])
    6
    """
    return gcd(*(f.count for f in features))


def sector_mesh(
    outline: Outline[Segment],
    features: tuple[Any, ...],
    planes: list[float],
    circles: list[float],
    *,
    size: float,
    graded_size: float | None,
    around: int,
    refinement: float,
    count: int | None = None,
) -> SectorMesh:
    """Mesh one sector of a shaft with cyclic features, or half of one where a mirror plane runs
    through its middle; without a `count` there are as many around as the features say.

    Sizes are those of :func:`solidgear.core.meshing.tetrahedra.tetrahedra`, given refined; `refinement`
    divides the sizes at features. MeshError for features without a common sector, geometry that
    cannot be meshed, cut faces that do not match, inverted elements, or wrong volumes and second moments.
    """
    count = count or sectors_of(features)
    reason = no_common_sector(features, count)
    if reason:
        raise MeshError(reason)
    limit, trials = most_misshapen(around), []
    for finer in FINER:
        sizes = {"size": size, "graded_size": (graded_size or size) / finer, "around": around}
        meshed = _meshed(outline, features, planes, circles, count, refinement, sizes)
        shapes = sector_shapes(meshed, outline, features)
        trials.append((max((shape.error for shape in shapes), default=0.0), finer, meshed, shapes))
        if trials[-1][0] <= limit:
            break
    *_, meshed, shapes = min(trials, key=lambda trial: trial[:2])
    if not shapes:
        return meshed
    refuse_misshapen(shapes, outline)
    return replace(meshed, quality=replace(meshed.quality, geometry=geometry_error(shapes)))


def _meshed(
    outline: Outline[Segment],
    features: tuple[Any, ...],
    planes: list[float],
    circles: list[float],
    count: int,
    refinement: float,
    sizes: Mapping[str, Any],
) -> SectorMesh:
    """Mesh one of so many sectors as :func:`sector_mesh` does."""
    around = sizes["around"]
    gmsh = import_gmsh()
    segments = outline.segments
    toothed = {f.segment: f for f in features if f.toothed}
    plane = mirror_angle(features, count)
    half = plane is not None
    first = next((middle(teeth, count) for teeth in toothed.values()), plane or 0.0)
    twists = [(s, toothed[s.name]) for s in segments if s.name in toothed]
    with Session(gmsh):
        volumes = draw_sector(gmsh, outline, toothed, planes, circles, count, half)
        holes = [f for f in features if not f.toothed]
        volumes = drill(gmsh, volumes, holes, segments, twists, count, first)
        if len(volumes) > 1:
            gmsh.model.occ.fragment(volumes[:1], volumes[1:])
        gmsh.model.occ.synchronize()
        drawn = sum(gmsh.model.occ.getMass(3, v) for _, v in gmsh.model.getEntities(3))
        if not half:
            pair_faces(gmsh, count)
        corners = graded_corners(outline, planes, circles)
        formulas = size_formulas(
            outline, corners, sizes["size"], sizes["graded_size"], None, around
        )
        formulas += tooth_sizes(segments, features, refinement)
        for f, segment, hole in hole_sizes(segments, features, refinement):
            # those in the sector, and on either side of it
            reach = pi / count + 2 * pi / f.count
            formulas.append(hole_size(hole, hole_places(f, segment, twists, first, reach)))
        set_size(gmsh, formulas, sizes["size"])
        filling = filled(gmsh, "gmsh could not mesh the sector ({}): change refinement a little")
    mesh = filling.mesh
    exact = volume_of_sector(outline, features, count) / (2 if half else 1)
    quality = check_filling(filling, volume=exact, rtol=lost_by_arcs(around))
    owner = segment_of_elements(mesh, segments)
    if half:
        return SectorMesh(mesh, owner, count, mesh.p, quality, drawn, first, half=True)
    # turned to the direction of the features
    twisted = _turned(mesh, lambda y: first + turn_at(y, twists))
    quality = check_filling(replace(filling, mesh=twisted))
    return SectorMesh(twisted, owner, count, mesh.p, quality, drawn, first)


def tooth_sizes(
    segments: Iterable[Segment], features: Iterable[Any], refinement: float
) -> list[str]:
    """Return formulas of element size at teeth, as gmsh reads them."""
    by_name = {s.name: s for s in segments}
    return [tooth_size(f, by_name[f.segment], refinement) for f in features if f.toothed]


def hole_sizes(
    segments: Iterable[Segment], features: Iterable[Any], refinement: float
) -> list[tuple[Any, Any, Hole]]:
    """Return bolt circles, the segments that they are in, and their holes with element sizes."""
    by_name = {s.name: s for s in segments}
    bolts = [(f, by_name[f.segment]) for f in features if not f.toothed]
    return [(f, segment, hole_of(f, segment, refinement)) for f, segment in bolts]


def sizes_around(
    segments: Sequence[Segment], features: Iterable[Any], refinement: float
) -> list[str]:
    """Return formulas of element size at straight teeth and bolt circles of a whole shaft."""
    holes = hole_sizes(segments, features, refinement)
    return tooth_sizes(segments, features, refinement) + [
        hole_size(hole, hole_places(f, segment, [], 0.0, pi + 1)) for f, segment, hole in holes
    ]


def volume_of_sector(outline: Outline[Segment], features: Iterable[Any], count: int) -> float:
    """Return the volume of one of `count` sectors in closed form, m^3."""
    toothed, segments = {f.segment: f for f in features if f.toothed}, outline.segments
    total = volume_of(outline) - volume_of(Outline(segments))  # of fillets and chamfers
    for s in segments:
        area = section_area(toothed[s.name]) if s.name in toothed else pi
        total += area * integrals_along(s.length, s.outer0, s.outer1)[0]
        total -= pi * integrals_along(s.length, s.inner0, s.inner1)[0]
    for f in features:
        if not f.toothed:
            lo, hi = f.reach(next(s for s in segments if s.name == f.segment))
            total -= f.count * pi * f.diameter**2 / 4 * (hi - lo)
    return total / count


def moments_of_sectors(outline: Outline[Segment], features: Iterable[Any]) -> np.ndarray:
    """Compute the moments of the parts of a shaft with teeth and bolt circles as
    :func:`~solidgear.core.scene.closed_form.moments_of_parts` does.
    """
    parts, out = parts_of(outline), moments_of_parts(outline)
    numbers = {s.name: number for number, s in enumerate(outline.segments)}
    for f in features:
        s = outline.segments[numbers[f.segment]]
        part = parts.of_segments[numbers[f.segment]]
        if f.toothed:
            beside = s.y0 - parts.middles[part]
            square, first, second, fourth = integrals_along(s.length, s.outer0, s.outer1)
            area = section_area(f) - pi
            polar = (section_polar(f) - pi / 2) * fourth
            out[part] += moments_about(beside, area * square, area * first, area * second, polar)
        else:
            lo, hi = f.reach(s)
            volume = f.count * pi * f.diameter**2 / 4 * (hi - lo)
            polar = volume * (f.circle**2 / 4 + f.diameter**2 / 8)
            beside = (lo + hi) / 2 - parts.middles[part]
            out[part] -= moments_about(beside, volume, 0.0, volume * (hi - lo) ** 2 / 12, polar)
    return out


def sector_shapes(
    sector: SectorMesh, outline: Outline[Segment], features: Sequence[Any]
) -> list[Misshapen]:
    """Compare the moments of a meshed sector, all of them together, with the closed form; none of two
    holes, which are not alike about the axis.
    """
    if any(f.count < 3 for f in features):
        return []
    turns = [rotation(1, 2 * pi * k / sector.count)[:3, :3] for k in range(sector.count)]
    if sector.half:
        turns += [turn @ np.diag([-1.0, 1.0, 1.0]) for turn in turns]
    moments = whole_moments(moments_of(sector.mesh, sector.segment, outline), turns)
    return misshapen(moments, moments_of_sectors(outline, features))


def _turned(mesh: MeshTet2, angle) -> MeshTet2:
    """Return the mesh with every section turned about +y, by an angle that depends on y."""
    x, y, z = mesh.doflocs
    c, s = np.cos(angle(y)), np.sin(angle(y))
    return with_nodes(mesh, np.stack([c * x + s * z, y, c * z - s * x]))


def matched(nodes: np.ndarray, count: int, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return the nodes on one cut face that a turn takes to those of the other, one for every one
    of `high`; MeshError if one of them has no partner.
    """
    turned = rotation(1, 2 * pi / count)[:3, :3] @ nodes[:, low]
    gap, nearest = cKDTree(turned.T).query(nodes[:, high].T)
    widest = gap.max(initial=0.0)
    paired = len(low) == len(high) and len(np.unique(nearest)) == len(low)
    if not paired or widest > MATCH * np.ptp(nodes[1]):
        raise MeshError(f"the cut faces of the sector carry different meshes, {widest:.1e} m apart")
    return low[nearest]


def cut_vertices(sector: SectorMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return vertices of the lower and of the higher cut face, without those on the axis, and
    these.
    """
    used = np.unique(sector.mesh.t)
    x, _, z = sector.straight[:, used]
    near = np.hypot(x, z) < MATCH * np.ptp(sector.straight[1])
    # distance from the cut planes, whose normals the angle gives
    c, s = cos(pi / sector.count), sin(pi / sector.count)
    tolerance = MATCH * np.ptp(sector.straight[1])
    on_faces = [np.abs(x * c - sign * z * s) < tolerance for sign in (-1, 1)]
    return (*(used[side & ~near] for side in on_faces), used[near])


def replicated(sector: SectorMesh) -> tuple[MeshTet2, np.ndarray]:
    """Return the mesh of the whole shaft, sector by sector around the axis, and the segment of each
    element.
    """
    mesh, count = sector.mesh, sector.count
    corners = np.unique(mesh.t)
    low, high, axis = cut_vertices(sector)
    master = matched(mesh.p, count, low, high)
    inner = np.setdiff1d(corners, np.r_[high, axis])
    place = np.zeros(mesh.p.shape[1], int)
    place[inner] = np.arange(len(inner))
    number = np.zeros((count, mesh.p.shape[1]), int)
    number[:, inner] = place[inner] + len(inner) * np.arange(count)[:, None]
    number[:, high] = np.roll(number, -1, axis=0)[:, master]
    number[:, axis] = len(inner) * count + np.arange(len(axis))
    total = len(inner) * count + len(axis)
    turns = [rotation(1, 2 * pi * k / count)[:3, :3] for k in range(count)]
    return joined(mesh, turns, number, total), np.tile(sector.segment, count)


def mirrored(sector: SectorMesh) -> SectorMesh:
    """Return the whole sector from half of it, the elements and their images in the middle plane; a
    whole one as it is.
    """
    if not sector.half:
        return sector
    mesh = sector.mesh
    used = np.unique(mesh.t)
    beside_plane = used[np.abs(mesh.p[0, used]) > MATCH * np.ptp(mesh.p[1])]
    number = np.zeros((2, mesh.p.shape[1]), int)
    number[:, used] = np.arange(len(used))
    number[1, beside_plane] = len(used) + np.arange(len(beside_plane))
    both_halves = joined(
        mesh, [np.eye(3), np.diag([-1.0, 1.0, 1.0])], number, len(used) + len(beside_plane)
    )
    turned = _turned(both_halves, lambda y: sector.turn)
    segment = np.tile(sector.segment, 2)
    quality = replace(check_mesh(turned), geometry=sector.quality.geometry)
    return SectorMesh(
        turned, segment, sector.count, both_halves.p, quality, 2 * sector.drawn, sector.turn
    )


def joined(mesh: MeshTet2, maps: Sequence[np.ndarray], number: np.ndarray, total: int) -> MeshTet2:
    """Return one mesh of copies of a mesh, turned or mirrored by orthogonal maps.

    `number` (copies, nv) are the numbers of the vertices of every copy, of a total of all copies;
    those that copies share come to lie on each other.
    """
    points, cells, ends, middles = np.zeros((3, total)), [], [], []
    middle = mesh.doflocs[:, mesh.dofs.edge_dofs[0]]
    corners = np.unique(mesh.t)
    for name, turn in zip(number, maps):
        points[:, name[corners]] = turn @ mesh.p[:, corners]
        # an image in a mirror is left-handed
        t = mesh.t if np.linalg.det(turn) > 0 else mesh.t[[0, 2, 1, 3]]
        cells.append(name[t])
        ends.append(name[mesh.edges])
        middles.append(turn @ middle)
    return ten_nodes(points, np.hstack(cells), np.hstack(ends), np.hstack(middles))
