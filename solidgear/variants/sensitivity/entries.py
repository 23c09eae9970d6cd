"""Numbers of a scene file that derivatives are by, and the scene with one of them a little changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from solidgear.core.errors import SceneError, SolidgearError, nearest
from solidgear.core.loading import part_of
from solidgear.core.scene import Scene
from solidgear.core.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.core.scene.file import scene_of
from solidgear.core.scene.paths import Keys, Tables, entries, entry, label_of, replace_entry
from solidgear.variants.sweep.amounts import amount, in_si

#: relative step of a number in the file, and that of a place, in lengths of the shaft: what
#: they move is linear in it but for angles, materials and springs in series
STEP, OF_PLACES = 1e-4, 1e-5
#: tables of a file whose numbers say how the shaft is
HELD_TABLES = ("material", "segment", "feature", "bearing", "mass", "housing", "port")
#: words in them that may look like numbers
WORDS = ("name", "note", "status", "kind", "from", "at", "attach_to", "source", "title")
#: keys of lengths that may be zero
PLACES = {"position", "span"}


def numbers(tables: Tables, by: Sequence[str] | None) -> Iterator[Keys]:
    """Entries that are numbers, of those asked for."""
    every = [keys for keys in entries(tables) if _is_number(keys, tables)]
    labels = [label_of(keys, tables) for keys in every]
    for one in by or ():
        if not any(_within(label, one) for label in labels):
            raise SolidgearError(f"--by {one}: no number of the file{nearest(one, labels)}")
    for keys, label in zip(every, labels):
        if not by or any(_within(label, one) for one in by):
            yield keys


def _within(label: str, path: str) -> bool:
    return label == path or label.startswith(f"{path}.")


def _is_number(keys: Keys, tables: Tables) -> bool:
    value = entry(keys, tables)
    if keys[0] not in HELD_TABLES or "catalogue" in keys or isinstance(value, bool):
        return False
    if keys[-1] in WORDS or (isinstance(value, str) and not amount(value)):
        return False
    if len(keys) > 2 and keys[-3] == "matrix" and int(keys[-2]) > int(keys[-1]):
        return False  # its mirror moves with the other
    # a place may be counted from zero; a term that is zero is none
    return bool(in_si(value)) or (in_si(value) == 0.0 and PLACES.intersection(keys[-2:]) != set())


@dataclass(frozen=True)
class Around:
    """The scene with an entry a little smaller and a little larger."""

    #: low, high: one of them the scene itself where the file allows no number on that side
    low: Scene
    high: Scene
    step: float  #: between them, SI
    written: str  #: the entry as the file has it
    unit: str  #: that the file gives it in; empty for SI
    at: float  #: the entry, SI
    side: str = ""  #: the only way that the entry may go


def around(scene: Scene, tables: Tables, keys: Keys, where: str) -> Around:
    """The scene on both sides of an entry.

    Raises
    ------
    SceneError
        Where the file allows no other number on either side.
    """
    written = str(entry(keys, tables))
    number, unit = amount(written).groups()  # type: ignore[union-attr]
    one = (in_si(f"1 {unit}") or 1.0) if unit else 1.0
    at = in_si(entry(keys, tables)) or 0.0
    step = OF_PLACES * scene.length if PLACES.intersection(keys[-2:]) else STEP * abs(at)
    sides: list[Scene | None] = []
    for sign in (-1, 1):
        try:
            other = _in_place(scene, tables, keys, at + sign * step)
            text = _text(float(number) + sign * step / one, unit)
            sides.append(other or _held(replace_entry(tables, keys, text), scene, where))
        except SceneError as error:
            sides.append(None)
            refused = error
    low, high = sides
    if low is None and high is None:
        raise refused
    if low is not None and high is not None:
        return Around(low, high, 2 * step, written, unit, at)
    side = "larger" if low is None else "smaller"
    return Around(low or scene, high or scene, step, written, unit, at, side)


def _text(value: float, unit: str) -> str | float:
    return f"{value!r} {unit}" if unit else value


def _in_place(scene: Scene, tables: Tables, keys: Keys, value: float) -> Scene | None:
    """A scene with an entry of a stiffness matrix or of the material changed, which no place hangs on;
    None for other entries.
    """
    first, *rest = keys
    if first == "material" and not any("material" in one for one in tables["segment"]):
        material = scene.material.with_changes(**{str(keys[1]): value})
        segments = tuple(one.with_changes(material=material) for one in scene.segments)
        return scene.unjudged(material=material, segments=segments)
    if first == "housing" and scene.housing is not None:
        housing = _stiffened(scene.housing, rest, value)
        return housing and scene.unjudged(housing=housing)
    if first != "bearing":
        return None
    place, *rest = rest
    own = scene.bearings[int(place)]
    if rest[0] == "housing":
        inside = _stiffened(own.housing, rest[1:], value)
        bearing = inside and own.with_changes(housing=inside)
    else:
        bearing = _stiffened(own, rest, value)
    if bearing is None:
        return None
    return scene.unjudged(bearings=tuple(bearing if one is own else one for one in scene.bearings))


def _stiffened(thing: Any, keys: Sequence[str | int], value: float) -> Any:
    """A thing with an entry of its matrix, and the mirror of it, changed; None for other entries."""
    if keys[0] == "stiffness":
        row, column, _ = STIFFNESS_NAMES[str(keys[1])]
    elif keys[0] == "matrix":
        row, column = map(int, keys[1:])
    else:
        return None
    matrix = np.array(thing.matrix)
    matrix[row, column] = matrix[column, row] = value
    return thing.with_changes(matrix=matrix)


def _held(tables: Tables, scene: Scene, where: str) -> Scene:
    """A scene of tables, catalogue bearings as stiff as they are."""
    other = scene_of(dict(tables), where, part_of)
    if all(bearing.catalogue is None for bearing in scene.bearings):
        return other
    bearings = tuple(
        new if new.catalogue is None else new.with_changes(matrix=old.matrix)
        for new, old in zip(other.bearings, scene.bearings)
    )
    return other.with_changes(bearings=bearings)
