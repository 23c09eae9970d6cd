"""A body reduced to its ports against the body itself, on any bearings, and the bound on their difference."""

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.solve.statics import flexibility
from tests.dense import every

SCENE = sg.load("geometry/pinion_overhung.toml")
LIGHT = {
    "euler": {"elements": 40},
    "timoshenko": {"elements": 40},
    "harmonic": {"order": 3, "layers": 1},
    "solid": {"size": 0.05, "layers": 0, "edge_layers": 0, "radial_layers": 0, "around": 8},
}
REDUCTIONS = {"rubin": sg.rubin, "craig_bampton": sg.craig_bampton}
#: what a solved mode of a body is good to, for twins told by their mean among them
ROUNDING = 1e-9


@pytest.fixture(scope="module", params=LIGHT)
def body(request):
    return sg.build(SCENE, request.param, **LIGHT[request.param])


@pytest.fixture(scope="module", params=REDUCTIONS)
def part(request, body):
    return REDUCTIONS[request.param](body, n=24)


def on_bearings(part, supports):
    return sg.System({"shaft": part}, sg.grounded("shaft", supports))


def coupled():
    """The bearings of the scene in a housing that gives along the shaft."""
    return SCENE.with_changes(housing_axial=1e8)


@pytest.mark.parametrize("supports", [SCENE, coupled()], ids=["scene", "housing"])
def test_modes_on_bearings_are_those_of_the_body_within_the_bound(body, part, supports):
    found = on_bearings(part, supports).modes(8)
    exact = every(sg.modes(body, supports, 8, ovalising=False))[:9]
    # free rotation, and nothing else
    assert found.rigid == 1 and found.frequency_hz[0] == 0.0 == exact[0]
    error = found.frequency_hz[1:] / exact[1:] - 1
    assert error.min() > -ROUNDING
    assert np.all(error <= found.error_bound[1:] + ROUNDING)
    # a Krylov step at the ports makes the free basis far the better one
    assert found.error_bound.max() < (1e-6 if part.kind == "rubin" else 0.02)


def test_a_part_without_modes_proves_no_frequency(body):
    bare = on_bearings(sg.rubin(body, n=0), SCENE).modes(2)
    assert np.isinf(bare.error_bound[1:]).all()


@pytest.mark.parametrize("modes", [24, 0])
def test_statics_are_those_of_the_body(body, part, modes):
    part = part if modes else sg.rubin(body, n=0)
    system = on_bearings(part, SCENE)
    rows = np.delete(system.motion("shaft.pinion"), 4, axis=0)
    found = rows @ system.static(rows.T)
    exact = np.delete(np.delete(sg.condense(body, SCENE, "pinion").compliance, 4, 0), 4, 1)
    size = np.sqrt(np.diag(exact))
    # both go back to the same attachment fields, good to 1e-12 in energy
    assert np.abs((found - exact) / np.outer(size, size)).max() < 1e-9


def test_the_free_part_keeps_flexibility_mass_and_rigid_motions(body, part):
    motions = np.vstack([p.rows for p in part.ports.values()])
    rigid = part.value == 0
    assert part.rigid == 6
    # exact: no strain row has an entry on a rigid motion
    assert not part.strain[:, rigid].any()
    # rigid coordinates are mass-normalised: what they move is P M^-1 P'
    swing = body.rigid_ports
    np.testing.assert_allclose(
        motions[:, rigid] @ motions[:, rigid].T,
        swing @ np.linalg.solve(body.mass_matrix(), swing.T),
        rtol=1e-9,
        atol=1e-12,
    )
    # loads in equilibrium find the flexibility of the body
    balanced = np.linalg.svd(swing)[0][:, 6:]
    elastic = balanced.T @ motions[:, ~rigid]
    found = (elastic / part.value[~rigid]) @ elastic.T
    exact = balanced.T @ flexibility(body).matrix @ balanced
    size = np.sqrt(np.diag(exact))
    assert np.abs((found - exact) / np.outer(size, size)).max() < 1e-8


