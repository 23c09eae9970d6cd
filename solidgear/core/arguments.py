"""The door of the package: functions for users refuse an argument of a wrong type in one sentence,
before anything is read or solved.

What an argument may be is its annotation.  Annotations that are no plain types, such as protocols,
admit everything: then the function itself looks.
"""

from __future__ import annotations

import builtins
import collections.abc as abc
import functools
import inspect
import os
import sys
import typing
from collections.abc import Callable, Iterator, Mapping
from numbers import Integral, Real
from types import NoneType, UnionType
from typing import Any, Literal, SupportsFloat, Union, get_args, get_origin, is_typeddict

from solidgear.core.errors import SolidgearError, nearest, show
from solidgear.core.scene.document import SOURCE_WORDS, Documented

#: what Python's own types are called
WORDS: dict[Any, str] = {
    str: "a text",
    float: "a number",
    int: "a whole number",
    bool: "True or False",
    NoneType: "None",
    os.PathLike: "a path",
}
SEVERAL = {str: "texts", float: "numbers", int: "whole numbers"}
#: where things come from that no constructor makes
MADE_BY = {"Body": "solidgear.build", "ModeSet": "solidgear.modes"}
_MAPPINGS = (dict, abc.Mapping)
_ROWS = (list, tuple, abc.Sequence, abc.Iterable, abc.Collection)


def checked(function: Callable[..., Any], name: str) -> Callable[..., Any]:
    """Return a function of the package that looks at the types of its arguments first; pickled by the
    name that users have for it.

    Examples
    --------
    >>> def half(n: int) -> float:
    ...     return n / 2
    >>> checked(half, "half")("three")
    Traceback (most recent call last):
    solidgear.core.errors.SolidgearError: half: `n` = "three": give a whole number
    """
    signature = inspect.signature(function)

    @functools.wraps(function)
    def checking(*args: Any, **named: Any) -> Any:
        try:
            bound = signature.bind(*args, **named)
        except TypeError as error:
            raise TypeError(f"{name}() {error}") from None
        hints = arguments_of(function)
        for key, value in bound.arguments.items():
            several = signature.parameters[key].kind
            if several is inspect.Parameter.VAR_KEYWORD:
                _check_words(name, value, hints.get(key))
            elif several is inspect.Parameter.VAR_POSITIONAL:
                for given in value:
                    _check(name, key, given, hints.get(key, Any))
            else:
                _check(name, key, value, hints.get(key, Any))
        return function(*args, **named)

    checking.__module__, checking.__qualname__ = "solidgear", name
    return checking


def _check_words(function: str, given: Mapping[str, Any], hints: Any) -> None:
    """Refuse further words of a function that it does not have, and values of wrong types."""
    if not isinstance(hints, Mapping):
        return
    for word, value in given.items():
        if word not in hints:
            hint = nearest(word, hints)
            raise TypeError(f"{function}() got an unexpected keyword argument {word!r}{hint}")
        _check(function, word, value, hints[word])


def _check(function: str, argument: str, value: Any, hint: Any) -> None:
    """Refuse a value that is nothing of what an annotation says."""
    if fits(value, hint):
        return
    members = [*_members(hint)]
    words = []
    if Documented in members:
        words.append(SOURCE_WORDS)
        members = [m for m in members if get_origin(m) in _ROWS]
    # nothing is what an argument that is left out has: no advice
    words += dict.fromkeys(_words(m) for m in members if m is not NoneType)
    raise SolidgearError(f"{function}: `{argument}` = {_shown(value)}: give {' or '.join(words)}")


def _shown(value: Any) -> str:
    """Return a value as a message has it; things of classes by their class."""
    plain = value is None or isinstance(value, (str, Real, list, tuple, dict, set))
    if plain:
        return repr(value) if value is None or isinstance(value, bool) else show(value, 40)
    return f"a {type(value).__name__}"


