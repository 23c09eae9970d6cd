r"""A system at rest on bearings that press: loads, motions, and stiffness at that point.

The system without bearings has modes ``phi_r`` and free motions R, mass-normalised.  Seen from
the seats of bearings, with rows G, it has the flexibility of inertia relief and rigid motions

    F = G phi diag(1 / w^2) phi' G',      P = G R,

and a load l on the coordinates moves the seats like loads on the seats themselves,

    p + K (g - F p),      P'p = R'l,      g = G phi diag(1 / w^2) phi' l,

with K the stiffness between seats (:func:`solidgear.bearings.balance.between`). So a system of any
number of shafts is one :class:`solidgear.bearings.balance.Balance`, whatever joins them. Reduced
bodies hold their static displacements under port loads, so that no truncation is in it; of a load
on all of a body, such as weight, motions of ports are exact as well (Galerkin).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.newton import NothingHolds
from solidgear.bearings.solved import mounted
from solidgear.core import DOF_NAMES, Bearing, Scene, SolidgearError, System, pinned
from solidgear.core.scene.housing import Housing
from solidgear.core.system.links import relative_motion

#: work of loads on a free motion, relative to the most they could do, that is rounding
UNBALANCED = 1e-9
#: of the largest load that a bearing carries, one that is rounding: what is left of digits after a
#: balance of very stiff and very soft springs
ROUNDING = 1e-10
#: N/m and N m/rad of a held seat at rest: a millionth of a shaft's flexibility, and rounding as small
FIRM = 1e15


@dataclass(frozen=True)
class Seats:
    """Bearings of one part."""

    part: str
    bearings: tuple[Mounted, ...]  #: on ports of the part
    places: tuple[float, ...]  #: of the bearings along the shaft, m
    housing: float | Housing | None = None  #: between all of them and their base
    #: ports of another part that the outer rings move rigidly with; ground without any
    stands_in: tuple[str, ...] = ()

    @property
    def ends(self) -> tuple[str, ...]:
        """Ports of the system, ``part.port``."""
        return tuple(f"{self.part}.{bearing.port}" for bearing in self.bearings)


@dataclass(frozen=True, eq=False)
class SystemEquilibrium:
    """A system at rest under loads; by ports of the system, ``part.port``."""

    #: (N,) motions times rows of the system give displacements from where nothing is loaded
    coordinates: np.ndarray
    #: motion of each bearing's inner ring against its outer one, m and rad
    relative: dict[str, np.ndarray]
    #: load of the shaft on each bearing, N and N m
    load: dict[str, np.ndarray]
    tangent: dict[str, np.ndarray]  #: of each bearing alone, at that point
    lost: tuple[str, ...]  #: bearings that carry nothing
    _state: np.ndarray = field(repr=False, default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, eq=False)
class OnBearings:
    """A system without bearings, and the bearings that it rests on.

    Examples
    --------
    A rigid drum of 10 kg on two springs carries its weight at both ends:

    >>> import numpy as np
    >>> from solidgear.bearings.balance import Linear
    >>> from solidgear.core.system import RigidBody, System
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
    def _seat_motions(self) -> dict[str, np.ndarray]:
        """Motion (6, N) of every seat relative to the base of the bearing, by port."""
        out: dict[str, np.ndarray] = {}
        for seats in self.seats:
            bases = [[self.system.port(base)] for base in seats.stands_in]
            for end, base in zip(seats.ends, bases or [[]] * len(seats.ends)):
                out[end] = relative_motion(self.system.port(end), *base)
        return out

    @cached_property
    def _rows(self) -> np.ndarray:
        """(5 b, N) the same without rotations about the axes."""
        rows = [across[list(FIVE)] for across in self._seat_motions.values()]
        return np.vstack([np.zeros((0, self.system.size)), *rows])

    @cached_property
    def _length(self) -> float:
        """Distance of the farthest seats, m, by which rotations count as displacements."""
        points = np.array(
            [self.system.port(end).point for seats in self.seats for end in seats.ends]
        )
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
        """Balance of the bearings on the elastic system between them."""
        bearings: list[Mounted] = []
        feet = []
        for seats in self.seats:
            numbers = range(len(bearings), len(bearings) + len(seats.bearings))
            feet += common_feet(seats.housing, dict(zip(numbers, seats.places)))
            bearings += seats.bearings
        elastic = between(self._soft @ self._soft.T, self._rigid, self._size)
        return Balance(elastic, bearings, feet)

    def _elastic(self, load: np.ndarray) -> np.ndarray:
        """Return ``diag(1 / w) phi' l``, (m,)."""
        omega, shapes = self.system.elastic
        return (shapes.T @ load) / omega

    def _carried_rigidly(self, load: np.ndarray) -> np.ndarray:
        """Return loads (5 b,) on the seats that do the same work on every free motion."""
        work = self.system.free.T @ load
        rows = self._rigid / self._size[:, None]
        pushed, *_ = np.linalg.lstsq(rows.T, work, rcond=1e-9)
        imbalance = work - rows.T @ pushed
        most = np.linalg.norm(np.linalg.solve(np.linalg.cholesky(self.system.mass), load))
        if np.linalg.norm(imbalance) > UNBALANCED * most:
            raise SolidgearError(self._imbalance_sentence(imbalance))
        return pushed / self._size

    def _imbalance_sentence(self, work: np.ndarray) -> str:
        """Return the sentence on loads that neither bearings nor each other balance."""
        motion = self.system.free @ work
        ends = [end for seats in self.seats for end in seats.ends]
        bases = [*dict.fromkeys(base for seats in self.seats for base in seats.stands_in)]
        moved = np.array([self.system.motion(end) @ motion for end in (*bases, *ends)])
        moved[:, 3:] *= self._length
        if bases and np.abs(moved[: len(bases)]).max() > 1e-6 * np.abs(moved).max():
            part = bases[0].partition(".")[0]
            way = DOF_NAMES[int(np.argmax(np.abs(moved[0])))]
            return f"no mount holds the {part} in {way} under these loads"
        moved = moved[len(bases) :]
        k, component = np.unravel_index(int(np.argmax(np.abs(moved))), moved.shape)
        return (
            f"no bearing holds {ends[k].partition('.')[0]} in {DOF_NAMES[component]} under these "
            "loads, which do not balance"
        )

    @pinned
    def equilibrium(
        self, load: np.ndarray, start: SystemEquilibrium | None = None
    ) -> SystemEquilibrium:
        """Return the equilibrium under constant loads (N,) on the coordinates of the system, as
        from :meth:`solidgear.core.system.System.load`, from one under near loads on.

        A motion that nothing resists, such as the rotation of a train, is as large as the bearings'
        motions require, and least in mass. Loads that nothing holds are refused.
        """
        load = np.asarray(load, float)
        rigid, pushed = self._carried_rigidly(load), self._soft @ self._elastic(load)
        bent = pushed - self._soft @ (self._soft.T @ rigid)
        basis, stiffness, size = self.balance.elastic
        target = basis.T @ rigid + stiffness * (basis.T @ (bent / size**2))
        try:
            settled = self.balance.settle(target, None if start is None else start._state)
        except NothingHolds as error:
            raise SolidgearError(self._not_held_sentence(error.direction)) from None
        return self._result(load, settled.motion)

    def _not_held_sentence(self, direction: np.ndarray) -> str:
        ends = [end for seats in self.seats for end in seats.ends]
        k = int(np.argmax(np.abs(direction)))
        component = DOF_NAMES[FIVE[k % 5]]
        shaft = ends[k // 5].partition(".")[0]
        return f"no bearing holds {shaft} in {component}: it is {pushed_out(component)}"

    def _result(self, load: np.ndarray, state: np.ndarray) -> SystemEquilibrium:
        ends = [end for load in self.seats for end in load.ends]
        relative, carried = self.balance.carried(state)
        total = load.copy()
        for end, seats in zip(ends, carried):
            total -= self._seat_motions[end].T @ seats
        omega, shapes = self.system.elastic
        elastic = shapes @ (self._elastic(total) / omega)
        missing = (self.balance.places(state) - self._rows @ elastic) / self._size
        free, *_ = np.linalg.lstsq(self._rigid / self._size[:, None], missing, rcond=1e-9)
        tangent = [
            bearing.bearing.tangent(q) for bearing, q in zip(self.balance.bearings, relative)
        ]
        lost = tuple(end for end, load in zip(ends, carried) if not load.any())
        carried = without_rounding(carried, self._length)
        return SystemEquilibrium(
            elastic + self.system.free @ free,
            dict(zip(ends, relative)),
            dict(zip(ends, carried)),
            dict(zip(ends, tangent)),
            lost,
            state,
        )


def without_rounding(carried: Sequence[np.ndarray], length: float) -> list[np.ndarray]:
    """Return the loads (6,) of bearings without components that are rounding beside the largest of
    all, moments as forces over a length, m.
    """
    size = np.repeat([1.0, 1 / length], 3)
    least = ROUNDING * max((np.abs(load * size).max() for load in carried), default=0.0)
    return [np.where(np.abs(load * size) > least, load, 0.0) for load in carried]


def weight(system: System, gravity: Sequence[float]) -> np.ndarray:
    """Return the load (N,) of weight on all parts of a system that can fall, N; `gravity` (3,) is
    an acceleration in the axes of the system, m/s^2; parts that only turn have none.
    """
    falling = np.zeros(system.size)
    for name, part in system.parts.items():
        falling[system.place(name)] = _fall(part, np.asarray(gravity, float))
    return system.mass @ falling


def _fall(part, gravity: np.ndarray) -> np.ndarray:
    """Return coordinates (n,) of a part whose ports all move by a vector, without strain."""
    strain, count = part.strain, part.mass.shape[0]
    free = np.eye(count)
    if len(strain):
        _, size, vectors = np.linalg.svd(strain, full_matrices=True)
        free = vectors[int((size > UNBALANCED * size[0]).sum()) :].T
    wanted = [np.r_[p.axes.T @ gravity, np.zeros(3)] for p in part.ports.values()]
    rows = np.vstack([p.rows for p in part.ports.values()]) @ free
    motion, *_ = np.linalg.lstsq(rows, np.concatenate(wanted), rcond=UNBALANCED)
    miss = np.abs(rows @ motion - np.concatenate(wanted)).max()
    return free @ motion if miss <= 1e-6 * np.linalg.norm(gravity) else np.zeros(count)


def seats_of(part: str, scene: Scene, made: Mapping[str, Catalogued]) -> Seats:
    """Return the bearings that a shaft rests on in a system, free stations left out; those of
    catalogue data by ``part.name``.
    """
    catalogued = [b.name for b in scene.bearings if b.catalogue is not None]
    by_name = {name: made[f"{part}.{name}"] for name in catalogued}
    firm = scene.with_changes(bearings=tuple(map(_firm, scene.bearings)))
    holding = tuple(bearing for bearing in mounted(firm, by_name) if _holds(bearing))
    places = {b.name: b.y for b in scene.bearings}
    housing = scene.housing or scene.housing_axial
    return Seats(part, holding, tuple(places[bearing.port] for bearing in holding), housing)


def _firm(bearing: Bearing) -> Bearing:
    """Return a held seat with springs that Newton's search resolves beside those of the shaft."""
    if bearing.hold is None:
        return bearing
    return bearing.with_changes(
        hold=None, scale=1.0, matrix=np.minimum(bearing.stiffness, FIRM).tolist()
    )


def _holds(seat: Mounted) -> bool:
    """Return False for a free station, whose stiffness is zero."""
    stiffness = getattr(seat.bearing, "stiffness", None)
    return stiffness is None or bool(np.any(stiffness))
