"""Which model to trust and which is the cheapest that will do, on solutions made by hand and on shafts."""

from types import SimpleNamespace

import numpy as np
import pytest

from solidgear.comparison.models import compare
from solidgear.core.body.mode_names import ModeName
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.deviations import BEYOND, OPEN, WITHIN, deviations, gap_verdict
from solidgear.core.judge.quantities import JUDGED
from solidgear.core.judge.record import GuardRecord, LevelRecord
from solidgear.core.judge.solution import Solution
from solidgear.core.judge.solving import Answer, Statics
from solidgear.core.judge.ties import SCENE, SECTION
from solidgear.core.judge.verdict import judge, percent, trusted
from solidgear.core.quantity import Quantity
from solidgear.core.scene import Ask, Bearing, Scene, Segment
from solidgear.core.solve.modes import Mode, ModeSet

STATIONS = np.linspace(0.0, 1.0, 13)


def mode(name, frequency):
    """A mode whose shape belongs to its name: a sine of as many half waves, along y or in both
    planes.
    """
    family, number = name.rsplit(" ", 1)
    wave = np.sin(int(number) * np.pi * STATIONS)
    components = {"bending": (2, 0), "axial": (1,), "torsion": (4,)}[family]
    motions = np.zeros((len(components), len(STATIONS), 6))
    for row, c in enumerate(components):
        motions[row, :, c] = wave
    return Mode(
        ModeName(name), family, frequency, len(components), ({},) * len(components), motions, 1.0
    )


def tied(c_zz=1.0, bending=100.0, **others):
    modes = tuple(
        sorted(
            (mode("bending 1", bending), mode("bending 2", 4 * bending)),
            key=lambda m: m.frequency_hz,
        )
    )
    found = ModeSet("any", modes, STATIONS, np.eye(6 * len(STATIONS)))
    return Answer(
        SimpleNamespace(size=10, mesh={}),
        Statics(SimpleNamespace(attachment="average", evidence={"residual": 0.0})),
        found,
        {Quantity(q): v for q, v in {"C_zz": c_zz, "bending 1": bending, **others}.items()},
    )


def barred(size, names):
    return {n: ErrorBar(size, size, 1.0, 0.0, 1.0) for n in names}


def solution(c_zz=1.0, bending=100.0, *, model="beam", bar=None, section=None, **others):
    ties = {SCENE: tied(c_zz, bending, **others)}
    if section is not None:
        ties[SECTION] = tied(*section)
    bars = {} if bar is None else {tie: barred(bar, t.quantities) for tie, t in ties.items()}
    meter = SimpleNamespace(seconds={"build": 1.0, "statics": 0.5, "modes": 0.5, "band": 100.0})
    return Solution(model, ties, meter, error_bars=bars, levels=[LevelRecord()] * 3)


def asking(tolerance, quantities=()):
    ports = (SimpleNamespace(name="gear"),)
    ask = Ask(tolerance=tolerance, quantities=quantities)
    return SimpleNamespace(ask=ask, port=ports[0], ports=ports, further_ports=())


def judged(solutions, tolerance, quantities=(), notices=()):
    reference, _ = trusted(solutions, tolerance, JUDGED)
    gaps = deviations(solutions, reference) if reference else []
    return judge(asking(tolerance, quantities), solutions, gaps, notices)


def verdicts(gaps, model="solid"):
    return {g.quantity: g.verdict for g in gaps if g.model == model}


