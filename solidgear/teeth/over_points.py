"""Stiffness of the teeth of a train at all of its operating points."""

from __future__ import annotations

from solidgear.teeth.study import stated_stiffness, touching
from solidgear.teeth.supports import Carried, with_sections
from solidgear.teeth.train_teeth import solved_mesh
from solidgear.trains.assembly.mesh_stiffness import asks_for_teeth, with_usual_meshes
from solidgear.trains.file.train import Train


def stiffness_over_points(train: Train) -> dict[str, tuple[float, ...]]:
    """Return the tangent stiffness of every mesh with ``stiffness = "teeth"`` at each operating point
    of a train, N/m, by mesh; of planets those of the first.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/gearbox_train.toml")
    >>> mesh = train.meshes[0].with_changes(stiffness="teeth")
    >>> full, coast = stiffness_over_points(train.with_changes(meshes=(mesh,)))["mesh"]
    >>> 2e9 > full > coast > 5e8
    True
    """
    if not asks_for_teeth(train):
        return {}
    first, *further = train.operation
    carried = Carried.at_rest(with_sections(with_usual_meshes(train)), first)
    states = [carried, *(carried.at(point) for point in further)]
    return {
        mesh.name: tuple(float(solved_mesh(state, mesh).cycle.tangent.mean()) for state in states)
        for mesh in touching(carried.train)
        if stated_stiffness(train, mesh.name) is None
    }
