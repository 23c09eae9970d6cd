"""Numbers of a shaft under its load in the rows of a sweep: deflection, bearings, stress."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from solidgear.bearings.bearing_life import life_of
from solidgear.bearings.duty import LivesOverPoints, PointLife
from solidgear.bearings.solved import solved
from solidgear.core import Scene, SolidgearError, build
from solidgear.core.loading import shaft
from solidgear.core.scene.closed_form import mass_properties
from solidgear.guards.one_shaft import ROUNDING, mass_of
from solidgear.strength.acting import FEW
from solidgear.strength.deflection.at_rest import Measured, deflection
from solidgear.strength.load import AT_REST
from solidgear.strength.stress.at_rest import stress_at_rest
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.variants.sweep.life_numbers import life_columns, life_numbers

#: kinds of numbers of a row, by the commands that show the same of one shaft
ANSWER, DEFLECTION, BEARING, STRESS = "answer", "deflect", "bearing", "stress"
ASKED = (ANSWER, DEFLECTION, BEARING, STRESS)
#: beginnings of columns of motions across the shaft, and their units
MOVED = {"deflection": "m moved", "slope": "rad moved"}
#: columns of loads of bearings, and their units
LOADS = {"radial": "N", "axial": "N", "moment": "N m"}
#: columns of the worst notch
FATIGUE, YIELD, WORST, LOCAL = "fatigue_safety", "yield_safety", "worst_notch", "notch_stress"
BAR = " bar"


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
        out |= {FATIGUE: float, f"{FATIGUE}{BAR}": float, YIELD: float}
        out |= {LOCAL: float, f"{LOCAL}{BAR}": float, WORST: str}
    return out


def places_of(scene: Scene) -> list[str]:
    """Return places of a shaft with columns of their motion, as columns spell them."""
    return [station.name.replace(" ", "_") for station in scene.stations]


def numbers_of(
    scene: Scene, ask: Sequence[str], model: str | None, tolerance: float | None
) -> dict[str, Any]:
    """Return the numbers of a shaft at rest by column, on a model or on the solid that has error
    bars within a tolerance.
    """
    out: dict[str, Any] = {}
    if DEFLECTION in ask:
        out |= _deflection(scene, model or JUDGE, tolerance)
    if BEARING in ask:
        out |= life_numbers(_lives(scene))
    if STRESS in ask:
        out |= _stress(scene, model or JUDGE)
    return out


def mass_alone(scene: Scene, model: str | None) -> tuple[float, float | None]:
    """Return the mass of a shaft without masses on it, kg, and its error bar: in closed form where
    there is one, else that of a mesh.
    """
    if scene.body is None and not scene.features:
        mass = mass_properties(scene.outline).mass
        return mass, ROUNDING * mass
    mass, bar = mass_of(scene, build(scene, model or JUDGE))
    return mass, bar and bar * mass


def _deflection(scene: Scene, model: str, tolerance: float | None) -> dict[str, Any]:
    solution = deflection(Assembly.of(scene, kept=FEW, tol=tolerance), AT_REST, model)
    out: dict[str, Any] = {}
    for place, (x, _, z, thx, _, thz) in solution.displacement.items():
        pairs = {"deflection": (x, z), "slope": (thx, thz)}
        for moved, pair in pairs.items():
            name = f"{moved}_{place.replace(' ', '_')}"
            out[name], out[f"{name}{BAR}"] = _across(pair)
    for bearing in solution.shafts[0].bearings:
        loads = bearing.radial, abs(float(bearing.load[1])), bearing.moment
        out |= {f"{bearing.name}.{load}": value for load, value in zip(LOADS, loads)}
    return out


def _across(pair: Sequence[Measured]) -> tuple[float, float | None]:
    """Return the size of a motion by its two components, and its error bar."""
    bars = [measure.bar for measure in pair if measure.bar is not None]
    value = math.hypot(*(measure.value for measure in pair))
    return value, math.hypot(*bars) if len(bars) == len(pair) else None


def _lives(scene: Scene) -> list[LivesOverPoints]:
    """Return the life of every catalogue bearing of a shaft under its load."""
    state = solved(scene, shaft(scene))
    lives = []
    for bearing in scene.bearings:
        if bearing.catalogue is not None:
            place = state.made[bearing.name], state.motion[bearing.name]
            life = life_of(bearing, scene.lubrication, "", None, [place])
            lives.append(LivesOverPoints(bearing.name, (PointLife("", life),)))
    if not lives:
        raise SolidgearError("no bearing is described by catalogue data, which a life needs")
    return lives


def _stress(scene: Scene, model: str) -> dict[str, Any]:
    """Return the least safeties of all notches, and the largest local stress."""
    (stressed,) = stress_at_rest(Assembly.of(scene, kept=FEW), AT_REST, model).shafts
    notches = stressed.found.worst
    if not notches:
        raise SolidgearError("no notch has a stress: the shaft has no fillets")
    largest = max(notches, key=lambda notch: notch.local.amplitude + abs(notch.local.mean))
    out: dict[str, Any] = {
        LOCAL: largest.local.amplitude + abs(largest.local.mean),
        f"{LOCAL}{BAR}": largest.local.amplitude_bar + largest.local.mean_bar,
        WORST: notches[0].name,
    }
    ratings = [notch.rating for notch in notches if notch.rating is not None]
    if ratings:
        worst = min(ratings, key=lambda rating: rating.fatigue)
        out |= {
            FATIGUE: worst.fatigue,
            f"{FATIGUE}{BAR}": worst.fatigue_bar,
            YIELD: min(rating.yielding for rating in ratings),
        }
    return out
