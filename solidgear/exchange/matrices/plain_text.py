"""Plain text: a head of comments, then every matrix under its name, a row a line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import SceneError
from solidgear.core.reduction.matrix_units import MatrixUnits
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.exchange.matrices.arrays import MATRICES
from solidgear.exchange.matrices.header import header, stated


def write(matrices: PortMatrices, path: Path, units: MatrixUnits) -> dict[Path, bytes]:
    """Return the text."""
    lines = [f"# {line}" for line in header(matrices, units)]
    tables = {"positions": np.array([*matrices.positions.values()]) / units.length}
    for name, table in (tables | matrices.in_units(units)).items():
        lines.append(name)
        lines += [" ".join(f"{value!r:>24}" for value in row) for row in table.tolist()]
    return {path: ("\n".join(lines) + "\n").encode()}


def read(path: Path, source: str) -> Mapping[str, Any]:
    """Return the arrays of the text."""
    lines = path.read_text("utf-8", errors="replace").splitlines()
    head = stated(line for line in lines if line.startswith("#"))
    tables: dict[str, list[list[float]]] = {}
    name = ""
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.startswith("#"):
            continue
        if line.strip() in (*MATRICES, "positions"):
            name = line.strip()
            tables[name] = []
            continue
        try:
            tables[name].append([float(part) for part in line.split()])
        except (ValueError, KeyError):
            raise SceneError(f"line {number}: {line[:60]!r} is no row", where=source) from None
    points = [head.names[node] for node in sorted(head.names)]
    try:
        arrays = {name: np.array(rows) for name, rows in tables.items()}
    except ValueError:
        raise SceneError("rows of one matrix differ in length", where=source) from None
    return {"points": points, **({"units": head.units} if head.units else {}), **arrays}
