"""Names of modes: family, plane of bending and number, whatever model computed them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from solidgear.core.quantity import Name

BENDING = "bending"
_FORM = re.compile(
    r"(?P<rigid>rigid )?(?P<family>.*?)(?: (?P<plane>[xz]))?(?: (?P<number>\d+))?", re.DOTALL
)


class ModeName(Name):
    """Name of a mode.

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
        match = _FORM.fullmatch(text)
        assert match is not None  # any text is a family at least
        self.rigid = match["rigid"] is not None
        self.family, self.plane = match["family"], match["plane"] or ""
        self.number = int(match["number"]) if match["number"] else None
        return self


def numbered(labels: Iterable[str]) -> list[ModeName]:
    """Return names of modes from their families, and planes, in the same order.

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
    """Return the place of the mode that a name means among modes in ascending order of frequency;
    None where there is none.

    ``bending 2`` is the second mode of bending in ascending order, whether or not a mirror plane
    gives bending the names of its planes: turning a keyway by a degree out of that plane must not
    make it another mode.

    Examples
    --------
    >>> names = ["bending x 1", "bending z 1", "axial 1", "bending x 2"]
    >>> [meant(name, names) for name in ("bending 1", "bending 2", "bending z 1", "torsion 1")]
    [0, 1, 1, None]
    """
    wanted, modes = ModeName(name), [ModeName(text) for text in names]
    in_order = wanted.family == BENDING and wanted.number is not None and not wanted.plane
    if not in_order or not any(mode.plane for mode in modes):
        return names.index(name) if name in names else None
    # where bearings couple both planes for some modes only, these have the names of no plane
    bending = [k for k, m in enumerate(modes) if m.family == BENDING and m.number is not None]
    return bending[wanted.number - 1] if wanted.number and wanted.number <= len(bending) else None
