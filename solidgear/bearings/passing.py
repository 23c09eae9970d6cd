r"""Frequencies of a rolling bearing by rolling without slip: cage, passage of elements, their spin.

A race at the radius ``(Dpw -+ Dw cos a) / 2`` of the contacts moves with the ring, the centre of an
element at the mean of the two speeds, and the spin takes up their difference.  With g = Dw cos(a) /
Dpw, rings that turn at n_i and n_o, and Z elements,

    FTF   n_c = (n_i (1 - g) + n_o (1 + g)) / 2        cage
    BPFO  Z |n_c - n_o| = Z/2 (1 - g) |n_i - n_o|      elements over a point of the outer ring
    BPFI  Z |n_i - n_c| = Z/2 (1 + g) |n_i - n_o|      elements over a point of the inner ring
    BSF   Dpw / (2 Dw) (1 - g^2) |n_i - n_o|           turns of an element against the cage

(Harris and Kotzalas, Essential Concepts of Bearing Technology, 5th ed., chapter on internal speeds
and motions).  A defect of an element meets both rings in each turn, so that the second
harmonic is often the larger one.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from solidgear.bearings.inside import Inside
from solidgear.bearings.row import Contacts


class Passing(NamedTuple):
    """Frequencies of a row of rolling elements, in the unit of the speeds of the rings."""

    cage: float  #: FTF; negative where the cage turns against the sense of the speeds
    #: outer, inner: BPFO and BPFI
    outer: float
    inner: float
    element: float  #: BSF, against the cage


def passing(
    inside: Inside, angle: float | None = None, inner: float = 1.0, outer: float = 0.0
) -> Passing:
    """Return frequencies of a row at the signed speeds of the rings, in any unit (by default one
    turn of the inner ring), and a contact angle at work, rad (by default the nominal one).

    Examples -------- The 6205 of the Case Western Reserve University's bearing data, 9 balls of
    0.3126 in on 1.537 in, for which they give 0.398, 3.5848, 5.4152 and, twice a turn of a ball,
    4.7135:

    >>> ball = Inside(9, 0.3126, 0.0, 1.537, 0.0, (0.52, 0.53))
    >>> [round(value, 4) for value in passing(ball)]
    [0.3983, 3.5848, 5.4152, 2.3567]
    """
    share = inside.diameter * math.cos(inside.angle if angle is None else angle) / inside.pitch
    cage = (inner * (1 - share) + outer * (1 + share)) / 2
    return Passing(
        cage,
        inside.elements * abs(cage - outer),
        inside.elements * abs(inner - cage),
        inside.pitch / (2 * inside.diameter) * (1 - share**2) * abs(inner - outer),
    )


def working_angle(contacts: Contacts) -> float | None:
    """Return the contact angle of a loaded row, rad: the mean of the elements, weighted by their
    loads, without sign; None if none is loaded.

    Examples
    --------
    A deep groove bearing without a nominal angle takes one under an axial load:

    >>> from solidgear.bearings.ball import BallRow
    >>> row = BallRow(count=9, diameter=9.5e-3, pitch=46e-3)
    >>> round(math.degrees(working_angle(row.contacts(np.array([0, 40e-6, 0, 0, 0, 0])))), 1)
    4.8
    """
    loaded = contacts.load > 0
    if not loaded.any():
        return None
    return float(np.average(np.abs(contacts.angle[loaded]), weights=contacts.load[loaded]))
