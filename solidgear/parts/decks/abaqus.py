"""Abaqus and CalculiX decks (.inp): nodes, elements, element sets and sections of one part."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from solidgear.core.meshing.quality import MeshError
from solidgear.core.scene.file_materials import FileMaterial
from solidgear.parts.decks.deck import (
    FACES,
    Deck,
    Lines,
    coordinates,
    integer,
    text_of,
    wrong_node_count,
)
from solidgear.parts.decks.left_out import KEYWORDS, OTHER, TYPES, LeftOut, sort_of

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
#: keywords with data that change the mesh, and what to do
CHANGING = {
    **dict.fromkeys(("SYSTEM", "NMAP"), "moves or turns nodes: write them in x, y, z"),
    **dict.fromkeys(
        ("NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY"),
        "makes nodes or elements that the file does not list: write them out",
    ),
}
#: options of keywords that are read, or refused by name
OPTIONS = {"NODE": ("NSET", "INPUT", "SYSTEM"), "ELEMENT": ("TYPE", "ELSET", "INPUT")}
#: entries that a line of data holds at most; a line that goes on after them needs no comma
FULL = 16
#: a set with a larger share of all nodes is no place where something acts
LOCAL = 0.1


class _Block(NamedTuple):
    """A keyword and the lines of data below it."""

    keyword: str
    parameters: dict[str, str]
    line: int
    data: list[tuple[int, str]]  #: number and text of each line


def read(path: str) -> Deck:
    """Read the mesh of a deck; MeshError for lines that are cut off, elements with too few nodes or
    a number twice, several parts, and keywords that a deck may not hold here.
    """
    text = text_of(path)
    blocks = list(_blocks(text))
    _refuse_includes(blocks)
    _refuse_changes(blocks)
    if not any(b.keyword == "NODE" for b in blocks):
        raise MeshError("cannot be read as Abaqus: it holds no *NODE")
    scope, meshes = "", {"": Lines()}
    instances: dict[str, list[_Block]] = {}
    later: list[
        tuple[str, _Block]
    ] = []  # they refer to nodes and elements, by the part they are in
    not_solid: list[tuple[Lines, _Block]] = []
    for block in blocks:
        if block.keyword == "PART":
            scope = block.parameters.get("NAME", f"part in line {block.line}")
            meshes.setdefault(scope, Lines())
        elif block.keyword == "END PART":
            scope = ""
        elif block.keyword == "INSTANCE":
            part = block.parameters.get("PART", "")
            instances.setdefault(part, []).append(block)
        elif block.keyword == "NODE":
            _add_nodes(meshes[scope], block)
        elif block.keyword == "ELEMENT":
            _add_elements(meshes[scope], block)
            if not _type(block).startswith("C3D"):
                not_solid.append((meshes[scope], block))
        else:
            later.append((scope, block))
    name, lines = _only_part(meshes)
    places = instances.get(name, [])
    if len(places) > 1:
        raise MeshError(f"part {name} is there {len(places)} times in the assembly: write one part")
    for block in places:
        lines.move(*_position(block))
    of_part = [block for scope, block in later if scope in ("", name)]
    _add_sets(lines, of_part)
    _refuse_cut_off(text, lines)
    _count_left_out(lines.left_out, not_solid, [block for _, block in later])
    _add_materials(lines, [block for _, block in later])
    deck = lines.deck()
    return replace(deck, patches={**deck.patches, **dict(_surfaces(lines, of_part, deck))})


def _blocks(text: str) -> Iterator[_Block]:
    """Yield keywords with the data below them; comments are left out."""
    block, open_line = None, False
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.strip()
        if not line or line.startswith("**"):
            continue
        if open_line and block is not None:  # a keyword goes on after a comma
            block.parameters.update(_parameters(line))
            open_line = line.endswith(",")
        elif line.startswith("*"):
            if block is not None:
                yield block
            word, _, parameters = line[1:].partition(",")
            keyword = " ".join(word.upper().split())
            block = _Block(keyword, _parameters(parameters), number, [])
            open_line = line.endswith(",")
        elif block is not None:
            block.data.append((number, line))
    if block is not None:
        yield block


def _refuse_includes(blocks: list[_Block]) -> None:
    """Refuse keywords that name another file."""
    for block in blocks:
        has_input = block.keyword in ("NODE", "ELEMENT") and "INPUT" in block.parameters
        if block.keyword == "INCLUDE" or has_input:
            raise MeshError(
                f"line {block.line}: *{block.keyword} names another file "
                f"({block.parameters.get('INPUT', '')}): put its lines in its place"
            )


def _refuse_changes(blocks: list[_Block]) -> None:
    """Refuse keywords that move nodes or make nodes and elements that the file does not list, and
    options of nodes and elements that are not read.
    """
    for block in blocks:
        if block.keyword in CHANGING and block.data:
            raise MeshError(f"line {block.line}: *{block.keyword} {CHANGING[block.keyword]}")
        known = OPTIONS.get(block.keyword, block.parameters)
        for option in block.parameters:
            if option not in known:
                raise MeshError(
                    f"line {block.line}: *{block.keyword} with {option} is not read here"
                )


def _position(instance: _Block) -> tuple[np.ndarray, np.ndarray]:
    """Return the turn (3, 3) and the shift (3,) of a part in its assembly: by a first line of data, and
    then about an axis through two points by an angle in degrees.
    """
    rows = []
    for line, text in instance.data:
        entries = [entry for entry in text.split(",") if entry.strip()]
        rows.append(coordinates(entries, line, 0))
    shift, turn = np.zeros(3), np.eye(3)
    if rows and len(rows[0]) == 3:
        shift = np.array(rows.pop(0))
    if not rows:
        return turn, shift
    if len(rows) > 1 or len(rows[0]) != 7:
        raise MeshError(
            f"line {instance.line}: *INSTANCE is placed by 3 numbers, and 7 of a rotation"
        )
    a, b, angle = np.array(rows[0][:3]), np.array(rows[0][3:6]), np.radians(rows[0][6])
    x, y, z = (b - a) / max(float(np.linalg.norm(b - a)), np.finfo(float).tiny)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return turn, turn @ (shift - a) + a


def _parameters(text: str) -> dict[str, str]:
    pairs = (entry.partition("=") for entry in text.split(",") if entry.strip())
    return {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}


def _add_nodes(lines: Lines, block: _Block) -> None:
    if block.parameters.get("SYSTEM", "R").upper() != "R":
        raise MeshError(
            f"line {block.line}: nodes are given in another system of coordinates than x, y, z"
        )
    for line, text in block.data:
        entries = text.rstrip(",").split(",")
        number = integer(entries[0], line, "the number of a node")
        if name := block.parameters.get("NSET"):
            lines.node_sets.setdefault(name, set()).add(number)
        if len(entries) < 4:
            raise MeshError(
                f"line {line}: node {number} has {len(entries) - 1} coordinates where 3 are wanted"
            )
        lines.add_node(number, line, coordinates(entries[1:4], line, number))


def _add_elements(lines: Lines, block: _Block) -> None:
    name = _type(block)
    if not name:
        raise MeshError(f"line {block.line}: *ELEMENT without a TYPE")
    continuum = re.match(r"C3D(\d+)", name)
    if not continuum:
        for _, text in block.data:
            entries = [entry for entry in text.split(",") if entry.strip()]
            numbers = [int(e) for e in entries if e.strip().isdigit()]
            lines.add_other(name, numbers[0] if numbers else 0, numbers[1:])
        return
    wanted = int(continuum[1])
    kind = CONTINUUM.get(wanted)
    if kind is None:
        raise MeshError(f"line {block.line}: elements of type {name} are unknown here")
    if not block.data:
        raise MeshError(f"line {block.line}: *ELEMENT with no element below it: lines are cut off")
    members = (
        lines.sets.setdefault(block.parameters["ELSET"], []) if "ELSET" in block.parameters else []
    )
    row: list[int] = []
    start, goes_on = 0, False
    for line, text in block.data:
        if row and not goes_on:
            raise wrong_node_count(row[0], start, name, len(row) - 1, str(wanted))
        entries = [entry for entry in text.split(",") if entry.strip()]
        start = start if row else line
        row += [integer(entry, line, f"an entry of an element of type {name}") for entry in entries]
        goes_on = text.endswith(",") or len(entries) == FULL
        if len(row) > wanted:
            if len(row) > wanted + 1:
                raise wrong_node_count(row[0], start, name, len(row) - 1, str(wanted))
            lines.add_element(row[0], start, kind, row[1:])
            members.append(row[0])
            row = []
    if row:
        raise wrong_node_count(row[0], start, name, len(row) - 1, str(wanted))


def _type(block: _Block) -> str:
    return block.parameters.get("TYPE", "").upper()


def _set_name(block: _Block) -> str:
    return block.parameters.get("ELSET", "").upper()


def _count_left_out(
    tally: LeftOut, not_solid: list[tuple[Lines, _Block]], blocks: list[_Block]
) -> None:
    """Count elements that are no solids and carry something, and keywords that tie or hold
    nodes.
    """
    sets: dict[str, set[int]] = {}
    for _, block in not_solid:
        elements = {
            integer(text.split(",")[0], line, "an element")
            for line, text in block.data
            if text[0].isdigit()
        }
        sets.setdefault(_set_name(block), set()).update(elements)
    for block in blocks:
        if block.keyword == "ELSET":
            sets.setdefault(_set_name(block), set()).update(_members(block, {}))
    names = [_set_name(block) for block in blocks if block.keyword.endswith("SECTION")]
    sectioned = set().union(*(sets.get(name, set()) for name in names))
    for _, block in not_solid:
        name = _type(block)
        elements = {int(text.split(",")[0]) for _, text in block.data if text[0].isdigit()}
        sort = sort_of(name, TYPES)
        tally.add(sort or OTHER, name, len(elements if sort else elements & sectioned))
    for block in blocks:
        sort = sort_of(block.keyword, KEYWORDS)
        if sort is not None:
            tally.add(sort, f"*{block.keyword}")
        if block.keyword == "MASS":
            tally.weigh(_masses(block, sets), _place_of_first(block, not_solid))


def _masses(block: _Block, sets: Mapping[str, set[int]]) -> list[float]:
    """Return the mass that a *MASS gives to each element of the set."""
    numbers = [text.split(",")[0] for _, text in block.data]
    count = len(sets.get(_set_name(block), ())) or 1
    try:
        return [float(re.sub("[dD]", "e", numbers[0]))] * count if numbers else []
    except ValueError:
        return []


def _place_of_first(
    mass: _Block, not_solid: list[tuple[Lines, _Block]]
) -> tuple[float, ...] | None:
    """Return the place of the first element of the set of a *MASS."""
    for lines, block in not_solid:
        if _set_name(block) == _set_name(mass) and block.data:
            node = block.data[0][1].split(",")[1:2]
            return lines.place(int(node[0])) if node and node[0].strip().isdigit() else None
    return None


def _add_materials(lines: Lines, blocks: list[_Block]) -> None:
    """Add isotropic materials of sections, by the groups that are made of them."""
    by_name: dict[str, FileMaterial] = {}
    name = ""
    for block in blocks:
        if block.keyword == "MATERIAL":
            name = block.parameters.get("NAME", "")
            by_name[name.upper()] = FileMaterial(name=name, group="")
        entries = block.data[0][1].split(",") if block.data else []
        numbers = [_plain(entry) for entry in entries]
        if not name or not numbers:
            continue
        if block.keyword == "ELASTIC" and block.parameters.get("TYPE", "ISO").upper().startswith(
            "ISO"
        ):
            nu = numbers[1] if len(numbers) > 1 else 0.0
            by_name[name.upper()] = by_name[name.upper()].with_changes(E=numbers[0], nu=nu)
        elif block.keyword == "DENSITY":
            by_name[name.upper()] = by_name[name.upper()].with_changes(density=numbers[0])
    for group, material in lines.of_material.items():
        isotropic = by_name.get(material.upper())
        if isotropic is not None and isotropic.E is not None:
            lines.materials.append(isotropic.with_changes(group=group))


def _plain(text: str) -> float | None:
    """Return a number, None for a field that is none."""
    try:
        return float(re.sub("[dD]", "e", text))
    except ValueError:
        return None


def _only_part(meshes: dict[str, Lines]) -> tuple[str, Lines]:
    """Return the name and the lines of the one part with elements of a volume."""
    full = {name: lines for name, lines in meshes.items() if lines.elements}
    if len(full) > 1:
        names = ", ".join(name or "none" for name in full)
        raise MeshError(f"holds {len(full)} parts with elements ({names}): write one part")
    for name, lines in full.items():
        return name, lines
    # nothing of a volume: the message lists the elements that are there instead
    return max(meshes.items(), key=lambda item: len(item[1].other_kinds))


def _add_sets(lines: Lines, blocks: list[_Block]) -> None:
    """Add sets of elements, nodes that something acts on, and sections by their material."""
    sections: dict[str, list[str]] = {}
    for block in blocks:
        if block.keyword == "ELSET" and "ELSET" in block.parameters:
            set_name = block.parameters["ELSET"]
            members = lines.sets.setdefault(set_name, [])
            members += _members(block, lines.sets)
            # of an assembly, a set may be one of another part; a count may run over gaps
            if not {"INSTANCE", "GENERATE"} & set(block.parameters):
                lines.listed += [(set_name, n, line) for n, line in _numbered(block)]
        elif block.keyword == "NSET":
            nodes = list(_members(block, {k: [*v] for k, v in lines.node_sets.items()}))
            if "ELSET" in block.parameters:
                nodes += lines.nodes_of(lines.sets.get(block.parameters["ELSET"], ()))
            lines.node_sets.setdefault(block.parameters.get("NSET", ""), set()).update(nodes)
            if len(nodes) <= max(1, LOCAL * len(lines.nodes)):
                lines.mentioned.update(nodes)
        elif block.keyword in ("SOLID SECTION", "MASS", "ROTARY INERTIA"):
            if "MATERIAL" in block.parameters:
                sections.setdefault(block.parameters["MATERIAL"], []).append(
                    block.parameters.get("ELSET", "")
                )
        elif block.keyword in ("RIGID BODY", "COUPLING", "EQUATION", "MPC"):
            lines.mentioned.update(
                int(word)
                for text in (block.parameters.get("REF NODE", ""), *(t for _, t in block.data))
                for word in re.findall(r"\b\d+\b", text)
            )
    by_name = {name.upper(): members for name, members in lines.sets.items()}
    for material, names in sections.items():
        members = [n for name in names for n in by_name.get(name.upper(), ())]
        namesake = by_name.get(material.upper())
        if namesake is not None and set(namesake) == set(members):
            name = next(n for n in lines.sets if n.upper() == material.upper())
        else:
            name = material if namesake is None else f"material:{material}"
            lines.sets[name] = members
        lines.material_sets.add(name)
        lines.of_material[name] = material


def _surfaces(lines: Lines, blocks: list[_Block], deck: Deck) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the corners of the faces of surfaces made of faces of elements."""
    faces = FACES[deck.kind.rstrip("0123456789")]
    sets = {name.upper(): members for name, members in lines.sets.items()}
    place = {e.number: k for k, e in enumerate(lines.elements)}
    for block in blocks:
        if (
            block.keyword != "SURFACE"
            or block.parameters.get("TYPE", "ELEMENT").upper() != "ELEMENT"
        ):
            continue
        patch = []
        for _, text in block.data:
            owner, _, face = (word.strip().upper() for word in text.partition(","))
            if not face:  # all that lie on the surface
                chosen = [list(corners) for corners in faces]
            elif face[:1] == "S" and face[1:].isdigit() and 0 < int(face[1:]) <= len(faces):
                chosen = [list(faces[int(face[1:]) - 1])]
            else:
                continue
            elements = [int(owner)] if owner.isdigit() else sets.get(owner, ())
            places = [place[n] for n in elements if n in place]
            patch += [deck.cells[corners, k] for k in places for corners in chosen]
        if patch:
            yield block.parameters.get("NAME", f"line {block.line}"), np.array(patch).T


