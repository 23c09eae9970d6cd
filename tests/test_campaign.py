"""Campaigns: what a seed draws, when a bar holds and a verdict is true, and what is kept and shown."""

import json
import math
import os
import time
from types import SimpleNamespace

import numpy as np
import pytest

from solidgear.core.judge.bars import ErrorBar
from solidgear.core.ladder import build
from solidgear.core.quantity import Quantity
from solidgear.core.scene import Scene
from validation.agree import nested
from validation.agree.relation import failed
from validation.campaign import __main__ as command
from validation.campaign import results, scoreboard, table
from validation.campaign import run as running
from validation.campaign.case import Run
from validation.campaign.cases import CASES, answers, claims, pairs, shafts, solids
from validation.campaign.cases.answers import goals_of, kind_of
from validation.campaign.rows import (
    AGREES,
    CONTRADICTS,
    DECIDED,
    FALSE_VALID,
    LIKE_ONLY,
    UNCERTAIN,
    VALID,
    Found,
    Row,
    Said,
    Truth,
    found_of,
    held,
    sorted_verdict,
    within,
)
from validation.campaign.scenes.bodies import BODIES
from validation.campaign.scenes.families import FAMILIES
from validation.campaign.scenes.parts import SORTS, draw
from validation.campaign.scenes.shafts import KINDS, TIES, random_scene, traits
from validation.campaign.scenes.small import small
from validation.campaign.scenes.solids import PARTS, Mesh, Part
from validation.campaign.scenes.springs import random_springs
from validation.campaign.truths import features
from validation.campaign.truths.kept import Truths, name_of, partner_of, truth_of
from validation.campaign.truths.reference import Reference
from validation.campaign.worker import Worker


def _row(error=1e-3, bar=2e-3, doubt=1e-6, side="both", quantity="C_zz", **rest):
    truth = None if error is None else Truth(2.0 - error * 2.0, doubt, 2.0, "made up")
    known = {"body": "bar", "tags": {"tolerance": "0.01"}, "tolerance": 1e-2} | rest
    return held(Said(quantity, 2.0, bar, 2.0, side), truth, **known)


def _mode(name, hz, turn=1.0):
    motions = [[[1.0, 0, 0, 0, 0, 0], [turn, 0, 0, 0, 0, 0]]]
    told = {"name": name, "family": name.split()[0], "frequency_hz": hz, "multiplicity": 1}
    return told | {"motions": motions, "uncertainty": 1e-6}


def _reference(**changes):
    values = {"C_zz": 1.0, "C_thx": 4.0, "C_z,thx": 0.1}
    modes = [_mode("bending 1", 100.0), _mode("bending 2", 102.0, -1.0), _mode("axial 1", 900.0)]
    rest = {"gram": np.eye(12).tolist(), "setting": [5, 6], "unknowns": 1, "seconds": 0.0}
    given = {"values": values, "uncertainty": dict.fromkeys(values, 1e-6), "modes": modes}
    return Reference(**(given | rest | changes))


# ------------------------------------------------------------------------------------------------
# - scenes
def test_a_seed_gives_one_scene():
    assert random_scene(5).as_dict() == random_scene(5).as_dict() != random_scene(6).as_dict()
    assert draw(5).text == draw(5).text and small(1, 5).scene == small(1, 5).scene
    with pytest.raises(ValueError, match="gearbox"):
        random_scene(1, kind="gear box")


def test_draws_cover_what_a_stranger_would_write():
    drawn = [traits(random_scene(seed)) for seed in range(150)]
    assert {d["kind"] for d in drawn} == set(KINDS) and {d["ties"] for d in drawn} == set(TIES)
    assert {d["bearings"] for d in drawn} == {1, 2, 3}
    ratios = [d["l_over_d"] for d in drawn]
    assert min(ratios) < 0.5 and max(ratios) > 30
    assert sum(d["coupled"] for d in drawn) > 30 and sum(d["unequal"] for d in drawn) > 20
    assert max(d["segments"] for d in drawn) >= 7
    assert min(d["wall_over_radius"] for d in drawn) < 0.1
    assert {draw(seed).sort for seed in range(60)} == set(SORTS)


