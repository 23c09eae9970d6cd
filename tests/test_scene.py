"""The scene says what its file says: positions, stiffness and units against closed forms."""

import json
import math
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SceneError
from solidgear.core.ladder.registry import LADDER
from solidgear.core.scene import STEEL, Bearing, Material, Port, Scene, Segment
from solidgear.core.scene.bearing_stiffness import (
    STIFFNESS_NAMES,
    checked_matrix,
    stiffness_entries,
    stiffness_matrix,
)
from solidgear.core.scene.file import load
from solidgear.core.scene.units import COMMON, _by_pint, quantity
from validation.shipped import shipped_shafts

GEOMETRY = Path(__file__).parents[1] / "geometry"
NEAR = dict(rel=0, abs=1e-9)


def test_overhung_pinion_against_closed_forms(overhung):
    axial, small = 0.063 * math.cos(0.391), 0.067 - 0.063 * math.sin(0.391)
    back = axial + 0.010
    head, backcone, shaft = overhung.segments
    assert [s.part for s in overhung.segments] == ["frustum", "backcone", "shaft"]
    assert [s.name for s in overhung.segments] == ["head", "head.backcone", "shaft"]
    assert (head.y0, head.y1, head.outer0, head.outer1) == pytest.approx(
        (0, axial, small, 0.067), **NEAR
    )
    assert (backcone.y0, backcone.y1, backcone.outer0, backcone.outer1) == pytest.approx(
        (axial, back, 0.067, 0.067), **NEAR
    )
    assert (shaft.y0, shaft.y1, shaft.outer0, shaft.inner0) == pytest.approx(
        (back, back + 0.208, 0.045, 0), **NEAR
    )
    one, two = overhung.bearings
    assert (one.y, two.y) == pytest.approx((back + 0.028, back + 0.178), **NEAR)
    assert (one.lo, one.hi, two.lo, two.hi) == pytest.approx(
        (back + 0.008, back + 0.048, back + 0.158, back + 0.198), **NEAR
    )
    assert (overhung.port.y, overhung.port.lo, overhung.port.hi) == pytest.approx(
        (axial / 2, 0, axial), **NEAR
    )
    assert overhung.steps == pytest.approx((back,), **NEAR)
    assert [s.name for s in overhung.stations] == ["pinion", "1", "2"]
    assert (
        overhung.housing_axial,
        overhung.ask.modes,
        overhung.ask.max_frequency,
        overhung.ask.tolerance,
    ) == (None, 10, 10e3, 0.05)


def test_neighbours_meet_exactly(overhung):
    for a, b in zip(overhung.segments, overhung.segments[1:]):
        assert a.y1 == b.y0
    assert overhung.port.hi == overhung.segments[0].y1


def test_published_bearing_one_is_the_published_matrix(overhung):
    expected = np.zeros((6, 6))
    for i, j, value in [
        (0, 0, 8.823e9),
        (1, 1, 8.887e8),
        (2, 2, 8.823e9),
        (0, 5, 1.452e8),
        (2, 3, -1.452e8),
        (3, 3, 3.856e6),
        (5, 5, 3.856e6),
        (0, 1, 109.5),
        (0, 2, 12.77),
        (1, 2, -21.38),
        (0, 3, 0.246),
        (1, 3, -0.487),
        (1, 5, 1.681),
    ]:
        expected[i, j] = expected[j, i] = value
    np.testing.assert_allclose(overhung.bearings[0].stiffness, expected, rtol=1e-12)


def test_stiffness_cannot_be_written_to(overhung):
    for bearing in overhung.bearings:
        with pytest.raises(ValueError):
            bearing.stiffness[0, 0] = 1.0


def test_a_stiffness_below_all_numbers_is_read_or_refused_in_a_sentence():
    """The product of two such entries is zero, and nothing may be divided by it."""
    tiny = np.diag([1e-310, 1e-310, 1e-310, 0.0, 0.0, 0.0])
    with np.errstate(divide="raise", invalid="raise"):
        assert checked_matrix(tiny)[0][0] == 1e-310
        tiny[0, 4] = tiny[4, 0] = 1e-319
        with pytest.raises(SceneError, match="indefinite in the pair"):
            checked_matrix(tiny)


