"""Layout of the mesh lines of a shaft of revolution, with strips of rings along bands at fillets
and chamfers.

Stress is singular at every shoulder and at every edge of a seat, so structured meshes are graded
geometrically towards all of them, axially and radially. A refinement ``s`` multiplies the number of
cells of a fixed density, so that meshes with different ``s`` are similar.

Ring lines of a meridian: the division of every radial band.

Bands are graded towards the surfaces that carry singular points. In a disc that is thinner than a
band is high, cells along the band bend as a plate does, and near its free faces as the edge of one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial, reduce
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from solidgear.core.meshing.bands import Bands, first_of_run, radial_bands
from solidgear.core.meshing.blocks import DEPTH, Joint, joints_of, lines_along, rounded_layers
from solidgear.core.meshing.grading import (
    Grading,
    corner_length,
    graded,
    joint_length,
    segments_under,
)
from solidgear.core.meshing.marks import marks_of, owners_of
from solidgear.core.scene.corner import SURFACES, Corner, Surface
from solidgear.core.scene.outline import Outline
from solidgear.core.scene.shaft import on_face

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Segment
    from solidgear.core.scene.shaft import Shaft


#: largest share of a band that a strip takes
MOST_OF_BAND = 0.3


class Strip(NamedTuple):
    """Rings of blocks along one side of a band."""

    depth: float  #: m, where no rim says otherwise
    cells: int


#: strips by band, first segment of a run, and the side of the band
Strips = dict[tuple[int, int, Surface], Strip]
#: sides of a band, from the inside
SIDES: tuple[Surface, Surface] = (SURFACES[1], SURFACES[0])


@dataclass(frozen=True)
class Layout:
    """Structured layout of the meridian."""

    y: np.ndarray  #: (ny + 1,) axial mesh lines, m
    segment: np.ndarray  #: (ny,) segment of each axial cell
    bands: Bands  #: radial bands a segment occupies, as indices into ``fractions``
    #: left, right: radii of the band boundaries ``lowest .. end`` at the two ends of the segment,
    #: m.
    left: tuple[np.ndarray, ...]
    right: tuple[np.ndarray, ...]
    #: subdivision of each band, 0 to 1 outwards, for every run of neighbours that have the band: a
    #: flange does not pass its rings on to a seat at the other end of the shaft
    fractions: dict[tuple[int, int], np.ndarray]
    #: places with fillets or chamfers, whose blocks of cells :mod:`solidgear.core.meshing.blended` puts
    #: in
    joints: tuple[Joint, ...] = ()

    def radii(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Return radii of all band boundaries of a segment at one place of the span y0 to y1, from
        the inside, m.
        """
        t = (y - span[0]) / (span[1] - span[0])
        return (1 - t) * self.left[segment] + t * self.right[segment]

    def divided(self, segment: int) -> list[np.ndarray]:
        """Return the subdivision of every band of a segment from the inside, each from 0 to 1."""
        lowest, end = self.bands[segment]
        return [
            self.fractions[band, first_of_run(self.bands, band, segment)]
            for band in range(lowest, end)
        ]

    @cached_property
    def _offsets(self) -> dict[int, int]:
        """Number of the innermost ring line of every band; bands count outwards through the whole
        shaft.
        """
        widest: dict[int, int] = {}
        for (band, _), lines in self.fractions.items():
            widest[band] = max(widest.get(band, 0), len(lines) - 1)
        out, count = {}, 0
        for band in sorted(widest):
            out[band] = count
            count += widest[band]
        out[max(widest) + 1] = count
        return out

    @property
    def ring_lines(self) -> int:
        """Number of ring lines: every one of :meth:`ring_numbers` is below it."""
        return max(self._offsets.values()) + 1

    @property
    def cells(self) -> int:
        """Number of cells, but for those at fillets and chamfers."""
        return sum(len(self.ring_numbers(k)) - 1 for k in self.segment)

    def ring_numbers(self, segment: int) -> np.ndarray:
        """Return the numbers of a segment's ring lines from the inside, the same as its neighbours'
        where they share a band.
        """
        lowest = self.bands[segment][0]
        parts = [
            self._offsets[lowest + k] + np.arange(len(lines) - 1)
            for k, lines in enumerate(self.divided(segment))
        ]
        return np.concatenate([*parts, [self._offsets[self.bands[segment][1]]]])

    def rings(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Return radii of all ring lines of a segment at one place of its span y0 to y1, from its
        bore or the axis outwards, m.
        """
        b = self.radii(segment, span, y)
        parts = [
            b[k] + lines[1:] * (b[k + 1] - b[k]) for k, lines in enumerate(self.divided(segment))
        ]
        return np.concatenate([b[:1], *parts])


def layout(scene: Shaft, grading: Grading, attachments: tuple[str, ...] | None = None) -> Layout:
    """Lay out bands and mesh lines for a scene; SolidgearError if a seat ends among the cells of a
    fillet or chamfer.

    `attachments` are those that every station will be built with; by default those of the scene.
    Planes of section ties are lines of the mesh and graded, ends of rigid seats are graded like
    shoulders.

    Examples
    --------
    Every shoulder is a line of the mesh:

    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> plan = layout(scene, Grading(layers=2))
    >>> all(np.abs(plan.y - step).min() < 1e-12 for step in scene.steps)
    True
    """
    segments, outline = scene.segments, scene.outline
    marks = marks_of(scene, grading, attachments)
    joints = joints_of(scene, grading, marks)
    y = lines_along(scene, grading, marks, joints)
    for joint in joints:
        joint.line = int(np.abs(y - joint.y).argmin())
    bands, left, right = radial_bands(outline)
    corners = {}
    for k in range(1, len(segments)):
        reach = grading.radial_reach * joint_length(segments, k - 1)
        for surface in SURFACES:
            corners[k, surface] = rounded_layers(
                outline, k, [surface], grading.across, reach, grading.ratio
            )
    needs = needs_of(scene, grading, attachments, bands, corners)
    strips: Strips = {}
    fractions = {}
    for run in runs_of(bands, left, right):
        thickness = max(run.thicknesses)
        for surface in SIDES:
            strip = strip_of(joints, bands, run, surface)
            if strip:
                strips[(*run.key, surface)] = strip
                thickness -= strip.depth
        fractions[run.key] = ring_lines(segments, grading, run, needs, thickness)
    if strips:
        bands, left, right, fractions = split_bands(outline, bands, left, right, strips, fractions)
    return Layout(y, owners_of(y, segments), bands, left, right, fractions, tuple(joints))


def strip_of(joints: Sequence[Joint], bands: Bands, run: Run, surface: Surface) -> Strip | None:
    """Return the strip along one side of a band; None where no fillet or chamfer lies on it."""
    wanted = [
        (DEPTH * c.radial if c.root else c.radial, joint.cells(c))
        for joint in joints
        for c in joint.corners
        if c.surface == surface
        and c.owner in run.segments
        and run.band == _band_at(bands, c.owner, surface)
    ]
    if not wanted:
        return None
    depth = min(MOST_OF_BAND * min(run.thicknesses), max(d for d, _ in wanted))
    return Strip(depth, max(n for _, n in wanted))


def _band_at(bands: Bands, segment: int, surface: Surface) -> int:
    """Return the band of a segment that lies at one surface."""
    lowest, end = bands[segment]
    return lowest if surface == "bore" else end - 1


def split_bands(
    outline: Outline,
    bands: Bands,
    left: Radii,
    right: Radii,
    strips: Strips,
    fractions: Mapping[tuple[int, int], np.ndarray],
) -> tuple:
    """Return bands, left, right and fractions with strips as bands of their own."""
    lowest, end = min(b[0] for b in bands), max(b[1] for b in bands)
    sides = {
        band: [s for s in SIDES if any((band, k, s) in strips for k in range(len(bands)))]
        for band in range(lowest, end)
    }
    start, count = {}, 0
    for band in range(lowest, end):
        start[band] = count
        count += 1 + len(sides[band])
    start[end] = count
    new_left, new_right = (
        tuple(
            _with_strips(outline, k, side, np.array(radii[k], float), bands, strips, sides)
            for k in range(len(bands))
        )
        for side, radii in ((1, left), (-1, right))
    )
    new_fractions = {}
    for (band, first), lines in fractions.items():
        place = start[band] + ("bore" in sides[band])
        new_fractions[place, first] = lines
        for surface in sides[band]:
            strip = strips.get((band, first, surface))
            strip_place = place + (1 if surface == "outer" else -1)
            new_fractions[strip_place, first] = (
                np.linspace(0, 1, strip.cells + 1) if strip else np.zeros(1)
            )
    new_bands = tuple((start[low], start[high]) for low, high in bands)
    return new_bands, new_left, new_right, new_fractions


def _with_strips(
    outline: Outline,
    segment: int,
    side: int,
    radii: np.ndarray,
    bands: Bands,
    strips: Strips,
    sides: Mapping[int, Sequence[Surface]],
) -> np.ndarray:
    """Return radii of the boundaries at the start (side 1) or end (-1) of a segment with those of
    strips.
    """
    rims = {surface: outline.rim(segment, surface, side) for surface in SIDES}
    _clear_of_rims(segment, side, radii, bands, rims)
    roots = {}
    for surface in SIDES:
        root = outline.root(segment + (side < 0), surface)
        if root and root.face_owner == segment:
            roots[surface, _band_at(bands, root.owner, surface)] = root
    low, high = bands[segment]
    out = [radii[0]]
    for band in range(low, high):
        for surface in sides[band]:
            base = radii[band - low + (surface == "outer")]
            inwards = 1 if surface == "bore" else -1
            rim, root = rims[surface], roots.get((surface, band))
            strip = strips.get((band, first_of_run(bands, band, segment), surface))
            if strip and rim and band == _band_at(bands, segment, surface):
                base = base + inwards * rim.radial
            elif strip:
                raised = root.out * root.radial if root else 0.0
                base = base - raised + inwards * strip.depth
            out.append(base)
        out.append(radii[band - low + 1])
    return np.array(out)


def _clear_of_rims(
    segment: int,
    side: int,
    radii: np.ndarray,
    bands: Bands,
    rims: Mapping[Surface, Corner | None],
) -> None:
    """Move radii of the bands at an end of a segment clear of the rims."""
    inner, outer = (rim.radial if rim else 0.0 for rim in rims.values())
    if not (outer or inner) or len(radii) == 2:
        return
    neighbour = segment - side
    if 0 <= neighbour < len(bands):
        # boundaries shared with the neighbour stay
        high = max(0, bands[neighbour][1] - bands[segment][0])
        low = max(0, bands[neighbour][0] - bands[segment][0])
        if outer and high < len(radii) - 1:
            a, b = radii[high], radii[-1]
            radii[high:-1] = a + (radii[high:-1] - a) * (b - outer - a) / (b - a)
        if inner and low > 0:
            a, b = radii[low], radii[0]
            radii[1 : low + 1] = a + (radii[1 : low + 1] - a) * (b + inner - a) / (b - a)
        return
    a, b = radii[0], radii[-1]
    inside = (radii[1:-1] - a) / (b - a)
    a, b = a + inner, b - outer
    radii[1:-1] = a + inside * (b - a)


#: longest cell of a plate, in its outer radii. With one cell from the axis to the rim the second mesh
#: of a plate of 0.01 diameters was 1e-2 off in bending 1, with three 1e-4; in thicker ones cells as
#: long as they are thick do
PLATE_CELL = 0.35
#: where the layer towards a free edge of a plate begins, in thicknesses: a twisting moment ends there
#: within one. Without it bending 1 of a ring plate was 1e-3 off on the fourth mesh, with it 1e-7
FREE_EDGE = 1.0

#: layers towards a boundary of a band, and where they begin, m
Need = tuple[int, float]
#: needs by boundary and segment
Needs = dict[tuple[int, int], Need]
#: radii of the boundaries of every segment at one of its ends, m
Radii = Sequence[np.ndarray]


class Run(NamedTuple):
    """Neighbouring segments that have a band, without a gap between them."""

    band: int
    segments: tuple[int, ...]
    thicknesses: tuple[float, ...]  #: of the band at both ends of each segment, m
    on_axis: bool

    @property
    def key(self) -> tuple[int, int]:
        """Band and first segment."""
        return self.band, self.segments[0]


def runs_of(bands: Bands, left: Radii, right: Radii) -> Iterator[Run]:
    """Yield all runs, band by band; radii of the boundaries are those at the two ends of every
    segment.
    """
    for band in range(min(b[0] for b in bands), max(b[1] for b in bands)):
        having = [k for k, b in enumerate(bands) if b[0] <= band < b[1]]
        first_of = {k: first_of_run(bands, band, k) for k in having}
        for first in sorted(set(first_of.values())):
            run = tuple(k for k in having if first_of[k] == first)
            place = [(k, band - bands[k][0]) for k in run]
            ends = [(end[k][i], end[k][i + 1]) for k, i in place for end in (left, right)]
            solid = any(i == 0 and left[k][0] == right[k][0] == 0.0 for k, i in place)
            yield Run(band, run, tuple(float(b - a) for a, b in ends), solid)


def ring_lines(
    segments: Sequence[Segment], grading: Grading, run: Run, needs: Needs, thickness: float
) -> np.ndarray:
    """Return the subdivision of a band, 0 to 1 outwards, graded towards the surfaces that carry
    singular points; `thickness` is in m, and segments are all of the shaft.
    """
    inside, outside = (
        reduce(
            partial(_finer, ratio=grading.ratio),
            (needs.get((boundary, k), (0, thickness)) for k in run.segments),
        )
        for boundary in (run.band, run.band + 1)
    )
    # the lines of a cone run from its thin end to its thick one, where they lie furthest apart
    cells = (grading.cell(segments[k], across=True) for k in run.segments)
    near, far = (min(sizes) for sizes in zip(*cells))
    thick = sum(segments[k].length for k in run.segments)
    if thick < thickness and not grading.plain:
        longest = max(
            thick,
            PLATE_CELL * max(max(segments[k].outer0, segments[k].outer1) for k in run.segments),
        )
        near, far = min(near, longest), min(far, longest)
        edge = min(1, grading.across), min(FREE_EDGE * thick, grading.reach * thickness)
        inside, outside = (need if need[0] else edge for need in (inside, outside))
    low, high = 0 if run.on_axis else inside[0], outside[0]
    reach = (inside[1], outside[1])
    both_sides = not (run.on_axis and grading.core)
    part = thickness if both_sides else thickness / 2
    lines = graded(part, (near, far), grading.ratio, reach, grading.refinement, low, high)
    lines = lines if both_sides else np.concatenate([[0.0], part + lines])
    return lines / thickness


def _finer(a: Need, b: Need, ratio: float) -> Need:
    """Return the need with more layers; of as many, the one that begins further out, unless the
    other begins more than a layer nearer.
    """
    if a[0] != b[0]:
        return max(a, b)
    near, far = sorted((a, b))
    return near if near[1] < ratio * far[1] else far


def needs_of(
    scene: Shaft,
    grading: Grading,
    attachments: tuple[str, ...] | None,
    bands: Bands,
    corners: Mapping[tuple[int, Surface], int],
) -> Needs:
    """Return layers and reach (m) that a band boundary needs in a segment; `corners` are layers
    towards those of the outline, by joint and surface.
    """
    segments = scene.segments
    needs: Needs = {}

    def add(boundary: int, segment: int, layers: int, reach: float) -> None:
        if layers:
            before = needs.get((boundary, segment), (0, 0.0))
            needs[boundary, segment] = _finer(before, (layers, reach), grading.ratio)

    for (joint, surface), layers in corners.items():
        reach = grading.radial_reach * joint_length(segments, joint - 1)
        (low, high), (next_low, next_high) = bands[joint - 1 : joint + 1]
        # A band boundary meets a shoulder where it is the surface of the smaller neighbour.
        boundary = min(high, next_high) if surface == "outer" else max(low, next_low)
        for k in (joint - 1, joint):
            add(boundary, k, layers, reach)
    for station in scene.stations:
        ties = attachments or (station.attachment,)
        is_rigid, narrow = "rigid" in ties, grading.seat_layers(station, segments, ties)
        edge = min(grading.edge, grading.across)
        layers = grading.across if is_rigid else edge
        for i in segments_under(station, segments):
            reach = grading.radial_reach * corner_length(segments[i])
            add(bands[i][1], i, layers + narrow, reach)
            if on_face(station):  # which ends in a ring of the bore as well, as sections do
                add(bands[i][0], i, layers, reach)
            elif "section" in ties:
                add(bands[i][0], i, edge, reach)
    return needs
