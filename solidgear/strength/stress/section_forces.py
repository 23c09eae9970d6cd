r"""Section forces along a free shaft, by statics alone.

Cut the shaft at y. The section force is exerted by the part *beyond* the cut on the part *before*
it, on the face whose normal points along +y, about the middle of the section::

          z                              Q_z   M_x about +x, T about +y, M_z about +z,
          |   before the cut    |         ^    all right-handed
          |  +------------------|-        |
    x out |  |                  |  ...    +----> N (tension is positive)
    of    +--|- - - - - - - - - | - - -> y
    page     |                  |
             +------------------|-       Q_x points along +x

The six components are in the order of every load here, ``(Q_x, N, Q_z, M_x, T, M_z)`` on
``(x, y, z, thx, thy, thz)``. With the loads before the cut, each moved to the cut,

    S(y) = - sum over y_i < y of L_i

and between loads forces stay while ``dM_x/dy = -Q_z`` and ``dM_z/dy = Q_x``. They make the stress
``sigma = N / A - M_x z / I + M_z x / I``.

A load that is spread over a seat is taken as one at the middle of the loaded part: at the place of
the port, or at the end of the seat nearest to that where the port lies beside the seat. Outside
of the seats section forces are exact however the load is spread; inside a seat the moment given
here is that of the concentrated load, a little above that of a spread one.

How a load is spread over its seat is not known: a key may take all of a torque on its own length.
In a section inside a seat, a share from none to all of the load has entered, so that force, torque
and couple lie between those of both sides of it. :func:`sections_along` gives both.

Weight is spread along the shaft as its mass is. Between two places a and y it adds its own part,

    S(y) = X(a - y)^T S(a) - integral from a to y of X(s - y)^T dm g,

so that moments are curved there, and may be largest where the shear force is zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from solidgear.core import DOF_NAMES, TOUCH, SolidgearError, listed, nearest
from solidgear.core.frames import shift
from solidgear.strength.stress.spread_weight import SpreadWeight

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from solidgear.core import Scene

#: components of a section force, in the order of those of loads
COMPONENTS = ("Q_x", "N", "Q_z", "M_x", "T", "M_z")
#: how names of the weights of masses begin
WEIGHT = "weight of "
#: intervals between two places, of a search for the largest moment or of a curve
FINE = 24
#: largest imbalance of loads, relative to the sum of their sizes; moments count by the length
BALANCED = 1e-6
#: and that of rounding
ROUNDING = 1e-13


@dataclass(frozen=True)
class Load:
    """A load on a shaft at one place."""

    name: str
    y: float  #: m
    six: np.ndarray  #: (6,) forces and moments about the axis at y, N and N m
    #: ends of the surface over which it enters, m; None of a load at a point
    seat: tuple[float, float] | None = None

    def enters_at(self, y: float, beyond: bool) -> bool:
        """Return whether the section just before a place, or just beyond it, lies where it enters."""
        lo, hi = self.seat or (self.y, self.y)
        return abs(y - self.y) <= TOUCH if hi - lo <= TOUCH else lies_in((lo, hi), y, beyond)

    def has_entered(self, y: float, beyond: bool) -> bool:
        """Return whether its place lies before the section just before a place, or just beyond it."""
        return beyond if abs(y - self.y) <= TOUCH else self.y < y


@dataclass(frozen=True)
class SectionForces:
    """Section forces of a shaft: between places forces are constant and moments straight, but for the
    weight that is spread there.
    """

    plain_names = ("y", "names", "left", "right", "largest_moment", "peak")

    #: (k,) both ends and all places of loads, ascending, m; under spread weight the joints of segments
    #: too, and places between where the bending moment is stationary
    y: np.ndarray
    names: tuple[str, ...]  #: of the loads at each place; empty where none acts
    #: left, right: (k, 6) just before and just beyond each place: Q_x, N, Q_z in N, M_x, T, M_z in
    #: N m
    left: np.ndarray
    right: np.ndarray
    spread: SpreadWeight | None = None
    loads: tuple[Load, ...] = field(repr=False, default=())
    #: (6,) what is less is rounding
    rounding: np.ndarray | float = field(repr=False, default=0.0)

    def at(self, y: float) -> np.ndarray:
        """Return the section forces (6,) at one place, m; where a load acts, just beyond it."""
        k = int(np.searchsorted(self.y, y, side="right")) - 1
        if k < 0 or y > self.y[-1]:
            return np.zeros(6)
        return _carried(self.right[k], self.y[k], y, self.spread)

    def before(self, y: float) -> np.ndarray:
        """Return the section forces (6,) at one place, m; where a load acts, just before it."""
        k = int(np.abs(self.y - y).argmin())
        return self.left[k] if abs(self.y[k] - y) <= TOUCH else self.at(y)

    @cached_property
    def largest_moment(self) -> float:
        """Largest bending moment along the shaft, N m."""
        return float(self._moments.max())

    @cached_property
    def peak(self) -> float | None:
        """Place of the largest bending moment, m, where no load acts there; else None."""
        k = int(self._moments.argmax())
        return None if self.names[k] or not self._moments[k] else float(self.y[k])

    @cached_property
    def _moments(self) -> np.ndarray:
        """(k,) larger bending moment of both sides of every place, N m."""
        return np.maximum(_bending(self.left), _bending(self.right))

    @cached_property
    def curve(self) -> tuple[np.ndarray, np.ndarray]:
        """Places (n,), m, and section forces (n, 6) of a line along the shaft, with both sides of every
        place.
        """
        y, rows = [self.y[0]], [self.left[0]]
        for k, end in enumerate(self.y[1:]):
            count = FINE if self.spread else 1
            between = np.linspace(self.y[k], end, count + 1)[1:-1]
            y += [self.y[k], *between, end]
            rows += [self.right[k], *map(self.at, between), self.left[k + 1]]
        return np.array([*y, self.y[-1]]), np.array([*rows, self.right[-1]])


def lies_in(span: tuple[float, float], y: float, beyond: bool) -> bool:
    """Return whether the section just before a place, m, or just beyond it, lies in a span."""
    lo, hi = span
    return lo - TOUCH <= y < hi - TOUCH if beyond else lo + TOUCH < y <= hi + TOUCH


class Cut(NamedTuple):
    """A section across the shaft, just before a place, m, or just beyond it."""

    y: float
    beyond: bool
    #: loads on whose seats it lies that enter on the other side of it than their places are
    across: tuple[str, ...] = ()

    def of(self, forces: SectionForces) -> np.ndarray:
        """Return the section forces (6,) there."""
        six = forces.at(self.y) if self.beyond else forces.before(self.y)
        moved = [load for load in forces.loads if load.name in self.across]
        if not moved:
            return six
        for load in moved:
            # the moment of its force stays that of the force at its place
            six = six + load.six if load.has_entered(self.y, self.beyond) else six - load.six
        return np.where(np.abs(six) > forces.rounding, six, 0.0)


def sections_along(
    span: tuple[float, float], forces: Sequence[SectionForces], ends: Iterable[float] = ()
) -> Iterator[Cut]:
    """Yield sections along a span, m, among which section forces are largest: at its ends, at places
    and ends of seats of loads, where moments are stationary, and at `ends` of what else lies there;
    on a seat with the load on one side and on the other.

    Examples
    --------
    A key from 10 to 30 mm under a hub from 20 to 60 mm, whose torque may all enter by the key:

    >>> load = Load("hub", 0.04, np.array([0, 0, 0, 0, 100.0, 0]), seat=(0.02, 0.06))
    >>> forces = section_forces([load, Load("end", 0.1, -load.six)], 0.1)
    >>> [float(cut.of(forces)[4]) for cut in sections_along((0.01, 0.03), [forces])]
    [0.0, 0.0, 0.0, -100.0, 0.0, -100.0]
    """
    lo, hi = span
    loads = {load.name: load for each in forces for load in each.loads if np.any(load.six)}
    seats = [end for load in loads.values() for end in load.seat or ()]
    inside = [y for y in chain(ends, seats, *(each.y for each in forces)) if lo < y < hi]
    places = [y for y in _places(inside, hi) if lo + TOUCH < y < hi - TOUCH]
    sides = [(lo, True), *((y, beyond) for y in places for beyond in (False, True)), (hi, False)]
    for y, beyond in sides:
        entering = [load.name for load in loads.values() if load.enters_at(y, beyond)]
        yield from both_sides(float(y), beyond, entering)


def both_sides(y: float, beyond: bool, entering: Sequence[str]) -> Iterator[Cut]:
    """Yield the section just before a place, m, or just beyond it, with loads of some names on one
    side of it and on the other.
    """
    for count in range(len(entering) + 1):
        for across in combinations(entering, count):
            yield Cut(y, beyond, across)


def _bending(forces: np.ndarray) -> np.ndarray:
    """Return bending moments of section forces (k, 6), N m."""
    return np.hypot(forces[:, 3], forces[:, 5])


def _carried(forces: np.ndarray, start: float, y: float, spread: SpreadWeight | None) -> np.ndarray:
    """Return section forces (6,) at a place behind a start, m, between which no load acts but weight."""
    moved = move_load(forces, start, y)
    return moved if spread is None else moved - spread.between(start, y, about=y)


def move_load(six: np.ndarray, y: float, target: float) -> np.ndarray:
    """Return a load about y as one about another place on the axis."""
    return shift([0.0, y - target, 0.0]).T @ six


def section_forces(
    loads: Iterable[Load], length: float, spread: SpreadWeight | None = None
) -> SectionForces:
    """Return section forces of a free shaft of a length, m, under loads and spread weight; those that
    do not balance are refused, with the component and the rest.
    """
    loads = sorted(loads, key=lambda load: load.y)
    whole = [] if spread is None else [Load("", 0.0, spread.between(0.0, length, about=0.0))]
    least = _refuse_imbalance([*loads, *whole], length)
    joints = [] if spread is None else spread.joints
    places = _places([*(load.y for load in loads), *joints], length)
    forces = _along(loads, places, least, spread)
    if spread is None or not (stationary := [*_stationary(forces)]):
        return forces
    return _along(loads, _places([*places, *stationary], length), least, spread)


def _along(
    loads: Sequence[Load],
    places: Sequence[float],
    least: np.ndarray,
    spread: SpreadWeight | None,
) -> SectionForces:
    """Return section forces at both sides of places, without what is below the least (6,)."""
    names, before, after = [], [], []
    forces, place = np.zeros(6), 0.0
    for y in places:
        forces, place = _carried(forces, place, y, spread), y
        before.append(forces)
        acting = [load for load in loads if abs(load.y - y) <= TOUCH]
        forces = forces - sum((load.six for load in acting), np.zeros(6))
        after.append(forces)
        names.append(", ".join(load.name for load in acting))
    left, right = (np.where(np.abs(side) > least, side, 0.0) for side in (before, after))
    return SectionForces(np.array(places), tuple(names), left, right, spread, tuple(loads), least)


def _stationary(forces: SectionForces) -> Iterator[float]:
    """Yield places between others, m, where the bending moment is stationary."""
    # start-up: the optimisers of scipy
    from scipy.optimize import brentq

    def slope(y: float) -> float:
        """Return the slope of half the square of the moment, N^2 m."""
        q_x, _, q_z, m_x, _, m_z = forces.at(y)
        return float(m_z * q_x - m_x * q_z)

    for start, end in zip(forces.y, forces.y[1:]):
        places = np.linspace(start, end - TOUCH, FINE + 1)
        slopes = [*map(slope, places)]
        for a, b, left, right in zip(places, places[1:], slopes, slopes[1:]):
            if left * right < 0:
                yield float(brentq(slope, a, b, xtol=TOUCH))
            elif left and not right:
                yield float(b)


def forces_of(
    scene: Scene, loads: Mapping[str, ArrayLike], gravity: ArrayLike | None = None
) -> SectionForces:
    """Return section forces of a shaft under loads on ports, and the weight where there is
    gravity, (3,) in m/s^2.
    """
    if gravity is None:
        return section_forces(on_ports(scene, loads), scene.length)
    g = np.asarray(gravity, float)
    spread = SpreadWeight.of(scene, g)
    return section_forces([*on_ports(scene, loads), *_masses(scene, g)], scene.length, spread)


def on_ports(scene: Scene, loads: Mapping[str, ArrayLike]) -> list[Load]:
    """Return the loads (6,) on the shaft, N and N m, about the places of the ports, bearings and
    masses of these names.
    """
    stations = {station.name: station for station in scene.stations}
    placed = []
    for name, load in loads.items():
        if name not in stations:
            raise SolidgearError(
                f'load on "{name}": the shaft has no such place{nearest(name, stations)}; it has '
                f"{listed(stations)}"
            )
        six = np.asarray(load, float)
        if six.shape != (6,) or not np.isfinite(six).all():
            raise SolidgearError(
                f'load on "{name}": it must be six finite numbers, {", ".join(DOF_NAMES)} in N and '
                "N m"
            )
        station = stations[name]
        y = min(max(station.y, station.lo), station.hi)
        placed.append(Load(name, y, move_load(six, station.y, y), (station.lo, station.hi)))
    return placed


def _masses(scene: Scene, gravity: np.ndarray) -> Iterator[Load]:
    """Yield the weights of the masses on a shaft."""
    stations = {station.name: station for station in scene.stations}
    for point in scene.masses:
        force = np.concatenate([point.mass * gravity, np.zeros(3)])
        centre = shift(point.offset).T @ force
        station = stations[point.station]
        yield Load(f"{WEIGHT}{point.name}", station.y, centre, (station.lo, station.hi))


def _refuse_imbalance(loads: Sequence[Load], length: float) -> np.ndarray:
    """Refuse loads that do not balance, and return the rounding (6,) of section forces."""
    total = sum((move_load(load.six, load.y, 0.0) for load in loads), np.zeros(6))
    forces = sum(float(np.linalg.norm(load.six[:3])) for load in loads)
    moments = sum(float(np.linalg.norm(load.six[3:])) for load in loads)
    size = np.repeat([max(forces, moments / length), max(moments, forces * length)], 3)
    wrong = np.flatnonzero(np.abs(total) > BALANCED * size)
    if not len(wrong):
        remainder = np.abs(total) + np.repeat([0.0, length], 3) * np.abs(total[:3]).max(initial=0.0)
        return np.maximum(2 * remainder, ROUNDING * size)
    remainder = [f"{total[k]:.6g} {'N' if k < 3 else 'N m'} of {DOF_NAMES[k]}" for k in wrong]
    hint = "; a drive torque is a load too" if wrong.tolist() == [4] else ""
    raise SolidgearError(
        f"the loads on the shaft do not balance: {listed(remainder)} is left about y = 0; give bearing "
        f"reactions, mesh forces and drive torques together{hint}"
    )


def _places(loaded: Sequence[float], length: float) -> list[float]:
    """Return both ends and all places of loads, each once."""
    out: list[float] = []
    for y in sorted([0.0, *loaded, length]):
        if not out or y - out[-1] > TOUCH:
            out.append(y)
    return out
