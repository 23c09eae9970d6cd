"""What the numbers of a data sheet assume, and why a section of it is left out."""

from __future__ import annotations

from collections.abc import Iterator

from solidgear.bearings.catalogue import catalogue_of
from solidgear.core import OpenNumbers, Scene
from solidgear.core.scene.acting import loads_of
from solidgear.datasheet.facts import Remark, WorstNotch
from solidgear.strength.load import LoadsAlone
from solidgear.strength.stress.at_rest import StressAtRest


def assumed(scene: Scene, ranges: OpenNumbers) -> Iterator[Remark]:
    """Yield what the data of a shaft leave to be assumed."""
    data = {b.name: catalogue_of(b) for b in scene.bearings}
    estimated = [name for name, d in data.items() if d is not None and d.estimated]
    if estimated:
        yield Remark("assumed inside", {"names": tuple(estimated)})
    classes = [n for n, d in data.items() if d is not None and isinstance(d.clearance, str)]
    if classes:
        yield Remark("assumed clearance", {"names": tuple(classes)})
    stiffness = [b.name for b in scene.bearings if b.status == "assumed" and not b.hold]
    if stiffness:
        yield Remark("assumed stiffness", {"names": tuple(stiffness)})
    loads = loads_of(scene)
    angles = [load.name for load in loads if load.kind == "gear" and load.pressure_angle is None]
    if angles:
        yield Remark("assumed angle", {"names": tuple(angles)})
    belts = [load.name for load in loads if load.kind == "belt"]
    if belts:
        yield Remark("assumed belt", {"names": tuple(belts)})
    stated = [entry.path for entry in scene.uncertain]
    if stated:
        yield Remark("assumed ranges", {"names": tuple(stated)})
    if ranges.left_out:
        yield Remark("assumed without ranges")


def assumed_at_rest(stressed: StressAtRest, notch: WorstNotch | None) -> Iterator[Remark]:
    """Yield what stress at rest assumes."""
    unrated = [feature.name for shaft in stressed.shafts for feature in shaft.found.unrated]
    if unrated:
        yield Remark("assumed unrated", {"names": tuple(unrated)})
    names = () if notch is None else notch.assumed
    if factors := tuple(name for name in names if name.startswith("K")):
        yield Remark("assumed factors", {"names": factors})
    if len(factors) < len(names):
        yield Remark("assumed steady")
    loads = stressed.under
    if isinstance(loads, LoadsAlone) and not any(load.six[4] for load in loads.acting):
        yield Remark("assumed no torque")


def absent_notch(stressed: StressAtRest, notch: WorstNotch | None) -> dict[str, Remark]:
    """Return why no notch is rated, by section; empty where one is."""
    if notch is None:
        return {"notch": Remark("absent notch")}
    if notch.fatigue is None:
        weak = [name for shaft in stressed.shafts for name in shaft.weak]
        return {"notch": Remark("absent strength", {"names": tuple(dict.fromkeys(weak))})}
    return {}
