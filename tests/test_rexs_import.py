"""Gearboxes in REXS as trains: small ones of our own, whose numbers are known."""

import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from rexs_gearboxes import helical, planetary
from typer.testing import CliRunner

import solidgear as sg
from solidgear.app import app
from solidgear.core import SolidgearError
from solidgear.exchange.rexs.commented import one_line
from solidgear.exchange.rexs.importing import imported
from solidgear.exchange.rexs.notes import Notes
from solidgear.exchange.rexs.pins import clamped_compliance
from solidgear.exchange.rexs.reading import document_of
from solidgear.trains.file.reading import load_train as train_as_written
from solidgear.trains.load.contact import contact
from tests.command import against_schema, command
from validation import rexs_files


def made(box):
    """Return what is made of a gearbox, or of the text of one."""
    text = box if isinstance(box, str) else box.xml()
    return imported(document_of(text.encode()), "train")


def written(box, folder):
    """Write the files of a gearbox into a folder; return the path of the train."""
    files = made(box).files
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder / next(iter(files))


@pytest.mark.parametrize("box", [helical, planetary])
def test_a_file_and_its_train_hold_the_same(box, tmp_path):
    """Counts, lengths, masses, ratio and distances by a reading that shares no code with the import."""
    path = tmp_path / "box.rexs"
    path.write_text(box().xml())
    rows = rexs_files.rows(path)
    assert len(rows) > 9
    assert [row for row in rows if not row.agrees(1e-7)] == []


def test_1_0_and_1_4_are_one_gearbox():
    """In 1.0 flanks, ratings and designations have other names, and a gear begins at its coordinate."""
    old, new = (made(helical(version)) for version in ("1.0", "1.4"))
    for file, text in new.files.items():
        strip = [line for line in text.splitlines() if "REXS 1." not in line]
        words = (
            "addendum_modification",
            "catalogue",
            "rating",
            "flank",
            "normal_pressure",
            "contam",
        )
        same = [line.partition("#")[0] for line in strip if line and line[0] != "#"]
        then = [
            line.partition("#")[0]
            for line in old.files[file].splitlines()
            if "REXS 1." not in line and line and line[0] != "#"
        ]
        assert same == then, words
    assert old.notes.groups == new.notes.groups


def test_words_of_a_train(tmp_path):
    train = sg.load_train(written(helical(), tmp_path))
    pair = train.pairs[0]
    assert (pair.pinion.hand, pair.gear.hand, pair.pinion.loaded_side) == ("right", "left", "right")
    assert pair.pinion.profile_shift == 0.2
    assert pair.mesh.stiffness == "teeth"
    # the wheel lies at v = 60, w = -80 mm: along z and against x of the first scene
    assert np.degrees(pair.mesh.azimuth) == pytest.approx(np.degrees(np.arctan2(60, 80)))
    assert pair.mesh.gear_position == pytest.approx((-0.1, 0.002, 0.0))
    left, right = train.shafts["output"].scene.bearings
    assert (left.catalogue.designation, left.catalogue.load_rating) == ("6209", 35100.0)
    assert (right.support, right.catalogue.clearance) == ("floating", "C3")
    lubrication = train.shafts["output"].scene.lubrication
    assert lubrication.cleanliness == 0.5
    # on the straight line of lg lg (nu + 0.7) over lg T through 100 and 11 mm^2/s at 40 and 100 degrees
    lines = np.log10(np.log10(np.array([100, 11, 1e6 * lubrication.viscosity]) + 0.7))
    places = np.log10(np.array([40, 100, 70]) + 273.15)
    assert np.interp(places[2], places[:2], lines[:2]) == pytest.approx(lines[2], abs=1e-5)
    point = train.operation[0]
    assert (point.torque, round(point.speed * 30 / np.pi, 6)) == (120.0, 1500.0)


def test_each_number_has_its_source():
    text = made(helical()).files["input.toml"]
    assert 'length = "40 mm" # shaft_section 100 "section 0": length' in text
    assert 'position = "15 mm" # concept_bearing 10 "bearing 10"' in text
    head = made(helical()).files["train.toml"].split("\n\ntitle")[0]
    assert all(not line or line[0] == "#" for line in head.splitlines())
    assert "Only you know" in head and "[engine] and [load]" in head


