"""Where the error of a number sits: whether the parts make the whole, and are where they are."""

import json
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.bounds.refining import Meshed
from solidgear.core.bounds.singular_places import singular_places
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.cell_places import ELSEWHERE
from solidgear.core.judge.quantities import usual
from solidgear.core.judge.record import PlaceRecord, WhereRecord
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import SCENE
from solidgear.core.judge.where import error_places as places_of
from solidgear.core.judge.where import recorded_places
from solidgear.core.quantity import Quantity
from solidgear.show.where_chart import draw_where
from tests.command import command

ROOT = Path(__file__).parent.parent
RADIAL = {"kxx": "5e8 N/m", "kzz": "5e8 N/m"}
#: mm; a shaft with one shoulder, and cuts of a mesh towards it (m)
STEPPED, CUT = ((150.0, 60), (250.0, 40)), {(0.15, 0.02): 3}


@pytest.fixture(scope="module")
def scenes():
    names = ("pinion_overhung", "shaft_stepped", "cylinder_free")
    return {name: sg.load(ROOT / "geometry" / f"{name}.toml") for name in names}


def shaft(*segments, seats=(40.0, 360.0), port=(380.0, 400.0), second=RADIAL, more=(), **changes):
    """A shaft of 400 mm on two bearings, loaded at its end; lengths and diameters in mm."""
    parts, start = [], 0.0
    for k, (length, d) in enumerate(segments):
        size = {"length": f"{length} mm", "diameter": f"{d} mm"}
        parts.append(sg.Segment.cylinder(f"part {k}", y0=start / 1e3, **size))
        start += length
    stiffness = ({**RADIAL, "kyy": "4e8 N/m"}, second)
    bearings = [
        sg.Bearing(name=name, y=f"{y} mm", seat_width="20 mm", stiffness=k, **changes)
        for name, y, k in zip("AB", seats, stiffness)
    ]
    points = [
        sg.Port(y=f"{(lo + hi) / 2} mm", lo=f"{lo} mm", hi=f"{hi} mm", **name, **changes)
        for (lo, hi), name in [(port, {}), *more]
    ]
    return sg.Scene.from_parts(parts, bearings=bearings, port=points[0], further_ports=points[1:])


def where(scene, quantity, options=None):
    """Places with arrays, on the first mesh unless told otherwise."""
    return arrays(places_of(scene, Quantity(quantity), options or Meshed().options()))


def arrays(found):
    names = ("points", "cells", "shares")
    return found.model_copy(update={name: np.array(getattr(found, name)) for name in names})


def shares(found):
    out = {}
    for row in found.rows:
        out[row.what] = out.get(row.what, 0.0) + row.share
    return out


def whole(found):
    """Whether the parts make one."""
    listed = [row.share for row in found.rows]
    assert sum(listed) == pytest.approx(1.0, abs=1e-9) and min(listed) >= 0.0
    assert listed == sorted(listed, reverse=True)
    assert found.shares.shape == found.cells[0].shape and found.shares.min() >= 0.0
    assert found.shares.sum() == pytest.approx(1.0, abs=1e-9)
    return True


@pytest.mark.parametrize(
    "name, quantity, count",
    [
        ("pinion_overhung", "axial 1", 2),
        pytest.param("shaft_stepped", "C_zz", 2, marks=pytest.mark.long),
    ],
)
def test_cells_cut_at_a_place_take_its_share_of_the_bar_away(scenes, name, quantity, count):
    scene = scenes[name]
    found = where(scene, quantity)
    assert whole(found)
    for row in found.rows[:count]:
        assert row.share > 0.05
        finer = where(scene, quantity, Meshed(cuts={(row.y, row.r): 3}).options())
        # three cuts leave less than 2 % of a right corner, and what is smooth beside it: 81 to 95 %
        # of the share was gone
        assert 0.75 * row.share < 1 - finer.total / found.total < 1.02 * row.share


@pytest.mark.long
def test_a_stiffness_has_its_error_where_its_own_forces_strain_the_shaft():
    scene, ends = shaft(*STEPPED), {(0.38, 0.02): 3, (0.40, 0.02): 3}
    found, finer = (where(scene, "K_zz", Meshed(cuts=cuts).options()) for cuts in ({}, ends))
    # the point is held against turning: little of the shaft but its seat is strained
    gone = 1 - finer.total / found.total
    assert gone > 0.7
    assert gone == pytest.approx(shares(found)["seat end of port"], rel=0.1)


@pytest.mark.parametrize("quantity", ["C_z,thx", "bending 1"])
def test_the_error_is_at_the_only_shoulder_and_moves_with_it(quantity):
    for at in (150.0, 220.0):
        found = where(shaft((at, 60), (400 - at, 40)), quantity)
        assert whole(found) and found.quantity == quantity and 0 < found.total < 0.1
        first = found.rows[0]
        assert first.what == "shoulder" and first.share > 0.6
        assert (first.y, first.r) == pytest.approx((at / 1e3, 0.020))
        assert f"of the error bar of {quantity} arises at the shoulder at y = {at:g} mm" in (
            found.sentence
        )
        # and the cell with the most of it touches the corner
        cell = found.points[:, found.cells[:, found.shares.argmax()]]
        assert np.hypot(*(cell - [[first.r], [first.y]])).min() < 1e-9


