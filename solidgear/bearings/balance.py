"""Balance of bearings on something elastic: contacts and springs that press, on one energy.

Motions d of the ports, of a ring on a spring or in a housing of its own, w, and of a housing of
several, h, on its 6x6 H, which moves the outer ring of bearing i by ``E_i h``, are unknown. With
the contacts' energy V and the stiffness K between the ports

    K d + sum of V'(d - w - E h) = load,      k_w w = V',      H h = sum of E' V',

the gradient of one convex energy: one equilibrium (:mod:`solidgear.bearings.newton`), however many
bearings there are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np
import scipy.linalg as sla

from solidgear.bearings.newton import NothingHolds, Settled, settle
from solidgear.bearings.rolling import UNITS
from solidgear.core import DOF_NAMES, SolidgearError
from solidgear.core.scene.housing import Elastic, Housing

E = TypeVar("E", bound=Elastic)

#: components of a port that are solved for
FIVE = (0, 1, 2, 3, 5)
#: of the largest: flexibility between ports that is none
RIGID = 1e-13
#: of the load
LEFT = 1e-8


class Holds(Protocol):
    """Carrier of load at a port: a rolling bearing, or a spring."""

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load (6,) that holds the shaft's seat at a motion (6,)."""

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the derivative of the load, (6, 6)."""

    def at_work(self, motion: np.ndarray) -> float:
        """Return the forces inside the bearing at a motion, N, also those that balance each other."""


@dataclass(frozen=True)
class Linear:
    """A bearing of constant stiffness."""

    stiffness: np.ndarray  #: (6, 6)

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return ``K q``."""
        return motion @ self.stiffness

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return ``K``."""
        return self.stiffness

    def at_work(self, motion: np.ndarray) -> float:
        """Return zero: a spring has no preload."""
        return 0.0


@dataclass(frozen=True)
class Foot:
    """Something elastic that the outer ring of a bearing stands on."""

    moves: np.ndarray  #: (6, k) motion of the ring for unit motions in which it gives
    stiffness: np.ndarray  #: (k, k) against these


def foot_of(housing: Elastic, moves: np.ndarray | None = None) -> Foot:
    """Return a housing as the equilibrium takes it, by the (6, k) motion of the ring for unit
    motions in which it gives (by default both are at one point); without turning about y where
    nothing resists that: no bearing brings a torque.
    """
    moves = np.eye(6)[:, housing.gives] if moves is None else moves
    keep = [k for k, c in enumerate(housing.gives) if c != 4 or housing.own[k, k] > 0]
    return Foot(moves[:, keep], housing.own[np.ix_(keep, keep)])


@dataclass(frozen=True)
class Mounted:
    """Carrier at a port."""

    port: str
    bearing: Holds
    attachment: str | None = None  #: of the port; None takes the body's first
    spring: float | None = None  #: in series with it along y, N/m
    housing: Elastic | None = None  #: that its outer ring alone stands in

    @property
    def feet(self) -> tuple[Foot, ...]:
        """Stiffness to ground of the shaft by itself."""
        spring = () if self.spring is None else (_along_y(Elastic, self.spring),)
        housing = () if self.housing is None else (self.housing,)
        return tuple(foot_of(part) for part in (*spring, *housing))


class Between(NamedTuple):
    """Elastic behaviour of something free between n places where it is seen."""

    basis: np.ndarray  #: (n, r) motions of the places that are possible at all, one a column
    stiffness: np.ndarray  #: (r,) against each of them, N/m; zero for rigid motions
    size: np.ndarray  #: (n,) motion of each place that counts as one metre


def between(soft: np.ndarray, rigid: np.ndarray, size: np.ndarray) -> Between:
    """Return principal stiffnesses of something free, ``Q (Q' F Q)^-1 Q'`` between places, from the
    flexibility F (n, n) under loads in equilibrium, motions P (n, z) that strain nothing, ``P' Q =
    0``, and the motion (n,) of each place that counts as one metre.

    Examples
    --------
    A spring of 1e6 N/m with two ends, which both flexibilities of inertia relief make:

    >>> import numpy as np
    >>> pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    >>> basis, stiffness, _ = between(2.5e-7 * pair, np.ones((2, 1)), np.ones(2))
    >>> bool(np.allclose(basis * stiffness @ basis.T, 1e6 * pair))
    True
    """
    rotation, value, _ = np.linalg.svd(rigid / size[:, None])
    rank = int((value > 1e-9 * value.max(initial=0.0)).sum())
    free = rotation[:, rank:]
    scaled = soft / np.outer(size, size)
    inner = free.T @ scaled @ free
    eigenvalues, vector = np.linalg.eigh((inner + inner.T) / 2)
    flexible = eigenvalues > RIGID * np.abs(scaled).max(initial=0.0)
    basis = np.hstack([rotation[:, :rank], free @ vector[:, flexible]])
    return Between(size[:, None] * basis, np.r_[np.zeros(rank), 1 / eigenvalues[flexible]], size)


def _along_y(kind: type[E], spring: float) -> E:
    """Return a housing that gives along y only."""
    fields: dict[str, Any] = {"stiffness": {"kyy": spring}}
    return kind(**fields)


class Balance:
    """Unknowns, loads and tangents of bearings on something elastic, at the first places of
    `elastic`, five components each, with housings of several bearings.

    Unknown are the motions between the places of the bearings, then those of the parts that the
    outer rings stand in.
    """

    def __init__(
        self,
        elastic: Between,
        bearings: Sequence[Mounted],
        housings: Sequence[Mapping[int, Foot]] = (),
    ):
        self.elastic, self.bearings = elastic, tuple(bearings)
        self.motions = len(elastic.stiffness)
        feet = [foot for bearing in self.bearings for foot in bearing.feet]
        commons = [next(iter(stiffnesses.values())) for stiffnesses in housings]
        feet_of_housing = [foot.stiffness for foot in (*feet, *commons)]
        self.own = sla.block_diag(np.diag(elastic.stiffness), *feet_of_housing)
        self.count = len(self.own)
        self.reads = [np.zeros((6, self.count)) for _ in self.bearings]
        column = self.motions
        for k, (read, bearing) in enumerate(zip(self.reads, self.bearings)):
            read[FIVE, : self.motions] = elastic.basis[5 * k : 5 * k + 5]
            for foot in bearing.feet:
                read[:, column : column + len(foot.stiffness)] = -foot.moves
                column += len(foot.stiffness)
        for common, feet_by_bearing in zip(commons, housings):
            for k, foot in feet_by_bearing.items():
                self.reads[k][:, column : column + len(foot.stiffness)] = -foot.moves
            column += len(common.stiffness)

    def places(self, state: np.ndarray) -> np.ndarray:
        """Return (n,) motions of the places."""
        return self.elastic.basis @ state[: self.motions]

    def load(self, state: np.ndarray) -> np.ndarray:
        """Return the gradient of the energy of bearings and elastic parts."""
        out = self.own @ state
        for bearing, read in zip(self.bearings, self.reads):
            out = out + read.T @ bearing.bearing.load(read @ state)
        return out

    def at_work(self, state: np.ndarray | None) -> float:
        """Return the forces inside the bearings, N; at rest those of their preloads."""
        state = np.zeros(self.count) if state is None else state
        return sum(b.bearing.at_work(read @ state) for b, read in zip(self.bearings, self.reads))

    def tangent(self, state: np.ndarray) -> np.ndarray:
        """Return the Hessian of the energy."""
        out = self.own.copy()
        for bearing, read in zip(self.bearings, self.reads):
            out = out + read.T @ bearing.bearing.tangent(read @ state) @ read
        return out

    def settle(self, target: np.ndarray, start: np.ndarray | None = None) -> Settled:
        """Return the motion at which loads (r,) on the motions between the places are carried;
        loads that no bearing holds are refused with the direction of the places, in metres.
        """
        begin = start if start is not None and start.size == self.count else None
        goal = np.r_[target, np.zeros(self.count - self.motions)]
        size = np.ones(self.count)
        try:
            settled = settle(self.load, self.tangent, goal, size, begin, self.at_work(begin))
        except NothingHolds as error:
            direction = self.places(error.direction) / self.elastic.size
            raise NothingHolds(str(error), direction) from None
        if settled.unbalanced > LEFT:
            raise SolidgearError(
                f"shaft and bearings find no equilibrium: {settled.unbalanced:.1e} of the load is left"
            )
        return settled

    def carried(self, state: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """Return the motion (6,) of each bearing's inner ring against its outer one, and its load
        (6,).
        """
        relative = [read @ state for read in self.reads]
        return relative, [b.bearing.load(q) for b, q in zip(self.bearings, relative)]


def common_feet(
    housing: float | Housing | None, places: Mapping[int, float]
) -> list[Mapping[int, Foot]]:
    """Return the feet of bearings at places along the shaft (m) in a housing of all of them; a
    number is a spring along y, N/m.
    """
    if housing is None or not places:
        return []
    shared = housing if isinstance(housing, Housing) else _along_y(Housing, housing)
    return [{k: foot_of(shared, shared.moves(y)) for k, y in places.items()}]


def not_held(sums: np.ndarray, direction: np.ndarray) -> str:
    """Return a sentence on a load that no bearing holds: the sum of all loads (5,) on the shaft, N
    and N m in the order of `FIVE`, and the direction (5 p,) in which the places went.
    """
    component = DOF_NAMES[FIVE[int(np.argmax(np.abs(direction))) % 5]]
    pushes = " and ".join(
        f"{v:.6g} {UNITS[c]} in {DOF_NAMES[c]}" for c, v in zip(FIVE, sums) if v != 0.0
    )
    return (
        f"no bearing holds the shaft in {component} under {pushes or 'its preloads'}: "
        f"it is {pushed_out(component)}"
    )


def pushed_out(component: str) -> str:
    """Return the end of a sentence on a component in which no bearing holds, with the remedy."""
    remedy = "turn one round, let one locate" if component == "y" else "turn one round"
    return f"pushed out of its bearings; {remedy}, or preload them"