def beam_frequencies(scene, count, elements=120):
    """Natural frequencies of bending of a shaft on springs, Hz: Timoshenko beams, written for this."""
    marks = {0.0, scene.length, *(b.y for b in scene.bearings), *(s.y1 for s in scene.segments)}
    nodes = np.unique(np.round([*marks, *np.linspace(0, scene.length, elements)], 12))
    K, M = np.zeros((2, 2 * len(nodes), 2 * len(nodes)))
    for k, (lo, hi) in enumerate(zip(nodes, nodes[1:])):
        segment = next(s for s in scene.segments if s.y0 - 1e-12 <= lo and hi <= s.y1 + 1e-12)
        inner, outer = np.array([segment.radius_at(y) for y in (lo, (lo + hi) / 2, hi)]).T
        weights = np.array([1, 4, 1]) / 6
        area = weights @ (np.pi * (outer**2 - inner**2))
        inertia = weights @ (np.pi / 4 * (outer**4 - inner**4))
        E, nu, L = segment.material.E, segment.material.nu, hi - lo
        # Hutchinson (2001), of a hollow circle
        a, b = inner.mean() ** 2, outer.mean() ** 2
        whole = 7 + 12 * nu + 4 * nu**2, 34 + 48 * nu + 16 * nu**2
        factor = 6 * (a + b) ** 2 * (1 + nu) ** 2 / (whole[0] * (a * a + b * b) + whole[1] * a * b)
        phi = 12 * E * inertia / (factor * E / (2 + 2 * nu) * area * L**2)
        c = E * inertia / ((1 + phi) * L**3)
        stiff = c * np.array(
            [[12, 6 * L, -12, 6 * L], [6 * L, (4 + phi) * L**2, -6 * L, (2 - phi) * L**2],
             [-12, -6 * L, 12, -6 * L], [6 * L, (2 - phi) * L**2, -6 * L, (4 + phi) * L**2]]
        )  # fmt: skip
        # straight deflections and turns between nodes, of which there are many
        mass = (
            segment.material.density * L / 6 * np.kron([[2, 1], [1, 2]], np.diag([area, inertia]))
        )
        place = slice(2 * k, 2 * k + 4)
        K[place, place] += stiff
        M[place, place] += mass
    for bearing in scene.bearings:
        node = int(np.argmin(np.abs(nodes - bearing.y)))
        K[2 * node, 2 * node] += 2e8
        K[2 * node + 1, 2 * node + 1] += 5e3
    values = np.linalg.eigvals(np.linalg.solve(M, K))
    return np.sqrt(np.sort(values.real)[:count]) / (2 * np.pi)


def test_frequencies_on_bearings_of_given_stiffness(tmp_path):
    """Those of an independent beam with the stiffness of the file, 2e8 N/m and 5e6 N mm/rad, to 1e-3:
    both are beams that differ by their elements alone.
    """
    scene = sg.load(written(helical(), tmp_path).parent / "input.toml").with_attachment("section")
    body = sg.build(scene, "timoshenko")
    found = [m for m in sg.modes(body, scene, n=12).frequency_hz if m > 1]
    for frequency in beam_frequencies(scene, 3):
        assert min(abs(f / frequency - 1) for f in found) < 1e-3


def test_a_shaft_that_runs_the_other_way_is_turned_end_for_end(tmp_path):
    """The same gearbox with the wheel's shaft written from its other end gives the same train."""
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    plain = sg.load_train(written(helical(), tmp_path / "a"))
    box = helical()
    turned = {}
    for k, (number, kind, name, attributes) in enumerate(box.components):
        attributes = dict(attributes)
        if number == 4:
            attributes |= box.place((140, 60, -80), u=(-1, 0, 0))
        elif number in (200, 201, 202):
            u, length = attributes["u_coordinate_on_shaft"][0], attributes["length"][0]
            attributes["u_coordinate_on_shaft"] = (130 - u - length, "mm")
        elif number in (12, 13):
            for key in ("u_coordinate_on_shaft_inner_side", "u_coordinate_on_shaft_outer_side"):
                attributes[key] = (130 - attributes[key][0], "mm")
        elif number in (21, 41):
            attributes["u_coordinate_on_shaft"] = (
                130 - attributes["u_coordinate_on_shaft"][0],
                "mm",
            )
        turned[k] = (number, kind, name, attributes)
    box.components = list(turned.values())
    mirrored = sg.load_train(written(box, tmp_path / "b"))
    assert mirrored.pairs[0].mesh == plain.pairs[0].mesh
    ours, theirs = (t.shafts["output"].scene for t in (plain, mirrored))
    assert [(s.y0, s.outer0) for s in ours.segments] == [(s.y0, s.outer0) for s in theirs.segments]
    assert {b.name: round(b.y, 9) for b in ours.bearings} == {
        b.name: round(b.y, 9) for b in theirs.bearings
    }


