"""Modes that a mesh may hide at the end of a list.

A mesh has no mode below the exact one of its number, and may have it far above: a mode just above
the end of a list may in truth lie within. The k-th eigenvalue of a family lies no lower than the
k-th lower end of that family, so that the first above the list bounds all that follow.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from solidgear.core.body import Body, Supports
from solidgear.core.bounds.harmonic import by_problem, is_bounded
from solidgear.core.judge.bounded import bounds_of
from solidgear.core.judge.solving import with_all_solved
from solidgear.core.ladder.registry import LADDER
from solidgear.core.scene import Scene
from solidgear.core.solve.modes import Mode, ModeSet

#: frequency (Hz) that the count of a mesh reaches, in the evidence of modes
COUNTED = "counted_below_hz"
#: frequency (Hz) below which the body itself has no further mode
COMPLETE = "complete_below_hz"


def complete_list(scene: Scene, body: Body, supports: Supports, listed: ModeSet) -> ModeSet:
    """Bound a list of counted modes of a solid: add the frequency below which the body
    itself has no further mode to the evidence; unchanged where none were counted, or no bound
    exists.
    """
    if COUNTED not in listed.evidence:
        return listed
    first = first_above(listed)
    if first is None:
        return listed
    needed = [mode.name for mode in first]
    if not LADDER[body.fidelity].follows:
        first = _first_of_families(listed)
    names = [mode.name for mode in first]
    bounds = bounds_of(scene, body, supports, False, with_all_solved(listed), names)
    limit = listed.evidence[COUNTED]
    for mode in first:
        least = bounds.frequency(mode)
        if least is None and mode.name in needed:
            return listed
        if least is not None:
            limit = min(limit, least * (1 - mode.error))
    return replace(listed, evidence=listed.evidence | {COMPLETE: limit})


def less_bars(evidence: dict, bars: Mapping[str, float], above: Iterable[Mode] = ()) -> dict:
    """Add to the evidence of counted modes, with error bars by name, the frequency below which the
    body itself has no further one: the least lower end of the modes above the list, if the first of
    these has one; else what the mesh counts less the widest error bar.
    """
    if not bars or COUNTED not in evidence or COMPLETE in evidence:
        return evidence
    counted = evidence[COUNTED]
    ascending = sorted(above, key=lambda mode: mode.frequency_hz)
    if ascending and ascending[0].name in bars:
        ends = [m.frequency_hz * (1 - bars[m.name]) for m in ascending if m.name in bars]
        limit = min(counted, *ends)
    else:
        limit = counted * (1 - max(bars.values()))
    return evidence | {COMPLETE: max(limit, 0.0)}


def _first_of_families(modes: ModeSet) -> list[Mode]:
    """Return the lowest mode of every family above the end of a list: a block that holds all
    families keeps their order, each for itself.
    """
    names_listed = {mode.name for mode in modes.modes}
    above = [m for m in modes.solved if m.frequency_hz > 0 and m.name not in names_listed]
    above.sort(key=lambda mode: mode.frequency_hz, reverse=True)
    return list({mode.family: mode for mode in above}.values())


def first_above(modes: ModeSet) -> list[Mode] | None:
    """Return the lowest mode of every eigenproblem above the end of a list; None where nothing was
    solved beyond those near one of them, on which the lower end rests.
    """
    names_listed = {mode.name for mode in modes.modes}
    out = []
    for group in by_problem([mode for mode in modes.solved if mode.frequency_hz > 0]):
        above = [mode for mode in group if mode.name not in names_listed]
        if not above or not is_bounded(modes, above[0]):
            return None
        out.append(above[0])
    return out
