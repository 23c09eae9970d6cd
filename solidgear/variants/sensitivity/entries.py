"""Numbers of a scene file to derive by, and the scene with one of them a little changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from solidgear.core import Scene, SceneError, SolidgearError, nearest
from solidgear.core.loading import part_of
from solidgear.core.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.core.scene.file import scene_of
from solidgear.core.scene.paths import Keys, Tables, entries, entry, label_of, replace_entry
from solidgear.variants.sweep.amounts import amount, in_si

#: relative step of a number in the file, and that of a place, in lengths of the shaft: nodes and
#: matrices are linear in it but for angles, materials and springs in series
STEP, OF_PLACES = 1e-4, 1e-5
#: tables of a file whose numbers describe the shaft
SHAFT_TABLES = ("material", "segment", "feature", "bearing", "mass", "housing", "port")
#: words in them that may look like numbers
WORDS = ("name", "note", "status", "kind", "from", "at", "attach_to", "source", "title")
#: keys of lengths that may be zero
PLACES = {"position", "span"}


def numbers(tables: Tables, by: Sequence[str] | None) -> Iterator[Keys]:
    """Yield the entries that are numbers, at or below one of the paths `by` if there are any."""
    keys_of_numbers = [keys for keys in entries(tables) if _is_number(keys, tables)]
    labels = [label_of(keys, tables) for keys in keys_of_numbers]
    for path in by or ():
        if not any(_within(label, path) for label in labels):
            raise SolidgearError(f"--by {path}: the file has no such number{nearest(path, labels)}")
    for keys, label in zip(keys_of_numbers, labels):
        if not by or any(_within(label, path) for path in by):
            yield keys


def _within(label: str, path: str) -> bool:
    return label == path or label.startswith(f"{path}.")


def _is_number(keys: Keys, tables: Tables) -> bool:
    value = entry(keys, tables)
    if keys[0] not in SHAFT_TABLES or "catalogue" in keys or isinstance(value, bool):
        return False
    if keys[-1] in WORDS or (isinstance(value, str) and not amount(value)):
        return False
    if len(keys) > 2 and keys[-3] == "matrix" and int(keys[-2]) > int(keys[-1]):
        return False  # the mirrored entry moves with the other
    # a place may be counted from zero; a term that is zero is none
    if in_si(value) == 0.0:
        return bool(PLACES.intersection(keys[-2:]))
    return bool(in_si(value))


@dataclass(frozen=True)
class Around:
    """Scene with an entry a little smaller and a little larger."""

    #: low, high: one of them the scene itself where the file allows no number on that side
    low: Scene
    high: Scene
    step: float  #: between them, SI
    written: str  #: the entry as the file has it
    unit: str  #: that the file gives it in; empty for SI
    at: float  #: the entry, SI
    side: str = ""  #: ``larger`` or ``smaller`` if the file allows no other side


def around(scene: Scene, tables: Tables, keys: Keys, where: str) -> Around:
    """Return the scene on both sides of an entry; SceneError if the file allows no other number."""
    written = str(entry(keys, tables))
    number, unit = amount(written).groups()  # type: ignore[union-attr]
    factor = 1.0
    if unit:
        factor = in_si(f"1 {unit}") or 1.0
    at = in_si(entry(keys, tables)) or 0.0
    step = OF_PLACES * scene.length if PLACES.intersection(keys[-2:]) else STEP * abs(at)
    sides: list[Scene | None] = []
    for sign in (-1, 1):
        try:
            changed = _changed_directly(scene, tables, keys, at + sign * step)
            value = float(number) + sign * step / factor
            text = f"{value!r} {unit}" if unit else value
            sides.append(changed or _read_again(replace_entry(tables, keys, text), scene, where))
        except SceneError as error:
            sides.append(None)
            refusal = error
    low, high = sides
    if low is None and high is None:
        raise refusal
    if low is not None and high is not None:
        return Around(low, high, 2 * step, written, unit, at)
    side = "larger" if low is None else "smaller"
    return Around(low or scene, high or scene, step, written, unit, at, side)


def _changed_directly(scene: Scene, tables: Tables, keys: Keys, value: float) -> Scene | None:
    """Return a scene with an entry of a stiffness matrix or of the material changed, which no place
    depends on; None for other entries.
    """
    first, *within = keys
    if first == "material" and not any("material" in table for table in tables["segment"]):
        material = scene.material.with_changes(**{str(keys[1]): value})
        segments = tuple(segment.with_changes(material=material) for segment in scene.segments)
        return scene.unjudged(material=material, segments=segments)
    if first == "housing" and scene.housing is not None:
        housing = _stiffened(scene.housing, within, value)
        return housing and scene.unjudged(housing=housing)
    if first != "bearing":
        return None
    index, *within = within
    bearings = list(scene.bearings)
    bearing = bearings[int(index)]
    if within[0] == "housing":
        housing = _stiffened(bearing.housing, within[1:], value)
        changed = housing and bearing.with_changes(housing=housing)
    else:
        changed = _stiffened(bearing, within, value)
    if changed is None:
        return None
    bearings[int(index)] = changed
    return scene.unjudged(bearings=tuple(bearings))


def _stiffened(thing: Any, keys: Sequence[str | int], value: float) -> Any:
    """Return a bearing or housing with an entry of its matrix, and the mirrored one, changed; None
    for other entries.
    """
    if keys[0] == "stiffness":
        row, column, _ = STIFFNESS_NAMES[str(keys[1])]
    elif keys[0] == "matrix":
        row, column = map(int, keys[1:])
    else:
        return None
    matrix = np.array(thing.matrix)
    matrix[row, column] = matrix[column, row] = value
    return thing.with_changes(matrix=matrix)


def _read_again(tables: Tables, scene: Scene, where: str) -> Scene:
    """Return the scene of tables, with catalogue bearings as stiff as in another scene."""
    changed = scene_of(dict(tables), where, part_of)
    if all(bearing.catalogue is None for bearing in scene.bearings):
        return changed
    bearings = tuple(
        new if new.catalogue is None else new.with_changes(matrix=old.matrix)
        for new, old in zip(changed.bearings, scene.bearings)
    )
    return changed.with_changes(bearings=bearings)
