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
    folder: Path, stressed: StressAtRest, lead: str, units: Units = ENGINEERING
) -> list[Path]:
    """Write ``stress.html``, section forces as CSV, JSON and charts; `lead` names the loads."""
    lines: dict[str, Table] = {}
    charts: dict[str, Make] = {}
    for shaft in stressed.shafts:
        name = f"section_forces_{re.sub(r'[^A-Za-z0-9_-]', '_', shaft.name)}"
        lines[name] = tables.components(shaft.found.forces)
        title = f"Section forces, {shaft.name}" if len(stressed.shafts) > 1 else "Section forces"
        charts[name] = partial(section_chart, shaft.found.forces, title, units)
    return write_files(
        folder,
        "stress",
        f"{stressed.title}: stress",
        f"{lead} {headline(stressed, units)}".strip(),
        [table for shaft in stressed.shafts for table in shaft_tables(stressed, shaft, units)],
        stressed.as_dict(),
        lines=lines,
        charts=charts,
        notes=sentences(stressed, units),
        cautions=stressed.cautions,
    )


def shaft_tables(
    stressed: StressAtRest, shaft: StressedShaft, units: Units = ENGINEERING, every: bool = True
) -> list[Table]:
    """Return tables of one shaft without empty ones; ratings of `every` fillet or of the worst."""
    stress = shaft.found
    rated = [notch for notch in stress.worst if notch.rating is not None]
    out = [
        tables.section_forces(stress.forces, units, shaft.open_moment, stressed.open_by),
        tables.nominal_stress(stress, units),
        tables.fillets(stress, units),
        tables.surface_stress(stress, shaft.open, units, stressed.open_by),
        tables.form_factors(stress),
        tables.safeties(stress),
        *(tables.rating(notch, units) for notch in rated[: None if every else 1]),
    ]
    if len(stressed.shafts) > 1:
        for table in out:
            table.title = f"{table.title}, {shaft.name}"
    return [table for table in out if table]


def headline(stressed: StressAtRest, units: Units = ENGINEERING) -> str:
    """Return the sentence on the worst fillet of all shafts; empty where none has one."""
    worst = [(shaft, shaft.found.worst[0]) for shaft in stressed.shafts if shaft.found.notches]
    if not worst:
        return ""
    shaft, notch = min(worst, key=lambda pair: pair[1].severity)
    value, bar = (
        units.number(stress, tables.STRESS, digits)
        for stress, digits in ((notch.local.amplitude, 4), (notch.local.amplitude_bar, 2))
    )
    place = f"{shaft.name}, {notch.name}" if len(stressed.shafts) > 1 else notch.name
    sentence = f"Worst at {place}: {value} ± {bar} {units.unit(tables.STRESS)} by bending"
    if notch.rating is not None:
        fatigue, yielding = map(tables.safety, (notch.rating.fatigue, notch.rating.yielding))
        sentence += f", safety {fatigue} against fatigue and {yielding} against yielding by DIN 743"
    return f"{sentence}."


def sentences(stressed: StressAtRest, units: Units = ENGINEERING) -> list[str]:
    """Return sentences on the shafts: places without a stress, and what was left out."""
    out = []
    for shaft in stressed.shafts:
        lead = f"{shaft.name}: " if len(stressed.shafts) > 1 else ""
        remarks = tables.remarks(shaft.found, units)
        if not shaft.found.notches:
            remarks.insert(0, "no shoulder has a fillet, so there is no stress on one.")
        if shaft.weak:
            names = ", ".join(f'"{name}"' for name in shaft.weak)
            remarks.append(
                f"not rated: the material of {names} has no strength; write strength = {{ "
                'yield_point = "700 MPa", ultimate = "1000 MPa" } beside E, nu and density.'
            )
        out += [lead + remark for remark in remarks]
    return [*out, ELASTIC]


#: what holds of all of it
ELASTIC = "Linear elastic; no stress at keyways, teeth and press fits, and no residual stress."
