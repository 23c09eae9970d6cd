"""The cheapest answer with a bar: whether the bar holds, what it costs, and what is passed over."""

import dataclasses
import json
import subprocess
import sys
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import solidgear as sg
from solidgear.body import as_supports
from solidgear.cli.answer import _absent, sentences
from solidgear.evidence.answer import Numbers, solve
from solidgear.evidence.quantities import change
from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.levels import HARMONIC, PAIRS, Sequence
from solidgear.fidelity.rung import STEPPED
from solidgear.scene import Bearing, BoltCircle
from solidgear.studies import climb as climbing
from solidgear.studies.answering import answer
from solidgear.studies.climb import Climb

ROOT = Path(__file__).parent.parent
SCENES = ["pinion_overhung", "shaft_stepped", "shaft_hollow", "pinion_straddle"]
ALL = ("C_zz", "C_z,thx", "C_thx", "C_yy", "K_zz", "bending 1", "bending 2", "axial 1")


@pytest.fixture(scope="module")
def scenes():
    return {name: sg.load(ROOT / "geometry" / f"{name}.toml") for name in SCENES}


@pytest.fixture(scope="module")
def truth(scenes):
    """A mesh or two above what a tolerance of 1e-3 takes: measured within 4e-5 of the next one."""

    @cache
    def found(name):
        return solve(scenes[name], "harmonic", 12, **HARMONIC[3]).quantities

    return found


#: a rung that is solved on ever finer meshes, not on pairs of orders
MESHES = dataclasses.replace(
    LADDER["harmonic"], meshes=lambda options: Sequence(HARMONIC, False, True)
)
#: an overhung head and a plain shaft; the others differ in their seats and bores
FEW = [
    SCENES[0],
    pytest.param(SCENES[1], marks=pytest.mark.long),
    *(pytest.param(n, marks=pytest.mark.slow) for n in SCENES[2:]),
]


@pytest.mark.parametrize("tol", [0.1, 0.01, 1e-3])
@pytest.mark.parametrize("name", FEW)
def test_the_truth_is_within_the_bar_and_the_bar_within_the_tolerance(scenes, truth, name, tol):
    found = answer(scenes[name], tol, ALL)
    assert found.reached and found.rung == "harmonic"
    values = {v.quantity: v.value for v in found.values}
    assert set(values) == {q for q in ALL if q in truth(name)}
    for row in found.values:
        assert row.bar <= tol
        # the reference is a mesh too: a twentieth of the tightest tolerance
        assert abs(change(values, truth(name), row.quantity)) <= row.bar + 5e-5


@pytest.mark.parametrize("name", FEW)
def test_a_bar_with_one_sign_points_to_the_truth(scenes, truth, name):
    found = answer(scenes[name], tol=1e-2, ask=ALL)
    sides = {v.quantity: v.side for v in found.values}
    assert sides["C_zz"] == "above" and sides["K_zz"] == sides["bending 1"] == "below"
    assert sides["C_z,thx"] == "both"  # a coupling may err either way
    for v in found.values:
        # The truth is a finer mesh of the same solid, which is too stiff as well, but by less.
        beyond = (truth(name)[v.quantity] - v.value) / v.size
        assert v.side == "both" or (beyond > 0) == (v.side == "above"), v


def test_bars_of_solids_whose_geometry_is_not_exact_have_two_sides(scenes):
    filleted = sg.load(ROOT / "geometry" / "pinion_filleted.toml")
    assert {v.side for v in answer(filleted, tol=5e-2, ask="C_zz").values} == {"both"}
    assert not any(LADDER[n].from_above for n in LADDER.of("solid") if n != "harmonic")


def test_a_looser_tolerance_costs_less(scenes):
    costs = [
        sum(s.unknowns for s in answer(scenes["shaft_stepped"], tol, "C_thx").steps if s.valid)
        for tol in (0.1, 1e-3, 1e-4)
    ]
    assert costs[0] < costs[1] < costs[2]


def test_only_what_is_asked_is_built_and_the_numbers_are_the_same(scenes):
    scene = scenes["pinion_overhung"]
    part = answer(scene, 1e-2, ["bending 1", "C_zz"])
    mesh = part.steps[-1].options
    body = sg.build(scene, "harmonic", **mesh)
    # three of four blocks' unknowns are bending's, in two planes
    assert part.steps[-1].unknowns < 0.8 * body.size
    full = solve(scene, "harmonic", **mesh).quantities
    # the bearings of this scene couple planes by 1e-8 of their stiffness, left out at this tolerance
    assert part["C_zz"] == pytest.approx(full["C_zz"], rel=1e-7)
    assert part["bending 1"] == pytest.approx(full["bending 1"], rel=1e-7)


