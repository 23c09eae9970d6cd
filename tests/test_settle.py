"""Commands that choose their mesh: the numbers are those of the mesh they name, the truth is within
the bars, in both planes, and what is not reached is said.
"""

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.judge import bounded
from solidgear.core.judge.answer import answer
from solidgear.core.judge.bounded import mode_bars
from solidgear.core.judge.quantities import change, measure
from solidgear.core.judge.settle import settle
from solidgear.core.judge.solving import solve
from solidgear.core.quantity import QUANTITIES
from solidgear.core.scene import Bearing
from solidgear.core.solve.statics import condense
from solidgear.variants.sweep.bearing_task import settled_for_sweep
from solidgear.variants.sweep.bearing_variants import bearing_variants

ROOT = Path(__file__).parent.parent
SCENE = str(ROOT / "geometry" / "pinion_overhung.toml")
STEPPED = str(ROOT / "geometry" / "shaft_stepped.toml")
FREE = str(ROOT / "geometry" / "cylinder_free.toml")
#: the same system, factored again
ROUNDING = 1e-9
#: layers towards all corners, and what such a mesh errs by itself
FINE = {"order": 5, "layers": 2, "edge_layers": 1, "relative_size": 4.0}
REFERENCE = 5e-5


@pytest.fixture(scope="module")
def scene():
    return sg.load(SCENE)


@pytest.fixture(scope="module")
def truth(scene):
    return solve(scene, "harmonic", 14, **FINE)


def apart(matrix, exact):
    """Largest difference of two matrices, on the scale of the diagonal entries of a row and a
    column; motions that are free left out.
    """
    held = np.diag(exact) > 0
    size = np.sqrt(np.diag(exact)[held])
    kept = np.ix_(held, held)
    return np.abs((matrix[kept] - exact[kept]) / np.outer(size, size)).max()


# --------------------------------------------------------------------------- stiffness
@pytest.mark.long
def test_stiffness_is_that_of_the_mesh_it_names_and_the_truth_is_within_its_bars(run, scene, truth):
    code, out, err = run("stiffness", SCENE, "--tol", "0.01", "--json")
    found = json.loads(out)
    assert code == 0 and err == "" and found["reached"]
    assert found["model"] == "harmonic"
    assert found["setting"].startswith(f"order {found['options']['order']}, ")
    bars = found["bars"]
    assert found["tolerance"] == 0.01 and max(bars.values()) <= 0.01
    assert {"C_zz", "C_thx", "C_yy", "K_z,thx", "C_xx", "K_thz"} <= set(bars)
    again = solve(scene, found["model"], 1, **found["options"])
    stiffness = np.array(found["stiffness"], float)
    compliance = np.array(found["compliance"], float)
    assert again.body.size == found["unknowns"]
    assert apart(stiffness, again.statics.main.stiffness) < ROUNDING
    assert apart(compliance, again.statics.main.compliance) < ROUNDING
    assert apart(stiffness, truth.statics.main.stiffness) <= max(bars.values()) + REFERENCE
    # and every number by itself, couplings too: of the body, which stands at an end of what is open
    assert set(bars) <= set(again.quantities)
    for name, bar in bars.items():
        assert abs(change(again.quantities, truth.quantities, name)) <= bar + REFERENCE, name


@pytest.mark.long
def test_a_tighter_tolerance_takes_a_finer_mesh_and_the_scene_has_one_of_its_own(scene):
    loose, tight = settle(scene, None, "stiffness"), settle(scene, 1e-3, "stiffness")
    assert loose.tolerance == scene.ask.tolerance
    assert tight.body.size > loose.body.size and tight.reached
    assert max(tight.bars.values()) <= 1e-3 < max(loose.bars.values())


@pytest.mark.long
def test_bars_of_a_body_hold_its_own_couplings(scene):
    """A coarse body errs by all that its bars hold, and a coupling by as much as its diagonal does."""
    found = settle(scene, 0.1, "stiffness")
    fine = sg.build(scene, "harmonic", **FINE)
    mine, exact = (measure(condense(body, scene, "pinion"), None) for body in (found.body, fine))
    off = {q: abs(change(mine, exact, q)) for q in ("C_z,thx", "C_x,thz", "K_z,thx", "K_x,thz")}
    # errors that are there, well above that of the fine mesh
    assert all(10 * REFERENCE < error <= found.bars[q] for q, error in off.items()), off