def _members(block: _Block, sets: dict[str, list[int]]) -> Iterator[int]:
    """Yield the numbers in a set; names of sets before it stand for their members."""
    members_of = {name.upper(): members for name, members in sets.items()}
    for line, text in block.data:
        entries = [entry.strip() for entry in text.split(",") if entry.strip()]
        if "GENERATE" in block.parameters:
            first, last, *step = (integer(e, line, "an entry of a set") for e in entries[:3])
            increment = step[0] if step else 1
            if increment < 1 or last - first > 10**9:
                raise MeshError(f"line {line}: a set counts from {first} to {last} by {increment}")
            yield from range(first, last + 1, increment)
            continue
        for entry in entries:
            if entry.lstrip("-").isdigit():
                yield int(entry)
            else:
                yield from members_of.get(entry.upper(), ())


def _numbered(block: _Block) -> Iterator[tuple[int, int]]:
    """Yield the numbers that a set lists, each with the line."""
    for line, text in block.data:
        yield from ((int(e), line) for e in text.split(",") if e.strip().isdigit())


def _refuse_cut_off(text: str, lines: Lines) -> None:
    """Refuse a file whose last line is an element without an end: half of a number may be lost."""
    last = text.rpartition("\n")[2].strip()
    if last and lines.elements and last.split(",")[0].strip() == str(lines.elements[-1].number):
        raise MeshError(
            f"line {lines.elements[-1].line}: the file ends in the middle of the line of element "
            f"{lines.elements[-1].number}; if it is whole, end it with a line break"
        )
