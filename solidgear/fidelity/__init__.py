"""One builder a file; ``build`` picks one from the ladder by name."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from solidgear.errors import SolidgearError, nearest, show
from solidgear.fidelity.ladder import LADDER
from solidgear.machine.threads import pinned

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.scene.shaft import Shaft


@pinned
def build(scene: Shaft, fidelity: str, **options) -> Body:
    """Free body of a scene at one fidelity.

    Parameters
    ----------
    scene : Scene
    fidelity : str
        A rung of the ladder that builds a body: euler, timoshenko, harmonic, solid.
    **options
        Passed to the builder: see :func:`solidgear.fidelity.beam.beam`,
        :func:`solidgear.fidelity.harmonic.harmonic`, :func:`solidgear.fidelity.solid.solid`.

    Raises
    ------
    SolidgearError
        For an unknown fidelity, an option it does not have or cannot use
        (the options of its rung), or a model that will not fit into memory.
    """
    from solidgear.fidelity.size import refuse_too_large

    if fidelity not in LADDER.bodies:
        raise SolidgearError(
            f"fidelity {show(fidelity, 40)} is unknown{nearest(fidelity, LADDER.bodies)}; "
            f"use one of {', '.join(LADDER.bodies)}"
        )
    rung = LADDER[fidelity]
    options = rung.checked(options)
    refuse_too_large(scene, fidelity, options)
    assert rung.build is not None  # as every rung of LADDER.bodies
    body = rung.build(scene, **{**rung.preset, **options})
    return body if body.fidelity == fidelity else replace(body, fidelity=fidelity)
