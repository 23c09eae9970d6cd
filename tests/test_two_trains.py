"""Two trains beside each other: what differs in their files is told and nothing else, and every number
is that of the file alone.
"""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.errors import SolidgearError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.load.strain import strain_shares
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.respond import respond
from solidgear.two_designs.differences import differences
from solidgear.two_designs.two_trains import others, reactions, two_trains
from tests.command import command, page_of, table

GEOMETRY = Path(__file__).parent.parent / "geometry"
OVERHUNG, STRADDLE = GEOMETRY / "axle_overhung.toml", GEOMETRY / "axle_straddle.toml"
TWO_STAGE = GEOMETRY / "gearbox_two_stage.toml"
COARSE = {"harmonic": {"order": 2, "layers": 1}}
EULER = ("euler", "euler")
#: columns of both mesh forces of two stages, the second driving
MESHES = ("mesh force [N]", "mesh force input-middle [N]")


def copied(folder, name="b.toml", **replaced):
    """The overhung train and its scenes in a folder, texts of the train's file replaced."""
    for scene in ("pinion_overhung.toml", "gear_shaft.toml"):
        shutil.copy(GEOMETRY / scene, folder)
    text = OVERHUNG.read_text()
    for old, new in replaced.values():
        assert old in text
        text = text.replace(old, new)
    (folder / name).write_text(text)
    return folder / name


@pytest.fixture(scope="module")
def stiffer(tmp_path_factory):
    """The shipped train beside one with twice the mesh stiffness, on coarse meshes."""
    folder = tmp_path_factory.mktemp("two")
    other = copied(folder, stiffness=('"2.5e8 N/m"', '"5e8 N/m"'))
    words = ("--pinion", "timoshenko", "--out", folder / "out", "--json", "--tol", "0.05")
    done = command("compare", OVERHUNG, other, *words)
    alone = respond(Assembly(sg.load_train(other), tol=0.05), "timoshenko", "harmonic")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout), folder / "out", alone


@pytest.fixture(scope="module")
def mountings():
    shops = [Assembly(sg.load_train(file)) for file in (OVERHUNG, STRADDLE)]
    return two_trains(shops, ("overhung", "straddle"), (), *EULER)


# --------------------------------------------------------------------------- what differs
@pytest.mark.long
def test_twice_the_mesh_stiffness_is_all_that_the_table_of_inputs_shows(stiffer):
    told, _, _ = stiffer
    assert told["differences"] == [{"path": "mesh.stiffness", "a": "2.5e8 N/m", "b": "5e8 N/m"}]
    assert told["sentences"][0] == "Changed: mesh.stiffness from 2.5e8 N/m to 5e8 N/m."


def test_what_means_the_same_is_no_difference(tmp_path):
    same = copied(
        tmp_path,
        units=('"2.5e8 N/m"', "250e6"),
        angle=('"25 deg"', f'"{float(np.radians(25.0))!r} rad"'),
        default=("teeth = 45", 'teeth = 45\napex = "start"'),
        status=('status = "identified"', 'status = "identified"  # as before'),
    )
    assert differences(OVERHUNG, same) == ()


def test_scenes_of_both_shafts_are_looked_into_by_the_names_in_them():
    found = {d.path: (d.a, d.b) for d in differences(OVERHUNG, STRADDLE) if not d.in_words}
    assert found.pop("pinion.bearing.0")[0] is None
    assert found.pop("pinion.segment.pilot")[1]["length"] == "56.75 mm"
    assert found == {
        "pinion.segment.shaft.length": ("208 mm", "173 mm"),
        "pinion.bearing.2.position": ("150 mm", "115 mm"),
        "pinion.housing": (None, {"axial": "7.71e9 N/m"}),
    }


def test_two_tables_of_one_name_differ_by_what_is_in_them(tmp_path):
    files = []
    for name, force in (("a", "100"), ("b", "120")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "cells.csv").write_text(f"x,y,z,nx,ny,nz,force\n0,0,0,0,0,1,{force}\n")
        cells = ('pressure_angle = "25 deg"', 'contact_cells = "cells.csv"')
        files.append(copied(tmp_path / name, name="train.toml", cells=cells))
    assert [d.path for d in differences(*files)] == ["mesh.contact_cells"]
    assert differences(files[0], files[0]) == ()


# --------------------------------------------------------------------------- numbers
@pytest.mark.long
def test_every_number_is_that_of_the_file_alone(stiffer):
    told, _, alone = stiffer
    peaks = [pair["b"] for pair in told["peaks"] if pair["b"] is not None]
    assert [p["mode"] for p in peaks] == [p.mode for p in alone.peaks]
    assert [p["force"] for p in peaks] == pytest.approx([p.force for p in alone.peaks])
    curve = told["responses"]["b"]["amplitude"]["pinion bearing 1 z [N]"]
    own = np.abs(alone.columns["pinion bearing 1 z [N]"])
    assert curve == pytest.approx(own.tolist())
    largest = told["largest"]["pinion bearing 1 z [N]"]["b"]
    assert largest["size"] == pytest.approx(own.max())


