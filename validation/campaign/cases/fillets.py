"""Do the bars of form factors hold? Drawn shoulders, against meshes of twice as many cells either
way.
"""

from __future__ import annotations

import argparse
import time

from solidgear.strength.stress.notch import UNIT_LOADS, fillet_factors
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
        return run.found(f"seed {seed}", judged, seed, tuple(run.given.orders))


def judged(seed: int, orders: tuple[int, ...]) -> Found:
    """Factors with bars and processor times by order, against the truth with its doubt, by load."""
    scene, body, out = filleted_shoulder(seed), f"seed {seed}", Found()
    by_order = {}
    for order in orders:
        start = time.process_time()
        by_order[order] = fillet_factors(scene, NAME, ALL, orders=(order - 1, order))
        out.costs.append(Cost(body, {"order": str(order)}, time.process_time() - start))
    fine = fillet_factors(scene, NAME, ALL, orders=FINE, refinement=FINER)
    # the doubt is what the last order changed
    before, last = (step.factors for step in fine.steps)
    for order, found in by_order.items():
        for load in UNIT_LOADS:
            truth, one = last[load], found.factors[load]
            true = Truth(truth, abs(truth - before[load]) / truth, truth, "a finer mesh")
            said = Said(f"Kt {load}", one.value, one.bar / truth, truth)
            tags = {"load": load, "order": str(order)}
            out.rows.append(held(said, true, body=body, tags=tags, rule=DECIDED))
    return out
