"""Problem: a shaft with a head on two bearings, drawn oddly in one respect at a time: lumped point
off its surface, narrow seats, thin discs, thin joints, steep cones, tiny steps, bearings almost at
one place, seats that touch, overlap or hang over.  Reference: the harmonic solid of the same scene.

Model: the Timoshenko beam.  What counts is the gap between the two in excess of the sound scene's,
what `check_scene` says, and the residual of the modes.
"""

from __future__ import annotations

import re

import numpy as np

import solidgear as sg
from solidgear.core.scene import Bearing, Port, Scene, Segment
from solidgear.guards.check import check_scene
from validation.stability.frame import Finding, curve

K = np.diag([1e9, 5e8, 1e9, 2e6, 0.0, 2e6])
PIN = np.diag([1e9, 5e8, 1e9, 0.0, 0.0, 0.0])
HEAD, LENGTH, DIAMETER = 0.06, 0.3, 0.06
LIMIT = 0.1


def scene(
    segments=None,
    seats=((0.1, 0.03), (0.25, 0.03)),
    port=(0.03, 0.0, HEAD),
    matrix=K,
    attachment="average",
) -> Scene:
    """The sound scene with some part replaced; seats are (middle, width), the port is (y, from,
    to).
    """
    segments = segments or (
        Segment.cylinder("head", length=HEAD, diameter=0.12),
        Segment.cylinder("shaft", length=LENGTH - HEAD, diameter=DIAMETER, y0=HEAD),
    )
    bearings = [
        Bearing(name=str(i + 1), y=y, seat_width=w, matrix=matrix, attachment=attachment)
        for i, (y, w) in enumerate(seats)
    ]
    return Scene.from_parts(
        segments,
        bearings=bearings,
        port=Port(name="p", y=port[0], lo=port[1], hi=port[2], attachment=attachment),
    )


def disc(length: float) -> Scene:
    """A head that is a disc."""
    parts = (
        Segment.cylinder("head", length=length, diameter=0.12),
        Segment.cylinder("shaft", length=LENGTH - length, diameter=DIAMETER, y0=length),
    )
    return scene(parts, port=(length / 2, 0.0, length))


def cone(length: float) -> Scene:
    """The step drawn as a short cone."""
    parts = (
        Segment.cylinder("head", length=HEAD - length, diameter=0.12),
        Segment.cone(
            "cone", length=length, start_diameter=0.12, end_diameter=DIAMETER, y0=HEAD - length
        ),
        Segment.cylinder("shaft", length=LENGTH - HEAD, diameter=DIAMETER, y0=HEAD),
    )
    return scene(parts, port=(0.03, 0.0, 0.05))


def joint(width: float) -> Scene:
    """A hollow head that shares a ring of that width with the end face of the shaft."""
    parts = (
        Segment.cylinder("head", length=HEAD, diameter=0.12, bore=DIAMETER - 2 * width),
        Segment.cylinder("shaft", length=LENGTH - HEAD, diameter=DIAMETER, y0=HEAD),
    )
    return scene(parts)


def step(height: float) -> Scene:
    """A step of that height in the diameter."""
    return scene(
        (
            Segment.cylinder("head", length=HEAD, diameter=DIAMETER + height),
            Segment.cylinder("shaft", length=LENGTH - HEAD, diameter=DIAMETER, y0=HEAD),
        )
    )


