r"""A system at rest on bearings that press: loads, motions, and stiffness at that point.

The system without its bearings has modes ``phi_r`` and free motions R, mass-normalised.  Seen from
the seats of its bearings, with rows G, it has the flexibility of inertia relief and rigid motions

    F = G phi diag(1 / w^2) phi' G',      P = G R,

and a load l on its coordinates moves the seats like loads on the seats themselves,

    p + K (g - F p),      P'p = R'l,      g = G phi diag(1 / w^2) phi' l,

with K the stiffness between seats (:func:`solidgear.bearings.balance.between`).  So a system of any number of shafts is one :class:`solidgear.bearings.balance.Balance`, whatever joins
them.  Reduced bodies hold their static displacements under port loads, so that no truncation is in
it; of a load on all of a body, such as weight, motions of ports are exact as well (Galerkin).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from solidgear.bearings.balance import (
    FIVE,
    Balance,
    Mounted,
    between,
    common_feet,
    pushed_out,
)
from solidgear.bearings.newton import NothingHolds
from solidgear.errors import SolidgearError
from solidgear.frames import DOF_NAMES
from solidgear.machine.threads import pinned
from solidgear.scene.housing import Housing
from solidgear.system.links import apart
from solidgear.system.system import System

#: work of loads on a free motion, relative to what they could do, that is rounding
UNBALANCED = 1e-9
#: of the largest load that a bearing carries, one that is rounding: what is left of digits after a
#: balance of very stiff and very soft springs
ROUNDING = 1e-10


@dataclass(frozen=True)
class Seats:
    """Bearings of one part."""

    part: str
    bearings: tuple[Mounted, ...]  #: on ports of the part
    places: tuple[float, ...]  #: of the bearings along the shaft, m
    housing: float | Housing | None = None  #: between all of them and ground, or what they stand in
    #: ports of another part that the outer rings move rigidly with; ground without any
    stands_in: tuple[str, ...] = ()

    @property
    def ends(self) -> tuple[str, ...]:
        """Ports of the system, ``part.port``."""
        return tuple(f"{self.part}.{one.port}" for one in self.bearings)


@dataclass(frozen=True, eq=False)
class SystemEquilibrium:
    """A system at rest under loads; by ports of the system, ``part.port``."""

    #: (N,) motions times rows of the system give displacements from where nothing is loaded
    coordinates: np.ndarray
    #: motion of each bearing's inner ring against its outer one, m and rad
    relative: dict[str, np.ndarray]
    #: what each bearing carries: the load of the shaft on it, N and N m
    load: dict[str, np.ndarray]
    tangent: dict[str, np.ndarray]  #: of each bearing alone, at that point
    lost: tuple[str, ...]  #: bearings that carry nothing
    _state: np.ndarray = field(repr=False, default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, eq=False)
class OnBearings:
    """A system without its bearings, and the bearings that it rests on.

    Examples
    --------
    A rigid drum of 10 kg on two springs carries its weight at both ends:

    >>> import numpy as np
    >>> from solidgear.bearings.balance import Linear
    >>> from solidgear.system import RigidBody, System
    >>> drum = RigidBody(np.diag([10, 10, 10, 0.1, 0.1, 0.1]), {"a": (0, -0.1, 0), "b": (0, 0.1, 0)})
    >>> spring = Linear(np.diag([1e6, 1e6, 1e6, 0, 0, 0]))
    >>> seats = Seats("drum", (Mounted("a", spring), Mounted("b", spring)), (-0.1, 0.1))
    >>> held = OnBearings(System({"drum": drum}), (seats,))
    >>> found = held.equilibrium(weight(held.system, (0.0, 0.0, -9.81)))
    >>> round(float(found.load["drum.a"][2]), 9)
    -49.05
    """

    system: System
    seats: tuple[Seats, ...]

    @cached_property
    def _across(self) -> dict[str, np.ndarray]:
        """(6, N) motion of every seat against what its bearing stands in, by its port."""
        out: dict[str, np.ndarray] = {}
        for own in self.seats:
            around = [[self.system.port(below)] for below in own.stands_in]
            for end, below in zip(own.ends, around or [[]] * len(own.ends)):
                out[end] = apart(self.system.port(end), *below)
        return out

    @cached_property
    def _rows(self) -> np.ndarray:
        """(5 b, N) the same without rotations about the axes."""
        rows = [across[list(FIVE)] for across in self._across.values()]
        return np.vstack([np.zeros((0, self.system.size)), *rows])

    @cached_property
    def _length(self) -> float:
        """Distance of the farthest seats, m: what makes a rotation a displacement."""
        points = np.array([self.system.port(end).point for own in self.seats for end in own.ends])
        if not len(points):
            raise SolidgearError("nothing holds the shaft against its loads: it has no bearing")
        return float(np.ptp(points, axis=0).max(initial=0.0)) or 1.0

    @cached_property
    def _size(self) -> np.ndarray:
        turn = 1 / self._length
        return np.tile([1.0, 1.0, 1.0, turn, turn], len(self._rows) // 5)

    @cached_property
    def _soft(self) -> np.ndarray:
        """(5 b, m) elastic shapes at the seats over their frequencies."""
        omega, shapes = self.system.elastic
        return self._rows @ shapes / omega

    @cached_property
    def _rigid(self) -> np.ndarray:
        """(5 b, z) free motions at the seats."""
        return self._rows @ self.system.free

    @cached_property
    def balance(self) -> Balance:
        """Its bearings on what it is elastically between them."""
        bearings: list[Mounted] = []
        around = []
        for own in self.seats:
            numbers = range(len(bearings), len(bearings) + len(own.bearings))
            around += common_feet(own.housing, dict(zip(numbers, own.places)))
            bearings += own.bearings
        elastic = between(self._soft @ self._soft.T, self._rigid, self._size)
        return Balance(elastic, bearings, around)

    def _elastic(self, load: np.ndarray) -> np.ndarray:
        """(m,) ``diag(1 / w) phi' l``."""
        omega, shapes = self.system.elastic
        return (shapes.T @ load) / omega

    def _carried_rigidly(self, load: np.ndarray) -> np.ndarray:
        """(5 b,) loads on the seats that do the same work on every free motion."""
        work = self.system.free.T @ load
        rows = self._rigid / self._size[:, None]
        pushed, *_ = np.linalg.lstsq(rows.T, work, rcond=1e-9)
        left = work - rows.T @ pushed
        most = np.linalg.norm(np.linalg.solve(np.linalg.cholesky(self.system.mass), load))
        if np.linalg.norm(left) > UNBALANCED * most:
            raise SolidgearError(self._not_balanced(left))
        return pushed / self._size

    def _not_balanced(self, left: np.ndarray) -> str:
        """Sentence on loads that neither bearings nor each other balance."""
        motion = self.system.free @ left
        ends = [end for own in self.seats for end in own.ends]
        under = [*dict.fromkeys(below for own in self.seats for below in own.stands_in)]
        moved = np.array([self.system.motion(end) @ motion for end in (*under, *ends)])
        moved[:, 3:] *= self._length
        if under and np.abs(moved[: len(under)]).max() > 1e-6 * np.abs(moved).max():
            part = under[0].partition(".")[0]
            way = DOF_NAMES[int(np.argmax(np.abs(moved[0])))]
            return f"nothing holds the {part} in {way} under these loads: no mount does"
        moved = moved[len(under) :]
        k, component = np.unravel_index(int(np.argmax(np.abs(moved))), moved.shape)
        return (
            f"nothing holds {ends[k].partition('.')[0]} in {DOF_NAMES[component]} under these "
            "loads: no bearing does, and they do not balance each other"
        )

    @pinned
    def equilibrium(
        self, load: np.ndarray, start: SystemEquilibrium | None = None
    ) -> SystemEquilibrium:
        """Equilibrium under constant loads.

        Parameters
        ----------
        load : (N,) ndarray
            On the coordinates of the system, as from :meth:`solidgear.system.System.load`.
        start : SystemEquilibrium, optional
            One of the same system to begin at, under loads that are near.

        Returns
        -------
        SystemEquilibrium
            Of a motion that nothing resists, such as the rotation of a train, as much as keeps the
            bearings' own motions and is least in mass.

        Raises
        ------
        SolidgearError
            If nothing holds the system against the loads.
        """
        load = np.asarray(load, float)
        rigid, pushed = self._carried_rigidly(load), self._soft @ self._elastic(load)
        bent = pushed - self._soft @ (self._soft.T @ rigid)
        basis, stiffness, size = self.balance.elastic
        target = basis.T @ rigid + stiffness * (basis.T @ (bent / size**2))
        try:
            found = self.balance.settle(target, None if start is None else start._state)
        except NothingHolds as error:
            raise SolidgearError(self._not_held(error.direction)) from None
        return self._told(load, found.motion)

    def _not_held(self, direction: np.ndarray) -> str:
        ends = [end for own in self.seats for end in own.ends]
        k = int(np.argmax(np.abs(direction)))
        component = DOF_NAMES[FIVE[k % 5]]
        shaft = ends[k // 5].partition(".")[0]
        return f"no bearing holds {shaft} in {component}: it is {pushed_out(component)}"

    def _told(self, load: np.ndarray, at: np.ndarray) -> SystemEquilibrium:
        ends = [end for own in self.seats for end in own.ends]
        relative, carried = self.balance.carried(at)
        total = load.copy()
        for end, own in zip(ends, carried):
            total -= self._across[end].T @ own
        omega, shapes = self.system.elastic
        elastic = shapes @ (self._elastic(total) / omega)
        missing = (self.balance.places(at) - self._rows @ elastic) / self._size
        free, *_ = np.linalg.lstsq(self._rigid / self._size[:, None], missing, rcond=1e-9)
        tangent = [one.bearing.tangent(q) for one, q in zip(self.balance.bearings, relative)]
        lost = tuple(end for end, own in zip(ends, carried) if not own.any())
        carried = without_rounding(carried, self._length)
        return SystemEquilibrium(
            elastic + self.system.free @ free,
            dict(zip(ends, relative)),
            dict(zip(ends, carried)),
            dict(zip(ends, tangent)),
            lost,
            at,
        )


def without_rounding(carried: Sequence[np.ndarray], length: float) -> list[np.ndarray]:
    """Loads (6,) of bearings without components that are rounding beside the largest of all, moments
    as forces over a length, m.
    """
    size = np.repeat([1.0, 1 / length], 3)
    least = ROUNDING * max((np.abs(load * size).max() for load in carried), default=0.0)
    return [np.where(np.abs(load * size) > least, load, 0.0) for load in carried]


def weight(system: System, gravity: Sequence[float]) -> np.ndarray:
    """Load of weight on all parts of a system that can fall.

    Parameters
    ----------
    gravity : (3,) sequence of float
        Acceleration in the axes of the system, m/s^2.

    Returns
    -------
    (N,) ndarray
        N on the coordinates of the system; none of parts that only turn.
    """
    falling = np.zeros(system.size)
    for name, part in system.parts.items():
        falling[system.place(name)] = _fall(part, np.asarray(gravity, float))
    return system.mass @ falling


def _fall(part, gravity: np.ndarray) -> np.ndarray:
    """(n,) coordinates of a part whose ports all move by a vector, without strain."""
    strain, count = part.strain, part.mass.shape[0]
    free = np.eye(count)
    if len(strain):
        _, size, vectors = np.linalg.svd(strain, full_matrices=True)
        free = vectors[int((size > UNBALANCED * size[0]).sum()) :].T
    wanted = [np.r_[p.axes.T @ gravity, np.zeros(3)] for p in part.ports.values()]
    rows = np.vstack([p.rows for p in part.ports.values()]) @ free
    found, *_ = np.linalg.lstsq(rows, np.concatenate(wanted), rcond=UNBALANCED)
    left = np.abs(rows @ found - np.concatenate(wanted)).max()
    return free @ found if left <= 1e-6 * np.linalg.norm(gravity) else np.zeros(count)
