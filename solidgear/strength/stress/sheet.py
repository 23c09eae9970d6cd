"""Sheet of the stress of shafts at rest: section forces, nominal stress, fillets."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from solidgear.core import TOUCH, listed
from solidgear.show.panel import GREY, Panel, Series, curve, readout
from solidgear.show.plot import WIDE, Chart
from solidgear.show.scales import Axis
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import Cell, Column, Table, exact, quantity, text, word
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.show.words import DASH, percent
from solidgear.strength.load import LoadsAlone
from solidgear.strength.stress.at_rest import StressAtRest, StressedShaft
from solidgear.strength.stress.din743 import LOADS, Load
from solidgear.strength.stress.nominal import LARGEST
from solidgear.strength.stress.notch_tables import (
    LITTLE,
    STRESS,
    drawn_notches,
    headline,
    over_cases,
    rating,
    safeties,
)
from solidgear.strength.stress.section_forces import SectionForces
from solidgear.strength.stress.shaft import Notch, ShaftStress
from solidgear.strength.stress.solid_sheet import solid_factors, solid_stress

#: of section forces: name, place among the six, and SI unit
COMPONENTS = (
    ("N", 1, "N"),
    ("Q_x", 0, "N"),
    ("Q_z", 2, "N"),
    ("M_x", 3, "N m"),
    ("M_z", 5, "N m"),
    ("T", 4, "N m"),
)
CONVENTION = (
    "Force of the part beyond a cut on the part before it; M about the middle of the section. "
    "Exact statics; loads act at the middle of their seats."
)
CHART_SHOWN = (
    "Section forces along the shaft; with two components, the dashed line is their resultant."
)
#: of the largest value of a table: what is less is rounding, or couplings of no weight
NOTHING = 1e-9
#: what holds of all of it
ELASTIC = "Linear elastic, without residual stress."
#: px; height of a panel of the chart
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


def sheet(stressed: StressAtRest, units: Units) -> Sheet:
    """Return the sheet of the stress of a shaft, or of all shafts of a train."""
    shafts = {re.sub(r"[^A-Za-z0-9_-]", "_", shaft.name): shaft for shaft in stressed.shafts}
    return Sheet(
        name="stress",
        title=f"{stressed.title}: stress",
        lead=f"{loads_in_words(stressed, units)}; bearing reactions by {stressed.model}.",
        tables=_tables(stressed, units),
        data=stressed.as_dict(),
        charts={
            f"section_forces_{name}": partial(_chart, stressed, shaft, units)
            for name, shaft in shafts.items()
        },
        lines={
            f"section_forces_{name}": components(shaft.found.forces)
            for name, shaft in shafts.items()
        },
        headline=headline(stressed, units),
        notes=sentences(stressed, units),
        cautions=stressed.cautions,
        reached=stressed.reached,
        terminal=Terminal(tables=_tables(stressed, units, all_ratings=False)),
        words={f"section_forces_{name}": CHART_SHOWN for name in shafts},
    )


def loads_in_words(stressed: StressAtRest, units: Units) -> str:
    """Return the load, or the operating point, that the shafts are under in words."""
    load = stressed.under
    if isinstance(load, LoadsAlone):
        return load.words(units)
    force = units.text(load.mesh_force, "N", 5)
    return f"At {load.point.label}: mesh force {force} along the line of action"


def _chart(stressed: StressAtRest, shaft: StressedShaft, units: Units, width: float) -> Chart:
    """Chart the section forces of one shaft, named where there are several."""
    title = f"Section forces, {shaft.name}" if len(stressed.shafts) > 1 else "Section forces"
    return section_chart(shaft.found.forces, title, units, width)


def _tables(stressed: StressAtRest, units: Units, all_ratings: bool = True) -> list[Table]:
    tables = [
        table
        for shaft in stressed.shafts
        for table in shaft_tables(stressed, shaft, units, all_ratings)
    ]
    return [*over_cases(stressed.cases, units), *tables]


def shaft_tables(
    stressed: StressAtRest,
    shaft: StressedShaft,
    units: Units = ENGINEERING,
    all_ratings: bool = True,
) -> list[Table]:
    """Return tables of one shaft without empty ones; `all_ratings` or that of the worst fillet."""
    stress = shaft.found
    rated = [(notch.name, notch.rating) for notch in stress.worst if notch.rating is not None]
    out = [
        section_forces(stress.forces, units, shaft.open_moment, stressed.open_by),
        nominal_stress(stress, units),
        fillets(stress, units),
        surface_stress(stress, shaft.open, units, stressed.open_by),
        form_factors(stress),
        drawn_notches(stress, units),
        solid_stress(shaft.solids, units),
        solid_factors(shaft.solids),
        safeties(stress),
        *(rating(name, record, units) for name, record in rated[: None if all_ratings else 1]),
    ]
    if len(stressed.shafts) > 1:
        for table in out:
            table.title = f"{table.title}, {shaft.name}"
    return [table for table in out if table]


def sentences(stressed: StressAtRest, units: Units = ENGINEERING) -> list[str]:
    """Return sentences on the shafts: places without a stress, and what was left out."""
    out = []
    for shaft in stressed.shafts:
        lead = f"{shaft.name}: " if len(stressed.shafts) > 1 else ""
        shaft_remarks = remarks(shaft.found, units)
        shaft_remarks += [f"{remark}." for remark in shaft.without_solid]
        if not shaft.found.notches:
            shaft_remarks.insert(0, "no shoulder has a fillet, so there is no stress on one.")
        if shaft.weak:
            names = ", ".join(f'"{name}"' for name in shaft.weak)
            shaft_remarks.append(
                f"not rated: the material of {names} has no strength; write strength = {{ "
                'yield_point = "700 MPa", ultimate = "1000 MPa" } beside E, nu and density.'
            )
        out += [lead + remark for remark in shaft_remarks]
    if stressed.duty:
        out.append(
            f"Ratings are over the duty table, {listed(stressed.duty, most=6)}; tables of stress are "
            "of the one case above."
        )
    return [*out, ELASTIC]


def section_forces(
    forces: SectionForces,
    units: Units = ENGINEERING,
    open_: tuple[float, float] | None = None,
    open_by: str = "",
) -> Table:
    """Return section forces on both sides of every load; `open_` is the range of the largest
    moment, N m.
    """
    sides = _sides(forces)
    q_x, n, q_z, m_x, t, m_z = np.array([side[3] for side in sides]).T
    force = _without_rounding(np.array([n, np.hypot(q_x, q_z)]))
    moment = _without_rounding(np.array([np.hypot(m_x, m_z), t]))
    rows = [[*side[:3], *f, *m] for side, f, m in zip(sides, force.T, moment.T)]
    columns = [
        quantity("y", "m", units),
        text("acts there"),
        word("side"),
        *(quantity(name, "N", units) for name in "NQ"),
        *(quantity(name, "N m", units) for name in "MT"),
    ]
    note = f"{CONVENTION} N is positive in tension; Q and M are sizes of two components."
    if forces.spread is not None:
        note += " Weight is spread along the shaft."
    if open_ is not None and open_[1] > (1 + LITTLE) * open_[0]:
        low, high = (units.number(value, "N m", 4) for value in open_)
        note += f" Largest M {low} to {high} {units.unit('N m')} by {open_by} of the bearings."
    return Table("Section forces", columns, rows, note)


def _without_rounding(values: np.ndarray) -> np.ndarray:
    """Return values, with zero for those that are rounding beside the largest."""
    return np.where(np.abs(values) > NOTHING * np.abs(values).max(initial=0.0), values, 0.0)


def components(forces: SectionForces) -> Table:
    """Return all six components on both sides of every load, and between where weight bends them, in
    SI, for other programs.
    """
    sides = _sides(forces)
    labelled = np.array([y for y, *_ in sides])
    if forces.spread is not None:
        sides += [
            (float(y), "", "both", six)
            for y, six in zip(*forces.curve)
            if np.abs(labelled - y).min() > TOUCH
        ]
        sides.sort(key=lambda side: side[0])
    heads = [f"{name} [{si}]" for name, _, si in COMPONENTS]
    columns = ["y [m]", "acts there", "side", *heads]
    rows = [
        [y, name, side, *(float(six[k]) for _, k, _ in COMPONENTS)] for y, name, side, six in sides
    ]
    return Table("", [Column(head, write=exact) for head in columns], rows).counted("place")


def _sides(forces: SectionForces) -> list[tuple[float, str, str, np.ndarray]]:
    """Return place, load, side and section forces, without places off the shaft or without a name."""
    last = len(forces.y) - 1
    ends = {0: forces.names[0] or "end", last: forces.names[-1] or "end"}
    out = []
    for k, (y, name) in enumerate(zip(forces.y.tolist(), forces.names)):
        label = ends.get(k, name)
        out += [(y, label, "before", forces.left[k])] if label and k else []
        out += [(y, label, "beyond", forces.right[k])] if label and k < last else []
        out += [(y, LARGEST, "both", forces.right[k])] if y == forces.peak else []
    return out


def nominal_stress(shaft_stress: ShaftStress, units: Units = ENGINEERING) -> Table:
    """Return the nominal stress on both sides of every load and joint."""
    loaded = [row for row in shaft_stress.nominal if row.forces.any()]
    stresses = [row.stress for row in loaded]
    values = np.array([[s.tension, s.bending, s.torsion, s.shear] for s in stresses])
    columns = [
        quantity("y", "m", units),
        text("in"),
        quantity("d", "m", units, digits=4),
        quantity("bore", "m", units, digits=4),
        *(_stress(head, units) for head in ("sigma_N", "sigma_b", "tau_t", "tau_q")),
    ]
    rows = [
        [row.y, row.segment, 2 * row.section.outer, 2 * row.section.inner, *four]
        for row, four in zip(loaded, _without_rounding(values))
    ]
    note = (
        "Plain sections: N/A, M a/I, T a/(2 I). The shaft turns under loads at rest: bending is "
        "an amplitude of every point of the surface, the rest a mean. tau_q: at the neutral axis."
    )
    return Table(f"Nominal stress, {units.unit(STRESS)}", columns, rows, note)


def _stress(head: str, units: Units, digits: int = 4) -> Column:
    """Return a column of stresses for a table with their unit in its title."""
    write = partial(units.number, si=STRESS, digits=digits)
    return Column(head, write=write, unit="Pa")


def fillets(stress: ShaftStress, units: Units = ENGINEERING) -> Table:
    """Return places, sizes and remarks of the fillets."""
    columns = [
        text("fillet"),
        quantity("y", "m", units),
        quantity("radius", "m", units, digits=3),
        Column("r/d", write=partial(plain, digits=3)),
        Column("D/d", write=_factor),
        text("to be known"),
    ]
    rows = [
        [n.name, n.y, n.radius, n.radius / n.small, n.large / n.small, n.remark or None]
        for n in stress.notches
    ]
    note = "y: where the fillet meets its cylinder, with section forces and nominal stress there."
    return Table("Fillets", columns, rows, note)


def surface_stress(
    stress: ShaftStress,
    open_: Mapping[str, tuple[float, float]],
    units: Units = ENGINEERING,
    open_by: str = "",
) -> Table:
    """Return stress on the fillets with error bars, and ranges of amplitudes by `open_by`, Pa."""
    columns = [
        text("fillet"),
        word("by"),
        _stress("nominal", units),
        _stress("surface", units),
        _stress("error bar", units, 2),
    ]
    rows = []
    for notch, load in _by_load(stress.notches):
        nominal, local = notch.nominal, notch.local
        shown = {
            "tension": (nominal.tension, local.mean, local.mean_bar),
            "bending": (nominal.bending, local.amplitude, local.amplitude_bar),
            "torsion": (nominal.torsion, local.shear, local.shear_bar),
        }
        ends = open_.get(notch.name, ()) if load == "bending" else ()
        range_ = " to ".join(units.number(end, STRESS, 4) for end in ends)
        least, largest = ends or (None, None)
        rows.append([notch.name, load, *shown[load], Cell(least, "", range_ or DASH), largest])
    note = (
        "Surface: largest stress along the meridian: by bending the amplitude of the turning "
        "shaft, shear force included, so that it is not Kt times nominal; by tension and torsion "
        "(shear at the same place) a mean. Error bar: of the harmonic solid around the fillet."
    )
    columns.append(Column("range", name="least", unit="Pa", hidden=not open_))
    columns.append(Column("largest", unit="Pa", hidden=True))
    if open_:
        note += f" Range: by {open_by} of the bearings."
    title = f"Stress on the fillets, {units.unit(STRESS)}"
    return Table(title, columns, rows, note)


def form_factors(stress: ShaftStress) -> Table:
    """Return the form factors and fatigue notch factors of the fillets beside published ones."""
    sources = [*dict.fromkeys(source for notch in stress.notches for source in notch.published)]
    rows: list[list[Any]] = []
    for notch, load in _by_load(stress.notches):
        factor, fatigue = notch.found.factors[load], notch.fatigue.get(load)
        share = factor.bar / factor.value
        bar = Cell(share, "", percent(share, signed=False))
        published = [notch.published.get(source, {}).get(load) for source in sources]
        norm = [None, None] if fatigue is None else [fatigue.notch, fatigue.norm_notch]
        rows.append([notch.name, load, factor.value, bar, *published, *norm])
    columns = [text("fillet"), word("by"), Column("Kt", write=_factor), Column("error bar")]
    columns += [Column(source, write=_factor) for source in sources]
    note = (
        "Kt: largest surface stress over nominal stress where the fillet meets its cylinder, by "
        "the harmonic solid around it. "
    )
    if sources:
        note += (
            f"{' and '.join(sources)}: published factors of plain shoulders on solid shafts, in "
            "tension and bending up to 20 % below elasticity. "
        )
    if any(notch.fatigue for notch in stress.notches):
        columns += [Column("Kf", write=_factor), Column("norm", write=_factor)]
        note += (
            "Kf = Kt/n, the support number n by DIN 743-2 and the stress gradient of the solid; "
            "norm: that of its own factor and gradient."
        )
    return Table("Form factors", columns, rows, note.strip())


def _by_load(notches: Sequence[Notch]) -> list[tuple[Notch, Load]]:
    return [(notch, load) for notch in notches for load in LOADS]


def _factor(value: float) -> str:
    return plain(value, 4)


def remarks(stress: ShaftStress, units: Units = ENGINEERING) -> list[str]:
    """Return sentences on places without a number, and on what is left out."""
    out = []
    for chamfered, kind in ((False, "sharp corners"), (True, "chamfers, two obtuse corners each")):
        places = [
            f"y = {units.text(corner.y, 'm')} ({'in the bore, ' if corner.surface == 'bore' else ''}"
            f"{' to '.join(corner.between)})"
            for corner in stress.sharp
            if corner.chamfered == chamfered
        ]
        if places:
            out.append(
                f"{kind} at {listed(places)}: no stress there, since it grows without limit as a "
                "mesh is refined; give fillets."
            )
    out += [
        f'{drawn.kind} "{drawn.name}": {drawn.remark}.' for drawn in stress.drawn if drawn.remark
    ]
    out += [f'not rated: {u.kind} "{u.name}": {u.reason}.' for u in stress.unrated]
    return out + [f"{remark}." for remark in stress.remarks]


def section_chart(
    forces: SectionForces,
    title: str = "",
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart:
    """Chart the section forces over the length of a shaft, one kind below the other.

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
    places, lines = forces.curve
    y = units.values(places, "m")
    curves = {
        key: (y, units.values(lines[:, component], si)) for key, component in components.items()
    }
    if len(curves) > 1:
        curves[name.split()[-1]] = _size(*curves.values())
    sides = np.stack([forces.left, forces.right], axis=1).reshape(-1, 6)
    readings = {key: units.values(sides[:, component], si) for key, component in components.items()}
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
            panel.read(_read(forces, key, readings[key], units.unit(si), units), series[key].colour)
    return panel


