"""Catalogue bearings of a scene: at their load, and over load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.bearings.row import Contacts
from solidgear.bearings.solved import Choice, Solved, solved
from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.scene import BearingLoad, Scene

#: why one row of a pair carries nothing
LOST = "any more: the pair has lost its preload"
#: times the load that the scene says
FACTORS = tuple(float(f) for f in np.geomspace(0.05, 2.0, 21))


@dataclass(frozen=True)
class BearingFacts:
    """One catalogue bearing at its load.

    Attributes
    ----------
    inside : dict
        Inner geometry it was solved with, SI.
    support : str
        Its word for y; empty for none.
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
    support: str
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
    if data.grooved:
        inside |= dict(zip(("conformity_inner", "conformity_outer"), made.inside.conformity))
    if not data.balls:
        inside["element_length"] = made.inside.length
    return BearingFacts(
        name,
        data.kind,
        data.designation,
        bearing.status,
        bearing.support or "",
        inside,
        made.estimated,
        made.clearance,
        made.bearing.load(motion),
        motion,
        np.array(bearing.matrix),
        spread,
        rows,
        tuple(_notes(rows, "under this thrust" if data.own_rows > 1 else LOST)),
    )


def _named(found: Solved, name: str):
    return next(b for b in found.scene.bearings if b.name == name)


def _notes(rows: Sequence[Contacts], why: str):
    if not any(row.load.any() for row in rows):
        yield "it carries nothing: it has lost its load, and has no stiffness"
        return
    for k, row in enumerate(rows):
        if not row.load.any():
            place = "lower" if k == 0 else "upper"
            yield f"the row at the {place} end of y carries nothing {why}"


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