# --------------------------------------------------------------------------- deviations
@pytest.mark.parametrize(
    ("relative", "mine", "theirs", "verdict"),
    [
        (0.010, 0.006, 0.005, "not resolved"),  # inside the sum, outside either one
        (-0.010, 0.006, 0.005, "not resolved"),
        (0.012, 0.006, 0.005, "resolved"),
        (-0.012, 0.006, 0.005, "resolved"),
        (0.004, None, 0.005, "not resolved"),  # a beam has no bar
        (0.006, None, 0.005, "resolved"),
        (0.004, None, None, "no band"),
        (0.0, 0.0, 0.0, "not resolved"),
    ],
)
def test_a_gap_inside_the_summed_bars_is_not_resolved(relative, mine, theirs, verdict):
    solutions = {"harmonic": solution(bar=theirs), "solid": solution(c_zz=1 + relative, bar=mine)}
    (gap,) = [g for g in deviations(solutions, "harmonic") if g.quantity == "C_zz"]
    assert gap.verdict == verdict
    assert gap.relative == pytest.approx(relative, abs=1e-15)  # one subtraction
    known = [b for b in (mine, theirs) if b is not None]
    assert gap.bar == (pytest.approx(sum(known), abs=1e-15) if known else None)
    assert gap.model == "solid" and gap.reference == "harmonic" and gap.quantity.unit == "m/N"


def test_every_model_is_held_as_the_scene_is_tied_and_like_for_like():
    solutions = {
        "timoshenko": solution(0.99, 99.0, section=(1.08, 94.0)),
        "harmonic": solution(1.0, 100.0, bar=1e-3, section=(1.1, 95.0)),
    }
    gaps = deviations(solutions, "harmonic")
    found = {(g.attachment, g.quantity): g.relative for g in gaps}
    # quotients of the numbers above
    assert found[(SCENE, "C_zz")] == pytest.approx(-0.01, rel=1e-12)
    assert found[(SECTION, "C_zz")] == pytest.approx(1.08 / 1.1 - 1, rel=1e-12)
    assert found[(SECTION, "bending 1")] == pytest.approx(94 / 95 - 1, rel=1e-12)
    assert all(g.model == "timoshenko" for g in gaps)  # the reference is not held against itself
    # without its own section means a model has no like-for-like partner
    solutions["timoshenko"].ties.pop(SECTION)
    assert {g.attachment for g in deviations(solutions, "harmonic")} == {SCENE}


def test_a_coupling_is_told_against_the_mean_of_its_diagonal_entries():
    values = {"C_thx": 4.0, "C_z,thx": 1e-17}
    solutions = {
        "timoshenko": solution(**(values | {"C_z,thx": 0.02})),
        "harmonic": solution(bar=1e-3, **values),
    }
    (gap,) = [g for g in deviations(solutions, "harmonic") if g.quantity == "C_z,thx"]
    # 0.02 over the root of 1 times 4: symmetry makes the coupling itself zero
    assert gap.relative == pytest.approx(0.01, rel=1e-12)


def test_quantities_that_one_side_lacks_are_left_out():
    solutions = {"harmonic": solution(K_zz=5.0), "solid": solution()}
    assert verdicts(deviations(solutions, "harmonic")) == {
        "C_zz": "no band",
        "bending 1": "no band",
    }


# --------------------------------------------------------------------------- judge
def test_a_solid_is_judged_by_the_bar_of_the_reference_and_not_by_its_own():
    """Its own bar says how far it may be from the truth, which the reference tells better."""
    for c_zz, valid in ((0.97, True), (0.94, False)):
        for bar in (None, 0.045, 0.2):
            solutions = {
                "harmonic": solution(1.0, model="harmonic", bar=0.001),
                "solid": solution(c_zz, model="solid", bar=bar),
            }
            judgement = judged(solutions, 0.05)[1]["solid"]
            assert judgement.valid is valid and not judgement.open


def test_a_check_is_called_no_surer_than_it_is():
    def sentence(c_zz, bar):
        solid = solution(c_zz, model="solid", bar=bar)
        solid.check = True
        solutions = {"harmonic": solution(model="harmonic", bar=0.001), "solid": solid}
        return next(s for s in judged(solutions, 0.05)[0].sentences if "is a check" in s)

    assert sentence(0.97, 0.2).endswith(
        "whose numbers are within 5 % of the harmonic solid; its own error bar is wider, 20 %."
    )
    assert sentence(0.97, None).endswith("of the harmonic solid; it has no error bar.")
    assert sentence(0.8, 0.1).endswith(
        "on which each number is within 5 % of the harmonic solid, or beyond both error bars on "
        "two meshes, or sure; its own error bar is wider, 10 %."
    )


