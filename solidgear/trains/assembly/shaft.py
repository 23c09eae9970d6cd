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
from typing import Any

import numpy as np

from solidgear.core import (
    LADDER,
    Body,
    Scene,
    SolidgearError,
    as_supports,
    listed,
    nearest,
    show,
    synthesise,
)
from solidgear.core.bounds.refining import Meshed
from solidgear.core.frames import shift
from solidgear.core.ladder import solid_of
from solidgear.core.reduction.condensed import condensed_shaft
from solidgear.core.reduction.superelement import Superelement
from solidgear.core.system.parts import Part
from solidgear.trains.assembly.matrices_body import MATRICES
from solidgear.trains.file.gears import Shaft

RIGID = "rigid"
LUMPED = ("lumped", "lumped-bending", "lumped-matched", "lumped-old")
#: body that lumped models come from unless one is named, and the judge of a system
JUDGE = LADDER.judges[0]
#: all models of a shaft, bodies in the sequence of the ladder
MODELS = (*LADDER.bodies, MATRICES, RIGID, *LUMPED)


def checked_model(name: str) -> tuple[str, str]:
    """Split the name of a shaft's model into its kind and the body it rests on, which is empty
    where the model is a body itself; an unknown name is refused.
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
    if kind in (*LADDER.bodies, MATRICES):
        return kind, ""
    return kind, body or JUDGE


def usual_models(shafts: Mapping[str, Shaft]) -> dict[str, str]:
    """Return the model of every shaft where none is named: matrices that the file names, else the
    cheapest solid that models all of it, cuts and parts from files included.
    """
    return {
        side: solid_of(shaft.scene) if shaft.matrices is None else MATRICES
        for side, shaft in shafts.items()
    }


def names_from(body: str, kinds: Sequence[str]) -> set[str]:
    """Return the names of rigid or lumped models of some kinds that rest on a body."""
    return {f"{kind}/{body}" for kind in kinds} | ({*kinds} if body == JUDGE else set())


def ladder_place(name: str) -> tuple[int, int]:
    """Return the places of a model and of the body beneath it in the sequence of all models, to
    sort by.
    """
    kind, body = checked_model(name)
    return MODELS.index(kind), MODELS.index(body) if body else -1


def mix_label(models: Mapping[str, str]) -> str:
    """Return the models by shaft in words, such as ``pinion harmonic, gear euler``."""
    return ", ".join(f"{side} {model}" for side, model in models.items())


@dataclass(frozen=True)
class Level:
    """A mesh of a solid that goes on along a list, coarse to fine."""

    levels: tuple[Mapping[str, Any], ...]  #: builder options of this mesh, and of finer ones

    def options(self) -> dict[str, Any]:
        """Return the options of the builder."""
        return dict(self.levels[0])

    @property
    def finer(self) -> Level | None:
        """The next mesh; None after the last."""
        return Level(self.levels[1:]) if len(self.levels) > 1 else None


@dataclass(frozen=True, eq=False)
class ShaftModel:
    """One shaft by one model, a part of a system."""

    side: str
    model: str
    part: Part
    body: Body  #: from which the part is reduced
    unknowns: int  #: of the body's mesh
    seconds: float  #: to build and reduce it, on all meshes that were tried
    mesh: Meshed | Level | None = None  #: that follows error bars
    #: the part with harmonics that teeth drive at a mesh point, by these
    local: dict[tuple, Part] = field(default_factory=dict, repr=False)

    @cached_property
    def rigid_mass(self) -> np.ndarray:
        """Rigid mass (6, 6) of the body about the origin of the scene."""
        return self.body.mass_matrix()


def lumped(shaft_model: ShaftModel, kind: str, scene: Scene, gears: Sequence[str]) -> Part:
    """Condense a shaft to the lumped points of the gears, by one of the lumped models; refused for
    a mass at one point where a shaft has several gears, and where no mode-matched masses exist.
    """
    part = shaft_model.part
    supports, port = as_supports(scene), scene.port.name
    assert isinstance(part, Superelement)
    condensed = condensed_shaft(part, np.array(supports.stiffness), supports.ports, gears)
    if kind == "lumped":
        return condensed
    if len(gears) > 1:
        raise SolidgearError(
            f"a {kind} shaft has its mass at one point, but the {shaft_model.side} carries several "
            f"gears; use lumped, or one of {listed(LADDER.bodies)}"
        )
    rigid = _mass_about(shaft_model.body, scene.port.y)
    if kind == "lumped-old":
        return condensed.with_mass(np.diag(np.diag(rigid)))
    mass = np.diag(np.diag(rigid))
    if kind == "lumped-bending":
        for plane in ([0, 5], [2, 3]):
            mass[np.ix_(plane, plane)] = condensed.mass[np.ix_(plane, plane)]
        return condensed.with_mass(mass)
    _, models = synthesise(shaft_model.body, supports, port)
    matched = models["mode-matched"]
    if matched.mass is None or not matched.feasible:
        raise SolidgearError(
            f"the {shaft_model.side} has no mode-matched masses: {matched.verdict}; use lumped"
        )
    for plane in ([0, 5], [2, 3]):
        mass[np.ix_(plane, plane)] = np.diag(np.diag(matched.mass))
    return condensed.with_mass(mass)


def _mass_about(body: Body, y: float) -> np.ndarray:
    """Return the (6, 6) rigid mass about the point y of the axis."""
    to_point = shift([0.0, -y, 0.0])
    return to_point.T @ body.mass_matrix() @ to_point
