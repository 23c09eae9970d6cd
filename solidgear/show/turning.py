"""Mode shapes ready to be turned: surfaces and motions of bodies, in comparable planes and signs.

The two shapes of a pair span a plane of shapes, and which two a solver gives is chance. Drawn is the
one that is symmetric about the plane of y and z, so that models side by side bend the same way.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from solidgear.core import SolidgearError
from solidgear.core.body.mode_names import meant
from solidgear.show.packing import Mesh, mesh_of

if TYPE_CHECKING:
    from solidgear.core import Body, Mode, ModeSet

#: slices along the axis in which the motions of two models are compared
SLICES = 12
#: a body turns about its axis if the rest moves at most half as much: ratio of mean squares
TURNS = 4.0


@dataclass(frozen=True, eq=False)
class Shape:
    """One mode as it is drawn."""

    name: str  #: such as ``bending 1``
    frequency_hz: float
    pair: bool  #: true if there is a second shape at this frequency
    #: true if sections turn about the axis: drawn enlarged, they are turned, and do not swell
    twists: bool
    #: (n, 3) at the points of the mesh; the largest has length 1, of all bodies that move in the
    #: mode
    displacement: np.ndarray


@dataclass(frozen=True, eq=False)
class Turned:
    """One body with its elastic modes."""

    title: str  #: of the model, such as ``harmonic solid``
    mesh: Mesh
    shapes: tuple[Shape, ...]  #: in ascending order of frequency; rigid motions are left out
    #: (3, 3) from the axes of the body, in which its mesh and shapes are, to those of the picture
    rotation: np.ndarray = field(default_factory=lambda: np.eye(3))
    #: (3,) of its axes in those of the picture, m
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    #: further bodies that move in the same modes, as the other shaft of a train does
    along: tuple[Turned, ...] = ()

    @property
    def bodies(self) -> tuple[Turned, ...]:
        """This body and those along with it."""
        return (self, *self.along)

    def index(self, name: str) -> int:
        """Return the place of a shape by name, also by plane; -1 if there is none."""
        names = [shape.name for shape in self.shapes]
        plain = name.replace("bending z ", "bending ").replace("bending x ", "bending ")
        matches = [meant(candidate, names) for candidate in (name, plain)]
        return next((place for place in matches if place is not None), -1)


class Member(NamedTuple):
    """A body among several that move together."""

    body: Body
    rotation: np.ndarray  #: (3, 3)
    origin: np.ndarray  #: (3,) as of :class:`Turned`
    #: arguments of :meth:`Body.surface`, for every mode one, or the two of a pair
    vectors: Sequence[Sequence[Mapping[int, np.ndarray]]]


def turned(
    body: Body,
    modes: ModeSet | Iterable[Mode],
    title: str = "",
    like: Sequence[Turned] = (),
) -> Turned:
    """Return surface and elastic mode shapes of a body, with the signs of the models they are
    `like`.
    """
    chosen = modes if isinstance(modes, Iterable) else modes.modes
    elastic = [mode for mode in chosen if mode.frequency_hz > 0]
    alone = Member(body, np.eye(3), np.zeros(3), [mode.vectors[:2] for mode in elastic])
    labels = [(mode.name, mode.frequency_hz) for mode in elastic]
    return together(title or body.fidelity, labels, [alone], like)


def together(
    title: str,
    modes: Sequence[tuple[str, float]],
    members: Sequence[Member],
    like: Sequence[Turned] = (),
) -> Turned:
    """Return several bodies that move in the same elastic modes (name, Hz), the first with the
    others along.
    """
    if not modes:
        raise SolidgearError(f"the model {title} has no elastic mode to draw")
    meshes = [mesh_of(member.body.surface({})) for member in members]
    shapes: list[list[Shape]] = [[] for _ in members]
    for k, (name, hz) in enumerate(modes):
        moved = [_moved(m.body, m.vectors[k], mesh) for m, mesh in zip(members, meshes)]
        largest = max(np.linalg.norm(displacement, axis=1).max() for displacement in moved)
        if not np.isfinite(largest) or not largest > 0:
            raise SolidgearError(
                f"{title}: the displacement of mode {name!r} is zero or not finite"
            )
        means = [sections(mesh.points, displacement) for mesh, displacement in zip(meshes, moved)]
        scale = _sign(np.vstack(means), name, like) / largest
        pair = len(members[0].vectors[k]) > 1
        for shape, displacement, mean in zip(shapes, moved, means):
            shape.append(Shape(name, hz, pair, _turns(mean), scale * displacement))
    bodies = [
        Turned(title, mesh, tuple(shape), member.rotation, member.origin)
        for mesh, shape, member in zip(meshes, shapes, members)
    ]
    return replace(bodies[0], along=tuple(bodies[1:]))


def _moved(body: Body, vectors: Sequence[Mapping[int, np.ndarray]], mesh: Mesh) -> np.ndarray:
    """Return the displacement of a mode at the points of a mesh, up to a factor."""
    moved = [body.surface(vector).displacement[mesh.source] for vector in vectors]
    return moved[0] if len(moved) == 1 else symmetric(mesh.points, *moved)


def symmetric(points: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return the shape in the span of a pair of modes that is symmetric about the plane of y and
    z.

    On that plane a symmetric shape has no motion along x, so the combination with the least of it
    nearby is taken.
    """
    x, z = points[:, 0] ** 2, points[:, 2] ** 2
    near = np.divide(z, x + z, out=np.zeros_like(z), where=x + z > 0) ** 8
    across = np.column_stack([first[:, 0], second[:, 0]])
    _, v = np.linalg.eigh(across.T @ (near[:, None] * across))
    return v[0, 0] * first + v[1, 0] * second


