"""Abaqus and CalculiX decks (.inp): nodes, elements, element sets and sections of one part."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from solidgear.meshing.decks.deck import Deck, Lines, coordinates, integer, text_of, told_short
from solidgear.meshing.decks.left_out import KEYWORDS, OTHER, TYPES, LeftOut, sort_of
from solidgear.meshing.quality import MeshError
from solidgear.scene.file_materials import FileMaterial

#: kinds of cells by the nodes of a continuum element, in meshio's words
CONTINUUM = {
    4: "tetra",
    5: "pyramid",
    6: "wedge",
    8: "hexahedron",
    10: "tetra10",
    13: "pyramid13",
    15: "wedge15",
    20: "hexahedron20",
    27: "hexahedron27",
}
#: corners of the faces S1, S2 and so on of elements
FACES = {
    "tetra": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    "hexahedron": (
        *((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1)),
        *((1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    ),
}
#: entries that a line of data holds at most; what goes on after them needs no comma
FULL = 16
#: a set of nodes of a larger share of all is no place where something acts
LOCAL = 0.1


class _Block(NamedTuple):
    """A keyword with its parameters, and the lines of data below it."""

    keyword: str
    given: dict[str, str]
    line: int
    data: list[tuple[int, str]]


def read(path: str) -> Deck:
    """The mesh of a deck; MeshError for lines that are cut off, elements with too few nodes or a
    number twice, several parts, and what a deck may not hold here.
    """
    text = text_of(path)
    blocks = list(_blocks(text))
    _in_one_file(blocks)
    if not any(b.keyword == "NODE" for b in blocks):
        raise MeshError("cannot be read as Abaqus: it holds no *NODE")
    scope, meshes = "", {"": Lines()}
    instances: dict[str, int] = {}
    late: list[tuple[str, _Block]] = []
    beside: list[tuple[Lines, _Block]] = []
    for block in blocks:
        if block.keyword == "PART":
            scope = block.given.get("NAME", f"part in line {block.line}")
            meshes.setdefault(scope, Lines())
        elif block.keyword == "END PART":
            scope = ""
        elif block.keyword == "INSTANCE":
            part = block.given.get("PART", "")
            instances[part] = instances.get(part, 0) + 1
        elif block.keyword == "NODE":
            _nodes(meshes[scope], block)
        elif block.keyword == "ELEMENT":
            _elements(meshes[scope], block)
            beside += [(meshes[scope], block)] * (not _is_solid(block))
        else:
            late.append((scope, block))
    name, lines = _the_part(meshes)
    if instances.get(name, 0) > 1:
        raise MeshError(
            f"part {name} is there {instances[name]} times in the assembly: write one part"
        )
    own = [b for where, b in late if where in ("", name)]
    _sets(lines, own)
    _whole(text, lines)
    _left_out(lines.left_out, beside, [block for _, block in late])
    _materials(lines, [block for _, block in late])
    deck = lines.deck()
    return replace(deck, patches=dict(_surfaces(lines, own, deck)))


def _blocks(text: str) -> Iterator[_Block]:
    """Keywords with the data below them; comments are left out."""
    block, open_line = None, False
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.strip()
        if not line or line.startswith("**"):
            continue
        if open_line and block is not None:  # a keyword goes on after a comma
            block.given.update(_parameters(line))
            open_line = line.endswith(",")
        elif line.startswith("*"):
            if block is not None:
                yield block
            word, _, rest = line[1:].partition(",")
            keyword = " ".join(word.upper().split())
            block = _Block(keyword, _parameters(rest), number, [])
            open_line = line.endswith(",")
        elif block is not None:
            block.data.append((number, line))
    if block is not None:
        yield block


def _in_one_file(blocks: list[_Block]) -> None:
    """Refuse what stands in another file."""
    for block in blocks:
        if (
            block.keyword == "INCLUDE"
            or block.keyword in ("NODE", "ELEMENT")
            and "INPUT" in block.given
        ):
            raise MeshError(
                f"line {block.line}: *{block.keyword} names another file "
                f"({block.given.get('INPUT', '')}): put its lines in its place"
            )


def _parameters(text: str) -> dict[str, str]:
    pairs = (entry.partition("=") for entry in text.split(",") if entry.strip())
    return {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}


def _nodes(lines: Lines, block: _Block) -> None:
    if block.given.get("SYSTEM", "R").upper() != "R":
        raise MeshError(
            f"line {block.line}: nodes are given in another system of coordinates than x, y, z"
        )
    for line, text in block.data:
        entries = text.rstrip(",").split(",")
        number = integer(entries[0], line, "the number of a node")
        if len(entries) < 4:
            raise MeshError(
                f"line {line}: node {number} has {len(entries) - 1} coordinates where 3 are wanted"
            )
        lines.node(number, line, coordinates(entries[1:4], line, number))


def _elements(lines: Lines, block: _Block) -> None:
    name = block.given.get("TYPE", "").upper()
    if not name:
        raise MeshError(f"line {block.line}: *ELEMENT without a TYPE")
    found = re.match(r"C3D(\d+)", name)
    if not found:
        for _, text in block.data:
            entries = [entry for entry in text.split(",") if entry.strip()]
            words = [int(e) for e in entries if e.strip().isdigit()]
            lines.other(name, words[0] if words else 0, words[1:])
        return
    wanted = int(found[1])
    kind = CONTINUUM.get(wanted)
    if kind is None:
        raise MeshError(f"line {block.line}: elements of type {name} are unknown here")
    if not block.data:
        raise MeshError(f"line {block.line}: *ELEMENT with no element below it: lines are cut off")
    members = lines.sets.setdefault(block.given["ELSET"], []) if "ELSET" in block.given else []
    row: list[int] = []
    start, goes_on = 0, False
    for line, text in block.data:
        if row and not goes_on:
            raise told_short(row[0], start, name, len(row) - 1, str(wanted))
        entries = [entry for entry in text.split(",") if entry.strip()]
        start = start if row else line
        row += [integer(entry, line, f"an entry of an element of type {name}") for entry in entries]
        goes_on = text.endswith(",") or len(entries) == FULL
        if len(row) > wanted:
            if len(row) > wanted + 1:
                raise told_short(row[0], start, name, len(row) - 1, str(wanted))
            lines.element(row[0], start, kind, row[1:])
            members.append(row[0])
            row = []
    if row:
        raise told_short(row[0], start, name, len(row) - 1, str(wanted))


def _is_solid(block: _Block) -> bool:
    return block.given.get("TYPE", "").upper().startswith("C3D")


def _left_out(tally: LeftOut, beside: list[tuple[Lines, _Block]], blocks: list[_Block]) -> None:
    """Count elements that are no solids and carry something, and what ties or holds nodes."""
    sets: dict[str, set[int]] = {}
    for _, block in beside:
        own = {
            integer(text.split(",")[0], line, "an element")
            for line, text in block.data
            if text[0].isdigit()
        }
        sets.setdefault(block.given.get("ELSET", "").upper(), set()).update(own)
    for block in blocks:
        if block.keyword == "ELSET":
            sets.setdefault(block.given.get("ELSET", "").upper(), set()).update(_members(block, {}))
    named = [b.given.get("ELSET", "").upper() for b in blocks if b.keyword.endswith("SECTION")]
    sectioned = set().union(*(sets.get(name, set()) for name in named))
    for _, block in beside:
        name = block.given.get("TYPE", "").upper()
        own = {int(text.split(",")[0]) for _, text in block.data if text[0].isdigit()}
        sort = sort_of(name, TYPES)
        tally.add(sort or OTHER, name, len(own if sort else own & sectioned))
    for block in blocks:
        sort = sort_of(block.keyword, KEYWORDS)
        if sort is not None:
            tally.add(sort, f"*{block.keyword}")
        if block.keyword == "MASS":
            tally.weigh(_masses(block, sets), _first(block, beside))


def _masses(block: _Block, sets: Mapping[str, set[int]]) -> list[float]:
    """Masses that a *MASS gives to each element of its set."""
    numbers = [text.split(",")[0] for _, text in block.data]
    count = len(sets.get(block.given.get("ELSET", "").upper(), ())) or 1
    try:
        return [float(re.sub("[dD]", "e", numbers[0]))] * count if numbers else []
    except ValueError:
        return []


def _first(mass: _Block, beside: list[tuple[Lines, _Block]]) -> tuple[float, ...] | None:
    """Place of the first element of the set of a *MASS."""
    wanted = mass.given.get("ELSET", "").upper()
    for lines, block in beside:
        if block.given.get("ELSET", "").upper() == wanted and block.data:
            node = block.data[0][1].split(",")[1:2]
            return lines.place(int(node[0])) if node and node[0].strip().isdigit() else None
    return None


def _materials(lines: Lines, blocks: list[_Block]) -> None:
    """Isotropic materials of sections, by the groups that are of them."""
    told: dict[str, FileMaterial] = {}
    name = ""
    for block in blocks:
        if block.keyword == "MATERIAL":
            name = block.given.get("NAME", "")
            told[name.upper()] = FileMaterial(name=name, group="")
        entries = block.data[0][1].split(",") if block.data else []
        numbers = [_plain(entry) for entry in entries]
        if not name or not numbers:
            continue
        if block.keyword == "ELASTIC" and block.given.get("TYPE", "ISO").upper().startswith("ISO"):
            nu = numbers[1] if len(numbers) > 1 else 0.0
            told[name.upper()] = told[name.upper()].with_changes(E=numbers[0], nu=nu)
        elif block.keyword == "DENSITY":
            told[name.upper()] = told[name.upper()].with_changes(density=numbers[0])
    for group, material in lines.of_material.items():
        found = told.get(material.upper())
        if found is not None and found.E is not None:
            lines.materials.append(found.with_changes(group=group))


def _plain(text: str) -> float | None:
    """A number, None for a field that is none."""
    try:
        return float(re.sub("[dD]", "e", text))
    except ValueError:
        return None


def _the_part(meshes: dict[str, Lines]) -> tuple[str, Lines]:
    """The one part with elements of a volume."""
    full = {name: lines for name, lines in meshes.items() if lines.elements}
    if len(full) > 1:
        named = ", ".join(name or "none" for name in full)
        raise MeshError(f"holds {len(full)} parts with elements ({named}): write one part")
    for name, lines in full.items():
        return name, lines
    # nothing of a volume: what there is instead is told
    return max(meshes.items(), key=lambda item: len(item[1].others))


def _sets(lines: Lines, blocks: list[_Block]) -> None:
    """Sets of elements, nodes that something acts on, and sections by their material."""
    sections: dict[str, list[str]] = {}
    for block in blocks:
        if block.keyword == "ELSET" and "ELSET" in block.given:
            set_name = block.given["ELSET"]
            own = lines.sets.setdefault(set_name, [])
            own += _members(block, lines.sets)
            # of an assembly, a set may be one of another part; a count may run over gaps
            if not {"INSTANCE", "GENERATE"} & set(block.given):
                lines.listed += [(set_name, n, line) for n, line in _numbered(block)]
        elif block.keyword == "NSET":
            found = list(_members(block, {}))
            if len(found) <= max(1, LOCAL * len(lines.nodes)):
                lines.mentioned.update(found)
        elif block.keyword in ("SOLID SECTION", "MASS", "ROTARY INERTIA"):
            if "MATERIAL" in block.given:
                sections.setdefault(block.given["MATERIAL"], []).append(
                    block.given.get("ELSET", "")
                )
        elif block.keyword in ("RIGID BODY", "COUPLING", "EQUATION", "MPC"):
            lines.mentioned.update(
                int(word)
                for text in (block.given.get("REF NODE", ""), *(t for _, t in block.data))
                for word in re.findall(r"\b\d+\b", text)
            )
    by_name = {name.upper(): members for name, members in lines.sets.items()}
    for material, names in sections.items():
        members = [n for name in names for n in by_name.get(name.upper(), ())]
        same = by_name.get(material.upper())
        if same is not None and set(same) == set(members):
            own_name = next(n for n in lines.sets if n.upper() == material.upper())
            lines.telling.add(own_name)
            lines.of_material[own_name] = material
            continue
        name = material if same is None else f"material:{material}"
        lines.sets[name] = members
        lines.telling.add(name)
        lines.of_material[name] = material


def _surfaces(lines: Lines, blocks: list[_Block], deck: Deck) -> Iterator[tuple[str, np.ndarray]]:
    """Corners of the faces of surfaces made of faces of elements."""
    faces = FACES[deck.kind.rstrip("0123456789")]
    sets = {name.upper(): members for name, members in lines.sets.items()}
    place = {e.number: k for k, e in enumerate(lines.elements)}
    for block in blocks:
        if block.keyword != "SURFACE" or block.given.get("TYPE", "ELEMENT").upper() != "ELEMENT":
            continue
        found = []
        for _, text in block.data:
            who, _, face = (word.strip().upper() for word in text.partition(","))
            if not (face[:1] == "S" and face[1:].isdigit() and 0 < int(face[1:]) <= len(faces)):
                continue
            own = [int(who)] if who.isdigit() else sets.get(who, ())
            corners = list(faces[int(face[1:]) - 1])
            found += [deck.cells[corners, place[n]] for n in own if n in place]
        if found:
            yield block.given.get("NAME", f"line {block.line}"), np.array(found).T


def _members(block: _Block, sets: dict[str, list[int]]) -> Iterator[int]:
    """Numbers in a set; names of sets before it stand for what they hold."""
    known = {name.upper(): members for name, members in sets.items()}
    for line, text in block.data:
        entries = [entry.strip() for entry in text.split(",") if entry.strip()]
        if "GENERATE" in block.given:
            first, last, *step = (integer(e, line, "an entry of a set") for e in entries[:3])
            every = step[0] if step else 1
            if every < 1 or last - first > 10**9:
                raise MeshError(f"line {line}: a set counts from {first} to {last} by {every}")
            yield from range(first, last + 1, every)
            continue
        for entry in entries:
            if entry.lstrip("-").isdigit():
                yield int(entry)
            else:
                yield from known.get(entry.upper(), ())


def _numbered(block: _Block) -> Iterator[tuple[int, int]]:
    """Numbers that a set lists, each with its line."""
    for line, text in block.data:
        yield from ((int(e), line) for e in text.split(",") if e.strip().isdigit())


def _whole(text: str, lines: Lines) -> None:
    """Refuse a file whose last line is an element without an end: half of a number may be lost."""
    last = text.rpartition("\n")[2].strip()
    if last and lines.elements and last.split(",")[0].strip() == str(lines.elements[-1].number):
        raise MeshError(
            f"line {lines.elements[-1].line}: the file ends in the middle of the line of element "
            f"{lines.elements[-1].number}; if it is whole, end it with a line break"
        )
