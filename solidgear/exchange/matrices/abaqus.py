"""Abaqus: matrices as ``*MATRIX INPUT``; what Abaqus and CalculiX write of matrices is read.

Read are lines ``node, direction, node, direction, value`` under ``*MATRIX INPUT`` or alone
(``*MATRIX GENERATE`` with ``*MATRIX OUTPUT``, files of one matrix each), the lower triangles of
``*USER ELEMENT`` (``*SUBSTRUCTURE MATRIX OUTPUT`` of both programs), and the ``.sti`` and ``.mas``
of CalculiX with the ``.dof`` beside them (``*FREQUENCY, SOLVER=MATRIXSTORAGE``).
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from solidgear.core.reduction.matrix_units import MatrixUnits
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.exchange.matrices.header import header, stated
from solidgear.exchange.matrices.nodes import Label, NodeMatrices, node_of, real

#: keywords of ``*MATRIX ASSEMBLE``, of matrices that Abaqus takes
KEYS = {"stiffness": "STIFFNESS", "mass": "MASS", "damping": "STRUCTURAL DAMPING"}
#: words in names of files of one matrix, and of the file beside it
BESIDE = (("STIF", "MASS"), ("stif", "mass"), (".sti", ".mas"))
SQUARE = "gyroscopic"


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
    comments: list[str] = []
    keyword, name = "", alone
    options: dict[str, str] = {}
    element = _Element()
    lines = path.read_text("utf-8", errors="replace").splitlines()
    if lines and lines[0].startswith("%%MatrixMarket"):
        raise out.wrong("is a Matrix Market file; name the .json beside it, which has the points")
    for number, raw in enumerate(lines, start=1):
        line = raw.strip()
        if line.startswith("**"):
            comments.append(line)
            element.comment(line)
        elif line.startswith("*"):
            keyword, options = _keyword(line)
            if keyword == "MATRIX INPUT":
                name = _meaning(options.get("NAME", ""), alone)
            elif keyword == "USER ELEMENT":
                element = _Element()
            elif keyword == "MATRIX":
                element.begin(_meaning(options.get("TYPE", ""), alone))
        elif line:
            try:
                values = [float(part) for part in line.replace(",", " ").split()]
            except ValueError:
                if keyword in ("MATRIX INPUT", "MATRIX", "USER ELEMENT", "NODE"):
                    raise out.wrong(f"line {number}: {line[:60]!r} is no row of numbers") from None
                continue
            if keyword == "NODE" and len(values) >= 4:
                out.places[int(values[0])] = np.array(values[1:4])
            elif keyword == "USER ELEMENT":
                element.direction(values)
            elif keyword == "MATRIX":
                element.numbers.setdefault(element.name, []).extend(values)
            elif keyword in ("", "MATRIX INPUT") and len(values) == 5:
                row, column = (int(values[0]), int(values[1])), (int(values[2]), int(values[3]))
                symmetric = options.get("TYPE", "SYMMETRIC") != "UNSYMMETRIC"
                out.add(name, row, column, values[4], symmetric)
    head = stated(comments)
    out.head.names |= head.names
    out.head.units = out.head.units or head.units
    element.into(out)


def _keyword(line: str) -> tuple[str, dict[str, str]]:
    """Return a keyword and its options, in capitals."""
    name, *options = (part.strip().upper() for part in line[1:].split(","))
    pairs = (option.partition("=") for option in options)
    return " ".join(name.split()), {key.strip(): value.strip() for key, _, value in pairs}


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
