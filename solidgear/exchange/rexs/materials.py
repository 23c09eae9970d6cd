"""Materials of a REXS document."""

from __future__ import annotations

from typing import Any

from solidgear.core.scene.materials import MATERIALS
from solidgear.exchange.rexs.commented import Sourced, said
from solidgear.exchange.rexs.document import Component
from solidgear.exchange.rexs.gearbox import Gearbox

STEEL = MATERIALS["steel"]


def material_of(gearbox: Gearbox, *parts: Component) -> Component | None:
    """Return the material of the first of some parts that names one."""
    for part in parts:
        for material in gearbox.document.referenced(part, "material"):
            return material
    return None


def density_of(gearbox: Gearbox, *parts: Component) -> tuple[float, str]:
    """Return the density of parts by their material, kg/m^3, and where it came from."""
    material = material_of(gearbox, *parts)
    density = None if material is None else material.number("density")
    if material is not None and density is None:
        gearbox.notes.assume(material, "has no density: that of steel is taken")
    if material is None or density is None:
        return STEEL.density, "assumed: steel"
    return density, f"{material.label}: density"


def material_table(gearbox: Gearbox, part: Component) -> dict[str, Any]:
    """Return the material of a shaft: what the file leaves out is that of steel."""
    material = material_of(gearbox, part)
    if material is None:
        gearbox.notes.assume("shafts without a material", "are of steel: 210 GPa, 0.3, 7850 kg/m^3")
    rows = (
        ("E", "elastic_modulus", STEEL.E, lambda v: said(v, "GPa", 1e9)),
        ("nu", "poisson_ratio", STEEL.nu, lambda v: v),
        ("density", "density", STEEL.density, lambda v: said(v, "kg/m^3")),
    )
    table = {}
    for key, name, usual, text in rows:
        value = None if material is None else material.number(name)
        source = "assumed: steel" if material is None else f"{material.label}: {name}"
        if value is None and material is not None:
            gearbox.notes.assume(material, f"has no {name}: that of steel is taken")
            source = "assumed: steel"
        table[key] = Sourced(text(usual if value is None else value), source)
    return table
