"""The scenes that come with solidgear: those of `geometry/` in a checkout, of the wheel elsewhere."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from typing import Any

from solidgear.errors import SolidgearError

#: where a wheel puts them, under the data folder of the installation
SHARED = "share/solidgear/geometry/"
CHECKOUT = Path(__file__).resolve().parents[2] / "geometry"
#: keys that name another file
REFERRING = ("scene", "step", "mesh", "contact_cells")


def shipped() -> dict[str, Path]:
    """Scene files by name.

    Raises
    ------
    SolidgearError
        Where the installation has none.

    Examples
    --------
    >>> "pinion_overhung" in shipped()
    True
    """
    found = sorted(CHECKOUT.glob("*.toml")) or _installed()
    if not found:
        raise SolidgearError(
            "this installation of solidgear has no scenes; they lie in geometry/ of its source"
        )
    return {path.stem: path for path in found}


def _installed() -> list[Path]:
    try:
        listed = files("solidgear") or []
    except PackageNotFoundError:
        return []
    mine = [f for f in listed if SHARED in f.as_posix() and f.suffix == ".toml"]
    return sorted(path for f in mine if (path := Path(str(f.locate())).resolve()).exists())


def title(path: Path) -> str:
    """Description that a scene file gives of itself.

    Examples
    --------
    >>> title(shipped()["shaft_hollow"])
    'Hollow shaft on two bearings'
    """
    return str(tomllib.loads(path.read_text("utf-8")).get("title", ""))


def needed(path: Path) -> list[Path]:
    """A scene file and the files it refers to, beside it.

    Examples
    --------
    >>> [file.name for file in needed(shipped()["axle_overhung"])]
    ['axle_overhung.toml', 'pinion_overhung.toml', 'gear_shaft.toml']
    """
    beside = [path.parent / name for name in _referred(tomllib.loads(path.read_text("utf-8")))]
    return [path, *(file for file in beside if file.is_file())]


def _referred(entry: Any) -> Iterator[str]:
    """Names of files in a table and in those that it holds."""
    if isinstance(entry, list):
        for one in entry:
            yield from _referred(one)
    elif isinstance(entry, dict):
        yield from (entry[key] for key in REFERRING if isinstance(entry.get(key), str))
        for one in entry.values():
            yield from _referred(one)
