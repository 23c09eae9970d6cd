"""Teeth of two cylindrical gears at their centre distance: refusals, cautions and facts.

Without allowances, as :mod:`solidgear.core.gears.wheel_pair` computes them; teeth of which the file says
no more have the basic rack of ISO 53.
"""

from __future__ import annotations

from collections.abc import Iterator

from solidgear.core import SceneError
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.trains.file.lengths import in_mm, in_um
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.tip_rules import ROUNDED, cut_caution, is_cutting

#: modules of overlap that the usual thinning of both wheels takes up (DIN 3967, cd25): refused above
THINNED = 0.05
#: modules of backlash above which no drawing asks for it: ISO/TR 10064-2 recommends 0.04 to 0.13
LOOSE = 0.25
#: modules of undercut without a caution: that of a wheel of 14 teeth without profile shift
PASSED = 0.185


def fit_of(pair: Pair) -> WheelPair | None:
    """Return the wheels of a pair of cylindrical gears; None where the file does not give their
    module and pressure angle.

    Raises
    ------
    SceneError
        As :class:`solidgear.core.gears.wheel_pair.WheelPair`.
    """
    if (pair.pinion.module or pair.gear.module) is None or pair.mesh.pressure_angle is None:
        return None
    teeth = wheels_of(pair)
    if teeth is None:
        return None
    _ = teeth.wheels.distance  # refused here where there is none
    return teeth.wheels


def wheels_in(fit: WheelPair) -> tuple[Wheel, Wheel]:
    """Return both wheels of a pair."""
    return fit.first, fit.second


