"""Layout of the mesh lines of a shaft of revolution.

Stress is singular at every shoulder and at every edge of a seat, so structured meshes are graded
geometrically towards all of them, axially and radially. A refinement ``s`` multiplies the number of
cells of a fixed density, so that meshes with different ``s`` are similar.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from solidgear.meshing.bands import Bands, first_of_run, radial_bands
from solidgear.meshing.blocks import Joint, joints_of, lines_along, rounded_layers
from solidgear.meshing.grading import Grading, joint_length
from solidgear.meshing.marks import marks_of, owners_of
from solidgear.meshing.rings import needs_of, ring_lines, runs_of
from solidgear.meshing.strips import SIDES, Strips, split_bands, strip_of
from solidgear.scene.outline import SURFACES

if TYPE_CHECKING:
    from solidgear.scene.shaft import Shaft


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
    #: places with fillets or chamfers, whose blocks of cells :mod:`solidgear.meshing.blended` puts
    #: in
    joints: tuple[Joint, ...] = ()

    def radii(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Radii of all band boundaries of a segment at one place of its span y0 to y1, from the
        inside, m.
        """
        t = (y - span[0]) / (span[1] - span[0])
        return (1 - t) * self.left[segment] + t * self.right[segment]

    def divided(self, segment: int) -> list[np.ndarray]:
        """Subdivision of every band of a segment from the inside, each from 0 to 1."""
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
        """Numbers of a segment's ring lines from the inside, the same as its neighbours' where they
        share a band.
        """
        lowest = self.bands[segment][0]
        parts = [
            self._offsets[lowest + k] + np.arange(len(lines) - 1)
            for k, lines in enumerate(self.divided(segment))
        ]
        return np.concatenate([*parts, [self._offsets[self.bands[segment][1]]]])

    def rings(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Radii of all ring lines of a segment at one place of its span y0 to y1, from its bore or
        the axis outwards, m.
        """
        b = self.radii(segment, span, y)
        parts = [
            b[k] + lines[1:] * (b[k + 1] - b[k]) for k, lines in enumerate(self.divided(segment))
        ]
        return np.concatenate([b[:1], *parts])


def layout(scene: Shaft, grading: Grading, attachments: tuple[str, ...] | None = None) -> Layout:
    """Lay out bands and mesh lines for a scene.

    Parameters
    ----------
    attachments : tuple of str, optional
        Attachments every station will be built with; by default those of the scene. Planes of
        section ties are lines of the mesh and graded, ends of rigid seats are graded like
        shoulders.

    Raises
    ------
    SolidgearError
        If a seat ends among the cells of a fillet or chamfer.

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
