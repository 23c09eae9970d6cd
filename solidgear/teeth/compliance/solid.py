r"""Teeth of a whole wheel in 3D, of second-order hexahedra.

One pitch is meshed, condensed to its sides and repeated (:mod:`solidgear.teeth.compliance.ring`).
Unit forces act on slices of the face along lines of constant radius; motions are read at the depth h
below.  Near a load the motion is as wide as h, which a table over radii would have to resolve: there
it is that of a half-space (:mod:`solidgear.teeth.compliance.half_space`), and the table, from which
that is taken out, is smooth and interpolated.

**Teeth alone.**  A force on a tooth also moves the rim as a rigid body, and shafts have this motion
already.  With the mean motion of the port, a cylinder in the rim, under loads that are spread over it,

    C = C_whole - H C_port H',

where the rows H are the motions of a rigid body along the normals.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, sin, sqrt, tan

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import CubicSpline

from solidgear.core.gears.wheel import Wheel
from solidgear.core.models.solid.matrices import _matrices
from solidgear.core.scene.parts import Material
from solidgear.teeth.compliance.half_space import between_pieces
from solidgear.teeth.compliance.mesh import Fineness, pitch_mesh
from solidgear.teeth.compliance.port import Port
from solidgear.teeth.compliance.ring import CondensedPitch, Ring, condensed
from solidgear.teeth.compliance.solid_mesh import SweptPitch, turned
from solidgear.teeth.contact.local import Elasticity

#: cells along the parts of a tooth
USUAL = Fineness(fillet=4, flank=6, across=6)
#: thickness of the layers of cells along the face, modules
LAYER = 0.5
#: highest power of z in the motion of the sides of a pitch
POWER = 8
#: radii of the table
RADII = 9
#: density, which stiffness does not feel, kg/m^3
ANY_DENSITY = 1.0


@dataclass(frozen=True)
class SolidTeeth:
    """Compliance of the teeth of one wheel, in 3D.

    Attributes
    ----------
    wheel : Wheel
    hold : float
        Radius of the cylinder that is held: below the root, of a ring wheel above it, m.
    port : float
        Radius of the cylinder whose mean motion is not the teeth's, between `hold` and the root, m;
        by default `hold`.
    material : Elasticity
    depth : float
        Below the flank at which the motion is read, m.
    hand : int
        1 where the teeth turn clockwise along z, as those of the first wheel of a pair, else -1.
    width, offset : float
        Width of the common face, and its middle from that of the wheel's face, m.
    slices : int
        Of the common face.
    fineness : Fineness
    layers : int, optional
        Of cells along the face; by default half a module thick.
    """

    wheel: Wheel
    hold: float
    port: float | None = None
    material: Elasticity = Elasticity()
    depth: float = 1e-3
    hand: int = 1
    width: float | None = None
    offset: float = 0.0
    slices: int = 24
    fineness: Fineness = USUAL
    layers: int | None = None
    radii_count: int = RADII
    power: int = POWER

    @cached_property
    def mesh(self) -> SweptPitch:
        """Mesh of one pitch."""
        face = self.wheel.face_width
        layers = self.layers or round(face / (LAYER * self.wheel.module))
        twist = self.hand * tan(self.wheel.helix_angle) / self.wheel.radius
        plane = pitch_mesh(self.wheel, self.hold, self.fineness)
        return SweptPitch(plane, np.linspace(-face / 2, face / 2, layers + 1), twist)

    @cached_property
    def ends(self) -> np.ndarray:
        """(slices + 1,) ends of the slices, from the middle of the wheel's face, m."""
        width = self.wheel.face_width if self.width is None else self.width
        return np.linspace(-width / 2, width / 2, self.slices + 1) + self.offset

    @property
    def middles(self) -> np.ndarray:
        """(slices,) middles of the slices, m."""
        return (self.ends[1:] + self.ends[:-1]) / 2

    @cached_property
    def rolled(self) -> np.ndarray:
        """(radii,) places of the table along the flank: lengths rolled off the base circle, m."""
        lengths = [self._rolled(r) for r in (self.wheel.form, self.wheel.tip)]
        return np.linspace(min(lengths), max(lengths), self.radii_count)

    def _rolled(self, r):
        return np.sqrt(np.maximum(np.square(r) - self.wheel.base**2, 0.0))

    @property
    def radii(self) -> np.ndarray:
        """(radii,) radii of the table, m."""
        return np.hypot(self.wheel.base, self.rolled)

    def flank(self, r: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the points of tooth 0's right flank (..., 3), m, and the unit normals into the tooth,
        at radii (k,) and places z (k,) or one.
        """
        points, normals = self.wheel.flank_points(r)
        helix = self.wheel.base_helix
        flat = turned(normals, self.mesh.twist * z) * cos(helix)
        axial = np.full(len(flat), self.hand * sin(helix))
        return self.mesh.places(points, z), np.column_stack([flat, axial])

    def _rows(self, depth: float) -> sp.csr_matrix:
        """Return the rows of the motion of slices at a depth below the flank."""
        points, normals = self.wheel.flank_points(self.radii)
        helix = self.wheel.base_helix
        # along the normal one goes ahead along the face as well, where the mesh is turned further
        ahead = self.hand * depth * sin(helix)
        below = turned(points + depth * cos(helix) * normals, -self.mesh.twist * ahead)
        cells, at = self.mesh.inside(below)

        def normals_at(z: float) -> np.ndarray:
            return self.flank(self.radii, np.asarray(z))[1]

        return self.mesh.rows(cells, at, self.ends, normals_at, ahead)

    @cached_property
    def _condensed(self) -> CondensedPitch:
        mesh = self.mesh
        material = Material(
            E=self.material.youngs, nu=self.material.poisson, density=ANY_DENSITY
        )
        stiffness, _ = _matrices(mesh.solid, [material])
        surface = self._rows(0.0).T.tocsr()
        readings = self._rows(self.depth)
        if self._port is not None:
            surface = sp.hstack([surface, self._port.loads]).tocsr()
            readings = sp.vstack([readings, self._port.loads.T]).tocsr()
        sides = mesh.side_motions(self.wheel.pitch_angle, self.power)
        return condensed(stiffness, mesh.inner, sides, surface, readings)

    @cached_property
    def _port(self) -> Port | None:
        if self.port is None or self.port == self.hold:
            return None
        return Port.on(self.mesh, self.port, self.wheel.pitch_angle)

    @property
    def _count(self) -> int:
        return self.radii_count * self.slices

    @cached_property
    def ring(self) -> Ring:
        """All pitches."""
        return Ring(self._condensed, self.wheel.count)

    @cached_property
    def _waves(self) -> np.ndarray:
        return self.ring.waves(self._condensed.loads[:, : self._count])

    @cached_property
    def port_compliance(self) -> np.ndarray:
        """(6, 6) motion of the port by loads spread over it, about the middle of the face."""
        if self._port is None:
            return np.zeros((6, 6))
        return self._port.compliance(self.ring, slice(self._count, None))

    def whole(self, tooth: int) -> np.ndarray:
        """Return the motion of the places of the table on a tooth by forces on those of tooth 0, with
        the motion of the rim, m/N; places of a radius stand together.
        """
        pitch, count = self._condensed, self._count
        motion = pitch.readings[:count] @ self.ring.sides(self._waves, tooth)
        direct = pitch.direct[:count, :count] if tooth % self.wheel.count == 0 else 0.0
        return motion + direct

    def _rigid(self, tooth: int) -> np.ndarray:
        """Return the (n, 6) motion of the places on a tooth along their normals by a rigid body."""
        r, z = np.repeat(self.radii, self.slices), np.tile(self.middles, self.radii_count)
        points, normals = self.flank(r, z)
        for part in (points, normals):
            part[:, :2] = turned(part[:, :2], tooth * self.wheel.pitch_angle)
        return np.hstack([normals, np.cross(points, normals)])

    def teeth(self, tooth: int) -> np.ndarray:
        """Return the same without the motion of the rim."""
        rim = self._rigid(tooth) @ self.port_compliance @ self._rigid(0).T
        return self.whole(tooth) - rim

    @cached_property
    def _tables(self) -> dict[int, np.ndarray]:
        return {}

    def table(self, tooth: int) -> np.ndarray:
        """Return the smooth part of what is interpolated, symmetric, m/N."""
        if tooth not in self._tables:
            there, back = self.teeth(tooth), self.teeth(-tooth)
            table = (there + back.T) / 2
            if tooth == 0:
                r = np.repeat(self.radii, self.slices)
                table = table - self._near(r, np.tile(self.middles, self.radii_count))
            self._tables[tooth] = table
        return self._tables[tooth]

    def _near(self, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the (n, n) motion of a half-space between places on one flank, m/N."""
        points, _ = self.flank(r, z)
        lean = self.mesh.twist * (r[:, None] + r) / 2
        stretch = np.sqrt(1 + lean**2)
        along = (z[:, None] - z) * stretch
        apart = ((points[:, None] - points) ** 2).sum(axis=-1)
        across = np.maximum(apart - along**2, 0.0)
        length = (self.ends[1] - self.ends[0]) * stretch
        return between_pieces(along, across, self.depth, length, self.material)

    def matrix(self, tooth: np.ndarray, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the compliance between places (:class:`FlankCompliance`)."""
        weights = self._weights(r, z)
        out = np.empty((len(r), len(r)))
        groups = {int(k): np.flatnonzero(tooth == k) for k in np.unique(tooth)}
        for k, rows in groups.items():
            for j, columns in groups.items():
                if j > k:
                    continue
                block = weights[rows] @ self.table(k - j) @ weights[columns].T
                if j == k:
                    block = block + self._near(r[rows], z[rows])
                out[np.ix_(rows, columns)] = block
                out[np.ix_(columns, rows)] = block.T
        return out

    @cached_property
    def _splines(self) -> CubicSpline:
        return CubicSpline(self.rolled, np.eye(self.radii_count))

    def _weights(self, r: np.ndarray, z: np.ndarray) -> sp.csr_matrix:
        """Return the weights (n, places) of the table at places: cubic along the flank, linear along
        the face.
        """
        rolled = np.clip(self._rolled(r), self.rolled[0], self.rolled[-1])
        radial = self._splines(rolled)
        share = np.clip((z - self.middles[0]) / (self.middles[1] - self.middles[0]), 0, self.slices - 1)
        low = np.minimum(share.astype(int), self.slices - 2)
        share = share - low
        n, k = radial.shape
        columns = np.arange(k) * self.slices + low[:, None]
        columns = np.stack([columns, columns + 1])
        values = np.stack([radial * (1 - share)[:, None], radial * share[:, None]])
        rows = np.broadcast_to(np.arange(n)[:, None], values.shape)
        shape = (n, self._count)
        return sp.csr_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape)
