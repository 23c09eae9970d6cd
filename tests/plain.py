"""What a report shows of plain results, as tests make them up."""

from pathlib import Path

from solidgear.comparison.page import html
from solidgear.core.judge.record import Record
from solidgear.show import terminal
from solidgear.show.border import as_record

#: a folder without a file
NOWHERE = Path("there is no such folder")


def _record(results):
    return results if isinstance(results, Record) else as_record(results)


def render_page(results, folder=NOWHERE, drawn=None):
    return html.render_page(_record(results), folder, drawn)


def write_report(results, folder):
    return html.write_report(_record(results), folder)


def drawn_charts(results):
    return html.drawn_charts(_record(results), NOWHERE)


def final_table(results):
    return terminal.final_table(_record(results))


def verdict_text(results):
    return terminal.verdict_text(_record(results))
