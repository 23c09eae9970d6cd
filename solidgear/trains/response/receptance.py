"""Receptance of a train: the steady motion of one port in one direction for a unit force on another.

Directions are in the axes of the shaft that a port is on.  With the losses of the file the matrices
stay symmetric, so that ends may change places (reciprocity).  Sums over modes place the
frequencies; the values are solved one frequency at a time, since the motion of a far port is the
small difference of large terms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core import DOF_NAMES, SolidgearError, show
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.components import FORCE_UNITS, MOTION_UNITS
from solidgear.trains.assembly.shaft import mix_label
from solidgear.trains.response.drive import Drive

#: a motion this much smaller than reciprocal motions of both ends allow is rounding
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
        return mix_label(self.models)


def receptance(
    assembly: Assembly,
    *models: str,
    from_: End,
    to: End,
    highest_hz: float | None = None,
    damping: str = "hysteretic",
    matched_hz: float = 0.0,
    frequency_hz: np.ndarray | None = None,
) -> TrainReceptance:
    """Compute the receptance between two ports of a train with the shafts by models, from port and
    direction of the force to those of the motion, such as ``("gear.gear", "z")``, on an adaptive
    grid unless frequencies are given; refused for directions in which a port does not move, and
    for ends that do not move each other.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
    >>> ends = {"from_": ("gear.gear", "z"), "to": ("pinion.pinion", "x")}
    >>> found = receptance(assembly, "timoshenko", "timoshenko", **ends, highest_hz=1000.0)
    >>> found.unit, [mode for _, _, mode in found.peaks][:2]
    ('m/N', ['load torsion 1', 'gear torsion 1'])
    """
    highest = highest_hz or assembly.highest_hz or assembly.train.ask.max_frequency
    assembly.follow(*models, highest_hz=highest)
    force = np.eye(6)[_component(from_)]
    load = {from_[0]: force}
    drive = Drive(assembly, *models, damping=damping, matched_hz=matched_hz, forces=load)
    row = drive.system.motion(to[0])[_component(to)]
    for end, row_of_end in ((from_, drive.load), (to, row)):
        if not row_of_end.any():
            moves = [d for d, r in zip(DOF_NAMES, drive.system.motion(end[0])) if r.any()]
            raise SolidgearError(f"{end[0]} does not move in {end[1]}, only in {' '.join(moves)}")

    def response(hz):
        return drive.motion(hz, row[None])

    _refuse_unrelated(drive, row)
    is_given = frequency_hz is not None
    hz = np.asarray(frequency_hz, float) if is_given else drive.grid(highest, motions_of=response)
    value = drive.steady.solved(hz, drive.load, row[None])[:, 0]
    top = drive.tops(hz, np.abs(value), row)
    force_unit = FORCE_UNITS[_component(from_)]
    if " " in force_unit:
        force_unit = f"({force_unit})"
    return TrainReceptance(
        models=assembly.models_by_shaft(models),
        damping=damping,
        from_=from_,
        to=to,
        unit=f"{MOTION_UNITS[_component(to)]}/{force_unit}",
        frequency_hz=hz,
        value=value,
        peaks=tuple(top),
    )


def _component(end: End) -> int:
    if end[1] not in DOF_NAMES:
        raise SolidgearError(
            f"{show(end[1], 20)} is no direction of {end[0]}; use one of {' '.join(DOF_NAMES)}"
        )
    return DOF_NAMES.index(end[1])


def _refuse_unrelated(drive: Drive, row: np.ndarray) -> None:
    """Refuse two ends that move each other by rounding alone, judged mode by mode."""
    shapes = np.hstack([drive.system.free, drive.system.elastic[1]])
    moved, loaded = np.abs(row @ shapes), np.abs(drive.load @ shapes)
    if not (moved * loaded).max() > NOTHING * moved.max() * loaded.max():
        raise SolidgearError(
            "a force there does not move the other end; choose other ports or directions"
        )
