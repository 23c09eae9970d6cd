r"""Contact of a bevel mesh of a train over a mesh cycle, on its shafts, at an operating point.

Both shafts move their wheels as rigid bodies at the lumped points.  Where cutter and mismatch are not
given they are estimated, the ease-off as the geometric mean of what is common, and the band of
:mod:`solidgear.teeth.bevel.band` stands beside the numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, sin, sqrt
from typing import Any

from solidgear.core.plain import plain
from solidgear.teeth.bevel.band import EASE_OFFS, SettingBand, setting_band
from solidgear.teeth.bevel.blank import BevelBlank
from solidgear.teeth.bevel.flank import BevelFlanks, Mismatch, lengthwise
from solidgear.teeth.bevel.pair import BevelPair
from solidgear.teeth.bevel.reading import blank_of, mismatch_of
from solidgear.teeth.compliance.plane import HUB, PlaneTeeth
from solidgear.teeth.compliance.slices import Slices
from solidgear.teeth.contact.cells import ToothedPair
from solidgear.teeth.contact.cycle import POSITIONS, mesh_cycle
from solidgear.teeth.contact.frame import Frame
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.teeth.mesh_contact import SolvedMesh
from solidgear.teeth.supports import Carried
from solidgear.trains.assembly.mesh_place import place_of_pair
from solidgear.trains.file.pairs import Pair
from solidgear.trains.load.contact import axes_of

#: of flanks whose mismatch is not known, m
USUAL_EASE_OFF = sqrt(EASE_OFFS[0] * EASE_OFFS[-1])
#: body behind the teeth that bends with them, modules: a virtual wheel has none of its own, and the
#: gear's is a ring.  From 2 to 10 modules the mesh stiffness falls by 12 to 19 %
RIM = 4.0
#: slices of the face
SLICES = 24
#: orders of the transmission error that are listed
ORDERS = 5
#: share of the load at tips and ends of the face that is worth a sentence
EDGE = 0.2
#: what estimated values of a blank are, by the attribute
ESTIMATES = {
    "pressure_angle": lambda blank: (
        f"pressure angle {degrees(blank.pressure_angle):.4g} deg, the usual one"
    ),
    "cutter_radius": lambda blank: (
        f"cutter radius {1e3 * blank.cutter_radius:.4g} mm, the mean cone distance"
    ),
    "gear_share": lambda blank: (
        f"addendum of the gear {blank.gear_share:.3g} of the working depth (ANSI/AGMA 2005-D03)"
    ),
    "working_depth": lambda blank: f"working depth {blank.working_depth:g} mean normal modules",
}


@dataclass(frozen=True, eq=False)
class BevelContact(SolvedMesh):
    """The teeth of one bevel mesh under one load."""

    pair: BevelPair
    eased: bool  #: whether the mismatch is estimated

    @property
    def teeth(self) -> ToothedPair:
        """Both wheels as their contact needs them."""
        return self.pair

    @property
    def module(self) -> float:
        """Normal module at the middle of the face, m."""
        return self.pair.flanks.blank.module

    @property
    def estimated(self) -> bool:
        """Whether cutter or mismatch are."""
        return self.eased or "cutter_radius" in self.pair.flanks.blank.estimated

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on numbers of the file that were not taken."""
        return self.pair.flanks.blank.notes

    @property
    def face_width(self) -> float:
        """Face width, m."""
        return self.pair.flanks.blank.face

    @property
    def height(self) -> str:
        """What places of cells up the tooth are, in words."""
        return "above the pitch cone"

    @property
    def status(self) -> str:
        """How the numbers came about, as in a file."""
        return "estimated" if self.estimated else "calculated"

    @property
    def gear_position(self) -> tuple[float, float, float]:
        """The gear's lumped point from the pinion's, in the pinion's frame, m: both at the middle of the
        face, by the pitch angles of the teeth.
        """
        blank = self.pair.flanks.blank
        pinion, gear = (blank.mean_distance * cos(angle) for angle in blank.pitch_angles)
        angle = blank.shaft_angle
        return -gear * sin(angle), gear * cos(angle) - pinion, 0.0

    @cached_property
    def band(self) -> SettingBand | None:
        """Contact over the settings that the file leaves open; None where it leaves none open."""
        if not self.estimated:
            return None
        ease_offs = EASE_OFFS if self.eased else (self.pair.flanks.ease_off(),)
        return setting_band(self.pair, self.cycle.torque, self.supports, ease_offs=ease_offs)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        flanks, band = self.pair.flanks, self.band
        data = super().as_dict() | plain(
            {
                "contact_ratio": flanks.contact_ratio,
                "ease_off": flanks.ease_off(),
                "cutter_radius": flanks.blank.cutter_radius,
                "band": [
                    {
                        "cutter_radius": setting.cutter_radius,
                        "ease_off": setting.ease_off,
                        "tangent": setting.cycle.tangent.mean(),
                        "secant": setting.cycle.secant.mean(),
                        "peak_to_peak": setting.cycle.peak_to_peak,
                    }
                    for setting in (() if band is None else band.settings)
                ],
            }
        )
        return data

    @property
    def edge(self) -> str:
        """Where contact leaves the flank: a sentence, or nothing."""
        share = self.cycle.corner_share
        if share <= EDGE:
            return ""
        return f"tips and ends of the face carry up to {100 * share:.0f} % of the load"


