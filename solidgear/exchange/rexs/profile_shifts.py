"""Profile shifts that a REXS document leaves open, from the centre distances of its stages."""

from __future__ import annotations

from math import acos, atan, cos, tan

from solidgear.core.gears.wheel import involute
from solidgear.exchange.rexs.gearbox import NEAR, Gearbox, GearOnShaft, PairStage
from solidgear.exchange.rexs.gears import (
    SHIFT,
    centre_distance,
    flank_number,
    module_of,
    pressure_angle,
    shift_of,
    teeth_of,
)


def fill_shifts(gearbox: Gearbox) -> None:
    """Fill the profile shifts that flanks leave open, by the centre distances, and note each: of a
    stage with one gear open first, for that gear may leave one open in a further stage.
    """
    if gearbox.document.is_ours:
        return  # where it is zero this program leaves it out
    stages = [stage for stage in gearbox.pairs if stage.component.kind == "cylindrical_stage"]
    while waiting := [stage for stage in stages if _open_gears(gearbox, stage)]:
        stage = min(waiting, key=lambda stage: len(_open_gears(gearbox, stage)))
        gears = _open_gears(gearbox, stage)
        given = [shift_of(gearbox, g.component) for g in stage.gears if g not in gears]
        total, source = _sum_of_shifts(gearbox, stage)
        share = (total - sum(given)) / len(gears) if source else 0.0
        reason = f"no {SHIFT} is given: {share:.6g}"
        if source:
            part = "half of what" if len(gears) == 2 else "as"
            reason += f", {part} the centre distance of {stage.component.title} asks for"
        for gear in gears:
            gearbox.shifts[gear.component.id] = share
            gearbox.notes.assume(gear.component, reason)


def _open_gears(gearbox: Gearbox, stage: PairStage) -> list[GearOnShaft]:
    """Return the gears of a stage whose profile shift is neither given nor filled."""
    return [
        gear
        for gear in stage.gears
        if gear.component.id not in gearbox.shifts
        and flank_number(gearbox, gear.component, SHIFT)[0] is None
    ]


def _sum_of_shifts(gearbox: Gearbox, stage: PairStage) -> tuple[float, str]:
    """Return the sum of the profile shifts of two gears without backlash at their centre distance, and
    where it came from; nothing where no shift reaches it.

    DIN 3960, 4.2: the involute of the working pressure angle less that of the rack is
    2 tan(alpha) (x1 + x2) / (z1 + z2).
    """
    first, second = stage.gears
    distance, source = centre_distance(gearbox, stage)
    if not distance:
        return 0.0, ""
    helix = abs(first.component.number("helix_angle_reference_diameter") or 0.0)
    normal, _ = pressure_angle(gearbox, stage)
    angle = atan(tan(normal) / cos(helix))
    count = teeth_of(first.component) + teeth_of(second.component)
    unshifted = module_of(first.component) * count / (2 * cos(helix))
    if abs(distance - unshifted) <= NEAR:
        return 0.0, source
    cosine = unshifted * cos(angle) / distance
    if cosine >= 1:
        return 0.0, ""
    working = float(involute(acos(cosine)) - involute(angle))
    return round(working * count / (2 * tan(normal)), 9), source
