"""Teeth of two cylindrical gears at their centre distance: refusals, cautions and facts.

Without allowances, as :mod:`solidgear.core.gears.wheel_pair` computes them; teeth of which the file says
no more have the basic rack of ISO 53.
"""

from __future__ import annotations

from collections.abc import Iterator

from solidgear.core import SceneError
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.trains.file.mesh_teeth import wheels_of
from solidgear.trains.file.pairs import Pair

#: modules of overlap that two digits of the profile shifts leave open, and that the usual thinning
#: of both wheels takes up (DIN 3967, cd25): no caution below the first, refused above the second
ROUNDED, THINNED = 5e-3, 0.05
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
        bore = min(s.radius_at(y)[0] for s in gear.scene.segments if s.y0 <= y <= s.y1)
        if root <= bore:
            yield SceneError(
                f"puts the roots of its teeth at {_mm(root)} from the axis, inside the bore of "
                f"its shaft, {_mm(bore)}; correct the teeth, the module, the profile shift or the "
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
        f"{first.count} and {second.count} teeth of {_mm(first.module)} module with profile shifts "
        f"that sum to {first.shift + second.shift:.4g}"
    )
    if fit.backlash < -THINNED * first.module:
        yield SceneError(
            f"is too short: {teeth_label} overlap there by {_um(-fit.backlash)} along the line of "
            f"action; they have no backlash at {_mm(fit.tight)}; correct the distance, the teeth, "
            "the module, the helix angle or the profile shifts",
            path=path,
        )
    elif fit.contact_ratio <= 0 and first.tip_radius is second.tip_radius is None:
        yield SceneError(
            f"is too long: {teeth_label} do not reach each other, for their tips lie at "
            f"{_mm(first.tip)} and {_mm(second.tip)}; correct the distance, the teeth, the "
            "module, the helix angle or the profile shifts",
            path=path,
        )


def fit_cautions(fit: WheelPair, sides: tuple[str, str]) -> Iterator[str]:
    """Yield cautions on wheels whose tips reach too far or not far enough; `sides` name the shafts."""
    wheels = wheels_in(fit)
    for clearance, wheel, side, mate in zip(fit.clearances, wheels, sides, sides[::-1]):
        if clearance < 0:
            cause = "profile shifts and centre distance ask for shorter tips"
            if wheel.tip_radius is not None:
                cause = f"its tip_diameter is at most {_mm(2 * (wheel.tip + clearance))} there"
            yield (
                f"tips of the {side} reach {_um(-clearance)} into the roots of the {mate}, "
                f"with teeth of ISO 53: {cause}"
            )
    for k, cut in enumerate(path_cuts(fit)):
        wheel, side, mate = wheels[k], sides[k], sides[1 - k]
        # a ring whose tips the file leaves open is made with shorter ones
        is_described = wheels[1 - k].sign > 0 or wheels[1 - k].tip_radius is not None
        if cut > ROUNDED * wheel.module and not wheel.is_undercut and is_described:
            yield (
                f"tips of the {mate} meet the fillets of the {side}, whose flanks end at "
                f"{_mm(wheel.form)} from the axis: {_um(cut)} of the path of contact are lost "
                f"there; shorten the tips of the {mate}, or give the {side} another rack"
            )
    if fit.contact_ratio + fit.overlap_ratio < 1:
        helical = f" and {fit.overlap_ratio:.2f} by their helix" if fit.base_helix else ""
        yield (
            f"the contact ratio is {fit.contact_ratio:.2f}{helical}, below 1: no teeth touch for a "
            "part of each pitch; correct centre distance, profile shifts, module or teeth"
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
    if wheel.tip_thickness < 0:
        yield (
            f"teeth of the {side} end in a point before their tip circle: a profile shift of "
            f"{wheel.shift:g} is too much for {wheel.count} teeth"
        )


def backlash_cautions(fit: WheelPair, file_backlash: float | None) -> Iterator[str]:
    """Yield cautions on a backlash that is large, or contradicts that of the file, m."""
    gap, module = fit.backlash, fit.first.module
    loose = LOOSE * module
    place = f"teeth without allowances leave {_um(gap)} along the line of action at"
    place += f" {_mm(fit.distance)}"
    if gap < -ROUNDED * module:
        yield (
            f"teeth without allowances overlap by {_um(-gap)} along the line of action at "
            f"{_mm(fit.distance)}: they need allowances larger than that; they have no "
            f"backlash at {_mm(fit.tight)}"
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
            f"backlash = {_um(file_backlash)} is less than the teeth have: {place}, and allowances only "
            "add to it; correct one of them"
        )
    elif file_backlash > max(gap, 0.0) + loose:
        yield (
            f"backlash = {_um(file_backlash)} is far more than the teeth have: {place}; correct one "
            "of them"
        )


def fit_line(fit: WheelPair) -> str:
    """Return the backlash and the contact ratio in a sentence."""
    ratio = f"{fit.contact_ratio:.3f}"
    if fit.overlap_ratio:
        ratio += f" and {fit.overlap_ratio:.3f} by their helix"
    cut = sum(path_cuts(fit))
    if cut > ROUNDED * fit.first.module:
        ratio += f", {_um(cut)} of the path lost at fillets"
    return (
        f"axes {_mm(fit.distance)} apart: backlash of teeth without allowances "
        f"{_um(fit.backlash)} along the line of action, contact ratio {ratio}"
    )


def _mm(length: float) -> str:
    return f"{1e3 * length:.6g} mm"


def _um(length: float) -> str:
    if length >= 1e-3:
        return f"{1e3 * length:.4g} mm"
    return f"{round(1e6 * length, 1) + 0.0:.4g} um"
