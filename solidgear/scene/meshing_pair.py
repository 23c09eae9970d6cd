"""Problems of two gears that mesh."""

from __future__ import annotations

from collections.abc import Iterator
from math import isclose, pi

from solidgear.errors import SceneError
from solidgear.scene.cylindrical import cylindrical_problems
from solidgear.scene.gears import FLANKS, Pair
from solidgear.scene.layout import RATIO_TYPED


def pair_problems(pair: Pair) -> Iterator[SceneError]:
    """Problems of two gears that mesh, with paths from ``pinion``, ``gear`` or ``mesh``."""
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    hands = (pinion.hand, gear.hand)
    curved = any(m.spiral_angle or m.helix_angle for m in (pinion, gear))
    if curved and None not in hands and hands[0] == hands[1]:
        kind = "spiral bevel pair" if mesh.shaft_angle else "helical pair on parallel shafts"
        yield SceneError(
            f"both wheels are {hands[0]}-handed and cannot mesh; a {kind} has one of each",
            path=("gear", "hand"),
        )
    yield from _flanks(pair)
    yield from cylindrical_problems(pinion, gear, mesh)
    ratio, given = pair.ratio, mesh.ratio
    if given is not None and not isclose(given, ratio, rel_tol=RATIO_TYPED):
        yield SceneError(
            f"{gear.teeth} over {pinion.teeth} teeth are a ratio of {ratio:.4f}; "
            "correct it or leave it out",
            path=("mesh", "ratio"),
        )
    yield from _cycles(pair)


def _cycles(pair: Pair) -> Iterator[SceneError]:
    """Tables over a mesh cycle cover one tooth pitch of the pinion and begin at one angle."""
    teeth, pitch = pair.pinion.teeth, 2 * pi / pair.pinion.teeth
    tables = {key: getattr(pair.mesh, key) for key in ("stiffness_cycle", "line_cycle")}
    given = {key: table for key, table in tables.items() if table is not None}
    for key, table in given.items():
        if not isclose(table.pitch, pitch, rel_tol=RATIO_TYPED):
            yield SceneError(
                f"covers {table.pitch:.5g} rad of the pinion, and one of its {teeth} teeth takes "
                f"{pitch:.5g} rad; correct the angles, or the number of teeth",
                path=("mesh", key, "angle"),
            )
    first = [table.angle[0] for table in given.values()]
    if len(first) > 1 and not isclose(*first, abs_tol=RATIO_TYPED * pitch):
        yield SceneError(
            f"begins at {first[1]:.5g} rad, and stiffness_cycle at {first[0]:.5g} rad; both tell "
            "one cycle and begin at one angle",
            path=("mesh", "line_cycle", "angle"),
        )


def _flanks(pair: Pair) -> Iterator[SceneError]:
    """Left and right flanks are those of cylindrical gears, and touch their own kind."""
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    named = [side for side in pair.members if pair.members[side].loaded_side in FLANKS]
    if named and mesh.shaft_angle:
        yield SceneError(
            "left and right flanks are words of parallel shafts (ISO 21771); of a bevel gear "
            "write concave or convex",
            path=(named[0], "loaded_side"),
        )
    elif named and None not in (pinion.flank, gear.flank):
        if pinion.flank != gear.flank:
            yield SceneError(
                f"is the {gear.flank} flank, and the {pinion.flank} one is loaded on "
                f"the {pair.shafts[0]}: seen from one side, left flanks touch left ones; correct "
                "one of the two, or leave that of the gear out",
                path=("gear", "loaded_side"),
            )
