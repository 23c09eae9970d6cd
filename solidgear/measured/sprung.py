"""A solved body on other springs, in the span of its modes and of the static deflections of the
ports.

Springs and masses stay outside, so that another set of them costs an eigenproblem of a hundred
unknowns (Rayleigh and Ritz; the static deflections are the residual attachment modes of MacNeal
1971, Computers & Structures 1, 581). Exact at the springs it was solved on, near beside them.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla
from scipy.optimize import linear_sum_assignment

from solidgear.core import Supports, as_supports, flexibility
from solidgear.measured.computed import Computed

#: of the largest, that a direction counts from on
LEAST = 1e-12


class Sprung:
    """Modes of a computed set under other springs and masses on the same ports."""

    def __init__(self, computed: Computed):
        body, supports = computed.body, as_supports(computed.scene)
        self.port_rows = supports.rows(body)
        fields = flexibility(body).fields
        self.owner = np.array([j for j, mode in enumerate(computed.modes) for _ in mode.vectors])
        shapes = [shape for mode in computed.modes for shape in mode.vectors]
        ports, stiff, references = [], [], []
        for index, block in enumerate(body.blocks):
            if not block.components:
                continue
            original = block.mirror[0] if block.mirror else index
            shapes_here = [shape[index][:, None] for shape in shapes if index in shape]
            # which bodies that are not of revolution do not keep
            static = fields.get(original, block.rigid)
            spans = np.hstack([*shapes_here, static, block.rigid])
            spans = spans / np.sqrt(np.einsum("nk,nk->k", spans, block.mass @ spans))
            size, turn = np.linalg.eigh(spans.T @ (block.mass @ spans))
            independent = size > LEAST * size[-1]
            basis = spans @ (turn[:, independent] / np.sqrt(size[independent]))
            heavy = block.mass @ basis
            moved = np.zeros((6 * len(body.ports), basis.shape[1]))
            moved[body.rows(block)] = block.ports @ basis
            ports.append(moved)
            stiff.append(basis.T @ (block.stiffness @ basis))
            zero = np.zeros(basis.shape[1])
            references.append([heavy.T @ s[index] if index in s else zero for s in shapes])
        self.ports = np.hstack(ports)[self.port_rows]
        self.stiffness = sla.block_diag(*stiff)
        self.references = np.hstack([np.array(part) for part in references])
        self.hertz = np.array([mode.frequency_hz for mode in computed.modes])
        self.ratio = np.ones(len(self.hertz))
        self.ratio = self.hertz / self.modes_on(supports)[0]

    def modes_on(self, supports: Supports) -> tuple[np.ndarray, np.ndarray]:
        """Return frequencies (modes,) of the same modes on other springs, Hz, and motions (shapes,
        6 m) of the ports in each of their shapes, normalised to the mass.
        """
        stiff = self.stiffness + self.ports.T @ supports.stiffness @ self.ports
        heavy = np.eye(len(stiff)) + self.ports.T @ supports.masses @ self.ports
        value, shapes = sla.eigh(stiff, heavy)
        overlap = (self.references @ heavy @ shapes) ** 2
        rows, columns = linear_sum_assignment(-overlap)
        square = np.zeros(len(self.hertz))
        count = np.bincount(self.owner, minlength=len(square))
        np.add.at(square, self.owner[rows], np.maximum(value[columns], 0.0))
        free = ~self.references.any(axis=1)  # shapes that move no port
        frequencies = np.sqrt(square / count) / (2 * np.pi) * self.ratio
        motions = np.zeros((len(self.owner), len(self.ports)))
        motions[rows] = (self.ports @ shapes[:, columns]).T
        motions[free] = 0.0
        frequencies[self.owner[free]] = self.hertz[self.owner[free]]
        return frequencies, motions

    def slopes(
        self, modes: tuple[np.ndarray, np.ndarray], low: Supports, high: Supports
    ) -> np.ndarray:
        """Return changes (modes,) of the logarithms of frequencies between two sets of springs,
        from the result of :meth:`modes_on` between them.
        """
        square, motions = (2 * np.pi * modes[0]) ** 2, modes[1]
        stiff, heavy = high.stiffness - low.stiffness, high.masses - low.masses
        changes = np.einsum("sa,ab,sb->s", motions, stiff, motions, optimize=True)
        changes -= square[self.owner] * np.einsum(
            "sa,ab,sb->s", motions, heavy, motions, optimize=True
        )
        return np.bincount(self.owner, changes) / np.bincount(self.owner) / (2 * square)
