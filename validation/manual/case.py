"""What a case of the manual is: a problem, references with their source, and models held to them.

A case is data and a callable per model; it draws nothing and prints nothing.  The same objects make
the pages (:mod:`validation.manual.page`) and the tests.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

Kind = Literal["closed_form", "literature", "cross_model", "golden"]
#: relative tolerance that would accept anything, and one that nine printed digits cannot hold
LOOSEST, TIGHTEST = 0.1, 1e-8
#: a model that takes this long (declared seconds) is solved by the slow tests only
SLOW = 0.5
LETTERS = "ABCDEFGHIJKLMNOP"


class CaseError(ValueError):
    """A case that does not say what it is, where its numbers come from or why it may deviate."""


@dataclass(frozen=True)
class Reference:
    """One quantity whose value is known from elsewhere.

    Attributes
    ----------
    quantity : str
    value : float
        In ``unit``; never zero, since deviations are relative to it.
    unit : str
    kind : str
        ``closed_form``, ``literature``, ``cross_model`` (another program or another model) or
        ``golden`` (this library, kept against unintended change).
    source : str
        With equation, table, section or page.
    uncertainty : float
        Relative.
    limits : str
        What the uncertainty comes from.
    """

    quantity: str
    value: float
    unit: str
    kind: Kind
    source: str
    uncertainty: float
    limits: str

    def __post_init__(self) -> None:
        for name in ("quantity", "unit", "source", "limits"):
            _says_something(f"reference {self.quantity!r}", name, getattr(self, name))
        if self.kind not in get_args(Kind):
            raise CaseError(
                f"reference {self.quantity!r}: kind {self.kind!r} is none of "
                f"{', '.join(get_args(Kind))}"
            )
        if not 0 < abs(self.value) < float("inf"):
            raise CaseError(
                f"reference {self.quantity!r}: value {self.value} must be finite and not zero"
            )
        if not 0 <= self.uncertainty < LOOSEST:
            raise CaseError(
                f"reference {self.quantity!r}: uncertainty {self.uncertainty} must be from 0 to "
                f"under {LOOSEST}"
            )


@dataclass(frozen=True)
class Answer:
    """What a model gave: values by quantity, in the units of the references, and its size.

    Attributes
    ----------
    values : mapping of str to float
    unknowns : int
    """

    values: Mapping[str, float]
    unknowns: int


@dataclass(frozen=True)
class Model:
    """One way of solving the problem, and how near it must come.

    Attributes
    ----------
    name : str
        With its mesh.
    solve : callable
        Without arguments; returns an :class:`Answer`.
    tolerance : float or mapping of str to float
        Relative, of every quantity of the case or of those named, which are those the model is
        judged by.
    why : str
        The physical or numerical reason of the tolerance.
    seconds : float
        Declared time on two cores, as a rough measure; never asserted.
    known : mapping of str to float
        Relative deviation that the model is known to have by its assumptions: the tolerance then
        lies around it.
    """

    name: str
    solve: Callable[[], Answer]
    tolerance: float | Mapping[str, float]
    why: str
    seconds: float = 0.3
    known: Mapping[str, float] = field(default_factory=dict)

    @property
    def slow(self) -> bool:
        """Whether only the slow tests solve it."""
        return self.seconds >= SLOW

    def tolerances(self, quantities: tuple[str, ...]) -> dict[str, float]:
        """Relative tolerance by judged quantity, in the order of the case."""
        if isinstance(self.tolerance, Mapping):
            return {q: self.tolerance[q] for q in quantities if q in self.tolerance}
        return dict.fromkeys(quantities, self.tolerance)


@dataclass(frozen=True)
class Line:
    """One judged number.

    Attributes
    ----------
    reference : Reference
    value : float or None
        None where the model did not give it.
    tolerance, known : float
        Relative.
    """

    reference: Reference
    value: float | None
    tolerance: float
    known: float

    @property
    def deviation(self) -> float:
        """Relative, from the reference; NaN where there is no value."""
        if self.value is None:
            return float("nan")
        return self.value / self.reference.value - 1

    @property
    def share(self) -> float:
        """Deviation beyond the known one, in tolerances; NaN where there is no value."""
        return abs(self.deviation - self.known) / self.tolerance

    @property
    def ok(self) -> bool:
        """Whether the value is there and within its tolerance."""
        return self.share <= 1.0


@dataclass(frozen=True)
class Case:
    """A problem whose answer is known, and the models that are held to it.

    Attributes
    ----------
    name : str
        Of the page, without suffix.
    title, problem, geometry, material, supports, asked : str
        Geometry may hold a sketch; ``supports`` are supports and loads.
    references : tuple of Reference
    models : tuple of Model
        A, B, C ... in this order.
    remarks : str
        What comes of it.
    printed : bool
        Whether it is an example of a book or catalogue, which the index lists apart.

    Raises
    ------
    CaseError
        For an empty text, an unnamed quantity, or a tolerance that accepts anything.

    Examples
    --------
    >>> half = Reference("half", 0.5, "1", "closed_form", "a book, equation 1", 0.0, "closed form")
    >>> near = Model("near", lambda: Answer({"half": 0.5004}, 1), 1e-3, "a thousandth")
    >>> case = Case("a", "A", "What is it?", "none", "none", "none", "half", (half,), (near,))
    >>> [line.ok for line in case.lines(near, near.solve().values)]
    [True]
    """

    name: str
    title: str
    problem: str
    geometry: str
    material: str
    supports: str
    asked: str
    references: tuple[Reference, ...]
    models: tuple[Model, ...]
    remarks: str = ""
    printed: bool = False

    def __post_init__(self) -> None:
        for name in ("name", "title", "problem", "geometry", "material", "supports", "asked"):
            _says_something(f"case {self.name!r}", name, getattr(self, name))
        if len(set(self.quantities)) < len(self.quantities) or not self.quantities:
            raise CaseError(f"case {self.name!r}: quantities {self.quantities} must differ")
        if not 0 < len(self.models) <= len(LETTERS):
            raise CaseError(f"case {self.name!r}: {len(self.models)} models, not 1 to 16")
        for model in self.models:
            self._accepts(model)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of the references."""
        return tuple(r.quantity for r in self.references)

    @property
    def lettered(self) -> tuple[tuple[str, Model], ...]:
        """Models with their letters."""
        return tuple(zip(LETTERS, self.models))

    def lines(self, model: Model, values: Mapping[str, float]) -> tuple[Line, ...]:
        """Judged numbers of one model, in the order of the references."""
        tolerances = model.tolerances(self.quantities)
        return tuple(
            Line(r, values.get(r.quantity), tolerances[r.quantity], model.known.get(r.quantity, 0))
            for r in self.references
            if r.quantity in tolerances
        )

    def _accepts(self, model: Model) -> None:
        """Refuse a model whose tolerances say nothing."""
        what = f"case {self.name!r}, model {model.name!r}"
        _says_something(what, "name", model.name)
        _says_something(what, "why", model.why)
        tolerances = model.tolerances(self.quantities)
        named = {*model.known}
        if isinstance(model.tolerance, Mapping):
            named |= {*model.tolerance}
        if strange := named - {*tolerances}:
            raise CaseError(f"{what}: {', '.join(sorted(strange))} is no judged quantity")
        if not tolerances:
            raise CaseError(f"{what}: judged by nothing")
        for r in self.references:
            tolerance = tolerances.get(r.quantity, LOOSEST)
            if not TIGHTEST <= tolerance <= LOOSEST:
                raise CaseError(
                    f"{what}: tolerance {tolerance} of {r.quantity} must be {TIGHTEST} to {LOOSEST}"
                )
            if tolerance < r.uncertainty:
                raise CaseError(
                    f"{what}: tolerance {tolerance} of {r.quantity} is below the uncertainty "
                    f"{r.uncertainty} of its reference"
                )


def references(
    values: Mapping[str, float],
    unit: str,
    kind: Kind,
    source: str,
    uncertainty: float,
    limits: str,
) -> tuple[Reference, ...]:
    """Several quantities of one source."""
    return tuple(
        Reference(name, float(value), unit, kind, source, uncertainty, limits)
        for name, value in values.items()
    )


def _says_something(what: str, name: str, text: object) -> None:
    if not isinstance(text, str) or not text.strip():
        raise CaseError(f"{what}: {name} must be a text that says something")
