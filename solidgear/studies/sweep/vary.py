"""Varied fields of a sweep: ``bearing.NAME.FIELD=SPEC`` texts, their full product or a Latin
hypercube.

``bearing.NAME.housing.FIELD=SPEC`` varies an entry of the housing of one bearing,
``housing.FIELD=SPEC`` one of the housing of all, or its ``axial`` spring: entries of motions that
the scene gives a stiffness for (what is rigid cannot be varied), couplings between them, or
``scale``.

FIELD of a bearing is ``position`` (middle of the seat from y = 0, whatever the datum in the scene file), an
entry of the bearing's own 6x6 as in scene files (``kxx``, ``kx_thz``, ...), or ``scale`` (a factor
on the whole bearing, series springs included, after its entries). SPEC is ``a:b:n`` (n values,
evenly), ``log:a:b:n`` (n values, geometrically) or a list ``a,b,c``; a value is a text with a unit
or a plain SI number.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.errors import SceneError, SolidgearError, nearest
from solidgear.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.scene.units import POSITION_DECIMALS, quantity

if TYPE_CHECKING:
    from solidgear.scene import Elastic, Scene

FIELDS = ("position", "scale", *STIFFNESS_NAMES)
#: how a housing is called in what is given
HOUSING = "housing"
#: More variants than this are a slip of the keyboard.
MOST = 10_000_000


@dataclass(frozen=True, kw_only=True)
class Span:
    """Values of something that varies.

    Attributes
    ----------
    label : str
        Name of its column, such as ``bearing.2.kxx``.
    spacing : {'linear', 'log', 'list'}
        How values between the listed ones are drawn: along a line, along its logarithm, or not at
        all.
    """

    label: str
    values: tuple[float, ...]
    spacing: str

    @property
    def only_listed(self) -> bool:
        """True where no values but the listed ones are drawn."""
        return self.spacing == "list"

    def draw(self, u: np.ndarray) -> np.ndarray:
        """Values for numbers between 0 and 1."""
        if self.only_listed:
            return np.array(self.values)[
                np.minimum((u * len(self.values)).astype(int), len(self.values) - 1)
            ]
        a, b = self.values[0], self.values[-1]
        return a + (b - a) * u if self.spacing == "linear" else a * (b / a) ** u


@dataclass(frozen=True, kw_only=True)
class Axis(Span):
    """One varied quantity of bearings or housings, in SI.

    Attributes
    ----------
    bearing : int or None
        Place of the bearing in the scene; None for the housing of all.
    housed : bool
        Whether it is of a housing: that of the bearing, or of all.
    field : str
        One of `FIELDS`, or ``axial`` of the housing of all.
    """

    bearing: int | None
    housed: bool
    field: str

    @property
    def place(self) -> tuple[int | None, bool]:
        """Owner of the field: a bearing, its housing, or that of all."""
        return self.bearing, self.housed

    @property
    def seat(self) -> int:
        """Place of the bearing whose position or own stiffness varies."""
        if self.bearing is None:
            raise TypeError(f"{self.label} is of no bearing")
        return self.bearing

    @property
    def only_listed(self) -> bool:
        """Positions as well, because every seat is meshed."""
        return super().only_listed or self.field == "position"


#: an entry of a bearing's own 6x6 as the file has it
_IN_FILE = re.compile(r"(bearing\..+|bearing)\.stiffness\.(k\w+)")


def of_bearings_alone(texts: Iterable[str]) -> list[str] | None:
    """Texts that vary springs and positions of bearings alone, in the words of :func:`axes`; None
    where one of them varies something else.

    Examples
    --------
    >>> of_bearings_alone(["bearing.A.stiffness.kxx=1e8,2e8", "housing.kzz=1e8,2e8"])
    ['bearing.A.kxx=1e8,2e8', 'housing.kzz=1e8,2e8']
    >>> of_bearings_alone(["segment.neck.diameter=30 mm,40 mm"]) is None
    True
    """
    out = []
    for text in texts:
        target, equals, spec = text.partition("=")
        target = _IN_FILE.sub(r"\1.\2", target.strip())
        head, _, field = target.rpartition(".")
        of_them = head == HOUSING or head.startswith("bearing.")
        if not of_them or field not in (*FIELDS, "axial"):
            return None
        out.append(f"{target}{equals}{spec}")
    return out


def axes(scene: Scene, texts: Iterable[str]) -> tuple[Axis, ...]:
    """Read all ``--vary`` texts of a sweep.

    Raises
    ------
    SolidgearError
        A text that cannot be read, a bearing or field that is not there, or the same quantity
        twice.
    """
    out: list[Axis] = []
    for text in texts:
        axis = _axis(scene, text)
        if any(a.place == axis.place and a.field == axis.field for a in out):
            raise SolidgearError(
                f"--vary {text}: {axis.label} is varied already; give all its values in one list"
            )
        out.append(axis)
    if not out:
        raise SolidgearError(
            'nothing is varied; give for example --vary "bearing.1.kxx=log:1e8 N/m:1e10 N/m:9"'
        )
    return tuple(out)


def product(axes: Sequence[Span]) -> np.ndarray:
    """(variants, axes) all combinations, the last axis running fastest."""
    total = int(np.prod([float(len(a.values)) for a in axes]))
    if total > MOST:
        raise SolidgearError(
            f"{total} variants are more than the {MOST} a sweep takes; use fewer values, or draw some with --sample"
        )
    return np.array(list(itertools.product(*(a.values for a in axes))), float)


def sample(axes: Sequence[Span], count: int, seed: int) -> np.ndarray:
    """(count, axes) a Latin hypercube over the ranges of the axes."""
    if not 1 <= count <= MOST:
        raise SolidgearError(f"--sample {count}: give a whole number from 1 to {MOST}")
    if seed < 0:
        raise SolidgearError(f"--seed {seed}: must not be negative")
    from scipy.stats import qmc

    u = qmc.LatinHypercube(d=len(axes), seed=seed).random(count)
    return np.column_stack([axis.draw(u[:, k]) for k, axis in enumerate(axes)])


def _axis(scene: Scene, text: str) -> Axis:
    target, equals, spec = text.partition("=")
    head, _, field = target.strip().rpartition(".")
    word, _, name = head.partition(".")
    if equals and head == HOUSING:
        return _of_the_housing(scene, text, field, spec)
    if not equals or word != "bearing" or not name:
        raise SolidgearError(
            f'--vary {text}: write bearing.NAME.FIELD=VALUES, such as "bearing.2.position=0.2 m:0.3 m:11"'
        )
    names = [b.name for b in scene.bearings]
    housed = name not in names and name.endswith(f".{HOUSING}")
    name = name.removesuffix(f".{HOUSING}") if housed else name
    if name in names:
        index = names.index(name)
    elif name.isdecimal() and 1 <= int(name) <= len(names):
        index = int(name) - 1
    else:
        raise SolidgearError(
            f"--vary {text}: there is no bearing {name!r}{nearest(name, names)}; the scene has "
            f"{', '.join(names) or 'none'}"
        )
    if housed:
        return _of_one_housing(scene, text, index, field, spec)
    if field == HOUSING:
        raise SolidgearError(
            f"--vary {text}: says nothing of what varies in the housing; write for example "
            f'"bearing.{names[index]}.{field}.kzz=log:1e8 N/m:1e10 N/m:9"'
        )
    if field not in FIELDS:
        raise SolidgearError(
            f"--vary {text}: unknown field {field!r}{nearest(field, FIELDS)}; valid are {', '.join(FIELDS)}"
        )
    return _read(text, (index, False), field, f"bearing.{names[index]}.{field}", spec)


def _of_one_housing(scene: Scene, text: str, index: int, field: str, spec: str) -> Axis:
    bearing = scene.bearings[index]
    if bearing.housing is None:
        raise SolidgearError(
            f"--vary {text}: bearing {bearing.name!r} stands in no housing of its own; "
            "give it one in the scene, with the entries that are to vary"
        )
    _refuse_rigid(text, field, _varied_of(bearing.housing), f"the housing of {bearing.name!r}")
    label = f"bearing.{bearing.name}.{HOUSING}.{field}"
    return _read(text, (index, True), field, label, spec)


def _of_the_housing(scene: Scene, text: str, field: str, spec: str) -> Axis:
    if scene.housing is None and not scene.housing_axial:
        raise SolidgearError(
            f"--vary {text}: the scene has no [housing]; give it one, with the entries that are to vary"
        )
    known = ("axial",) if scene.housing is None else _varied_of(scene.housing)
    _refuse_rigid(text, field, known, "its housing")
    return _read(text, (None, True), field, f"{HOUSING}.{field}", spec)


def _varied_of(housing: Elastic) -> tuple[str, ...]:
    """Fields of a housing that can be varied: entries of motions in which it gives, and all
    together.
    """
    gives = {name: {i, j} <= set(housing.gives) for name, (i, j, _) in STIFFNESS_NAMES.items()}
    return (*(name for name, varied in gives.items() if varied), "scale")


def _refuse_rigid(text: str, field: str, known: Sequence[str], what: str) -> None:
    if field in known:
        return
    valid = (*STIFFNESS_NAMES, "scale")
    if field not in valid:
        raise SolidgearError(
            f"--vary {text}: unknown field {field!r} of a housing{nearest(field, known)}; "
            f"valid are {', '.join(known)}"
        )
    raise SolidgearError(
        f"--vary {text}: the scene gives {what} no {field}, and what is rigid cannot be varied; "
        f"it has {', '.join(known)}"
    )


def _read(text: str, place: tuple[int | None, bool], field: str, label: str, spec: str) -> Axis:
    of_its_own = {"position": "length", "scale": "dimensionless", "axial": "force_per_length"}
    dimension = of_its_own.get(field) or STIFFNESS_NAMES[field][2]
    try:
        values, spacing = spread(spec, lambda one: quantity(plain_number(one.strip()), dimension))
    except SceneError as error:
        raise SolidgearError(f"--vary {text}: {error}") from None
    if field == "position":
        values = [round(v, POSITION_DECIMALS) + 0.0 for v in values]
    different = tuple(dict.fromkeys(values))  # the same value twice would be the same row twice
    bearing, housed = place
    return Axis(
        label=label, values=different, spacing=spacing, bearing=bearing, housed=housed, field=field
    )


def spread(spec: str, read: Callable[[str], float]) -> tuple[list[float], str]:
    """Values of a text ``a:b:n``, ``log:a:b:n`` or ``a,b,c``, and their spacing.

    Parameters
    ----------
    read : callable
        Value of one number.

    Raises
    ------
    SceneError
        For another text; as `read`.
    """
    spacing, parts = "linear", [part.strip() for part in spec.split(":")]
    if parts[0] == "log":
        spacing, parts = "log", parts[1:]
    if len(parts) == 1 and spacing == "linear":
        return [float(read(part)) for part in spec.split(",")], "list"
    if len(parts) != 3:
        raise SceneError('values are "a:b:n", "log:a:b:n" or a list "a,b,c"')
    a, b = (read(part) for part in parts[:2])
    if not parts[2].isdecimal() or not 2 <= int(parts[2]) <= MOST:
        raise SceneError(f"a:b:n needs a whole number n of 2 or more values, not {parts[2]!r}")
    if spacing == "log" and not a * b > 0:
        raise SceneError("a logarithmic range needs both ends above zero")
    return (np.linspace if spacing == "linear" else np.geomspace)(
        a, b, int(parts[2])
    ).tolist(), spacing


def plain_number(text: str) -> str | float:
    """A number where a text is one, else the text."""
    try:
        return float(text)
    except ValueError:
        return text
