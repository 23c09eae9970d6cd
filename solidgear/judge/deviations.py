"""Deviations of models from a reference.

A gap counts with the bars of both sides: within the tolerance even at their far end it is *within*,
beyond it even at their near end it is *beyond*, else the question is *open*.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from solidgear.judge.partners import Partners
from solidgear.judge.quantities import change
from solidgear.judge.solution import Solution
from solidgear.judge.ties import SCENE, SECTION
from solidgear.quantity import COMPLIANCE, QUANTITIES, Quantity

WITHIN, OPEN, BEYOND = "within", "open", "beyond"
TIES = {
    SCENE: "with the attachments of the scene",
    SECTION: "like for like (section means everywhere)",
}


def gap_verdict(gap: float, bar: float, tolerance: float) -> str:
    """``within``, ``open`` or ``beyond`` a tolerance, for a gap known to within an error bar."""
    if abs(gap) + bar <= tolerance:
        return WITHIN
    return BEYOND if abs(gap) - bar > tolerance else OPEN


def resolution(size: float, band: float | None) -> str:
    """``resolved`` where a difference is more than the bars of both sides, else ``not resolved``, or
    ``no band``.
    """
    if band is None:
        return "no band"
    return "resolved" if size > band else "not resolved"


@dataclass(frozen=True)
class Deviation:
    """A quantity of a model beside that of the reference.

    Attributes
    ----------
    attachment : str
        Tie of both: ``as scene`` or ``section``.
    value, reference_value : float
        SI.
    relative : float
        Of couplings to the geometric mean of their diagonal entries.
    band : float or None
        Sum of the bars of both, relative; None where neither has one.
    pairing : str
        In words, how a mode was found where its name did not tell.
    """

    model: str
    reference: str
    attachment: str
    quantity: Quantity
    value: float
    reference_value: float
    relative: float
    band: float | None
    pairing: str = ""

    @property
    def size(self) -> float:
        """Without its sign."""
        return abs(self.relative)

    @property
    def verdict(self) -> str:
        """``resolved`` where it is more than the bars of both, else ``not resolved``, or ``no band``."""
        return resolution(self.size, self.band)

    def standing(self, tolerance: float) -> str:
        """``within``, ``open`` or ``beyond`` a tolerance."""
        return gap_verdict(self.relative, self.band or 0.0, tolerance)

    @property
    def side(self) -> str:
        """Meaning of its sign to an engineer."""
        if self.quantity.diagonals:
            return "off (of the geometric mean of the two diagonal entries)"
        if self.quantity.kind == COMPLIANCE:
            return "too small (too stiff)" if self.relative < 0 else "too large (too soft)"
        return "too high" if self.relative > 0 else "too low"


def deviations(solutions: dict[str, Solution], reference: str) -> list[Deviation]:
    """Relative deviations from the reference, once with the attachments of the scene and once like
    for like.

    Couplings are related to the geometric mean of their diagonal entries, frequencies are those of
    the modes with the same shape. A gap inside the sum of both bars is "not resolved", which is
    not agreement.
    """
    base = solutions[reference]
    out: list[Deviation] = []
    for model, solution in solutions.items():
        if model == reference:
            continue
        for tie in (SCENE, SECTION):
            if (
                tie not in solution.ties
                or tie not in base.ties
                or (tie == SECTION and solution.ties[SECTION] is solution.ties[SCENE])
            ):
                continue
            out += _deviations(model, reference, tie, solution, base)
    return out


def _deviations(
    model: str, reference: str, tie: str, solution: Solution, base: Solution
) -> Iterable[Deviation]:
    mine, theirs = solution.ties[tie], base.ties[tie]
    partners = Partners(mine.modes, theirs.modes)
    further = [name for name in mine.quantities if name.points and not name.repeats]
    for name in (*QUANTITIES, *further):
        value, how = mine.quantities.get(name), ""
        if name.is_frequency:
            value, how = partners.frequency(name)
        if value is None or name not in theirs.quantities:
            continue
        relative = change({**mine.quantities, name: value}, theirs.quantities, name)
        if relative is None:
            continue
        bars = [
            r.error_bars[tie][name].width
            for r in (base, solution)
            if name in r.error_bars.get(tie, {})
        ]
        yield Deviation(
            model,
            reference,
            tie,
            name,
            value,
            theirs.quantities[name],
            relative,
            sum(bars) if bars else None,
            how,
        )


def about(
    gaps: Iterable[Deviation], model: str, names: Collection[Quantity], tie: str | None = None
) -> list[Deviation]:
    """Those of a model in some quantities, with one tie or with any."""
    return [
        gap
        for gap in gaps
        if gap.model == model and gap.quantity in names and tie in (None, gap.attachment)
    ]