@pytest.mark.long
def test_the_plane_that_rests_on_the_mesh_decides(scene):
    """Soft bearings hide the mesh in one plane, stiff ones show it in the other."""
    bearings = []
    for b in scene.bearings:
        stiffness = {"kxx": 4e9, "kyy": 4e6, "kzz": 4e6, "kthx": 1e3, "kthz": 1e6}
        bearings.append(Bearing(name=b.name, y=b.y, seat_width=b.seat_width, stiffness=stiffness))
    uneven = scene.with_changes(bearings=tuple(bearings))
    found = settle(uneven, 5e-4, "stiffness")
    soft_plane = answer(uneven, 5e-4, ("C_zz", "C_thx", "C_yy", "K_zz", "K_thx", "K_yy"))
    assert found.reached and found.largest[0] == "K_thz"
    coarse, mine, exact = (
        sg.condense(sg.build(uneven, "harmonic", **options), uneven, "pinion").stiffness[5, 5]
        for options in (soft_plane.steps[-1].options, found.options, FINE)
    )
    assert abs(mine / exact - 1) <= found.bars["K_thz"] + REFERENCE
    # the mesh that suits the soft plane is outside the tolerance here
    assert soft_plane.reached and abs(coarse / exact - 1) > 5e-4


def test_a_body_that_nothing_holds_has_a_stiffness_of_zero_and_no_bar(run):
    code, out, _ = run("stiffness", FREE, "--json")
    found = json.loads(out)
    assert code == 0 and found["reached"] and found["bars"] == {}
    assert found["stiffness"] == [[0.0] * 6] * 6
    code, out, _ = run("stiffness", FREE)
    assert code == 0 and "Largest" not in out and "No answer for C_zz" in out


# --------------------------------------------------------------------------- modes
@pytest.mark.long
def test_modes_are_those_of_the_mesh_and_the_first_of_every_family_have_a_bar(run, scene, truth):
    code, out, _ = run("modes", SCENE, "-n", "14", "--tol", "0.01", "--json")
    found = json.loads(out)
    assert code == 0 and found["reached"]
    assert set(found["bars"]) == {q for q in QUANTITIES if q.is_frequency}
    listed = {m["name"]: m["frequency_hz"] for m in found["modes"]}
    body, highest = sg.build(scene, found["model"], **found["options"]), scene.ask.max_frequency
    again = sg.modes(body, scene, 14, max_frequency=highest)
    assert list(listed) == list(again.names)
    np.testing.assert_allclose(list(listed.values()), again.frequency_hz, rtol=ROUNDING)
    for name in ("bending 1", "axial 1"):
        assert abs(listed[name] / truth.quantities[name] - 1) <= found["bars"][name] + REFERENCE
    # and all others that are listed, which the tolerance is not kept for
    assert found["without_bar"] == [] and {"bending 3", "axial 2"} < set(listed)
    for mode in found["modes"]:
        if mode["frequency_hz"] > 0:
            error = 1 - truth.modes.named(mode["name"]).frequency_hz / mode["frequency_hz"]
            assert 0 <= error + REFERENCE and error <= mode["bar"] + REFERENCE < 0.02


def test_modes_for_people(run):
    code, out, err = run("modes", SCENE, "--max-frequency", "9000", "-n", "14")
    assert code == 0 and err == ""
    assert "pinion_overhung: harmonic, order 3 (auto), " in out
    assert "Largest error bar: +- 0." in out and "Within the 5 % asked." in out
    assert "Skipped" not in out and "Residual" not in out  # --count shows it
    assert re.search(r"bending 3 +bending +\d+\.\d +2 +0\.\d+ %", out)


def test_bars_of_listed_modes_beyond_the_tolerance_are_told(run):
    code, out, _ = run("modes", SCENE, "-n", "14", "--tol", "0.002")
    assert code == 0 and "Beyond 0.20 %: bending 3 +- 0.3" in out


def test_the_highest_mode_of_a_family_has_no_bar(scene):
    """Nothing was found above, to which it could be near."""
    body = sg.build(scene, "harmonic", order=2, layers=0)
    found = sg.modes(body, scene, 8, ovalising=False)
    last = max((m for m in found.modes if m.family == "bending"), key=lambda m: m.frequency_hz)
    alone = replace(found, beyond=(), above=())
    assert last.name in mode_bars(scene, body, as_supports(scene), alone)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bounded, "modes", lambda *_, **__: alone)
        assert last.name not in mode_bars(scene, body, as_supports(scene), alone)


# --------------------------------------------------------------------------- not reached
@pytest.mark.long
def test_what_is_not_reached_is_given_with_its_bar_and_an_exit_code(run, two_meshes):
    code, out, err = run("modes", STEPPED, "-n", "4", "--tol", "1e-6", "--json")
    found = json.loads(out)
    assert code == 3 and err == "" and found["reached"] is False
    assert found["modes"] and max(found["bars"].values()) > 1e-6


def test_what_is_not_reached_is_said(run, two_meshes):
    code, out, _ = run("stiffness", SCENE, "--tol", "1e-5")
    assert code == 3 and "Not reached: " in out and "2 meshes were too coarse" in out
    assert "K_thx" in out and "compliance, engineering units" in out


