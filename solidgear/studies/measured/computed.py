"""Natural frequencies of a scene up to where something was measured, each with its bar."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from solidgear.body import Body, as_supports
from solidgear.judge.bounded import mode_bars
from solidgear.ladder import build
from solidgear.ladder.registry import LADDER
from solidgear.machine.threads import pinned
from solidgear.scene import Scene
from solidgear.scene.rules import MOST_MODES
from solidgear.solve.modes import Mode, ModeSet, modes
from solidgear.studies.change import BarredMode
from solidgear.studies.one_shaft import one_shaft

Progress = Callable[[str], None]
#: of the highest measured frequency: modes above it may be what was measured
BEYOND = 1.1
#: highest order of elements that is tried, and steps between
HIGHEST, STEP = 11, 2


@dataclass(frozen=True, eq=False)
class Computed:
    """Modes of a scene.

    Attributes
    ----------
    modes : tuple of Mode
        Elastic ones by frequency.
    bars : tuple of float
        Relative; infinite where nothing tells it.
    tolerance : float
        That bars were asked to keep.
    rung : str
        Model.
    options : dict
        Of its builder.
    """

    scene: Scene
    body: Body
    modes: tuple[Mode, ...]
    bars: tuple[float, ...]
    tolerance: float
    rung: str
    options: dict[str, Any]

    @property
    def mesh(self) -> str:
        """Model and mesh in words."""
        order = self.options.get("order")
        return f"{self.rung}, order {order}" if order else self.rung

    @property
    def barred(self) -> tuple[BarredMode, ...]:
        """Names, frequencies and bars."""
        return tuple(
            BarredMode(str(mode.name), mode.frequency_hz, bar if math.isfinite(bar) else None)
            for mode, bar in zip(self.modes, self.bars)
        )


@pinned
def computed_up_to(
    scene: Scene,
    highest: float,
    tolerance: float,
    progress: Progress = lambda _: None,
    before: Computed | None = None,
) -> Computed:
    """All modes up to a little above a frequency, by the cheapest solid; one of revolution is refined
    until the bar of every mode is within a tolerance.

    Parameters
    ----------
    highest : float
        Hz.
    tolerance : float
        Relative.
    before : Computed, optional
        Of a scene like it, on whose mesh it begins.
    """
    limit = BEYOND * highest
    if before is None or not LADDER[before.rung].bounded:
        ask = scene.ask.with_changes(modes=MOST_MODES, max_frequency=limit)
        found = one_shaft(scene.with_changes(ask=ask), tolerance, progress=progress)
        rung, options = found.settled.rung, dict(found.settled.options)
        body, listed = found.settled.body, _elastic(found.modes)
        bars = [found.bars.get(mode.name, math.inf) for mode in listed]
    else:
        rung, options = before.rung, dict(before.options)
        body, listed, bars = _on_mesh(scene, rung, options, limit)
    while LADDER[rung].bounded and _largest(listed, bars, highest) > tolerance:
        if options.get("order", 3) + STEP > HIGHEST:
            break
        options["order"] = options.get("order", 3) + STEP
        progress(f"order {options['order']}: bars of all modes")
        body, listed, bars = _on_mesh(scene, rung, options, limit)
    return Computed(scene, body, tuple(listed), tuple(bars), tolerance, rung, options)


def _on_mesh(
    scene: Scene, rung: str, options: dict[str, Any], limit: float
) -> tuple[Body, list[Mode], list[float]]:
    """Body, modes and their bars of a harmonic solid on a mesh."""
    body = build(scene, rung, **options)
    found = modes(body, scene, n=MOST_MODES, max_frequency=limit)
    told = mode_bars(scene, body, as_supports(scene), found)
    listed = _elastic(found)
    return body, listed, [told.get(str(mode.name), math.inf) for mode in listed]


def _elastic(found: ModeSet) -> list[Mode]:
    return [mode for mode in found.modes if mode.frequency_hz > 0]


def _largest(listed: list[Mode], bars: list[float], highest: float) -> float:
    """Largest bar up to a frequency; the highest mode of a family may have none."""
    told = [b for m, b in zip(listed, bars) if m.frequency_hz <= highest and math.isfinite(b)]
    return max(told, default=0.0)
