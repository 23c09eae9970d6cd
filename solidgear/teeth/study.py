"""Contact of the teeth of a train at an operating point, mesh by mesh, and over its torque."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np

from solidgear.core import SolidgearError, pinned
from solidgear.core.plain import plain
from solidgear.teeth.mesh_contact import MeshContact
from solidgear.teeth.supports import Carried, with_sections
from solidgear.teeth.train_teeth import TeethModel, mesh_contact, provisional
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train

#: torques of a curve, of that of the operating point
FACTORS = (0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.25, 1.5)


@dataclass(frozen=True, eq=False)
class AtTorque:
    """A mesh at one torque of the operating point's shaft."""

    torque: float  #: of the operating point's shaft, N m
    contact: MeshContact

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
                "skew": self.contact.skew.total,
            }
        )


@dataclass(frozen=True, eq=False)
class TeethStudy:
    """Contact of all meshes of a train with parallel shafts."""

    title: str
    point: OperatingPoint
    meshes: tuple[MeshContact, ...]
    curves: dict[str, tuple[AtTorque, ...]]  #: by mesh, torque ascending; empty without
    stiffness: dict[str, float | None]  #: of each mesh in the file, N/m; None where of teeth
    cautions: tuple[str, ...]
    seconds: float

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        return plain(
            {
                "train": self.title,
                "point": self.point,
                "meshes": {mesh.name: mesh.as_dict() for mesh in self.meshes},
                "curves": {
                    name: [at.as_dict() for at in curve] for name, curve in self.curves.items()
                },
                "file_stiffness": self.stiffness,
                "cautions": self.cautions,
                "seconds": self.seconds,
            }
        )


@pinned
def teeth_study(
    train: Train,
    point: OperatingPoint | None = None,
    *,
    model: TeethModel | None = None,
    factors: Sequence[float] = FACTORS,
    progress: Callable[[str], None] = lambda text: None,
) -> TeethStudy:
    """Solve the contact of all meshes over a mesh cycle, and over the torque.

    Parameters
    ----------
    train : Train
        With parallel shafts.
    point : OperatingPoint, optional
        By default the first of the train.
    model : TeethModel, optional
    factors : sequence of float
        Torques of the curves, of that of the point; none without curves.
    progress : callable
        Is told in words what is solved.

    Raises
    ------
    SolidgearError
        For a train without an operating point or parallel meshes, and teeth that the file does not
        describe.

    Examples
    --------
    >>> import solidgear as sg
    >>> study = teeth_study(sg.load_train("geometry/gearbox_train.toml"), factors=())
    >>> mesh = study.meshes[0]
    >>> bool(mesh.cycle.tangent.mean() > mesh.cycle.secant.mean() > 3e8)
    True
    """
    start, model = perf_counter(), model or TeethModel()
    point = train.point if point is None else point
    if point is None:
        raise SolidgearError(
            f"{train.name} has no torque: teeth touch under a load; give --torque, or [operation] "
            "in the file"
        )
    numbers = {
        pair.name: None if mesh.stiffness == "teeth" else mesh.stiffness
        for pair, mesh in zip(train.pairs, train.meshes)
    }
    sectioned = with_sections(provisional(train))
    carried = Carried.at_rest(sectioned, point)
    pairs = [pair for pair in carried.train.pairs if not pair.mesh.shaft_angle]
    if not pairs:
        raise SolidgearError(f"{train.name} has no mesh of parallel shafts")
    meshes = []
    for pair in pairs:
        progress(f"teeth of the {pair.name}")
        meshes.append(mesh_contact(carried, pair, model))
    curves: dict[str, list[AtTorque]] = {pair.name: [] for pair in pairs} if factors else {}
    for factor in sorted(factors):
        torque = factor * point.torque
        progress(f"teeth at {torque:.4g} N m")
        at = carried if factor == 1 else carried.at(point.with_changes(torque=torque))
        for k, pair in enumerate(pairs):
            solved = meshes[k] if factor == 1 else mesh_contact(at, pair, model)
            curves[pair.name].append(AtTorque(torque, solved))
    return TeethStudy(
        title=train.title or train.name,
        point=point,
        meshes=tuple(meshes),
        curves={name: tuple(curve) for name, curve in curves.items()},
        stiffness=numbers,
        cautions=tuple(carried.state.notes),
        seconds=perf_counter() - start,
    )
