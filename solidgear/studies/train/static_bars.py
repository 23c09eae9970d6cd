r"""Error bars of a train at rest under load, from the meshes of its harmonic shafts.

A quantity a'q of the state at rest has a bar where a shaft is a harmonic solid: its flexibility at
the ports lies between F and F + M (:mod:`solidgear.bounds.harmonic`), so that with the forces f on
the ports at rest, and those, g, which a unit load on the quantity would bring about on the bearings'
tangents,

    |error| <= sqrt(f'M f) sqrt(g'M g),      summed over the shafts

(Cauchy and Schwarz in the energy of the local problems; second order in M is left out).  Beams are
exact in their own theory: their bar is none, and what they miss is told by the harmonic solid.
"""

from __future__ import annotations

import numpy as np

from solidgear.bounds.harmonic import HarmonicBounds, harmonic_bounds, with_tail
from solidgear.bounds.safety import LOCAL
from solidgear.scene.coned import coned
from solidgear.scene.train_housing import HOUSING
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.operation import OperatingState, settled
from solidgear.studies.train.shaft import JUDGE
from solidgear.system.port_forces import port_forces
from solidgear.system.system import System


class StaticBars:
    """Error bars that meshes of harmonic shafts leave in linear numbers of a state at rest."""

    def __init__(self, workshop: Workshop, state: OperatingState, rungs: dict[str, str]):
        self.workshop, self.state = workshop, state
        self.sides = [side for side, rung in rungs.items() if rung == JUDGE]
        self.bounds: dict[str, HarmonicBounds] = {}
        if not self.sides or any(mesh.local_harmonics for mesh in workshop.train.meshes):
            return
        shop = workshop.with_train(settled(workshop.train, state))
        self.tangent: System = shop.system(*rungs.values())
        for side in self.sides:
            body = workshop.shaft(side, JUDGE).body
            self.bounds[side] = harmonic_bounds(coned(workshop.scenes[side]), body, statics=True)
        self.rest = self._ports(state.forces())

    def _ports(self, forces: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """(6 p,) forces on the ports of every harmonic shaft."""
        out = {}
        for side, bounds in self.bounds.items():
            out[side] = np.zeros(6 * len(bounds.body.ports))
            for end, six in forces.items():
                part, _, port = end.partition(".")
                if part == side:
                    at = 6 * bounds.body.port_index(port)
                    out[side][at : at + 6] += six
        return out

    def of(self, row: np.ndarray) -> float | None:
        """Bar of ``row @ coordinates``; None where there is none, and where the number grows as the
        train turns.
        """
        if not self.bounds:
            return None
        turns = np.abs(row @ self.tangent.free).max(initial=0.0)
        if turns > 1e-9 * np.linalg.norm(row):
            return None
        adjoint = port_forces(self.tangent, self.tangent.static(row))
        parts = [*self.workshop.scenes, *[HOUSING] * (self.workshop.train.housing is not None)]
        own = self._ports(_with_load(adjoint, self.tangent, row, parts))
        total = 0.0
        for side, bounds in self.bounds.items():
            f, g = self.rest[side], own[side]
            two, one = (
                float(np.sqrt(max(f @ m @ f, 0.0) * max(g @ m @ g, 0.0)))
                for m in (bounds.more, bounds.less)
            )
            total += LOCAL * with_tail(two, one)
        return total


def _with_load(
    forces: dict[str, np.ndarray], system: System, row: np.ndarray, parts: list[str]
) -> dict[str, np.ndarray]:
    """Forces of links with the unit load that a row of coordinates stands for, on the ports that it
    is made of.
    """
    out = dict(forces)
    ends = [f"{side}.{port}" for side in parts for port in system.parts[side].ports]
    rows = np.vstack([system.motion(end) for end in ends])
    loads, *_ = np.linalg.lstsq(rows.T, row, rcond=1e-12)
    for end, six in zip(ends, loads.reshape(-1, 6)):
        out[end] = out.get(end, np.zeros(6)) + six
    return out
