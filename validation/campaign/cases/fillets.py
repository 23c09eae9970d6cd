"""Do the bars of form factors hold? Drawn shoulders, against meshes of twice as many cells either
way.
"""

from __future__ import annotations

import argparse
import time

from solidgear.studies.stress.notch import UNIT_LOADS, FilletFactors, fillet_factors
from validation.campaign.case import Case, Run
from validation.campaign.rows import DECIDED, Cost, Found, Said, Truth, held
from validation.campaign.scenes.fillets import NAME, filleted_shoulder

#: orders and refinement of the meshes that are taken for the truth
FINE, FINER = (5, 6), 2.0
#: tolerance of an order that the sequence reaches whatever its bar
ALL = 1e-9


class Fillets(Case):
    """Form factors of tension, bending, torsion and shear at three orders, on drawn shoulders."""

    name, question = "fillets", "bars of form factors of fillets"
    parts = ((), ("load",), ("order",))
    details = (("load", "order"),)
    tag_of_costs = "order"
    seeds = (0, 59)

    def options(self, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("--orders", type=int, nargs="+", default=[5, 6, 7])

    def judge(self, run: Run, seed: int) -> Found:
        body = f"seed {seed}"
        found, problem = run.call(solved, seed, tuple(run.given.orders))
        if problem:
            return Found(problems=[f"{body}: {problem}"])
        out = Found()
        for order, (said, seconds) in found["orders"].items():
            out.costs.append(Cost(body, {"order": str(order)}, seconds))
            for load in UNIT_LOADS:
                value, bar = said[load]
                truth, doubt = found["truth"][load]
                true = Truth(truth, doubt / truth, truth, "a finer mesh")
                tags = {"load": load, "order": str(order)}
                one = Said(f"Kt {load}", value, bar / truth, truth)
                out.rows.append(held(one, true, body=body, tags=tags, rule=DECIDED))
        return out


def solved(seed: int, orders: tuple[int, ...]) -> dict:
    """Factors with bars and processor times by order, and the truth with its doubt, by load."""
    scene = filleted_shoulder(seed)
    by_order = {}
    for order in orders:
        start = time.process_time()
        found = fillet_factors(scene, NAME, ALL, orders=(order - 1, order))
        said = {load: (one.value, one.bar) for load, one in found.factors.items()}
        by_order[order] = said, time.process_time() - start
    fine = fillet_factors(scene, NAME, ALL, orders=FINE, refinement=FINER)
    return {"orders": by_order, "truth": _truth(fine)}


def _truth(fine: FilletFactors) -> dict[str, tuple[float, float]]:
    """Values, and what the last order changed of them."""
    before, last = (step.factors for step in fine.steps)
    return {load: (last[load], abs(last[load] - before[load])) for load in UNIT_LOADS}
