"""Where the error of a compliance sits: whether the parts make the whole, and are where they are."""

import json
from pathlib import Path

import numpy as np
import pytest
from skfem.element import ElementQuadP
from typer.testing import CliRunner

import solidgear as sg
from solidgear.cli.app import app
from solidgear.errors import SolidgearError
from solidgear.evidence.places import singular_places
from solidgear.evidence.where import ELSEWHERE, PLACED, USUAL, Row, where
from solidgear.fidelity import harmonic_energy
from solidgear.fidelity.harmonic_energy import Meridional
from solidgear.report.where_chart import draw_where

ROOT = Path(__file__).parent.parent
RADIAL = {"kxx": "5e8 N/m", "kzz": "5e8 N/m"}
#: orders differ in their quadrature, which is not exact on cones: 2e-3 of the change was the most
#: on random shafts, 6e-5 on these scenes
SUMS = 1e-2


@pytest.fixture(scope="module")
def scenes():
    names = ("pinion_overhung", "shaft_stepped", "cylinder_free")
    return {name: sg.load(ROOT / "geometry" / f"{name}.toml") for name in names}


def shaft(*segments, seats=(40.0, 360.0), port=(380.0, 400.0), second=RADIAL, **changes):
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
    at = f"{sum(port) / 2} mm"
    point = sg.Port(y=at, lo=f"{port[0]} mm", hi=f"{port[1]} mm", **changes)
    return sg.Scene.from_parts(parts, bearings=bearings, port=point)


def shares(found):
    out = {}
    for row in found.rows:
        out[row.what] = out.get(row.what, 0.0) + row.share
    return out


@pytest.mark.parametrize(
    "name, quantity, place",
    [
        ("pinion_overhung", "C_zz", (2, 2)),
        ("shaft_stepped", "C_thx", (3, 3)),
        ("shaft_stepped", "C_yy", (1, 1)),
    ],
)
def test_the_energies_add_up_to_the_change_of_the_compliance(scenes, name, quantity, place):
    scene = scenes[name]
    found = where(scene, quantity)
    assert found.check == pytest.approx(1.0, abs=SUMS)
    family = ("axial",) if quantity == "C_yy" else ("bending",)
    supports = sg.body.as_supports(scene).on((1,) if quantity == "C_yy" else (0, 2, 3, 5))
    c = []
    for order in (3, 4):
        body = sg.build(scene, "harmonic", **{**USUAL, "order": order, "families": family})
        c.append(sg.condense(body, supports, scene.port.name).compliance[place])
    # another way to the same compliances, which differ in the fourth digit and are good to 1e-9
    assert found.total == pytest.approx(c[1] / c[0] - 1, rel=1e-3)
    assert sum(row.share for row in found.rows) == pytest.approx(1.0, abs=1e-9)
    assert found.shares.sum() == pytest.approx(1.0, abs=1e-6)  # less what springs take up
    assert all(row.share >= 0 for row in found.rows)


def test_the_error_is_at_the_only_shoulder_and_moves_with_it():
    for at in (150.0, 220.0):
        # with a layer at seat ends, whose share is as large as the shoulder's without one
        found = where(shaft((at, 60), (400 - at, 40)), "C_zz", {"edge_layers": 1})
        first = found.rows[0]
        assert first.what == "shoulder" and first.share > 0.8
        assert (first.y, first.r) == pytest.approx((at / 1e3, 0.020))
        assert f"at the shoulder at y = {at:g} mm" in found.sentence
        # and the cell with the most of it touches the corner, or its neighbour does
        cell = found.points[:, found.cells[:, found.shares.argmax()]]
        assert np.hypot(*(cell - [[first.r], [first.y]])).min() < 0.020


def test_a_shaft_without_shoulders_has_its_error_at_seats_or_elsewhere():
    found = where(shaft((400.0, 50)), "C_zz")
    assert found.check == pytest.approx(1.0, abs=SUMS)
    assert {row.what for row in found.rows} == {
        *("seat end of A", "seat end of B", "seat end of port"),
        *(ELSEWHERE, "bearings"),
    }
    assert abs(found.total) < 1e-4  # a shoulder leaves ten times as much


@pytest.mark.parametrize("attachment", ["average", "rigid"])
def test_the_energies_of_any_displacement_are_those_of_its_block(attachment):
    scene = shaft((150.0, 60), (250.0, 40), attachment=attachment)
    body = sg.build(scene, "harmonic", **USUAL)
    cells = Meridional(scene, body)
    for k, block in enumerate(body.blocks):
        u = np.random.default_rng(k).standard_normal((block.size, 2))
        found = cells.energies(k, cells.local(k, u)).energy.sum(axis=(2, 3))
        assert np.allclose(found, u.T @ (block.stiffness @ u), rtol=1e-11)  # the same sum


@pytest.mark.parametrize("attachment", ["rigid", "section"])
def test_other_ties_add_up_and_have_their_places(attachment):
    found = where(shaft((150.0, 60), (250.0, 40), attachment=attachment), "C_thx")
    assert found.check == pytest.approx(1.0, abs=SUMS)
    word = "seat end of A" if attachment == "rigid" else "section plane of A"
    # the tie of the loaded seat is as singular as a crack, or a plane without layers of its own
    assert word in shares(found)
    assert shares(found)[word.replace("of A", "of port")] > 0.02