def test_load_cases_are_operating_points(tmp_path):
    box = helical()
    for torque, speed, share in ((100, 1000, 60), (-50, 2000, 40)):
        box.cases.append(
            [
                (1, "gear_unit", "unit", {"load_duration_fraction": (share, "%")}),
                (3, "shaft", "input", {"rotational_speed": (speed, "1 / min")}),
                (40, "external_load", "in", {"torque_around_u_axis": (torque, "N m"),
                                             "force_v_direction": (300, "N")}),
            ]
        )  # fmt: skip
    points = sg.load_train(written(box, tmp_path)).operation
    assert [p.torque for p in points] == [100.0, -50.0]
    assert [p.share for p in points] == [0.6, 0.4]
    assert [round(p.speed * 30 / np.pi) for p in points] == [1000, 2000]
    assert (points[0].force[0].at, points[0].force[0].z) == ("input.in", 300.0)  # v is z


def test_bearings_by_their_inside_and_by_the_stiffness_at_a_point(tmp_path):
    box = helical()
    components = {number: k for k, (number, *_) in enumerate(box.components)}
    number, kind, name, attributes = box.components[components[12]]
    inside = {"inner_diameter": (45, "mm"), "outer_diameter": (85, "mm"), "width": (19, "mm")}
    box.components[components[12]] = (
        number,
        kind,
        name,
        {**attributes, **inside, "catalogue_designation": "X"},
    )
    box.add(80, "rolling_bearing_row", number_of_rolling_elements=("10", "none"),
            reference_diameter=(65, "mm"), raceway_radius_of_inner_ring=(6.6, "mm"),
            raceway_radius_of_outer_ring=(6.7, "mm"))  # fmt: skip
    box.add(81, "rolling_element", diameter_of_rolling_element=(12.7, "mm"))
    box.relate("ordered_assembly", assembly=12, part=80)
    box.relate("assembly", assembly=80, part=81)
    number, kind, name, attributes = box.components[components[13]]
    matrix = {"operating_point_stiffness_f_u_d_u": (1e8, "N / m")}
    matrix |= {
        f"operating_point_stiffness_f_{a}_d_{a}": (k, "N / m") for a, k in (("v", 3e8), ("w", 4e8))
    }
    matrix["operating_point_stiffness_f_v_rot_w"] = (2e6, "N / rad")
    matrix["operating_point_stiffness_m_w_d_v"] = (2e6, "N")
    matrix |= {f"operating_point_stiffness_m_{a}_rot_{a}": (3e7, "N mm / rad") for a in "vw"}
    box.components[components[13]] = (number, kind, name, {**attributes, **matrix})
    left, right = sg.load_train(written(box, tmp_path)).shafts["output"].scene.bearings
    data = left.catalogue
    assert (data.kind, data.elements, data.element_diameter, data.pitch_diameter) == (
        "deep_groove", 10, 0.0127, 0.065
    )  # fmt: skip
    assert data.conformity == pytest.approx((6.6 / 12.7, 6.7 / 12.7), abs=1e-6)
    # w, u, v are x, y, z: the coupling of v with the turn about w is that of z and thx
    K = right.stiffness
    assert np.diag(K).tolist() == pytest.approx([4e8, 1e8, 3e8, 3e4, 0.0, 3e4])
    assert K[2, 3] == pytest.approx(2e6)


