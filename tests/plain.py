"""What a report shows of plain results, as tests make them up."""

from pathlib import Path

from solidgear.comparison.page import html, sheet
from solidgear.comparison.recording import as_record
from solidgear.core.judge.record import Record

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
    return sheet.final_table(_record(results))


def verdict_text(results):
    return "\n".join(sheet.verdict_lines(_record(results)))
