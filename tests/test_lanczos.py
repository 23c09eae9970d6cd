"""Block Lanczos against dense eigenvalues: clusters, exhausted starts, tiny problems, honest
failure.
"""

import numpy as np
import pytest

from solidgear.core.solve import lanczos
from solidgear.core.solve.lanczos import block_lanczos


def problem(theta, seed=0):
    """Operator ``A^-1 M`` with given eigenvalues and a mass that is not the identity: (operator,
    mass, M, eigenvectors).
    """
    n = len(theta)
    rng = np.random.default_rng(seed)
    q, _ = np.linalg.qr(rng.standard_normal((n, n)))
    root = np.eye(n) + 0.3 * np.diag(rng.standard_normal(n - 1), 1)
    m = root.T @ root
    u = np.linalg.solve(root, q)  # u' M u = 1
    inverse = (u * theta) @ u.T
    return (lambda f: inverse @ f), (lambda x: m @ x), m, u


def start(n, p, seed=3):
    return np.random.default_rng(seed).standard_normal((n, p))


SPECTRUM = np.concatenate([[9.0, 9.0, 4.0, 4.0, 4.0, 1.0, 0.5, 0.5], np.linspace(0.3, 0.001, 112)])


def test_eigenvalues_of_a_spectrum_with_twins_and_triplets():
    """Eigenvalue errors are the square of the residual bound over the gap: rounding at 1e-9."""
    operator, mass, m, _ = problem(SPECTRUM)
    found = block_lanczos(operator, mass, start(120, 4), 9)
    assert found.converged
    np.testing.assert_allclose(found.theta, np.sort(SPECTRUM)[::-1][:9], rtol=1e-12)
    np.testing.assert_allclose(found.vectors.T @ m @ found.vectors, np.eye(9), atol=1e-12)


def test_one_vector_at_a_time_finds_single_eigenvalues():
    theta = np.concatenate([[9.0, 4.0, 1.0, 0.5], np.linspace(0.3, 0.001, 116)])
    operator, mass, m, _ = problem(theta)
    single = block_lanczos(operator, mass, start(120, 1), 4)
    assert single.converged
    np.testing.assert_allclose(single.theta, theta[:4], rtol=1e-12)
    np.testing.assert_allclose(single.vectors.T @ m @ single.vectors, np.eye(4), atol=1e-12)
    # blocks take more solves, in fewer calls
    assert single.columns < block_lanczos(operator, mass, start(120, 4), 4).columns


def test_residual_meets_the_tolerance_asked_for():
    operator, mass, m, _ = problem(SPECTRUM)
    for tolerance in (1e-3, 1e-6, 1e-9):
        found = block_lanczos(operator, mass, start(120, 4), 6, tolerance=tolerance)
        back = operator(mass(found.vectors)) - found.vectors * found.theta
        residual = np.sqrt(np.einsum("ij,ij->j", back, m @ back)) / found.theta
        assert residual.max() <= 1.01 * tolerance + 1e-14
        assert found.columns < 120


def test_a_start_inside_an_invariant_space_is_left():
    """Ten exact eigenvectors as a start see nothing else; the search goes on with fresh directions
    and finds the largest.
    """
    operator, mass, _, u = problem(SPECTRUM)
    found = block_lanczos(operator, mass, u[:, 5:9].copy(), 7)
    assert found.converged
    np.testing.assert_allclose(found.theta, SPECTRUM[:7], rtol=1e-10)


def test_dependent_columns_in_the_start_do_no_harm():
    operator, mass, _, _ = problem(SPECTRUM)
    x = start(120, 3)
    found = block_lanczos(operator, mass, np.hstack([x, 1e-9 * x[:, :1], x[:, 1:2] + 1e-14]), 5)
    np.testing.assert_allclose(found.theta, SPECTRUM[:5], rtol=1e-12)


@pytest.mark.parametrize("n", [3, 5, 8])
def test_everything_of_a_tiny_problem(n):
    theta = np.linspace(2.0, 1.0, n)
    operator, mass, _, _ = problem(theta)
    found = block_lanczos(operator, mass, start(n, 2), n)
    np.testing.assert_allclose(found.theta, theta, rtol=1e-11)


def test_says_when_it_did_not_converge(monkeypatch):
    monkeypatch.setattr(lanczos, "PATIENCE", 1)  # one basis, which cannot tell eigenvalues so near
    operator, mass, _, _ = problem(np.linspace(1.0, 0.99, 200))
    assert not block_lanczos(operator, mass, start(200, 4), 6, most=24).converged


def test_clusters_wider_than_the_block():
    """Six equal eigenvalues and a block of two: exact arithmetic would show two of them, the
    restart finds the rest.
    """
    theta = np.concatenate([np.full(6, 5.0), np.linspace(1.0, 0.01, 40)])
    operator, mass, _, _ = problem(theta)
    found = block_lanczos(operator, mass, start(46, 2), 6, tolerance=1e-8)
    # Nothing in a Krylov space can promise this; the inertia count is there for it. What must hold:
    # values are eigenvalues.
    nearest = np.abs(found.theta[:, None] - theta).min(axis=1)
    assert nearest.max() < 1e-7
    wide = block_lanczos(operator, mass, start(46, 8), 6, tolerance=1e-8)
    np.testing.assert_allclose(wide.theta, 5.0, rtol=1e-12)
