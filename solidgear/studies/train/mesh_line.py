r"""The line of action of a train over its mesh cycle, as rows between the ports of both shafts.

Each place of the table is a mesh vector on both shafts (Hua 2010, equation 21).  That the gear turns
about its shaft enters through the ratio of the mean line (3.2.2): a pair that turns evenly does not
stretch its teeth, wherever they touch.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from solidgear.errors import SceneError
from solidgear.scene.gears import Pair
from solidgear.studies.train.contact import LEVER_REFUSED, axes_of
from solidgear.studies.train.models import Workshop
from solidgear.system.gear_mesh import MeshVector, to_gear_frame
from solidgear.system.links import RowSpring

#: orders of the mesh that are kept of what varies over its cycle, and places at which it is read
CYCLE_ORDERS, CYCLE_PLACES = 8, 4096
#: a row that turns by less than this of the mean one is rounding
STILL = 1e-12
#: rotation about the shaft, of six components
AXIAL = 4


@dataclass(frozen=True, eq=False)
class TurningLine:
    """A line of action over the mesh cycle."""

    mean: np.ndarray  #: (12,) row of the mean line on the pinion, and on the gear
    further: np.ndarray  #: (r, 12) rows by which it turns
    orders: np.ndarray  #: (o, r) how much of each, by orders of the mesh

    def mean_of(self, mesh: RowSpring) -> RowSpring:
        """The teeth along the mean line."""
        return replace(mesh, row=self.mean[:6], to_row=self.mean[6:])

    def further_of(self, mesh: RowSpring) -> RowSpring:
        """Rows by which it turns, between the same ports."""
        return replace(mesh, row=self.further[:, :6], to_row=self.further[:, 6:], law=None)


def orders_of(angle: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean (c,) of a table (n, c) over a mesh cycle, linear between its angles, and complex orders
    (o, c) from 1.
    """
    at = np.linspace(angle[0], angle[-1], CYCLE_PLACES, endpoint=False)
    read = np.column_stack([np.interp(at, angle, column) for column in np.transpose(values)])
    parts = np.fft.rfft(read, axis=0) / CYCLE_PLACES
    return parts[0].real, 2 * parts[1 : CYCLE_ORDERS + 1]


def turning_line(workshop: Workshop, pair: Pair) -> TurningLine | None:
    """Mean row of the teeth of a mesh, and how it turns; None where its line stays.

    Raises
    ------
    SceneError
        For a train whose teeth hold their mesh point, or act on the other flank, and lever arms that
        are not in the ratio of the teeth.
    """
    table, path = pair.mesh.line_cycle, (*pair.paths["mesh"], "line_cycle")
    if table is None:
        return None
    if pair.mesh.local_harmonics:
        raise SceneError(
            "moves the mesh point, and local_harmonics hold it where it is on the rim; leave one out",
            path=path,
        )
    if pair.point is not None and pair.point.coast:
        raise SceneError(
            "is that of one flank; a torque on the other one (coast, below zero) needs a file with "
            "its own",
            path=path,
        )
    rows = [
        _row(workshop, pair, np.array(normal), np.array(point), path)
        for normal, point in zip(table.normal, table.point)
    ]
    mean, orders = orders_of(np.array(table.angle), np.array(rows))
    left, size, right = np.linalg.svd(np.vstack([orders.real, orders.imag]), full_matrices=False)
    kept = size > STILL * np.abs(mean).max()
    shares = (left * size)[:, kept]
    shares = shares[: len(orders)] + 1j * shares[len(orders) :]
    scale = np.abs(shares).sum(axis=0)  # so that shares are one at most
    return TurningLine(mean, scale[:, None] * right[kept], shares / scale)


def _row(
    workshop: Workshop, pair: Pair, normal: np.ndarray, point: np.ndarray, path: tuple
) -> np.ndarray:
    """(12,) row of the teeth on both shafts while they touch at a point."""
    met = workshop.contacts[pair.name]
    normal = normal / np.linalg.norm(normal)
    angle = pair.mesh.shaft_angle
    here = (
        MeshVector(normal, point),
        MeshVector(to_gear_frame(normal, angle), to_gear_frame(point - met.origin, angle)),
    )
    turns = [axes_of(pair, side) for side in pair.members]
    own = [MeshVector(turn @ one.normal, turn @ one.point) for turn, one in zip(turns, here)]
    ratio = met.gear.lever / met.pinion.lever
    levers = own[1].lever / own[0].lever if own[0].lever else np.inf
    if not abs(levers / ratio - 1) < LEVER_REFUSED or own[0].lever * met.pinion.lever < 0:
        told = ", ".join(f"{1e3 * v:.2f}" for v in point)
        raise SceneError(
            f"has lever arms of {1e3 * own[0].lever:.2f} mm on the pinion and "
            f"{1e3 * own[1].lever:.2f} mm on the gear where the mesh point is ({told}) mm; those of "
            f"the mesh are {1e3 * met.pinion.lever:.2f} and {1e3 * met.gear.lever:.2f} mm",
            path=path,
        )
    gear = own[1].vector.copy()
    gear[AXIAL] = ratio * own[0].vector[AXIAL]
    return np.concatenate([own[0].vector, gear])