def sections(points: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """Return (SLICES, 7) mean motions in slices along the axis: x, y, z, swirl, breathing,
    ovalising.

    Means over points, not over areas: enough to tell a shape from its negative.
    """
    x, y, z = points.T
    r = np.maximum(np.hypot(x, z), 1e-12 * np.abs(points).max())
    radial = (x * moved[:, 0] + z * moved[:, 2]) / r
    swirl = (z * moved[:, 0] - x * moved[:, 2]) / r
    twice, sine = (z**2 - x**2) / r**2, 2 * x * z / r**2
    columns = np.column_stack([moved, swirl, radial, radial * twice, swirl * sine])
    place = (SLICES * (y - y.min()) / np.ptp(y)).astype(int).clip(0, SLICES - 1)
    count = np.bincount(place, minlength=SLICES)
    sums = np.column_stack([np.bincount(place, column, SLICES) for column in columns.T])
    return sums / np.maximum(count, 1)[:, None]


def _turns(means: np.ndarray) -> bool:
    """Return True if the sections of a body mainly rotate about its axis."""
    across, swirl = (means[:, :3] ** 2).sum(), (means[:, 3] ** 2).sum()
    return bool(swirl > TURNS * across)


def _sign(means: np.ndarray, name: str, like: Sequence[Turned]) -> float:
    """Return the sign of the same mode of a model before, or one that makes the largest motion
    positive.
    """
    largest = means.ravel()[np.abs(means).argmax()]
    for model in like:
        place = model.index(name)
        if place >= 0:
            partners = [sections(b.mesh.points, b.shapes[place].displacement) for b in model.bodies]
            largest = (means * np.vstack(partners)).sum()
            break
    return -1.0 if largest < 0 else 1.0


def picks(models: Sequence[Turned]) -> list[Mapping[str, Any]]:
    """Return every mode of any model with its place in each (-1: missing), by frequency."""
    rows: dict[tuple[int, ...], dict[str, Any]] = {}
    for model in models:
        for shape in model.shapes:
            places = tuple(partner.index(shape.name) for partner in models)
            rows.setdefault(
                places, {"name": shape.name, "at": list(places), "hz": shape.frequency_hz}
            )
    return sorted(rows.values(), key=lambda row: row["hz"])
