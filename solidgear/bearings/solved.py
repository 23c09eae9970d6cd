"""Scenes with catalogue bearings: the stiffness of each, at its own load or in equilibrium."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from solidgear.bearings.balance import Linear, Mounted
from solidgear.bearings.catalogued import Catalogued, End, catalogued, state
from solidgear.bearings.equilibrium import Equilibrium, equilibrium
from solidgear.bearings.pairs import divided, partners
from solidgear.errors import SceneError
from solidgear.scene import Scene
from solidgear.scene.catalogue import Preload

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.scene import Bearing


@dataclass(frozen=True)
class Choice:
    """Place in the ranges of catalogue data at which a solution is taken."""

    end: End = "middle"  #: of an estimated inner geometry
    clearance: float = 0.5  #: place in the range of a clearance class, 0 to 1
    #: preload, load: times what the scene says
    preload: float = 1.0
    load: float = 1.0
    #: those of single bearings by name, but for the load
    apart: Mapping[str, Choice] = field(default_factory=dict)


AS_TOLD = Choice()


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
    """Names of the bearings that wait for the load that the shaft brings them."""
    if scene.load is None:
        return ()
    return tuple(
        b.name
        for b in scene.bearings
        if b.catalogue is not None and b.catalogue.load is None and b.catalogue.displacement is None
    )


def wants_equilibrium(scene: Scene) -> bool:
    """True where a bearing of the scene waits for the load that the shaft brings."""
    return bool(waiting(scene))


def solved(
    scene: Scene,
    body: Body | None = None,
    choice: Choice = AS_TOLD,
    start: Equilibrium | None = None,
) -> Solved:
    """Stiffness of every catalogue bearing of a scene.

    Parameters
    ----------
    scene : Scene
        Loads are those of its bearings, or its own at the port.
    body : Body, optional
        The shaft; without one, bearings that wait for its load are taken at rest.
    start : Equilibrium, optional
        To begin at.

    Raises
    ------
    SceneError
        Data that make no bearing, loads that one cannot carry, and bearings that hold nothing.

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
    made = made_of(scene, choice)
    settled = None
    if body is not None and scene.load is not None and wants_equilibrium(scene):
        loads = {scene.port.name: choice.load * np.array(scene.load.six)}
        around = scene.housing or scene.housing_axial
        settled = equilibrium(body, mounted(scene, made), loads, around, start)
    motion, tangent = {}, {}
    for name, k in places.items():
        data = scene.bearings[k].catalogue
        assert data is not None
        waits = settled is not None and data.load is None and data.displacement is None
        try:
            at = (
                settled.relative[name]
                if waits and settled
                else state(data, made[name], choice.load)
            )
        except SceneError as error:
            raise located(error, k) from None
        motion[name] = made[name].bearing.seen(at)
        tangent[name] = made[name].bearing.tangent(at)
        if not tangent[name].any() and not waits:
            once = " (once for both of a pair)" * data.one_sided
            reason = (
                f"without load a bearing has no stiffness: give load or displacement, a preload{once}, "
                "a negative clearance, or a [load] on the port"
            )
            raise located(SceneError(reason), k)
    bearings = tuple(_with(b, tangent) for b in scene.bearings)
    return Solved(scene.with_changes(bearings=bearings), made, motion, settled)


def made_of(scene: Scene, choice: Choice = AS_TOLD) -> dict[str, Catalogued]:
    """Bearings of a scene that catalogue data describe, by name; a preload that one of a pair is told is
    of both.
    """
    places = {b.name: k for k, b in enumerate(scene.bearings) if b.catalogue is not None}

    def make(name: str, of: str, preload: Preload | None = None) -> Catalogued:
        bearing = scene.bearings[places[name]]
        own, data = choice.apart.get(name, choice), bearing.catalogue
        assert data is not None
        try:
            return catalogued(
                data if preload is None else data.with_changes(preload=preload),
                own.end,
                clearance_share=own.clearance,
                preload_factor=choice.apart.get(of, choice).preload,
                floats=bearing.support == "floating",
            )
        except SceneError as error:
            raise located(error, places[name]) from None

    told: dict[str, tuple[str, Preload | None]] = {name: (name, None) for name in places}
    for name, giver in partners(scene).items():
        data = scene.bearings[places[giver]].catalogue
        assert data is not None and data.preload is not None
        first, second = data.preload, data.preload
        if data.preload.displacement is not None:
            rows = partial(make, giver, giver), partial(make, name, giver)
            first, second = divided(data.preload.displacement, *rows)
        told |= {giver: (giver, first), name: (giver, second)}
    return {name: make(name, *own) for name, own in told.items()}


def located(error: SceneError, index: int) -> SceneError:
    """The same error under the key of a bearing of a file."""
    return SceneError.of(
        one.located(None, path=("bearing", index, "catalogue", *one.path)) for one in error.problems
    )


def _with(bearing: Bearing, tangent: Mapping[str, np.ndarray]) -> Bearing:
    if bearing.name not in tangent:
        return bearing
    stiffness = tangent[bearing.name]
    # friction at speed leaves a part that is no spring
    return bearing.with_changes(matrix=(stiffness + stiffness.T) / 2)


def mounted(scene: Scene, made: Mapping[str, Catalogued]) -> list[Mounted]:
    """Bearings of a scene as the equilibrium takes them."""
    out = []
    for bearing in scene.bearings:
        if bearing.name not in made:
            out.append(Mounted(bearing.name, Linear(np.array(bearing.stiffness))))
            continue
        own, spring = made[bearing.name].bearing, bearing.spring
        out.append(Mounted(bearing.name, own, spring=spring, housing=bearing.housing))
    return out
