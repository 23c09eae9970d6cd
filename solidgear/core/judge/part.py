"""Parts of a record of a run: data that are missing have defaults, and numbers are finite or None."""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    ValidationError,
    ValidatorFunctionWrapHandler,
    field_validator,
)
from pydantic_core import PydanticUseDefault


def _plain(value: Any) -> Any:
    """Return a value as lists, dicts, texts and finite numbers; anything else from numpy is None."""
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


Number = Annotated[float | None, BeforeValidator(_plain)]
Numbers = Annotated[list[float | None], BeforeValidator(_plain)]
Matrix = Annotated[list[list[float | None]], BeforeValidator(_plain)]
Facts = Annotated[dict[str, Any], BeforeValidator(_plain)]
Quantities = dict[str, Number]


class Part(BaseModel):
    """Part of a record: fields that are missing, or None where None is not allowed, have their
    default; unknown ones are kept. It may be made from an object with attributes of the same names.
    """

    model_config = ConfigDict(extra="allow", from_attributes=True)

    @field_validator("*", mode="wrap")
    @classmethod
    def _none_is_missing(cls, value: Any, validate: ValidatorFunctionWrapHandler) -> Any:
        try:
            return validate(value)
        except ValidationError:
            if value is None:
                raise PydanticUseDefault from None
            raise
