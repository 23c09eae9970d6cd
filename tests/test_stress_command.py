"""Stress of scenes and trains at rest, from the command line: loads, tables, JSON, page, refusals."""

import functools
import html
import json
import re
from math import pi
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.scene.closed_form import mass_properties
from solidgear.core.scene.gravity import GRAVITY
from solidgear.cuts.features import RingGroove
from solidgear.strength.load import driven
from solidgear.strength.stress import shaft
from solidgear.strength.stress.at_rest import StressSettings, stress_at_rest
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.sheet import shaft_tables
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint

GEOMETRY = Path(__file__).parent.parent / "geometry"
FILLETED = GEOMETRY / "pinion_filleted.toml"
GEARBOX = GEOMETRY / "gearbox_train.toml"
#: beams find the same reactions where statics alone give them, and a coarse bar is met sooner
QUICK = ("-f", "timoshenko", "--tol", "0.05")

SHAFT = """
title = "Output shaft"
segment = [
  { kind = "cylinder", name = "left", length = "90 mm", diameter = "40 mm" },
  { kind = "cylinder", name = "wheel", length = "150 mm", diameter = "60 mm" },
]
feature = [{ kind = "fillet", name = "root", at = "left.end", radius = "4 mm" }]
port = { name = "gear", position = "180 mm", span = ["170 mm", "190 mm"] }
load = { x = "6 kN", y = "1.5 kN" }

[material]
E = "207 GPa"
nu = 0.3
density = "7850 kg/m^3"
strength = { yield_point = "700 MPa", ultimate = "1000 MPa" }

[[bearing]]
name = "A"
position = "20 mm"
seat_width = "20 mm"
[bearing.catalogue]
kind = "angular_contact"
designation = "7208 B"
arrangement = "back_to_back"
preload = "500 N"
load_rating = "34.5 kN"

[[bearing]]
name = "B"
position = "220 mm"
seat_width = "20 mm"
catalogue = { designation = "NU 212", load_rating = "110 kN" }
"""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("stress") / "output.toml"
    path.write_text(SHAFT)
    return path


def stress_of(scene, **how):
    """Stress of a shaft under the load of its scene."""
    return stress_at_rest(Assembly.of(scene), model="timoshenko", **how)


def total(loads, places):
    """Sum (6,) of loads about the origin."""
    out = np.zeros(6)
    for name, six in loads.items():
        force, moment = np.array(six[:3]), np.array(six[3:])
        out += np.r_[force, moment + np.cross([0.0, places[name], 0.0], force)]
    return out


# ----------------------------------------------------------------------- a shaft
def test_the_bending_moment_is_force_times_arm_and_the_tables_are_the_json(run):
    how = ("stress", FILLETED, "--load", "z=10 kN", "--drive", "2=300 N*m", *QUICK)
    data, said = json.loads(run(*how, "--json")[1]), run(*how)[1]
    scene = sg.load(FILLETED)
    (notch,) = data["shafts"]["pinion_filleted"]["found"]["notches"]
    fillet = scene.segments[-1].y0 + 0.004
    moment = 10e3 * (fillet - scene.port.y)
    six = dict(zip(data["components"], notch["forces"]))
    assert np.hypot(six["M_x"], six["M_z"]) == pytest.approx(moment, rel=1e-12)
    assert notch["nominal"]["bending"] == pytest.approx(32 * moment / (pi * 0.09**3), rel=1e-12)
    assert notch["nominal"]["torsion"] == pytest.approx(16 * 300 / (pi * 0.09**3), rel=1e-12)
    factors, local = notch["found"]["factors"], notch["local"]
    rows = [line.split() for line in said.splitlines() if line.startswith(" head fillet")]
    stress, form = ([row[2:] for row in rows if row[2] == "bending"][k] for k in (0, 1))
    nominal, surface, bar = (float(word) for word in stress[1:4])
    assert nominal == pytest.approx(notch["nominal"]["bending"] / 1e6, rel=5e-4)
    assert surface == pytest.approx(local["amplitude"] / 1e6, rel=5e-4)
    assert bar == pytest.approx(local["amplitude_bar"] / 1e6, rel=0.05)
    assert float(form[1]) == pytest.approx(factors["bending"]["value"], rel=5e-4)
    assert "thy 300.0 N m at 2" in " ".join(said.split())
    assert 'the material of "shaft" has no strength; write strength' in said


def test_a_shaft_without_torque_says_so(run):
    data = json.loads(run("stress", FILLETED, "--load", "z=10 kN", *QUICK, "--json")[1])
    (caution,) = data["cautions"]
    assert caution.startswith("no torque runs along the shaft") and "--drive" in caution


def test_points_where_nothing_acts_are_told():
    scene = sg.load(GEOMETRY / "intermediate_shaft.toml").with_changes(load={"x": 100.0})
    found = stress_of(driven(scene, {"pinion": 50.0}))
    assert found.cautions == ()
    bare = stress_of(scene).cautions
    assert any(c.startswith('nothing acts at the point "pinion"') for c in bare)


