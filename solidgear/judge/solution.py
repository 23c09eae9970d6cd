"""One model of one scene, solved with the ties of the scene and like for like, with the bands of a
solid.

The *ties of the scene* are what its bearings and its port say.  *Like for like* means mean motions
of cross-sections at every station: what a beam knows of a solid.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from solidgear.body import Body
from solidgear.judge.bars import Band
from solidgear.judge.quantities import JUDGED
from solidgear.judge.solving import Answer
from solidgear.judge.ties import SCENE
from solidgear.machine.meter import Meter
from solidgear.solve.condensed import Condensed
from solidgear.solve.modes import ModeSet


@dataclass
class Solution:
    """One rung of one scene, solved with its evidence.

    Attributes
    ----------
    model : str
        The rung.
    ties : dict of str to Answer
        ``as scene`` and ``section``, as far as they could be solved.
    bands : dict of str to dict of str to Band
        The same keys; empty for a model without a band of its own.
    scores : dict of str to ndarray
        By quantity with the ties of the scene, (ne,) shares of its bar by cells of a meridian; of a
        model whose bars are computed.
    variants : dict of str to Answer
        The scene with each attachment everywhere: ``average``, ``rigid`` (bearing seats only),
        ``section``.
    levels : list of dict
        Facts about every mesh, coarse to fine.
    failed : dict of str to str
        What was left out, and why.
    """

    model: str
    ties: dict[str, Answer]
    meter: Meter
    bands: dict[str, dict[str, Band]] = field(default_factory=dict)
    scores: dict[str, np.ndarray] = field(default_factory=dict)
    variants: dict[str, Answer] = field(default_factory=dict)
    levels: list[dict] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def body(self) -> Body:
        """The finest body, tied as in the scene."""
        return self.ties[SCENE].body

    @property
    def condensed(self) -> Condensed:
        """Statics with the ties of the scene."""
        return self.ties[SCENE].condensed

    @property
    def modes(self) -> ModeSet:
        """Modes with the ties of the scene."""
        return self.ties[SCENE].modes

    @property
    def quantities(self) -> dict[str, float]:
        """Compared numbers with the ties of the scene."""
        return self.ties[SCENE].quantities

    def worst_band(self, names: Iterable[str] = JUDGED) -> float | None:
        """Largest band with the ties of the scene over some quantities; None where there is none."""
        own = self.bands.get(SCENE, {})
        return max((own[n].gci for n in names if n in own), default=None)
