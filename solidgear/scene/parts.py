"""What a shaft is made of, each frozen and validated: material and segment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic.fields import FieldInfo

from solidgear.errors import TOLD, SceneError, did_you_mean, near, scene_error
from solidgear.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.scene.rules import TOUCH
from solidgear.scene.units import (
    Density,
    Modulus,
    Poisson,
    Position,
    PositiveLength,
    Thickness,
    quantity,
)

_Self = TypeVar("_Self", bound="Model")

#: words of the field for what a scene calls otherwise
OTHER_WORDS = {
    "rho": "density",
    "young": "E",
    "youngs_modulus": "E",
    "modulus": "E",
    "poisson": "nu",
    "poissons_ratio": "nu",
    "poisson_ratio": "nu",
    "name": "title",
    "at": "position",
    "y": "position",
    "width": "seat_width",
    "d": "diameter",
    "dia": "diameter",
    "od": "diameter",
    "outer_diameter": "diameter",
    "id": "bore",
    "di": "bore",
    "inner_diameter": "bore",
    "bore_diameter": "bore",
    "l": "length",
    "m": "mass",
    "k": "stiffness",
}


class Model(BaseModel):
    """Frozen and validated; a refusal names every problem in a sentence of its own.

    Raises
    ------
    SceneError
        By the constructor: unknown keys, missing ones, and values out of their range.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    def __init__(self, /, **data: Any):
        known = [field.alias or name for name, field in type(self).model_fields.items()]
        strange = [key for key in data if key not in known]
        meant = {key: self._meant(key, known) for key in strange[:TOLD]}
        problems = [
            SceneError(
                f"unknown key{did_you_mean(meant.get(key)) or '; known here: ' + ', '.join(known)}",
                path=(key,),
            )
            for key in strange
        ]
        try:
            super().__init__(**{key: data[key] for key in data if key in known})
        except ValidationError as error:
            # where a key is misspelt, it is not also missing
            absent = {(name,) for name in meant.values() if name not in data}
            problems += [one for one in scene_error(error, data).problems if one.path not in absent]
        if problems:
            raise SceneError.of(one.located(data) for one in problems) from None

    @classmethod
    def _meant(cls, key: str, known: list[str]) -> str:
        """The known key that a strange one stands for, as likely as not; empty for none."""
        word = OTHER_WORDS.get(key.lower())
        if word in known:
            return word
        if "stiffness" in known and key in STIFFNESS_NAMES:  # which stand in a table of their own
            return f"stiffness.{key}"
        inside = [name for name in known if key in _keys_of(cls.model_fields.get(name))]
        return near(key, known) or (f"{inside[0]}.{key}" if inside else "")

    def with_changes(self: _Self, **changes: Any) -> _Self:
        """A validated copy with some fields replaced.

        Parameters
        ----------
        **changes
            Fields by name.

        Returns
        -------
        Model
            Of the same class.

        Raises
        ------
        SceneError
            As by the constructor.
        """
        fields = type(self).model_fields
        given = {name: getattr(self, name) for name in fields} | changes
        keys = {name: field.alias or name for name, field in fields.items()}
        return type(self)(**{keys.get(name, name): value for name, value in given.items()})

    def model_copy(
        self: _Self, *, update: Mapping[str, Any] | None = None, deep: bool = False
    ) -> _Self:
        """As `with_changes` of `update`: pydantic's own copy would skip validation."""
        return self.with_changes(**(update or {}))


def _keys_of(field: FieldInfo | None) -> list[str]:
    """Keys of the table that a field holds; none where it holds none."""
    kinds = [field.annotation, *get_args(field.annotation)] if field else []
    tables = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, Model)]
    return [one.alias or name for table in tables for name, one in table.model_fields.items()]


