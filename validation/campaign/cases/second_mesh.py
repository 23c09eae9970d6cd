"""Do bars of a 3D solid whose mesh was set, told by a coarser second mesh, hold? Random shafts against
the harmonic solid.
"""

from __future__ import annotations

import argparse
import time

from solidgear.core.judge.coarser_mesh import coarser_bars

from solidgear.core.body import as_supports
from solidgear.core.judge.bounded import mode_bars
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.solve.modes import modes
from validation.campaign.case import Case, Run
from validation.campaign.rows import DECIDED, Found, Row
from validation.campaign.scenes.shafts import random_scene

#: unknowns of a mesh that is solved here
LARGEST = 60_000
TOO_LARGE = "its mesh is too large for a campaign"
#: harmonic solid that tells the true frequencies, and shapes beyond those asked for: its order is another
TRUTH, MORE = {"order": 6}, 8


class SecondMesh(Case):
    """Every frequency that has a bar, by the name of its mode."""

    name, question = "second-mesh", "bars of modes -f solid from a second mesh"
    parts = ((), ("cells",))
    details = (("family",),)
    seeds = (1, 40)

    def options(self, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("--element", default="hex20", help="of the mesh that is set")
        parser.add_argument("--refinement", type=float, default=1.0, help="of the same")

    def judge(self, run: Run, seed: int) -> Found:
        given = run.given
        return run.found(f"seed {seed}", judged, seed, given.element, given.refinement)


def judged(seed: int, element: str, refinement: float) -> Found:
    """Bars, errors and what the second mesh cost."""
    scene = random_scene(seed)
    options = {"element": element, "refinement": refinement}
    if LADDER["solid"].size(scene, options).unknowns > LARGEST:
        raise ValueError(TOO_LARGE)
    start = time.process_time()
    body = build(scene, "solid", **options)
    found = modes(body, scene, scene.ask.modes)
    alone = time.process_time()
    bars = coarser_bars(scene, body, found, options)
    share = (time.process_time() - alone) / (alone - start)
    exact = build(scene, "harmonic", **TRUTH)
    true = modes(exact, scene, scene.ask.modes + MORE)
    doubts = mode_bars(scene, exact, as_supports(scene), true)
    known = {str(mode.name): mode.frequency_hz for mode in true.modes}
    rows = [
        Row(
            body=f"seed {seed}",
            quantity=name,
            tags={"cells": element, "family": mode.family},
            bar=bars[name],
            error=mode.frequency_hz / known[name] - 1,
            doubt=doubts.get(name, 0.0),
            how=f"second mesh {100 * share:.0f} % more time",
            rule=DECIDED,
        )
        for mode in found.modes
        if (name := str(mode.name)) in bars and name in known
    ]
    return Found(rows)
