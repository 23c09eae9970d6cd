"""Modes in the reduced basis against the body itself, and the bound on their difference."""

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.body import Supports
from solidgear.core.reduction import moments as reduction
from solidgear.core.reduction.moments import reduce
from solidgear.variants.sweep.bearing_variants import bearing_variants
from solidgear.variants.sweep.ritz import Seats, _bound, _Group, ritz_modes
from tests.counted import from_the_start
from tests.dense import whole

PATH = from_the_start("geometry/pinion_overhung.toml")
SCENE = sg.load(PATH)
#: overlapping candidate seats, among them two that share no mesh line
POSITIONS = "bearing.2.position=0.205,0.2137,0.23,0.246"
VARIANTS = bearing_variants(PATH, [POSITIONS])
LIGHT = {"timoshenko": {"elements": 40}, "harmonic": {"order": 2, "layers": 1}}


@pytest.fixture(scope="module", params=LIGHT)
def body(request):
    return sg.build(VARIANTS.shaft(), request.param, **LIGHT[request.param])


def springs(kind, place):
    """Supports of one kind on the seats of one placement."""
    _, plain = VARIANTS.supports(place)
    k = np.array(plain.stiffness)
    rng = np.random.default_rng(7)
    if kind == "coupled":  # both planes, axial motion and torsion at once
        size = np.sqrt(np.diag(k) + 1e4 * (np.diag(k) == 0))
        for i in (0, 6):
            c = rng.standard_normal((6, 6))
            c = c @ c.T
            d = np.sqrt(np.diag(c))
            k[i : i + 6, i : i + 6] = (0.5 * np.eye(6) + 0.5 * c / np.outer(d, d)) * np.outer(
                size[i : i + 6], size[i : i + 6]
            )
    elif kind == "uneven":  # the planes differ
        k[0, 0] *= 3
        k[6, 6] *= 0.8
    elif kind == "free":
        k *= 0
    elif kind in ("pin", "uneven_pin"):  # the shaft swings about its first bearing
        k[6:, :] = k[:, 6:] = 0
        k[3:6, :] = k[:, 3:6] = 0
        k[0, 0] *= 1 + 2 * (kind == "uneven_pin")
    elif kind == "soft":
        k *= 1e-7
    elif kind == "stiff":
        k *= 1e14
    elif kind == "mixed":
        k[:6, :6] *= 1e9
        k[6:, 6:] *= 1e-5
    return Supports(plain.ports, k)


def shapes(found):
    """Elastic frequencies and names of `modes`, twins twice."""
    rows = [
        (m.frequency_hz, m.name)
        for m in found.modes
        if not m.name.startswith("rigid")
        for _ in range(m.multiplicity)
    ]
    return np.array([f for f, _ in rows]), [n for _, n in rows]


def small(reduced, body, supports, n, slack=1e-6):
    return ritz_modes(
        reduced,
        Seats(reduced, tuple(body.port_index(p) for p in supports.ports)),
        supports,
        n,
        slack,
    )


KINDS = ("plain", "coupled", "uneven", "free", "pin", "uneven_pin", "soft", "stiff", "mixed")


@pytest.mark.parametrize(
    "body, kind",
    [*(("timoshenko", k) for k in KINDS), *(("harmonic", k) for k in ("coupled", "pin", "mixed"))],
    indirect=["body"],
)
def test_modes_of_any_bearings_agree_with_those_of_the_body(body, kind):
    reduced = reduce(body, 10, level=1)
    for place in (0, 2):
        supports = springs(kind, place)
        found, direct = small(reduced, body, supports, 10), sg.modes(body, supports, 10)
        frequency, names = shapes(direct)
        assert found.error_bound < 1e-6
        # a mode of 1 Hz in a shaft of 4 kHz is defined to about 1e-7 by matrices in double
        # precision
        rounding = 1e-7 if kind == "soft" else 1e-9
        np.testing.assert_allclose(
            found.frequency_hz,
            frequency[:10],
            rtol=found.error_bound + direct.evidence["residual"] + rounding,
        )
        if kind != "coupled":  # families mix there, and the larger share may fall either way
            assert list(found.names) == names[:10]


def dense(body, supports, n):
    """All eigenvalues of ``K + G' Kb G`` assembled in full, LAPACK's generalised solver: shares
    nothing with the package.
    """
    k, m, g = whole(body)
    g = g[supports.rows(body)]
    return sla.eigh(
        k + g.T @ supports.stiffness @ g, m, eigvals_only=True, subset_by_index=[0, n - 1]
    )


@pytest.mark.parametrize("kind", ["plain", "coupled", "uneven"])
@pytest.mark.parametrize("more", [0.2, 0.6, 1.0])
def test_the_error_lies_below_its_bound_and_not_far(kind, more, monkeypatch):
    """Poor bases on purpose, so that the error is far above rounding; every frequency is too high,
    and by no more than the bound.
    """
    body = sg.build(VARIANTS.shaft(), "timoshenko", elements=12)
    # one step of Krylov taken away, and few free modes
    monkeypatch.setattr(reduction, "LEVELS", ((more, 0),))
    reduced = reduce(body, 10)
    promised = 0
    for place in range(4):
        supports = springs(kind, place)
        rigid = supports.unresisted(body).shape[1]
        exact = np.sqrt(dense(body, supports, 10 + rigid)[rigid:]) / (2 * np.pi)
        for n in (2, 4, 6, 10):
            found = small(reduced, body, supports, n)
            error = found.frequency_hz / exact[:n] - 1
            assert (
                error.min() > -1e-7
            )  # rounding of the dense solution; couplings left out are below it
            if np.isfinite(found.error_bound):
                promised += 1
                assert error.max() <= found.error_bound + 1e-7
                if error.max() > 1e-6:
                    assert found.error_bound < 40 * error.max()
    assert promised >= 4


