"""Block assembly on scikit-fem elements: tabulate once, batch the element matrices.

scikit-fem supplies elements, mappings, quadrature and the numbering of unknowns; its own forms (the
oracle in the tests) spend their time in Python loops over pairs of vector components. Batches are
small enough to stay in the cache: fresh memory costs more than the arithmetic.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
from skfem import Element, ElementQuad1, ElementQuad2, Mesh
from skfem.assembly import Dofs
from skfem.element import ElementQuadP

from solidgear.core.body.symmetric import Symmetric
from solidgear.core.kernel.room import assemblable, assembled

BATCH_BYTES = 4e6
# Rounding of coordinates puts the nodes of a straight element off by 1e-14 to 1e-13 of its least
# extent; a bend changes the entries by about its own size.  Elements bent by more go through
# quadrature.
STRAIGHT = 3e-13
#: elements of meridians: their functions of high order take longer than the matrices of a coarse mesh
QUADRILATERALS = (ElementQuad1, ElementQuad2, ElementQuadP)
#: coordinates of reference points up to which functions are kept: points of rules
FEW = 2_000


@dataclass(frozen=True)
class Tabulated:
    """Basis functions of some elements at reference points."""

    value: np.ndarray  #: (nb, nq)
    slope: np.ndarray  #: (nb, dim, nq) reference gradients
    det: np.ndarray  #: (ne, nq) determinant of the Jacobian, m^dim
    x: np.ndarray  #: (dim, ne, nq) places, m
    #: jac, inverse: (dim, dim, ne, nq) derivative of position along reference coordinates, m, and
    #: its inverse
    jac: np.ndarray
    inverse: np.ndarray

    @property
    def tangent(self) -> np.ndarray:
        """(ne, nq, dim, dim) derivative of position (third axis) along reference coordinates
        (fourth).
        """
        return self.jac.transpose(2, 3, 0, 1)

    def gradient(self, factor: np.ndarray) -> np.ndarray:
        """Return (ne, dim, nb, nq) gradients in physical coordinates, times a factor (ne, nq)."""
        scaled = self.inverse * factor
        dim = len(scaled)
        out = np.empty((scaled.shape[2], dim, *self.value.shape))
        for i in range(dim):
            np.multiply(self.slope[:, 0], scaled[0, i][:, None], out=out[:, i])
            for c in range(1, dim):
                out[:, i] += self.slope[:, c] * scaled[c, i][:, None]
        return out


def reference(element: Element, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return values (nb, nq) and reference gradients (nb, dim, nq) of an element at points (dim,
    nq).

    Examples
    --------
    >>> from skfem import ElementQuad1
    >>> value, gradient = reference(ElementQuad1(), np.array([[0.5], [0.5]]))
    >>> value.ravel()
    array([0.25, 0.25, 0.25, 0.25])
    """
    if type(element) in QUADRILATERALS and points.size <= FEW:
        number, points = QUADRILATERALS.index(type(element)), np.asarray(points, float)
        return _once(number, getattr(element, "p", 0), points.shape, points.tobytes())
    return _reference(element, points)


@lru_cache(maxsize=64)
def _once(
    number: int, order: int, shape: tuple[int, ...], places: bytes
) -> tuple[np.ndarray, np.ndarray]:
    """Return values and gradients of a quadrilateral, of an order where its type has several, once
    for all meshes.
    """
    element, points = QUADRILATERALS[number], np.frombuffer(places).reshape(shape)
    value, gradient = _reference(element(order) if order else element(), points)
    value.setflags(write=False)
    gradient.setflags(write=False)
    return value, gradient


