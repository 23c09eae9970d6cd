"""Kinds of features and of parts, by the meshes that hold them."""

from __future__ import annotations

#: kinds of features that are cut out at one place, and those that repeat themselves around the axis
CUTS = frozenset({"keyway", "flat", "cross_hole"})
CYCLIC = frozenset({"teeth", "spline", "bolt_circle"})
#: kinds of files that hold a whole part
PARTS = frozenset({"step", "mesh"})
