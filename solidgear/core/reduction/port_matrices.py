"""A body by mass and stiffness of its points, in physical coordinates, as programs exchange it.

Coordinates are the six motions of every point, point by point, then those of modes, which move no
point (Craig and Bampton 1968).  SI units; all points have the axes of the body.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg as sla

from solidgear.core.errors import SceneError, SolidgearError, listed
from solidgear.core.frames import DOF_NAMES, shift
from solidgear.core.reduction.matrix_units import MATRIX_UNITS, SI, MatrixUnits
from solidgear.core.reduction.superelement import PortMotion
from solidgear.core.registry import addition

MOST = 2000
#: asymmetry, over the diagonal, that typed or printed numbers leave
PRINTED = 1e-6
#: frequency of a rigid motion, over the first elastic one, that rounding of such numbers leaves
STILL = 1e-2
#: spans, m, and masses over cubes of them, kg/m^3, that machines have
SPANS, HEAVY = (1e-3, 20.0), (1e-2, 1e7)
#: sound in the stiffest metals does not reach this, m/s
SOUND = 1e4
#: name of the mean motion among the points
CENTRE = "centre"


@dataclass(frozen=True, eq=False)
class PortMatrices:
    """A body by the motions of points and modes; a part of a :class:`System`.

    Attributes
    ----------
    source : str
        File of the matrices, or what they were made from.
    mass, stiffness : (n, n) ndarray
        Symmetric, the first positive definite, SI.
    positions : dict of str to (3,) ndarray
        Points in the order of coordinates, m.
    damping : (n, n) ndarray or None
        Structural: the imaginary part of a stiffness whose losses do not depend on frequency, SI.
    gyroscopic : (n, n) ndarray or None
        Antisymmetric, times velocities, at the speed that `notes` name, SI.
    notes : tuple of str
        Sentences on what the body is, and what holds it.
    cautions : tuple of str
        Sentences on what the numbers leave out.

    Examples
    --------
    >>> import solidgear as sg
    >>> shaft = sg.port_matrices("geometry/shaft_stepped.toml", model="timoshenko", modes=3)
    >>> shaft.size, [*shaft.positions]
    (21, ['port', 'A', 'B'])
    >>> body = sg.build(sg.load("geometry/shaft_stepped.toml"), "timoshenko")
    >>> bool(abs(shaft.rigid_mass[0, 0] / body.mass_matrix()[0, 0] - 1) < 1e-9)
    True
    """

    source: str
    mass: np.ndarray
    stiffness: np.ndarray
    positions: dict[str, np.ndarray]
    damping: np.ndarray | None = None
    gyroscopic: np.ndarray | None = None
    notes: tuple[str, ...] = ()
    cautions: tuple[str, ...] = ()
    #: keys of a file beside ``matrices`` that they were read by: points and units
    keys: Mapping[str, Any] = field(default_factory=dict)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, PortMatrices):
            return NotImplemented
        same = self.matrices.keys() == other.matrices.keys()
        places = [(name, *place) for name, place in self.positions.items()]
        return (
            same
            and places == [(name, *place) for name, place in other.positions.items()]
            and all(np.array_equal(m, other.matrices[n]) for n, m in self.matrices.items())
        )

    __hash__ = object.__hash__

    def __repr__(self) -> str:
        points = f"{len(self.positions)} points ({listed(self.positions, 6)})"
        notes = "; ".join(self.notes)
        return f"<PortMatrices of {self.source}: {points}, {self.modes} modes; {notes}>"

    def __str__(self) -> str:
        return self.source

    def to_dict(self) -> dict[str, Any]:
        """Return the keys of a train file that read them: matrices, points and units."""
        return {"matrices": os.path.abspath(self.source), **self.keys}

    def write(self, path: Any, to: str = "", units: str = SI.name) -> list[Path]:
        """Write the matrices for another program, as :func:`solidgear.export`.

        Parameters
        ----------
        path : str or path
        to : str, optional
            Format, such as ``npz`` or ``nastran``; by default that of the ending.
        units : str

        Returns
        -------
        list of Path
            Files, whole ones or none.

        Raises
        ------
        SolidgearError
            For an unknown format, or a file that cannot be written.
        """
        return addition("matrices", "write")(self, path, to, units)

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return len(self.mass)

    @property
    def modes(self) -> int:
        """Number of coordinates that move no point."""
        return self.size - 6 * len(self.positions)

    @property
    def coordinates(self) -> list[str]:
        """Names of all coordinates, such as ``gear.thx`` and ``mode 1``."""
        of_points = [f"{name}.{dof}" for name in self.positions for dof in DOF_NAMES]
        return of_points + [f"mode {k}" for k in range(1, self.modes + 1)]

    @property
    def matrices(self) -> dict[str, np.ndarray]:
        """The matrices that there are, by name."""
        by_name = {
            "stiffness": self.stiffness,
            "mass": self.mass,
            "damping": self.damping,
            "gyroscopic": self.gyroscopic,
        }
        return {name: matrix for name, matrix in by_name.items() if matrix is not None}

    def in_units(self, units: MatrixUnits) -> dict[str, np.ndarray]:
        """Return the matrices in a system of units."""
        unit = units.matrix(len(self.positions), self.modes)
        return {name: matrix / unit for name, matrix in self.matrices.items()}

    def with_names(self, names: Sequence[str]) -> PortMatrices:
        """Return the same with other names of the points, in order."""
        return replace(self, positions=dict(zip(names, self.positions.values())))

    # the part of a system

    @property
    def strain(self) -> np.ndarray:
        """Rows (n - 6, n) of the elastic strain, exactly zero for rigid motions."""
        return self.elastic[1]

    @cached_property
    def ports(self) -> Mapping[str, PortMotion]:
        """Points, and the mean motion at the centre of mass."""
        rows, axes = np.eye(self.size), np.eye(3)
        points = {
            name: PortMotion(rows[6 * k : 6 * k + 6], place, axes)
            for k, (name, place) in enumerate(self.positions.items())
        }
        return {CENTRE: PortMotion(self.mean, self.centre, axes), **points}

    # rigid motions

    def rigid(self, about: np.ndarray | None = None) -> np.ndarray:
        """Return the (n, 6) coordinates of rigid motions about a point, the origin by default."""
        origin = np.zeros(3) if about is None else about
        moved = rigid_motions(place - origin for place in self.positions.values())
        return np.pad(moved, ((0, self.modes), (0, 0)))

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

    # the free body

    @cached_property
    def _factor(self) -> np.ndarray:
        try:
            return np.linalg.cholesky(self.mass)
        except np.linalg.LinAlgError:
            raise self.wrong("its mass is not positive definite") from None

    def wrong(self, reason: str) -> SceneError:
        """Return an error that names the file."""
        return SceneError(reason, where=self.source)

    @cached_property
    def _free(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Elastic frequencies (n - 6,), rad/s, strain rows, and the frequency of rigid motions."""
        lower = self._factor
        operator = sla.solve_triangular(lower, self.stiffness, lower=True)
        operator = sla.solve_triangular(lower, operator.T, lower=True)
        basis = np.linalg.qr(lower.T @ self.rigid(self.centre), mode="complete")[0]
        rigid_basis, elastic_basis = basis[:, :6], basis[:, 6:]
        square, turn = np.linalg.eigh(elastic_basis.T @ operator @ elastic_basis)
        least = np.sqrt(np.abs(np.linalg.eigvalsh(rigid_basis.T @ operator @ rigid_basis)).max())
        if not len(square) or square[0] <= 0:
            raise self.wrong(
                "its stiffness leaves more than six motions free, or is negative in one; for a "
                "rigid housing give mass, inertia and centre"
            )
        omega = np.sqrt(square)
        return omega, (lower @ elastic_basis @ turn * omega).T, float(least)

    @property
    def rigid_share(self) -> float:
        """Frequency of the stiffest rigid motion over that of the first elastic mode: zero, but for
        rounding, of a free body.
        """
        omega, _, least = self._free
        return least / float(omega[0])

    @property
    def elastic(self) -> tuple[np.ndarray, np.ndarray]:
        """Elastic frequencies (n - 6,) of the free body, rad/s, and strain rows (n - 6, n), exactly
        zero for rigid motions; refused for a body that is held.
        """
        omega, strain, least = self._free
        if least > STILL * omega[0]:
            raise self.wrong(
                f"its stiffness resists rigid motions (mode at {least / (2 * np.pi):.4g} Hz): give "
                f"the free body's, in SI, with positions in the axes of the body{self._hint()}"
            )
        return omega, strain

    @property
    def sentence(self) -> str:
        """How free the body is, and its first elastic mode."""
        return (
            f"free to {max(self.rigid_share, 1e-16):.0e} of its first mode at "
            f"{self.elastic[0][0] / (2 * np.pi):.1f} Hz"
        )

    def _hint(self) -> str:
        """Return the units of positions with which the body would be free."""
        if np.linalg.norm(self._span) == 0:
            return ""
        for units in MATRIX_UNITS.values():
            for factor in {units.length, 1 / units.length} - {1.0}:
                places = {name: place * factor for name, place in self.positions.items()}
                other = replace(self, positions=places)
                if np.linalg.det(other.rigid_mass) > 0 and other.rigid_share < STILL:
                    return (
                        f"; it would be free with positions {factor:.4g} times as large, so units "
                        "of positions and matrices differ"
                    )
        return ""

    @property
    def _span(self) -> np.ndarray:
        places = np.array([*self.positions.values()])
        return places.max(axis=0) - places.min(axis=0)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Sentences on mass, size and frequency that no machine has: wrong units most likely."""
        span, mass = float(np.linalg.norm(self._span)), float(self.rigid_mass[0, 0])
        hertz = float(self.elastic[0][0]) / (2 * np.pi)
        if not span:
            return ()
        out = []
        if not _usual(span, mass):
            stated = MATRIX_UNITS.get(str(self.keys.get("units")), SI)
            length, heavy = span / stated.length, mass * stated.length / stated.force  # as written
            fitting = [
                units
                for units in MATRIX_UNITS.values()
                if _usual(length * units.length, heavy * units.force / units.length)
            ]
            words = f", as of {fitting[0].words}: units = {fitting[0].name!r}" if fitting else ""
            out.append(f"a mass of {mass:.3g} kg on points {span:.3g} m apart is unusual{words}")
        elif hertz * span > SOUND:
            out.append(
                f"its first mode at {hertz:.3g} Hz is too high for {span:.3g} m of any metal: is "
                f"the mass of {mass:.3g} kg in tonnes, or the stiffness in other units?"
            )
        return tuple(out)


def rigid_motions(places: Iterable[np.ndarray]) -> np.ndarray:
    """Return the (6 p, 6) motions of places (3,) by unit rigid motions about the origin."""
    return np.vstack([shift(place) for place in places])


def _usual(span: float, mass: float) -> bool:
    """Return True for a span, m, and a mass, kg, that a part of a machine can have."""
    return SPANS[0] < span < SPANS[1] and HEAVY[0] < mass / span**3 < HEAVY[1]


def checked_matrices(
    source: str,
    matrices: Mapping[str, np.ndarray],
    positions: Mapping[str, Any],
    units: MatrixUnits = SI,
    notes: tuple[str, ...] = (),
) -> PortMatrices:
    """Return matrices of a file in SI; refuse shapes that do not fit, numbers that are none, and
    matrices that are not symmetric, each in a sentence with the name of the file.
    """

    def wrong(reason: str) -> SceneError:
        return SceneError(reason, where=source)

    missing = [name for name in ("mass", "stiffness") if name not in matrices]
    if missing:
        raise wrong(f"has no {missing[0]} matrix; mass and stiffness are needed")
    count = len(positions)
    mass = matrices["mass"]
    n = len(mass) if mass.ndim == 2 else 0
    fits = all(matrix.shape == (n, n) for matrix in matrices.values())
    if not fits or not 6 * max(count, 1) <= n <= MOST or (count == 1 and n == 6):
        shapes = ", ".join(f"{name} {matrix.shape}" for name, matrix in matrices.items())
        raise wrong(
            f"{shapes} and {count} points do not fit: matrices are all (n, n), n from six times "
            f"the points to {MOST}, and one point alone needs modes"
        )
    for name, matrix in {**matrices, "positions": np.array([*positions.values()])}.items():
        if matrix.dtype.kind not in "fiu" or not np.isfinite(matrix).all():
            raise wrong(f"{name} must be real and finite numbers")
    out = {}
    unit = units.matrix(count, n - 6 * count)
    for name, matrix in matrices.items():
        if name == "gyroscopic":
            out[name] = unit * (matrix - matrix.T) / 2
            continue
        size = np.sqrt(np.abs(np.diag(matrix)))
        if (np.abs(matrix - matrix.T) > PRINTED * np.outer(size, size)).any():
            raise wrong(f"{name} is not symmetric")
        out[name] = unit * (matrix.astype(float) + matrix.T) / 2
    places = {name: units.length * np.asarray(p, float) for name, p in positions.items()}
    return PortMatrices(source, positions=places, notes=notes, **out)


def named_once(names: list[str], source: str) -> None:
    """Refuse a point that is named twice."""
    if len({*names}) < len(names):
        raise SceneError("a point is named twice; each has a name of its own", where=source)


def not_free(matrices: PortMatrices) -> SolidgearError | None:
    """Return why the matrices are not those of a free body; None where they are."""
    try:
        _ = matrices.elastic
    except SceneError as error:
        return error
    return None
