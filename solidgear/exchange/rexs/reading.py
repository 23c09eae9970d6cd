"""REXS files as documents: XML, JSON, either in a zip; nothing in a file is trusted.

A file is read up to a size, elements are counted while they come, a document type (which entities
need) is refused, and a zip is unpacked up to the same size whatever it says of itself.
"""

from __future__ import annotations

import base64
import binascii
import json
import re
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

import numpy as np

from solidgear.core import show
from solidgear.exchange.rexs.document import (
    Attribute,
    Component,
    Document,
    LoadCase,
    Ref,
    Relation,
    RexsError,
    Spectrum,
    Value,
)

#: bytes of a file, and of one unpacked: models with all results take some ten million
LARGEST = 100_000_000
#: elements of a file, and how deep they lie: model, load_spectrum, load_case, component, attribute,
#: array_of_arrays, array, c
MOST_ELEMENTS, DEEPEST = 5_000_000, 12
#: numbers of coded arrays
CODES = {"int32": "<i4", "float32": "<f4", "float64": "<f8"}


def read(path: Path) -> Document:
    """Return the document of a file.

    Raises
    ------
    RexsError
        A file that is not there, too large, broken or none of REXS; the sentence names it.
    """
    try:
        return document_of(_bytes(path))
    except OSError as error:
        reason = error.strerror or str(error)
        raise RexsError(f"{path}: cannot be read ({reason}); name a REXS file") from None
    except RexsError as error:
        raise RexsError(f"{path}: {error}") from None


def document_of(data: bytes) -> Document:
    """Return the document in the bytes of a file, whatever its form."""
    if len(data) > LARGEST:
        raise RexsError(f"is larger than {LARGEST // 1_000_000} MB, and no gearbox")
    if data[:4] == b"PK\x03\x04":
        data = _unpacked(data)
    start = data.lstrip(b"\xef\xbb\xbf\xff\xfe\0 \t\r\n")[:1]
    if start == b"{":
        return _of_json(data)
    if start == b"<":
        return _of_xml(data)
    raise RexsError("is no REXS file: neither XML (<model ...>), nor JSON, nor a zip of one")


def _bytes(path: Path) -> bytes:
    if not path.is_file():
        known = "is a folder" if path.is_dir() else "there is no such file"
        raise RexsError(f"{known}; name a REXS file, such as gearbox.rexs")
    with path.open("rb") as file:
        return file.read(LARGEST + 1)


def _unpacked(data: bytes) -> bytes:
    """Return the one model in a zip."""
    import io  # start-up: for zipped files alone

    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = [
                name
                for name in archive.namelist()
                if name.lower().endswith((".rexs", ".rexsj", ".xml", ".json"))
                and not name.startswith("__MACOSX")
            ]
            models = [n for n in names if n.lower().endswith((".rexs", ".rexsj"))] or names
            if len(models) != 1:
                count = f"{len(models)} models ({show(models)})" if models else "no .rexs or .rexsj"
                raise RexsError(f"the zip holds {count}; one is needed")
            with archive.open(models[0]) as file:
                content = file.read(LARGEST + 1)
    except (zipfile.BadZipFile, EOFError, NotImplementedError, RuntimeError, ValueError) as error:
        raise RexsError(f"is a broken or locked zip ({error}); export it again") from None
    except Exception as error:
        if type(error).__module__ != "zlib":
            raise
        raise RexsError(f"is a broken zip ({error}); export it again") from None
    if len(content) > LARGEST:
        raise RexsError(f"unpacks to more than {LARGEST // 1_000_000} MB, and no gearbox")
    return content


# --------------------------------------------------------------------------- XML
def _tree(data: bytes) -> Element:
    """Return the root of an XML file; refuse document types, too many and too deep elements."""
    builder, parser = TreeBuilder(), expat.ParserCreate()
    depth = count = 0

    def plain(name: str) -> str:
        return name.rpartition(":")[2]

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > DEEPEST or count > MOST_ELEMENTS:
            raise RexsError(
                f"line {parser.CurrentLineNumber}: elements lie deeper than {DEEPEST}, or are more "
                f"than {MOST_ELEMENTS}, and no REXS file has so many"
            )
        builder.start(plain(name), attributes)

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(plain(name))

    def refuse(*_: Any) -> None:
        raise RexsError("has a document type (<!DOCTYPE ...>), which REXS has not and is not read")

    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = builder.data, refuse
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise RexsError(
            f"line {error.lineno}: is no whole XML ({expat.ErrorString(error.code)}); the file is "
            "cut off or was edited: export it again"
        ) from None
    except (LookupError, ValueError) as error:
        raise RexsError(f"its text cannot be read ({error}); save it as UTF-8") from None
    return builder.close()


