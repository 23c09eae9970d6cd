"""Notches of solved examinations and of a book, rated through scenes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.scene.parts import Strength
from solidgear.cuts.features import PressFit
from solidgear.cuts.features.fits import interference_of
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.din743 import LOADS, Load, form_factor, gradient
from solidgear.strength.stress.norm_notch import NotchByForm, Section
from solidgear.strength.stress.notch import fillet_factors
from solidgear.strength.stress.published import peterson
from solidgear.strength.stress.rating import rated
from validation.manual.case import Answer, Case, Model
from validation.manual.printed import printed, to_the_digits

EXAMS = (
    "Maschinenelemente, examination of winter {}, results in tests/test_1.py of "
    "github.com/hanslhansl/din743"
)
ROD = {"kind": "cylinder", "name": "rod", "length": "400 mm"}
EQUATIONS = 6
SAFETIES = "Safety against fatigue and against yielding by DIN 743."
READ_OFF = "charts are read off to some 3 to 5 %"
ROUNDED = "the norm's formulas give the printed digits"


def _rated(
    segments: list[dict[str, Any]],
    feature: dict[str, Any],
    strength: Mapping[str, str],
    load: Mapping[str, float],
    tol: float = 0.01,
    **conditions: Any,
) -> dict[str, float]:
    """Safeties of the one notch of a shaft between moments, torques and forces at its ends."""
    ends = [
        {
            "name": name,
            "position": f"{place} mm",
            "seat_width": "10 mm",
            "thx": sign * load.get("moment", 0.0),
            "torque": sign * load.get("torque", 0.0),
            "y": -sign * load.get("force", 0.0),
        }
        for name, place, sign in (("left", 5, 1), ("right", 395, -1))
    ]
    bearings = [
        {"name": name, "position": f"{place} mm", "seat_width": "10 mm"}
        | {"stiffness": dict.fromkeys(axes, 1e9)}
        for name, place, axes in (("A", 30, ("kxx", "kyy", "kzz")), ("B", 370, ("kxx", "kzz")))
    ]
    scene = {
        "material": {"E": "210 GPa", "nu": 0.3, "density": "7850 kg/m^3", "strength": strength},
        "segment": segments,
        "feature": [feature],
        "bearing": bearings,
        "port": {"name": "middle", "position": "300 mm", "span": ["295 mm", "305 mm"]},
        "load": ends,
    }
    shaft = sg.stress(scene, "euler", tol=tol, conditions=conditions).shafts[0].found
    (notch,) = shaft.worst
    assert notch.rating is not None
    return {"fatigue": notch.rating.fatigue, "yielding": notch.rating.yielding}


def _shaft(diameter: str) -> list[dict[str, Any]]:
    return [ROD | {"diameter": diameter}]


def _exam(
    name: str,
    title: str,
    problem: str,
    geometry: str,
    steel: str,
    loads: str,
    year: str,
    values: Mapping[str, str],
    solve: Any,
) -> Case:
    return Case(
        name=name,
        title=title,
        problem=problem,
        geometry=geometry,
        material=steel,
        supports=loads,
        asked=SAFETIES,
        printed=True,
        references=printed(values, "1", EXAMS.format(year)),
        models=(
            Model(
                "rating of the notch in a scene",
                lambda: Answer({k: v for k, v in solve().items() if k in values}, EQUATIONS),
                to_the_digits(values),
                ROUNDED,
            ),
        ),
    )


def _shoulder(small: float, large: float, radius: float) -> NotchByForm:
    """Shoulder by the norm's own form factors; lengths in m."""
    return NotchByForm(
        Section(small),
        "",
        {load: form_factor(load, large, small, radius) for load in LOADS},
        {load: gradient(load, large, small, radius) for load in LOADS},
        revolved=True,
    )


STEEL_1 = {"yield_point": "900 MPa", "ultimate": "1100 MPa", "group": "tempering"}
LOAD_1 = {"moment": 23275.43165, "torque": 13965.25899, "force": 443341.5553}
HOW_1 = {
    "roughness": "10 um",
    "bending_share": 2909.428956 / 23275.43165,
    "constant_mean": True,
}


def _by_the_norm() -> Answer:
    """Safeties of the first examination by the norm's form factors alone."""
    notch = _shoulder(0.084, 0.1, 0.004)
    six = np.array([0.0, LOAD_1["force"], 0.0, LOAD_1["moment"], LOAD_1["torque"], 0.0])
    conditions = Conditions(**HOW_1)
    levels = conditions.levels(notch.section.nominal(six))
    rating = rated(notch, levels, Strength(**STEEL_1), conditions, 0.1, "")
    return Answer({"fatigue": rating.fatigue, "yielding": rating.yielding}, EQUATIONS)


