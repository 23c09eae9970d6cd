"""Natural frequencies of a scene up to where something was measured, each with its bar."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from solidgear.body import Body, as_supports
from solidgear.judge.bounded import mode_bars
from solidgear.judge.coarser_mesh import coarser_bars
from solidgear.judge.settle import Settled, bars_of_modes, settle
from solidgear.ladder import build
from solidgear.ladder.registry import LADDER
from solidgear.machine.threads import pinned
from solidgear.scene import Scene
from solidgear.scene.rules import MOST_MODES
from solidgear.scene.shaft import without_axis
from solidgear.solve.adjoint import mode_form
from solidgear.solve.modes import Mode, ModeSet, modes
from solidgear.studies.change import BarredMode
from solidgear.studies.sweep.bench import surface

Progress = Callable[[str], None]
#: of the highest measured frequency: modes above it may be what was measured
BEYOND = 1.1
#: shapes that are asked for first, and beside those that are thought to be there
FEW, MORE = 24, 6
#: highest order of elements that is tried, and steps between
HIGHEST, STEP = 11, 2


@dataclass(frozen=True, eq=False)
class Computed:
    """Modes of a scene."""

    scene: Scene
    body: Body
    modes: tuple[Mode, ...]  #: elastic ones by frequency
    bars: tuple[float, ...]  #: relative; infinite where nothing tells it
    rung: str  #: model
    options: dict[str, Any]  #: of its builder
    limit: float  #: hz, up to which there are all modes

    @property
    def mesh(self) -> str:
        """Model and mesh in words."""
        order = self.options.get("order")
        return f"{self.rung}, order {order}" if order else self.rung

    def widths(self, springs: float) -> np.ndarray:
        """(modes,) standard deviations of logarithms of frequencies that those of the stiffnesses of
        all bearings make, each on its own: half the share of a mode's energy (Rayleigh).

        A stiffness has the deviation that the scene's ``[uncertain]`` states, else ``springs``; with
        none of these there are no widths, for stiffnesses are what they are.
        """
        if not springs:
            return np.zeros(len(self.modes))
        supports = as_supports(self.scene)
        said = {u.path: u.deviation for u in self.scene.uncertain}
        known = [said.get(f"bearing.{name}.stiffness", springs) for name in supports.ports]
        count, there = len(supports.ports), supports.rows(self.body)
        own = np.einsum("piqj->pqij", supports.stiffness.reshape(count, 6, count, 6))
        own, out = own[range(count), range(count)], []
        for mode in self.modes:
            states = [state for state, _ in mode_form(self.body, supports, mode).pairs]
            held = np.array([state.motions[there].reshape(count, 6) for state in states])
            energy = np.einsum("spi,pij,spj->p", held, own, held) / len(states)
            out.append(np.linalg.norm(known * energy) / (2 * np.pi * mode.frequency_hz) ** 2)
        return np.array(out) / 2

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
    """All modes up to a little above a frequency, Hz, by the cheapest solid; one of revolution is
    refined until the bar of every mode is within a relative tolerance. It begins on the mesh of
    what was computed `before` of a scene like it.
    """
    limit = BEYOND * highest
    settled = None
    if before is None or not (LADDER[before.rung].bounded or without_axis(scene)):
        settled = settle(scene, tolerance, "modes", progress=progress)
        rung, options, body = settled.rung, dict(settled.options), settled.body
    else:
        rung, options = before.rung, dict(before.options)
        alike = surface(scene) == surface(before.scene)
        body = before.body if alike else build(scene, rung, **options)
    progress("modes and how sure they are")
    listed, bars = _barred(scene, body, limit, options, settled)
    while LADDER[rung].bounded and _largest(listed, bars, highest) > tolerance:
        if options.get("order", 3) + STEP > HIGHEST:
            break
        options["order"] = options.get("order", 3) + STEP
        progress(f"order {options['order']}: bars of all modes")
        body = build(scene, rung, **options)
        listed, bars = _barred(scene, body, limit, options, settled)
    return Computed(scene, body, tuple(listed), tuple(bars), rung, options, limit)


@pinned
def computed_like(before: Computed, scene: Scene) -> Computed:
    """The same modes of a scene like one that was solved, on its mesh; bars are those it had there."""
    body = before.body
    if surface(scene) != surface(before.scene):
        body = build(scene, before.rung, **before.options)
    shapes = sum(mode.multiplicity for mode in before.modes)
    listed = _elastic(_modes(scene, body, before.limit, shapes + MORE))
    bars = {str(mode.name): bar for mode, bar in zip(before.modes, before.bars)}
    # planes that part have other names, and bars like the others
    usual = max((bar for bar in before.bars if math.isfinite(bar)), default=math.inf)
    told = tuple(bars.get(str(mode.name), usual) for mode in listed)
    return replace(before, scene=scene, body=body, modes=tuple(listed), bars=told)


@pinned
def motions_up_to(computed: Computed, limit: float) -> list[tuple[Mode, float]]:
    """All modes up to a frequency, Hz, with the rigid motions that nothing holds, and their bars: of
    the highest of a family the largest of all, and infinite where nothing tells one.
    """
    scene, body = computed.scene, computed.body
    found = _modes(scene, body, limit, 2 * len(computed.modes))
    known = {str(mode.name): bar for mode, bar in zip(computed.modes, computed.bars)}
    bars = known | _bars(scene, body, found, computed.options, None)
    usual = max((bar for bar in bars.values() if math.isfinite(bar)), default=math.inf)
    told = [
        usual if math.isinf(bars.get(str(m.name), math.inf)) else bars[str(m.name)]
        for m in found.modes
    ]
    return [(m, bar if m.frequency_hz > 0 else 0.0) for m, bar in zip(found.modes, told)]


def _barred(
    scene: Scene, body: Body, limit: float, options: Mapping[str, Any], settled: Settled | None
) -> tuple[list[Mode], list[float]]:
    """Modes of a body and their bars."""
    found = _modes(scene, body, limit)
    told = _bars(scene, body, found, options, settled)
    listed = _elastic(found)
    return listed, [told.get(str(mode.name), math.inf) for mode in listed]


def _bars(
    scene: Scene, body: Body, found: ModeSet, options: Mapping[str, Any], settled: Settled | None
) -> dict[str, float]:
    """Relative bars by the names of modes."""
    if LADDER[body.fidelity].bounded:
        return mode_bars(scene, body, as_supports(scene), found)
    if without_axis(scene):
        return coarser_bars(scene, body, found, options)
    return bars_of_modes(scene, body, found, settled)


def _modes(scene: Scene, body: Body, limit: float, count: int = FEW) -> ModeSet:
    """All modes up to a frequency: as many shapes are asked for as it takes to pass it."""
    while True:
        found = modes(body, scene, n=min(count, MOST_MODES), max_frequency=limit)
        listed = _elastic(found)
        if count >= MOST_MODES or sum(m.multiplicity for m in listed) < count:
            return found
        count = math.ceil(count * limit / listed[-1].frequency_hz) + MORE


def _elastic(found: ModeSet) -> list[Mode]:
    return [mode for mode in found.modes if mode.frequency_hz > 0]


def _largest(listed: list[Mode], bars: list[float], highest: float) -> float:
    """Largest bar up to a frequency; the highest mode of a family may have none."""
    told = [b for m, b in zip(listed, bars) if m.frequency_hz <= highest and math.isfinite(b)]
    return max(told, default=0.0)
