"""Flanks of pairs and planets askew at rest, and the face load factor of the norm by them."""

from math import cos, pi, radians
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.strength.deflection.at_rest import deflection
from solidgear.teeth.supports import Carried, with_sections
from solidgear.teeth.train_teeth import TeethModel, mesh_contact
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.load.operation import Operating

GEOMETRY = Path(__file__).parent.parent / "geometry"
FACE = 12e-3


@pytest.mark.parametrize(("loaded_side", "slope"), [("left", 0.0), ("right", 20e-6)])
def test_the_factor_is_that_of_contact_on_the_same_beams(loaded_side, slope):
    """Contact has f_sh by sections of the shafts along the face, which bend within it, at a sharp slope
    of the flanks too. The factor again by hand.
    """
    train = sg.load_train(GEOMETRY / "gearbox_train.toml")
    pinion = train.pinion.with_changes(helix_slope=slope, loaded_side=loaded_side)
    gear = train.gear.with_changes(helix_slope=slope / 4)  # at the same end: it adds up
    train = train.with_changes(pinion=pinion, gear=gear)
    (load,) = deflection(Assembly(train), train.point, "timoshenko").face_loads
    carried = Carried.at_rest(with_sections(train), train.point)
    pair = carried.train.pairs[0]
    solved = mesh_contact(carried, pair, TeethModel(slices=8, positions=8))
    assert load.shape == pytest.approx(1.25 * slope, abs=1e-12)
    assert load.shape == pytest.approx(solved.skew.shape, abs=1e-12)
    assert load.skew == pytest.approx(solved.skew.bending + solved.skew.turning, abs=0.2e-6)
    assert load.line_load == pytest.approx(solved.line_load, rel=1e-6)
    share = abs(load.skew + load.shape) * 0.85 * load.stiffness / (2 * load.line_load)
    assert load.factor == pytest.approx(1 + share if share < 1 else 2 * share**0.5, rel=1e-12)


@pytest.fixture(scope="module")
def reducer():
    train = sg.load_train(GEOMETRY / "reducer.toml")
    (stage,) = train.stages
    shaft = train.shafts["wheel"]
    gears = {**shaft.gears, "sun": shaft.gears["sun"].with_changes(face_width=FACE)}
    train = train.with_changes(shafts={**train.shafts, "wheel": shaft.with_changes(gears=gears)})
    assembly = Assembly(train)
    return assembly, deflection(assembly, train.point, "timoshenko")


def test_every_planet_lies_askew_by_the_tilts_of_sun_carrier_and_planet(reducer):
    """The lines of action of a planet at the azimuth psi, by geometry: of the sun's mesh the tangent
    leans by the pressure angle away from it, of the ring's mesh towards it.
    """
    assembly, solved = reducer
    (stage,) = assembly.stages.values()
    state = Operating(assembly, "timoshenko").at(assembly.train.point)
    system = state.system
    named = {m.name: m.value for m in solved.misalignment}
    axis = system.port("wheel.sun").axes[:, 1]

    def tilt(end):
        return system.motion(end)[3:] @ state.coordinates

    sun = system.port("wheel.sun").axes @ tilt("wheel.sun")
    for k, name in enumerate(stage.planets.values(), 1):
        end = f"{name}.centre"
        out = system.port(end).point - system.port("wheel.sun").point
        out -= (out @ axis) * axis
        out /= np.linalg.norm(out)
        planet = system.port(end).axes @ tilt(end)
        tangent = np.cross(axis, out) * stage.way
        alpha = radians(20)
        for mate, first, second, way in (("sun", sun, planet, -1), ("ring", planet, 0 * sun, 1)):
            # pushed off: a sun away from its planet and back, a planet off the ring and on
            normal = way * tangent * cos(alpha) - out * np.sin(alpha)
            slope = np.cross(first - second, axis)
            due = normal @ slope
            assert named[f"in plane stage {mate} {k}"] == pytest.approx(due, rel=1e-9)


def test_a_sun_is_wound_up_by_all_planets(reducer):
    """T b / (2 G J) of the torque of three planets, at the lever of one; the end far from the wheel,
    which drives the sun, stands back.
    """
    assembly, solved = reducer
    named = {m.name: m.value for m in solved.misalignment}
    scene = assembly.scenes["wheel"]
    places = {port.name: port.y for port in scene.ports}
    y, away = places["sun"], np.sign(places["sun"] - places["wheel"])
    segment = scene.segments_at(y)[0]
    shear = segment.material.E / (2 * (1 + segment.material.nu))
    base = 17 * 1.25e-3 / 2 * cos(radians(20))
    torque = sum(
        load.line_load * FACE * base for load in solved.face_loads if "sun" in load.mesh
    )  # a spur gear
    assert torque == pytest.approx(4.0 * 25 / 15, rel=1e-6)
    inner, outer = segment.radius_at(y)
    twist = torque * FACE / (2 * shear * pi / 2 * (outer**4 - inner**4))
    for k in (1, 2, 3):
        assert named[f"wind-up stage sun {k}"] == pytest.approx(away * base * twist, rel=1e-6)
        assert named[f"wind-up stage ring {k}"] == 0.0
    assert [load.mesh for load in solved.face_loads] == [
        f"mesh stage {mate} {k}" for mate in ("sun", "ring") for k in (1, 2, 3)
    ]


