r"""Teeth of a whole wheel in plane strain, from one pitch by cyclic symmetry.

**Waves.**  With z equal pitches, a load on tooth 0 alone is the mean of z loads that grow from pitch to
pitch by the factor ``exp(2 pi i n / z)``, each a wave n (Thomas, International Journal for Numerical
Methods in Engineering 14, 1979, p. 81-102).  Under a wave the right side of a pitch moves as the left
one does, turned and times that factor.  So the interior of one pitch is condensed to both sides once,
in real numbers; what is left of a wave is a small Hermitian matrix, and the motion of tooth d is the
inverse Fourier transform over the waves.

**Near the force.**  Below a force on the flank a tooth moves as a half-plane does, F
(:mod:`solidgear.teeth.compliance.half_plane`), and smoothly beside.  What finite elements read at a
depth, less F there, is smooth: three depths are extrapolated to the surface by a parabola, and F at the
depth that is asked for is added again.  So a depth is nothing but where the closed form of
:mod:`solidgear.teeth.contact.local` takes over.  (A single reading leaves out what the smooth part
gives way by up to its depth, 1 % of a tooth at a quarter of a module.)

**What is body and what is tooth.**  The rim is held at a circle, which no shaft does, and the shaft's
model has the wheel's body in it.  So the motion of the body as that model would know it is taken out
again: with the force and moment of a flank's normal force about the axis, h, and the compliance of a
*port*, the mean motion of a circle below the roots under loads that are spread over it,

    C = C_FE - h' C_port h.

By symmetry ``C_port`` is a compliance of translation, wave 1, and of rotation, wave 0.  The waves from
2 on are real: no rigid motion has them, and a thin rim is softened by them.  They see the circle as
held, or free where nothing carries the rim there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import BSpline, make_interp_spline
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree
from skfem import ElementQuad2
from skfem.quadrature import get_quadrature
from skfem.refdom import RefQuad

from solidgear.core.errors import SolidgearError
from solidgear.core.gears.wheel import Wheel
from solidgear.core.kernel.assembly import Pattern, reference, tabulate
from solidgear.teeth.compliance.half_plane import half_plane, near_force
from solidgear.teeth.compliance.mesh import Fineness, PitchMesh, pitch_mesh
from solidgear.teeth.contact.local import Elasticity

#: cells of a tooth: those below the flank are small beside the depths of readings
FINENESS = Fineness(fillet=8, flank=20, across=12)
#: depth at which compliances are given, first depth of readings, port below the root, modules
DEPTH, BASE, PORT = 0.25, 0.2, 0.1
#: hold of a solid wheel, part of the root radius; rim of a ring wheel, modules
HUB, RIM = 0.1, 2.0
#: most that the first depth may be of the way to the middle of the tooth
HALF = 0.5
#: by how much larger depths are, for error bars
DEEPER = 1.5
#: degree of polynomials that the quadrature of a cell integrates
DEGREE = 7
#: points of a pitch of the port at which its mean motion is read
PORT_POINTS = 40
#: cells whose middles are nearest to a point, one of which has it
NEAREST = 9
#: steps of Newton from the middle of a cell, and what rounding leaves outside it
STEPS, OUTSIDE = 12, 1e-9


@dataclass(frozen=True)
class PlaneTeeth:
    """Compliance of the teeth of a wheel in plane strain, in its transverse section.

    Attributes
    ----------
    wheel : Wheel
    hold : float, optional
        Radius of the circle that ends the rim: the bore, the inside of a rim, or the outside of a
        ring wheel, m; by default the wheel is solid, a ring two modules thick.
    port : float, optional
        Radius of the circle whose mean motion the body's model knows, m; by default just below the
        roots.
    elasticity : Elasticity
    free : bool
        Whether the rim ends freely for all but its motion as a whole.
    fineness : Fineness
    base : float
        First of the depths at which finite elements are read, modules.

    Raises
    ------
    SolidgearError
        For a rim without thickness, pointed teeth and a port that is not in the rim.

    Examples
    --------
    A tooth of 23 gives way by 25e-12 m per N/m from a quarter of a module below the middle of its
    flank, besides its body.

    >>> teeth = PlaneTeeth(Wheel(23, 4e-3), hold=25e-3)
    >>> compliance = teeth.matrix(np.array([0]), np.array([46e-3]), depth=1e-3)
    >>> print(f"{compliance.item():.3g}")
    2.5e-11
    """

    wheel: Wheel
    hold: float | None = None
    port: float | None = None
    elasticity: Elasticity = Elasticity()
    free: bool = False
    fineness: Fineness = FINENESS
    base: float = BASE

    @property
    def hold_radius(self) -> float:
        """Radius of the circle that ends the rim, m."""
        if self.hold is not None:
            return self.hold
        wheel = self.wheel
        return HUB * wheel.root if wheel.teeth > 0 else wheel.root + RIM * wheel.module

    @property
    def port_radius(self) -> float:
        """Radius of the circle whose mean motion the body's model knows, m."""
        if self.port is not None:
            return self.port
        return self.wheel.root - self.wheel.sign * PORT * self.wheel.module

    def matrix(self, tooth: np.ndarray, r: np.ndarray, depth: float) -> np.ndarray:
        """Return the motion of places on the right flanks at a depth along their normals, per normal
        force on each and face width, without the motion of the body.

        Parameters
        ----------
        tooth : (n,) ndarray of int
            Teeth, numbered clockwise.
        r : (n,) ndarray
            Radii, m; beyond the ends of the flank those of the ends count.
        depth : float
            m.

        Returns
        -------
        (n, n) ndarray
            m per N/m, symmetric.
        """
        solved, count = self._solved, self.wheel.count
        r = self._on_flank(r)
        weights = solved.weights(self._place(r))
        points, _ = self.wheel.flank_points(r)
        out = np.empty((len(r), len(r)))
        cells = {int(k): np.flatnonzero(tooth == k) for k in np.unique(tooth)}
        for k, rows in cells.items():
            for loaded, columns in cells.items():
                table = solved.tables[(k - loaded) % count]
                block = weights[rows] @ table @ weights[columns].T
                if k == loaded:
                    block += self._half_plane(_distances(points[rows]), depth)
                out[np.ix_(rows, columns)] = block
        return out

    def near(self, tooth: np.ndarray, r: np.ndarray, depth: float) -> np.ndarray:
        """Return the part of the matrix that is near the force: of each tooth, the motion of a
        half-plane within the thickness of a tooth.
        """
        points, _ = self.wheel.flank_points(self._on_flank(r))
        reach = self.wheel.thickness
        near = near_force(_distances(points), depth, reach, self.elasticity)
        return np.where(tooth[:, None] == tooth, near, 0.0)

    def error(self, r: np.ndarray, depth: float) -> np.ndarray:
        """Return error bars (n,) of a tooth's compliance at radii (n,), m, relative: by a coarser mesh,
        of second order at least, and by deeper readings, whose extrapolation leaves the third.
        """
        r = np.asarray(r, float)
        tooth = np.zeros(len(r), int)
        usual, coarse, deep = (
            np.diag(v.matrix(tooth, r, depth)) for v in (self, self.coarser, self.deeper)
        )
        return (abs(coarse - usual) / (2**2 - 1) + abs(deep - usual) / (DEEPER**3 - 1)) / usual

    @property
    def coarser(self) -> PlaneTeeth:
        """The same teeth on a mesh of half as many cells in every direction."""
        return replace(self, fineness=self.fineness.finer(0.5))

    @property
    def deeper(self) -> PlaneTeeth:
        """The same teeth, read at larger depths."""
        return replace(self, base=DEEPER * self.base)

    @property
    def asymmetry(self) -> float:
        """Largest difference of two compliances that reciprocity makes equal, of the largest one: a
        measure of the extrapolation's error. The matrices have their mean.
        """
        return self._solved.asymmetry

    @cached_property
    def _solved(self) -> _Tables:
        # the face and the mesh of no wheel depend on each other
        return _tables(replace(self, wheel=self.wheel.thinned(0.0)))

    def _on_flank(self, r: np.ndarray) -> np.ndarray:
        return np.clip(r, *sorted(self._solved.radii[[0, -1]]))

    def _place(self, radii: np.ndarray) -> np.ndarray:
        """Return places along the flank that grow from the fillet to the tip."""
        return self.wheel.sign * (radii / self.wheel.radius) ** 2

    def _half_plane(self, distance: np.ndarray, depth: np.ndarray | float) -> np.ndarray:
        return half_plane(distance, depth, self.wheel.module, self.elasticity)


