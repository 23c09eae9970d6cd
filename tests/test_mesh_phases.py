"""Phases of meshes by places and numbers of teeth, and a train that all of them drive together."""

from dataclasses import replace
from math import pi, radians
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.layout import senses
from solidgear.trains.assembly.mesh_phases import MeshPhase, MeshPhases
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.response.excitation import _in_step, excitation, meetings
from solidgear.trains.response.respond import respond
from tests.test_train_many import BEARING, MESHES, PRESSURE, scene_text, train_text, written

GEOMETRY = Path(__file__).parent.parent / "geometry"
HZ = np.array([150.0, 900.0, 2300.0])


def idler_train(folder, teeth, azimuth=0.0, shift=0.0):
    """20, `teeth` and 40 teeth of 3 mm module, the third axis aside by an azimuth."""
    written(folder)
    (folder / "idler.toml").write_text(scene_text("input", BEARING))
    text = ""
    for side, scene, count in (
        ("input", "input", 20),
        ("idler", "idler", teeth),
        ("output",) * 2 + (40,),
    ):
        text += f'[shaft.{side}]\nscene = "{scene}.toml"\nteeth = {count}\nface_width = 0.03\n'
        text += f"module = 0.003\nhelix_angle = 0\nprofile_shift = {shift if side == 'idler' else -shift}\n"
        text += 'loaded_side = "left"\n' if side == "input" else ""
    for (one, two), turned in ((("input", "idler"), 0.0), (("idler", "output"), azimuth)):
        text += f'[[mesh]]\nbetween = ["{one}", "{two}"]\nshaft_angle = 0\nstiffness = 3e8\n'
        text += f"azimuth = {turned}\npressure_angle = {PRESSURE}\ntransmission_error = 1e-6\n"
    for name, shaft in (("engine", "input"), ("load", "output")):
        text += f'[{name}]\nshaft = "{shaft}"\ninertia = 0.03\n'
        text += f'[{name}.spring]\nstiffness = 4e3\nat = "b1"\n'
    (folder / "train.toml").write_text(text + "[operation]\ntorque = 90\n")
    return sg.load_train(folder / "train.toml")


def apart(phase, due):
    """Distance of a phase from another, in pitches on the circle."""
    return abs((phase - due + 0.5) % 1 - 0.5)


@pytest.mark.parametrize(
    ("teeth", "azimuth", "shift"), [(31, 0.0, 0.0), (30, 0.7, 0.3), (31, -1.1, -0.2)]
)
def test_an_idler_hands_the_phase_on(tmp_path, teeth, azimuth, shift):
    """Half a pitch from flank to flank of a tooth, with a shift by as much more as it makes the teeth
    thicker, and the teeth between both pitch points.
    """
    train = idler_train(tmp_path, teeth, azimuth, shift)
    assembly = Assembly(train)
    phases = MeshPhases(assembly, "mesh input-idler").by_mesh
    assert phases["mesh input-idler"].pitches == 0.0
    between = (pi + azimuth) * teeth / (2 * pi)
    # where it rolls with both wheels a tooth is pi m / 2 + 2 x m tan alpha thick: x = 0 in sum
    thick = 0.5 + 2 * shift * np.tan(PRESSURE) / pi
    phase = phases["mesh idler-output"]
    way = 1 if assembly.contacts["mesh idler-output"].pinion.vector[4] < 0 else -1
    assert apart(phase.pitches, thick - way * between) < 1e-9
    assert [mesh.way for mesh in phases.values()] == [1, 1]


@pytest.mark.parametrize(("teeth", "sign"), [(31, 1), (30, -1)])
def test_meshes_of_an_idler_drive_as_one_sum(tmp_path, teeth, sign):
    """Of an idler between two wheels in a line, both errors of one size: in step with an odd number of
    teeth, against each other with an even one.
    """
    assembly = Assembly(idler_train(tmp_path, teeth))
    options = {"frequency_hz": HZ, "highest_hz": 3000.0}
    first, second = (
        respond(assembly, "timoshenko", mesh=name, **options)
        for name in ("input-idler", "idler-output")
    )
    both = respond(assembly, "timoshenko", mesh="input-idler", together=True, **options)
    alone = first.columns["mesh force [N]"]
    other = second.columns["mesh force input-idler [N]"]
    assert both.force == pytest.approx(alone + sign * other, rel=1e-9)
    assert np.abs(both.force - alone).min() > 1e-3 * np.abs(alone).max()
    seat = next(name for name in both.columns if "bearing b0" in name and " z " in name)
    due = first.columns[seat] + sign * second.columns[seat]
    assert both.columns[seat] == pytest.approx(due, rel=1e-9, abs=1e-9 * np.abs(due).max())
    assert any("--together adds them up" in text for text in first.cautions)
    assert not any("--together" in text for text in both.cautions)


