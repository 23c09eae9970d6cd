"""What checks of a shaft or a train print as JSON."""

from __future__ import annotations

from typing import Any

from solidgear.core.judge.record import GuardRecord
from solidgear.show.printed import Printed

SENTENCES = {
    "facts": list[str],
    "cautions": list[str],
    "faults": list[str],
    "verdicts": dict[str, dict[str, Any]],
}
SHAFT = Printed(keys={**SENTENCES, "records": list[GuardRecord]})
#: of a train the checks of its shafts by their names
CHECK = (SHAFT, Printed(keys=SENTENCES, named=SHAFT))
