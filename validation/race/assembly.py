"""Assembly of stiffness and mass against scikit-fem's own vector forms: same mesh, same quadrature,
one process.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from skfem import Basis, BilinearForm, ElementVector, MeshHex2, MeshTet2
from skfem.element import ElementHexS2
from skfem.helpers import ddot, dot, sym_grad, trace
from skfem.quadrature import get_quadrature
from skfem.refdom import RefQuad

import solidgear as sg
from solidgear.core.models.harmonic import blocks as harmonic_blocks
from solidgear.core.models.solid import matrices as solid_matrices
from validation.common import ROOT
from validation.race.heat import Check, Clock, Heat, Sample
from validation.race.race import Race

SCENE = ROOT / "geometry" / "pinion_overhung.toml"
SOLIDS = {
    "tet10": {"size": 0.022, "graded_size": 0.0038},
    "hex20": {"layers": 5},
    "hex27": {"layers": 3, "radial_layers": 1},
}
#: for a quick run
COARSE = {"size": 0.04, "graded_size": 0.03}


@dataclass(repr=False)
class MeshHex20(MeshHex2):
    """Twenty-node geometry; scikit-fem ships none."""

    elem: type = ElementHexS2


class Case(NamedTuple):
    """What is raced: ``ours()`` gives (K, M); scikit-fem assembles two forms on a basis and keeps
    some of the unknowns.
    """

    ours: Callable[[], tuple]
    basis: Callable[[], Basis]
    stiffness: Any
    mass: Any
    keep: Any


def moduli(scene, segment):
    """Lame constants and density, a column each."""
    materials = [s.material for s in scene.segments]
    e, nu, rho = (
        np.array([getattr(m, k) for m in materials])[segment][:, None]
        for k in ("E", "nu", "density")
    )
    return e * nu / (1 + nu) / (1 - 2 * nu), e / 2 / (1 + nu), rho


def solid_case(scene, element, options) -> Case:
    """A 3D solid."""
    geometry = sg.build(scene, "solid", element=element, **options).geometry
    mesh = {"tet10": MeshTet2, "hex20": MeshHex20, "hex27": MeshHex2}[element](
        geometry.nodes, geometry.mesh.t
    )
    lame, mu, rho = moduli(scene, geometry.segment)
    stiffness = BilinearForm(
        lambda u, v, w: (
            lame * trace(sym_grad(u)) * trace(sym_grad(v)) + 2 * mu * ddot(sym_grad(u), sym_grad(v))
        )
    )
    mass = BilinearForm(lambda u, v, w: rho * dot(u, v))

    def basis():
        rule = solid_matrices._cell_rule(element)
        return Basis(mesh, ElementVector(geometry.element), quadrature=rule)

    def ours():
        return solid_matrices._matrices(geometry, [s.material for s in scene.segments])

    return Case(ours, basis, stiffness, mass, slice(None))


def harmonic_case(scene) -> Case:
    """Bending (n = 1) on the meridian; unknowns that vanish on the axis are left out by both."""
    body = sg.build(scene, "harmonic")
    mesh, element, order = body.geometry.mesh, body.geometry.element, body.mesh["order"]
    lame, mu, rho = moduli(scene, body.geometry.meridian.segment)

    def strain(u, r):
        g = u.grad
        radial, turning = u[0] + u[1], u[0] - u[1]
        dr, dt, dw = g[0] + g[1], g[0] - g[1], g[2]
        return (
            dr[0],
            2 * u[1] / r,
            dw[1],
            -radial / r - dt[0] + turning / r,
            -dt[1] - u[2] / r,
            dr[1] + dw[0],
        )

    @BilinearForm
    def stiffness(u, v, w):
        r = w.x[0]
        a, b = strain(u, r), strain(v, r)
        normal = sum(x * y for x, y in zip(a[:3], b[:3]))
        shear = sum(x * y for x, y in zip(a[3:], b[3:]))
        return np.pi * r * (lame * sum(a[:3]) * sum(b[:3]) + 2 * mu * normal + mu * shear)

    mass = BilinearForm(
        lambda u, v, w: np.pi * w.x[0] * rho * (2 * u[0] * v[0] + 2 * u[1] * v[1] + u[2] * v[2])
    )
    rule = get_quadrature(RefQuad, 2 * (order + 2) - 1)

    def basis():
        return Basis(mesh, ElementVector(element, dim=3), quadrature=rule)

    keep = np.ones((int(body.geometry.dofs.max()) + 1, 3), bool)
    axis = mesh.facets_satisfying(lambda x: x[0] < 1e-9)
    keep[Basis(mesh, element, quadrature=rule).get_dofs(axis).all(), 1:] = False

    def ours():
        work = harmonic_blocks.Work(scene, body.geometry)
        block = work.block("bending_z", (2, 3), [(scene.stations[0], "average")])
        return block.stiffness, block.mass

    return Case(ours, basis, stiffness, mass, np.flatnonzero(keep.ravel()))


def assembled(case: Case) -> Sample:
    """K and M by scikit-fem, which share one basis."""

    def restricted(form):
        matrix = form.assemble(basis)
        return matrix if isinstance(case.keep, slice) else matrix[case.keep][:, case.keep]

    clock = Clock()
    basis = clock.stage("basis", case.basis)
    k = clock.stage("K", lambda: restricted(case.stiffness))
    m = clock.stage("M", lambda: restricted(case.mass))
    return clock.sample((k, m), unknowns=k.shape[0])


def element(heat: Heat, name: str) -> None:
    """One kind of element."""
    scene = sg.load(SCENE)
    if name == "harmonic":
        case = harmonic_case(scene)
    else:
        case = solid_case(scene, name, COARSE if heat.quick and name == "tet10" else SOLIDS[name])
    # prepared: imports and first touch of memory; ours is quick: more samples between two of theirs
    ours = heat.add("solidgear, K and M", case.ours, prepare=case.ours, repeats=3)

    def differ(answer: tuple, which: int) -> float:
        mine, theirs = ours.answer[which], answer[which]
        return abs(mine - theirs).max() / abs(theirs).max()

    why = "the same sums in another order"
    checks = [Check(w, partial(differ, which=i), 1e-12, why) for i, w in enumerate("KM")]
    theirs = heat.add("scikit-fem", partial(assembled, case), checks=checks)
    asked = 50.0 if name == "tet10" else None
    heat.ratio("scikit-fem's K and M / ours", theirs, ours, asked)


ASSEMBLY = Race(
    "assembly of K and M against scikit-fem's own forms",
    {name: partial(element, name=name) for name in (*SOLIDS, "harmonic")},
)
