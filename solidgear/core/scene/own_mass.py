"""Mass and centre of a shaft as its file has it: the body of revolution that its segments describe, and
what features cut out of it or a part from a file has beside it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.registry import addition
from solidgear.core.scene.closed_form import mass_properties
from solidgear.core.scene.shaft import resolved

if TYPE_CHECKING:
    from solidgear.core.scene.model import Scene


@dataclass(frozen=True)
class Beside:
    """What a shaft has beside its body of revolution, between two places along it; less than nothing where
    it is cut out.
    """

    mass: float  #: kg
    first: np.ndarray  #: (3,) first moments of it about the start of the axis, kg m
    #: lo, hi: m
    lo: float
    hi: float

    def between(self, start: float, end: float) -> tuple[float, float]:
        """Return the mass between two places, m, and its first moment along the axis, kg and kg m: the
        line of density that has the mass and the moment of all.
        """
        length, middle = self.hi - self.lo, (self.lo + self.hi) / 2
        a, b = np.clip((start, end), self.lo, self.hi) - middle
        even = self.mass / length
        slope = 12 * (float(self.first[1]) - self.mass * middle) / length**3
        mass = even * (b - a) + slope * (b**2 - a**2) / 2
        about_middle = even * (b**2 - a**2) / 2 + slope * (b**3 - a**3) / 3
        return float(mass), float(about_middle + middle * mass)


@dataclass(frozen=True)
class OwnMass:
    """Mass of a shaft without the masses on it."""

    mass: float  #: kg
    centre: tuple[float, float, float]  #: m


def beside(scene: Scene) -> tuple[Beside, ...]:
    """Return what a shaft has beside its body of revolution."""
    body = scene.body
    if body is not None:
        if body.round:
            return ()
        outline = mass_properties(scene.outline)
        mass = body.mass(scene.material)
        first = mass * np.array(body.centre_of_mass(scene.material))
        first[1] -= outline.mass * outline.centre
        ends = [end for stretch in body.uneven for end in stretch] or [0.0, scene.length]
        return (Beside(mass - outline.mass, first, min(ends), max(ends)),)
    if not resolved(scene):
        return ()
    return addition("question of features", "mass")(scene.segments, resolved(scene))


def own_mass(scene: Scene) -> OwnMass:
    """Return the mass and the centre of a shaft without the masses on it, in closed form.

    Examples
    --------
    >>> import solidgear as sg
    >>> keyed = sg.load("geometry/pinion_keyed.toml")
    >>> key, = keyed.features
    >>> lighter = own_mass(keyed.plain).mass - own_mass(keyed).mass
    >>> bool(np.isclose(lighter, 7850 * key.volume(0.045, 0.0)))
    True
    """
    outline = mass_properties(scene.outline)
    further = beside(scene)
    if not further:
        return OwnMass(outline.mass, (0.0, outline.centre, 0.0))
    mass = outline.mass + sum(part.mass for part in further)
    first = np.array([0.0, outline.mass * outline.centre, 0.0])
    x, y, z = sum((part.first for part in further), first) / mass
    return OwnMass(mass, (float(x), float(y), float(z)))


def mass_with_masses(scene: Scene) -> tuple[float, float]:
    """Return the mass of a shaft with the masses on it, kg, and the place of its centre along the axis,
    m.
    """
    shaft, places = own_mass(scene), {s.name: s.y for s in scene.stations}
    on_shaft = [(m.mass, places[m.station] + m.offset[1]) for m in scene.masses]
    mass = shaft.mass + sum(m for m, _ in on_shaft)
    first = shaft.mass * shaft.centre[1] + sum(m * y for m, y in on_shaft)
    return mass, first / mass
