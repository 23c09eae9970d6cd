"""A number held against the truth, and a verdict held against it: the judgement of every campaign."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

#: errors below this are rounding
SMALL = 1e-7
#: an error is known if it is this many times the uncertainty of the true value
SURE = 3.0
#: references contradict where they differ by more than this many times both uncertainties
LENIENT, ROUNDING = 2.0, 1e-9
#: when a row is judged: the error itself is known; it is known whether the bar holds it, be the
#: error unsure by half of itself; or always, where a limit stands for the bar
KNOWN, DECIDED, CLAIM = "known", "decided", "claim"


@dataclass(frozen=True)
class Truth:
    """A true value, its uncertainty relative to the size of the quantity, and its source."""

    value: float
    uncertainty: float
    size: float
    how: str

    def agrees(self, other: Truth) -> bool:
        """Tell if both may be right; a little more than both admit is let pass."""
        gap = abs(self.value - other.value) / self.size
        return gap <= LENIENT * (self.uncertainty + other.uncertainty) + ROUNDING


@dataclass(frozen=True)
class Said:
    """A number as a model gave it; its bar is relative to `size`, the exact answer on `side`."""

    quantity: str
    value: float
    bar: float
    size: float
    side: str = "both"


@dataclass(frozen=True)
class Row:
    """A bar held against an error, both relative to the size of the quantity.

    Attributes
    ----------
    body, quantity : str
    tags : dict of str to str
        Tables are parted by these.
    bar : float
    error : float or None
        Of the value, with its sign; None where no reference tells.
    doubt : float
        Uncertainty of the error.
    side : str
        Of the value on which the exact answer was said to lie: above, below or both.
    tolerance : float or None
        Asked for.
    how : str
        Source of the true value.
    rule : str
        KNOWN, DECIDED or CLAIM.
    """

    body: str
    quantity: str
    tags: dict[str, str]
    bar: float
    error: float | None
    doubt: float = 0.0
    side: str = "both"
    tolerance: float | None = None
    how: str = ""
    rule: str = KNOWN

    @property
    def off(self) -> float:
        """The error without its sign; 0 where it is not known."""
        return abs(self.error or 0.0)

    @property
    def small(self) -> bool:
        """The error is surely rounding."""
        return self.error is not None and self.rule != CLAIM and self.off + self.doubt <= SMALL

    @property
    def judged(self) -> bool:
        """The error is known as well as the rule asks, and is not rounding."""
        if self.error is None or self.rule == CLAIM:
            return self.error is not None
        if self.rule == DECIDED:
            return self.off > SMALL and abs(self.off - self.bar) > self.doubt
        return self.off > max(SMALL, SURE * self.doubt)

    @property
    def held(self) -> bool | None:
        """The bar holds the error as far as that is known; None where it is not judged."""
        return self.off - self.doubt <= self.bar if self.judged else None

    @property
    def surely_held(self) -> bool:
        """The bar holds any error that is possible."""
        return self.error is not None and self.off + self.doubt <= self.bar

    @property
    def ratio(self) -> float | None:
        """Bar over error, where both are there and judged."""
        return self.bar / self.off if self.judged and self.off else None

    @property
    def wrong_side(self) -> bool:
        """The exact answer surely lies on the side that was excluded."""
        if not self.judged or self.side not in ("above", "below"):
            return False
        # the exact answer lies above the value: then the value is too small
        return (self.error > 0) is (self.side == "above")

    @property
    def beyond(self) -> bool:
        """The error is surely above the tolerance."""
        known = self.error is not None and self.tolerance is not None
        return known and self.off - self.doubt > self.tolerance

    @property
    def promised(self) -> bool:
        """The number was said to be within the tolerance."""
        return self.tolerance is not None and self.bar <= self.tolerance


def held(said: Said, truth: Truth | None, **rest: Any) -> Row:
    """Hold a number against the truth; the rest are fields of the row."""
    if truth is None:
        return Row(
            quantity=said.quantity,
            bar=said.bar,
            error=None,
            side=said.side,
            how="no reference",
            **rest,
        )
    error = (said.value - truth.value) / said.size
    told = {"quantity": said.quantity, "bar": said.bar, "side": said.side, "how": truth.how}
    return Row(error=error, doubt=truth.uncertainty, **told, **rest)


# ------------------------------------------------------------------------------------------------
# - verdicts
VALID, INVALID, FALSE_VALID = "valid, true", "not valid, true", "false valid"
FALSE_INVALID, LIKE_ONLY = "false invalid", "not valid like for like only"
EDGE, UNSOLVED = "on the edge", "not solved"
AGREES, UNCERTAIN, CONTRADICTS = "agrees", "uncertain", "contradicts"


@dataclass(frozen=True)
class Verdict:
    """One verdict of a model at a tolerance, sorted; `why` where somebody should look at it."""

    body: str
    model: str
    tolerance: float
    sort: str
    why: str = ""


def within(errors: Mapping[str, tuple[float, float]], tolerance: float) -> bool | None:
    """All (error, doubt) are within the tolerance; None where the doubt of one decides."""
    if any(abs(e) - d > tolerance for e, d in errors.values()):
        return False
    return True if all(abs(e) + d <= tolerance for e, d in errors.values()) else None


def sorted_verdict(said: bool, true: bool | None, fair: bool | None = True) -> str:
    """Sort a verdict by the truth of the scene as it stands, and of its fair like.

    *False valid*: said to be valid, and a judged quantity is further off than the tolerance. *False
    invalid*: said not to be, and all are within it both as the scene stands and with section ties
    everywhere, so that neither a cancellation nor the effect of a tie explains the refusal.
    """
    if true is None:
        return EDGE
    if said:
        return VALID if true else FALSE_VALID
    if not true:
        return INVALID
    return FALSE_INVALID if fair else LIKE_ONLY


# ------------------------------------------------------------------------------------------------
# - what a body gave
@dataclass(frozen=True)
class Cost:
    """Processor time of one answer."""

    body: str
    tags: dict[str, str]
    seconds: float
    unknowns: int = 0
    reached: bool = True


@dataclass
class Found:
    """Judgements of one body or of many.

    Attributes
    ----------
    rows, verdicts, costs : list
    failures : list of str
        In a sentence each: what must hold and does not.
    problems : list of str
        In a sentence each: why something could not be judged.
    """

    rows: list[Row] = field(default_factory=list)
    verdicts: list[Verdict] = field(default_factory=list)
    costs: list[Cost] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)

    def add(self, other: Found) -> None:
        """Take in what another has."""
        for name in self.__dataclass_fields__:
            getattr(self, name).extend(getattr(other, name))

    @property
    def wrong(self) -> bool:
        """A bar, a verdict or a claim does not hold."""
        false = any(v.sort == FALSE_VALID for v in self.verdicts)
        return false or bool(self.failures) or any(row.held is False for row in self.rows)

    def as_dict(self) -> dict[str, list]:
        """Plain data."""
        return asdict(self)


def found_of(content: Mapping[str, list]) -> Found:
    """Undo `Found.as_dict`."""
    kinds = {"rows": Row, "verdicts": Verdict, "costs": Cost}
    made = {name: [kind(**one) for one in content[name]] for name, kind in kinds.items()}
    return Found(**made, failures=list(content["failures"]), problems=list(content["problems"]))
