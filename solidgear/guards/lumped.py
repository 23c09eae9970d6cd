"""Guards on lumped models."""

from __future__ import annotations

from solidgear.core import SolidgearError, gap_verdict
from solidgear.core.judge import deviations
from solidgear.core.judge.lumped import preferred
from solidgear.core.judge.ties import SCENE
from solidgear.core.quantity import FIRST_BENDING
from solidgear.guards.notice import Notice, Notices, against, beams, beyond, sure
from solidgear.guards.probe import Probe

BEAM_OR_SOLID = "a beam or a solid"
# effective_mass_limits.py: held along the head of the overhung pinion; at 7 % the receptance is
# right to 0.24 of first bending only
ENERGY = 0.95


def effective_mass(probe: Probe) -> Notices:
    """Yield a notice where there is no lumped model, or where the first mode is not nearly the
    static shape it rests on.
    """
    try:
        point, variants = probe.lumped
    except SolidgearError as error:
        yield Notice("avoid", ("lumped",), f"there is no lumped model: {error}")
        return
    thesis = variants["thesis"]
    if not thesis.feasible and probe.scene.ask.lumped:
        yield Notice(
            "fact",
            ("lumped",),
            f"the published equations of effective mass have no solution here ({thesis.verdict})",
        )
    better = probe.instead(BEAM_OR_SOLID, *beams())
    beam = "its beam" if probe.beam_fits else "the beam of the plain part"
    matched, reasons, level = variants["mode-matched"], [], "caution"
    if not (matched.feasible and matched.first):
        deviation = variants["guyan"].frequency_error
        assert deviation is not None  # its mass is always positive definite
        level = beyond(deviation, probe.scene.ask.tolerance)
        lacks = "holds the mode as its second one" if matched.feasible else "has a negative entry"
        reasons.append(
            f"the mode-matched pair of masses {lacks}, so Guyan's is taken, with first bending "
            f"{against(deviation, 'higher', 'lower')} that of {beam}"
        )
    if point.static_share < ENERGY:
        reasons.append(
            f"the static shape of {probe.scene.port.name!r} holds {100 * point.static_share:.3g} "
            f"% of the energy of first bending, less than {100 * ENERGY:g} %: a lumped model is "
            "good for stiffness only"
        )
    if reasons:
        yield Notice(level, ("lumped",), f"{'; '.join(reasons)}; use {better}")


def lumped_against_solid(probe: Probe) -> Notices:
    """Yield a notice on first bending of the lumped model, with the errors of its beam and of
    lumping, against a light harmonic solid.
    """
    try:
        _, variants = probe.lumped
    except SolidgearError:
        return  # `effective_mass` says so
    variant, solid = preferred(variants), probe.solution("harmonic")
    frequency = None if variant is None else variants[variant].frequency_hz
    truth, tolerance = solid.quantities.get(FIRST_BENDING), probe.scene.ask.tolerance
    if not truth or frequency is None:
        return
    gap = frequency / truth - 1
    bars = solid.error_bars.get(SCENE, {})
    bar = bars[FIRST_BENDING].width if FIRST_BENDING in bars else 0.0
    kind = gap_verdict(gap, bar, tolerance)
    text = (
        f"its first bending is {against(gap, 'higher', 'lower')} that of a light harmonic "
        f"solid{sure(bar)}"
    )
    if kind == deviations.BEYOND:
        yield Notice(
            "avoid",
            ("lumped",),
            f"{text}, more than the {100 * tolerance:g} % asked for; use {probe.instead(BEAM_OR_SOLID, *beams())}",
        )
    elif kind == deviations.OPEN:
        yield Notice(
            "open",
            ("lumped",),
            f"{text}, which is too close to the {100 * tolerance:g} % asked for to tell; run "
            "compare to find out",
        )


# guyan_in_frequency.py: off by 1 % and 10 % of the static stiffness, over the first frequency with
# the lumped point held
HOLDS, DRIFTS = 0.39, 0.63


def frequency_range(probe: Probe) -> Notices:
    """Yield a notice where the range asked for reaches towards the first mode that a condensed
    model cannot have.
    """
    highest = probe.scene.ask.max_frequency
    if highest and (pole := probe.fixed_interface) and highest > HOLDS * pole:
        yield Notice(
            "avoid" if highest > pole else "caution",
            ("lumped",),
            f"within the {highest:g} Hz asked for it lacks the mode at {pole:.4g} Hz (lumped point "
            f"held), and is 1 % off from {HOLDS * pole:.4g} Hz, 10 % from {DRIFTS * pole:.4g} Hz; "
            f"use {probe.instead(BEAM_OR_SOLID, *beams())} above",
        )
