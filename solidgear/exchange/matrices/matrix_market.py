"""Matrix Market: a file for every matrix, and a sidecar in JSON with points and units."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import SceneError
from solidgear.core.reduction.matrix_units import MatrixUnits
from solidgear.core.reduction.port_matrices import MOST, PortMatrices
from solidgear.exchange.matrices.arrays import arrays_of
from solidgear.exchange.matrices.header import header

#: digits that give every number back
DIGITS = 17


def write(matrices: PortMatrices, path: Path, units: MatrixUnits) -> dict[Path, bytes]:
    """Return ``NAME_stiffness.mtx`` and so on, and ``NAME.json``."""
    from scipy.io import mmwrite  # start-up: for this format alone
    from scipy.sparse import coo_array

    out, files = {}, {}
    for name, matrix in matrices.in_units(units).items():
        file = path.with_name(f"{path.stem}_{name}.mtx")
        symmetry = "skew-symmetric" if name == "gyroscopic" else "symmetric"
        buffer = io.BytesIO()
        comment = "\n".join(header(matrices, units))
        mmwrite(buffer, coo_array(matrix), comment, "real", DIGITS, symmetry)
        out[file], files[name] = buffer.getvalue(), file.name
    arrays = arrays_of(matrices, units)
    facts = {key: arrays[key] for key in ("about", "units", "coordinates", "points")}
    facts |= {"positions": arrays["positions"].tolist(), "files": files}
    side = path.with_suffix(".json")
    return {**out, side: (json.dumps(facts, indent=1, ensure_ascii=False) + "\n").encode()}


def read(path: Path, source: str) -> Mapping[str, Any]:
    """Return the arrays of a sidecar and of the files that it names."""
    try:
        facts = json.loads(path.read_text("utf-8"))
    except json.JSONDecodeError as error:
        raise SceneError(f"is no JSON: {error}", where=source) from None
    if not isinstance(facts, dict) or not isinstance(facts.get("files"), dict):
        reason = 'names no matrices: "files" holds {"stiffness": ..., "mass": ...}'
        raise SceneError(reason, where=source)
    arrays = {key: value for key, value in facts.items() if key != "files"}
    for name, file in facts["files"].items():
        if not (path.parent / str(file)).is_file():
            raise SceneError(f"the file {file} of its {name} is missing", where=source)
        try:
            arrays[name] = _matrix(path.parent / str(file))
        except ValueError as error:
            raise SceneError(f"{file} is no Matrix Market file: {error}", where=source) from None
    return arrays


def _matrix(path: Path) -> np.ndarray:
    """Read a real matrix of coordinates; the reader of SciPy 1.17 ends the program where a row is
    out of range.
    """
    with path.open(encoding="utf-8", errors="replace") as file:
        words = file.readline().lower().split()
        if words[:3] != ["%%matrixmarket", "matrix", "coordinate"] or len(words) != 5:
            raise ValueError("its first line is not %%MatrixMarket matrix coordinate real ...")
        size = next((line for line in file if line.strip() and line[0] != "%"), "").split()
        rows, columns, count = (int(word) for word in size)
        table = np.loadtxt(file, comments="%", ndmin=2)
    if rows != columns or not 0 < rows <= MOST or table.shape != (count, 3):
        raise ValueError(f"{count} entries of {rows} by {columns} were announced")
    at = table[:, :2].astype(int) - 1
    if (at < 0).any() or (at >= rows).any():
        raise ValueError(f"an entry lies outside {rows} by {columns}")
    out = np.zeros((rows, rows))
    out[at[:, 0], at[:, 1]] = table[:, 2]
    below = np.tril(out, -1).T
    mirrored = {"symmetric": below, "skew-symmetric": -below, "general": 0 * below}
    if words[4] not in mirrored:
        raise ValueError(f"a {words[4]} matrix is not read")
    return out + mirrored[words[4]]
