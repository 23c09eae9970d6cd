"""Words on a mesh that a command has chosen by itself: ``-f auto``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import typer

from solidgear.core.body import Body
from solidgear.core.errors import listed
from solidgear.core.judge.answer import Answered
from solidgear.core.judge.quantities import in_words
from solidgear.core.judge.settle import Settled, widest
from solidgear.core.ladder.model import BEAM
from solidgear.core.ladder.registry import LADDER
from solidgear.core.quantity import Quantity
from solidgear.core.scene import Scene
from solidgear.core.solve.modes import ModeSet
from solidgear.show.command import NOT_REACHED
from solidgear.show.words import is_number, percent

#: where bars of a 3D solid come from whose mesh was set
SECOND_MESH = "Bars: from a second, coarser mesh."


def heading(scene: Scene, body: Body, settled: Settled | None) -> str:
    """Scene, model, mesh and size."""
    model = body.fidelity
    if settled is not None:
        model = f"{model}, {settled.setting} (auto)"
    part = f"{body.mesh['solved_part']}, " if "solved_part" in body.mesh else ""
    return f"{scene.name}: {model}, {part}{body.size} unknowns"


def bar_lines(settled: Settled | None, bars: Mapping[Quantity, float] | None = None) -> list[str]:
    """The largest of the bars that are shown, by default of all that were judged, and whether the
    tolerance is kept, in plain text.
    """
    if settled is None:
        return []
    shown = settled.bars if bars is None else bars
    return [*largest_bar(shown, settled.point), *sentences(settled)]


def over_the_sweep(settled: Settled | None) -> list[str]:
    """The same of a sweep, whose mesh is judged on the scene and at the ends of what varies."""
    if settled is None:
        return []
    mesh = f"Mesh: {settled.rung}, {settled.setting}."
    where = f" over {settled.judged_on} bearing sets (the scene's and those at the ends)"
    if settled.judged_on == 1:
        where = " on the bearing set of the scene alone (what lies at the ends is refused)"
    return [mesh, *largest_bar(settled.bars, settled.point, where), *sentences(settled)]


def largest_bar(bars: Mapping[Quantity, float], point: str, where: str = "") -> list[str]:
    """Sentence on the quantity with the largest bar, if any has one; `point` is the main one."""
    top = widest(bars)
    if top is None:
        return []

    quantity, bar = top
    main = point if any(name.points for name in bars) else ""
    width = percent(bar, signed=False) if is_number(bar) else "unknown"
    return [f"Largest mesh bar{where}: +- {width}, of {in_words(quantity, main)}."]


def without_bar(found: ModeSet, bars: Mapping[str, float]) -> list[str]:
    """Names of elastic modes that have none."""
    return [m.name for m in found.modes if m.frequency_hz > 0 and m.name not in bars]


def beyond(bars: Mapping[str, float], settled: Settled | None) -> list[str]:
    """Sentences on bars that are not within the tolerance although those of what was judged are."""
    if settled is None or not settled.reached:
        return []

    wide = {name: bar for name, bar in bars.items() if bar > settled.tolerance}
    if not wide:
        return []
    named = listed((f"{q} +- {percent(bar, signed=False)}" for q, bar in wide.items()), most=3)
    return [
        f"Beyond {percent(settled.tolerance, signed=False)}: {named}; the first of every "
        "family are what the tolerance is kept for, a smaller --tol makes these narrower too."
    ]


def unjudged(names: Sequence[str], model: str, *, second: bool = False) -> str:
    """Reason why modes beside others have no bar, of a second mesh where that told the others; empty where
    there are none.
    """
    if not names:
        return ""
    if second:
        return "the coarser mesh has no mode of that name, or no fewer cells around"
    if LADDER[model].bounded:
        return "no further mode of their family was found above, which a bar needs; raise -n"
    return "the higher a mode, the more it asks of a mesh"


def ended(settled: Settled | None) -> None:
    """An exit code of its own where the tolerance is not kept."""
    if settled is not None and not settled.reached:
        raise typer.Exit(NOT_REACHED)


def sentences(found: Answered | Settled) -> list[str]:
    """Plain text of the choice: solids that could not answer and why, and whether the tolerance is kept.

    Beams are passed over always, for they have no error of their own to show.
    """
    passed: dict[str, list[str]] = {}
    for step in found.steps:
        if not step.valid and LADDER[step.rung].family != BEAM:
            passed.setdefault(step.why, []).append(step.rung)
    lines = [f"Passed over: {', '.join(names)} ({why})." for why, names in passed.items()]
    if found.missing:
        lines.append(f"Not there: {_absent(found.missing)}.")
    asked = f"{100 * found.tolerance:g} %"
    if found.reached:
        there = ", what is there" if found.missing else ""
        lines.append(f"Within the {asked} asked{there}.")
        return lines
    why = next((step.why for step in found.steps if step.chosen and step.why), "")
    lines.append(f"Not reached: {asked} was asked for{f'; {why}' if why else ''}.")
    return lines


def _absent(missing: Sequence[Quantity]) -> str:
    """Quantities that a scene does not have, each kind with why."""
    free = [q for q in missing if not q.is_frequency]
    modes = [q for q in missing if q.is_frequency]
    one = len(free) == 1
    whys = [
        (free, f"{'a motion' if one else 'motions'} that no bearing resists"),
        (modes, "no such mode among the lowest"),
    ]
    return "; ".join(f"{', '.join(names)} ({why})" for names, why in whys if names)
