"""Unit of length of the shape in a STEP file.

A file has units for much besides: of a density, of tolerances, of drawings. Those of the coordinates are
in the context of the representation that holds the solids, ``GLOBAL_UNIT_ASSIGNED_CONTEXT``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from solidgear.meshing.quality import MeshError

#: a representation of a shape: its items and its context
_SHAPE = re.compile(
    rb"SHAPE_REPRESENTATION\s*\(\s*'(?:[^']|'')*'\s*,\s*\(([^()]*)\)\s*,\s*(#\d+)\s*\)"
)
_SOLID = re.compile(
    rb"(#\d+)\s*=\s*\(?\s*(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP)\s*\("
)
_UNITS = re.compile(rb"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^()]*)\)")
_NUMBER = re.compile(rb"#\d+")
_PREFIX = {b"MILLI": "mm", b"CENTI": "cm", b"": "m"}


def unit_said(content: bytes) -> str:
    """Name of the unit of length that a STEP file gives to its solids; MeshError where it gives none that
    is known here, or several.

    Examples
    --------
    >>> unit_said(
    ...     b"#1=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#2))REPRESENTATION_CONTEXT('',''));"
    ...     b"#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));"
    ...     b"#3=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));#4=DERIVED_UNIT_ELEMENT(#3,-3.);"
    ... )
    'mm'
    """
    texts = {text for context in _contexts(content) for text in _units_of(context, content)}
    lengths = [text for text in texts if b"LENGTH_UNIT" in text]
    said = sorted({unit for unit in map(_unit_of, lengths) if unit})
    if len(said) != 1:
        what = f"several units of length ({', '.join(said)})" if said else "no unit of length"
        raise MeshError(
            f"names {what} that is known here for its solids; known are mm, cm, m and inch"
        )
    return said[0]


def _contexts(content: bytes) -> list[bytes]:
    """Contexts of the representations that hold solids; of all shapes, or all there are, where none
    does.
    """
    shapes = [(_NUMBER.findall(items), context) for items, context in _SHAPE.findall(content)]
    solids = set(_SOLID.findall(content))
    names = {context for items, context in shapes if solids & {*items}}
    names = names or {context for _, context in shapes}
    chosen = [_text(name, content) for name in names]
    return [text for text in chosen if _UNITS.search(text)] or [content]


def _units_of(context: bytes, content: bytes) -> Iterator[bytes]:
    """Texts of the units that a context names."""
    for units in _UNITS.findall(context):
        for name in _NUMBER.findall(units):
            yield _text(name, content)


def _text(name: bytes, content: bytes) -> bytes:
    """Text of an entity such as ``#12``; empty where the file has none."""
    found = re.search(rb"(?<![\d#])" + name + rb"\s*=([^;]*);", content)
    return found[1] if found else b""


def _unit_of(text: bytes) -> str | None:
    converted = re.search(rb"CONVERSION_BASED_UNIT\s*\(\s*'([^']*)'", text)
    if converted:
        name = converted[1].strip().upper()
        return "inch" if name in (b"INCH", b"IN") else None
    plain = re.search(rb"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.\s*\)", text)
    return _PREFIX.get(plain[1] or b"") if plain else None
