"""Options of `response` that speak of one speed, and what is printed of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity
from solidgear.show import speed_tables
from solidgear.show.command import Group, say
from solidgear.trains.file.train import Train
from solidgear.trains.modes.modes import TrainMode
from solidgear.trains.response.at_speed import (
    NEAR,
    AtSpeed,
    at_speed,
    refuse_share,
    turns_of_pinion,
)
from solidgear.trains.response.spectrum import read_spectrum

#: rows of tables on a terminal
MOST, MOST_NEAR = 30, 10


@dataclass(frozen=True)
class Speed(Group):
    """Options of `response` that speak of one speed."""

    speed: Annotated[
        str | None,
        typer.Option(
            "--speed",
            help='Speed such as "3000 rpm": orders of shafts, mesh and catalogue bearings in Hz, '
            "and those near natural frequencies. By default the operating point's speed.",
        ),
    ] = None
    of: Annotated[
        str | None,
        typer.Option(
            "--of", help="Shaft of --speed: pinion or gear; by default the engine's shaft."
        ),
    ] = None
    measured: Annotated[
        Path | None,
        typer.Option(
            "--measured",
            help="Spectrum at this speed (CSV: frequency in Hz, amplitude), drawn over the "
            "computed mesh force; every peak is listed with its order.",
        ),
    ] = None
    fit_speed: Annotated[
        float | None,
        typer.Option(
            "--fit-speed",
            help="Fit the speed within this share, such as 0.03, to the mesh order in the spectrum.",
        ),
    ] = None
    within: Annotated[
        float | None,
        typer.Option(
            "--within", help="Share of a natural frequency within which an order is listed; 0.05."
        ),
    ] = None

    def asked(self, train: Train) -> Asked:
        """Return these options checked for a train."""
        return Asked(train, self)


class Asked:
    """Options of one speed, checked before anything is solved.

    Raises
    ------
    SolidgearError
        For a speed that is none, a spectrum that cannot be used, or options that need others.
    """

    def __init__(self, train: Train, speed: Speed):
        self.train, self.fit = train, speed.fit_speed
        self.within = NEAR if speed.within is None else speed.within
        self.turns, self.told = 0.0, ""
        if speed.speed is not None:
            shaft = speed.of or train.reference
            self.turns, self.told = (
                _turns(train, speed.speed, shaft),
                f"{speed.speed} of the {shaft}",
            )
            if shaft != train.reference:
                self.told += f", {60 * self.turns:.6g} rpm of the {train.reference}"
        elif train.point is not None and train.point.speed:
            turns = train.point.speed_of(train.reference, train.turns) or 0.0
            self.turns, self.told = turns / (2 * pi), train.point.label
        else:
            for option, value in (
                ("--measured", speed.measured),
                ("--within", speed.within),
                ("--of", speed.of),
            ):
                if value is not None:
                    raise SolidgearError(f'{option} needs a speed; add --speed "3000 rpm"')
        refuse_share("--within", speed.within)
        refuse_share("--fit-speed", speed.fit_speed)
        if speed.fit_speed is not None and speed.measured is None:
            raise SolidgearError("--fit-speed needs a spectrum; add --measured spectrum.csv")
        self.spectrum = None if speed.measured is None else read_spectrum(speed.measured)

    def found(self, modes: Iterable[TrainMode]) -> AtSpeed | None:
        """Return orders at the speed; nothing without one."""
        if not self.turns:
            return None
        how = self.within, self.spectrum, self.fit
        return at_speed(self.train, modes, self.turns, self.told, *how)


def _turns(train: Train, text: str, shaft: str) -> float:
    try:
        speed = quantity(text, "speed")
    except SceneError:
        raise SolidgearError(
            f'--speed {show(text, 40)}: write a number and a unit, such as "3000 rpm" or '
            '"314 rad/s"'
        ) from None
    try:
        return turns_of_pinion(train, speed, shaft)
    except SolidgearError as error:
        raise SolidgearError(f"--speed {show(text, 40)} --of {show(shaft, 40)}: {error}") from None


def say_at_speed(orders: AtSpeed) -> None:
    """Print orders at a speed, those near natural frequencies, and measured peaks."""
    say(speed_tables.first_lines(orders.lines))
    near = speed_tables.coincidences(orders, MOST_NEAR)
    say(near if near else f"{near.title}: none.")
    if orders.spectrum is not None:
        peaks = speed_tables.measured(orders, MOST)
        say(peaks if peaks else f"{peaks.title}: none stands out of the noise.")
    say(*orders.notes())
