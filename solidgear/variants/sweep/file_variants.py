"""Variants of files: tables with the entries that vary replaced, and the scenes that they make."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from solidgear.core import Scene, SceneError, SolidgearError, Source, document_of
from solidgear.core.loading import scene_of
from solidgear.core.scene.paths import Tables
from solidgear.core.scene.paths import entry as value_in_file
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.entries import Entry, KeptSum, explained, in_si, put_in
from solidgear.variants.sweep.following import Follower, followers_of, list_in

#: name of the file that was asked about, among others that it names
MAIN = ""
#: label of operating points that are looked at in turn, which are put into no table
POINT = "point"
#: variants that are tried for one that the rules of the files let pass
TRIED = 2000
#: a scene or a train
T = TypeVar("T")


@dataclass(frozen=True)
class FileVariants(Generic[T]):
    """Points of a sweep over entries of files."""

    path: Path  #: of the document that was asked about
    files: Mapping[str, Tables]  #: tables by the names of files, those of `path` by an empty name
    entries: tuple[Entry, ...]  #: entries that vary
    values: np.ndarray  #: not a number where a variant leaves an entry as it is in the file
    sums: tuple[KeptSum, ...] = ()  #: sums that stay as they are in the file
    design: Design = Design()  #: design that `values` are the points of
    followers: tuple[Follower, ...] = ()  #: what follows the entries that vary

    def __len__(self) -> int:
        return len(self.values)

    def varied(self, index: int) -> dict[str, str | float | None]:
        """Return the values of a variant by the labels of their entries."""
        row = self.values[index].tolist()
        out = {entry.label: entry.in_row(value) for entry, value in zip(self.entries, row)}
        for kept in self.sums:
            file = kept.places[0].file
            out[kept.label] = kept.remainder(put_in(self.files[file], file, self.entries, row))
        for follower in self.followers:
            tables = self.put(follower.file, self.entries, row)
            numbers = {p.label: in_si(value_in_file(p.keys, tables)) for p in follower.numbers}
            out.update(numbers)
        return out

    @property
    def columns(self) -> dict[str, type]:
        """Names and types of the columns of the entries that vary."""
        out: dict[str, type] = {
            entry.label: float if entry.numeric else str for entry in self.entries
        }
        further = [kept.label for kept in self.sums]
        further += [place.label for follower in self.followers for place in follower.numbers]
        return out | dict.fromkeys(further, float)

    @property
    def plan(self) -> dict[str, Any]:
        """Entries that vary and how they are drawn, as data for JSON."""
        vary = {
            entry.label: [entry.spacing, entry.unit, *(entry.words or entry.values)]
            for entry in self.entries
        }
        return {"vary": vary, "sample": self.design.plan}

    @property
    def followed(self) -> tuple[str, ...]:
        """Sentences on entries that follow those that vary."""
        return tuple(follower.sentence for follower in self.followers)

    def in_turn(self, numbers: Iterable[int]) -> list[int]:
        """Return variants in the order in which they are solved."""
        return sorted(numbers)

    # ---------------------------------------------------------------------------- scenes and trains
    def variant(self, index: int) -> T:
        """Return the scene or train of a variant; SceneError if files with these values are refused."""
        return self.read(self.entries, self.values[index].tolist())

    def checked_variant(self, index: int) -> T:
        """Return a variant as far as it is checked before a sweep; raises like :meth:`variant`."""
        return self.variant(index)

    def read(self, varied: Sequence[Entry], row: Sequence[float]) -> T:
        """Return the scene or train of the files with some entries replaced."""
        raise NotImplementedError

    def tables(self, index: int) -> dict[str, Tables]:
        """Return the tables of all files of a variant, by their names."""
        row = self.values[index].tolist()
        return {name: self.put(name, self.entries, row) for name in self.files}

    def put(
        self,
        name: str,
        varied: Sequence[Entry],
        row: Sequence[float],
        tables: Tables | None = None,
    ) -> Tables:
        """Return the tables of a file, or of one in its place, with the values of its entries."""
        tables = self.files[name] if tables is None else tables
        for entry, value in zip(varied, row):
            if entry.label != POINT:
                tables = put_in(tables, name, (entry,), (value,))
        for kept in self.sums:
            tables = kept.put(tables) if kept.places[0].file == name else tables
        for follower in self.followers:
            tables = follower.put(tables) if follower.file == name else tables
        # entries that vary may lie beside the ranges that a file states, which no row depends on
        return {key: table for key, table in tables.items() if key != "uncertain"}

    def fitting(self, name: str, tables: Tables, scene: Scene) -> Scene:
        """Return the scene of changed tables of a file, unless it does not go with a value that varies."""
        for follower in self.followers:
            if follower.file == name:
                follower.refuse(tables, scene)
        return scene

    # --------------------------------------------------------------------------------- refusals
    def first_sound(self) -> tuple[int, T]:
        """Return the number and the scene or train of the first variant that no rule refuses; if there
        is none, raise an error on the entry that is refused whatever its value, if there is one.
        """
        refusal: Exception | None = None
        for index in dict.fromkeys(np.linspace(0, len(self) - 1, TRIED).astype(int).tolist()):
            try:
                return index, self.checked_variant(index)
            except SolidgearError as error:
                refusal = refusal or self.located(error, index)
        self.refuse_hopeless()
        self._refuse_file_as_it_is()
        raise SolidgearError(f"no variant can be solved; the first one is refused: {refusal}")

    def refuse_hopeless(self) -> None:
        """Refuse an entry that no file may have, whatever its value."""
        for entry in self.entries:
            self._refuse_whatever_its_value(entry)

    def refuse_unknown_words(self) -> None:
        """Refuse a word of a list that the rules of the file do not know for its entry, such as a
        designation that there is not.
        """
        for entry in self.entries:
            for value in entry.values if entry.text and entry.label != POINT else ():
                try:
                    self.read((entry,), (value,))
                except SceneError as error:
                    places = [place.keys for place in entry.places]
                    unknown = [p for p in error.problems if p.path in places and p.value]
                    for problem in unknown:
                        raise SolidgearError(f"`vary` {problem.sentence}") from None

    def _refuse_whatever_its_value(self, entry: Entry) -> None:
        first: SceneError | None = None
        for value in entry.values if entry.label != POINT else ():
            try:
                self.read((entry,), (value,))
                return
            except SceneError as error:
                problems = [p for p in error.problems if _overlap(p.path, entry.keys)]
                if not problems:
                    return
                first = first or problems[0]
        if first is not None:
            raise SolidgearError(
                f"`vary` {entry.label}: {explained(first, entry.label, self.files)}"
            )

    def _refuse_file_as_it_is(self) -> None:
        """Refuse a file for entries that do not vary, in the words of the file."""
        try:
            self.read((), ())
        except SceneError as error:
            paths = [problem.path for problem in error.problems]
            if not any(_overlap(path, entry.keys) for path in paths for entry in self.entries):
                if not error.where:
                    error = error.located(self.files[MAIN], where=str(self.path))
                raise error from None

    def located(self, error: SolidgearError, index: int) -> SolidgearError:
        """Return an error of a variant with the key and the value of its own file."""
        if not isinstance(error, SceneError) or error.where:
            return error
        return error.located(self.tables(index)[MAIN], where=str(self.path))

    def status(self, error: SolidgearError, index: int) -> str:
        """Return the reason why a variant has no numbers, in a line without the main file's name."""
        located = self.located(error, index)
        problems = located.problems if isinstance(located, SceneError) else [located]
        sentences = [str(problem).removeprefix(f"{self.path}: ") for problem in problems]
        return " ".join("; ".join(sentences).split())


