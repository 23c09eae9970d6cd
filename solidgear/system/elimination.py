r"""Steady motion by elimination, one frequency at a time, beside springs of any stiffness.

In a sum of stiffnesses a clamp of 1e22 N/m leaves nothing of the shaft beside it.  So the forces s
of links that are stiffer than all parts are unknowns of their own.  With their unit rows g, ``k``
the stiffness along each and D that of all else less ``w^2 M``,

    D q + g' s = f,     g q - s / (k (1 + i eta)) = 0.

A load on such a seat goes for the most part straight into what holds it.  Where they span it, ``f =
g' a``, it is taken as the motion ``a / (k (1 + i eta))`` of their feet, so that the small rest is no
difference; and a motion that they span is read from q or from s, whichever rounds less.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from solidgear.system.system import System

#: stiffness of a link, over its effective mass, above the highest eigenvalue of the parts by so much
#: that it is no term of a sum; both forms are exact, and round alike near it
STIFF = 1e4
#: a load or a row that differs from a combination of the rows of links by less, relative, is one
SAME = 1e-14
#: a weight in such a combination that is rounding
SPARE = 1e-12


class Elimination:
    """Matrices of a system, those of the parts apart from the rows of the links.

    Parameters
    ----------
    loss : mapping of str to float
        Loss factor eta of parts and links.
    """

    def __init__(self, system: System, loss: Mapping[str, float]):
        g, where = system.strains
        eta = np.zeros(len(g))
        for name, place in where.items():
            eta[place] = loss.get(name, 0.0)
        linked = np.zeros(len(g), bool)
        for name in system.links.keys() & where.keys():
            linked[where[name]] = True
        self.mass = system.mass
        stiff = linked & self._stiff(g, linked)
        self.elastic = g[~stiff].T @ g[~stiff]
        self.lost = g[~stiff].T @ (eta[~stiff, None] * g[~stiff])
        length = np.linalg.norm(g[stiff], axis=1)
        self.unit, self.stiffness, self.eta = g[stiff] / length[:, None], length**2, eta[stiff]

    def _stiff(self, g: np.ndarray, linked: np.ndarray) -> np.ndarray:
        """Strain rows far above all that parts have by themselves."""
        alone = np.einsum("ij,ji->i", g, np.linalg.solve(self.mass, g.T))
        return alone > STIFF * alone[~linked].max(initial=np.inf if linked.all() else 0.0)

    def motion(
        self, omega: np.ndarray, growth: np.ndarray, load: np.ndarray, rows: np.ndarray
    ) -> np.ndarray:
        """Amplitudes (f, q) of some motions (q, N) under a load (N,).

        Parameters
        ----------
        omega : (f,) ndarray
            rad/s.
        growth : (f,) ndarray
            Losses over what they are where they were told.
        load : (N,) ndarray
        rows : (q, N) ndarray
        """
        n = len(self.mass)
        gives = 1 / (self.stiffness * (1 + 1j * growth[:, None] * self.eta))
        left = np.zeros((len(omega), n + len(self.eta), n + len(self.eta)), complex)
        w2, grown = omega[:, None, None] ** 2, growth[:, None, None]
        left[:, :n, :n] = self.elastic - w2 * self.mass + 1j * grown * self.lost
        left[:, n:, :n], left[:, :n, n:] = self.unit, self.unit.T
        at = np.arange(n, left.shape[1])
        left[:, at, at] = -gives
        straight, spanned = self._spanned(load[None])
        right = np.zeros((len(omega), left.shape[1], 1), complex)
        right[:, :n, 0] = 0.0 if spanned[0] else load
        right[:, n:, 0] = gives * straight[0]
        found = np.linalg.solve(left, right)[:, :, 0]
        return self._seen(found[:, :n], found[:, n:], straight[0], gives, rows)

    def _seen(self, q, force, straight, gives, rows) -> np.ndarray:
        """Motions from coordinates, or from the forces of links where those round less."""
        seen = q @ rows.T
        weight, spanned = self._spanned(rows)
        by_force = ((force + straight) * gives) @ weight.T
        blur = (np.abs(force) + np.abs(straight)) * np.abs(gives)
        less = blur @ np.abs(weight).T < np.abs(q) @ np.abs(rows).T
        return np.where(spanned & less, by_force, seen)

    def _spanned(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Combinations (q, r) of the rows of links, zero where rows (q, N) are none, and which are."""
        weight = np.linalg.lstsq(self.unit.T, rows.T, rcond=None)[0].T
        # rounding on a soft spring far away would be as large as what a clamp lets through
        weight[np.abs(weight) <= SPARE * np.abs(weight).max(axis=1, initial=0.0, keepdims=True)] = 0
        away = np.linalg.norm(rows - weight @ self.unit, axis=1)
        spanned = away <= SAME * np.linalg.norm(rows, axis=1)
        return np.where(spanned[:, None], weight, 0.0), spanned
