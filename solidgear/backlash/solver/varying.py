r"""Mesh stiffness and line of action that vary over the mesh cycle, and where that alone makes
motions grow.

Teeth that keep contact, with ``k (1 + c(t))`` along a line that turns, make a linear system with
periodic coefficients. Near speeds at which the excitation, or a multiple of it, is the sum of two
natural frequencies or twice one, its motions grow by themselves (tongues of Mathieu and Hill), as
Floquet's multipliers show. Edges at which a multiplier is +1 or -1 have a motion that repeats
itself after one cycle or two,

    s_h - H(h w) (P s)_h = 0,        h = ..., -1, 0, 1, ...   or   ..., -1/2, 1/2, 3/2, ...

with P the tangent of the excess at every instant, so that Hill's determinant is zero there, from
receptances alone.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq

from solidgear.backlash.solver.model import Remainder
from solidgear.backlash.solver.stability import over_cycle
from solidgear.core import pinned

#: instants of a cycle, and harmonics of Hill's determinant on either side
INSTANTS, HARMONICS = 512, 8
#: places between two speeds at which the determinant is looked at
PLACES = 400


def growth(remainder: Remainder, omega: float) -> complex:
    """Return the largest Floquet multiplier of teeth that keep contact, at a frequency of the
    cycle, rad/s.

    Examples
    --------
    Mathieu's equation at twice its natural frequency:

    >>> from solidgear.backlash.solver.model import remainder
    >>> from solidgear.core.system import Inertia, RowSpring, System
    >>> from solidgear.core.system.law import Gap
    >>> teeth = RowSpring("gear", [0, 0, 1, 0, 0, 0], 1.0, law=Gap(1.0, 0.0))
    >>> pair = System({"gear": Inertia(1.0, "z")}, {"mesh": teeth})
    >>> found = remainder(pair, cycles={"mesh": [0.2]})
    >>> bool(abs(growth(found, 2.0)) > 1), bool(abs(growth(found, 1.7)) > 1 + 1e-9)
    (True, False)
    """
    more, drag = _varied(remainder, omega)
    value = np.linalg.eigvals(over_cycle(remainder, omega, more, drag))
    return complex(value[np.abs(value).argmax()])


def _varied(remainder: Remainder, omega: float) -> tuple[np.ndarray, np.ndarray]:
    """Return tangents (INSTANTS, m, m) of the excess of teeth that keep contact, over stretch and
    rate.
    """
    angle = 2 * np.pi * np.arange(INSTANTS) / INSTANTS
    line, factor = remainder.line(angle, omega), remainder.factor(angle)[..., None]
    stiffness, damper = remainder.stiffness, remainder.damper
    if line is None:
        return stiffness - factor * stiffness, damper - factor * damper
    # the tangent of a law is that of the first row of its link, shared out to all its rows
    on_line = np.tile(np.eye(remainder.rows), (INSTANTS, 1, 1))
    drift = np.zeros_like(on_line)
    for rows in line.links:
        on_line[:, rows.start, rows], drift[:, rows.start, rows] = (
            line.share[:, rows],
            line.slope[:, rows],
        )
    out = factor * on_line.transpose(0, 2, 1)
    return stiffness - out @ (stiffness @ on_line + damper @ drift), damper - out @ damper @ on_line


def hill(remainder: Remainder, omega: float, half: bool, count: int = HARMONICS) -> float:
    """Return Hill's determinant with `count` harmonics on either side; it changes sign where a
    multiplier is +1, or -1 with `half`.
    """
    m = remainder.rows
    place = np.arange(-count, count + 1 - half) + (0.5 if half else 0.0)
    moves, _ = remainder.receptance(omega * place)
    moves = moves + remainder.flexible
    parts = np.fft.fft(_varied(remainder, omega)[0], axis=0) / INSTANTS
    out = np.eye(len(place) * m, dtype=complex).reshape(len(place), m, len(place), m)
    between = np.arange(len(place))[:, None] - np.arange(len(place))
    out -= np.einsum("tij,tajk->tiak", moves, parts[between])
    return float(np.linalg.det(out.reshape(len(place) * m, -1)).real)


@pinned
def edges(remainder: Remainder, low: float, high: float, half: bool) -> tuple[float, ...]:
    """Return the frequencies of the cycle between two at which Hill's determinant is zero, rad/s;
    with `half` for motions that repeat themselves after two cycles, such as about twice a natural
    frequency.
    """
    places: Sequence[float] = np.geomspace(low, high, PLACES).tolist()
    values = [hill(remainder, w, half) for w in places]
    out = []
    for a, b, before, after in zip(places, places[1:], values, values[1:]):
        # an undamped pole of a receptance changes the sign too, by way of infinity
        if before * after < 0:
            edge = float(brentq(lambda w: hill(remainder, w, half), a, b, xtol=1e-12 * b))
            if abs(hill(remainder, edge, half)) <= min(abs(before), abs(after)):
                out.append(edge)
    return tuple(out)
