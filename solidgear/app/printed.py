"""What the commands of one shaft print as JSON."""

from __future__ import annotations

from typing import Any

from solidgear.core import OpenNumbers, Record, Settled
from solidgear.core.judge.answer import Answered
from solidgear.core.judge.record import WhereRecord
from solidgear.core.registry import added
from solidgear.core.solve.condensed import Condensed, Coupled
from solidgear.show.printed import Printed

Number = float | None

PLACES = Printed((WhereRecord,), without=("model", "points", "cells", "shares"))
ANSWER = Printed(
    (Answered,), {"open": OpenNumbers}, sometimes={"where": (PLACES, Printed(keys={"error": str}))}
)
MODE = Printed(
    keys={
        "name": str,
        "family": str,
        "frequency_hz": float,
        "multiplicity": int,
        "solver_error": Number,
        "bar": Number,
        "split": Any,
    }
)
#: of a model that was chosen or given, with what is beside its numbers
SOLVED = {
    "scene": str,
    "model": str,
    "unknowns": int,
    "evidence": dict[str, Any],
    "cautions": list[str],
    "open": OpenNumbers,
    "why_without_bar": str,
}
MODES = Printed(
    keys={**SOLVED, "modes": list[MODE], "without_bar": list[str]},  # type: ignore[valid-type]
    optional=(Settled,),
)
STIFFNESS = tuple(
    Printed((kind,), SOLVED, optional=(Settled,), sometimes={"bars": dict[str, Number]})
    for kind in (Condensed, Coupled)
)
COMPARE = (Record, *added("printed by compare").values())
