"""Data that a rating by DIN 743 needs beyond the shaft, loads and strength."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from solidgear.core import Model, PositiveLength, SceneError, show
from solidgear.core.scene.units import Hours, Stress
from solidgear.strength.stress.norm.life import FEWEST

if TYPE_CHECKING:
    from solidgear.strength.stress.nominal import NominalStress

#: m, Rz of no shaft is larger; a factor of strength by size or surface, a share of a mean
ROUGHEST = 1e-3
StrengthFactor = Annotated[float, Field(gt=0, le=10)]
Share = Annotated[float, Field(ge=0)]


def _levels(value: Any) -> Any:
    """Return the levels of a spectrum from a text such as ``1:2e4, 0.7:1e6``; others as they are."""
    if not isinstance(value, str):
        return value
    levels = []
    for part in value.split(","):
        factor, _, cycles = part.partition(":")
        try:
            levels.append((float(factor), float(cycles)))
        except ValueError:
            raise SceneError(
                f"{show(part.strip(), 30)} is no level; write factors of the load with their "
                "cycles, such as 1:2e4, 0.7:1e6"
            ) from None
    return tuple(levels)


Level = tuple[Annotated[float, Field(gt=0)], Annotated[float, Field(gt=0)]]
Levels = Annotated[tuple[Level, ...], BeforeValidator(_levels), Field(min_length=1)]


class Conditions(Model):
    """Data that a rating by DIN 743 needs beyond the shaft, loads and strength; a factor that is
    not positive, or a share below zero, is refused.

    Examples
    --------
    >>> Conditions(roughness="6.3 um", torque_share=0.2).roughness
    6.3e-06
    >>> Conditions(spectrum="1:2e4, 0.7:1e6").spectrum
    ((1.0, 20000.0), (0.7, 1000000.0))
    """

    roughness: Annotated[PositiveLength, Field(le=ROUGHEST)] | None = None  #: rz of the notch, m
    #: ultimate_at_size, yield_at_size: K_1: strength at the size of the part over the one given; by
    #: the group of the steel where that is known
    ultimate_at_size: StrengthFactor | None = None
    yield_at_size: StrengthFactor | None = None
    #: d_eff of K_1, m; else the largest diameter of the shaft
    treated_diameter: PositiveLength | None = None
    hardening: StrengthFactor | None = None  #: K_V of the surface
    hard_surface: bool = False  #: whether the surface is case-hardened, nitrided or hardened
    surface_strength: Stress | None = None  #: tensile strength of a hard surface, Pa
    #: force_share, torque_share: amplitudes of axial force and torque over their mean
    force_share: Share | None = None
    torque_share: Share | None = None
    #: amplitude of bending over its mean where the shaft stands still; else it turns, and bending
    #: is all amplitude
    bending_share: Share | None = None
    #: largest load over the load, for yielding and first cracks
    overload: Annotated[float, Field(ge=1, le=100)] | None = None
    #: whether mean stress stays as loads grow (case 1 of the norm) or grows with them (case 2)
    constant_mean: bool = False
    #: cycles of the load, for a finite life; without them fatigue is endless
    cycles: Annotated[float, Field(gt=0)] | None = None
    #: factors of the load, each with its cycles, in place of `cycles`
    spectrum: Levels | None = None
    #: life in hours, of a duty table with shares of the time
    hours: Hours | None = None
    #: sum of damage that a spectrum bears
    damage_sum: Annotated[float, Field(gt=0, le=2)] | None = None

    @model_validator(mode="after")
    def _one_life(self) -> Conditions:
        if self.cycles is not None and self.spectrum is not None:
            raise SceneError("give either cycles or a spectrum, not both", path=("spectrum",))
        if self.cycles is not None and self.cycles < FEWEST:
            raise SceneError(
                f"finite life begins at {FEWEST:g} cycles; below, the yield limit decides",
                path=("cycles",),
            )
        if self.surface_strength is not None and not self.hard_surface:
            raise SceneError(
                "is that of a hard surface; say hard_surface too", path=("surface_strength",)
            )
        if self.hard_surface and (self.cycles is not None or self.spectrum is not None):
            raise SceneError(
                "finite life is for surfaces that are not hardened: the slope of others is not "
                "known here",
                path=("cycles" if self.cycles is not None else "spectrum",),
            )
        return self

    def levels(self, nominal: NominalStress) -> tuple[LoadLevel, ...]:
        """Return the levels of a nominal stress under the spectrum, or the one level."""
        spectrum = self.spectrum or ((1.0, self.cycles),)
        return tuple(LoadLevel(scaled(nominal, factor), cycles) for factor, cycles in spectrum)


@dataclass(frozen=True)
class LoadLevel:
    """A nominal stress and its cycles, None for endless ones."""

    nominal: NominalStress
    cycles: float | None


def scaled(nominal: NominalStress, factor: float) -> NominalStress:
    """Return a nominal stress times a factor."""
    return type(nominal)(*(factor * getattr(nominal, f.name) for f in fields(nominal)))
