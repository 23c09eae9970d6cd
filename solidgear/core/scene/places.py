"""Places along a shaft by the words of a file, and models that a file places by words.

A file gives a place in words, such as ``position = "28 mm"`` with ``from = "head.end"``; a scene
holds the place in m. A model is checked when it is read (`Placed.read`) even where its place is not
known, because the shaft that the words refer to is in doubt.

A key of a file that gives a place is one of the model's ``Words``, and ``place`` says which fields it
gives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, ClassVar, Protocol, TypeVar

from pydantic import AfterValidator, Field, PrivateAttr, model_validator
from pydantic.fields import FieldInfo

from solidgear.core.errors import SceneError, listed, nearest
from solidgear.core.scene.patches import Patch
from solidgear.core.scene.typed import Model, Problems, by_key, not_misspelt, unknown_keys
from solidgear.core.scene.units import Length, PositiveLength

#: in place of a place that is not known, m
SOMEWHERE = 1.0
#: fields that give a place
PLACE_FIELDS = ("y", "lo", "hi")
_Thing = TypeVar("_Thing", bound="Placed")


def plain_name(name: str) -> str:
    """Return a name that datums can be made of, or refuse it."""
    if not name.strip() or "." in name or len(name) > 60 or not name.isprintable():
        raise SceneError("a name is a short text without a dot")
    return name


Name = Annotated[str, AfterValidator(plain_name)]


class RoundPart(Protocol):
    """A part from a file and the body of revolution inside it."""

    body: Any

    def span(self, seat: Seat) -> tuple[float, float]: ...


class Places:
    """Places of the shaft of a file, by name."""

    def __init__(
        self, attachment: Any = None, *, of_body: bool = False, part: RoundPart | None = None
    ):
        #: of all datums in the order of the file, also those whose place is in doubt; None where
        #: names of segments are in doubt themselves
        self.names: list[str] | None = ["start", "end"]
        self.datums: dict[str, float] = {}  #: known places, m
        self.segments: list[str] = []
        #: ends of each segment's surface, which can carry a port, m
        self.surface: dict[str, tuple[float, float]] = {}
        self.attachment = attachment  #: that of the file; None where each thing has its usual one
        self.of_body = of_body  #: whether the shaft is a part from a file
        self.part = part  #: once it is read

    def add(self, name: str, y: float | None = None) -> None:
        """Add a datum, with the place where that is known."""
        if self.names is not None:
            self.names.append(name)
        if y is not None:
            self.datums[name] = y

    def enter(self, segment: str, ends: tuple[float, float], datums: Sequence[str]) -> None:
        """Add the datums of a shape between two ends, m, whose surface is known or all of it."""
        lo, hi = self.surface.get(segment, ends)
        places = {
            "start": ends[0],
            "end": ends[1],
            "middle": (ends[0] + ends[1]) / 2,
            "mid_face": (lo + hi) / 2,
        }
        self.datums |= {f"{segment}.{datum}": places[datum] for datum in datums}

    def forget(self) -> None:
        """Drop all places of a shaft that is in doubt, and keep the names."""
        self.datums, self.surface = {}, {}

    def datum(self, name: str, key: str) -> float | None:
        """Return the place of a datum, m; None where it is in doubt, refused if unknown."""
        if self.names is not None and name not in self.names:
            raise SceneError(
                f"unknown datum{nearest(name, self.names)}; known here: {listed(self.names)}",
                path=(key,),
            )
        return self.datums.get(name)

    def span_of(self, segment: str, key: str) -> tuple[float, float] | None:
        """Return the ends of a segment's surface, m; None and refusals as of :meth:`datum`."""
        if self.names is not None and segment not in self.segments:
            raise SceneError(
                f"unknown segment{nearest(segment, self.segments)}; "
                f"known here: {listed(self.segments)}",
                path=(key,),
            )
        return self.surface.get(segment)

    def span_of_seat(self, seat: Seat, instead: str) -> tuple[float, float] | None:
        """Return the ends of a seat on the part, m, as :meth:`span_of`; on segments refuse it and
        name the key to write `instead`.
        """
        if not self.of_body:
            raise SceneError(
                "a seat by diameter is looked for on a part from a file; on segments "
                f"write {instead}",
                path=("seat",),
            )
        if self.part is None:
            return None
        try:
            return self.part.span(seat)
        except SceneError as error:
            raise error.located(None, prefix=("seat",)) from None

    def patch(self, name: str, point: Sequence[float] | None = None) -> Patch | None:
        """Return a patch of a body without an axis, with a lumped `point` (m, in the axes of the file)
        in place of its middle; None where the body is in doubt.
        """
        if self.part is None and self.of_body:
            return None
        body = None if self.part is None else self.part.body
        if body is None or body.edges is None:
            reason = 'patches are faces of a body without an axis (axis = "none", or a block)'
            raise SceneError(reason, path=("patch",))
        patches = {patch.name: patch for patch in body.patches}
        if name not in patches:
            names = listed(map(repr, patches)) or "none: name groups of surfaces in the mesher"
            raise SceneError(
                f"unknown patch{nearest(name, patches)}; there are {names}", path=("patch",)
            )
        if point is None:
            return patches[name]
        return patches[name].with_changes(point=body.placed(point))


