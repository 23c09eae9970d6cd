"""Stress of shafts at rest from a path, tables or an object."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Unpack

from solidgear.core import Source, explained, read_tolerance
from solidgear.strength.acting import Acting, Under
from solidgear.strength.stress.at_rest import StressAtRest, StressSettings, stress_at_rest
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.notch import ENOUGH
from solidgear.trains.file.train import Train


def stress(
    source: Source | Train,
    model: str = "",
    *,
    tol: float | str = ENOUGH,
    local: float | str | None = None,
    conditions: Mapping[str, Any] | Conditions | None = None,
    duty: bool = False,
    progress: Callable[[str], None] = lambda text: None,
    **under: Unpack[Under],
) -> StressAtRest:
    """Stress of shafts at rest: section forces, nominal stress, stress on fillets, DIN 743.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file (TOML), the tables of one, or an object.
    model : str
        Model for bearing reactions; by default the cheapest solid that models all of each shaft, or
        none where they follow from statics.
    tol : float
        Error bar allowed for a form factor, relative.
    local : float, optional
        Error bar allowed for form factors of keyways and cross holes, relative, for which 3D
        solids are solved, some seconds each; without it they have none.
    conditions : mapping or Conditions, optional
        Of the rating by DIN 743: ``roughness``, ``ultimate_at_size``, ``yield_at_size``,
        ``treated_diameter``, ``hardening``, ``hard_surface``, ``surface_strength``,
        ``force_share``, ``torque_share``, ``bending_share``, ``overload``, ``constant_mean``,
        ``cycles``, ``spectrum``, ``hours``, ``damage_sum``.
    duty : bool
        Whether ratings are over all cases of a shaft or operating points of a train, by their
        shares or hours and speeds.
    progress : callable
        Called with a sentence at every step.
    **under
        What acts, as of :func:`solidgear.deflect`.

    Returns
    -------
    StressAtRest
        ``shafts``, each with its forces, nominal stress, fillets (``notches``) and rated features
        (``drawn``). ``write(folder)`` makes a page, section forces and their charts.

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
    settings = StressSettings(
        read_tolerance(tol), conditions, duty, None if local is None else read_tolerance(local)
    )
    assembly, at = Acting(**under).read(source)
    with explained(source):
        return stress_at_rest(assembly, at, model, settings, progress)
