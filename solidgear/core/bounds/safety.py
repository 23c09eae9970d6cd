"""The few constants that decide an error bar and are measured, not derived.

They stand in ``safety.json`` with the date and the shafts that they were measured on. That of local
problems is judged by ``python -m validation.campaign answers``. Nothing else that is measured
widens or narrows an error bar.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from importlib.resources import files

_MEASURED = json.loads((files("solidgear.core.bounds") / "safety.json").read_text("utf-8"))

#: on bounds by local problems: errors that the richer space does not see
LOCAL: float = _MEASURED["local problems"]["safety"]

#: energies of errors over what one order more tells of them, by elements where this is not one
SLOWER: dict[str, float] = _MEASURED["one order more"]["slower"]
#: distance from a narrow seat that cells of first order see, over their depth
REACH: float = _MEASURED["narrow seats"]["reach"]
#: factor by which cells of first order are too stiff in a gap between rigid seats as wide as they are
#: deep, less one
GAP: float = _MEASURED["narrow seats"]["gap"]


@dataclass(frozen=True)
class Safety:
    """Measured constants of a solid whose error bars rest on two meshes."""

    #: error bar over the change by the last mesh, after two meshes and after more
    steps: tuple[float, float]
    #: share, share_of_free_modes: least error bar over the change that features make to a number,
    #: and to a mode that no bearing holds, for two meshes may agree by accident. Zero where the
    #: meshes hold the whole part.
    share: float = 0.0
    share_of_free_modes: float = 0.0
    shrinks: float = 1.0  #: share of that which each finer mesh leaves

    def least_share(self, free: bool, meshes: int) -> float:
        """Return the least error bar after some meshes, over the change that features make.

        Examples
        --------
        >>> safety = Safety((2.0, 1.5), share=0.2, share_of_free_modes=0.8, shrinks=0.5)
        >>> [safety.least_share(False, meshes) for meshes in (2, 3)]
        [0.2, 0.1]
        """
        share = self.share_of_free_modes if free else self.share
        return share * self.shrinks ** max(0, meshes - 2)


def _steps(name: str) -> tuple[float, float]:
    two, more = _MEASURED[name]["steps"]
    return float(two), float(more)


#: of meshes with layers towards corners, of plain refinement, and of features
LAYERS, REFINEMENT = Safety(_steps("layers")), Safety(_steps("refinement"))
FEATURES = Safety(
    _steps("features"),
    _MEASURED["features"]["share"],
    _MEASURED["features"]["share of free modes"],
    _MEASURED["features"]["shrinks"],
)
