"""A data sheet with every section, without any solution."""

from datetime import date

from solidgear.core import Scene
from solidgear.datasheet.facts import (
    Amount,
    BearingFact,
    DrawnShaft,
    Figure,
    Force,
    Frequency,
    LesserSafety,
    MotionFact,
    Remark,
    Resonance,
    Speed,
    Trust,
    UnratedCorner,
    WorstNotch,
    WorstSection,
)
from solidgear.datasheet.result import Datasheet

NAMES = {"names": ("L1", "L2")}
TABLES = {
    "title": "Welle 7",
    "material": "42CrMo4",
    "turns": "+y",
    "segment": [
        {"kind": "cylinder", "name": "a", "length": "40 mm", "diameter": "30 mm"},
        {"kind": "cylinder", "name": "b", "length": "5 mm", "diameter": "42 mm"},
        {"kind": "cylinder", "name": "c", "length": "60 mm", "diameter": "36 mm", "bore": "9 mm"},
    ],
    "bearing": [
        {
            "name": "L1",
            "position": "15 mm",
            "seat_width": "16 mm",
            "catalogue": {"designation": "6206", "load": {"z": "1 kN"}},
        },
        {"name": "L2", "position": "95 mm", "seat_width": "10 mm", "stiffness": {"kzz": 1e8}},
    ],
    "port": {"name": "Ritzel", "at": "c.middle", "span": ["50 mm", "80 mm"]},
}


def made_up_shaft(sense="+y"):
    """A shaft with a load at its gear and two reactions."""
    forces = (
        Force("L1", 0.015, (-400.0, 0.0, 300.0, 0.0, 0.0, 0.0), True),
        Force("Ritzel", 0.075, (1200.0, -350.0, -900.0, 8.0, 25.0, 0.0), False),
        Force("L2", 0.095, (-800.0, 350.0, 600.0, 0.0, 0.0, 0.0), True),
    )
    data = Scene.from_dict(TABLES).as_dict()
    return DrawnShaft("Welle", data, forces, sense, speed=150.0)


def made_up_sheet(**changes):
    """A sheet with every section, in English."""
    notch = {"shaft": "Welle", "place": "R2", "y": 0.04, "amplitude": 81e6, "bar": 1.2e6}
    safeties = {"fatigue": 0.93, "yielding": 1.15, "assumed": ("K_F",)}
    values = {
        "title": "Welle 7",
        "file": "welle7",
        "train": False,
        "trust": Trust("harmonic", 0.05, True, 0.012, 0.0014, "timoshenko", 0.031, "within motion"),
        "drawn": (made_up_shaft(),),
        "figures": (
            Figure("C_zz", 5.45e-9, "m/N", 0.0043, (-0.27, 3.97)),
            Figure("C_z,thx@Rad", -1.31e-8, "rad/N", 0.0037),
            Figure("bending 1", 1576.25, "Hz", 0.0014, (-0.55, 0.15)),
        ),
        "notch": WorstNotch(
            **notch,
            **safeties,
            least=(0.81, 1.02),
            open=(79e6, 83.5e6),
            elsewhere=(
                LesserSafety("yielding", "Welle", "R1", 0.012, 1.12),
                LesserSafety("crack", "Welle", "R3", 0.0455, 0.98),
            ),
        ),
        "corners": (UnratedCorner("Welle", 0.045), UnratedCorner("Welle", 0.0505)),
        "section": WorstSection("Welle", "a", 0.04, 61.5e6, 60e6, 8.25e6, 0.0),
        "bearings": (
            BearingFact("L1", "6206", 500.0, 0.0, "modified", 2.5e9, (1.5e9, 4e9), 29071.5, 8.84),
            BearingFact("L2", "", 1000.5, 350.25),
        ),
        "motions": (
            MotionFact("Ritzel", 24.4e-6, 4.3e-9, 75e-6, 7.7e-8, (18.9e-6, 29.9e-6), None, 49e-6),
        ),
        "frequencies": (
            Frequency("bending 1", 1576.25, 0.0014, (-0.55, 0.15)),
            Frequency("torsion 1", 7834.5, 0.0022),
        ),
        "resonances": (
            Resonance(2, "", False, "bending 1", 160.5, 150.25, 170.75, -0.065),
            Resonance(3, "mesh Stufe", True, "Rad axial 1", 165.0, 164.5, 165.5, -0.09),
        ),
        "turns": "Welle",
        "speed": 150.0,
        "operation": Remark(
            "under named point at speed",
            {"name": "Voll", "torque": Amount(115.5, "N m", None), "shaft": "Welle"}
            | {"speed": Speed(150.0)},
        ),
        "assumed": tuple(
            Remark(f"assumed {key}", NAMES)
            for key in ("inside", "clearance", "stiffness", "ranges", "angle", "factors")
        ),
        "cautions": (
            Remark("caution static", {"name": "L1", "safety": "0.87"}),
            Remark("caution fatigue", {"place": "R2", "safety": "0.93", "least": "1.2"}),
        ),
        "elsewhere": 2,
        "day": date(2026, 11, 27),
    }
    return Datasheet(**values | changes)
