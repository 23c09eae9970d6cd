"""Rows of a sweep as curves over the one number that varies."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from solidgear.core import SolidgearError, listed
from solidgear.variants.sweep.entries import Entry, in_si
from solidgear.variants.sweep.file_variants import POINT, FileVariants
from solidgear.variants.sweep.life_numbers import HOURS, STATIC
from solidgear.variants.sweep.shaft_numbers import BAR, FATIGUE, MOVED, YIELD
from solidgear.variants.sweep.tooth_numbers import CHARTED, TOOTH_UNITS, of_mesh

#: rows that curves are made of
MOST_CURVED = 5000
#: units of misalignment that are angles; the others are lengths
UNITS = dict.fromkeys(("shaft angle", "in plane", "across"), "rad moved")
#: numbers of a shaft in a table, and their units
STATICS = {
    "K_zz": "N/m",
    "K_thx": "N m/rad",
    HOURS: "h",
    STATIC: "",
    FATIGUE: "",
    YIELD: "",
}
#: beginning of the columns of mesh forces
FORCE = "mesh_force"
#: and of the numbers of a misalignment
MISALIGNMENT = "misalignment"


def force_of(mesh: str) -> str:
    """Return the column of the force of a mesh at rest."""
    return of_mesh(FORCE, mesh)


def misaligned(name: str) -> str:
    """Return the column of a number of the misalignment."""
    return f"{MISALIGNMENT}_{name.replace(' ', '_')}"


@dataclass(frozen=True, eq=False)
class Curve:
    """One number of every row."""

    name: str
    unit: str  #: SI; ``m moved`` and ``rad moved`` are motions
    values: np.ndarray  #: (n,) not a number where a row has none
    #: words on each value, such as the name of the mode; empty for none
    words: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves over one number."""

    #: over, unit: path of the entry that varies, and unit of `x`; an empty one is SI
    over: str
    unit: str
    log: bool
    x: np.ndarray  #: (n,) ascending
    labels: tuple[str, ...]  #: names of the rows where they have some, such as operating points
    frequencies: list[Curve]
    statics: list[Curve]  #: numbers of a shaft at rest, for a table
    mesh_force: list[Curve]  #: one for each mesh, or none
    misalignment: list[Curve]
    #: radial, axial: loads of bearings
    radial: list[Curve]
    axial: list[Curve]
    #: peak_hz, peak_force: one each, or none; of the largest peak of the force of the mesh that
    #: drives
    peak_hz: list[Curve]
    peak_force: list[Curve]
    #: numbers of teeth in contact by their names, of every mesh, whose name is empty where it is the
    #: only one
    teeth: dict[str, list[Curve]]

    @property
    def empty(self) -> bool:
        """True where no variant could be solved."""
        at_rest = self.misalignment, self.radial, self.axial, self.teeth
        return not any((self.frequencies, self.statics, *at_rest, self.peak_force))

    @property
    def on_terminal(self) -> bool:
        """True where the table of the rows has numbers beside the one that varies."""
        lines = self.frequencies, self.statics, self.mesh_force, self.peak_hz, self.teeth
        return any(lines)


def chartable(variants: FileVariants) -> Entry:
    """Return the one entry that curves go over; refuse several, words and too many values."""
    several = [entry for entry in variants.entries if len(entry.values) > 1]
    if len(several) != 1:
        labels = listed(entry.label for entry in several) or "none"
        raise SolidgearError(
            f"a chart needs one number that varies, but here vary {labels}; leave `chart` out, or "
            "give several values to one of them only"
        )
    entry = several[0]
    if entry.label != POINT and not entry.numeric:
        raise SolidgearError(f"a chart has curves over a number, and {entry.label} varies by words")
    if len(variants) > MOST_CURVED:
        raise SolidgearError(
            f"{len(variants)} variants are more than the {MOST_CURVED} that a chart shows"
        )
    return entry


def curves_of(
    read: Callable[[], Mapping[str, list[Any]]],
    variants: FileVariants,
    misalignments: Sequence[str] = (),
    meshes: Sequence[str] = (),
) -> Curves | None:
    """Return the curves of the columns of all rows, over the torque where operating points vary; None
    of a sweep that has none, whose columns are not read. `misalignments` names the numbers of the
    misalignment of a train, `meshes` those in contact.
    """
    try:
        entry = chartable(variants)
    except SolidgearError:
        return None
    columns = read()
    of_points = entry.label == POINT
    over = "torque" if of_points else entry.label
    x = _numbers(columns[over])
    order = np.argsort(x, kind="stable")
    order = order[np.isfinite(x[order])]
    unit = "N m" if of_points else entry.shown_in
    size = None if of_points or not unit else in_si(f"1 {unit}")

    def curve(name: str, column: str, si: str, words: str | None = None) -> list[Curve]:
        """Return the curve of a column, with the words of another; none where no row has a value."""
        values = _numbers(columns.get(column, []))
        if not np.isfinite(values).any():
            return []
        texts = [] if words is None else [columns[words][k] for k in order]
        return [Curve(name, si, values[order], tuple("" if t is None else str(t) for t in texts))]

    def loads(ending: str) -> list[Curve]:
        """Return the curves of the loads of all bearings in one direction."""
        return [
            line
            for column in columns
            if column.endswith(ending)
            for line in curve(column.removesuffix(ending), column, "N")
        ]

    def teeth(number: str) -> list[Curve]:
        """Return the curves of a number of the teeth of all meshes."""
        return [
            line
            for mesh in meshes
            for line in curve(
                mesh.removeprefix("mesh").strip(), of_mesh(number, mesh), TOOTH_UNITS[number]
            )
        ]

    modes = [column for column in columns if re.fullmatch(r"f\d+_hz", column)]
    return Curves(
        over=over,
        unit=unit,
        log=entry.spacing == "log",
        x=x[order] / (size or 1.0),
        labels=tuple(str(columns[POINT][k]) for k in order) if of_points else (),
        frequencies=[
            line
            for column in modes
            for line in curve(column[:-3], column, "Hz", f"mode{column[1:-3]}")
        ],
        statics=[
            line
            for column in columns
            if (si := at_rest_unit(column)) is not None
            for line in curve(column, column, si)
        ],
        mesh_force=[
            line
            for column in columns
            if column.startswith(FORCE)
            for line in curve(
                f"mesh force{column.removeprefix(FORCE).replace('_', ' ')}", column, "N"
            )
        ],
        misalignment=[
            line
            for name in misalignments
            for line in curve(name, misaligned(name), misalignment_unit(name))
        ],
        radial=loads(".radial"),
        axial=loads(".axial"),
        peak_hz=curve("largest peak", "peak1_hz", "Hz", "peak1_mode"),
        peak_force=curve("largest peak", "peak1_force", "N", "peak1_mode"),
        teeth={number.replace("_", " "): lines for number in CHARTED if (lines := teeth(number))},
    )


def at_rest_unit(column: str) -> str | None:
    """Return the unit of a number of a shaft at rest that has a place in a table; None of any other."""
    if column.endswith(BAR):
        return None
    moved = (unit for word, unit in MOVED.items() if column.startswith(f"{word}_"))
    return STATICS.get(column, next(moved, None))


def misalignment_unit(name: str) -> str:
    """Return the unit of a number of the misalignment, whose name a mesh may follow."""
    return next((unit for kind, unit in UNITS.items() if name.startswith(kind)), "m moved")


def _numbers(values: Sequence[Any]) -> np.ndarray:
    return np.array([np.nan if v is None else float(v) for v in values], float)
