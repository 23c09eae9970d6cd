"""Caution of a sheet on natural frequencies that spin moves."""

from __future__ import annotations

from collections.abc import Iterator

from solidgear.core.judge.at_rest import Moved
from solidgear.datasheet.facts import Amount, ModeTerm, Remark, Speed


def caution_of_spin(moved: Moved | None) -> Iterator[Remark]:
    """Yield a caution on the frequency that spin moves the most, if it moves any."""
    if moved is None:
        return
    mode, whirl = next(iter(moved.modes.items()))
    ends = {"down": Amount(100 * whirl.down, "%", 2), "up": Amount(100 * whirl.up, "%", 2)}
    yield Remark("caution spin", {"speed": Speed(moved.speed), "mode": ModeTerm(mode), **ends})
