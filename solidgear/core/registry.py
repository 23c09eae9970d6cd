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
    addition.cache_clear()


def added(kind: str) -> dict[str, Any]:
    """Return all additions of a kind, by name, in the order of registration."""
    return {
        name: thing for name in _PLACES.get(kind, ()) if (thing := addition(kind, name)) is not None
    }


def registered(kind: str) -> tuple[str, ...]:
    """Return the names of all additions of a kind, without importing them."""
    return tuple(_PLACES.get(kind, ()))


@cache
def addition(kind: str, name: str) -> Any:
    """Return one addition; None where nobody registered it or its room is not installed."""
    place = _PLACES.get(kind, {}).get(name)
    if place is None:
        return None
    module, _, attribute = place.partition(":")
    try:
        return getattr(import_module(module), attribute)
    except ModuleNotFoundError as error:
        if _is_room(error.name or ""):
            return None
        raise  # a wrong place, or a library that is missing


def _is_room(module: str) -> bool:
    """Return True for a package right below solidgear: that of the addition or one it builds on."""
    return module.startswith("solidgear.") and module.count(".") == 1
