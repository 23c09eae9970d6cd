"""Claims of the thesis: the verdicts, and the figures they rest on."""

import pytest

from tests.charted import facts_of
from validation.thesis import claims, curves
from validation.thesis.claims import CAVEAT, CONFIRMED, NOT, OPEN

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
    "mesh_stiffness": OPEN,
    "masses": NOT,
}


@pytest.fixture(scope="module")
def judged():
    return {name: claim() for name, claim in FOUND.items()}


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
