"""Entries chosen for a goal: the best design, limits that are kept, and what is claimed of it."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import solidgear as sg
from solidgear.variants.optimise.pool import Number
from solidgear.variants.optimise.wish import Wish, limit_of, wish_of
from tests.command import command

SHAFT = "geometry/shaft_stepped.toml"
#: the tilt compliance of the middle has its least value inside this range
SPAN = "bearing.B.position=-75 mm:-20 mm"


BEAM = {"model": "timoshenko"}


@pytest.fixture(scope="module")
def span():
    return sg.optimise(SHAFT, [SPAN], "min C_thx", **BEAM)


def test_the_best_of_a_span_is_that_of_a_grid(span):
    grid = sg.sweep(SHAFT, "bearing.B.position=-75 mm:-20 mm:28", model="timoshenko", n=1)
    # the least is flat: within a fiftieth of the range it changes by less than this
    assert span.best.value == pytest.approx(grid["C_thx"].min(), rel=2e-4)
    assert len(span.path) <= 45  # two samples and the searches from them
    assert "no error bars" in span.sentences[1]


def test_an_optimum_inside_a_range_is_found_and_one_at_its_end_is_told(span):
    assert span.at_end == () and -0.075 < span.best.values["bearing.B.position"] < -0.02
    found = sg.optimise(SHAFT, ["segment.middle.diameter=70 mm:90 mm"], "min C_zz", **BEAM)
    assert found.best.values["segment.middle.diameter"] == 0.09
    assert found.at_end == ("segment.middle.diameter",)
    assert any("at the end of its range" in sentence for sentence in found.sentences)


@pytest.mark.slow
def test_an_optimum_at_the_file_and_one_away_from_it_are_at_an_end_too():
    # where that is the file, and not where the file lies outside of the range
    as_it_is = sg.optimise(SHAFT, ["segment.middle.diameter=70 mm:80 mm"], "min C_zz", **BEAM)
    assert as_it_is.best.number == 0 and as_it_is.at_end == ("segment.middle.diameter",)
    outside = sg.optimise(SHAFT, ["segment.middle.diameter=60 mm:70 mm"], "min C_zz", **BEAM)
    assert outside.best.values["segment.middle.diameter"] == 0.07


@pytest.mark.parametrize(
    ("bars", "verdict", "said"),
    [((0.3, 0.3), "not resolved", "No gain is claimed"), ((0.1, 0.1), "resolved", "+0.5 % from")],
)
def test_a_gain_is_claimed_only_beyond_both_bars(span, bars, verdict, said):
    first = replace(span.path[0], goals=(Number(100.0, bars[0]),))
    best = replace(span.path[1], goals=(Number(100.5, bars[1]),))
    found = replace(span, goals=(wish_of("max f1"),), path=(first, best), best=best)
    assert found.gain.verdict == verdict and said in " ".join(found.sentences)


@pytest.mark.long
def test_limits_are_kept_and_what_cannot_be_is_told():
    vary = ["segment.middle.diameter=70 mm:90 mm"]
    found = sg.optimise(SHAFT, vary, "min mass", ["bending 1 > 800 Hz"], **BEAM)
    assert {one.kept for one in found.path} == {True, False}
    for one in found.path:
        assert one.kept == (Wish("bending 1", True).value(one.rows)[0] >= 800)
    assert found.best.value == min(one.value for one in found.path if one.kept)
    ends = ["segment.middle.diameter=70 mm,90 mm"]
    never = sg.optimise(SHAFT, ends, "min mass", ["C_zz < 0.1 um/kN"], **BEAM)
    assert never.best is None and "No design" in never.sentences[0]
    assert "nearest misses by" in never.sentences[1]


def test_words_of_goals_and_limits():
    assert wish_of("max bending 1") == wish_of("Maximise bending 1")
    assert limit_of("C_zz < 5 um/kN").limit == pytest.approx(5e-9)
    assert limit_of("K_thx > 2 kN*m/mrad").limit == pytest.approx(2e6)
    assert limit_of("life > 20000 h") == Wish("life_hours", True, 20000.0)
    assert limit_of("deflection_pinion < 20 um").limit == pytest.approx(2e-5)
    assert limit_of("f1 >= 600 Hz").limit == 600.0 and limit_of("mass<12 kg").upward is False


@pytest.mark.parametrize(
    ("vary", "goal", "keep", "said"),
    [
        ([], "max f1", [], "nothing is varied"),
        (["segment.left.diameter=40 mm"], "max f1", [], "holds one value alone"),
        (["segment.left.diameter=40 mm:40 mm"], "max f1", [], "both ends are the same"),
        (["segment.left.diamter=40 mm:50 mm"], "max f1", [], "diamter"),
        ([SPAN], "bending 1", [], "max NUMBER"),
        ([SPAN], "max bnding 1", [], "has no bnding 1.*bending 1"),
        # before a mesh: no mode is without a number
        ([SPAN], "max safety", [], "has no .safety.*yield_safety.*and modes such as bending 1"),
        ([SPAN], "max f1", ["C_zz = 5"], "NUMBER < VALUE"),
        ([SPAN], "max f1", ["C_zz < 5 kg"], "'kg' is not a unit"),
        ([SPAN], "max f1", ["C_zz < five"], "is not a number with a unit"),
        ([SPAN], "max f1", ["bnding 1 > 5"], "`keep`.*has no bnding 1.*bending 1"),
        ([SPAN], ["max f1", "min f1"], [], "both are of f1"),
        ([SPAN], ["max f1", "min f2", "min f3"], [], "one goal, or two"),
    ],
)
def test_bad_words_end_in_a_sentence(vary, goal, keep, said):
    with pytest.raises(sg.SolidgearError, match=said):
        sg.optimise(SHAFT, vary, goal, keep, **BEAM)


@pytest.mark.long
def test_the_command_writes_its_path_and_says_where_no_design_will_do(tmp_path):
    out = tmp_path / "out"
    words = ["optimise", SHAFT, "--vary", "bearing.B.position=-40 mm:-30 mm", "-f", "euler"]
    told = command(*words, "--goal", "max f1", "-o", out)
    assert told.exit_code == 0 and "across the range" in told.output
    data = json.loads((out / "optimum.json").read_text())
    values = [one["value"] for one in data["designs"] if one["kept"]]
    assert data["designs"][data["best"]]["value"] == max(values)
    assert (out / "designs.png").stat().st_size > 1000
    words[3] = "bearing.B.position=-40 mm,-30 mm"
    never = command(*words, "--goal", "max f1", "--keep", "f1 > 1 MHz")
    assert never.exit_code == 3
    assert np.isfinite(values).all()
