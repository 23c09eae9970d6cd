"""Rigid mass on a shaft: a disc, a coupling half, a gear blank, a mass without extent."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import model_validator

from solidgear.core.errors import SceneError
from solidgear.core.frames import shift
from solidgear.core.scene.places import Placed, Places
from solidgear.core.scene.stations import Attachment
from solidgear.core.scene.units import POSITION_DECIMALS, Mass, Position, PositiveLength, three

ON_A_STATION = "belongs to a seat of its own; a mass on a station has that of the station"


class PointMass(Placed):
    """A rigid mass that moves with a port, a bearing seat or a seat of its own.

    Attributes
    ----------
    name : str
        Name in reports; without it, the scene makes one.
    mass : float
        Mass, kg.
    inertia : tuple of float
        Moments of inertia about axes x, y, z through the centre of mass, kg m^2; y is the polar
        one. Zero for a mass without extent.
    offset : tuple of float
        From the station to the centre of mass, along x, y, z, m.
    on : str or None
        Name of the lumped point or the bearing that it moves with, or of the segment that is its
        seat; None for a seat of its own.
    y : float
        Middle of the seat of its own, m.
    seat_width : float or None
        Width of the seat of its own, m.
    attachment : {'average', 'rigid', 'section'}
        How the seat follows the mass.

    Raises
    ------
    SceneError
        A mass that is not positive, moments of inertia that no body has, or neither a station nor a
        seat.

    Examples
    --------
    >>> from solidgear import PointMass
    >>> disc = PointMass(name="disc", mass="8 kg", inertia=[0.02, 0.035, 0.02],
    ...                  offset=["0 mm", "100 mm", "0 mm"], on="pinion")
    >>> round(float(disc.matrix[3, 3]), 6), round(float(disc.matrix[2, 3]), 6)
    (0.1, 0.8)
    """

    needs: ClassVar = (("on", "position"), ("on", "seat_width"))

    name: str = ""
    mass: Mass
    inertia: Annotated[tuple[float, float, float], three("inertia", "about x, y and z")] = (
        0.0,
        0.0,
        0.0,
    )
    offset: Annotated[tuple[float, float, float], three("length", "along x, y and z")] = (
        0.0,
        0.0,
        0.0,
    )
    on: str | None = None
    y: Position = 0.0
    seat_width: PositiveLength | None = None
    attachment: Attachment = "average"

    @model_validator(mode="after")
    def _is_a_body_somewhere(self) -> PointMass:
        check_inertia(self.inertia)
        if self.on is None and self.seat_width is None:
            raise SceneError(
                "this key is missing: the width of the seat that carries the mass, unless on "
                "names a port, bearing or segment that does",
                path=("seat_width",),
            )
        if self.on is not None:
            seat = {"y": self.y, "seat_width": self.seat_width, "attachment": self.attachment}
            for key, value in seat.items():
                if value != type(self).model_fields[key].get_default():
                    raise SceneError(ON_A_STATION, path=(key,))
        return self

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        if "on" not in table:
            hint = 'name the port, bearing or segment that carries it, or write position = "28 mm"'
            words.require("position", hint, "on")
            return {"y": words.y(places)}
        if words.position is not None:
            raise SceneError("give either on or position, not both", path=("position",))
        words.refuse(ON_A_STATION, "from_", "seat_width", "attachment", table=table)
        return {"attachment": "average"}

    @property
    def station(self) -> str:
        """Name of the station that it moves with."""
        return self.on or self.name

    def attached(self, attachment: str) -> PointMass:
        """Return the mass with another attachment of its seat; one on a station unchanged."""
        return self if self.on is not None else self.with_changes(attachment=attachment)

    @property
    def lo(self) -> float:
        """End of the seat towards y = 0, m."""
        assert self.seat_width is not None  # asked of own seats only
        return round(self.y - self.seat_width / 2, POSITION_DECIMALS)

    @property
    def hi(self) -> float:
        """End of the seat away from y = 0, m."""
        assert self.seat_width is not None  # asked of own seats only
        return round(self.y + self.seat_width / 2, POSITION_DECIMALS)

    @property
    def matrix(self) -> np.ndarray:
        """(6, 6) mass matrix about the point of the station, order x y z thx thy thz: kg, kg m and
        kg m^2.
        """
        at_centre = np.diag([*[self.mass] * 3, *self.inertia])
        to_centre = shift(self.offset)
        return to_centre.T @ at_centre @ to_centre


def check_inertia(inertia: tuple[float, float, float]) -> None:
    """Refuse moments of inertia (kg m^2, about three orthogonal axes) that no body has."""
    if min(inertia) < 0:
        raise SceneError("a moment of inertia must not be negative", path=("inertia",))
    if 2 * max(inertia) > (1 + 1e-9) * sum(inertia):
        raise SceneError(
            "one moment of inertia is larger than the sum of the other two, which is impossible; "
            "a thin disc across the shaft has [I, 2 I, I]",
            path=("inertia",),
        )
