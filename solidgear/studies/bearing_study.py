"""Catalogue bearings of a scene: at their load, over load, and what their ranges leave open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from solidgear.bearings.bounds import Ranges, choices
from solidgear.bearings.row import Contacts
from solidgear.bearings.solved import Choice, Solved, solved, wants_equilibrium
from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.scene import Scene
from solidgear.solve.modes import modes
from solidgear.studies.loading import SHAFT

#: times the load that the scene says
FACTORS = tuple(float(f) for f in np.geomspace(0.05, 2.0, 21))


@dataclass(frozen=True)
class BearingFacts:
    """One catalogue bearing at its load.

    Attributes
    ----------
    inside : dict
        Inner geometry it was solved with, SI.
    estimated : tuple of str
        What of it was not given.
    clearance : float
        Radial, at work, m.
    load, motion : (6,) ndarray
        What the shaft puts on it, and the motion of its inner ring.
    stiffness : (6, 6) ndarray
    spread : (ndarray, ndarray) or None
        Diagonal of the stiffness: least and largest of an estimated inside and its two ends.
    notes : tuple of str
        What is to be said of it, one sentence each.
    """

    name: str
    kind: str
    designation: str
    status: str
    inside: dict[str, float]
    estimated: tuple[str, ...]
    clearance: float
    load: np.ndarray
    motion: np.ndarray
    stiffness: np.ndarray
    spread: tuple[np.ndarray, np.ndarray] | None
    rows: tuple[Contacts, ...]
    notes: tuple[str, ...]


def bearing_facts(scene: Scene, body: Body | None = None) -> list[BearingFacts]:
    """Every catalogue bearing of a scene at its load.

    Parameters
    ----------
    body : Body, optional
        The shaft, where the bearings wait for its load.

    Raises
    ------
    SolidgearError
        As :func:`solidgear.bearings.solved.solved`, or a scene without such bearings.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/gearbox_catalogue.toml")
    >>> facts = bearing_facts(scene, sg.build(scene, "timoshenko"))
    >>> [(fact.name, fact.kind, len(fact.rows)) for fact in facts]
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
    bearing = _named(found, name)
    made, motion = found.made[name], found.motion[name]
    data = bearing.catalogue
    assert data is not None
    rows = made.bearing.contacts(motion)
    spread = None
    if made.estimated:
        # an even number of elements under the load is another bearing than an odd one: the middle
        # need not lie between
        all_three = [np.diag(np.array(_named(s, name).matrix)) for s in (found, *ends.values())]
        spread = (np.min(all_three, axis=0), np.max(all_three, axis=0))
    inside = {
        "elements": made.inside.elements,
        "element_diameter": made.inside.diameter,
        "pitch_diameter": made.inside.pitch,
        "contact_angle": made.inside.angle,
    }
    if data.balls:
        inside |= dict(zip(("conformity_inner", "conformity_outer"), made.inside.conformity))
    else:
        inside["element_length"] = made.inside.length
    return BearingFacts(
        name,
        data.kind,
        data.designation,
        bearing.status,
        inside,
        made.estimated,
        made.clearance,
        made.bearing.load(motion),
        motion,
        np.array(bearing.matrix),
        spread,
        rows,
        tuple(_notes(rows)),
    )


def _named(found: Solved, name: str):
    return next(b for b in found.scene.bearings if b.name == name)


def _notes(rows: Sequence[Contacts]):
    if not any(row.load.any() for row in rows):
        yield "it carries nothing: it has lost its load, and has no stiffness"
        return
    for k, row in enumerate(rows):
        if not row.load.any():
            place = "lower" if k == 0 else "upper"
            yield f"the row at the {place} end of y carries nothing: the pair has lost its preload"


@dataclass(frozen=True)
class OverLoad:
    """Stiffness of a bearing over the load.

    Attributes
    ----------
    factors : (n,) ndarray
        Times the load of the scene.
    load : (n, 6) ndarray
        On the bearing.
    middle, low, high : (n, 6) ndarray
        Diagonal of its stiffness, and its range by an estimated inside.
    """

    factors: np.ndarray
    load: np.ndarray
    middle: np.ndarray
    low: np.ndarray
    high: np.ndarray


