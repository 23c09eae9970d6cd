"""Compared numbers: which of them a scene is judged by, and where they are found in results."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.quantity import (
    ACROSS,
    COMPLIANCE,
    FIRST_BENDING,
    QUANTITIES,
    Quantity,
)
from solidgear.scene.rules import no_such_point, no_term
from solidgear.solve.condensed import Condensed, Coupled
from solidgear.solve.modes import ModeSet

if TYPE_CHECKING:
    from solidgear.scene import Scene

Values = Mapping[Quantity, float]

#: What models are judged by: compliances and the frequencies a gear designer reads.  Stiffnesses
#: follow from compliances and are shown, not judged: inverting spreads a small change of one entry
#: over all of them.
JUDGED = (
    *(q for q in QUANTITIES if q.kind == COMPLIANCE),
    FIRST_BENDING,
    Quantity("axial 1"),
)


def in_words(quantity: Quantity, main: str) -> str:
    """A quantity with its points in words; the main one is named where there are several.

    Examples
    --------
    >>> [in_words(Quantity(name), "wheel") for name in ("C_zz", "C_zz@wheel@pinion")]
    ['C_zz at wheel', 'C_zz between wheel and pinion']
    """
    name, pair = quantity.symbol, quantity.pair
    if pair is not None and pair[0] == pair[1]:
        return f"{name} at {pair[0]} with the other points held"
    if pair is not None:
        return f"{name} between {pair[0]} and {pair[1]}"
    if not main or quantity.is_frequency:
        return quantity
    return f"{name} at {quantity.points[0] if quantity.points else main}"


def between(names: Iterable[Quantity], points: Sequence[str]) -> tuple[Quantity, ...]:
    """Terms between some points of quantities that are of a point; of stiffnesses the diagonal too, for it
    holds all of them.

    Examples
    --------
    >>> between([Quantity("C_zz"), Quantity("C_z,thx"), Quantity("bending 1")], ["a", "b"])
    ('C_zz@a@b', 'C_z,thx@a@b', 'C_z,thx@b@a')
    """
    of_points = [name for name in names if not name.is_frequency]
    found = (
        name.at(*pair)
        for a, b in combinations_with_replacement(points, 2)
        for name in of_points
        for pair in ([(a, b), (b, a)] if name.is_coupling and a != b else [(a, b)])
    )
    return tuple(name for name in found if not name.repeats)


def at_points(names: Iterable[Quantity], points: Iterable[str]) -> tuple[Quantity, ...]:
    """Quantities at the main point, and those of them that are of a point at further ones.

    Examples
    --------
    >>> at_points([Quantity("C_zz"), Quantity("bending 1")], ["pinion"])
    ('C_zz', 'bending 1', 'C_zz@pinion')
    """
    names = tuple(names)
    of_points = [name for name in names if not name.is_frequency]
    return (*names, *(name.at(point) for point in points for name in of_points))


def usual(scene: Scene) -> tuple[Quantity, ...]:
    """Quantities that models are judged by unless a scene says otherwise: at all of its points."""
    return at_points(JUDGED, (port.name for port in scene.further_ports))


def judged(scene: Scene) -> tuple[Quantity, ...]:
    """Quantities that the models of a scene are judged by."""
    return tuple(own_name(scene, name) for name in scene.ask.quantities) or usual(scene)


def own_name(scene: Scene, name: Quantity) -> Quantity:
    """A quantity as results call it: that of the main point has no name behind it, and points stand
    in the order of the scene where it does not matter.

    Raises
    ------
    SolidgearError
        If the scene has no such point, or for a stiffness between points.
    """
    known = [port.name for port in scene.ports]
    asked = list(name.points_among(known))
    for one in asked:
        if one not in known:
            raise SolidgearError(f"{name}: {no_such_point(one, known)}")
    if reason := no_term(name, asked):
        raise SolidgearError(f"{name}: {reason}")
    if len(set(asked)) < 2:
        return name.at(*(point for point in asked[:1] if point != known[0]))
    if not name.is_coupling:
        asked.sort(key=known.index)
    return name.at(*asked)


def in_order(names: Iterable[Quantity]) -> list[Quantity]:
    """Names as they are listed: of the main point as in `QUANTITIES` and `ACROSS`, then those of
    further ones and between points; without those that only repeat another.
    """
    names = list(names)
    further = (q for q in names if q.points and not q.repeats)
    return [*(q for q in (*QUANTITIES, *ACROSS) if q in names), *further]


def measure(
    condensed: Condensed | None,
    modes: ModeSet | None,
    further: Mapping[str, Condensed] | None = None,
    coupled: Coupled | None = None,
    known: Sequence[Quantity] = QUANTITIES,
) -> dict[Quantity, float]:
    """The compared numbers of one solution; those that do not exist (free motions, missing modes)
    or were not solved (None) are left out.

    Parameters
    ----------
    condensed : Condensed or None
        At the main point.
    further : mapping of str to Condensed, optional
        At further points, by name.
    coupled : Coupled, optional
        Of several points, for the terms between them; what these are related to comes along
        (:attr:`Quantity.repeats`).
    known : sequence of Quantity
        Those that are measured away from the main point: there `ACROSS` is left out unless asked for.
    """
    out = _measured(condensed, modes, (*QUANTITIES, *ACROSS))
    for point, there in (further or {}).items():
        own = _measured(there, None, known)
        out |= {name.at(point): value for name, value in own.items()}
    return out | (_between(coupled, known) if coupled is not None else {})


def _between(coupled: Coupled, known: Iterable[Quantity]) -> dict[Quantity, float]:
    """Terms between points, and what they are related to."""
    names = [name for name in known if not name.is_frequency]
    own = [name.at(a, a) for a in coupled.ports for name in names]
    # those of the diagonal first: a term of motions that nothing resists is no number
    out: dict[Quantity, float] = {}
    for name in sorted(
        dict.fromkeys((*own, *between(names, coupled.ports))),
        key=lambda q: q.diagonals is not None,
    ):
        one, other = name.points
        value = float(name.of(coupled.between(one, other, name.kind)))
        pair = name.diagonals
        there = value > 0.0 if pair is None else all(d in out for d in pair)
        if np.isfinite(value) and there:
            out[name] = value
    return out


def _measured(
    condensed: Condensed | None, modes: ModeSet | None, names: Iterable[Quantity]
) -> dict[Quantity, float]:
    out = {}
    for name in names:
        value = np.nan
        if name.is_frequency:
            mode = modes.named(name) if modes is not None else None
            value = mode.frequency_hz if mode else np.nan
        elif condensed is not None:
            value = name.of(getattr(condensed, name.kind))
        if np.isfinite(value) and (value != 0.0 or name.is_coupling):
            out[name] = float(value)
    # a coupling of motions that nothing resists is no number
    return {name: v for name, v in out.items() if all(d in out for d in name.diagonals or ())}


def size(values: Mapping[str, float] | Values, name: str) -> float:
    """Scale that errors of a quantity are relative to: of couplings the geometric mean of their
    diagonal entries, of all else the value itself.
    """
    name = Quantity(name)
    pair = name.diagonals
    if pair is not None and all(one in values for one in pair):
        return float((values[pair[0]] * values[pair[1]]) ** 0.5)
    return abs(values[name])


def change(
    new: Mapping[str, float] | Values, old: Mapping[str, float] | Values, name: str
) -> float | None:
    """Relative change of one quantity, or None where either lacks it; rounding (below 1e-11) counts
    as none.

    Couplings are related to the geometric mean of their diagonal entries, all else to the old value.
    """
    name = Quantity(name)
    if name not in new or name not in old:
        return None
    scale = size(old, name)
    if scale == 0.0:
        return 0.0 if new[name] == 0.0 else None
    relative = (new[name] - old[name]) / scale
    return relative if abs(relative) > 1e-11 else 0.0
