"""Stress concentration of filleted shoulders, beside what is published."""

from __future__ import annotations

from collections.abc import Callable

from solidgear.core.scene import Fillet, Port, Scene, Segment
from solidgear.strength.stress.din743 import LOADS, Load, form_factor
from solidgear.strength.stress.notch import fillet_factors
from solidgear.strength.stress.published import peterson
from validation.common import markdown
from validation.manual.case import Answer, Case, Model, Reference
from validation.manual.exact_fillets import finite_elements

DIAMETER = 0.05
#: D/d and r/d
SHAPES = (
    (1.05, 0.01),
    (1.1, 0.02),
    (1.2, 0.02),
    (1.2, 0.05),
    (1.5, 0.02),
    (1.5, 0.05),
    (1.5, 0.1),
    (1.5, 0.2),
    (2.0, 0.01),
    (2.0, 0.05),
    (2.0, 0.1),
    (2.0, 0.3),
)
SOURCES = {
    "tension": "Tipton, Sorem and Rolovic (1996), J. Mech. Des. 118, 321",
    "bending": "Tipton, Sorem and Rolovic (1996), J. Mech. Des. 118, 321",
    "torsion": "Rolovic, Tipton and Sorem (2001), J. Mech. Des. 123, 300",
}
#: of fits to finite elements, by what two loads scatter around ours
FIT = {"tension": 0.012, "bending": 0.012, "torsion": 0.025}


def _quantity(load: str, shape: tuple[float, float]) -> str:
    ratio, radius = shape
    return f"Kt {load}, D/d {ratio:g}, r/d {radius:g}"


def shoulder(ratio: float, radius: float) -> Scene:
    """A shaft with a step that is long on both sides."""
    large = ratio * DIAMETER
    length = 4 * large
    thin = Segment.cylinder("thin", length=length, diameter=DIAMETER)
    thick = Segment.cylinder("thick", y0=length, length=length, diameter=large)
    port = Port(y=2 * length, lo=1.9 * length, hi=2 * length)
    fillet = Fillet(name="fillet", y=length, radius=radius * DIAMETER)
    return Scene.from_parts([thin, thick], port=port, blends=[fillet])


def _solid(tolerance: float) -> Answer:
    values, unknowns = {}, 0
    for shape in SHAPES:
        found = fillet_factors(shoulder(*shape), "fillet", tolerance)
        unknowns = max(unknowns, found.steps[-1].unknowns)
        values |= {_quantity(load, shape): found.factors[load].value for load in LOADS}
    return Answer(values, unknowns)


def _short(published: Callable[..., float | None], load: Load) -> int:
    """Per cent by which published factors fall short at most."""
    factors = [
        (published(load, ratio, 1.0, radius), finite_elements(load, ratio, radius))
        for ratio, radius in SHAPES
    ]
    return round(max(100 * (1 - value / best) for value, best in factors if value is not None))


def _charts() -> str:
    """Table of published factors beside one another."""
    head = (
        "D/d",
        "r/d",
        "load",
        "finite elements",
        "Peterson",
        "per cent",
        "DIN 743-2",
        "per cent",
    )
    rows = []
    for ratio, radius in SHAPES:
        for load in LOADS:
            best = finite_elements(load, ratio, radius)
            chart = peterson(load, ratio, 1.0, radius)
            norm = form_factor(load, ratio, 1.0, radius)
            cells = [f"{ratio:g}", f"{radius:g}", load, f"{best:.3f}"]
            for value in (chart, norm):
                cells.append("no fit" if value is None else f"{value:.3f}")
                cells.append("" if value is None else f"{100 * (value / best - 1):+.1f}")
            rows.append(cells)
    return "\n".join(markdown(head, rows))


SHOULDERS = Case(
    name="shoulder_fillets",
    title="Stress concentration of filleted shoulders",
    problem="A round shaft steps from d to D with a fillet of radius r. What is the largest stress "
    "on the fillet over the nominal stress of the section with d?",
    geometry="Both sides of the step go on for four diameters D; d = 50 mm, D/d from 1.05 to 2, r/d "
    "from 0.01 to 0.3.",
    material="E 207 GPa, Poisson's ratio 0.3, density 7850 kg/m^3.",
    supports="Free; unit tension, bending and torsion at both ends of the piece around the fillet.",
    asked="Kt in tension and bending (normal stress along the meridian) and in torsion (shear).",
    references=tuple(
        Reference(
            _quantity(load, shape),
            finite_elements(load, *shape),
            "1",
            "literature",
            SOURCES[load],
            FIT[load],
            "a fit to finite element results, typed from memory: that of tension was found in a "
            "second place, those of bending and torsion are confirmed by what they are held against",
        )
        for shape in SHAPES
        for load in LOADS
    ),
    models=(
        Model(
            "harmonic solid of the piece around the fillet, bars of 1 %",
            lambda: _solid(0.01),
            {_quantity(load, shape): FIT[load] for shape in SHAPES for load in LOADS},
            "what fits of a few coefficients leave; the bars of the solid are below 1 %, and meshes "
            "four times as fine change it by less than 0.6 %",
            12.0,
        ),
    ),
    remarks="Peterson's charts (as fitted by Pilkey) and the formulas of DIN 743-2 beside the fits "
    f"to finite elements:\n\n{_charts()}\n\n"
    f"Where their fit is given Peterson's charts lie up to {_short(peterson, 'tension')} % too low in "
    f"tension and {_short(peterson, 'bending')} % in bending, the norm {_short(form_factor, 'tension')} and "
    f"{_short(form_factor, 'bending')} %. Peterson's charts were taken over from grooves and flat bars, as "
    "Tipton, Sorem and Rolovic (1996) found. So the 3 to 5 % to which charts are read say nothing of how "
    "near they are; in torsion they are as near as that.",
)


CASES = (SHOULDERS,)