def test_a_shaft_without_shoulders_has_its_error_at_seats_or_elsewhere():
    found = where(shaft((400.0, 50)), "C_zz")
    assert whole(found) and found.total < 2e-4  # a shoulder leaves ten times as much
    ends = {"seat end of A", "seat end of B", "seat end of port"}
    assert {row.what for row in found.rows} == {*ends, ELSEWHERE}
    assert 1 - shares(found)[ELSEWHERE] > 0.5


@pytest.mark.parametrize("quantity", ["C_zz", "bending 1"])
def test_a_symmetric_shaft_has_symmetric_shares(quantity):
    scene = shaft((130.0, 40), (140.0, 60), (130.0, 40), port=(190.0, 210.0))
    found = where(scene, quantity)
    assert whole(found)
    assert shares(found)["shoulder"] > 0.9
    at = {(row.what, round(1e3 * row.y), round(1e3 * row.r)): row.share for row in found.rows}
    assert at["shoulder", 130, 20] == pytest.approx(at["shoulder", 270, 20], rel=1e-6)
    assert at["seat end of A", 50, 20] == pytest.approx(at["seat end of B", 350, 20], rel=1e-4)
    assert at["seat end of port", 190, 30] == pytest.approx(
        at["seat end of port", 210, 30], rel=1e-4
    )
    middle = found.points[:, found.cells].mean(axis=1).T
    for (r, y), share in zip(middle, found.shares):
        other = np.hypot(middle[:, 0] - r, middle[:, 1] - (0.4 - y)).argmin()
        assert found.shares[other] == pytest.approx(share, rel=1e-3, abs=1e-6)


def test_a_cell_between_two_corners_belongs_to_the_sharper_one():
    # one cell reaches from the shoulder to the seat, which has little of its own
    near = where(shaft((320.0, 60), (80.0, 40)), "C_zz")
    assert shares(near)["shoulder"] > 0.8
    # of two shoulders that are alike each has a part
    both = where(shaft((195.0, 40), (10.0, 60), (195.0, 40), port=(0.0, 20.0)), "torsion 1")
    at = [row.share for row in both.rows if row.what == "shoulder"]
    assert at == pytest.approx([0.5, 0.5], abs=0.05)


@pytest.mark.parametrize("attachment", ["rigid", "section"])
def test_other_ties_have_their_places(attachment):
    found = where(shaft(*STEPPED, attachment=attachment), "C_thx")
    assert whole(found)
    word = "seat end of" if attachment == "rigid" else "section plane of"
    # the tie of the loaded seat is as singular as a crack, or a plane without layers of its own
    assert shares(found)[f"{word} port"] > 0.02 and f"{word} A" in shares(found)


@pytest.mark.long
def test_bearings_that_couple_families_bring_their_loads_along():
    couplings = {"kyz": "2e8 N/m", "kz_thy": "4e6 N/rad"}
    stiff = {**RADIAL, "kyy": "3e8 N/m", "kthy": "1e5 N*m/rad"}
    alone, both = (shaft(*STEPPED, second={**stiff, **more}) for more in ({}, couplings))
    found, finer = (where(both, "C_yy", Meshed(cuts=cuts).options()) for cuts in ({}, CUT))
    assert whole(found)
    # what is pulled is bent as well: more of the bar is at the shoulder, and that much goes with it
    assert shares(found)["shoulder"] > 1.1 * shares(where(alone, "C_yy"))["shoulder"]
    gone = 1 - finer.total / found.total
    assert gone == pytest.approx(shares(found)["shoulder"], rel=0.1)


def test_numbers_of_further_points_and_between_points():
    scene = shaft(*STEPPED, more=[((60.0, 80.0), {"name": "wheel"})])
    main, wheel = where(scene, "C_zz"), where(scene, "C_zz@wheel")
    assert whole(main) and whole(wheel)
    for end in ("seat end of wheel", "seat end of A"):  # between which the wheel bends the shaft
        assert shares(wheel)[end] > 10 * shares(main)[end]
    for end in ("seat end of port", "seat end of B"):
        assert shares(main)[end] > 10 * shares(wheel)[end]
    assert whole(where(scene, "C_zz@port@wheel"))