def test_a_finer_mesh_that_fails_leaves_the_body_before_it(scene, builds_until):
    calls = builds_until(1)
    found = settle(scene, 1e-5, "stiffness")
    assert not found.reached and found.options == calls[0] and len(calls) == 2
    assert "3000 MB are free" in found.steps[-1].why
    assert found.body.size == [s for s in found.steps if s.chosen][0].unknowns
    # one mesh tells its own error
    assert all(0 < bar < 1 for bar in found.bars.values())


# --------------------------------------------------------------------------- refused
REFUSED = {
    "options of no fixed model": (
        ["stiffness", SCENE, "--set", "order=3"],
        "needs a fixed model: add -f harmonic",
    ),
    "the same of modes": (
        ["modes", SCENE, "-f", "auto", "--set", "order=3"],
        "needs a fixed model: add -f harmonic",
    ),
    "a tolerance for a fixed model": (
        ["stiffness", SCENE, "-f", "euler", "--tol", "0.1"],
        "--tol 0.1 needs -f auto",
    ),
    "one for a mesh that is set": (
        ["modes", SCENE, "-f", "solid", "--set", "refinement=0.4", "--tol", "0.1"],
        "--tol 0.1 needs -f auto",
    ),
    "the same of a sweep": (
        ["sweep", SCENE, "-f", "harmonic", "--vary", "bearing.1.scale=1,2", "--tol", "0.1"],
        "--tol 0.1 needs -f auto",
    ),
    "no tolerance": (["modes", SCENE, "--tol", "0"], "tol = 0"),
    "one below arithmetic": (["stiffness", SCENE, "--tol", "1e-12"], "sixteen digits"),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_refused_in_one_sentence(run, tmp_path, kind):
    arguments, says = REFUSED[kind]
    code, out, err = run(*arguments)
    assert code == 1 and out == "" and says in err
    assert err.startswith("solidgear: ") and err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.long
def test_a_named_3d_solid_is_as_coarse_as_the_tolerance_allows(run, scene):
    code, out, _ = run("modes", SCENE, "-f", "solid", "-n", "4", "--tol", "0.03", "--json")
    coarse = json.loads(out)
    assert code == 0 and coarse["reached"] and 0 < coarse["bars"]["bending 1"] <= 0.03
    assert coarse["unknowns"] < sg.build(scene, "solid").size / 5


# --------------------------------------------------------------------------- sweep
@pytest.mark.slow
def test_a_sweep_settles_on_the_scene_and_at_the_ends_of_what_varies(run, scene, tmp_path):
    words = ["sweep", SCENE, "--tol", "0.02", "-n", "3", "-o", "rows.csv"]
    words += ["--vary", "bearing.1.scale=0.5,1"]
    code, out, _ = run(*words)
    assert code == 0 and "Largest error bar over 3 bearing sets (the scene's and" in out
    rows = list(csv.DictReader((tmp_path / "rows.csv").open()))
    body = settle(scene, 0.02, "all").body
    base = sg.condense(body, scene, scene.port.name)
    # of a body with the same mesh, whose small problems are solved in another way
    assert float(rows[1]["K_zz"]) == pytest.approx(base.stiffness[2, 2], rel=1e-7)
    code, out, _ = run(*words, "--json")
    found = json.loads(out)
    assert code == 0 and found["skipped"] == 2 and found["reached"]
    assert found["options"]["order"] == 3 and {"C_zz", "bending 1"} <= set(found["bars"])


def test_a_sweep_whose_ends_are_refused_is_judged_on_the_scene_alone(run):
    # a coupling beyond both diagonal entries is no spring, on either side
    words = ["sweep", SCENE, "--tol", "0.05", "-n", "3", "-o", "rows.csv"]
    code, out, _ = run(*words, "--vary", "bearing.1.kx_thz=-1e15,0,1e15")
    assert code == 0 and "2 refused" in out
    assert "on the scene's bearing set alone (those at the ends are refused)" in out


@pytest.mark.slow
def test_a_sweep_takes_the_mesh_that_its_hardest_bearings_need(scene):
    """Clamped as hard as this, a compliance is all shaft, and errs as the shaft does."""
    scales = ["bearing.1.scale=1,1e4", "bearing.2.scale=1,1e4"]
    hard = settled_for_sweep(bearing_variants(SCENE, scales), 0.01)
    base = settle(scene, 0.01, "all")
    assert hard.judged_on > 1 and hard.reached
    for quantity, bar in base.bars.items():
        if hard.options == base.options:
            assert hard.bars[quantity] >= bar
    assert hard.largest[1] > base.largest[1] or hard.body.size > base.body.size
