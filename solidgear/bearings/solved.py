"""Scenes with catalogue bearings: the stiffness of each, at a given load or in equilibrium.

A preload of two single bearings that hold a shaft against each other is stated once and holds for
both.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from solidgear.bearings.balance import Linear, Mounted
from solidgear.bearings.catalogue import Catalogue, Preload, catalogue_of
from solidgear.bearings.catalogued import Catalogued, End, catalogued, state
from solidgear.bearings.equilibrium import Equilibrium, equilibrium
from solidgear.core import Bearing, Scene, SceneError, SolidgearError, listed
from solidgear.core.scene import Lubrication
from solidgear.core.scene.acting import own_weight, station_loads, weights_of_masses
from solidgear.core.scene.load_rules import named_case

if TYPE_CHECKING:
    from solidgear.core import Body


@dataclass(frozen=True)
class Choice:
    """Place in the ranges of catalogue data at which a solution is taken."""

    end: End = "middle"  #: of an estimated inner geometry
    clearance: float = 0.5  #: place in the range of a clearance class, 0 to 1
    #: preload, load: factors on the values of the scene
    preload: float = 1.0
    load: float = 1.0
    #: choices for single bearings by name, but for the load
    overrides: Mapping[str, Choice] = field(default_factory=dict)


AS_STATED = Choice()


@dataclass(frozen=True)
class Solved:
    """A scene whose catalogue bearings have their stiffness."""

    scene: Scene  #: with a 6x6 for every bearing
    made: dict[str, Catalogued]  #: bearings of catalogue data by name
    #: motion of the inner ring of each at which the stiffness is taken
    motion: dict[str, np.ndarray]
    #: of shaft and bearings, where the scene has a load of its own
    equilibrium: Equilibrium | None = None


def waiting(scene: Scene) -> tuple[str, ...]:
    """Return names of the bearings that wait for the load that the shaft brings them."""
    if not scene.is_loaded:
        return ()
    return tuple(
        b.name
        for b in scene.bearings
        if b.catalogue is not None and b.catalogue.load is None and b.catalogue.displacement is None
    )


def wants_equilibrium(scene: Scene) -> bool:
    """Return whether a bearing of the scene waits for the load that the shaft brings."""
    return bool(waiting(scene))


def solved(
    scene: Scene,
    body: Body | None = None,
    choice: Choice = AS_STATED,
    start: Equilibrium | None = None,
    speed: float | None = None,
) -> Solved:
    """Return the stiffness of every catalogue bearing of a scene, under the loads of the bearings,
    or those of the shaft in the first case; at the speed of that case, or at another one of the
    shaft, rad/s.

    Without a body, bearings that wait for the load of the shaft are taken at rest; the search
    begins at the equilibrium `start`. Refused are data that make no bearing, loads that one cannot
    carry, and bearings that hold nothing.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/gearbox_catalogue.toml")
    >>> found = solved(scene, sg.build(scene, "timoshenko"))
    >>> carried = found.equilibrium.load  # all that [load] says, in N
    >>> round(float(sum(load[2] for load in carried.values())), 6)
    1400.0
    """
    places = {b.name: k for k, b in enumerate(scene.bearings) if b.catalogue is not None}
    bearings_made = catalogued_bearings(scene, choice, speed or named_case(scene.cases).speed)
    settled = None
    if body is not None and wants_equilibrium(scene):
        loads = {name: choice.load * six for name, six in station_loads(scene).items()}
        falling = None
        if scene.weight is not None:
            falling = own_weight(scene)
            for name, six in weights_of_masses(scene).items():
                loads[name] = loads.get(name, np.zeros(6)) + six
        around = scene.housing or scene.housing_axial
        on_bearings = mounted(scene, bearings_made)
        try:
            settled = equilibrium(body, on_bearings, loads, around, start, falling)
        except SolidgearError as error:
            raise SolidgearError(f"{error}{_unused_ribs(scene)}") from None
    motion, tangent = {}, {}
    for name, k in places.items():
        data = catalogue_of(scene.bearings[k])
        assert data is not None
        bearing = bearings_made[name].bearing
        waits = settled is not None and data.load is None and data.displacement is None
        if waits and settled:
            motion_here, tangent[name] = settled.relative[name], settled.tangent[name]
        else:
            try:
                motion_here = state(data, bearings_made[name], choice.load)
            except SceneError as error:
                raise located(error, k) from None
            tangent[name] = bearing.tangent(motion_here)
        motion[name] = bearing.ring_motion(motion_here)
        if not tangent[name].any() and not waits:
            once = " (once for both of a pair)" * data.one_sided
            reason = (
                "the bearing carries no load, so it has no stiffness: give it load or "
                f"displacement, a preload{once}, a negative clearance, or the port a load"
            )
            raise located(SceneError(reason), k)
    bearings = tuple(_with_stiffness(b, tangent) for b in scene.bearings)
    # a stiffness bears on nothing else of a sound scene
    return Solved(scene.unjudged(bearings=bearings), bearings_made, motion, settled)


def _unused_ribs(scene: Scene) -> str:
    """Return the end of a sentence on ribs that could hold the shaft; empty where there are none."""
    names = [
        repr(b.name)
        for b in scene.bearings
        if (data := catalogue_of(b)) is not None and data.ribs == "one way" and data.floats
    ]
    if not names:
        return ""
    return f'; one rib of {listed(names)} would hold it one way: write holds = "+y" or "-y" there'


def speed_of_bearing(data: Catalogue, oil: Lubrication | None, shaft: float | None) -> float:
    """Return the speed at which a bearing turns, rad/s, 0 where none is known: that of the shaft in a
    case or at an operating point, else that of its data, else that of the lubrication.
    """
    return shaft or data.speed or (oil.speed if oil else None) or 0.0


def catalogued_bearings(
    scene: Scene, choice: Choice = AS_STATED, speed: float | None = None
) -> dict[str, Catalogued]:
    """Return bearings of a scene that catalogue data describe, by name, where a case gives the shaft
    a speed, rad/s; a preload that is stated for one of a pair holds for both.
    """
    places = {b.name: k for k, b in enumerate(scene.bearings) if b.catalogue is not None}

    def make(name: str, preload_source: str, preload: Preload | None = None) -> Catalogued:
        bearing = scene.bearings[places[name]]
        choice_here, data = choice.overrides.get(name, choice), catalogue_of(bearing)
        assert data is not None
        data = data.at_speed(speed_of_bearing(data, scene.lubrication, speed))
        try:
            return catalogued(
                data if preload is None else data.with_changes(preload=preload),
                choice_here.end,
                clearance_share=choice_here.clearance,
                preload_factor=choice.overrides.get(preload_source, choice).preload,
                floats=bearing.support == "floating",
            )
        except SceneError as error:
            raise located(error, places[name]) from None

    preloads: dict[str, tuple[str, Preload | None]] = {name: (name, None) for name in places}
    for name, giver in partners(scene).items():
        data = scene.bearings[places[giver]].catalogue
        assert data is not None and data.preload is not None
        first, second = data.preload, data.preload
        if data.preload.displacement is not None:
            displacement = data.preload.displacement
            first, second = divided(
                displacement, partial(make, giver, giver), partial(make, name, giver)
            )
        preloads |= {giver: (giver, first), name: (giver, second)}
    return {name: make(name, source, preload) for name, (source, preload) in preloads.items()}


def located(error: SceneError, index: int) -> SceneError:
    """Return the same error under the key of a bearing of a file."""
    return SceneError.of(
        problem.located(None, path=("bearing", index, "catalogue", *problem.path))
        for problem in error.problems
    )


def _with_stiffness(bearing: Bearing, tangent: Mapping[str, np.ndarray]) -> Bearing:
    if bearing.name not in tangent:
        return bearing
    stiffness = tangent[bearing.name]
    # friction at speed leaves a part that is no spring
    return bearing.with_changes(matrix=(stiffness + stiffness.T) / 2)


def mounted(scene: Scene, catalogued: Mapping[str, Catalogued]) -> list[Mounted]:
    """Return bearings of a scene as the equilibrium takes them."""
    out = []
    for bearing in scene.bearings:
        if bearing.name not in catalogued:
            out.append(Mounted(bearing.name, Linear(np.array(bearing.stiffness))))
            continue
        bearing_data, spring = catalogued[bearing.name].bearing, bearing.spring
        out.append(Mounted(bearing.name, bearing_data, spring=spring, housing=bearing.housing))
    return out


#: of a displacement, to which both rows press alike
ALIKE = 1e-9
#: makes a row under a preload
Press = Callable[[Preload], Catalogued]


def partners(scene: Scene) -> dict[str, str]:
    """Return, by the name of each bearing that takes a preload from another, the name of that one:
    the nearest that holds the shaft the other way and has a preload that no other such row has as
    well.
    """
    rows = [
        (b, b.catalogue)
        for b in scene.bearings
        if b.catalogue is not None and b.catalogue.faces_one_way
    ]
    pressed = [(b, data.holds) for b, data in rows if data.preload is not None]
    free = [
        (b, data.holds)
        for b, data in rows
        if data.preload is None and data.load is None and data.displacement is None and not b.floats
    ]
    for bearing, way in [*pressed]:  # those of a pair that are told both
        if (bearing, way) in pressed and (partner := _nearest(bearing, way, pressed)) is not None:
            pressed.remove((bearing, way))
            pressed = [entry for entry in pressed if entry[0] is not partner]
    out: dict[str, str] = {}
    for bearing, way in pressed:
        if (partner := _nearest(bearing, way, free)) is not None:
            free = [entry for entry in free if entry[0] is not partner]
            out[partner.name] = bearing.name
    return out


def _nearest(
    bearing: Bearing, way: str | None, rows: Sequence[tuple[Bearing, str | None]]
) -> Bearing | None:
    """Return the nearest row that holds the shaft the other way; None where there is none."""
    opposite = [b for b, row_way in rows if b is not bearing and row_way != way]
    return min(opposite, key=lambda b: abs(b.y - bearing.y), default=None)


def divided(displacement: float, first: Press, second: Press) -> tuple[Preload, Preload]:
    """Return displacements of two rows with a given sum, m, under which both press alike."""
    from scipy.optimize import brentq  # slow to import, and seldom needed

    def preloads(share: float) -> tuple[Preload, Preload]:
        of_first, of_second = (part * displacement for part in (share, 1 - share))
        return Preload(displacement=of_first), Preload(displacement=of_second)

    def difference(share: float) -> float:
        rows = (press(preload) for press, preload in zip((first, second), preloads(share)))
        force_first, force_second = (abs(float(row.bearing.load(np.zeros(6))[1])) for row in rows)
        return force_first - force_second

    return preloads(float(brentq(difference, 0.0, 1.0, xtol=ALIKE)))
