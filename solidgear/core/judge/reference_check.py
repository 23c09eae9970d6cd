"""Check of a reference by a solid with an error of its own: how far its numbers are from those of the
reference, mesh by mesh.

The check of a number has ended where it is within the tolerance even at the far end of the
reference's error bar: then both agree, whatever the mesh of the solid leaves. It has ended as well
where the error bars of both exclude each other on two meshes, for then a difference is shown. One
mesh does not show it, since the error bar of a coarse mesh may be too small.
"""

from __future__ import annotations

from collections.abc import Sequence

from solidgear.core.judge.deviations import deviations, select_gaps
from solidgear.core.judge.quantities import Values, change
from solidgear.core.judge.solution import Solution
from solidgear.core.judge.ties import SCENE
from solidgear.core.quantity import Quantity

Distances = dict[Quantity, float]


class ReferenceCheck:
    """Compares the meshes of a solid with a reference in some numbers, to a relative tolerance."""

    def __init__(self, reference: Solution, names: Sequence[Quantity], tol: float):
        self.reference, self.names, self.tol = reference, names, tol
        self._beyond: set[Quantity] = set()  # both error bars, on the last mesh

    def distances(self, solution: Solution) -> Distances:
        """Return how far each number of a mesh may be from that of the reference, relative; zero
        where a difference is shown. Empty where a frequency without an error bar may be too far.
        """
        pair = {solution.model: solution, self.reference.model: self.reference}
        bars = solution.error_bars.get(SCENE, {})
        distances: Distances = {}
        beyond: set[Quantity] = set()
        for gap in select_gaps(
            deviations(pair, self.reference.model), solution.model, self.names, SCENE
        ):
            if gap.quantity not in self._reference_bars:
                continue
            distances[gap.quantity] = gap.size + gap.reference_bar
            if gap.quantity in bars and gap.verdict == "resolved":
                beyond.add(gap.quantity)
        distances |= dict.fromkeys(beyond & self._beyond, 0.0)
        self._beyond = beyond
        without = (d for q, d in distances.items() if q.is_frequency and q not in bars)
        return {} if max(without, default=0.0) > self.tol else distances

    def distances_beyond(self, static: Values) -> Distances:
        """Return how far the static numbers of a mesh may be from those of the reference; empty
        unless one is beyond the tolerance for certain, so that the mesh cannot be the last.
        """
        reference, bars = self.reference.quantities, self._reference_bars
        gaps = {
            name: abs(relative)
            for name in self.names
            if name in bars and (relative := change(static, reference, name)) is not None
        }
        if all(gap - bars[name].width <= self.tol for name, gap in gaps.items()):
            return {}
        return {name: gap + bars[name].width for name, gap in gaps.items()}

    @property
    def _reference_bars(self):
        return self.reference.error_bars.get(SCENE, {})
