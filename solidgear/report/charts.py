"""The list of charts in the report: each one SVG in bytes, None where there is nothing to draw.

They are drawn through figure objects, never through a display, and the same results give the same
bytes. matplotlib is imported when the first one is drawn: a terminal run has no use for it.
"""

from __future__ import annotations

from solidgear.report import sketch as scene_sketch
from solidgear.report.change_charts import attachment_chart, cause_chart
from solidgear.report.chart_style import Chart, as_svg
from solidgear.report.convergence_chart import convergence_chart
from solidgear.report.cost_chart import cost_chart
from solidgear.report.mode_charts import mac_chart, mode_chart
from solidgear.report.where_chart import where_chart


@as_svg
def sketch(record):
    """The scene as a dimensioned section: shaft, seats, springs, lumped point."""
    return scene_sketch.draw(record.scene)


#: heading -> chart, in the order of the report; what each picture says in words is up to the page
CHARTS: dict[str, Chart] = {
    "sketch": sketch,
    "modes": mode_chart,
    "mac": mac_chart,
    "convergence": convergence_chart,
    "where": where_chart,
    "causes": cause_chart,
    "cost": cost_chart,
    "attachments": attachment_chart,
}
