"""Additions to the core that rooms of features register, imported when first asked for.

The core names none of its features.  It asks for the additions of a kind, such as ``feature``
or ``solid body``, and :mod:`solidgear.rooms` says where each addition stands.  A room that is not
there adds nothing; what cannot do without it is refused in a sentence that names the room.
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
        if missing_room(error):
            return None
        raise  # a wrong place, or a library that is missing


def needed(kind: str, name: str, what: str) -> Any:
    """Return an addition that `what` cannot do without; refuse where its room is not there."""
    found = addition(kind, name)
    if found is None:
        # start-up: a process that draws does without
        from solidgear.core.errors import SolidgearError

        raise SolidgearError(f"{what} {absent(kind, name)}")
    return found


def absent(kind: str, name: str) -> str:
    """Return what is wrong with an addition whose room is not there; nothing for one that is."""
    if name not in _PLACES.get(kind, {}) or addition(kind, name) is not None:
        return ""
    return without(_PLACES[kind][name].split(".")[1])


def without(room: str) -> str:
    """Return the words on what cannot do without a room."""
    return f"needs the room {room!r} of solidgear, which is not installed"


def missing_room(error: ModuleNotFoundError) -> str:
    """Return the room that is not there, a folder right below solidgear; nothing for another module."""
    package, _, room = (error.name or "").partition(".")
    return room if package == "solidgear" and room and "." not in room else ""