#: what is odd -> (how to make it, values from sound to absurd, unit)
SWEEPS = {
    "lumped point beyond its surface, over the diameter": (
        lambda d: scene(port=(HEAD + d * DIAMETER, 0.0, HEAD)),
        (0.1, 0.33, 1.0, 2.0, 4.0),
    ),
    "seat width over the diameter": (
        lambda w: scene(seats=((0.1, w * DIAMETER), (0.25, w * DIAMETER))),
        (0.5, 0.2, 0.1, 0.05, 0.02, 1e-2, 1e-3),
    ),
    "head length over its diameter": (
        lambda x: disc(0.12 * x),
        (0.5, 0.3, 0.2, 0.1, 0.05, 0.02, 1e-2, 1e-3),
    ),
    "cone length over the step, across a shoulder": (
        lambda x: cone(0.03 * x),
        (1.0, 0.5, 0.2, 0.1, 1e-2, 1e-3),
    ),
    "ring shared by hollow head and shaft, over the radius": (
        lambda x: joint(x * DIAMETER / 2),
        (0.9, 0.5, 0.3, 0.2, 0.1, 0.05, 1e-2, 1e-3),
    ),
    "step over the diameter": (lambda x: step(x * DIAMETER), (0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)),
    "lever between bearings without tilt stiffness, over the diameter": (
        lambda x: scene(
            seats=((0.1, 0.5 * x * DIAMETER), (0.1 + x * DIAMETER, 0.5 * x * DIAMETER)), matrix=PIN
        ),
        (1.0, 0.3, 0.1, 1e-2, 1e-3),
    ),
}
FEW = {
    "lumped point beyond its surface, over the diameter": (1.0,),
    "head length over its diameter": (1e-2,),
    "ring shared by hollow head and shaft, over the radius": (0.05,),
}
#: things that are plainly wrong -> how to make them
PLAIN = {
    "lumped point off the shaft": lambda: scene(port=(-0.01, 0.0, HEAD)),
    "span across the step": lambda: scene(port=(0.03, 0.0, 0.08)),
    "span backwards": lambda: scene(port=(0.03, 0.05, 0.01)),
    "seat over the end": lambda: scene(seats=((0.1, 0.03), (0.29, 0.03))),
    "seat across the step": lambda: scene(seats=((0.06, 0.03), (0.25, 0.03))),
    "seat touches the step": lambda: scene(seats=((0.075, 0.03), (0.25, 0.03))),
    "seats overlap": lambda: scene(seats=((0.1, 0.03), (0.12, 0.03))),
    "seats touch, averaged": lambda: scene(seats=((0.1, 0.03), (0.13, 0.03))),
    "seats touch, rigid": lambda: scene(seats=((0.1, 0.03), (0.13, 0.03)), attachment="rigid"),
    "two bearings at one place": lambda: scene(seats=((0.1, 0.03), (0.1, 0.03))),
    "lumped span on a rigid seat": lambda: scene(port=(0.1, 0.09, 0.11), attachment="rigid"),
    "lumped span on an averaged seat": lambda: scene(port=(0.1, 0.085, 0.115)),
}


def answers(body, here) -> dict:
    """Compliances at the lumped point, first bending, residual of the modes."""
    c = sg.condense(body, here, port="p").compliance
    found = sg.modes(body, here, n=8)
    first = found.named("bending 1")
    return {
        "C_zz": c[2, 2],
        "C_thx": c[3, 3],
        "f1": first.frequency_hz if first else np.nan,
        "residual": found.evidence["residual"],
        "local": sum(m.family == "local" for m in found.modes),
    }


def cautions(here, body) -> set[str]:
    """What `check_scene` says, without its figures."""
    said = check_scene(here, body)
    return {re.sub(r"[-+]?\d[\d.e+-]*", "#", s) for s in (*said.cautions, *said.faults)}


def compare(here, quick: bool) -> dict:
    """Beam and solid of one scene."""
    solid = sg.build(
        here, "harmonic", order=3, layers=1 if quick else 2, edge_layers=0 if quick else 1
    )
    beam, full = answers(sg.build(here, "timoshenko"), here), answers(solid, here)
    return {name: full[name] / beam[name] - 1 for name in ("C_zz", "C_thx", "f1")} | {
        "residual": full["residual"],
        "local modes": full["local"],
        "said": cautions(here, solid),
    }


