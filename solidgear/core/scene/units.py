"""Conversion of quantities as users write them to floats in SI, and the types of fields.

The only module that imports pint, once a text needs it: the import costs more than solving a beam.
"""

from __future__ import annotations

import functools
import math
import numbers
import re
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from solidgear.core.errors import SceneError, show
from solidgear.core.scene.written import Measure, Range, Three

#: dimension -> (unit of a plain number, SI but for hours, example as text, allowed powers of the
#: radian). pint holds the radian to
#: be dimensionless, so N, N/rad and N*rad look alike to it; the power is what sets an angle apart
#: from a ratio, and rpm from Hz.
DIMENSIONS: dict[str, tuple[str, str, tuple[int, ...]]] = {
    "length": ("m", "90 mm", (0,)),
    "angle": ("rad", "22.4 deg", (1,)),
    "pressure": ("Pa", "207 GPa", (0,)),
    "density": ("kg/m^3", "7850 kg/m^3", (0,)),
    "force_per_length": ("N/m", "8.6e9 N/m", (0,)),
    "force": ("N/rad", "1.45e8 N/rad", (0, -1)),
    "moment": ("N*m/rad", "3.6e6 N*m/rad", (0, -1)),
    "mass": ("kg", "8 kg", (0,)),
    "inertia": ("kg*m^2", "0.02 kg*m^2", (0,)),
    "frequency": ("Hz", "10 kHz", (0,)),
    "load": ("N", "2 kN", (0,)),
    "torque": ("N*m", "15 N*m", (0,)),
    "speed": ("rad/s", "3000 rpm", (1,)),
    "viscosity": ("m^2/s", "68 mm^2/s", (0,)),
    "temperature": ("K", "10 K", (0,)),
    "time": ("h", "6000 h", (0,)),
    "power": ("W", "5.5 kW", (0,)),
    "dimensionless": ("", "0.3", (0,)),
}

#: base dimensions with their powers, by name
Dimension = tuple[tuple[str, float], ...]


def _dimension(*, length: int = 0, mass: int = 0, temperature: int = 0, time: int = 0) -> Dimension:
    powers = {
        "[length]": length,
        "[mass]": mass,
        "[temperature]": temperature,
        "[time]": time,
    }
    return tuple((name, float(power)) for name, power in powers.items() if power)


_LENGTH, _ANGLE, _RATE = _dimension(length=1), _dimension(), _dimension(time=-1)
_STRESS, _DENSITY = _dimension(mass=1, length=-1, time=-2), _dimension(mass=1, length=-3)
_PER_LENGTH, _FORCE = _dimension(mass=1, time=-2), _dimension(mass=1, length=1, time=-2)
_VISCOSITY = _dimension(length=2, time=-1)
_MOMENT, _INERTIA = _dimension(mass=1, length=2, time=-2), _dimension(mass=1, length=2)
_TIME = _dimension(time=1)
#: s; plain numbers of times are hours
HOUR = 3600.0
#: units of nearly every scene: (SI units in one, power of the radian, dimension). The numbers are
#: those of pint (a test compares), without the half second that pint takes to start
COMMON: dict[str, tuple[float, float, Dimension]] = {
    unit: (factor, radians, dimension)
    for dimension, radians, units in (
        (_LENGTH, 0.0, {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "in": 0.0254}),
        (_ANGLE, 0.0, {"%": 0.01}),
        (_ANGLE, 1.0, {"rad": 1.0, "deg": 0.0174532925199433}),
        (_STRESS, 0.0, {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9}),
        (_DENSITY, 0.0, {"kg/m^3": 1.0, "g/cm^3": 1e3}),
        (_PER_LENGTH, 0.0, {"N/m": 1.0, "N/mm": 1e3, "kN/mm": 1e6, "MN/m": 1e6, "N/um": 1e6}),
        (_PER_LENGTH, 0.0, {"kN/m": 1e3, "kN/um": 1e9, "GN/m": 1e9}),
        (_FORCE, 0.0, {"N": 1.0, "kN": 1e3}),
        (_FORCE, -1.0, {"N/rad": 1.0, "kN/rad": 1e3, "MN/rad": 1e6, "N/mrad": 1e3, "kN/mrad": 1e6}),
        (_dimension(mass=1), 0.0, {"kg": 1.0, "g": 1e-3}),
        (_INERTIA, 0.0, {"kg*m^2": 1.0, "kg m^2": 1.0}),
        (_MOMENT, 0.0, {"N*m": 1.0, "N m": 1.0, "kN*m": 1e3, "kN m": 1e3}),
        (_MOMENT, -1.0, {"N*m/rad": 1.0, "N m/rad": 1.0, "kN*m/rad": 1e3, "kN m/rad": 1e3}),
        (_MOMENT, -1.0, {"MN*m/rad": 1e6, "N*mm/rad": 1e-3, "N*m/mrad": 1e3}),
        (_RATE, 0.0, {"Hz": 1.0, "kHz": 1e3}),
        (_RATE, 1.0, {"rad/s": 1.0, "rpm": 0.10471975511966}),
        (_VISCOSITY, 0.0, {"m^2/s": 1.0, "mm^2/s": 1e-6, "cSt": 1e-6}),
        (_dimension(temperature=1), 0.0, {"K": 1.0}),
        (_TIME, 0.0, {"h": 3600.0, "min": 60.0, "s": 1.0}),
        (_dimension(mass=1, length=2, time=-3), 0.0, {"W": 1.0, "kW": 1e3, "MW": 1e6}),
    )
    for unit, factor in units.items()
}

