"""Problem: a uniform overhung shaft on two springs of 1e-3 to 1e24 N/m, and of exactly 0.
Reference: closed form for the compliance at the overhung end, the exact initial-parameter solution
(krylov) for the first frequency.

Models: an Euler beam of 10 and of 160 elements; its springs by the Woodbury identity and inertia
relief (the program), and added to the stiffness matrix, K + G'KbG (naive).
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
import scipy.sparse.linalg as spla

import solidgear as sg
from solidgear.core.body import Supports, as_supports
from solidgear.core.scene import STEEL, Port, Scene, Segment
from validation.manual.models import bearing, frequencies
from validation.stability.frame import Finding, crossing, curve
from validation.thesis.krylov import from_scene, krylov

LENGTH, DIAMETER, AT = 0.4, 0.06, (0.1, 0.35)
ELEMENTS = (10, 160)


def shaft(k: float) -> Scene:
    """Lumped point at the free end, radial and axial springs behind it."""
    bearings = [bearing(str(i + 1), y, 0.02, (k, k, k, 0, 0, 0)) for i, y in enumerate(AT)]
    port = Port(name="end", y=0.0, lo=0.0, hi=0.02, attachment="section")
    return Scene.from_parts(
        [Segment.cylinder("shaft", length=LENGTH, diameter=DIAMETER)], bearings=bearings, port=port
    )


def exact_compliance(k: float) -> float:
    """z at the end under a unit force there: both springs by levers, and the overhang on two rigid
    supports.
    """
    a, span = AT[0], AT[1] - AT[0]
    bend = STEEL.E * np.pi / 64 * DIAMETER**4
    return ((1 + a / span) ** 2 + (a / span) ** 2) / k + a * a * (span + a) / (3 * bend)


def block_of(body, component: int = 2):
    """The first block that carries a component."""
    return next(b for b in body.blocks if component in b.components)


def assembled(body, supports: Supports) -> sp.csc_matrix:
    """K + G'KbG of the block that moves along z, as a textbook would add it."""
    block = block_of(body)
    n = len(block.components)
    total = block.stiffness.copy()
    for i, name in enumerate(supports.ports):
        at = 6 * i + np.array(block.components)
        g = block.ports[n * body.port_index(name) : n * (body.port_index(name) + 1)]
        total = total + g.T @ sp.csr_matrix(supports.stiffness[np.ix_(at, at)]) @ g
    return total.tocsc()


def naive_compliance(body, supports, port: str) -> float:
    """z per unit F_z by one direct solution; NaN where the factorisation fails."""
    block = block_of(body)
    row = block.ports[len(block.components) * body.port_index(port)].toarray().ravel()
    try:
        return float(row @ spla.splu(assembled(body, supports)).solve(row))
    except RuntimeError:
        return float("nan")


def naive_first(body, supports, number: int = 0) -> float:
    """Eigenvalue of the assembled matrices by a dense symmetric solver, as a frequency; negative
    ones stay negative.
    """
    value = sla.eigh(
        assembled(body, supports).toarray(),
        block_of(body).mass.tocsr().toarray(),
        eigvals_only=True,
        subset_by_index=(number, number),
    )[0]
    return float(np.sign(value) * np.sqrt(abs(value)) / (2 * np.pi))


def rounding_over_first(body, supports, first: float) -> float:
    """Unit roundoff times the largest eigenvalue of the assembled matrices, over the exact first
    one.

    Above 1 the sum itself, however it is solved, holds no digit of the first frequency: rounding
    its entries moves eigenvalues by more than that one is. The largest entry of K over that of M on
    the diagonal bounds the largest eigenvalue from below (Rayleigh).
    """
    largest = (assembled(body, supports).diagonal() / block_of(body).mass.tocsr().diagonal()).max()
    return float(np.finfo(float).eps / 2 * largest / (2 * np.pi * first) ** 2)


