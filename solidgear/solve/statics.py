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
from typing import TYPE_CHECKING, overload

import numpy as np
import scipy.linalg as sla

from solidgear.body import Block, Body, as_supports
from solidgear.body.supports import separated
from solidgear.errors import SolidgearError, show
from solidgear.machine.threads import pinned
from solidgear.solve.condensed import Condensed, Coupled
from solidgear.solve.inertia_relief import relieved_fields
from solidgear.solve.shifted import factors

if TYPE_CHECKING:
    from solidgear.body.supports import Holding

# Relative error of a compliance where refinement tells none, and that of a stiffness above which
# two points count as one.
ROUNDING, APART = 1e-14, 1e-4
# Of the geometric mean of two diagonal entries: a coupling that is none.
LAST_DIGIT = 1e-15
# Relative error of the energy of fields that local problems look at.
SOLVED = 1e-26


@dataclass(frozen=True)
class Flexibility:
    """Inertia-relief flexibility of a free body at its ports."""

    matrix: np.ndarray  #: (6 p, 6 p) symmetric positive semidefinite, SI
    asymmetry: float  #: relative asymmetry of the computed matrix before it was symmetrised
    #: estimated relative error that refinement left: the square of what the displacements miss
    residual: float
    backend: str
    #: elastic displacements under unit loads on the ports, by planar blocks
    fields: Mapping[int, np.ndarray] = field(default_factory=dict)


def flexibility(body: Body, tolerance: float = 1e-12) -> Flexibility:
    """Flexibility of the free body at all its ports (inertia relief), kept with the body; by
    :func:`solidgear.solve.inertia_relief.elastic_fields`.

    Parameters
    ----------
    tolerance : float
        Relative error of the energy at which refinement stops.

    Raises
    ------
    SolidgearError
        If the static solution is not finite.
    """
    return body.cache.get(Flexibility, lambda: _flexibility(body, tolerance))


def of_twin(body: Body, block: Block, matrix: np.ndarray) -> np.ndarray:
    """Part of a (..., 6 p, 6 p) matrix of all ports that a block with a mirror has: that of its
    original, in the other plane.
    """
    assert block.mirror is not None
    original, signs = block.mirror
    own, turn = body.rows(body.blocks[original]), np.tile(signs, len(body.ports))
    return matrix[..., own[:, None], own] * np.outer(turn, turn)


def port_fields(
    body: Body, tolerance: float
) -> Iterator[tuple[int, np.ndarray, np.ndarray, float]]:
    """Elastic displacements of the free body under unit loads on its ports, block by block: of those
    that repeat no other, the index, the displacements, the work that loads do on them, as computed,
    and the relative error of it that is left.
    """
    for index, (block, factor) in enumerate(zip(body.blocks, factors(body))):
        if not block.components or block.mirror is not None:
            continue
        k = block.stiffness
        load, u, missing = relieved_fields(block, factor.solve, block.ports.T.toarray(), tolerance)
        # Clapeyron: 2 u'f - u'Ku is stationary at the solution; each pair of loads misses the
        # product of what both displacements miss.
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
    backends = [f.said for b, f in zip(body.blocks, factors(body)) if b.components]
    for block in body.blocks:
        if block.mirror is not None:
            rows = body.rows(block)
            out[np.ix_(rows, rows)] = of_twin(body, block, out)
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
def condense(body, supports, port, attachment=None):
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
    alike = attachment is None or isinstance(attachment, str)
    kinds = (attachment,) * len(names) if alike else tuple(attachment)
    supports = as_supports(supports)
    flex = flexibility(body)
    indices = [body.port_index(name, kind) for name, kind in zip(names, kinds)]
    here = np.concatenate([6 * index + np.arange(6) for index in indices])
    there = supports.rows(body)
    p_l = body.rigid_ports[here]
    free = supports.unresisted(body)
    k = np.zeros((len(here), len(here)))
    c = np.full_like(k, np.nan)
    evidence = {"asymmetry": flex.asymmetry, "residual": flex.residual, "backend": flex.backend}
    if free.shape[1] < 6 or len(names) > 1:  # what is wholly free is stiff between its ports
        full = _full_compliance(body, supports, flex, here, there, free)
        loads = _allowed_loads(p_l @ free, body.length)
        small = loads.T @ full @ loads
        small = (small + small.T) / 2
        left = 0.0 if len(names) == 1 else _inverted(small, flex.residual)
        k = loads @ _spd_solve(small, loads.T) if left < APART else np.full_like(k, np.nan)
        k = _apart((k + k.T) / 2)
        on = _still(p_l @ free, body.length)
        if len(names) > 1:
            evidence["stiffness_error"] = left
        c[np.ix_(on, on)] = _apart(((full + full.T) / 2)[np.ix_(on, on)])
    tied = tuple(body.ports[index].attachment for index in indices)
    if isinstance(port, str):
        return Condensed(port, tied[0], k, c, p_l @ free, evidence)
    return Coupled(names, tied, k, c, p_l @ free, evidence)