def test_stiffness_names_and_matrix_are_inverse():
    assert len(STIFFNESS_NAMES) == 21
    for row, name in enumerate(STIFFNESS_NAMES):
        K = stiffness_matrix({name: 2.5 + row})
        i, j, _ = STIFFNESS_NAMES[name]
        assert K[i, j] == K[j, i] == 2.5 + row and np.count_nonzero(K) == (1 if i == j else 2)
        assert stiffness_entries(K) == {name: 2.5 + row}
    assert [
        STIFFNESS_NAMES[n][:2] for n in ("kxx", "kyz", "kx_thz", "kz_thx", "kthy", "kthx_thz")
    ] == [(0, 0), (1, 2), (0, 5), (2, 3), (4, 4), (3, 5)]


def test_series_spring_condenses_the_couplings_of_y():
    rng = np.random.default_rng(0)
    A = rng.normal(size=(6, 6))
    K, spring = A @ A.T, 0.7  # two of 1.4 behind one another
    big = np.zeros((7, 7))  # the ring's own y is the last degree of freedom
    inner = [0, 6, 2, 3, 4, 5]
    big[np.ix_(inner, inner)] += K
    big[np.ix_([1, 6], [1, 6])] += spring * np.array([[1, -1], [-1, 1]])
    condensed = big[:6, :6] - np.outer(big[:6, 6], big[6, :6]) / big[6, 6]
    bearing = Bearing(name="b", y=0, seat_width=1, stiffness=K, axial_series=("1.4 N/m", 1.4))
    np.testing.assert_allclose(bearing.stiffness, condensed, atol=1e-12)


@pytest.mark.parametrize(
    "text, dimension, value",
    [
        ("90 mm", "length", 0.09),
        ("9cm", "length", 0.09),
        (90e-3, "length", 0.09),
        (f"{90 / 25.4!r} in", "length", 0.09),
        ("22.4 deg", "angle", math.radians(22.4)),
        ("0.391 rad", "angle", 0.391),
        ("207 GPa", "pressure", 2.07e11),
        ("7.85 g/cm^3", "density", 7850),
        ("8.6e9 N/m", "force_per_length", 8.6e9),
        ("8.6e6 N/mm", "force_per_length", 8.6e9),
        ("145 MN/rad", "force", 1.45e8),
        ("1 N/deg", "force", 180 / math.pi),
        ("3.6e6 N*m/rad", "moment", 3.6e6),
        ("3600 kN m", "moment", 3.6e6),
        ("10 kHz", "frequency", 1e4),
        ("5 %", "dimensionless", 0.05),
        (5, "length", 5.0),
    ],
)
def test_quantities(text, dimension, value):
    assert quantity(text, dimension) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    "text",
    [
        "mm",
        "",
        "1 mm + 2 mm",
        "5 m**9**9**9**9",
        "1 (",
        "5 m*rad",
        "10 degC",
        "1e400 mm",
        "nan",
        True,
        None,
        [1],
        10**400,
    ],
)
def test_not_a_length(text):
    with pytest.raises(SceneError):
        quantity(text, "length")


def test_a_scene_does_not_depend_on_the_units_it_is_written_in(overhung, tmp_path):
    text = (GEOMETRY / "pinion_overhung.toml").read_text(encoding="utf-8")
    for old, new in {
        '"90 mm"': f'"{90 / 25.4!r} in"',
        '"208 mm"': "0.208",
        '"28 mm"': '"2.8 cm"',
        '"207 GPa"': "2.07e11",
        '"10 kHz"': "10000",
    }.items():
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "pinion_overhung.toml"
    path.write_text(text, encoding="utf-8")
    other = load(path)
    assert other.segments[2].outer0 == pytest.approx(0.045, rel=1e-14)
    assert other.with_changes(segments=overhung.segments) == overhung


@pytest.mark.parametrize("unit", COMMON)
def test_units_known_by_heart_are_what_pint_says(unit):
    assert COMMON[unit] == _by_pint(unit)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("115 Nm", "torque", 115.0),
        ("2.5 kNm", "torque", 2500.0),
        ("3 Nmm", "torque", 3e-3),
        ("3e6 Nm/rad", "moment", 3e6),
        ("1500 1/min", "speed", 50 * math.pi),
        ("1500 min^-1", "speed", 50 * math.pi),
    ],
)
def test_units_as_they_stand_on_a_nameplate(text, dimension, value):
    assert quantity(text, dimension) == pytest.approx(value, rel=1e-13)


def test_plain_numbers_do_not_import_pint():
    code = "import sys; from solidgear.core.scene import *; Scene.from_parts([Segment.cylinder('rod', length=0.3, diameter=0.06)]); print('pint' in sys.modules)"
    out = subprocess.run(
        [sys.executable, "-c", code],
        cwd=GEOMETRY.parent,
        capture_output=True,
        text=True,
        check=True,
    )
    assert out.stdout.strip() == "False"


