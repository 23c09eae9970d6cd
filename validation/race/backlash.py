"""Branches of teeth with backlash: harmonic balance beside sweeps in time, and beside pyHarm.

The pair is ``x'' + 2 zeta x' + f(x) = F_m + F_a w^2 cos w t``, f of slope one beside a half gap of
one, zeta 0.05, F_m 0.1, F_a 0.05; the train is the overhung axle, mean force 5 kN, transmission error
10 um, backlash 100 um.  All seconds are of the processor.  Sweeps go up and down, each motion begun
where the last one ended, and say where a motion jumps to their step; a branch says it to rounding.
"""

from __future__ import annotations

from functools import cache
from time import process_time

import numpy as np

import solidgear as sg
from solidgear.backlash.solver.continuation import Branch, follow
from solidgear.backlash.solver.model import Remainder, remainder
from solidgear.backlash.solver.motion import sweep
from solidgear.backlash.train import STEP, backlash_model, teeth_of
from solidgear.core.system import Inertia, RowSpring, System
from solidgear.core.system.law import Gap
from solidgear.trains.assembly.assembly import Assembly
from validation.common import ROOT
from validation.race import pyharm_peer
from validation.race.heat import Check, Heat, Sample
from validation.race.installed import missing
from validation.race.race import Race

ZETA, MEAN, AMPLITUDE = 0.05, 0.1, 0.05
BEGIN, END = 0.5, 1.3
#: speeds of a sweep each way, together as many as a branch has points, and those of a quick run
PAIR_SPEEDS, TRAIN_SPEEDS, QUICK = 30, 136, 3
#: Hz in which teeth of the axle part and jump, and of all of its branch
PARTING, WHOLE = (500.0, 1000.0), (40.0, 4000.0)
HARMONICS = 9
#: of pyHarm: instants of a period, longest steps of the pair and of the axle
INSTANTS, STEPS = 1024, (0.02, 0.05)
#: Hz, above all modes of the lumped axle
ALL = 1e6
#: rad/s by which the axle is scaled for it
SCALE = 2 * np.pi * 700.0
#: share of the largest stretch of the teeth in a mode below which the mode is left out for it
STILL = 1e-6
#: processor seconds after which a slow lane runs no more
ENOUGH = 10.0
#: relative, and why
AGREE = (1e-3, "asked of two methods; both have the same law and modes")


def pair(amplitude: float = AMPLITUDE) -> Remainder:
    """A mass on teeth with a half gap of one."""
    teeth = RowSpring("gear", [0, 0, 1, 0, 0, 0], 1.0, law=Gap(1.0, 1.0))
    system = System({"gear": Inertia(1.0, "z")}, {"mesh": teeth})
    losses = {"loss": {"mesh": 2 * ZETA}, "kind": "viscous", "matched_hz": 1 / (2 * np.pi)}
    return remainder(system, load=np.array([MEAN]), errors={"mesh": [amplitude]}, **losses)


@cache
def axle(model: str, highest_hz: float = WHOLE[1]) -> Remainder:
    """The overhung axle by one model of both shafts."""
    train = sg.load_train(ROOT / "geometry" / "axle_overhung.toml")
    mesh = train.mesh.with_changes(backlash="100 um", transmission_error="10 um")
    assembly = Assembly(train.with_changes(mesh=mesh))
    return backlash_model(assembly, [model], teeth_of(assembly, 5000.0), highest_hz)


def branched(own: Remainder, begin: float, end: float, **more) -> Sample:
    """A branch, clocked by the processor."""
    clock = process_time()
    found = follow(own, begin, end, **more)
    spent = process_time() - clock
    return Sample({"processor": spent}, spent, found, {"points": float(len(found.points))})


def swept(own: Remainder, branch: Branch, speeds: np.ndarray, steady: float) -> Sample:
    """Sweeps up and down over speeds, rad/s, from the motions of a branch at both ends."""
    clock, out = process_time(), []
    for way, at in ((speeds, 0), (speeds[::-1], -1)):
        out += sweep(own, way.tolist(), state=branch.at(float(way[0]))[at].state(), steady=steady)
    spent = process_time() - clock
    facts = {"motions": float(len(out)), "of one period": float(sum(x.cycle == 1 for x in out))}
    return Sample({"processor": spent}, spent, out, facts)


