"""The shapes that a page turns: closed surfaces, true motions, comparable planes and signs."""

import base64
import json
import re
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.scene.closed_form import volume_of
from solidgear.core.scene.outline import Outline
from solidgear.show import packing, viewer
from solidgear.show.packing import mesh_of
from solidgear.show.scales import MOTION, rgb
from solidgear.show.turning import picks, turned
from tests.command import command

ROOT = Path(__file__).parents[1]
KINDS = ("timoshenko", "harmonic", "solid")


def told(fragment):
    """The data that a fragment hands its script."""
    return json.loads(re.search(r'class="data">(.*?)</script>', fragment, re.S)[1])


def unpacked(text):
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).reshape(4, -1)
    code = (planes.astype(np.int64) << np.array([[0], [8], [16], [24]])).sum(axis=0)
    return np.cumsum(np.where(code % 2, -(code + 1) // 2, code // 2))


def drawn(fragment):
    """Points, triangles and displacements by name of the one body that a page draws."""
    (model,) = told(fragment)["models"]
    (body,) = model["bodies"]
    moved = {s["name"]: s["step"] * unpacked(s["moved"][0]) for s in model["shapes"]}
    return (
        (body["step"] * unpacked(body["points"])).reshape(3, -1).T,
        unpacked(body["triangles"]).reshape(-1, 3),
        {name: columns.reshape(3, -1).T for name, columns in moved.items()},
    )


def closed_volume(points, triangles):
    """Volume in a surface of which every edge is of two triangles."""
    _, one = np.unique(points.round(9), axis=0, return_inverse=True)  # split at sharp edges
    pairs = one.ravel()[np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])]
    assert set(np.unique(np.sort(pairs, axis=1), axis=0, return_counts=True)[1]) == {2}
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij", np.cross(a, b), c)) / 6


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_drawn_is_closed_and_has_the_volume_of_the_shaft(kind, drawable, overhung):
    points, triangles, _ = drawn(viewer.viewer_fragment([turned(*drawable(kind))]))
    # 48 sides for a circle are 0.3 % too little area; outward normals make it positive
    assert closed_volume(points, triangles) == pytest.approx(
        volume_of(Outline(overhung.segments)), rel=0.01
    )
    assert len(np.unique(triangles)) == len(points)


@pytest.mark.long
def test_edges_are_drawn_where_the_surface_is_sharp(drawable):
    mesh = turned(*drawable("harmonic")).mesh
    # both ends, and both rims of the head where it meets cone and shaft, in 48 pieces each
    assert len(mesh.edges) == 48 * 4
    assert np.ptp(mesh.points[mesh.edges][:, :, 1], axis=1).max() < 1e-9


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_drawn_moves_as_the_body_does(kind, drawable):
    body, modes = drawable(kind)
    model = turned(body, modes)
    points, _, shapes = drawn(viewer.viewer_fragment([model]))
    rest = body.surface({}).points
    np.testing.assert_allclose(points, rest[model.mesh.source], atol=1e-6 * np.ptp(rest[:, 1]))
    assert list(shapes) == [m.name for m in modes.modes if m.frequency_hz > 0]
    for name, seen in shapes.items():
        own = [
            body.surface(vectors).displacement[model.mesh.source].ravel()
            for vectors in modes.named(name).vectors
        ]
        # of a pair any combination is a shape of the body
        factors, *_ = np.linalg.lstsq(np.column_stack(own), seen.ravel(), rcond=None)
        left = seen - (np.column_stack(own) @ factors).reshape(-1, 3)
        largest = np.linalg.norm(seen, axis=1).max()
        assert largest == pytest.approx(1, abs=1e-3)
        # half a step in each of three directions is 8.7e-4
        assert np.linalg.norm(left, axis=1).max() < 1e-3 * largest


def test_models_side_by_side_bend_the_same_way(drawable):
    models = []
    for kind in KINDS:
        models.append(turned(*drawable(kind), like=models))
    for model in models:
        bent = model.shapes[model.index("bending 1")]
        assert bent.pair
        across, up = np.abs(bent.displacement[:, [0, 2]]).max(axis=0)
        # sections do not stay quite round: poisson's motion across is a few hundredths
        assert up > 0.9 and across < 0.1
    ends = [m.shapes[m.index("bending 2")].displacement for m in models]
    fronts = [d[m.mesh.points[:, 1] < 1e-6, 2].mean() for d, m in zip(ends, models)]
    assert len({np.sign(v) for v in fronts}) == 1


def test_which_shapes_of_a_pair_and_which_sign_a_solver_gives_is_not_seen(drawable):
    body, modes = drawable("solid")
    mode = modes.named("bending 1")
    one, other = mode.vectors
    c, s = np.cos(2.0), np.sin(2.0)

    def combined(a, b):
        blocks = one.keys() | other.keys()
        return {k: a * one.get(k, 0.0) + b * other.get(k, 0.0) for k in blocks}

    mixed = replace(mode, vectors=(combined(c, s), combined(-s, c)))
    here, there = (turned(body, [m]).shapes[0].displacement for m in (mode, mixed))
    np.testing.assert_allclose(here, there, atol=1e-6)
    plain = turned(body, [mode])
    negative = replace(mode, vectors=tuple({k: -v for k, v in x.items()} for x in mode.vectors))
    np.testing.assert_allclose(turned(body, [negative], like=[plain]).shapes[0].displacement, here)


def test_two_halves_of_a_part_become_one_surface():
    scene = sg.load(ROOT / "geometry" / "pinion_keyed.toml")
    body = sg.build(scene, "solid", refinement=0.5)
    mesh = mesh_of(body.surface({}))
    mass = body.mass_matrix()[1, 1]
    assert closed_volume(mesh.points, mesh.triangles) == pytest.approx(
        mass / scene.material.density, rel=0.01
    )
    # nothing is left of the plane between the halves
    middle = mesh.points[mesh.triangles][:, :, 0]
    flat = (np.abs(middle) < 1e-9).all(axis=1)
    assert not flat.any()


