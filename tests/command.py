"""The command in this process, and what it leaves: tables and JSON."""

import csv
import json

from typer.testing import CliRunner

from solidgear.cli import app


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
