"""Border of the report, which reads typed records: results that come out of a file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from solidgear.core import Record, SolidgearError
from solidgear.core.judge.record import SCHEMA


def as_record(data: Mapping[str, Any], name: str = "the results") -> Record:
    """Return the plain data, such as ``results.json`` has it, as a record.

    Parameters
    ----------
    data : mapping
        Parts may be missing.  Data without a ``schema`` is taken for current.
    name : str
        What an error calls it.

    Raises
    ------
    SolidgearError
        For data of another version of the layout, or data that is no record.

    Examples
    --------
    >>> as_record({"verdict": {"trust": "harmonic"}}).verdict.trust
    'harmonic'
    >>> as_record({"schema": 2}, "out/results.json")
    Traceback (most recent call last):
    solidgear.core.errors.SolidgearError: out/results.json: written by an older version of solidgear (layout 2; this version reads 4); run solidgear compare again
    """
    version = data.get("schema")
    if version is not None and version != SCHEMA:
        older = isinstance(version, int) and version < SCHEMA
        raise SolidgearError(
            f"{name}: written by {'an older' if older else 'another'} version of solidgear "
            f"(layout {version}; this version reads {SCHEMA}); run solidgear compare again"
        )
    try:
        return Record.model_validate(data)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        raise SolidgearError(
            f"{name}: {place} cannot be read ({first['msg']}); run solidgear compare again"
        ) from None