def test_what_is_cut_into_a_shaft_is_a_notch_without_a_rating_where_strength_is_missing():
    scene = sg.load(GEOMETRY / "pinion_keyed.toml").with_changes(load={"z": 1e3})
    (one,) = stress_of(scene).shafts
    assert [(d.kind, d.rating) for d in one.found.drawn] == [("keyway", None)]
    assert one.weak == (one.found.drawn[0].segment,)
    assert one.found.forces.largest_moment > 0


@pytest.mark.long
def test_what_bearings_leave_open_moves_moment_and_stress(file):
    scene = sg.load(file)
    found = stress_of(scene, asked=StressSettings(0.05))
    (one,) = found.shafts
    (notch,) = one.found.notches
    low, high = one.open["root"]
    assert 0.9 * high < low < high and low <= notch.local.amplitude <= high
    assert one.open_moment[0] <= one.found.forces.largest_moment <= one.open_moment[1]
    assert found.open_by == "estimated insides"
    known = stress_of(sg.load(FILLETED).with_changes(load={"z": 1e3}), asked=StressSettings(0.05))
    assert known.shafts[0].open == {} and known.shafts[0].open_moment is None


def test_what_bearings_leave_open_moves_the_least_safety(file):
    ring = RingGroove(name="ring", segment="left", y=0.06, width=2e-3, depth=1.5e-3)
    scene = sg.load(file).with_changes(blends=(), features=(ring,))
    (one,) = stress_of(scene).shafts
    low, high = one.open_safety
    assert 0.9 * high < low < high and low <= one.found.worst[0].rating.worst <= high


def test_stress_by_shear_that_no_rating_holds_is_told(file):
    """Of a moment of 1 / 20 of the force times the diameter, shear makes most of the stress."""
    scene = sg.load(file)
    a, b = (bearing.y for bearing in scene.bearings)
    force, arm = 1e4, 0.086 - a  # to where the fillet meets its cylinder
    first = -force * arm - 20.0
    near = {
        "A": [force, 0, 0, 0, 0, first],
        "B": [-force, 0, 0, 0, 0, -force * (b - a) - first],
    }
    (notch,) = shaft.shaft_stress(scene, near, tolerance=0.05).notches
    assert abs(notch.forces[5]) == pytest.approx(20.0, rel=1e-9)
    bent = notch.found.factors["bending"].value * notch.nominal.bending
    share = 100 * (notch.local.amplitude / bent - 1)
    assert share > 50
    assert f"its amplitude is {share:.0f} % above Kt times nominal bending" in notch.remark


# ----------------------------------------------------------------------- a train
@pytest.mark.parametrize(
    ("name", "direction"),
    [
        ("axle_straddle", None),
        pytest.param("axle_straddle", "x", marks=pytest.mark.long),
        pytest.param("gearbox_train", "-z", marks=pytest.mark.long),
        *(pytest.param("gearbox_train", way, marks=pytest.mark.slow) for way in (None, "x")),
    ],
)
def test_both_shafts_of_a_train_balance(name, direction):
    """Teeth, springs, bearings, weight of shaft and wheel, each shaft in axes of its own."""
    point = OperatingPoint(torque=115.0, **({"weight": direction} if direction else {}))
    train = sg.load_train(GEOMETRY / f"{name}.toml", point)
    found = stress_at_rest(Assembly(train), point, "timoshenko")
    for one in found.shafts:
        places = {station.name: station.y for station in one.scene.stations}
        left = total(one.acting.loads, places)
        if direction:
            assert np.linalg.norm(one.acting.gravity) == pytest.approx(GRAVITY, rel=1e-12)
            mass = mass_properties(one.scene.outline)
            at_middle = {"shaft": [*(mass.mass * one.acting.gravity), 0, 0, 0]}
            left += total(at_middle, {"shaft": mass.centre})
        size = sum(np.linalg.norm(six[:3]) for six in one.acting.loads.values())
        assert np.abs(left).max() < 1e-9 * size, one.name


def test_torque_runs_from_the_spring_to_the_teeth(run):
    data = json.loads(run("stress", GEARBOX, "--torque", "80 N*m", *QUICK, "--json")[1])
    assert data["under"]["mesh_force"] == pytest.approx(80 / 115 * 4223.3, rel=1e-4)
    torques = {}
    for side, one in data["shafts"].items():
        table = np.array(one["found"]["forces"]["right"])
        torques[side] = set(np.abs(table[:, 4]).round(9)) - {0.0}
    assert torques == {"pinion": {80.0}, "gear": {228.0}}  # 57 teeth over 20


def test_a_spring_at_the_teeth_leaves_no_torque_and_that_is_told():
    train = sg.load_train(GEOMETRY / "axle_straddle.toml")
    found = stress_at_rest(Assembly(train), OperatingPoint(torque=100.0), "timoshenko")
    assert sum("no torque runs along the" in caution for caution in found.cautions) == 2
    assert not any(one.found.forces.right[:, 4].any() for one in found.shafts)


