"""Wheels of the meshes of a train file: what is read, what is assumed, and which way along the face."""

from math import cos, hypot, pi, radians, sin
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SceneError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.stages import mesh_row
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.load.contact import contact

GEOMETRY = Path(__file__).parent.parent / "geometry"
PLAIN = {"pitch_radius": None, "spiral_angle": None, "pitch_angle": None, "scene_load": "added"}
HELIX = radians(15)


@pytest.fixture(scope="module")
def gearbox():
    return sg.load_train(GEOMETRY / "gearbox_train.toml").with_changes(operation=())


def by_module(train, pinion=None, gear=None, **mesh):
    """20 and 57 teeth of 3 mm module at 15 degrees on 50 mm of face."""
    first = PLAIN | {"module": 3e-3, "helix_angle": HELIX} | (pinion or {})
    return train.with_changes(
        pinion=train.pinion.with_changes(**first),
        gear=train.gear.with_changes(**PLAIN, **(gear or {})),
        mesh=train.mesh.with_changes(**mesh),
    )


def test_module_of_a_pitch_radius_and_all_that_a_file_leaves_open(gearbox):
    teeth = wheels_of(gearbox.pairs[0])
    wheels = teeth.wheels
    assert wheels.first.module == pytest.approx(2 * 30e-3 * cos(HELIX) / 20, rel=1e-12)
    assert wheels.distance == pytest.approx(115.5e-3, rel=1e-12)
    assert wheels.face_width == 50e-3 and teeth.is_involute
    words = " ".join(teeth.assumed)
    for word in ("module", "face width of the gear", "ISO 53", "without modification"):
        assert word in words


def test_what_a_file_gives_is_not_assumed(gearbox):
    rack = {"addendum": 1.1, "dedendum": 1.3, "root_radius": 0.3}
    described = {"rack": rack, "crowning": 5e-6}
    train = by_module(gearbox, described, described | {"face_width": 40e-3, "tip_diameter": 0.183})
    teeth = wheels_of(train.pairs[0])
    assert teeth.assumed == ()
    assert teeth.wheels.first.rack.dedendum == 1.3 and teeth.wheels.second.tip == 0.0915
    assert teeth.wheels.face_width == 40e-3 and not teeth.is_involute


def test_bevel_gears_have_no_wheels_of_cylinders():
    assert wheels_of(sg.load_train(GEOMETRY / "axle_overhung.toml").pairs[0]) is None


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("loaded_side", ["right", "left"])
@pytest.mark.parametrize("coast", [False, True])
@pytest.mark.parametrize("apex", [("start", "start"), ("end", "start"), ("start", "end")])
def test_face_places_run_the_way_in_which_a_line_nears_the_first_tips(
    gearbox, hand, loaded_side, coast, apex
):
    """The line of action n lies in the plane of action and across the contact line. Along the axis by
    dy the line stands n_y / n_t dy further from the base circle, against the transverse push n_t on
    the pinion: the axial force, computed apart, says which way.
    """
    other = {"right": "left", "left": "right"}[hand]
    train = by_module(
        gearbox,
        {"hand": hand, "loaded_side": loaded_side, "apex": apex[0]},
        {"hand": other, "apex": apex[1]},
    )
    pair = train.pairs[0]
    vectors = contact(pair, coast)
    # both are the direction of the force on the pinion
    due = np.sign(vectors.pinion.normal[1]), np.sign(vectors.gear.normal[1])
    assert wheels_of(pair, coast).along == due


@pytest.mark.parametrize("apex", [("start", "start"), ("end", "start"), ("end", "end")])
@pytest.mark.parametrize("loaded_side", ["left", "right"])
def test_faces_lie_where_the_file_puts_them(gearbox, apex, loaded_side):
    """Pinion 50 mm about +4 mm, gear 40 mm about -9 mm of its shaft, in one axis by hand."""
    train = by_module(
        gearbox,
        {"face_offset": 4e-3, "apex": apex[0], "loaded_side": loaded_side},
        {"face_offset": -9e-3, "apex": apex[1], "face_width": 40e-3},
    )
    teeth = wheels_of(train.pairs[0])
    ends = [1 if word == "start" else -1 for word in apex]
    faces = [
        (end * offset - width / 2, end * offset + width / 2)
        for end, offset, width in zip(ends, (4e-3, -9e-3), (50e-3, 40e-3))
    ]
    low, high = max(f[0] for f in faces), min(f[1] for f in faces)
    assert teeth.wheels.face_width == pytest.approx(high - low, rel=1e-12)
    for end, middle in zip(ends, teeth.middles):
        assert end * middle == pytest.approx((low + high) / 2, abs=1e-15)
    # crowning is least in the middle of each face
    for k, (end, (start, stop)) in enumerate(zip(ends, faces)):
        z = teeth.along[k] * end * ((start + stop) / 2 - (low + high) / 2)
        assert teeth.shapes[k].middle == pytest.approx(z, abs=1e-15)


