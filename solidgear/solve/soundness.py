"""Digits that rounding leaves a frequency: enough to be reported or not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.solve.groups import Part

if TYPE_CHECKING:
    from solidgear.solve.modes import Mode

#: Relative error of a frequency above which it is not reported.
WRONG = 1e-3


def sound(body: Body, mode: Mode, parts: list[Part]) -> Mode:
    """The mode, found in some parts, unless rounding may move its frequency by more than
    ``WRONG``: SolidgearError, which names the cause.
    """
    if mode.error > WRONG:
        doubt = (
            f"modes: rounding may move {mode.name} ({mode.frequency_hz:.6g} Hz) "
            f"by {100 * mode.error:.2g} %"
        )
        if _by_springs(mode, parts) > mode.error / 2:
            raise SolidgearError(
                f"{doubt}: bearings resist it by the difference of far larger stiffnesses that "
                "couple, and its sixteen digits are not enough; give the bearing a stiffness that "
                "is clearly positive in every direction, or zero"
            )
        highest = (
            max(part.supported.highest for part in parts) / (2 * np.pi * mode.frequency_hz) ** 2
        )
        raise SolidgearError(
            f"{doubt}: the smallest cell of the {body.fidelity} body is so stiff that the "
            f"eigenvalues span {np.log10(highest):.0f} digits of the 16 there are; use a coarser "
            "mesh (lower order, fewer layers), or a beam for a shaft as slender as this"
        )
    return mode


def _by_springs(mode: Mode, parts: list[Part]) -> float:
    """Share of the relative error of a frequency that comes from the rounding of the bearings'
    stiffness.
    """
    value, lost = (2 * np.pi * mode.frequency_hz) ** 2, 0.0
    for part in parts:
        own = part.supported
        for vectors in mode.vectors:
            if not set(vectors) & set(own.group):
                continue
            pieces = [vectors.get(b, np.zeros(k.size)) for b, k in zip(own.group, own.blocks)]
            u = np.concatenate(pieces)
            lost = max(lost, float(own.spring_rounding(u[:, None])[0]))
    return lost / (2 * value)
