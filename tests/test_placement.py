"""Measuring points in frames of test equipment, and responses that say no unit."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest
from universal_files import header, mode, nodes, response, units, written

import solidgear as sg
from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.loading import scene_of
from solidgear.measured.data import load_measured
from solidgear.measured.placement import Places, PointsTable
from solidgear.measured.universal import Responses, read_universal

pytest.importorskip("pyuff")

STEPPED = """
material = "steel"
segment = [
    { kind = "cylinder", name = "a", length = "120 mm", diameter = "40 mm" },
    { kind = "cylinder", name = "b", length = "200 mm", diameter = "50 mm" },
]
port = { at = "b.middle", attach_to = "b" }
"""
PLAIN = STEPPED.replace("40 mm", "50 mm")
#: places on a line of the surface, m; steps and ends tell where along the axis they are
ALONG = np.array([0.0, 0.04, 0.08, 0.119, 0.15, 0.19, 0.23, 0.28, 0.32])
LINE = np.column_stack([np.where(ALONG < 0.12, 0.02, 0.025), ALONG, 0 * ALONG])
#: a tap test's axes, accelerances of two modes
HERTZ = np.arange(4.0, 6001.0, 4.0)
#: of test equipment whose x is along the shaft: (x, y, z) of the scene are (-y, x, z) of the file
SIDEWAYS = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])


def surface(text):
    scene = scene_of(tomllib.loads(text), "shaft.toml")
    return sg.build(scene, "harmonic", order=2).surface({})


@pytest.fixture(scope="module")
def stepped():
    return surface(STEPPED)


def accelerances(count=1):
    shares = np.linspace(0.3, 0.5, count)[:, None]
    poles = ((1496.4, 0.002), (3953.4, 0.002))
    one = sum(-(HERTZ**2) / (f**2 - HERTZ**2 + 2j * z * f * HERTZ) for f, z in poles)
    drawn = np.random.default_rng(1).standard_normal((count, len(HERTZ), 2)) @ [1, 1j]
    return shares * one + 1e-3 * drawn


@pytest.mark.parametrize(
    ("points", "length", "frame"),
    [
        (LINE, 1.0, (1.0, "y", 0.0)),
        (1e3 * LINE, None, (1e-3, "y", 0.0)),
        # dataset 164 says m
        (1e3 * LINE, 1.0, (1e-3, "y", 0.0)),
        (LINE @ SIDEWAYS.T, 1.0, (1.0, "x", 0.0)),
        (1e3 * LINE @ SIDEWAYS.T - [80.0, 0.0, 0.0], 1.0, (1e-3, "x", -0.08)),
        (LINE / 0.0254 + [0.0, 2.0, 0.0], None, (0.0254, "y", 0.0508)),
        (LINE * [1.0, -1.0, -1.0], 1.0, (1.0, "-y", 0.0)),
    ],
)
def test_the_frame_of_points_is_found_where_there_is_one_alone(stepped, points, length, frame):
    found, away = Places(points, length, stepped, revolved=True).frame(PointsTable())
    assert (found.unit, found.axis) == frame[:2]
    # a hundredth of the 1.25 mm within which a point is one of the surface
    assert found.origin == pytest.approx(frame[2], abs=2e-5) and away < 2e-5
    placed = found.placing.to_scene(points.T).T
    assert placed[:, 1] == pytest.approx(ALONG, abs=2e-5)


def test_what_is_stated_is_taken_and_the_rest_is_looked_for(stepped):
    shifted = 1e3 * LINE @ SIDEWAYS.T + [50.0, 0.0, 100.0]
    whole = PointsTable(unit="mm", axis="x", origin=["50 mm", "0 mm", "100 mm"])
    found, _ = Places(shifted, None, stepped, revolved=True).frame(whole)
    assert found.placing.to_scene(shifted.T).T == pytest.approx(LINE, abs=1e-12)
    part = PointsTable(axis="x")
    found, _ = Places(1e3 * LINE @ SIDEWAYS.T, None, stepped, revolved=True).frame(part)
    assert found.unit == 1e-3


def test_points_that_fit_in_several_ways_are_refused():
    """Points off the ends of a plain rod may be anywhere along it; with both ends it may be turned."""
    plain = surface(PLAIN)
    inner = np.array([[0.025, y, 0.0] for y in (0.1, 0.15, 0.2)])
    with pytest.raises(SolidgearError, match="at many places along the axis: write the origin"):
        Places(inner + [0.0, 1.0, 0.0], 1.0, plain, revolved=True).frame(PointsTable())
    with pytest.raises(SolidgearError, match="does not say its unit of length"):
        Places(7.3 * LINE, None, plain, revolved=True).frame(PointsTable())


def tap(path, *first, places=None, labels=("", "", ""), kinds=(12, 13), values=None, ways=(3, 3)):
    """A universal file of responses with words on its axes."""
    sets = [header(), *first] + ([] if places is None else [nodes(places)])
    for k, row in enumerate(accelerances(9) if values is None else values, start=1):
        axes = ("abscissa", "ordinate", "orddenom")
        words = {f"{axis}_axis_units_lab": word for axis, word in zip(axes, labels)}
        one = response(k, HERTZ, row) | words
        one |= {"ordinate_spec_data_type": kinds[0], "orddenom_spec_data_type": kinds[1]}
        sets.append(one | {"rsp_dir": ways[0], "ref_dir": ways[1]})
    return written(path, *sets)


def test_resonances_need_neither_unit_nor_places(tmp_path):
    measured = load_measured(tap(tmp_path / "a.uff", values=accelerances()))
    assert [m.frequency for m in measured.modes] == pytest.approx([1496.4, 3953.4], abs=0.1)
    assert measured.on_points is None and measured.remarks == ()
    bare = written(tmp_path / "b.unv", mode(1, 700.0, LINE), mode(2, 250.0, LINE))
    shapes = load_measured(bare)
    assert [m.frequency for m in shapes.modes] == [250.0, 700.0] and shapes.on_points is None
    assert "no positions of its points" in shapes.remarks[0]


@pytest.mark.parametrize(
    ("labels", "size", "derivatives"),
    [
        (("Hz", "mm/s^2", "N"), 1e-3, 2),
        (("Hz", "g", "lbf"), 9.80665 / 4.4482216152605, 2),
        (("Hz", "m/s", "kN"), 1e-3, 1),
        (("Hz", "µm", "N"), 1e-6, 0),
        (("Hz", "EU", "N"), None, None),
        (("Hz", "", ""), None, None),
    ],
)
def test_labels_of_axes_say_the_unit_where_dataset_164_is_not_there(
    tmp_path, labels, size, derivatives
):
    read = read_universal(tap(tmp_path / "a.uff", labels=labels, kinds=(0, 0)))
    assert (read.scaled, read.derivatives) == (size is not None, derivatives)
    assert read.values == pytest.approx((size or 1.0) * accelerances(9), rel=1e-6)


def test_a_file_that_contradicts_itself_is_called_so(tmp_path):
    path = tap(tmp_path / "a.uff", units(1, 1.0, 1.0), labels=("Hz", "g", "N"))
    assert "one of them is wrong" in read_universal(path).remarks[0]
    kilo = tap(tmp_path / "b.uff", labels=("kHz", "m/s^2", "N"), values=accelerances())
    read = read_universal(kilo)
    assert read.frequencies == pytest.approx(1e3 * HERTZ)
    assert read.remarks == ("Frequencies are in kHz, as the label of their axis says.",)


def test_a_table_says_what_the_file_does_not(tmp_path, stepped):
    tap(tmp_path / "tap.uff", places=1e3 * LINE @ SIDEWAYS.T)
    path = tmp_path / "tap.toml"
    path.write_text(
        'file = "tap.uff"\nresponse_unit = "mm/s^2/N"\nuncertainty = "0.1 %"\n'
        'points = { unit = "mm", axis = "x" }\n'
    )
    measured = load_measured(path)
    assert measured.modes[0].uncertainty == (1e-3, "relative")
    placed = measured.placed(stepped, revolved=True)
    assert placed.on_points.points == pytest.approx(LINE, abs=1e-12)
    responses = placed.responses.responses
    assert responses.values == pytest.approx(1e-3 * accelerances(9), rel=1e-6)
    # also where the file says otherwise
    tap(tmp_path / "tap.uff", units(1, 1.0, 1.0), places=LINE, labels=("Hz", "g", "N"))
    path.write_text('file = "tap.uff"\nresponse_unit = "mm/s^2/N"\n')
    again = load_measured(path)
    assert again.responses.responses.values == pytest.approx(responses.values)
    assert again.remarks == ()
    # nothing is left to be told
    assert placed.remarks == ()
    path.write_text('file = "tap.uff"\nresponse_unit = "bar"\n')
    with pytest.raises(SceneError, match="must be a motion over a force"):
        load_measured(path)
    path.write_text('file = "tap.uff"\nmode = [{ frequency = "3 Hz" }]\n')
    with pytest.raises(SceneError, match="either the file of all resonances, or a list"):
        load_measured(path)


def test_directions_turn_with_the_axis_and_what_is_found_is_said(tmp_path, stepped):
    """Tapped along -x of the scene, which is +y of a file whose x is along the shaft."""
    path = tap(tmp_path / "tap.uff", units(5), places=1e3 * LINE @ SIDEWAYS.T, ways=(2, -3))
    placed = load_measured(path).placed(stepped, revolved=True)
    responses: Responses = placed.responses.responses
    assert set(responses.points) == {(k, -1) for k in range(1, 10)}
    assert set(responses.references) == {(1, -3)}
    shapes = placed.on_points.values
    assert shapes[..., 0] == pytest.approx(-placed.responses.fit.residues)
    assert not shapes[..., 1:].any()
    said = 'by points = { unit = "mm", axis = "x" }.'
    assert (
        placed.remarks[-1].startswith("Measuring points were placed") and said in placed.remarks[-1]
    )
    # once placed they stay
    assert placed.placed(stepped, revolved=True).on_points.points == pytest.approx(
        placed.on_points.points
    )
