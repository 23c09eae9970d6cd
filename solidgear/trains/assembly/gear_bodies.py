"""Checks of the gears of a train as bodies: whether teeth fit each other, stand on a body, weigh as
their size demands, and bear the torque.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import cos, pi, sin, sqrt

from solidgear.core import Scene
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.trains.assembly.layout import mesh_forces
from solidgear.trains.file.gears import HeadInertia
from solidgear.trains.file.layout import ends_of, flanks_from_file
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import Stage
from solidgear.trains.file.tooth_fit import (
    backlash_cautions,
    fit_cautions,
    fit_of,
    wheel_cautions,
    wheels_in,
)
from solidgear.trains.file.train import Train
from solidgear.trains.load.contact import Contact

#: modules by which a body may end below the roots of its teeth, as a blank drawn without them, or
#: above their tips
BELOW, ABOVE = 1.0, 0.5
#: radius of gyration of a gear over its pitch radius: a hub as heavy as a rim has 0.4, and a slip of
#: 1000 in a unit leaves less than 0.04 of a sound one
LEAST_GYRATION = 0.15
#: the same of a ring, which has its mass outside of its teeth, and flanges further out
RING_GYRATION = (0.3, 3.0)
#: radius of gyration about a diameter over the pitch radius: of a thin disc 0.5, of a long hub 2
ACROSS = (0.1, 6.0)
#: mass over that of a steel disc of pitch radius and face width, and density of steel, kg/m^3
MASSES, STEEL = (0.01, 30.0), 7850.0
#: Pa, force over face width and module: case-hardened teeth break at some 600 MPa at rest (ISO 6336)
STRONG = 500e6


@dataclass(frozen=True)
class GearSize:
    """A gear by the numbers of its teeth, at the middle of the face."""

    #: radius, root, tip: of the pitch circle, the root circle and the tip circle, m
    radius: float
    root: float
    tip: float
    #: module, face_width: normal module; the face width is zero where it is not known, m
    module: float
    face_width: float

    @classmethod
    def of(cls, wheel: Wheel) -> GearSize:
        """Return the size of a wheel that rolls on its reference circle."""
        return cls(wheel.radius, wheel.root, wheel.tip, wheel.module, wheel.face_width)


def size_of(pair: Pair, k: int) -> GearSize | None:
    """Return the first or the second wheel of a pair; None where the file does not give the size."""
    rolling = pair.rolling
    wheels = rolling.pinion, rolling.gear
    wheel, mate = wheels[k], wheels[1 - k]
    radius = wheel.pitch_radius or (mate.pitch_radius or 0.0) * wheel.teeth / mate.teeth
    if not radius:
        return None
    cone = wheel.pitch_angle
    if cone is None:
        cone = 0.0 if mate.pitch_angle is None else rolling.mesh.shaft_angle - mate.pitch_angle
    face = wheel.face_width or mate.face_width or 0.0
    radius -= face * sin(cone) / 2
    lean = wheel.spiral_angle or mate.spiral_angle or 0.0
    module = 2 * radius * cos(lean) / wheel.teeth
    if (fit := fit_of(pair)) is not None:
        sized = wheels_in(fit)[k]
        return GearSize(radius, sized.root, sized.tip, sized.module, face)
    rack, height = Rack(), module * cos(cone)
    root, tip = radius - rack.dedendum * height, radius + rack.addendum * height
    return GearSize(radius, root, tip, module, face)


def gear_cautions(train: Train, contacts: Mapping[str, Contact]) -> Iterator[str]:
    """Yield sentences on gears that cannot be as the file describes them, or hardly."""
    checked: set[tuple[str, str]] = set()
    for k, pair in enumerate(train.pairs):
        prefix = f"{pair.name}: " if pair.label else ""
        if not _flank_is_given(train, k):
            yield (
                f"{prefix}loaded_side is not given: the {pair.pinion.flank} flank of the "
                f"{pair.shafts[0]} is taken to carry; the other flank gives other numbers where "
                "bearings differ between x and z"
            )
        if (fit := fit_of(pair)) is not None:
            yield from (prefix + text for text in backlash_cautions(fit, pair.mesh.backlash))
            yield from (prefix + text for text in fit_cautions(fit, pair.shafts))
        for member, (side, port) in enumerate(zip(pair.shafts, pair.ports)):
            wheel = size_of(pair, member)
            if wheel is None or (side, port) in checked:
                continue
            checked.add((side, port))
            if fit is not None:
                yield from wheel_cautions(wheels_in(fit)[member], _gear_label(train, side, port))
            yield from _gear_on_shaft(train, side, port, wheel)
    for stage in train.stages:
        yield from _stage_cautions(train, stage, checked)
    yield from _load_cautions(train, contacts)


def _flank_is_given(train: Train, k: int) -> bool:
    """Check whether a file names the flanks of a mesh that carry, where the line of action needs
    them.
    """
    mesh, ends = train.meshes[k], ends_of(train, k)
    if mesh.shaft_angle or mesh.line_of_action or mesh.contact_cells:
        return True
    pinion, gear = (train.shafts[side].member(port) for side, port in ends)
    return flanks_from_file(train, ends, pinion, gear)[0].flank is not None


def _gear_label(train: Train, side: str, port: str) -> str:
    """Return a gear in words: the shaft, of several gears with the lumped point."""
    return side if len(train.shafts[side].gears) == 1 else f"{side}.{port}"


def _gear_on_shaft(train: Train, side: str, port: str, wheel: GearSize) -> Iterator[str]:
    """Yield sentences on the body and the head of a gear on a shaft."""
    shaft = train.shafts[side]
    head = shaft.gears[port].head
    label = _gear_label(train, side, port)
    yield from _body_below_teeth(shaft.scene, port, label, wheel, head is not None)
    if head is not None:
        tip_ratio = wheel.tip / wheel.radius
        yield from _gyration(f"head of the {label}", head, wheel, (LEAST_GYRATION, tip_ratio))


def _body_below_teeth(
    scene: Scene, port: str, label: str, wheel: GearSize, head: bool
) -> Iterator[str]:
    """Yield a sentence on a body that ends below the roots of the teeth, or beyond their tips."""
    seat = next(s for s in scene.stations if s.name == port)
    segments = scene.segments_at(seat.y)
    body = max(s.radius_at(seat.y)[1] for s in segments)
    discs = any(
        m.on == port or (m.on is None and m.lo < seat.hi and m.hi > seat.lo) for m in scene.masses
    )
    if not head and not discs and body < wheel.root - BELOW * wheel.module:
        ring = ""
        if wheel.face_width:
            mass = (
                segments[0].material.density * pi * (wheel.radius**2 - body**2) * wheel.face_width
            )
            inertia = mass * (wheel.radius**2 + body**2) / 2
            ring = f", a ring of {mass:.3g} kg and {inertia:.3g} kg m^2,"
        yield (
            f"the teeth of the {label} roll at {_mm(wheel.radius)} from the axis, but the shaft "
            f"ends at {_mm(body)}: the material between{ring} is in no model; correct teeth or "
            "module, make the segment as large, or give the gear a head"
        )
    if body > wheel.tip + ABOVE * wheel.module:
        yield (
            f"the teeth of the {label} end at {_mm(wheel.tip)} from the axis, within the shaft "
            f"there, whose radius is {_mm(body)}; correct teeth, module or the segment"
        )


def _gyration(
    name: str, inertia: HeadInertia, wheel: GearSize, sound: tuple[float, float]
) -> Iterator[str]:
    """Yield a sentence on a body whose inertia or mass does not fit the size."""
    about, across = sqrt(inertia.torsional / inertia.mass), sqrt(inertia.bending / inertia.mass)
    start = f"{inertia.mass:.4g} kg and {inertia.torsional:.4g} kg m^2 of the {name} are"
    check = "check both numbers and their units, and the size of the teeth"
    size = f"its pitch radius is {_mm(wheel.radius)}"
    if not sound[0] <= about / wheel.radius <= sound[1]:
        yield f"{start} a radius of gyration of {_mm(about)}, and {size}; {check}"
    elif not ACROSS[0] <= across / wheel.radius <= ACROSS[1]:
        yield (
            f"{inertia.mass:.4g} kg and {inertia.bending:.4g} kg m^2 across of the {name} are a "
            f"radius of gyration of {_mm(across)}, and {size}; {check}"
        )
    elif wheel.face_width:
        disc = STEEL * pi * wheel.radius**2 * wheel.face_width
        if not MASSES[0] <= inertia.mass / disc <= MASSES[1]:
            yield (
                f"{inertia.mass:.4g} kg of the {name} are {inertia.mass / disc:.2g} times a steel "
                f"disc of its pitch radius and face width, {disc:.3g} kg; {check}"
            )


def _stage_cautions(train: Train, stage: Stage, checked: set[tuple[str, str]]) -> Iterator[str]:
    """Yield sentences on sun, planets and ring of a planetary stage."""
    table = stage.table
    outside, inside = _stage_fits(stage)
    sentences = [
        *fit_cautions(outside, ("sun", "planets")),
        *fit_cautions(inside, ("planets", "ring")),
    ]
    wheels = {"sun": outside.first, "planets": outside.second, "ring": inside.second}
    for name, wheel in wheels.items():
        sentences += wheel_cautions(wheel, name)
    yield from (f"{stage.called}: {text}" for text in sentences)
    sun, port = stage.shafts[0], stage.ports[0]
    if (sun, port) not in checked:
        yield from _gear_on_shaft(train, sun, port, GearSize.of(outside.first))
    planet = GearSize.of(outside.second)
    sound = LEAST_GYRATION, planet.tip / planet.radius
    yield from _gyration(f"planet of {stage.called}", table.planet, planet, sound)
    if table.ring is not None:
        ring = GearSize.of(inside.second)
        yield from _gyration(f"ring of {stage.called}", table.ring, ring, RING_GYRATION)


def _stage_fits(stage: Stage) -> tuple[WheelPair, WheelPair]:
    """Return the wheels of a planet with the sun, and with the ring."""
    sun, ring = (wheels_of(mesh) for mesh in stage.together)
    assert sun is not None and ring is not None  # a stage is refused without a module
    return sun.wheels, ring.wheels


def _load_cautions(train: Train, contacts: Mapping[str, Contact]) -> Iterator[str]:
    """Yield sentences on torques that no teeth bear, at the worst operating point of each mesh."""
    worst: dict[str, tuple[float, str]] = {}
    for point in train.operation:
        for name, force in mesh_forces(train, contacts, point).items():
            worst[name] = max(worst.get(name, (0.0, "")), (force, point.label))
    wheels = {pair.name: size_of(pair, 0) for pair in train.pairs}
    for stage in train.stages:
        wheels[stage.name] = GearSize.of(_stage_fits(stage)[0].first)
    for name, (force, label) in worst.items():
        wheel = wheels[name]
        if wheel is None:
            continue
        face = wheel.face_width or 2 * wheel.radius
        stress = force / (face * wheel.module)
        if stress > STRONG:
            width_note = "" if wheel.face_width else ", were it as wide as its pitch circle"
            yield (
                f"{name}: {label} brings {force / 1e3:.4g} kN to its teeth, {1e-6 * stress:.0f} MPa "
                f"of face width times module{width_note}, and hardened steel breaks at some "
                f"{1e-6 * STRONG:.0f} MPa; check the torque and its unit, face width and module"
            )


def _mm(length: float) -> str:
    return f"{1e3 * length:.4g} mm"
