"""Variants of files: tables with the entries that vary replaced."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.scene.paths import Tables
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.designations import kept_data
from solidgear.variants.sweep.entries import Entry, Kept, hinted, put_in

#: name of the file that was asked about, among others that it names
OWN = ""
#: label of operating points that are looked at in turn, which are put into no table
POINT = "point"
#: variants that are looked at for one that the rules of the files let pass
LOOKED = 2000


def in_own_file(path: str) -> tuple[str, str]:
    """Place of a path where there is one file."""
    return OWN, path


#: a scene or a train
T = TypeVar("T")


@dataclass(frozen=True)
class FileVariants(Generic[T]):
    """Points of a sweep over entries of files."""

    path: Path  #: of the file that was asked about
    files: Mapping[str, Tables]  #: tables by the names of files, those of `path` by an empty name
    entries: tuple[Entry, ...]  #: what varies
    values: np.ndarray  #: not a number where a variant leaves an entry as it is in the file
    kept: tuple[Kept, ...] = ()  #: sums that stay what they are in the file
    design: Design = Design()  #: they are the points of

    def __len__(self) -> int:
        return len(self.values)

    def told(self, index: int) -> dict[str, str | float | None]:
        """Values that vary, by their labels."""
        row = self.values[index].tolist()
        out = {one.label: one.told(value) for one, value in zip(self.entries, row)}
        for one in self.kept:
            file = one.places[0].file
            out[one.label] = one.left(put_in(self.files[file], file, self.entries, row))
        return out

    @property
    def columns(self) -> dict[str, type]:
        """Names and types of the columns of what varies."""
        out: dict[str, type] = {one.label: float if one.numeric else str for one in self.entries}
        return out | dict.fromkeys((one.label for one in self.kept), float)

    @property
    def plan(self) -> dict[str, Any]:
        """Entries that vary and how they are drawn, as data for JSON."""
        vary = {
            one.label: [one.spacing, one.unit, *(one.words or one.values)] for one in self.entries
        }
        return {"vary": vary, "sample": self.design.plan}

    @property
    def cautions(self) -> tuple[str, ...]:
        """Sentences on what does not fit together in variants that can be solved."""
        return tuple(kept_data(self.entries, self.files))

    def in_turn(self, numbers: Iterable[int]) -> list[int]:
        """Variants in the order in which they are solved."""
        return sorted(numbers)

    def first_sound(self) -> tuple[int, T]:
        """The first variant that the rules of the files let pass: its number, scene or train.

        Raises
        ------
        SolidgearError
            If there is none, with the entry that is refused whatever its value, if there is one.
        """
        refusal: Exception | None = None
        for index in dict.fromkeys(np.linspace(0, len(self) - 1, LOOKED).astype(int).tolist()):
            try:
                return index, self.tried(index)
            except SolidgearError as error:
                refusal = refusal or self.located(error, index)
        self.refuse_hopeless()
        self._refuse_as_it_is()
        raise SolidgearError(f"no variant can be solved; the first one is refused: {refusal}")

    def _refuse_as_it_is(self) -> None:
        """Refuse a file for what does not vary, in the words of the file."""
        try:
            self.read((), ())
        except SceneError as error:
            paths = [problem.path for problem in error.problems]
            if not any(_meets(path, entry.keys) for path in paths for entry in self.entries):
                if not error.where:
                    error = error.located(self.files[OWN], where=str(self.path))
                raise error from None

    def refuse_hopeless(self) -> None:
        """Refuse an entry that no file may have, whatever its value.

        Raises
        ------
        SolidgearError
        """
        for one in self.entries:
            self._refuse_whatever_its_value(one)

    def of(self, index: int) -> T:
        """Scene or train of one variant.

        Raises
        ------
        SceneError
            If files with these values would be refused.
        """
        return self.read(self.entries, self.values[index].tolist())

    def tried(self, index: int) -> T:
        """Scene or train of one variant, as far as it is checked before a sweep; raises like
        :meth:`of`.
        """
        return self.of(index)

    def read(self, varied: Sequence[Entry], row: Sequence[float]) -> T:
        """Scene or train of the files with some entries replaced."""
        raise NotImplementedError

    def _refuse_whatever_its_value(self, one: Entry) -> None:
        first: SceneError | None = None
        for value in one.values if one.label != POINT else ():
            try:
                self.read((one,), (value,))
                return
            except SceneError as error:
                own = [found for found in error.problems if _meets(found.path, one.keys)]
                if not own:
                    return
                first = first or own[0]
        if first is not None:
            raise SolidgearError(f"--vary {one.label}: {hinted(first, one.label, self.files)}")

    def located(self, error: SolidgearError, index: int) -> SolidgearError:
        """An error of one variant told with the key and the value of its own file."""
        if not isinstance(error, SceneError) or error.where:
            return error
        return error.located(self.tables(index)[OWN], where=str(self.path))

    def status(self, error: SolidgearError, index: int) -> str:
        """Reason why a variant has no numbers, in a line; the file asked about is not named."""
        found = self.located(error, index)
        problems = found.problems if isinstance(found, SceneError) else [found]
        told = [str(one).removeprefix(f"{self.path}: ") for one in problems]
        return " ".join("; ".join(told).split())

    def tables(self, index: int) -> dict[str, Tables]:
        """Tables of all files of one variant, by their names."""
        row = self.values[index].tolist()
        return {name: self.put(name, self.entries, row) for name in self.files}

    def put(
        self,
        name: str,
        varied: Sequence[Entry],
        row: Sequence[float],
        tables: Tables | None = None,
    ) -> Tables:
        """Tables of a file, or of one that takes its place, with values of its entries put in."""
        own = [pair for pair in zip(varied, row) if pair[0].label != POINT]
        tables = self.files[name] if tables is None else tables
        tables = put_in(tables, name, *zip(*own)) if own else tables
        for one in self.kept:
            tables = one.put(tables) if one.places[0].file == name else tables
        # what varies may lie beside the ranges that a file states, of which no row tells
        return {key: table for key, table in tables.items() if key != "uncertain"}


def _meets(path: tuple, keys: tuple) -> bool:
    """True where a problem is of an entry, of what lies in it or of a table that it was put in."""
    shared = min(len(path), len(keys))
    return shared > 0 and path[:shared] == keys[:shared]


def plain(data: Any) -> Any:
    """Tables of a file for JSON, without what no number depends on."""
    if isinstance(data, Mapping):
        return {k: plain(v) for k, v in data.items() if k not in ("title", "source", "note")}
    if isinstance(data, (list, tuple)):
        return [plain(one) for one in data]
    return data if isinstance(data, (str, int, float, type(None))) else str(data)
