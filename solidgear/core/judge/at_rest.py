"""Cautions that natural frequencies are those at rest, where the speed of a shaft is known: modes
that spin opens by more than their error bars and by a tenth of a per cent; those without bars by
more than a tolerance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite, pi

from solidgear.core.body import Body, as_supports
from solidgear.core.errors import listed
from solidgear.core.scene import Scene
from solidgear.core.scene.shaft import turning_speed
from solidgear.core.solve.modes import Mode
from solidgear.core.solve.spin import spin_openings

#: modes that a sentence names, and the least share of the largest opening for one to be counted
MOST_NAMED, WORTH_NAMING = 3, 0.1
#: relative; nobody minds a smaller change of a frequency, however narrow the error bar is
LEAST_OPENING = 1e-3


def spin_caution(
    scene: Scene,
    body: Body,
    modes: Sequence[Mode],
    bars: Mapping[str, float],
    speed: float | None = None,
) -> list[str]:
    """Return a sentence on the modes of a shaft that spin opens, or none; error bars are relative,
    by the names of modes, with the tolerance of the scene where they are missing, and the speed
    (rad/s) is that of the scene by default.
    """
    speed = speed or turning_speed(scene)
    if not speed:
        return []
    revolutions = speed / (2 * pi)
    openings = spin_openings(body, as_supports(scene), modes, revolutions)
    frequency = {str(mode.name): mode.frequency_hz for mode in modes}
    shares = {name: hz / frequency[name] for name, hz in openings.items()}
    return opened_words(shares, bars, scene.ask.tolerance, f"at {60 * revolutions:.6g} rpm")


def opened_words(
    shares: Mapping[str, float], bars: Mapping[str, float | None], tolerance: float, speed_text: str
) -> list[str]:
    """Return a sentence on modes by the share of their frequency by which spin opens them, the most
    first; none where their error bars, or else a tolerance, are wider, or nobody minds it.
    """
    opened = {}
    for name, share in shares.items():
        bar = bars.get(name)
        limit = bar if bar is not None and isfinite(bar) else tolerance
        if share > max(limit, LEAST_OPENING):
            opened[name] = share
    if not opened:
        return []
    largest = max(opened.values())
    most = sorted(opened, key=opened.__getitem__, reverse=True)
    most = [name for name in most if opened[name] >= WORTH_NAMING * largest]
    modes_text = listed((f"{name} by {100 * opened[name]:.2g} %" for name in most), most=MOST_NAMED)
    return [
        f"natural frequencies are those at rest; {speed_text} spin moves {modes_text} up and down "
        "(first order)"
    ]
