"""Branches apart from that which begins at low speed: where they are looked for, and how they are told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from solidgear.nonlinear.apart import STARTS, search
from solidgear.nonlinear.continuation import Branch
from solidgear.nonlinear.stability import multipliers
from solidgear.studies.train.backlash import Backlash, Range

#: share of a mean force that the linear one must exceed where branches apart are looked for
LIVELY = 0.2
PERIODS = {1: "one mesh period", 2: "two mesh periods", 3: "three mesh periods"}
APART = "A branch apart of {0} from {1}: {2}."
MERGED = "Motions of {0} come off a branch from {1}: {2}."
SEARCHED = (
    "Branches apart, which a blow can reach and a slow sweep not, were looked for from {0} starts at {1} speeds "
    "from {2}, of 1 to {3} mesh periods{4}."
)
OTHERS, NONE = "; there may be others", ": none was found, and there may be some"
UNSEARCHED = "Branches apart from this one were not looked for."
QUIET = (
    "Branches apart were not looked for: the linear force stays below {0:.0f} % of the mean one."
)


def searched(found: Backlash, count: int, step: float) -> Backlash:
    """The same with the branches apart that are found from starts at so many speeds."""
    looked = search(found.branch, (2 * np.pi * _lively(found, count)).tolist(), step)
    apart = tuple(
        replace(
            found,
            branch=one.branch,
            multiplier=largest(one.branch),
            periods=one.periods,
            end=one.end,
        )
        for one in looked.branches
    )
    return replace(found, search=looked, apart=apart)


def largest(branch: Branch) -> np.ndarray:
    """(p,) largest multiplier of each motion."""
    return np.array([multipliers(point)[0] for point in branch.points])


def _lively(found: Backlash, count: int) -> np.ndarray:
    """Frequencies in even ratios over those at which the linear force of some mesh exceeds a share of
    its mean, or over all where the mesh varies, Hz.
    """
    hz = found.frequency_hz
    if not found.teeth.varies:
        hz = found.linear[0]
        over = [one.linear[1] > LIVELY * one.teeth.mean_force for one in found.every]
        hz = hz[np.any(over, axis=0)]
    return np.geomspace(hz.min(), hz.max(), count) if len(hz) else hz


def sentences(
    found: Backlash, at: Callable[[float], str], span: Callable[[Range], str]
) -> list[str]:
    """Sentences of starts and motions found, with words for a frequency and for a range of them."""
    looked = found.search
    if looked is None:
        return [UNSEARCHED]
    if not len(looked.omega):
        return [QUIET.format(100 * LIVELY)]
    lines = []
    for one in found.apart:
        what = "nowhere stable"
        if one.calm:
            hz, size = one.loudest
            what = (
                f"stable from {span(one.calm)}, up to {size:.0f} N at {at(hz)}; in time a period is "
                f"off by {100 * one.departs:.1g} %"
            )
        told = MERGED if one.end == "merged" else APART
        lines.append(told.format(PERIODS[one.periods], span(_ends(one.frequency_hz)), what))
    ends = span(_ends(looked.omega / (2 * np.pi)))
    lines.append(
        SEARCHED.format(
            looked.starts, len(looked.omega), ends, max(STARTS), OTHERS if found.apart else NONE
        )
    )
    if looked.lost:
        told = ", ".join(at(omega / (2 * np.pi)) for omega in sorted({*looked.lost}))
        lines.append(f"Further motions at {told} could not be followed.")
    return lines


def _ends(hz: np.ndarray) -> Range:
    return Range(float(hz.min()), float(hz.max()))


def plain(found: Backlash) -> dict[str, Any]:
    """Search and branches apart as plain data, SI."""
    looked = found.search
    search = looked and {
        "frequency_hz": (looked.omega / (2 * np.pi)).tolist(),
        "starts": looked.starts,
        "not_followed_hz": [omega / (2 * np.pi) for omega in looked.lost],
    }
    return {"search": search, "apart": [_plain(one) for one in found.apart]}


def _plain(one: Backlash) -> dict[str, Any]:
    hz, size = one.loudest
    return {
        "mesh_periods": one.periods,
        "end": one.end,
        **asdict(_ends(one.frequency_hz)),
        "stable": asdict(one.calm) if one.calm else None,
        "largest": {"frequency_hz": hz, "force": size} if one.calm else None,
        "off_in_time": one.departs,
    }
