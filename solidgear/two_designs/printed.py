"""What the comparison of two designs prints as JSON."""

from __future__ import annotations

from typing import Any, Literal

from solidgear.show.printed import Printed

#: two designs beside each other
TWO = Printed(
    keys={
        "kind": Literal["two shafts", "two trains"],
        "differences": list[Any],
        "sentences": list[str],
    },
    sometimes={
        "shafts": dict[str, Any],
        "trains": dict[str, Any],
        "models": dict[str, str],
        "mesh": str,
        "tolerance": float,
        "highest_hz": float,
        "numbers": dict[str, Any],
        "under_loads": dict[str, Any],
        "asked": dict[str, Any],
        "open": dict[str, Any],
        "paired": str,
        "modes": list[Any],
        "alone": dict[str, Any],
        "peaks": list[Any],
        "largest": dict[str, Any],
        "responses": dict[str, Any],
        "misalignment": dict[str, Any],
        "at_rest": dict[str, Any],
        "cautions": list[str],
        "unpublished": dict[str, Any],
        "unpublished_lines": list[str],
        "environment": dict[str, Any],
        "seconds_total": float,
        "files": list[str],
    },
)
