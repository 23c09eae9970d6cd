"""A train at a speed: its orders in Hz, those near natural frequencies, and the orders that peaks of a
measured spectrum belong to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from solidgear.core import SolidgearError
from solidgear.core.plain import plain
from solidgear.show.words import hertz
from solidgear.trains.assembly.kinematics import SLIP, angles_of, settled_angles, train_orders
from solidgear.trains.file.train import PerTurn, Train
from solidgear.trains.load.operation import before_motion
from solidgear.trains.modes.modes import TrainMode
from solidgear.trains.response.spectrum import Spectrum

NOT_OURS = "not ours"
#: share of a natural frequency within which an order is listed
NEAR = 0.05
#: kinds of orders in the sequence of the tables: those that excite most come first
RANKS = ("mesh", "shaft", "sideband")
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

    @property
    def place(self) -> str:
        """Frequency, Hz, or the ends of its error bar."""
        if self.exact:
            return hertz(self.frequency_hz)
        return f"{hertz(self.low_hz)} to {hertz(self.high_hz)}"


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
    return AtSpeed(
        rpm=60 * turns,
        speed=speed,
        within=within,
        lines=tuple(lines),
        modes=mode_list,
        coincidences=_coincidences(lines, mode_list, turns, within),
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
        state = before_motion(train, train.point)
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
        rank = RANKS.index(line.kind) if line.kind in RANKS else len(RANKS)
        for name, hz in modes:
            off = line.frequency_hz / hz - 1
            if abs(off) <= within:
                rpm = 60 * turns * hz / line.frequency_hz
                near = Coincidence(line.name, name, line.frequency_hz, hz, off, rpm)
                ranked.append((rank, abs(off), near))
    return tuple(near for *_, near in sorted(ranked, key=lambda row: row[:2]))


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
    line, names = next(iter(candidates), None), tuple(line.name for line in candidates[1:])
    return MeasuredPeak(hz, amplitude, resolution, line, names)


def _covered(lines: Sequence[Line], spectrum: Spectrum) -> float:
    """Return the share of the lines of a spectrum on which a peak would be assigned to an order."""
    hz, resolution = spectrum.frequency_hz, spectrum.resolution_hz
    covered = np.zeros(len(hz), bool)
    for line in lines:
        covered |= (hz >= line.low_hz - resolution) & (hz <= line.high_hz + resolution)
    return float(resolution[covered].sum() / resolution.sum())
