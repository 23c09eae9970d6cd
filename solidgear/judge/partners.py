"""Frequency of one model that answers for a mode of another: the mode of the same shape, or where
none is certain the same place in the order.
"""

from __future__ import annotations

import numpy as np

from solidgear.judge.correlation import Pairing, pair_modes
from solidgear.solve.modes import ModeSet


class Partners:
    """Modes of a model beside those of a reference."""

    def __init__(self, model: ModeSet, reference: ModeSet):
        self.model, self.reference = model, reference
        self.pairs: dict[str, Pairing] = {p.reference.name: p for p in pair_modes(model, reference)}

    def frequency(self, name: str) -> tuple[float | None, str]:
        """Frequency (Hz) of the model that answers for a mode of the reference, and in words how it
        was found where shapes did not tell.

        Where no shape is certainly the same, the mode is compared with the one at the same place in
        ascending order, twins counted twice: eigenvalues of two models of one shaft are ordered
        alike (Courant and Fischer) whatever their shapes are called.
        """
        # bending may be called by its plane
        asked = self.reference.named(name)
        name = name if asked is None else asked.name
        pair = self.pairs.get(name)
        if pair is None:
            return None, ""
        if pair.certain and pair.mode is not None:
            return (
                pair.mode.frequency_hz,
                ""
                if pair.mode.name == name
                else f"paired by shape, MAC {pair.mac:.2f}: it calls the mode {pair.mode.name}",
            )
        place = int(
            np.searchsorted(_ladder(self.reference), pair.reference.frequency_hz * (1 - 1e-9))
        )
        mine = _ladder(self.model)
        if place >= len(mine):
            return None, ""
        return float(
            mine[place]
        ), f"no shape is certainly the same, so number {place + 1} in ascending order is compared"


def _ladder(modes: ModeSet) -> np.ndarray:
    """Elastic frequencies in ascending order, each as often as it has shapes; families that only
    one model has left out.
    """
    own = sorted((*modes.modes, *modes.beyond), key=lambda m: m.frequency_hz)
    return np.array(
        [
            m.frequency_hz
            for m in own
            if m.frequency_hz > 0 and m.waves < 2
            for _ in range(m.multiplicity)
        ]
    )
