"""Catalogue bearings of a scene: at their load, and over load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.row import Contacts
from solidgear.bearings.solved import Choice, Solved, solved
from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.scene import Bearing, BearingLoad, Scene
from solidgear.scene.catalogue import Catalogue

#: why one row of a pair carries nothing
LOST = "any more: the pair has lost its preload"
#: times the load that the scene says
FACTORS = tuple(float(f) for f in np.geomspace(0.05, 2.0, 21))


@dataclass(frozen=True)
class BearingFacts:
    """One catalogue bearing at its load."""

    bearing: Bearing  #: with its stiffness there
    made: Catalogued  #: its rows, by its data
    motion: np.ndarray  #: (6,) of its inner ring
    #: diagonal of the stiffness: least and largest of an estimated inside and its two ends
    spread: tuple[np.ndarray, np.ndarray] | None

    @property
    def name(self) -> str:
        """Of the bearing."""
        return self.bearing.name

    @property
    def data(self) -> Catalogue:
        """Of the catalogue."""
        assert self.bearing.catalogue is not None
        return self.bearing.catalogue

    @property
    def called(self) -> str:
        """Designation, or else its kind in words."""
        return self.data.designation or self.data.kind.replace("_", " ")

    @property
    def stiffness(self) -> np.ndarray:
        """Tangent (6, 6) there."""
        return np.array(self.bearing.matrix)

    @property
    def load(self) -> np.ndarray:
        """Load (6,) that the shaft puts on it, N and N m."""
        return self.made.bearing.load(self.motion)

    @property
    def rows(self) -> tuple[Contacts, ...]:
        """Contacts of its rolling elements, row by row."""
        return self.made.bearing.contacts(self.motion)

    @property
    def inside(self) -> dict[str, float]:
        """Inner geometry it was solved with, SI."""
        own = self.made.inside
        out = {
            "elements": own.elements,
            "element_diameter": own.diameter,
            "pitch_diameter": own.pitch,
            "contact_angle": own.angle,
        }
        if self.data.grooved:
            out |= dict(zip(("conformity_inner", "conformity_outer"), own.conformity))
        if not self.data.balls:
            out["element_length"] = own.length
        return out

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on rows that carry nothing."""
        bare = [k for k, row in enumerate(self.rows) if not row.load.any()]
        if len(bare) == len(self.rows):
            return ("it carries nothing: it has lost its load, and has no stiffness",)
        why = "under this thrust" if self.data.own_rows > 1 else LOST
        return tuple(
            f"the row at the {'upper' if k else 'lower'} end of y carries nothing {why}"
            for k in bare
        )


def bearing_facts(scene: Scene, body: Body | None = None) -> list[BearingFacts]:
    """Every catalogue bearing of a scene at its load; `body` is the shaft, where they wait for its
    load.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/gearbox_catalogue.toml")
    >>> facts = bearing_facts(scene, sg.build(scene, "timoshenko"))
    >>> [(fact.name, fact.data.kind, len(fact.rows)) for fact in facts]
    [('A', 'cylindrical', 1), ('B', 'angular_contact', 2)]
    """
    known = [b for b in scene.bearings if b.catalogue is not None]
    if not known:
        raise SolidgearError(
            f"{scene.name}: no bearing is described by catalogue data; write [bearing.catalogue] "
            "in place of [bearing.stiffness], as in geometry/gearbox_catalogue.toml"
        )
    middle = solved(scene, body)
    ends: dict[str, Solved] = {}
    if any(made.estimated for made in middle.made.values()):
        ends = {end: solved(scene, body, Choice(end=end)) for end in ("softer", "stiffer")}
    return [_facts(bearing.name, middle, ends) for bearing in known]


def _facts(name: str, found: Solved, ends: dict[str, Solved]) -> BearingFacts:
    bearing, made, spread = _named(found, name), found.made[name], None
    if made.estimated:
        # an even number of elements under the load is another bearing than an odd one: the middle
        # need not lie between
        all_three = [np.diag(np.array(_named(s, name).matrix)) for s in (found, *ends.values())]
        spread = (np.min(all_three, axis=0), np.max(all_three, axis=0))
    return BearingFacts(bearing, made, found.motion[name], spread)


def _named(found: Solved, name: str) -> Bearing:
    return next(b for b in found.scene.bearings if b.name == name)


@dataclass(frozen=True)
class OverLoad:
    """Stiffness of a bearing over the load."""

    factors: np.ndarray  #: (n,) times the load of the scene
    load: np.ndarray  #: (n, 6) on the bearing
    #: middle, low, high: (n, 6) diagonal of its stiffness, and its range by an estimated inside
    middle: np.ndarray
    low: np.ndarray
    high: np.ndarray


def over_load(
    scene: Scene, body: Body | None = None, factors: Sequence[float] = FACTORS
) -> dict[str, OverLoad]:
    """Stiffness of every catalogue bearing at so many times the load that the scene says; `body` is
    the shaft, where they wait for its load.
    """
    names = [b.name for b in scene.bearings if b.catalogue is not None]
    loads: dict[str, list] = {name: [] for name in names}
    found: dict[tuple[str, str], list] = {}
    for end in ("middle", "softer", "stiffer"):
        start = None
        for factor in factors:
            at = solved(scene, body, Choice(end=end, load=factor), start)
            start = at.equilibrium
            for name in names:
                stiffness = at.made[name].bearing.tangent(at.motion[name])
                found.setdefault((name, end), []).append(np.diag(stiffness))
                if end == "middle":
                    loads[name].append(at.made[name].bearing.load(at.motion[name]))
    curves = {}
    for name in names:
        ends = np.array([found[name, end] for end in ("middle", "softer", "stiffer")])
        at_load = np.array(loads[name])
        curves[name] = OverLoad(
            np.array(factors), at_load, ends[0], ends.min(axis=0), ends.max(axis=0)
        )
    return curves


def with_load(scene: Scene, load: dict[str, str | float], bearing: str | None) -> Scene:
    """A scene with another load of such components, on its port or on the bearing of a name."""
    new = BearingLoad(**load)
    if bearing is None:
        free = tuple(
            b
            if b.catalogue is None
            else b.with_changes(catalogue=b.catalogue.with_changes(load=None))
            for b in scene.bearings
        )
        return scene.with_changes(load=new, bearings=free)
    known = {b.name: b.catalogue for b in scene.bearings if b.catalogue is not None}
    if bearing not in known:
        raise SolidgearError(
            f"--bearing {bearing}: no bearing of catalogue data has this name; known here: "
            f"{', '.join(known) or 'none'}"
        )
    data = known[bearing].with_changes(load=new, displacement=None)
    changed = (b.with_changes(catalogue=data) if b.name == bearing else b for b in scene.bearings)
    return scene.with_changes(bearings=tuple(changed))
