"""What teeth in contact print as JSON."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.show.printed import Printed
from solidgear.trains.file.operation import OperatingPoint

Number = float | None

ERROR = Printed(
    keys={
        "phase": np.ndarray,
        "loaded": np.ndarray,
        "unloaded": np.ndarray,
        "peak_to_peak": float,
        "orders": np.ndarray,
        "angles": np.ndarray,
    }
)
STIFFNESS = Printed(
    keys={
        "secant": np.ndarray,
        "tangent": np.ndarray,
        "secant_with_supports": np.ndarray,
        "tangent_with_supports": np.ndarray,
        "aligned_tangent": Any,
    },
    sometimes={"norm_single": Number, "norm_mesh": Number},
)
MESH = Printed(
    keys={
        "mesh": str,
        "status": str,
        "torque": float,
        "force": float,
        "transmission_error": ERROR,
        "stiffness": STIFFNESS,
        "face_load_factor": float,
        "line_load_factor": float,
        "face_load": np.ndarray,
        "pressure": Any,
        "load_share": np.ndarray,
        "mean_lines": Number,
        "corner_share": float,
        "mesh_point": np.ndarray,
        "line_of_action": np.ndarray,
        "assumed": list[str],
        "contact_ratio": float,
    },
    # of cylindrical teeth, then of bevel teeth
    sometimes={
        "overlap_ratio": float,
        "skew": dict[str, Number],
        "ease_off": Any,
        "cutter_radius": Any,
        "band": list[Any],
    },
)
AT_TORQUE = Printed(
    keys={
        "torque": float,
        "peak_to_peak": float,
        "orders": np.ndarray,
        "tangent": float,
        "secant": float,
        "face_load_factor": float,
        "pressure": Any,
    }
)
LADDER = Printed(
    keys={
        "mesh": str,
        "tolerance": float,
        "bars": dict[str, float],
        "energy_share": Any,
        "models": dict[str, dict[str, Any]],
    }
)
CONTACT = Printed(
    keys={
        "train": str,
        "point": OperatingPoint,
        "model": str,
        "meshes": dict[str, MESH],  # type: ignore[valid-type]
        "curves": dict[str, list[AT_TORQUE]],  # type: ignore[valid-type]
        "bars": dict[str, dict[str, float]],
        "file_stiffness": dict[str, Number],
        "models": dict[str, LADDER],  # type: ignore[valid-type]
        "cautions": list[str],
        "seconds": float,
    }
)