@pytest.mark.parametrize("apex", ["start", "end"])
def test_teeth_push_where_both_faces_lie(gearbox, apex):
    """50 mm about +6 mm of the pinion and 40 mm about -9 mm of the gear share -19 to 11 mm: -4 mm of
    both shafts, whose lumped points lie side by side.
    """
    offsets = {"start": (6e-3, -9e-3), "end": (-6e-3, 9e-3)}[apex]
    train = by_module(
        gearbox,
        {"face_offset": offsets[0], "apex": apex},
        {"face_offset": offsets[1], "apex": apex, "face_width": 40e-3},
    )
    vectors, plain = contact(train.pairs[0]), contact(by_module(gearbox).pairs[0])
    due = {"start": -4e-3, "end": 4e-3}[apex]
    for here, there in ((vectors.pinion, plain.pinion), (vectors.gear, plain.gear)):
        assert here.point[1] == pytest.approx(due, abs=1e-15)
        assert abs(here.point[0]) == pytest.approx(abs(there.point[0]), rel=1e-12)
        assert here.lever == pytest.approx(there.lever * np.sign(due) * -1, rel=1e-12)


def test_a_slope_is_missing_at_the_end_of_the_shaft_whatever_flank_carries(gearbox):
    for loaded_side in ("left", "right"):
        for apex in ("start", "end"):
            changes = {"helix_slope": 8e-6, "loaded_side": loaded_side, "apex": apex}
            teeth = wheels_of(by_module(gearbox, changes).pairs[0])
            y = np.array([-25e-3, 25e-3])  # from the middle, along the shaft
            missing = teeth.shapes[0].deviation(10e-3, teeth.along[0] * y)
            assert missing == pytest.approx(
                np.array([-4e-6, 4e-6]) * cos(teeth.wheels.base_helix), rel=1e-12
            )


def test_a_measured_grid_is_turned_round_with_the_face(gearbox):
    grid = {
        "z": (-25e-3, 25e-3),
        "diameter": (58e-3, 66e-3),
        "deviation": ((0.0, 0.0), (0.0, 2e-6)),
    }
    for loaded_side in ("left", "right"):
        changes = {"measured_flank": grid, "loaded_side": loaded_side}
        teeth = wheels_of(by_module(gearbox, changes).pairs[0])
        wheel, (shape, _) = teeth.wheels.first, teeth.shapes
        s = (0.033**2 - wheel.base**2) ** 0.5
        # more material is positive in the file, and a gap below zero
        gap = shape.deviation(s, teeth.along[0] * np.array([-25e-3, 0.0, 25e-3]))
        assert gap == pytest.approx(
            np.array([0.0, -1e-6, -2e-6]) * cos(teeth.wheels.base_helix), abs=1e-18
        )


def test_long_relief_begins_where_a_single_pair_carries(gearbox):
    """From the inner point B and the outer point D of single contact, which lie a base pitch from the
    ends of the path, itself by tips alone.
    """
    relief = {"relief": {"tip": 10e-6, "root": 6e-6}}
    changes = {"helix_angle": 0.0, "hand": None} | relief
    train = by_module(gearbox, changes, {"hand": None} | relief)
    teeth = wheels_of(train.pairs[0])
    pressure, pitch = radians(20), pi * 3e-3 * cos(radians(20))
    rolls = [((1.5e-3 * (z + 2)) ** 2 - (1.5e-3 * z * cos(pressure)) ** 2) ** 0.5 for z in (20, 57)]
    length = 1.5e-3 * 77 * sin(pressure)
    start, stop = length - rolls[1], rolls[0]
    inner, outer = stop - pitch, start + pitch
    first, second = teeth.shapes
    assert first.tip.start == pytest.approx(outer, rel=1e-9)
    assert first.root.start == pytest.approx(inner, rel=1e-9)
    assert second.tip.start == pytest.approx(length - inner, rel=1e-9)
    assert second.root.start == pytest.approx(length - outer, rel=1e-9)
    for shape, roll, wheel in zip(teeth.shapes, rolls, (teeth.wheels.first, teeth.wheels.second)):
        assert shape.deviation(roll, 0.0) == pytest.approx(10e-6, rel=1e-9)
        ends = hypot(wheel.base, shape.root.end)
        assert ends == pytest.approx(wheel.form, rel=1e-12)


