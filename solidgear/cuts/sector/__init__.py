"""Parts of equal sectors by cyclic symmetry."""

import solidgear.core.ladder  # noqa: F401  # first, for the ladder holds the model of this room