def test_a_cylinder_in_one_call():
    lead = Material(E=16e9, nu=0.44, density=11340)
    scene = Scene.from_parts([Segment.cylinder("rod", length=0.3, diameter=0.06, bore=0.02)], lead)
    (rod,) = scene.segments
    assert (scene.length, rod.radius_at(0.15), rod.material) == (0.3, (0.01, 0.03), lead)
    assert (scene.port.y, scene.port.lo, scene.port.hi, scene.bearings) == (0.15, 0.0, 0.3, ())
    assert lead.shear_modulus == pytest.approx(16e9 / 2.88)


def test_radius_along_a_cone():
    cone = Segment.cone("c", length=0.2, start_diameter=0.1, end_diameter=0.2, bore=0.04, y0=1.0)
    assert cone.radius_at(1.05) == pytest.approx((0.02, 0.0625))
    with pytest.raises(ValueError):
        cone.radius_at(0.9)


def test_variants(overhung):
    assert {s.attachment for s in overhung.with_attachment("section").stations} == {"section"}
    assert {round(b.hi - b.lo, 9) for b in overhung.with_seat_width("20 mm").bearings} == {0.02}
    softer = overhung.with_material(E=1e11)
    assert {s.material.E for s in softer.segments} == {1e11} and softer.material.nu == 0.3
    assert {
        s.material for s in overhung.with_changes(material=STEEL.with_changes(nu=0.2)).segments
    } == {STEEL.with_changes(nu=0.2)}
    for a, b in zip(overhung.bearings, overhung.with_bearing_scale(3.0).bearings):
        np.testing.assert_allclose(b.stiffness, 3 * a.stiffness, rtol=1e-13)
    assert overhung.with_port(y=0.03).port == Port(
        name="pinion", y=0.03, lo=overhung.port.lo, hi=overhung.port.hi
    )


@pytest.mark.parametrize(
    "change",
    [
        lambda s: s.with_seat_width(0.0),
        lambda s: s.with_seat_width(0.16),
        lambda s: s.with_attachment("welded"),
        lambda s: s.with_material(nu=0.5),
        lambda s: s.with_bearing_scale(-1.0),
        lambda s: s.with_port(y=1.0),
        lambda s: s.with_port(hi=0.07),
        lambda s: s.with_changes(segments=s.segments[1:]),
        lambda s: s.with_changes(bearings=s.bearings[:1] * 2),
        lambda s: s.with_changes(bearing=()),
        lambda s: s.model_copy(update={"segments": ()}),
        lambda s: s.bearings[0].with_changes(stiffness={"kxx": 1.0, "kxy": 0.1}),
        lambda s: s.with_attachment("rigid").with_port(y=0.1, lo=0.1, hi=0.11, attachment="rigid"),
    ],
)
def test_changes_are_validated(overhung, change):
    with pytest.raises(SceneError) as caught:
        change(overhung)
    assert "\n" not in str(caught.value)


def test_frozen(overhung):
    with pytest.raises(Exception, match="frozen"):
        overhung.title = "other"


def test_a_seat_may_end_at_the_shoulder(overhung):
    one, two = overhung.bearings
    scene = overhung.with_changes(
        bearings=(one.with_changes(y=overhung.steps[0] + one.seat_width / 2), two)
    )
    assert scene.bearings[0].lo == scene.steps[0]


def test_head_with_its_toe_to_the_end(tmp_path):
    text = (GEOMETRY / "cylinder_free.toml").read_text(encoding="utf-8")
    head = '[[segment]]\nkind = "bevel_head"\nname = "h"\npitch_radius = 0.1\npitch_angle = "30 deg"\nface_width = 0.08\nbackcone = 0.02\ntoe = "end"\n\n[port]'
    text = (
        text.replace("[port]", head)
        .replace('"rod.middle"', '"h.mid_face"')
        .replace('attach_to = "rod"', 'attach_to = "h"')
    )
    path = tmp_path / "toe.toml"
    path.write_text(text, encoding="utf-8")
    scene = load(path)
    _, backcone, frustum = scene.segments
    assert (backcone.part, backcone.y0, backcone.y1, frustum.part) == (
        "backcone",
        0.3,
        0.32,
        "frustum",
    )
    assert (frustum.outer0, frustum.outer1, scene.length) == pytest.approx(
        (0.1, 0.06, 0.32 + 0.08 * math.cos(math.pi / 6))
    )
    assert scene.port.y == pytest.approx(0.32 + 0.04 * math.cos(math.pi / 6))


