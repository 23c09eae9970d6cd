"""Problem: one bad element in a good mesh of a shaft.  Reference: the same mesh before it was
spoilt.

Cases: a sliver (a vertex pushed towards the opposite face), a mid-edge node slid along its edge
until det J turns negative at a corner and then at Gauss points, and two elements whose det J is
positive at all their nodes and Gauss points and negative in between.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse.linalg as spla
from skfem import MeshHex, MeshHex2, MeshTet, MeshTet2

import solidgear as sg
from solidgear.core.kernel.assembly import tabulate
from solidgear.core.meshing.quality import MeshError, check_mesh, element_ratios
from solidgear.core.models.solid.matrices import _cell_rule, _matrices
from solidgear.core.models.solid.mesh import _isoparametric
from solidgear.core.scene import Scene, Segment
from validation.stability.frame import Finding, curve

HEIGHTS = (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6)
SLIDES = (0.5, 0.35, 0.26, 0.24, 0.2, 0.15, 0.1)


def good_mesh():
    """Shaft and a small mesh of it with second-order tetrahedra."""
    scene = Scene.from_parts([Segment.cylinder("shaft", length=0.3, diameter=0.1)])
    return scene, sg.build(scene, "solid", element="tet10", size=0.05, graded_size=0.05).geometry


def least_at_gauss_points(mesh, name: str) -> float:
    """Least det J at the points the stiffness is integrated at, relative to the greatest in the
    same element.
    """
    det = tabulate(
        mesh.elem(), mesh.doflocs[:, mesh.dofs.element_dofs], mesh.elem(), _cell_rule(name)[0]
    ).det
    return float((det.min(axis=1) / det.max(axis=1)).min())


def spoilt(scene, geometry, mesh) -> dict:
    """What the matrices, the frequencies and the gate say to a mesh."""
    row = {
        "least det J": float(element_ratios(mesh).min()),
        "least at Gauss points": least_at_gauss_points(mesh, "tet10"),
    }
    with np.errstate(invalid="ignore"):
        materials = [segment.material for segment in scene.segments]
        k, m = _matrices(_isoparametric(mesh, "tet10", geometry.segment), materials)
    k, m = k.tocsr(), m.tocsr()
    if np.isfinite(k.data).all():
        row["greatest eigenvalue"] = float(
            spla.eigsh(k, 1, m, tol=1e-3, return_eigenvectors=False, v0=np.ones(k.shape[0]))[0]
        )
        row["trace of K"] = float(k.diagonal().sum())
        row["first bending, Hz"] = float(
            np.sqrt(
                np.sort(
                    spla.eigsh(
                        k, 8, m, sigma=-1e6, return_eigenvectors=False, v0=np.ones(k.shape[0])
                    )
                )[6]
            )
            / (2 * np.pi)
        )
    else:
        row["stiffness"] = "not a number"
    try:
        quality = check_mesh(mesh)
        row |= {"least volume over mean": quality.min_volume_ratio, "gate": "passes"}
    except MeshError as error:
        row["gate"] = "nearly folded" if "nearly folded" in str(error) else "inverted"
    return row


def flattened(mesh, vertex: int, element: int, height: float):
    """The mesh with a vertex of an element brought down to a part of its height over the opposite
    face, edges kept straight.
    """
    others = [v for v in mesh.t[:4, element] if v != vertex]
    doflocs = mesh.doflocs.copy()
    face = doflocs[:, others].mean(axis=1)
    doflocs[:, vertex] = face + height * (doflocs[:, vertex] - face)
    touched = np.flatnonzero((mesh.edges == vertex).any(axis=0))
    doflocs[:, mesh.dofs.edge_dofs[0, touched]] = doflocs[:, mesh.edges[:, touched]].mean(axis=1)
    return replace(mesh, doflocs=doflocs)


def inner_vertex(mesh) -> tuple[int, int]:
    """A vertex inside the shaft and one of its elements that can be flattened without turning
    another inside out.
    """
    surface = np.unique(mesh.facets[:, mesh.boundary_facets()])
    for vertex in np.setdiff1d(np.unique(mesh.t[:4]), surface):
        for element in np.flatnonzero((mesh.t[:4] == vertex).any(axis=0)):
            around = element_ratios(flattened(mesh, vertex, element, 1e-6))
            if around.min() > 0.1:
                return int(vertex), int(element)
    raise RuntimeError("no vertex of this mesh can be moved so")


def slid(mesh, edge: int, place: float):
    """The mesh with the mid node of an edge at a part of its length."""
    doflocs = mesh.doflocs.copy()
    a, b = mesh.edges[:, edge]
    doflocs[:, mesh.dofs.edge_dofs[0, edge]] = (1 - place) * doflocs[:, a] + place * doflocs[:, b]
    return replace(mesh, doflocs=doflocs)


def negative_between() -> dict[str, object]:
    """One element each that is inverted between its nodes and Gauss points; their least det J is
    known in closed form.
    """
    tet = MeshTet2.from_mesh(MeshTet.init_refdom())
    x, y, z = tet.doflocs
    # det J = (x - 0.37) (x - 0.48), at least -0.003
    bent = replace(tet, doflocs=np.array([x * x / 2 - 0.37 * x, y * (x - 0.48), z]))
    cube = MeshHex.init_tensor(*3 * [np.array([0.0, 1.0])])
    cube = MeshHex2.from_mesh(MeshHex(cube.p, cube.t[[0, 2, 1, 3, 4, 6, 5, 7]]))
    x, y, z = cube.doflocs
    # det J = 1 - 1.1 z (1 - 8 (x - 1/4)^2), at least -0.1
    pressed = replace(cube, doflocs=np.array([x, y, z - 0.55 * z * z * (1 - 8 * (x - 0.25) ** 2)]))
    return {"tet10": bent, "hex27": pressed}


def measure(quick: bool = False) -> Finding:
    """Rows of all cases."""
    scene, geometry = good_mesh()
    mesh = geometry.mesh
    rows = []
    vertex, element = inner_vertex(mesh)
    for height in HEIGHTS[::2] if quick else HEIGHTS:
        rows.append(
            {"case": "sliver", "amount": height}
            | spoilt(scene, geometry, flattened(mesh, vertex, element, height))
        )
    inner = np.setdiff1d(np.arange(mesh.edges.shape[1]), mesh.boundary_edges())
    edge = int(inner[len(inner) // 2])
    for place in SLIDES[::2] if quick else SLIDES:
        rows.append(
            {"case": "mid node", "amount": place} | spoilt(scene, geometry, slid(mesh, edge, place))
        )
    for name, one in negative_between().items():
        nodes = tabulate(
            one.elem(), one.doflocs[:, one.dofs.element_dofs], one.elem(), one.elem().doflocs.T
        ).det
        rows.append(
            {
                "case": f"between, {name}",
                "least at nodes": nodes.min() / nodes.max(),
                "least at Gauss points": least_at_gauss_points(one, name),
                "least det J": float(element_ratios(one)[0]),
            }
        )
        rows[-1]["gate"] = "inverted" if _refused(one) else "passes"
    sliver = [r for r in rows if r["case"] == "sliver"]
    worst = sliver[-1]
    moved = worst["first bending, Hz"] / sliver[0]["first bending, Hz"] - 1
    nodes = [r for r in rows if r["case"] == "mid node"]
    unseen = [r for r in nodes if r["gate"] == "inverted" and "stiffness" not in r]
    shifts = [abs(r["first bending, Hz"] / nodes[0]["first bending, Hz"] - 1) for r in unseen]
    unnoticed = max(shifts, default=float("nan"))
    return Finding(
        "bad_elements",
        "Slivers, inverted elements",
        "One bad element leaves the answers alone and ruins the numbers behind them: a "
        "sliver raises the greatest eigenvalue, an inverted corner goes unseen by the "
        "integration.",
        f"A sliver of {worst['amount']:g} of its height moves first bending by {moved:+.0e} and the "
        f"greatest eigenvalue by {worst['greatest eigenvalue'] / sliver[0]['greatest eigenvalue']:.0e}. "
        f"An element inverted at a corner is positive at every Gauss point still at "
        f"{', '.join(str(r['amount']) for r in unseen)} of an edge, where first bending moves by "
        f"{unnoticed:.0e}.",
        "Every 3D mesh passes a gate that bounds det J from below over the whole "
        "element, and is refused below 1e-3 of its greatest value.",
        "tests/test_mesh_quality.py::test_inversion_between_all_samples_is_seen",
        rows,
    )


def _refused(mesh) -> bool:
    try:
        check_mesh(mesh)
    except MeshError:
        return True
    return False


def draw(finding: Finding, axes) -> None:
    """Growth of the greatest eigenvalue and change of first bending with the height of the sliver."""
    rows = [r for r in finding.rows if r["case"] == "sliver"]

    def times(name):
        return lambda r: r[name] / rows[0][name]

    def moved(r):
        return r["first bending, Hz"] / rows[0]["first bending, Hz"] - 1

    words = "greatest eigenvalue, times that of the good mesh"
    curve(axes, rows, "amount", times("greatest eigenvalue"), "o-", "#c4541c", words)
    curve(axes, rows[1:], "amount", moved, "s-", "#0072b2", "change of first bending")
    axes.invert_xaxis()
    axes.set(
        xlabel="height of the sliver, part of the good element's",
        ylabel="factor, relative change",
        title="One sliver in a mesh of a shaft",
    )
    axes.legend()
