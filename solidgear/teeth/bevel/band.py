"""What a bevel pair's contact may be where no cutter and no mismatch are known.

A blank's data leave both open.  How far the flanks stand apart at the ends of the teeth, the ease-off, is
chosen for how far the shafts give way; cutters of 0.8 to 1.3 times the mean cone distance and ease-offs
of 50 to 300 micrometres are common.  The band is all of them, under one torque.  Contact spreads with
the load over the ease-off, as a Hertz contact does, so that the ease-off counts and the cutter, at one
ease-off, hardly.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from solidgear.core.errors import SceneError
from solidgear.teeth.bevel.flank import BevelFlanks, lengthwise
from solidgear.teeth.bevel.pair import BevelPair
from solidgear.teeth.contact.cells import Carrying
from solidgear.teeth.contact.cycle import MeshCycle, mesh_cycle

#: cutter radii over the mean cone distance, and ease-offs, m
CUTTERS, EASE_OFFS = (0.8, 1.0, 1.3), (50e-6, 100e-6, 300e-6)
#: positions of a mesh cycle
POSITIONS = 16


@dataclass(frozen=True, eq=False)
class Setting:
    """A cutter and a mismatch that a pair may have, and its contact with them."""

    cutter_radius: float  #: m
    ease_off: float  #: largest gap between the flanks, m
    cycle: MeshCycle


@dataclass(frozen=True, eq=False)
class SettingBand:
    """Contact over all settings that the data leave open."""

    settings: tuple[Setting, ...]
    refused: tuple[str, ...]  #: cutters that make no flank, a sentence each

    def ends(self, value: Callable[[MeshCycle], float]) -> tuple[float, float]:
        """Return the least and the largest value of a cycle."""
        values = [value(setting.cycle) for setting in self.settings]
        return min(values), max(values)

    @property
    def stiffness(self) -> tuple[float, float]:
        """Least and largest tangent stiffness of the teeth, mean over the cycle, N/m."""
        return self.ends(lambda cycle: float(cycle.tangent.mean()))

    @property
    def error(self) -> tuple[float, float]:
        """Least and largest peak-to-peak transmission error, m."""
        return self.ends(lambda cycle: cycle.peak_to_peak)

    @property
    def sentence(self) -> str:
        """What the band says."""
        least, most = self.stiffness
        return (
            f"Cutter and mismatch are estimated: over those that are usual the mesh stiffness is "
            f"{least:.2g} to {most:.2g} N/m, a factor of {most / least:.1f}."
        )


def setting_band(
    pair: BevelPair,
    torque: float,
    supports: Carrying | None = None,
    *,
    cutters: Sequence[float] | None = None,
    ease_offs: Sequence[float] = EASE_OFFS,
    positions: int = POSITIONS,
) -> SettingBand:
    """Compute the contact of a pair over the settings that its data leave open.

    Parameters
    ----------
    pair : BevelPair
        Teeth give way as those of this pair, whatever the cutter.
    torque : float
        On the pinion, N m.
    supports : Carrying, optional
        What carries both wheels.
    cutters : sequence of float, optional
        Over the mean cone distance; by default 0.8 to 1.3 where the cutter is estimated, else that
        of the blank.
    ease_offs : sequence of float
        m.
    positions : int
        Of the mesh cycle.
    """
    blank = pair.flanks.blank
    ratio = blank.cutter_radius / blank.mean_distance
    if cutters is None:
        cutters = CUTTERS if "cutter_radius" in blank.estimated else (ratio,)
    settings: list[Setting] = []
    refused: list[str] = []
    for cutter in cutters:
        try:
            changed = replace(blank, cutter_radius=cutter * blank.mean_distance)
            BevelFlanks(changed).refuse_undercut()
        except SceneError as error:
            refused.append(error.reason)
            continue
        flanks = (BevelFlanks(changed, lengthwise(changed, ease_off)) for ease_off in ease_offs)
        settings += _settings(pair, flanks, torque, supports, positions)
    return SettingBand(tuple(settings), tuple(refused))


def _settings(
    pair: BevelPair,
    all_flanks: Iterator[BevelFlanks],
    torque: float,
    supports: Carrying | None,
    positions: int,
) -> Iterator[Setting]:
    """Yield the contact with flanks."""
    for flanks in all_flanks:
        changed = replace(pair, flanks=flanks)
        cycle = mesh_cycle(
            changed, torque, changed.base, changed.slices, supports, positions=positions
        )
        yield Setting(flanks.blank.cutter_radius, flanks.ease_off(), cycle)
