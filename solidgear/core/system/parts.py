"""Parts of a system: anything with a mass, strain rows and ports.

A part kind is one class with the three attributes of :class:`Part`; nothing else needs to know of
it. :class:`solidgear.core.reduction.Superelement` is one; here are the simpler ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from solidgear.core.body import Body
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import DOF_NAMES, shift
from solidgear.core.reduction.superelement import PortMotion, Truncation
from solidgear.core.system.matrices import frozen, positive, spd


class Part(Protocol):
    """Interface of a part with n coordinates.

    A part that stands for more than the coordinates may further have ``truncation``, a
    :class:`solidgear.core.reduction.superelement.Truncation`: frequencies then come with their bound.
    One that has something to draw may have ``expand(coordinates)``.
    """

    @property
    def mass(self) -> np.ndarray:
        """(n, n) symmetric positive definite."""

    @property
    def strain(self) -> np.ndarray:
        """(r, n) rows S with ``S'S`` the stiffness; none for a rigid part."""

    @property
    def ports(self) -> Mapping[str, PortMotion]:
        """Places where links can act, by name."""


@dataclass(frozen=True, eq=False)
class RigidBody:
    """A mass with ports that move rigidly with it.

    Attributes
    ----------
    mass : (6, 6) array_like
        Symmetric positive definite, at the origin of the part, order x y z thx thy thz, SI.
    points : mapping of str to (3,) array_like
        Ports and where they are, m; by default one, ``centre``, at the origin.

    Examples
    --------
    >>> import numpy as np
    >>> disc = RigidBody(np.diag([5, 5, 5, 0.01, 0.02, 0.01]), {"rim": (0.1, 0, 0)})
    >>> disc.ports["rim"].rows[2] + 0.0    # rises with the disc, falls as it turns about y
    array([ 0. ,  0. ,  1. ,  0. , -0.1,  0. ])
    """

    mass: np.ndarray
    points: Mapping[str, ArrayLike] = field(default_factory=lambda: {"centre": (0.0, 0.0, 0.0)})

    def __post_init__(self):
        object.__setattr__(self, "mass", spd("the mass of a rigid body", self.mass))

    @classmethod
    def of(cls, body: Body) -> RigidBody:
        """Return the rigid limit of a body: the mass about the origin of the scene, and the ports."""
        points = {p.name: (0.0, p.y, 0.0) for p in body.ports}
        return cls(body.mass_matrix(), points)

    @property
    def strain(self) -> np.ndarray:
        """(0, 6): nothing gives."""
        return np.zeros((0, 6))

    @cached_property
    def ports(self) -> Mapping[str, PortMotion]:
        """Of all points, in the axes of the part."""
        out = {}
        for name, point in self.points.items():
            place = frozen(f"the point {name!r}", point, (3,))
            out[name] = PortMotion(shift(place), place, np.eye(3))
        return out


@dataclass(frozen=True, eq=False)
class Inertia:
    """A single degree of freedom with a mass: an engine, a load.

    Attributes
    ----------
    value : float
        kg m^2 of a rotation, kg of a translation.
    dof : str
        Which of x y z thx thy thz.

    Examples
    --------
    >>> Inertia(2.5).ports["end"].rows[:, 0]
    array([0., 0., 0., 0., 1., 0.])
    """

    value: float
    dof: str = "thy"

    def __post_init__(self):
        if self.dof not in DOF_NAMES:
            raise SolidgearError(
                f"an inertia in {self.dof!r}; its motion is one of {' '.join(DOF_NAMES)}"
            )
        positive("an inertia", self.value)

    @property
    def mass(self) -> np.ndarray:
        """(1, 1)."""
        return np.array([[float(self.value)]])

    @property
    def strain(self) -> np.ndarray:
        """(0, 1): nothing gives."""
        return np.zeros((0, 1))

    @property
    def ports(self) -> Mapping[str, PortMotion]:
        """One, ``end``."""
        rows = np.eye(6)[:, [DOF_NAMES.index(self.dof)]]
        return {"end": PortMotion(rows, np.zeros(3), np.eye(3))}


@dataclass(frozen=True, eq=False)
class PlanarBody:
    """A rigid body that moves across an axis and turns about it: x, z and thy.

    Examples
    --------
    >>> import numpy as np
    >>> carrier = PlanarBody(np.diag([5.0, 5.0, 0.05]), {"pin": (0.1, 0, 0)})
    >>> carrier.ports["pin"].rows[2] + 0.0     # z of the pin
    array([ 0. ,  1. , -0.1])
    """

    #: (3, 3) symmetric positive definite, at the origin of the part, order x z thy, kg and kg m^2
    mass: np.ndarray
    #: ports and where they are, m; by default one, ``centre``, on the axis
    points: Mapping[str, ArrayLike] = field(default_factory=lambda: {"centre": (0.0, 0.0, 0.0)})

    def __post_init__(self):
        object.__setattr__(self, "mass", frozen("the mass of a planar body", self.mass, (3, 3)))

    @property
    def strain(self) -> np.ndarray:
        """(0, 3): nothing gives."""
        return np.zeros((0, 3))

    @cached_property
    def ports(self) -> Mapping[str, PortMotion]:
        """Of all points, in the axes of the part."""
        full = RigidBody(np.eye(6), self.points).ports
        return {
            name: PortMotion(port.rows[:, [0, 2, 4]], port.point, port.axes)
            for name, port in full.items()
        }


@dataclass(frozen=True, eq=False)
class Placed:
    """A part somewhere else: turned, then moved.

    Ports keep their own axes, so that vectors on a part stay in the part's own frame.

    Attributes
    ----------
    part : Part
    rotation : (3, 3) array_like
        The axes of the part as columns.
    origin : (3,) array_like
        Its origin, m.

    Examples
    --------
    >>> import numpy as np
    >>> across = Placed(Inertia(1.0), [[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    >>> across.ports["end"].axes[:, 1]      # its y axis points along -x
    array([-1.,  0.,  0.])
    """

    part: Part
    rotation: np.ndarray = field(default_factory=lambda: np.eye(3))
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self):
        turn = frozen("the rotation of a part", self.rotation, (3, 3))
        error = np.abs(turn.T @ turn - np.eye(3)).max()
        if error > 1e-9 or np.linalg.det(turn) < 0:
            raise SolidgearError(
                "the rotation of a part must be a right-handed orthogonal matrix, within 1e-9"
            )
        object.__setattr__(self, "rotation", turn)
        object.__setattr__(self, "origin", frozen("the origin of a part", self.origin, (3,)))

    @property
    def mass(self) -> np.ndarray:
        """That of the part."""
        return self.part.mass

    @property
    def strain(self) -> np.ndarray:
        """That of the part."""
        return self.part.strain

    @property
    def truncation(self) -> Truncation | None:
        """That of the part."""
        return getattr(self.part, "truncation", None)

    @property
    def ports(self) -> Mapping[str, PortMotion]:
        """Ports of the part, at their new places."""
        return {
            name: PortMotion(p.rows, self.origin + self.rotation @ p.point, self.rotation @ p.axes)
            for name, p in self.part.ports.items()
        }

    def expand(self, coordinates: np.ndarray) -> dict[int, np.ndarray]:
        """Return the motion of the mesh of the part, in the frame of the part."""
        return self.part.expand(coordinates)  # type: ignore[attr-defined]
