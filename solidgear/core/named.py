"""Results whose parts have names: ``result["bending 1"]``, ``in``, ``list``, ``len`` as Python has
them.
"""

from __future__ import annotations

from collections.abc import ItemsView, Iterator, KeysView, Mapping, Sequence
from typing import Any, Generic, TypeVar, overload

from solidgear.core.errors import NoSuchName, listed, nearest

T = TypeVar("T")


class ByName(Generic[T]):
    """Base of results that are mappings of names. They have no method `values`: some have a field of
    that name.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.answer("geometry/shaft_stepped.toml", ask=["C_zz", "bending"])
    >>> list(found), "C_zz" in found, "K_zz" in found
    (['C_zz', 'bending 1'], True, False)
    >>> round(dict(found)["bending 1"])
    783
    """

    @property
    def by_name(self) -> Mapping[str, T]:
        """What each name stands for, in order."""
        raise NotImplementedError

    def __getitem__(self, name: str) -> T:
        by_name = self.by_name
        if name not in by_name:
            raise no_such(name, by_name)
        return by_name[name]

    def __contains__(self, name: object) -> bool:
        return name in self.by_name

    def __iter__(self) -> Iterator[str]:
        return iter(self.by_name)

    def __len__(self) -> int:
        return len(self.by_name)

    def __bool__(self) -> bool:
        return True  # a result, whatever it holds

    def keys(self) -> KeysView[str]:
        """Names, in order."""
        return self.by_name.keys()

    def items(self) -> ItemsView[str, T]:
        """Pairs of a name and what it stands for."""
        return self.by_name.items()

    def get(self, name: str, default: Any = None) -> Any:
        """What a name stands for, or the default where there is no such name."""
        return self.by_name.get(name, default)


class NamedModes(Generic[T]):
    """Base of lists of modes: a mode by its place or by its name; several may have one name, of which
    the first counts.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> found = sg.modes(sg.build(scene, "timoshenko"), scene, n=4)
    >>> len(found), found[1].name, found["axial 1"] is found[1], "axial 9" in found
    (4, 'axial 1', True, False)
    """

    @property
    def listed_modes(self) -> Sequence[T]:
        """Modes in the order of the list."""
        raise NotImplementedError

    def named(self, name: str) -> T | None:
        """Return the first mode of a name; None where there is none."""
        modes: Sequence[Any] = self.listed_modes
        return next((mode for mode in modes if mode.name == name), None)

    @overload
    def __getitem__(self, place: str | int) -> T: ...

    @overload
    def __getitem__(self, place: slice) -> Sequence[T]: ...

    def __getitem__(self, place: str | int | slice) -> T | Sequence[T]:
        if not isinstance(place, str):
            return self.listed_modes[place]
        mode = self.named(place)
        if mode is None:
            modes: Sequence[Any] = self.listed_modes
            raise no_such(place, [str(mode.name) for mode in modes])
        return mode

    def __contains__(self, mode: object) -> bool:
        if isinstance(mode, str):
            return self.named(mode) is not None
        return any(mode is each for each in self.listed_modes)

    def __iter__(self) -> Iterator[T]:
        return iter(self.listed_modes)

    def __len__(self) -> int:
        return len(self.listed_modes)

    def __bool__(self) -> bool:
        return True  # a result, whatever it holds


def no_such(name: object, names: Mapping[str, Any] | Sequence[str]) -> NoSuchName:
    """Return the error of a name that a result has not."""
    there = listed([*dict.fromkeys(names)]) or "none"
    hint = nearest(name, [*names]) if isinstance(name, str) else ""
    return NoSuchName(f"there is no {name!r}{hint}; there are {there}")
