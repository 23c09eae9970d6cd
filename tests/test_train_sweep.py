"""Sweeps of a train: rows against the same files edited by hand, what is kept from row to row, what
is refused, and stops.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from command import command, numbers

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.scene.paths import keys_of, label_of, with_entry
from solidgear.core.scene.toml_file import parse
from solidgear.strength.deflection.at_rest import deflection
from solidgear.strength.deflection.misalignment import measured_names
from solidgear.trains.assembly import assembly as train_assembly
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.load.operation import at_point
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.respond import respond
from solidgear.variants.sweep import file_task
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import run
from solidgear.variants.sweep.train_task import train_task

GEOMETRY = Path(__file__).parent.parent / "geometry"
TWO_STAGE = GEOMETRY / "gearbox_two_stage.toml"
GEARBOX, AXLE = GEOMETRY / "gearbox_train.toml", GEOMETRY / "axle_overhung.toml"
BEAMS = {"pinion": "timoshenko", "gear": "timoshenko"}
LIGHT = {**BEAMS, "max_frequency": 1500.0}
MODES, AT_REST = ["system-modes"], ["deflect"]


def counted(train, vary, out, progress=lambda *_: None, jobs=1, **how):
    """Account and rows of a sweep, numbers as numbers, and how many bodies were made."""
    drawn = {k: how.pop(k) for k in ("sample", "seed") if k in how}
    task = train_task(train, Design(tuple(vary), **drawn), **{**LIGHT, **how})
    found = run(task, out, progress=progress, jobs=jobs)
    return found, numbers(out), task.bench.made


def swept(*of, **how):
    """The same without bodies."""
    return counted(*of, **how)[:2]


def by_hand(folder, file, *edits):
    """Copy of the shipped files with texts replaced in some of them; the file of the train."""
    for source in GEOMETRY.glob("*.toml"):
        text = source.read_text()
        for name, old, new in edits:
            if source.name == name:
                assert text.count(old) == 1, (name, old)
                text = text.replace(old, new)
        (folder / source.name).write_text(text)
    return folder / file.name


# ---------------------------------------------------------------------------------- what rows say
def test_a_row_is_what_the_same_files_edited_by_hand_give(tmp_path):
    vary = [
        "operation.full.torque=140 N*m",
        "mesh.stiffness=log:2e8 N/m:4e8 N/m:2",
        "pinion.bearing.A.position=16.5 mm",
        "gear.segment.right.diameter=50 mm:52 mm:2",
    ]
    found, rows = swept(GEARBOX, vary, tmp_path / "rows.csv", max_frequency=None)
    assert (found.total, found.refused) == (4, 0)
    (row,) = (r for r in rows if list(r.values())[1:5] == [140.0, 4e8, 0.0165, 0.05])
    path = by_hand(
        tmp_path,
        GEARBOX,
        ("gearbox_train.toml", 'torque = "115 N*m"', 'torque = "140 N*m"'),
        ("gearbox_train.toml", 'stiffness = "3.2e8 N/m"', 'stiffness = "4e8 N/m"'),
        ("gearbox_catalogue.toml", 'position = "15 mm"', 'position = "16.5 mm"'),
        ("gearbox_wheel.toml", 'diameter = "52 mm"', 'diameter = "50 mm"'),
    )
    train = sg.load_train(path)
    assembly = Assembly(train)
    modes = [mode for mode in train_modes(assembly, *BEAMS.values()).modes if mode.frequency_hz > 0]
    assert row["modes"] == len(modes) and row["rigid_modes"] == 1
    # the same operations on the same numbers; the tangents of bearings are found to 1e-9
    swept_hz = [row[f"f{k}_hz"] for k in range(1, len(modes) + 1)]
    np.testing.assert_allclose(swept_hz, [mode.frequency_hz for mode in modes], rtol=1e-8)
    assert [row[f"mode{k}"] for k in range(1, len(modes) + 1)] == [mode.name for mode in modes]
    assert row[f"f{len(modes) + 1}_hz"] == ""
    tops = sorted(respond(assembly, *BEAMS.values()).peaks, key=lambda top: -top.force)
    for k, top in enumerate(tops[:3], start=1):
        assert row[f"peak{k}_hz"] == pytest.approx(top.frequency_hz, rel=1e-8)
        assert row[f"peak{k}_force"] == pytest.approx(top.force, rel=1e-6)
        assert row[f"peak{k}_mode"] == top.mode
    still = deflection(assembly, train.operation[0], *BEAMS.values())
    assert row["mesh_force"] == pytest.approx(still.mesh_forces["mesh"], rel=1e-12)
    assert [one.name for one in still.misalignment] == list(measured_names(train))
    for one in still.misalignment:
        column = f"misalignment_{one.name.replace(' ', '_')}"
        assert row[column] == pytest.approx(one.value, rel=1e-6, abs=1e-12)
    for shaft in still.shafts:
        for bearing in shaft.bearings:
            told = [row[f"{shaft.name}.{bearing.name}.{w}"] for w in ("radial", "axial", "moment")]
            own = bearing.radial, bearing.load[1], bearing.moment
            np.testing.assert_allclose(told, own, rtol=1e-6, atol=1e-6)


@pytest.mark.long
def test_a_row_of_three_shafts_is_what_the_same_files_edited_by_hand_give(tmp_path):
    mix = {"input": "euler", "middle": "timoshenko", "output": "lumped/euler"}
    how = {"mesh": "middle-output", "models": mix, "pinion": None, "gear": None}
    vary = [
        "mesh.middle-output.stiffness=4.5e8 N/m,9e8 N/m",
        "middle.bearing.E.position=18 mm",
        "output.head.mass=12 kg,13 kg",
    ]
    found, rows, bodies = counted(
        TWO_STAGE, vary, tmp_path / "rows.csv", max_frequency=700.0, **how
    )
    assert (found.total, found.refused, bodies) == (4, 0, 3)
    (row,) = (r for r in rows if list(r.values())[1:4] == [9e8, 0.018, 13.0])
    path = by_hand(
        tmp_path,
        TWO_STAGE,
        (TWO_STAGE.name, 'stiffness = "4.5e8 N/m"', 'stiffness = "9e8 N/m"'),
        (TWO_STAGE.name, 'mass = "12 kg"', 'mass = "13 kg"'),
        ("gearbox_middle.toml", 'position = "15 mm"', 'position = "18 mm"'),
    )
    train = sg.load_train(path)
    assembly = Assembly(train)
    modes = train_modes(assembly, *mix.values(), max_frequency=700.0).modes[1:]
    assert row["modes"] == len(modes) and row["mode3"] == modes[2].name
    hz = [row[f"f{k}_hz"] for k in range(1, len(modes) + 1)]
    np.testing.assert_allclose(hz, [mode.frequency_hz for mode in modes], rtol=1e-8)
    tops = respond(assembly, *mix.values(), mesh="middle-output", highest_hz=700.0).peaks
    top = max(tops, key=lambda one: one.force)
    assert row["peak1_force"] == pytest.approx(top.force, rel=1e-6)
    assert row["peak1_mode"] == top.mode
    still = deflection(assembly, train.operation[0], "euler", "timoshenko", "euler")
    for name, force in still.mesh_forces.items():
        assert row[f"mesh_force_{name.partition(' ')[2]}"] == pytest.approx(force, rel=1e-12)
    for one in still.misalignment:
        column = f"misalignment_{one.name.replace(' ', '_')}"
        assert row[column] == pytest.approx(one.value, rel=1e-6, abs=1e-12)
    carried = {f"{s.name}.{b.name}.radial": b.radial for s in still.shafts for b in s.bearings}
    assert {c: row[c] for c in carried} == pytest.approx(carried, rel=1e-6) and len(carried) == 6
    for other, says in (
        ({"models": {"pinion": "euler"}}, "has no shaft 'pinion'"),
        ({"mesh": "third"}, "no mesh 'third'"),
    ):
        with pytest.raises(SolidgearError, match=says):
            swept(TWO_STAGE, vary, tmp_path / "no.csv", **how | other)
    with pytest.raises(SolidgearError, match="input.bearing.A.position or middle.bearing.A"):
        swept(TWO_STAGE, ["bearing.A.position=1,2"], tmp_path / "no.csv", **how)


def test_the_bound_of_a_row_is_the_largest_of_its_frequencies(tmp_path):
    how = {"reduction": "craig_bampton", "kept": 8, "n": 9, "ask": MODES, "max_frequency": None}
    _, (row,) = swept(AXLE, ["mesh.stiffness=2.5e8 N/m"], tmp_path / "rows.csv", **how)
    modes = train_modes(Assembly(sg.load_train(AXLE), "craig_bampton", 8), *BEAMS.values()).modes[
        1:
    ]
    largest = max(mode.bound for mode in modes[:9])
    assert row["reduction_bound"] == pytest.approx(largest, rel=1e-6) and largest > 1e-8
    assert row["modes"] == len(modes) > 9 and "f10_hz" not in row


def test_every_operating_point_has_a_row_that_is_the_train_at_that_point(tmp_path):
    _, rows = swept(GEARBOX, [], tmp_path / "rows.csv", every_point=True, ask=MODES + AT_REST)
    assert [(row["point"], row["torque"]) for row in rows] == [("full", 115.0), ("coast", -30.0)]
    train = at_point(sg.load_train(GEARBOX), "coast")
    assembly = Assembly(train)
    modes = train_modes(assembly, *BEAMS.values(), max_frequency=1500.0).modes
    own = [mode.frequency_hz for mode in modes if mode.frequency_hz > 0]
    np.testing.assert_allclose(
        [rows[1][f"f{k}_hz"] for k in range(1, len(own) + 1)], own, rtol=1e-8
    )
    assert rows[0]["f3_hz"] != pytest.approx(rows[1]["f3_hz"], rel=1e-3)
    in_plane = deflection(assembly, train.operation[0], *BEAMS.values()).misalignment[0].value
    assert rows[1]["misalignment_in_plane"] == pytest.approx(in_plane, rel=1e-6)


def test_the_point_that_varies_is_the_one_that_is_looked_at(tmp_path):
    vary = ["operation.coast.torque=-30 N*m,-60 N*m"]
    _, rows = swept(GEARBOX, vary, tmp_path / "a.csv", ask=AT_REST)
    assert [row["torque"] for row in rows] == [-30.0, -60.0]
    _, rows = swept(GEARBOX, vary, tmp_path / "b.csv", ask=AT_REST, point="full")
    assert [row["torque"] for row in rows] == [115.0, 115.0]
    both = [*vary, "operation.full.torque=1,2"]
    with pytest.raises(SolidgearError, match="several operating points; choose one by `point`"):
        swept(GEARBOX, both, tmp_path / "c.csv")


def test_a_range_has_the_unit_of_its_first_end_in_curves_and_si_in_rows(tmp_path):
    vary = ["pinion.bearing.2.position=140 mm:0.15 m:3"]
    found, rows = swept(AXLE, vary, tmp_path / "rows.csv", ask=MODES)
    assert [row["pinion.bearing.2.position"] for row in rows] == [0.14, 0.145, 0.15]
    curves = found.curves
    assert (curves.over, curves.unit) == ("pinion.bearing.2.position", "mm")
    assert curves.x.tolist() == [140.0, 145.0, 150.0]
    assert curves.frequencies[0].values.tolist() == [row["f1_hz"] for row in rows]
    assert [*curves.frequencies[0].words] == [row["mode1"] for row in rows]


def test_words_vary_as_numbers_do(tmp_path):
    vary = [
        'gear.bearing.D.catalogue.designation=6210,6310,"6010"',
        "gear.bearing.D.catalogue.load_rating=37 kN",
        "pinion.loaded_side=left,right",
    ]
    _, rows = swept(GEARBOX, vary, tmp_path / "rows.csv", ask=AT_REST)
    assert [row["gear.bearing.D.catalogue.designation"] for row in rows] == [
        *(6210.0, 6210.0),
        *(6310.0, 6310.0),
        *(6010.0, 6010.0),
    ]
    assert [row["pinion.loaded_side"] for row in rows] == ["left", "right"] * 3
    assert {row["status"] for row in rows} == {"ok"}
    # another flank pushes the axis the other way; a bearing of another series is another spring
    axial = [row["pinion.B.axial"] for row in rows]
    assert axial[0] * axial[1] < 0
    assert len({row["misalignment_in_plane"] for row in rows}) == 6


def test_a_file_of_a_shaft_varies_and_its_entries_go_by_their_names(tmp_path):
    path = by_hand(tmp_path, AXLE)
    other = (tmp_path / "gear_shaft.toml").read_text()
    # the same segments in another order of numbers
    split = other.replace(
        'name = "shaft"',
        'name = "hub"\nlength = "1 mm"\ndiameter = "120 mm"\n\n'
        '[[segment]]\nkind = "cylinder"\nname = "shaft"',
    ).replace('length = "111 mm"', 'length = "110 mm"')
    (tmp_path / "hub.toml").write_text(split)
    vary = ["gear.scene=gear_shaft.toml,hub.toml", "gear.segment.shaft.diameter=120 mm,100 mm"]
    _, rows = swept(path, vary, tmp_path / "rows.csv", ask=MODES)
    assert {row["status"] for row in rows} == {"ok"}
    first = [row["f3_hz"] for row in rows]
    # a cut through a cylinder changes nothing; where its other half keeps 120 mm, next to nothing
    assert first[0] == pytest.approx(first[2], rel=1e-5)
    assert first[1] == pytest.approx(first[3], rel=3e-2) and first[0] > 1.005 * first[1]


# ---------------------------------------------------------------------------- what is not done again
NOT_OF_THE_BODY = (
    "mesh.stiffness=2e8 N/m,3e8 N/m",
    "mesh.pressure_angle=20 deg,25 deg",
    "losses.mesh=0.1,0.2",
    "engine.spring.stiffness=1e4 N*m/rad,2e4 N*m/rad",
    "pinion.bearing.1.stiffness.kyy=8e8 N/m,9e8 N/m",
)


@pytest.mark.long
def test_what_is_no_part_of_a_body_makes_none(tmp_path):
    found, rows, bodies = counted(AXLE, NOT_OF_THE_BODY, tmp_path / "rows.csv")
    assert (found.total, bodies) == (32, 2)
    assert len({row["peak1_force"] for row in rows}) > 8
    moved = [*NOT_OF_THE_BODY[:1], "pinion.bearing.2.position=140 mm,145 mm,150 mm"]
    found, _, bodies = counted(AXLE, moved, tmp_path / "moved.csv")
    assert (found.total, bodies) == (6, 3 + 1)


def test_torques_make_a_body_of_each_shaft_for_each_model_of_it(tmp_path):
    vary = ["operation.full.torque=20 N*m:200 N*m:4"]
    how = {"pinion": "euler", "gear": "lumped/euler", "ask": AT_REST}
    found, rows, bodies = counted(GEARBOX, vary, tmp_path / "rows.csv", **how)
    # loads of bearings are those of the models that are named
    assert (found.total, bodies) == (4, 2)
    assert [row["pinion.B.radial"] for row in rows] == sorted(r["pinion.B.radial"] for r in rows)


def test_harmonics_at_the_teeth_are_found_once_for_a_mesh_point(tmp_path, monkeypatch):
    made, teeth = [], train_assembly.local_teeth
    monkeypatch.setattr(train_assembly, "local_teeth", lambda *of: made.append(of[0]) or teeth(*of))
    coarse = {(side, "harmonic"): {"order": 2, "layers": 0} for side in ("pinion", "gear")}
    how = {"pinion": "harmonic", "gear": "harmonic", "settings": coarse, "local_harmonics": (2,)}
    vary = ["pinion.pitch_radius=67 mm,66 mm", "mesh.stiffness=2e8 N/m,3e8 N/m"]
    _, rows = swept(AXLE, vary, tmp_path / "rows.csv", ask=MODES, **how)
    assert made == 2 * ["pinion", "gear"]
    # and they are those of the point: the second radius as in a assembly of its own
    path = by_hand(
        tmp_path, AXLE, ("axle_overhung.toml", 'pitch_radius = "67 mm"', 'pitch_radius = "66 mm"')
    )
    train = sg.load_train(path)
    mesh = train.mesh.with_changes(local_harmonics=(2,), stiffness=3e8)
    assembly = Assembly(train.with_changes(mesh=mesh), settings=coarse)
    (first, *_) = [
        hz for hz in assembly.system("harmonic", "harmonic").modes(4).frequency_hz if hz > 60
    ]
    assert rows[3]["f3_hz"] == pytest.approx(first, rel=1e-9)
    assert rows[1]["f3_hz"] != pytest.approx(first, rel=1e-6)


# ------------------------------------------------------------------------------------- what is refused
def test_a_refused_variant_says_why_and_the_others_are_solved(tmp_path):
    vary = ["pinion.bearing.2.position=150 mm,175 mm,900 mm", "losses.mesh=0.1,3"]
    found, rows = swept(AXLE, vary, tmp_path / "rows.csv", ask=MODES)
    assert found.refused == 5 and rows[1]["status"] in found.whys
    assert rows[0]["status"] == "ok" and rows[0]["f1_hz"] > 0
    assert "losses.mesh = 3: a loss factor lies between 0 and 1" in rows[1]["status"]
    for row in rows[2:]:
        assert "inside the shaft" in row["status"] and row["f1_hz"] == "" == row["modes"]


def test_a_load_is_held_against_the_torque_of_its_own_variant(tmp_path):
    """Whatever was solved before: the [load] of the wheel's scene is the mesh force at 115 N m."""
    path = by_hand(
        tmp_path,
        GEARBOX,
        ("gearbox_train.toml", 'scene_load = "replaced"\nteeth = 57', "teeth = 57"),
    )
    vary = ["operation.full.torque=115 N*m,300 N*m"]
    _, rows = swept(path, vary, tmp_path / "rows.csv", ask=AT_REST)
    assert rows[0]["status"] == "ok"
    assert "the [load] of the gear's scene is" in rows[1]["status"]


