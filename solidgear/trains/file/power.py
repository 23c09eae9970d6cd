"""Power of a train: shares of engines, loads, meshes and shafts.

A mesh or a planetary stage that alone joins two parts of the train passes the power that one part
takes.  Meshes of a loop divide it by their stiffness, and have no share here.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import fsum

from solidgear.core import SceneError
from solidgear.core.scene.units import TYPED
from solidgear.trains.file.layout import outward
from solidgear.trains.file.shafting import Shafting

#: share of the power below which it is rounding
NONE = 1e-12


def shares_of(train: Shafting) -> dict[str, float]:
    """Return the share of the power that every engine brings, and every load takes, below zero."""
    out: dict[str, float] = {}
    for sign, names in ((1.0, train.engines), (-1.0, train.loads)):
        shares = [train.rotors[name].share or 1.0 for name in names]
        out |= {name: sign * share / fsum(shares) for name, share in zip(names, shares)}
    return out


def flows_of(train: Shafting) -> dict[str, float | None]:
    """Return the share of the power that every mesh or stage passes from the first shaft to the
    second; None where a loop of meshes divides it by stiffness.
    """
    brought = dict.fromkeys(train.shafts, 0.0)
    for name, share in shares_of(train).items():
        brought[train.rotors[name].shaft] += share
    out: dict[str, float | None] = {}
    for joint in train.joints:
        first, second = joint.shafts
        behind = {side for side, _ in outward(train, first, excluded=joint)}
        flow = fsum(brought[side] for side in behind)
        out[joint.name] = None if second in behind else flow * (abs(flow) > NONE)
    return out


def carried_of(train: Shafting) -> dict[str, float]:
    """Return the share of the power that passes every shaft, without shafts that it does not pass; in
    a loop that of the shaft's engines and loads.
    """
    out = {}
    for side in train.shafts:
        flows = [
            share for name, share in shares_of(train).items() if train.rotors[name].shaft == side
        ]
        for joint in train.joints:
            if side in joint.shafts:
                sign = 1 if side == joint.shafts[1] else -1
                flows.append((train.flows[joint.name] or 0.0) * sign)
        most = max(fsum(w for w in flows if w > 0), -fsum(w for w in flows if w < 0))
        if most > NONE:
            out[side] = most
    return out


def share_problems(train: Shafting) -> Iterator[SceneError]:
    """Yield problems of the shares of engines or loads."""
    for kind, names in (("engine", train.engines), ("load", train.loads)):
        if not names:
            continue
        shares = [train.rotors[name].share for name in names]
        path = (*train.rotor_path(names[0]), "share")
        if len(names) > 1 and None in shares:
            lacking = train.rotor_path(names[shares.index(None)])
            reason = (
                f"this key is missing; {kind}s share the power: give each its share, such as 0.5"
            )
            yield SceneError(reason, path=(*lacking, "share"))
        elif any(shares) and abs(fsum(share or 0.0 for share in shares) - 1) > TYPED:
            total = fsum(share or 0.0 for share in shares)
            yield SceneError(
                f"the shares of all {kind}s sum to {total:.6g}; they must sum to 1", path=path
            )
    for name, rotor in train.rotors.items():
        if rotor.share is not None and name not in (*train.engines, *train.loads):
            reason = "is of engines and loads, which torque passes; leave it out"
            yield SceneError(reason, path=(*train.rotor_path(name), "share"))
