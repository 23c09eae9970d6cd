"""What nonlinear motion prints as JSON."""

from __future__ import annotations

from typing import Any

from solidgear.backlash.study import Sufficiency
from solidgear.show.printed import Printed

NONLINEAR = Printed(
    keys={
        "title": str,
        "teeth": dict[str, Any],
        "sentences": list[str],
        "mixes": list[dict[str, Any]],
        "beside_the_first": list[Sufficiency],
        "over_mean_force": Any,
        "in_time": Any,
        "runs": list[dict[str, Any]],
        "cautions": list[str],
    }
)
