"""Preload of two single bearings that hold a shaft against each other: told once, it is of both."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from solidgear.bearings.catalogued import Catalogued
from solidgear.scene import Bearing, Scene
from solidgear.scene.catalogue import Preload

#: of a displacement, to which both rows press alike
ALIKE = 1e-9
#: makes a row under a preload
Press = Callable[[Preload], Catalogued]


def partners(scene: Scene) -> dict[str, str]:
    """By the name of each bearing that takes a preload from another, the name of that one: the nearest
    that holds the shaft the other way and is told a preload that no other such row is told as well.
    """
    rows = [
        (b, b.catalogue)
        for b in scene.bearings
        if b.catalogue is not None and b.catalogue.one_sided
    ]
    pressed = [(b, data.holds) for b, data in rows if data.preload is not None]
    free = [
        (b, data.holds)
        for b, data in rows
        if data.preload is None and data.load is None and data.displacement is None and not b.floats
    ]
    for one, way in [*pressed]:  # those of a pair that are told both
        if (one, way) in pressed and (other := _nearest(one, way, pressed)) is not None:
            pressed.remove((one, way))
            pressed = [own for own in pressed if own[0] is not other]
    out: dict[str, str] = {}
    for one, way in pressed:
        if (other := _nearest(one, way, free)) is not None:
            free = [own for own in free if own[0] is not other]
            out[other.name] = one.name
    return out


def _nearest(
    one: Bearing, way: str | None, rows: Sequence[tuple[Bearing, str | None]]
) -> Bearing | None:
    """The nearest row that holds the shaft the other way; None where there is none."""
    opposite = [b for b, other in rows if b is not one and other != way]
    return min(opposite, key=lambda b: abs(b.y - one.y), default=None)


def divided(displacement: float, first: Press, second: Press) -> tuple[Preload, Preload]:
    """Displacements of two rows that together are one, m, under which both press alike."""
    from scipy.optimize import brentq  # slow to import, and seldom needed

    def preloads(share: float) -> tuple[Preload, Preload]:
        own, other = (part * displacement for part in (share, 1 - share))
        return Preload(displacement=own), Preload(displacement=other)

    def beyond(share: float) -> float:
        made = (press(own) for press, own in zip((first, second), preloads(share)))
        one, two = (abs(float(own.bearing.load(np.zeros(6))[1])) for own in made)
        return one - two

    return preloads(float(brentq(beyond, 0.0, 1.0, xtol=ALIKE)))
