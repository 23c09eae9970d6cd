"""Stress of shafts at rest from a path, tables or an object."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from solidgear.core import SolidgearError, Source, explained, name_of_source
from solidgear.core.scene.units import quantity
from solidgear.strength.acting import Acting, Given
from solidgear.strength.stress.at_rest import StressAtRest, StressSettings, stress_at_rest
from solidgear.strength.stress.notch import ENOUGH
from solidgear.strength.stress.rating import Conditions
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.file.train import Train


def stress(
    source: Source | Train,
    model: str = JUDGE,
    *,
    torque: Given = None,
    of: str | None = None,
    point: str | None = None,
    weight: str | None = None,
    load: str | Mapping[str, Any] | None = None,
    drive: Mapping[str, str | float] | None = None,
    tol: float = ENOUGH,
    local: float | None = None,
    conditions: Mapping[str, Any] | Conditions | None = None,
    progress: Callable[[str], None] = lambda text: None,
) -> StressAtRest:
    """Stress of shafts at rest: section forces, nominal stress, stress on fillets, DIN 743.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file (TOML), the tables of one, or an object.
    model : str
        Model for bearing reactions.
    torque, of, point, weight, load
        As of :func:`solidgear.deflect`.
    drive : mapping of str to str or float, optional
        Torques that enter a shaft at a bearing, mass or point and leave it at the port, such as
        ``{"B": "115 N*m"}``; numbers in N m.
    tol : float
        Error bar allowed for a form factor, relative.
    local : float, optional
        Error bar allowed for form factors of keyways and cross holes, relative, for which 3D
        solids are solved, some seconds each; without it they have none.
    conditions : mapping or Conditions, optional
        Of the rating by DIN 743: ``roughness``, ``ultimate_at_size``, ``yield_at_size``,
        ``hardening``, ``force_share``, ``torque_share``, ``constant_mean``.
    progress : callable
        Called with a sentence at every step.

    Returns
    -------
    StressAtRest
        ``shafts``, each with its forces, nominal stress and ``notches``. ``write(folder)`` makes a
        page, section forces and their charts.

    Raises
    ------
    SolidgearError
        For a train without a torque, options that do not apply, a tolerance beyond all meshes.

    Examples
    --------
    The overhung pinion under 10 kN across its head:

    >>> import solidgear as sg
    >>> (shaft,) = sg.stress("geometry/pinion_filleted.toml", "timoshenko", load="z=10 kN").shafts
    >>> (notch,) = shaft.found.notches
    >>> notch.name, f'{notch.forces[3]:.1f} N m', f'{notch.found.factors["bending"].value:.1f}'
    ('head fillet', '431.2 N m', '2.2')
    """
    if not isinstance(conditions, Conditions):
        conditions = Conditions(**(conditions or {}))
    settings = StressSettings(tol, conditions, local)
    assembly, at = Acting(torque, of, point, weight, load).read(source)
    torques = {name: quantity(value, "torque") for name, value in (drive or {}).items()}
    if torques and not assembly.train.is_one_shaft:
        raise SolidgearError(
            f"`drive` is for a shaft, and {name_of_source(source)} is a train: torques come by the "
            "springs of engine and load"
        )
    with explained(source):
        return stress_at_rest(assembly, at, model, settings, progress, torques)