def _full_compliance(body, supports, flex, here, there, free) -> np.ndarray:
    """Motions of ports under loads on them; loads that do work on free motions are meant to be
    left out.
    """
    f_ll = flex.matrix[np.ix_(here, here)]
    p_l, root = body.rigid_ports[here], supports.root
    if not root.shape[1]:
        return f_ll
    f_lb, f_bb = flex.matrix[np.ix_(here, there)], flex.matrix[np.ix_(there, there)]
    p_b = body.rigid_ports[there]
    # S = N'N and H = (N P_b)'(N P_b); with the stiffest springs first both N and its QR factor
    # keep the digits of the softest.
    inner = np.eye(root.shape[1]) + root.T @ f_bb @ root
    n = _half_solve(inner, root.T)
    held = _complement(free, body.length)
    reach = n @ f_lb.T
    rigid = n @ p_b @ held
    x = (p_l @ held - reach.T @ rigid).T
    swing = _half_inverse(rigid, x)
    return f_ll - reach.T @ reach + swing.T @ swing


def _apart(found: np.ndarray) -> np.ndarray:
    """The same without what rounding couples: less than a last digit of both diagonal entries."""
    size = np.sqrt(np.abs(np.diag(found)))
    return np.where(np.abs(found) <= LAST_DIGIT * np.outer(size, size), 0.0, found)


def _inverted(small: np.ndarray, residual: float) -> float:
    """Relative error that the inverse of a compliance has: of two points that move as one it is
    nothing but error.
    """
    size = np.sqrt(np.maximum(np.diag(small), 0.0))  # of a motion without any, rounding
    if not len(size) or not np.all(size > 0):
        return np.inf if len(size) else 0.0
    least = np.linalg.eigvalsh(small / np.outer(size, size))[0]
    return float(max(residual, ROUNDING) / max(least, ROUNDING))


def _half_solve(a, b):
    """``C^-1 b`` with ``C C' = a`` positive definite, ``C`` lower triangular."""
    d = 1 / np.sqrt(np.diag(a))
    try:
        c = np.linalg.cholesky(a * np.outer(d, d))
    except np.linalg.LinAlgError as error:
        raise SolidgearError(
            "the condensed system is not positive definite; check the bearing stiffnesses"
        ) from error
    return sla.solve_triangular(c, d[:, None] * b, lower=True)


def _half_inverse(n, b):
    """``R^-T b`` with ``R`` the triangular factor of ``n``: its Gram matrix is ``b' (n'n)^-1 b``,
    without forming ``n'n``.

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
    """Solve with a positive definite matrix after bringing its diagonal to one."""
    d = 1 / np.sqrt(np.diag(a))
    try:
        factor = sla.cho_factor(a * np.outer(d, d))
        return d[:, None] * sla.cho_solve(factor, d[:, None] * b)
    except np.linalg.LinAlgError as error:
        raise SolidgearError(
            "the condensed system is not positive definite; check the bearing stiffnesses"
        ) from error


def _complement(null: np.ndarray, length: float) -> np.ndarray:
    """Basis of the rigid motions that springs resist (any complement will do)."""
    return _sizes(null, length) * _without(null, length)


def _allowed_loads(null: np.ndarray, length: float) -> np.ndarray:
    """Basis of the loads that do no work on free motions of ports."""
    return _without(null, length) / _sizes(null, length)


def _without(null: np.ndarray, length: float) -> np.ndarray:
    """Orthonormal complement of motions, made comparable; coordinate axes where possible."""
    q, _ = np.linalg.qr(null / _sizes(null, length), mode="complete")
    return separated(q[:, null.shape[1] :])


def _still(null: np.ndarray, length: float) -> np.ndarray:
    """Mask of the components of ports that no free motion moves."""
    q, _ = np.linalg.qr(null / _sizes(null, length))
    return np.abs(q).max(axis=1, initial=0.0) < 1e-9


def _sizes(motions: np.ndarray, length: float) -> np.ndarray:
    """Column of what makes components comparable: one, and one over the length of rotations."""
    return np.tile([1.0, 1.0, 1.0, 1 / length, 1 / length, 1 / length], len(motions) // 6)[:, None]
