"""Do the error bars of grooves, cross holes and keyways hold? Drawn ones, against finer meshes."""

from __future__ import annotations

import argparse
import time

import numpy as np

from solidgear.core.scene import Material, Segment
from solidgear.cuts.features import CrossHole, Keyway
from solidgear.strength.stress.groove import groove_factors
from solidgear.strength.stress.groove_mesh import GrooveShape
from solidgear.strength.stress.local_factors import LOADS, SIZES, local_factors
from validation.campaign.case import Case, Run
from validation.campaign.rows import DECIDED, Cost, Found, Said, Truth, held
from validation.campaign.scenes.shafts import between

#: meshes that are solved for the truth beyond those in use
FURTHER = 2
#: of grooves: orders and refinement
ORDERS, FINER = (5, 6), 1.6
#: tolerance that no mesh reaches
ALL = 1e-9
DIAMETER = 0.04


class Notches(Case):
    """Form factors of tension, bending and torsion at drawn grooves, cross holes and keyways."""

    name, question = "notches", "error bars of grooves, cross holes and keyways"
    parts = ((), ("kind",), ("load",))
    details = (("kind", "load"),)
    tag_of_costs = "kind"
    seeds = (0, 5)

    def options(self, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("--tolerance", type=float, default=0.05)

    def judge(self, run: Run, seed: int) -> Found:
        return run.found(f"seed {seed}", judged, seed, run.given.tolerance)


def judged(seed: int, tolerance: float) -> Found:
    """Factors with bars and processor times, against the truth with its doubt, by load."""
    rng = np.random.default_rng([seed, 47])
    material = Material(E=2.1e11, nu=float(rng.choice([0.3, 0.3, 0.25, 0.33])), density=7850.0)
    bore = DIAMETER * float(rng.choice([0.0, 0.0, rng.uniform(0.1, 0.6)]))
    shaft = Segment.cylinder("shaft", length=1.0, diameter=DIAMETER, bore=bore, material=material)
    kind = ("groove", "hole", "keyway")[seed % 3]
    body, out = f"seed {seed}, {kind}", Found()
    start = time.process_time()
    if kind == "groove":
        shape = _groove(rng, (DIAMETER - bore) / 2)
        found = groove_factors("groove", shaft, shape, 0.5)
        cost = time.process_time() - start
        fine = groove_factors("fine", shaft, shape, 0.5, ALL, orders=ORDERS, refinement=FINER)
    else:
        cut = _hole(rng) if kind == "hole" else _keyway(rng, (DIAMETER - bore) / 2)
        found = local_factors(shaft, cut, tolerance)
        cost = time.process_time() - start
        fine = local_factors(shaft, cut, ALL, sizes=SIZES[: len(found.steps) + FURTHER])
    out.costs.append(Cost(body, {"kind": kind}, cost))
    before, last = (step.factors for step in fine.steps[-2:])
    for load in LOADS:
        truth, factor = last[load], found.factors[load]
        # the doubt is what the last mesh changed
        true = Truth(truth, abs(truth - before[load]) / truth, truth, "a finer mesh")
        said = Said(f"Kt {load}", factor.value, factor.bar / truth, truth)
        tags = {"load": load, "kind": kind}
        out.rows.append(held(said, true, body=body, tags=tags, rule=DECIDED))
    return out


def _groove(rng: np.random.Generator, wall: float) -> GrooveShape:
    """Draw a U, V, flat or rectangular groove."""
    depth = min(between(rng, 0.005, 0.2) * DIAMETER, 0.5 * wall)
    radius = depth * between(rng, 0.08, 3.0)
    kind = rng.integers(3)
    if kind == 1:
        return GrooveShape(depth, min(radius, depth), floor=radius * rng.uniform(0.3, 5.0))
    lean = float(np.radians(rng.uniform(15, 60))) if kind == 2 else 0.0
    return GrooveShape(depth, radius, lean=lean)


def _hole(rng: np.random.Generator) -> CrossHole:
    """Draw a hole across the axis."""
    size = between(rng, 0.06, 0.4) * DIAMETER
    return CrossHole(name="hole", segment="shaft", y=0.5, diameter=size)


def _keyway(rng: np.random.Generator, wall: float) -> Keyway:
    """Draw a keyway with round ends, and the radius at its floor."""
    width = rng.uniform(0.2, 0.32) * DIAMETER
    depth = min(rng.uniform(0.1, 0.18) * DIAMETER, 0.6 * wall)
    length = width + rng.uniform(0.3, 1.5) * DIAMETER
    radius = between(rng, 0.05, 0.5) * depth
    return Keyway(
        name="key", segment="shaft", y=0.4, length=length, width=width, depth=depth, radius=radius
    )