def test_a_gap_counts_with_its_bar():
    assert gap_verdict(0.04, 0.009, 0.05) == gap_verdict(-0.04, 0.009, 0.05) == WITHIN
    assert gap_verdict(0.045, 0.009, 0.05) == gap_verdict(-0.055, 0.009, 0.05) == OPEN
    assert gap_verdict(0.06, 0.009, 0.05) == BEYOND


@pytest.mark.parametrize(
    ("tolerance", "euler", "timoshenko"),
    [(0.01, False, False), (0.05, False, True), (0.25, True, True)],
)
def test_tolerance_decides(tolerance, euler, timoshenko):
    solutions = {
        "euler": solution(0.8),
        "timoshenko": solution(0.97),
        "harmonic": solution(1.0, bar=1e-3),
    }
    verdict, validity = judged(solutions, tolerance)
    assert validity["euler"].valid is euler and validity["timoshenko"].valid is timoshenko
    assert validity["harmonic"].valid and validity["harmonic"].why_not is None
    assert verdict.cheapest == ("euler" if euler else "timoshenko" if timoshenko else "harmonic")
    assert verdict.trust == "harmonic" and verdict.tolerance == tolerance
    for model, valid in (("euler", euler), ("timoshenko", timoshenko)):
        why = validity[model].why_not
        assert (why is None) is valid
        if not valid:
            assert "C_zz" in why and "harmonic solid" in why and f"{100 * tolerance:g} %" in why
            assert "more than the" in why and not validity[model].open


def test_what_the_bars_leave_open_is_not_valid():
    # 4.9 % off, known to within 0.2 %: that may be 5.1 %
    solutions = {"timoshenko": solution(0.951), "harmonic": solution(1.0, bar=2e-3)}
    verdict, validity = judged(solutions, 0.05)
    assert not validity["timoshenko"].valid and validity["timoshenko"].open
    assert "may or may not be within" in validity["timoshenko"].why_not
    assert verdict.cheapest == "harmonic"


def test_cheapest_does_not_depend_on_the_order_of_the_rungs():
    solutions = {
        "solid": solution(1.001, bar=1e-3),
        "harmonic": solution(1.0, bar=1e-3),
        "timoshenko": solution(0.99),
        "euler": solution(0.5),
    }
    verdict, _ = judged(solutions, 0.05)
    assert verdict.cheapest == "timoshenko"
    # what it costs is building and solving it, not its evidence
    assert any(
        "Cheapest model within 5 %: Timoshenko beam (10 unknowns, 2 s)" in s
        for s in verdict.sentences
    )


def test_a_share_in_words_has_no_exponent():
    assert [percent(x) for x in (3.5e-7, 5e-6, 0.0123, 1.5)] == [
        "less than 0.0001 %",
        "0.0005 %",
        "1.2 %",
        "150 %",
    ]


def test_worst_of_the_judged_numbers_is_named():
    solutions = {"timoshenko": solution(0.93, 120.0), "harmonic": solution(bar=1e-3)}
    why = judged(solutions, 0.05)[1]["timoshenko"].why_not
    assert (
        why.startswith("bending 1") and "20 %" in why and "against the harmonic solid, more" in why
    )


def test_like_for_like_counts_too():
    # right with the scene's seats, wrong like for like: a cancellation
    solutions = {
        "timoshenko": solution(1.0, 100.0, section=(1.0, 100.0)),
        "harmonic": solution(1.0, 100.0, bar=1e-3, section=(1.2, 99.0)),
    }
    verdict, validity = judged(solutions, 0.05)
    assert not validity["timoshenko"].valid and "like for like" in validity["timoshenko"].why_not
    assert any(
        "by luck" in s and "soft seats" in s and "cancel that at this seat width" in s
        for s in verdict.sentences
    )


