"""Gears of a train as bodies: do teeth fit each other, stand on a body, weigh what their size asks
for, and bear what a torque brings.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import cos, pi, sin, sqrt

from solidgear.scene import Scene
from solidgear.scene.gears import HeadInertia, Pair
from solidgear.scene.layout import ends_of, flanks_from_file
from solidgear.scene.planetary import Stage
from solidgear.scene.tooth_fit import (
    ADDENDUM,
    DEDENDUM,
    ToothFit,
    backlash_cautions,
    fit_cautions,
    fit_of,
    wheel_cautions,
)
from solidgear.scene.train import Train
from solidgear.studies.train.contact import Contact
from solidgear.studies.train.layout import mesh_forces

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
class Wheel:
    """A gear by the numbers of its teeth, at the middle of its face."""

    #: radius, root, tip: of the pitch circle, the root circle and the tip circle, m
    radius: float
    root: float
    tip: float
    #: module, face_width: normal module; the face width is zero where it is not known, m
    module: float
    face_width: float


def wheel_of(pair: Pair, k: int) -> Wheel | None:
    """The first or the second wheel of a pair; None where the file does not tell its size."""
    own = pair.rolling
    wheels = own.pinion, own.gear
    wheel, mate = wheels[k], wheels[1 - k]
    radius = wheel.pitch_radius or (mate.pitch_radius or 0.0) * wheel.teeth / mate.teeth
    if not radius:
        return None
    cone = wheel.pitch_angle
    if cone is None:
        cone = 0.0 if mate.pitch_angle is None else own.mesh.shaft_angle - mate.pitch_angle
    face = wheel.face_width or mate.face_width or 0.0
    radius -= face * sin(cone) / 2
    lean = wheel.spiral_angle or mate.spiral_angle or 0.0
    module = 2 * radius * cos(lean) / wheel.teeth
    if (fit := fit_of(pair)) is not None:
        return Wheel(radius, fit.roots[k], fit.tips[k], fit.module, face)
    root, tip = radius - DEDENDUM * module * cos(cone), radius + ADDENDUM * module * cos(cone)
    return Wheel(radius, root, tip, module, face)


def gear_cautions(train: Train, contacts: Mapping[str, Contact]) -> Iterator[str]:
    """Sentences on gears that cannot be what the file says, or hardly."""
    known: set[tuple[str, str]] = set()
    for k, pair in enumerate(train.pairs):
        of = f"{pair.name}: " if pair.label else ""
        if not _told(train, k):
            yield (
                f"{of}loaded_side is not given: the {pair.pinion.flank} flank of the "
                f"{pair.shafts[0]} is taken to carry; the other one moves numbers where bearings "
                "differ across the shaft"
            )
        if (fit := fit_of(pair)) is not None:
            yield from (of + text for text in backlash_cautions(fit, pair.mesh.backlash))
            yield from (of + text for text in fit_cautions(fit, pair.shafts))
        for which, end in enumerate(zip(pair.shafts, pair.ports)):
            wheel = wheel_of(pair, which)
            if wheel is None or end in known:
                continue
            known.add(end)
            if fit is not None:
                yield from wheel_cautions(fit, which, _called(train, *end))
            yield from _of_gear(train, *end, wheel)
    for stage in train.stages:
        yield from _of_stage(train, stage, known)
    yield from _loads(train, contacts)


def _told(train: Train, k: int) -> bool:
    """Tell whether a file says which flanks of a mesh carry, where the line of action needs them."""
    mesh, ends = train.meshes[k], ends_of(train, k)
    if mesh.shaft_angle or mesh.line_of_action or mesh.contact_cells:
        return True
    pinion, gear = (train.shafts[side].member(port) for side, port in ends)
    return flanks_from_file(train, ends, pinion, gear)[0].flank is not None


def _called(train: Train, side: str, port: str) -> str:
    """A gear in words: its shaft, of several gears with the lumped point."""
    return side if len(train.shafts[side].gears) == 1 else f"{side}.{port}"


def _of_gear(train: Train, side: str, port: str, wheel: Wheel) -> Iterator[str]:
    """Sentences on the body and the head of a gear on a shaft."""
    shaft = train.shafts[side]
    head = shaft.gears[port].head
    called = _called(train, side, port)
    yield from _below(shaft.scene, port, called, wheel, head is not None)
    if head is not None:
        most = wheel.tip / wheel.radius
        yield from _gyration(f"head of the {called}", head, wheel, (LEAST_GYRATION, most))


def _below(scene: Scene, port: str, called: str, wheel: Wheel, head: bool) -> Iterator[str]:
    """Sentence on a body that does not reach up to its teeth, or beyond them."""
    seat = next(s for s in scene.stations if s.name == port)
    here = [s for s in scene.segments if s.y0 <= seat.y <= s.y1]
    body = max(s.radius_at(seat.y)[1] for s in here)
    discs = any(
        m.on == port or (m.on is None and m.lo < seat.hi and m.hi > seat.lo) for m in scene.masses
    )
    if not head and not discs and body < wheel.root - BELOW * wheel.module:
        told = ""
        if wheel.face_width:
            mass = here[0].material.density * pi * (wheel.radius**2 - body**2) * wheel.face_width
            inertia = mass * (wheel.radius**2 + body**2) / 2
            told = f", a ring of {mass:.3g} kg and {inertia:.3g} kg m^2,"
        yield (
            f"the teeth of the {called} roll at {_mm(wheel.radius)} from the axis, and the shaft "
            f"below them ends at {_mm(body)}: what lies between{told} is in no model; correct "
            "teeth or module, make the segment as large, or give the gear a head"
        )
    if body > wheel.tip + ABOVE * wheel.module:
        yield (
            f"the teeth of the {called} end at {_mm(wheel.tip)} from the axis, within the shaft "
            f"there, whose radius is {_mm(body)}; correct teeth, module or the segment"
        )


def _gyration(
    what: str, inertia: HeadInertia, wheel: Wheel, sound: tuple[float, float]
) -> Iterator[str]:
    """Sentence on a body whose inertia or mass is not that of its size."""
    about, across = sqrt(inertia.torsional / inertia.mass), sqrt(inertia.bending / inertia.mass)
    given = f"{inertia.mass:.4g} kg and {inertia.torsional:.4g} kg m^2 of the {what} are"
    check = "check both numbers and their units, and the size of the teeth"
    size = f"its pitch radius is {_mm(wheel.radius)}"
    if not sound[0] <= about / wheel.radius <= sound[1]:
        yield f"{given} a radius of gyration of {_mm(about)}, and {size}; {check}"
    elif not ACROSS[0] <= across / wheel.radius <= ACROSS[1]:
        yield (
            f"{inertia.mass:.4g} kg and {inertia.bending:.4g} kg m^2 across of the {what} are a "
            f"radius of gyration of {_mm(across)}, and {size}; {check}"
        )
    elif wheel.face_width:
        disc = STEEL * pi * wheel.radius**2 * wheel.face_width
        if not MASSES[0] <= inertia.mass / disc <= MASSES[1]:
            yield (
                f"{inertia.mass:.4g} kg of the {what} are {inertia.mass / disc:.2g} times a steel "
                f"disc of its pitch radius and face width, {disc:.3g} kg; {check}"
            )


def _of_stage(train: Train, stage: Stage, known: set[tuple[str, str]]) -> Iterator[str]:
    """Sentences on sun, planets and ring of a planetary stage."""
    teeth, table = stage.teeth, stage.table
    outside = _fit(stage, (teeth.sun, teeth.planet))
    inside = _fit(stage, (teeth.planet, -teeth.ring))
    told = [*fit_cautions(outside, ("sun", "planets")), *fit_cautions(inside, ("planets", "ring"))]
    for fit, k, name in ((outside, 0, "sun"), (outside, 1, "planets"), (inside, 1, "ring")):
        told += wheel_cautions(fit, k, name)
    yield from (f"{stage.called}: {text}" for text in told)
    end = stage.shafts[0], stage.ports[0]
    if end not in known:
        yield from _of_gear(train, *end, _wheel(outside, 0))
    planet = _wheel(outside, 1)
    sound = LEAST_GYRATION, planet.tip / planet.radius
    yield from _gyration(f"planet of {stage.called}", table.planet, planet, sound)
    if table.ring is not None:
        ring = _wheel(inside, 1)
        yield from _gyration(f"ring of {stage.called}", table.ring, ring, RING_GYRATION)


def _fit(stage: Stage, teeth: tuple[int, int]) -> ToothFit:
    """Teeth of two members of a stage, which have no profile shift."""
    sun = stage.sun
    assert sun.module is not None  # a stage is refused without
    helix, pressure = sun.helix_angle or 0.0, stage.table.mesh.pressure_angle
    apart = sun.module * sum(teeth) / (2 * cos(helix))
    return ToothFit(teeth, sun.module, helix, pressure, (0.0, 0.0), apart, sun.face_width or 0.0)


def _wheel(fit: ToothFit, k: int) -> Wheel:
    """The first or the second wheel, which rolls on its reference circle."""
    radius, root, tip = (abs(pair[k]) for pair in (fit.radii, fit.roots, fit.tips))
    return Wheel(radius, root, tip, fit.module, fit.face_width)


def _loads(train: Train, contacts: Mapping[str, Contact]) -> Iterator[str]:
    """Sentences on torques that no teeth bear, of the worst point of each mesh."""
    worst: dict[str, tuple[float, str]] = {}
    for point in train.operation:
        for name, force in mesh_forces(train, contacts, point).items():
            worst[name] = max(worst.get(name, (0.0, "")), (force, point.label))
    wheels = {pair.name: wheel_of(pair, 0) for pair in train.pairs}
    for stage in train.stages:
        wheels[stage.name] = _wheel(_fit(stage, (stage.teeth.sun, stage.teeth.planet)), 0)
    for name, (force, label) in worst.items():
        wheel = wheels[name]
        if wheel is None:
            continue
        face = wheel.face_width or 2 * wheel.radius
        stress = force / (face * wheel.module)
        if stress > STRONG:
            wide = "" if wheel.face_width else ", were it as wide as its pitch circle"
            yield (
                f"{name}: {label} brings {force / 1e3:.4g} kN to its teeth, {1e-6 * stress:.0f} MPa "
                f"of face width times module{wide}, and hardened steel breaks at some "
                f"{1e-6 * STRONG:.0f} MPa; check the torque and its unit, face width and module"
            )


def _mm(length: float) -> str:
    return f"{1e3 * length:.4g} mm"