def toothed_bevel(
    blank: BevelBlank,
    materials: tuple[Elasticity, Elasticity],
    mismatch: Mismatch | None = None,
    slices: int = SLICES,
) -> BevelPair:
    """Return the flanks with the compliance of their teeth; `mismatch` is estimated by default.

    Raises
    ------
    SceneError
        For undercut flanks, and teeth that part before the next ones touch.
    """
    flanks = BevelFlanks(blank, mismatch or lengthwise(blank, USUAL_EASE_OFF))
    flanks.refuse_undercut()
    length = blank.face / cos(blank.spiral_angle)
    compliances = []
    for wheel, material in zip(blank.virtual_wheels(length), materials):
        hold = max(wheel.root - RIM * wheel.module, HUB * wheel.root)
        plane = PlaneTeeth(wheel, hold=hold, elasticity=material)
        compliances.append(Slices(plane, length, slices))
    law = LineContact(materials, (compliances[0].depth, compliances[1].depth))
    return BevelPair(flanks, (compliances[0], compliances[1]), law, slices)


def assumed(blank: BevelBlank, mismatch: Mismatch | None) -> tuple[str, ...]:
    """Return a sentence for each value that is estimated, and for data that were not taken."""
    out = [ESTIMATES[key](blank) for key in blank.estimated]
    if mismatch is None:
        out.append(f"ease-off {1e6 * USUAL_EASE_OFF:.0f} um, by a larger cutter of the pinion")
    return tuple(out)


def apex_frame(carried: Carried, pair: Pair, blank: BevelBlank) -> Frame:
    """Return the pinion's frame at the pitch apex; the lumped point lies at the middle of the face."""
    port = carried.system.port(f"{pair.shafts[0]}.{pair.ports[0]}")
    axes = port.axes @ axes_of(pair, "pinion")
    ahead = blank.mean_distance * cos(blank.pitch_angles[0])
    return Frame(port.point - ahead * axes[:, 1], axes)


def bevel_contact(
    carried: Carried,
    pair: Pair,
    materials: tuple[Elasticity, Elasticity],
    slices: int = SLICES,
    positions: int = POSITIONS,
) -> BevelContact:
    """Solve the contact of a bevel mesh over its cycle where its train is carried.

    Parameters
    ----------
    carried : Carried
        The train at rest under its loads.
    pair : Pair
        A bevel mesh of it.
    materials : (Elasticity, Elasticity)
        Of pinion and gear.
    slices, positions : int
        Of the face and of the mesh cycle.
    """
    blank = blank_of(pair, carried.coast(pair))
    mismatch = mismatch_of(pair, blank)
    toothed = toothed_bevel(blank, materials, mismatch, slices)
    place = place_of_pair(carried.assembly, carried.system, pair)
    supports = carried.supports(pair, place, apex_frame(carried, pair, blank))
    lever = carried.assembly.contacts[pair.name].pinion.lever
    torque = abs(float(carried.force(place) * lever))

    return BevelContact(
        name=pair.name,
        pair=toothed,
        supports=supports,
        cycle=mesh_cycle(toothed, torque, toothed.base, slices, supports, positions),
        assumed=assumed(blank, mismatch),
        eased=mismatch is None,
    ).within_reach()
