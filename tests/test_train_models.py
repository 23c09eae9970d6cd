"""Systems made from a train file, against matrices put together by hand and against exact limits."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla
from shafts import moved_by

import solidgear as sg
from solidgear.core.frames import shift
from solidgear.core.solve.statics import condense
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.meshes import mesh_limit
from solidgear.trains.judge.judge import judge_train
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.modes.naming import TRAIN, mode_names
from solidgear.trains.options import models_of
from tests.command import command
from tests.dense import whole
from validation.thesis.lumped_pair import LumpedPair

OVERHUNG = Path(__file__).parent.parent / "geometry" / "axle_overhung.toml"
TRAIN_DATA = sg.load_train(OVERHUNG)
#: coarse, so that all modes can be kept and solved in full
COARSE = {"timoshenko": {"elements": 8}, "euler": {"elements": 8}}


def assembled(assembly, rungs, losses=None):
    """K, M, motions of ports and the row of the mesh: blocks of the bodies side by side, every
    spring added to K by hand, complex with losses; nothing of reduction/ or system/.
    """
    train = assembly.train
    lost = {"shafts": 0.0, "bearings": 0.0, "mesh": 0.0, "springs": 0.0}
    if losses is not None:
        lost = {name: 1j * getattr(losses, name) for name in lost}
    bodies = {s: sg.build(assembly.scenes[s], rung, **COARSE[rung]) for s, rung in rungs.items()}
    (k1, m1, one), (k2, m2, two) = map(whole, bodies.values())
    k = (1 + lost["shafts"]) * sla.block_diag(k1, k2, np.zeros((2, 2)))
    m = sla.block_diag(m1, m2, train.engine.inertia, train.load.inertia)
    size = len(k)
    rows = sla.block_diag(one, two, np.zeros((12, 2)))
    rows[-8, -2] = rows[-2, -1] = 1.0  # engine and load turn about y
    names = [f"{side}.{port.name}" for side, body in bodies.items() for port in body.ports]
    names += ["engine", "load"]

    def motion(port):
        return rows[6 * names.index(port) :][:6].copy()

    for side, name, at in (("pinion", "engine", size - 2), ("gear", "load", size - 1)):
        scene = assembly.scenes[side]
        seats = np.vstack([motion(f"{side}.{b.name}") for b in scene.bearings])
        held = sla.block_diag(*(b.stiffness for b in scene.bearings))
        if scene.housing_axial:
            # the housing gives way along y under the sum of the axial forces of its bearings
            axial = held[:, 1::6].sum(axis=1)
            held = held - np.outer(axial, axial) / (scene.housing_axial + axial[1::6].sum())
        k = k + (1 + lost["bearings"]) * (seats.T @ held @ seats)
        twist = motion(f"{side}.{train.spring_port(name)}")[4]
        twist[at] -= 1.0
        k = k + (1 + lost["springs"]) * train.rotors[name].spring.stiffness * np.outer(twist, twist)
    met = assembly.contact
    row = met.pinion.vector @ motion("pinion.pinion") - met.gear.vector @ motion("gear.gear")
    return k + (1 + lost["mesh"]) * met.stiffness * np.outer(row, row), m, motion, row


@pytest.fixture(scope="module")
def coarse():
    """The whole train in full: frequencies by LAPACK."""
    assembly = Assembly(TRAIN_DATA, kept=24, settings=COARSE)
    k, m, *_ = assembled(assembly, {"pinion": "timoshenko", "gear": "timoshenko"})
    hz = np.sqrt(np.maximum(sla.eigh(k, m, eigvals_only=True), 0)) / (2 * np.pi)
    return assembly, hz[1:]


def test_reduced_as_by_default_the_frequencies_are_those_of_the_whole(coarse):
    assembly, hz = coarse
    found = assembly.system("timoshenko", "timoshenko").modes(20).frequency_hz
    assert found[0] == 0.0 and found[1] > 1  # one exact zero
    wanted = hz[:20][hz[:20] < 4000]
    # 1e-4 is what a reduction may cost; rounding of the full matrices stays below 1e-6
    assert np.allclose(found[1 : 1 + len(wanted)], wanted, rtol=1e-6)


def test_all_modes_kept_is_no_reduction_at_all(coarse):
    _, hz = coarse
    assembly = Assembly(TRAIN_DATA, kept=10_000, settings=COARSE)
    system = assembly.system("timoshenko", "timoshenko")
    assert np.isinf(system.truncation.cut)
    found = system.modes(12).frequency_hz[1:]
    # the torsion of the train has the least digits in the full matrices: (1e6 / 16 Hz)^2 eps
    assert np.allclose(found[2:], hz[2:12], rtol=1e-8)
    assert np.allclose(found[:2], hz[:2], rtol=1e-5)


def test_the_layout_of_the_thesis_has_ninety_two_degrees_of_freedom():
    """Hua (2010), section 2.2: 15 nodes x 6, engine and load; its modes below 3 kHz are those of
    many elements within what cubic shapes over a whole shaft can do.
    """
    scene = sg.load(OVERHUNG.parent / "thesis_straddle.toml")
    train = TRAIN_DATA.with_changes(pinion=TRAIN_DATA.pinion.with_changes(scene=scene))
    few = Assembly(train, kept=10_000, settings={"euler": {"elements": 1}})
    system = few.system("euler", "euler")
    assert system.size == 92
    assert sum(few.shaft_model(side, "euler").unknowns for side in ("pinion", "gear")) == 15 * 6
    fine = Assembly(train).system("euler", "euler").modes(12).frequency_hz[1:]
    coarse = system.modes(12).frequency_hz[1:]
    low = fine < 3000.0
    assert np.all(coarse[low] >= fine[low] * (1 - 1e-9))  # Rayleigh
    assert np.abs(coarse[low] / fine[low] - 1).max() < 2e-3


@pytest.mark.parametrize(("reduction", "kept", "within"), [("rubin", 3, 2e-3), ("rubin", 8, 1e-5)])
def test_the_bound_holds_and_few_modes_will_do(coarse, reduction, kept, within):
    _, hz = coarse
    assembly = Assembly(TRAIN_DATA, reduction=reduction, kept=kept, settings=COARSE)
    found = assembly.system("timoshenko", "timoshenko").modes(8)
    error = found.frequency_hz[1:] / hz[:8] - 1
    assert np.all(error[2:] >= -1e-9)  # Rayleigh: never too low
    assert np.all(error[2:] <= found.error_bound[3:] + 1e-9)
    assert np.abs(error[2:]).max() < within


def test_craig_bampton_gives_the_same(coarse):
    _, hz = coarse
    assembly = Assembly(TRAIN_DATA, reduction="craig_bampton", kept=30, settings=COARSE)
    found = assembly.system("timoshenko", "timoshenko").modes(8).frequency_hz
    assert np.allclose(found[3:], hz[2:8], rtol=1e-3)


def lumped_pair(assembly, masses, stiffness):
    train, met = assembly.train, assembly.contact
    return LumpedPair(
        train.engine.inertia,
        train.load.inertia,
        masses["pinion"],
        masses["gear"],
        stiffness["pinion"],
        stiffness["gear"],
        train.engine.spring.stiffness,
        train.load.spring.stiffness,
        met.stiffness,
        met.pinion,
        met.gear,
    )


def test_rigid_shafts_are_the_fourteen_degrees_with_rigid_masses():
    assembly = Assembly(TRAIN_DATA, settings=COARSE)
    masses, stiffness = {}, {}
    for side, scene in assembly.scenes.items():
        body = sg.build(scene, "timoshenko", elements=8)
        y = scene.port.y
        back = shift([0.0, -y, 0.0])
        masses[side] = back.T @ body.mass_matrix() @ back
        total = sum(moved_by(b.stiffness, [0, y - b.y, 0]) for b in scene.bearings)
        if scene.housing_axial:
            total = total - np.outer(total[1], total[1]) / (scene.housing_axial + total[1, 1])
        stiffness[side] = total
    exact = lumped_pair(assembly, masses, stiffness).solve().frequency_hz
    found = assembly.system("rigid/timoshenko", "rigid/timoshenko").modes().frequency_hz
    assert found[0] == exact[0] == 0.0
    assert np.allclose(found[1:], exact[1:], rtol=1e-10)


def test_a_lumped_shaft_has_the_condensed_stiffness():
    assembly = Assembly(TRAIN_DATA, settings=COARSE)
    masses, stiffness = {}, {}
    for side, scene in assembly.scenes.items():
        model = assembly.shaft_model(side, "lumped/timoshenko")
        stiffness[side] = np.array(condense(model.body, scene, scene.port.name).stiffness)
        masses[side] = model.part.mass
    exact = lumped_pair(assembly, masses, stiffness).solve().frequency_hz
    found = assembly.system("lumped/timoshenko", "lumped/timoshenko").modes().frequency_hz
    assert np.allclose(found[1:], exact[1:], rtol=1e-9)


def test_the_effective_axial_mass_is_less_than_the_total():
    assembly = Assembly(TRAIN_DATA, settings=COARSE)
    part = assembly.shaft_model("gear", "lumped/timoshenko").part
    total = assembly.shaft_model("gear", "timoshenko").body.mass_matrix()[1, 1]
    assert total == pytest.approx(79.82, abs=0.01)
    assert part.mass[1, 1] < total


def test_the_train_turns_in_the_ratio_of_its_teeth():
    system = Assembly(TRAIN_DATA, settings=COARSE).system("timoshenko", "euler")
    turn = system.modes(1).shapes[:, 0]
    engine, load = (system.motion(name)[4] @ turn for name in ("engine", "load"))
    assert abs(engine / load) == pytest.approx(45 / 14, rel=1e-12)


def test_names_are_one_a_mode_and_say_what_moves():
    assembly = Assembly(TRAIN_DATA, settings=COARSE)
    system = assembly.system("timoshenko", "timoshenko")
    found = system.modes(10)
    names = mode_names(assembly, system, found)
    assert len(set(names)) == len(names)
    assert names[0] == TRAIN
    assert names[1].startswith("load torsion") and names[2].split()[1] == "torsion"


def test_a_solid_has_modes_that_the_mesh_does_not_drive():
    coarse = {"solid": {"around": 8, "refinement": 0.3}, **COARSE}
    assembly = Assembly(TRAIN_DATA, kept=16, settings=coarse)
    found = train_modes(assembly, "euler", "solid", max_frequency=3000.0)
    named = [mode.name for mode in found.modes if "ovalising" in mode.name]
    assert named == ["gear ovalising n=2 1", "gear ovalising n=2 2"]  # near 1.9 kHz
    assert any("not driven by this mesh model" in line for line in found.remarks())


def test_a_shaft_that_nothing_holds_along_its_axis_is_told():
    scene = TRAIN_DATA.gear.scene
    bearings = []
    for bearing in scene.bearings:
        k = np.array(bearing.matrix)
        k[1] = k[:, 1] = 0.0
        bearings.append(bearing.with_changes(matrix=tuple(map(tuple, k))))
    loose = scene.with_changes(bearings=tuple(bearings), housing_axial=None)
    train = TRAIN_DATA.with_changes(gear=TRAIN_DATA.gear.with_changes(scene=loose))
    found = train_modes(
        Assembly(train, settings=COARSE), "timoshenko", "timoshenko", max_frequency=500.0
    )
    assert found.rigid == 2
    assert "gear's shaft do not hold it in y" in found.remarks()[0]


def test_a_frequency_beyond_the_reduction_is_refused():
    assembly = Assembly(TRAIN_DATA, kept=4, settings=COARSE)
    with pytest.raises(
        sg.SolidgearError, match="is beyond the reduction, which leaves out modes from"
    ):
        train_modes(assembly, "timoshenko", "timoshenko", max_frequency=20_000.0)


def test_a_frequency_beyond_the_mesh_is_refused():
    # so many modes are kept that the reduction resolves more than cells of 28 mm and order 2 do
    coarse = {"harmonic": {"order": 2, "layers": 0, "edge_layers": 0}}
    assembly = Assembly(TRAIN_DATA, kept=80, settings=coarse)
    with pytest.raises(sg.SolidgearError, match="beyond the mesh of the gear"):
        train_modes(assembly, "timoshenko", "harmonic", max_frequency=20_000.0)
    assert train_modes(assembly, "timoshenko", "harmonic", max_frequency=2_000.0).modes


def test_cells_of_one_order_follow_waves_of_one_length():
    reach = []
    for element in ("tet10", "hex20"):
        assembly = Assembly(
            TRAIN_DATA, kept=4, settings={"solid": {"element": element, "refinement": 0.3}}
        )
        model = assembly.shaft_model("gear", "solid")
        limit = mesh_limit(assembly, "gear", model.part)
        reach.append(limit * model.body.mesh["representative_size"])
    assert reach[0] == pytest.approx(reach[1], rel=1e-12)  # both are of second order


@pytest.mark.parametrize(
    ("rung", "words"),
    [
        ("timoschenko", 'did you mean "timoshenko"'),
        ("euler/harmonic", "such as lumped/harmonic"),
        ("lumped/stiff", "such as lumped/harmonic"),
    ],
)
def test_an_unknown_rung_is_told(rung, words):
    with pytest.raises(sg.SolidgearError, match=words):
        Assembly(TRAIN_DATA).system(rung, "euler")


def test_an_unknown_reduction_is_told():
    with pytest.raises(sg.SolidgearError, match="rubin or craig_bampton"):
        Assembly(TRAIN_DATA, reduction="guyan")


def test_a_reduced_body_is_asked_for_a_port_it_does_not_have():
    system = Assembly(TRAIN_DATA, settings=COARSE).system("timoshenko", "euler")
    with pytest.raises(sg.SolidgearError, match="no port; pinion has pinion.pinion"):
        system.motion("pinion.9")


def test_the_command_prints_a_table_and_json():
    args = ["system-modes", str(OVERHUNG), "--pinion", "euler", "--gear", "timoshenko"]
    table = command(*args)
    assert table.exit_code == 0
    assert "train rotation" in table.stdout and "Identified, not published" in table.stdout
    data = json.loads(command(*args, "--json").stdout)
    assert data["rigid"] == 1 and data["reduction"] == "rubin"
    assert data["modes"][0]["frequency_hz"] == 0.0
    assert data["unpublished"]["mesh.stiffness"] == "identified"


def test_a_mesh_that_cannot_be_names_the_file_and_the_key(tmp_path):
    text = OVERHUNG.read_text().replace('face_width = "63 mm"', 'face_width = "630 mm"')
    for name in ("pinion_overhung", "gear_shaft"):
        text = text.replace(f'"{name}.toml"', f'"{OVERHUNG.parent / name}.toml"')
    path = tmp_path / "wide.toml"
    path.write_text(text)
    done = command("system-modes", str(path))
    assert done.exit_code != 0
    assert "wide.toml: pinion.face_width" in str(done.exception)
    assert "reaches past the apex" in str(done.exception)


def test_the_name_of_the_lumped_point_means_nothing():
    # "teeth" was the name of an inner port, and such a pinion was left out of the mesh's rotation
    pinion, engine = TRAIN_DATA.pinion, TRAIN_DATA.engine
    port = pinion.scene.port.with_changes(name="teeth")
    named = TRAIN_DATA.with_changes(
        pinion=pinion.with_changes(scene=pinion.scene.with_changes(port=port)),
        engine=engine.with_changes(spring=engine.spring.with_changes(at="teeth")),
    )
    usual, other = (
        Assembly(train, kept=4).system("euler", "euler").modes(6).frequency_hz
        for train in (TRAIN_DATA, named)
    )
    assert other == pytest.approx(usual, rel=1e-9, abs=1e-9)


def test_a_shaft_with_a_cut_has_the_solid_that_models_it_where_none_is_named():
    # a keyed pinion was refused by every command on modes, with no model asked for
    shafts = dict(TRAIN_DATA.shafts)
    keyed = sg.load(OVERHUNG.with_name("pinion_keyed.toml"))
    shafts["pinion"] = shafts["pinion"].with_changes(scene=keyed)
    assert models_of(shafts, "train", None) == {"pinion": "corrected", "gear": "harmonic"}
    assert models_of(shafts, "train", {"pinion": "harmonic"})["pinion"] == "harmonic"
    found = train_modes(Assembly(TRAIN_DATA), "euler", "euler", at_most=1)
    mixed = replace(
        found,
        models={"pinion": "corrected", "gear": "harmonic"},
        modes=tuple(replace(mode, mesh=1e-6) for mode in found.modes),
    )
    no_bars = "What the meshes of pinion leave is not known"
    assert any("harmonic shafts' meshes" in line and no_bars in line for line in mixed.notes())
    cut = replace(found, models=dict.fromkeys(("pinion", "gear"), "corrected"))
    assert any("meshes of pinion, gear leave is not known" in line for line in cut.notes())
    assert not any("is not known" in line for line in found.notes())


def test_mixes_of_a_train_with_a_cut_are_refused_with_what_does_answer():
    keyed = sg.load(OVERHUNG.with_name("pinion_keyed.toml"))
    shafts = TRAIN_DATA.shafts | {"pinion": TRAIN_DATA.shafts["pinion"].with_changes(scene=keyed)}
    with pytest.raises(sg.SolidgearError, match=r"'pinion' has keyway.*run solidgear system-modes"):
        judge_train(Assembly(TRAIN_DATA.with_changes(shafts=shafts)))
