"""The table ``body`` of a scene file, which names a part."""

from __future__ import annotations

from pathlib import Path

from solidgear.core import SceneError
from solidgear.parts.body_file import BodyFile, BodyTable, check_tables, written
from solidgear.parts.recognised import Recognised, with_seats


def refuse_parts(table: BodyTable, folder: Path) -> Recognised:
    """Refuse a part from a file, where no reader is given."""
    raise SceneError(
        "a part from a file is read by solidgear.load only; in trains and bearing studies write "
        "segments",
        path=("body", table.key),
    )


class Parts:
    """The table ``body`` as the reader of scene files asks for it."""

    Table = BodyTable
    Body = BodyFile
    check_tables = staticmethod(check_tables)
    with_seats = staticmethod(with_seats)
    refuse_parts = staticmethod(refuse_parts)

    written = staticmethod(written)

    @staticmethod
    def recognise(table: BodyTable, folder: Path) -> Recognised:
        """Read the part that a table names."""
        from solidgear.parts.part import recognise  # start-up: not every file needs it

        return recognise(table, folder)
