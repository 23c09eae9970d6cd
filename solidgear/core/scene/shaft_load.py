"""Load on a shaft at any place, by its components or by what a designer knows of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from solidgear.core.errors import SceneError, show
from solidgear.core.scene.gravity import GRAVITY
from solidgear.core.scene.load import ABOUT_AXIS
from solidgear.core.scene.load_force import (
    ACROSS,
    PULLS,
    USUAL_PRESSURE_ANGLE,
    Belt,
    Teeth,
    direction,
    pulls,
)
from solidgear.core.scene.load_kinds import check_words, kind_of
from solidgear.core.scene.places import Along, Placed, Places
from solidgear.core.scene.stations import Attachment, Port
from solidgear.core.scene.units import (
    Diameter,
    Factor,
    Length,
    Mass,
    Newtons,
    NotNegativeLoad,
    PitchAngle,
    Position,
    PositiveLength,
    PositiveLoad,
    Power,
    PressureAngle,
    SignedAngle,
    SpiralAngle,
    Torque,
    quantity,
)
from solidgear.core.scene.written import Written

ON_A_STATION = "belongs to a place of its own; a load on a station has that of the station"

TOWARDS = (
    'must be "+x", "-x", "+z", "-z", or an angle from x towards z such as "30 deg": from the axis '
    "to the tooth contact, the other pulley, or where the force points"
)
#: largest angle, rad, with what rounding adds
TURN = 2 * np.pi + 1e-9
AxisWord = Literal["+x", "-x", "+z", "-z"]
Sense = Literal["driving", "driven"]
Hand = Literal["left", "right"]
AlongAxis = Literal["+y", "-y"]


def _towards(value: Any) -> Any:
    """Return a direction as a word, or as an angle in rad."""
    if isinstance(value, str):
        word = value.strip().lower()
        word = word if word[:1] in ("+", "-") else f"+{word}"
        if word in ACROSS:
            return word
    try:
        angle = quantity(value, "angle")
    except SceneError:
        raise SceneError(TOWARDS) from None
    if abs(angle) > TURN:
        raise SceneError(f"is more than a turn: plain numbers are rad; {TOWARDS}")
    return angle


Towards = Annotated[str | float, BeforeValidator(_towards), Written(AxisWord | SignedAngle)]


class ShaftLoad(Placed):
    """A load on a shaft: components, teeth, a belt, a weight, or a force with an angle.

    Attributes
    ----------
    name : str
        Name in results, cases and sweeps; without it that of the station, or a number.
    on : str or None
        Lumped point, bearing or mass that it acts on, or a segment; None for a place of its own.
    lo, hi : float or None
        Ends of the surface that carries it, m, where it has a place of its own, in whose middle it
        acts: by ``position="40 mm", seat_width="20 mm"``, ``at="hub.middle"``, or `span`.
    attachment : {'average', 'rigid', 'section'}
        How that surface follows it.
    x, y, z, thx, thz : float or None
        Forces along the axes, N, and moments about x and z, N m.
    torque : float or None
        Moment about the axis, N m, positive about +y; also of gears and belts.
    power : float or None
        In place of a torque: power at the speed of the case, W, positive where it is brought to the
        shaft.
    pitch_diameter, tangential_force, pressure_angle, helix_angle, hand, pitch_angle, apex
        Of a gear: reference diameter at the middle of the face, force in place of a torque, pressure
        angle in the normal section (20 degrees by default), helix or spiral angle with its hand,
        pitch angle of a bevel gear with the side of its apex.
    diameter, tight, slack, pull_ratio : float or None
        Of a belt or chain: any two of torque, both pulls and their ratio.
    mass : float or None
        Of a weight, kg.
    radial, axial : float or None
        Force across the shaft and along it, N.
    towards : str, float or None
        Direction from the axis to the tooth contact, to the other pulley, or of a force.
    sense : {'driving', 'driven'} or None
        With a torque as a size: a driven gear or pulley turns the shaft.

    Raises
    ------
    SceneError
        Words of two kinds of load, words that are missing, and pulls that no belt has.

    Examples
    --------
    >>> from solidgear import ShaftLoad
    >>> gear = ShaftLoad(name="gear", on="gear", torque="100 N*m", pitch_diameter="80 mm",
    ...                  towards="+x")
    >>> gear.six().round(1).tolist()
    [-909.9, 0.0, -2500.0, 0.0, 100.0, 0.0]
    """

    class Words(Along):
        """Words for a place of its own."""

        #: place of its middle, such as `NAME.middle` of a segment
        at: str | None = None
        #: width of the surface that carries it, m
        seat_width: PositiveLength | None = None
        #: ends of that surface, from the start of the shaft, m
        span: Annotated[list[Length], Field(min_length=2, max_length=2)] | None = None

    sources: ClassVar = {
        "lo": ("at", "position", "span", "seat_width"),
        "hi": ("seat_width", "span", "at", "position"),
    }
    needs: ClassVar = (("on", "position", "at", "span"), ("on", "seat_width", "span"))
    _aliases: ClassVar = {}

    #: name in results, cases and sweeps; by default that of the station
    name: str = ""
    #: lumped point, bearing, mass or segment that it acts on
    on: str | None = None
    lo: Position | None = None
    hi: Position | None = None
    #: how the surface follows it
    attachment: Attachment = "average"
    #: force along x, N
    x: Newtons | None = None
    #: force along y, the axis, N
    y: Newtons | None = None
    #: force along z, N
    z: Newtons | None = None
    #: moment about x, N m
    thx: Torque | None = None
    #: moment about z, N m
    thz: Torque | None = None
    #: moment about the axis, N m, positive about +y; also of a gear or a belt
    torque: Torque | None = None
    #: in place of a torque: power at the speed of the case, W, positive where it is brought to the shaft;
    #: a size with `sense`
    power: Power | None = None
    #: of a gear: reference diameter at the middle of its face, m
    pitch_diameter: Diameter | None = None
    #: of a gear, in place of a torque: tangential force with the sign of the torque, N
    tangential_force: Newtons | None = None
    #: of a gear: pressure angle in the normal section; 20 deg by default
    pressure_angle: PressureAngle | None = None
    #: of a gear: helix angle, or spiral angle of a bevel gear
    helix_angle: SpiralAngle | None = None
    #: of a helix or spiral
    hand: Hand | None = None
    #: of a bevel gear: between its axis and its pitch cone
    pitch_angle: PitchAngle | None = None
    #: of a bevel gear: side on which the apex of its pitch cone lies
    apex: AlongAxis | None = None
    #: of a belt or chain: diameter of the pulley, m
    diameter: Diameter | None = None
    #: of a belt or chain: pull of the tight side, N
    tight: PositiveLoad | None = None
    #: of a belt or chain: pull of the slack side, N
    slack: NotNegativeLoad | None = None
    #: of a belt: pull of the tight side over that of the slack one
    pull_ratio: Factor | None = None
    #: of a weight, kg
    mass: Mass | None = None
    #: force across the shaft, N
    radial: Newtons | None = None
    #: force along y, N
    axial: Newtons | None = None
    #: from the axis to the tooth contact or the other pulley, or where a force points: an axis, or an
    #: angle from x towards z
    towards: Towards | None = None
    #: a driven gear or pulley turns the shaft, a driving one is turned by it; torques are sizes then
    sense: Sense | None = None

    def __init__(self, /, **data: Any):
        _refuse_about_axis(data)
        super().__init__(**data)

    @classmethod
    def read(cls, table: Mapping[str, Any], places: Places, **usual: Any) -> ShaftLoad | None:
        _refuse_about_axis(table)
        return super().read(table, places, **usual)

    @classmethod
    def _unplaced(cls, table: Mapping[str, Any]) -> dict[str, None]:
        return {"lo": None, "hi": None}

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        if "on" in table:
            words.refuse(ON_A_STATION, "position", "from_", "at", "seat_width", "span")
            words.refuse(ON_A_STATION, "attachment", table=table)
            return {"attachment": "average"}
        if words.span is not None:
            reason = "span gives the place and the width; leave one of them out"
            words.refuse(reason, "position", "from_", "at", "seat_width")
            lo, hi = words.span
            return {"lo": lo, "hi": hi}
        middle = cls._middle(words, places)
        hint = "the width of the surface that carries the load, such as that of the hub"
        words.require("seat_width", hint)
        if middle is None:
            return {"lo": None, "hi": None}
        return {"lo": middle - words.seat_width / 2, "hi": middle + words.seat_width / 2}

    @staticmethod
    def _middle(words: Any, places: Places) -> float | None:
        """Return the middle of a place of its own, m."""
        if words.at is not None:
            words.refuse("give either at, or position with from, not both", "position", "from_")
            return places.datum(words.at, "at")
        hint = (
            "name the point, bearing, mass or segment that it acts on, or write position = "
            '"28 mm" and seat_width'
        )
        words.require("position", hint, "on")
        return words.y(places)

    @model_validator(mode="after")
    def _is_one_load(self) -> ShaftLoad:
        if self.on is None and (self.lo is None or self.hi is None):
            raise SceneError(
                "this key is missing: name the point, bearing, mass or segment that it acts on, or "
                'write position = "28 mm" and seat_width',
                path=("on",),
            )
        check_words(self)
        self.pulls()
        return self

    @property
    def kind(self) -> str:
        """Kind of load, of `KINDS`: that of which words are given."""
        return kind_of(self)

    def pulls(self) -> tuple[float, float] | None:
        """Return the pulls of the tight and the slack side of a belt, N; None of another load."""
        if self.kind != "belt" or self.diameter is None or self.power is not None:
            return None
        numbers = {word: getattr(self, word) for word in PULLS if getattr(self, word) is not None}
        if self.torque is None and self.sense is None:
            raise SceneError(
                'this key is missing: "driven" where the belt turns the shaft, "driving" where it '
                "is turned, or give torque with a sign",
                path=("sense",),
            )
        return pulls(numbers, self.diameter)

    def at_speed(self, speed: float | None, turns: float = 1.0) -> ShaftLoad:
        """Return the load with the torque of its power.

        Parameters
        ----------
        speed : float or None
            Speed of the shaft, rad/s, which a power needs.
        turns : float
            1 for a shaft that turns about +y, -1 for one about -y.

        Returns
        -------
        ShaftLoad

        Raises
        ------
        SceneError
            A power without a speed.

        Examples
        --------
        >>> from solidgear import ShaftLoad
        >>> motor = ShaftLoad(on="coupling", power="5.5 kW")
        >>> round(motor.at_speed(157.08).torque, 2)
        35.01
        """
        if self.power is None:
            return self
        if not speed:
            raise SceneError(
                'a power gives a torque at a speed: write [[case]] with speed = "1500 rpm", or '
                "torque in place of power",
                path=("power",),
            )
        way = turns if self.sense is None else 1.0
        return self.with_changes(power=None, torque=way * self.power / speed)

    def six(
        self, factor: float = 1.0, turns: float = 1.0, speed: float | None = None
    ) -> np.ndarray:
        """Return the load on the axis, times a factor.

        Parameters
        ----------
        factor : float
            On torques and forces; teeth under a torque turned round press with their other flanks,
            and a belt pulls with its other side.
        turns : float
            1 for a shaft that turns about +y, -1 for one about -y, for which `sense` asks.
        speed : float, optional
            Speed of the shaft, rad/s, for which `power` asks.

        Returns
        -------
        (6,) array
            x, y, z in N, thx, thy (the torque), thz in N m.
        """
        if self.power is not None:
            return self.at_speed(speed, turns).six(factor, turns)
        way = 1.0 if self.sense is None else turns * (1.0 if self.sense == "driven" else -1.0)
        if self.kind == "gear":
            return self._teeth().six(factor * way * self._tooth_torque())
        if (sides := self.pulls()) is not None:
            assert self.diameter is not None and self.towards is not None
            tight, slack = (abs(factor) * pull for pull in sides)
            sign = way * np.sign(factor) * (1.0 if (self.torque or 0.0) >= 0 else -1.0)
            return Belt(tight, slack, self.diameter, self.towards).six(float(sign))
        out = np.array(
            [getattr(self, word) or 0.0 for word in ("x", "y", "z", "thx", "torque", "thz")]
        )
        if self.towards is not None:
            size = self.mass * GRAVITY if self.mass is not None else self.radial or 0.0
            out[:3] += size * direction(self.towards)
        out[1] += self.axial or 0.0
        return factor * out

    def _tooth_torque(self) -> float:
        """Return the torque of a gear, N m, as it is written."""
        if self.torque is not None:
            return self.torque
        assert self.tangential_force is not None and self.pitch_diameter is not None
        return self.tangential_force * self.pitch_diameter / 2

    def _teeth(self) -> Teeth:
        """Return the teeth of a gear."""
        assert self.pitch_diameter is not None and self.towards is not None
        return Teeth(
            self.pitch_diameter,
            self.towards,
            USUAL_PRESSURE_ANGLE if self.pressure_angle is None else self.pressure_angle,
            self.helix_angle or 0.0,
            self.hand or "right",
            self.pitch_angle or 0.0,
            self.apex or "-y",
        )

    @property
    def assumed(self) -> tuple[str, ...]:
        """Sentences on what the words of the load leave open."""
        out = []
        if self.kind == "gear" and self.pressure_angle is None:
            out.append(f"{self.name}: pressure angle 20 deg assumed")
        sides = self.pulls()
        if (sides is not None and sides[1] > 0) or (self.kind == "belt" and self.power is not None):
            out.append(f"{self.name}: both strands of the belt are taken as parallel")
        return tuple(out)

    @property
    def seat(self) -> Port | None:
        """Station of a place of its own; None of a load on another station."""
        if self.lo is None or self.hi is None:
            return None
        middle = (self.lo + self.hi) / 2
        return Port(name=self.name, y=middle, lo=self.lo, hi=self.hi, attachment=self.attachment)

    @property
    def station(self) -> str:
        """Name of the station that it acts on."""
        return self.on or self.name

    def attached(self, attachment: str) -> ShaftLoad:
        """Return the load with another attachment of its seat; one on a station unchanged."""
        return self if self.on is not None else self.with_changes(attachment=attachment)


def _refuse_about_axis(data: Mapping[str, Any]) -> None:
    """Refuse a torque under another name."""
    for key in data:
        if key.lower() in ABOUT_AXIS and key != "torque":
            raise SceneError(
                "a moment about the axis is written torque: the shaft turns freely about y, and only "
                "other torques or something that holds it there can take it",
                path=(key,),
                value=show(data[key]),
            )
