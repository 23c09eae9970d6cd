"""The command in this process, and what it leaves: tables and JSON."""

import csv
import json
import re
from functools import cache

from jsonschema import Draft7Validator
from typer.testing import CliRunner

from solidgear.app import app
from solidgear.core.registry import registered
from solidgear.show.schema.results import schema_of_command


def command(*words, **how):
    """Run `solidgear` with these words: exit code, output and exception. JSON has its schema."""
    words = [str(word) for word in words]
    result = CliRunner().invoke(app, words, **how)
    hold_to_schema(words, result.stdout)
    return result


def hold_to_schema(words, text):
    """Hold JSON that a command printed against its schema; nothing where it printed none."""
    name = next((word for word in words if not word.startswith("-")), "")
    if "--json" in words and name in registered("printed") and text.startswith("{"):
        assert against_schema(name, text) == []


@cache
def _validator(name):
    return Draft7Validator(schema_of_command(name))


def against_schema(name, text):
    """What the schema of a command says against JSON that it printed: places and sentences."""
    lines = [line for line in text.splitlines() if line.startswith("{")]
    errors = _validator(name).iter_errors(json.loads(lines[-1]))
    return [(".".join(map(str, e.absolute_path)), e.message[-300:]) for e in errors]


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
