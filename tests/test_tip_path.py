"""Tips in the spaces of their mates, against whole wheels that turn; and what a train says of them."""

from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest
from matplotlib import path as polygons

import solidgear as sg
from solidgear.core.errors import SceneError
from solidgear.core.gears.tip_path import cut_depth, largest_tip
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.train_teeth import teeth_of

GEOMETRY = Path(__file__).parent.parent / "geometry"
PLAIN = {"pitch_radius": None, "spiral_angle": None, "pitch_angle": None, "scene_load": "added"}


def outline(wheel):
    """All teeth of a wheel, tooth by tooth, as one polygon."""
    right = np.vstack(
        [wheel.fillet(150), wheel.flank_points(np.linspace(wheel.form, wheel.tip, 150))[0][1:]]
    )
    tooth = np.vstack([right * [-1, 1], right[::-1]])
    turns = np.arange(wheel.count) * wheel.pitch_angle
    points = [tooth @ np.array([[cos(t), -sin(t)], [sin(t), cos(t)]]) for t in turns]
    return np.vstack(points)


def touches(pair, k):
    """True where a corner of the tips lies in the other wheel's teeth at some of 1,500 positions of both
    wheels turning; flanks that touch are taken 1 um apart.
    """
    wheels, sign = (pair.first, pair.second), pair.second.sign
    working = [wheel.base / cos(pair.working_angle) for wheel in wheels]
    halves = [float(wheel.half_angle(radius)) for wheel, radius in zip(wheels, working)]
    turn = np.linspace(-1.5, 1.5, 1500) * pair.first.pitch_angle
    # clockwise angles of tooth 0 of each, a second external wheel upside down: in the pitch point right
    # flanks touch, of a ring the left one, which turns with the planet
    turns = (
        turn - halves[0] - 1e-6 / working[0],
        -sign * (halves[1] + turn * working[0] / working[1]),
    )
    upright = (1.0, -float(sign))
    tips, mate = wheels[k], wheels[1 - k]
    aside = float(tips.half_angle(tips.tip)) * (-1 if (k == 1 and sign < 0) else 1)
    angle, between = turns[k] + aside, (1 - 2 * k) * sign * pair.distance
    x = upright[k] * tips.tip * np.sin(angle)
    y = upright[k] * tips.tip * np.cos(angle) - between
    r = np.hypot(x, y)
    phi = np.arctan2(upright[1 - k] * x, upright[1 - k] * y) - turns[1 - k]
    places = np.column_stack([r * np.sin(phi), r * np.cos(phi)])
    inside = polygons.Path(outline(mate)).contains_points(places)
    return bool((inside if mate.sign > 0 else ~inside).any())


PAIRS = {
    "usual": (Wheel(20, 3e-3), Wheel(57, 3e-3), 1),
    "undercut": (Wheel(9, 3e-3), Wheel(57, 3e-3), 1),
    "lifted": (Wheel(12, 3e-3, shift=1.05), Wheel(40, 3e-3), 1),
    "stub rack": (Wheel(24, 2e-3, rack=Rack(dedendum=1.1, root_radius=0.1)), Wheel(60, 2e-3), 1),
    "ring": (Wheel(34, 2e-3), Wheel(-85, 2e-3), 1),
    "narrow ring": (Wheel(34, 2e-3), Wheel(-42, 2e-3), 1),
    "planet": (Wheel(34, 2e-3), Wheel(-85, 2e-3), 0),
}


@pytest.mark.parametrize("name", PAIRS)
def test_the_largest_tip_is_where_turning_wheels_begin_to_cut(name):
    """Within 60 um of the tip radius; flanks are a micrometre apart."""
    first, second, k = PAIRS[name]
    pair = WheelPair(first, second)
    wheel = (first, second)[k]
    longer = pair_with(pair, k, wheel.tip + wheel.sign * 0.6 * wheel.module)
    most = largest_tip(longer, k)
    for off, cuts in ((-60e-6, False), (60e-6, True)):
        there = pair_with(pair, k, most + wheel.sign * off)
        assert touches(there, k) is cuts
        assert (cut_depth(there, k) > 0.3e-6) is cuts


def pair_with(pair, k, tip):
    wheels = [pair.first, pair.second]
    wheels[k] = replace(wheels[k], tip_radius=tip)
    return WheelPair(*wheels)


def test_a_tip_that_ends_at_the_root_cuts_as_deep_as_it_reaches_below():
    """Tips of 20 teeth 0.3 mm below the roots of 57: on the line of centres by as much at least."""
    pair = WheelPair(Wheel(20, 3e-3, tip_radius=34.05e-3), Wheel(57, 3e-3))
    assert pair.clearances[0] == pytest.approx(-0.3e-3, rel=1e-9)
    assert cut_depth(pair, 0) > 0.3e-3
    assert cut_depth(pair, 1) == 0.0


