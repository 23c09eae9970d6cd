"""Matrix Market: a file for every matrix, and a sidecar in JSON with points, units and coordinates."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import SceneError
from solidgear.core.reduction.matrix_units import MatrixUnits
from solidgear.core.reduction.port_matrices import PortMatrices
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
    from scipy.io import mmread  # start-up: for this format alone
    from scipy.sparse import issparse

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
            matrix = mmread(path.parent / str(file))
        except ValueError as error:
            raise SceneError(f"{file} is no Matrix Market file: {error}", where=source) from None
        arrays[name] = matrix.toarray() if issparse(matrix) else np.asarray(matrix)
    return arrays
