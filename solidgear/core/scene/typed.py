"""Base of all data of scenes and trains: frozen, validated, with a sentence for every problem."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from inspect import Parameter, Signature
from keyword import iskeyword
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic.fields import FieldInfo

from solidgear.core.errors import MOST_PROBLEMS, SceneError, did_you_mean, near, scene_error
from solidgear.core.scene.bearing_stiffness import STIFFNESS_NAMES

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)

_Self = TypeVar("_Self", bound="Model")
_Read = TypeVar("_Read")

#: words of the field for what a scene calls otherwise
OTHER_WORDS = {
    "fx": "x",
    "fy": "y",
    "fz": "z",
    "mx": "thx",
    "mz": "thz",
    "rho": "density",
    "young": "E",
    "youngs_modulus": "E",
    "modulus": "E",
    "poisson": "nu",
    "poissons_ratio": "nu",
    "poisson_ratio": "nu",
    "name": "title",
    "at": "position",
    "y": "position",
    "width": "seat_width",
    "d": "diameter",
    "dia": "diameter",
    "od": "diameter",
    "outer_diameter": "diameter",
    "id": "bore",
    "di": "bore",
    "inner_diameter": "bore",
    "bore_diameter": "bore",
    "l": "length",
    "m": "mass",
    "k": "stiffness",
    "yield": "yield_point",
    "yield_strength": "yield_point",
    "re": "yield_point",
    "rp02": "yield_point",
    "rm": "ultimate",
    "tensile_strength": "ultimate",
}


#: names that pydantic gives every model, hidden from help() and completion
PYDANTIC = frozenset(name for name in dir(BaseModel) if not name.startswith("_"))


class _Listing(ModelMetaclass):
    """Metaclass that lists fields and methods without those of pydantic, for help() and completion."""

    def __dir__(cls) -> list[str]:
        names = {*super().__dir__(), *cls.__dict__.get("__pydantic_fields__", ())} - PYDANTIC
        return sorted(name for name in names if "pydantic" not in name)


class _NoSuch(AttributeError):
    """Error of a missing attribute; the hint is searched only when the error is printed."""

    def __str__(self) -> str:
        model, name = self.args
        attributes = [entry for entry in dir(model) if not entry.startswith("_")]
        hint = did_you_mean(near(f"{name}s", attributes) or near(name, attributes))
        return f"a {type(model).__name__} has no {name!r}{hint}"


class Model(BaseModel, metaclass=_Listing):
    """Frozen and validated data; a refusal names every problem in a sentence.

    Raises
    ------
    SceneError
        By the constructor: unknown keys, missing ones, and values out of their range.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
    #: words of a file that may stand for fields of other names
    _aliases: ClassVar[Mapping[str, str]] = {}
    #: groups of keys of a table of a file, of each of which it has one at least; keys in brackets
    #: stand together
    needs: ClassVar[tuple[tuple[str | tuple[str, ...], ...], ...]] = ()

    def __init__(self, /, *values: Any, **data: Any):
        if values:
            raise TypeError(f"{type(self).__name__} takes its values by name; see its help")
        data = {self._field_name(key, data): value for key, value in data.items()}
        fields = by_key(type(self))
        problems, meant = unknown_keys(data, fields)
        try:
            super().__init__(**{key: data[key] for key in data if key in fields})
        except ValidationError as error:
            problems += not_misspelt(scene_error(error, data).problems, meant)
        if problems:
            raise SceneError.of(problem.located(data) for problem in problems) from None

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Set the signature that help() shows: keys of a file, with defaults."""
        cls.__signature__ = Signature(
            [
                Parameter(
                    cls._words_by_field().get(name, field.alias or name),
                    Parameter.KEYWORD_ONLY,
                    default=Parameter.empty if field.is_required() else field.get_default(),
                )
                for name, field in cls.model_fields.items()
                if not iskeyword(field.alias or name)  # such as from
            ]
        )

    @classmethod
    def _field_name(cls, word: str, data: Mapping[str, Any]) -> str:
        """Return the field that a word of a file stands for, unless `data` gives that as well."""
        field = cls._aliases.get(word, word)
        return field if field in cls.model_fields and field not in data else word

    def __dir__(self) -> list[str]:
        return sorted({*dir(type(self)), *self._words_by_field().values()})

    @classmethod
    def _words_by_field(cls) -> dict[str, str]:
        """Return words of a file by the fields that they stand for."""
        return {field: word for word, field in cls._aliases.items() if field in cls.model_fields}

    def __repr_args__(self) -> Any:
        words = self._words_by_field()
        return ((words.get(name or "", name), value) for name, value in super().__repr_args__())

    def __getattr__(self, name: str) -> Any:
        if name in self._words_by_field().values():
            return getattr(self, type(self)._aliases[name])
        if name.startswith("_"):
            return super().__getattr__(name)  # type: ignore[misc]
        raise _NoSuch(self, name)

    @classmethod
    def table_keys(cls) -> dict[str, FieldInfo | None]:
        """Return the keys of a table of a file, with the fields that they hold."""
        return by_key(cls)

    def with_changes(self: _Self, **changes: Any) -> _Self:
        """Return a validated copy with some fields replaced, by name."""
        fields = type(self).model_fields
        changes = {self._field_name(key, changes): value for key, value in changes.items()}
        values = {name: getattr(self, name) for name in fields} | changes
        keys = {name: field.alias or name for name, field in fields.items()}
        return type(self)(**{keys.get(name, name): value for name, value in values.items()})

    def model_copy(
        self: _Self, *, update: Mapping[str, Any] | None = None, deep: bool = False
    ) -> _Self:
        """Return `with_changes` of `update`; pydantic's copy would skip validation."""
        return self.with_changes(**(update or {}))

    def unjudged(self: _Self, **changes: Any) -> _Self:
        """Return a copy with sound fields replaced that bear on no others, without validation."""
        out = super().model_copy(update=changes)
        for name in {*out.__dict__} - {*type(self).model_fields}:  # cached properties
            del out.__dict__[name]
        return out