def test_the_way_back_to_the_mesh(body, part):
    rng = np.random.default_rng(3)
    q = rng.standard_normal((part.size, 2))
    fields = part.expand(q)
    ports = np.zeros((6 * len(body.ports), 2))
    heavy = energy = 0.0
    for index, u in fields.items():
        block = body.blocks[index]
        ports[body.rows(block)] += block.ports @ u
        heavy += np.sum(u * (block.mass @ u))
        energy += np.sum(u * (block.stiffness @ u))
    told = np.vstack([p.rows for p in part.ports.values()]) @ q
    assert np.abs(ports - told).max() < 1e-9 * np.abs(told).max()
    # shapes far above the spectrum of interest are normalised to 1e-6 where an element has no
    # rotary inertia
    assert heavy == pytest.approx(np.sum(q * q), rel=1e-5)
    assert energy == pytest.approx(np.sum((part.strain @ q) ** 2), rel=1e-5)
    assert [u.shape for u in part.expand(q[:, 0]).values()] == [(b.size,) for b in body.blocks]


def test_a_mode_of_the_system_is_one_on_the_mesh():
    body = sg.build(SCENE, "timoshenko", elements=40)
    system = on_bearings(sg.rubin(body, n=24), SCENE)
    shape = system.modes(2).shapes[:, 1]
    direct = sg.modes(body, SCENE, 2).modes[1]
    fields = system.expand("shaft", shape)
    overlap = 0.0
    for vectors in direct.vectors:
        inner = sum(v @ (body.blocks[b].mass @ fields[b]) for b, v in vectors.items())
        overlap += inner**2
    # inside the plane of the twins
    assert overlap == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("reduction", REDUCTIONS)
def test_any_attachment_of_any_port(reduction):
    body = sg.build(SCENE, "timoshenko", elements=40, attachments=("average", "section"))
    part = REDUCTIONS[reduction](body, 24, ports=[("pinion", "section"), "2", "1"])
    assert list(part.ports) == ["pinion", "2", "1"]
    load = np.eye(6)[2]
    system = on_bearings(part, SCENE)
    found = system.motion("shaft.pinion") @ system.static(system.load({"shaft.pinion": load}))
    exact = sg.condense(body, SCENE, "pinion", "section").compliance
    assert found[2] == pytest.approx(exact[2, 2], rel=1e-9)
    other = sg.condense(body, SCENE, "pinion", "average").compliance
    assert abs(other[2, 2] / exact[2, 2] - 1) > 1e-3


def test_a_station_without_bearing_is_a_bearing_without_stiffness():
    sensor = sg.Bearing(name="end", y=0.27, seat_width=0.006, stiffness=np.zeros((6, 6)))
    scene = SCENE.with_changes(bearings=(*SCENE.bearings, sensor))
    body = sg.build(scene, "timoshenko")
    system = on_bearings(sg.rubin(body, n=24), scene)
    assert "shaft.end" not in system.links
    moved = system.motion("shaft.end") @ system.static(system.load({"shaft.pinion": np.eye(6)[2]}))
    # Maxwell: the same the other way round
    back = system.motion("shaft.pinion") @ system.static(system.load({"shaft.end": np.eye(6)[2]}))
    assert moved[2] == pytest.approx(back[2], rel=1e-9) and abs(moved[2]) > 0
    exact = every(sg.modes(body, SCENE, 4))
    np.testing.assert_allclose(system.modes(4).frequency_hz[1:], exact[1:5], rtol=1e-7)


