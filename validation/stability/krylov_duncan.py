"""Problem: bending roots of a uniform free-free and clamped-clamped shaft, kL from 5 to 200.
Reference: roots of cos(x) - 1/cosh(x), which overflows nowhere.

Models: the determinant U^2 - T V (clamped; the free one has the same) in plain cosh and sinh, whole
and as a product of transfer matrices, and the program's `krylov`.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from validation.stability.frame import Finding, columns, crossing
from validation.thesis.krylov import Span, krylov, krylov_duncan

MOST = 64
CUTS = 8


def exact(count: int) -> np.ndarray:
    """Elastic roots kL of cos(x) cosh(x) = 1, the first 4.730."""
    middle = np.pi * (np.arange(1, count + 1) + 0.5)
    return np.array(
        [
            brentq(
                lambda x: np.cos(x) - 1 / np.cosh(x),
                m - 0.3,
                m + 0.3,
                xtol=1e-15,
                rtol=4 * np.finfo(float).eps,
            )
            for m in middle
        ]
    )


def determinant(kl: float) -> float:
    """U^2 - T V of the whole shaft."""
    _, t, u, v = krylov_duncan(kl)
    return float(u * u - t * v)


def transferred(kl: float) -> float:
    """The same from the product of the transfer matrices of short pieces."""
    s, t, u, v = krylov_duncan(kl / CUTS)
    piece = np.array([[s, t, u, v], [v, s, t, u], [u, v, s, t], [t, u, v, s]])
    whole = np.linalg.matrix_power(piece, CUTS)
    return float(whole[0, 2] * whole[1, 3] - whole[0, 3] * whole[1, 2])


def root(f, at: float) -> tuple[float, int]:
    """The root of f found near one, NaN if there is no change of sign, and how many changes a scan
    sees where there is one.
    """
    scan = np.linspace(at - 1.2, at + 1.2, 120)  # an even number: the root itself is not among them
    signs = np.sign([f(x) for x in scan])
    changes = np.flatnonzero(signs[1:] * signs[:-1] < 0)
    if not len(changes):
        return float("nan"), 0
    i = changes[np.argmin(np.abs(scan[changes] - at))]
    return brentq(f, scan[i], scan[i + 1], xtol=1e-15, rtol=4 * np.finfo(float).eps), len(changes)


def measure(quick: bool = False) -> Finding:
    """Error of every root, and roots lost or invented."""
    roots = exact(MOST)
    found = krylov((Span(1.0, 1.0, 1.0),), n=MOST + 2)
    mine = np.sqrt(2 * np.pi * found.frequency_hz[found.rigid :])
    rows = []
    for i in (0, 4, 9, 11, 20, 63) if quick else range(MOST):
        x = roots[i]
        row = {"kL": x}
        for name, f in (("plain", determinant), ("transfer", transferred)):
            at, changes = root(f, x)
            row |= {f"{name} error": abs(at / x - 1), f"{name} roots seen": changes}
        below, above = found.counts[found.rigid + i]
        rows.append(
            row
            | {
                "estimate eps exp(kL) / kL": float(np.finfo(float).eps * np.exp(x) / x),
                "program error": abs(mine[i] / x - 1),
                "program roots counted": int(above - below),
            }
        )
    kl = [r["kL"] for r in rows]

    def lost(name):
        return next((r["kL"] for r in rows if r[f"{name} roots seen"] != 1), float("nan"))

    # Past 40 both are noise.
    edge = {
        (name, level): crossing(
            [x for x in kl if x < 40],
            [max(np.nan_to_num(r[f"{name} error"], nan=1.0), 1e-17) for r in rows if r["kL"] < 40],
            level,
        )
        for name in ("plain", "transfer")
        for level in (1e-6, 1e-4)
    }
    return Finding(
        "krylov_duncan",
        "Krylov-Duncan functions in cosh and sinh",
        "The frequency determinant is a difference of products that grow like exp(2 "
        "kL). Its sign becomes that of rounding, and roots are lost or invented.",
        f"Plain functions pass 1e-4 at kL {edge['plain', 1e-4]:.0f} and see the wrong number of roots "
        f"from {lost('plain'):.0f}, {CUTS} transfer matrices at {edge['transfer', 1e-4]:.0f} and "
        f"{lost('transfer'):.0f}. The program's worst error up to kL {max(kl):.0f} is "
        f"{max(r['program error'] for r in rows):.0e}, with "
        f"{min(r['program roots counted'] for r in rows)} root counted at each.",
        "`validation.thesis.krylov` makes solutions orthonormal after every piece of kL "
        "2 and counts roots (Wittrick and Williams).",
        "tests/test_krylov.py::test_all_modes_up_to_kl_200",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Errors over kL."""
    for name, line, colour, words in (
        ("plain error", "o-", "#c4541c", "plain cosh, sinh"),
        ("transfer error", "s:", "#e0a030", f"{CUTS} transfer matrices"),
        ("program error", "^-", "#0072b2", "program"),
        ("estimate eps exp(kL) / kL", "--", "#888888", "eps exp(kL) / kL"),
    ):
        kl, error = columns(finding.rows, "kL", name)
        # a root that the program has to the last bit stays on the chart
        error = np.maximum(error, 1e-17 if name == "program error" else 0.0)
        axes.semilogy(kl, error, line, color=colour, label=words)
    wrong = [r["kL"] for r in finding.rows if r["plain roots seen"] != 1]
    axes.plot(wrong, [3.0] * len(wrong), "x", color="#aa2222", label="plain: wrong number of roots")
    axes.set(
        xlabel="kL of the root",
        ylabel="relative error of kL",
        title=finding.method,
        ylim=(1e-17, 30),
    )
    axes.legend(fontsize=8, loc="center right")
