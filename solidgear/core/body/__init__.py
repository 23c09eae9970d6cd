"""The one currency of the house: free elastic parts with ports, and their supports."""

from solidgear.core.body.model import FURTHER, SINE, Block, Body, Port, Reflection, component_rows
from solidgear.core.body.supports import Supports, as_supports

__all__ = [
    "Block",
    "Body",
    "FURTHER",
    "Port",
    "Reflection",
    "SINE",
    "Supports",
    "as_supports",
    "component_rows",
]
