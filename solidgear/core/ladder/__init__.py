"""One model a file; ``build`` builds the free body of one by name."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from solidgear.core.errors import SolidgearError, show
from solidgear.core.ladder.model import SOLID, unknown_model
from solidgear.core.ladder.registry import LADDER
from solidgear.core.ladder.remedies import refusal
from solidgear.core.machine.memory import NoRoom, begin
from solidgear.core.machine.threads import pinned
from solidgear.core.models.kinds import CYCLIC

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.scene.shaft import Shaft

#: advice where no model fits
NO_MODEL = "no model solves all features of the scene"


def way_out(scene: Shaft) -> str:
    """Return advice for a scene that no model holds: smear its teeth, with the loss by that;
    `NO_MODEL` alone where smearing does not help.
    """
    from solidgear.core.scene import Scene  # start-up: every command reads the ladder
    from solidgear.core.scene.shaft import feature_labels

    features = scene.features
    cut = [f for f in features if f.sort == CYCLIC and not f.smeared and f.toothed]
    if not cut or not isinstance(scene, Scene):
        return NO_MODEL
    cones = (f.with_changes(model="pitch_cone") if f in cut else f for f in features)
    smeared = scene.with_changes(features=tuple(cones))
    fit = [name for name in LADDER.fit(smeared) if LADDER[name].can_model(smeared)]
    if not fit:
        return NO_MODEL
    return (
        f'{NO_MODEL}; write model = "pitch_cone" for {feature_labels(cut)}, which replaces teeth by '
        f"their pitch surface, and use {' or '.join(fit)}"
    )


def solid_of(scene: Shaft) -> str:
    """Return the cheapest solid that models all of a scene, cuts and parts from files included; refused
    where none does.

    Examples
    --------
    >>> import solidgear as sg
    >>> [solid_of(sg.load(f"geometry/{name}.toml")) for name in ("shaft_stepped", "pinion_keyed")]
    ['harmonic', 'corrected']
    """
    for name in LADDER.of(SOLID):
        if LADDER[name].can_model(scene):
            return name
    raise SolidgearError(way_out(scene))


@pinned
def build(scene: Shaft, fidelity: str, **options) -> Body:
    """Free body of a scene by one model.

    Parameters
    ----------
    scene : Scene
    fidelity : str
        A model of the ladder that builds a body: euler, timoshenko, harmonic, solid.
    **options
        Passed to the builder: see :func:`solidgear.core.models.beam.body.beam`,
        :func:`solidgear.core.models.harmonic.body.harmonic`, :func:`solidgear.core.models.solid.body.solid`.

    Returns
    -------
    Body

    Raises
    ------
    SolidgearError
        For an unknown model, or an option it does not have or cannot use.
    NoRoom
        For a mesh or matrices that will not fit into memory. Factors are checked when they are
        first needed.

    Examples
    --------
    >>> import numpy as np
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> body = sg.build(sg.Scene.from_parts([rod]), "euler", elements=40)
    >>> [block.name for block in body.blocks]
    ['bending_z', 'bending_x', 'axial', 'torsion']
    >>> bool(np.isclose(body.mass_matrix()[0, 0], 7850 * np.pi * 0.01**2 * 0.6))  # kg
    True
    """
    if fidelity not in LADDER.bodies:
        raise SolidgearError(unknown_model(fidelity, LADDER.bodies))
    if not hasattr(scene, "segments"):
        raise SolidgearError(
            f"build: {show(str(scene), 40)} is no Scene: read it first, by sg.load"
        )
    model = LADDER[fidelity]
    unfit = model.unfit(scene)
    if unfit:
        fit = LADDER.holding(scene)
        use = f"use {' or '.join(fit)}" if fit else way_out(scene)
        raise SolidgearError(f"{unfit}; {use}")
    options = model.checked(model.given(scene, options))
    builder_options, factoring = model.split(options)
    model.builder()  # large libraries do not count as memory of the body
    begin()
    try:
        body = model.build(scene, **builder_options)
    except NoRoom as error:
        raise refusal(scene, fidelity, options, None, error) from None
    except MemoryError:
        raise SolidgearError(
            f"{fidelity}: its matrices did not fit into memory; {model.coarser}"
        ) from None
    remedies = partial(refusal, scene, fidelity, options)
    return replace(body, fidelity=fidelity, factoring=factoring, remedies=remedies)
