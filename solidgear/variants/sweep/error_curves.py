"""Transmission error over the torque, a curve for each relief or whatever else varies.

The chart goes back to Harris (Proceedings of the Institution of Mechanical Engineers 172, 1958,
p. 87-112): each relief has a torque at which bent teeth come into mesh as smoothly as rigid ones, and
the error there is least.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from solidgear.variants.sweep.entries import Entry, in_si
from solidgear.variants.sweep.file_variants import POINT, FileVariants
from solidgear.variants.sweep.tooth_numbers import ERROR, of_mesh

#: curves of a chart at most
MOST = 8
TORQUE = "torque"


@dataclass(frozen=True, eq=False)
class ErrorCurves:
    """Transmission error of one mesh over the torque, peak to peak."""

    name: str  #: of the error in words, with the mesh
    over: str  #: path of the entry that is the torque
    unit: str  #: of the torque, as the user wrote it
    torque: np.ndarray  #: (n,) ascending, in that unit
    labels: tuple[str, ...]  #: values of what else varies, a word for each curve
    error: np.ndarray  #: (curves, n) m; not a number where a variant was refused

    @property
    def best(self) -> tuple[int, ...]:
        """Number of the curve with the least error at each torque."""
        return tuple(np.argmin(np.nan_to_num(self.error, nan=np.inf), axis=0).tolist())


class Varied(NamedTuple):
    """The entries of a sweep over the torque."""

    torque: int  #: number of the entry that is the torque
    beside: tuple[int, ...]  #: of those that have several values


def over_torque(variants: FileVariants) -> Varied | None:
    """Return which entry is the torque and which vary beside it; None where none does, and of designs
    with other combinations than all.
    """
    several = [k for k, entry in enumerate(variants.entries) if len(entry.values) > 1]
    torques = [k for k in several if _is_torque(variants.entries[k])]
    beside = tuple(k for k in several if k not in torques)
    counts = [len(variants.entries[k].values) for k in several]
    if len(torques) != 1 or not beside or len(variants) != np.prod(counts):
        return None
    if np.prod([len(variants.entries[k].values) for k in beside]) > MOST:
        return None
    return Varied(torques[0], beside)


def error_curves(
    columns: Mapping[str, list[Any]], variants: FileVariants, meshes: Sequence[str]
) -> tuple[ErrorCurves, ...]:
    """Return the transmission error of each mesh over the torque, of rows that have it."""
    varied = over_torque(variants)
    if varied is None or not meshes:
        return ()
    entry = variants.entries[varied.torque]
    of_points = entry.label == POINT
    unit = "N m" if of_points else entry.shown_in
    size = (None if of_points or not unit else in_si(f"1 {unit}")) or 1.0
    places, labels = variants.values[:, varied.beside], []
    groups = dict.fromkeys(map(tuple, places.tolist()))
    rows = []
    for group in groups:
        labels.append(_label(variants, varied.beside, group))
        rows.append(np.flatnonzero((places == group).all(axis=1)))
    torque = _numbers(columns[TORQUE if of_points else entry.label])[rows[0]] / size
    order = np.argsort(torque, kind="stable")
    return tuple(
        ErrorCurves(
            name=column.replace("_", " "),
            over=TORQUE if of_points else entry.label,
            unit=unit or "N m",
            torque=torque[order],
            labels=tuple(labels),
            error=np.array([_numbers(columns[column])[row][order] for row in rows]),
        )
        for column in (of_mesh(ERROR, mesh) for mesh in meshes)
    )


def _is_torque(entry: Entry) -> bool:
    return entry.label == POINT or (entry.keys[0] == "operation" and entry.keys[-1] == TORQUE)


def _label(variants: FileVariants, beside: Sequence[int], values: Sequence[float]) -> str:
    """Return the words on a curve: the last two keys of each entry, and its value."""
    words = []
    for k, value in zip(beside, values):
        entry = variants.entries[k]
        name = " and ".join(".".join(place.label.split(".")[-2:]) for place in entry.places[:1])
        words.append(f"{name} {entry.written(value)}")
    return ", ".join(words)


def _numbers(values: Sequence[Any]) -> np.ndarray:
    return np.array([np.nan if value is None else float(value) for value in values], float)