def test_the_tie_is_told_apart_from_the_beam():
    # 12 % off at seats that distort, 1 % like for like
    solutions = {
        "timoshenko": solution(0.88, section=(0.99, 100.0)),
        "harmonic": solution(bar=1e-3, section=(1.0, 100.0)),
    }
    verdict, validity = judged(solutions, 0.05)
    assert not validity["timoshenko"].valid
    assert any(
        "The seats, not the beam" in s and "12 %" in s and "1 %" in s for s in verdict.sentences
    )


def test_only_what_is_asked_is_judged():
    solutions = {"timoshenko": solution(0.8, 101.0), "harmonic": solution(bar=1e-3)}
    assert not judged(solutions, 0.05)[1]["timoshenko"].valid
    verdict, validity = judged(solutions, 0.05, quantities=("bending 1",))
    assert validity["timoshenko"].valid and verdict.judged == ["bending 1"]


def test_stiffnesses_are_shown_but_not_judged():
    solutions = {"timoshenko": solution(K_zz=2.0), "harmonic": solution(K_zz=1.0, bar=1e-3)}
    assert "K_zz" not in JUDGED
    assert any(
        g.quantity == "K_zz" and g.relative == 1.0 for g in deviations(solutions, "harmonic")
    )
    assert judged(solutions, 0.05)[1]["timoshenko"].valid


def test_solid_inside_the_bars_is_said_to_be_not_resolved():
    sentences = " ".join(
        judged({"harmonic": solution(bar=1e-3), "solid": solution(1.001, bar=1e-3)}, 0.05)[
            0
        ].sentences
    )
    assert "not resolved" in sentences and "agree" not in sentences
    sentences = " ".join(
        judged({"harmonic": solution(bar=1e-3), "solid": solution(1.01, bar=1e-3)}, 0.05)[
            0
        ].sentences
    )
    assert "not resolved" not in sentences and "beyond the error bars in C_zz" in sentences


def test_a_solid_without_bars_is_not_said_to_be_beyond_them():
    """One mesh of a solid may err by all of its gap; of several quantities some may have a bar."""
    alone = solution(1.01)
    said = " ".join(judged({"harmonic": solution(bar=1e-3), "solid": alone}, 0.05)[0].sentences)
    assert "beyond" not in said and "inside the error bars" not in said
    assert (
        "within 1 % of it in every judged number; it has no error bars, so it is not known which of both is off"
        in said
    )
    half = solution(1.01, 101.0, bar=1e-3)
    del half.error_bars[SCENE]["bending 1"]
    said = " ".join(judged({"harmonic": solution(bar=1e-3), "solid": half}, 0.05)[0].sentences)
    assert "beyond the error bars in C_zz; it has no error bar for bending 1" in said


# --------------------------------------------------------------------------- no evidence, no verdict
def test_beams_alone_are_not_judged():
    for solutions in ({"euler": solution(0.9)}, {"euler": solution(0.9), "timoshenko": solution()}):
        verdict, validity = judged(solutions, 0.05)
        assert verdict.trust is verdict.cheapest is None
        assert verdict.sentences == ["Not judged: no solid was run, and a beam has no error bar."]
        assert all(not v.valid and v.open for v in validity.values())


def test_a_solid_without_a_bar_judges_nobody():
    lost = solution()
    lost.failed["finer mesh"] = "9 MB are free"
    verdict, validity = judged({"timoshenko": solution(), "harmonic": lost}, 0.05)
    assert verdict.trust is None and "no error bar (9 MB are free)" in verdict.sentences[0]
    assert (
        not validity["timoshenko"].valid
        and validity["timoshenko"].open
        and not validity["harmonic"].valid
    )


@pytest.mark.parametrize("bar", [0.06, 6.0])
def test_a_bar_above_the_tolerance_is_never_valid(bar):
    verdict, validity = judged({"timoshenko": solution(), "harmonic": solution(bar=bar)}, 0.05)
    assert (
        verdict.trust is None
        and not validity["harmonic"].valid
        and not validity["timoshenko"].valid
    )
    assert not any("Trust" in s for s in verdict.sentences)


