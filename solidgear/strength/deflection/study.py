"""Deflection of a train under torque, or of a shaft under its load, from a path, tables or an
object.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Unpack

from solidgear.core import LADDER, SolidgearError, Source, explained
from solidgear.strength.acting import Acting, Under
from solidgear.strength.deflection import at_rest
from solidgear.trains.assembly.shaft import checked_model
from solidgear.trains.file.train import Train


def deflect(
    source: Source | Train,
    models: str | Sequence[str] | None = None,
    *,
    tol: float | str | None = None,
    settings: Mapping[str, Any] | None = None,
    progress: Callable[[str], None] = lambda text: None,
    **under: Unpack[Under],
) -> at_rest.Deflections:
    """Deflection of shafts at rest: displacements, misalignment of gears, bearing loads.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file (TOML), the tables of one, or an object.
    models : str or sequence of str, optional
        Models of all shafts that are compared, the finest last; by default rigid, euler and
        timoshenko, of shafts with cuts of their plain parts, and the cheapest solid that models all of
        each shaft.
    tol : float, optional
        Relative error that meshes of solid shafts may leave in the motions of gears; by default a tenth
        of the tolerance of the file for harmonic ones, all of it for 3D ones.
    settings : mapping, optional
        Builder options of the last of the models that are named, such as ``{"refinement": 0.5}``.
    progress : callable
        Called with a sentence at every step.
    **under
        What acts on a train: `torque`, such as ``"115 N*m"`` (a number in N m), with the shaft `of`
        it, the engine's by default, and the direction of `weight` in the first shaft's scene, such
        as ``"-z"``; or an operating `point` by name or number. By default all points of the train,
        the first of which is compared.

        On a shaft: `load` at the port in place of the loads of its scene, such as
        ``"x=2 kN, z=-500 N"`` or a dict; `case` of its loads, by name or number, by default all, the
        first of which is compared; `drive`, torques that enter at a bearing, mass or point and leave
        at the port, or where its file says, such as ``{"B": "115 N*m"}`` (numbers in N m).

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
    assembly, at = Acting(**under).read(source, tol)
    chosen = any(under.get(key) is not None for key in ("torque", "point", "case"))
    every_point = not chosen and len(assembly.train.operation) > 1
    names = (models,) if isinstance(models, str) else tuple(models or ())
    if settings:
        if not names:
            raise SolidgearError("settings are of a model that is named: give `models` as well")
        kind, base = checked_model(names[-1])
        assembly.settings = {base or kind: LADDER[base or kind].checked(dict(settings))}
    with explained(source):
        return at_rest.deflect(assembly, at, names, progress, every_point)
