"""Matrices out and in: against systems, balances of momentum and decks written by hand."""

import json
import sys
from math import pi
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest
import scipy.linalg as sla
from scipy.io import loadmat

import solidgear as sg
from solidgear.core.reduction.matrix_units import MATRIX_UNITS
from solidgear.exchange.matrices.dmig import number, real
from solidgear.exchange.matrices.formats import FORMATS
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.options import models_of
from tests.command import command
from validation.matrices_elsewhere import block_from_calculix, shaft_in_calculix
from validation.race.installed import present

GEOMETRY = Path(__file__).parent.parent / "geometry"
GEAR = GEOMETRY / "gear_shaft.toml"
#: names of formats that can be read, each with the ending of its file
ENDINGS = {name: f.endings[0] for name, f in FORMATS.items() if f.read}
HERTZ = np.array([30.0, 700.0, 4000.0])


@pytest.fixture(scope="module")
def body():
    return sg.build(sg.load(GEAR), "euler", elements=12)


@pytest.fixture(scope="module")
def part(body):
    return sg.craig_bampton(body, n=6)


@pytest.fixture(scope="module")
def matrices(part):
    return sg.port_matrices(part)


def receptance(part):
    """(f, 6 p, 6 p) at the ports, scaled by its diagonal, from all modes of the part alone."""
    system = sg.System({"part": part})
    names = [name for name in part.ports if name != "centre"]
    modes = system.modes()
    moved = np.vstack([system.motion(f"part.{name}") for name in names]) @ modes.shapes
    square = (2 * pi * modes.frequency_hz) ** 2
    return np.array([moved / (square - (2 * pi * f) ** 2) @ moved.T for f in HERTZ])


def apart(first, second):
    """Largest difference over the geometric mean of both diagonals."""
    size = np.sqrt(np.abs(np.einsum("fii->fi", first)))
    return np.abs((first - second) / (size[:, :, None] * size[:, None, :])).max()


@pytest.mark.parametrize("units", MATRIX_UNITS)
@pytest.mark.parametrize("to", ENDINGS)
def test_a_superelement_written_and_read_has_the_same_receptance(
    part, matrices, tmp_path, to, units
):
    files = matrices.write(tmp_path / f"part{ENDINGS[to]}", to, units)
    again = sg.read_matrices(files[-1])
    assert [*again.positions] == [*part.ports] and again.size == part.size
    # numbers of sixteen figures have 13 digits, and springs and masses cancel to some 1e-12
    assert apart(receptance(part), receptance(again)) < 1e-10
    # a mode of unit mass is one in every system
    assert matrices.in_units(MATRIX_UNITS[units])["mass"][-1, -1] == pytest.approx(1.0, rel=1e-12)
    for name, place in again.positions.items():
        assert place == pytest.approx(part.ports[name].point, abs=1e-12)


def test_matlab_finds_the_same_arrays(matrices, tmp_path):
    (file,) = matrices.write(tmp_path / "part.mat")
    arrays = loadmat(file, squeeze_me=True)
    assert np.array_equal(arrays["stiffness"], matrices.stiffness)
    assert [*arrays["points"]] == [*matrices.positions] and arrays["units"] == "m-kg-N"
    assert "coordinates: x y z thx thy thz of every point" in " ".join(arrays["about"])


@pytest.mark.parametrize("to", [*ENDINGS, "calculix"])
def test_any_name_of_a_point_stays_in_its_line(to, matrices, tmp_path):
    names = ['a "b" \\ c', "d\n*STEP\nGRID,9,,1.,2.,3.", "Gehäuse  $ # ** % ,"]
    odd = matrices.with_names(names)
    files = odd.write(tmp_path / f"part{ENDINGS.get(to, '.inp')}", to)
    if to == "calculix":
        assert not any(line == "*STEP" for line in files[0].read_text().splitlines())
    else:
        assert [*sg.read_matrices(files[-1]).positions] == names


def test_free_interface_modes_are_kept_whole(body):
    part = sg.rubin(body, n=6)
    assert apart(receptance(part), receptance(sg.port_matrices(part))) < 1e-10


def test_a_point_has_the_stiffness_of_the_shaft_on_its_bearings(body):
    scene = sg.load(GEAR)
    point = sg.port_matrices(scene, model="euler", elements=12, ports=["gear"], bearings=True)
    stiffness = np.array(sg.condense(body, scene, "gear").stiffness)
    # it turns freely
    size = np.sqrt(np.where(stiffness.diagonal(), stiffness.diagonal(), stiffness[3, 3]))
    assert (np.abs(point.stiffness - stiffness) / np.outer(size, size)).max() < 1e-9


