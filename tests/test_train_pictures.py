"""Both shafts of a train in one picture: placed where the teeth meet, moved as the modes say."""

import json

import numpy as np
import pytest
from test_train_models import COARSE, OVERHUNG

import solidgear as sg
from solidgear.show.folder import clear
from solidgear.show.turning import sections
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.modes.naming import mode_names
from solidgear.trains.modes.pictures import draw_modes, system_surface, turning_modes, turning_pair
from tests.command import command

TRAIN = sg.load_train(OVERHUNG)
FINE = {**COARSE, "harmonic": {"order": 2, "layers": 1}}


@pytest.fixture(scope="module")
def assembly():
    return Assembly(TRAIN, settings=FINE)


def rigid_motion(points, moved):
    """Motion of the origin and rotation that fit a cloud of points best, and what is left."""
    rows = np.zeros((len(points), 3, 6))
    rows[:, :, :3] = np.eye(3)
    for k, axis in enumerate(np.eye(3)):
        rows[:, :, 3 + k] = np.cross(axis, points)
    found, *_ = np.linalg.lstsq(rows.reshape(-1, 6), moved.ravel(), rcond=None)
    left = moved - (rows @ found)
    return found, np.abs(left).max() / np.abs(moved).max()


def halves(assembly, system, rungs, shape):
    drawn = system_surface(assembly, system, rungs, shape)
    first = len(assembly.shaft_model("pinion", rungs[0]).body.surface({}).points)
    return (
        (drawn.points[:first], drawn.displacement[:first]),
        (drawn.points[first:], drawn.displacement[first:]),
    )


@pytest.mark.parametrize("rungs", [("timoshenko", "timoshenko"), ("harmonic", "harmonic")])
def test_as_the_train_turns_its_teeth_stay_together(assembly, rungs):
    """Points on both surfaces, carried to the mesh point, move alike along the line of action:
    place, axes and signs of the gear are all in it.
    """
    system = assembly.system(*rungs)
    pinion, gear = halves(assembly, system, rungs, system.free[:, 0])
    scene, met = assembly.scenes["pinion"], assembly.contact.pinion
    mesh = np.array([0.0, scene.port.y, 0.0]) + met.point
    along = []
    for points, moved in (pinion, gear):
        motion, left = rigid_motion(points, moved)
        assert left < 1e-6  # a rigid rotation, drawn as one
        along.append(met.normal @ (motion[:3] + np.cross(motion[3:], mesh)))
    assert along[0] == pytest.approx(along[1], rel=1e-6)
    assert abs(along[0]) > 0


def test_shafts_cross_at_right_angles_and_the_mesh_point_is_on_both_heads(assembly):
    rungs = ("timoshenko", "timoshenko")
    system = assembly.system(*rungs)
    pinion, gear = halves(assembly, system, rungs, system.elastic[1][:, 0])
    scene = assembly.scenes["pinion"]
    mesh = np.array([0.0, scene.port.y, 0.0]) + assembly.contact.pinion.point
    for points, _ in (pinion, gear):
        assert np.linalg.norm(points - mesh, axis=1).min() < 0.03  # a face is 63 mm wide
    across = [np.ptp(points, axis=0) for points, _ in (pinion, gear)]
    # the pinion is long along y, the flat ring is as large along y as along z
    assert across[0][1] > 1.5 * across[0][2]
    assert across[1][1] == pytest.approx(across[1][2], rel=0.01) and across[1][0] < across[1][2]


def test_the_surface_moves_as_the_ports_do(assembly):
    """The mean motion of the gear's lumped seat in the picture is that of its port."""
    rungs = ("timoshenko", "timoshenko")
    system = assembly.system(*rungs)
    shape = system.elastic[1][:, 3]
    gear = halves(assembly, system, rungs, shape)[1]
    part, port = system.parts["gear"], assembly.scenes["gear"].port
    own = (gear[0] - part.origin) @ part.rotation
    near = np.abs(own[:, 1] - port.y) < 0.02
    motion, _ = rigid_motion(own[near] - [0, port.y, 0], gear[1][near] @ part.rotation)
    told = system.motion(f"gear.{port.name}") @ shape
    # sections of a beam between its nodes; the port is the mean over a width
    assert np.allclose(motion, told, atol=0.02 * np.abs(told).max())


def test_a_model_without_a_shape_says_so(assembly, tmp_path):
    with pytest.raises(sg.SolidgearError, match="lumped of the gear has no shape to draw"):
        draw_modes(assembly, "timoshenko", "lumped", folder=tmp_path / "out", numbers=[2])
    assert not (tmp_path / "out").exists()


@pytest.mark.long
def test_modes_are_drawn_with_four_phases(assembly, tmp_path):
    from matplotlib.image import imread

    done = draw_modes(assembly, "timoshenko", "timoshenko", folder=tmp_path, numbers=[4])
    ((told, one),) = done.items()
    if "OpenGL" in one.reason:
        pytest.skip(one.reason)
    assert one.ok and told.startswith("gear bending 1, ")
    assert one.path.name == "system_mode_04.png"
    picture = imread(one.path)[:, :, :3]
    # four frames side by side, each with a shape in it, the first and the last moved apart
    frames = np.array_split(picture[150:600], 4, axis=1)
    assert all((frame < 0.98).any(axis=2).mean() > 0.1 for frame in frames)
    assert all((frame > 0.98).all(axis=2).mean() > 0.3 for frame in frames)  # on white paper
    assert np.abs(frames[0] - frames[3]).mean() > 0.01


