"""Problem: the overhung pinion on its bearings, with a shift that lands on its first bending pair.
Reference: the dense solution.

Models: textbook shift-invert with the shift 1e-2 down to 0 (relative) from the pair, and `modes`,
whose shift is negative and so is never on an eigenvalue.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
import scipy.sparse.linalg as spla

import solidgear as sg
from solidgear.core.body import as_supports
from validation.common import ROOT
from validation.side_by_side import side_by_side
from validation.stability.frame import Finding, curve

AWAY = (*10.0 ** -np.arange(2, 15.5, 0.5), 0.0)
BODIES = {
    "timoshenko": ("timoshenko", {}),
    "hex8": ("solid", {"element": "hex8", "refinement": 0.5}),
}
FEW = (1e-2, 1e-7, 1e-12, 0.0)
WANTED = 6
RUNS = 6


def supported(body, supports) -> tuple[sp.csc_matrix, sp.csc_matrix]:
    """K + G'KbG and M of all blocks at once."""
    k, m, motions = side_by_side(body.blocks, len(body.ports))
    g = motions[supports.rows(body)]
    return (k + g.T @ sp.csr_matrix(supports.stiffness) @ g).tocsc(), m


def attempt(k, m, sigma, exact, seed) -> dict:
    """One run of shift-invert, its nearest modes held against the exact ones: how many are missing,
    the worst error, the residual a user could see.
    """
    try:
        lu = spla.splu((k - sigma * m).tocsc())
        n = k.shape[0]
        start = np.random.default_rng(seed).standard_normal(n)
        value, u = spla.eigsh(
            k, WANTED, m, sigma=sigma, OPinv=spla.LinearOperator((n, n), lu.solve), v0=start, tol=0
        )
    except (RuntimeError, spla.ArpackError) as error:
        return {"failed": str(error)[:60]}
    near = np.sort(exact[np.argsort(np.abs(exact - sigma))[:WANTED]])
    left, missing, worst = list(value), 0, 0.0
    for v in near:
        closest = min(left, key=lambda x: abs(x - v))
        error = abs(closest - v) / max(
            abs(v), exact[1]
        )  # a rigid motion that nothing resists has no relative error
        if error > 1e-3 or not np.isfinite(error):
            missing += 1
        else:
            worst = max(worst, error)
            left.remove(closest)
    residual = np.linalg.norm(k @ u - (m @ u) * value, axis=0) / np.linalg.norm(k @ u, axis=0)
    return {"missing": missing, "error": worst, "residual": float(np.median(residual))}


def cholesky(matrix) -> str:
    """What a Cholesky factorisation says of a matrix."""
    try:
        np.linalg.cholesky(matrix.toarray())
    except np.linalg.LinAlgError:
        return "refused"
    return "accepted"


def measure(quick: bool = False) -> Finding:
    """Errors of shift-invert over the distance of the shift from the pair."""
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    rows = []
    for name, (fidelity, options) in BODIES.items():
        if quick and name != "timoshenko":
            continue
        body = sg.build(scene, fidelity, **options)
        k, m = supported(body, as_supports(scene))
        exact = sla.eigh(k.toarray(), m.toarray(), eigvals_only=True, subset_by_index=(0, 19))
        pair = next(i for i in range(1, 18) if abs(exact[i + 1] / exact[i] - 1) < 1e-9)
        highest = (
            spla.eigsh(
                k,
                1,
                m,
                Minv=spla.LinearOperator(k.shape, spla.splu(m).solve),
                which="LM",
                tol=1e-2,
                return_eigenvectors=False,
            )[0]
            / exact[pair]
        )
        for away in FEW if quick else AWAY:
            runs = [
                attempt(k, m, exact[pair] * (1 + away), exact, seed)
                for seed in range(2 if quick else RUNS)
            ]
            done = [r for r in runs if "failed" not in r]
            row = {
                "body": name,
                "solver": "shift-invert",
                "shift from pair": float(away),
                "highest / pair": highest,
                "runs": len(runs),
                "failed": len(runs) - len(done),
            }
            row["cholesky"] = (
                cholesky(k - exact[pair] * (1 + away) * m) if away in (AWAY[0], 0.0) else None
            )
            rows.append(
                row
                | {
                    key: max((r[key] for r in done), default=float("nan"))
                    for key in ("missing", "error", "residual")
                }
            )
        found = sg.modes(body, scene, n=10)
        mode = found.named("bending 1")
        error = abs((2 * np.pi * mode.frequency_hz) ** 2 / exact[pair] - 1)
        away = abs(found.evidence["shift_rad2"] / exact[pair] - 1)
        rows.append(
            {
                "body": name,
                "solver": "program",
                "shift from pair": away,
                "highest / pair": highest,
                "runs": 1,
                "failed": 0,
                "missing": 2 - mode.multiplicity,
                "error": error,
                "residual": found.evidence["residual"],
            }
        )
    naive, ours = (
        [r for r in rows if r["solver"] == which] for which in ("shift-invert", "program")
    )

    def told(name):
        own = [r for r in naive if r["body"] == name]
        worst, on = (
            max(own, key=lambda r: (r["missing"], r["error"])),
            next(r for r in own if r["shift from pair"] == 0),
        )
        return (
            f"On {name} the error is {own[0]['error']:.0e} at 1e-2, at worst {worst['error']:.0e} "
            f"at {worst['shift from pair']:.0e} with a residual of {worst['residual']:.0e}, "
            f"{on['error']:.0e} on the pair itself"
        )

    return Finding(
        "shift_on_eigenvalue",
        "A shift on an eigenvalue",
        "A shift near an eigenvalue magnifies rounding in every other mode, at a "
        "residual that looks small. Above the first eigenvalue it leaves the matrix "
        "indefinite.",
        "Distances are relative to the pair. "
        f"{'. '.join(told(name) for name in dict.fromkeys(r['body'] for r in rows))}. The "
        f"program's shift is {min(r['shift from pair'] for r in ours):.4g} eigenvalues away, "
        f"its error {max(r['error'] for r in ours):.0e}.",
        "`solidgear modes` and `compare` shift to the negative side only (`shift_rad2` "
        "in the evidence), where no eigenvalue can be.",
        "tests/test_stability_numerics.py::test_a_shift_cannot_hit_an_eigenvalue",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Errors and lost modes over the distance of the shift."""
    away = "shift from pair"
    for name, colour in zip(BODIES, ("#0072b2", "#c4541c")):
        rows = [r for r in finding.rows if r["solver"] == "shift-invert" and r["body"] == name]
        least = {"least_x": 1e-16, "least": 1e-17}
        words = f"{name}: worst eigenvalue error"
        curve(axes, rows, away, "error", "o-", colour, words, **least)
        curve(axes, rows, away, "residual", "s:", colour, f"{name}: residual seen", **least)
        for r in rows:
            if r["missing"]:
                axes.annotate(
                    f"{r['missing']:g} lost",
                    (max(r[away], 1e-16), 0.03),
                    rotation=90,
                    ha="center",
                    va="bottom",
                    fontsize=8,
                    color=colour,
                )
        for r in finding.rows:
            if r["solver"] == "program" and r["body"] == name:
                error = max(r["error"], 1e-17)
                axes.axhline(error, color=colour, lw=0.8, ls="--", label=f"{name}: program")
    axes.annotate("on the pair", (1e-16, 1e-15), rotation=90, fontsize=8)
    axes.set(
        xlabel="distance of the shift from the pair, relative",
        ylabel="relative error",
        title=finding.method,
        ylim=(1e-17, 10),
    )
    axes.legend(fontsize=8)
