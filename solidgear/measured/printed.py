"""What measured resonances beside computed ones print as JSON."""

from __future__ import annotations

from typing import Any, Literal

from solidgear.measured.identify import Identification
from solidgear.show.printed import Printed

Number = float | None

PAIR = Printed(
    keys={
        "number": int,
        "measured_hz": float,
        "measured_deviation_hz": Number,
        "mode": str | None,
        "computed_hz": Number,
        "bar_hz": Number,
        "relative": Number,
        "probability": float,
        "mac": Number,
        "others": list[tuple[str, float]],
        "verdict": str,
    },
    sometimes={"damping": float, "damping_deviation": float},
)
MISSED = Printed(keys={"mode": str, "computed_hz": float, "probability": float})
CORRELATE = Printed(
    keys={
        "kind": Literal["correlation"],
        "scene": str,
        "measurement": str,
        "mesh": str,
        "rms": Number,
        "common": Any,
        "other_part": Any,
        "pairs": list[PAIR],  # type: ignore[valid-type]
        "mac": list[list[Number] | None] | None,
        "modes": list[str],
        "not_measured": list[MISSED],  # type: ignore[valid-type]
        "sentences": list[str],
        "cautions": list[str],
    }
)
IDENTIFY = Printed((Identification,))
