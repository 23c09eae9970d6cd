"""Equilibrium of a shaft and the bearings: loads, tilts, and the stiffness at that point.

The free body is seen from the ports: the flexibility (inertia relief) and rigid motions give the
stiffness between them.  Torques about y are left out, and with them the free turning: they leave by
the drive, and no bearing feels them.  The rest is :mod:`solidgear.bearings.balance`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.bearings.balance import (
    FIVE,
    Balance,
    Mounted,
    between,
    common_feet,
    not_held,
)
from solidgear.bearings.newton import NothingHolds
from solidgear.core import SolidgearError, flexibility
from solidgear.core.scene.housing import Housing

if TYPE_CHECKING:
    from solidgear.core import Body


@dataclass(frozen=True)
class Equilibrium:
    """A shaft at rest under load."""

    ports: tuple[str, ...]  #: bearings in the order given, then loaded ports that carry none
    motion: dict[str, np.ndarray]  #: of ports, m and rad; thy is not solved for and is zero
    relative: dict[str, np.ndarray]  #: motion of each bearing's inner ring against its outer one
    load: dict[str, np.ndarray]  #: of the shaft on each bearing, N and N m
    tangent: dict[str, np.ndarray]  #: of each bearing alone, at that point
    lost: tuple[str, ...]  #: bearings that carry nothing
    unbalanced: float  #: largest imbalance, relative to the largest load or to the preloads
    iterations: int
    _state: np.ndarray = field(repr=False, default_factory=lambda: np.zeros(0))

    def moved_by(self, others: Iterable[Equilibrium]) -> Equilibrium:
        """Return this one as a search begins at it, moved by as much as each of some others is away."""
        away = (other._state - self._state for other in others)
        return replace(self, _state=sum(away, self._state))


def equilibrium(
    body: Body,
    bearings: Sequence[Mounted],
    loads: Mapping[str, Sequence[float] | np.ndarray],
    housing: float | Housing | None = None,
    start: Equilibrium | None = None,
    weight: tuple[np.ndarray, float] | None = None,
) -> Equilibrium:
    """Return the equilibrium of a shaft on bearings of any kind, under loads (6,) on ports by name,
    N and N m; torques about y pass on to the drive.

    A housing stands between all bearings and ground; a number is a spring along y, N/m. The search
    begins at `start`, an equilibrium of the same shaft under a load that is near; a load that
    nothing holds is refused. A `weight` (6,) at a place, m, is spread as the mass of the body: alone
    it strains no free body.
    """
    bearings = tuple(bearings)
    indices = [body.port_index(b.port, b.attachment) for b in bearings]
    if len(set(indices)) < len(bearings):
        raise SolidgearError("two bearings on one port: mount them as rows of one bearing")
    names = [b.port for b in bearings]
    for name in loads:
        if name not in names:
            names.append(name)
            indices.append(body.port_index(name))
    if not indices:
        raise SolidgearError("no bearing and no load: there is nothing to settle")
    rows = [6 * index + c for index in indices for c in FIVE]
    soft = flexibility(body).matrix[np.ix_(rows, rows)]
    size = np.tile([1.0, 1.0, 1.0, 1 / body.length, 1 / body.length], len(indices))
    elastic = between(soft, body.rigid_ports[rows], size)
    balance = Balance(
        elastic,
        bearings,
        common_feet(housing, {k: body.ports[indices[k]].y for k in range(len(bearings))}),
    )
    outside = np.zeros((len(names), 5))
    for name, load in loads.items():
        outside[names.index(name)] += np.asarray(load, float)[list(FIVE)]
    target = balance.elastic.basis.T @ outside.ravel()
    if weight is not None:
        carried_rigidly = _carried(weight, body, indices[0], rows, size)
        target = target + elastic.basis.T @ carried_rigidly
        # the same loads without the strain that these bring about
        bent = elastic.basis.T @ (soft @ carried_rigidly / size**2)
        target = target - elastic.stiffness * bent
    try:
        settled = balance.settle(target, None if start is None else start._state)
    except NothingHolds as error:
        raise SolidgearError(not_held(outside.sum(axis=0), error.direction)) from None
    motion = {name: np.zeros(6) for name in names}
    for name, five in zip(names, balance.places(settled.motion).reshape(-1, 5)):
        motion[name][list(FIVE)] = five
    relative, carried = (
        {b.port: value for b, value in zip(bearings, values)}
        for values in balance.carried(settled.motion)
    )
    return Equilibrium(
        ports=tuple(names),
        motion=motion,
        relative=relative,
        load=carried,
        tangent={b.port: b.bearing.tangent(relative[b.port]) for b in bearings},
        lost=tuple(name for name, load in carried.items() if not load.any()),
        unbalanced=settled.unbalanced,
        iterations=settled.iterations,
        _state=settled.motion,
    )


def _carried(
    weight: tuple[np.ndarray, float], body: Body, index: int, rows: list[int], size: np.ndarray
) -> np.ndarray:
    """Return loads (5 n,) on places that do the work of a weight on every rigid motion, by a port of
    the body and the motion of each place that counts as one metre.
    """
    six, y = weight
    arm = y - body.ports[index].y
    at_port = six + arm * np.array([0.0, 0.0, 0.0, six[2], 0.0, -six[0]])
    work = body.rigid_ports[6 * index : 6 * index + 6].T @ at_port
    scaled = body.rigid_ports[rows] / size[:, None]
    pushed, *_ = np.linalg.lstsq(scaled.T, work, rcond=1e-9)
    return pushed / size