@pytest.mark.parametrize(
    "word, ribs, holds",
    [("both_directions", "both ways", None), ("positive", "one way", "+y"), ("no_direction", "none", None)],
)  # fmt: skip
def test_ribs_of_cylindrical_rollers_follow_the_file(tmp_path, word, ribs, holds):
    box = helical()
    place = next(k for k, (number, *_) in enumerate(box.components) if number == 12)
    number, kind, name, attributes = box.components[place]
    words = {"bearing_type": "radial_roller_bearing", "catalogue_designation": "NUP 209"}
    words |= {f"radial_{kind_}_load_rating": (70, "kN") for kind_ in ("dynamic", "static")}
    box.components[place] = (
        number, kind, name, {**attributes, **words, "axial_force_absorption": word}
    )  # fmt: skip
    left = train_as_written(written(box, tmp_path)).shafts["output"].scene.bearings[0]
    assert (left.catalogue.kind, left.catalogue.ribs) == ("cylindrical", ribs)
    assert left.catalogue.holds == holds and left.floats == (ribs == "none")


def test_a_planetary_stage(tmp_path):
    train = sg.load_train(written(planetary(), tmp_path))
    stage = train.stages[0]
    assert stage.teeth.azimuths == pytest.approx([0, 2 * np.pi / 3, 4 * np.pi / 3])
    assert train.ratio == pytest.approx(1 + 61 / 17)
    assert train.operation[0].torque == pytest.approx(20e3 / (1000 * np.pi / 30))
    carrier = train.shafts["carrier"].scene
    plate = next(m for m in carrier.masses if m.name == "side_plate_7")
    assert plate.mass == pytest.approx(7850 * np.pi / 4 * (0.11**2 - 0.06**2) * 0.008)
    assert plate.offset[1] == pytest.approx(-0.004)  # its middle, 4 mm before the carrier's end
    pin = stage.table.planet.pin
    # two bearings of 5e8 N/m on the pin, 8 mm and 22 mm along the planet, in series with the pin
    C = clamped_compliance([0.016, 0.030], [0.0, 0.046], 0.018, 0.0, 2.1e11, 0.3) + np.eye(2) / 5e8
    assert pin.radial == pytest.approx(np.linalg.inv(C).sum(), rel=1e-5)
    assert pin.radial < 1e9


def test_a_pin_is_a_clamped_beam():
    """The closed form of the middle of a beam clamped at both ends, L^3 / 192 E I + L / 4 k G A, and
    of the end of one clamped at the other, of a slender pin and of a thick one.
    """
    for diameter in (0.01, 0.3):
        C = clamped_compliance([0.5], [0.0, 1.0], diameter, 0.0, 2.1e11, 0.3)
        area, inertia = np.pi * diameter**2 / 4, np.pi * diameter**4 / 64
        shear = 6 * 1.3 / (7 + 6 * 0.3) * 2.1e11 / 2.6 * area
        closed = 1 / (192 * 2.1e11 * inertia) + 1 / (4 * shear)
        assert C[0, 0] == pytest.approx(closed, rel=1e-6)
        free = clamped_compliance([1.0], [0.0], diameter, 0.0, 2.1e11, 0.3)
        assert free[0, 0] == pytest.approx(1 / (3 * 2.1e11 * inertia) + 1 / shear, rel=1e-6)


def without(box, *names):
    """Return a gearbox without some attributes."""
    box.components = [
        (number, kind, name, {k: v for k, v in attributes.items() if k not in names})
        for number, kind, name, attributes in box.components
    ]
    return box


@pytest.mark.parametrize("version", ["1.0", "1.4"])
def test_a_file_without_places_has_coordinates_and_an_angle(version, tmp_path):
    """A gear begins at its coordinate in 1.0 and has its middle there later; the angle is about -u."""
    vectors = (
        "support_vector",
        "u_axis_vector",
        "w_axis_vector",
        "reference_component_for_position",
    )
    box = without(helical(version), *vectors)
    text = box.xml().replace(
        '<attribute id="center_distance"',
        f'<attribute id="rotating_angle_around_neg_u_axis" unit="deg">{180 - np.degrees(0.6435011)}'
        '</attribute><attribute id="center_distance"',
    )
    train = sg.load_train(written(text, tmp_path))
    assert [gear.scene.port.y for gear in (train.pairs[0].pinion, train.pairs[0].gear)] == [
        0.07,
        0.062,
    ]
    assert train.pairs[0].mesh.azimuth == pytest.approx(0.6435011)


