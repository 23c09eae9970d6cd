"""Natural frequencies of a scene up to the highest measured one, each with an error bar."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from solidgear.core import (
    LADDER,
    BarredMode,
    Body,
    Mode,
    ModeSet,
    Scene,
    as_supports,
    build,
    modes,
    number_cautions,
    pinned,
    settle,
)
from solidgear.core.errors import NoBounds
from solidgear.core.judge.bounded import mode_bars
from solidgear.core.machine.memory import NoRoom
from solidgear.core.scene.limits import MOST_MODES
from solidgear.variants.sensitivity.adjoint import mode_form
from solidgear.variants.sweep.bench import surface

Progress = Callable[[str], None]
#: of the highest measured frequency: modes above it may be measured ones
BEYOND = 1.1
#: shapes that are solved for first, and in addition to the expected ones
FEW, MORE = 24, 6
#: highest order of elements that is tried, and steps between
HIGHEST, STEP = 11, 2


@dataclass(frozen=True, eq=False)
class Computed:
    """Modes of a scene."""

    scene: Scene
    body: Body
    modes: tuple[Mode, ...]  #: elastic ones by frequency
    bars: tuple[float, ...]  #: relative; infinite where none is known
    model: str  #: model
    options: dict[str, Any]  #: of its builder
    limit: float  #: hz, up to which there are all modes

    @property
    def mesh(self) -> str:
        """Model and mesh in words."""
        order = self.options.get("order")
        return f"{self.model}, order {order}" if order else self.model

    @property
    def cautions(self) -> tuple[str, ...]:
        """Sentences on what the frequencies leave out."""
        bars = {str(mode.name): bar for mode, bar in zip(self.modes, self.bars)}
        return tuple(number_cautions(self.scene, bars, self.model))

    def widths(self, springs: float) -> np.ndarray:
        """Return standard deviations (modes,) of logarithms of frequencies from those of the
        stiffnesses of all bearings, each independent: half the share of a mode's energy (Rayleigh).

        A stiffness has the deviation that the scene's ``[uncertain]`` states, else ``springs``; if
        that is zero the widths are zero.
        """
        if not springs:
            return np.zeros(len(self.modes))
        supports = as_supports(self.scene)
        stated = {u.path: u.deviation for u in self.scene.uncertain}
        deviations = [stated.get(f"bearing.{name}.stiffness", springs) for name in supports.ports]
        count, rows = len(supports.ports), supports.rows(self.body)
        stiffness = np.einsum("piqj->pqij", supports.stiffness.reshape(count, 6, count, 6))
        stiffness, widths = stiffness[range(count), range(count)], []
        for mode in self.modes:
            states = [state for state, _ in mode_form(self.body, supports, mode).pairs]
            motions = np.array([state.motions[rows].reshape(count, 6) for state in states])
            energy = np.einsum("spi,pij,spj->p", motions, stiffness, motions) / len(states)
            widths.append(
                np.linalg.norm(deviations * energy) / (2 * np.pi * mode.frequency_hz) ** 2
            )
        return np.array(widths) / 2

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
    """Compute all modes up to a little above a frequency, Hz, by the cheapest solid; one of
    revolution is refined until the error bar of every mode is within a relative tolerance. It
    begins on the mesh of an earlier result `before` of a similar scene.
    """
    limit = BEYOND * highest
    if before is None:
        settled = settle(scene, tolerance, "modes", progress=progress)
        model, options, body = settled.rung, dict(settled.options), settled.body
    else:
        model, options = before.model, dict(before.options)
        same_surface = surface(scene) == surface(before.scene)
        body = before.body if same_surface else build(scene, model, **options)
    progress("modes and their error bars")
    listed, bars = _barred(scene, body, limit)
    while LADDER[model].follows and options.get("order", 3) + STEP <= HIGHEST:
        # the highest mode of a family may have no bar
        known = [b for m, b in zip(listed, bars) if m.frequency_hz <= highest and math.isfinite(b)]
        if max(known, default=0.0) <= tolerance:
            break
        options["order"] = options.get("order", 3) + STEP
        progress(f"order {options['order']}: error bars of all modes")
        body = build(scene, model, **options)
        listed, bars = _barred(scene, body, limit)
    return Computed(scene, body, tuple(listed), tuple(bars), model, options, limit)


@pinned
def computed_like(before: Computed, scene: Scene) -> Computed:
    """Compute the same modes of a similar scene, on the mesh and with the error bars of an earlier
    result.
    """
    body = before.body
    if surface(scene) != surface(before.scene):
        body = build(scene, before.model, **before.options)
    shapes = sum(mode.multiplicity for mode in before.modes)
    listed = _elastic(_modes(scene, body, before.limit, shapes + MORE))
    bars = {str(mode.name): bar for mode, bar in zip(before.modes, before.bars)}
    # planes that part have other names, and bars like the others
    usual = max((bar for bar in before.bars if math.isfinite(bar)), default=math.inf)
    listed_bars = tuple(bars.get(str(mode.name), usual) for mode in listed)
    return replace(before, scene=scene, body=body, modes=tuple(listed), bars=listed_bars)


@pinned
def motions_up_to(computed: Computed, limit: float) -> list[tuple[Mode, float]]:
    """Return all modes up to a frequency, Hz, with free rigid motions, and their error bars: the
    largest of all for the highest of a family, infinite where none is known.
    """
    scene, body = computed.scene, computed.body
    solved = _modes(scene, body, limit, 2 * len(computed.modes))
    known_bars = {str(mode.name): bar for mode, bar in zip(computed.modes, computed.bars)}
    bars = known_bars | _bars(scene, body, solved)
    usual = max((bar for bar in bars.values() if math.isfinite(bar)), default=math.inf)
    all_bars = [
        usual if math.isinf(bars.get(str(m.name), math.inf)) else bars[str(m.name)]
        for m in solved.modes
    ]
    return [(m, bar if m.frequency_hz > 0 else 0.0) for m, bar in zip(solved.modes, all_bars)]


def _barred(scene: Scene, body: Body, limit: float) -> tuple[list[Mode], list[float]]:
    """Return modes of a body and their error bars."""
    solved = _modes(scene, body, limit)
    by_name = _bars(scene, body, solved)
    listed = _elastic(solved)
    return listed, [by_name.get(str(mode.name), math.inf) for mode in listed]


def _bars(scene: Scene, body: Body, solved: ModeSet) -> dict[str, float]:
    """Return relative error bars by the names of modes; none where they cannot be computed."""
    try:
        return mode_bars(scene, body, as_supports(scene), solved)
    except (NoBounds, NoRoom):
        return {}


def _modes(scene: Scene, body: Body, limit: float, count: int = FEW) -> ModeSet:
    """Return all modes up to a frequency: the number of shapes grows until it is passed."""
    while True:
        solved = modes(body, scene, n=min(count, MOST_MODES), max_frequency=limit)
        listed = _elastic(solved)
        if count >= MOST_MODES or sum(m.multiplicity for m in listed) < count:
            return solved
        count = math.ceil(count * limit / listed[-1].frequency_hz) + MORE


def _elastic(solved: ModeSet) -> list[Mode]:
    return [mode for mode in solved.modes if mode.frequency_hz > 0]
