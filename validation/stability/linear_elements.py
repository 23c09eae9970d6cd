"""Problem: bending of a uniform shaft with linear elements, static and free.  Reference: the
harmonic solid with the same section ties.

Models: TET4 and HEX8 against TET10, HEX20 and HEX27 at equal numbers of unknowns; and hexahedra
drawn out along the shaft on one mesh of the section, where a linear element answers bending with
shear it should not have.
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.scene import Port, Scene, Segment
from solidgear.core.scene.closed_form import mass_properties
from solidgear.core.scene.outline import Outline
from validation.manual.models import FIRM, bearing
from validation.stability.frame import Finding, curve

RADIUS, LENGTH = 0.05, 0.4
LEVELS = {
    "tet4": (2.4, 3.2),
    "hex8": (2, 3),
    "tet10": (1, 1.6),
    "hex20": (1.5, 1.8),
    "hex27": (1, 1.3),
}
FEW = {"tet4": (1, 1.6), "hex8": (1, 1.4), "hex20": (0.7, 1)}
EQUAL, EQUAL_QUICK = 9000, 2000  # unknowns at which errors are compared
ASPECTS = (1.0, 1.5, 2.0, 4.0, 6.0)
PLAIN = dict(layers=0, edge_layers=0, radial_layers=0)


def shaft() -> Scene:
    """Uniform shaft held by one section and loaded at its first."""
    clamp = bearing("clamp", LENGTH - RADIUS / 2, RADIUS, [FIRM] * 6)
    port = Port(y=0.0, lo=0.0, hi=RADIUS, attachment="section")
    return Scene.from_parts(
        [Segment.cylinder("shaft", length=LENGTH, diameter=2 * RADIUS)], bearings=[clamp], port=port
    )


def answers(body, scene) -> dict[str, float]:
    """Tilt under a unit moment, and first bending of the free body (its lowest elastic mode)."""
    return {
        "C_thx": sg.condense(body, scene, port="port").compliance[3, 3],
        "f1": next(f for f in sg.modes(body, (), n=2).frequency_hz if f > 0),
    }


def mesh(element: str, level: float) -> dict:
    """Builder options of one uniform mesh."""
    if element.startswith("tet"):
        return dict(
            element=element, size=RADIUS / 1.5 / level, graded_size=RADIUS / 1.5 / level, around=16
        )
    return dict(element=element, size=RADIUS / level, around=max(8, 4 * round(3 * level)), **PLAIN)


def errors(scene, want, **options) -> dict[str, float]:
    """Unknowns and relative errors of one solid body."""
    body = sg.build(scene, "solid", **options)
    got = answers(body, scene)
    return {"unknowns": body.size} | {name: got[name] / want[name] - 1 for name in want}


def at_equal(rows, unknowns: float, name: str) -> float:
    """Size of an error at a number of unknowns, on the line through the two nearest meshes,
    log-log.
    """
    x = np.log([r["unknowns"] for r in rows])
    near = np.sort(np.argsort(np.abs(x - np.log(unknowns)))[:2])
    y = np.log([abs(rows[i][name]) for i in near])
    slope = (y[1] - y[0]) / (x[near[1]] - x[near[0]])
    # meshes of tetrahedra can be alike in size; a slope from them means nothing
    slope = slope if x[near[1]] - x[near[0]] > 0.1 else 0.0
    return float(np.exp(y[0] + slope * (np.log(unknowns) - x[near[0]])))


def drawn_out(scene, want, element: str, aspect: float, around: int) -> dict:
    """Errors with cells half a radius across and ``aspect`` times as long, or the next shorter that
    fits.
    """
    size = aspect * RADIUS / 2
    long = scene.bearings[0].y / np.ceil(scene.bearings[0].y / size - 1e-6)
    return {"drawn out": element, "length over width": long / (RADIUS / 2)} | errors(
        scene, want, element=element, size=size, around=around, **PLAIN
    )


def mass_error(scene, around: int) -> dict:
    """What trilinear hexahedra lose of the mass: their nodes lie where those of quadratic ones
    should.
    """
    mass = sg.build(
        scene, "solid", element="hex8", size=4 * RADIUS, around=around, **PLAIN
    ).mass_matrix()[0, 0]
    return {
        "HEX8, cells around": around,
        "mass": mass / mass_properties(Outline(scene.segments)).mass - 1,
    }


def measure(quick: bool = False) -> Finding:
    """Errors over unknowns, and over aspect ratio."""
    scene = shaft()
    want = answers(sg.build(scene, "harmonic", order=6, layers=0, edge_layers=3), scene)
    rows = [
        {"element": element} | errors(scene, want, **mesh(element, level))
        for element, levels in (FEW if quick else LEVELS).items()
        for level in levels
    ]
    equal = EQUAL_QUICK if quick else EQUAL
    compared = {
        e: {n: at_equal([r for r in rows if r["element"] == e], equal, n) for n in want}
        for e in dict.fromkeys(r["element"] for r in rows)
    }
    drawn = [
        drawn_out(scene, want, e, a, 16 if quick else 24)
        for e in ("hex8", "hex20")
        for a in (ASPECTS[::2] if quick else ASPECTS)
    ]
    light = [mass_error(scene, around) for around in (12, 16, 24, 32, 48)[:: 4 if quick else 1]]
    tet = (
        f"TET4 {compared['tet4']['f1'] / compared['tet10']['f1']:.0f} times TET10, "
        if "tet10" in compared
        else ""
    )
    return Finding(
        "linear_elements",
        "TET4 and HEX8",
        "Linear elements answer curvature with shear: they are too stiff in bending, "
        "more so the longer they are. Straight sides also lose mass.",
        f"Error in first bending at {equal} unknowns: {tet}HEX8 "
        f"{compared['hex8']['f1'] / compared['hex20']['f1']:.0f} times HEX20 "
        f"({100 * compared['hex8']['f1']:.1f} %). HEX8 lacks {abs(light[0]['mass']):.1%} of the mass "
        f"with {light[0]['HEX8, cells around']} cells around.",
        "`solidgear check --model solid` cautions on tet4 and hex8 and calls the lost "
        "mass a fault; HEX20 is the default.",
        "tests/test_check_guards.py::test_guard[hex8]",
        rows
        + [{"at equal unknowns": e, "unknowns": equal} | v for e, v in compared.items()]
        + drawn
        + light,
    )


def draw(finding: Finding, axes) -> None:
    """Error of first bending over unknowns."""
    style = {
        "tet4": ("#c98a00", "^-"),
        "hex8": ("#c4541c", "s-"),
        "tet10": ("#0072b2", "^-"),
        "hex20": ("#00805e", "s-"),
        "hex27": ("#5a3e8c", "D-"),
    }
    for element, (colour, line) in style.items():
        rows = [r for r in finding.rows if r.get("element") == element]
        if rows:
            curve(axes, rows, "unknowns", "f1", line, colour, element.upper())
    for element in ("hex8", "hex20"):
        rows = [r for r in finding.rows if r.get("drawn out") == element]
        colour, words = style[element][0], f"{element.upper()} drawn out"
        curve(axes, rows, "unknowns", "f1", "o:", colour, words, mfc="white")
        for r in rows:
            axes.annotate(
                f"{r['length over width']:.0f}",
                (r["unknowns"], abs(r["f1"])),
                xytext=(5, 3),
                textcoords="offset points",
                fontsize=7.5,
                color=colour,
            )
    axes.set(
        xlabel="unknowns",
        ylabel="error of first bending",
        title=f"{finding.method} (figures: length over width of cells)",
    )
    axes.legend(ncols=2, fontsize=8)
