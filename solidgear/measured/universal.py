"""Universal files (.unv, .uff) of test equipment: mode shapes and responses on measuring points, SI.

Units stand in dataset 164, else in the labels of axes: ``m/s^2``, ``g``, ``lbf``, ``kHz``. A label
is free text that equipment writes; an unknown one is ignored.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import SceneError, SolidgearError, explained
from solidgear.core.meshing.placing import Placing
from solidgear.parts.universal_units import units_of

#: endings of their names
ENDINGS = (".unv", ".uff")
#: dataset 58's kinds of data that carry a length (displacement, velocity, acceleration) or a force
LENGTHS, FORCES = (8, 11, 12), (9, 13)
#: and one of which it says nothing
UNKNOWN = 0
#: its function that is a frequency response
RESPONSE = 4
#: dataset 55's analyses: normal modes; complex ones
NORMAL, COMPLEX = 2, (3, 7)
#: m of a unit of length, N of one of force, Hz of one of frequency, as labels write them
LENGTH_LABELS = {
    "m": 1.0,
    "mm": 1e-3,
    "cm": 1e-2,
    "um": 1e-6,
    "µm": 1e-6,
    "μm": 1e-6,
    "in": 0.0254,
    "inch": 0.0254,
    "mil": 2.54e-5,
    "ft": 0.3048,
}
FORCE_LABELS = {"n": 1.0, "mn": 1e-3, "kn": 1e3, "lbf": 4.4482216152605, "lb": 4.4482216152605}
FREQUENCY_LABELS = {"hz": 1.0, "khz": 1e3, "rad/s": 1 / (2 * math.pi), "rpm": 1 / 60, "cpm": 1 / 60}
#: m/s^2 of an acceleration in units of free fall
GRAVITY = dict.fromkeys(("g", "gn", "g0"), 9.80665)
#: a length, and how often it is over a second
_MOTION = re.compile(
    r"(?P<length>[^\W\d]+)(?:/s(?:ec)?(?P<square>\^2|\*\*2|²|2|/s(?:ec)?)?)?", re.I
)
_MARK = re.compile(rb"^ {4}-1[ \t]*\r?$", re.MULTILINE)


@dataclass(frozen=True, eq=False)
class Shapes:
    """Measured shapes on points."""

    numbers: np.ndarray  #: (p,) of the points in the file
    points: np.ndarray  #: (p, 3) x, y, z, m
    #: (n, p, 3) a shape for every resonance, real or complex, to a factor; components that are
    #: zero in all shapes were not measured
    values: np.ndarray
    #: m that a unit of the file was taken for; None where it is unknown, and places are in units of
    #: the file
    length: float | None = 1.0

    def placed(self, placing: Placing) -> Shapes:
        """Return the same shapes in the frame of a scene."""
        points = placing.to_scene(self.points.T / (self.length or 1.0)).T
        return replace(
            self, points=points, values=self.values @ np.array(placing.turn).T, length=1.0
        )


@dataclass(frozen=True, eq=False)
class Responses:
    """Measured frequency responses over one axis of frequencies.

    Examples
    --------
    A resonance at 1 kHz in the acceleration of a point that is driven itself:

    >>> import numpy as np, solidgear as sg
    >>> hertz = np.arange(800.0, 1200.0, 0.5)
    >>> noise = 1e-4 * np.random.default_rng(0).standard_normal((2, len(hertz)))
    >>> peak = -(hertz**2) / (1e6 - hertz**2 + 2e-3j * 1e3 * hertz) + noise[0] + 1j * noise[1]
    >>> driven = ((1, 3),)
    >>> tap = sg.Responses(hertz, peak[None], driven, driven, {1: (0.0, 0.1, 0.0)}, derivatives=2)
    >>> [round(mode.frequency) for mode in sg.load_measured(tap).modes]
    [1000]
    """

    frequencies: np.ndarray  #: (k,) Hz
    values: np.ndarray  #: (n, k) SI, or to a factor where their unit is unknown
    #: points, references: number and direction of the point of each, and of where it was driven: 1,
    #: 2, 3 for x, y, z, negative backwards; empty where unknown
    points: tuple[tuple[int, int], ...] = ()
    references: tuple[tuple[int, int], ...] = ()
    #: of points by their numbers, m; empty where unknown
    places: Mapping[int, tuple[float, float, float]] = field(default_factory=dict)
    #: times that the displacement is differentiated in the numerator: 2 for an acceleration; None
    #: where unknown
    derivatives: int | None = None
    length: float | None = 1.0  #: m that a unit of the places was taken for, as of shapes
    scaled: bool = True  #: false where the unit of the values is unknown
    #: sentences on parts of the file that may be meant otherwise than they were read
    remarks: tuple[str, ...] = ()

    def placed(self, placing: Placing) -> Responses:
        """Return the same responses in the frame of a scene."""
        numbers = list(self.places)
        points = np.reshape([self.places[number] for number in numbers], (-1, 3))
        moved = placing.to_scene(points.T / (self.length or 1.0)).T.tolist()
        turn = np.array(placing.turn)

        def turned(end: tuple[int, int]) -> tuple[int, int]:
            number, way = end
            if not 1 <= abs(way) <= 3:
                return end
            along = np.sign(way) * turn[:, abs(way) - 1]
            axis = int(np.abs(along).argmax())
            return number, int(np.sign(along[axis])) * (axis + 1)

        return replace(
            self,
            points=tuple(map(turned, self.points)),
            references=tuple(map(turned, self.references)),
            places={number: tuple(place) for number, place in zip(numbers, moved)},
            length=1.0,
        )


def read_universal(
    path: str | os.PathLike, response_unit: tuple[float, int] | None = None
) -> tuple[list[float], Shapes | None] | Responses:
    """Return frequencies in Hz, ascending, and shapes of the modes of a universal file (dataset
    55), or the frequency responses (dataset 58) where it has no modes.

    Where it gives no places of the points, there are no shapes. `response_unit`, SI units in one of
    the responses and derivatives of the displacement, overrules the file. Refused is a file cut
    short, with neither, with places of some points alone, and with responses over more than one
    axis.
    """
    try:
        from pyuff import UFF
    except ImportError:
        raise SolidgearError(
            "universal files need pyuff: pip install 'solidgear[testdata]'"
        ) from None
    with explained(path, {}):
        sets = _datasets(Path(path), UFF)
        kinds = NORMAL, *COMPLEX
        modes = [d for d in sets if d["type"] == 55 and d["analysis_type"] in kinds]
        if modes:
            return _shapes(sets, modes)
        responses = [d for d in sets if d["type"] == 58 and d["func_type"] == RESPONSE]
        if responses:
            return _responses(sets, responses, response_unit)
        raise SceneError(
            "holds no mode shapes (dataset 55 of normal or complex modes) and no frequency responses "
            "(dataset 58, function 4)"
        )


def _shapes(
    sets: Sequence[Mapping[str, Any]], modes: Sequence[Mapping[str, Any]]
) -> tuple[list[float], Shapes | None]:
    places = _points(sets)
    numbers = modes[0]["node_nums"]
    for mode in modes:
        count = len(mode["node_nums"])
        if any(len(mode[r]) != count for r in ("r1", "r2", "r3")):
            raise SceneError(f"is cut short in mode {mode['mode_n']}")
        if not np.array_equal(mode["node_nums"], numbers):
            raise SceneError(f"has other points in mode {mode['mode_n']} than in the first")
    missing = [int(k) for k in numbers if int(k) not in places]
    if missing and places:
        raise SceneError(f"gives no position of point {missing[0]} (dataset 15 or 2411)")
    hertz = [
        float(m["freq"] if m["analysis_type"] == NORMAL else abs(m["eig"]) / (2 * np.pi))
        for m in modes
    ]
    order = np.argsort(hertz, kind="stable")
    values = np.array(
        [np.column_stack([modes[k]["r1"], modes[k]["r2"], modes[k]["r3"]]) for k in order]
    )
    if not np.all(np.isfinite(values)) or not np.all(np.any(values, axis=(1, 2))):
        raise SceneError("has a mode shape that is zero or not a number")
    hertz = [hertz[k] for k in order]
    if not places:
        return hertz, None
    points = np.array([places[int(k)] for k in numbers])
    return hertz, Shapes(np.asarray(numbers, int), points, values, _length(sets))


def _responses(
    sets: Sequence[Mapping[str, Any]],
    datasets: Sequence[Mapping[str, Any]],
    stated: tuple[float, int] | None,
) -> Responses:
    axis = datasets[0]["x"]
    kinds = datasets[0]["ordinate_spec_data_type"], datasets[0]["orddenom_spec_data_type"]
    for k, dataset in enumerate(datasets, start=1):
        if len(dataset["data"]) != dataset["num_pts"]:
            raise SceneError(
                f"is cut short in response {k}: {len(dataset['data'])} of {dataset['num_pts']} lines"
            )
        if not np.array_equal(dataset["x"], axis):
            raise SceneError(f"has other frequencies in response {k} than in the first")
        if (dataset["ordinate_spec_data_type"], dataset["orddenom_spec_data_type"]) != kinds:
            raise SceneError(f"has another kind of data in response {k} than in the first")
    labels = [_labels(dataset) for dataset in datasets]
    hertz = FREQUENCY_LABELS.get(_bare(labels[0][0]), 1.0)
    derivatives = LENGTHS.index(kinds[0]) if kinds[0] in LENGTHS and kinds[1] in FORCES else None
    if kinds == (UNKNOWN, UNKNOWN) and (by_label := _motion(labels[0][1])):
        derivatives = by_label[1]
    scales = [_scale(sets, kinds, words) for words in labels]
    remarks = list(_remarks(labels, scales))
    if stated is not None:
        scales, derivatives, remarks = [stated[0]] * len(datasets), stated[1], []
    scaled = derivatives is not None and None not in scales
    if hertz != 1:
        remarks.append(f"Frequencies are in {labels[0][0]}, as the label of their axis says.")
    return Responses(
        np.asarray(axis) * hertz,
        np.array([np.multiply(d["data"], s or 1.0) for d, s in zip(datasets, scales)], complex),
        tuple((d["rsp_node"], d["rsp_dir"]) for d in datasets),
        tuple((d["ref_node"], d["ref_dir"]) for d in datasets),
        _points(sets),
        derivatives,
        _length(sets),
        scaled,
        tuple(remarks),
    )


def _labels(dataset: Mapping[str, Any]) -> tuple[str, str, str]:
    """Return units on the axes of a response: of the frequency, the motion and the force."""

    def word(axis: str) -> str:
        text = str(dataset.get(f"{axis}_axis_units_lab") or "").strip()
        return "" if text.upper() == "NONE" else text

    return word("abscissa"), word("ordinate"), word("orddenom")


def _scale(
    sets: Sequence[Mapping[str, Any]], kinds: tuple[int, int], labels: tuple[str, str, str]
) -> float | None:
    """Return SI units in one of a response: by dataset 164, or without it by the labels of the
    axes.
    """
    units = _units(sets)
    if units is None:
        by_labels = _motion_over_force(*labels[1:])
        return by_labels and by_labels[0]
    length, newton = units
    factors = dict.fromkeys(LENGTHS, length) | dict.fromkeys(FORCES, newton)
    return factors.get(kinds[0], 1.0) / factors.get(kinds[1], 1.0)


def _remarks(
    labels: Sequence[tuple[str, str, str]], scales: Sequence[float | None]
) -> Iterator[str]:
    """Yield labels of axes that contradict dataset 164."""
    for words, scale in zip(labels, scales):
        by_labels = _motion_over_force(*words[1:])
        if by_labels is None or scale is None or math.isclose(scale, by_labels[0], rel_tol=1e-3):
            continue
        yield (
            f"Responses are scaled by dataset 164, {scale:.4g} in SI, but the labels of their "
            f"axes say {words[1]} over {words[2]}, {by_labels[0]:.4g}: one of them is wrong."
        )
        return


def _datasets(path: Path, reader: Callable) -> list[dict[str, Any]]:
    """Return all datasets of a file that is whole."""
    try:
        text = path.read_bytes()
    except OSError as error:
        raise SceneError(f"cannot be read ({error})") from None
    if not _MARK.search(text):
        raise SceneError("is not a universal file: no line holds the mark -1 of a dataset")
    # binary data may run into the mark that ends them
    if not text.rstrip().endswith(b"    -1"):
        raise SceneError("is cut short: its last dataset has no end")
    try:
        datasets = reader(os.fspath(path)).read_sets()
    except Exception as error:  # pyuff raises nothing narrower
        raise SceneError(f"cannot be read ({error})") from None
    return datasets if isinstance(datasets, list) else [datasets]


def _units(sets: Sequence[Mapping[str, Any]]) -> tuple[float, float] | None:
    """Return units of length and force, m and N; None where dataset 164 is not there."""
    for d in sets:
        if d["type"] == 164:
            return units_of(d["units_code"], d["length"], d["force"])
    return None


def _length(sets: Sequence[Mapping[str, Any]]) -> float | None:
    """Return the unit of length, m."""
    units = _units(sets)
    return None if units is None else units[0]


def _points(sets: Sequence[Mapping[str, Any]]) -> dict[int, tuple[float, float, float]]:
    """Return number of a point -> x, y, z, m, or in units of the file if they are unknown; empty if
    it gives no places.
    """
    nodes = [dataset for dataset in sets if dataset["type"] in (15, 2411)]
    length = _length(sets) or 1.0
    systems = {int(s) for dataset in nodes for s in (*dataset["def_cs"], *dataset["disp_cs"])}
    if len(systems) > 1:
        raise SceneError("has points in more than one coordinate system; write x, y, z of all")
    return {
        int(k): (length * x, length * y, length * z)
        for dataset in nodes
        for k, x, y, z in zip(dataset["node_nums"], dataset["x"], dataset["y"], dataset["z"])
    }


def response_unit(label: str) -> tuple[float, int] | None:
    """Return SI units in the unit of a motion over a force, such as ``mm/s^2/N``, and how often the
    displacement is differentiated in it; None of one that is unknown.
    """
    motion, _, force = label.rpartition("/")
    return _motion_over_force(motion.strip().strip("()"), force)


def _motion_over_force(motion: str, force: str) -> tuple[float, int] | None:
    above, below = _motion(motion), FORCE_LABELS.get(_bare(force))
    return None if above is None or below is None else (above[0] / below, above[1])


def _motion(label: str) -> tuple[float, int] | None:
    """Return SI units in the unit of a motion, and how often the displacement is differentiated."""
    word = _bare(label)
    if word in GRAVITY:
        return GRAVITY[word], 2
    parts = _MOTION.fullmatch(word)
    if parts is None or parts["length"] not in LENGTH_LABELS:
        return None
    order = 0 if "/" not in word else 2 if parts["square"] else 1
    return LENGTH_LABELS[parts["length"]], order


def _bare(label: str) -> str:
    return re.sub(r"\s+", "", label).strip("[]()").lower()
