"""One interface over several factorisations: the same answers from each, and a sentence where there
is none.
"""

from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse as sp

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.machine.memory import NoRoom
from solidgear.core.solve import choice as choosing
from solidgear.core.solve import factor
from solidgear.core.solve.backends import missing
from solidgear.core.solve.choice import SMALL
from solidgear.core.solve.factor import FactorError, factorise

GEOMETRY = Path(__file__).parent.parent / "geometry"


def needs(name):
    return pytest.mark.skipif(bool(missing(name)), reason=missing(name) or "-")


BACKENDS = [
    pytest.param(name, marks=needs(name)) for name in ("superlu", "pardiso", "cholmod", "mumps")
]


@pytest.fixture(autouse=True)
def no_forced_backend(monkeypatch):
    monkeypatch.delenv("SOLIDGEAR_BACKEND", raising=False)


def shifted(body):
    """What the eigensolver factors: positive definite."""
    block = body.blocks[0]
    return (block.stiffness + body.scale * block.mass).tocsr(), block.border


@pytest.fixture(scope="module")
def plane(overhung):
    return shifted(sg.build(overhung, "harmonic", order=2, layers=1))[0]


@pytest.fixture(scope="module")
def bordered(overhung):
    """Rigid seats: each adds six unknowns that touch every node of its seat."""
    matrix, border = shifted(
        sg.build(overhung.with_attachment("rigid"), "solid", refinement=0.2, half=False)
    )
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


def test_large_matrices_take_the_fastest_there_and_say_what_is_missing(monkeypatch):
    absent = {"pardiso": "pypardiso is not usable (ImportError)", "cholmod": "", "mumps": ""}
    monkeypatch.setattr(choosing, "missing", lambda name: absent.get(name, ""))
    matrix = sp.identity(SMALL + 1, format="csr")
    assert choosing.choice(*matrix.shape, None, False)[0] == "cholmod"
    absent["cholmod"] = "scikit-sparse is not usable (ImportError)"
    assert choosing.choice(*matrix.shape, None, False)[0] == "mumps"
    absent["mumps"] = "python-mumps is not usable (ImportError)"
    found = factorise(matrix)
    assert found.backend == "superlu" and str(SMALL) in found.reason
    for extra in ("fast", "cholmod", "mumps"):
        assert f"pip install 'solidgear[{extra}]'" in found.reason
    with pytest.raises(FactorError, match=r"pardiso was asked for but pypardiso is not usable"):
        factorise(sp.identity(3, format="csr"), "pardiso")
    absent.clear()
    assert choosing.choice(*matrix.shape, None, False) == (
        "pardiso",
        f"{SMALL + 1} unknowns are above {SMALL}",
    )
    # planar matrices too large for SuperLU's indices are treated like solids
    monkeypatch.setattr(choosing, "LARGE_PLANAR", SMALL)
    assert choosing.choice(*matrix.shape, None, True)[0] == "pardiso"


def test_environment_forces_a_backend(monkeypatch, plane):
    monkeypatch.setenv("SOLIDGEAR_BACKEND", "superlu")
    assert factorise(sp.identity(SMALL + 1, format="csr")).backend == "superlu"
    monkeypatch.setenv("SOLIDGEAR_BACKEND", "")
    assert factorise(plane).backend == "superlu"  # empty is the same as unset
    monkeypatch.setenv("SOLIDGEAR_BACKEND", "umfpack")
    with pytest.raises(
        FactorError,
        match="unknown back end 'umfpack'; use 'pardiso', 'cholmod', 'mumps', 'superlu'",
    ):
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


@pytest.mark.parametrize(
    "matrix", [chain(), with_a_loose_unknown()], ids=["floating chain", "loose unknown"]
)
@pytest.mark.parametrize("backend", BACKENDS)
def test_singular_matrix_is_refused_in_a_sentence(matrix, backend):
    with pytest.raises(FactorError) as caught:
        factorise(matrix, backend)
    text = str(caught.value)
    assert isinstance(caught.value, SolidgearError) and (
        "could not factor" in text or "failed on the system matrix" in text
    )
    assert "\n" not in text and text[0].isupper()


