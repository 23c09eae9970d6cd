"""Members of a planetary stage: rigid with six motions, locked in the plane, or parts of one's own.

A member without a diametral moment of inertia moves in x and z and turns about y alone; with one it
has all six motions.  A part, such as a reduced elastic body, brings others.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import pi
from typing import Protocol, Self

import numpy as np
import scipy.linalg as sla
from numpy.typing import ArrayLike

from solidgear.core import SolidgearError, System, rotation
from solidgear.core.system.matrices import not_negative, positive, spd
from solidgear.core.system.parts import Part, PlanarBody, RigidBody

#: x and z of six motions
ACROSS = [0, 2]
#: m, and relative: how far typed digits may be off
TYPED = 1e-6
MAY_BE_ZERO = ("turning", "diametral", "sun_mesh", "ring_mesh")


@dataclass(frozen=True, eq=False)
class CentralMember:
    """Sun, ring or carrier of a planetary stage.

    Attributes
    ----------
    mass, inertia : float
        kg, and kg m^2 about the axis; of a carrier without the planets.
    radius : float
        Of the base circle, of a carrier that of its pins, m.
    bearing : float or (6, 6) array_like
        Radial stiffness to ground, N/m, or stiffness of all six motions of its centre; without it the member
        floats.
    turning : float
        Torsional stiffness to ground, N m/rad, beside the bearing.
    diametral : float
        Moment of inertia about a diameter, kg m^2; without it the member is locked in the plane.
    part : Part, optional
        Instead of a rigid body, such as a reduced elastic one, with a port ``centre`` at its origin.
        It carries teeth or pins rigidly but for ports of their own, ``planet 1`` and so on.  See
        :meth:`of`.

    Examples
    --------
    >>> import solidgear as sg
    >>> sg.CentralMember(mass=0.4, inertia=5.8e-4, radius=38.71e-3, bearing=1e8).turning
    0.0
    """

    mass: float
    inertia: float
    radius: float
    bearing: ArrayLike = 0.0
    turning: float = 0.0
    diametral: float = 0.0
    part: Part | None = None

    @classmethod
    def of(cls, part: Part, radius: float, bearing: ArrayLike = 0.0, turning: float = 0.0) -> Self:
        """Return a member that is a part, with the mass of the rigid motions.

        Examples
        --------
        >>> import numpy as np
        >>> import solidgear as sg
        >>> disc = sg.RigidBody(np.diag([3.0, 3.0, 3.0, 0.02, 0.04, 0.02]))
        >>> member = sg.CentralMember.of(disc, 0.1)
        >>> round(member.mass, 9), round(member.inertia, 9), round(member.diametral, 9)
        (3.0, 0.04, 0.02)
        """
        _centred("a member", part)
        free = sla.null_space(part.strain) if len(part.strain) else np.eye(len(part.mass))
        unit = np.linalg.pinv(part.ports["centre"].rows @ free)
        inertia = np.diag(unit.T @ free.T @ part.mass @ free @ unit)
        return cls(
            float(inertia[0]),
            float(inertia[4]),
            radius,
            bearing,
            turning,
            float(inertia[3] + inertia[5]) / 2,
            part,
        )

    @property
    def support(self) -> np.ndarray:
        """(6, 6) stiffness of the centre to ground."""
        return _radial(self.bearing) + self.turning * np.diag([0, 0, 0, 0, 1.0, 0])


@dataclass(frozen=True, eq=False)
class Planet:
    """Planet on a pin of the carrier, in mesh with sun and ring.

    Attributes
    ----------
    mass, inertia : float
        kg, and kg m^2 about the pin.
    radius : float
        Of the base circle, m.
    pin : float or (6, 6) array_like
        Stiffness of pin and bearing, the same radially and tangentially, N/m; or of all six
        motions, x away from the sun, of which the spin is free.
    sun_mesh, ring_mesh : float
        Stiffness of the teeth along the line of action, N/m.
    azimuth : float
        Of the pin, right-handed about y from x, rad.
    diametral : float
        Moment of inertia about a diameter, kg m^2; without it the planet is locked in the plane.
    part : Part, optional
        Instead of a rigid body, in the planet's axes with a port ``centre`` at its origin.

    Examples
    --------
    >>> import solidgear as sg
    >>> one = sg.Planet(0.66, 1.5e-3, 50e-3, pin=1e8, sun_mesh=5e8, ring_mesh=5e8)
    >>> [round(planet.azimuth, 3) for planet in one.spaced(3)]
    [0.0, 2.094, 4.189]

    On a catalogue bearing, at the tooth forces that it carries forward:

    >>> from dataclasses import replace
    >>> from solidgear.bearings.catalogued import catalogued
    >>> from solidgear.bearings.catalogue import Catalogue
    >>> bearing = catalogued(Catalogue(designation="NJ 2204")).bearing
    >>> pin = bearing.tangent(bearing.motion([0, 0, -1500.0, 0, 0, 0]))
    >>> round(float(replace(one, pin=pin, diametral=9e-4).support[2, 2] / 1e8), 1)
    3.9
    """

    mass: float
    inertia: float
    radius: float
    pin: ArrayLike
    sun_mesh: float
    ring_mesh: float
    azimuth: float = 0.0
    diametral: float = 0.0
    part: Part | None = None

    def spaced(self, count: int) -> tuple[Planet, ...]:
        """Return so many copies, at equal angles from the first."""
        if count < 1:
            raise SolidgearError(f"{count} is not a number of planets; ask for 1 or more")
        return tuple(replace(self, azimuth=self.azimuth + 2 * pi * k / count) for k in range(count))

    @property
    def axes(self) -> np.ndarray:
        """(3, 3) axes of the planet as columns: away from the sun, along the axis, backwards."""
        return rotation(1, self.azimuth)[:3, :3]

    @property
    def support(self) -> np.ndarray:
        """(6, 6) stiffness of the centre to the carrier, in the planet's axes."""
        return _radial(self.pin)


