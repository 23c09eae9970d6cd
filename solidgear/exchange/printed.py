"""What export and import print as JSON."""

from __future__ import annotations

from solidgear.show.printed import Printed

EXPORT = (
    Printed(
        keys={
            "source": str,
            "notes": list[str],
            "cautions": list[str],
            "coordinates": list[str],
            "positions": dict[str, tuple[float, float, float]],
            "units": str,
            "mass": float | None,
            "free": bool,
            "files": list[str],
        }
    ),
    # a file of REXS
    Printed(
        keys={
            "files": list[str],
            "version": str,
            "components": dict[str, int],
            "without_place": dict[str, list[str]],
        }
    ),
    # a rotor of another program is its own account
    Printed(keys={"files": list[str]}),
)
IMPORT = Printed(
    keys={
        "files": list[str],  # the train first where there is one
        "train": bool,
        "facts": list[str],
        "notes": dict[str, list[str]],  # by what they are: contradictory, assumed, left out
    }
)