@pytest.mark.long
def test_modes_that_both_share_are_pairs_and_what_the_mesh_strains_rises(stiffer):
    told, _, _ = stiffer
    pairs = told["modes"]
    assert all(pair["a"] and pair["b"] and pair["mac"] > 0.3 for pair in pairs)
    # by Rayleigh: on the same mesh a stiffer spring lowers no frequency, counted from below
    hz = [sorted(pair[key]["frequency_hz"] for pair in pairs) for key in "ab"]
    assert np.all(np.array(hz[1]) > (1 - 1e-9) * np.array(hz[0]))
    for pair in pairs:
        change = pair["frequency"]
        assert change["band"] == pytest.approx(change["bar_a"] + change["bar_b"])
        assert change["bar_a"] == pytest.approx(pair["a"]["bar"] * pair["a"]["frequency_hz"])
        resolved = abs(change["difference"]) > change["band"]
        assert change["verdict"] == ("resolved" if resolved else "not resolved")
    moved = {p["a"]["name"]: p["frequency"] for p in pairs}
    # a quarter of its energy is in the mesh, and these meshes leave 1 % of its frequency
    assert moved["gear axial 1"]["verdict"] == "resolved"
    # a mode of the gear across the line of action
    assert moved["gear bending 2"]["verdict"] == "not resolved"


def test_a_train_beside_itself_differs_nowhere_and_nothing_is_resolved():
    assembly = Assembly(sg.load_train(OVERHUNG))
    found = two_trains(
        (assembly, assembly), ("one", "same"), (), "harmonic", "timoshenko", highest_hz=1000.0
    )
    assert found.modes and found.peaks
    for pair in found.modes:
        assert pair.a.name == pair.b.name and pair.mac == pytest.approx(1.0)
        assert pair.change.difference == 0.0 and pair.change.band > 0.0
        assert pair.change.verdict == "not resolved"
    assert all(pair.decibels == 0.0 for pair in found.peaks)
    assert all(found.decibels(c) in (0.0, None) for c in found.columns)
    told = found.told()
    assert told[0] == "Nothing differs in the input."
    assert any(
        one.startswith("None of") and "changed by more than their error bars." in one
        for one in told
    )


def test_a_mirrored_train_has_the_same_frequencies_found_by_name(tmp_path):
    mirrored = copied(
        tmp_path,
        pinion=('hand = "left" ', 'hand = "other"'),
        gear=('hand = "right"', 'hand = "left"'),
        back=('hand = "other"', 'hand = "right"'),
    )
    shops = [Assembly(sg.load_train(file)) for file in (OVERHUNG, mirrored)]
    found = two_trains(shops, ("left", "right"), (), *EULER, highest_hz=2500.0)
    assert "by the motion that names them" in found.pairing
    for pair in found.modes:
        assert pair.a.name == pair.b.name and pair.mac is None
        assert pair.change.relative == pytest.approx(0.0, abs=1e-9)


def test_what_one_train_has_alone_is_told_so(mountings):
    assert "all but pinion.0" in mountings.pairing
    assert mountings.a.largest("pinion bearing 0 z [N]") is None
    assert mountings.b.largest("pinion bearing 0 z [N]")[1] > 0
    assert mountings.decibels("pinion bearing 0 z [N]") is None
    together = [(pair.a.mode, pair.b.mode) for pair in mountings.peaks if pair.a and pair.b]
    assert set(together) <= {(p.a.name, p.b.name) for p in mountings.modes if p.a and p.b}
    alone = [pair.a for pair in mountings.peaks if pair.b is None]
    assert "pinion bending 2" in [peak.mode for peak in alone]
    known = {p.a.name for p in mountings.modes if p.a} | {p.b.name for p in mountings.modes if p.b}
    assert {m.name for one in mountings.both for m in one.modes if m.frequency_hz < 4000} <= known


