"""Two shafts under their loads beside each other: motions of lumped points and loads of bearings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot, sqrt

from solidgear.core import Scene, SolidgearError
from solidgear.core.judge.change import Change
from solidgear.strength.deflection.at_rest import Deflection, Measured, deflections
from solidgear.strength.load import AT_REST
from solidgear.trains.assembly.assembly import NO_MODES, Assembly
from solidgear.trains.load.static_errors import FORBIDDEN
from solidgear.two_designs.beside import NumberChange

#: motions across the shaft by their words: components, and SI unit
ACROSS = {"deflection": (("x", "z"), "m moved"), "slope": (("thx", "thz"), "rad moved")}
BY = "by the cheapest solids that model all of the shafts"


def loaded_changes(scenes: Sequence[Scene]) -> tuple[tuple[NumberChange, ...], str]:
    """Return numbers of two shafts under their loads, each in the first case of its own, or the reason
    why there are none; both are empty of shafts without loads.
    """
    if not all(scene.is_loaded for scene in scenes):
        return (), ""
    try:
        a, b = (_deflected(scene) for scene in scenes)
    except SolidgearError as error:
        return (), f"Under the loads nothing is compared: {error}"
    return tuple(_changes(a, b)), ""


def _deflected(scene: Scene) -> Deflection:
    assembly = Assembly.of(scene, kept=NO_MODES)
    return deflections(assembly, [assembly.train.point or AT_REST], *assembly.solids)[0]


def _changes(a: Deflection, b: Deflection) -> Iterator[NumberChange]:
    """Yield the motions of points that both have, without slopes that symmetry forbids, and radial
    loads of such bearings.
    """
    for point in (name for name in a.lumped if name in b.lumped):
        changes = {}
        for word, (components, _) in ACROSS.items():
            (first, bar_a), (second, bar_b) = (
                _size([m for m in solved.displacement[point] if m.name in components])
                for solved in (a, b)
            )
            changes[word] = Change(first, second, bar_a, bar_b)
        arm, moved = float(a.shafts[0].stations[-1]), changes["deflection"].a
        for word, change in changes.items():
            if word == "deflection" or arm * change.a > FORBIDDEN * moved:
                yield NumberChange(f"{word} of {point}", ACROSS[word][1], change, change.a)
    partners = {bearing.name: bearing for bearing in b.shafts[0].bearings}
    for bearing in a.shafts[0].bearings:
        if bearing.name in partners:
            change = Change(bearing.radial, partners[bearing.name].radial)
            yield NumberChange(f"radial load of {bearing.name}", "N", change, bearing.radial)


def _size(measures: Sequence[Measured]) -> tuple[float, float | None]:
    """Return the size of a motion by its components, and a bar that holds it."""
    bars = [measure.bar for measure in measures if measure.bar is not None]
    size = hypot(*(measure.value for measure in measures))
    return size, sqrt(sum(bar**2 for bar in bars)) if len(bars) == len(measures) else None
