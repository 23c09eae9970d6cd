"""Derivatives of numbers of one body by changes of its scene, from a scene on either side: springs and
masses by their matrices, the shaft by the derivatives of its model.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from solidgear.core import Body, Scene, SolidgearError, as_supports, build, coned
from solidgear.core.scene import STEEL
from solidgear.variants.sensitivity.adjoint import Form, change_by_bodies, change_by_supports
from solidgear.variants.sensitivity.beam import BeamAdjoint
from solidgear.variants.sensitivity.harmonic import HarmonicAdjoint, Motion
from solidgear.variants.sweep.bench import surface

#: largest distance of a mesh from the middle of two others, relative to their own
OFF_MIDDLE = 1e-2


class Derivatives:
    """Derivatives of the numbers of forms of a body, which was built by a model with these options."""

    def __init__(
        self, scene: Scene, body: Body, forms: Sequence[Form], model: str, options: dict[str, Any]
    ):
        self.scene, self.body, self.forms = scene, body, forms
        self.model, self.options = model, options
        self.rows = as_supports(scene).rows(body)

    def by(self, low: Scene, high: Scene, step: float) -> np.ndarray:
        """Compute (forms,) the change of numbers from one scene to another, over a step; SolidgearError
        if the mesh cannot follow.
        """
        out = np.zeros(len(self.forms))
        if _springs(low) != _springs(high):
            a, b = as_supports(low), as_supports(high)
            out += [change_by_supports(form, self.rows, a, b) / step for form in self.forms]
        return out if surface(low) == surface(high) else out + self._shaft(low, high, step)

    def _shaft(self, low: Scene, high: Scene, step: float) -> np.ndarray:
        if self.model in ("timoshenko", "euler"):
            return self._beam.by(low, high, step)
        moves = _shape(low) != _shape(high)
        if self.model == "harmonic" and self._straight:
            motion = Motion(self._harmonic, low, high, step)
            return np.array([motion.derivative(push) for push in self._harmonic.pushes])
        if moves and self.model != "harmonic":
            raise SolidgearError(f"the {self.model} model makes a new mesh for every shape")
        a, b = (build(scene, self.model, **self.options) for scene in (low, high))
        if moves:
            _check_middle(a, self.body, b)
        return np.array([change_by_bodies(form, a, b) for form in self.forms]) / step

    @cached_property
    def _straight(self) -> bool:
        return not coned(self.scene).outline.corners and self.body.mesh["order"] >= 3

    @cached_property
    def _harmonic(self) -> HarmonicAdjoint:
        return HarmonicAdjoint(self.scene, self.body, self.forms)

    @cached_property
    def _beam(self) -> BeamAdjoint:
        return BeamAdjoint(self.scene, self.body, self.forms)


def _check_middle(low: Body, body: Body, high: Body) -> None:
    """Refuse a mesh that does not lie half way between two others."""
    bodies: tuple[Any, ...] = low, body, high
    meridians = [b.geometry.meridian for b in bodies]
    follows = all(np.array_equal(m.cells, meridians[1].cells) for m in meridians)
    if follows:
        a, middle, b = (m.points for m in meridians)
        follows = abs((a + b) / 2 - middle).max() <= OFF_MIDDLE * abs(b - a).max()
    if not follows:
        raise SolidgearError("the mesh changes with it")


def _springs(scene: Scene) -> tuple:
    """Return all that supports are made of."""
    springs = [bearing.stiffness.tolist() for bearing in scene.bearings]
    housing = scene.housing and (scene.housing, [bearing.y for bearing in scene.bearings])
    return springs, scene.masses, scene.housing_axial, housing


def _shape(scene: Scene) -> Hashable:
    """Return all that a mesh is made of: the shaft but for its materials."""
    segments = [segment.with_changes(material=STEEL) for segment in scene.segments]
    return surface(scene.with_changes(segments=segments))