def test_power_and_the_speed_of_another_shaft_give_the_torque(tmp_path):
    box = without(helical(), "rotational_speed", "defines_speed", "torque_around_u_axis")
    for number, added in (
        (4, {"rotational_speed": (-300, "1 / min")}),
        (40, {"power": (12, "kW")}),
    ):
        k = next(k for k, component in enumerate(box.components) if component[0] == number)
        box.components[k] = (*box.components[k][:3], box.components[k][3] | added)
    point = sg.load_train(written(box, tmp_path)).operation[0]
    speed = 300 * np.pi / 30 * 53 / 23
    assert point.speed == pytest.approx(speed, rel=1e-9)
    assert point.torque == pytest.approx(12e3 / speed, rel=1e-9)


def spoiled(*edits, box=helical):
    text = box().xml()
    for old, new, *count in edits:
        assert old in text, old
        text = text.replace(old, new, *count)
    return text


def value(name, old, new, unit=None):
    """Return an edit of an attribute, of its unit as well where a new one is given."""
    return f'id="{name}" unit="{old[1]}">{old[0]}<', f'id="{name}" unit="{unit or old[1]}">{new}<'


HELIX = ("15", "deg")
SPOILED = {
    "two gear units": ([("<components>", '<components><component id="99" type="gear_unit"/>')], "2 gear units"),
    "no stage": ([('type="cylindrical_stage"', 'type="worm_stage"')], "no stage joins its gears"),
    "a stage of one gear": ([('role="gear_2"', 'role="gear_1"')], "no stage joins its gears"),
    "both gears on one shaft": ([('<ref id="4" role="assembly"/><ref id="21" role="part"/>', '<ref id="3" role="assembly"/><ref id="21" role="part"/>')], "both gears sit on|off shaft"),
    "no shaft": ([('type="shaft"', 'type="spindle"')], "no component of the type shaft"),
    "no sections": ([('type="shaft_section"', 'type="hull"')], "has no shaft_section"),
    "length zero": ([value("length", ("60.0" if False else "60", "mm"), "0")], "length = 0 mm"),
    "length negative": ([value("length", ("60", "mm"), "-60")], "length = -60 mm"),
    "length in kg": ([value("length", ("60", "mm"), "60", "kg")], "'kg' is not its unit"),
    "length in inches": ([value("length", ("60", "mm"), "60", "inch")], "'inch' is not its unit"),
    "length a word": ([value("length", ("60", "mm"), "sixty")], "length = sixty mm"),
    "length nan": ([value("length", ("60", "mm"), "nan")], "finite number"),
    "length without end": ([value("length", ("60", "mm"), "1e999")], "finite number"),
    "a gap": ([value("length", ("60", "mm"), "50")], "leaves a gap of 10 mm"),
    "an overlap": ([value("length", ("60", "mm"), "70")], "overlaps by 10 mm"),
    "a bore as wide as the shaft": ([value("inner_diameter_begin", ("10", "mm"), "40")], "larger than the bore"),
    "no diameter": ([('id="outer_diameter_end" unit="mm">28<', 'id="outer_diameter" unit="mm">28<')], "outer_diameter_end: is missing"),
    "metres for millimetres": ([('unit="mm">60<', 'unit="mm">60000<'), ("none", "none")], "off shaft|leaves a gap|overlaps"),
    "a bearing off the shaft": ([value("u_coordinate_on_shaft_inner_side", ("125", "mm"), "725")], "725 mm, off shaft"),
    "a bearing without a place": ([('id="u_coordinate_on_shaft_inner_side" unit="mm">125<', 'id="u" unit="mm">125<')], "inner_side: is missing"),
    "a gear off the shaft": ([('<c>70</c><c>0</c><c>0</c>', '<c>700</c><c>0</c><c>0</c>')], "700 mm, off shaft"),
    "a load off the shaft": ([value("u_coordinate_on_shaft", ("130", "mm"), "999")], "999 mm, off shaft"),
    "absorbs sideways": ([("no_direction", "sideways")], "REXS has both_directions"),
    "absorbs maybe": ([('"radial_force_absorption" unit="none">true', '"radial_force_absorption" unit="none">maybe')], "must be true or false"),
    "no teeth": ([value("number_of_teeth", ("23", "none"), "0")], "must not be zero"),
    "half a tooth": ([value("number_of_teeth", ("23", "none"), "23.5")], "whole number"),
    "teeth in mm": ([value("number_of_teeth", ("23", "none"), "23", "mm")], "REXS has no unit"),
    "two modules": ([value("normal_module", ("2.5", "mm"), "2.5"), ('id="normal_module" unit="mm">2.5</attribute>\n<attribute id="helix_angle_reference_diameter" unit="deg">-15', 'id="normal_module" unit="mm">3</attribute>\n<attribute id="helix_angle_reference_diameter" unit="deg">-15')], "normal_module = 3 mm"),
    "module zero": ([value("normal_module", ("2.5", "mm"), "0")], "greater than zero"),
    "no module": ([('id="normal_module"', 'id="module"')], "normal_module: is missing"),
    "two helix angles": ([value("helix_angle_reference_diameter", ("-15", "deg"), "-25")], "and both are in"),
    "one hand": ([value("helix_angle_reference_diameter", ("-15", "deg"), "15")], "right-handed"),
    "a helix of 95 degrees": ([("15</attribute>", "95</attribute>")], "80 degrees|too long|cannot|helix"),
    "no face": ([('id="face_width"', 'id="face"'), ("torque_around_u_axis", "moment")], "face_width: is missing"),
    "axes in one place": ([("<c>60</c><c>-80</c>", "<c>0</c><c>0</c>"), ('id="center_distance" unit="mm">100', 'id="center_distance" unit="mm">0')], "are one"),
    "far too short a distance": ([value("center_distance", ("100", "mm"), "60")], "centre_distance|overlap"),
    "far too long a distance": ([value("center_distance", ("100", "mm"), "200")], "too long"),
    "a distance in degrees": ([value("center_distance", ("100", "mm"), "100", "deg")], "'deg' is not its unit"),
    "a place of two numbers": ([("<c>10</c><c>60</c><c>-80</c>", "<c>10</c><c>60</c>")], "must be three numbers"),
    "a direction of zeros": ([("<c>1</c><c>0</c><c>0</c>", "<c>0</c><c>0</c><c>0</c>")], "has no direction"),
    "axes that lean": ([("<c>0</c><c>0</c><c>1</c>", "<c>1</c><c>0</c><c>1</c>")], "must be across u_axis_vector"),
    "a place in nothing": ([('id="reference_component_for_position" unit="none">1<', 'id="reference_component_for_position" unit="none">77<')], "no such component"),
    "a place in itself": ([('id="reference_component_for_position" unit="none">1<', 'id="reference_component_for_position" unit="none">3<', 1)], "closes a circle"),
    "a modulus in mm": ([value("elastic_modulus", ("206000", "N / mm^2"), "206000", "mm")], "not its unit"),
    "a modulus of nothing": ([value("elastic_modulus", ("206000", "N / mm^2"), "0")], "E"),
    "Poisson's ratio 0.7": ([value("poisson_ratio", ("0.3", "none"), "0.7")], "between -1 and 0.5"),
    "a density below zero": ([value("density", ("7.83", "kg / dm^3"), "-7")], "density"),
    "a stiffness below zero": ([value("radial_stiffness", ("200000000.0", "N / m"), "-2e8")], "must not be negative"),
    "a torque in newtons": ([value("torque_around_u_axis", ("120", "N m"), "120", "N")], "'N' is not its unit"),
    "a torque of letters": ([value("torque_around_u_axis", ("120", "N m"), "much")], "finite number"),
    "a shift of nine": ([value("addendum_modification_coefficient", ("0.2", "none"), "9")], "profile_shift|2.5"),
}  # fmt: skip


