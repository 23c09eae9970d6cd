"""Catalogue data of a bearing, checked, and the rules that they have to keep.

:mod:`solidgear.bearings` computes the 6x6 at a load from these data.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, get_args

from pydantic import BeforeValidator, Field, model_validator

from solidgear.bearings.bearing_list import with_listed_by_variable
from solidgear.bearings.designation import boundary
from solidgear.bearings.kinds import SHARES, Shares
from solidgear.core import (
    Length,
    Model,
    PositiveLength,
    Range,
    SceneError,
    SignedAngle,
    Written,
    show,
)
from solidgear.core.scene.load import BearingLoad
from solidgear.core.scene.units import (
    Angle,
    AxialSpring,
    PositiveLoad,
    RatingFactor,
    Ratio,
    Speed,
    TemperatureRise,
    quantity,
)
from solidgear.core.scene.written import Measure, Word

if TYPE_CHECKING:
    from solidgear.core import Bearing

Kind = Literal[
    "deep_groove",
    "angular_contact",
    "cylindrical",
    "tapered",
    "needle",
    "spherical",
    "thrust_ball",
    "double_row_angular",
    "four_point",
    "self_aligning",
]
Arrangement = Literal["single", "double_row", "tandem", "back_to_back", "face_to_face"]
#: clearance classes of ISO 5753-1
ClearanceClass = Literal["C2", "CN", "C3", "C4", "C5", "CM"]
CLASSES = get_args(ClearanceClass)
PAIRED = ("tandem", "back_to_back", "face_to_face")
#: direction along y in which the lower and the upper row of two hold the shaft
WAYS = {"back_to_back": ("+y", "-y"), "face_to_face": ("-y", "+y")}
#: other words of the field for arrangements
_CALLED = {"o": "back_to_back", "db": "back_to_back", "x": "face_to_face", "df": "face_to_face"}
#: words that a designation may give, beside sizes and clearance
DESIGNATED = ("arrangement", "cage", "ribs")
#: rolling elements of a row
FEWEST, MOST = 3, 300


class BearingDisplacement(Model):
    """Displacement of the inner ring against the outer one, m and rad."""

    #: displacement along x, m
    x: Length = 0.0
    #: displacement along y, the axis, m
    y: Length = 0.0
    #: displacement along z, m
    z: Length = 0.0
    #: tilt about x, rad
    thx: SignedAngle = 0.0
    #: tilt about z, rad
    thz: SignedAngle = 0.0

    @property
    def six(self) -> list[float]:
        """(6,) displacement in the order (x, y, z, thx, thy, thz), m and rad."""
        return [self.x, self.y, self.z, self.thx, 0.0, self.thz]


class Preload(Model):
    """Preload of a bearing: by a force or by a displacement."""

    #: force along y that every row feels while the shaft carries nothing else, N
    force: float | None = None
    #: distance along y by which the rings, or both rows of a pair together, are pushed from where
    #: they just touch, m
    displacement: float | None = None


def _preload(value: Any) -> Any:
    if isinstance(value, (Preload, dict)) or value is None:
        return value
    if not isinstance(value, str):
        raise SceneError(
            'write a force such as "500 N" or a displacement such as "10 um"', value=show(value)
        )
    for key, dimension in (("force", "load"), ("displacement", "length")):
        try:
            number = quantity(value, dimension)
        except SceneError:
            continue
        if number <= 0:
            raise SceneError("must be greater than zero; leave it out for none", value=show(value))
        return {key: number}
    raise SceneError(
        'is neither a force such as "500 N" nor a displacement such as "10 um"', value=show(value)
    )


def arrangement_word(value: Any) -> Any:
    """Return the word of a catalogue for an arrangement as people write it."""
    if not isinstance(value, str):
        return value
    plain = re.sub(r"[\s-]+", "_", value.strip().lower())
    return _CALLED.get(plain, plain if plain in WAYS else value)


def _clearance(value: Any) -> Any:
    if value in CLASSES:
        return value
    if isinstance(value, str) and value[:1].upper() == "C":
        raise SceneError(
            f'must be one of the classes {", ".join(CLASSES)} or a length such as "10 um"',
            value=show(value),
        )
    return quantity(value, "length")


#: of grooves
GROOVE = Range(
    "is groove radius over ball diameter: write more than 0.5 and at most 0.6; usual is 0.52",
    above=0.5,
    most=0.6,
)


def _conformity(value: Any) -> Any:
    pair = value if isinstance(value, (list, tuple)) else [value, value]
    if len(pair) != 2:
        raise SceneError("write one number, or two: inner and outer ring", value=show(value))
    for ratio in (quantity(v, "dimensionless") for v in pair):
        try:
            GROOVE.check(ratio)
        except SceneError as error:
            raise SceneError(error.reason, value=show(value)) from None
    return tuple(pair)


#: other spellings of the words of arrangements
SPELLINGS = tuple(
    spelling
    for word in (*_CALLED, *WAYS)
    for spelling in dict.fromkeys((word, word.upper(), word.capitalize(), word.replace("_", " ")))
)
#: words of pairs, first those of drawings
PairWord = Annotated[str, Word(("O", "X", *WAYS), "|".join(SPELLINGS))]
ArrangementWord = Arrangement | PairWord
PreloadText = (
    Annotated[str, Measure("load", quantity), Range("", above=0)]
    | Annotated[str, Measure("length", quantity), Range("", above=0)]
)
Groove = Annotated[Ratio, GROOVE]
Conformity = Groove | Annotated[list[Groove], Field(min_length=2, max_length=2)]


class Catalogue(Model):
    """A bearing by its catalogue data; numbers in SI, or texts with units.

    Attributes
    ----------
    kind : str
        Kind: deep_groove, angular_contact, cylindrical, tapered, needle, spherical (rollers),
        thrust_ball, double_row_angular, four_point or self_aligning (balls).
    designation : str
        Designation such as ``6208-2RS1/C3``: gives kind, bore, outer_diameter, width, ribs, contact
        angle and a class of clearance where these are left out; seals, cages and tolerances are read
        and ignored.  A list of bearings is looked up first.
    bore, outer_diameter, width : float
        Boundary dimensions, m; the bore of a drawn cup is the diameter under its rollers.
    raceway : float or None
        Diameter under needle rollers on an inner ring, m (F_w of makers).
    cage : bool
        False for a full complement of rollers, which leaves room for no cage.
    ribs : {'none', 'one way', 'both ways'}
        How ribs of cylindrical rollers hold the shaft along y: NU and N have none, NJ and NF hold
        one way and need `holds` to do so, NUP holds both ways.
    rib_stiffness : float or None
        Stiffness of the ribs along y, N/m; by default a rough estimate.
    listed : str
        File and line of the list of bearings that the data come from; empty for none.
    load_rating, static_rating : float or None
        Basic dynamic and static radial load rating, N; for a pair those of one bearing, for a thrust
        bearing its axial ones.
    fatigue_limit : float or None
        Fatigue load limit C_u, N, of one bearing.
    rating_factor : float or None
        Factor b_m of ISO 281; by default that of its kind.
    elements : int or None
        Number of rolling elements in a row.
    element_diameter, element_length, pitch_diameter : float or None
        Dimensions of the rolling elements and their circle, m; for tapered rollers the mean diameter.
    contact_angle : float or None
        Angle of the contacts from the radial plane, rad.
    conformity : (float, float) or None
        Groove radius over ball diameter, inner and outer; for spherical rollers over twice the radius
        of their contour.
    profile : {'logarithmic', 'straight'}
        Profile of cylindrical, tapered and needle rollers, by ISO/TS 16281.
    arrangement : str
        Rows: single, double_row (of bearings that hold no shaft along y, or both ways), tandem,
        back_to_back (or "O") or face_to_face (or "X"): two rows in this one bearing.
    row_distance : float or None
        Distance of the rows' middles, m; by default the width.
    holds : {'+y', '-y'} or None
        Direction in which single rows and tandems with a contact angle keep the shaft from moving;
        they need it, since mounting decides it, or else `arrangement` of the scene.
    clearance : float or str
        Radial internal clearance, m, or a class of ISO 5753-1 (CM: of electric motors), taken in its
        middle.
    shaft_interference, housing_interference : float
        Interference of the fits, on the diameter, m.
    inner_ring_warmer : float
        Temperature of the inner ring above the outer one, K.
    preload : Preload or None
        Preload along y; a text with a unit in a file: ``"500 N"`` or ``"10 um"``.
    preload_spring : float or None
        Stiffness of the spring that preloads the upper row of a pair, N/m.
    speed : float
        Speed of the inner ring, rad/s, where neither a case nor an operating point has one; balls
        have their inertia at it.
    load : BearingLoad or None
        Load at which the stiffness is taken.
    displacement : BearingDisplacement or None
        Displacement at which the stiffness is taken.

    Raises
    ------
    SceneError
        Data that contradict each other, one sentence each.

    Examples
    --------
    >>> data = Catalogue(designation="6208", load={"z": "2 kN"})
    >>> data.kind, data.bore, data.estimated
    ('deep_groove', 0.04, ('elements', 'element_diameter', 'pitch_diameter', 'conformity'))
    """

    needs: ClassVar = (("designation", ("kind", "bore", "outer_diameter", "width")),)

    kind: Kind
    designation: str = ""
    bore: PositiveLength
    outer_diameter: PositiveLength
    width: PositiveLength
    raceway: PositiveLength | None = None
    cage: bool = True
    ribs: Literal["none", "one way", "both ways"] = "none"
    rib_stiffness: AxialSpring | None = None
    listed: str = ""
    load_rating: PositiveLoad | None = None
    static_rating: PositiveLoad | None = None
    fatigue_limit: PositiveLoad | None = None
    rating_factor: RatingFactor | None = None
    elements: Annotated[int, Field(strict=True, ge=FEWEST, le=MOST)] | None = None
    element_diameter: PositiveLength | None = None
    element_length: PositiveLength | None = None
    pitch_diameter: PositiveLength | None = None
    contact_angle: Angle | None = None
    conformity: (
        Annotated[tuple[float, float], BeforeValidator(_conformity), Written(Conformity)] | None
    ) = None
    profile: Literal["logarithmic", "straight"] = "logarithmic"
    arrangement: Annotated[
        Arrangement, BeforeValidator(arrangement_word), Written(ArrangementWord)
    ] = "single"
    row_distance: PositiveLength | None = None
    holds: Literal["+y", "-y"] | None = None
    clearance: Annotated[
        float | ClearanceClass, BeforeValidator(_clearance), Written(Length | ClearanceClass)
    ] = 0.0
    shaft_interference: Length = 0.0
    housing_interference: Length = 0.0
    inner_ring_warmer: TemperatureRise = 0.0
    preload: Annotated[
        Preload | None, BeforeValidator(_preload), Written(PreloadText | Preload)
    ] = None
    preload_spring: AxialSpring | None = None
    speed: Speed = 0.0
    load: BearingLoad | None = None
    displacement: BearingDisplacement | None = None

    def __init__(self, /, **data: Any):
        if "support" in data:
            reason = "belongs to the bearing, not to its catalogue data"
            raise SceneError(reason, path=("support",), value=show(data["support"]))
        if "designation" in data and not (
            isinstance(data["designation"], str) and (data["designation"] or "kind" in data)
        ):
            reason = 'must be a text in quotes, such as "6208", or left out'
            raise SceneError(reason, path=("designation",), value=show(data["designation"]))
        data = with_listed_by_variable(data, Catalogue)
        if (
            isinstance(data.get("designation"), str)
            and data["designation"]
            # a file of another program leaves out what the designation gives, and keeps the list
            and not ("kind" in data and data.get("listed"))
        ):
            data = _with_boundary(data)
        super().__init__(**data)

    @property
    def nature(self) -> Shares:
        """Nature and usual inside of the kind."""
        return SHARES[self.kind]

    @property
    def one_sided(self) -> bool:
        """True where the bearing holds the shaft in one direction along y only."""
        by_ribs = self.ribs == "one way" and self.holds is not None
        return by_ribs or self.faces_one_way

    @property
    def faces_one_way(self) -> bool:
        """True where the contact angle of all rows holds the shaft in one direction along y."""
        return self.nature.holds == "one way" and self.arrangement in ("single", "tandem")

    @property
    def ribbed(self) -> bool:
        """True where ribs hold the shaft along y."""
        return self.ribs == "both ways" or (self.ribs == "one way" and self.holds is not None)

    @property
    def angled(self) -> bool:
        """True for kinds with a contact angle."""
        return self.nature.angled

    @property
    def own_rows(self) -> int:
        """Rows of a single bearing of this kind."""
        return self.nature.rows

    @property
    def grooved(self) -> bool:
        """True for kinds whose contacts depend on the conformity of grooves."""
        return self.balls or self.barrels

    @property
    def floats(self) -> bool:
        """True for kinds that carry nothing along y."""
        return self.nature.holds == "nothing" and not self.ribbed

    @property
    def balls(self) -> bool:
        """True for kinds with balls."""
        return self.nature.elements == "balls"

    @property
    def barrels(self) -> bool:
        """True for kinds with barrels on a sphere, whose ring tilts freely."""
        return self.nature.elements == "barrels"

    @property
    def paired(self) -> bool:
        """True for two bearings side by side."""
        return self.arrangement in PAIRED

    @property
    def seat_width(self) -> float:
        """Width of all rows together, m."""
        return self.width * (2 if self.paired else 1)

    @property
    def opposed(self) -> bool:
        """True where two rows hold the shaft against each other."""
        return self.own_rows > 1 or (self.paired and self.arrangement != "tandem")

    @property
    def both_ways(self) -> bool:
        """True where the bearing holds the shaft along y in both directions."""
        return not (self.floats or self.one_sided)

    @property
    def rated_rows(self) -> int:
        """Rows that the load ratings are given for."""
        return 2 if self.arrangement == "double_row" else self.own_rows

    @property
    def estimated(self) -> tuple[str, ...]:
        """Inner dimensions that are not given, by field name."""
        inner = ["elements", "element_diameter", "pitch_diameter"]
        inner += ["conformity"] * self.grooved + ["element_length"] * (not self.balls)
        if self.angled:
            inner.append("contact_angle")
        if self.ribbed:
            inner.append("rib_stiffness")
        return tuple(name for name in inner if getattr(self, name) is None)

    @property
    def written_too(self) -> tuple[str, ...]:
        """Fields that a file has even where they have their default, for the designation says
        something else.
        """
        if not self.designation or self.listed:
            return ("clearance",)
        said = boundary(self.designation)
        usual = {key: type(self).model_fields[key].get_default() for key in DESIGNATED}
        unlike = (k for k in DESIGNATED if getattr(self, k) == usual[k] != getattr(said, k))
        return ("clearance", *(key for key in unlike if getattr(said, key) is not None))

    def at_speed(self, speed: float) -> Catalogue:
        """Return the data at a speed of the shaft, rad/s; as they are where they are solved at rest
        only.
        """
        at_rest_only = "speed" in _REFUSED.get(self.kind, {}) or self.preload_spring is not None
        if not self.balls or at_rest_only or speed == self.speed:
            return self
        return self.model_copy(update={"speed": speed})

    @model_validator(mode="after")
    def _hangs_together(self) -> Catalogue:
        if problems := [*catalogue_problems(self)]:
            raise SceneError.of(problems)
        return self


def _with_boundary(data: dict[str, Any]) -> dict[str, Any]:
    """Return catalogue data completed by the standard dimensions of the designation."""
    try:
        standard = boundary(data["designation"])
    except SceneError as error:
        raise SceneError(error.reason, path=("designation",), value=error.value) from None
    fields = {key: value for key, value in standard._asdict().items() if value is not None}
    del fields["ignored"]
    if fields.pop("tapered_bore") and data.get("clearance") is None:
        raise SceneError(
            "has a tapered bore, K: its clearance is what is left once it is driven up; write it, as "
            'clearance = "20 um"',
            path=("clearance",),
            value=show(data["designation"]),
        )
    if "kind" in data and data["kind"] != standard.kind:
        raise SceneError(
            f"does not fit the designation {show(data['designation'])}, which is {standard.kind}",
            path=("kind",),
            value=show(data["kind"]),
        )
    return {key: value for key, value in fields.items() if data.get(key) is None} | {
        key: value for key, value in data.items() if value is not None or key not in fields
    }


def catalogue_problems(data: Catalogue) -> Iterator[SceneError]:
    """Yield all problems of catalogue data, one sentence each."""
    if data.outer_diameter <= data.bore:
        yield SceneError(
            f"must be larger than the bore ({data.bore:.6g} m)", path=("outer_diameter",)
        )
        return
    yield from _belongs(data)
    yield from _fits(data)
    if data.load is not None and data.displacement is not None:
        yield SceneError("give either load or displacement, not both", path=("displacement",))


def _belongs(data: Catalogue) -> Iterator[SceneError]:
    """Yield problems of keys that the kind or the arrangement does not have."""
    kind = data.kind.replace("_", " ")
    if data.kind in _REFUSED:
        yield from _by_nature(data, kind)
    elif not data.angled:
        if data.contact_angle is not None:
            yield SceneError(
                f"a {kind} bearing has no contact angle of its own: leave it out, or write "
                f'kind = "{"angular_contact" if data.balls else "tapered"}"',
                path=("contact_angle",),
            )
        if data.arrangement not in ("single", "double_row"):
            yield SceneError(
                f"{kind} bearings have no contact angle to pair: write single or double_row",
                path=("arrangement",),
            )
        if data.preload is not None:
            yield SceneError(
                f"a {kind} bearing is not preloaded along y: write a negative clearance",
                path=("preload",),
            )
    elif data.arrangement == "double_row":
        yield SceneError(
            f"two rows of {kind} bearings are back_to_back, face_to_face or tandem",
            path=("arrangement",),
        )
    if data.kind != "cylindrical":
        for key in ("ribs", "rib_stiffness"):
            if getattr(data, key) not in (None, "none"):
                yield SceneError(f"a {kind} bearing has no ribs to give: leave it out", path=(key,))
    elif data.rib_stiffness is not None and not data.ribbed:
        yield SceneError(
            'no rib holds this bearing: write ribs = "both ways", or "one way" with holds',
            path=("rib_stiffness",),
        )
    if data.faces_one_way and data.holds is None:
        yield SceneError(
            f"{data.arrangement} {kind} bearings hold the shaft in one direction only: write "
            'holds = "+y" if this one keeps it from moving towards +y, else "-y", or for a pair '
            'arrangement = "O" or "X" above all tables',
            path=("holds",),
        )
    for key, allowed, owner in (
        ("conformity", data.grooved, "balls and spherical rollers"),
        ("element_length", not data.balls, "rollers"),
        ("speed", data.balls, "balls"),
    ):
        if getattr(data, key) and not allowed:
            yield SceneError(
                f"belongs to {owner}; a {kind} bearing has none: leave it out", path=(key,)
            )
    if not data.cage and (data.balls or data.barrels):
        yield SceneError(f"a {kind} bearing has a cage: leave it out", path=("cage",))
    if data.preload_spring is not None and data.speed:
        yield SceneError(
            "a pair on a preload spring is solved at rest only: leave out speed, or the spring",
            path=("speed",),
        )
    if data.preload_spring is not None and (
        data.arrangement not in ("back_to_back", "face_to_face")
        or data.preload is None
        or data.preload.force is None
    ):
        yield SceneError(
            'needs a pair, arrangement = "back_to_back" or "face_to_face", and a preload such as '
            '"500 N"',
            path=("preload_spring",),
        )


_TWO_ROWS = {
    "arrangement": "has two rows of its own",
    "preload": "is preloaded by a negative clearance and not along y",
}
_AT_REST = {"speed": "is computed at rest only, without what speed does to its balls"}
#: keys that a kind does not have, with the reason
_REFUSED = {
    "spherical": {**_TWO_ROWS, "profile": "has barrels, whose profile is their conformity"},
    "double_row_angular": {"arrangement": "has two rows of its own, back to back"},
    "four_point": {**_TWO_ROWS, **_AT_REST},
    "self_aligning": {**_TWO_ROWS, **_AT_REST},
    "thrust_ball": {
        "arrangement": "has one row and holds one way (of two, write holds at each)",
        "contact_angle": "stands at 90 degrees",
        "clearance": "has no clearance across the shaft",
        "shaft_interference": "is not made tighter by its fit",
        "housing_interference": "is not made tighter by its fit",
        "inner_ring_warmer": "is not made tighter by a warm shaft",
        **_AT_REST,
    },
}


def _by_nature(data: Catalogue, kind: str) -> Iterator[SceneError]:
    """Yield problems of keys that the kind does not have."""
    names = {"spherical": "spherical roller", "self_aligning": "self-aligning ball"}
    for key, reason in _REFUSED[data.kind].items():
        if getattr(data, key) != type(data).model_fields[key].get_default():
            name = names.get(data.kind, kind)
            yield SceneError(f"a {name} bearing {reason}: leave it out", path=(key,))


def _fits(data: Catalogue) -> Iterator[SceneError]:
    """Yield problems of sizes that leave no room for each other."""
    room = (data.outer_diameter - data.bore) / 2
    if data.element_diameter is not None and data.element_diameter >= room:
        yield SceneError(
            f"does not fit between bore and outer_diameter, {room:.6g} m apart",
            path=("element_diameter",),
        )
        return
    if data.raceway is not None and not data.bore < data.raceway < data.outer_diameter:
        yield SceneError(
            f"must lie between bore and outer_diameter ({data.bore:.6g} and "
            f"{data.outer_diameter:.6g} m)",
            path=("raceway",),
        )
    if data.element_length is not None and data.element_length > data.width:
        yield SceneError(
            f"must not be longer than the width ({data.width:.6g} m)", path=("element_length",)
        )
    pitch = data.pitch_diameter or (data.bore + data.outer_diameter) / 2
    if not data.bore < pitch < data.outer_diameter:
        yield SceneError(
            f"must lie between bore and outer_diameter ({data.bore:.6g} and "
            f"{data.outer_diameter:.6g} m)",
            path=("pitch_diameter",),
        )
    elif data.elements is not None and data.element_diameter is not None:
        most = int(math.pi / math.asin(min(data.element_diameter / pitch, 1.0)) + 1e-9)
        if data.elements > most:
            yield SceneError(
                f"more than fit on the pitch circle of {pitch:.6g} m: at most {most} elements of "
                f"{data.element_diameter:.6g} m",
                path=("elements",),
            )


def catalogue_of(bearing: Bearing) -> Catalogue | None:
    """Return the catalogue data of a bearing; None where its stiffness is given."""
    data = bearing.catalogue
    return data if isinstance(data, Catalogue) else None
