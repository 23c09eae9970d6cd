"""Cache of results that solvers have computed about a body: it dies with the body."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


class Cache:
    """Things by their type, one of each, some of them there from the beginning.

    Examples
    --------
    >>> cache = Cache()
    >>> cache.get(list, lambda: [1.0])
    [1.0]
    >>> cache.get(list, lambda: [2.0])  # made once
    [1.0]
    >>> cache.keep({"a": 1})
    >>> cache.find(dict), cache.find(set)
    ({'a': 1}, None)
    """

    def __init__(self, *things: object):
        self._things: dict[type, Any] = {type(thing): thing for thing in things}

    def get(self, kind: type[T], make: Callable[[], T]) -> T:
        """Return the thing of a type, made at the first call."""
        if kind not in self._things:
            self._things[kind] = make()
        return self._things[kind]

    def find(self, kind: type[T]) -> T | None:
        """Return the thing of a type, if there is one."""
        return self._things.get(kind)

    def keep(self, thing: object) -> None:
        """Keep a thing that was made with others; it takes the place of one of the same type."""
        self._things[type(thing)] = thing

    def clear(self) -> None:
        """Forget everything: factors are the largest things that a body holds."""
        self._things.clear()
