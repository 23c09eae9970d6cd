"""Numbers of a shaft under its load in the rows of a sweep: deflection, bearings, stress."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from solidgear.bearings.duty import LivesOverPoints, PointLife
from solidgear.bearings.solved import wants_equilibrium
from solidgear.bearings.study import bearing_facts
from solidgear.core import Scene, SolidgearError
from solidgear.core.ladder import solid_of
from solidgear.strength.deflection.at_rest import Measured, deflections
from solidgear.strength.load import AT_REST
from solidgear.strength.stress.at_rest import StressSettings, stress_at_rest
from solidgear.strength.stress.notch_tables import not_rated
from solidgear.strength.stress.rating import Rating
from solidgear.trains.assembly.assembly import NO_MODES, Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import ALONE
from solidgear.trains.load.lives import lives_in
from solidgear.trains.load.operation import Operating
from solidgear.trains.load.state import OperatingState
from solidgear.variants.sweep.life_numbers import life_columns, life_numbers

#: kinds of numbers of a row, by the commands that show the same of one shaft
ANSWER, DEFLECTION, BEARING, STRESS = "answer", "deflect", "bearing", "stress"
ASKED = (ANSWER, DEFLECTION, BEARING, STRESS)
#: beginnings of columns of motions across the shaft, and their units
MOVED = {"deflection": "m moved", "slope": "rad moved"}
#: columns of loads of bearings, and their units
LOADS = {"radial": "N", "axial": "N", "moment": "N m"}
#: columns of the worst notch: safeties, and with the least K_1 where none is known
FATIGUE, YIELD, CRACK = "fatigue_safety", "yield_safety", "crack_safety"
LEAST_FATIGUE, LEAST_YIELD = f"{FATIGUE}_least", f"{YIELD}_least"
SAFETIES = (FATIGUE, YIELD, CRACK, LEAST_FATIGUE, LEAST_YIELD)
WORST, LOCAL = "worst_notch", "notch_stress"
#: column of what has neither safety nor stress, such as sharp corners, which may be worse
NOT_RATED = "not_rated"
BAR = " bar"
#: a row has ratings, and the stress on fillets
RATED = StressSettings(surfaces=False)


def columns_of(scene: Scene, ask: Sequence[str], barred: bool) -> dict[str, type]:
    """Return names and types of the numbers of a shaft at rest, with error bars or without."""
    out: dict[str, type] = {}

    def add(name: str, with_bar: bool = True) -> None:
        out[name] = float
        if barred and with_bar:
            out[f"{name}{BAR}"] = float

    if DEFLECTION in ask:
        for place in places_of(scene):
            for moved in MOVED:
                add(f"{moved}_{place}")
        for bearing in scene.bearings:
            for load in LOADS:
                add(f"{bearing.name}.{load}", with_bar=False)
    if BEARING in ask:
        out |= life_columns(b.name for b in scene.bearings if b.catalogue is not None)
    if STRESS in ask:
        out |= dict.fromkeys(SAFETIES, float) | {f"{FATIGUE}{BAR}": float}
        out |= {LOCAL: float, f"{LOCAL}{BAR}": float, WORST: str, NOT_RATED: str}
    return out


def places_of(scene: Scene) -> list[str]:
    """Return places of a shaft with columns of their motion, as columns spell them."""
    return [station.name.replace(" ", "_") for station in scene.stations]


def numbers_of(
    scene: Scene, ask: Sequence[str], model: str | None, tolerance: float | str | None
) -> dict[str, Any]:
    """Return the numbers of a shaft at rest by column, on a model or on the solid that has error
    bars within a tolerance.
    """
    out: dict[str, Any] = {}
    if {DEFLECTION, BEARING} & {*ask}:
        assembly = Assembly.of(scene, kept=NO_MODES, tol=tolerance)
        if DEFLECTION in ask:
            out |= _deflection(assembly, model or solid_of(scene))
        if BEARING in ask:
            out |= life_numbers(_lives(assembly, model))
    if STRESS in ask:
        out |= _stress(scene, model or "")
    return out


def _points(assembly: Assembly) -> tuple[OperatingPoint, ...]:
    """Return the cases of the loads of a shaft, or its load alone."""
    return assembly.train.operation or (AT_REST,)


def _deflection(assembly: Assembly, model: str) -> dict[str, Any]:
    """Return motions and loads of bearings, the largest of all cases."""
    out: dict[str, Any] = {}
    for solution in deflections(assembly, _points(assembly), model):
        for place, (x, _, z, thx, _, thz) in solution.displacement.items():
            pairs = {"deflection": (x, z), "slope": (thx, thz)}
            for moved, pair in pairs.items():
                name = f"{moved}_{place.replace(' ', '_')}"
                value, bar = _across(pair)
                if value >= out.get(name, 0.0):
                    out |= {name: value, f"{name}{BAR}": bar}
        for bearing in solution.shafts[0].bearings:
            loads = bearing.radial, abs(float(bearing.load[1])), bearing.moment
            for load, value in zip(LOADS, loads):
                name = f"{bearing.name}.{load}"
                out[name] = max(value, out.get(name, 0.0))
    return out


def _across(pair: Sequence[Measured]) -> tuple[float, float | None]:
    """Return the size of a motion by its two components, and its error bar."""
    bars = [measure.bar for measure in pair if measure.bar is not None]
    value = math.hypot(*(measure.value for measure in pair))
    return value, math.hypot(*bars) if len(bars) == len(pair) else None


def _lives(assembly: Assembly, model: str | None) -> list[LivesOverPoints]:
    """Return the life of every catalogue bearing of a shaft in all cases of its loads, by default on
    the model that deflection trusts; under their own loads where none waits for that of the shaft.
    """
    scene = assembly.train.shafts[ALONE].scene
    if not wants_equilibrium(scene):
        lives = [fact.life for fact in bearing_facts(scene)]
        return [LivesOverPoints(life.name, (PointLife("", life),)) for life in lives]
    operating = Operating(assembly.settling(model), model) if model else Operating(assembly)
    states = list[OperatingState]()
    for point in _points(assembly):
        states.append(operating.at(point, states[-1] if states else None))
    return lives_in(assembly.train, [states])


def _stress(scene: Scene, model: str) -> dict[str, Any]:
    """Return the least safeties of all notches and the largest local stress, the worst of all cases."""
    assembly = Assembly.of(scene, kept=NO_MODES)
    out: dict[str, Any] = {}
    for point in _points(assembly):
        (stressed,) = stress_at_rest(assembly, point, model, RATED).shafts
        if not stressed.found.worst:
            raise SolidgearError("no notch has a stress: the shaft has no fillets or other notches")
        out[NOT_RATED] = "; ".join(not_rated(stressed.found))
        for fillet in stressed.found.notches:
            stress = fillet.local.amplitude + abs(fillet.local.mean)
            if stress >= out.get(LOCAL, 0.0):
                bar = fillet.local.amplitude_bar + fillet.local.mean_bar
                out |= {LOCAL: stress, f"{LOCAL}{BAR}": bar}
        for notch in stressed.found.worst:
            out.setdefault(WORST, notch.name)
            if notch.rating is not None:
                out |= lesser(out, notch.rating, notch.name)
    return out


def lesser(out: dict[str, Any], rating: Rating, name: str) -> dict[str, Any]:
    """Return the safeties of a notch that are less than those that are known."""
    less: dict[str, Any] = {}
    if rating.fatigue < out.get(FATIGUE, math.inf):
        less |= {FATIGUE: rating.fatigue, f"{FATIGUE}{BAR}": rating.fatigue_bar, WORST: name}
    others = {YIELD: rating.yielding, CRACK: rating.crack}
    if rating.least is not None:
        others |= dict(zip((LEAST_FATIGUE, LEAST_YIELD), rating.least))
    for column, safety in others.items():
        if safety is not None and safety < out.get(column, math.inf):
            less[column] = safety
    return less
