"""Problem: a shaft whose Poisson ratio goes to one half.  Reference: the harmonic solid of order 10
at the same ratio.

Models: all elements of the 3D solid, the harmonic solid of low order, the Timoshenko beam (its
shear coefficient).  A displacement element that cannot keep its volume while it bends locks: its
error grows with 1 / (1 - 2 nu).
"""

from __future__ import annotations

import solidgear as sg
from validation.stability.frame import Finding
from validation.stability.linear_elements import PLAIN, RADIUS, answers, shaft

RATIOS = (0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999)
FEW = (0.3, 0.49, 0.4999)
HEX = dict(PLAIN, size=RADIUS / 1.5, around=16)
TET = dict(size=RADIUS / 3, graded_size=RADIUS / 3, around=16)
FLAT = dict(layers=0, edge_layers=0, size=RADIUS / 2)
MODELS = {
    "tet4": ("solid", dict(TET, element="tet4")),
    "hex8": ("solid", dict(HEX, element="hex8")),
    "tet10": ("solid", dict(TET, element="tet10")),
    "hex20": ("solid", dict(HEX, element="hex20")),
    "hex27": ("solid", dict(HEX, element="hex27")),
    "harmonic Q1": ("harmonic", dict(FLAT, order=1)),
    "harmonic Q2": ("harmonic", dict(FLAT, order=2)),
    "harmonic Q3": ("harmonic", dict(FLAT, order=3)),
    "harmonic Q5": ("harmonic", dict(FLAT, order=5)),
    "timoshenko, first bending": ("timoshenko", {}),
}
COLOURS = {
    "tet4": "#c98a00",
    "hex8": "#c4541c",
    "tet10": "#0072b2",
    "hex20": "#00805e",
    "hex27": "#5a3e8c",
    "harmonic Q1": "#c4541c",
    "harmonic Q2": "#00805e",
    "harmonic Q3": "#0072b2",
    "harmonic Q5": "#888888",
    "timoshenko, first bending": "#111111",
}
CHEAP = ("hex8", "hex20", "harmonic Q1", "harmonic Q2", "harmonic Q5", "timoshenko, first bending")
LINEAR = ("tet4", "hex8", "harmonic Q1")
HIGH = ("harmonic Q3", "harmonic Q5", "timoshenko, first bending")


def compliance(scene, fidelity: str, **options) -> float:
    """Tilt under a unit moment, rad/(N m)."""
    return sg.condense(sg.build(scene, fidelity, **options), scene, port="port").compliance[3, 3]


def beam_error(scene, body) -> float:
    """First bending of the free Timoshenko beam against that of a body."""
    return answers(sg.build(scene, "timoshenko"), scene)["f1"] / answers(body, scene)["f1"] - 1


def measure(quick: bool = False) -> Finding:
    """Error of the bending compliance of every model at every ratio; of first bending for the beam,
    whose pure bending knows no nu.
    """
    rows = {model: {"model": model} for model in (CHEAP if quick else MODELS)}
    for nu in FEW if quick else RATIOS:
        scene = shaft().with_material(nu=nu)
        exact = sg.build(scene, "harmonic", order=8 if quick else 10, **FLAT)
        want = sg.condense(exact, scene, port="port").compliance[3, 3]
        for model, row in rows.items():
            fidelity, options = MODELS[model]
            row[f"nu {nu:g}"] = (
                beam_error(scene, exact)
                if fidelity == "timoshenko"
                else compliance(scene, fidelity, **options) / want - 1
            )
    rows = list(rows.values())
    at = [k for k in rows[0] if k != "model"]

    def words(chosen):
        return ", ".join(
            f"{r['model']} {100 * abs(r[at[0]]):.2g} to {100 * abs(r[at[-1]]):.2g} %"
            for r in rows
            if chosen(r["model"])
        )

    return Finding(
        "nearly_incompressible",
        "Elements near nu = 1/2",
        "Linear elements lock as the material becomes incompressible; quadratic ones do "
        "so later, high orders and the beam do not.",
        f"Error of the bending compliance from {at[0]} to {at[-1][3:]}: "
        f"{words(lambda m: m in LINEAR)}. Of order two: {words(lambda m: m not in LINEAR + HIGH)}. "
        f"Others: {words(lambda m: m in HIGH)}.",
        "The scene refuses nu of 0.5 and above. `solidgear check` cautions where the "
        "element asked for errs by more than 1 % at this nu (hexahedra of order two "
        "from 0.496) and names the harmonic solid.",
        "tests/test_check_guards.py::test_guard[hex20 locks]",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Error over the distance of nu from one half."""
    at = [k for k in finding.rows[0] if k.startswith("nu ")]
    away = [0.5 - float(k[3:]) for k in at]
    for row in finding.rows:
        line = "o-" if MODELS[row["model"]][0] == "solid" else "x--"
        errors = [abs(row[k]) for k in at]
        axes.loglog(away, errors, line, color=COLOURS[row["model"]], label=row["model"])
    axes.invert_xaxis()
    axes.set_xticks(away, [k[3:] for k in at], fontsize=8)
    axes.minorticks_off()
    axes.set(xlabel="Poisson ratio", ylabel="error of the bending compliance", title=finding.method)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)
