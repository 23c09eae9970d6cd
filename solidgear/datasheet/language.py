"""Words and numbers of a data sheet in a language."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from datetime import date
from typing import Any

from solidgear.core import LADDER, Quantity, SolidgearError, show
from solidgear.datasheet.facts import Amount, ModeTerm, Place, Remark, Speed, Term
from solidgear.datasheet.messages import LANGUAGES, MESSAGES
from solidgear.show.open_words import between
from solidgear.show.units import Units, digits_for, plain
from solidgear.show.words import DASH, bar_percent, is_number

#: figures of a number with an error bar
FEWEST_DIGITS, MOST_DIGITS = 4, 5
#: decimals of a place in a sentence, m
PLACE = 5
#: families of motion in names of modes
_FAMILIES = ("bending", "axial", "torsion", "ovalising", "rotational", "along", "about")
_MODE = re.compile(
    rf"(?P<part>.*?) ?\b(?P<family>{'|'.join(_FAMILIES)})(?P<rest>(?: [xyz])?(?: n=\d+)?(?: \d+)?)"
)
#: names of whole modes, and their keys
_WHOLE = {"train rotation": "mode train rotation", "free motion": "mode free motion"}


@dataclass(frozen=True)
class Language:
    """A language of data sheets, and the units that they are read in."""

    code: str
    units: Units

    def __post_init__(self) -> None:
        if self.code not in LANGUAGES:
            raise SolidgearError(
                f"`language` {show(self.code, 40)}: there are {' and '.join(LANGUAGES)}"
            )

    def say(self, key: str, **values: Any) -> str:
        """Return a message with values in their places."""
        texts = {name: self._text_of(value) for name, value in values.items()}
        return MESSAGES[key][LANGUAGES.index(self.code)].format(**texts)

    def sentence(self, remark: Remark) -> str:
        """Return a remark as a sentence."""
        return self.say(remark.key, **remark.values)

    def has(self, key: str) -> bool:
        """Return whether there is a message of a key."""
        return key in MESSAGES

    def _text_of(self, value: Any) -> str:
        if isinstance(value, Amount):
            if value.digits is None:
                return f"{self.as_written(value.value, value.unit)} {self.units.unit(value.unit)}"
            return self.text(value.value, value.unit, value.digits)
        if isinstance(value, Place):
            return self.place(value.y)
        if isinstance(value, Speed):
            return self.speed(value.value)
        if isinstance(value, Term):
            return self.say(value.key)
        if isinstance(value, ModeTerm):
            return self.mode(value.name)
        if isinstance(value, Remark):
            return self.sentence(value)
        return str(value)

    def place(self, y: float) -> str:
        """Return a place along a shaft, m, with its unit."""
        return f"{self.length(round(y, PLACE))} {self.units.unit('m')}"

    def local(self, number: str) -> str:
        """Return a number with the decimal mark of the language."""
        return re.sub(r"(?<=\d)\.(?=\d)", self.say("decimal mark"), number)

    def number(self, value: float | None, si: str = "1", digits: int = 4) -> str:
        """Return a value of SI in the units of the sheet, without their name."""
        return self.local(self.units.number(value, si, digits))

    def text(self, value: float | None, si: str, digits: int = 4) -> str:
        """Return a value of SI in the units of the sheet, with their name."""
        return self.local(self.units.text(value, si, digits))

    def as_written(self, value: float, si: str) -> str:
        """Return a number of the file without zeros behind it, and without a unit."""
        return self.local(self.units.given(value, si))

    def length(self, value: float) -> str:
        """Return a length of the file without zeros behind it, and without a unit."""
        return self.as_written(round(value, 9), "m")

    def speed(self, value: float, digits: int = 5) -> str:
        """Return a speed, rad/s, in turns a minute."""
        turns = plain(abs(value) * 30 / math.pi, digits)
        return f"{self.local(turns.rstrip('0').rstrip('.') if '.' in turns else turns)} /min"

    def with_bar(self, value: float, si: str, bar: float | None) -> str:
        """Return a value with figures that suit the relative error bar."""
        return self.text(value, si, digits_for(bar, FEWEST_DIGITS, MOST_DIGITS))

    def measured(self, value: float, si: str, bar: float | None) -> tuple[str, str]:
        """Return a value and its relative error bar; of a value inside its bar, which is as good as
        zero, the bar about zero in the unit.
        """
        if bar is None or bar <= 1:
            return self.with_bar(value, si, bar), self.bar(bar)
        zero = self.text(0.0, si)
        return zero, f"± {self.text(abs(value) * (1 + bar), si, FEWEST_DIGITS)}"

    def bar(self, share: float | None) -> str:
        """Return a relative error bar in per cent."""
        return DASH if share is None else self.local(f"± {bar_percent(share)}")

    def percent(self, share: float | None) -> str:
        """Return a share in per cent, to two figures or more."""
        return DASH if not is_number(share) else self.local(f"{100 * share:.2g} %")

    def interval(self, open_: tuple[float, float] | None) -> str:
        """Return a range relative to a number in per cent."""
        if open_ is None:
            return DASH
        return self.local(between(open_[0], open_[1]))

    def between(self, ends: tuple[float, float] | None, si: str, digits: int = 3) -> str:
        """Return the ends of a range, without the name of their unit."""
        if ends is None:
            return DASH
        low, high = (self.number(end, si, digits) for end in ends)
        return low if low == high else self.say("range", low=low, high=high)

    def listed(self, names: Any) -> str:
        """Return names as a list in a sentence."""
        names = [self._text_of(name) for name in names]
        last = self.say("and")
        return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}"

    def date(self, day: date) -> str:
        """Return a date."""
        return day.strftime(self.say("date"))

    def model(self, name: str) -> str:
        """Return the name of a model; those of several shafts joined by plus."""
        models = [part.strip() for part in name.split("+")]
        return " + ".join(self._model(model) for model in models)

    def _model(self, name: str) -> str:
        if self.has(f"model {name}"):
            return self.say(f"model {name}")
        return LADDER[name].title if name in LADDER else name

    def quantity(self, name: str) -> str:
        """Return a quantity in words, with its points and symbol."""
        quantity = Quantity(name)
        if quantity.is_frequency:
            return self.mode(name)
        key = f"quantity {quantity.symbol}"
        words = self.say(key) if self.has(key) else ""
        places = (
            self.say("at places", places=" – ".join(quantity.points)) if quantity.points else ""
        )
        return ", ".join(filter(None, (words, places, quantity.symbol)))

    def measure(self, name: str) -> str:
        """Return a measure of misalignment in words, with the mesh that its name ends with."""
        keys = [key for key in MESSAGES if key.startswith("measure ")]
        for key in sorted(keys, key=len, reverse=True):
            symbol = key.removeprefix("measure ")
            if name == symbol or name.startswith(f"{symbol} "):
                return f"{self.say(key)}{self.mesh(name.removeprefix(symbol))}"
        return name

    def mesh(self, label: str) -> str:
        """Return what a name of a mesh ends with, as the end of a name."""
        return f" ({label.strip()})" if label.strip() else ""

    def mode(self, name: str) -> str:
        """Return the name of a mode, of a shaft or of a train."""
        key = _WHOLE.get(name)
        if key is not None:
            return self.say(key)
        return " + ".join(self._motion(part) for part in name.split(" + "))

    def _motion(self, name: str) -> str:
        match = _MODE.fullmatch(name)
        if match is None:
            return name
        part, family, number = match["part"], match["family"], match["rest"]
        motion = f"{self.say(f'family {family}')}{number}"
        return f"{part} {motion}" if part else motion
