"""Planetary stages as systems of bodies and meshes.

Sun, ring, carrier and planets have six motions each, or are locked in the plane across their axis,
where they move in x and z and turn about y: that is the stage of Lin and Parker (1999).  Azimuths
are right-handed about y from x, in axes that turn with the carrier; in these a stage does not
change with time.  Axes of a planet: x points away from the sun, y along the axis.

A mesh gives along the line of action and passes through neither pin nor bearing.  With h =
{n, r x n}, n the direction of the tooth force and r the pitch point in the middle of the face, the
stretch is

    h_1 q_1 - h_2 q_2,

positive where teeth press while the sun drives about +y.  Teeth over a face width b are as two
springs of half the stiffness at b / sqrt(12) to both sides, which resist tilting as an even
distribution does, ``k b^2 cos^2 / 12``.  Tooth stiffnesses are means over a mesh period, contact is
never lost, and no teeth are there to be counted.

Modes are those of a carrier that stands still; :meth:`PlanetaryStage.turning_terms` adds the effect
of the turning.

Terms that a turning carrier adds to a planetary stage, in axes that turn with it.

With W the speed of the carrier, y its axis, and w the speed of a body about the body's axis, all in
space, rates of change in turning axes give for the shift u and the tilt t of a rigid body of mass
m, diametral and polar moments of inertia J and I

    m (u'' + 2 W y x u' - W^2 u),        J t'' + (2 J W - I w) y x t' + W (I w - J W) t,

u and t across the axis; motions along and about it are left alone.  Together

    M q'' + G q' + (K - C + P) q = 0.

P is the effect of the centrifugal force of planets, ``F = m W^2 R`` on each pin away from the axis
e: it turns with the carrier, where it has the energy ``-F e . (t x (u_p - u_c)) - F R |t x e|^2 /
2``, t the turn of the carrier. Lin and Parker (1999) have G and C in the plane and leave P out; it
is of the size of C, and without it a stage that is free to turn would run away under centrifugal
force. Pins are taken to carry all of that force; that it loads meshes, bends the ring, or shifts
frequencies by stretching loaded parts is left out.

In these axes a motion that stands still in space turns backwards at W: a frequency p in space is ``p
- W`` and ``p + W`` here.  Bearings that are not the same all around would change with time.

References
----------
Lin and Parker, Analytical characterization of the unique properties of planetary gear free
vibration, Journal of Vibration and Acoustics 121, 1999, p. 316-321.
Eritenel and Parker, Modal properties of three-dimensional helical planetary gears, Journal of Sound
and Vibration 325, 2009, p. 397-420.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sqrt
from typing import NamedTuple

import numpy as np
import scipy.linalg as sla

from solidgear.core import SolidgearError, System
from solidgear.core.frames import cross_matrix
from solidgear.core.reduction.superelement import PortMotion
from solidgear.core.system.gear_mesh import MeshVector, cylindrical_mesh
from solidgear.core.system.links import BearingSpring, Link, RowSpring
from solidgear.core.system.matrices import not_negative
from solidgear.core.system.parts import Part, Placed
from solidgear.trains.system.planetary_members import CentralMember, Planet, body_of, check_member
from solidgear.trains.system.planetary_modes import (
    CENTRAL,
    SAME,
    Phases,
    PlanetaryMode,
    named_modes,
)

#: relative to the distance of both axes, of two lines of action that are typed to be one
ONE_LINE = 1e-6
#: of its distance from the axis, how far a port may lie beside its planet: a small part of a tooth
ONE_PLACE = 1e-3
#: relative: a load that a pin does not resist
GIVES = 1e-9


AXIS = cross_matrix([0.0, 1.0, 0.0])
ROUND = np.diag([1.0, 0.0, 1.0])
#: of the highest frequency: a free rotation is a double zero, which rounding parts by its root
STILL = 1e-6


class TurningTerms(NamedTuple):
    """Matrices (N, N) of ``M q'' + G q' + (K - C + P) q`` on the coordinates of the stage's system."""

    #: gyroscopic, centrifugal, pull: G, skew-symmetric, kg/s and kg m^2/s; C and P, symmetric, N/m
    #: and N m/rad
    gyroscopic: np.ndarray
    centrifugal: np.ndarray
    pull: np.ndarray


class TurningMode(NamedTuple):
    """Mode of a stage whose carrier turns."""

    kind: str  #: as of :class:`solidgear.trains.system.planetary_modes.PlanetaryMode`
    frequency_hz: float  #: in axes that turn with the carrier
    growth: float  #: 1/s; 0 but for rounding where the stage is stable
    shape: np.ndarray  #: (N,) amplitudes of ``exp(i w t)``, of unit ``q* M q``


@dataclass(frozen=True, eq=False)
class PlanetaryStage:
    """Sun, ring, carrier and any number of planets, each of its own and at any angle.

    Base circles, pressure angle and pins are given separately, as Lin and Parker do; where
    they do not fit, :attr:`apart` says by how much.

    Attributes
    ----------
    sun, ring, carrier : CentralMember
    planets : tuple of Planet
    pressure_angle : float or (float, float)
        Transverse, at work in all meshes, or in those with the sun and those with the ring, rad.
    base_helix : float
        Helix angle on the base cylinders, rad; positive of a right-handed sun, whose planets and
        ring are left-handed.
    face_width : float
        Of all meshes, m; without it teeth press at the middle alone.

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

    Helical teeth need members that move along the axis and tilt:

    >>> from dataclasses import replace
    >>> held = np.diag([1e8, 5e7, 1e8, 1e5, 0.0, 1e5])
    >>> sun, carrier = (replace(m, bearing=held, diametral=m.inertia) for m in (sun, carrier))
    >>> ring = replace(ring, bearing=held, diametral=0.6 * ring.inertia)
    >>> pin = np.diag([1e8, 5e7, 1e8, 5e4, 0.0, 5e4])
    >>> planet = replace(planet, pin=pin, diametral=0.6 * planet.inertia)
    >>> helical = sg.PlanetaryStage(
    ...     sun, ring, carrier, planet.spaced(4), np.radians(24.6), base_helix=0.2, face_width=0.03
    ... )
    >>> [(m.name, m.multiplicity) for m in helical.modes()[1:3]]
    [('translational-tilting 1', 2), ('translational-tilting 2', 2)]

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
    base_helix: float = 0.0
    face_width: float = 0.0

    def __post_init__(self):
        if not self.planets:
            raise SolidgearError("a planetary stage needs at least one planet")
        not_negative("face_width", self.face_width)
        for name in CENTRAL:
            check_member(name, getattr(self, name))
        for name, planet in zip(self._names, self.planets):
            check_member(name, planet)
        for mesh in ("sun_mesh", "ring_mesh"):
            if not any(getattr(planet, mesh) for planet in self.planets):
                raise SolidgearError(
                    f"{mesh} is 0 N/m for every planet, so that nothing is in mesh there"
                )
        turns = np.array([planet.azimuth for planet in self.planets])
        between = (turns - turns[:, None]) % (2 * pi)
        between = np.minimum(between, 2 * pi - between) + pi * np.eye(len(turns))
        first, second = np.unravel_index(int(between.argmin()), between.shape)
        if between[first, second] < SAME:
            raise SolidgearError(
                f"{self._names[first]} and {self._names[second]} are at one angle; "
                "give each an azimuth of its own"
            )
        if np.shape(self.pressure_angle) not in ((), (2,)):
            raise SolidgearError(
                f"pressure_angle is {self.pressure_angle}; give one, or that of the meshes with the "
                "sun and that of those with the ring, in rad"
            )
        for k in range(len(self.planets)):
            self.meshes(k)
        for name in CENTRAL:
            self._refuse_ports_beside_planets(name)

    def _refuse_ports_beside_planets(self, name: str) -> None:
        """Refuse an elastic member whose ports are not where planets are."""
        part = getattr(self, name).part
        ports = {} if part is None or not len(part.strain) else part.ports
        if not any(planet in ports for planet in self._names):
            return
        for planet, body in zip(self._names, self.planets):
            if planet not in ports:
                raise SolidgearError(
                    f"the {name} has no port for {planet}, though it has one for others"
                )
            place = body.axes.T @ ports[planet].point
            if abs(place[2]) > ONE_PLACE * place[0]:
                raise SolidgearError(
                    f"the port of the {name} for {planet} lies {1e3 * abs(place[2]):.3g} mm beside "
                    f"it, for it is at {np.degrees(body.azimuth):.6g} deg; "
                    f"make the {name} for planets of these angles"
                )

    @property
    def _names(self) -> list[str]:
        return [f"planet {k}" for k in range(1, len(self.planets) + 1)]

    @property
    def angles(self) -> tuple[float, float]:
        """Pressure angles of the meshes with the sun and with the ring, rad."""
        pair = np.broadcast_to(np.asarray(self.pressure_angle, float), (2,))
        return float(pair[0]), float(pair[1])

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
        carrier that stand still, N/m; without the face width.

        Both tooth forces of a planet are equal, and the pin carries their sum, in the plane
        ``1 / k = 1 / k_sun + 1 / k_ring + (2 + 2 cos(a_sun + a_ring)) / k_pin``.
        """
        out = []
        for k, planet in enumerate(self.planets):
            moves = [0, 1, 2, 3, 5] if planet.diametral else [0, 2]
            carried = np.sum([inner.vector for _, inner in self.meshes(k).values()], axis=0)[moves]
            pin = planet.support[np.ix_(moves, moves)]
            size = np.sqrt(np.where(np.diag(pin) > 0, np.diag(pin), 1.0))
            unit, load = pin / np.outer(size, size), carried / size
            motion = np.linalg.lstsq(unit, load, rcond=GIVES)[0]
            flexibility = float(load @ motion)
            if np.abs(unit @ motion - load).max() > GIVES * np.abs(load).max():
                flexibility = np.inf
            with np.errstate(divide="ignore"):
                flexibility += 1 / np.float64(planet.sun_mesh) + 1 / np.float64(planet.ring_mesh)
            out.append(1 / flexibility)
        return np.array(out)

    def meshes(self, planet: int) -> dict[str, tuple[MeshVector, MeshVector]]:
        """Return mesh vectors of sun and ring, each in the member's axes, with those of a planet in
        the axes of the planet.
        """
        body = self.planets[planet]
        out = {}
        for name, angle in zip(("sun", "ring"), self.angles):
            internal = name == "ring"
            sizes = (getattr(self, name).radius, body.radius, angle)
            # planets have the other hand than the sun, and a ring that of its planets
            hand = -self.base_helix if internal else self.base_helix
            (outer, _), (_, inner) = (
                cylindrical_mesh(*sizes, azimuth, internal=internal, base_helix=hand)
                for azimuth in (body.azimuth, 0.0)
            )
            out[name] = (outer, inner)
        return out

    @cached_property
    def parts(self) -> Mapping[str, Part]:
        """Bodies by name: ``sun``, ``ring``, ``carrier`` with a port at each pin, ``planet 1`` ..."""
        pins = {}
        out: dict[str, Part] = {}
        for name, planet in zip(self._names, self.planets):
            pins[name] = planet.axes @ [self.carrier.radius, 0.0, 0.0]
            out[name] = Placed(body_of(planet, {}), planet.axes, pins[name])
        points = {"sun": {}, "ring": {}, "carrier": pins}
        return {n: body_of(getattr(self, n), points[n]) for n in CENTRAL} | out

    @cached_property
    def links(self) -> Mapping[str, Link]:
        """Bearings of central members, pins and meshes: ``sun bearing``, ``planet 1 pin``,
        ``planet 1 sun mesh`` ...
        """
        out: dict[str, Link] = {}
        for name in CENTRAL:
            support = getattr(self, name).support
            if support.any():
                out[f"{name} bearing"] = BearingSpring(f"{name}.centre", support)
        return out | self.joints(self._port)

    def joints(
        self, port: Callable[[str, str], tuple[str, PortMotion] | None], prefix: str = ""
    ) -> dict[str, Link]:
        """Return pins and meshes of all planets, on any ports.

        Parameters
        ----------
        port : callable
            Of ``sun``, ``ring`` or ``carrier`` and the name of a planet: the end that a link acts on
            there, and the port in the axes of the stage; None for the ground.
        before : str
            Put before the names of planets where they are parts of a larger system.
        """
        out: dict[str, Link] = {}
        for k, (name, planet) in enumerate(zip(self._names, self.planets)):
            centre = f"{prefix}{name}.centre"
            carrier = port("carrier", name)
            carrier_end = carrier and carrier[0]
            out[f"{prefix}{name} pin"] = BearingSpring(centre, planet.support, carrier_end)
            for mate, (outer, inner) in self.meshes(k).items():
                mate_port = port(mate, name)
                planet_rows = self._rows(inner, body_of(planet, {}).ports["centre"])
                stiffness = getattr(planet, f"{mate}_mesh") / len(planet_rows)
                spring = RowSpring(centre, -planet_rows, stiffness)
                if mate_port is not None:
                    rows = self._rows(outer, mate_port[1])
                    spring = RowSpring(mate_port[0], rows, stiffness, centre, planet_rows)
                out[f"{prefix}{name} {mate} mesh"] = spring
        return out

    def _port(self, member: str, planet: str) -> tuple[str, PortMotion]:
        """Return the port where a central member meets a planet: the port for that planet, or the
        centre.
        """
        ports = self.parts[member].ports
        name = planet if planet in ports else "centre"
        return f"{member}.{name}", ports[name]

    def _rows(self, mesh: MeshVector, port: PortMotion) -> np.ndarray:
        """Return the stretch (r, 6) by motions of a port that carries the teeth, at one place or
        two.
        """
        offset = self.face_width / sqrt(12)
        places = [-offset, offset] if offset else [0.0]
        normal = port.axes.T @ mesh.normal
        from_port = port.axes.T @ (mesh.point - port.point)
        axis = port.axes.T @ [0.0, 1.0, 0.0]
        return np.array([MeshVector(normal, from_port + y * axis).vector for y in places])

    @cached_property
    def system(self) -> System:
        """The stage alone."""
        return System(self.parts, self.links)

    def modes(self) -> list[PlanetaryMode]:
        """Return all modes, by ascending frequency, those of one frequency and kind together."""
        return named_modes(self)

    def turning_terms(self, carrier: float, ring: float = 0.0) -> TurningTerms:
        """Return the gyroscopic and centrifugal terms in axes that turn with the carrier, of rigid
        members.

        Parameters
        ----------
        carrier, ring : float
            Speeds about +y, turns a second.

        Raises
        ------
        SolidgearError
            For an elastic member, or a speed that is not finite.
        """
        for name, speed in (("carrier", carrier), ("ring", ring)):
            if not np.isfinite(speed):
                raise SolidgearError(
                    f"the {name} turns at {speed}; give a finite speed in turns a second"
                )
        bodies: dict[str, CentralMember | Planet] = {n: getattr(self, n) for n in CENTRAL}
        bodies |= {f"planet {k}": planet for k, planet in enumerate(self.planets, 1)}
        elastic = [
            n for n, body in bodies.items() if body.part is not None and len(body.part.strain)
        ]
        if elastic:
            raise SolidgearError(
                f"the {elastic[0]} is an elastic body; terms of a turning carrier are those of rigid ones"
            )
        system, about = self.system, 2 * np.pi * carrier
        gyroscopic, centrifugal, pull = np.zeros((3, system.size, system.size))
        spins = speeds(self, carrier, ring)
        carried = system.motion("carrier.centre")
        for name, body in bodies.items():
            shifts, tilts = np.vsplit(system.motion(f"{name}.centre"), 2)
            polar, across = body.inertia * spins[name], body.diametral * about
            gyroscopic += 2 * about * body.mass * shifts.T @ AXIS @ shifts
            gyroscopic += (2 * across - polar) * tilts.T @ AXIS @ tilts
            centrifugal += about**2 * body.mass * shifts.T @ ROUND @ shifts
            centrifugal += about * (across - polar) * tilts.T @ ROUND @ tilts
            if isinstance(body, Planet):
                relative, outward = body.axes @ shifts - carried[:3], body.axes[:, 0]
                force = body.mass * about**2 * self.carrier.radius
                turned = -force * relative.T @ cross_matrix(outward) @ carried[3:]
                lever = self.carrier.radius * (np.eye(3) - np.outer(outward, outward))
                pull += turned + turned.T - force * carried[3:].T @ lever @ carried[3:]
        return TurningTerms(gyroscopic, centrifugal, pull)

    def turning_modes(self, carrier: float, ring: float = 0.0) -> list[TurningMode]:
        """Return all modes in axes that turn with the carrier, by ascending frequency; as
        :meth:`turning_terms`.
        """
        terms, system = self.turning_terms(carrier, ring), self.system
        lower = np.linalg.cholesky(system.mass)

        def normal(matrix):
            half = sla.solve_triangular(lower, matrix, lower=True)
            return sla.solve_triangular(lower, half.T, lower=True).T

        stiff = normal(system.stiffness - terms.centrifugal + terms.pull)
        scale = np.sqrt(np.linalg.norm(stiff, 2))
        zero, unit = np.zeros_like(stiff), np.eye(len(stiff))
        state = np.block([[zero, unit], [-stiff / scale**2, -normal(terms.gyroscopic) / scale]])
        value, vector = np.linalg.eig(state)
        # eigenvalues come in fours or in pairs of two signs: one of each is kept
        value = np.where(np.abs(value) < STILL, 0.0, value)
        still = np.abs(value.imag) < STILL
        resting = np.flatnonzero(still)[np.argsort(-value[still].real, kind="stable")]
        selected = np.concatenate(
            [resting[: len(resting) // 2], np.flatnonzero(value.imag >= STILL)]
        )
        selected = selected[np.argsort(np.abs(value[selected].imag), kind="stable")]
        shapes = vector[: len(stiff), selected]
        shapes = sla.solve_triangular(lower.T, shapes / np.linalg.norm(shapes, axis=0), lower=False)
        eigenvalues = scale * value[selected]
        kinds = Phases(self).kinds(shapes)
        return [
            TurningMode(
                kind, float(abs(eigenvalue.imag)) / (2 * np.pi), float(eigenvalue.real), shape
            )
            for kind, eigenvalue, shape in zip(kinds, eigenvalues, shapes.T)
        ]


def speeds(stage: PlanetaryStage, carrier: float, ring: float) -> dict[str, float]:
    """Return the speed of every body about the axis in space, rad/s, from those of carrier and
    ring.
    """
    relative = (ring - carrier) * stage.ring.radius
    out = {"sun": carrier - relative / stage.sun.radius, "ring": ring, "carrier": carrier}
    for k, planet in enumerate(stage.planets, 1):
        out[f"planet {k}"] = carrier + relative / planet.radius
    return {name: 2 * np.pi * speed for name, speed in out.items()}
