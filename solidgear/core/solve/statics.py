"""Elastic flexibility of a free body at its ports, and condensation to one port with bearings.

The free body is factored once, as ``K + sigma M`` with a small sigma; everything about bearings
happens in dense matrices of the size of the ports. Derivation of the formulas:

A free body under self-equilibrated port loads f moves its ports by ``d = F f + P a`` with F the
inertia-relief flexibility and P the rigid motions. With springs ``f_b = -Kb d_b`` on the bearing
ports and equilibrium ``P_l' f_l = P_b' Kb d_b``, eliminating ``d_b`` gives

    C = F_ll - F_lb S F_bl + (P_l - F_lb S P_b) H^-1 (P_l - F_lb S P_b)'
    S = L (I + L' F_bb L)^-1 L',   Kb = L L',   H = P_b' S P_b

Nothing is subtracted that is larger than the result when springs are soft, and nothing overflows
when they are stiff. A rigid motion that no spring resists is taken out exactly, so a free torsion
is an exact zero and not a penalty.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import overload

import numpy as np
import scipy.linalg as sla

from solidgear.core.body import Block, Body, as_supports
from solidgear.core.body.supports import Holding, separated
from solidgear.core.errors import SolidgearError, show
from solidgear.core.machine.threads import pinned
from solidgear.core.solve.condensed import Condensed, Coupled
from solidgear.core.solve.inertia_relief import relieved_fields
from solidgear.core.solve.shifted import factors

# Relative error of a compliance where refinement gives none, and that of a stiffness above which
# two points count as one.
ROUNDING, APART = 1e-14, 1e-4
# Of the geometric mean of two diagonal entries: a coupling that is none.
LAST_DIGIT = 1e-15
# Relative error of the energy of fields for local problems.
SOLVED = 1e-26


@dataclass(frozen=True)
class Flexibility:
    """Inertia-relief flexibility of a free body at the ports."""

    matrix: np.ndarray  #: (6 p, 6 p) symmetric positive semidefinite, SI
    asymmetry: float  #: relative asymmetry of the computed matrix before it was symmetrised
    #: estimated relative error that refinement left: the square of that of the displacements
    residual: float
    backend: str
    #: elastic displacements under unit loads on the ports, by planar blocks
    fields: Mapping[int, np.ndarray] = field(default_factory=dict)


def flexibility(body: Body, tolerance: float = 1e-12) -> Flexibility:
    """Return the flexibility of the free body at all ports (inertia relief), kept with the body; by
    :func:`solidgear.core.solve.inertia_relief.elastic_fields` to a relative error of the energy of
    `tolerance`. SolidgearError if the solution is not finite.
    """
    return body.cache.get(Flexibility, lambda: _flexibility(body, tolerance))


def twin_matrix(body: Body, block: Block, matrix: np.ndarray) -> np.ndarray:
    """Return the part of a (..., 6 p, 6 p) matrix of all ports that belongs to a block with a
    mirror: that of the original block, in the other plane.
    """
    assert block.mirror is not None
    original, signs = block.mirror
    rows, turn = body.rows(body.blocks[original]), np.tile(signs, len(body.ports))
    return matrix[..., rows[:, None], rows] * np.outer(turn, turn)


def port_fields(
    body: Body, tolerance: float
) -> Iterator[tuple[int, np.ndarray, np.ndarray, float]]:
    """Yield elastic displacements of the free body under unit loads on the ports, block by block:
    of those that repeat no other, the index, the displacements, the work that loads do on them, as
    computed, and the relative error of it.
    """
    for index, (block, factor) in enumerate(zip(body.blocks, factors(body))):
        if not block.components or block.mirror is not None:
            continue
        k = block.stiffness
        load, u, missing = relieved_fields(block, factor.solve, block.ports.T.toarray(), tolerance)
        # Clapeyron: 2 u'f - u'Ku is stationary at the solution; each pair of loads misses the
        # product of the errors of both displacements.
        work = u.T @ load
        yield index, u, work + work.T - u.T @ (k @ u), missing


def _flexibility(body: Body, tolerance: float) -> Flexibility:
    n = 6 * len(body.ports)
    out = np.zeros((n, n))
    asymmetry = residual = 0.0
    fields: dict[int, np.ndarray] = {}
    for index, u, f_block, missing in port_fields(body, tolerance):
        block = body.blocks[index]
        size = np.sqrt(np.abs(np.diag(f_block)))
        size[size == 0] = np.inf  # a motion without any flexibility is not asymmetric
        asymmetry = max(
            asymmetry, float((np.abs(f_block - f_block.T) / np.outer(size, size)).max())
        )
        residual = max(residual, float(missing))
        rows = body.rows(block)
        out[np.ix_(rows, rows)] = (f_block + f_block.T) / 2
        if block.planar:
            fields[index] = u
    backends = [f.label for b, f in zip(body.blocks, factors(body)) if b.components]
    for block in body.blocks:
        if block.mirror is not None:
            rows = body.rows(block)
            out[np.ix_(rows, rows)] = twin_matrix(body, block, out)
    if not np.all(np.isfinite(out)):
        raise SolidgearError(f"the static solution of the {body.fidelity} body is not finite")
    return Flexibility(out, asymmetry, residual, "+".join(sorted(set(backends))), fields)


@overload
def condense(
    body: Body, supports: Holding, port: str, attachment: str | None = None
) -> Condensed: ...


@overload
def condense(
    body: Body,
    supports: Holding,
    port: tuple[str, ...] | list[str],
    attachment: str | Sequence[str | None] | None = None,
) -> Coupled: ...


@pinned
def condense(
    body: Body,
    supports: Holding,
    port: str | tuple[str, ...] | list[str],
    attachment: str | Sequence[str | None] | None = None,
) -> Condensed | Coupled:
    """Stiffness and compliance of the supported shaft at one port, or between several.

    Parameters
    ----------
    body : Body
    supports : Scene, Supports or iterable of bearings
        A scene brings its housing along.
    port : str or tuple of str
        Name of the port to condense to; of several names, the ports together with all terms
        between them.
    attachment : str or sequence of str, optional
        Which attachment of that port, where the body carries several.

    Returns
    -------
    Condensed, or Coupled of several ports

    Raises
    ------
    SolidgearError
        If the body lacks the port, or the bearing stiffnesses leave no positive definite system.

    Examples
    --------
    A shaft on two bearings that stop all but its rotation:

    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> at_gear = sg.condense(sg.build(scene, "timoshenko"), scene, port="port")
    >>> at_gear.free_names
    ('thy',)
    >>> bool(at_gear.stiffness[2, 2] < 4e8 + 5e8)  # softer than the bearings side by side
    True
    """
    names = (port,) if isinstance(port, str) else tuple(port)
    if not names or len(set(names)) < len(names):
        raise SolidgearError(f"condense: port = {show(names)}; name each port once, at least one")
    if attachment is None or isinstance(attachment, str):
        attachment = [attachment] * len(names)
    if len(attachment) != len(names):
        raise SolidgearError(
            f"condense: attachment = {show([*attachment])}: give one, or one for each of {show(names)}"
        )
    supports = as_supports(supports)
    flex = flexibility(body)
    indices = [body.port_index(name, kind) for name, kind in zip(names, attachment)]
    rows = np.concatenate([6 * index + np.arange(6) for index in indices])
    bearing_rows = supports.rows(body)
    p_l = body.rigid_ports[rows]
    free = supports.unresisted(body)
    k = np.zeros((len(rows), len(rows)))
    c = np.full_like(k, np.nan)
    evidence = {"asymmetry": flex.asymmetry, "residual": flex.residual, "backend": flex.backend}
    if free.shape[1] < 6 or len(names) > 1:  # a wholly free body is stiff between its ports
        full = _full_compliance(body, supports, flex, rows, bearing_rows, free)
        loads = _allowed_loads(p_l @ free, body.length)
        small = loads.T @ full @ loads
        small = (small + small.T) / 2
        inversion_error = 0.0 if len(names) == 1 else _inversion_error(small, flex.residual)
        k = np.full_like(k, np.nan)
        if inversion_error < APART:
            k = loads @ _spd_solve(small, loads.T)
            k = _without_rounding((k + k.T) / 2)
        fixed = _still(p_l @ free, body.length)
        if len(names) > 1:
            evidence["stiffness_error"] = inversion_error
        c[np.ix_(fixed, fixed)] = _without_rounding(((full + full.T) / 2)[np.ix_(fixed, fixed)])
    tied = tuple(body.ports[index].attachment for index in indices)
    if isinstance(port, str):
        return Condensed(port, tied[0], k, c, p_l @ free, evidence)
    return Coupled(names, tied, k, c, p_l @ free, evidence)


def _full_compliance(body, supports, flex, rows, bearing_rows, free) -> np.ndarray:
    """Compute motions of ports under loads on them; loads that do work on free motions must be left
    out by the caller.
    """
    f_ll = flex.matrix[np.ix_(rows, rows)]
    p_l, root = body.rigid_ports[rows], supports.root
    if not root.shape[1]:
        return f_ll
    f_lb = flex.matrix[np.ix_(rows, bearing_rows)]
    f_bb = flex.matrix[np.ix_(bearing_rows, bearing_rows)]
    p_b = body.rigid_ports[bearing_rows]
    # S = N'N and H = (N P_b)'(N P_b); with the stiffest springs first both N and its QR factor
    # keep the digits of the softest.
    inner = np.eye(root.shape[1]) + root.T @ f_bb @ root
    n = _half_solve(inner, root.T)
    resisted = _complement(free, body.length)
    reach = n @ f_lb.T
    rigid = n @ p_b @ resisted
    x = (p_l @ resisted - reach.T @ rigid).T
    swing = _half_inverse(rigid, x)
    return f_ll - reach.T @ reach + swing.T @ swing


def _without_rounding(matrix: np.ndarray) -> np.ndarray:
    """Return a matrix without couplings that are rounding: less than a last digit of both diagonal
    entries.
    """
    size = np.sqrt(np.abs(np.diag(matrix)))
    return np.where(np.abs(matrix) <= LAST_DIGIT * np.outer(size, size), 0.0, matrix)


def _inversion_error(small: np.ndarray, residual: float) -> float:
    """Return the relative error of the inverse of a compliance; of two points that move as one the
    inverse is only error.
    """
    size = np.sqrt(np.maximum(np.diag(small), 0.0))  # of a motion without any, rounding
    if not len(size) or not np.all(size > 0):
        return np.inf if len(size) else 0.0
    least = np.linalg.eigvalsh(small / np.outer(size, size))[0]
    return float(max(residual, ROUNDING) / max(least, ROUNDING))


def _half_solve(a, b):
    """Return ``C^-1 b`` with ``C C' = a`` positive definite, ``C`` lower triangular."""
    d = 1 / np.sqrt(np.diag(a))
    try:
        c = np.linalg.cholesky(a * np.outer(d, d))
    except np.linalg.LinAlgError as error:
        raise SolidgearError(
            "the condensed system is not positive definite; check the bearing stiffnesses"
        ) from error
    return sla.solve_triangular(c, d[:, None] * b, lower=True)


