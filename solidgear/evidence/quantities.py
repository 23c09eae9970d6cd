"""The handful of numbers by which models are compared, and where they are found in results.

Numbers of the main lumped point have plain names, those of further points have the point's behind
an ``@``: ``C_zz@pinion``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.scene.ask import AT
from solidgear.scene.rules import no_such_point
from solidgear.solve.condensed import Condensed
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


#: a coupling passes through zero where symmetry wants it to: it is related to the geometric mean
#: of these two
COUPLINGS = {"C_z,thx": ("C_zz", "C_thx"), "K_z,thx": ("K_zz", "K_thx")}

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
    return QUANTITIES[name.partition(AT)[0]]


def diagonals(name: str) -> tuple[str, str] | None:
    """The two entries of the diagonal that a coupling stands between; None of all else.

    Parameters
    ----------
    name : str

    Examples
    --------
    >>> diagonals("C_z,thx@pinion")
    ('C_zz@pinion', 'C_thx@pinion')
    """
    base, at, point = name.partition(AT)
    if base not in COUPLINGS:
        return None
    one, two = COUPLINGS[base]
    return f"{one}{at}{point}", f"{two}{at}{point}"


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
    """A quantity as results call it: that of the main point has no name behind it.

    Raises
    ------
    SolidgearError
        If the scene has no such point.
    """
    base, at, point = name.partition(AT)
    known = [port.name for port in scene.ports]
    if at and point not in known:
        raise SolidgearError(f"{name}: {no_such_point(point, known)}")
    return base if point == known[0] else name


def in_order(names: Iterable[str]) -> list[str]:
    """Names as they are listed: of the main point as in `QUANTITIES`, then those of further ones."""
    names = list(names)
    return [*(q for q in QUANTITIES if q in names), *(q for q in names if AT in q)]


def measure(
    condensed: Condensed | None,
    modes: ModeSet | None,
    further: Mapping[str, Condensed] | None = None,
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
    """
    out = _measured(condensed, modes)
    for point, there in (further or {}).items():
        out |= {f"{name}{AT}{point}": value for name, value in _measured(there, None).items()}
    return out


def _measured(condensed: Condensed | None, modes: ModeSet | None) -> dict[str, float]:
    out = {}
    for name, (kind, place, _) in QUANTITIES.items():
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
