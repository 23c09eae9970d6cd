"""Problem: the free steel cylinder, whose six rigid motions have frequency zero.  Reference: six
exact zeros, and the elastic modes of a dense solution.

Models: textbook shift-invert (ARPACK on the factor of K - sigma M) with sigma from 0 to -1e4 times
the first elastic eigenvalue, and `modes`, which takes the rigid motions out.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla
import scipy.sparse.linalg as spla

import solidgear as sg
from validation.common import ROOT
from validation.side_by_side import side_by_side
from validation.stability.frame import Finding, curve

BODIES = {
    "timoshenko": ("timoshenko", {}),
    "hex8": ("solid", {"element": "hex8", "refinement": 0.5}),
    "hex20": ("solid", {"element": "hex20", "refinement": 0.5}),
}
SHIFTS = (0.0, -1e-16, -1e-14, -1e-12, -1e-10, -1e-8, -1e-6, -1e-4, -1e-3, -1e-2, -1.0, -1e2, -1e4)
FEW = (0.0, -1e-12, -1e-3)
WANTED = 14
RUNS = 12  # numberings of the unknowns and start vectors, where the result is one of rounding


def shift_invert(k, m, sigma: float, wanted: int, seed: int = 0) -> np.ndarray:
    """Eigenvalues nearest the shift, unknowns numbered at random; raises RuntimeError where the
    factorisation or the iteration fails.
    """
    order = np.random.default_rng(seed).permutation(k.shape[0])
    k, m = k[order][:, order], m[order][:, order]
    lu = spla.splu(
        (k - sigma * m).tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    n = k.shape[0]
    start = np.random.default_rng(seed).standard_normal(n)
    return np.sort(
        spla.eigsh(
            k,
            wanted,
            m,
            sigma=sigma,
            OPinv=spla.LinearOperator((n, n), lu.solve),
            v0=start,
            tol=1e-10,
            return_eigenvectors=False,
        )
    )


def judged(found: np.ndarray, exact: np.ndarray) -> dict:
    """How many zero modes came out, how far from zero they are, how far the elastic ones are from
    the exact ones, and how many of those are missing.
    """
    first = exact[6]
    zeros = found[np.abs(found) < 0.01 * first]
    left, missing, worst = list(found[np.abs(found) >= 0.01 * first]), 0, 0.0
    for value in exact[6:WANTED]:
        near = min(left, key=lambda v: abs(v - value), default=np.inf)
        if abs(near / value - 1) > 1e-2:
            missing += 1
            continue
        worst = max(worst, abs(near / value - 1) / 2)
        left.remove(near)
    noise = float(np.sqrt(np.abs(zeros).max(initial=0.0) / first))
    return {
        "zero modes": len(zeros),
        "negative": int((zeros < 0).sum()),
        "rigid f / f1": noise,
        "elastic missing": missing,
        "elastic error": worst,
    }


def wrong(r: dict) -> bool:
    """Not six zero modes, an elastic one missing, or one 1e-6 off."""
    return r["zero modes"] != 6 or r["elastic missing"] > 0 or r["elastic error"] > 1e-6


def measure(quick: bool = False) -> Finding:
    """The free cylinder over the shift."""
    scene = sg.load(ROOT / "geometry" / "cylinder_free.toml")
    rows = []
    for name, (fidelity, options) in BODIES.items():
        if quick and name == "hex20":
            continue
        body = sg.build(scene, fidelity, **options)
        k, m, _ = side_by_side(body.blocks, len(body.ports))
        exact = sla.eigh(
            k.toarray(), m.toarray(), eigvals_only=True, subset_by_index=(0, WANTED + 2)
        )
        # Rayleigh: entries of the diagonal bound the largest eigenvalue from below.
        rounding = np.finfo(float).eps / 2 * (k.diagonal() / m.diagonal()).max()
        for relative in FEW if quick else SHIFTS:
            runs = []
            for seed in range(RUNS if relative > -1e-7 else 2):
                try:
                    runs.append(
                        judged(shift_invert(k, m, relative * exact[6], WANTED, seed), exact)
                    )
                except (RuntimeError, spla.ArpackError) as error:
                    runs.append({"failed": str(error)[:60]})
            done = [r for r in runs if "failed" not in r]
            row = {
                "body": name,
                "solver": "shift-invert",
                "shift / lambda_1": relative,
                "runs": len(runs),
                "failed runs": len(runs) - len(done),
                "wrong runs": sum(wrong(r) for r in done),
            }
            if relative:
                row["rounding / shift"] = float(rounding / abs(relative * exact[6]))
            rows.append(
                row | max(done, key=lambda r: (r["elastic missing"], r["rigid f / f1"]), default={})
            )
        found = sg.modes(body, (), n=WANTED - 6)
        values = np.repeat((2 * np.pi * found.frequency_hz) ** 2, found.multiplicity)
        rows.append(
            {
                "body": name,
                "solver": "program",
                "shift / lambda_1": found.evidence["shift_rad2"] / exact[6],
                "runs": 1,
                "failed runs": 0,
                "wrong runs": int(wrong(own := judged(values, exact))),
            }
            | own
        )
    naive = [r for r in rows if r["solver"] == "shift-invert"]
    ours = [r for r in rows if r["solver"] == "program"]
    near = [r for r in naive if -1e-7 < r["shift / lambda_1"] < 0]
    zero = [r for r in naive if r["shift / lambda_1"] == 0]
    good = [
        r["shift / lambda_1"]
        for r in naive
        if -1 <= r["shift / lambda_1"] < -1e-7 and not r["wrong runs"] and not r["failed runs"]
    ]

    def told(part):
        runs = sum(r["runs"] for r in part)
        return (
            f"{sum(r['failed runs'] for r in part)} of {runs} runs fail, "
            f"{sum(r['wrong runs'] for r in part)} are wrong, with up to "
            f"{max(r.get('elastic missing', 0) for r in part)} of 8 elastic modes missing"
        )

    return Finding(
        "free_body_shift",
        "Shift-invert of a free shaft",
        "With too small a shift the factor of a free shaft is one of rounding: rigid "
        "motions come out as noise, and elastic modes go missing with no message.",
        f"At shift 0 {told(zero)}. Between -1e-16 and -1e-8 of the first elastic eigenvalue "
        f"{told(near)}. From {max(good):.0e} to {min(good):g} all are there. "
        f"The program finds {', '.join(str(r['zero modes']) for r in ours)} zeros, exact, and "
        f"the elastic modes within {max(r['elastic error'] for r in ours):.0e}.",
        "`solidgear modes` and `compare` shift by a thousandth of the first elastic "
        "eigenvalue to the negative side, and take unresisted rigid motions out "
        "exactly.",
        "tests/test_modes.py::test_free_cylinder_has_six_rigid_modes",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Noise of the zero modes and error of the elastic ones over the shift."""

    def shift(r):
        return max(-r["shift / lambda_1"], 1e-18)

    for name, colour in zip(BODIES, ("#0072b2", "#c4541c", "#00805e")):
        rows = [r for r in finding.rows if r["body"] == name and r["solver"] == "shift-invert"]
        done = [r for r in rows if "elastic error" in r]
        for key, line in (("rigid f / f1", "o-"), ("elastic error", "s:")):
            curve(axes, done, shift, key, line, colour, f"{name}: {key}", least=1e-17)
        lost = [r for r in rows if r.get("elastic missing", 1)]
        curve(axes, lost, shift, lambda r: 3.0, "x", colour, ms=9)
    axes.axvline(1e-18, color="#888888", lw=0.8)
    axes.annotate("shift 0", (1e-18, 1e-16), rotation=90, fontsize=8)
    axes.set(
        xlabel="negative shift over first elastic eigenvalue (crosses: elastic modes missing, or failed)",
        ylabel="relative to f1",
        title=finding.method,
        ylim=(1e-17, 20),
    )
    axes.legend(fontsize=7, ncols=3)
