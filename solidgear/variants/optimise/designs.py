"""Designs of a search: variants of a file that are solved as rows of a sweep."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from solidgear.core import (
    SolidgearError,
    Source,
    nearest,
    read_tolerance,
    show,
)
from solidgear.core.body.mode_names import ModeName
from solidgear.variants.optimise.wish import FIRST, Rows
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.entries import Entry
from solidgear.variants.sweep.file_task import FileTask, without_bars
from solidgear.variants.sweep.file_variants import POINT, scene_variants
from solidgear.variants.sweep.scene_task import STATICS, SceneTask, statics_of
from solidgear.variants.sweep.shaft_numbers import ANSWER, columns_of
from solidgear.variants.sweep.shaft_numbers import ASKED as ASKED_OF_SHAFT
from solidgear.variants.sweep.train_task import ASKED, CONTACT, MASS, MODES, TrainTask, train_task

#: natural frequencies that a goal may be of
MOST_MODES = 12
EXAMPLE = "bearing.B.position=180 mm:240 mm"


@dataclass(frozen=True)
class Designs:
    """The file of a search, with its entries at any values."""

    task: FileTask
    title: str
    points: int  #: rows of a design, the first of the task
    solved: str  #: how every design is solved, in words
    unbarred: str  #: why its numbers have no error bars; empty where they have
    names: Callable[[dict[str, Any]], list[str]]  #: numbers of a row that goals may be of

    @property
    def entries(self) -> tuple[Entry, ...]:
        """Entries that a search varies."""
        return tuple(entry for entry in self.task.variants.entries if entry.label != POINT)

    def solve(self, values: Sequence[float]) -> tuple[dict[str, Any], Rows]:
        """Return a design by the labels of its entries and its rows; not a number leaves an entry as
        it is in the file.
        """
        self._set(values)
        varied = self.task.variants.varied(0)
        varied.pop(POINT, None)
        return varied, self.task.rows(range(self.points), cautions=False)

    def cautions(self, values: Sequence[float]) -> tuple[str, ...]:
        """Return sentences on what the numbers of a design that has some leave out."""
        self._set(values)
        told = (text for point in range(self.points) for text in self.task.cautions_of(point))
        return tuple(dict.fromkeys(told))

    def _set(self, values: Sequence[float]) -> None:
        self.task.variants.values[: self.points, : len(self.entries)] = values


def scene_designs(
    scene: Source, design: Design, names: Sequence[str], model: str | None, tol: float | str | None
) -> Designs:
    """Return the designs of a scene with the numbers of these names: each by the cheapest mesh whose
    bars are within the tolerance, or by a model that is given.
    """
    variants = scene_variants(scene, design, EXAMPLE)
    base = variants.variant(0)  # the file as it is
    variants.refuse_hopeless()
    variants.refuse_unknown_words()
    tol = base.ask.tolerance / 10 if tol is None else read_tolerance(tol)
    solved, unbarred = "the cheapest mesh whose bars are within the tolerance", ""
    if model is not None:
        solved = f"the {model} model, without error bars"
        unbarred = without_bars(model)
    columns = {kind: [*columns_of(base, (kind,), barred=False)] for kind in AT_REST}
    names_at_rest = [
        *map(str, statics_of(base)),
        "mass",
        *(name for group in columns.values() for name in group),
    ]
    _refuse_strange(names, names_at_rest)
    kinds, modes = _kinds_of_shaft(columns, names)
    task = SceneTask(variants, model, tol, {}, modes, ask=kinds, names=tuple(names))

    def names_of(row: dict[str, Any]) -> list[str]:
        modes_of_row = [
            str(v) for k, v in row.items() if k.startswith("mode") and k != "model" and v
        ]
        return [*names_at_rest, *modes_of_row]

    return Designs(task, base.title or base.name, 1, solved, unbarred, names_of)


#: kinds of numbers of a shaft that have columns of their own
AT_REST = tuple(kind for kind in ASKED_OF_SHAFT if kind != ANSWER)


def _refuse_strange(names: Sequence[str], known: Sequence[str]) -> None:
    """Refuse names that are no column and, without a number, no mode, before anything is solved."""
    for name in names:
        if not {name, name.replace(" ", "_")} & {*known} and not FIRST.fullmatch(name):
            if ModeName(name).number is None:
                raise SolidgearError(
                    f"`goal`, `keep`: a design has no {show(name, 40)}{nearest(name, known)}; it has "
                    f"{', '.join(known)}, and modes such as bending 1"
                )


def _kinds_of_shaft(
    columns: dict[str, list[str]], names: Sequence[str]
) -> tuple[tuple[str, ...], int]:
    """Return the kinds of numbers that names are of, and how many natural frequencies they want."""
    kinds, modes = set[str](), 1
    statics = {*map(str, STATICS)}
    for name in names:
        spelled = {name, name.replace(" ", "_")}
        kind = next((kind for kind, group in columns.items() if spelled & {*group}), ANSWER)
        if name == "mass":
            continue
        kinds.add(kind)
        if kind == ANSWER and name not in statics:
            first = FIRST.fullmatch(name)
            modes = max(modes, int(first["number"]) if first else MOST_MODES)
    return tuple(kind for kind in ASKED_OF_SHAFT if kind in kinds), min(modes, MOST_MODES)


def train_designs(
    train: Source,
    design: Design,
    names: Sequence[str],
    model: str | None,
    tol: float | str | None,
    point: str | int | None,
    every_point: bool,
) -> Designs:
    """Return the designs of a train, with the numbers of these names at an operating point or at all;
    every shaft by the model, the cheapest harmonic solid by default.
    """
    task = train_task(
        train,
        design,
        ask=(MODES,),
        n=MOST_MODES,
        tolerance=tol,
        point=point,
        every_point=every_point,
    )
    usual = task.usual
    models = task.models if model is None else dict.fromkeys(task.models, model)
    task = replace(task, models=models, ask=_kinds(task, names))
    task.variants.refuse_hopeless()
    task.variants.refuse_unknown_words()
    points = len(usual.operation) if every_point else 1
    solved = f"the {model} model" if model is not None else "harmonic solids"
    if task.ask == (CONTACT,):
        solved = "plane slices of the teeth on Timoshenko shafts"
    if every_point:
        solved += f", at the worst of {points} operating points"
    unbarred = "none: rows of a train have no error bars"
    title = usual.title or usual.name
    return Designs(task, title, points, solved, unbarred, _numbers_of_train)


def _kinds(task: TrainTask, names: Sequence[str]) -> tuple[str, ...]:
    """Return the kinds of numbers that names are of; names of no column are those of modes."""
    kinds = set()
    for name in {*names} - {MASS}:
        kind = next((k for k in ASKED if _is_of(replace(task, ask=(k,)), name)), MODES)
        kinds.add(kind)
    return tuple(kind for kind in ASKED if kind in kinds) or (MODES,)


def _is_of(task: TrainTask, name: str) -> bool:
    try:
        columns = task.columns
    except SolidgearError:  # of a train without teeth in mesh
        return False
    return bool({name, name.replace(" ", "_")} & {*columns})


def _numbers_of_train(row: dict[str, Any]) -> list[str]:
    modes = [str(v) for k, v in row.items() if k.startswith("mode") and isinstance(v, str)]
    numbers = [key for key, value in row.items() if isinstance(value, float)]
    return [*numbers, *modes]