def _in_a_scene() -> Answer:
    segments = [
        ROD | {"name": name, "length": "200 mm", "diameter": diameter}
        for name, diameter in (("thick", "100 mm"), ("thin", "84 mm"))
    ]
    fillet = {"kind": "fillet", "name": "shoulder", "at": "thick.end", "radius": "4 mm"}
    return Answer(_rated(segments, fillet, STEEL_1, LOAD_1, **HOW_1), EQUATIONS)


SAFETIES_1 = {"fatigue": "2.373", "yielding": "1.464"}
SHOULDER = Case(
    name="printed_norm_shoulder",
    title="Shoulder under tension, bending and torsion, DIN 743",
    problem="A shaft that stands still has a shoulder, and its bending swells.",
    geometry="Shoulder from 100 to 84 mm with a radius of 4 mm; Rz 10 um.",
    material="50CrMo4: tensile strength 1100 MPa, yield point 900 MPa.",
    supports="443341.5553 N, 23275.43165 +- 2909.428956 N m of bending, 13965.25899 N m of torque; "
    "mean stress constant (case 1).",
    asked=SAFETIES,
    printed=True,
    references=printed(SAFETIES_1, "1", EXAMS.format("2024, exercise 1")),
    models=(
        Model(
            "form factors of the norm",
            _by_the_norm,
            to_the_digits(SAFETIES_1),
            ROUNDED,
        ),
        Model(
            "rating of the fillet in a scene, bars of 1 %",
            _in_a_scene,
            {"fatigue": 0.01, "yielding": 5e-4},
            "the scene takes the form factor of the solid, which lies above the norm's; bars of 1 %",
            1.5,
            known={"fatigue": -0.048},
        ),
    ),
    remarks="`solidgear stress` shows the norm's factors beside those of the solid, which give less "
    "safety ([why](shoulder_fillets.md)).",
)
KEYWAY = _exam(
    "printed_norm_keyway",
    "Keyway in a hard surface, DIN 743",
    "A turning shaft has a keyway in a hardened surface.",
    "Keyway in 60 mm, treated at 80 mm; Rz 25 um.",
    "C50: tensile strength 750 MPa, yield point 520 MPa.",
    "1402.294 N m of bending, 1336.902 N m of torque, overload 1.8.",
    "2024, exercise 2",
    {"fatigue": "1.472", "yielding": "2.568"},
    lambda: _rated(
        _shaft("60 mm"),
        {
            "kind": "keyway", "name": "key", "segment": "rod", "position": "150 mm",
            "length": "60 mm", "width": "18 mm", "depth": "7 mm",
        },
        {"yield_point": "520 MPa", "ultimate": "750 MPa", "group": "tempering"},
        {"moment": 1402.294, "torque": 1336.902},
        treated_diameter="80 mm",
        roughness="25 um",
        hard_surface=True,
        overload=1.8,
    ),
)  # fmt: skip
V_GROOVE = _exam(
    "printed_norm_v_groove",
    "V groove that yields, DIN 743",
    "A shaft that stands still has a V groove under tension and bending.",
    "V groove from 80 to 60 mm.",
    "S235: tensile strength 360 MPa, yield point 235 MPa.",
    "40 kN, 12666.667 N m of bending, overload 1.5.",
    "2024, exercise 4",
    {"yielding": "0.274"},
    lambda: _rated(
        _shaft("80 mm"),
        {"kind": "v_groove", "name": "groove", "segment": "rod", "position": "200 mm"}
        | {"depth": "10 mm"},
        {"yield_point": "235 MPa", "ultimate": "360 MPa", "group": "construction"},
        {"moment": 12666.667, "force": 40e3},
        tol=0.2,  # the rating takes the norm's factor
        bending_share=0.0,
        overload=1.5,
    ),
)
CROSS_HOLE = _exam(
    "printed_norm_cross_hole",
    "Cross hole, DIN 743",
    "A turning shaft has a cross hole.",
    "Hole of 4 mm across 50 mm, treated at 80 mm; Rz 25 um.",
    "E335: tensile strength 570 MPa, yield point 335 MPa.",
    "1088.802 N m of bending, 596.831 N m of torque, overload 2.",
    "2022",
    {"fatigue": "1.105", "yielding": "1.607"},
    lambda: _rated(
        _shaft("50 mm"),
        {"kind": "cross_hole", "name": "hole", "segment": "rod", "position": "200 mm"}
        | {"diameter": "4 mm"},
        {"yield_point": "335 MPa", "ultimate": "570 MPa", "group": "construction"},
        {"moment": 1088.802, "torque": 596.831},
        treated_diameter="80 mm",
        roughness="25 um",
        overload=2.0,
    ),
)


