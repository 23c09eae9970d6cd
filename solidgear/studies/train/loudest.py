"""The largest dynamic mesh force of a train in a sentence, and the speeds at which it is met."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from math import inf, pi
from typing import Any

from solidgear.scene import Scene
from solidgear.scene.train import PerTurn, Train
from solidgear.studies.train.modes import TrainMode
from solidgear.studies.train.respond import Peak, TrainResponse

RPM = 30 / pi


@dataclass(frozen=True)
class Loudest:
    """The largest peak of the mesh force, beside the speeds that the files give.

    Attributes
    ----------
    peak : Peak or None
        The largest that the first order of the teeth meets at the speeds given, or of the range where
        none is; None where there is no peak.
    beyond : Peak or None
        A larger one that they do not reach.
    teeth : PerTurn
        Of the mesh in one turn of the engine's shaft; 0 where a force on a port drives the train,
        which no speed belongs to.
    bar : float or None
        Relative, of the frequency of its mode; None where a model has no bar.
    rpm : float or None
        Highest speed of the engine's shaft in the files.
    said_by : str
        Where that speed stands.
    asked_hz : float
        Highest frequency of the range.
    what : str
        In words, which of several meshes has it.
    """

    peak: Peak | None
    beyond: Peak | None
    teeth: PerTurn
    bar: float | None
    rpm: float | None
    said_by: str
    asked_hz: float
    what: str = "mesh force"

    def as_dict(self) -> dict[str, Any]:
        """Plain data that JSON can hold."""
        return asdict(self) | {"sentences": self.sentences()}

    def sentences(self) -> list[str]:
        """The peak first, then what speeds say of the range."""
        limit = None if self.rpm is None else self.rpm * self.teeth / 60
        upto = f" up to {self.asked_hz:g} Hz"
        if limit:
            upto = f" up to {self.rpm:.0f} rpm of the {self.teeth.of} ({self.said_by})"
        lines = [f"There is no peak of the dynamic {self.what}{upto}."]
        if self.peak is not None:
            sure = "its model has no bar"
            if self.bar is not None:
                sure = f"within {f'{100 * self.bar:.1g}' if self.bar >= 1e-4 else '0.01'} %"
            lines = [
                f"Largest dynamic {self.what}{upto}: {self._told(self.peak)} ({sure} in frequency; "
                "the height hangs on the losses and has no bar)."
            ]
        if not limit:
            return lines
        if self.beyond is not None:
            lines.append(
                f"A larger one cannot be reached, for at {self.rpm:.0f} rpm teeth pass at "
                f"{limit:.0f} Hz: {self._told(self.beyond)}."
            )
        if self.asked_hz < 0.999 * limit:
            lines.append(
                f"The range asked for, up to {self.asked_hz:g} Hz, does not cover the speeds: teeth "
                f"pass at {limit:.0f} Hz at {self.rpm:.0f} rpm; raise max_frequency."
            )
        return lines

    def _told(self, peak: Peak) -> str:
        if self.teeth:
            rpm = 60 * peak.frequency_hz / self.teeth
            speed = f", {self.teeth.of} at {rpm:.0f} rpm"
        else:
            speed = ""
        return f"{_figures(peak.force)} N at {_figures(peak.frequency_hz)} Hz{speed}, {peak.mode}"


def _figures(value: float) -> str:
    """Three figures, without a power of ten; as many as there are before the point."""
    return f"{value:.0f}" if value >= 1000 else f"{value:.3g}"


def loudest(
    response: TrainResponse,
    modes: Sequence[TrainMode],
    train: Train,
    scenes: Mapping[str, Scene],
    meshes: bool = True,
    mesh: str | None = None,
) -> Loudest:
    """The largest peak of a response.

    Parameters
    ----------
    modes : sequence of TrainMode
        Of the same models.
    scenes : mapping of str to Scene
        Of all shafts.
    meshes : bool, optional
        False where a force on a port drives the train instead of the teeth.
    mesh : str, optional
        Whose error drives it; the first by default.
    """
    rpm, said_by = max(_speeds(train, scenes), default=(None, "")) if meshes else (None, "")
    pair = train.named_mesh(mesh)
    teeth = train.per_turn(pair)
    limit = inf if rpm is None else rpm * teeth / 60
    by_force = sorted(response.peaks, key=lambda one: -one.force)
    peak = next((one for one in by_force if one.frequency_hz <= limit), None)
    beyond = next(iter(by_force), None)
    mode = next((m for m in modes if peak is not None and m.name == peak.mode), None)
    return Loudest(
        peak,
        None if beyond is peak else beyond,
        teeth if meshes else PerTurn(0.0),
        None if mode is None or mode.mesh is None else mode.mesh + mode.bound,
        rpm,
        said_by,
        float(response.frequency_hz[-1]),
        f"force of the {pair.name}" if pair.label else "mesh force",
    )


def _speeds(train: Train, scenes: Mapping[str, Scene]) -> Iterator[tuple[float, str]]:
    """Speeds that the files give, rpm of the engine's shaft, and where."""
    for point in train.operation:
        if (speed := point.speed_of(train.reference, train.turns)) is not None:
            yield abs(speed) * RPM, f"operation {point.name!r}" if point.name else "the operation"
    for side, own in train.turns.items():
        turns, oil = 1 / own, scenes[side].lubrication
        if oil is not None and oil.speed:
            yield turns * abs(oil.speed) * RPM, f"lubrication of the {side}"
        for bearing in scenes[side].bearings:
            if bearing.catalogue is not None and bearing.catalogue.speed:
                speed = abs(bearing.catalogue.speed)
                yield turns * speed * RPM, f"bearing {bearing.name!r} of the {side}"