def test_a_variant_without_equilibrium_is_refused_as_well(tmp_path):
    """A bearing that holds one way only is pushed out of by the other flank."""
    path = by_hand(
        tmp_path,
        GEARBOX,
        (
            "gearbox_catalogue.toml",
            'arrangement = "back_to_back"',
            'arrangement = "single"\nholds = "+y"',
        ),
    )
    vary = ["operation.full.torque=100 N*m,-100 N*m"]
    _, rows = swept(path, vary, tmp_path / "rows.csv", ask=AT_REST)
    assert sorted(row["status"] == "ok" for row in rows) == [False, True]
    (why,) = (row["status"] for row in rows if row["status"] != "ok")
    assert "pushed out of its bearings" in why


@pytest.mark.parametrize(
    "vary, says",
    [
        ("mesh.stifness=1,2", 'unknown key; did you mean "mesh.stiffness"?'),
        ("pinion.bearings.1.position=1,2", 'did you mean "pinion.bearing.1.position"?'),
        ("pinion.bearing.2.positon=1 mm:2 mm:3", 'did you mean "pinion.bearing.2.position"?'),
        ("pinion.bearing.9.position=1,2", "there is no bearing.9; there are 1, 2"),
        ("pinion.bearing.1.seat_width=10 N,20 N", '"N" is not a unit of length'),
        ("mesh.stiffness=1 N/m:2 furlong/N2:3", "is not a known unit"),
        ("mesh.stiffness=1 N/m:2:3", "give both ends with a unit, or none"),
        ("mesh.stiffness=1:2", 'values are "a:b:n"'),
        ("mesh=1", "mesh: is no single entry; add one of shaft_angle"),
        ("mesh.stiffness.kxx=1", "which has no kxx"),
        ("mesh.stiffness", "write PATH=VALUES"),
        ("bearing.1.position=1,2", "pinion.bearing.1.position or gear.bearing.1.position"),
        ("pinion.pitch_radius=300 mm,400 mm", "no variant can be solved; the first one is"),
        ("gear.teeth=44.5", "gear.teeth = 44.5: must be a whole number"),
    ],
)
def test_what_no_variant_can_have_is_refused_at_once(vary, says, tmp_path):
    with pytest.raises(SolidgearError) as caught:
        swept(AXLE, [vary], tmp_path / "rows.csv")
    assert says in str(caught.value) and len(str(caught.value).splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_the_same_entry_twice_is_refused_by_whatever_name(tmp_path):
    vary = ["pinion.bearing.2.position=150 mm", "pinion.bearing.2.position=140 mm"]
    with pytest.raises(SolidgearError, match="is varied already"):
        swept(AXLE, vary, tmp_path / "rows.csv")
    point = ["operation.full.torque=1", "operation.1.torque=2"]
    with pytest.raises(SolidgearError, match="operation.full.torque is varied already"):
        swept(GEARBOX, point, tmp_path / "rows.csv")


# ----------------------------------------------------------------------------------------- stops
VARY = ["mesh.stiffness=2e8 N/m:3e8 N/m:3", "pinion.bearing.2.position=150 mm,140 mm"]


def test_a_stopped_sweep_goes_on_and_gives_the_same_digits(tmp_path):
    whole, _ = swept(AXLE, VARY, tmp_path / "whole.csv")

    def stop(done, total, text):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        swept(AXLE, VARY, tmp_path / "rows.csv", progress=stop)
    assert len(numbers(tmp_path / "rows.csv")) == 2
    rest, _ = swept(AXLE, VARY, tmp_path / "rows.csv")
    assert (rest.skipped, rest.total) == (2, whole.total) == (2, 6)
    assert (tmp_path / "rows.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()
    again, _, bodies = counted(AXLE, VARY, tmp_path / "rows.csv")
    assert (again.skipped, bodies) == (6, 0)
    for other in ({"gear": "euler"}, {"max_frequency": 1400.0}, {"ask": MODES}):
        with pytest.raises(SolidgearError, match=r"another sweep .*`overwrite`"):
            swept(AXLE, VARY, tmp_path / "rows.csv", **other)


@pytest.mark.long
def test_two_processes_give_the_rows_of_one(tmp_path):
    pytest.importorskip("joblib")
    swept(AXLE, VARY, tmp_path / "one.csv", ask=MODES)
    swept(AXLE, VARY, tmp_path / "two.csv", ask=MODES, jobs=2)
    assert (tmp_path / "one.csv").read_bytes() == (tmp_path / "two.csv").read_bytes()


# ------------------------------------------------------------------------------------ paths of a scene
def test_entries_of_a_scene_go_by_their_paths_as_those_of_a_train_do():
    tables = parse(str(GEOMETRY / "gearbox_catalogue.toml"))
    for path, label in {
        "segment.2.length": "segment.pinion.length",
        "segment.pinion.length": "segment.pinion.length",
        "bearing.A.catalogue.designation": "bearing.A.catalogue.designation",
        "bearing.B.catalogue.conformity.2": "bearing.B.catalogue.conformity.2",
        "load.x": "load.x",
        "port.pinion.at": "port.at",
        "port.position": "port.position",
        "material.E": "material.E",
    }.items():
        assert label_of(keys_of(path, tables), tables) == label
    wider = with_entry(tables, keys_of("bearing.A.seat_width", tables), "20 mm")
    assert [one.get("seat_width") for one in wider["bearing"]] == ["20 mm", "36 mm"]
    assert tables["bearing"][0]["seat_width"] == "17 mm"


# ------------------------------------------------------------------------------------- the command
def call(tmp_path, *words):
    beams = ("--pinion", "timoshenko", "--gear", "timoshenko")
    return command("sweep", *words, *beams, "--out", tmp_path / "rows.csv")


@pytest.mark.long
def test_the_command_draws_curves_over_one_number(tmp_path):
    vary = ("--vary", "operation.full.torque=20 N*m:100 N*m:3")
    for ending, said in (
        ("svg", "2 shafts meshed and reduced"),
        ("html", "all 3 rows were there already"),
    ):
        chart = tmp_path / f"curves.{ending}"
        done = call(tmp_path, GEARBOX, *vary, "--chart", chart)
        assert done.exit_code == 0, done.output
        assert said in " ".join(done.stdout.split())  # a long folder wraps the line
        drawn = chart.read_text()
        assert "operation.full.torque, N*m" in drawn and "radial load of bearings in N" in drawn
        # words on every place of a curve, in the unit that was asked in
        assert "operation.full.torque: 60 N*m" in drawn and "gear bending 1" in drawn
        (row,) = (r for r in numbers(tmp_path / "rows.csv") if r["operation.full.torque"] == 60)
        assert "mesh force" in done.stdout and f"{row['mesh_force']:.4g}" in done.stdout


def test_the_command_refuses_what_it_cannot_draw_before_anything_is_solved(tmp_path, monkeypatch):
    monkeypatch.setattr(file_task, "RowFile", None)
    two = ("--vary", "mesh.stiffness=1e8,2e8", "--vary", "losses.mesh=0.1,0.2")
    for words, says in (
        ((*two, "--chart", "a.png"), "here vary mesh.stiffness, losses.mesh"),
        (("--vary", "pinion.loaded_side=concave,convex", "--chart", "a.png"), "varies by words"),
        ((*two, "--chart", "a.pdf"), "give a picture a name that ends in"),
        ((*two, "--ask", "modes"), "give one or more of system-modes, response, deflect"),
        ((*two, "--model", "euler"), "its models are those of --pinion and --gear"),
        ((*two, "--every-point"), "the file has no operating point"),
        ((*two, "--point", "full"), "axle_overhung has no operating point"),
        ((), "nothing is varied"),
    ):
        done = call(tmp_path, AXLE, *words)
        assert done.exit_code == 1 and says in str(done.exception), words
    shaft = command("sweep", GEOMETRY / "pinion_overhung.toml", "--every-point")
    assert "--every-point is for a train" in str(shaft.exception)


def test_the_command_ends_with_an_error_where_no_variant_finds_its_rest(tmp_path):
    done = call(
        tmp_path, AXLE, "--vary", "mesh.stiffness=2e8,3e8", "--max-frequency", "9e5", "--json"
    )
    told = json.loads(done.stdout)
    assert done.exit_code == 1 and told["refused"] == told["total"] == 2
    assert "beyond the reduction" in "".join(told["whys"])
