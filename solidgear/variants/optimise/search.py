"""Search of a space for the design with the least of a number that is costly and a little rough.

Every combination of lists is sampled: corners of a small box of ranges and points of Sobol's sequence
inside.  Local searches begin at samples that no better one lies near to, as in multi level single
linkage (Rinnooy Kan and Timmer, Mathematical Programming 39, 1987, p. 57), whose distance shrinks as
samples become more.  A local search is COBYQA (Ragonneau and Zhang 2024), a trust-region method with
bounds and constraints that wants no derivative, which SciPy has.

A search ends where a further round, with as many samples again and the searches that begin there,
brings nothing better, or at the most designs.  Combinations whose samples are worse than the best by
more than any search has gained are not searched.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from solidgear.variants.optimise.pool import Design, EnoughDesigns, Pool
from solidgear.variants.optimise.space import Place

#: relative gain of a round that is none
TOLERANCE = 1e-3
#: coordinates of a box whose corners are all sampled
MOST_CORNERED = 3
#: samples of a first round: on a line, for each coordinate of other boxes, and for each coordinate in
#: every combination of lists
LINE, INSIDE, EACH = 9, 8, 4
#: share of the most designs that first samples of all combinations may take
SAMPLED = 0.4
#: local searches of a round, and those of a whole search at least
STARTS, FEWEST = 4, 3
#: rounds at most, and at least where no design keeps the limits
ROUNDS, UNKEPT = 6, 3
#: most designs of a local search a coordinate, and beside these for each limit
MOST, FOR_LIMITS = 12, 12
#: of a range: first and last radius of a local search, and of the last one; a distance that is moved
#: to the end; one below which two ends are the same
FIRST, COARSE, LAST, FINE, NEAR, TOGETHER = 0.2, 1e-2, 3e-2, 1e-4, 2e-2, 5e-2
#: last searches in turn
REPEATED = 4
#: of the number, for a limit that is missed by all of it
PENALTY = 3.0
#: of the distance by which samples are linked, four in the paper
LINKED = 2.0
#: values of a list that are tried in place of one
EXCHANGED = 12


@dataclass(frozen=True)
class Aim:
    """A goal of a search, and limits in addition to those of all designs."""

    pool: Pool
    goal: int = 0  #: number of the goal
    #: relative distance of a design beyond each further limit
    further: tuple[Callable[[Design], float], ...] = ()

    @property
    def limits(self) -> list[Callable[[Design], float]]:
        """Relative distances beyond all limits."""
        pool = self.pool
        limits = [lambda design, wish=wish: pool.shortfall(wish, design) for wish in pool.keep]
        return [*limits, *self.further]

    def loss(self, design: Design) -> float:
        """Return the number to be made small."""
        return self.pool.loss(design, self.goal)

    def merit(self, design: Design) -> float:
        """Return the number with a penalty for limits that are missed."""
        missing = sum(max(0.0, limit(design)) for limit in self.limits)
        return self.loss(design) + PENALTY * missing

    def keeps(self, design: Design) -> bool:
        """Return True for a design with numbers within all limits."""
        return design.kept and all(limit(design) <= 0 for limit in self.further)

    def rank(self, design: Design) -> tuple[bool, float]:
        """Return the rank of a design, the best least."""
        keeps = self.keeps(design)
        return not keeps, self.loss(design) if keeps else self.merit(design)

    def best(self, designs: Sequence[Design]) -> Design:
        """Return the best of designs."""
        return min(designs, key=self.rank)


@dataclass(frozen=True)
class End:
    """A local search: the designs where it began and ended."""

    start: Design
    end: Design


@dataclass
class Trace:
    """Record of a search."""

    sampled: int = 0  #: designs of samples
    ends: list[End] = field(default_factory=list)  #: local searches
    further_samples: int = 0  #: samples of the last round
    further_searches: int = 0  #: searches of the last round
    rounds: int = 0
    missed: int = 0  #: combinations of lists without a design
    refused: int = 0  #: combinations whose designs were all refused
    passed: int = 0  #: combinations with samples alone
    nearest_passed: float = math.inf  #: relative distance of the best of these from the best
    whole: bool = False  #: whether every combination was solved, and nothing else is open
    cut: bool = False  #: whether the most designs ended it


def search(aim: Aim, begin: Sequence[Design] = ()) -> Trace:
    """Search the space of a pool; designs to begin at are those that are known.

    The pool keeps the designs: the best of them is the result.
    """
    trace = Trace()
    space = aim.pool.space
    try:
        if space.dimension == 0 and not are_many(aim.pool):
            _solve_all(aim, trace)
        else:
            _in_rounds(aim, trace, begin)
    except EnoughDesigns:
        trace.cut = True
    _pass_over(aim, trace)
    return trace


def _solve_all(aim: Aim, trace: Trace) -> None:
    for choices in aim.pool.space.all_choices():
        aim.pool.solve(Place(choices, ()))
    trace.sampled, trace.whole = aim.pool.space.combinations, True


def _in_rounds(aim: Aim, trace: Trace, begin: Sequence[Design]) -> None:
    """Sample and search in rounds, until one of them brings nothing better."""
    pool, searched = aim.pool, list[Design]()
    samples = _Samples(aim)
    solved = [design for design in begin if design.place is not None]
    best: Design | None = None
    for trace.rounds in range(1, ROUNDS + 1):
        before, count, searches = best, len(pool.designs), len(trace.ends)
        solved += samples.further(best, _gain(aim, trace))
        trace.further_samples = len(pool.designs) - count
        trace.sampled += trace.further_samples
        best = aim.best(solved)
        for start in _starts(aim, solved, searched, best, trace):
            searched.append(start)
            solved.append(_searched(aim, start, trace, samples.joint))
            best = aim.best(solved)
        trace.further_searches = len(trace.ends) - searches
        solved.append(_polished(aim, best))
        best = aim.best(solved)
        if before is not None and not _better(aim, best, before):
            enough = len(trace.ends) >= FEWEST or trace.further_searches == 0
            if enough and (aim.keeps(best) or trace.rounds >= UNKEPT):
                break


def _better(aim: Aim, design: Design, before: Design) -> bool:
    """Return True for a design that is better than one before by more than rounding."""
    if aim.keeps(design) != aim.keeps(before):
        return aim.keeps(design)
    (_, value), (_, earlier) = aim.rank(design), aim.rank(before)
    return earlier - value > TOLERANCE * max(abs(value), TOLERANCE)


def are_many(pool: Pool) -> bool:
    """Return True where combinations of lists are too many to be sampled one by one."""
    space = pool.space
    if space.dimension == 0:
        return space.combinations > pool.most
    return space.combinations * EACH * space.dimension > SAMPLED * pool.most


class _Samples:
    """Samples of a space, from round to round."""

    def __init__(self, aim: Aim):
        self.aim, self.pool, self.space = aim, aim.pool, aim.pool.space
        self.round = 0
        #: whether combinations are too many to be sampled one by one
        self.joint = are_many(aim.pool)
        self.count = EACH * self.space.dimension
        if self.joint:
            self.count = int(SAMPLED * self.pool.most)

    def further(self, best: Design | None, gain: float) -> list[Design]:
        """Return the designs of one more round, in combinations that may be better than the best by a
        search that gains as much.
        """
        places = [*(self._of_all() if self.joint else self._of_each(best, gain))]
        self.round += 1
        return [self.pool.solve(place) for place in places]

    def _of_all(self) -> Iterator[Place]:
        """Yield places of lists and ranges together."""
        counts = [len(entry.values) for entry in self.space.lists]
        size = self.count if self.round == 0 else self.count // 4
        skip = 0 if self.round == 0 else self.count + (self.round - 1) * size
        for u in _sobol(len(counts) + self.space.dimension, skip, size):
            choices = tuple(
                min(int(share * count), count - 1) for share, count in zip(u.tolist(), counts)
            )
            yield Place(choices, tuple(u[len(counts) :].tolist()))

    def _of_each(self, best: Design | None, gain: float) -> Iterator[Place]:
        """Yield places of the ranges for every combination."""
        for choices in self.space.all_choices():
            samples = self.pool.of_choices(choices)
            if best is not None and samples:
                nearest = self.aim.merit(self.aim.best(samples))
                if nearest > self.aim.merit(best) + gain:
                    continue
            for x in self._box(alone=self.space.combinations == 1):
                yield Place(choices, tuple(x))

    def _box(self, alone: bool) -> Iterator[list[float]]:
        """Yield places of the box of ranges."""
        dimension, number = self.space.dimension, self.round
        if dimension == 1:
            steps = (LINE - 1 if alone else EACH) * 2**number
            # as fine again: the places between those before
            yield from ([k / steps] for k in range(steps + 1) if number == 0 or k % 2)
            return
        if number == 0 and alone and dimension <= MOST_CORNERED:
            yield from map(list, product((0.0, 1.0), repeat=dimension))
        size = INSIDE * dimension if alone else self.count
        skip = 1 + (size * (2**number - 1) if number else 0)  # the sequence begins in a corner
        yield from (u.tolist() for u in _sobol(dimension, skip, size * 2 ** max(number - 1, 0)))


def _sobol(dimension: int, skip: int, count: int) -> np.ndarray:
    """Return (count, dimension) points of Sobol's sequence."""
    from scipy.stats import qmc  # start-up: slow to import, and few commands have a use for it

    bits = max(int(math.ceil(math.log2(skip + count))), 1)
    return np.asarray(qmc.Sobol(dimension, scramble=False).random_base2(bits)[skip : skip + count])


