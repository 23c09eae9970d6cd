"""Derivatives of numbers of one body by what may change of its scene, from a scene on either side:
springs and masses by their matrices, the shaft by what its model says of it.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from solidgear.core.body import Body, as_supports
from solidgear.core.errors import SolidgearError
from solidgear.core.ladder import build
from solidgear.core.scene import STEEL, Scene
from solidgear.core.scene.coned import coned
from solidgear.variants.sensitivity.adjoint import Form, change_by_bodies, change_by_supports
from solidgear.variants.sensitivity.beam import BeamAdjoint
from solidgear.variants.sensitivity.harmonic import HarmonicAdjoint
from solidgear.variants.sensitivity.harmonic_motion import Motion
from solidgear.variants.sweep.bench import surface

#: of how far nodes move between two meshes, that the one between may lie beside their middle
BESIDE = 1e-2


class Derivatives:
    """Derivatives of the numbers of some forms.

    Parameters
    ----------
    model : str
    options : dict
        That the body was built with.
    """

    def __init__(
        self, scene: Scene, body: Body, forms: Sequence[Form], model: str, options: dict[str, Any]
    ):
        self.scene, self.body, self.forms = scene, body, forms
        self.model, self.options = model, options
        self.there = as_supports(scene).rows(body)

    def by(self, low: Scene, high: Scene, step: float) -> np.ndarray:
        """(forms,) change of numbers from one scene to another, over a step.

        Raises
        ------
        SolidgearError
            If the mesh cannot follow.
        """
        out = np.zeros(len(self.forms))
        if _springs(low) != _springs(high):
            one, two = as_supports(low), as_supports(high)
            out += [change_by_supports(form, self.there, one, two) / step for form in self.forms]
        return out if surface(low) == surface(high) else out + self._shaft(low, high, step)

    def _shaft(self, low: Scene, high: Scene, step: float) -> np.ndarray:
        if self.model in ("timoshenko", "euler"):
            return self._beam.by(low, high, step)
        moves = _shape(low) != _shape(high)
        if self.model == "harmonic" and self._straight:
            moved = Motion(self._harmonic, low, high, step)
            return np.array([moved.derivative(push) for push in self._harmonic.pushes])
        if moves and self.model != "harmonic":
            raise SolidgearError(
                f"the {self.model} model meshes every shape anew, and no mesh follows it"
            )
        one, two = (build(scene, self.model, **self.options) for scene in (low, high))
        if moves:
            _follows(one, self.body, two)
        return np.array([change_by_bodies(form, one, two) for form in self.forms]) / step

    @cached_property
    def _straight(self) -> bool:
        return not coned(self.scene).outline.corners and self.body.mesh["order"] >= 3

    @cached_property
    def _harmonic(self) -> HarmonicAdjoint:
        return HarmonicAdjoint(self.scene, self.body, self.forms)

    @cached_property
    def _beam(self) -> BeamAdjoint:
        return BeamAdjoint(self.scene, self.body, self.forms)


def _follows(low: Body, body: Body, high: Body) -> None:
    """Refuse meshes of which one does not lie half way between the others."""
    flats: list[Any] = [one.geometry.meridian for one in (low, body, high)]  # type: ignore[union-attr]
    same = all(np.array_equal(flat.cells, flats[1].cells) for flat in flats)
    if same:
        one, at, two = (flat.points for flat in flats)
        same = abs((one + two) / 2 - at).max() <= BESIDE * abs(two - one).max()
    if not same:
        raise SolidgearError("the mesh changes with it")


def _springs(scene: Scene) -> tuple:
    """All that supports are made of."""
    springs = [b.stiffness.tolist() for b in scene.bearings]
    around = scene.housing and (scene.housing, [b.y for b in scene.bearings])
    return springs, scene.masses, scene.housing_axial, around


def _shape(scene: Scene) -> Hashable:
    """All that a mesh is made of: the shaft but for its materials."""
    bare = scene.with_changes(segments=[one.with_changes(material=STEEL) for one in scene.segments])
    return surface(bare)
