"""Tables of the local stress at grooves, keyways and cross holes by solids."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from solidgear.show.table import Cell, Column, Table, quantity, text, word
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.show.words import percent
from solidgear.strength.stress.din743 import LOADS
from solidgear.strength.stress.groove import GrooveFactors
from solidgear.strength.stress.solid_notches import SolidNotch

#: SI unit of a stress in tables
STRESS = "Pa stressed"


def solid_stress(notches: Sequence[SolidNotch], units: Units = ENGINEERING) -> Table:
    """Return nominal and local stress of notches with error bars."""
    columns = [
        text("notch"),
        quantity("y", "m", units),
        word("by"),
        *(
            Column(head, write=partial(units.number, si=STRESS, digits=digits), unit="Pa")
            for head, digits in (("nominal", 4), ("local", 4), ("error bar", 2))
        ),
        text("to be known"),
    ]
    rows: list[list[Any]] = []
    for notch in notches:
        nominal, local = notch.nominal, notch.local
        by_load = {
            "tension": (nominal.tension, local.mean, local.mean_bar),
            "bending": (nominal.bending, local.amplitude, local.amplitude_bar),
            "torsion": (nominal.torsion, local.shear, local.shear_bar),
        }
        for load in LOADS:
            remark = "; ".join(notch.remarks) if load == LOADS[0] else ""
            rows.append([notch.name, notch.y, load, *by_load[load], remark or None])
    note = (
        "Local: largest principal stress where that by bending and tension together is largest; by "
        "bending the amplitude of the turning shaft at its worst angle, by tension a mean; by "
        "torsion the largest shear there, a mean. Error bar: of the solid around the notch."
    )
    return Table(f"Local stress of notches, {units.unit(STRESS)}", columns, rows, note)


def solid_factors(notches: Sequence[SolidNotch]) -> Table:
    """Return form factors and stress gradients of notches with error bars."""
    rows = []
    for notch in notches:
        concentration = notch.factors
        section = (
            "the floor" if isinstance(concentration, GrooveFactors) else concentration.nominal.what
        )
        for load in LOADS:
            factor = concentration.factors[load]
            bars = [value / abs(of) for value, of in _bars(factor)]
            rows.append(
                [
                    notch.name,
                    load,
                    factor.value,
                    *(Cell(bar, "", percent(bar, signed=False)) for bar in bars[:1]),
                    1e-3 * factor.gradient,
                    *(Cell(bar, "", percent(bar, signed=False)) for bar in bars[1:]),
                    section,
                ]
            )
    columns = [
        text("notch"),
        word("by"),
        Column("Kt", write=partial(plain, digits=4)),
        Column("error bar"),
        Column("G', 1/mm", write=partial(plain, digits=3)),
        Column("bar of G'"),
        text("over the nominal stress of"),
    ]
    note = (
        "Kt: largest local stress of each load over its nominal stress, each at a place of its own; "
        "in torsion of keyways and holes the largest shear stress. G': relative stress gradient into "
        "the material."
    )
    return Table("Form factors of notches by solids", columns, rows, note)


def _bars(factor) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return error bars and section they are of."""
    return (factor.bar, factor.value), (factor.gradient_bar, factor.gradient)
