"""Rough estimate of the lowest eigenvalue of a free shaft.

The shaft is cut into slices: bending, stretch and twist of the chain of slices are solved as small
banded eigenproblems over the true distribution of stiffness and mass, and
overhanging parts (flanges, thin discs) are taken as plates.  The least of all is within about a
factor of three of the lowest elastic eigenvalue of the harmonic solid's own families on every shaft
tried.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg as sla

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft

SLICES = 120
LEVELS = 60  # radii at which overhangs are looked for


def elastic_scale(scene: Shaft) -> float:
    """Estimate the lowest elastic eigenvalue of the free shaft, rad^2/s^2, by a chain of slices and
    overhanging plates: it places spectral shifts, where a factor of ten is harmless.
    """
    chain = _Chain(scene.segments)
    return min(
        chain.bending(),
        chain.rod(chain.stretch, chain.mass),
        chain.rod(chain.twist, chain.polar),
        *_flanges(scene.segments),
    )


class _Chain:
    """Slices of a shaft: length, mass, and the stiffness of each in bending, shear, stretch and
    twist.
    """

    def __init__(self, segments):
        ends = np.array([0.0, *(s.y1 for s in segments)])
        grid = np.linspace(0.0, ends[-1], SLICES + 1)
        # Pieces within one segment and one slice; slices collect them, springs in series and masses
        # in sum.
        edges = np.unique(np.concatenate([grid, ends]))
        middle, piece = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
        owner = np.searchsorted(ends, middle) - 1
        first = np.searchsorted(edges, grid[:-1])

        def values(name):
            return np.array([getattr(s, name) for s in segments])[owner]

        modulus, shear, density = np.array(
            [(s.material.E, s.material.shear_modulus, s.material.density) for s in segments]
        )[owner].T
        t = (middle - values("y0")) / (values("y1") - values("y0"))
        outer = values("outer0") + t * (values("outer1") - values("outer0"))
        inner = values("inner0") + t * (values("inner1") - values("inner0"))
        area, second = np.pi * (outer**2 - inner**2), np.pi / 4 * (outer**4 - inner**4)

        def summed(per_length):
            return np.add.reduceat(per_length * piece, first)

        self.length = summed(1.0)
        self.mass = summed(density * area)
        self.polar = summed(2 * density * second)
        self.tilt = self.polar / 2 + self.mass * self.length**2 / 12
        self.stretch = 1 / summed(1 / (modulus * area))
        self.twist = 1 / summed(1 / (2 * shear * second))
        self.bend = 1 / summed(1 / (modulus * second))
        # A third to a half of a section carries shear; a rough value will do.
        self.shear = 1 / summed(1 / (0.6 * shear * area))

    def rod(self, stiffness, inertia) -> float:
        """Return the lowest elastic eigenvalue of inertias joined by springs in a row, each half of
        two slices.
        """
        between = 2 / (1 / stiffness[1:] + 1 / stiffness[:-1])
        return _second_tridiagonal(between, inertia)

    def bending(self) -> float:
        """Return the lowest elastic eigenvalue of rigid slices joined by springs in bending and
        shear at their borders.
        """
        n = len(self.mass)
        bend = 2 / (1 / self.bend[1:] + 1 / self.bend[:-1])
        shear = 2 / (1 / self.shear[1:] + 1 / self.shear[:-1])
        # Slices deflect and turn; a joint sees the turn between its neighbours, and the gap between
        # their ends.
        left, right = self.length[:-1] / 2, self.length[1:] / 2
        turn = np.zeros((n - 1, 4))
        turn[:, 1], turn[:, 3] = -1.0, 1.0
        gap = np.column_stack([-np.ones(n - 1), -left, np.ones(n - 1), -right])
        joints = (
            bend[:, None, None] * turn[:, :, None] * turn[:, None]
            + shear[:, None, None] * gap[:, :, None] * gap[:, None]
        )
        size = np.sqrt(np.column_stack([self.mass, self.tilt]).ravel())
        band = np.zeros((4, 2 * n))
        for i in range(4):
            for j in range(i + 1):
                band[i - j, j : j + 2 * (n - 1) : 2] += joints[:, i, j]
        for k in range(4):
            band[k, : 2 * n - k] /= size[: 2 * n - k] * size[k:]
        values = sla.eig_banded(
            band, lower=True, eigvals_only=True, select="i", select_range=(2, 2)
        )
        return float(values[0])


def _second_tridiagonal(between, inertia) -> float:
    """Return the second eigenvalue of a free chain; the first one is the rigid motion."""
    main = (np.append(between, 0.0) + np.append(0.0, between)) / inertia
    off_diagonal = -between / np.sqrt(inertia[1:] * inertia[:-1])
    return float(sla.eigvalsh_tridiagonal(main, off_diagonal, select="i", select_range=(1, 1))[0])


def _flanges(segments):
    """Yield eigenvalues of parts that overhang a thinner neighbour: plates clamped at its radius, of the
    quickest material there.

    A strip of length b and thickness h: bending ``12.4 E h^2 / (12 rho b^4)``, shear ``(pi / 2 b)^2
    k G / rho``, in series.
    """
    for base, run in overhangs(
        [(max(s.outer0, s.outer1), s.length, s.material.E / s.material.density) for s in segments],
        0.0,
    ):
        overhang, speed = max(r for r, _, _ in run) - base, max(c for _, _, c in run)
        thickness = sum(length for _, length, _ in run)
        if thickness <= 2 * overhang:
            bending = speed * thickness**2 / overhang**4
            shear = speed * 0.3 * (np.pi / 2 / overhang) ** 2
            yield bending * shear / (bending + shear)


def overhangs(
    parts: Sequence[tuple[float, float, float]], *bases: float
) -> Iterator[tuple[float, list[tuple[float, float, float]]]]:
    """Yield (radius, parts) of neighbours that together reach beyond a radius, of parts (radius,
    length, E / rho) along the shaft, for every radius that a part ends at, and for ``bases``.
    """
    levels = sorted({*bases, *(part[0] for part in parts)})
    levels = levels[:: 1 + len(levels) // LEVELS] + levels[-1:]
    for base in levels[:-1]:
        yield from ((base, run) for run in _runs(parts, base))


def _runs(parts, base: float):
    """Yield the runs of neighbouring parts that reach beyond a radius."""
    run = []
    for part in parts:
        if part[0] > base + 1e-9 * abs(base):
            run.append(part)
        elif run:
            yield run
            run = []
    if run:
        yield run
