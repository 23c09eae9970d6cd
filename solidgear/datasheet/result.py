"""A data sheet: facts of a shaft or a train, and the ways to show them."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from datetime import date
from pathlib import Path
from typing import Any, ClassVar

from solidgear.core import Sheeted
from solidgear.core.machine.version import VERSION
from solidgear.core.plain import plain
from solidgear.datasheet.facts import (
    BearingFact,
    DrawnShaft,
    Figure,
    Frequency,
    MotionFact,
    Remark,
    Resonance,
    Trust,
    WorstNotch,
    WorstSection,
)


@dataclass(frozen=True, eq=False, repr=False)
class Datasheet(Sheeted):
    """One page of a shaft or a train."""

    sheeted: ClassVar[str] = "datasheet.sections:sheet_of"

    title: str
    file: str
    train: bool
    trust: Trust
    drawn: tuple[DrawnShaft, ...] = ()
    figures: tuple[Figure, ...] = ()  #: the numbers asked for
    notch: WorstNotch | None = None
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

    def in_language(self, language: str) -> Datasheet:
        """Return the same sheet in another language."""
        return replace(self, language=language)

    def to_html(self, units: str = "engineering") -> str:
        """Return the page as HTML that needs no network and no other file.

        Parameters
        ----------
        units : {'engineering', 'si', 'us'}

        Returns
        -------
        str
        """
        from solidgear.datasheet.page import html_of  # start-up: for pages alone

        return html_of(self, units)

    def save(self, path: str | os.PathLike, units: str = "engineering") -> list[Path]:
        """Write the page as HTML, or as PDF by a browser.

        Parameters
        ----------
        path : str or path
            A file that ends in ``.html`` or ``.pdf``.
        units : {'engineering', 'si', 'us'}

        Returns
        -------
        list of pathlib.Path
            The files that were written: without a browser an HTML page in place of the PDF.

        Raises
        ------
        SolidgearError
            For another ending, and a file that cannot be written.
        """
        from solidgear.datasheet.page import save  # start-up: for pages alone

        return save(self, path, units)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        data = plain(self)
        return data | {"day": self.day.isoformat()}
