"""NumPy and MATLAB: matrices, names and positions of points as arrays of one file."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import SceneError
from solidgear.core.reduction.matrix_units import SI, MatrixUnits, matrix_units
from solidgear.core.reduction.port_matrices import PortMatrices, checked_matrices, named_once
from solidgear.exchange.matrices.header import header

MATRICES = ("mass", "stiffness", "damping", "gyroscopic")
ARRAYS = ("mass", "stiffness", "points", "positions")


def arrays_of(matrices: PortMatrices, units: MatrixUnits) -> dict[str, Any]:
    """Return the arrays of a file."""
    places = np.array([*matrices.positions.values()]) / units.length
    fields = {"points": [*matrices.positions], "positions": places}
    words = {"coordinates": matrices.coordinates, "units": units.name}
    return matrices.in_units(units) | fields | words | {"about": header(matrices, units)}


def write_npz(matrices: PortMatrices, path: Path, units: MatrixUnits) -> dict[Path, bytes]:
    """Return an ``.npz`` file."""
    buffer = io.BytesIO()
    np.savez(buffer, **arrays_of(matrices, units))
    return {path: buffer.getvalue()}


def write_mat(matrices: PortMatrices, path: Path, units: MatrixUnits) -> dict[Path, bytes]:
    """Return a ``.mat`` file of level 5, lists of words as cells; none is read, for the reader of
    SciPy 1.17 ends the program on damaged ones.
    """
    from scipy.io import savemat  # start-up: for this format alone

    arrays = arrays_of(matrices, units)
    for name in ("points", "coordinates", "about"):
        cells = np.empty(len(arrays[name]), object)
        cells[:] = arrays[name]
        arrays[name] = cells
    buffer = io.BytesIO()
    savemat(buffer, arrays)
    return {path: buffer.getvalue()}


def read_npz(path: Path, source: str) -> Mapping[str, Any]:
    """Return the arrays of an ``.npz`` file."""
    with np.load(path, allow_pickle=False) as store:
        return {name: store[name] for name in store}


def from_arrays(arrays: Mapping[str, Any], source: str, units: str) -> PortMatrices:
    """Return the matrices of arrays by name."""
    missing = [name for name in ARRAYS if name not in arrays]
    if missing:
        reason = f"has no array {missing[0]!r}; it holds {', '.join(ARRAYS)}"
        raise SceneError(reason, where=source)
    names = [str(name) for name in np.ravel(arrays["points"])]
    named_once(names, source)
    try:
        positions = np.array(arrays["positions"], float)
    except (ValueError, TypeError):
        raise SceneError("positions must be three numbers a point", where=source) from None
    if positions.shape != (len(names), 3):
        raise SceneError(
            f"{len(names)} points and positions {positions.shape} do not fit; of p points, these "
            "are (p, 3)",
            where=source,
        )
    matrices = {name: np.asarray(arrays[name]) for name in MATRICES if name in arrays}
    system = matrix_units(units or str(arrays.get("units", SI.name)))
    return checked_matrices(source, matrices, dict(zip(names, positions)), system)
