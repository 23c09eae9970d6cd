"""A data sheet from a path, tables or an object."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Unpack

from solidgear.core import SolidgearError, Source, explained, is_train
from solidgear.datasheet.language import Language
from solidgear.datasheet.result import Datasheet
from solidgear.datasheet.shaft import shaft_sheet
from solidgear.datasheet.train import train_sheet
from solidgear.show.options import speed_of
from solidgear.show.units import ENGINEERING
from solidgear.strength.acting import Acting, Under
from solidgear.strength.stress.at_rest import StressSettings
from solidgear.strength.stress.conditions import Conditions
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.train import Train
from solidgear.trains.loading import load_train


def sheet(
    source: Source | Train,
    tol: float | str | None = None,
    *,
    language: str = "en",
    speed: str | None = None,
    conditions: Mapping[str, Any] | Conditions | None = None,
    progress: Callable[[str], None] = lambda text: None,
    **under: Unpack[Under],
) -> Datasheet:
    """One page of a shaft or a train: drawing with forces, numbers with both error bars, verdict,
    worst place, bearings and lives, deflection, natural frequencies and speeds to avoid.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file (TOML), the tables of one, or an object.
    tol : float, optional
        Relative error that numbers of a shaft may have; by default that of the file.
    language : {'en', 'de'}
        Of all words.
    speed : str, optional
        Speed of a shaft alone, such as ``"1500 rpm"``; by default that of its file.
    conditions : mapping or Conditions, optional
        Of the rating by DIN 743, as of :func:`solidgear.stress`.
    progress : callable
        Called with a sentence at every step.
    **under
        What acts, as of :func:`solidgear.deflect`.

    Returns
    -------
    Datasheet
        ``to_html()`` is the page, ``save("sheet.pdf")`` writes it.  What the file has no data for is
        in ``absent`` with the reason.

    Raises
    ------
    SolidgearError
        For an unknown language, options that do not apply, and a file that no model can answer.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.sheet("geometry/shaft_stepped.toml")
    >>> found.trust.model, [figure.name for figure in found.figures][:2], "motions" in found.absent
    ('harmonic', ['C_zz', 'C_z,thx'], True)
    >>> "Eigenfrequenzen" in found.in_language("de").to_html()
    True
    """
    Language(language, ENGINEERING)  # before anything is solved
    if not isinstance(conditions, Conditions):
        conditions = Conditions(**(conditions or {}))
    settings = StressSettings(conditions=conditions, surfaces=False)
    acting = Acting(**under)
    with explained(source):
        if isinstance(source, Train) or is_train(source):
            facts = _of_train(source, acting, settings, tol, speed, progress)
        else:
            assembly, at = acting.read(source, tol)
            facts = shaft_sheet(assembly, at, settings, tol, speed_of(speed), progress)
    return replace(facts, language=language)


def _of_train(
    source: Source | Train,
    acting: Acting,
    settings: StressSettings,
    tol: float | str | None,
    speed: str | None,
    progress: Callable[[str], None],
) -> Datasheet:
    """Return the sheet of a train; one without a torque has no section on loads."""
    if speed is not None:
        raise SolidgearError("`speed` is for a shaft alone; that of a train stands in [operation]")
    train = load_train(source)
    if not train.operation and acting.torque is None:
        return train_sheet(train, None, None, settings, progress)
    train, at = acting.read_train(train)
    return train_sheet(train, Assembly(train, tol=tol), at, settings, progress)