def test_from_the_second_pair_on_only_what_is_open_is_solved(scenes):
    scene = scenes["pinion_overhung"]
    found = answer(scene, 1e-3, ["C_thx", "bending 1", "axial 1"])
    steps = [s for s in found.steps if s.valid]
    # without layers it is enough for axial 1, with one for bending 1: the shoulder disturbs them less
    rest = ("C_thx", "bending 1")
    assert [s.only for s in steps] == [(), (), rest, rest, ("C_thx",), ("C_thx",)]
    assert [s.options["order"] for s in steps] == [2, 3, 2, 3, 3, 4]
    # bending is two of the four blocks, and three of five of the unknowns
    assert steps[-1].unknowns < 0.8 * sg.build(scene, "harmonic", **steps[-1].options).size
    own = {"axial 1": 1, "bending 1": 3, "C_thx": 5}
    for v in found.values:
        whole = solve(scene, "harmonic", **steps[own[v.quantity]].options).quantities
        assert v.bar <= 1e-3 and v.meshes == 2
        assert abs(change({**whole, v.quantity: v.value}, whole, v.quantity)) < 1e-7


def test_what_a_finer_mesh_finds_less_sure_again_is_solved_on(scenes):
    climb = Climb(scenes["shaft_stepped"], MESHES, ("C_zz", "K_zz"), 1e-3, lambda _: None)
    left = {"C_zz": 0.0, "K_zz": 0.0}

    def level(c, k):
        climb.levels.append(Numbers({"C_zz": c, "K_zz": k}, left))
        climb.judge()
        return [q for _, names in climb._questions() for q in names]

    level(1.0, 1.1)
    assert level(1.0, 1.0) == ["K_zz"]  # C_zz has not moved
    # C_zz comes with K_zz, and moves after all
    assert level(1.1, 1.0) == ["C_zz"]


def test_bearings_that_couple_families_keep_them_together(scenes):
    scene = scenes["shaft_stepped"]
    stiffness = {"kxx": 4e8, "kyy": 3e8, "kzz": 4e8, "kyz": 2e8}
    first = scene.bearings[0]
    tilted = Bearing(name=first.name, y=first.y, seat_width=first.seat_width, stiffness=stiffness)
    coupled = scene.with_changes(bearings=(tilted, *scene.bearings[1:]))
    found = answer(coupled, 0.01, "C_zz")
    full = solve(coupled, "harmonic", **found.steps[-1].options).quantities
    assert found["C_zz"] == pytest.approx(full["C_zz"], rel=1e-9)  # the same system: rounding
    # and the coupling is no trifle: measured 4 %
    alone = sg.condense(
        sg.build(coupled, "harmonic", **HARMONIC[1]),
        as_supports(coupled).on((0, 2, 3, 5)),
        coupled.port.name,
    )
    assert abs(alone.compliance[2, 2] / full["C_zz"] - 1) > 0.01


def test_springs_on_motions_that_a_body_lacks_are_refused(scenes):
    # it would be rigid there: C_yy came out 7 % too small without a word
    scene = scenes["pinion_overhung"]
    body = sg.build(scene, "harmonic", order=2, layers=0, families=("bending",))
    with pytest.raises(sg.SolidgearError, match="without the motions y, which bearings hold"):
        sg.condense(body, scene, "pinion")
    with pytest.raises(sg.SolidgearError, match="without the motions y"):
        sg.modes(body, scene, 4)
    bending = as_supports(scene).on((0, 2, 3, 5))
    assert sg.condense(body, bending, "pinion").compliance[2, 2] > 0


def test_beams_are_passed_over_with_the_reason(scenes):
    found = answer(scenes["shaft_stepped"], 0.1, "bending")
    passed = {s.rung: s.why for s in found.steps if not s.valid}
    assert set(passed) == set(LADDER.of("beam"))
    assert all("no error of their own" in why for why in passed.values())
    assert sum(s.chosen for s in found.steps) == 1


def test_past_the_finest_mesh_the_best_is_given_and_not_called_reached(scenes, two_meshes):
    found = answer(scenes["pinion_overhung"], 1e-5, "C_zz")
    assert not found.reached and found.bar > 1e-5
    assert "no finer mesh" in found.steps[-1].why and found.steps[-1].chosen


