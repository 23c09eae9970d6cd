"""The housing of a train, against matrices and balances written by hand."""

import json
from math import cos, pi, sqrt
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SceneError, SolidgearError
from solidgear.strength.deflection.at_rest import deflection
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.meshes import mesh_bars
from solidgear.trains.judge.judge import _Judge
from solidgear.trains.load.operation import Operating
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.modes.pairing import modes_and_motions
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.receptance import receptance
from tests.command import command
from tests.test_train_many import BEARING, DENSITY, MESHES, SHAFTS, by_hand, hertz, written

GEOMETRY = Path(__file__).parent.parent / "geometry"
RIGID = "rigid/timoshenko"
#: where a solid is only what a lumped shaft rests on
COARSE = {"harmonic": {"order": 2, "layers": 1}}
MASS, CENTRE = 85.0, np.array([-0.1, 0.12, 0.04])
INERTIA = np.array([[3.1, 0.2, 0.0], [0.2, 2.2, -0.1], [0.0, -0.1, 2.9]])
SPRING, MOUNTS = (4e6, 3e6, 6e6), ((-0.3, 0.0, -0.15), (0.2, 0.05, -0.15), (0.0, 0.3, -0.1))


def housing(mass=MASS, inertia=INERTIA, spring=SPRING, mounts=MOUNTS, centre=CENTRE, **more):
    named = dict(zip(("kxx", "kyy", "kzz"), spring))
    return {
        "mass": mass,
        "inertia": np.asarray(inertia).tolist(),
        "centre": [*centre],
        "mount": [{"position": place, "stiffness": named} for place in mounts],
        **more,
    }


@pytest.fixture(scope="module")
def bare(tmp_path_factory):
    return sg.load_train(written(tmp_path_factory.mktemp("housed")))


@pytest.fixture(scope="module")
def train(bare):
    return bare.with_changes(housing=housing())


@pytest.fixture(scope="module")
def assembly(train):
    return Assembly(train)


def places_by_hand():
    """Of every bearing in the axes of the train."""
    origin = {"input": np.zeros(3)}
    for (one, at), (other, there), teeth, radius, _, azimuth, *_ in MESHES:
        away = radius * (1 + teeth[1] / teeth[0]) * np.array([-cos(azimuth), 0, np.sin(azimuth)])
        along = SHAFTS[one][2][at] - SHAFTS[other][2][there]
        origin[other] = origin[one] + away + [0, along, 0]
    return {
        f"{name}.b{k}": origin[name] + [0, y, 0]
        for name, (_, bearings, _) in SHAFTS.items()
        for k, y in enumerate(bearings)
    }