def fits(value: Any, hint: Any) -> bool:
    """Return False for a value that an annotation does not admit.

    Examples
    --------
    >>> fits("euler", str | abc.Sequence[str]), fits([1], str | abc.Sequence[str])
    (True, False)
    """
    if hint in (None, NoneType):
        return value is None
    origin = get_origin(hint)
    if origin in (Union, UnionType):
        return any(fits(value, member) for member in get_args(hint))
    if origin is Literal:
        return any(isinstance(value, type(word)) for word in get_args(hint))
    kind = origin or hint
    if kind is abc.Callable:
        return callable(value)
    if kind is bool:
        return fits(value, int) or type(value).__name__ in ("bool", "bool_")
    if kind is int:
        return isinstance(value, Integral) and not isinstance(value, bool)
    if kind is float:
        number = isinstance(value, SupportsFloat) and not getattr(value, "ndim", 0)
        return number and not isinstance(value, bool)
    if kind in _MAPPINGS:
        items = value.items() if isinstance(value, Mapping) else ()
        return isinstance(value, Mapping) and all(
            fits(part, of) for pair in items for part, of in zip(pair, get_args(hint))
        )
    if kind in _ROWS:
        return _fits_row(value, kind, get_args(hint))
    if not isinstance(kind, type):
        return True
    try:
        return isinstance(value, kind)
    except TypeError:  # a protocol without members at run time
        return True


def _fits_row(value: Any, kind: Any, parts: tuple[Any, ...]) -> bool:
    """Return False for a value that is no row of such parts; what is read once is not read here."""
    if isinstance(value, (str, bytes, Mapping)) and not (
        parts in ((str,), ()) and kind is abc.Iterable
    ):
        return False
    if not isinstance(value, abc.Collection):
        return kind is abc.Iterable and isinstance(value, abc.Iterable)
    of = [part for part in parts if part is not ...]
    if kind is tuple and of == [*parts] and of:
        return len(value) == len(of) and all(map(fits, value, of))
    return not of or all(any(fits(entry, part) for part in of) for entry in value)


def _words(hint: Any) -> str:
    """Return what an annotation admits in words."""
    kind = get_origin(hint) or hint
    if kind in WORDS:
        return WORDS[kind]
    if kind is abc.Callable:
        return "a function"
    if kind is Literal:
        return " or ".join(show(word) for word in get_args(hint))
    parts = [part for part in get_args(hint) if part is not ...]
    if kind in _MAPPINGS:
        return "a dict"
    if kind is tuple and parts and parts == [*get_args(hint)]:
        return f"a pair ({', '.join(_words(part).partition(',')[0] for part in parts)})"
    if kind in _ROWS:
        of = dict.fromkeys(_several(m) for part in parts for m in _members(part))
        return f"a list of {' or '.join(of)}" if of else "a list"
    name = getattr(kind, "__name__", str(kind))
    made = f", which {MADE_BY[name]} makes" if name in MADE_BY else ""
    return f"{'an' if name[0] in 'AEIO' else 'a'} {name}{made}"


def _several(hint: Any) -> str:
    """Return what a list may have in words."""
    return (
        SEVERAL.get(hint)
        or f"{_words(hint).partition(',')[0].removeprefix('an ').removeprefix('a ')}s"
    )


def _members(hint: Any) -> Iterator[Any]:
    """Yield the members of a union, or the annotation itself."""
    if get_origin(hint) in (Union, UnionType):
        for member in get_args(hint):
            yield from _members(member)
    else:
        yield hint


@functools.cache
def arguments_of(function: Callable[..., Any]) -> dict[str, Any]:
    """Return the annotations of a function as types, of keywords those of each."""
    names = _Names(function)
    found = {key: names.read(text) for key, text in function.__annotations__.items()}
    for key, hint in found.items():
        (keys,) = get_args(hint) if get_origin(hint) is typing.Unpack else (None,)
        if is_typeddict(keys):
            of_keys = _Names(keys)
            found[key] = {k: of_keys.read(text) for k, text in keys.__annotations__.items()}
    return found


class _Names(dict):
    """Names that annotations of a function or class may have: those of its module, and exported ones."""

    def __init__(self, owner: Any):
        super().__init__(vars(sys.modules[owner.__module__]))

    def __missing__(self, name: str) -> Any:
        places = (builtins, abc, sys.modules["solidgear"])
        return getattr(next(place for place in places if hasattr(place, name)), name)

    def read(self, text: Any) -> Any:
        """Return an annotation as a type; Any where a name is only known to type checkers."""
        if isinstance(text, typing.ForwardRef):
            text = text.__forward_arg__
        if not isinstance(text, str):
            return text
        try:
            return self.read(eval(text, {}, self))
        except (NameError, StopIteration, TypeError):
            return Any
