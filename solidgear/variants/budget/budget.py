"""Ranges of the numbers of a scene by its open inputs: by each, by each source, in total.

**Range**: the lowest and the highest of a number over the points that are solved. Those are the ends
of every input by itself; the corners of all of them (of more than :data:`MOST_OF_ALL_CORNERS`
inputs those to which the single effects point, for every number); and, where rows of rolling elements may
lift, a Latin hypercube inside. Springs and moduli move frequencies and compliances one way
(Rayleigh), so that corners hold all of it; a row that comes into contact half way need not.

**Deviation**: every input equally likely anywhere in its range, the deviation by each alone (Gauss,
five points), and of all the root of the sum of squares (JCGM 100:2008, 5.1.2): the variance of inputs
that do not act on one another. Seeded samples of all together show whether they do.

Open inputs of a scene, and its numbers at any point of their ranges.

Open are the inside of a catalogue bearing that is estimated, its clearance where that is a class,
and entries that ``[uncertain]`` of the file states (:mod:`solidgear.core.scene.uncertain`). A point is a place in
every range, 0 to 1.
"""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.clearance import clearance_range, is_axial
from solidgear.bearings.equilibrium import Equilibrium
from solidgear.bearings.solved import Choice, solved, wants_equilibrium
from solidgear.core import (
    LADDER,
    STIFFNESS,
    Body,
    ModeSet,
    OpenNumbers,
    Quantity,
    Scene,
    Sheeted,
    SolidgearError,
    Source,
    as_supports,
    build,
    change,
    load,
    modes,
    number_cautions,
    rubin,
)
from solidgear.core.body import Supports
from solidgear.core.judge.correlation import FOREIGN
from solidgear.core.judge.open_numbers import InputRecord, IntervalRecord, OpenRecord, SampledRecord
from solidgear.core.judge.quantities import in_order, measure
from solidgear.core.scene.uncertain import with_scaled_entry
from solidgear.core.solve.neighbours import best_assignment
from solidgear.core.solve.statics import condense
from solidgear.core.springs import modes_on_springs
from solidgear.variants.budget.questions import Question, questions

Progress = Callable[[str], None]
Place = tuple[float, ...]
#: model of the ranges, of which ratios count: thousands of points are solved
BEAM = "timoshenko"
#: most open inputs of which every corner is solved, and of which ranges stand beside error bars
MOST_OF_ALL_CORNERS, MOST_BESIDE_BARS = 4, 12
#: points of the sample inside
INSIDE_POINTS = 16
#: samples that can be asked for; the deviation of fewer than the least says nothing
FEWEST_SAMPLES, MOST_SAMPLES = 20, 100_000


def beside(scene: Scene, body: Body | None = None) -> OpenNumbers:
    """Return ranges as they stand beside error bars: without deviations, and left out for so many inputs
    that they would take long. The body is as for :class:`solidgear.variants.budget.budget.Points`.
    """
    return _if_few(scene, lambda: _Study(scene, open_inputs(scene), body).record(()))


def opened(scene: Scene) -> OpenNumbers:
    """Return the whole budget for a report, left out as by :func:`beside`."""
    return _if_few(scene, lambda: _studied(scene)[1])


def _if_few(scene: Scene, solve: Callable[[], OpenNumbers]) -> OpenNumbers:
    """Return the ranges of a scene, or the reason why they are left out."""
    inputs = open_inputs(scene)
    if len(inputs) > MOST_BESIDE_BARS:
        why = f"{len(inputs)} open inputs take a while; run solidgear budget"
        return OpenNumbers(inputs=_recorded(inputs), left_out=why)
    if not inputs:
        return OpenNumbers()
    try:
        return solve()
    except SolidgearError as error:
        return OpenNumbers(inputs=_recorded(inputs), left_out=str(error))


