"""The handful of numbers by which models are compared, and where they are found in results.

Numbers of the main lumped point have plain names, those of further points have the point's behind
an ``@``: ``C_zz@pinion``. Terms between points have both: ``C_z,thx@wheel@pinion`` is the motion z
of the wheel under a moment thx on the pinion. Of a stiffness between points the others are held, so
that its own diagonal, ``K_zz@wheel@wheel``, is not the stiffness of one point alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.scene.rules import AT, no_such_point, no_term
from solidgear.solve.condensed import Condensed, Coupled
from solidgear.solve.modes import ModeSet

if TYPE_CHECKING:
    from solidgear.scene import Scene

# name -> (kind, place, unit); compliances first: they are what a change of tie or model moves least
# by accident.  The place is an entry of a matrix, or the name of a mode.
QUANTITIES: dict[str, tuple[str, tuple[int, int] | str, str]] = {
    "C_zz": ("compliance", (2, 2), "m/N"),
    "C_z,thx": ("compliance", (2, 3), "rad/N"),
    "C_thx": ("compliance", (3, 3), "rad/(N m)"),
    "C_yy": ("compliance", (1, 1), "m/N"),
    "K_zz": ("stiffness", (2, 2), "N/m"),
    "K_z,thx": ("stiffness", (2, 3), "N/rad"),
    "K_thx": ("stiffness", (3, 3), "N m/rad"),
    "K_yy": ("stiffness", (1, 1), "N/m"),
    "bending 1": ("frequency", "bending 1", "Hz"),
    "bending 2": ("frequency", "bending 2", "Hz"),
    "axial 1": ("frequency", "axial 1", "Hz"),
    "torsion 1": ("frequency", "torsion 1", "Hz"),
}

#: The other plane and torsion, which differ where bearings or features do: measured at the main
#: point, given where they are asked for, and no part of what models are judged by.
ACROSS: dict[str, tuple[str, tuple[int, int] | str, str]] = {
    "C_xx": ("compliance", (0, 0), "m/N"),
    "C_x,thz": ("compliance", (0, 5), "rad/N"),
    "C_thz": ("compliance", (5, 5), "rad/(N m)"),
    "C_thy": ("compliance", (4, 4), "rad/(N m)"),
    "K_xx": ("stiffness", (0, 0), "N/m"),
    "K_x,thz": ("stiffness", (0, 5), "N/rad"),
    "K_thz": ("stiffness", (5, 5), "N m/rad"),
    "K_thy": ("stiffness", (4, 4), "N m/rad"),
}

#: a coupling passes through zero where symmetry wants it to: it is related to the geometric mean
#: of these two
COUPLINGS = {
    "C_z,thx": ("C_zz", "C_thx"),
    "K_z,thx": ("K_zz", "K_thx"),
    "C_x,thz": ("C_xx", "C_thz"),
    "K_x,thz": ("K_xx", "K_thz"),
}

#: What models are judged by: compliances and the frequencies a gear designer reads.  Stiffnesses
#: follow from compliances and are shown, not judged: inverting spreads a small change of one entry
#: over all of them.
JUDGED = ("C_zz", "C_z,thx", "C_thx", "C_yy", "bending 1", "axial 1")


def described(name: str) -> tuple[str, tuple[int, int] | str, str]:
    """Kind, place and unit of a quantity at whatever point.

    Parameters
    ----------
    name : str

    Examples
    --------
    >>> described("C_zz@pinion")
    ('compliance', (2, 2), 'm/N')
    """
    base = name.partition(AT)[0]
    return ACROSS[base] if base in ACROSS else QUANTITIES[base]


def diagonals(name: str) -> tuple[str, str] | None:
    """The two entries of the diagonal that a coupling stands between; None of all else.

    Parameters
    ----------
    name : str

    Examples
    --------
    >>> diagonals("C_z,thx@pinion")
    ('C_zz@pinion', 'C_thx@pinion')
    >>> diagonals("C_zz@wheel@pinion")
    ('C_zz@wheel@wheel', 'C_zz@pinion@pinion')
    """
    base, at, point = name.partition(AT)
    pair = points_of(name)
    if pair is None and base in COUPLINGS:
        one, two = COUPLINGS[base]
        return f"{one}{at}{point}", f"{two}{at}{point}"
    if pair is None or base not in COUPLINGS and pair[0] == pair[1]:
        return None
    one, two = COUPLINGS.get(base, (base, base))
    a, b = pair
    return f"{one}{AT}{a}{AT}{a}", f"{two}{AT}{b}{AT}{b}"


def points_of(name: str) -> tuple[str, str] | None:
    """The two points of a term between points: of the motion (of a stiffness: the load) and of the
    load (the motion); None of all else.

    Parameters
    ----------
    name : str

    Examples
    --------
    >>> points_of("C_zz@wheel@pinion"), points_of("C_zz@pinion")
    (('wheel', 'pinion'), None)
    """
    parts = name.split(AT)
    return (parts[1], parts[2]) if len(parts) == 3 else None


def in_words(quantity: str, main: str) -> str:
    """A quantity with its points in words.

    Parameters
    ----------
    quantity : str
    main : str
        Name of the main point where there are several, else nothing.

    Examples
    --------
    >>> in_words("C_zz", "wheel"), in_words("C_zz@wheel@pinion", "wheel")
    ('C_zz at wheel', 'C_zz between wheel and pinion')
    """
    name, _, point = quantity.partition(AT)
    pair = points_of(quantity)
    if pair is not None and pair[0] == pair[1]:
        return f"{name} at {pair[0]} with the other points held"
    if pair is not None:
        return f"{name} between {pair[0]} and {pair[1]}"
    if not main or name[:2] not in ("C_", "K_"):
        return quantity
    return f"{name} at {point or main}"


def repeats(name: str) -> bool:
    """Whether a quantity is another one over again: a compliance "between" a point and itself,
    which stands there to relate others to.

    Parameters
    ----------
    name : str

    Examples
    --------
    >>> repeats("C_zz@wheel@wheel"), repeats("K_zz@wheel@wheel")
    (True, False)
    """
    pair = points_of(name)
    return pair is not None and pair[0] == pair[1] and name.startswith("C_")


def between(names: Iterable[str], points: Sequence[str]) -> tuple[str, ...]:
    """Terms between some points of quantities that are of a point; of stiffnesses the diagonal too,
    for it holds all of them.

    Parameters
    ----------
    names : iterable of str
        Of the main point.
    points : sequence of str
        In the order of the scene.

    Examples
    --------
    >>> between(["C_zz", "C_z,thx", "bending 1"], ["a", "b"])
    ('C_zz@a@b', 'C_z,thx@a@b', 'C_z,thx@b@a')
    """
    of_points = [name for name in names if not isinstance(described(name)[1], str)]
    found = (
        f"{name}{AT}{one}{AT}{other}"
        for a, b in combinations_with_replacement(points, 2)
        for name in of_points
        for one, other in ([(a, b), (b, a)] if name in COUPLINGS and a != b else [(a, b)])
    )
    return tuple(name for name in found if not repeats(name))


def at_points(names: Iterable[str], points: Iterable[str]) -> tuple[str, ...]:
    """Quantities at the main point, and those of them that are of a point at further ones.

    Parameters
    ----------
    names, points : iterable of str

    Examples
    --------
    >>> at_points(["C_zz", "bending 1"], ["pinion"])
    ('C_zz', 'bending 1', 'C_zz@pinion')
    """
    names = tuple(names)
    of_points = [name for name in names if not isinstance(QUANTITIES[name][1], str)]
    return (*names, *(f"{name}{AT}{point}" for point in points for name in of_points))


def usual(scene: Scene) -> tuple[str, ...]:
    """What models are judged by unless a scene says otherwise: at all of its points."""
    return at_points(JUDGED, (port.name for port in scene.further_ports))


def judged(scene: Scene) -> tuple[str, ...]:
    """What the models of a scene are judged by."""
    return tuple(own_name(scene, name) for name in scene.ask.quantities) or usual(scene)


def own_name(scene: Scene, name: str) -> str:
    """A quantity as results call it: that of the main point has no name behind it, and points stand
    in the order of the scene where it does not matter.

    Raises
    ------
    SolidgearError
        If the scene has no such point, or for a stiffness between points.
    """
    base, at, point = name.partition(AT)
    known = [port.name for port in scene.ports]
    asked = [point] if not at or point in known else point.split(AT)
    for one in asked if at else ():
        if one not in known:
            raise SolidgearError(f"{name}: {no_such_point(one, known)}")
    reason = "" if len(asked) == 1 else no_term(base, asked)
    if reason:
        raise SolidgearError(f"{name}: {reason}")
    if len(set(asked)) == 1:
        return base if asked[0] in ("", known[0]) else f"{base}{AT}{asked[0]}"
    if base not in COUPLINGS:
        asked.sort(key=known.index)
    return AT.join([base, *asked])


def in_order(names: Iterable[str]) -> list[str]:
    """Names as they are listed: of the main point as in `QUANTITIES` and `ACROSS`, then those of
    further ones and between points; without those that only repeat another.
    """
    names = list(names)
    further = (q for q in names if AT in q and not repeats(q))
    return [*(q for q in (*QUANTITIES, *ACROSS) if q in names), *further]


def measure(
    condensed: Condensed | None,
    modes: ModeSet | None,
    further: Mapping[str, Condensed] | None = None,
    coupled: Coupled | None = None,
) -> dict[str, float]:
    """The compared numbers of one solution; those that do not exist (free motions, missing modes)
    or were not solved (None) are left out.

    Parameters
    ----------
    condensed : Condensed or None
        At the main point.
    modes : ModeSet or None
    further : mapping of str to Condensed, optional
        At further points, by name.
    coupled : Coupled, optional
        Of several points, for the terms between them; what these are related to comes along
        (:func:`repeats`).
    """
    out = _measured(condensed, modes, QUANTITIES | ACROSS)
    for point, there in (further or {}).items():
        out |= {
            f"{name}{AT}{point}": value
            for name, value in _measured(there, None, QUANTITIES).items()
        }
    return out | (_between(coupled) if coupled is not None else {})


def measure_across(
    further: Mapping[str, Condensed], coupled: Coupled | None = None
) -> dict[str, float]:
    """The numbers of the other bending plane and of torsion (`ACROSS`) away from the main point, where
    :func:`measure` has them.

    Parameters
    ----------
    further : mapping of str to Condensed
        At further points, by name.
    coupled : Coupled, optional
        Of several points.
    """
    out = {
        f"{name}{AT}{point}": value
        for point, there in further.items()
        for name, value in _measured(there, None, ACROSS).items()
    }
    return out | (_between(coupled, ACROSS) if coupled is not None else {})


def _between(coupled: Coupled, known: Iterable[str] = QUANTITIES) -> dict[str, float]:
    """Terms between points, and what they are related to."""
    names = [name for name in known if name.startswith(("C_", "K_"))]
    own = [f"{name}{AT}{a}{AT}{a}" for a in coupled.ports for name in names]
    # those of the diagonal first: a term of motions that nothing resists is no number
    out: dict[str, float] = {}
    for name in sorted(
        dict.fromkeys((*own, *between(names, coupled.ports))),
        key=lambda q: diagonals(q) is not None,
    ):
        kind, place, _ = described(name)
        _, one, other = name.split(AT)
        value = float(coupled.between(one, other, kind)[place])
        pair = diagonals(name)
        there = value > 0.0 if pair is None else all(d in out for d in pair)
        if np.isfinite(value) and there:
            out[name] = value
    return out


def _measured(
    condensed: Condensed | None, modes: ModeSet | None, names: Iterable[str]
) -> dict[str, float]:
    out = {}
    for name in names:
        kind, place, _ = described(name)
        value = np.nan
        if isinstance(place, str):
            mode = modes.named(place) if modes is not None else None
            value = mode.frequency_hz if mode else np.nan
        elif condensed is not None:
            value = getattr(condensed, kind)[place]
        if np.isfinite(value) and (value != 0.0 or name in COUPLINGS):
            out[name] = float(value)
    # a coupling of motions that nothing resists is no number
    return {name: v for name, v in out.items() if all(d in out for d in COUPLINGS.get(name, ()))}


def size(values: Mapping[str, float], name: str) -> float:
    """What errors of a quantity are relative to: of couplings the geometric mean of their diagonal
    entries (`COUPLINGS`), of all else the value itself.
    """
    pair = diagonals(name)
    if pair is not None and all(one in values for one in pair):
        return float((values[pair[0]] * values[pair[1]]) ** 0.5)
    return abs(values[name])


def change(new: Mapping[str, float], old: Mapping[str, float], name: str) -> float | None:
    """Relative change of one quantity, or None where either lacks it; rounding (below 1e-11) counts
    as none.

    Couplings are related to the geometric mean of their diagonal entries (`COUPLINGS`), all else to
    the old value.
    """
    if name not in new or name not in old:
        return None
    scale = size(old, name)
    if scale == 0.0:
        return 0.0 if new[name] == 0.0 else None
    relative = (new[name] - old[name]) / scale
    return relative if abs(relative) > 1e-11 else 0.0
