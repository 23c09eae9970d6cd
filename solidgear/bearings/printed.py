"""What catalogue bearings print as JSON."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.bearings.duty import DutyLife
from solidgear.bearings.equivalent import Equivalent
from solidgear.show.printed import Printed

Number = float | None

LIFE = Printed(
    keys={
        "speed": Number,
        "basic": Number,
        "reference": Number,
        "modified": Any,
        "no_modified_life": str,
        "range": dict[str, tuple[Number, Number]],
        "not_known": str,
        "equivalent_load": Equivalent | None,
        "reference_load": Number,
        "static_load": float,
        "static_safety": Number,
        "ratings": {"C": float, "C0": float, "Cu": Number, "sources": Any},
        "notes": list[str],
    }
)
ROW = Printed(
    keys={
        "azimuth": np.ndarray,
        "load": np.ndarray,
        "contact_angle": np.ndarray,
        "pressure_inner": np.ndarray,
        "pressure_outer": np.ndarray,
    }
)
FACTS = Printed(
    keys={
        "name": str,
        "kind": str,
        "designation": str,
        "status": str,
        "support": str | None,
        "inside": dict[str, Number],
        "estimated": list[str],
        "clearance": Number,
        "load": np.ndarray,
        "displacement": np.ndarray,
        "stiffness": np.ndarray,
        "spread": Any,
        "no_spread": str,
        "rows": list[ROW],  # type: ignore[valid-type]
        "notes": list[str],
        "life": LIFE,
    }
)
OVER_POINTS = Printed(
    keys={
        "name": str,
        "points": list[Printed((LIFE,), {"at": str})],  # type: ignore[misc]
        "duty": (Printed((DutyLife,), {"of": str}), type(None)),
    }
)
BEARING = (
    Printed(
        keys={"scene": str, "bearings": list[FACTS]},  # type: ignore[valid-type]
        sometimes={"case": str, "cases": list[OVER_POINTS]},  # type: ignore[valid-type]
    ),
    Printed(
        keys={"train": str, "bearings": list[OVER_POINTS], "cautions": list[str]}  # type: ignore[valid-type]
    ),
)
