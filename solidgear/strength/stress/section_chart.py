"""Chart of the section forces along a shaft: axial force, shear, bending and torque."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.show.panel import GREY, Axis, Panel, Series, curve, readout
from solidgear.show.plot import WIDE, Chart
from solidgear.show.units import ENGINEERING, Units, plain

if TYPE_CHECKING:
    from solidgear.strength.stress.section_forces import SectionForces

#: px; of a panel
TALL = 130.0
COLOURS = {"Q_x": "#1f5fa8", "Q_z": "#2b7a4b", "M_x": "#2b7a4b", "M_z": "#1f5fa8"}
ALONE, SIZE = "#00805e", "#b3305c"
#: panels: name, SI unit, and components by their place among the six
PANELS: tuple[tuple[str, str, dict[str, int]], ...] = (
    ("axial force N", "N", {"N": 1}),
    ("shear Q", "N", {"Q_x": 0, "Q_z": 2}),
    ("bending M", "N m", {"M_x": 3, "M_z": 5}),
    ("torque T", "N m", {"T": 4}),
)
#: places between two loads, of a curve that is not straight
BETWEEN = 24


def section_chart(
    forces: SectionForces,
    title: str = "",
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart:
    """Chart the section forces over the length of a shaft, one kind below the other.

    Parameters
    ----------
    width : float
        px.

    Examples
    --------
    >>> import numpy as np
    >>> from solidgear.strength.stress.section_forces import Load, section_forces
    >>> ends = [Load("A", 0.0, [0, -5, 0, 0, 0, 0]), Load("B", 0.2, [0, 5, 0, 0, 0, 0])]
    >>> "axial force N" in section_chart(section_forces(ends, 0.2)).svg()
    True
    """
    panels = [_panel(forces, *panel, units, last=panel is PANELS[-1]) for panel in PANELS]
    return Chart([[panel] for panel in panels], width, title)


def _panel(
    forces: SectionForces,
    name: str,
    si: str,
    components: dict[str, int],
    units: Units,
    last: bool,
) -> Panel:
    """Return the panel of one kind of section force."""
    y = units.values(np.repeat(forces.y, 2), "m")
    sides = np.stack([forces.left, forces.right], axis=1).reshape(-1, 6)
    curves = {
        key: (y, units.values(sides[:, component], si)) for key, component in components.items()
    }
    if len(curves) > 1:
        curves[name.split()[-1]] = _size(*curves.values())
    series = {key: Series(COLOURS.get(key, SIZE if len(curves) > 1 else ALONE)) for key in curves}
    panel = Panel(
        Axis(f"y in {units.unit('m')}" if last else "", (float(y[0]), float(y[-1]))),
        Axis(f"{name} in {units.unit(si)}", _ends([values for _, values in curves.values()])),
        TALL,
        series=series,
        legend={"orient": "right", "symbolType": "stroke", "symbolStrokeWidth": 3}
        if len(curves) > 1
        else None,
        right=70.0,
    )
    panel.draw({"type": "rule", "color": GREY, "strokeWidth": 1}, [{"y": 0.0}])
    for key, (place, values) in curves.items():
        mark = {"type": "line", "strokeWidth": 2}
        if key not in components:
            mark |= {"strokeDash": [5, 3]}
        panel.draw(mark, curve(place, values, name=key))
        if key in components:
            panel.read(
                _read(forces, y, key, values, units.unit(si), units.unit("m")), series[key].colour
            )
    return panel


def _size(
    a: tuple[np.ndarray, np.ndarray], b: tuple[np.ndarray, np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the resultant of two components that are straight between loads, as places and
    values.
    """
    share = np.linspace(0.0, 1.0, BETWEEN)
    (y, first), (_, second) = a, b

    def fine(values: np.ndarray) -> np.ndarray:
        return (values[1:-1:2, None] * (1 - share) + values[2::2, None] * share).ravel()

    return fine(y), np.hypot(fine(first), fine(second))


def _read(
    forces: SectionForces, y, key: str, values, unit: str, length: str
) -> list[dict[str, Any]]:
    """Return places to be read: both sides of every load."""
    rows = curve(y, values)
    for k, row in enumerate(rows):
        name = f"{key} {'beyond' if k % 2 else 'before'} {forces.names[k // 2] or 'end'}"
        facts = ("y", plain(row["x"]), length), (key, plain(row["y"]), unit)
        row["readout"] = readout(name, *facts)
    return rows


def _ends(curves: list[np.ndarray]) -> tuple[float, float]:
    """Return ends of an axis that hold curves and zero, with some room."""
    low, high = min(0.0, *(c.min() for c in curves)), max(0.0, *(c.max() for c in curves))
    room = 0.08 * (high - low) or 1.0
    return float(low - room if low < 0 else -0.3 * room), float(
        high + room if high > 0 else 0.3 * room
    )