def test_a_coupling_is_the_product_of_two_errors(scenes):
    found = where(scenes["pinion_overhung"], "C_z,thx")
    assert found.check == pytest.approx(1.0, abs=SUMS)
    # C_z,thx is negative; of its error the shoulder has about half, and ends of seats the rest
    assert found.rows[0].what == "shoulder"
    assert found.rows[0].share == pytest.approx(-0.5, abs=0.1)
    assert sum(abs(row.share) for row in found.rows) == pytest.approx(1.0)


def test_bearings_that_couple_families_bring_their_energies_along():
    couplings = {"kyz": "2e8 N/m", "kz_thy": "4e6 N/rad"}
    tilted = {**RADIAL, "kyy": "3e8 N/m", "kthy": "1e5 N*m/rad", **couplings}
    found = where(shaft((150.0, 60), (250.0, 40), second=tilted), "C_zz")
    assert found.check == pytest.approx(1.0, abs=SUMS)
    # more supports than statics needs: their springs take up some of the error
    assert shares(found)["bearings"] > 1e-8


def test_an_order_of_another_basis_is_judged_too():
    # order 2 is nodal, order 3 hierarchical
    found = where(shaft((150.0, 60), (250.0, 40)), "C_zz", {"order": 2})
    assert found.check == pytest.approx(1.0, abs=SUMS) and found.order == 2


@pytest.mark.parametrize("broken", [lambda up: 1.01 * up, lambda up: np.eye(*up.shape)])
def test_a_wrong_embedding_does_not_add_up(monkeypatch, broken):
    right = harmonic_energy.embedding
    monkeypatch.setattr(harmonic_energy, "embedding", lambda a, b: broken(right(a, b)))
    assert not abs(where(shaft((150.0, 60), (250.0, 40)), "C_zz").check - 1) < SUMS


def test_an_element_that_does_not_hold_the_other_is_refused():
    with pytest.raises(SolidgearError, match="are none of"):
        harmonic_energy.embedding(ElementQuadP(4), ElementQuadP(3))


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


def test_what_has_no_places_is_refused(scenes):
    scene = scenes["shaft_stepped"]
    with pytest.raises(SolidgearError, match="there are those of C_zz"):
        where(scene, "K_zz")
    with pytest.raises(SolidgearError, match="from 1 to 11"):
        where(scene, "C_zz", {"order": 12})
    with pytest.raises(SolidgearError, match="the motion is free"):
        where(scenes["cylinder_free"], "C_zz")
    symmetric = shaft((400.0, 50), port=(190.0, 210.0))
    with pytest.raises(SolidgearError, match="which is rounding"):
        where(symmetric, "C_z,thx")


def test_the_picture_is_of_the_cells_and_names_the_places(tmp_path):
    points = np.array([[0.0, 0.02, 0.02, 0.0, 0.02, 0.0], [0.0, 0.0, 0.1, 0.1, 0.3, 0.3]])
    cells = np.array([[0, 1, 2, 3], [3, 2, 4, 5]]).T
    file = tmp_path / "a.svg"
    draw_where(file, points, cells, np.array([0.9, 0.1]), [Row("shoulder", 0.1, 0.02, 0.9)], "E")
    text = file.read_text()
    assert "1: shoulder, y = 100 mm, 90 %" in text and "radius drawn 2.1 times" in text
    with pytest.raises(SolidgearError, match=r"use .png or .svg"):
        draw_where(tmp_path / "a.gif", points, cells, np.ones(2))


def test_command_line(tmp_path):
    def run(*arguments):
        return CliRunner().invoke(app, ["answer", *map(str, arguments)])

    scene, file = ROOT / "geometry" / "pinion_overhung.toml", tmp_path / "error.png"
    done = run(scene, "--tol", 0.05, "--ask", "bending", "--picture", file, "--json")
    found = json.loads(done.stdout)["where"]
    assert found["quantity"] == "C_zz" and found["rows"][0]["what"] == "shoulder"
    shares = [row["share"] for row in found["rows"]]
    assert shares == sorted(shares, reverse=True)
    assert found["stands_for"] == "bending 1"
    # what was asked itself comes before what stands for something, whose bar is wider here
    plain = ROOT / "geometry" / "shaft_stepped.toml"
    asked = run(plain, "--tol", 0.05, "--ask", "bending,C_yy", "--where", "--json")
    asked = json.loads(asked.stdout)
    bars = {value["quantity"]: value["bar"] for value in asked["values"]}
    assert bars["bending 1"] > bars["C_yy"] and asked["where"]["quantity"] == "C_yy"
    assert asked["where"]["stands_for"] is None
    assert file.read_bytes().startswith(b"\x89PNG")
    told = run(scene, "--tol", 0.05, "--ask", "C_yy", "--where").stdout
    assert "of what is left in C_yy sits at the shoulder at y = 68.25 mm" in told
    assert "error of C_yy" in told and "within, mm" in told
    none = run(scene, "--tol", 0.05, "--ask", "torsion", "--where")
    assert "Where the error sits: only known of C_zz" in none.stdout
    wrong = run(scene, "--picture", tmp_path / "error.gif")
    assert wrong.exit_code != 0


@pytest.mark.slow
def test_a_comparison_keeps_where_the_error_of_its_judge_sits(scenes):
    found = sg.compare(scenes["shaft_stepped"], models=("harmonic",)).record.where
    assert found.model == "harmonic" and found.quantity in PLACED
    assert found.check == pytest.approx(1, abs=0.01)  # energies sum to the change to two digits
    assert "shoulder" in found.sentence and found.sentence.count("mm") >= 1
    assert len(found.shares) == len(found.cells[0])
