"""The geared rotor of Hua (2010) with backlash, by models of its shafts and over torque."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.errors import SolidgearError
from solidgear.nonlinear.balance import Balance
from solidgear.nonlinear.continuation import Follower, Point, follow, walked
from solidgear.nonlinear.motion import settled
from solidgear.nonlinear.stability import stable
from solidgear.studies.train.backlash import Backlash
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.nonlinear import (
    FADED,
    STEP,
    backlash_model,
    teeth_of,
    with_backlash,
)
from solidgear.studies.train.nonlinear_told import BacklashTold
from validation.common import ROOT

AXLES = ("axle_overhung", "axle_thesis")
BACKLASH, ERROR, FORCE = "100 um", "10 um", 5000.0
#: Hz of the mesh
LOWEST, HIGHEST = 150.0, 2000.0
#: pinion and gear; the first is the judge of the others
MIXES = (
    ("harmonic", "harmonic"),
    ("lumped", "lumped"),
    ("lumped/timoshenko", "lumped/timoshenko"),
    ("lumped/euler", "lumped/euler"),
    ("timoshenko", "timoshenko"),
    ("timoshenko", "harmonic"),
    ("harmonic", "timoshenko"),
)
#: mean forces of the map, of the solid axle's linear peak
SHARES = (0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.99)
#: whose maps are drawn
MAPPED = (MIXES[0], MIXES[1])
#: Hz between places at which ranges are compared
GRID = 0.1
#: a mean force at which the large motion hangs together with the small one, N, a frequency on both, Hz,
#: and steps in which the force is raised from there
CONNECTED, RAISED_AT, RAISES = 4600.0, 540.0, 12
#: points after which a walk may be back where it began
AWAY = 12


def workshop(name: str) -> Workshop:
    """A shipped axle with teeth that can part."""
    train = sg.load_train(ROOT / "geometry" / f"{name}.toml")
    mesh = train.mesh.with_changes(backlash=BACKLASH, transmission_error=ERROR)
    return Workshop(train.with_changes(mesh=mesh))


def models(name: str, told: Callable[[str], None]) -> list[dict[str, Any]]:
    """A row of every mix of models at one mean force, each beside the solid one."""
    shop = workshop(name)
    teeth = teeth_of(shop, FORCE)
    found = []
    for mix in MIXES:
        told(f"{name}: {' + '.join(mix)}")
        found.append(with_backlash(shop, mix, teeth, HIGHEST, LOWEST))
    beside = BacklashTold(shop.train, tuple(found), lever(shop)).sufficiency()
    out = []
    for one, judged in zip(found, (None, *beside)):
        row = of(one) | {"unknowns": shop.system(*one.models.values()).size, "by": one.label}
        row["enough"] = None if judged is None else judged.enough
        out.append(row)
    return out


def lever(shop: Workshop) -> float:
    """Torque of the pinion over mesh force, m."""
    return abs(shop.contact.pinion.lever)


def of(one: Backlash) -> dict[str, Any]:
    """What is told of one branch, Hz and N."""
    at, size = one.loudest
    there, linear = one.linear_loudest
    return {
        "jumps": [[j.frequency_hz, j.rising] for j in one.jumps],
        "parts": [[r.low, r.high] for r in one.lost],
        "other flank": [[r.low, r.high] for r in one.both_flanks],
        "least contact": float(one.driving[one.stable].min()),
        "largest": [at, size],
        "highest": float(one.highest[one.stable].max()),
        "linear": [there, linear],
        "wanders": [[r.low, r.high] for _, r in one.wandering],
        "seconds": one.seconds,
    }


def over_torque(name: str, told: Callable[[str], None]) -> list[dict[str, Any]]:
    """Rows of models and mean forces: where the linear force exceeds the mean, and where teeth part."""
    shop = workshop(name)
    teeth, out = teeth_of(shop, FORCE), []
    peak = with_backlash(shop, MIXES[0], teeth, HIGHEST, LOWEST).linear_loudest[1]
    for mix in MAPPED:
        for share in SHARES:
            force = share * peak
            told(f"{name}: {' + '.join(mix)}, {force:.0f} N")
            row = {"by": mix[0], "force": force, "torque": force * lever(shop)}
            try:
                one = with_backlash(shop, mix, replace(teeth, mean_force=force), HIGHEST, LOWEST)
                row |= of(one) | criterion(one, force)
            except SolidgearError as error:
                row["error"] = str(error)
            out.append(row)
    return out


def criterion(one: Backlash, force: float) -> dict[str, Any]:
    """The linear criterion beside what the branch says: ranges, and Hz that only one of them has."""
    hz = np.arange(LOWEST, HIGHEST, GRID)
    said = np.interp(hz, *one.linear) > force
    true = np.zeros(len(hz), bool)
    for part in one.lost:
        true |= (hz >= part.low) & (hz <= part.high)
    edges = np.flatnonzero(np.diff(np.r_[False, said, False].astype(int))).reshape(-1, 2)
    return {
        "said": [[float(hz[a]), float(hz[b - 1])] for a, b in edges],
        "only true": GRID * float((true & ~said).sum()),
        "only said": GRID * float((said & ~true).sum()),
    }


def detached(shop: Workshop, model: str, force: float) -> dict[str, Any]:
    """The branch of the overhung axle that hangs together with no other, at a mean force.

    It is met on a smaller mean force, where one branch has all motions, and carried up from there.

    Returns
    -------
    dict
        Hz between which it lives and those of its stable part, the largest dynamic mesh force there,
        N, and the same in time.
    """
    teeth = replace(teeth_of(shop, FORCE), mean_force=CONNECTED)
    own = backlash_model(shop, [model], teeth, shop.train.ask.max_frequency)
    branch = follow(own, *(2 * np.pi * f for f in (400.0, 800.0)), step=STEP)
    begin = branch.at(2 * np.pi * RAISED_AT)[-1]
    motion = begin.motion
    for share in np.linspace(1.0, force / CONNECTED, RAISES):
        balance = Balance(replace(own, mean=share * own.mean), begin.balance.count)
        motion = balance.solve(motion, begin.omega)
    walk = Follower(balance, *branch.scale)
    first = walk.point(motion, begin.omega, np.append(np.zeros(motion.size), -1.0))
    met: list[Point] = []

    def around(point: Point) -> bool:
        met.append(point)
        apart = np.abs(point.harmonics[1] - first.harmonics[1]).max() / walk.size
        near = abs(point.omega - first.omega) < STEP * walk.width and apart < 0.1
        return len(met) > AWAY and near

    points, turning = walked(walk, first, STEP, True, around)
    hz = np.array([p.omega for p in points]) / (2 * np.pi)
    calm = np.array([stable(p) for p in points])
    size = np.array([np.ptp(p.forces()) / 2 for p in points])
    most = int(np.where(calm, size, 0.0).argmax())
    time = settled(
        points[most].balance.remainder, points[most].omega, points[most].state(), steady=FADED
    )
    return {
        "by": model,
        "force": force,
        "lives": [hz.min(), hz.max()],
        "turning": [hz[k] for k in turning],
        "stable": [hz[calm].min(), hz[calm].max()],
        "largest": [hz[most], size[most]],
        "in time": [time.cycle, float(np.ptp(time.force)) / 2],
    }
