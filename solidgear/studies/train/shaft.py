"""Models of one shaft of a train.

A model of a shaft is that of a body (``euler``, ``timoshenko``, ``harmonic``, ``solid``), ``rigid``,
or ``lumped``: six degrees of freedom at the lumped point, condensed from a body that may be named
(``lumped/euler``), with one of these masses:

- ``lumped``: Guyan's, of all six motions, and of all lumped points of a shaft with several gears;
- ``lumped-bending``: Guyan's in bending, the total mass along the shaft (Hua 2010, equation 55);
- ``lumped-matched``: the mode-matched pair in bending, the total mass along the shaft;
- ``lumped-old``: total mass and inertia.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from solidgear.body import Body, as_supports
from solidgear.errors import SolidgearError, listed, nearest, show
from solidgear.frames import shift
from solidgear.ladder.registry import LADDER
from solidgear.reduction.condensed import condensed_shaft
from solidgear.reduction.effective_mass import synthesise
from solidgear.reduction.superelement import Superelement
from solidgear.scene import Scene
from solidgear.system.parts import Part

RIGID = "rigid"
LUMPED = ("lumped", "lumped-bending", "lumped-matched", "lumped-old")
#: body that lumped models come from unless one is named, and the judge of a system
JUDGE = LADDER.judges[0]
#: all models of a shaft, bodies in the sequence of the ladder
MODELS = (*LADDER.bodies, RIGID, *LUMPED)


def checked_rung(name: str) -> tuple[str, str]:
    """Kind of a shaft's model, and the body it rests on (empty for a body of its own).

    Raises
    ------
    SolidgearError
        For a model that there is not.
    """
    kind, _, body = name.partition("/")
    if kind not in MODELS:
        raise SolidgearError(
            f"model {show(name, 40)} of a shaft is unknown{nearest(kind, MODELS)}; "
            f"use one of {', '.join(MODELS)}"
        )
    if body and (kind not in (*LUMPED, RIGID) or body not in LADDER.bodies):
        raise SolidgearError(
            f"model {show(name, 40)}: write a lumped model and the body it comes from, "
            f"such as lumped/{JUDGE}"
        )
    if kind in LADDER.bodies:
        return kind, ""
    return kind, body or JUDGE


def ladder_place(name: str) -> tuple[int, int]:
    """Place of a model among all, and of the body beneath it."""
    kind, body = checked_rung(name)
    return MODELS.index(kind), MODELS.index(body) if body else -1


def told_mix(models: Mapping[str, str]) -> str:
    """Models by shaft in words."""
    return ", ".join(f"{side} {rung}" for side, rung in models.items())


@dataclass(frozen=True, eq=False)
class ShaftModel:
    """One shaft by one model, a part of a system."""

    side: str
    rung: str
    part: Part
    body: Body  #: what the part was made of
    unknowns: int  #: of the body's mesh
    seconds: float  #: to build and reduce it
    #: the part with harmonics that teeth drive at a mesh point, by these
    local: dict[tuple, Part] = field(default_factory=dict, repr=False)

    @cached_property
    def rigid_mass(self) -> np.ndarray:
        """(6, 6) rigid mass of the body about the origin of its scene."""
        return self.body.mass_matrix()


def lumped(under: ShaftModel, kind: str, scene: Scene, gears: Sequence[str]) -> Part:
    """A shaft condensed to the lumped points of its gears, by one of the lumped models.

    Raises
    ------
    SolidgearError
        If it has no mode-matched masses, or several gears and a mass that is the whole one at a point.
    """
    shaft = under.part
    supports, port = as_supports(scene), scene.port.name
    assert isinstance(shaft, Superelement)
    whole = condensed_shaft(shaft, np.array(supports.stiffness), supports.ports, gears)
    if kind == "lumped":
        return whole
    if len(gears) > 1:
        raise SolidgearError(
            f"a {kind} shaft has its whole mass at one point, and the {under.side} carries several "
            f"gears, which share it in no one way; use lumped, or one of {listed(LADDER.bodies)}"
        )
    rigid = _mass_about(under.body, scene.port.y)
    if kind == "lumped-old":
        return whole.with_mass(np.diag(np.diag(rigid)))
    mass = np.diag(np.diag(rigid))
    if kind == "lumped-bending":
        for plane in ([0, 5], [2, 3]):
            mass[np.ix_(plane, plane)] = whole.mass[np.ix_(plane, plane)]
        return whole.with_mass(mass)
    _, models = synthesise(under.body, supports, port)
    matched = models["mode-matched"]
    if matched.mass is None or not matched.feasible:
        raise SolidgearError(
            f"the {under.side} has no mode-matched masses: {matched.verdict}; use lumped"
        )
    for plane in ([0, 5], [2, 3]):
        mass[np.ix_(plane, plane)] = np.diag(np.diag(matched.mass))
    return whole.with_mass(mass)


def _mass_about(body: Body, y: float) -> np.ndarray:
    """(6, 6) rigid mass about a point of the axis."""
    back = shift([0.0, -y, 0.0])
    return back.T @ body.mass_matrix() @ back
