"""The ladder: every model there is, cheapest first.  Whatever lists models goes through it."""

from __future__ import annotations

from solidgear.core.ladder.beams import Euler, Timoshenko
from solidgear.core.ladder.harmonic import Harmonic
from solidgear.core.ladder.lumped import Lumped
from solidgear.core.ladder.model import Ladder
from solidgear.core.ladder.solid import Solid
from solidgear.cuts.corrected.model import Corrected
from solidgear.cuts.sector.model import Sector

LADDER = Ladder(Lumped(), Euler(), Timoshenko(), Harmonic(), Corrected(), Sector(), Solid())
