"""Forces of links on the ports that they act on, in a static state of a system."""

from __future__ import annotations

import numpy as np

from solidgear.core.reduction.superelement import PortMotion
from solidgear.core.system.system import System


def port_forces(system: System, coordinates: np.ndarray) -> dict[str, np.ndarray]:
    """Return the forces (6,) of all links on each port, ``part.port``, N and N m, in the axes and
    at the point of the port, from coordinates (N,) of the system.

    Examples
    --------
    >>> import numpy as np
    >>> from solidgear.core.system import Inertia, System, torsion_spring
    >>> pair = System({"a": Inertia(1.0), "b": Inertia(1.0)}, {"s": torsion_spring("a", 50.0, "b")})
    >>> forces = port_forces(pair, np.array([0.1, 0.0]))
    >>> round(float(forces["a"][4]), 9), round(float(forces["b"][4]), 9)
    (-5.0, 5.0)
    """
    out: dict[str, np.ndarray] = {}
    for link in system.links.values():
        ends = [system.port(end) for end in link.ends]
        size = 6 * len(ends)
        unit = np.split(np.eye(size), len(ends)) if ends else []
        alone = [PortMotion(rows, end.point, end.axes) for rows, end in zip(unit, ends)]
        rows = np.asarray(link.strain(*alone), float).reshape(-1, size)
        moved = np.concatenate([end.rows @ coordinates for end in ends])
        forces = -rows.T @ (rows @ moved)
        for name, force in zip(link.ends, np.split(forces, len(ends))):
            out[name] = out.get(name, np.zeros(6)) + force
    return out
