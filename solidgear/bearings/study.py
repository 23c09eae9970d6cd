"""Catalogue bearings of a scene: stiffness and contacts at their load, and stiffness over load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from solidgear.bearings.bearing_life import BearingLife, left_open, life_of
from solidgear.bearings.catalogue import Catalogue, catalogue_of
from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.row import Contacts
from solidgear.bearings.solved import AS_STATED, Choice, Solved, solved
from solidgear.core import Bearing, Body, Scene, SceneError, SolidgearError, show
from solidgear.core.plain import plain
from solidgear.core.scene import BearingLoad
from solidgear.core.scene.load_rules import named_case

#: why one row of a pair carries nothing
LOST = "any more: the pair has lost its preload"
#: why a stiffness has no range
ALL_GIVEN = "all inner dimensions are given"
#: soft and stiff ends of the estimated dimensions
ENDS = (Choice(end="softer"), Choice(end="stiffer"))
#: factors on the load of the scene
FACTORS = tuple(float(f) for f in np.geomspace(0.05, 2.0, 21))


@dataclass(frozen=True)
class BearingFacts:
    """One catalogue bearing at its load."""

    bearing: Bearing  #: with its stiffness there
    made: Catalogued  #: rows made from its data
    motion: np.ndarray  #: (6,) motion of its inner ring
    #: least and largest diagonal (6,) of the stiffness over the range of estimated dimensions; None
    #: where all inner dimensions are given
    spread: tuple[np.ndarray, np.ndarray] | None
    life: BearingLife

    @property
    def name(self) -> str:
        """Name of the bearing."""
        return self.bearing.name

    @property
    def data(self) -> Catalogue:
        """Catalogue data of the bearing."""
        data = catalogue_of(self.bearing)
        assert data is not None
        return data

    @property
    def called(self) -> str:
        """Designation, or else the kind in words."""
        return self.data.designation or self.data.kind.replace("_", " ")

    @property
    def stiffness(self) -> np.ndarray:
        """Tangent stiffness (6, 6) at the load."""
        return np.array(self.bearing.matrix)

    @property
    def load(self) -> np.ndarray:
        """Load (6,) of the shaft on the bearing, N and N m."""
        return self.made.bearing.load(self.motion)

    @property
    def rows(self) -> tuple[Contacts, ...]:
        """Contacts of rolling elements, row by row."""
        return self.made.bearing.contacts(self.motion)

    @property
    def inside(self) -> dict[str, float]:
        """Inner dimensions that it was solved with, SI."""
        inner = self.made.inside
        out = {
            "elements": inner.elements,
            "element_diameter": inner.diameter,
            "pitch_diameter": inner.pitch,
            "contact_angle": inner.angle,
        }
        if self.data.grooved:
            out |= dict(zip(("conformity_inner", "conformity_outer"), inner.conformity))
        if not self.data.balls:
            out["element_length"] = inner.length
        return out

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on rows that carry nothing."""
        bare = [k for k, row in enumerate(self.rows) if not row.load.any()]
        if len(bare) == len(self.rows):
            return ("it carries nothing: it has lost its load, and has no stiffness",)
        reason = "under this thrust" if self.data.own_rows > 1 else LOST
        return tuple(
            f"the row at the {'upper' if k else 'lower'} end of y carries nothing {reason}"
            for k in bare
        )

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        rows = [
            {
                "azimuth": row.azimuth,
                "load": row.load,
                "contact_angle": row.angle,
                "pressure_inner": row.inner,
                "pressure_outer": row.outer,
            }
            for row in self.rows
        ]
        data = {
            "name": self.name,
            "kind": self.data.kind,
            "designation": self.data.designation,
            "status": self.bearing.status,
            "support": self.bearing.support or None,
            "inside": self.inside,
            "estimated": self.made.estimated,
            "clearance": self.made.clearance,
            "load": self.load,
            "displacement": self.motion,
            "stiffness": self.stiffness,
            "spread": self.spread,
            "no_spread": ALL_GIVEN if self.spread is None else "",
            "rows": rows,
            "notes": self.notes,
            "life": self.life.as_dict(),
        }
        return plain(data)


