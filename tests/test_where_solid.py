"""Where the error of a 3D solid sits: beside the harmonic solid, and beside meshes made finer there."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from skfem import MeshHex

import solidgear as sg
from solidgear.core.bounds.singular_places import Place
from solidgear.core.bounds.solid import solid_bounds
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.cell_places import ELSEWHERE, CellPlaces, place_of_most
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import SCENE
from solidgear.core.judge.where import error_places, least_certain, map_error, recorded_places
from solidgear.core.quantity import Quantity
from solidgear.cuts.features import CrossHole, Keyway
from solidgear.show.render import render_modes
from solidgear.show.where_surface import draw_surface, where_surface
from tests.test_body_patches import HEAD
from tests.test_body_patches import scene as body_file
from validation.mesh_files import write_boxes
from validation.shipped import GEOMETRY

#: a mesh of hexahedra of one layer at shoulders and none at the ends of seats, and of tetrahedra
HEX = {"layers": 1, "radial_layers": 1, "edge_layers": 0, "relative_size": 2.0, "around": 8}
TET = {"element": "tet10", "refinement": 0.2}
#: m; height of an L bracket, and thickness of both of its arms
TALL, THICK = 0.03, 0.01
HELD = """
[[bearing]]
name = "wall"
patch = "foot"
attachment = "rigid"
hold = "clamped"

