"""Lines at the head of a file of matrices: what they are, units, coordinates, points and modes."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from solidgear.core.frames import DOF_NAMES
from solidgear.core.reduction.matrix_units import MatrixUnits
from solidgear.core.reduction.port_matrices import PortMatrices

#: lines of points and units, as :func:`header` writes them behind any sign of a comment
POINT = re.compile(r'point (\d+) ("(?:[^"\\]|\\.)*") at ')
UNITS = re.compile(r"units: (\S+) ")


def header(matrices: PortMatrices, units: MatrixUnits) -> list[str]:
    """Return lines without any sign of a comment; nodes of points are numbered from one, each
    coordinate of a mode is a node of its own behind them.
    """
    count = len(matrices.positions)
    lines = [f"Matrices by solidgear of {matrices.source or 'a system'}", *matrices.notes]
    lines += [f"caution: {text}" for text in matrices.cautions]
    lines.append(f"units: {units.name} ({units.words}; radians and seconds)")
    lines.append(f"coordinates: {' '.join(DOF_NAMES)} of every point, then modes that move none")
    for k, (name, place) in enumerate(matrices.positions.items(), start=1):
        x, y, z = (format(v / units.length, ".9g") for v in place)
        lines.append(f"point {k} {quoted(name)} at x {x}, y {y}, z {z}")
    for k in range(matrices.modes):
        row = 6 * count + k
        ratio = matrices.stiffness[row, row] / matrices.mass[row, row]
        hertz = np.sqrt(max(ratio, 0.0)) / (2 * np.pi)
        lines.append(f"mode {k + 1} is node {count + k + 1}, {hertz:.6g} Hz with all points held")
    kinds = {
        "damping": "damping is structural: stiffness is K + i damping at every frequency",
        "gyroscopic": "gyroscopic is times velocities, antisymmetric",
    }
    lines += [text for name, text in kinds.items() if name in matrices.matrices]
    return [" ".join(line.splitlines()) for line in lines]


def quoted(name: str) -> str:
    """Return a name on one line, whatever is in it."""
    return json.dumps(name)


@dataclass
class Stated:
    """Facts that a head states."""

    names: dict[int, str] = field(default_factory=dict)  #: of nodes
    units: str = ""


def stated(lines: Iterable[str]) -> Stated:
    """Read names of points and units from the comments of a file."""
    out = Stated()
    for line in lines:
        if match := POINT.search(line):
            out.names[int(match[1])] = json.loads(match[2])
        elif match := UNITS.search(line):
            out.units = out.units or match[1]
    return out