def test_a_train_keeps_its_frequencies_and_its_losses():
    train = sg.load_train(GEOMETRY / "axle_overhung.toml")
    ports = ["pinion.pinion", "gear.gear", "gear.3"]
    matrices = sg.port_matrices(train, model="euler", modes=4, method="free-interface", ports=ports)
    assembly = Assembly(train, kept=4)
    system = assembly.system("euler", "euler")
    exact = (2 * pi * system.modes(20).frequency_hz) ** 2
    value = sla.eigvalsh(matrices.stiffness, matrices.mass)[:21]
    # squares from 1e4 to 1e14 in one product, where a system multiplies by strains
    assert value[1:] == pytest.approx(exact[1:], rel=1e-5)
    assert abs(value[0]) < 1e-5 * value[1]
    # losses: the motion of the gear, whose axes lie across those of the train, by a push on itself
    turn = assembly.places["gear"][0]
    push, load = np.zeros(matrices.size), np.array([3.0, 1.0, -2.0, 0.1, 0.2, -0.3])
    push[6:12] = np.kron(np.eye(2), turn) @ load
    omega = 2 * pi * 650.0
    dynamic = matrices.stiffness + 1j * matrices.damping - omega**2 * matrices.mass
    got = np.kron(np.eye(2), turn).T @ np.linalg.solve(dynamic, push)[6:12]
    motion = system.response(
        [650.0], system.load({"gear.gear": load}), loss=assembly.loss_factors()
    )
    assert got == pytest.approx(system.motion("gear.gear") @ motion[0], rel=1e-6)


def test_spin_turns_the_momentum_of_the_whole_shaft(body):
    """A spin about y of angular momentum L asks for the moments (-L thz', L thx') of tilts."""
    matrices = sg.port_matrices(body, modes=2, speed=300.0)
    rigid = matrices.rigid()
    moment = rigid.T @ matrices.gyroscopic @ rigid
    momentum = 300.0 * body.mass_matrix()[4, 4]
    wanted = np.zeros((6, 6))
    wanted[3, 5], wanted[5, 3] = -momentum, momentum
    assert moment[3:, 3:] == pytest.approx(wanted[3:, 3:], rel=1e-6, abs=1e-9 * momentum)


@pytest.mark.parametrize(
    "value", [1e-300, 0.0, -1.23456789012e-20, 0.1, -np.pi, 1e9 / 7, -4e15 / 3]
)
def test_sixteen_figures_hold_twelve_digits(value):
    text = real(value)
    assert len(text) <= 16 and "." in text
    assert number(text) == pytest.approx(value, rel=5e-12)


# what other programs write


def bar():
    """Stiffness and mass of a uniform bar between two points, SI, 12 by 12, and the points."""
    rod = sg.Segment.cylinder("rod", length=1.0, diameter=0.1)
    ends = [
        sg.Bearing(
            name=name, y=y, seat_width=0.02, attachment="section", stiffness=np.zeros((6, 6))
        )
        for name, y in (("a", 0.05), ("b", 0.95))
    ]
    return sg.port_matrices(sg.Scene.from_parts([rod], bearings=ends), ports=["a", "b"])


