"""Surface fields, pictures and VTU files."""

import json
import os
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista as pv
from scipy.spatial import cKDTree
from skfem.quadrature import get_quadrature
from skfem.refdom import RefHex, RefTet

import solidgear as sg
from solidgear.comparison.page import write
from solidgear.core.elements import ELEMENTS
from solidgear.core.errors import SolidgearError
from solidgear.core.machine.processes import Other
from solidgear.core.scene.closed_form import volume_of
from solidgear.core.scene.outline import Outline
from solidgear.core.solve.modes import Mode
from solidgear.show import canvas, drawing, render
from solidgear.show.folder import OWN, clear
from solidgear.show.outputs import OUTPUTS, Output, node_order, write_vtu
from solidgear.show.render import PACKAGES, Drawing, RenderJob, render_modes
from solidgear.show.scales import MOTION, YLORRD

ROOT = Path(__file__).parents[1]
SOLID = {"refinement": 0.5}
RIGID = {"attachments": ("rigid",)}


def unit_motion(body, component):
    return {
        i: b.rigid[:, b.components.index(component)]
        for i, b in enumerate(body.blocks)
        if component in b.components
    }


@pytest.mark.parametrize(
    "name", ["pinion_overhung", pytest.param("shaft_hollow", marks=pytest.mark.slow)]
)
@pytest.mark.parametrize(
    "fidelity, options",
    [
        ("euler", {}),
        ("timoshenko", {}),
        ("harmonic", {"order": 1}),
        ("harmonic", {"order": 2} | RIGID),
        pytest.param("harmonic", {"order": 5}, marks=pytest.mark.slow),
        ("solid", {"element": "hex8"} | SOLID),
        ("solid", {"element": "hex20"} | SOLID | RIGID),
        ("solid", {"element": "tet10", "size": 0.06, "graded_size": 0.06}),
    ],
)
def test_six_rigid_motions_and_a_closed_surface(name, fidelity, options):
    scene = sg.load(ROOT / "geometry" / f"{name}.toml")
    body = sg.build(scene, fidelity, **options)
    for component in range(6):
        s = body.surface(unit_motion(body, component))
        axis = np.eye(3)[component % 3]
        wanted = (
            np.broadcast_to(axis, s.points.shape) if component < 3 else np.cross(axis, s.points)
        )
        np.testing.assert_allclose(s.displacement, wanted, rtol=0, atol=1e-14)

    # Every edge belongs to two faces that run along it in opposite senses, so the surface is closed
    # and oriented.
    sides = [s.faces[:, [i, (i + 1) % 4]] for i in range(4)] + [
        s.triangles[:, [i, (i + 1) % 3]] for i in range(3)
    ]
    count = Counter(map(tuple, np.concatenate(sides)))
    assert all(count[a, b] == count[b, a] == 1 for a, b in count)
    p = s.points
    three = np.concatenate([s.faces[:, :3], s.faces[:, [0, 2, 3]], s.triangles])
    volume = np.einsum("ij,ij->", p[three[:, 0]], np.cross(p[three[:, 1]], p[three[:, 2]])) / 6
    # 48 chords around enclose 0.29 % less than a circle; 8 straight elements 10 %
    assert volume == pytest.approx(
        volume_of(Outline(scene.segments)), rel=0.11 if options.get("element") == "hex8" else 0.01
    )


def test_ovalising_shapes_move_as_their_harmonic(overhung):
    body = sg.build(overhung, "harmonic", order=2, ovalising=(2,))
    index = next(i for i, b in enumerate(body.blocks) if b.name == "ovalising_2")
    s = body.surface({index: np.ones(body.blocks[index].size)})
    x, _, z = s.points.T
    t = np.arctan2(x, z)
    # all unknowns one: U = 2, V = 0, W = 1 beyond the cells that touch the axis, where they are
    # held at zero
    off, on = np.hypot(x, z) > 0.04, np.hypot(x, z) < 1e-9
    radial = s.displacement[:, 0] * np.sin(t) + s.displacement[:, 2] * np.cos(t)
    around = s.displacement[:, 0] * np.cos(t) - s.displacement[:, 2] * np.sin(t)
    np.testing.assert_allclose(radial[off], 2 * np.cos(2 * t[off]), atol=1e-12)
    np.testing.assert_allclose(around[off], 0, atol=1e-12)
    np.testing.assert_allclose(s.displacement[off, 1], np.cos(2 * t[off]), atol=1e-12)
    np.testing.assert_allclose(s.displacement[on], 0, atol=1e-12)


