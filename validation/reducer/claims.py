"""Verdicts on the source's claims: over a turn at rest, and in time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from validation.common import markdown
from validation.reducer.dynamics import RUNOUT, Seen
from validation.reducer.study import MOST, SEEN, Outcome

#: share of the variance at other than mesh frequencies and their multiples
FOREIGN = 0.1
#: relative, of what a bearing leaves as it is
STAYS = 1e-3
#: m; a line of less is none
NONE = 1e-8
#: N, internal and external, on three bearings
SOURCE = (515.0, 540.0)


def table(found: list[Outcome], in_time: Mapping[str, Seen]) -> list[str]:
    """Table of the five claims."""
    rests, moves = _at_rest(found), _in_time(in_time)
    rows = [
        (claim, rest, moving, "; ".join(filter(None, (one, other))))
        for (claim, rest, one), (moving, other) in zip(rests, moves)
    ]
    return markdown(("claim", "over a turn at rest", "in time", "holds in"), rows)


def _at_rest(found: list[Outcome]) -> list[tuple[str, str, str]]:
    low, middle, high = _quantiles([o.two / o.mean for o in found], 100)
    seen = {
        overhung: share([o.two > SEEN * o.mean for o in found if o.design.overhung is overhung])
        for overhung in (False, True)
    }
    halved = share([o.three < MOST * o.two for o in found])
    tight = share([o.tight < MOST * o.two for o in found])
    more = share([o.three > (1 + STAYS) * o.two for o in found])
    lifts = sum(o.two > o.mean for o in found)
    return [
        (
            "1 statics: ratio, torques, mean forces",
            "holds to 1e-10",
            share([o.balanced for o in found]),
        ),
        ("2 ideal joints: mesh frequency", "", ""),
        ("3 the input shaft swings", "", ""),
        (
            "4 modulation at the carrier's frequency",
            f"{low} to {high} % of the mean force in nine of ten, median {middle} %; in {lifts} a "
            "planet would lift, and is no spring any more",
            f"above {100 * SEEN:.0f} %: {seen[False]}; overhung {seen[True]}",
        ),
        (
            "5 a third bearing removes most",
            "clearance decides; the bevel force stays",
            f"halved at rest: {halved}, without clearance {tight}; larger: {more}",
        ),
    ]


def _in_time(all_: Mapping[str, Seen]) -> list[tuple[str, str]]:
    ideal, two, three, rough = (all_[name] for name in ("ideal", "two", "three", "two, runout"))
    off = max(np.abs(one.mean / one.statics - 1).max() for one in all_.values())
    swing = _quantiles(ideal.swing / ideal.mean, 100)
    near, far = (_quantiles(1e6 * one[0], 1, ".2g") for one in (two.near, two.far))
    line, bevel = _quantiles(1e9 * rough.shaft), _quantiles(all_["ideal, runout"].bevel, 1, ".2g")
    carrier = _quantiles(two.carrier / two.mean, 100)
    halved, grows = three.carrier < MOST * two.carrier, three.mesh > (1 + STAYS) * two.mesh
    below_two, below = (
        np.maximum(three.external / other.external, three.internal / other.internal) < 1 - STAYS
        for other in (two, ideal)
    )
    at_rest = three.closed < MOST * two.closed
    stays = np.abs(three.near[0] / two.near[0] - 1) < STAYS
    return [
        (f"mean forces over a turn within {off:.0e}", ""),
        (
            f"mesh forces swing by {swing[0]} to {swing[2]} % of their mean; at least "
            f"{100 * (1 - ideal.foreign.max()):.0f} % of the variance at mesh frequencies and "
            "multiples, the rest at their sums and differences",
            share(ideal.foreign < FOREIGN),
        ),
        (
            f"its mesh end shifts by {near[0]} to {near[2]} µm, its far end by {far[0]} to {far[2]} "
            "µm; **its speed is no frequency of the motion** unless something goes round with it: "
            f"{1e6 * RUNOUT:.0f} µm of runout bring {line[0]} to {line[2]} nm at the mesh end, and "
            f"{bevel[0]} to {bevel[2]} N of bevel force even on ideal joints",
            f"mesh end shifts more: {share(two.near[0] > two.far[0])}; swings more: "
            f"{share(two.near[1] > two.far[1])}; its frequency without runout: "
            f"{share(two.shaft > NONE)}",
        ),
        (
            f"{carrier[0]} to {carrier[2]} % of the mean force, median {carrier[1]} %; teeth part "
            f"in {int(two.apart.sum())}",
            f"a larger maximum than on ideal joints: {share(two.external > ideal.external)}",
        ),
        (
            "515 and 540 N need a torque (below)",
            f"halved in time: {share(halved)}, at rest with such teeth and rigid shafts "
            f"{share(at_rest)}; mesh lines grow: {share(grows)}; maximum below that "
            f"of two: {share(below_two)}, below that of ideal joints: {share(below)}; all four: "
            f"{share(halved & grows & below_two & below)}; shift of the input shaft stays: "
            f"{share(stays)}",
        ),
    ]


def source_forces(three: Seen, torques: np.ndarray) -> dict[str, str]:
    """The source's two largest forces beside those of designs on three bearings."""
    internal, external = SOURCE
    needed = _quantiles(torques * external / three.external, 1, ".2g")
    ratio = _quantiles(three.external / three.internal, 1, ".3f")
    return {
        "lowest": f"{three.external.min():.0f}",
        "highest": f"{three.external.max():.0f}",
        "needed_low": needed[0],
        "needed_high": needed[2],
        "ratio_low": ratio[0],
        "ratio_high": ratio[2],
        "source_ratio": f"{external / internal:.3f}",
    }


def departure(two: Seen) -> tuple[str, str, int]:
    """Of the modulation in time from its closed form, per cent, while no teeth part: nine of ten
    designs lie between, and how many keep contact.
    """
    held = two.apart == 0
    low, _, high = _quantiles((two.carrier / two.closed - 1)[held], 100, ".1f")
    return low, high, int(held.sum())


def share(true: Sequence[bool] | np.ndarray) -> str:
    """So many of all."""
    return f"{int(np.sum(true))} of {len(true)}"


def _quantiles(values, scale: float = 1.0, form: str = ".0f") -> list[str]:
    found = np.quantile(scale * np.asarray(values), [0.05, 0.5, 0.95])
    return [format(value, form).replace("-", "−") for value in found]
