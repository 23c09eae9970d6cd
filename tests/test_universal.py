"""Universal files: mode shapes and responses of test equipment, and shapes held against modes."""

from __future__ import annotations

import numpy as np
import pytest
from universal_files import mode, nodes, response, units, written

import solidgear as sg
from solidgear.core.errors import SceneError, SolidgearError
from solidgear.measured.computed import computed_up_to
from solidgear.measured.correlate import correlate
from solidgear.measured.data import load_measured
from solidgear.measured.shapes import OnPoints
from solidgear.measured.universal import Shapes, read_universal

pytest.importorskip("pyuff")

#: places of points on the rod of 0.6 m by 20 mm, x, y, z, mm
PLACES = np.array(
    [[10.0 * c, y, 10.0 * s] for y in np.linspace(0, 600, 9) for c, s in ((1, 0), (0, 1))]
)


def test_shapes_come_back_as_written_in_si_by_ascending_frequency(tmp_path):
    shapes = np.random.default_rng(1).standard_normal((2, len(PLACES), 3))
    path = written(
        tmp_path / "a.unv",
        units(),
        nodes(PLACES),
        mode(1, 700.0, shapes[0]),
        mode(2, 250.0, shapes[1]),
    )
    found = load_measured(path)
    assert [one.frequency for one in found.modes] == [250.0, 700.0]
    assert found.on_points.points == pytest.approx(PLACES / 1e3)
    # the format keeps six digits
    assert found.on_points.values == pytest.approx(shapes[::-1], rel=1e-5)


def test_responses_come_back_in_si_over_one_axis(tmp_path):
    hertz = np.linspace(10.0, 1000.0, 100)
    values = np.random.default_rng(2).standard_normal((3, 100, 2)) @ [1, 1j]
    sets = [response(k + 1, hertz, one) for k, one in enumerate(values)]
    found = read_universal(written(tmp_path / "a.uff", units(), *sets))
    assert found.frequencies == pytest.approx(hertz) and found.points[2] == (3, 1)
    # mm/s^2 over mN are m/s^2 over N
    assert found.values == pytest.approx(values)


def test_bad_files_end_in_one_sentence(tmp_path):
    shape = np.ones((len(PLACES), 3))
    cases = {
        "gives no position of point 18": (units(), nodes(PLACES[:-1]), mode(1, 250.0, shape)),
        "holds no mode shapes": (units(), nodes(PLACES)),
    }
    for told, sets in cases.items():
        with pytest.raises(SceneError, match=told):
            load_measured(written(tmp_path / "bad.unv", *sets))
    whole = written(tmp_path / "cut.unv", units(), nodes(PLACES), mode(1, 250.0, shape))
    whole.write_bytes(whole.read_bytes()[:-200])
    with pytest.raises(SceneError, match="is cut short"):
        load_measured(whole)


#: a rod as long that bending 4 and torsion 1 lie 1 % from each other, m
LENGTH, RADIUS = 0.497, 0.01
#: points on it, of which no three of one angle lie on nodes
ROUND = np.array([[c, s] for c, s in ((1, 0), (0, 1), (-0.6, 0.8))])
ON = np.array([[RADIUS * c, y, RADIUS * s] for y in np.linspace(0.0, LENGTH, 11) for c, s in ROUND])


def bent(n):
    """Bending of a free slender rod in a plane at 40 degrees (Blevins, Formulas, table 8-1)."""
    k = {1: 4.73004, 2: 7.85320, 3: 10.99561, 4: 14.13717}[n]
    sigma = (np.cosh(k) - np.cos(k)) / (np.sinh(k) - np.sin(k))
    x = k * ON[:, 1] / LENGTH
    across = np.cosh(x) + np.cos(x) - sigma * (np.sinh(x) + np.sin(x))
    plane = np.array([np.cos(0.7), 0.0, np.sin(0.7)])
    return across[:, None] * plane


def twisted():
    """Torsion of a free rod, tangential."""
    angle = np.cos(np.pi * ON[:, 1] / LENGTH)
    return angle[:, None] * np.column_stack([ON[:, 2], 0 * angle, -ON[:, 0]]) / RADIUS


def rod_scene():
    return sg.Scene.from_parts([sg.Segment.cylinder("rod", length=LENGTH, diameter=2 * RADIUS)])