#: revolutions a minute in other words of nameplates
TURNS = dict.fromkeys(("1/min", "min^-1", "min-1", "rev/min", "r/min", "U/min"), "rpm")

#: largest quantity and softest spring in SI, whose squares neither overflow nor vanish
LARGEST, SOFTEST = 1e24, 1e-30

#: relative difference of numbers that are typed with four digits
TYPED = 1e-3

#: most letters of a quantity
LONGEST = 200

_TEXT = re.compile(
    r"\s*(?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf)\b)"
    r"\s*(?P<unit>.*?)\s*",
    re.S | re.I,
)
_COMMA = re.compile(r"\s*[+-]?\d*,\d")
_UNIT = re.compile(r"[^\W\d_][^\W\d]*|%|\d|[\s*/^().·-]", re.U)


def quantity(value: Any, dimension: str) -> float:
    """Read a quantity in the SI unit of a dimension of `DIMENSIONS`, from a plain number in SI or a text
    with a unit, such as ``"90 mm"``.

    Raises
    ------
    SceneError
        Not a number, NaN, infinite or larger than `LARGEST`, no unit or an unknown one, or a unit
        of another dimension.

    Examples
    --------
    >>> quantity("208 mm", "length"), quantity(0.208, "length")
    (0.208, 0.208)
    >>> quantity("3 kHz", "length")
    Traceback (most recent call last):
    ...
    solidgear.core.errors.SceneError: "3 kHz": "kHz" is not a unit of length; write for example "90 mm"
    """
    si, example, _ = DIMENSIONS[dimension]
    if isinstance(value, str):
        number = _read_text(value, dimension)
    elif isinstance(value, numbers.Real) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
    else:
        raise SceneError(
            f'must be a number{f" in {si}" if si else ""} or a text such as "{example}"',
            value=show(value),
        )
    if not math.isfinite(number):
        raise SceneError(f'must be a finite number, for example "{example}"', value=show(value))
    if abs(number) > LARGEST:
        raise SceneError(
            f"is larger than {LARGEST:g}{f' {si}' if si else ''}, which is not physical; write "
            f'for example "{example}"',
            value=show(value),
        )
    return number


#: a place of a segment or of the shaft, which belongs to another key
_PLACE = re.compile(r"(?:[^.\d][^.]*\.)?(?:start|middle|end|mid_face)")


def _read_text(text: str, dimension: str) -> float:
    si, example, powers = DIMENSIONS[dimension]

    def wrong(reason: str) -> SceneError:
        return SceneError(reason, value=show(text))

    if len(text) > LONGEST:  # before any pattern looks at it: their time grows with the square
        raise wrong(
            f"an unknown unit, or no quantity at all: {len(text)} letters; "
            f'write for example "{example}"'
        )
    if _COMMA.match(text):
        raise wrong(f'has a comma: decimals take a point, and thousands no mark, as in "{example}"')
    match = _TEXT.fullmatch(text)
    if match is None and dimension == "length" and _PLACE.fullmatch(text):
        raise wrong(
            "names a place, where a number with a unit belongs: write position = "
            f'"0 mm" and from = {show(text)}'
        )
    if match is None:
        raise wrong(f'must be a number with a unit, such as "{example}"')
    number, unit = float(match["number"]), match["unit"]
    if not unit:
        if si:
            plain = "hours" if dimension == "time" else f"SI ({si})"
            raise wrong(
                f"has no unit: write a plain number (without quotes) for {plain}, "
                f'or add a unit as in "{example}"'
            )
        return number
    factors = si_factor(unit)
    if factors is None:
        raise wrong(f'unknown unit {show(unit)}; write for example "{example}"')
    factor, radians, dimensionality = factors
    si_factors = si_factor(si) if si else None
    wanted = si_factors[2] if si_factors else ()
    if dimensionality != wanted or radians not in powers:
        kind_name = dimension.replace("_", " ")
        kind = f"not a unit of {kind_name}" if si else "a unit, but this is a plain ratio"
        raise wrong(f'{show(unit)} is {kind}; write for example "{example}"')
    return _as_plain(number, factor, dimensionality)


