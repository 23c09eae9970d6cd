"""Which model to trust and which is the cheapest that will do, on rungs made by hand and on the overhung pinion."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import solidgear as sg
from solidgear.comparison import compare
from solidgear.verdict import JUDGED, deviations, judge

GEOMETRY = Path(__file__).parent.parent / "geometry"


def solution(c_zz=1.0, bending=100.0):
    """A condensed result and a mode set with just these two numbers; everything else is not there."""
    compliance, stiffness = np.full((6, 6), np.nan), np.zeros((6, 6))
    compliance[2, 2] = c_zz
    named = {"bending 1": SimpleNamespace(frequency_hz=bending)}
    return SimpleNamespace(compliance=compliance, stiffness=stiffness, attachment="average"), SimpleNamespace(named=named.get)


def rung(c_zz=1.0, bending=100.0, *, band=None, section=None, size=10, **others):
    condensed, modes = solution(c_zz, bending)
    return SimpleNamespace(
        condensed=condensed,
        modes=modes,
        quantities={"C_zz": c_zz, "bending 1": bending, **others},
        bands={} if band is None else {name: {"gci": band} for name in ("C_zz", "bending 1", *others)},
        variants={} if section is None else {"section": solution(*section)},
        body=SimpleNamespace(size=size),
        meter=SimpleNamespace(seconds={"build": 1.0, "statics": 0.5, "modes": 0.5, "band": 100.0}),
    )


def asking(tolerance):
    return SimpleNamespace(ask=SimpleNamespace(tolerance=tolerance))


def verdicts(gaps, model="solid"):
    return {g["quantity"]: g["verdict"] for g in gaps if g["model"] == model}


# --------------------------------------------------------------------------- deviations
@pytest.mark.parametrize(
    ("relative", "mine", "theirs", "verdict"),
    [
        (0.010, 0.006, 0.005, "not resolved"),  # inside the sum, outside either one
        (-0.010, 0.006, 0.005, "not resolved"),
        (0.012, 0.006, 0.005, "resolved"),
        (-0.012, 0.006, 0.005, "resolved"),
        (0.004, None, 0.005, "not resolved"),  # a beam has no band
        (0.006, None, 0.005, "resolved"),
        (0.004, None, None, "no band"),
        (0.0, 0.0, 0.0, "not resolved"),
    ],
)
def test_a_gap_inside_the_summed_bands_is_not_resolved(relative, mine, theirs, verdict):
    rungs = {"harmonic": rung(band=theirs), "solid": rung(c_zz=1 + relative, band=mine)}
    (gap,) = [g for g in deviations(rungs, "harmonic") if g["quantity"] == "C_zz"]
    assert gap["verdict"] == verdict
    assert gap["relative"] == pytest.approx(relative, abs=1e-15)  # one subtraction
    known = [b for b in (mine, theirs) if b is not None]
    assert gap["band"] == (pytest.approx(sum(known), abs=1e-15) if known else None)
    assert gap["model"] == "solid" and gap["reference"] == "harmonic" and gap["unit"] == "m/N"


def test_beams_are_also_held_against_section_means():
    reference = rung(1.0, 100.0, band=1e-3, section=(1.1, 95.0))
    gaps = deviations({"timoshenko": rung(0.99, 99.0), "harmonic": reference}, "harmonic")
    found = {(g["attachment"], g["quantity"]): g["relative"] for g in gaps}
    # quotients of the numbers above
    assert found[("as scene", "C_zz")] == pytest.approx(-0.01, rel=1e-12)
    assert found[("section", "C_zz")] == pytest.approx(0.99 / 1.1 - 1, rel=1e-12)
    assert found[("section", "bending 1")] == pytest.approx(99 / 95 - 1, rel=1e-12)
    assert all(g["model"] == "timoshenko" for g in gaps)  # the reference is not held against itself


def test_solids_are_held_like_for_like():
    rungs = {"harmonic": rung(1.0, band=1e-3, section=(1.1, 95.0)), "solid": rung(1.01, band=1e-3, section=(1.11, 96.0))}
    found = {(g["attachment"], g["quantity"]): g["relative"] for g in deviations(rungs, "harmonic")}
    assert found[("section", "C_zz")] == pytest.approx(1.11 / 1.1 - 1, rel=1e-12)  # quotient
    # without its own section means a solid has no like-for-like partner
    rungs["solid"].variants = {}
    assert {g["attachment"] for g in deviations(rungs, "harmonic")} == {"as scene"}


def test_quantities_that_one_side_lacks_are_left_out():
    rungs = {"harmonic": rung(K_zz=5.0), "solid": rung()}
    assert verdicts(deviations(rungs, "harmonic")) == {"C_zz": "no band", "bending 1": "no band"}


# --------------------------------------------------------------------------- judge
def judged(rungs, tolerance, reference="harmonic"):
    gaps = deviations(rungs, reference)
    return judge(asking(tolerance), rungs, reference, gaps)


@pytest.mark.parametrize(("tolerance", "euler", "timoshenko"), [(0.01, False, False), (0.05, False, True), (0.25, True, True)])
def test_tolerance_decides(tolerance, euler, timoshenko):
    rungs = {"euler": rung(0.8), "timoshenko": rung(0.97), "harmonic": rung(1.0, band=1e-3)}
    verdict, validity = judged(rungs, tolerance)
    assert validity["euler"][0] is euler and validity["timoshenko"][0] is timoshenko and validity["harmonic"] == (True, None)
    assert verdict["cheapest"] == ("euler" if euler else "timoshenko" if timoshenko else "harmonic")
    assert verdict["trust"] == "harmonic" and verdict["tolerance"] == tolerance
    for model, valid in (("euler", euler), ("timoshenko", timoshenko)):
        why = validity[model][1]
        assert (why is None) is valid
        if not valid:
            assert "C_zz" in why and "harmonic" in why and f"{100 * tolerance:g} %" in why
            assert "more than the" in validity[model][1]


def test_cheapest_does_not_depend_on_the_order_of_the_rungs():
    rungs = {"solid": rung(1.001, band=1e-3), "harmonic": rung(1.0, band=1e-3), "timoshenko": rung(0.99), "euler": rung(0.5)}
    verdict, _ = judged(rungs, 0.05)
    assert verdict["cheapest"] == "timoshenko"
    # what it costs is building and solving it, not its evidence
    assert any("Cheapest model within 5 %: timoshenko (10 unknowns, 2 s)" in s for s in verdict["sentences"])


def test_worst_of_the_judged_numbers_is_named():
    rungs = {"timoshenko": rung(0.93, 120.0), "harmonic": rung()}
    _, validity = judged(rungs, 0.05)
    why = validity["timoshenko"][1]
    assert why.startswith("bending 1") and "20.0 %" in why and "with the attachments of the scene" in why


def test_like_for_like_counts_too():
    # right with the scene's seats, wrong like for like: a cancellation
    rungs = {"timoshenko": rung(1.0, 100.0), "harmonic": rung(1.0, 100.0, section=(1.2, 99.0))}
    _, validity = judged(rungs, 0.05)
    valid, why = validity["timoshenko"]
    assert not valid and "like for like (section means)" in why


def test_stiffnesses_are_shown_but_not_judged():
    rungs = {"timoshenko": rung(K_zz=2.0), "harmonic": rung(K_zz=1.0)}
    assert "K_zz" not in JUDGED
    assert any(g["quantity"] == "K_zz" and g["relative"] == 1.0 for g in deviations(rungs, "harmonic"))
    assert judged(rungs, 0.05)[1]["timoshenko"] == (True, None)


def test_solid_inside_the_bands_is_said_to_be_not_resolved():
    sentences = " ".join(judged({"harmonic": rung(band=1e-3), "solid": rung(1.001, band=1e-3)}, 0.05)[0]["sentences"])
    assert "not resolved" in sentences and "agree" not in sentences
    sentences = " ".join(judged({"harmonic": rung(band=1e-3), "solid": rung(1.01, band=1e-3)}, 0.05)[0]["sentences"])
    assert "not resolved" not in sentences and "beyond the bands in C_zz" in sentences


def test_beams_alone_are_not_trusted():
    verdict, _ = judged({"euler": rung(0.9), "timoshenko": rung()}, 0.05, reference="timoshenko")
    assert verdict["reference"] == "timoshenko"
    assert "no band of its own" in verdict["sentences"][0] and not any(s.startswith("Trust") for s in verdict["sentences"])


def test_nothing_solved():
    verdict, validity = judge(asking(0.05), {}, None, [])
    assert verdict["trust"] is verdict["cheapest"] is None and verdict["sentences"] == ["No model could be solved."] and validity == {}


def cancels(verdict):
    return [s for s in verdict["sentences"] if "seat flexibility" in s]


@pytest.mark.parametrize(("as_scene", "section", "said"), [(100.4, 97.0, True), (99.6, 97.0, True), (103.0, 97.0, False), (100.0, 100.0, False)])
def test_cancellation_is_said_where_there_is_one(as_scene, section, said):
    # 100 in the beam: off by (100 / as_scene - 1) with the scene's seats and by (100 / section - 1) like for like
    rungs = {"timoshenko": rung(1.0, 100.0), "harmonic": rung(1.0, as_scene, section=(1.0, section))}
    assert bool(cancels(judged(rungs, 0.05)[0])) is said


def test_cancellation_on_the_overhung_pinion():
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    found = compare(scene, ("timoshenko", "harmonic"), settings={"harmonic": {"order": 3, "layers": 1}}).results
    # measured 0.87 % with the scene's seats and 3.0 % like for like
    (sentence,) = cancels(found["verdict"])
    assert sentence.startswith("Timoshenko's first bending looks 0.87 % off") and "but is 3 % off" in sentence
    # so it fails at 5 % in spite of a first bending within 1 %: measured -10.1 % in C_thx like for like
    assert not found["models"]["timoshenko"]["valid"]
    assert "like for like" in found["models"]["timoshenko"]["why_not"]
    # and is good enough for someone who asks for 20 %
    loose = scene.with_changes(ask=scene.ask.with_changes(tolerance=0.2))
    found = compare(loose, ("timoshenko", "harmonic"), settings={"harmonic": {"order": 3, "layers": 1}}).results
    assert found["models"]["timoshenko"]["valid"] and found["verdict"]["cheapest"] == "timoshenko"
