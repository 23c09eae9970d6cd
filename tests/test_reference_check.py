"""A 3D solid that checks a reference, and ends when its numbers say enough about it."""

import re
from functools import cache
from types import SimpleNamespace

import pytest

from solidgear.comparison.models import _checked, compare
from solidgear.comparison.recording import Findings, recorded
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.deviations import WITHIN, deviations, select_gaps
from solidgear.core.judge.quantities import JUDGED
from solidgear.core.judge.reference_check import ReferenceCheck
from solidgear.core.judge.refinement import Refinement, Solved, refine
from solidgear.core.judge.solving import Numbers
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import SCENE
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.memory import NoRoom
from solidgear.core.quantity import Quantity
from solidgear.core.scene import Ask, Bearing, Scene, Segment
from tests.test_verdict import solution

C_ZZ, BENDING = Quantity("C_zz"), Quantity("bending 1")
TOLERANCE = 0.02


def shaft(**ask):
    """A step between two bearings: the first hexahedra leave bars of 2.1 %, and err by 1.4 %."""
    segments = [
        Segment.cylinder("thin", length=0.06, diameter=0.03),
        Segment.cylinder("thick", y0=0.06, length=0.05, diameter=0.05),
    ]
    bearings = [
        Bearing(name=n, y=y, seat_width=0.015, stiffness={"kxx": 3e8, "kyy": 1e8, "kzz": 3e8})
        for n, y in (("A", 0.015), ("B", 0.1))
    ]
    return Scene.from_parts(segments, bearings=bearings, ask=Ask(**{"tolerance": TOLERANCE} | ask))


@cache
def reference():
    return study(shaft(), "harmonic", evidence=False)


@cache
def solutions():
    solid = study(shaft(), "solid", evidence=False, reference=reference())
    return {"harmonic": reference(), "solid": solid}


# --------------------------------------------------------------------------- a whole comparison
def test_a_check_ends_at_a_mesh_whose_numbers_are_within_the_tolerance_of_the_reference():
    solid = solutions()["solid"]
    assert solid.check and not reference().check and len(solid.levels) == 1
    assert solid.worst_bar() > TOLERANCE
    gaps = select_gaps(deviations(solutions(), "harmonic"), "solid", JUDGED)
    assert {g.quantity for g in gaps} == set(JUDGED)
    assert all(g.standing(TOLERANCE) == WITHIN for g in gaps)


def test_a_check_shows_its_own_bar_and_is_called_a_check():
    record = recorded(shaft(), Findings(solutions()))
    solid = record.models["solid"]
    assert solid.valid and solid.band.compliance > TOLERANCE
    (sentence,) = (s for s in record.verdict.sentences if "is a check" in s)
    assert sentence == (
        "The 3D solid is a check: it ended at a mesh whose numbers are within 2 % of the harmonic "
        f"solid; its own error bar is wider, {100 * solutions()['solid'].worst_bar():.2g} %."
    )


def test_numbers_asked_for_are_compared_and_no_others():
    """First bending errs by 0.26 % with a bar of 0.37 %, C_thx by 1.4 %."""
    scene = shaft(tolerance=0.003, quantities=("bending 1",))
    solid = study(scene, "solid", evidence=False, reference=reference())
    assert solid.check and len(solid.levels) == 1


def test_a_solid_checks_the_harmonic_one_where_that_is_sure():
    sure, unsure = (solution(model="harmonic", bar=bar) for bar in (0.001, 0.1))
    assert _checked(shaft(), "solid", {"harmonic": sure}) is sure
    assert _checked(shaft(), "solid", {"harmonic": unsure}) is None
    assert _checked(shaft(), "timoshenko", {"harmonic": sure}) is None
    # a sector is a 3D mesh as well: its error is no other one
    assert _checked(shaft(), "solid", {"sector": solution(model="sector", bar=0.001)}) is None


