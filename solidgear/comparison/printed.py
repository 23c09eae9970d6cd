"""What a race of models prints as JSON."""

from __future__ import annotations

from typing import Any

from solidgear.comparison.race.race import Reference
from solidgear.show.printed import Printed

CHART = Printed(
    keys={
        "scene": str,
        "complete": bool,
        "reference": Reference,
        "setup": Any,
        "seconds": float,
        "rows": list[dict[str, Any]],
        "cautions": list[str],
    }
)
