"""The ladder: every model there is, cheapest first.  Whatever lists models goes through it.

To add one: a builder that gives a body whose geometry draws itself, and a subclass of ``Model`` with
name, title, family, options and ``builder``; a solid also has ``meshes`` coarse to fine, the safety
of its error bars and, where building it to count is dear, ``_size``.  A variant of a model is a
subclass with a ``preset``.  ``answer`` takes the first solid that models a scene, so that one which
does not refine itself stands behind one that does.  A further level of meshes is a line in the file
of its model; its safety in ``core/safety.py`` is measured anew by ``python -m
validation.campaign features``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from solidgear.core.ladder.beams import Euler, Timoshenko
from solidgear.core.ladder.harmonic import Harmonic
from solidgear.core.ladder.lumped import Lumped
from solidgear.core.ladder.model import Ladder
from solidgear.core.ladder.solid import Solid
from solidgear.core.registry import added

if TYPE_CHECKING:
    pass

_further = [model() for model in added("model").values()]
LADDER = Ladder(Lumped(), Euler(), Timoshenko(), Harmonic(), *_further, Solid())