def test_a_comparison_hands_its_reference_to_the_solid(monkeypatch):
    references = {}

    def studied(scene, model, options, *, reference, **others):
        references[model] = reference
        return solutions()[model]

    monkeypatch.setattr("solidgear.comparison.models.study", studied)
    compare(shaft(), ("harmonic", "solid"))
    assert references["harmonic"] is None
    assert references["solid"] is solutions()["harmonic"]


@pytest.mark.long
def test_a_mesh_that_statics_rule_out_is_passed_over():
    solid = study(shaft(tolerance=0.01), "solid", evidence=False, reference=reference())
    first, last = solid.levels
    assert BENDING not in first.quantities and solid.options["layers"] == 1
    assert last.dofs > first.dofs and BENDING in last.quantities
    assert solid.worst_bar() <= 0.01 and not solid.check


def test_a_first_harmonic_mesh_whose_statics_are_too_coarse_is_solved_for_no_modes(monkeypatch):
    scene = shaft(tolerance=0.01)
    asked = []

    def interrupt(text):
        asked.append(text)
        if sum(one.startswith("harmonic: order") for one in asked) == 2:
            raise KeyboardInterrupt

    harmonic = study(scene, "harmonic", evidence=False)
    first, last = harmonic.levels
    assert list(first.quantities) == [C_ZZ] and list(last.quantities) == [C_ZZ, BENDING]
    assert harmonic.worst_bar() <= 0.01 / LADDER["harmonic"].share
    with pytest.raises(
        KeyboardInterrupt, match=r"order 3, was solved for statics alone, in which C_"
    ):
        study(scene, "harmonic", evidence=False, progress=interrupt)


def test_an_interrupt_after_a_mesh_that_was_passed_over_leaves_what_that_mesh_showed(monkeypatch):
    def studied(scene, model, options, **others):
        return reference() if model == "harmonic" else study(scene, model, options, **others)

    def interrupt(text):
        if text.startswith("solid: layers"):
            meshes.append(text)
            if len(meshes) == 2:
                raise KeyboardInterrupt

    meshes = []
    monkeypatch.setattr("solidgear.comparison.models.study", studied)
    results = compare(shaft(tolerance=0.01), ("harmonic", "solid"), progress=interrupt).results
    assert results["complete"] is False and len(meshes) == 2
    shown = results["models"]["solid"]["why_not"]
    mesh = meshes[0].removeprefix("solid: ")
    assert shown.startswith(f"interrupted; its first mesh, {mesh}, was solved for statics alone")
    off = float(re.search(r"C_\w+ may be ([\d.]+) % from the harmonic solid", shown)[1])
    assert 1.0 < off < 3.0  # the tolerance, and twice what the shaft's first hexahedra err by


@pytest.mark.long
def test_without_a_reference_a_solid_goes_on_until_its_own_bars_are_narrow():
    alone = study(shaft(), "solid", evidence=False)
    assert len(alone.levels) == 2 and alone.worst_bar() <= TOLERANCE and not alone.check


# --------------------------------------------------------------------------- the distance of a number
def checking(base):
    """A check of a reference in C_zz and first bending, to 5 %."""
    return ReferenceCheck(base, (C_ZZ, BENDING), 0.05)


def test_a_number_is_as_far_from_the_reference_as_its_far_end():
    check = checking(solution(model="harmonic", bar=0.002))
    distances = check.distances(solution(0.97, 101.0, model="solid", bar=0.2))
    assert distances == pytest.approx({C_ZZ: 0.032, BENDING: 0.012})


def test_a_difference_is_shown_by_two_meshes_and_not_by_one():
    """The error bar of a coarse mesh may miss the truth; a difference of models stays."""
    check = checking(solution(model="harmonic", bar=0.002))
    coarse, fine = (solution(0.9, 101.0, model="solid", bar=bar) for bar in (0.08, 0.06))
    assert check.distances(coarse)[C_ZZ] == pytest.approx(0.102)
    assert check.distances(fine) == pytest.approx({C_ZZ: 0.0, BENDING: 0.012})
    # on the next mesh it is inside the bars: nothing was shown
    assert check.distances(solution(0.93, model="solid", bar=0.08))[C_ZZ] == pytest.approx(0.072)
    assert check.distances(fine)[C_ZZ] == pytest.approx(0.102)


