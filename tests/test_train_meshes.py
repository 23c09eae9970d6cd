"""Meshes of harmonic shafts in a train follow the error bars of what is asked for."""

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.strength.deflection.at_rest import deflection
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.page.tables import peaks
from solidgear.trains.response.respond import respond

SIDES = dict.fromkeys(("pinion", "gear"), JUDGE)
LIMIT = 2500.0
#: what the fine meshes leave
RIGHT = 1e-4
PINION = """\
material = "steel"
segment = [{ kind = "cylinder", name = "shaft", length = "120 mm", diameter = "40 mm" }]
bearing = [
    { name = "A", position = "15 mm", seat_width = "16 mm", stiffness = { kxx = "3e8 N/m", kyy = "1e8 N/m", kzz = "3e8 N/m" } },
    { name = "B", position = "105 mm", seat_width = "16 mm", stiffness = { kxx = "2e8 N/m", kzz = "2e8 N/m" } },
]
port = { name = "teeth", at = "shaft.middle", span = ["50 mm", "70 mm"] }
"""
GEAR = """\
material = "steel"
segment = [
    { kind = "cylinder", name = "shaft", length = "90 mm", diameter = "45 mm" },
    { kind = "cylinder", name = "wheel", length = "22 mm", diameter = "150 mm" },
]
bearing = [
    { name = "C", position = "14 mm", seat_width = "16 mm", stiffness = { kxx = "4e8 N/m", kyy = "2e8 N/m", kzz = "4e8 N/m" } },
    { name = "D", position = "70 mm", seat_width = "16 mm", stiffness = { kxx = "4e8 N/m", kzz = "4e8 N/m" } },
]
port = { name = "teeth", at = "wheel.middle", attach_to = "wheel" }
"""
TRAIN = """\
title = "Spur pair"

[pinion]
scene = "pinion.toml"
teeth = 22
loaded_side = "left"
pitch_radius = "22 mm"
pitch_angle = 0.0
spiral_angle = 0.0
face_width = "20 mm"

[gear]
scene = "gear.toml"
teeth = 77
pitch_radius = "77 mm"

[mesh]
shaft_angle = 0
stiffness = "2e8 N/m"
pressure_angle = "20 deg"
transmission_error = "1 um"

[ask]
max_frequency = "2500 Hz"

[engine]
inertia = "0.05 kg*m^2"

[engine.spring]
stiffness = "2e4 N*m/rad"
at = "A"

[load]
inertia = "0.5 kg*m^2"

[load.spring]
stiffness = "4e4 N*m/rad"
at = "C"

[losses]
"""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """A spur pair that no mesh was ever tuned on."""
    folder = tmp_path_factory.mktemp("train")
    for name, text in (("pinion", PINION), ("gear", GEAR), ("train", TRAIN)):
        (folder / f"{name}.toml").write_text(text)
    return folder / "train.toml"


@pytest.fixture(scope="module")
def train(file):
    return sg.load_train(file)


@pytest.fixture(scope="module")
def fine(train):
    """Meshes good to some 5e-5."""
    return Assembly(train, settings={"harmonic": {"order": 4, "layers": 1, "edge_layers": 1}})


def unknowns(assembly):
    return {side: assembly.shaft_model(side, JUDGE).unknowns for side in SIDES}


@pytest.mark.parametrize("tol", [5e-3, 5e-4])
def test_meshes_follow_until_every_mode_is_within_the_tolerance(train, fine, tol):
    """The bars hold what every mode errs by, and are no wider than what was asked for; on the first
    meshes they are wider.
    """
    assembly = Assembly(train, tol=tol)
    first = unknowns(assembly)
    modes = train_modes(assembly, JUDGE, max_frequency=LIMIT).modes
    bars = np.array([mode.mesh for mode in modes[1:]])
    hz = np.array([mode.frequency_hz for mode in modes[1:]])
    exact = fine.system(JUDGE).modes(len(hz)).frequency_hz[1:]
    error = hz / exact - 1
    assert (error < bars).all() and (error > -RIGHT).all()
    assert bars.max() <= tol < 30 * bars.max()
    assert sum(unknowns(assembly).values()) > sum(first.values())


def test_a_shaft_that_holds_no_error_keeps_its_mesh(train):
    """The modes of the pinion on a beam rest on the mesh of the gear, and on no other."""
    assembly = Assembly(train, tol=5e-3)
    first = unknowns(assembly)
    assembly.system("timoshenko", JUDGE)
    assert unknowns(assembly)["pinion"] == first["pinion"]
    assert unknowns(assembly)["gear"] > first["gear"]


