"""One sheet of a study: what the terminal, the page, files and JSON read from it."""

import json
from dataclasses import replace

import pytest
import typer

from solidgear.show.options import Run
from solidgear.show.sheet import Sheet, Terminal, present, print_sheet
from solidgear.show.table import Table

SHEET = Sheet(
    name="weight",
    title="Pinion: weight",
    lead="Of steel.",
    tables=[Table("Parts", ["part", "kg"], [("shaft", 4.25)]), Table("Nothing", ["part"], [])],
    data={"mass": 4.25},
    lines={"parts": Table("", ["part", "mass [kg]"], [("shaft", 4.25)])},
    headline="It weighs 4.25 ± 0.01 kg.",
    notes=["Without its key."],
    cautions=["the bore is a guess"],
)


def test_a_terminal_shows_a_sheet_from_its_title_to_its_cautions(capsys):
    print_sheet(SHEET)
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == ["Pinion: weight", "Of steel."]
    assert lines[-3:] == [
        "It weighs 4.25 +- 0.01 kg.",
        "Without its key.",
        "caution: the bore is a guess",
    ]
    assert "Nothing" not in lines  # a table without rows


def test_a_terminal_may_show_parts_in_other_words(capsys):
    print_sheet(replace(SHEET, terminal=Terminal(heading=["Weight"], tables=[], closing=[])))
    assert capsys.readouterr().out.splitlines() == ["Weight", "It weighs 4.25 +- 0.01 kg."]


def test_a_folder_holds_page_data_and_tables_of_a_sheet(capsys, tmp_path):
    out = tmp_path / "out"
    present(lambda progress: SHEET, Run(), out)
    assert sorted(path.name for path in out.iterdir()) == [
        "parts.csv",
        "weight.html",
        "weight.json",
    ]
    assert "weight.html" in capsys.readouterr().out.replace("\n", "")
    assert json.loads((out / "weight.json").read_text()) == SHEET.data
    page = (out / "weight.html").read_text()
    assert "Of steel. It weighs 4.25 ± 0.01 kg." in page and "the bore is a guess" in page


def test_json_is_the_data_alone_and_a_missed_tolerance_is_exit_code_3(capsys):
    with pytest.raises(typer.Exit) as left:
        present(lambda progress: replace(SHEET, reached=False), Run(as_json=True))
    assert left.value.exit_code == 3
    assert json.loads(capsys.readouterr().out) == SHEET.data
