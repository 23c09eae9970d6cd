"""Trains of more than two shafts, against matrices written by hand from textbook forces."""

import json
from math import cos, pi, radians, sin

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.strength.deflection.misalignment import misalignment
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.judge.judge import JUDGE, MIXED, mixes_of
from solidgear.trains.load.operation import Operating
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.drive import Drive
from tests.command import command

DENSITY = 7850.0
#: name: length and diameter of cylinders in turn (m), places of bearings, of gears
SHAFTS = {
    "input": ([(0.16, 0.04)], (0.02, 0.14), {"gear": 0.06}),
    "middle": (
        [(0.05, 0.04), (0.05, 0.17), (0.1, 0.07)],
        (0.02, 0.18),
        {"wheel": 0.075, "pinion": 0.14},
    ),
    "output": ([(0.12, 0.06), (0.06, 0.2), (0.07, 0.06)], (0.02, 0.23), {"gear": 0.15}),
}
#: of both meshes: shafts and gears, teeth, pitch radius of the first, helix and where the second
#: gear lies as seen from the first (rad about y from -x), the sign of the torque on the first
MESHES = (
    (("input", "gear"), ("middle", "wheel"), (20, 57), 0.03, radians(15), 0.0, 1.0, 1.0),
    (("middle", "pinion"), ("output", "gear"), (18, 55), 0.036, radians(12), pi / 2, -1.0, -1.0),
)
STIFFNESS, PRESSURE, ROTORS = (3e8, 4e8), radians(20), {"engine": (0.03, 4e3), "load": (2.5, 9e4)}
BEARING = [8e7, 5e7, 9e7, 2e4, 0.0, 3e4]
WORDS = {1.0: ("right", "left"), -1.0: ("left", "right")}


def scene_text(name, bearing):
    cylinders, bearings, gears = SHAFTS[name]
    out = f'[material]\nE = "206 GPa"\nnu = 0.3\ndensity = {DENSITY}\n'
    for k, (length, diameter) in enumerate(cylinders):
        out += f'[[segment]]\nkind = "cylinder"\nname = "s{k}"\nlength = {length}\ndiameter = {diameter}\n'
    for k, y in enumerate(bearings):
        keys = ("kxx", "kyy", "kzz", "kthx", "kthy", "kthz")
        named = ", ".join(f"{key} = {value}" for key, value in zip(keys, bearing))
        out += f'[[bearing]]\nname = "b{k}"\nposition = {y}\nseat_width = 0.01\nstiffness = {{{named}}}\n'
    for port, y in gears.items():
        out += f'[[port]]\nname = "{port}"\nposition = {y}\nspan = [{y - 0.01}, {y + 0.01}]\n'
    return out


def train_text(changes=()):
    out = ""
    numbers = {}
    for one, two, teeth, radius, helix, _, hand, torque in MESHES:
        own, other = WORDS[hand]
        flank = "left" if torque > 0 else "right"
        numbers[one] = (teeth[0], radius, helix, own, flank)
        numbers[two] = (teeth[1], radius * teeth[1] / teeth[0], helix, other, None)
    for name in SHAFTS:
        gears = {end[1]: found for end, found in numbers.items() if end[0] == name}
        out += f'[shaft.{name}]\nscene = "{name}.toml"\n'
        for port, (teeth, radius, helix, hand, flank) in gears.items():
            out += f"[shaft.{name}.gears.{port}]\n" if len(gears) > 1 else ""
            out += f'teeth = {teeth}\npitch_radius = {radius}\nspiral_angle = {helix}\nhand = "{hand}"\n'
            out += "face_width = 0.03\n" + f'loaded_side = "{flank}"\n' * bool(flank)
    for k, (one, two, _, _, _, azimuth, _, _) in enumerate(MESHES):
        out += f'[[mesh]]\nbetween = ["{".".join(one)}", "{".".join(two)}"]\nshaft_angle = 0\n'
        out += f"azimuth = {azimuth}\nstiffness = {STIFFNESS[k]}\npressure_angle = {PRESSURE}\n"
        out += f'transmission_error = "{k + 1} um"\n'
    for (name, (inertia, spring)), shaft in zip(ROTORS.items(), ("input", "output")):
        out += f'[{name}]\nshaft = "{shaft}"\ninertia = {inertia}\n'
        out += f'[{name}.spring]\nstiffness = {spring}\nat = "b1"\n'
    for old, new in changes:
        assert old in out, old
        out = out.replace(old, new)
    return out


