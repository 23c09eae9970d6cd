"""Claims of the thesis: the verdicts, and the figures they rest on."""

import numpy as np
import pytest

import solidgear as sg
from tests.charted import facts_of
from validation.thesis import claims, contact, curves
from validation.thesis.claims import CAVEAT, CONFIRMED, NOT, OPEN
from validation.thesis.lumped_pair import shaft_stiffness
from validation.thesis.pair import DATA

FOUND = {claim.__name__: claim for claim in claims.CLAIMS}
VERDICTS = {
    "old_synthesis": CONFIRMED,
    "new_synthesis": CAVEAT,
    "damping": NOT,
    "peak_at_800": CAVEAT,
    "bending_leaves": CONFIRMED,
    "moments": CAVEAT,
    "pinion_motion": CAVEAT,
    "amplitude": OPEN,
    "mesh_point_still": CONFIRMED,
    "line_of_action_still": CONFIRMED,
    "stiffness_by_pilot": CONFIRMED,
    "close_pilot_counts_more": NOT,
    "span_with_pilot": CONFIRMED,
    "span_without_pilot": CAVEAT,
    "pilot_stiffens": CONFIRMED,
    "stiffness_without_shafts": NOT,
    "stiffness_level": OPEN,
    "mesh_stiffness": NOT,
    "masses": NOT,
}


