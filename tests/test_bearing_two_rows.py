"""Bearings of two rows, four points and balls on a sphere, and ribs that hold a shaft."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.bearings.ball import BallRow
from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.catalogued import catalogued, state
from solidgear.bearings.equivalent import factors, static_load
from solidgear.bearings.geometry import inner_geometry
from solidgear.bearings.hertz import point_contact
from solidgear.bearings.life import life
from solidgear.bearings.rating import ball_rating, ratings
from solidgear.bearings.rolling import RollingBearing
from solidgear.core import SceneError, SolidgearError

MOTION = np.array([6e-6, 4e-6, -5e-6, 4e-5, 0.0, -3e-5])


def test_two_rows_in_one_are_a_pair_back_to_back():
    one = Catalogue(designation="3208 A", preload="400 N")
    inside = inner_geometry(one).middle
    pair = Catalogue(
        kind="angular_contact", bore=0.04, outer_diameter=0.08, width=0.018, arrangement="O",
        elements=inside.elements, element_diameter=inside.diameter, pitch_diameter=inside.pitch,
        contact_angle=inside.angle, conformity=inside.conformity, row_distance=one.width / 2,
        preload="400 N",
    )  # fmt: skip
    for made in (catalogued(one), catalogued(pair)):
        assert made.bearing.load(MOTION) == pytest.approx(
            catalogued(one).bearing.load(MOTION), rel=1e-12
        )
    assert one.both_ways and one.seat_width == one.width


def test_four_points_are_both_diagonals_of_the_same_balls():
    data = Catalogue(designation="QJ 208", load={"y": "1 kN"})
    made = catalogued(data)
    inside = made.inside
    rows = [
        BallRow(inside.elements, inside.diameter, inside.pitch, inside.angle, side)
        for side in (-1, 1)
    ]
    assert made.bearing.load(MOTION) == pytest.approx(RollingBearing(tuple(rows)).load(MOTION))
    # along the shaft alone one diagonal carries, at 35 degrees and a little more
    lower, upper = made.bearing.contacts(state(data, made))
    assert not lower.load.any() and math.degrees(upper.angle[0]) == pytest.approx(36, abs=1)
    carried = inside.elements * upper.load[0] * math.sin(upper.angle[0])
    assert carried == pytest.approx(1e3, rel=1e-9)
    # makers (SKF, QJ): e 0.95, X 1 and 0.6, Y 0.66 and 1.07
    e, low, high = factors(data, inside, 1.0)
    assert (e, *low, *high) == pytest.approx((0.95, 1, 0.66, 0.6, 1.07), abs=0.006)


def test_balls_on_a_sphere_let_the_shaft_tilt():
    data = Catalogue(designation="1208", load={"y": "300 N", "z": "2 kN"})
    made = catalogued(data)
    motion = state(data, made)
    stiffness = made.bearing.tangent(motion)
    assert not stiffness[3:].any() and not stiffness[:, 3:].any()
    # Hertz's contact of a ball in a sphere about the middle of the bearing, by curvatures alone
    inside, row = made.inside, made.bearing.rows[0]
    sphere = inside.pitch / 2 / math.cos(inside.angle) + inside.diameter / 2
    curvature = 2 / inside.diameter - 1 / sphere
    alone = point_contact(curvature, curvature, row.E, row.nu)
    assert row.rings[1].constant == pytest.approx(alone.constant, rel=1e-9)
    # the sum of all contact forces is the load: equilibrium without the tangent
    total = np.zeros(3)
    for contacts, side in zip(made.bearing.contacts(motion), (-1, 1)):
        c, s = np.cos(contacts.azimuth), np.sin(contacts.azimuth)
        angle = np.where(contacts.load > 0, contacts.angle, 0.0)
        press = contacts.load * np.cos(angle)
        total += [press @ c, contacts.load @ np.sin(angle), press @ s]
        assert np.all(side * angle >= 0)
    assert total == pytest.approx([0.0, 300.0, 2000.0], abs=1e-5)
    # ISO 281: 0.42 and 0.65 cot a; ISO 76: 0.44 cot a
    cot = 1 / math.tan(inside.angle)
    e, low, high = factors(data, inside, 0.0)
    assert (e * cot, low[1] / cot, high[0], high[1] / cot) == pytest.approx(
        (1.5, 0.42, 0.65, 0.65), rel=0.01
    )
    load = static_load(data, inside, np.array([0, 100.0, 0, 0, 0, 0]))
    assert load == pytest.approx(44 * cot)


#: kN: C and C0 of NTN's catalogue 2203, of SKF's for 32 A
RATED = "1205:12.2/3.3 1206:15.8/4.65 1208:19.3/6.5 1210:22.8/8.1 1305:18.2/5 1308:29.8/9.7 1312:57.5/20.8"
TWO_ROWS = "3205_A:21.6/14.3 3206_A:30/20.4 3207_A:40/28 3208_A:47.5/34 3306_A:41.5/27.5"


@pytest.mark.parametrize(
    "text, most", [(RATED, 0.15), (TWO_ROWS, 0.17)], ids=["self_aligning", "double_row_angular"]
)
def test_estimated_insides_have_the_other_rating_of_their_catalogue(text, most):
    # estimated from C, so that C0 is the check
    off = []
    for entry in text.split():
        name, both = entry.split(":")
        dynamic, static = (1e3 * float(v) for v in both.split("/"))
        data = Catalogue(designation=name.replace("_", " "), load_rating=dynamic)
        off.append(ratings(data, inner_geometry(data).middle).static / static - 1)
    assert max(map(abs, off)) < most and abs(np.mean(off)) < most / 2


def test_factors_of_iso_281_of_balls_on_a_sphere():
    # ISO 281:2007, Table 2, f_c of self-aligning ball bearings with b_m = 1.3
    inside = inner_geometry(Catalogue(designation="1208")).middle
    for gamma, known in ((0.05, 17.3), (0.10, 23.4), (0.16, 29.7), (0.20, 33.5)):
        sized = replace(
            inside, diameter=gamma * inside.pitch, angle=0.0, conformity=(0.53, (1 / gamma + 1) / 2)
        )
        scale = sized.elements ** (2 / 3) * (sized.diameter * 1e3) ** 1.8
        assert ball_rating(sized) / 1.3 / scale == pytest.approx(known, rel=0.01), gamma


def cylindrical(name, **more):
    return catalogued(Catalogue(designation=name, **more))


def test_ribs_hold_one_way_or_both():
    nup, nj = cylindrical("NUP 208"), cylindrical("NJ 208", holds="+y")
    up, down = np.array([0, 2e-6, 0, 0, 0, 0]), np.array([0, -2e-6, 0, 0, 0, 0])
    assert nup.bearing.load(up)[1] == -nup.bearing.load(down)[1] > 0
    assert nj.bearing.load(up)[1] == nup.bearing.load(up)[1] and nj.bearing.load(down)[1] == 0
    turned = cylindrical("NJ 208", holds="-y")
    assert turned.bearing.load(up)[1] == 0 > turned.bearing.load(down)[1]
    assert not cylindrical("NU 208").bearing.load(up)[1] and "rib_stiffness" in nup.estimated
    known = cylindrical("NUP 208", rib_stiffness="200 N/um")
    assert known.bearing.load(up)[1] == pytest.approx(400.0)
    # the range of the estimate: four times from end to end
    ends = [catalogued(Catalogue(designation="NUP 208"), end) for end in ("softer", "stiffer")]
    soft, stiff = (made.bearing.tangent(up)[1, 1] for made in ends)
    assert 3 < stiff / soft < 6


def test_load_on_ribs_is_found_and_told():
    data = Catalogue(designation="NUP 208", load={"y": "1.5 kN", "z": "2 kN"}, load_rating="62 kN")
    made = catalogued(data)
    result = life(data, made, state(data, made))
    assert result.equivalent.load == pytest.approx(2000)
    assert "1500 N along the shaft on its ribs, above half of its radial load" in result.notes[0]
    with pytest.raises(SolidgearError, match="nothing holds it in y"):
        nu = data.with_changes(ribs="none")
        state(nu, catalogued(nu))


SEAT = {"name": "A", "y": 0.0, "seat_width": 0.018}


def test_support_follows_the_ribs():
    assert sg.Bearing(**SEAT, catalogue={"designation": "NUP 208"}).catalogue.both_ways
    assert not sg.Bearing(**SEAT, catalogue={"designation": "NUP 208"}, support="locating").floats
    assert sg.Bearing(**SEAT, catalogue={"designation": "NJ 208"}).floats
    assert not sg.Bearing(**SEAT, catalogue={"designation": "NJ 208", "holds": "+y"}).floats
    with pytest.raises(SceneError, match="with one rib holds one way: write holds"):
        sg.Bearing(**SEAT, catalogue={"designation": "NJ 208"}, support="locating")
    with pytest.raises(SceneError, match="without ribs carries nothing along y"):
        sg.Bearing(**SEAT, catalogue={"designation": "NU 208"}, support="locating")
    loose = sg.Bearing(**SEAT, catalogue={"designation": "NUP 208"}, support="floating")
    assert loose.floats


def test_a_rib_that_could_hold_a_shaft_is_named():
    ends = [
        sg.Bearing(name=name, y=y, seat_width=0.018, catalogue={"designation": name})
        for name, y in (("NJ 208", 0.01), ("NU 208", 0.19))
    ]
    shaft = sg.Segment.cylinder("shaft", length=0.2, diameter=0.04)
    port = sg.Port(y=0.1, lo=0.05, hi=0.15)
    load = {"y": 500.0, "z": 2000.0}
    scene = sg.Scene.from_parts([shaft], bearings=ends, port=port, load=load)
    with pytest.raises(SolidgearError, match="one rib of 'NJ 208' would hold it one way"):
        sg.load(scene)
    held = [ends[0].held_towards("+y"), ends[1]]
    scene = sg.load(sg.Scene.from_parts([shaft], bearings=held, port=port, load=load))
    assert scene.bearings[0].stiffness[1, 1] > 1e8 > scene.bearings[1].stiffness[1, 1]


def test_words_against_a_designation_are_written():
    """A file that takes a NUP without its ribs reads back as one."""
    data = Catalogue(designation="NUP 208", ribs="none")
    assert data.written_too == ("clearance", "ribs")
    assert Catalogue(designation="NUP 208").written_too == ("clearance",)


WRONG = (
    ({"designation": "6208", "ribs": "both ways"}, "has no ribs to give"),
    ({"designation": "NU 208", "rib_stiffness": "1e8 N/m"}, "no rib holds this bearing"),
    ({"designation": "QJ 208", "arrangement": "O"}, "has two rows of its own"),
    ({"designation": "1208", "speed": "100 rpm"}, "at rest only"),
    ({"designation": "NA 4905", "raceway": "50 mm"}, "must lie between bore and outer_diameter"),
    ({"designation": "6208", "cage": False}, "has a cage"),
)


@pytest.mark.parametrize("data, sentence", WRONG, ids=[s for _, s in WRONG])
def test_bad_data_end_in_one_sentence(data, sentence):
    with pytest.raises(SceneError, match=sentence) as refused:
        Catalogue(**data)
    assert len(refused.value.problems) == 1


def test_needles_on_an_inner_ring_run_on_its_raceway():
    ring, bare = Catalogue(designation="NA 4905"), Catalogue(designation="RNA 4905")
    for data in (ring, bare):
        inside = inner_geometry(data).middle
        assert inside.pitch - inside.diameter == pytest.approx(0.03)
    assert inner_geometry(Catalogue(designation="NCF 2208 V")).middle.elements == 17


def test_the_ten_ratings_of_the_guide_are_computed():
    """C, C0 and lives of the page of bearings, from sizes alone, beside those that makers print."""
    page = Path("docs/guide/bearings.md").read_text(encoding="utf-8")
    rows = [line.strip("| ").split(" | ") for line in page.splitlines() if line.startswith("| ")]
    rows = [row for row in rows if len(row) == 7 and row[1] in ("URB", "NTN")]
    assert len(rows) == 10
    for name, _, c, computed, c0, computed0, longer in rows:
        data = Catalogue(designation=name, **({"holds": "+y"} if name[0] in "37" else {}))
        result = ratings(data, inner_geometry(data).middle)
        assert result.dynamic / 1e3 == pytest.approx(float(computed), abs=0.06), name
        assert result.static / 1e3 == pytest.approx(float(computed0), abs=0.06), name
        power = 3 if data.balls else 10 / 3
        assert (result.dynamic / 1e3 / float(c)) ** power == pytest.approx(float(longer), abs=0.006)
        # a claim of the page: twice the life at most, but for one tapered bearing
        assert 0.6 < float(longer) < 2.3 and abs(result.static / 1e3 / float(c0) - 1) < 0.41
