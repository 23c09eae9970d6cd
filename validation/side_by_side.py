"""A body as one pair of matrices, as a program that knows no symmetry would hold it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Block


def side_by_side(
    blocks: Sequence[Block], ports: int
) -> tuple[sp.csc_matrix, sp.csc_matrix, sp.csr_matrix]:
    """K and M of blocks on one diagonal, and six rows for each of the ports that give its motion."""
    motions = []
    for block in blocks:
        at = (6 * np.arange(ports)[:, None] + np.array(block.components)).ravel()
        ones = (np.ones(len(at)), (at, np.arange(len(at))))
        motions.append(sp.csr_matrix(ones, shape=(6 * ports, len(at))) @ block.ports)
    stiffness = sp.block_diag([b.stiffness for b in blocks], "csc")
    mass = sp.block_diag([b.mass.tocsr() for b in blocks], "csc")
    return stiffness, mass, sp.hstack(motions, "csr")