def measure(quick: bool = False) -> Finding:
    """Errors of compliance and first frequency over the stiffness of the springs."""
    rows = []
    for elements in ELEMENTS:
        body = sg.build(shaft(1.0), "euler", rotary_inertia=False, elements=elements)
        for k in (1e-3, 1.0, 1e6, 1e12, 1e18, 1e24) if quick else 10.0 ** np.arange(-3, 25):
            supports = as_supports(shaft(k))
            compliance, first = (
                exact_compliance(k),
                krylov(*from_scene(shaft(k)), n=1).frequency_hz[0],
            )
            here = sg.condense(body, supports, port="end").compliance[2, 2]
            found = sg.modes(body, supports, n=4)
            mine = frequencies(found, "bending")[0]
            row = {
                "elements": elements,
                "k N/m": float(k),
                "C_zz program": abs(here / compliance - 1),
                "C_zz naive": abs(naive_compliance(body, supports, "end") / compliance - 1),
            }
            # The beam's own error against the exact frequency is in both columns; it is below 1e-4
            # for ten elements.
            row |= {
                "f1 program": abs(mine / first - 1),
                "f1 naive": abs(naive_first(body, supports) / first - 1),
                "f1 residual told": found.evidence["residual"],
            }
            rows.append(row | {"rounding / lambda_1": rounding_over_first(body, supports, first)})
        free = sg.condense(
            body,
            as_supports([b.with_changes(matrix=np.zeros((6, 6))) for b in shaft(1.0).bearings]),
            port="end",
        )
        none = Supports(("1", "2"), np.zeros((12, 12)))
        rows.append(
            {
                "elements": elements,
                "k N/m": 0.0,
                "C_zz program": float(np.abs(free.stiffness).max()),
                "C_zz naive": naive_compliance(body, none, "end"),
            }
        )
    fine = [r for r in rows if r["elements"] == ELEMENTS[1] and r["k N/m"] > 0]
    k = np.array([r["k N/m"] for r in fine])
    soft = {
        name: crossing(k[k < 1e12], [r[name] for r in fine if r["k N/m"] < 1e12], 0.01)
        for name in ("C_zz naive", "f1 naive")
    }
    stiff = crossing(k[k >= 1e12], [r["f1 naive"] for r in fine if r["k N/m"] >= 1e12], 0.01)
    worst = {name: max(fine, key=lambda r: r[name]) for name in ("C_zz program", "f1 program")}
    return Finding(
        "bearing_extremes",
        "Springs added to the stiffness matrix",
        "Bearings added to the matrix of the free shaft: soft ones are lost in its "
        "rounding, stiff ones drown the shaft.",
        f"With {ELEMENTS[1]} elements the naive compliance is 1 % wrong below "
        f"{soft['C_zz naive']:.1g} N/m, the naive first frequency below "
        f"{soft['f1 naive']:.1g} and above {stiff:.1g} N/m. From 1e-3 to 1e24 N/m the "
        f"program's compliance is within {worst['C_zz program']['C_zz program']:.0e} and its "
        f"first frequency within {worst['f1 program']['f1 program']:.0e}.",
        "They are never added: the free body is factored alone and bearings enter by "
        "the Woodbury identity. Unresisted motions are reported as free, with stiffness "
        "exactly 0.",
        "tests/test_condense.py::test_soft_bearings_lengthen_the_compliance_of_a_beam_exactly",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Errors of the compliance over stiffness."""
    for elements, line in zip(ELEMENTS, (":", "-")):
        rows = [r for r in finding.rows if r["elements"] == elements and r["k N/m"] > 0]
        for name, colour, marker in (
            ("C_zz naive", "#c4541c", "o"),
            ("f1 naive", "#e0a030", "D"),
            ("C_zz program", "#0072b2", "s"),
            ("f1 program", "#00805e", "^"),
        ):

            def error(r, name=name):
                return min(np.nan_to_num(r[name], nan=1e3), 1e3)

            words = f"{name}, {elements} elements"
            curve(axes, rows, "k N/m", error, marker + line, colour, words, least=1e-17)
    axes.axhline(0.01, color="#aa2222", lw=0.8, ls="--")
    axes.set(xlabel="bearing stiffness, N/m", ylabel="relative error", title=finding.method)
    axes.legend(fontsize=7, ncols=2)
