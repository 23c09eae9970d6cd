"""Rolling bearings from catalogue data: load, stiffness at load, equilibrium with a shaft."""

import solidgear.core.scene  # noqa: F401  # first, for a scene reads the tables of this room
