"""Data of a bearing in the file that belong to one designation, where the designation varies."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from solidgear.core.errors import listed, show
from solidgear.core.scene.paths import Tables, entry, label_of
from solidgear.variants.sweep.entries import Entry

#: keys of catalogue data that a designation does not share with another
OWN_OF_ONE = (
    "bore",
    "outer_diameter",
    "width",
    "load_rating",
    "static_rating",
    "fatigue_limit",
    "elements",
    "element_diameter",
    "element_length",
    "pitch_diameter",
    "contact_angle",
    "conformity",
    "row_distance",
)


def kept_data(varied: Sequence[Entry], files: Mapping[str, Tables]) -> Iterator[str]:
    """Sentences on data that every designation of a sweep keeps from the file."""
    moved = {(place.file, place.keys) for one in varied for place in one.places}
    for one in varied:
        for file, _, keys in one.places:
            if keys[-1] != "designation" or {*one.words} <= {one.there}:
                continue
            tables = files[file]
            data = [
                key
                for key in OWN_OF_ONE
                if entry((*keys[:-1], key), tables) is not None
                and (file, (*keys[:-1], key)) not in moved
            ]
            if data:
                are, them = ("is", "it") if len(data) == 1 else ("are", "them")
                yield (
                    f"{label_of(keys, tables)} varies, and {listed(data)} {are} kept from the file, "
                    f"where {'it belongs' if them == 'it' else 'they belong'} to "
                    f"{show(one.there)}: leave {them} out of the file, or vary {them} as well "
                    "(--table)"
                )
