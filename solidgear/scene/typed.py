"""Data that are frozen and validated, and tell every problem of theirs in a sentence of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from inspect import Parameter, Signature
from keyword import iskeyword
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic.fields import FieldInfo

from solidgear.errors import TOLD, SceneError, did_you_mean, near, scene_error
from solidgear.scene.bearing_stiffness import STIFFNESS_NAMES

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


#: what pydantic gives every model, and nobody who reads a scene asks for
PYDANTIC = frozenset(name for name in dir(BaseModel) if not name.startswith("_"))


class _Shown(ModelMetaclass):
    """Classes that list their fields and their own methods, for help() and completion."""

    def __dir__(cls) -> list[str]:
        names = {*super().__dir__(), *cls.__dict__.get("__pydantic_fields__", ())} - PYDANTIC
        return sorted(name for name in names if "pydantic" not in name)


class _NoSuch(AttributeError):
    """Its hint is looked for when it is told: most who ask for an attribute take another answer."""

    def __str__(self) -> str:
        model, name = self.args
        names = {one: None for one in dir(model) if not one.startswith("_")}
        meant = did_you_mean(near(f"{name}s", names) or near(name, names))
        return f"a {type(model).__name__} has no {name!r}{meant}"


class Model(BaseModel, metaclass=_Shown):
    """Frozen and validated; a refusal names every problem in a sentence of its own.

    Raises
    ------
    SceneError
        By the constructor: unknown keys, missing ones, and values out of their range.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    #: words of a file that fields may be called by as well
    _also: ClassVar[Mapping[str, str]] = {}

    def __init__(self, /, **data: Any):
        data = {self._own(key, data): value for key, value in data.items()}
        fields = by_key(type(self))
        problems, meant = unknown_keys(data, fields)
        try:
            super().__init__(**{key: data[key] for key in data if key in fields})
        except ValidationError as error:
            problems += not_meant(scene_error(error, data).problems, meant)
        if problems:
            raise SceneError.of(problem.located(data) for problem in problems) from None

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Keys and defaults, as help() shows them."""
        cls.__signature__ = Signature(
            [
                Parameter(
                    cls._words().get(name, field.alias or name),
                    Parameter.KEYWORD_ONLY,
                    default=Parameter.empty if field.is_required() else field.get_default(),
                )
                for name, field in cls.model_fields.items()
                if not iskeyword(field.alias or name)  # such as from
            ]
        )

    @classmethod
    def _own(cls, word: str, data: Mapping[str, Any]) -> str:
        """The field that a word of a file stands for, if it is not given as well."""
        field = cls._also.get(word, word)
        return field if field in cls.model_fields and field not in data else word

    def __dir__(self) -> list[str]:
        return sorted({*dir(type(self)), *self._words().values()})

    @classmethod
    def _words(cls) -> dict[str, str]:
        """Words of a file by the fields that they stand for."""
        return {field: word for word, field in cls._also.items() if field in cls.model_fields}

    def __repr_args__(self) -> Any:
        words = self._words()
        return ((words.get(name or "", name), value) for name, value in super().__repr_args__())

    def __getattr__(self, name: str) -> Any:
        if name in self._words().values():
            return getattr(self, type(self)._also[name])
        if name.startswith("_"):
            return super().__getattr__(name)  # type: ignore[misc]
        raise _NoSuch(self, name)

    @classmethod
    def table_keys(cls) -> dict[str, FieldInfo | None]:
        """Keys of a table that describes one, with the fields that they hold."""
        return by_key(cls)

    def with_changes(self: _Self, **changes: Any) -> _Self:
        """A validated copy with some fields replaced, by name."""
        fields = type(self).model_fields
        changes = {self._own(key, changes): value for key, value in changes.items()}
        values = {name: getattr(self, name) for name in fields} | changes
        keys = {name: field.alias or name for name, field in fields.items()}
        return type(self)(**{keys.get(name, name): value for name, value in values.items()})

    def model_copy(
        self: _Self, *, update: Mapping[str, Any] | None = None, deep: bool = False
    ) -> _Self:
        """As `with_changes` of `update`: pydantic's own copy would skip validation."""
        return self.with_changes(**(update or {}))

    def unjudged(self: _Self, **changes: Any) -> _Self:
        """A copy with fields that are sound by themselves and bear on no other."""
        out = super().model_copy(update=changes)
        for name in {*out.__dict__} - {*type(self).model_fields}:  # what was cached
            del out.__dict__[name]
        return out


@dataclass(frozen=True)
class Holds:
    """Mark of a field of tables that are read later, each into a model of a kind."""

    kind: type[Model]


class Gathered(list[SceneError]):
    """Problems that are told together."""

    def read(self, reader: Callable[[], _Read], path: tuple = ()) -> _Read | None:
        """Result of a reader; None where it refuses, and its problems join these, under a path."""
        try:
            return reader()
        except SceneError as error:
            self += error.located(None, prefix=path).problems
            return None

    def tell(self) -> None:
        """Raise all of them, if there are any."""
        if self:
            raise SceneError.of(self)


def by_key(kind: type[Model]) -> dict[str, FieldInfo | None]:
    """Fields of a model by the keys that its constructor takes."""
    return {field.alias or name: field for name, field in kind.model_fields.items()}


def unknown_keys(
    data: Iterable[str], known: Mapping[str, FieldInfo | None]
) -> tuple[list[SceneError], set[tuple[str, ...]]]:
    """Problems of keys that are not known, and paths of the known ones that they stand for, as
    likely as not.
    """
    strange = [key for key in data if key not in known]
    meant = {key: _meant(key, known) for key in strange[:TOLD]}
    problems = [
        SceneError(
            f"unknown key{did_you_mean(meant.get(key)) or '; known here: ' + ', '.join(known)}",
            path=(key,),
        )
        for key in strange
    ]
    return problems, {(name,) for name in meant.values() if name not in data}


def not_meant(problems: Sequence[SceneError], meant: set[tuple[str, ...]]) -> list[SceneError]:
    """Problems without those of keys that are misspelt: they are not also missing."""
    return [problem for problem in problems if problem.path not in meant]


def _meant(key: str, known: Mapping[str, FieldInfo | None]) -> str:
    """The known key that a strange one stands for, as likely as not; empty for none."""
    word = OTHER_WORDS.get(key.lower(), "")
    if word in known:
        return word
    if "stiffness" in known and key in STIFFNESS_NAMES:  # which stand in a table of their own
        return f"stiffness.{key}"
    inside = [name for name, field in known.items() if key in _keys_of(field)]
    return near(key, known) or (f"{inside[0]}.{key}" if inside else "")


def _keys_of(field: FieldInfo | None) -> list[str]:
    """Keys of the table that a field holds; none where it holds none."""
    kinds = [field.annotation, *get_args(field.annotation)] if field else []
    tables = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, Model)]
    tables += [mark.kind for mark in field.metadata if isinstance(mark, Holds)] if field else []
    return [key for table in tables for key in table.table_keys()]