def first_bending(body, modes):
    return [body.surface(v) for v in modes.named("bending 1").vectors]


@pytest.mark.parametrize("fidelity, share", [("harmonic", 0.01), ("timoshenko", 0.08)])
def test_first_bending_moves_as_in_the_solid(drawable, fidelity, share):
    pair, others = first_bending(*drawable(fidelity)), first_bending(*drawable("solid"))
    distance, at = cKDTree(pair[0].points).query(others[0].points)
    near = distance < 1e-3
    assert near.sum() > 300
    basis = np.column_stack([s.displacement[at[near]].ravel() for s in pair])
    turn = []
    for other in others:
        target = other.displacement[near].ravel()
        # A pair may be turned about the axis: two numbers align it. Left over are 0.4 % (harmonic)
        # and 5.9 % (beam, whose sections stay plane).
        c, *_ = np.linalg.lstsq(basis, target, rcond=None)
        assert np.linalg.norm(basis @ c - target) < share * np.linalg.norm(target)
        turn.append(c)
    # Both sides are normalised to unit mass, so the alignment is a rotation and hides no scale.
    np.testing.assert_allclose(np.array(turn) @ np.array(turn).T, np.eye(2), atol=2 * share)


def test_what_does_not_fit_is_refused(drawable):
    body, _ = drawable("timoshenko")
    with pytest.raises(SolidgearError, match="block bending_z has"):
        body.surface({0: np.zeros(3)})


def bending_jobs(drawable, folder):
    jobs = []
    for fidelity in ("timoshenko", "harmonic"):
        body, modes = drawable(fidelity)
        mode = modes.named("bending 1")
        title = f"{fidelity} - {mode.name} - {mode.frequency_hz:.1f} Hz"
        jobs.append(RenderJob(body.surface(mode.vectors[0]), title, folder / f"{fidelity}.png"))
    return jobs


@pytest.mark.long
def test_pictures(drawable, tmp_path):
    from matplotlib.image import imread
    from PIL import Image

    jobs = bending_jobs(drawable, tmp_path)
    still = jobs[0].surface
    dead = RenderJob(
        type(still)(still.points, 0 * still.points, still.faces, still.triangles, still.lines),
        "still",
        tmp_path / "still.png",
    )
    *results, refused = render_modes([*jobs, dead])
    if any("OpenGL" in r.reason for r in results):
        pytest.skip(results[0].reason)
    for result in results:
        assert result.ok, result.reason
        picture = (imread(result.path)[:, :, :3] * 255).round().astype(int)
        assert picture.shape == (700, 1200, 3)
        colours = np.unique(picture.reshape(-1, 3) @ [65536, 256, 1])
        # a palette of its own: half the bytes of 24 bits, and as many colours as that holds
        with Image.open(result.path) as kept:
            assert kept.mode == "P"
        assert 200 < len(colours) <= 256
        covered = (picture < 250).any(axis=2)
        assert 0.2 < covered.mean() < 0.7
        columns = np.flatnonzero(covered[100:580].any(axis=0))
        assert np.ptp(columns) > 0.7 * 1200
    # One picture that cannot be drawn costs no other, and leaves nothing behind.
    assert not refused.ok and "zero or not finite" in refused.reason
    assert sorted(p.name for p in tmp_path.iterdir()) == ["harmonic.png", "timoshenko.png"]


def test_without_a_renderer_there_is_a_sentence_and_no_file(drawable, tmp_path, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_RENDERER", "none")
    results = render_modes(bending_jobs(drawable, tmp_path))
    assert len(results) == 2
    for r in results:
        assert not r.ok
        assert PACKAGES in r.reason and "\n" not in r.reason
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "death, timeout",
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", 60),
        ("import time; time.sleep(60)", 1),
    ],
)
def test_a_child_that_dies_or_hangs_is_survived(drawable, tmp_path, monkeypatch, death, timeout):
    fake = tmp_path / "python"
    fake.write_text(f"#!{sys.executable}\n{death}\n")
    fake.chmod(0o755)
    monkeypatch.setattr(render.sys, "executable", str(fake))
    out = tmp_path / "out"
    results = render_modes(bending_jobs(drawable, out), timeout=timeout)
    assert [r.ok for r in results] == [False, False]
    assert all(PACKAGES in r.reason for r in results)
    assert ("signal 11" in results[0].reason) == ("SIGSEGV" in death)
    assert not out.exists()


