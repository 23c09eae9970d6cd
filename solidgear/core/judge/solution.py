"""One model of one scene, solved with the ties of the scene and like for like, with the error bars
of a solid.

The *ties of the scene* are those of bearings and port. *Like for like* means mean motions of
cross-sections at every station, as a beam sees a solid.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from solidgear.core.body import Body
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.quantities import JUDGED
from solidgear.core.judge.record import LevelRecord
from solidgear.core.judge.solving import Answer
from solidgear.core.judge.ties import SCENE
from solidgear.core.machine.meter import Meter
from solidgear.core.quantity import Quantity
from solidgear.core.solve.condensed import Condensed
from solidgear.core.solve.modes import ModeSet


@dataclass
class Solution:
    """One model of one scene, solved, with the evidence."""

    model: str  #: name in the ladder
    ties: dict[str, Answer]  #: ``as scene`` and ``section``, as far as they could be solved
    meter: Meter
    #: the same keys; empty for a model without an error bar of its own
    error_bars: dict[str, dict[Quantity, ErrorBar]] = field(default_factory=dict)
    #: with the ties of the scene, (ne,) shares of the error bar by cells of a meridian; of a model
    #: whose bars are computed
    scores: dict[Quantity, np.ndarray] = field(default_factory=dict)
    #: the scene with each attachment everywhere: ``average``, ``rigid`` (bearing seats only),
    #: ``section``
    variants: dict[str, Answer] = field(default_factory=dict)
    levels: list[LevelRecord] = field(default_factory=list)  #: coarse to fine
    failed: dict[str, str] = field(default_factory=dict)  #: part left out -> reason
    options: dict[str, Any] = field(default_factory=dict)
    #: whether it only checks a reference: its meshes ended before its bars were within the tolerance
    check: bool = False

    @property
    def body(self) -> Body:
        """The finest body, tied as in the scene."""
        return self.ties[SCENE].body

    @property
    def condensed(self) -> Condensed:
        """Statics with the ties of the scene."""
        return self.ties[SCENE].statics.main

    @property
    def modes(self) -> ModeSet:
        """Modes with the ties of the scene."""
        return self.ties[SCENE].modes

    @property
    def quantities(self) -> dict[Quantity, float]:
        """Compared numbers with the ties of the scene."""
        return self.ties[SCENE].quantities

    def without_matrices(self) -> Solution:
        """Return what numbers and pictures are taken from, which is much less."""

        def without(answers: dict[str, Answer]) -> dict[str, Answer]:
            return {k: replace(a, body=a.body.without_matrices()) for k, a in answers.items()}

        return replace(self, ties=without(self.ties), variants=without(self.variants))

    def worst_bar(self, names: Iterable[Quantity] = JUDGED) -> float | None:
        """Return the largest error bar over some quantities, tied as in the scene; None where there
        is none.
        """
        error_bars = self.error_bars.get(SCENE, {})
        return max((error_bars[n].width for n in names if n in error_bars), default=None)