def written(folder, *changes, bearing=BEARING):
    for name in SHAFTS:
        (folder / f"{name}.toml").write_text(scene_text(name, bearing))
    path = folder / "train.toml"
    path.write_text(train_text(changes))
    return path


@pytest.fixture(scope="module")
def train(tmp_path_factory):
    return sg.load_train(written(tmp_path_factory.mktemp("many")))


@pytest.fixture(scope="module")
def assembly(train):
    return Assembly(train)


def by_hand(stiff_bearing=BEARING, teeth_loss=0.0):
    """K, M and both mesh rows of rigid shafts, six motions each at the start of the shaft, and of
    engine and load, from masses of cylinders and forces of helical gears; all axes parallel.
    """
    size = 6 * len(SHAFTS) + 2
    k, m, y = np.zeros((size, size), complex), np.zeros((size, size)), np.array([0.0, 1.0, 0.0])

    def moved(name, point):
        """(6, N) motion of a point of a shaft."""
        at = 6 * [*SHAFTS].index(name)
        out = np.zeros((6, size))
        out[:, at : at + 6] = np.eye(6)
        x = np.array(point)
        out[:3, at + 3 : at + 6] = [[0, x[2], -x[1]], [-x[2], 0, x[0]], [x[1], -x[0], 0]]
        return out

    for name, (cylinders, bearings, _) in SHAFTS.items():
        start = 0.0
        for length, diameter in cylinders:
            r, mass = diameter / 2, DENSITY * pi * diameter**2 / 4 * length
            across = mass * (3 * r**2 + length**2) / 12
            own = moved(name, (0, start + length / 2, 0))
            m += own.T @ np.diag([mass, mass, mass, across, mass * r**2 / 2, across]) @ own
            start += length
        for place in bearings:
            seat = moved(name, (0, place, 0))
            k += seat.T @ np.diag(stiff_bearing) @ seat
    for n, ((inertia, spring), name) in enumerate(zip(ROTORS.values(), ("input", "output"))):
        m[size - 2 + n, size - 2 + n] = inertia
        twist = moved(name, (0, SHAFTS[name][1][1], 0))[4]
        twist[size - 2 + n] -= 1
        k += spring * np.outer(twist, twist)
    rows = []
    for stiffness, (one, two, teeth, radius, helix, azimuth, hand, torque) in zip(
        STIFFNESS, MESHES
    ):
        to_mate = np.array([-cos(azimuth), 0, sin(azimuth)])  # -x turned right-handed about y
        around = np.cross(y, to_mate)
        push = torque * cos(PRESSURE) * (cos(helix) * around - hand * sin(helix) * y)
        push -= sin(PRESSURE) * to_mate  # gears push each other apart
        ends = []
        for (name, gear), arm in ((one, radius), (two, -radius * teeth[1] / teeth[0])):
            ends.append(push @ moved(name, arm * to_mate + SHAFTS[name][2][gear] * y)[:3])
        rows.append(ends[0] - ends[1])
        k += (1 + 1j * teeth_loss) * stiffness * np.outer(rows[-1], rows[-1])
    return k, m, rows


def lumped_matrices(part, bearings):
    """Stiffness and mass of a lumped shaft on its bearings."""
    stiffness = part.strain.T @ part.strain
    for name in bearings:
        stiffness = stiffness + part.ports[name].rows.T @ np.diag(BEARING) @ part.ports[name].rows
    return stiffness, part.mass


