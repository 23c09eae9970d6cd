"""Decks (.inp, .bdf, .unv) with lines of elements and nodes that are lost, cut off or doubled."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import dataclass

#: endings of files that are read line by line
DECKS = ("inp", "bdf", "unv")


@dataclass(frozen=True)
class Format:
    """How a deck writes elements and nodes.

    Attributes
    ----------
    sign : str
        What makes a file a deck of this kind.
    element, node : Pattern
        The line that one begins in, with its number as the group.
    first_nodes : str
        Of the last line of an element, all up to some nodes, as a pattern to be given their count.
    tall, tall_node : int
        Lines of an element, and of a node.
    """

    sign: str
    element: re.Pattern
    node: re.Pattern
    first_nodes: str
    tall: int
    tall_node: int


_COORDINATE = r", *-?[\d.]+(?:e[+-]\d+)?"
FORMATS = (
    Format(
        "*ELEMENT",
        re.compile(r"(\d+)(?:, *\d+){4}$"),
        re.compile(rf"(\d+)(?:{_COORDINATE}){{3}}$"),
        r"\d+(?:, *\d+){%d}",
        1,
        1,
    ),
    Format(
        "BEGIN BULK",
        re.compile(r"CTETRA  (.{8})"),
        re.compile(r"GRID\*   (.{16})"),
        r".{24}(?:.{8}){%d}",
        1,
        2,
    ),
    Format(
        "  2412",
        re.compile(r"(.{10}) +111 "),
        re.compile(r"(.{10})(?: +\d+){2} +11$"),
        r"(?:.{10}){%d}",
        2,
        2,
    ),
)


class Deck:
    """The lines of a deck, and which of them elements and nodes begin in."""

    def __init__(self, text: str):
        self.lines = text.splitlines(keepends=True)
        self.format = next(f for f in FORMATS if f.sign in text)
        sets = [k for k, line in enumerate(self.lines) if line.startswith("*ELSET")]
        body = [line.rstrip() for line in self.lines[: sets[0] if sets else None]]
        self.nodes = [k for k, line in enumerate(body) if self.format.node.match(line)]
        self.elements = [k for k, line in enumerate(body) if self.format.element.match(line)]

    def without(self, places: list[int], tall: int) -> str:
        """The text without some elements or nodes."""
        gone = {k + i for k in places for i in range(tall)}
        return "".join(line for k, line in enumerate(self.lines) if k not in gone)

    def with_lines(self, place: int, lines: list[str], instead_of: int = 0) -> str:
        """The text with lines put in at a place, instead of some or of none."""
        return "".join([*self.lines[:place], *lines, *self.lines[place + instead_of :]])

    def numbered(self, pattern: re.Pattern, place: int, number: str) -> str:
        """The line at a place with another number, in a field as wide as it was."""
        line = self.lines[place]
        match = pattern.match(line.rstrip())
        assert match is not None
        field = match[1]
        width = len(field) if " " in field else 0
        new = number.rjust(width) if field.startswith(" ") else number.ljust(width)
        return line[: match.start(1)] + new + line[match.end(1) :]


def elements_lost(text: str, dice: random.Random) -> str:
    """Some lines of elements are missing, the first and the last not among them."""
    deck = Deck(text)
    places = dice.sample(deck.elements[1:-1], dice.choice((1, 1, 2, 5, 12)))
    return deck.without(places, deck.format.tall)


def block_cut_off(text: str, dice: random.Random) -> str:
    """A block of elements ends early."""
    deck = Deck(text)
    keep = dice.randrange(len(deck.elements) * 97 // 100)
    return deck.without(deck.elements[keep:], deck.format.tall)


def element_cut_short(text: str, dice: random.Random) -> str:
    """An element has fewer nodes than its type."""
    deck = Deck(text)
    last = dice.choice(deck.elements) + deck.format.tall - 1
    kept = re.match(deck.format.first_nodes % dice.randrange(1, 4), deck.lines[last])
    assert kept is not None
    return deck.with_lines(last, [kept[0] + "\n"], 1)


def element_number_twice(text: str, dice: random.Random) -> str:
    """Two elements have one number."""
    deck = Deck(text)
    a, b = dice.sample(deck.elements, 2)
    match = deck.format.element.match(deck.lines[a].rstrip())
    assert match is not None
    changed = deck.numbered(deck.format.element, b, match[1].strip())
    return deck.with_lines(b, [changed], 1)


def spare_node(text: str, dice: random.Random) -> str:
    """A node that no element names."""
    deck = Deck(text)
    place = dice.choice(deck.nodes)
    head = deck.numbered(deck.format.node, place, str(dice.randrange(900000, 999999)))
    return deck.with_lines(place, [head, *deck.lines[place + 1 : place + deck.format.tall_node]])


def node_lost(text: str, dice: random.Random) -> str:
    """A node that elements name is missing."""
    deck = Deck(text)
    return deck.without([dice.choice(deck.nodes)], deck.format.tall_node)


def node_elsewhere_again(text: str, dice: random.Random) -> str:
    """A node is there twice, at two places."""
    deck = Deck(text)
    a, b = dice.sample(deck.nodes, 2)
    match = deck.format.node.match(deck.lines[a].rstrip())
    assert match is not None
    head = deck.numbered(deck.format.node, b, match[1].strip())
    return deck.with_lines(b, [head, *deck.lines[b + 1 : b + deck.format.tall_node]])


def ends_in_an_element(text: str, dice: random.Random) -> str:
    """The file ends in the middle of the line of an element."""
    deck = Deck(text)
    later = deck.elements[len(deck.elements) // 2 :]
    place = dice.choice(later) + deck.format.tall - 1
    line = deck.lines[place].rstrip()
    return "".join(deck.lines[:place]) + line[: dice.randrange(len(line) // 2, len(line))]


DECK_CHANGES: tuple[Callable[[str, random.Random], str], ...] = (
    elements_lost,
    block_cut_off,
    element_cut_short,
    element_number_twice,
    spare_node,
    node_lost,
    node_elsewhere_again,
    ends_in_an_element,
)