def test_the_3d_solid_judges_where_the_harmonic_one_is_missing():
    verdict, validity = judged({"timoshenko": solution(0.97), "solid": solution(bar=1e-3)}, 0.05)
    assert verdict.trust == "solid" and validity["timoshenko"].valid
    assert verdict.sentences[0].startswith("Trust the 3D solid: own error")


def test_a_guard_that_says_avoid_is_heard():
    notice = GuardRecord(level="avoid", models=["timoshenko"], sentence="sections lose their shape")
    solutions = {"timoshenko": solution(), "harmonic": solution(bar=1e-3)}
    verdict, validity = judged(solutions, 0.05, notices=[notice])
    assert (
        not validity["timoshenko"].valid
        and validity["timoshenko"].why_not == "sections lose their shape"
    )
    assert verdict.cheapest == "harmonic"
    # a caution is told and does not decide
    assert judged(solutions, 0.05, notices=[notice.model_copy(update={"level": "caution"})])[1][
        "timoshenko"
    ].valid


def test_nothing_solved():
    verdict, validity = judge(asking(0.05), {}, [])
    assert (
        verdict.trust is verdict.cheapest is None
        and verdict.sentences == ["No model could be solved."]
        and validity == {}
    )


# --------------------------------------------------------------------------- on shafts
def plain_shaft(**ask):
    """The simplest shaft there is: 300 x 40 mm on two equal bearings, the lumped point in the
    middle of all of its surface.
    """
    bearings = [
        Bearing(name=n, y=y, seat_width=0.02, stiffness={"kxx": 3e8, "kzz": 3e8, **k})
        for n, y, k in (("A", 0.03, {"kyy": 1e8}), ("B", 0.27, {}))
    ]
    return Scene.from_parts(
        [Segment.cylinder("s", length=0.3, diameter=0.04)], bearings=bearings, ask=Ask(**ask)
    )


@pytest.mark.long
def test_a_plain_symmetric_shaft_is_within_every_models_reach():
    found = compare(plain_shaft(), ("timoshenko", "harmonic")).results
    models, gaps = (
        found["models"],
        {(g["attachment"], g["quantity"]): g["relative"] for g in found["deviations"]},
    )
    assert (
        found["verdict"]["trust"] == "harmonic"
        and models["harmonic"]["valid"]
        and models["timoshenko"]["valid"]
    )
    # symmetry makes the coupling zero: its bar and its gap are shares of what it could be
    assert (
        models["harmonic"]["band"]["each"]["C_z,thx"] < 1e-4
        and abs(gaps[(SCENE, "C_z,thx")]) < 1e-4
    )
    assert models["harmonic"]["band"]["compliance"] < 0.05 / 20
    # a beam tied to a span of 300 mm as the solid is: 0.3 % in tilt, where its node alone was 650 %
    # off
    assert abs(gaps[(SCENE, "C_thx")]) < 0.005 and abs(gaps[(SECTION, "C_thx")]) < 0.015


@pytest.mark.long
def test_like_for_like_means_every_station():
    # the port is tied by its section and a bearing rigidly: ties of the port alone would leave
    # nothing to compare
    scene = plain_shaft(tolerance=0.01)
    scene = scene.with_port(attachment="section")
    scene = scene.with_changes(
        bearings=(scene.bearings[0], scene.bearings[1].with_changes(attachment="rigid"))
    )
    light = {"harmonic": {"order": 3, "layers": 1}}
    found = compare(scene, ("euler", "harmonic"), settings=light).results
    assert {g["attachment"] for g in found["deviations"]} == {SCENE, SECTION}
    # Euler lacks the shear deflection, 12 (1 + nu) / kappa r^2 / L^2 of a span of 240 mm: about 5 %
    assert not found["models"]["euler"]["valid"]
