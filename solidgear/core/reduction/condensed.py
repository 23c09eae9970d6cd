r"""A shaft on bearings reduced to the six motions of each of its lumped points (Guyan 1965).

The static shapes of unit motions d of the lumped points, nothing else loaded, are

    [K  P'] [Phi]   [0]
    [P  0 ] [ L ] = [I],      K_ll = Phi'K Phi = -L,      M_ll = Phi'M Phi,

with P the rows of the lumped points, K that of the shaft *with* bearings.  A free rotation is
one of the shapes; nothing has to hold it.  M_ll is the mass of a shaft that moves in its static
shapes: an *effective* mass, in the axial direction too, where the end behind the bearing moves less
than the head.

Seats follow as ``P_b Phi``, so that bearings stay outside, with their own losses and reactions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg as sla

from solidgear.core.errors import SolidgearError, listed
from solidgear.core.reduction.superelement import PortMotion, Superelement


@dataclass(frozen=True, eq=False)
class CondensedShaft:
    """A part whose coordinates are the motions of l lumped points."""

    mass: np.ndarray  #: (6 l, 6 l)
    strain: np.ndarray  #: (r, 6 l) of the shaft alone, without bearings
    #: all ports of the shaft, which follow the lumped points statically
    ports: Mapping[str, PortMotion]

    def with_mass(self, mass: np.ndarray) -> CondensedShaft:
        """Return the same stiffness with another mass at the lumped point."""
        return replace(self, mass=np.asarray(mass, float))


def condensed_shaft(
    shaft: Superelement, supports: np.ndarray, held: tuple[str, ...], points: Sequence[str]
) -> CondensedShaft:
    """Reduce a superelement to a few of the ports, on supports of some stiffness (6 p, 6 p) on the
    ports ``held``, in their order; refuse shapes that are not determined, as where a shaft swings
    on one bearing.
    """
    rows = np.vstack([np.zeros((0, shaft.size)), *(shaft.ports[name].rows for name in held)])
    value = shaft.value
    elastic = value > 0
    # Coordinates of unit strain energy, so that the stiffness of the free shaft is one.
    scale = np.where(elastic, 1 / np.sqrt(np.where(elastic, value, 1.0)), 1.0)
    seats, lumped = rows * scale, np.vstack([shaft.ports[name].rows for name in points]) * scale
    unit = np.sqrt(np.trace(seats.T @ supports @ seats) or 1.0)
    stiffness = np.diag(elastic.astype(float)) + seats.T @ supports @ seats
    size = np.linalg.norm(lumped, axis=1) / unit
    n, k = len(value), len(lumped)
    bordered = np.zeros((n + k, n + k))
    bordered[:n, :n] = stiffness
    bordered[n:, :n] = lumped / size[:, None]
    bordered[:n, n:] = bordered[n:, :n].T
    right = np.vstack([np.zeros((n, k)), np.diag(1 / size)])
    try:
        solution = sla.solve(bordered, right, assume_a="sym")[:n]
    except (sla.LinAlgError, np.linalg.LinAlgError):
        raise SolidgearError(
            f"the shaft is not held by {listed(points)} and its bearings together; "
            "a lumped model needs bearings that hold it"
        ) from None
    shapes = scale[:, None] * solution
    ports = {
        name: PortMotion(motion.rows @ shapes, motion.point, motion.axes)
        for name, motion in shaft.ports.items()
    }
    mass = shapes.T @ shapes
    return CondensedShaft((mass + mass.T) / 2, shaft.strain @ shapes, ports)
