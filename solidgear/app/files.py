"""Commands that give files to begin with: new, scenes; and the options of the models."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from typing import Annotated, Any

import typer

from solidgear.app.starts import STARTS, start
from solidgear.core import LADDER, SolidgearError, nearest, show
from solidgear.core.ladder.model import Model
from solidgear.core.machine.whole_file import write_files
from solidgear.core.models.options import Option, limits
from solidgear.show.command import as_typed, command, say
from solidgear.show.schema.files import directive
from solidgear.show.table import Table, text, word

KINDS = "; ".join(f"{kind}: {what}" for kind, what in STARTS.items())


@command
def new(
    name: Annotated[Path, typer.Argument(help="Scene file to write, with or without .toml.")],
    kind: Annotated[str, typer.Option(help=f"{KINDS}.")] = "overhung",
) -> None:
    if name.name in ("", ".."):
        raise SolidgearError(f"new: {name} is a folder; give the name of a file, such as shaft")
    path = name if name.suffix == ".toml" else name.with_name(f"{name.name}.toml")
    contents = {path.parent / file: content for file, content in start(kind, path.stem).items()}
    _write({file: _with_schema(content).encode() for file, content in contents.items()})
    companions = (
        f" (with {', '.join(str(file) for file in contents if file != path)})"
        if len(contents) > 1
        else ""
    )
    typer.echo(f"{path}: {STARTS[kind]}{companions}. Next: solidgear check {as_typed(path)}")


def _with_schema(content: str) -> str:
    """Return a file with a first line that names its schema to editors."""
    return f"{directive(tomllib.loads(content))}\n{content}"


@command
def scenes(
    names: Annotated[
        list[str] | None, typer.Argument(help="Scenes to copy; all of them by default.")
    ] = None,
    to: Annotated[
        Path | None, typer.Option("--to", help="Folder to copy them into, with what they refer to.")
    ] = None,
) -> None:
    shipped_names = shipped()
    for name in names or []:
        if name.removesuffix(".toml") not in shipped_names:
            raise SolidgearError(
                f"scene {show(name, 60)} does not come with solidgear{nearest(name, shipped_names)}; "
                f"there are {', '.join(shipped_names)}"
            )
    wanted_names = [name.removesuffix(".toml") for name in names or shipped_names]
    if to is None:
        columns = [text("scene", str), text("what it is", lambda name: title(shipped_names[name]))]
        say(Table("", columns, wanted_names, style="ruled"))
        return
    files = sorted({file for name in wanted_names for file in needed(shipped_names[name])})
    _write({to / file.name: file.read_bytes() for file in files})
    typer.echo(f"{to}: {', '.join(file.name for file in files)}")


@command
def options(
    model: Annotated[
        str, typer.Argument(help=f"{', '.join(LADDER.bodies)}; all of them by default.")
    ] = "",
) -> None:
    for name in (LADDER[model].name,) if model else LADDER.bodies:
        say(_options(LADDER[name]))


def _options(model: Model) -> Table:
    defaults, choices = model.defaults(), model.options
    columns = [
        word("option", str),
        word("default", lambda key: _default(defaults.get(key))),
        text("may be", lambda key: _may_be(choices[key])),
        text("what it is", lambda key: choices[key].meaning),
    ]
    return Table(f"{model.name}: {model.title}", columns, list(choices))


def _may_be(option: Option) -> str:
    match option.kind:
        case "flag":
            return "true or false"
        case "choice":
            return " or ".join(option.choices)
        case "several":
            return f"one or more of {', '.join(option.choices)}"
        case "whole":
            return f"a whole number {limits(option)}"
        case "harmonics":
            return f"whole numbers {limits(option)}"
    return f"a number {limits(option)}"


def _default(value: object) -> str:
    """Return a value as ``--set`` would take it."""
    if value is None or value == ():
        return "-"
    if isinstance(value, bool):
        return str(value).lower()
    return ",".join(map(str, value)) if isinstance(value, tuple) else str(value)


def _write(files: Mapping[Path, bytes]) -> None:
    """Write new files, or refuse all of them where one is there already."""
    for path in files:
        if path.exists():
            raise SolidgearError(f"{path}: there is such a file already; give another name")
    write_files(files)


#: where a wheel puts them, under the data folder of the installation
SHARED = "share/solidgear/geometry/"
CHECKOUT = Path(__file__).resolve().parents[2] / "geometry"
#: keys that name another file
REFERRING = ("scene", "step", "mesh", "contact_cells")


def shipped() -> dict[str, Path]:
    """Return shipped scene files by name; refuse an installation that has none.

    Examples
    --------
    >>> "pinion_overhung" in shipped()
    True
    """
    toml_files = sorted(CHECKOUT.glob("*.toml")) or _installed()
    if not toml_files:
        raise SolidgearError(
            "this installation of solidgear has no scenes; they lie in geometry/ of its source"
        )
    return {path.stem: path for path in toml_files}


def _installed() -> list[Path]:
    try:
        listed = files("solidgear") or []
    except PackageNotFoundError:
        return []
    scene_files = [f for f in listed if SHARED in f.as_posix() and f.suffix == ".toml"]
    return sorted(path for f in scene_files if (path := Path(str(f.locate())).resolve()).exists())


def title(path: Path) -> str:
    """Return the title of a scene file.

    Examples
    --------
    >>> title(shipped()["shaft_hollow"])
    'Hollow shaft on two bearings'
    """
    return str(tomllib.loads(path.read_text("utf-8")).get("title", ""))


def needed(path: Path) -> list[Path]:
    """Return a scene file and the files that it refers to.

    Examples
    --------
    >>> [file.name for file in needed(shipped()["axle_overhung"])]
    ['axle_overhung.toml', 'pinion_overhung.toml', 'gear_shaft.toml']
    """
    referred = [path.parent / name for name in _referred(tomllib.loads(path.read_text("utf-8")))]
    return [path, *(file for file in referred if file.is_file())]


def _referred(entry: Any) -> Iterator[str]:
    """Yield names of files in a table and in those that it holds."""
    if isinstance(entry, list):
        for item in entry:
            yield from _referred(item)
    elif isinstance(entry, dict):
        yield from (entry[key] for key in REFERRING if isinstance(entry.get(key), str))
        for item in entry.values():
            yield from _referred(item)
