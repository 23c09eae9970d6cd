"""Lubrication of the bearings of a shaft, for the modified life of ISO 281."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator

from solidgear.core.errors import SceneError, near, show
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import PositiveSpeed, Reliability, Share, Viscosity, quantity
from solidgear.core.scene.written import Word, Written

#: ISO 281:2007, Table 13: e_C from the worst to the best of each word, for pitch diameters below
#: 100 mm and from there on
CLEANLINESS: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "extreme": ((1.0, 1.0), (1.0, 1.0)),
    "high": ((0.6, 0.8), (0.8, 0.9)),
    "normal": ((0.5, 0.6), (0.6, 0.8)),
    "slight contamination": ((0.3, 0.5), (0.4, 0.6)),
    "typical contamination": ((0.1, 0.3), (0.2, 0.4)),
    "severe contamination": ((0.0, 0.1), (0.0, 0.1)),
    "very severe contamination": ((0.0, 0.0), (0.0, 0.0)),
}


def _cleanliness(value: Any) -> Any:
    if isinstance(value, str) and value in CLEANLINESS:
        return value
    if isinstance(value, str) and not value[:1].isdigit():
        meant = near(value, CLEANLINESS)
        words = f'"{meant}"' if meant else ", ".join(CLEANLINESS)
        raise SceneError(
            f"is no cleanliness of ISO 281; write {words}, or its factor e_C, 0 to 1",
            value=show(value),
        )
    factor = quantity(value, "dimensionless")
    if not 0 <= factor <= 1:
        raise SceneError(
            "is the factor e_C of ISO 281, which lies between 0 (dirt) and 1 (clean)",
            value=show(value),
        )
    return factor


#: a word of ISO 281, or the factor e_C
Cleanliness = Share | Annotated[str, Word(tuple(CLEANLINESS))]


class Lubrication(Model):
    """Lubrication of all bearings of a shaft; numbers in SI, or texts with units.

    Attributes
    ----------
    viscosity : float
        Kinematic viscosity of the oil, or of the base oil of a grease, at working temperature,
        m2/s.
    cleanliness : str or float
        A word of ISO 281 (extreme, high, normal, slight contamination, typical contamination,
        severe contamination, very severe contamination), or the factor e_C itself.
    reliability : float
        Share of bearings that reach the modified life.
    speed : float or None
        Speed of the shaft, rad/s, where a bearing does not give one.

    Raises
    ------
    SceneError
        A value out of its range, or of another dimension.

    Examples
    --------
    >>> oil = Lubrication(viscosity="68 mm^2/s", cleanliness="normal", speed="1500 rpm")
    >>> oil.viscosity, oil.contamination(0.06)
    (6.8e-05, (0.5, 0.6))
    """

    viscosity: Viscosity
    cleanliness: Annotated[float | str, BeforeValidator(_cleanliness), Written(Cleanliness)]
    reliability: Reliability = 0.90
    speed: PositiveSpeed | None = None

    def contamination(self, pitch: float) -> tuple[float, float]:
        """Return the least and the largest factor e_C, for a pitch diameter in m."""
        if isinstance(self.cleanliness, str):
            return CLEANLINESS[self.cleanliness][pitch >= 0.1]
        return self.cleanliness, self.cleanliness
