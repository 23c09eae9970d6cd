"""Notches on the seats of loads, notches that meet, and what has no rating beside a worst safety."""

import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import solidgear as sg
from solidgear.strength.stress.arc_stress import ArcStress
from solidgear.strength.stress.at_rest import ShaftLoads, StressedShaft, lesser_elsewhere
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.drawn import drawn_stresses
from solidgear.strength.stress.nominal import CrossSection
from solidgear.strength.stress.notch import Factor
from solidgear.strength.stress.notch_tables import headline
from solidgear.strength.stress.rating import Rating
from solidgear.strength.stress.section_forces import Load, forces_of, section_forces, sections_along
from solidgear.strength.stress.shaft import shaft_stress, worst_load
from solidgear.variants.optimise.sentences import _not_rated
from solidgear.variants.sweep.shaft_numbers import numbers_of

FOUND = Path(__file__).parent / "found" / "design"


def tables(name, *features, **changes):
    """Tables of a file with further features, those of its own changed by name, without fillets,
    which cost a solid each.
    """
    out = tomllib.loads((FOUND / f"{name}.toml").read_text("utf-8"))
    own = [f for f in out["feature"] if f["kind"] != "fillet"]
    out["feature"] = [f | changes.get(f["name"], {}) for f in own] + [*features]
    return out


def forces_on(scene):
    """Section forces of a shaft of these files, by statics: two bearings 270 mm apart, a load halfway."""
    load, out = scene.loads
    loads = {"p": load.six(), "out": out.six()}
    loads["A"] = np.array([-load.x / 2, -load.y, 0, 0, 0, 0])
    loads["B"] = np.array([-load.x / 2, 0, 0, 0, 0, 0])
    return forces_of(scene, loads)


def drawn(source, **conditions):
    """Features by name with their stress, on a rough surface."""
    scene = sg.load(source)
    rough = Conditions(roughness="16 um", **conditions)
    return {notch.name: notch for notch in drawn_stresses(scene, forces_on(scene), rough)[0]}


def stressed(source):
    """Stress of the features, without the solids of grooves, as the command has it."""
    scene = sg.load(source)
    stress = shaft_stress(
        scene, {load.name: load.six for load in forces_on(scene).loads}, conditions=Conditions()
    )
    shaft = StressedShaft("shaft", scene, ShaftLoads({}), stress, None, {})
    return SimpleNamespace(shafts=(shaft,), open_by="")


# ------------------------------------------------------------------- loads enter over their seats
def test_notches_apart_from_seats_and_each_other_are_as_by_hand():
    """DIN 743 by hand, with factors, sizes and section forces of each alone."""
    safeties = {name: notch.rating.fatigue for name, notch in drawn(tables("notches")).items()}
    by_hand = {"key": 5.96, "ring": 6.64, "fit": 6.66}
    assert safeties == pytest.approx(by_hand, abs=0.005)


def test_a_key_that_ends_in_its_hub_takes_all_of_the_torque():
    """1200 N m enter over 20 mm of seat, 8 of them on the key; what differs from the key that passes
    the middle of the seat is the moment 2 mm aside, 1.5 % of it.
    """
    short = drawn(tables("key_ends_in_hub"), torque_share=1)["key"]
    passing = drawn(tables("key_ends_in_hub", key={"position": "12 mm"}), torque_share=1)["key"]
    assert abs(short.forces[4]) == pytest.approx(1200.0)
    assert short.rating.fatigue == pytest.approx(3.03, rel=0.01)
    assert short.rating.fatigue == pytest.approx(passing.rating.fatigue, rel=0.01)
    # one that ends before the seat has no torque
    before = drawn(tables("key_ends_in_hub", key={"length": "31 mm"}), torque_share=1)["key"]
    assert before.forces[4] == 0 and before.rating.fatigue > 10


