"""Names of files that hold names of shafts, of which a folder takes every one, on Windows as well."""

from __future__ import annotations

import re
from collections.abc import Iterable

#: what no name of a file holds on one system or another
REFUSED = re.compile(r'[<>:"/\\|?*\x00-\x1f]')


def file_stems(names: Iterable[str]) -> dict[str, str]:
    """Return a stem for each name, different in other ways than in upper and lower case.

    Examples
    --------
    >>> file_stems(["deflection_A", "deflection_a", "turn_1/2"])
    {'deflection_A': 'deflection_A', 'deflection_a': 'deflection_a_2', 'turn_1/2': 'turn_1_2'}
    """
    stems: dict[str, str] = {}
    taken: set[str] = set()
    for name in dict.fromkeys(names):
        stem = plain = REFUSED.sub("_", name).rstrip(". ")
        count = 1
        while stem.casefold() in taken:
            count += 1
            stem = f"{plain}_{count}"
        taken.add(stem.casefold())
        stems[name] = stem
    return stems
