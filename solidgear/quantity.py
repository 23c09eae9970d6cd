"""The numbers by which models are compared, by their names.

An entry of a compliance (``C_``) or stiffness (``K_``) is named by its row and column: ``C_zz``,
``C_thx``, ``K_z,thx``. At the main lumped point that is all; at a further one its name follows an
``@``: ``C_zz@pinion``. Terms between points have both: ``C_z,thx@wheel@pinion`` is the motion z of
the wheel under a moment thx on the pinion. Of a stiffness between points the others are held, so
that its own diagonal, ``K_zz@wheel@wheel``, is not the stiffness of one point alone. Any other text
is the name of a mode, and means its natural frequency.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any, overload

from solidgear.frames import DOF_NAMES

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
    """A text that has been taken apart: equal to what it is written as, with what it says beside it.

    A text with attributes, and not a record with a text: users, tables and JSON go on reading text.
    """

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema  # slow to import, and only records need it

        return core_schema.no_info_after_validator_function(cls, core_schema.str_schema())


class Quantity(Name):
    """A number by which models are compared.

    Parameters
    ----------
    text : str

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
    #: row, column: place in the 6x6, in the order of :data:`~solidgear.frames.DOF_NAMES`; None of
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
        """True where it is the natural frequency of the mode of its name."""
        return self.kind == FREQUENCY

    @property
    def place(self) -> tuple[int, int]:
        """Row and column of an entry of a matrix."""
        assert self.row is not None and self.column is not None, f"{self} is no entry of a matrix"
        return self.row, self.column

    @overload
    def of(self, matrix: np.ndarray) -> float: ...

    @overload
    def of(self, matrix: Sequence[Sequence[float | None]]) -> float | None: ...

    def of(self, matrix: Any) -> float | None:
        """Its value in a 6x6 of its kind; None where the matrix has none there.

        Parameters
        ----------
        matrix : (6, 6) ndarray or list of lists

        Examples
        --------
        >>> Quantity("C_z,thx").of([[10 * i + j for j in range(6)] for i in range(6)])
        23
        """
        row, column = self.place
        return matrix[row][column]

    @property
    def loads(self) -> tuple[tuple[float, ...], ...]:
        """Loads that its energy is of, on the point of the motion and on that of the load."""
        return tuple(tuple(float(k == component) for k in range(6)) for component in self.place)

    @property
    def components(self) -> set[int]:
        """Components of motion that it speaks of."""
        return {k for load in self.loads for k, value in enumerate(load) if value}

    @property
    def unit(self) -> str:
        """SI."""
        if self.is_frequency:
            return "Hz"
        return BLOCK_UNITS[self.kind][sum(k > 2 for k in self.place)]

    @property
    def pair(self) -> tuple[str, str] | None:
        """The two points of a term between points; None of all else."""
        return (self.points[0], self.points[1]) if len(self.points) == 2 else None

    @property
    def is_coupling(self) -> bool:
        """True where row and column differ: such an entry passes through zero where symmetry wants
        it to.
        """
        return self.row != self.column

    @property
    def diagonals(self) -> tuple[Quantity, Quantity] | None:
        """The two entries of the diagonal that a coupling, or a term between points, stands between
        and is related to the geometric mean of; None of all else.

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
        """True where it is another one over again: a compliance "between" a point and itself, which
        stands there to relate others to.

        Examples
        --------
        >>> Quantity("C_zz@wheel@wheel").repeats, Quantity("K_zz@wheel@wheel").repeats
        (True, False)
        """
        pair = self.pair
        return pair is not None and pair[0] == pair[1] and self.kind == COMPLIANCE

    def at(self, *points: str) -> Quantity:
        """The same at another point, or between two; at the main one where none is given.

        Parameters
        ----------
        *points : str
        """
        return Quantity(AT.join((self.symbol, *points)))

    def points_among(self, names: Collection[str]) -> tuple[str, ...]:
        """Its points, where the name of a single one may have an ``@`` of its own.

        Parameters
        ----------
        known : collection of str
            Names of all lumped points.
        """
        joined = AT.join(self.points)
        return (joined,) if joined in names else self.points


C_ZZ, K_ZZ, FIRST_BENDING = Quantity("C_zz"), Quantity("K_zz"), Quantity("bending 1")

#: What a scene may ask for. Compliances first: they are what a change of tie or model moves least
#: by accident.
QUANTITIES = (
    C_ZZ,
    *map(Quantity, ("C_z,thx", "C_thx", "C_yy")),
    K_ZZ,
    *map(Quantity, ("K_z,thx", "K_thx", "K_yy")),
    FIRST_BENDING,
    *map(Quantity, ("bending 2", "axial 1", "torsion 1")),
)
#: The other plane and torsion, which differ where bearings or features do: measured at the main
#: point, given where they are asked for, and no part of what models are judged by.
ACROSS = tuple(
    map(Quantity, ("C_xx", "C_x,thz", "C_thz", "C_thy", "K_xx", "K_x,thz", "K_thz", "K_thy"))
)