def fit_problems(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of teeth that do not fit the centre distance, or have no root."""
    try:
        fit = fit_of(pair)
    except SceneError as error:
        yield from error.problems
        return
    if fit is None:
        return
    yield from _distance(pair, fit)
    for (side, gear), wheel in zip(pair.members.items(), wheels_in(fit)):
        y, root = gear.scene.port.y, wheel.root
        bore = min(s.radius_at(y)[0] for s in gear.scene.segments_at(y))
        if root <= bore:
            yield SceneError(
                f"puts the roots of its teeth at {in_mm(root)} from the axis, inside the bore of "
                f"its shaft, {in_mm(bore)}; correct the teeth, the module, the profile shift or the "
                "bore",
                path=(side, "teeth"),
            )


def _distance(pair: Pair, fit: WheelPair) -> Iterator[SceneError]:
    """Yield problems of the centre distance."""
    if pair.mesh.centre_distance is None:
        return
    first, second = wheels_in(fit)
    path = ("mesh", "centre_distance")
    teeth_label = (
        f"{first.count} and {second.count} teeth of {in_mm(first.module)} module with profile shifts "
        f"that sum to {first.shift + second.shift:.4g}"
    )
    if fit.backlash < -THINNED * first.module:
        yield SceneError(
            f"is too short: {teeth_label} overlap there by {in_um(-fit.backlash)} along the line of "
            f"action; they have no backlash at {in_mm(fit.tight)}; correct the distance, the teeth, "
            "the module, the helix angle or the profile shifts",
            path=path,
        )
    elif fit.contact_ratio <= 0 and first.tip_radius is second.tip_radius is None:
        yield SceneError(
            f"is too long: {teeth_label} do not reach each other, for their tips lie at "
            f"{in_mm(first.tip)} and {in_mm(second.tip)}; correct the distance, the teeth, the "
            "module, the helix angle or the profile shifts",
            path=path,
        )


def fit_cautions(fit: WheelPair, sides: tuple[str, str]) -> Iterator[str]:
    """Yield cautions on wheels whose tips reach too far or not far enough; `sides` name the shafts."""
    wheels = wheels_in(fit)
    for k in range(2):
        # a ring whose tips the file leaves open is made with shorter ones
        is_described = wheels[k].sign > 0 or wheels[k].tip_radius is not None
        if is_described and wheels[k].tip_thickness >= 0 and is_cutting(fit, k):
            yield cut_caution(fit, k, sides)
        elif is_described:
            yield from _flank_lost(fit, 1 - k, sides)
    if parting := parting_teeth(fit):
        yield parting


def parting_teeth(fit: WheelPair) -> str:
    """Return a sentence on wheels of which no teeth touch for a part of each pitch, or nothing."""
    if fit.contact_ratio + fit.overlap_ratio >= 1:
        return ""
    helical = f" and {fit.overlap_ratio:.2f} by their helix" if fit.base_helix else ""
    return (
        f"the contact ratio is {fit.contact_ratio:.2f}{helical}, below 1: no teeth touch for a "
        "part of each pitch; correct tips, centre distance, profile shifts, module or teeth"
    )


def _flank_lost(fit: WheelPair, k: int, sides: tuple[str, str]) -> Iterator[str]:
    """Yield a caution on used flank of the first or the second wheel that its fillets take."""
    cut, wheel, side, mate = path_cuts(fit)[k], wheels_in(fit)[k], sides[k], sides[1 - k]
    if cut <= ROUNDED * wheel.module:
        return
    if wheel.is_undercut:
        whole = fit.contact_ratio + sum(path_cuts(fit)) / fit.pitch
        yield (
            f"undercut of the {side} takes {in_um(cut)} of the path of contact that tips of the "
            f"{mate} would use: a contact ratio of {fit.contact_ratio:.2f} remains of {whole:.2f}"
        )
        return
    yield (
        f"tips of the {mate} meet the fillets of the {side}, whose flanks end at "
        f"{in_mm(wheel.form)} from the axis: {in_um(cut)} of the path of contact are lost "
        f"there; shorten the tips of the {mate}, or give the {side} another rack"
    )


def path_cuts(fit: WheelPair) -> tuple[float, float]:
    """Return by how much the fillets of the first and of the second wheel shorten the path of contact
    that the tips would have, m.
    """
    (start, stop), (first, second) = fit.tip_ends, fit.form_ends
    return max(first - start, 0.0), max(stop - second, 0.0)


def wheel_cautions(wheel: Wheel, side: str) -> Iterator[str]:
    """Yield cautions on the teeth of a wheel on the shaft `side`."""
    if wheel.missing_shift > PASSED:
        yield (
            f"the {wheel.count} teeth of the {side} are undercut by their rack: without "
            f"undercut their profile shift is at least {wheel.shift + wheel.missing_shift:.2f}"
        )


def backlash_cautions(fit: WheelPair, file_backlash: float | None) -> Iterator[str]:
    """Yield cautions on a backlash that is large, or contradicts that of the file, m."""
    gap, module = fit.backlash, fit.first.module
    loose = LOOSE * module
    place = f"teeth without allowances leave {in_um(gap)} along the line of action at"
    place += f" {in_mm(fit.distance)}"
    if gap < -ROUNDED * module:
        yield (
            f"teeth without allowances overlap by {in_um(-gap)} along the line of action at "
            f"{in_mm(fit.distance)}: they need allowances larger than that; they have no "
            f"backlash at {in_mm(fit.tight)}"
        )
    if gap > loose:
        yield (
            f"the backlash is large: {place}, which is {gap / module:.2g} modules; check centre "
            "distance, profile shifts, module and teeth"
        )
    if file_backlash is None:
        return
    if file_backlash < gap - ROUNDED * module:
        yield (
            f"backlash = {in_um(file_backlash)} is less than the teeth have: {place}, and allowances only "
            "add to it; correct one of them"
        )
    elif file_backlash > max(gap, 0.0) + loose:
        yield (
            f"backlash = {in_um(file_backlash)} is far more than the teeth have: {place}; correct one "
            "of them"
        )


def fit_line(fit: WheelPair) -> str:
    """Return the backlash and the contact ratio in a sentence."""
    ratio = f"{fit.contact_ratio:.3f}"
    if fit.overlap_ratio:
        ratio += f" and {fit.overlap_ratio:.3f} by their helix"
    cut = sum(path_cuts(fit))
    if cut > ROUNDED * fit.first.module:
        ratio += f", {in_um(cut)} of the path lost at fillets"
    return (
        f"axes {in_mm(fit.distance)} apart: backlash of teeth without allowances "
        f"{in_um(fit.backlash)} along the line of action, contact ratio {ratio}"
    )
