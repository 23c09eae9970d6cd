"""Parts of a shaft, frozen and validated: material and segment."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BeforeValidator, model_serializer, model_validator

from solidgear.core.errors import SceneError
from solidgear.core.registry import addition
from solidgear.core.scene.limits import TOUCH
from solidgear.core.scene.materials import by_name
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import (
    Density,
    Modulus,
    Poisson,
    Position,
    PositiveLength,
    Stress,
    Thickness,
)

#: groups of DIN 743, by which strength falls with size
SteelGroup: TypeAlias = Literal[
    "construction", "tempering", "case_hardening", "case_hardening_crnimo", "nitriding"
]


class Strength(Model):
    """Strength of a material, for ratings of fatigue only."""

    #: yield point R_e or R_p0.2, Pa
    yield_point: Stress
    #: tensile strength R_m, Pa
    ultimate: Stress
    #: group of DIN 743: strength is that of a test bar (of 16 mm; tensile strength of construction
    #: and nitriding steels of 100 mm) and falls with the diameter of the shaft
    group: SteelGroup | None = None

    @model_serializer(mode="wrap")
    def _without_an_unknown_group(self, dump: Any) -> dict[str, Any]:
        data = dump(self)
        return {key: value for key, value in data.items() if value is not None}

    @model_validator(mode="after")
    def _yields_first(self) -> Strength:
        if self.yield_point > self.ultimate:
            raise SceneError(
                f"lies above the ultimate strength, {self.ultimate:.6g} Pa; a metal yields first",
                path=("yield_point",),
            )
        return self


_CONSTANTS = ("E", "nu", "density")


class Material(Model):
    """Isotropic linear elastic material; numbers in SI, or texts with units.

    Attributes
    ----------
    E : float
        Young's modulus, Pa.
    nu : float
        Poisson's ratio, between -1 and 0.5, both excluded.
    density : float
        Density, kg/m3.
    strength : Strength or None
        Yield point and ultimate strength, for ratings of fatigue.
    name : str
        Name in reports, without effect.

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
    strength: Strength | None = None
    name: str = ""

    @model_serializer(mode="wrap")
    def _without_what_is_not_given(self, dump: Any) -> dict[str, Any]:
        data = dump(self)
        return {key: value for key, value in data.items() if key in _CONSTANTS or value}

    def with_changes(self, **changes: Any) -> Material:
        """A validated copy with some fields replaced; other constants lose the name."""
        material = super().with_changes(**changes)
        unchanged = all(getattr(material, key) == getattr(self, key) for key in _CONSTANTS)
        if unchanged or "name" in changes or not material.name:
            return material
        return material.with_changes(name="")

    def following(self, usual: Material, replacement: Material) -> Material:
        """Return the material of a segment with constants that equal the usual ones replaced."""
        if self == usual:
            return replacement
        keys = [key for key in _CONSTANTS if getattr(self, key) == getattr(usual, key)]
        return self.with_changes(**{key: getattr(replacement, key) for key in keys})

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) in Pa."""
        return self.E / (2 * (1 + self.nu))


#: the material that files call "steel"
STEEL = Material(**by_name("steel"))


class Segment(Model):
    """A cylinder or cone between two places on the axis.

    Attributes
    ----------
    name : str
    y0, y1 : float
        Ends along the shaft, m. Without `y0` it begins where the segment before it ends.
    outer0, outer1 : float
        Outer radii at the two ends, m.
    inner0, inner1 : float
        Radii of the bore, m; 0 is solid.
    material : Material or str
        Constants, or the name of a material.
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
    y0: Position = 0.0
    y1: Position
    outer0: PositiveLength
    outer1: PositiveLength
    inner0: Thickness = 0.0
    inner1: Thickness = 0.0
    material: Annotated[Material, BeforeValidator(by_name)] = STEEL
    part: Literal["shaft", "frustum", "backcone"] = "shaft"

    def __init__(self, /, *values: Any, **data: Any):
        if "length" in data:
            raise SceneError(
                'with a length write Segment.cylinder("seat", length=0.04, diameter=0.09), or '
                "Segment.cone; Segment itself takes y1, outer0 and outer1",
                path=("length",),
            )
        super().__init__(*values, **data)

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
        y0: float | str | None = None,
        material: Material | str | None = None,
    ) -> Segment:
        """A cylinder.

        Parameters
        ----------
        name : str
        length, diameter, bore : float or str
            m, or texts with units; `bore` is a diameter, 0 is solid.
        y0 : float or str, optional
            Start along the shaft, m; without it, in a scene, the end of the segment before.
        material : Material or str, optional
            Constants, or a name; without it the segment takes that of the scene it is put into.

        Returns
        -------
        Segment

        Raises
        ------
        SceneError
            A length that is not positive, or a bore that leaves no wall.
        """
        words = {"name": name, "length": length, "diameter": diameter, "bore": bore}
        return addition("document", "segment of words")("cylinder", words, y0, material)

    @classmethod
    def cone(
        cls,
        name: str,
        *,
        length: Any,
        start_diameter: Any,
        end_diameter: Any,
        bore: Any = 0.0,
        y0: float | str | None = None,
        material: Material | str | None = None,
    ) -> Segment:
        """A cone with a constant bore.

        Parameters
        ----------
        name : str
        length, start_diameter, end_diameter, bore : float or str
            m, or texts with units; the outer diameters are those at `y0` and at the far end.
        y0 : float or str, optional
            Start along the shaft, m; without it, in a scene, the end of the segment before.
        material : Material or str, optional
            Constants, or a name; without it the segment takes that of the scene it is put into.

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
        words = {
            "name": name,
            "length": length,
            "start_diameter": start_diameter,
            "end_diameter": end_diameter,
            "bore": bore,
        }
        return addition("document", "segment of words")("cone", words, y0, material)

    def with_changes(self, **changes: Any) -> Segment:
        """Return a validated copy with some fields replaced; what a scene decides stays open."""
        values = {name: getattr(self, name) for name in self.model_fields_set}
        return type(self)(**{**values, **changes})

    def beginning_at(self, y: float) -> Segment:
        """Return the segment at its place, or beginning at `y` (m) where it was made without one."""
        if "y0" in self.model_fields_set:
            return self
        return self.with_changes(y0=y, y1=y + self.y1)

    @property
    def length(self) -> float:
        """Axial length in m."""
        return self.y1 - self.y0

    @property
    def diameter(self) -> float:
        """Outer diameter in m; of a cone, the larger one."""
        return max(self.start_diameter, self.end_diameter)

    @property
    def start_diameter(self) -> float:
        """Outer diameter at y0, m."""
        return 2 * self.outer0

    @property
    def end_diameter(self) -> float:
        """Outer diameter at y1, m."""
        return 2 * self.outer1

    @property
    def bore(self) -> float:
        """Diameter of the bore in m, the larger one where it is conical; 0 is solid."""
        return 2 * max(self.inner0, self.inner1)

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
