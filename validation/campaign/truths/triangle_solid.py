"""A body of revolution in triangles and plain cylindrical components: matrices, seats, energies.

With y the axis and ``z = r cos t, x = r sin t``, harmonic n of the displacement is

    u_r = U cos nt,  u_t = V sin nt,  u_y = W cos nt          (n = 0: torsion is u_t = V)

and its strains are, each times a sine or a cosine,

    rr = U,r                      tt = (U + n V) / r      yy = W,y
    rt = V,r - (n U + V) / r      ty = V,y - n W / r      ry = U,y + W,r

U, V and W are continuous polynomials on triangles (:mod:`validation.campaign.truths.triangle_mesh`). On the
axis a displacement has one value: for n = 0, U = V = 0; for n = 1, V = -U and W = 0; else all three
are zero.

Inside, lengths are in units of the largest radius, moduli and densities of the largest there are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from skfem import (
    Basis,
    BilinearForm,
    ElementTriP2,
    ElementTriP3,
    ElementTriP4,
    FacetBasis,
    MeshTri,
)

from solidgear.core.errors import SolidgearError
from solidgear.core.scene import Scene
from validation.campaign.truths.triangle_mesh import TriangleMesh

ELEMENTS = {2: ElementTriP2, 3: ElementTriP3, 4: ElementTriP4}


@dataclass(frozen=True)
class Family:
    """Motions that go together: waves around the axis, which of U, V and W, and what of the motion
    of a station, by place in x y z thx thy thz.
    """

    waves: int
    parts: tuple[int, ...]
    components: tuple[int, ...]


FAMILIES = {
    "bending": Family(1, (0, 1, 2), (2, 3)),
    "axial": Family(0, (0, 2), (1,)),
    "torsion": Family(0, (1,), (4,)),
    "n=2": Family(2, (0, 1, 2), ()),
}

#: products of a function u and a test function v, of which all energies over the meridian consist
FORMS = {
    "tt": BilinearForm(lambda u, v, w: u * v / w.x[0]),
    "rt": BilinearForm(lambda u, v, w: u.grad[0] * v),
    "yt": BilinearForm(lambda u, v, w: u.grad[1] * v),
    "rr": BilinearForm(lambda u, v, w: u.grad[0] * v.grad[0] * w.x[0]),
    "yy": BilinearForm(lambda u, v, w: u.grad[1] * v.grad[1] * w.x[0]),
    "yr": BilinearForm(lambda u, v, w: u.grad[1] * v.grad[0] * w.x[0]),
    "mass": BilinearForm(lambda u, v, w: u * v * w.x[0]),
}


class Solid:
    """A body of revolution on one mesh, without its bearings, in polynomials of order 2, 3 or 4; its
    units are `radius`, `modulus` and `density`, SI.
    """

    def __init__(self, scene: Scene, mesh: TriangleMesh, order: int):
        materials = [segment.material for segment in scene.segments]
        self.scene, self.mesh = scene, mesh
        self.radius = max(max(s.outer0, s.outer1) for s in scene.segments)
        self.modulus = max(m.E for m in materials)
        self.density = max(m.density for m in materials)
        mu = np.array([m.shear_modulus for m in materials]) / self.modulus
        nu = np.array([m.nu for m in materials])
        self.mu, self.lame = mu[mesh.segment], (2 * mu * nu / (1 - 2 * nu))[mesh.segment]
        self.rho = np.array([m.density / self.density for m in materials])[mesh.segment]
        self.flat = MeshTri(mesh.points, mesh.triangles)
        # 1 / r is no polynomial: two orders more than those need
        self.points = 2 * order + 2
        self.basis = Basis(self.flat, ELEMENTS[order](), intorder=self.points)
        self.count = self.basis.N
        self.r, self.y = self.basis.doflocs
        self.axis = self.r < 1e-12
        nb = self.basis.Nbfun
        # (test function, function, triangle)
        self.products = {
            name: form.coo_data(self.basis).data.reshape(nb, nb, -1).swapaxes(0, 1)
            for name, form in FORMS.items()
        }

    def matrices(self, family: Family) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """Stiffness and mass of all unknowns, one component after the other."""
        n, p, mu, lame = family.waves, self.products, self.mu, self.lame
        turned = {name: local.swapaxes(0, 1) for name, local in p.items()}
        whole, cross = lame + 2 * mu, p["rt"] + turned["rt"]
        blocks = {
            (0, 0): whole * (p["rr"] + p["tt"]) + lame * cross + mu * (n * n * p["tt"] + p["yy"]),
            (1, 1): whole * n * n * p["tt"] + mu * (p["rr"] - cross + p["tt"] + p["yy"]),
            (2, 2): whole * p["yy"] + mu * (p["rr"] + n * n * p["tt"]),
            (0, 1): n * (whole * p["tt"] + lame * turned["rt"] + mu * (p["tt"] - p["rt"])),
            (0, 2): lame * (p["yr"] + p["yt"]) + mu * turned["yr"],
            (1, 2): n * (lame * p["yt"] - mu * turned["yt"]),
        }
        blocks |= {(j, i): block.swapaxes(0, 1) for (i, j), block in blocks.items() if i < j}
        around = np.pi if n else 2 * np.pi
        stiffness = [[around * self._sum(blocks[i, j]) for j in family.parts] for i in family.parts]
        mass = [around * self._sum(self.rho * p["mass"])] * len(family.parts)
        return sp.block_array(stiffness, format="csr"), sp.block_diag(mass, format="csr")

    def energy(self, family: Family, moved: np.ndarray) -> np.ndarray:
        """(k, k) twice the strain energies of columns of unknowns with one another.

        From strains at points, where rigid motion leaves no more than rounding squared: products
        with the stiffness matrix would leave its rounding once.
        """
        around = np.pi if family.waves else 2 * np.pi
        area = around * self.basis.dx * self.basis.default_parameters()["x"][0]
        lame, twice, once = (area * one[:, None] for one in (self.lame, 2 * self.mu, self.mu))
        weight = np.array([lame, *[twice] * 3, *[once] * 3]).ravel()
        strains = [self._strains(family, column) for column in moved.T]
        return np.array([[a @ (weight * b) for b in strains] for a in strains])

    def _strains(self, family: Family, column: np.ndarray) -> np.ndarray:
        """Dilatation, then rr, tt, yy, rt, ty and ry at the points of all triangles, end to end."""
        n, r = family.waves, self.basis.default_parameters()["x"][0]
        parts = dict(zip(family.parts, column.reshape(len(family.parts), -1)))
        fields = [self.basis.interpolate(parts.get(k, np.zeros(self.count))) for k in range(3)]
        (u, v, w), (du, dv, dw) = map(np.asarray, fields), [f.grad for f in fields]
        normal = du[0], (u + n * v) / r, dw[1]
        shear = dv[0] - (n * u + v) / r, dv[1] - n * w / r, du[1] + dw[0]
        return np.array([sum(normal), *normal, *shear]).ravel()

    def _sum(self, local: np.ndarray) -> sp.csr_matrix:
        """Matrix of one pair of components from those of the triangles."""
        dofs = self.basis.element_dofs
        rows, columns = np.broadcast_arrays(dofs[:, None], dofs[None])
        entries = (local.ravel(), (rows.ravel(), columns.ravel()))
        return sp.coo_matrix(entries, shape=(self.count, self.count)).tocsr()

    def rigid(self, component: int, y0: float) -> np.ndarray:
        """(3, n) U, V and W of all nodes in a motion of a station at y0 with the whole body."""
        r, h, zero = self.r, self.y - y0 / self.radius, np.zeros(self.count)
        one = zero + 1.0
        motions = {2: (one, -one, zero), 3: (h, -h, -r), 1: (zero, zero, one), 4: (zero, r, zero)}
        return np.array(motions[component])

    def surface(self, station) -> FacetBasis:
        """The seat of a station, or its section."""
        facets, on = self.flat.facets, np.zeros(self.flat.facets.shape[1], bool)
        for piece in self.mesh.surfaces[station.name]:
            on |= np.isin(facets, piece).all(axis=0)
        chosen = np.flatnonzero(on)
        return FacetBasis(self.flat, self.basis.elem, facets=chosen, intorder=self.points)

    def mean(self, family: Family, station) -> np.ndarray:
        """(k, unknowns) rows of the rigid motion nearest to that of a surface, by area."""
        surface = self.surface(station)
        weight = BilinearForm(lambda u, v, w: u * v * w.x[0]).assemble(surface)
        motions = [self.rigid(c, station.y)[list(family.parts)] for c in family.components]
        shape = (len(motions), len(family.parts) * self.count)
        loads = np.reshape([(weight @ motion.T).T for motion in motions], shape)
        flat = np.reshape(motions, shape)
        return np.linalg.solve(loads @ flat.T, loads)

    def ties(self, family: Family) -> sp.csr_matrix:
        """All unknowns from those that the axis and rigid seats leave."""
        n, count = family.waves, self.count
        own = np.ones((3, count), bool)
        own[:, self.axis] = [[n == 1], [False], [n == 0]]
        seats: list[np.ndarray] = []
        for station in self.scene.stations:
            if station.attachment == "rigid":
                seat = np.zeros(count, bool)
                seat[self.basis.get_dofs(self.surface(station).find).flatten()] = True
                if not own[0, seat].all():
                    raise SolidgearError(f'the rigid seat "{station.name}" touches another')
                own[:, seat] = False
                seats += [(self.rigid(c, station.y) * seat).ravel() for c in family.components]
        follow = sp.eye_array(3 * count, format="csr")
        if n == 1:  # V = -U on the axis
            axis = np.flatnonzero(self.axis)
            there = (count + axis, axis)
            follow = follow - sp.csr_array((np.ones(len(axis)), there), shape=follow.shape)
        carried = sp.csr_array(np.reshape(seats, (-1, 3 * count)).T)
        out = sp.hstack([follow[:, own.ravel()], carried], format="csr")
        out = out[np.concatenate([k * count + np.arange(count) for k in family.parts])]
        return out[:, np.flatnonzero(np.diff(out.tocsc().indptr))]
