"""Springs of a scene from changed tables of its file; no place along the shaft depends on them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from solidgear.core.errors import SceneError
from solidgear.core.scene.bearing_stiffness import refuse_two_stiffnesses
from solidgear.core.scene.housing import read_housing
from solidgear.core.scene.paths import Keys, Tables
from solidgear.core.scene.places import Places
from solidgear.core.scene.stations import Bearing

if TYPE_CHECKING:
    from solidgear.core.scene.model import Scene

_SPRINGS = ("stiffness", "matrix", "axial_series", "housing", "scale")


def resprung(scene: Scene, tables: Tables, touched: Iterable[Keys]) -> Scene:
    """Return a scene with the springs of bearings and housing of other tables, which differ from those
    of its file in the entries `touched`; refuse them as a file.
    """
    bearings = list(scene.bearings)
    changes: dict[str, Any] = {}
    for place in dict.fromkeys(keys[:2] if keys[0] == "bearing" else keys[:1] for keys in touched):
        if place == ("housing",):
            changes |= _housing(scene, tables["housing"])
            continue
        k = int(place[1])
        try:
            bearings[k] = _bearing(bearings[k], tables["bearing"][k])
        except SceneError as error:
            raise error.located(None, prefix=place) from None
    return scene.unjudged(bearings=tuple(bearings), **changes)


def _bearing(bearing: Bearing, table: Mapping[str, Any]) -> Bearing:
    """Return a bearing with the springs of a table."""
    refuse_two_stiffnesses(table)
    try:
        return bearing.with_changes(**{key: table[key] for key in _SPRINGS if key in table})
    except SceneError as error:
        problems = error.problems
        raise SceneError.of(
            problem.located(None, path=Bearing.key_path(problem.path, table))
            for problem in problems
        ) from None


def _housing(scene: Scene, table: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields of a scene for the housing of a table, at the place of the old one."""
    housing = scene.housing
    places = Places()
    places.datums["start"] = 0.0
    housing_table = {key: value for key, value in table.items() if key != "from"}
    if housing is not None:
        housing_table["position"] = housing.y
    try:
        support = read_housing(housing_table, places)
    except SceneError as error:
        raise error.located(None, prefix=("housing",)) from None
    axial = support if isinstance(support, float) else None
    return {"housing_axial": axial, "housing": None if axial is not None else support}
