"""What variants of a file print as JSON."""

from __future__ import annotations

from typing import Any, Literal

from solidgear.core import Settled
from solidgear.show.printed import Printed
from solidgear.variants.budget.budget import Budget
from solidgear.variants.sensitivity.run import Sensitivities
from solidgear.variants.sweep.bearing_task import SweptBearings
from solidgear.variants.sweep.file_task import Swept

Number = float | None

SENSITIVITIES = Printed((Sensitivities,))
BUDGET = Printed((Budget,))
SWEEP = (
    Printed((SweptBearings,), {"cautions": list[str]}, optional=(Settled,)),
    Printed(
        (Swept,),
        {"cautions": list[str]},
        sometimes={"bodies": int, "cut": Any, "title": str},
    ),
)
#: values of the entries that vary and follow stand by their paths, a second goal by its name
DESIGN = Printed(
    keys={"number": int, "value": Number, "bar": Number, "kept": Any, "status": str},
    named=Number | str,
)
OPTIMISE = Printed(
    keys={
        "kind": Literal["optimum"],
        "scene": str,
        "goals": list[str],
        "keep": list[str],
        "best": int | None,
        "front": list[int],
        "at_end": list[str],
        "search": list[str],
        "followed": list[str],
        "about_bars": str,
        "gain": Any,
        "cautions": list[str],
        "designs": list[DESIGN],  # type: ignore[valid-type]
        "sentences": list[str],
    }
)