def test_a_basis_that_misses_a_mode_promises_nothing(body, monkeypatch):
    monkeypatch.setattr(reduction, "LEVELS", ((0.1, 0),))
    assert not small(reduce(body, 4), body, springs("plain", 0), 10).error_bound < 1e-3


def test_a_larger_basis_lowers_frequencies_and_bound(body):
    supports = springs("uneven", 1)
    found = [small(reduce(body, 10, level), body, supports, 10) for level in (0, 1)]
    assert found[1].error_bound < found[0].error_bound < 1e-6
    assert np.all(found[1].frequency_hz <= found[0].frequency_hz * (1 + 1e-12))


def test_a_body_smaller_than_its_basis_is_solved_exactly():
    body = sg.build(VARIANTS.shaft(), "euler", elements=1)
    supports = springs("plain", 0)
    found = small(reduce(body, 10), body, supports, 6)
    np.testing.assert_allclose(
        found.frequency_hz, shapes(sg.modes(body, supports, 6))[0][:6], rtol=1e-8
    )


def test_ovalising_modes_do_not_feel_bearings():
    body = sg.build(VARIANTS.shaft(), "harmonic", **LIGHT["harmonic"], ovalising=(2,))
    supports = springs("plain", 0)
    found, (frequency, _) = (
        small(reduce(body, 20), body, supports, 20),
        shapes(sg.modes(body, supports, 20)),
    )
    own = [f for f, name in zip(found.frequency_hz, found.names) if name.startswith("ovalising")]
    assert own and all(np.abs(frequency / f - 1).min() < 1e-8 for f in own)


@pytest.mark.long
def test_in_the_solid_one_block_holds_everything():
    """A coarse 3D body; its pairs are exact by symmetry, so names and pairs are those of `modes`."""
    body = sg.build(
        VARIANTS.shaft(), "solid", size=0.05, layers=0, edge_layers=0, radial_layers=0, around=8
    )
    reduced = reduce(body, 6)
    for kind in ("plain", "uneven"):
        supports = springs(kind, 1)
        found, direct = small(reduced, body, supports, 6), sg.modes(body, supports, 6)
        frequency, names = shapes(direct)
        assert found.error_bound < 1e-5
        np.testing.assert_allclose(
            found.frequency_hz, frequency[:6], rtol=found.error_bound + 1e-9
        )  # and what the free shapes of the basis miss
        assert list(found.names) == names[:6]


def test_a_shaft_on_feathers_moves_as_a_rigid_body(body):
    """Springs 1e-13 of real ones: six eigenvalues of a 6x6, to the share of elastic motion in them."""
    plain = springs("plain", 0)
    supports = Supports(plain.ports, 1e-13 * plain.stiffness)
    p = body.rigid_ports[supports.rows(body)]
    rigid = sla.eigh(p.T @ supports.stiffness @ p, body.mass_matrix(), eigvals_only=True)[
        1:
    ]  # torsion is free
    found = small(reduce(body, 6), body, supports, 6)
    np.testing.assert_allclose(found.frequency_hz[:5], np.sqrt(rigid) / (2 * np.pi), rtol=1e-7)


def test_the_bound_holds_for_any_operator_it_is_made_for():
    """Random operators ``[[T, E'], [E, C]]`` with ``C <= cut``: no eigenvalue above the last wanted
    one may go uncounted.
    """
    rng = np.random.default_rng(1)
    finite = hidden = 0
    for _ in range(400):
        cut, theta = 0.5, np.sort(rng.uniform(0.45, 2.0, 5))[::-1]
        c = rng.standard_normal((6, 6))
        c = cut * (c @ c.T) / np.linalg.norm(c @ c.T, 2)
        e = rng.standard_normal((6, 5)) * 10 ** rng.uniform(-4, -0.3)
        e[:, 0] *= 1e-3
        exact = np.linalg.eigvalsh(np.block([[np.diag(theta), e.T], [e, c]]))[::-1]
        count = int(rng.integers(1, 4))
        # as for the first of several groups: the last mode of all lies between two of this one
        t = rng.uniform(theta[count], theta[count - 1])
        found = _bound(_Group(1 / theta, theta, e.T @ e, cut, {}), count, 1 / t, 0.0, 1e-6)
        more = (exact > t * (1 + 2e-6)).sum() > count
        hidden += more
        assert not (more and np.isfinite(found))
        if np.isfinite(found):
            finite += 1
            assert np.all(np.sqrt(exact[:count] / theta[:count]) - 1 <= found + 1e-14)
    assert finite > 50 and hidden > 10
