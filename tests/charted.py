"""Charts as tests look at them: the words of their marks and their texts."""

import html
import re

from solidgear.report.plot import Chart


def words_of(svg):
    """What is to be read off a drawing, a text a mark."""
    return [html.unescape(words) for words in re.findall(r' aria-label="([^"]*&#xA;[^"]*)"', svg)]


def facts_of(svg):
    """The same: name, and values by what they are."""
    lines = [words.split("\n") for words in words_of(svg)]
    return [(name, dict(fact.split(": ", 1) for fact in facts)) for name, *facts in lines]


def texts_of(chart):
    """Texts that are written in the panels of a chart, or in one."""
    panels = [p for row in chart.rows for p in row] if isinstance(chart, Chart) else [chart]
    rows = [row for p in panels for mark, rows, _ in p.layers for row in rows]
    return [row["text"] for row in rows if "text" in row]