def _as_plain(number: float, factor: float, dimensionality: Dimension) -> float:
    """Return a number in units of a factor as a plain one: in SI, and of a time in hours."""
    if dimensionality == _TIME:
        return number * (factor / HOUR) if factor >= HOUR else number / (HOUR / factor)
    return _in_si(number, factor)


def _in_si(number: float, factor: float) -> float:
    """Return a number in units of a factor in SI."""
    # dividing by 1000 is exact where multiplying by 0.001 is not: "208 mm" must be the same float
    # as 0.208
    if factor < 1 and (1 / factor).is_integer():
        return number / round(1 / factor)
    return number * factor


def with_unit_of(written: Any, value: Any) -> Any:
    """Return a number in SI as a text with the unit in which an entry is written; as it is where there
    is none, or where no text of that unit is the same number.

    Examples
    --------
    >>> with_unit_of("40 mm", 0.0415), with_unit_of(0.04, 0.0415), with_unit_of("40 mm", 1 / 3)
    ('41.5 mm', 0.0415, '333.3333333333333 mm')
    """
    match = _TEXT.fullmatch(written) if isinstance(written, str) else None
    factors = si_factor(match["unit"]) if match and match["unit"] else None
    if factors is None or match is None or isinstance(value, bool | str):
        return value
    size = factors[0] / HOUR if factors[2] == _TIME else factors[0]
    for digits in range(1, 18):
        text = f"{value / size:.{digits}g}"
        if _as_plain(number := float(text), factors[0], factors[2]) == value:
            plain = not number or 1e-4 <= abs(number) < 1e6
            text = repr(number).removesuffix(".0") if plain else re.sub(r"e\+?(-?)0*", r"e\1", text)
            return f"{text} {match['unit']}"
    return value


@functools.lru_cache(maxsize=256)
def si_factor(unit: str) -> tuple[float, float, Dimension] | None:
    """Return the SI units in one `unit`, the power of the radian in it, and its dimensions; None for
    a unit that pint does not know.
    """
    # m2 for m^2, m3 for m^3, as people write inertias and densities, and Nm for N*m (to pint the count of a yarn)
    unit = re.sub(r"(?<=m)([23])\b", r"^\1", unit)
    unit = re.sub(r"\b([mkM]?N)(?=[mc]?m\b)", r"\1*", unit)
    unit = TURNS.get(unit, unit)
    return COMMON[unit] if unit in COMMON else _by_pint(unit)


def _by_pint(unit: str) -> tuple[float, float, Dimension] | None:
    # pint evaluates exponents as it parses; a chain such as m**9**9**9 would never return
    if (
        len(unit) > 60
        or re.search(r"\d{3}|(\*\*|\^).*(\*\*|\^).*(\*\*|\^)", unit)
        or _UNIT.sub("", unit)
    ):
        return None
    registry = _registry()
    try:
        parsed = registry.parse_units(unit)
        root = registry.get_root_units(parsed)
        factor, radians = float(root[0]), float(dict(root[1]._units).get("radian", 0))
        mass = float(dict(root[1]._units).get("gram", 0))
        return (
            float(f"{factor * 1e-3**mass:.15g}"),
            radians,
            tuple(sorted((name, float(power)) for name, power in parsed.dimensionality.items())),
        )  # pint's root of mass is the gram
    except Exception:  # pint raises a dozen kinds, some its own, some of the tokenizer underneath
        return None


@functools.cache
def _registry():
    import pint

    return pint.UnitRegistry(on_redefinition="ignore")


# Field types of the scene's models: a quantity, and the range it must lie in.

#: positions are kept to a picometre, so that ends computed along different routes compare equal
POSITION_DECIMALS = 12


def _in(dimension: str) -> Measure:
    return Measure(dimension, quantity)


def _between(low: float, high: float, words: str) -> Range:
    return Range(f"must lie between {words}", least=low, most=high)


def _loss(value: float) -> float:
    if 1 < value <= 100:
        reason = (
            f"a loss factor lies between 0 and 1; {value:g} per cent is written {value / 100:g}"
        )
        raise SceneError(reason)
    return value


def three(dimension: str, example: str) -> Three:
    """Return a mark of three quantities of one dimension."""
    return Three(dimension, example, quantity)


_POSITIVE = Range("must be greater than zero", above=0)
_NOT_NEGATIVE = Range("must not be negative", least=0)


def quantity_type(dimension: str) -> Any:
    """Return the type of a number in the SI unit of a dimension."""
    return Annotated[float, _in(dimension)]


