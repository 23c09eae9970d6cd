"""The ladder: every model there is, cheapest first.  Whatever lists models goes through it."""

from __future__ import annotations

from solidgear.core.ladder.beams import Euler, Timoshenko
from solidgear.core.ladder.harmonic import Harmonic
from solidgear.core.ladder.lumped import Lumped
from solidgear.core.ladder.model import Ladder
from solidgear.core.ladder.solid import Solid
from solidgear.core.registry import added

_further = [model() for model in added("model").values()]
LADDER = Ladder(Lumped(), Euler(), Timoshenko(), Harmonic(), *_further, Solid())
