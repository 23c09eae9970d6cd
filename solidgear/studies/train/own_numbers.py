"""Numbers of the gear's teeth held against those of the pinion's.

The mesh is made from the pinion's numbers; those of the gear follow from them and the teeth, so that
a gear that is described as well can only agree or contradict.
"""

from __future__ import annotations

from collections.abc import Iterator

from solidgear.errors import SceneError
from solidgear.scene.gears import Pair

#: relative, of pitch radii, and rad, of angles: told from the first on, refused from the second on;
#: the former is what rounding to three digits leaves
RADII, ANGLES = (5e-3, 5e-2), (1e-2, 5e-2)
#: of face widths: a pinion is made wider by what assembly may shift it, some tenth
FACES = 0.25


def compared(pair: Pair) -> list[str]:
    """Contradictions between the numbers of both wheels that are small enough to go on with.

    Raises
    ------
    SceneError
        Large ones, where the line of action comes from these numbers: radii that are not in the
        ratio of the teeth, pitch angles that do not add up to the shaft angle, spiral angles of
        parallel shafts that differ.
    """
    told, refused = [], []
    for key, words, severe in _contradictions(pair):
        if severe:
            refused.append(SceneError(words, path=("gear", key)))
        else:
            told.append(f"{key} of the gear: {words}")
    if refused:
        raise SceneError.of(refused)
    return told


def _contradictions(pair: Pair) -> Iterator[tuple[str, str, bool]]:
    """Key of the gear, what it contradicts, and whether that is too much."""
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    of_teeth = mesh.line_of_action is None and not mesh.contact_cells
    if pinion.pitch_radius and gear.pitch_radius:
        given = gear.pitch_radius / pinion.pitch_radius
        off = abs(given / pair.ratio - 1)
        words = (
            f"is {given:.4g} times the {1e3 * pinion.pitch_radius:.5g} mm of the {pair.shafts[0]}, and "
            f"{gear.teeth} over {pinion.teeth} teeth ask for {pair.ratio:.4g} times"
        )
        if off > RADII[0]:
            yield "pitch_radius", f"{words}; correct one of the two", of_teeth and off > RADII[1]
    if pinion.pitch_angle is not None and gear.pitch_angle is not None:
        both = pinion.pitch_angle + gear.pitch_angle
        off = abs(both - mesh.shaft_angle)
        words = (
            f"and that of the {pair.shafts[0]} add up to {both:.4g} rad, and the shafts are at "
            f"{mesh.shaft_angle:.4g} rad; correct one of the three"
        )
        if off > ANGLES[0]:
            yield "pitch_angle", words, of_teeth and off > ANGLES[1]
    if pinion.spiral_angle is not None and gear.spiral_angle is not None:
        off = abs(pinion.spiral_angle - gear.spiral_angle)
        words = (
            f"is {gear.spiral_angle:.4g} rad, and that of the pinion {pinion.spiral_angle:.4g} rad; "
            "teeth that mesh lean alike, to opposite hands"
        )
        if off > ANGLES[0]:
            yield "spiral_angle", words, of_teeth and not mesh.shaft_angle and off > ANGLES[1]
    if pinion.face_width and gear.face_width:
        if abs(gear.face_width / pinion.face_width - 1) > FACES:
            words = (
                f"is {1e3 * gear.face_width:.4g} mm, and that of the pinion "
                f"{1e3 * pinion.face_width:.4g} mm; only the face that both share carries, and the "
                "mesh point is taken at the middle of the pinion's"
            )
            yield "face_width", words, False
    if pinion.loaded_side and pinion.loaded_side == gear.loaded_side and pinion.spiral_angle:
        if pinion.loaded_side in ("concave", "convex"):
            same, other = gear.loaded_side, "concave" if gear.loaded_side == "convex" else "convex"
            words = (
                f"{same} like that of the pinion, where a concave flank touches a convex one; that of "
                "the pinion is taken"
            )
            if pair.idle:
                words = (
                    f"is {other}, the flank that it drives with, so that it is driven on its {same} one "
                    f"by a {same} one, where a concave flank touches a convex one; that of the pinion "
                    f"is taken: write {same}, or leave it out"
                )
            yield "loaded_side", words, False