def measure(quick: bool = False) -> list[Finding]:
    """Gaps in excess of the sound scene's, what is refused, what is told."""
    sound = compare(scene(), quick)
    rows = []
    for what, (make, values) in SWEEPS.items():
        if quick and what not in FEW:
            continue
        for value in FEW[what] if quick else values:
            row = {"odd": what, "value": value}
            try:
                got = compare(make(value), quick)
            except sg.SolidgearError as error:
                rows.append(row | {"outcome": "refused", "sentence": str(error)})
                continue
            gaps = {
                name: max(abs(got[name]) - abs(sound[name]), 0.0)
                for name in ("C_zz", "C_thx", "f1")
            }
            new = got["said"] - sound["said"]
            worst = max(gaps.values())
            outcome = (
                "told"
                if new
                else "silent"
                if worst > LIMIT or got["residual"] > 1e-3 or np.isnan(got["f1"])
                else "sound"
            )
            rows.append(
                row
                | gaps
                | {
                    "worst": worst,
                    "residual": got["residual"],
                    "local modes": got["local modes"],
                    "outcome": outcome,
                    "sentence": " / ".join(sorted(new)),
                }
            )
    plain = []
    for what, make in PLAIN.items():
        row = {"odd": what}
        for model, options in (
            ("timoshenko", {}),
            ("harmonic", {"order": 2, "layers": 0, "edge_layers": 0}),
        ):
            try:
                sg.condense(sg.build(make(), model, **options), make(), port="p")
                row[model] = "accepted"
            except sg.SceneError as error:
                row |= {model: "scene refused", "sentence": error.reason}
            except sg.SolidgearError as error:
                row |= {model: "model refused", "sentence": str(error)}
        plain.append(row)
    silent = {}
    for what in dict.fromkeys(r["odd"] for r in rows):
        own = [r for r in rows if r["odd"] == what and r["outcome"] == "silent"]
        if own:
            begins, worst = own[0], max(own, key=lambda r: r["worst"])
            silent[what] = (
                f"{what} from {begins['value']:g} ({100 * begins['worst']:.0f} %), at worst "
                f"{_times(worst['worst'])}, residual up to {max(r['residual'] for r in own):.0e}"
            )
    return [
        Finding(
            "odd_geometry",
            "Shafts drawn oddly",
            "Beam and solid answer different questions once the lumped point leaves its "
            "surface, a head is a disc, or parts hang together by a thin ring.",
            f"Gaps of more than {100 * LIMIT:.0f} % in excess of the sound scene's, or no first "
            f"bending at all, come without a caution for: {'; '.join(silent.values()) or 'none'}.",
            "`solidgear check` cautions on discs, thin joints, narrow seats and lumped "
            "points off their surface. A scene is refused where a part is a millionth of "
            "the shaft.",
            "tests/test_check_guards.py::test_guard[disc]",
            rows,
        ),
        Finding(
            "impossible_geometry",
            "Seats and spans that cannot be",
            "Seats that overlap, cross a step or hang over the end, and lumped points off "
            "the shaft, have no meaning that every model shares.",
            f"Of {len(plain)} such scenes {sum(r['harmonic'] == 'scene refused' for r in plain)} "
            "are refused as scenes. Left are: "
            + "; ".join(
                f"{r['odd']} ({r['harmonic']} by the solid)"
                for r in plain
                if r["harmonic"] != "scene refused"
            )
            + ".",
            "Every command refuses such a scene with the place and the numbers. Two rigid "
            "seats that touch are refused by the solids only, for only they share points.",
            "tests/test_bad_scenes.py::test_refused_in_one_line",
            plain,
        ),
    ]


def _times(gap: float) -> str:
    return f"{1 + gap:.3g} times" if gap > 1 else f"{100 * gap:.0f} %"


def draw(finding: Finding, axes) -> None:
    """Gaps over what is odd; for impossible scenes, what became of each."""
    axes.set_title(finding.method)
    if finding.name == "impossible_geometry":
        names = [r["odd"] for r in finding.rows][::-1]
        colours = {"accepted": "#0072b2", "scene refused": "#c4541c", "model refused": "#e0a030"}
        for i, r in enumerate(finding.rows[::-1]):
            for k, model in enumerate(("timoshenko", "harmonic")):
                axes.barh(i, 0.9, left=k, color=colours[r[model]])
                axes.text(
                    k + 0.45, i, r[model], ha="center", va="center", fontsize=7, color="white"
                )
        axes.set_yticks(range(len(names)), names, fontsize=7)
        axes.set_xticks((0.45, 1.45), ("beam", "harmonic solid"))
        return
    for what, marker in zip(SWEEPS, "osD^v<P"):
        rows = [r for r in finding.rows if r["odd"] == what and "worst" in r]
        if rows:
            curve(axes, rows, "value", "worst", marker + "-", None, what, least=1e-5)
            quiet = [r for r in rows if r["outcome"] == "silent"]
            curve(axes, quiet, "value", "worst", "o", "#aa2222", least=1e-5, ms=10, mfc="none")
    axes.axhline(LIMIT, color="#aa2222", lw=0.8, ls="--")
    axes.set(
        xlabel="what is odd, relative (circled in red: without a caution)",
        ylabel="gap beam to solid in excess of the sound scene's",
    )
    axes.legend(fontsize=6)