@pytest.mark.long
def test_two_near_modes_that_changed_places_are_told_by_their_shapes(tmp_path):
    scene = rod_scene()
    computed = computed_up_to(scene, 3300.0, 0.02)
    at = {str(one.name): one.frequency_hz for one in computed.modes}
    assert at["torsion 1"] == pytest.approx(at["bending 4"], rel=0.03)
    # each has the frequency of the other
    shapes = [
        (at["bending 1"], bent(1), "bending 1"),
        (at["bending 2"], bent(2), "bending 2"),
        (at["bending 3"], bent(3), "bending 3"),
        (at["torsion 1"], bent(4), "bending 4"),
        (at["bending 4"], twisted(), "torsion 1"),
    ]
    sets = [mode(k, hertz, shape) for k, (hertz, shape, _) in enumerate(shapes, start=1)]
    path = written(tmp_path / "rod.unv", units(), nodes(1e3 * ON), *sets)
    found = correlate(scene, load_measured(path), tol=0.02)
    shapes.sort(key=lambda one: one[0])
    assert [pair.computed.name for pair in found.pairs] == [name for *_, name in shapes]
    # a slender rod's closed forms; shear and the rod's own turning change bending 4 by a little
    assert all(pair.mac > 0.97 for pair in found.pairs)
    assert all(pair.probability > 0.95 for pair in found.pairs)


@pytest.mark.long
def test_some_resonances_have_shapes_and_others_none(tmp_path):
    """Bending 4 and torsion 1, 1 % apart, in the places of each other: only one has a shape."""
    sets = [mode(k, hertz, bent(n)) for k, hertz, n in ((1, 345.0, 1), (2, 3200.0, 4))]
    written(tmp_path / "rod.unv", units(), nodes(1e3 * ON), *sets)
    at = {str(m.name): m.frequency_hz for m in computed_up_to(rod_scene(), 3300.0, 0.02).modes}
    lower, upper = sorted((at["bending 4"], at["torsion 1"]))
    # the shape of bending 4 at the frequency of torsion 1
    first = at["bending 4"] < at["torsion 1"]
    listed = [(at["bending 1"], 1), (at["bending 2"], 0), (at["bending 3"], 0)]
    listed += [(lower, 0 if first else 2), (upper, 2 if first else 0)]
    lines = ", ".join(
        f"{{ frequency = {hertz:.6g}{f', shape = {k}' if k else ''} }}" for hertz, k in listed
    )
    path = tmp_path / "peaks.toml"
    path.write_text(f'shapes = "rod.unv"\nnoise = "3 %"\nuncertainty = "0.1 %"\nmode = [{lines}]')
    found = correlate(rod_scene(), load_measured(path), tol=0.02)
    assert [pair.mac is not None for pair in found.pairs] == [bool(shape) for _, shape in listed]
    last = ["torsion 1", "bending 4"] if first else ["bending 4", "torsion 1"]
    assert [str(pair.computed.name) for pair in found.pairs[3:]] == last
    path.write_text(path.read_text().replace("shape = 2", "shape = 3"))
    with pytest.raises(SceneError, match=r"rod.unv holds 2 shapes"):
        load_measured(path)
    (tmp_path / "rod.unv").write_text("no datasets")
    with pytest.raises(SceneError, match=r"rod.unv: is not a universal file"):
        load_measured(path)
    path.write_text(path.read_text().replace('shapes = "rod.unv"', ""))
    with pytest.raises(SceneError, match="the file of the shapes is missing"):
        load_measured(path)


def test_points_that_do_not_tell_modes_apart_are_named_with_one_that_would(tmp_path):
    """Three points at one station see of every bending mode the same: that it moves across."""
    few = 3
    at = [k for k, y in enumerate(ON[:, 1]) if abs(y - ON[3, 1]) < 1e-9][:few]
    sets = [
        {**mode(k, hertz, bent(n)[at]), "node_nums": [1, 2, 3]}
        for k, (hertz, n) in enumerate(((430.0, 1), (1180.0, 2)), start=1)
    ]
    written(tmp_path / "few.unv", units(), nodes(1e3 * ON[at]), *sets)
    measured = load_measured(tmp_path / "few.unv")
    computed = computed_up_to(rod_scene(), 1200.0, 0.02)
    points = OnPoints(measured.on_points, 0.05, computed)
    one = points.confused(2)[0]
    assert (one.first, one.second) == (0, 1) and one.mac > 0.9 and one.mac_with_it < 0.1
    found = correlate(rod_scene(), measured, tol=0.02)
    told = [s for s in found.sentences if "do not distinguish bending 1 and bending 2" in s]
    assert told and "one more at x, y, z" in told[0]
    # the point that is named does what is said
    more = Shapes(np.arange(few + 1), np.vstack([ON[at], one.place]), np.ones((2, few + 1, 3)))
    again = OnPoints(more, 0.05, computed)
    assert not [c for c in again.confused(2) if c.mac > one.mac_with_it + 0.01]


def test_a_point_off_the_surface_is_named(tmp_path):
    places = ON.copy()
    places[4, 2] += 0.2 * RADIUS
    path = written(tmp_path / "off.unv", units(), nodes(1e3 * places), mode(1, 345.0, bent(1)))
    with pytest.raises(SolidgearError, match="measuring point 5 .* off the surface"):
        correlate(rod_scene(), load_measured(path), tol=0.02)