@pytest.mark.parametrize("coupled", ["none", "paired", "strong"])
def test_springs_hold_and_never_push(coupled):
    for seed in range(50):
        k = random_springs(np.random.default_rng(seed), 0.05, seed % 2 == 0, coupled)
        size = np.where(np.diag(k) > 0, np.sqrt(np.diag(k)), 1.0)
        assert np.array_equal(k, k.T) and not k[4].any()
        assert np.linalg.eigvalsh(k / np.outer(size, size)).min() > -1e-14


@pytest.mark.parametrize("name", BODIES)
def test_every_drawn_body_is_a_scene_that_can_be_meshed(name):
    scene = BODIES[name].make()
    assert isinstance(scene, Scene) and BODIES[name].reason
    options = {"order": 1, "layers": 0, "edge_layers": 0, "families": ("torsion",)}
    assert build(scene, "harmonic", **options).size > 0


# ------------------------------------------------------------------------------------------------
# - judgement
@pytest.mark.parametrize(
    "error, bar, doubt, rule, expected",
    [
        (1e-3, 2e-3, 1e-6, "known", True),
        (-1e-3, 5e-4, 1e-6, "known", False),
        (1e-3, 9.9e-4, 2e-5, "known", True),  # may be within: benefit of the doubt
        (5e-8, 1e-9, 0.0, "known", None),  # rounding
        (1e-3, 1e-4, 5e-4, "known", None),  # the error is not known
        (1e-3, 1e-4, 5e-4, "decided", False),  # whatever it is, the bar is too small
        (1e-3, 9.9e-4, 2e-5, "decided", None),
        (5e-8, 1e-9, 0.0, "claim", False),  # a limit holds for rounding too
        (None, 1e-3, 0.0, "known", None),
    ],
)
def test_a_bar_holds_or_not(error, bar, doubt, rule, expected):
    row = _row(error, bar, doubt, rule=rule)
    assert row.held is expected and row.judged is (expected is not None)
    assert row.ratio == (pytest.approx(bar / abs(error)) if row.judged else None)


def test_a_number_is_beyond_the_tolerance_whatever_its_bar_says():
    told, honest = _row(2e-2, bar=5e-3), _row(2e-2, bar=3e-2)
    assert told.beyond and told.promised and not told.held
    assert honest.beyond and not honest.promised and honest.held
    assert not _row(1.01e-2, doubt=1e-3).beyond


def test_the_exact_answer_lies_on_the_side_that_was_told():
    # the value is too large: the exact answer lies below
    assert _row(1e-3, side="above").wrong_side and _row(-1e-3, side="below").wrong_side
    assert not _row(1e-3, side="below").wrong_side and not _row(1e-3).wrong_side


def test_errors_at_the_edge_are_not_counted():
    assert within({"C_zz": (0.04, 0.001)}, 0.05) is True
    assert within({"C_zz": (0.06, 0.001), "C_yy": (0.0, 0.0)}, 0.05) is False
    assert within({"C_zz": (0.0505, 0.001)}, 0.05) is None
    assert sorted_verdict(True, None) == "on the edge"


@pytest.mark.parametrize(
    "valid, error, fair, sort",
    [
        (True, 0.0, 0.0, VALID),
        (True, 0.2, 0.0, FALSE_VALID),
        (False, 0.2, 0.2, "not valid, true"),
        (False, 0.0, 0.0, "false invalid"),
        (False, 0.0, 0.2, LIKE_ONLY),
    ],
)
def test_verdicts_are_sorted(valid, error, fair, sort):
    scene = random_scene(1)
    tolerance = scene.ask.tolerance
    model = {"valid": valid, "why_not": "reason", "modes": [], "bars": {}}
    model["values"] = {"C_zz": 1.0 + 10 * error * tolerance}
    off = {"C_zz": model["values"]["C_zz"] / (1 + 10 * fair * tolerance), "C_thx": 4.0}
    like = _reference(values=off, uncertainty=dict.fromkeys(off, 1e-6))
    said = {"models": {"euler": model}, "check": {"euler": "holds", "lumped": "holds"}}
    found = shafts.verdicts_of(said, {"spectral 0": _reference()}, {"spectral 0": like}, scene, "b")
    euler = next(v for v in found if v.model == "euler")
    assert euler.sort == sort and bool(euler.why) == ("false" in sort)
    check = next(v for v in found if v.model == "check of euler")
    assert check.sort == (AGREES if valid else CONTRADICTS)