def _starts(
    aim: Aim, solved: Sequence[Design], searched: Sequence[Design], best: Design, trace: Trace
) -> list[Design]:
    """Return the designs at which the local searches of a round begin, the best first."""
    sound = [design for design in solved if design.goals]
    merits = {design.number: aim.merit(design) for design in sound}
    ends = [end.end for end in trace.ends]
    worst = aim.merit(best) + _gain(aim, trace)
    starts: list[Design] = []
    for design in sorted(sound, key=lambda d: merits[d.number]):
        place = design.place
        assert place is not None
        samples = aim.pool.of_choices(place.choices)
        linked = _link(len(samples), len(place.x))
        better = (rival for rival in sound if merits[rival.number] < merits[design.number])
        if len(starts) == STARTS or merits[design.number] > worst:
            break
        if any(_between(rival, place) < linked for rival in better):
            continue
        if any(_between(rival, place) < TOGETHER for rival in (*searched, *ends)):
            continue
        starts.append(design)
    return starts


def _gain(aim: Aim, trace: Trace) -> float:
    """Return the largest gain of a local search; infinite before any."""
    gains = (aim.merit(end.start) - aim.merit(end.end) for end in trace.ends)
    return max(gains, default=math.inf)


def _between(design: Design, place: Place) -> float:
    """Return the Euclidean distance of a design from a place; infinite for other values of lists."""
    if design.place is None or design.place.choices != place.choices:
        return math.inf
    return math.dist(design.place.x, place.x)


