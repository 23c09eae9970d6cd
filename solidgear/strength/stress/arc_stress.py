r"""Stress of a harmonic solid on the arc of a notch: along the arc, around the axis, and the traction that a
free surface must not have.

Strains are those of :func:`solidgear.core.models.harmonic.families.strains`; with the outward normal n and
the tangent s of the meridian,

    along = s . sigma s,   around = sigma_tt,   shear = s . sigma t,   traction = sigma n

The traction is zero for the exact solution. A finite element solution leaves some of it: the error
of the stress at that place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core import Block, Body, SolidgearError
from solidgear.core.kernel.cell_shapes import Kind
from solidgear.core.meshing.cells import HIGH, LOW, OUT
from solidgear.core.models.harmonic.blocks import Work
from solidgear.core.models.harmonic.families import TORSION, family_of, strains
from solidgear.core.models.harmonic.mesh import HarmonicMesh
from solidgear.core.scene.corner import Corner

#: places on the side of a cell, and the step of differences in its reference coordinates
PLACES, STEP = 65, 1e-3


@dataclass(frozen=True)
class ArcStress:
    """Stress along the arc of a notch, from its foot on: of a fillet from the cylinder to the face.

    Of harmonic n >= 1 these are amplitudes: `shear` goes with sin nt, the others with cos nt.
    """

    angle: np.ndarray  #: (q,) from the foot of the arc, rad
    along: np.ndarray  #: (q,) normal stress along the meridian, Pa
    around: np.ndarray  #: (q,) normal stress around the axis, Pa
    shear: np.ndarray  #: (q,) between both, Pa
    traction: np.ndarray  #: (q,) size of the traction, which should be zero, Pa
    slope: np.ndarray  #: (2, q) derivative of `along` and `shear` along the normal, outwards, Pa/m


@dataclass(frozen=True)
class RootArc:
    """Arc of a notch of revolution, from its foot, where it runs along the axis, to one side."""

    name: str  #: of the notch, in words
    #: centre, foot: (r, y) of its middle, and of its lowest place, m
    centre: tuple[float, float]
    foot: tuple[float, float]
    radius: float  #: m
    side: int  #: 1 where the arc lies at larger y than its foot, else -1

    @classmethod
    def of(cls, corner: Corner) -> RootArc:
        """Return the arc of a fillet; refuse a chamfer, which has none."""
        if corner.centre is None:
            raise SolidgearError(f'{corner.kind} "{corner.name}" is no arc')
        what = f'fillet "{corner.name}"'
        return cls(what, corner.centre, corner.on_cylinder, corner.radial, -corner.side)


class Arc:
    """Root of a notch on the mesh of a harmonic solid; refused if the mesh has no such arc."""

    def __init__(self, scene, body: Body, root: RootArc):
        mesh: HarmonicMesh = body.geometry  # type: ignore[assignment]
        flat = mesh.meridian
        self.root, self.scene = root, scene
        self._work = Work(scene, mesh)
        away = np.hypot(*(flat.centre - np.array(root.centre)[:, None]))
        beside = root.side * (flat.points[1][flat.cells].mean(axis=0) - root.foot[1]) > 0
        cells = np.flatnonzero((flat.arc >= 0) & (away < 1e-6 * root.radius) & beside)
        if not len(cells):
            raise SolidgearError(f"the mesh has no arc of the {root.name}")
        self._cells = cells

    def stress(self, block: Block, u: np.ndarray) -> ArcStress:
        """Compute the stress under displacements (n,) of a block."""
        family = family_of(block.name)
        values = self._work.geometry.whole(family, u)
        parts = np.concatenate(
            [self._on_cell(int(k), family.waves, values) for k in self._cells], axis=1
        )
        angle, along, around, shear, traction, *slope = parts[
            :, np.argsort(parts[0], kind="stable")
        ]
        return ArcStress(angle, along, around, shear, traction, np.array(slope))

    def _on_cell(self, cell: int, waves: int, values: np.ndarray) -> np.ndarray:
        """Return angle, along, around, shear, traction and both slopes (7, q) on the arc of a cell."""
        edge = int(self._work.flat.arc[cell])
        t = np.linspace(0.0, 1.0, PLACES)
        end = np.full(PLACES, float(edge in (OUT, HIGH)))
        points = np.array([t, end] if edge in (LOW, HIGH) else [end, t])
        kind = next(k for k in self._work.shapes.kinds if cell in k.cells)
        sigma, place, jac = self._tensor(kind, cell, waves, values, points)
        centre = np.array(self.root.centre)[:, None]
        normal = (centre - place) / np.hypot(*(centre - place))
        tangent = np.array([-normal[1], normal[0]])
        across = _across(sigma, normal)
        traction = np.sqrt((across**2).sum(axis=0))
        distance = np.abs(place - np.array(self.root.foot)[:, None])
        angle = np.arctan2(distance[1], np.abs(centre[0] - place[0]))
        # differences along reference coordinates, turned to the normal with tensors as they are there
        way = np.linalg.solve(jac, normal.T[:, :, None])[:, :, 0].T
        slopes = np.zeros((2, PLACES))
        for k in (0, 1):
            step = np.zeros((2, 1))
            step[k] = STEP
            ahead, back = (
                self._tensor(kind, cell, waves, values, points + sign * step)[0] for sign in (1, -1)
            )
            rate = _along_and_shear((ahead - back) / (2 * STEP), tangent)
            slopes += way[k] * rate
        along, shear = _along_and_shear(sigma, tangent)
        return np.array([angle, along, sigma[1], shear, traction, *slopes])

    def _tensor(self, kind: Kind, cell: int, waves: int, values: np.ndarray, points: np.ndarray):
        """Return stress (6, q) rr, tt, yy, rt, ty, ry, places (2, q) and Jacobians (q, 2, 2) at
        reference points of a cell.
        """
        table = self._work.shapes.on(kind, np.array([cell]), points)
        r = table.x[0][0]
        slope = table.gradient(np.ones((1, len(r))))[0]
        functions = np.array([table.value / r, slope[0], slope[1]])
        fields = np.einsum("ibq,bc->qic", functions, values[self._work.dofs[:, cell]])
        material = self.scene.segments[self._work.flat.segment[cell]].material
        if waves == TORSION:
            strain = np.zeros((6, len(r)))
            strain[3], strain[4] = r * fields[:, 1, 0], r * fields[:, 2, 0]
        else:
            strain = np.einsum("kic,qic->kq", np.array(strains(waves)), fields)
        mu = material.shear_modulus
        lame = 2 * mu * material.nu / (1 - 2 * material.nu)
        sigma = mu * strain
        sigma[:3] = 2 * sigma[:3] + lame * strain[:3].sum(axis=0)
        return sigma, np.array([r, table.x[1][0]]), table.tangent[0]


def _across(sigma: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the traction (3, q) along r, y and around the axis on a surface of some normal (r, y)."""
    rr, _, yy, rt, ty, ry = sigma
    n, m = normal
    return np.array([n * rr + m * ry, n * ry + m * yy, n * rt + m * ty])


def _along_and_shear(sigma: np.ndarray, tangent: np.ndarray) -> np.ndarray:
    """Return the normal stress along a tangent (r, y) and the shear between it and the
    circumference (2, q).
    """
    r, y, around = _across(sigma, tangent)
    return np.array([tangent[0] * r + tangent[1] * y, around])
