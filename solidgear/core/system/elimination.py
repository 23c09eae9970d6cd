r"""Steady motion by elimination, one frequency at a time, beside springs of any stiffness.

In a sum of stiffnesses a clamp of 1e22 N/m leaves nothing of the shaft beside it.  So the forces s
of links that are stiffer than all parts are unknowns of their own.  With their unit rows g, ``k``
the stiffness along each and D that of all else less ``w^2 M``,

    D q + g' s = f,     g q - s / (k (1 + i eta)) = 0.

A load on such a seat goes for the most part straight into the ground. Where they span it, ``f = g'
a``, it is taken as the motion ``a / (k (1 + i eta))`` of their feet, so that the small rest is no
difference; and a motion that they span is read from q or from s, whichever rounds less.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.core.system.coupled import Coupled

#: stiffness of a link, over its effective mass, above the highest eigenvalue of the parts by so much
#: that it is no term of a sum; both forms are exact, and round alike near it
STIFF = 1e4
#: a load or a row that differs from a combination of the rows of links by less, relative, is one
SAME = 1e-14
#: a weight in such a combination that is rounding
SPARE = 1e-12


class Elimination:
    """Matrices of a system with loss factors of parts and links, those of the parts separate from
    the rows of the links.
    """

    def __init__(self, system: Coupled, loss: Mapping[str, float]):
        g, rows_of = system.strains
        eta = np.zeros(len(g))
        for name, place in rows_of.items():
            eta[place] = loss.get(name, 0.0)
        linked = np.zeros(len(g), bool)
        for name in system.links.keys() & rows_of.keys():
            linked[rows_of[name]] = True
        self.mass = system.mass
        stiff = linked & self._stiff(g, linked)
        self.elastic = g[~stiff].T @ g[~stiff]
        self.lost = g[~stiff].T @ (eta[~stiff, None] * g[~stiff])
        length = np.linalg.norm(g[stiff], axis=1)
        self.unit, self.stiffness, self.eta = g[stiff] / length[:, None], length**2, eta[stiff]

    def _stiff(self, g: np.ndarray, linked: np.ndarray) -> np.ndarray:
        """Return which strain rows are far stiffer than all parts."""
        own_stiffness = np.einsum("ij,ji->i", g, np.linalg.solve(self.mass, g.T))
        return own_stiffness > STIFF * own_stiffness[~linked].max(
            initial=np.inf if linked.all() else 0.0
        )

    def motion(
        self, omega: np.ndarray, growth: np.ndarray, load: np.ndarray, rows: np.ndarray
    ) -> np.ndarray:
        """Return amplitudes (f, q) of the motions `rows` (q, N) under a load (N,), at frequencies
        (f,), rad/s; `growth` (f,) multiplies the losses.
        """
        n = len(self.mass)
        flexibility = 1 / (self.stiffness * (1 + 1j * growth[:, None] * self.eta))
        matrix = np.zeros((len(omega), n + len(self.eta), n + len(self.eta)), complex)
        w2, grown = omega[:, None, None] ** 2, growth[:, None, None]
        matrix[:, :n, :n] = self.elastic - w2 * self.mass + 1j * grown * self.lost
        matrix[:, n:, :n], matrix[:, :n, n:] = self.unit, self.unit.T
        links = np.arange(n, matrix.shape[1])
        matrix[:, links, links] = -flexibility
        straight, spanned = self._spanned(load[None])
        right = np.zeros((len(omega), matrix.shape[1], 1), complex)
        right[:, :n, 0] = 0.0 if spanned[0] else load
        right[:, n:, 0] = flexibility * straight[0]
        solution = np.linalg.solve(matrix, right)[:, :, 0]
        return self._motions(solution[:, :n], solution[:, n:], straight[0], flexibility, rows)

    def _motions(self, q, force, straight, flexibility, rows) -> np.ndarray:
        """Return motions from coordinates, or from the forces of links where those round less."""
        by_coordinates = q @ rows.T
        weight, spanned = self._spanned(rows)
        by_force = ((force + straight) * flexibility) @ weight.T
        blur = (np.abs(force) + np.abs(straight)) * np.abs(flexibility)
        less = blur @ np.abs(weight).T < np.abs(q) @ np.abs(rows).T
        return np.where(spanned & less, by_force, by_coordinates)

    def _spanned(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return combinations (q, r) of the rows of links, zero where rows (q, N) are none, and
        which are.
        """
        weight = np.linalg.lstsq(self.unit.T, rows.T, rcond=None)[0].T
        # rounding on a soft spring far away would be as large as the motion of a clamp
        weight[np.abs(weight) <= SPARE * np.abs(weight).max(axis=1, initial=0.0, keepdims=True)] = 0
        miss = np.linalg.norm(rows - weight @ self.unit, axis=1)
        spanned = miss <= SAME * np.linalg.norm(rows, axis=1)
        return np.where(spanned[:, None], weight, 0.0), spanned
