"""From a TOML file to a `Scene`, errors named by the keys of the file.

The format is documented by the files in ``geometry``. Every problem of a file is reported at once:
each table by itself, the names by which tables refer to each other, and the places of all parts
that are sound by themselves.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from solidgear.errors import SceneError, listed, nearest
from solidgear.scene.body_file import Reader, Recognised, unread
from solidgear.scene.model import Scene
from solidgear.scene.places import resolve
from solidgear.scene.rules import MOST_BEARINGS, MOST_MASSES, MOST_SEGMENTS, too_many
from solidgear.scene.segment_tables import KINDS
from solidgear.scene.tables import FEATURES, PartTable, SceneTable, SoundTables
from solidgear.scene.toml_file import describes_train, name_of, parse, place_of


def _drop_tag(loc: tuple) -> tuple:
    """pydantic puts the kind of a segment into its location; the file has no such key."""
    tags = {"segment": KINDS, "feature": FEATURES}.get(loc[0], ()) if loc else ()
    return (*loc[:2], *loc[3:]) if loc[2:3] and loc[2] in tags else loc


def load(path: str | os.PathLike, part_of: Reader = unread) -> Scene:
    """Read and resolve a scene file.

    Parameters
    ----------
    path : str or path
        A TOML file; ``geometry/pinion_overhung.toml`` describes the format.
    part_of : callable
        Reads the part that a [body] names, and recognises the body of revolution inside it.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        The file, the key (``bearing[2] "2".seat_width``, counted from one), the value as written,
        what would be right: one line for each problem, in the order of the file.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/pinion_overhung.toml")
    >>> [bearing.name for bearing in scene.bearings], scene.port.name
    (['1', '2'], 'pinion')
    """
    where = os.fspath(path)
    raw = parse(where)
    if describes_train(raw):
        raise SceneError(
            "describes a train of two shafts and not a shaft; run solidgear compare, check, "
            "system-modes, response or receptance on it, or read it with solidgear.load_train"
        ).located(raw, where=place_of(where))
    try:
        return _read(raw, where, part_of)
    except SceneError as error:
        found = error.problems
        if isinstance(raw.get("port"), Mapping):  # one [port] is a table and not a list of one
            found = tuple(one.located(None, path=_of_the_one_port(one.path)) for one in found)
        problems = {
            (one.path, one.reason): one for one in found
        }  # both ends of a cylinder are one diameter
        order = _FileOrder(raw)
        ordered = sorted(problems.values(), key=lambda one: order.of(one.path))
        raise SceneError.of(ordered).located(raw, where=place_of(where)) from None


def _of_the_one_port(path: tuple) -> tuple:
    return ("port", *path[2:]) if path[:1] == ("port",) and path[1:2] == (0,) else path


def _read(raw: dict[str, Any], where: str, part_of: Reader) -> Scene:
    most_of = (("segment", MOST_SEGMENTS), ("bearing", MOST_BEARINGS), ("mass", MOST_MASSES))
    for what, most in most_of:
        if isinstance(raw.get(what), list) and len(raw[what]) > most:
            raise SceneError(
                too_many("masses" if what == "mass" else f"{what}s", len(raw[what]), most),
                path=(what,),
            )
    problems: list[SceneError] = []
    table, numbers = _tables(raw, problems)
    part = None
    if table is not None and table.body is not None:
        try:
            part = part_of(table.body, Path(where).parent)
        except SceneError as error:
            raise SceneError.of([*problems, error]) from None
    problems += _unknown_names(raw, part)
    if table is None:
        raise SceneError.of(problems)
    return resolve(table, numbers, name_of(where), problems, part)


def _tables(raw: dict[str, Any], problems: list[SceneError]) -> tuple[SceneTable | None, list[int]]:
    """The tables that are sound each by itself, and which bearings of the file are among them; None
    without a whole shaft.
    """
    # masses are judged only where all of them are sound
    count = len(raw["bearing"]) if isinstance(raw.get("bearing"), list) else 0
    try:
        return (PartTable if "body" in raw else SceneTable)(**raw), list(range(count))
    except SceneError as error:
        found = [one.located(raw, path=_drop_tag(one.path)) for one in error.problems]
    problems += found
    spoilt = {one.path[: 2 if one.path[0] in ("segment", "bearing") else 1] for one in found}
    if ("bearing",) in spoilt or any(
        place[0] in ("segment", "material", "body") for place in spoilt
    ):
        return None, []
    numbers = [k for k in range(count) if ("bearing", k) not in spoilt]
    sound = {
        key: raw[key]
        for key in ("material", "segment", "body", "attachment", "port", "ask")
        if key in raw and (key,) not in spoilt
    }
    return SoundTables(**sound, bearing=[raw["bearing"][k] for k in numbers]), numbers


class _FileOrder:
    """Where entries stand in a file."""

    def __init__(self, raw: Mapping):
        self.raw = raw
        self.places: dict[int, dict] = {}

    def of(self, path: tuple) -> list[int]:
        """Places of the keys of a path in their tables, the last one for a key that is missing."""
        out: list[int] = []
        here = self.raw
        for key in path:
            if id(here) not in self.places:
                self.places[id(here)] = {key: k for k, key in enumerate(_keys(here))}
            places = self.places[id(here)]
            if key not in places:
                return [*out, len(places)]
            out.append(places[key])
            here = here[key]
        return out


def _keys(table: Any) -> Iterable:
    if isinstance(table, Mapping):
        return table
    return range(len(table)) if isinstance(table, list) else ()


_PIECES = {"bevel_head": ("start", "end", "middle", "mid_face")}
_EVERY_PIECE = ("start", "end", "middle")


def _unknown_names(raw: dict[str, Any], part: Recognised | None) -> Iterator[SceneError]:
    """Names of segments that are taken twice, and datums and segments that are asked for but are
    not there.

    Read from the file as it stands, since a segment of a wrong length still has its name.
    """
    pieces, bearings, masses, ports = (
        _list_of_tables(raw.get("segment"))
        if part is None
        else [{"name": f"s{k}"} for k in range(1, len(part.walls) + 1)],
        _list_of_tables(raw.get("bearing", [])),
        _list_of_tables(raw.get("mass", [])),
        _list_of_tables([given] if isinstance(given := raw.get("port"), Mapping) else given),
    )
    if pieces is None or not all(isinstance(piece.get("name"), str) for piece in pieces):
        return  # without sound names, what refers to them cannot be judged
    known, segments = ["start", "end", *(["origin"] if part is not None else [])], []
    for i, piece in enumerate(pieces):
        if piece["name"] in segments:
            yield SceneError(
                "another segment has this name; each needs its own", path=("segment", i, "name")
            )
        segments.append(piece["name"])
        known += [
            f"{piece['name']}.{part}" for part in _PIECES.get(str(piece.get("kind")), _EVERY_PIECE)
        ]
    for i, bearing in enumerate(bearings or ()):
        yield from _unknown_datum(bearing.get("from"), known, ("bearing", i, "from"))
        if isinstance(bearing.get("name"), str):
            known.append(f"bearing.{bearing['name']}")
    for i, mass in enumerate(masses or () if bearings is not None else ()):
        yield from _unknown_datum(mass.get("from"), known, ("mass", i, "from"))
    for i, feature in enumerate(_list_of_tables(raw.get("feature", [])) or ()):
        for key in ("at", "from"):
            yield from _unknown_datum(feature.get(key), known, ("feature", i, key))
    if bearings is None:
        return
    housing = raw.get("housing")
    if isinstance(housing, Mapping):
        yield from _unknown_datum(housing.get("from"), known, ("housing", "from"))
    for i, port in enumerate(ports or ()):
        for key in ("at", "from"):
            yield from _unknown_datum(port.get(key), known, ("port", i, key))
        carrier = port.get("attach_to")
        if isinstance(carrier, str) and carrier not in segments:
            yield SceneError(
                f"unknown segment{nearest(carrier, segments)}; known here: {listed(segments)}",
                path=("port", i, "attach_to"),
            )


def _list_of_tables(value: Any) -> list[Mapping] | None:
    return (
        value
        if isinstance(value, list) and all(isinstance(entry, Mapping) for entry in value)
        else None
    )


def _unknown_datum(text: Any, known: list[str], path: tuple) -> Iterable[SceneError]:
    if isinstance(text, str) and text not in known:
        yield SceneError(
            f"unknown datum{nearest(text, known)}; known here: {listed(known)}", path=path
        )
