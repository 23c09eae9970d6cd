"""The cheapest answer with a bar: whether the bar holds, what it costs, and what is passed over."""

import json
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.judge import question
from solidgear.core.judge.answer import answer
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.quantities import change
from solidgear.core.judge.question import FamilySolver
from solidgear.core.judge.refinement import Refinement, refine
from solidgear.core.judge.solving import Numbers, solve
from solidgear.core.ladder.registry import LADDER
from solidgear.core.quantity import C_ZZ, K_ZZ, Quantity
from solidgear.core.scene import Bearing
from solidgear.cuts.features import BoltCircle
from solidgear.show.settled import _absent, sentences
from tests.command import command

ROOT = Path(__file__).parent.parent
SCENES = ["pinion_overhung", "shaft_stepped", "shaft_hollow", "pinion_straddle"]
C_YY = Quantity("C_yy")
ALL = ("C_zz", "C_z,thx", "C_thx", "C_yy", "K_zz", "bending 1", "bending 2", "axial 1")


def begun(scene, model, wanted, tol):
    """A refinement without a mesh yet."""
    return Refinement(scene, model, wanted, tol, plan=model.meshes_of(scene, {}))


@pytest.fixture(scope="module")
def scenes():
    return {name: sg.load(ROOT / "geometry" / f"{name}.toml") for name in SCENES}


@pytest.fixture(scope="module")
def truth(scenes):
    """A mesh with layers towards all corners: measured within 4e-5 of the next one."""

    @cache
    def found(name):
        return solve(scenes[name], "harmonic", 12, **FINE).quantities

    return found


