r"""Loads on the cells of contact lines: a small complementarity problem.

With the compliance C of the teeth between cells, what gives way where they touch ``d(f)``, the gaps g
and the levers l about the first wheel's axis, forces f and the rotation theta of that wheel satisfy

    w = C f + d(f) + g - l theta >= 0,    f >= 0,    f w = 0,    l f = T,

so that teeth touch where they push and nowhere pull.  What carries the wheels adds ``H S H'`` to C,
with its compliance S and the rows H by which its motions open the cells, and its motion m under all
other loads adds ``H m`` to g.  Newton takes d by its tangent; each linear problem
is solved by the cells that touch, of which those that would pull are dropped and those that would cut
into each other are added, all at once, and in the order of their numbers if that goes round, which
ends for every matrix of positive principal minors (Murty, Linear Complementarity, 1988, 3.2).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.core import SolidgearError
from solidgear.teeth.contact.cells import Carrying, Cells, ToothedPair
from solidgear.teeth.contact.frame import RigidSupports
from solidgear.teeth.contact.local import LineContact

#: wheels that are held
RIGID = RigidSupports(np.zeros((6, 6)), np.zeros(6))
#: relative change of forces at which Newton ends, and overlap of the rotation that is none
NEWTON, OVERLAP = 1e-11, 1e-11
#: steps of Newton, and changes of the cells that touch before they change one at a time
MOST_STEPS, MOST_CHANGES = 60, 40


@dataclass(frozen=True, eq=False)
class Loads:
    """Loads on the cells at one position under a torque on the first wheel."""

    cells: Cells
    law: LineContact
    torque: float  #: N m
    force: np.ndarray  #: (n,) N
    rotation: float  #: of the first wheel under the torque, the second one held, rad
    #: of the first touch without load: of the flanks alone, with the supports where the load has
    #: brought them, and with the supports at rest, rad
    touch: float
    supported_touch: float
    #: rotation per torque about this state: of the teeth alone, and with their supports, rad/(N m)
    slope: float
    supported_slope: float
    steps: int  #: of Newton

    @cached_property
    def wrench(self) -> np.ndarray:
        """(6,) force and moment on the first wheel at the origin, N and N m."""
        return self.force @ self.cells.rows

    @cached_property
    def total(self) -> float:
        """Size of the force of all cells, N."""
        return float(np.linalg.norm(self.wrench[:3]))

    @property
    def line_of_action(self) -> np.ndarray:
        """(3,) unit direction of the force on the first wheel."""
        return self.wrench[:3] / self.total

    @property
    def point(self) -> np.ndarray:
        """(3,) mean of the cells by their forces, the mesh point, m."""
        return self.force @ self.cells.point / self.force.sum()

    @property
    def arm(self) -> float:
        """Lever of the line of action about the first wheel's axis, m."""
        return self.torque / self.total

    @property
    def secant(self) -> float:
        """Stiffness of the teeth alone along the line of action from first touch to load, N/m."""
        return self.total / ((self.rotation - self.touch) * self.arm)

    @property
    def tangent(self) -> float:
        """Stiffness of the teeth alone along the line of action about the load, N/m: what a train
        needs, whose shafts give way by themselves.
        """
        return 1 / (self.slope * self.arm**2)

    @property
    def supported_secant(self) -> float:
        """Stiffness of teeth and supports from first touch to load, N/m."""
        return self.total / ((self.rotation - self.supported_touch) * self.arm)

    @property
    def supported_tangent(self) -> float:
        """Stiffness of teeth and supports about the load, N/m."""
        return 1 / (self.supported_slope * self.arm**2)

    @property
    def line_load(self) -> np.ndarray:
        """(n,) force per length of contact line, N/m."""
        return self.force / self.cells.length

    @property
    def pressure(self) -> np.ndarray:
        """(n,) largest Hertz pressure of every cell, N/m^2."""
        return self.law.pressure(self.line_load, self.cells.radius)

    @property
    def shares(self) -> dict[int, float]:
        """Share of the force by contact line, of those that carry."""
        lines = np.unique(self.cells.line[self.force > 0])
        total = self.force.sum()
        return {int(k): float(self.force[self.cells.line == k].sum() / total) for k in lines}


