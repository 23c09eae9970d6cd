"""Deflection of a train under torque, or of a shaft under its load, from a path, tables or an
object.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from solidgear.core import Source, explained
from solidgear.strength.acting import Acting, Given
from solidgear.strength.deflection import at_rest
from solidgear.trains.file.train import Train


def deflect(
    source: Source | Train,
    models: str | Sequence[str] | None = None,
    *,
    torque: Given = None,
    of: str | None = None,
    point: str | int | None = None,
    weight: str | None = None,
    load: str | Mapping[str, Any] | None = None,
    case: str | int | None = None,
    drive: Mapping[str, str | float] | list[str] | None = None,
    tol: float | str | None = None,
    progress: Callable[[str], None] = lambda text: None,
) -> at_rest.Deflections:
    """Deflection of shafts at rest: displacements, misalignment of gears, bearing loads.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file (TOML), the tables of one, or an object.
    models : str or sequence of str, optional
        Models of all shafts that are compared, the finest last; by default rigid, euler,
        timoshenko and harmonic, of shafts with cuts of their plain parts.
    torque : str or float, optional
        Torque on a train, such as ``"115 N*m"`` (a number in N m); by default the operating points
        of the train, the first of which is compared.
    of : str, optional
        Shaft of the torque; the engine's by default.
    point : str, optional
        Operating point of a train, by name or number.
    weight : str, optional
        With a torque: direction of weight in the first shaft's scene, such as ``"-z"``.
    load : str or dict, optional
        Load on a shaft in place of those of its scene: ``"x=2 kN, z=-500 N"`` at the port.
    case : str, optional
        Case of the loads of a shaft, by name or number; by default all, the first of which is
        compared.
    drive : mapping of str to str or float, optional
        Torques that enter a shaft at a bearing, mass or point and leave it at the port, or where
        its file says, such as ``{"B": "115 N*m"}``; numbers in N m.
    tol : float, optional
        Relative error that meshes of harmonic shafts may leave in the motions of gears; a tenth of
        the tolerance of the train by default.
    progress : callable
        Called with a sentence at every step.

    Returns
    -------
    Deflections
        By ``solutions``, one for each model; the finest is ``judge``. ``write(folder)`` makes a
        page, deflection lines and their chart.

    Raises
    ------
    SolidgearError
        For a train without a torque, options that do not apply, and models without bearings.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.deflect("geometry/axle_straddle.toml", "timoshenko", torque="200 N*m")
    >>> [m.name for m in found.judge.misalignment], len(found.judge.shafts[0].bearings)
    (['E', 'P', 'G', 'shaft angle'], 3)
    """
    acting = Acting(torque, of, point, weight, load, case, drive)
    assembly, at = acting.read(source, tol)
    chosen = any(given is not None for given in (torque, point, case))
    every_point = not chosen and len(assembly.train.operation) > 1
    names = (models,) if isinstance(models, str) else models or at_rest.MODELS
    with explained(source):
        if models:
            return at_rest.deflect(assembly, at, names, progress, every_point)
        return at_rest.deflect_plain(assembly, at, progress, every_point)
