"""Files of a deflection: lines, numbers, chart and page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from solidgear.report import deflection_tables as tables
from solidgear.report.deflection_chart import deflection_chart
from solidgear.report.sheet_files import write_files
from solidgear.report.table import Table
from solidgear.report.units import ENGINEERING, Units, units_named


def write_deflection(
    folder: Path,
    models: Mapping[str, Sequence[Any]],
    data: Mapping[str, Any],
    title: str,
    lead: str,
    told: Sequence[Table] = (),
    cautions: Sequence[str] = (),
    units: str | Units = ENGINEERING,
) -> list[Path]:
    """Write a deflection into a folder.

    Parameters
    ----------
    models : mapping of str to sequence of ShaftDeflection
        Shafts by model, the judge last.
    data : mapping
        Everything as plain data in SI, which becomes ``deflection.json``.
    told : sequence of Table
        Before those of displacements and bearings.
    units : str or Units
        Of chart and page.

    Returns
    -------
    list of Path
        ``deflection.html`` first, then a CSV a shaft with its line by the judge, the JSON, the chart.
    """
    shown = units_named(units)
    judge = list(models.values())[-1]
    charts = {"deflection": partial(deflection_chart, models, title, shown)}
    lines = {f"deflection_{shaft.name}": tables.line(shaft) for shaft in judge}
    return write_files(
        folder,
        "deflection",
        title,
        lead,
        [*told, *tables.bearings(judge, shown), tables.displacements(judge, shown)],
        data,
        lines=lines,
        charts=charts,
        cautions=cautions,
    )
