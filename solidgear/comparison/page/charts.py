"""The list of charts in the report: each an SVG in bytes, None where there is nothing to draw.

The same results give the same bytes. What draws them is imported when the first one is drawn: a
terminal run has no use for it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from solidgear.comparison.page.change_charts import attachment_chart, cause_chart
from solidgear.comparison.page.convergence_chart import convergence_chart
from solidgear.comparison.page.cost_chart import cost_chart
from solidgear.core import Record
from solidgear.show.mode_charts import mac_chart, mode_chart
from solidgear.show.plot import Chart, page_svg
from solidgear.show.sketch_page import sketch_svg
from solidgear.show.where_chart import where_chart
from solidgear.variants.budget.chart import of_record as budget_chart

#: those that are described in Vega-Lite, for a page of a width
DESCRIBED: dict[str, Callable[[Record, float], Chart | None]] = {
    "budget": budget_chart,
    "modes": mode_chart,
    "mac": mac_chart,
    "convergence": convergence_chart,
    "where": where_chart,
    "causes": cause_chart,
    "cost": cost_chart,
    "attachments": attachment_chart,
}


def _drawn(name: str, record: Record) -> bytes | None:
    """Return a chart for the page."""
    return page_svg(name, partial(DESCRIBED[name], record))


#: heading -> chart, in the order of the report; what each picture says in words is up to the page
CHARTS: dict[str, Callable[[Record], bytes | None]] = {
    "sketch": lambda record: sketch_svg("sketch", record.scene),
    **{name: partial(_drawn, name) for name in DESCRIBED},
}