def test_check_may_doubt():
    said = {"models": {"euler": {"valid": True, "values": {}}}, "check": {"euler": "with caution"}}
    assert shafts.verdicts_of(said, {}, {}, random_scene(1), "b")[-1].sort == UNCERTAIN


def test_kinds_of_quantities():
    assert {kind_of(q) for q in ("C_zz", "K_thx", "C_thy", "C_zz@gear")} == {"static"}
    assert {kind_of(q) for q in ("C_z,thx", "C_zz@p@gear")} == {"coupling"}
    assert kind_of("torsion 1") == "mode"


def test_references_are_refined_for_what_is_not_known():
    rows = [_row(1e-4, doubt=1e-4), _row(1e-3, doubt=1e-4, quantity="C_yy"), _row(None)]
    assert goals_of(rows) == {"C_zz": pytest.approx(3e-5)}
    assert not goals_of([_row(1e-9, doubt=1e-9)])
    # one that seems to be missed is made sure of
    sure, missed = _row(1e-3, doubt=1e-4), _row(1e-3, bar=1e-4, doubt=1e-4)
    assert not goals_of([sure]) and goals_of([missed]) == {"C_zz": pytest.approx(3e-5)}


# ------------------------------------------------------------------------------------------------
# - which value is true
def test_couplings_are_related_to_their_diagonals():
    assert truth_of("C_z,thx", 0.1, {"spectral": _reference()}).size == pytest.approx(2.0)
    assert truth_of("C_thy", 0.1, {"spectral": _reference()}) is None


def test_references_that_contradict_each_other_are_not_believed():
    better = _reference(uncertainty=dict.fromkeys(("C_zz", "C_thx", "C_z,thx"), 1e-9))
    assert truth_of("C_zz", 1.0, {"spectral": _reference(), "product": better}).how == "product"
    far = _reference(values={"C_zz": 1.1, "C_thx": 4.0, "C_z,thx": 0.1})
    assert truth_of("C_zz", 1.0, {"spectral": far, "product": better}) is None
    assert truth_of("C_thx", 4.0, {"spectral": far, "product": better}) is not None


def test_a_finer_level_counts_unless_it_drowns_in_rounding():
    def level(value, doubt):
        return _reference(values={"C_thx": value}, uncertainty={"C_thx": doubt})

    both = {"spectral 1": level(1.0, 5e-7), "spectral 0": level(1.1, 1e-7)}
    assert truth_of("C_thx", 1.0, both).value == 1.0
    assert truth_of("C_thx", 1.0, both | {"spectral 2": level(2.0, 0.3)}).value == 1.0


def test_modes_near_each_other_are_paired_by_shape_whatever_their_names():
    found = {"spectral": _reference()}
    # alone: by name, without a shape
    assert truth_of("axial 1", 901.0, found, shape=pytest.fail).how == "spectral, by name"
    swapped = truth_of("bending 1", 101.0, found, lambda: _mode("bending 1", 101.0, -1.0))
    assert swapped.value == 102.0 and "there called bending 2" in swapped.how
    assert truth_of("bending 1", 101.0, found) is None
    assert partner_of(_mode("bending 1", 400.0), _reference())[0] is None
    # a reference without shapes tells a mode only where no other is near
    apart = _reference(modes=[_mode("bending 1", 100.0), _mode("axial 1", 101.0)], gram=[])
    assert truth_of("bending 1", 100.2, {"triangles": apart}).value == 100.0
    assert truth_of("bending 1", 101.0, {"triangles": _reference(gram=[])}) is None