def over_load(
    scene: Scene, body: Body | None = None, factors: Sequence[float] = FACTORS
) -> dict[str, OverLoad]:
    """Stiffness of every catalogue bearing over the load.

    Parameters
    ----------
    body : Body, optional
        The shaft, where the bearings wait for its load.
    factors : sequence of float
        Times the load that the scene says.
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


@dataclass(frozen=True)
class Bound:
    """Range of one natural frequency.

    Attributes
    ----------
    middle, low, high : float
        Hz.
    """

    mode: str
    middle: float
    low: float
    high: float


@dataclass(frozen=True)
class BearingRange:
    """Ranges of natural frequencies and of what they come from.

    Attributes
    ----------
    bounds : tuple of Bound
        Modes that every point has, by name.
    lost : tuple of str
        Bearings that carry nothing somewhere in the range.
    refused : tuple of str
        Why points could not be solved, each reason once.
    model : str
        Model that was solved.
    """

    bounds: tuple[Bound, ...]
    ranges: Ranges
    points: int
    lost: tuple[str, ...]
    refused: tuple[str, ...]
    model: str = SHAFT

    def as_dict(self) -> dict[str, Any]:
        """Plain data that JSON can hold."""
        return {
            "model": self.model,
            "points": self.points,
            "varied": self.ranges.text,
            "bounds": [
                {"mode": b.mode, "frequency_hz": b.middle, "low": b.low, "high": b.high}
                for b in self.bounds
            ],
            "lost": list(self.lost),
            "refused": list(self.refused),
        }


def bearing_range(
    scene: Scene, ranges: Ranges, body: Body | None = None, n: int = 10, fidelity: str = SHAFT
) -> BearingRange:
    """Bounds on natural frequencies from what is not known of the bearings.

    Parameters
    ----------
    body : Body, optional
        Made at `fidelity` unless given; factored once.
    n : int
        Elastic modes.

    Raises
    ------
    SolidgearError
        If what the scene itself says cannot be solved.
    """
    if body is None:
        from solidgear.ladder import build

        body = build(scene, fidelity)
    ranges = ranges.for_scene(scene)
    settles = body if wants_equilibrium(scene) else None
    frequencies: list[dict[str, float]] = []
    lost: dict[str, None] = {}
    refused: dict[str, None] = {}
    points = list(choices(ranges))
    for k, point in enumerate(points):
        try:
            at = solved(scene, settles, point)
            found = modes(body, at.scene, n)
        except SolidgearError as error:
            if k == 0:
                raise
            refused[str(error)] = None
            continue
        frequencies.append({m.name: m.frequency_hz for m in found.modes if m.frequency_hz > 0})
        for name in at.made:
            if not at.made[name].bearing.load(at.motion[name]).any():
                lost[name] = None
    names = [m for m in frequencies[0] if all(m in other for other in frequencies)]
    bounds = tuple(
        Bound(
            name,
            frequencies[0][name],
            min(f[name] for f in frequencies),
            max(f[name] for f in frequencies),
        )
        for name in names
    )
    return BearingRange(
        bounds, ranges, len(frequencies), tuple(lost), tuple(refused), body.fidelity
    )


def with_load(scene: Scene, load: dict[str, str | float], bearing: str | None) -> Scene:
    """A scene with another load, on its port or on one of its bearings.

    Parameters
    ----------
    load : dict
        As for :class:`solidgear.scene.BearingLoad`.
    bearing : str or None
        Name of the bearing that bears it; None puts it on the port.

    Raises
    ------
    SolidgearError
        A bearing that is not there, or has no catalogue data; components that are none.
    """
    from solidgear.scene import BearingLoad

    new = BearingLoad(**load)
    if bearing is None:
        free = tuple(
            b
            if b.catalogue is None
            else b.with_changes(catalogue=b.catalogue.with_changes(load=None))
            for b in scene.bearings
        )
        return scene.with_changes(load=new, bearings=free)
    known = [b.name for b in scene.bearings if b.catalogue is not None]
    if bearing not in known:
        raise SolidgearError(
            f"--bearing {bearing}: no bearing of catalogue data has this name; known here: "
            f"{', '.join(known) or 'none'}"
        )
    changed = tuple(replace_load(b, new) if b.name == bearing else b for b in scene.bearings)
    return scene.with_changes(bearings=changed)


def replace_load(bearing, load):
    """A bearing whose stiffness is taken at a load of its own."""
    data = bearing.catalogue.with_changes(load=load, displacement=None)
    return bearing.with_changes(catalogue=data)
