"""A train at a speed: options of `response`, orders in Hz, those near natural frequencies, the orders
that peaks of a measured spectrum belong to, and what is printed of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.plain import plain
from solidgear.core.scene.units import quantity
from solidgear.show import speed_tables
from solidgear.show.command import Group, say
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.kinematics import SLIP, angles_of, settled_angles, train_orders
from solidgear.trains.file.train import PerTurn, Train
from solidgear.trains.load.operation import Operating
from solidgear.trains.modes.modes import TrainMode
from solidgear.trains.response.spectrum import Spectrum, read_spectrum

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


NOT_OURS = "not ours"
#: share of a natural frequency within which an order is listed
NEAR = 0.05
#: kinds of orders in the sequence of the tables: those that excite most come first
TOLD = ("mesh", "shaft", "sideband")
ROLLING = (
    "Orders of teeth are exact and have no error bar. Orders of bearings assume pure rolling; "
    f"their error bars cover {100 * SLIP:g} % of slip either way, and both ends of an estimated "
    "inside."
)


@dataclass(frozen=True)
class Line:
    """An order at the speed."""

    #: kind, name, source: as of :class:`solidgear.trains.assembly.kinematics.Order`
    kind: str
    name: str
    source: str
    frequency_hz: float
    low_hz: float
    high_hz: float

    @property
    def exact(self) -> bool:
        """Whether teeth alone give it."""
        return self.low_hz == self.high_hz


@dataclass(frozen=True)
class Coincidence:
    """An order near a natural frequency."""

    line: str
    mode: str
    line_hz: float
    mode_hz: float
    #: low, high: of the order from the mode, as a share of the latter
    off: float
    rpm: float


@dataclass(frozen=True)
class MeasuredPeak:
    """A peak of a measured spectrum."""

    frequency_hz: float
    amplitude: float
    resolution_hz: float
    #: the nearest order within its bar and the resolution, lines of teeth before those of bearings;
    #: None where there is none
    line: Line | None
    others: tuple[str, ...]  #: further orders within their bars and the resolution

    @property
    def name(self) -> str:
        """Name of the order, or ``not ours``."""
        return NOT_OURS if self.line is None else self.line.name


@dataclass(frozen=True, eq=False)
class AtSpeed:
    """Findings at one speed."""

    rpm: float  #: of the shaft `of`
    speed: str  #: origin of the speed
    within: float  #: share of a natural frequency within which orders are listed
    lines: tuple[Line, ...]
    modes: tuple[tuple[str, float], ...]
    #: of the mesh, of shafts, of sidebands, of bearings; of each the nearest first
    coincidences: tuple[Coincidence, ...]
    spectrum: Spectrum | None = None
    peaks: tuple[MeasuredPeak, ...] = ()
    #: share of the spectrum's range that lines cover with their bars and the resolution: of peaks
    #: that are none of ours, so many are called so by chance
    covered: float | None = None
    shaft: str = "pinion"

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        out: dict[str, Any] = {
            f"{self.shaft}_rpm": self.rpm,
            "speed": self.speed,
            "within": self.within,
            "lines": plain(self.lines),
            "coincidences": plain(self.coincidences),
        }
        if self.spectrum is not None:
            out["measured"] = {
                "file": self.spectrum.name,
                "what": self.spectrum.what,
                "unit": self.spectrum.unit,
                "peaks": plain(self.peaks),
                "covered": self.covered,
            }
        return out

    def notes(self) -> list[str]:
        """Return sentences on where the numbers come from and how sure they are."""
        out = [f"Speed: {self.speed}."]
        if not all(line.exact for line in self.lines):
            out.append(ROLLING)
        if self.spectrum is not None and self.covered is not None:
            foreign = sum(peak.line is None for peak in self.peaks)
            out.append(
                f"{self.spectrum.name}: {len(self.peaks)} peaks stand out, {foreign} of them not "
                f"ours; error bars and resolution cover {100 * self.covered:.2g} % of the range, "
                "so that share of unrelated peaks matches an order by chance."
            )
            if not any(peak.line is not None and peak.line.kind == "mesh" for peak in self.peaks):
                out.append(
                    "No peak is an order of the mesh: check the speed and its shaft, or fit the "
                    "speed."
                )
        return out


def turns_of_pinion(train: Train, speed: float, shaft: str) -> float:
    """Return the turns of the engine's shaft in a second, from the speed of a shaft in rad/s;
    refused unless above zero.
    """
    if shaft not in train.turns:
        raise SolidgearError(f"speed of {shaft!r}: a train has a {' and a '.join(train.turns)}")
    if not speed > 0:
        raise SolidgearError(
            "the speed must be greater than zero; the direction does not change orders"
        )
    return speed / (2 * np.pi) / train.turns[shaft]


def refuse_share(name: str, share: float | None) -> None:
    """Refuse a number that is not between 0 and 1."""
    if share is not None and not 0 < share < 1:
        raise SolidgearError(f"{name} {share:g}: give a share between 0 and 1, such as 0.05")


def at_speed(
    train: Train,
    modes: Iterable[TrainMode],
    turns: float,
    speed: str,
    within: float = NEAR,
    spectrum: Spectrum | None = None,
    fit: float | None = None,
) -> AtSpeed:
    """Compare the orders of a train at a speed, turns of the pinion in a second, with natural
    frequencies to a relative distance, and with a measured spectrum; `speed` is the origin of
    the speed in words, and `fit` the share of it within which it is fitted to the first order of
    the mesh in the spectrum.

    Examples
    --------
    >>> import solidgear as sg
    >>> from solidgear.trains.assembly.assembly import Assembly
    >>> from solidgear.trains.modes.modes import train_modes
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
    >>> modes = train_modes(assembly, "timoshenko", max_frequency=1000.0).modes
    >>> found = at_speed(assembly.train, modes, 3210 / 60, "3210 rpm of the pinion")
    >>> first = found.coincidences[0]
    >>> first.line, first.mode, round(100 * first.off, 1)
    ('mesh 1', 'gear bending 2', 4.6)
    """
    refuse_share("within", within)
    refuse_share("fit", fit)
    tops = spectrum.peaks() if spectrum is not None else []
    if fit is not None:
        turns, speed = _fitted(tops, train.per_turn(train.drivers[0]), turns, fit, speed)
    lines = []
    for order in train_orders(train, _angles(train)):
        hz, low, high = order.at(turns)
        lines.append(Line(order.kind, order.name, order.source, hz, low, high))
    mode_list = tuple((m.name, m.frequency_hz) for m in modes if m.frequency_hz > 0 and m.driven)
    coincidences = _coincidences(lines, mode_list, turns, within)
    return AtSpeed(
        rpm=60 * turns,
        speed=speed,
        within=within,
        lines=tuple(lines),
        modes=mode_list,
        coincidences=coincidences,
        spectrum=spectrum,
        peaks=tuple(explained(lines, hz, amplitude, width) for hz, amplitude, width in tops),
        covered=None if spectrum is None else _covered(lines, spectrum),
        shaft=train.reference,
    )


def _angles(train: Train) -> dict[str, tuple[float, ...]]:
    """Return contact angles of all bearings where their stiffness is taken, by ``side.bearing``: at
    the operating point of the train, or without one at the loads of the scenes.
    """
    if train.point is not None:
        state = Operating(Assembly(train)).at(train.point)
        return angles_of(state.bearings, state.equilibrium.relative)
    return {
        f"{side}.{name}": angles
        for side, shaft in train.shafts.items()
        for name, angles in settled_angles(shaft.scene).items()
    }


def _coincidences(
    lines: Sequence[Line], modes: Sequence[tuple[str, float]], turns: float, within: float
) -> tuple[Coincidence, ...]:
    ranked = []
    for line in lines:
        rank = TOLD.index(line.kind) if line.kind in TOLD else len(TOLD)
        for name, hz in modes:
            difference = line.frequency_hz / hz - 1
            if abs(difference) <= within:
                rpm = 60 * turns * hz / line.frequency_hz
                coincidence = Coincidence(
                    line=line.name,
                    mode=name,
                    line_hz=line.frequency_hz,
                    mode_hz=hz,
                    off=difference,
                    rpm=rpm,
                )
                ranked.append((rank, abs(difference), coincidence))
    return tuple(coincidence for *_, coincidence in sorted(ranked, key=lambda row: row[:2]))


def _fitted(
    tops: Sequence[tuple[float, float, float]],
    teeth: PerTurn,
    turns: float,
    share: float,
    speed: str,
) -> tuple[float, str]:
    """Return the speed at which the largest peak near the first order of the mesh is that order,
    and the origin in words.
    """
    wanted = teeth * turns
    near_peaks = [top for top in tops if abs(top[0] / wanted - 1) <= share]
    if not near_peaks:
        raise SolidgearError(
            f"no peak of the spectrum lies within {100 * share:g} % of the first mesh order at "
            f"{wanted:.6g} Hz; check the speed and its shaft, or fit within a larger share"
        )
    hz, _, resolution = max(near_peaks, key=lambda top: top[1])
    difference = 100 * (hz / wanted - 1)
    return hz / teeth, (
        f"{60 * hz / teeth:.6g} rpm of the {teeth.of}, fitted: the largest peak within "
        f"{100 * share:g} % of the mesh order, {hz:.6g} Hz, is taken for it; {difference:+.2f} % from "
        f"{speed}, known to {100 * resolution / hz:.2g} %"
    )


def explained(
    lines: Sequence[Line], hz: float, amplitude: float, resolution: float
) -> MeasuredPeak:
    """Return a peak and the orders that it may be."""
    candidates = [
        line for line in lines if line.low_hz - resolution <= hz <= line.high_hz + resolution
    ]
    # orders of teeth alone lie within the resolution, where a wide bar holds almost anything
    candidates.sort(key=lambda line: (not line.exact, abs(line.frequency_hz - hz)))
    if not candidates:
        return MeasuredPeak(hz, amplitude, resolution, None, ())
    names = tuple(line.name for line in candidates[1:])
    return MeasuredPeak(hz, amplitude, resolution, candidates[0], names)


def _covered(lines: Sequence[Line], spectrum: Spectrum) -> float:
    """Return the share of the lines of a spectrum on which a peak would be assigned to an order."""
    hz, resolution = spectrum.frequency_hz, spectrum.resolution_hz
    explained_lines = np.zeros(len(hz), bool)
    for line in lines:
        explained_lines |= (hz >= line.low_hz - resolution) & (hz <= line.high_hz + resolution)
    return float(resolution[explained_lines].sum() / resolution.sum())
