"""Error bars that the meshes of harmonic shafts leave in the frequencies of a train.

The bound is that of one shaft (:mod:`solidgear.bounds.harmonic`): a mode of the train moves
every shaft, what the other parts do to it are forces on its ports, and the local problems of all
shafts add up.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.body import FURTHER
from solidgear.bounds.harmonic import lower_ends, vibration_energies, with_tail
from solidgear.bounds.safety import LOCAL
from solidgear.elements import ELEMENTS
from solidgear.machine.threads import pinned
from solidgear.scene.coned import coned
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.shaft import JUDGE
from solidgear.system.parts import Part, Placed
from solidgear.system.system import System

#: modes above those asked for that are looked at: the gap to the highest one counts, and near modes
#: share a bar
ABOVE = 6
#: and the error of the reduction up to which one of them is a mode of the shafts
RESOLVED = 1e-3


@pinned
def mesh_bars(
    workshop: Workshop, system: System, rungs: Mapping[str, str], n: int
) -> np.ndarray | None:
    """Largest relative error that meshes of harmonic shafts leave in frequencies of a train.

    Parameters
    ----------
    system : System
        Of its shafts.
    rungs : mapping of str to str
        Model of each shaft, in the sequence of the file.
    n : int
        Elastic modes.

    Returns
    -------
    (n,) ndarray or None
        The exact frequency lies below by no more than this, where beams are what they are. None
        where no shaft is a harmonic solid, and where teeth drive families of two waves and more.

    Examples
    --------
    >>> import solidgear as sg
    >>> coarse = {"harmonic": {"order": 2, "layers": 1}}
    >>> shop = Workshop(sg.load_train("geometry/axle_overhung.toml"), kept=8, settings=coarse)
    >>> both = {"pinion": "harmonic", "gear": "timoshenko"}
    >>> bool(mesh_bars(shop, shop.system(*both.values()), both, 4).max() < 1e-2)
    True
    """
    sides = [side for side, rung in rungs.items() if rung == JUDGE]
    if not sides:
        return None
    known = workshop.bars.get(tuple(rungs.values()))
    if known is not None and len(known) >= n:
        return known[:n]
    found = system.modes(n + ABOVE)
    resolved = int((found.error_bound[found.rigid :] < RESOLVED).sum())
    elastic = slice(found.rigid, found.rigid + max(n + 1, resolved))
    shapes = found.shapes[:, elastic]
    value = (2 * np.pi * found.frequency_hz[elastic]) ** 2
    two, one = np.zeros(len(value)), np.zeros(len(value))
    for side in sides:
        fields = system.expand(side, shapes)
        if max(fields) >= FURTHER:
            return None
        body = workshop.shaft(side, JUDGE).body
        own = vibration_energies(coned(workshop.scenes[side]), body, fields, value)
        two, one = two + own[0], one + own[1]
    energy = LOCAL * np.array([with_tail(a, b) for a, b in zip(two, one)])
    least = np.maximum(lower_ends(value, energy, value[-1]), 0.0)
    bars = (1 - np.sqrt(least / value))[:n]
    workshop.bars[tuple(rungs.values())] = bars
    return bars


def mesh_limit(workshop: Workshop, side: str, part: Part) -> float:
    """Frequency up to which the mesh under a part follows shear waves, Hz; infinite for what has
    no cells.

    A quarter of the order in radians a cell: at 0.6 of it frequencies of the pinion, the ring
    gear and a stepped shaft were off by 0.3 % at most at order 4, at all of it by some 2 % at
    order 2.
    """
    inner = part.part if isinstance(part, Placed) else part
    model = workshop._made.get((side, getattr(inner, "fidelity", "")))
    cell = model.body.mesh.get("representative_size") if model is not None else None
    if model is None or not cell:
        return np.inf
    facts = model.body.mesh
    order = facts.get("order") or ELEMENTS[facts["element"]].order
    materials = {segment.material for segment in workshop.scenes[side].segments}
    shear = min(np.sqrt(m.shear_modulus / m.density) for m in materials)
    return float(order * shear / (8 * np.pi * cell))
