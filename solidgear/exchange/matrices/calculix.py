"""CalculiX: matrices as unit masses on springs, tied to the points by equations.

CalculiX reads no matrix of six directions a node in all its versions, but masses, springs and
linear equations in each.  In the modes of the free body, ``K = diag(w^2)`` and ``M = 1`` are exact
as ``*SPRING`` and ``*MASS``; points move by their shares of the modes in ``*EQUATION``.  A point is
two nodes, as ``*RIGID BODY`` takes them: REF NODE with x y z, and ROT NODE, whose x y z are
rotations.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.linalg as sla

from solidgear.core import SolidgearError
from solidgear.core.reduction.matrix_units import MatrixUnits
from solidgear.core.reduction.port_matrices import PortMatrices, not_free
from solidgear.exchange.matrices.header import header, quoted
from solidgear.exchange.matrices.nodes import real

#: share of the largest motion of a point that is rounding, and of stiffness that is a free motion
TRIFLE, FREE = 1e-13, 1e-12


def write(matrices: PortMatrices, path: Path, units: MatrixUnits) -> dict[Path, bytes]:
    """Return the deck, to be taken by ``*INCLUDE`` or as it is."""
    if matrices.damping is not None or matrices.gyroscopic is not None:
        raise SolidgearError(
            "CalculiX takes neither damping nor gyroscopic matrices here; export without them"
        )
    value, shapes = _modes(matrices)
    count, modes = len(matrices.positions), len(value)
    unit = units.coordinates(count, matrices.modes)
    root = np.sqrt(units.energy)
    moved = (shapes / unit[:, None] * root)[: 6 * count]
    lines = [f"** {line}" for line in header(matrices, units) if "is node" not in line]
    for k, name in enumerate(matrices.positions):
        lines.append(f"** point {quoted(name)}: REF NODE {2 * k + 1}, ROT NODE {2 * k + 2}")
    lines.append("** a node of a mode has up to three of them, along its directions")
    lines.append("*NODE, NSET=POINTS")
    for k, place in enumerate(matrices.positions.values()):
        x, y, z = (real(v / units.length) for v in place)
        lines += [f"{2 * k + node}, {x}, {y}, {z}" for node in (1, 2)]
    first, nodes = 2 * count + 1, -(-modes // 3)
    lines.append("*NODE, NSET=MODES")
    lines += [f"{first + k}, {k}., 0., 0." for k in range(nodes)]
    lines.append("*ELEMENT, TYPE=MASS, ELSET=MASSES")
    lines += [f"{k + 1}, {first + k}" for k in range(nodes)]
    lines += ["*MASS, ELSET=MASSES", "1."]
    element = nodes
    for k, square in enumerate(value):
        if square:
            element += 1
            lines.append(f"*ELEMENT, TYPE=SPRING1, ELSET=S{k + 1}")
            lines.append(f"{element}, {first + k // 3}")
            lines += [f"*SPRING, ELSET=S{k + 1}", f"{k % 3 + 1}", f"{real(square)}"]
    spare = range(modes, 3 * nodes)
    if spare:
        lines.append("*BOUNDARY")
        lines += [f"{first + k // 3}, {k % 3 + 1}, {k % 3 + 1}" for k in spare]
    for row, shares in enumerate(moved):
        lines += _equation(row, shares, first)
    return {path: ("\n".join(lines) + "\n").encode()}


def _modes(matrices: PortMatrices) -> tuple[np.ndarray, np.ndarray]:
    """Return eigenvalues, exactly zero of free motions, and mass-normalised shapes (n, m)."""
    if not_free(matrices) is None:
        lower = np.linalg.cholesky(matrices.mass)
        omega, strain = matrices.elastic
        # strain rows are shapes times mass and frequency
        elastic = sla.cho_solve((lower, True), strain.T) / omega
        rigid = matrices.rigid(matrices.centre)
        root = np.linalg.cholesky(matrices.rigid_mass)
        rigid = sla.solve_triangular(root, rigid.T, lower=True).T
        return np.r_[np.zeros(6), omega**2], np.hstack([rigid, elastic])
    value, shapes = sla.eigh(matrices.stiffness, matrices.mass)
    return np.where(value < FREE * value[-1], 0.0, value), shapes


def _equation(row: int, shares: np.ndarray, first: int) -> list[str]:
    """Return the equation of one motion of a point."""
    node, direction = 2 * (row // 6) + (row % 6) // 3 + 1, row % 3 + 1
    terms = [f"{node}, {direction}, 1."]
    for k in np.flatnonzero(np.abs(shares) > TRIFLE * np.abs(shares).max(initial=0.0)):
        terms.append(f"{first + k // 3}, {k % 3 + 1}, {real(-shares[k])}")
    lines = [", ".join(terms[k : k + 4]) for k in range(0, len(terms), 4)]
    return ["*EQUATION", str(len(terms)), *lines]