def two_stages(folder, angles=None):
    """Both gears of the middle shaft with 57 teeth, so that both meshes have one frequency."""
    radius = MESHES[1][3]
    text = (
        train_text()
        .replace("teeth = 18\n", "teeth = 57\n")
        .replace("teeth = 55\n", "teeth = 171\n")
    )
    text = text.replace(f"pitch_radius = {radius * 55 / 18}\n", f"pitch_radius = {3 * radius}\n")
    for port, angle in (angles or {}).items():
        text = text.replace(f"gears.{port}]\n", f"gears.{port}]\nangle = {angle}\n")
    written(folder)
    (folder / "train.toml").write_text(text)
    return Assembly(sg.load_train(folder / "train.toml"))


def test_gears_of_a_shaft_need_their_angles(tmp_path):
    assembly = two_stages(tmp_path)
    driver = assembly.train.pairs[0]
    (meeting,) = meetings(assembly, driver)
    assert (meeting.order, meeting.own_order, meeting.error) == (1, 1, None)
    with pytest.raises(SolidgearError, match="give the angle of the gears wheel and pinion of"):
        excitation(assembly, driver, together=True)
    angles = {}
    for turn in (0.0, 0.01, 0.03):
        tied = two_stages(tmp_path, {"wheel": 0.2, "pinion": 0.2 + turn})
        weights = excitation(tied, tied.train.pairs[0], together=True).weights()
        assert abs(weights["mesh middle-output"]) == pytest.approx(2.0, rel=1e-12)  # of 1 and 2 um
        angles[turn] = np.angle(weights["mesh middle-output"])
    for turn in (0.01, 0.03):
        # a pinion that stands further the way it turns is ahead, by its teeth
        way = 1 if senses(tied.train, tied.contacts)["middle"] == "+y" else -1
        moved = np.exp(1j * (angles[turn] - angles[0.0]))
        assert moved == pytest.approx(np.exp(1j * way * 57 * turn), abs=1e-9)


def test_teeth_that_may_meet_otherwise_leave_a_phase_open(tmp_path):
    """A mesh that stands half a pitch further with another tooth in mesh is in step by even orders."""
    train = idler_train(tmp_path, 31)
    mesh, driver = train.pairs[1], train.pairs[0]
    error = mesh.error.with_changes(orders=(1e-6, 1e-6))
    mesh = replace(mesh, mesh=mesh.mesh.with_changes(transmission_error=error))
    reference = MeshPhase(0.0, (), 1)
    half = MeshPhase(0.25, (0.5, 3.0), 1)
    assert _in_step(mesh, driver, half, reference, (1, 1)) is None
    assert _in_step(mesh, driver, half, reference, (2, 2)) == pytest.approx(-1e-6)


def test_planets_are_in_step_as_the_known_formulas_say():
    """From planet to planet by the teeth of the sun (as the drive by all planets has it), from sun to
    ring at a planet half a pitch for an even number of its teeth (Parker and Lin 2004).
    """
    assembly = Assembly(sg.load_train(GEOMETRY / "reducer.toml"))
    (stage,) = assembly.train.stages
    phases = MeshPhases(assembly, "mesh stage sun 1").by_mesh
    assert len(phases) == 6 and stage.teeth.planet % 2 == 0
    at_work = assembly.stages[stage.name]
    for mesh in stage.together:
        lags = mesh.phases(at_work.turns)
        first = phases[next(iter(lags))].pitches
        for name, lag in lags.items():
            way = phases[name].way
            assert apart(phases[name].pitches, first - way * lag / (2 * pi)) < 1e-9
    assert apart(phases["mesh stage ring 1"].pitches, 0.5) < 1e-9
    assert all(abs(f - round(f)) < 1e-9 for phase in phases.values() for f in phase.freedom)


def test_helical_teeth_stand_further_where_their_face_lies(tmp_path):
    """The face of an idler's second mesh 6 mm along it: ahead by tan beta_b / p_bt a length."""
    phases = {}
    for offset in (0.0, 6e-3):
        train = idler_train(tmp_path, 31)
        helix = {"helix_angle": radians(12), "spiral_angle": None}
        hands = {"input": "right", "idler": "left", "output": "right"}
        shafts = {
            side: shaft.with_changes(
                gears={
                    name: gear.with_changes(
                        **helix, hand=hands[side], face_offset=offset if side == "output" else 0.0
                    )
                    for name, gear in shaft.gears.items()
                }
            )
            for side, shaft in train.shafts.items()
        }
        assembly = Assembly(train.with_changes(shafts=shafts))
        phases[offset] = MeshPhases(assembly, "mesh input-idler").by_mesh["mesh idler-output"]
    moved = phases[6e-3].pitches - phases[0.0].pitches
    axial = pi * 3e-3 / np.sin(radians(12))
    along = wheels_of(assembly.train.pairs[1]).along[0]  # where lines near tips of the idler
    assert apart(moved, along * 3e-3 / axial) < 1e-6