@pytest.mark.parametrize("kind", ["press_fit", "ring_groove"])
def test_fits_and_grooves_on_the_light_half_of_a_seat_see_the_load(kind):
    fit = {"length": "4 mm", "hub_diameter": "90 mm", "interference": "20 um"}
    groove = {"width": "2 mm", "depth": "1.5 mm", "radius": "0.2 mm"}
    more = {"press_fit": fit, "ring_groove": groove}[kind]
    lies = {"kind": kind, "name": "it", "segment": "b", "position": "42 mm", **more}
    source = tables("key_ends_in_hub", lies)
    source["feature"] = [f for f in source["feature"] if f["name"] == "it"]
    notch = drawn(source, torque_share=1)["it"]
    assert abs(notch.forces[4]) == pytest.approx(1200.0)


def test_section_forces_on_a_seat_are_those_of_both_sides_and_balance():
    """Forces, torque and couple of a load jump anywhere on its seat; the moment of its force does
    not, and outside of the seat all is as by statics.
    """
    six = np.array([0, 500.0, -3e3, 40.0, 100.0, 0])
    load = Load("gear", 0.05, six, seat=(0.03, 0.07))
    ends = [Load("A", 0.0, [0, 0, 1500, 0, 0, 0]), Load("B", 0.1, [0, -500, 1500, -40, -100, 0])]
    forces = section_forces([load, *ends], 0.1)
    (alone, across) = (
        cut.of(forces) for cut in sections_along((0.04, 0.04), [forces]) if cut.beyond
    )
    assert alone == pytest.approx([0, 0, -1500, 60, 0, 0])
    assert across - alone == pytest.approx(-six)
    aside = [cut.of(forces) for cut in sections_along((0.01, 0.02), [forces])]
    assert len(aside) == 2 and all(each[4] == 0 for each in aside)


@pytest.mark.parametrize(("seat", "torque"), [((0.09, 0.15), 100.0), ((0.1, 0.15), 0.0)])
def test_a_seat_over_a_step_of_the_bore_loads_its_fillet(seat, torque):
    """A seat that ends at the step is on one side of it."""
    ones = np.ones(3)
    profile = ArcStress(ones, ones, ones, ones, ones, np.ones((2, 3)))
    fillet = SimpleNamespace(
        reference=0.098,
        corner=SimpleNamespace(y=0.1),
        section=CrossSection(0.02, 0.01),
        radius=0.01,
        factors=dict.fromkeys(("tension", "bending", "torsion", "shear"), Factor(2, 0, 0, 1, 0)),
        profiles=dict.fromkeys(("tension", "bending", "torsion", "shear"), profile),
    )
    six = np.array([0, 0, 0, 0, 100.0, 0])
    loads = [Load("hub", 0.12, six, seat=seat), Load("end", 0.3, -six)]
    assert abs(worst_load(fillet, section_forces(loads, 0.3))[4]) == torque


# ------------------------------------------------------------------------------- notches that meet
def test_a_hole_in_a_press_fit_is_rated_with_both():
    both = drawn(tables("hole_in_press_fit"))
    alone = {}
    for name in both:
        source = tables("hole_in_press_fit")
        source["feature"] = [f for f in source["feature"] if f["name"] == name]
        alone |= drawn(source)
    assert 4.1 < both["hole"].rating.fatigue < 4.7
    for name, other in (("hole", "fit"), ("fit", "hole")):
        for load in ("bending", "torsion"):
            excess = sum(alone[n].factors[load] - 1 for n in both)
            assert both[name].factors[load] == pytest.approx(1 + excess, rel=1e-12)
        assert f'"{other}"' in both[name].remark
        assert both[name].rating.fatigue < alone[name].rating.fatigue


GROOVE = {
    "kind": "ring_groove",
    "name": "groove",
    "position": "40 mm",
    "width": "2 mm",
    "depth": "1.5 mm",
    "radius": "0.2 mm",
}
HOLE = {"kind": "cross_hole", "name": "hole", "position": "41 mm", "diameter": "4 mm"}
THREAD = {"kind": "thread", "name": "thread", "size": "M40x1.5", "position": "25 mm"}