def bearing_facts(
    scene: Scene, body: Body | None = None, speed: float | None = None
) -> list[BearingFacts]:
    """Compute every catalogue bearing of a scene at its load; `body` is the shaft, needed where
    bearings settle under the load, and `speed` that of the shaft, rad/s, in place of those of the
    first case, bearings and lubrication.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/gearbox_catalogue.toml")
    >>> facts = bearing_facts(scene, sg.build(scene, "timoshenko"))
    >>> [(fact.name, fact.data.kind, round(fact.life.life.basic / 1e9, 1)) for fact in facts]
    [('A', 'cylindrical', 13.7), ('B', 'angular_contact', 23.1)]
    """
    bearings = [b for b in scene.bearings if b.catalogue is not None]
    if not bearings:
        raise SolidgearError(
            f"{scene.name}: no bearing is described by catalogue data; write [bearing.catalogue] "
            "in place of [bearing.stiffness], as in geometry/gearbox_catalogue.toml"
        )
    speed = speed or named_case(scene.cases).speed
    unknown, corners = left_open([scene])
    choices = [AS_STATED, *corners]
    if any(data.estimated for data in map(catalogue_of, bearings) if data is not None):
        choices += [end for end in ENDS if end not in choices]
    states = [solved(scene, body, choice, speed=speed) for choice in choices]
    over_estimates = [states[choices.index(c)] for c in (AS_STATED, *ENDS) if c in choices]
    facts = []
    for bearing in bearings:
        name = bearing.name
        places = [(state.made[name], state.motion[name]) for state in states[: 1 + len(corners)]]
        made, motion = places[0]
        spread = None
        if made.estimated:
            # an even number of elements under the load is another bearing than an odd one: the
            # middle need not lie between
            diagonals = [np.diag(np.array(_named(s, name).matrix)) for s in over_estimates]
            spread = (np.min(diagonals, axis=0), np.max(diagonals, axis=0))
        life = life_of(bearing, scene.lubrication, unknown, speed, places)
        facts.append(BearingFacts(_named(states[0], name), made, motion, spread, life))
    return facts


def _named(solution: Solved, name: str) -> Bearing:
    return next(b for b in solution.scene.bearings if b.name == name)


@dataclass(frozen=True)
class OverLoad:
    """Stiffness of a bearing over the load."""

    factors: np.ndarray  #: (n,) on the load of the scene
    middle: np.ndarray  #: (n, 6) diagonal of its stiffness
    low: np.ndarray  #: its least value over the range of estimated dimensions
    high: np.ndarray  #: its largest


def over_load(
    scene: Scene,
    body: Body | None = None,
    factors: Sequence[float] = FACTORS,
    speed: float | None = None,
) -> dict[str, OverLoad]:
    """Compute the stiffness of every catalogue bearing at multiples of the load of the scene;
    `body` is the shaft, needed where bearings settle under the load, and `speed` that of the shaft,
    rad/s.
    """
    diagonals: dict[str, list] = {b.name: [] for b in scene.bearings if b.catalogue is not None}
    for end in (AS_STATED, *ENDS):
        start = None
        for factor in factors:
            state = solved(scene, body, replace(end, load=factor), start, speed)
            start = state.equilibrium
            for name, rows in diagonals.items():
                rows.append(np.diag(state.made[name].bearing.tangent(state.motion[name])))
    curves = {}
    for name, rows in diagonals.items():
        ends = np.reshape(rows, (-1, len(factors), 6))
        low, high = ends.min(axis=0), ends.max(axis=0)
        curves[name] = OverLoad(np.array(factors), ends[0], low, high)
    return curves


def loaded_by(scene: Scene, load: str | Mapping[str, Any], bearing: str | None = None) -> Scene:
    """Return the scene under a load such as ``x=2 kN, z=-500 N``, or its components, on the port or on
    a bearing; refuse components that are none.
    """
    components = load if isinstance(load, Mapping) else _components(str(load))
    try:
        return _with_load(scene, BearingLoad(**components), bearing)
    except SceneError as error:
        raise SolidgearError(f"`load` {show(load)}: {error}") from None


def _components(text: str) -> dict[str, Any]:
    """Return the components of a load from ``x=2 kN, z=500``."""
    components: dict[str, Any] = {}
    for part in text.split(","):
        key, sep, value = (piece.strip() for piece in part.partition("="))
        if not sep or not value:
            raise SolidgearError(
                f'`load` {show(text)}: write components such as "x=2 kN, z=-500 N, thx=10 N*m"'
            )
        try:
            components[key] = float(value)
        except ValueError:
            components[key] = value
    return components


def _with_load(scene: Scene, load: BearingLoad, bearing: str | None) -> Scene:
    """Return the scene with a load on the port, or on the bearing of a name."""
    catalogues = {b.name: b.catalogue for b in scene.bearings if b.catalogue is not None}
    if bearing is None:
        catalogues = {name: data.with_changes(load=None) for name, data in catalogues.items()}
    elif bearing in catalogues:
        catalogues = {bearing: catalogues[bearing].with_changes(load=load, displacement=None)}
    else:
        raise SolidgearError(
            f"`name` {bearing}: no bearing of catalogue data has this name; known here: "
            f"{', '.join(catalogues) or 'none'}"
        )
    bearings = tuple(
        b.with_changes(catalogue=catalogues[b.name]) if b.name in catalogues else b
        for b in scene.bearings
    )
    on_port = {"load": load, "loads": (), "cases": ()} if bearing is None else {}
    return scene.with_changes(bearings=bearings, **on_port)
