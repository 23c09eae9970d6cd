"""Mesh stiffness that comes from teeth in contact: where it holds, and how it changes with the load."""

from __future__ import annotations

from dataclasses import dataclass

from solidgear.show.units import Units
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.tables import TEETH


@dataclass(frozen=True)
class ToothStiffness:
    """Stiffness of one mesh by its teeth."""

    mesh: str
    points: tuple[OperatingPoint, ...]  #: that of the train first
    stiffness: tuple[float, ...]  #: at each point, N/m
    #: ``estimated`` where cutter or mismatch of bevel teeth are, else ``calculated``
    status: str

    def sentence(self, units: Units) -> str:
        """Return what it is, at which load, and what it is at the others."""
        (first, *points), (stiffness, *values) = self.points, self.stiffness
        mesh = "Mesh stiffness" if self.mesh == "mesh" else f"Stiffness of the {self.mesh}"
        text = (
            f"{mesh} {self.status} from the teeth at {first.label}: {units.text(stiffness, 'N/m', 3)}, "
            "without shafts and bearings."
        )
        if points:
            changes = [
                f"{100 * (value / stiffness - 1):+.0f} % at {point.label}"
                for point, value in zip(points, values)
            ]
            text += f" It would be {', '.join(changes)}."
        return text


def tooth_stiffness(assembly: Assembly, everywhere: bool = True) -> tuple[ToothStiffness, ...]:
    """Return the stiffness of every mesh whose teeth give it, at all operating points of the train or at
    the one that it stands at; of planets those of the first.
    """
    train, of_train = assembly.asked_train, _of_train(assembly)
    if not of_train:
        return ()
    further = [_of_train(assembly.at(point)) for point in train.operation[1:] if everywhere]
    meshes = []
    for name, (stiffness, status) in of_train.items():
        values = (stiffness, *(at_point[name][0] for at_point in further))
        meshes.append(ToothStiffness(name, train.operation[: len(values)], values, status))
    return tuple(meshes)


def _of_train(assembly: Assembly) -> dict[str, tuple[float, str]]:
    """Return the stiffness that the train has of its teeth, N/m, and its status, by mesh."""
    statuses = {pair.name: pair.mesh.status for pair in assembly.train.pairs}
    out = {
        pair.name: (assembly.contacts[pair.name].stiffness, str(statuses[pair.name]))
        for pair in assembly.asked_train.pairs
        if pair.mesh.stiffness == TEETH
    }
    solved = {mesh.name: mesh for stage in assembly.train.stages for mesh in stage.meshes}
    for stage in assembly.asked_train.stages:
        for mesh in stage.meshes:
            asked = getattr(mesh.mesh, f"{mesh.mate}_stiffness")
            if mesh.planets == (1,) and asked == TEETH:
                planets = solved[mesh.name]
                out[mesh.name] = float(planets.stiffness), str(planets.mesh.status)
    return out


def of_teeth(assembly: Assembly, units: Units) -> list[str]:
    """Return a sentence for every mesh whose teeth give its stiffness, where the train stands."""
    return [mesh.sentence(units) for mesh in tooth_stiffness(assembly, everywhere=False)]