def _half_inverse(n, b):
    """Return ``R^-T b`` with ``R`` the triangular factor of ``n``: the Gram matrix of it is ``b'
    (n'n)^-1 b``, without forming ``n'n``.

    The rows of ``n`` must fall in size: Householder's reflections then lose nothing of the small
    ones (Cox and Higham 1998).
    """
    size = np.linalg.norm(n, axis=0)
    size = np.where(size > 0, size, 1.0)
    order = np.argsort(-np.abs(n).max(axis=1, initial=0.0), kind="stable")
    r, pivot = sla.qr((n / size)[order], mode="r", pivoting=True)
    r = r[: n.shape[1]]
    if len(r) < n.shape[1] or np.any(np.diag(r) == 0):
        raise SolidgearError(
            "the condensed system is not positive definite; check the bearing stiffnesses"
        )
    return sla.solve_triangular(r, (b / size[:, None])[pivot], trans="T")


def _spd_solve(a, b):
    """Solve with a positive definite matrix, scaled to a diagonal of ones."""
    d = 1 / np.sqrt(np.diag(a))
    try:
        factor = sla.cho_factor(a * np.outer(d, d))
        return d[:, None] * sla.cho_solve(factor, d[:, None] * b)
    except np.linalg.LinAlgError as error:
        raise SolidgearError(
            "the condensed system is not positive definite; check the bearing stiffnesses"
        ) from error


def _complement(null: np.ndarray, length: float) -> np.ndarray:
    """Return a basis of the rigid motions that springs resist (any complement will do)."""
    return _sizes(null, length) * _scaled_complement(null, length)


def _allowed_loads(null: np.ndarray, length: float) -> np.ndarray:
    """Return a basis of the loads that do no work on free motions of ports."""
    return _scaled_complement(null, length) / _sizes(null, length)


def _scaled_complement(null: np.ndarray, length: float) -> np.ndarray:
    """Return the orthonormal complement of motions, made comparable; coordinate axes where
    possible.
    """
    q, _ = np.linalg.qr(null / _sizes(null, length), mode="complete")
    return separated(q[:, null.shape[1] :])


def _still(null: np.ndarray, length: float) -> np.ndarray:
    """Return the mask of the components of ports that no free motion moves."""
    q, _ = np.linalg.qr(null / _sizes(null, length))
    return np.abs(q).max(axis=1, initial=0.0) < 1e-9


def _sizes(motions: np.ndarray, length: float) -> np.ndarray:
    """Return the column that makes components comparable: one, and one over the length for
    rotations.
    """
    return np.tile([1.0, 1.0, 1.0, 1 / length, 1 / length, 1 / length], len(motions) // 6)[:, None]
