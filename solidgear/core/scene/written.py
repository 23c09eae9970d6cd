"""How a file writes the fields of models: marks that a schema of files is made of.

A field without a mark is written as its type says.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from solidgear.core.errors import SceneError


@dataclass(frozen=True, eq=False)
class Written:
    """Mark of a field that is read from something else than its type: `kind` is a type, or a mapping
    of the keys of a table to their types.
    """

    kind: Any


@dataclass(frozen=True)
class Word:
    """Mark of a text: words to choose from, or a regular expression of all that is read."""

    words: tuple[str, ...] = ()
    pattern: str = ""


@dataclass(frozen=True, eq=False)
class Kinds:
    """Mark of a table that is one of several models, by its key ``kind``."""

    tables: Callable[[], Mapping[str, Any]]  #: called when a schema is made
    #: keys that the reader gives where a file does not
    given: tuple[str, ...] = ()


@dataclass(frozen=True)
class Range:
    """Range of a number in SI, and the reason why a number outside is refused."""

    reason: str
    #: above, below: ends that are outside; least, most: ends that are inside
    above: float = -inf
    least: float = -inf
    below: float = inf
    most: float = inf

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self.check, handler(source))

    def check(self, value: float) -> float:
        """Return a number of the range; refuse any other."""
        if value > self.above and self.least <= value <= self.most and value < self.below:
            return value
        raise SceneError(self.reason)


@dataclass(frozen=True)
class Measure:
    """Mark of a number in the SI unit of a dimension, which a text may give in another unit."""

    dimension: str
    read: Callable[[Any, str], float]

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_before_validator_function(
            lambda value: self.read(value, self.dimension), handler(source)
        )


@dataclass(frozen=True)
class Three:
    """Mark of three quantities of one dimension, with an example."""

    dimension: str
    example: str
    read: Callable[[Any, str], float]

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self._read_all, handler(source))

    def _read_all(self, value: Any) -> tuple[float, ...]:
        if not isinstance(value, (list, tuple)) or len(value) != 3:
            raise SceneError(f"must be three quantities, {self.example}")
        return tuple(self._read_entry(k, entry) for k, entry in enumerate(value))

    def _read_entry(self, place: int, entry: Any) -> float:
        try:
            return self.read(entry, self.dimension)
        except SceneError as error:
            raise error.located(None, path=(place,)) from None