def test_a_child_is_gone_when_its_caller_has_left(drawable, tmp_path, monkeypatch):
    """Pictures are drawn beside what the caller does; Ctrl-C in there leaves no process behind."""
    fake, told = tmp_path / "python", tmp_path / "told"
    fake.write_text(
        f"#!{sys.executable}\nimport os, pathlib, time\n"
        f"pathlib.Path({str(told)!r}).write_text(str(os.getpid()))\ntime.sleep(60)\n"
    )
    fake.chmod(0o755)
    monkeypatch.setattr(render.sys, "executable", str(fake))
    with pytest.raises(KeyboardInterrupt), Drawing(bending_jobs(drawable, tmp_path)):
        while not (told.exists() and told.read_text()):
            time.sleep(0.01)
        os.kill(int(told.read_text()), 0)  # it is there
        raise KeyboardInterrupt
    with pytest.raises(ProcessLookupError):
        os.kill(int(told.read_text()), 0)
    assert not list(tmp_path.glob("*.png"))


def test_the_child_starts_without_the_rest_of_the_package():
    code = "import sys, json, solidgear.show.drawing; print(json.dumps([m for m in sys.modules if m.startswith(('solidgear', 'scipy', 'skfem', 'pyvista'))]))"
    out = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert set(json.loads(out.stdout)) == {
        "solidgear",
        "solidgear.core",
        "solidgear.core.machine",
        "solidgear.core.machine.processes",
        "solidgear.core.machine.version",
        "solidgear.core.registry",
        "solidgear.rooms",
        "solidgear.show",
        "solidgear.show.canvas",
        "solidgear.show.drawing",
        "solidgear.show.scales",
    }


def test_a_picture_is_drawn_without_the_plotter_of_pyvista_and_matplotlib():
    code = """
import sys
import numpy as np
from solidgear.show.canvas import Canvas, Shading, edges_of, scale_of, surface_of
corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
body = surface_of(corners, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
canvas, scale = Canvas(60, 60), scale_of(("#ff0000", "#00ff00"), (0.0, 1.0))
canvas.smooth(body, np.arange(4) / 3, scale, Shading(1.0, 0.0))
canvas.lines(edges_of(body), "#0000ff", 2.0, nearer=np.zeros(3))
canvas.silhouette(body, "#000000", 2.0)
canvas.words("a", 0.9, 12)
canvas.bar(scale, 0.5, 8, 3, "%.1f")
canvas.aim(np.full(3, 0.3), np.ones(3), np.array([0.0, 0, 1]), 3.0)
canvas.axes()
print(len(np.unique(canvas.pixels())), sorted({"matplotlib", "pyvista.plotting"} & set(sys.modules)))
"""
    out = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        env={
            "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow",
            **os.environ,
            "PYTHONPATH": str(ROOT),
        },
    )
    if out.returncode < 0:
        pytest.skip("there is no OpenGL")
    levels, _, imported = out.stdout.strip().partition(" ")
    assert imported == "[]" and int(levels) > 20, out.stderr


def test_colours_are_those_of_their_names():
    from matplotlib import colormaps

    share = np.linspace(0, 1, canvas.STEPS)
    for ramp, named, at, most in (
        # samples of viridis, between which it bends by 4 of 255
        (MOTION, "viridis", 0.14 + 0.86 * share, 5),
        # the colours that it is made of: no more than rounding to bytes
        (YLORRD, "YlOrRd", share, 1),
    ):
        scale = canvas.scale_of(ramp, (0.0, 1.0))
        table = [scale.GetTableValue(k)[:3] for k in range(canvas.STEPS)]
        np.testing.assert_allclose(table, colormaps[named](at)[:, :3], rtol=0, atol=most / 255)


