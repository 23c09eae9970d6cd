r"""Planetary stages as systems of bodies and meshes, in the plane across their axis.

Sun, ring, carrier and planets move in x and z and turn about y (Lin and Parker 1999).  Azimuths are
right-handed about y from x, in axes that turn with the carrier; in these a stage does not change
with time.  Coordinates of a planet are its own x, which points away from the sun, z, and thy.

A mesh gives along its line of action and passes through neither pin nor bearing.  With n the
direction of the tooth force and levers r of the base circles, its stretch is

    (n u_1 + r_1 th_1) - (n u_2 + r_2 th_2),

positive where teeth press while the sun drives about +y.  Tooth stiffnesses are means over a mesh
period, contact is never lost, and no teeth are there to be counted.

Turning axes add ``W G q' - W^2 C q`` to the equations of motion at carrier speed W, of the order of
W over a natural frequency.  They are left out: modes are those of a carrier that stands still.

References
----------
Lin and Parker, Analytical characterization of the unique properties of planetary gear free
vibration, Journal of Vibration and Acoustics 121, 1999, p. 316-321.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import cos, isclose, pi
from typing import NamedTuple

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.frames import rotation
from solidgear.system.gear_mesh import MeshVector, spur_mesh
from solidgear.system.links import BearingSpring, Link, RowSpring, mesh_spring
from solidgear.system.matrices import not_negative, positive
from solidgear.system.parts import Part, Placed, PlanarBody
from solidgear.system.system import System

CENTRAL = ("sun", "ring", "carrier")
#: share of a mode's kinetic energy below which a motion is rounding
NO_SHARE = 1e-9
#: relative; natural frequencies of a symmetric stage that are one differ by rounding alone
SAME = 1e-9
#: relative to the distance of both axes, of two lines of action that are typed to be one
ONE_LINE = 1e-6


@dataclass(frozen=True)
class CentralMember:
    """Sun, ring or carrier of a planetary stage.

    Attributes
    ----------
    mass, inertia : float
        kg, and kg m^2 about the axis; of a carrier without the planets.
    radius : float
        Of the base circle, of a carrier that of its pins, m.
    bearing : float
        Radial stiffness to ground, N/m; one without floats.
    turning : float
        Torsional stiffness to ground, N m/rad.

    Examples
    --------
    >>> import solidgear as sg
    >>> sg.CentralMember(mass=0.4, inertia=5.8e-4, radius=38.71e-3, bearing=1e8).turning
    0.0
    """

    mass: float
    inertia: float
    radius: float
    bearing: float = 0.0
    turning: float = 0.0


@dataclass(frozen=True)
class Planet:
    """Planet on a pin of the carrier, in mesh with sun and ring.

    Attributes
    ----------
    mass, inertia : float
        kg, and kg m^2 about the pin.
    radius : float
        Of the base circle, m.
    pin : float
        Stiffness of pin and bearing, the same radially and tangentially, N/m.
    sun_mesh, ring_mesh : float
        Stiffness of the teeth along the line of action, N/m.
    azimuth : float
        Of the pin, right-handed about y from x, rad.

    Examples
    --------
    >>> import solidgear as sg
    >>> one = sg.Planet(0.66, 1.5e-3, 50e-3, pin=1e8, sun_mesh=5e8, ring_mesh=5e8)
    >>> [round(planet.azimuth, 3) for planet in one.spaced(3)]
    [0.0, 2.094, 4.189]
    """

    mass: float
    inertia: float
    radius: float
    pin: float
    sun_mesh: float
    ring_mesh: float
    azimuth: float = 0.0

    def spaced(self, count: int) -> tuple[Planet, ...]:
        """So many of it, at equal angles from its own on."""
        if count < 1:
            raise SolidgearError(f"{count} is not a number of planets; ask for 1 or more")
        return tuple(replace(self, azimuth=self.azimuth + 2 * pi * k / count) for k in range(count))


class PlanetaryMode(NamedTuple):
    """Modes of a stage at one natural frequency.

    Attributes
    ----------
    kind : str
        ``rotational`` (central members turn only), ``translational`` (they shift only), ``planet``
        (they rest), or ``mixed``, which a stage of equal planets at equal angles has none of.
    number : int
        Among those of its kind, from 1.
    multiplicity : int
        Of equal frequencies; 2 of ``translational``, N - 3 of ``planet`` in a stage of N equal
        planets at equal angles.
    shapes : (n, multiplicity) ndarray
        On the coordinates of the stage's system, mass-normalised.
    """

    kind: str
    number: int
    frequency_hz: float
    multiplicity: int
    shapes: np.ndarray

    @property
    def name(self) -> str:
        """Kind and number."""
        return f"{self.kind} {self.number}"


@dataclass(frozen=True, eq=False)
class PlanetaryStage:
    """Sun, ring, carrier and any number of planets, each of its own and at any angle.

    Base circles, pressure angle and pins are told apart from each other, as Lin and Parker do; where
    they do not fit, :attr:`apart` says by how much.

    Attributes
    ----------
    sun, ring, carrier : CentralMember
    planets : tuple of Planet
    pressure_angle : float or (float, float)
        At work in all meshes, or in those with the sun and those with the ring, rad.

    Raises
    ------
    SolidgearError
        For planets on no pins, two at one angle, or numbers out of range.

    Examples
    --------
    >>> import numpy as np
    >>> import solidgear as sg
    >>> sun = sg.CentralMember(0.4, 0.39 * 38.71e-3**2, 38.71e-3, bearing=1e8)
    >>> ring = sg.CentralMember(2.35, 3.0 * 0.1375**2, 0.1375, 1e8, turning=1e9 * 0.1375**2)
    >>> carrier = sg.CentralMember(5.43, 6.29 * 88.4e-3**2, 88.4e-3, bearing=1e8)
    >>> planet = sg.Planet(0.66, 0.61 * 50.175e-3**2, 50.175e-3, 1e8, 5e8, 5e8)
    >>> stage = sg.PlanetaryStage(sun, ring, carrier, planet.spaced(4), np.radians(24.6))
    >>> {m.name: (round(m.frequency_hz), m.multiplicity) for m in stage.modes()[:4]}
    {'rotational 1': (0, 1), 'translational 1': (727, 2), 'translational 2': (1091, 2), 'rotational 2': (1537, 1)}

    Further parts and links join it in a system of one's own:

    >>> shaft = sg.torsion_spring("carrier.centre", 1e5, "load")
    >>> whole = sg.System({**stage.parts, "load": sg.Inertia(0.5)}, {**stage.links, "out": shaft})
    >>> whole.size
    22
    """

    sun: CentralMember
    ring: CentralMember
    carrier: CentralMember
    planets: tuple[Planet, ...]
    pressure_angle: float | tuple[float, float]

    def __post_init__(self):
        if not self.planets:
            raise SolidgearError("a planetary stage needs at least one planet")
        for name in CENTRAL:
            self._checked(name, getattr(self, name), ("bearing", "turning"))
        for name, planet in zip(self._names, self.planets):
            self._checked(name, planet, ("pin", "sun_mesh", "ring_mesh", "azimuth"))
            if not planet.pin > 0:
                raise SolidgearError(
                    f"{name} is on no pin: its stiffness is {planet.pin} N/m; "
                    "give that of pin and planet bearing"
                )
        for mesh in ("sun_mesh", "ring_mesh"):
            if not any(getattr(planet, mesh) for planet in self.planets):
                raise SolidgearError(f"{mesh} is 0 N/m of every planet; nothing is in mesh there")
        turns = np.array([planet.azimuth for planet in self.planets])
        between = (turns - turns[:, None]) % (2 * pi)
        between = np.minimum(between, 2 * pi - between) + pi * np.eye(len(turns))
        one, other = np.unravel_index(int(between.argmin()), between.shape)
        if between[one, other] < SAME:
            raise SolidgearError(
                f"{self._names[one]} and {self._names[other]} are at one angle; "
                "give each an azimuth of its own"
            )
        if np.shape(self.pressure_angle) not in ((), (2,)):
            raise SolidgearError(
                f"pressure_angle is {self.pressure_angle}; give one, or that of the meshes with the "
                "sun and that of those with the ring, in rad"
            )
        for k in range(len(self.planets)):
            self.meshes(k)

    def _checked(self, name: str, member, may_be_zero: tuple[str, ...]) -> None:
        for one in fields(member):
            value = getattr(member, one.name)
            if one.name == "azimuth":
                if not np.isfinite(value):
                    raise SolidgearError(
                        f"azimuth of {name} is {value}; give a finite angle in rad"
                    )
                continue
            check = not_negative if one.name in may_be_zero else positive
            check(f"{one.name} of {name}", value)

    @property
    def _names(self) -> list[str]:
        return [f"planet {k}" for k in range(1, len(self.planets) + 1)]

    @property
    def angles(self) -> tuple[float, float]:
        """Pressure angles of the meshes with the sun and with the ring, rad."""
        both = np.broadcast_to(np.asarray(self.pressure_angle, float), (2,))
        return float(both[0]), float(both[1])

    @property
    def apart(self) -> tuple[float, float]:
        """Distance of the two lines of action in each mesh with the sun and with the ring, m.

        Gears whose base circles, pressure angle and axes fit have one; otherwise tooth forces make
        a torque out of nothing.  The data of Lin and Parker (1999) are 8.5 and 7.0 mm off.
        """
        sun, ring = self.angles
        pins = self.carrier.radius
        with_sun = [self.sun.radius + p.radius - pins * cos(sun) for p in self.planets]
        with_ring = [self.ring.radius - p.radius - pins * cos(ring) for p in self.planets]
        return max(with_sun, key=abs), max(with_ring, key=abs)

    @property
    def path_stiffness(self) -> np.ndarray:
        """(N,) stiffness along the line of action from the sun through each planet to ring and
        carrier that stand still, N/m.

        Both tooth forces of a planet are equal, and its pin carries their sum:
        ``1 / k = 1 / k_sun + 1 / k_ring + (2 + 2 cos(a_sun + a_ring)) / k_pin``.
        """
        pins = 2 + 2 * cos(sum(self.angles))
        with np.errstate(divide="ignore"):
            give = [
                1 / np.float64(p.sun_mesh) + 1 / np.float64(p.ring_mesh) + pins / p.pin
                for p in self.planets
            ]
        return 1 / np.array(give)

    def meshes(self, planet: int) -> dict[str, tuple[MeshVector, MeshVector]]:
        """Mesh vectors of sun and ring, each in its axes, with those of a planet in the planet's."""
        one = self.planets[planet]
        out = {}
        for name, angle in zip(("sun", "ring"), self.angles):
            sizes = (getattr(self, name).radius, one.radius, angle)
            internal = name == "ring"
            outer, _ = spur_mesh(*sizes, one.azimuth, internal=internal)
            _, inner = spur_mesh(*sizes, internal=internal)
            out[name] = (outer, inner)
        return out

    @cached_property
    def parts(self) -> Mapping[str, Part]:
        """Bodies by name: ``sun``, ``ring``, ``carrier`` with a port at each pin, ``planet 1`` ..."""
        pins = {}
        out: dict[str, Part] = {}
        for name, planet in zip(self._names, self.planets):
            turn = rotation(1, planet.azimuth)[:3, :3]
            pins[name] = turn @ [self.carrier.radius, 0.0, 0.0]
            out[name] = Placed(_body(planet), turn, pins[name])
        points = {"centre": (0.0, 0.0, 0.0)}
        central: dict[str, Part] = {
            "sun": _body(self.sun),
            "ring": _body(self.ring),
            "carrier": _body(self.carrier, points | pins),
        }
        return central | out

    @cached_property
    def links(self) -> Mapping[str, Link]:
        """Bearings of central members, pins and meshes: ``sun bearing``, ``planet 1 pin``,
        ``planet 1 sun mesh`` ...
        """
        out: dict[str, Link] = {}
        for name in CENTRAL:
            one = getattr(self, name)
            if one.bearing or one.turning:
                spring = np.diag([one.bearing, 0.0, one.bearing, 0.0, one.turning, 0.0])
                out[f"{name} bearing"] = BearingSpring(f"{name}.centre", spring)
        for k, (name, planet) in enumerate(zip(self._names, self.planets)):
            out[f"{name} pin"] = RowSpring(
                name, OUTWARD, planet.pin, f"carrier.{name}", OUTWARD @ rotation(1, -planet.azimuth)
            )
            for mate, (outer, inner) in self.meshes(k).items():
                stiffness = getattr(planet, f"{mate}_mesh")
                at = f"{mate}.centre"
                out[f"{name} {mate} mesh"] = mesh_spring(at, outer, name, inner, stiffness)
        return out

    @cached_property
    def system(self) -> System:
        """The stage alone."""
        return System(self.parts, self.links)

    def modes(self) -> list[PlanetaryMode]:
        """All modes, by ascending frequency, those of one frequency and kind together."""
        found = self.system.modes()
        kinds = [self._kind(shape) for shape in found.shapes.T]
        out: list[PlanetaryMode] = []
        for hz, kind, shape in zip(found.frequency_hz, kinds, found.shapes.T):
            last = next((mode for mode in reversed(out) if mode.kind == kind), None)
            if last and isclose(hz, last.frequency_hz, rel_tol=SAME):
                both = np.column_stack([last.shapes, shape])
                joined = last._replace(multiplicity=last.multiplicity + 1, shapes=both)
                out[out.index(last)] = joined
                continue
            number = 1 + sum(mode.kind == kind for mode in out)
            out.append(PlanetaryMode(kind, number, float(hz), 1, shape[:, None]))
        return out

    def _kind(self, shape: np.ndarray) -> str:
        """Kind of a mode by the kinetic energy of central members that shift and that turn."""
        energy = np.diag(self.system.mass) * shape**2
        own = np.array([energy[self.system.place(name)] for name in CENTRAL])
        shifts, turns = own[:, :2].sum() > NO_SHARE, own[:, 2].sum() > NO_SHARE
        if shifts and turns:
            return "mixed"
        if shifts:
            return "translational"
        return "rotational" if turns else "planet"


#: motions of a planet away from the sun and forward, of x y z thx thy thz in its own axes
OUTWARD = np.array([[1.0, 0, 0, 0, 0, 0], [0, 0, -1.0, 0, 0, 0]])


def _body(member: CentralMember | Planet, points: Mapping | None = None) -> PlanarBody:
    mass = np.diag([member.mass, member.mass, member.inertia])
    return PlanarBody(mass) if points is None else PlanarBody(mass, points)
