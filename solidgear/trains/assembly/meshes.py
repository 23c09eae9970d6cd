"""Error bars that the meshes of harmonic shafts leave in the frequencies of a train.

The bound is that of one shaft (:mod:`solidgear.core.bounds.harmonic`): a mode of the train moves
every shaft, the other parts act as forces on the ports, and the local problems of all
shafts add up.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.core import ELEMENTS, System, coned, pinned
from solidgear.core.body import FURTHER
from solidgear.core.bounds.clusters import cluster_of, lower_ends
from solidgear.core.bounds.harmonic import vibration_energies, with_tail
from solidgear.core.bounds.safety import LOCAL
from solidgear.core.system.modes import SystemModes
from solidgear.core.system.parts import Part, Placed
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import JUDGE

#: modes above those asked for that are looked at: the gap to the highest one counts, and near modes
#: share a bar
ABOVE = 6
#: and the error of the reduction up to which one of them is a mode of the shafts
RESOLVED = 1e-3


@pinned
def mesh_bars(
    assembly: Assembly, system: System, models: Mapping[str, str], n: int
) -> np.ndarray | None:
    """Return the (n,) largest relative errors that meshes of harmonic shafts leave in the first
    elastic frequencies of a train, which lie below by no more than that where beams are exact;
    None without a harmonic solid, and where teeth drive families of two waves and more.

    Examples
    --------
    >>> import solidgear as sg
    >>> coarse = {"harmonic": {"order": 2, "layers": 1}}
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"), kept=8, settings=coarse)
    >>> both = {"pinion": "harmonic", "gear": "timoshenko"}
    >>> bool(mesh_bars(assembly, assembly.system(*both.values()), both, 4).max() < 1e-2)
    True
    """
    sides = [side for side, model in models.items() if model == JUDGE]
    if not sides:
        return None
    stored = assembly.bars.get(tuple(models.values()))
    if stored is not None and len(stored) >= n:
        return stored[:n]
    modes = system.modes(n + ABOVE)
    if not _ends_below(modes, n):
        # near the last one asked for there are more of them than usual
        modes = system.modes(n + 4 * ABOVE)
    elastic = slice(modes.rigid, modes.rigid + max(n + 1, _resolved(modes)))
    shapes = modes.shapes[:, elastic]
    value = (2 * np.pi * modes.frequency_hz[elastic]) ** 2
    double_energy, single_energy = np.zeros((2, len(value), len(value)))
    for side in sides:
        fields = system.expand(side, shapes)
        if max(fields) >= FURTHER:
            return None
        body = assembly.shaft_model(side, JUDGE).body
        energies = vibration_energies(coned(assembly.scenes[side]), body, fields, value)
        double_energy, single_energy = double_energy + energies[0], single_energy + energies[1]
    two_more, one_more = double_energy.diagonal(), single_energy.diagonal()
    tails = np.array([with_tail(a, b) for a, b in zip(two_more, one_more)])
    grown = np.sqrt(np.divide(tails, two_more, out=np.ones(len(value)), where=two_more > 0))
    products = LOCAL * double_energy * np.outer(grown, grown)
    least = lower_ends(value, products, value[-1])
    # nothing resolved beyond the last ones: as far down as one likes
    least = np.maximum(np.nan_to_num(least, nan=0.0), 0.0)
    bars = (1 - np.sqrt(least / value))[:n]
    assembly.bars[tuple(models.values())] = bars
    return bars


def _resolved(modes: SystemModes) -> int:
    """Return the number of elastic modes that are modes of the shafts."""
    return int((modes.error_bound[modes.rigid :] < RESOLVED).sum())


def _ends_below(modes: SystemModes, n: int) -> bool:
    """Return whether modes near the n-th elastic one end below a further mode of the shafts."""
    values = modes.frequency_hz[modes.rigid :][: _resolved(modes)] ** 2
    return n <= len(values) and cluster_of(values, n - 1).stop < len(values)


def mesh_limit(assembly: Assembly, side: str, part: Part) -> float:
    """Return the frequency up to which the mesh under a part follows shear waves, Hz; infinite
    without cells.

    A quarter of the order in radians a cell: at 0.6 of it frequencies of the pinion, the ring
    gear and a stepped shaft were off by 0.3 % at most at order 4, at all of it by some 2 % at
    order 2.
    """
    reduced = part.part if isinstance(part, Placed) else part
    model = assembly._models.get((side, getattr(reduced, "fidelity", "")))
    cell = model.body.mesh.get("representative_size") if model is not None else None
    if model is None or not cell:
        return np.inf
    facts = model.body.mesh
    order = facts.get("order") or ELEMENTS[facts["element"]].order
    materials = {segment.material for segment in assembly.scenes[side].segments}
    shear = min(np.sqrt(m.shear_modulus / m.density) for m in materials)
    return float(order * shear / (8 * np.pi * cell))
