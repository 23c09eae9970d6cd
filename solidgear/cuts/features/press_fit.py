r"""Hubs that are pressed or shrunk onto a cylinder.

Lame's thick rings: an interference I on the diameter d presses with

    p = I / (d (K_hub + K_shaft)),   K_hub = ((1 + Q^2)/(1 - Q^2) + nu)/E,
                                     K_shaft = ((1 + q^2)/(1 - q^2) - nu)/E

Q = d/d_hub and q = bore/d. A ring of the yield point R stays elastic to p = R (1 - Q^2)/sqrt(3), and a
solid shaft to 2 R/sqrt(3) (DIN 7190-1:2017).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator

from solidgear.core import PositiveLength, SceneError
from solidgear.core.scene.parts import Segment
from solidgear.core.scene.units import Diameter, Modulus, Poisson, Stress
from solidgear.cuts.features.detail import Stretch
from solidgear.cuts.features.fits import checked_fit, interference_of

#: interference over diameter at which steels have long yielded
LARGEST = 0.01


class PressFit(Stretch):
    """A hub pressed onto a cylinder.

    Examples
    --------
    >>> fit = PressFit(name="hub", segment="seat", y=0.0, hub_diameter="80 mm", interference="40 um")
    >>> seat = Segment(name="seat", y1=0.05, outer0=0.02, outer1=0.02)
    >>> f"{fit.pressure(seat) / 1e6:.1f} MPa"
    '78.8 MPa'
    """

    needs: ClassVar = (("interference", "fit"),)

    kind: Literal["press_fit"] = "press_fit"
    #: outer diameter of the hub, m
    hub_diameter: Diameter
    #: largest difference of diameters before joining, m, less what smoothing of surfaces takes
    interference: PositiveLength | None = None
    #: fit in place of the interference, such as H7/s6
    fit: Annotated[str, AfterValidator(checked_fit)] | None = None
    #: yield point of the hub, Pa; its pressure is not judged where none is given
    hub_yield_point: Stress | None = None
    #: Young's modulus of the hub, Pa
    hub_E: Modulus = 2.1e11
    #: Poisson's ratio of the hub
    hub_nu: Poisson = 0.3

    def most(self, segment: Segment) -> float:
        """Return the largest interference on a segment, m."""
        if self.fit is None:
            return self.interference or 0.0
        return interference_of(self.fit, 2 * segment.outer0)[1]

    def pressure(self, segment: Segment) -> float:
        """Return the largest pressure between hub and shaft, Pa, both elastic."""
        diameter, material = 2 * segment.outer0, segment.material
        hub, shaft = diameter / self.hub_diameter, segment.inner0 / segment.outer0
        gives = ((1 + hub**2) / (1 - hub**2) + self.hub_nu) / self.hub_E
        gives += ((1 + shaft**2) / (1 - shaft**2) - material.nu) / material.E
        return self.most(segment) / (diameter * gives)

    def hub_limit(self, segment: Segment) -> float | None:
        """Return the pressure at which the bore of the hub yields, Pa; None without a yield point."""
        if self.hub_yield_point is None:
            return None
        return self.hub_yield_point * (1 - (2 * segment.outer0 / self.hub_diameter) ** 2) / 3**0.5

    def shaft_limit(self, segment: Segment) -> float | None:
        """Return the pressure at which the shaft yields, Pa; None without a strength."""
        strength = segment.material.strength
        if strength is None:
            return None
        if not segment.inner0:
            return 2 * strength.yield_point / math.sqrt(3)
        hollow = 1 - (segment.inner0 / segment.outer0) ** 2
        return strength.yield_point * hollow / math.sqrt(3)

    def _fitted(self, segment: Segment) -> Iterator[SceneError]:
        diameter = 2 * segment.outer0
        if self.hub_diameter <= diameter:
            yield SceneError(
                f'a hub around "{segment.name}" is thicker than it, {diameter:.6g} m',
                path=("hub_diameter",),
            )
            return
        if (self.fit is None) == (self.interference is None):
            yield SceneError(
                'give either an interference or a fit, such as "H7/s6"', path=("interference",)
            )
            return
        if (self.interference or 0.0) > LARGEST * diameter:
            yield SceneError(
                f"is more than a hundredth of the diameter, {diameter:.6g} m: probably wrong units",
                path=("interference",),
            )
            return
        try:
            pressure = self.pressure(segment)
        except SceneError as error:
            yield error.located(None, path=("fit",))
            return
        for part, limit in (
            ("hub", self.hub_limit(segment)),
            ("shaft", self.shaft_limit(segment)),
        ):
            if limit is not None and pressure > limit:
                most = self.most(segment) * limit / pressure
                yield SceneError(
                    f"presses with {pressure / 1e6:.4g} MPa, and the {part} yields at "
                    f"{limit / 1e6:.4g} MPa (DIN 7190-1): it bears {1e6 * most:.3g} um at most",
                    path=("interference" if self.fit is None else "fit",),
                )
                return
