"""Do the bars of terms between two points hold? Random shafts with a second lumped point, against
the over-refined harmonic solution.

    python -m validation.attack.points [--scenes 24] [--seed 1]

Every mesh that the harmonic solid of a comparison climbs over is judged, not the last one alone, and
beside the terms between points those of the second point, and stiffnesses with both points held.
"""

from __future__ import annotations

import argparse
import time
from collections import defaultdict
from collections.abc import Callable, Iterable

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.judge.quantities import AT, points_of, repeats, size
from solidgear.judge.solution import Solution
from solidgear.judge.study import study
from solidgear.judge.ties import SCENE
from solidgear.scene import Scene
from validation.attack.campaign import FINEST
from validation.attack.judge import Band, band_of, rate
from validation.attack.reference import MOST_UNKNOWNS, Reference, reference
from validation.attack.scenes import random_scene, with_second_point

#: what a name is a term of, in the order of the table
BETWEEN, HELD, SECOND, MAIN = (
    "compliance between two points",
    "stiffness, both points held",
    "at the second point",
    "at the main point",
)
#: a reference that is known worse than this share of a band is refined
SHARE = 0.1
#: that are climbed at most: beyond, a reference costs minutes
MESHES = 3


def scene_of(seed: int) -> Scene:
    """Random shaft with two points."""
    return with_second_point(random_scene(seed), seed)


def sort_of(name: str) -> str:
    """What a quantity is a term of."""
    if points_of(name):
        return BETWEEN if name.startswith("C_") else HELD
    return SECOND if AT in name else MAIN


def solutions(scene: Scene, most: int | None = None) -> dict[int, Solution]:
    """The harmonic solid on every mesh that has bands, by the number of the mesh."""
    kept: list[Solution] = []
    study(scene, "harmonic", evidence=False, counted=False, most=most, keep=kept.append)
    return {k: one for k, one in enumerate(kept, start=1) if one.bands.get(SCENE)}


def judged(found: Solution, truth: Reference) -> list[Band]:
    """Bands of static quantities, held against the truth."""
    bands, values = found.bands[SCENE], found.quantities
    names = [q for q in bands if q in values and q.startswith(("C_", "K_")) and not repeats(q)]
    model = {
        "values": values,
        "bands": {name: bands[name].gci * size(values, name) for name in names},
    }
    out = [band_of(name, model, truth) for name in names]
    return [band for band in out if band is not None]


def truth_of(scene: Scene, found: Iterable[Solution], **rest) -> Reference | None:
    """The over-refined solution, fine enough to judge these bands by."""
    goal: dict[str, float] = {}
    for one in found:
        for name, band in one.bands[SCENE].items():
            goal[name] = min(goal.get(name, 1.0), max(SHARE * band.gci, FINEST))
    return reference(scene, goal, **rest)


def campaign(
    seeds: Iterable[int],
    limit: int = MOST_UNKNOWNS,
    most: int = MESHES,
    tell: Callable[[str], None] = print,
) -> dict[tuple[str, int], list[Band]]:
    """Bands of all scenes by what they are of and the number of the mesh."""
    out: dict[tuple[str, int], list[Band]] = defaultdict(list)
    for seed in seeds:
        start = time.process_time()
        try:
            scene = scene_of(seed)
            found = solutions(scene, most)
            truth = truth_of(scene, found.values(), limit=limit)
        except SolidgearError as error:
            tell(f"seed {seed}: {error}")
            continue
        if truth is None:
            tell(f"seed {seed}: no reference within {limit} unknowns")
            continue
        for count, one in found.items():
            for band in judged(one, truth):
                out[sort_of(band.quantity), count].append(band)
                if band.judged and not band.held:
                    tell(
                        f"seed {seed} ({scene.title}), mesh {count}, {band.quantity}: "
                        f"band {band.band:.1e}, error {band.error:+.1e} +- {band.doubt:.0e}"
                    )
        tell(f"seed {seed}: {scene.title}, {time.process_time() - start:.1f} s of processor time")
    return out


def table(bands: dict[tuple[str, int], list[Band]]) -> list[str]:
    """Markdown: share held and how tight, by what is judged and the mesh that tells it."""
    out = [
        "| bars | mesh | held | band / error, median | 5 % | 95 % | largest band | not judged |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    order = (BETWEEN, HELD, SECOND, MAIN)
    for sort, count in sorted(bands, key=lambda key: (key[1], order.index(key[0]))):
        mine = [band for band in bands[sort, count] if band.judged]
        if not mine:
            continue
        low, middle, high = np.quantile([b.band / abs(b.error) for b in mine], [0.05, 0.5, 0.95])
        held = rate(sum(b.held for b in mine), len(mine))
        left = len(bands[sort, count]) - len(mine)
        largest = max(b.band for b in mine)
        out.append(
            f"| {sort} | {count} | {held} | {middle:.3g} | {low:.3g} | {high:.3g} | {largest:.1e} | {left} |"
        )
    return out


def main(arguments: list[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1, help="of the first scene")
    parser.add_argument("--limit", type=int, default=MOST_UNKNOWNS, help="unknowns of a reference")
    parser.add_argument("--meshes", type=int, default=MESHES, help="that a scene climbs at most")
    options = parser.parse_args(arguments)
    seeds = range(options.seed, options.seed + options.scenes)
    found = campaign(seeds, options.limit, options.meshes, lambda text: print(text, flush=True))
    print("\n".join(table(found)))


if __name__ == "__main__":
    main()
