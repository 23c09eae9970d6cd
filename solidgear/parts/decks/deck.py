"""Content of a mesh file, whatever the format: nodes, elements of one kind, and groups of them.

A further format is a reader in this room that gives a :class:`Deck`, a line in ``FORMATS`` and a case
in ``tests/test_part_materials.py``.  A mesh of other origin becomes a body by
:func:`solidgear.parts.own_mesh.solid_body`.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from solidgear.core.meshing.quality import MeshError
from solidgear.core.scene.file_materials import FileMaterial
from solidgear.parts.decks.left_out import LeftOut

#: how a file ends, and the module of this room that reads it
FORMATS = {
    ".msh": "foreign",
    ".inp": "abaqus",
    ".bdf": "nastran",
    ".nas": "nastran",
    ".vtu": "foreign",
    ".unv": "universal",
}
#: lines by which files that end otherwise, such as .dat, are recognised, by the module that reads them
CONTENTS = {
    "nastran": r"^\s*BEGIN\s+BULK|^GRID\b[*,\s]",
    "abaqus": r"^\*(?:NODE|HEADING|PART|INCLUDE)\b",
    "universal": r"\A\s*-1\s*\n\s*(?:151|164|2411|2420|781)\s*\n",
}
#: kinds of cells that are assembled, in meshio's words, and their names here
KINDS = {
    "tetra": "tet4",
    "tetra10": "tet10",
    "hexahedron": "hex8",
    "hexahedron20": "hex20",
}
#: corners of the faces of elements, in the order S1, S2 and so on of Abaqus
FACES = {
    "tetra": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    "hexahedron": (
        *((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1)),
        *((1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    ),
}
#: how kinds of cells of a volume begin
VOLUMES = ("wedge", "pyramid", "hexahedron", "tetra", "polyhedron", "VTK_LAGRANGE")


@dataclass(frozen=True)
class Group:
    """Elements that a file gives a name."""

    name: str  #: as a scene writes it
    elements: np.ndarray  #: (n,) places in :attr:`Deck.cells`
    #: whether such groups stand for materials, and not, say, for places where loads act
    of_material: bool = True


@dataclass(frozen=True)
class Deck:
    """A mesh as a file has it."""

    points: np.ndarray  #: (3, n) in the unit of the file
    kind: str  #: of its cells, one of `KINDS`
    cells: np.ndarray  #: (nodes, ne) in VTK's order of nodes
    groups: tuple[Group, ...] = ()
    numbers: np.ndarray | None = None  #: (ne,) by which the file calls its elements
    lines: np.ndarray | None = None  #: (ne,) where in the file they begin, counted from 1
    remarks: tuple[str, ...] = ()  #: oddities of the file that are no fault
    #: corners (3 or 4, n) of the faces of named groups of surfaces
    patches: Mapping[str, np.ndarray] = field(default_factory=dict)
    materials: tuple[FileMaterial, ...] = ()  #: that the file gives to its groups

    def label(self, place: int) -> str:
        """Return a label of an element, by the place in :attr:`cells`."""
        if self.numbers is None or self.lines is None:
            return f"element {place + 1}"
        return f"line {self.lines[place]}: element {self.numbers[place]}"


class Element(NamedTuple):
    """An element of a file of lines."""

    number: int
    line: int
    kind: str
    nodes: Sequence[int]


def read(path: str) -> Deck:
    """Read the mesh in a file; MeshError where it cannot be read or has no elements of one kind
    that is assembled here.
    """
    module = importlib.import_module(f"solidgear.parts.decks.{reader_of(path)}")
    reader: Callable[[str], Deck] = module.read
    return reader(path)


def reader_of(path: str) -> str:
    """Return the module of this room that reads a file: by the ending of the name, else by the
    content.
    """
    ending = Path(path).suffix.lower()
    if ending in FORMATS:
        return FORMATS[ending]
    text = text_of(path)
    for module, begins in CONTENTS.items():
        if re.search(begins, text, re.I | re.M):
            return module
    raise MeshError(
        f"a mesh file that ends in {ending or 'nothing'} is unknown, and its content is neither "
        f"Nastran, Abaqus nor a universal file; known are {', '.join(FORMATS)}"
    )


def text_of(path: str) -> str:
    """Read the text of a file; MeshError where it cannot be opened, or holds no text."""
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise MeshError(f"cannot be read ({error.strerror or error})") from None
    if b"\0" in content:
        raise MeshError("is not a text: it holds zero bytes")
    return content.decode("utf-8", "replace")


def one_kind(counts: dict[str, int]) -> str:
    """Return the one kind of cells of a volume, from the number of cells of each kind (in meshio's
    words) in a file; MeshError where there is none, more than one, or one that is not assembled
    here.
    """
    volumes = [kind for kind in counts if kind.startswith(VOLUMES)]
    if not volumes:
        content = ", ".join(f"{n} {kind}" for kind, n in counts.items())
        raise MeshError(
            f"holds no volume elements ({content or 'no elements at all'}): mesh the inside too"
        )
    if len(volumes) > 1 or volumes[0] not in KINDS:
        content = ", ".join(f"{counts[kind]} {kind}" for kind in volumes)
        raise MeshError(f"holds {content}; write one kind of {', '.join(KINDS)}")
    return volumes[0]


class Lines:
    """Nodes, elements and sets of a file of lines, as they are read, each with the line."""

    def __init__(self) -> None:
        self.nodes: dict[int, tuple[int, int]] = {}  #: place and line, by number
        self.places: list[tuple[float, ...]] = []
        self.elements: list[Element] = []  #: of volumes
        self.other_kinds: dict[str, int] = {}  #: number of elements that are none of a volume
        #: nodes that something else than an element of a volume needs
        self.mentioned: set[int] = set()
        self.sets: dict[str, list[int]] = {}  #: numbers of elements by the name of their group
        self.material_sets: set[str] = set()  #: groups that stand for materials
        #: name of a group, number of an element that it lists one by one, and the line
        self.listed: list[tuple[str, int, int]] = []
        self.node_sets: dict[str, set[int]] = {}  #: numbers of nodes by the name of their group
        self.left_out = LeftOut()  #: all that the file carries beside elements of volumes
        self.materials: list[FileMaterial] = []  #: of groups
        self.of_material: dict[str, str] = {}  #: name of the material by that of its group
        self._other_elements: set[int] = set()
        self._lines: dict[int, int] = {}

    def add_node(self, number: int, line: int, point: Sequence[float]) -> None:
        """Add a node."""
        if len(point) != 3 or not np.isfinite(point).all():
            raise MeshError(f"line {line}: node {number} has a coordinate that is no number")
        if number in self.nodes:
            place, first = self.nodes[number]
            if self.places[place] != tuple(point):
                raise MeshError(
                    f"line {line}: node {number} is given twice, at another position than in line "
                    f"{first}"
                )
            return
        self.nodes[number] = (len(self.places), line)
        self.places.append(tuple(point))

    def add_element(self, number: int, line: int, kind: str, nodes: Sequence[int]) -> None:
        """Add an element of a volume."""
        if number in self._lines:
            raise MeshError(
                f"line {line}: element {number} is given twice, first in line {self._lines[number]}"
            )
        self._lines[number] = line
        self.elements.append(Element(number, line, kind, nodes))

    def add_other(self, kind: str, number: int, nodes: Iterable[int]) -> None:
        """Count an element that is none of a volume."""
        self.other_kinds[kind] = self.other_kinds.get(kind, 0) + 1
        self._other_elements.add(number)
        self.mentioned.update(nodes)

    def deck(self) -> Deck:
        """Return the mesh of all lines; MeshError for an element that names a node that is not
        there, a node that nothing needs, or a group with an element that is not there.
        """
        counts = dict(self.other_kinds)
        for element in self.elements:
            counts[element.kind] = counts.get(element.kind, 0) + 1
        kind = one_kind(counts)
        if not self.nodes:
            raise MeshError("holds elements and no nodes")
        for element in self.elements:
            for node in element.nodes:
                if node not in self.nodes:
                    raise MeshError(
                        f"line {element.line}: element {element.number} names node {node}, which "
                        "is not there"
                    )
        cells = np.array([[self.nodes[n][0] for n in e.nodes] for e in self.elements]).T
        self._refuse_spare_nodes(cells)
        for name, number, line in self.listed:
            if number not in self._lines and number not in self._other_elements:
                raise MeshError(
                    f"line {line}: group {name} lists element {number}, which is not there: lines "
                    "of elements are missing"
                )
        numbers = np.array([e.number for e in self.elements])
        place = {int(number): k for k, number in enumerate(numbers)}
        groups = []
        for name, members in self.sets.items():
            inside = sorted({place[n] for n in members if n in place})
            if inside:
                groups.append(Group(name, np.array(inside), name in self.material_sets))
        remarks = (*_gaps(numbers, [e.line for e in self.elements]), self.left_out.remark())
        return Deck(
            np.array(self.places, float).T,
            kind,
            cells,
            groups=tuple(groups),
            numbers=numbers,
            lines=np.array([e.line for e in self.elements]),
            remarks=tuple(filter(None, remarks)),
            patches=self._faces_of_node_sets(kind, cells),
            materials=tuple(self.materials),
        )

    def _faces_of_node_sets(self, kind: str, cells: np.ndarray) -> dict[str, np.ndarray]:
        """Return the corners of the faces of elements whose corners are all in a set of nodes, by the
        name of the set: those on the surface are a patch, such as the foot that a program holds.
        """
        faces = np.array(FACES[kind.rstrip("0123456789")])
        out = {}
        for name, nodes in self.node_sets.items():
            inside = np.zeros(len(self.places), bool)
            inside[[self.nodes[n][0] for n in nodes if n in self.nodes]] = True
            if inside[cells].all():
                continue  # a name for the whole mesh is none of a place
            corners = [cells[face][:, inside[cells[face]].all(axis=0)] for face in faces]
            if any(c.size for c in corners):
                out[name] = np.hstack(corners)
        return out

    def move(self, turn: np.ndarray, shift: np.ndarray) -> None:
        """Turn all nodes by (3, 3), and shift them by (3,)."""
        self.places = [tuple(turn @ place + shift) for place in np.array(self.places, float)]

    def nodes_of(self, elements: Iterable[int]) -> list[int]:
        """Return the nodes of elements by their numbers."""
        by_number = {e.number: e.nodes for e in self.elements}
        return [node for number in elements for node in by_number.get(number, ())]

    def place(self, node: int) -> tuple[float, ...] | None:
        """Return the coordinates of a node; None where the file has no such node."""
        return self.places[self.nodes[node][0]] if node in self.nodes else None

    def _refuse_spare_nodes(self, cells: np.ndarray) -> None:
        """Refuse nodes that nothing needs: elements are missing, then."""
        needed = np.zeros(len(self.places), bool)
        needed[cells] = True
        spare = [n for n, (k, _) in self.nodes.items() if not needed[k] and n not in self.mentioned]
        if spare:
            more = f", and {len(spare) - 1} more like it," if len(spare) > 1 else ""
            raise MeshError(
                f"line {self.nodes[spare[0]][1]}: node {spare[0]}{more} belongs to no element: "
                "add the missing lines of elements, or leave such nodes out"
            )


#: share of the numbers of elements that may be missing, and how many in any case, for the rest to
#: look like an unbroken row
FEW, AT_LEAST = 0.05, 12


def _gaps(numbers: np.ndarray, lines: Sequence[int]) -> Iterable[str]:
    """Yield a remark on numbers left out of an otherwise unbroken row."""
    order = np.argsort(numbers)
    row = numbers[order]
    step = np.diff(row) - 1
    missing = int(step.sum())
    if not 0 < missing <= max(AT_LEAST, FEW * len(row)):
        return
    first = int(np.flatnonzero(step)[0])
    number = int(row[first]) + 1
    absent = f"{number} and {missing - 1} more are" if missing > 1 else f"{number} is"
    yield (
        f"element {absent} missing in the row of elements {row[0]} to {row[-1]}, first after line "
        f"{lines[order[first]]}: unless left out on purpose, lines are lost and the part has a hole"
    )


def integer(text: str, line: int, quantity: str) -> int:
    """Return a whole number of a line; MeshError, which names the quantity, if it is none."""
    try:
        return int(text)
    except ValueError:
        raise MeshError(
            f"line {line}: {quantity} is {text.strip()[:20]!r} where a whole number is wanted"
        ) from None


def coordinates(entries: Sequence[str], line: int, node: int) -> list[float]:
    """Return the coordinates of a node; MeshError if one is no number."""
    try:
        return [float(re.sub("[dD]", "e", entry)) for entry in entries]
    except ValueError:
        raise MeshError(f"line {line}: node {node} has a coordinate that is no number") from None


def wrong_node_count(number: int, line: int, name: str, n: int, wanted: str) -> MeshError:
    """Return the error of an element with too few or too many nodes."""
    return MeshError(
        f"line {line}: element {number} of type {name} has {n} nodes where {wanted} are wanted: "
        "its line is cut off, or the type is wrong"
    )
