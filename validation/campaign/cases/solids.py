"""Do bars of a 3D solid, computed on the one mesh that was set, hold? Bodies drawn to break them and
random shafts, against the harmonic solid, which shares no mesh and no function with it.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from typing import Any

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.bounded import bounded
from solidgear.core.judge.quantities import size
from solidgear.core.judge.solving import Statics, numbers, search_modes
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.ladder.solid import AROUND, HEXAHEDRA, TETRAHEDRA, Level
from solidgear.core.machine.whole_file import whole
from solidgear.core.quantity import STIFFNESS, Quantity
from solidgear.core.scene import Scene
from validation.campaign.case import Case, Run
from validation.campaign.cases.answers import ASKED, kind_of, scene_of
from validation.campaign.rows import DECIDED, Cost, Found, Row, Truth
from validation.campaign.scenes.bodies import BODIES
from validation.campaign.truths.kept import name_of

NAMES = tuple(map(Quantity, ASKED))
FREQUENCIES = [name for name in NAMES if name.is_frequency]
#: relative error of the true values asked for
FINE = 1e-5
#: shapes that are searched for
SHAPES = 10

_LAYERED = [{**level, "around": AROUND} for level in HEXAHEDRA[:3]]
#: what is solved: by the name of an element, meshes coarse to fine
MESHES: dict[str, list[Level]] = {
    "tet10": [{"refinement": 0.2}, {"refinement": 0.3}, TETRAHEDRA[0]],
    "hex20": _LAYERED,
    "hex27": _LAYERED[:1],
}
LOWER = "lower side"


class Solids(Case):
    """Every number of a mesh: its bar about the middle, and the least by which a compliance grows
    (`lower side`, the error in place of the bar, the growth in place of the error).
    """

    name, question = "solids", "bars of a 3D solid on one mesh that was set"
    parts = ((), ("element",), ("kind",), ("element", "kind"))
    details = (("element", "mesh"), ("quantity",))
    seeds = (99101, 99130)
    tag_of_costs = "stage"

    def options(self, parser: argparse.ArgumentParser) -> None:
        add = parser.add_argument
        add("--words", nargs="*", help="drawn bodies whose names have one of these words")
        add("--no-drawn", action="store_true", help="leave the drawn bodies out")
        add("--no-random", action="store_true", help="leave the random shafts out")
        add("--elements", nargs="+", default=list(MESHES), choices=list(MESHES))
        add("--limit", type=int, default=30_000, help="unknowns of a mesh")

    def bodies(self, given: argparse.Namespace) -> list[tuple[str]]:
        words = given.words or [""]
        drawn = [name for name in BODIES if any(word in name for word in words)]
        first, last = given.seeds
        random = [f"random {seed}" for seed in range(first, last + 1)]
        chosen = drawn * (not given.no_drawn) + random * (not given.no_random)
        return [(name,) for name in chosen]

    def judge(self, run: Run, body: str) -> Found:
        scene = scene_of(body)
        truths, problem = _kept_truths(run, scene)
        if problem:
            return Found(problems=[f"{body}: {problem}"])
        out = Found()
        for element in run.given.elements:
            for density, level in enumerate(MESHES[element], start=1):
                options = {"element": element, **level}
                tags = {"element": element, "mesh": str(density)}
                found, problem = run.call(judged, body, options, tags, truths, run.given.limit)
                if problem:
                    out.problems.append(f"{body}, {element} {density}: {problem}")
                    continue
                out.add(found)
        return out


def _kept_truths(run: Run, scene: Scene) -> tuple[dict[str, Truth], str]:
    """True values of a scene, kept under what it is, or why there are none."""
    path = run.folder / "references" / f"answer-{name_of(scene)}.json"
    if not path.exists():
        values, problem = run.call(answered, scene)
        if problem:
            return {}, f"no reference: {problem}"
        path.parent.mkdir(parents=True, exist_ok=True)
        with whole(path) as partial:
            partial.write_text(json.dumps(values))
    values = json.loads(path.read_text())
    return {name: Truth(**value) for name, value in values.items()}, ""


# ------------------------------------------------------------------------------------------------
# - asked of a worker
def answered(scene: Scene) -> dict[str, dict]:
    """True values by their names, as plain data."""
    answer = sg.answer(scene, FINE, ask=ASKED)
    if answer.rung != "harmonic":
        raise ValueError(f"answered by the {answer.rung}")
    return {
        str(v.quantity): {"value": v.value, "uncertainty": v.bar, "size": v.size, "how": "harmonic"}
        for v in answer.values
    }


def judged(
    body: str, options: Level, tags: dict[str, str], truths: dict[str, Truth], limit: int
) -> Found:
    """Bars of one mesh, held against the truth, and what each stage cost."""
    scene, found = scene_of(body), Found()
    unknowns = int(LADDER["solid"].size(scene, options).unknowns)
    if unknowns > limit:
        raise ValueError(f"{unknowns} unknowns are more than {limit}")

    def timed(stage: str, function: Callable[..., Any], *arguments: Any, **rest: Any) -> Any:
        start = time.process_time()
        result = function(*arguments, **rest)
        spent = time.process_time() - start
        found.costs.append(Cost(body, {"stage": stage, **tags}, spent, unknowns))
        return result

    solid = timed("build", build, scene, "solid", **options)
    supports = as_supports(scene)
    statics = None
    if supports.ports:
        statics = timed("statics", Statics.for_quantities, scene, solid, supports, NAMES)
    modes = timed("modes", search_modes, solid, supports, SHAPES, FREQUENCIES, spare=True)
    values = numbers(statics, modes)
    names = [name for name in NAMES if name in values.quantities]
    given = (scene, solid, supports, statics, modes, names, values.solver)
    bars = timed("estimate", bounded, *given).error_bars
    for name in (name for name in names if name in bars and str(name) in truths):
        scale, truth = size(values.quantities, name), truths[str(name)]
        rows = rows_of(name, values.quantities[name], bars[name], scale, truth)
        for kind, *sizes in rows:
            bar, error = map(float, sizes)
            found.rows.append(
                Row(
                    body=body,
                    quantity=str(name),
                    tags={**tags, "kind": kind, "quantity": str(name)},
                    bar=bar,
                    error=error,
                    doubt=truth.uncertainty,
                    how=f"{truth.how}, {unknowns} unknowns",
                    rule=DECIDED,
                )
            )
    return found


def rows_of(
    name: Quantity, value: float, bar: ErrorBar, scale: float, truth: Truth
) -> list[tuple[str, float, float]]:
    """Kind, bar and error of a number about the middle of both its ends; and of one that grows with
    every function the whole error as a limit of its least growth.
    """
    if bar.middle is None:
        return [(kind_of(str(name)), bar.width, (value - truth.value) / scale)]
    out = [(kind_of(str(name)), bar.about_middle, (bar.middle - truth.value) / scale)]
    if name.diagonals is None:
        far = value + bar.factor * (bar.extrapolated - value)
        sign = -1.0 if name.kind == STIFFNESS else 1.0
        least = sign * (2 * bar.middle - far - value) / scale
        out.append((LOWER, sign * (truth.value - value) / scale, least))
    return out
