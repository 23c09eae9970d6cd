"""Charts as tests look at them: the words of their marks and their texts; cases of a small race."""

import html
import re

from solidgear.comparison.race.race import Row
from solidgear.show.plot import Chart

SETUP = {"numpy and scipy": 0.5, "gmsh, first use": 0.1}


def few(scene=None, full=False):
    """Cases of a race: one that fails, and the last better than the bar of a light reference."""
    coarse = {"order": 2, "layers": 0, "edge_layers": 0, "refinement": 0.5}
    fine = {"order": 4, "layers": 2, "edge_layers": 1}
    return [
        Row("lumped", "lumped", 1, "lumped", {}),
        Row("beam", "Timoshenko", 1, "timoshenko", {"elements": 1}),
        Row("harmonic", "harmonic h uniform", 1, "harmonic", coarse),
        Row("harmonic", "harmonic p graded", 1, "harmonic", {"order": 99}),
        Row("harmonic", "harmonic p graded", 2, "harmonic", fine),
    ]


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
