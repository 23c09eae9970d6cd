"""Templates of pages, their contents, and pictures inside them."""

from __future__ import annotations

import base64
import functools
import logging
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

log = logging.getLogger(__name__)


@dataclass
class Contents:
    """Sections of a page, numbered as its template tells them."""

    number: str = "{}."  #: of a section, with braces for its figure
    #: anchor and heading of every section
    told: list[tuple[str, str]] = field(default_factory=list)

    def add(self, anchor: str, title: str) -> str:
        """Return the heading of a further section."""
        heading = f"{self.number.format(len(self.told) + 1)} {title}"
        self.told.append((anchor, heading))
        return heading


@functools.cache
def template(name: str, folder: Path | None = None):
    """Return the template of a page, in a folder of its study or here."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    here = Path(__file__).parent
    loader = FileSystemLoader([folder or here, here])
    return Environment(
        loader=loader,
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    ).get_template(name)


def data_uri(key: str, path: Path) -> str | None:
    """Return a picture in a file as a data URI; None if it cannot be read."""
    try:
        data = path.read_bytes()
    except OSError as error:
        log.warning("render of %s: %s", key, error)
        return None
    if not data.startswith(b"\x89PNG"):
        return None
    return f"data:image/png;base64,{base64.b64encode(data).decode()}"


def figures(files: Mapping[str, Path], what: str) -> str:
    """Return pictures of deformed bodies as HTML, by their captions; `what` begins the text for
    those who do not see them.
    """
    picture = template("parts.html").module.picture
    drawn = "".join(picture(name, data_uri(name, path), what) for name, path in files.items())
    return f'<div class="renders">\n{drawn}</div>' if drawn else ""
