"""What spin does to natural frequencies, from modes at rest."""

import json
from math import pi
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.judge.at_rest import moved_beyond, spin_caution
from solidgear.core.scene import Bearing, Material, PointMass, Scene
from solidgear.core.solve.spin import (
    Whirl,
    _of_sections,
    couplings,
    opened,
    spin_moves,
    whirled,
    whole_shapes,
)
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.modes.modes import train_modes
from tests.shafts import shaft
from validation.shipped import GEOMETRY

#: harmonic meshes, good to 1 % here
COARSE = {"order": 3, "layers": 0, "edge_layers": 0, "relative_size": 4.0}


def opening(scene, name, model, **options):
    """Half of the frequency by which one turn in a second parts a pair, Hz."""
    body = sg.build(scene, model, **options)
    found = sg.modes(body, scene, 8)
    moved = spin_moves(body, as_supports(scene), found.modes, 1.0)[name]
    frequency = next(mode.frequency_hz for mode in found.modes if mode.name == name)
    return frequency * (moved.up - moved.down) / 2


@pytest.mark.parametrize("model", ["euler", "timoshenko"])
def test_rotor_of_friswell(model):
    """Friswell et al. 2010, Dynamics of Rotating Machines, example 5.9.1, a shaft with two discs at 4,000
    rpm: 85.39, 87.80, 251.78, 294.71 rad/s, and 86.66, 274.31 at rest.
    """
    steel = Material(E=2.11e11, nu=0.2992610837, density=7810.0)
    rod = shaft((1.5, 0.025, 0.025)).segments[0].model_copy(update={"material": steel})
    stiff = np.diag([1e6, 0.0, 1e6, 0.0, 0.0, 0.0])
    bearings = [
        Bearing(name=name, y=y, seat_width=0.002, matrix=stiff, attachment="section")
        for name, y in (("left", 0.001), ("right", 1.499))
    ]
    masses = []
    for name, y, outer in (("small", 0.5, 0.28), ("large", 1.0, 0.35)):
        mass = 7810 * pi / 4 * (outer**2 - 0.05**2) * 0.07
        polar = mass * (outer**2 + 0.05**2) / 8
        flat = polar / 2 + mass * 0.07**2 / 12
        masses.append(
            PointMass(
                name=name,
                mass=mass,
                inertia=(flat, polar, flat),
                y=y,
                seat_width=0.001,
                attachment="section",
            )
        )
    scene = Scene.from_parts([rod], bearings=bearings, masses=masses)
    body = sg.build(scene, model)
    found = sg.modes(body, scene, 12)
    moved = spin_moves(body, as_supports(scene), found.modes, 4000 / 60)
    # 0.1 % of the frequency: a shaft whose bearings stand 1 mm inside its ends, and in an Euler beam
    # shear
    for name, at_rest, backward, forward in (
        ("bending 1", 86.66, 85.39, 87.80),
        ("bending 2", 274.31, 251.78, 294.71),
    ):
        assert 1 + moved[name].down == pytest.approx(backward / at_rest, abs=1e-3)
        assert 1 + moved[name].up == pytest.approx(forward / at_rest, abs=1e-3)


def test_a_rigid_disc_opens_by_its_moments_of_inertia():
    """A disc that only tilts, on a soft tilting spring beside a nearly massless shaft: the whirl of a
    rigid rotor is ``w^2 - (Jp / Jd) Omega w - w0^2 = 0``, to first order w0 +- (Jp / 2 Jd) Omega.
    """
    light = Material(E=2e13, nu=0.3, density=1.0)
    rod = shaft((0.1, 0.02, 0.02)).segments[0].model_copy(update={"material": light})
    tilting = np.diag([1e10, 1e10, 1e10, 1e3, 0.0, 1e3])
    held = Bearing(name="pivot", y=0.05, seat_width=0.01, matrix=tilting, attachment="section")
    disc = PointMass(name="disc", mass=5.0, inertia=(0.01, 0.016, 0.01), on="pivot")
    scene = Scene.from_parts([rod], bearings=[held], masses=[disc])
    assert opening(scene, "bending 1", "timoshenko") == pytest.approx(0.016 / 0.02, rel=1e-3)


@pytest.mark.parametrize("name, g", [("gear_shaft", 0.794), ("pinion_overhung", 0.178)])
def test_shipped_shafts_open_as_another_program_found(name, g):
    """Inner products of an independent code on meshes of triangles, whose frequencies are 0.7 % off."""
    scene = sg.load(GEOMETRY / f"{name}.toml")
    assert opening(scene, "bending 1", "harmonic", **COARSE) == pytest.approx(g, rel=0.015)


