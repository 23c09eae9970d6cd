"""System as steady motion reads it: matrices, free motions and elastic modes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from solidgear.core.system.links import Link
from solidgear.core.system.parts import Part


class Coupled(Protocol):
    """Parts and links put together, such as a :class:`solidgear.core.system.system.System`."""

    @property
    def parts(self) -> Mapping[str, Part]:
        """Parts by name."""

    @property
    def links(self) -> Mapping[str, Link]:
        """Links by name."""

    @property
    def mass(self) -> np.ndarray:
        """(N, N)."""

    @property
    def strains(self) -> tuple[np.ndarray, dict[str, slice]]:
        """G with ``K = G'G``, and which rows belong to which part or link."""

    @property
    def free(self) -> np.ndarray:
        """(N, z) mass-normalised motions that strain nothing."""

    @property
    def elastic(self) -> tuple[np.ndarray, np.ndarray]:
        """All elastic frequencies (m,), ascending, rad/s, and shapes (N, m), mass-normalised."""