#: one order more and one layer more each, towards all corners
COARSE, MIDDLE, FINE = (
    {"order": p, "layers": p - 2, "edge_layers": max(p - 3, 0), "relative_size": 4.0}
    for p in (3, 4, 5)
)
#: an overhung head and a plain shaft; the others differ in their seats and bores
FEW = [
    SCENES[0],
    *(pytest.param(n, marks=pytest.mark.slow) for n in SCENES[1:]),
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
    assert [n for n in LADDER.of("solid") if LADDER[n].follows] == ["harmonic"]


def test_only_what_is_asked_is_built_and_the_numbers_are_the_same(scenes):
    scene = scenes["pinion_overhung"]
    part = answer(scene, 1e-3, ["bending 1", "C_zz"])
    assert len([s for s in part.steps if s.valid]) > 1  # what couples what is known from the first
    mesh = part.steps[-1].options
    body = sg.build(scene, "harmonic", **mesh)
    # three of four blocks' unknowns are bending's, in two planes
    assert part.steps[-1].unknowns < 0.8 * body.size
    full = solve(scene, "harmonic", **mesh).quantities
    # the bearings of this scene couple planes by 1e-8 of their stiffness, left out at this tolerance
    assert part["C_zz"] == pytest.approx(full["C_zz"], rel=1e-7)
    assert part["bending 1"] == pytest.approx(full["bending 1"], rel=1e-7)


@pytest.mark.long
def test_from_the_second_mesh_on_only_what_is_open_is_solved(scenes):
    scene = scenes["pinion_overhung"]
    found = answer(scene, 1e-3, ["C_thx", "bending 1", "axial 1"])
    first, *finer = (s for s in found.steps if s.valid)
    # the shoulder disturbs axial 1 least: one cell a band and strip is enough for it
    assert first.only == () and finer and all("axial 1" not in step.only for step in finer)
    assert set(finer[0].only) == {"C_thx", "bending 1"}
    # bending is two of the four blocks, and three of five of the unknowns
    assert finer[-1].unknowns < 0.8 * sg.build(scene, "harmonic", **finer[-1].options).size
    for v in found.values:
        own = next(s for s in [*finer[::-1], first] if not s.only or v.quantity in s.only)
        whole = solve(scene, "harmonic", **own.options).quantities
        assert v.bar <= 1e-3
        # bearings couple planes by 1e-8 of their stiffness, which is left out at this tolerance
        assert abs(change({**whole, v.quantity: v.value}, whole, v.quantity)) < 1e-7


def rod(length=2.0, **rest):
    """A plain bar of 30 mm, on two bearings that do not resist its turning."""
    ends = [
        Bearing(name=n, y=y, seat_width=0.02, stiffness={"kxx": 3e8, "kzz": 3e8, **along})
        for n, y, along in (("A", 0.02, {"kyy": 3e8}), ("B", length - 0.02, {}))
    ]
    bar = sg.Segment.cylinder("s", length=length, diameter=0.03)
    port = sg.Port(name="P", y=length / 2, lo=length / 2 - 0.02, hi=length / 2 + 0.02)
    return sg.Scene.from_parts([bar], port=port, bearings=ends, **rest)


@pytest.mark.long
def test_a_mode_is_found_and_the_same_whatever_else_is_asked():
    """Of a bar 67 diameters long ten bending modes lie below the first along it, and more below its
    twist.
    """
    scene = rod()
    alone, both = answer(scene, 0.01, "axial 1"), answer(scene, 0.01, "bending 1,axial 1")
    assert both.reached and not both.missing
    assert both["axial 1"] == pytest.approx(alone["axial 1"], rel=1e-9)
    listed = answer(scene, 0.01)
    assert "axial 1" in {v.quantity for v in listed.values} and not listed.missing
    assert listed["axial 1"] == pytest.approx(alone["axial 1"], rel=1e-9)


def test_a_mode_far_above_the_others_is_exact_for_a_bar_that_turns_freely():
    """A uniform bar twists at c / 2 L, with c the speed of shear waves: sections stay plane."""
    scene = rod()
    found = answer(scene, 1e-3, ["torsion 1", "C_zz"])
    steel = scene.segments[0].material
    exact = (steel.shear_modulus / steel.density) ** 0.5 / 4.0
    assert found["torsion 1"] > 20 * answer(scene, 0.1, "bending 1")["bending 1"]
    (twist,) = (v for v in found.values if v.quantity == "torsion 1")
    assert 0 <= twist.value / exact - 1 <= twist.bar <= 1e-3


def test_a_mode_above_the_highest_frequency_of_the_scene_is_judged():
    low = rod(ask=sg.Ask(max_frequency=30.0))
    found, free = (answer(scene, 0.01, ["axial 1"]) for scene in (low, rod()))
    assert found.reached and found["axial 1"] > 10 * 30.0
    assert found["axial 1"] == pytest.approx(free["axial 1"], rel=1e-9)


def test_a_coupling_stands_in_the_middle_of_its_bar(scenes, truth):
    """Its two ends are what the mesh says and what its softest relative does."""
    scene = scenes["pinion_overhung"]
    wanted = tuple(map(Quantity, ("C_z,thx", "C_zz", "C_thx")))
    refinement = begun(scene, LADDER["harmonic"], wanted, 0.02)
    refine(refinement, FamilySolver(refinement), lambda _: None, "harmonic")
    value, *diagonal = refinement.values()
    bar = refinement.error_bars["C_z,thx"]
    of_mesh = refinement.levels[-1].quantities["C_z,thx"]
    assert value.value == bar.middle != of_mesh
    assert abs(of_mesh / value.value - 1) > 1e-5
    assert abs(of_mesh - value.value) <= value.bar * value.size < bar.width * value.size
    # half of what Cauchy and Schwarz leave of its diagonal entries
    whole = (diagonal[0].bar * diagonal[1].bar) ** 0.5
    assert value.bar == pytest.approx(whole / 2, rel=1e-4)
    exact = truth("pinion_overhung")["C_z,thx"]
    assert abs(value.value - exact) <= value.bar * value.size
    assert abs(value.value - exact) < abs(of_mesh - exact)


@pytest.mark.long
def test_what_holds_a_bar_back_is_named(two_meshes):
    """A rigid seat that ends at a shoulder: at 1e-8 the corner is what is left after two meshes."""
    parts = [
        sg.Segment.cylinder("a", length=0.06, diameter=0.04),
        sg.Segment.cylinder("b", y0=0.06, length=0.06, diameter=0.06),
    ]
    springs = dict.fromkeys(("kxx", "kyy", "kzz"), 1e9) | {"kthx": 1e5, "kthz": 1e5}
    held = Bearing(name="A", y=0.09, seat_width=0.02, stiffness=springs)
    port = sg.Port(name="P", y=0.05, lo=0.04, hi=0.06, attachment="rigid")
    found = answer(sg.Scene.from_parts(parts, port=port, bearings=[held]), 1e-8, "C_zz")
    assert not found.reached
    why = found.steps[-1].why
    assert (
        found.bar > 1e-8 and found.steps[-1].chosen and why.startswith("2 meshes were too coarse")
    )
    assert why.endswith("most of the error bar comes from the shoulder at y = 60 mm, r = 20 mm")


def test_what_a_finer_mesh_finds_less_sure_again_is_solved_on(scenes):
    refinement = begun(scenes["shaft_stepped"], LADDER["harmonic"], (C_ZZ, K_ZZ), 1e-3)
    solver = FamilySolver(refinement)

    def level(c, k):
        refinement.levels.append(Numbers({C_ZZ: 1.0, K_ZZ: 1.0}, {}))
        for name, width in ((C_ZZ, c), (K_ZZ, k)):
            bar = ErrorBar(width, change=width, factor=1.0, solver=0.0, extrapolated=1.0)
            refinement.error_bars[name] = bar
        return list(solver.next_quantities())

    assert level(1e-4, 1e-2) == ["K_zz"]
    # C_zz comes with K_zz, and is less sure after all
    assert level(1e-2, 1e-4) == ["C_zz"]


@pytest.mark.long
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
        sg.build(coupled, "harmonic", **COARSE),
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
    assert all("cannot show their own error" in why for why in passed.values())
    assert sum(s.chosen for s in found.steps) == 1


def test_a_finer_mesh_that_fails_leaves_the_answer_of_the_one_before(scenes, builds_until):
    calls = builds_until(1)
    scene = scenes["pinion_overhung"]
    found = answer(scene, 1e-5, "C_thx")
    assert not found.reached and "3000 MB are free" in found.steps[-1].why and len(calls) == 2
    own = {k: v for k, v in calls[0].items() if k != "families"}
    alone = solve(scene, "harmonic", **own).quantities["C_thx"]
    # the other families, which couple to bending by 1e-8 of the stiffness of bearings, are left out
    assert found["C_thx"] == pytest.approx(alone, rel=1e-7)
    # one mesh tells its own error
    assert 1e-5 < found.bar < 0.1 and found.values[0].how == "local problems"


def test_a_model_that_cannot_be_built_is_passed_over(scenes, monkeypatch):
    real = question.build

    def build(scene, model, **options):
        if model == "harmonic":
            raise sg.SolidgearError("a keyway is no body of revolution")
        return real(scene, model, **options)

    monkeypatch.setattr(question, "build", build)
    found = answer(scenes["shaft_stepped"], 0.3, "C_zz")
    assert found.rung == "solid"
    assert any(s.rung == "harmonic" and "keyway" in s.why for s in found.steps)


def test_what_heavy_meshes_cost_is_told_before_they_are_made(monkeypatch):
    """Holes of 2 mm through 60 mm, where 80,000 unknowns are many; those of 12 mm are no matter."""
    from solidgear.core.judge import effort

    monkeypatch.setattr(effort, "HEAVY", 80_000)
    monkeypatch.setattr(effort, "MAYBE_HEAVY", 80_000 / 3)

    def told(diameter):
        rim = sg.Segment.cylinder("rim", length=0.06, diameter=0.05)
        holes = BoltCircle(name="b", segment="rim", count=6, diameter=diameter, circle=0.036)
        scene = sg.Scene.from_parts([rim], features=[holes])
        return list(effort.heavy_meshes(scene, LADDER["sector"]))

    (sentence,) = told(0.002)
    assert (
        "its coarsest mesh takes " in sentence and "without which there is no error bar" in sentence
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
    # the comma of any entry is its own, whether it is known or not
    with pytest.raises(sg.SolidgearError, match='no quantity "C_x,y"'):
        answer(scenes["pinion_overhung"], 0.1, "C_zz, C_x,y,bending")


def test_what_does_not_exist_is_said_to_be_missing():
    free = sg.load(ROOT / "geometry" / "cylinder_free.toml")
    found = answer(free, 0.1, "C_zz,bending")
    assert found.missing == ("C_zz",) and [v.quantity for v in found.values] == ["bending 1"]
    (told,) = (line for line in sentences(found) if line.startswith("No answer for"))
    assert told == "No answer for C_zz (a motion that no bearing resists)."
    assert _absent(list(map(Quantity, ("C_zz", "K_thy", "torsion 1")))) == (
        "C_zz, K_thy (motions that no bearing resists); torsion 1 (no such mode among the lowest)"
    )
    nothing = answer(free, 0.1, "C_zz")
    assert not nothing.reached and nothing.values == () and "exists" in nothing.steps[-1].why


def test_command_line(run):
    stepped, free = (
        ROOT / "geometry" / f"{name}.toml" for name in ("shaft_stepped", "cylinder_free")
    )
    code, out, _ = run("answer", stepped, "--tol", "5%", "--ask", "bending", "--json")
    found = json.loads(out)
    assert code == 0 and found["reached"] and found["tolerance"] == 0.05
    assert found["values"][0]["bar"] <= 0.05
    code, _, err = run("answer", stepped, "--tol", "one")
    assert code == 2 and "or 1%" in " ".join(err.split())
    code, _, err = run("answer", stepped, "--tol", "0")
    assert code == 1 and "tol = 0" in err


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


def test_solids_alone_are_told_to_be_passed_over():
    """Beams are so in every answer; a solid that could not be solved is news."""
    beam, solid = (
        SimpleNamespace(rung=rung, valid=False, why="not enough memory", chosen=False)
        for rung in ("euler", "harmonic")
    )
    chosen = SimpleNamespace(rung="sector", valid=True, why="", chosen=True)
    found = SimpleNamespace(steps=[beam, chosen], missing=(), tolerance=1e-3, reached=True)
    assert sentences(found) == ["Within the 0.1 % asked."]
    found.steps.insert(0, solid)
    assert sentences(found)[0] == "Skipped: harmonic (not enough memory)."


def test_f1_is_the_lowest_frequency_of_all_and_a_tolerance_may_be_written_in_per_cent(scenes):
    pinion = scenes["pinion_overhung"]
    found = answer(pinion, "2 %", "f1, f2")
    # this shaft moves along its axis before it bends
    assert [value.quantity for value in found.values] == ["axial 1", "bending 1"]
    assert found.tolerance == 0.02 and found["axial 1"] < found["bending 1"]
    with pytest.raises(sg.SolidgearError, match="f5 is bending 3 here"):
        answer(pinion, 0.02, "f5")
    with pytest.raises(sg.SolidgearError, match='or "1%"'):
        answer(pinion, "half")


def test_an_answer_that_lacks_a_number_asked_for_says_so_in_its_exit_code():
    shaft = "geometry/shaft_stepped.toml"
    lacking = command("answer", shaft, "--tol", "10%", "--ask", "bending,C_thy")
    assert (
        lacking.exit_code == 3 and "No answer for C_thy (a motion that no bearing" in lacking.stdout
    )
    assert command("answer", shaft, "--tol", "10%", "--ask", "bending").exit_code == 0
