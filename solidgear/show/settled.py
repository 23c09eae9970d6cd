"""Numbers of one scene by one model, and words on a mesh that was chosen for them: ``-f auto``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import typer

from solidgear.core import BEAM, LADDER, Body, OpenNumbers, Quantity, Scene, Settled
from solidgear.core.judge.answer import Answered
from solidgear.core.judge.quantities import in_words
from solidgear.core.judge.settle import widest
from solidgear.show.command import NOT_REACHED
from solidgear.show.words import is_number, percent


def source_of_bars(model: str) -> str:
    """Return the sentence on where the error bars of a model come from whose mesh was set."""
    return f"Error bars: {LADDER[model].bars_by}, on this mesh."


@dataclass(frozen=True)
class Judged:
    """Numbers of a scene by one model: their error bars and what is said beside them."""

    scene: Scene
    body: Body
    settled: Settled | None  #: None where model and mesh were given
    bars: Mapping[Quantity, float]  #: relative
    reason: str  #: that no number has an error bar; empty where some have one
    cautions: Sequence[str]
    open: OpenNumbers

    @property
    def heading(self) -> str:
        """Scene, model, mesh and size."""
        model = self.body.fidelity
        if self.settled is not None:
            model = f"{model}, {self.settled.setting} (auto)"
        mesh = self.body.mesh
        part = f"{mesh['solved_part']}, " if "solved_part" in mesh else ""
        return f"{self.scene.name}: {model}, {part}{self.body.size} unknowns"

    @property
    def reached(self) -> bool:
        """Return whether the tolerance is kept, if one was asked for."""
        return self.settled is None or self.settled.reached


def bar_lines(
    settled: Settled | None, bars: Mapping[Quantity, float] | None = None, bare: bool = False
) -> list[str]:
    """Return the largest error bar shown, by default of all judged, and whether the tolerance is
    kept; `bare` where further numbers are shown without one.
    """
    if settled is None:
        return []
    chosen = settled.bars if bars is None else bars
    return [*largest_bar(chosen, settled.point), *sentences(settled, bare)]


def over_the_sweep(settled: Settled | None) -> list[str]:
    """Return the same for a sweep, judged on the scene and at the ends of the ranges."""
    if settled is None:
        return []
    mesh = f"Mesh: {settled.rung}, {settled.setting}."
    range_ = f" over {settled.judged_on} bearing sets (the scene's and those at the ends)"
    if settled.judged_on == 1:
        range_ = " on the scene's bearing set alone (those at the ends are refused)"
    return [mesh, *largest_bar(settled.bars, settled.point, range_), *sentences(settled)]


def largest_bar(bars: Mapping[Quantity, float], point: str, range_: str = "") -> list[str]:
    """Return the sentence on the quantity with the largest error bar; `point` is the main one."""
    top = widest(bars)
    if top is None:
        return []

    quantity, bar = top
    main = point if any(name.points for name in bars) else ""
    width = percent(bar, signed=False) if is_number(bar) else "unknown"
    return [f"Largest error bar{range_}: +- {width}, of {in_words(quantity, main)}."]


def ended(settled: Settled | None) -> None:
    """Exit with code 3 where the tolerance is not kept."""
    if settled is not None and not settled.reached:
        raise typer.Exit(NOT_REACHED)


def sentences(answered: Answered | Settled, bare: bool = False) -> list[str]:
    """Return sentences on solids that were skipped and why, and on the tolerance; skipped beams
    are not named.

    Beams are passed over always, for they have no error of their own to show.
    """
    passed: dict[str, list[str]] = {}
    for step in answered.steps:
        if not step.valid and LADDER[step.rung].family != BEAM:
            passed.setdefault(step.why, []).append(step.rung)
    lines = [f"Skipped: {', '.join(names)} ({reason})." for reason, names in passed.items()]
    if answered.missing:
        lines.append(f"No answer for {_absent(answered.missing)}.")
    tolerance = f"{100 * answered.tolerance:g} %"
    if answered.reached:
        within = "All others are within" if answered.missing else "Within"
        within = "What has an error bar is within" if bare else within
        lines.append(f"{within} the {tolerance} asked.")
        return lines
    reason = next((step.why for step in answered.steps if step.chosen and step.why), "")
    lines.append(f"Not reached: {tolerance} was asked for{f'; {reason}' if reason else ''}.")
    return lines


def _absent(missing: Sequence[Quantity]) -> str:
    """Return quantities that a scene does not have, each kind with the reason."""
    free = [q for q in missing if not q.is_frequency]
    modes = [q for q in missing if q.is_frequency]
    single = len(free) == 1
    reasons = [
        (free, f"{'a motion' if single else 'motions'} that no bearing resists"),
        (modes, "no such mode among the lowest"),
    ]
    return "; ".join(f"{', '.join(names)} ({reason})" for names, reason in reasons if names)