@pytest.fixture(scope="module")
def judged():
    """Claims by mesh cycles of a quarter of the places that the page takes, which every verdict outlives."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(contact, "POSITIONS", contact.POSITIONS // 4)
        yield {name: claim() for name, claim in FOUND.items()}
    contact.contact.cache_clear()


def test_every_claim_has_its_verdict(judged):
    assert {name: claim.verdict for name, claim in judged.items()} == VERDICTS


def test_the_page_holds_these_verdicts(judged):
    text = claims.PAGE.read_text(encoding="utf-8")
    for claim in judged.values():
        assert f"| {claim.place} | {claim.says} | **{claim.verdict}** |" in text


def test_every_verdict_leads_to_the_curve_it_rests_on():
    text = claims.PAGE.read_text(encoding="utf-8")
    assert all(callable(getattr(curves, name)) for name in FOUND)
    for k in range(1, len(FOUND) + 1):
        row = next(line for line in text.splitlines() if f"(#claim-{k})" in line)
        assert row.startswith("| ") and f"\n## Claim {k}\n" in text
        assert f"](claim_{k}.png)" in text and claims.PAGE.with_name(f"claim_{k}.png").is_file()


@pytest.mark.long
def test_a_curve_shows_the_numbers_of_its_verdict(judged):
    told = judged["bending_leaves"].numbers
    for case, key in (("A: 2-bearing", "identified 2"), ("B: 3-bearing", "identified 3")):
        shares = [
            float(fact["pinion bending"].split()[0]) / 100
            for name, fact in facts_of(curves.bending_leaves(1000.0).svg())
            if name.startswith(case)
            and "pinion bending" in fact
            and float(fact["frequency"].split()[0]) < 1000.0
        ]
        assert sum(shares) == pytest.approx(told[key], abs=0.005)  # each is told to 0.1 %


def test_the_effective_masses_hold_below_and_not_above(judged):
    numbers = judged["new_synthesis"].numbers
    assert numbers["real solutions"] == 0
    assert numbers["low"] < 0.02 and numbers["high"] > 0.2
    assert numbers["overhung matched"] == pytest.approx(numbers["overhung FE"], rel=1e-9)
    assert numbers["straddled first"] == 0.0


def test_the_peak_moves_left_and_grows_with_the_identified_mesh_stiffness_only(judged):
    numbers = judged["peak_at_800"].numbers
    # read off figure 3.7 and printed as modes: 830 and 794 Hz
    assert numbers["identified 2"] == pytest.approx(830.2, rel=0.01)
    assert numbers["identified 3"] == pytest.approx(793.9, rel=0.02)
    assert numbers["identified growth"] > 0.1 and numbers["published masses growth"] > 0
    assert numbers["plotted mesh stiffness growth"] < 0


def test_the_word_moment_decides(judged):
    numbers = judged["moments"].numbers
    assert numbers["identified 2-bearing alone"] > 5 * numbers["identified 3-bearing alone"]
    assert numbers["identified 2-bearing row"] < 0.1 * numbers["identified 3-bearing row"]


def test_the_pinion_moves_less_at_low_frequency_but_tilts_more_above(judged):
    numbers = judged["pinion_motion"].numbers
    assert numbers["identified x"] < 0.2 and numbers["identified thx"] < 0.02
    assert numbers["identified thz above"] > 1


def test_the_axes_leave_two_micrometres_at_most(judged):
    numbers = judged["amplitude"].numbers
    assert 1.5e-6 < numbers["identified"] < 2.5e-6


def test_masses_and_geometry_of_table_1_are_of_two_rotors(judged):
    numbers = judged["masses"].numbers
    assert numbers["pinion mass"] == pytest.approx(15.91, abs=0.01)
    assert numbers["pinion torsional"] == pytest.approx(0.0202, abs=1e-4)
    assert numbers["gear mass"] == pytest.approx(79.82, abs=0.01)


# ---------------------------------------------------------------- teeth in contact
def test_mountings_of_table_1_have_the_published_stiffness():
    for mounting, key in ((contact.TWO, "2-bearing"), (contact.THREE, "3-bearing")):
        scene = mounting.scene
        ours = sg.condense(sg.build(scene, "euler"), scene, "pinion").stiffness
        published = shaft_stiffness(**DATA["support"][key])
        assert ours == pytest.approx(published, rel=5e-3, abs=1e3)


def test_a_compliance_at_the_apex_is_that_of_the_shaft():
    """A force at the mesh point moves it by what the shaft does at its lumped point."""
    stiffness = shaft_stiffness(**DATA["support"]["2-bearing"])
    stiffness[4, 4] = 1e30
    place, point = 0.185, np.array([-0.06, 0.18, -0.005])
    normal = np.array([0.24, 0.54, 0.80])
    row = np.concatenate([normal, np.cross(point, normal)])
    lumped = np.concatenate([normal, np.cross(point - [0.0, place, 0.0], normal)])
    moved = row @ contact.at_apex(stiffness, place) @ row
    assert moved == pytest.approx(lumped @ np.linalg.solve(stiffness, lumped), rel=1e-9)


def test_mesh_point_and_line_of_action_are_those_of_the_plots():
    """Read off figures 3.11 and 3.15: within 6 mm and 0.03."""
    cycle = contact.contact("200 N m, 300 um", contact.THREE)
    assert cycle.points.mean(axis=0) == pytest.approx(DATA["plotted"]["mesh_point"], abs=6e-3)
    line = cycle.lines_of_action.mean(axis=0)
    assert line == pytest.approx(DATA["plotted"]["line_of_action"], abs=0.03)


def test_the_published_stiffness_has_the_supports_in_it(judged):
    """Taken out in series, they leave the teeth: so a train with shafts counts them twice."""
    numbers = judged["stiffness_without_shafts"].numbers
    for way in contact.WAYS:
        for mounting in ("two bearings", "three"):
            teeth, series = (numbers[f"{way} {mounting} {key}"] for key in ("teeth", "series"))
            assert series == pytest.approx(teeth, rel=0.02)
            assert numbers[f"{way} {mounting}"] < 0.85 * teeth
        assert numbers[f"{way} tangent"] > 1.3 * numbers[f"{way} secant"]


def test_what_a_pilot_changes_is_not_the_teeth(judged):
    numbers = judged["mesh_stiffness"].numbers
    for way in contact.WAYS:
        assert numbers[f"{way} k_m"] > 0.04
        assert abs(numbers[f"{way} teeth"]) < 0.2 * numbers[f"{way} k_m"]


def test_torque_and_ease_off_decide_the_level(judged):
    levels = list(judged["stiffness_level"].numbers.values())
    assert max(levels) > 2.5 * min(levels)
    assert min(levels) < 3.2e8 < max(levels)
