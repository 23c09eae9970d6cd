"""Ranges of the entries of a scene: the table ``[uncertain]`` of a file.

A path of the file names an entry, a text gives the range: ``"material.E" = "206 GPa ± 3 %"``,
``"bearing.A.stiffness.kxx" = "3e8 N/m : 6e8 N/m"``, ``"load" = "0.2 : 1.2"``. Ranges are kept as
factors, so that they stay with a scene that is changed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from solidgear.core.errors import SceneError, show
from solidgear.core.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.core.scene.open_range import FACTOR, Uncertain, range_ends
from solidgear.core.scene.typed import Problems

if TYPE_CHECKING:
    from solidgear.core.scene.model import Scene
    from solidgear.core.scene.parts import Segment
    from solidgear.core.scene.stations import Bearing

#: range of a bearing with the status "assumed" where the file states none: a factor two each way
ASSUMED = "0.5 : 2"
#: entries of loads that may have a range, with their dimensions
LOAD_UNITS = dict.fromkeys(("x", "y", "z", "tangential_force", "radial", "axial"), "load")
LOAD_UNITS |= dict.fromkeys(("thx", "thz", "torque"), "torque")
_KNOWN = (
    "a range may have material.E, material.density, segment.NAME.material.E, load, load.z, "
    "load.NAME.torque, housing, bearing.NAME.stiffness, bearing.NAME.stiffness.kxx or bearing.NAME.catalogue.preload"
)


def with_ranges(
    scene: Scene, table: Mapping[str, Any], bearings: Sequence[Mapping[str, Any]] = ()
) -> Scene:
    """Return a scene with ranges: those of a table of texts by path, nested or not, and of bearings
    whose tables have the status assumed.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = with_ranges(sg.load("geometry/shaft_stepped.toml"), {"material.E": "± 3 %"})
    >>> scene.uncertain[0].low, scene.uncertain[0].high
    (0.97, 1.03)
    """
    texts: dict[str, Any] = {
        f"bearing.{bearing['name']}.stiffness": ASSUMED
        for bearing in bearings
        if bearing.get("status") == "assumed" and ("stiffness" in bearing or "matrix" in bearing)
    }
    file_texts = dict(_flat(table))
    for path in file_texts:  # the file states the range of the bearing or of an entry of it
        head, part, _ = path.partition(".stiffness")
        texts.pop(head + part, None)
    problems = Problems()
    ranges = [
        problems.read(partial(_read, scene, path, text), ("uncertain", path))
        for path, text in {**texts, **file_texts}.items()
    ]
    problems.raise_any()
    return scene.unjudged(uncertain=tuple(ranges)) if ranges else scene


def with_scaled_entry(scene: Scene, path: str, factor: float) -> Scene:
    """Return the scene with the entry of a path multiplied; factors of all loads and of preloads are
    not part of a scene (:class:`solidgear.bearings.solved.Choice`).
    """
    kind, _, name = path.partition(".")
    if kind == "material":
        constant = getattr(scene.material, name) * factor
        return scene.with_changes(material=scene.material.with_changes(**{name: constant}))
    if kind == "segment":
        return scene.with_changes(segments=tuple(_of_segments(scene, path, factor)))
    if kind == "housing":
        housing, axial = scene.housing, scene.housing_axial
        return scene.with_changes(
            housing=housing and housing.scaled(factor), housing_axial=axial and axial * factor
        )
    if kind == "load":
        return _with_scaled_load(scene, path, factor)
    bearing, key = _bearing(scene, path)
    return scene.with_changes(
        bearings=tuple(_scaled(b, key, factor) if b is bearing else b for b in scene.bearings)
    )


def _with_scaled_load(scene: Scene, path: str, factor: float) -> Scene:
    """Return the scene with an entry of a load multiplied."""
    load, name = _load(scene, path)
    assert load is not None
    changed = load.with_changes(**{name: getattr(load, name) * factor})
    if load is scene.load:
        return scene.with_changes(load=changed)
    loads = tuple(changed if each is load else each for each in scene.loads)
    return scene.with_changes(loads=loads)


def _load(scene: Scene, path: str) -> tuple[Any, str]:
    """Return the load of a path ``load.z`` or ``load.NAME.torque``, and its entry."""
    name, _, key = path.removeprefix("load.").rpartition(".")
    if not name:
        return scene.load, key
    return next((load for load in scene.loads if load.name == name), None), key


def _of_segments(scene: Scene, path: str, factor: float = 1.0) -> Iterator[Segment]:
    """Yield all segments, those of a path ``segment.NAME.material.E`` with the constant multiplied."""
    name, _, constant = path.removeprefix("segment.").rpartition(".material.")
    for segment in scene.segments:
        material = segment.material
        if _is_of(segment, name):
            value = getattr(material, constant) * factor
            segment = segment.with_changes(material=material.with_changes(**{constant: value}))
        yield segment


def _is_of(segment: Segment, name: str) -> bool:
    """Return True for a segment of the named shape of a file, which may have several."""
    return segment.name == name or segment.name.startswith(f"{name}.")


def _scaled(bearing: Bearing, key: str, factor: float) -> Bearing:
    name = key.removeprefix("stiffness").removeprefix(".")
    if not name:
        return bearing.scaled(factor)
    i, j, _ = STIFFNESS_NAMES[name]
    rows = [list(row) for row in bearing.matrix or ()]
    rows[i][j] *= factor
    rows[j][i] = rows[i][j]
    return bearing.with_changes(matrix=rows)


def _flat(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping) and {*value} != {"range", "factors"}:
            yield from _flat(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value


def _bearing(scene: Scene, path: str) -> tuple[Bearing | None, str]:
    """Return the bearing of a path, and the remainder of the path."""
    for bearing in scene.bearings:
        prefix = f"bearing.{bearing.name}."
        if path.startswith(prefix):
            return bearing, path.removeprefix(prefix)
    return None, ""


def written_range(scene: Scene, entry: Uncertain) -> Any:
    """Return the range of an entry as a file gives it: its words, and the factors as well where the
    value has been changed since.
    """
    try:
        if _read(scene, entry.path, entry.said) == entry:
            return entry.said
    except SceneError:
        pass  # the words do not contain the new value
    return {"range": entry.said, "factors": [entry.low, entry.high]}


def _read(scene: Scene, path: str, text: Any) -> Uncertain:
    value, dimension = _entry(scene, path)
    factors = None
    if isinstance(text, Mapping):
        text, factors = text["range"], text["factors"]
    if not isinstance(text, str):
        raise SceneError('must be a text such as "± 3 %" or "0.5 : 2"', value=show(text))
    if factors is None:
        factors = [end / value for end in range_ends(text, value, dimension)]
    elif not (isinstance(factors, list) and len(factors) == 2 and {*map(type, factors)} == {float}):
        raise SceneError("must be two numbers: the ends over the value", path=("factors",))
    low, high = sorted(factors)
    if not 0 < low <= 1 + 1e-9 or not high >= 1 - 1e-9 or not low < high:
        nominal = "1" if dimension == FACTOR else f"{value:.6g} in SI"
        raise SceneError(
            f"must be a range above zero that contains the scene's value, {nominal}",
            value=show(text),
        )
    return Uncertain(path=path, said=text, low=low, high=high)


def _entry(scene: Scene, path: str) -> tuple[float, str]:
    """Return the value of an entry, SI, and its dimension; 1 for entries multiplied as a whole."""
    value, dimension = None, FACTOR
    if path in ("material.E", "material.density"):
        name = path.removeprefix("material.")
        value = getattr(scene.material, name)
        dimension = "pressure" if name == "E" else "density"
    elif path.startswith("segment.") and path.endswith((".material.E", ".material.density")):
        shape, _, name = path.removeprefix("segment.").rpartition(".material.")
        materials = [s.material for s in scene.segments if _is_of(s, shape)]
        value = getattr(materials[0], name) if materials else None
        dimension = "pressure" if name == "E" else "density"
    elif path == "housing" and (scene.housing or scene.housing_axial):
        value = 1.0
    elif path == "load" and (scene.is_loaded or any(b.catalogue for b in scene.bearings)):
        value = 1.0
    elif path.startswith("load.") and scene.is_loaded:
        load, name = _load(scene, path)
        if name in LOAD_UNITS and load is not None:
            value, dimension = getattr(load, name, None), LOAD_UNITS[name]
    else:
        bearing, key = _bearing(scene, path)
        name = key.removeprefix("stiffness.")
        data = bearing.catalogue if bearing else None
        if bearing and data is None and not bearing.hold and key == "stiffness":
            value = 1.0
        elif bearing and data is None and not bearing.hold and name in STIFFNESS_NAMES:
            i, j, dimension = STIFFNESS_NAMES[name]
            value = (bearing.matrix or ())[i][j]
        elif data is not None and data.preload is not None and key == "catalogue.preload":
            value = data.preload.force or data.preload.displacement
            dimension = "load" if data.preload.force else "length"
    if not isinstance(value, float) or value == 0:
        raise SceneError(f"this entry cannot have a range here; {_KNOWN}")
    return value, dimension
