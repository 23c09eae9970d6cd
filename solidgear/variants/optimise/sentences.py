"""Conclusions of a search in words: the best design, what was searched, and how sure it is."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from solidgear.core.judge.change import Change
from solidgear.show.units import ENGINEERING, Units
from solidgear.variants.optimise.front import FrontTrace
from solidgear.variants.optimise.outcome import Outcome
from solidgear.variants.optimise.pool import Design
from solidgear.variants.optimise.search import FINE, TOLERANCE, Trace
from solidgear.variants.optimise.wish import Wish
from solidgear.variants.sweep.entries import Entry, in_si
from solidgear.variants.sweep.shaft_numbers import LOCAL, NOT_RATED, SAFETIES

#: relative error bar that is rounding alone
ROUNDING = 1e-9


def sentences(optimum: Outcome, units: Units = ENGINEERING) -> Iterator[str]:
    """Yield the conclusions of a search."""
    solved = [design for design in optimum.path if design.status == "ok"]
    if not solved:
        yield f"No design could be solved; the file as it is: {optimum.path[0].status}."
        return
    if optimum.best is None:
        yield from _without_any(optimum, solved, units)
    elif optimum.front:
        yield from _front(optimum, units)
    else:
        yield from _best(optimum, optimum.best, units)
    if optimum.best is not None:
        yield from _not_rated(optimum, optimum.front or [optimum.best])
    yield from solved_all_of(optimum)
    yield from _refused(optimum)
    for sentence in optimum.followed:
        yield f"{sentence}."


def _without_any(optimum: Outcome, solved: Sequence[Design], units: Units) -> Iterator[str]:
    """Yield sentences on a search in which no design keeps all limits."""
    limits = ", ".join(map(str, optimum.keep))
    yield f"No design of {len(solved)} keeps {limits}, error bars included."
    missing = {d.number: max(wish.missing(d.rows) for wish in optimum.keep) for d in solved}
    closest = min(solved, key=lambda design: missing[design.number])
    yield (
        f"The nearest misses by {100 * missing[closest.number]:.3g} % of the limit, at "
        f"{listed_values(optimum, closest, units)}."
    )


def _front(optimum: Outcome, units: Units) -> Iterator[str]:
    """Yield sentences on a front of two goals."""
    front, (first_goal, second_goal) = optimum.front, optimum.goals
    both = f"both {first_goal.name} and {second_goal.name}"
    if len(front) > 1:
        yield f"{len(front)} designs are beaten by no other in {both}."
    else:
        yield f"One design is the best in {both}."
    ends = (front[0], front[-1]) if len(front) > 1 else front[:1]
    for design in ends:
        yield (
            f"{numbers(optimum, design, units)} at {listed_values(optimum, design, units)} "
            f"(design {design.number})."
        )
    first = optimum.path[0]
    if first.kept and first.goals:
        better = [design for design in front if _beats(optimum, design, first)]
        if better:
            words = f"{len(better)} of them are" if len(better) > 1 else "1 of them is"
            yield f"{words} better in both than the file as it is, {numbers(optimum, first, units)}."
    blurred = sum(_as_good(optimum, a, b) for a, b in zip(front, front[1:]))
    if blurred:
        yield f"{blurred} of them differ from the next by less than the error bars."
    if optimum.unbarred:
        yield f"They have no error bars ({optimum.unbarred.removeprefix('none: ')})."


def _beats(optimum: Outcome, design: Design, rival: Design) -> bool:
    """Return True for a design that is better than another in every goal."""
    pairs = zip(optimum.goals, design.goals, rival.goals)
    return all((a.value > b.value) if goal.upward else (a.value < b.value) for goal, a, b in pairs)


def _as_good(optimum: Outcome, design: Design, rival: Design) -> bool:
    """Return True where error bars of two designs leave open which is better, in every goal."""
    pairs = zip(design.goals, rival.goals)
    changes = [Change(a.value, b.value, a.bar, b.bar) for a, b in pairs]
    return all(change.verdict == "not resolved" for change in changes)


def _best(optimum: Outcome, best: Design, units: Units) -> Iterator[str]:
    """Yield sentences on the best design of one goal."""
    goal, gain = optimum.goal, optimum.gain
    yield (
        f"{goal}: {numbers(optimum, best, units)} at {listed_values(optimum, best, units)} "
        f"(design {best.number})."
    )
    if best.number == 0:
        yield "No design is better than the file as it is by more than the error bars."
    elif gain is not None:
        file = f"the file as it is, {with_bar(goal, gain.a, gain.bar_a, units)}"
        if not optimum.path[0].kept:
            file += ", which misses a limit"
        percent = f"{100 * (gain.relative or 0.0):+.3g} % from {file}"
        if gain.verdict == "no band":
            yield f"{percent}; it has no error bars ({optimum.unbarred.removeprefix('none: ')})."
        elif gain.verdict == "resolved":
            yield f"{percent}."
        else:
            yield (
                f"No gain is claimed over {file}: the difference is within the error bars; a "
                "smaller --tol narrows them."
            )
    changes = [
        Change(design.value, best.value, design.bar, best.bar)
        for design in optimum.path
        if design is not best
        and design.kept
        and design.value is not None
        and best.value is not None
    ]
    count = sum(change.verdict == "not resolved" for change in changes)
    if count:
        designs = "designs are" if count > 1 else "design is"
        yield f"{count} more {designs} as good within the error bars."
    for label in optimum.at_end:
        yield f"{label} is at the end of its range; a wider range may hold a better design."


def _not_rated(optimum: Outcome, designs: Sequence[Design]) -> Iterator[str]:
    """Yield a sentence on what has no safety in designs that are judged by one."""
    asked = {wish.name.replace(" ", "_") for wish in (*optimum.goals, *optimum.keep)}
    if not asked & {*SAFETIES, LOCAL}:
        return
    names = [row.get(NOT_RATED) for design in designs for row in design.rows]
    for name in dict.fromkeys(filter(None, names)):
        yield f"Not rated, and perhaps worse: {name}."


def numbers(optimum: Outcome, design: Design, units: Units) -> str:
    """Return the goals of a design in words."""
    if len(optimum.goals) == 1:
        return with_bar(optimum.goal, design.value, design.bar, units)
    pairs = zip(optimum.goals, design.goals)
    return " and ".join(f"{g.name} {with_bar(g, n.value, n.bar, units)}" for g, n in pairs)


def with_bar(wish: Wish, value: float | None, bar: float | None, units: Units) -> str:
    """Return a number with its error bar and unit."""
    text = units.number(value, wish.unit, 5)
    if bar and value and bar > ROUNDING * abs(value):
        text += f" ± {units.number(bar, wish.unit, 2)}"
    return f"{text} {units.unit(wish.unit)}".strip()


def listed_values(optimum: Outcome, design: Design, units: Units = ENGINEERING) -> str:
    """Return the values of a design, in the units in which they were asked for."""
    entries = {entry.label: entry for entry in optimum.entries}
    return ", ".join(
        f"{label} = {value_text(entries.get(label), value, units)}"
        for label, value in design.values.items()
    )


def value_text(entry: Entry | None, value: str | float | None, units: Units = ENGINEERING) -> str:
    """Return a value of an entry in the unit in which it was asked for; of one that follows, in mm."""
    if value is None:
        return "as in the file"
    if isinstance(value, str):
        return value
    if entry is None:
        return units.text(value, "m", 5) if abs(value) < 10 else f"{value:.6g}"
    size = in_si(f"1 {entry.shown_in}") if entry.shown_in else 1.0
    return f"{value / (size or 1.0):.6g} {entry.shown_in}".strip()


# ------------------------------------------------------------------------------ how it was searched
def solved_all_of(optimum: Outcome) -> Iterator[str]:
    """Yield sentences on what was searched, and how sure the result is."""
    trace = optimum.trace
    if isinstance(trace, FrontTrace):
        yield from _searched_front(optimum, trace)
    else:
        yield from _searched(optimum, trace)


def _searched(optimum: Outcome, trace: Trace) -> Iterator[str]:
    """Yield sentences on a search by one goal."""
    best, count = optimum.best, len(optimum.path)
    if trace.whole:
        yield f"Searched: all {trace.sampled} combinations, so that none is better."
        return
    space = _space(optimum, trace)
    searches = _count_of(len(trace.ends), "local search", "local searches")
    yield (
        f"Searched: {count} designs; {trace.sampled} across {space}, then {searches} (COBYQA) from "
        "separate places."
    )
    if trace.missed:
        yield f"{_count_of(trace.missed, 'combination')} of the lists left out."
    if trace.refused:
        yield f"{_count_of(trace.refused, 'combination')} of the lists refused in every design."
    if trace.passed and math.isfinite(trace.nearest_passed) and best is not None:
        yield (
            f"{_count_of(trace.passed, 'combination')} sampled without a local search; the nearest is "
            f"{100 * trace.nearest_passed:.3g} % behind the best, missed limits counted."
        )
    if trace.cut:
        yield (
            f"Stopped at {optimum.most} designs before a further round brought nothing: the best may "
            "be a local one; a larger --most goes on."
        )
    elif best is not None:
        yield (
            f"The last round, {_count_of(trace.further_samples, 'further design')} and "
            f"{_count_of(trace.further_searches, 'search', 'searches')}, brought nothing better by "
            f"{100 * TOLERANCE:g} %."
        )
    if best is not None:
        yield from _ends(optimum, trace, best)


def _ends(optimum: Outcome, trace: Trace, best: Design) -> Iterator[str]:
    """Yield a sentence on where local searches ended."""
    upward, size = optimum.goal.upward, abs(best.value or 0.0)
    behind = [
        abs(end.end.value - (best.value or 0.0)) / (size or 1.0)
        for end in trace.ends
        if end.end.value is not None and end.end.kept
    ]
    at_best = sum(share <= NEAR_BEST for share in behind)
    further = [share for share in behind if share > NEAR_BEST]
    if not trace.ends:
        return
    text = f"{at_best} of {len(trace.ends)} searches ended within {100 * NEAR_BEST:g} % of the best"
    if further:
        word = "below" if upward else "above"
        text += f", the others {100 * min(further):.2g} % or more {word} it"
    missed = len(trace.ends) - len(behind)
    text += f"; {missed} where a limit is missed" if missed else ""
    yield f"{text}; the best was searched to {FINE:g} of the ranges."


#: relative distance of the end of a coarse search that has come to the best
NEAR_BEST = 0.01


def _searched_front(optimum: Outcome, trace: FrontTrace) -> Iterator[str]:
    """Yield sentences on a search for a front."""
    if trace.whole:
        count = trace.ends[0].sampled
        yield f"Searched: all {count} combinations, so that the front is whole."
        return
    searches = sum(len(end.ends) for end in trace.ends)
    yield (
        f"Searched: {len(optimum.path)} designs; each goal by itself ({searches} local searches), "
        f"then {_count_of(trace.halved, 'time')} the best {optimum.goals[1].name} for a level of "
        f"{optimum.goals[0].name} between neighbours of the front."
    )
    if len(optimum.front) > 1:
        yield (
            f"Between neighbours, designs that neither beats are open in {100 * trace.open:.2g} % of "
            "the area that both ends span."
        )
    missed = max((end.missed for end in trace.ends), default=0)
    if missed:
        yield f"{_count_of(missed, 'combination')} of the lists left out."
    if trace.cut:
        yield (
            f"Stopped at {optimum.most} designs: the front may have gaps and ends further out; a "
            "larger --most goes on."
        )


def _count_of(count: int, thing: str, things: str = "") -> str:
    """Return a number of things in words."""
    return f"{count} {thing if count == 1 else things or f'{thing}s'}"


def _space(optimum: Outcome, trace: Trace) -> str:
    ranges = sum(entry.open for entry in optimum.entries)
    lists = len(optimum.entries) - ranges
    total = math.prod(len(entry.values) for entry in optimum.entries if not entry.open)
    combinations = f"{total - trace.missed} of {total} combinations of the lists"
    spans = "the ranges" if ranges > 1 else "the range"
    if not lists:
        return spans
    return f"{combinations} and {spans}" if ranges else combinations


def _refused(optimum: Outcome) -> Iterator[str]:
    """Yield a sentence on designs that were refused, with the commonest reason."""
    whys = [design.status for design in optimum.path if design.status != "ok"]
    if not whys:
        return
    reasons = [*dict.fromkeys(whys)]
    usual = max(reasons, key=whys.count)
    count = f"{len(whys)} designs were" if len(whys) > 1 else "1 design was"
    more = f" (and {len(reasons) - 1} more reasons: see the designs)" if len(reasons) > 1 else ""
    yield f"{count} refused: {usual}{more}."
