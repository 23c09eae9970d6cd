"""What solvers have worked out about a body and keep with it, so that it dies with the body."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


class Kept:
    """Things by their type, one of each.

    Parameters
    ----------
    *things : object
        What is known from the beginning.

    Examples
    --------
    >>> kept = Kept()
    >>> kept.get(list, lambda: [1.0])
    [1.0]
    >>> kept.get(list, lambda: [2.0])  # made once
    [1.0]
    """

    def __init__(self, *things: object):
        self._things: dict[type, Any] = {type(thing): thing for thing in things}

    def get(self, kind: type[T], make: Callable[[], T]) -> T:
        """The thing of a type, made when first asked for."""
        if kind not in self._things:
            self._things[kind] = make()
        return self._things[kind]

    def clear(self) -> None:
        """Forget everything: factors are the largest things that a body holds."""
        self._things.clear()
