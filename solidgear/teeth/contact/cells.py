"""Cells of the contact lines at one position of the teeth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from solidgear.teeth.contact.local import LineContact


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells on the contact lines, (n,) each, in a frame of the pair."""

    line: np.ndarray  #: number of the contact line; the larger, the nearer to the first wheel's tip
    length: np.ndarray  #: along the line, m
    radius: np.ndarray  #: relative, across the line, m
    gap: np.ndarray  #: between both flanks along the normal before any load, m
    lever: np.ndarray  #: of the normal about the first wheel's axis, m
    point: np.ndarray  #: (n, 3) m
    normal: np.ndarray  #: (n, 3) unit, the direction of the force on the first wheel
    slice: np.ndarray  #: number of the slice of the face
    place: np.ndarray  #: along the path of contact or the height of the tooth, m
    z: np.ndarray  #: along the face, m
    at_corner: np.ndarray  #: true beyond the path of contact, at the corner of a tip
    lean: np.ndarray  #: angle between both flanks at the corner of a tip, rad; no number elsewhere

    @cached_property
    def rows(self) -> np.ndarray:
        """(n, 6) motion along the normals of a rigid translation and rotation at the origin."""
        return np.hstack([self.normal, np.cross(self.point, self.normal)])


class ToothedPair(Protocol):
    """Two wheels with all that their contact needs; positions count in pitches."""

    @property
    def law(self) -> LineContact:
        """What gives way where flanks touch."""
        ...

    def cells(self, phase: float) -> Cells:
        """Return the cells at a position."""
        ...

    def bulk(self, cells: Cells) -> np.ndarray:
        """Return the (n, n) compliance of the teeth of both wheels between cells, m/N."""
        ...


class Carrying(Protocol):
    """What carries both wheels."""

    @property
    def compliance(self) -> np.ndarray:
        """(N, N) of its motions."""
        ...

    @property
    def motion(self) -> np.ndarray:
        """(N,) under all loads but those of these teeth."""
        ...

    def rows(self, cells: Cells) -> np.ndarray:
        """Return the (n, N) rows by which its motions open the cells."""
        ...
