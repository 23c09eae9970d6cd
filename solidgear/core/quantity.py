"""Numbers by which models are compared, by name.

An entry of a compliance (``C_``) or stiffness (``K_``) is named by row and column: ``C_zz``,
``C_thx``, ``K_z,thx``. At the main lumped point that is all; at a further one its name follows an
``@``: ``C_zz@pinion``. Terms between points have both: ``C_z,thx@wheel@pinion`` is the motion z of
the wheel under a moment thx on the pinion. In a stiffness between points all other motions are held,
so that the diagonal ``K_zz@wheel@wheel`` is not the stiffness of one point alone. Any other text is
the name of a mode, and means the natural frequency of that mode.

To add one: its name in ``QUANTITIES`` (judged and shown) or ``ACROSS`` (on request).  One that is no
single entry says itself what it is ``of`` a matrix, its ``loads``, ``unit`` and ``diagonals``, and
has error bars like the others.  Judged frequencies have error bars on every page that lists modes,
so that documented consoles are written anew.  One with a number that each user gives is no line
here: ``scene/ask.py``, ``judge/answer.py`` and ``judge/quantities.py`` know quantities by that list.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any, overload

from solidgear.core.frames import DOF_NAMES

if TYPE_CHECKING:
    import numpy as np

AT = "@"
COMPLIANCE, STIFFNESS, FREQUENCY = "compliance", "stiffness", "frequency"
_KINDS = {"C": COMPLIANCE, "K": STIFFNESS}
#: kind -> unit of the blocks (translation, translation), (mixed), (rotation, rotation)
BLOCK_UNITS = {
    STIFFNESS: ("N/m", "N/rad", "N m/rad"),
    COMPLIANCE: ("m/N", "rad/N", "rad/(N m)"),
}
#: entries of the diagonal, and of all of a matrix with their places
_DIAGONAL = ("xx", "yy", "zz", *DOF_NAMES[3:])
_PLACES = {f"{a},{b}": (i, j) for i, a in enumerate(DOF_NAMES) for j, b in enumerate(DOF_NAMES)}
_PLACES |= {name: (k, k) for k, name in enumerate(_DIAGONAL)}


class Name(str):
    """A text with its parts as attributes; users, tables and JSON go on reading the text."""

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema  # slow to import, and only records need it

        return core_schema.no_info_after_validator_function(cls, core_schema.str_schema())


class Quantity(Name):
    """A number by which models are compared.

    Examples
    --------
    >>> name = Quantity("C_z,thx@wheel@pinion")
    >>> name.kind, name.row, name.column, name.points, name.unit
    ('compliance', 2, 3, ('wheel', 'pinion'), 'rad/N')
    >>> name == "C_z,thx@wheel@pinion", Quantity("bending 1").kind
    (True, 'frequency')
    """

    symbol: str  #: the name without points
    kind: str
    #: row, column: place in the 6x6, in the order of :data:`~solidgear.core.frames.DOF_NAMES`; None of
    #: frequencies
    row: int | None
    column: int | None
    #: names of lumped points, of the motion (of a stiffness: the load) and of the load (the
    #: motion); one where both are the same, none at the main point
    points: tuple[str, ...]

    def __new__(cls, text: str) -> Quantity:
        if isinstance(text, Quantity):
            return text
        self = super().__new__(cls, text)
        self.symbol, *points = text.split(AT)
        letter, _, entry = self.symbol.partition("_")
        is_entry = letter in _KINDS and entry in _PLACES
        self.kind = _KINDS[letter] if is_entry else FREQUENCY
        self.row, self.column = _PLACES[entry] if is_entry else (None, None)
        self.points = tuple(points)
        return self

    @property
    def is_frequency(self) -> bool:
        """True for the natural frequency of a mode."""
        return self.kind == FREQUENCY

    @property
    def place(self) -> tuple[int, int]:
        """Row and column of an entry of a matrix."""
        assert self.row is not None and self.column is not None, (
            f"{self} is not an entry of a matrix"
        )
        return self.row, self.column

    @overload
    def of(self, matrix: np.ndarray) -> float: ...

    @overload
    def of(self, matrix: Sequence[Sequence[float | None]]) -> float | None: ...

    def of(self, matrix: Any) -> float | None:
        """Return the entry of a (6, 6) matrix of this kind; None where the matrix has none there.

        Examples
        --------
        >>> Quantity("C_z,thx").of([[10 * i + j for j in range(6)] for i in range(6)])
        23
        """
        row, column = self.place
        return matrix[row][column]

    @property
    def loads(self) -> tuple[tuple[float, ...], ...]:
        """Unit loads (6,) on the point of the motion and on that of the load, which the energy is of."""
        return tuple(tuple(float(k == component) for k in range(6)) for component in self.place)

    @property
    def components(self) -> set[int]:
        """Components of motion that the row and the column name."""
        return {k for load in self.loads for k, value in enumerate(load) if value}

    @property
    def unit(self) -> str:
        """SI unit."""
        if self.is_frequency:
            return "Hz"
        return BLOCK_UNITS[self.kind][sum(k > 2 for k in self.place)]

    @property
    def pair(self) -> tuple[str, str] | None:
        """Both points of a term between points; None otherwise."""
        return (self.points[0], self.points[1]) if len(self.points) == 2 else None

    @property
    def is_coupling(self) -> bool:
        """True where row and column differ; such an entry may pass through zero by symmetry."""
        return self.row != self.column

    @property
    def diagonals(self) -> tuple[Quantity, Quantity] | None:
        """Entries of the diagonal of row and column, whose geometric mean a coupling or a term between
        points is related to; None otherwise.

        Examples
        --------
        >>> Quantity("C_z,thx@pinion").diagonals
        ('C_zz@pinion', 'C_thx@pinion')
        >>> Quantity("C_zz@wheel@pinion").diagonals
        ('C_zz@wheel@wheel', 'C_zz@pinion@pinion')
        """
        pair = self.pair
        if not self.is_coupling and (pair is None or pair[0] == pair[1]):
            return None
        first, second = (Quantity(f"{self.symbol[:2]}{_DIAGONAL[k]}") for k in self.place)
        if pair is None:
            return first.at(*self.points), second.at(*self.points)
        return first.at(pair[0], pair[0]), second.at(pair[1], pair[1])

    @property
    def repeats(self) -> bool:
        """True for a compliance "between" a point and itself, which repeats another and is there to
        relate couplings to.

        Examples
        --------
        >>> Quantity("C_zz@wheel@wheel").repeats, Quantity("K_zz@wheel@wheel").repeats
        (True, False)
        """
        pair = self.pair
        return pair is not None and pair[0] == pair[1] and self.kind == COMPLIANCE

    def at(self, *points: str) -> Quantity:
        """Return the same quantity at another point, or between two; without any at the main point."""
        return Quantity(AT.join((self.symbol, *points)))

    def points_among(self, names: Collection[str]) -> tuple[str, ...]:
        """Return the points, given the names of all lumped points, one of which may hold an ``@``."""
        joined = AT.join(self.points)
        return (joined,) if joined in names else self.points


C_ZZ, K_ZZ, FIRST_BENDING = Quantity("C_zz"), Quantity("K_zz"), Quantity("bending 1")

#: quantities that a scene may ask for; compliances first, which a change of tie or model moves least
#: by accident
QUANTITIES = (
    C_ZZ,
    *map(Quantity, ("C_z,thx", "C_thx", "C_yy")),
    K_ZZ,
    *map(Quantity, ("K_z,thx", "K_thx", "K_yy")),
    FIRST_BENDING,
    *map(Quantity, ("bending 2", "axial 1", "torsion 1")),
)
#: the other plane and torsion, which differ where bearings or features do: measured at the main
#: point, given on request, and not used to judge models
ACROSS = tuple(
    map(Quantity, ("C_xx", "C_x,thz", "C_thz", "C_thy", "K_xx", "K_x,thz", "K_thz", "K_thy"))
)
