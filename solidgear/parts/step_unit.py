"""The unit of length of the solids in a STEP file.

A file has units for much besides: of a density, of tolerances, of drawings.  Those of the coordinates
are in the context of the representation that holds the solids, ``GLOBAL_UNIT_ASSIGNED_CONTEXT``.  A
unit by conversion, whatever its name, carries its factor to another unit of the file.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from solidgear.core.meshing.quality import MeshError
from solidgear.parts.body_file import UNITS

#: relative difference of two units that their digits leave
SAME_UNIT = 1e-6
#: metres of SI units of length by their prefixes (ISO 10303-41)
PREFIXES = {
    b"": 1.0,
    **{b"KILO": 1e3, b"HECTO": 1e2, b"DECA": 1e1, b"DECI": 1e-1, b"CENTI": 1e-2},
    **{b"MILLI": 1e-3, b"MICRO": 1e-6, b"NANO": 1e-9},
}
#: units by conversion from one to another, as foot to inch to metre: more are a circle
MOST_STEPS = 8
#: a representation of a shape: its items and its context
_SHAPE = re.compile(
    rb"SHAPE_REPRESENTATION\s*\(\s*'(?:[^']|'')*'\s*,\s*\(([^()]*)\)\s*,\s*(#\d+)\s*\)"
)
_SOLID = re.compile(
    rb"(#\d+)\s*=\s*\(?\s*(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP)\s*\("
)
_UNITS = re.compile(rb"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^()]*)\)")
_NUMBER = re.compile(rb"#\d+")
_CONVERTED = re.compile(rb"CONVERSION_BASED_UNIT\s*\(\s*'(?:[^']|'')*'\s*,\s*(#\d+)")
#: a factor, alone or as a measure, and the unit that it counts
_FACTOR = re.compile(rb"MEASURE_WITH_UNIT\s*\(\s*(?:\w+\s*\(\s*)?([-+.\dE]+)\s*\)?\s*,\s*(#\d+)")
_SI = re.compile(rb"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.\s*\)")


def length_unit(content: bytes) -> float:
    """Return metres for each unit of length that a STEP file gives to its solids; MeshError where it
    gives none, or several.

    Examples
    --------
    >>> length_unit(
    ...     b"#1=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#2))REPRESENTATION_CONTEXT('',''));"
    ...     b"#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));"
    ...     b"#3=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));#4=DERIVED_UNIT_ELEMENT(#3,-3.);"
    ... )
    0.001
    """
    texts = {text for context in _contexts(content) for text in _units_of(context, content)}
    lengths = [text for text in texts if b"LENGTH_UNIT" in text]
    units = sorted({unit for text in lengths if (unit := _metres(text, content))})
    if not units:
        raise MeshError(
            "names no unit of length for its solids, neither of SI nor by conversion: export it again"
        )
    if not math.isclose(units[0], units[-1], rel_tol=SAME_UNIT):
        names = ", ".join(map(unit_words, units))
        raise MeshError(f"names several units of length ({names}) for its solids")
    return next(
        (v for v in UNITS.values() if math.isclose(v, units[0], rel_tol=SAME_UNIT)), units[0]
    )


def unit_words(unit: float) -> str:
    """Return a unit of so many metres as files write it, or in metres.

    Examples
    --------
    >>> unit_words(0.0254), unit_words(0.3048)
    ('inch', 'units of 0.3048 m')
    """
    names = (name for name, v in UNITS.items() if math.isclose(v, unit, rel_tol=SAME_UNIT))
    return next(names, f"units of {unit:g} m")


def _contexts(content: bytes) -> list[bytes]:
    """Return the contexts of the representations that hold solids; of all shapes, or all there are,
    where none does.
    """
    shapes = [(_NUMBER.findall(items), context) for items, context in _SHAPE.findall(content)]
    solids = set(_SOLID.findall(content))
    names = {context for items, context in shapes if solids & {*items}}
    names = names or {context for _, context in shapes}
    chosen = [_text(name, content) for name in names]
    return [text for text in chosen if _UNITS.search(text)] or [content]


def _units_of(context: bytes, content: bytes) -> Iterator[bytes]:
    """Yield the texts of the units that a context names."""
    for units in _UNITS.findall(context):
        for name in _NUMBER.findall(units):
            yield _text(name, content)


def _text(name: bytes, content: bytes) -> bytes:
    """Return the text of an entity such as ``#12``; empty where the file has none."""
    match = re.search(rb"(?<![\d#])" + name + rb"\s*=([^;]*);", content)
    return match[1] if match else b""


def _metres(text: bytes, content: bytes) -> float | None:
    """Return metres for each of a unit of length, of SI or by conversion; None for others."""
    factor = 1.0
    for _ in range(MOST_STEPS):
        if plain := _SI.search(text):
            prefix = PREFIXES.get(plain[1] or b"")
            return None if prefix is None else factor * prefix
        converted = _CONVERTED.search(text)
        step = converted and _FACTOR.search(_text(converted[1], content))
        if not step:
            return None
        try:
            factor *= float(step[1])
        except ValueError:
            return None
        text = _text(step[2], content)
    return None
