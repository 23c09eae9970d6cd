"""What must hold of any contact of real teeth: conditions at random positions, torques, misalignments
and flanks; the reaction of the second wheel; a train that is laid elsewhere.
"""

from functools import lru_cache
from math import cos, radians

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.gears.flank_shape import FlankShape, Relief
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.compliance.slices import HelicalSlices
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.frame import RigidSupports
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.teeth.contact.solver import loads
from solidgear.teeth.supports import Carried, with_sections
from solidgear.teeth.train_teeth import TeethModel, mesh_contact
from validation.teeth_pair import Case
from validation.teeth_pair_train import train_of

FACE, SLICES = 20e-3, 24
STEEL = Elasticity()


@lru_cache
def teeth(helix):
    """Both wheels of 23 and 57 teeth with the compliance of their slices."""
    wheels = WheelPair(
        Wheel(23, 4e-3, radians(helix), face_width=FACE),
        Wheel(57, 4e-3, radians(helix), face_width=FACE),
    )
    first, second = (
        HelicalSlices.of(wheel, FACE, SLICES, bore=wheel.root - 16e-3)
        for wheel in (wheels.first, wheels.second)
    )
    return wheels, (first, second)


def random_pair(generator):
    wheels, compliances = teeth(generator.choice([0.0, 12.0, 30.0]))
    start, stop = wheels.ends
    ends = stop, float(wheels.second_length(start))
    shapes = [
        FlankShape(
            wheels.base_helix,
            FACE,
            tip=Relief(amount, end - length, end),
            crowning=crowning,
        )
        for amount, crowning, length, end in zip(
            10 ** generator.uniform(-7, -4, 2),
            10 ** generator.uniform(-7, -4, 2),
            generator.uniform(1e-3, 8e-3, 2),
            ends,
        )
    ]
    law = LineContact((STEEL, STEEL), (compliances[0].depth, compliances[1].depth))
    return CylindricalPair(wheels, compliances, law, (shapes[0], shapes[1]), SLICES)


def conditions_hold(number):
    generator = np.random.default_rng([7, number])
    pair = random_pair(generator)
    torque = 10 ** generator.uniform(-1, 4)
    tilt = generator.choice([-1, 1]) * 10 ** generator.uniform(-7, np.log10(500e-6)) / FACE
    # about v, across the line of action: one end of the face opens, the other closes
    supports = RigidSupports(np.zeros((6, 6)), np.array([0, 0, 0, 0, tilt, 0]))
    result = loads(pair, torque, generator.uniform(), supports)
    cells = result.cells
    secant, _ = pair.law.compliances(result.line_load, cells.radius, cells.lean)
    apart = pair.bulk(cells) @ result.force + secant / cells.length * result.force
    apart += cells.gap + cells.rows @ supports.motion - cells.lever * result.rotation
    size = abs(result.rotation) * cells.lever.mean() + np.ptp(cells.gap)
    touching = result.force > 0
    assert result.force.min() >= 0
    assert np.abs(apart[touching]).max() <= 1e-9 * size
    assert apart.min() >= -1e-9 * size
    assert cells.lever @ result.force == pytest.approx(torque, rel=1e-12)
    # the second wheel has the opposite force, about its own axis
    wheels = pair.wheels
    angle = wheels.working_angle
    centre = wheels.second.base / cos(angle) * np.array([-np.sin(angle), np.cos(angle), 0.0])
    reaction = np.cross(cells.point - centre, -result.force[:, None] * cells.normal).sum(axis=0)
    assert abs(reaction[2]) == pytest.approx(torque * 57 / 23, rel=1e-12)
    return result.steps


def test_conditions_hold_at_random():
    steps = [conditions_hold(number) for number in range(30)]
    assert max(steps) < 20


@pytest.mark.slow
def test_conditions_hold_at_many_random_positions():
    steps = [conditions_hold(number) for number in range(1002)]
    assert np.median(steps) < 8
    assert max(steps) < 20


def test_a_turned_train_has_the_same_contact(tmp_path):
    """The mesh about its first shaft, at several azimuths; bearings are alike in all directions."""
    train_of(Case(3e5, 20e-6), tmp_path)
    soft = {
        "kxx = 1e12": "kxx = 3e8",
        "kzz = 1e12": "kzz = 3e8",
        "1e9": "1e4",
        '"30 mm"': '"24 mm"',
    }
    text = (tmp_path / "pinion.toml").read_text()
    for usual, other in soft.items():
        text = text.replace(usual, other)
    (tmp_path / "pinion.toml").write_text(text)
    train = sg.load_train(tmp_path / "train.toml")
    cycles = []
    for azimuth in (0.0, 2.2):
        turned = train.with_changes(meshes=(train.meshes[0].with_changes(azimuth=azimuth),))
        carried = Carried.at_rest(with_sections(turned), turned.point)
        contact = mesh_contact(carried, carried.train.pairs[0], TeethModel(slices=8, positions=4))
        cycles.append(contact.cycle)
    assert cycles[0].face_load_factor > 1.05
    turned = cycles[1]
    assert turned.error == pytest.approx(cycles[0].error, rel=1e-9)
    assert turned.tangent == pytest.approx(cycles[0].tangent, rel=1e-8)
    assert turned.face_loads == pytest.approx(cycles[0].face_loads, rel=1e-7)
