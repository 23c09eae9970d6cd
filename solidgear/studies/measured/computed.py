"""Natural frequencies of a scene up to where something was measured, each with its bar."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from solidgear.body import Body, as_supports
from solidgear.judge.bounded import mode_bars
from solidgear.ladder import build
from solidgear.ladder.registry import LADDER
from solidgear.machine.threads import pinned
from solidgear.scene import Scene
from solidgear.scene.rules import MOST_MODES
from solidgear.solve.modes import Mode, modes
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
    mesh : str
        Model and mesh in words.
    """

    scene: Scene
    body: Body
    modes: tuple[Mode, ...]
    bars: tuple[float, ...]
    tolerance: float
    mesh: str

    @property
    def barred(self) -> tuple[BarredMode, ...]:
        """Names, frequencies and bars."""
        return tuple(
            BarredMode(str(mode.name), mode.frequency_hz, bar if math.isfinite(bar) else None)
            for mode, bar in zip(self.modes, self.bars)
        )


@pinned
def computed_up_to(
    scene: Scene, highest: float, tolerance: float, progress: Progress = lambda _: None
) -> Computed:
    """All modes up to a little above a frequency, by the cheapest solid; one of revolution is refined
    until the bar of every mode is within a tolerance.

    Parameters
    ----------
    highest : float
        Hz.
    tolerance : float
        Relative.
    """
    limit = BEYOND * highest
    ask = scene.ask.with_changes(modes=MOST_MODES, max_frequency=limit)
    found = one_shaft(scene.with_changes(ask=ask), tolerance, progress=progress)
    body, listed = found.settled.body, [m for m in found.modes.modes if m.frequency_hz > 0]
    bars = [found.bars.get(mode.name, math.inf) for mode in listed]
    rung, options = found.settled.rung, dict(found.settled.options)
    while LADDER[rung].bounded and _largest(listed, bars, highest) > tolerance:
        options["order"] = options.get("order", 3) + STEP
        if options["order"] > HIGHEST:
            break
        progress(f"order {options['order']}: bars of all modes")
        body = build(scene, rung, **options)
        found_modes = modes(body, scene, n=MOST_MODES, max_frequency=limit)
        listed = [mode for mode in found_modes.modes if mode.frequency_hz > 0]
        told = mode_bars(scene, body, as_supports(scene), found_modes)
        bars = [told.get(str(mode.name), math.inf) for mode in listed]
    mesh = f"{rung}, order {options['order']}" if "order" in options else f"{rung}"
    return Computed(scene, body, tuple(listed), tuple(bars), tolerance, mesh)


def _largest(listed: list[Mode], bars: list[float], highest: float) -> float:
    """Largest bar up to a frequency; the highest mode of a family may have none."""
    told = [b for m, b in zip(listed, bars) if m.frequency_hz <= highest and math.isfinite(b)]
    return max(told, default=0.0)
