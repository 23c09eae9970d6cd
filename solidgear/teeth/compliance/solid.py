r"""Teeth of a whole wheel in 3D, of second-order hexahedra.

One pitch is meshed, condensed to its sides and repeated (:mod:`solidgear.teeth.compliance.ring`).
Unit forces act on slices of the face along lines of constant radius; motions are read below.

**Near a load** a tooth moves as a half-space does (:mod:`solidgear.teeth.compliance.half_space`), near
an end of the face as one under the load and its mirror image, which hold the plane between them free
of shear.  The motion that is read at a depth, less that, is smooth: along the flank, so that a table
of few radii is interpolated, and with the depth, so that readings at two depths are continued to the
surface by a line.  With the half-space at the depth that is asked for, the sum then depends on this
depth as the closed form does that takes over there.

**Teeth alone.**  A force on a tooth also moves the rim as a rigid body, and shafts have this motion
already.  With the mean motion of the port, a cylinder in the rim, under loads that are spread over it,

    C = C_whole - H C_port H',

where the rows H are the motions of a rigid body along the normals.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import cos, sin, tan

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import CubicSpline

from solidgear.core.gears.wheel import Wheel
from solidgear.core.models.solid.matrices import _matrices
from solidgear.core.scene.parts import Material
from solidgear.teeth.compliance.half_space import between_pieces
from solidgear.teeth.compliance.mesh import Fineness, pitch_mesh
from solidgear.teeth.compliance.plane import DEPTH, usual_hold, usual_port
from solidgear.teeth.compliance.port import Port, port_of
from solidgear.teeth.compliance.ring import CondensedPitch, at_pitch, condensed
from solidgear.teeth.compliance.solid_mesh import SweptPitch, turned
from solidgear.teeth.contact.local import Elasticity

#: depth of the second reading, modules, but no deeper than the middle of the tooth; the first is at
#: half of it, and both count so many times at the surface
DEEPEST, COUNTED = 0.5, (2.0, -1.0)
#: cells along the parts of a tooth
USUAL = Fineness(fillet=4, flank=8, across=6)
#: thickness of the layers of cells along the face, modules
LAYER = 0.5
#: highest power of z in the motion of the sides of a pitch: least, and per width in modules, which is
#: 2e-4 off in what a tooth gives way by at ten modules
LEAST_POWER, POWER = 6, 0.5
#: density, which stiffness does not feel, kg/m^3
ANY_DENSITY = 1.0


@dataclass(frozen=True)
class SolidTeeth:
    """Compliance of the teeth of one wheel, in 3D.

    Attributes
    ----------
    wheel : Wheel
    hold : float, optional
        Radius of the cylinder that ends the rim: the bore, the inside of a rim, or the outside of a
        ring wheel, m; by default the wheel is solid, a ring two modules thick.
    port : float, optional
        Radius of the cylinder whose mean motion the body's model knows, m; by default just below the
        roots.
    reading_depth : float, optional
        Below the flank, at which compliances are given, m; by default a quarter of a module.
    elasticity : Elasticity
    free : bool
        Whether the rim ends freely for all but its motion as a whole.
    hand : int
        1 where the teeth turn clockwise along z, as those of the first wheel of a pair, and -1 where
        they turn the other way, as those of its mate.
    width, offset : float
        Of the face that both wheels share, by default all of it, and of its middle from that of the
        wheel's face, m.
    slices : int
        Of the shared face.
    fineness : Fineness
    layer : float
        Thickness of the layers of cells along the face, but no thinner than slices, modules.
    deepest : float
        Depth of the second reading, modules.
    power : float
        Highest power of z in the motion of the sides of a pitch, per face width in modules.

    Raises
    ------
    SolidgearError
        For a rim without thickness, pointed teeth, and a port or a depth that is not in the wheel.
    NoRoom
        For a mesh that does not fit into memory.

    Examples
    --------
    Under an even load teeth of 23 give way by 5 % more than in plane strain.

    >>> teeth = SolidTeeth(Wheel(23, 4e-3, face_width=20e-3), hold=25e-3, slices=4, layer=2.5)
    >>> places = np.zeros(4, int), np.full(4, 46e-3), teeth.middles
    >>> print(f"{teeth.matrix(*places).mean() * 20e-3:.2g} m per N/m")
    2.6e-11 m per N/m
    """

    wheel: Wheel
    hold: float | None = None
    port: float | None = None
    reading_depth: float | None = None
    elasticity: Elasticity = Elasticity()
    free: bool = False
    hand: int = 1
    width: float | None = None
    offset: float = 0.0
    slices: int = 24
    fineness: Fineness = USUAL
    layer: float = LAYER
    deepest: float = DEEPEST
    power: float = POWER

    @property
    def hold_radius(self) -> float:
        """Radius of the cylinder that ends the rim, m."""
        return usual_hold(self.wheel) if self.hold is None else self.hold

    @property
    def port_radius(self) -> float:
        """Radius of the cylinder whose mean motion the body's model knows, m."""
        return usual_port(self.wheel) if self.port is None else self.port

    @property
    def depth(self) -> float:
        """Depth below the flank at which compliances are given, m."""
        return DEPTH * self.wheel.module if self.reading_depth is None else self.reading_depth

    @property
    def coarser(self) -> SolidTeeth:
        """The same teeth on a mesh of half as many cells in every direction.  The difference of a result
        from the usual one is an error bar: 2.8 % of a stiffness that is off by 0.4 %, and two to six
        times the error of a face load factor.
        """
        return replace(self, fineness=self.fineness.finer(0.5), layer=2 * self.layer)

    @cached_property
    def ends(self) -> np.ndarray:
        """(slices + 1,) ends of the slices, from the middle of the wheel's face, m."""
        width = self.wheel.face_width if self.width is None else self.width
        return np.linspace(-width / 2, width / 2, self.slices + 1) + self.offset

    @property
    def middles(self) -> np.ndarray:
        """(slices,) middles of the slices, from the middle of the wheel's face, m."""
        return (self.ends[1:] + self.ends[:-1]) / 2

    @cached_property
    def mesh(self) -> SweptPitch:
        """Mesh of one pitch."""
        face = self.wheel.face_width
        # thinner layers than slices would resolve what no load has
        thickness = max(self.layer * self.wheel.module, self.ends[1] - self.ends[0])
        layers = max(1, round(face / thickness))
        twist = self.hand * tan(self.wheel.helix_angle) / self.wheel.radius
        plane = pitch_mesh(self.wheel, self.hold_radius, self.fineness)
        return SweptPitch(plane, np.linspace(-face / 2, face / 2, layers + 1), twist)

    @cached_property
    def radii(self) -> np.ndarray:
        """(k,) radii of the tables, m: ends of the flank, and middles of its cells, where a point load
        is met best by their functions.
        """
        nodes = self.mesh.plane.radii
        return np.sort(nodes[np.r_[0, 1 : len(nodes) : 2, -1]])

    def flank(self, r: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return points (k, 3) of tooth 0's right flank, m, and unit normals into the tooth, at radii
        (k,) and places z (k,) from the middle of the wheel's face.
        """
        points, normals = self.wheel.flank_points(r)
        helix = self.wheel.base_helix
        flat = turned(normals, self.mesh.twist * z) * cos(helix)
        axial = np.full(len(flat), self.hand * sin(helix))
        return self.mesh.places(points, z), np.column_stack([flat, axial])

    @cached_property
    def _depths(self) -> np.ndarray:
        """(2, k) depths of both readings below the radii of the tables, m."""
        points, normals = self.wheel.flank_points(self.radii)
        middle = -points[:, 0] / (normals[:, 0] * cos(self.wheel.base_helix))
        deepest = np.minimum(self.deepest * self.wheel.module, middle)
        return np.array([deepest / 2, deepest])

    def _rows(self, depths: np.ndarray) -> sp.csr_matrix:
        """Return the rows of the mean normal motions of slices at depths (k,) below the radii of the
        tables, those of a radius together.
        """
        helix, mesh = self.wheel.base_helix, self.mesh
        points, normals = self.wheel.flank_points(self.radii)
        # the normal leads along the face as well, to where the mesh is turned further
        ahead = self.hand * depths * sin(helix)
        below = turned(points + depths[:, None] * cos(helix) * normals, -mesh.twist * ahead)
        cells, local = mesh.inside(below)
        parts = []
        for k, r in enumerate(self.radii):
            z, weights, numbers = mesh.means(self.ends + ahead[k])
            _, directions = self.flank(np.full(len(z), r), z - ahead[k])
            cell, place = np.full(len(z), cells[k]), np.tile(local[k], (len(z), 1))
            parts.append(mesh.rows(cell, place, z, directions, weights, numbers))
        return sp.vstack(parts).tocsr()

    @cached_property
    def _forces(self) -> sp.csr_matrix:
        """Rows of the flank itself, by which forces act."""
        return self._rows(np.zeros(len(self.radii)))

    @cached_property
    def _readings(self) -> sp.csr_matrix:
        """Rows of both readings, continued to the surface."""
        return sum(times * self._rows(depths) for times, depths in zip(COUNTED, self._depths))

    @cached_property
    def port_part(self) -> Port:
        """The part of the port in one pitch."""
        return port_of(self.mesh, self.port_radius, self.wheel.pitch_angle)

    @property
    def _stiffness(self) -> sp.csr_matrix:
        constants = Material(
            E=self.elasticity.youngs, nu=self.elasticity.poisson, density=ANY_DENSITY
        )
        return _matrices(self.mesh.solid, [constants])[0]

    def pitch(self, holds: bool = True) -> CondensedPitch:
        """Return one pitch seen from its sides, its rim held or free: forces on the places of the
        tables and six loads of the port, motions of both.
        """
        mesh = self.mesh
        width = self.wheel.face_width / self.wheel.module
        power = min(max(LEAST_POWER, round(self.power * width)), mesh.layers)
        sides = mesh.side_motions(self.wheel.pitch_angle, power, holds)
        loads = sp.hstack([self._forces.T, self.port_part.loads]).tocsr()
        readings = sp.vstack([self._readings, self.port_part.loads.T]).tocsr()
        return condensed(self._stiffness, mesh.inner(holds), sides, loads, readings)

    @property
    def _responses(self) -> tuple[np.ndarray, np.ndarray]:
        """(waves, n, n) motion of the places by forces on them, and (6, 6) compliance of the port."""
        return _responses_of(replace(self, reading_depth=None))

    @property
    def port_compliance(self) -> np.ndarray:
        """(6, 6) mean motion of the port by loads spread over it, about the middle of the face."""
        return self._responses[1]

    def with_rim(self, tooth: int) -> np.ndarray:
        """Return the (n, n) motion of places on a tooth by forces on those of tooth 0, with the motion
        of the rim, m/N.
        """
        return at_pitch(self._responses[0], tooth, self.wheel.count)

    def _rigid(self, tooth: int) -> np.ndarray:
        """Return the (n, 6) motion of the places on a tooth along their normals by a rigid body."""
        points, normals = self.flank(*self._places)
        for part in (points, normals):
            part[:, :2] = turned(part[:, :2], tooth * self.wheel.pitch_angle)
        return np.hstack([normals, np.cross(points, normals)])

    @property
    def _places(self) -> tuple[np.ndarray, np.ndarray]:
        """Radii and z (n,) of the places in the tables, m."""
        return np.repeat(self.radii, self.slices), np.tile(self.middles, len(self.radii))

    def without_rim(self, tooth: int) -> np.ndarray:
        """Return the same without the motion of the rim."""
        rim = self._rigid(tooth) @ self.port_compliance @ self._rigid(0).T
        return self.with_rim(tooth) - rim

    @cached_property
    def _tables(self) -> dict[int, np.ndarray]:
        return {}

    def table(self, tooth: int) -> np.ndarray:
        """Return the (n, n) smooth part of the compliance between places on a tooth and on tooth 0,
        the mean of both senses, m/N.
        """
        if tooth not in self._tables:
            table, exchanged = self.without_rim(tooth), self.without_rim(-tooth)
            if tooth == 0:
                near = np.zeros_like(table)
                for times, depths in zip(COUNTED, np.repeat(self._depths, self.slices, axis=1)):
                    near += times * self._near(*self._places, depths[:, None])
                table, exchanged = table - near, exchanged - near
            self._tables[tooth] = (table + exchanged.T) / 2
        return self._tables[tooth]

    def _near(self, r: np.ndarray, z: np.ndarray, depth: float | np.ndarray) -> np.ndarray:
        """Return the (n, n) motion of a half-space between places on one flank, m/N, at a depth or at
        one (n, 1) by place, by forces there and by their images beyond both ends of the face.
        """
        points, _ = self.flank(r, z)
        lean = self.mesh.twist * (r[:, None] + r) / 2
        stretch = np.sqrt(1 + lean**2)
        length = (self.ends[1] - self.ends[0]) * stretch
        face = self.wheel.face_width
        near = np.zeros((len(r), len(r)))
        for sense, shift in ((1, 0.0), (-1, face), (-1, -face)):
            along = (z[:, None] - sense * z - shift) * stretch
            image = points * [1, 1, sense] + [0, 0, shift]
            squares = ((points[:, None] - image) ** 2).sum(axis=-1)
            across = np.maximum(squares - along**2, 0.0)
            near += between_pieces(along, across, depth, length, self.elasticity)
        return near

    def matrix(self, tooth: np.ndarray, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the compliance between places
        (:meth:`solidgear.teeth.compliance.flank.FlankCompliance.matrix`).
        """
        out = np.empty((len(r), len(r)))
        groups = {int(k): np.flatnonzero(tooth == k) for k in np.unique(tooth)}
        weights = {k: self._weights(r[rows], z[rows]) for k, rows in groups.items()}
        for k, rows in groups.items():
            for j, columns in groups.items():
                if j > k:
                    continue
                block = (weights[j] @ (weights[k] @ self.table(k - j)).T).T
                if j == k:
                    block = block + self._near(r[rows], z[rows], self.depth)
                out[np.ix_(rows, columns)] = block
                out[np.ix_(columns, rows)] = block.T
        return out

    def _rolled(self, r: np.ndarray) -> np.ndarray:
        """Return lengths rolled off the base circle to radii, m."""
        return np.sqrt(np.maximum(np.square(r) - self.wheel.base**2, 0.0))

    @cached_property
    def _splines(self) -> CubicSpline:
        return CubicSpline(self._rolled(self.radii), np.eye(len(self.radii)))

    def _weights(self, r: np.ndarray, z: np.ndarray) -> sp.csr_matrix:
        """Return the weights (k, n) of the table at places: cubic along the flank, linear along the
        face, and those of its ends beyond them.
        """
        radial = self._splines(self._rolled(np.clip(r, self.radii[0], self.radii[-1])))
        step = self.middles[1] - self.middles[0]
        slices = np.clip((z - self.middles[0]) / step, 0, self.slices - 1)
        low = np.minimum(slices.astype(int), self.slices - 2)
        share = (slices - low)[:, None]
        columns = np.arange(len(self.radii)) * self.slices + low[:, None]
        values = np.stack([radial * (1 - share), radial * share])
        rows = np.broadcast_to(np.arange(len(r))[:, None], values.shape)
        columns = np.stack([columns, columns + 1])
        size = (len(r), len(self.radii) * self.slices)
        return sp.csr_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=size)


@lru_cache(maxsize=8)
def _responses_of(teeth: SolidTeeth) -> tuple[np.ndarray, np.ndarray]:
    """Solve one wheel, once for all that ask: motions of its places as waves around, and compliance of
    its port.
    """
    count = teeth.wheel.count
    pitch = teeth.pitch()
    rigid = np.array([pitch.response(wave, count) for wave in (0, 1)])
    if teeth.free:
        pitch = teeth.pitch(holds=False)
    waves = range(2, count // 2 + 1)
    responses = np.array([*rigid, *(pitch.response(wave, count) for wave in waves)])
    places, port = slice(-6), slice(-6, None)
    compliance = teeth.port_part.compliance(rigid[:, port, port], count)
    return responses[:, places, places], compliance