def test_a_shaft_with_two_gears_is_lumped_at_both(assembly):
    """Against one solve of all unknowns under unit loads of both points; and in torsion, where nothing
    holds it, against the rod between them, with what lies outside of it turning along.
    """
    body = assembly.shaft_model("middle", "euler").body
    names = [port.name for port in body.ports]
    points = [names.index(port) for port in SHAFTS["middle"][2]]
    stiffness, mass = lumped_matrices(
        assembly.shaft_model("middle", "lumped/euler").part, ("b0", "b1")
    )
    for block in body.blocks:
        components, rows = list(block.components), block.ports.toarray()
        at = [6 * k + c for k in (0, 1) for c in components]
        if components == [4]:
            continue
        count, k, m = len(components), block.stiffness.toarray(), block.mass @ np.eye(block.size)
        for name in ("b0", "b1"):
            seat = rows[names.index(name) * count :][:count]
            k = k + seat.T @ np.diag(np.array(BEARING)[components]) @ seat
        loads = np.vstack([rows[p * count :][:count] for p in points]).T
        moved = np.linalg.solve(k, loads)
        own = np.linalg.inv(loads.T @ moved)
        assert stiffness[np.ix_(at, at)] == pytest.approx(
            own, rel=1e-6, abs=1e-7 * np.abs(own).max()
        )
        exact = own @ moved.T @ m @ moved @ own
        assert mass[np.ix_(at, at)] == pytest.approx(exact, rel=1e-6, abs=1e-9)
    # torsion: a moment spread over a seat of length s twists it by s / 6 less than one in its middle;
    # four cells a seat, in which twist is straight, take 0.3 % of that
    (wheel, pinion), shear = SHAFTS["middle"][2].values(), 206e9 / 2.6
    polar = [pi * d**4 / 32 for _, d in SHAFTS["middle"][0]]
    rods = 0.1 - wheel - 0.02 / 6, pinion - 0.1 - 0.02 / 6
    soft = sum(rod / (shear * p) for rod, p in zip(rods, polar[1:]))
    twist = stiffness[np.ix_([4, 10], [4, 10])]
    assert twist == pytest.approx(np.array([[1, -1], [-1, 1]]) / soft, rel=4e-3)
    own = mass[np.ix_([4, 10], [4, 10])]
    whole = sum(DENSITY * p * length for (length, _), p in zip(SHAFTS["middle"][0], polar))
    assert own.sum() == pytest.approx(whole, rel=1e-6)


def test_lumped_shafts_are_stiffer_than_their_bodies_and_true_below_their_first_bending(assembly):
    """Guyan's shapes are fewer (Rayleigh and Ritz): no frequency is lower.  Those of the chain of
    inertias lack what twists between a gear and the seat of a rotor's spring: of the input 4e3 of
    2.5e5 N m/rad.
    """
    lumped, whole = (
        assembly.system(model).modes(8).frequency_hz[1:]
        for model in ("lumped/timoshenko", "timoshenko")
    )
    assert (lumped >= whole * (1 - 1e-9)).all()
    assert lumped[:2] == pytest.approx(whole[:2], rel=2e-2)
    with pytest.raises(SolidgearError, match="the middle carries several gears.*use lumped"):
        assembly.system("lumped-old/timoshenko")


def hertz(k, m):
    return np.sqrt(np.abs(sla.eigh(k.real, m, eigvals_only=True))) / (2 * pi)


def test_rigid_shafts_move_like_matrices_written_by_hand(assembly):
    found = assembly.system("rigid/timoshenko").modes(19)
    exact = hertz(*by_hand()[:2])
    assert found.rigid == 1 and exact[0] < 1e-3
    assert found.frequency_hz[1:] == pytest.approx(exact[1:], rel=1e-9)


def test_held_shafts_turn_like_a_chain_of_five_inertias(tmp_path):
    """Torsion alone: lateral motions take a share of bearing over mesh stiffness, 1e-6, at most."""
    held = [1e15, 1e15, 1e15, 1e11, 0.0, 1e11]
    assembly = Assembly(sg.load_train(written(tmp_path, bearing=held)))
    polar = [
        sum(DENSITY * pi / 32 * length * d**4 for length, d in SHAFTS[name][0]) for name in SHAFTS
    ]
    inertia = np.diag([ROTORS["engine"][0], *polar, ROTORS["load"][0]])
    k = np.zeros((5, 5))
    for (a, b), (_, stiffness) in zip(((0, 1), (3, 4)), ROTORS.values()):
        k[np.ix_([a, b], [a, b])] += stiffness * np.array([[1, -1], [-1, 1]])
    for a, stiffness, (_, _, teeth, radius, helix, *_) in zip((1, 2), STIFFNESS, MESHES):
        row = radius * cos(PRESSURE) * cos(helix) * np.array([1, teeth[1] / teeth[0]])
        k[a : a + 2, a : a + 2] += stiffness * np.outer(row, row)
    chain = hertz(k, inertia)[1:]
    found = train_modes(assembly, "rigid/timoshenko", max_frequency=1.01 * chain[-1]).modes
    near = [min((m.frequency_hz for m in found), key=lambda hz: abs(hz - one)) for one in chain]
    assert near == pytest.approx(chain, rel=1e-5)
    assert [m.name for m in found if "torsion" in m.name][0] == "load torsion 1"