def budget(
    scene: Source, *, samples: int = 0, seed: int = 0, progress: Progress = lambda _: None
) -> Budget:
    """Contribution of every open input to every number of a scene.

    Parameters
    ----------
    scene : path, dict or Scene
        A scene: its file (TOML), the tables of one, or an object.
    samples : int
        Number of random samples of all inputs together (Latin hypercube), beside the sums; 0 for
        none.
    seed : int
    progress : callable
        Called with a sentence at every step.

    Returns
    -------
    Budget
        ``numbers`` each with ``by_input``, ``by_source``, ``total`` and ``shares``; its ``write``
        makes the chart and the numbers.

    Raises
    ------
    SolidgearError
        For a scene without open inputs, or one that cannot be solved as it is.

    Examples
    --------
    >>> import solidgear as sg
    >>> import tomllib
    >>> from pathlib import Path
    >>> tables = tomllib.loads(Path("geometry/shaft_stepped.toml").read_text(encoding="utf-8"))
    >>> tables["uncertain"] = {"material.density": "± 1 %"}
    >>> first = sg.budget(tables).of("bending 1")
    >>> round(first.total.low, 4), round(first.total.high, 4)
    (-0.005, 0.005)
    """
    scene = load(scene)
    if samples and not FEWEST_SAMPLES <= samples <= MOST_SAMPLES:
        raise SolidgearError(f"samples = {samples}: give {FEWEST_SAMPLES} to {MOST_SAMPLES}, or 0")
    study, ranges = _studied(scene, samples, seed, progress)
    progress("what makers know")
    insides = [k for k, open_input in enumerate(study.inputs) if open_input.of]
    asked = questions(study.points, ranges, insides)
    bars = {str(number.quantity): None for number in ranges.numbers}
    return Budget(
        scene=scene.name,
        questions=asked,
        cautions=number_cautions(scene, bars, study.points.model),
        **dict(ranges),
    )


def _studied(
    scene: Scene, samples: int = 0, seed: int = 0, progress: Progress = lambda _: None
) -> tuple[_Study, OpenNumbers]:
    """Return the points of a scene that were solved, and the ranges of its numbers with deviations;
    refuse a scene without open inputs.
    """
    inputs = open_inputs(scene)
    if not inputs:
        raise SolidgearError(
            f"{scene.name}: no input is open, since no bearing has an estimated inside, a class "
            'of clearance or status = "assumed" in the file, and it has no [uncertain]'
        )
    study = _Study(scene, inputs)
    for k, open_input in enumerate(inputs):
        progress(f"{open_input.path} ({k + 1} of {len(inputs)})")
        study.solve([study.single(k, place) for place, _ in open_input.nodes])
    sampled: list[dict[Quantity, float]] = []
    if samples:
        from scipy.stats import qmc  # slow to import, and no other command has a use for it

        places = qmc.LatinHypercube(len(inputs), rng=seed).random(samples)
        for k, place in enumerate(places):
            if k % 50 == 0:
                progress(f"samples: {k} of {samples}")
            if (numbers := study.at(tuple(place))) is not None:
                sampled.append(numbers)
    progress("ends of all inputs together")
    return study, study.record(sampled, samples, seed if samples else None)


class Budget(Sheeted, OpenNumbers):
    """Ranges of every number of a scene by every open input."""

    sheeted: ClassVar[str] = "variants.budget.chart:budget_sheet"

    scene: str = ""  #: name of it
    questions: list[Question] = []  #: to makers of bearings, those that narrow most first
    cautions: list[str] = []  #: sentences on what the numbers leave out


