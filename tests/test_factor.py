"""One interface over several factorisations: the same answers from each, and a sentence where there is none."""

from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse as sp

import solidgear as sg
from solidgear.errors import SolidgearError
from solidgear.solve import factor
from solidgear.solve.factor import SMALL, FactorError, factorise, pardiso_missing

GEOMETRY = Path(__file__).parent.parent / "geometry"
needs_pardiso = pytest.mark.skipif(bool(pardiso_missing()), reason=pardiso_missing() or "-")
BACKENDS = ["superlu", pytest.param("pardiso", marks=needs_pardiso)]


@pytest.fixture(autouse=True)
def no_forced_backend(monkeypatch):
    monkeypatch.delenv("SOLIDGEAR_BACKEND", raising=False)


def shifted(body):
    """What the eigensolver factors: positive definite."""
    block = body.blocks[0]
    return (block.stiffness + body.scale * block.mass).tocsr(), block.border


@pytest.fixture(scope="module")
def overhung():
    return sg.load(GEOMETRY / "pinion_overhung.toml")


@pytest.fixture(scope="module")
def plane(overhung):
    return shifted(sg.build(overhung, "harmonic", order=2, layers=1))[0]


@pytest.fixture(scope="module")
def bordered(overhung):
    """Rigid seats: each adds six unknowns that touch every node of its seat."""
    matrix, border = shifted(sg.build(overhung.with_attachment("rigid"), "solid", refinement=0.35))
    assert border == 18
    return matrix, border


def load(n, k=3):
    return np.random.default_rng(1).standard_normal((n, k))


def off(x, y):
    return np.linalg.norm(x - y) / np.linalg.norm(y)


# --------------------------------------------------------------------------- answers
@pytest.mark.parametrize("backend", BACKENDS)
def test_backend_agrees_with_dense_cholesky(plane, backend):
    rhs = load(plane.shape[0])
    found = factorise(plane, backend)
    assert found.backend == backend and found.reason == "asked for"
    # condition numbers here are below 1e6: 1e-9 leaves a wide margin over rounding (measured 1e-13)
    assert off(found.solve(rhs), sla.solve(plane.toarray(), rhs, assume_a="pos")) < 1e-9


@needs_pardiso
def test_backends_agree_on_a_solid(bordered):
    matrix, _ = bordered
    rhs = load(matrix.shape[0])
    # two factorisations of one matrix; measured 1e-13
    assert off(factorise(matrix, "pardiso").solve(rhs), factorise(matrix, "superlu").solve(rhs)) < 1e-9


@pytest.mark.parametrize("backend", BACKENDS)
def test_border_changes_nothing_but_the_work(bordered, backend):
    matrix, border = bordered
    rhs = load(matrix.shape[0])
    plain = factorise(matrix, backend).solve(rhs)
    found = factorise(matrix, backend, border=border)
    assert found.backend == backend
    # exact elimination in another order: rounding, measured 1e-13
    assert off(found.solve(rhs), plain) < 1e-9
    # any number of unknowns may be called the border
    assert off(factorise(matrix, backend, border=1).solve(rhs), plain) < 1e-9
    # the residual itself, relative to the load, so that both being wrong alike is excluded
    assert off(matrix @ plain, rhs) < 1e-9


@pytest.mark.parametrize("border", [0, 4])
@pytest.mark.parametrize("backend", BACKENDS)
def test_one_load_or_many(plane, backend, border):
    solve = factorise(plane, backend, border=border).solve
    rhs = load(plane.shape[0], 2)
    both = solve(rhs)
    assert both.shape == rhs.shape
    one = solve(rhs[:, 0])
    assert one.shape == (len(rhs),)
    # blocked and single substitution differ in rounding only
    assert off(one, both[:, 0]) < 1e-12
    # a factor outlives its first use and does not write on its loads
    assert np.array_equal(rhs, load(plane.shape[0], 2)) and off(solve(rhs), both) < 1e-15 + 1e-12


# --------------------------------------------------------------------------- choice
def test_small_and_planar_matrices_take_superlu():
    small = factorise(sp.identity(10, format="csr"))
    assert small.backend == "superlu" and str(SMALL) in small.reason
    planar = factorise(sp.identity(SMALL + 1, format="csr"), planar=True)
    assert planar.backend == "superlu" and "planar" in planar.reason


@needs_pardiso
def test_large_matrices_take_pardiso():
    found = factorise(sp.identity(SMALL + 1, format="csr"))
    assert found.backend == "pardiso" and str(SMALL) in found.reason


def test_without_pardiso_large_matrices_take_superlu_and_say_so(monkeypatch):
    monkeypatch.setattr(factor, "pardiso_missing", lambda: "pypardiso is not usable (ImportError)")
    found = factorise(sp.identity(SMALL + 1, format="csr"))
    assert found.backend == "superlu" and "'fast'" in found.reason and "ImportError" in found.reason
    with pytest.raises(FactorError, match=r"pardiso was asked for but pypardiso is not usable"):
        factorise(sp.identity(3, format="csr"), "pardiso")


def test_environment_forces_a_backend(monkeypatch, plane):
    monkeypatch.setenv("SOLIDGEAR_BACKEND", "superlu")
    assert factorise(sp.identity(SMALL + 1, format="csr")).backend == "superlu"
    monkeypatch.setenv("SOLIDGEAR_BACKEND", "")
    assert factorise(plane).backend == "superlu"  # empty is the same as unset
    monkeypatch.setenv("SOLIDGEAR_BACKEND", "cholmod")
    with pytest.raises(FactorError, match="unknown back end 'cholmod'; use 'pardiso' or 'superlu'"):
        factorise(plane)
    # what the caller asks for comes first
    assert factorise(plane, "superlu").backend == "superlu"


# --------------------------------------------------------------------------- refusals
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("border", [0, 1])
def test_entries_that_are_no_numbers_are_refused(bad, border):
    matrix = sp.identity(5, format="csr")
    matrix.data[2] = bad
    with pytest.raises(FactorError, match="NaN or infinite"):
        factorise(matrix, border=border)


def test_unknown_backend_is_refused():
    with pytest.raises(FactorError, match="unknown back end 'umfpack'"):
        factorise(sp.identity(3, format="csr"), "umfpack")


def chain():
    """Three masses on two springs, floating: singular in exact arithmetic and in floating point."""
    return sp.csr_matrix(np.array([[1.0, -1, 0], [-1, 2, -1], [0, -1, 1]]))


def with_a_loose_unknown():
    d = np.ones(20)
    d[7] = 0.0
    return sp.diags(d).tocsr()


@pytest.mark.parametrize("matrix", [chain(), with_a_loose_unknown()], ids=["floating chain", "loose unknown"])
@pytest.mark.parametrize("backend", BACKENDS)
def test_singular_matrix_is_refused_in_a_sentence(matrix, backend):
    with pytest.raises(FactorError) as caught:
        factorise(matrix, backend)
    text = str(caught.value)
    assert isinstance(caught.value, SolidgearError) and "could not factor" in text or "failed on the system matrix" in text
    assert "\n" not in text and text[0].isupper()


@pytest.mark.parametrize("backend", BACKENDS)
def test_indefinite_border_is_refused(backend):
    matrix = sp.diags(np.r_[np.ones(9), -1.0]).tocsr()
    with pytest.raises(FactorError, match="not positive definite"):
        factorise(matrix, backend, border=2)
