"""Materials by name, with the sources of their constants.

A standard gives one modulus to a whole group: plain and low-alloy steels lie within 2 % of 210 GPa
whatever their strength and heat treatment, and suppliers' sheets of one grade differ by as much.
Where 2 % of stiffness matter, measure, and give E.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from solidgear.core.errors import SceneError, nearest, show
from solidgear.core.scene.written import Word

STEEL_SOURCE = "EN 1993-1-1:2005, 3.2.6, and EN 1991-1-1:2002, table A.4: all structural steels"
IRON_SOURCE = "EN 1563, informative annex on further properties"
LIGHT_SOURCE = "EN 1999-1-1:2007, 3.2.5: wrought alloys"


@dataclass(frozen=True)
class MaterialConstants:
    """Constants of a material in SI, and their source."""

    E: float  #: pa
    nu: float
    density: float  #: kg/m^3
    source: str


_STEEL = MaterialConstants(210e9, 0.3, 7850.0, STEEL_SOURCE)
_ALUMINIUM = MaterialConstants(70e9, 0.3, 2700.0, LIGHT_SOURCE)
_FERRITIC = MaterialConstants(169e9, 0.275, 7100.0, IRON_SOURCE)

MATERIALS = {
    "steel": _STEEL,
    "S235": _STEEL,
    "S275": _STEEL,
    "S355": _STEEL,
    "E295": _STEEL,
    "E335": _STEEL,
    "E360": _STEEL,
    "C45": _STEEL,
    "C60": _STEEL,
    "34CrMo4": _STEEL,
    "42CrMo4": _STEEL,
    "50CrMo4": _STEEL,
    "34CrNiMo6": _STEEL,
    "16MnCr5": _STEEL,
    "20MnCr5": _STEEL,
    "18CrNiMo7-6": _STEEL,
    "100Cr6": _STEEL,
    "EN-GJS-400": _FERRITIC,
    "EN-GJS-500": _FERRITIC,
    "EN-GJS-600": MaterialConstants(174e9, 0.275, 7200.0, IRON_SOURCE),
    "EN-GJS-700": MaterialConstants(176e9, 0.275, 7200.0, IRON_SOURCE),
    "aluminium": _ALUMINIUM,
}
#: type of the name of a material
MaterialName = Annotated[str, Word(tuple(MATERIALS))]
#: materials without constants, and why
NONE_OF_ITS_OWN = {
    "lamination": "a laminated stack has no fixed E, since pressing and welding decide; give the E that "
    "fits a measured first bending",
}


def by_name(value: Any) -> Any:
    """Return the constants of a material given by name; anything else as it is.

    Examples
    --------
    >>> by_name("42CrMo4")
    {'E': 210000000000.0, 'nu': 0.3, 'density': 7850.0, 'name': '42CrMo4'}
    """
    if not isinstance(value, str):
        return value
    for word, reason in NONE_OF_ITS_OWN.items():
        if word[:6] in value.lower():
            raise SceneError(reason)
    names = {name.lower(): name for name in MATERIALS}
    name = names.get(value.strip().lower())
    if name is None:
        raise SceneError(
            f"material {show(value, 40)} is not known by name{nearest(value, MATERIALS)}; "
            f"give E, nu and density, or one of {', '.join(MATERIALS)}"
        )
    constants = MATERIALS[name]
    return {"E": constants.E, "nu": constants.nu, "density": constants.density, "name": name}


def as_table(material: Any) -> Any:
    """Return the table that stands for the name of a material in a file; anything else as it is.

    Examples
    --------
    >>> as_table("42CrMo4")
    {'E': '210 GPa', 'nu': 0.3, 'density': '7850 kg/m^3'}
    """
    try:
        constants = by_name(material) if isinstance(material, str) else None
    except SceneError:
        return material  # refused by the reader of the file
    if constants is None:
        return material
    modulus, density = f"{constants['E'] / 1e9:g} GPa", f"{constants['density']:g} kg/m^3"
    return {"E": modulus, "nu": constants["nu"], "density": density}
