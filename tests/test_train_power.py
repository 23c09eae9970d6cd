"""Torques that divide among engines, loads and loops of meshes, against statics by hand."""

from math import asin, cos, radians, sin

import numpy as np
import pytest

import solidgear as sg
from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.motion import steady_motion
from solidgear.backlash.train import backlash_model, teeth_of
from solidgear.core.errors import SceneError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.load.contact import axes_of
from solidgear.trains.load.operation import Operating
from tests.test_train_many import BEARING, PRESSURE, SHAFTS, scene_text, written

LOAD = '[load]\nshaft = "output"\ninertia = 2.5\n[load.spring]\nstiffness = 90000.0\nat = "b1"\n'
ENGINE = LOAD.replace("load", "engine").replace("output", "input")
ENGINE = ENGINE.replace("2.5", "0.03").replace("90000.0", "4000.0")


def named(table, name, shaft, share):
    """Table of one of several engines or loads."""
    kind = table[1 : table.index("]")]
    text = table.replace(f"[{kind}]", f"[{kind}.{name}]\nshare = {share}")
    text = text.replace(f"[{kind}.spring]", f"[{kind}.{name}.spring]")
    return text.replace('"output"', f'"{shaft}"').replace('"input"', f'"{shaft}"')


TWO_LOADS = (LOAD, named(LOAD, "end", "output", 0.6) + named(LOAD, "side", "middle", 0.4))
TWO_ENGINES = (
    ENGINE,
    named(ENGINE, "first", "input", 0.3) + named(ENGINE, "second", "middle", 0.7),
)


def in_balance(state, shafts):
    """Forces on every shaft add up to nothing, moments about the start of its scene included."""
    acting, largest = {side: np.zeros(6) for side in shafts}, max(state.mesh_forces.values())
    for end, six in state.forces().items():
        side, _, port = end.partition(".")
        if side in acting:
            own = getattr(state.system.parts[side], "part", state.system.parts[side])
            acting[side] += np.r_[six[:3], six[3:] + np.cross(own.ports[port].point, six[:3])]
    return all(np.abs(six).max() < 1e-10 * largest for six in acting.values())


#: what is told of 100 N m on a shaft: how much of the engine's whole torque that makes on the input
SPLIT = {
    "two loads": (TWO_LOADS, "input", 100.0),
    "two loads, told of one": (TWO_LOADS, "output", 100.0 / 0.6 / (57 / 20 * 55 / 18)),
    "two loads, told of what both pass": (TWO_LOADS, "middle", 100.0 / (57 / 20)),
    "two engines": (TWO_ENGINES, "input", 100.0 / 0.3),
    "two engines, coasting": (TWO_ENGINES, "middle", 100.0 / (57 / 20)),
}


@pytest.mark.parametrize(("tables", "of", "whole"), SPLIT.values(), ids=SPLIT)
def test_a_torque_divides_by_the_shares_of_the_power(tmp_path, tables, of, whole):
    """Levers of the teeth are pitch radii times cosines of pressure and helix angle."""
    train = sg.load_train(written(tmp_path, tables))
    loads = tables is TWO_LOADS
    sign = -1.0 if of == "middle" and not loads else 1.0
    point = train.with_changes(operation=({"torque": sign * 100.0, "of": of},)).operation[0]
    state = Operating(Assembly(train), "timoshenko").at(point)
    first, second = (1.0, 0.6) if loads else (0.3, 1.0)
    teeth = (
        first * whole / (0.03 * cos(PRESSURE) * cos(radians(15))),
        second * whole * 57 / 20 / (0.036 * cos(PRESSURE) * cos(radians(12))),
    )
    assert [*state.mesh_forces.values()] == pytest.approx(teeth, rel=1e-10)
    torque = {name: six[4] for name, six in state.outside.items()}
    if loads:
        by_hand = {"engine": 1.0, "end": 0.6 * 57 / 20 * 55 / 18, "side": 0.4 * 57 / 20}
    else:
        by_hand = {"first": 0.3, "second": 0.7 * 57 / 20, "load": 57 / 20 * 55 / 18}
    assert {name: abs(t) for name, t in torque.items()} == pytest.approx(
        {name: share * whole for name, share in by_hand.items()}, rel=1e-10
    )
    # the middle turns against the other two
    with_it = (
        {"engine": 1, "end": -1, "side": 1} if loads else {"first": 1, "second": -1, "load": -1}
    )
    first = next(iter(torque.values()))
    assert {name: np.sign(t / first) for name, t in torque.items()} == with_it
    assert in_balance(state, SHAFTS)


