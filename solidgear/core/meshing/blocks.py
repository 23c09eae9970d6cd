"""Blocks of cells at edges that have a fillet or a chamfer, on the two sides of a joint and on the
two sides of a band.

Next to such an edge a mesh has a block of as many rows as rings, which
:mod:`solidgear.core.meshing.blended` exchanges; this file finds how large it is along the shaft.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.meshing.corners import corner_layers
from solidgear.core.meshing.grading import Grading, joint_length
from solidgear.core.meshing.marks import Mark, lines_between
from solidgear.core.scene.corner import SURFACES, Corner, Surface
from solidgear.core.scene.limits import TOUCH
from solidgear.core.scene.outline import Outline, radii_of

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft

#: how deep into the material the block at a root reaches, in sizes of the fillet
DEPTH = 1.0
#: and of the way to the next end of a segment, at most
MOST_OF_WAY = 0.3
#: the last layer towards a fillet begins this far from its block, in sizes of the block
GROWTH = 1.0


@dataclass
class Zone:
    """Rows of blocks on one side of a joint."""

    side: int  #: -1 where y is smaller than at the joint, +1 where it is larger
    rows: int = 0  #: 0 where there is no block
    #: axial extent of fillets that run into this side from the face of the other, m
    skip: float = 0.0
    #: how far the zone reaches at some radii, m
    knots: list[tuple[float, float]] = field(default_factory=list)

    @property
    def depth(self) -> float:
        """Largest depth, m."""
        return max((d for _, d in self.knots), default=0.0)

    @property
    def reach(self) -> float:
        """First place beyond all fillets, from the joint, m."""
        return max(self.depth, self.skip)

    def depth_at(self, r: np.ndarray) -> np.ndarray:
        """Return the depths at some radii, m."""
        return np.interp(r, *np.array(sorted(self.knots)).T)


@dataclass
class Joint:
    """A place where segments meet, or an end face, with the edges that have fillets or chamfers."""

    y: float  #: m
    index: int  #: number of the segment that begins here
    corners: list[Corner]
    low: Zone = field(default_factory=lambda: Zone(-1))
    high: Zone = field(default_factory=lambda: Zone(1))
    line: int = -1  #: mesh line of the joint, once there is one
    #: radii of steps without a root, whose plane faces lie at the joint, m
    bare: tuple[float, ...] = ()

    def zone(self, side: int) -> Zone:
        """Return the zone of one side."""
        return self.low if side < 0 else self.high

    def cells(self, corner: Corner) -> int:
        """Return the rows of the block of an edge: of a root all there are in its zone."""
        return self.zone(corner.face_side).rows

    def shift(self, r: np.ndarray) -> np.ndarray:
        """Return the distance of the line of the joint from it where both sides have material,
        m.
        """
        roots = [(c.r, c.side * c.axial) for c in self.corners if c.root]
        if not roots:
            return np.zeros(np.shape(r))
        knots = sorted([*roots, *((radius, 0.0) for radius in self.bare)])
        return np.interp(r, *np.array(knots).T)


def joints_of(scene: Shaft, grading: Grading, marks: Sequence[Mark]) -> list[Joint]:
    """Return joints with fillets or chamfers, and how large the blocks are along the shaft."""
    by_place = defaultdict(list)
    for corner in scene.outline.corners:
        by_place[corner.joint].append(corner)
    ends = [0.0, *(s.y1 for s in scene.segments)]
    joints = [
        Joint(ends[k], k, by_place[k], bare=_bare_steps(scene, k, by_place[k]))
        for k in sorted(by_place)
    ]
    for joint in joints:
        for zone in (joint.low, joint.high):
            _set_size(joint, zone, grading, ends, marks)
    return joints


def _bare_steps(scene: Shaft, index: int, corners: Sequence[Corner]) -> tuple[float, ...]:
    """Return the radii of steps between two segments that have no root, m."""
    if not 0 < index < len(scene.segments):
        return ()
    low, high = scene.segments[index - 1 : index + 1]
    rooted = {corner.surface for corner in corners if corner.root}
    out = []
    for surface in SURFACES:
        radii = radii_of(low, surface)[1], radii_of(high, surface)[0]
        if surface not in rooted and abs(radii[0] - radii[1]) > TOUCH:
            out.append(min(radii) if surface == "outer" else max(radii))
    return tuple(out)


def _set_size(joint: Joint, zone: Zone, grading: Grading, ends, marks) -> None:
    """Set rows and depths of one side of a joint."""
    k = grading.along_corner
    corners = [c for c in joint.corners if c.face_side == zone.side]
    rims, roots = ([c for c in corners if c.root is root] for root in (False, True))
    zone.skip = max((c.axial for c in joint.corners if c.root and c.side == zone.side), default=0.0)
    if rims:
        zone.rows = 2 * k
    else:
        zone.rows = k if roots else 0
    zone.knots = [(c.r, c.axial) for c in rims]
    if not roots:
        return
    end = ends[joint.index + zone.side]
    room = MOST_OF_WAY * abs(end - joint.y)
    clear = max([zone.skip * 1.5, *(c.axial for c in rims)], default=0.0)
    away = [zone.side * (mark.y - joint.y) for mark in marks]
    room = min([room, *(d for d in away if d > clear - TOUCH and d > TOUCH)])
    depth = min(room, DEPTH * max(c.axial for c in roots))
    depth = max(depth, clear)
    zone.knots += [(c.r, depth) for c in roots]


def rounded_layers(
    outline: Outline,
    joint: int,
    surfaces: Sequence[Surface],
    layers: int,
    reach: float,
    ratio: float,
) -> int:
    """Return the geometric layers towards the edges of some surfaces at a joint with fillets or
    chamfers, where a right-angled shoulder gets `layers`; they begin at `reach`, m, and have a
    ratio to the one before.
    """
    edges = [edge for edge in outline.edges_at(joint) if edge.surface in surfaces]
    roots = [edge.root for edge in edges if edge.root]
    if not roots:
        return corner_layers(outline, joint, layers)
    needed = [corner_layers(outline, joint, layers, [edge for edge in edges if not edge.root])]
    for root in roots:
        if root.kind == "chamfer":
            needed.append(corner_layers(outline, joint, layers))
        else:
            size = GROWTH * DEPTH * min(root.axial, root.radial)
            wanted = int(np.ceil(np.log(max(reach / size, 1.0)) / -np.log(ratio) - 1e-9))
            needed.append(min(layers, max(1, wanted)))
    return max(needed)


def lines_along(
    scene: Shaft, grading: Grading, marks: Sequence[Mark], joints: Sequence[Joint]
) -> np.ndarray:
    """Return mesh lines along the shaft, with the rows of blocks on either side of joints.

    Where a fillet only runs into the space between two marks, the line of the joint takes the place
    of the first one beyond it.
    """
    places = _beside_blocks(scene, grading, marks, joints)
    stretches = [np.array([0.0])]
    for (a, start), (b, end) in zip(places, places[1:]):
        after, before = start.high if start else Zone(1), end.low if end else Zone(-1)
        length = b.y - a.y - after.reach - before.reach
        lines = a.y + after.reach + lines_between(scene, grading, a, b, length)
        if after.reach:
            lines = np.concatenate([np.linspace(a.y, lines[0], after.rows + 1), lines[1:]])
        if before.reach:
            last = np.linspace(lines[-1], b.y, before.rows + 1) if before.rows else [b.y]
            lines = np.concatenate([lines[:-1], last])
        stretches.append(lines[1:])
    return np.concatenate(stretches)


def _beside_blocks(
    scene: Shaft, grading: Grading, marks: Sequence[Mark], joints: Sequence[Joint]
) -> list[tuple[Mark, Joint | None]]:
    """Return marks with the joints they stand for, without those that fall into a block: a line
    that ends there ends at the block.
    """
    out: list[tuple[Mark, Joint | None]] = []
    for mark in marks:
        joint = next((j for j in joints if abs(j.y - mark.y) <= TOUCH), None)
        if joint:
            out.append((Mark(mark.y, _layers(scene, grading, joint.index)), joint))
            continue
        near = [j for j in joints if -j.low.reach - TOUCH <= mark.y - j.y <= j.high.reach + TOUCH]
        if not near:
            out.append((mark, None))
        elif mark.layers and not any(
            c.surface == "outer" and abs(c.on_cylinder[1] - mark.y) <= TOUCH
            for j in near
            for c in j.corners
        ):
            raise SolidgearError(
                f"a seat ends or is held at y = {mark.y:.6g} m, inside the cells of the "
                f'{near[0].corners[0].kind} "{near[0].corners[0].name}" at {near[0].y:.6g} m; '
                "move one of them"
            )
    return out


def _layers(scene: Shaft, grading: Grading, joint: int) -> int:
    """Return the layers along the shaft towards a joint with fillets or chamfers."""
    if not 0 < joint < len(scene.segments):
        return 0
    reach = grading.reach * joint_length(scene.segments, joint - 1)
    return rounded_layers(scene.outline, joint, SURFACES, grading.layers, reach, grading.ratio)
