"""One sector of a shaft drawn in OCC: wedges, toothed slabs, holes, and the pairs of cut faces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import cos, pi, sin
from typing import Any

import numpy as np

from solidgear.core import Outline, rotation
from solidgear.core.meshing.quality import MeshError
from solidgear.core.meshing.revolved import draw_revolved
from solidgear.core.scene.outline import Frustum
from solidgear.cuts.features.around import middle
from solidgear.cuts.sector.teeth import half_outline
from solidgear.cuts.sector.teeth import outline as teeth_outline
from solidgear.cuts.solid.holes import hole_places


def draw_sector(gmsh, outline: Outline, toothed, planes, circles, count: int, half: bool):
    """Draw the volumes of the sector, or of a half from the middle on: wedges of runs of plain
    segments, and slabs of toothed ones. Volumes overlap where fillets stand on the faces of toothed
    segments.
    """
    segments = outline.segments
    turn = (pi if half else 2 * pi) / count
    start = -pi / 2 - (0.0 if half else turn / 2)
    runs: list[list[int]] = []
    for i, s in enumerate(segments):
        if s.name in toothed:
            inside = [y for y in (*planes, *circles) if s.y0 < y < s.y1]
            _draw_teeth(gmsh, s, toothed[s.name], sorted(set(inside)), count, half)
        elif runs and runs[-1][-1] == i - 1:
            runs[-1].append(i)
        else:
            runs.append([i])
    for run in runs:
        plain = [segments[i] for i in run]
        inside = [
            [y for y in places if plain[0].y0 <= y <= plain[-1].y1] for places in (planes, circles)
        ]
        low, high = (_under_teeth(outline, toothed, joint) for joint in (run[0], run[-1] + 1))
        moved = [
            replace(c, owner=c.owner - run[0] + len(low)) for c in outline.corners if c.owner in run
        ]
        drawn = Outline([*low, *plain, *high], moved)
        draw_revolved(gmsh, drawn, inside[0], inside[1], start, turn)
    gmsh.model.occ.synchronize()
    return gmsh.model.getEntities(3)


def draw_toothed(gmsh, outline: Outline, features, planes, circles) -> None:
    """Draw the volumes of a whole shaft with straight teeth and bolt circles: the half on one side
    of a mirror plane of the teeth, the image, and holes. Volumes overlap as those of a sector do.
    """
    occ, toothed = gmsh.model.occ, {f.segment: f for f in features if f.toothed}
    first = next((middle(teeth, 1) for teeth in toothed.values()), 0.0)
    half = draw_sector(gmsh, outline, toothed, planes, circles, 1, True)
    image = occ.copy(half)
    occ.mirror(image, 1.0, 0.0, 0.0, 0.0)
    holes = [f for f in features if not f.toothed]
    volumes = drill(gmsh, [*half, *image], holes, outline.segments, [], 1, first)
    occ.rotate(volumes, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, first)
    occ.synchronize()


def _under_teeth(outline: Outline, toothed: Mapping[str, Any], joint: int) -> list[Frustum]:
    """Return a short piece of a toothed segment below the roots of its teeth, where a fillet or
    chamfer stands on its face: the wedge beside it has this face to be drawn to.
    """
    roots = [c for c in outline.corners if c.root and c.joint == joint]
    corners = [c for c in roots if outline.segments[c.face_owner].name in toothed]
    if not corners:
        return []
    corner, s = corners[0], outline.segments[corners[0].face_owner]
    ends = (s.outer0, s.inner0), (s.outer1, s.inner1)
    (outer, inner), (far_outer, far_inner) = ends[:: corner.side]
    share = min(corner.radial / s.length, 0.5)
    root = toothed[s.name].land * outer
    r = (corner.on_face[0] + root) / 2
    far = (
        corner.y - corner.side * share * s.length,
        r * (1 + share * (far_outer / outer - 1)),
        inner + share * (far_inner - inner),
    )
    (y0, outer0, inner0), (y1, outer1, inner1) = (far, (corner.y, r, inner))[:: corner.side]
    return [Frustum(y0, y1, outer0, outer1, inner0, inner1)]


def _draw_teeth(gmsh, segment, teeth, cuts: list[float], count: int, half: bool) -> None:
    """Draw a toothed segment between the cut faces, as polyhedra from cut to cut, less the bore."""
    occ = gmsh.model.occ
    angle, radius = (half_outline if half else teeth_outline)(teeth, count)
    places = [segment.y0, *cuts, segment.y1]
    sections = []
    for y in places:
        r = segment.outer0 + (segment.outer1 - segment.outer0) * (y - segment.y0) / segment.length
        points = [occ.addPoint(0.0, y, 0.0)]
        points += [occ.addPoint(r * q * sin(t), y, r * q * cos(t)) for t, q in zip(angle, radius)]
        rim = [occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
        face = occ.addPlaneSurface([occ.addCurveLoop(rim)])
        sections.append((points, rim, face))
    solids = []
    for low, high in zip(sections, sections[1:]):
        risers = [occ.addLine(a, b) for a, b in zip(low[0], high[0])]
        n = len(risers)
        sides = [
            occ.addPlaneSurface(
                [occ.addCurveLoop([low[1][i], risers[(i + 1) % n], -high[1][i], -risers[i]])]
            )
            for i in range(n)
        ]
        solids.append((3, occ.addVolume([occ.addSurfaceLoop([low[2], *sides, high[2]])])))
    if segment.inner0 or segment.inner1:
        a, b, length = segment.inner0, segment.inner1, segment.length
        if a == b:
            bore = occ.addCylinder(0.0, segment.y0, 0.0, 0.0, length, 0.0, a)
        else:
            bore = occ.addCone(0.0, segment.y0, 0.0, 0.0, length, 0.0, a, b)
        occ.cut(solids, [(3, bore)])


def drill(gmsh, volumes, holes, segments, twists, count: int, first: float):
    """Cut the holes that reach into the sector, also those that its borders halve; return the
    volumes.
    """
    occ, tools = gmsh.model.occ, []
    for f in holes:
        segment = next(s for s in segments if s.name == f.segment)
        lo, hi = f.reach(segment)
        half = pi / count + 2 * f.diameter / f.circle
        for x, z in hole_places(f, segment, twists, first, half):
            tools.append((3, occ.addCylinder(x, lo, z, 0.0, hi - lo, 0.0, f.diameter / 2)))
    if not tools:
        return volumes
    cut, _ = occ.cut(volumes, tools)
    occ.synchronize()
    return [entity for entity in cut if entity[0] == 3]


def pair_faces(gmsh, count: int) -> None:
    """Pair in gmsh the cut faces that carry the same mesh."""
    half = pi / count
    low: dict[int, tuple[float, ...]] = {}
    high: dict[int, tuple[float, ...]] = {}
    for _, face in gmsh.model.getEntities(2):
        x, y, z = gmsh.model.occ.getCenterOfMass(2, face)
        t, key = np.arctan2(x, z), (np.hypot(x, z), y, gmsh.model.occ.getMass(2, face))
        if abs(abs(t) - half) < 1e-7:
            (low if t < 0 else high)[face] = key
    high_keys = np.array(list(high.values())).reshape(-1, 3)
    if len(high_keys) != len(low):
        raise MeshError("the two cut faces of the sector are not divided alike")
    pairs = []
    for face, place in low.items():
        k = int(np.abs(high_keys - place).max(axis=1).argmin())
        pairs.append((list(high)[k], face))
    if len({slave for slave, _ in pairs}) != len(low):
        raise MeshError("the two cut faces of the sector are not divided alike")
    turn = np.eye(4)
    turn[:3, :3] = rotation(1, 2 * half)[:3, :3]
    slaves, masters = zip(*pairs)
    gmsh.model.mesh.setPeriodic(2, slaves, masters, turn.ravel().tolist())
