"""Modes that a mesh may hide at the end of a list.

A mesh has no mode below the exact one of its number, and may have it far above: what it puts just
above a list may in truth lie within. The k-th eigenvalue of a family lies no lower than the k-th of
its lower ends, so that the first above the list tells for all that follow it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from solidgear.body import Body, Supports
from solidgear.bounds.harmonic import APART, harmonic_bounds, of_one_problem
from solidgear.bounds.safety import LOCAL
from solidgear.judge.bounded import ABOVE
from solidgear.judge.solving import MOST_SHAPES, widened
from solidgear.scene import Scene
from solidgear.scene.coned import coned
from solidgear.solve.modes import Mode, ModeSet, modes

#: frequency (Hz) that the count of a mesh reaches, in the evidence of modes
COUNTED = "counted_below_hz"
#: frequency (Hz) below which the body itself has no further mode
COMPLETE = "complete_below_hz"


def complete_list(scene: Scene, body: Body, supports: Supports, found: ModeSet) -> ModeSet:
    """Counted modes of a harmonic body, with the frequency below which the body itself has no further
    one in their evidence; unchanged where none were counted, or nothing tells it.
    """
    if COUNTED not in found.evidence:
        return found
    shapes = sum(mode.multiplicity for mode in found.modes)
    every, count = found, shapes
    while (first := _first_above(every)) is None and count < MOST_SHAPES:
        count += ABOVE if count == shapes else count - shapes
        every = widened(found, modes(body, supports, count))
    if first is None:
        return found
    known = replace(every, beyond=(*every.beyond, *every.above), above=())
    names = [mode.name for mode in (*_elastic(found), *first)]
    bounds = harmonic_bounds(
        coned(scene), body, statics=False, modes=known, wanted=names, safety=LOCAL
    )
    least = {mode.name: bounds.frequency(mode) * (1 - mode.error) for mode in first}
    limit = min([found.evidence[COUNTED], *least.values()])
    return replace(every, evidence=found.evidence | {COMPLETE: limit})


def less_widest(evidence: dict, bars: Iterable[float]) -> dict:
    """Evidence of counted modes whose bars come from several meshes, with the frequency below which the
    body itself has no further one: that of the mesh less the widest bar.
    """
    widest = max(bars, default=None)
    if widest is None or COUNTED not in evidence or COMPLETE in evidence:
        return evidence
    return evidence | {COMPLETE: evidence[COUNTED] * max(1 - widest, 0.0)}


def _elastic(found: ModeSet) -> list[Mode]:
    return [mode for mode in found.modes if mode.frequency_hz > 0]


def _first_above(found: ModeSet) -> list[Mode] | None:
    """The lowest mode of every eigenproblem above the end of a list; None where one of them has no other
    mode clear above it, on whose distance its lower end rests.
    """
    listed = {mode.name for mode in found.modes}
    left = [mode for mode in found.solved if mode.frequency_hz > 0]
    left.sort(key=lambda mode: mode.frequency_hz)
    out = []
    while left:
        group = [mode for mode in left if of_one_problem(mode, left[0])]
        left = [mode for mode in left if mode not in group]
        above = [mode for mode in group if mode.name not in listed]
        if not above or (above[0].frequency_hz / above[-1].frequency_hz) ** 2 > 1 - APART:
            return None
        out.append(above[0])
    return out
