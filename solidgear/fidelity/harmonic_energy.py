"""Where in a harmonic solid the strain energy of a displacement sits, point by point of the
quadrature.

Two bodies on one mesh whose elements differ in their order hold nested displacements: what one
order more adds is a displacement of the finer body, found here element by element.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.fidelity.assembly import reference
from solidgear.fidelity.harmonic_blocks import _energy, _functions, _weight, _Work

if TYPE_CHECKING:
    from solidgear.fidelity.harmonic import HarmonicMesh
    from solidgear.scene import Scene

#: waves around the axis of the blocks that have (p, q, w) or (u_r, u_y) for unknowns
WAVES = {"bending_z": 1, "bending_x": 1, "axial": 0}


@dataclass(frozen=True)
class PointEnergies:
    """Products of strain energy at the quadrature points of a meridian.

    Attributes
    ----------
    r, y : (ne, nq) ndarray
        Places, m.
    energy : (k, k, ne, nq) ndarray
        Of every two of k displacements: their share of ``u'K v``, N m.
    """

    r: np.ndarray
    y: np.ndarray
    energy: np.ndarray


class Meridional:
    """The cells of the meridian of a harmonic body.

    Parameters
    ----------
    scene : Scene
    body : Body
        Of the harmonic solid.
    """

    def __init__(self, scene: Scene, body: Body):
        self.body = body
        geometry: HarmonicMesh = body.geometry  # type: ignore[assignment]
        self.flat = geometry.meridian
        self.element, self.dofs = geometry.element, geometry.dofs
        order = int(body.mesh["order"])
        self._work = _Work(scene, geometry.mesh, self.element, self.dofs, self.flat, order)

    def local(self, block: int, u: np.ndarray) -> np.ndarray:
        """Coefficients of displacements on every cell.

        Parameters
        ----------
        block : int
        u : (n, k) ndarray
            Unknowns of the block.

        Returns
        -------
        (nb, ne, c, k) ndarray
            Of the basis functions of the cells, by unknown of the block.
        """
        of = self.body.blocks[block]
        u = u if of.expand is None else of.expand @ u
        count = self._work.n
        c = 1
        keep = np.ones(count, bool)
        if of.name in WAVES:
            keep = self._work.kept(WAVES[of.name])
            c = len(keep) // count
        every = np.zeros((count * c, u.shape[1]))
        every[keep] = u
        return every.reshape(count, c, -1)[self.dofs]

    def embedded(self, coarse: Meridional, local: np.ndarray) -> np.ndarray:
        """Coefficients of the displacements of a body of lower order on the same mesh.

        Parameters
        ----------
        coarse : Meridional
        local : (nb, ne, c, k) ndarray
            Coefficients there.

        Raises
        ------
        SolidgearError
            If the meshes differ, or the displacements there are none of this body.
        """
        mine, theirs = self.flat, coarse.flat
        same = mine.points.shape == theirs.points.shape and np.array_equal(mine.cells, theirs.cells)
        if not same or not np.array_equal(mine.points, theirs.points):
            raise SolidgearError("the two bodies have different meshes; give both the same layers")
        return np.tensordot(embedding(coarse.element, self.element), local, axes=1)

    def energies(self, block: int, local: np.ndarray) -> PointEnergies:
        """Products of strain energy of some displacements, point by point.

        Parameters
        ----------
        block : int
        local : (nb, ne, c, k) ndarray
        """
        name = self.body.blocks[block].name
        ne, nq, k = local.shape[1], len(self._work.weights), local.shape[3]
        r, y, out = np.zeros((ne, nq)), np.zeros((ne, nq)), np.zeros((k, k, ne, nq))
        for part, material, t, dv in self._work._batches():
            r[part], y[part] = t.x
            here = np.ascontiguousarray(local[:, part].transpose(1, 3, 2, 0))
            strains = self._torsion if name == "torsion" else self._bending
            out[:, :, part] = strains(name, here, material, t, dv)
        return PointEnergies(r, y, out)

    def _bending(self, name, local, material, t, dv):
        """(k, k, m, nq) products for local coefficients (m, k, c, nb)."""
        n = WAVES[name]
        m, k, c, nb = local.shape
        f = _functions(t, _weight(n, t, dv))
        g = (local.reshape(m, 1, k * c, nb) @ f).reshape(m, 3, k, c, -1)
        g = g.transpose(2, 0, 1, 3, 4).reshape(k, m, 3 * c, -1)
        mu = material.shear_modulus
        lame = 2 * mu * material.nu / (1 - 2 * material.nu)
        trace, normal, shear = (part.reshape(3 * c, 3 * c) for part in _energy(n))
        stress = (lame * trace + mu * (2 * normal + shear)) @ g
        return np.einsum("amiq,bmiq->abmq", g, stress)

    def _torsion(self, name, local, material, t, dv):
        """The same for ``u_t / r``."""
        weight = 2 * np.pi * dv * t.x[0] ** 3 * material.shear_modulus
        m, k, _, nb = local.shape
        g = local.reshape(m, 1, k, nb) @ t.gradient(np.sqrt(weight))
        return np.einsum("miaq,mibq->abmq", g, g)


def embedding(coarse, fine) -> np.ndarray:
    """Basis functions of a quadrilateral in those of one of higher order.

    Parameters
    ----------
    coarse, fine : scikit-fem element

    Returns
    -------
    (nb fine, nb coarse) ndarray

    Raises
    ------
    SolidgearError
        If the finer element does not hold the functions of the coarser one.

    Examples
    --------
    >>> from skfem import ElementQuad1, ElementQuad2
    >>> up = embedding(ElementQuad1(), ElementQuad2())
    >>> [round(abs(float(x)), 12) for x in up[:, 0]]  # at its own corner 1, half on the sides
    [1.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.5, 0.25]
    """
    # as many points along a side as tell apart the polynomials of the finer element
    count = int(np.sqrt(fine.maxdeg)) + 2
    x = (np.polynomial.legendre.leggauss(count)[0] + 1) / 2
    a, b = np.meshgrid(x, x, indexing="ij")
    points = np.array([a.ravel(), b.ravel()])
    low, high = reference(coarse, points)[0], reference(fine, points)[0]
    up = np.linalg.lstsq(high.T, low.T, rcond=None)[0]
    missed = np.abs(high.T @ up - low.T).max()
    if missed > 1e-9 * np.abs(low).max():
        raise SolidgearError(
            f"the displacements of {type(coarse).__name__} are none of {type(fine).__name__}; "
            "give elements of the same family, the finer one second"
        )
    return up
