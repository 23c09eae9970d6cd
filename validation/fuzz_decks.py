"""Decks (.inp, .bdf, .unv) with lines of elements and nodes that are lost, cut off or doubled."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

#: endings of files that are read line by line
DECKS = ("inp", "bdf", "unv")
#: how a line of an element begins, by what makes a file a deck of that kind
ELEMENT = {
    "*ELEMENT": re.compile(r"\d+(, *\d+){4}$"),
    "BEGIN BULK": re.compile(r"CTETRA "),
    "  2412": re.compile(r" +\d+ +111 "),
}
NODE = {
    "*ELEMENT": re.compile(r"\d+(, *-?[\d.]+(?:e[+-]\d+)?){3}$"),
    "BEGIN BULK": re.compile(r"GRID\*"),
    "  2412": re.compile(r"(?: +\d+){3} +11$"),
}
#: lines of an element, and of a node
TALL = {"*ELEMENT": (1, 1), "BEGIN BULK": (1, 2), "  2412": (2, 2)}


class Lines:
    """The lines of a deck, and which of them elements and nodes begin in."""

    def __init__(self, text: str):
        self.all = text.splitlines(keepends=True)
        self.kind = next(kind for kind in ELEMENT if kind in text)
        last = len(self.all)
        if self.kind == "*ELEMENT":
            sets = [k for k, line in enumerate(self.all) if line.startswith("*ELSET")]
            last = sets[0] if sets else last
        body = [(k, line.rstrip()) for k, line in enumerate(self.all[:last])]
        self.nodes = [k for k, line in body if NODE[self.kind].match(line)]
        self.elements = [k for k, line in body if ELEMENT[self.kind].match(line)]
        self.tall, self.tall_node = TALL[self.kind]

    def without(self, places: list[int], tall: int) -> str:
        """The text without some of them."""
        gone = {k + i for k in places for i in range(tall)}
        return "".join(line for k, line in enumerate(self.all) if k not in gone)

    def written(self, place: int, lines: list[str]) -> str:
        """The text with other lines from a place on."""
        out = list(self.all)
        out[place : place + len(lines)] = lines
        return "".join(out)


def elements_lost(text: str, dice: random.Random) -> str:
    """Some lines of elements are missing, the first and the last not among them."""
    lines = Lines(text)
    places = dice.sample(lines.elements[1:-1], dice.choice((1, 1, 2, 5, 12)))
    return lines.without(places, lines.tall)


def block_cut_off(text: str, dice: random.Random) -> str:
    """A block of elements ends early."""
    lines = Lines(text)
    keep = dice.randrange(len(lines.elements) * 97 // 100)
    return lines.without(lines.elements[keep:], lines.tall)


def element_cut_short(text: str, dice: random.Random) -> str:
    """An element has fewer nodes than its type."""
    lines = Lines(text)
    place = dice.choice(lines.elements)
    own = lines.all[place : place + lines.tall]
    last = own[-1].rstrip()
    if lines.kind == "*ELEMENT":
        last = ",".join(last.split(",")[: -dice.randrange(1, 4)])
    elif lines.kind == "BEGIN BULK":
        last = last[: 24 + 8 * dice.randrange(1, 4)]
    else:
        last = last[: 10 * dice.randrange(1, 4)]
    return lines.written(place, [*own[:-1], last + "\n"])


def element_number_twice(text: str, dice: random.Random) -> str:
    """Two elements have one number."""
    lines = Lines(text)
    a, b = dice.sample(lines.elements, 2)
    first, second = lines.all[a], lines.all[b]
    if lines.kind == "*ELEMENT":
        changed = first.partition(",")[0] + "," + second.partition(",")[2]
    elif lines.kind == "BEGIN BULK":
        changed = second[:8] + first[8:16] + second[16:]
    else:
        changed = first[:10] + second[10:]
    return lines.written(b, [changed])


def spare_node(text: str, dice: random.Random) -> str:
    """A node that no element names."""
    lines = Lines(text)
    place = dice.choice(lines.nodes)
    own = lines.all[place : place + lines.tall_node]
    number = dice.randrange(900000, 999999)
    if lines.kind == "*ELEMENT":
        head = f"{number}," + own[0].partition(",")[2]
    elif lines.kind == "BEGIN BULK":
        head = f"{own[0][:8]}{number:<16d}{own[0][24:]}"
    else:
        head = f"{number:10d}{own[0][10:]}"
    out = list(lines.all)
    out[place:place] = [head, *own[1:]]
    return "".join(out)


def node_lost(text: str, dice: random.Random) -> str:
    """A node that elements name is missing."""
    lines = Lines(text)
    return lines.without([dice.choice(lines.nodes)], lines.tall_node)


def node_elsewhere_again(text: str, dice: random.Random) -> str:
    """A node is there twice, at two places."""
    lines = Lines(text)
    a, b = dice.sample(lines.nodes, 2)
    first = lines.all[a : a + lines.tall_node]
    second = lines.all[b : b + lines.tall_node]
    if lines.kind == "*ELEMENT":
        head = first[0].partition(",")[0] + "," + second[0].partition(",")[2]
    elif lines.kind == "BEGIN BULK":
        head = first[0][:24] + second[0][24:]
    else:
        head = first[0]
    out = list(lines.all)
    out[b:b] = [head, *second[1:]]
    return "".join(out)


def ends_in_an_element(text: str, dice: random.Random) -> str:
    """The file ends in the middle of the line of an element."""
    lines = Lines(text)
    place = dice.choice(lines.elements[len(lines.elements) // 2 :]) + lines.tall - 1
    line = lines.all[place].rstrip()
    return "".join(lines.all[:place]) + line[: dice.randrange(len(line) // 2, len(line))]


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
