"""Equilibrium of a shaft and the bearings: loads, tilts, and the stiffness at that point.

The free body is seen from the ports: the flexibility (inertia relief) and rigid motions give the
stiffness between them.  Torques about y are left out, and with them the free turning: they leave by
the drive, and no bearing feels them.  The rest is :mod:`solidgear.bearings.balance`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
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


def equilibrium(
    body: Body,
    bearings: Sequence[Mounted],
    loads: Mapping[str, Sequence[float] | np.ndarray],
    housing: float | Housing | None = None,
    start: Equilibrium | None = None,
) -> Equilibrium:
    """Return the equilibrium of a shaft on bearings of any kind, under loads (6,) on ports by name,
    N and N m; torques about y pass on to the drive.

    A housing stands between all bearings and ground; a number is a spring along y, N/m. The search
    begins at `start`, an equilibrium of the same shaft under a load that is near; a load that
    nothing holds is refused.
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
    balance = Balance(
        between(
            flexibility(body).matrix[np.ix_(rows, rows)],
            body.rigid_ports[rows],
            np.tile([1.0, 1.0, 1.0, 1 / body.length, 1 / body.length], len(indices)),
        ),
        bearings,
        common_feet(housing, {k: body.ports[indices[k]].y for k in range(len(bearings))}),
    )
    outside = np.zeros((len(names), 5))
    for name, load in loads.items():
        outside[names.index(name)] += np.asarray(load, float)[list(FIVE)]
    target = balance.elastic.basis.T @ outside.ravel()
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