def asked_for(folder, count):
    """Pictures of nothing, as a caller hands them over."""
    for k in range(count):
        np.savez(folder / f"{k}.npz")
        (folder / f"{k}.json").write_text("{}")


def test_the_child_ends_when_nothing_is_left_to_draw(tmp_path):
    asked_for(tmp_path, 2)
    drawing.work(tmp_path, Other(os.getpid()), lambda job, path: path.write_text("drawn"))
    # and nobody has said that there are no more
    assert sorted(p.name for p in tmp_path.glob("*.png")) == ["0.png", "1.png"]


def fake_child(tmp_path, monkeypatch, code):
    """A child that runs this code with its folder as `room`, and how often it was started so far."""
    fake, starts = tmp_path / "python", tmp_path / "starts"
    fake.write_text(
        f"#!{sys.executable}\nimport pathlib, sys\nroom = pathlib.Path(sys.argv[3])\n"
        f"starts = pathlib.Path({str(starts)!r})\nstarts.open('a').write('x')\n"
        f"def draw():\n    for job in room.glob('?.json'):\n"
        f"        job.with_suffix('.png').write_bytes(b'drawn')\n{code}\n"
    )
    fake.chmod(0o755)
    monkeypatch.setattr(render.sys, "executable", str(fake))
    return starts


def test_another_child_draws_what_comes_after_the_first_has_ended(drawable, tmp_path, monkeypatch):
    starts = fake_child(tmp_path, monkeypatch, "draw()")
    first, second = bending_jobs(drawable, tmp_path / "out")
    with Drawing([first]) as pictures:
        pictures._child.wait()
        pictures.add(second)
        pictures._child.wait()
        assert starts.read_text() == "xx"  # while the caller does something else
        assert all(result.ok for result in pictures.results())
    assert starts.read_text() == "xx" and len(list((tmp_path / "out").iterdir())) == 2


def test_no_picture_is_lost_that_is_handed_over_to_a_child_about_to_end(
    drawable, tmp_path, monkeypatch
):
    # the first has looked for the last time, and is still there as both are handed over
    code = "import time\nif len(starts.read_text()) > 1: draw()\nelse: time.sleep(1)"
    starts = fake_child(tmp_path, monkeypatch, code)
    assert all(result.ok for result in render_modes(bending_jobs(drawable, tmp_path / "out")))
    assert starts.read_text() == "xx" and len(list((tmp_path / "out").iterdir())) == 2


def test_a_child_that_leaves_no_picture_is_not_started_for_ever(drawable, tmp_path, monkeypatch):
    starts = fake_child(tmp_path, monkeypatch, "")
    results = render_modes(bending_jobs(drawable, tmp_path / "out"))
    assert all("left no picture" in result.reason for result in results)
    assert 2 <= len(starts.read_text()) <= 3


def volumes(points, cells, vtk_name):
    """Volume of every cell and its least Jacobian determinant, by VTK's own shape functions."""
    from vtkmodules import vtkCommonDataModel

    cell = getattr(vtkCommonDataModel, vtk_name)()
    rule, weights = get_quadrature(RefTet if "Tetra" in vtk_name else RefHex, 7)
    total, least = np.zeros(len(cells)), np.full(len(cells), np.inf)
    for at, weight in zip(rule.T, weights):
        slopes = [0.0] * (3 * cells.shape[1])
        cell.InterpolateDerivs(at.tolist(), slopes)
        det = np.linalg.det(np.einsum("enc,kn->eck", points[cells], np.reshape(slopes, (3, -1))))
        total, least = total + weight * det, np.minimum(least, det)
    return total, least


@pytest.mark.parametrize("element", ELEMENTS.values(), ids=ELEMENTS)
def test_nodes_stand_in_the_order_of_vtk(element):
    from vtkmodules import vtkCommonDataModel

    cell = getattr(vtkCommonDataModel, element.vtk)()
    places = np.reshape(cell.GetParametricCoords(), (-1, 3))[: cell.GetNumberOfPoints()]
    assert node_order(places, element.vtk).tolist() == list(range(len(places)))


