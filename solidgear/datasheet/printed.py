"""What a data sheet prints as JSON."""

from __future__ import annotations

from solidgear.datasheet.result import Datasheet
from solidgear.show.printed import Printed

SHEET = Printed((Datasheet,), {"day": str})
