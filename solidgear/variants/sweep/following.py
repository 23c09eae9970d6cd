"""Entries of a file that follow one that varies: the seat and the data of another designation, the
pitch radius of other teeth.

A shaft is made for its bearings: where the seat has the bore of the bearing in the file, it has that
of every other bearing in its place, or the file would be refused for all bores but one.  Ratings and
inner dimensions are those of one designation, and are left out for others.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

from solidgear.bearings.bearing_list import read_list, with_listed
from solidgear.bearings.catalogue import Catalogue, catalogue_of
from solidgear.bearings.fit import misfits_of
from solidgear.core import TOUCH, Scene, SceneError, SolidgearError, listed, show
from solidgear.core.scene.paths import Keys, Tables, keys_of, label_of, replace_entry
from solidgear.core.scene.paths import entry as value_in_file
from solidgear.variants.sweep.entries import Entry, Owner, Place, in_si, place_of

#: keys of catalogue data that a designation does not share with another
DATA_OF_DESIGNATION = (
    "kind",
    "bore",
    "outer_diameter",
    "width",
    "load_rating",
    "static_rating",
    "fatigue_limit",
    "rating_factor",
    "elements",
    "element_diameter",
    "element_length",
    "pitch_diameter",
    "contact_angle",
    "conformity",
    "row_distance",
    "ribs",
    "rib_stiffness",
)
#: relative, of lengths that are the same
SAME = 1e-9


class Follower(Protocol):
    """Entries of a file that follow one that varies."""

    @property
    def file(self) -> str:
        """Name of the file, of several."""

    @property
    def numbers(self) -> tuple[Place, ...]:
        """Numbers that follow, each a column of rows."""

    @property
    def sentence(self) -> str:
        """Sentence on what follows."""

    def put(self, tables: Tables) -> Tables:
        """Return tables that hold a value of the entry, with all that follows put in."""

    def refuse(self, tables: Tables, scene: Scene) -> None:
        """Refuse the scene of tables that does not go with the value."""


@dataclass(frozen=True)
class Seat:
    """A bearing whose designation varies, and its seat on the shaft."""

    place: Place  #: of the designation
    in_file: Any  #: designation
    diameters: tuple[Place, ...]  #: those that become the bore
    width: Place | None  #: seat width that becomes the width
    dropped: tuple[str, ...]  #: keys of the file that belong to its designation alone
    shoulders: tuple[tuple[str, str], ...]  #: seat, and a segment beside it that is larger
    #: names of the bearings that fit their seats in the file, and then must go on fitting
    fitting: tuple[str, ...]
    label: str  #: path of the designation
    listed: Path | None  #: file of a list of bearings, where designations are looked up first

    @property
    def file(self) -> str:
        return self.place.file

    @property
    def numbers(self) -> tuple[Place, ...]:
        return self.diameters

    @property
    def sentence(self) -> str:
        parts = []
        if self.diameters:
            labels = [place.label for place in self.diameters]
            parts.append(f"{listed(labels)} {_verb(labels, 'follow')} its bore")
        else:
            parts.append("no diameter follows its bore")
        if self.width is not None:
            parts.append("seat_width follows its width")
        if self.dropped:
            parts.append(
                f"{listed(self.dropped)} of the file {_verb(self.dropped, 'belong')} to "
                f"{show(self.in_file)} and {_verb(self.dropped, 'are')} left out for others, whose "
                "data are those of a list of bearings or estimated"
            )
        return f"{self.label} varies: {'; '.join(parts)}"

    def put(self, tables: Tables) -> Tables:
        keys = keys_of(self.place.path, tables)  # of this file, or of another in its place
        if value_in_file(keys, tables) == self.in_file:
            return tables
        for key in self.dropped:
            tables = _dropping(tables, (*keys[:-1], key))
        data = catalogue_in(tables, keys[:-1], self.listed)
        if data is None:
            return tables  # refused by the reader of the file
        if data.both_ways or data.floats:
            tables = _dropping(tables, (*keys[:-1], "holds"))
        for place in self.diameters:
            tables = replace_entry(tables, keys_of(place.path, tables), data.bore)
        return tables if self.width is None else _dropping(tables, (*keys[:2], "seat_width"))

    def refuse(self, tables: Tables, scene: Scene) -> None:
        keys = keys_of(self.place.path, tables)
        if value_in_file(keys, tables) == self.in_file:
            return
        fitting = [b for b in scene.bearings if b.name in self.fitting]
        reason = next((problem for b in fitting for problem in misfits_of(scene, b)), "")
        for seat, shoulder in self.shoulders:
            high, low = (_largest(scene, name) for name in (shoulder, seat))
            if high <= low * (1 + SAME):
                reason = (
                    f"its bore of {2e3 * low:.5g} mm leaves no shoulder at {shoulder!r} "
                    f"({2e3 * high:.5g} mm)"
                )
        if reason:
            raise SceneError(reason, path=keys)


@dataclass(frozen=True)
class PitchRadius:
    """The pitch radius of a gear whose teeth vary, at the module of the file."""

    place: Place  #: of the number of teeth
    radius: Place
    teeth: float  #: in the file
    module: float  #: twice the radius over the teeth in the file, m
    label: str  #: path of the number of teeth

    @property
    def file(self) -> str:
        return self.place.file

    @property
    def numbers(self) -> tuple[Place, ...]:
        return (self.radius,)

    @property
    def sentence(self) -> str:
        return (
            f"{self.label} varies: {self.radius.label} follows at the transverse module of the file, "
            f"{1e3 * self.module:.5g} mm, and with it the centre distance; shafts and head inertias "
            "stay as they are"
        )

    def put(self, tables: Tables) -> Tables:
        teeth = in_si(value_in_file(self.place.keys, tables))
        if teeth is None or teeth == self.teeth:
            return tables
        radius = float(f"{self.module * teeth / 2:.12g}")
        return replace_entry(tables, self.radius.keys, radius)

    def refuse(self, tables: Tables, scene: Scene) -> None:
        return


def followers_of(
    varied: Sequence[Entry],
    files: Mapping[str, Tables],
    owner: Owner,
    scene_of_file: Callable[[str], Scene],
    list_of_file: Callable[[str], Path | None],
    follow: Iterable[str] = (),
) -> tuple[Follower, ...]:
    """Return what follows the entries that vary, given the scene of a file and the list of bearings
    that it names; `follow` names further diameters that follow the bore of a bearing.
    """
    moved = {(place.file, place.keys) for varying in varied for place in varying.places}
    seats: list[Seat] = []
    radii: list[PitchRadius] = []
    for varying in varied:
        for place in varying.places:
            if place.keys[-1] == "designation" and {*varying.words} - {varying.in_file}:
                scene = scene_of_file(place.file)
                listed_in = list_of_file(place.file)
                seats.append(_seat(place, files[place.file], scene, moved, listed_in))
            radii += _pitch_radius(place, files[place.file], moved)
    for text in follow:
        seats = _with_diameter(text, seats, files, owner, moved)
    return (*seats, *radii)


def _seat(
    place: Place,
    tables: Tables,
    scene: Scene,
    moved: set[tuple[str, Keys]],
    listed_in: Path | None,
) -> Seat:
    """Return a bearing whose designation varies, with the seat that it has in the file."""
    file, keys = place.file, place.keys
    table = value_in_file(keys[:-1], tables)
    bearing = scene.bearings[int(keys[1])]
    data = catalogue_of(bearing)
    dropped = tuple(
        key
        for key in DATA_OF_DESIGNATION
        if key in table and (file, (*keys[:-1], key)) not in moved
    )
    seat = Seat(
        place=place,
        in_file=table.get("designation"),
        diameters=(),
        width=None,
        dropped=dropped,
        shoulders=(),
        fitting=tuple(b.name for b in scene.bearings if not any(misfits_of(scene, b))),
        label=place.label,
        listed=listed_in,
    )
    if data is None:
        return seat
    wide = keys[:2] + ("seat_width",)
    width = in_si(value_in_file(wide, tables))
    if width is not None and abs(width / data.seat_width - 1) < SAME and (file, wide) not in moved:
        seat = replace(seat, width=Place(file, label_of(wide, tables), wide))
    middle = (bearing.lo + bearing.hi) / 2
    for segment in scene.segments:
        diameter = _diameter_of(segment.name, tables)
        if diameter is None or (file, diameter) in moved or not _holds(segment, middle):
            continue
        if abs(2 * segment.outer0 / data.bore - 1) < SAME:
            seat = _with_bore(
                seat, scene, segment.name, Place(file, label_of(diameter, tables), diameter)
            )
    return seat


def _with_bore(seat: Seat, scene: Scene, name: str, diameter: Place) -> Seat:
    """Return a seat with one more diameter that follows the bore, and the shoulders beside it."""
    names = [segment.name for segment in scene.segments]
    k = names.index(name)
    neighbours = [names[i] for i in (k - 1, k + 1) if 0 <= i < len(names)]
    larger = [n for n in neighbours if _largest(scene, n) > _largest(scene, name)]
    return replace(
        seat,
        diameters=(*seat.diameters, diameter),
        shoulders=(*seat.shoulders, *((name, n) for n in larger)),
    )


def _pitch_radius(
    place: Place, tables: Tables, moved: set[tuple[str, Keys]]
) -> Iterator[PitchRadius]:
    """Yield the pitch radius that a file has beside a number of teeth that varies."""
    at_radius = (*place.keys[:-1], "pitch_radius")
    teeth = in_si(value_in_file(place.keys, tables))
    radius = in_si(value_in_file(at_radius, tables))
    if place.keys[-1] != "teeth" or not teeth or radius is None or (place.file, at_radius) in moved:
        return
    gear_radius = Place(place.file, label_of(at_radius, tables), at_radius)
    yield PitchRadius(place, gear_radius, teeth, 2 * radius / teeth, place.label)


def _with_diameter(
    text: str,
    seats: list[Seat],
    files: Mapping[str, Tables],
    owner: Owner,
    moved: set[tuple[str, Keys]],
) -> list[Seat]:
    """Return seats of which one has a further diameter that follows its bore."""
    try:
        place = place_of(text.strip(), files, owner)
        number = in_si(value_in_file(place.keys, files[place.file]))
    except SceneError as error:
        raise SolidgearError(f"`follow` {text}: {error}") from None
    if number is None or "diameter" not in str(place.keys[-1]):
        raise SolidgearError(
            f"`follow` {text}: name a diameter of the file, such as segment.left.diameter"
        )
    if (place.file, place.keys) in moved:
        raise SolidgearError(f"`follow` {text}: it varies by itself; leave it out of one of them")
    near = [seat for seat in seats if seat.file == place.file]
    if any(place in seat.diameters for seat in near):
        return seats
    if len(near) != 1:
        labels = listed(seat.label for seat in near) or "none"
        raise SolidgearError(
            f"`follow` {text}: one designation of its file must vary, and here vary {labels}"
        )
    (seat,) = near
    wider = replace(seat, diameters=(*seat.diameters, place))
    return [wider if each is seat else each for each in seats]


def _diameter_of(segment: str, tables: Tables) -> Keys | None:
    """Return the keys of the diameter of a cylinder by its name; None of any other shape."""
    for k, table in enumerate(tables.get("segment", ())):
        if table.get("name") == segment and table.get("kind") == "cylinder":
            return "segment", k, "diameter"
    return None


def _holds(segment: Any, y: float) -> bool:
    return bool(segment.y0 - TOUCH <= y <= segment.y1 + TOUCH)


def _largest(scene: Scene, name: str) -> float:
    """Return the largest outer radius of a segment, m."""
    return max(max(s.outer0, s.outer1) for s in scene.segments if s.name == name)


def catalogue_in(tables: Tables, keys: Keys, listed: Path | None) -> Catalogue | None:
    """Return the catalogue data of a bearing in the tables of a file, whichever way it holds the
    shaft; None where they are refused.
    """
    table = value_in_file(keys, tables)
    for way in dict[str, Any](), {"holds": "+y"}:
        try:
            if listed is not None:
                table = with_listed(table, read_list(os.fspath(listed), Catalogue))
            return Catalogue(**{**table, **way})
        except (SceneError, TypeError):
            continue
    return None


def _dropping(tables: Any, keys: Keys) -> Any:
    """Return a copy of tables without one entry."""
    first, *further = keys
    if isinstance(first, int):
        out = list(tables)
        out[first] = _dropping(out[first], tuple(further))
        return out
    if first not in tables:
        return tables
    if further:
        return {**tables, first: _dropping(tables[first], tuple(further))}
    return {key: value for key, value in tables.items() if key != first}


def list_in(tables: Tables, folder: Path) -> Path | None:
    """Return the file of the list of bearings that tables name; None where they name none."""
    name = tables.get("bearings")
    return folder / name if isinstance(name, str) else None


def _verb(things: Sequence[Any], plural: str) -> str:
    """Return a verb for one thing or for several."""
    if len(things) > 1:
        return plural
    return "is" if plural == "are" else f"{plural}s"
