"""REXS documents as text and as files: XML, JSON, or XML in a zip, as they are read."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from solidgear.core import SolidgearError, listed
from solidgear.exchange.rexs.document import Attribute, Component, Document, Relation
from solidgear.exchange.rexs.units import UNIT_OF, WHOLE

#: when a zip says that its model was written: no file differs from the one before by its time
NO_DATE = (1980, 1, 1, 0, 0, 0)


def xml_of(document: Document) -> str:
    """Return a document as XML, which :func:`solidgear.exchange.rexs.reading.document_of` reads back
    equal.
    """
    root = Element("model", {**document.header, "version": document.version})
    relations = SubElement(root, "relations")
    for relation in document.relations:
        keys = {"id": str(relation.id), "type": relation.type}
        if relation.order is not None:
            keys["order"] = str(relation.order)
        element = SubElement(relations, "relation", keys)
        for ref in relation.refs:
            keys = {"id": str(ref.id), "role": ref.role}
            SubElement(element, "ref", keys | ({"hint": ref.hint} if ref.hint else {}))
    _add(SubElement(root, "components"), document.components.values())
    for spectrum in document.spectra:
        element = SubElement(root, "load_spectrum", {"id": str(spectrum.id)})
        for case in spectrum.cases:
            _add(SubElement(element, "load_case", {"id": str(case.id)}), case.components)
        if spectrum.accumulation:
            _add(SubElement(element, "accumulation"), spectrum.accumulation)
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _add(parent: Element, components: Iterable[Component]) -> None:
    for component in components:
        keys = {"id": str(component.id), "type": component.type}
        element = SubElement(parent, "component", keys | _name(component))
        for attribute in component.attributes.values():
            _add_attribute(element, attribute)


def _name(component: Component) -> dict[str, str]:
    return {"name": component.name} if component.name else {}


def _add_attribute(parent: Element, attribute: Attribute) -> None:
    keys = {"id": attribute.name} | ({"unit": attribute.unit} if attribute.unit else {})
    element, value = SubElement(parent, "attribute", keys), attribute.value
    if isinstance(value, str):
        element.text = value
        return
    block = SubElement(element, attribute.kind or "array")
    row_tag = {"matrix": "r", "array_of_arrays": "array"}.get(attribute.kind)
    for row in value:
        cells = [row] if isinstance(row, str) else row
        place = block if isinstance(row, str) else SubElement(block, row_tag or "array")
        for cell in cells:
            SubElement(place, "c").text = cell


def json_of(document: Document) -> str:
    """Return a document as JSON, which reads back with equal numbers."""
    components = [_component_table(c) for c in document.components.values()]
    model: dict[str, Any] = {**document.header, "version": document.version}
    model["relations"] = [_relation_table(relation) for relation in document.relations]
    model["components"] = components
    spectra = []
    for spectrum in document.spectra:
        cases = [
            {"id": case.id, "components": [*map(_component_table, case.components)]}
            for case in spectrum.cases
        ]
        table: dict[str, Any] = {"id": spectrum.id, "load_cases": cases}
        if spectrum.accumulation:
            parts = [*map(_component_table, spectrum.accumulation)]
            table["accumulation"] = {"components": parts}
        spectra.append(table)
    if spectra:
        model["load_spectrum"] = spectra
    return json.dumps({"model": model}, indent=1, ensure_ascii=False) + "\n"


def _relation_table(relation: Relation) -> dict[str, Any]:
    refs = [
        {"id": ref.id, "role": ref.role} | ({"hint": ref.hint} if ref.hint else {})
        for ref in relation.refs
    ]
    order = {} if relation.order is None else {"order": relation.order}
    return {"id": relation.id, "type": relation.type, **order, "refs": refs}


def _component_table(component: Component) -> dict[str, Any]:
    attributes = [_attribute_table(a) for a in component.attributes.values()]
    name = _name(component)
    return {"id": component.id, "type": component.type, **name, "attributes": attributes}


def _attribute_table(attribute: Attribute) -> dict[str, Any]:
    """Return an attribute with its value under the type of the value."""
    head = {"id": attribute.name, "unit": attribute.unit}
    value = attribute.value
    if not isinstance(value, str):
        if any(not isinstance(cell, str) for cell in value):
            raise SolidgearError(f"{attribute.name}: matrices are written as XML; use .rexs")
        return head | {"floating_point_array": [float(str(cell)) for cell in value]}
    if attribute.name in WHOLE:
        return head | {WHOLE[attribute.name]: int(value)}
    if value in ("true", "false"):
        return head | {"boolean": value == "true"}
    if UNIT_OF.get(attribute.name, "none") != "none" or attribute.name in NUMBERS:
        return head | {"floating_point": float(value)}
    return head | {"string": value}


#: numbers without a unit
NUMBERS = frozenset(
    "poisson_ratio addendum_modification_coefficient contamination_factor_iso_281_2007 "
    "addendum_coefficient_reference_profile tip_radius_factor direction_vector_gravity_u "
    "direction_vector_gravity_v direction_vector_gravity_w".split()
)


def _zipped(document: Document) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(zipfile.ZipInfo("model.rexs", NO_DATE), xml_of(document).encode())
    return packed.getvalue()


#: how a document is written, by the ending of its file
ENDINGS = {
    ".rexs": lambda document: xml_of(document).encode(),
    ".rexsj": lambda document: json_of(document).encode(),
    ".rexsz": _zipped,
}


def bytes_of(document: Document, path: Path) -> bytes:
    """Return a document as a file has it, by the ending of its name."""
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise SolidgearError(
            f"{path}: the ending {ending or 'none'!r} is none of REXS; use {listed(ENDINGS)}"
        )
    return ENDINGS[ending](document)