@pytest.mark.parametrize("backend", BACKENDS)
def test_indefinite_border_is_refused(backend):
    matrix = sp.diags(np.r_[np.ones(9), -1.0]).tocsr()
    with pytest.raises(FactorError, match="not positive definite"):
        factorise(matrix, backend, border=2)


@pytest.mark.parametrize("backend", BACKENDS)
def test_indefinite_matrix_is_refused(backend):
    # every diagonal entry positive, one eigenvalue negative: 1 + 2 cos(pi k / 21)
    matrix = sp.diags(
        [np.ones(20), np.ones(19), np.ones(19)], [0, 1, -1]
    ).tocsr() + 0.5 * sp.identity(20)
    assert matrix.diagonal().min() > 0 and np.linalg.eigvalsh(matrix.toarray())[0] < -0.4
    with pytest.raises(FactorError, match="not positive definite") as caught:
        factorise(matrix, backend)
    if backend == "superlu":  # which beams come to
        assert "very short or thin against their diameter" in str(caught.value)


# --------------------------------------------------------------------------- memory
@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("backend", BACKENDS)
def test_what_will_not_fit_is_refused_before_it_is_factored(plane, backend, planar, monkeypatch):
    monkeypatch.setattr(
        factor.BACKENDS[backend], "factor", lambda self: pytest.fail("the numbers were begun")
    )
    monkeypatch.setattr("solidgear.core.machine.memory.SMALL_MB", 0.0)
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "0.5")
    with pytest.raises(
        NoRoom,
        match=rf"^{plane.shape[0]} unknowns need about [\d.]+ MB to factor by {backend}, 0.5 MB are free; use a coarser",
    ):
        factorise(plane, backend, planar=planar)


@pytest.mark.parametrize("backend", BACKENDS)
def test_estimate_is_of_the_size_of_the_factor(plane, backend):
    found = factorise(plane, backend, planar=True)
    # A factor holds at least the upper triangle of the matrix (8 bytes an entry), and on a planar
    # mesh nothing near a hundred times it.
    least = 8 * plane.nnz / 2 / 2**20
    assert least < found.estimate_mb < 100 * least
    if found.nnz is not None:
        assert found.nnz > plane.nnz / 2


def test_a_matrix_that_is_all_border():
    """A shaft that its rigid seats hold from end to end."""
    matrix = sp.csr_matrix([[2.0, 1.0], [1.0, 3.0]])
    rhs = np.array([1.0, 2.0])
    made = factorise(matrix, planar=True, border=2)
    assert matrix @ made.solve(rhs) == pytest.approx(rhs)
    found = factor.indefinite(sp.csr_matrix([[2.0, 3.0], [3.0, 1.0]]), planar=True, border=2)
    assert found is not None and found.negative == 1


@needs("pardiso")
def test_threes_of_unknowns_that_are_not_nodes_are_not_ordered_as_such():
    """Nodes on the plane of a half have fewer unknowns: an order of threes filled the factor with
    2.4 times the entries on one half in three.
    """
    from solidgear.core.solve.backends.pardiso import Pardiso, _node_order

    whole = shifted(sg.build(sg.load(GEOMETRY / "cylinder_free.toml"), "solid", refinement=0.9))[0]
    assert _node_order(whole) is not None
    # one unknown less at every thirtieth node: threes are nodes no more, for the most part
    n = whole.shape[0]
    left = np.delete(np.arange(n), np.arange(0, n, 90)[: n // 90 // 3 * 3])
    part = whole[left][:, left].tocsr()
    assert part.shape[0] % 3 == 0
    assert _node_order(part) is None
    back = Pardiso(part)
    assert back.order is None
