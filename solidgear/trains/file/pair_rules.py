"""Rules for two gears that mesh, one sentence for each problem."""

from __future__ import annotations

from collections.abc import Iterator
from math import isclose, pi

from solidgear.core import SceneError
from solidgear.core.scene.units import TYPED
from solidgear.trains.file.cylindrical import cylindrical_problems
from solidgear.trains.file.flank_rules import flank_problems
from solidgear.trains.file.gears import FLANKS
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.tooth_fit import fit_problems


def pair_problems(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of two gears that mesh, with paths from ``pinion``, ``gear`` or ``mesh``."""
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    hands = (pinion.hand, gear.hand)
    curved = any(m.spiral_angle or m.helix_angle for m in (pinion, gear))
    if curved and None not in hands and hands[0] == hands[1]:
        kind = "spiral bevel pair" if mesh.shaft_angle else "helical pair on parallel shafts"
        yield SceneError(
            f"both wheels are {hands[0]}-handed; a {kind} needs one of each hand",
            path=("gear", "hand"),
        )
    yield from _flanks(pair)
    if wrong := [*cylindrical_problems(pinion, gear, mesh)]:
        yield from wrong
    else:
        yield from fit_problems(pair)
        yield from flank_problems(pair)
    ratio, file_ratio = pair.ratio, mesh.ratio
    if file_ratio is not None and not isclose(file_ratio, ratio, rel_tol=TYPED):
        yield SceneError(
            f"{gear.teeth} over {pinion.teeth} teeth are a ratio of {ratio:.4f}; "
            "correct it or leave it out",
            path=("mesh", "ratio"),
        )
    yield from _cycles(pair)


def _cycles(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of tables over a mesh cycle, which cover one tooth pitch of the pinion."""
    teeth, pitch = pair.pinion.teeth, 2 * pi / pair.pinion.teeth
    tables = {key: getattr(pair.mesh, key) for key in ("stiffness_cycle", "line_cycle")}
    tables_given = {key: table for key, table in tables.items() if table is not None}
    for key, table in tables_given.items():
        if not isclose(table.pitch, pitch, rel_tol=TYPED):
            yield SceneError(
                f"covers {table.pitch:.5g} rad of the pinion, but one of its {teeth} teeth takes "
                f"{pitch:.5g} rad; correct the angles, or the number of teeth",
                path=("mesh", key, "angle"),
            )
    first = [table.angle[0] for table in tables_given.values()]
    if len(first) > 1 and not isclose(first[0], first[1], abs_tol=TYPED * pitch):
        yield SceneError(
            f"begins at {first[1]:.5g} rad, but stiffness_cycle at {first[0]:.5g} rad; let both "
            "begin at one angle",
            path=("mesh", "line_cycle", "angle"),
        )


def _flanks(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of left and right flanks: of cylindrical gears alone, left against left."""
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    sides = [side for side in pair.members if pair.members[side].loaded_side in FLANKS]
    if sides and mesh.shaft_angle:
        yield SceneError(
            "left and right flanks are for parallel shafts (ISO 21771); for a bevel gear write "
            "concave or convex",
            path=(sides[0], "loaded_side"),
        )
    elif sides and None not in (pinion.flank, gear.flank):
        if pinion.flank != gear.flank and pair.idle:
            file_flank = next(flank for flank in FLANKS if flank != gear.flank)
            yield SceneError(
                f"is the flank that the {pair.shafts[1]} drives with, so it would be driven on "
                f"its {gear.flank} flank, but the {pair.shafts[0]} drives it on the "
                f'{pinion.flank} one: write "{gear.flank}" in place of "{file_flank}", or leave it '
                "out",
                path=("gear", "loaded_side"),
            )
        elif pinion.flank != gear.flank:
            yield SceneError(
                f"is the {gear.flank} flank, but the {pinion.flank} one is loaded on the "
                f"{pair.shafts[0]}, and left flanks touch left ones; correct one of them, or "
                "leave the gear's out",
                path=("gear", "loaded_side"),
            )
