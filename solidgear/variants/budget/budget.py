"""Ranges that the open inputs of a scene leave to its numbers: by each, by each source, in total.

**Range**: the lowest and the highest of a number over the points that are solved. Those are the ends
of every input by itself; the corners of all of them (of more than :data:`MOST_OF_ALL_CORNERS`
those that the single effects point at, for every number); and, where rows of rolling elements may
lift, a Sobol sample inside. Springs and moduli move frequencies and compliances one way
(Rayleigh), so that corners hold all of it; a row that comes into contact half way need not.

**Deviation**: every input equally likely anywhere in its range, the deviation by each alone (Gauss,
five points), and of all the root of the sum of squares (JCGM 100:2008, 5.1.2): the variance of inputs
that do not act on one another. Seeded samples of all together tell whether they do.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from solidgear.core.body import Body
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.open_record import (
    InputRecord,
    IntervalRecord,
    OpenNumbers,
    OpenRecord,
    SampledRecord,
)
from solidgear.core.judge.quantities import change, in_order
from solidgear.core.ladder.registry import LADDER
from solidgear.core.quantity import Quantity
from solidgear.core.scene import Scene
from solidgear.variants.budget.open_inputs import OpenInput, Points, open_inputs

Progress = Callable[[str], None]
Place = tuple[float, ...]
#: open inputs of which every corner is solved; and beyond which numbers are not told by the way
MOST_OF_ALL_CORNERS, MOST_BY_THE_WAY = 4, 12
#: points of the sample inside; a power of two, for which Sobol's points are balanced
INSIDE_POINTS = 16
#: samples that can be asked for; the deviation of fewer than the least says nothing
FEWEST_SAMPLES, MOST_SAMPLES = 20, 100_000


def beside(scene: Scene, body: Body | None = None) -> OpenNumbers:
    """Ranges as they are told beside error bars: without deviations, and left out where there are
    so many inputs that they would take long.

    Parameters
    ----------
    body : Body, optional
        As for :class:`solidgear.variants.budget.open_inputs.Points`.
    """
    return _by_the_way(scene, lambda: _Study(scene, open_inputs(scene), body).record(()))


def opened(scene: Scene) -> OpenNumbers:
    """The whole budget for a report, left out where :func:`beside` leaves it out."""
    return _by_the_way(scene, lambda: budget(scene))


def _by_the_way(scene: Scene, found: Callable[[], OpenNumbers]) -> OpenNumbers:
    """Numbers that a scene leaves open, or why they are left out."""
    inputs = open_inputs(scene)
    if len(inputs) > MOST_BY_THE_WAY:
        why = f"{len(inputs)} open inputs take a while; solidgear budget tells what they leave open"
        return OpenNumbers(inputs=_recorded(inputs), left_out=why)
    if not inputs:
        return OpenNumbers()
    try:
        return found()
    except SolidgearError as error:
        return OpenNumbers(inputs=_recorded(inputs), left_out=str(error))


def budget(
    scene: Scene, *, samples: int = 0, seed: int = 0, progress: Progress = lambda _: None
) -> OpenNumbers:
    """Contribution of every open input to every number of a scene.

    Parameters
    ----------
    scene : Scene
    samples : int
        Seeded samples of all inputs together (Latin hypercube), to be held against the sums; 0 for
        none.
    seed : int
    progress : callable
        Called with a sentence at every step.

    Returns
    -------
    OpenNumbers
        ``numbers`` each with ``by_input``, ``by_source``, ``total`` and ``shares``.

    Raises
    ------
    SolidgearError
        For a scene without open inputs, or one that cannot be solved as it is.

    Examples
    --------
    >>> import solidgear as sg
    >>> from solidgear.core.scene.uncertain import with_ranges
    >>> scene = with_ranges(sg.load("geometry/shaft_stepped.toml"), {"material.density": "± 1 %"})
    >>> first = sg.budget(scene).of("bending 1")
    >>> round(first.total.low, 4), round(first.total.high, 4)
    (-0.005, 0.005)
    """
    inputs = open_inputs(scene)
    if not inputs:
        raise SolidgearError(
            f"{scene.name}: no input is open: no bearing has an estimated inside or a class of "
            "clearance, and the file states no [uncertain]"
        )
    if samples and not FEWEST_SAMPLES <= samples <= MOST_SAMPLES:
        raise SolidgearError(f"samples = {samples}: give {FEWEST_SAMPLES} to {MOST_SAMPLES}, or 0")
    study = _Study(scene, inputs)
    for k, one in enumerate(inputs, start=1):
        progress(f"{one.path} ({k} of {len(inputs)})")
        study.solve([study.single(k - 1, place) for place, _ in one.nodes])
    found: list[dict[Quantity, float]] = []
    if samples:
        from scipy.stats import qmc  # slow to import, and no other command has a use for it

        every = qmc.LatinHypercube(len(inputs), rng=seed).random(samples)
        for k, place in enumerate(every):
            if k % 50 == 0:
                progress(f"samples: {k} of {samples}")
            if (numbers := study.at(tuple(place))) is not None:
                found.append(numbers)
    progress("ends of all inputs together")
    return study.record(found, samples, seed if samples else None)


class _Study:
    """Points that were solved, and what follows from them."""

    def __init__(self, scene: Scene, inputs: Sequence[OpenInput], body: Body | None = None):
        self.inputs, self.points = inputs, Points(scene, inputs, body)
        self.usual: Place = tuple(one.usual for one in inputs)
        self.solved: dict[Place, dict[Quantity, float]] = {}
        self.refused: dict[str, None] = {}
        self.middle = self.solved[self.usual] = self.points.numbers(self.usual)

    def single(self, index: int, place: float) -> Place:
        """The point with one input elsewhere."""
        return (*self.usual[:index], place, *self.usual[index + 1 :])

    def at(self, place: Place) -> dict[Quantity, float] | None:
        """Numbers at a point; None where it cannot be solved."""
        try:
            return self.points.numbers(place)
        except SolidgearError as error:
            self.refused[str(error)] = None
            return None

    def solve(self, places: Iterable[Place]) -> None:
        """Solve points that are not solved yet."""
        for place in places:
            if place not in self.solved and (found := self.at(place)) is not None:
                self.solved[place] = found

    def record(
        self, found: Sequence[dict[Quantity, float]], samples: int = 0, seed: int | None = None
    ) -> OpenNumbers:
        """Everything together."""
        all_of = range(len(self.inputs))
        self.solve(self.single(k, end) for k in all_of for end in (0.0, 1.0))
        sources = dict.fromkeys(one.source for one in self.inputs)
        groups = {s: [k for k in all_of if self.inputs[k].source == s] for s in sources}
        for group in (*groups.values(), list(all_of)):
            if len(group) > 1:
                self.solve(list(self._corners(group)))
        if any(one.catalogue for one in self.points.scene.bearings):
            from scipy.stats import qmc  # as above

            inside = qmc.Sobol(len(self.inputs), scramble=False).random(INSIDE_POINTS)
            self.solve(tuple(place) for place in inside)
        numbers = [self._number(q, groups, found) for q in self._quantities()]
        return OpenNumbers(
            model=self.points.model,
            title=LADDER[self.points.model].title,
            inputs=_recorded(self.inputs),
            numbers=[one for one in numbers if one is not None],
            points=len(self.solved),
            samples=samples,
            seed=seed,
            lost=list(self.points.lost),
            refused=list(self.refused),
        )

    def _quantities(self) -> list[Quantity]:
        static = in_order(self.middle)
        return [*static, *(q for q in self.middle if q not in static and q.is_frequency)]

    def _corners(self, group: Sequence[int]) -> Iterable[Place]:
        """Corners of some inputs, the others as the scene says."""
        if len(group) <= MOST_OF_ALL_CORNERS:
            signs: Iterable[tuple[bool, ...]] = itertools.product((False, True), repeat=len(group))
        else:
            rising = [self._rises(quantity, group) for quantity in self.middle]
            signs = dict.fromkeys(
                [*rising, *(tuple(not up for up in pattern) for pattern in rising)]
            )
        for pattern in signs:
            place = list(self.usual)
            for k, up in zip(group, pattern):
                place[k] = float(up)
            yield tuple(place)

    def _rises(self, quantity: Quantity, group: Sequence[int]) -> tuple[bool, ...]:
        """For each of some inputs, whether a number rises with it."""

        def end(k: int, place: float) -> float:
            numbers = self.solved.get(self.single(k, place), self.middle)
            return numbers.get(quantity, math.nan)

        return tuple(end(k, 1.0) > end(k, 0.0) for k in group)

    def _number(
        self,
        quantity: Quantity,
        groups: dict[str, list[int]],
        found: Sequence[dict[Quantity, float]],
    ) -> OpenRecord | None:
        """A number, or None of one that is not there at every point."""
        if any(quantity not in numbers for numbers in (*self.solved.values(), *found)):
            return None
        by_input = {}
        for k, one in enumerate(self.inputs):
            by_input[one.path] = self._interval(quantity, [k])
            by_input[one.path].deviation = self._deviation(quantity, k)
        total = self._interval(quantity, range(len(self.inputs)))
        parts = [one.deviation for one in by_input.values() if one.deviation is not None]
        if len(parts) == len(by_input):
            total.deviation = math.hypot(*parts)
        return OpenRecord(
            quantity=quantity,
            value=self.middle[quantity],
            total=total,
            by_source={source: self._interval(quantity, group) for source, group in groups.items()},
            by_input=by_input,
            sampled=self._sampled(quantity, found) if found else None,
        )

    def _interval(self, quantity: Quantity, moved: Iterable[int]) -> IntervalRecord:
        """Range over the points at which no other inputs were moved."""
        others = set(range(len(self.inputs))) - set(moved)
        changes = [
            self._change(quantity, numbers)
            for place, numbers in self.solved.items()
            if all(place[k] == self.usual[k] for k in others)
        ]
        return IntervalRecord(low=min(changes), high=max(changes))

    def _change(self, quantity: Quantity, numbers: dict[Quantity, float]) -> float:
        return change(numbers, self.middle, quantity) or 0.0

    def _deviation(self, quantity: Quantity, k: int) -> float | None:
        nodes = [
            (self.solved.get(self.single(k, place)), weight)
            for place, weight in self.inputs[k].nodes
        ]
        changes = [(self._change(quantity, n), weight) for n, weight in nodes if n is not None]
        if len(changes) < len(nodes):
            return None
        mean = sum(weight * c for c, weight in changes)
        return math.sqrt(sum(weight * (c - mean) ** 2 for c, weight in changes))

    def _sampled(self, quantity: Quantity, found: Sequence[dict[Quantity, float]]) -> SampledRecord:
        changes = np.array([self._change(quantity, numbers) for numbers in found])
        low, high = np.percentile(changes, (2.5, 97.5))
        return SampledRecord(
            low=float(changes.min()),
            high=float(changes.max()),
            deviation=float(changes.std(ddof=1)),
            low95=float(low),
            high95=float(high),
        )


def _recorded(inputs: Iterable[OpenInput]) -> list[InputRecord]:
    return [InputRecord(path=one.path, source=one.source, said=one.said) for one in inputs]
