"""Problem: a dumbbell, two equal heads on a thin shaft.  Its bending pairs come two by two, and the
nearer the more bearings stand between the heads. Reference: all eigenpairs of the same matrices by
a dense solution.

Models: `modes` with every count from 1 up on the Timoshenko beam, the harmonic and the 3D solid;
textbook shift-invert from one start vector beside it.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.body import Supports
from solidgear.core.judge.correlation import subspace_mac
from solidgear.core.scene import Port, Scene, Segment
from validation.manual.models import bearing, frequencies
from validation.stability.frame import Finding, curve
from validation.stability.free_body_shift import shift_invert
from validation.stability.shift_on_eigenvalue import supported

BODIES = {
    "timoshenko": ("timoshenko", {"elements": 40}),
    "harmonic": ("harmonic", {"order": 2, "layers": 0, "edge_layers": 0}),
    "hex8": (
        "solid",
        {
            "element": "hex8",
            "layers": 0,
            "edge_layers": 0,
            "radial_layers": 0,
            "around": 8,
            "refinement": 0.5,
        },
    ),
}
COUNTS = (1, 3, 5, 7, 9)
FEW = (1, 9)
MOST = 12
LENGTH, HEAD = 0.6, 0.05
# stiffer ones would cost the dense reference its digits
SPRING = (1e9, 1e9, 1e9, 1e6, 1e6, 1e6)


def dumbbell() -> Scene:
    """Two heads on a thin shaft with room for nine bearings."""
    thin = LENGTH - 2 * HEAD
    segments = [
        Segment.cylinder("left", length=HEAD, diameter=0.12),
        Segment.cylinder("shaft", length=thin, diameter=0.04, y0=HEAD),
        Segment.cylinder("right", length=HEAD, diameter=0.12, y0=HEAD + thin),
    ]
    bearings = [bearing(str(i), LENGTH / 2 + 0.05 * i, 0.02, SPRING) for i in range(-4, 5)]
    return Scene.from_parts(
        segments, bearings=bearings, port=Port(name="end", y=HEAD / 2, lo=0.0, hi=HEAD)
    )


def held_by(count: int) -> Supports:
    """The innermost bearings only."""
    return Supports(
        tuple(str(i) for i in range(-(count // 2), count // 2 + 1)), np.diag(SPRING * count)
    )


def dense(body, supports):
    """All eigenpairs of a supported body up to a few past what is asked; vectors per block."""
    k, m = supported(body, supports)
    value, u = sla.eigh(k.toarray(), m.toarray(), subset_by_index=(0, MOST + 12))
    return np.maximum(value, 0.0), u, m


def stacked(body, mode) -> np.ndarray:
    """Shapes of a mode as columns over all blocks."""
    out = []
    for vectors in mode.vectors:
        out.append(
            np.concatenate(
                [vectors.get(b, np.zeros(block.size)) for b, block in enumerate(body.blocks)]
            )
        )
    return np.array(out)


def held(body, supports, exact, u, m, n: int) -> dict:
    """One call of `modes` against the dense solution: shapes, pairs cut, frequencies off, and the
    subspace MAC of every cluster.
    """
    found = [x for x in sg.modes(body, supports, n=n).modes if x.frequency_hz > 0]
    values = np.repeat(
        [(2 * np.pi * x.frequency_hz) ** 2 for x in found], [x.multiplicity for x in found]
    )
    zeros = int((exact < 1e-9 * exact[-1]).sum())
    want = exact[zeros : zeros + len(values)]
    shapes = np.vstack([stacked(body, x) for x in found])
    # Clusters of the dense solution, cut where the next eigenvalue is 1e-5 away; one that reaches
    # past the last shape asked for is left out.
    mac, start = 1.0, 0
    edges = [
        i
        for i in range(1, len(exact) - zeros)
        if exact[zeros + i] / exact[zeros + i - 1] - 1 > 1e-5
    ]
    for end in edges:
        if end > len(values):
            break
        mac = min(mac, subspace_mac(shapes[start:end], u[:, zeros + start : zeros + end].T, m))
        start = end
    # An axisymmetric shaft has all its bending in pairs: a single bending mode is half of one.
    cut = sum(x.family == "bending" and x.multiplicity != 2 for x in found)
    return {
        "shapes": len(values),
        "worst eigenvalue": float(np.abs(values / want - 1).max()),
        "1 - subspace MAC": 1 - mac,
        "pairs cut": cut,
    }


def naive_lost(k, m, exact, n: int) -> int:
    """Eigenvalues among the lowest n that a Lanczos iteration from one vector does not return."""
    try:
        value = list(shift_invert(k, m, -1e-3 * exact[exact > 1e-9 * exact[-1]][0], n))
    except (RuntimeError, sla.LinAlgError):
        return n
    lost = 0
    for v in exact[:n]:
        near = min(value, key=lambda x: abs(x - v), default=np.inf)
        if abs(near - v) > 1e-6 * max(v, exact[-1] * 1e-6):
            lost += 1
        else:
            value.remove(near)
    return lost


def measure(quick: bool = False) -> Finding:
    """The dumbbell over the stiffness of its middle, every count of modes."""
    rows = []
    for name, (fidelity, options) in BODIES.items():
        if quick and name != "timoshenko":
            continue
        body = sg.build(dumbbell(), fidelity, **options)
        for count in FEW if quick else COUNTS if name == "timoshenko" else (5, 9):
            supports = held_by(count)
            exact, u, m = dense(body, supports)
            whole_k, whole_m = supported(body, supports)
            bending = frequencies(sg.modes(body, supports, n=MOST), "bending")
            gap = float((np.diff(bending) / bending[:-1]).min())
            for n in (1, 3, 6) if quick else range(1, MOST + 1):
                row = {
                    "body": name,
                    "bearings": count,
                    "nearest pairs apart": gap,
                    "asked": n,
                } | held(body, supports, exact, u, m, n)
                rows.append(row | {"one vector lost": naive_lost(whole_k, whole_m, exact, n)})
    short = [r for r in rows if r["shapes"] < r["asked"]]
    return Finding(
        "clusters",
        "Clustered and equal modes",
        "A shaft of revolution bends in equal pairs, and two nearly equal ends make "
        "four modes of nearly one frequency: an iteration from one vector returns part "
        "of them.",
        f"With pairs down to {min(r['nearest pairs apart'] for r in rows):.0e} apart and "
        f"every count from 1 to {max(r['asked'] for r in rows)} ({len(rows)} calls) the "
        f"program lost {len(short)} modes and cut {sum(r['pairs cut'] for r in rows)} pairs. "
        f"The iteration from one vector lost a mode in {sum(r['one vector lost'] > 0 for r in rows)}.",
        "`solidgear modes` and `compare` solve each symmetry block apart and a mirrored "
        "block once, compute two modes more than asked, and never tear a pair.",
        "tests/test_modes.py::test_count_does_not_tear_pairs",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Errors of eigenvalue and subspace over the nearest gap."""
    near = "nearest pairs apart"
    for name, colour, marker in zip(BODIES, ("#0072b2", "#c4541c", "#00805e"), "osD"):
        rows = [r for r in finding.rows if r["body"] == name]
        least = {"least_x": 1e-16, "least": 1e-17}
        words = f"{name}: eigenvalue"
        curve(axes, rows, near, "worst eigenvalue", marker, colour, words, **least)
        words = f"{name}: 1 - subspace MAC"
        curve(axes, rows, near, "1 - subspace MAC", marker, colour, words, mfc="none", **least)
    lost = [r for r in finding.rows if r["one vector lost"]]
    words = "iteration from one vector lost a mode"
    curve(axes, lost, near, lambda r: 1e-1, "x", "#aa2222", words, least_x=1e-16, ms=7)
    axes.set(
        xlabel="distance of the two nearest pairs, relative",
        ylabel="error of the program",
        title=finding.method,
        ylim=(1e-17, 1e4),
    )
    axes.legend(fontsize=7, ncols=2)
