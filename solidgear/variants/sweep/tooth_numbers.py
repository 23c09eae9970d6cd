"""Numbers of teeth in contact in the rows of a train, and what rows share that solve them.

Shafts, bearings and loads decide how a train carries its teeth, and wheels what their cells give way
by; neither changes with the shapes of flanks.  Both are kept while rows have them in common.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from typing import Any

import numpy as np

from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.mesh_contact import SolvedMesh
from solidgear.teeth.supports import Carried, on_beams, with_sections
from solidgear.teeth.train_teeth import with_teeth
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_stiffness import with_usual_meshes
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train

#: beginnings of columns: transmission error under load from peak to peak and by order of the mesh,
#: tangent stiffness of the teeth, face load factor, and largest pressure; and their units
ERROR, STIFFNESS, FACE_LOAD, PRESSURE = (
    "transmission_error",
    "tooth_stiffness",
    "face_load_factor",
    "contact_pressure",
)
#: states of a train and pairs of wheels that are kept
MOST = 40
#: orders of the transmission error that have a column
ORDERS = 3
ERROR_ORDERS = tuple(f"{ERROR}_order{k}" for k in range(1, ORDERS + 1))
TOOTH_UNITS = {
    ERROR: "m moved",
    **dict.fromkeys(ERROR_ORDERS, "m moved"),
    STIFFNESS: "N/m",
    FACE_LOAD: "",
    PRESSURE: "Pa stressed",
}
#: those that have a chart
CHARTED = ERROR, STIFFNESS, FACE_LOAD, PRESSURE


def of_mesh(number: str, mesh: str) -> str:
    """Return the column of a number of a mesh."""
    return f"{number}{mesh.removeprefix('mesh').replace(' ', '_')}"


def tooth_numbers(meshes: Iterable[SolvedMesh]) -> dict[str, float]:
    """Return the numbers of meshes of a train where it is carried, by column, SI."""
    out: dict[str, float] = {}
    for mesh in meshes:
        cycle = mesh.cycle
        numbers = {
            ERROR: cycle.peak_to_peak,
            **dict(zip(ERROR_ORDERS, np.abs(cycle.orders(ORDERS)).tolist())),
            STIFFNESS: float(cycle.tangent.mean()),
            FACE_LOAD: cycle.face_load_factor,
            PRESSURE: cycle.pressure,
        }
        out |= {of_mesh(number, mesh.name): value for number, value in numbers.items()}
    return out


class TeethBench:
    """States of a train that carries its teeth, kept from row to row."""

    def __init__(self) -> None:
        self._key: Hashable = None
        self._states: list[tuple[OperatingPoint, Carried]] = []
        self._pairs: dict[Any, CylindricalPair] = {}
        self.settled = 0  #: states that were solved

    def solved(self, key: Hashable, train: Train, point: OperatingPoint) -> Train:
        """Return a train with the numbers of its teeth at an operating point."""
        return with_teeth(train, self.carried(key, train, point))

    def carried(self, key: Hashable, train: Train, point: OperatingPoint) -> Carried:
        """Return a train at rest; the key is the same for trains that differ in operating points and
        in the shapes of flanks alone.
        """
        if key != self._key:
            self._key, self._states = key, []
        for settled_at, state in self._states:
            if settled_at == point:
                return state
        sectioned = with_sections(with_usual_meshes(train))
        if not self._states:
            operating = on_beams(Assembly(sectioned))
        else:
            _, first = self._states[0]
            operating = first.operating.with_points(sectioned)
        if len(self._pairs) > MOST:
            self._pairs.clear()
        # not from another state: no row depends on those before it
        carried = Carried(operating, operating.at(point), self._pairs)
        del self._states[MOST:]
        self._states.append((point, carried))
        self.settled += 1
        return carried