class Members(Protocol):
    """Sun, ring, carrier and planets of a stage, with the system that they make."""

    @property
    def sun(self) -> CentralMember:
        """Sun."""

    @property
    def ring(self) -> CentralMember:
        """Ring."""

    @property
    def carrier(self) -> CentralMember:
        """Carrier, whose radius is that of its pins."""

    @property
    def planets(self) -> tuple[Planet, ...]:
        """Planets by their number."""

    @property
    def system(self) -> System:
        """Stage alone, with the names of its parts."""


def _radial(stiffness: ArrayLike) -> np.ndarray:
    """Return the stiffness (6, 6); a number acts on x and z."""
    matrix = np.asarray(stiffness, float)
    return matrix * np.diag([1.0, 0, 1.0, 0, 0, 0]) if matrix.ndim == 0 else matrix


def weights(member: CentralMember | Planet) -> np.ndarray:
    """Return mass and moments of inertia (6,) of the motions of a member's centre."""
    across, about = member.diametral, member.inertia
    return np.array([member.mass] * 3 + [across, about, across])


def body_of(member: CentralMember | Planet, points: Mapping[str, np.ndarray]) -> Part:
    """Return the part of a member, or a rigid body with ports at some points beside the centre."""
    if member.part is not None:
        return member.part
    all_points = {"centre": np.zeros(3), **points}
    masses = weights(member)
    if member.diametral:
        return RigidBody(np.diag(masses), all_points)
    return PlanarBody(np.diag(masses[[0, 2, 4]]), all_points)


def check_member(name: str, member: CentralMember | Planet) -> None:
    """Refuse numbers that are none of a gear on a bearing."""
    support_field = "bearing" if isinstance(member, CentralMember) else "pin"
    for field in fields(member):
        value = getattr(member, field.name)
        if field.name == "azimuth":
            if not np.isfinite(value):
                raise SolidgearError(f"azimuth of {name} is {value}; give a finite angle in rad")
        elif field.name == support_field:
            if np.ndim(value):
                spd(f"{support_field} of {name}", value, definite=False)
            else:
                not_negative(f"{support_field} of {name}", value)
        elif field.name != "part":
            check = not_negative if field.name in MAY_BE_ZERO else positive
            check(f"{field.name} of {name}", value)
    if 0 < member.diametral < (1 - TYPED) * member.inertia / 2:
        raise SolidgearError(
            f"diametral of {name} is {member.diametral:g} kg m^2; about a diameter no body has less "
            f"than half of what it has about its axis, {member.inertia:g}"
        )
    if member.part is not None:
        _centred(name, member.part)
    if isinstance(member, CentralMember):
        return
    pin = member.support
    if not np.linalg.eigvalsh(pin[np.ix_(ACROSS, ACROSS)])[0] > 0:
        raise SolidgearError(
            f"{name} is on no pin: its stiffness is {np.asarray(member.pin)} N/m; "
            "give that of pin and planet bearing"
        )
    if pin[4].any():
        raise SolidgearError(
            f"the pin of {name} resists its spin; row and column thy of its stiffness must be 0"
        )


def _centred(name: str, part: Part) -> None:
    centre = part.ports.get("centre")
    if centre is None:
        raise SolidgearError(
            f"the part of {name} needs a port 'centre'; it has {', '.join(part.ports)}"
        )
    if not (np.allclose(centre.point, 0, atol=TYPED) and np.allclose(centre.axes, np.eye(3))):
        raise SolidgearError(
            f"the port 'centre' of the part of {name} is at {np.round(centre.point, 6).tolist()} m "
            "or turned; place the part so that it is at the origin, in the axes of the stage"
        )
