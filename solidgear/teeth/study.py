"""Contact of the teeth of a train at an operating point, mesh by mesh, and over its torque."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from solidgear.core import Sheeted, SolidgearError, Source, explained, pinned
from solidgear.core.plain import plain
from solidgear.strength.acting import Acting, Given
from solidgear.teeth.bars import error_bars
from solidgear.teeth.ladder import Ladder, Solved, ladder
from solidgear.teeth.mesh_contact import MeshContact, SolvedMesh
from solidgear.teeth.supports import Carried, with_sections
from solidgear.teeth.train_teeth import TeethModel, solved_mesh
from solidgear.trains.assembly.mesh_stiffness import with_usual_meshes
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.file.tables import TEETH
from solidgear.trains.file.train import Train
from solidgear.trains.loading import load_train

#: torques of a curve, of that of the operating point
FACTORS = (0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.25, 1.5)


@dataclass(frozen=True, eq=False)
class AtTorque:
    """A mesh at one torque of the operating point's shaft."""

    torque: float  #: of the operating point's shaft, N m
    contact: SolvedMesh

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        cycle = self.contact.cycle
        return plain(
            {
                "torque": self.torque,
                "peak_to_peak": cycle.peak_to_peak,
                "orders": np.abs(cycle.orders(3)),
                "tangent": cycle.tangent.mean(),
                "secant": cycle.secant.mean(),
                "face_load_factor": cycle.face_load_factor,
                "pressure": cycle.pressure,
            }
        )


@dataclass(frozen=True, eq=False, repr=False)
class TeethStudy(Sheeted):
    """Contact of all meshes of a train.

    Attributes
    ----------
    title : str
    point : OperatingPoint
    model : TeethModel
        Of cylindrical teeth; bevel teeth are of slices.
    meshes : tuple of SolvedMesh
        At the operating point.
    curves : dict of str to tuple of AtTorque
        By mesh, torque ascending; empty without.
    stiffness : dict of str to float or None
        Of each mesh in the file, N/m; None where it is that of the teeth.
    bars : dict of str to dict of str to float
        Error bars of the numbers of each mesh, SI, as of :func:`solidgear.teeth.bars.error_bars`; of
        cylindrical teeth.
    ladders : tuple of Ladder
        Models of the teeth side by side, where asked for.
    cautions : tuple of str
    seconds : float

    Examples
    --------
    >>> import solidgear as sg
    >>> coarse = TeethModel(slices=12, positions=8)
    >>> study = sg.contact("geometry/gearbox_train.toml", model=coarse, factors=())
    >>> [mesh.name for mesh in study.meshes], study.stiffness
    (['mesh'], {'mesh': 320000000.0})
    >>> sorted(study.as_dict()["meshes"]["mesh"])[:3]
    ['assumed', 'contact_ratio', 'corner_share']
    """

    sheeted: ClassVar[str] = "teeth.sheet:contact_sheet"

    title: str
    point: OperatingPoint
    model: TeethModel
    meshes: tuple[SolvedMesh, ...]
    curves: dict[str, tuple[AtTorque, ...]]
    stiffness: dict[str, float | None]
    bars: dict[str, dict[str, float]]
    ladders: tuple[Ladder, ...]
    cautions: tuple[str, ...]
    seconds: float

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        return plain(
            {
                "train": self.title,
                "point": self.point,
                "model": self.model.name,
                "meshes": {mesh.name: mesh.as_dict() for mesh in self.meshes},
                "curves": {
                    name: [at.as_dict() for at in curve] for name, curve in self.curves.items()
                },
                "bars": self.bars,
                "file_stiffness": self.stiffness,
                "models": {ladder.mesh: ladder.as_dict() for ladder in self.ladders},
                "cautions": self.cautions,
                "seconds": self.seconds,
            }
        )


