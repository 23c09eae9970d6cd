"""A solved body on other springs: what its modes and the static deflections of its ports span.

Springs and masses stay outside, so that another set of them costs an eigenproblem of a hundred
unknowns (Rayleigh and Ritz; the static deflections are the residual attachment modes of MacNeal
1971, Computers & Structures 1, 581). Exact at the springs it was solved on, near beside them.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla
from scipy.optimize import linear_sum_assignment

from solidgear.body import Supports, as_supports
from solidgear.solve.statics import flexibility
from solidgear.studies.measured.computed import Computed

#: of the largest, that a direction counts from on
LEAST = 1e-12


class Sprung:
    """Modes of a computed set under other springs and masses on the same ports."""

    def __init__(self, computed: Computed):
        body, supports = computed.body, as_supports(computed.scene)
        self.there = supports.rows(body)
        fields = flexibility(body).fields
        self.owner = np.array([j for j, mode in enumerate(computed.modes) for _ in mode.vectors])
        shapes = [shape for mode in computed.modes for shape in mode.vectors]
        ports, stiff, known = [], [], []
        for index, block in enumerate(body.blocks):
            if not block.components:
                continue
            original = block.mirror[0] if block.mirror else index
            own = [shape[index][:, None] for shape in shapes if index in shape]
            # which bodies that are not of revolution do not keep
            static = fields.get(original, block.rigid)
            spans = np.hstack([*own, static, block.rigid])
            spans = spans / np.sqrt(np.einsum("nk,nk->k", spans, block.mass @ spans))
            size, turn = np.linalg.eigh(spans.T @ (block.mass @ spans))
            kept = size > LEAST * size[-1]
            basis = spans @ (turn[:, kept] / np.sqrt(size[kept]))
            heavy = block.mass @ basis
            moved = np.zeros((6 * len(body.ports), basis.shape[1]))
            moved[body.rows(block)] = block.ports @ basis
            ports.append(moved)
            stiff.append(basis.T @ (block.stiffness @ basis))
            none = np.zeros(basis.shape[1])
            known.append([heavy.T @ s[index] if index in s else none for s in shapes])
        self.ports = np.hstack(ports)[self.there]
        self.stiffness = sla.block_diag(*stiff)
        self.known = np.hstack([np.array(part) for part in known])
        self.hertz = np.array([mode.frequency_hz for mode in computed.modes])
        self.ratio = np.ones(len(self.hertz))
        self.ratio = self.hertz / self.at(supports)[0]

    def at(self, supports: Supports) -> tuple[np.ndarray, np.ndarray]:
        """(modes,) frequencies of the modes that these are, Hz, and (shapes, 6 m) motions of the ports
        in each of their shapes, normed to the mass.
        """
        stiff = self.stiffness + self.ports.T @ supports.stiffness @ self.ports
        heavy = np.eye(len(stiff)) + self.ports.T @ supports.masses @ self.ports
        value, shapes = sla.eigh(stiff, heavy)
        alike = (self.known @ heavy @ shapes) ** 2
        rows, columns = linear_sum_assignment(-alike)
        square = np.zeros(len(self.hertz))
        count = np.bincount(self.owner, minlength=len(square))
        np.add.at(square, self.owner[rows], np.maximum(value[columns], 0.0))
        free = ~self.known.any(axis=1)  # shapes that move no port
        found = np.sqrt(square / count) / (2 * np.pi) * self.ratio
        motions = np.zeros((len(self.owner), len(self.ports)))
        motions[rows] = (self.ports @ shapes[:, columns]).T
        motions[free] = 0.0
        found[self.owner[free]] = self.hertz[self.owner[free]]
        return found, motions

    def slopes(
        self, at: tuple[np.ndarray, np.ndarray], low: Supports, high: Supports
    ) -> np.ndarray:
        """(modes,) changes of the logarithms of frequencies from springs to others, at what :meth:`at`
        gives of those between.
        """
        square, motions = (2 * np.pi * at[0]) ** 2, at[1]
        stiff, heavy = high.stiffness - low.stiffness, high.masses - low.masses
        each = np.einsum("sa,ab,sb->s", motions, stiff, motions, optimize=True)
        each -= square[self.owner] * np.einsum(
            "sa,ab,sb->s", motions, heavy, motions, optimize=True
        )
        return np.bincount(self.owner, each) / np.bincount(self.owner) / (2 * square)
