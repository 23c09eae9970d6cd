"""Basic reference rating life by ISO/TS 16281:2008: fatigue of a row from the loads of the
elements.

A raceway whose every element presses with the capacity Q_c lives one million revolutions.  The
capacities of the inner and the outer raceway follow from the basic dynamic load rating C of the row
(one that nothing but a radial load presses, half of it loaded):

    balls     Q_ci = C / (0.407 Z cos(a)) (1 + v^(10/3))^(3/10),
              Q_ce = C / (0.389 Z cos(a)) (1 + v^(-10/3))^(3/10),
              v = 1.044 ((1 - g) / (1 + g))^1.72 (r_i / r_e (2 r_e - Dw) / (2 r_i - Dw))^0.41
    rollers   Q_ci = C / (0.83 0.378 Z cos(a)) (1 + v^(9/2))^(2/9),
              Q_ce = C / (0.83 0.364 Z cos(a)) (1 + v^(-9/2))^(2/9),
              v = 1.038 ((1 - g) / (1 + g))^(143/108)

with g = Dw cos(a) / Dpw. The four constants are Stribeck's integrals of half a loaded row; of
thrust balls, whose C is axial, they are 1, and so is the factor in place of cos(a) (sin 90). A
slice (lamina) of a roller has ``Q_c / n^(7/9)``.

The ring that turns against the load feels all elements in turn, ``Q = (mean Q_j^p)^(1/p)``; the one
that stands is ruled by the worst loaded places, ``Q = (mean Q_j^s)^(1/s)``: p, s = 3, 10/3 for
points and 4, 9/2 for lines. Then, over both rings and all slices and rows,

    L_10r = (sum of (Q / Q_c)^s)^(-p / s)      million revolutions.

Rollers press harder at their ends than their slices do: each slice is raised by
``1 - 0.01 / ln(1.985 |2 k - n - 1| / (2 n - 2))``, k = 1 .. n.

Of ISO/TS 16281:2008 these are equations (19), (20), (25) to (29) for balls and (47), (48), (58) to
(65) for rollers.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from solidgear.bearings.inside import Inside
from solidgear.bearings.row import Contacts

Ring = Literal["inner", "outer"]


class Fatigue(NamedTuple):
    """Laws of fatigue of a kind of contact."""

    #: turning, standing: powers p and s of the mean load on a ring
    turning: float
    standing: float
    slices: float  #: power of the number of slices in the capacity of one
    #: inner, outer: integrals that turn the rating of half a loaded row into the capacity of an
    #: element
    inner: float
    outer: float
    edge: float  #: factor of the rating for uneven loads along an element


POINT = Fatigue(3.0, 10 / 3, 0.0, 0.407, 0.389, 1.0)
#: of washers that are loaded evenly
THRUST = POINT._replace(inner=1.0, outer=1.0)
LINE = Fatigue(4.0, 9 / 2, 7 / 9, 0.378, 0.364, 0.83)


class Raceways(NamedTuple):
    """Load of an element for which a raceway lives one million revolutions."""

    #: inner, outer: Q_ci and Q_ce, N
    inner: float
    outer: float
    law: Fatigue
    rating: float  #: of the row, N


def raceways(inside: Inside, rating: float) -> Raceways:
    """Return capacities of both raceways of a row, of the basic dynamic radial load rating of this
    row alone, N.

    Examples
    --------
    >>> found = raceways(Inside(7, 11.5e-3, 0.0, 43.5e-3, 0.0, (0.52, 0.53)), 23.4e3)
    >>> round(found.inner), round(found.outer)
    (8423, 18289)
    """
    g = inside.gamma
    if inside.length:
        law, ratio = LINE, 1.038 * ((1 - g) / (1 + g)) ** (143 / 108)
    else:
        inner, outer = inside.conformity
        grooves = (inner * (2 * outer - 1) / (outer * (2 * inner - 1))) ** 0.41
        law, ratio = POINT, 1.044 * ((1 - g) / (1 + g)) ** 1.72 * grooves
    share = math.cos(inside.angle)
    if inside.thrust:
        law, share = THRUST, 1.0
    element_load = rating / law.edge / (inside.elements * share)
    s = law.standing
    return Raceways(
        element_load / law.inner * (1 + ratio**s) ** (1 / s),
        element_load / law.outer * (1 + ratio**-s) ** (1 / s),
        law,
        rating,
    )


@functools.cache
def edge_stress(slices: int) -> np.ndarray:
    """Return the factors (slices,) by which the ends of a roller press harder than the slices."""
    if slices == 1:
        return np.ones(1)
    place = np.abs(2 * np.arange(slices) - slices + 1) / (2 * slices - 2)
    # the middle one of an odd number is not raised
    return 1 - 0.01 / np.log(1.985 * np.maximum(place, 1e-300))


@dataclass(frozen=True)
class Damage:
    """Damage of the rows of a bearing in a million revolutions, slice by slice."""

    by_slice: np.ndarray  #: (rows, slices) sum of ``(Q / Q_c)^s`` over both rings
    law: Fatigue
    rating: float  #: basic dynamic radial load rating of a row, N

    @property
    def life(self) -> float:
        """Basic reference rating life for 90 % reliability, revolutions; infinite where nothing is
        loaded.
        """
        return self.modified(np.ones_like(self.by_slice)) if self.by_slice.any() else math.inf

    def modified(self, factor: np.ndarray) -> float:
        """Return the life in revolutions if slices live by factors (rows, slices) longer."""
        p, s = self.law.turning, self.law.standing
        return 1e6 * float(np.sum(self.by_slice * factor ** (-s / p))) ** (-p / s)

    @property
    def slice_loads(self) -> np.ndarray:
        """Load of a row, N, whose slices were all loaded as this one, (rows, slices)."""
        damage_sum = self.by_slice * self.by_slice.shape[-1]
        return self.rating / self.law.edge * damage_sum ** (1 / self.law.standing)


def damage(rows: Sequence[Contacts], capacity: Raceways, turning: Ring = "inner") -> Damage:
    """Return the damage of rows of one make that turn together, from the loads of their elements at
    one motion and the capacity of each; `turning` is the ring that turns against the load.
    """
    law = capacity.law
    inner = np.array([row.on_inner for row in rows]) / capacity.inner
    outer = np.array([row.on_outer for row in rows]) / capacity.outer
    slices = inner.shape[-1]
    by_slice = np.zeros((len(rows), slices))
    for ring, share in (("inner", inner), ("outer", outer)):
        power = law.turning if ring == turning else law.standing
        felt = share * edge_stress(slices) * slices**law.slices
        by_slice += np.mean(felt**power, axis=1) ** (law.standing / power)
    return Damage(by_slice, law, capacity.rating)