# ----------------------------------------------------------------------- charts of a book
def _charts() -> Answer:
    sizes = {"large": 1.65, "small": 1.1, "radius": 0.11}
    values = {load: peterson(load, **sizes) for load in CHARTS}
    return Answer({load: value for load, value in values.items() if value is not None}, 1)


def _solid() -> Answer:
    segments = [
        ROD | {"name": name, "length": "6 in", "diameter": diameter}
        for name, diameter in (("thick", "1.65 in"), ("thin", "1.1 in"))
    ]
    scene = {
        "material": {"E": "30e6 psi", "nu": 0.292, "density": "7800 kg/m^3"},
        "segment": segments,
        "feature": [{"kind": "fillet", "name": "shoulder", "at": "thick.end", "radius": "0.11 in"}],
        "port": {"name": "end", "position": "1 in", "span": ["0.5 in", "1.5 in"]},
    }
    fillet = fillet_factors(sg.Scene.from_dict(scene), "shoulder", 0.01)
    values: dict[str, float] = {load: fillet.factors[load].value for load in CHARTS}
    return Answer(values, max(step.unknowns for step in fillet.steps))


CHARTS: dict[Load, str] = {"bending": "1.68", "torsion": "1.42"}
BOOK_SHOULDER = Case(
    name="printed_shoulder",
    title="Stress concentration of a shoulder, Shigley 7-1",
    problem="How much larger is the stress on a fillet than the nominal stress?",
    geometry="Shoulder from 1.65 to 1.1 in with a radius of 0.11 in: D/d 1.5, r/d 0.1.",
    material="Steel; no factor of the charts depends on it.",
    supports="1260 lbf in of bending, 1100 lbf in of torque.",
    asked="Kt and Kts.",
    printed=True,
    references=printed(
        dict(CHARTS.items()),
        "1",
        "Shigley's Mechanical Engineering Design, 9th edition, example 7-1, page 370, read off "
        "figures A-15-9 and A-15-8",
    ),
    models=(
        Model("Peterson's charts, as fitted by Pilkey", _charts, 0.05, READ_OFF),
        Model(
            "harmonic solid of the piece around the fillet, bars of 1 %",
            _solid,
            0.05,
            f"{READ_OFF}; in bending elasticity lies above them",
            2.0,
            known={"bending": 0.075},
        ),
    ),
    remarks="Charts fall short of elasticity in bending ([by how much](shoulder_fillets.md)). The "
    "book goes on with notch sensitivity and DE-Goodman, which DIN 743 does not have.",
)


# ----------------------------------------------------------------------- hub shrunk onto a shaft
def _hub() -> Answer:
    seat = sg.Segment.cylinder("seat", length=0.1, diameter=0.08, material=HUB_SHAFT)
    hub = PressFit(name="hub", segment="seat", y=0.0, hub_diameter="168 mm", fit="H7/s6")
    smoothed = hub.with_changes(fit=None, interference="68 um", hub_E="176 GPa")
    least, most = (1e6 * value for value in interference_of("H7/s6", 0.08))
    values = {"least interference": least, "largest interference": most}
    return Answer(values | {"largest pressure": smoothed.pressure(seat) / 1e6}, 1)


HUB_SHAFT = sg.Material(E="210 GPa", nu=0.3, density="7850 kg/m^3")
HUB = "dsoftcon.be, ShaftHubLock, PressShrinkFitDesHtml: rows 32, 33 and 35"
INTERFERENCE = {"least interference": "29", "largest interference": "78"}
PRESSED = {"largest pressure": "61"}
HUB_ON_SHAFT = Case(
    name="printed_shrink_fit",
    title="Hub shrunk onto a shaft, ShaftHubLock",
    problem="How far apart are the diameters of a fit, and how hard does the hub press?",
    geometry="Shaft of 80 mm, hub of 168 mm, H7/s6, smoothed by 10 um of roughness to 68 um.",
    material="Steel shaft with a strain factor of 3.33, 210 GPa; the hub's of 10.72 means 176 GPa at "
    "a Poisson's ratio of 0.3.",
    supports="None.",
    asked="Least and largest interference of the fit, and the largest pressure.",
    printed=True,
    references=printed(INTERFERENCE, "um", HUB) + printed(PRESSED, "N/mm^2", HUB),
    models=(
        Model(
            "thick rings",
            _hub,
            to_the_digits(INTERFERENCE) | {"largest pressure": 0.016},
            "ISO 286 to the digits; the printed interference of 68 um is rounded, 0.7 %",
        ),
    ),
    remarks="No printed rating of a press fit by DIN 743 could be read; its factors are held by hand "
    "in `tests/test_notches_norm.py`.",
)

CASES = (BOOK_SHOULDER, HUB_ON_SHAFT, SHOULDER, KEYWAY, V_GROOVE, CROSS_HOLE)
