"""One assumed design of the reducer: wheel and sun on a shaft whose bearings give way, and the
planets around it.

Of the prototype the source tells tooth ratios, kinds of bearings and one designation.  Every other
number here is assumed, and drawn from a range.  Along y of the shaft, from the pitch apex on, stand
third bearing, wheel, pair and sun, so that the sun shifts against the wheel as the source has it; or,
overhung, pair, wheel, sun and third bearing.  Ring and carrier stand in rigid bearings, contact is
never lost, teeth have their mean stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import atan2, radians, sin

import numpy as np

import solidgear as sg
from solidgear.bearings.balance import Linear, Mounted
from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.catalogued import catalogued
from solidgear.bearings.equilibrium import Equilibrium, equilibrium
from solidgear.core.scene.file import scene_of
from solidgear.core.system.gear_mesh import line_of_action, mean_radius, mesh_point
from solidgear.trains.system.carrier_turn import CarrierTurn

PRESSURE = radians(20)
#: of the face of a bevel gear, of its cone distance
FACE = 0.3
#: m; width of wheel hub and sun, and of what the third bearing sits on beyond its middle
HUB, SPIGOT = 12e-3, 5e-3
ACROSS = [0, 2]
#: N/m and N m/rad of ring and carrier
STILL = 1e20


@dataclass(frozen=True)
class Design:
    """Assumed numbers, SI.

    Attributes
    ----------
    teeth : tuple of int
        Pinion, wheel, sun, planet, ring.
    torque : float
        On the pinion, N m.
    module : float
        Of the planetary stage.
    wheel : float
        Pitch diameter of the wheel.
    spiral : float
        Of the bevel teeth, rad.
    hand : str
    pair, third : str
        Designations.
    rows, preload : float
        Of the pair: distance, and force.
    beside_wheel, beside_sun, to_third : float
        Free shaft between pair and wheel, before the sun, and from the free end's wheel or sun to the
        middle of the third bearing.
    overhung : bool
    clearance : float
        Radial, of the third bearing.
    sun_mesh, ring_mesh, pin : float
        N/m.
    stiffening : float
        What the modulus of the shaft is multiplied by; much, and it is rigid.
    """

    teeth: tuple[int, ...] = (15, 45, 36, 24, 84)
    torque: float = 4.0
    module: float = 1.25e-3
    wheel: float = 65e-3
    spiral: float = radians(25)
    hand: str = "left"
    pair: str = "7203 B"
    third: str = "BK0810"
    rows: float = 20e-3
    preload: float = 200.0
    beside_wheel: float = 8e-3
    beside_sun: float = 8e-3
    to_third: float = 18e-3
    overhung: bool = False
    clearance: float = 5e-6
    sun_mesh: float = 2e8
    ring_mesh: float = 2.2e8
    pin: float = 1e8
    stiffening: float = 1.0

    @property
    def material(self) -> dict[str, float]:
        """Steel of the shafts."""
        return {"E": 210e9 * self.stiffening, "nu": 0.3, "density": 7850.0}

    @cached_property
    def planetary(self) -> sg.PlanetaryTeeth:
        """Teeth of the second stage."""
        return sg.PlanetaryTeeth(*self.teeth[2:], self.module, pressure_angle=PRESSURE)

    @property
    def sun_torque(self) -> float:
        """N m."""
        return self.torque * self.teeth[1] / self.teeth[0]

    @property
    def mean_force(self) -> float:
        """Of every mesh of the planets by statics, N."""
        return self.sun_torque / (3 * self.planetary.base_radii[0])

    @cached_property
    def stage(self) -> sg.PlanetaryStage:
        """The second stage, its sun afloat; masses have no part in statics."""
        sun, planet, ring = self.planetary.base_radii
        return sg.PlanetaryStage(
            sg.CentralMember(1.0, sun**2, sun),
            sg.CentralMember(1.0, ring**2, ring, bearing=STILL, turning=STILL),
            sg.CentralMember(1.0, 1e-3, self.planetary.pin_radius, bearing=STILL),
            sg.Planet(1.0, planet**2, planet, self.pin, self.sun_mesh, self.ring_mesh).spaced(3),
            PRESSURE,
        )

    @property
    def path(self) -> float:
        """Stiffness through one planet, N/m."""
        return float(self.stage.path_stiffness[0])

    @cached_property
    def wheel_load(self) -> np.ndarray:
        """(6,) force of the bevel teeth on the wheel at its lumped point, N and N m."""
        cone = atan2(self.teeth[1], self.teeth[0])
        face = FACE * self.wheel / 2 / sin(cone)
        action = line_of_action(cone, self.spiral, PRESSURE, self.hand, "left", "gear")
        point = mesh_point(mean_radius(self.wheel / 2, cone, face), member="gear")
        mesh = sg.MeshVector(action, point)
        return self.sun_torque / mesh.lever * mesh.vector

    @cached_property
    def _pair(self) -> dict[str, Catalogue]:
        """Both angular contact bearings, back to back."""
        given = {"designation": self.pair, "preload": f"{self.preload} N"}
        return {n: Catalogue(holds=way, **given) for n, way in (("first", "+y"), ("second", "-y"))}

    @cached_property
    def _third(self) -> Catalogue:
        return Catalogue(designation=self.third, clearance=self.clearance)

    @cached_property
    def places(self) -> dict[str, float]:
        """Middles of bearings, wheel and sun along the shaft, m."""
        half = self._pair["first"].width / 2
        if self.overhung:
            first = half
            wheel = first + self.rows + half + self.beside_wheel + HUB / 2
            sun = wheel + HUB + self.beside_sun
            third = sun + self.to_third
        else:
            third = SPIGOT
            wheel = third + self.to_third
            first = wheel + HUB / 2 + self.beside_wheel + half
            sun = first + self.rows + half + self.beside_sun + HUB / 2
        second = first + self.rows
        return {"first": first, "second": second, "wheel": wheel, "sun": sun, "third": third}

    @cached_property
    def scene(self) -> sg.Scene:
        """Shaft with wheel and sun; its bearings carry nothing yet."""
        at, held, spigot = self.places, self._pair["first"], self._third.bore
        wheel, sun = (at[name] - HUB / 2 for name in ("wheel", "sun"))
        segments = [
            ("left", wheel, held.bore if self.overhung else spigot),
            ("wheel", HUB, held.bore + 8e-3),
            ("between", sun - wheel - HUB, held.bore),
            ("sun", HUB, self.module * (self.teeth[2] - 2.5)),
        ]
        if self.overhung:
            segments.append(("right", self.to_third - HUB / 2 + SPIGOT, spigot))
        seats = {"first": held.width, "second": held.width, "third": 2 * SPIGOT}
        tables = {
            "material": self.material,
            "segment": [
                {"kind": "cylinder", "name": name, "length": length, "diameter": diameter}
                for name, length, diameter in segments
            ],
            "bearing": [
                {"name": n, "position": at[n], "seat_width": width, "stiffness": {"kxx": 1.0}}
                for n, width in seats.items()
            ],
            "port": [{"name": n, "position": at[n], "attach_to": n} for n in ("wheel", "sun")],
        }
        return scene_of(tables, "reducer")

    @cached_property
    def body(self) -> sg.Body:
        """The shaft as a beam."""
        return sg.build(self.scene, "timoshenko")

    def settled(self, third: bool) -> Equilibrium:
        """Shaft under the force of the bevel teeth, at the load of its bearings.

        To the shaft three equal planets are one spring, the same in all directions.
        """
        return self._on_three if third else self._on_two

    @cached_property
    def _on_two(self) -> Equilibrium:
        return self._settled(self._pair)

    @cached_property
    def _on_three(self) -> Equilibrium:
        return self._settled({**self._pair, "third": self._third})

    def _settled(self, bearings: dict[str, Catalogue]) -> Equilibrium:
        around = 1.5 * self.path
        mounted = [Mounted(name, catalogued(data).bearing) for name, data in bearings.items()]
        mounted.append(Mounted("sun", Linear(np.diag([around, 0.0, around, 0.0, 0.0, 0.0]))))
        loads = {"wheel": self.wheel_load, "sun": np.zeros(6), "third": np.zeros(6)}
        return equilibrium(self.body, mounted, loads)

    def modulation(self, third: bool) -> float:
        """Amplitude of every mesh force at the carrier's frequency, N."""
        return self.path * float(np.linalg.norm(self.settled(third).motion["sun"][ACROSS]))

    def flexibility(self, third: bool, model: str = "timoshenko") -> tuple[np.ndarray, np.ndarray]:
        """Shift (2,) of the sun under the bevel force and its flexibility (2, 2), the planets taken
        off, on the tangents of the bearings; the shaft ``rigid`` or by a model of the ladder.
        """
        system = self._on_springs(third, model)
        drive = np.array([0, 0, 0, 0, -self.sun_torque, 0])
        load = system.load({"shaft.wheel": self.wheel_load, "shaft.sun": drive})
        seen = system.motion("shaft.sun")[ACROSS]
        found = seen @ system.static(np.column_stack([load, seen.T]))
        return found[:, 0], found[:, 1:]

    def _on_springs(self, third: bool, model: str) -> sg.System:
        if model == "rigid":
            shaft = sg.RigidBody.of(self.body)
        else:
            shaft = sg.rubin(sg.build(self.scene, model))
        tangent = self.settled(third).tangent
        names = [*self._pair, *["third"] * third]
        springs = {n: sg.BearingSpring(f"shaft.{n}", tangent[n]) for n in names}
        return sg.System({"shaft": shaft}, springs)

    def closed_form(self, shift: np.ndarray, give: np.ndarray) -> float:
        """Amplitude of every mesh force, N: ``k_e |s|`` with ``(1 + 3/2 k_e C) s = e``."""
        return self.path * float(
            np.linalg.norm(np.linalg.solve(np.eye(2) + 1.5 * self.path * give, shift))
        )

    def turn(self, shift: np.ndarray, give: np.ndarray) -> CarrierTurn:
        """Mesh forces over a turn of the carrier."""
        support = np.linalg.inv(give)
        fixed = sg.FixedSupport((support + support.T) / 2, shift)
        return sg.carrier_turn(self.stage, self.sun_torque, {"sun": fixed})

    def settled_turn(self, third: bool) -> CarrierTurn:
        """The same where bearings are no springs: on their tangents, and from where the shaft
        settles on them.
        """
        _, give = self.flexibility(third)
        shift = self.settled(third).motion["sun"][ACROSS]
        return self.turn(shift + 1.5 * self.path * give @ shift, give)

    def foretold(self) -> float:
        """Amplitude of every mesh force with a third bearing, N, from the shaft on two.

        With s and u the motions of sun and third place and c flexibilities between them, the planets
        on, a bearing of stiffness q carries ``F = (u - clearance) / (c_33 + 1 / q)`` and leaves
        ``s - c_s3 F``.
        """
        on_two, on_three = self.settled(False), self.settled(True)
        sun, end = (on_two.motion[name][ACROSS] for name in ("sun", "third"))
        beyond = float(np.linalg.norm(end)) - self.clearance
        carried = float(np.linalg.norm(on_three.load["third"]))
        if beyond <= 0 or not carried:
            return self.path * float(np.linalg.norm(sun))
        pressed = float(np.linalg.norm(on_three.relative["third"][ACROSS])) - self.clearance
        system = self._on_springs(False, "timoshenko")
        seen = np.vstack([system.motion(f"shaft.{n}")[ACROSS] for n in ("sun", "third")])
        give = seen @ system.static(seen.T)
        held = np.linalg.solve(np.eye(2) + 1.5 * self.path * give[:2, :2], give[:2])
        give = give - 1.5 * self.path * give[:, :2] @ held
        own = np.trace(give[2:, 2:]) / 2 + pressed / carried
        force = beyond / own * end / np.linalg.norm(end)
        return self.path * float(np.linalg.norm(sun - give[:2, 2:] @ force))
