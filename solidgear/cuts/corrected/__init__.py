"""The harmonic solid corrected by a coarse 3D difference."""

import solidgear.core.ladder  # noqa: F401  # first, for the ladder holds the model of this room
