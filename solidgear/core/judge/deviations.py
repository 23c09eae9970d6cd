"""Deviations of models from a reference.

A difference is *resolved* where it exceeds the error bars of both sides. The error of a model is known
as well as the reference is: a gap within the tolerance even at the far end of the reference's bar is
*within*, beyond it even at the near end it is *beyond*, else the question is *open*; what the bar
of the model's own mesh allows is in the gap already.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

import numpy as np

from solidgear.core.judge.correlation import Pairing, pair_modes
from solidgear.core.judge.quantities import change
from solidgear.core.judge.solution import Solution
from solidgear.core.judge.ties import SCENE, SECTION
from solidgear.core.quantity import COMPLIANCE, QUANTITIES, Quantity
from solidgear.core.solve.modes import ModeSet

WITHIN, OPEN, BEYOND = "within", "open", "beyond"
TIES = {
    SCENE: "",
    SECTION: " like for like",
}


def gap_verdict(gap: float, bar: float, tolerance: float) -> str:
    """Return ``within``, ``open`` or ``beyond`` a tolerance, for a gap known to within an error
    bar.
    """
    if abs(gap) + bar <= tolerance:
        return WITHIN
    return BEYOND if abs(gap) - bar > tolerance else OPEN


def resolution(size: float, bar: float | None) -> str:
    """Return ``resolved`` where a difference exceeds the error bars of both sides, else ``not
    resolved``, or ``no band``.
    """
    if bar is None:
        return "no band"
    return "resolved" if size > bar else "not resolved"


@dataclass(frozen=True)
class Deviation:
    """A quantity of a model against that of the reference."""

    model: str
    reference: str
    attachment: str  #: tie of both: ``as scene`` or ``section``
    quantity: Quantity
    #: SI
    value: float
    reference_value: float
    relative: float  #: of couplings to the geometric mean of their diagonal entries
    bar: float | None  #: sum of the error bars of both, relative; None where neither has one
    reference_bar: float  #: relative error bar of the reference; zero without one
    pairing: str = ""  #: in words, how a mode was paired where the name did not decide

    @property
    def size(self) -> float:
        """Magnitude of the relative deviation."""
        return abs(self.relative)

    @property
    def verdict(self) -> str:
        """``resolved`` where the deviation exceeds the error bars of both, else ``not resolved``,
        or ``no band``.
        """
        return resolution(self.size, self.bar)

    def standing(self, tolerance: float) -> str:
        """Return ``within``, ``open`` or ``beyond`` a tolerance."""
        return gap_verdict(self.relative, self.reference_bar, tolerance)

    @property
    def side(self) -> str:
        """Meaning of the sign to an engineer."""
        if self.quantity.diagonals:
            return "of the geometric mean of both diagonal entries off"
        if self.quantity.kind == COMPLIANCE:
            return "too small (too stiff)" if self.relative < 0 else "too large (too soft)"
        return "too high" if self.relative > 0 else "too low"


def deviations(solutions: dict[str, Solution], reference: str) -> list[Deviation]:
    """Compute relative deviations from the reference, once with the attachments of the scene and
    once like for like.

    Couplings are related to the geometric mean of their diagonal entries, frequencies are those of
    the modes with the same shape. A gap inside the sum of both error bars is "not resolved", which
    is not agreement.
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
    model_answer, reference_answer = solution.ties[tie], base.ties[tie]
    partners = Partners(model_answer.modes, reference_answer.modes)
    further = [name for name in model_answer.quantities if name.points and not name.repeats]
    for name in (*QUANTITIES, *further):
        value, pairing = model_answer.quantities.get(name), ""
        if name.is_frequency:
            value, pairing = partners.frequency(name)
        if value is None or name not in reference_answer.quantities:
            continue
        relative = change(
            {**model_answer.quantities, name: value}, reference_answer.quantities, name
        )
        if relative is None:
            continue
        of_reference, of_model = (r.error_bars.get(tie, {}).get(name) for r in (base, solution))
        bars = [bar.width for bar in (of_reference, of_model) if bar is not None]
        yield Deviation(
            model,
            reference,
            attachment=tie,
            quantity=name,
            value=value,
            reference_value=reference_answer.quantities[name],
            relative=relative,
            bar=sum(bars) if bars else None,
            reference_bar=0.0 if of_reference is None else of_reference.width,
            pairing=pairing,
        )


def select_gaps(
    gaps: Iterable[Deviation], model: str, names: Collection[Quantity], tie: str | None = None
) -> list[Deviation]:
    """Select the gaps of a model in some quantities, with one tie or with any."""
    return [
        gap
        for gap in gaps
        if gap.model == model and gap.quantity in names and tie in (None, gap.attachment)
    ]


class Partners:
    """Modes of a model paired with those of a reference: of the same shape or, where none is
    certain, at the same place in the order.
    """

    def __init__(self, model: ModeSet, reference: ModeSet):
        self.model, self.reference = model, reference
        self.pairs: dict[str, Pairing] = {p.reference.name: p for p in pair_modes(model, reference)}

    def frequency(self, name: str) -> tuple[float | None, str]:
        """Return the frequency (Hz) of the model that answers for a mode of the reference, and in
        words how it was found where shapes did not decide.

        Where no shape is certainly the same, the mode is compared with the one at the same place in
        ascending order, twins counted twice: eigenvalues of two models of one shaft are ordered
        alike (Courant and Fischer) whatever their shapes are called.
        """
        # bending may be called by its plane
        reference = self.reference.named(name)
        name = name if reference is None else reference.name
        pair = self.pairs.get(name)
        if pair is None:
            return None, ""
        if pair.certain and pair.mode is not None:
            pairing = ""
            if pair.mode.name != name:
                pairing = f"paired by shape, MAC {pair.mac:.2f}, with its {pair.mode.name}"
            return pair.mode.frequency_hz, pairing
        place = int(
            np.searchsorted(_ascending(self.reference), pair.reference.frequency_hz * (1 - 1e-9))
        )
        frequencies = _ascending(self.model)
        if place >= len(frequencies):
            return None, ""
        pairing = (
            f"no shape is certainly the same: compared by number {place + 1} in ascending order"
        )
        return float(frequencies[place]), pairing


def _ascending(modes: ModeSet) -> np.ndarray:
    """Return elastic frequencies in ascending order, each as often as it has shapes; families that
    only one model has are left out.
    """
    elastic = sorted((*modes.modes, *modes.beyond), key=lambda m: m.frequency_hz)
    return np.array(
        [
            m.frequency_hz
            for m in elastic
            if m.frequency_hz > 0 and m.waves < 2
            for _ in range(m.multiplicity)
        ]
    )