def test_small_fields_and_fields_with_commas_are_read(tmp_path):
    bar_matrices = bar()
    lines = ["GRID,1,,0.,50.,0.", "GRID,2,,0.,950.,0."]
    for name, kind in (("KAAX", "stiffness"), ("MAAX", "mass")):
        table = bar_matrices.in_units(MATRIX_UNITS["mm-t-N"])[kind]
        lines.append(f"DMIG    {name}           0       6       2       0")
        for column in range(12):
            node, direction = column // 6 + 1, column % 6 + 1
            for row in range(column, 12):
                value = f"{table[row, column]:.14e}".upper().replace("E", "D")
                lines.append(
                    f"DMIG,{name},{node},{direction},,{row // 6 + 1},{row % 6 + 1},{value}"
                )
    (tmp_path / "bar.bdf").write_text("\n".join(lines))
    again = sg.read_matrices(tmp_path / "bar.bdf", {"left": 1, "right": 2}, "mm-t-N")
    assert [*again.positions] == ["left", "right"]
    assert again.rigid_mass[0, 0] == pytest.approx(7850 * pi / 4 * 0.01, rel=1e-9)
    assert again.elastic[0] == pytest.approx(bar_matrices.elastic[0], rel=1e-9)
    # the same numbers without units are refused no number, but nobody has such a bar
    assert "units = 'mm-t-N'" in sg.read_matrices(tmp_path / "bar.bdf").doubts[0]
    keys = again.to_dict()
    reread = sg.read_matrices(keys["matrices"], keys["points"], keys["units"])
    assert reread == again and str(again) == again.source
    sg.export(bar_matrices, tmp_path / "si.bdf")
    assert "units = 'm-kg-N'" in sg.read_matrices(tmp_path / "si.bdf", units="mm-t-N").doubts[0]
    slip = {"left": {"node": 1, "positon": [0, 0, 0]}, "right": 2}
    with pytest.raises(sg.SceneError, match="'left': unknown key .positon.*position"):
        sg.read_matrices(tmp_path / "bar.bdf", slip, "mm-t-N")
    with pytest.raises(sg.SceneError, match="none.bdf: there is no such file"):
        sg.read_matrices("none.bdf")


def test_a_user_element_of_a_substructure_is_read(tmp_path):
    bar_matrices = bar()
    lines = ["*USER ELEMENT, NODES= 2, LINEAR", "** ELEMENT NODES", "** 7, 9", "1,2,3,4,5,6"]
    for name in ("stiffness", "mass"):
        lines.append(f"*MATRIX,TYPE={name.upper()}")
        table = bar_matrices.matrices[name]
        for row in range(12):
            values = [f"{value!r}" for value in table[row, : row + 1].tolist()]
            lines += [", ".join(values[k : k + 4]) + "," for k in range(0, row + 1, 4)]
    (tmp_path / "bar.mtx").write_text("\n".join(lines))
    points = {
        "a": {"node": 7, "position": [0, 0.05, 0]},
        "b": {"node": 9, "position": [0, "950 mm", 0]},
    }
    again = sg.read_matrices(tmp_path / "bar.mtx", points)
    assert again.stiffness == pytest.approx(bar_matrices.stiffness, rel=1e-14)


