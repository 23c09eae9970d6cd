"""Rows of a sweep as curves over the one number that varies."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from solidgear.core.errors import SolidgearError, listed
from solidgear.variants.sweep.amounts import in_si
from solidgear.variants.sweep.entries import Entry
from solidgear.variants.sweep.file_variants import POINT, FileVariants

#: rows that curves are made of
MOST_CURVED = 5000
#: units of misalignment that are angles; the others are lengths
UNITS = dict.fromkeys(("shaft angle", "in plane", "across"), "rad moved")
#: stiffness of a shaft that a table tells, and its units
STATICS = {"K_zz": "N/m", "K_thx": "N m/rad"}
#: what columns of mesh forces begin with
FORCE = "mesh_force"


def force_of(mesh: str) -> str:
    """Column of the force of a mesh at rest."""
    return f"{FORCE}{mesh.removeprefix('mesh').replace(' ', '_')}"


def misaligned(name: str) -> str:
    """Column of a number of the misalignment."""
    return f"misalignment_{name.replace(' ', '_')}"


@dataclass(frozen=True, eq=False)
class Curve:
    """One number of every row."""

    name: str
    unit: str  #: SI; ``m moved`` and ``rad moved`` are motions
    values: np.ndarray  #: (n,) not a number where a row has none
    #: what is said of each value, such as the name of its mode; empty where nothing is
    words: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves over one number."""

    #: over, unit: what varies, and in which unit it is told; an empty one is SI
    over: str
    unit: str
    log: bool
    x: np.ndarray  #: (n,) ascending
    labels: tuple[str, ...]  #: names of the rows where they have some, such as operating points
    frequencies: list[Curve]
    statics: list[Curve]  #: stiffness at the lumped point of a shaft, to be told in a table
    mesh_force: list[Curve]  #: one for each mesh, or none
    misalignment: list[Curve]
    #: radial, axial: loads of bearings
    radial: list[Curve]
    axial: list[Curve]
    #: peak_hz, peak_force: one each, or none; of the largest peak of the force of the mesh that
    #: drives
    peak_hz: list[Curve]
    peak_force: list[Curve]

    @property
    def empty(self) -> bool:
        """True where no variant could be solved."""
        lists = self.frequencies, self.misalignment, self.radial, self.axial, self.peak_force
        return not any(lists)


def chartable(variants: FileVariants) -> Entry:
    """The one entry that curves go over; refused before a sweep begins where there is none.

    Raises
    ------
    SolidgearError
        If there are several, its values are words, or there are too many.
    """
    several = [one for one in variants.entries if len(one.values) > 1]
    if len(several) != 1:
        named = listed(one.label for one in several) or "none"
        raise SolidgearError(
            f"a chart has curves over one number that varies, and here vary: {named}; leave --chart "
            "out, or give one of them several values and the others one"
        )
    one = several[0]
    if one.label != POINT and not one.numeric:
        raise SolidgearError(f"a chart has curves over a number, and {one.label} varies by words")
    if len(variants) > MOST_CURVED:
        raise SolidgearError(
            f"{len(variants)} variants are more than the {MOST_CURVED} that a chart shows"
        )
    return one


def curves_of(
    columns: Mapping[str, list[Any]], variants: FileVariants, measured: Sequence[str] = ()
) -> Curves | None:
    """Curves of a finished sweep; None of one that has none.

    Parameters
    ----------
    columns : mapping of str to list
        Values of all rows by the names of columns; of operating points curves go over their torque.
    measured : sequence of str
        Names of the numbers of the misalignment of a train.
    """
    try:
        one = chartable(variants)
    except SolidgearError:
        return None
    of_points = one.label == POINT
    x = _numbers(columns["torque" if of_points else one.label])
    order = np.argsort(x, kind="stable")
    order = order[np.isfinite(x[order])]
    unit = "N m" if of_points else one.shown_in
    size = None if of_points or not unit else in_si(f"1 {unit}")

    def told(name: str, column: str, si: str, *words: str) -> list[Curve]:
        """The curve of a column; none where no row has a value."""
        values = _numbers(columns.get(column, []))
        if not np.isfinite(values).any():
            return []
        said = zip(*([columns[word][k] for k in order] for word in words))
        texts = tuple(", ".join(str(v) for v in row if v is not None) for row in said)
        return [Curve(name, si, values[order], texts)]

    modes = [column for column in columns if re.fullmatch(r"f\d+_hz", column)]
    radial, axial = (
        [
            curve
            for column in columns
            if column.endswith(ending)
            for curve in told(column.removesuffix(ending), column, "N")
        ]
        for ending in (".radial", ".axial")
    )
    return Curves(
        over="torque" if of_points else one.label,
        unit=unit,
        log=one.spacing == "log",
        x=x[order] / (size or 1.0),
        labels=tuple(str(columns[POINT][k]) for k in order) if of_points else (),
        frequencies=[
            curve
            for column in modes
            for curve in told(column[:-3], column, "Hz", f"mode{column[1:-3]}")
        ],
        statics=[curve for name, si in STATICS.items() for curve in told(name, name, si)],
        mesh_force=[
            curve
            for column in columns
            if column.startswith(FORCE)
            for curve in told(
                f"mesh force{column.removeprefix(FORCE).replace('_', ' ')}", column, "N"
            )
        ],
        misalignment=[
            curve for name in measured for curve in told(name, misaligned(name), _unit_of(name))
        ],
        radial=radial,
        axial=axial,
        peak_hz=told("largest peak", "peak1_hz", "Hz", "peak1_mode"),
        peak_force=told("largest peak", "peak1_force", "N", "peak1_mode"),
    )


def _unit_of(name: str) -> str:
    """Unit of a number of the misalignment, of several meshes with the name of its own."""
    return next((unit for what, unit in UNITS.items() if name.startswith(what)), "m moved")


def _numbers(values: Sequence[Any]) -> np.ndarray:
    return np.array([np.nan if v is None else float(v) for v in values], float)
