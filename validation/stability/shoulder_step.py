"""Problem: a shaft clamped by its thick part and loaded at its thin end.  Reference: the harmonic
solid, tied by section means at both ends as a beam is.

Model: Timoshenko beam.  A pure moment loads a section tie with the stresses of beam theory, so all
of the gap in tilt comes from the shoulder: stress cannot fill the thick part right behind it.  It
is told as a missing length of thin shaft, and as the angle of the cone (from the axis) that the
thick part may be thought to start with.
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.scene import STEEL, Port, Scene, Segment
from validation.manual.models import FIRM, bearing
from validation.stability.frame import Finding, columns, crossing

THIN = 0.1  # diameter, m
RATIOS = (1.02, 1.05, 1.1, 1.2, 1.3, 1.5, 1.75, 2.0, 2.5, 3.0)
FEW = (1.05, 1.2, 1.5, 2.0, 3.0)
REACH = (1.0, 2.0)  # lengths of the thin shaft in its diameters
LEVELS = (0.01, 0.05)


def shaft(ratio: float, reach: float, angle: float | None = None, softer: float = 1.0) -> Scene:
    """Thin shaft, then a thick one held by an immovable section; the thick one may start with a
    cone, and be of a material so many times softer.
    """
    step, end = reach * THIN, reach * THIN + 1.5 * ratio * THIN
    thick = ratio * THIN
    segments = [Segment.cylinder("thin", length=step, diameter=THIN)]
    y = step
    if angle is not None:
        y = step + (thick - THIN) / 2 / np.tan(angle)
        segments.append(
            Segment.cone("cone", y0=step, length=y - step, start_diameter=THIN, end_diameter=thick)
        )
    segments.append(Segment.cylinder("thick", y0=segments[-1].y1, length=end - y, diameter=thick))
    material = STEEL.with_changes(E=STEEL.E / softer)
    segments[1:] = [segment.with_changes(material=material) for segment in segments[1:]]
    width = (
        2e-4 * THIN
    )  # what lies beyond a tie is strained along and stiffens: 0.002 d in tilt at a stub of 0.01 d
    clamp = bearing("clamp", end - width / 2, width, [FIRM] * 6)
    return Scene.from_parts(
        segments, bearings=[clamp], port=Port(y=0.0, lo=0.0, hi=width, attachment="section")
    )


def compliance(model: str, scene: Scene, **options) -> tuple[float, float]:
    """Deflection under a unit force and tilt under a unit moment at the thin end."""
    c = sg.condense(sg.build(scene, model, **options), scene, port="port").compliance
    return c[2, 2], c[3, 3]


def of_two_materials(
    ratios=(1.05, 1.2, 1.5, 2.0, 3.0, 6.0), softer=(0.2, 0.5, 2.0, 5.0, 20.0), order=5, layers=3
) -> list[dict]:
    """What a beam lacks in bending, stretch and twist where the thick part is so many times softer
    than the thin one, over what it lacks in one material.
    """
    rows = []
    for ratio in ratios:
        alone = lacking(ratio, 1.0, order, layers)
        for times in softer:
            share = lacking(ratio, times, order, layers) / alone
            names = ("bending", "stretch", "twist")
            rows.append({"ratio": ratio, "softer": times} | dict(zip(names, share.tolist())))
    return rows


def lacking(ratio: float, softer: float, order: int, layers: int) -> np.ndarray:
    """Tilt, stretch and twist of the harmonic solid less those of the beam, under their own load."""
    scene = shaft(ratio, 2.0, softer=softer)
    mesh = {"order": order, "layers": layers, "edge_layers": 0, "size": THIN / 2}
    solid, beam = (
        np.diag(sg.condense(sg.build(scene, model, **options), scene, port="port").compliance)
        for model, options in (("harmonic", mesh), ("timoshenko", {}))
    )
    return (solid - beam)[[3, 1, 4]]


def cone_angle(extra: float, ratio: float) -> float:
    """Angle (rad) of the cone whose extra tilt under a unit moment, over a cylinder of the thick
    radius, is ``extra``.
    """
    a, b = THIN / 2, ratio * THIN / 2
    # int dy / (E I) along the cone less along the cylinder, with dy = dr cot(angle)
    per_cot = ((a**-3 - b**-3) / 3 - (b - a) / b**4) / (STEEL.E * np.pi / 4)
    return float(np.arctan(per_cot / extra))


def measure(quick: bool = False) -> Finding:
    """Gap over the step ratio."""
    rows = []
    stiff = STEEL.E * np.pi / 64 * THIN**4
    for ratio in FEW if quick else RATIOS:
        row = {"ratio": ratio}
        for reach in REACH:
            scene = shaft(ratio, reach)
            options = dict(edge_layers=0, size=THIN / 2)
            solid = compliance(
                "harmonic", scene, order=4 if quick else 6, layers=2 if quick else 4, **options
            )
            beam = compliance("timoshenko", scene)
            row |= {
                f"C_zz, {reach:g} d": beam[0] / solid[0] - 1,
                f"C_thx, {reach:g} d": beam[1] / solid[1] - 1,
            }
            row[f"missing length / d, {reach:g} d"] = (solid[1] - beam[1]) * stiff / THIN
        extra = solid[1] - beam[1]
        row["cone angle, deg"] = np.degrees(cone_angle(extra, ratio))
        row["C_zz with that cone"] = (
            compliance("timoshenko", shaft(ratio, reach, cone_angle(extra, ratio)))[0] / solid[0]
            - 1
        )
        row["C_zz with a hinge"] = (beam[0] + extra * (reach * THIN) ** 2) / solid[0] - 1
        rows.append(row)
    at = [r["ratio"] for r in rows]

    def passed(name, level):
        x = crossing(at, [abs(r[name]) for r in rows], level)
        return f"{level:.0%} at {x:.2f}" if np.isfinite(x) else f"{level:.0%} never"

    last = rows[-1]
    return Finding(
        "shoulder_step",
        "Beam at a shoulder",
        "A beam fills the thick section with stress at once; the solid needs a cone of "
        "length to do so, and is softer.",
        "By ratio of diameters, the deflection of an overhang of one diameter is too small by "
        f"{passed('C_zz, 1 d', 0.01)}, {passed('C_zz, 1 d', 0.05)}. The shoulder is worth up to "
        f"{last['missing length / d, 1 d']:.3f} d of thin shaft, at ratio {last['ratio']:g}.",
        "`solidgear check` cautions for every shoulder from 1 % on with the length it "
        "is worth, and measures the beam against a light harmonic solid on the scene "
        "itself.",
        "tests/test_check_guards.py::test_guard[shoulder]",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Errors and cone angle over the ratio."""
    for name, line, colour, words in (
        ("C_zz, 1 d", "o-", "#c4541c", "deflection, overhang 1 d"),
        ("C_zz, 2 d", "s-", "#0072b2", "deflection, overhang 2 d"),
        ("C_thx, 1 d", "v-", "#c98a00", "tilt, overhang 1 d"),
        ("C_zz with that cone", "D-", "#00805e", "deflection, 2 d, with the cone"),
        ("C_zz with a hinge", "^-", "#111111", "deflection, 2 d, with a hinge"),
    ):
        at, error = columns(finding.rows, "ratio", name)
        axes.plot(at, 100 * error, line, color=colour, label=words)
    axes.set(
        xlabel="ratio of diameters",
        ylabel="beam against solid, %",
        title=finding.method,
        ylim=(-22, 22),
    )
    axes.legend(loc="upper left", ncols=2)
    other = axes.twinx()
    other.plot(*columns(finding.rows, "ratio", "cone angle, deg"), ":", color="#5a3e8c", lw=1.6)
    other.set(ylabel="angle of the equivalent cone, degrees (dotted)", ylim=(0, 90))
    other.spines["right"].set_visible(True)
    other.grid(visible=False)