def _link(count: int, dimension: int) -> float:
    """Return the distance within which the better of two samples stands for both, of so many in a
    unit box.
    """
    if dimension == 0 or count < 2:
        return 0.0
    ball = LINKED * math.gamma(1 + dimension / 2) * math.log(count) / count
    return min(float(ball ** (1 / dimension) / math.sqrt(math.pi)), 0.5)


def _searched(aim: Aim, start: Design, trace: Trace, exchange: bool) -> Design:
    """Return the end of a local search, and record it."""
    try:
        end = descend(aim, start, FIRST, COARSE, exchange)
    except EnoughDesigns:
        assert start.place is not None
        trace.ends.append(End(start, aim.best(aim.pool.of_choices(start.place.choices))))
        raise
    trace.ends.append(End(start, end))
    return end


def descend(aim: Aim, start: Design, first: float, last: float, exchange: bool) -> Design:
    """Return the end of a local search with a first and last radius in the ranges, and with other
    values of lists where these are many.
    """
    end = trust_region(aim, start, first, last)
    while exchange:
        exchanged = _exchanged(aim, end)
        if exchanged is end:
            break
        end = trust_region(aim, exchanged, first / 2, last)
    return end


def _exchanged(aim: Aim, design: Design) -> Design:
    """Return the best design with another value of one list at the same place in the ranges."""
    best, place = design, design.place
    assert place is not None
    for k, entry in enumerate(aim.pool.space.lists):
        present, count = place.choices[k], len(entry.values)
        near = sorted(range(count), key=lambda value: abs(value - present))[1 : EXCHANGED + 1]
        for value in near:
            choices = (*place.choices[:k], value, *place.choices[k + 1 :])
            best = aim.best([best, aim.pool.solve(place._replace(choices=choices))])
    return best


