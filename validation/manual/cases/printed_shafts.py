"""Shafts under gears and belts, of books: reactions, moments, nominal stress, deflection."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import solidgear as sg
from validation.manual.case import Answer, Case, Model
from validation.manual.printed import (
    EQUATIONS,
    EXACT,
    INCH,
    POUND,
    POUND_INCH,
    SHIGLEY,
    STEEL,
    moments,
    printed,
    reactions,
    to_the_digits,
)

#: springs that hold like a simple support, N/m
FIRM = 1e12


def _rod(
    length: str,
    diameter: str,
    supports: Mapping[str, str],
    loads: list[dict[str, Any]],
    **rest: Any,
) -> sg.Scene:
    """Scene of a rod between simple supports, the first of which locates it."""
    bearings: list[dict[str, Any]] = [
        {
            "name": name,
            "position": place,
            "seat_width": "2 mm",
            "stiffness": {"kxx": FIRM, "kzz": FIRM},
        }
        for name, place in supports.items()
    ]
    bearings[0]["stiffness"]["kyy"] = FIRM
    segment = {"kind": "cylinder", "name": "rod", "length": length, "diameter": diameter}
    return sg.Scene.from_dict(
        {
            "material": {"E": "30e6 psi", "nu": 0.292, "density": "7800 kg/m^3"},
            "attachment": "section",
            "segment": [segment],
            "bearing": bearings,
            "load": loads,
            **rest,
        }
    )


# ----------------------------------------------------------------------- two pulleys
def _pulleys() -> Answer:
    belts = [
        {
            "name": "B", "position": "11 in", "seat_width": "1 in", "diameter": "4 in",
            "tight": "1000 lbf", "slack": "200 lbf", "towards": "-z", "sense": "driven",
        },
        {
            "name": "C", "position": "21 in", "seat_width": "1 in", "diameter": "8 in",
            "tight": "500 lbf", "slack": "100 lbf", "towards": "+x", "sense": "driving",
        },
    ]  # fmt: skip
    port = {"name": "middle", "position": "16 in", "span": ["15 in", "17 in"]}
    scene = _rod("32 in", "1.5 in", {"A": "1 in", "D": "31 in"}, belts, port=port, turns="+y")
    shaft = sg.stress(scene, "euler").shafts[0].found
    worst = max(
        (row.stress for row in shaft.nominal if row.names == "B"), key=lambda s: abs(s.torsion)
    )
    values = {
        "moment at B": moments(shaft.forces.at(11 * INCH))[2],
        "torque": abs(shaft.forces.at(16 * INCH)[4]) / POUND_INCH,
        "bending stress": worst.bending * INCH**2 / POUND,
        "shear stress": abs(worst.torsion) * INCH**2 / POUND,
    }
    return Answer(values, EQUATIONS)


MOMENTS = {"moment at B": "8246", "torque": "1600"}
STRESSES = {"bending stress": "24.89e3", "shear stress": "2414"}
EXAMPLE_3_9 = f"{SHIGLEY}, example 3-9, from memory; a chain by hand gives these digits"
TWO_PULLEYS = Case(
    name="printed_two_pulleys",
    title="Two pulleys across each other, Shigley 3-9",
    problem="A shaft between simple supports carries two pulleys, whose belts pull in planes at "
    "right angles.",
    geometry="Rod of 1.5 in; bearings at 0 and 30 in, pulleys B of 4 in at 10 in and C of 8 in at "
    "20 in.",
    material=STEEL,
    supports="Belts with 1000 and 200 lbf at B, and with 500 and 100 lbf at C.",
    asked="Largest bending moment, torque between the pulleys and nominal stress there.",
    printed=True,
    references=printed(MOMENTS, "lbf in", EXAMPLE_3_9) + printed(STRESSES, "psi", EXAMPLE_3_9),
    models=(Model("section forces", _pulleys, to_the_digits(MOMENTS | STRESSES), EXACT),),
)


# ----------------------------------------------------------------------- helical gears
def _helical_pinion() -> Answer:
    pinion = {
        "name": "pinion", "position": "14 in", "seat_width": "0.5 in",
        "pitch_diameter": f"{18 / (12 * math.cos(math.radians(30)))} in",
        "torque": "35 lbf*in", "pressure_angle": "20 deg", "helix_angle": "30 deg",
        "hand": "right", "towards": "+z",
    }  # fmt: skip
    port = {"name": "coupling", "position": "0.3 in", "span": ["0.2 in", "0.4 in"]}
    supports = {"A": "1 in", "B": "11 in"}
    scene = _rod("15 in", "1 in", supports, [pinion], port=port, torque_at="coupling")
    # the book's x, y and z are here y, z and x
    values = reactions(scene, "zxy", POUND)
    forces = sg.ShaftLoad.model_validate(pinion).six()[:3] / POUND
    values |= {f"pinion {axis}": float(force) for axis, force in zip("zxy", forces)}
    return Answer({name: value for name, value in values.items() if name in PINION}, EQUATIONS)


PINION = {
    "pinion x": "-23.3",
    "pinion y": "-17.0",
    "pinion z": "40.4",
    "F_A x": "23.3",
    "F_A y": "-3.1",
    "F_A z": "12.1",
    "F_B y": "20.1",
    "F_B z": "-52.5",
}
HELICAL_PINION = Case(
    name="printed_helical_pinion",
    title="Helical pinion beside its bearings, Shigley 13-9",
    problem="A motor drives a helical pinion that overhangs its bearings.",
    geometry="Bearings at 0 and 10 in, pinion of 18 teeth and normal diametral pitch 12 at 13 in; "
    "normal pressure angle 20 degrees, helix angle 30 degrees, right hand.",
    material=STEEL,
    supports="1 hp at 1800 rev/min: 35 lbf in. A takes the thrust.",
    asked="Forces on the pinion and bearing reactions, in the book's axes.",
    printed=True,
    references=printed(PINION, "lbf", f"{SHIGLEY}, example 13-9"),
    models=(
        Model(
            "statics of a beam",
            _helical_pinion,
            to_the_digits(PINION, 1.0),
            "the book rounds forces to 0.1 lbf before it takes moments: one unit of the last digit",
        ),
    ),
)


def _intermediate_shaft() -> Answer:
    gears = [
        {
            "name": "wheel", "position": "415 mm", "seat_width": "60 mm",
            "tangential_force": "-6021 N", "pitch_diameter": "454.94 mm",
            "helix_angle": "20 deg", "hand": "right", "towards": "+z",
        },
        {
            "name": "pinion", "position": "205 mm", "seat_width": "90 mm",
            "tangential_force": "26727 N", "pitch_diameter": "101.46 mm",
            "helix_angle": "15 deg", "hand": "right", "towards": "+z",
        },
    ]  # fmt: skip
    supports = {"A": "320 mm", "B": "30 mm"}
    port = {"name": "middle", "position": "260 mm", "span": ["255 mm", "265 mm"]}
    scene = _rod("450 mm", "80 mm", supports, gears, port=port, torque_at="middle")
    values = reactions(scene, "xzy", 1.0)  # along the shaft is the report's z, and z its -y
    values = {name: -value if name.endswith("y") else value for name, value in values.items()}
    return Answer({name: value for name, value in values.items() if name in BETWEEN}, EQUATIONS)


BETWEEN = {
    "F_A x": "-8134.966",
    "F_A y": "-9638.978",
    "F_A z": "4971",
    "F_B x": "-12571.034",
    "F_B y": "-2764.022",
}
INTERMEDIATE = Case(
    name="printed_intermediate_shaft",
    title="Intermediate shaft with two helical gears, Schulz and Huss",
    problem="An intermediate shaft carries a helical wheel that overhangs its bearings and a helical "
    "pinion between them.",
    geometry="Bearings at 0 (A, which locates) and -290 mm (B), wheel of 454.94 mm at 95 mm, pinion "
    "of 101.46 mm at -115 mm; helix angles 20 and 15 degrees, normal pressure angle 20 degrees.",
    material=STEEL,
    supports="Tangential forces of 6021 and 26727 N, which differ by 1 % in torque; the rest leaves "
    "at the middle.",
    asked="Bearing reactions, in the report's axes.",
    printed=True,
    references=printed(
        BETWEEN,
        "N",
        "Schulz and Huss, Belegarbeit Maschinenelemente 2 (2023), "
        "github.com/sydgtfzguhgfhtr/ME_Wellennachweis, Lager_und_Wellen.ipynb, Zwischenwelle",
    ),
    models=(
        Model(
            "statics of a beam",
            _intermediate_shaft,
            to_the_digits({"F_A x": "-8134.966", "F_B x": "-12571.034"}, 1.0)
            | dict.fromkeys(("F_A y", "F_A z", "F_B y"), 3e-4),
            "exact statics of tangential forces; in y and z the report rounds radial and axial forces "
            "of the teeth to a newton",
        ),
    ),
    remarks="Its safeties are not compared: its shear stress divides by the fourth power of the "
    "diameter (welle.py, `Spannungen`).",
)


# ----------------------------------------------------------------------- two belts
def _belts() -> Answer:
    belts = [
        {
            "name": "B", "position": "9 in", "seat_width": "1 in", "diameter": "8 in",
            "tight": "300 lbf", "slack": "50 lbf", "towards": "-z", "sense": "driven",
        },
        {
            "name": "C", "position": "17 in", "seat_width": "1 in", "diameter": "6 in",
            "tight": "360 lbf", "slack": "27 lbf", "towards": "+x", "sense": "driving",
        },
    ]  # fmt: skip
    port = {"name": "middle", "position": "13 in", "span": ["12 in", "14 in"]}
    supports = {"A": "1 in", "D": "23 in"}
    scene = _rod("24 in", "1 in", supports, belts, port=port, turns="-y")
    values = reactions(scene, "zxy", POUND)
    return Answer({name: abs(value) for name, value in values.items() if name in BELTS}, EQUATIONS)


BELTS = {"F_A y": "223", "F_D y": "127"}
TWO_BELTS = Case(
    name="printed_two_belts",
    title="Two belts across each other, Shigley, problem 5-23",
    problem="A shaft carries two pulleys with belts in planes at right angles.",
    geometry="Bearings at 0 and 22 in, pulleys of 8 in at 8 in and of 6 in at 16 in.",
    material=STEEL,
    supports="300 and 50 lbf down, 360 and 27 lbf aside.",
    asked="Bearing reactions in the plane of the first belt.",
    printed=True,
    references=printed(
        BELTS,
        "lbf",
        "Shigley's Mechanical Engineering Design, 8th edition, problem 5-23, instructor's solution",
    ),
    models=(Model("statics of a beam", _belts, to_the_digits(BELTS), EXACT),),
    remarks="The torques are 1000 and 999 lbf in, which the book and the tolerance of typed numbers "
    "take as equal.",
)

CASES = (
    TWO_PULLEYS,
    HELICAL_PINION,
    INTERMEDIATE,
    TWO_BELTS,
)
