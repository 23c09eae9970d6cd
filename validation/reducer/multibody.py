"""A design as rigid bodies in contact: bevel pair, shaft of wheel and sun, three planets, carrier.

Shafts stand in their own axes, planets and carrier in those of the carrier, so that directions of
planet meshes are constant there and turn on the sun.  The ring stands still, the pinion turns
uniformly, the carrier is held by its torque.  Bearings are linear at their load; in ideal joints
everything turns only, and planets ride on their pins.  What turning axes add to the inertia is left
out, as in :mod:`solidgear.trains.system.planetary`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import atan2, cos, pi, sin, sqrt, tan

import numpy as np

import solidgear as sg
from solidgear.bearings.balance import Mounted
from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.catalogued import catalogued
from solidgear.bearings.equilibrium import Equilibrium, equilibrium
from solidgear.core.frames import rotation
from solidgear.core.scene.file import scene_of
from solidgear.core.system.gear_mesh import (
    cylindrical_mesh,
    line_of_action,
    mean_radius,
    mesh_point,
)
from solidgear.core.system.law import Gap
from validation.reducer.design import FACE, HUB, PRESSURE, Design
from validation.reducer.stepping import Bodies

#: kg/m^3, and of teeth in the bevel mesh at once
STEEL, BEVEL_TEETH = 7850.0, 1.5
#: orders of the mesh cycle
ORDERS = 3
#: assumed: kg m^2 at the output, m of half a backlash, loss of bearings and pins at the mesh frequency
OUTPUT, HALF_GAP, LOSS = 4e-3, 20e-6, 0.04
#: assumed input shaft, m: its pair, their distance, free shaft behind the pinion
INPUT_PAIR, INPUT_ROWS, INPUT_FREE = "7201 B", 25e-3, 5e-3
#: what contacts are called, in their order
CONTACTS = ("bevel", *(f"{mate} {k}" for mate in ("sun", "ring") for k in (1, 2, 3)))


def contact_ratio(teeth: sg.PlanetaryTeeth, mate: str) -> float:
    """Mean number of tooth pairs of a planet in contact with sun or ring."""
    module, base = teeth.module, dict(zip(("sun", "planet", "ring"), teeth.base_radii))

    def reach(member: str) -> float:
        tip = module * (getattr(teeth, member) / 2 + (-1 if member == "ring" else 1))
        return sqrt(tip**2 - base[member] ** 2)

    between = teeth.pin_radius * sin(PRESSURE)
    out, inner = reach("planet"), reach(mate)
    path = out + inner - between if mate == "sun" else out - inner + between
    return path / (pi * module * cos(PRESSURE))


def teeth_that_come_and_go(ratio: float, phase: float) -> np.ndarray:
    """(o,) how the number of pairs varies around its mean, by orders of the mesh."""
    n = np.arange(1, ORDERS + 1)
    size = 2 * np.sin(n * pi * (ratio % 1)) / (n * pi * ratio)
    return size * np.exp(1j * n * phase)


@dataclass(frozen=True)
class Reducer:
    """All of a design that moves.

    Attributes
    ----------
    design : Design
        Its shaft is taken as rigid, and its teeth by Hertz.
    bearings : int
        Of the shaft of wheel and sun: 2 or 3; 0 are ideal joints everywhere.
    rpm : float
        Of the pinion.
    runout : float
        Of the pinion: its teeth are off by so much once a turn, m.
    """

    given: Design
    bearings: int = 2
    rpm: float = 8000.0
    runout: float = 0.0

    @cached_property
    def cone(self) -> float:
        """Pitch angle of the wheel, rad."""
        return atan2(self.given.teeth[1], self.given.teeth[0])

    @cached_property
    def ratios(self) -> np.ndarray:
        """(7,) mean number of tooth pairs in contact."""
        sun, ring = (contact_ratio(self.given.planetary, mate) for mate in ("sun", "ring"))
        return np.array([BEVEL_TEETH, *[sun] * 3, *[ring] * 3])

    @cached_property
    def laws(self) -> list[Gap]:
        """Of one pair of teeth: bevel, sun and ring."""
        design = self.given
        sun, planet, ring = (radius * tan(PRESSURE) for radius in design.planetary.base_radii)
        middle = self.wheel_radius
        small = middle * design.teeth[0] / design.teeth[1]
        # spur gears on the back cones, normal to the teeth
        flanks = [
            radius / cos(angle) * sin(PRESSURE) / cos(design.spiral) ** 2
            for radius, angle in ((small, pi / 2 - self.cone), (middle, self.cone))
        ]
        return [
            Gap.impact(*flanks, HALF_GAP),
            Gap.impact(sun, planet, HALF_GAP),
            Gap.impact(planet, ring, HALF_GAP, internal=True),
        ]

    @cached_property
    def drive(self) -> np.ndarray:
        """(7,) stiffness of all teeth in contact, N/m^1.5."""
        bevel, sun, ring = (law.drive for law in self.laws)
        return self.ratios * [bevel, *[sun] * 3, *[ring] * 3]

    @cached_property
    def wheel_radius(self) -> float:
        """Of the wheel at the middle of its face, m."""
        face = FACE * self.given.wheel / 2 / sin(self.cone)
        return mean_radius(self.given.wheel / 2, self.cone, face)

    @cached_property
    def design(self) -> Design:
        """The design with the stiffness that these teeth have at their mean force."""
        force = self.given.mean_force
        sun, ring = (1.5 * self.drive[k] ** (2 / 3) * force ** (1 / 3) for k in (1, 4))
        return replace(self.given, sun_mesh=sun, ring_mesh=ring, stiffening=1e5)

    @cached_property
    def mean(self) -> np.ndarray:
        """(7,) forces by statics, N."""
        bevel = np.linalg.norm(self.design.wheel_load[:3])
        return np.array([bevel, *[self.design.mean_force] * 6])

    @cached_property
    def bevel_mesh(self) -> tuple[sg.MeshVector, sg.MeshVector]:
        """Mesh vectors of pinion and wheel, each in its own axes, of the force on the wheel."""
        design = self.design
        normal = line_of_action(self.cone, design.spiral, PRESSURE, design.hand, "left", "gear")
        back = np.array([-normal[1], normal[0], normal[2]])  # y_g = -x_p, x_g = y_p
        small = self.wheel_radius * design.teeth[0] / design.teeth[1]
        pinion = sg.MeshVector(back, mesh_point(small))
        return pinion, sg.MeshVector(normal, mesh_point(self.wheel_radius, member="gear"))

    @cached_property
    def _input_pair(self) -> dict[str, Catalogue]:
        given = {"designation": INPUT_PAIR, "preload": f"{self.design.preload} N"}
        return {n: Catalogue(holds=way, **given) for n, way in (("first", "+y"), ("second", "-y"))}

    @cached_property
    def input_shaft(self) -> sg.Body:
        """Pinion, overhung before its pair."""
        held = self._input_pair["first"]
        length = INPUT_FREE + held.width + INPUT_ROWS
        across = 2 * self.wheel_radius * self.design.teeth[0] / self.design.teeth[1]
        first = HUB + INPUT_FREE + held.width / 2
        tables = {
            "material": self.design.material,
            "segment": [
                {"kind": "cylinder", "name": "pinion", "length": HUB, "diameter": across},
                {"kind": "cylinder", "name": "shaft", "length": length, "diameter": held.bore},
            ],
            "bearing": [
                {"name": n, "position": y, "seat_width": held.width, "stiffness": {"kxx": 1.0}}
                for n, y in (("first", first), ("second", first + INPUT_ROWS))
            ],
            "port": [{"name": "pinion", "position": HUB / 2, "attach_to": "pinion"}],
        }
        return sg.build(scene_of(tables, "input shaft"), "timoshenko")

    @cached_property
    def input_settled(self) -> Equilibrium:
        """Input shaft under its bevel force, at the load of its bearings."""
        mounted = [Mounted(n, catalogued(one).bearing) for n, one in self._input_pair.items()]
        load = -self.mean[0] * self.bevel_mesh[0].vector
        return equilibrium(self.input_shaft, mounted, {"pinion": load})

    @cached_property
    def system(self) -> sg.System:
        """Bodies on their bearings; contacts are no links of it."""
        design, stage = self.design, self.stage
        links = {name: one for name, one in stage.links.items() if name.endswith("pin")}
        links["wheel disc"] = sg.PortInertia("shaft.wheel", disc(design.wheel / 2, HUB))
        held = {"input": self.input_settled, "shaft": design.settled(self.bearings == 3)}
        for part, settled in held.items():
            for name, tangent in settled.tangent.items():
                if name != "sun":
                    links[f"{part} {name}"] = sg.BearingSpring(f"{part}.{name}", tangent)
        parts = {
            "input": sg.RigidBody.of(self.input_shaft),
            "shaft": sg.RigidBody.of(design.body),
            **{name: one for name, one in stage.parts.items() if name not in ("sun", "ring")},
        }
        return sg.System(parts, links)

    @cached_property
    def stage(self) -> sg.PlanetaryStage:
        """Planets and carrier with their masses."""
        teeth, bare = self.design.planetary, self.design.stage
        radius = teeth.module * teeth.planet / 2
        planet = disc(radius, HUB)
        carrier = disc(teeth.pin_radius, HUB)
        planets = (replace(p, mass=planet[0, 0], inertia=planet[4, 4]) for p in bare.planets)
        spider = sg.CentralMember(carrier[0, 0], carrier[4, 4] + OUTPUT, teeth.pin_radius)
        return replace(bare, carrier=spider, planets=tuple(planets))

    @cached_property
    def basis(self) -> np.ndarray:
        """(N, n) motions that joints leave: all but the turning of the pinion and shifts of the
        carrier, or, of ideal ones, turning alone.
        """
        system = self.system
        whole = np.eye(system.size)
        carrier = system.place("carrier").stop - 1
        if self.bearings:
            drop = [system.place("input").start + 4, carrier - 2, carrier - 1]
            return np.delete(whole, drop, axis=1)
        turns = [system.place("shaft").start + 4]
        turns += [system.place(f"planet {k}").stop - 1 for k in (1, 2, 3)]
        along = whole[:, carrier].copy()
        pins = system.parts["carrier"].ports
        for k, planet in enumerate(self.stage.planets, 1):
            name = f"planet {k}"
            moved = rotation(1, -planet.azimuth) @ pins[name].rows[:, 2]
            at = system.place(name).start
            along[at : at + 2] = moved[[0, 2]]
        return np.column_stack([whole[:, turns], along])

    @cached_property
    def rows(self) -> np.ndarray:
        """(3, 7, N) stretch of all contacts: what stands still, and goes with cosine and sine."""
        system = self.system
        out = np.zeros((3, len(CONTACTS), system.size))
        pinion, wheel = self.bevel_mesh
        out[0, 0] = pinion.vector @ system.motion("input.pinion")
        out[0, 0] -= wheel.vector @ system.motion("shaft.wheel")
        sun = system.motion("shaft.sun")
        for k, planet in enumerate(self.stage.planets):
            meshes = self.stage.meshes(k)
            own = system.motion(f"planet {k + 1}")
            sizes = (self.stage.sun.radius, planet.radius, PRESSURE)
            at = [cylindrical_mesh(*sizes, planet.azimuth + turn)[0] for turn in (0.0, pi / 2)]
            out[0, 1 + k] = at[0].lever * sun[4] - meshes["sun"][1].vector @ own
            out[1:, 1 + k] = [mesh.normal @ sun[:3] for mesh in at]
            out[0, 4 + k] = -meshes["ring"][1].vector @ own
        return out

    @cached_property
    def load(self) -> np.ndarray:
        """(N,) torque of the output, and what bearings push at no motion of their tangents."""
        system, design = self.system, self.design
        torque = -design.sun_torque * design.planetary.speed_ratio
        out = system.load({"carrier.centre": np.array([0, 0, 0, 0, torque, 0])})
        held = {"input": self.input_settled, "shaft": design.settled(self.bearings == 3)}
        for part, settled in held.items():
            for name, tangent in settled.tangent.items():
                if name != "sun":
                    pushed = tangent @ settled.relative[name] - settled.load[name]
                    out += system.load({f"{part}.{name}": pushed})
        return out

    @cached_property
    def speed(self) -> float:
        """Of the carrier, rad/s."""
        design = self.given
        ratio = design.teeth[1] / design.teeth[0] * design.planetary.speed_ratio
        return self.rpm * 2 * pi / 60 / ratio

    @cached_property
    def orders(self) -> dict[str, int]:
        """Multiples of the carrier's frequency of what excites."""
        shaft = round(self.rpm * 2 * pi / 60 / self.speed)
        ring = self.given.teeth[4]
        return {
            "carrier": 1,
            "shaft": shaft,
            "planetary": ring,
            "bevel": shaft * self.given.teeth[0],
        }

    @cached_property
    def cycle(self) -> np.ndarray:
        """(o, 7) how teeth in contact vary, planets one after the other by their places."""
        teeth, out = self.given.planetary, np.zeros((ORDERS, len(CONTACTS)), complex)
        out[:, 0] = teeth_that_come_and_go(self.ratios[0], 0.0)
        for k, azimuth in enumerate(teeth.azimuths):
            out[:, 1 + k] = teeth_that_come_and_go(self.ratios[1], -teeth.sun * azimuth)
            out[:, 4 + k] = teeth_that_come_and_go(self.ratios[4], teeth.ring * azimuth)
        return out

    @cached_property
    def bodies(self) -> Bodies:
        """As they are stepped, alone."""
        p, system = self.basis, self.system
        stiffness = p.T @ system.stiffness @ p
        matched = self.orders["planetary"] * self.speed
        order = np.array([self.orders["bevel"], *[self.orders["planetary"]] * 6])
        error = np.array([self.runout, *[0.0] * 6], complex)
        load = np.zeros((3, 1, p.shape[1]))
        load[0, 0] = p.T @ self.load
        rows = self.rows @ p
        own = self.laws[0]
        return Bodies(
            (p.T @ system.mass @ p)[None],
            LOSS / matched * stiffness[None],
            stiffness[None],
            rows[:, None],
            load,
            replace(own, drive=1.0, damper=own.damper / own.drive),
            self.drive[None],
            order[None],
            self.cycle[:, None],
            np.full((1, len(CONTACTS)), self.orders["shaft"]),
            error[None],
            np.array([self.speed]),
            self.mean[None],
        )

    @cached_property
    def on_housing(self) -> np.ndarray:
        """(n,) force of all bearings on the housing along z, beyond that at rest, N."""
        system, out = self.system, np.zeros(self.system.size)
        for link in system.links.values():
            if isinstance(link, sg.BearingSpring) and link.to is None:
                out += (link.stiffness @ system.motion(link.at))[2]
        return out @ self.basis

    def moved(self, end: str, place: np.ndarray) -> np.ndarray:
        """(t, 6) motion of a port from coordinates (t, n)."""
        return place @ (self.system.motion(end) @ self.basis).T


def disc(radius: float, width: float) -> np.ndarray:
    """(6, 6) mass of a steel disc about its middle."""
    mass = STEEL * pi * radius**2 * width
    across, along = mass * (3 * radius**2 + width**2) / 12, mass * radius**2 / 2
    return np.diag([mass, mass, mass, across, along, across])
