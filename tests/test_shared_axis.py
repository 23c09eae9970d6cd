"""The axis of a part is found wherever it lies, and told as a file wants it."""

import re

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.meshing.placing import turn_of
from solidgear.parts.part import shared_axis
from validation.step_parts import shaft_step, write_step

SCENE = """
material = "steel"
[body]
step = "part.step"
{given}
[port]
name = "gear"
at = "s2.middle"
attach_to = "s2"
"""
ALONG = np.array([2.0, -1.0, 2.0]) / 3


def triangles_of_a_stepped_shaft():
    """Corners on cylinders of three diameters about y, and a block beside them that is round about nothing."""
    turn = 2 * np.pi * np.arange(30) / 30
    here, there = np.arange(30), (np.arange(30) + 1) % 30
    points, triangles = [], []
    for low, high, radius in ((0, 60, 20), (60, 110, 30), (110, 180, 22.5)):
        ring = np.array([radius * np.cos(turn), 0 * turn + low, radius * np.sin(turn)])
        start = 60 * len(points)
        points.append(np.hstack([ring, ring + [[0], [high - low], [0]]]))
        triangles += [start + np.array([here, there, 30 + here])]
        triangles += [start + np.array([there, 30 + there, 30 + here])]
    block = np.array([[30, 50, 20], [40, 55, 20], [33, 90, 28], [60, 40, 70]]).T
    faces = np.array([[0, 1, 2], [0, 2, 3], [1, 2, 3], [0, 1, 3]]).T + 180
    return np.hstack([*points, block]) * 1e-3, np.hstack([*triangles, faces])


def test_the_axis_that_cylinders_share_is_found_to_the_last_digits():
    """Whatever else there is of the surface: 1e-9 of the size, a ten-thousandth of what seats ask for."""
    points, triangles = triangles_of_a_stepped_shaft()
    back, at = np.array(turn_of(tuple(ALONG))).T, np.array([0.2, -0.1, 0.7])
    foot, along = shared_axis(back @ points + at[:, None], triangles)
    assert abs(along @ ALONG) == pytest.approx(1, abs=1e-15)
    assert np.linalg.norm(np.cross(along, ALONG)) < 1e-9
    assert np.linalg.norm(np.cross(foot - at, ALONG)) < 1e-9 * 0.18


@pytest.mark.long
def test_what_is_told_of_an_oblique_part_reads_it(tmp_path):
    """Out of an assembly, of which the file says no more: the sentence has the axis and the point to
    write, and with both the segments are those that were drawn.
    """
    segments = shaft_step()[0]
    turn = np.array(turn_of(tuple(ALONG))).T
    write_step(tmp_path / "part.step", segments, turn=turn, shift=(0.123, -0.0567, 0.089))
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(given=""))
    with pytest.raises(sg.SceneError) as error:
        sg.load(path)
    said = re.search(r"about (\[.*?\]) through \((.*?)\) mm: write that point", str(error.value))
    assert said, error.value
    places = ", ".join(f'"{v} mm"' for v in said[2].split(", "))
    path.write_text(SCENE.format(given=f"axis = {said[1]}\norigin = [{places}]"))
    scene = sg.load(path)
    assert scene.body.round
    for name in ("y0", "y1", "outer0", "outer1"):
        found = [getattr(s, name) for s in scene.segments]
        assert found == pytest.approx([getattr(s, name) for s in segments], abs=1e-8), name


@pytest.mark.parametrize("axis", ["[0, 0, 0]", "[1, 2]", '["1", 0, 0]', "[inf, 0, 0]", '"w"'])
def test_an_axis_that_is_none_is_refused(axis, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(given=f"axis = {axis}"))
    with pytest.raises(sg.SceneError, match=r"body\.axis"):
        sg.load(path)


@pytest.mark.long
def test_an_axis_a_little_beside_the_one_that_is_written_is_taken_and_told(tmp_path):
    """0.7 um is more than seats of 30 mm allow; the mesh then lies about the axis of the part."""
    write_step(tmp_path / "part.step", shaft_step()[0], shift=(7e-7, 0, 0))
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(given=""))
    scene = sg.load(path)
    assert scene.body.foot == pytest.approx((7e-7, 0, 0), abs=1e-10)
    assert any(
        "lies 0.7 um beside y of the file" in doubt for doubt in scene.body.doubts(scene.material)
    )