class Material(Model):
    """Isotropic linear elastic material; numbers in SI, or texts with units.

    Attributes
    ----------
    E : float
        Young's modulus, Pa.
    nu : float
        Poisson's ratio, between -1 and 0.5, both excluded.
    density : float
        kg/m3.

    Raises
    ------
    SceneError
        A constant out of its range, or of another dimension.

    Examples
    --------
    >>> from solidgear import Material
    >>> aluminium = Material(E="70 GPa", nu=0.33, density=2700)
    >>> round(aluminium.shear_modulus / 1e9, 2)
    26.32
    """

    E: Modulus
    nu: Poisson
    density: Density

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) in Pa."""
        return self.E / (2 * (1 + self.nu))


STEEL = Material(E=2.07e11, nu=0.3, density=7850.0)


class Segment(Model):
    """A cylinder or cone between two places on the axis.

    Attributes
    ----------
    name : str
    y0, y1 : float
        Ends along the shaft, m.
    outer0, outer1 : float
        Outer radii at the two ends, m.
    inner0, inner1 : float
        Radii of the bore, m; 0 is solid.
    material : Material
    part : {'shaft', 'frustum', 'backcone'}

    Raises
    ------
    SceneError
        Ends in the wrong order, or a bore that leaves no wall.

    Examples
    --------
    >>> from solidgear import Segment
    >>> seat = Segment.cylinder("seat", length="40 mm", diameter="90 mm", bore="20 mm")
    >>> seat.y1, seat.outer0, seat.inner0
    (0.04, 0.045, 0.01)
    """

    name: str
    y0: Position
    y1: Position
    outer0: PositiveLength
    outer1: PositiveLength
    inner0: Thickness = 0.0
    inner1: Thickness = 0.0
    material: Material = STEEL
    part: Literal["shaft", "frustum", "backcone"] = "shaft"

    @model_validator(mode="after")
    def _has_a_wall(self) -> Segment:
        if self.y1 <= self.y0:
            raise SceneError("must lie beyond y0", path=("y1",))
        for end in "01":
            inner, outer = getattr(self, "inner" + end), getattr(self, "outer" + end)
            if inner >= outer:
                raise SceneError(
                    f"the bore must be smaller than the outer radius {outer:.6g} m",
                    path=("inner" + end,),
                )
        return self

    @classmethod
    def cylinder(
        cls,
        name: str,
        *,
        length: Any,
        diameter: Any,
        bore: Any = 0.0,
        y0: float = 0.0,
        material: Material | None = None,
    ) -> Segment:
        """A cylinder.

        Parameters
        ----------
        name : str
        length, diameter, bore : float or str
            m, or texts with units; `bore` is a diameter, 0 is solid.
        y0 : float
            Start along the shaft, m.
        material : Material, optional
            Without it the segment takes that of the scene it is put into.

        Returns
        -------
        Segment

        Raises
        ------
        SceneError
            A length that is not positive, or a bore that leaves no wall.
        """
        return cls.cone(
            name,
            length=length,
            start_diameter=diameter,
            end_diameter=diameter,
            bore=bore,
            y0=y0,
            material=material,
        )

    @classmethod
    def cone(
        cls,
        name: str,
        *,
        length: Any,
        start_diameter: Any,
        end_diameter: Any,
        bore: Any = 0.0,
        y0: float = 0.0,
        material: Material | None = None,
    ) -> Segment:
        """A cone with a constant bore.

        Parameters
        ----------
        name : str
        length, start_diameter, end_diameter, bore : float or str
            m, or texts with units; the outer diameters are those at `y0` and at the far end.
        y0 : float
            Start along the shaft, m.
        material : Material, optional
            Without it the segment takes that of the scene it is put into.

        Returns
        -------
        Segment

        Raises
        ------
        SceneError
            A length that is not positive, or a bore that leaves no wall.

        Examples
        --------
        >>> from solidgear import Segment
        >>> taper = Segment.cone("taper", length=0.2, start_diameter=0.04, end_diameter=0.08)
        >>> taper.radius_at(0.1)
        (0.0, 0.03)
        """
        outer0, outer1, inner = (
            quantity(d, "length") / 2 for d in (start_diameter, end_diameter, bore)
        )
        given: dict[str, Any] = {} if material is None else {"material": material}
        return cls(
            name=name,
            y0=y0,
            y1=y0 + quantity(length, "length"),
            outer0=outer0,
            outer1=outer1,
            inner0=inner,
            inner1=inner,
            **given,
        )

    @property
    def length(self) -> float:
        """Axial length in m."""
        return self.y1 - self.y0

    def radius_at(self, y: float) -> tuple[float, float]:
        """Radii of the bore and of the outer surface at one place.

        Parameters
        ----------
        y : float
            m.

        Returns
        -------
        inner, outer : float
            m.

        Raises
        ------
        ValueError
            A place outside the segment.
        """
        if not self.y0 - TOUCH <= y <= self.y1 + TOUCH:
            raise ValueError(
                f'y = {y} m is outside segment "{self.name}" ({self.y0} to {self.y1} m)'
            )
        t = min(max((y - self.y0) / self.length, 0.0), 1.0)
        return (1 - t) * self.inner0 + t * self.inner1, (1 - t) * self.outer0 + t * self.outer1
