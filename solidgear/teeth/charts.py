"""Charts of the contact of teeth: over a mesh cycle, on the flank, along the face, over the torque."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.show.panel import GREY, Panel, Series, curve, lines_legend, readout
from solidgear.show.plot import NARROW, WIDE, Chart, in_columns
from solidgear.show.scales import HEAT, Axis, Shade, log_ticks, number
from solidgear.show.units import Units
from solidgear.teeth.mesh_contact import SolvedMesh
from solidgear.teeth.study import AtTorque
from solidgear.trains.page.chart import COLOURS

#: cells of the pattern along the height of a tooth; decades of its colours
HEIGHTS, DECADES = 22, 1.3
#: orders of the error that are drawn over the torque
DRAWN_ORDERS = 3
#: courses that may lie on another, and how they are drawn
COVERING, DASHED = ("tangent, aligned",), {"type": "line", "strokeDash": [5, 4]}


def cycle_chart(mesh: SolvedMesh, units: Units, title: str = "", width: float = WIDE) -> Chart:
    """Chart transmission error and stiffness of the teeth over two mesh cycles."""
    cycle = mesh.cycle
    error = _lines(
        {"loaded": cycle.error, "without load": cycle.free_error},
        cycle.phases, units, "m moved", "error",
    )  # fmt: skip
    stiffness = _lines(
        {
            "tangent": cycle.tangent,
            "secant": cycle.secant,
            "tangent, aligned": mesh.aligned.tangent,
        },
        cycle.phases, units, "N/m", "mesh stiffness",
    )  # fmt: skip
    return Chart(in_columns([error, stiffness], 2 if width > NARROW else 1), width, title)


def _lines(
    values: dict[str, np.ndarray], phases: np.ndarray, units: Units, si: str, name: str
) -> Panel:
    """Return the panel of courses over two mesh cycles, each from its mean where it is an error."""
    looks = {key: Series(COLOURS[k % len(COLOURS)]) for k, key in enumerate(values)}
    unit = units.unit(si)
    shown = {
        key: units.values(course - course.mean() if si == "m moved" else course, si)
        for key, course in values.items()
    }
    everything = np.concatenate(list(shown.values()))
    low, high = float(everything.min()), float(everything.max())
    if si != "m moved":
        low = 0.0
    room = 0.08 * (high - low) or 0.1
    twice = np.concatenate([phases, phases + 1, [2.0]])
    title = f"{name} less its mean, {unit}" if si == "m moved" else f"{name}, {unit}"
    panel = Panel(
        Axis("mesh cycles", (0.0, 2.0)),
        Axis(title, (low - (room if low else 0.0), high + room)),
        230.0,
        series=looks,
        legend=lines_legend(4),
    )
    for key, course in shown.items():
        course = np.concatenate([course, course, course[:1]])
        panel.draw(DASHED if key in COVERING else "line", curve(twice, course, name=key))
        read = curve(twice, course)
        for row in read:
            at, size = ("at", f"{row['x']:.2f}", "cycles"), (name, f"{row['y']:.4g}", unit)
            row["readout"] = readout(key, at, size)
        panel.read(read, looks[key].colour)
    return panel


def pattern(mesh: SolvedMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the largest line load over a mesh cycle on every cell of a flank, (heights, slices) N/m,
    and the edges of the cells along the path and along the face, m; nan where nothing touches.
    """
    slices = mesh.cycle.slices
    places = np.concatenate([position.cells.place for position in mesh.cycle.positions])
    heights = np.linspace(places.min(), places.max(), HEIGHTS + 1)
    faces = np.linspace(-mesh.face_width / 2, mesh.face_width / 2, slices + 1)
    loads = np.full((HEIGHTS, slices), np.nan)
    for position in mesh.cycle.positions:
        cells = position.cells
        row = np.clip(np.searchsorted(heights, cells.place) - 1, 0, HEIGHTS - 1)
        for i, j, load in zip(row, cells.slice, position.line_load):
            loads[i, j] = np.nanmax([loads[i, j], load])
    return loads, heights, faces


