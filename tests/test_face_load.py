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


@pytest.mark.parametrize(
    ("loaded_side", "slope", "moved"), [("left", 0.0, 0.2e-6), ("right", 20e-6, 6e-6)]
)
def test_the_factor_is_that_of_contact_on_the_same_beams(loaded_side, slope, moved):
    """Contact has f_sh by sections of the shafts along the face, and where the load lies on it; deflect
    has all load in the middle, so that flanks askew lie off by what their own load moves. The factor
    again by hand.
    """
    train = sg.load_train(GEOMETRY / "gearbox_train.toml")
    pinion = train.pinion.with_changes(helix_slope=slope, loaded_side=loaded_side)
    gear = train.gear.with_changes(helix_slope=slope / 4)  # at the same end: it adds up
    train = train.with_changes(pinion=pinion, gear=gear)
    (load,) = deflection(Assembly(train), train.point, "timoshenko").face_loads
    carried = Carried.at_rest(with_sections(train), train.point)
    pair = carried.train.pairs[0]
    solved = mesh_contact(carried, pair, TeethModel(slices=8, positions=8))
    axis = carried.place(pair, wheels_of(pair, carried.point.coast)).axis
    along = axis @ solved.supports.frame.axes[:, 2]
    assert load.shape == pytest.approx(1.25 * slope * cos(solved.wheels.base_helix), abs=1e-12)
    assert load.shape == pytest.approx(along * solved.skew.shape, abs=1e-12)
    turned = solved.skew.bending + solved.skew.turning
    assert load.skew == pytest.approx(along * turned, abs=moved)
    assert load.line_load == pytest.approx(solved.line_load, rel=1e-6)
    share = abs(load.skew + load.shape) * 0.85 * load.stiffness / (2 * load.line_load)
    assert load.factor == pytest.approx(1 + share if share < 1 else 2 * share**0.5, rel=1e-12)
    assert load.factor == pytest.approx(solved.norm_face_load_factor, rel=0.15)


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
