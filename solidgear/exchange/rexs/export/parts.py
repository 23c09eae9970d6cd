"""A REXS document that grows: components with attributes in the units of REXS, and relations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from solidgear.exchange.rexs.document import (
    Attribute,
    Component,
    Document,
    LoadCase,
    Ref,
    Relation,
    Spectrum,
)
from solidgear.exchange.rexs.units import OURS, UNIT_OF, UNITS, scaled

VERSION = "1.4"
#: relations in which REXS asks for an order
ORDERED = ("ordered_assembly", "manufacturing_step")
#: axes of a frame in REXS, u v w, among x y z of a scene: u lies along the shaft
UVW = (1, 2, 0)


def number_text(number: float, unit: str) -> str:
    """Return a number in SI in a unit of REXS: the shortest text that reads back equal, or the nearest.

    Examples
    --------
    >>> number_text(0.08, "mm"), number_text(1 / 3, "mm")
    ('80', '333.3333333333333')
    """
    factor = UNITS[unit][1]
    for digits in range(1, 18):
        text = f"{number / factor:.{digits}g}"
        if scaled(float(text), factor) == number:
            return repr(float(text)).removesuffix(".0")
    return repr(number / factor)


def attribute_of(name: str, value: Any) -> Attribute:
    """Return an attribute of a value in SI, in the unit that REXS has for it."""
    unit = UNIT_OF.get(name, "none")
    if isinstance(value, bool):
        return Attribute(name, str(value).lower(), unit)
    if isinstance(value, str):
        return Attribute(name, value, unit)
    if isinstance(value, int):
        return Attribute(name, str(value), unit)
    if isinstance(value, (Sequence, np.ndarray)):
        row = tuple(number_text(float(number), unit) for number in value)
        return Attribute(name, row, unit, "array")
    return Attribute(name, number_text(float(value), unit), unit)


class Parts:
    """Components, relations and load cases of a document, in the order in which they are added."""

    def __init__(self) -> None:
        self.components: dict[int, Component] = {}
        self.relations: list[Relation] = []
        self.cases: list[LoadCase] = []
        self.unit = self.add("gear_unit", **self.frame(np.zeros(3), np.eye(3), 1))
        self.casing = self.add("gear_casing", whole=self.unit)

    def add(
        self, kind: str, name: str = "", whole: int = 0, by: str = "assembly", **attributes: Any
    ) -> int:
        """Add a component, as a part of another where its number is given; return its number."""
        number = len(self.components) + 1
        given = {key: attribute_of(key, v) for key, v in attributes.items() if v is not None}
        self.components[number] = Component(number, kind, name, given)
        if whole:
            self.relate(by, assembly=whole, part=number)
        return number

    def add_cylinder(self, shaft: int, length: float, diameter: float) -> None:
        """Add the section of a shaft that is a cylinder, from its beginning."""
        self.add(
            "shaft_section",
            whole=shaft,
            u_coordinate_on_shaft=0.0,
            length=length,
            outer_diameter_begin=diameter,
            outer_diameter_end=diameter,
            inner_diameter_begin=0.0,
            inner_diameter_end=0.0,
        )

    def write(self, number: int, **attributes: Any) -> None:
        """Add attributes to a component."""
        given = {key: attribute_of(key, v) for key, v in attributes.items() if v is not None}
        self.components[number] = self.components[number].with_attributes(given)

    def relate(self, kind: str, **roles: int) -> None:
        """Add a relation between components by their roles."""
        refs = tuple(
            Ref(number, role, self.components[number].type) for role, number in roles.items()
        )
        order = 1 if kind in ORDERED else None
        self.relations.append(Relation(len(self.relations) + 1, kind, refs, order))

    def add_case(self, components: Iterable[Component]) -> None:
        """Add a load case."""
        self.cases.append(LoadCase(len(self.cases) + 1, tuple(components)))

    def frame(self, origin: np.ndarray, axes: np.ndarray, reference: int = 0) -> dict[str, Any]:
        """Return the attributes of a frame by its origin, m, and its axes x, y, z as columns, both in
        x, y, z of the first shaft.
        """
        turned = np.asarray(axes)[UVW, :]
        # a turned zero may be minus zero
        return {
            "support_vector": np.asarray(origin)[list(UVW)] + 0.0,
            "u_axis_vector": 1e-3 * turned[:, 1] + 0.0,
            "w_axis_vector": 1e-3 * turned[:, 0] + 0.0,
            "reference_component_for_position": reference or self.unit,
        }

    def document(self) -> Document:
        """Return the document."""
        spectra = (Spectrum(1, tuple(self.cases)),) if self.cases else ()
        header = {"version": VERSION, "applicationId": OURS}
        return Document(VERSION, self.components, tuple(self.relations), spectra, header)
