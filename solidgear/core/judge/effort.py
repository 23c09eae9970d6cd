"""Time and memory of heavy meshes of a solid."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from solidgear.core.errors import SolidgearError
from solidgear.core.ladder.model import Model

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: unknowns from which a mesh takes minutes, which is said beforehand
HEAVY = 250_000
#: a rough number from which there may be so many
MAYBE_HEAVY = HEAVY / 3
#: s for so many unknowns on two cores, and how time grows with them: sectors with holes took 8 to 14,
#: 25 to 52 and 190 s for 129,000, 311,000 and 1,241,000 unknowns
SECONDS, UNKNOWNS, GROWTH = 10.0, 130_000, 1.3


def cost_text(unknowns: int, mb: float) -> str:
    """Return unknowns, memory and time of a mesh in words, rounded to their accuracy.

    Examples
    --------
    >>> cost_text(931_117, 5894.0)
    '931,117 unknowns, about 5.9 GB and 2 to 4 min'
    """
    minutes = SECONDS * (unknowns / UNKNOWNS) ** GROWTH / 60
    low, high = max(1, round(0.8 * minutes)), max(2, math.ceil(1.5 * minutes))
    return f"{unknowns:,} unknowns, about {mb / 1e3:.1f} GB and {low} to {high} min"


def heavy_meshes(scene: Scene, model: Model) -> Iterator[str]:
    """Yield the cost of the two coarsest meshes of a solid, which an error bar needs, in sentences
    where it is much; meshes that may be large are made and counted.
    """
    places = ("its coarsest mesh", "the next, without which there is no error bar,")
    words = []
    for position, level in zip(places, model.meshes_of(scene, {}).levels):
        if model.rough_unknowns(scene, level) < MAYBE_HEAVY:
            continue
        try:
            size = model.size(scene, level)
        except SolidgearError:
            continue  # said where it is built
        if size.unknowns >= HEAVY:
            words.append(f"{position} takes {cost_text(size.unknowns, size.mb)}")
    if words:
        yield f"the {model.title} is heavy here: {'; '.join(words)}"