@pytest.mark.parametrize("case", SPOILED)
def test_a_spoiled_file_ends_in_a_sentence(case, tmp_path):
    """A file that cannot be a train is refused by the import, or by the reader of what it writes."""
    edits, words = SPOILED[case]
    with pytest.raises(SolidgearError, match=words) as refusal:
        sg.load_train(written(spoiled(*edits), tmp_path))
    sentence = str(refusal.value).splitlines()[0]
    assert 15 < len(sentence) < 500 and "Traceback" not in sentence


PLANETS = {
    "a profile shift": ([('id="addendum_modification_coefficient" unit="none">0<', 'id="addendum_modification_coefficient" unit="none">0.3<')], "stages of trains have none"),
    "a ring that turns": ([('type="coupling"', 'type="clutch"')], "no stage joins its gears"),
    "planets that differ": ([('<component id="30" type="cylindrical_gear" name="gear 30">\n<attribute id="u_coordinate_on_shaft" unit="mm">15</attribute>\n<attribute id="face_width" unit="mm">30</attribute>\n<attribute id="number_of_teeth" unit="none">22', '<component id="30" type="cylindrical_gear" name="gear 30">\n<attribute id="u_coordinate_on_shaft" unit="mm">15</attribute>\n<attribute id="face_width" unit="mm">30</attribute>\n<attribute id="number_of_teeth" unit="none">21')], "its planets have"),
    "a ring that does not fit": ([value("number_of_teeth", ("-61", "none"), "-63")], "does not fit"),
}  # fmt: skip


