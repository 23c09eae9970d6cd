"""The motion of a port of a body under a force that oscillates, by its modes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from solidgear.body import Body
from solidgear.solve.modes import ModeSet
from solidgear.solve.statics import condense

if TYPE_CHECKING:
    from solidgear.body.supports import Holding


def modal_receptance(
    body: Body, supports: Holding, port: str, found: ModeSet
) -> Callable[[float], float]:
    """Receptance z/F_z (m/N) at a port of a body on its supports, by the frequency in rad/s: modal
    superposition of its modes there, with the static remainder.

    The static part of the modes left out is exact, so the error is of the order of (omega /
    omega_left_out)^4.

    Examples
    --------
    At rest it is the static compliance:

    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> body = sg.build(scene, "euler")
    >>> receptance = modal_receptance(body, scene, "port", sg.modes(body, scene, n=4))
    >>> static = sg.condense(body, scene, "port").compliance[2, 2]
    >>> bool(np.isclose(receptance(0.0), static))
    True
    """
    index = body.port_index(port)
    static = condense(body, supports, port).compliance[2, 2]
    pairs = []
    for mode in (*found.modes, *found.beyond):
        if mode.frequency_hz > 0:
            w2 = (2 * np.pi * mode.frequency_hz) ** 2
            pairs += [(w2, body.port_motions(v)[6 * index + 2] ** 2) for v in mode.vectors]
    w2, strength = np.array(pairs).T

    def receptance(omega: float) -> float:
        # 1 / (w_i^2 - w^2) - 1 / w_i^2, the dynamic surplus of each mode
        return float(static + (strength * omega**2 / (w2 * (w2 - omega**2))).sum())

    return receptance
