"""What the commands of trains print as JSON."""

from __future__ import annotations

from typing import Any, Literal

from solidgear.show.printed import Printed
from solidgear.trains.judge.judge import Departure
from solidgear.trains.modes.modes import TrainModes
from solidgear.trains.response.loudest import Loudest

Number = float | None

#: models stand by the names of shafts
SYSTEM_MODES = Printed((TrainModes,), {"cautions": list[str]}, without=("models",), named=str)
LOUDEST = Printed((Loudest,), {"sentences": list[str]})
VERDICT = Printed(
    keys={
        "train": str,
        "highest_hz": float,
        "tolerance": float,
        "decibels": float,
        "judge": str,
        "judge_title": str,
        "judge_bar": Number,
        "cheapest": dict[str, str],
        "mixes": list[Printed((Departure,), without=("models",), named=str)],  # type: ignore[misc]
        "unpublished": dict[str, str],
        "cautions": list[str],
        "sentences": list[str],
    }
)
COMPARISON = Printed(
    keys={
        "kind": Literal["train"],
        "train": dict[str, Any],
        "verdict": VERDICT,
        "loudest": LOUDEST,
        "modes": Printed((SYSTEM_MODES,), {"notes": list[str]}, named=str),
        "peaks": list[Any],
        "crossings": list[Any],
        "environment": dict[str, Any],
        "seconds_total": float,
    },
    sometimes={
        "tooth_stiffness": list[Any],
        "pictures": dict[str, str],
        "left_out": list[str],
        "files": list[str],
    },
)
RESPONSE = Printed(
    keys={
        "title": str,
        "responses": list[  # type: ignore[misc]
            Printed(keys={"peaks": list[Any], "bars": dict[str, Number]}, named=str)
        ],
        "damping": str,
        "unpublished": dict[str, str],
        "cautions": list[str],
        "loudest": LOUDEST,
    },
    sometimes={"at_speed": dict[str, Any]},
)
RECEPTANCE = Printed(
    keys={
        "title": str,
        "unit": str,
        "models": list[Any],
        "from": str,
        "to": str,
        "unpublished": dict[str, str],
        "cautions": list[str],
    }
)
