"""The few constants that decide an error bar and are measured, not derived.

They stand in ``safety.json`` with the date and the shafts that they were measured on. That of local
problems is judged by ``python -m validation.campaign answers``. Nothing else that is measured
widens or narrows an error bar.
"""

from __future__ import annotations

import json
from importlib.resources import files

_MEASURED = json.loads((files("solidgear.core.bounds") / "safety.json").read_text("utf-8"))

#: on bounds by local problems: errors that the richer space does not see
LOCAL: float = _MEASURED["local problems"]["safety"]

#: energies of errors over what one order more tells of them, by elements where this is not one
SLOWER: dict[str, float] = _MEASURED["one order more"]["slower"]
#: share of an energy that may be missing where conjugate gradients end; what is missing is added
MISSING: float = _MEASURED["one order more"]["missing"]
#: of the lower side: volume and seats of a mesh are not quite those of the body
LEAST: float = _MEASURED["one order more"]["least"]
#: Poisson's ratio from which on a layer that is held on both sides locks where it is one cell thick
LOCKING: float = _MEASURED["held layers"]["ratio"]
#: what cells as wide as such a layer is thick add at its rim to the energy of an error over that in
#: one order more, at a Poisson's ratio of 1/2
RIM: float = _MEASURED["held layers"]["rim"]
#: distance from a narrow seat that cells of first order see, over their depth
REACH: float = _MEASURED["narrow seats"]["reach"]
#: factor by which cells of first order are too stiff in a gap between rigid seats as wide as they are
#: deep, less one
GAP: float = _MEASURED["narrow seats"]["gap"]