IDLER = 31
TEETH = {"input": 20, "left": IDLER, "right": IDLER, "output": 40}
MODULE, AWAY = 0.003, radians(50)
STIFF = {"input-left": 2e8, "input-right": 3e8, "left-output": 2.5e8, "right-output": 4e8}


def looped(folder, bearing, *changes):
    """Two idlers side by side between two wheels: spur gears, equal scenes."""
    for name in TEETH:
        (folder / f"{name}.toml").write_text(scene_text("input", bearing))
    text = ""
    for side, teeth in TEETH.items():
        text += f'[shaft.{side}]\nscene = "{side}.toml"\nteeth = {teeth}\nface_width = 0.03\n'
        text += f"pitch_radius = {MODULE * teeth / 2}\nspiral_angle = 0\n"
        text += 'loaded_side = "left"\n' * (side == "input")
    # heights of the idlers over the line of both wheels are the same from either side
    back = asin(sin(AWAY) * (TEETH["input"] + IDLER) / (TEETH["output"] + IDLER))
    azimuth = {"input-left": AWAY, "input-right": -AWAY, "left-output": -back, "right-output": back}
    for name, stiffness in STIFF.items():
        one, two = name.split("-")
        text += (
            f'[[mesh]]\nbetween = ["{one}", "{two}"]\nshaft_angle = 0\nstiffness = {stiffness}\n'
        )
        text += f"azimuth = {azimuth[name]}\npressure_angle = {PRESSURE}\n"
        text += "transmission_error = 1e-6\n"
    text += ENGINE + LOAD
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    (folder / "train.toml").write_text(text)
    return sg.load_train(folder / "train.toml")


def test_a_loop_of_meshes_divides_the_torque_by_its_stiffness(tmp_path):
    """Rigid shafts that only turn: teeth of a path one after the other, both paths side by side.
    Bearings give a share of the stiffness of teeth over theirs, 4e-7.
    """
    train = looped(tmp_path, [1e15, 1e15, 1e15, 1e11, 0.0, 1e11])
    point = train.with_changes(operation=({"torque": 100.0},)).operation[0]
    state = Operating(Assembly(train), "rigid/timoshenko").at(point)
    paths = [
        1 / (1 / STIFF[f"input-{side}"] + 1 / STIFF[f"{side}-output"]) for side in ("left", "right")
    ]
    whole = 100.0 / (MODULE * TEETH["input"] / 2 * cos(PRESSURE))
    left, right = (whole * path / sum(paths) for path in paths)
    forces = {name.removeprefix("mesh "): force for name, force in state.mesh_forces.items()}
    by_hand = {"input-left": left, "left-output": left, "input-right": right, "right-output": right}
    assert forces == pytest.approx(by_hand, rel=1e-6)
    # driven by the load's torque and told of its shaft it is the same
    other = point.with_changes(torque=200.0, of="output")
    assert Operating(Assembly(train), "rigid/timoshenko").at(other).mesh_forces == pytest.approx(
        state.mesh_forces, rel=1e-9
    )


def test_shafts_of_a_loop_are_in_balance_on_their_own_bearings(tmp_path):
    train = looped(tmp_path, BEARING)
    state = Operating(Assembly(train), "timoshenko").at(
        train.with_changes(operation=({"torque": 100.0},)).operation[0]
    )
    assert in_balance(state, TEETH) and any("divide the torque" in note for note in state.notes)
    whole = 100.0 / (MODULE * TEETH["input"] / 2 * cos(PRESSURE))
    both = [state.mesh_forces[f"mesh input-{side}"] for side in ("left", "right")]
    assert sum(both) == pytest.approx(whole, rel=1e-10)
    engine, load = (state.outside[name][4] for name in ("engine", "load"))
    assert abs(engine) == pytest.approx(100.0, rel=1e-10) and load / engine == pytest.approx(-2.0)


