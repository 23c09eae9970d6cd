"""Nastran: matrices as DMIG in large fields, points as GRID, modes as SPOINT.

A large field has 16 characters; numbers are written with the exponent that leaves most digits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from solidgear.core.reduction.matrix_units import MatrixUnits
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.exchange.matrices.header import header, stated
from solidgear.exchange.matrices.nodes import NodeMatrices, node_of

WIDTH = 16
#: names of matrices in a deck, and of what case control takes them as
NAMES = {"stiffness": "KSG", "mass": "MSG", "damping": "DSG", "gyroscopic": "GSG"}
CASE = {"stiffness": "K2GG", "mass": "M2GG", "damping": "K42GG", "gyroscopic": "B2PP"}
#: first letters by which other programs name the matrices they write
FIRST = {"K4": "damping", "K": "stiffness", "M": "mass"}
SYMMETRIC, SQUARE = 6, 1
#: parameters that multiply matrices
FACTORS = ("CK2", "CK42", "CM2", "CB2")


def real(value: float) -> str:
    """Return a number in 16 characters, as near as they allow.

    Examples
    --------
    >>> real(-1234567890.12341), real(1e-20), real(0.1)
    ('-1234567890.1234', '1.-20', '.1')
    """
    texts = []
    exponent = int(np.floor(np.log10(abs(value)))) if value else 0
    # without an exponent there are 14 digits, with one of a single figure 12
    for shift in (0,) if -2 < exponent < 13 else (exponent, 9, -9):
        tail = f"{shift:+d}" if shift else ""
        mantissa = value / 10.0**shift
        if not 1e-4 < abs(mantissa) < 1e14:
            continue
        whole = len(f"{abs(mantissa):.0f}") + (value < 0) + 1
        text = f"{mantissa:.{max(WIDTH - len(tail) - whole, 0)}f}"
        if abs(mantissa) < 1:  # the zero before the point leaves room for a digit more
            text = f"{mantissa:.{WIDTH - len(tail) - (value < 0) - 1}f}".replace("0.", ".", 1)
        text = text.rstrip("0") if "." in text else f"{text}."
        if len(text + tail) <= WIDTH and text not in ("", "."):
            texts.append(text + tail)
    return min(texts, key=lambda text: abs(number(text) - value), default="0.")


def number(text: str) -> float:
    """Read a real of a deck, whose exponent may have a D or no letter."""
    text = text.strip().upper().replace("D", "E")
    body = text.lstrip("+-")
    for sign in "+-":
        head, mark, tail = body.rpartition(sign)
        if mark and head and not head.endswith("E"):
            start = text[: len(text) - len(body)]
            return float(f"{start}{head}E{sign}{tail}")
    return float(text)


def write(matrices: PortMatrices, path: Path, units: MatrixUnits) -> dict[Path, bytes]:
    """Return the deck."""
    lines = [f"$ {line}" for line in header(matrices, units)]
    lines += [f"$ case control: {CASE[name]} = {NAMES[name]}" for name in matrices.matrices]
    points = len(matrices.positions)
    for k, place in enumerate(matrices.positions.values(), start=1):
        x, y, z = (real(v / units.length) for v in place)
        lines.append(f"{'GRID*':8}{k:>16}{'':16}{x:>16}{y:>16}")
        lines.append(f"{'*':8}{z:>16}")
    if matrices.modes:
        lines.append(f"{'SPOINT':8}{points + 1:>8}{'THRU':>8}{points + matrices.modes:>8}")
    for name, matrix in matrices.in_units(units).items():
        lines += _dmig(name, matrix, points)
    return {path: ("\n".join(lines) + "\n").encode()}


def _dmig(name: str, matrix: np.ndarray, points: int) -> Iterator[str]:
    """Yield the lines of one matrix, of a symmetric one its lower triangle by columns."""
    form = SQUARE if name == "gyroscopic" else SYMMETRIC
    label = NAMES[name]
    yield f"{'DMIG':8}{label:8}{0:>8}{form:>8}{2:>8}{0:>8}"
    for column in range(len(matrix)):
        first = 0 if form == SQUARE else column
        rows = [row for row in range(first, len(matrix)) if matrix[row, column] != 0]
        if not rows:
            continue
        yield f"{'DMIG*':8}{label:16}{_label(column, points)}"
        for row in rows:
            yield f"{'*':8}{_label(row, points)}{real(matrix[row, column]):>16}"


def _label(row: int, points: int) -> str:
    node, direction = node_of(row, points)
    return f"{node:>16}{direction if row < 6 * points else 0:>16}"


def read(path: Path, source: str) -> NodeMatrices:
    """Read DMIG and GRID of a deck, in small or large fields or with commas."""
    text = path.read_text(encoding="utf-8", errors="replace")
    out = NodeMatrices(source, head=stated(s for s in text.splitlines() if s[:1] == "$"))
    symmetric: dict[str, bool] = {}
    names: dict[str, str] = {}
    cards = list(_cards(text))
    usual = next((_systems(card) for card in cards if _kind(card) == "GRDSET"), ("", ""))
    turned = _rectangular(cards)
    _refuse_scales(out, text, cards)
    for card in cards:
        kind = _kind(card)
        if kind == "GRID" and len(card) > 5:
            place_in, move_in = (a or b for a, b in zip(_systems(card), usual))
            if place_in not in ("", "0"):
                raise out.wrong(
                    f"node {card[1].strip()} lies in coordinate system {place_in}; write nodes in the "
                    "basic system"
                )
            if move_in not in ("", "0"):
                if move_in not in turned:
                    raise out.wrong(
                        f"node {card[1].strip()} moves in coordinate system {move_in}; only those "
                        "of CORD2R in the basic system are read"
                    )
                out.turns[int(card[1])] = turned[move_in]
            out.places[int(card[1])] = np.array([number(v or "0") for v in card[3:6]])
        elif kind == "DMIG" and len(card) > 3:
            label = card[1].strip().upper()
            if card[2].strip() == "0" and label not in symmetric:
                if card[3].strip() not in (str(SYMMETRIC), str(SQUARE)):
                    raise out.wrong(
                        f"the matrix {label} has the form {card[3].strip()}; square (1) and symmetric "
                        "(6) ones are read"
                    )
                symmetric[label] = int(card[3]) == SYMMETRIC
                names[label] = _meaning(label)
                _refuse_complex(out, label, card)
                continue
            column = int(card[2]), int(card[3] or 0) or 1
            # four fields a term behind the empty one that ends the first line
            for k in range(5, len(card) - 2, 4):
                if card[k].strip():
                    row = int(card[k]), int(card[k + 1] or 0) or 1
                    value = number(card[k + 2])
                    out.add(names.get(label, label), row, column, value, symmetric.get(label, True))
    if not out.entries:
        raise out.wrong("has no DMIG entries")
    return out


def _kind(card: list[str]) -> str:
    return card[0].rstrip("*").upper()


def _systems(card: list[str]) -> tuple[str, str]:
    """Return the coordinate systems of the place and of the motions of a GRID or a GRDSET."""
    fields = (card + [""] * 7)[2:7]
    return fields[0].strip(), fields[4].strip()


def _rectangular(cards: list[list[str]]) -> dict[str, np.ndarray]:
    """Return the directions (3, 3) of rectangular systems in the basic one, as columns, by number."""
    out = {}
    for card in cards:
        if _kind(card) != "CORD2R" or card[2].strip() not in ("", "0"):
            continue
        values = [number(v) if v.strip() else 0.0 for v in (card + [""] * 9)[3:12]]
        origin, on_z, in_xz = np.reshape(values, (3, 3))
        z = on_z - origin
        y = np.cross(z, in_xz - origin)
        if np.any(y):
            z, y = z / np.linalg.norm(z), y / np.linalg.norm(y)
            out[card[1].strip()] = np.column_stack([np.cross(y, z), y, z])
    return out


def _refuse_scales(out: NodeMatrices, text: str, cards: list[list[str]]) -> None:
    """Refuse factors by which the deck multiplies its matrices."""
    for card in cards:
        name = card[1].strip().upper() if _kind(card) == "PARAM" and len(card) > 2 else ""
        if name in FACTORS and number(card[2]) != 1:
            raise out.wrong(
                f"PARAM {name} multiplies its matrices by {card[2].strip()}; leave it out"
            )
    factor = re.search(r"^\s*([KMB]\d+(?:GG|PP))\s*=.*\*", text, re.M | re.I)
    if factor:
        raise out.wrong(
            f"{factor[1].upper()} takes a matrix times a factor; multiply the matrix by it"
        )


def _meaning(label: str) -> str:
    """Return what a matrix is, by its name."""
    for name, deck_name in NAMES.items():
        if label == deck_name:
            return name
    return next((name for start, name in FIRST.items() if label.startswith(start)), label)


def _refuse_complex(out: NodeMatrices, label: str, card: list[str]) -> None:
    if len(card) > 4 and card[4].strip() in ("3", "4"):
        raise out.wrong(f"the matrix {label} is complex; real ones are read")


def _cards(text: str) -> Iterator[list[str]]:
    """Yield cards as fields, continuations joined: the name, then 8 small or 4 large ones a line."""
    card: list[str] = []
    for line in text.splitlines():
        line = line.split("$")[0].rstrip()
        if not line:
            continue
        fields = _fields(line)
        if fields[0] in ("", "*", "+") or fields[0][:1] in "*+":
            card += fields[1:]
            continue
        if card:
            yield card
        card = fields
    if card:
        yield card


def _fields(line: str) -> list[str]:
    if "," in line:
        name, *values = (part.strip() for part in line.split(","))
        return [name, *_filled(values, 4 if "*" in name else 8)]
    line = line.expandtabs(8)
    name = line[:8].strip()
    width = 16 if name.endswith("*") or name.startswith("*") else 8
    body = line[8:72]
    values = [body[k : k + width].strip() for k in range(0, len(body), width)]
    return [name, *_filled(values, 64 // width)]


def _filled(values: list[str], count: int) -> list[str]:
    """Return as many fields as a line has."""
    return (values + [""] * count)[:count]
