"""The eigensolvers against each other, their fall-back, and the count that proves no mode was
missed.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.scene import STEEL, Material, Scene, Segment
from solidgear.core.solve import eigen
from solidgear.core.solve import groups as parts
from solidgear.core.solve.coupling import decoupled, groups
from solidgear.core.solve.eigen import count_below, lowest
from solidgear.core.solve.supported import Supported

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def scene():
    return sg.load(ROOT / "geometry" / "pinion_overhung.toml")


@pytest.fixture(scope="module")
def solid(scene):
    """Of one block, which holds all motions."""
    return sg.build(scene, "solid", refinement=0.3, half=False)


@pytest.fixture(scope="module")
def harmonic(scene):
    return sg.build(scene, "harmonic", order=2, layers=1)


def supported(body, scene, group=0):
    spring, _ = decoupled(body, as_supports(scene), 1e-6)
    return Supported(
        body, as_supports(scene), spring, groups(body, as_supports(scene), spring)[group]
    )


@pytest.mark.parametrize("fidelity, bearings", [("solid", True), ("harmonic", False)])
def test_lanczos_and_arpack_agree(scene, fidelity, bearings, request):
    """Two algorithms on the same factor: frequencies are those of Rayleigh quotients, each good to
    the rounding of K u.
    """
    body = request.getfixturevalue(fidelity)
    on = scene if bearings else ()
    a, b = (sg.modes(body, on, n=12, method=m) for m in ("lanczos", "arpack"))
    assert a.names == b.names
    assert a.multiplicity == b.multiplicity
    # Entries of K u are rounded by eps |K| |u|, so an eigenvalue by eps times the largest one,
    # which is about three times that of a single unknown; two quotients differ by twice that, their
    # frequencies by half.
    largest = 3 * max(
        (block.stiffness.diagonal() / block.mass.tocsr().diagonal()).max() for block in body.blocks
    )
    squared = (2 * np.pi * b.frequency_hz) ** 2
    rounding = np.finfo(float).eps * largest / np.where(squared > 0, squared, np.inf)
    assert np.all(np.abs(a.frequency_hz - b.frequency_hz) <= b.frequency_hz * (1e-11 + rounding))
    assert rounding.max() < 1e-7  # and that is a bound worth the name
    assert a.evidence["method"] == "lanczos" and b.evidence["method"] == "arpack"
    assert a.evidence["residual"] < 1e-6
    assert a.evidence["orthogonality"] < 1e-10


def test_dense_is_the_oracle(scene):
    few, many = (supported(sg.build(scene, "timoshenko", elements=n), scene) for n in (10, 150))
    # small systems are LAPACK's by themselves, whoever was asked; the one compared here is not
    assert few.size <= eigen.DENSE < many.size and lowest(few, 6).method == "dense"
    exact = lowest(many, 6, "dense")
    for method in ("lanczos", "arpack"):
        found = lowest(many, 6, method)
        assert found.method == method
        # two quotients, each good to the rounding of K u (above): 1.2e-9 of the lowest eigenvalue
        np.testing.assert_allclose(
            [r.value for r in found.elastic], [r.value for r in exact.elastic], rtol=2.4e-9
        )


def test_unknown_method_is_refused(scene, harmonic):
    with pytest.raises(sg.SolidgearError, match="'power' is unknown; use 'lanczos'"):
        sg.modes(harmonic, scene, method="power")


def test_arpack_takes_over_where_lanczos_gives_up(scene, solid, monkeypatch):
    solid.cache.clear()  # of modes that other tests have found
    real = eigen.block_lanczos
    monkeypatch.setattr(eigen, "block_lanczos", lambda *a, **k: real(*a, **{**k, "most": 8}))
    found = sg.modes(solid, scene, n=6, method="lanczos")
    assert "did not converge" in found.evidence["method"]
    np.testing.assert_allclose(
        found.frequency_hz, sg.modes(solid, scene, n=6, method="arpack").frequency_hz, rtol=1e-9
    )


def test_both_of_twins_among_near_modes_are_found_in_a_basis_that_is_too_small():
    """Eigenvalues some 1e-3 apart, every other one twice: a basis of few vectors goes on with its best
    half, and still holds both of each pair.
    """
    value = 1 / np.sort(np.r_[np.repeat(1 + 2e-3 * np.arange(100), 2), 1 + 3e-3 * np.arange(200)])
    start = np.random.default_rng(0).standard_normal((len(value), 8))
    apply = (lambda f: value[:, None] * f, lambda u: u)
    pairs = eigen.block_lanczos(*apply, start, 12, tolerance=1e-7, most=48)
    assert pairs.converged and pairs.columns > 48
    np.testing.assert_allclose(pairs.theta, value[:12], rtol=1e-12)


@pytest.mark.parametrize("fidelity", ["solid", "harmonic"])
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e6])
def test_count_confirms_complete_results(scene, fidelity, scale, request):
    """Bearings from next to nothing to near rigid: the inertia of K - mu M and the correction for
    the springs add up.
    """
    body = request.getfixturevalue(fidelity)
    found = sg.modes(body, scene.with_bearing_scale(scale), n=10, count=True)
    assert all(c["checked"] for c in found.evidence["count"]), found.evidence["count"]


def test_count_of_a_free_body_includes_its_rigid_motions(solid):
    body_modes = sg.modes(solid, (), n=6, count=True)
    count = body_modes.evidence["count"][0]
    below = sum(m.multiplicity for m in body_modes.modes if m.frequency_hz < count["below_hz"])
    assert count["modes"] >= 6 + 3
    assert (
        below <= count["modes"] <= below + 2
    )  # two shapes more than asked for are found, and counted where the gap is behind them


@pytest.mark.parametrize("lost", [0, *(pytest.param(k, marks=pytest.mark.long) for k in (1, 5))])
def test_count_notices_a_lost_mode(scene, solid, lost):
    on = supported(solid, scene)
    solved = lowest(on, 10)
    reach = solved.elastic[8].value
    whole = count_below(on, solved, reach)
    assert whole.computed == whole.existing
    short = replace(solved, elastic=[r for i, r in enumerate(solved.elastic) if i != lost])
    seen = count_below(on, short, reach)
    assert seen.existing == seen.computed + 1


def test_a_lost_mode_is_searched_again(scene, solid, monkeypatch):
    real = parts.lowest
    calls = []

    def forgetful(on, n, method=None):
        calls.append(method)
        solved = real(on, n, method)
        return (
            replace(solved, elastic=solved.elastic[:1] + solved.elastic[2:])
            if len(calls) == 1
            else solved
        )

    monkeypatch.setattr(parts, "lowest", forgetful)
    found = sg.modes(solid, scene, n=8, count=True)
    assert len(calls) == 2
    monkeypatch.undo()
    np.testing.assert_allclose(
        found.frequency_hz[:5], sg.modes(solid, scene, n=8).frequency_hz[:5], rtol=1e-9
    )


@pytest.mark.long
def test_a_mode_lost_twice_ends_in_a_sentence(scene, solid, monkeypatch):
    real = parts.lowest
    monkeypatch.setattr(
        parts, "lowest", lambda *a: (lambda s: replace(s, elastic=s.elastic[1:]))(real(*a))
    )
    with pytest.raises(
        sg.SolidgearError, match=r"modes were found below .* Hz but the factor counts"
    ):
        sg.modes(solid, scene, n=8, count=True)


def test_elastic_modes_below_the_soft_limit_of_a_free_shaft():
    """An estimate of the spectrum that is far too high puts elastic modes far below the shift,
    where soft springs put theirs; with no spring there is no rigid motion to mix in.
    """
    lead = Material(E=16e9, nu=0.44, density=11340.0)
    steel = STEEL
    parts = [
        Segment.cylinder("a", length=0.04, diameter=0.09, material=steel),
        Segment.cylinder("b", length=0.054, diameter=0.07, y0=0.04, material=lead),
        Segment.cylinder("c", length=0.03, diameter=0.1, y0=0.094, material=steel),
    ]
    scene = Scene.from_parts(parts)
    body = sg.build(scene, "timoshenko")
    body = replace(body, scale=200 * body.scale)
    found = sg.modes(body, (), n=4)
    assert found.evidence["orthogonality"] < 1e-9
    assert found.evidence["rigid_modes"] == 6
    k, m = (getattr(body.blocks[0], name).toarray() for name in ("stiffness", "mass"))
    exact = np.sqrt(sla.eigh(k, m, eigvals_only=True)[2]) / (2 * np.pi)
    assert (2 * np.pi * exact) ** 2 < 0.01 * body.scale  # or it would prove nothing
    assert found.named("bending 1").frequency_hz == pytest.approx(exact, rel=1e-7)


@pytest.mark.parametrize("model", ["euler", "timoshenko"])
def test_unknowns_without_mass(model):
    # lumped masses without rotary inertia leave the turns of a beam massless; the mass matrix is
    # then no metric
    scene = sg.load(Path(__file__).parents[1] / "geometry" / "shaft_stepped.toml")
    lumped, consistent = (
        sg.modes(sg.build(scene, model, mass=mass, rotary_inertia=False), scene, n=6)
        for mass in ("lumped", "consistent")
    )
    assert lumped.names[:6] == consistent.names[:6]
    # lumping costs the square of the element over the wave: 40 elements, 1e-3 and less
    assert lumped.frequency_hz[:6] == pytest.approx(consistent.frequency_hz[:6], rel=3e-3)
    # shapes are moved into place by the inverse, whose rounding is 1e-6 for short Euler elements;
    # its square is what frequencies feel
    assert lumped.evidence["residual"] < 1e-4 and lumped.evidence["orthogonality"] < 1e-4
