"""Tables of the loads of a shaft alone: components, resultant, equilibrium, torque along the shaft."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from solidgear.core import DOF_NAMES
from solidgear.show.table import Column, Table, quantity, text
from solidgear.show.units import ENGINEERING, Units
from solidgear.strength.load import LoadsAlone
from solidgear.strength.statics import Statics
from solidgear.trains.assembly.components import FORCE_UNITS

#: of the largest force or moment of a table: what is less is rounding
ROUNDING = 1e-9
#: place of resultants
START = "y = 0"


def loads_table(loads: LoadsAlone, statics: Statics, units: Units = ENGINEERING) -> list[Table]:
    """Return the loads with their resultant and the reactions; none of one load at the main point."""
    if loads.is_one_at_port:
        return []
    rows: list[list[Any]] = [[load.name, load.station, load.y, *load.six] for load in loads.acting]
    rows += [
        ["all loads", START, 0.0, *statics.loads],
        ["all bearings", START, 0.0, *statics.reactions],
    ]
    values = np.array([row[3:] for row in rows])
    rows = [[*row[:3], *six] for row, six in zip(rows, _without_rounding(values))]
    note = (
        "Components on the axis; thy is the torque. Loads and bearings balance to "
        f"{statics.imbalance:.1g} of the sum of their sizes."
    )
    if loads.assumed:
        note += f" {'; '.join(loads.assumed)}."
    return [Table("Loads", [text("load"), text("at"), *_components(units)], rows, note)]


def _components(units: Units) -> list[Column]:
    six = [quantity(dof, si, units, digits=4) for dof, si in zip(DOF_NAMES, FORCE_UNITS)]
    return [Column("place", unit="m", hidden=True), *six]


def _without_rounding(values: np.ndarray) -> Sequence[Sequence[float]]:
    """Return rows of six components, zero for those that are rounding beside the largest of all."""
    sizes = np.abs(values).reshape(-1, 2, 3).max(axis=(0, 2))
    least = np.repeat(ROUNDING * sizes, 3)
    return np.where(np.abs(values) > least, values, 0.0).tolist()


def torque_table(statics: Statics, units: Units = ENGINEERING) -> list[Table]:
    """Return the torque along the shaft; none where there is none."""
    if not statics.torque:
        return []
    columns = [
        quantity("from", "m", units),
        quantity("to", "m", units),
        quantity("torque", "N m", units, digits=5),
    ]
    note = "Torque of the part beyond a section on the part before it, about +y."
    return [Table("Torque along the shaft", columns, [[*s] for s in statics.torque], note)]