class NoWords(Model):
    """Words of a thing without a place of its own: none."""


class Along(Model):
    """Words for a place along the shaft, by the distance from a datum."""

    #: distance from the place `from` along the shaft, m
    position: Length | None = None
    #: place that the position counts from, such as `start`, `end`, `NAME.end` of a segment or
    #: `bearing.NAME`
    from_: str | None = Field(None, alias="from")

    def y(self, places: Places, datum: str = "start") -> float | None:
        """Return the place, m, from `datum` or the datum of the words; None where it is in doubt."""
        if self.from_ is not None:
            start = places.datum(self.from_, "from")
        else:
            start = places.datums.get(datum)
        return None if start is None else start + (self.position or 0.0)

    def refuse(self, reason: str, *keys: str, table: Mapping[str, Any] | None = None) -> None:
        """Refuse the first of `keys` that is given, as a word or in the table of the file."""
        for key in keys:
            if getattr(self, key, None) is not None or key in (table or ()):
                raise SceneError(reason, path=(key.rstrip("_"),))

    def require(self, key: str, hint: str, error_key: str = "") -> None:
        """Refuse a missing word, under its key or under `error_key`."""
        if getattr(self, key) is None:
            raise SceneError(f"this key is missing; {hint}", path=(error_key or key,))

    def require_one(self, first: str, second: str, hint: str) -> None:
        """Refuse neither of two words, or both."""
        if getattr(self, second) is None:
            self.require(first, hint)
        elif getattr(self, first) is not None:
            raise SceneError(f"give either {first} or {second}, not both", path=(second,))


