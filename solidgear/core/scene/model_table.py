"""Tables of models as a file has them, with numbers in SI."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from numbers import Integral, Real
from typing import Any

from solidgear.core.scene.typed import Model


def entry_of(value: Any) -> Any:
    """Return a value as `tomllib` would give it: a model as a table, a sequence as a list.

    Examples
    --------
    >>> from solidgear.core.scene import BearingLoad
    >>> entry_of((BearingLoad(z="2 kN"), 1))
    [{'z': 2000.0}, 1]
    """
    if isinstance(value, Model):
        return table_of(value)
    if isinstance(value, Mapping):
        return {str(key): entry_of(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [entry_of(entry) for entry in value]
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, Integral):
        return int(value)
    return float(value) if isinstance(value, Real) else str(value)


def table_of(
    model: Model, *, leave_out: Collection[str] = (), write: Collection[str] = ()
) -> dict[str, Any]:
    """Return the table of a model by the keys of files: fields that differ from their defaults, and
    those to `write` in any case; None where a file has no entry.
    """
    table: dict[str, Any] = {}
    for name, field in type(model).model_fields.items():
        value = getattr(model, name)
        usual = name not in write and value == field.get_default()
        if value is not None and not usual and name not in leave_out:
            table[field.alias or name] = entry_of(value)
    return table
