"""Additions to the core that rooms of features register, imported when first asked for.

The core names none of its features.  It asks for the additions of a kind, such as ``feature``
or ``solid body``, and :mod:`solidgear.rooms` says where each addition stands.  A room that is not
installed adds nothing.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import Any

_PLACES: dict[str, dict[str, str]] = {}


def register(kind: str, name: str, place: str) -> None:
    """Add an object, ``module:attribute``, under a kind and a name."""
    _PLACES.setdefault(kind, {})[name] = place
    added.cache_clear()
    addition.cache_clear()


@cache
def added(kind: str) -> dict[str, Any]:
    """Return all additions of a kind, by name, in the order of registration."""
    return {
        name: thing for name in _PLACES.get(kind, ()) if (thing := addition(kind, name)) is not None
    }


@cache
def addition(kind: str, name: str) -> Any:
    """Return one addition; None where nobody registered it or its room is not installed."""
    place = _PLACES.get(kind, {}).get(name)
    if place is None:
        return None
    module, _, attribute = place.partition(":")
    room = ".".join(module.split(".")[:2])
    try:
        return getattr(import_module(module), attribute)
    except ModuleNotFoundError as error:
        if error.name and (error.name == room or error.name.startswith(room + ".")):
            return None
        raise
