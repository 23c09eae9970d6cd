"""Teeth of Hua (2010) in contact, on the shafts and bearings of its chapter 3.

The thesis loads its teeth on flexible shafts and takes ``k_m = F / (e_L - e_0)``, e_L being the
transmission error under load and e_0 that without.  Here the same, from flanks that follow from Table 1
(:mod:`solidgear.teeth.bevel`): the pitch angles are those of the teeth, the cutter of 6 inches, the
addendum and 22.5 degrees of pressure angle are assumed.  Neither torque nor mismatch is published; two
pairs of them are taken (`WAYS`).  The shafts are the Euler beams whose condensed stiffness is the
published one (``geometry/thesis_*.toml``), with the pilot at S ahead of the pinion's small end and
bearing 2 at L behind bearing 1.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from math import cos, radians
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.frames import shift
from solidgear.core.scene import Scene
from solidgear.core.scene.file import scene_of
from solidgear.core.system.gear_mesh import to_gear_frame
from solidgear.teeth.bevel.blank import BevelBlank
from solidgear.teeth.bevel.flank import lengthwise
from solidgear.teeth.bevel.pair import BevelPair
from solidgear.teeth.bevel.train import toothed_bevel
from solidgear.teeth.contact.cycle import MeshCycle, mesh_cycle
from solidgear.teeth.contact.frame import RigidSupports
from solidgear.teeth.contact.local import Elasticity
from validation.common import ROOT
from validation.thesis.pair import DATA, gear_support

INCH = 25.4e-3
#: torque on the pinion, N m, and ease-off, m
WAYS = {"200 N m, 300 um": (200.0, 300e-6), "1000 N m, 100 um": (1000.0, 100e-6)}
#: positions of the pilot ahead of the small end and of bearing 2 behind bearing 1, in
PILOTS = (0.002, 1.18, 2.36, 3.36, 4.36, 5.36)
SPANS = (5.965, 4.445, 2.925)
#: m; nearest to the small end that a beam's element can be
NEAREST = 1e-4
#: pilot of Table 1, 100 mm ahead of the back face, from the small end, m
PILOT = 0.1 - 0.0765
#: spans of Table 1 with the pilot and without, m
STRADDLED, OVERHUNG = 0.115, 0.150
#: positions of a mesh cycle
POSITIONS = 16
STEEL = Elasticity(2.07e11, 0.3)
#: mm; length of the head, bearing 1 behind the back face, shaft beyond the middle of a seat, a seat
HEAD, BEHIND, BEYOND, SEAT = 76.5, 28.0, 30.0, 20.0


def blank() -> BevelBlank:
    """Table 1, with what is assumed."""
    gears = DATA["gears"]
    return BevelBlank(
        tuple(gears["teeth"]),
        gears["pitch_radius"][0],
        gears["face_width"],
        gears["spiral_angle"],
        gears["hand"][0],
        gears["loaded_side"][0],
        pressure_angle=radians(22.5),
        cutter_radius=6 * INCH,
        gear_share=0.27,
        estimated=("pressure_angle", "cutter_radius", "gear_share", "working_depth"),
    )


# --------------------------------------------------------------------------- supports
@dataclass(frozen=True)
class Mounting:
    """Where the pinion's bearings are, m."""

    pilot: float | None  #: ahead of the small end; None without one
    span: float  #: from bearing 1 to bearing 2

    @property
    def scene(self) -> Scene:
        """The pinion's shaft."""
        name = "thesis_overhung" if self.pilot is None else "thesis_straddle"
        path = ROOT / "geometry" / f"{name}.toml"
        raw = tomllib.loads(path.read_text(encoding="utf-8"))
        by_name: dict[str, dict[str, Any]] = {
            table["name"]: table for table in (*raw["segment"], *raw["bearing"])
        }
        by_name["2"]["position"] = self.span
        by_name["shaft"]["length"] = (BEHIND + BEYOND) / 1e3 + self.span
        if self.pilot is not None:
            by_name["0"]["position"] = -HEAD / 1e3 - self.pilot
            # a seat ends at the step of the head; its section takes no note of the width
            by_name["0"]["seat_width"] = min(SEAT / 1e3, 2 * self.pilot)
            by_name["stub"]["length"] = self.pilot + BEYOND / 1e3
        return scene_of(raw, str(path))


#: Table 1, without and with a pilot
TWO, THREE = Mounting(None, OVERHUNG), Mounting(PILOT, STRADDLED)


def at_apex(stiffness: np.ndarray, place: float) -> np.ndarray:
    """(6, 6) compliance of a shaft at the pitch apex, from its stiffness at a place of its axis, m;
    the rotation about the axis is that of the contact and gives nothing.
    """
    components = [0, 1, 2, 3, 5]
    out = np.zeros((6, 6))
    out[np.ix_(components, components)] = np.linalg.inv(stiffness[np.ix_(components, components)])
    moved = shift([0.0, -place, 0.0])
    return moved @ out @ moved.T


@cache
def gear_compliance() -> np.ndarray:
    """(6, 6) compliance of the gear's shaft at the apex in the pinion's frame."""
    teeth = blank()
    turned = np.kron(np.eye(2), to_gear_frame(np.eye(3)))
    place = teeth.mean_distance * cos(teeth.pitch_angles[1])
    return turned.T @ at_apex(gear_support(), place) @ turned


@cache
def supports(mounting: Mounting | None) -> RigidSupports | None:
    """Both shafts, in the pinion's frame at the apex; None where wheels are held."""
    if mounting is None:
        return None
    scene, teeth = mounting.scene, blank()
    pinion = sg.condense(sg.build(scene, "euler"), scene, "pinion").stiffness
    place = teeth.mean_distance * cos(teeth.pitch_angles[0])
    return RigidSupports(at_apex(pinion, place) + gear_compliance(), np.zeros(6))


# --------------------------------------------------------------------------- contact
@cache
def pair(ease_off: float) -> BevelPair:
    """The flanks with a mismatch, m, on teeth of steel."""
    teeth = blank()
    return toothed_bevel(teeth, (STEEL, STEEL), lengthwise(teeth, ease_off))


@cache
def contact(way: str, mounting: Mounting | None) -> MeshCycle:
    """One mesh cycle."""
    torque, ease_off = WAYS[way]
    bevel = pair(ease_off)
    return mesh_cycle(
        bevel, torque, bevel.base, bevel.slices, supports(mounting), positions=POSITIONS
    )


def along_line(cycle: MeshCycle, mounting: Mounting) -> float:
    """Compliance of the supports along the mean line of action through the mean mesh point, m/N."""
    normal = cycle.lines_of_action.mean(axis=0)
    row = np.concatenate([normal, np.cross(cycle.points.mean(axis=0), normal)])
    carrying = supports(mounting)
    assert carrying is not None
    return float(row @ carrying.compliance @ row / (normal @ normal))


def by_pilot() -> dict[str, Mounting]:
    """Figures 3.11, 3.15 and 3.19."""
    return {f"S = {S:g} in": Mounting(max(S * INCH, NEAREST), STRADDLED) for S in PILOTS}


def by_span(pilot: float | None) -> dict[str, Mounting]:
    """Figures 3.12, 3.13, 3.16, 3.17, 3.20 and 3.21."""
    return {f"L = {L:g} in": Mounting(pilot, L * INCH) for L in SPANS}