def loads(
    pair: ToothedPair,
    torque: float,
    phase: float,
    supports: Carrying | None = None,
) -> Loads:
    """Compute the loads on all cells at a position.

    Parameters
    ----------
    pair : ToothedPair
    torque : float
        On the first wheel, above zero, N m.
    phase : float
        Position in pitches.
    supports : Carrying, optional
        What carries both wheels, and how it has moved them; by default both are held.

    Raises
    ------
    SolidgearError
        For a torque that does not press the flanks together.
    """
    if not torque > 0:
        raise SolidgearError(
            f"a torque of {torque:.4g} N m lifts these flanks off each other; give one above zero, "
            "or the other flank"
        )
    cells = pair.cells(phase)
    teeth = pair.bulk(cells)
    carrying = RIGID if supports is None else supports
    rows = carrying.rows(cells)
    gap = cells.gap + rows @ carrying.motion
    bulk = teeth + rows @ carrying.compliance @ rows.T
    force, rotation, steps = _newton(cells, pair.law, bulk, gap, torque)
    moved = gap + rows @ (carrying.compliance @ (rows.T @ force))
    loaded = np.flatnonzero(force > 0)
    _, tangent = pair.law.compliances(force / cells.length, cells.radius, cells.lean)
    local = np.diag(tangent / cells.length)
    slopes = [
        _solved(matrix + local, cells.lever, loaded, np.zeros(len(loaded)), 1.0)[-1]
        for matrix in (teeth, bulk)
    ]
    return Loads(
        cells=cells,
        law=pair.law,
        torque=torque,
        force=force,
        rotation=rotation,
        touch=float((moved / cells.lever).min()),
        supported_touch=float((gap / cells.lever).min()),
        slope=float(slopes[0]),
        supported_slope=float(slopes[1]),
        steps=steps,
    )


def _newton(
    cells: Cells, law: LineContact, bulk: np.ndarray, gap: np.ndarray, torque: float
) -> tuple[np.ndarray, float, int]:
    """Return forces, rotation and steps of Newton on what gives way where cells touch."""
    lever, length = cells.lever, cells.length
    force = np.full(len(lever), torque / lever.sum())
    touching = np.ones(len(lever), bool)
    for step in range(1, MOST_STEPS + 1):
        secant, tangent = law.compliances(force / length, cells.radius, cells.lean)
        matrix = bulk + np.diag(tangent / length)
        offset = gap + (secant - tangent) / length * force
        before = force
        force, rotation, touching = _linear(matrix, offset, lever, torque, touching)
        if np.abs(force - before).max() < NEWTON * torque / lever.mean():
            return force, rotation, step
    raise SolidgearError(
        f"the loads on the teeth did not settle in {MOST_STEPS} steps under {torque:.4g} N m"
    )


def _solved(
    matrix: np.ndarray, lever: np.ndarray, cells: np.ndarray, approach: np.ndarray, torque: float
) -> np.ndarray:
    """Return the forces of some cells, and the rotation behind them, of approaches and a torque."""
    n = len(cells)
    bordered = np.zeros((n + 1, n + 1))
    bordered[:n, :n] = matrix[np.ix_(cells, cells)]
    bordered[:n, n], bordered[n, :n] = -lever[cells], lever[cells]
    # in units in which both blocks are of like size
    scale = np.concatenate([np.ones(n), [float(np.diag(bordered)[:n].mean())]])
    right = np.concatenate([approach, [torque]])
    return np.linalg.solve(bordered * scale, right) * scale


def _linear(
    matrix: np.ndarray,
    offset: np.ndarray,
    lever: np.ndarray,
    torque: float,
    touching: np.ndarray,
) -> tuple[np.ndarray, float, np.ndarray]:
    """Return forces, rotation and the cells that touch of one linear complementarity problem."""
    touching, change = touching.copy(), 0
    force = np.zeros(len(lever))
    while True:
        cells = np.flatnonzero(touching)
        result = _solved(matrix, lever, cells, -offset[cells], torque)
        force[:] = 0.0
        force[cells], rotation = result[:-1], float(result[-1])
        pulling = touching & (force < 0)
        overlap = matrix @ force + offset - lever * rotation
        cutting = ~touching & (overlap < -OVERLAP * abs(rotation) * lever)
        wrong = pulling if pulling.any() and change < MOST_CHANGES else pulling | cutting
        if not wrong.any():
            return force, rotation, touching
        if change >= MOST_CHANGES:
            wrong = np.arange(len(wrong)) == int(np.argmax(wrong))
        touching ^= wrong
        change += 1
