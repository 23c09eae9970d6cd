"""Contact of the teeth of a train, on both shafts: the mesh point, and the line of action. The mesh
is made from the pinion's numbers; those of a gear that is described as well can only agree or
contradict.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import cos, sin

import numpy as np

from solidgear.core import SceneError, SolidgearError, rotation
from solidgear.core.gears.wheel import Wheel
from solidgear.core.scene.acting import station_loads
from solidgear.core.system.contact_cells import ContactWrench, contact_wrench
from solidgear.core.system.gear_mesh import (
    MeshVector,
    line_of_action,
    mean_radius,
    mesh_point,
    to_gear_frame,
)
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.tables import solved

#: a typed line of action with six digits
UNIT = 1e-6
#: lever arms off the ratio of the teeth by this give a caution, by that they are refused
LEVER_TOLD, LEVER_REFUSED = 5e-3, 5e-2
#: pitch angles whose tangents are off the ratio of the teeth by this give a caution
CONE_TOLD = 2e-2
#: and of pitch angles below this, rad, of this: those of parallel shafts are zero
LEAST_CONE = 0.05
#: a head whose radius changes by less than this of its length is no pitch cone
CONE_SEEN = 0.02
#: needs gear geometry although the line of action is given
WITHOUT_POSITION = "the place of the gear, without gear_position under [mesh],"
#: a line that is this much nearer (cosine) to the one of the teeth when it is turned back was
#: given in the gear's frame
TURNED = 0.2
#: the mesh point may lie outside the head by this share of its radius and of its length
OUTSIDE_RADIUS, OUTSIDE_LENGTH = 0.02, 0.5
#: a [load] of a scene that is this far off the line of action gives a caution, rad: more than friction and
#: another pressure angle make
LOAD_ASIDE = np.radians(20.0)
#: which of the pinion's data geometry needs
GEOMETRY = ("hand", "loaded_side", "pitch_radius", "pitch_angle", "spiral_angle", "face_width")
#: how parallel shafts call them
CYLINDRICAL = {"spiral_angle": "helix_angle", "pitch_radius": "module"}
#: flanks of bevel gears, which say which side they face together with a hand
CURVED = ("concave", "convex")
#: pressure angle to judge a given line with, where the file has none
USUAL_PRESSURE_ANGLE = np.radians(20.0)
#: relative, of pitch radii, and rad, of angles: a caution from the first on, refused from the second on;
#: the first is left by rounding to three digits
RADII, ANGLES = (5e-3, 5e-2), (1e-2, 5e-2)
#: of face widths: a pinion is made wider by a possible shift in assembly, some tenth
FACES = 0.25


@dataclass(frozen=True, eq=False)
class Contact:
    """The mesh on both shafts, each vector in the axes of that shaft's scene."""

    #: pinion, gear: points from each lumped point
    pinion: MeshVector
    gear: MeshVector
    #: N/m, ``teeth`` where their contact gives it
    file_stiffness: float | str
    origin: np.ndarray  #: (3,) the gear's lumped point from the pinion's, in the pinion's frame, m
    wrench: ContactWrench | None  #: of contact cells
    cautions: tuple[str, ...]  #: on data that do not fit together but can be solved

    @property
    def stiffness(self) -> float:
        """Stiffness of the mesh, N/m; refused where teeth give it and are not solved."""
        return solved(self.file_stiffness)


def contact(pair: Pair, coast: bool | None = None) -> Contact:
    """Return the mesh vectors of two gears; `coast` is True for the flank that the file does not
    name, by default that of its operating point. Refused for missing or contradicting gear data,
    a line of action that is no unit vector or lies in the wrong frame, a mesh point off the
    gears, and lever arms that are not in the ratio of the teeth.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = contact(sg.load_train("geometry/axle_overhung.toml").pairs[0])
    >>> round(abs(found.gear.lever / found.pinion.lever), 4), found.cautions[0][:43]
    (3.2143, 'the pitch angle of 0.391 rad does not match')
    """
    try:
        tips = {side: _tips(pair, side) for side in pair.members}
        return _contact(pair.rolling, tips, coast)
    except SceneError as error:
        raise SceneError.of(pair.with_file_paths(error.problems)) from None


def axes_of(pair: Pair, side: str) -> np.ndarray:
    """Return the (3, 3) turn from the frame of ``pinion`` or ``gear`` to the axes of its scene,
    whose y may run towards the apex (half a turn about z), and whose -x need not point to the
    mesh.
    """
    parallel = abs(sin(pair.mesh.shaft_angle)) < 1e-6
    turned = pair.mesh.azimuth if parallel or side == "pinion" else 0.0
    flip = np.eye(3) if pair.members[side].apex == "start" else np.diag([-1.0, -1.0, 1.0])
    return flip @ rotation(1, turned)[:3, :3]


