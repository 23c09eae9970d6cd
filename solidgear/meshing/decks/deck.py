"""Content of a mesh file, whatever its format: nodes, elements of one kind, and groups of them."""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from solidgear.meshing.decks.left_out import LeftOut
from solidgear.meshing.quality import MeshError
from solidgear.scene.file_materials import FileMaterial

#: how a file ends, and the module of this room that reads it
FORMATS = {
    ".msh": "foreign",
    ".inp": "abaqus",
    ".bdf": "nastran",
    ".nas": "nastran",
    ".vtu": "foreign",
    ".unv": "universal",
}
#: lines by which files that end otherwise, such as .dat, are known, and the modules that read them
CONTENTS = {
    "nastran": r"^\s*BEGIN\s+BULK|^GRID\b[*,\s]",
    "abaqus": r"^\*(?:NODE|HEADING|PART|INCLUDE)\b",
    "universal": r"\A\s*-1\s*\n\s*(?:151|164|2411|2420|781)\s*\n",
}
#: kinds of cells that are assembled, in meshio's words, and what they are called here
KINDS = {
    "tetra": "tet4",
    "tetra10": "tet10",
    "hexahedron": "hex8",
    "hexahedron20": "hex20",
}
#: how kinds of cells of a volume begin
VOLUMES = ("wedge", "pyramid", "hexahedron", "tetra", "polyhedron", "VTK_LAGRANGE")


@dataclass(frozen=True)
class Group:
    """Elements that a file gives a name."""

    name: str  #: as one writes it in a scene
    elements: np.ndarray  #: (n,) places in :attr:`Deck.cells`
    #: whether such groups are made to tell materials, and not, say, where loads act
    tells: bool = True


@dataclass(frozen=True)
class Deck:
    """A mesh as its file has it."""

    points: np.ndarray  #: (3, n) in the unit of the file
    kind: str  #: of its cells, one of `KINDS`
    cells: np.ndarray  #: (nodes, ne) in VTK's order of nodes
    groups: tuple[Group, ...] = ()
    numbers: np.ndarray | None = None  #: (ne,) by which the file calls its elements
    lines: np.ndarray | None = None  #: (ne,) where in the file they begin, counted from 1
    remarks: tuple[str, ...] = ()  #: what is odd about the file, but no fault
    #: corners (3 or 4, n) of the faces of named groups of surfaces
    patches: Mapping[str, np.ndarray] = field(default_factory=dict)
    materials: tuple[FileMaterial, ...] = ()  #: that the file says itself, of its groups

    def named(self, place: int) -> str:
        """An element in a sentence, by its place in :attr:`cells`."""
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
    """The mesh in a file; MeshError where it cannot be read or has no elements of one kind that is
    assembled here.
    """
    module = importlib.import_module(f"solidgear.meshing.decks.{reader_of(path)}")
    reader: Callable[[str], Deck] = module.read
    return reader(path)


def reader_of(path: str) -> str:
    """The module of this room that reads a file: by how its name ends, else by what is in it."""
    ending = Path(path).suffix.lower()
    if ending in FORMATS:
        return FORMATS[ending]
    text = text_of(path)
    for module, begins in CONTENTS.items():
        if re.search(begins, text, re.I | re.M):
            return module
    raise MeshError(
        f"a mesh file that ends in {ending or 'nothing'} is unknown, and what is in it is neither "
        f"Nastran, Abaqus nor a universal file; known are {', '.join(FORMATS)}"
    )


def text_of(path: str) -> str:
    """The text of a file; MeshError where it cannot be opened, or holds no text."""
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise MeshError(f"cannot be read ({error.strerror or error})") from None
    if b"\0" in content:
        raise MeshError("is no text: it holds zero bytes")
    return content.decode("utf-8", "replace")


def one_kind(counts: dict[str, int]) -> str:
    """The one kind of cells of a volume, by the cells of each kind (in meshio's words) that a file
    holds; MeshError where there is none, more than one, or one that is not assembled here.
    """
    volumes = [kind for kind in counts if kind.startswith(VOLUMES)]
    if not volumes:
        told = ", ".join(f"{n} {kind}" for kind, n in counts.items())
        raise MeshError(
            f"holds no volume elements ({told or 'no elements at all'}): mesh the inside too"
        )
    if len(volumes) > 1 or volumes[0] not in KINDS:
        told = ", ".join(f"{counts[kind]} {kind}" for kind in volumes)
        raise MeshError(
            f"holds {told}; wanted is one kind of {', '.join(KINDS)}, for no other is assembled"
        )
    return volumes[0]


