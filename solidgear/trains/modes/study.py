"""Natural frequencies of a train from a path, tables or an object."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any, ClassVar, Unpack

import numpy as np

from solidgear.core import DOF_NAMES, Sheeted, Source
from solidgear.core.named import NamedModes
from solidgear.show.table import Table
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.train import Train
from solidgear.trains.modes.modes import TrainMode, TrainModes, train_modes
from solidgear.trains.options import Models, Reducing, Settings, assembled


@dataclass(frozen=True, eq=False, repr=False)
class SolvedModes(NamedModes[TrainMode], Sheeted):
    """Modes of a train, with the train that they are of."""

    sheeted: ClassVar[str] = "trains.modes.sheet:modes_sheet"

    assembly: Assembly
    solved: TrainModes

    @property
    def modes(self) -> tuple[TrainMode, ...]:
        """Modes by frequency, rigid motions first."""
        return self.solved.modes

    @property
    def frequency_hz(self) -> np.ndarray:
        """(n,) natural frequencies, Hz."""
        return np.array([mode.frequency_hz for mode in self.modes])

    @property
    def listed_modes(self) -> tuple[TrainMode, ...]:
        """Modes by frequency."""
        return self.modes

    def framed_tables(self) -> dict[str, Any]:
        """Return all tables of numbers by name, the main one first, and the shapes of the modes."""
        return {**super().framed_tables(), "shapes": shapes(self)}

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return dict(self.sheet().data)


def shapes(modes: SolvedModes) -> Table:
    """Return the motions of ports in all modes; a mode that has the name of another is counted."""
    from solidgear.show.shown import shapes_table  # start-up: for frames alone

    solved = modes.solved
    system = modes.assembly.system(*solved.models.values())
    ends = [f"{part}.{port}" for part, body in system.parts.items() for port in body.ports]
    moved = {end: system.motion(end) @ solved.shapes for end in ends}
    counts = Counter[str]()
    rows: list[tuple[Any, ...]] = []
    for k, mode in enumerate(solved.modes):
        counts[mode.name] += 1
        name = mode.name if counts[mode.name] == 1 else f"{mode.name} ({counts[mode.name]})"
        for port, six in moved.items():
            for dof, motion in zip(DOF_NAMES, six[:, k]):
                rows.append((name, mode.frequency_hz, port, dof, float(motion)))
    return shapes_table("ports", "port", rows)


def system_modes(
    train: Source | Train,
    models: Models = None,
    *,
    settings: Settings = None,
    **reduced: Unpack[Reducing],
) -> SolvedModes:
    """Natural frequencies of a train, each with its name and a proven bound.

    Parameters
    ----------
    train : path, dict or Train
        A train: its file (TOML), the tables of one, or an object.
    models : str or mapping of str to str, optional
        Model of all shafts, such as ``"timoshenko"``, or models by shaft; harmonic solids by default.
    settings : mapping, optional
        Builder options by shaft, such as ``{"pinion": {"order": 3}}``.
    **reduced
        Of every study of a train: `max_frequency` in Hz, by default that of the train;
        `reduction`, ``"rubin"`` or ``"craig_bampton"``; `kept`, modes of each shaft in its
        reduction; `local_harmonics` of harmonic solids that teeth drive where they touch, such as
        ``(2, 3)``; `point`, an operating point by name or number; `tol`, the relative error that
        meshes of harmonic shafts may leave.

    Returns
    -------
    SolvedModes
        ``modes`` with name, frequency, speed and bound; ``write(folder)`` makes a page.

    Raises
    ------
    SolidgearError
        For an unknown shaft or model, and frequencies beyond those that the reduction resolves.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.system_modes("geometry/axle_overhung.toml", "timoshenko", max_frequency=1000.0)
    >>> [mode.name for mode in found][:2], round(found["load torsion 1"].frequency_hz)
    (['train rotation', 'load torsion 1'], 16)
    """
    assembly, mix = assembled(train, models, settings, reduced)
    limit, count = reduced.get("max_frequency"), assembly.train.ask.modes
    return SolvedModes(assembly, train_modes(assembly, *mix, max_frequency=limit, at_most=count))
