r"""A system in the motions of some of its ports and of modes with these ports held.

In mass-normalised coordinates q with the strain rows S, ``K = S'S``, and port motions ``P q``:

    q = T [u; eta],      P T = [1, 0],      T = [P^+ + N A, N Z],

N being an orthonormal basis of the motions that hold all ports.  A is the one of least strain, so
that the columns of u are static (Guyan 1965), and Z holds the singular vectors of ``S N``: modes
with the ports held (Craig and Bampton 1968).  All of them together change nothing but coordinates;
statics of the ports is exact however few are taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import scipy.linalg as sla

from solidgear.core.errors import SolidgearError, listed
from solidgear.core.machine.threads import pinned
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.core.system.system import System

#: a motion of ports this small, over the largest of unit rows, follows from the others
TOGETHER = 1e-8
#: singular value over the largest that is a free motion
FREE = 1e-11


@pinned
def port_coordinates(
    system: System,
    ends: Mapping[str, str],
    modes: int | None = 0,
    losses: Mapping[str, float] | None = None,
    swirl: np.ndarray | None = None,
    source: str = "",
    notes: Sequence[str] = (),
) -> PortMatrices:
    """Return the matrices of a system in the motions of ports, in the axes of the system, and of the
    lowest modes with the ports held, all of them for None.

    Parameters
    ----------
    ends : mapping of str to str
        Ports ``part.port`` by the name of the point.
    losses : mapping of str to float, optional
        Loss factors of parts and links, for the structural damping.
    swirl : (N, N) ndarray, optional
        Gyroscopic matrix in the coordinates of the system.

    Raises
    ------
    SolidgearError
        For ports that cannot move independently, or a free motion with all of them held that no
        mode is kept for.
    """
    lower = np.linalg.cholesky(system.mass)

    def normalised(rows: np.ndarray) -> np.ndarray:
        return sla.solve_triangular(lower, rows.T, lower=True).T

    ports = {name: system.port(end) for name, end in ends.items()}
    moved = normalised(np.vstack([np.kron(np.eye(2), p.axes) @ p.rows for p in ports.values()]))
    strains, rows_of = system.strains
    strain = normalised(strains)
    shapes = _shapes(moved, strain, [*ports], modes)
    strained = strain @ shapes
    damping = None
    if losses:
        lost = [np.sqrt(losses.get(name, 0.0)) * strained[rows] for name, rows in rows_of.items()]
        damping = _squared(np.vstack(lost))
    gyroscopic = None
    if swirl is not None:
        back = sla.solve_triangular(lower.T, shapes, lower=False)
        gyroscopic = back.T @ swirl @ back
    places = {name: np.asarray(port.point, float) for name, port in ports.items()}
    mass, stiffness = _squared(shapes), _squared(strained)
    # static shapes strain no mode that holds the ports
    p = len(moved)
    stiffness[:p, p:] = stiffness[p:, :p] = 0.0
    return PortMatrices(source, mass, stiffness, places, damping, gyroscopic, tuple(notes))


def _shapes(moved: np.ndarray, strain: np.ndarray, names: list[str], modes: int | None):
    """Return the static shapes of unit motions of ports, then modes with the ports held."""
    size = np.linalg.norm(moved, axis=1)
    rows = moved / np.where(size > 0, size, 1.0)[:, None]
    u, s, vt = np.linalg.svd(rows)
    if len(rows) > rows.shape[1] or s[-1] < TOGETHER * s[0]:
        weights = np.abs(u[:, len(s) - 1 :]).max(axis=1).reshape(-1, 6).max(axis=1)
        together = [name for name, weight in zip(names, weights) if weight > weights.max() / 10]
        raise SolidgearError(
            f"the ports {listed(together)} cannot all move independently; leave one out with `ports`"
        )
    still = vt[len(s) :].T
    moving = vt[: len(s)].T @ ((u.T / s[:, None]) / size)
    stretch, sigma, turn = np.linalg.svd(strain @ still)
    sigma = np.r_[sigma, np.zeros(still.shape[1] - len(sigma))][: still.shape[1]]
    largest = max(sigma.max(initial=0.0), np.linalg.norm(strain, 2) if strain.size else 0.0)
    free = int((sigma <= FREE * largest).sum())
    count = still.shape[1] if modes is None else min(modes, still.shape[1])
    if free > count:
        raise SolidgearError(
            f"{free} motions stay free with all ports held, and {count} modes are kept; ask for "
            f"{free} modes or more, or for ports of what moves"
        )
    # singular values descend: the softest come last
    stiff = len(sigma) - free
    basis = still @ turn.T
    static = moving
    if stiff:
        work = stretch[:, :stiff].T @ (strain @ moving)
        static = moving - basis[:, :stiff] @ (work / sigma[:stiff, None])
    return np.hstack([static, basis[:, ::-1][:, :count]])


def _squared(rows: np.ndarray) -> np.ndarray:
    """Return a Gram matrix, symmetric to the bit."""
    out = rows.T @ rows
    return (out + out.T) / 2