def test_stored_matrices_are_condensed_to_points_of_two_nodes(tmp_path, matrices):
    """As CalculiX stores them: a triangle, with REF NODE and ROT NODE of every rigid face."""
    labels = [(10 + row // 3, row % 3 + 1) for row in range(18)]
    labels += [(30 + k, 1) for k in range(matrices.modes)]
    (tmp_path / "part.dof").write_text("\n".join(f"{node}.{d}" for node, d in labels))
    for ending, table in ((".sti", matrices.stiffness), (".mas", matrices.mass)):
        rows = [
            f"{j + 1} {i + 1} {table[i, j]:.17e}" for i in range(len(table)) for j in range(i + 1)
        ]
        (tmp_path / f"part{ending}").write_text("\n".join(rows))
    # two of three points: what is left out moves under rigid motions
    points = {
        name: {"node": nodes, "position": matrices.positions[name].tolist()}
        for name, nodes in (("gear", [10, 11]), ("4", [14, 15]))
    }
    again = sg.read_matrices(tmp_path / "part.sti", points)
    assert again.notes == (f"condensed from {matrices.size} unknowns to its points and 12 modes",)
    assert again.elastic[0] == pytest.approx(matrices.elastic[0], rel=1e-8)


def spoilt(**changes):
    """Arrays of a bar, some of them changed."""
    bar_matrices = bar()
    arrays = {
        "mass": bar_matrices.mass,
        "stiffness": bar_matrices.stiffness,
        "points": ["a", "b"],
        "positions": [[0, 0.05, 0], [0, 0.95, 0]],
    }
    return arrays | {name: change(np.array(arrays[name])) for name, change in changes.items()}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"stiffness": lambda k: k * np.where(np.eye(12), 1, 1.1)}, "leaves more than six|resists"),
        (
            {"stiffness": lambda k: k + np.triu(np.ones((12, 12))) * 1e9},
            "stiffness is not symmetric",
        ),
        ({"mass": lambda m: -m}, "mass is not positive definite"),
        ({"positions": lambda p: 1e3 * p}, r"positions 0\.001 times as large"),
        ({"positions": lambda p: p[:1]}, r"2 points and positions \(1, 3\) do not fit"),
        ({"mass": lambda m: m[:6]}, r"mass \(6, 12\).* do not fit"),
        ({"stiffness": lambda k: k * np.nan}, "stiffness must be real and finite"),
        ({"points": lambda p: ["a", "a"]}, "a point is named twice"),
    ],
)
def test_what_is_no_free_body_is_refused_in_a_sentence(tmp_path, changes, said):
    np.savez(tmp_path / "bar.npz", **spoilt(**changes))
    with pytest.raises(sg.SceneError, match=said) as caught:
        _ = sg.read_matrices(tmp_path / "bar.npz").elastic
    assert "bar.npz: " in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("2 2 2\n1 1 2.\n3 1 1.", "an entry lies outside 2 by 2"),
        ("2 2 3\n1 1 2.", "3 entries of 2 by 2 were announced"),
        ("2 2 1\n1 1 two", "could not convert"),
    ],
)
def test_a_damaged_matrix_market_file_is_refused_in_a_sentence(tmp_path, text, said):
    """SciPy's reader ends the program on a row out of range."""
    (tmp_path / "x.json").write_text('{"files": {"mass": "m.mtx"}}')
    head = "%%MatrixMarket matrix coordinate real symmetric\n"
    (tmp_path / "m.mtx").write_text(head + text)
    with pytest.raises(sg.SceneError, match=f"x.json: m.mtx is no Matrix Market file: .*{said}"):
        sg.read_matrices(tmp_path / "x.json")


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("x.bdf", "GRID,1,,0.,0.,0.", "has no DMIG entries"),
        ("x.bdf", "GRID,1,5,0.,0.,0.", "coordinate system 5"),
        ("x.inp", "*HEADING\nnothing", "no \\*MATRIX INPUT"),
        (
            "x.inp",
            "*MATRIX INPUT, NAME=K\n1, 1, 1, one, 2.",
            "line 2: '1, 1, 1, one, 2.' is no row",
        ),
        ("x.inp", "*MATRIX INPUT, NAME=STIF\n1, 1, 1, 1, 2.", "has a stiffness alone"),
        ("x.mtx", "%%MatrixMarket matrix", "name the .json"),
        ("x.json", "{", "is no JSON"),
        ("x.json", '{"files": {"mass": "gone.mtx"}}', "the file gone.mtx of its mass is missing"),
        ("x.npz", "PK", "not a file of NumPy"),
        ("x.mat", "PK", "files that end in .npz"),
        ("x.npz", "PK\x03\x04" + 60 * "x", "not a file of NumPy"),
        (
            "x.json",
            '{"files": {}, "mass": 1, "stiffness": 1, "points": ["a"], "positions": [[0], "b"]}',
            "positions must be three numbers",
        ),
        ("x.sti", "1 1 2.", "x.dof is missing"),
        ("x.txt", "1 2", "line 1: '1 2' is no row"),
        ("x.dxf", "", "files that end in .npz"),
    ],
)
def test_files_that_are_no_matrices_are_refused_in_a_sentence(tmp_path, name, text, said):
    (tmp_path / name).write_text(text)
    with pytest.raises(sg.SceneError, match=said):
        sg.read_matrices(tmp_path / name)


# by other programs


@pytest.mark.long
@pytest.mark.skipif(not present("CalculiX"), reason="CalculiX is not installed")
@pytest.mark.parametrize("units", ["m-kg-N", "mm-t-N"])
def test_calculix_finds_the_frequencies_of_what_is_written(tmp_path, units):
    theirs, ours = shaft_in_calculix(tmp_path, units)
    # printed with seven figures
    assert theirs == pytest.approx(ours, rel=1e-6)


@pytest.mark.long
@pytest.mark.skipif(not present("CalculiX"), reason="CalculiX is not installed")
def test_what_calculix_stores_has_its_frequencies(tmp_path):
    theirs, ours = block_from_calculix(tmp_path)
    assert ours == pytest.approx(theirs, rel=1e-5)