def test_the_answered_mode_is_the_nearest_of_its_family():
    modes = [_mode("bending 1", 100.0), _mode("bending 2", 104.0), _mode("axial 1", 103.0)]
    assert answers.shape_of("bending 1", 103.0, modes)["frequency_hz"] == 104.0
    assert answers.shape_of("bending 1", 300.0, modes) is None


def test_references_are_kept_under_what_a_scene_is_and_failures_are_not_tried_again(tmp_path):
    scene, asked = BODIES["shoulder 3"].make(), []

    def call(function, *arguments):
        asked.append(arguments[1:])
        return (_reference(), "") if arguments[1:] == (0, 100) else (None, "too long")

    first = Truths(scene, tmp_path, call, (100, 50), 1.0, str)
    first.refine(lambda: True)
    again = Truths(scene.with_changes(title="another"), tmp_path, call, (100, 50), 1.0, str)
    again.refine(lambda: True)
    assert again.finest == _reference() and asked == [(0, 100), (1, 50)]
    Truths(scene, tmp_path, call, (100, 50), 2.0, str).refine(lambda: True)
    assert len(asked) == 3  # more time is another matter
    assert name_of(BODIES["shoulder 1.2"].make()) != name_of(scene)


# ------------------------------------------------------------------------------------------------
# - the table
def test_a_table_counts_what_was_judged():
    rows = [_row(1e-3, 2e-3), _row(1e-3, 4e-3), _row(1e-3, 5e-4), _row(1e-9, 1e-3, 0.0), _row(None)]
    whole = table.bars(rows)[0]
    counts = ("of", "judged", "not judgeable", "rounding", "held")
    assert [whole[name] for name in counts] == [5, 3, 1, 1, 2]
    assert whole["bar / error, least"] == 0.5 and whole["bar / error, median"] == 2
    assert table.misses(rows)[0].startswith("bar, 0.01, C_zz: not held; bar 5.0e-04")
    assert table.unknown(rows) == ["bar: 1 (0 surely held, 1 without a true value)"]
    assert table.bars(rows, [("tolerance",)])[0]["numbers"] == "0.01"


def test_what_was_found_is_read_as_it_was_written():
    found = Found([_row(), _row(None, rule=DECIDED)], failures=["it fell over"])
    assert found_of(json.loads(json.dumps(found.as_dict()))) == found
    assert found.wrong and not Found([_row()]).wrong and Found([_row(bar=1e-4)]).wrong


# ------------------------------------------------------------------------------------------------
# - the whole
def test_a_worker_survives_what_it_runs():
    worker = Worker(20.0)
    try:
        assert worker.call(math.sqrt, 4.0) == (2.0, "")
        assert "math domain" in worker.call(math.sqrt, -1.0)[1]
        assert "TypeError" in worker.call(math.sqrt)[1]
        assert "exit code 3" in worker.call(os._exit, 3)[1]
        worker.seconds = 0.5
        assert worker.call(time.sleep, 60)[1].startswith("timeout")
    finally:
        worker.close()


class _Told:
    """A worker that knows its answers."""

    asked: list[str] = []

    def __init__(self, seconds):
        pass

    def call(self, function, *arguments):
        self.asked.append(function.__name__)
        if function is not answers.ask:
            return _reference(), ""
        if arguments[0].length < 0.15:
            return None, "timeout after 1 s"
        value = {"quantity": "C_zz", "value": 1.001, "bar": 2e-3, "size": 1.0, "side": "both"}
        told = {"options": {}, "unknowns": 7, "seconds": 0.5, "reached": True, "rung": "harmonic"}
        return {"values": [value]} | told, ""

    def close(self):
        pass


