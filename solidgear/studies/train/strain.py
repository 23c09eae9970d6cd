"""Strain energy of modes of a train, by what it is in: shafts, their bearings, teeth, springs."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.scene.train import SIDES


def strain_shares(energy: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Shares of the strain energy of modes, along the train.

    Parameters
    ----------
    energy : mapping of str to (k,) ndarray
        By part and link, as of :class:`solidgear.system.modes.SystemModes`.

    Returns
    -------
    dict of str to (k,) ndarray
        ``engine spring``, ``pinion shaft``, ``pinion bearings`` (with their housing), ``mesh``,
        ``gear bearings``, ``gear shaft``, ``load spring``; those that are never strained left out.

    Examples
    --------
    >>> half = np.array([0.25])
    >>> shares = strain_shares({"mesh": half, "pinion": half, "pinion.1": half, "pinion.2": half})
    >>> {name: float(share[0]) for name, share in shares.items()}
    {'pinion shaft': 0.25, 'pinion bearings': 0.5, 'mesh': 0.25}
    """
    first, last = SIDES
    order = ["engine spring", f"{first} shaft", f"{first} bearings", "mesh"]
    order += [f"{last} bearings", f"{last} shaft", "load spring"]
    out: dict[str, np.ndarray] = {}
    for name, share in energy.items():
        place = _place(name)
        out[place] = out.get(place, 0.0) + share
    return {name: out[name] for name in [*order, *out] if name in out and out[name].any()}


def _place(name: str) -> str:
    """Place that a part or a link belongs to."""
    side, dot, _ = name.partition(".")
    if dot:
        return f"{side} bearings"
    return f"{name} shaft" if name in SIDES else name
