"""Room for matrices while they are assembled, in memory and in the numbers of their entries."""

from __future__ import annotations

import numpy as np

from solidgear.core.machine.memory import NoRoom, require

MB = 2.0**20
#: bytes of an entry of the element matrices while its place is sought, and of one of
#: the assembled matrix while it is put together
SOUGHT, PUT = 25.0, 20.0
#: entries that 32-bit indices can number, less some for what is numbered beside them
MOST_ENTRIES = 2_000_000_000


def assemblable(elements: float, columns: int, rows: int | None = None) -> None:
    """Refuse (:class:`NoRoom`) meshes whose matrices cannot be assembled, by the columns and rows of
    an element matrix of one component, by default as many; called before a mesh with a bound of its
    elements, and after it with their number.
    """
    entries = elements * columns * (columns if rows is None else rows)
    number = f"{elements:.0f}" if elements < 1e6 else f"{elements:.2g}"
    matrices = f"matrices of {number} elements"
    if entries > MOST_ENTRIES:
        raise NoRoom(
            f"{matrices} have {entries:.2g} matrix entries, more than the {MOST_ENTRIES:.0e} that can "
            "be numbered",
            np.inf,
            np.inf,
        )
    require(SOUGHT * entries / MB, matrices)


def assembled(entries: int, unknowns: int) -> None:
    """Refuse (:class:`NoRoom`) a matrix whose entries will not fit into memory."""
    require(PUT * entries / MB, f"matrices of {unknowns} unknowns")
