"""Searches of a box: the least of several valleys, limits that are active, ends that are reached."""

import numpy as np
import pytest

import solidgear as sg
from solidgear.variants.optimise.optimise import FINE, search_box

#: a shaft with a disc at either end: bending 2 is high where bearing B stands beside either
DISCS = """
material = { E = "207 GPa", nu = 0.3, density = "7850 kg/m^3" }
segment = [
    { kind = "cylinder", name = "left", length = "60 mm", diameter = "120 mm" },
    { kind = "cylinder", name = "mid", length = "500 mm", diameter = "40 mm" },
    { kind = "cylinder", name = "right", length = "60 mm", diameter = "110 mm" },
]
bearing = [
    { name = "A", position = "250 mm", seat_width = "20 mm", stiffness = { kxx = "2e8 N/m", kyy = "2e8 N/m", kzz = "2e8 N/m" } },
    { name = "B", position = "350 mm", seat_width = "20 mm", stiffness = { kxx = "2e8 N/m", kzz = "2e8 N/m" } },
]
port = { at = "left.middle", attach_to = "left" }
"""


def best(dimension, goal, misses, begin):
    """Least number that was asked for where no limit is missed, its place, and how many were."""
    asked = []

    def kept(place):
        asked.append(np.array(place))
        return goal(place)

    search_box(dimension, kept, misses, np.array(begin))
    sound = [place for place in asked if all(miss(place) <= 0 for miss in misses)]
    place = min(sound, key=goal)
    return goal(place), place, len(asked)


def valleys(place):
    """The deeper valley is narrow and far from where the search begins."""
    x = place[0]
    return min(4 * (x - 0.2) ** 2, 6 * (x - 0.85) ** 2 - 0.1)


@pytest.mark.parametrize("misses", [[], [lambda place: place[0] - 2.0]], ids=["free", "limit"])
def test_the_deeper_of_two_valleys_is_found_from_the_other(misses):
    value, place, count = best(1, valleys, misses, [0.2])
    # an end of the search of a hundredth of the range: 6 * 0.01 ** 2
    assert value == pytest.approx(-0.1, abs=6e-4) and place[0] == pytest.approx(0.85, abs=0.01)
    assert count < 60


def test_a_search_goes_up_to_limits_that_are_active():
    """Least x + y with x y >= 1/4: both are one half there, and the limit holds the search."""
    value, place, _ = best(2, sum, [lambda p: 0.25 - p[0] * p[1]], [0.9, 0.9])
    assert value == pytest.approx(1.0, abs=4 * FINE)
    assert place == pytest.approx([0.5, 0.5], abs=0.05)  # along the limit the sum is flat


def test_an_end_that_is_best_is_reached_to_the_last_digit():
    limit = [lambda p: 0.3 - p[1]]
    _, place, _ = best(2, lambda p: p[1] - 0.05 * p[0], limit, [0.5, 0.5])
    assert place[0] == 1.0 and place[1] == pytest.approx(0.3, abs=2 * FINE)


def test_the_best_seat_of_a_shaft_is_beside_the_other_disc(tmp_path):
    """Going up from the file ends beside the right disc, at 510 Hz; beside the left one there is more."""
    path = tmp_path / "discs.toml"
    path.write_text(DISCS)
    vary = ["bearing.B.position=75 mm:540 mm"]
    beam = {"model": "timoshenko"}
    ends = sg.sweep(path, "bearing.B.position=75 mm,540 mm", n=4, one_at_a_time=True, **beam)
    left, right = (
        next(ends[f"f{j}_hz"][k] for j in range(1, 5) if ends[f"mode{j}"][k] == "bending 2")
        for k in (1, 2)
    )
    found = sg.optimise(path, vary, "max bending 2", **beam)
    assert found.best.value == pytest.approx(left, rel=1e-9) and left > 1.03 * right
    assert found.at_end == ("bearing.B.position",)
    assert "9 designs across the range" in " ".join(found.sentences)