def test_a_number_without_a_bar_of_the_reference_is_not_compared():
    base = solution(model="harmonic", bar=0.002)
    del base.error_bars[SCENE][C_ZZ]
    assert set(checking(base).distances(solution(model="solid", bar=0.2))) == {BENDING}


def test_a_frequency_without_a_bar_that_may_be_too_far_lets_the_meshes_go_on():
    check = checking(solution(model="harmonic", bar=0.002))
    for bending, distances in ((104.9, {}), (104.7, {C_ZZ: 0.002, BENDING: 0.049})):
        solid = solution(1.0, bending, model="solid", bar=0.2)
        del solid.error_bars[SCENE][BENDING]
        assert check.distances(solid) == pytest.approx(distances)


def test_statics_show_that_a_mesh_cannot_be_the_last():
    check = checking(solution(model="harmonic", bar=0.002))
    assert check.distances_beyond({C_ZZ: 0.93}) == pytest.approx({C_ZZ: 0.072})
    # at the near end of the error bar of the reference it may be within 5 %
    assert check.distances_beyond({C_ZZ: 0.949}) == check.distances_beyond({C_ZZ: 0.97}) == {}
    assert check.distances_beyond({}) == {}


def test_a_mesh_that_statics_rule_out_is_solved_where_there_is_no_room_for_a_finer_one(monkeypatch):
    """C_thx errs by 1.4 % on the first mesh, where 1 % is asked for."""
    layers = []

    def built(scene, model, **options):
        layers.append(options["layers"])
        if layers[-1]:
            raise NoRoom("9 MB are free", 99.0, 9.0)
        return build(scene, model, **options)

    monkeypatch.setattr("solidgear.core.judge.tied.build", built)
    solid = study(shaft(tolerance=0.01), "solid", evidence=False, reference=reference())
    assert layers == [0, 1, 0] and not solid.check
    assert "9 MB are free" in solid.failed["finer mesh"] and solid.worst_bar() > 0.01


# --------------------------------------------------------------------------- the list of meshes
class Scripted:
    """A solver with a given bar and distance of C_zz on each mesh."""

    def __init__(self, refinement, script):
        self.refinement, self.script = refinement, iter(script)

    def next_quantities(self):
        return self.refinement.wanted

    def solve(self, options):
        bar, distance = next(self.script)
        self.refinement.error_bars = {C_ZZ: ErrorBar(bar, bar, 1.0, 0.0, 1.0)}
        distances = {} if distance is None else {C_ZZ: distance}
        return Solved(SimpleNamespace(), Numbers({C_ZZ: 1.0}, {}), 10, None, distances)


def meshes_until_enough(script):
    """Numbers of the meshes of the list of hexahedra that are solved, to 1 %."""
    model = LADDER["solid"]
    plan = model.meshes_of(shaft(), {})
    refinement = Refinement(shaft(), model, (C_ZZ,), 0.01, plan)
    refine(refinement, Scripted(refinement, script), lambda _: None, "solid")
    return [plan.levels.index(step.options) for step in refinement.steps]


@pytest.mark.parametrize(
    ("script", "solved"),
    [
        ([(0.3, 0.009)], [0]),
        ([(0.3, 0.0)], [0]),
        ([(0.009, 0.5)], [0]),
        # mesh by mesh while the distance is near the tolerance, however wide the bars are
        ([(0.3, 0.02), (0.2, 0.009)], [0, 1]),
        # meshes that can be seen to be too coarse by bar and distance alike are passed over
        ([(0.3, 0.2), (0.009, 0.2)], [0, 2]),
        ([(0.3, None), (0.009, None)], [0, 3]),
    ],
)
def test_a_list_of_meshes_ends_by_the_bar_or_the_distance(script, solved):
    assert meshes_until_enough(script) == solved
