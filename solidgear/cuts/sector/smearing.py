"""Price of smearing teeth into their pitch cone, and whether that matters at a tolerance.

Measured on an overhung pinion with 10 to 45 teeth of several proportions, straight and of 35
degrees, by cyclic sectors (`python -m validation.teeth`): the cone is too stiff, by up to 0.05 of
the depth of a tooth over the pitch radius, most in tilt. Frequencies are off by up to half of the share
of polar inertia, or of mass, that the cone lacks of the whole shaft, in closed form, and by a
quarter of the error of the stiffness.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from solidgear.core import LADDER, Outline
from solidgear.core.scene.closed_form import mass_properties
from solidgear.core.scene.shaft import feature_labels
from solidgear.cuts.sector.teeth import lacking
from solidgear.guards.notice import Notice, Notices, everything

if TYPE_CHECKING:
    from solidgear.core import Scene

#: error of stiffness over the depth of a tooth, as a share of the pitch radius
STIFFER = 0.05
#: share of lacking inertia, and of the error of stiffness, in frequencies
INERTIA, BY_STIFFNESS = 0.5, 0.25


def _smeared(scene: Scene) -> list[Any]:
    return [f for f in scene.features if f.smeared and f.toothed]


def _lacking(scene: Scene) -> tuple[float, float]:
    """Return mass (kg) and polar inertia (kg m^2) that cones lack of all smeared teeth."""
    by_name = {s.name: s for s in scene.segments}
    parts = [lacking(f, by_name[f.segment]) for f in _smeared(scene)]
    return sum(mass for mass, _ in parts), sum(polar for _, polar in parts)


def expected(scene: Scene) -> tuple[float, float]:
    """Return the largest errors measured of a shaft whose smeared teeth are a cone: of stiffness and
    of frequencies, relative.

    Examples
    --------
    >>> import solidgear as sg
    >>> from solidgear.cuts.features import Teeth
    >>> pinion = sg.load("geometry/pinion_overhung.toml")
    >>> teeth = Teeth(name="teeth", segment="head", count=14)
    >>> [round(e, 3) for e in expected(pinion.with_changes(features=(teeth,)))]
    [0.016, 0.019]
    """
    whole = mass_properties(Outline(scene.segments))
    stiffness = max(STIFFER * (f.tip - f.root) for f in _smeared(scene))
    mass, polar = _lacking(scene)
    share = max(abs(mass) / whole.mass, abs(polar) / whole.iyy)
    return stiffness, INERTIA * share + BY_STIFFNESS * stiffness


def smearing(scene: Scene) -> Notices:
    """Yield a notice on smeared teeth: the errors they cause, and whether they need a model in 3D."""
    if not _smeared(scene):
        return
    stiffness, frequency = expected(scene)
    mass, polar = _lacking(scene)
    cost = (
        f"{feature_labels(_smeared(scene))}: smeared into the segment, which lacks "
        f"{mass:+.3g} kg and {polar:+.3g} kg m^2; stiffness is up to {100 * stiffness:.2g} % off, "
        f"frequencies up to {100 * frequency:.2g} % (as on an overhung pinion)"
    )
    tolerance = scene.ask.tolerance
    if max(stiffness, frequency) <= tolerance:
        yield Notice("fact", (), f"{cost}, within the tolerance of {100 * tolerance:g} %")
        return
    round_ones = tuple(m for m in everything() if not LADDER[m].for_features)
    yield Notice(
        "caution",
        round_ones,
        f'{cost}, beyond the tolerance of {100 * tolerance:g} %; use model = "sector", or add the '
        "missing mass at the lumped point",
    )
