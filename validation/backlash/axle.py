"""The geared rotor of Hua (2010) with backlash, by models of its shafts and over torque."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.backlash.periodic import Backlash
from solidgear.backlash.solver.motion import steady_motion
from solidgear.backlash.study import BacklashStudy
from solidgear.backlash.train import FADED, teeth_of, with_backlash
from solidgear.core.errors import SolidgearError
from solidgear.trains.assembly.assembly import Assembly
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
#: at which branches apart are looked for
SPEEDS = 96


def assembly(name: str) -> Assembly:
    """A shipped axle with teeth that can part."""
    train = sg.load_train(ROOT / "geometry" / f"{name}.toml")
    mesh = train.mesh.with_changes(backlash=BACKLASH, transmission_error=ERROR)
    return Assembly(train.with_changes(mesh=mesh))


def models(name: str, told: Callable[[str], None]) -> list[dict[str, Any]]:
    """A row of every mix of models at one mean force, each beside the solid one."""
    shop = assembly(name)
    teeth = teeth_of(shop, FORCE)
    found = []
    for mix in MIXES:
        told(f"{name}: {' + '.join(mix)}")
        found.append(with_backlash(shop, mix, teeth, HIGHEST, LOWEST, search_speeds=SPEEDS))
    beside = BacklashStudy(shop.train, tuple(found), lever(shop)).sufficiency()
    out = []
    for one, judged in zip(found, (None, *beside)):
        row = of(one) | {"unknowns": shop.system(*one.models.values()).size, "by": one.label}
        row["enough"] = None if judged is None else judged.enough
        out.append(row)
    return out


def lever(shop: Assembly) -> float:
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
        "apart": [[other.periods, *other.loudest] for other in one.branches_apart if other.calm],
        "wanders": [[r.low, r.high] for _, r in one.wandering],
        "seconds": one.seconds,
    }


def over_torque(name: str, told: Callable[[str], None]) -> list[dict[str, Any]]:
    """Rows of models and mean forces: where the linear force exceeds the mean, and where teeth part."""
    shop = assembly(name)
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


def apart(name: str, model: str, force: float) -> list[dict[str, Any]]:
    """Branches apart of an axle at a mean force: where they live and are stable, Hz, the largest dynamic
    mesh force there, N, and the same in time, after periods of the mesh.
    """
    shop = assembly(name)
    teeth = replace(teeth_of(shop, FORCE), mean_force=force)
    found = with_backlash(shop, [model], teeth, HIGHEST, LOWEST, search_speeds=SPEEDS)
    out = []
    for one in found.branches_apart:
        hz, size = one.loudest
        row = {
            "axle": name,
            "by": model,
            "force": force,
            "periods": one.periods,
            "lives": [one.frequency_hz.min(), one.frequency_hz.max()],
            "stable": None,
        }
        if one.calm:
            point = one.points[int(np.argmin(abs(one.force - size)))]
            omega = one.periods * point.omega
            time = steady_motion(found.remainder, omega, point.state(), steady=FADED)
            row["stable"] = [one.calm.low, one.calm.high]
            row["largest"] = [hz, size]
            row["in time"] = [time.cycle, float(np.ptp(time.force)) / 2]
        out.append(row)
    return out
