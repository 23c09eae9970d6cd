"""Universal files (.unv, .uff) of test equipment: mode shapes and responses on measuring points, SI."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.errors import SceneError, SolidgearError

#: endings of their names
ENDINGS = (".unv", ".uff")
#: dataset 164's code -> m and N of its units; 9 gives factors of its own
UNITS = {
    1: (1.0, 1.0),
    2: (0.3048, 4.4482216152605),
    3: (1.0, 9.80665),
    4: (0.3048, 0.138254954376),
    5: (1e-3, 1e-3),
    6: (1e-2, 1e-2),
    7: (0.0254, 4.4482216152605),
    8: (1e-3, 9.80665),
}
#: dataset 58's kinds of data that carry a length (displacement, velocity, acceleration) or a force
LENGTHS, FORCES = (8, 11, 12), (9, 13)
#: dataset 55's analyses: normal modes; complex ones
NORMAL, COMPLEX = 2, (3, 7)
_MARK = re.compile(rb"^ {4}-1[ \t]*\r?$", re.MULTILINE)


@dataclass(frozen=True, eq=False)
class Shapes:
    """Measured shapes on points.

    Attributes
    ----------
    numbers : (p,) ndarray of int
        Of the points in the file.
    points : (p, 3) ndarray
        x, y, z in the scene's frame, m.
    values : (n, p, 3) ndarray
        A shape for every resonance, real or complex, to a factor; what no shape moves was not
        measured.
    """

    numbers: np.ndarray
    points: np.ndarray
    values: np.ndarray


@dataclass(frozen=True, eq=False)
class Responses:
    """Measured functions over one axis of frequencies.

    Attributes
    ----------
    frequencies : (k,) ndarray
        Hz.
    values : (n, k) ndarray
        SI.
    points : tuple of (int, int)
        Number and direction of the point of each: 1, 2, 3 for x, y, z, negative backwards.
    """

    frequencies: np.ndarray
    values: np.ndarray
    points: tuple[tuple[int, int], ...]


def read_shapes(path: str | os.PathLike) -> tuple[list[float], Shapes]:
    """Frequencies in Hz, ascending, and shapes of the modes of a universal file (dataset 55).

    Raises
    ------
    SceneError
        For a file cut short, without modes, points or units.
    """
    sets = _datasets(path)
    modes = [
        one for one in sets if one["type"] == 55 and one["analysis_type"] in (NORMAL, *COMPLEX)
    ]
    if not modes:
        raise _error(path, "holds no mode shapes (dataset 55 of normal or complex modes)")
    places = _points(path, sets)
    numbers = modes[0]["node_nums"]
    for one in modes:
        count = len(one["node_nums"])
        if any(len(one[r]) != count for r in ("r1", "r2", "r3")):
            raise _error(path, f"is cut short in mode {one['mode_n']}")
        if not np.array_equal(one["node_nums"], numbers):
            raise _error(path, f"has other points in mode {one['mode_n']} than in the first")
    missing = [int(k) for k in numbers if int(k) not in places]
    if missing:
        raise _error(path, f"gives no place of point {missing[0]} (dataset 15 or 2411)")
    hertz = [_hertz(one) for one in modes]
    order = np.argsort(hertz, kind="stable")
    values = np.array(
        [np.column_stack([modes[k]["r1"], modes[k]["r2"], modes[k]["r3"]]) for k in order]
    )
    if not np.all(np.isfinite(values)) or not np.all(np.any(values, axis=(1, 2))):
        raise _error(path, "has a mode shape that is zero or no number")
    points = np.array([places[int(k)] for k in numbers])
    return [hertz[k] for k in order], Shapes(np.asarray(numbers, int), points, values)


def read_responses(path: str | os.PathLike) -> Responses:
    """Responses of a universal file (dataset 58), all over one axis.

    Raises
    ------
    SceneError
        For a file cut short, without responses or units, or with more than one axis.
    """
    sets = _datasets(path)
    found = [one for one in sets if one["type"] == 58]
    if not found:
        raise _error(path, "holds no responses (dataset 58)")
    length, force = _units(path, sets)
    axis = found[0]["x"]
    for k, one in enumerate(found, start=1):
        if len(one["data"]) != one["num_pts"]:
            raise _error(
                path, f"is cut short in response {k}: {len(one['data'])} of {one['num_pts']} lines"
            )
        if not np.array_equal(one["x"], axis):
            raise _error(path, f"has other frequencies in response {k} than in the first")

    def unit(kind: int) -> float:
        if kind in LENGTHS:
            return length
        return force if kind in FORCES else 1.0

    values = np.array(
        [
            one["data"]
            * (unit(one["ordinate_spec_data_type"]) / unit(one["orddenom_spec_data_type"]))
            for one in found
        ]
    )
    return Responses(axis, values, tuple((one["rsp_node"], one["rsp_dir"]) for one in found))


def _datasets(path: str | os.PathLike) -> list[dict[str, Any]]:
    try:
        import pyuff
    except ImportError:
        raise SolidgearError(
            "universal files are read by pyuff: pip install 'solidgear[testdata]'"
        ) from None
    try:
        text = Path(path).read_bytes()
    except OSError as error:
        raise _error(path, f"cannot be read ({error})") from None
    if not _MARK.search(text):
        raise _error(path, "is no universal file: no line holds the mark -1 of a dataset")
    # binary data may run into the mark that ends them
    if not text.rstrip().endswith(b"    -1"):
        raise _error(path, "is cut short: its last dataset has no end")
    try:
        found = pyuff.UFF(os.fspath(path)).read_sets()
    except Exception as error:  # pyuff raises nothing narrower
        raise _error(path, f"cannot be read ({error})") from None
    return found if isinstance(found, list) else [found]


def _units(path: str | os.PathLike, sets: Sequence[Mapping[str, Any]]) -> tuple[float, float]:
    """Units of length and force, m and N."""
    found = [one for one in sets if one["type"] == 164]
    if not found:
        raise _error(path, "does not tell its units (dataset 164)")
    one = found[0]
    if one["units_code"] == 9 and one["length"] > 0 and one["force"] > 0:
        return 1 / one["length"], 1 / one["force"]
    if one["units_code"] not in UNITS:
        raise _error(path, f"has units of code {one['units_code']}; dataset 164 knows 1 to 9")
    return UNITS[one["units_code"]]


def _points(
    path: str | os.PathLike, sets: Sequence[Mapping[str, Any]]
) -> dict[int, tuple[float, float, float]]:
    """Number of a point -> x, y, z, m."""
    nodes = [one for one in sets if one["type"] in (15, 2411)]
    if not nodes:
        raise _error(path, "gives no places of its points (dataset 15 or 2411)")
    length, _ = _units(path, sets)
    systems = {int(s) for one in nodes for s in (*one["def_cs"], *one["disp_cs"])}
    if len(systems) > 1:
        raise _error(path, "has points in more than one coordinate system; write x, y, z of all")
    return {
        int(k): (length * x, length * y, length * z)
        for one in nodes
        for k, x, y, z in zip(one["node_nums"], one["x"], one["y"], one["z"])
    }


def _hertz(one: Mapping[str, Any]) -> float:
    """Frequency of a mode; of a complex one from its eigenvalue."""
    return float(one["freq"] if one["analysis_type"] == NORMAL else abs(one["eig"]) / (2 * np.pi))


def _error(path: str | os.PathLike, text: str) -> SceneError:
    return SceneError(text, where=os.fspath(path))
