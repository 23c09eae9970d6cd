"""Tooth numbers of a planetary stage: whether they assemble, ratio of speeds and radii."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import atan, cos, inf, isclose, isfinite, pi, radians, sin, tan

import numpy as np

from solidgear.core.errors import SceneError
from solidgear.core.gears.wheel import Rack
from solidgear.core.scene.units import TYPED

#: share of a tooth by which an azimuth typed with six digits is off from where a planet fits
FITS = 1e-3


@dataclass(frozen=True)
class PlanetaryTeeth:
    """Teeth of sun, planets and ring without profile shift; the ring stands still.

    Attributes
    ----------
    sun, planet, ring : int
        Numbers of teeth.
    module : float
        Transverse, m.
    planets : int or tuple of float
        Number of planets at equal angles, or the azimuth of each, rad.
    pressure_angle : float
        Transverse, rad.
    ratio : float, optional
        Ratio of the speeds of sun and carrier where it is given elsewhere, to be checked by the
        teeth.
    helix : float
        Helix angle at the pitch circles, rad; positive of a right-handed sun.

    Raises
    ------
    SceneError
        For teeth that do not mesh around one axis, planets that do not assemble or overlap, or
        another ratio.

    Examples
    --------
    >>> import solidgear as sg
    >>> teeth = sg.PlanetaryTeeth(17, 34, 85, module=1.5e-3)
    >>> teeth.speed_ratio, round(teeth.mesh_frequency(80.0), 2)
    (6.0, 1133.33)
    """

    sun: int
    planet: int
    ring: int
    module: float
    planets: int | tuple[float, ...] = 3
    pressure_angle: float = radians(20)
    ratio: float | None = None
    helix: float = 0.0

    def __post_init__(self):
        for field in fields(self)[:3]:
            value = getattr(self, field.name)
            if not (isinstance(value, int) and value > 0):
                raise SceneError(f"{field.name} has {value!r} teeth; give a whole number")
        if not (isfinite(self.module) and self.module > 0):
            raise SceneError(f"module is {self.module}; it must be finite and above zero")
        if not abs(self.helix) < pi / 2:
            raise SceneError(f"helix is {self.helix} rad; it lies between -pi/2 and pi/2")
        wanted = self.sun + 2 * self.planet
        if self.ring != wanted:
            raise SceneError(
                f"a ring of {self.ring} teeth does not fit a sun of {self.sun} and planets of "
                f"{self.planet}: around one axis it has {wanted}",
                path=("ring",),
            )
        if not self.azimuths:
            raise SceneError("a planetary stage needs at least one planet", path=("planets",))
        self._assembles()
        self._side_by_side()
        if self.ratio is not None and not isclose(self.ratio, self.speed_ratio, rel_tol=TYPED):
            raise SceneError(
                f"a ratio of {self.ratio:g} is not that of the teeth: "
                f"1 + {self.ring}/{self.sun} = {self.speed_ratio:.6g}",
                path=("ratio",),
            )

    @property
    def azimuths(self) -> tuple[float, ...]:
        """Azimuths of all planets, rad."""
        if isinstance(self.planets, int):
            return tuple(2 * pi * k / self.planets for k in range(self.planets))
        return tuple(self.planets)

    def _assembles(self) -> None:
        """Refuse planets that do not stand a whole number of teeth of sun and ring from the first."""
        around = self.sun + self.ring
        if isinstance(self.planets, int) and around % self.planets:
            fit = ", ".join(str(n) for n in range(2, 9) if around % n == 0)
            raise SceneError(
                f"{self.planets} planets at equal angles do not assemble: {self.sun} + {self.ring} "
                f"teeth are no multiple of {self.planets}; {fit or 'none from 2 to 8'} would",
                path=("planets",),
            )
        for k, azimuth in enumerate(self.azimuths[1:], 2):
            place = (azimuth - self.azimuths[0]) * around / (2 * pi)
            if abs(place - round(place)) > FITS:
                nearest = np.degrees(self.azimuths[0] + 2 * pi * round(place) / around)
                raise SceneError(
                    f"planet {k} does not assemble at {np.degrees(azimuth):.6g} deg; "
                    f"the nearest angle that does is {nearest:.6g} deg",
                    path=("planets",),
                )

    def _side_by_side(self) -> None:
        """Refuse neighbours whose tips overlap."""
        # a rack's addendum counts in normal modules
        tips = self.module * (self.planet + 2 * Rack().addendum * cos(self.helix))
        if self.spacing <= tips:
            raise SceneError(
                f"planets {np.degrees(self._closest):.4g} deg apart overlap: their axes are "
                f"{1e3 * self.spacing:.4g} mm from each other, their tips {1e3 * tips:.4g} mm across",
                path=("planets",),
            )

    @property
    def _closest(self) -> float:
        """Angle between the planets that are nearest to each other, rad."""
        turns = np.sort(np.array(self.azimuths) % (2 * pi))
        return float(np.diff([*turns, turns[0] + 2 * pi]).min())

    @property
    def spacing(self) -> float:
        """Distance between the axes of the planets that are nearest to each other, m; without end
        for a single planet.
        """
        if len(self.azimuths) < 2:
            return inf
        return 2 * self.pin_radius * sin(self._closest / 2)

    @property
    def speed_ratio(self) -> float:
        """Turns of the sun in one of the carrier."""
        return 1 + self.ring / self.sun

    @property
    def pin_radius(self) -> float:
        """Radius of the circle of pins, m."""
        return self.module * (self.sun + self.planet) / 2

    @property
    def base_radii(self) -> tuple[float, float, float]:
        """Base radii of sun, planet and ring, m."""
        sun, planet, ring = (
            self.module * teeth * cos(self.pressure_angle) / 2
            for teeth in (self.sun, self.planet, self.ring)
        )
        return sun, planet, ring

    @property
    def base_helix(self) -> float:
        """Helix angle on the base cylinders, rad."""
        return atan(tan(self.helix) * cos(self.pressure_angle))

    def mesh_frequency(self, sun: float) -> float:
        """Return the frequency of both meshes, Hz, at a speed of the sun, turns a second."""
        return self.ring * sun / self.speed_ratio
