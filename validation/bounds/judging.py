"""Arithmetic of the judgement: the error of a number, its bar, and whether the one holds the other."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from solidgear.judge.quantities import described, diagonals
from validation.bounds.truths import Truth

#: errors below this are rounding
SMALL = 1e-7
#: an error is known if it is this many times the uncertainty of the true value
KNOWN = 3.0
STATIC, COUPLING, MODE = "static", "coupling", "mode"


def kind_of(quantity: str) -> str:
    """Whether a quantity is a frequency, stands between two motions, or neither."""
    if described(quantity)[0] == "frequency":
        return MODE
    return STATIC if diagonals(quantity) is None else COUPLING


@dataclass(frozen=True)
class Answer:
    """A number as it was answered; the bar is relative to `size`, the exact answer lies on `side`."""

    quantity: str
    value: float
    bar: float
    size: float
    side: str


@dataclass(frozen=True)
class Row:
    """A number held against the truth.

    Attributes
    ----------
    body, scene : str
        Name, and what the scene's references are kept under.
    tolerance : float
        Asked for.
    quantity : str
    value : float
        Answered.
    bar : float
        Relative.
    side : str
    true : float or None
        None where no reference tells.
    uncertainty, error : float or None
        Relative to the size of the quantity; the error is that of the answer, with its sign.
    how : str
        Where the true value comes from.
    seconds : float
        Of processor time, for all numbers of this body at this tolerance.
    unknowns : int
        Of the last mesh.
    reached : bool
        Whether all bars of the body are within the tolerance, as answered.
    """

    body: str
    scene: str
    tolerance: float
    quantity: str
    value: float
    bar: float
    side: str
    true: float | None
    uncertainty: float | None
    error: float | None
    how: str
    seconds: float
    unknowns: int
    reached: bool

    @property
    def kind(self) -> str:
        """As `kind_of`."""
        return kind_of(self.quantity)

    @property
    def size_of_error(self) -> float:
        """Without its sign; 0 where it is not known."""
        return abs(self.error or 0.0)

    @property
    def small(self) -> bool:
        """Whether the error is surely rounding."""
        return self.error is not None and self.size_of_error + self.doubt <= SMALL

    @property
    def doubt(self) -> float:
        """Uncertainty of the error."""
        return self.uncertainty or 0.0

    @property
    def judged(self) -> bool:
        """Whether the error is known, and not rounding."""
        if self.error is None:
            return False
        return self.size_of_error > max(SMALL, KNOWN * self.doubt)

    @property
    def ratio(self) -> float | None:
        """Bar over error."""
        return self.bar / self.size_of_error if self.judged else None

    @property
    def held(self) -> bool | None:
        """Whether the bar holds the error, as far as that is known; None where it is not judged."""
        return self.size_of_error - self.doubt <= self.bar if self.judged else None

    @property
    def surely_held(self) -> bool:
        """Whether the bar holds any error that is possible."""
        return self.error is not None and self.size_of_error + self.doubt <= self.bar

    @property
    def wrong_side(self) -> bool:
        """Whether the exact answer surely lies on the side that was excluded."""
        if not self.judged or self.side not in ("above", "below"):
            return False
        # the exact answer lies above the value: then the value is too small
        return (self.error > 0) is (self.side == "above")

    @property
    def beyond(self) -> bool:
        """Whether the error is surely above the tolerance."""
        return self.error is not None and self.size_of_error - self.doubt > self.tolerance

    @property
    def promised(self) -> bool:
        """Whether the number was said to be within the tolerance."""
        return self.bar <= self.tolerance

    def as_dict(self) -> dict:
        """Plain data, with what follows from it."""
        told = ("judged", "ratio", "held", "beyond", "wrong_side")
        return asdict(self) | {name: getattr(self, name) for name in told}


FIELDS = tuple(Row.__dataclass_fields__)


def row_of(content: dict) -> Row:
    """A row from plain data."""
    return Row(**{name: content[name] for name in FIELDS})


def judged(answer: Answer, truth: Truth | None, **rest) -> Row:
    """An answer held against the truth.

    Parameters
    ----------
    answer : Answer
    truth : Truth or None
    **rest
        body, scene, tolerance, seconds, unknowns, reached.
    """
    known = {"true": None, "uncertainty": None, "error": None, "how": "no reference"}
    if truth is not None:
        known = {
            "true": truth.value,
            "uncertainty": truth.uncertainty,
            "error": (answer.value - truth.value) / answer.size,
            "how": truth.how,
        }
    told = {name: getattr(answer, name) for name in ("quantity", "value", "bar", "side")}
    return Row(**told, **known, **rest)
