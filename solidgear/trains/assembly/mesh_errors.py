"""Errors that the meshes of harmonic shafts leave in the frequencies of a system, and finer meshes
where they come from.

The bound is that of one shaft (:mod:`solidgear.core.bounds.harmonic`): a mode of the train moves
every shaft, the other parts act as forces on the ports, and the local problems of all
shafts add up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from solidgear.core import ELEMENTS, Body, Scene, SolidgearError, System, coned
from solidgear.core.body import FURTHER
from solidgear.core.bounds.clusters import cluster_of, lower_ends
from solidgear.core.bounds.harmonic import (
    VibrationEnergies,
    harmonic_bounds,
    vibration_energies,
    why_unbounded,
    with_tail,
)
from solidgear.core.bounds.refining import HIGHEST, MOST_MESHES, Meshed
from solidgear.core.judge.refinement import FUTILE
from solidgear.core.safety import LOCAL
from solidgear.core.solve.statics import flexibility
from solidgear.core.system.modes import SystemModes

#: modes above those asked for that are looked at: the gap to the highest one counts, and near modes
#: share a bar
ABOVE = 6
#: and the error of the reduction up to which one of them is a mode of the shafts
RESOLVED = 1e-3
#: flexibility, in the largest of all ports, that is rounding
ROUNDED = 1e-12
#: share of a tolerance that shafts whose meshes stay as they are may take
SMALL = 0.7
#: meshes of which the last must be better than the first, or finer ones do not help
FEWEST = 3


@dataclass(frozen=True)
class Need:
    """Need of a shaft for a finer mesh."""

    score: np.ndarray  #: (ne,) weights of the cells by relative errors
    tolerance: float  #: relative error that may be left


@dataclass(frozen=True)
class MeshErrors:
    """Errors of the first n elastic frequencies of a system by the meshes of harmonic shafts."""

    bars: np.ndarray  #: (n,) relative; 1 where nothing was solved far enough beyond a mode
    sizes: np.ndarray  #: (n,) relative, without regard to modes nearby
    shares: dict[str, np.ndarray]  #: (ne, n) of the cells of each shaft, of all shafts in sum 1

    def needs(self, n: int, tolerance: float) -> dict[str, Need]:
        """Return what shafts need for the first n frequencies to be within a tolerance; none where
        they are.
        """
        width = np.where(self.bars < 1, self.bars, self.sizes)[:n]
        wide = np.flatnonzero(width > tolerance)
        parts = {
            side: width[wide] * share[:, wide].sum(axis=0) for side, share in self.shares.items()
        }
        needs: dict[str, Need] = {}
        # those that hold most, until what all others leave is small
        left = width[wide].copy()
        while (left > SMALL * tolerance).any():
            side = max(parts.keys() - needs.keys(), key=lambda side: parts[side].max())
            score = (width[wide] * self.shares[side][:, wide]).max(axis=1)
            needs[side] = Need(score, 0.0)
            left -= parts[side]
        refined_sum = np.sum([parts[side] for side in needs], axis=0)
        for side, need in needs.items():
            worst = int(parts[side].argmax())
            share = float(parts[side][worst] / refined_sum[worst])
            least = max(share, 1 / len(self.shares))
            allowed = (tolerance - max(0.0, float(left[worst]))) * least
            needs[side] = replace(need, tolerance=allowed)
        return needs


def mesh_errors(
    system: System, scenes: Mapping[str, Scene], bodies: Mapping[str, Body], n: int
) -> MeshErrors | None:
    """Compute the errors of the first n elastic frequencies of a system by the meshes of some of
    the shafts, harmonic ones; None without any, where teeth drive families of two waves and more,
    and where nothing is known of the error of one.
    """
    if not bodies:
        return None
    modes = system.modes(n + ABOVE)
    if not _ends_below(modes, n):
        # near the last one asked for there are more of them than usual
        modes = system.modes(n + 4 * ABOVE)
    value = (2 * np.pi * modes.frequency_hz[modes.rigid :]) ** 2
    last = len(value) - 1
    highest = value[min(max(n, _resolved(modes) - 1), last)]
    near = min(cluster_of(value, min(n - 1, last)).stop, last) + 1
    value, shapes = value[:near], modes.shapes[:, modes.rigid :][:, :near]
    by_shaft: dict[str, VibrationEnergies] = {}
    for side, body in bodies.items():
        fields = system.expand(side, shapes)
        if max(fields) >= FURTHER:
            return None
        shape = coned(scenes[side])
        if why_unbounded(shape, body):
            return None
        by_shaft[side] = vibration_energies(shape, body, fields, value)
    two_more = np.sum([energies.two_more for energies in by_shaft.values()], axis=0)
    one_more = np.sum([energies.one_more for energies in by_shaft.values()], axis=0)
    energy = two_more.diagonal()
    tails = np.array([with_tail(a, b) for a, b in zip(energy, one_more.diagonal())])
    grown = np.sqrt(np.divide(tails, energy, out=np.ones(len(value)), where=energy > 0))
    products = LOCAL * two_more * np.outer(grown, grown)
    least = lower_ends(value, products, highest)
    # nothing resolved beyond the last ones: as far down as one likes
    least = np.maximum(np.nan_to_num(least, nan=0.0), 0.0)
    total = np.where(energy > 0, energy, 1.0)
    return MeshErrors(
        bars=(1 - np.sqrt(least / value))[:n],
        sizes=(products.diagonal() / value / 2)[:n],
        shares={side: (e.by_cell / total)[:, :n] for side, e in by_shaft.items()},
    )


def flexibility_errors(side: str, scene: Scene, body: Body) -> MeshErrors | None:
    """Compute the errors of the flexibility of a free harmonic shaft at its ports, under every unit
    load, balanced by inertia; None where nothing is known of them.
    """
    if why_unbounded(coned(scene), body):
        return None
    bounds = harmonic_bounds(coned(scene), body, statics=True)
    by_cell = np.einsum("cii->ic", bounds.of_ports)
    size = flexibility(body).matrix.diagonal()
    loaded = np.flatnonzero((size > ROUNDED * size.max()) & (by_cell.sum(axis=1) > 0))
    bars = LOCAL * bounds.tailed.diagonal()[loaded] / size[loaded]
    shares = by_cell[loaded].T / by_cell[loaded].sum(axis=1)
    return MeshErrors(bars, bars, {side: shares})


def _resolved(modes: SystemModes) -> int:
    """Return the number of elastic modes that are modes of the shafts."""
    return int((modes.error_bound[modes.rigid :] < RESOLVED).sum())


def _ends_below(modes: SystemModes, n: int) -> bool:
    """Return whether modes near the n-th elastic one end below a further mode of the shafts."""
    values = modes.frequency_hz[modes.rigid :][: _resolved(modes)] ** 2
    return n <= len(values) and cluster_of(values, n - 1).stop < len(values)


def refine_meshes(
    finer: Callable[[], tuple[Mapping[str, Any], float]],
    refine: Callable[[Any], None],
) -> None:
    """Refine meshes of shafts until there are none to refine, or finer ones do not help; `finer`
    returns the next meshes and the largest error bar of the last ones, `refine` solves them.
    """
    bars: list[float] = []
    for _ in range(MOST_MESHES):
        meshes, bar = finer()
        bars.append(bar)
        if not meshes or len(bars) > FEWEST and bar > FUTILE * bars[-FEWEST]:
            return
        try:
            refine(meshes)
        except (SolidgearError, MemoryError):
            return  # error bars stay as wide as they are, and are shown so


def resolving(mesh: Meshed) -> Meshed:
    """Return a mesh that follows waves of a higher frequency."""
    if mesh.order < HIGHEST:
        return replace(mesh, order=mesh.order + 1)
    return replace(mesh, size=mesh.size / 2)


def highest_resolved(scene: Scene, body: Body) -> float:
    """Return the frequency up to which the mesh of a body follows shear waves, Hz; infinite
    without cells.

    A quarter of the order in radians a cell: at 0.6 of it frequencies of the pinion, the ring
    gear and a stepped shaft were off by 0.3 % at most at order 4, at all of it by some 2 % at
    order 2.
    """
    facts = body.mesh
    cell = facts.get("representative_size")
    if not cell:
        return np.inf
    order = facts.get("order") or ELEMENTS[facts["element"]].order
    materials = {segment.material for segment in scene.segments}
    shear = min(np.sqrt(m.shear_modulus / m.density) for m in materials)
    return float(order * shear / (8 * np.pi * cell))
