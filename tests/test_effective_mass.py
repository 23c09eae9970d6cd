"""Lumped synthesis: the published stiffness, and what can be said of a first bending mode with two
numbers.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.reduction.effective_mass import effective_masses, modal_receptance, synthesise
from solidgear.core.reduction.lumped_point import LumpedPoint, lumped_point

GEOMETRY = Path(__file__).parent.parent / "geometry"
PINIONS = ("pinion_overhung", "pinion_straddle", "thesis_overhung", "thesis_straddle")
HELD = ("pinion_overhung", "pinion_straddle", "gear_shaft", "shaft_hollow")
BODIES = {"euler": {}, "timoshenko": {}, "harmonic": {"order": 2, "layers": 2}}


@cache
def solved(name, fidelity):
    scene = sg.load(GEOMETRY / f"{name}.toml")
    body = sg.build(scene, fidelity, **BODIES[fidelity])
    point, found = synthesise(body, scene, scene.port.name, sg.modes(body, scene, 12))
    return scene, body, point, found


every_body = pytest.mark.parametrize("fidelity", BODIES)


# --------------------------------------------------------------------------- published stiffness
# Hua (2010): x, y, thx and |x,thz| of the condensed stiffness at the pinion's lumped point, as in its tables
PUBLISHED = {
    "thesis_overhung": {
        (0, 0): 8.644e9,
        (2, 2): 8.644e9,
        (1, 1): 1.013e9,
        (3, 3): 2.843e7,
        (5, 5): 2.843e7,
        (0, 5): 4.140e8,
        (2, 3): 4.140e8,
    },
    "thesis_straddle": {
        (0, 0): 1.585e10,
        (2, 2): 1.585e10,
        (1, 1): 1.015e9,
        (3, 3): 5.140e7,
        (5, 5): 5.140e7,
        (0, 5): 7.294e7,
        (2, 3): 7.294e7,
    },
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_stiffness_follows_from_an_euler_body(name):
    scene = sg.load(GEOMETRY / f"{name}.toml")
    k = sg.condense(sg.build(scene, "euler"), scene, "pinion").stiffness
    for place, value in PUBLISHED[name].items():
        # identified head and stub; the published figures carry four digits
        assert abs(k[place]) == pytest.approx(value, rel=5e-3), place


@pytest.mark.parametrize("fidelity", ["timoshenko", "harmonic"])
@pytest.mark.parametrize("name", PUBLISHED)
def test_published_stiffness_is_no_elasticity(name, fidelity):
    scene = sg.load(GEOMETRY / f"{name}.toml")
    k = sg.condense(sg.build(scene, fidelity, **BODIES[fidelity]), scene, "pinion").stiffness
    # with shear the identified scene is softer by 40 to 55 %: the thesis's beams had none
    assert k[2, 2] < 0.65 * PUBLISHED[name][2, 2]


# --------------------------------------------------------------------------- the inequality
@every_body
@pytest.mark.parametrize("name", HELD)
def test_static_shape_stores_least_energy(name, fidelity):
    _, _, point, _ = solved(name, fidelity)
    # v'K_a v <= w1^2 u'Mu for every body; 1e-9 is the accuracy of w1^2
    assert point.static_share <= 1 + 1e-9
    assert point.static_share > 0.3  # and it is no artefact of a vanishing lumped-point motion


@every_body
@pytest.mark.parametrize("name", PINIONS)
def test_equations_52_and_53_have_no_solution_on_a_pinion(name, fidelity):
    _, _, _, found = solved(name, fidelity)
    thesis = found["thesis"]
    assert not thesis.feasible and thesis.mass is None
    assert thesis.numbers["static_share"] < 1 - 1e-4


def point_with(k, mass, order=0):
    """A lumped point whose body *is* a 2-DOF model: its modes are static shapes of the lumped
    point.
    """
    w2, shapes = sla.eigh(k, mass)
    return LumpedPoint(k, shapes[:, order], float(np.sqrt(w2[order])), mass[0, 0], mass[1, 1], mass)


def test_equations_52_and_53_accept_a_static_shape():
    mass = np.diag([5.0, 0.02])
    point = point_with(np.array([[4.7e9, 2.4e8], [2.4e8, 1.9e7]]), mass)
    found = effective_masses(point)
    assert found["thesis"].feasible and found["thesis"].first
    # the double root of the quadratic loses half of the digits
    assert found["thesis"].mass == pytest.approx(mass, rel=1e-6)
    for s in found.values():
        assert s.frequency_error == pytest.approx(
            0, abs=1e-7
        )  # all four agree when the body is its lumped model
        assert s.kinetic_error == pytest.approx(0, abs=1e-7)


def test_a_second_mode_is_not_taken_for_the_first():
    point = point_with(np.array([[4.7e9, 2.4e8], [2.4e8, 1.9e7]]), np.diag([5.0, 0.02]), order=1)
    found = effective_masses(point)
    # (52) and (53) hold to the letter here, but at the second frequency of the model
    assert not found["thesis"].feasible
    assert found["mode-matched"].feasible and not found["mode-matched"].first


# --------------------------------------------------------------------------- mode-matched, Guyan, old
@every_body
@pytest.mark.parametrize("name", HELD)
def test_mode_matched_keeps_frequency_and_slope(name, fidelity):
    _, _, point, found = solved(name, fidelity)
    matched = found["mode-matched"]
    assert matched.feasible == bool(np.all(np.diag(matched.mass) > 0))
    if not matched.feasible:
        return
    w2, shapes = sla.eigh(point.stiffness, matched.mass)
    k = int(np.argmin(abs(np.sqrt(w2) / point.omega - 1)))
    assert np.sqrt(w2[k]) == pytest.approx(point.omega, rel=1e-8)
    assert shapes[1, k] / shapes[0, k] == pytest.approx(point.motion[1] / point.motion[0], rel=1e-7)
    assert matched.first == (k == 0)
    if matched.first:
        assert matched.frequency_error == pytest.approx(0, abs=1e-8)


@every_body
@pytest.mark.parametrize("name", HELD)
def test_guyan_bounds_from_above(name, fidelity):
    _, _, _, found = solved(name, fidelity)
    # Rayleigh: the static shapes are a subspace; 1e-9 for rounding
    assert found["guyan"].frequency_error > -1e-9
    assert np.linalg.eigvalsh(found["guyan"].mass)[0] > 0


def test_guyan_of_a_nearly_rigid_shaft_is_the_rigid_body():
    scene = sg.load(GEOMETRY / "pinion_overhung.toml").with_material(E=2.07e16)
    body = sg.build(scene, "timoshenko")
    point, _ = lumped_point(body, scene, "pinion", sg.modes(body, scene, 12))
    m, y = body.mass_matrix(), scene.port.y
    # seen from the lumped point: z motion couples with tilt through the static moment
    moment = m[2, 3] - y * m[2, 2]
    rigid = np.array([[m[2, 2], moment], [moment, m[3, 3] - 2 * y * m[2, 3] + y * y * m[2, 2]]])
    # a thousand times stiffer steel leaves 1e-3 to 1e-4 of elasticity per unit of bearing
    # flexibility
    assert point.guyan == pytest.approx(rigid, rel=1e-3)


# --------------------------------------------------------------------------- receptance and other bodies
def test_receptance_against_a_direct_solution():
    scene, body, _, _ = solved("pinion_overhung", "timoshenko")
    found = sg.modes(body, scene, 12)
    receptance = modal_receptance(body, scene, "pinion", found)
    block = body.blocks[0]
    g = block.ports.toarray()
    supports = as_supports(scene)
    spring = supports.stiffness[np.ix_([2, 3, 8, 9], [2, 3, 8, 9])]
    k = block.stiffness.toarray() + g[2:6].T @ spring @ g[2:6]
    for share in (0.3, 0.8, 1.3):
        w = share * 2 * np.pi * found.named("bending 1").frequency_hz
        direct = g[0] @ np.linalg.solve(k - w * w * block.mass.toarray(), g[0])
        # five bending pairs and the static remainder: (w / w_6)^4, below 1e-3
        assert receptance(w) == pytest.approx(direct, rel=1e-3)


def test_a_free_shaft_has_no_lumped_model():
    scene = sg.load(GEOMETRY / "cylinder_free.toml")
    body = sg.build(scene, "timoshenko")
    with pytest.raises(sg.SolidgearError, match="bearings leave it free"):
        lumped_point(body, scene, scene.port.name, sg.modes(body, scene, 6))


@pytest.mark.parametrize("soft", ["kxx", "kzz"])
def test_unequal_bearings_keep_the_model_in_its_plane(soft):
    """With the other plane softer its mode comes first; the lumped model of (z, thx) still takes
    the mode that moves it.
    """
    scene = sg.load(Path(__file__).parent.parent / "geometry" / "pinion_overhung.toml")
    weight = np.ones(6)
    weight[{"kxx": 0, "kzz": 2}[soft]] = 0.9
    bearings = tuple(
        b.with_changes(matrix=np.diag(weight) @ np.array(b.matrix) @ np.diag(weight))
        for b in scene.bearings
    )
    scene = scene.with_changes(bearings=bearings)
    point, made = synthesise(sg.build(scene, "timoshenko"), scene, scene.port.name)
    assert abs(point.motion[0]) > 0.1
    assert made["guyan"].feasible and 0 <= made["guyan"].frequency_error < 0.05
