"""Problem: the overhung pinion on bearings that are stiffer along z than along x, by 1e-16 to 10
times: its bending pairs split. Reference: isotropic bearings give exact pairs; the split to first
order is that of the harmonic solid.

Models: Timoshenko and harmonic (bending planes apart), hexahedra (an O-grid of fourfold symmetry
keeps pairs) and tetrahedra (no symmetry: the mesh splits every pair).
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.body import Supports, as_supports
from solidgear.core.frames import rotation
from solidgear.core.judge.correlation import subspace_mac
from validation.common import ROOT
from validation.stability.frame import Finding, crossing, curve

BODIES = {
    "timoshenko": ("timoshenko", {}),
    "harmonic": ("harmonic", {"order": 2, "layers": 0, "edge_layers": 0}),
    "hex8": (
        "solid",
        {"element": "hex8", "layers": 1, "edge_layers": 0, "radial_layers": 0, "around": 8},
    ),
    "tet4 coarse": ("solid", {"element": "tet4", "refinement": 0.5}),
    "tet10 coarse": ("solid", {"element": "tet10", "refinement": 0.35}),
    "tet10 default": ("solid", {"element": "tet10"}),
}
QUICK = ("timoshenko", "tet4 coarse")
SPLITS = (0.0, 1e-16, 1e-14, 1e-12, *10.0 ** -np.arange(11, -0.5, -1), 10.0)
FEW = (0.0, 1e-8, 1e-2, 10.0)
SOME = (0.0, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0)
ANGLE = np.radians(30.0)


def anisotropic(scene, by: float, turn: float = 0.0) -> Supports:
    """The scene's bearings without their weak couplings, their terms of z times 1 + `by`, then
    turned about the axis.
    """
    keep = [(0, 0), (1, 1), (2, 2), (3, 3), (5, 5), (0, 5), (5, 0), (2, 3), (3, 2)]
    base = as_supports(scene)
    k = np.zeros_like(base.stiffness)
    rotate = rotation(1, turn)
    for i in range(len(base.ports)):
        own = np.zeros((6, 6))
        for a, b in keep:
            own[a, b] = base.stiffness[6 * i + a, 6 * i + b]
        scale = np.array([1, 1, 1 + by, 1 + by, 1, 1]) ** 0.5
        k[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = rotate @ (own * np.outer(scale, scale)) @ rotate.T
    return Supports(base.ports, k)


def first_two(body, supports, found) -> tuple[list, float]:
    """The modes that make up the first bending pair, and the distance of the two frequencies, by
    Rayleigh's quotient where they were grouped.
    """
    bending = [m for m in found.modes if m.family == "bending" and m.frequency_hz > 0]
    pair = bending[:1] if bending[0].multiplicity == 2 else bending[:2]
    values = sorted(quotient(body, supports, v) for m in pair for v in m.vectors)
    return pair, float(np.sqrt(values[1] / values[0]) - 1)


def quotient(body, supports, vectors) -> float:
    """Energy of one shape of unit modal mass, doubled: its eigenvalue."""
    total, motion = 0.0, np.zeros(6 * len(body.ports))
    for b, u in vectors.items():
        block = body.blocks[b]
        total += float(u @ (block.stiffness @ u))
        motion[body.rows(block)] = block.ports @ u
    at = motion[supports.rows(body)]
    return total + float(at @ supports.stiffness @ at)


def measure(quick: bool = False) -> Finding:
    """Split of the first pair, grouping, naming, and the subspace it spans, over the anisotropy."""
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    rows, mesh_split = [], {}
    for name in QUICK if quick else BODIES:
        fidelity, options = BODIES[name]
        body = sg.build(scene, fidelity, **options)
        base, base_split = None, 0.0
        tet = name.startswith("tet")
        for by in (
            FEW if quick else SOME[:1] if name == "tet10 default" else SOME if tet else SPLITS
        ):
            supports = anisotropic(scene, by)
            found = sg.modes(body, supports, n=6)
            pair, split = first_two(body, supports, found)
            span = np.vstack([m.motions.reshape(m.multiplicity, -1) for m in pair])
            base = span if base is None else base
            row = {
                "body": name,
                "anisotropy": float(by),
                "split of f1": split,
                "grouped as": " + ".join(f"{m.name} x{m.multiplicity}" for m in pair),
                "1 - subspace MAC to isotropic": 1 - subspace_mac(span, base, found.gram),
            }
            supports = anisotropic(scene, by, ANGLE)
            other, turned = first_two(body, supports, sg.modes(body, supports, n=6))
            ends = [
                abs(b.frequency_hz / a.frequency_hz - 1)
                for a, b in zip((pair[0], pair[-1]), (other[0], other[-1]))
            ]
            second = [m for m in found.modes if m.name == "bending 2"]
            row |= {
                "change when turned 30 deg": max(ends),
                "split when turned": turned,
                "bending 2 Hz": second[0].frequency_hz if second else None,
            }
            if by == 0:
                base_split = mesh_split[name] = split
            rows.append(
                row
                | {
                    "pair_tolerance": body.mesh.get("pair_tolerance", 1e-7),
                    "unknowns": body.size,
                    "split above isotropic": split - base_split,
                }
            )
    # The smallest anisotropy whose true split, that of the beam, is larger than what the mesh makes
    # of an isotropic shaft.
    beam = [
        (r["anisotropy"], r["split of f1"])
        for r in rows
        if r["body"] == "timoshenko" and r["anisotropy"] > 0
    ]
    beam = [(a, s) for a, s in beam if s > 1e-13]
    blind = {
        n: crossing([a for a, _ in beam], [s for _, s in beam], split)
        for n, split in mesh_split.items()
        if split > beam[0][1]
    }
    return Finding(
        "split_pairs",
        "Bending pairs split by bearings or by the mesh",
        "Unequal bearings split every bending pair, and so does a mesh without "
        "symmetry: frequencies alone do not tell the two apart.",
        "On isotropic bearings the mesh splits the first pair by "
        + ", ".join(f"{s:.0e} ({n})" for n, s in mesh_split.items())
        + ". The true split passes that of the mesh only above an anisotropy of "
        + ", ".join(f"{a:.0e} ({n})" for n, a in blind.items())
        + ".",
        "`solidgear modes` groups twins by shape where symmetry promises them; half of "
        "what the mesh splits is in their error bar. `check`, `modes` and `compare` say "
        "where a pair is split by less than the mesh splits it. `compare` pairs modes by "
        "subspace MAC.",
        "tests/test_check_guards.py::test_guard[pair split by 1e-8]",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Split of the first pair over the anisotropy."""
    least = {"least_x": 1e-17, "least": 1e-17}
    for name, colour, marker in zip(
        BODIES, ("#0072b2", "#00805e", "#e0a030", "#c4541c", "#aa2277", "#555555"), "osD^v<"
    ):
        rows = [r for r in finding.rows if r["body"] == name]
        if not rows:
            continue
        curve(axes, rows, "anisotropy", "split of f1", marker + "-", colour, name, **least)
        one = [r for r in rows if " + " not in r["grouped as"]]
        curve(axes, one, "anisotropy", "split of f1", marker, colour, ms=9, mfc="none", **least)
    axes.set(
        xlabel="anisotropy of the bearings (circled: held to be one pair)",
        ylabel="split of the first pair, relative",
        title=finding.method,
        ylim=(3e-18, 10),
    )
    axes.legend(fontsize=8)
