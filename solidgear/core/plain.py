"""Results as plain data, which JSON can hold."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import PurePath
from typing import Any

import numpy as np


def plain(value: Any) -> Any:
    """Return a result as plain data: dataclasses and named tuples as dicts, arrays as lists, infinite
    numbers as None.

    The tuple ``plain_names`` of a dataclass lists its keys in order, each the name of a field or a
    property, or a pair of key and name; without it, all fields but those that no ``repr`` shows.
    A method ``as_dict`` of a nested result is not called.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass
    ... class Bearing:
    ...     plain_names = ("name", ("axial_load", "axial"), "life")
    ...     name: str
    ...     load: np.ndarray
    ...     life: float
    ...
    ...     @property
    ...     def axial(self):
    ...         return self.load[1]
    >>> plain({"front": Bearing("A", np.array([1.0, 2.0]), math.inf)})
    {'front': {'name': 'A', 'axial_load': 2.0, 'life': None}}
    """
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if is_dataclass(value):
        names = getattr(value, "plain_names", None)
        if names is None:
            names = [field.name for field in fields(value) if field.repr]
        pairs = [(name, name) if isinstance(name, str) else name for name in names]
        return {key: plain(getattr(value, name)) for key, name in pairs}
    if hasattr(value, "_asdict"):  # a named tuple
        return plain(value._asdict())
    if hasattr(value, "model_dump"):  # of pydantic
        return value.model_dump(mode="json")
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    return str(value) if isinstance(value, PurePath) else value