@pytest.fixture(scope="module")
def gearbox():
    return sg.load_train(GEOMETRY / "gearbox_train.toml").with_changes(operation=())


def spur(train, pinion=None, gear=None, **mesh):
    """20 and 57 straight teeth of 3 mm module, with other numbers."""
    plain = PLAIN | {"hand": None}
    first = plain | {"module": 3e-3, "helix_angle": 0.0} | (pinion or {})
    return train.with_changes(
        pinion=train.pinion.with_changes(**first),
        gear=train.gear.with_changes(**plain, **(gear or {})),
        mesh=train.mesh.with_changes(**mesh),
    )


LONG = {"addendum": 1.2, "dedendum": 1.25}


@pytest.mark.parametrize(
    ("pinion", "gear", "mesh", "field", "words"),
    [
        (None, {"tip_diameter": 178.3e-3}, {}, "tip_diameter", r"puts tips at 178\.3 mm across"),
        (None, {"rack": LONG}, {}, "rack", r"87\.7 um deep into the teeth of the pinion"),
        (
            {"profile_shift": 1.0},
            {"profile_shift": 1.0},
            {"stiffness": "teeth"},
            "tip_diameter",
            "is missing, and by default puts tips at 72 mm across",
        ),
    ],
)
def test_tips_that_cut_are_refused_with_the_largest_that_fit(
    gearbox, pinion, gear, mesh, field, words
):
    with pytest.raises(SceneError, match=words) as error:
        spur(gearbox, pinion, gear, **mesh)
    problem = error.value.problems[0]
    assert problem.path[1] == field
    most = float(str(problem).partition("at most ")[2].partition(" mm")[0]) * 1e-3
    side = problem.path[0]
    fitting = {"tip_diameter": most, "rack": None}
    tables = {"pinion": pinion or {}, "gear": gear or {}}
    if pinion:  # both wheels are alike in what is wrong
        tables = {key: table | {"tip_diameter": None} for key, table in tables.items()}
        with pytest.raises(SceneError) as error:
            spur(gearbox, tables["pinion"] | fitting, tables["gear"], **mesh)
        other = str(error.value).partition("at most ")[2].partition(" mm")[0]
        tables["gear"] = tables["gear"] | {"tip_diameter": float(other) * 1e-3}
    tables[side] = tables[side] | fitting
    spur(gearbox, tables["pinion"], tables["gear"], **mesh)


def test_assumed_tips_that_cut_are_refused_where_teeth_are_solved_alone(gearbox):
    train = spur(gearbox, {"profile_shift": 1.0}, {"profile_shift": 1.0})
    with pytest.raises(SceneError, match="by default puts tips at 72 mm") as error:
        teeth_of(train.pairs[0], coast=False)
    assert error.value.path == (*train.pairs[0].paths["pinion"], "tip_diameter")


def test_teeth_that_end_in_a_point_are_refused(gearbox):
    """Of 12 teeth with a shift of 1.4, whose flanks meet where inv alpha has grown by the thickness."""
    with pytest.raises(SceneError, match="end, 48.607 mm across") as error:
        spur(gearbox, {"teeth": 12, "profile_shift": 1.4})
    assert error.value.problems[0].path == ("pinion", "profile_shift")
    wheel = Wheel(12, 3e-3, shift=1.4)
    assert wheel.point * cos(pi / 9) < wheel.tip
    angle = np.arccos(wheel.base / 24.3035e-3)
    grown = np.tan(angle) - angle - (np.tan(pi / 9) - pi / 9)
    assert grown == pytest.approx(wheel.thickness / (2 * wheel.radius), rel=1e-4)


def test_planets_say_whose_tips_cut():
    train = sg.load_train(GEOMETRY / "reducer.toml")
    (stage,) = train.stages

    def with_table(**changes):
        table = stage.table.with_changes(**changes)
        return train.with_changes(planetary={stage.called: table})

    planet = stage.table.planet.with_changes(tip_diameter="46 mm")
    with pytest.raises(SceneError, match="into the teeth of the sun; a tip_diameter of at most"):
        with_table(planet=planet)
    wheel = train.shafts["wheel"]
    sun = wheel.gears["sun"].with_changes(tip_diameter="25 mm")
    with pytest.raises(SceneError, match="beyond the point") as error:
        shaft = wheel.with_changes(gears={**wheel.gears, "sun": sun})
        train.with_changes(shafts={**train.shafts, "wheel": shaft})
    assert error.value.problems[0].path == ("shaft", "wheel", "gears", "sun", "tip_diameter")
    ring = {"tip_diameter": "103.5 mm"}
    with pytest.raises(SceneError, match="of the planets; a tip_diameter of at least") as error:
        with_table(ring_flanks=ring)
    assert error.value.problems[0].path[2:] == ("ring_flanks", "tip_diameter")
