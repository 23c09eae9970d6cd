"""Receptance of a train: the steady motion of one port in one direction for a unit force on another.

Directions are in the axes of the shaft that a port is on.  With the losses of the file the matrices
stay symmetric, so that ends may change places (reciprocity).  Sums over modes place the
frequencies; the values are solved one frequency at a time, since what reaches a far port is the
small difference of large terms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.errors import SolidgearError, show
from solidgear.frames import DOF_NAMES
from solidgear.studies.train.components import FORCE_UNITS, MOTION_UNITS
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.respond import Drive
from solidgear.studies.train.shaft import told_mix

#: a motion this much smaller than what reciprocal motions of both ends allow is rounding
NOTHING = 1e-12

#: port and direction, such as ("gear.gear", "z")
End = tuple[str, str]


@dataclass(frozen=True, eq=False)
class TrainReceptance:
    """Motion of one end for a unit force on another."""

    models: dict[str, str]  #: by shaft
    damping: str
    #: from_, to: port and direction
    from_: End
    to: End
    unit: str  #: of the values
    frequency_hz: np.ndarray  #: (f,)
    value: np.ndarray  #: (f,)
    peaks: tuple[tuple[float, float, str], ...]  #: hz, amplitude, and the mode that makes it

    @property
    def label(self) -> str:
        """Name in a legend: the models of the shafts."""
        return told_mix(self.models)


def receptance(
    workshop: Workshop,
    *models: str,
    from_: End,
    to: End,
    highest_hz: float | None = None,
    damping: str = "hysteretic",
    matched_hz: float = 0.0,
    frequency_hz: np.ndarray | None = None,
) -> TrainReceptance:
    """Receptance between two ports of a train with its shafts by models.

    Parameters
    ----------
    from_, to : (str, str)
        Port and direction of the force and of the motion, such as ``("gear.gear", "z")``.
    highest_hz : float, optional
        That of the file by default.
    damping, matched_hz
        As :class:`solidgear.studies.train.respond.Drive`.
    frequency_hz : (f,) ndarray, optional
        Instead of an adaptive grid.

    Raises
    ------
    SolidgearError
        For unknown ports and directions, those in which a port does not move, ends that do not
        feel each other, or a frequency beyond what the reduction resolves.

    Examples
    --------
    >>> import solidgear as sg
    >>> shop = Workshop(sg.load_train("geometry/axle_overhung.toml"))
    >>> ends = {"from_": ("gear.gear", "z"), "to": ("pinion.pinion", "x")}
    >>> found = receptance(shop, "timoshenko", "timoshenko", **ends, highest_hz=1000.0)
    >>> found.unit, [mode for _, _, mode in found.peaks][:2]
    ('m/N', ['load torsion 1', 'gear torsion 1'])
    """
    force = np.eye(6)[_number(from_)]
    load = {from_[0]: force}
    drive = Drive(workshop, *models, damping=damping, matched_hz=matched_hz, forces=load)
    row = drive.system.motion(to[0])[_number(to)]
    for end, own in ((from_, drive.load), (to, row)):
        if not own.any():
            moves = [d for d, r in zip(DOF_NAMES, drive.system.motion(end[0])) if r.any()]
            raise SolidgearError(f"{end[0]} does not move in {end[1]}, only in {' '.join(moves)}")

    def seen(hz):
        return drive.motion(hz, row[None])

    _felt(drive, row)
    highest = highest_hz or workshop.train.ask.max_frequency
    given = frequency_hz is not None
    hz = np.asarray(frequency_hz, float) if given else drive.grid(highest, seen=seen)
    value = drive.steady.solved(hz, drive.load, row[None])[:, 0]
    top = drive.tops(hz, np.abs(value), row)
    unit = f"{MOTION_UNITS[_number(to)]}/{_bracketed(FORCE_UNITS[_number(from_)])}"
    rungs = workshop.mix(models)
    return TrainReceptance(rungs, damping, from_, to, unit, hz, value, tuple(top))


def _number(end: End) -> int:
    if end[1] not in DOF_NAMES:
        raise SolidgearError(
            f"{show(end[1], 20)} is no direction of {end[0]}; use one of {' '.join(DOF_NAMES)}"
        )
    return DOF_NAMES.index(end[1])


def _bracketed(unit: str) -> str:
    return f"({unit})" if " " in unit else unit


def _felt(drive: Drive, row: np.ndarray) -> None:
    """Refuse two ends that move each other by rounding alone, judged mode by mode."""
    shapes = np.hstack([drive.system.free, drive.system.elastic[1]])
    there, here = np.abs(row @ shapes), np.abs(drive.load @ shapes)
    if not (there * here).max() > NOTHING * there.max() * here.max():
        raise SolidgearError(
            "a force there does not move the other end: no mode has a part in both; "
            "choose other ports or directions"
        )
