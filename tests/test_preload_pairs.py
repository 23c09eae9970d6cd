"""A preload that one of two bearings is told is that of both."""

import numpy as np
import pytest

from solidgear.bearings.solved import AS_STATED, Choice, catalogued_bearings, partners, solved
from solidgear.core.errors import SceneError
from solidgear.core.scene.file import load

ROD = """material = "steel"
{words}
segment = [{{ kind = "cylinder", name = "rod", length = "300 mm", diameter = "40 mm" }}]
port = {{ name = "gear", at = "rod.middle", span = ["140 mm", "160 mm"] }}
"""
ROW = """[[bearing]]
name = "{name}"
position = {y}
seat_width = "18 mm"
catalogue = {{ designation = "{designation}"{more} }}
"""
PAIR = (("A", 0.05, "32208"), ("B", 0.25, "30208"))


def shaft(tmp_path, *more, rows=PAIR, words='arrangement = "O"'):
    path = tmp_path / "shaft.toml"
    keys = ("name", "y", "designation")
    told = (ROW.format(**dict(zip(keys, row)), more=own) for row, own in zip(rows, more))
    path.write_text(ROD.format(words=words) + "".join(told))
    return load(path)


def pressed(scene, choice=AS_STATED):
    """Axial force of each bearing at rest, N."""
    return {
        n: one.bearing.load(np.zeros(6))[1] for n, one in catalogued_bearings(scene, choice).items()
    }


FORCE = ', preload = "2 kN"'


@pytest.mark.parametrize("told", [(FORCE, ""), ("", FORCE)])
def test_a_force_that_one_is_told_presses_both(tmp_path, told):
    one, both = shaft(tmp_path, *told), shaft(tmp_path, FORCE, FORCE)
    force = pressed(one)
    assert force["A"] == pytest.approx(-force["B"], rel=1e-9)
    assert abs(force["A"]) == pytest.approx(2000.0, rel=1e-9)
    for here, there in zip(solved(one).scene.bearings, solved(both).scene.bearings):
        assert np.allclose(here.stiffness, there.stiffness, rtol=1e-9)


def test_a_displacement_that_one_is_told_is_that_of_both_together(tmp_path):
    """Each row takes what presses it as the other is pressed: softer ones give more."""
    scene = shaft(tmp_path, ', preload = "20 um"', "")
    force = pressed(scene)
    assert force["A"] == pytest.approx(-force["B"], rel=1e-6)
    given = [one.bearing.rows[0].preload for one in catalogued_bearings(scene).values()]
    assert sum(given) == pytest.approx(20e-6, rel=1e-9) and given[0] != pytest.approx(given[1])


def test_its_range_is_that_of_both(tmp_path):
    scene = shaft(tmp_path, FORCE, "")
    force = pressed(scene, Choice(overrides={"A": Choice(preload=0.5)}))
    assert force["A"] == pytest.approx(-force["B"], rel=1e-9)
    assert abs(force["A"]) == pytest.approx(1000.0, rel=1e-9)


def test_forces_that_differ_are_refused(tmp_path):
    with pytest.raises(SceneError, match="2000 N at 'A' and 1000 N at 'B'; give it once"):
        shaft(tmp_path, FORCE, ', preload = "1 kN"')


def test_a_pair_without_any_is_asked_for_one(tmp_path):
    with pytest.raises(SceneError, match=r"a preload \(once for both of a pair\)"):
        solved(shaft(tmp_path, "", ""))


ROWS = (("A", 0.03, "7208 B"), ("B", 0.06, "7208 B"), ("C", 0.24, "7208 B"), ("D", 0.27, "7208 B"))
UP, DOWN = ', holds = "+y"', ', holds = "-y"'


@pytest.mark.parametrize(
    ("told", "taken"),
    [
        ((UP + FORCE, DOWN, UP + FORCE, DOWN), {"B": "A", "D": "C"}),
        ((UP + FORCE, DOWN + FORCE, UP, DOWN), {}),
        ((UP, DOWN, UP, DOWN), {}),
        ((UP + FORCE, UP, UP, UP), {}),
    ],
)
def test_of_several_the_nearest_that_holds_the_other_way_takes_it(tmp_path, told, taken):
    assert partners(shaft(tmp_path, *told, rows=ROWS, words="")) == taken