def test_every_model_sees_the_same_spin():
    """Waves around a 3D mesh, a beam, and a narrow rigid seat, which takes unknowns of the mesh away,
    against the harmonic solid.
    """
    scene = shaft((0.1, 0.015, 0.015), (0.03, 0.06, 0.06), (0.06, 0.015, 0.015))
    soft = np.diag([1e5, 1e5, 1e5, 0.0, 0.0, 0.0])
    held = [
        scene.with_changes(
            bearings=(
                Bearing(name="A", y=0.02, seat_width=0.004, matrix=soft, attachment=attachment),
            )
        )
        for attachment in ("average", "rigid")
    ]
    exact, tied = (opening(one, "bending 2", "harmonic", **COARSE) for one in held)
    assert exact > 0.1 and tied == pytest.approx(exact, rel=0.03)
    # a beam's disc does not bend, and cells as coarse as these are some per cent off
    assert opening(held[0], "bending 2", "timoshenko") == pytest.approx(exact, rel=0.1)
    assert opening(held[0], "bending 2", "solid", refinement=0.4) == pytest.approx(exact, rel=0.1)


def test_a_thin_ring_opens_as_bryan_says():
    """Bryan 1890: in a ring that turns, n waves lag by 2 / (n^2 + 1) of its turn; seen from outside they
    go round by the rest of it, n (n^2 - 1) / (n^2 + 1) in their n waves, here of a wall of 2 %.
    """
    ring = shaft((0.03, 0.051, 0.051, 0.05, 0.05))
    assert opening(ring, "ovalising n=2 1", "harmonic", order=3) == pytest.approx(6 / 5, rel=0.01)
    assert opening(ring, "ovalising n=3 1", "harmonic", order=3) == pytest.approx(24 / 10, rel=0.01)
    # so coarse cells are far too stiff, and have the other mode of two waves below it
    cells = opening(ring, "ovalising n=2 2", "solid", refinement=0.5)
    assert cells == pytest.approx(6 / 5, rel=0.01)


def test_spin_couples_shapes_of_one_mode_antisymmetrically():
    scene = shaft((0.1, 0.02, 0.02), (0.02, 0.05, 0.05))
    body = sg.build(scene, "timoshenko")
    found = sg.modes(body, scene, 6)
    shapes = [v for m in found.modes if m.frequency_hz > 0 for v in m.vectors]
    coupling = couplings(body, as_supports(scene), shapes)
    assert coupling == pytest.approx(-coupling.T, abs=1e-15) and np.abs(coupling).max() > 0.1


def test_a_pair_whirls_as_the_rigid_rotor_does():
    """w^2 - 2 d w - w0^2 = 0, far beyond first order: a rotor whose opening d is two thirds of w0."""
    moved = whirled(np.array([90.0, 90.0]), np.array([[0.0, 1.0], [-1.0, 0.0]]), turns=60.0)
    assert sorted(moved) == pytest.approx([np.hypot(90, 60) - 60, np.hypot(90, 60) + 60])


def test_a_shape_keeps_the_name_of_its_whirl_where_others_cross_it():
    # the forward whirl of the first pair passes the backward one of the second
    coupling = np.zeros((4, 4))
    coupling[0, 1], coupling[2, 3], coupling[0, 3] = 1.0, 0.2, 0.05
    coupling -= coupling.T
    moved = whirled(np.array([100.0, 100.0, 150.0, 150.0]), coupling, turns=70.0)
    assert sorted(moved[:2]) == pytest.approx([52, 192], rel=0.02)
    assert sorted(moved[2:]) == pytest.approx([136.7, 164.7], rel=0.02)


def test_sections_that_tilt_as_one_stand_for_bodies_without_a_matrix_of_spin():
    """Corrected solids and sectors have none; here of a body that has one: its disc bends by 1 %."""
    scene = shaft((0.1, 0.015, 0.015), (0.03, 0.06, 0.06), (0.06, 0.015, 0.015))
    body = sg.build(scene, "harmonic", **COARSE)
    found = sg.modes(body, scene, 6).modes
    shapes = [
        s for m in found if m.family == "bending" and m.frequency_hz > 0 for s in whole_shapes(m)
    ]
    exact = couplings(body, as_supports(scene), shapes)
    assert _of_sections(body, shapes) == pytest.approx(exact, abs=0.02 * np.abs(exact).max())


def test_a_split_pair_opens_by_the_root_of_both_squares():
    coupling = np.array([[0.0, 0.3], [-0.3, 0.0]])
    by = opened(np.array([100.0, 108.0]), coupling, turns=10.0)
    assert by == pytest.approx([1.0, 1.0])  # 5 = hypot(4, 3)


def test_what_spin_moves_more_than_a_bar_is_told():
    moves = {
        "bending 1": Whirl(-0.05, 0.06, False),
        "bending 2": Whirl(-0.002, 0.002, False),
        "torsion 1": Whirl(0.0, 0.0, False),
    }
    turning = 3000 * 2 * pi / 60
    assert moved_beyond(moves, {"bending 1": 0.07, "bending 2": 0.01}, 0.05, turning) is None
    assert moved_beyond(moves, {"bending 1": 0.01}, 0.05, turning).sentence == (
        "natural frequencies are those at rest; at 3000 rpm spin moves bending 1 by -5 % and +6 %"
    )
    # a narrow bar makes no trifle worth a word
    trifle = {"bending 1": Whirl(-4.8e-7, 4.8e-7, False)}
    assert moved_beyond(trifle, {"bending 1": 1e-9}, 0.05, turning) is None


