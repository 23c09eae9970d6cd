"""Branches apart from that which begins at low speed: where they are searched, and sentences and
data on them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from solidgear.backlash.solver.apart import STARTS, search
from solidgear.backlash.solver.continuation import Branch
from solidgear.backlash.solver.stability import multipliers
from solidgear.backlash.torque import Backlash, Range
from solidgear.core.plain import plain

#: share of a mean force that the linear one must exceed where branches apart are looked for
LIVELY = 0.2
PERIODS = {1: "one mesh period", 2: "two mesh periods", 3: "three mesh periods"}
APART = "A separate branch of {0} from {1}: {2}."
MERGED = "Motions of {0} come off a branch from {1}: {2}."
SEARCHED = (
    "Separate branches, which a blow can reach but a slow sweep cannot, were searched from {0} "
    "starts at {1} speeds from {2}, with 1 to {3} mesh periods{4}."
)
OTHERS, NONE = "; there may be others", ": none was found, and there may be some"
UNSEARCHED = "Branches separate from this one were not searched."
QUIET = (
    "Separate branches were not searched: the linear force stays below {0:.0f} % of the mean force."
)


def search_branches(backlash: Backlash, count: int, step: float) -> Backlash:
    """Return the same with the branches apart that are found from starts at so many speeds."""
    results = search(
        backlash.branch, (2 * np.pi * _start_frequencies(backlash, count)).tolist(), step
    )
    branches = tuple(
        replace(
            backlash,
            branch=branch.branch,
            multiplier=largest_multipliers(branch.branch),
            periods=branch.periods,
            end=branch.end,
        )
        for branch in results.branches
    )
    return replace(backlash, search=results, branches_apart=branches)


def largest_multipliers(branch: Branch) -> np.ndarray:
    """Return the (p,) largest multiplier of each motion."""
    return np.array([multipliers(point)[0] for point in branch.points])


def _start_frequencies(backlash: Backlash, count: int) -> np.ndarray:
    """Return frequencies in even ratios over those at which the linear force of some mesh exceeds a
    share of the mean, or over all where the mesh varies, Hz.
    """
    hz = backlash.frequency_hz
    if not backlash.teeth.varies:
        hz = backlash.linear[0]
        lively = [mesh.linear[1] > LIVELY * mesh.teeth.mean_force for mesh in backlash.meshes]
        hz = hz[np.any(lively, axis=0)]
    return np.geomspace(hz.min(), hz.max(), count) if len(hz) else hz


def branch_sentences(
    backlash: Backlash, frequency_text: Callable[[float], str], range_text: Callable[[Range], str]
) -> list[str]:
    """Return sentences on starts and motions found; two functions put a frequency and a range of
    them into words.
    """
    results = backlash.search
    if results is None:
        return [UNSEARCHED]
    if not len(results.omega):
        return [QUIET.format(100 * LIVELY)]
    lines = []
    for branch in backlash.branches_apart:
        motion = "nowhere stable"
        if branch.calm:
            hz, size = branch.loudest
            motion = (
                f"stable from {range_text(branch.calm)}, up to {size:.0f} N at "
                f"{frequency_text(hz)}; in time a period is off by {100 * branch.departs:.1g} %"
            )
        sentence = MERGED if branch.end == "merged" else APART
        lines.append(
            sentence.format(
                PERIODS[branch.periods], range_text(_range(branch.frequency_hz)), motion
            )
        )
    ends = range_text(_range(results.omega / (2 * np.pi)))
    lines.append(
        SEARCHED.format(
            results.starts,
            len(results.omega),
            ends,
            max(STARTS),
            OTHERS if backlash.branches_apart else NONE,
        )
    )
    if results.lost:
        sentence = ", ".join(
            frequency_text(omega / (2 * np.pi)) for omega in sorted({*results.lost})
        )
        lines.append(f"Further motions at {sentence} could not be followed.")
    return lines


def _range(hz: np.ndarray) -> Range:
    return Range(float(hz.min()), float(hz.max()))


def branch_data(backlash: Backlash) -> dict[str, Any]:
    """Return search and branches apart as plain data, SI."""
    results = backlash.search
    search = results and {
        "frequency_hz": (results.omega / (2 * np.pi)).tolist(),
        "starts": results.starts,
        "not_followed_hz": [omega / (2 * np.pi) for omega in results.lost],
    }
    return {"search": search, "apart": [_branch(branch) for branch in backlash.branches_apart]}


def _branch(branch: Backlash) -> dict[str, Any]:
    hz, size = branch.loudest
    return {
        "mesh_periods": branch.periods,
        "end": branch.end,
        **plain(_range(branch.frequency_hz)),
        "stable": plain(branch.calm),
        "largest": {"frequency_hz": hz, "force": size} if branch.calm else None,
        "off_in_time": branch.departs,
    }
