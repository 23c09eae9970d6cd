"""The front of two goals: designs none of which is beaten in both.

The ends of the front are the best designs by each goal alone.  Between two neighbours of the front
lies a rectangle, the only place for a design that neither beats.  The largest of these is halved in
turn: the second goal is made best where the first may be no worse than the middle of it (the
epsilon-constraint method, Haimes, Lasdon and Wismer 1971, which finds hollow parts of a front too).
A design that a search has only passed on its way is not of the front, unbeaten as it may be: nothing
has been searched beside it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from solidgear.variants.optimise.pool import Design, EnoughDesigns, Pool
from solidgear.variants.optimise.search import (
    FINE,
    FIRST,
    Aim,
    Trace,
    are_many,
    descend,
    search,
)

#: share of the span of both goals that rectangles between neighbours may leave, and rectangles that
#: are halved at most
OPEN, HALVED = 0.05, 20
#: relative, of goals that are the same; of the span of both goals, between designs that are listed
SAME, NEXT = 1e-6, 2e-3


@dataclass
class FrontTrace:
    """Record of a search for a front."""

    ends: list[Trace] = field(default_factory=list)  #: searches by each goal alone
    halved: int = 0  #: rectangles between neighbours that were searched
    #: share of the rectangle between both ends in which an unbeaten design may still lie
    open: float = 1.0
    whole: bool = False  #: whether all designs were solved, and nothing else is open
    cut: bool = False  #: whether the most designs ended it
    reached: list[Design] = field(default_factory=list)  #: ends of searches

    def front(self, pool: Pool) -> list[Design]:
        """Return the front, by the first goal from its best: ends of searches, or those that beat
        them, and all designs where these are whole.
        """
        unbeaten = unbeaten_of(pool)
        if self.whole:
            return unbeaten
        return _thinned(
            pool, [d for d in unbeaten if any(_beats(pool, d, end) for end in self.reached)]
        )


def _thinned(pool: Pool, front: list[Design]) -> list[Design]:
    """Return a front without designs that are next to the one before in both goals, but for the last."""
    if len(front) < 3:
        return front
    first, last = front[0], front[-1]
    spans = [abs(pool.loss(first, goal) - pool.loss(last, goal)) for goal in range(2)]
    out = [first]
    for design in front[1:-1]:
        steps = [
            max(
                abs(pool.loss(design, goal) - pool.loss(neighbour, goal)) / (spans[goal] or 1.0)
                for goal in range(2)
            )
            for neighbour in (out[-1], last)
        ]
        if min(steps) > NEXT:
            out.append(design)
    return [*out, last]


def _beats(pool: Pool, design: Design, rival: Design) -> bool:
    """Return True for a design that is as good as another in both goals."""
    pairs = [(pool.loss(design, goal), pool.loss(rival, goal)) for goal in range(2)]
    return all(a <= b + SAME for a, b in pairs)


def unbeaten_of(pool: Pool) -> list[Design]:
    """Return the designs that keep all limits and none of which is beaten in both goals, by the first
    goal from its best.
    """
    sound = [design for design in pool.designs if design.kept and design.place is not None]
    ordered = sorted(sound, key=lambda d: (pool.loss(d, 0), pool.loss(d, 1), d.number))
    front: list[Design] = []
    for design in ordered:
        if not front or pool.loss(design, 1) < pool.loss(front[-1], 1) - SAME:
            front.append(design)
    return front


def search_front(pool: Pool) -> FrontTrace:
    """Search the front of the two goals of a pool, which keeps its designs."""
    trace = FrontTrace()
    try:
        _between_ends(pool, trace)
    except EnoughDesigns:
        trace.cut = True
    rectangles = _rectangles(pool, trace.front(pool), set())
    trace.open = sum(area for area, _ in rectangles)
    return trace


def _between_ends(pool: Pool, trace: FrontTrace) -> None:
    most = pool.most
    for goal in range(2):
        # each goal by itself may take a quarter of the designs, what is left is for the front
        pool.most = min(most, len(pool.designs) + max(most // 4, 1))
        begin = [design for design in pool.designs if design.place is not None]
        end = search(Aim(pool, goal), begin)
        pool.most = most
        trace.ends.append(end)
        if end.whole:
            trace.whole = True
            return
        _settle_end(pool, goal, trace)
    closed: set[tuple[int, int]] = set()
    for trace.halved in range(1, HALVED + 1):
        front = trace.front(pool)
        rectangles = _rectangles(pool, front, closed)
        if sum(area for area, _ in rectangles) < OPEN:
            return
        _, (first, second) = max(rectangles, key=lambda rectangle: rectangle[0])
        _halve(pool, first, second, trace)
        if [d.number for d in trace.front(pool)] == [d.number for d in front]:
            closed.add((first.number, second.number))


def _settle_end(pool: Pool, goal: int, trace: FrontTrace) -> None:
    """Search the best of the other goal among designs as good as the best by this one."""
    sound = [design for design in pool.designs if design.kept and design.place is not None]
    if not sound:
        return
    aim = Aim(pool, goal)
    best = aim.best(sound)
    second = _no_worse_than(pool, 1 - goal, goal, pool.loss(best, goal) + SAME)
    trace.reached += [best, descend(second, best, FIRST / 4, FINE, are_many(pool))]


def _no_worse_than(pool: Pool, goal: int, limited: int, level: float) -> Aim:
    """Return the aim at a goal where another is no worse than a level."""
    size = max(abs(level), SAME)
    return Aim(pool, goal, (lambda design: (pool.loss(design, limited) - level) / size,))


def _halve(pool: Pool, first: Design, second: Design, trace: FrontTrace) -> None:
    """Search the best second goal where the first is no worse than midway between two designs."""
    level = (pool.loss(first, 0) + pool.loss(second, 0)) / 2
    aim = _no_worse_than(pool, 1, 0, level)
    starts = [first, second]
    if first.place is not None and second.place is not None:
        if first.place.choices == second.place.choices and first.place.x:
            middle = [(a + b) / 2 for a, b in zip(first.place.x, second.place.x)]
            starts = [pool.solve(first.place.moved(middle))]
    solved = [d for d in pool.designs if d.place is not None and d.goals]
    best = aim.best(solved)
    if best.place is not None and best not in starts:
        searched = {d.place.choices for d in starts if d.place is not None}
        starts += [best] if best.place.choices not in searched else []
    for start in starts:
        if start.place is not None:
            end = descend(aim, start, FIRST / 2, FINE, are_many(pool))
            trace.reached += [end] if aim.keeps(end) else []


def _rectangles(
    pool: Pool, front: Sequence[Design], closed: set[tuple[int, int]]
) -> list[tuple[float, tuple[Design, Design]]]:
    """Return the rectangles between neighbours of a front, each with the share that it has of the one
    between the ends, without those that are closed.
    """
    if len(front) < 2:
        return []
    ends = [(pool.loss(design, 0), pool.loss(design, 1)) for design in (front[0], front[-1])]
    span = abs((ends[1][0] - ends[0][0]) * (ends[1][1] - ends[0][1]))
    out = []
    for a, b in zip(front, front[1:]):
        area = abs((pool.loss(b, 0) - pool.loss(a, 0)) * (pool.loss(b, 1) - pool.loss(a, 1)))
        if (a.number, b.number) not in closed and math.isfinite(area):
            out.append((area / span if span else 0.0, (a, b)))
    return out
