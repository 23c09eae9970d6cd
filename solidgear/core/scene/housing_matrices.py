"""Elastic housing by mass and stiffness of its points, as other programs reduce it to them.

Coordinates are the six motions of every point, point by point, in the axes of the train, then those
of modes, which move no point (Craig and Bampton 1968).  SI units.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as sla

from solidgear.core.errors import SceneError
from solidgear.core.frames import shift

ARRAYS = ("mass", "stiffness", "points", "positions")
MOST = 2000
#: asymmetry, over the diagonal, that typed or printed numbers leave
PRINTED = 1e-6
#: frequency of a rigid motion, over the first elastic one, that rounding of such numbers leaves
STILL = 1e-2


@dataclass(frozen=True, eq=False)
class HousingMatrices:
    """A free elastic body by the motions of points and modes."""

    source: str  #: file of the matrices
    #: mass, stiffness: (n, n) symmetric, the first positive definite, SI
    mass: np.ndarray
    stiffness: np.ndarray
    positions: dict[str, np.ndarray]  #: of the points in the order of coordinates, m

    def __eq__(self, other: object) -> bool:
        return isinstance(other, HousingMatrices) and (
            np.array_equal(self.mass, other.mass)
            and np.array_equal(self.stiffness, other.stiffness)
            and [*self.positions] == [*other.positions]
            and all(np.array_equal(a, other.positions[n]) for n, a in self.positions.items())
        )

    __hash__ = object.__hash__

    @cached_property
    def _factor(self) -> np.ndarray:
        try:
            return np.linalg.cholesky(self.mass)
        except np.linalg.LinAlgError:
            raise self._wrong("its mass is not positive definite") from None

    def _wrong(self, reason: str) -> SceneError:
        return SceneError(reason, where=self.source)

    def rigid(self, about: np.ndarray | None = None) -> np.ndarray:
        """Return the (n, 6) coordinates of rigid motions about a point, the origin by default."""
        about = np.zeros(3) if about is None else about
        moved = [shift(place - about) for place in self.positions.values()]
        return np.pad(np.vstack(moved), ((0, len(self.mass) - 6 * len(moved)), (0, 0)))

    @cached_property
    def centre(self) -> np.ndarray:
        """(3,) centre of mass, m."""
        inertia = self.rigid().T @ self.mass @ self.rigid()
        return np.array([inertia[1, 5], inertia[2, 3], inertia[0, 4]]) / inertia[0, 0]

    @cached_property
    def rigid_mass(self) -> np.ndarray:
        """(6, 6) mass matrix about the centre of mass."""
        return self.rigid(self.centre).T @ self.mass @ self.rigid(self.centre)

    @cached_property
    def mean(self) -> np.ndarray:
        """(6, n) motion of a rigid body with the same momentum, at the centre of mass."""
        return np.linalg.solve(self.rigid_mass, self.rigid(self.centre).T @ self.mass)

    @cached_property
    def elastic(self) -> tuple[np.ndarray, np.ndarray]:
        """Elastic frequencies (n - 6,) of the free body, rad/s, and strain rows (n - 6, n), exactly
        zero for rigid motions.
        """
        lower = self._factor
        operator = sla.solve_triangular(lower, self.stiffness, lower=True)
        operator = sla.solve_triangular(lower, operator.T, lower=True)
        basis = np.linalg.qr(lower.T @ self.rigid(self.centre), mode="complete")[0]
        rigid_basis, elastic_basis = basis[:, :6], basis[:, 6:]
        square, turn = np.linalg.eigh(elastic_basis.T @ operator @ elastic_basis)
        least = np.sqrt(np.abs(np.linalg.eigvalsh(rigid_basis.T @ operator @ rigid_basis)).max())
        if not len(square) or square[0] <= 0:
            raise self._wrong(
                "its stiffness leaves more than six motions free, or is negative in one; for a "
                "rigid housing give mass, inertia and centre"
            )
        omega = np.sqrt(square)
        if least > STILL * omega[0]:
            frequency = least / (2 * np.pi)
            raise self._wrong(
                f"its stiffness resists rigid motions (mode at {frequency:.4g} Hz): give the free "
                "body's, in SI, with positions in the axes of the train"
            )
        return omega, (lower @ elastic_basis @ turn * omega).T


def read_matrices(path: str | os.PathLike) -> HousingMatrices:
    """Read an elastic housing from an ``.npz`` file with ``mass``, ``stiffness`` (n, n), ``points``,
    the names of p points, and ``positions`` (p, 3); refuse matrices that are not of a free body.
    """
    file_path = os.fspath(path)
    try:
        with np.load(file_path, allow_pickle=False) as store:
            missing = [name for name in ARRAYS if name not in store]
            if missing:
                reason = f"has no array {missing[0]!r}; it holds {', '.join(ARRAYS)}"
                raise SceneError(reason, where=file_path)
            mass, stiffness, points, positions = (store[name] for name in ARRAYS)
    except (OSError, ValueError, TypeError, AttributeError) as error:
        cause = getattr(error, "strerror", None) or "not an .npz file of NumPy"
        raise SceneError(f"the matrices cannot be read: {cause}", where=file_path) from None
    names = [str(name) for name in points.ravel()]
    n = len(mass) if mass.ndim == 2 else 0
    shapes = mass.shape == stiffness.shape == (n, n) and positions.shape == (len(names), 3)
    if not shapes or not 6 * max(len(names), 2) <= n <= MOST:
        raise SceneError(
            f"mass {mass.shape}, stiffness {stiffness.shape}, {len(names)} points and positions "
            f"{positions.shape} do not fit: of p points, two or more, they are (n, n), (n, n) and "
            f"(p, 3), n from 6 p to {MOST}",
            where=file_path,
        )
    if len({*names}) < len(names):
        raise SceneError("a point is named twice; each has a name of its own", where=file_path)
    for name, matrix in (("mass", mass), ("stiffness", stiffness), ("positions", positions)):
        if matrix.dtype.kind not in "fiu" or not np.isfinite(matrix).all():
            raise SceneError(f"{name} must be real and finite numbers, SI", where=file_path)
    for name, matrix in (("mass", mass), ("stiffness", stiffness)):
        size = np.sqrt(np.abs(np.diag(matrix)))
        if (np.abs(matrix - matrix.T) > PRINTED * np.outer(size, size)).any():
            raise SceneError(f"{name} is not symmetric", where=file_path)
    mass, stiffness = (
        (matrix + matrix.T) / 2 for matrix in (mass.astype(float), stiffness.astype(float))
    )
    housing = HousingMatrices(file_path, mass, stiffness, dict(zip(names, positions.astype(float))))
    housing.elastic  # noqa: B018  refuses a body that is not free
    return housing