@dataclass(frozen=True)
class SceneVariants(FileVariants[Scene]):
    """Points of a sweep over entries of a scene file, catalogue bearings with their stiffness."""

    def read(self, varied: Sequence[Entry], row: Sequence[float]) -> Scene:
        tables = self.put(MAIN, varied, row)
        return self.fitting(MAIN, tables, scene_of(tables, self.path))


def scene_variants(scene: Source, design: Design, example: str) -> SceneVariants:
    """Return the points of a sweep over a scene; `example` of an entry is for error messages."""
    document = document_of(scene)
    files, path = {MAIN: document.tables}, Path(document.path)

    def owner(within: str) -> tuple[str, str]:
        return MAIN, within

    points = design.points(files, owner, example=example)
    followers = followers_of(
        points.entries,
        files,
        owner,
        lambda name: scene_of(files[name], path, alone=False),
        lambda name: list_in(files[name], path.parent),
        design.follow,
    )
    return SceneVariants(path, files, points.entries, points.values, points.sums, design, followers)


def _overlap(path: tuple, keys: tuple) -> bool:
    """True where a problem is of an entry, of a part of it or of a table around it."""
    shared = min(len(path), len(keys))
    return shared > 0 and path[:shared] == keys[:shared]


def tables_for_plan(data: Any) -> Any:
    """Return tables of a file for JSON, without texts that no number depends on."""
    if isinstance(data, Mapping):
        return {
            key: tables_for_plan(value)
            for key, value in data.items()
            if key not in ("title", "source", "note")
        }
    if isinstance(data, (list, tuple)):
        return [tables_for_plan(value) for value in data]
    return data if isinstance(data, (str, int, float, type(None))) else str(data)
