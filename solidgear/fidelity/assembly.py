"""Block assembly on scikit-fem elements: tabulate once, batch the element matrices.

scikit-fem supplies elements, mappings, quadrature and the numbering of unknowns; its own
forms (the oracle in the tests) spend their time in Python loops over pairs of vector components.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from skfem.assembly import Dofs

CHUNK_BYTES = 1.5e8


@dataclass(frozen=True)
class Tabulated:
    """Basis functions of some elements at reference points, in physical coordinates.

    ``value`` (nb, nq); ``gradient`` (ne, nb, dim, nq); ``det`` (ne, nq); ``x`` (dim, ne, nq);
    ``tangent`` (ne, nq, dim, dim) derivative of position (third axis) along reference coordinates (fourth).
    """

    value: np.ndarray
    gradient: np.ndarray
    det: np.ndarray
    x: np.ndarray
    tangent: np.ndarray


def reference(element, points):
    """Values (nb, nq) and reference gradients (nb, dim, nq) of a scikit-fem element."""
    count = element.refdom.nnodes * element.nodal_dofs
    count += (element.refdom.nedges or 0) * element.edge_dofs if element.refdom.dim() == 3 else 0
    count += element.refdom.nfacets * element.facet_dofs + element.interior_dofs
    value, gradient = zip(*(element.lbasis(points, i) for i in range(count)))
    shape = points.shape[1:]
    value = np.array([np.broadcast_to(v, shape) for v in value])
    gradient = np.array([[np.broadcast_to(g, shape) for g in grad] for grad in gradient])
    return value, gradient


def tabulate(geometry, nodes, element, points) -> Tabulated:
    """Tabulate basis functions in physical coordinates.

    Parameters
    ----------
    geometry : scikit-fem element
        Of the mapping; for an isoparametric element the element itself.
    nodes : (dim, nn, ne) ndarray
        Nodes of the mapping, m.
    element : scikit-fem element
        Of the unknowns.
    points : (dim, nq) ndarray
        Reference points.
    """
    shape, dshape = reference(geometry, points)
    value, dvalue = (shape, dshape) if geometry is element else reference(element, points)
    x = np.einsum("dne,nq->deq", nodes, shape, optimize=True)
    jac = np.einsum("dne,ncq->eqdc", nodes, dshape, optimize=True)
    det = np.linalg.det(jac)
    inverse = np.linalg.inv(jac)
    gradient = np.einsum("bcq,eqcd->ebdq", dvalue, inverse, optimize=True)
    return Tabulated(value, gradient, det, x, jac)


def unknowns(mesh, element) -> np.ndarray:
    """(nb, ne) scalar numbering of unknowns, scikit-fem's own."""
    return np.asarray(Dofs(mesh, element).element_dofs)


class Pattern:
    """Sparse pattern of an element connectivity, reused for every matrix on it.

    Parameters
    ----------
    dofs : (nb, ne) ndarray of int
    """

    def __init__(self, dofs: np.ndarray):
        self.dofs = dofs
        self.n = int(dofs.max()) + 1
        nb, ne = dofs.shape
        row = np.broadcast_to(dofs.T[:, :, None], (ne, nb, nb)).ravel().astype(np.int64)
        col = np.broadcast_to(dofs.T[:, None, :], (ne, nb, nb)).ravel()
        keys, self.place = np.unique(row * self.n + col, return_inverse=True)
        self.indices = (keys % self.n).astype(np.int32)
        self.indptr = np.searchsorted(keys, np.arange(self.n + 1, dtype=np.int64) * self.n).astype(np.int32)

    def scalar(self, parts) -> sp.csr_matrix:
        """Sum (m, nb, nb) element matrices, given in order and in parts, into an (n, n) matrix."""
        return self.blocks(part[:, :, None, :, None] for part in parts)

    def blocks(self, parts) -> sp.csr_matrix:
        """Sum (m, nb, c, nb, c) element matrices into an (n c, n c) matrix, unknowns grouped by node."""
        data, done = None, 0
        square = self.dofs.shape[0] ** 2
        for part in parts:
            c = part.shape[2]
            if data is None:
                data = np.zeros((c, c, len(self.indices)))
            place = self.place[done : done + len(part) * square]
            done += len(part) * square
            for i in range(c):
                for j in range(c):
                    data[i, j] += np.bincount(place, weights=part[:, :, i, :, j].ravel(), minlength=len(self.indices))
        if c == 1:
            return sp.csr_matrix((data[0, 0], self.indices, self.indptr), shape=(self.n,) * 2)
        data = np.ascontiguousarray(np.moveaxis(data, 2, 0))
        return sp.bsr_matrix((data, self.indices, self.indptr), shape=(self.n * c,) * 2).tocsr()


def chunks(count: int, bytes_each: float):
    """Slices of a range whose work arrays stay within ``CHUNK_BYTES``."""
    step = max(1, int(CHUNK_BYTES / bytes_each))
    return [slice(i, min(i + step, count)) for i in range(0, count, step)]