@pytest.mark.parametrize(("share", "guess"), [(0.1, False), (0.5, True)])
def test_first_order_is_a_guess_where_its_square_is_beyond_the_tolerance(share, guess):
    waves = {"ovalising n=2 1": Whirl(-share, share, True)}
    said = moved_beyond(waves, {}, 0.05, 300.0).sentence
    assert f"{100 * share:.0f} % up and down (first order" in said
    assert ("no more than a guess" in said) == guess


DISC = Path(__file__).parent / "found/spin/disc_at_speed.toml"
#: own harmonic solid with spin, orders 4 and 8: 254.7 and 444.6 Hz, for 348.8 at rest
MOVED = "at 12000 rpm spin moves bending 1 by -27 % and +2"


def test_the_speed_may_be_that_of_bearings_oil_or_cases():
    scene = sg.load(DISC)
    assert MOVED in spin_caution(scene, {"bending 1": 0.01})[0]
    still = scene.with_changes(lubrication=None)
    assert spin_caution(still, {"bending 1": 0.01}) == []
    case = sg.LoadCase(name="run", speed="12000 rpm")
    load = sg.ShaftLoad(name="weight", on="disc", z="-10 N")
    loaded = still.with_changes(loads=[load], cases=[case])
    assert MOVED in spin_caution(loaded, {"bending 1": 0.01})[0]
    # of a compliance nothing is said
    assert spin_caution(scene, {"C_zz": 0.01}) == []


def test_spin_at_thirty_thousand_turns_is_that_of_the_rotor(run):
    """Ring gear on its shaft, harmonic with spin by another program: -46 and +74 % (first order 65)."""
    code, out, _ = run(
        "modes", GEOMETRY / "gear_shaft.toml", "-f", "timoshenko", "--speed", "30000 rpm", "--json"
    )
    said = " ".join(json.loads(out)["cautions"])
    assert code == 0 and "spin moves bending 1 by -47 % and +75 %" in said


def test_spin_of_a_keyed_shaft_is_that_of_its_round_part():
    keyed = sg.load(GEOMETRY / "pinion_keyed.toml")
    names = {"bending z 1": 0.01, "bending x 1": 0.01}
    (said,) = spin_caution(keyed, names, 60_000 * 2 * pi / 60)
    (plain,) = spin_caution(keyed.plain, {"bending 1": 0.01}, 60_000 * 2 * pi / 60)
    assert "bending z 1 by -6.5 % and +6.4 %, " in said and "round part" in said
    assert "bending 1 by -6.5 % and +6.4 %" in plain


def test_a_body_without_an_axis_takes_no_speed(run):
    block = Path(__file__).parent / "found/parts/clamped_foot.toml"
    code, _, err = run("modes", block, "--speed", "100 rpm")
    assert code != 0 and "clamped_foot has no axis that it could turn about" in err


def test_a_check_says_that_frequencies_are_those_at_rest():
    assert any(MOVED in text for text in sg.check(DISC).cautions)


@pytest.mark.parametrize(
    "command",
    [
        ("answer",),
        ("sensitivities", "-f", "timoshenko", "--by", "material.E"),
        ("sweep", "-f", "timoshenko", "--vary", "segment.shaft.length=200 mm,210 mm"),
        ("sweep", "-f", "timoshenko", "--vary", "bearing.front.scale=0.5,1"),
        ("optimise", "-f", "timoshenko", "--vary", "segment.shaft.diameter=39 mm,40 mm")
        + ("--goal", "max bending 1"),
        ("sheet", "--language", "de"),
    ],
    ids=lambda words: " ".join(words[:1] + words[-1:]),
)
def test_every_command_says_that_frequencies_are_those_at_rest(command, run, tmp_path):
    out = {"sweep": tmp_path / "rows.csv", "sheet": tmp_path / "sheet.html"}.get(command[0])
    written = ("--json",) if out is None else ("--out", out)
    code, shown, err = run(command[0], DISC, *command[1:], *written)
    said = " ".join((shown + err).split())
    assert code == 0
    german = "bei 12000 /min verschiebt die Drehung"
    assert said.count(german if command[0] == "sheet" else MOVED) == 1


def test_a_train_tells_spin_at_its_fastest_operating_point():
    """Its ring gear turns 45/14 times slower than the pinion, whose speed it is."""
    train = sg.load_train(GEOMETRY / "axle_overhung.toml")
    point = sg.load_train(GEOMETRY / "gearbox_train.toml").operation[0]
    point = point.with_changes(of="pinion", share=None)
    # its bearings part the pair by more than 8,000 rpm do: 1.3 %, within the tolerance of 2 %
    slow, fast = (
        train_modes(
            Assembly(train.with_changes(operation=[point.with_changes(speed=speed)])),
            "timoshenko",
            "timoshenko",
            max_frequency=900.0,
        ).cautions
        for speed in ("8000 rpm", "20000 rpm")
    )
    assert not any("spin" in text for text in slow)
    (said,) = (text for text in fast if "spin" in text)
    assert "at 20000 rpm of the pinion spin moves gear bending 1 by" in said
