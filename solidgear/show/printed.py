"""What a command prints as JSON, by the types of its results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, eq=False)
class Printed:
    """Keys of a table of JSON: those of results as :func:`solidgear.core.plain.plain` gives them, and
    further ones by their types.
    """

    #: results whose keys it has
    results: tuple[type | Printed, ...] = ()
    keys: Mapping[str, Any] = field(default_factory=dict)
    #: keys that not every run has, of results all
    sometimes: Mapping[str, Any] = field(default_factory=dict)
    optional: tuple[type, ...] = ()
    #: type of entries under names of the file, such as models by shaft
    named: Any = None
    #: keys of results that it does not have
    without: tuple[str, ...] = ()