def test_places_of_bores_cones_and_materials():
    brass = sg.STEEL.with_changes(E="100 GPa")
    tube = {"length": 0.1, "diameter": 0.06, "bore": 0.03}
    flare = {"length": 0.02, "start_diameter": 0.06, "end_diameter": 0.08, "bore": 0.03}
    segments = [
        sg.Segment.cylinder("a", **{**tube, "bore": 0.02}),
        sg.Segment.cylinder("b", y0=0.1, **tube),
        sg.Segment.cylinder("c", y0=0.2, material=brass, **tube),
        sg.Segment.cone("d", y0=0.3, material=brass, **flare),
    ]
    scene = sg.Scene.from_parts(segments)
    found = [(p.what, p.y, p.r) for p in singular_places(scene) if "port" not in p.what]
    expected = [
        ("step of the bore", 0.1, 0.015),
        ("concave kink of the surface", 0.3, 0.03),
        ("change of material", 0.2, 0.03),
        ("change of material in the bore", 0.2, 0.015),
    ]
    assert [what for what, *_ in found] == [what for what, *_ in expected]
    assert np.allclose([at for _, *at in found], [at for _, *at in expected])


def test_a_bar_that_is_rounding_has_no_places():
    # axial waves of a rod are smooth, and order 12 has all their digits
    rod = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.02, diameter=0.05)])
    with pytest.raises(SolidgearError, match="which is rounding"):
        where(rod, "torsion 1", Meshed(order=10).options())


def test_the_picture_is_of_the_mesh_and_names_the_places(tmp_path):
    points = np.array([[0.0, 0.02, 0.02, 0.0, 0.02, 0.0], [0.0, 0.0, 0.1, 0.1, 0.3, 0.3]])
    cells = np.array([[0, 1, 2, 3], [3, 2, 4, 5]]).T
    file = tmp_path / "a.svg"
    shoulder = PlaceRecord(what="shoulder", y=0.1, r=0.02, share=0.9, reach=0.02)
    drawn = WhereRecord(
        points=points.tolist(), cells=cells.tolist(), shares=[0.9, 0.1], rows=[shoulder]
    )
    draw_where(file, drawn, "E")
    text = file.read_text()
    assert "1: shoulder, y = 100 mm, 90 %" in text and "radius drawn 2.1 times" in text
    assert "mm wide" not in text  # all of its cells can be seen
    with pytest.raises(SolidgearError, match=r"name that ends in .png or .svg"):
        draw_where(tmp_path / "a.gif", drawn)
    cut = where(shaft(*STEPPED), "C_zz", Meshed(cuts=CUT).options())
    first = next(row for row in cut.rows if row.what == "shoulder")
    draw_where(file, cut.model_copy(update={"rows": [first]}))
    near = np.hypot(*(cut.points - [[first.r], [first.y]]))
    wide = 2e3 * np.sqrt(near[near > 1e-9].min() * first.reach)
    assert f">1, {wide:.2g} mm wide<" in file.read_text() and wide < 5


@pytest.mark.long
def test_command_line(tmp_path):
    def run(*arguments):
        return command("answer", *map(str, arguments))

    scene, file = ROOT / "geometry" / "pinion_overhung.toml", tmp_path / "error.png"
    done = run(scene, "--tol", 1e-4, "--ask", "torsion", "--picture", file, "--json")
    told = json.loads(done.stdout)
    found, (value,) = told["where"], told["values"]
    first, last = (step["options"]["order"] for step in told["steps"] if step["unknowns"])
    assert first < last == found["order"]
    assert found["total"] == value["bar"] and found["rows"][0]["what"] == "shoulder"
    assert set(found) == {"quantity", "order", "total", "sentence", "seconds", "rows", "picture"}
    assert file.read_bytes().startswith(b"\x89PNG")
    # the last mesh is for torsion alone, and what is widest was solved on the one before
    told = json.loads(
        run(scene, "--tol", 2e-4, "--ask", "axial,torsion", "--where", "--json").stdout
    )
    bars = {value["quantity"]: value["bar"] for value in told["values"]}
    assert told["steps"][-1]["only"] == ["torsion 1"] and bars["axial 1"] > bars["torsion 1"]
    assert (told["where"]["quantity"], told["where"]["order"]) == ("axial 1", first)
    words = " ".join(run(scene, "--tol", 0.05, "--ask", "torsion", "--where").stdout.split())
    assert "of the error bar of torsion 1 arises at the shoulder at y = 68.25 mm" in words
    assert "(a bound by local problems, 0.0" in words
    assert "error of torsion 1" in words and "within, mm" in words
    assert run(scene, "--picture", tmp_path / "error.gif").exit_code != 0


@pytest.mark.long
def test_a_study_keeps_where_its_widest_bar_sits(scenes):
    scene = scenes["shaft_stepped"]
    solution = study(scene, "harmonic", share=2.0, evidence=False)
    found = recorded_places(scene, solution)
    bars = solution.error_bars[SCENE]
    assert found.quantity == max(usual(scene), key=lambda q: bars[q].width)
    assert found.model == "harmonic" and found.total == bars[found.quantity].width
    assert whole(arrays(found)) and len(found.shares) == len(found.cells[0])
    same = where(scene, found.quantity, solution.options)
    assert found.sentence == same.sentence and found.order == same.order
    # there planes of section ties are singular as well, which the richer space knows of
    assert np.allclose(found.shares, same.shares, atol=1e-4)
    solution.error_bars = {}
    assert recorded_places(scene, solution) is None