[[port]]
name = "tip"
patch = "eye"
"""


def shaft(step=0.03, features=()):
    """A shaft with one shoulder on two bearings, thick before it."""
    segments = [
        sg.Segment.cylinder("thick", length=0.06, diameter=0.05),
        sg.Segment.cylinder("thin", length=0.08, diameter=step, y0=0.06),
    ]
    springs = np.diag([2e8, 1e8, 2e8, 1e4, 0.0, 1e4]).tolist()
    bearings = [
        sg.Bearing(name=name, y=y, seat_width=0.01, matrix=springs)
        for name, y in (("A", 0.015), ("B", 0.12))
    ]
    port = sg.Port(name="gear", y=0.04, lo=0.035, hi=0.045)
    scene = sg.Scene.from_parts(segments, bearings=bearings, port=port)
    return scene.with_changes(features=features)


def places(scene, quantity, options, model="solid"):
    return error_places(scene, Quantity(quantity), options, model)


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
    return True


@pytest.mark.slow
def test_layers_at_a_shoulder_take_away_its_part_of_the_bar_and_no_other():
    coarse, fine = (
        places(shaft(), "C_thx", {**HEX, "layers": n, "radial_layers": n}) for n in (1, 2)
    )
    assert whole(coarse) and whole(fine)
    first = coarse.rows[0]
    assert (first.what, first.y, first.r) == ("shoulder", 0.06, 0.015) and first.share > 0.7
    assert (first.x, first.z) == (None, None) and not coarse.cells
    assert "of the error bar of C_thx arises at the shoulder at y = 60 mm" in coarse.sentence
    before, after = (found.total * shares(found)["shoulder"] for found in (coarse, fine))
    # a layer of ratio 0.35 leaves 0.35 ** (2 * 0.5445) = 0.32 of what a right angle has
    assert after / before == pytest.approx(0.32, abs=0.1)
    assert fine.total - after == pytest.approx(coarse.total - before, rel=0.1)


@pytest.mark.parametrize("options", [pytest.param(HEX, marks=pytest.mark.long), TET])
def test_a_shaft_has_its_error_where_the_harmonic_solid_has_it(options):
    found, flat = (
        shares(places(shaft(), "bending 1", how, model))
        for how, model in ((options, "solid"), ({"order": 3}, "harmonic"))
    )
    assert found["shoulder"] == pytest.approx(flat["shoulder"], abs=0.2)
    assert max(found, key=found.get) == max(flat, key=flat.get) == "shoulder"


@pytest.mark.long
def test_a_shoulder_that_is_higher_has_more_of_the_error():
    low, high = (shares(places(shaft(step), "C_thx", TET)) for step in (0.047, 0.03))
    assert high["shoulder"] > 2 * low["shoulder"]


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_a_cell_belongs_to_the_sharpest_place_it_touches_or_to_the_nearest_in_reach(turn):
    mesh = MeshHex.init_tensor(np.array([1.0, 2.0]), np.arange(6.0), np.array([0.0, 1.0]))
    x, y, z = mesh.p
    c, s = np.cos(turn), np.sin(turn)
    points = np.array([c * x - s * z, y, s * x + c * z])
    sharp = Place("shoulder", 1.0, 1.0, reach=0.5, exponent=0.5)
    blunt = Place("seat end", 2.0, 1.0, reach=1.7, exponent=1.0)
    cells = CellPlaces((blunt, sharp), points, mesh.t, flat=False, axis=True)
    along = np.argsort(points[1, mesh.t].mean(axis=0))
    # one touches both, the fourth is 1.6 away from the seat, the last one 2.6
    assert cells.owners[:, along].tolist() == [[0, 0, 1, 1, 0], [1, 1, 0, 0, 0]]
    by_cells = np.zeros(5)
    by_cells[along] = 0.1, 0.2, 0.3, 0.15, 0.25
    listed = {share.what: share.share for share in cells.shares(by_cells)}
    assert listed == pytest.approx({"seat end": 0.45, "shoulder": 0.3, ELSEWHERE: 0.25})
    # two that are alike have a half each
    twin = CellPlaces((sharp, replace(blunt, exponent=0.5)), points, mesh.t, flat=False, axis=True)
    assert twin.owners[:, along[1]].tolist() == [0.5, 0.5]


def test_energies_of_cells_are_all_of_the_energy():
    scene = shaft()
    body = sg.build(scene, "solid", **TET)
    bounds = solid_bounds(scene, body, statics=True)
    forces = np.random.default_rng(4).normal(size=len(bounds.reached)) * np.tile(
        [1, 1, 1, 9, 9, 9], 3
    )
    by_cells = bounds.energy_by_cells(forces)
    assert len(by_cells) == body.geometry.solved.mesh.t.shape[1] and by_cells.min() >= 0
    # a little more, where the work of a function in one cell is below zero
    assert by_cells.sum() == pytest.approx(forces @ bounds.reached @ forces, rel=0.02)


def keyway(depth):
    return Keyway(name="key", segment="thin", y=0.07, length=0.04, width=0.009, depth=depth)


@pytest.mark.long
def test_a_deeper_keyway_is_named_and_has_more_of_the_error():
    shallow, deep = (
        places(shaft(0.046, (keyway(depth),)), "torsion 1", TET) for depth in (0.002, 0.012)
    )
    assert whole(shallow) and whole(deep)
    name = "keyway key"
    assert shares(deep)[name] > 3 * shares(shallow)[name]
    # the bar grows by what the keyway has of it
    others = [found.total * (1 - shares(found)[name]) for found in (shallow, deep)]
    assert others[1] == pytest.approx(others[0], rel=0.2)
    assert deep.rows[0].what == name and "arises at the keyway key at y = " in deep.sentence
    # a point of the keyway itself: within its ends, at the side it is cut into, above its floor
    row = deep.rows[0]
    assert 0.07 - 1e-6 <= row.y <= 0.11 + 1e-6 and abs(row.x) <= 0.0045 + 1e-6
    assert row.z > 0.008 - 1e-6 and row.r == pytest.approx(np.hypot(row.x, row.z))


def test_features_side_by_side_are_named_as_one():
    hole = CrossHole(name="oil", segment="thin", y=0.09, diameter=0.006)
    apart = CrossHole(name="pin", segment="thin", y=0.125, diameter=0.006, angle=np.pi / 2)
    scene = shaft(0.04, (keyway(0.005), hole, apart))
    body = sg.build(scene, "solid", **TET)
    cells = CellPlaces.of_body(scene, body)
    names = {place.what: place for place in cells.places}
    assert {"keyway key", "keyway key or cross hole oil", "cross hole pin"} <= set(names)
    y = names["cross hole pin"].points[1]
    assert 0.122 - 1e-4 <= y.min() and y.max() <= 0.128 + 1e-4
    # every cell belongs to places by whole parts or to none
    parts = cells.owners.sum(axis=0)
    assert np.all((np.abs(parts - 1) < 1e-12) | (parts == 0))


def bracket(folder, inner=THICK):
    """An L bracket of a mesh file, with its concave edge along x at y = z = `inner`."""
    lines = [np.linspace(0, THICK, 3), *(2 * [np.linspace(0, TALL, 7)])]
    patches = {"foot": lambda m: m[2] > TALL - 1e-9, "eye": lambda m: m[1] > TALL - 1e-9}
    write_boxes(folder / "l.msh", lines, patches, lambda m: (m[1] > inner) & (m[2] > inner))
    return sg.load(body_file(folder, "l.msh", more=HELD))


@pytest.mark.parametrize("inner", [0.010, 0.015])
def test_a_place_of_a_mesh_file_is_named_by_coordinates(tmp_path, inner):
    scene = bracket(tmp_path, inner)
    found = places(scene, "C_zz", {})
    assert whole(found)
    first = found.rows[0]
    assert first.what == "concave edge" and first.share > 0.5 and first.r is None
    assert (first.y, first.z) == pytest.approx((inner, inner), abs=1e-9)
    at = f"arises at the concave edge at x = {1e3 * first.x:.4g}, y = {1e3 * inner:g}, z = "
    assert f"{at}{1e3 * inner:g} mm" in found.sentence
    assert {"end of patch foot", "end of patch eye"} <= set(shares(found))
    # the edge runs all along x, and the border of a patch around it
    spots = {
        place.what: place.points
        for place in CellPlaces.of_body(scene, sg.build(scene, "solid")).places
    }
    x, y, z = spots["concave edge"]
    assert np.unique(x.round(9)).tolist() == [0.0, 0.005, 0.01]
    assert np.ptp(y) < 1e-9 and np.ptp(z) < 1e-9
    x, y, z = spots["end of patch foot"]
    inside = (x > 1e-9) & (x < THICK - 1e-9) & (y > 1e-9) & (y < inner - 1e-9)
    assert np.allclose(z, TALL) and not inside.any()


def test_a_smooth_free_block_has_its_error_in_cells_at_coordinates(tmp_path):
    path = tmp_path / "block.toml"
    path.write_text(f"{HEAD}body = {{ block = [0.02, 0.06, 0.01] }}\n")
    scene = sg.load(path)
    body = sg.build(scene, "solid", refinement=0.5)
    count = body.geometry.solved.mesh.t.shape[1]
    by_cells = np.zeros(count)
    by_cells[3] = 1.0
    x, y, z = 1e3 * CellPlaces.of_body(scene, body).middles[:, 3]
    assert place_of_most(scene, body, by_cells) == (
        f"cells at x = {x:.4g}, y = {y:.4g}, z = {z:.4g} mm"
    )


@pytest.mark.long
def test_a_study_keeps_where_its_widest_bar_sits():
    scene = shaft().with_changes(ask=shaft().ask.with_changes(tolerance=0.5))
    solution = study(scene, "solid", TET, evidence=False)
    found, name = recorded_places(scene, solution), least_certain(scene, solution)
    assert found.quantity == name and found.model == "solid"
    assert found.total == solution.error_bars[SCENE][name].width
    assert solution.scores[name].sum() == pytest.approx(1.0) and whole(found)
    same = places(scene, name, solution.options)
    assert same.rows[0].what == found.rows[0].what
    solution.scores = {}
    assert recorded_places(scene, solution) is None


@pytest.mark.slow
def test_a_corrected_solid_has_its_error_at_the_cut_that_corrects_it(tmp_path):
    scene = shaft(0.046, (keyway(0.012),))
    error_map = map_error(scene, Quantity("torsion 1"), {"refinement": 0.3}, "corrected")
    assert whole(error_map.record) and error_map.record.rows[0].what == "keyway key"
    job = where_surface(error_map.body, error_map.by_cells, "", tmp_path / "error.png")
    assert len(job.shades) == len(job.surface.triangles) and job.shades.max() > 0


def test_teeth_of_a_sector_are_named():
    found = places(
        sg.load(GEOMETRY / "pinion_toothed.toml"), "C_zz", {"refinement": 0.25}, "sector"
    )
    assert whole(found) and found.rows[0].what in ("teeth teeth", "shoulder")
    assert shares(found)["teeth teeth"] > 0.2


def test_a_model_without_computed_bars_says_so():
    with pytest.raises(SolidgearError, match="the Timoshenko beam has no error bar by cells"):
        places(shaft(), "C_zz", {}, "timoshenko")


@pytest.mark.long
def test_the_surface_is_drawn_in_the_colours_of_its_cells(tmp_path):
    body = sg.build(shaft(), "solid", **HEX)
    mesh = body.geometry.solved
    # the only cells with a share are those at the far end
    middle = mesh.mesh.p[:, mesh.mesh.t].mean(axis=1)
    by_cells = np.where(middle[1] > 0.12, 1.0, 0.0)
    job = where_surface(body, by_cells, "C_zz", tmp_path / "error.png")
    surface = job.surface
    y = surface.points[surface.faces].mean(axis=1)[:, 1]
    assert len(job.shades) == len(surface.faces) and set(job.shades.tolist()) == {0.0, 1.0}
    assert y[job.shades > 0].min() > 0.11 and y[job.shades == 0].max() < 0.13
    (result,) = render_modes([job])
    if "OpenGL" in result.reason:
        pytest.skip(result.reason)
    assert result.ok and job.path.stat().st_size < 100_000
    with Image.open(job.path) as kept:
        red, green, _ = np.asarray(kept.convert("RGB")).astype(int).transpose(2, 0, 1)
    dark = (red > 2 * green + 40)[90:390]  # of the surface, not of its colour bar
    columns = np.flatnonzero(dark.sum(axis=0) > 20)  # letters have less
    # the end of a shaft that fills the picture: what has a share lies at the right of it
    assert dark.sum() > 2000 and columns.min() > 0.75 * dark.shape[1]


def test_halves_and_sectors_are_drawn_whole(tmp_path):
    half = sg.build(shaft(0.046, (keyway(0.012),)), "solid", **TET)
    sector = sg.build(sg.load(GEOMETRY / "pinion_toothed.toml"), "sector", refinement=0.25)
    for body, copies in ((half, 2), (sector, 28)):
        mesh = body.geometry.solved
        job = where_surface(body, np.arange(mesh.mesh.t.shape[1]) + 1.0, "C_zz", tmp_path / "a.png")
        owners = mesh.outline.owners
        assert len(job.shades) == copies * len(owners)
        assert np.array_equal(job.shades[: len(owners)], job.shades[-len(owners) :])
        # a face lies in the cell that it has the colour of
        corners = mesh.mesh.p[:, mesh.mesh.t[:, owners]]
        at = mesh.outline.points[mesh.outline.triangles].mean(axis=1).T
        near = 0.2 * np.ptp(corners, axis=1).max(axis=0)
        assert np.all(at > corners.min(axis=1) - near) and np.all(at < corners.max(axis=1) + near)


def test_a_picture_that_cannot_be_drawn_costs_no_number(tmp_path):
    body = sg.build(shaft(), "solid", **HEX)
    shares_of_cells = np.ones(body.geometry.solved.mesh.t.shape[1])
    reason = draw_surface(body, shares_of_cells, "C_zz", tmp_path / "error.svg")
    assert reason == "the surface of a 3D solid is drawn as .png, not as .svg"
