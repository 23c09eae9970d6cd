"""Differences between the blocks of a harmonic solid: unknowns, energies, rigid and mean motions.

In the unknowns of :mod:`solidgear.models.harmonic.blocks`; one set of integrals serves them all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.body import Block
from solidgear.models.harmonic.blocks import _energy


@dataclass(frozen=True)
class Family:
    """One family of motion of a harmonic solid.

    Attributes
    ----------
    waves : int
        Around the axis; -1 of torsion.
    count : int
        Unknowns of a point.
    energy : tuple of (3, c, 3, c) ndarray
        See :func:`solidgear.models.harmonic.blocks._energy`.
    share : (c,) ndarray
        Of the mass in every unknown.
    held : tuple of int
        Unknowns that are zero on the axis.
    """

    waves: int
    count: int
    energy: tuple[np.ndarray, ...]
    share: np.ndarray
    held: tuple[int, ...]

    def stiffness(self, material) -> np.ndarray:
        """(3 c, 3 c) coefficients of the strain energy."""
        mu = material.shear_modulus
        lame = 2 * mu * material.nu / (1 - 2 * material.nu)
        trace, normal, shear = self.energy
        size = 3 * self.count
        return (lame * trace + mu * (2 * normal + shear)).reshape(size, size)

    def weight(self, r: np.ndarray, area: np.ndarray) -> np.ndarray:
        """Weights of points in integrals over the body."""
        if self.waves < 0:
            return 2 * np.pi * area * r**3
        return (2 * np.pi if self.waves == 0 else np.pi) * area * r

    def rigid(self, r: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(..., c, m) rigid motions about the origin at some places."""
        count = 2 if self.waves == 1 else 1 if self.waves < 1 else 0
        out = np.zeros((*r.shape, self.count, count))
        if self.waves == 0:
            out[..., 1, 0] = 1.0
        elif self.waves < 0:
            out[..., 0, 0] = 1.0
        elif self.waves == 1:
            out[..., 0, 0] = 1.0
            out[..., 0, 1] = y
            out[..., 2, 1] = -r
        return out

    def means(self, r: np.ndarray, h: np.ndarray, w: np.ndarray) -> np.ndarray:
        """(..., c, m) densities whose integrals over a surface of length weights ``w`` are its mean
        motions about the place from which ``h`` counts.
        """
        if self.waves == 0:
            out = np.zeros((*r.shape, 2, 1))
            out[..., 1, 0] = w * r / (w * r).sum()
        elif self.waves < 0:
            out = (w * r**3 / (w * r**3).sum())[..., None, None]
        else:
            raw = np.zeros((*r.shape, 3, 2))
            raw[..., 0, 0], raw[..., 0, 1] = 2 * np.pi * w * r, 2 * np.pi * w * r * h
            raw[..., 2, 1] = -np.pi * w * r * r
            a = 2 * np.pi * np.array([[(w * r).sum(), (w * r * h).sum()], [0.0, 0.0]])
            a[1] = a[0, 1], np.pi * (w * r * (2 * h * h + r * r)).sum()
            out = raw @ np.linalg.inv(a)
        return out


def family_of(block: Block) -> Family:
    """The family of a block."""
    if block.name == "torsion":
        shear = np.zeros((3, 1, 3, 1))
        shear[1, 0, 1, 0] = shear[2, 0, 2, 0] = 1.0
        return Family(-1, 1, (0 * shear, 0 * shear, shear), np.ones(1), ())
    if block.name == "axial":
        return Family(0, 2, _energy(0), np.ones(2), (0,))
    waves = 1 if block.name.startswith("bending") else int(block.name.rpartition("_")[2])
    held = (1, 2) if waves == 1 else (0, 1, 2)
    return Family(waves, 3, _energy(waves), np.array([2.0, 2.0, 1.0]), held)