@pytest.mark.parametrize("built", [2, 3], ids=["a whole pair", "and the lower order of the next"])
def test_the_lower_order_of_a_pair_alone_is_no_answer(scenes, builds_until, built):
    """A finer mesh that fails leaves the answer of the pair before it."""
    calls = builds_until(built)
    scene = scenes["pinion_overhung"]
    found = answer(scene, 1e-5, "C_thx")
    assert not found.reached and "3000 MB are free" in found.steps[-1].why
    assert len(calls) == built + 1
    pair = [{k: v for k, v in own.items() if k != "families"} for own in calls[:2]]
    lower, higher = (solve(scene, "harmonic", **own).quantities["C_thx"] for own in pair)
    # the other families, which couple to bending by 1e-8 of the stiffness of bearings, are left out
    assert found["C_thx"] == pytest.approx(higher, rel=1e-7)
    # and the bar is that of this pair: 1e-7 of the values is 1e-3 of the step between them
    (place,) = (k for k, known in enumerate(PAIRS) if known[1]["layers"] == pair[1]["layers"])
    share = LADDER["harmonic"].factors.same_mesh[STEPPED][place]
    assert found.bar == pytest.approx(share * (higher / lower - 1), rel=1e-3)


def test_a_rung_that_cannot_be_built_is_passed_over(scenes, monkeypatch):
    real = climbing.build

    def build(scene, rung, **options):
        if rung == "harmonic":
            raise sg.SolidgearError("a keyway is no body of revolution")
        return real(scene, rung, **options)

    monkeypatch.setattr(climbing, "build", build)
    found = answer(scenes["shaft_stepped"], 0.3, "C_zz")
    assert found.rung == "solid"
    assert any(s.rung == "harmonic" and "keyway" in s.why for s in found.steps)


def test_a_frequency_that_rises_is_rounding_and_widens_the_bar(scenes):
    climb = Climb(scenes["shaft_stepped"], MESHES, ("bending 1",), 1e-6, lambda _: None)
    known = {"bending 1": 1e-12}
    for value in (101.0, 100.0, 100.1):
        climb.levels.append(Numbers({"bending 1": value}, known))
    climb.judge()
    assert climb.bar("bending 1") >= 2 * 1e-3 * 0.99  # twice a rise of 0.1 %
    climb.levels[-1] = Numbers({"bending 1": 99.999}, known)
    climb.judge()
    assert climb.bar("bending 1") < 1e-3


def test_a_climb_ends_where_no_mesh_makes_bars_narrow_enough():
    """Meshes of a corrected solid that agree to 1e-5 on a feature that takes 3 % of C_zz: its bar
    holds a fifth of that after two meshes and a quarter of a fifth after the fourth, which is the last.
    """
    scene = sg.load(ROOT / "geometry" / "pinion_keyed.toml")
    body = sg.build(scene.plain, "harmonic", order=3, layers=1, edge_layers=0)
    plain = sg.condense(body, scene.plain, "pinion").compliance
    c_zz, c_yy = 1.03 * plain[2, 2], 1.0001 * plain[1, 1]

    def climb(tol):
        made = Climb(scene, LADDER["corrected"], ("C_zz", "C_yy"), tol, lambda _: None)
        for off in (1e-5, 0.0):
            made.levels.append(Numbers({"C_zz": c_zz * (1 + off), "C_yy": c_yy * (1 + off)}, {}))
            made.sizes.append(None)
        made.judge()
        return made

    stuck = climb(1e-3)
    # the effect is 0.03 / 1.03, by a plain part good to 1e-4
    assert stuck.floors()["C_zz"] == pytest.approx(0.2 * 0.5**2 * 0.03 / 1.03, rel=0.02)
    assert "sure of a quantity to a share of what features change" in stuck._in_vain()
    assert "of C_zz at best" in stuck._in_vain()
    assert not climb(2e-3)._in_vain()
    # something else is open that a finer mesh will narrow: for that alone it is solved
    stuck.levels[0] = Numbers({"C_zz": c_zz, "C_yy": c_yy * 1.01}, {})
    stuck.judge()
    assert not stuck._in_vain()
    assert [q for _, names in stuck._questions() for q in names] == ["C_yy"]


def test_what_heavy_meshes_cost_is_told_before_they_are_made():
    """Holes of 0.5 mm through 60 mm; those of 12 mm are no matter."""
    from solidgear.studies.effort import heavy_meshes

    def told(diameter):
        rim = sg.Segment.cylinder("rim", length=0.06, diameter=0.05)
        holes = BoltCircle(name="b", segment="rim", count=6, diameter=diameter, circle=0.036)
        scene = sg.Scene.from_parts([rim], features=[holes])
        return list(heavy_meshes(scene, LADDER["sector"]))

    (sentence,) = told(0.0005)
    assert (
        "its coarsest mesh takes about" in sentence and "without which there is no bar" in sentence
    )
    assert "unknowns" in sentence and "GB" in sentence and "min" in sentence
    assert not told(0.012)


