r"""Contact cells of a spiral bevel pair.

The pinion of a pair that drives turns against the force on it, so that the position of contact line k
at the time ``phase``, in pitches, is the crown's turn ``phi = -turn (phase + k) pitch``: line k + 1 is
a pitch ahead, nearer to the tip of the pinion, and belongs to its tooth k + 1 and to the tooth -k - 1 of
the gear, each counted towards the side of its loaded flank.  In the wheel's frame of
:mod:`solidgear.core.gears.wheel` this is clockwise, whatever the hand.

A line is cut at the slices of the face and where the tips of pinion and gear end it; the cells at its
ends are shorter, so that they come and go without a jump, and count as corners, whose pressure means
nothing.  Teeth give way like those of the virtual spur
wheels of the normal section at the middle of the face.  All lengths of a section grow with the distance
from the apex alike, and what plane teeth give way by per unit width does not depend on their size: a
place on a tooth is taken to the middle of the face along a ray to the apex.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, cos, floor, sin

import numpy as np

from solidgear.core.gears.wheel import Wheel
from solidgear.teeth.bevel.flank import BevelFlanks
from solidgear.teeth.compliance.flank import FlankCompliance
from solidgear.teeth.contact.cells import Cells
from solidgear.teeth.contact.local import LineContact

#: least share of a slice that a contact line crosses
SLIVER = 1e-3
#: relative error of the distance from the apex at which a line reaches it
REACHED = 1e-9


@dataclass(frozen=True, eq=False)
class BevelCells(Cells):
    """Cells of a bevel pair, in the pinion's frame with its origin in the apex."""

    lift: np.ndarray  #: (2, n) heights above both pitch cones, at the middle of the face, m


@dataclass(frozen=True, eq=False)
class BevelPair:
    """Flanks of a bevel pair and the compliance of their teeth."""

    flanks: BevelFlanks
    compliances: tuple[FlankCompliance, FlankCompliance]  #: of `wheels`
    law: LineContact
    slices: int = 24

    @property
    def wheels(self) -> tuple[Wheel, Wheel]:
        """Virtual spur wheels of the normal section, as wide as a tooth is long."""
        blank = self.flanks.blank
        return blank.virtual_wheels(blank.face / cos(blank.spiral_angle))

    @property
    def base(self) -> float:
        """Lever of the normal at the mean point about the pinion's axis, m."""
        blank = self.flanks.blank
        radius = blank.mean_distance * sin(blank.pitch_angles[0])
        return radius * cos(blank.pressure_angle) * cos(blank.spiral_angle)

    def cells(self, phase: float) -> BevelCells:
        """Return the cells of all contact lines at a position in pitches."""
        flanks, blank = self.flanks, self.flanks.blank
        edges = np.linspace(blank.toe_distance, blank.heel_distance, self.slices + 1)
        numbers = np.array(self._lines(phase))
        rolls = -flanks.turn * (phase + numbers) * flanks.pitch
        ends = flanks.line(edges, rolls[:, None])
        start, stop = _shares(flanks.room(ends))
        reached = np.abs(ends.distance / edges - 1) < REACHED
        crossed = (stop - start > SLIVER) & reached[:, :-1] & reached[:, 1:]
        row, piece = np.nonzero(crossed)
        start, stop = start[row, piece], stop[row, piece]
        first, last = ends.place[row, piece], ends.place[row, piece + 1]
        points = flanks.points(first + (start + stop) / 2 * (last - first), rolls[row])
        return BevelCells(
            line=numbers[row],
            length=np.abs(stop - start) * np.abs(last - first) * points.stretch,
            radius=points.radius,
            gap=flanks.gap(points),
            lever=flanks.turn * points.lever,
            point=points.point @ flanks.pinion_frame.T,
            normal=points.normal @ flanks.pinion_frame.T,
            slice=piece,
            place=points.lift[0],
            z=points.distance - blank.mean_distance,
            at_corner=(stop - start < 1) | (piece == 0) | (piece == self.slices - 1),
            lean=np.full(len(row), np.nan),
            lift=points.lift,
        )

    def _lines(self, phase: float) -> range:
        """Return the numbers of the lines that may lie on the flanks."""
        ends = sorted(-self.flanks.turn * roll / self.flanks.pitch for roll in self.flanks.rolls)
        return range(floor(ends[0] - phase), ceil(ends[1] - phase) + 1)

    def bulk(self, cells: Cells) -> np.ndarray:
        """Return the (n, n) compliance of the teeth of both wheels between cells, m/N."""
        assert isinstance(cells, BevelCells)
        along = cells.z / cos(self.flanks.blank.spiral_angle)
        out = np.zeros((len(along), len(along)))
        for compliance, wheel, lift, sense in zip(
            self.compliances, self.wheels, cells.lift, (1, -1)
        ):
            out += compliance.matrix(sense * cells.line, wheel.radius + lift, along)
        return out


def _shares(room: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return where in every slice a line begins and ends to lie on the flanks, as shares of the slice,
    from the (2, lines, edges) room at the slices' edges.
    """
    before, after = room[..., :-1], room[..., 1:]
    span = np.where(before == after, 1.0, before - after)
    crossing = np.clip(before / span, 0.0, 1.0)
    start = np.where(before < 0, np.where(after > 0, crossing, 1.0), 0.0)
    stop = np.where(after < 0, np.where(before > 0, crossing, 0.0), 1.0)
    return start.max(axis=0), stop.min(axis=0)