def test_a_rigid_mesh_is_the_limit_of_a_stiff_one(train):
    k, m, rows = by_hand()
    k = k.real - STIFFNESS[1] * np.outer(rows[1], rows[1])
    free = sla.null_space(rows[1][None])
    exact = hertz(free.T @ k @ free, free.T @ m @ free)[1:8]
    first, second = train.meshes
    stiff = train.with_changes(meshes=(first, second.with_changes(stiffness=1e14)))
    found = Assembly(stiff).system("rigid/timoshenko").modes(7).frequency_hz[1:]
    assert found == pytest.approx(exact, rel=1e-5)


def test_neither_the_sequence_of_shafts_nor_the_side_a_mesh_is_told_from_changes_a_frequency(
    train, assembly
):
    k, m, _ = by_hand()
    first, second = train.meshes
    turned = second.with_changes(
        between=second.between[::-1], azimuth=second.azimuth + pi, gear_position=None
    )
    output = train.member("output").with_changes(loaded_side="right", face_width=0.03)
    other = train.with_changes(
        shafts={
            "output": output.shaft,
            "middle": train.shafts["middle"],
            "input": train.shafts["input"],
        },
        meshes=(turned, first),
    )
    found = Assembly(other).system("timoshenko").modes(12).frequency_hz[1:]
    assert found == pytest.approx(
        assembly.system("timoshenko").modes(12).frequency_hz[1:], rel=1e-7
    )
    assert other.turns == pytest.approx(train.turns, rel=1e-14)


def test_an_error_of_either_mesh_drives_what_the_dense_matrices_give(assembly):
    hz = np.array([40.0, 300.0, 900.0, 2100.0])
    losses = assembly.train.losses.with_changes(shafts=0, bearings=0, springs=0)
    lossy = Assembly(assembly.train.with_changes(losses=losses))
    k, m, rows = by_hand(teeth_loss=losses.mesh)
    for n, pair in enumerate(lossy.train.pairs):
        drive = Drive(lossy, "rigid/timoshenko", mesh=pair.name)
        told = drive.columns(hz)
        other = lossy.train.pairs[1 - n]
        size = (n + 1) * 1e-6
        for f, one in enumerate(hz):
            push = (1 + 1j * losses.mesh) * np.array(STIFFNESS)
            q = np.linalg.solve(k - (2 * pi * one) ** 2 * m, push[n] * size * rows[n])
            forces = push[n] * (rows[n] @ q - size), push[1 - n] * (rows[1 - n] @ q)
            assert told["mesh force [N]"][f] == pytest.approx(forces[0], rel=1e-8)
            assert told[f"mesh force{other.label} [N]"][f] == pytest.approx(forces[1], rel=1e-8)


def test_forces_at_rest_are_in_balance_on_every_shaft_and_torque_leaves_by_the_teeth(train):
    loaded = train.with_changes(operation=({"torque": 100.0},))
    state = Operating(Assembly(loaded), "timoshenko").at(loaded.operation[0])
    assert loaded.operation[0].of == "input"
    ratio = 57 / 20 * 55 / 18
    assert state.outside["load"][4] == pytest.approx(100.0 * ratio, rel=1e-10)
    assert abs(state.outside["engine"][4]) == pytest.approx(100.0, rel=1e-10)
    first = 100 / (0.03 * cos(PRESSURE) * cos(radians(15)))
    second = 100 * 57 / 20 / (0.036 * cos(PRESSURE) * cos(radians(12)))
    assert [*state.mesh_forces.values()] == pytest.approx([first, second], rel=1e-10)
    acting, largest = {side: np.zeros(6) for side in SHAFTS}, max(state.mesh_forces.values())
    for end, six in state.forces().items():
        side, _, port = end.partition(".")
        if side in acting:
            local = getattr(state.system.parts[side], "part", state.system.parts[side])
            arm = local.ports[port].point
            acting[side] += np.r_[six[:3], six[3:] + np.cross(arm, six[:3])]
    for six in acting.values():
        assert np.abs(six).max() < 1e-10 * largest


