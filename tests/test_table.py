"""One table says the same to every reader, each in the manner of its medium."""

from __future__ import annotations

import csv
import io
import re

import pytest
from rich.console import Console

from solidgear.show.matrices import block
from solidgear.show.table import Cell, Column, Table, quantity, text
from solidgear.show.units import ENGINEERING, SI
from solidgear.show.words import plus_minus

#: a name that rich would take for markup and a page for a tag; a number of five digits in groups
ROWS = [("[red]<b>", 4.7105e10, 0.012), ("none – µ", None, float("nan"))]
TABLE = Table(
    "K & bars",
    [
        text("model", lambda row: row[0]),
        quantity("K", "N/m", ENGINEERING, lambda row: row[1]),
        Column("bar", lambda row: Cell(row[2], "quiet"), plus_minus),
    ],
    ROWS,
    note="of “one” mesh",
)


def in_terminal(table):
    console = Console(width=80, file=io.StringIO(), color_system=None)
    console.print(table)
    return console.file.getvalue()


def test_a_terminal_gets_ascii_and_names_as_they_are():
    lines = [line.split() for line in in_terminal(TABLE).splitlines()]
    assert ["model", "K,", "N/um", "bar"] in lines
    assert ["[red]<b>", "47105", "+-", "1.20", "%"] in lines
    assert ["none", "-", "u", "-", "-"] in lines


def test_a_page_gets_groups_of_digits_classes_and_no_markup_from_names():
    page = TABLE._repr_html_()
    cells = re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", page)
    assert cells[3:6] == ["[red]&lt;b&gt;", "47\u00a0105", "± 1.20 %"]
    assert cells[6:] == ["none – µ", "–", "–"]
    assert "K &amp; bars" in page and '<td class="quiet">± 1.20 %' in page


def test_a_file_gets_nothing_for_what_is_not_there(tmp_path):
    told = TABLE.write(tmp_path / "table.csv").read_text(encoding="utf-8")
    head, first, second = csv.reader(io.StringIO(told))
    assert head == ["model", "K, N/µm", "bar"] and first[0] == "[red]<b>"
    assert second == ["none – µ", "", ""]


@pytest.mark.parametrize("units", [ENGINEERING, SI])
def test_a_6x6_has_a_unit_over_each_block_in_every_medium(units):
    matrix = [[1e9 if i == j else 0.0 for j in range(6)] for i in range(6)]
    matrix[2][3] = 1.0
    table = block(matrix, "stiffness", units, "stiffness", free=["thy"])
    over = [found for found, _ in table.blocks]
    assert over == [
        tuple(map(units.unit, pair)) for pair in (("N/m", "N/rad"), ("N/rad", "N m/rad"))
    ]
    assert re.findall(r'<td colspan="3">(.*?)</td>', table._repr_html_()) == [*over[0], *over[1]]
    assert [cell.value for cell in table.cells[4][1:]] == ["–"] * 6
    # a millionth of a millionth of the diagonal: grey, and without digits where there are no exponents
    assert table.cells[2][4][:2] == ("1.0000" if units is SI else "0", "faint")
    lines = in_terminal(table).splitlines()
    assert [len(line.split()) for line in lines if line.startswith((" x", " thx"))] == [7, 7]


@pytest.mark.parametrize("width", [120, 60, 46, 20])
def test_no_terminal_is_too_narrow_for_a_number(width):
    """Heads and texts take more lines, columns move together; a wider table runs over."""
    heads = [text("at"), *(Column(f"across the plane {k}, urad") for k in range(4))]
    rows = [
        ("a point with a long name (115 N m)", "-93.41", "0.573 to 3.44", "± 0.022 %", "1.25e-12")
    ]
    console = Console(width=width, file=io.StringIO(), color_system=None)
    console.print(Table("lies", heads, rows), crop=False)
    told = console.file.getvalue()
    assert "…" not in told and "..." not in told
    for number in ("-93.41", "0.573 to 3.44", "+- 0.022 %", "1.25e-12"):
        assert number in told
    if width >= 60:
        assert max(map(len, told.splitlines())) <= width


@pytest.mark.parametrize("style", ["bare", "ruled", ""])
def test_numbers_beside_each_other_never_run_together(style):
    heads = [text("shafts"), text("jump up, Hz"), text("jump down, Hz")]
    heads += [Column(f"quantity {k}, Hz") for k in range(5)]
    row = ("input lumped, middle harmonic", "-", "-", "546.6", "2182.8", "545.4", "2179.5", "67.85")
    told = in_terminal(Table("Jumps", heads, [row], style=style))
    assert set(row[3:]) <= set(re.split(r"[\s│]+", told))
    assert max(map(len, told.splitlines())) <= 80
