"""Planets over a turn of their carrier: mesh forces at an operating point, and natural frequencies.

To a stage, a train with bearings at the operating point is a stiffness and a place at
rest of sun and carrier: those of :func:`solidgear.trains.system.carrier_turn.carrier_turn`, condensed from
the rest of the train.  Weight of planets and ring and centrifugal forces act on the stage itself
(:mod:`solidgear.trains.load.planet_loads`).  At the position of the file the forces are those of
the train at rest.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from solidgear.core import System, pinned
from solidgear.core.plain import plain
from solidgear.core.system.system import port_forces
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.stages import StageAtWork
from solidgear.trains.file.planetary import Stage
from solidgear.trains.file.train import Train, with_carrier_turned
from solidgear.trains.load.planet_loads import centrifugal, weights
from solidgear.trains.load.state import OperatingState, with_settled_bearings
from solidgear.trains.system.carrier_turn import FixedSupport, carrier_turn

#: motions of a port that no free rotation of a shaft is a part of
HELD = [0, 1, 2, 3, 5]
#: of a turn of the carrier
POSITIONS = 72
#: positions at which frequencies of unequally spaced planets are solved
LOOKED_AT = 6
#: of the largest force
ROUNDING = 1e-9
#: planets at equal angles that make a stage the same all around
ALIKE = 3


@dataclass(frozen=True, eq=False)
class StageTurn:
    """Mesh forces of a stage over a turn of the carrier."""

    plain_names = ("angle", ("force", "force_by_planet"), "planets")

    stage: str
    angle: np.ndarray  #: (a,) of the carrier from its position in the file, the way it turns, rad
    #: (a, n) of each planet, with the sun, and equally with the ring, for it spins freely, N; less
    #: than zero would need teeth that pull
    force: np.ndarray

    @property
    def force_by_planet(self) -> np.ndarray:
        """(n, a) the same, a row each."""
        return self.force.T

    @property
    def planets(self) -> list[PlanetTurn]:
        """Forces planet by planet."""
        once = 2 * np.abs(np.fft.rfft(self.force, axis=0)[1]) / len(self.angle)
        once[once < ROUNDING * np.abs(self.force).max()] = 0.0
        return [
            PlanetTurn(
                planet=k,
                at=float(force[0]),
                mean=float(force.mean()),
                least=float(force.min()),
                most=float(force.max()),
                once=float(amplitude),
            )
            for k, (force, amplitude) in enumerate(zip(self.force_by_planet, once), 1)
        ]

    def as_dict(self) -> dict:
        """Return plain data in SI for JSON."""
        return plain(self)


@dataclass(frozen=True)
class PlanetTurn:
    """Mesh force of one planet: at the position of the file, over a turn of the carrier, and the
    amplitude once a turn, N.
    """

    planet: int
    at: float
    mean: float
    least: float
    most: float
    once: float


def stages_over_a_turn(train: Train) -> tuple[Stage, ...]:
    """Return stages whose forces are computed over a turn: none beside a housing, by which sun,
    carrier and ring move one another.
    """
    return train.stages if train.housing is None else ()


@pinned
def over_a_turn(
    assembly: Assembly, state: OperatingState, models: Mapping[str, str]
) -> tuple[StageTurn, ...]:
    """Return the mesh forces of all planetary stages that carry torque, over a turn of the carrier;
    bearings keep their stiffness at the state, which is that of these models.
    """
    meshing = state.assembly
    stages = [meshing.stages[stage.name] for stage in stages_over_a_turn(assembly.train)]
    carrying = [stage for stage in stages if state.mesh_forces[stage.stage.name]]
    if not carrying:
        return ()
    train_system = assembly.with_train(with_settled_bearings(meshing.train, state)).system(
        *models.values()
    )
    out = []
    for stage in carrying:
        outside = System(
            {name: part for name, part in train_system.parts.items() if name not in stage.bodies},
            {name: link for name, link in train_system.links.items() if name not in stage.links},
        )
        pushed = port_forces(System(state.system.parts, stage.links), state.coordinates)
        supports = {
            member: _support(stage, end, outside, state, pushed[end])
            for member, end in zip(("sun", "carrier"), stage.ends)
        }
        torque = state.mesh_forces[stage.stage.name] * abs(stage.stage.levers[0])
        solved = carrier_turn(
            stage.model,
            torque,
            supports,
            positions=POSITIONS,
            weights=weights(assembly, stage, state.point),
            carried=centrifugal(assembly, stage, state.point),
        )
        force = solved.sun_mesh
        if stage.turns != stage.way:  # it turns the other way than the stage is described
            force = np.roll(force[::-1], 1, axis=0)
        out.append(StageTurn(stage.stage.called, solved.angle, force))
    return tuple(out)


def _support(
    stage: StageAtWork, end: str, outside: System, state: OperatingState, pushed: np.ndarray
) -> FixedSupport:
    """Return a port as the rest of the train holds it, in the axes of the stage: the stiffness, and
    the place without the force (6,) of the planets.
    """
    rows = outside.motion(end)[HELD]
    compliance = rows @ outside.static(rows.T)
    held_rows = np.ix_(HELD, HELD)
    stiffness, shift = np.zeros((6, 6)), np.zeros(6)
    stiffness[held_rows] = np.linalg.inv((compliance + compliance.T) / 2)
    shift[HELD] = state.motion(end)[HELD] - compliance @ pushed[HELD]
    turn = np.kron(np.eye(2), stage.axes)
    return FixedSupport(turn.T @ stiffness @ turn, turn.T @ shift)


def frequencies_over_a_turn(assembly: Assembly, models: Mapping[str, str], names: list[str]) -> str:
    """Return a sentence on how far natural frequencies move over a turn of a carrier; empty without
    planets. Names are those of the modes by ascending frequency, the free ones first.
    """
    lines = []
    for stage in assembly.train.stages:
        count = len(stage.teeth.azimuths)
        if stage.table.planets is not None and count >= ALIKE:
            lines.append(
                f"{count} equal planets at equal angles: frequencies do not depend on the "
                f"position of the carrier ({stage.called})."
            )
            continue
        omegas = [
            assembly.with_train(
                with_carrier_turned(assembly.train, stage.called, 2 * np.pi * k / LOOKED_AT)
            )
            .system(*models.values())
            .elastic[0]
            for k in range(LOOKED_AT)
        ]
        free = assembly.system(*models.values()).free.shape[1]
        elastic = np.array(omegas)[:, : len(names) - free]
        moved = np.ptp(elastic, axis=0) / elastic[0]
        most = int(moved.argmax())
        lines.append(
            f"Over a turn of the carrier of the {stage.called} frequencies move by up to "
            f"{100 * moved[most]:.2g} % ({names[free + most]}), solved at {LOOKED_AT} positions; "
            "these are those at the position of the file."
        )
    return " ".join(lines)
