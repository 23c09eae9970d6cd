"""Stations of a shaft, each frozen and validated: bearing and port."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, Field, PrivateAttr, model_validator

from solidgear.core.errors import SceneError, show
from solidgear.core.frames import DOF_NAMES
from solidgear.core.registry import addition
from solidgear.core.scene.bearing_stiffness import Matrix, refuse_two_stiffnesses
from solidgear.core.scene.housing import ELASTIC, Elastic, elastic
from solidgear.core.scene.patches import Patch, Point, fields_on_patch, patch_problems
from solidgear.core.scene.places import SOMEWHERE, Along, Placed, Places, Seat
from solidgear.core.scene.support import (
    HOLDS,
    Hold,
    Support,
    few_springs,
    held_matrix,
    sliding,
)
from solidgear.core.scene.tables import Absent
from solidgear.core.scene.typed import Model, Problems
from solidgear.core.scene.units import (
    POSITION_DECIMALS,
    SOFTEST,
    AxialSpring,
    Factor,
    Length,
    Position,
    PositiveLength,
)
from solidgear.core.scene.written import Written

if TYPE_CHECKING:
    from solidgear.core.scene.tables import BearingData as Catalogue
else:
    Catalogue = addition("table", "catalogue") or Absent


def _catalogue_keys() -> Collection[str]:
    """Return the keys of catalogue data, which in Python may stand beside those of the bearing."""
    return getattr(Catalogue, "model_fields", ())


def _width_of(data: Any) -> float | None:
    """Return the width of a bearing by its catalogue data, whichever way it holds the shaft; some width
    for data that are refused anyway, None without any.
    """
    if not isinstance(data, Mapping):
        return getattr(data, "seat_width", None)
    kind: Any = Catalogue
    for known in dict[str, Any](), {"holds": "+y"}:
        try:
            return kind(**{**data, **known}).seat_width
        except (SceneError, TypeError):
            continue
    return SOMEWHERE


Attachment = Literal["average", "rigid", "section"]
Status = Literal["published", "identified", "assumed", "measured", "calculated", "estimated"]
Face = Literal["start", "end"]


class Settled(Model):
    """Stiffness that catalogue data have under the load of a shaft; False in its place where it is
    not solved yet.
    """

    #: digest of the tables that it was solved for; with others it is solved anew
    under: str
    #: 6x6, SI: named entries or six rows
    stiffness: Matrix


def usual_attachment(bearing: Mapping[str, Any]) -> Attachment:
    """Return how a bearing is attached that says nothing, by its table: what is held as one rigid
    piece, any other by its mean, which at an end face is that of the section.
    """
    if bearing.get("hold") is not None:
        return "rigid"
    return "average" if bearing.get("face") is None else "section"


class Bearing(Placed):
    """A bearing: a 6x6 stiffness between ground and the seat it sits on.

    It takes the words of a file as well: a place counted ``from`` a datum, or ``on`` a segment, and
    catalogue data beside its other keys, such as ``designation="6206"``.

    Attributes
    ----------
    name : str
        Name in results, loads and sweeps.
    y : float
        Middle of the seat, m; `position`, as in a file, is the same.
    seat_width : float
        Width of the seat along the shaft, m; that of a catalogue bearing by default.
    matrix : tuple of tuple of float, or None
        6x6 of the bearing alone, SI, order (x, y, z, thx, thy, thz): six rows, or named entries,
        also as `stiffness`. None as long as catalogue data are not solved.
    catalogue : Catalogue or None
        Catalogue data that the stiffness comes from, where it is not given.
    axial_series : tuple of float
        Springs in series with its axial stiffness, N/m.
    housing : Elastic or None
        Stiffness under its outer ring, in series with all of it.
    scale : float
        Factor on its whole stiffness; bearing loads are found without it.
    attachment : {'average', 'rigid', 'section'}
        How the seat, or the face, follows the bearing: by its mean, but one that is held as one
        rigid piece. The mean of a face is that of its section.
    status : str
        Source of its numbers: published, identified, assumed, measured, or for catalogue data
        calculated (inner geometry given) or estimated.
    note : str
        Free text.
    support : {'locating', 'floating'} or None
        A floating bearing slides in its seat and carries nothing along y; by default cylindrical
        and needle rollers float, and all others locate.
    hold : {'clamped', 'pinned'} or None
        In place of a stiffness: no motion, or rotations only, of the seat or face as one rigid
        piece; with another `attachment`, of its mean alone.
    face : {'start', 'end'} or None
        The end face that it holds in place of a seat; `seat_width` is then that of the rim beside
        it, which pictures show and no other seat may share.
    patch : Patch or None
        Faces that it holds, on a body without an axis.

    Raises
    ------
    SceneError
        A matrix that is not symmetric, is indefinite, or has too soft springs.

    Examples
    --------
    >>> from solidgear import Bearing
    >>> front = Bearing(name="front", y=0.1, seat_width="40 mm", axial_series=[4e8],
    ...                 stiffness={"kxx": 8e8, "kyy": "4e8 N/m", "kzz": 8e8})
    >>> round(float(front.stiffness[1, 1]) / 1e8, 6)  # two equal springs in series
    2.0
    >>> front.lo, front.hi
    (0.08, 0.12)
    """

    class Words(Along):
        """Words for the seat: along the shaft, on a cylinder of a part, or on faces of a body."""

        #: cylinder of a part from a file, in place of position and seat_width
        seat: Seat | None = None
        #: segment that it sits in the middle of
        on: str | None = None
        #: faces that it holds, by name, on a body without an axis
        patch: str | None = None
        #: point in place of the middle of the patch, in the axes of the file, m
        point: Point = None
        #: stiffness that catalogue data have under the load of the shaft, as `to_dict` writes it;
        #: false where it is not solved yet
        settled: Settled | Literal[False] | None = None

    sources: ClassVar = {
        "y": ("seat", "on", "face", "position"),
        "seat_width": ("seat", "on", "seat_width"),
        "matrix": ("matrix", "stiffness"),
    }

    needs: ClassVar = (
        ("position", "on", "face", "seat", "patch"),
        ("seat_width", "on", "seat", "patch", "catalogue"),
        ("stiffness", "matrix", "catalogue", "hold"),
    )

    name: str
    y: Position
    seat_width: PositiveLength
    matrix: Matrix | None = None
    catalogue: Catalogue | None = None
    axial_series: Annotated[tuple[AxialSpring, ...], BeforeValidator(few_springs)] = ()
    housing: Annotated[Elastic | None, BeforeValidator(elastic), Written(ELASTIC)] = None
    scale: Factor = 1.0
    attachment: Attachment = "average"
    status: Status = "assumed"
    note: str = ""
    support: Support | None = None
    hold: Hold | None = None
    face: Face | None = None
    patch: Patch | None = None
    #: what catalogue data without a direction lack, until an arrangement gives it
    _unpaired: SceneError | None = PrivateAttr(None)

    def __init__(self, /, **data: Any):
        inside = [key for key in data if key in _catalogue_keys() and key not in self.table_keys()]
        if inside:
            if data.get("catalogue") is not None:
                reason = "belongs to catalogue, which gives it as well; write it in one place"
                raise SceneError(reason, path=(inside[0],), value=show(data[inside[0]]))
            data = {key: value for key, value in data.items() if key not in inside} | {
                "catalogue": {key: data[key] for key in inside}
            }
        if not {"seat_width", "on", "seat", "patch"} & {*data}:
            width = _width_of(data.get("catalogue"))
            data |= {} if width is None else {"seat_width": width}
        try:
            super().__init__(**data)
        except SceneError as error:
            if any(problem.path != ("catalogue", "holds") for problem in error.problems):
                raise
            if "holds" in data["catalogue"]:
                raise
            # the arrangement of a pair says so, once places are known
            words = {self._words_by_field().get(key, key): value for key, value in data.items()}
            super().__init__(**data | {"catalogue": {**data["catalogue"], "holds": "+y"}})
            self._table, self._unpaired = words, error

    @classmethod
    def _construct(
        cls, fields: dict[str, Any], table: Mapping[str, Any], problems: Problems
    ) -> Bearing | None:
        bearing = super()._construct(fields, table, problems)
        if bearing is None or bearing._unpaired is None:
            return bearing
        problems += bearing._unpaired.problems
        return None

    @classmethod
    def _by_field(cls, data: dict[str, Any]) -> dict[str, Any]:
        data = dict(data)
        if "stiffness" in data:
            data["matrix"] = data.pop("stiffness")
        if data.get("hold") in tuple(HOLDS) and "matrix" not in data:
            data["matrix"] = held_matrix(data["hold"])
        data.setdefault("attachment", usual_attachment(data))
        return data

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        refuse_two_stiffnesses(table)
        face = table.get("face")
        if words.patch is not None:
            return fields_on_patch(words, table, places, "seat_width")
        if words.seat is not None:
            reason = "a seat has its place and width in seat; leave one of them out"
            words.refuse(reason, "position", "from_", "face", "seat_width", table=table)
            return _on_surface(places.span_of_seat(words.seat, "position and seat_width"))
        if words.on is not None:
            reason = "a bearing on a segment has its place and width; leave one of them out"
            words.refuse(reason, "position", "from_", "face", "seat_width", table=table)
            on_segment = _on_surface(places.span_of(words.on, "on"))
            width = _width_of(table.get("catalogue"))
            return on_segment if width is None else {**on_segment, "seat_width": width}
        if face is None:
            words.require("position", 'write position = "28 mm" with from, or face = "start"')
            return {"y": words.y(places)}
        _check_face_words(words, table)
        return {"y": places.datums.get(face) if face in ("start", "end") else None}

    @classmethod
    def usually_attached(cls, table: Mapping[str, Any], places: Places) -> str:
        """Return the attachment of the file, if it has one."""
        return places.attachment or usual_attachment(table)

    @model_validator(mode="after")
    def _status_of_data(self) -> Bearing:
        if self.catalogue is not None and "status" not in self.model_fields_set:
            status = "estimated" if self.catalogue.estimated else "calculated"
            object.__setattr__(self, "status", status)
        return self

    @model_validator(mode="after")
    def _springs_or_none(self) -> Bearing:
        if self.matrix is None:
            if self.catalogue is None:
                raise SceneError(
                    "this key is missing; write stiffness = {kxx = ...}, matrix = 6 rows of 6 "
                    'numbers, catalogue = {...}, or hold = "clamped"',
                    path=("matrix",),
                )
            return self
        for name, k in zip(DOF_NAMES, np.diag(self.matrix)):
            if 0 < k < SOFTEST:
                raise SceneError(
                    f"the stiffness in {name} is {k:.6g}, below {SOFTEST:g} in SI, too soft for a "
                    "spring: write 0",
                    path=("matrix",),
                )
        return self

    @model_validator(mode="after")
    def _mean_of_a_face(self) -> Bearing:
        if self.face is not None and self.attachment == "average":
            object.__setattr__(self, "attachment", "section")
        return self

    @model_validator(mode="after")
    def _supports(self) -> Bearing:
        if problems := [*_support_problems(self), *patch_problems(self)]:
            raise SceneError.of(problems)
        return self

    def with_changes(self, **changes: Any) -> Bearing:
        """Return a validated copy with some fields replaced; other catalogue data wait for their
        stiffness.
        """
        if not {"matrix", "stiffness"} & {*changes} and "catalogue" in changes:
            same = changes["catalogue"] == self.catalogue
            changes["matrix"] = self.matrix if same else None
        if "hold" in changes and self.attachment == usual_attachment(dict(self)):
            usual = usual_attachment(dict(self) | changes)
            changes = {"attachment": usual, **changes}
        return super().with_changes(**changes)

    @property
    def floats(self) -> bool:
        """True where the bearing carries nothing along y, by mounting or kind."""
        by_kind = self.catalogue is not None and self.catalogue.floats
        return self.support == "floating" or by_kind

    @property
    def unsettled(self) -> Bearing:
        """The same bearing without the stiffness that catalogue data have under the load of the shaft;
        unchanged where the stiffness does not depend on that load.
        """
        data = self.catalogue
        waits = data is not None and data.load is None and data.displacement is None
        return self.with_changes(matrix=None) if waits else self

    def held_towards(self, way: str) -> Bearing:
        """Return the bearing turned to hold the shaft towards '+y' or '-y', with catalogue data."""
        data = self.catalogue
        return self.with_changes(catalogue=data and data.with_changes(holds=way))

    def attached(self, attachment: str) -> Bearing:
        """Return the bearing with another attachment of its seat or face."""
        return self.with_changes(attachment=attachment)

    @property
    def lo(self) -> float:
        """Seat end towards y = 0, in m; the place of a face."""
        return self.y if self.face else self.rim[0]

    @property
    def hi(self) -> float:
        """Seat end away from y = 0, in m; the place of a face."""
        return self.y if self.face else self.rim[1]

    @property
    def rim(self) -> tuple[float, float]:
        """Ends of the seat, or of the rim beside a face, m, that no other seat may share."""
        inward = {"start": 0.0, "end": 1.0}.get(self.face or "", 0.5)
        lo, hi = self.y - self.seat_width * inward, self.y + self.seat_width * (1.0 - inward)
        return round(lo, POSITION_DECIMALS), round(hi, POSITION_DECIMALS)

    @property
    def stiffness(self) -> np.ndarray:
        """(6, 6) read-only, SI, order x y z thx thy thz: the bearing with its axial series springs
        and the housing at its seat condensed in.

        Raises
        ------
        SceneError
            If it is to come from catalogue data that are not solved yet.
        """
        K = np.array(self._solved_matrix())
        if (spring := self.spring) is not None:
            # the ring between bearing and spring carries no load of its own: condense its y out,
            # couplings included
            K -= np.outer(K[:, 1], K[1, :]) / (K[1, 1] + spring)
        if self.support == "floating":
            K = sliding(K)
        if self.housing is not None:
            K = self.housing.beneath_one(K, f"the housing of bearing {show(self.name)}")
        K *= self.scale
        K.flags.writeable = False
        return K

    @property
    def spring(self) -> float | None:
        """Springs in series as one, N/m."""
        return 1 / sum(1 / k for k in self.axial_series) if self.axial_series else None

    def _solved_matrix(self) -> tuple[tuple[float, ...], ...]:
        if self.matrix is None:
            raise SceneError(
                f"bearing {show(self.name)} is described by catalogue data whose stiffness is not "
                "worked out yet: read the scene with solidgear.load, which does"
            )
        return self.matrix

    def scaled(self, factor: float) -> Bearing:
        """The same bearing with every stiffness, series springs and housing included, multiplied.

        Parameters
        ----------
        factor : float
            Above zero.

        Returns
        -------
        Bearing

        Raises
        ------
        SceneError
            A factor that is not above zero.
        """
        if not factor > 0:
            raise SceneError("must be greater than zero", field="factor", value=show(factor))
        if self.hold:  # there is nothing stiffer; what it stands in may be
            return (
                self
                if self.housing is None
                else self.with_changes(housing=self.housing.scaled(factor))
            )
        return self.with_changes(
            matrix=np.array(self._solved_matrix()) * factor,
            axial_series=tuple(k * factor for k in self.axial_series),
            housing=None if self.housing is None else self.housing.scaled(factor),
        )


class Port(Placed):
    """The lumped point on the axis, attached to a span of the outer surface.

    Attributes
    ----------
    name : str
        Name in results and sweeps.
    y : float
        Place, m; it need not lie within the span. `position`, as in a file, is the same, and so is
        ``at="gear.middle"``.
    lo, hi : float
        Span of the surface that carries it, m, or ``attach_to="gear"``; ``on="gear"`` is the middle
        of a segment, attached to all of its surface.
    attachment : {'average', 'rigid', 'section'}
        How the surface follows the point.
    patch : Patch or None
        Faces that carry it and the point itself, on a body without an axis.

    Raises
    ------
    SceneError
        A field that is missing or of another dimension.

    Examples
    --------
    >>> from solidgear import Port
    >>> Port(y="29 mm", lo=0.0, hi="58 mm").hi
    0.058
    """

    class Words(Along):
        """Words for the place of the point, and for the surface that carries it."""

        #: place of the point, such as `NAME.middle` of a segment
        at: str | None = None
        #: segment in whose middle the point lies, and whose surface carries it
        on: str | None = None
        #: segment whose surface carries the point
        attach_to: str | None = None
        #: ends of the surface that carries the point, from the start of the shaft, m
        span: Annotated[list[Length], Field(min_length=2, max_length=2)] | None = None
        #: cylinder of a part from a file that carries the point
        seat: Seat | None = None
        #: faces that carry the point, by name, on a body without an axis
        patch: str | None = None
        #: the point in place of the middle of the patch, in the axes of the file, m
        point: Point = None

    sources: ClassVar = {
        "y": ("at", "on", "position"),
        "lo": ("seat", "span", "on", "attach_to"),
        "hi": ("seat", "span", "on", "attach_to"),
    }

    needs: ClassVar = (
        ("at", "on", "position", "seat", "patch"),
        ("attach_to", "on", "span", "seat", "patch"),
    )

    name: str = "port"
    y: Position
    lo: Position
    hi: Position
    attachment: Attachment = "average"
    patch: Patch | None = None

    @model_validator(mode="after")
    def _on_a_patch(self) -> Port:
        if problems := list(patch_problems(self)):
            raise SceneError.of(problems)
        return self

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        if words.patch is not None:
            return fields_on_patch(words, table, places, "lo", "hi")
        if words.on is not None:
            reason = "a port on a segment has its place and surface; leave one of them out"
            words.refuse(reason, "at", "position", "from_", "attach_to", "span", "seat")
            lo, hi = places.span_of(words.on, "on") or (None, None)
            middle = None if lo is None or hi is None else (lo + hi) / 2
            return {"y": middle, "lo": lo, "hi": hi}
        problems = Problems()
        y = problems.read(lambda: cls._y(words, places))
        lo, hi = problems.read(lambda: cls._span(words, places)) or (None, None)
        problems.raise_any()
        if words.at is None and words.position is None and lo is not None and hi is not None:
            y = (lo + hi) / 2
        return {"y": y, "lo": lo, "hi": hi}

    @staticmethod
    def _y(words: Any, places: Places) -> float | None:
        """Return the place, m."""
        if words.at is not None:
            words.refuse("give either at, or position with from, not both", "position", "from_")
            return places.datum(words.at, "at")
        if words.seat is None:
            words.require("position", 'write at = "<segment>.middle", or position with from', "at")
        return words.y(places)

    @staticmethod
    def _span(words: Any, places: Places) -> tuple[float, float] | None:
        """Return the ends of the surface that carries the point, m."""
        if words.seat is not None:
            for key in ("attach_to", "span"):
                words.refuse(f"give either seat or {key}, not both", key)
            return places.span_of_seat(words.seat, "span, or attach_to with the name of a segment")
        hint = 'name the segment whose surface carries the port, or write span = ["0 mm", "58 mm"]'
        words.require_one("attach_to", "span", hint)
        return words.span or places.span_of(words.attach_to, "attach_to")


def _on_surface(span: tuple[float, float] | None) -> dict[str, float | None]:
    """Return place and width of a seat between two ends, m; None where they are not known."""
    if span is None:
        return {"y": None, "seat_width": None}
    return {"y": (span[0] + span[1]) / 2, "seat_width": span[1] - span[0]}


def _check_face_words(words: Along, table: Mapping[str, Any]) -> None:
    """Refuse a bearing on a face with a position as well, or without a width."""
    words.refuse("give either face, or position with from, not both", "position", "from_")
    if "seat_width" not in table and "catalogue" not in table:
        raise SceneError(
            'this key is missing; face stands for the position alone: write seat_width = "10 mm" or so '
            "as well, the rim beside the face that no other seat may lie on",
            path=("seat_width",),
        )


def _support_problems(bearing: Bearing) -> Iterator[SceneError]:
    """Yield contradictions in the support of a bearing."""
    data = bearing.catalogue
    if bearing.support is None:
        return
    if bearing.hold is not None:
        yield SceneError(
            f"a {bearing.hold} bearing holds y as well: leave support out", path=("support",)
        )
        return
    kind = "" if data is None else data.kind.replace("_", " ")
    if bearing.support == "locating":
        if data is not None and data.floats:
            remedy = "leave support out, or take one with ribs, such as NUP"
            if data.ribs == "one way":
                remedy = 'write holds = "+y" or "-y", the way in which its rib holds the shaft'
            yield SceneError(
                f"a {kind} bearing without ribs carries nothing along y: {remedy}"
                if data.ribs == "none"
                else f"a {kind} bearing with one rib holds one way: {remedy}",
                path=("support",),
            )
        elif data is None and bearing.matrix is not None and not bearing.matrix[1][1]:
            yield SceneError(
                'its stiffness holds nothing along y: write kyy, or support = "floating"',
                path=("support",),
            )
        return
    if data is not None and data.one_sided:
        yield SceneError(
            f"a {data.arrangement} {kind} bearing cannot float, since nothing presses it: write "
            'two rows as one bearing with arrangement = "O" or "X" and row_distance',
            path=("support",),
        )
    if bearing.axial_series:
        yield SceneError("a floating bearing presses no spring along y", path=("axial_series",))
    for key in ("load", "displacement"):
        state = None if data is None else getattr(data, key)
        if state is not None and state.y:
            yield SceneError(
                "a floating bearing carries nothing along y", path=("catalogue", key, "y")
            )
