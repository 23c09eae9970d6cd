"""A free body seen from the ports: rigid motions, lowest free modes, and residual flexibility.

Rubin's representation (1975, AIAA J. 13, 996): with U the free elastic modes, G the rows of the
ports and H the inverse of K without rigid motions and without U, a body is

    u = R a + U q + H G' f,    rigid mass, lambda, G U,    mu_0 = G H G',    mu_1 = G H M H G',

numbers of the ports alone, on any mesh. Two meshes of one part have nearly the same numbers, so that
those of one can be corrected by the difference of two others.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import min_weight_full_bipartite_matching

from solidgear.core import Body, modes
from solidgear.core.solve.statics import port_fields, twin_matrix

#: stations by whose motions modes of two meshes are recognised
STATIONS = 25
#: share of a mode that sections must hold to be one of a shaft: ovalising is left to mu_0
SHAFT = 0.5


@dataclass
class Modal:
    """Port numbers of a free body."""

    rigid_mass: np.ndarray  #: (6, 6)
    #: (k, k) stiffness among the modes, rad^2/s^2: diagonal before it is corrected
    value: np.ndarray
    motions: np.ndarray  #: (6 p, k) G U
    sections: np.ndarray  #: (6 s, k) motions of sections in every mode
    gram: np.ndarray  #: (6 s, 6 s) mass matrix of sections
    static: np.ndarray  #: (6 p, 6 p) mu_0 before any mode is taken out of H
    inert: np.ndarray  #: (6 p, 6 p) mu_1 likewise
    vectors: list[dict[int, np.ndarray]]  #: the modes on the mesh
    moves: list[tuple[int, ...]]  #: port components of the block that each mode is of
    #: ``H G'`` on the mesh likewise, by block, columns of that block's port components
    fields: dict[int, np.ndarray]

    def residual(self, turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return mu_0 and mu_1, (6 p, 6 p) each, with orthonormal combinations (k, l) of the modes
        taken out.
        """
        motions, value = self.motions @ turn, turn.T @ self.value @ turn
        reached = np.linalg.solve(value, motions.T)
        return self.static - motions @ reached, self.inert - reached.T @ reached

    def without_modes(self, fields: np.ndarray, index: int, rows: np.ndarray) -> np.ndarray:
        """Return fields (n, q) of unit loads on port components of a block, the modes taken out."""
        for i, vector in enumerate(self.vectors):
            if index in vector:
                reached = self.motions[rows, i] / self.value[i, i]
                fields = fields - np.outer(vector[index], reached)
        return fields

    def first(self, count: int) -> Modal:
        """Return the same with the lowest modes only."""
        return replace(
            self,
            value=self.value[:count, :count],
            motions=self.motions[:, :count],
            sections=self.sections[:, :count],
            vectors=self.vectors[:count],
            moves=self.moves[:count],
        )

    def within(self, components: tuple[int, ...]) -> np.ndarray:
        """Return the places of the modes that move in these port components and in no others."""
        return np.array(
            [k for k, moved in enumerate(self.moves) if set(moved) <= set(components)], int
        )


def modal(body: Body, count: int) -> Modal:
    """Compute the port numbers of a free body with the ``count`` lowest modes, twins counted twice."""
    mode_set = modes(body, (), n=count, ovalising=False, stations=STATIONS)
    vectors, values, moved = [], [], []
    for mode in mode_set.modes:
        if mode.frequency_hz == 0.0 or mode.captured < SHAFT:
            continue
        for vector, motion in zip(mode.vectors, mode.motions):
            vectors.append(vector)
            moved.append(motion.ravel())
            values.append(sum(v @ (body.blocks[b].stiffness @ v) for b, v in vector.items()))
    motions = np.array([body.port_motions(v) for v in vectors]).T
    sections = np.array(moved).T
    static, inert, fields = _static(body)
    return Modal(
        rigid_mass=body.mass_matrix(),
        value=np.diag(values),
        motions=motions.reshape(6 * len(body.ports), len(vectors)),
        sections=sections.reshape(6 * STATIONS, len(vectors)),
        gram=mode_set.gram,
        static=static,
        inert=inert,
        vectors=vectors,
        moves=[body.blocks[next(iter(vector))].components for vector in vectors],
        fields=fields,
    )


def _static(body: Body) -> tuple[np.ndarray, np.ndarray, dict[int, np.ndarray]]:
    """Return mu_0, mu_1 and the fields of unit port loads, rigid motions taken out."""
    n = 6 * len(body.ports)
    static, inert = np.zeros((2, n, n))
    fields: dict[int, np.ndarray] = {}
    for index, u, work, _ in port_fields(body, 1e-20):
        block = body.blocks[index]
        rows = np.ix_(body.rows(block), body.rows(block))
        static[rows], inert[rows] = work, u.T @ (block.mass @ u)
        fields[index] = u
    for index, block in enumerate(body.blocks):
        if block.mirror is not None:
            rows = np.ix_(body.rows(block), body.rows(block))
            for matrix in (static, inert):
                matrix[rows] = twin_matrix(body, block, matrix)
            original, signs = block.mirror
            fields[index] = fields[original] * np.tile(signs, len(body.ports))
    return (static + static.T) / 2, (inert + inert.T) / 2, fields


def alike_turn(sections: np.ndarray, reference: np.ndarray, gram: np.ndarray) -> np.ndarray:
    """Return the rotation (k, l) of modes that makes them most like others, by their section motions
    (6 s, k) and (6 s, l), with orthonormal columns (k >= l).

    Every one of the others is given a mode, by the squared cosine between them; these are turned among
    themselves so that ``sections @ turn`` is nearest to ``reference`` (the orthogonal Procrustes
    problem). Modes without a partner take no part: the span stays one of modes.

    Examples
    --------
    >>> alike_turn(np.eye(2), -np.eye(2)[:, ::-1], np.eye(2)).round(12) + 0.0
    array([[ 0., -1.],
           [-1.,  0.]])
    """
    product = sections.T @ gram @ reference
    size, reference_size = (np.einsum("ik,ij,jk->k", s, gram, s) for s in (sections, reference))
    # from 1 on, for a zero in a sparse matrix is a pair that is not allowed
    cosines = sp.csr_matrix(1.0 + product.T**2 / np.outer(reference_size, size))
    _, chosen = min_weight_full_bipartite_matching(cosines, maximize=True)
    u, _, vt = np.linalg.svd(product[chosen])
    turn = np.zeros(product.shape)
    turn[chosen] = u @ vt
    return turn
