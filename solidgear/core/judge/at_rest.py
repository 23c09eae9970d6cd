"""Cautions that natural frequencies are those at rest, where the speed of a shaft is known: modes
that spin moves by more than their error bars and by a tenth of a per cent; those without bars by
more than a tolerance.

What spin does depends on the shaft and its speed, and not on who shows a frequency: it is computed
on a light harmonic solid of the plain part, whichever model a number comes from.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite, pi

from solidgear.core.body import as_supports
from solidgear.core.body.mode_names import BENDING, ModeName
from solidgear.core.errors import SolidgearError, listed
from solidgear.core.judge.solving import ENOUGH
from solidgear.core.ladder import build
from solidgear.core.ladder.meshes import HARMONIC
from solidgear.core.quantity import QUANTITIES, Quantity
from solidgear.core.scene import Scene
from solidgear.core.scene.ask import MOST_MODES
from solidgear.core.scene.shaft import turning_speed, without_axis
from solidgear.core.solve.modes import modes
from solidgear.core.solve.spin import Whirl, spin_moves

#: modes that a sentence names, and the least share of the largest move for one to be counted
MOST_NAMED, WORTH_NAMING = 3, 0.1
#: relative; nobody minds a smaller change of a frequency, however narrow the error bar is
LEAST_MOVE = 1e-3
AT_REST = "natural frequencies are those at rest"
#: frequencies that studies show, without error bars
USUAL: Mapping[str, None] = dict.fromkeys(str(q) for q in QUANTITIES if q.is_frequency)


@dataclass(frozen=True)
class Moved:
    """Modes of a shaft that spin moves by more than their error bars, or else by a tolerance."""

    speed: float  #: rad/s
    modes: Mapping[str, Whirl]  #: by names, those that it moves the most first
    tolerance: float  #: relative
    of: str = ""  #: shaft that has the speed, where there are several
    how: str = ""  #: end of the sentence, on how it is known

    @property
    def sentence(self) -> str:
        """The caution."""
        of = f" of the {self.of}" if self.of else ""
        words = (f"{n} by {_move_words(whirl, self.tolerance)}" for n, whirl in self.modes.items())
        modes_text = listed(words, most=MOST_NAMED)
        return f"{AT_REST}; {at_speed(self.speed)}{of} spin moves {modes_text}{self.how}"


def at_speed(speed: float) -> str:
    """Return a speed, rad/s, in words."""
    return f"at {60 * speed / (2 * pi):.6g} rpm"


def spin_caution(
    scene: Scene, bars: Mapping[str, float | None] = USUAL, speed: float | None = None
) -> list[str]:
    """Return a sentence on those natural frequencies of a shaft, by names, that spin moves, or none;
    parameters are as of :func:`spin_moved`.
    """
    try:
        moved = spin_moved(scene, bars, speed)
    except (SolidgearError, ArithmeticError, MemoryError) as error:
        reason = str(error) or "not enough memory"
        return [f"{AT_REST}; how far spin moves them is not known: {reason}"]
    return [] if moved is None else [moved.sentence]


def spin_moved(
    scene: Scene, bars: Mapping[str, float | None] = USUAL, speed: float | None = None
) -> Moved | None:
    """Return those natural frequencies of a shaft, by names, that spin moves, or None; error bars are
    relative, None where there is none, and names of other quantities are left out. The speed (rad/s)
    is that of the scene by default. A body without an axis does not turn.
    """
    speed = speed or turning_speed(scene)
    bars = {name: bar for name, bar in bars.items() if Quantity(name).is_frequency}
    if not speed or not bars or without_axis(scene):
        return None
    moves = _moves(scene, len(bars), speed / (2 * pi))
    by_name = {name: moves.get(_on_plain_part(scene, name)) for name in bars}
    how = "" if scene.plain is scene else ", by the round part without cuts"
    moves = {name: whirl for name, whirl in by_name.items() if whirl is not None}
    return moved_beyond(moves, bars, scene.ask.tolerance, speed, how=how)


def _moves(scene: Scene, count: int, turns: float) -> dict[str, Whirl]:
    """Compute what spin does to the modes of the plain part, at least so many of them."""
    plain = scene.settled.plain
    body = build(plain, "harmonic", **HARMONIC)
    listed_modes = modes(body, plain, min(count + ENOUGH, MOST_MODES)).modes
    return spin_moves(body, as_supports(plain), listed_modes, turns)


def _on_plain_part(scene: Scene, name: str) -> str:
    """Return the name of a mode on the plain part, where both planes of bending have one."""
    mode = ModeName(name)
    if mode.family != BENDING or mode.number is None or scene.plain is scene:
        return name
    # in ascending order both planes have a number each
    number = mode.number if mode.plane else (mode.number + 1) // 2
    return f"{BENDING} {number}"


def moved_beyond(
    moves: Mapping[str, Whirl],
    bars: Mapping[str, float | None],
    tolerance: float,
    speed: float,
    *,
    of: str = "",
    how: str = "",
) -> Moved | None:
    """Return the modes that spin moves, by what it does to them; None where their error bars, or else
    a tolerance, are wider, or nobody minds it.
    """
    moved = {}
    for name, whirl in moves.items():
        bar = bars.get(name)
        limit = bar if bar is not None and isfinite(bar) else tolerance
        if _size(whirl) > max(limit, LEAST_MOVE):
            moved[name] = whirl
    if not moved:
        return None
    largest = max(map(_size, moved.values()))
    most = sorted(moved, key=lambda name: _size(moved[name]), reverse=True)
    modes_moved = {n: moved[n] for n in most if _size(moved[n]) >= WORTH_NAMING * largest}
    return Moved(speed, modes_moved, tolerance, of, how)


def _size(whirl: Whirl) -> float:
    return max(-whirl.down, whirl.up)


def _move_words(whirl: Whirl, tolerance: float) -> str:
    """Return how far spin moves a mode; what is known to first order is no more than a guess where
    its square, which that leaves out, is beyond the tolerance.
    """
    if whirl.first_order:
        beyond = whirl.up**2 / 2 > tolerance
        order = "first order, no more than a guess" if beyond else "first order"
        return f"{_percent(whirl.up)} up and down ({order})"
    ways = [w for w in (whirl.down, whirl.up) if abs(w) > WORTH_NAMING * _size(whirl)]
    return " and ".join(
        f"{'-' if way < 0 else '+'}{_percent(abs(way))}" for way in dict.fromkeys(ways)
    )


def _percent(share: float) -> str:
    """Return a share in per cent with two digits."""
    per_cent = 100 * share
    return f"{per_cent:.0f} %" if per_cent >= 10 else f"{per_cent:.2g} %"