def _polished(aim: Aim, best: Design) -> Design:
    """Return the end of last searches from the best design, each from the end of the one before."""
    place = best.place
    if place is None or not place.x:
        return best
    ends = [0.0 if x < NEAR else 1.0 if x > 1 - NEAR else x for x in place.x]
    best = aim.best([best, aim.pool.solve(place.moved(ends))])
    for _ in range(REPEATED):
        end = trust_region(aim, best, LAST, FINE)
        better, best = _better(aim, end, best), aim.best([end, best])
        if not better:
            break
    return best


def trust_region(aim: Aim, start: Design, first: float, last: float) -> Design:
    """Run COBYQA with a first and last radius of the region, and return the best design on the way."""
    from scipy.optimize import NonlinearConstraint, minimize  # start-up: as above

    place = start.place
    assert place is not None
    if not place.x:
        return start
    visited = [start]

    def solved(x: np.ndarray) -> Design:
        design = aim.pool.solve(place.moved(x))
        visited.append(design)
        return design

    def constraint(limit: Callable[[Design], float]) -> NonlinearConstraint:
        return NonlinearConstraint(lambda x: limit(solved(x)), -np.inf, 0.0)

    limits = aim.limits
    minimize(
        lambda x: aim.loss(solved(x)),
        place.x,
        bounds=[(0.0, 1.0)] * len(place.x),
        constraints=[*map(constraint, limits)],
        method="COBYQA",
        options={
            "maxfev": MOST * len(place.x) + FOR_LIMITS * bool(limits),
            "initial_tr_radius": first,
            "final_tr_radius": last,
        },
    )
    return aim.best(visited)


def _pass_over(aim: Aim, trace: Trace) -> None:
    """Record combinations of lists without a design, or with samples alone, and how near the best of
    these is.
    """
    pool = aim.pool
    designs = [design for design in pool.designs if design.place is not None]
    sampled = {design.place.choices for design in designs if design.place is not None}
    trace.missed = pool.space.combinations - len(sampled)
    by_choices = {choices: pool.of_choices(choices) for choices in sampled}
    sound = {k for k, samples in by_choices.items() if any(d.goals for d in samples)}
    trace.refused = len(sampled - sound)
    searched = {end.end.place.choices for end in trace.ends if end.end.place is not None}
    passed = sound - searched if pool.space.lists and not trace.whole else set()
    trace.passed = len(passed)
    if passed:
        best = aim.best(designs)
        nearest = min(aim.merit(aim.best(by_choices[choices])) for choices in passed)
        size = max(abs(aim.loss(best)), TOLERANCE)
        trace.nearest_passed = (nearest - aim.merit(best)) / size
