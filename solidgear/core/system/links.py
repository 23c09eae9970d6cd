"""Links between parts: springs between ports of any two parts, or of one and ground.

A link kind is one class with the two members of :class:`Link`; nothing else needs to know of it. A
spring gives *strain rows* g on the coordinates of the system: the stiffness is ``g'g``, the energy
the square of the stretch ``g q`` over two. So no spring has to cancel another, and a motion that no
row touches is free, exactly.

Ends are written ``part.port``; a part with one port may be named alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from solidgear.core.body import Supports, as_supports
from solidgear.core.body.supports import Holding
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import DOF_NAMES
from solidgear.core.reduction.superelement import PortMotion
from solidgear.core.system.gear_mesh import MeshVector
from solidgear.core.system.law import Law
from solidgear.core.system.matrices import frozen, not_negative, spd


class Link(Protocol):
    """Interface of a link.

    A link that carries mass may further have ``mass(*ends)``, (N, N) positive semidefinite.
    """

    @property
    def ends(self) -> tuple[str, ...]:
        """Ports it acts on, each ``part.port``; ground needs none."""

    def strain(self, *ends: PortMotion) -> np.ndarray:
        """Return (r, N) strain rows from the motion of every end, on the coordinates of the system."""


@dataclass(frozen=True, eq=False)
class BearingSpring:
    """A 6x6 spring between a port and ground, or a port of another part.

    Attributes
    ----------
    at : str
    stiffness : (6, 6) array_like
        Symmetric positive semidefinite, in the axes and at the point of `at`, SI.
    to : str, optional
        The other port, whose part is carried rigidly to the point of the first; ground without it.

    Examples
    --------
    >>> import numpy as np
    >>> import solidgear as sg
    >>> flywheel = sg.RigidBody(np.diag([2.0, 2.0, 2.0, 0.01, 0.02, 0.01]), {"hub": (0, 0, 0)})
    >>> held = sg.BearingSpring("flywheel.hub", np.diag([8e6, 8e6, 8e6, 0.0, 0.0, 0.0]))
    >>> modes = sg.System({"flywheel": flywheel}, {"bearing": held}).modes(6)
    >>> np.round(modes.frequency_hz * 2 * np.pi)  # three rotations are free; sqrt(8e6 / 2) = 2000
    array([   0.,    0.,    0., 2000., 2000., 2000.])
    """

    at: str
    stiffness: np.ndarray
    to: str | None = None

    def __post_init__(self):
        stiffness = spd(f"the stiffness of the spring at {self.at}", self.stiffness, definite=False)
        object.__setattr__(self, "stiffness", stiffness)

    @property
    def ends(self) -> tuple[str, ...]:
        """One or two ports."""
        return (self.at,) if self.to is None else (self.at, self.to)

    def strain(self, *ends: PortMotion) -> np.ndarray:
        """Return the root of the stiffness times the motion of one end relative to the other."""
        return Supports(("spring",), self.stiffness).root.T @ relative_motion(*ends)


def relative_motion(port: PortMotion, *bases: PortMotion) -> np.ndarray:
    """Return (6, N) motion of a port against others, carried to it rigidly."""
    motion = port.rows
    for base in bases:
        motion = motion - base.seen_from(port)
    return motion


@dataclass(frozen=True, eq=False)
class RowSpring:
    """A spring on one combination of the motions of a port, or of two.

    Its stretch is ``row @ motion of at - to_row @ motion of to``, each motion in its own port's
    axes.  :func:`torsion_spring` and :func:`mesh_spring` are such springs.

    Attributes
    ----------
    at : str
    row : (6,) or (r, 6) array_like
        Several rows are as many springs.
    stiffness : float
        N per unit of stretch.
    to : str, optional
        Ground without it.
    to_row : array_like, optional
        By default ``row``.
    law : Law, optional
        Force over stretch where motions are large; `stiffness` is its tangent at the operating point.

    Examples
    --------
    >>> import solidgear as sg
    >>> diagonal = sg.RowSpring("shaft.end", [1, 0, 1, 0, 0, 0], 1e6)  # resists x + z
    >>> diagonal.ends
    ('shaft.end',)
    """

    at: str
    row: ArrayLike
    stiffness: float = 1.0
    to: str | None = None
    to_row: ArrayLike | None = None
    law: Law | None = None

    def __post_init__(self):
        name = f"the spring at {self.at}"
        not_negative(f"the stiffness of {name}", self.stiffness)
        for field in ("row", "to_row"):
            rows_given = getattr(self, field)
            if rows_given is None:
                continue
            rows = np.atleast_2d(np.asarray(rows_given, float))
            object.__setattr__(self, field, frozen(f"the row of {name}", rows, (len(rows), 6)))

    @property
    def ends(self) -> tuple[str, ...]:
        """One or two ports."""
        return (self.at,) if self.to is None else (self.at, self.to)

    def stretch(self, *ends: PortMotion) -> np.ndarray:
        """Return (r, N) rows of the stretch itself, m."""
        stretch = self.row @ ends[0].rows
        if len(ends) > 1:
            stretch = stretch - (self.row if self.to_row is None else self.to_row) @ ends[1].rows
        return stretch

    def strain(self, *ends: PortMotion) -> np.ndarray:
        """Return the root of the stiffness times the stretch; no row for no stiffness."""
        stretch = self.stretch(*ends)
        return np.sqrt(self.stiffness) * stretch if self.stiffness > 0 else stretch[:0]


def torsion_spring(at: str, stiffness: float, to: str | None = None, dof: str = "thy") -> RowSpring:
    """Return a spring on one component of a port, against the same of another or ground.

    Parameters
    ----------
    at : str
    stiffness : float
        N m/rad, or N/m for a translation.
    to : str, optional
    dof : str
        Which of x y z thx thy thz, in each port's own axes.

    Raises
    ------
    SolidgearError
        For another name of a motion.

    Examples
    --------
    >>> import numpy as np
    >>> import solidgear as sg
    >>> engine, load = sg.Inertia(0.02, "thy"), sg.Inertia(0.08, "thy")
    >>> coupling = sg.torsion_spring("engine", 1.6e4, "load")
    >>> modes = sg.System({"engine": engine, "load": load}, {"coupling": coupling}).modes(2)
    >>> np.round(modes.frequency_hz * 2 * np.pi)  # sqrt(1.6e4 (1 / 0.02 + 1 / 0.08)) = 1000
    array([   0., 1000.])
    """
    if dof not in DOF_NAMES:
        raise SolidgearError(f"a spring in {dof!r}; its motion is one of {' '.join(DOF_NAMES)}")
    return RowSpring(at, np.eye(6)[DOF_NAMES.index(dof)], stiffness, to)


def mesh_spring(
    pinion: str, pinion_mesh: MeshVector, gear: str, gear_mesh: MeshVector, stiffness: float
) -> RowSpring:
    """Return the teeth of two gears: a spring on their transmission error ``h_p q_p - h_g q_g``.

    Parameters
    ----------
    pinion, gear : str
        Ports.
    pinion_mesh, gear_mesh : MeshVector
        Each in the axes of its own port, of *one* physical direction.
    stiffness : float
        N/m.

    Examples
    --------
    >>> import solidgear as sg
    >>> down = sg.MeshVector([0, 0, -1], [0.05, 0, 0])  # at a lever of 50 mm
    >>> mesh = sg.mesh_spring("pinion.pinion", down, "gear.gear", down, 4e8)
    >>> mesh.ends
    ('pinion.pinion', 'gear.gear')

    References
    ----------
    Hua (2010), equations 21 to 23.
    """
    return RowSpring(pinion, pinion_mesh.vector, stiffness, gear, gear_mesh.vector)


@dataclass(frozen=True, eq=False)
class PortInertia:
    """A rigid mass fixed to a port: a coupling, a gear blank, a sensor.

    Attributes
    ----------
    at : str
    matrix : (6, 6) array_like
        Symmetric positive semidefinite, in the axes and at the point of the port.

    Examples
    --------
    >>> import numpy as np
    >>> import solidgear as sg
    >>> blank = sg.PortInertia("shaft.pinion", np.diag([4.0, 4.0, 4.0, 0.02, 0.03, 0.02]))
    >>> blank.ends
    ('shaft.pinion',)
    """

    at: str
    matrix: np.ndarray

    def __post_init__(self):
        checked = spd(f"the inertia at {self.at}", self.matrix, definite=False)
        object.__setattr__(self, "matrix", checked)

    @property
    def ends(self) -> tuple[str, ...]:
        """The port."""
        return (self.at,)

    def strain(self, *ends: PortMotion) -> np.ndarray:
        """Return (0, N): nothing gives."""
        return np.zeros((0, ends[0].rows.shape[1]))

    def mass(self, *ends: PortMotion) -> np.ndarray:
        """Return a matrix (N, N)."""
        return ends[0].rows.T @ self.matrix @ ends[0].rows


@dataclass(frozen=True, eq=False)
class HousedSprings:
    """Springs of several ports to ground that act on one another, such as bearings in one housing."""

    at: tuple[str, ...]
    supports: Supports  #: of as many ports, in their order

    @property
    def ends(self) -> tuple[str, ...]:
        """All ports."""
        return self.at

    def strain(self, *ends: PortMotion) -> np.ndarray:
        """Return the root of the common stiffness times all motions."""
        return self.supports.root.T @ np.vstack([end.rows for end in ends])


def grounded(part: str, supports: Holding) -> dict[str, Link]:
    """Return supports of one shaft as links to ground.

    Parameters
    ----------
    part : str
        Name of the part in the system; its ports have the names that the supports use.
    supports : Supports, Scene or iterable of bearings
        A scene brings its housing spring along, which makes one link of all bearings.

    Returns
    -------
    dict of str to Link
        One a bearing, called ``part.port``, none for a bearing without stiffness, which is a free
        station; or ``part.bearings`` for all where they act on one another. And one a mass on a
        port, called ``part.port.mass``.

    Examples
    --------
    >>> import solidgear as sg
    >>> list(sg.grounded("shaft", sg.load("geometry/shaft_stepped.toml")))
    ['shaft.A', 'shaft.B']
    """
    supports = as_supports(supports)
    ends = tuple(f"{part}.{name}" for name in supports.ports)
    k = np.array(supports.stiffness)
    by_end = {end: k[6 * i : 6 * i + 6, 6 * i : 6 * i + 6].copy() for i, end in enumerate(ends)}
    for i in range(len(ends)):
        k[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = 0.0
    masses: dict[str, Link] = {}
    for i, end in enumerate(ends):
        inertia = supports.masses[6 * i : 6 * i + 6, 6 * i : 6 * i + 6]
        if inertia.any():
            masses[f"{end}.mass"] = PortInertia(end, inertia)
    if k.any():
        return {f"{part}.bearings": HousedSprings(ends, supports), **masses}
    springs = {end: BearingSpring(end, matrix) for end, matrix in by_end.items() if matrix.any()}
    return {**springs, **masses}