@pytest.mark.parametrize("told", ["", 'loaded_side = "right"'])
def test_an_idler_between_two_wheels_is_pushed_across_by_both(tmp_path, told):
    """Driven on one flank it drives with the other: forces along its teeth add up, and those that
    push wheels apart cancel where the three axes lie in a line.
    """
    written(tmp_path)
    (tmp_path / "idler.toml").write_text(scene_text("input", BEARING))
    text = ""
    for side, scene, teeth in (
        ("input", "input", 20),
        ("idler", "idler", 31),
        ("output", "output", 40),
    ):
        text += f'[shaft.{side}]\nscene = "{scene}.toml"\nteeth = {teeth}\nface_width = 0.03\n'
        text += f"pitch_radius = {0.0015 * teeth}\nspiral_angle = 0\n"
        text += {"input": 'loaded_side = "left"\n', "idler": told + "\n", "output": ""}[side]
    for one, two in (("input", "idler"), ("idler", "output")):
        text += f'[[mesh]]\nbetween = ["{one}", "{two}"]\nshaft_angle = 0\nstiffness = 3e8\n'
        text += f"pressure_angle = {PRESSURE}\ntransmission_error = 1e-6\n"
    for name, shaft in (("engine", "input"), ("load", "output")):
        text += f'[{name}]\nshaft = "{shaft}"\ninertia = 0.03\n'
        text += f'[{name}.spring]\nstiffness = 4e3\nat = "b1"\n'
    (tmp_path / "train.toml").write_text(text + "[operation]\ntorque = 90\n")
    train = sg.load_train(tmp_path / "train.toml")
    state = Operating(Assembly(train), "timoshenko").at(train.operation[0])
    push = sum(state.forces()[f"idler.{b}"][:3] for b in ("b0", "b1"))  # of the bearings
    assert np.abs(push) == pytest.approx([0, 0, 2 * 90 / 0.03], abs=1e-6)
    assert state.outside["load"][4] == pytest.approx(90.0 * 40 / 20, rel=1e-10)
    # an idler passes on what it takes: the input alone is wound up, by T b / (2 G J), here J of 40 mm
    askew = misalignment(Assembly(train), state.system)
    wound = {m.name: m.row @ state.coordinates for m in askew if m.name.startswith("wind-up")}
    twist = 90 * 0.03 / (2 * 206e9 / 2.6 * np.pi / 2 * 0.02**4)
    lever = 0.03 * cos(PRESSURE)
    assert abs(wound["wind-up input-idler"]) == pytest.approx(lever * twist, rel=1e-6)
    if told:
        (tmp_path / "train.toml").write_text(text.replace(told, 'loaded_side = "left"'))
        with pytest.raises(SolidgearError) as refused:
            sg.load_train(tmp_path / "train.toml")
        said = str(refused.value)
        assert 'loaded_side = "left": is the flank that the idler drives with' in said
        assert 'write "right" in place of "left", or leave it out' in said


