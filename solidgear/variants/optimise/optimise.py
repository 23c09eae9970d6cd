"""Entries of a scene chosen for a goal, as far as error bars tell one design from another.

Every design is read, meshed and solved as a variant of a sweep, its mesh refined until its bars are
within the tolerance: it costs seconds, and its small jumps from mesh to mesh would spoil differences.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.errors import SolidgearError, nearest
from solidgear.variants.optimise.optimum import Design, Optimum
from solidgear.variants.optimise.searching import searched
from solidgear.variants.optimise.wishes import Wish, limit_of, wish_of
from solidgear.variants.sweep import design
from solidgear.variants.sweep.amounts import in_si
from solidgear.variants.sweep.entries import Entry
from solidgear.variants.sweep.scene_task import STATICS, SceneTask
from solidgear.variants.sweep.scene_variants import scene_variants
from solidgear.variants.sweep.spans import plain_number

#: of a range: how near two designs are one, and how near to its end an optimum is at the end
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
    """Search entries of a scene file for the largest or smallest of a number.

    Parameters
    ----------
    scene : path
        Of the scene file.
    vary : iterable of str
        ``PATH=LOW:HIGH``, such as ``bearing.B.position=180 mm:240 mm``.
    goal : str
        ``max bending 1``, ``min C_zz``, ``min mass`` ...
    keep : iterable of str
        Limits such as ``C_zz < 5 um/kN``, ``f1 > 600 Hz``, ``mass < 12 kg``; bars included.
    keep_sum : iterable of str
        ``PATH+PATH``: sums that stay what they are in the file.
    model : str, optional
        Solve every design by it, such as ``timoshenko``, without bars; by default by the cheapest
        mesh whose bars are within `tol`.
    tol : float, optional
        Relative, that bars of designs are brought to; a tenth of the tolerance of the scene by
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
    texts = tuple(map(_ends, vary))
    drawn = design.Design(texts, one_at_a_time=True, keep_sum=tuple(keep_sum))
    variants = scene_variants(Path(scene), drawn, "bearing.B.position=180 mm:240 mm")
    base = variants.of(0)  # the file as it is
    variants.refuse_hopeless()
    tol = base.ask.tolerance / 10 if tol is None else tol
    task = SceneTask(variants, model, tol, {}, MODES)
    return _Search(wanted, limits, task, progress).run(base.title or base.name)


class _Search:
    """Designs by their places in the ranges of all entries, each between 0 and 1."""

    def __init__(
        self,
        goal: Wish,
        keep: tuple[Wish, ...],
        task: SceneTask,
        progress: Callable[[str], None],
    ):
        self.goal, self.keep, self.task, self.progress = goal, keep, task, progress
        # the first of them is the one that is read next
        self.variants, self.entries = task.variants, task.variants.entries
        self.designs: list[Design] = []
        self.places: list[np.ndarray] = []

    def run(self, title: str) -> Optimum:
        """Search from the file as it is, at its place in the ranges as far as it is in them."""
        self._solved(np.full(len(self.entries), math.nan))
        self.places[0] = self._place_of_file()
        misses = [partial(self._shortfall, wish) for wish in self.keep]
        begin = np.nan_to_num(self.places[0], nan=0.5)
        how = searched(len(self.entries), self._objective, misses, begin)
        sound = [
            one
            for one, place in zip(self.designs, self.places)
            # the file as it is may lie outside of the ranges
            if one.kept and one.value is not None and np.all(np.isfinite(place))
        ]
        best = min(sound, key=self._loss, default=None)
        at_end = () if best is None else self._at_end(best)
        return Optimum(
            title, self.goal, self.keep, tuple(self.designs), best, at_end, how, self.task.model
        )

    def _loss(self, one: Design) -> float:
        assert one.value is not None
        return -one.value if self.goal.upward else one.value

    def _objective(self, place: np.ndarray) -> float:
        """Goal relative to that of the file, to be made small; of a refused design worse than any."""
        one = self._solved(place)
        known = [abs(d.value) for d in self.designs if d.value is not None]
        size = known[0] if known and known[0] else 1.0
        if one.value is None:
            return 2 * max(known, default=1.0) / size
        return self._loss(one) / size

    def _shortfall(self, wish: Wish, place: np.ndarray) -> float:
        return min(wish.missing(self._solved(place).row), 10.0)

    def _solved(self, place: np.ndarray) -> Design:
        """A design, or one that was solved as near as makes no difference."""
        for one, there in zip(self.designs, self.places):
            if np.array_equal(place, there) or np.all(abs(place - there) < SAME):
                return one
        number = len(self.designs)
        self.variants.values[0] = [_between(entry, x) for entry, x in zip(self.entries, place)]
        self.progress(f"design {number}")
        row = self.task.rows([0])[0]
        told = self.goal.of(row)
        kept = row["status"] == "ok" and all(wish.missing(row) <= 0 for wish in self.keep)
        if row["status"] == "ok" and told is None:
            self._refuse_goal(row)
        value, bar = told or (None, None)
        one = Design(number, self.variants.told(0), value, bar, kept, row["status"], row)
        self.designs.append(one)
        self.places.append(place.copy())
        return one

    def _refuse_goal(self, row: dict[str, Any]) -> None:
        named = [str(v) for k, v in row.items() if k.startswith("mode") and k != "model" and v]
        has = [*map(str, STATICS), "mass", *named]
        raise SolidgearError(
            f"--goal {self.goal}: a design has no {self.goal.name}{nearest(self.goal.name, has)}; "
            f"it has {', '.join(has)}"
        )

    def _place_of_file(self) -> np.ndarray:
        """Place of the file in the ranges; not a number beyond them."""
        out = []
        for entry in self.entries:
            low, high = (in_si(entry.put(value)) for value in (entry.values[0], entry.values[-1]))
            there = in_si(entry.there)
            if there is None or low is None or high is None or high == low:
                out.append(math.nan)
                continue
            x = (there - low) / (high - low)
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


def _ends(text: str) -> str:
    """A range for two ends, in the words of sweeps."""
    path, _, spec = text.partition("=")
    if spec.count(":") != 1:
        raise SolidgearError(
            f'--vary {text}: write PATH=LOW:HIGH, such as "bearing.B.position=180 mm:240 mm"'
        )
    low, high = map(str.strip, spec.split(":"))
    if in_si(plain_number(low)) == in_si(plain_number(high)):
        raise SolidgearError(
            f"--vary {text}: both ends are the same, and nothing is left to choose"
        )
    return f"{path}={spec}:2"
