"""The command in this process, and what it leaves: tables and JSON."""

import csv
import json
import re

from typer.testing import CliRunner

from solidgear.app import app


def command(*words, **how):
    """Run `solidgear` with these words: exit code, output and exception."""
    return CliRunner().invoke(app, [str(word) for word in words], **how)


def table(path):
    """Rows of a CSV file by the names of its columns."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def numbers(path):
    """The same, numbers as numbers."""
    return [{name: _plain(text) for name, text in row.items()} for row in table(path)]


def _plain(text):
    try:
        return float(text)
    except ValueError:
        return text


def strict(text):
    """JSON as the standard has it: no NaN, no infinity."""

    def refuse(word):
        raise AssertionError(f"{word} is not JSON")

    return json.loads(text, parse_constant=refuse)


def page_of(folder, told, sentences):
    """The page of a folder and its text: it needs no other file and says all sentences, and what is
    stored beside it is what was told.
    """
    stored = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert set(stored.pop("files")) | {"results.json"} == {p.name for p in folder.iterdir()}
    assert stored == told
    page = (folder / "report.html").read_text(encoding="utf-8")
    text = " ".join(re.sub(r"<[^>]+>", " ", page).split())
    for sentence in sentences:
        assert " ".join(sentence.split()) in text
    assert not re.findall(r'(?:src|href|xlink:href)="(?!#|data:)([^"]*)"', page)
    return page, text