@dataclass(frozen=True)
class Holds:
    """Mark of a field whose tables are read later, each into a model of this kind."""

    kind: type[Model]


class Problems(list[SceneError]):
    """Problems that are raised together."""

    def read(self, reader: Callable[[], _Read], path: tuple = ()) -> _Read | None:
        """Return the result of a reader; on a refusal append the problems under `path`."""
        try:
            return reader()
        except SceneError as error:
            self += error.located(None, prefix=path).problems
            return None

    def raise_any(self) -> None:
        """Raise all problems as one error, if there are any."""
        if self:
            raise SceneError.of(self)


def by_key(kind: type[Model]) -> dict[str, FieldInfo | None]:
    """Return the fields of a model by the keys of its constructor."""
    return {field.alias or name: field for name, field in kind.model_fields.items()}


def unknown_keys(
    data: Iterable[str], fields: Mapping[str, FieldInfo | None]
) -> tuple[list[SceneError], set[tuple[str, ...]]]:
    """Return problems of unknown keys, and paths of the known keys that they are probably meant for."""
    unknown = [key for key in data if key not in fields]
    meant = {key: _meant_key(key, fields) for key in unknown[:MOST_PROBLEMS]}
    problems = [
        SceneError(
            f"unknown key{did_you_mean(meant.get(key)) or '; known here: ' + ', '.join(fields)}",
            path=(key,),
        )
        for key in unknown
    ]
    return problems, {(name,) for name in meant.values() if name not in data}


def not_misspelt(problems: Sequence[SceneError], meant: set[tuple[str, ...]]) -> list[SceneError]:
    """Return problems without those of misspelt keys, which are not also missing."""
    return [problem for problem in problems if problem.path not in meant]


def _meant_key(key: str, fields: Mapping[str, FieldInfo | None]) -> str:
    """Return the known key that an unknown one is probably meant for; empty for none."""
    word = OTHER_WORDS.get(key.lower(), "")
    if word in fields:
        return word
    if "stiffness" in fields and key in STIFFNESS_NAMES:  # entries of the table stiffness
        return f"stiffness.{key}"
    inside = [name for name, field in fields.items() if key in _keys_of(field)]
    # the same word in a table of its own is nearer than one that is alike
    return f"{inside[0]}.{key}" if inside else near(key, fields)


def _keys_of(field: FieldInfo | None) -> list[str]:
    """Return the keys of the table that a field holds; none for other fields."""
    kinds = [field.annotation, *get_args(field.annotation)] if field else []
    tables = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, Model)]
    tables += [mark.kind for mark in field.metadata if isinstance(mark, Holds)] if field else []
    return [key for table in tables for key in table.table_keys()]
