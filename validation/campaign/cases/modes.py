"""Is a mode missed, or wrong by more than 1e-6 or than its own bound says? Random shafts against an
independent dense solution.
"""

from __future__ import annotations

import argparse

import numpy as np

from solidgear.core.ladder import build
from solidgear.core.solve.modes import modes
from validation.campaign.case import Case, Run
from validation.campaign.rows import CLAIM, Found, Row
from validation.campaign.scenes.small import small
from validation.campaign.truths.dense import Dense, springs_lost

#: relative error of a frequency that is wrong, whatever its bound
WRONG = 1e-6
#: unknowns a dense solution is allowed
DENSE = 1500
TOO_LARGE = "too large for a dense solution"


class Modes(Case):
    """Every frequency of beams and light harmonic solids, against dense factors of their own."""

    name, question = "modes", "modes against a dense solution: none missed, none wrong"
    widths = False
    parts = ((), ("model",), ("method",))
    seeds = (0, 999)

    def options(self, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("--draw", type=int, default=1, help="another set of scenes")

    def judge(self, run: Run, number: int) -> Found:
        body = f"{run.given.draw}/{number}"
        return run.found(body, judged, body, run.given.draw, number)


def judged(name: str, seed: int, number: int) -> Found:
    """Rows or failures of one case, solved both ways."""
    case = small(seed, number)
    body = build(case.scene, case.model, **case.options)
    if body.size > DENSE:
        raise ValueError(TOO_LARGE)
    n = case.ask["n"]
    found = modes(body, case.scene, **case.ask, ovalising=False)
    elastic = [mode for mode in found.modes if mode.frequency_hz > 0]
    count = sum(mode.multiplicity for mode in elastic)
    rigid = len(found.modes) - len(elastic)
    dense = Dense(body, case.scene)
    value, change = dense.values(max(n, count))
    exact = np.sqrt(np.maximum(value, 0.0)) / (2 * np.pi)
    if rigid != dense.free:
        return Found(failures=[f"{name}: {rigid} rigid motions told, {dense.free} there"])
    if count < min(n, len(exact)):
        return Found(failures=[f"{name}: {count} shapes told of {n}"])
    tags = {"model": case.model, "method": str(found.evidence["method"])}
    rows, place = [], 0
    for mode in elastic:
        mine = slice(place, place + mode.multiplicity)
        place = mine.stop
        # a pair is told as the root mean square of its two
        true = np.sqrt(np.mean(exact[mine] ** 2))
        # what the reference itself does not know, and what couplings left out may do
        unknown = found.evidence["coupling_bound"] / 2 + float(change[mine].max())
        allowed = min(mode.error, WRONG) + unknown + springs_lost(case.scene) + 1e-11
        off = float(mode.frequency_hz / true - 1)
        told = {"error": off, "how": f"{true:.9g} Hz", "rule": CLAIM}
        rows.append(Row(name, mode.name, tags, float(allowed), **told))
    return Found(rows)