def test_modes_of_all_models_are_listed_once(drawable):
    models = [turned(*drawable(kind)) for kind in ("harmonic", "timoshenko")]
    rows = picks(models)
    names = [row["name"] for row in rows]
    assert len(names) == len(set(names))
    assert [row["hz"] for row in rows] == sorted(row["hz"] for row in rows)
    row = rows[names.index("bending 1")]
    assert [m.shapes[k].name for m, k in zip(models, row["at"])] == ["bending 1"] * 2


def test_a_page_stays_small_and_alone(drawable, monkeypatch):
    models = [turned(*drawable(kind)) for kind in KINDS]
    page = viewer.Turning(tuple(models), "three models").page()
    assert len(page) < 200_000
    assert not re.search(r"(src|href)=|https?://|import\(|fetch\(", page)
    assert [m["title"] for m in told(page)["models"]] == [*KINDS]
    # what would not fit is left out from the end, and nothing refers to it
    monkeypatch.setattr(viewer, "BUDGET", 1)
    less = told(viewer.viewer_fragment(models))
    assert [m["title"] for m in less["models"]] == ["timoshenko"]
    assert {len(row["at"]) for row in less["modes"]} == {1}


def test_words_of_a_scene_cannot_leave_their_place(drawable, tmp_path):
    nasty = "</script><b>&"
    model = turned(*drawable("timoshenko"), title=nasty)
    path = viewer.Turning((model,), nasty).write(tmp_path / "model.html")
    page = path.read_text()
    assert nasty not in page
    fragment = viewer.fragment_of(path)
    assert told(fragment)["models"][0]["title"] == nasty
    assert fragment.startswith(viewer.START) and fragment.endswith(viewer.END)
    assert viewer.fragment_of(tmp_path / "none.html") == ""


def test_a_notebook_shows_it_in_a_frame_of_its_own(drawable):
    found = sg.turn(*drawable("harmonic"), drawable("timoshenko"))
    assert repr(found).startswith("Models to turn: harmonic (")
    shown = found._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "<script" not in shown


def test_rigid_motions_are_no_modes_to_turn(drawable):
    body, modes = drawable("timoshenko")
    rigid = [m for m in modes.modes if not m.frequency_hz > 0]
    assert rigid
    with pytest.raises(SolidgearError, match="no elastic mode"):
        turned(body, rigid)


@pytest.mark.long
def test_a_comparison_puts_it_into_its_report(tmp_path, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_RENDERER", "none")
    scene = sg.load(ROOT / "geometry" / "cylinder_free.toml")
    found = sg.compare(scene, models=("lumped", "euler", "timoshenko"))
    found.write_report(tmp_path)
    assert viewer.TURNED in found.record.files
    page = (tmp_path / "report.html").read_text()
    assert page.count(viewer.START) == 1
    # the finest model first
    assert [m["title"] for m in told(page)["models"]] == ["Timoshenko beam", "Euler beam"]
    found.write_report(tmp_path, renders=False)
    assert not (tmp_path / viewer.TURNED).exists()
    assert viewer.START not in (tmp_path / "report.html").read_text()


def test_the_command_writes_a_page_also_where_nothing_can_be_drawn(tmp_path, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_RENDERER", "none")
    scene, target = str(ROOT / "geometry" / "pinion_overhung.toml"), tmp_path / "model.html"
    words = ["render", scene, "-f", "timoshenko", "--beside", "euler", "--mode", "torsion 1"]
    done = command(*words, "--turn", str(target))
    assert done.exit_code == 0, done.output
    assert "no picture for print in model.html" in done.stderr
    data = told(target.read_text())
    assert [m["title"] for m in data["models"]] == ["Timoshenko beam", "Euler beam"]
    assert data["models"][0]["shapes"][data["first"]]["name"] == "torsion 1"
    assert not list(tmp_path.glob("*.png"))
    refused = command(*words)
    assert refused.exit_code == 1 and isinstance(refused.exception, SolidgearError)


def test_a_page_has_the_colours_of_pictures(drawable):
    fragment = viewer.viewer_fragment([turned(*drawable("timoshenko"))])
    given = np.reshape(told(fragment)["ramp"], (-1, 3))
    # a place of the four that are written
    np.testing.assert_allclose(given, [rgb(c) / 255 for c in MOTION], rtol=0, atol=1e-4)
    assert f"uRamp[{len(MOTION)}]" in fragment and ", ".join(MOTION) in fragment


def test_points_that_coincide_are_those_that_a_tree_finds():
    random = np.random.default_rng(0)
    points = random.integers(0, 6, (400, 3)) + 1e-9 * random.standard_normal((400, 3))
    near = {tuple(pair) for pair in cKDTree(points).query_pairs(1e-8, output_type="ndarray")}
    pairs = (np.transpose(pair) for pair in packing._pairs(points, 1e-8))
    assert {tuple(pair) for some in pairs for pair in some} == near
    assert len(near) > 100


def test_the_page_of_mode_shapes_has_the_cautions_of_its_frequencies(tmp_path, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_RENDERER", "none")
    disc = ROOT / "tests" / "found" / "spin" / "disc_at_speed.toml"
    sg.compare(disc, models=("euler",)).write_report(tmp_path)
    pages = [(tmp_path / name).read_text("utf-8") for name in ("report.html", viewer.TURNED)]
    assert all("at 12000 rpm spin moves bending 1" in page for page in pages)