def _of_xml(data: bytes) -> Document:
    root = _tree(data)
    if root.tag != "model":
        raise RexsError(f"is no REXS file: it begins with <{root.tag[:40]}>, not with <model>")
    components = [_component(e) for e in root.iterfind("components/component")]
    relations = [
        Relation(
            _id(e, "relation"),
            e.get("type", ""),
            tuple(
                Ref(_id(ref, "ref"), ref.get("role", ""), ref.get("hint", ""))
                for ref in e.iterfind("ref")
            ),
            _whole(e.get("order"), "order of a relation") if e.get("order") else None,
        )
        for e in root.iterfind("relations/relation")
    ]
    spectra = [
        Spectrum(
            _id(e, "load_spectrum"),
            tuple(
                LoadCase(
                    _id(case, "load_case"),
                    tuple(_component(c) for c in case.iterfind("component")),
                )
                for case in e.iterfind("load_case")
            ),
            tuple(_component(c) for c in e.iterfind("accumulation/component")),
        )
        for e in root.iterfind("load_spectrum")
    ]
    return _document(dict(root.attrib), components, relations, spectra)


def _component(element: Element) -> Component:
    number, kind = _id(element, "component"), element.get("type", "")
    attributes = [_attribute(e) for e in element.iterfind("attribute")]
    return _with_attributes(number, kind, element.get("name", ""), attributes)


def _attribute(element: Element) -> Attribute:
    name, unit = element.get("id", ""), element.get("unit", "")
    value: Value = (element.text or "").strip()
    kind = ""
    for child in element:
        kind = child.tag
        if child.tag == "array":
            value = _array(child, name)
        elif child.tag == "array_of_arrays":
            value = tuple(_array(row, name) for row in child.iterfind("array"))
        elif child.tag == "matrix":
            value = _matrix(child, name)
        else:
            raise RexsError(f"attribute {name}: <{child.tag[:40]}> is no value of REXS")
    return Attribute(name, value, unit, kind)


def _array(element: Element, name: str) -> tuple[str, ...]:
    if code := element.get("code"):
        return _decoded(code, element.text or "", name)
    return tuple((c.text or "").strip() for c in element.iterfind("c"))


def _matrix(element: Element, name: str) -> tuple[tuple[str, ...], ...]:
    if code := element.get("code"):
        size = [_whole(element.get(key), f"{key} of {name}") for key in ("rows", "columns")]
        return _rows(_decoded(code, element.text or "", name), size[0], size[1], name)
    rows = element.iterfind("r")
    return tuple(tuple((c.text or "").strip() for c in row.iterfind("c")) for row in rows)


def _decoded(code: str, text: str, name: str) -> tuple[str, ...]:
    """Return the numbers of a coded array, in the bytes of the machines that have least first."""
    if code not in CODES:
        raise RexsError(f"attribute {name}: code {show(code)}; REXS has {', '.join(CODES)}")
    try:
        data = base64.b64decode("".join(text.split()), validate=True)
        numbers = np.frombuffer(data, dtype=CODES[code])
    except (binascii.Error, ValueError):
        raise RexsError(
            f"attribute {name}: is no whole base64 of {code}; export it again"
        ) from None
    return tuple(map(repr, numbers.tolist()))


def _rows(
    numbers: tuple[str, ...], rows: int, columns: int, name: str
) -> tuple[tuple[str, ...], ...]:
    if rows < 0 or columns < 0 or rows * columns != len(numbers):
        raise RexsError(
            f"attribute {name}: {len(numbers)} numbers do not fill {rows} rows of {columns}"
        )
    return tuple(numbers[k * columns : (k + 1) * columns] for k in range(rows))


# --------------------------------------------------------------------------- JSON
def _of_json(data: bytes) -> Document:
    try:
        model = json.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise RexsError(f"not UTF-8 text (byte {error.start}); save it as UTF-8") from None
    except RecursionError:
        raise RexsError("is nested too deeply, and no REXS file") from None
    except ValueError as error:
        raise RexsError(f"is no whole JSON ({error}); export it again") from None
    model = model.get("model") if isinstance(model, dict) else None
    if not isinstance(model, dict):
        raise RexsError('is no REXS file: it has no "model"')
    components = [_json_component(c) for c in _tables(model, "components")]
    relations = [
        Relation(
            _whole(r.get("id"), "id of a relation"),
            str(r.get("type", "")),
            tuple(
                Ref(
                    _whole(ref.get("id"), "id of a ref"),
                    str(ref.get("role", "")),
                    str(ref.get("hint", "")),
                )
                for ref in _tables(r, "refs")
            ),
            None if r.get("order") is None else _whole(r["order"], "order of a relation"),
        )
        for r in _tables(model, "relations")
    ]
    given = model.get("load_spectrum")
    several = {"spectra": [given] if isinstance(given, dict) else given or []}
    shared = model.get("accumulation")
    spectra = []
    for spectrum in _tables(several, "spectra"):
        sums = spectrum.get("accumulation", shared)
        cases = [
            LoadCase(
                _whole(case.get("id"), "id of a load case"),
                tuple(_json_component(c) for c in _tables(case, "components")),
            )
            for case in _tables(spectrum, "load_cases")
        ]
        summed = _tables(sums, "components") if isinstance(sums, dict) else []
        number = _whole(spectrum.get("id"), "id of a load spectrum")
        spectra.append(Spectrum(number, tuple(cases), tuple(map(_json_component, summed))))
    header = {key: value for key, value in model.items() if isinstance(value, str)}
    return _document(header, components, relations, spectra)


