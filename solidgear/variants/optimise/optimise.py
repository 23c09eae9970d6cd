"""Search for the entries of a scene that reach a goal best, as far as error bars distinguish designs.

Every design is read, meshed and solved as a variant of a sweep, its mesh refined until its error bars
are within the tolerance: it costs seconds, and its small jumps from mesh to mesh would spoil differences.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import SolidgearError, nearest
from solidgear.variants.optimise.optimum import Design, Optimum
from solidgear.variants.optimise.searching import search_box
from solidgear.variants.optimise.wishes import Wish, limit_of, wish_of
from solidgear.variants.sweep.amounts import in_si
from solidgear.variants.sweep.design import Design as SweepDesign
from solidgear.variants.sweep.entries import Entry, assignment
from solidgear.variants.sweep.file_variants import SceneVariants, scene_variants
from solidgear.variants.sweep.scene_task import STATICS, SceneTask
from solidgear.variants.sweep.spans import plain_number

#: of a range: distance of two designs that are the same, and of an optimum at the end from the end
SAME, AT_END = 1e-6, 1e-6
#: natural frequencies that a goal may be of
MODES = 12


def optimise(
    scene: str | os.PathLike,
    vary: Iterable[str],
    goal: str,
    keep: Iterable[str] = (),
    *,
    keep_sum: Iterable[str] = (),
    model: str | None = None,
    tol: float | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Optimum:
    """Vary entries of a scene file to make a number as large or as small as possible.

    Parameters
    ----------
    scene : path
        Of the scene file.
    vary : iterable of str
        ``PATH=LOW:HIGH``, such as ``bearing.B.position=180 mm:240 mm``.
    goal : str
        ``max bending 1``, ``min C_zz``, ``min mass`` ...
    keep : iterable of str
        Limits such as ``C_zz < 5 um/kN``, ``f1 > 600 Hz``, ``mass < 12 kg``; error bars included.
    keep_sum : iterable of str
        ``PATH+PATH``: sums that stay as they are in the file.
    model : str, optional
        Solve every design by it, such as ``timoshenko``, without error bars; by default by the
        cheapest mesh whose error bars are within `tol`.
    tol : float, optional
        Relative error bar of designs; a tenth of the tolerance of the scene by
        default.

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
    wanted, limits = wish_of(goal), tuple(map(limit_of, keep))
    texts = tuple(map(_with_both_ends, vary))
    design = SweepDesign(texts, one_at_a_time=True, keep_sum=tuple(keep_sum))
    variants = scene_variants(Path(scene), design, "bearing.B.position=180 mm:240 mm")
    base = variants.variant(0)  # the file as it is
    variants.refuse_hopeless()
    tol = base.ask.tolerance / 10 if tol is None else tol
    task = SceneTask(variants, model, tol, {}, MODES)
    return _Search(wanted, limits, task, progress).run(base.title or base.name)


class _Search:
    """Designs by their coordinates in the ranges of all entries, each between 0 and 1."""

    def __init__(
        self,
        goal: Wish,
        keep: tuple[Wish, ...],
        task: SceneTask,
        progress: Callable[[str], None],
    ):
        self.goal, self.keep, self.task, self.progress = goal, keep, task, progress
        # the first variant is the design that is solved next
        self.variants: SceneVariants = task.variants
        self.entries = task.variants.entries
        self.designs: list[Design] = []
        self.places: list[np.ndarray] = []

    def run(self, title: str) -> Optimum:
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
            title,
            goal=self.goal,
            keep=self.keep,
            path=tuple(self.designs),
            best=best,
            at_end=() if best is None else self._at_end(best),
            how=how,
            model=self.task.model,
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
        return min(wish.missing(self._solve(place).row), 10.0)

    def _solve(self, place: np.ndarray) -> Design:
        """Solve a design, or return one that was solved at the same place."""
        for design, solved in zip(self.designs, self.places):
            if np.array_equal(place, solved) or np.all(abs(place - solved) < SAME):
                return design
        number = len(self.designs)
        self.variants.values[0] = [_between(entry, x) for entry, x in zip(self.entries, place)]
        self.progress(f"design {number}")
        row = self.task.rows([0])[0]
        goal = self.goal.value(row)
        kept = row["status"] == "ok" and all(wish.missing(row) <= 0 for wish in self.keep)
        if row["status"] == "ok" and goal is None:
            self._refuse_goal(row)
        value, bar = goal or (None, None)
        design = Design(number, self.variants.varied(0), value, bar, kept, row["status"], row)
        self.designs.append(design)
        self.places.append(place.copy())
        return design

    def _refuse_goal(self, row: dict[str, Any]) -> None:
        modes = [str(v) for k, v in row.items() if k.startswith("mode") and k != "model" and v]
        names = [*map(str, STATICS), "mass", *modes]
        raise SolidgearError(
            f"--goal {self.goal}: a design has no {self.goal.name}{nearest(self.goal.name, names)}; "
            f"it has {', '.join(names)}"
        )

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

    def _at_end(self, best: Design) -> tuple[str, ...]:
        place = self.places[best.number]
        return tuple(
            entry.label for entry, x in zip(self.entries, place) if min(x, 1 - x) <= AT_END
        )


def _between(entry: Entry, x: float) -> float:
    low, high = entry.values[0], entry.values[-1]
    return math.nan if math.isnan(x) else float(f"{low + x * (high - low):.9g}")


def _with_both_ends(text: str) -> str:
    """Return ``PATH=LOW:HIGH`` as a sweep has it, with two values."""
    form = 'PATH=LOW:HIGH, such as "bearing.B.position=180 mm:240 mm"'
    path, spec = assignment(text, form)
    if spec.count(":") != 1:
        raise SolidgearError(f"--vary {text}: write {form}")
    low, high = map(str.strip, spec.split(":"))
    if in_si(plain_number(low)) == in_si(plain_number(high)):
        raise SolidgearError(
            f"--vary {text}: both ends are the same, and nothing is left to choose"
        )
    return f"{path}={spec}:2"