def test_strain_energies_add_up_to_one_and_are_those_of_each_spring():
    assembly = Assembly(sg.load_train(STRADDLE))
    system = assembly.system("timoshenko", "timoshenko")
    found = system.modes(10)
    shares = strain_shares(found.energy)
    assert list(shares) == [
        "engine spring",
        "pinion shaft",
        "pinion bearings",
        "mesh",
        "gear bearings",
        "gear shaft",
        "load spring",
    ]
    elastic = found.shapes[:, found.rigid :]
    squared = (2 * np.pi * found.frequency_hz[found.rigid :]) ** 2  # u'Ku of unit modal mass
    own = {name: share[found.rigid :] for name, share in shares.items()}
    assert sum(own.values()) == pytest.approx(np.ones(10))

    for side, rotor in (("pinion", "engine"), ("gear", "load")):
        supports = as_supports(assembly.scenes[side])
        seats = np.vstack([system.motion(f"{side}.{name}") for name in supports.ports]) @ elastic
        energy = np.einsum("ik,ij,jk->k", seats, np.array(supports.stiffness), seats)
        assert own[f"{side} bearings"] == pytest.approx(energy / squared, abs=1e-9)
        at = f"{side}.{assembly.train.spring_port(rotor)}"
        twist = (system.motion(at)[4] - system.motion(rotor)[4]) @ elastic
        stiffness = assembly.train.rotors[rotor].spring.stiffness
        assert own[f"{rotor} spring"] == pytest.approx(stiffness * twist**2 / squared, abs=1e-9)
    vectors = [(f"{side}.{assembly.scenes[side].port.name}", side) for side in ("pinion", "gear")]
    stretch = [getattr(assembly.contact, s).vector @ system.motion(port) for port, s in vectors]
    energy = assembly.contact.stiffness * ((stretch[0] - stretch[1]) @ elastic) ** 2
    assert own["mesh"] == pytest.approx(energy / squared, abs=1e-9)


def test_twice_the_torque_and_transmission_error_double_all_and_move_no_frequency():
    # bearings of these files are of constant stiffness: everything is linear
    train = sg.load_train(OVERHUNG)
    shops = [
        Assembly(
            train.with_changes(
                operation=(OperatingPoint(torque=100.0 * twice),),
                mesh=train.mesh.with_changes(transmission_error=2e-6 * twice),
            )
        )
        for twice in (1, 2)
    ]
    found = two_trains(shops, ("once", "twice"), (), *EULER, highest_hz=1000.0)
    assert {number.name for number in found.changes} == {"E", "P", "G", "shaft angle"}
    for change in (number.change for number in found.changes):
        assert change.relative == pytest.approx(np.sign(change.a), rel=1e-6)
    loads = [
        {b.name: b.radial for shaft in one.loaded.shafts for b in shaft.bearings}
        for one in found.both
    ]
    assert loads[1] == {name: pytest.approx(2 * load, rel=1e-6) for name, load in loads[0].items()}
    assert all(abs(pair.change.relative) < 1e-12 for pair in found.modes)
    double = pytest.approx(6.0206, abs=1e-4)  # dB
    assert [pair.decibels for pair in found.peaks] == [double] * len(found.peaks)
    assert found.decibels("gear bearing 3 z [N]") == double


# --------------------------------------------------------------------------- three shafts
@pytest.fixture(scope="module")
def three():
    """The shipped gearbox of two stages, and it with twice the stiffness of the second mesh."""
    train = sg.load_train(TWO_STAGE)
    first, second = train.meshes
    stiffer = second.with_changes(stiffness=2 * second.stiffness)
    return Assembly(train), Assembly(train.with_changes(meshes=(first, stiffer)))


@pytest.mark.slow
def test_numbers_of_three_shafts_are_those_of_each_train_alone(three):
    mix = ("euler", "timoshenko", "euler")
    how = {"mesh": "middle-output", "highest_hz": 700.0}
    found = two_trains(three, ("usual", "stiffer"), (), *mix, **how)
    told = found.results
    assert told["models"] == dict(zip(("input", "middle", "output"), mix))
    for key, assembly in zip("ab", three):
        alone = respond(assembly, *mix, **how)
        assert [p[key] for p in told["peaks"] if p[key]] == [p._asdict() for p in alone.peaks]
        for column in (*MESHES, "middle bearing E z [N]", "output thx [rad]"):
            own = np.abs(alone.columns[column])
            assert told["responses"][key]["amplitude"][column] == own.tolist()
            assert told["largest"][column][key]["size"] == own.max()
        modes = {
            m.name: m.frequency_hz for m in train_modes(assembly, *mix, max_frequency=700).modes
        }
        del modes["train rotation"]
        seen = {p[key]["name"]: p[key]["frequency_hz"] for p in told["modes"] if p[key]}
        assert {name: seen[name] for name in modes} == pytest.approx(modes, rel=1e-12)
        assert all(sum(p[key]["shares"].values()) == pytest.approx(1) for p in told["modes"])
    # by Rayleigh: a stiffer spring lowers no frequency, counted from below
    hz = [sorted(p[key]["frequency_hz"] for p in told["modes"]) for key in "ab"]
    assert np.all(np.array(hz[1]) > (1 - 1e-9) * np.array(hz[0])) and hz[1][-1] > hz[0][-1]
    for words in ("Largest force of the mesh middle-output: ", "Largest force of the mesh input-"):
        assert any(one.startswith(words) for one in told["sentences"])
    # at rest torque alone makes the forces, whatever the teeth give
    changes = {number.name: number for number in found.changes}
    assert {"in plane input-middle", "across middle-output"} <= {*changes}
    assert all(change.relative == pytest.approx(0, abs=1e-6) for change in changes.values())
    assert others(found) == [(MESHES[1], "force of the mesh input-middle")]
    for unit in ("N", "N m"):
        shafts = [column.split()[0] for column, _ in reactions(found, unit)]
        assert shafts == sorted(shafts) and {*shafts} == {*told["models"]}


