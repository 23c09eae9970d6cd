"""Help: commands by what they are for, and every word of it as it was written."""

from __future__ import annotations

import io
import re

import pytest
import typer
from command import command
from rich.console import Console

from solidgear.app import app
from solidgear.app.application import COMMANDS, GROUPS, _imported
from solidgear.show.command import Progress, console

#: what rich would take for markup
BRACKETS = re.compile(r"\[[^\[\]]+\]")


def test_help_groups_commands_in_the_order_of_the_work():
    told = command("--help").stdout
    heads = re.findall(r"^╭─ (.+?) ─", told, re.M)
    assert heads == ["Options", *GROUPS]
    panels = dict(zip(heads, told.split("╭─")[1:]))
    for group, commands in GROUPS.items():
        assert re.findall(r"^│ ([a-z]\S*)", panels[group], re.M) == list(commands)


@pytest.mark.parametrize("name", COMMANDS)
def test_help_loses_no_word_in_square_brackets(name):
    known = _imported(name)
    texts = [COMMANDS[name].help, *(getattr(option, "help", None) or "" for option in known.params)]
    words = {word for text in texts for word in BRACKETS.findall(text)}
    told = re.sub(r"[\s│]+", " ", command(name, "--help").stdout)
    assert {word for word in words if word not in told} == set()
    assert "\\[" not in told


def test_some_help_holds_square_brackets():
    """Or the test above proves nothing."""
    assert "[uncertain]" in str([option.help for option in _imported("identify").params[2:]])
    assert "[operation]" in COMMANDS["bearing"].help


def test_progress_on_a_terminal_prints_names_as_they_are(monkeypatch):
    screen = Console(file=io.StringIO(), force_terminal=True, markup=False, width=80)
    monkeypatch.setitem(Progress.__init__.__globals__, "console", lambda stderr: screen)
    with Progress() as progress:
        progress("bearing [front] of [/tmp/a]")
        assert "bearing [front] of [/tmp/a]" in progress.status.status.plain


def test_what_is_printed_keeps_its_square_brackets():
    screen = console()
    screen.file = io.StringIO()
    screen.print("[uncertain] of [/b]")
    assert screen.file.getvalue() == "[uncertain] of [/b]\n"


def test_help_is_the_same_when_it_is_asked_for_again():
    known = typer.main.get_command(app)
    first, again = (known.get_help(typer.Context(known)) for _ in range(2))
    assert first == again and command("bearing", "-h").stdout == command("bearing", "-h").stdout
