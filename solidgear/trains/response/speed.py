"""Options on one speed of a train, and the turns and the spectrum that they give."""

from __future__ import annotations

import os
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity
from solidgear.show.command import Group
from solidgear.trains.file.train import Train
from solidgear.trains.response.at_speed import refuse_share, turns_of_pinion
from solidgear.trains.response.spectrum import Spectrum, read_spectrum

if TYPE_CHECKING:
    File: TypeAlias = str | os.PathLike | None
else:
    File = Path | None


@dataclass(frozen=True)
class Speed(Group):
    """Speed of a train, and what was measured at it."""

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
        File,
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

    def turns(self, train: Train) -> tuple[float, str]:
        """Return turns of the engine's shaft in a second, and their origin in words; zero without a
        speed.
        """
        reference, point = train.reference, train.point
        if self.speed is not None:
            shaft = self.of or reference
            turns, origin = _turns(train, self.speed, shaft), f"{self.speed} of the {shaft}"
            if shaft != reference:
                origin += f", {60 * turns:.6g} rpm of the {reference}"
            return turns, origin
        if point is not None and point.speed:
            return (point.speed_of(reference, train.turns) or 0.0) / (2 * pi), point.label
        needing = {"`measured`": self.measured, "`within`": self.within, "`of`": self.of}
        for option, value in needing.items():
            if value is not None:
                raise SolidgearError(f'{option} needs a speed; add `speed` "3000 rpm"')
        return 0.0, ""

    def spectrum(self) -> Spectrum | None:
        """Read the measured spectrum, once shares are between 0 and 1."""
        refuse_share("`within`", self.within)
        refuse_share("`fit_speed`", self.fit_speed)
        if self.fit_speed is not None and self.measured is None:
            raise SolidgearError("`fit_speed` needs a spectrum; add `measured` spectrum.csv")
        return None if self.measured is None else read_spectrum(self.measured)


def _turns(train: Train, text: str, shaft: str) -> float:
    try:
        speed = quantity(text, "speed")
    except SceneError:
        raise SolidgearError(
            f'`speed` {show(text, 40)}: write a number and a unit, such as "3000 rpm" or '
            '"314 rad/s"'
        ) from None
    try:
        return turns_of_pinion(train, speed, shaft)
    except SolidgearError as error:
        raise SolidgearError(f"`speed` {show(text, 40)} `of` {show(shaft, 40)}: {error}") from None
