r"""From contact cells to one mesh point, one line of action, and the moment that they cannot carry.

Cells at r_i push along n_i with f_i.  Their sum is a force and a moment about the origin,

    F = sum f_i n_i,      M = sum f_i r_i x n_i,      n = F / |F|,

and a force F at a point r balances M only up to the part along n: ``n . (r x F) = 0``.  The
rest, ``M . n``, is a moment about the line of action that *no* mesh point carries; over |F| it is
the pitch of the wrench.  Points that leave nothing else are those of the central axis, ``r = F x M
/ F^2 + t n``.

Hua (2010), 3.2.1, equation 3, takes y from the forces, x from the moment about z and z from that
about y,

    y = sum f_i y_i / sum f_i,      x = (M_z + F_x y) / F_y,      z = (M_y + F_z x) / F_x,

and leaves M_x as it comes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from solidgear.core.errors import SolidgearError


@dataclass(frozen=True, eq=False)
class ContactWrench:
    """The force and moment of contact cells, and the mesh points that stand for them.

    Examples
    --------
    Two cells of one normal: a force at their middle, and nothing is left:

    >>> up = [0.0, 0.0, 1.0]
    >>> wrench = contact_wrench([[0.1, 0, 0], [0.3, 0, 0]], [up, up], [5.0, 5.0])
    >>> wrench.point, wrench.pitch
    (array([0.2, 0. , 0. ]), 0.0)
    """

    force: np.ndarray  #: (3,) F, N
    moment: np.ndarray  #: (3,) M about the origin of the cells, N m
    centre: np.ndarray  #: (3,) mean place of the cells, weighted by force, m

    @property
    def normal(self) -> np.ndarray:
        """(3,) unit line of action."""
        return self.force / np.linalg.norm(self.force)

    @property
    def point(self) -> np.ndarray:
        """(3,) the point of the central axis nearest to the centre of the cells, m."""
        n = self.normal
        foot = np.cross(self.force, self.moment) / (self.force @ self.force)
        return foot + n * (n @ (self.centre - foot)) + 0.0

    @property
    def pitch(self) -> float:
        """Moment about the line of action that no mesh point can balance, over the force, m."""
        return float(self.normal @ self.moment / np.linalg.norm(self.force))

    @property
    def thesis_point(self) -> np.ndarray:
        """(3,) point by the formulas of the thesis, m; a force without a component along x or y, by
        which they divide, is refused.
        """
        fx, fy, fz = self.force
        if min(abs(fx), abs(fy)) < 1e-9 * np.linalg.norm(self.force):
            axis = "x" if abs(fx) < abs(fy) else "y"
            raise SolidgearError(
                f"the formulas of the thesis divide by the force along {axis}, which is zero; use "
                "the point on the central axis"
            )
        y = self.centre[1]
        x = (self.moment[2] + fx * y) / fy
        return np.array([x, y, (self.moment[1] + fz * x) / fx])

    def left_over(self, point: ArrayLike) -> float:
        """Return the size of the moment that the force at a point does not balance, N m."""
        return float(np.linalg.norm(self.moment - np.cross(np.asarray(point), self.force)))

    def mesh_stiffness(self, loaded_error: float, unloaded_error: float) -> float:
        """Return ``|F| / (e_L - e_0)`` (Hua 2010, 3.2.1), N/m."""
        if loaded_error == unloaded_error:
            raise SolidgearError(
                "the transmission error with and without load is the same; "
                "a mesh stiffness is the force over their difference"
            )
        return float(np.linalg.norm(self.force) / abs(loaded_error - unloaded_error))


def contact_wrench(
    points: Sequence[ArrayLike] | np.ndarray,
    normals: Sequence[ArrayLike] | np.ndarray,
    forces: ArrayLike,
) -> ContactWrench:
    """Return the wrench of contact cells at points (n, 3), m, with unit normals (n, 3) along the
    force on this member and forces (n,), N, not negative; cells that cancel are refused.
    """
    r, n, f = (np.asarray(a, float) for a in (points, normals, forces))
    if r.ndim != 2 or r.shape[1:] != (3,) or n.shape != r.shape or f.shape != (len(r),):
        raise SolidgearError("contact cells need points (n, 3), normals (n, 3) and forces (n,)")
    if np.any(np.abs(np.linalg.norm(n, axis=1) - 1) > 1e-6):
        raise SolidgearError("the normals of contact cells must be unit vectors within 1e-6")
    if np.any(f < 0):
        raise SolidgearError("a contact cell pulls; forces must not be negative")
    pushes = f[:, None] * n
    force = pushes.sum(axis=0)
    if not np.linalg.norm(force) > 1e-9 * f.sum():
        raise SolidgearError("the forces of the contact cells cancel; there is no line of action")
    return ContactWrench(force, np.cross(r, pushes).sum(axis=0), f @ r / f.sum())
