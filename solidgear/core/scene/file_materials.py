"""Materials that a mesh file gives, in a system of units that it does not give."""

from __future__ import annotations

from solidgear.core.scene.parts import Material
from solidgear.core.scene.typed import Model

#: Pa and kg/m^3 for each unit of stress and of density in systems of units of decks: SI; N, mm, t;
#: mN, mm, kg; kN, mm, kg (with ms); N and cm; kgf and mm; lbf and inch with lbf s^2/in, with lb
SYSTEMS = (
    (1.0, 1.0),
    (1e6, 1e12),
    (1e3, 1e9),
    (1e9, 1e9),
    (1e6, 1e9),
    (1e4, 1e6),
    (9.80665e6, 9.80665e12),
    (6894.757, 1.068692e7),
    (6894.757, 27679.9),
)
#: relative difference of E and density, and difference of nu, up to which they are the same number
SAME, SAME_NU = 5e-3, 5e-3


class FileMaterial(Model):
    """An isotropic material of a mesh file."""

    name: str  #: in the file
    group: str  #: of elements of this material
    #: E, nu, density: in the units of the file; None where the file gives none
    E: float | None = None
    nu: float | None = None
    density: float | None = None

    def is_like(self, material: Material) -> bool:
        """Return True where it equals a material of a scene in some system of units."""
        if self.nu is not None and abs(self.nu - material.nu) > SAME_NU:
            return False
        return any(
            _is_equal(self.E, stress, material.E)
            and _is_equal(self.density, dense, material.density)
            for stress, dense in SYSTEMS
        )

    @property
    def numbers(self) -> str:
        """Constants that the file gives, in a sentence."""
        constants = (("E", self.E), ("nu", self.nu), ("density", self.density))
        return ", ".join(f"{key} {value:.6g}" for key, value in constants if value is not None)


def _is_equal(file_value: float | None, unit: float, value: float) -> bool:
    return file_value is None or abs(file_value * unit / value - 1) <= SAME
