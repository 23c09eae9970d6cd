r"""Mesh of one pitch of a toothed wheel: quadrilaterals of nine nodes in two structured blocks.

The *tooth* is cut into rows by arcs around the axis, from where the fillet leans by :data:`LEAN` against
the radius to the tip; the *rim* runs from what lies below, the rest of both fillets and the land of the
root, to the circle at which the wheel is held, in rows that grow away from the teeth.  Cells are thin
below the flanks, and every node of a flank or fillet lies on it (cells are isoparametric).  Both sides of
a pitch are radii with nodes at equal places, so that pitches join to a ring.

Of a ring wheel, inside and outside are exchanged, and nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, ceil, cos, log, pi, sin

import numpy as np
from skfem import ElementQuad2

from solidgear.core.errors import SolidgearError
from solidgear.core.gears.wheel import Wheel
from solidgear.core.kernel.assembly import tabulate

#: angle of the fillet against the radius at which the tooth ends and the rim begins, rad
LEAN = pi / 4
#: cells across a tooth are thin by this power towards its flanks
THIN = 1.6
#: growth of the rows of the rim, and of the first of them, in modules
GROWTH, FIRST = 1.5, 0.4
#: part of a pitch below which the root has no land
NARROW = 1e-4
#: nodes of a cell in a block of 3 by 3, in the order of ``ElementQuad2``
_ORDER = ((0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0), (1, 1))


@dataclass(frozen=True)
class Fineness:
    """Cells along the parts of a tooth.

    Examples
    --------
    >>> Fineness().finer(2).flank
    20
    """

    fillet: int = 8
    flank: int = 10
    across: int = 8  #: even, so that there are nodes in the middle of the tooth
    rim: float = 1.0  #: rows of the rim per usual row

    def finer(self, factor: float) -> Fineness:
        """Return a fineness with as many times the cells in each direction."""

        def times(count: int) -> int:
            return max(2, 2 * round(factor * count / 2))

        return Fineness(
            times(self.fillet), times(self.flank), times(self.across), factor * self.rim
        )


@dataclass(frozen=True)
class PitchMesh:
    """Mesh of one pitch around tooth 0, in the frame of :mod:`solidgear.core.gears.wheel`."""

    points: np.ndarray  #: (n, 2) m
    cells: np.ndarray  #: (m, 9) nodes in the order of ``ElementQuad2``: corners counter-clockwise
    #: (k,) nodes of the right flank from the fillet to the tip, every second of them in the middle of
    #: an edge, and their radii, m
    flank: np.ndarray
    radii: np.ndarray
    #: (2, s) nodes of the left and the right side, from the teeth to the held circle: the right ones
    #: are the left ones, turned clockwise by a pitch
    sides: np.ndarray
    circle: np.ndarray  #: (c,) nodes of the held circle, clockwise

    @property
    def corners(self) -> np.ndarray:
        """(m, 4) corners of the cells, counter-clockwise."""
        return self.cells[:, :4]


def pitch_mesh(wheel: Wheel, hold: float, fineness: Fineness = Fineness()) -> PitchMesh:
    """Return the mesh of one pitch of a wheel.

    Parameters
    ----------
    wheel : Wheel
    hold : float
        Radius of the circle that ends the rim: below the root, of a ring wheel above it, m.
    fineness : Fineness

    Returns
    -------
    PitchMesh

    Raises
    ------
    SolidgearError
        Where teeth are pointed, and where the rim has no thickness.

    Examples
    --------
    >>> mesh = pitch_mesh(Wheel(23, 4e-3), hold=25e-3)
    >>> len(mesh.cells), len(mesh.flank), mesh.sides.shape
    (200, 21, (2, 11))
    """
    if hold <= 0 or wheel.sign * (wheel.root - hold) <= 0:
        raise SolidgearError(
            f"teeth: the rim has no thickness between the root, {1e3 * wheel.root:.6g} mm, and "
            f"the radius at which it is held, {1e3 * hold:.6g} mm"
        )
    if wheel.tip_thickness <= 0:
        raise SolidgearError(f"teeth: pointed below their tip radius, {1e3 * wheel.tip:.6g} mm")
    low, high = _contour(wheel, fineness)
    tooth = _tooth(high, fineness.across)
    foot = np.concatenate([low[:-1] * [-1, 1], tooth[0], low[:-1][::-1]])
    rim = _rim(foot, wheel, hold, fineness.rim)
    return _joined(tooth, rim, len(low) - 1, len(high) - 2 * fineness.flank - 1)


def _contour(wheel: Wheel, fineness: Fineness) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes of the right side of a tooth below and above the place where the rim begins,
    from the middle of the space to the tip, m.
    """
    fillet = wheel.fillet(2 * fineness.fillet + 1)
    slope = np.gradient(fillet, axis=0)
    out = fillet / np.hypot(fillet[:, 0], fillet[:, 1])[:, None]
    along = wheel.sign * np.sum(slope * out, axis=1)
    across = np.abs(slope[:, 0] * out[:, 1] - slope[:, 1] * out[:, 0])
    lean = np.arctan2(across, along)[2:-2:2]
    split = 2 + 2 * int(np.argmin(np.abs(lean - LEAN)))
    # equal steps along an involute are equal steps of its squared radius
    squares = np.linspace(wheel.form**2, wheel.tip**2, 2 * fineness.flank + 1)
    flank, _ = wheel.flank_points(np.sqrt(squares))
    low = fillet[: split + 1]
    land = _land(wheel, low, fineness.fillet // 2)
    return np.concatenate([land, low]), np.concatenate([fillet[split:-1], flank])


def _land(wheel: Wheel, low: np.ndarray, most: int) -> np.ndarray:
    """Return the nodes of the root between the middle of the space and the fillet, of `most` cells;
    without land, move the fillet's first node to the middle.
    """
    middle, start = wheel.pitch_angle / 2, atan2(low[0, 0], low[0, 1])
    if middle - start < NARROW * middle:
        low[0] = wheel.root * np.array([sin(middle), cos(middle)])
        return np.empty((0, 2))
    cell = float(np.hypot(*(low[2] - low[0]))) / wheel.root
    count = min(max(1, round((middle - start) / cell)), most)
    angles = np.linspace(middle, start, 2 * count + 1)[:-1]
    return wheel.root * np.column_stack([np.sin(angles), np.cos(angles)])


def _tooth(high: np.ndarray, across: int) -> np.ndarray:
    """Return the (rows, columns, 2) nodes of the tooth: arcs around the axis, from left to right."""
    r, half = np.hypot(high[:, 0], high[:, 1]), np.arctan2(high[:, 0], high[:, 1])
    even = np.linspace(-1, 1, across + 1)
    edges = np.sign(even) * (1 - (1 - np.abs(even)) ** THIN)
    angles = half[:, None] * _with_middles(edges)
    return r[:, None, None] * np.stack([np.sin(angles), np.cos(angles)], axis=-1)


def _rim(foot: np.ndarray, wheel: Wheel, hold: float, rows: float) -> np.ndarray:
    """Return the (rows, columns, 2) nodes of the rim, from its held circle to the teeth."""
    depth = abs(wheel.root - hold)
    growth = GROWTH ** (1 / rows)
    usual = log(1 + depth * (GROWTH - 1) / (FIRST * wheel.transverse_module), GROWTH)
    count = max(2, ceil(rows * usual))
    edges = (growth ** np.arange(count + 1) - 1) / (growth**count - 1)
    share = _with_middles(edges)[::-1, None, None]
    angles = np.linspace(-pi / wheel.count, pi / wheel.count, len(foot))
    circle = hold * np.column_stack([np.sin(angles), np.cos(angles)])
    return foot * (1 - share) + circle * share


def _with_middles(edges: np.ndarray) -> np.ndarray:
    """Return numbers with the middle between each two."""
    out = np.empty(2 * len(edges) - 1)
    out[::2] = edges
    out[1::2] = (edges[:-1] + edges[1:]) / 2
    return out


def _joined(tooth: np.ndarray, rim: np.ndarray, aside: int, below: int) -> PitchMesh:
    """Return the mesh of both blocks, whose shared nodes begin `aside` columns from the side of the
    rim; the flank begins `below` rows above the foot.
    """
    rows, columns = tooth.shape[:2]
    of_rim = np.arange(rim.shape[0] * rim.shape[1]).reshape(rim.shape[:2])
    shared = of_rim[-1, aside : aside + columns]
    new = of_rim.size + np.arange((rows - 1) * columns).reshape(rows - 1, columns)
    of_tooth = np.concatenate([shared[None], new])
    points = np.concatenate([rim.reshape(-1, 2), tooth[1:].reshape(-1, 2)])
    cells = np.concatenate([_cells(of_rim), _cells(of_tooth)])
    determinants = tabulate(
        ElementQuad2(), points[cells].transpose(2, 1, 0), ElementQuad2(), ElementQuad2.doflocs.T
    ).det
    if np.all(determinants < 0):  # rows of a ring wheel run towards its axis
        cells = cells[:, [0, 3, 2, 1, 7, 6, 5, 4, 8]]
    elif not np.all(determinants > 0):
        raise SolidgearError("teeth: this shape of tooth and rim has no regular mesh")
    flank = of_tooth[below:, -1]
    radii = np.hypot(points[flank, 0], points[flank, 1])
    sides = of_rim[::-1, [0, -1]].T
    return PitchMesh(points, cells, flank, radii, sides, of_rim[0])


def _cells(nodes: np.ndarray) -> np.ndarray:
    """Return the (m, 9) nodes of the cells of a block."""
    rows, columns = nodes.shape
    return np.column_stack(
        [nodes[i : rows - 2 + i : 2, j : columns - 2 + j : 2].ravel() for i, j in _ORDER]
    )
