"""The list of charts in the report: each an SVG in bytes, None where there is nothing to draw.

The same results give the same bytes. What draws them is imported when the first one is drawn: a
terminal run has no use for it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from solidgear.judge.record import Record
from solidgear.report.border import as_record
from solidgear.report.budget_chart import of_record as budget_chart
from solidgear.report.change_charts import attachment_chart, cause_chart
from solidgear.report.convergence_chart import convergence_chart
from solidgear.report.cost_chart import cost_chart
from solidgear.report.mode_charts import mac_chart, mode_chart
from solidgear.report.plot import Chart, page_svg
from solidgear.report.sketch_page import sketch_svg
from solidgear.report.where_chart import where_chart

#: a chart of the report: from what a run found to an SVG
Drawing = Callable[[Record | Mapping[str, Any]], bytes | None]


def sketch(found: Record | Mapping[str, Any]) -> bytes | None:
    """The scene as a dimensioned section: shaft, seats, springs, lumped point."""
    return sketch_svg("sketch", as_record(found).scene)


def _drawn(name: str, make: Callable[..., Chart | None]) -> Drawing:
    """From a function that describes a chart to one that draws it."""

    def draw(found: Record | Mapping[str, Any]) -> bytes | None:
        record = as_record(found)
        return page_svg(name, lambda width: make(record, width))

    return draw


_DESCRIBED = {
    "budget": budget_chart,
    "modes": mode_chart,
    "mac": mac_chart,
    "convergence": convergence_chart,
    "where": where_chart,
    "causes": cause_chart,
    "cost": cost_chart,
    "attachments": attachment_chart,
}
#: heading -> chart, in the order of the report; what each picture says in words is up to the page
CHARTS: dict[str, Drawing] = {
    "sketch": sketch,
    **{name: _drawn(name, make) for name, make in _DESCRIBED.items()},
}
