"""Housing under the bearings of a train, with mass and mounts: data only.

Everything is in the axes of the train, which are those of the first shaft's scene.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BeforeValidator, Field, InstanceOf, model_validator

from solidgear.core import Model, SceneError, Written, listed, nearest
from solidgear.core.reduction.port_matrices import CENTRE, PortMatrices
from solidgear.core.scene.bearing_stiffness import Matrix
from solidgear.core.scene.stations import Status
from solidgear.core.scene.units import TYPED, Loss, Mass, Product, quantity
from solidgear.trains.file.matrix_keys import PointNode, WithMatrices
from solidgear.trains.file.mesh_cycle import Vector

#: name of the housing among the parts of a train
HOUSING = "housing"
#: loss factor of castings with their joints, where none is given
LOSS = 0.01


def _inertia(value: Any) -> tuple[tuple[float, ...], ...]:
    """Return a tensor of inertia, kg m^2, from its rows or the three moments about the axes."""
    rows = value.tolist() if isinstance(value, np.ndarray) else value
    form = "three moments of inertia about x, y and z, or three rows of three"
    if not isinstance(rows, (list, tuple)) or len(rows) != 3:
        raise SceneError(f"must be {form}")
    if not any(isinstance(row, (list, tuple)) for row in rows):
        rows = [[moment if j == k else 0.0 for j in range(3)] for k, moment in enumerate(rows)]
    if any(not isinstance(row, (list, tuple)) or len(row) != 3 for row in rows):
        raise SceneError(f"must be {form}")
    tensor = np.array([[quantity(entry, "inertia") for entry in row] for row in rows])
    if np.abs(tensor - tensor.T).max() > 1e-9 * np.abs(tensor).max():
        raise SceneError("is not symmetric; products of inertia stand on both sides alike")
    least, middle, most = np.linalg.eigvalsh(tensor)
    if least <= 0:
        raise SceneError(
            f"has a principal moment of {least:.4g} kg m^2; all three must be greater than zero"
        )
    if most > (1 + TYPED) * (least + middle):
        raise SceneError(
            f"has principal moments of {least:.4g}, {middle:.4g} and {most:.4g} kg m^2; the "
            "largest must not be more than the sum of the others"
        )
    return tuple(tuple(row) for row in tensor.tolist())


#: three moments, or a row of three
Triple = Annotated[list[Product], Field(min_length=3, max_length=3)]


class Mount(Model):
    """A spring between the housing and ground."""

    needs: ClassVar = (("at", "position"),)

    #: name; by default its number, counted from one
    name: str = ""
    #: place of the mount on a rigid housing, m
    position: Vector | None = None
    #: point of the housing that it stands at, in place of a position
    at: str | None = None
    #: 6x6 about its place, SI; named entries or six rows
    stiffness: Matrix
    #: loss factor, twice a damping ratio
    loss: Loss = 0.1
    #: source of the stiffness
    status: Status = "assumed"

    @model_validator(mode="after")
    def _holds(self):
        if (self.at is None) == (self.position is None):
            reason = "give its place: position, or at = a point of the housing"
            raise SceneError(reason, path=("position",))
        if not np.any(self.stiffness):
            reason = "holds nothing; write entries such as {kxx = ..., kyy = ..., kzz = ...}"
            raise SceneError(reason, path=("stiffness",))
        return self


class TrainHousing(WithMatrices):
    """A body that carries the bearings of shafts, on mounts to ground: rigid, or of matrices.

    Examples
    --------
    >>> mount = Mount(position=("0 mm", "0 mm", "-150 mm"), stiffness={"kzz": "2e7 N/m"})
    >>> box = TrainHousing(mass="85 kg", inertia=(3.1, 2.2, 2.9), centre=(0, 0.1, 0), mount=(mount,))
    >>> list(box.mounted), box.mass_matrix.diagonal()
    (['1'], array([85. , 85. , 85. ,  3.1,  2.2,  2.9]))
    """

    needs: ClassVar = (("matrices", ("mass", "inertia", "centre")),)

    #: file of the matrices of an elastic housing; mass, inertia and centre are then theirs
    matrices: Annotated[InstanceOf[PortMatrices] | None, Written(str)] = Field(
        None, exclude=True, repr=False
    )
    #: mass of a rigid housing, kg
    mass: Mass
    #: moments of inertia about x, y and z through its centre of mass, kg m^2, or three rows of
    #: three
    inertia: Annotated[
        tuple[tuple[float, ...], ...], BeforeValidator(_inertia), Written(Triple | list[Triple])
    ]
    #: centre of mass, m
    centre: Vector
    #: loss factor of an elastic housing, 0.01 by default
    loss: Loss | None = None
    #: shafts whose bearings stand in it, and with them rings of planetary stages; all by default
    carries: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    #: springs between the housing and ground
    mounts: tuple[Mount, ...] = Field((), alias="mount")
    #: places of a rigid housing whose motion is given, by name, m, or the nodes of the file of
    #: matrices
    points: Annotated[dict[str, Vector], Written(dict[str, Vector | PointNode])] = {}
    #: source of mass and inertia
    status: Status = "assumed"

    def __init__(self, /, **data: Any):
        if isinstance(matrices := data.get("matrices"), PortMatrices):
            _ = matrices.elastic  # which refuses a body that is held
            rigid_mass = matrices.rigid_mass
            mass_fields = {"mass": float(rigid_mass[0, 0]), "inertia": rigid_mass[3:, 3:].tolist()}
            data |= mass_fields | {"centre": tuple(matrices.centre.tolist()), "points": {}}
        super().__init__(**data)

    @model_validator(mode="after")
    def _named_once(self):
        if self.loss is not None and self.matrices is None:
            raise SceneError(
                "belongs to an elastic housing; a rigid one has no losses", path=("loss",)
            )
        places, names = [*self.point_places], [CENTRE]
        for k, mount in enumerate(self.mounts):
            if mount.at is not None and mount.at not in places:
                reason = f"names no point of the housing{nearest(mount.at, places)}; known here: "
                raise SceneError(reason + listed(places), path=("mount", k, "at"))
            if mount.at is None and self.matrices is not None:
                reason = f"stands at a point of the matrices: write at, one of {listed(places)}"
                raise SceneError(reason, path=("mount", k, "position"))
        mount_names = [(("mount", k, "name"), name) for k, name in enumerate(self.mounted)]
        for path, name in [*mount_names, *((("points", name), name) for name in self.points)]:
            if name in names or "." in name or not name.strip():
                reason = (
                    f"{name!r} cannot name it: mounts and points have names of their own, without "
                    f"dots, and {CENTRE!r} is the centre of mass"
                )
                raise SceneError(reason, path=path)
            names.append(name)
        return self

    @property
    def point_places(self) -> Mapping[str, tuple[float, ...]]:
        """Points by name, m, without the centre of mass."""
        if self.matrices is None:
            return self.points
        return {name: tuple(place.tolist()) for name, place in self.matrices.positions.items()}

    @property
    def mounted(self) -> dict[str, Mount]:
        """Mounts by name."""
        return {mount.name or str(k): mount for k, mount in enumerate(self.mounts, start=1)}

    @property
    def feet(self) -> dict[str, str]:
        """Points that mounts stand at, by name of the mount."""
        return {name: mount.at or name for name, mount in self.mounted.items()}

    def foot(self, name: str) -> tuple[float, ...]:
        """Return the place of a mount, m."""
        mount = self.mounted[name]
        return tuple(mount.position or map(float, self.point_places[mount.at or ""]))

    @property
    def free_points(self) -> list[str]:
        """Points whose motion is reported: all without a bearing or a mount."""
        return [
            CENTRE,
            *(n for n in self.point_places if "." not in n and n not in self.feet.values()),
        ]

    @property
    def mass_matrix(self) -> np.ndarray:
        """(6, 6) about the centre of mass."""
        out = self.mass * np.eye(6)
        out[3:, 3:] = self.inertia
        return out

    @property
    def places(self) -> dict[str, np.ndarray]:
        """(3,) places of all points of a rigid housing from the centre of mass, m."""
        mounts = {name: mount.position for name, mount in self.mounted.items() if mount.at is None}
        points = {CENTRE: self.centre, **mounts, **self.points}
        return {name: np.subtract(place, self.centre) for name, place in points.items()}
