"""Sorts of features and of parts, by the meshes that hold them."""

from __future__ import annotations

#: cut out at one place, or repeating themselves around the axis; and whole parts
CUTS, CYCLIC, PARTS = "cut", "cyclic", "part"