def pattern_chart(mesh: SolvedMesh, units: Units, title: str = "", width: float = WIDE) -> Chart:
    """Chart the contact pattern on the flank of the first wheel."""
    loads, heights, faces = pattern(mesh)
    length, unit = units.unit("m"), units.unit("N/m along")
    place, along = units.values(heights, "m"), units.values(faces, "m")
    panel = Panel(
        Axis(f"along the face, {length}", (float(along[0]), float(along[-1]))),
        Axis(f"{mesh.height}, {length}", (float(place[0]), float(place[-1]))),
        260.0,
    )
    top = float(np.nanmax(loads))
    rows = []
    for i, j in zip(*np.nonzero(np.nan_to_num(loads) > 0)):
        load = float(units.values(loads[i, j], "N/m along"))
        rows.append(
            {
                "x": float(along[j]),
                "x2": float(along[j + 1]),
                "y": float(place[i]),
                "y2": float(place[i + 1]),
                "load": load,
                "readout": readout("line load", ("", f"{load:.4g}", unit)),
            }
        )
    most = float(units.values(np.array(top), "N/m along"))
    low = most * 10**-DECADES
    shade = Shade(
        "load",
        (low, most),
        HEAT,
        f"largest line load, {unit}",
        {value: number(value) for value in log_ticks(low, most)},
    )
    panel.draw({"type": "rect"}, rows, shade)
    for end in mesh.path_ends:
        place_of_end = float(units.values(np.array(end), "m"))
        panel.draw({"type": "rule", "color": GREY, "strokeDash": [4, 3]}, [{"y": place_of_end}])
    return Chart([[panel]], width, title)


def face_chart(mesh: SolvedMesh, units: Units, title: str = "", width: float = WIDE) -> Chart:
    """Chart the load along the face, as it lies and aligned."""
    slices = mesh.cycle.slices
    step = mesh.face_width / slices
    z = units.values((np.arange(slices) + 0.5) * step - mesh.face_width / 2, "m")
    loads = {"under load": mesh.cycle.face_loads / step, "aligned": mesh.aligned.face_loads / step}
    looks = {key: Series(COLOURS[k]) for k, key in enumerate(loads)}
    shown = {key: units.values(load, "N/m along") for key, load in loads.items()}
    unit, top = units.unit("N/m along"), max(float(load.max()) for load in shown.values())
    half = float(units.values(np.array(mesh.face_width / 2), "m"))
    panel = Panel(
        Axis(f"along the face, {units.unit('m')}", (-half, half)),
        Axis(f"load per face width, {unit}", (0.0, 1.08 * top)),
        200.0,
        series=looks,
        legend=lines_legend(2),
    )
    for key, load in shown.items():
        panel.draw("line", curve(z, load, name=key))
        read = curve(z, load)
        for row in read:
            row["readout"] = readout(key, ("load", f"{row['y']:.4g}", unit))
        panel.read(read, looks[key].colour)
    return Chart([[panel]], width, title)


def torque_chart(
    at_torques: Sequence[AtTorque], units: Units, title: str = "", width: float = WIDE
) -> Chart:
    """Chart transmission error, its first orders and stiffness over the torque."""
    torque = units.values(np.array([at.torque for at in at_torques]), "N m")
    cycles = [at.contact.cycle for at in at_torques]
    orders = np.abs([cycle.orders(DRAWN_ORDERS) for cycle in cycles])
    error = {"peak to peak": np.array([cycle.peak_to_peak for cycle in cycles])}
    error |= {f"order {n + 1}": orders[:, n] for n in range(DRAWN_ORDERS)}
    stiffness = {
        "tangent": np.array([cycle.tangent.mean() for cycle in cycles]),
        "secant": np.array([cycle.secant.mean() for cycle in cycles]),
    }
    in_row = 4 if width > NARROW else 2
    panels = [
        _over(torque, error, units, "m moved", "transmission error", in_row),
        _over(torque, stiffness, units, "N/m", "mesh stiffness", in_row),
    ]
    return Chart(in_columns(panels, 2 if width > NARROW else 1), width, title)


def _over(
    torque: np.ndarray,
    values: dict[str, np.ndarray],
    units: Units,
    si: str,
    name: str,
    in_row: int,
) -> Panel:
    """Return the panel of courses over the torque, with so many names in a row of its legend."""
    looks = {key: Series(COLOURS[k % len(COLOURS)]) for k, key in enumerate(values)}
    shown = {key: units.values(course, si) for key, course in values.items()}
    unit, top = units.unit(si), max(float(course.max()) for course in shown.values())
    low, high = sorted((float(torque[0]), float(torque[-1])))
    panel = Panel(
        Axis(f"torque, {units.unit('N m')}", (min(low, 0.0), max(high, 0.0))),
        Axis(f"{name}, {unit}", (0.0, 1.08 * top or 1.0)),
        230.0,
        series=looks,
        legend=lines_legend(in_row),
    )
    for key, course in shown.items():
        rows = curve(torque, course, name=key)
        panel.draw("line", rows)
        for row in rows:
            row["readout"] = readout(key, (name, f"{row['y']:.4g}", unit))
        panel.draw({"type": "point", "filled": True, "size": 30}, rows)
    return panel
