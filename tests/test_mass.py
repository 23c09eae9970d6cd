"""The scalar mass of a solid behaves as the full matrix it stands for."""

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import solidgear as sg
from solidgear.core.body.mass import ScalarMass

GEOMETRY = Path(__file__).parent.parent / "geometry"
N, C = 17, 3


@pytest.fixture
def pair():
    """The mass and the matrix it stands for."""
    rng = np.random.default_rng(1)
    a = sp.random_array((N, N), density=0.2, rng=rng)
    scalar = sp.csr_matrix(a @ a.T + sp.eye_array(N))
    return ScalarMass(scalar, C), sp.kron(scalar, sp.eye(C)).tocsr()


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("columns", [(), (1,), (8,)])
def test_times_arrays(pair, columns, order):
    mass, full = pair
    x = np.asarray(np.random.default_rng(2).standard_normal((N * C, *columns)), order=order)
    # sums of the same products in the same order
    assert np.abs(mass @ x - full @ x).max() < 1e-14
    assert (mass @ x).shape == x.shape
    assert np.abs(x.T @ mass - x.T @ full).max() < 1e-14
    assert np.abs(mass.__matmul__(x) - full @ x).max() < 1e-14


def test_times_and_plus_sparse(pair):
    mass, full = pair
    other = sp.random(N * C, N * C, density=0.1, format="csr", rng=3)
    tie = sp.random(N * C, 7, density=0.3, format="csr", rng=4)
    for found, expected in (
        (mass.tocsr(), full),
        (mass.T.tocsr(), full.T),
        (mass @ tie, full @ tie),
        (tie.T @ mass, tie.T @ full),
        (tie.T @ mass @ tie, tie.T @ full @ tie),
        (other + 0.3 * mass, other + 0.3 * full),
        (0.3 * mass + other, other + 0.3 * full),
        (np.float64(0.3) * mass + other, other + 0.3 * full),
        (other - mass, other - full),
        (mass - other, full - other),
        (sp.csc_matrix(other) + mass, other + full),
        (other.tobsr((3, 3)) + mass, other + full),
    ):
        assert sp.issparse(found) and found.shape == expected.shape
        assert abs(found - expected).max() < 1e-14


def test_facts(pair):
    mass, full = pair
    assert mass.shape == full.shape and mass.nnz == full.nnz and mass.dtype == full.dtype
    assert np.array_equal(mass.diagonal(), full.diagonal())
    assert np.array_equal(mass.toarray(), full.toarray())


def test_wrong_sizes_are_refused(pair):
    mass, _ = pair
    for wrong in (np.zeros(N), np.zeros((N, C)), np.zeros((N * C, 2, 2))):
        with pytest.raises(ValueError, match="dimension mismatch"):
            mass @ wrong
    with pytest.raises(TypeError):
        mass * np.ones(3)


def test_solid_carries_it_where_exact():
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    options = {
        "element": "hex20",
        "size": 0.04,
        "layers": 0,
        "edge_layers": 0,
        "radial_layers": 0,
        "around": 8,
        "half": False,  # in blocks by parity the components of a node have each their own mass
    }
    free = sg.build(scene, "solid", **options)
    assert isinstance(free.blocks[0].mass, ScalarMass)
    rigid = sg.build(scene, "solid", attachments=("rigid",), **options)
    assert sp.issparse(rigid.blocks[0].mass)  # unknowns of seats are gone
    # both are the same body: rigid motions do not feel the ties
    assert rigid.mass_matrix() == pytest.approx(
        free.mass_matrix(), rel=1e-9, abs=1e-9 * free.mass_matrix().max()
    )
