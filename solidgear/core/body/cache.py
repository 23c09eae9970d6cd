"""Cache of results that solvers have computed about a body: it dies with the body, which no thing
in it may hold (:meth:`solidgear.core.body.Body.without_results`): garbage in circles is not freed
before a collector comes by, and that counts objects, of which a body of 100 MB has few.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, Generic, TypeVar

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


class LastTwo(Generic[T]):
    """Things of a body on the last two sets of springs.

    Examples
    --------
    >>> on_springs = LastTwo[str]()
    >>> [on_springs.on(key, lambda: key.upper()) for key in "abac"]
    ['A', 'B', 'A', 'C']
    >>> on_springs.on("c", lambda: "made again"), on_springs.on("a", lambda: "made again")
    ('C', 'made again')
    >>> on_springs.latest
    'made again'
    """

    def __init__(self) -> None:
        self._things: dict[Hashable, T] = {}

    @property
    def latest(self) -> T | None:
        """The thing that was made last; None before there is one."""
        return next(reversed(self._things.values()), None)

    def on(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return the thing on some springs, made where these are new, in the place of the oldest."""
        if key not in self._things:
            while len(self._things) >= 2:
                del self._things[next(iter(self._things))]
            self._things[key] = make()
        return self._things[key]
