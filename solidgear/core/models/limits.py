"""Checks of numbers against limits, and of sizes of cells, each refused in one sentence."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from solidgear.core.errors import SolidgearError, show
from solidgear.core.models.options import is_number, within

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft

Value = TypeVar("Value")
#: lines of cells along the shaft, or across it; a mesh of so many has billions of unknowns in 3D
MOST_LINES = 20_000


def number(
    model: str,
    name: str,
    value: Value,
    *,
    above: float | None = None,
    least: float | None = None,
    below: float | None = None,
    whole: bool = False,
) -> Value:
    """Return a number within limits, of which only `least` may be met, or refuse it by the option of
    the builder; None, the default, is passed through.
    """
    if value is None or is_number(value, whole) and within(value, above, least, below):
        return value
    limits = [
        f"{word} {limit:g}"
        for word, limit in (("above", above), ("at least", least), ("below", below))
        if limit is not None
    ]
    raise SolidgearError(
        f"{model}: {name} = {show(value)} is not usable; give a {'whole ' if whole else ''}number "
        f"{' and '.join(limits)}"
    )


def countable(model: str, scene: Shaft, size: float, refinement: float) -> float:
    """Return a size of cells, m, away from singular places, or refuse one of which no mesh can be
    laid out.
    """
    extent = max(scene.length, scene.outline.largest_radius)
    lines = extent / size * refinement
    if lines > MOST_LINES:
        raise SolidgearError(
            f"{model}: cells of {size / refinement:.3g} m would make {lines:.3g} lines of cells, "
            f"more than {MOST_LINES}; give size of at least "
            f"{extent * refinement / MOST_LINES:.3g} m or a smaller refinement"
        )
    return size
