r"""Stability of periodic motions by Floquet's multipliers.

Small motions beside a periodic one obey ``y' = A(t) y`` with the tangents of the laws along it.
Over a period they are taken by the monodromy matrix, whose eigenvalues, the multipliers, lie within
the unit circle where the motion is stable. One leaves through +1 at a turning point, through -1
where the period doubles, a pair elsewhere where a second frequency comes in.

Of laws of straight pieces A is constant between crossings, whose instants are roots of the Fourier
series: the product of matrix exponentials is exact.  Where a damper in contact begins at once, the
force leaps, and small motions with it (saltation).
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla

from solidgear.backlash.solver.continuation import Point
from solidgear.backlash.solver.model import Remainder
from solidgear.backlash.solver.pieces import Pieces
from solidgear.core import pinned

#: a multiplier beyond the unit circle by less is on it: digits of a crossing
ON = 1e-7
#: steps of Newton's method that locate a crossing between two instants
STEPS = 4


@pinned
def multipliers(point: Point) -> np.ndarray:
    """Return the Floquet multipliers (2r,) of a periodic motion, largest first."""
    remainder = point.balance.remainder
    if all(law.pieces for law, _ in remainder.laws) and not remainder.varies:
        matrix = _by_pieces(point)
    else:
        matrix = _by_instants(point)
    value = np.linalg.eigvals(matrix)
    return value[np.argsort(-np.abs(value), kind="stable")]


def stable(point: Point) -> bool:
    """Return whether small motions beside a periodic one die away."""
    return bool(np.abs(multipliers(point)[0]) <= 1 + ON)


def _by_pieces(point: Point) -> np.ndarray:
    remainder, omega = point.balance.remainder, point.omega
    pieces = Pieces(remainder, omega)
    s, _ = point.waves()
    crossings = sorted(_crossings(point, s, pieces.edges))
    period = 2 * np.pi / omega
    names = [pieces.name(s[0])]
    for _, row, side in crossings:
        names.append(tuple(w + side * (j == row) for j, w in enumerate(names[-1])))
    straights = [pieces.straight(name) for name in names]
    out = np.eye(2 * len(remainder.omega))
    times = [0.0, *(angle / omega for angle, _, _ in crossings), period]
    for k, (before, after) in enumerate(zip(times, times[1:])):
        stiffness, damper, _ = straights[k]
        more, drag = remainder.stiffness - np.diag(stiffness), remainder.damper - np.diag(damper)
        out = sla.expm((after - before) * remainder.generator(more, drag)) @ out
        if k < len(crossings) and remainder.drags:
            jump = np.diag(straights[k + 1][1] - damper)
            out = _saltation(point, crossings[k], jump) @ out
    return out


def _crossings(point: Point, s: np.ndarray, edges: list[np.ndarray]):
    """Yield angle, row and side (1 to the next piece, -1 to the last) of every crossing in a
    period.
    """
    step = 2 * np.pi / len(s)
    for row, row_edges in enumerate(edges):
        for edge in row_edges:
            gap = s[:, row] - edge
            # the edge itself belongs to the lower piece
            above = gap > 0
            for k in np.flatnonzero(above != np.roll(above, -1)):
                after = gap[(k + 1) % len(s)]
                angle = step * (k + gap[k] / (gap[k] - after))
                for _ in range(STEPS):
                    value, slope = _wave(point, angle)
                    new = angle - (value[row] - edge) / slope[row]
                    angle = float(np.clip(new, step * k, step * (k + 1)))
                yield angle, row, -1 if above[k] else 1


def _wave(point: Point, angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Return stretches (m,) and their slopes over the angle at one angle."""
    harmonics = point.harmonics
    n = 1j * np.arange(len(harmonics))[:, None]
    turned = harmonics * np.exp(n * angle)
    return turned.sum(axis=0).real, (n * turned).sum(axis=0).real


def _saltation(point: Point, crossing: tuple[float, int, int], jump: np.ndarray) -> np.ndarray:
    """Return the leap (2r, 2r) of small motions where the damping force of a row sets in or ends."""
    remainder = point.balance.remainder
    angle, row, _ = crossing
    rate = point.omega * _wave(point, angle)[1]
    r = len(remainder.omega)
    out = np.eye(2 * r)
    leap = -remainder.shapes.T @ jump @ rate
    out[r:, :r] += np.outer(leap, remainder.shapes[row] / remainder.omega) / rate[row]
    return out


def _by_instants(point: Point) -> np.ndarray:
    remainder = point.balance.remainder
    line = point.balance.line(point.omega)
    tangent, _ = remainder.excess(*point.waves(), point.balance.factor, line)
    return over_cycle(remainder, point.omega, tangent.by_stretch, tangent.by_rate)


def over_cycle(
    remainder: Remainder, omega: float, by_stretch: np.ndarray, by_rate: np.ndarray
) -> np.ndarray:
    """Return the monodromy (2r, 2r) by the midpoint rule, from the tangents of the excess (T, m, m)
    at equal intervals of a period.
    """
    half = np.pi / omega / len(by_stretch)
    # among the poles of the laws' tangents a step is diagonal but for the few rows of the excess
    poles, right, inputs, outputs = remainder.modes
    still = np.linalg.inv(np.eye(remainder.rows) - remainder.flexible @ by_stretch)
    excess = np.stack([by_stretch @ still, by_rate @ still], axis=1)
    rows = np.einsum("tkab,kbn->tan", excess, outputs)
    near = 1 / (1 - half * poles)
    pushed = half * near[:, None] * inputs
    cores = np.linalg.inv(np.eye(remainder.rows) - rows @ pushed)
    out = np.eye(len(poles), dtype=complex)
    for row, core in zip(rows, cores):
        middle = near[:, None] * out
        middle += pushed @ (core @ (row @ middle))
        out = 2 * middle - out
    return (right @ out @ np.linalg.inv(right)).real
