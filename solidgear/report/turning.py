"""Mode shapes ready to be turned: what a viewer draws of a body, in comparable planes and signs.

The two shapes of a pair span a plane of shapes, and which two a solver gives is chance. Drawn is the
one that is symmetric about the plane of y and z, so that models side by side bend the same way.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from solidgear.body.mode_names import meant
from solidgear.errors import SolidgearError
from solidgear.report.packing import Mesh, mesh_of

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.solve.modes import Mode, ModeSet

#: slices along the axis in which the motions of two models are compared
SLICES = 12
#: a body of several turns about its axis if the mean square of that is so many times that of the rest
TURNS = 10.0


@dataclass(frozen=True, eq=False)
class Shape:
    """One mode as it is drawn.

    Attributes
    ----------
    name : str
        Such as ``bending 1``.
    frequency_hz : float
    pair : bool
        Whether there is a second shape at this frequency.
    twists : bool
        Whether sections turn about the axis: drawn enlarged, they are turned, and do not swell.
    displacement : (n, 3) ndarray
        At the points of the mesh; the largest has length 1, of all bodies that move in the mode.
    """

    name: str
    frequency_hz: float
    pair: bool
    twists: bool
    displacement: np.ndarray


@dataclass(frozen=True, eq=False)
class Turned:
    """One body with its elastic modes.

    Attributes
    ----------
    title : str
        Of the model, such as ``harmonic solid``.
    mesh : Mesh
    shapes : tuple of Shape
        In ascending order of frequency; rigid motions are left out.
    rotation : (3, 3) ndarray
        From the axes of the body, in which its mesh and shapes are, to those of the picture.
    origin : (3,) ndarray
        Of its axes in those of the picture, m.
    along : tuple of Turned
        Further bodies that move in the same modes, as the other shaft of a train does.
    """

    title: str
    mesh: Mesh
    shapes: tuple[Shape, ...]
    rotation: np.ndarray = field(default_factory=lambda: np.eye(3))
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    along: tuple[Turned, ...] = ()

    def index(self, name: str) -> int:
        """Place of the shape of that name, also where bending is named by its plane; -1 if none."""
        names = [shape.name for shape in self.shapes]
        plain = name.replace("bending z ", "bending ").replace("bending x ", "bending ")
        found = [meant(wanted, names) for wanted in (name, plain)]
        return next((place for place in found if place is not None), -1)


def turned(
    body: Body,
    modes: ModeSet | Iterable[Mode],
    title: str = "",
    like: Sequence[Turned] = (),
) -> Turned:
    """Surface and mode shapes of a body for :func:`solidgear.report.viewer.viewer_fragment`.

    Parameters
    ----------
    body : Body
    modes : ModeSet or iterable of Mode
    title : str, optional
        The body's fidelity by default.
    like : sequence of Turned, optional
        Models beside it: a shape takes the sign of theirs of the same name.

    Returns
    -------
    Turned

    Raises
    ------
    SolidgearError
        For a body that carries no geometry, modes of another body, or none that is elastic.
    """
    chosen: Any = getattr(modes, "modes", modes)
    elastic = [mode for mode in chosen if mode.frequency_hz > 0]
    if not elastic:
        raise SolidgearError(f"the {body.fidelity} body has no elastic mode to draw")
    mesh = mesh_of(body.surface({}))
    shapes = []
    for mode in elastic:
        moved = _drawn(body, mode, mesh)
        moved *= _sign(mesh.points, moved, _partner(mode.name, like))
        pair, twists = len(mode.vectors) > 1, mode.family == "torsion"
        shapes.append(Shape(mode.name, mode.frequency_hz, pair, twists, moved))
    return Turned(title or body.fidelity, mesh, tuple(shapes))


def _drawn(body: Body, mode: Mode, mesh: Mesh) -> np.ndarray:
    """The displacement of a mode at the points, the largest of length 1."""
    moved = [body.surface(vectors).displacement[mesh.source] for vectors in mode.vectors[:2]]
    out = moved[0] if len(moved) == 1 else symmetric(mesh.points, *moved)
    largest = np.linalg.norm(out, axis=1).max()
    if not np.isfinite(largest) or not largest > 0:
        raise SolidgearError(
            f"mode {mode.name!r} of the {body.fidelity} body: the displacement is zero or not finite"
        )
    return out / largest


class Member(NamedTuple):
    """A body among several that move together.

    Attributes
    ----------
    body : Body
    rotation : (3, 3) ndarray
    origin : (3,) ndarray
        As of :class:`Turned`.
    vectors : sequence of mapping
        What :meth:`Body.surface` draws, a mode each.
    """

    body: Body
    rotation: np.ndarray
    origin: np.ndarray
    vectors: Sequence[Any]


def together(
    title: str,
    modes: Sequence[tuple[str, float]],
    members: Sequence[Member],
    like: Turned | None = None,
) -> Turned:
    """Several bodies that move in the same modes, each in its place.

    Parameters
    ----------
    title : str
    modes : sequence of (str, float)
        Name and frequency, Hz, of elastic modes.
    members : sequence of Member
        Each with a vector for every mode.
    like : Turned, optional
        The same bodies by other models: a shape takes the sign of theirs of the same name.

    Returns
    -------
    Turned
        The first body, with the others along.

    Raises
    ------
    SolidgearError
        For a body that carries no geometry, or no mode at all.
    """
    if not modes:
        raise SolidgearError(f"{title}: no elastic mode to draw")
    meshes = [mesh_of(member.body.surface({})) for member in members]
    shapes: list[list[Shape]] = [[] for _ in members]
    for k, (name, hz) in enumerate(modes):
        moved = [
            m.body.surface(m.vectors[k]).displacement[w.source] for m, w in zip(members, meshes)
        ]
        largest = max(np.linalg.norm(one, axis=1).max() for one in moved)
        if not np.isfinite(largest) or not largest > 0:
            raise SolidgearError(f"mode {name!r}: the displacement is zero or not finite")
        told = [sections(mesh.points, one) for mesh, one in zip(meshes, moved)]
        scale = _sign_like(np.vstack(told), name, like) / largest
        for own, one, section in zip(shapes, moved, told):
            own.append(Shape(name, hz, False, _turns(section), scale * one))
    bodies = [
        Turned(title, mesh, tuple(own), member.rotation, member.origin)
        for mesh, own, member in zip(meshes, shapes, members)
    ]
    return replace(bodies[0], along=tuple(bodies[1:]))


def _sign_like(told: np.ndarray, name: str, like: Turned | None) -> float:
    """The sign of the shape of that name of the same bodies; else the usual one."""
    at = -1 if like is None else like.index(name)
    if like is None or at < 0:
        return _direction(told)
    others = [sections(b.mesh.points, b.shapes[at].displacement) for b in (like, *like.along)]
    return _sign_of(float((told * np.vstack(others)).sum()))


def _turns(told: np.ndarray) -> bool:
    """Whether the sections of a body do little but turn about its axis."""
    across, swirl = (told[:, :3] ** 2).sum(), (told[:, 3] ** 2).sum()
    return bool(swirl > TURNS * across)


def symmetric(points: np.ndarray, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Of the shapes that a pair spans, that symmetric about the plane of y and z.

    On that plane a symmetric shape has no motion along x, so the combination with the least of it
    nearby is taken.

    Parameters
    ----------
    points, one, other : (n, 3) ndarray
        Points, and the displacements of two shapes of the same modal mass.
    """
    x, z = points[:, 0] ** 2, points[:, 2] ** 2
    near = np.divide(z, x + z, out=np.zeros_like(z), where=x + z > 0) ** 8
    across = np.column_stack([one[:, 0], other[:, 0]])
    _, v = np.linalg.eigh(across.T @ (near[:, None] * across))
    return v[0, 0] * one + v[1, 0] * other


