"""Cost of the meshes of a solid, before any of them is made."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from solidgear.errors import SolidgearError
from solidgear.ladder.model import Rung
from solidgear.ladder.size import Size, estimated_size

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: unknowns from which a mesh takes minutes, and what is told beforehand
HEAVY = 250_000
#: s for so many unknowns on two cores, and how time grows with them: sectors with holes took 8 to 14,
#: 25 to 52 and 190 s for 129,000, 311,000 and 1,241,000 unknowns
SECONDS, AT, GROWTH = 10.0, 130_000, 1.3


def told(size: Size) -> str:
    """Unknowns, memory and time of a mesh, each to what an estimate is worth.

    Parameters
    ----------
    size : Size

    Examples
    --------
    >>> told(Size(931_117, 52_801_770, 1, 100.0, 5894.0, ""))
    'about 930,000 unknowns, 5.9 GB and 2 to 4 min'
    """
    digits = 1 - math.floor(math.log10(size.unknowns))
    minutes = SECONDS * (size.unknowns / AT) ** GROWTH / 60
    low, high = max(1, round(0.8 * minutes)), max(2, math.ceil(1.5 * minutes))
    return (
        f"about {round(size.unknowns, digits):,} unknowns, {size.peak_mb / 1e3:.1f} GB and {low} to "
        f"{high} min"
    )


def foretold(scene: Scene, rung: Rung, level: Mapping[str, Any]) -> str:
    """The same of one mesh where it is heavy, led by a comma; else nothing.

    Parameters
    ----------
    scene : Scene
    rung : Rung
        A solid.
    level : mapping
        Of the builder.
    """
    try:
        size = estimated_size(scene, rung.name, dict(level))
    except (SolidgearError, ArithmeticError):
        return ""  # said where it is built
    return f", {told(size)}" if size.unknowns >= HEAVY else ""


def heavy_meshes(scene: Scene, rung: Rung) -> Iterator[str]:
    """Cost of the two coarsest meshes of a solid, from which a bar is told, where that is much.

    Parameters
    ----------
    scene : Scene
    rung : Rung
        A solid.
    """
    if rung.meshes is None:
        return
    costs = [foretold(scene, rung, level) for level in rung.meshes_of(scene, {}).levels[:2]]
    if any(costs):
        places = ("its coarsest mesh", "the next, without which there is no bar,")
        words = [f"{where} takes {cost[2:]}" for where, cost in zip(places, costs) if cost]
        yield f"the {rung.title} is heavy here: {'; '.join(words)}"
