"""Assembly of stiffness and mass against scikit-fem's own vector forms: same mesh, same quadrature,
one process, interleaved.

    python -m validation.assembly_speed [--runs 3] [--only tet10]

Entries are compared before times.  Wall and processor seconds are medians; the processor's are the
steadier on a busy machine. Asked for: K and M together at least 50 times faster for TET10 at about
94 thousand unknowns.
"""

from __future__ import annotations

import argparse
import statistics
import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from skfem import Basis, BilinearForm, ElementVector, MeshHex2, MeshTet2
from skfem.element import ElementHexS2
from skfem.helpers import ddot, dot, sym_grad, trace
from skfem.quadrature import get_quadrature
from skfem.refdom import RefQuad

import solidgear as sg
from solidgear.models.harmonic import blocks as harmonic_blocks
from solidgear.models.solid import matrices as solid_matrices
from validation.common import ROOT, results_folder, show, write_rows

SCENE = ROOT / "geometry" / "pinion_overhung.toml"
SOLIDS = {
    "tet10": {"size": 0.022, "graded_size": 0.0038},
    "hex20": {"layers": 5},
    "hex27": {"layers": 3, "radial_layers": 1},
}
AGREE = 1e-12


@dataclass(repr=False)
class MeshHex20(MeshHex2):
    """Twenty-node geometry; scikit-fem ships none."""

    elem: type = ElementHexS2


class Case(NamedTuple):
    """What is raced: ``ours()`` gives (K, M); scikit-fem assembles two forms on a basis and keeps
    some of the unknowns.
    """

    ours: object
    basis: object
    stiffness: object
    mass: object
    keep: object


def moduli(scene, segment):
    """Lame constants and density, a column each."""
    materials = [s.material for s in scene.segments]
    e, nu, rho = (
        np.array([getattr(m, k) for m in materials])[segment][:, None]
        for k in ("E", "nu", "density")
    )
    return e * nu / (1 + nu) / (1 - 2 * nu), e / 2 / (1 + nu), rho


def solid_case(scene, element, options):
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
        return Basis(
            mesh, ElementVector(geometry.element), quadrature=solid_matrices._cell_rule(element)
        )

    return Case(
        lambda: solid_matrices._matrices(geometry, [s.material for s in scene.segments]),
        basis,
        stiffness,
        mass,
        slice(None),
    )


def harmonic_case(scene):
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
        normal, shear = (
            sum(x * y for x, y in zip(a[:3], b[:3])),
            sum(x * y for x, y in zip(a[3:], b[3:])),
        )
        return np.pi * r * (lame * sum(a[:3]) * sum(b[:3]) + 2 * mu * normal + mu * shear)

    mass = BilinearForm(
        lambda u, v, w: np.pi * w.x[0] * rho * (2 * u[0] * v[0] + 2 * u[1] * v[1] + u[2] * v[2])
    )
    rule = get_quadrature(RefQuad, 2 * (order + 2) - 1)

    def basis():
        return Basis(mesh, ElementVector(element, dim=3), quadrature=rule)

    keep = np.ones((int(body.geometry.dofs.max()) + 1, 3), bool)
    on_axis = (
        Basis(mesh, element, quadrature=rule)
        .get_dofs(mesh.facets_satisfying(lambda x: x[0] < 1e-9))
        .all()
    )
    keep[on_axis, 1:] = False

    def ours():
        work = harmonic_blocks._Work(
            scene, mesh, element, body.geometry.dofs, body.geometry.meridian, order
        )
        block = work.bending_block("bending_z", (2, 3), 1, [(scene.stations[0], "average")])
        return block.stiffness, block.mass

    return Case(ours, basis, stiffness, mass, np.flatnonzero(keep.ravel()))


def clocked(work):
    """Result, wall seconds, processor seconds."""
    wall, cpu = time.perf_counter(), time.process_time()
    out = work()
    return out, time.perf_counter() - wall, time.process_time() - cpu


def restricted(matrix, keep):
    return matrix if isinstance(keep, slice) else matrix[keep][:, keep]


def race(case: Case, runs: int) -> dict:
    """Medians of both sides, taken in turn; scikit-fem's K and M share one basis, which is counted
    with both.
    """
    seconds = {name: ([], []) for name in ("ours", "basis", "K", "M")}

    def run(name, work):
        out, *taken = clocked(work)
        for kept, t in zip(seconds[name], taken):
            kept.append(t)
        return out

    gap = {}
    case.ours()  # imports and first touch of memory
    for i in range(runs):
        k, m = run("ours", case.ours)
        basis = run("basis", case.basis)
        k_theirs = run(
            "K", lambda basis=basis: restricted(case.stiffness.assemble(basis), case.keep)
        )
        m_theirs = run("M", lambda basis=basis: restricted(case.mass.assemble(basis), case.keep))
        if not i:
            gap = {
                "K": abs(k - k_theirs).max() / abs(k_theirs).max(),
                "M": abs(m - m_theirs).max() / abs(m_theirs).max(),
            }
            if max(gap.values()) > AGREE:
                raise SystemExit(f"entries differ by {gap}: times mean nothing")
        del basis, k_theirs, m_theirs
        # ours is quick: more samples between two of theirs
        for _ in range(2):
            run("ours", case.ours)
    wall, cpu = ({name: statistics.median(t[c]) for name, t in seconds.items()} for c in (0, 1))
    return {
        "unknowns": k.shape[0],
        "K differs": float(gap["K"]),
        "M differs": float(gap["M"]),
        "ours K+M s": wall["ours"],
        "skfem K s": wall["K"] + wall["basis"],
        "skfem M s": wall["M"] + wall["basis"],
        "K ratio": (wall["K"] + wall["basis"]) / wall["ours"],
        "M ratio": (wall["M"] + wall["basis"]) / wall["ours"],
        "K+M ratio": (wall["K"] + wall["M"] + wall["basis"]) / wall["ours"],
        "K+M ratio, cpu": (cpu["K"] + cpu["M"] + cpu["basis"]) / cpu["ours"],
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--only", choices=[*SOLIDS, "harmonic"])
    args = parser.parse_args()
    scene = sg.load(SCENE)
    rows = []
    for name in [args.only] if args.only else [*SOLIDS, "harmonic"]:
        case = harmonic_case(scene) if name == "harmonic" else solid_case(scene, name, SOLIDS[name])
        rows.append({"element": name, **race(case, args.runs)})
    show(
        f"assembly, {args.runs} interleaved runs; ratios: scikit-fem over our K and M together",
        rows,
    )
    write_rows(results_folder("assembly_speed") / "rows.csv", rows)


if __name__ == "__main__":
    main()
