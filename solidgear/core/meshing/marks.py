"""Places along a shaft that must be lines of its mesh, and the lines between them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from solidgear.core.meshing.corners import corner_layers
from solidgear.core.meshing.grading import Grading, corner_length, distinct, graded, joint_length

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft

#: two places that are nearer to each other than this share of the length are one
SAME_PLACE = 1e-9


class Mark(NamedTuple):
    """A place (m) that must be a line of the mesh, and the layers it needs on either side."""

    y: float
    layers: int


def marks_of(scene: Shaft, grading: Grading, attachments: tuple[str, ...] | None) -> list[Mark]:
    """Return the ends, segment boundaries, seat ends and section planes; where several coincide the
    strongest counts.
    """
    segments, tol = scene.segments, SAME_PLACE * scene.length
    weight: dict[float, int] = {s.y0: 0 for s in segments} | {segments[-1].y1: 0}

    def add(y: float, layers: int) -> None:
        weight[y] = max(weight.get(y, 0), layers)

    for station in scene.stations:
        ties = attachments or (station.attachment,)
        is_rigid = "rigid" in ties
        narrow = grading.seat_layers(station, segments, ties)
        # A seat that ends at a face needs its layers too: the shear that it carries, along the axis
        # or in tilting, ends in a corner whose other side is free of it.
        for y in (station.lo, station.hi):
            add(y, (grading.layers if is_rigid else grading.edge) + narrow)
        planes = "section" in ties and tol < station.y < scene.length - tol
        add(station.y, max(grading.edge, grading.layers - 1) if planes else 0)
    for joint in range(1, len(segments)):
        add(segments[joint].y0, corner_layers(scene.outline, joint, grading.layers))
    marks = []
    for mark in distinct(sorted(weight), tol):
        coinciding = [layers for y, layers in weight.items() if abs(y - mark) <= tol]
        marks.append(Mark(mark, max(coinciding)))
    return marks


def lines_between(scene: Shaft, grading: Grading, a: Mark, b: Mark, length: float) -> np.ndarray:
    """Return lines from 0 to a length (m), graded towards the two marks beside it."""
    tol = SAME_PLACE * scene.length
    owner = next(s for s in scene.segments if (a.y + b.y) / 2 < s.y1 + tol)
    return graded(
        length,
        grading.cell(owner),
        grading.ratio,
        [grading.reach * _length_at(mark.y, scene.segments, tol) for mark in (a, b)],
        grading.refinement,
        a.layers,
        b.layers,
    )


def owners_of(lines: np.ndarray, segments: Sequence) -> np.ndarray:
    """Return the segment of every cell between two lines."""
    middle = (lines[1:] + lines[:-1]) / 2
    return np.minimum(np.searchsorted([s.y1 for s in segments], middle), len(segments) - 1)


def _length_at(y: float, segments: Sequence, tol: float) -> float:
    """Return the length (m) over which stress at a place is singular: of the joint there, or of the
    segment.
    """
    near = [k for k, s in enumerate(segments) if s.y0 < y + tol and y < s.y1 + tol]
    if len(near) > 1:
        return min(joint_length(segments, k) for k in near[:-1])
    return corner_length(segments[near[0]])
