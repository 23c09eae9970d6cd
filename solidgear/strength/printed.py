"""What deflection and stress at rest print as JSON."""

from __future__ import annotations

from typing import Any

from solidgear.core.scene.acting import ActingLoad
from solidgear.show.printed import Printed
from solidgear.strength.deflection.at_rest import Measured, Standing
from solidgear.strength.deflection.shaft import ShaftDeflection
from solidgear.strength.statics import Statics
from solidgear.strength.stress.at_rest import StressAtRest, StressedShaft
from solidgear.trains.assembly.turn import StageTurn

SIX = dict[str, dict[str, Measured]]
SOLUTION = Printed(
    keys={
        "point": Any,
        "mesh_force": float,
        "mesh_forces": dict[str, float],
        "misalignment": dict[str, Measured],
        "displacement": SIX,
        "shafts": dict[str, ShaftDeflection],
        "turns": dict[str, StageTurn],
        "face_load_norm": dict[str, Any],
        "notes": list[str],
        "seconds": float,
    },
    sometimes={"mounts": SIX},
    named=str,
)
#: of a shaft under the load of its scene
SHAFT = Printed(
    (ShaftDeflection,),
    {
        "displacement": SIX,
        "notes": list[str],
        "seconds": float,
        "case": str,
        "statics": Statics,
    },
)
COMMON = {
    "tolerance": float,
    "verdict": str,
    "standings": list[Standing],
    "cautions": list[str],
    "senses": dict[str, str],
}
DEFLECT = (
    Printed(
        keys={
            "train": str,
            "models": dict[str, SOLUTION],  # type: ignore[valid-type]
            "points": list[SOLUTION],  # type: ignore[valid-type]
            **COMMON,
        }
    ),
    Printed(
        keys={
            "scene": str,
            "port": str,
            "case": str,
            "load": list[float],
            "loads": list[ActingLoad],
            "assumed": list[str],
            "why_without_bar": str,
            "models": dict[str, SHAFT],  # type: ignore[valid-type]
            "points": list[SHAFT],  # type: ignore[valid-type]
            **COMMON,
        }
    ),
)
STRESS = Printed(
    (StressAtRest,),
    {
        "asked": dict[str, Any],
        "shafts": dict[str, Printed((StressedShaft,), {"worst": str | None})],  # type: ignore[misc]
        "components": list[str],
        "why_without_bar": str,
    },
)
