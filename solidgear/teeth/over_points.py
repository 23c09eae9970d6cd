"""Stiffness of the teeth of a train at all of its operating points."""

from __future__ import annotations

from solidgear.teeth.supports import Carried, with_sections
from solidgear.teeth.train_teeth import solved_mesh
from solidgear.trains.assembly.mesh_stiffness import with_usual_meshes
from solidgear.trains.file.tables import TEETH
from solidgear.trains.file.train import Train


def stiffness_over_points(train: Train) -> dict[str, tuple[float, ...]]:
    """Return the tangent stiffness of every pair with ``stiffness = "teeth"`` at each operating point
    of a train, N/m, by mesh.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/gearbox_train.toml")
    >>> mesh = train.meshes[0].with_changes(stiffness="teeth")
    >>> full, coast = stiffness_over_points(train.with_changes(meshes=(mesh,)))["mesh"]
    >>> 2e9 > full > coast > 5e8
    True
    """
    names = [pair.name for pair in train.pairs if pair.mesh.stiffness == TEETH]
    if not names:
        return {}
    first, *further = train.operation
    carried = Carried.at_rest(with_sections(with_usual_meshes(train)), first)
    states = [carried, *(carried.at(point) for point in further)]
    return {
        pair.name: tuple(float(solved_mesh(state, pair).cycle.tangent.mean()) for state in states)
        for pair in carried.train.pairs
        if pair.name in names
    }
