"""Files of a response as numbers, for other programs."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.show.table import Column, Table, exact, numbers
from solidgear.trains.page import tables as train_tables


def over_frequency(response: Any, teeth: float) -> Table:
    """Return amplitude and phase of every column over frequency, units in brackets."""
    columns = places(response.frequency_hz, teeth)
    for name, value in response.columns.items():
        quantity, _, unit = name.partition(" [")
        columns[f"{quantity} [{unit}"] = np.abs(value)
        columns[f"{quantity} phase [deg]"] = np.degrees(np.angle(value))
    return numbers(columns, axes=1)


def crossings(orders: Any, of: str = "pinion") -> Table:
    """Return the table of crossings of order lines and natural frequencies, in SI."""
    columns = [
        Column("order", lambda c: c.line),
        Column("mode", lambda c: c.mode),
        Column("frequency [Hz]", lambda c: c.frequency_hz, exact),
        Column(f"{of} speed [rpm]", lambda c: c.rpm, exact),
        Column("mesh force [N]", lambda c: c.force, exact),
    ]
    return Table("", columns, orders.crossings)


def places(hz: np.ndarray, teeth: float) -> dict[str, np.ndarray]:
    """Return columns of frequency and speed."""
    return {"frequency [Hz]": hz, f"{train_tables.turned(teeth)} speed [rpm]": 60 * hz / teeth}
