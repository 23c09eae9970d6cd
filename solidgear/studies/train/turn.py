"""Planets over a turn of their carrier: mesh forces at an operating point, and natural frequencies.

What a train with its bearings at the operating point is to a stage are a stiffness and a place at
rest of sun and carrier: those of :func:`solidgear.system.carrier_turn.carrier_turn`, condensed from
the rest of the train.  Weight of planets and ring and centrifugal forces act on the stage itself
(:mod:`solidgear.studies.train.planet_loads`).  At the position of the file its forces are those of
the train at rest.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from solidgear.machine.threads import pinned
from solidgear.scene.planetary import Stage, with_carrier_turned
from solidgear.scene.train import Train
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.operation import OperatingState, settled
from solidgear.studies.train.planet_loads import centrifugal, weights
from solidgear.studies.train.stages import StageAtWork
from solidgear.system.carrier_turn import FixedSupport, carrier_turn
from solidgear.system.port_forces import port_forces
from solidgear.system.system import System

#: motions of a port that no free rotation of a shaft is a part of
HELD = [0, 1, 2, 3, 5]
#: of a turn of the carrier
POSITIONS = 72
#: positions at which frequencies of planets that are not alike all around are solved
LOOKED_AT = 6
#: of the largest force
ROUNDING = 1e-9
#: planets at equal angles that make a stage the same all around
ALIKE = 3


@dataclass(frozen=True, eq=False)
class StageTurn:
    """Mesh forces of a stage over a turn of its carrier."""

    stage: str
    angle: np.ndarray  #: (a,) of the carrier from its position in the file, the way it turns, rad
    #: (a, n) of each planet, with the sun and, for it spins freely, with the ring alike, N; less
    #: than zero would need teeth that pull
    force: np.ndarray

    @property
    def planets(self) -> list[PlanetTurn]:
        """Planet by planet."""
        once = 2 * np.abs(np.fft.rfft(self.force, axis=0)[1]) / len(self.angle)
        once[once < ROUNDING * np.abs(self.force).max()] = 0.0
        return [
            PlanetTurn(k, *map(float, (own[0], own.mean(), own.min(), own.max(), amplitude)))
            for k, (own, amplitude) in enumerate(zip(self.force.T, once), 1)
        ]

    def as_dict(self) -> dict:
        """Plain data in SI that JSON can hold."""
        return {"angle": self.angle.tolist(), "force": self.force.T.tolist()} | {
            "planets": [vars(one) for one in self.planets]
        }


@dataclass(frozen=True)
class PlanetTurn:
    """Mesh force of one planet: at the position of the file, over a turn of the carrier, and its
    amplitude once a turn, N.
    """

    planet: int
    at: float
    mean: float
    least: float
    most: float
    once: float


def told_over_a_turn(train: Train) -> tuple[Stage, ...]:
    """Stages whose forces are told over a turn: none beside a housing, by which sun, carrier and ring
    move one another.
    """
    return train.stages if train.housing is None else ()


@pinned
def over_a_turn(
    workshop: Workshop, state: OperatingState, models: Mapping[str, str]
) -> tuple[StageTurn, ...]:
    """Mesh forces of all planetary stages that carry torque, over a turn of the carrier.

    Parameters
    ----------
    state : OperatingState
        Of these models; bearings keep the stiffness that they have there.
    """
    flank = workshop.on_flank(state.point.coast)
    told = [flank.stages[stage.name] for stage in told_over_a_turn(workshop.train)]
    carrying = [one for one in told if state.mesh_forces[one.stage.name]]
    if not carrying:
        return ()
    whole = workshop.with_train(settled(workshop.train, state)).system(*models.values())
    out = []
    for one in carrying:
        rest = System(
            {name: part for name, part in whole.parts.items() if name not in one.bodies},
            {name: link for name, link in whole.links.items() if name not in one.links},
        )
        pushed = port_forces(System(state.system.parts, one.links), state.coordinates)
        supports = {
            member: _support(one, end, rest, state, pushed[end])
            for member, end in zip(("sun", "carrier"), one.ends)
        }
        torque = state.mesh_forces[one.stage.name] * abs(one.stage.levers[0])
        found = carrier_turn(
            one.model,
            torque,
            supports,
            positions=POSITIONS,
            weights=weights(workshop, one, state.point),
            carried=centrifugal(workshop, one, state.point),
        )
        force = found.sun_mesh
        if one.turns != one.way:  # it turns the other way than the stage is told
            force = np.roll(force[::-1], 1, axis=0)
        out.append(StageTurn(one.stage.called, found.angle, force))
    return tuple(out)


def _support(
    stage: StageAtWork, end: str, rest: System, state: OperatingState, pushed: np.ndarray
) -> FixedSupport:
    """A port as the rest of the train holds it, in the axes of the stage: its stiffness, and where
    it would be without the force (6,) of the planets.
    """
    rows = rest.motion(end)[HELD]
    give = rows @ rest.static(rows.T)
    own = np.ix_(HELD, HELD)
    stiffness, shift = np.zeros((6, 6)), np.zeros(6)
    stiffness[own] = np.linalg.inv((give + give.T) / 2)
    shift[HELD] = state.motion(end)[HELD] - give @ pushed[HELD]
    turn = np.kron(np.eye(2), stage.axes)
    return FixedSupport(turn.T @ stiffness @ turn, turn.T @ shift)


def frequencies_over_a_turn(workshop: Workshop, models: Mapping[str, str], names: list[str]) -> str:
    """Sentence on how far natural frequencies move over a turn of a carrier; empty without planets.

    Parameters
    ----------
    names : list of str
        Of the modes in question, by ascending frequency, the free ones first.
    """
    lines = []
    for stage in workshop.train.stages:
        count = len(stage.teeth.azimuths)
        if stage.table.planets is not None and count >= ALIKE:
            lines.append(
                f"{count} equal planets at equal angles are the same all around to their shafts: "
                f"frequencies do not hang on the position of the carrier ({stage.called})."
            )
            continue
        found = [
            workshop.with_train(
                with_carrier_turned(workshop.train, stage.called, 2 * np.pi * k / LOOKED_AT)
            )
            .system(*models.values())
            .elastic[0]
            for k in range(LOOKED_AT)
        ]
        free = workshop.system(*models.values()).free.shape[1]
        own = np.array(found)[:, : len(names) - free]
        moved = np.ptp(own, axis=0) / own[0]
        most = int(moved.argmax())
        lines.append(
            f"Over a turn of the carrier of the {stage.called} frequencies move by up to "
            f"{100 * moved[most]:.2g} % ({names[free + most]}), solved at {LOOKED_AT} positions; "
            "these are those at the position of the file."
        )
    return " ".join(lines)