@pytest.mark.parametrize("path", shipped_shafts(), ids=lambda p: p.stem)
def test_shipped_scenes_load_and_are_json(path):
    scene = sg.load(path)
    data = json.loads(json.dumps(scene.as_dict(), allow_nan=False))
    assert scene.name == path.stem and scene.title and scene.source
    assert data["length"] == scene.length and len(data["segments"]) == len(scene.segments)
    for row, bearing in zip(data["bearings"], scene.bearings, strict=True):
        np.testing.assert_array_equal(row["stiffness"], bearing.stiffness)
    assert scene == sg.load(path)


def test_straddled_pinion():
    scene = load(GEOMETRY / "pinion_straddle.toml")
    back = scene.segments[2].y1
    assert [b.y for b in scene.bearings] == pytest.approx(
        [back - 0.1, back + 0.028, back + 0.143], **NEAR
    )
    assert scene.housing_axial == 7.71e9
    assert scene.bearings[2].stiffness[1, 1] == pytest.approx(
        1 / (1 / 1.721e9 + 1 / 4.1e8), rel=1e-9
    )
    assert scene.bearings[0].stiffness[1, 1] == 0.0


def test_a_train_is_told_from_a_shaft():
    with pytest.raises(SceneError, match="describes a train, not one shaft"):
        load(GEOMETRY / "axle_overhung.toml")


def test_a_seat_a_hair_beside_a_face_or_a_joint_ends_there():
    # 50 nm of rounding in a position: a sliver of a cell, and a line that gmsh refuses
    parts = [
        sg.Segment(name="a", y0=0.0, y1=0.1, outer0=0.02, outer1=0.02),
        sg.Segment(name="b", y0=0.1, y1=0.2, outer0=0.03, outer1=0.03),
    ]
    springs = {"kxx": 1e8, "kyy": 1e8, "kzz": 1e8}
    a = sg.Bearing(name="A", y=0.0100001, seat_width=0.0200001, stiffness=springs)
    b = sg.Bearing(name="B", y=0.1100001, seat_width=0.02, stiffness=springs)
    port = sg.Port(name="gear", y=0.19, lo=0.18, hi=0.20000005)
    scene = sg.Scene.from_parts(parts, port=port, bearings=[a, b])
    assert [s.lo for s in scene.bearings] == [0.0, 0.1] and scene.port.hi == 0.2
    assert scene.bearings[0].hi == a.hi and scene.bearings[1].hi == b.hi
    assert sg.build(scene, "solid", element="tet10", refinement=0.3).size > 0
    # a gap that one can see is a gap
    wide = sg.Bearing(name="A", y=0.0101, seat_width=0.02, stiffness=springs)
    assert scene.with_changes(bearings=(wide,)).bearings[0].lo == pytest.approx(1e-4)


def test_fields_are_called_as_in_a_file_and_pydantic_is_not_shown():
    overhung = sg.load("geometry/pinion_overhung.toml")
    front = overhung.bearings[0]
    assert front.position == front.y and "position=0.096" in repr(front)
    assert front.with_changes(position="0.1 m").y == 0.1
    assert sg.Bearing(name="A", position=0.1, seat_width=0.02, hold="pinned").y == 0.1
    assert overhung.segments[-1].diameter == pytest.approx(0.09)
    for shown in (overhung, front, sg.Bearing, sg.Material):
        names = set(dir(shown))
        assert not names & {"copy", "json", "dict", "schema"}
        assert not any("pydantic" in name or name.startswith("model_") for name in names)
    assert {"seat_width", "with_changes"} <= set(dir(sg.Bearing))


@pytest.mark.parametrize(
    "name, meant",
    (("bearing", "bearings"), ("materal", "material"), ("with_change", "with_changes")),
)
def test_a_name_that_is_not_there_is_answered_by_the_one_that_is_meant(name, meant):
    overhung = sg.load("geometry/pinion_overhung.toml")
    with pytest.raises(AttributeError, match=f'a Scene has no .{name}.; did you mean "{meant}"'):
        getattr(overhung, name)
    with pytest.raises(AttributeError, match='did you mean "compare"'):
        sg.__getattr__("compar")


def test_the_help_of_the_package_names_all_that_it_exports_and_every_model():
    words = set(re.findall(r"[A-Za-z_]+", sg.__doc__))
    assert {*sg.__all__} - {"__version__"} <= words
    assert set(LADDER.bodies) <= words
