"""Table of facts of a run, such as its machine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.show.table import Table, text
from solidgear.show.words import DASH


def pairs_of(
    mapping: Mapping[str, Any], caption: str, heads: tuple[str, str] = ("item", "value")
) -> Table:
    """Return a table of a mapping, an entry a row."""
    rows = [[str(key), _flat(value)] for key, value in mapping.items()]
    return Table(caption, [heads[0], text(heads[1])], rows, style="facts")


def _flat(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{k} {_flat(v)}" for k, v in value.items())
    if isinstance(value, list):
        return ", ".join(_flat(v) for v in value)
    if value is None:
        return DASH
    return f"{value:.5g}" if isinstance(value, float) else str(value)