@pytest.mark.long
def test_weight_is_spread_along_the_shafts_of_a_train():
    point = OperatingPoint(torque=115.0, weight="-z")
    found = stress_at_rest(Assembly(sg.load_train(GEARBOX, point)), point, "timoshenko")
    for stressed in found.shafts:
        table = shaft_tables(found, stressed)[0]
        assert "Weight is spread" in table.note
        mass = mass_properties(stressed.scene.outline)
        free = stressed.found.forces.spread.between(0.0, stressed.scene.length, about=0.0)
        assert np.linalg.norm(free[:3]) == pytest.approx(9.80665 * mass.mass, rel=1e-12)


# ----------------------------------------------------------------------- page and files
@pytest.mark.long
def test_the_page_holds_every_number_of_the_worst_fillet(run, file, tmp_path):
    out = tmp_path / "out"
    code, said, _ = run(
        *("stress", file, *QUICK, "--roughness", "6.3 um", "--torque-share", "0.1"),
        *("--drive", "A=200 N*m", "--out", out),
    )
    assert code == 0 and "Safety by DIN 743" in said
    data = json.loads((out / "stress.json").read_text())
    assert data["asked"]["conditions"]["roughness"] == pytest.approx(6.3e-6)
    (notch,) = data["shafts"]["output"]["found"]["notches"]
    assert notch["name"] == data["shafts"]["output"]["worst"] == "root"
    page = html.unescape(
        re.sub(r"<svg.*?</svg>", "", (out / "stress.html").read_text(), flags=re.S)
    )
    shown = [float(word) for word in re.findall(r"(?<=[> ])-?\d+(?:\.\d+)?(?=[< ])", page)]

    def told(value, scale=1.0, digits=5e-3):
        return any(abs(one - scale * value) <= digits * abs(scale * value) for one in shown)

    for load in ("tension", "bending", "torsion"):
        factor = notch["found"]["factors"][load]
        assert told(factor["value"]) and told(factor["bar"] / factor["value"], 100, 0.05)
        assert told(notch["nominal"][load], 1e-6)
    for name in ("amplitude", "mean", "shear"):
        assert told(notch["local"][name], 1e-6) and told(notch["local"][f"{name}_bar"], 1e-6, 0.05)
    scale = {"Pa": 1e-6, "1/m": 1e-3, "": 1.0}
    for entry in notch["rating"]["entries"]:
        assert entry["source"] in page
        assert all(told(v, scale[entry["unit"]]) for v in entry["values"] if v is not None)
    for key in ("fatigue", "yielding"):
        assert told(notch["rating"][key])
    assert (out / "section_forces_output.csv").exists()
    assert (out / "section_forces_output.png").exists()


@pytest.mark.long
def test_a_rating_follows_what_is_given(file):
    scene = sg.load(file)
    usual, rough = (
        stress_of(scene, asked=StressSettings(0.05, conditions)).shafts[0].found.worst[0]
        for conditions in (Conditions(), Conditions(roughness="25 um"))
    )
    assert rough.rating.fatigue < usual.rating.fatigue
    assert "K_F" in usual.rating.assumed and "K_F" not in rough.rating.assumed


def test_a_tolerance_that_is_not_reached_ends_with_its_code(run, monkeypatch):
    short = functools.partial(shaft.fillet_factors, orders=(4, 5))
    monkeypatch.setattr(shaft, "fillet_factors", short)
    how = ("stress", FILLETED, "--load", "z=10 kN", "-f", "timoshenko", "--tol", "0.003")
    code, said, _ = run(*how)
    assert code == 3 and "above the 0.3 % asked for" in " ".join(said.split())


# ----------------------------------------------------------------------- refusals
@pytest.mark.parametrize(
    "words, says",
    [
        ([FILLETED], "there is no load; write [load] with forces at the port"),
        ([FILLETED, "--torque", "3 N*m"], "--torque is for a train"),
        ([GEARBOX, "--load", "z=1 kN"], "--load is for a shaft"),
        ([GEARBOX, "--drive", "A=3 N*m"], "--drive is for a shaft"),
        ([FILLETED, "--load", "z=1 kN", "--drive", "pinion=3 N*m"], "enters where the gear takes"),
        (
            [FILLETED, "--load", "z=1 kN", "--drive", "C=3 N*m"],
            "the shaft has no such place",
        ),
        ([FILLETED, "--load", "z=1 kN", "--drive", "2=3 N"], '"N" is not a unit of torque'),
        ([FILLETED, "--load", "z=1 kN", "--drive", "2"], "write NAME=TORQUE"),
        ([FILLETED, "--load", "z=1 kN", "--roughness", "6"], '--roughness "6": has no unit'),
        (
            [FILLETED, "--load", "z=1 kN", "--tol", "1e-6"],
            "give a relative error bar of form factors from",
        ),
        ([GEOMETRY / "cylinder_free.toml", "--load", "z=1 kN"], "it has no bearing"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence_and_nothing_is_written(run, tmp_path, words, says):
    out = tmp_path / "none"
    code, said, refused = run("-q", "stress", *words, "-f", "timoshenko", "--out", out)
    assert code == 1 and said == "" and says in refused
    assert len(refused.strip().splitlines()) == 1
    assert not out.exists()