def _size(
    a: tuple[np.ndarray, np.ndarray], b: tuple[np.ndarray, np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the resultant of two components that are straight between loads, as places and
    values.
    """
    share = np.linspace(0.0, 1.0, BETWEEN)
    (y, first), (_, second) = a, b

    steps = np.flatnonzero(np.diff(y) > 0)

    def fine(values: np.ndarray) -> np.ndarray:
        return (values[steps, None] * (1 - share) + values[steps + 1, None] * share).ravel()

    return fine(y), np.hypot(fine(first), fine(second))


def _read(
    forces: SectionForces, key: str, values: np.ndarray, unit: str, units: Units
) -> list[dict[str, Any]]:
    """Return places to be read: both sides of every load."""
    rows = curve(units.values(np.repeat(forces.y, 2), "m"), values)
    last = len(forces.y) - 1
    for k, row in enumerate(rows):
        usual = "end" if k // 2 in (0, last) else "here"
        name = f"{key} {'beyond' if k % 2 else 'before'} {forces.names[k // 2] or usual}"
        facts = ("y", plain(row["x"]), units.unit("m")), (key, plain(row["y"]), unit)
        row["readout"] = readout(name, *facts)
    return rows


def _ends(curves: list[np.ndarray]) -> tuple[float, float]:
    """Return ends of an axis that hold curves and zero, with some room."""
    low, high = min(0.0, *(c.min() for c in curves)), max(0.0, *(c.max() for c in curves))
    room = 0.08 * (high - low) or 1.0
    return float(low - room if low < 0 else -0.3 * room), float(
        high + room if high > 0 else 0.3 * room
    )
