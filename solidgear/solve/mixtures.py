"""Modes that are two motions in nearly equal parts, whose names are a toss-up.

A flat or a keyway on one side couples torsion with bending across it. Where the frequencies of both lie
close together, each mode is a mixture, and another mesh or model may call either of them by either name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from solidgear.solve.families import FAMILIES
from solidgear.solve.naming import shares

if TYPE_CHECKING:
    from solidgear.solve.modes import Mode, ModeSet

#: share of the modal mass of its own family up to which another mesh may give a mode another name: beside a
#: flat on one side the share of torsion went from 0.51 to 0.58 from mesh to mesh
TOSS_UP = 0.65
#: relative distance of frequencies within which two modes mix
CLOSE = 0.15


class Mixture(NamedTuple):
    """Two modes that are mixtures of the same two motions."""

    #: name, other: of the modes
    name: str
    other: str
    share: float  #: of the modal mass of the first that moves as its family does
    apart: float  #: frequency of the other over that of the first, less one

    @property
    def sentence(self) -> str:
        """Sentence for a reader."""
        return (
            f"{self.name} and {self.other} ({100 * self.apart:+.2g} %) are mixtures of the same two "
            f"motions, the first {100 * self.share:.0f} % what its name says: another mesh or model may "
            "call them the other way round, and a bar holds the mode, whatever its name"
        )


def mixtures(found: ModeSet) -> tuple[Mixture, ...]:
    """Modes with a name that is a toss-up, and the one that each shares its motion with: each pair
    once, in ascending order of frequency.
    """
    out: list[Mixture] = []
    elastic = [m for m in found.modes if m.frequency_hz > 0 and m.family in FAMILIES]
    of = {mode.name: _shares(found, mode) for mode in elastic}
    for mode in elastic:
        own = of[mode.name]
        second = max((f for f in own if f != mode.family), key=own.__getitem__)
        if not own[mode.family] < TOSS_UP or not own[second] > 1 - TOSS_UP:
            continue
        partners = [m for m in elastic if m.family == second and of[m.name][second] < TOSS_UP]
        apart = [(m.frequency_hz / mode.frequency_hz - 1, m.name) for m in partners]
        for gap, other in sorted(apart, key=lambda one: abs(one[0]))[:1]:
            if abs(gap) < CLOSE and not any({mode.name, other} == {o.name, o.other} for o in out):
                out.append(Mixture(mode.name, other, own[mode.family], gap))
    return tuple(out)


def _shares(found: ModeSet, mode: Mode) -> dict[str, float]:
    """Share of the section motions of a mode that moves as each family does."""
    energy = shares(mode.motions[0], found.gram)
    total = sum(energy.values())
    return {family: value / total for family, value in energy.items()}