#: six rows of a 6x6, plain numbers in SI
Rows = Annotated[
    list[Annotated[list[float], Field(min_length=6, max_length=6)]],
    Field(min_length=6, max_length=6),
]
Length = Annotated[float, _in("length")]
Position = Annotated[
    float, _in("length"), AfterValidator(lambda v: round(v, POSITION_DECIMALS) + 0.0)
]
PositiveLength = Annotated[Length, _POSITIVE]
Diameter = Annotated[PositiveLength, Range("is above 20 m: probably wrong units", most=20)]
Thickness = Annotated[Length, _NOT_NEGATIVE]
Angle = Annotated[
    float,
    _in("angle"),
    Range("must lie between 0 and 90 degrees (0 and 1.571 rad)", above=0, below=math.pi / 2),
]
Modulus = Annotated[
    float,
    _in("pressure"),
    _POSITIVE,
    Range("is below 1 Pa, softer than any solid: probably wrong units", least=1),
]
Stress = Annotated[
    Modulus, Range("is below 1 MPa, weak for a metal: probably wrong units", least=1e6)
]
Density = Annotated[
    float,
    _in("density"),
    _POSITIVE,
    Range("is below 1e-6 kg/m^3, lighter than any solid: probably wrong units", least=1e-6),
    Range(
        "is above 1e8 kg/m^3, denser than any solid (osmium has 22600): probably wrong units",
        most=1e8,
    ),
]
Poisson = Annotated[
    float,
    _in("dimensionless"),
    Range("must lie between -1 and 0.5, both excluded; steel is 0.3", above=-1, below=0.5),
]
AxialSpring = Annotated[
    float,
    _in("force_per_length"),
    _POSITIVE,
    Range(f"is softer than {SOFTEST:g} N/m, too soft for a spring: leave it out", least=SOFTEST),
]
Newtons = Annotated[float, _in("load")]
PositiveLoad = Annotated[Newtons, _POSITIVE]
NotNegativeLoad = Annotated[Newtons, _NOT_NEGATIVE]
Torque = Annotated[float, _in("torque")]
Power = Annotated[float, _in("power")]
SignedAngle = Annotated[float, _in("angle")]
Speed = Annotated[float, _in("speed"), _NOT_NEGATIVE]
TemperatureRise = Annotated[float, _in("temperature")]
Viscosity = Annotated[
    float,
    _in("viscosity"),
    _POSITIVE,
    Range(
        "is outside 1 to 10000 mm^2/s, the viscosities of oils at work: probably wrong units",
        least=1e-7,
        most=1e-1,
    ),
]
PositiveSpeed = Annotated[Speed, _POSITIVE]
Reliability = Annotated[
    float, _in("dimensionless"), _between(0.9, 0.9995, "0.90 and 0.9995, the range of ISO 281")
]
RatingFactor = Annotated[
    float,
    _in("dimensionless"),
    Range("is b_m of ISO 281, 1.0 to 1.3: must lie between 0.5 and 2", least=0.5, most=2),
]
Ratio = Annotated[float, _in("dimensionless")]
Share = Annotated[float, _in("dimensionless"), _between(0, 1, "0 and 1")]
#: of the time of a duty table
TimeShare = Annotated[
    float, _in("dimensionless"), _POSITIVE, Range("a share is 1, or 100 %, at most", most=1)
]
#: h
Hours = Annotated[float, _in("time"), _POSITIVE]
Frequency = Annotated[float, _in("frequency"), _POSITIVE]
Mass = Annotated[float, _in("mass"), _POSITIVE]
Factor = Annotated[float, _in("dimensionless"), _POSITIVE]
Tolerance = Annotated[
    float,
    _in("dimensionless"),
    Range("must lie between 0 and 1; 0.05 is five per cent", above=0, below=1),
]

# Quantities of a train.
Product = Annotated[float, _in("inertia")]
Inertia = Annotated[float, _in("inertia"), _POSITIVE]
TorsionSpring = Annotated[float, _in("moment"), _POSITIVE]
MeshSpring = Annotated[float, _in("force_per_length"), _POSITIVE]
Loss = Annotated[
    float,
    _in("dimensionless"),
    AfterValidator(_loss),
    _between(0, 1, "0 and 1, as a loss factor does"),
]
SpiralAngle = Annotated[float, _in("angle"), _between(0.0, 1.4, "0 and 80 degrees (0 and 1.4 rad)")]
PitchAngle = Annotated[
    float, _in("angle"), _between(0.0, 1.56, "0 (cylindrical gears) and 89 degrees (1.56 rad)")
]
PressureAngle = Annotated[
    float, _in("angle"), _between(0.05, 0.8, "3 and 45 degrees (0.05 and 0.8 rad)")
]
ShaftAngle = Annotated[
    float,
    _in("angle"),
    _between(0.0, math.radians(175), "0 (parallel shafts) and 175 degrees"),
]
