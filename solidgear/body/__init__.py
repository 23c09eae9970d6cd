"""The one currency of the house: free elastic parts with ports, and what holds them."""

from solidgear.body.model import (
    DOF_NAMES,
    FURTHER,
    Block,
    Body,
    Port,
    Supports,
    as_supports,
    component_rows,
)

__all__ = [
    "Block",
    "Body",
    "DOF_NAMES",
    "FURTHER",
    "Port",
    "Supports",
    "as_supports",
    "component_rows",
]
