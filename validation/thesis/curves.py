"""The curve that the verdict on each claim rests on, by the charts of `solidgear compare A B`: a
function of the name of the one that judges the claim.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from solidgear.show.plot import Chart
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.page.chart import columns_chart, response_chart
from solidgear.trains.response.respond import respond
from solidgear.trains.response.response import TrainResponse
from solidgear.two_designs.shares import Bar, shares_chart
from solidgear.two_designs.two_trains import TwoTrains, motions, two_trains
from validation.thesis import claims
from validation.thesis.claims import AXES, WAYS, fourteen, mounted
from validation.thesis.contact import WAYS as WAYS_OF_CONTACT
from validation.thesis.contact_curves import (  # noqa: F401  (by the names of claims)
    close_pilot_counts_more,
    line_of_action_still,
    mesh_point_still,
    pilot_stiffens,
    span_with_pilot,
    span_without_pilot,
    stiffness_by_pilot,
    stiffness_level,
    stiffness_without_shafts,
)
from validation.thesis.pair import CASES, DATA

HIGHEST = 4000.0
TEETH = DATA["gears"]["teeth"][0]


@cache
def mountings(way: str) -> TwoTrains:
    """Both mountings of the pinion beside each other."""
    shops = [fourteen(case, way).assembly for case in CASES]
    return two_trains(shops, CASES, (), "thesis", highest_hz=HIGHEST)


def responses(way: str) -> list[TrainResponse]:
    """Of both mountings."""
    return [one.response for one in mountings(way).both]


def over(width: float, **named: TrainResponse) -> Chart:
    """Mesh forces of responses over one another, by their names with underscores for blanks."""
    told = [replace(one, name=name.replace("_", " ")) for name, one in named.items()]
    return response_chart(told, "", TEETH, None, {}, width=width)


def rotor(rung: str, highest: float = HIGHEST) -> TrainResponse:
    """The overhung rotor by one model of both shafts."""
    return respond(Assembly(mounted(CASES[0])), rung, highest_hz=highest)


def old_synthesis(width: float) -> Chart:
    old = rotor("lumped-old/euler")
    return over(width, Euler_beams=rotor("euler"), total_mass_at_the_lumped_point=old)


def new_synthesis(width: float) -> Chart:
    own = {rung: rotor(rung, 6000.0) for rung in ("euler", "lumped-bending/euler")}
    return over(width, Euler_beams=own["euler"], effective_mass=own["lumped-bending/euler"])


def damping(width: float) -> Chart:
    assembly = fourteen(CASES[0], "identified").assembly
    loss, literal = (
        respond(assembly, "thesis", "thesis", highest_hz=HIGHEST, damping=kind)
        for kind in ("hysteretic", "literal")
    )
    return over(width, loss_factor_2_zeta=loss, to_the_letter=literal)


def peak_at_800(width: float) -> Chart | None:
    grid = np.unique(np.concatenate([r.frequency_hz for w in WAYS for r in responses(w)]))
    grid = grid[grid >= 100.0]
    told = []
    for k, case in enumerate(CASES):
        columns = {
            f"{way} [N]": respond(
                fourteen(case, way).assembly, "thesis", "thesis", frequency_hz=grid
            ).force
            for way in WAYS
        }
        told.append(replace(responses("identified")[k], frequency_hz=grid, columns=columns))
    return columns_chart(
        told, [(f"{way} [N]", f"mesh force, {way}") for way in WAYS], TEETH, width=width
    )


def bending_leaves(width: float) -> Chart | None:
    modes = []
    for k in range(1, 14):
        bars = []
        for letter, case in zip("AB", CASES):
            pair = claims.solved_pair(case, "identified")
            shares = dict(zip(claims.COMPONENTS, pair.energy[k].tolist()))
            bars.append(Bar(letter, f"{case}, mode {k + 1}", float(pair.frequency_hz[k]), shares))
        if min(bar.hz for bar in bars) < 1000.0:
            modes.append((" and ".join(f"{bar.hz:.0f}" for bar in bars) + " Hz", bars))
    return shares_chart(modes, width)


def moments(width: float) -> Chart | None:
    told = []
    for case, one in zip(CASES, responses("identified")):
        drive = fourteen(case, "identified")
        tilt = drive.motion(one.frequency_hz, drive.system.motion("pinion.1"))[:, 5]
        bearing = next(b for b in drive.assembly.scenes["pinion"].bearings if b.name == "1")
        alone = {"k_thz thz alone [N m]": bearing.stiffness[5, 5] * tilt}
        told.append(replace(one, columns=one.columns | alone))
    whole = "pinion bearing 1 thz [N m]"
    names = [("k_thz thz alone [N m]", "k_thz thz alone"), (whole, "the whole row")]
    return columns_chart(told, names, TEETH, width=width)


def pinion_motion(width: float) -> Chart | None:
    dofs = ("pinion, x", "pinion, z", "pinion, thx", "pinion, thz")
    own = [pair for pair in motions(mountings("identified"), "pinion") if pair[1] in dofs]
    return columns_chart(responses("identified"), own, TEETH, width=width)


def amplitude(width: float) -> Chart | None:
    """Transmission error that reaches the end of the first axis it meets, over frequency."""
    hz = np.geomspace(500.0, 2500.0, 1201)
    told = []
    for k, case in enumerate(CASES):
        columns = {}
        for way in WAYS:
            found = respond(fourteen(case, way).assembly, "thesis", "thesis", frequency_hz=hz)
            error = fourteen(case, way).amplitude(hz)
            sizes = {"mesh force": found.force} | {
                name: found.columns[f"pinion {name} [{'m' if len(name) == 1 else 'rad'}]"]
                for name in AXES
                if name != "mesh force"
            }
            least = [AXES[name] * error / np.abs(size) for name, size in sizes.items()]
            columns[f"{way} [m]"] = np.min(least, axis=0)
        told.append(replace(responses("identified")[k], frequency_hz=hz, columns=columns))
    return columns_chart(
        told,
        [(f"{way} [m]", f"most that the axes allow, {way}") for way in WAYS],
        TEETH,
        width=width,
    )


def mesh_stiffness(width: float) -> Chart:
    grown = claims.mesh_stiffness().numbers
    way = next(iter(WAYS_OF_CONTACT))
    more = respond(claims.scaled(1 + grown[f"{way} k_m"]), "thesis", "thesis", highest_hz=HIGHEST)
    teeth = respond(
        claims.scaled(1 + grown[f"{way} teeth"]), "thesis", "thesis", highest_hz=HIGHEST
    )
    return over(
        width,
        two_bearings=responses("identified")[0],
        k_m_with_a_pilot=more,
        teeth_with_a_pilot=teeth,
    )


def masses(width: float) -> Chart:
    one, other = responses("identified")[0], responses("published masses")[0]
    return over(width, identified_masses=one, published_masses=other)
