"""Scenes through `compare`, `check` and the reference, one line of JSON each: resumable, and kept
apart by version of the product.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from solidgear.errors import SolidgearError
from solidgear.judge.quantities import size
from solidgear.scene import Scene
from validation.attack import judge
from validation.attack.outcome import SOLIDS, outcome, stamp
from validation.attack.reference import FOLDER, Reference, reference, section_ties
from validation.attack.scenes import random_scene, traits
from validation.attack.worker import Worker

#: a reference finer than this is not asked for: solver noise
FINEST = 1e-8
#: what is run: name -> (models, builder settings, whether `check` is asked too)
LANES = {
    "all": (("lumped", "euler", "timoshenko", "harmonic"), None, True),
    "hex20": (("solid",), None, False),
    "tet10": (("solid",), {"solid": {"element": "tet10"}}, False),
}


def run(seed: int, tolerance: float | None, lane: str) -> dict:
    """Outcome of one seed; the job of a worker."""
    models, settings, check = LANES[lane]
    start = time.perf_counter()
    try:
        out = outcome(scene_of(seed, tolerance), models, settings, check)
    except SolidgearError as error:
        out = {"refused": str(error)}
    return out | {"wall": time.perf_counter() - start}


def scene_of(seed: int, tolerance: float | None) -> Scene:
    """The scene of a seed, with another tolerance if one is given."""
    scene = random_scene(seed)
    return (
        scene
        if tolerance is None
        else scene.with_changes(ask=scene.ask.with_changes(tolerance=tolerance))
    )


def collect(
    seeds,
    tolerance: float | None,
    lane: str,
    seconds: float,
    tell: Callable[[str], None],
    folder: Path = FOLDER.parent,
) -> list[dict]:
    """Outcomes of all seeds, from the file as far as they are there; Ctrl-C gives what there is."""
    path = folder / f"outcomes-{lane}-{tolerance or 'own'}-{stamp()}.jsonl"
    folder.mkdir(parents=True, exist_ok=True)
    done = {row["seed"]: row for row in _rows(path)}
    worker = Worker(run, seconds)
    try:
        for k, seed in enumerate(seeds):
            if seed in done:
                continue
            done[seed] = {"seed": seed, "lane": lane, "tolerance": tolerance} | worker.run(
                seed, tolerance, lane
            )
            with path.open("a") as file:
                file.write(json.dumps(done[seed]) + "\n")
            problem = problem_of(done[seed])
            spent = done[seed].get("wall", seconds)
            tell(f"{lane}: {k + 1} of {len(seeds)}, seed {seed}, {spent:.1f} s {problem}")
    except KeyboardInterrupt:
        tell("interrupted; judging what there is")
    finally:
        worker.close()
    return [done[seed] for seed in seeds if seed in done]


def problem_of(row: dict) -> str:
    """Why an outcome cannot be judged, in a line; empty where it can."""
    told = row.get("crash") or row.get("refused") or ""
    return told.strip().splitlines()[-1] if told else ""


def _rows(path: Path) -> Iterator[dict]:
    for text in path.read_text().splitlines() if path.exists() else ():
        try:
            yield json.loads(text)
        except json.JSONDecodeError:
            continue  # a line cut off by a kill is run again


def truth_for(row: dict, ties: str = "scene") -> Reference | None:
    """The reference of an outcome's scene, fine enough for its bands; with section ties
    everywhere if asked.

    What is judged are bands of the solids, which ask for a tenth of each, and verdicts, for which
    a hundredth of the tolerance will do.
    """
    scene = scene_of(row["seed"], row["tolerance"])
    goal = dict.fromkeys(judge.JUDGED, scene.ask.tolerance / 100)
    if ties == "section":
        return reference(section_ties(scene), goal)
    for model in SOLIDS:
        found = row.get("models", {}).get(model, {})
        for name, band in found.get("bands", {}).items():
            goal[name] = min(
                goal.get(name, 1.0), max(0.1 * band / size(found["values"], name), FINEST)
            )
    return reference(scene, goal)


def described(row: dict) -> dict:
    """Traits of an outcome's scene."""
    return traits(scene_of(row["seed"], row["tolerance"]))