def carried(arm):
    """(6, 6) motion at the end of an arm."""
    out, (x, y, z) = np.eye(6), arm
    out[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return out


def housed_by_hand(mass, stiffness, motion):
    """K and M of rigid shafts and rotors with a housing of (n, n) matrices behind them, whose
    `motion` of a point, with its place, is (6, n); only what shafts and teeth do without bearings
    is that of another test.
    """
    k, m, _ = by_hand([0.0] * 6)
    n, box = len(k), len(mass)
    k, m = (np.pad(one, (0, box)) for one in (k.real, m))
    for name, place in places_by_hand().items():
        side, end = name.split(".b")
        at, across = 6 * [*SHAFTS].index(side), np.zeros((6, n + box))
        across[:, at : at + 6] = carried([0, SHAFTS[side][1][int(end)], 0])
        across[:, n:] = -motion(name, place)
        k += across.T @ np.diag(BEARING) @ across
    k[n:, n:] += stiffness
    for number, place in enumerate(MOUNTS, start=1):
        foot = motion(f"foot {number}", np.array(place))[:3]
        k[n:, n:] += foot.T @ np.diag(SPRING) @ foot
    m[n:, n:] = mass
    return k, m


def test_rigid_shafts_and_their_housing_move_like_matrices_written_by_hand(assembly):
    found = assembly.system(RIGID).modes(25)
    mass = np.diag([MASS, MASS, MASS, 0, 0, 0])
    mass[3:, 3:] = INERTIA
    own = housed_by_hand(mass, np.zeros((6, 6)), lambda name, place: carried(place - CENTRE))
    exact = hertz(*own)
    assert found.rigid == 1 and len(exact) == 26
    assert found.frequency_hz[1:] == pytest.approx(exact[1:], rel=1e-9)


def lumps(stiff=1.0):
    """Mass and stiffness of an elastic housing: lumps at all its points, each on a spring to the
    first, and a mode that moves with them; its points and where they are.
    """
    feet = {f"foot {number}": np.array(place) for number, place in enumerate(MOUNTS, start=1)}
    places = {**places_by_hand(), **feet, "cover": np.array([0.0, 0.2, 0.3])}
    size = 6 * len(places) + 1
    mass, stiffness, (first, *_) = np.zeros((size, size)), np.zeros((size, size)), places.values()
    for n, place in enumerate(places.values()):
        at, across = slice(6 * n, 6 * n + 6), np.zeros((6, size))
        mass[at, at] = np.diag([7.0 + n, 7.0 + n, 7.0 + n, 0.03, 0.02, 0.04])
        across[:, at] += np.eye(6)
        across[:, :6] -= carried(place - first)
        spring = stiff * (1 + n) * np.diag([2e8, 1e8, 3e8, 1e6, 2e6, 1e6])
        stiffness += across.T @ spring @ across
    mass[-1, -1], stiffness[-1, -1] = 1.0, stiff * (2 * pi * 400) ** 2
    mass[-1, :3] = mass[:3, -1] = 0.5, -1.0, 0.8
    return mass, stiffness, places


def elastic(folder, mass, stiffness, places, *changes):
    """A train file with such a housing."""
    arrays = {"mass": mass, "stiffness": stiffness, "points": [*places]}
    np.savez(folder / "box.npz", positions=[*places.values()], **arrays)
    text = '[housing]\nmatrices = "box.npz"\n'
    keys = ", ".join(f"{key} = {value}" for key, value in zip(("kxx", "kyy", "kzz"), SPRING))
    for number in range(1, len(MOUNTS) + 1):
        text += f'[[housing.mount]]\nat = "foot {number}"\nstiffness = {{{keys}}}\n'
    train = written(folder, *changes)
    train.write_text(train.read_text() + text)
    return train


def test_a_housing_of_matrices_moves_like_them(tmp_path):
    mass, stiffness, places = lumps()
    names = [*places]

    def motion(name, place):
        rows, at = np.zeros((6, len(mass))), 6 * names.index(name)
        rows[:, at : at + 6] = carried(place - places[name])
        return rows

    exact = hertz(*housed_by_hand(mass, stiffness, motion))
    # the same body with one point 2 mm from its bearing, which an arm then reaches
    beside, at = np.eye(len(mass)), 6 * names.index("middle.b1")
    beside[at : at + 6, at : at + 6] = carried([0, -0.002, 0])
    there = {**places, "middle.b1": places["middle.b1"] + [0, 0.002, 0]}
    own = (beside.T @ one @ beside for one in (mass, stiffness))
    assembly = Assembly(sg.load_train(elastic(tmp_path, *own, there)))
    found = assembly.system(RIGID).modes(len(exact) - 1)
    assert found.rigid == 1
    assert found.frequency_hz[1:] == pytest.approx(exact[1:], rel=1e-9)
    moved = "'middle.b1' of the housing lies 2 mm from that bearing"
    assert any(moved in text for text in assembly.cautions())
    modes = train_modes(assembly, RIGID, max_frequency=1500.0).modes
    assert any("housing elastic" in mode.name for mode in modes)


def test_a_stiff_housing_of_matrices_is_a_rigid_one(tmp_path, bare):
    """Springs inside it a million times as stiff, so that some 1e-6 of what bearings give is left."""
    elastic_one = sg.load_train(elastic(tmp_path, *lumps(1e6)))
    box = elastic_one.housing
    feet = tuple(
        mount.with_changes(at=None, position=place) for mount, place in zip(box.mounts, MOUNTS)
    )
    rigid = box.with_changes(matrices=None, mounts=feet)
    shops = [Assembly(bare.with_changes(housing=one)) for one in (box, rigid)]
    found, exact = (assembly.system("euler").modes(12).frequency_hz[1:] for assembly in shops)
    assert found == pytest.approx(exact, rel=1e-5)
    point = bare.with_changes(operation=({"torque": 100.0, "weight": "-z"},)).operation[0]
    one, other = (deflection(assembly, point, "euler") for assembly in shops)
    for key in ("1", "2", "3"):
        loads = [[m.value for m in own.mounts[key]] for own in (one, other)]
        assert loads[0] == pytest.approx(loads[1], rel=1e-4, abs=1e-6)


@pytest.mark.parametrize(
    "change, said",
    [
        (lambda m, k, p: (m, k + np.eye(len(k)) * 1e6, p), r"resists rigid motions \(mode at"),
        (lambda m, k, p: (m, k * 0, p), "more than six motions free"),
        (lambda m, k, p: (m - np.eye(len(m)) * 8, k, p), "mass is not positive definite"),
        (lambda m, k, p: (m[1:, 1:], k, p), "do not fit"),
        (lambda m, k, p: (m, np.triu(k), p), "stiffness is not symmetric"),
        (
            lambda m, k, p: (m, k, {n.replace("output.b1", "out"): v for n, v in p.items()}),
            "no point 'output.b1'",
        ),
        (
            lambda m, k, p: (m, k, {n.replace("foot 2", "toe"): v for n, v in p.items()}),
            "at.*no point of the housing",
        ),
    ],
)
def test_matrices_of_no_free_housing_are_refused_in_a_sentence(tmp_path, change, said):
    with pytest.raises(SceneError, match=said):
        sg.load_train(elastic(tmp_path, *change(*lumps())))


@pytest.mark.parametrize(
    "still", [{"spring": (1e18,) * 3}, {"mass": 1e14, "inertia": np.eye(3) * 1e13}]
)
def test_a_housing_that_cannot_move_is_none(bare, still):
    models, n = ("euler", "rigid/euler", "rigid/euler"), 9
    usual = Assembly(bare).system(*models).modes(n).frequency_hz[1:]
    found = Assembly(bare.with_changes(housing=housing(**still))).system(*models).modes(n + 6)
    elastic = found.frequency_hz[found.frequency_hz > 1.0]
    assert elastic[:n] == pytest.approx(usual, rel=1e-6)


def test_a_housing_of_nastran_that_cannot_give_is_none(tmp_path, bare):
    """Springs and mounts of some 1e17 N/m and more beside bearings of 1e8."""
    mass, stiffness, places = lumps(1e9)
    path = elastic(tmp_path, mass, stiffness, places)
    box = sg.read_matrices(tmp_path / "box.npz")
    box.write(tmp_path / "box.bdf", units="mm-t-N")
    text = path.read_text().replace("box.npz", "box.bdf")
    for spring in map(str, SPRING):
        text = text.replace(f" = {spring}", " = 1e18")
    path.write_text(text)
    models, n = ("euler", "rigid/euler", "rigid/euler"), 9
    usual = Assembly(bare).system(*models).modes(n).frequency_hz[1:]
    found = Assembly(sg.load_train(path)).system(*models).modes(n).frequency_hz[1:]
    assert found == pytest.approx(usual, rel=1e-6)


def test_points_of_a_deck_are_named_by_nodes_and_doubtful_units_are_told(tmp_path):
    path = elastic(tmp_path, *lumps())
    box = sg.read_matrices(tmp_path / "box.npz")
    box.write(tmp_path / "box.bdf", units="mm-t-N")
    deck = tmp_path / "box.bdf"
    # as another program leaves it: no names, no units
    deck.write_text("\n".join(s for s in deck.read_text().splitlines() if s[0] != "$"))
    nodes = ", ".join(f'"{name}" = {k}' for k, name in enumerate(box.positions, start=1))
    points = f'matrices = "box.bdf"\npoints = {{{nodes}}}\n'
    text = path.read_text()
    path.write_text(text.replace('matrices = "box.npz"\n', f'{points}units = "mm-t-N"\n'))
    train = sg.load_train(path)
    assert train.housing.mass == pytest.approx(box.rigid_mass[0, 0], rel=1e-9)
    assert not any("unusual" in text for text in Assembly(train).cautions())
    path.write_text(text.replace('matrices = "box.npz"\n', points))
    (said,) = (text for text in Assembly(sg.load_train(path)).cautions() if "unusual" in text)
    assert "as of millimetres, tonnes and newtons: units = 'mm-t-N'" in said
    path.write_text(text.replace('matrices = "box.npz"\n', f'{points}units = "mm"\n'))
    with pytest.raises(SceneError, match="housing.units = .mm.: use one of m-kg-N"):
        sg.load_train(path)
    path.write_text(text.replace('matrices = "box.npz"\n', points.replace("= 1,", "= 99,")))
    with pytest.raises(SceneError, match="box.bdf: point .*: 99 is no node of the matrices"):
        sg.load_train(path)


def test_on_bearings_that_do_not_hold_a_housing_has_the_modes_of_a_mass_on_its_mounts(bare):
    """Four mounts about the centre of mass; bearings of 1e-6 N/m change 1e-12 of a stiffness."""
    mass, (ix, iy, iz), (kx, ky, kz) = 40.0, (0.7, 0.5, 0.6), (8e5, 9e5, 2e6)
    a, b = 0.12, 0.2
    corners = [(x + CENTRE[0], y + CENTRE[1], CENTRE[2]) for x in (-a, a) for y in (-b, b)]
    box = housing(mass, (ix, iy, iz), (kx, ky, kz), corners)
    assembly = Assembly(bare.with_changes(housing=box))
    names = [f"{side}.b{k}" for side in SHAFTS for k in (0, 1)]
    soft = np.diag([1e-6, 1e-6, 1e-6, 1e-8, 0.0, 1e-8])
    found = assembly.with_bearings(dict.fromkeys(names, soft)).system(RIGID).modes(25).frequency_hz
    turns = kz * b**2 / ix, kz * a**2 / iy, (kx * b**2 + ky * a**2) / iz
    exact = [sqrt(4 * k) / (2 * pi) for k in (kx / mass, ky / mass, kz / mass, *turns)]
    assert [found[np.argmin(abs(found - hz))] for hz in exact] == pytest.approx(exact, rel=1e-9)
    system = assembly.with_bearings(dict.fromkeys(names, soft)).system(RIGID)
    modes, seen = modes_and_motions(assembly, system, max(exact) + 1)
    near = [np.argmin(abs(modes.frequency_hz[modes.rigid :] - hz)) for hz in exact]
    assert np.linalg.norm(seen[:, near], axis=0).min() > 0.1  # a mode is paired by what it moves


def test_without_mounts_six_motions_more_are_free_and_told_and_loads_at_rest_are_refused(bare):
    assembly = Assembly(bare.with_changes(housing=housing(mounts=())))
    found = train_modes(assembly, RIGID, max_frequency=2000.0)
    assert found.rigid == 7 and [m.frequency_hz for m in found.modes[:8]].count(0.0) == 7
    assert "7 motions are free" in found.free[0] and "bearings" not in found.free[0]
    assert "no mount holds the housing in x y z thx thy thz" in found.free[0]
    point = bare.with_changes(operation=({"torque": 100.0},)).operation[0]
    with pytest.raises(SolidgearError, match="no mount holds the housing in thy"):
        Operating(assembly, RIGID).at(point)


def test_mounts_carry_the_difference_of_both_torques_and_the_weight(train):
    loaded = train.with_changes(operation=({"torque": 100.0, "weight": "-z"},))
    found = deflection(Assembly(loaded), loaded.operation[0], "euler")
    load = {n: np.array([one.value for one in six]) for n, six in found.mounts.items()}
    force = sum(six[:3] for six in load.values())
    moment = sum(np.cross(at, six[:3]) for at, six in zip(MOUNTS, load.values()))
    volumes = [length * pi * d**2 / 4 for own, *_ in SHAFTS.values() for length, d in own]
    weight = 9.80665 * (MASS + DENSITY * sum(volumes))
    assert force == pytest.approx([0, 0, -weight], rel=1e-10, abs=1e-10 * weight)
    unloaded = train.with_changes(operation=({"torque": 1e-9, "weight": "-z"},))
    own = deflection(Assembly(unloaded), unloaded.operation[0], "euler").mounts.values()
    moment -= sum(np.cross(p, [m.value for m in six[:3]]) for p, six in zip(MOUNTS, own))
    # the left flank's load turns the input about +y, against the engine; two meshes turn it back
    torque = -100.0 * (1 - 57 / 20 * 55 / 18)
    assert moment == pytest.approx([0, torque, 0], abs=1e-10 * abs(torque))


def boxes(train, folder):
    """The train in a rigid housing, and in an elastic one with a spring of the load beside bearings;
    of both a mount with a loss of its own, and the point that it stands at.
    """
    first, *others = train.housing.mounts
    lossy = (first.with_changes(loss=0.25), *others)
    box = train.housing.with_changes(mounts=lossy, points={"foot": MOUNTS[0]})
    yield train.with_changes(housing=box), "foot"
    aside = (
        'stiffness = 90000.0\nat = "b1"',
        "stiffness = 90000.0\nposition = 0.2\nseat_width = 0.01",
    )
    other = sg.load_train(elastic(folder, *lumps(), aside))
    first, *others = other.housing.mounts
    lossy = (first.with_changes(loss=0.25), *others)
    yield other.with_changes(housing=other.housing.with_changes(mounts=lossy)), "foot 1"


def test_lines_of_shafts_are_told_against_a_housing_however_soft_it_stands(train):
    """What teeth and torque do to bearings hangs on no mount; digits are lost to what mounts do."""
    loaded = train.with_changes(operation=({"torque": 100.0},))
    soft = tuple(
        mount.with_changes(stiffness=(np.array(mount.stiffness) / 50).tolist())
        for mount in train.housing.mounts
    )
    boxed = loaded.housing.with_changes(mounts=soft)
    one, other = (
        deflection(Assembly(each), each.operation[0], "euler")
        for each in (loaded, loaded.with_changes(housing=boxed))
    )
    moved = [abs(found.displacement["housing"][2].value) for found in (one, other)]
    assert moved[1] == pytest.approx(50 * moved[0], rel=1e-6)
    for mine, its in zip(one.shafts, other.shafts):
        off = np.abs(mine.line - its.line)[:, :3].max()
        assert off < 1e-9 * moved[1] < 1e-3 * np.abs(mine.line[:, :3]).max()
    assert "are relative to the housing" in one.notes[-1]


def test_what_bearings_mounts_and_inertia_do_to_a_housing_is_in_balance_at_every_frequency(
    train, tmp_path
):
    """Losses included: force for force, by what the response tells."""
    hz = np.array([8.0, 35.0, 240.0, 900.0])
    for boxed, foot in boxes(train, tmp_path):
        drive = Drive(Assembly(boxed), "euler")
        told, mass = drive.columns(hz), boxed.housing.mass
        moved = drive.motion(hz, drive.system.motion(f"housing.{foot}"))[:, 2]
        assert told["mount 1 z [N]"] / moved == pytest.approx(
            np.full(4, SPRING[2] * (1 + 0.25j)), rel=1e-8
        )
        for dof in "xyz":
            ends = [v for n, v in told.items() if " bearing " in n and n.endswith(f" {dof} [N]")]
            mounts = [told[f"mount {n} {dof} [N]"] for n in "123"]
            inertia = mass * told[f"housing centre acceleration {dof} [m/s²]"]
            assert len(ends) == 6
            assert np.abs(sum(ends) + sum(mounts) + inertia).max() < 1e-8 * np.abs(ends).max()
            assert inertia == pytest.approx(
                -mass * (2 * pi * hz) ** 2 * told[f"housing centre {dof} [m]"], rel=1e-12
            )


def test_a_force_on_the_cover_moves_a_gear_as_one_on_the_gear_moves_the_cover(bare):
    assembly = Assembly(bare.with_changes(housing=housing(points={"cover": (0.0, 0.2, 0.3)})))
    ends, hz = (("housing.cover", "z"), ("output.gear", "x")), np.array([30.0, 500.0])
    there, back = (
        receptance(assembly, "euler", from_=a, to=b, frequency_hz=hz).value
        for a, b in (ends, ends[::-1])
    )
    assert there == pytest.approx(back, rel=1e-9) and np.abs(there).min() > 0


@pytest.mark.long
def test_finer_meshes_stay_within_the_bars_of_a_train_in_a_housing(train):
    """Beams of the other shafts are what they are, so that the pinion's solid alone may fall."""
    models = {"input": "harmonic", "middle": "euler", "output": "euler"}
    shops = [
        Assembly(train, kept=8, settings={"harmonic": how})
        for how in ({"order": 2, "layers": 1}, {"order": 4})
    ]
    coarse, fine = (s.system(*models.values()).modes(16).frequency_hz[1:] for s in shops)
    bars = mesh_bars(shops[0], shops[0].system(*models.values()), models, 16)
    error = 1 - fine / coarse  # solved to some 1e-11
    assert (error > -1e-10).all() and (error < bars + 1e-10).all()
    assert error.max() > 0.5 * bars.max()


@pytest.mark.long
def test_mixes_are_judged_where_a_housing_stands_on_nothing(bare):
    """Seven motions at 0 Hz take no part: equal models leave no band."""
    free = bare.with_changes(housing=housing(mounts=()))
    judge = _Judge(Assembly(free, kept=8, settings=COARSE), 800.0)
    assert judge.found.rigid == 7
    assert judge.departure("harmonic").to_hz == np.inf
    assert judge.departure("rigid/harmonic").mode in judge.names[7:]


def test_lumped_shafts_whose_bearings_are_condensed_to_ground_are_refused(train):
    assembly = Assembly(train, settings=COARSE)
    with pytest.raises(SolidgearError, match="lumped shaft .* stand in a housing; use one of"):
        assembly.system("lumped")


@pytest.mark.parametrize(
    "change, said",
    [
        ({"mass": 0.0}, r"housing.mass.*greater than zero"),
        ({"inertia": [1.0, 2.0]}, r"housing.inertia.*three moments"),
        ({"inertia": [1.0, -2.0, 1.5]}, r"housing.inertia.*-2 kg m\^2"),
        ({"inertia": [1.0, 1.0, 3.0]}, "the largest must not be more than the sum of the others"),
        ({"inertia": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}, "not symmetric"),
        ({"carries": ["inptu"]}, r"carries.*no shaft 'inptu'; did you mean"),
        ({"spring": (0.0, 0.0, 0.0)}, "stiffness.*holds nothing"),
        ({"loss": 0.1}, "loss.*belongs to an elastic housing"),
        ({"points": {"centre": (0, 0, 0)}}, "points.centre.*cannot name it"),
    ],
)
def test_a_housing_that_cannot_be_is_refused_in_a_sentence(bare, change, said):
    with pytest.raises(SceneError, match=said) as refused:
        bare.with_changes(housing=housing(**change))
    assert len({one.reason for one in refused.value.problems}) == 1


def test_a_shaft_that_stands_in_a_housing_of_its_own_and_in_that_of_the_train_is_refused():
    train = sg.load_train(GEOMETRY / "axle_overhung.toml")
    with pytest.raises(SceneError, match=r"gear.scene.*\[housing\] of its own"):
        train.with_changes(housing=housing())
    assert train.with_changes(housing=housing(carries=["pinion"])).housed == ("pinion",)


@pytest.mark.long
def test_the_shipped_train_tells_its_housing_by_name(tmp_path):
    path = str(GEOMETRY / "gearbox_housed.toml")
    mix = ["--pinion", "rigid/timoshenko", "--gear", "rigid/timoshenko"]
    modes = json.loads(
        command("system-modes", path, *mix, "--max-frequency", "150", "--json").stdout
    )
    names = [mode["name"] for mode in modes["modes"]]
    assert sum(name.startswith("housing ") for name in names) >= 5
    run = command("response", path, *mix, "--max-frequency", "150", "--out", str(tmp_path))
    page = (tmp_path / "response.html").read_text()
    assert not run.exit_code and "mount rear left force" in page and "housing, rigid" in page
    head = (tmp_path / "response.csv").read_text().partition("\n")[0]
    assert "housing cover acceleration z [m/s²]" in head
