"""Mode correlation: the algebra of the subspace MAC, and modes of one shaft recognised across
refinements and rotations.
"""

from dataclasses import replace

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.judge.correlation import correlate, subspace_mac

RNG = np.random.default_rng(4)
N = 12


def gram(n=N):
    a = RNG.standard_normal((n, n))
    return a @ a.T + n * np.eye(n)


def rotation(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


# --------------------------------------------------------------------------- algebra
@pytest.mark.parametrize("angle", [0.0, 0.3, np.pi / 4, np.pi / 2, 2.0, np.pi])
def test_rotated_pair_is_the_same_pair(angle):
    pair, g = RNG.standard_normal((2, N)), gram()
    # same plane, other basis: rounding
    assert subspace_mac(pair, rotation(angle) @ pair, g) == pytest.approx(1.0, abs=1e-12)
    # also a basis that is neither orthogonal nor normalised
    assert subspace_mac(pair, np.array([[2.0, 1.0], [0.1, -3.0]]) @ pair, g) == pytest.approx(
        1.0, abs=1e-12
    )


def test_orthogonal_in_the_inner_product_is_zero():
    g = gram()
    basis = np.linalg.solve(np.linalg.cholesky(g).T, np.eye(N)).T  # rows with x g x' = identity
    assert np.allclose(basis @ g @ basis.T, np.eye(N), atol=1e-12)
    # orthogonal by construction: squares of rounding
    assert subspace_mac(basis[:2], basis[2:4], g) < 1e-24
    assert subspace_mac(basis[:1], basis[1:2], g) < 1e-24
    # in the plain dot product they are not
    assert subspace_mac(basis[:2], basis[2:4], np.eye(N)) > 1e-6


@pytest.mark.parametrize("factor", [1.0, -1.0, 1e-9, 3e7])
def test_single_modes_follow_the_formula_whatever_their_scale(factor):
    a, b, g = RNG.standard_normal((1, N)), RNG.standard_normal((1, N)), gram()
    formula = (a @ g @ b.T).item() ** 2 / ((a @ g @ a.T).item() * (b @ g @ b.T).item())
    # the same quotient in another order of operations: rounding
    assert subspace_mac(factor * a, b, g) == pytest.approx(formula, rel=1e-10)
    assert subspace_mac(a, factor * b, 7.0 * g) == pytest.approx(formula, rel=1e-10)
    assert 0 < formula < 0.9  # or nothing was shown


def test_mean_of_squared_cosines():
    basis = np.eye(4)
    # planes that share one direction and differ by an angle in the other
    angle = 0.7
    other = np.array([[1, 0, 0, 0], [0, np.cos(angle), np.sin(angle), 0]])
    # (1 + cos^2) / 2 by definition, rounding
    assert subspace_mac(basis[:2], other, np.eye(4)) == pytest.approx(
        (1 + np.cos(angle) ** 2) / 2, abs=1e-14
    )
    assert subspace_mac(other, basis[:2], np.eye(4)) == pytest.approx(
        (1 + np.cos(angle) ** 2) / 2, abs=1e-14
    )


def test_member_of_a_pair_against_the_pair():
    pair, g = RNG.standard_normal((2, N)), gram()
    # it lies in the plane wherever it points: rounding
    assert subspace_mac(pair[:1] - 0.4 * pair[1:], pair, g) == pytest.approx(1.0, abs=1e-12)


def test_shapes_without_motion():
    some = RNG.standard_normal((1, N))
    assert subspace_mac(np.zeros((1, N)), some, np.eye(N)) == 0.0
    # a direction the inner product does not see
    g = np.diag([0.0] + [1.0] * (N - 1))
    assert subspace_mac(np.eye(N)[:1], some, g) == 0.0


# --------------------------------------------------------------------------- modes of a shaft
@pytest.fixture(scope="module")
def coarse_and_fine(overhung):
    return tuple(
        sg.modes(sg.build(overhung, "timoshenko", elements=n), overhung, 10) for n in (20, 60)
    )


def test_refinements_of_one_beam_agree(coarse_and_fine):
    coarse, fine = coarse_and_fine
    found = correlate(coarse, fine)
    assert found.rows == found.columns and len(found.rows) >= 6
    assert "rigid torsion" in fine.names and not any("rigid" in name for name in found.rows)
    # measured 2e-5 on the highest mode of 20 elements; 1 - MAC is the square of the angle between
    # shapes
    values = np.array(found.values)
    assert np.all(np.diag(values) > 1 - 1e-4)
    # different modes are orthogonal in the section masses up to what sections do not describe:
    # measured 4e-6
    assert np.all(values - np.diag(np.diag(values)) < 1e-4)
    assert np.all((values >= 0) & (values <= 1))
    for partner in found.pairs:
        assert partner.mode == partner.partner
        assert partner.relative == partner.frequency_hz / partner.reference_hz - 1
        assert partner.frequency_hz == coarse.named(partner.mode).frequency_hz
        assert partner.reference_hz == fine.named(partner.mode).frequency_hz


def turned(modes, angle):
    """The same set, every mode with its shapes mixed: another basis of the same plane."""
    changed = []
    for mode in modes.modes:
        if mode.multiplicity == 2:
            mode = replace(mode, motions=np.einsum("ij,jsc->isc", rotation(angle), mode.motions))
        changed.append(mode)
    return replace(modes, modes=tuple(changed))


@pytest.mark.parametrize("angle", [0.2, np.pi / 4, 1.0, np.pi / 2])
def test_twins_may_come_in_any_orientation(coarse_and_fine, angle):
    coarse, fine = coarse_and_fine
    assert sum(m.multiplicity == 2 for m in fine.modes) >= 3
    # the planes are the same: rounding of a 2x2 rotation
    assert np.allclose(
        correlate(turned(fine, angle), fine).values, correlate(fine, fine).values, atol=1e-10
    )
    assert np.allclose(
        correlate(coarse, turned(fine, angle)).values, correlate(coarse, fine).values, atol=1e-10
    )
    pair = fine.named("bending 1").motions.reshape(2, -1)
    mixed = turned(fine, angle).named("bending 1").motions.reshape(2, -1)
    # single MACs of the members do mean nothing: they fall with the square of the cosine, rounding
    assert subspace_mac(mixed[:1], pair[:1], fine.gram) == pytest.approx(
        np.cos(angle) ** 2, abs=1e-9
    )


def test_order_of_modes_does_not_matter(coarse_and_fine):
    coarse, fine = coarse_and_fine
    backwards = replace(fine, modes=fine.modes[::-1])
    assert [p.partner for p in correlate(coarse, backwards).pairs] == [
        p.partner for p in correlate(coarse, fine).pairs
    ]


def test_nothing_to_correlate_with(coarse_and_fine):
    coarse, fine = coarse_and_fine
    rigid_only = replace(fine, modes=tuple(m for m in fine.modes if m.frequency_hz == 0))
    found = correlate(coarse, rigid_only)
    assert found.values == [[] for _ in found.rows] and found.pairs == []
    assert correlate(rigid_only, fine).values == []


def test_other_stations_are_refused(coarse_and_fine):
    coarse, fine = coarse_and_fine
    with pytest.raises(ValueError, match="different stations"):
        correlate(coarse, replace(fine, stations=fine.stations * 1.01))