def test_a_triangle_of_wheels_is_refused_for_it_cannot_turn(tmp_path):
    """Each turns against its neighbours, and three cannot."""
    train = looped(tmp_path, BEARING)
    between = [("input", "left"), ("left", "output"), ("input", "output")]
    side = [(TEETH[a] + TEETH[b]) * MODULE / 2 for a, b in between]
    at_input = np.arccos((side[0] ** 2 + side[2] ** 2 - side[1] ** 2) / (2 * side[0] * side[2]))
    at_output = np.arccos((side[1] ** 2 + side[2] ** 2 - side[0] ** 2) / (2 * side[1] * side[2]))
    meshes = [
        train.meshes[0].with_changes(between=both, azimuth=angle)
        for both, angle in zip(between, (at_input, -at_output, 0.0))
    ]
    shafts = {s: train.shafts[s] for s in ("input", "left", "output")}
    with pytest.raises(SceneError, match="turn the .* the other way: the loop cannot turn"):
        Assembly(train.with_changes(shafts=shafts, meshes=tuple(meshes)))


def test_a_line_of_action_that_locks_a_loop_is_refused(tmp_path):
    """A point typed to a millimetre; in a tree such lever arms turn."""
    train = looped(tmp_path, BEARING)
    last, contact = train.pairs[3], [*Assembly(train).contacts.values()][3]
    met = contact.pinion
    turn = axes_of(last, "pinion").T
    given = {"line_of_action": turn @ met.normal, "point": (turn @ met.point).round(3)}
    given["gear_position"] = contact.origin
    typed = last.mesh.with_changes(pressure_angle=None, **{k: tuple(v) for k, v in given.items()})
    with pytest.raises(
        SceneError, match="turn the output by .* % more or less than the other meshes do"
    ):
        Assembly(train.with_changes(meshes=(*train.meshes[:3], typed)))
    Assembly(train.with_changes(meshes=(*train.meshes[:2], typed)))


BAD = {
    "sum": (
        (LOAD, TWO_LOADS[1].replace("0.4", "0.5")),
        "load.end.share = 0.6: the shares of all loads sum to 1.1",
    ),
    "no share": (
        (LOAD, TWO_LOADS[1].replace("share = 0.4\n", "")),
        r"load.side.share.*this key is missing; loads share the power",
    ),
    "share of one": ((LOAD, LOAD.replace("inertia", "share = 0.4\ninertia")), "sum to 0.4"),
    "share of a rotor": (
        (LOAD, LOAD + named(LOAD, "fan", "middle", 0.1).replace("[load.", "[rotor.")),
        "rotor.fan.share = 0.1: is of engines and loads",
    ),
    "spring": (
        (LOAD, TWO_LOADS[1].replace("[load.side.spring]\n", "[losses]\n").split("[losses]")[0]),
        r"torsional spring between the side and the middle's shaft is missing; write \[load.side",
    ),
    "port": (
        (LOAD, TWO_LOADS[1].replace('at = "b1"', 'at = "b9"', 1)),
        'load.end.spring.at = "b9": unknown port',
    ),
    "twice": (
        (LOAD, TWO_LOADS[1].replace("load.side", "load.engine")),
        "load.engine.*an engine or a load is called 'engine' as well",
    ),
    "reserved": (
        (LOAD, TWO_LOADS[1].replace("load.side", "load.modes")),
        "what turns cannot be called 'modes'",
    ),
}


@pytest.mark.parametrize(("change", "reason"), BAD.values(), ids=BAD)
def test_what_cannot_divide_is_refused_by_the_keys_of_the_file(tmp_path, change, reason):
    with pytest.raises(SceneError, match=reason):
        sg.load_train(written(tmp_path, change))


@pytest.mark.long
def test_teeth_of_a_loop_part_as_in_motion_in_time(tmp_path):
    """Both paths carry their share of the mean; only the laws and the modes are shared with what
    integrates.  Harmonics are followed to 1e-4 of the largest stretch, which is more of a small force.
    """
    gap = ("transmission_error = 1e-6\n", 'transmission_error = 1e-5\nbacklash = "40 um"\n')
    assembly = Assembly(looped(tmp_path, BEARING, gap))
    teeth = teeth_of(assembly, 300.0)
    made = backlash_model(assembly, ["timoshenko"], teeth, 2500.0)
    carried = made.mean * np.diag(made.stiffness)
    np.testing.assert_allclose(carried, [one.mean_force for one in teeth.meshes], rtol=1e-9)
    branch = follow(made, 2 * np.pi * 835, 2 * np.pi * 880, step=0.05)
    at = 2 * np.pi * 845.0
    point = branch.at(at)[0]
    steady = steady_motion(made, at, steady=1e-4, state=point.state())
    assert (steady.stretch.min(axis=0) < 20e-6).any() and steady.cycle == 1
    np.testing.assert_allclose(
        np.ptp(steady.force, axis=0), np.ptp(point.forces(), axis=0), rtol=4e-3
    )
