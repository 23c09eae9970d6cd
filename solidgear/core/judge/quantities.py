"""Compared numbers: by which of them a scene is judged, and how they are measured in results."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.quantity import ACROSS, COMPLIANCE, FIRST_BENDING, QUANTITIES, Quantity
from solidgear.core.scene.rules import no_such_point, no_term
from solidgear.core.solve.condensed import Condensed, Coupled
from solidgear.core.solve.modes import ModeSet

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

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
    """Return a quantity with points in words; the main one is named where there are several.

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
    """Return static quantities between some points; of stiffnesses the diagonal too, for it bounds
    all of them.

    Examples
    --------
    >>> between([Quantity("C_zz"), Quantity("C_z,thx"), Quantity("bending 1")], ["a", "b"])
    ('C_zz@a@b', 'C_z,thx@a@b', 'C_z,thx@b@a')
    """
    of_points = [name for name in names if not name.is_frequency]
    crossed = (
        name.at(*pair)
        for a, b in combinations_with_replacement(points, 2)
        for name in of_points
        for pair in ([(a, b), (b, a)] if name.is_coupling and a != b else [(a, b)])
    )
    return tuple(name for name in crossed if not name.repeats)


def at_points(names: Iterable[Quantity], points: Iterable[str]) -> tuple[Quantity, ...]:
    """Return quantities at the main point, and the static ones among them at further points.

    Examples
    --------
    >>> at_points([Quantity("C_zz"), Quantity("bending 1")], ["pinion"])
    ('C_zz', 'bending 1', 'C_zz@pinion')
    """
    names = tuple(names)
    of_points = [name for name in names if not name.is_frequency]
    return (*names, *(name.at(point) for point in points for name in of_points))


def usual(scene: Scene) -> tuple[Quantity, ...]:
    """Return the quantities that models are judged by unless a scene says otherwise: at all points,
    and frequencies alone without any.
    """
    names = JUDGED if scene.ports else [name for name in JUDGED if name.is_frequency]
    return at_points(names, (port.name for port in scene.further_ports))


def judged(scene: Scene) -> tuple[Quantity, ...]:
    """Return the quantities that the models of a scene are judged by."""
    return tuple(canonical_name(scene, name) for name in scene.ask.quantities) or usual(scene)


def canonical_name(scene: Scene, name: Quantity) -> Quantity:
    """Return a quantity under the name that results use: at the main point without a suffix, and
    points in the order of the scene where it does not matter; SolidgearError if the scene has no
    such point, or for a stiffness between points.
    """
    if name.is_frequency:
        return name
    ports = [scene.port.name, *(port.name for port in scene.further_ports)]
    points = list(name.points_among(ports))
    for name_of_point in points:
        if name_of_point not in ports:
            raise SolidgearError(f"{name}: {no_such_point(name_of_point, ports)}")
    if reason := no_term(name, points):
        raise SolidgearError(f"{name}: {reason}")
    if len(set(points)) < 2:
        return name.at(*(point for point in points[:1] if point != ports[0]))
    if not name.is_coupling:
        points.sort(key=ports.index)
    return name.at(*points)


def in_order(names: Iterable[Quantity]) -> list[Quantity]:
    """Return names in the order of lists: at the main point as in `QUANTITIES` and `ACROSS`, then
    at further points and between points; without those that only repeat another.
    """
    names = list(names)
    further = (q for q in names if q.points and not q.repeats)
    return [*(q for q in (*QUANTITIES, *ACROSS) if q in names), *further]


def measure(
    condensed: Condensed | None,
    modes: ModeSet | None,
    further: Mapping[str, Condensed] | None = None,
    coupled: Coupled | None = None,
    names: Sequence[Quantity] = QUANTITIES,
) -> dict[Quantity, float]:
    """Measure the compared numbers of one solution at the main point, at further ones by name, and
    between several, the terms that these are related to included (:attr:`Quantity.repeats`); those
    that do not exist (free motions, missing modes) or were not solved (None) are left out.

    `names` are those measured away from the main point: there `ACROSS` is left out unless asked
    for.
    """
    out = _measured(condensed, modes, (*QUANTITIES, *ACROSS))
    for point, condensed_point in (further or {}).items():
        values = _measured(condensed_point, None, names)
        out |= {name.at(point): value for name, value in values.items()}
    return out | (_between(coupled, names) if coupled is not None else {})


def _between(coupled: Coupled, wanted: Iterable[Quantity]) -> dict[Quantity, float]:
    """Measure terms between points, and the diagonal terms that they are related to."""
    names = [name for name in wanted if not name.is_frequency]
    diagonal = [name.at(a, a) for a in coupled.ports for name in names]
    # those of the diagonal first: a term of motions that nothing resists is no number
    out: dict[Quantity, float] = {}
    for name in sorted(
        dict.fromkeys((*diagonal, *between(names, coupled.ports))),
        key=lambda q: q.diagonals is not None,
    ):
        first, second = name.points
        value = float(name.of(coupled.between(first, second, name.kind)))
        pair = name.diagonals
        exists = value > 0.0 if pair is None else all(d in out for d in pair)
        if np.isfinite(value) and exists:
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
    """Return the scale that errors of a quantity are relative to: of couplings the geometric mean
    of their diagonal entries, of all else the value itself.
    """
    name = Quantity(name)
    pair = name.diagonals
    if pair is not None and all(diagonal in values for diagonal in pair):
        return float((values[pair[0]] * values[pair[1]]) ** 0.5)
    return abs(values[name])


def change(
    new: Mapping[str, float] | Values, old: Mapping[str, float] | Values, name: str
) -> float | None:
    """Compute the relative change of one quantity, or None where either lacks it; rounding (below
    1e-11) counts as none.

    Couplings are related to the geometric mean of their diagonal entries, all else to the old
    value.
    """
    name = Quantity(name)
    if name not in new or name not in old:
        return None
    scale = size(old, name)
    if scale == 0.0:
        return 0.0 if new[name] == 0.0 else None
    relative = (new[name] - old[name]) / scale
    return relative if abs(relative) > 1e-11 else 0.0