def apart(motions: list, branch: Branch) -> float:
    """Largest relative difference in rms between motions of one period and the nearest of a branch."""
    worst = 0.0
    for one in motions:
        if one.cycle == 1:
            near = [abs(p.rms[0] / one.rms[0] - 1) for p in branch.at(one.omega)]
            worst = max(worst, min(near))
    return worst


def of_pair(heat: Heat) -> None:
    """The single pair: a branch of some 60 points, 60 motions in time, and pyHarm."""
    own = pair()
    branch = follow(own, BEGIN, END)
    fast = heat.add("branch", lambda: branched(own, BEGIN, END), within=0.1)
    speeds = np.linspace(0.6, 1.2, QUICK if heat.quick else PAIR_SPEEDS)
    check = Check("rms, each against the branch", lambda x: apart(x, branch), *AGREE)
    slow = heat.add(
        "sweeps", lambda: swept(own, branch, speeds, 1e-5), checks=[check], enough=ENOUGH
    )
    heat.ratio("sweeps in time / branch", slow, fast, 100.0)
    fixed = heat.add(
        "branch, nine harmonics", lambda: branched(own, BEGIN, END, harmonics=HARMONICS)
    )
    by_pyharm(heat, pair_for_pyharm(AMPLITUDE), branch, 1.0, STEPS[0], fixed)


def pair_for_pyharm(amplitude: float) -> dict:
    """Plain data for pyHarm: the mass, and what its teeth and its damper stand against."""
    moves = [[2 * ZETA, -2 * ZETA], [-2 * ZETA, 2 * ZETA]]
    linear = {"mass": [[1, 0], [0, 0]], "damping": moves, "stiffness": [[0, 0], [0, 0]]}
    return linear | {"load": [MEAN, 0], "error": amplitude, "begin": BEGIN, "end": END}


def of_lumped(heat: Heat) -> None:
    """The axle of 14 degrees of freedom, nine harmonics."""
    own, branch = of_axle(heat, "lumped", 10.0)
    if not heat.quick:
        whole = axle("lumped", ALL)
        omegas = [2 * np.pi * f for f in PARTING]
        fixed = heat.add(
            "branch, all modes", lambda: branched(whole, *omegas, harmonics=HARMONICS, step=STEP)
        )
        reference = follow(whole, *omegas, step=STEP)
        by_pyharm(heat, scaled_axle(whole), reference, SCALE, STEPS[1], fixed)


def of_solid(heat: Heat) -> None:
    """The axle with both shafts solid."""
    of_axle(heat, "harmonic", 5.0)


def of_axle(heat: Heat, model: str, within: float) -> tuple[Remainder, Branch]:
    """A branch over all of its range, one where teeth part, and sweeps there."""
    own = axle(model)
    whole, part = ([2 * np.pi * f for f in ends] for ends in (WHOLE, PARTING))
    more = {"harmonics": HARMONICS, "step": STEP}
    heat.add("branch, 40 to 4000 Hz", lambda: branched(own, *whole, **more), within=within)
    fast = heat.add("branch, 500 to 1000 Hz", lambda: branched(own, *part, **more))
    branch = follow(own, *part, step=STEP)
    speeds = np.linspace(*part, QUICK if heat.quick else TRAIN_SPEEDS)
    check = Check("rms, each against the branch", lambda x: apart(x, branch), *AGREE)
    slow = heat.add(
        "sweeps, 500 to 1000 Hz",
        lambda: swept(own, branch, speeds, 1e-4),
        checks=[check],
        enough=ENOUGH,
    )
    heat.ratio("sweeps in time / branch, 500 to 1000 Hz", slow, fast, 100.0)
    return own, branch


def by_pyharm(heat: Heat, scaled: dict, branch: Branch, scale: float, step: float, fast) -> None:
    """A lane of pyHarm on the same equations, and its ratio."""
    if absent := missing("pyHarm"):
        heat.skip(absent)
        return
    more = {"harmonics": HARMONICS, "instants": INSTANTS, "step": step}

    def call() -> Sample:
        found = pyharm_peer.solve(limit=heat.limit, **scaled, **more)
        heat.versions["pyHarm"] = found["version"]
        seconds = found["seconds"]
        facts = {"points": float(len(found["omega"]))}
        return Sample({"processor": seconds}, seconds, found, facts)

    checks = [
        Check("turning points", lambda x: turned(x, branch, scale), 2e-3, "a step of pyHarm's"),
        Check("rms at three speeds", lambda x: rms_apart(x, branch, scale), 5e-3, "the same"),
    ]
    note = "best of three, without imports and compilation"
    slow = heat.add("pyHarm, nine harmonics", call, checks=checks, note=note, enough=ENOUGH)
    heat.ratio("pyHarm / branch, nine harmonics", slow, fast)