def test_a_deck_of_masses_springs_and_equations_has_the_motions_of_the_points(matrices, tmp_path):
    """Its springs and equations, read here: the receptance of its modes is that of the matrices."""
    (file,) = matrices.write(tmp_path / "part.inp", "calculix", "mm-t-N")
    shares, square = np.zeros((6 * 3, matrices.size)), np.zeros(matrices.size)
    lines = file.read_text().splitlines()
    for k, line in enumerate(lines):
        if line.startswith("*ELEMENT, TYPE=SPRING1"):
            node, direction = int(lines[k + 1].split(",")[1]), int(lines[k + 3])
            square[3 * (node - 7) + direction - 1] = float(lines[k + 4])
        elif line == "*EQUATION":
            terms, at = [], k + 2
            while len(terms) < 3 * int(lines[k + 1]):
                terms += [float(word) for word in lines[at].split(",")]
                at += 1
            row = 3 * (int(terms[0]) - 1) + int(terms[1]) - 1
            for node, direction, share in zip(terms[3::3], terms[4::3], terms[5::3]):
                shares[row, 3 * (int(node) - 7) + int(direction) - 1] = -share
    got = np.array([shares / (square - (2 * pi * f) ** 2) @ shares.T for f in HERTZ])
    size = np.tile(np.repeat([1e-3, 1.0], 3), 3)
    # mm and rad by N and N mm
    got = got * np.outer(size, size) / 1e-3
    assert apart(receptance(matrices), got) < 1e-10


class RossElement:
    """Stands for elements of ROSS: keeps what it is made of, a shaft element with Cowper's coefficient."""

    kappa = 6 * 1.3 / (7 + 6 * 0.3)

    def __init__(self, *sizes, **more):
        self.sizes, self.more, self.phi = sizes, more, 1.0


def ross_file(source, path, *words):
    """Names in the file that `export --to ross` writes, run beside a stand-in for ROSS."""
    done = command("export", source, "--to", "ross", "--out", path, *words)
    assert done.exit_code == 0, done.output
    rotor = SimpleNamespace(
        DiskElement=RossElement,
        ShaftElement=RossElement,
        Material=lambda name, **more: more,
        Rotor=lambda shaft, disk_elements: (shaft, disk_elements),
    )
    names = {"__name__": "rotor_file"}
    with mock.patch.dict(sys.modules, {"ross": rotor}):
        exec(compile(path.read_text(), "rotor.py", "exec"), names)
    return names, " ".join(done.output.split())


def test_a_rotor_file_for_ross_has_the_point_in_its_axes(tmp_path):
    names, _ = ross_file(GEAR, tmp_path / "gear.py")
    element = names["condensed"](3)
    stiffness, mass = element.stiffness, element.inertia
    point = sg.port_matrices(GEAR, ports=["gear"], bearings=True)
    assert (element.sizes, element.more["tag"]) == ((3,), "gear")
    # along the axis, which is y here and z there, the shaft is as stiff
    assert stiffness[2][2] == point.stiffness[1, 1] and mass[5][5] == point.mass[4, 4]
    assert stiffness[0][4] == point.stiffness[2, 3] and stiffness[1][3] == point.stiffness[0, 5]


def test_a_rotor_for_ross_has_its_bearings_and_the_shear_of_the_beam_here(tmp_path):
    """Hutchinson's coefficient in place of Cowper's, which makes phi = 12 E I / (k G A L^2) smaller; with
    it frequencies of the rotor by ROSS 2.3 and of the beam with bearings at sections agree to 6e-5.
    """
    path = GEOMETRY / "shaft_stepped.toml"
    names, words = ross_file(path, tmp_path / "stepped.py")
    shaft, points = names["rotor"]()
    scene = sg.load(path)
    nu = scene.segments[0].material.nu
    due = 6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2)  # of a full circle
    assert [e.kappa for e in shaft] == pytest.approx([due] * len(shaft))
    assert shaft[0].phi == pytest.approx(RossElement.kappa / due)
    assert sum(e.sizes[0] for e in shaft) == pytest.approx(scene.length)
    by_name = {b.name: b for b in scene.bearings}
    assert {e.more["tag"] for e in points} == {*by_name}
    assert points[0].stiffness[1][1] == pytest.approx(by_name["A"].stiffness[0, 0])
    assert "The rotor has A, B at one node each" in words
    free, _ = ross_file(path, tmp_path / "free.py", "--free")
    assert not any(np.any(e.stiffness) for e in free["rotor"]()[1])


def test_a_shaft_with_a_housing_has_no_rotor_for_ross(tmp_path):
    """A housing makes bearings act on one another, which no element of ROSS at one node does; the
    condensed point has it.
    """
    names, words = ross_file(GEAR, tmp_path / "gear.py")
    assert "rotor" not in names and "There is no rotor, only the condensed point" in words
    free, words = ross_file(GEAR, tmp_path / "free.py", "--free")
    assert "rotor" in free and "no rotor" not in words


