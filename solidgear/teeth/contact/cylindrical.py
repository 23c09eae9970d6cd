r"""A pair of cylindrical wheels in contact: cells on the lines, gaps of modified flanks, and corners.

Frame of the pair: origin in the pitch point at the middle of the common face, u along the transverse
line of action, towards where the path ends, w along the axes, so that contact lines lie at larger u
for larger w, and v across both.  The first wheel is pushed along ``(-cos beta_b, 0, sin beta_b)``.

Under load teeth bend, and contact begins before and ends after the path, where the corner of a tip
touches the mate's flank.  How far they stand apart there follows from the geometry: turn both wheels
back by the distance, each about its centre, and measure by how much the flank misses the corner.  The
lines run on by `BEYOND` pitches with that gap g, and no further than to where the mate's flank ends in
its fillet.  Flanks of the relative radius R lean against each other there by ``sqrt(2 g / R)``, and touch
on one side of the corner only; its pressure has no bound.

Relieved flanks do not touch on the line of action but beside it, where less is missing.  At x along both
flanks from there, of the relative radius R, they part by

    x^2 / (2 R) + C1(s1(x)) + C2(s2(x)),      s1 = sqrt(s1^2 + 2 rb1 x),  s2 = sqrt(s2^2 - 2 rb2 x),

as arcs of involutes grow with ``s^2 / (2 rb)``; the least of it is the gap, by half of R times the
squared slope below that at x = 0.  At a corner the lean adds ``x sqrt(2 g / R)``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import cos, sin, tan

import numpy as np

from solidgear.core.gears.flank_shape import FlankShape
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.compliance.flank import FlankCompliance
from solidgear.teeth.contact.cells import Cells
from solidgear.teeth.contact.local import LineContact

#: pitches beyond both ends of the path that corners may reach under load
BEYOND = 0.3
#: steps in which contact lines go beyond the path
STEPS = 6
#: least share of a cell that a line crosses
SLIVER = 1e-3
#: places beside the line of action at which relieved flanks are looked at, and along their profiles
BESIDE, PROFILE = 81, 33


@dataclass(frozen=True, eq=False)
class _Solved:
    """What a pair has computed that no shape of its flanks changes."""

    lines: dict[float, Cells]  #: of flanks without modification, by position
    bulks: dict[bytes, np.ndarray]  #: compliances, by the places of the cells


@dataclass(frozen=True, eq=False)
class CylindricalPair:
    """Two cylindrical wheels with their compliance and the shapes of their flanks."""

    wheels: WheelPair
    compliances: tuple[FlankCompliance, FlankCompliance]
    law: LineContact
    #: of both flanks; face places count from the middle of the shared face
    shapes: tuple[FlankShape, FlankShape] = (FlankShape(), FlankShape())
    slices: int = 24
    beyond: float = BEYOND  #: pitches; 0 for the path alone
    _solved: _Solved = field(default_factory=lambda: _Solved({}, {}), init=False, repr=False)

    def with_shapes(self, shapes: tuple[FlankShape, FlankShape]) -> CylindricalPair:
        """Return the same wheels with other flanks, and with the cells and compliances that these have
        computed.
        """
        pair = replace(self, shapes=shapes)
        pair._solved.lines.update(self._solved.lines)
        pair._solved.bulks.update(self._solved.bulks)
        return pair

    def cells(self, phase: float) -> Cells:
        """Return the cells of all contact lines at a position in pitches."""
        lines = self._solved.lines
        if phase not in lines:
            lines[phase] = self._exact_cells(phase)
        cells = lines[phase]
        if all(shape.is_involute for shape in self.shapes):
            return cells
        inside = np.clip(cells.place, *self.wheels.ends)
        return replace(cells, gap=self.least_gap(inside, cells.z, cells.gap))

    def _exact_cells(self, phase: float) -> Cells:
        """Return the cells of flanks without modification."""
        wheels, n = self.wheels, self.slices
        step = self.wheels.face_width / n
        z = (np.arange(n) + 0.5) * step - self.wheels.face_width / 2
        lean = tan(wheels.base_helix)
        half = step * lean / 2
        start, stop = wheels.ends
        first, last = start - self.beyond * wheels.pitch, stop + self.beyond * wheels.pitch
        # a cell lies on one side of an end of the path, beyond which flanks part ever faster
        steps = wheels.pitch * self.beyond * np.linspace(0, 1, STEPS + 1) ** 2
        places = np.concatenate([start - steps[::-1], stop + steps])
        regions = list(zip(places, places[1:])) if self.beyond else [(start, stop)]
        parts = [
            (k, j, place, z[j], share * step / cos(wheels.base_helix))
            for k in self._lines(phase, first, last)
            for low, high in regions
            for j, place, share in _crossed(
                wheels.pitch_point + (phase + k) * wheels.pitch + z * lean, half, low, high
            )
        ]
        line, piece, place, along, length = (np.array(column) for column in zip(*parts))
        gap = corner_gap(wheels, place)
        flank = np.isfinite(gap)
        line, piece, place, along = line[flank], piece[flank], place[flank], along[flank]
        length, gap = length[flank], gap[flank]
        inside, beyond = np.clip(place, start, stop), (place < start) | (place > stop)
        radius = wheels.curvature_radius(inside)
        n_cells = len(line)
        normal = np.array([-cos(wheels.base_helix), 0.0, sin(wheels.base_helix)])
        lever = np.full(n_cells, wheels.first.base * cos(wheels.base_helix))
        point = np.column_stack([place - wheels.pitch_point, np.zeros(n_cells), along])
        return Cells(
            line=line,
            length=length,
            radius=radius,
            gap=gap,
            lever=lever,
            point=point,
            normal=np.tile(normal, (n_cells, 1)),
            slice=piece,
            place=place,
            z=along,
            at_corner=beyond,
            lean=np.where(beyond, np.sqrt(2 * gap / radius), np.nan),
        )

    def _lines(self, phase: float, first: float, last: float) -> range:
        """Return the numbers of lines that may cross the face within two places of the path."""
        wheels = self.wheels
        slope = tan(wheels.base_helix) * self.wheels.face_width / 2
        low = (first - slope - wheels.pitch_point) / wheels.pitch - phase
        high = (last + slope - wheels.pitch_point) / wheels.pitch - phase
        return range(int(np.floor(low)), int(np.ceil(high)) + 1)

    def least_gap(self, place: np.ndarray, z: np.ndarray, parted: np.ndarray) -> np.ndarray:
        """Return the least gap beside places of the path, m, where involutes part by so much."""
        wheels = self.wheels
        radius = wheels.curvature_radius(place)
        lengths = place, wheels.second_length(place)
        profile = np.linspace(*wheels.ends, PROFILE)
        profiles = profile, wheels.second_length(profile)
        bases = wheels.first.base, -wheels.second.sign * wheels.second.base
        spare = np.zeros(len(place))
        for shape, length, along in zip(self.shapes, lengths, profiles):
            spare += shape.deviation(length, z) - shape.deviation(along, z[:, None]).min(axis=1)
        reach = np.sqrt(2 * radius * np.maximum(spare, 0.0))
        beside = reach[:, None] * np.linspace(-1, 1, BESIDE)
        lean = np.sqrt(2 * parted / radius)[:, None]
        gap = parted[:, None] + beside**2 / (2 * radius[:, None]) + lean * np.abs(beside)
        for shape, length, base in zip(self.shapes, lengths, bases):
            moved = np.sqrt(np.maximum(length[:, None] ** 2 + 2 * base * beside, 0.0))
            gap += shape.deviation(moved, z[:, None])
        return gap.min(axis=1)

    def bulk(self, cells: Cells) -> np.ndarray:
        """Return the (n, n) compliance of the teeth of both wheels between cells, m/N."""
        bulks = self._solved.bulks
        places = b"".join(array.tobytes() for array in (cells.line, cells.place, cells.z))
        if places not in bulks:
            bulks[places] = self._bulk(cells)
        return bulks[places]

    def _bulk(self, cells: Cells) -> np.ndarray:
        place = np.clip(cells.place, *self.wheels.ends)
        radii = self.wheels.first_radius(place), self.wheels.second_radius(place)
        out = np.zeros((len(place), len(place)))
        middles = self.wheels.face_middles
        for compliance, r, sense, middle in zip(self.compliances, radii, (1, -1), middles):
            out += compliance.matrix(sense * cells.line, r, cells.z - middle)
        return out


def _crossed(
    places: np.ndarray, half: float, first: float, last: float
) -> Iterator[tuple[int, float, float]]:
    """Yield slice, middle on the path and share of every slice that a line crosses between two
    places of the path; a line ends where the path does, inside a slice.
    """
    for j, place in enumerate(places):
        if half < 1e-12 * abs(last - first):
            if first <= place < last:
                yield j, float(place), 1.0
            continue
        low, high = max(place - half, first), min(place + half, last)
        share = (high - low) / (2 * half)
        if share > SLIVER:
            yield j, (low + high) / 2, share


def corner_gap(wheels: WheelPair, place: np.ndarray) -> np.ndarray:
    """Return how far the tip of one wheel stands from the flank of the other along the normal at
    places beyond the path, m; zero on it, and infinite where the other has no flank any more.

    Examples
    --------
    >>> from solidgear.core.gears.wheel import Wheel
    >>> pair = WheelPair(Wheel(23, 4e-3), Wheel(57, 4e-3))
    >>> before = pair.ends[0] - 0.1 * pair.pitch
    >>> round(1e6 * float(corner_gap(pair, np.array([before]))[0]), 1)
    30.9
    """
    place = np.asarray(place, float)
    angle, sign = wheels.working_angle, wheels.second.sign
    first, second = wheels.first, wheels.second
    along = np.array([cos(angle), sin(angle)])
    touch = first.base * np.array([-sin(angle), cos(angle)])
    centres = np.zeros(2), np.array([0.0, sign * wheels.distance])
    out = np.zeros_like(place)
    start, stop = wheels.ends
    # before A: the second wheel's corner on the first wheel's flank; after E the other way
    for end, beyond, corner, flank, which in (
        (start, place < start, second, first, 0),
        (stop, place > stop, first, second, 1),
    ):
        if not beyond.any():
            continue
        ahead = place[beyond] - end
        at_end = touch + end * along
        turn = ahead / corner.base * (sign if which == 0 else -1)
        point = _turned(at_end - centres[1 - which], turn) + centres[1 - which]
        view = point - centres[which]
        reference = at_end - centres[which]
        tooth_turn = ahead / flank.base * (1 if which == 0 else -1)
        middle = _clockwise(reference, which, sign) - flank.half_angle(np.hypot(*reference))
        radius = np.hypot(view[:, 0], view[:, 1])
        on_flank = flank.sign * (radius - flank.form) >= 0
        missed = _clockwise(view, which, sign) - middle - tooth_turn - flank.half_angle(radius)
        gap = np.maximum(missed, 0.0) * flank.base * cos(wheels.base_helix)
        out[beyond] = np.where(on_flank, gap, np.inf)
    return out


def _turned(vector: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return the (n, 2) places of a vector turned counter-clockwise by angles, rad."""
    c, s = np.cos(angle), np.sin(angle)
    return np.column_stack([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def _clockwise(vector: np.ndarray, which: int, sign: int) -> np.ndarray:
    """Return angles from +y of each wheel's frame, clockwise, rad: the second wheel is seen upside
    down, a ring in a mirror.
    """
    x, y = np.moveaxis(np.asarray(vector), -1, 0)
    if which == 0:
        return np.arctan2(x, y)
    return np.arctan2(-x, -y) if sign > 0 else np.arctan2(-x, y)
