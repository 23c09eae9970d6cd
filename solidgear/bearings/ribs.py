"""Ribs of cylindrical roller bearings, which hold the shaft along y: NJ one way, NUP both.

The end of a roller is pressed on two ribs in series, that of the inner and that of the outer ring,
along a chord of ``0.8 Dw``, with Palmgren's line contact.  Where all rollers carry alike, Z of them
stand side by side.  How many do, how a rib bends, and how much play it has is the maker's: the
stiffness is estimated at half of that, from a quarter to all of it.  The play of the ribs (some 0.05
to 0.2 mm) is left out: the shaft is taken as pressed on one side.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.bearings.hertz import LINE_POWER, line_constant
from solidgear.bearings.inside import Inside

#: of the roller diameter: the chord along which its end touches a rib
CHORD = 0.8
#: N per mm of chord, as ribs carry for long
LINE_LOAD = 20.0
#: shares of the stiffness of all rollers together at the ends of an estimate
SHARES = {"softer": 0.25, "middle": 0.5, "stiffer": 1.0}
#: directions along y in which ribs hold the shaft
WAYS = {"+y": (1,), "-y": (-1,), None: (1, -1)}


@dataclass(frozen=True)
class Ribs:
    """Springs along y of ribs that press one way or both."""

    stiffness: float  #: N/m
    holds: str | None = None  #: ``+y``, ``-y``; None for both

    def _pressed(self, motion: np.ndarray) -> np.ndarray:
        """Return whether a rib is pressed at motions (..., 6)."""
        y = np.asarray(motion, float)[..., 1]
        return np.isin(np.sign(y), (*WAYS[self.holds], *((0,) if self.holds is None else ())))

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load (..., 6) that holds the shaft at motions (..., 6), N."""
        out = np.zeros(np.shape(motion))
        out[..., 1] = self.stiffness * np.asarray(motion, float)[..., 1] * self._pressed(motion)
        return out

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the derivative of the load, (..., 6, 6)."""
        out = np.zeros((*np.shape(motion), 6))
        out[..., 1, 1] = self.stiffness * self._pressed(motion)
        return out


def estimated_stiffness(inside: Inside, end: str = "middle") -> float:
    """Return the stiffness of ribs along y, N/m, at an end of its estimate.

    Examples
    --------
    >>> rollers = Inside(13, 10e-3, 10e-3, 53.5e-3, 0.0, (0.5, 0.5))
    >>> round(estimated_stiffness(rollers) / 1e9, 1)
    0.8
    """
    chord = CHORD * inside.diameter
    # of both ends of a roller in series, as of both rings of a raceway
    constant = line_constant(chord)
    load = LINE_LOAD * 1e3 * chord
    approach = (load / constant) ** (1 / LINE_POWER)
    return SHARES[end] * inside.elements * LINE_POWER * load / approach
