"""Parts from STEP and mesh files."""

import solidgear.core.scene  # noqa: F401  # first, for a scene reads the tables of this room
