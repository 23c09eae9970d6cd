"""Modes that are two motions in nearly equal parts, whose names are a toss-up.

A flat or a keyway on one side couples torsion with bending across it. Where the frequencies of both
lie close together, each mode is a mixture, and another mesh or model may call either of them by
either name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from solidgear.core.solve.families import FAMILIES
from solidgear.core.solve.naming import Shares

if TYPE_CHECKING:
    from solidgear.core.solve.modes import Mode, ModeSet

#: share of the modal mass of its own family up to which another mesh may give a mode another name: beside a
#: flat on one side the share of torsion went from 0.51 to 0.58 from mesh to mesh
TOSS_UP = 0.65
#: relative distance of frequencies within which two modes mix
CLOSE = 0.15


class Mixture(NamedTuple):
    """A mode that is a mixture of two motions, with the mode that is one of the same two if it is near."""

    name: str  #: of the mode
    partner: str  #: name of the second mode; empty where none is near
    share: float  #: of the modal mass that moves as its family does
    gap: float  #: relative difference of the frequency of the partner
    second: str  #: family of the second motion
    rest: float  #: share of the modal mass that moves so

    @property
    def sentence(self) -> str:
        """Sentence for a reader."""
        if not self.partner:
            return (
                f"{self.name} is {100 * self.rest:.0f} % {self.second}: its name is that of the "
                f"larger part, {100 * self.share:.0f} %"
            )
        return (
            f"{self.name} and {self.partner} ({100 * self.gap:+.2g} % apart) are mixtures of the "
            f"same two motions, the first {100 * self.share:.0f} % as named: another mesh or "
            "model may swap the names, and error bars hold for the mode, whatever its name"
        )


def mixtures(mode_set: ModeSet) -> tuple[Mixture, ...]:
    """Return modes with a name that is a toss-up, with the mode that shares the motion where one is
    near: each pair once, in ascending order of frequency.
    """
    out: list[Mixture] = []
    elastic = [m for m in mode_set.modes if m.frequency_hz > 0 and m.family in FAMILIES]
    by_mode = {mode.name: _shares(mode_set, mode) for mode in elastic}
    for mode in elastic:
        family_shares = by_mode[mode.name]
        second = max((f for f in family_shares if f != mode.family), key=family_shares.__getitem__)
        if not family_shares[mode.family] < TOSS_UP or not family_shares[second] > 1 - TOSS_UP:
            continue
        partners = [m for m in elastic if m.family == second and by_mode[m.name][second] < TOSS_UP]
        gaps = [(m.frequency_hz / mode.frequency_hz - 1, m.name) for m in partners]
        near = [pair for pair in gaps if abs(pair[0]) < CLOSE]
        gap, partner = min(near, key=lambda pair: abs(pair[0]), default=(0.0, ""))
        if not any({mode.name, partner} == {o.name, o.partner} for o in out):
            shares = family_shares[mode.family], family_shares[second]
            out.append(Mixture(mode.name, partner, shares[0], gap, second, shares[1]))
    return tuple(out)


def _shares(mode_set: ModeSet, mode: Mode) -> dict[str, float]:
    """Return the share of the section motions of a mode that moves as each family does."""
    energy = Shares(mode_set.gram).by_family(mode.motions[0])
    total = sum(energy.values())
    return {family: value / total for family, value in energy.items()}