@dataclass(frozen=True, eq=False)
class _Tables:
    """What the section of one wheel is solved for: the smooth part of the compliance."""

    radii: np.ndarray  #: (k,) from the end of the fillet to the tip, m
    weights: BSpline  #: (k,) weights of the tables by places along the flank
    #: (z, k, k) motion of the surface at radius i of tooth d per force on radius j of tooth 0, of
    #: tooth 0 less that of a half-plane, m per N/m
    tables: np.ndarray
    asymmetry: float


@lru_cache(maxsize=64)
def _tables(teeth: PlaneTeeth) -> _Tables:
    """Solve one section, once for all that ask."""
    wheel, count = teeth.wheel, teeth.wheel.count
    mesh = pitch_mesh(wheel, teeth.hold_radius, teeth.fineness)
    nodes, radii = mesh.flank[::2], mesh.radii[::2]
    points, normals = mesh.points[nodes], wheel.flank_points(radii)[1]
    forces = _rows(nodes[:, None], np.ones((len(nodes), 1)), normals, len(mesh.points))
    to_middle = points[:, 0] / -normals[:, 0]
    base = np.minimum(teeth.base * wheel.module, HALF * to_middle)[:, None]
    depths = [k * base for k in (1, 2, 3)]
    readings = [_read(mesh, points + depth * normals, normals) for depth in depths]
    pitches = [_Pitch(mesh, teeth.elasticity, holds) for holds in (True, not teeth.free)]
    waves = np.arange(count // 2 + 1)
    read = sp.vstack(readings, format="csr")
    responses = pitches[1].responses(read, forces, waves, count)
    responses[:2] = pitches[0].responses(read, forces, waves[:2], count)
    moved = np.fft.irfft(responses, n=count, axis=0).reshape(count, 3, len(nodes), len(nodes))
    distances = _distances(points)
    for k, depth in enumerate(depths):
        moved[0, k] -= teeth._half_plane(distances, depth)
    surface = 3 * moved[:, 0] - 3 * moved[:, 1] + moved[:, 2]

    translation, rotation = _port_compliance(mesh, pitches[0], teeth)
    moment = points[:, 0] * normals[:, 1] - points[:, 1] * normals[:, 0]
    for table, angle in zip(surface, wheel.pitch_angle * np.arange(count)):
        c, s = np.cos(angle), np.sin(angle)
        turned = normals @ np.array([[c, -s], [s, c]])  # clockwise, as teeth are numbered
        table -= translation * turned @ normals.T + rotation * np.outer(moment, moment)
    exchanged = surface[-np.arange(count)].transpose(0, 2, 1)
    largest = (surface[0] + teeth._half_plane(distances, DEPTH * wheel.module)).max()
    asymmetry = float(np.abs(surface - exchanged).max() / largest)
    weights = make_interp_spline(teeth._place(radii), np.eye(len(radii)), k=3)
    return _Tables(radii, weights, (surface + exchanged) / 2, asymmetry)


def _distances(points: np.ndarray) -> np.ndarray:
    """Return the (n, n) distances between (n, 2) points."""
    between = points[:, None] - points
    return np.hypot(between[..., 0], between[..., 1])


class _Pitch:
    """One pitch, condensed to its sides; the circle that ends the rim is held or free."""

    def __init__(self, mesh: PitchMesh, elasticity: Elasticity, holds: bool):
        stiffness = _stiffness(mesh, elasticity)
        fixed = np.zeros(len(mesh.points), bool)
        fixed[mesh.circle] = holds
        sides = mesh.sides[:, ~fixed[mesh.sides[0]]]
        inside = ~fixed
        inside[sides] = False
        unknowns = 2 * np.flatnonzero(inside)[:, None] + np.arange(2)
        #: unknowns inside, and those of both sides, left before right, radial and clockwise
        self.inside = unknowns.ravel()
        self.polar = _polar(mesh.points[sides.ravel()])
        self.edge = (2 * sides.ravel()[:, None] + np.arange(2)).ravel()
        self.factor = splu(stiffness[self.inside][:, self.inside].tocsc())
        to_edge = stiffness[self.inside][:, self.edge] @ self.polar.T
        self.coupling = to_edge.toarray()
        follow = self.factor.solve(self.coupling)
        at_edge = self.polar @ stiffness[self.edge][:, self.edge] @ self.polar.T
        condensed = at_edge.toarray() - self.coupling.T @ follow
        self.condensed = (condensed + condensed.T) / 2

    def responses(
        self, readings: sp.csr_matrix, forces: sp.csr_matrix, waves: np.ndarray, count: int
    ) -> np.ndarray:
        """Return the (waves, readings, forces) response of a pitch to forces that grow from pitch to
        pitch as waves do; readings and forces are rows of the unknowns.
        """
        inner = forces[:, self.inside].toarray().T
        solved = self.factor.solve(inner)
        read = readings[:, self.inside]
        # what a unit motion of the sides moves, and what forces press on the sides
        by_edge = -(read @ self.factor.solve(self.coupling))
        by_edge += (readings[:, self.edge] @ self.polar.T).toarray()
        pressed = -(self.coupling.T @ solved)
        pressed += (self.polar @ forces[:, self.edge].T).toarray()
        grown = np.exp(2j * np.pi * waves / count)
        by_side = np.split(by_edge, 2, axis=1)
        on_side = np.split(pressed, 2, axis=0)
        moved = by_side[0] + grown[:, None, None] * by_side[1]
        push = on_side[0] + grown.conj()[:, None, None] * on_side[1]
        return read @ solved + moved @ np.linalg.solve(self._wave_matrices(grown), push)

    def _wave_matrices(self, grown: np.ndarray) -> np.ndarray:
        """Return the stiffness of the left side under waves with these factors from pitch to pitch."""
        half = len(self.condensed) // 2
        ends = self.condensed.reshape(2, half, 2, half).transpose(0, 2, 1, 3)
        across = grown[:, None, None] * ends[0, 1]
        return ends[0, 0] + ends[1, 1] + across + across.conj().transpose(0, 2, 1)


def _polar(points: np.ndarray) -> sp.csr_matrix:
    """Return the rotation of motions at points into their radial and clockwise parts."""
    out = points / np.hypot(points[:, 0], points[:, 1])[:, None]
    around = np.column_stack([out[:, 1], -out[:, 0]])
    return sp.block_diag(np.stack([out, around], axis=1), format="csr")


def _stiffness(mesh: PitchMesh, elasticity: Elasticity) -> sp.csr_matrix:
    """Return the stiffness of a pitch in plane strain, per face width, N/m^2."""
    youngs, poisson = elasticity.youngs, elasticity.poisson
    shear = youngs / (2 * (1 + poisson))
    lame = youngs * poisson / ((1 + poisson) * (1 - 2 * poisson))
    points, weights = get_quadrature(RefQuad, DEGREE)
    element = ElementQuad2()
    cells = tabulate(element, mesh.points[mesh.cells].transpose(2, 1, 0), element, points)
    gradient = cells.gradient(np.sqrt(cells.det * weights))
    products = np.einsum("eiaq,ejbq->ijeab", gradient, gradient, optimize=True)
    swapped = products.transpose(1, 0, 2, 3, 4)
    values = lame * products + shear * swapped
    for i in range(2):
        values[i, i] += shear * (products[0, 0] + products[1, 1])
    total = Pattern(mesh.cells.T).sum(2)
    total.add(slice(None), values)
    return total.matrix()


def _rows(
    nodes: np.ndarray, shares: np.ndarray, directions: np.ndarray, count: int
) -> sp.csr_matrix:
    """Return rows over the unknowns of `count` nodes: the (m, b) shares of the motions of (m, b) nodes
    along (m, 2) directions.
    """
    entries = shares[:, :, None] * directions[:, None, :]
    columns = 2 * nodes[:, :, None] + np.arange(2)
    rows = np.broadcast_to(np.arange(len(nodes))[:, None, None], entries.shape)
    return sp.csr_matrix(
        (entries.ravel(), (rows.ravel(), columns.ravel())), shape=(len(nodes), 2 * count)
    )


def _read(mesh: PitchMesh, points: np.ndarray, directions: np.ndarray) -> sp.csr_matrix:
    """Return rows that read the motion along (m, 2) directions at (m, 2) points inside the mesh."""
    nodes = mesh.points[mesh.cells]
    _, near = cKDTree(nodes[:, 8]).query(points, min(NEAREST, len(nodes)))
    place = np.full((*near.shape, 2), 0.5)
    element = ElementQuad2()
    for _ in range(STEPS):
        shapes, slopes = reference(element, place.reshape(-1, 2).T)
        shapes, slopes = shapes.reshape(9, *near.shape), slopes.reshape(9, 2, *near.shape)
        missing = points[:, None] - np.einsum("bmk,mkbi->mki", shapes, nodes[near])
        jacobian = np.einsum("bdmk,mkbi->mkid", slopes, nodes[near])
        step = np.linalg.solve(jacobian, missing[..., None])[..., 0]
        place = np.clip(place + step, -1.0, 2.0)  # a cell far from the point has it nowhere
    outside = np.abs(place - 0.5).max(axis=2) - 0.5
    cell = np.arange(len(points)), np.argmin(outside, axis=1)
    if outside[cell].max() > OUTSIDE:
        raise SolidgearError("teeth: a place at which motion is read is in no tooth or rim")
    shapes, _ = reference(element, place[cell].T)
    return _rows(mesh.cells[near[cell]], shapes.T, directions, len(mesh.points))


def _port_compliance(mesh: PitchMesh, pitch: _Pitch, teeth: PlaneTeeth) -> tuple[float, float]:
    """Return the compliance of translation and of rotation of the port, per face width, m per N/m and
    rad per N.

    A force along x on the whole port is a wave 1: in the frame of pitch k it is the real part of
    ``exp(2 pi i k / z) (1, -i)``.
    """
    wheel, radius = teeth.wheel, teeth.port_radius
    if wheel.sign * radius >= wheel.sign * wheel.root:
        raise SolidgearError(f"teeth: the port at {1e3 * radius:.6g} mm is not in the rim")
    angles = wheel.pitch_angle * ((np.arange(PORT_POINTS) + 0.5) / PORT_POINTS - 0.5)
    out = np.column_stack([np.sin(angles), np.cos(angles)])
    clockwise = np.column_stack([out[:, 1], -out[:, 0]])
    aside, ahead = np.broadcast_to(np.eye(2)[:, None], (2, PORT_POINTS, 2))
    means = [_read(mesh, radius * out, d).mean(axis=0) for d in (aside, ahead, clockwise)]
    port = sp.csr_matrix(np.vstack(means))
    still, once = pitch.responses(port, port, np.arange(2), wheel.count)
    along = np.array([1.0, -1j, 0.0])
    translation = (along.conj() @ once @ along).real / (2 * wheel.count)
    return float(translation), float(still[2, 2].real / (wheel.count * radius**2))
