"""Search for the entries of a file that reach a goal best, as far as error bars distinguish designs.

Every design is read, meshed and solved as a variant of a sweep, its mesh refined until its error bars
are within the tolerance: it costs seconds, and its small jumps from mesh to mesh would spoil differences.

Search of a box for the least of a number that is costly and a little rough: a sample of the whole
box first, searches from the best places of it, and a last step at the best.

The sample has the corners of a small box and points of Sobol's sequence inside, the searches are those
of SciPy that want no derivative: Brent's bounded scalar search for one coordinate without limits, and
COBYQA (Ragonneau and Zhang 2024), a trust-region method with bounds and constraints, for all others.
A box of one minimum costs little more than one search; the sample shows whether there are several.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np

from solidgear.core import Sheeted, SolidgearError, Source, document_of, nearest
from solidgear.core.errors import names_in
from solidgear.core.judge.change import Change
from solidgear.core.plain import plain
from solidgear.variants.optimise.designs import Designs, scene_designs, train_designs
from solidgear.variants.optimise.wish import Rows, Wish, limit_of, wish_of
from solidgear.variants.sweep.design import Design as SweepDesign
from solidgear.variants.sweep.entries import Entry, assignment, in_si, plain_number


@dataclass(frozen=True)
class Design:
    """A design that was solved."""

    number: int  #: in order; 0 is the file as it is
    values: dict[str, Any]  #: of the entries that vary, SI
    #: value, bar: of the goal, and its error bar
    value: float | None
    bar: float | None
    kept: bool  #: whether every limit is kept with its error bar
    status: str  #: ``ok``, or why it has no numbers
    rows: Rows  #: all numbers; of a train at each operating point


@dataclass(frozen=True, repr=False, eq=False)
class Optimum(Sheeted):
    """Result of a search."""

    shown: ClassVar[str] = "variants.optimise.command:designs"
    sheeted: ClassVar[str] = "variants.optimise.command:optimum_sheet"

    scene: str
    goal: Wish
    keep: tuple[Wish, ...]
    path: tuple[Design, ...]  #: all designs, the file as it is first
    best: Design | None  #: none where no design keeps every limit
    at_end: tuple[str, ...]  #: entries of the best design that are at an end of their range
    how: str = ""  #: the search in words
    #: why values have no error bars; empty where they have
    unbarred: str = ""
    solved: str = ""  #: how every design was solved, in words

    @property
    def gain(self) -> Change | None:
        """Change from the file to the best design; None where one of them has no number."""
        first, best = self.path[0], self.best
        if best is None or first.value is None or best.value is None:
            return None
        return Change(first.value, best.value, first.bar, best.bar)

    @property
    def sentences(self) -> list[str]:
        """Conclusions."""
        return list(_sentences(self))

    @property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        return {
            "kind": "optimum",
            "scene": self.scene,
            "goal": str(self.goal),
            "keep": [str(wish) for wish in self.keep],
            "best": None if self.best is None else self.best.number,
            "at_end": list(self.at_end),
            "search": self.how,
            "about_bars": self.unbarred or "beside each value",
            "gain": None if self.gain is None else plain(self.gain),
            "designs": [
                {
                    "number": design.number,
                    **design.values,
                    "value": design.value,
                    "bar": design.bar,
                    "kept": design.kept,
                    "status": design.status,
                }
                for design in self.path
            ],
            "sentences": self.sentences,
        }


def _sentences(optimum: Optimum) -> Iterator[str]:
    best, gain = optimum.best, optimum.gain
    solved = sum(design.status == "ok" for design in optimum.path)
    if not solved:
        yield f"No design could be solved; the file as it is: {optimum.path[0].status}."
        return
    if best is None or best.value is None:
        limits = ", ".join(map(str, optimum.keep))
        yield f"No design of {solved} keeps {limits}, error bars included."
        missing = {
            design.number: max(wish.missing(design.rows) for wish in optimum.keep)
            for design in optimum.path
            if design.status == "ok"
        }
        closest = min(missing, key=lambda number: missing[number])
        yield (
            f"The nearest misses by {100 * missing[closest]:.3g} % of the limit, at "
            f"{_listed_values(optimum.path[closest])} (SI)."
        )
        return
    yield f"{optimum.goal}: {_with_bar(best.value, best.bar)} (SI) at {_listed_values(best)}."
    if optimum.how:
        yield f"Searched: {optimum.how}; {solved} designs solved."
    if best.number == 0:
        yield "No design is better than the file as it is by more than the error bars."
    elif gain is not None:
        file = f"the file as it is, {_with_bar(gain.a, gain.bar_a)}"
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
        if design is not best and design.kept and design.value is not None
    ]
    count = sum(change.verdict == "not resolved" for change in changes)
    if count:
        designs = "designs are" if count > 1 else "design is"
        yield f"{count} more {designs} as good within the error bars."
    for label in optimum.at_end:
        yield f"{label} is at the end of its range; a wider range may hold a better design."


def _with_bar(value: float | None, bar: float | None) -> str:
    return f"{value:.6g}" + (f" ± {bar:.2g}" if bar else "")


def _listed_values(design: Design) -> str:
    return ", ".join(f"{label} = {value:.6g}" for label, value in design.values.items())


#: of a range: distance of two designs that are the same, and of an optimum at the end from the end
SAME, AT_END = 1e-6, 1e-6


def optimise(
    scene: Source,
    vary: str | Iterable[str],
    goal: str,
    keep: str | Iterable[str] = (),
    *,
    keep_sum: str | Iterable[str] = (),
    model: str | None = None,
    tol: float | None = None,
    point: str | None = None,
    every_point: bool = False,
    progress: Callable[[str], None] = lambda _: None,
) -> Optimum:
    """Vary entries of a scene or train to make a number as large or as small as possible.

    Parameters
    ----------
    scene : path, dict, Scene or Train
        A scene or train: its file, the tables of one, or an object.
    vary : str or iterable of str
        ``PATH=LOW:HIGH``, such as ``bearing.B.position=180 mm:240 mm``.
    goal : str
        ``max bending 1``, ``min C_zz``, ``min mass`` ...; of a train a column of its sweep, such as
        ``min transmission_error``.
    keep : str or iterable of str
        Limits such as ``C_zz < 5 um/kN``, ``f1 > 600 Hz``, ``mass < 12 kg``; error bars included.
    keep_sum : str or iterable of str
        ``PATH+PATH``: sums that stay as they are in the file.
    model : str, optional
        Solve every design by it, such as ``timoshenko``, without error bars; by default by the
        cheapest mesh whose error bars are within `tol`.
    tol : float, optional
        Relative error bar of designs; a tenth of the tolerance of the scene by
        default.
    point : str, optional
        Of a train: operating point, by its name or number; the first by default.
    every_point : bool
        Of a train: goals and limits hold for the worst of all operating points.

    Returns
    -------
    Optimum

    Raises
    ------
    SolidgearError
        For texts that cannot be read, a number that designs do not have, and a file that cannot be
        solved in any of them.

    Examples
    --------
    A bearing of a stepped shaft, where bending 1 is highest, by a beam:

    >>> import solidgear as sg
    >>> found = sg.optimise("geometry/shaft_stepped.toml", ["bearing.B.position=-60 mm:-30 mm"],
    ...     "max bending 1", model="timoshenko")
    >>> found.best.number > 0, found.gain.relative > 0.1, found.at_end
    (True, True, ('bearing.B.position',))
    """
    wanted, limits = wish_of(goal), tuple(map(limit_of, names_in(keep)))
    texts, sums = tuple(map(_with_both_ends, names_in(vary))), names_in(keep_sum)
    document = document_of(scene)
    if document.describes_train:
        names = [wish.name for wish in (wanted, *limits)]
        designs = train_designs(
            document, SweepDesign(texts, keep_sum=sums), names, model, tol, point, every_point
        )
    else:
        designs = scene_designs(
            document, SweepDesign(texts, one_at_a_time=True, keep_sum=sums), model, tol
        )
    return _Search(wanted, limits, designs, progress).run()


class _Search:
    """Designs by their coordinates in the ranges of all entries, each between 0 and 1."""

    def __init__(
        self,
        goal: Wish,
        keep: tuple[Wish, ...],
        tried: Designs,
        progress: Callable[[str], None],
    ):
        self.goal, self.keep, self.tried, self.progress = goal, keep, tried, progress
        self.entries = tried.entries
        self.designs: list[Design] = []
        self.places: list[np.ndarray] = []

    def run(self) -> Optimum:
        """Search from the file as it is, at its place in the ranges as far as it is in them."""
        self._solve(np.full(len(self.entries), math.nan))
        self.places[0] = self._place_of_file()
        misses = [partial(self._shortfall, wish) for wish in self.keep]
        begin = np.nan_to_num(self.places[0], nan=0.5)
        how = search_box(len(self.entries), self._objective, misses, begin)
        sound = [
            design
            for design, place in zip(self.designs, self.places)
            # the file as it is may lie outside of the ranges
            if design.kept and design.value is not None and np.all(np.isfinite(place))
        ]
        best = min(sound, key=self._loss, default=None)
        return Optimum(
            self.tried.title,
            goal=self.goal,
            keep=self.keep,
            path=tuple(self.designs),
            best=best,
            at_end=tuple(
                entry.label
                for entry, x in zip(self.entries, self.places[best.number] if best else ())
                if min(x, 1 - x) <= AT_END
            ),
            how=how,
            unbarred=self.tried.unbarred,
            solved=self.tried.solved,
        )

    def _loss(self, design: Design) -> float:
        assert design.value is not None
        return -design.value if self.goal.upward else design.value

    def _objective(self, place: np.ndarray) -> float:
        """Compute the goal relative to that of the file, to be minimised; a refused design is worse
        than all others.
        """
        design = self._solve(place)
        sizes = [abs(d.value) for d in self.designs if d.value is not None]
        size = sizes[0] if sizes and sizes[0] else 1.0
        if design.value is None:
            return 2 * max(sizes, default=1.0) / size
        return self._loss(design) / size

    def _shortfall(self, wish: Wish, place: np.ndarray) -> float:
        return min(wish.missing(self._solve(place).rows), 10.0)

    def _solve(self, place: np.ndarray) -> Design:
        """Solve a design, or return one that was solved at the same place."""
        for design, solved in zip(self.designs, self.places):
            if np.array_equal(place, solved) or np.all(abs(place - solved) < SAME):
                return design
        number = len(self.designs)
        self.progress(f"design {number}")
        values = [_between(entry, x) for entry, x in zip(self.entries, place)]
        varied, rows = self.tried.solve(values)
        status = next((row["status"] for row in rows if row["status"] != "ok"), "ok")
        goal = self.goal.value(rows)
        kept = status == "ok" and all(wish.missing(rows) <= 0 for wish in self.keep)
        if status == "ok" and goal is None:
            names = self.tried.names(rows[0])
            raise SolidgearError(
                f"`goal` {self.goal}: a design has no {self.goal.name}"
                f"{nearest(self.goal.name, names)}; it has {', '.join(names)}"
            )
        value, bar = goal or (None, None)
        design = Design(number, varied, value, bar, kept, status, rows)
        self.designs.append(design)
        self.places.append(place.copy())
        return design

    def _place_of_file(self) -> np.ndarray:
        """Return the coordinates of the file in the ranges; not a number beyond them."""
        out = []
        for entry in self.entries:
            low, high = (in_si(entry.written(end)) for end in (entry.values[0], entry.values[-1]))
            value = in_si(entry.in_file)
            if value is None or low is None or high is None or high == low:
                out.append(math.nan)
                continue
            x = (value - low) / (high - low)
            out.append(x if 0 <= x <= 1 else math.nan)
        return np.array(out)


def _between(entry: Entry, x: float) -> float:
    low, high = entry.values[0], entry.values[-1]
    return math.nan if math.isnan(x) else float(f"{low + x * (high - low):.9g}")


def _with_both_ends(text: str) -> str:
    """Return ``PATH=LOW:HIGH`` as a sweep has it, with two values."""
    form = 'PATH=LOW:HIGH, such as "bearing.B.position=180 mm:240 mm"'
    path, spec = assignment(text, form)
    if spec.count(":") != 1:
        raise SolidgearError(f"`vary` {text}: write {form}")
    low, high = map(str.strip, spec.split(":"))
    if in_si(plain_number(low)) == in_si(plain_number(high)):
        raise SolidgearError(
            f"`vary` {text}: both ends are the same, and nothing is left to choose"
        )
    return f"{path}={spec}:2"


#: coordinates of a box whose corners are all sampled
MOST_CORNERED = 3
#: points of the sample: on a line, and for each coordinate of other boxes (a power of two for two)
LINE, INSIDE = 9, 8
#: searches from the sample, distance of their beginnings, and most designs of one a coordinate
STARTS, DISTANCE, MOST = 3, 0.25, 12
#: of a range: last steps of a search and of the last one, and a distance that is moved to the end
COARSE, FINE, NEAR = 1e-2, 1e-4, 2e-2
#: of the number, for a limit that is missed by all of it
PENALTY = 2.0

#: from a place in the unit box
Number = Callable[[np.ndarray], float]


def search_box(dimension: int, goal: Number, misses: Sequence[Number], begin: np.ndarray) -> str:
    """Search the least of a number where no miss is above zero, each relative to a size of its own, from
    a (dimension,) place `begin` and those of a sample; return the search in words.

    The caller keeps the places that its numbers were asked for: the best of them is the result.
    """
    merit = _merit(goal, misses)
    places = _sample(dimension)
    merits = [merit(place) for place in places]
    if dimension == 1 and not misses:
        count = _on_the_line(goal, [float(place[0]) for place in places], merits)
        return f"{LINE} designs across the range, then Brent's method from {_best(count)}"
    starts = _distant([begin, *places], [merit(begin), *merits])
    best = min(starts, key=merit)
    for start in starts:
        best = min(best, _trust_region(goal, misses, start, 0.2, COARSE), key=merit)
    ends = np.where(best < NEAR, 0.0, np.where(best > 1 - NEAR, 1.0, best))
    best = min(best, ends, key=merit)
    _trust_region(goal, misses, best, COARSE, FINE)
    return (
        f"{len(places)} designs across the ranges, then COBYQA from {_best(len(starts))}, and a last "
        f"step of {FINE:g} of the ranges"
    )


def _best(count: int) -> str:
    return "the best of them" if count == 1 else f"the {count} best separate ones"


def _merit(goal: Number, misses: Sequence[Number]) -> Number:
    """Return the number with a penalty for limits that are missed."""

    def merit(place: np.ndarray) -> float:
        missing = sum(max(0.0, miss(place)) for miss in misses)
        return goal(place) + (1.0 + PENALTY * missing if missing else 0.0)

    return merit


def _sample(dimension: int) -> list[np.ndarray]:
    """Return the places of a sample of the unit box."""
    from scipy.stats import qmc  # slow to import, and few commands have a use for it

    if dimension == 1:
        return list(np.linspace(0.0, 1.0, LINE)[:, None])
    corners: list[np.ndarray] = []
    if dimension <= MOST_CORNERED:
        corners = [*map(np.array, itertools.product((0.0, 1.0), repeat=dimension))]
    inside = qmc.Sobol(dimension, scramble=False).random_base2(int(np.log2(INSIDE * dimension)))
    return [*corners, *inside[1:]]  # the sequence begins in a corner


def _on_the_line(goal: Number, places: Sequence[float], values: Sequence[float]) -> int:
    """Run Brent's search about the places of a line that are better than their neighbours, the best
    first, and return their number.
    """
    from scipy.optimize import minimize_scalar

    wall = [np.inf, *values, np.inf]
    least = [k for k in range(len(places)) if wall[k] > wall[k + 1] <= wall[k + 2]]
    least = sorted(least, key=lambda k: values[k])[:STARTS]
    for k in least:
        low, high = places[max(k - 1, 0)], places[min(k + 1, len(places) - 1)]
        minimize_scalar(
            lambda x: goal(np.array([x])),
            bounds=(low, high),
            method="bounded",
            options={"xatol": COARSE / 2, "maxiter": MOST},
        )
    return len(least)


def _distant(places: Sequence[np.ndarray], merits: Sequence[float]) -> list[np.ndarray]:
    """Return the best places that lie a distance from each other."""
    starts: list[np.ndarray] = []
    for k in np.argsort(merits, kind="stable"):
        far = all(np.abs(places[k] - start).max() > DISTANCE for start in starts)
        if far and len(starts) < STARTS:
            starts.append(places[k])
    return starts


def _trust_region(
    goal: Number, misses: Sequence[Number], start: np.ndarray, first: float, last: float
) -> np.ndarray:
    """Run COBYQA with a first and last radius of the region, and return its last place."""
    from scipy.optimize import NonlinearConstraint, minimize

    limits = [NonlinearConstraint(miss, -np.inf, 0.0) for miss in misses]
    result = minimize(
        goal,
        start,
        bounds=[(0.0, 1.0)] * len(start),
        constraints=limits,
        method="COBYQA",
        options={
            "maxfev": MOST * len(start) + MOST * bool(misses),
            "initial_tr_radius": first,
            "final_tr_radius": last,
        },
    )
    return np.clip(result.x, 0.0, 1.0)