@pytest.mark.parametrize(
    "element, kind, vtk_name, loss",
    [
        # Curved cells lose what their builder reports: 1e-3 at the most. Straight ones lose the arcs: an octagon has
        # 90.03 % of its circle.
        ("hex27", "hexahedron27", "vtkTriQuadraticHexahedron", 1e-3),
        ("hex20", "hexahedron20", "vtkQuadraticHexahedron", 1e-3),
        ("tet10", "tetra10", "vtkQuadraticTetra", 1e-3),
        ("hex8", "hexahedron", "vtkHexahedron", 0.1),
        ("tet4", "tetra", "vtkTetra", 0.03),
    ],
)
def test_a_solid_comes_back_from_its_file(overhung, tmp_path, element, kind, vtk_name, loss):
    options = SOLID if element.startswith("hex") else {"size": 0.06, "graded_size": 0.06}
    body = sg.build(overhung, "solid", element=element, **options)
    made_up = [
        Mode(f"motion {c}", "", 1.5, 1, (unit_motion(body, c),), np.zeros((1, 1, 6)), 1.0)
        for c in range(6)
    ]
    path = write_vtu(body, made_up, tmp_path / "new" / "body.vtu", most=4)
    assert [p.name for p in path.parent.iterdir()] == ["body.vtu"]
    back = meshio.read(path)
    assert [c.type for c in back.cells] == [kind]
    assert list(back.point_data) == [f"motion {c} (1.50 Hz)" for c in range(4)]
    np.testing.assert_allclose(
        back.point_data["motion 3 (1.50 Hz)"], np.cross([1.0, 0.0, 0.0], back.points), atol=1e-14
    )
    # A wrong order of nodes would turn some of every cell inside out.
    volume, least = volumes(back.points, back.cells[0].data, vtk_name)
    assert least.min() > 0
    assert volume.sum() == pytest.approx(volume_of(Outline(overhung.segments)), rel=loss)
    # And VTK reads the same file; it measures curved cells by flat pieces, so up to 16 chords for a
    # circle (2.6 %).
    measured = pv.read(path).compute_cell_sizes(length=False, area=False)["Volume"]
    assert measured.min() > 0
    assert measured.sum() == pytest.approx(volume.sum(), rel=0.026 if kind[-1].isdigit() else 1e-12)


@pytest.mark.parametrize("fidelity", ["timoshenko", "harmonic"])
def test_other_bodies_are_written_as_surfaces(drawable, tmp_path, fidelity):
    body, modes = drawable(fidelity)
    back = meshio.read(write_vtu(body, modes, tmp_path / "body.vtu"))
    assert {c.type for c in back.cells} == {"quad", "triangle"}
    bending = modes.named("bending 1")
    for letter, vectors in zip("ab", bending.vectors):
        s = body.surface(vectors)
        np.testing.assert_array_equal(back.points, s.points)
        np.testing.assert_array_equal(
            back.point_data[f"bending 1{letter} ({bending.frequency_hz:.2f} Hz)"], s.displacement
        )
    assert len(back.point_data) == sum(len(m.vectors) for m in modes.modes)


def test_a_file_for_other_programs_is_written_listed_and_cleared(tmp_path, monkeypatch):
    def six(solution, path):
        np.savetxt(path, solution.condensed.stiffness)

    def refuse(solution, path):
        raise ValueError("no licence")

    own = (Output("modes as text", "modes", ".vtu", six), Output("deck", "deck", ".inp", refuse))
    monkeypatch.setattr(write, "OUTPUTS", own)
    scene = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.6, diameter=0.02)])
    found = sg.compare(scene, models=("euler",))
    found.write_report(tmp_path, renders=False)
    # one that fails costs a sentence and no other file
    assert np.loadtxt(tmp_path / "modes_euler.vtu").shape == (6, 6)
    assert found.record.left_out == ["deck of euler left out: no licence"]
    assert found.record.files == ["report.html", "modes_euler.vtu"]
    clear(tmp_path)
    assert not (tmp_path / "modes_euler.vtu").exists()
    # a damaged list can name nothing that no output is called
    assert all(OWN.fullmatch(output.name("solid")) for output in OUTPUTS)
    assert not OWN.fullmatch("modes_solid.txt") and not OWN.fullmatch("../modes_solid.vtu")
