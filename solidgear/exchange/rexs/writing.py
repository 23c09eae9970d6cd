"""REXS documents as text: XML, as it is read."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from solidgear.exchange.rexs.document import Attribute, Component, Document


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
