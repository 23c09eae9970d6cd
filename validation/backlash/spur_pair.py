"""ROSS's example of a gear pair with backlash, of our parts and laws.

Two equal spur gears, each a rigid body on two springs across its shaft, under torques that press
them together (ROSS 3.1, ``test_multi_rotor.py``, after Yi et al. 2019, Mechanical Systems and Signal
Processing 132).  ROSS takes the centre distance as it is at every instant: a metre more opens the
gap by ``sin alpha`` and, a second time, draws the driving flanks apart.  So its driving flanks push
the gears apart by ``2 sin alpha`` of their force and the others not at all, where one contact along
its line of action pushes by ``sin alpha``; `spread` says which.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.backlash.solver.balance import Balance
from solidgear.backlash.solver.continuation import Point
from solidgear.backlash.solver.model import Remainder, remainder
from solidgear.backlash.solver.motion import Integrated
from solidgear.core.system import BearingSpring, RigidBody, RowSpring, System
from solidgear.core.system.law import Gap

#: orders of the mesh by which its stiffness and its motion are told, and looks at each
MESH_ORDERS, LOOKS = 16, 4
#: N/m and N m/rad of what ROSS leaves free and nothing pushes
ALOFT = 1e6
#: Hz at which a loss factor of a bearing is its damper; any will do
MATCHED = 100.0


@dataclass(frozen=True, eq=False)
class SpurPair:
    """Numbers of the example, SI.

    Attributes
    ----------
    mass, polar : float
        Of each gear, kg and kg m^2.
    base_radius, pressure_angle : float
        m, rad.
    teeth : int
    half_gap, error : float
        b and the amplitude of the transmission error, once a tooth, m.
    bearing, damper : float
        Across each shaft, N/m and N s/m.
    torque, swing : float
        Mean, and amplitude once a turn, on both gears, N m.
    stiffness : (n,) array_like
        Of the mesh at equal intervals of a tooth pitch, N/m.
    mesh_damper : float
        Of flanks that touch, N s/m.
    spread : float
        How often the driving flank pushes by ``sin alpha``.
    """

    mass: float
    polar: float
    base_radius: float
    pressure_angle: float
    teeth: int
    half_gap: float
    error: float
    bearing: float
    damper: float
    torque: float
    swing: float
    stiffness: np.ndarray
    mesh_damper: float = 0.0
    spread: float = 2.0

    @property
    def per_cycle(self) -> int:
        """Teeth in a cycle of the motion: those of a turn where the torque swings with it."""
        return self.teeth if self.swing else 1

    def omega(self, rpm: float) -> float:
        """Of that cycle, rad/s."""
        return 2 * np.pi * rpm / 60 * self.teeth / self.per_cycle

    @cached_property
    def system(self) -> System:
        """Both gears in the plane of their rotation, the flanks as links that hold on one side."""
        body = np.diag([self.mass] * 3 + [self.polar / 2, self.polar, self.polar / 2])
        held = np.diag([self.bearing, ALOFT, self.bearing, ALOFT, 0.0, ALOFT])
        apart, along = np.sin(self.pressure_angle), np.cos(self.pressure_angle)
        law = Gap(float(np.mean(self.stiffness)), self.half_gap, 0.0, damper=self.mesh_damper)

        def flank(away: float, turned: float, stiffness: float) -> RowSpring:
            row = [away * apart, 0, turned * along, 0, turned * self.base_radius, 0]
            other = [*row[:4], -row[4], 0]
            return RowSpring("first.hub", row, stiffness, "second.hub", other, law)

        links = {
            "first bearing": BearingSpring("first.hub", held),
            "second bearing": BearingSpring("second.hub", held),
            "drive": flank(self.spread, 1.0, law.drive),
            "coast": flank(2.0 - self.spread, -1.0, 0.0),
        }
        gears = {name: RigidBody(body, {"hub": (0, 0, 0)}) for name in ("first", "second")}
        return System(gears, links)

    @cached_property
    def remainder(self) -> Remainder:
        """Told by cycles of the motion."""
        cycle = np.zeros(self.per_cycle * MESH_ORDERS, complex)
        parts = np.fft.rfft(self.stiffness)[1 : MESH_ORDERS + 1]
        cycle[self.per_cycle - 1 :: self.per_cycle] = 2 * parts / np.sum(self.stiffness)
        # an amplitude of rounding is none: pieces stay straight
        cycle[np.abs(cycle) < 1e-12] = 0.0
        error = np.zeros(self.per_cycle, complex)
        error[-1] = -1j * self.error
        turning = [0, 0, 0, 0, 1.0, 0]
        push = self.system.load({"first.hub": turning, "second.hub": turning})
        lost = 2 * np.pi * MATCHED * self.damper / self.bearing
        return remainder(
            self.system,
            loss={"first bearing": lost, "second bearing": lost},
            kind="viscous",
            matched_hz=MATCHED,
            load=self.torque * push,
            errors={"drive": error, "coast": -error},
            cycles={"drive": cycle, "coast": cycle},
            forces=[-1j * self.swing * push],
        )

    def balanced(self, rpm: float) -> Point:
        """Motion over a cycle by harmonic balance, begun with the driving flanks in contact."""
        omega = self.omega(rpm)
        balance = Balance(self.remainder, self.per_cycle * MESH_ORDERS)
        motion = balance.solve(balance.start(omega), omega)
        return Point(omega, motion, balance, np.zeros(0), 0.0)

    def in_time(self, begin: Point, cycles: int = 1) -> tuple[np.ndarray, np.ndarray]:
        """Stretches and forces (t, 2) over the last of some cycles, from a motion on."""
        own = self.remainder
        run = Integrated(own, begin.omega, LOOKS * self.per_cycle * MESH_ORDERS)
        state = begin.state()
        for _ in range(cycles):
            state, s, v = run.period(state)
        factor = own.factor(2 * np.pi * np.arange(run.looks) / run.looks)
        return s, own.forces(s, v, factor).value