def _tables(table: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
    """Return the tables under a key; refuse anything else there."""
    rows = table.get(key) or []
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise RexsError(f"{key}: must be a list of objects, not {show(rows)}")
    return rows


def _json_component(table: Mapping[str, Any]) -> Component:
    number = _whole(table.get("id"), "id of a component")
    attributes = [_json_attribute(a) for a in _tables(table, "attributes")]
    return _with_attributes(
        number, str(table.get("type") or ""), str(table.get("name") or ""), attributes
    )


def _json_attribute(table: Mapping[str, Any]) -> Attribute:
    name, unit = str(table.get("id", "")), str(table.get("unit") or "")
    key = next((k for k in table if k not in ("id", "unit")), "")
    value = table.get(key)
    if value is False and name.endswith("_vector"):
        value = None  # an empty array, as some writers have it
    if isinstance(value, dict) and key.endswith("_coded"):
        numbers = _decoded(str(value.get("code")), str(value.get("value", "")), name)
        if "matrix" not in key:
            return Attribute(name, numbers, unit, "array")
        size = [_whole(value.get(k), f"{k} of {name}") for k in ("rows", "columns")]
        return Attribute(name, _rows(numbers, size[0], size[1], name), unit, "matrix")
    if isinstance(value, list) and all(isinstance(row, list) for row in value) and value:
        kind = "array_of_arrays" if key.startswith("array_of") else "matrix"
        return Attribute(name, tuple(tuple(map(_text, row)) for row in value), unit, kind)
    if isinstance(value, list):
        return Attribute(name, tuple(map(_text, value)), unit, "array")
    if isinstance(value, dict):
        raise RexsError(f"attribute {name}: {show(value)} is no value of REXS")
    return Attribute(name, _text(value), unit)


def _text(value: Any) -> str:
    """Return a value of JSON as XML has it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    return value.strip() if isinstance(value, str) else repr(value)


# --------------------------------------------------------------------------- both
def _document(
    header: Mapping[str, str],
    components: Iterable[Component],
    relations: Iterable[Relation],
    spectra: Iterable[Spectrum],
) -> Document:
    version = header.get("version", "")
    if not re.fullmatch(r"[12](\.\d{1,3}){0,2}", version):
        missing = "has no version" if not version else f"is of version {show(version, 30)}"
        raise RexsError(f"{missing}; REXS 1.0 to 2.0 are read")
    by_id: dict[int, Component] = {}
    for component in components:
        if component.id in by_id:
            raise RexsError(f"component {component.id} is there twice; numbers are given once")
        if not component.type:
            raise RexsError(f"component {component.id} has no type")
        by_id[component.id] = component
    if not by_id:
        raise RexsError("holds no components")
    # nothing refers to a relation, so that its number may be there twice
    return Document(version, by_id, tuple(relations), tuple(spectra), dict(header))


def _with_attributes(
    number: int, kind: str, name: str, attributes: Iterable[Attribute]
) -> Component:
    by_name: dict[str, Attribute] = {}
    for attribute in attributes:
        if not attribute.name:
            raise RexsError(f"component {number}: an attribute has no id")
        if attribute.name in by_name:
            raise RexsError(
                f"component {number} ({kind}): the attribute {attribute.name} is there twice"
            )
        by_name[attribute.name] = attribute
    return Component(number, kind, name, by_name)


def _id(element: Element, what: str) -> int:
    return _whole(element.get("id"), f"id of a {what}")


def _whole(value: Any, what: str) -> int:
    """Return a whole number of a file."""
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    if isinstance(value, str) and re.fullmatch(r"\s*-?\d{1,15}\s*", value):
        return int(value)
    given = "is missing" if value is None else f"is {show(value, 30)}"
    raise RexsError(f"the {what} {given}; it is a whole number")