def _contact(pair: Pair, tips: Mapping[str, float], coast: bool | None) -> Contact:
    mesh, cautions = pair.mesh, _contradictions(pair)
    wrench = None
    if mesh.contact_cells:
        wrench = contact_wrench(
            [c.point for c in mesh.contact_cells],
            [c.normal for c in mesh.contact_cells],
            [c.force for c in mesh.contact_cells],
        )
        normal, point = wrench.normal, wrench.point
    elif mesh.line_of_action is not None:
        normal, point = _given_line(pair), np.array(mesh.point)
    else:
        normal = _of_teeth(pair, mesh.pressure_angle)
        point = mesh_point(_mean_radius(pair)) + np.array([0.0, _face_middle(pair), 0.0])
    if coast is None:
        coast = pair.point is not None and pair.point.coast
    if coast:
        normal = other_flank(pair, normal, point)
    origin = _gear_position(pair, point)
    n_gear = to_gear_frame(normal, mesh.shaft_angle)
    r_gear = to_gear_frame(point - origin, mesh.shaft_angle)
    pinion, gear = MeshVector(normal, point), MeshVector(n_gear, r_gear)
    cautions += _cones(pair) + _apexes(pair)
    vectors = {"pinion": pinion, "gear": gear}
    for side, vector in vectors.items():
        _refuse_point_off_head(pair, side, vector.point, tips[side])
    cautions += _levers(pair, pinion, gear)
    cautions += [line for side in pair.members for line in _scene_load(pair, side, vectors[side])]
    stiffness: float | str | None = mesh.stiffness
    if stiffness is None:
        assert wrench and mesh.loaded_error is not None and mesh.unloaded_error is not None
        stiffness = wrench.mesh_stiffness(mesh.loaded_error, mesh.unloaded_error)
    return Contact(
        pinion=_in_scene(pair, "pinion", pinion),
        gear=_in_scene(pair, "gear", gear),
        file_stiffness=stiffness,
        origin=origin,
        wrench=wrench,
        cautions=tuple(cautions),
    )


def _contradictions(pair: Pair) -> list[str]:
    """Return sentences on contradictions between the numbers of both wheels that are small enough
    to go on with; large ones are refused where the line of action comes from these numbers.
    """
    sentences, refused = [], []
    for key, words, severe in _gear_against_pinion(pair):
        if severe:
            refused.append(SceneError(words, path=("gear", key)))
        else:
            sentences.append(f"{key} of the gear: {words}")
    if refused:
        raise SceneError.of(refused)
    return sentences


def _gear_against_pinion(pair: Pair) -> Iterator[tuple[str, str, bool]]:
    """Yield a key of the gear, the contradiction in words, and whether it is too large to go on
    with.
    """
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    of_teeth = mesh.line_of_action is None and not mesh.contact_cells
    if pinion.pitch_radius and gear.pitch_radius:
        radius_ratio = gear.pitch_radius / pinion.pitch_radius
        difference = abs(radius_ratio / pair.ratio - 1)
        words = (
            f"is {radius_ratio:.4g} times the {1e3 * pinion.pitch_radius:.5g} mm of the "
            f"{pair.shafts[0]}, but {gear.teeth} over {pinion.teeth} teeth need {pair.ratio:.4g} "
            "times"
        )
        if difference > RADII[0]:
            yield (
                "pitch_radius",
                f"{words}; correct one of the two",
                of_teeth and difference > RADII[1],
            )
    if pinion.pitch_angle is not None and gear.pitch_angle is not None:
        angle_sum = pinion.pitch_angle + gear.pitch_angle
        difference = abs(angle_sum - mesh.shaft_angle)
        words = (
            f"and the {pair.shafts[0]}'s add up to {angle_sum:.4g} rad, but the shafts are at "
            f"{mesh.shaft_angle:.4g} rad; correct one of the three"
        )
        if difference > ANGLES[0]:
            yield "pitch_angle", words, of_teeth and difference > ANGLES[1]
    if pinion.spiral_angle is not None and gear.spiral_angle is not None:
        difference = abs(pinion.spiral_angle - gear.spiral_angle)
        words = (
            f"is {gear.spiral_angle:.4g} rad, but the pinion's is {pinion.spiral_angle:.4g} rad; "
            "teeth that mesh have one angle and opposite hands"
        )
        if difference > ANGLES[0]:
            yield (
                "spiral_angle",
                words,
                of_teeth and not mesh.shaft_angle and difference > ANGLES[1],
            )
    if pinion.face_width and gear.face_width:
        if abs(gear.face_width / pinion.face_width - 1) > FACES:
            words = (
                f"is {1e3 * gear.face_width:.4g} mm, but the pinion's is "
                f"{1e3 * pinion.face_width:.4g} mm; only the shared face carries, and the mesh "
                "point is taken at the middle of the pinion's"
            )
            yield "face_width", words, False
    if pinion.loaded_side and pinion.loaded_side == gear.loaded_side and pinion.spiral_angle:
        if pinion.loaded_side in ("concave", "convex"):
            flank, driving_flank = (
                gear.loaded_side,
                "concave" if gear.loaded_side == "convex" else "convex",
            )
            words = (
                f"{flank} like the pinion's, but a concave flank touches a convex one; the "
                "pinion's is taken"
            )
            if pair.idle:
                words = (
                    f"is {driving_flank}, the flank it drives with, so that its {flank} flank is "
                    f"driven by a {flank} one, but a concave flank touches a convex one; the "
                    f"pinion's is taken: write {flank}, or leave it out"
                )
            yield "loaded_side", words, False


