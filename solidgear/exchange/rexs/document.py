"""A REXS document: components with attributes, relations between them, load spectra.

Values stay as the file has them, so that a document is written as it was read; numbers are asked for
in SI, under the names of version 1.4, whatever the version.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import isfinite

from solidgear.core import SolidgearError, show
from solidgear.exchange.rexs.units import OTHER_NAMES, REST, TYPES, UNIT_OF, UNITS, scaled

#: a value: text, numbers in a row, or rows
Value = str | tuple[str, ...] | tuple[tuple[str, ...], ...]
#: relations that say what is part of what
ASSEMBLY = ("assembly", "ordered_assembly")
#: what joins a gear to its shaft, by the relation ``side``, in place of a relation of both
JOINTS = (
    "cylindrical_interference_fit",
    "tapered_interference_fit",
    "feather_key_connection",
    "involute_spline_connection",
)


class RexsError(SolidgearError):
    """A REXS document that cannot be used as written."""


@dataclass(frozen=True)
class Attribute:
    """A value of a component, with its unit."""

    name: str
    value: Value
    unit: str = ""
    kind: str = ""  #: array, matrix or array_of_arrays; empty for one value


@dataclass(frozen=True)
class Component:
    """A part of the gearbox."""

    id: int
    type: str
    name: str = ""
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    @property
    def kind(self) -> str:
        """Type by its name from 1.3 on."""
        return TYPES.get(self.type, self.type)

    @property
    def label(self) -> str:
        """Type, number and name, as messages and comments call it."""
        name = f" {show(self.name, 60)}" if self.name else ""
        return f"{self.type} {self.id}{name}"

    @property
    def title(self) -> str:
        """Name in a line about several: that of the file, or type and number."""
        return show(self.name, 60).strip('"') if self.name.strip() else f"{self.type} {self.id}"

    def attribute(self, name: str) -> Attribute | None:
        """Return an attribute by its name of 1.4, or those of other versions; None where it is not
        there, or empty.
        """
        for word in (name, *OTHER_NAMES.get(name, ())):
            attribute = self.attributes.get(word)
            if attribute is not None and attribute.value not in ("", ()):
                return attribute
        return None

    def text(self, name: str) -> str:
        """Return the text of an attribute; empty where there is none."""
        attribute = self.attribute(name)
        if attribute is None or not isinstance(attribute.value, str):
            return ""
        return attribute.value.strip()

    def flag(self, name: str) -> bool | None:
        """Return a truth value; None where there is none."""
        word = self.text(name).lower()
        if not word:
            return None
        if word not in ("true", "false"):
            raise self.wrong(name, "must be true or false")
        return word == "true"

    def number(self, name: str) -> float | None:
        """Return a number in SI (temperatures in degrees Celsius); None where there is none."""
        attribute = self.attribute(name)
        if attribute is None:
            return None
        if not isinstance(attribute.value, str):
            raise self.wrong(name, "must be one number")
        return self._si(attribute, attribute.value)

    def numbers(self, name: str) -> tuple[float, ...] | None:
        """Return the numbers of an array in SI; None where there are none."""
        attribute = self.attribute(name)
        if attribute is None:
            return None
        row = attribute.value
        if isinstance(row, str) or not all(isinstance(entry, str) for entry in row):
            raise self.wrong(name, "must be an array of numbers")
        return tuple(self._si(attribute, str(entry)) for entry in row)

    def whole(self, name: str) -> int | None:
        """Return a whole number; None where there is none."""
        number = self.number(name)
        if number is None:
            return None
        if number != round(number):
            raise self.wrong(name, "must be a whole number")
        return round(number)

    def wrong(self, name: str, reason: str) -> RexsError:
        """Return the error of an attribute, with its value as the file has it."""
        attribute = self.attribute(name)
        if attribute is None:
            return RexsError(f"{self.label}: {name}: {reason}")
        value = attribute.value
        shown = value if isinstance(value, str) else show(list(value))
        shown = shown if len(shown) <= 70 else f"{shown[:67]}..."
        unit = "" if attribute.unit in ("", "none") else f" {attribute.unit}"
        return RexsError(f"{self.label}: {attribute.name} = {shown}{unit}: {reason}")

    def _si(self, attribute: Attribute, text: str) -> float:
        words = (w for w, others in OTHER_NAMES.items() if attribute.name in others)
        name = next(words, attribute.name)
        usual = UNIT_OF.get(name, "none")
        unit = attribute.unit.strip() or usual
        dimension, factor = UNITS.get(unit, ("", 1.0))
        if dimension != UNITS[usual][0]:
            wanted = "no unit" if usual == "none" else usual
            raise self.wrong(attribute.name, f"{unit!r} is not its unit; REXS has {wanted}")
        try:
            number = float(text)
        except ValueError:
            number = float("nan")
        if not isfinite(number):
            raise self.wrong(attribute.name, "must be a finite number")
        return scaled(number, factor)

    def with_attributes(self, attributes: Mapping[str, Attribute]) -> Component:
        """Return the component with further attributes, or others in place of its own."""
        return Component(self.id, self.type, self.name, {**self.attributes, **attributes})


@dataclass(frozen=True)
class Ref:
    """A component in a relation."""

    id: int
    role: str
    hint: str = ""


@dataclass(frozen=True)
class Relation:
    """Components that belong together, each with its role."""

    id: int
    type: str
    refs: tuple[Ref, ...]
    order: int | None = None

    def ids(self, role: str) -> list[int]:
        """Return the components in a role."""
        return [ref.id for ref in self.refs if ref.role == role]


@dataclass(frozen=True)
class LoadCase:
    """Attributes of components under a load."""

    id: int
    components: tuple[Component, ...]


@dataclass(frozen=True)
class Spectrum:
    """Load cases, and what results of all of them together."""

    id: int
    cases: tuple[LoadCase, ...]
    accumulation: tuple[Component, ...] = ()


@dataclass(frozen=True)
class Document:
    """A REXS document.

    Attributes
    ----------
    version : str
        Such as ``1.4``.
    header : Mapping of str to str
        What the head of the file says: applicationId, applicationVersion, date.
    components : Mapping of int to Component
        By their numbers.
    relations : tuple of Relation
    spectra : tuple of Spectrum

    Raises
    ------
    RexsError
        Relations or load cases with components that are not there, and parts of themselves.
    """

    version: str
    components: Mapping[int, Component]
    relations: tuple[Relation, ...] = ()
    spectra: tuple[Spectrum, ...] = ()
    header: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for relation in self.relations:
            for ref in relation.refs:
                if ref.id not in self.components:
                    raise RexsError(
                        f"relation {relation.id} ({relation.type}): names component {ref.id} as "
                        f"{ref.role}, and there is none of this number"
                    )
        for spectrum in self.spectra:
            for case in spectrum.cases:
                for component in case.components:
                    if component.id not in self.components:
                        raise RexsError(
                            f"load_case {case.id}: names component {component.id}, and there is "
                            "none of this number"
                        )
        _refuse_cycles(self.parts)

    @cached_property
    def is_ours(self) -> bool:
        """True for a document that this program wrote, whoever wrote it since: its names are those of
        files.
        """
        return any(REST in component.attributes for component in self.components.values())

    @cached_property
    def parts(self) -> dict[int, list[int]]:
        """Parts of each component, in the order of the file or of the relations; a gear that a fit, a
        key or a spline holds is a part of its shaft.
        """
        out: dict[int, list[tuple[int, int]]] = {}
        for relation in self.relations:
            if relation.type not in ASSEMBLY:
                continue
            for whole in relation.ids("assembly"):
                place = relation.order or 0
                out.setdefault(whole, []).extend((place, part) for part in relation.ids("part"))
        for joint in self.of_kind(*JOINTS):
            if (pair := self.joined(joint)) is not None:
                pairs = out.setdefault(pair[0].id, [])
                pairs += [(0, pair[1].id)] * (pair[1].id not in (part for _, part in pairs))
        return {whole: [p for _, p in sorted(pairs, key=_place)] for whole, pairs in out.items()}

    def sides_of(self, link: Component) -> tuple[Component, Component] | None:
        """Return what a bearing, a coupling or a fit joins, inside and outside; None where the file
        does not say.
        """
        for relation in self.related("side", link, "assembly"):
            inner, outer = relation.ids("inner_part"), relation.ids("outer_part")
            if inner and outer:
                return self.components[inner[0]], self.components[outer[0]]
        return None

    def joined(self, joint: Component) -> tuple[Component, Component] | None:
        """Return the shaft and the gear that a fit, a key or a spline joins; None for others."""
        sides = self.sides_of(joint)
        if sides is None:
            return None
        shaft, gear = sides if sides[0].kind == "shaft" else sides[::-1]
        is_pair = shaft.kind == "shaft" and gear.kind.endswith("_gear")
        return (shaft, gear) if is_pair else None

    def of_kind(self, *kinds: str) -> list[Component]:
        """Return the components of some types, in the order of the file."""
        return [c for c in self.components.values() if c.kind in kinds]

    def parts_of(self, component: Component, *kinds: str) -> list[Component]:
        """Return the parts of a component that are of some types."""
        parts = (self.components[part] for part in self.parts.get(component.id, ()))
        return [part for part in parts if part.kind in kinds]

    def whole_of(self, component: Component, *kinds: str) -> Component | None:
        """Return what a component is a part of, among some types."""
        for whole, parts in self.parts.items():
            if component.id in parts and self.components[whole].kind in kinds:
                return self.components[whole]
        return None

    def related(self, relation_type: str, component: Component, role: str) -> Iterator[Relation]:
        """Yield the relations of a type in which a component has a role."""
        for relation in self.relations:
            if relation.type == relation_type and component.id in relation.ids(role):
                yield relation

    def referenced(self, component: Component, kind: str) -> list[Component]:
        """Return the components of a type that a component refers to, such as its material."""
        out = []
        for relation in self.relations:
            if relation.type not in ("reference", "ordered_reference"):
                continue
            if component.id in relation.ids("origin"):
                out += [self.components[i] for i in relation.ids("referenced")]
        return [other for other in out if other.kind == kind]


def _place(pair: tuple[int, int]) -> int:
    return pair[0]


def _refuse_cycles(parts: Mapping[int, list[int]]) -> None:
    """Refuse components that are parts of themselves."""
    sound: set[int] = set()
    for first in parts:
        path, stack = [first], [iter(parts.get(first, ()))]
        while stack:
            part = next(stack[-1], None)
            if part is None:
                sound.add(path.pop())
                stack.pop()
            elif part in path:
                raise RexsError(f"component {part} is a part of itself: relations close a circle")
            elif part not in sound:
                path.append(part)
                stack.append(iter(parts.get(part, ())))
