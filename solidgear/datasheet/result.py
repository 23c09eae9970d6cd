"""A data sheet: facts of a shaft or a train, and the ways to show them."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

from solidgear.core import Sheeted
from solidgear.datasheet.facts import Facts


@dataclass(frozen=True, eq=False, repr=False)
class Datasheet(Facts, Sheeted):
    """One page of a shaft or a train; its facts are attributes."""

    sheeted: ClassVar[str] = "datasheet.sections:sheet_of"

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

    def write(self, folder: str | os.PathLike, units: str = "engineering") -> list[Path]:
        """Write the page as ``sheet.html`` into a folder.

        Parameters
        ----------
        folder : path
        units : {'engineering', 'si', 'us'}

        Returns
        -------
        list of pathlib.Path
            The file.

        Raises
        ------
        SolidgearError
            If it cannot be written, or units are unknown.
        """
        return self.save(Path(folder) / "sheet.html", units)

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
