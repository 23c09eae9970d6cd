"""One builder a file; ``build`` picks one from the ladder by name."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from solidgear.errors import SolidgearError, nearest, show
from solidgear.ladder.registry import LADDER
from solidgear.machine.threads import pinned

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.scene.shaft import Shaft

#: what to use instead, where there is nothing
NO_MODEL = "no model holds all that the scene has"


@pinned
def build(scene: Shaft, fidelity: str, **options) -> Body:
    """Free body of a scene at one fidelity.

    Parameters
    ----------
    scene : Scene
    fidelity : str
        A rung of the ladder that builds a body: euler, timoshenko, harmonic, solid.
    **options
        Passed to the builder: see :func:`solidgear.models.beam.body.beam`,
        :func:`solidgear.models.harmonic.body.harmonic`, :func:`solidgear.models.solid.body.solid`.

    Returns
    -------
    Body

    Raises
    ------
    SolidgearError
        For an unknown fidelity, an option it does not have or cannot use
        (the options of its rung), or a model that will not fit into memory.

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
    from solidgear.ladder.remedies import refuse_too_large

    if fidelity not in LADDER.bodies:
        raise SolidgearError(
            f"fidelity {show(fidelity, 40)} is unknown{nearest(fidelity, LADDER.bodies)}; "
            f"use one of {', '.join(LADDER.bodies)}"
        )
    rung = LADDER[fidelity]
    unfit = rung.unfit(scene)
    if unfit:
        fit = [r.name for r in LADDER if r.build is not None and not r.unfit(scene)]
        use = f"use {' or '.join(fit)}" if fit else NO_MODEL
        raise SolidgearError(f"{unfit}; {use}")
    options = rung.checked(rung.given(scene, options))
    size = refuse_too_large(scene, fidelity, options)
    assert rung.build is not None  # as every rung of LADDER.bodies
    own, factoring = rung.split(options)
    try:
        body = rung.build(scene, **{**rung.preset, **own})
    except MemoryError:
        raise SolidgearError(
            f"{fidelity}: about {size.unknowns} unknowns did not fit into memory; {size.lower}"
        ) from None
    return replace(body, fidelity=fidelity, factoring=factoring)
