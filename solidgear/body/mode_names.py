"""Names of modes: family, plane of bending and number, whatever model has found them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from solidgear.quantity import Name

BENDING = "bending"
_FORM = re.compile(
    r"(?P<rigid>rigid )?(?P<family>.*?)(?: (?P<plane>[xz]))?(?: (?P<number>\d+))?", re.DOTALL
)


class ModeName(Name):
    """Name of a mode.

    Parameters
    ----------
    text : str

    Examples
    --------
    >>> name = ModeName("bending x 2")
    >>> name.family, name.plane, name.number, name == "bending x 2"
    ('bending', 'x', 2, True)
    >>> ModeName("ovalising n=2 1").family, ModeName("rigid torsion").rigid
    ('ovalising n=2', True)
    """

    family: str  #: ``bending``, ``axial``, ``ovalising n=2``, ..
    plane: str  #: ``z`` or ``x`` of bending in a part with a mirror plane, else empty
    number: int | None  #: in ascending order of frequency, from one; None of rigid motions
    rigid: bool

    def __new__(cls, text: str) -> ModeName:
        if isinstance(text, ModeName):
            return text
        self = super().__new__(cls, text)
        found = _FORM.fullmatch(text)
        assert found is not None  # any text is a family at least
        self.rigid = found["rigid"] is not None
        self.family, self.plane = found["family"], found["plane"] or ""
        self.number = int(found["number"]) if found["number"] else None
        return self


def numbered(labels: Iterable[str]) -> list[ModeName]:
    """Names of modes from their families, and planes, in the order given.

    Parameters
    ----------
    labels : iterable of str

    Examples
    --------
    >>> numbered(["bending", "axial", "bending"])
    ['bending 1', 'axial 1', 'bending 2']
    """
    count: dict[str, int] = {}
    out = []
    for label in labels:
        count[label] = count.get(label, 0) + 1
        out.append(ModeName(f"{label} {count[label]}"))
    return out


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

    Examples
    --------
    >>> names = ["bending x 1", "bending z 1", "axial 1", "bending x 2"]
    >>> [meant(name, names) for name in ("bending 1", "bending 2", "bending z 1", "torsion 1")]
    [0, 1, 1, None]
    """
    asked, every = ModeName(name), [ModeName(one) for one in names]
    in_order = asked.family == BENDING and asked.number is not None and not asked.plane
    if not in_order or not any(one.plane for one in every):
        return names.index(name) if name in names else None
    # where bearings couple both planes for some modes only, these have the names of no plane
    own = [k for k, one in enumerate(every) if one.family == BENDING and one.number is not None]
    return own[asked.number - 1] if asked.number and asked.number <= len(own) else None