@pytest.mark.parametrize("case", PLANETS)
def test_a_spoiled_planetary_stage_ends_in_a_sentence(case, tmp_path):
    edits, words = PLANETS[case]
    with pytest.raises(SolidgearError, match=words):
        sg.load_train(written(spoiled(*edits, box=planetary), tmp_path))


def test_what_is_left_out_is_named_and_the_rest_goes_on(tmp_path):
    box = helical()
    box.add(90, "worm_stage", "worm drive")
    box.add(91, "shaft", "worm", **box.place((0, 200, 0), u=(0, 1, 0), w=(0, 0, 1)))
    box.sections(91, 900, (50, 20, 20, 0))
    result = made(box)
    lines = dict(result.notes.groups)["Left out"]
    assert any("worm drive (worm_stage): not read: no train here" in line for line in lines)
    assert any("worm: no teeth of the train lead to it" in line for line in lines)
    assert (
        "worm.toml" in result.files and len(tomllib.loads(result.files["train.toml"])["shaft"]) == 2
    )
    assert any("Walther" in text for text in result.files.values())


def test_words_of_a_file_end_no_comment(tmp_path):
    """Names and designations of a file stand in comments, whatever letters they have."""
    text = (
        helical()
        .xml()
        .replace("6209-C3", "6209-C3&#10;[ask]&#10;")
        .replace('applicationId="test', 'applicationId="te&#10;x = 1')
    )
    text = text.replace('name="section 1"', 'name="neck&#10;[load]&#10;"')
    train = sg.load_train(written(text, tmp_path))
    assert [b.name for b in train.shafts["output"].scene.bearings] == ["left", "right"]
    assert one_line("neck\n\x1b[2J") == "neck??[2J"


def test_a_note_is_there_once():
    notes = Notes()
    for name in ("left", "right", "left"):
        notes.assume(name, "rigid")
    assert notes.groups == [("Assumed", ["left; right: rigid"])]


def test_the_command_writes_all_or_nothing(tmp_path):
    source, out = tmp_path / "gear box.rexs", tmp_path / "the out"
    source.write_text(helical().xml())
    run = CliRunner().invoke(app, ["import", str(source), "--out", str(out)])
    assert run.exit_code == 0, run.output
    assert sorted(p.name for p in out.iterdir()) == ["gear_box.toml", "input.toml", "output.toml"]
    assert "2 shafts of 6 sections, 1 cylindrical stage" in run.output
    assert f'Next: solidgear check "{out / "gear_box.toml"}"' in run.output
    indented = [row for row in run.output.splitlines() if row.startswith("  ")]
    assert max(map(len, indented)) <= 80
    with pytest.raises(SolidgearError, match="there is such a file already"):
        CliRunner().invoke(app, ["import", str(source), "--out", str(out)], catch_exceptions=False)
    printed = command("import", source, "--out", out, "--force", "--json").stdout
    data = json.loads(printed)
    assert against_schema("import", printed) == [] and data["train"]
    assert data["files"] == [
        str(out / name) for name in ("gear_box.toml", "input.toml", "output.toml")
    ]
    assert all(line in " ".join(run.output.split()) for line in data["facts"])
    assert {*data["notes"]} == {row for row in run.output.splitlines() if row in data["notes"]}
    source.write_text(helical().xml()[:3000])
    with pytest.raises(SolidgearError, match="no whole XML"):
        CliRunner().invoke(
            app, ["import", str(source), "--out", str(tmp_path / "b")], catch_exceptions=False
        )
    assert not (tmp_path / "b").exists()


