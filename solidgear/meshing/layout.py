"""Layout of the mesh lines of a shaft of revolution.

Stress is singular at every shoulder and at every edge of a seat, so structured meshes are graded
geometrically towards all of them, axially and radially. A refinement ``s`` multiplies the number of
cells of a fixed density, so that meshes with different ``s`` are similar.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.meshing.bands import first_of_run, radial_bands
from solidgear.meshing.blocks import (
    Joint,
    joints_of,
    layers_at,
    raised_by,
    split_bands,
    strips_of,
)
from solidgear.meshing.grading import Grading, corner_length, distinct, graded, joint_length
from solidgear.meshing.rings import fractions_of
from solidgear.scene.outline import TOUCH


@dataclass(frozen=True)
class Layout:
    """Structured layout of the meridian.

    Attributes
    ----------
    y : (ny + 1,) ndarray
        Axial mesh lines, m.
    segment : (ny,) ndarray of int
        Segment of each axial cell.
    bands : tuple of (lowest, end) per segment
        Radial bands a segment occupies, as indices into ``fractions``.
    left, right : tuple of ndarray per segment
        Radii of the band boundaries ``lowest .. end`` at the two ends of the segment, m.
    fractions : dict of (band index, first segment of a run) -> (m + 1,) ndarray
        Subdivision of each band, 0 to 1 outwards, for every run of neighbours that have the band: a
        flange does not pass its rings on to a seat at the other end of the shaft.
    joints : tuple of Joint
        Places with fillets or chamfers, whose blocks of cells
        :mod:`solidgear.meshing.blended` puts in.
    """

    y: np.ndarray
    segment: np.ndarray
    bands: tuple[tuple[int, int], ...]
    left: tuple[np.ndarray, ...]
    right: tuple[np.ndarray, ...]
    fractions: dict[tuple[int, int], np.ndarray]
    joints: tuple[Joint, ...] = ()

    def radii(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Radii of all band boundaries of a segment at one place.

        Parameters
        ----------
        segment : int
        span : (float, float)
            Its y0 and y1, m.
        y : float
            m.

        Returns
        -------
        (b + 1,) ndarray
            From the inside, m.
        """
        t = (y - span[0]) / (span[1] - span[0])
        return (1 - t) * self.left[segment] + t * self.right[segment]

    def divided(self, segment: int) -> list[np.ndarray]:
        """Subdivision of every band of a segment, from the inside.

        Parameters
        ----------
        segment : int

        Returns
        -------
        list of (m + 1,) ndarray
            Each from 0 to 1.
        """
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
        """Numbers of a segment's ring lines, the same as its neighbours' where they share a band.

        Parameters
        ----------
        segment : int

        Returns
        -------
        (r,) ndarray of int
            From the inside.
        """
        lowest = self.bands[segment][0]
        parts = [
            self._offsets[lowest + k] + np.arange(len(lines) - 1)
            for k, lines in enumerate(self.divided(segment))
        ]
        return np.concatenate([*parts, [self._offsets[self.bands[segment][1]]]])

    def rings(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Radii of all ring lines of a segment at one place.

        Parameters
        ----------
        segment : int
        span : (float, float)
            Its y0 and y1, m.
        y : float
            m.

        Returns
        -------
        (r,) ndarray
            From its bore (or the axis) outwards, m.
        """
        b = self.radii(segment, span, y)
        parts = [
            b[k] + lines[1:] * (b[k + 1] - b[k]) for k, lines in enumerate(self.divided(segment))
        ]
        return np.concatenate([b[:1], *parts])


def layout(scene, grading: Grading, attachments: tuple[str, ...] | None = None) -> Layout:
    """Lay out bands and mesh lines for a scene.

    Parameters
    ----------
    scene : Scene
    grading : Grading
    attachments : tuple of str, optional
        Attachments every station will be built with; by default those of the scene. Planes of
        section ties are lines of the mesh and graded, ends of rigid seats are graded like
        shoulders.

    Returns
    -------
    Layout

    Examples
    --------
    Every shoulder is a line of the mesh:

    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> plan = layout(scene, Grading(layers=2))
    >>> all(np.abs(plan.y - step).min() < 1e-12 for step in scene.steps)
    True
    """
    segments = scene.segments
    tol = 1e-9 * scene.length
    marks = _marks(scene, grading, attachments)
    joints = joints_of(scene, grading, [mark.y for mark in marks])
    raised = raised_by(joints)
    bands, left, right = radial_bands(segments, raised)
    marks = _beside_blocks(scene, grading, marks, joints)
    lines = [np.array([0.0])]
    for a, b in zip(marks, marks[1:]):
        owner = next(s for s in segments if (a.y + b.y) / 2 < s.y1 + tol)
        between = graded(
            b.y - a.y - a.after - b.before,
            grading.cell(owner),
            grading.ratio,
            [grading.reach * _length_at(mark.y, segments, tol) for mark in (a, b)],
            grading.refinement,
            a.layers,
            b.layers,
        )
        lines.append(_with_blocks(a, b, a.y + a.after + between)[1:])
    y = np.concatenate(lines)
    for joint in joints:
        joint.line = int(np.abs(y - joint.y).argmin())
    middle = (y[1:] + y[:-1]) / 2
    segment = np.minimum(np.searchsorted([s.y1 for s in segments], middle), len(segments) - 1)
    strips = strips_of(joints, bands, left, right, raised, grading)
    fractions = fractions_of(scene, grading, attachments, bands, left, right, joints, strips)
    if joints:
        bands, left, right, fractions = split_bands(
            joints, bands, left, right, raised, strips, fractions
        )
    return Layout(y, segment, bands, left, right, fractions, tuple(joints))


def _length_at(y: float, segments, tol: float) -> float:
    """Length (m) over which stress at a place is singular: of the joint there, or of the segment."""
    near = [k for k, s in enumerate(segments) if s.y0 < y + tol and y < s.y1 + tol]
    if len(near) > 1:
        return min(joint_length(segments, k) for k in near[:-1])
    return corner_length(segments[near[0]])


@dataclass(frozen=True)
class _Mark:
    """An axial place that must be a line of the mesh, and the layers it needs on either side."""

    y: float
    layers: int
    joint: Joint | None = None

    @property
    def before(self) -> float:
        """Room that blocks and fillets take before it, m."""
        return self.joint.low.reach if self.joint else 0.0

    @property
    def after(self) -> float:
        """And after it, m."""
        return self.joint.high.reach if self.joint else 0.0


def _beside_blocks(scene, grading: Grading, marks: list[_Mark], joints: list[Joint]) -> list[_Mark]:
    """Marks with the joints they stand for, without those that fall into a block: what ends there
    ends at the block.
    """
    if not joints:
        return marks
    out = []
    for mark in marks:
        joint = next((j for j in joints if abs(j.y - mark.y) <= TOUCH), None)
        if joint:
            out.append(_Mark(mark.y, _layers(scene, grading, joint), joint))
            continue
        near = [j for j in joints if -j.low.reach - TOUCH <= mark.y - j.y <= j.high.reach + TOUCH]
        if not near:
            out.append(mark)
        elif mark.layers and not any(
            c.surface == "outer" and abs(c.on_cylinder[1] - mark.y) <= TOUCH
            for j in near
            for c in j.corners
        ):
            raise SolidgearError(
                f"a seat ends or is held at y = {mark.y:.6g} m, among the cells of the "
                f'{near[0].corners[0].kind} "{near[0].corners[0].name}" at {near[0].y:.6g} m; '
                "move the one or the other"
            )
    return out


def _layers(scene, grading: Grading, joint: Joint) -> int:
    """Layers towards a joint with fillets or chamfers."""
    k = joint.index
    if not 0 < k < len(scene.segments):
        return 0
    a, b = scene.segments[k - 1 : k + 1]
    reach = grading.reach * joint_length(scene.segments, k - 1)
    return layers_at(joint, a, b, "", grading.layers, reach, grading.ratio)


def _with_blocks(a: _Mark, b: _Mark, lines: np.ndarray) -> np.ndarray:
    """Lines from one mark to the next with the rows of blocks beside them.

    Where a fillet only runs into the space between them, the line of the joint takes the place of
    the first one beyond it.
    """
    if a.joint and a.after:
        rows = a.joint.high.rows
        first = np.linspace(a.y, lines[0], rows + 1) if rows else np.array([a.y])
        lines = np.concatenate([first, lines[1:]])
    if b.joint and b.before:
        rows = b.joint.low.rows
        last = np.linspace(lines[-1], b.y, rows + 1) if rows else np.array([b.y])
        lines = np.concatenate([lines[:-1], last])
    return lines


def _marks(scene, grading: Grading, attachments) -> list[_Mark]:
    """Ends, segment boundaries, seat ends and section planes; where several coincide the strongest
    counts.
    """
    segments, tol = scene.segments, 1e-9 * scene.length
    weight: dict[float, int] = {s.y0: 0 for s in segments} | {segments[-1].y1: 0}

    def add(y: float, layers: int) -> None:
        weight[y] = max(weight.get(y, 0), layers)

    for station in scene.stations:
        ties = attachments or (station.attachment,)
        held = "rigid" in ties
        narrow = grading.seat_layers(station, segments, ties)
        # A seat that ends at a face needs its layers too: the shear that it carries, along the axis
        # or in tilting, ends in a corner whose other side is free of it.
        for y in (station.lo, station.hi):
            add(y, (grading.layers if held else grading.edge) + narrow)
        planes = "section" in ties and tol < station.y < scene.length - tol
        add(station.y, max(grading.edge, grading.layers - 1) if planes else 0)
    for a, b in zip(segments, segments[1:]):
        add(b.y0, layers_at(None, a, b, "", grading.layers, 1.0, grading.ratio))
    marks = []
    for mark in distinct(sorted(weight), tol):
        here = [layers for y, layers in weight.items() if abs(y - mark) <= tol]
        marks.append(_Mark(mark, max(here)))
    return marks