@pytest.mark.parametrize(
    ("segment", "first", "second"),
    [
        pytest.param("b", GROOVE, "key", id="groove in a keyway"),
        pytest.param("c", GROOVE, "fit", id="groove in a fit"),
        pytest.param("c", {**THREAD, "length": "20 mm"}, "fit", id="thread in a fit"),
        pytest.param("b", HOLE, "key", id="hole in a keyway"),
        pytest.param("a", {**HOLE, "position": "60.9 mm"}, "ring", id="hole in a groove"),
    ],
)
def test_any_two_that_overlap_are_worse_than_each(segment, first, second):
    both = drawn(tables("notches", first | {"segment": segment}))
    alone = drawn(tables("notches"))
    lone = tables("notches", first | {"segment": segment})
    lone["feature"] = [f for f in lone["feature"] if f["name"] == first["name"]]
    alone |= drawn(lone)
    for name in (first["name"], second):
        notch, other = both[name], second if name != second else first["name"]
        excess = [alone[n].factors["bending"] - 1 for n in (name, other)]
        if f'"{other}"' in notch.remark:
            assert notch.factors["bending"] == pytest.approx(1 + sum(excess), rel=1e-9)
    assert f'"{second}"' in both[first["name"]].remark
    assert both[first["name"]].rating.fatigue < alone[first["name"]].rating.fatigue


def test_notches_of_one_section_that_do_not_touch_do_not_meet():
    """A hole a quarter turn from a keyway, and a notch that ends where another begins."""
    aside = HOLE | {"segment": "b", "angle": "90 deg"}
    beside = GROOVE | {"segment": "c", "position": "50 mm"}
    both, alone = drawn(tables("notches", aside, beside)), drawn(tables("notches"))
    assert not any("meets" in both[name].remark for name in ("key", "hole", "fit", "groove"))
    for name in ("key", "fit"):
        assert both[name].rating.fatigue == alone[name].rating.fatigue


def test_a_notch_without_a_factor_that_meets_another_is_named():
    flat = {"kind": "flat", "name": "flat", "segment": "c", "position": "25 mm"}
    source = tables("notches", flat | {"length": "20 mm", "depth": "2 mm"})
    assert 'meets the flat "flat", which has no factor' in drawn(source)["fit"].remark


# ------------------------------------------------------- the worst of every kind, and the unrated
def rated(fatigue, yielding, name):
    rating = Rating((), fatigue, yielding, None, 0.0, (), None, None)
    return SimpleNamespace(name=name, rating=rating)


def test_a_lesser_safety_of_another_kind_is_found_with_its_place():
    tired, weak = rated(2.0, 3.0, "step"), rated(2.5, 1.4, "groove")
    shaft = SimpleNamespace(name="s", found=SimpleNamespace(worst=(tired, weak)))
    ((kind, least),) = lesser_elsewhere([shaft], tired.rating)
    assert (kind, least.value, least.notch.name) == ("yielding", 1.4, "groove")


def test_the_headline_names_the_least_against_fatigue_and_where_another_yields_first():
    """Torque on one side, a deeper groove on the other: the groove tires, the fit yields."""
    source = tables("notches", ring={"depth": "3 mm"})
    for load in source["load"]:
        load["torque"] = f"{'-' if load['name'] == 'out' else ''}900 N*m"
    result = stressed(source)
    ratings = {notch.name: notch.rating for notch in result.shafts[0].found.worst}
    assert min(ratings, key=lambda n: ratings[n].fatigue) == [*ratings][0] == "ring"
    assert min(ratings, key=lambda n: ratings[n].yielding) == "fit"
    words = headline(result)
    assert 'Worst of 3 notches at ring groove "ring": ' in words
    assert f'; least against yielding {ratings["fit"].yielding:.2f} at press fit "fit".' in words


def test_sharp_corners_are_named_beside_the_worst_safety():
    source = tables("notches")
    names = "sharp corners at y = 100.00 mm, 200.00 mm"
    assert f"Not rated: {names}." in headline(stressed(source))
    source["feature"] = [f for f in source["feature"] if f["name"] == "key"]
    row = numbers_of(sg.load(source), ["stress"], "euler", None)
    assert row["not_rated"] == names
    wish = SimpleNamespace(name="fatigue safety")
    optimum = SimpleNamespace(goals=[wish], keep=[])
    (sentence,) = _not_rated(optimum, [SimpleNamespace(rows=[row])])
    assert row["not_rated"] in sentence
    assert not [*_not_rated(SimpleNamespace(goals=[], keep=[]), [SimpleNamespace(rows=[row])])]