class Placed(Model):
    """A thing that a file puts on the shaft by words, which are not fields of the model."""

    Words: ClassVar[type[Model]] = Along
    #: fields that come from keys of other names in a file, and these keys
    sources: ClassVar[Mapping[str, tuple[str, ...]]] = {"y": ("position",)}
    _aliases: ClassVar[Mapping[str, str]] = {"position": "y"}
    #: words that wait for a shaft, by which a thing made in Python is placed; None once it is
    _table: Mapping[str, Any] | None = PrivateAttr(None)

    def __init__(self, /, *values: Any, **data: Any):
        if values or not self._are_words(data):
            super().__init__(*values, **self._by_field(data))
            return
        words = by_key(self.Words)
        fields = {key: value for key, value in data.items() if key not in words}
        places = Places(of_body=True)
        places.names, places.datums["start"] = None, 0.0
        word_entries = {key: value for key, value in data.items() if key in words}
        if "y" in self.sources and "y" in fields and "position" in words:
            word_entries.setdefault("position", fields.pop("y"))
        place_fields = self.place(self.Words(**word_entries), fields, places)
        provisional = {
            key: SOMEWHERE if value is None else value for key, value in place_fields.items()
        }
        super().__init__(**self._by_field(fields | provisional))
        if None in place_fields.values():
            self._table = fields | word_entries

    @classmethod
    def _are_words(cls, data: Mapping[str, Any]) -> bool:
        """Return True for words of a file that place a thing, False where its fields do."""
        fields, words = cls.model_fields, by_key(cls.Words)
        names = {cls._field_name(key, data) for key in data}
        if isinstance(data.get("patch"), str) or names & {*words} - {*fields} - {*cls._aliases}:
            return True
        missing = [key for key in PLACE_FIELDS if key in cls.sources and key not in names]
        return any(fields[key].is_required() for key in missing)

    @classmethod
    def _by_field(cls, data: dict[str, Any]) -> dict[str, Any]:
        """Return data of the constructor by the fields that hold them."""
        return data

    @property
    def words(self) -> Mapping[str, Any] | None:
        """Words that need a shaft, until a scene puts the thing on one; None once it has a place."""
        return self._table

    def placed_on(self: _Thing, places: Places, path: tuple) -> _Thing:
        """Return the thing at its place on a shaft; errors are under a path."""
        if self._table is None:
            return self
        try:
            thing = type(self).read(self._table, places)
        except SceneError as error:
            raise error.located(self._table).located(None, prefix=path) from None
        assert thing is not None  # every place on a shaft is known
        return thing

    def with_changes(self: _Thing, **changes: Any) -> _Thing:
        """Return a validated copy with some fields replaced, by name."""
        if self._table is None:
            return super().with_changes(**changes)
        keys = self._words_by_field()
        changes = {keys.get(name, name): value for name, value in changes.items()}
        return type(self)(**{**self._table, **changes})

    def __repr_args__(self) -> Any:
        return super().__repr_args__() if self._table is None else self._table.items()

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        """Return the fields that follow from the words of a table, None where the shaft is not known;
        refuse words that contradict each other or name unknown places.
        """
        return {"y": words.y(places)} if cls.sources else {}

    @classmethod
    def read(
        cls: type[_Thing], table: Mapping[str, Any], places: Places, **usual: Any
    ) -> _Thing | None:
        """Read a thing from a table of a file, with usual values of fields that the table leaves out;
        return None where it is sound but its place is not known.
        """
        words, keys = by_key(cls.Words), cls.table_keys()
        strange, meant = unknown_keys(table, keys)
        problems = Problems(strange)
        if isinstance(name := table.get("name"), str):
            problems.read(lambda: plain_name(name), ("name",))
        entries = {key: table[key] for key in table if key in keys and key not in words}
        word_entries = {key: table[key] for key in table if key in words}
        place_fields = problems.read(lambda: cls.place(cls.Words(**word_entries), entries, places))
        if place_fields is None:
            place_fields = cls._unplaced(table)
        if "attachment" in keys:
            usual.setdefault("attachment", cls.usually_attached(table, places))
        provisional = {
            key: SOMEWHERE if value is None else value for key, value in place_fields.items()
        }
        thing = cls._construct({**usual, **entries, **provisional}, table, problems)
        Problems(not_misspelt(problems, meant)).raise_any()
        return None if None in place_fields.values() else thing

    @classmethod
    def usually_attached(cls, table: Mapping[str, Any], places: Places) -> str:
        """Return the attachment of a thing whose table names none."""
        return places.attachment or "average"

    @classmethod
    def _construct(
        cls: type[_Thing], fields: dict[str, Any], table: Mapping[str, Any], problems: Problems
    ) -> _Thing | None:
        """Construct the model; append problems of keys that have none yet to `problems`."""
        try:
            return cls(**fields)
        except SceneError as error:
            new = [p.located(None, path=cls.key_path(p.path, table)) for p in error.problems]
        known_paths = {problem.path for problem in problems}
        problems += [problem for problem in new if problem.path not in known_paths]
        return None

    @classmethod
    def key_path(cls, path: tuple, table: Mapping[str, Any]) -> tuple:
        """Return the path of a field by the key of the table that it came from."""
        if not path:
            return ()
        keys = cls.sources.get(path[0], (path[0],))
        return (next((key for key in keys if key in table), keys[-1]), *path[1:])

    @classmethod
    def table_keys(cls) -> dict[str, FieldInfo | None]:
        """Return the keys of a table with the fields that they hold, words in place of the place."""
        fields, words = by_key(cls), by_key(cls.Words)
        keys: dict[str, FieldInfo | None] = {}
        for key, field in fields.items():
            sources = cls.sources.get(key, (key,))
            keys |= words if key not in sources else {}
            keys |= {
                source: field if source == key else fields.get(source)
                for source in sources
                if source not in keys
            }
        return keys | words

    @classmethod
    def _unplaced(cls, table: Mapping[str, Any]) -> dict[str, None]:
        """Return the fields of a place that is refused."""
        keys = cls.table_keys()
        fields = [key for key, field in cls.model_fields.items() if field.is_required()]
        has_width = "seat" in table or "patch" in table  # which is refused, and its width with it
        seated = ["seat_width"] if has_width and "seat_width" in fields else []
        return dict.fromkeys([key for key in fields if key not in keys] + seated)


class Seat(Model):
    """A stretch of a cylinder of the part, counted from the origin of the body."""

    #: diameter of the cylinder of the part, m
    diameter: PositiveLength
    #: start of the seat from the origin of the body, m
    from_: Length = Field(alias="from")
    #: end of the seat from the origin of the body, m
    to: Length

    @model_validator(mode="after")
    def _long(self):
        if self.to <= self.from_:
            raise SceneError("must lie beyond from", path=("to",))
        return self
