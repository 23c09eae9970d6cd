"""Computed shapes on measuring points, and how like measured ones they are.

MAC of a measured shape and a mode is the share of it that lies in the span of the mode's shapes
(Allemang 2003, Sound and Vibration 37, 14, eq. 4, where there is one; for a pair the plane of the
measurement is free).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.core import Body, Mode
from solidgear.measured.alignment import ShapeLikeness
from solidgear.measured.computed import Computed
from solidgear.measured.placement import nearest, refuse_off
from solidgear.measured.universal import Shapes

#: MAC of two computed modes on the measuring points from which on they look alike there
ALIKE = 0.1
#: pairs of modes that are named which look alike on the measuring points
NAMED = 3
#: places of the surface that are tried for one more point
TRIED = 300


class SurfacePoints:
    """Motions of a body's surface at measuring points (p, 3), m, by their numbers; a point that is
    off the surface is refused.

    Examples
    --------
    >>> import numpy as np, solidgear as sg
    >>> scene = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.6, diameter=0.02)])
    >>> body = sg.build(scene, "harmonic", order=3)
    >>> ends = sg.SurfacePoints(body, [1, 2], np.array([[0.01, 0.0, 0.0], [0.01, 0.6, 0.0]]))
    >>> bending = sg.modes(body, scene, n=2).named("bending 1")
    >>> across = ends.motion(bending.vectors[0])
    >>> across.shape, bool(np.allclose(across[0, [0, 2]], across[1, [0, 2]], rtol=1e-6))
    ((2, 3), True)
    """

    def __init__(self, body: Body, numbers: Sequence[int], points: np.ndarray):
        self.body, self.still = body, body.surface({})
        self.corners, self.weights, away = nearest(self.still, points)
        refuse_off(self.still, numbers, points, away)

    def motion(self, vector: Mapping[int, np.ndarray]) -> np.ndarray:
        """Return displacements (p, 3) from the unknowns of blocks."""
        return self.interpolate(self.body.surface(vector).displacement)

    def interpolate(self, moved: np.ndarray) -> np.ndarray:
        """Return displacements (p, 3) from those of all points of the surface."""
        return np.einsum("pc,pcx->px", self.weights, moved[self.corners])


@dataclass(frozen=True)
class Confused:
    """Two modes that look alike on the measuring points."""

    #: first, second: modes
    first: int
    second: int
    mac: float  #: of both on the points
    place: tuple[
        float, float, float
    ]  #: x, y, z of the further point that distinguishes them best, m
    mac_with_it: float  #: MAC with it


class OnPoints:
    """Shapes of modes on measuring points, and their likeness to measured ones."""

    def __init__(self, measured: Shapes, noise: float, computed: Computed):
        body = computed.body
        places = SurfacePoints(body, measured.numbers.tolist(), measured.points)
        still = places.still
        measured_points = np.any(measured.values != 0, axis=0)
        tried = np.unique(np.linspace(0, len(still.points) - 1, TRIED).astype(int))
        self.tried = still.points[tried]
        #: shapes of every mode on the points, and on those that may be added, by columns
        self.shapes: list[np.ndarray] = []
        self.more: list[np.ndarray] = []

        for mode in computed.modes:
            motions = [body.surface(vector).displacement for vector in mode.vectors]
            self.shapes.append(
                np.column_stack([places.interpolate(u)[measured_points] for u in motions])
            )
            self.more.append(np.stack([u[tried] for u in motions], axis=-1))
        spans = [_basis(shapes) for shapes in self.shapes]
        rows = measured.values[:, measured_points]
        square = np.sum(np.abs(rows) ** 2, axis=1)
        share = [np.sum(np.abs(rows @ span) ** 2, axis=1) for span in spans]
        mac = np.column_stack(share) / np.where(square > 0, square, np.nan)[:, None]
        parts = 2 if np.any(np.imag(rows)) else 1
        free = parts * np.array([span.shape[1] for span in spans])
        self.likeness = ShapeLikeness(mac, parts * rows.shape[1], free, noise)
        self._bases = spans

    def confused(self, count: int) -> list[Confused]:
        """Return pairs of the first `count` modes that look alike on the points, nearest ones
        first.
        """
        out = []
        for j in range(count):
            for k in range(j):
                like = _like(self._bases[j], self._bases[k])
                if like > ALIKE:
                    out.append((j - k, k, j, like))
        return [
            Confused(k, j, like, *self._best_further_point(k, j)) for _, k, j, like in sorted(out)
        ]

    def sentences(self, modes: Sequence[Mode]) -> tuple[str, ...]:
        """Return sentences on the first modes that look alike on the measuring points."""
        out = []
        names = [str(mode.name) for mode in modes]
        shapes = sum(mode.multiplicity for mode in modes)
        if shapes > self.likeness.components:
            out.append(
                f"{self.likeness.components} measured components distinguish no more than "
                f"{self.likeness.components} shapes, but {shapes} are computed up to the highest "
                f"resonance, so MAC is high by chance; measure {shapes - self.likeness.components} "
                "more at least."
            )
        confused = self.confused(len(modes))
        for pair in confused[:NAMED]:
            place = ", ".join(f"{x:.4g}" for x in pair.place)
            out.append(
                f"The measuring points do not distinguish {names[pair.first]} and "
                f"{names[pair.second]} (MAC {pair.mac:.2f})"
                + (
                    f"; one more at x, y, z = {place} m would (MAC {pair.mac_with_it:.2f})."
                    if pair.mac_with_it <= ALIKE
                    else ", nor would any one more point."
                )
            )
        if len(confused) > NAMED:
            out.append(f"They do not tell {len(confused) - NAMED} further pairs of modes.")
        return tuple(out)

    def _best_further_point(self, j: int, k: int) -> tuple[tuple[float, float, float], float]:
        """Return the place of one more point that distinguishes two modes best, and their MAC with
        it.
        """
        likes = [
            _like(
                _basis(np.vstack([self.shapes[j], self.more[j][p]])),
                _basis(np.vstack([self.shapes[k], self.more[k][p]])),
            )
            for p in range(len(self.tried))
        ]
        best = int(np.argmin(likes))
        x, y, z = self.tried[best].tolist()
        return (x, y, z), likes[best]


def _basis(columns: np.ndarray) -> np.ndarray:
    """Return orthonormal columns of the same span; a mode that no point sees spans nothing."""
    vectors, size, _ = np.linalg.svd(columns, full_matrices=False)
    return vectors[:, size > 1e-6 * max(size[0], np.finfo(float).tiny)]


def _like(a: np.ndarray, b: np.ndarray) -> float:
    """Return the MAC of two spans, of a shape of either with all of the other: the larger of both."""
    least = min(a.shape[1], b.shape[1])
    return float(np.sum((a.T @ b) ** 2)) / least if least else 0.0