# in trains


def test_a_shaft_of_a_train_by_matrices_of_nastran(tmp_path):
    for name in ("pinion_overhung", "gear_shaft"):
        (tmp_path / f"{name}.toml").write_text((GEOMETRY / f"{name}.toml").read_text())
    text = (GEOMETRY / "axle_overhung.toml").read_text()
    (tmp_path / "axle.toml").write_text(
        text.replace("[gear]\n", '[gear]\nmatrices = "gear.bdf"\n', 1)
    )
    wanted = {"model": "euler", "modes": 24, "method": "free-interface"}
    sg.export(GEAR, tmp_path / "gear.bdf", units="mm-t-N", **wanted)
    assembly = Assembly(sg.load_train(tmp_path / "axle.toml"))
    got = assembly.system("euler", "matrices").modes(12).frequency_hz
    exact = assembly.system("euler", "euler").modes(12).frequency_hz
    assert got[1:] == pytest.approx(exact[1:], rel=1e-8)
    models = models_of(assembly.train.shafts, "axle", {"pinion": "euler"})
    assert models == {"pinion": "euler", "gear": "matrices"}
    # the tables of the train name the file; those of its shaft give the same body
    again = sg.load_train(assembly.train.to_dict()).shafts["gear"]
    assert again.matrices == assembly.train.shafts["gear"].matrices
    assert sg.port_matrices(again.scene.to_dict(), **wanted).size == again.matrices.size
    sg.export(GEAR, tmp_path / "gear.bdf", ports=["gear", "3"], modes=3)
    with pytest.raises(sg.SceneError, match="has no point '4'"):
        Assembly(sg.load_train(tmp_path / "axle.toml")).system("euler", "matrices")


# the command


def test_the_command_says_what_it_wrote(tmp_path):
    out = tmp_path / "gear.bdf"
    words = ("export", GEAR, "--modes", 2, "-f", "euler", "--out", out, "--units", "mm-t-N")
    done = command(*words)
    assert done.exit_code == 0, done.output
    assert "then 2 modes" in done.output and "Free: without its bearings." in done.output
    head = out.read_text().split("GRID*")[0]
    assert '$ point 1 "gear" at x 0, y 8.97115608, z 0' in head and "mm-t-N" in head
    assert str(tmp_path) not in head
    data = json.loads(command(*words, "--json", "--bearings").output)
    assert data["free"] is False and data["coordinates"][:2] == ["gear.x", "gear.y"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--out", "x.step"), "is of no format"),
        (("--out", "x.npz", "--to", "nastrn"), 'did you mean "nastran"'),
        (("--out", "x.npz", "--ports", "gaer"), 'has no port "gaer"; did you mean "gear"'),
        (("--out", "x.npz", "--method", "guyan"), 'method "guyan"'),
        (("--out", "x.npz", "--units", "mm"), "use one of m-kg-N, mm-t-N"),
        (("--out", "x.npz", "--modes", "-1"), "is not a number of modes"),
        (("--out", "x.py", "--to", "ross", "--ports", "3,4"), "at one node, not at 3, 4"),
        (("--out", "x.inp", "--to", "calculix", "--loss", "0.1"), "neither damping"),
        (("--out", "none/x.npz/y.npz"), None),
    ],
)
def test_the_command_refuses_in_a_sentence_and_writes_nothing(tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "none").write_text("")
    done = command("export", GEAR, "-f", "euler", *words)
    assert done.exit_code == 1 and done.exception is not None
    if said is not None:
        assert said in str(done.exception), str(done.exception)
    assert [path.name for path in tmp_path.iterdir()] == ["none"]


def test_a_mass_on_a_bearing_belongs_to_the_free_shaft():
    scene = sg.load(Path(__file__).parent / "found/spin/mass_on_bearing.toml")
    matrices = sg.port_matrices(scene)
    lift = np.zeros(len(matrices.mass))
    lift[2::6] = 1.0  # every port by one metre along z
    shaft = scene.with_changes(masses=())
    heavy, light = lift @ matrices.mass @ lift, lift @ sg.port_matrices(shaft).mass @ lift
    assert heavy - light == pytest.approx(2.0, rel=1e-9)
    assert np.abs(matrices.stiffness @ lift).max() < 1e-6 * np.abs(matrices.stiffness).max()
