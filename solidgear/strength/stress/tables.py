"""Tables of the stress of a shaft: section forces, nominal stress, fillets, and their rating."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core import listed
from solidgear.show.table import Cell, Column, Table, quantity, text, word
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.show.words import percent

if TYPE_CHECKING:
    from solidgear.strength.stress.rating import Entry, Rating
    from solidgear.strength.stress.section_forces import SectionForces
    from solidgear.strength.stress.shaft import Notch, ShaftStress

#: SI unit of a stress in tables
STRESS = "Pa stressed"
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
LOADS = ("tension", "bending", "torsion")
#: stress on a fillet by what brings it, as attributes of nominal and local stress
BY = {"tension": "mean", "bending": "amplitude", "torsion": "shear"}
#: of the largest value of a table: what is less is rounding, or couplings of no weight
NOTHING = 1e-9
#: share of a value that is left open from which on it is told
LITTLE = 1e-3
#: safety that DIN 743 asks for where loads and strength are sure
LEAST = 1.2


def section_forces(
    forces: SectionForces,
    units: Units = ENGINEERING,
    open_: tuple[float, float] | None = None,
    open_by: str = "",
) -> Table:
    """Return section forces on both sides of every load; `open_` is the range of the largest
    moment, N m.
    """
    rows = [
        (y, name, side, six[1], math.hypot(six[0], six[2]), math.hypot(six[3], six[5]), six[4])
        for y, name, side, six in _sides(forces, forces.names_without_weights)
    ]
    force = _of_weight(value for row in rows for value in (row[3], row[4]))
    moment = _of_weight(value for row in rows for value in (row[5], row[6]))
    columns = [
        quantity("y", "m", units),
        text("acts there"),
        word("side"),
        quantity("N", "N", units, lambda row: force(row[3])),
        quantity("Q", "N", units, lambda row: force(row[4])),
        quantity("M", "N m", units, lambda row: moment(row[5])),
        quantity("T", "N m", units, lambda row: moment(row[6])),
    ]
    note = f"{CONVENTION} N is positive in tension; Q and M are sizes of two components."
    if forces.names_without_weights != forces.names:
        note += " Weight acts between, at the middle of each segment."
    if open_ is not None and open_[1] > (1 + LITTLE) * open_[0]:
        low, high = (units.number(value, "N m", 4) for value in open_)
        note += f" Largest M {low} to {high} {units.unit('N m')} by {open_by} of the bearings."
    return Table("Section forces", columns, rows, note)


def _of_weight(values: Iterable[float]) -> Callable[[float], float]:
    """Return values, with zero for those that are rounding beside the largest."""
    least = NOTHING * max(map(abs, values), default=0.0)
    return lambda value: value if abs(value) > least else 0.0


def components(forces: SectionForces) -> Table:
    """Return all six components on both sides of every place, in SI, for other programs."""
    heads = [f"{name} [{si}]" for name, _, si in COMPONENTS]
    columns = ["y [m]", "acts there", "side", *heads]
    rows = [
        [y, name, side, *(float(six[k]) for _, k, _ in COMPONENTS)]
        for y, name, side, six in _sides(forces, forces.names)
    ]
    return Table("", [Column(head, write=lambda v: f"{v:.9g}") for head in columns], rows)


def _sides(forces: SectionForces, names: Sequence[str]) -> list[tuple[float, str, str, np.ndarray]]:
    """Yield place, load, side and section forces, without places off the shaft or without a name."""
    last = len(forces.y) - 1
    ends = {0: names[0] or "end", last: names[-1] or "end"}
    out = []
    for k, (y, name) in enumerate(zip(forces.y.tolist(), names)):
        label = ends.get(k, name)
        out += [(y, label, "before", forces.left[k])] if label and k else []
        out += [(y, label, "beyond", forces.right[k])] if label and k < last else []
    return out


def nominal_stress(shaft_stress: ShaftStress, units: Units = ENGINEERING) -> Table:
    """Return the nominal stress on both sides of every load and joint."""
    rows = [row for row in shaft_stress.nominal if row.forces.any()]
    kinds = {"sigma_N": "tension", "sigma_b": "bending", "tau_t": "torsion", "tau_q": "shear"}
    weighty = _of_weight(getattr(row.stress, kind) for row in rows for kind in kinds.values())

    def stress(head: str, kind: str) -> Column:
        return _stress(head, units, lambda row: weighty(getattr(row.stress, kind)))

    columns = [
        quantity("y", "m", units, lambda row: row.y),
        text("in", lambda row: row.segment),
        quantity("d", "m", units, lambda row: 2 * row.section.outer, 4),
        quantity("bore", "m", units, lambda row: 2 * row.section.inner, 4),
        *(stress(head, kind) for head, kind in kinds.items()),
    ]
    note = (
        "Plain sections: N/A, M a/I, T a/(2 I). The shaft turns under loads at rest: bending is "
        "an amplitude of every point of the surface, the rest a mean. tau_q: at the neutral axis."
    )
    return Table(f"Nominal stress, {units.unit(STRESS)}", columns, rows, note)


def _stress(head: str, units: Units, value: Callable[[Any], float], digits: int = 4) -> Column:
    """Return a column of stresses for a table with their unit in its title."""
    return Column(head, value, partial(units.number, si=STRESS, digits=digits))


def fillets(stress: ShaftStress, units: Units = ENGINEERING) -> Table:
    """Return places, sizes and remarks of the fillets."""
    columns = [
        text("fillet", lambda notch: notch.name),
        quantity("y", "m", units, lambda notch: notch.y),
        quantity("radius", "m", units, lambda notch: notch.radius, 3),
        Column("r/d", lambda notch: notch.radius / notch.small, lambda v: plain(v, 3)),
        Column("D/d", lambda notch: notch.large / notch.small, lambda v: plain(v, 4)),
        text("to be known", lambda notch: notch.remark or None),
    ]
    note = "y: where the fillet meets its cylinder, with section forces and nominal stress there."
    return Table("Fillets", columns, stress.notches, note)


def surface_stress(
    stress: ShaftStress,
    open_: Mapping[str, tuple[float, float]],
    units: Units = ENGINEERING,
    open_by: str = "",
) -> Table:
    """Return stress on the fillets with error bars, and ranges of amplitudes by `open_by`, Pa."""
    columns = [
        text("fillet", lambda row: row[0].name),
        word("by", lambda row: row[1]),
        _stress("nominal", units, lambda row: getattr(row[0].nominal, row[1])),
        _stress("surface", units, lambda row: getattr(row[0].local, BY[row[1]])),
        _stress("error bar", units, lambda row: getattr(row[0].local, f"{BY[row[1]]}_bar"), 2),
    ]
    note = (
        "Surface: largest stress along the meridian: by bending the amplitude of the turning "
        "shaft, shear force included, so that it is not Kt times nominal; by tension and torsion "
        "(shear at the same place) a mean. Error bar: of the harmonic solid around the fillet."
    )
    if open_:
        columns.append(Column("range", partial(_open, open_, units)))
        note += f" Range: by {open_by} of the bearings."
    title = f"Stress on the fillets, {units.unit(STRESS)}"
    return Table(title, columns, _by_load(stress.notches), note)


def _open(
    open_: Mapping[str, tuple[float, float]], units: Units, row: tuple[Notch, str]
) -> str | None:
    if row[1] != "bending":
        return None
    low, high = (units.number(value, STRESS, 4) for value in open_[row[0].name])
    return f"{low} to {high}"


def form_factors(stress: ShaftStress) -> Table:
    """Return the form factors and fatigue notch factors of the fillets beside published ones."""

    def published(source: str) -> Column:
        def factor(row: tuple[Notch, str]) -> float | None:
            return row[0].published.get(source, {}).get(row[1])  # type: ignore[call-overload]

        return Column(source, factor, _factor)

    def fatigue(head: str, name: str) -> Column:
        def factor(row: tuple[Notch, str]) -> float | None:
            return getattr(row[0].fatigue[row[1]], name) if row[0].fatigue else None  # type: ignore[index]

        return Column(head, factor, _factor)

    sources = dict.fromkeys(source for notch in stress.notches for source in notch.published)
    columns = [
        text("fillet", lambda row: row[0].name),
        word("by", lambda row: row[1]),
        Column("Kt", lambda row: row[0].found.factors[row[1]].value, _factor),
        Column("error bar", lambda row: _bar(row[0], row[1])),
        *map(published, sources),
    ]
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
        columns += [fatigue("Kf", "notch"), fatigue("norm", "norm_notch")]
        note += (
            "Kf = Kt/n, the support number n by DIN 743-2 and the stress gradient of the solid; "
            "norm: that of its own factor and gradient."
        )
    return Table("Form factors", columns, _by_load(stress.notches), note.strip())


def _by_load(notches: Sequence[Notch]) -> list[tuple[Notch, str]]:
    return [(notch, load) for notch in notches for load in LOADS]


def _factor(value: float) -> str:
    return plain(value, 4)


def _bar(notch: Notch, load: str) -> str:
    factor = notch.found.factors[load]
    return percent(factor.bar / factor.value, signed=False)


def safeties(stress: ShaftStress) -> Table:
    """Return safeties of all fillets that are rated, the least first."""
    columns = [
        text("fillet", lambda notch: notch.name),
        Column("S, fatigue", lambda notch: safety(notch.rating.fatigue)),
        Column("less by the error bar", lambda notch: plain(notch.rating.fatigue_bar, 2)),
        Column("S, yielding", lambda notch: safety(notch.rating.yielding)),
    ]
    rows = [notch for notch in stress.worst if notch.rating is not None]
    note = (
        f"The norm asks for {LEAST:g} where loads and strength are known. Less by the error bar: "
        "loss of S with Kt at the upper end of its error bar."
    )
    return Table("Safety by DIN 743", columns, rows, note)


def rating(notch: Notch, units: Units = ENGINEERING) -> Table:
    """Return the rating of one fillet by DIN 743, every factor with its source."""
    assert notch.rating is not None
    record: Rating = notch.rating
    columns = [
        word("", lambda entry: entry.symbol),
        text("what", lambda entry: _named(entry, units)),
        *(Column(load, partial(_value, k, units)) for k, load in enumerate(LOADS)),
        text("source", _source),
    ]
    note = (
        f"Safety against fatigue {safety(record.fatigue)}, against yielding "
        f"{safety(record.yielding)}, by nominal stress without shear forces, as in the norm."
    )
    if record.assumed:
        note += f" Assumed, since not given: {', '.join(record.assumed)}."
    return Table(f"DIN 743 at {notch.name}", columns, list(record.entries), note)


def _named(entry: Entry, units: Units) -> str:
    unit = units.unit(STRESS) if entry.unit == "Pa" else "1/mm" if entry.unit else ""
    return f"{entry.what}, {unit}" if unit else entry.what


def _value(place: int, units: Units, entry: Entry) -> str | None:
    value = entry.values[place]
    if value is None:
        return None
    if entry.unit == "Pa":
        return units.number(value, STRESS, 4)
    return plain(1e-3 * value if entry.unit else value, 4)


def _source(entry: Entry) -> str | Cell:
    return Cell(entry.source, "mark assumed") if "assumed" in entry.source else entry.source


def safety(value: float) -> str:
    """Return a safety as text."""
    return plain(value, 3) if math.isfinite(value) else "endless"


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
    return out + [f"{remark}." for remark in stress.remarks]