def test_the_tolerance_is_a_tenth_of_that_of_the_file(train):
    assert Assembly(train).tolerance == train.ask.tolerance / 10
    assert Assembly(train, tol="1%").tolerance == 0.01


@pytest.mark.parametrize("tol", [0.0, -1, 2.0, "wide", 1e-12])
def test_a_tolerance_that_cannot_be_met_is_refused(train, tol):
    with pytest.raises(SolidgearError, match="tol = "):
        Assembly(train, tol=tol)


def test_a_mesh_that_is_set_stays(train):
    assembly = Assembly(train, settings={("gear", JUDGE): {"order": 2}}, tol=0.05)
    first = unknowns(assembly)
    assembly.system(JUDGE)
    assert unknowns(assembly)["gear"] == first["gear"]


def test_meshes_are_chosen_once_for_bearings_that_vary(train):
    assembly = Assembly(train, tol=0.05)
    assembly.system(JUDGE)
    bodies = [assembly.shaft_model(side, JUDGE).body for side in SIDES]
    stiff = assembly.with_bearings({"gear.C": np.diag([1e10, 1e10, 1e10, 0, 0, 0])})
    stiff.system(JUDGE)
    assert [stiff.shaft_model(side, JUDGE).body for side in SIDES] == bodies


def test_a_higher_frequency_refines_and_is_not_refused(train):
    """A mesh that is set does not resolve it; one that follows does."""
    coarse = Assembly(train, settings={JUDGE: {"order": 1, "layers": 0, "size": 0.05}})
    with pytest.raises(SolidgearError, match="beyond the mesh"):
        train_modes(coarse, JUDGE, max_frequency=4 * LIMIT)
    assembly = Assembly(train, tol=1.0)
    first = unknowns(assembly)
    assembly.follow(JUDGE, highest_hz=LIMIT)
    assert unknowns(assembly) == first
    assembly.follow(JUDGE, highest_hz=14 * LIMIT)
    assert all(unknowns(assembly)[side] > first[side] for side in SIDES)


@pytest.mark.parametrize("tol", [5e-3, 5e-4])
@pytest.mark.long
def test_gears_at_rest_are_within_the_tolerance(train, fine, tol):
    point = OperatingPoint(torque=80.0)
    assembly = Assembly(train, kept=6, tol=tol)
    found, exact = (deflection(a, point, JUDGE) for a in (assembly, fine))
    for side in SIDES:
        for components in ((0, 1, 2), (3, 5)):
            pairs = [(found.displacement[side][k], exact.displacement[side][k]) for k in components]
            length = np.linalg.norm([measure.value for measure, _ in pairs])
            for measure, reference in pairs:
                assert measure.bar < tol * length
                assert abs(measure.value - reference.value) < measure.bar + RIGHT * length
    largest = max(m.bar for m in found.misalignment)
    assert largest > 0.0


@pytest.mark.slow
def test_shafts_that_teeth_drive_where_they_touch_have_meshes_within_the_tolerance(train):
    local = train.with_changes(meshes=(train.meshes[0].with_changes(local_harmonics=(2,)),))
    usual, finer = (Assembly(local, kept=6, tol=tol) for tol in (1e-2, 2e-3))
    point, models = OperatingPoint(torque=80.0), ("timoshenko", JUDGE)
    found, exact = (deflection(assembly, point, *models) for assembly in (usual, finer))
    assert all(m.bar is None for m in found.misalignment)
    first = unknowns(Assembly(local, kept=6))["gear"]
    assert unknowns(finer)["gear"] > unknowns(usual)["gear"] > first
    for measure, reference in zip(found.misalignment, exact.misalignment):
        assert measure.value == pytest.approx(reference.value, rel=1e-2)


def test_the_bars_of_a_response_are_those_of_its_modes(train):
    """They stand beside its peaks, in a column that beams do not have."""
    response = respond(Assembly(train, tol="1%"), "timoshenko", JUDGE)
    named = [peak.mode for peak in response.peaks]
    assert named and all(response.bars[name] <= 0.01 for name in named)
    assert peaks(response.peaks, "mesh force", "N", 22, bars=response.bars).heads[-1] == "mesh"
    assert respond(Assembly(train), "timoshenko").bars == {}


@pytest.mark.long
def test_variants_do_not_decide_each_others_meshes(file):
    """A shaft has the mesh that its flexibility needs, whichever variant comes first."""
    entry, of_gear = "mesh.stiffness", {"pinion": "euler", "tolerance": 0.05}
    both, turned = (
        sg.sweep(file, f"{entry}={values}", ask=["system-modes"], n=3, **of_gear)["f2_hz"]
        for values in ("1e8 N/m,4e8 N/m", "4e8 N/m,1e8 N/m")
    )
    assert list(both) == list(turned)[::-1]
