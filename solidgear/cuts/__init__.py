"""Cuts into a shaft: keyways, holes, flats, teeth."""

import solidgear.core.scene  # noqa: F401  # first, for a scene reads the features of this room
