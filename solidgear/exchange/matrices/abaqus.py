"""Abaqus: matrices as ``*MATRIX INPUT``; what Abaqus and CalculiX write of matrices is read.

Read are lines ``node, direction, node, direction, value`` under ``*MATRIX INPUT`` or alone
(``*MATRIX GENERATE`` with ``*MATRIX OUTPUT``, files of one matrix each), also in files that these
name, in the directions of ``*TRANSFORM`` and times ``SCALE FACTOR``; the lower triangles of
``*USER ELEMENT`` (``*SUBSTRUCTURE MATRIX OUTPUT`` of both programs), and the ``.sti`` and ``.mas``
of CalculiX with the ``.dof`` beside them (``*FREQUENCY, SOLVER=MATRIXSTORAGE``).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from solidgear.core.reduction.matrix_units import MatrixUnits
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.exchange.matrices.header import header, stated
from solidgear.exchange.matrices.nodes import Label, NodeMatrices, node_of, real
from solidgear.parts.decks.left_out import KEYWORDS, sort_of

#: keywords of ``*MATRIX ASSEMBLE``, of matrices that Abaqus takes
KEYS = {"stiffness": "STIFFNESS", "mass": "MASS", "damping": "STRUCTURAL DAMPING"}
#: words in names of files of one matrix, and of the file beside it
BESIDE = (("STIF", "MASS"), ("stif", "mass"), (".sti", ".mas"))
SQUARE = "gyroscopic"
#: keywords whose data may stand in another file
NAMING = ("INCLUDE", "NODE", "MATRIX INPUT")
#: options of keywords that are read; any other would turn, scale or move what they hold
OPTIONS = {
    "NODE": ("NSET", "INPUT", "SYSTEM"),
    "NSET": ("NSET", "GENERATE", "UNSORTED", "INTERNAL"),
    "TRANSFORM": ("NSET", "TYPE"),
    "MATRIX INPUT": ("NAME", "INPUT", "TYPE", "SCALE FACTOR"),
    "MATRIX ASSEMBLE": ("STIFFNESS", "MASS", "STRUCTURAL DAMPING"),
    "MATRIX": ("TYPE",),
    "USER ELEMENT": ("NODES", "TYPE", "LINEAR", "COORDINATES", "PROPERTIES", "VARIABLES"),
}
#: keywords with data that move or turn nodes
MOVING = ("SYSTEM", "NMAP", "INSTANCE", "SUBSTRUCTURE PROPERTY")


def write(matrices: PortMatrices, path: Path, units: MatrixUnits) -> dict[Path, bytes]:
    """Return the input file."""
    points = len(matrices.positions)
    lines = [f"** {line}" for line in header(matrices, units)]
    lines.append("*NODE, NSET=POINTS")
    for k, place in enumerate(matrices.positions.values(), start=1):
        x, y, z = (real(v / units.length) for v in place)
        lines.append(f"{k}, {x}, {y}, {z}")
    if matrices.modes:
        lines.append("*NODE, NSET=MODES")
        lines += [f"{points + k}, 0., 0., 0." for k in range(1, matrices.modes + 1)]
    for name, matrix in matrices.in_units(units).items():
        shape = "UNSYMMETRIC" if name == SQUARE else "SYMMETRIC"
        lines.append(f"*MATRIX INPUT, NAME={name.upper()}, TYPE={shape}")
        half = matrix if name == SQUARE else np.tril(matrix)
        for row, column in np.argwhere(half):
            (node, direction), (to, to_direction) = node_of(row, points), node_of(column, points)
            lines.append(f"{node}, {direction}, {to}, {to_direction}, {real(half[row, column])}")
    keys = [f"{key}={name.upper()}" for name, key in KEYS.items() if name in matrices.matrices]
    lines.append(f"*MATRIX ASSEMBLE, {', '.join(keys)}")
    return {path: ("\n".join(lines) + "\n").encode()}


def read(path: Path, source: str) -> NodeMatrices:
    """Read an input file, or a file of one matrix with the other beside it."""
    out = NodeMatrices(source)
    if path.suffix.lower() in (".sti", ".mas"):
        return _stored(path, out)
    _read_into(out, path, "stiffness")
    if "mass" not in out.entries:
        for stiff, mass in BESIDE:
            beside = path.with_name(path.name.replace(stiff, mass))
            if beside != path and beside.is_file():
                _read_into(out, beside, "mass")
                break
    if not out.entries:
        raise out.wrong("has no *MATRIX INPUT, no *USER ELEMENT and no lines of a matrix")
    if "mass" not in out.entries:
        raise out.wrong(
            "has a stiffness alone; a body needs its mass too: *MATRIX GENERATE, STIFFNESS, MASS, "
            "or *SUBSTRUCTURE MATRIX OUTPUT, STIFFNESS=YES, MASS=YES"
        )
    return out


def _read_into(out: NodeMatrices, path: Path, alone: str) -> None:
    """Read one file; lines of a matrix without a keyword are of the matrix ``alone``."""
    deck = _Deck(out, alone)
    comments: list[str] = []
    for place, line in _lines(out, path):
        if line.startswith("%%MatrixMarket"):
            raise out.wrong(
                "is a Matrix Market file; name the .json beside it, which has the points"
            )
        if line.startswith("**"):
            comments.append(line)
            deck.element.comment(line)
        elif line.startswith("*"):
            deck.begin(*_keyword(line), place)
        elif line:
            deck.data(line, place)
    deck.finish()
    head = stated(comments)
    out.head.names |= head.names
    out.head.units = out.head.units or head.units


def _lines(
    out: NodeMatrices, path: Path, inside: tuple[Path, ...] = ()
) -> Iterator[tuple[str, str]]:
    """Yield the lines of a file, each with its place, and those of files that it names in theirs."""
    if path in inside:
        raise out.wrong(f"{path.name} names itself")
    name = f"{path.name}, " if inside else ""
    begun = ""
    for number, raw in enumerate(path.read_text("utf-8", errors="replace").splitlines(), start=1):
        line, begun = begun + raw.strip(), ""
        is_keyword = line.startswith("*") and not line.startswith("**")
        if is_keyword and line.endswith(","):
            begun = line  # it goes on in the next line
            continue
        keyword, options = _keyword(line) if is_keyword else ("", {})
        if keyword != "INCLUDE":
            yield f"{name}line {number}", line
        if keyword in NAMING and "INPUT" in options:
            beside = path.parent / options["INPUT"]
            if not beside.is_file():
                raise out.wrong(f"{name}line {number}: the file {options['INPUT']} is missing")
            yield from _lines(out, beside, (*inside, path))


def _keyword(line: str) -> tuple[str, dict[str, str]]:
    """Return a keyword in capitals and its options, with values as they are written."""
    name, *options = (part.strip() for part in line[1:].split(","))
    pairs = (option.partition("=") for option in options if option)
    return " ".join(name.upper().split()), {
        " ".join(key.upper().split()): value.strip().strip("\"'") for key, _, value in pairs
    }


class _Deck:
    """Keywords and data of a file, as they come; all that it turns or scales is known at its end."""

    def __init__(self, out: NodeMatrices, alone: str) -> None:
        self._out, self._alone = out, alone
        self.element = _Element()
        self._keyword, self._options = "", dict[str, str]()
        self._sets: dict[str, list[int]] = {}
        #: place, TYPE and NSET of a *TRANSFORM, and its numbers
        self._transforms: list[tuple[str, dict[str, str], list[float]]] = []
        #: entries by the name of a matrix; lines without a keyword have none
        self._entries: dict[str, list[tuple[Label, Label, float, bool]]] = {}
        self._roles: dict[str, list[str]] = {}  #: names of matrices, by what they are assembled as

    def begin(self, keyword: str, options: dict[str, str], place: str) -> None:
        """Begin a keyword; refuse options that would change numbers here."""
        self._keyword, self._options = keyword, options
        known = OPTIONS.get(keyword, options)
        for option in options:
            if option not in known:
                raise self._out.wrong(f"{place}: *{keyword} with {option} is not read here")
        if keyword == "NODE" and options.get("SYSTEM", "R").upper() != "R":
            raise self._out.wrong(
                f"{place}: nodes in another system than x, y, z are not read here"
            )
        if keyword == "MATRIX INPUT":
            shape = options.get("TYPE", "SYMMETRIC").upper()
            if shape not in ("SYMMETRIC", "UNSYMMETRIC"):
                raise self._out.wrong(f"{place}: a matrix of the type {shape} is not read here")
            self._scale = self._real(options.get("SCALE FACTOR", "1"), place)
            self._entries.setdefault(options.get("NAME", "").upper(), [])
        elif keyword == "MATRIX ASSEMBLE":
            for key, name in KEYS.items():
                if name in options:
                    self._roles.setdefault(key, []).append(options[name].upper())
        elif keyword == "USER ELEMENT":
            self.element = _Element()
        elif keyword == "MATRIX":
            self.element.begin(_meaning(options.get("TYPE", ""), self._alone))
        elif keyword == "TRANSFORM":
            self._transforms.append((place, options, []))
        elif sort_of(keyword, KEYWORDS) is not None and not keyword.startswith("MATRIX"):
            self._out.left_out[f"*{keyword}"] = None

    def data(self, line: str, place: str) -> None:
        """Read a line of data."""
        keyword = self._keyword
        if keyword in MOVING:
            raise self._out.wrong(f"{place}: *{keyword} moves or turns nodes, and is not read here")
        if keyword == "NSET":
            self._sets.setdefault(self._options.get("NSET", "").upper(), []).extend(
                self._members(line, place)
            )
            return
        try:
            values = [float(part) for part in line.replace(",", " ").split()]
        except ValueError:
            if keyword in ("MATRIX INPUT", "MATRIX", "USER ELEMENT", "NODE", "TRANSFORM"):
                raise self._out.wrong(f"{place}: {line[:60]!r} is no row of numbers") from None
            return
        if keyword == "NODE" and len(values) >= 4:
            self._out.places[int(values[0])] = np.array(values[1:4])
            self._sets.setdefault(self._options.get("NSET", "").upper(), []).append(int(values[0]))
        elif keyword == "TRANSFORM":
            self._transforms[-1][2].extend(values)
        elif keyword == "USER ELEMENT":
            self.element.direction(values)
        elif keyword == "MATRIX":
            self.element.numbers.setdefault(self.element.name, []).extend(values)
        elif keyword in ("", "MATRIX INPUT") and len(values) == 5:
            name, scale, symmetric = "", 1.0, True
            if keyword:
                name, scale = self._options.get("NAME", "").upper(), self._scale
                symmetric = self._options.get("TYPE", "SYMMETRIC").upper() != "UNSYMMETRIC"
            row, column = (int(values[0]), int(values[1])), (int(values[2]), int(values[3]))
            self._entries.setdefault(name, []).append((row, column, scale * values[4], symmetric))

    def finish(self) -> None:
        """Hand what was read to the matrices by nodes."""
        for name, entries in self._entries.items():
            meaning = self._meaning(name)
            for row, column, value, symmetric in entries if meaning else ():
                self._out.add(meaning, row, column, value, symmetric)
        self.element.into(self._out)
        for place, options, numbers in self._transforms:
            name = options.get("NSET", "")
            if name.upper() not in self._sets:
                raise self._out.wrong(f"{place}: there is no set of nodes {name!r}")
            for node in self._sets[name.upper()]:
                self._out.turns[node] = self._axes(place, options, numbers, node)

    def _meaning(self, name: str) -> str:
        """Return what a matrix is: as it is assembled, else by its name, else the only one; empty for
        one that is not assembled.
        """
        if self._roles:
            return next((key for key, names in self._roles.items() if name in names), "")
        meaning = _meaning(name, "")
        if not meaning and len(self._entries) > 1:
            raise self._out.wrong(
                f"nothing says what the matrix {name or 'without a name'} is; add *MATRIX ASSEMBLE "
                "with STIFFNESS= and MASS="
            )
        return meaning or self._alone

    def _axes(
        self, place: str, options: dict[str, str], numbers: list[float], node: int
    ) -> np.ndarray:
        """Return the directions (3, 3) of a node that a *TRANSFORM turns, as columns in x, y, z."""
        kind = options.get("TYPE", "R").upper()
        if kind not in ("R", "C") or len(numbers) != 6:
            raise self._out.wrong(
                f"{place}: *TRANSFORM with six numbers and TYPE=R or C is read, not {kind}"
            )
        a, b = np.array(numbers[:3]), np.array(numbers[3:])
        if kind == "R":
            first, across = a, b
        else:
            if node not in self._out.places:
                raise self._out.wrong(f"{place}: nothing says where its node {node} lies")
            axis = b - a
            first = self._out.places[node] - a
            first = first - axis * (first @ axis) / max(axis @ axis, np.finfo(float).tiny)
            across = np.cross(axis, first)
        third = np.cross(first, across)
        size = np.linalg.norm(first), np.linalg.norm(third)
        if not min(size) > 0:
            raise self._out.wrong(f"{place}: *TRANSFORM gives node {node} no directions")
        first, third = first / size[0], third / size[1]
        return np.column_stack([first, np.cross(third, first), third])

    def _members(self, line: str, place: str) -> list[int]:
        """Return the nodes of a line of a set."""
        words = [word.strip() for word in line.split(",") if word.strip()]
        if "GENERATE" in self._options:
            first, last, *step = (int(self._real(word, place)) for word in words[:3])
            return [*range(first, last + 1, max(*step, 1) if step else 1)]
        out: list[int] = []
        for word in words:
            out += [int(word)] if word.isdigit() else self._sets.get(word.upper(), [])
        return out

    def _real(self, text: str, place: str) -> float:
        try:
            return float(text)
        except ValueError:
            raise self._out.wrong(f"{place}: {text[:30]!r} is no number") from None


def _meaning(word: str, alone: str) -> str:
    """Return what a matrix is, by a word of its name."""
    for start, name in (("STIF", "stiffness"), ("MASS", "mass"), ("GYRO", "gyroscopic")):
        if start in word.upper():
            return name
    return "damping" if "DAMP" in word.upper() else alone


class _Element:
    """Matrices of a user element: lower triangles of the directions of its nodes."""

    def __init__(self) -> None:
        self._nodes: list[int] = []
        self._listed = False
        self._directions: list[tuple[int, list[int]]] = []  # from which of the nodes on
        self.name = "stiffness"
        self.numbers: dict[str, list[float]] = {}

    def comment(self, line: str) -> None:
        """Read the nodes, which comments list."""
        if "ELEMENT NODES" in line.upper():
            self._listed, self._nodes = True, []
        elif self._listed and re.fullmatch(r"\*\*[\s\d,]+", line):
            self._nodes += [int(part) for part in re.findall(r"\d+", line)]

    def direction(self, values: Iterable[float]) -> None:
        """Read active directions: of all nodes first, then from a node on."""
        numbers = [int(v) for v in values]
        start = 1
        if self._directions:
            start, *numbers = numbers
        self._directions.append((start, numbers))

    def begin(self, name: str) -> None:
        """Begin a matrix."""
        self.name, self._listed = name, False

    def labels(self) -> list[Label]:
        """Return nodes and directions in the order of rows."""
        out = []
        for place, node in enumerate(self._nodes, start=1):
            active = [numbers for start, numbers in self._directions if start <= place]
            out += [(node, direction) for direction in (active[-1] if active else [])]
        return out

    def into(self, out: NodeMatrices) -> None:
        """Add the matrices to those of the file."""
        labels = self.labels()
        n = len(labels)
        for name, numbers in self.numbers.items():
            if len(numbers) != n * (n + 1) // 2:
                raise out.wrong(
                    f"the {name} of the user element has {len(numbers)} numbers; the lower "
                    f"triangle of {n} directions has {n * (n + 1) // 2}"
                )
            values = iter(numbers)
            for i, row in enumerate(labels):
                for column in labels[: i + 1]:
                    out.add(name, row, column, next(values), True)


def _stored(path: Path, out: NodeMatrices) -> NodeMatrices:
    """Read the matrices that CalculiX stores: row, column and value, and what a row is."""
    labels = path.with_suffix(".dof")
    files = {"stiffness": path.with_suffix(".sti"), "mass": path.with_suffix(".mas")}
    for file in (labels, *files.values()):
        if not file.is_file():
            raise out.wrong(f"{file.name} is missing beside it; CalculiX writes all three")
    texts = labels.read_text("utf-8").split()
    rows = [(int(node), int(direction)) for node, direction in (t.split(".") for t in texts)]
    tables = {}
    for name, file in files.items():
        try:
            row, column, value = np.loadtxt(file, ndmin=2).T
            at = row.astype(int) - 1, column.astype(int) - 1
            half = sp.csr_matrix((value, at), shape=(len(rows), len(rows)))
        except ValueError:
            raise out.wrong(f"{file.name} has other lines than row, column and value") from None
        tables[name] = half + sp.triu(half, 1).T + sp.tril(half, -1).T
    out.stored = rows, {name: table.tocsr() for name, table in tables.items()}
    return out