class Lines:
    """Collection of a reader of lines: nodes, elements and sets, each with where it stands.

    Attributes
    ----------
    nodes : dict of int to (place, line)
    places : list of (float, float, float)
    elements : list of Element
        Of volumes.
    mentioned : set of int
        Nodes that something else than an element of a volume needs.
    sets : dict of str to list of int
        Numbers of elements by the name of their group.
    telling : set of str
        Groups that are made to tell materials.
    listed : list of (str, int, int)
        Name of a group, number of an element that it lists one by one, and the line.
    left_out : LeftOut
        What the file carries beside its elements of volumes.
    materials : list of FileMaterial
        Of groups.
    of_material : dict of str to str
        Name of a material by that of a group that is of it.
    """

    def __init__(self) -> None:
        self.nodes: dict[int, tuple[int, int]] = {}
        self.places: list[tuple[float, ...]] = []
        self.elements: list[Element] = []
        self.others: dict[str, int] = {}
        self.mentioned: set[int] = set()
        self.sets: dict[str, list[int]] = {}
        self.telling: set[str] = set()
        self.listed: list[tuple[str, int, int]] = []
        self.left_out = LeftOut()
        self.materials: list[FileMaterial] = []
        self.of_material: dict[str, str] = {}
        self._others: set[int] = set()
        self._lines: dict[int, int] = {}

    def node(self, number: int, line: int, at: Sequence[float]) -> None:
        """Take a node."""
        if len(at) != 3 or not np.isfinite(at).all():
            raise MeshError(f"line {line}: node {number} has a coordinate that is no number")
        if number in self.nodes:
            place, first = self.nodes[number]
            if self.places[place] != tuple(at):
                raise MeshError(
                    f"line {line}: node {number} is there a second time, at another place than in "
                    f"line {first}"
                )
            return
        self.nodes[number] = (len(self.places), line)
        self.places.append(tuple(at))

    def element(self, number: int, line: int, kind: str, nodes: Sequence[int]) -> None:
        """Take an element of a volume."""
        if number in self._lines:
            raise MeshError(
                f"line {line}: element {number} is there a second time, first in line "
                f"{self._lines[number]}"
            )
        self._lines[number] = line
        self.elements.append(Element(number, line, kind, nodes))

    def other(self, kind: str, number: int, nodes: Iterable[int]) -> None:
        """Take an element that is none of a volume."""
        self.others[kind] = self.others.get(kind, 0) + 1
        self._others.add(number)
        self.mentioned.update(nodes)

    def deck(self) -> Deck:
        """All of it.

        Raises
        ------
        MeshError
            An element that names a node that is not there, a node that nothing needs, or a group with
        an element that is not there.
        """
        counts = dict(self.others)
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
        own = np.array([[self.nodes[n][0] for n in e.nodes] for e in self.elements]).T
        self._all_needed(own)
        for name, number, line in self.listed:
            if number not in self._lines and number not in self._others:
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
                groups.append(Group(name, np.array(inside), name in self.telling))
        remarks = (*_gaps(numbers, [e.line for e in self.elements]), self.left_out.remark())
        return Deck(
            np.array(self.places, float).T,
            kind,
            own,
            tuple(groups),
            numbers,
            np.array([e.line for e in self.elements]),
            tuple(filter(None, remarks)),
            materials=tuple(self.materials),
        )

    def place(self, node: int) -> tuple[float, ...] | None:
        """Coordinates of a node, where it is there."""
        return self.places[self.nodes[node][0]] if node in self.nodes else None

    def _all_needed(self, cells: np.ndarray) -> None:
        """Refuse nodes that nothing needs: elements are missing, then."""
        needed = np.zeros(len(self.places), bool)
        needed[cells] = True
        spare = [n for n, (k, _) in self.nodes.items() if not needed[k] and n not in self.mentioned]
        if spare:
            more = f", and {len(spare) - 1} more like it," if len(spare) > 1 else ""
            raise MeshError(
                f"line {self.nodes[spare[0]][1]}: node {spare[0]}{more} belongs to no element: "
                "lines of elements are missing, or else leave such nodes out"
            )


#: share of the numbers of elements that may be missing, and how many in any case, for the rest to
#: look like an unbroken row
FEW, AT_LEAST = 0.05, 12


def _gaps(numbers: np.ndarray, lines: Sequence[int]) -> Iterable[str]:
    """Numbers left out of what is otherwise an unbroken row."""
    order = np.argsort(numbers)
    row = numbers[order]
    step = np.diff(row) - 1
    missing = int(step.sum())
    if not 0 < missing <= max(AT_LEAST, FEW * len(row)):
        return
    first = int(np.flatnonzero(step)[0])
    number = int(row[first]) + 1
    what = f"{number} and {missing - 1} more are" if missing > 1 else f"{number} is"
    yield (
        f"element {what} missing in the row of elements {row[0]} to {row[-1]}, first after line "
        f"{lines[order[first]]}: unless left out on purpose, lines are lost and the part has a hole"
    )


def integer(text: str, line: int, what: str) -> int:
    """A whole number of a line, and what it stands for; MeshError if it is none."""
    try:
        return int(text)
    except ValueError:
        raise MeshError(
            f"line {line}: {what} is {text.strip()[:20]!r} where a whole number is wanted"
        ) from None


def coordinates(entries: Sequence[str], line: int, node: int) -> list[float]:
    """Coordinates of a node; MeshError if one is no number."""
    try:
        return [float(re.sub("[dD]", "e", entry)) for entry in entries]
    except ValueError:
        raise MeshError(f"line {line}: node {node} has a coordinate that is no number") from None


def told_short(number: int, line: int, name: str, has: int, wanted: str) -> MeshError:
    """An element with too few or too many nodes."""
    return MeshError(
        f"line {line}: element {number} of type {name} has {has} nodes where {wanted} are wanted: "
        "its line is cut off, or the type is wrong"
    )
