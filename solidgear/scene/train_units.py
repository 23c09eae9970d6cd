"""Quantities of a train that a single shaft does not have, and the ranges they must lie in."""

from __future__ import annotations

import math
import re
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator

from solidgear.errors import SceneError, show
from solidgear.scene.units import quantity

_WRITTEN = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S.*?)\s*")
_INERTIA = {"kg*m^2": 1.0, "kg m^2": 1.0, "kg*m2": 1.0, "kg m2": 1.0, "kg*mm^2": 1e-6}
_MASS = {"kg": 1.0, "g": 1e-3, "t": 1e3}


def _read(value: Any, units: dict[str, float], example: str) -> float:
    """A plain number in SI, or a text with one of a few units."""
    if isinstance(value, str):
        found = _WRITTEN.fullmatch(value)
        if found is None or found[2] not in units:
            raise SceneError(
                f'must be a number with a unit ({", ".join(units)}), such as "{example}"',
                value=show(value),
            )
        value = float(found[1]) * units[found[2]]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise SceneError(f'must be a number in SI or a text such as "{example}"', value=show(value))
    number = quantity(value, "dimensionless")
    if not number > 0:
        raise SceneError("must be greater than zero")
    return number


def _in(dimension: str) -> BeforeValidator:
    return BeforeValidator(lambda value: quantity(value, dimension))


def _positive(value: float) -> float:
    if not value > 0:
        raise SceneError("must be greater than zero")
    return value


def _angle(low: float, high: float, words: str) -> AfterValidator:
    def check(value: float) -> float:
        if not low <= value <= high:
            raise SceneError(f"must lie between {words}")
        return value

    return AfterValidator(check)


def _loss(value: float) -> float:
    if value < 0:
        raise SceneError("a loss factor must not be negative")
    if value > 1:
        percent = f"; {value:g} per cent is written {value / 100:g}" if value <= 100 else ""
        raise SceneError(f"a loss factor lies between 0 and 1{percent}")
    return value


def _lengths(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 3:
        raise SceneError('must be three lengths, such as ["-55 mm", "0 mm", "0 mm"]')
    return tuple(quantity(one, "length") for one in value)


def _not_negative(value: float) -> float:
    if value < 0:
        raise SceneError("must not be negative")
    return value


Mass = Annotated[float, BeforeValidator(lambda v: _read(v, _MASS, "14.7 kg"))]
Inertia = Annotated[float, BeforeValidator(lambda v: _read(v, _INERTIA, "2.7 kg*m^2"))]
TorsionSpring = Annotated[float, _in("moment"), AfterValidator(_positive)]
MeshSpring = Annotated[float, _in("force_per_length"), AfterValidator(_positive)]
Ordinate = Annotated[float, _in("length"), AfterValidator(_not_negative)]
Vector = Annotated[tuple[float, float, float], BeforeValidator(_lengths)]
Loss = Annotated[float, _in("dimensionless"), AfterValidator(_loss)]
SpiralAngle = Annotated[float, _in("angle"), _angle(0.0, 1.4, "0 and 80 degrees (0 and 1.4 rad)")]
PitchAngle = Annotated[
    float, _in("angle"), _angle(0.0, 1.56, "0 (cylindrical gears) and 89 degrees (1.56 rad)")
]
PressureAngle = Annotated[
    float, _in("angle"), _angle(0.05, 0.8, "3 and 45 degrees (0.05 and 0.8 rad)")
]
ShaftAngle = Annotated[
    float,
    _in("angle"),
    _angle(0.0, math.radians(175), "0 (parallel shafts) and 175 degrees"),
]
