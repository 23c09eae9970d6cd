"""Problem: a sharp shoulder under a pure moment.  Reference: a finely graded harmonic solid of high
order.

Models: the harmonic solid on uniform meshes (orders of convergence against twice the corner
exponent), on graded ones, and the greatest strain on the surface, which has no limit.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse.linalg as spla
from skfem import ElementQuad1

import solidgear as sg
from solidgear.core.kernel.assembly import reference, tabulate
from solidgear.core.meshing.corners import sharpest_corner
from solidgear.core.scene import STEEL, Port, Scene, Segment
from validation.manual.models import FIRM, bearing
from validation.stability.frame import Finding, curve

THIN, THICK, STEP, END = 0.05, 0.075, 0.1, 0.2  # radii and places, m
REFINEMENTS = (1, 2, 4, 8)
LAYERS, RATIO = (2, 4, 6, 7), 0.15


def shaft() -> Scene:
    """Thin and thick shaft."""
    segments = [
        Segment(name="thin", y0=0.0, y1=STEP, outer0=THIN, outer1=THIN),
        Segment(name="thick", y0=STEP, y1=END, outer0=THICK, outer1=THICK),
    ]
    width = 2e-4 * THIN
    clamp = bearing("clamp", END - width / 2, width, [FIRM] * 6)
    return Scene.from_parts(
        segments, bearings=[clamp], port=Port(y=0.0, lo=0.0, hi=width, attachment="section")
    )


def tilt(body, scene) -> float:
    """Tilt of the thin end under a unit moment."""
    return sg.condense(body, scene, port="port").compliance[3, 3]


def greatest_strain(body, scene) -> float:
    """Greatest axial strain at the middles of surface cells near the shoulder, over M r / E I of
    the thin shaft.
    """
    block, work = body.blocks[0], body.geometry
    here, there = (
        block.ports[2 * body.port_index(n) : 2 * body.port_index(n) + 2] for n in ("port", "clamp")
    )
    # springs that hold the clamped section carry the moment; their stiffness moves the shaft but
    # does not strain it
    held = (block.stiffness + there.T @ there * 1e10).tocsc()
    u = spla.spsolve(held, here[1].toarray().ravel())
    flat, dofs = work.meridian, work.dofs
    full = np.zeros((dofs.max() + 1, 3))
    keep = np.ones(full.shape, bool)
    inner = flat.inner[np.abs(flat.points[0][flat.cells[0, flat.inner]]) < 1e-12]
    side = (
        np.abs(reference(work.element, np.array([[0.0] * 5, np.linspace(0, 1, 5)]))[0]).max(axis=1)
        > 1e-12
    )
    keep[np.unique(dofs[side][:, inner]), 1:] = False
    full[keep] = u
    outer = flat.outer[np.abs(flat.points[1][flat.cells[:, flat.outer]].mean(axis=0) - STEP) < 0.05]
    middle = np.array([[1.0], [0.5]])
    tangent = tabulate(
        ElementQuad1(), flat.points[:, flat.cells[:, outer]], work.element, middle
    ).tangent[:, 0]
    slope = reference(work.element, middle)[1][:, :, 0]
    strain = np.einsum(
        "bc,ec,be->e", slope, np.linalg.inv(tangent)[:, :, 1], full[:, 2][dofs[:, outer]]
    )
    return float(np.abs(strain).max() / (THIN / (STEEL.E * np.pi / 4 * THIN**4)))


def uniform(scene, order: int, refinement: int):
    """Harmonic solid on a mesh that takes no notice of the shoulder."""
    return sg.build(
        scene, "harmonic", order=order, layers=0, edge_layers=0, size=0.025, refinement=refinement
    )


def graded(scene, order: int, layers: int, ratio: float = RATIO):
    """Harmonic solid with layers towards the shoulder."""
    return sg.build(
        scene, "harmonic", order=order, layers=layers, edge_layers=0, size=0.025, ratio=ratio
    )


def measure(quick: bool = False) -> Finding:
    """Convergence of the tilt and of the greatest strain."""
    rows, orders = [], {}
    refinements = REFINEMENTS[:2] if quick else REFINEMENTS
    scene = shaft()
    expected = 2 * sharpest_corner(scene)[1]
    best = tilt(graded(scene, *((6, 5) if quick else (8, 7))), scene)
    for order in (1, 2, 3):
        errors, strains = [], []
        for refinement in refinements[: 3 if order == 3 else None]:
            body = uniform(scene, order, refinement)
            errors.append(abs(tilt(body, scene) / best - 1))
            strains.append(greatest_strain(body, scene) if order == 2 else None)
            rows.append(
                {
                    "mesh": f"uniform Q{order}",
                    "refinement": refinement,
                    "unknowns": body.size,
                    "error of tilt": errors[-1],
                    "greatest strain over nominal": strains[-1],
                }
            )
        orders[order] = np.log2(errors[-2] / errors[-1])
    for order in (2, 3) if quick else (2, 3, 4, 5):
        body = graded(scene, order, order)
        rows.append(
            {
                "mesh": f"graded Q{order}, {order} layers",
                "unknowns": body.size,
                "error of tilt": abs(tilt(body, scene) / best - 1),
            }
        )
    layers = LAYERS[:2] if quick else LAYERS
    peaks = [greatest_strain(graded(scene, 3, n), scene) for n in layers]
    rows += [
        {"mesh": f"strain, Q3, {n} layers", "refinement": n, "greatest strain over nominal": x}
        for n, x in zip(layers, peaks)
    ]
    growth = np.log(peaks[-1] / peaks[-2]) / np.log(RATIO) / (layers[-1] - layers[-2])
    cheap = next(r for r in rows if r["mesh"].startswith("graded Q3"))
    last = next(r for r in rows[::-1] if r.get("mesh") == "uniform Q2")
    return Finding(
        "sharp_shoulder",
        "Solids at a sharp shoulder",
        "At a sharp shoulder the greatest strain grows with every refinement. The "
        "global compliance converges, on uniform meshes slowly whatever the order.",
        "Observed orders on uniform meshes "
        f"{', '.join(f'{p:.2f} (Q{o})' for o, p in orders.items())} against {expected:.2f} expected of "
        f"the corner. The greatest strain grows like h^{growth:.2f} (expected h^{expected / 2 - 1:.2f}). "
        f"Grading reaches {cheap['error of tilt']:.0e} with {cheap['unknowns']} unknowns, Q2 uniform "
        f"{last['error of tilt']:.0e} with {last['unknowns']}.",
        "All solids grade their meshes towards shoulders; `solidgear check` cautions "
        "where a mesh is not graded towards one.",
        "tests/test_check_guards.py::test_guard[uniform mesh]",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Error of the tilt over unknowns."""

    def of(mesh):
        return [r for r in finding.rows if r["mesh"].startswith(mesh)]

    for mesh, line, colour in (
        ("uniform Q1", "v-", "#c98a00"),
        ("uniform Q2", "o-", "#c4541c"),
        ("uniform Q3", "D-", "#5a3e8c"),
    ):
        curve(axes, of(mesh), "unknowns", "error of tilt", line, colour, mesh)
    graded = of("graded")
    curve(axes, graded, "unknowns", "error of tilt", "s-", "#00805e", "graded Q2 to Q5")
    other = axes.twinx()
    strain = "greatest strain over nominal"
    curve(other, of("uniform Q2"), "unknowns", strain, "x:", "#0072b2")
    other.set(ylabel=f"{strain}, uniform Q2 (crosses)", ylim=(1, 10))
    other.set_yticks([1, 2, 3, 5, 10], ["1", "2", "3", "5", "10"])
    other.minorticks_off()
    other.spines["right"].set_visible(True)
    other.grid(visible=False)
    axes.set(xlabel="unknowns", ylabel="error of the tilt", title=finding.method)
    axes.legend(loc="lower left")
