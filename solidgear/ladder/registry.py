"""The ladder: every model there is, cheapest first.  Whatever lists models goes through it."""

from __future__ import annotations

from solidgear.ladder.beams import Euler, Timoshenko
from solidgear.ladder.corrected import Corrected
from solidgear.ladder.harmonic import Harmonic
from solidgear.ladder.lumped import Lumped
from solidgear.ladder.model import Ladder
from solidgear.ladder.sector import Sector
from solidgear.ladder.solid import Solid

LADDER = Ladder(Lumped(), Euler(), Timoshenko(), Harmonic(), Corrected(), Sector(), Solid())
