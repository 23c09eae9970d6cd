"""Tables of the stress of a shaft: section forces, nominal stress, fillets, and their rating."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from solidgear.report.table import Cell, Column, Table, quantity, text, word
from solidgear.report.units import ENGINEERING, Units, plain
from solidgear.report.words import percent

if TYPE_CHECKING:
    from solidgear.studies.stress.notch import Factor
    from solidgear.studies.stress.rating import Entry, Rating
    from solidgear.studies.stress.section_forces import SectionForces
    from solidgear.studies.stress.shaft import Notch, ShaftStress

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
    "What the part beyond a cut exerts on the part before it, along the axes; M_x and M_z about "
    "the middle of the section. Exact statics; loads act at the middle of what carries them."
)
LOADS = ("tension", "bending", "torsion")


def section_forces(forces: SectionForces, units: Units = ENGINEERING) -> Table:
    """Section forces just before and beyond every place where something acts."""
    rows = []
    for y, name, left, right in zip(forces.y, forces.names, forces.left, forces.right):
        for where, six in (("before", left), ("beyond", right)):
            rows.append((float(y), name, where, *map(float, six)))
    columns = [
        quantity("y", "m", units, lambda row: row[0]),
        text("acts there", lambda row: row[1]),
        word("side", lambda row: row[2]),
        *(
            quantity(head, si, units, lambda row, at=3 + k: row[at])  # type: ignore[misc]
            for head, k, si in COMPONENTS
        ),
    ]
    return Table("Section forces", columns, rows, CONVENTION)


def nominal_stress(found: ShaftStress, units: Units = ENGINEERING) -> Table:
    """Nominal stress on both sides of every load and joint."""
    columns = [
        quantity("y", "m", units, lambda row: row.y),
        text("in", lambda row: row.segment),
        quantity("outside", "m", units, lambda row: 2 * row.section.outer),
        quantity("bore", "m", units, lambda row: 2 * row.section.inner),
        quantity("sigma_N, mean", STRESS, units, lambda row: row.stress.tension),
        quantity("sigma_b, amplitude", STRESS, units, lambda row: row.stress.bending),
        quantity("tau_t, mean", STRESS, units, lambda row: row.stress.torsion),
        quantity("tau_q", STRESS, units, lambda row: row.stress.shear),
    ]
    note = (
        "Plain sections: N/A, M a/I, T a/(2 I). The shaft turns under loads at rest: bending is an "
        "amplitude of every point of the surface, the rest a mean. tau_q is that at the neutral axis."
    )
    rows = [row for row in found.nominal if row.forces.any()]
    return Table("Nominal stress", columns, rows, note)


def fillets(found: ShaftStress, units: Units = ENGINEERING) -> Table:
    """Form factors of the fillets, and the stress that the loads make there."""

    def factor(load: str) -> Column:
        return Column(
            f"Kt {load}", lambda notch: _with_bar(notch.found.factors[load]), kind="number"
        )

    columns = [
        text("fillet", lambda notch: notch.name),
        quantity("y", "m", units, lambda notch: notch.y),
        quantity("radius", "m", units, lambda notch: notch.radius, 3),
        Column("r/d", lambda notch: notch.radius / notch.small, lambda v: plain(v, 3)),
        Column("D/d", lambda notch: notch.large / notch.small, lambda v: plain(v, 4)),
        *map(factor, LOADS),
        quantity("amplitude", STRESS, units, lambda notch: notch.local.amplitude, 4),
        quantity("mean", STRESS, units, lambda notch: notch.local.mean, 4),
        quantity("shear, mean", STRESS, units, lambda notch: notch.local.shear, 4),
    ]
    note = (
        "Kt: largest surface stress over nominal stress of the section where the fillet meets its "
        "cylinder, by the harmonic solid of this shaft around it. Stress along the meridian where it "
        "is largest: amplitude by bending, mean by axial force, shear by torque."
    )
    told = [f"{notch.name}: {notch.remark}." for notch in found.notches if notch.remark]
    told += [f"y = {units.text(y, 'm')}: {why}." for y, why in found.sharp]
    told += [f"{remark}." for remark in found.remarks]
    return Table("Fillets", columns, found.notches, " ".join([note, *told]))


def _with_bar(factor: Factor) -> str:
    return f"{plain(factor.value, 4)} ± {percent(factor.bar / factor.value, signed=False)}"


def fatigue_notches(found: ShaftStress) -> Table:
    """Fatigue notch factors of the fillets beside those of the norm's formulas."""
    rows = [(notch, load) for notch in found.notches for load in LOADS if notch.fatigue]
    columns = [
        text("fillet", lambda row: row[0].name),
        word("load", lambda row: row[1]),
        *(
            Column(head, lambda row, name=name: _of(row, name), lambda v: plain(v, 4))  # type: ignore[misc]
            for head, name in (
                ("Kt", "form"),
                ("alpha, norm", "norm_form"),
                ("n", "support"),
                ("Kf", "notch"),
                ("beta, norm", "norm_notch"),
            )
        ),
        Column("G', 1/mm", lambda row: 1e-3 * _of(row, "gradient"), lambda v: plain(v, 4)),
        Column("G' norm", lambda row: 1e-3 * _of(row, "norm_gradient"), lambda v: plain(v, 4)),
    ]
    note = (
        "Kf = Kt / n with n by DIN 743-2 and the stress gradient G' of the solid; beside them the "
        "norm's own form factor, gradient and result."
    )
    return Table("Fatigue notch factors", columns, rows, note)


def _of(row: tuple[Notch, Any], name: str) -> float:
    return getattr(row[0].fatigue[row[1]], name)


def rating(notch: Notch, units: Units = ENGINEERING) -> Table:
    """Rating of one fillet by DIN 743, every factor with its source.

    Parameters
    ----------
    notch : Notch
        With a rating.
    units : Units
    """
    assert notch.rating is not None
    found: Rating = notch.rating
    columns = [
        word("", lambda entry: entry.symbol),
        text("what", lambda entry: _named(entry, units)),
        *(
            Column(load, lambda entry, at=k: _value(entry, at, units), kind="number")  # type: ignore[misc]
            for k, load in enumerate(LOADS)
        ),
        text("source", lambda entry: _source(entry)),
    ]
    rows = list(found.entries)
    safety = (
        f"Safety against fatigue {_safety(found.fatigue)} (the bar of Kt takes up to "
        f"{plain(found.fatigue_bar, 2)}), against yielding {_safety(found.yielding)}; the norm asks "
        "for 1.2 where loads and strength are sure."
    )
    assumed = f" Assumed, for nobody gave it: {', '.join(found.assumed)}." if found.assumed else ""
    return Table(f"DIN 743 at {notch.name}", columns, rows, safety + assumed)


def _named(entry: Entry, units: Units) -> str:
    unit = units.unit(STRESS) if entry.unit == "Pa" else "1/mm" if entry.unit else ""
    return f"{entry.what}, {unit}" if unit else entry.what


def _value(entry: Entry, at: int, units: Units) -> str | None:
    value = entry.values[at]
    if value is None:
        return None
    if entry.unit == "Pa":
        return units.number(value, STRESS, 4)
    return plain(1e-3 * value if entry.unit else value, 4)


def _source(entry: Entry) -> str | Cell:
    return Cell(entry.source, "mark assumed") if "assumed" in entry.source else entry.source


def _safety(value: float) -> str:
    return plain(value, 3) if math.isfinite(value) else "without end: no load"
