"""Names by which a mode is asked for, whatever its model calls it."""

from __future__ import annotations

import re
from collections.abc import Sequence

#: names of modes of bending: in order, and by the plane of a part that has a mirror plane
IN_ORDER, BY_PLANE = re.compile(r"bending (\d+)"), re.compile(r"bending [zx] \d+")


def meant(name: str, names: Sequence[str]) -> int | None:
    """Place of the mode that a name means.

    Parameters
    ----------
    name : str
        ``bending 2`` is the second mode of bending in ascending order, whether or not a mirror plane
        gives bending the names of its planes: turning a keyway by a degree out of that plane must
        not make it another mode.
    names : sequence of str
        Of modes in ascending order of frequency.

    Returns
    -------
    int or None

    Examples
    --------
    >>> names = ["bending x 1", "bending z 1", "axial 1", "bending x 2"]
    >>> [meant(name, names) for name in ("bending 1", "bending 2", "bending z 1", "torsion 1")]
    [0, 1, 1, None]
    """
    asked = IN_ORDER.fullmatch(name)
    if asked is None or not any(map(BY_PLANE.fullmatch, names)):
        return names.index(name) if name in names else None
    # where bearings couple both planes for some modes only, these have the names of no plane
    own = [k for k, one in enumerate(names) if BY_PLANE.fullmatch(one) or IN_ORDER.fullmatch(one)]
    return own[int(asked[1]) - 1] if 1 <= int(asked[1]) <= len(own) else None
