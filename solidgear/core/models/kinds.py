"""Sorts of features and of parts, by the meshes that hold them."""

from __future__ import annotations

#: cut out at one place, or repeating themselves around the axis; whole parts;
#: and blocks and other bodies, which have no axis
CUTS, CYCLIC, PARTS, BODIES = "cut", "cyclic", "part", "body"
