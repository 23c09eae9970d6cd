"""A geared pair of rotors as 14 degrees of freedom: engine, pinion, gear and load.

Coordinates, in this order (Hua 2010, equations 15 and 16)::

    0        engine thy
    1 ..  6  pinion x y z thx thy thz     in the pinion's frame, at its lumped point
    7 .. 12  gear   x y z thx thy thz     in the gear's frame, at its lumped point
    13       load thy

Both frames are drawn in :mod:`solidgear.system.gear_mesh`.  The pair is a
:class:`solidgear.system.System` of two inertias and two rigid bodies, which keeps springs as strain
rows and solves the modes; here are its checks, its matrices and the words of its energies.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.frames import DOF_NAMES
from solidgear.system.gear_mesh import MeshVector
from solidgear.system.links import Link, RowSpring, mesh_spring, torsion_spring
from solidgear.system.modes import relative_residual
from solidgear.system.parts import Inertia, Part, RigidBody
from solidgear.system.system import System

ENGINE, LOAD = 0, 13
PINION, GEAR = slice(1, 7), slice(7, 13)
PINION_THY, GEAR_THY = 5, 11
NAMES = (
    "engine thy",
    *(f"pinion {d}" for d in DOF_NAMES),
    *(f"gear {d}" for d in DOF_NAMES),
    "load thy",
)
# Components of the strain energy in the order and words of Hua (2010), figure 3.8 (a).
COMPONENTS = (
    "pinion translation",
    "gear translation",
    "pinion rotation",
    "gear rotation",
    "pinion bending",
    "gear bending",
    "mesh",
)
TRANSLATION, TILT = [0, 1, 2], [3, 5]
# Published 6x6 carry seven digits at the very most: a torsion row or a negative eigenvalue below
# this is rounding.
ROUNDING = 1e-9


def diagonal_mass(mass: float, torsional: float, bending: float) -> np.ndarray:
    """(6, 6) mass matrix of a body of revolution at its centre of mass (equation 17).

    Parameters
    ----------
    mass : float
        kg.
    torsional, bending : float
        Moments of inertia about y, and about x and z, kg m^2.
    """
    for name, value in (
        ("mass", mass),
        ("torsional inertia", torsional),
        ("bending inertia", bending),
    ):
        _positive(name, value)
    return np.diag([mass, mass, mass, bending, torsional, bending]).astype(float)


def shaft_stiffness(translation: float, axial: float, tilt: float, coupling: float) -> np.ndarray:
    """(6, 6) lumped stiffness of a shaft of revolution on bearings; torsion is free.

    Parameters
    ----------
    translation, axial : float
        kxx = kzz and kyy, N/m.
    tilt : float
        kthx = kthz, N m/rad.
    coupling : float
        kx,thz, N/rad; kz,thx is its negative.  Negative where the bearings lie at larger y than the lumped point.
    """
    out = np.diag([translation, axial, translation, tilt, 0.0, tilt]).astype(float)
    out[0, 5] = out[5, 0] = coupling
    out[2, 3] = out[3, 2] = -coupling
    return out


@dataclass(frozen=True, eq=False)
class PairModes:
    """Undamped modes of a :class:`LumpedPair`.

    Attributes
    ----------
    frequency_hz : (14,) ndarray
        Ascending; rigid motions are exactly 0.0.
    shapes : (14, 14) ndarray
        One mode a column, mass-normalised.
    energy : (14, 7) ndarray
        Fraction of each mode's strain energy in every one of `COMPONENTS`.  Rows sum to 1; those of
        rigid motions, which strain nothing, are zero.  "Translation" and "bending" are the
        translations and tilts of a lumped point on its 6x6, the cross terms shared equally, so a
        fraction can be slightly negative; "rotation" is the torsional spring to the engine or load.
    residual : float
        Largest ``|K u - w^2 M u|`` relative to ``|K| |u|``.
    """

    frequency_hz: np.ndarray
    shapes: np.ndarray
    energy: np.ndarray
    residual: float

    @property
    def rigid(self) -> int:
        """Number of zero frequencies."""
        return int((self.frequency_hz == 0).sum())

    def dominant(self) -> list[str]:
        """Component with the largest fraction for every mode, ``rigid`` where there is none."""
        return [COMPONENTS[int(np.argmax(e))] if e.any() else "rigid" for e in self.energy]


@dataclass(frozen=True, eq=False)
class LumpedPair:
    """Two rigid gears on shaft-bearing stiffnesses, coupled by a mesh spring, between an engine and
    a load.

    Attributes
    ----------
    engine_inertia, load_inertia : float
        About the shaft, kg m^2.
    pinion_mass, gear_mass : (6, 6) array_like
        Symmetric positive definite at the lumped point; see `diagonal_mass`.
    pinion_support, gear_support : (6, 6) array_like
        K_ll, symmetric positive semidefinite with a zero torsion row; from `solidgear.condense` or
        `shaft_stiffness`.
    pinion_torsion, gear_torsion : float
        Spring from engine to pinion and from gear to load, N m/rad, not negative.
    mesh_stiffness : float
        k_m, N/m, not negative.
    pinion_mesh, gear_mesh : MeshVector
        h_p and h_g with *one* physical direction n, so that the transmission error is ``h_p q_p -
        h_g q_g``.

    Raises
    ------
    SolidgearError
        In one sentence, for what no such pair can have.

    References
    ----------
    Hua (2010), equations 5 and 14 to 18 (matrices), 21 to 23 (mesh), figure 3.8 (energies).
    """

    engine_inertia: float
    load_inertia: float
    pinion_mass: np.ndarray
    gear_mass: np.ndarray
    pinion_support: np.ndarray
    gear_support: np.ndarray
    pinion_torsion: float
    gear_torsion: float
    mesh_stiffness: float
    pinion_mesh: MeshVector
    gear_mesh: MeshVector

    def __post_init__(self):
        for field in fields(self):
            value, name = getattr(self, field.name), field.name.replace("_", " ")
            if name in ("pinion mesh", "gear mesh"):
                if not isinstance(value, MeshVector):
                    raise SolidgearError(f"{name} must be a MeshVector, not {type(value).__name__}")
            elif name.endswith("inertia"):
                _positive(name, value)
            elif name.endswith("mass"):
                object.__setattr__(self, field.name, _mass(name, value))
            elif name.endswith("support"):
                object.__setattr__(self, field.name, _support(name, value))
            elif not (_is_finite(value) and value >= 0):
                raise SolidgearError(
                    f"{name} is {value}; it must be a finite stiffness that is not negative"
                )

    @cached_property
    def transmission(self) -> np.ndarray:
        """(14,) row that gives the dynamic transmission error (equation 23), m."""
        row = np.zeros(14)
        row[PINION] = self.pinion_mesh.vector
        row[GEAR] = -self.gear_mesh.vector
        return row

    @cached_property
    def train_rotation(self) -> np.ndarray:
        """(14,) rotation of the whole train that strains no spring, the faster side turning by 1
        rad.
        """
        lever_p, lever_g = self.pinion_mesh.lever, self.gear_mesh.lever
        if lever_p == 0 and lever_g == 0:
            raise SolidgearError(
                "the line of action meets both shafts, so the mesh transmits no rotation; check the mesh vectors"
            )
        turn = np.zeros(14)
        size = max(abs(lever_p), abs(lever_g))
        turn[[ENGINE, PINION_THY]], turn[[GEAR_THY, LOAD]] = lever_g / size, lever_p / size
        return turn

    @cached_property
    def system(self) -> System:
        """The pair as parts and links: ``engine``, ``pinion``, ``gear``, ``load``."""
        parts: dict[str, Part] = {
            "engine": Inertia(self.engine_inertia),
            "pinion": RigidBody(self.pinion_mass),
            "gear": RigidBody(self.gear_mass),
            "load": Inertia(self.load_inertia),
        }
        links: dict[str, Link] = {
            "pinion support": RowSpring("pinion", _root(self.pinion_support)),
            "gear support": RowSpring("gear", _root(self.gear_support)),
        }
        if self.pinion_torsion > 0:
            links["pinion torsion"] = torsion_spring("engine", self.pinion_torsion, "pinion")
        if self.gear_torsion > 0:
            links["gear torsion"] = torsion_spring("gear", self.gear_torsion, "load")
        if self.mesh_stiffness > 0:
            links["mesh"] = mesh_spring(
                "pinion", self.pinion_mesh, "gear", self.gear_mesh, self.mesh_stiffness
            )
        return System(parts, links)

    @property
    def strains(self) -> tuple[np.ndarray, dict[str, slice]]:
        """``G`` with ``K = G'G``, and which rows belong to which spring."""
        return self.system.strains

    def matrices(self) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness and mass (14, 14), SI (equations 17 and 18), assembled from the springs and not
        from `strains`.
        """
        k, m = np.zeros((14, 14)), np.zeros((14, 14))
        k[PINION, PINION], k[GEAR, GEAR] = self.pinion_support, self.gear_support
        m[PINION, PINION], m[GEAR, GEAR] = self.pinion_mass, self.gear_mass
        m[ENGINE, ENGINE], m[LOAD, LOAD] = self.engine_inertia, self.load_inertia
        for i, j, spring in (
            (ENGINE, PINION_THY, self.pinion_torsion),
            (GEAR_THY, LOAD, self.gear_torsion),
        ):
            k[np.ix_([i, j], [i, j])] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
        return k + self.mesh_stiffness * np.outer(self.transmission, self.transmission), m

    def solve(self) -> PairModes:
        """All 14 undamped modes."""
        k, m = self.matrices()
        found = self.system.modes()
        shapes, omega = found.shapes, 2 * np.pi * found.frequency_hz
        if found.rigid == 1 and self.pinion_torsion * self.gear_torsion * self.mesh_stiffness > 0:
            # Known exactly, so not left to rounding.
            turn = self.train_rotation
            shapes[:, 0] = turn / np.sqrt(turn @ m @ turn)
            shapes = self.system.signed(shapes)
        energy = self._energy(shapes, omega, *self.strains)
        return PairModes(found.frequency_hz, shapes, energy, relative_residual(k, m, shapes, omega))

    def _energy(self, shapes, omega, strain, where) -> np.ndarray:
        """(14, 7) fractions; see `PairModes.energy`."""
        stretch = strain @ shapes
        out = np.zeros((14, len(COMPONENTS)))
        for k, (body, place) in enumerate((("pinion", PINION), ("gear", GEAR))):
            rows = where[f"{body} support"]
            force = strain[rows, place].T @ stretch[rows]
            each = force * shapes[place]
            out[:, k] = each[TRANSLATION].sum(axis=0)
            out[:, 4 + k] = each[TILT].sum(axis=0)
            if f"{body} torsion" in where:
                out[:, 2 + k] = (stretch[where[f"{body} torsion"]] ** 2).sum(axis=0)
        if "mesh" in where:
            out[:, 6] = (stretch[where["mesh"]] ** 2).sum(axis=0)
        out[omega == 0] = 0.0
        total = out.sum(axis=1, keepdims=True)
        return np.divide(out, total, out=np.zeros_like(out), where=total > 0)


def _is_finite(value: Any) -> bool:
    return bool(np.isscalar(value) and np.isfinite(value))


def _positive(name: str, value: float) -> None:
    if not (_is_finite(value) and value > 0):
        raise SolidgearError(f"{name} is {value}; it must be finite and positive")


def _square(name: str, value) -> np.ndarray:
    try:
        out = np.array(value, float)
    except (TypeError, ValueError):
        raise SolidgearError(f"{name} must be a 6x6 of numbers in SI") from None
    if out.shape != (6, 6):
        raise SolidgearError(
            f"{name} has shape {out.shape}; it must be 6x6 in the order {' '.join(DOF_NAMES)}"
        )
    if not np.isfinite(out).all():
        raise SolidgearError(f"{name} contains NaN or infinity; all entries must be finite")
    # Relative to the diagonals, since rows mix N/m with N m/rad.
    d = np.sqrt(np.abs(np.outer(np.diag(out), np.diag(out))))
    if (np.abs(out - out.T) > ROUNDING * np.maximum(d, np.abs(out))).any():
        raise SolidgearError(f"{name} is not symmetric; entry (i, j) must equal (j, i)")
    out = (out + out.T) / 2
    out.setflags(write=False)
    return out


def _mass(name: str, value) -> np.ndarray:
    out = _square(name, value)
    d = np.diag(out)
    if (d <= 0).any():
        i = int(np.argmin(d))
        raise SolidgearError(
            f"{name} has {d[i]:g} for {DOF_NAMES[i]}; every mass and inertia must be positive"
        )
    if np.linalg.eigvalsh(out / np.sqrt(np.outer(d, d))).min() <= ROUNDING:
        raise SolidgearError(
            f"{name} is not positive definite; its off-diagonal entries are too large for its diagonal"
        )
    return out


def _support(name: str, value) -> np.ndarray:
    out = _square(name, value)
    if out[4].any():
        raise SolidgearError(
            f"{name} resists thy; its torsion row and column must be zero, torsion is the spring to the engine or load"
        )
    d = np.diag(out)
    safe = np.sqrt(np.where(d > 0, d, 1.0))
    if (d < 0).any() or np.linalg.eigvalsh(out / np.outer(safe, safe)).min() < -ROUNDING:
        raise SolidgearError(
            f"{name} is indefinite; no shaft on bearings releases energy, check the signs of kx,thz and kz,thx"
        )
    return out


def _root(stiffness: np.ndarray) -> np.ndarray:
    """(r, 6) rows ``R`` with ``R'R`` the stiffness and r its rank; scaled first, so that every
    spring keeps its own precision.
    """
    d = np.sqrt(np.diag(stiffness))
    safe = np.where(d > 0, d, 1.0)
    w, v = np.linalg.eigh(stiffness / np.outer(safe, safe))
    keep = w > ROUNDING
    return (np.sqrt(w[keep])[:, None] * v[:, keep].T) * d
