"""Nastran bulk data (.bdf, .nas): GRID and the solid elements, by property."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from solidgear.core.meshing.quality import MeshError
from solidgear.core.scene.file_materials import FileMaterial
from solidgear.parts.decks.deck import Deck, Lines, integer, text_of, wrong_node_count
from solidgear.parts.decks.left_out import CARDS, LINK, sort_of

#: kinds of cells of a card by their number of nodes, in meshio's words
SOLIDS = {
    "CTETRA": {4: "tetra", 10: "tetra10"},
    "CHEXA": {8: "hexahedron", 20: "hexahedron20"},
    "CPENTA": {6: "wedge", 15: "wedge15"},
    "CPYRAM": {5: "pyramid", 13: "pyramid13"},
    "CPYRA": {5: "pyramid", 13: "pyramid13"},
}
#: edges of a brick: bottom, upright, top in Nastran; bottom, top, upright in VTK
BRICK = (*range(12), *range(16, 20), *range(12, 16))
#: beginnings of cards that need the nodes they name
NEEDY = ("C", "RBE", "RBAR", "RROD", "RSPLINE", "MPC", "SPOINT")


class Card(NamedTuple):
    """A card of a bulk data section."""

    name: str
    fields: list[str]  #: after the name
    line: int  #: where it begins
    text: str = ""  #: of that line


def read(path: str) -> Deck:
    """Read the mesh of a bulk data file; MeshError for one without ENDDATA, elements with too few
    nodes or a number twice, and nodes in a system of coordinates of their own.
    """
    lines = Lines()
    solids: dict[str, str] = {}
    materials: dict[str, Card] = {}
    masses: list[tuple[float, int]] = []
    in_deck = list(cards(text_of(path)))
    usual = next((card.fields[1] for card in in_deck if card.name == "GRDSET"), "")
    weights = [
        c.fields[1] for c in in_deck if c.name == "PARAM" and c.fields[0].upper() == "WTMASS"
    ]
    # by which the solver multiplies all masses, such as 1 / g where densities are weights
    unit = (_plain(weights[-1]) if weights else None) or 1.0
    for card in in_deck:
        sort = sort_of(card.name, CARDS)
        if sort is not None:
            lines.left_out.add(sort, card.name)
            masses += [(unit * mass, node) for mass, node in _mass(card)]
        if card.name == "GRID":
            _add_node(lines, card, usual)
        elif card.name in SOLIDS:
            _add_solid(lines, card)
        elif card.name == "INCLUDE":
            raise MeshError(
                f"line {card.line}: INCLUDE names another file{_quoted(card)}: put its lines in its "
                "place"
            )
        elif card.name == "PSOLID":
            solids[card.fields[0]] = card.fields[1]
        elif card.name == "MAT1":
            materials[card.fields[0]] = card
        elif card.name.startswith(NEEDY) and not card.name.startswith("CORD"):
            numbers = [int(f) for f in card.fields if f.isdigit()]
            lines.add_other(card.name, numbers[0] if numbers else 0, numbers[1:])
    lines.left_out.weigh(
        (mass for mass, _ in masses), lines.place(masses[0][1]) if masses else None
    )
    lines.materials = [
        _material(materials[number], group, unit)
        for group, number in solids.items()
        if number in materials and group in lines.sets
    ]
    return lines.deck()


def cards(text: str) -> Iterator[Card]:
    """Yield the cards of a bulk data section, lines that go on joined; MeshError without
    ENDDATA.
    """
    # the lines before it are for the solver; many programs write the bulk alone
    begins = re.compile(r"\s*BEGIN\s*BULK", re.I)
    inside = not any(begins.match(line) for line in text.splitlines())
    ended, card, number = False, None, 0
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.split("$")[0].rstrip().expandtabs(8)
        if not line:
            continue
        if not inside:
            inside = bool(begins.match(line))
            continue
        if line.strip().upper().startswith("ENDDATA"):
            ended = True
            break
        first, fields = _fields(line)
        if first == "" or first[0] in "+*":
            if card is not None:
                card.fields.extend(fields)
            continue
        if card is not None:
            yield card
        # meshio writes an underscore after the names of elements of second order
        card = Card(first.rstrip("*").upper().rstrip("_"), fields, number, line)
    if not ended:
        raise MeshError(f"is cut off after line {number}: it does not end with ENDDATA")
    if card is not None:
        yield card


def _fields(line: str) -> tuple[str, list[str]]:
    """Return the first field of a line, and those of data, padded so that the next line goes on
    behind them.
    """
    if "," in line[:10]:
        first, *entries = (entry.strip() for entry in line.split(","))
        count = 4 if first.endswith("*") or first.startswith("*") else 8
        fields = entries[:count]
    else:
        first = line[:8].strip()
        wide = 16 if "*" in first else 8
        count = 4 if wide == 16 else 8
        fields = [line[8 + wide * k : 8 + wide * (k + 1)].strip() for k in range(count)]
    return first, fields + [""] * (count - len(fields))


def _number(text: str) -> float:
    """Return a number as Nastran writes it: the E of an exponent may be left out."""
    plain = re.sub("[dD]", "e", text)
    if "e" not in plain.lower():
        plain = re.sub(r"(?<=[\d.])([+-]\d+)$", r"e\1", plain)
    return float(plain)


def _add_node(lines: Lines, card: Card, usual: str) -> None:
    """Add a node, in the system that GRDSET gives where the GRID names none."""
    number = integer(card.fields[0], card.line, "the number of a GRID")
    system = card.fields[1] or usual
    if system not in ("", "0"):
        raise MeshError(
            f"line {card.line}: GRID {number} is given in system {system}: write all nodes in the "
            "basic system"
        )
    try:
        # a blank field is zero, a line that should go on is none
        point = [_number(entry or "0.") for entry in card.fields[2:5]]
    except ValueError:
        raise MeshError(
            f"line {card.line}: GRID {number} has a coordinate that is missing or no number"
        ) from None
    if card.fields[6].strip("0"):
        lines.left_out.add(LINK, "GRID with held motions")
    lines.add_node(number, card.line, point)


def _plain(text: str) -> float | None:
    """Return a number, None for a field that is blank or none."""
    try:
        return _number(text) if text else None
    except ValueError:
        return None


def _mass(card: Card) -> list[tuple[float, int]]:
    """Return mass and node of a card that puts one on a node."""
    places = {"CONM2": (3, 1), "CMASS2": (1, 2), "CMASS4": (1, 2)}.get(card.name)
    if places is None:
        return []
    mass, node = (card.fields[place] for place in places)
    return [(_plain(mass) or 0.0, int(node) if node.isdigit() else 0)]


def _material(card: Card, group: str, unit: float) -> FileMaterial:
    """Return the material of a MAT1, whose Poisson's ratio may follow from the shear modulus and whose
    density counts in a unit of mass.
    """
    young, shear, nu, density = map(_plain, card.fields[1:5])
    if nu is None and young and shear:
        nu = young / 2 / shear - 1
    if young is None and shear and nu is not None:
        young = 2 * shear * (1 + nu)
    return FileMaterial(
        name=f"MAT1 {card.fields[0]}",
        group=group,
        E=young,
        nu=nu,
        density=unit * density if density else None,
    )


def _quoted(card: Card) -> str:
    """Return the file that an INCLUDE names, in brackets, where it stands in one line."""
    name = re.search(r"['\"]([^'\"]+)", card.text)
    return f" ({name[1].strip()})" if name else ""


def _add_solid(lines: Lines, card: Card) -> None:
    number = integer(card.fields[0], card.line, f"the number of a {card.name}")
    kinds = SOLIDS[card.name]
    entries = card.fields[2:]
    while entries and not entries[-1]:
        entries.pop()
    if len(entries) not in kinds or "" in entries:
        count = sum(1 for entry in entries if entry)
        raise wrong_node_count(number, card.line, card.name, count, " or ".join(map(str, kinds)))
    nodes = [integer(entry, card.line, f"a node of {card.name} {number}") for entry in entries]
    if len(nodes) == len(BRICK):
        nodes = [nodes[k] for k in BRICK]
    lines.add_element(number, card.line, kinds[len(nodes)], nodes)
    if card.fields[1]:
        name = str(integer(card.fields[1], card.line, f"the property of {card.name} {number}"))
        lines.sets.setdefault(name, []).append(number)
        lines.material_sets.add(name)