@pytest.mark.parametrize(
    "box, commands",
    [
        pytest.param(helical, ("system-modes --tol 0.2", "contact"), marks=pytest.mark.long),
        *(
            pytest.param(
                box, ("check", "system-modes", "deflect", "contact"), marks=pytest.mark.slow
            )
            for box in (helical, planetary)
        ),
    ],
)
def test_trains_answer_without_a_hand_on_them(box, commands, tmp_path):
    path = str(written(box(), tmp_path))
    for words in commands:
        run = CliRunner().invoke(app, ["-q", *words.split(), path], catch_exceptions=False)
        assert run.exit_code in (0, 3), run.output


def test_a_shaft_behind_a_coupling_is_the_inertia_of_the_engine(tmp_path):
    box = helical()
    box.relations = [r for r in box.relations if ("part", 40) not in r[1]]
    box.add(6, "shaft", "motor", **box.place((-100, 0, 0)))
    box.sections(6, 600, (100, 40, 40, 0))
    box.relate("assembly", assembly=6, part=40)
    box.add(60, "coupling", "claw", rotational_stiffness=(4e6, "N mm / rad"),
            u_coordinate_on_shaft_inner_side=(100, "mm"), u_coordinate_on_shaft_outer_side=(0, "mm"))  # fmt: skip
    box.relate("side", assembly=60, inner_part=6, outer_part=3)
    train = sg.load_train(written(box, tmp_path))
    assert train.engine.shaft == "input" and train.engine.spring.at == "claw"
    assert train.engine.spring.stiffness == pytest.approx(4e3)
    assert train.engine.inertia == pytest.approx(7850 * np.pi / 32 * 0.04**4 * 0.1, rel=1e-3)
    assert "motor" not in train.shafts and train.operation[0].torque == 120.0


def test_spur_planets_leave_axial_motion_unmoved(tmp_path):
    """No mode of a spur stage moves its shafts along their axes: their error bars are those of the
    harmonics that move.
    """
    no_torque = ('id="power" unit="kW">20<', 'id="note" unit="none">20<')
    train = sg.load_train(written(spoiled(no_torque, box=planetary), tmp_path))
    assert not train.operation and train.stages[0].table.mesh.sun_stiffness == 6e8  # 20 N/(mm um)
    solved = sg.system_modes(tmp_path / "train.toml")
    assert solved.frequency_hz[0] == 0.0 and len(solved.frequency_hz) > 3


def test_teeth_with_profile_shift_touch_beyond_the_pitch_circle(tmp_path):
    """A point between the pitch circle and the tips, on a shaft that is thinner than both."""
    pair = sg.load_train(written(helical(), tmp_path)).pairs[0]
    wheel = pair.pinion
    pitch, tip = 0.1 * 23 / 76, 2.5e-3 * (23 / (2 * np.cos(wheel.helix_angle)) + 1.2)
    touched = contact(replace(pair, mesh=pair.mesh.with_changes(stiffness=2e8, azimuth=0.0))).pinion
    for way, is_on in ((0.3, True), (1.3, False)):
        # along the line of action from the pitch point, as far as a share of the way to the tips
        step = way * np.sqrt(tip**2 - pitch**2)
        point = max(
            (touched.point + sign * step * touched.normal for sign in (1, -1)),
            key=lambda place: np.hypot(place[0], place[2]),
        )
        assert (pitch < np.hypot(point[0], point[2]) < tip) == is_on
        line = {"line_of_action": tuple(touched.normal), "point": tuple(point)}
        line |= {"stiffness": 2e8, "pressure_angle": None, "azimuth": 0.0}
        mesh = pair.mesh.with_changes(**line)
        if is_on:
            assert contact(replace(pair, mesh=mesh)).pinion.point == pytest.approx(point)
            continue
        with pytest.raises(SolidgearError, match="from the axis"):
            contact(replace(pair, mesh=mesh))
