"""A campaign as an object: what it draws, what it asks of each body, and how its table is parted."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from solidgear.core.scene import Scene
from validation.campaign.rows import Found
from validation.campaign.table import Parts
from validation.campaign.truths.kept import Truths


@dataclass(frozen=True)
class Run:
    """Means of a campaign at one body.

    Attributes
    ----------
    given : Namespace
        Options.
    folder : Path
        Where what is costly is kept.
    call : callable
        Of a function and its arguments, in a process of its own: what it gave, and why nothing.
    tell : callable
        Takes a sentence on what could not be judged.
    """

    given: argparse.Namespace
    folder: Path
    call: Callable[..., tuple[Any, str]]
    tell: Callable[[str], None]

    def found(self, body: str, function: Callable[..., Found], *arguments: Any) -> Found:
        """Judgement that a function gives in a process of its own, or why it gave none."""
        found, problem = self.call(function, *arguments)
        return Found(problems=[f"{body}: {problem}"]) if problem else found

    def truths(self, scene: Scene, *limits: int) -> Truths:
        """References of a shaft of revolution; limits are unknowns of the spectral levels."""
        kept = self.folder / "references"
        return Truths(scene, kept, self.call, limits, self.given.seconds, self.tell)


class Case:
    """A campaign.

    Attributes
    ----------
    name : str
    question : str
    parts, details : sequence of tuple of str
        Tags by which its table is parted; of details the scoreboard has none.
    tag_of_costs : str
    widths : bool
        Bars are what the program says; else they are limits, of whose width nothing is to be told.
    singly : bool
        Rows that do not hold are named one by one; else failures alone are.
    seeds : (int, int)
        First and last, if none are given.
    seconds : float
        Longest that one call may take.
    """

    name: str
    question: str
    parts: Parts = ((),)
    details: Parts = ()
    tag_of_costs: str = "tolerance"
    widths: bool = True
    singly: bool = True
    seeds: tuple[int, int] = (1, 20)
    seconds: float = 600.0

    def options(self, parser: argparse.ArgumentParser) -> None:
        """Add options of its own."""

    def bodies(self, given: argparse.Namespace) -> list[tuple]:
        """Bodies, each as the arguments of `judge` after the first."""
        first, last = given.seeds
        return [(seed,) for seed in range(first, last + 1)]

    def judge(self, run: Run, *body: Any) -> Found:
        """Hold what the program says of one body against the truth."""
        raise NotImplementedError

    def asked(self, given: argparse.Namespace) -> str:
        """The bodies of a run in a few words, and what was asked for beside the usual."""
        first, last = given.seeds
        own = argparse.ArgumentParser()
        self.options(own)
        usual = vars(own.parse_args([]))
        changed = {k: v for k, v in vars(given).items() if k in usual and v != usual[k]}
        return ", ".join([f"seeds {first} to {last}", *(_told(*one) for one in changed.items())])


def _told(option: str, value: Any) -> str:
    if value is True:
        return option
    values = value if isinstance(value, list) else [value]
    return f"{option} {' '.join(map(str, values))}"
