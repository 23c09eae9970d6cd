"""Facts of a data sheet, in SI and free of any language."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from typing import Any, NamedTuple

from solidgear.core.machine.version import VERSION
from solidgear.core.plain import plain

#: least and largest of a number over the data that are open
Range = tuple[float, float] | None
#: share of a speed within which a resonance is listed
NEAR = 0.2


class Amount(NamedTuple):
    """A number in a sentence, with its SI unit and the figures that it is written with."""

    value: float
    unit: str
    digits: int | None = 4  #: None: as it was written


class Place(NamedTuple):
    """A place along a shaft in a sentence, m."""

    y: float


class Speed(NamedTuple):
    """A speed in a sentence, rad/s."""

    value: float


class Term(NamedTuple):
    """A word in a sentence that has one in every language: its key in the table of messages."""

    key: str


class ModeTerm(NamedTuple):
    """The name of a mode in a sentence, or of a model, which has words in every language."""

    name: str


@dataclass(frozen=True)
class Remark:
    """A sentence: its key in the table of messages, and what stands in it."""

    key: str
    values: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Figure:
    """A number with both error bars."""

    name: str  #: of the quantity, such as ``C_zz@wheel``, or of the measure of a train
    value: float  #: SI
    unit: str
    #: bar, open: error of mesh and solver, and change over the open data, relative; None where
    #: there is no such bar
    bar: float | None
    open: Range = None


@dataclass(frozen=True)
class Force:
    """Load on a shaft at one place, of teeth, from outside, or of a bearing."""

    name: str
    y: float  #: m
    six: tuple[float, ...]  #: (6,) on the shaft, N and N m, in the axes of its scene
    by_bearing: bool


@dataclass(frozen=True)
class DrawnShaft:
    """A shaft as it is drawn."""

    name: str
    scene: Mapping[str, Any] = field(repr=False)
    forces: tuple[Force, ...] = ()
    sense: str = ""  #: in which it turns, ``+y`` or ``-y`` of its scene; empty where unknown
    speed: float | None = None  #: rad/s


@dataclass(frozen=True)
class Trust:
    """The model that numbers come from, and why."""

    model: str
    tolerance: float  #: asked for, relative
    reached: bool
    #: widest error bars of compliances (of a train, of the misalignment) and of frequencies,
    #: relative; None without any
    static_bar: float | None
    frequency_bar: float | None
    cheapest: str = ""  #: cheapest model within the tolerance; empty where none was shown to be
    gap: float | None = None  #: by so much, relative
    demand: str = ""  #: key of what that tolerance is of


@dataclass(frozen=True)
class LesserSafety:
    """A safety of one kind that is least at another notch than that against fatigue is."""

    kind: str  #: ``yielding`` or ``crack``
    shaft: str
    place: str
    y: float  #: m
    safety: float


@dataclass(frozen=True)
class UnratedCorner:
    """A sharp corner, whose safety nothing gives."""

    shaft: str
    y: float  #: m


@dataclass(frozen=True)
class WorstNotch:
    """The notch with the least safety against fatigue, or the largest stress where none is rated."""

    shaft: str
    place: str
    y: float  #: m
    #: amplitude by bending, Pa: on its surface with an error bar, or the nominal one without
    amplitude: float
    bar: float | None
    #: fatigue, yielding: safeties by DIN 743; None where it is not rated
    fatigue: float | None
    yielding: float | None
    assumed: tuple[str, ...] = ()  #: symbols of factors that were not given
    #: safeties against fatigue and yielding with K_1 of the steels that fall most; None where known
    least: tuple[float, float] | None = None
    open: Range = None  #: least and largest amplitude over open data, Pa
    #: safeties of other kinds that are less at other notches
    elsewhere: tuple[LesserSafety, ...] = ()


@dataclass(frozen=True)
class WorstSection:
    """The section with the largest nominal stress by von Mises."""

    shaft: str
    segment: str
    y: float  #: m
    #: equivalent, bending, torsion, tension: Pa
    equivalent: float
    bending: float
    torsion: float
    tension: float


@dataclass(frozen=True)
class BearingFact:
    """Load and life of a bearing."""

    name: str
    designation: str
    #: radial, axial: load of the shaft on it, N; None without a load
    radial: float | None = None
    axial: float | None = None
    kind: str = ""  #: of its life, ``modified`` or ``reference``; empty without one
    life: float | None = None  #: revolutions
    open: Range = None  #: revolutions
    hours: float | None = None  #: at the speed, or over the duty table
    static_safety: float | None = None
    over_table: bool = False  #: its life is that over a duty table, whatever the point of the load


@dataclass(frozen=True)
class MotionFact:
    """Motion of a gear or another lumped point under load."""

    place: str
    #: radial, radial_bar: size across the shaft and its error bar, m
    radial: float
    radial_bar: float | None
    #: tilt, tilt_bar: size against the axis and its error bar, rad
    tilt: float
    tilt_bar: float | None
    open: Range = None  #: of the radial motion, m
    open_tilt: Range = None
    #: axial, axial_bar: size along the shaft and its error bar, m
    axial: float = 0.0
    axial_bar: float | None = None
    open_axial: Range = None

    @property
    def size(self) -> float:
        """Size of the whole motion, m."""
        return math.hypot(self.radial, self.axial)


@dataclass(frozen=True)
class Frequency:
    """A natural frequency, with the speed at which a shaft turns as fast."""

    mode: str
    hz: float
    bar: float | None  #: relative
    open: Range = None  #: relative


@dataclass(frozen=True)
class Resonance:
    """A speed at which an order meets a natural frequency."""

    order: int
    source: str  #: shaft or mesh that has the order
    by_teeth: bool
    mode: str
    #: speed, low, high: rad/s, its middle, and its ends by error bar and open data
    speed: float
    low: float
    high: float
    distance: float  #: of the speed of the file from it, relative


@dataclass(frozen=True, eq=False)
class Facts:
    """Facts of one page of a shaft or a train."""

    title: str
    file: str
    train: bool
    trust: Trust
    drawn: tuple[DrawnShaft, ...] = ()
    figures: tuple[Figure, ...] = ()  #: the numbers asked for
    notch: WorstNotch | None = None
    corners: tuple[UnratedCorner, ...] = ()  #: sharp ones, of all shafts
    section: WorstSection | None = None
    bearings: tuple[BearingFact, ...] = ()
    motions: tuple[MotionFact, ...] = ()
    frequencies: tuple[Frequency, ...] = ()
    #: speeds of the shaft `turns` at which orders meet natural frequencies, the nearest first
    resonances: tuple[Resonance, ...] = ()
    turns: str = ""  #: shaft that speeds belong to; empty of a shaft alone
    speed: float | None = None  #: rad/s
    operation: Remark | None = None  #: operating point of a train
    assumed: tuple[Remark, ...] = ()
    absent: dict[str, Remark] = field(default_factory=dict)  #: why a section is left out
    cautions: tuple[Remark, ...] = ()
    elsewhere: int = 0  #: further cautions, which the commands behind the sheet print
    language: str = "en"
    day: date = field(default_factory=date.today)
    version: str = VERSION
    report: str = ""  #: page that the sheet links to

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        data = plain(self)
        return data | {"day": self.day.isoformat()}
