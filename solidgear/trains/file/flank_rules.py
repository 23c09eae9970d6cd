"""Rules for racks, tips, faces and flanks of cylindrical gears, one sentence for each problem."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import cos, pi, sin, tan

from solidgear.core import SceneError
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.core.scene.units import TYPED
from solidgear.trains.file.flanks import Flanks, MeasuredFlank, ReliefTable, radius_at, roll_length
from solidgear.trains.file.gears import Member
from solidgear.trains.file.lengths import in_mm
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import Stage
from solidgear.trains.file.tables import TEETH
from solidgear.trains.file.tip_rules import pointed_problem, tip_problems

#: keys that say how much is missing, all along the face
ALONG_FACE = ("crowning", "helix_slope")
#: least share of a face that lies on its shaft
LEAST_ON_SHAFT = 0.5


def flank_problems(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of two gears that mesh, with paths from ``pinion``, ``gear`` or ``mesh``."""
    gears, solves = pair.members, pair.mesh.stiffness == TEETH
    if solves and not any(gear.face_width for gear in gears.values()):
        yield _needed("face_width")
    if pair.mesh.shaft_angle:
        return
    for side, gear in gears.items():
        yield from _off_shaft(gear, (side,))
    described = [side for side, gear in gears.items() if gear.is_described]
    try:
        teeth = wheels_of(pair)
        if teeth is not None:
            _ = teeth.wheels.distance
    except SceneError:
        return  # told with the fit of the teeth
    if teeth is None and solves:
        yield _needed("module")
    elif teeth is None and described:
        side = described[0]
        key = next(k for k in Flanks.model_fields if getattr(gears[side], k))
        yield SceneError("needs teeth of a size; give the module", path=(side, key))
    if teeth is None:
        return
    wheels = teeth.wheels
    if not (solves or described):
        pointed = [
            pointed_problem(wheel, gears[side], (side,))
            for side, wheel in zip(gears, (wheels.first, wheels.second))
        ]
        yield from filter(None, pointed)
        return
    problems = [
        problem
        for k, side in enumerate(gears)
        for problem in _wheel(wheels, k, gears[side], (side,))
    ]
    problems = problems or [*_reach(wheels, gears)]
    yield from problems or tip_problems(pair, wheels, solves)
    yield from _faces(wheels, [(side, "face_offset") for side in gears])


def stage_flank_problems(stage: Stage) -> Iterator[SceneError]:
    """Yield problems of a planetary stage, with paths below its table."""
    table, sun = stage.table, stage.sun
    if TEETH in (table.mesh.sun_stiffness, table.mesh.ring_stiffness) and not sun.face_width:
        yield SceneError(
            f"the sun, {'.'.join((stage.shafts[0], stage.ports[0]))}, needs its face_width where "
            f'teeth give a stiffness (stiffness = "{TEETH}")',
            path=("sun",),
        )
    yield from _off_shaft(sun, ("sun",))
    flanks = {
        ("sun",): (sun, 0, 0),
        ("planet",): (table.planet, 0, 1),
        ("ring_flanks",): (table.ring_flanks or Flanks(), 1, 1),
    }
    meshes = [wheels_of(mesh) for mesh in stage.together]
    problems: list[SceneError] = []
    for path, (wheel_flanks, number, k) in flanks.items():
        teeth = meshes[number]
        if teeth is not None and wheel_flanks.is_described:
            problems += _wheel(teeth.wheels, k, wheel_flanks, path)
    for mesh, teeth in zip(stage.together, meshes):
        solved = getattr(table.mesh, f"{mesh.mate}_stiffness") == TEETH
        if teeth is not None and not problems:
            yield from tip_problems(mesh, teeth.wheels, solved)
    yield from problems
    planet = meshes[1] and meshes[1].wheels.first
    if planet and table.planet.is_described and 2 * planet.tip >= stage.teeth.spacing:
        yield SceneError(
            f"lets planets overlap: their tips are {in_mm(2 * planet.tip)} across, their axes "
            f"{in_mm(stage.teeth.spacing)} apart",
            path=("planet", "tip_diameter" if table.planet.tip_diameter else "rack"),
        )
    for teeth, member in zip(meshes, ("planet", "ring_flanks")):
        if teeth is not None:
            yield from _faces(teeth.wheels, [(member, "face_offset")])


def _needed(key: str) -> SceneError:
    reason = f'is missing; stiffness = "{TEETH}" under [mesh] needs it'
    return SceneError(reason, path=("pinion", key))


def _reach(wheels: WheelPair, gears: Mapping[str, Flanks]) -> Iterator[SceneError]:
    """Yield a problem of given tips that do not reach each other."""
    given = [side for side, gear in gears.items() if gear.tip_diameter]
    if given and wheels.contact_ratio <= 0:
        yield SceneError(
            f"is too small: tips at {in_mm(wheels.first.tip)} and {in_mm(wheels.second.tip)} do not "
            f"reach each other, with axes {in_mm(wheels.distance)} apart; correct it or leave it out",
            path=(given[0], "tip_diameter"),
        )


