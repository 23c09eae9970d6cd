"""Families of motion of a harmonic solid: unknowns, energies, rigid and mean motions of each, in the
unknowns of :mod:`solidgear.core.models.harmonic.blocks`; one set of integrals serves them all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from solidgear.core.scene import Material

#: stands for torsion among numbers of waves
TORSION = -1


def strains(n: int) -> tuple[np.ndarray, ...]:
    """Return strains rr, tt, yy and shears rt, ty, ry of harmonic n, each (3, c): entry [i, p] belongs to
    function i of unknown p, functions being (phi / r, phi,r, phi,y) and unknowns (u_r, u_y) for
    n = 0, (p, q, w) otherwise. Shears rt and ty go with ``sin nt``, the others with ``cos nt``.
    """
    if n == 0:
        rr, tt, yy, rt, ty, ry = np.zeros((6, 3, 2))
        rr[1, 0] = tt[0, 0] = yy[2, 1] = ry[2, 0] = ry[1, 1] = 1.0
    else:
        rr, tt, yy, rt, ty, ry = np.zeros((6, 3, 3))
        rr[1, 0] = rr[1, 1] = 1.0
        tt[0, 0], tt[0, 1] = 1 - n, 1 + n
        yy[2, 2] = 1.0
        rt[0, 0], rt[1, 0], rt[0, 1], rt[1, 1] = 1 - n, -1.0, -(1 + n), 1.0
        ty[2, 0], ty[2, 1], ty[0, 2] = -1.0, 1.0, -n
        ry[2, 0] = ry[2, 1] = ry[1, 2] = 1.0
    return rr, tt, yy, rt, ty, ry


@dataclass(frozen=True)
class Family:
    """A family of motion."""

    waves: int  #: around the axis, or :data:`TORSION`

    @property
    def count(self) -> int:
        """Number of unknowns of a point."""
        return {TORSION: 1, 0: 2}.get(self.waves, 3)

    @property
    def share(self) -> np.ndarray:
        """Share (c,) of the mass in every unknown."""
        return np.array([2.0, 2.0, 1.0]) if self.count == 3 else np.ones(self.count)

    @property
    def turns(self) -> np.ndarray:
        """Waves (c,) around of the motion of every unknown along fixed axes; zeros where nothing
        varies.
        """
        n = self.waves
        return np.array([n - 1.0, n + 1.0, n]) if self.count == 3 else np.zeros(self.count)

    @property
    def zero_on_axis(self) -> tuple[int, ...]:
        """Unknowns that are zero on the axis."""
        return {TORSION: (), 0: (0,), 1: (1, 2)}.get(self.waves, (0, 1, 2))

    def free(self, on_axis: np.ndarray) -> np.ndarray:
        """Return the mask (n, c) of the unknowns that the axis leaves free, from the mask (n,) of
        points with a share on it.
        """
        keep = np.ones((len(on_axis), self.count), bool)
        for unknown in self.zero_on_axis:
            keep[on_axis, unknown] = False
        return keep

    @property
    def power(self) -> int:
        """Power of the radius in integrals over the body."""
        return 3 if self.waves == TORSION else 1

    def weight(self, r: np.ndarray, area: np.ndarray) -> np.ndarray:
        """Return the weights of points in integrals over the body."""
        return (np.pi if self.waves > 0 else 2 * np.pi) * area * r**self.power

    @property
    def energy(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of twice the strain energy density: three (3, c, 3, c) that multiply lambda, 2
        mu and mu. Entry [i, p, j, q] belongs to the product of function i of unknown p with function
        j of unknown q, as in :func:`strains`.
        """
        if self.waves == TORSION:
            shear = np.zeros((3, 1, 3, 1))
            shear[1, 0, 1, 0] = shear[2, 0, 2, 0] = 1.0
            return 0 * shear, 0 * shear, shear
        rr, tt, yy, rt, ty, ry = strains(self.waves)

        def product(*parts: np.ndarray) -> np.ndarray:
            return np.sum([np.multiply.outer(s, s) for s in parts], axis=0)

        return product(rr + tt + yy), product(rr, tt, yy), product(rt, ty, ry)

    def stiffness(self, material: Material) -> np.ndarray:
        """Return the coefficients (3, c, 3, c) of twice the strain energy density in a material."""
        mu = material.shear_modulus
        lame = 2 * mu * material.nu / (1 - 2 * material.nu)
        trace, normal, shear = self.energy
        return lame * trace + mu * (2 * normal + shear)

    def rigid(self, r: np.ndarray, y: np.ndarray, constant: np.ndarray | float = 1.0) -> np.ndarray:
        """Return the rigid motions (..., c, m) about the origin at some places; or their
        coefficients by those of the places and of a constant.
        """
        motions = {TORSION: 1, 0: 1, 1: 2}.get(self.waves, 0)
        out = np.zeros((*r.shape, self.count, motions))
        if self.waves == 0:
            out[..., 1, 0] = constant
        elif self.waves == TORSION:
            out[..., 0, 0] = constant
        elif self.waves == 1:
            out[..., 0, 0] = constant
            out[..., 0, 1] = y
            out[..., 2, 1] = -r
        return out

    def means(self, r: np.ndarray, h: np.ndarray, w: np.ndarray) -> np.ndarray:
        """Return the densities (..., c, m) whose integrals over a surface of length weights ``w``
        are its mean motions (least squares) about the place from which ``h`` counts.
        """
        if self.waves == 0:
            out = np.zeros((*r.shape, 2, 1))
            out[..., 1, 0] = w * r / (w * r).sum()
        elif self.waves == TORSION:
            out = (w * r**3 / (w * r**3).sum())[..., None, None]
        else:
            raw = np.zeros((*r.shape, 3, 2))
            raw[..., 0, 0], raw[..., 0, 1] = 2 * np.pi * w * r, 2 * np.pi * w * r * h
            raw[..., 2, 1] = -np.pi * w * r * r
            a = 2 * np.pi * np.array([[(w * r).sum(), (w * r * h).sum()], [0.0, 0.0]])
            a[1] = a[0, 1], np.pi * (w * r * (2 * h * h + r * r)).sum()
            out = raw @ np.linalg.inv(a)
        return out


def family_of(block: str) -> Family:
    """Return the family of a block, by name."""
    waves = {"torsion": TORSION, "axial": 0, "bending_z": 1, "bending_x": 1}
    return Family(waves[block] if block in waves else int(block.rpartition("_")[2]))
