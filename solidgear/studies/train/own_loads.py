"""Loads that scenes of a train have of their own, beside the torque that brings loads to all."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.errors import SceneError
from solidgear.scene.train import Train
from solidgear.studies.train.layout import force_on, mesh_forces
from solidgear.studies.train.models import Workshop

#: a [load] of a scene that is off the mesh force by less, of it, is that force written down
SAME_LOAD = 0.05


def refuse_own_loads(train: Train, side: str) -> None:
    """Refuse bearings whose load is told by themselves where a torque brings it."""
    for bearing in train.shafts[side].scene.bearings:
        data = bearing.catalogue
        if data is None:
            continue
        for key in ("load", "displacement"):
            if getattr(data, key) is not None:
                reason = (
                    f"bearing {bearing.name} has a {key} of its own, and in a train with an "
                    "[operation] the torque brings its load: leave it out"
                )
                raise SceneError(reason, path=(*train.shaft_path(side), "scene"))


def scene_load(
    workshop: Workshop, side: str, forces: Mapping[str, float]
) -> tuple[np.ndarray | None, list[str]]:
    """Load (6,) that the [load] of a shaft's scene adds to the mesh force, and what is to be said.

    Raises
    ------
    SceneError
        If it is neither the mesh force nor said to be added or replaced.
    """
    train, scene = workshop.train, workshop.scenes[side]
    if scene.load is None:
        return None, []
    own, word = np.array(scene.load.six), train.shafts[side].scene_load
    if word == "added":
        return own, [f"the [load] of the {side}'s scene is added to the mesh force"]
    if word == "replaced":
        return None, []
    if any(train.flows[pair.name] is None for pair in train.pairs if side in pair.shafts):
        raise SceneError(
            f"the [load] of the {side}'s scene stands beside teeth of a loop of meshes, whose force the "
            'bearings have a say in: write "replaced", or "added" where it acts beside the teeth',
            path=(*train.shaft_path(side), "scene_load"),
        )
    flanks = [(workshop.on_flank(p.coast), p) for p in train.operation]
    wanted = [_force_on(s, side, mesh_forces(train, s.contacts, p)) for s, p in flanks]
    wanted.append(_force_on(workshop, side, forces))
    if any(np.linalg.norm(own[:3] - f) <= SAME_LOAD * np.linalg.norm(f) for f in wanted):
        return None, [f"the [load] of the {side}'s scene is its mesh force, and is not added"]
    raise SceneError(
        f"the [load] of the {side}'s scene is ({_newtons(own[:3])}) N at its lumped point, and the "
        f"mesh force is ({_newtons(wanted[0])}) N: leave [load] out of the scene, or write "
        f'scene_load = "replaced" under [{".".join(train.shaft_path(side))}], or "added" where it '
        "acts beside the teeth",
        path=(*train.shaft_path(side), "scene_load"),
    )


def _force_on(workshop: Workshop, side: str, forces: Mapping[str, float]) -> np.ndarray:
    """(3,) force of all teeth on a shaft, in the axes of its scene, N; equal planets have none."""
    each = [
        forces[pair.name] * force_on(pair, side, workshop.contacts[pair.name])[:3]
        for pair in workshop.train.pairs
        if side in pair.shafts
    ]
    return np.sum([np.zeros(3), *each], axis=0)


def _newtons(force: np.ndarray) -> str:
    return ", ".join(f"{v:.0f}" for v in force)
