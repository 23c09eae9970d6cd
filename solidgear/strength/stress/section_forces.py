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
of the seats, where all fillets lie, section forces are exact however the load is spread; inside a
seat the moment given here is that of the concentrated load, a little above that of a spread one.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import DOF_NAMES, TOUCH, Outline, SolidgearError, listed, nearest
from solidgear.core.frames import shift
from solidgear.core.scene.closed_form import mass_properties

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from solidgear.core import Scene

#: components of a section force, in the order of those of loads
COMPONENTS = ("Q_x", "N", "Q_z", "M_x", "T", "M_z")
#: how names of loads that are weights begin
WEIGHT = "weight of "
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


@dataclass(frozen=True)
class SectionForces:
    """Section forces of a shaft: forces are constant from place to place, moments straight."""

    y: np.ndarray  #: (k,) both ends and all places of loads, ascending, m
    names: tuple[str, ...]  #: of the loads at each place; empty where none acts
    #: left, right: (k, 6) just before and just beyond each place: Q_x, N, Q_z in N, M_x, T, M_z in
    #: N m
    left: np.ndarray
    right: np.ndarray

    def at(self, y: float) -> np.ndarray:
        """Return the section forces (6,) at one place, m; where a load acts, just beyond it."""
        k = int(np.searchsorted(self.y, y, side="right")) - 1
        if k < 0 or y > self.y[-1]:
            return np.zeros(6)
        return move_load(self.right[k], self.y[k], y)

    def before(self, y: float) -> np.ndarray:
        """Return the section forces (6,) at one place, m; where a load acts, just before it."""
        k = int(np.abs(self.y - y).argmin())
        return self.left[k] if abs(self.y[k] - y) <= TOUCH else self.at(y)

    @property
    def names_without_weights(self) -> tuple[str, ...]:
        """Names of the loads at each place, without weights."""
        names = (
            [name for name in names.split(", ") if not name.startswith(WEIGHT)]
            for names in self.names
        )
        return tuple(map(", ".join, names))

    @cached_property
    def largest_moment(self) -> float:
        """Largest bending moment along the shaft, N m."""
        ends = np.concatenate([self.left, self.right])
        return float(np.hypot(ends[:, 3], ends[:, 5]).max())


def move_load(six: np.ndarray, y: float, target: float) -> np.ndarray:
    """Return a load about y as one about another place on the axis."""
    return shift([0.0, y - target, 0.0]).T @ six


def section_forces(loads: Iterable[Load], length: float) -> SectionForces:
    """Return section forces of a free shaft of a length, m, under loads; those that do not balance
    are refused, with the component and the rest.
    """
    loads = sorted(loads, key=lambda load: load.y)
    least = _refuse_imbalance(loads, length)
    places = _places([load.y for load in loads], length)
    names, before, after = [], [], []
    forces, place = np.zeros(6), 0.0
    for y in places:
        forces, place = move_load(forces, place, y), y
        before.append(forces)
        acting = [load for load in loads if abs(load.y - y) <= TOUCH]
        forces = forces - sum((load.six for load in acting), np.zeros(6))
        after.append(forces)
        names.append(", ".join(load.name for load in acting))
    sides = [np.where(np.abs(side) > least, side, 0.0) for side in (before, after)]
    return SectionForces(np.array(places), tuple(names), left=sides[0], right=sides[1])


def forces_of(
    scene: Scene, loads: Mapping[str, ArrayLike], gravity: ArrayLike | None = None
) -> SectionForces:
    """Return section forces of a shaft under loads on ports, and the weight where there is
    gravity.
    """
    falling = [] if gravity is None else weight(scene, gravity)
    return section_forces([*on_ports(scene, loads), *falling], scene.length)


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
        placed.append(Load(name, y, move_load(six, station.y, y)))
    return placed


def weight(scene: Scene, gravity: ArrayLike) -> list[Load]:
    """Return the weight of a shaft and of the masses on it: one load a segment, at its centre of
    mass; gravity (3,) in m/s^2.

    Section forces are exact at both ends of every segment, where fillets are; between them they
    step where those of a spread weight run smoothly. Material removed by features
    still counts.
    """
    g = np.asarray(gravity, float)
    loads = []
    for k, segment in enumerate(scene.segments):
        edges = [replace(corner, owner=0) for corner in scene.outline.corners if corner.owner == k]
        mass = mass_properties(Outline([segment], edges))
        force = np.concatenate([mass.mass * g, np.zeros(3)])
        loads.append(Load(f"{WEIGHT}{segment.name}", mass.centre, force))
    seats = {station.name: station.y for station in scene.stations}
    for point in scene.masses:
        force = np.concatenate([point.mass * g, np.zeros(3)])
        centre = shift(point.offset).T @ force
        loads.append(Load(f"{WEIGHT}{point.name}", seats[point.station], centre))
    return loads


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
