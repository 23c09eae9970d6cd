"""Blocks of cells at edges that have a fillet or a chamfer, on the two sides of a joint and on the
two sides of a band.

Next to such an edge a mesh has a block of as many rows as rings.  What becomes of it is in
:mod:`solidgear.meshing.blended`; here it is found how large it is.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from solidgear.meshing.bands import first_of_run
from solidgear.meshing.corners import corner_layers
from solidgear.meshing.grading import Grading
from solidgear.scene.blends import Corner
from solidgear.scene.outline import TOUCH

#: how deep into the material the block at a root reaches, in sizes of the fillet
DEPTH = 1.0
#: and of a band, and of the way to the next end of a segment, at most
MOST_OF_BAND, MOST_OF_WAY = 0.3, 0.3
#: the last layer towards a fillet begins this far from its block, in sizes of the block
GROWTH = 1.0


@dataclass
class Zone:
    """Rows of blocks on one side of a joint.

    Attributes
    ----------
    side : int
        -1 where y is smaller than at the joint, +1 where it is larger.
    rows : int
        0 where there is no block.
    skip : float
        Axial extent of fillets that run into this side from the face of the other, m.
    knots : list of (radius, depth)
        How far the zone reaches at some radii, m.
    """

    side: int
    rows: int = 0
    skip: float = 0.0
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
        """Depths at some radii, m."""
        return np.interp(r, *np.array(sorted(self.knots)).T)


@dataclass
class Joint:
    """A place where segments meet, or an end face, with the edges that have fillets or chamfers.

    Attributes
    ----------
    y : float
        m.
    index : int
        Number of the segment that begins here.
    corners : list of Corner
    low, high : Zone
    line : int
        Mesh line of the joint, once there is one.
    """

    y: float
    index: int
    corners: list[Corner]
    low: Zone = field(default_factory=lambda: Zone(-1))
    high: Zone = field(default_factory=lambda: Zone(1))
    line: int = -1

    def zone(self, side: int) -> Zone:
        """The zone of one side."""
        return self.low if side < 0 else self.high

    def thick(self, corner: Corner) -> int:
        """Segment that the block of an edge lies in."""
        low = self.block_side(corner) < 0
        return self.index - 1 if low else self.index

    @staticmethod
    def block_side(corner: Corner) -> int:
        """Side of the joint on which the block of an edge lies."""
        return -corner.side if corner.root else corner.side

    def cells(self, corner: Corner) -> int:
        """Rows of the block of an edge: of a root all there are in its zone."""
        return self.zone(self.block_side(corner)).rows

    def shift(self, r: np.ndarray) -> np.ndarray:
        """Distance of the line of the joint from it where both sides have material, m."""
        roots = sorted((c.r, c.side * c.axial) for c in self.corners if c.root)
        return np.interp(r, *np.array(roots).T) if roots else np.zeros(np.shape(r))


def joints_of(scene, grading: Grading, marks: Sequence[float]) -> list[Joint]:
    """Joints with fillets or chamfers, and how large the blocks are along the shaft.

    Parameters
    ----------
    scene : Scene
    grading : Grading
    marks : sequence of float
        Further places that must be lines of the mesh, m.
    """
    corners = scene.outline.corners
    ends = [0.0, *(s.y1 for s in scene.segments)]
    by_place = defaultdict(list)
    for corner in corners:
        by_place[min(range(len(ends)), key=lambda k: abs(ends[k] - corner.y))].append(corner)
    joints = [Joint(ends[k], k, by_place[k]) for k in sorted(by_place)]
    for joint in joints:
        for zone in (joint.low, joint.high):
            _size(joint, zone, grading, ends, marks)
    return joints


def _size(joint: Joint, zone: Zone, grading: Grading, ends, marks) -> None:
    """Rows and depths of one side of a joint."""
    k = grading.along_corner
    here = [c for c in joint.corners if joint.block_side(c) == zone.side]
    rims, roots = ([c for c in here if c.root is root] for root in (False, True))
    zone.skip = max((c.axial for c in joint.corners if c.root and c.side == zone.side), default=0.0)
    zone.rows = 2 * k if rims else k if roots else 0
    zone.knots = [(c.r, c.axial) for c in rims]
    if not roots:
        return
    end = ends[joint.index + zone.side]
    room = MOST_OF_WAY * abs(end - joint.y)
    clear = max([zone.skip * 1.5, *(c.axial for c in rims)], default=0.0)
    away = [zone.side * (y - joint.y) for y in marks]
    room = min([room, *(d for d in away if d > clear - TOUCH and d > TOUCH)])
    depth = min(room, DEPTH * max(c.axial for c in roots))
    depth = max(depth, clear)
    zone.knots += [(c.r, depth) for c in roots]


def layers_at(
    joint: Joint | None, a, b, surface: str, layers: int, reach: float, ratio: float
) -> int:
    """Geometric layers that a joint of two segments needs towards the edges of one surface, or of
    the worst of both.

    Parameters
    ----------
    joint : Joint or None
        None where no edge has a fillet.
    a, b : Segment
    surface : {'outer', 'bore', ''}
    layers : int
        What a right-angled shoulder gets.
    reach : float
        Where layers begin, m.
    ratio : float
        Of each to the one before.
    """
    roots = [c for c in joint.corners if c.root] if joint else []
    here = [c for c in roots if surface in ("", c.surface)]
    if not here:
        return corner_layers(a, b, layers)
    left = corner_layers(a, b, layers, tuple(c.surface for c in roots))
    found = [] if surface else [left]
    for c in here:
        if c.kind == "chamfer":
            found.append(corner_layers(a, b, layers))
        else:
            size = GROWTH * DEPTH * min(c.axial, c.radial)
            wanted = int(np.ceil(np.log(max(reach / size, 1.0)) / -np.log(ratio) - 1e-9))
            found.append(min(layers, max(1, wanted)))
    return max(found)


@dataclass(frozen=True)
class Strip:
    """Rings of blocks along one side of a band.

    Attributes
    ----------
    depth : float
        Where no rim says otherwise, m.
    cells : int
    """

    depth: float
    cells: int


def strips_of(joints, bands, left, right, raised, grading) -> dict[tuple[int, int, int], Strip]:
    """Rings of blocks: by band, first segment of the run of neighbours that have it, and side
    (1 outside, 0 inside).
    """
    found: dict[tuple[int, int, int], list[tuple[float, int]]] = defaultdict(list)
    for joint in joints:
        for c in joint.corners:
            lowest, end = bands[c.owner]
            band, side = (end - 1, 1) if c.surface == "outer" else (lowest, 0)
            first = first_of_run(bands, band, c.owner)
            depth = DEPTH * c.radial if c.root else c.radial
            found[band, first, side].append((depth, joint.cells(c)))
    out = {}
    for (band, first, side), wanted in found.items():
        room = min(_thicknesses(bands, left, right, band, first))
        depth = min(MOST_OF_BAND * room, max(d for d, _ in wanted))
        out[band, first, side] = Strip(depth, max(n for _, n in wanted))
    return out


def _thicknesses(bands, left, right, band, first):
    k = first
    while k < len(bands) and bands[k][0] <= band < bands[k][1]:
        i = band - bands[k][0]
        yield left[k][i + 1] - left[k][i]
        yield right[k][i + 1] - right[k][i]
        k += 1


def raised_by(joints) -> dict[tuple[int, str, str], float]:
    """Radii at which faces begin beyond a root, for :func:`solidgear.meshing.bands.radial_bands`,
    m.
    """
    out = {}
    for joint in joints:
        for c in joint.corners:
            if c.root:
                side = joint.block_side(c)
                end = "right" if side < 0 else "left"
                boundary = "high" if c.surface == "outer" else "low"
                out[joint.thick(c), end, boundary] = c.out * c.radial
    return out


def split_bands(joints, bands, left, right, raised, strips, fractions):
    """Bands with their strips as bands of their own.

    Returns
    -------
    bands, left, right, fractions
        As :class:`~solidgear.meshing.layout.Layout` holds them.
    """
    lowest, end = min(b[0] for b in bands), max(b[1] for b in bands)
    start, count = {}, 0
    sides = {
        band: [any((band, f, s) in strips for f in range(len(bands))) for s in (0, 1)]
        for band in range(lowest, end)
    }
    for band in range(lowest, end):
        start[band] = count
        count += 1 + sum(sides[band])
    start[end] = count
    new_left: list[np.ndarray] = []
    new_right: list[np.ndarray] = []
    for k, (low, high) in enumerate(bands):
        for ends, made, at in ((left, new_left, "left"), (right, new_right, "right")):
            radii = _inside_rims(joints, k, at, np.array(ends[k], float), bands, raised)
            found = [radii[0]]
            for band in range(low, high):
                first = first_of_run(bands, band, k)
                bottom, top = radii[band - low], radii[band - low + 1]
                inner, outer = sides[band]
                lifted = raised.get((k, at, "low"), 0.0) if inner else 0.0
                sunk = raised.get((k, at, "high"), 0.0) if outer else 0.0
                for side, there in ((0, inner), (1, outer)):
                    if not there:
                        continue
                    strip = strips.get((band, first, side))
                    if strip is None:
                        found.append(bottom if side == 0 else top)
                        continue
                    rim = (
                        _rim(joints, k, at, "bore" if side == 0 else "outer")
                        if (band == (low if side == 0 else high - 1))
                        else None
                    )
                    if side == 0:
                        own = _own(joints, k, at, "bore", band, bands)
                        found.append(bottom + rim if rim else bottom - lifted * own + strip.depth)
                    else:
                        own = _own(joints, k, at, "outer", band + 1, bands)
                        found.append(top - rim if rim else top - sunk * own - strip.depth)
                found.append(top)
            made.append(np.array(found))
    new_fractions = {}
    for (band, first), lines in fractions.items():
        inner, outer = sides[band]
        place = start[band]
        for side, there in ((0, inner), (1, outer)):
            strip = strips.get((band, first, side))
            cells = strip.cells if strip else 0
            if there:
                new_fractions[place + (0 if side == 0 else 1 + inner), first] = (
                    np.linspace(0, 1, cells + 1) if cells else np.zeros(1)
                )
        new_fractions[place + inner, first] = lines
    new_bands = tuple((start[low], start[high]) for low, high in bands)
    return new_bands, tuple(new_left), tuple(new_right), new_fractions


def _own(joints, segment, at, surface, boundary, bands) -> bool:
    """True where the boundary of a band is that of the root at this end of a segment."""
    for joint in joints:
        for c in joint.corners:
            if c.root and c.surface == surface and joint.thick(c) == segment:
                if (joint.block_side(c) < 0) == (at == "right"):
                    return bands[c.owner][1 if surface == "outer" else 0] == boundary
    return False


def _rim(joints, segment, at, surface) -> float | None:
    """Radial extent of the rim at this end of a segment, m."""
    for joint in joints:
        for c in joint.corners:
            if not c.root and c.owner == segment and c.surface == surface:
                if (c.side < 0) == (at == "right"):
                    return c.radial
    return None


def _inside_rims(joints, segment, at, radii, bands, raised):
    """Radii of the bands at an end of a segment, moved clear of its rims."""
    outer = _rim(joints, segment, at, "outer")
    inner = _rim(joints, segment, at, "bore")
    if outer is None and inner is None or len(radii) == 2:
        return radii
    neighbour = segment + (1 if at == "right" else -1)
    low, high = 0, len(radii) - 1
    if 0 <= neighbour < len(bands):
        # boundaries shared with the neighbour stay
        high = max(0, bands[neighbour][1] - bands[segment][0])
        low = max(0, bands[neighbour][0] - bands[segment][0])
        if outer is not None and high < len(radii) - 1:
            a, b = radii[high], radii[-1]
            radii[high:-1] = a + (radii[high:-1] - a) * (b - outer - a) / (b - a)
        if inner is not None and low > 0:
            a, b = radii[low], radii[0]
            radii[1 : low + 1] = a + (radii[1 : low + 1] - a) * (b + inner - a) / (b - a)
        return radii
    a, b = radii[0], radii[-1]
    inside = (radii[1:-1] - a) / (b - a)
    a, b = a + (inner or 0.0), b - (outer or 0.0)
    radii[1:-1] = a + inside * (b - a)
    return radii
