"""The planetary stage alone, its sun on a spring whose seat is off, by two base frequencies and in
time: cross-check of one by the other.

In the carrier's axes the seat turns backwards, so that the sun is pushed at the carrier's frequency.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import pi

import numpy as np

import solidgear as sg
from solidgear.backlash.solver.model import Remainder, remainder
from solidgear.backlash.solver.two_tone import TwoTone
from solidgear.core.system.law import Gap
from validation.reducer.multibody import LOSS, Reducer, disc
from validation.reducer.stepping import Bodies

#: N/m and N m/rad of ring and carrier
HELD, TURNING = 1e9, 1e6


@dataclass(frozen=True)
class Stage:
    """Sun, planets and carrier of a reducer.

    Attributes
    ----------
    support : float
        Of the sun, N/m.
    shift : float
        Of its seat, m.
    share : float
        Of what teeth that come and go vary.
    """

    reducer: Reducer
    support: float = 5e7
    shift: float = 5e-6
    share: float = 1.0

    @cached_property
    def stage(self) -> sg.PlanetaryStage:
        """Bodies on their bearings."""
        teeth, planets = self.reducer.design.planetary, self.reducer.stage.planets
        sun, _, ring = teeth.base_radii
        own, around = disc(teeth.module * teeth.sun / 2, 40e-3), disc(ring, 12e-3)
        carrier = self.reducer.stage.carrier
        return sg.PlanetaryStage(
            sg.CentralMember(own[0, 0], own[4, 4], sun, self.support),
            sg.CentralMember(around[0, 0], around[4, 4], ring, HELD, TURNING),
            replace(carrier, bearing=HELD, turning=TURNING),
            planets,
            self.reducer.design.stage.pressure_angle,
        )

    @cached_property
    def meshes(self) -> dict[str, int]:
        """Links that are teeth, and which contact of the reducer each is."""
        return {
            f"planet {k} {mate} mesh": first + k
            for k in (1, 2, 3)
            for first, mate in ((0, "sun"), (3, "ring"))
        }

    def law(self, contact: int) -> Gap:
        """Of all teeth of a mesh."""
        one = self.reducer.laws[1 if contact < 4 else 2]
        ratio = self.reducer.ratios[contact]
        return replace(one, drive=one.drive * ratio, damper=one.damper * ratio)

    @cached_property
    def system(self) -> sg.System:
        """With laws on its teeth."""
        mean, links = self.reducer.design.mean_force, dict(self.stage.links)
        for name, contact in self.meshes.items():
            law = self.law(contact)
            links[name] = replace(links[name], law=law, stiffness=law.stiffness(mean))
        return sg.System(self.stage.parts, links)

    def _load(self, **forces: list[float]) -> np.ndarray:
        return self.system.load({f"{name}.centre": np.array(f) for name, f in forces.items()})

    @cached_property
    def torque(self) -> np.ndarray:
        """Load of the sun; ring and carrier hold against it."""
        return self._load(sun=[0, 0, 0, 0, self.reducer.design.sun_torque, 0])

    @cached_property
    def pushes(self) -> tuple[np.ndarray, np.ndarray]:
        """Loads of the seat that go with cosine and sine of the carrier's angle."""
        size = self.support * self.shift
        return self._load(sun=[size, 0, 0, 0, 0, 0]), self._load(sun=[0, 0, size, 0, 0, 0])

    def balance(self, counts: tuple[int, int] = (6, 3)) -> TwoTone:
        """By two frequencies."""
        own = self.reducer
        mesh = own.orders["planetary"] * own.speed
        linear = {name: LOSS for name in self.system.links if name not in self.meshes}
        known = {
            "loss": linear,
            "kind": "viscous",
            "matched_hz": mesh / (2 * pi),
            "load": self.torque,
        }
        cycles = {name: self.share * own.cycle[:, at] for name, at in self.meshes.items()}
        x, z = self.pushes
        fast: Remainder = remainder(self.system, cycles=cycles, **known)
        slow: Remainder = remainder(self.system, forces=[x - 1j * z], **known)
        return TwoTone(fast, slow, (mesh, own.speed), counts)

    @cached_property
    def bodies(self) -> Bodies:
        """In time."""
        own, system = self.reducer, self.system
        plain = {name: link for name, link in system.links.items() if name not in self.meshes}
        stiffness = sg.System(system.parts, plain).stiffness
        rows = np.zeros((3, 1, len(self.meshes), system.size))
        for row, name in enumerate(self.meshes):
            link = system.links[name]
            rows[0, 0, row] = link.stretch(*map(system.port, link.ends))[0]
        at = list(self.meshes.values())
        law = own.laws[1]
        none = np.zeros((1, len(at)))
        return Bodies(
            system.mass[None],
            LOSS / (own.orders["planetary"] * own.speed) * stiffness[None],
            stiffness[None],
            rows,
            np.array([self.torque, *self.pushes])[:, None],
            replace(law, drive=1.0, damper=law.damper / law.drive),
            own.drive[None, at],
            np.full((1, len(at)), own.orders["planetary"]),
            self.share * own.cycle[:, None, at],
            none,
            none + 0j,
            np.array([own.speed]),
            own.mean[None, at],
        )
