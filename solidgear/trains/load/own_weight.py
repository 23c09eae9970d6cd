"""Weight of a shaft alone, as much as its outline has, whatever its model leaves out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.core import Scene, System
from solidgear.core.scene.acting import weight_about
from solidgear.trains.file.train import ALONE
from solidgear.trains.system.equilibrium import weight


def weight_alone(scene: Scene, system: System, gravity: Sequence[float]) -> np.ndarray:
    """Return the load (N,) of weight on the coordinates of a shaft alone: spread as the mass of its
    model, and at the main point what that lacks, such as of fillets that a beam leaves out.
    """
    spread, end = weight(system, gravity), f"{ALONE}.{scene.port.name}"
    at_port = system.motion(end) @ system.free
    resultant, *_ = np.linalg.lstsq(at_port.T, system.free.T @ spread, rcond=1e-12)
    return spread + system.load({end: weight_about(scene, scene.port.y) - resultant})