def _reference(element: Element, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return values and gradients as :func:`reference`, evaluated anew."""
    count = element.refdom.nnodes * element.nodal_dofs
    count += (element.refdom.nedges or 0) * element.edge_dofs if element.refdom.dim() == 3 else 0
    count += element.refdom.nfacets * element.facet_dofs + element.interior_dofs
    values, gradients = zip(*(element.lbasis(points, i) for i in range(count)))
    shape = points.shape[1:]
    value = np.array([np.broadcast_to(v, shape) for v in values])
    gradient = np.empty((count, len(gradients[0]), *shape))
    for rows, grad in zip(gradient, gradients):
        for out, g in zip(rows, grad):
            out[:] = g
    return value, gradient


class Tabulation:
    """Basis functions of an element at reference points (dim, nq), to be mapped to elements a batch
    at a time; `geometry` is the element of the mapping, of an isoparametric one itself.
    """

    def __init__(self, geometry: Element, element: Element, points: np.ndarray):
        self._shape, self._dshape = reference(geometry, points)
        self.value, self.slope = (
            (self._shape, self._dshape) if geometry is element else reference(element, points)
        )

    def on(self, nodes: np.ndarray) -> Tabulated:
        """Tabulate on some elements, by the nodes (dim, nn, ne) of their mapping, m."""
        nn, dim, nq = self._dshape.shape
        nodes = np.ascontiguousarray(nodes.transpose(0, 2, 1))
        jac = (
            (nodes @ self._dshape.reshape(nn, dim * nq))
            .reshape(dim, -1, dim, nq)
            .transpose(0, 2, 1, 3)
        )
        inverse, det = inverted(jac)
        return Tabulated(self.value, self.slope, det, nodes @ self._shape, jac, inverse)


def tabulate(
    geometry: Element, nodes: np.ndarray, element: Element, points: np.ndarray
) -> Tabulated:
    """Tabulate basis functions once; parameters as for :class:`Tabulation`."""
    return Tabulation(geometry, element, points).on(nodes)


def inverted(jac: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return inverses and determinants of (d, d, ...) matrices, d = 2 or 3, by cofactors.

    Examples
    --------
    >>> inverse, det = inverted(np.array([[2.0, 0.0], [1.0, 4.0]]))
    >>> float(det), inverse[1]
    (8.0, array([-0.125,  0.25 ]))
    """
    d = len(jac)
    if d == 2:
        det = jac[0, 0] * jac[1, 1] - jac[0, 1] * jac[1, 0]
        return np.array([[jac[1, 1], -jac[0, 1]], [-jac[1, 0], jac[0, 0]]]) / det, det
    out = np.empty(jac.shape)
    for i in range(3):
        for j in range(3):
            # cyclic indices bring the signs along
            a, b, c, e = (j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3
            np.multiply(jac[a, c], jac[b, e], out=out[i, j])
            out[i, j] -= jac[a, e] * jac[b, c]
    det = sum(out[0, j] * jac[j, 0] for j in range(3))
    out /= det
    return out, det


def straight(element: Element, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a mask (ne,) of elements whose nodes (dim, nb, ne), one for every unknown, are an
    affine image of the reference nodes to ``STRAIGHT`` of their smallest extent, and the constant
    Jacobians (dim, dim, ne) in the least-squares sense, position first.
    """
    dim, _, ne = nodes.shape
    affine = np.column_stack([element.doflocs, np.ones(len(element.doflocs))])
    jac = np.matmul(np.linalg.pinv(affine)[:dim], nodes)
    bend = np.matmul(sla.null_space(affine.T).T, nodes)
    bend = np.sqrt(np.einsum("dne,dne->e", bend, bend))
    size = np.sqrt(np.einsum("dce,dce->e", jac, jac))
    # the least extent is at least the determinant over the square (in the plane: the first power)
    # of the largest
    return bend <= STRAIGHT * np.abs(inverted(jac)[1]) / size ** (dim - 1), jac


def unknowns(mesh: Mesh, element: Element) -> np.ndarray:
    """Return the (nb, ne) numbering of scalar unknowns, scikit-fem's own."""
    return np.asarray(Dofs(mesh, element).element_dofs)


class Pattern:
    """Sparse pattern of an element connectivity (nb, ne), reused for every matrix on it.

    With rows for the functions of an element from the `first` on alone, the columns of these are
    held on and above the diagonal, since matrices are symmetric; others have lesser numbers.

    Examples
    --------
    Two springs of 1 and 2 N/m in a row:

    >>> pattern = Pattern(np.array([[0, 1], [1, 2]]))
    >>> chain = pattern.sum()
    >>> spring = np.array([[1.0, -1.0], [-1.0, 1.0]])
    >>> chain.add(np.array([0, 1]), np.array([spring, 2 * spring]))
    >>> chain.matrix().toarray()
    array([[ 1., -1.,  0.],
           [-1.,  3., -2.],
           [ 0., -2.,  2.]])
    """

    def __init__(self, dofs: np.ndarray, first: int = 0):
        rows = dofs[first:]
        least = int(rows.min()) if first else 0
        #: number of unknowns, of those before any that has a row, and of those that have rows
        self.n, self.before, self.of_rows = int(dofs.max()) + 1, least, int(rows.max()) + 1 - least
        nb, ne = dofs.shape
        nr = len(rows)
        assemblable(ne, nb, nr)
        numbers = np.ascontiguousarray(dofs.T, np.int32)
        row_numbers = np.ascontiguousarray(rows.T, np.int32) - np.int32(least)
        # Element entries row by row, each row being an unknown of an element.  A transposition is a
        # counting sort by column that leaves rows in order: columns first, then rows.
        slots = np.arange(ne * nb, dtype=np.int32).reshape(ne, nb)
        by_row = sp.csr_matrix(
            (slots.ravel(), numbers.ravel(), np.arange(0, ne * nb + 1, nb)), shape=(ne, self.n)
        ).tocsc()
        element, a = by_row.indices, by_row.data % nb
        entry = (element * (nr * nb) + a)[:, None] + np.arange(0, nr * nb, nb, dtype=np.int32)
        entries = sp.csr_matrix(
            (entry.ravel(), row_numbers[element].ravel(), by_row.indptr * nr),
            shape=(self.n, self.of_rows),
        ).tocsc()
        # a change of column opens a new entry, and so does a change of row
        opens = np.ones(entries.nnz, bool)
        np.not_equal(entries.indices[1:], entries.indices[:-1], out=opens[1:])
        opens[entries.indptr[:-1][np.diff(entries.indptr) > 0]] = True
        below = np.zeros(entries.nnz, bool)
        if first:
            row = np.arange(least, least + self.of_rows, dtype=np.int32)
            below = entries.indices < np.repeat(row, np.diff(entries.indptr))
            below &= entries.indices >= least
            opens &= ~below
        starts = np.flatnonzero(opens)
        number = np.cumsum(opens, dtype=np.int32) - 1
        number[below] = len(starts)  # nothing reads that one
        #: place of every entry of every element matrix among the entries of the assembled one
        self.place = np.empty((ne, nr * nb), np.int32)
        self.place.ravel()[entries.data] = number
        self.indices = entries.indices[starts]
        self.indptr = np.searchsorted(starts, entries.indptr).astype(np.int32)

    def sum(self, components: int = 1) -> Sum:
        """Return an empty matrix on this pattern, of a number of unknowns of a node, numbered
        together.
        """
        return Sum(self, components)


class Sum:
    """A matrix that element matrices are added to; see :meth:`Pattern.sum`."""

    def __init__(self, pattern: Pattern, components: int):
        self.pattern, self.c = pattern, components
        entries = (len(pattern.indices) + 1) * components**2
        assembled(entries, pattern.n * components)
        self._data = np.zeros(entries)

    def add(self, elements: slice | np.ndarray, values: np.ndarray) -> None:
        """Add element matrices (c, c, m, nr, nb), component of row and column first; of one
        component (m, nr, nb) will do.
        """
        c = self.c
        places = self.pattern.place[elements].ravel() * np.intp(c * c)
        for k, plane in enumerate(values.reshape(c * c, -1)):
            np.add.at(self._data[k:], places, plane)

    @property
    def data(self) -> np.ndarray:
        """Entries, those of the components of a node together."""
        return self._data[: -(self.c**2)]

    def matrix(self) -> sp.csr_matrix:
        """Return the assembled (rows c, n c) matrix, with unknowns grouped by node."""
        p, c = self.pattern, self.c
        if c == 1:
            return sp.csr_matrix((self.data, p.indices, p.indptr), shape=(p.of_rows, p.n))
        return sp.bsr_matrix(
            (self.data.reshape(-1, c, c), p.indices, p.indptr), shape=(p.of_rows * c, p.n * c)
        ).tocsr()

    def before(self) -> sp.csr_matrix:
        """Return the part in the columns of unknowns before any that has a row."""
        p = self.pattern
        return self._part(p.indices < p.before, 0, p.before)

    def symmetric(self) -> Symmetric:
        """Return the part in the columns of unknowns that have rows."""
        p, c = self.pattern, self.c
        upper = self._part(p.indices >= p.before, p.before, p.of_rows)
        row = np.repeat(np.arange(c * p.of_rows, dtype=np.int32), np.diff(upper.indptr))
        upper.data[upper.indices < row] = 0.0  # of blocks on the diagonal
        upper.eliminate_zeros()
        return Symmetric(upper)

    def _part(self, chosen: np.ndarray, offset: int, width: int) -> sp.csr_matrix:
        """Return chosen entries, of some columns."""
        p, c = self.pattern, self.c
        count = np.concatenate([[0], np.cumsum(chosen)])
        return sp.bsr_matrix(
            (self.data.reshape(-1, c, c)[chosen], p.indices[chosen] - offset, count[p.indptr]),
            shape=(p.of_rows * c, width * c),
        ).tocsr()


def batches(elements: np.ndarray, bytes_each: float) -> list[np.ndarray]:
    """Cut a list of elements into pieces whose work arrays stay within ``BATCH_BYTES``."""
    step = max(1, int(BATCH_BYTES / bytes_each))
    return [elements[i : i + step] for i in range(0, len(elements), step)]