BAD = {
    "unknown shaft": (
        (('"middle.pinion", "output', '"middle.pinion", "outptu'),),
        "no shaft 'outptu'",
    ),
    "which gear": ((('"middle.pinion", "output', '"middle", "output'),), "several gears; write"),
    "no such gear": (
        (('"middle.pinion", "output', '"middle.gear", "output'),),
        "no gear at 'gear'",
    ),
    "itself": (
        (('"middle.pinion", "output.gear"', '"middle.pinion", "middle.wheel"'),),
        "both gears are on the middle",
    ),
    "flanks": ((('loaded_side = "right"', 'loaded_side = "left"'),), "no torque passes it"),
    "hands": (
        (
            ('loaded_side = "right"', 'loaded_side = "right"'),
            (
                'hand = "left"\nface_width = 0.03\nloaded',
                'hand = "right"\nface_width = 0.03\nloaded',
            ),
        ),
        "-handed; a",
    ),
    "ratio": ((("pressure_angle", "ratio = 3.0\npressure_angle"),), "are a ratio of"),
    "rotor": ((('[load]\nshaft = "output"', '[load]\nshaft = "outputs"'),), "names no shaft"),
    "no rotor shaft": ((('[load]\nshaft = "output"', "[load]"),), "says which shaft it turns with"),
    "balance": (
        (("[load]\nshaft", "[operation]\ntorque = 100\noutput_torque = 500\n[load]\nshaft"),),
        "are balanced by 870.833",
    ),
    "speed": (
        (
            (
                "[load]\nshaft",
                "[operation]\ntorque = 100\nspeed = 300\noutput_speed = 50\n[load]\nshaft",
            ),
        ),
        "turn the output at",
    ),
    "no mesh": (
        (("[load]\nshaft", '[shaft.idle]\nscene = "input.toml"\nteeth = 20\n[load]\nshaft'),),
        "is in no mesh",
    ),
    "apart": (
        (
            (
                "[load]\nshaft",
                '[shaft.one]\nscene = "input.toml"\nteeth = 20\n[shaft.two]\nscene = "input.toml"\nteeth = 20\n[[mesh]]\nbetween = ["one", "two"]\nstiffness = 1e8\nline_of_action = [0, 0, 1]\npoint = [-0.01, 0, 0]\ntransmission_error = 0\n[load]\nshaft',
            ),
        ),
        "no mesh leads from the input",
    ),
    "loop": (
        (
            (
                "[load]\nshaft",
                '[[mesh]]\nbetween = ["input", "output"]\nshaft_angle = 0\nstiffness = 1e8\npressure_angle = 0.3\ntransmission_error = 0\n[load]\nshaft',
            ),
        ),
        "the loop cannot turn",
    ),
}


@pytest.mark.parametrize(("changes", "reason"), BAD.values(), ids=BAD)
def test_what_is_no_train_is_refused_in_one_sentence(tmp_path, changes, reason):
    with pytest.raises(SolidgearError, match=reason) as caught:
        Assembly(sg.load_train(written(tmp_path, *changes)))
    assert "\n" not in str(caught.value).replace("problems in", "") or caught.value.problems


def test_a_short_file_and_a_long_one_are_the_same_train(tmp_path):
    text = open("geometry/axle_overhung.toml", encoding="utf-8").read()
    for name in ("pinion_overhung", "gear_shaft"):
        (tmp_path / f"{name}.toml").write_bytes(open(f"geometry/{name}.toml", "rb").read())
    for side in ("pinion", "gear"):
        text = text.replace(f"\n[{side}]", f"\n[shaft.{side}]")
    text = text.replace("\n[mesh]", '\n[mesh]\nbetween = ["pinion", "gear"]')
    text = text.replace("\n[engine]", '\n[engine]\nshaft = "pinion"')
    text = text.replace("\n[load]", '\n[load]\nshaft = "gear"')
    (tmp_path / "long.toml").write_text(text)
    long, short = (
        sg.load_train(tmp_path / "long.toml"),
        sg.load_train("geometry/axle_overhung.toml"),
    )
    assert long.with_changes(name=short.name) == short


def test_mixes_of_many_shafts_do_not_explode():
    for count, asked in ((2, 8), (3, 20), (4, 34)):
        found = mixes_of(count)
        assert len(found) == len({*found}) == asked
        off = [sum(rung != JUDGE for rung in mix) for mix in found]
        assert all(n <= 2 or len({*mix}) == 1 for n, mix in zip(off, found))
    assert mixes_of(2) == [(p, g) for p in MIXED for g in MIXED if (p, g) != (JUDGE, JUDGE)]


@pytest.mark.long
def test_commands_take_the_shipped_gearbox_of_two_stages(tmp_path):
    file = "geometry/gearbox_two_stage.toml"
    beams = [a for s in SHAFTS for a in ("--shaft", f"{s}=euler")]
    told = json.loads(command("system-modes", file, *beams, "--json").stdout)
    assert [told[side] for side in SHAFTS] == ["euler"] * 3 and told["rigid"] == 1
    out = tmp_path / "out"
    done = command(
        "response", file, *beams, "--mesh", "middle-output", "--max-frequency", "300", "--out", out
    )
    assert done.exit_code == 0 and "driven by the mesh" in done.output
    head = (out / "response.csv").read_text().splitlines()[0]
    assert "input speed [rpm]" in head and "mesh force input-middle [N]" in head
    done = command("response", file, "--mesh", "third")
    assert done.exit_code != 0 and "mesh" in str(done.exception)
