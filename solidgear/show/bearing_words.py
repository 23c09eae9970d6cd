"""Sentences on bearings beside the table of their stiffness: their designation and their load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi
from typing import Any

from solidgear.show.units import Units
from solidgear.show.words import is_number

#: of a load, in its order, with their units
LOADS = {"x": "N", "y": "N", "z": "N", "thx": "N m", "torque": "N m", "thz": "N m"}
#: of six components
SIX = tuple(LOADS)


def load_row(scene: Mapping[str, Any], units: Units) -> list[list[str]]:
    """Return the loads under which catalogue bearings have their stiffness, as rows; none without
    one.
    """
    sentence = loads(scene.get("load") or {}, units)
    rows = [["load at the lumped point", sentence]] if sentence else []
    for load in scene.get("acting") or ():
        words = loads(dict(zip(SIX, load["load"])), units)
        rows.append([f"load {load['name']} at {load['station']}", words or "none"])
    if rows:
        rows[-1][1] += "; bearings have their stiffness under " + ("it" if sentence else "them")
    return rows


def speed_row(scene: Mapping[str, Any]) -> list[list[str]]:
    """Return the speed for lives where a bearing has none, as a row."""
    speed = (scene.get("lubrication") or {}).get("speed")
    return [["speed of the shaft", f"{30 / pi * speed:.6g} rpm"]] if is_number(speed) else []


def loads(load: Mapping[str, Any], units: Units) -> str:
    """Return a load in words: its nonzero forces and moments."""
    components = {
        name: load.get(name) for name in LOADS if is_number(load.get(name)) and load[name]
    }
    return ", ".join(
        f"{name} {units.given(value, LOADS[name])} {units.unit(LOADS[name])}"
        for name, value in components.items()
    )


def catalogue(data: Mapping[str, Any] | None, units: Units) -> str:
    """Return the designation, dimensions and load of a bearing from its catalogue data in a
    record; nothing for a given 6x6.
    """
    if not data:
        return ""
    length = units.unit("m")
    sizes = " x ".join(
        units.given(data.get(name), "m") for name in ("bore", "outer_diameter", "width")
    )
    name = data.get("designation") or str(data.get("kind", "")).replace("_", " ")
    words = [f"{name}, {sizes} {length}"]
    if data.get("arrangement") not in (None, "single"):
        words.append(str(data["arrangement"]).replace("_", " "))
    preload = data.get("preload") or {}
    if is_number(preload.get("force")):
        words.append(f"preload {units.given(preload['force'], 'N')} {units.unit('N')}")
    if is_number(preload.get("displacement")):
        words.append(f"preload {units.given(preload['displacement'], 'm')} {length}")
    clearance = data.get("clearance")
    if is_number(clearance) and clearance:
        words.append(f"clearance {units.given(clearance, 'm')} {length}")
    elif isinstance(clearance, str):
        words.append(f"clearance {clearance}")
    if is_number(data.get("speed")) and data["speed"]:
        words.append(f"at {30 / pi * data['speed']:.6g} rpm")
    load = loads(data.get("load") or {}, units)
    if load:
        words.append(f"under {load}")
    return ", ".join(words) + "."


def without_column(
    bearings: Sequence[Mapping[str, Any]], columns: Sequence[tuple[int, int]]
) -> str:
    """Return the sentence on bearings with further entries than `columns`; empty without any."""
    names = [f"'{b.get('name', '')}'" for b in bearings if not b.get("hold") and _more(b, columns)]
    if not names:
        return ""
    return f"Further entries of {', '.join(names)}, such as couplings, are in results.json, in SI."


def _more(bearing: Mapping[str, Any], columns: Sequence[tuple[int, int]]) -> bool:
    stiffness = bearing.get("stiffness") or []
    if len(stiffness) != 6:
        return False
    turned = stiffness[0][5] == -stiffness[2][3]
    covered = {*columns, *((j, i) for i, j in columns)} | ({(0, 5), (5, 0)} if turned else set())
    return any(stiffness[i][j] for i in range(6) for j in range(6) if (i, j) not in covered)
