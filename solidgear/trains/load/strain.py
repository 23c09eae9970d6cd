"""Strain energy of modes of a train by place: shafts, bearings, teeth, springs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np


def strain_shares(
    energy: Mapping[str, np.ndarray], shafts: Sequence[str] = ("pinion", "gear")
) -> dict[str, np.ndarray]:
    """Return shares (k,) of the strain energy of modes in the sequence of the train: ``engine
    spring``, ``pinion shaft``, ``pinion bearings`` (with their housing), ``mesh``, ``gear
    bearings``, ``gear shaft``, ``load spring``, ``mounts``; those that are never strained are
    left out.

    Examples
    --------
    >>> half = np.array([0.25])
    >>> shares = strain_shares({"mesh": half, "pinion": half, "pinion.1": half, "pinion.2": half})
    >>> {name: float(share[0]) for name, share in shares.items()}
    {'pinion shaft': 0.25, 'pinion bearings': 0.5, 'mesh': 0.25}
    """
    first, *further = shafts
    energy = mounts_together(energy)
    order = ["engine spring", f"{first} shaft", f"{first} bearings"]
    order += [name for name in energy if name.startswith("mesh")]
    for side in further:
        order += [f"{side} bearings", f"{side} shaft"]
    order += ["load spring"]
    out: dict[str, np.ndarray] = {}
    for name, share in energy.items():
        place = _place(name, shafts)
        out[place] = out.get(place, 0.0) + share
    return {name: out[name] for name in [*order, *out] if name in out and out[name].any()}


def mounts_together(energy: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the strain energy of modes with that of all mounts of a housing under ``mounts``."""
    out = {name: share for name, share in energy.items() if not name.startswith("mount ")}
    mounts = [share for name, share in energy.items() if name.startswith("mount ")]
    return out | ({"mounts": np.sum(mounts, axis=0)} if mounts else {})


def _place(name: str, shafts: Sequence[str]) -> str:
    """Return the place that a part or a link belongs to."""
    side, dot, _ = name.partition(".")
    if dot:
        return f"{side} bearings"
    return f"{name} shaft" if name in shafts else name
