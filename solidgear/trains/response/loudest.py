"""The largest dynamic mesh force of a train in a sentence, and the speeds at which it occurs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from operator import attrgetter
from typing import Any

import numpy as np

from solidgear.core import Scene
from solidgear.core.plain import plain
from solidgear.trains.file.train import PerTurn, Train
from solidgear.trains.modes.modes import TrainMode
from solidgear.trains.response.drive import highest_speed
from solidgear.trains.response.response import OrderCurve, TrainResponse, figures

_force = attrgetter("force")
#: relative, of frequencies that are the same
SAME = 1e-9
HEIGHT = "height depends on losses, without error bar"


@dataclass(frozen=True)
class Top:
    """The largest force of a part of a curve."""

    frequency_hz: float  #: of the order of the teeth
    force: float  #: amplitude, N
    order: int  #: of the teeth, counted from 1
    mode: str  #: that makes the peak there; empty where the part ends, or rises without a peak
    #: where it ends: the mode whose peak follows as the curve rises; empty where none does
    towards: str = ""


@dataclass(frozen=True)
class Loudest:
    """The largest dynamic mesh force of all orders, compared with the speeds that the files give."""

    top: Top  #: the largest that teeth meet at the speeds given, or of the range where none is
    peak: Top | None  #: the largest peak there, where the curve ends higher
    beyond: Top | None  #: a larger force that they do not reach
    #: of the mesh in one turn of the engine's shaft; 0 where a force on a port drives the train,
    #: which no speed belongs to
    teeth: PerTurn
    #: relative, of the frequency of the mode of `top`; None where a model has no bar
    bar: float | None
    rpm: float | None  #: highest speed of the engine's shaft in the files
    said_by: str  #: where that speed stands
    #: begin_hz, asked_hz: lowest and highest frequency of the range
    begin_hz: float
    asked_hz: float
    orders: int = 1  #: of the teeth
    parting: tuple[str, ...] = ()  #: sentences on teeth that part
    what: str = "mesh force"  #: in words, which of several meshes has it

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return plain(self) | {"sentences": self.sentences()}

    @property
    def limit_hz(self) -> float:
        """Frequency at which the teeth pass at the highest speed of the files, Hz; zero where
        nothing turns there.
        """
        return self.rpm * self.teeth / 60 if self.rpm else 0.0

    def sentences(self) -> list[str]:
        """Return the largest force first, then the reach of the speeds over the range."""
        limit = self.limit_hz
        upto = f" up to {self.asked_hz:g} Hz"
        if limit:
            upto = f" up to {self.rpm:.0f} rpm of the {self.teeth.of} ({self.said_by})"
        sureness = HEIGHT
        if self.top.mode:
            bar = "no error bar"
            if self.bar is not None:
                bar = f"within {f'{100 * self.bar:.1g}' if self.bar >= 1e-4 else '0.01'} %"
            sureness = f"{bar} in frequency; {HEIGHT}"
        lines = [f"Largest dynamic {self.what}{upto}: {self._top_text(self.top)} ({sureness})."]
        if self.peak is not None:
            lines.append(f"Largest peak up to there: {self._top_text(self.peak)}.")
        lines += self.parting
        if self.rpm == 0:
            lines.append(
                f"At 0 rpm ({self.said_by}) nothing drives the train, so this is over the whole "
                "range."
            )
        if not limit:
            return lines
        if self.beyond is not None:
            lines.append(
                f"A larger one lies beyond the highest speed, {self.rpm:.0f} rpm and {limit:.0f} "
                f"Hz of the teeth: {self._top_text(self.beyond)}."
            )
        if self.asked_hz < 0.999 * self.orders * limit:
            further = f", their order {self.orders} at {self.orders * limit:.0f} Hz"
            lines.append(
                f"The range asked for, up to {self.asked_hz:g} Hz, ends below the teeth's "
                f"{limit:.0f} Hz at {self.rpm:.0f} rpm{further * (self.orders > 1)}; raise "
                "max_frequency."
            )
        return lines

    def _top_text(self, top: Top) -> str:
        speed = f", order {top.order} of the teeth" if top.order > 1 else ""
        if self.teeth:
            rpm = 60 * top.frequency_hz / (top.order * self.teeth)
            speed += f", {self.teeth.of} at {rpm:.0f} rpm"
        place = top.mode or self._end(top)
        return f"{figures(top.force)} N at {figures(top.frequency_hz)} Hz{speed}, {place}"

    def _end(self, top: Top) -> str:
        """Return words on the place where a part of a curve ends, or rises without a peak."""
        ends = {
            "the highest speed": top.order * self.limit_hz,
            "the end of the range": self.asked_hz,
            "the start of the range": self.begin_hz,
        }
        rising = f", still rising towards {top.towards}" if top.towards else ""
        for end, hz in ends.items():
            if abs(top.frequency_hz - hz) <= SAME * hz:
                return f"{end}{rising}"
        return "not a peak"


def loudest(
    response: TrainResponse,
    modes: Sequence[TrainMode],
    train: Train,
    scenes: Mapping[str, Scene],
    meshes: bool = True,
    mesh: str | None = None,
) -> Loudest:
    """Return the largest dynamic mesh force of a response, with modes of the same models; `meshes`
    is False where a force on a port drives the train instead of the error of a mesh, by default
    the first.
    """
    speed = highest_speed(train, scenes) if meshes else None
    pair = train.named_mesh(mesh)
    teeth = train.per_turn(pair)
    limit = speed.rpm * teeth / 60 * (1 + SAME) if speed is not None and speed.rpm else inf
    hz = response.frequency_hz
    reached = [top for c in response.orders for top in _top(c, hz, hz <= c.order * limit)]
    unreached = [top for c in response.orders for top in _top(c, hz, hz > c.order * limit)]
    # a range that begins beyond the speeds has its first point alone
    top = max(reached or unreached, key=_force)
    larger = max((t for t in unreached if t.force > top.force), key=_force, default=None)
    peaks = (
        Top(p.frequency_hz, p.force, c.order, p.mode)
        for c in response.orders
        for p in c.peaks
        if p.frequency_hz <= c.order * limit
    )
    mode = next((m for m in modes if m.name == top.mode), None)
    return Loudest(
        top=top,
        peak=None if top.mode else max(peaks, key=_force, default=None),
        beyond=larger if reached else None,
        teeth=teeth if meshes else PerTurn(0.0),
        bar=None if mode is None or mode.mesh is None else mode.mesh + mode.bound,
        rpm=None if speed is None else speed.rpm,
        said_by="" if speed is None else speed.source,
        begin_hz=float(hz[0]),
        asked_hz=float(hz[-1]),
        orders=len(response.orders),
        parting=response.parting,
        what=f"force of the {pair.name}" if pair.label else "mesh force",
    )


def _top(curve: OrderCurve, frequency_hz: np.ndarray, mask: np.ndarray) -> Iterator[Top]:
    """Yield the largest force of a part of a curve; none where it has no point."""
    places = np.flatnonzero(mask)
    if not len(places):
        return
    k = int(places[curve.force[places].argmax()])
    hz, force = float(frequency_hz[k]), float(curve.force[k])
    mode = next((p.mode for p in curve.peaks if p.frequency_hz == hz), "")
    rises = not mode and k == places[-1] and k + 1 < len(curve.force)
    next_peak = (p.mode for p in curve.peaks if p.frequency_hz > hz) if rises else iter(())
    yield Top(hz, force, curve.order, mode, next(next_peak, ""))