@pytest.mark.parametrize("reduction", REDUCTIONS)
def test_a_body_smaller_than_its_basis_is_kept_whole(reduction):
    body = sg.build(SCENE, "euler", elements=1)
    part = REDUCTIONS[reduction](body, n=10**4)
    assert part.size == body.size and np.isinf(part.truncation.cut)
    found = on_bearings(part, SCENE).modes(6)
    assert not found.error_bound.any()
    exact = every(sg.modes(body, SCENE, 6))
    np.testing.assert_allclose(found.frequency_hz, exact[:7], rtol=1e-7)


@pytest.mark.parametrize("scale", [1e-9, 1e14])
def test_springs_far_from_the_shaft_cost_no_digits(scale):
    body = sg.build(SCENE, "timoshenko", elements=40)
    scene = SCENE.with_bearing_scale(scale)
    system = on_bearings(sg.rubin(body, n=24), scene)
    rows = np.delete(system.motion("shaft.pinion"), 4, axis=0)
    found = rows @ system.static(rows.T)
    exact = np.delete(np.delete(sg.condense(body, scene, "pinion").compliance, 4, 0), 4, 1)
    size = np.sqrt(np.diag(exact))
    # a bidiagonal factorisation leaves 1e-9 at 1e14
    assert np.abs((found - exact) / np.outer(size, size)).max() < 1e-12
    assert system.modes(4).rigid == 1


@pytest.mark.parametrize("reduction", REDUCTIONS)
def test_a_port_as_long_as_the_shaft(reduction):
    """Its mean motion is a rigid motion alone: along the axis nothing is left over for fields."""
    rod = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.5, diameter=0.05)])
    springs = sg.Supports(("port",), np.diag([1e7, 2e7, 1e7, 1e4, 2e4, 1e4]))
    for attachment in ("average", "rigid"):
        body = sg.build(rod.with_attachment(attachment), "timoshenko")
        found = on_bearings(REDUCTIONS[reduction](body, n=20), springs).modes(6)
        # a seat that is rigid from end to end leaves a rigid body
        count = 6 if attachment == "rigid" else 8
        exact = every(sg.modes(body, springs, count))
        np.testing.assert_allclose(found.frequency_hz, exact[: len(found.frequency_hz)], rtol=1e-4)
        assert found.rigid == 0


def test_in_soft_springs_a_shaft_is_a_rigid_body():
    body = sg.build(SCENE, "timoshenko", elements=40)
    soft = SCENE.with_bearing_scale(1e-7)
    elastic = on_bearings(sg.rubin(body, n=24), soft).modes(5)
    rigid = on_bearings(sg.RigidBody.of(body), soft).modes(5)
    assert elastic.rigid == rigid.rigid == 1
    # compliance of the shaft beside that of the springs
    np.testing.assert_allclose(elastic.frequency_hz[1:], rigid.frequency_hz[1:], rtol=1e-5)


@pytest.mark.parametrize(
    "ask, words",
    [
        (lambda b: sg.rubin(b, ports=["nose"]), "no port nose"),
        (lambda b: sg.rubin(b, ports=["1", ("1", "section")]), "given twice"),
        (lambda b: sg.rubin(b, n=-1), "neither may be negative"),
        (lambda b: sg.craig_bampton(b, n=0), "one mode or more|1 or more"),
        (lambda b: sg.craig_bampton(b, ports=[]), "no port to hold"),
        (lambda b: sg.rubin(b).expand(np.zeros(3)), "cannot expand 3"),
    ],
)
def test_wrong_questions_are_one_sentence(ask, words):
    body = sg.build(SCENE, "euler", elements=20)
    with pytest.raises(sg.SolidgearError, match=words) as caught:
        ask(body)
    assert "\n" not in str(caught.value)


def test_ports_that_move_as_one_are_refused():
    # the lumped point is the section in the middle of the second seat
    scene = SCENE.with_attachment("section")
    scene = scene.with_port(y=scene.bearings[1].y, lo=0.07, hi=0.27)
    with pytest.raises(sg.SolidgearError, match="cannot all move independently"):
        sg.craig_bampton(sg.build(scene, "timoshenko"), n=8)
