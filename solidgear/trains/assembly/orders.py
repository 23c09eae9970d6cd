"""Order lines of a train over the speed of the pinion, or of the shaft that the engine turns with,
and the natural frequencies they cross.

Order n of a mesh runs at ``n z_p`` times the speed of the pinion, the first order of a shaft at
the speed of the shaft.  Speeds go up to where the first order of the mesh meets the highest frequency.
Bearings and teeth do not change with speed here, so natural frequencies are level lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.core import SolidgearError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.kinematics import MESH_ORDERS, mesh_harmonics, shaft_harmonics
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.file.train import PerTurn
from solidgear.trains.modes.modes import TrainMode, train_modes
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.excitation import MOST_ORDERS

#: orders of shafts that are drawn
SHAFT_ORDERS = (1, 2)


@dataclass(frozen=True, eq=False)
class OrderLine:
    """An order over the speed of the pinion."""

    name: str  #: ``mesh 1``, ``pinion 1``, ``gear 2``
    per_turn: float  #: periods in one turn of the pinion
    #: rpm, force: (s,) speeds of the pinion and amplitude of the mesh force, N, where the
    #: transmission error has this order
    rpm: np.ndarray | None = None
    force: np.ndarray | None = None


@dataclass(frozen=True)
class Crossing:
    """Crossing of an order and a natural frequency."""

    line: str
    mode: str
    frequency_hz: float
    rpm: float  #: of the pinion
    #: of the mesh there, N; None for an order that the transmission error does not have
    force: float | None


@dataclass(frozen=True, eq=False)
class OrderMap:
    """Order lines and natural frequencies of a train."""

    highest_hz: float
    highest_rpm: float
    teeth: PerTurn  #: of the mesh whose error drives the train
    lines: tuple[OrderLine, ...]
    modes: tuple[TrainMode, ...]  #: elastic ones
    crossings: tuple[Crossing, ...]  #: by order, then by frequency


def order_map(
    assembly: Assembly,
    *models: str,
    highest_hz: float | None = None,
    damping: str = "hysteretic",
    matched_hz: float = 0.0,
    mesh_orders: int | None = None,
    shaft_orders: Sequence[int] = SHAFT_ORDERS,
    mesh: str | None = None,
    together: bool = False,
) -> OrderMap:
    """Return the order lines of a train with the shafts by models, up to a frequency that is by
    default that of the file; damping, mesh and together are those of
    :class:`solidgear.trains.response.drive.Drive`, and orders of other meshes have no force. By
    default there are three orders of the mesh, or as many as the transmission error has.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
    >>> found = order_map(assembly, "timoshenko", "timoshenko", highest_hz=1000.0)
    >>> first = found.crossings[0]
    >>> first.line, first.mode, round(first.rpm)  # 16.28 Hz and 14 teeth
    ('mesh 1', 'load torsion 1', 70)
    """
    drive = Drive(
        assembly, *models, damping=damping, matched_hz=matched_hz, mesh=mesh, together=together
    )
    train, driven = assembly.train, drive.pair
    highest = highest_hz or train.ask.max_frequency
    error_orders = drive.excitation.orders
    count = max(*MESH_ORDERS, error_orders) if mesh_orders is None else mesh_orders
    if not 1 <= count <= MOST_ORDERS:
        raise SolidgearError(f"{count} orders of the mesh; ask for 1 to {MOST_ORDERS}")
    teeth = train.per_turn(driven)
    highest_rpm = 60 * highest / teeth
    hz = drive.grid(highest)
    lines = []
    stage = driven.stage if isinstance(driven, PlanetMesh) else None
    name = driven.name if stage is None else stage.name
    for n, order in enumerate(mesh_harmonics(name, teeth, range(1, count + 1)), start=1):
        force = np.abs(drive.mesh(hz, n)[1]) if n <= error_orders else None
        rpm = None if force is None else 60 * hz / order.per_turn
        lines.append(OrderLine(order.name, order.per_turn, rpm, force))
    other_meshes = {
        pair.name: train.per_turn(pair) for pair in train.pairs if pair.name != driven.name
    }
    other_meshes |= {s.name: train.per_turn(s.meshes[0]) for s in train.stages if s is not stage}
    for name, passing in other_meshes.items():
        orders = mesh_harmonics(name, passing, range(1, count + 1))
        lines += [OrderLine(o.name, o.per_turn) for o in orders]
    for side, turns in train.turns.items():
        lines += [OrderLine(o.name, o.per_turn) for o in shaft_harmonics(side, turns, shaft_orders)]
    modes = train_modes(assembly, *models, max_frequency=highest).modes
    elastic = tuple(m for m in modes if 0 < m.frequency_hz <= highest)
    crossings = []
    for k, line in enumerate(lines):
        crossed = [
            mode for mode in elastic if 60 * mode.frequency_hz / line.per_turn <= highest_rpm
        ]
        hz_crossed = np.array([mode.frequency_hz for mode in crossed])
        force = (
            np.abs(drive.mesh(hz_crossed, k + 1)[1])
            if line.force is not None
            else [None] * len(crossed)
        )
        for mode, size in zip(crossed, force):
            force_there = None if size is None else float(size)
            at_rpm = 60 * mode.frequency_hz / line.per_turn
            crossings.append(Crossing(line.name, mode.name, mode.frequency_hz, at_rpm, force_there))
    return OrderMap(
        highest_hz=highest,
        highest_rpm=highest_rpm,
        teeth=teeth,
        lines=tuple(lines),
        modes=elastic,
        crossings=tuple(crossings),
    )
