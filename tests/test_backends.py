"""Real bodies on every back end that is there: the same physics, and the same count of negative
eigenvalues.
"""

from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse as sp

import solidgear as sg
from solidgear.core.solve import factor
from solidgear.core.solve.backends import missing
from solidgear.core.solve.factor import factorise, indefinite
from solidgear.core.solve.statics import flexibility

SCENE = sg.load(Path(__file__).parent.parent / "geometry" / "pinion_overhung.toml")
NAMES = ("superlu", "pardiso", "cholmod", "mumps")


def needs(name):
    return pytest.mark.skipif(bool(missing(name)), reason=missing(name) or "-")


OTHERS = [pytest.param(name, marks=needs(name)) for name in NAMES[1:]]
COUNTING = [pytest.param(name, marks=needs(name)) for name in ("superlu", "pardiso", "mumps")]
BODIES = {"harmonic": dict(order=2, layers=1), "solid": dict(refinement=0.3)}


def solved(fidelity, backend, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_BACKEND", backend)
    body = sg.build(SCENE, fidelity, **BODIES[fidelity])
    found = flexibility(body)
    assert found.backend == backend
    return found.matrix, sg.modes(body, SCENE, n=6).frequency_hz


@pytest.fixture(scope="module")
def reference():
    with pytest.MonkeyPatch.context() as patch:
        return {fidelity: solved(fidelity, "superlu", patch) for fidelity in BODIES}


@pytest.mark.parametrize("backend", OTHERS)
@pytest.mark.parametrize("fidelity", list(BODIES))
def test_flexibility_and_frequencies_do_not_depend_on_the_back_end(
    reference, fidelity, backend, monkeypatch
):
    matrix, frequency = solved(fidelity, backend, monkeypatch)
    expected, expected_hz = reference[fidelity]
    # the flexibility is refined on K itself, a frequency is accurate to the square of its vector:
    # both are below 1e-9 though the factors round apart
    size = np.sqrt(np.diag(expected))
    assert (np.abs(matrix - expected) / np.outer(size, size)).max() < 1e-9
    np.testing.assert_allclose(frequency, expected_hz, rtol=1e-9)


# --------------------------------------------------------------------------- inertia
@pytest.fixture(scope="module")
def pencil():
    block = sg.build(SCENE, "harmonic", order=2, layers=0).blocks[0]
    k, m = block.stiffness.tocsr(), block.mass.tocsr()
    return k, m, sla.eigh(k.toarray(), m.toarray(), eigvals_only=True)


def check(matrix, found, expected, backend):
    assert found is not None and found.negative == expected and found.backend == backend
    rhs = np.random.default_rng(3).standard_normal((matrix.shape[0], 2))
    x = found.solve(rhs)
    # a sound factorisation leaves a backward error of rounding size
    assert np.linalg.norm(matrix @ x - rhs) < 1e-10 * (
        sp.linalg.norm(matrix) * np.linalg.norm(x) + np.linalg.norm(rhs)
    )


@pytest.mark.parametrize("backend", COUNTING)
@pytest.mark.parametrize("after", [3, 6, 20])
def test_count_between_eigenvalues_of_a_body(pencil, backend, after):
    k, m, values = pencil
    matrix = (k - np.sqrt(values[after - 1] * values[after]) * m).tocsr()
    check(matrix, indefinite(matrix, backend), after, backend)
    # a border is eliminated by hand; inertia adds up
    check(matrix, indefinite(matrix, backend, border=7), after, backend)


@pytest.mark.parametrize("backend", COUNTING)
@pytest.mark.parametrize("seed", range(3))
def test_count_of_a_random_matrix(backend, seed):
    rng = np.random.default_rng(seed)
    a = sp.random(200, 200, 0.03, random_state=rng)
    matrix = (a + a.T + sp.diags(rng.standard_normal(200))).tocsr()
    expected = int((np.linalg.eigvalsh(matrix.toarray()) < 0).sum())
    found = indefinite(matrix, backend)
    # Static or no pivots may leave a factor that is not sound: a back end may decline, it must not
    # be wrong, and one of them must count.
    if found is not None:
        check(matrix, found, expected, backend)
    assert indefinite(matrix).negative == expected


def test_zero_diagonal_needs_pivots_or_is_declined():
    pair = sp.csr_matrix(np.array([[0.0, 1], [1, 0]]))
    matrix = sp.block_diag([pair] * 5, format="csr")
    for backend in ("superlu", "pardiso", "mumps"):
        found = None if missing(backend) else indefinite(matrix, backend)
        assert found is None or found.negative == 5


@pytest.mark.parametrize("backend", COUNTING)
def test_singular_matrix_has_no_count(backend):
    matrix = sp.csr_matrix(np.array([[1.0, -1, 0], [-1, 2, -1], [0, -1, 1]]))
    assert indefinite(matrix, backend) is None


def test_unsound_factor_is_passed_over(monkeypatch):
    """A factor that solves another matrix must not lend its count."""
    matrix = sp.diags(np.r_[-1.0, np.ones(9)]).tocsr()
    monkeypatch.setattr(factor.BACKENDS["superlu"], "negative", 0)
    original = factor.BACKENDS["superlu"].factor

    def wrong(self):
        original(self)
        solve = self.solve
        self.solve = lambda rhs: solve(rhs) * (1 + 1e-6)

    monkeypatch.setattr(factor.BACKENDS["superlu"], "factor", wrong)
    assert indefinite(matrix, "superlu") is None
    found = indefinite(matrix)
    assert (
        found is None
        if missing("pardiso") and missing("mumps")
        else found.negative == 1 and "no sound factor by superlu" in found.reason
    )


@pytest.mark.skipif(bool(missing("cholmod")), reason="no CHOLMOD")
def test_cholmod_hands_the_count_on(monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_BACKEND", "cholmod")
    found = indefinite(sp.diags([-1.0, 2.0, 3.0]).tocsr())
    assert found.negative == 1 and found.backend != "cholmod"


@pytest.mark.parametrize("backend", [pytest.param(name, marks=needs(name)) for name in NAMES])
def test_order_of_entries_does_not_matter_and_is_left_alone(backend):
    given = sp.csr_matrix(
        (np.array([2.0, 4.0, 5.0, 1.0, 1.0]), np.array([1, 0, 1, 0, 0]), np.array([0, 2, 5])),
        shape=(2, 2),
    )
    before = given.indices.copy()
    x = factorise(given, backend).solve(np.array([6.0, 7.0]))
    np.testing.assert_allclose(
        x, [1, 1], rtol=1e-14
    )  # [[4, 2], [2, 5]], two entries given in parts
    assert np.array_equal(given.indices, before)
