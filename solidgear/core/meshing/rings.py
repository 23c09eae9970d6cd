"""Ring lines of a meridian: the division of every radial band.

Bands are graded towards the surfaces that carry singular points. In a disc that is thinner than a
band is high, cells along the band bend as a plate does, and near its free faces as the edge of one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial, reduce
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from solidgear.core.meshing.bands import Bands, first_of_run
from solidgear.core.meshing.grading import (
    Grading,
    corner_length,
    graded,
    joint_length,
    segments_under,
)
from solidgear.core.scene.corner import Surface

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Segment
    from solidgear.core.scene.shaft import Shaft

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
    near, far = (min(sizes) for sizes in zip(*(grading.cell(segments[k]) for k in run.segments)))
    thick = sum(segments[k].length for k in run.segments)
    if thick < thickness and not grading.plain:
        longest = max(thick, PLATE_CELL * max(_outermost(segments[k]) for k in run.segments))
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


def _outermost(segment) -> float:
    return max(segment.outer0, segment.outer1)


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
        for i in segments_under(station, segments):
            edge = min(grading.edge, grading.across)
            reach = grading.radial_reach * corner_length(segments[i])
            add(bands[i][1], i, (grading.across if is_rigid else edge) + narrow, reach)
            if "section" in ties:  # whose plane ends in a ring of the bore as well
                add(bands[i][0], i, edge, reach)
    return needs