def turning(omega: np.ndarray) -> list[float]:
    """Speeds at which a branch turns, by the parabola through the points there."""
    out = []
    for k in np.flatnonzero(np.diff(np.sign(np.diff(omega)))) + 1:
        before, here, after = omega[k - 1 : k + 2]
        bend = before - 2 * here + after
        out.append(float(here - (after - before) ** 2 / (8 * bend)))
    return out


def turned(found: dict, branch: Branch, scale: float) -> float:
    """Largest relative difference of turning points; infinite where there are more or fewer."""
    theirs = np.array(turning(np.array(found["omega"]))) * scale
    ours = branch.omega[list(branch.turning)]
    return float(np.abs(theirs / ours - 1).max()) if len(theirs) == len(ours) else np.inf


def branch_rms(omega: np.ndarray, parts: np.ndarray, at: float) -> np.ndarray:
    """rms about the mean of every motion at a speed, in order, linear between points."""
    rms = np.sqrt((parts[:, 1:] ** 2).sum(axis=1) / 2)
    on = np.flatnonzero((omega[:-1] - at) * (omega[1:] - at) <= 0)
    share = (at - omega[on]) / (omega[on + 1] - omega[on])
    return rms[on] + share * (rms[on + 1] - rms[on])


def rms_apart(found: dict, branch: Branch, scale: float) -> float:
    """Largest relative difference of rms at three speeds between the turning points."""
    omega, parts = np.array(found["omega"]) * scale, np.array(found["stretch"])
    size = 1.0 if scale == 1.0 else float(axle_gap(branch))
    ends = branch.omega[list(branch.turning)]
    worst = 0.0
    for w in np.linspace(ends.min(), ends.max(), 5)[1:-1]:
        ours = np.array([p.rms[0] for p in branch.at(float(w))])
        theirs = size * branch_rms(omega, parts, float(w))
        if len(theirs) != len(ours):
            return np.inf
        worst = max(worst, float(np.abs(theirs / ours - 1).max()))
    return worst


def axle_gap(branch: Branch) -> float:
    """Half gap of the teeth of a branch, m."""
    return float(branch.points[0].balance.remainder.laws[0][0].edges[-1])


def scaled_axle(own: Remainder) -> dict:
    """Plain data for pyHarm: stretch, and what each mode but one has of it, as unknowns, half gap and
    mesh stiffness one.
    """
    heard = np.abs(own.shapes[0]) > STILL * np.abs(own.shapes[0]).max()
    seen, omega = own.shapes[0, heard], own.omega[heard]
    losses = own.losses[np.ix_(heard, heard)]
    gap, teeth = own.laws[0][0].edges[-1], own.stiffness[0, 0]
    way = np.diag(seen)
    at = int(np.abs(seen).argmax())
    way[at] = way[0]
    way[0] = seen
    back = np.linalg.inv(way)
    # any load that stretches the teeth as much will do
    load = own.mean[0] * seen / (seen**2 / omega**2).sum()

    def bordered(matrix: np.ndarray) -> list:
        return np.pad(back.T @ matrix @ back / teeth, (0, 1)).tolist()

    return {
        "mass": bordered(SCALE**2 * np.eye(len(omega))),
        "damping": bordered(SCALE * losses),
        "stiffness": bordered(np.diag(omega**2) - teeth * np.outer(seen, seen)),
        "load": [*(back.T @ load / (teeth * gap)).tolist(), 0.0],
        "error": abs(own.error[0, 0]) / gap,
        "begin": 2 * np.pi * PARTING[0] / SCALE,
        "end": 2 * np.pi * PARTING[1] / SCALE,
    }


BACKLASH = Race(
    "branches of teeth with backlash, beside sweeps in time and pyHarm",
    {"pair": of_pair, "axle": of_lumped, "solid": of_solid},
    needs=("pyHarm",),
)