def test_shafts_and_meshes_that_one_train_does_not_have_are_refused(three):
    pair = Assembly(sg.load_train(OVERHUNG))
    with pytest.raises(SolidgearError, match="pinion, gear and b has the shafts input, middle"):
        two_trains((pair, three[0]), ("a", "b"))
    with pytest.raises(SolidgearError, match="no mesh 'third'; it has input-middle, middle-out"):
        two_trains(three, ("a", "b"), mesh="third")


# --------------------------------------------------------------------------- page and files
@pytest.mark.long
def test_the_page_holds_the_numbers_of_the_json_and_needs_no_other_file(stiffer):
    told, out, _ = stiffer
    page, text = page_of(out, told, told["sentences"])
    for pair in told["modes"]:
        for one in (pair["a"], pair["b"]):
            shown = f"{one['frequency_hz']:.1f}"
            assert one["frequency_hz"] < 100 or (one["name"] in text and shown in text)
            assert all(f"{100 * s:.1f}" in text for s in one["shares"].values() if s > 0.01)
    for pair in told["peaks"]:
        assert pair["decibels"] is None or f"{pair['decibels']:+.1f} dB" in text
    for path in ("mesh.stiffness", "2.5e8 N/m", "5e8 N/m"):
        assert path in text
    for anchor in re.findall(r'<a href="#([^"]*)"', page):
        assert f'id="{anchor}"' in page
    # both trains can be read off the charts
    assert {"A: axle_overhung", "B: b"} <= set(re.findall(r'aria-label="([^"&]*)&#xA;', page))


@pytest.mark.long
def test_the_tables_of_the_folder_are_both_responses(stiffer):
    told, out, _ = stiffer
    for key in "ab":
        rows = table(out / f"response_{key}.csv")
        force = told["responses"][key]["amplitude"]["mesh force [N]"]
        assert [float(row["mesh force [N]"]) for row in rows] == pytest.approx(force)


@pytest.mark.parametrize(
    "words, said",
    [
        ([OVERHUNG, STRADDLE, "--models", "euler"], "--models is for one shaft"),
        ([OVERHUNG, STRADDLE, "--pinion", "eulr"], "did you mean.*euler"),
        ([OVERHUNG, "--pinion", "euler"], "--pinion is for two trains"),
        ([OVERHUNG, "--mesh", "mesh"], "--mesh is for two trains"),
        ([TWO_STAGE, OVERHUNG, "--pinion", "euler"], 'has no shaft "pinion"; it has input'),
    ],
    ids=lambda w: "" if isinstance(w, list) else w[:30],
)
def test_what_cannot_be_compared_is_refused_in_a_sentence(words, said, tmp_path):
    done = command("compare", *words, "--out", tmp_path / "out")
    assert done.exit_code == 1 and re.search(said, str(done.exception))
    assert not (tmp_path / "out").exists()


def test_one_file_given_twice_is_told_so_and_nothing_is_solved(tmp_path):
    for words in ([OVERHUNG, OVERHUNG], [OVERHUNG, OVERHUNG.parent / "." / OVERHUNG.name]):
        done = command("compare", *words, "--out", tmp_path / "out")
        assert done.exit_code == 0 and "nothing differs" in done.output
    told = json.loads(command("compare", OVERHUNG, OVERHUNG, "--json").stdout)
    assert told["differences"] == [] and "nothing differs" in told["sentences"][0]
    assert not (tmp_path / "out").exists()


def test_frames_of_two_trains_hold_numbers(mountings):
    pytest.importorskip("pandas")
    modes = mountings.to_dataframe("natural_frequencies")
    change = (modes["B"] - modes["A"]) / modes["A"]
    assert np.allclose(modes["difference"].dropna(), change.dropna(), rtol=1e-12)
    shares = mountings.to_dataframe("strain_energy").drop(columns=["mode", "frequency"])
    assert np.allclose(shares.sum(axis=1), 1.0)
