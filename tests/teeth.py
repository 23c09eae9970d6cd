"""A unit mass on teeth, which many laws and motions are tried on."""

import numpy as np

from solidgear.backlash.solver.model import remainder
from solidgear.core.system import Inertia, RowSpring, System

#: of the motion along z, of six
ALONG = [0, 0, 1, 0, 0, 0]


def mass_on_teeth(law, mean=0.0, error=0.0, varying=0.0, damping=0.0):
    """``s'' + 2 damping s' + f(s) (1 + varying cos w t) = mean - e''`` with ``e = error cos w t``."""
    link = RowSpring("gear", ALONG, law.stiffness(mean), law=law)
    return remainder(
        System({"gear": Inertia(1.0, "z")}, {"mesh": link}),
        load=np.array([mean]),
        errors={"mesh": [error]},
        cycles={"mesh": [varying]},
        loss={"mesh": 2 * damping},
        kind="viscous",
        matched_hz=1 / (2 * np.pi),
    )