class _Study:
    """Points that were solved, and the ranges by them."""

    def __init__(self, scene: Scene, inputs: Sequence[OpenInput], body: Body | None = None):
        self.inputs, self.points = inputs, Points(scene, inputs, body)
        self.usual: Place = tuple(open_input.usual for open_input in inputs)
        self.solved: dict[Place, dict[Quantity, float]] = {}
        self.refused: dict[str, None] = {}
        self.middle = self.solved[self.usual] = self.points.numbers(self.usual)

    def single(self, index: int, place: float) -> Place:
        """Return the usual point with one input at another place."""
        return (*self.usual[:index], place, *self.usual[index + 1 :])

    def at(self, place: Place) -> dict[Quantity, float] | None:
        """Return the numbers at a point; None where it cannot be solved."""
        try:
            return self.points.numbers(place)
        except SolidgearError as error:
            self.refused[str(error)] = None
            return None

    def solve(self, places: Iterable[Place]) -> None:
        """Solve points that are not solved yet."""
        for place in places:
            if place not in self.solved and (numbers := self.at(place)) is not None:
                self.solved[place] = numbers

    def record(
        self, sampled: Sequence[dict[Quantity, float]], samples: int = 0, seed: int | None = None
    ) -> OpenNumbers:
        """Solve ends, corners and points inside, and return the ranges of all numbers."""
        indices = range(len(self.inputs))
        self.solve(self.single(k, end) for k in indices for end in (0.0, 1.0))
        groups: dict[str, list[int]] = {}
        for k in indices:
            groups.setdefault(self.inputs[k].source, []).append(k)
        for group in (*groups.values(), list(indices)):
            if len(group) > 1:
                self.solve(list(self._corners(group)))
        if any(bearing.catalogue for bearing in self.points.scene.bearings):
            self.solve(tuple(place) for place in spread_points(len(self.inputs), INSIDE_POINTS))
        numbers = [self._number(q, groups, sampled) for q in self._quantities()]
        return OpenNumbers(
            model=self.points.model,
            title=LADDER[self.points.model].title,
            inputs=_recorded(self.inputs),
            numbers=[number for number in numbers if number is not None],
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
        """Yield the corners of some inputs, the others as in the scene."""
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
        """Return for each of some inputs whether a number rises with it."""

        def end(k: int, place: float) -> float:
            numbers = self.solved.get(self.single(k, place), self.middle)
            return numbers.get(quantity, math.nan)

        return tuple(end(k, 1.0) > end(k, 0.0) for k in group)

    def _number(
        self,
        quantity: Quantity,
        groups: dict[str, list[int]],
        sampled: Sequence[dict[Quantity, float]],
    ) -> OpenRecord | None:
        """Return the ranges of a number; None for one that is not there at every point."""
        if any(quantity not in numbers for numbers in (*self.solved.values(), *sampled)):
            return None
        by_input = {}
        for k, open_input in enumerate(self.inputs):
            interval = self._interval(quantity, [k])
            interval.deviation = self._deviation(quantity, k)
            by_input[open_input.path] = interval
        total = self._interval(quantity, range(len(self.inputs)))
        parts = [i.deviation for i in by_input.values() if i.deviation is not None]
        if len(parts) == len(by_input):
            total.deviation = math.hypot(*parts)
        return OpenRecord(
            quantity=quantity,
            value=self.middle[quantity],
            total=total,
            by_source={source: self._interval(quantity, group) for source, group in groups.items()},
            by_input=by_input,
            sampled=self._sampled(quantity, sampled) if sampled else None,
        )

    def _interval(self, quantity: Quantity, moved: Iterable[int]) -> IntervalRecord:
        """Return the range over the points at which no other inputs were moved."""
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
        changes = [
            (self._change(quantity, numbers), weight)
            for numbers, weight in nodes
            if numbers is not None
        ]
        if len(changes) < len(nodes):
            return None
        mean = sum(weight * c for c, weight in changes)
        return math.sqrt(sum(weight * (c - mean) ** 2 for c, weight in changes))

    def _sampled(
        self, quantity: Quantity, sampled: Sequence[dict[Quantity, float]]
    ) -> SampledRecord:
        changes = np.array([self._change(quantity, numbers) for numbers in sampled])
        low, high = np.percentile(changes, (2.5, 97.5))
        return SampledRecord(
            low=float(changes.min()),
            high=float(changes.max()),
            deviation=float(changes.std(ddof=1)),
            low95=float(low),
            high95=float(high),
        )


def _recorded(inputs: Iterable[OpenInput]) -> list[InputRecord]:
    return [InputRecord(path=i.path, source=i.source, said=i.said, of=i.of) for i in inputs]


def spread_points(dimension: int, count: int) -> np.ndarray:
    """Return (count, dimension) points in a unit cube, always the same, of which every direction has
    one in each of as many equal parts (Latin hypercube).

    Examples
    --------
    >>> sorted(spread_points(2, 4)[:, 1].tolist())
    [0.125, 0.375, 0.625, 0.875]
    """
    turns = np.random.default_rng(0)
    return np.column_stack([turns.permutation(count) + 0.5 for _ in range(dimension)]) / count


BEARINGS, LOAD, MATERIAL = "bearings", "load", "material"
INSIDE, CLEARANCE, PRELOAD = ".inside", ".clearance", ".preload"
#: modes beyond those asked for, among which a mode may be that has moved up
FURTHER_MODES = 4
#: free modes of a beam that are kept for each mode looked at: frequencies to some 1e-6, ranges have three figures
KEPT_PER_MODE = 2
#: ends of an estimated inside; the bearing is one of three and none between them
ENDS = ("softer", "middle", "stiffer")
#: places of a smooth input for its variance, with their weights (Gauss, five points), and of an
#: inside
SMOOTH = tuple(
    (float(x + 1) / 2, float(w) / 2) for x, w in zip(*np.polynomial.legendre.leggauss(5))
)
THREE = tuple((place, 1 / 3) for place in (1 / 6, 0.5, 5 / 6))


@dataclass(frozen=True)
class OpenInput:
    """Open input of a scene."""

    path: str
    source: str  #: ``bearings``, ``load`` or ``material``
    said: str  #: the range in words
    #: low, high: factors on the value of the scene; places, 0 and 1, of an inside and of a clearance
    low: float = 0.0
    high: float = 1.0
    usual: float = 0.5  #: place of the value of the scene in the range, 0 to 1
    of: str = ""  #: bearing in words, of an estimated inside

    def value(self, place: float) -> float:
        """Return the factor, or the place, at a place of the range."""
        return self.low + (self.high - self.low) * place

    @property
    def nodes(self) -> tuple[tuple[float, float], ...]:
        """Places and weights for the variance."""
        return THREE if self.path.endswith(INSIDE) else SMOOTH


def open_inputs(scene: Scene) -> tuple[OpenInput, ...]:
    """Return the inputs of a scene that have a range.

    Examples
    --------
    >>> import solidgear as sg
    >>> for open_input in open_inputs(sg.load("geometry/gearbox_catalogue.toml"))[:2]:
    ...     print(open_input.path, "|", open_input.said)
    bearing.A.inside | estimated, softer to stiffer
    bearing.A.clearance | CN, 25 to 50 um
    """
    inputs = []
    for bearing in scene.bearings:
        data = catalogue_of(bearing)
        if data is None:
            continue
        path = f"bearing.{bearing.name}"
        if data.estimated:
            designation = f" ({data.designation})" if data.designation else ""
            words = f"bearing {bearing.name}{designation}"
            said = "estimated, softer to stiffer"
            inputs.append(OpenInput(path + INSIDE, BEARINGS, said, of=words))
        if isinstance(data.clearance, str):
            least, most = (f"{1e6 * end:.3g}" for end in clearance_range(data))
            words = f"{data.clearance}, {least} to {most} um{' along y' * is_axial(data)}"
            inputs.append(OpenInput(path + CLEARANCE, BEARINGS, words))
    for stated in scene.uncertain:
        source = {"material": MATERIAL, "segment": MATERIAL, "load": LOAD}.get(
            stated.path.partition(".")[0], BEARINGS
        )
        usual = (1 - stated.low) / (stated.high - stated.low)
        inputs.append(OpenInput(stated.path, source, stated.said, stated.low, stated.high, usual))
    return tuple(inputs)


class Points:
    """Numbers of a scene at points of the ranges of its open inputs.

    A body gives stiffnesses, and no frequencies; by default, and where one of several moduli is
    open, the beam of :data:`BEAM`, made anew for every material.
    """

    def __init__(self, scene: Scene, inputs: Sequence[OpenInput], body: Body | None = None):
        self.scene, self.inputs = scene, inputs
        self.body = body if _one_modulus(scene, inputs) else None
        self.lost: dict[str, None] = {}  #: names of bearings that carried nothing at a point
        self._beams: dict[tuple, Body] = {}
        self._first: NamedShapes | None = None
        self._usual: Equilibrium | None = None  #: with all inputs as usual
        #: with each input alone elsewhere, by its place
        self._alone: list[dict[float, Equilibrium]] = [{} for _ in inputs]

    def with_data(self, bearing: str, **known: Any) -> Points:
        """Return the same points of a scene in which more catalogue data of a bearing are known."""
        out = copy.copy(self)
        bearings = tuple(
            b.with_changes(catalogue=b.catalogue.with_changes(**known))
            if b.name == bearing and b.catalogue is not None
            else b
            for b in self.scene.bearings
        )
        out.scene = self.scene.with_changes(bearings=bearings)
        out._alone = [{**states} for states in self._alone]
        return out

    @property
    def model(self) -> str:
        """Model that the numbers are of."""
        return BEAM if self.body is None else self.body.fidelity

    def numbers(self, place: Sequence[float]) -> dict[Quantity, float]:
        """Return the numbers at a point, a place in every range; SolidgearError if bearings hold
        nothing there, or a stiffness is not usable.
        """
        values = {open_input.path: open_input.value(x) for open_input, x in zip(self.inputs, place)}
        scene = self.scene
        for path, value in values.items():
            if path != "load" and not path.endswith((INSIDE, CLEARANCE, PRELOAD)):
                scene = with_scaled_entry(scene, path, value)
        beam = None
        if self.body is None or wants_equilibrium(scene):
            key = tuple(segment.material for segment in scene.segments)
            if key not in self._beams:
                self._beams = {key: build(scene.plain, BEAM)}
            beam = self._beams[key]
        on_beam = beam if wants_equilibrium(scene) else None
        rest = solved(scene, on_beam, _choice(values), self._near(place))
        if rest.equilibrium is not None:
            self._keep(place, rest.equilibrium)
        for name, made in rest.made.items():
            if not made.bearing.load(rest.motion[name]).any():
                self.lost[name] = None
        if self.body is None:
            assert beam is not None
            return self._measured(beam, rest.scene, frequencies=True)
        # a shaft that is e times as stiff on its bearings is e times as stiff as one on bearings
        # that are e times softer
        e = values.get("material.E", 1.0)
        numbers = self._measured(self.body, _softer(rest.scene, e), frequencies=False)
        return {q: v * e if q.kind == STIFFNESS else v / e for q, v in numbers.items()}

    def _near(self, place: Sequence[float]) -> Equilibrium | None:
        """Return where the search for the equilibrium at a point begins: at the usual point, and as
        far on as the nearest place of each input moved it alone; None before there is one.
        """
        if self._usual is None:
            return None
        known = zip(self._alone, place)
        nearest = [states[min(states, key=lambda at: abs(at - x))] for states, x in known]
        return self._usual.moved_by(nearest)

    def _keep(self, place: Sequence[float], equilibrium: Equilibrium) -> None:
        """Keep the equilibrium at a point at which one input at most is not as usual."""
        moved = [k for k, x in enumerate(place) if x != self.inputs[k].usual]
        if not moved:
            self._usual = equilibrium
        if len(moved) <= 1:
            for k in moved or range(len(place)):
                self._alone[k][place[k]] = equilibrium

    def _measured(self, body: Body, scene: Scene, frequencies: bool) -> dict[Quantity, float]:
        main, *further = (condense(body, scene, port.name) for port in scene.ports)
        numbers = measure(main, None, {condensed.port: condensed for condensed in further})
        return numbers | (self._frequencies(body, scene) if frequencies else {})

    def _frequencies(self, body: Body, scene: Scene) -> dict[Quantity, float]:
        """Return the frequencies of the modes of the first point, Hz, paired by shapes: names change
        where other modes come between.
        """
        listed = scene.ask.modes
        reduced = body.cache.get(ReducedBeam, lambda: ReducedBeam(body, listed + FURTHER_MODES))
        shapes = reduced.shapes(as_supports(scene), body)
        if self._first is None:
            self._first = NamedShapes.of(modes(body, scene, listed), shapes)
        return self._first.frequencies(shapes, body)


class ReducedBeam:
    """A beam in its free modes and the fields of its ports (Rubin): on other springs, its modes are
    those of a small matrix.
    """

    def __init__(self, body: Body, count: int):
        self.count = count
        self.part = rubin(body, KEPT_PER_MODE * count)

    def shapes(self, supports: Supports, body: Body) -> Shapes:
        """Return the lowest elastic modes on supports of the body, which keeps this and is not held."""
        part, still = self.part, np.zeros((0, self.part.size))
        motion = np.vstack([still, *(part.ports[name].rows for name in supports.ports)])
        mass = part.mass + motion.T @ supports.masses @ motion
        value, shapes = modes_on_springs(np.diag(part.value), mass, motion.T @ supports.root)
        rigid = supports.unresisted(body).shape[1]
        elastic = slice(rigid, rigid + self.count)
        return Shapes(np.sqrt(value[elastic]) / (2 * np.pi), part.expand(shapes[:, elastic]))


@dataclass(frozen=True)
class Shapes:
    """Elastic modes of a beam, shape by shape."""

    frequency_hz: np.ndarray  #: (k,) ascending, twins twice
    fields: Mapping[int, np.ndarray]  #: (n, k) unknowns of the blocks of the body, by index


@dataclass(frozen=True)
class NamedShapes:
    """Elastic modes of the first point, shape by shape."""

    names: tuple[Quantity, ...]  #: twins share a name
    fields: Mapping[int, np.ndarray]  #: (n, k) of :class:`Shapes`

    @classmethod
    def of(cls, named: ModeSet, shapes: Shapes) -> NamedShapes:
        """Return the first of some shapes with the names of the same modes."""
        names = tuple(
            Quantity(m.name) for m in named.modes for _ in range(m.multiplicity) if m.frequency_hz
        )
        return cls(names, {k: field[:, : len(names)] for k, field in shapes.fields.items()})

    def frequencies(self, shapes: Shapes, body: Body) -> dict[Quantity, float]:
        """Return the frequency of every name, Hz, by the shapes that move most alike; of a pair that
        has split, the root of the mean square; without those of which nothing is alike.
        """
        product, squares, squares_of_shapes = np.zeros((3, 1, 1))
        for k, field in self.fields.items():
            moved, carried = shapes.fields[k], body.blocks[k].mass @ shapes.fields[k]
            product = product + field.T @ carried
            squares = squares + np.einsum("ni,ni->i", field, body.blocks[k].mass @ field)[:, None]
            squares_of_shapes = squares_of_shapes + np.einsum("ni,ni->i", moved, carried)
        alike = np.square(product) / (squares * squares_of_shapes)
        # twins turn into one another as they like
        of_names = {name: alike[[n == name for n in self.names]].sum(axis=0) for name in self.names}
        gain = np.array([of_names[name] for name in self.names])
        hz2: dict[Quantity, list[float]] = {name: [] for name in of_names}
        for row, column in zip(*best_assignment(gain)):
            if gain[row, column] >= FOREIGN:
                hz2[self.names[row]].append(float(shapes.frequency_hz[column]) ** 2)
        return {name: math.sqrt(np.mean(found)) for name, found in hz2.items() if found}


def _one_modulus(scene: Scene, inputs: Sequence[OpenInput]) -> bool:
    """True where an open modulus is that of all of the shaft, or none is open."""
    alike = len({segment.material.E for segment in scene.segments}) == 1
    moduli = [i.path for i in inputs if i.path.endswith("material.E")]
    return not moduli or (alike and moduli == ["material.E"])


def _choice(values: Mapping[str, float]) -> Choice:
    """Return the places in the data of catalogue bearings."""
    by_bearing: dict[str, dict] = {}
    for path, value in values.items():
        key = next((k for k in (INSIDE, CLEARANCE, PRELOAD) if path.endswith(k)), None)
        if key is None:
            continue
        name = path.removeprefix("bearing.").removesuffix(key).removesuffix(".catalogue")
        field = {INSIDE: "end", CLEARANCE: "clearance", PRELOAD: "preload"}[key]
        end = ENDS[min(int(3 * value), 2)] if key == INSIDE else value
        by_bearing.setdefault(name, {})[field] = end
    choices = {name: Choice(**fields) for name, fields in by_bearing.items()}
    return Choice(load=values.get("load", 1.0), overrides=choices)


def _softer(scene: Scene, e: float) -> Scene:
    """Return the scene on springs that are e times softer."""
    if e == 1:
        return scene
    housing, axial = scene.housing, scene.housing_axial
    return scene.with_bearing_scale(1 / e).with_changes(
        housing=housing and housing.scaled(1 / e), housing_axial=axial and axial / e
    )