def test_without_a_renderer_there_is_a_sentence(tmp_path, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_RENDERER", "none")
    args = ["system-modes", str(OVERHUNG), "--pinion", "euler", "--gear", "euler"]
    done = command(*args, "--pictures", str(tmp_path), "--mode", "3")
    assert done.exit_code == 0 and "install OpenGL by" in done.output
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (["--mode", "3"], "add --pictures"),
        (["--pictures", "out", "--mode", "0"], "there is no mode 0"),
        (["--pictures", "out", "--mode", "5000"], "modes are numbered 1 to"),
    ],
)
def test_wrong_modes_are_told(more, words, tmp_path, monkeypatch):
    args = ["system-modes", str(OVERHUNG), "--pinion", "euler", "--gear", "euler"]
    monkeypatch.chdir(tmp_path)
    done = command(*args, *more)
    assert done.exit_code == 1 and words in str(done.exception)
    assert not list(tmp_path.iterdir())


def test_files_of_an_earlier_run_of_a_train_or_a_shaft_are_cleared(tmp_path):
    listed = ["system_mode_04.png", "orders.csv", "mode_euler.png", "modes_euler.vtu"]
    (tmp_path / "results.json").write_text(json.dumps({"files": listed}))
    for name in (*listed, "mine.png"):
        (tmp_path / name).write_text("")
    clear(tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == {"results.json", "mine.png"}


@pytest.mark.parametrize("rungs", [("timoshenko", "timoshenko"), ("harmonic", "euler")])
def test_what_is_turned_stands_and_moves_as_in_the_pictures(assembly, rungs):
    """Both shafts put in their places are the surface of the picture, in rest and in motion, with
    one scale for both: the largest displacement of the two is 1.
    """
    model = turning_modes(assembly, *rungs, highest_hz=900.0)
    system = assembly.system(*rungs)
    found = system.modes(len(model.shapes))
    assert (
        len(model.shapes) > 3
        and [s.name for s in model.shapes] == mode_names(assembly, system, found)[1:]
    )
    for k, shape in enumerate(model.shapes):
        assert shape.frequency_hz == found.frequency_hz[k + 1] > 0
        drawn = halves(assembly, system, rungs, found.shapes[:, k + 1])
        both = [(one, one.shapes[k].displacement) for one in (model, *model.along)]
        moved = []
        for (one, motion), (points, displacement) in zip(both, drawn):
            source = one.mesh.source
            placed = one.mesh.points @ one.rotation.T + one.origin
            np.testing.assert_allclose(placed, points[source], atol=1e-12)
            moved.append((motion @ one.rotation.T, displacement[source]))
        ours, theirs = (np.vstack(own) for own in zip(*moved))
        scale = (ours * theirs).sum() / (theirs**2).sum()
        np.testing.assert_allclose(ours, scale * theirs, atol=1e-9)
        assert np.linalg.norm(ours, axis=1).max() == pytest.approx(1.0)


def test_only_a_shaft_that_turns_is_drawn_as_turning(assembly):
    """Enlarged along the tangent a turning section would swell; one that bends must not be turned."""
    model = turning_modes(assembly, "timoshenko", "timoshenko", highest_hz=1000.0)
    by = {s.name: (s.twists, model.along[0].shapes[k].twists) for k, s in enumerate(model.shapes)}
    # the shafts wind up against engine and load, nearly rigid themselves
    assert by["load torsion 1"] == (True, True)
    assert by["gear bending 1"][1] is False


@pytest.mark.long
def test_the_page_of_system_modes_has_modes_to_turn_and_units(tmp_path):
    page = tmp_path / "modes.html"
    told = ["system-modes", str(OVERHUNG), "--pinion", "euler", "--gear", "timoshenko"]
    told += ["--max-frequency", "700"]
    done = command(*told, "--turn", str(page), "--units", "us")
    assert done.exit_code == 0, done.output
    text = page.read_text(encoding="utf-8")
    assert "sg-turn" in text and text.count('"triangles"') == 2 and "gear bending 1" in text
    # 250 N/um: 250e6 / 4.4482216152605 * 0.0254 lbf/in
    assert "1\u00a0428\u00a0000 lbf/in" in text and "78.7402 µin" in text
    light = [*told[:3], "lumped", "--gear", "lumped"]
    nothing = command(*light, "--turn", str(tmp_path / "no.html"))
    assert nothing.exit_code == 1
    refused = command(*light, "--units", "us")
    assert refused.exit_code == 1 and "add --turn model.html" in str(refused.exception)
    assert "lumped of the pinion has no shape" in str(nothing.exception)
    assert not (tmp_path / "no.html").exists()


def test_two_mixes_side_by_side_show_partners_under_one_name(assembly):
    """Paired by what the ports do, with one sign; what has no partner says so."""
    one, other = turning_pair(assembly, ("harmonic", "harmonic"), ("euler", "euler"), 900.0)
    assert [t.title for t in (one, other)] == ["both shafts harmonic", "both shafts euler"]
    shared = {s.name for s in one.shapes} & {s.name for s in other.shapes}
    assert {"load torsion 1", "gear torsion 1", "gear bending 1"} <= shared
    alone = [s.name for s in other.shapes if s.name not in shared]
    assert all(name.endswith(", both shafts euler alone") for name in alone)
    for name in shared:
        mine, its = (t.shapes[t.index(name)] for t in (one, other))
        if name == "gear bending 1":  # a beam without shear is the stiffer one
            assert 1 < its.frequency_hz / mine.frequency_hz < 1.5
        told = [
            np.vstack(
                [
                    sections(b.mesh.points, b.shapes[t.index(name)].displacement)
                    for b in (t, *t.along)
                ]
            )
            for t in (one, other)
        ]
        assert (told[0] * told[1]).sum() > 0
