"""Error against cost: the front, the floor under it, and a race that nothing but its own reference
can stop.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.comparison.race import timing as racing
from solidgear.comparison.race.race import Race, Reference, Row, front
from solidgear.comparison.race.timing import answer, plan, race, scaled_error, setup_seconds
from solidgear.core.errors import SolidgearError

GEOMETRY = Path(__file__).parent.parent / "geometry"
#: coarse, but enough to give a bar
COARSE = {"order": 3, "layers": 0, "edge_layers": 0}


@pytest.fixture(scope="module")
def scene():
    return sg.load(GEOMETRY / "shaft_stepped.toml")


def made(points, bar=1e-4):
    """A race of (seconds, unknowns, error) by hand."""
    table = [
        Row(
            "harmonic",
            "harmonic h graded",
            k,
            "harmonic",
            {},
            "ok",
            "",
            u,
            [s],
            {"C_zz": 1 + e},
            {"C_zz": e},
        )
        for k, (s, u, e) in enumerate(points, start=1)
    ]
    reference = Reference("harmonic", {}, "order 2", 100, 1.0, {"C_zz": 1.0}, {"C_zz": bar})
    return Race({}, reference, table, {}, 1, 10, 240.0)


# ------------------------------------------------------------------------------------------------- front


def test_points_without_a_number_take_no_part():
    assert front([None, 1.0, 2.0, 0.1, float("inf")], [1e-9, None, 1e-2, float("nan"), 1e-9]) == [2]
    assert front([], []) == []


def test_front_is_what_nothing_beats():
    rng = np.random.default_rng(0)
    cost, error = rng.integers(0, 12, (2, 60)).astype(float)
    found = set(zip(cost[f := front(cost, error)], error[f]))
    best = {
        (c, e)
        for c, e in zip(cost, error)
        if not np.any((cost <= c) & (error <= e) & ((cost < c) | (error < e)))
    }
    assert found == best


def test_below_the_bar_nothing_is_told_apart():
    r = made([(1.0, 10, 1e-2), (2.0, 20, 9e-5), (3.0, 30, 1e-9)])
    assert [r.error(row, "C_zz") for row in r.rows] == [1e-2, 1e-4, 1e-4]
    assert [r.resolved(row, "C_zz") for row in r.rows] == [True, False, False]
    # 1e-9 is luck: the cheaper of the two that reach the bar is the one on the front
    assert r.front("C_zz") == r.rows[:2]


def test_fronts_over_time_and_over_unknowns_differ():
    r = made([(1.0, 500, 1e-2), (2.0, 20, 1e-2), (3.0, 10, 1e-3)])
    assert [row.level for row in r.front("C_zz")] == [1, 3]
    assert [row.level for row in r.front("C_zz", "unknowns")] == [3]


def test_a_failed_row_is_never_on_the_front():
    r = made([(1.0, 10, 1e-2), (2.0, 20, 1e-3)])
    r.rows[1].status = "failed"
    assert r.front("C_zz") == r.rows[:1]


def test_a_cancellation_earns_no_place_on_the_front():
    r = made([(1.0, 10, 5e-2), (2.0, 20, 1e-3), (3.0, 30, 1e-2)])
    r.rows[1].like_for_like["C_zz"] = 6e-2
    assert r.error(r.rows[1], "C_zz") == 1e-3 and r.sure_error(r.rows[1], "C_zz") == 6e-2
    assert [row.level for row in r.front("C_zz")] == [1, 3]


def test_a_coarse_mesh_that_beats_its_own_refinement_was_lucky():
    r = made([(1.0, 10, 2e-2), (2.0, 20, 1e-4), (3.0, 30, 1e-2), (4.0, 40, 2e-3)], bar=1e-6)
    assert [r.sure_error(row, "C_zz") for row in r.rows] == [2e-2, 1e-2, 1e-2, 2e-3]
    assert [row.level for row in r.front("C_zz")] == [1, 2, 4]
    r.rows[1].series = "another"  # nothing finer is known of it
    assert r.sure_error(r.rows[1], "C_zz") == 1e-4


def test_scaled_error_sees_couplings_and_leaves_free_motions_out():
    c = np.diag([4.0, 1.0, 4.0, 1e-4, np.nan, 1e-4])
    d = c.copy()
    d[2, 3] = d[3, 2] = 2e-4  # a coupling that should be zero, 1 % of sqrt(4 * 1e-4)
    assert scaled_error(d, c) == pytest.approx(1e-2)
    d[0, 0] *= 1.03
    assert scaled_error(d, c) == pytest.approx(3e-2)
    assert scaled_error(np.full((6, 6), np.nan), c) is None


# ------------------------------------------------------------------------------------------------- plan
@pytest.mark.parametrize("full", [False, True])
def test_plan_has_every_family_uniform_and_graded_level_by_level(scene, full):
    names = {row.series for row in plan(scene, full)}
    assert names == {"lumped", "Euler", "Timoshenko", "automatic"} | {
        f"{kind} {grading}"
        for kind in ("harmonic h", "harmonic p", "TET4", "TET10", "HEX8", "HEX20", "HEX27")
        for grading in ("uniform", "graded")
    }
    levels = [row.level for row in plan(scene, full)]
    assert levels == sorted(levels)
    assert len(plan(scene, True)) > len(plan(scene))


@pytest.mark.long
def test_uniform_means_no_grading(scene):
    """Cells next to a shoulder are as large as the others, to the rounding of whole numbers of
    cells.
    """
    for row in plan(scene):
        if row.level > 1 or row.model not in ("harmonic", "solid") or row.family == "tetrahedra":
            continue
        body = sg.build(scene, row.model, **row.options)
        y = body.geometry.mesh.p[1]
        steps = np.diff(np.unique(y.round(9)))
        if "uniform" in row.series:
            assert steps.max() < 5 * steps.min(), row.series
        elif row.series != "harmonic p graded" or row.level > 1:
            assert steps.max() > 5 * steps.min(), row.series
    uniform = [row for row in plan(scene) if row.family == "tetrahedra" and "uniform" in row.series]
    assert uniform and all(row.options["graded_size"] == row.options["size"] for row in uniform)


# ------------------------------------------------------------------------------------------------- race
@pytest.mark.long
def test_a_failure_is_a_row_with_its_reason_and_stops_nothing(raced):
    _, beam, good, bad, _ = raced.rows
    assert [beam.status, bad.status, good.status] == ["ok", "failed", "ok"]
    assert "order 99" in bad.reason and bad.errors == {} and raced.error(bad, "C_zz") is None
    assert len(beam.samples) == len(good.samples) == 2 and len(bad.samples) == 1
    assert raced.complete and 0 < raced.reference.bands["C_zz"] < 1e-2


def test_errors_are_those_of_the_answers_a_user_gets(scene, raced):
    beam = raced.rows[1]
    body = sg.build(scene, "timoshenko", **beam.options)
    c = sg.condense(body, scene, scene.port.name).compliance[2, 2]
    f = sg.modes(body, scene, 10).named("bending 1").frequency_hz
    reference = sg.build(scene, "harmonic", **raced.reference.options)
    c0 = sg.condense(reference, scene, scene.port.name).compliance[2, 2]
    f0 = sg.modes(reference, scene, 10).named("bending 1").frequency_hz
    assert beam.values == pytest.approx({"C_zz": c, "bending 1": f}, rel=1e-12)
    assert beam.errors["C_zz"] == pytest.approx(abs(c / c0 - 1), rel=1e-9)
    assert beam.errors["bending 1"] == pytest.approx(abs(f / f0 - 1), rel=1e-9)
    assert beam.errors["C 6x6"] >= beam.errors["C_zz"]
    assert beam.unknowns == body.size


def test_like_for_like_is_against_section_ties(scene, raced):
    tied = scene.with_attachment("section")
    reference = sg.build(tied, "harmonic", **raced.reference.options)
    c = sg.condense(reference, tied, scene.port.name).compliance[2, 2]
    beam = raced.rows[1]
    own = sg.condense(sg.build(tied, beam.model, **beam.options), tied, scene.port.name).compliance[
        2, 2
    ]
    assert beam.like_for_like["C_zz"] == pytest.approx(abs(own / c - 1), rel=1e-9)
    assert raced.rows[2].like_for_like == {}  # a solid is tied as the scene says
    # seats that distort add to what a beam gets wrong, so the two columns cannot be the same number
    assert beam.like_for_like["C_zz"] != pytest.approx(beam.errors["C_zz"], rel=0.01)


def test_every_model_is_attached_as_the_scene_says(scene):
    rigid = scene.with_attachment("rigid")
    for model, options, wanted in (("harmonic", COARSE, "rigid"), ("timoshenko", {}, "rigid")):
        body = answer(rigid, model, options, 10).body
        assert {port.attachment for port in body.ports} == {wanted}


def test_lumped_has_the_compliance_of_its_source_and_its_own_frequency(scene):
    lumped = answer(scene, "lumped", {}, 10).quantities
    beam = answer(scene, "timoshenko", {}, 10).quantities
    assert lumped["C_zz"] == beam["C_zz"]
    # mode-matched or Guyan: never below the body's own first bending
    assert lumped["bending 1"] >= beam["bending 1"] * (1 - 1e-9)


def test_a_lumped_model_that_cannot_be_made_fails_with_the_reason(scene, monkeypatch):
    monkeypatch.setattr(racing, "preferred", lambda made: None)
    with pytest.raises(SolidgearError, match="no lumped mass is positive"):
        answer(scene, "lumped", {}, 10)


#: wall seconds of one of a processor
BUSY = 10.0


class Stage:
    """Clocks of our own, and answers that cost what they are told to cost."""

    def __init__(self, monkeypatch, scene, cost):
        self.now, self.cost, self.calls = 0.0, cost, []
        real = answer(scene, "timoshenko", {}, 10)
        self.real = real
        monkeypatch.setattr(racing, "processor_seconds", lambda: self.now)
        # a machine that does nine other things at once
        monkeypatch.setattr(racing.time, "perf_counter", lambda: BUSY * self.now)
        monkeypatch.setattr(racing, "answer", self.answer)
        reference = Reference(
            model="harmonic solid",
            options=COARSE,
            setting="order 3",
            unknowns=1,
            seconds=1.0,
            values={"C_zz": 1e-9, "bending 1": 1e3},
            bands={"C_zz": 1e-6, "bending 1": 1e-6},
        )
        monkeypatch.setattr(
            racing, "_reference", lambda *_: (reference, real.statics.main.compliance)
        )
        monkeypatch.setattr(racing, "_warm_up", lambda *_: {})
        monkeypatch.setattr(
            racing.gc, "collect", lambda: 0
        )  # it walks through all that the suite has loaded

    def answer(self, scene, model, options, n):
        self.calls.append(options["tag"])
        step = self.cost[options["tag"]]
        if isinstance(step, BaseException):
            raise step
        self.now += step
        return self.real


def tagged(*tags):
    """One series a letter, one level a digit."""
    return [Row("harmonic", tag[0], int(tag[1]), "harmonic", {"tag": tag}) for tag in tags]


def test_runs_go_in_turns(scene, monkeypatch):
    stage = Stage(monkeypatch, scene, {"a1": 1.0, "b1": 9.0, "c1": 25.0})
    found = race(scene, tagged("a1", "b1", "c1"), runs=4, budget=1e6)
    # 9 s are worth three runs and 25 s one
    assert stage.calls == ["a1", "b1", "c1", "a1", "b1", "a1", "b1", "a1"]
    assert [len(r.samples) for r in found.rows] == [4, 3, 1]
    assert found.rows[1].seconds == 9.0 * BUSY


def test_budget_leaves_out_levels_that_would_not_fit_with_all_their_runs(scene, monkeypatch):
    stage = Stage(
        monkeypatch, scene, {"a1": 1.0, "b1": 0.1, "a2": 4.0, "b2": 0.2, "a3": 1.0, "b3": 0.4}
    )
    found = race(scene, tagged("a1", "b1", "a2", "b2", "a3", "b3"), runs=5, budget=60.0)
    status = {r.options["tag"]: r.status for r in found.rows}
    # a3 is guessed at 16 s from the growth of a1 to a2: three runs of it and what is owed to the
    # others are above 60 s
    assert status == {"a1": "ok", "b1": "ok", "a2": "ok", "b2": "ok", "a3": "left out", "b3": "ok"}
    assert "60 s" in next(r.reason for r in found.rows if r.options["tag"] == "a3")
    assert "a3" not in stage.calls
    assert stage.now <= 60.0 < found.seconds
    assert all(len(r.samples) == 5 for r in found.rows if r.status == "ok")


def test_small_models_come_before_large_ones_and_the_warm_up_tells_which_are_large(
    scene, monkeypatch
):
    stage = Stage(monkeypatch, scene, {"a1": 30.0, "b1": 0.1, "b2": 0.2})
    monkeypatch.setattr(
        racing,
        "_warm_up",
        lambda *_: {("solid", None, False): 30.0, ("harmonic", None, False): 0.1},
    )
    rows = tagged("a1", "b1", "b2")
    rows[0].model = "solid"
    found = race(scene, rows, runs=2, budget=20.0)
    assert stage.calls == ["b1", "b2", "b1", "b2"]
    assert found.rows[0].status == "left out" and "30 s a run" in found.rows[0].reason


def test_a_level_after_one_left_out_is_left_out(scene, monkeypatch):
    Stage(monkeypatch, scene, {"a1": 10.0, "a2": 0.0, "a3": 0.0})
    found = race(scene, tagged("a1", "a2", "a3"), runs=1, budget=15.0)
    assert [r.status for r in found.rows] == ["ok", "left out", "left out"]


def test_a_budget_that_ends_early_leaves_fewer_runs_and_says_so(scene, monkeypatch):
    stage = Stage(monkeypatch, scene, {"a1": 5.0})
    found = race(scene, tagged("a1"), runs=5, budget=12.0)
    assert len(found.rows[0].samples) == 2 and "12 s" in found.rows[0].reason
    assert stage.now <= 12.0


def test_what_the_reference_takes_is_none_of_the_budget(scene, monkeypatch):
    stage = Stage(monkeypatch, scene, {"a1": 1.0})
    told = racing._reference()

    def slow(*_):
        stage.now += 1000.0
        return told

    monkeypatch.setattr(racing, "_reference", slow)
    found = race(scene, tagged("a1"), runs=2, budget=5.0)
    assert len(found.rows[0].samples) == 2 and found.seconds >= 1000.0


def test_a_beam_is_there_whatever_else_used_up_the_budget(scene, monkeypatch):
    stage = Stage(monkeypatch, scene, {"a1": 0.1, "b1": 0.1})

    def slow(*_):
        stage.now += 100.0
        return {("harmonic", None, False): 0.1}

    monkeypatch.setattr(racing, "_warm_up", slow)
    rows = tagged("a1", "b1")
    rows[1].family = "beam"
    found = race(scene, rows, runs=2, budget=5.0)
    assert [(r.status, len(r.samples)) for r in found.rows] == [("left out", 0), ("ok", 1)]


def test_the_cheapest_case_is_there_whatever_used_up_the_budget(scene, monkeypatch):
    """A part that no beam models, on a budget that was gone before its first case."""
    stage = Stage(monkeypatch, scene, {"a1": 8.0, "b1": 2.0, "b2": 4.0})
    guesses = {("solid", None, False): np.inf, ("harmonic", None, False): 2.0}

    def slow(*_):
        stage.now += 100.0
        return guesses

    monkeypatch.setattr(racing, "_warm_up", slow)
    rows = tagged("a1", "b1", "b2")
    rows[0].model = "solid"
    found = race(scene, rows, runs=2, budget=5.0)
    assert [row.status for row in found.rows] == ["left out", "ok", "left out"]
    assert len(found.rows[1].samples) == 1


def test_a_chart_without_a_single_answer_is_an_error_that_says_why(scene, monkeypatch):
    Stage(monkeypatch, scene, {"a1": SolidgearError("no mesh")})
    with pytest.raises(SolidgearError, match="nothing to chart: no case.*no mesh"):
        race(scene, tagged("a1"), runs=1, budget=1e6)


def test_a_model_that_does_not_fit_a_scene_is_one_row_that_says_why():
    rows = plan(sg.load(GEOMETRY / "pinion_keyed.toml"))
    failed = {row.model: row.reason for row in rows if row.status == "failed"}
    assert {"euler", "timoshenko", "harmonic"} <= set(failed)
    assert "keyway" in failed["harmonic"]
    assert {row.model for row in rows if row.status == "waiting"} >= {"corrected", "solid"}


def test_an_interrupt_keeps_what_there_was(scene, monkeypatch):
    kept = []
    Stage(monkeypatch, scene, {"a1": 1.0, "b1": KeyboardInterrupt(), "c1": 1.0})
    found = race(
        scene,
        tagged("a1", "b1", "c1"),
        runs=3,
        budget=1e6,
        keep=lambda r: kept.append([row.status for row in r.rows]),
    )
    assert not found.complete
    assert [(r.status, len(r.samples)) for r in found.rows] == [
        ("ok", 1),
        ("left out", 0),
        ("left out", 0),
    ]
    assert found.rows[1].reason == "interrupted"
    assert kept[0] == ["ok", "waiting", "waiting"] and kept[-1] == ["ok", "left out", "left out"]


@pytest.mark.parametrize(
    "stopped", [MemoryError(), ValueError("bad shape"), SolidgearError("no mesh")]
)
def test_whatever_stops_a_model_becomes_its_reason(scene, monkeypatch, stopped):
    Stage(monkeypatch, scene, {"a1": stopped, "b1": 1.0})
    found = race(scene, tagged("a1", "b1"), runs=2, budget=1e6)
    assert found.rows[0].status == "failed" and found.rows[1].status == "ok"
    assert (
        found.rows[0].reason
        == {
            "MemoryError": "not enough memory",
            "ValueError": "ValueError: bad shape",
            "SolidgearError": "no mesh",
        }[type(stopped).__name__]
    )


def test_a_missing_first_bending_is_said_and_costs_only_that_number(scene, monkeypatch):
    stage = Stage(monkeypatch, scene, {"a1": 1.0})
    stage.real = replace(stage.real, quantities={"C_zz": stage.real.quantities["C_zz"]})
    found = race(scene, tagged("a1"), runs=1, budget=1e6)
    row = found.rows[0]
    assert row.status == "ok" and row.reason == "found no bending 1"
    assert found.error(row, "bending 1") is None and found.error(row, "C_zz") > 0


def test_a_free_shaft_is_charted_by_its_frequency_alone():
    free = sg.load(GEOMETRY / "cylinder_free.toml")
    found = race(free, [Row("beam", "Timoshenko", 1, "timoshenko", {})], runs=1, sure=1e-2)
    assert list(found.reference.values) == ["bending 1"]
    assert list(found.rows[0].values) == ["bending 1"]


@pytest.mark.long
def test_setup_costs_come_from_a_fresh_interpreter():
    found = setup_seconds()
    assert {"numpy and scipy", "solidgear and scikit-fem"} <= set(found)
    assert all(v > 0 for v in found.values())
