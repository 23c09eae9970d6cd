"""A table on its way to the page."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass
class Table:
    """A table as the template takes it: cells are texts or (text, css class); the first of a row is
    its header.
    """

    caption: str
    head: list[str]
    rows: list[list[Any]] = field(default_factory=list)
    note: str = ""
    css: str = ""

    def __post_init__(self):
        self.head = [h.replace("N m", "N\u00a0m") for h in self.head]  # a unit is one word

    @property
    def columns(self) -> list[tuple[str, str]]:
        """(head, css class): a head stands over its column, texts to the left and numbers to the
        right.
        """
        first = self.rows[0] if self.rows else []
        return [
            (
                h,
                "text"
                if k < len(first) and isinstance(first[k], tuple) and "text" in first[k][1]
                else "",
            )
            for k, h in enumerate(self.head)
        ]

    def __bool__(self) -> bool:
        return bool(self.rows)
