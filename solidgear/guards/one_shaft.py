"""One shaft by the cheapest solid that is sure enough: numbers and modes with their error bars."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.core import (
    QUANTITIES,
    BarredMode,
    Body,
    Mode,
    ModeSet,
    Quantity,
    Settled,
    Supports,
    as_supports,
    bars_of_modes,
    settle,
    size,
)
from solidgear.core.judge.bounded import with_all_for_bars
from solidgear.core.judge.change import Side
from solidgear.core.judge.quantities import Values
from solidgear.core.judge.solving import quantities_at, search_modes
from solidgear.core.scene.own_mass import own_mass
from solidgear.guards.check import cautions

if TYPE_CHECKING:
    from solidgear.core import Scene

Progress = Callable[[str], None]
#: relative, of a mass in closed form
ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class OneShaft(Side):
    """A shaft, solved with error bars."""

    scene: Scene
    settled: Settled
    values: Values  #: SI
    modes: ModeSet
    bars: dict[str, float]  #: relative, of quantities and modes
    mass: float  #: of the shaft without masses on it, kg
    mass_bar: float | None  #: kg; rounding for a closed form, else None

    @property
    def title(self) -> str:
        """Title of the scene."""
        return self.scene.title or self.scene.name

    def bar(self, name: Quantity) -> float | None:
        """Return the error bar of a quantity in its unit; None where nothing is known, as of a free
        motion.
        """
        if name not in self.values:
            return None
        width = self.settled.bars.get(name, math.inf) * size(self.values, name)
        return width if math.isfinite(width) else None

    def seen(self, mode: Mode) -> BarredMode:
        """Return a mode with the error bar."""
        bar = self.bars.get(mode.name, math.inf)
        return BarredMode(str(mode.name), mode.frequency_hz, bar if math.isfinite(bar) else None)


def one_shaft(
    scene: Scene,
    tol: float,
    letter: str = "",
    name: str = "",
    points: Sequence[str] = (),
    before: Settled | None = None,
    guarded: bool = True,
    progress: Progress = lambda _: None,
) -> OneShaft:
    """Solve a shaft by the cheapest solid whose error bars are within a relative tolerance, with
    numbers of further lumped points; `before` as in :func:`solidgear.core.judge.settle.settle`. Where
    it is not `guarded` it has no cautions, which may cost a beam and a light solid.
    """

    def say(text: str) -> None:
        progress(f"{letter}: {text}" if letter else text)

    def solved(body: Body) -> ModeSet:
        say("modes")
        return search_modes(
            body,
            as_supports(scene),
            scene.ask.modes,
            [q for q in QUANTITIES if q.is_frequency],
            max_frequency=scene.ask.max_frequency,
            ovalising=True,
            spare=True,
        )

    #: of the last mesh: its modes, and all that their bars rest on
    last: list[tuple[Body, ModeSet, ModeSet]] = []

    def listing(body: Body, supports: Supports) -> ModeSet:
        listed = solved(body)
        last[:] = [(body, listed, with_all_for_bars(body, supports, listed.whole))]
        return last[0][2]

    ask = "all" if scene.ports else "modes"
    settled = settle(scene, tol, ask, points=points, before=before, listing=listing, progress=say)
    body, extended = settled.body, None
    if last and last[0][0] is body:
        ((_, modes, extended),) = last
    else:
        modes = solved(body)
    main = [port.name for port in scene.ports[:1]]
    values = quantities_at([*main, *points], body, as_supports(scene), modes)
    say("error bars of its frequencies")
    bars = bars_of_modes(scene, body, modes.whole, settled, extended)
    for quantity in (q for q in settled.bars if q.is_frequency):
        # bending may be called by its plane
        mode = modes.named(quantity)
        if mode is not None:
            bars.setdefault(str(mode.name), settled.bars[quantity])
    mass, mass_bar = mass_of(scene)
    return OneShaft(
        letter=letter,
        name=name,
        cautions=tuple(cautions(scene, body)) if guarded else (),
        scene=scene,
        settled=settled,
        values=values,
        modes=modes,
        bars=bars,
        mass=mass,
        mass_bar=mass_bar,
    )


def mass_of(scene: Scene) -> tuple[float, float | None]:
    """Return the mass of a shaft without masses on it, kg, and its error bar, kg: rounding where it has
    a closed form, None where it is that of a file.
    """
    mass = own_mass(scene).mass
    return mass, ROUNDING * mass if scene.body is None or scene.body.round else None
