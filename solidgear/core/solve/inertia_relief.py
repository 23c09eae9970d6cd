"""Elastic displacements of a free body: loads balanced by inertia forces, displacements without a
rigid part.

One factor of ``A = K + sigma M`` serves. It is not K, so solutions are corrected on K by conjugate
gradients: the preconditioned operator ``A^-1 K`` has the eigenvalues ``lambda / (lambda + sigma)``,
all near one but the few lowest, and a handful of steps settles it whatever sigma is.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.linalg as sla

from solidgear.core.body import Block

Linear = Callable[[np.ndarray], np.ndarray]


def inertia_relief(solve: Linear, mass: Linear, rigid: np.ndarray) -> tuple[Linear, Linear]:
    """Return two functions for a free body, by ``(K + sigma M)^-1 f``, ``M u`` and the rigid
    motions (n, r): the load less the inertia forces of the rigid acceleration it causes; and the
    displacements less their rigid part in the mass norm.
    """
    heavy = mass(rigid)
    gram = sla.cho_factor(rigid.T @ heavy)

    def balanced(load):
        return load - heavy @ sla.cho_solve(gram, rigid.T @ load)

    def relieved(load):
        u = solve(load)
        return u - rigid @ sla.cho_solve(gram, heavy.T @ u)

    return balanced, relieved


def elastic_fields(
    solve: Linear,
    mass: Linear,
    stiffness: Linear,
    rigid: np.ndarray,
    load: np.ndarray,
    tolerance: float,
    most: int = 30,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Solve ``K u = f`` of a free body under (n, k) loads whose resultants are balanced by inertia,
    by the functions ``(K + sigma M)^-1 f``, ``M u`` and ``K u``, until the relative error of the
    energy is below `tolerance`, whose root is that of displacements, or for `most` solves.

    Returns
    -------
    load, u : (n, k) ndarray
        The balanced load and its displacements.
    missing : float
        Estimated relative error of the energy, the largest of all columns.

    Examples
    --------
    Two unit masses on a spring of 100 N/m, pulled apart by 1 N each:

    >>> k, sigma = np.array([[100.0, -100.0], [-100.0, 100.0]]), 6.0
    >>> inverse = np.linalg.inv(k + sigma * np.eye(2))
    >>> _, u, _ = elastic_fields(inverse.__matmul__, lambda u: u, k.__matmul__, np.ones((2, 1)),
    ...                          np.array([[1.0], [-1.0]]), 1e-12)
    >>> np.round(u.ravel(), 9)
    array([ 0.005, -0.005])
    """
    balanced, relieved = inertia_relief(solve, mass, rigid)
    load = balanced(load)
    u = np.zeros_like(load)
    residual, step, last = load, np.zeros_like(load), np.inf
    size = energy = np.zeros(load.shape[1])
    missing = 0.0
    for count in range(most):
        z = relieved(residual)
        fresh = columns(residual, z)
        step = z + step * ratio(fresh, size)
        size = fresh
        pull = stiffness(step)
        along = ratio(size, columns(step, pull))
        u = u + step * along
        residual = residual - pull * along
        gain = along * size
        energy = energy + gain
        share = float(ratio(np.abs(gain), energy).max(initial=0.0))
        # What is still missing shrinks by a constant factor from step to step; rounding shows as
        # gains that do not.
        missing = share if count == 0 else share * share / last
        if missing < tolerance or share > 0.5 * last:
            break
        last = share
    return load, u, min(missing, 1.0)


def relieved_fields(
    block: Block, solve: Linear, load: np.ndarray, tolerance: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return balanced load, displacements and missing energy (:func:`elastic_fields`) of a free
    block, by the solution with a factor of it.
    """
    return elastic_fields(
        solve,
        block.mass.__matmul__,
        block.stiffness.__matmul__,
        block.rigid,
        load,
        tolerance,
    )


def columns(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the products of columns with each other."""
    return np.einsum("ij,ij->j", a, b)


def ratio(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return ``a / b``, and zero where b is zero."""
    return np.divide(a, b, out=np.zeros_like(a), where=b > 0)