def _off_shaft(gear: Member, path: tuple) -> Iterator[SceneError]:
    """Yield a problem of a gear that is part of its shaft, with less than half of its face on it."""
    scene, width = gear.scene, gear.face_width
    if gear.head is not None or not width:
        return
    middle = scene.port.y + gear.face_offset
    start, end = max(middle - width / 2, 0.0), min(middle + width / 2, scene.length)
    if end - start < LEAST_ON_SHAFT * width:
        yield SceneError(
            f"puts {in_mm(max(end - start, 0.0))} of the face on the shaft, which is "
            f"{in_mm(scene.length)} long, with the middle of the face at {in_mm(middle)}; correct "
            "face_width, face_offset or the place of the gear",
            path=(*path, "face_width"),
        )


def _faces(wheels: WheelPair, paths: list[tuple]) -> Iterator[SceneError]:
    """Yield a problem of faces that do not overlap."""
    if min(wheels.first.face_width, wheels.second.face_width) > 0 >= wheels.face_width:
        yield SceneError(
            f"puts the middles of the faces {in_mm(abs(wheels.offset))} apart, so that "
            f"{in_mm(wheels.first.face_width)} and {in_mm(wheels.second.face_width)} of face share "
            "nothing; correct the offset",
            path=paths[-1],
        )


def _wheel(wheels: WheelPair, k: int, flanks: Flanks, path: tuple) -> Iterator[SceneError]:
    """Yield problems of the first or the second wheel."""
    wheel = (wheels.first, wheels.second)[k]
    if problem := _rack(wheel):
        yield problem.located(None, path=(*path, "rack", "root_radius"))
        return
    if wheel.sign * (wheel.tip - wheel.form) <= 0:
        yield SceneError(
            f"leaves no flank: flanks begin at a diameter of {in_mm(2 * wheel.form)}",
            path=(*path, "tip_diameter" if flanks.tip_diameter else "rack"),
        )
        return
    if problem := pointed_problem(wheel, flanks, path):
        yield problem
        return
    for key in ALONG_FACE:
        amount = abs(getattr(flanks, key))
        if amount and not wheel.face_width:
            yield SceneError("needs the face_width, over which it counts", path=(*path, key))
        elif problem := _too_deep(wheel, amount):
            yield problem.located(None, path=(*path, key))
    if flanks.relief is not None:
        for problem in _relief(wheel, flanks.relief):
            yield problem.located(None, path=(*path, "relief", *problem.path))
    if flanks.measured_flank is not None:
        for problem in _measured(wheel, flanks.measured_flank):
            yield problem.located(None, path=(*path, "measured_flank", *problem.path))


def _rack(wheel: Wheel) -> SceneError | None:
    """Return a problem of a corner that does not fit between the flanks of its rack."""
    angle, rack = wheel.transverse_angle, wheel.rack
    between = pi / (4 * cos(wheel.helix_angle)) - rack.dedendum * tan(angle)
    most = between * cos(angle) / (1 - sin(angle))
    if rack.root_radius <= most or wheel.sign < 0:
        return None
    return SceneError(
        f"does not fit between the flanks of the rack, {max(most, 0):.3g} modules at most with a "
        f"dedendum of {rack.dedendum:g}; correct one of them"
    )


def _too_deep(wheel: Wheel, amount: float) -> SceneError | None:
    """Return a problem of both flanks losing more than the tooth is thick at its tip."""
    half = wheel.tip_thickness / 2
    if amount <= max(half, 0.0) or not amount:
        return None
    return SceneError(
        f"is deeper than half the tooth, {in_mm(max(half, 0.0))} at its tip; check the value and its "
        'unit, such as "10 um"'
    )


def _relief(wheel: Wheel, table: ReliefTable) -> Iterator[SceneError]:
    """Yield problems of the relief of tip and root, with paths below its table."""
    low, high = sorted((wheel.form, wheel.tip))
    ends = (
        ("tip", "from", table.tip, table.from_),
        ("root", "root_from", table.root, table.root_from),
    )
    for key, start_key, amount, start in ends:
        if problem := _too_deep(wheel, amount):
            yield problem.located(None, path=(key,))
        if start is not None and not amount:
            yield SceneError(f"needs {key}, how much is missing", path=(start_key,))
        elif start is not None and not low < start / 2 < high:
            yield SceneError(
                f"lies off the flank, whose diameters go from {in_mm(2 * low)} to {in_mm(2 * high)}; "
                "correct it or leave it out",
                path=(start_key,),
            )


def _measured(wheel: Wheel, table: MeasuredFlank) -> Iterator[SceneError]:
    """Yield problems of a grid that does not lie on the flank, with paths below its table."""
    furthest = max(abs(table.z[0]), abs(table.z[-1]))
    if furthest > (1 + TYPED) * wheel.face_width / 2:
        yield SceneError(
            f"reaches {in_mm(furthest)} from the middle of a face that is {in_mm(wheel.face_width)} wide; "
            "z counts from the middle, in metres",
            path=("z",),
        )
    key = "roll" if table.roll else "diameter"
    heights = table.roll or tuple(roll_length(d / 2, wheel.base) for d in table.diameter)
    ends = sorted(roll_length(r, wheel.base) for r in (wheel.form, wheel.tip))
    if heights[0] >= ends[1] or heights[-1] <= ends[0]:
        size = [in_mm(end) for end in ends]
        if key == "diameter":
            size = [in_mm(2 * radius_at(end, wheel.base)) for end in ends]
        yield SceneError(
            f"lies off the flank, which goes from {size[0]} to {size[1]}; write metres", path=(key,)
        )