def test_a_campaign_goes_on_after_a_hang_and_where_it_was(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(running, "Worker", _Told)
    monkeypatch.setattr(_Told, "asked", [])
    given = ["answers", "--words", "shoulder 3", "--scenes", "nowhere.toml"]
    given += ["--folder", str(tmp_path), "--jobs", "2"]
    assert command.main(given) == 0
    assert _Told.asked.count("ask") == 2 and "nowhere.toml" in capsys.readouterr().out
    assert command.main(given) == 0 and _Told.asked.count("ask") == 2
    (path,) = tmp_path.glob("*.json")
    score = json.loads(path.read_text())
    assert score["asked"] == "1 drawn bodies; 1 scene files; tolerances 0.01, 0.001"
    assert (score["bars"][0]["judged"], score["bars"][0]["held"]) == (2, 2)
    assert score["problems"] == 1 and score["machine"] and score["date"]
    # asked again; a body that hangs is told
    assert command.main([*given, "--again"]) == 0 and _Told.asked.count("ask") == 4
    assert command.main(["answers", "--words", "disc of 0.03", "--folder", str(tmp_path)]) == 0
    assert "timeout after 1 s" in capsys.readouterr().out


def test_the_scoreboard_is_what_the_results_say():
    """Written anew by `python -m validation.campaign scoreboard`."""
    found = results.read()
    assert scoreboard.PAGE.read_text() == scoreboard.page(found)
    assert {result["campaign"] for result in found} <= set(CASES)
    for result in found:
        assert result["date"] and result["commit"] and result["asked"] and result["machine"]


def _directly(function, *arguments):
    return function(*arguments), ""


def _run(folder, *arguments):
    return Run(command.parsed([*arguments]), folder, _directly, pytest.fail)


@pytest.mark.long
def test_a_coarse_answer_of_a_drawn_body():
    scene = answers.scene_of("free shaft")
    found = answers.ask(scene, 0.1)
    named = {value["quantity"]: value["value"] for value in found["values"]}
    assert {"bending 1", "axial 1", "torsion 1"} <= set(named)
    assert "C_zz" in found["missing"] and found["rung"] == "harmonic"
    mode = answers.shape_of(
        "bending 1", named["bending 1"], answers.shapes(scene, found["options"])
    )
    assert mode["frequency_hz"] == pytest.approx(named["bending 1"], rel=1e-9)


def test_modes_of_small_shafts_are_those_of_dense_factors(tmp_path):
    """A beam, and harmonic solids by two methods."""
    run = _run(tmp_path, "modes")
    found = Found()
    for number in (1, 2, 3, 5):
        found.add(CASES["modes"].judge(run, number))
    assert not found.wrong and not found.problems and len(found.rows) > 20


@pytest.mark.parametrize(
    "seed",
    (
        pytest.param(26, marks=pytest.mark.long),
        *(pytest.param(s, marks=pytest.mark.slow) for s in (8, 25, 61, 56)),
    ),
)
def test_what_must_hold_of_every_part(seed):
    """A fillet with a chamfer, teeth with a bolt circle; a keyway, three without a mirror plane, cross holes."""
    found = claims.judged(draw(seed).text, f"{seed}", bars=False)
    assert not found.wrong and {"rigid", "mass", "symmetry"} <= {r.quantity for r in found.rows}


@pytest.mark.slow
def test_random_shafts_end_to_end(tmp_path):
    """Bars of both solids held, and no beam called valid falsely, on shafts of two kinds."""
    run = _run(tmp_path, "shafts", "--seeds", "11", "12", "--solid", "1")
    found = Found()
    for body in CASES["shafts"].bodies(run.given):
        found.add(CASES["shafts"].judge(run, *body))
    assert {row.tags["model"] for row in found.rows} == {"harmonic", "hex20", "tet10"}
    assert not found.wrong and not found.problems


@pytest.mark.long
def test_a_resolved_change_goes_the_way_of_its_theorem(monkeypatch):
    # a bearing that is stiffer by 0.1
    monkeypatch.setattr(pairs, "between", lambda *_: 0.1)
    scene = random_scene(2)
    found = pairs.two_shafts([scene, pairs.changed(scene, 2)[0]])
    monkeypatch.setattr(pairs, "two_shafts", lambda shafts: found)
    rows = pairs.judged(2).rows
    assert {row.quantity for row in rows} >= {"C_zz", "K_zz", "bending 1"}
    assert all(row.held for row in rows)
    # told as one that is softer: every number is on the wrong side
    monkeypatch.setattr(
        pairs, "_wrong_way", lambda *given, right=pairs._wrong_way: right(*given[:-1], -given[-1])
    )
    wrong = pairs.judged(2).rows
    assert not any(row.held for row in wrong if row.tags["verdict"] == "resolved")
    assert any(row.tags["verdict"] == "resolved" for row in wrong)


def test_of_a_solid_both_ends_of_a_number_are_held_against_the_truth():
    # ends at 1.1 and 1.5, the middle 1.3
    bar = ErrorBar(0.5, 0.5, 1.25, 0.0, 1.4, middle=1.3, aside=0.3)

    def ends(name, value, truth):
        rows = solids.rows_of(Quantity(name), value, bar, 1.0, Truth(truth, 0.0, 1.0, "made up"))
        return {kind: (pytest.approx(limit), pytest.approx(error)) for kind, limit, error in rows}

    held = {"static": (0.2, -0.05), "value of the mesh": (0.5, -0.35), "lower side": (0.35, 0.1)}
    assert ends("C_zz", 1.0, 1.35) == held
    # a truth nearer than the least growth shows
    limit, error = ends("C_zz", 1.0, 1.05)["lower side"]
    assert limit.expected < error.expected
    held = {"coupling": (0.2, 0.1), "value of the mesh": (0.5, -0.2)}
    assert ends("C_z,thx", 1.0, 1.2) == held
    softer = ErrorBar(0.5, 0.5, 1.25, 0.0, 0.6, middle=0.7, aside=0.3)
    rows = solids.rows_of(Quantity("K_zz"), 1.0, softer, 1.0, Truth(0.65, 0.0, 1.0, "made up"))
    sizes = (0.2, 0.05), (0.5, 0.35), (0.35, 0.1)
    assert [row[1:] for row in rows] == [pytest.approx(pair) for pair in sizes]


def test_a_solid_is_judged_on_one_mesh_and_told_what_it_costs():
    truths = {"C_zz": Truth(1e-10, 1e-15, 1e-10, "made up")}
    options = {"element": "hex20", "layers": 0, "relative_size": 2.0, "around": 8}
    mesh = Mesh(BODIES["short plate"].make(), "hex20", options)
    found = solids.judged("short plate", mesh, {"element": "hex20", "mesh": "1"}, truths, 1000)
    kinds = ["static", "value of the mesh", "lower side"]
    assert [row.tags["kind"] for row in found.rows] == kinds
    # the number is larger than that, though it can only grow
    assert not any(row.held for row in found.rows)
    assert [cost.tags["stage"] for cost in found.costs] == ["build", "statics", "modes", "estimate"]


def test_a_body_that_no_mesh_is_light_enough_for_is_not_solved(tmp_path):
    given = command.parsed(["solids", "--limit", "100", "--no-random", "--elements", "hex20"])
    called = []

    def call(function, *arguments):
        called.append(function)
        return function(*arguments), ""

    found = solids.Solids().judge(Run(given, tmp_path, call, print), "short plate")
    assert [word in found.problems[0] for word in ("hex20 1", "more than 100")] == [True, True]
    assert not found.rows and called == [solids.part_of, solids.unknowns_of]


@pytest.mark.parametrize("sort", ["block", "bracket"])
def test_bodies_of_boxes_are_one_body_by_any_mesh(sort, tmp_path):
    part = PARTS[sort](3, tmp_path)
    scenes = [*part.exact, *(mesh.scene for mesh in part.meshes)]
    assert {scene.body.element for scene in scenes} >= {"tet4", "hex8"}
    assert [s.body.volume for s in scenes] == pytest.approx([scenes[0].body.volume] * len(scenes))
    assert all(scene.bearings[0].patch and scene.port.patch for scene in scenes)
    sizes = solids.unknowns_of(part)
    # what is true is finer than what is judged
    assert max(sizes) < int(build(part.exact[-1], "solid").size)


@pytest.mark.parametrize("sort", ["web", "half"])
def test_a_body_of_a_family_is_one_body_by_any_mesh(sort, tmp_path):
    """Cells that would fold straighten arcs of a thin wall a little: 2e-4 of the volume."""
    part = FAMILIES[sort](3, tmp_path)
    volumes = [mesh.scene.body.volume for mesh in part.meshes]
    assert volumes == pytest.approx(volumes[:1] * len(volumes), rel=3e-4)
    names = [seat.name for seat in part.drawing.seats]
    assert {s.name for s in part.meshes[-1].scene.stations} == set(names)
    again = FAMILIES[sort](3, tmp_path)
    assert again.drawing == part.drawing != FAMILIES[sort](4, tmp_path).drawing


def test_bars_of_two_meshes_that_exclude_each_other_are_found_whatever_the_truth():
    def row(mesh, error, kind="static"):
        tags = {"element": "tet10", "mesh": mesh, "kind": kind}
        return Row("body", "C_zz", tags, bar=0.1, error=error, doubt=1.0)

    def excluding(*rows):
        return failed(nested.beside("body", solids.claims_of(rows)))

    assert not excluding(row("1", -0.3), row("2", -0.15))
    assert excluding(row("1", -0.3), row("2", -0.05))
    assert not excluding(row("1", -0.3), row("2", -0.05, solids.LOWER))


def test_a_frequency_lies_between_the_values_and_the_lower_ends_of_its_place():
    modes = SimpleNamespace(
        modes=[
            SimpleNamespace(name=name, frequency_hz=hz, vectors=[0] * count)
            for name, hz, count in (
                ("rigid 1", 0.0, 1),
                ("bending 1", 100.0, 2),
                ("axial 1", 104.0, 1),
                ("torsion 1", 105.0, 1),
                ("axial 2", 106.0, 1),
            )
        ]
    )
    bars = {
        name: ErrorBar(width, width, 1.25, 0.0, 0.0)
        for name, width in (("bending 1", 0.01), ("axial 1", 0.1), ("axial 2", 0.5))
    }
    found = solids.ascending({Quantity(name): bar for name, bar in bars.items()}, modes)
    assert found == {
        "f1": (100.0, pytest.approx(93.6)),
        "f2": (100.0, pytest.approx(99.0)),
        "f3": (104.0, pytest.approx(99.0)),
    }


@pytest.mark.long
def test_a_shaft_in_a_mesh_file_is_that_of_its_segments(tmp_path):
    part = PARTS["mesh"](2, tmp_path)
    plain = part.exact[0]
    volume = sum(np.pi * (s.outer0**2 - s.inner0**2) * s.length for s in plain.segments)
    assert [mesh.element for mesh in part.meshes] == ["hex20"] * 3
    assert part.meshes[0].scene.body.volume == pytest.approx(volume, rel=2e-4)
    assert plain.body is None and len(plain.bearings) == 2


def test_pairs_of_parts_with_features_have_the_names_of_their_modes():
    given = {"pair 1": 10.0, "pair 2": 11.0, "axial 1": 5.0}
    numbers = features.Numbers(given, dict.fromkeys(given, 0.1), {})
    names = {}
    for sort, source in (("half", "features"), ("cut", "features"), ("sector", "sectors")):
        found = solids._by_names(Part(sort, [], source, []), numbers)
        names[sort] = {name: row["value"] for name, row in found.items()}
    assert names["half"] == {"bending z 1": 10.0, "bending x 1": 11.0, "axial 1": 5.0}
    assert names["cut"] == {"bending 1": 10.0, "bending 2": 11.0, "axial 1": 5.0}
    assert names["sector"] == {"bending 1": 10.0, "axial 1": 5.0}
