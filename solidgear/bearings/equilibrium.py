"""A shaft and its bearings in equilibrium: loads, tilts, and the stiffness at that point.

The free body is seen from its ports.  Its flexibility F (inertia relief) and rigid motions P give
the stiffness between ports

    K = Q (Q' F Q)^-1 Q',      Q a basis of the loads in equilibrium, P' Q = 0,

without any rigid motion in it; torques about y are left out, and with them the free turning: they
leave by the drive, and no bearing feels them.  Unknown are the motions d of the ports, of a ring w
on a spring or in a housing of its own, and of the housing of all, h, on its 6x6 H, which moves the
outer ring of bearing i by ``E_i h``.  With the contacts' energy V

    K d + sum of V'(d - w - E h) = load,      k_w w = V',      H h = sum of E' V',

the gradient of one convex energy: one equilibrium (:mod:`solidgear.bearings.newton`), however many
bearings there are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numpy as np
import scipy.linalg as sla

from solidgear.bearings.newton import NothingHolds, settle
from solidgear.bearings.rolling import UNITS
from solidgear.errors import SolidgearError
from solidgear.frames import DOF_NAMES
from solidgear.scene.housing import Elastic, Housing
from solidgear.solve.statics import flexibility

if TYPE_CHECKING:
    from solidgear.body import Body

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
        """Load (6,) that holds the shaft's seat at a motion (6,)."""

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Its derivative, (6, 6)."""

    def at_work(self, motion: np.ndarray) -> float:
        """Forces inside it at a motion, N, also those that balance each other."""


@dataclass(frozen=True)
class Linear:
    """A bearing of constant stiffness.

    Attributes
    ----------
    stiffness : (6, 6) ndarray
    """

    stiffness: np.ndarray

    def load(self, motion: np.ndarray) -> np.ndarray:
        """``K q``."""
        return motion @ self.stiffness

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """``K``."""
        return self.stiffness

    def at_work(self, motion: np.ndarray) -> float:
        """None: a spring has no preload."""
        return 0.0


@dataclass(frozen=True)
class Foot:
    """Something elastic that the outer ring of a bearing stands on.

    Attributes
    ----------
    moves : (6, k) ndarray
        Motion of the ring for unit motions in which it gives.
    stiffness : (k, k) ndarray
        Against these.
    """

    moves: np.ndarray
    stiffness: np.ndarray


def foot_of(housing: Elastic, moves: np.ndarray | None = None) -> Foot:
    """A housing as the equilibrium takes it.

    Parameters
    ----------
    housing : Elastic
    moves : (6, k) ndarray, optional
        Of the ring for unit motions in which the housing gives; by default both are at one point.

    Returns
    -------
    Foot
        Without turning about y where nothing resists that: no bearing brings a torque.
    """
    moves = np.eye(6)[:, housing.gives] if moves is None else moves
    keep = [k for k, c in enumerate(housing.gives) if c != 4 or housing.own[k, k] > 0]
    return Foot(moves[:, keep], housing.own[np.ix_(keep, keep)])


@dataclass(frozen=True)
class Mounted:
    """Carrier at a port.

    Attributes
    ----------
    port : str
    bearing : Holds
    attachment : str or None
        Of the port; None takes the body's first.
    spring : float or None
        In series with it along y, N/m.
    housing : Elastic or None
        That its outer ring alone stands in.
    """

    port: str
    bearing: Holds
    attachment: str | None = None
    spring: float | None = None
    housing: Elastic | None = None

    @property
    def feet(self) -> tuple[Foot, ...]:
        """Stiffness to ground of the shaft by itself."""
        spring = () if self.spring is None else (_along_y(Elastic, self.spring),)
        own = () if self.housing is None else (self.housing,)
        return tuple(foot_of(one) for one in (*spring, *own))


@dataclass(frozen=True)
class Equilibrium:
    """A shaft at rest under load.

    Attributes
    ----------
    ports : tuple of str
        Bearings in the order given, then loaded ports that carry none.
    motion : dict of str to (6,) ndarray
        Of ports, m and rad; thy is not solved for and is zero.
    relative : dict of str to (6,) ndarray
        Motion of each bearing's inner ring against its outer one.
    load : dict of str to (6,) ndarray
        What each bearing carries, N and N m: the load of the shaft on it.
    tangent : dict of str to (6, 6) ndarray
        Of each bearing alone, at that point.
    lost : tuple of str
        Bearings that carry nothing.
    unbalanced : float
        What is left of the loads, of the largest of them or of the preloads.
    iterations : int
    """

    ports: tuple[str, ...]
    motion: dict[str, np.ndarray]
    relative: dict[str, np.ndarray]
    load: dict[str, np.ndarray]
    tangent: dict[str, np.ndarray]
    lost: tuple[str, ...]
    unbalanced: float
    iterations: int
    _state: np.ndarray = field(repr=False, default_factory=lambda: np.zeros(0))


def port_stiffness(body: Body, rows: Sequence[int]) -> np.ndarray:
    """Stiffness of the free body between port components; it resists no rigid motion.

    Parameters
    ----------
    body : Body
    rows : sequence of int
        Places among the body's port components, without those of thy.

    Returns
    -------
    (n, n) ndarray
        Symmetric positive semidefinite, SI.
    """
    rows = list(rows)
    size = np.where(np.isin(np.array(rows) % 6, (3, 5)), 1 / body.length, 1.0)
    rigid = body.rigid_ports[rows] / size[:, None]
    left, value, _ = np.linalg.svd(rigid)
    free = left[:, int((value > 1e-9 * value[0]).sum()) :]
    soft = flexibility(body).matrix[np.ix_(rows, rows)] / np.outer(size, size)
    inner = free.T @ soft @ free
    own, vector = np.linalg.eigh((inner + inner.T) / 2)
    own = np.maximum(own, RIGID * own[-1]) if own.size else own
    basis = (free @ vector) / np.sqrt(own) / size[:, None]
    return basis @ basis.T


def equilibrium(
    body: Body,
    bearings: Sequence[Mounted],
    loads: Mapping[str, Sequence[float] | np.ndarray],
    housing: float | Housing | None = None,
    start: Equilibrium | None = None,
) -> Equilibrium:
    """Equilibrium of a shaft on bearings of any kind.

    Parameters
    ----------
    body : Body
        Any, whose ports carry the bearings and the loads.
    bearings : sequence of Mounted
    loads : mapping of str to (6,) array_like
        Loads on ports by name, N and N m; torques about y pass on to the drive.
    housing : float or Housing, optional
        Between all bearings and ground; a number is a spring along y, N/m.
    start : Equilibrium, optional
        One of the same shaft to begin at, under a load that is near.

    Returns
    -------
    Equilibrium

    Raises
    ------
    SolidgearError
        If nothing holds the shaft against a load.

    Examples
    --------
    >>> import numpy as np
    >>> import solidgear as sg
    >>> from solidgear.bearings.ball import BallRow
    >>> from solidgear.bearings.rolling import RollingBearing
    >>> body = sg.build(sg.load("geometry/shaft_stepped.toml"), "timoshenko")
    >>> balls = RollingBearing((BallRow(count=9, diameter=12e-3, pitch=60e-3),))
    >>> found = equilibrium(body, [Mounted("A", balls), Mounted("B", balls)],
    ...                     {"port": [0, 0, 2000.0, 0, 0, 0]})
    >>> round(float(found.load["A"][2] + found.load["B"][2]), 6)
    2000.0
    """
    system = _System(body, bearings, loads, housing)
    begin = start._state if start is not None and start._state.size == system.count else None
    try:
        found = settle(
            system.load, system.tangent, system.target, system.size, begin, system.at_work(begin)
        )
    except NothingHolds as error:
        raise SolidgearError(system.not_held(error.direction)) from None
    if found.unbalanced > LEFT:
        raise SolidgearError(
            f"shaft and bearings find no equilibrium: {found.unbalanced:.1e} of the load is left"
        )
    return system.told(found.motion, found.unbalanced, found.iterations)


def _along_y(kind: type[E], spring: float) -> E:
    """A housing that gives along y only."""
    given: dict[str, Any] = {"stiffness": {"kyy": spring}}
    return kind(**given)


class _System:
    """Unknowns, loads and tangents of a shaft with what holds it."""

    def __init__(self, body: Body, bearings, loads, housing):
        self.bearings = tuple(bearings)
        places = {(b.port, b.attachment): body.port_index(b.port, b.attachment) for b in bearings}
        if len(set(places.values())) < len(self.bearings):
            raise SolidgearError("two bearings on one port: mount them as rows of one bearing")
        self.names = [b.port for b in self.bearings]
        indices = [places[b.port, b.attachment] for b in self.bearings]
        for name in loads:
            if name not in self.names:
                self.names.append(name)
                indices.append(body.port_index(name))
        if not indices:
            raise SolidgearError("no bearing and no load: there is nothing to settle")
        rows = [6 * index + c for index in indices for c in FIVE]
        self.stiffness = port_stiffness(body, rows)
        self.ports = len(rows)
        feet = [foot for bearing in self.bearings for foot in bearing.feet]
        own = [foot.stiffness for foot in feet]
        if housing is not None:
            around = housing if isinstance(housing, Housing) else _along_y(Housing, housing)
            below = [foot_of(around, around.moves(body.ports[k].y)) for k in indices]
            own.append(below[0].stiffness)
        self.own = sla.block_diag(*own) if own else np.zeros((0, 0))
        self.count = self.ports + len(self.own)
        self.reads = []
        at = self.ports
        for k, bearing in enumerate(self.bearings):
            read = np.zeros((6, self.count))
            read[FIVE, 5 * k + np.arange(5)] = 1.0
            for foot in bearing.feet:
                read[:, at : at + len(foot.stiffness)] = -foot.moves
                at += len(foot.stiffness)
            if housing is not None:
                read[:, self.count - len(own[-1]) :] = -below[k].moves
            self.reads.append(read)
        self.size = np.ones(self.count)
        self.size[: self.ports] = np.tile(
            [1.0, 1.0, 1.0, 1 / body.length, 1 / body.length], len(indices)
        )
        self.target = np.zeros(self.count)
        for name, load in loads.items():
            at = 5 * self.names.index(name)
            self.target[at : at + 5] += np.asarray(load, float)[list(FIVE)]

    def load(self, at: np.ndarray) -> np.ndarray:
        """Gradient of the energy without the loads'."""
        out = np.concatenate([self.stiffness @ at[: self.ports], self.own @ at[self.ports :]])
        for bearing, read in zip(self.bearings, self.reads):
            out = out + read.T @ bearing.bearing.load(read @ at)
        return out

    def at_work(self, at: np.ndarray | None) -> float:
        """Forces inside the bearings, N; at rest those of their preloads."""
        at = np.zeros(self.count) if at is None else at
        return sum(b.bearing.at_work(read @ at) for b, read in zip(self.bearings, self.reads))

    def tangent(self, at: np.ndarray) -> np.ndarray:
        """Its Hessian."""
        out = sla.block_diag(self.stiffness, self.own)
        for bearing, read in zip(self.bearings, self.reads):
            out = out + read.T @ bearing.bearing.tangent(read @ at) @ read
        return out

    def not_held(self, direction: np.ndarray) -> str:
        """Error of a search that found no equilibrium."""
        component = DOF_NAMES[FIVE[int(np.argmax(np.abs(direction[: self.ports]))) % 5]]
        pushes = self.target[: self.ports].reshape(-1, 5)
        sums = " and ".join(
            f"{v:.6g} {UNITS[c]} in {DOF_NAMES[c]}"
            for c, v in zip(FIVE, pushes.sum(axis=0))
            if v != 0.0
        )
        return (
            f"no bearing holds the shaft in {component} under {sums or 'its preloads'}: "
            "it is pushed out of its bearings; turn one round, or preload them"
        )

    def told(self, at: np.ndarray, unbalanced: float, iterations: int) -> Equilibrium:
        """The equilibrium by names."""
        motion = {}
        for k, name in enumerate(self.names):
            motion[name] = np.zeros(6)
            motion[name][list(FIVE)] = at[5 * k : 5 * k + 5]
        relative = {b.port: read @ at for b, read in zip(self.bearings, self.reads)}
        load = {b.port: b.bearing.load(relative[b.port]) for b in self.bearings}
        tangent = {b.port: b.bearing.tangent(relative[b.port]) for b in self.bearings}
        lost = tuple(name for name, carried in load.items() if not carried.any())
        names = tuple(self.names)
        return Equilibrium(names, motion, relative, load, tangent, lost, unbalanced, iterations, at)
