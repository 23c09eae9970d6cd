"""One shaft by the cheapest solid that is sure enough: its numbers and modes, each with its bar."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.body import Body, as_supports
from solidgear.judge.quantities import Values, size
from solidgear.judge.settle import Settled, bars_of_modes, settle
from solidgear.judge.solving import answered
from solidgear.quantity import QUANTITIES, Quantity
from solidgear.scene.closed_form import mass_properties
from solidgear.scene.differences import ROUNDING
from solidgear.solve.modes import Mode, ModeSet
from solidgear.studies.beside import Side
from solidgear.studies.change import BarredMode
from solidgear.studies.check import cautions

if TYPE_CHECKING:
    from solidgear.scene import Scene

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class OneShaft(Side):
    """A shaft, solved with bars."""

    scene: Scene
    settled: Settled
    values: Values  #: SI
    modes: ModeSet
    bars: dict[str, float]  #: relative, of quantities and modes
    mass: float  #: of the shaft without what sits on it, kg
    mass_bar: float | None  #: relative; that of rounding where it has a closed form, None elsewhere

    @property
    def title(self) -> str:
        """Title of its scene."""
        return self.scene.title or self.scene.name

    def bar(self, name: Quantity) -> float | None:
        """Bar of a quantity in its own unit; None where nothing is known."""
        width = self.settled.bars.get(name, math.inf) * size(self.values, name)
        return width if math.isfinite(width) else None

    def seen(self, mode: Mode) -> BarredMode:
        """A mode with its bar."""
        bar = self.bars.get(mode.name, math.inf)
        return BarredMode(str(mode.name), mode.frequency_hz, bar if math.isfinite(bar) else None)


def one_shaft(
    scene: Scene,
    tol: float,
    letter: str = "",
    name: str = "",
    points: Sequence[str] = (),
    before: Settled | None = None,
    progress: Progress = lambda _: None,
) -> OneShaft:
    """A shaft by the cheapest solid whose bars are within a relative tolerance, with the numbers of
    further lumped points; `before` as of :func:`solidgear.judge.settle.settle`.
    """

    def say(text: str) -> None:
        progress(f"{letter}: {text}" if letter else text)

    settled = settle(scene, tol, points=points, before=before, progress=say)
    body = settled.body
    say("statics and modes")
    found = answered(
        body,
        as_supports(scene),
        [scene.port.name, *points],
        n=scene.ask.modes,
        max_frequency=scene.ask.max_frequency,
        ovalising=True,
        wanted=[q for q in QUANTITIES if q.is_frequency],
        spare=True,
    )
    say("how sure its frequencies are")
    bars = bars_of_modes(scene, body, found.modes.whole, settled)
    for asked in (q for q in settled.bars if q.is_frequency):
        # bending may be called by its plane
        mode = found.modes.named(asked)
        if mode is not None:
            bars.setdefault(str(mode.name), settled.bars[asked])
    mass, exact = mass_of(scene, body)
    said = tuple(cautions(scene, body))
    numbers = found.quantities, found.modes, bars
    return OneShaft(letter, name, said, scene, settled, *numbers, mass, exact)


def mass_of(scene: Scene, body: Body) -> tuple[float, float | None]:
    """Mass of a shaft without what sits on it, kg, and its relative bar: that of rounding where the
    mass has a closed form, None where it is that of a mesh.
    """
    if body.mesh.get("round", True):
        return mass_properties(scene.outline).mass, ROUNDING
    return float(body.mass_matrix()[0, 0]), None