def sections(points: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """(SLICES, 7) mean motions in slices along the axis: x, y, z, swirl, breathing, ovalising.

    Means over points, not over areas: enough to tell a shape from its negative.
    """
    x, y, z = points.T
    r = np.maximum(np.hypot(x, z), 1e-12 * np.abs(points).max())
    radial = (x * moved[:, 0] + z * moved[:, 2]) / r
    swirl = (z * moved[:, 0] - x * moved[:, 2]) / r
    twice, sine = (z**2 - x**2) / r**2, 2 * x * z / r**2
    told = np.column_stack([moved, swirl, radial, radial * twice, swirl * sine])
    place = (SLICES * (y - y.min()) / np.ptp(y)).astype(int).clip(0, SLICES - 1)
    count = np.bincount(place, minlength=SLICES)
    sums = np.column_stack([np.bincount(place, column, SLICES) for column in told.T])
    return sums / np.maximum(count, 1)[:, None]


def _partner(name: str, like: Sequence[Turned]) -> np.ndarray | None:
    """Sections of the first shape of that name among models drawn before."""
    for other in like:
        at = other.index(name)
        if at >= 0:
            return sections(other.mesh.points, other.shapes[at].displacement)
    return None


def _sign(points: np.ndarray, moved: np.ndarray, partner: np.ndarray | None) -> float:
    """As its partner moves; else that the largest section motion is positive: up, along y or about y."""
    own = sections(points, moved)
    return _direction(own) if partner is None else _sign_of(float((own * partner).sum()))


def _direction(told: np.ndarray) -> float:
    """The sign that makes the largest section motion positive."""
    return _sign_of(float(told.ravel()[np.abs(told).argmax()]))


def _sign_of(value: float) -> float:
    return -1.0 if value < 0 else 1.0


def picks(models: Sequence[Turned]) -> list[Mapping[str, Any]]:
    """Every mode that one of the models has, with its place in each (-1: not there), by frequency."""
    rows: dict[tuple[int, ...], dict[str, Any]] = {}
    for model in models:
        for shape in model.shapes:
            at = tuple(other.index(shape.name) for other in models)
            rows.setdefault(at, {"name": shape.name, "at": list(at), "hz": shape.frequency_hz})
    return sorted(rows.values(), key=lambda row: row["hz"])
