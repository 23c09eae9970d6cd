"""Sentences on bearings beside the table of their stiffness: their designation and their load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi
from typing import Any

from solidgear.show.units import Units
from solidgear.show.words import is_number

#: of a load, in its order, with their units
LOADS = {"x": "N", "y": "N", "z": "N", "thx": "N m", "thz": "N m"}


def load_row(scene: Mapping[str, Any], units: Units) -> list[list[str]]:
    """The load under which catalogue bearings have their stiffness, as a row; none without one."""
    told = loads(scene.get("load") or {}, units)
    return [["load at the lumped point", f"{told}; bearings are taken under it"]] if told else []


def speed_row(scene: Mapping[str, Any]) -> list[list[str]]:
    """The speed at which lives are told where a bearing has none of its own, as a row."""
    speed = (scene.get("lubrication") or {}).get("speed")
    return [["speed of the shaft", f"{30 / pi * speed:.6g} rpm"]] if is_number(speed) else []


def loads(load: Mapping[str, Any], units: Units) -> str:
    """A load in words: forces and moments that are there."""
    there = {name: load.get(name) for name in LOADS if is_number(load.get(name)) and load[name]}
    return ", ".join(
        f"{name} {units.given(value, LOADS[name])} {units.unit(LOADS[name])}"
        for name, value in there.items()
    )


def catalogue(data: Mapping[str, Any] | None, units: Units) -> str:
    """Designation, dimensions and load of a bearing from its catalogue data in a record; nothing
    for a given 6x6.
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
    own = loads(data.get("load") or {}, units)
    if own:
        words.append(f"under {own}")
    return ", ".join(words) + "."


def without_column(bearings: Sequence[Mapping[str, Any]], shown: Sequence[tuple[int, int]]) -> str:
    """Sentence that names the bearings with entries beside those `shown`, by their places; empty
    where there are none. K_x,thz stands with K_z,thx where one is the other turned.
    """
    names = [f"'{b.get('name', '')}'" for b in bearings if not b.get("hold") and _more(b, shown)]
    if not names:
        return ""
    return (
        f"Entries without a column, couplings among them, has the 6x6 of {', '.join(names)}; "
        "results.json has all of them, in SI."
    )


def _more(bearing: Mapping[str, Any], shown: Sequence[tuple[int, int]]) -> bool:
    stiffness = bearing.get("stiffness") or []
    if len(stiffness) != 6:
        return False
    turned = stiffness[0][5] == -stiffness[2][3]
    known = {*shown, *((j, i) for i, j in shown)} | ({(0, 5), (5, 0)} if turned else set())
    return any(stiffness[i][j] for i in range(6) for j in range(6) if (i, j) not in known)