@pytest.mark.parametrize("tol", [0, -1e-3, 1.5, float("nan"), "x", True])
def test_a_tolerance_that_is_none_is_refused(scenes, tol):
    with pytest.raises(sg.SolidgearError, match="give a number above 0 and at most 1"):
        answer(scenes["shaft_stepped"], tol)


def test_a_tolerance_below_arithmetic_is_refused(scenes):
    with pytest.raises(sg.SolidgearError, match="sixteen digits"):
        answer(scenes["shaft_stepped"], 1e-12)


def test_an_unknown_quantity_is_refused_and_the_nearest_offered(scenes):
    with pytest.raises(sg.SolidgearError, match='did you mean "C_zz"'):
        answer(scenes["shaft_stepped"], 0.1, "C_zx")


def test_couplings_may_be_asked_for_by_name(scenes):
    found = answer(scenes["pinion_overhung"], 0.1, "C_z,thx,bending")
    assert [v.quantity for v in found.values] == ["C_z,thx", "bending 1"]


def test_what_does_not_exist_is_said_to_be_missing():
    free = sg.load(ROOT / "geometry" / "cylinder_free.toml")
    found = answer(free, 0.1, "C_zz,bending")
    assert found.missing == ("C_zz",) and [v.quantity for v in found.values] == ["bending 1"]
    (told,) = (line for line in sentences(found) if line.startswith("Not there"))
    assert told == "Not there: C_zz (a motion that no bearing resists)."
    assert _absent(("C_zz", "K_thy", "torsion 1")) == (
        "C_zz, K_thy (motions that no bearing resists); torsion 1 (no such mode among the lowest)"
    )
    nothing = answer(free, 0.1, "C_zz")
    assert not nothing.reached and nothing.values == () and "exists" in nothing.steps[-1].why


def test_command_line():
    def run(*arguments):
        command = [sys.executable, "-m", "solidgear.cli", "answer", *arguments]
        return subprocess.run(command, capture_output=True, text=True, timeout=120, cwd=ROOT)

    done = run("geometry/shaft_stepped.toml", "--tol", "0.05", "--ask", "bending", "--json")
    found = json.loads(done.stdout)
    assert done.returncode == 0 and found["reached"] and found["values"][0]["bar"] <= 0.05
    told = run("geometry/cylinder_free.toml", "--ask", "C_zz")
    assert told.returncode == 3 and "Not there: C_zz" in told.stdout
    share = run("geometry/shaft_stepped.toml", "--tol", "1%")
    assert share.returncode == 2 and "write 0.01" in " ".join(share.stderr.split())
    with pytest.raises(sg.SolidgearError, match='did you mean "bending 1"'):
        answer(sg.load("geometry/shaft_stepped.toml"), ask="f1")
    wrong = run("geometry/shaft_stepped.toml", "--tol", "0")
    assert wrong.returncode == 1 and "tol = 0" in wrong.stderr


def test_a_coupling_that_symmetry_forbids_is_zero_and_others_are_not(scenes):
    shaft = sg.Scene.from_parts(
        [sg.Segment.cylinder("shaft", length=0.3, diameter=0.04)],
        bearings=[
            sg.Bearing(name=n, y=y, seat_width=0.02, matrix=np.eye(6) * 1e8)
            for n, y in (("A", 0.03), ("B", 0.27))
        ],
    )
    even = answer(shaft, 0.05, "C_zz, C_z,thx, C_thx").values
    assert [v.zero for v in even] == [False, True, False]
    assert even[1].size == pytest.approx((even[0].value * even[2].value) ** 0.5)
    odd = answer(scenes["pinion_overhung"], 0.05, "C_z,thx").values
    assert not odd[0].zero


def test_what_an_answer_cost_is_told_in_plain_seconds():
    """Not as 1.1e+02 s."""
    step = SimpleNamespace(rung="sector", valid=True, why="", chosen=True, seconds=108.4)
    found = SimpleNamespace(steps=[step], missing=(), tolerance=1e-3, reached=True, rung="sector")
    (line,) = sentences(found)
    assert line == "Within 0.10 %: sector, 108 s for all meshes tried."
