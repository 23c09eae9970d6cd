"""Universal files (.unv) of I-DEAS: nodes (dataset 2411 or 781), elements (2412 or 780), permanent
groups (2467, 2477, 2452 and others of their kind).

The format is described by the Structural Dynamics Research Laboratory of the University of
Cincinnati, "Universal file formats for modal analysis testing and finite elements".
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from solidgear.core.meshing.quality import MeshError
from solidgear.parts.decks.deck import Deck, Lines, coordinates, integer, text_of, wrong_node_count
from solidgear.parts.decks.left_out import DATASETS, DESCRIPTORS, LINK, OTHER, SORTS, sort_of
from solidgear.parts.universal_units import units_of

#: by the descriptor of a finite element: kind of cell in meshio's words, and its nodes in VTK's
#: order; those of second order go around each edge
SOLIDS: dict[int, tuple[str, tuple[int, ...]]] = {
    111: ("tetra", tuple(range(4))),
    118: ("tetra10", (0, 2, 4, 9, 1, 3, 5, 6, 7, 8)),
    112: ("wedge", tuple(range(6))),
    113: ("wedge15", tuple(range(15))),
    115: ("hexahedron", tuple(range(8))),
    116: (
        "hexahedron20",
        (0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11),
    ),
}
#: elements along a line have one line of data more
BEAMS = (11, 21, 22, 23, 24)
NODES, ELEMENTS = ("2411", "781"), ("2412", "780")
#: entries for each member of a group: kind and number, and in newer ones two more
GROUPS = {"2417": 2, "2429": 2, "2430": 2, "2432": 2, "2435": 4, "2452": 4, "2467": 4, "2477": 4}
#: kinds of members of a group: a node, an element
IS_NODE, IS_ELEMENT = 7, 8


def read(path: str) -> Deck:
    """Read the mesh of a universal file; MeshError for a dataset that does not end, elements with
    another number of nodes than their kind has, or a number twice.
    """
    lines, datasets = Lines(), set()
    thin: list[tuple[int, list[int]]] = []
    for kind, data in _datasets(text_of(path)):
        datasets.add(kind)
        if kind in NODES:
            _add_nodes(lines, data)
        elif kind in ELEMENTS:
            thin += _add_elements(lines, data)
        elif kind in GROUPS:
            _add_groups(lines, data, GROUPS[kind])
        elif re.fullmatch(DATASETS, kind):
            lines.left_out.add(LINK, f"dataset {kind} of restraints")
    if not datasets & set(NODES):
        raise MeshError("cannot be read as a universal file: it holds no dataset 2411 of nodes")
    solid = {node for element in lines.elements for node in element.nodes}
    for descriptor, nodes in thin:
        # faces and edges of solids are how meshers write groups of surfaces and lines
        if not solid.issuperset(nodes):
            lines.left_out.add(OTHER, f"beams or shells of kind {descriptor}")
    return lines.deck()


def unit_of(text: str) -> float | None:
    """Return the unit of length that dataset 164 of a universal file gives, in metres; None without
    one.
    """
    for kind, data in _datasets(text):
        if kind == "164" and data:
            entries = [entry for _, line in data[1:] for entry in line.split()]
            code = integer(data[0][1][:10], data[0][0], "the code of its units")
            try:
                length, force = (float(re.sub("[dD]", "e", entry)) for entry in entries[:2])
            except ValueError:
                length = force = 0.0
            return units_of(code, length, force)[0]
    return None


Data = list[tuple[int, str]]


def _datasets(text: str) -> Iterator[tuple[str, Data]]:
    """Yield each dataset: number and lines."""
    kind: str | None = None
    data: Data = []
    begun = 0
    for number, raw in enumerate(text.splitlines(), 1):
        if raw.strip() == "-1":
            if begun:
                if kind is not None:
                    yield kind, data
                kind, data, begun = None, [], 0
            else:
                begun = number
        elif begun and kind is None:
            kind = raw.strip()
        elif begun:
            data.append((number, raw))
    if begun:
        raise MeshError(f"is cut off: the dataset that begins in line {begun} does not end with -1")


def _add_nodes(lines: Lines, data: Data) -> None:
    for (line, head), (below, entries) in _records(data, 2):
        number = integer((head.split() or [""])[0], line, "the number of a node")
        place = coordinates(entries.split(), below, number)
        if len(place) != 3:
            raise MeshError(f"line {below}: node {number} has a coordinate that is no number")
        lines.add_node(number, line, place)


def _records(data: Data, count: int) -> Iterator[tuple[tuple[int, str], ...]]:
    if len(data) % count:
        raise MeshError(f"line {data[-1][0]}: a record is cut off")
    for k in range(0, len(data), count):
        yield tuple(data[k : k + count])


def _add_elements(lines: Lines, data: Data) -> list[tuple[int, list[int]]]:
    """Add the elements of a dataset; return kind and nodes of those along lines and on faces."""
    k = 0
    thin: list[tuple[int, list[int]]] = []
    while k < len(data):
        line, head = data[k]
        row = [integer(entry, line, "an entry of an element") for entry in head.split()]
        if len(row) < 6:
            raise MeshError(f"line {line}: an element has {len(row)} entries where 6 are wanted")
        # dataset 780 has the number of a table before each of property and material
        columns = (0, 1, 2, 3, 5) if len(row) < 8 else (0, 1, 3, 5, 7)
        number, descriptor, prop, material, wanted = (row[k] for k in columns)
        k += 1 + (descriptor in BEAMS)
        nodes: list[int] = []
        while k < len(data) and len(nodes) < wanted:
            place, text = data[k]
            nodes += [integer(e, place, f"a node of element {number}") for e in text.split()]
            k += 1
        if descriptor not in SOLIDS:
            lines.add_other(f"kind {descriptor}", number, nodes)
            sort = sort_of(str(descriptor), DESCRIPTORS)
            if sort is not None:
                lines.left_out.add(sort, f"{SORTS[sort][0]} of kind {descriptor}")
            else:
                thin.append((descriptor, nodes))
            continue
        kind, order = SOLIDS[descriptor]
        if len(nodes) != len(order) or wanted != len(order):
            raise wrong_node_count(
                number, line, f"{descriptor} ({kind})", len(nodes), str(len(order))
            )
        lines.add_element(number, line, kind, [nodes[place] for place in order])
        lines.sets.setdefault(str(material), []).append(number)
        lines.material_sets.add(str(material))
        lines.sets.setdefault(f"property:{prop}", []).append(number)
    return thin


def _add_groups(lines: Lines, data: Data, step: int) -> None:
    """Add permanent groups: a line that ends with their size, a name, and members."""
    k = 0
    while k + 1 < len(data):
        line, head = data[k]
        count = integer((head.split() or [""])[-1], line, "the size of a group")
        name = data[k + 1][1].strip()
        k += 2
        entries: list[int] = []
        while k < len(data) and len(entries) < step * count:
            entries += [integer(e, data[k][0], f"a member of {name}") for e in data[k][1].split()]
            k += 1
        kinds, numbers = entries[0::step], entries[1::step]
        members = [number for kind, number in zip(kinds, numbers) if kind == IS_ELEMENT]
        nodes = {number for kind, number in zip(kinds, numbers) if kind == IS_NODE}
        if nodes:
            lines.node_sets.setdefault(name, set()).update(nodes)
        if members:
            lines.sets.setdefault(name, []).extend(members)
            lines.material_sets.add(name)
            lines.listed += [(name, number, line) for number in members]