@pinned
def contact(
    train: Source | Train,
    point: str | int | OperatingPoint | None = None,
    *,
    torque: Given = None,
    of: str | None = None,
    weight: str | None = None,
    model: TeethModel | None = None,
    factors: Sequence[float] = FACTORS,
    judge: bool = False,
    progress: Callable[[str], None] = lambda text: None,
) -> TeethStudy:
    """Teeth in contact: mesh stiffness, transmission error and load along the face over a mesh cycle,
    and over the torque.

    Parameters
    ----------
    train : path, dict or Train
        A train: its file (TOML), the tables of one, or an object.
    point : str or OperatingPoint, optional
        By name or number; by default the first of the train.
    torque, of, weight
        A torque in place of a point, as of :func:`solidgear.deflect`.
    model : TeethModel, optional
        By default slices.
    factors : sequence of float
        Torques of the curves, of that of the point; none without curves.
    judge : bool
        Whether other models of the teeth are solved as well, and judged by the finest.
    progress : callable
        Called with words on what is solved.

    Returns
    -------
    TeethStudy
        ``meshes`` with their cycles; ``write(folder)`` makes a page, charts and the mesh cycle.

    Raises
    ------
    SolidgearError
        For a train without an operating point or teeth, and teeth that the file does not describe.

    Examples
    --------
    >>> import solidgear as sg
    >>> mesh = sg.contact("geometry/gearbox_train.toml", factors=()).meshes[0]
    >>> bool(mesh.cycle.tangent.mean() > mesh.cycle.secant.mean() > 3e8)
    True
    """
    if isinstance(point, OperatingPoint):
        # as the file has it: an assembly would have the teeth solved already
        at_rest, at = load_train(train), point
    else:
        at_rest, at = Acting(torque, of, point, weight).read_train(train)
    with explained(train):
        return _contact(at_rest, at, model or TeethModel(), factors, judge, progress)


def _contact(
    train: Train,
    point: OperatingPoint,
    model: TeethModel,
    factors: Sequence[float],
    judge: bool,
    progress: Callable[[str], None],
) -> TeethStudy:
    start = perf_counter()
    sectioned = with_sections(with_usual_meshes(train))
    carried = Carried.at_rest(sectioned, point)
    teeth = touching(carried.train)
    meshes, took = [], []
    for mesh in teeth:
        progress(f"teeth of the {mesh.name}")
        begun = perf_counter()
        meshes.append(solved_mesh(carried, mesh, model))
        took.append(perf_counter() - begun)
    curves: dict[str, list[AtTorque]] = {mesh.name: [] for mesh in teeth} if factors else {}
    for factor in sorted(factors):
        torque = factor * point.torque
        progress(f"teeth at {torque:.4g} N m")
        at = carried if factor == 1 else carried.at(point.with_changes(torque=torque))
        for mesh, solved in zip(teeth, meshes):
            contact = solved if factor == 1 else solved_mesh(at, mesh, model)
            curves[mesh.name].append(AtTorque(torque, contact))
    bars: dict[str, dict[str, float]] = {}
    for mesh, solved in zip(teeth, meshes):
        if isinstance(solved, MeshContact):
            progress(f"error bars of the {mesh.name}")
            bars[mesh.name] = error_bars(carried, mesh, model, solved)
    tolerance = train.ask.tolerance
    ladders = [
        ladder(
            carried,
            mesh,
            tolerance,
            model,
            solved={model.name: Solved(solved, seconds, bars[mesh.name])},
            progress=progress,
        )
        for mesh, solved, seconds in zip(teeth, meshes, took)
        if judge and isinstance(solved, MeshContact)
    ]
    return TeethStudy(
        title=train.title or train.name,
        point=point,
        model=model,
        meshes=tuple(meshes),
        curves={name: tuple(curve) for name, curve in curves.items()},
        stiffness={mesh.name: stated_stiffness(train, mesh.name) for mesh in teeth},
        bars=bars,
        ladders=tuple(ladders),
        cautions=(*carried.state.notes, *(line for mesh in meshes for line in mesh.cautions)),
        seconds=perf_counter() - start,
    )


def touching(train: Train) -> list[Pair | PlanetMesh]:
    """Return the meshes of pairs, and of planets those of the first; refused without any."""
    planets = [mesh for stage in train.stages for mesh in stage.meshes if mesh.planets == (1,)]
    if not (train.pairs or planets):
        raise SolidgearError(f"{train.name} has no teeth in mesh")
    return [*train.pairs, *planets]


def stated_stiffness(train: Train, name: str) -> float | None:
    """Return the stiffness that the file gives a mesh, N/m; None where it is that of the teeth."""
    mesh = next(mesh for mesh in train.teeth if mesh.name == name)
    key = f"{mesh.mate}_stiffness" if isinstance(mesh, PlanetMesh) else "stiffness"
    stiffness = getattr(mesh.mesh, key)
    return None if stiffness == TEETH else stiffness
