"""Places along a shaft by the words of a file, and models that a file gives by them.

A file says where a thing is in words, such as ``position = "28 mm"`` with ``from = "head.end"``; a
scene holds where that is, in m. A model that is read (`Placed.read`) is checked whatever its place,
and has one as far as the shaft that its words refer to is known.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, ClassVar, TypeVar

from pydantic import AfterValidator, Field
from pydantic.fields import FieldInfo

from solidgear.errors import SceneError, listed, nearest
from solidgear.scene.patches import Patch
from solidgear.scene.recognised import Recognised, Seat
from solidgear.scene.typed import Gathered, Model, by_key, not_meant, unknown_keys
from solidgear.scene.units import Length

#: in place of a place that is not known, m
SOMEWHERE = 1.0
_Thing = TypeVar("_Thing", bound="Placed")


def plain_name(name: str) -> str:
    """A name that datums can be made of, or a refusal."""
    if not name.strip() or "." in name or len(name) > 60 or not name.isprintable():
        raise SceneError("a name is a short text without a dot")
    return name


Name = Annotated[str, AfterValidator(plain_name)]


class Places:
    """Places of the shaft of a file by their names.

    Attributes
    ----------
    known : list of str or None
        Datums in the order of the file, also those whose place is in doubt; None where names of
        segments are in doubt themselves.
    at : dict of str to float
        Those whose place is known, m.
    surface : dict of str to (float, float)
        Ends of a segment's surface that can carry a port, m.
    attachment : str
        Of what does not say its own.
    of_body : bool
        Whether the shaft is a part from a file.
    part : Recognised or None
        The part, once it is read.
    """

    def __init__(self, attachment: Any, *, of_body: bool = False, part: Recognised | None = None):
        self.known: list[str] | None = ["start", "end"]
        self.at: dict[str, float] = {}
        self.segments: list[str] = []
        self.surface: dict[str, tuple[float, float]] = {}
        self.attachment, self.of_body, self.part = attachment, of_body, part

    def add(self, name: str, y: float | None = None) -> None:
        """A datum, and its place where that is known."""
        if self.known is not None:
            self.known.append(name)
        if y is not None:
            self.at[name] = y

    def forget(self) -> None:
        """Keep the names alone, of a shaft that is in doubt."""
        self.at, self.surface = {}, {}

    def of(self, name: str, key: str) -> float | None:
        """Place of a datum, m; None where that is not known. A datum that there is not is refused
        under the key.
        """
        if self.known is not None and name not in self.known:
            raise SceneError(
                f"unknown datum{nearest(name, self.known)}; known here: {listed(self.known)}",
                path=(key,),
            )
        return self.at.get(name)

    def span_of(self, segment: str, key: str) -> tuple[float, float] | None:
        """Ends of a segment's surface, m, as :meth:`of` a datum."""
        if self.known is not None and segment not in self.segments:
            raise SceneError(
                f"unknown segment{nearest(segment, self.segments)}; "
                f"known here: {listed(self.segments)}",
                path=(key,),
            )
        return self.surface.get(segment)

    def span_of_seat(self, seat: Seat, instead: str) -> tuple[float, float] | None:
        """Ends of a seat on the part, m, as :meth:`of` a datum; on segments it is told what to
        write.
        """
        if not self.of_body:
            raise SceneError(
                "a seat by diameter is looked for on a part from a file ([body]); on segments "
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
        """A patch of a body without an axis, lumped into a point (m, in the axes of its file) where
        one is given; None where the body is in doubt.
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
        found = patches[name]
        return found if point is None else found.with_changes(point=body.placed(point))


class NoWords(Model):
    """Of a thing that has no place of its own."""


class Along(Model):
    """Words for a place along the shaft: so far from a datum."""

    position: Length | None = None
    from_: str | None = Field(None, alias="from")

    def y(self, places: Places, datum: str = "start") -> float | None:
        """The place (m) from a datum unless another is named; None where that is not known."""
        start = places.of(self.from_, "from") if self.from_ is not None else places.at.get(datum)
        return None if start is None else start + (self.position or 0.0)

    def refuse(self, reason: str, *keys: str, beside: Mapping[str, Any] | None = None) -> None:
        """Refuse the first of some words that is given, or of keys of the table beside them."""
        for key in keys:
            if getattr(self, key, None) is not None or key in (beside or ()):
                raise SceneError(reason, path=(key.rstrip("_"),))

    def needs(self, key: str, how: str, error_key: str = "") -> None:
        """Refuse a table without a word, told under its own key or another."""
        if getattr(self, key) is None:
            raise SceneError(f"this key is missing; {how}", path=(error_key or key,))

    def one_of(self, first: str, second: str, how: str) -> None:
        """Refuse neither of two words, or both."""
        if getattr(self, second) is None:
            self.needs(first, how)
        elif getattr(self, first) is not None:
            raise SceneError(f"give either {first} or {second}, not both", path=(second,))


class Placed(Model):
    """A thing that a file puts on the shaft by words of its own, beside the fields that it has.

    Attributes
    ----------
    Words : type of Model
        The words.
    sources : dict of str to tuple of str
        Fields that come from other keys of a file than their own, and these keys.
    """

    Words: ClassVar[type[Model]] = Along
    sources: ClassVar[Mapping[str, tuple[str, ...]]] = {"y": ("position",)}
    _also: ClassVar[Mapping[str, str]] = {"position": "y"}

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        """Fields that follow from the words of a table, None where the shaft is not known; refuses
        words that do not go together, or that name what is not there.
        """
        return {"y": words.y(places)} if cls.sources else {}

    @classmethod
    def read(
        cls: type[_Thing], table: Mapping[str, Any], places: Places, **usual: Any
    ) -> _Thing | None:
        """The thing that a table of a file describes, with some fields that the table may leave
        out; None where nothing is wrong with it, but its place is not known. Problems are told
        under its keys.
        """
        words, keys = by_key(cls.Words), cls.table_keys()
        strange, meant = unknown_keys(table, keys)
        problems = Gathered(strange)
        if isinstance(name := table.get("name"), str):
            problems.read(lambda: plain_name(name), ("name",))
        entries = {key: table[key] for key in table if key in keys and key not in words}
        word_entries = {key: table[key] for key in table if key in words}
        place = problems.read(lambda: cls.place(cls.Words(**word_entries), entries, places))
        place_fields = cls._nowhere(table) if place is None else place
        if "attachment" in keys:
            usual.setdefault("attachment", cls.usually_attached(table, places))
        somewhere = {
            key: SOMEWHERE if value is None else value for key, value in place_fields.items()
        }
        thing = cls._made({**usual, **entries, **somewhere}, table, problems)
        Gathered(not_meant(problems, meant)).tell()
        return None if None in place_fields.values() else thing

    @classmethod
    def usually_attached(cls, table: Mapping[str, Any], places: Places) -> str:
        """Attachment of a thing whose table names none."""
        return places.attachment

    @classmethod
    def _made(
        cls: type[_Thing], fields: dict[str, Any], table: Mapping[str, Any], problems: Gathered
    ) -> _Thing | None:
        """The thing of some fields; problems of keys that nothing was said of join the others."""
        try:
            return cls(**fields)
        except SceneError as error:
            problems_of_fields = [
                problem.located(None, path=cls.key_path(problem.path, table))
                for problem in error.problems
            ]
        known_paths = {problem.path for problem in problems}
        problems += [problem for problem in problems_of_fields if problem.path not in known_paths]
        return None

    @classmethod
    def key_path(cls, path: tuple, table: Mapping[str, Any]) -> tuple:
        """The key of a table that a field came from, in a path to the field."""
        keys = cls.sources.get(path[0], (path[0],)) if path else ()
        return (next((key for key in keys if key in table), keys[-1]), *path[1:]) if path else ()

    @classmethod
    def table_keys(cls) -> dict[str, FieldInfo | None]:
        """Keys of a table, with the fields that they hold; its words stand where its place does."""
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
    def _nowhere(cls, table: Mapping[str, Any]) -> dict[str, None]:
        """Fields of a place that is refused."""
        keys = cls.table_keys()
        fields = [key for key, field in cls.model_fields.items() if field.is_required()]
        seated = ["seat_width"] if "seat" in table and "seat_width" in fields else []
        return dict.fromkeys([key for key in fields if key not in keys] + seated)
