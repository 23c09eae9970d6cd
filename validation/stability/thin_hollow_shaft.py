"""Problem: a free tube whose section ovalises (n = 2, 3 waves around) before its axis bends.
Reference: rings in closed form.

Models: the harmonic solid with its extra harmonics, the full 3D solid on one tube.  The closed form
is the inextensional ring of a long tube (Love, Theory of Elasticity, sec. 293).
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.scene import STEEL, Scene, Segment
from validation.manual.exact import Elastic, ring_frequency
from validation.manual.models import frequencies as elastic
from validation.stability.frame import Finding, columns, crossing, curve

OUTER = 0.5  # radius, m: frequencies go with its inverse, ratios do not care
WALLS = (
    0.7,
    0.6,
    0.5,
    0.4,
    0.3,
    0.25,
    0.2,
    0.15,
    0.1,
    0.07,
    0.05,
    0.035,
    0.025,
)  # of the outer radius
SLENDERNESS = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0)
WAVES = (2, 3)


def tube(wall: float, length: float) -> Scene:
    """A tube of a wall told in outer radii."""
    return Scene.from_parts(
        [Segment.cylinder("tube", length=length, diameter=2 * OUTER, bore=2 * OUTER * (1 - wall))]
    )


def frequencies(wall: float, length: float, order: int = 4) -> dict[int, float]:
    """Lowest elastic frequency (Hz) of the free tube by the number of waves around; 1 is bending."""
    body = sg.build(
        tube(wall, length),
        "harmonic",
        order=order,
        layers=0,
        edge_layers=0,
        size=min(OUTER, length / 2),
        ovalising=WAVES,
    )
    found = sg.modes(body, (), n=24)
    families = {1: "bending"} | {n: f"ovalising n={n}" for n in WAVES}
    return {n: min(elastic(found, family), default=np.nan) for n, family in families.items()}


def ring(wall: float, waves: int) -> float:
    """Frequency (Hz) of the inextensional ring of a long tube."""
    steel = Elastic(STEEL.E, STEEL.nu, STEEL.density)
    return ring_frequency(waves, wall * OUTER, OUTER * (1 - wall / 2), steel)


def solid_error(wall: float, slenderness: float, around: int) -> dict[str, float]:
    """Relative distance of the 3D solid's lowest n = 2 and n = 3 pairs from the harmonic ones."""
    scene = tube(wall, 2 * OUTER * slenderness)
    body = sg.build(
        scene,
        "solid",
        element="hex20",
        around=around,
        layers=0,
        edge_layers=0,
        radial_layers=0,
        size=OUTER * min(1.0, 24 / around),
    )
    # a thin tube's lowest four pairs: two of two waves (even and odd along the axis), then two of
    # three
    found = [m.frequency_hz for m in sg.modes(body, (), n=8).modes if m.frequency_hz > 0]
    want = frequencies(wall, scene.length)
    return {
        "3D solid, cells around": around,
        "n = 2": found[0] / want[2] - 1,
        "n = 3": found[2] / want[3] - 1,
    }


def timoshenko(wall: float, slenderness: float) -> float:
    """First bending (Hz) of the free tube as a beam."""
    body = sg.build(tube(wall, 2 * OUTER * slenderness), "timoshenko")
    return elastic(sg.modes(body, (), n=8), "bending")[0]


def measure(quick: bool = False) -> Finding:
    """Wall at which n = 2 and n = 3 cross bending, for each slenderness."""
    rows = []
    for slenderness in (2.0, 5.0) if quick else SLENDERNESS:
        walls = np.array(WALLS[::-2] if quick else WALLS[::-1])
        found = [frequencies(w, 2 * OUTER * slenderness, 3 if quick else 4) for w in walls]
        row = {"L/D": slenderness}
        for n in WAVES:
            ratio = np.array([f[n] / f[1] for f in found])
            known = np.isfinite(ratio)
            row[f"wall / radius, n = {n} meets bending"] = crossing(walls[known], ratio[known], 1.0)
        row["wall / radius, closed form"] = crossing(
            walls, [ring(w, 2) / timoshenko(w, slenderness) for w in walls], 1.0
        )
        rows.append(row)
    solid = [
        solid_error(0.1, 2.0, around)
        for around in ((12, 32) if quick else (12, 16, 24, 32, 48, 64))
    ]
    edges = ", ".join(
        f"{r['wall / radius, n = 2 meets bending']:.2f} at L/D {r['L/D']:g}" for r in rows[::2]
    )
    return Finding(
        "thin_hollow_shaft",
        "Beam, thin hollow shaft",
        "Beams know no ovalising, and a thin tube ovalises at a lower frequency than it "
        "bends. A 3D mesh with few cells around is too stiff for it.",
        f"n = 2 comes before free bending below a wall, over the outer radius, of {edges}. "
        f"At wall 0.1 the 3D solid is {solid[0]['n = 2']:+.0%} in n = 2 with 12 cells around and "
        f"{solid[-1]['n = 2']:+.1%} with {solid[-1]['3D solid, cells around']}.",
        "`solidgear check` says when families lie below or near first bending. `modes` "
        "on a harmonic solid solves them as far as asked; 3D gets cells around to "
        "match.",
        "tests/test_check_guards.py::test_guard[tube, n = 2 below bending]",
        rows + solid,
    )


def draw(finding: Finding, axes) -> None:
    """Wall of equal frequencies over slenderness."""
    rows = [r for r in finding.rows if "L/D" in r]
    for n, line, colour in ((2, "o-", "#c4541c"), (3, "s-", "#0072b2")):
        wall, words = f"wall / radius, n = {n} meets bending", f"n = {n} meets bending (measured)"
        curve(axes, rows, "L/D", wall, line, colour, words)
    words = "closed form: ring against Timoshenko"
    curve(axes, rows, "L/D", "wall / radius, closed form", ":", "#555555", words)
    at, wall = columns(rows, "L/D", "wall / radius, n = 2 meets bending")
    axes.fill_between(at, wall, 0.01, color="#c4541c", alpha=0.08, lw=0)
    axes.annotate("ovalises first", (0.06, 0.08), xycoords="axes fraction", color="#c4541c")
    axes.set(
        xlabel="length over outer diameter",
        ylabel="wall over outer radius",
        title=finding.method,
        ylim=(0.01, 1),
    )
    axes.set_xticks(at, [f"{t:g}" for t in at])
    axes.minorticks_off()
    axes.legend()
