"""Universal files (.unv, .uff) of test equipment: mode shapes and responses on measuring points, SI."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.errors import SceneError, SolidgearError
from solidgear.scene.universal_units import units_of
from solidgear.studies.loading import explained

#: endings of their names
ENDINGS = (".unv", ".uff")
#: dataset 58's kinds of data that carry a length (displacement, velocity, acceleration) or a force
LENGTHS, FORCES = (8, 11, 12), (9, 13)
#: its function that is a frequency response
RESPONSE = 4
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
    """Measured frequency responses over one axis of frequencies.

    Attributes
    ----------
    frequencies : (k,) ndarray
        Hz.
    values : (n, k) ndarray of complex
        SI.
    points, references : tuple of (int, int)
        Number and direction of the point of each, and of where it was driven: 1, 2, 3 for x, y, z,
        negative backwards; empty where nothing tells them.
    places : mapping of int to (float, float, float)
        Of points by their numbers, m; empty where nothing tells them.
    derivatives : int or None
        Times that the displacement is differentiated in what is over a force: 2 for an
        acceleration; None where nothing tells it.
    """

    frequencies: np.ndarray
    values: np.ndarray
    points: tuple[tuple[int, int], ...] = ()
    references: tuple[tuple[int, int], ...] = ()
    places: Mapping[int, tuple[float, float, float]] = field(default_factory=dict)
    derivatives: int | None = None


def read_universal(path: str | os.PathLike) -> tuple[list[float], Shapes] | Responses:
    """Frequencies in Hz, ascending, and shapes of the modes of a universal file (dataset 55), or its
    frequency responses (dataset 58) where it has no modes.

    Raises
    ------
    SceneError
        For a file cut short, without units, with neither, with modes without points, and with
        responses over more than one axis.
    """
    try:
        from pyuff import UFF
    except ImportError:
        raise SolidgearError(
            "universal files are read by pyuff: pip install 'solidgear[testdata]'"
        ) from None
    with explained(path, {}):
        sets = _datasets(Path(path), UFF)
        kinds = NORMAL, *COMPLEX
        modes = [one for one in sets if one["type"] == 55 and one["analysis_type"] in kinds]
        if modes:
            return _shapes(sets, modes)
        found = [one for one in sets if one["type"] == 58 and one["func_type"] == RESPONSE]
        if found:
            return _responses(sets, found)
        raise SceneError(
            "holds no mode shapes (dataset 55 of normal or complex modes) and no frequency responses "
            "(dataset 58, function 4)"
        )


def _shapes(
    sets: Sequence[Mapping[str, Any]], modes: Sequence[Mapping[str, Any]]
) -> tuple[list[float], Shapes]:
    places = _points(sets)
    numbers = modes[0]["node_nums"]
    for one in modes:
        count = len(one["node_nums"])
        if any(len(one[r]) != count for r in ("r1", "r2", "r3")):
            raise SceneError(f"is cut short in mode {one['mode_n']}")
        if not np.array_equal(one["node_nums"], numbers):
            raise SceneError(f"has other points in mode {one['mode_n']} than in the first")
    missing = [int(k) for k in numbers if int(k) not in places]
    if missing:
        raise SceneError(f"gives no place of point {missing[0]} (dataset 15 or 2411)")
    hertz = [_hertz(one) for one in modes]
    order = np.argsort(hertz, kind="stable")
    values = np.array(
        [np.column_stack([modes[k]["r1"], modes[k]["r2"], modes[k]["r3"]]) for k in order]
    )
    if not np.all(np.isfinite(values)) or not np.all(np.any(values, axis=(1, 2))):
        raise SceneError("has a mode shape that is zero or no number")
    points = np.array([places[int(k)] for k in numbers])
    return [hertz[k] for k in order], Shapes(np.asarray(numbers, int), points, values)


def _responses(sets: Sequence[Mapping[str, Any]], found: Sequence[Mapping[str, Any]]) -> Responses:
    length, force = _units(sets)
    axis = found[0]["x"]
    kinds = found[0]["ordinate_spec_data_type"], found[0]["orddenom_spec_data_type"]
    for k, one in enumerate(found, start=1):
        if len(one["data"]) != one["num_pts"]:
            raise SceneError(
                f"is cut short in response {k}: {len(one['data'])} of {one['num_pts']} lines"
            )
        if not np.array_equal(one["x"], axis):
            raise SceneError(f"has other frequencies in response {k} than in the first")
        if (one["ordinate_spec_data_type"], one["orddenom_spec_data_type"]) != kinds:
            raise SceneError(f"has another kind of data in response {k} than in the first")

    def unit(kind: int) -> float:
        if kind in LENGTHS:
            return length
        return force if kind in FORCES else 1.0

    told = kinds[0] in LENGTHS and kinds[1] in FORCES
    return Responses(
        axis,
        np.array([one["data"] for one in found], complex) * (unit(kinds[0]) / unit(kinds[1])),
        tuple((one["rsp_node"], one["rsp_dir"]) for one in found),
        tuple((one["ref_node"], one["ref_dir"]) for one in found),
        _points(sets) if any(one["type"] in (15, 2411) for one in sets) else {},
        LENGTHS.index(kinds[0]) if told else None,
    )


def _datasets(path: Path, reader: Callable) -> list[dict[str, Any]]:
    """All datasets of a file that is whole."""
    try:
        text = path.read_bytes()
    except OSError as error:
        raise SceneError(f"cannot be read ({error})") from None
    if not _MARK.search(text):
        raise SceneError("is no universal file: no line holds the mark -1 of a dataset")
    # binary data may run into the mark that ends them
    if not text.rstrip().endswith(b"    -1"):
        raise SceneError("is cut short: its last dataset has no end")
    try:
        found = reader(os.fspath(path)).read_sets()
    except Exception as error:  # pyuff raises nothing narrower
        raise SceneError(f"cannot be read ({error})") from None
    return found if isinstance(found, list) else [found]


def _units(sets: Sequence[Mapping[str, Any]]) -> tuple[float, float]:
    """Units of length and force, m and N."""
    found = [one for one in sets if one["type"] == 164]
    if not found:
        raise SceneError("does not tell its units (dataset 164)")
    one = found[0]
    return units_of(one["units_code"], one["length"], one["force"])


def _points(sets: Sequence[Mapping[str, Any]]) -> dict[int, tuple[float, float, float]]:
    """Number of a point -> x, y, z, m."""
    nodes = [one for one in sets if one["type"] in (15, 2411)]
    if not nodes:
        raise SceneError("gives no places of its points (dataset 15 or 2411)")
    length, _ = _units(sets)
    systems = {int(s) for one in nodes for s in (*one["def_cs"], *one["disp_cs"])}
    if len(systems) > 1:
        raise SceneError("has points in more than one coordinate system; write x, y, z of all")
    return {
        int(k): (length * x, length * y, length * z)
        for one in nodes
        for k, x, y, z in zip(one["node_nums"], one["x"], one["y"], one["z"])
    }


def _hertz(one: Mapping[str, Any]) -> float:
    """Frequency of a mode; of a complex one from its eigenvalue."""
    return float(one["freq"] if one["analysis_type"] == NORMAL else abs(one["eig"]) / (2 * np.pi))
