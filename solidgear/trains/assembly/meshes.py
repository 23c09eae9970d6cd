"""Error bars that the meshes of harmonic shafts leave in the frequencies of a train, and the
frequencies that the meshes of its shafts resolve."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.core import System, pinned
from solidgear.core.system.parts import Part, Placed
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_errors import highest_resolved


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
    errors = assembly.mesh_errors(system, models, n)
    return None if errors is None else errors.bars[:n]


def mesh_limit(assembly: Assembly, side: str, part: Part) -> float:
    """Return the frequency up to which the mesh under a part follows shear waves, Hz; infinite
    without cells.
    """
    reduced = part.part if isinstance(part, Placed) else part
    model = assembly._models.get((side, getattr(reduced, "fidelity", "")))
    return np.inf if model is None else highest_resolved(assembly.scenes[side], model.body)
