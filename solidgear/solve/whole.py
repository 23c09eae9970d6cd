"""Up to where what was solved of the families of motion is whole."""

from __future__ import annotations

import numpy as np

from solidgear.solve.families import FAMILIES
from solidgear.solve.groups import Part


def whole_to(parts: list[Part]) -> dict[int, float]:
    """Eigenvalues up to which the families of every block are whole, by its index, rad^2/s^2;
    solved parts that share a family of motion with another one are as whole as both.
    """
    ends: dict[str, float] = {}
    for part in parts:
        last = part.solved.elastic[-1].value if part.solved.elastic else 0.0
        for family in _motions(part):
            ends[family] = min(last, ends.get(family, np.inf))
    return {
        index: min(ends[family] for family in _motions(part))
        for part in parts
        for index in (*(part.first + b for b in part.supported.group), *part.twins)
    }


def _motions(part: Part) -> set[str]:
    """Families of motion that a part may show; of an ovalising block its name."""
    moved = {c for block in part.blocks for c in block.components}
    own = {name for name, components in FAMILIES.items() if moved & set(components)}
    return own or {block.name for block in part.blocks}
