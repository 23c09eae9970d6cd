"""Two spur gears: ROSS integrates them in time, ours by harmonic balance and in time."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.stability import stable
from validation.backlash.spur_pair import SpurPair
from validation.race import ross_peer

HALF_GAP = 5e-5
#: ROSS's own example, at 1000 rpm; and a tenth of its transmission error on a constant stiffness,
#: with a mesh that is damped, near its resonance, where teeth part
EXAMPLE = {
    "hz": [1000 / 3],
    "error": 2e-5,
    "swing": 100.0,
    "varying": 0.275,
    "damping": 0.0,
    "cycles": 400,
    "steps": 300,
}
PARTING = {
    "hz": [3000.0, 3110.0, 3200.0, 3400.0],
    "error": 2e-6,
    "swing": 0.0,
    "varying": 0.0,
    "damping": 0.07,
    "cycles": 500,
    "steps": 80,
}
CASES = {"example": EXAMPLE, "parting": PARTING}
#: Hz around the resonance
AROUND = 4200.0, 2000.0


def rows() -> list[dict[str, Any]]:
    """Every motion by ROSS, by us as ROSS has the separating force, and with the force of statics."""
    out = []
    for name, given in CASES.items():
        found = ross_peer.in_time(limit=3600.0, **given)
        for run in found["runs"]:
            approach, gap, force = (
                np.array(run[key]).reshape(2, -1) for key in ("approach", "gap", "force")
            )
            before, last = (told(s, f) for s, f in zip(approach - gap + HALF_GAP, force))
            row = last | {"distance": run["distance"] - 0.2}
            row["still changing"] = abs(last["swing"] / before["swing"] - 1)
            common = {"case": name, "hz": run["hz"]}
            out.append(common | {"by": f"ROSS {found['version']}", **row})
            pair = spur_pair(found["pair"], run, given)
            for spread in (2.0, 1.0):
                out += [common | one for one in ours(replace(pair, spread=spread), run["hz"], row)]
    return out


def spur_pair(numbers: dict, run: dict, given: dict) -> SpurPair:
    """Ours with the numbers of a run of ROSS."""
    return SpurPair(
        **{k: numbers[k] for k in ("mass", "polar", "base_radius", "mesh_damper")},
        teeth=int(numbers["teeth"]),
        pressure_angle=np.radians(20.0),
        half_gap=HALF_GAP,
        error=given["error"],
        bearing=1e8,
        damper=512.64,
        torque=300.0,
        swing=given["swing"],
        stiffness=np.array(run["stiffness"]),
    )


def ours(pair: SpurPair, hz: float, beside: dict[str, float]) -> list[dict[str, Any]]:
    """Motion by harmonic balance, that nearest to another one, and from there on in time."""
    rpm = 60 * hz / pair.teeth
    if pair.swing:
        point = pair.balanced(rpm)
    else:
        branch = follow(pair.remainder, *(2 * np.pi * f for f in AROUND), step=0.03)
        settled = [p for p in branch.at(pair.omega(rpm)) if stable(p)]
        point = min(settled, key=lambda p: abs(p.rms[0] - beside["swing"]))
    s, f = pair.in_time(point, 1 if pair.swing else 200)
    who = f"ours, {pair.spread:g} sin alpha"
    rows = {"balance": (point.waves()[0], point.forces()), "time": (s, f)}
    return [
        {"by": f"{who}, {way}", **told(s[:, 0], f[:, 0] - f[:, 1])} for way, (s, f) in rows.items()
    ]


def told(stretch: np.ndarray, force: np.ndarray) -> dict[str, float]:
    """Mean and standard deviation of the stretch, m, ends of the force, N, and share of contact."""
    return {
        "mean": float(stretch.mean()),
        "swing": float(stretch.std()),
        "most": float(force.max()),
        "least": float(force.min()),
        "touching": float(np.mean(force > 0)),
    }