@pytest.fixture(scope="module")
def floating():
    """The reducer at rest with a sun that floats on a shaft of 8 mm, planets on stiff pins, teeth as stiff
    in its file as they are, the sun's flanks askew by a micrometre.
    """
    train = sg.load_train(GEOMETRY / "reducer.toml")
    shaft, stage = train.shafts["wheel"], train.planetary["stage"]
    springs = {"kxx": 1e9, "kyy": 1e8, "kzz": 1e9}
    bearings = tuple(
        sg.Bearing(name=b.name, y=b.y, seat_width=b.seat_width, stiffness=springs)
        for b in shaft.scene.bearings
    )
    segments = tuple(
        segment.with_changes(outer0=4e-3, outer1=4e-3) if segment.name == "between" else segment
        for segment in shaft.scene.segments
    )
    scene = shaft.scene.with_changes(bearings=bearings, segments=segments)
    sun = shaft.gears["sun"].with_changes(face_width=FACE, helix_slope=1e-6)
    wheel = shaft.with_changes(gears={**shaft.gears, "sun": sun}, scene=scene)
    planet = stage.planet.with_changes(pin={"radial": 1e8, "axial": 2e7, "tilting": 1e6})
    mesh = stage.mesh.with_changes(sun_stiffness=2.32e8, ring_stiffness=3.54e8)
    train = train.with_changes(
        shafts={**train.shafts, "wheel": wheel},
        planetary={"stage": stage.with_changes(mesh=mesh, planet=planet)},
    )
    carried = Carried.at_rest(with_sections(train), train.point)
    quick = TeethModel(slices=12, positions=8)
    meshes = carried.train.stages[0].meshes
    return train, carried, {m.name: (m, mesh_contact(carried, m, quick)) for m in meshes}


def test_planets_lie_askew_in_contact_as_in_deflect(floating):
    """Each under its own force, f_sh with the moment of its two half springs once: rings to rounding, the
    sun but for bending within its face, 3 % of the largest.
    """
    train, carried, contacts = floating
    solved = deflection(Assembly(train), train.point, "timoshenko")
    by_name = {load.mesh: load for load in solved.face_loads}
    largest = max(abs(load.skew) for load in by_name.values())
    for name, (_, contact) in contacts.items():
        load, turned = by_name[name], contact.skew.bending + contact.skew.turning
        assert turned == pytest.approx(load.skew, abs=(1e-5 if "ring" in name else 0.03) * largest)
        assert contact.line_load == pytest.approx(load.line_load, rel=1e-6)
    shares = [contact.cycle.force for _, contact in contacts.values()]
    mean = carried.state.mesh_forces["mesh stage"]
    assert sum(shares) == pytest.approx(6 * mean, rel=1e-6)
    assert max(shares) > 1.02 * mean  # the bevel gear pushes the sun aside


def test_a_floating_sun_has_the_face_load_factors_of_springs_along_every_face(floating):
    """All planets at once on springs along their faces, in place of the teeth of the sun, which do not
    pull: they are not joined along the face as teeth are, which is worth 3 to 6 % here.
    """
    _, carried, contacts = floating
    suns = [(mesh, contact) for name, (mesh, contact) in contacts.items() if "sun" in name]
    strains, places = carried.system.strains
    stiffness = strains.T @ strains
    load, faces = stiffness @ carried.state.coordinates, []
    z = ((np.arange(24) + 0.5) / 24 - 0.5) * FACE
    for mesh, contact in suns:
        own = strains[places[mesh.name]]
        frame, names = contact.supports.frame, []
        for end in carried.place(mesh, wheels_of(mesh, carried.coast(mesh))).ends:
            names += carried.sections(end, frame)
        ports = [carried.system.port(name) for name in names]
        moved = np.vstack([np.kron(np.eye(2), port.axes) @ port.rows for port in ports])
        points = np.column_stack([np.zeros((24, 2)), z])
        normals = np.tile(contact.cycle.positions[0].cells.normal[0], (24, 1))
        rows = contact.supports.opening(points, normals) @ moved
        gaps = contact.along * contact.skew.shape * z / FACE
        stiffness -= own.T @ own
        faces.append((rows, gaps))
    spring, rows, gaps = 2.32e8 / 24, *map(np.concatenate, zip(*faces))
    carry = np.ones(len(gaps), bool)
    for _ in range(20):  # springs do not pull
        pressed = spring * rows[carry].T
        whole, total = stiffness + pressed @ rows[carry], load - pressed @ gaps[carry]
        motion = np.linalg.lstsq(whole, total, rcond=1e-13)[0]
        pushing = rows @ motion + gaps < 0
        if (pushing == carry).all():
            break
        carry = pushing
    assert (pushing == carry).all() and not carry.all()
    for (_, contact), forces in zip(suns, np.split(-spring * (rows @ motion + gaps) * carry, 3)):
        assert contact.cycle.force == pytest.approx(forces.sum(), rel=0.01)
        assert contact.cycle.face_load_factor == pytest.approx(
            forces.max() / forces.mean(), rel=0.1
        )
