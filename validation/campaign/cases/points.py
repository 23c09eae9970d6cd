"""Do the bars of terms between two points hold? Random shafts with a second lumped point.

Every mesh that the harmonic solid of a comparison climbs over is judged, not the last one alone, and
beside the terms between points those of the second point, and stiffnesses with both points held.
"""

from __future__ import annotations

import argparse
import time

from solidgear.core.judge.quantities import Values, size
from solidgear.core.judge.solution import Solution
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import SCENE
from solidgear.core.quantity import COMPLIANCE, Quantity
from solidgear.core.scene import Scene
from validation.campaign.case import Case, Run
from validation.campaign.cases.shafts import FINE, MOST_UNKNOWNS, SHARE
from validation.campaign.rows import DECIDED, Cost, Found, Row, Said, held
from validation.campaign.scenes.shafts import random_scene, with_second_point
from validation.campaign.truths.kept import truth_of
from validation.campaign.truths.reference import Reference

#: that are climbed at most: beyond, a reference costs minutes
MESHES = 3


class Points(Case):
    """Terms at and between two points on every mesh, held against the spectral reference."""

    name, question = "points", "bars of terms between two points"
    parts = ((), ("mesh", "of"))
    seeds = (1, 24)
    tag_of_costs = "model"

    def options(self, parser: argparse.ArgumentParser) -> None:
        add = parser.add_argument
        add("--limit", type=int, default=MOST_UNKNOWNS, help="unknowns of a reference")
        add("--meshes", type=int, default=MESHES, help="that a scene climbs at most")

    def judge(self, run: Run, seed: int) -> Found:
        scene, limit = scene_of(seed), run.given.limit
        body = f"seed {seed} ({scene.title})"
        meshes, problem = run.call(solutions, scene, run.given.meshes)
        if problem:
            return Found(problems=[f"{body}: {problem}"])
        goal: dict[str, float] = {}
        for said in (one for mesh in meshes.values() for one in mesh["said"]):
            wanted = max(SHARE * said.bar, FINE)
            goal[said.quantity] = min(goal.get(said.quantity, 1.0), wanted)
        truths = run.truths(scene, limit, limit // 2, limit // 2)
        truths.meet(goal)
        if truths.finest is None:
            return Found(problems=[f"{body}: no reference within {limit} unknowns"])
        out = Found(
            costs=[Cost(body, {"model": "harmonic"}, max(m["seconds"] for m in meshes.values()))]
        )
        for count, mesh in meshes.items():
            out.rows += judged(mesh["said"], truths.references, body, count)
        return out


def scene_of(seed: int) -> Scene:
    """Random shaft with two points."""
    return with_second_point(random_scene(seed), seed)


def sort_of(name: str) -> str:
    """Kind of term."""
    term = Quantity(name)
    if term.pair:
        soft = term.kind == COMPLIANCE
        return "compliance between two points" if soft else "stiffness, both held"
    return "at the second point" if term.points else "at the main point"


def solutions(scene: Scene, most: int | None = None) -> dict[int, dict]:
    """Static quantities of the harmonic solid on every mesh that has bars, by the number of the
    mesh, and the processor time until then.
    """
    out: dict[int, dict] = {}
    meshes, start = iter(range(1, 100)), time.process_time()

    def keep(one: Solution) -> None:
        count = next(meshes)
        if bars := one.error_bars.get(SCENE):
            said = _statics(one.quantities, bars)
            out[count] = {"said": said, "seconds": time.process_time() - start}

    study(scene, "harmonic", evidence=False, counted=False, most=most, keep=keep)
    return out


def _statics(values: Values, bars: dict) -> list[Said]:
    names = [q for q in bars if q in values and not q.is_frequency and not q.repeats]
    return [Said(q, values[q], bars[q].width, size(values, q)) for q in names]


def judged(said: list[Said], references: dict[str, Reference], body: str, mesh: int) -> list[Row]:
    """Bars held against the truth, those without one left out."""
    out = []
    for one in said:
        tags = {"mesh": f"{mesh}", "of": sort_of(one.quantity)}
        row = held(
            one, truth_of(one.quantity, one.value, references), body=body, tags=tags, rule=DECIDED
        )
        out += [row] * (row.error is not None)
    return out