def other_flank(pair: Pair, normal: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Return the line of action of the other flank of the same tooth, in the pinion's frame:
    mirrored at the normal of the pitch cone where they touch.
    """
    if pair.mesh.contact_cells:
        raise SceneError(
            "belong to one flank; a torque on the other flank (coast, below zero) needs a file "
            "with its cells",
            path=("mesh", "contact_cells"),
        )
    angle = pair.pinion.pitch_angle
    if angle is None and abs(sin(pair.mesh.shaft_angle)) > 1e-6:
        _needs(pair, "pitch_angle", reason="the line of action of the other flank (coast)")
    gamma = angle or 0.0
    outward = np.array([point[0], 0.0, point[2]]) / np.hypot(point[0], point[2])
    across = -cos(gamma) * outward + sin(gamma) * np.array([0.0, 1.0, 0.0])
    return 2 * (normal @ across) * across - normal


def _in_scene(pair: Pair, side: str, vector: MeshVector) -> MeshVector:
    """Return a vector in the axes of the scene."""
    axes = axes_of(pair, side)
    return MeshVector(axes @ vector.normal, axes @ vector.point)


def _needs(pair: Pair, *keys: str, reason: str) -> None:
    missing = [key for key in keys if getattr(pair.pinion, key) is None]
    straight, parallel = not pair.pinion.spiral_angle, not pair.mesh.shaft_angle
    words = dict.fromkeys(GEOMETRY, "")
    if parallel:
        words["loaded_side"] = ': write "left" or "right", the flank that carries the torque'
    if parallel and pair.pinion.hand is not None:
        words["spiral_angle"] = ": helical teeth have a hand; leave hand out for straight teeth"
    if parallel and straight and pair.pinion.loaded_side not in CURVED:
        missing = [key for key in missing if key != "hand"]  # straight teeth have none
    elif straight and {"hand", "loaded_side"} & set(missing):
        note = ": of straight teeth both together say which flank is loaded"
        words |= {"hand": note, "loaded_side": note}
    if pair.pinion.pitch_angle == 0:
        missing = [key for key in missing if key != "face_width"]  # the radius is one all along
    names = CYLINDRICAL if parallel else {}
    if missing:
        raise SceneError.of(
            SceneError(
                f"is missing; {reason} needs it{words[key]}", path=("pinion", names.get(key, key))
            )
            for key in missing
        )


def _of_teeth(pair: Pair, pressure_angle: float | None) -> np.ndarray:
    _needs(pair, *GEOMETRY, reason="a line of action from gear geometry")
    p = pair.pinion
    assert p.pitch_angle is not None and p.spiral_angle is not None
    assert p.loaded_side is not None and pressure_angle is not None
    hand = p.hand or "right"  # of straight teeth, whose flank is given directly
    return line_of_action(p.pitch_angle, p.spiral_angle, pressure_angle, hand, p.loaded_side)


def _mean_radius(pair: Pair) -> float:
    what = "a mesh point from gear geometry"
    _needs(pair, "pitch_radius", "pitch_angle", "face_width", reason=what)
    p = pair.pinion
    assert p.pitch_radius is not None and p.pitch_angle is not None
    if p.pitch_angle == 0:
        return p.pitch_radius
    assert p.face_width is not None
    try:
        return mean_radius(p.pitch_radius, p.pitch_angle, p.face_width)
    except SolidgearError as error:
        raise SceneError(str(error), path=("pinion", "face_width")) from None


def _face_middle(pair: Pair) -> float:
    """Return the middle of the face that cylindrical gears share, from the pinion's lumped point along
    its frame, m.
    """
    pinion, gear = pair.pinion, pair.gear
    if not (pinion.face_offset or gear.face_offset):
        return 0.0
    teeth = wheels_of(pair)
    if teeth is None:
        return 0.0
    return teeth.middles[0] if pinion.apex == "start" else -teeth.middles[0]


def _gear_position(pair: Pair, point: np.ndarray) -> np.ndarray:
    """Return the gear's lumped point from the pinion's: with both at the middle of the face, where
    the middles of the faces touch and radii are in the ratio of the teeth.
    """
    if pair.mesh.gear_position is not None:
        return np.array(pair.mesh.gear_position)
    if pair.mesh.line_of_action is not None or pair.mesh.contact_cells:
        _needs(pair, "pitch_radius", "pitch_angle", "face_width", reason=WITHOUT_POSITION)
    radius = _mean_radius(pair)
    at_gear = mesh_point(pair.ratio * radius, member="gear")
    # from the gear's frame back to the pinion's: the opposite turn
    return mesh_point(radius) - to_gear_frame(at_gear, -pair.mesh.shaft_angle)


def _given_line(pair: Pair) -> np.ndarray:
    normal = np.array(pair.mesh.line_of_action)
    length = float(np.linalg.norm(normal))
    path = ("mesh", "line_of_action")
    if not abs(length - 1) < UNIT:
        unit = [round(float(v), 7) for v in normal / length] if length > 0 else [0.0, 0.0, 1.0]
        raise SceneError(
            f"has length {length:.6g}; the unit vector of this direction is {unit}", path=path
        )
    if all(getattr(pair.pinion, key) is not None for key in GEOMETRY):
        teeth = _of_teeth(pair, pair.mesh.pressure_angle or USUAL_PRESSURE_ANGLE)
        in_pinion_frame = to_gear_frame(normal, -pair.mesh.shaft_angle)
        if in_pinion_frame @ teeth > normal @ teeth + TURNED:
            raise SceneError(
                "is given in the gear's frame; in the pinion's frame it is "
                f"{np.round(in_pinion_frame, 7).tolist()}",
                path=path,
            )
    return normal


def _cones(pair: Pair) -> list[str]:
    """Return a caution where the pitch angle does not fit the numbers of teeth."""
    angle, shaft = pair.pinion.pitch_angle, pair.mesh.shaft_angle
    if angle is None:
        return []
    # Shigley's Mechanical Engineering Design, bevel gears: both cones roll on each other
    of_teeth = float(np.arctan2(sin(shaft), pair.ratio + cos(shaft)))
    if abs(angle - of_teeth) < CONE_TOLD * max(of_teeth, LEAST_CONE):
        return []
    return [
        f"the pitch angle of {angle:.4g} rad does not match {pair.pinion.teeth} and "
        f"{pair.gear.teeth} teeth ({of_teeth:.4g} rad); radii are taken in the ratio of the teeth"
    ]


def _apexes(pair: Pair) -> list[str]:
    """Return cautions where the pitch apex does not lie where the head of the scene is narrowest."""
    if abs(sin(pair.mesh.shaft_angle)) < 1e-6:
        return []  # parallel shafts have none
    out = []
    for side in pair.members:
        scene, apex = pair.members[side].scene, pair.members[side].apex
        port = scene.port
        head = max(scene.segments, key=lambda s: min(s.y1, port.hi) - max(s.y0, port.lo))
        taper = (head.outer1 - head.outer0) / head.length
        lies = "start" if taper > 0 else "end"
        if abs(taper) > CONE_SEEN and lies != apex:
            out.append(
                f'apex = "{apex}" of the {side} contradicts its scene, where {head.name!r} '
                f"narrows towards the {lies} of the shaft; the axial mesh force is right only "
                f'with apex = "{lies}", or with the shaft turned round'
            )
    return out


def _tips(pair: Pair, side: str) -> float:
    """Return the tip radius of a cylindrical gear of a known module, m, else 0: teeth with profile shift
    touch beyond the pitch circle.
    """
    member, mate = pair.members[side], pair.members["gear" if side == "pinion" else "pinion"]
    module = member.module or mate.module
    if module is None:
        return 0.0
    helix = member.helix_angle or mate.helix_angle or 0.0
    wheel = Wheel(member.teeth, module, helix, member.profile_shift)
    return wheel.tip if member.tip_diameter is None else member.tip_diameter / 2


def _refuse_point_off_head(pair: Pair, side: str, point: np.ndarray, tip: float) -> None:
    scene, apex = pair.members[side].scene, pair.members[side].apex
    port = scene.port
    most = scene.outline.largest_radius
    # a wheel that is a rigid mass is not among the segments; its pitch radius or its tips say how far
    # it goes
    most = max(most, pair.members[side].pitch_radius or 0.0, tip)
    radius = float(np.hypot(point[0], point[2]))
    y = port.y + (point[1] if apex == "start" else -point[1])
    slack = OUTSIDE_LENGTH * (port.hi - port.lo)
    member = pair.members[side]
    given = ("mesh", "point") if pair.mesh.point is not None else ()
    if radius > most * (1 + OUTSIDE_RADIUS) and member.head and not member.pitch_radius:
        raise SceneError(
            "is missing; a wheel as a rigid head needs it, since the mesh point lies "
            f"{1e3 * radius:.1f} mm from the axis, beyond the shaft's largest radius of "
            f"{1e3 * most:.1f} mm",
            path=(side, "pitch_radius"),
        )
    if radius > most * (1 + OUTSIDE_RADIUS):
        raise SceneError(
            f"the mesh point lies {1e3 * radius:.1f} mm from the axis of the {side}, off the "
            f"{side}, whose largest radius is {1e3 * most:.1f} mm",
            path=given or (side, "pitch_radius" if member.pitch_radius else "module"),
        )
    if not port.lo - slack <= y <= port.hi + slack:
        raise SceneError(
            f"the mesh point lies at y = {1e3 * y:.1f} mm of the {side}'s shaft, off its head "
            f"from {1e3 * port.lo:.1f} to {1e3 * port.hi:.1f} mm",
            path=given or (side, "face_offset"),
        )


def _scene_load(pair: Pair, side: str, vector: MeshVector) -> list[str]:
    """Return a caution on bearings that settled under a [load] which is no force of the teeth; a
    load that pulls the teeth apart is refused.
    """
    member = pair.members[side]
    scene = member.scene
    waiting = any(b.unsettled is not b for b in scene.bearings)
    if pair.point or not scene.is_loaded or not waiting or member.scene_load == "added":
        return []
    force = station_loads(scene).get(scene.port.name, np.zeros(6))[:3]
    if not force.any():
        return []
    normal = _in_scene(pair, side, vector).normal
    teeth = normal if side == "pinion" else -normal
    along = float(force @ teeth / np.linalg.norm(force))
    start = (
        f"the [load] in the {side}'s scene, ({', '.join(f'{v:.0f}' for v in force)}) N, under "
        "which its bearings settle"
    )
    advice = (
        f'give the train an [operation] with its torque and write scene_load = "replaced" under '
        f"[{side}], so that the mesh force follows"
    )
    if along < 0:
        raise SceneError(
            f"{start}, pulls the teeth apart: they push the {side} along "
            f'({", ".join(f"{v:.3f}" for v in teeth)}); {advice}, or write scene_load = "added" '
            f"under [{side}] if it does not come from the teeth",
            path=(side, "scene"),
        )
    if along > cos(LOAD_ASIDE):
        return []
    return [
        f"{start}, lies {np.degrees(np.arccos(along)):.0f} degrees off their line of action; {advice}"
    ]


def _levers(pair: Pair, pinion: MeshVector, gear: MeshVector) -> list[str]:
    path = ("mesh", "point") if pair.mesh.point is not None else ("mesh",)
    for side, vector in (("pinion", pinion), ("gear", gear)):
        if abs(vector.lever) < 1e-6 * np.linalg.norm(vector.point):
            raise SceneError(
                f"the line of action meets the axis of the {side}, so that the mesh transmits no "
                "torque; turn it, or move the mesh point",
                path=path,
            )
    levers = abs(gear.lever / pinion.lever)
    error = levers / pair.ratio - 1
    if abs(error) > LEVER_REFUSED:
        raise SceneError(
            f"the lever arms are {1e3 * abs(pinion.lever):.2f} mm on the {pair.shafts[0]} and "
            f"{1e3 * abs(gear.lever):.2f} mm on the {pair.shafts[1]}, a ratio of {levers:.4f}; "
            f"the teeth need {pair.ratio:.4f}",
            path=path,
        )
    if abs(error) > LEVER_TOLD:
        return [
            f"the lever arms have a ratio of {levers:.4f}, the teeth of {pair.ratio:.4f}: "
            f"{100 * error:+.1f} %"
        ]
    return []
