"""What all parts of a record are made of."""

from __future__ import annotations

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

from solidgear.core.plain import plain

Number = Annotated[float | None, BeforeValidator(plain)]


class Part(BaseModel):
    """Part of a record: fields that are missing, or None where None is not allowed, have their
    default; unknown ones are kept. It may be made from an object with attributes of the same names.
    """

    model_config = ConfigDict(extra="allow", from_attributes=True, defer_build=True)

    @field_validator("*", mode="wrap")
    @classmethod
    def _none_is_missing(cls, value: Any, validate: ValidatorFunctionWrapHandler) -> Any:
        try:
            return validate(value)
        except ValidationError:
            if value is None:
                raise PydanticUseDefault from None
            raise
