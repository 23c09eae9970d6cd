"""A geared pair of rotors as 14 degrees of freedom: engine, pinion, gear and load.

The pair is a :class:`solidgear.core.system.System` of two inertias and two rigid bodies at their lumped
points, each in its own frame (drawn in :mod:`solidgear.core.system.gear_mesh`).  The system keeps
springs as strain rows and solves the modes; here are the words of its energies.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.core.system.gear_mesh import MeshVector
from solidgear.core.system.links import BearingSpring, Link, mesh_spring, torsion_spring
from solidgear.core.system.parts import Inertia, Part, RigidBody
from solidgear.core.system.system import System

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


def diagonal_mass(mass: float, torsional: float, bending: float) -> np.ndarray:
    """(6, 6) mass matrix of a body of revolution at its centre of mass (equation 17).

    Parameters
    ----------
    mass : float
        kg.
    torsional, bending : float
        Moments of inertia about y, and about x and z, kg m^2.
    """
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
    energy : (14, 7) ndarray
        Fraction of each mode's strain energy in every one of `COMPONENTS`.  Rows sum to 1; those of
        rigid motions, which strain nothing, are zero.  "Translation" and "bending" are the
        translations and tilts of a lumped point on its 6x6, the cross terms shared equally, so a
        fraction can be slightly negative; "rotation" is the torsional spring to the engine or load.
    """

    frequency_hz: np.ndarray
    energy: np.ndarray

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
    pinion_mass, gear_mass : (6, 6) ndarray
        At the lumped point; see `diagonal_mass`.
    pinion_support, gear_support : (6, 6) ndarray
        K_ll with a zero torsion row; from `solidgear.condense` or `shaft_stiffness`.
    pinion_torsion, gear_torsion : float
        Spring from engine to pinion and from gear to load, N m/rad.
    mesh_stiffness : float
        k_m, N/m.
    pinion_mesh, gear_mesh : MeshVector
        h_p and h_g with *one* physical direction n, so that the transmission error is ``h_p q_p -
        h_g q_g``.

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
            "pinion support": BearingSpring("pinion", self.pinion_support),
            "gear support": BearingSpring("gear", self.gear_support),
            "pinion rotation": torsion_spring("engine", self.pinion_torsion, "pinion"),
            "gear rotation": torsion_spring("gear", self.gear_torsion, "load"),
            "mesh": mesh_spring(
                "pinion", self.pinion_mesh, "gear", self.gear_mesh, self.mesh_stiffness
            ),
        }
        return System(parts, links)

    def solve(self) -> PairModes:
        """All 14 undamped modes."""
        found = self.system.modes()
        shares = dict(found.energy)
        total = (2 * np.pi * found.frequency_hz) ** 2
        strain, where = self.system.strains
        stretch = strain @ found.shapes
        for body in ("pinion", "gear"):
            place, rows = self.system.place(body), where[f"{body} support"]
            each = (strain[rows, place].T @ stretch[rows]) * found.shapes[place]
            for name, components in (("translation", TRANSLATION), ("bending", TILT)):
                energy = each[components].sum(axis=0)
                shares[f"{body} {name}"] = np.divide(
                    energy, total, out=np.zeros_like(energy), where=total > 0
                )
        return PairModes(found.frequency_hz, np.column_stack([shares[name] for name in COMPONENTS]))
