"""Files of the stress of shafts at rest: a page, numbers, and a chart of section forces a shaft."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from solidgear.show.plot import Make
from solidgear.show.sheet_files import write_files
from solidgear.show.table import Table
from solidgear.show.units import ENGINEERING, Units
from solidgear.strength.stress import tables
from solidgear.strength.stress.section_chart import section_chart

if TYPE_CHECKING:
    from solidgear.strength.stress.at_rest import StressAtRest, StressedShaft


def write_stress(
    folder: Path, found: StressAtRest, lead: str, units: Units = ENGINEERING
) -> list[Path]:
    """Write the stress of shafts into a folder: ``stress.html``, then a CSV of section forces a
    shaft, the JSON, and the charts; `lead` says under what they are loaded.
    """
    lines: dict[str, Table] = {}
    charts: dict[str, Make] = {}
    for shaft in found.shafts:
        name = f"section_forces_{re.sub(r'[^A-Za-z0-9_-]', '_', shaft.name)}"
        lines[name] = tables.components(shaft.found.forces)
        title = f"Section forces, {shaft.name}" if len(found.shafts) > 1 else "Section forces"
        charts[name] = partial(section_chart, shaft.found.forces, title, units)
    return write_files(
        folder,
        "stress",
        f"{found.title}: stress",
        f"{lead} {headline(found, units)}".strip(),
        [table for shaft in found.shafts for table in shaft_tables(found, shaft, units)],
        found.as_dict(),
        lines=lines,
        charts=charts,
        notes=sentences(found, units),
        cautions=found.cautions,
    )


def shaft_tables(
    found: StressAtRest, shaft: StressedShaft, units: Units = ENGINEERING, every: bool = True
) -> list[Table]:
    """Tables of one shaft, those without a row left out; the rating of every fillet or that of the
    worst alone.
    """
    own = shaft.found
    rated = [notch for notch in own.worst if notch.rating is not None]
    out = [
        tables.section_forces(own.forces, units, shaft.open_moment, found.open_by),
        tables.nominal_stress(own, units),
        tables.fillets(own, units),
        tables.surface_stress(own, shaft.open, units, found.open_by),
        tables.form_factors(own),
        tables.safeties(own),
        *(tables.rating(notch, units) for notch in rated[: None if every else 1]),
    ]
    if len(found.shafts) > 1:
        for table in out:
            table.title = f"{table.title}, {shaft.name}"
    return [table for table in out if table]


def headline(found: StressAtRest, units: Units = ENGINEERING) -> str:
    """Sentence on the worst fillet of all shafts; empty where none has one."""
    worst = [(shaft, shaft.found.worst[0]) for shaft in found.shafts if shaft.found.notches]
    if not worst:
        return ""
    shaft, notch = min(worst, key=lambda pair: pair[1].severity)
    value, bar = (
        units.number(stress, tables.STRESS, digits)
        for stress, digits in ((notch.local.amplitude, 4), (notch.local.amplitude_bar, 2))
    )
    where = f"{shaft.name}, {notch.name}" if len(found.shafts) > 1 else notch.name
    told = f"Worst at {where}: {value} ± {bar} {units.unit(tables.STRESS)} by bending"
    if notch.rating is not None:
        fatigue, yielding = map(tables.safety, (notch.rating.fatigue, notch.rating.yielding))
        told += f", safety {fatigue} against fatigue and {yielding} against yielding by DIN 743"
    return f"{told}."


def sentences(found: StressAtRest, units: Units = ENGINEERING) -> list[str]:
    """Sentences on the shafts: places without a stress, and what was left out."""
    out = []
    for shaft in found.shafts:
        lead = f"{shaft.name}: " if len(found.shafts) > 1 else ""
        told = tables.remarks(shaft.found, units)
        if not shaft.found.notches:
            told.insert(0, "no shoulder has a fillet: there is no stress to be told of any.")
        if shaft.weak:
            names = ", ".join(f'"{name}"' for name in shaft.weak)
            told.append(
                f"not rated: the material of {names} has no strength; write it beside E, nu and "
                'density as strength = { yield_point = "700 MPa", ultimate = "1000 MPa" }.'
            )
        out += [lead + one for one in told]
    return [*out, ELASTIC]


#: what holds of all of it
ELASTIC = "Linear elastic; no stress at keyways, teeth and press fits, and no residual stress."
