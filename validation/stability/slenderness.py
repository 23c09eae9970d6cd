"""Problem: a uniform shaft, from slender to a disc, free and on two stiff bearings.  Reference: the
harmonic solid, its own change under refinement beside it.

Models: Euler and Timoshenko beams.  The shaft on bearings has its seats at a tenth of its length
from both ends and is loaded in the middle, all tied by section means, the fair partner of a beam
node.
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.scene import STEEL, Port, Scene, Segment
from validation.manual.models import bearing, frequencies
from validation.stability.frame import Finding, crossing, curve

DIAMETER = 0.1
SLENDERNESS = (20.0, 16.0, 12.0, 8.0, 5.0, 4.0, 3.0, 2.5, 2.0, 1.5, 1.25, 1.0, 0.75, 0.5)
FEW = (20.0, 16.0, 5.0, 2.0, 1.0, 0.5)
LEVELS = (0.01, 0.05)


def shaft(slenderness: float) -> Scene:
    """The shaft on two bearings a thousand times stiffer than itself; its free body is that of the
    free shaft.
    """
    length = slenderness * DIAMETER
    bending = 48 * STEEL.E * np.pi / 64 * DIAMETER**4 / (0.8 * length) ** 3
    shear = STEEL.shear_modulus * np.pi * DIAMETER**2 / length
    k = 1e3 / (1 / bending + 1 / shear)
    width = 0.02 * length
    bearings = [
        bearing(f"bearing {i + 1}", f * length, width, (k, k, k, 0, 0, 0))
        for i, f in enumerate((0.1, 0.9))
    ]
    port = Port(
        name="middle",
        y=length / 2,
        lo=length / 2 - width,
        hi=length / 2 + width,
        attachment="section",
    )
    return Scene.from_parts(
        [Segment.cylinder("shaft", length=length, diameter=DIAMETER)], bearings=bearings, port=port
    )


def answers(body, scene) -> dict[str, float]:
    """First bending free, first bending and compliance on bearings."""
    free, held = (frequencies(sg.modes(body, on, n=12), "bending")[0] for on in ((), scene))
    return {
        "free f1": free,
        "f1 on bearings": held,
        "C_zz on bearings": sg.condense(body, scene, port="middle").compliance[2, 2],
    }


def measure(quick: bool = False) -> list[Finding]:
    """One finding for each beam theory."""
    rows: dict[str, list[dict]] = {"euler": [], "timoshenko": []}
    for slenderness in FEW if quick else SLENDERNESS:
        scene = shaft(slenderness)
        coarse, fine = (
            answers(
                sg.build(
                    scene,
                    "harmonic",
                    order=p,
                    layers=0,
                    edge_layers=0,
                    size=DIAMETER * min(0.5, slenderness / 4),
                ),
                scene,
            )
            for p in ((3, 4) if quick else (4, 6))
        )
        for model, into in rows.items():
            mine = answers(sg.build(scene, model), scene)
            row = {"L/D": slenderness} | {name: mine[name] / fine[name] - 1 for name in fine}
            into.append(
                row | {"reference moved": max(abs(coarse[name] / fine[name] - 1) for name in fine)}
            )
    return [_finding(model, into) for model, into in rows.items()]


def thresholds(rows) -> dict[tuple[str, float], float]:
    """L/D at which each error passes each level, going towards short shafts."""
    at = [r["L/D"] for r in rows][::-1]
    names = [n for n in rows[0] if n not in ("L/D", "reference moved")]
    return {
        (n, level): crossing(at, [abs(r[n]) for r in rows][::-1], level)
        for n in names
        for level in LEVELS
    }


def _finding(model, rows) -> Finding:
    edge = thresholds(rows)

    def words(level):
        return ", ".join(
            f"{name} {edge[name, level]:.2f}"
            if np.isfinite(edge[name, level])
            else f"{name} nowhere"
            for name in ("free f1", "f1 on bearings", "C_zz on bearings")
        )

    name = {"euler": "Euler", "timoshenko": "Timoshenko"}[model]
    lacks = {
        "euler": "shear and rotary inertia are missing",
        "timoshenko": "a section is taken to stay plane and of one shape",
    }[model]
    return Finding(
        f"slenderness_{model}",
        f"{name} beam, short shaft",
        f"The {name} beam is wrong on short uniform shafts, where {lacks}.",
        f"Errors of 1 % begin below L/D of {words(0.01)}. Errors of 5 % begin below "
        f"{words(0.05)} (down to L/D 0.5).",
        "`solidgear check` cautions below the slenderness for 1 %, and for 5 % says not to use it.",
        "tests/test_check_guards.py::test_guard["
        + {"euler": "Euler, L/D 17.9", "timoshenko": "Timoshenko, L/D 1.1"}[model]
        + "]",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Errors over slenderness."""
    for name, line, colour in (
        ("free f1", "o-", "#c4541c"),
        ("f1 on bearings", "s-", "#0072b2"),
        ("C_zz on bearings", "D-", "#00805e"),
    ):
        curve(axes, finding.rows, "L/D", name, line, colour, name)
    words = "what refining the reference moves"
    curve(axes, finding.rows, "L/D", "reference moved", ":", "#888888", words, least=1e-9)
    for level in LEVELS:
        axes.axhline(level, color="#aa2222", lw=0.8, ls="--")
        axes.annotate(
            f"{100 * level:g} %",
            (1.0, level),
            xycoords=("axes fraction", "data"),
            ha="right",
            va="bottom",
            fontsize=8,
            color="#aa2222",
        )
    axes.set(
        xlabel="length over diameter",
        ylabel="distance from the solid",
        title=finding.method,
        ylim=(1e-7, 10),
    )
    axes.set_xticks(ticks := [0.5, 1, 2, 3, 5, 10, 20], [f"{t:g}" for t in ticks])
    axes.minorticks_off()
    axes.legend()
