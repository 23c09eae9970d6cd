r"""Compliance of teeth by slices of the face: plane strain across, an elastic layer along.

Under a load on one place of the face a tooth gives way beside it too, less and less.  Plane strain has
the motion c q under an even line load q; along the face it follows

    w - lambda^2 w'' = c q,    w' = 0 at both ends of the face

(a tooth bends as a cantilever plate, whose motion falls so; Jaramillo, Journal of Applied Mechanics 17,
1950, p. 67-72).  The answer at z to a unit force at z' is c times

    G = [cosh((b - |z - z'|) / lambda) + cosh((z + z') / lambda)] / (2 lambda sinh(b / lambda)),

which is symmetric, has the integral 1 and keeps an even load even.

**Near the force** a tooth moves as a half-plane does, and that reaches along the face hardly further than
below it; what bends and tilts the tooth reaches further.  So the first part acts within a slice, as the
local law of contact does, and the layer has the rest.  (In a layer that had both, the ends of the face
would carry a tenth too much of a tilted load: its ends are stiff against a slope, those of a tooth are
not.)  How long lambda is was measured on teeth in 3D, by the loads on the ends of tilted faces
(:data:`SPREAD`): it is no constant of nature, and shorter for a thin rim and a narrow face.

**Slices.**  A cell of a contact line is the load of a slice and not a point.  G has a kink at z = z', so
that points would make a slice soft or stiff by how many there are.  It is averaged in closed form over
both slices, for any places; the rows of all slices of a face add up to 1 over the width of a slice, as
the integral does.

**Helical teeth** bend in their normal section, where they are slimmer than in the transverse one and
where their forces lie: as those of a spur wheel of ``z / (cos^2 beta_b cos beta)`` teeth, which are
``b / cos beta`` long.  (Slices across the axis, whose motions and forces are turned to the normal, are a
third too stiff at 20 degrees of helix and three quarters at 30.)

Their axial part, ``sin beta_b``, bends the wheel out of its plane: a disc as thick as the face is wide,
free at its edge of radius a, which a force there moves at the angle phi from it by

    a^2 / (pi D) sum_(n >= 2) (2 n + 1 + nu) / (n^2 (n^2 - 1) (3 + nu) (1 - nu)) cos n phi,

D the stiffness of a plate (the solution ``A r^n + B r^(n + 2)`` of its equation with a free edge; shifts
and tilts, n = 0 and 1, are the body's).  A shaft that runs on beside the face as thick as the wheel keeps
it from that.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, pi, sin

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.gears.wheel import Wheel
from solidgear.teeth.compliance.plane import DEPTH, PlaneTeeth
from solidgear.teeth.contact.local import Elasticity

#: length lambda of the layer, modules: mean of thirty places on wheels in 3D, and twice the deviation
#: (``validation/tooth_spread.py``); the load on the end of a tilted face is 5 % off at most
SPREAD, SPREAD_OFF = 1.2, 0.3
#: stiffness by which slices are above teeth in 3D on a free disc, relative: of straight teeth, and
#: more for each sin^2 of the base helix; load on the end of the face by which they are below, for the
#: latter (``validation/helical_slices.py``: 0 to 30 degrees, faces of 4 to 20 modules)
TOO_STIFF, TOO_STIFF_BY_HELIX, TOO_EVEN_BY_HELIX = 0.04, 0.42, 0.4


@dataclass(frozen=True)
class Slices:
    """Compliance of the flanks of a wheel by slices of its face.

    Attributes
    ----------
    plane : PlaneTeeth
        The section of a spur wheel; the face of the wheel ends where the spread does.
    face_width : float
        Face that both wheels of the pair share, which is cut into slices, m.
    slices : int
    reading_depth : float, optional
        Depth below the flanks at which compliances are given, m; by default a quarter of a module.
    spread : float
        How far what bends a tooth reaches along the face, modules.

    Raises
    ------
    SolidgearError
        For a face without width, and no slice.

    Examples
    --------
    >>> from solidgear.core.gears.wheel import Wheel
    >>> teeth = PlaneTeeth(Wheel(23, 4e-3, face_width=20e-3), hold=25e-3)
    >>> slices = Slices(teeth, face_width=20e-3, slices=10)
    >>> z = slices.middles
    >>> matrix = slices.matrix(np.zeros(10, int), np.full(10, 46e-3), z)
    >>> even = matrix.sum(axis=1) * 2e-3  # under 1 N/mm
    >>> print(f"{even[0]:.3g} {even[5]:.3g}")
    2.5e-11 2.5e-11
    """

    plane: PlaneTeeth
    face_width: float
    slices: int
    reading_depth: float | None = None
    spread: float = SPREAD

    def __post_init__(self):
        if not self.plane.wheel.face_width > 0 or not self.face_width > 0 or self.slices < 1:
            raise SolidgearError("slices of teeth need a face width and at least one slice")
        if self.plane.wheel.helix_angle:
            raise SolidgearError("slices of helical teeth lie in their normal section")

    @property
    def depth(self) -> float:
        """Depth below the flanks at which compliances are given, m."""
        if self.reading_depth is not None:
            return self.reading_depth
        return DEPTH * self.plane.wheel.module

    @property
    def step(self) -> float:
        """Width of a slice, m."""
        return self.face_width / self.slices

    @property
    def middles(self) -> np.ndarray:
        """(slices,) middles of the slices from the middle of the common face, m."""
        return (np.arange(self.slices) + 0.5) * self.step - self.face_width / 2

    def matrix(self, tooth: np.ndarray, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the (n, n) normal motion at the depth below each place per normal force on each, m/N;
        parameters as of :class:`~solidgear.teeth.compliance.flank.FlankCompliance`.
        """
        across = self.plane.matrix(tooth, r, self.depth)
        near = self.plane.near(tooth, r, self.depth)
        # cells of several lines share slices
        places, number = np.unique(z, return_inverse=True)
        apart = np.abs(np.subtract.outer(places, places))
        within = np.maximum(self.step - apart, 0.0) / self.step**2
        along, within = (part[number[:, None], number] for part in (self.along(places), within))
        return (across - near) * along + near * within

    def along(self, z: np.ndarray) -> np.ndarray:
        """Return the (n, n) answers G of the layer between slices at places z, (n,) m, 1/m.

        Slices that stand out over an end of the face are moved within it.
        """
        width, length = self.plane.wheel.face_width, self.spread * self.plane.wheel.module
        z = np.clip(z, (self.step - width) / 2, (width - self.step) / 2)
        low, high = z - self.step / 2, z + self.step / 2

        def direct(s: np.ndarray) -> np.ndarray:
            return length**2 * _ratio(width - np.abs(s), width, length) + np.abs(s) / 2

        def reflected(s: np.ndarray) -> np.ndarray:
            return length**2 * _ratio(s, width, length)

        # both are second antiderivatives: four corners give the integral over two slices
        total = direct(np.subtract.outer(high, low)) - direct(np.subtract.outer(low, low))
        total += direct(np.subtract.outer(low, high)) - direct(np.subtract.outer(high, high))
        total += reflected(np.add.outer(high, high)) - reflected(np.add.outer(low, high))
        total += reflected(np.add.outer(low, low)) - reflected(np.add.outer(high, low))
        return total / self.step**2