def test_relief_begins_at_the_diameter_of_the_file(gearbox):
    train = by_module(gearbox, {"relief": {"tip": 10e-6, "from": 64e-3}})
    shape, wheels = wheels_of(train.pairs[0]).shapes[0], wheels_of(train.pairs[0]).wheels
    assert hypot(shape.tip.start, wheels.first.base) == pytest.approx(32e-3, rel=1e-12)
    assert shape.root is None


def test_planets_mesh_with_the_sun_first_and_with_the_ring_second():
    train = sg.load_train(GEOMETRY / "reducer.toml")
    (stage,) = train.stages
    sun, ring = (wheels_of(mesh) for mesh in stage.together)
    teeth = stage.teeth
    assert (sun.wheels.first.teeth, sun.wheels.second.teeth) == (teeth.sun, teeth.planet)
    assert (ring.wheels.first.teeth, ring.wheels.second.teeth) == (teeth.planet, -teeth.ring)
    for mesh in (sun, ring):
        assert mesh.wheels.distance == pytest.approx(teeth.pin_radius, rel=1e-12)
        assert mesh.wheels.backlash == pytest.approx(0.0, abs=1e-12)
    table = stage.table.with_changes(
        ring_flanks={"crowning": 4e-6}, planet=stage.table.planet.with_changes(crowning=3e-6)
    )
    side, port = stage.shafts[0], stage.ports[0]
    shaft = train.shafts[side]
    wide = shaft.with_changes(gears={**shaft.gears, port: stage.sun.with_changes(face_width=0.03)})
    shafts = {**train.shafts, side: wide}
    changed = train.with_changes(shafts=shafts, planetary={stage.called: table}).stages[0]
    sun, ring = (wheels_of(mesh) for mesh in changed.together)
    assert [s.crowning for s in (*sun.shapes, *ring.shapes)] == [0.0, 3e-6, 3e-6, 4e-6]


@pytest.mark.parametrize(
    ("grid", "words"),
    [
        ({"roll": (1e-3, 2e-3), "diameter": (0.1, 0.2)}, "either roll or diameter"),
        ({"roll": (2e-3, 1e-3)}, "must ascend"),
        ({"roll": (1e-3, 2e-3, 3e-3)}, "must be 2 rows of 3"),
        ({"roll": (1e-3, 2e-3), "deviation": ((5.0, 1.0), (0.0, 0.0))}, "larger than a millimetre"),
        ({"roll": (-1e-3, 2e-3)}, "must not be negative"),
    ],
)
def test_grids_that_are_none_are_refused(gearbox, grid, words):
    plain = {"z": (0.0, 1e-2), "deviation": ((0.0, 0.0), (0.0, 0.0))}
    with pytest.raises(SceneError, match=words):
        gearbox.pinion.with_changes(measured_flank=plain | grid)


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("coast", [False, True])
def test_face_places_of_planets_run_as_the_axial_force_of_their_teeth_says(hand, coast):
    """As of pairs, by the rows of the meshes in the system: they push the first wheel off the other."""
    train = sg.load_train(GEOMETRY / "reducer.toml")
    (stage,) = train.stages
    side, port = stage.shafts[0], stage.ports[0]
    gears = train.shafts[side].gears
    leaning = gears[port].with_changes(helix_angle=radians(12), hand=hand)
    shaft = train.shafts[side].with_changes(gears={**gears, port: leaning})
    assembly = Assembly(train.with_changes(shafts={**train.shafts, side: shaft}))
    assembly = assembly.on_flank(coast)
    system = assembly.system("euler")
    (at_work,) = assembly.stages.values()
    sun, planet = (
        system.port(f"{side}.{port}"),
        system.port(f"{at_work.planets['planet 1']}.centre"),
    )
    axis = sun.axes[:, 1]
    outward = planet.point - sun.point
    outward -= (outward @ axis) * axis
    for mesh, first in zip(at_work.stage.together, (sun, planet)):
        row, _ = mesh_row(system, f"{stage.name} {mesh.mate} 1")
        push = first.axes @ np.linalg.lstsq(first.rows.T, row, rcond=None)[0][:3]
        push *= -np.sign(push @ outward)
        due = np.sign(push @ axis)
        assert wheels_of(mesh, at_work.way < 0).along == (due, due)
