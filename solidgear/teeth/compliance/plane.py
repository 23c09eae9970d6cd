r"""Teeth of a whole wheel in plane strain, from one pitch by cyclic symmetry.

**Waves.**  With z equal pitches, a load on tooth 0 alone is the mean of z loads that grow from pitch to
pitch by the factor ``exp(2 pi i n / z)``, each a wave n (Thomas, International Journal for Numerical
Methods in Engineering 14, 1979, p. 81-102).  Under a wave the right side of a pitch moves as the left
one does, turned and times that factor (:mod:`solidgear.teeth.compliance.pitch`), and the motion of
tooth d is the inverse Fourier transform over the waves.

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

from solidgear.core.errors import SolidgearError
from solidgear.core.gears.wheel import Wheel
from solidgear.teeth.compliance.half_plane import half_plane, near_force
from solidgear.teeth.compliance.mesh import Fineness, PitchMesh, pitch_mesh
from solidgear.teeth.compliance.pitch import motion_rows, plane_pitch, read_rows
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
#: points of a pitch of the port at which its mean motion is read
PORT_POINTS = 40


def usual_hold(wheel: Wheel) -> float:
    """Return the radius that ends the rim of a solid wheel, or of a ring two modules thick, m."""
    return HUB * wheel.root if wheel.teeth > 0 else wheel.root + RIM * wheel.module


def usual_port(wheel: Wheel) -> float:
    """Return the radius just below the roots at which the body's model knows the motion, m."""
    return wheel.root - wheel.sign * PORT * wheel.module


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
    body : bool
        Whether the motion of the body on its held circle is left in.
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
    body: bool = False
    fineness: Fineness = FINENESS
    base: float = BASE

    @property
    def hold_radius(self) -> float:
        """Radius of the circle that ends the rim, m."""
        return usual_hold(self.wheel) if self.hold is None else self.hold

    @property
    def port_radius(self) -> float:
        """Radius of the circle whose mean motion the body's model knows, m."""
        return usual_port(self.wheel) if self.port is None else self.port

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
    forces = motion_rows(nodes[:, None], np.ones((len(nodes), 1)), normals, len(mesh.points))
    to_middle = points[:, 0] / -normals[:, 0]
    base = np.minimum(teeth.base * wheel.module, HALF * to_middle)[:, None]
    depths = [k * base for k in (1, 2, 3)]
    readings = [read_rows(mesh, points + depth * normals, normals) for depth in depths]
    port = _port(mesh, teeth)
    rows = sp.vstack([*readings, port], format="csr"), sp.vstack([forces, port], format="csr")
    read, pressed = rows
    held = plane_pitch(mesh, teeth.elasticity, True, pressed, read)
    rest = plane_pitch(mesh, teeth.elasticity, False, pressed, read) if teeth.free else held
    waves = range(count // 2 + 1)
    # waves 0 and 1 move the wheel as a whole, which is held
    responses = np.array([(rest if n > 1 else held).response(n, count) for n in waves])
    of_teeth = responses[:, : 3 * len(nodes), : len(nodes)]
    moved = np.fft.irfft(of_teeth, n=count, axis=0).reshape(count, 3, len(nodes), len(nodes))
    distances = _distances(points)
    for k, depth in enumerate(depths):
        moved[0, k] -= teeth._half_plane(distances, depth)
    surface = 3 * moved[:, 0] - 3 * moved[:, 1] + moved[:, 2]

    of_port = responses[:2, 3 * len(nodes) :, len(nodes) :]
    translation, rotation = (0.0, 0.0) if teeth.body else _port_compliance(of_port, teeth)
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


def _port(mesh: PitchMesh, teeth: PlaneTeeth) -> sp.csr_matrix:
    """Return rows of the mean motion of a pitch of the port: aside, ahead and clockwise; none where the
    body stays in.
    """
    wheel, radius = teeth.wheel, teeth.port_radius
    if teeth.body:
        return sp.csr_matrix((0, 2 * len(mesh.points)))
    if wheel.sign * radius >= wheel.sign * wheel.root:
        raise SolidgearError(f"teeth: the port at {1e3 * radius:.6g} mm is not in the rim")
    angles = wheel.pitch_angle * ((np.arange(PORT_POINTS) + 0.5) / PORT_POINTS - 0.5)
    out = np.column_stack([np.sin(angles), np.cos(angles)])
    clockwise = np.column_stack([out[:, 1], -out[:, 0]])
    aside, ahead = np.broadcast_to(np.eye(2)[:, None], (2, PORT_POINTS, 2))
    means = [read_rows(mesh, radius * out, d).mean(axis=0) for d in (aside, ahead, clockwise)]
    return sp.csr_matrix(np.vstack(means))


def _port_compliance(responses: np.ndarray, teeth: PlaneTeeth) -> tuple[float, float]:
    """Return the compliance of translation and of rotation of the port, per face width, m per N/m and
    rad per N, from its (2, 3, 3) responses to the waves 0 and 1.

    A force along x on the whole port is a wave 1: in the frame of pitch k it is the real part of
    ``exp(2 pi i k / z) (1, -i)``.
    """
    still, once = responses
    count, radius = teeth.wheel.count, teeth.port_radius
    along = np.array([1.0, -1j, 0.0])
    translation = (along.conj() @ once @ along).real / (2 * count)
    return float(translation), float(still[2, 2].real / (count * radius**2))