@dataclass(frozen=True)
class HelicalSlices:
    """Compliance of the flanks of a helical wheel by slices of the spur wheel of its normal section.

    Examples
    --------
    >>> wheel = Wheel(29, 2.5e-3, helix_angle=0.35, face_width=25e-3)
    >>> normal_section(wheel).teeth
    34
    >>> teeth = HelicalSlices.of(wheel, face_width=25e-3, slices=10)
    >>> even = teeth.matrix(np.zeros(10, int), np.full(10, wheel.radius), teeth.slices.middles)
    >>> print(f"{even.sum(axis=1)[4] * 2.5e-3:.2g} m per N/m")
    2.5e-11 m per N/m
    """

    wheel: Wheel
    slices: Slices  #: of its normal section, along the teeth
    disc: bool = True  #: whether the wheel bends out of its plane

    @classmethod
    def of(
        cls,
        wheel: Wheel,
        face_width: float,
        slices: int,
        bore: float | None = None,
        elasticity: Elasticity | None = None,
        coarse: bool = False,
        depth: float | None = None,
        spread: float = SPREAD,
        disc: bool = True,
    ) -> HelicalSlices:
        """Return the slices of a wheel, straight or helical, over the face that it shares, m; the rim ends
        freely at a bore, m from the axis.
        """
        spur = normal_section(wheel)
        hold = None if bore is None else bore + spur.radius - wheel.radius
        steel = elasticity or Elasticity()
        plane = PlaneTeeth(spur, hold=hold, elasticity=steel, free=bore is not None)
        plane = plane.coarser if coarse else plane
        length = face_width / cos(wheel.helix_angle)
        return cls(wheel, Slices(plane, length, slices, depth, spread), disc)

    @property
    def depth(self) -> float:
        """Depth below the flanks at which compliances are given, m."""
        return self.slices.depth

    def matrix(self, tooth: np.ndarray, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the compliance between places
        (:meth:`solidgear.teeth.compliance.flank.FlankCompliance.matrix`).
        """
        height = self.slices.plane.wheel.radius - self.wheel.radius
        out = self.slices.matrix(tooth, r + height, z / cos(self.wheel.helix_angle))
        if self.disc and self.wheel.teeth > 0:
            angle = self.wheel.pitch_angle * np.subtract.outer(tooth, tooth)
            out += sin(self.wheel.base_helix) ** 2 * self.out_of_plane(angle)
        return out

    def out_of_plane(self, angle: np.ndarray) -> np.ndarray:
        """Return how far the edge of the wheel moves along the axis by an axial force on it, an angle
        away, m/N.
        """
        steel, wheel = self.slices.plane.elasticity, self.wheel
        nu, n = steel.poisson, np.arange(2, max(wheel.count // 2, 3))
        plate = steel.plane * wheel.face_width**3 / 12
        waves = (2 * n + 1 + nu) / (n**2 * (n**2 - 1.0) * (3 + nu) * (1 - nu))
        return wheel.radius**2 / (pi * plate) * (np.cos(angle[..., None] * n) @ waves)


def normal_section(wheel: Wheel) -> Wheel:
    """Return the spur wheel whose teeth are those of a helical one in its normal section, along them."""
    steep = cos(wheel.base_helix) ** 2 * cos(wheel.helix_angle)
    teeth = wheel.sign * round(wheel.count / steep)
    spur = replace(
        wheel, teeth=teeth, helix_angle=0.0, face_width=wheel.face_width / cos(wheel.helix_angle)
    )
    if wheel.tip_radius is None:
        return spur
    return replace(spur, tip_radius=spur.radius + wheel.tip_radius - wheel.radius)


def _ratio(s: np.ndarray, width: float, length: float) -> np.ndarray:
    """Return ``cosh(s / length) / (2 length sinh(width / length))`` for s up to the width, without
    large numbers.
    """
    whole = width / length
    grown = np.exp(np.abs(s) / length - whole) + np.exp(-np.abs(s) / length - whole)
    return grown / (2 * length * -np.expm1(-2 * whole))
