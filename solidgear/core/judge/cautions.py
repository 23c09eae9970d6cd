"""Cautions that belong to numbers of a scene, whichever command or call shows them.

Who shows a number asks here, by the names of what is shown, and by the model: what a rigid seat does
that ends on softer material concerns solids; what spin does concerns natural frequencies.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from solidgear.core.judge.at_rest import spin_caution
from solidgear.core.ladder.model import SOLID
from solidgear.core.ladder.registry import LADDER
from solidgear.core.quantity import QUANTITIES
from solidgear.core.scene.shaft import without_axis

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: static numbers and natural frequencies that studies show, without error bars
SHOWN: Mapping[str, None] = dict.fromkeys(map(str, QUANTITIES))
#: static ones alone
AT_REST: Mapping[str, None] = dict.fromkeys(str(q) for q in QUANTITIES if not q.is_frequency)


def number_cautions(
    scene: Scene,
    numbers: Mapping[str, float | None] = AT_REST,
    model: str = "",
    speed: float | None = None,
) -> list[str]:
    """Return sentences to be read before numbers of a scene are used, by their names with relative
    error bars, None where there is none, by default static ones; by a solid unless a model is named, and at the speed
    (rad/s) of the scene unless one is given.

    Examples
    --------
    >>> import solidgear as sg
    >>> number_cautions(sg.load("geometry/shaft_stepped.toml"))
    []
    """
    if not numbers:
        return []
    return [*_on_seats(scene, model), *spin_caution(scene, numbers, speed)]


def _on_seats(scene: Scene, model: str) -> list[str]:
    """Return sentences on rigid seats of a solid that end where details of the drawing decide all
    numbers.
    """
    if (model and model not in LADDER.of(SOLID)) or without_axis(scene):
        return []
    if len({segment.material for segment in scene.segments}) == 1:
        return []
    # start-up: for shafts of several materials alone
    from solidgear.core.bounds.singular_places import undecided_ends

    return [*undecided_ends(scene.plain)]
