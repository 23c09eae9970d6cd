"""One builder a file, cheapest first; ``build`` picks one by name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned

if TYPE_CHECKING:
    from solidgear.scene.shaft import Shaft

FIDELITIES = ("euler", "timoshenko", "harmonic", "solid")


@pinned
def build(scene: Shaft, fidelity: str, **options) -> Body:
    """Free body of a scene at one fidelity.

    Parameters
    ----------
    scene : Scene
    fidelity : {'euler', 'timoshenko', 'harmonic', 'solid'}
    **options
        Passed to the builder: see :func:`solidgear.fidelity.beam.beam`,
        :func:`solidgear.fidelity.harmonic.harmonic`, :func:`solidgear.fidelity.solid.solid`.

    Returns
    -------
    Body

    Raises
    ------
    SolidgearError
        For an unknown fidelity, an option it does not have or cannot use
        (:data:`solidgear.fidelity.options.OPTIONS`), or a model that will not fit into memory.

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
    if fidelity in FIDELITIES:
        from solidgear.fidelity.options import checked
        from solidgear.fidelity.size import refuse_too_large

        options = checked(fidelity, options)
        refuse_too_large(scene, fidelity, options)
    if fidelity == "euler":
        from solidgear.fidelity.beam import beam

        return beam(scene, **{"shear": False, "rotary_inertia": False, **options})
    if fidelity == "timoshenko":
        from solidgear.fidelity.beam import beam

        return beam(scene, **options)
    if fidelity == "harmonic":
        from solidgear.fidelity.harmonic import harmonic

        return harmonic(scene, **options)
    if fidelity == "solid":
        from solidgear.fidelity.solid import solid

        return solid(scene, **options)
    raise SolidgearError(f"fidelity {fidelity!r} is unknown; use one of {', '.join(FIDELITIES)}")
