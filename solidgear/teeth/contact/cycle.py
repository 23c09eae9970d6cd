r"""Contact over one mesh cycle: transmission error, stiffness, load along the face.

Positions are spread evenly over one pitch.  The transmission error is the arc by which the first wheel
runs ahead on its base cylinder, theta rb, as the second wheel is held: positive where flanks stand
back or give way.  Its order n is the amplitude of the n-th harmonic of the tooth frequency.

The face load factor is what the norm means by it: the largest load per face width over its mean, of
all lines together and averaged over the cycle (ISO 6336-1:2019, 7.1); beside it stands the largest
line load of any cell over the mean line load at its position.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.teeth.contact.cells import Carrying, ToothedPair
from solidgear.teeth.contact.solver import Loads, loads

#: positions of a mesh cycle
POSITIONS = 32


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """Loads at all positions of one mesh cycle under one torque."""

    positions: tuple[Loads, ...]
    base: float  #: radius on which the transmission error is an arc, m
    slices: int

    @property
    def phases(self) -> np.ndarray:
        """(p,) positions in pitches."""
        return np.arange(len(self.positions)) / len(self.positions)

    @property
    def torque(self) -> float:
        """Torque on the first wheel, N m."""
        return self.positions[0].torque

    @cached_property
    def error(self) -> np.ndarray:
        """(p,) loaded transmission error, m."""
        return self.base * np.array([position.rotation for position in self.positions])

    @cached_property
    def free_error(self) -> np.ndarray:
        """(p,) transmission error without load, m."""
        return self.base * np.array([position.supported_touch for position in self.positions])

    @cached_property
    def secant(self) -> np.ndarray:
        """(p,) stiffness of the teeth from first touch to load, N/m."""
        return np.array([position.secant for position in self.positions])

    @cached_property
    def tangent(self) -> np.ndarray:
        """(p,) stiffness of the teeth about the load, N/m."""
        return np.array([position.tangent for position in self.positions])

    @cached_property
    def supported_secant(self) -> np.ndarray:
        """(p,) stiffness of teeth and supports from first touch to load, N/m."""
        return np.array([position.supported_secant for position in self.positions])

    @cached_property
    def supported_tangent(self) -> np.ndarray:
        """(p,) stiffness of teeth and supports about the load, N/m."""
        return np.array([position.supported_tangent for position in self.positions])

    @property
    def force(self) -> float:
        """Mean force along the line of action, N."""
        return float(np.mean([position.total for position in self.positions]))

    @property
    def points(self) -> np.ndarray:
        """(p, 3) mesh points in the frame of the pair, m."""
        return np.array([position.point for position in self.positions])

    @property
    def lines_of_action(self) -> np.ndarray:
        """(p, 3) directions of the force on the first wheel."""
        return np.array([position.line_of_action for position in self.positions])

    @property
    def peak_to_peak(self) -> float:
        """Largest less least loaded transmission error, m."""
        return float(np.ptp(self.error))

    def orders(self, count: int) -> np.ndarray:
        """Return the (count,) complex amplitudes of the loaded transmission error, m."""
        return harmonics(self.error, count)

    @cached_property
    def line_error(self) -> np.ndarray:
        """(p,) loaded transmission error along the line of action, m: the rotation times its lever."""
        return np.array([position.rotation * position.arm for position in self.positions])

    @property
    def parametric_error(self) -> np.ndarray:
        """(p,) error along the line of action that a spring of the tangent stiffness must have to give
        way by the loaded one under this force, m.
        """
        forces = np.array([position.total for position in self.positions])
        return self.line_error - forces / self.tangent

    @cached_property
    def face_loads(self) -> np.ndarray:
        """(slices,) load by slice of the face, of all lines, mean over the cycle, N."""
        total = np.zeros(self.slices)
        for position in self.positions:
            np.add.at(total, position.cells.slice, position.force)
        return total / len(self.positions)

    @property
    def face_load_factor(self) -> float:
        """Largest load per face width over the mean, K_H beta."""
        return float(self.face_loads.max() / self.face_loads.mean())

    @cached_property
    def line_load_factor(self) -> float:
        """Largest line load on the path over the mean line load of its position, largest of the cycle."""
        return float(max(_over_mean(position) for position in self.positions))

    @cached_property
    def pressure(self) -> float:
        """Largest Hertz pressure on the path of contact, N/m^2; that of corners means nothing."""
        return float(max(_on_path(position) for position in self.positions))

    @cached_property
    def load_share(self) -> float:
        """Largest share of the force that a contact line carries."""
        return max(max(position.shares.values()) for position in self.positions)

    @cached_property
    def mean_lines(self) -> float:
        """Mean number of contact lines that carry."""
        return float(np.mean([len(position.shares) for position in self.positions]))

    @cached_property
    def corner_share(self) -> float:
        """Largest share of the force that corners of tips carry, beyond the path."""
        return max(
            float(position.force[position.cells.at_corner].sum() / position.force.sum())
            for position in self.positions
        )


def _over_mean(position: Loads) -> float:
    """Return the largest line load of the cells on the path over the mean of all."""
    cells = position.cells
    largest = position.line_load[~cells.at_corner].max(initial=0.0)
    return float(largest * cells.length[~cells.at_corner].sum() / position.force.sum())


def harmonics(course: np.ndarray, count: int) -> np.ndarray:
    """Return the (count,) complex amplitudes of a course (p,) over a cycle: order n at the angle
    2 pi phase is ``Re(a exp(i n angle))``.
    """
    return 2 * np.fft.rfft(course)[1 : count + 1] / len(course)


def _on_path(position: Loads) -> float:
    """Return the largest pressure of the cells on the path, N/m^2."""
    on_path = ~position.cells.at_corner
    return float(position.pressure[on_path].max(initial=0.0))


def mesh_cycle(
    pair: ToothedPair,
    torque: float,
    base: float,
    slices: int,
    supports: Carrying | None = None,
    positions: int = POSITIONS,
) -> MeshCycle:
    """Solve the contact at evenly spread positions of one pitch; arguments as of
    :func:`solidgear.teeth.contact.solver.loads`.
    """
    solved = tuple(loads(pair, torque, k / positions, supports) for k in range(positions))
    return MeshCycle(solved, base, slices)
