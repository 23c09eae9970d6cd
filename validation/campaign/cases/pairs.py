"""Is a change of a shaft resolved only where it is one, and its sign right? Random shafts beside
themselves with one thing changed, by `compare A B`.

The truth needs no solution.  What stiffens a body or what holds it (Loewner order) lowers no
stiffness of a port, raises none of its compliances and lowers no frequency; what adds mass lowers
frequencies and leaves statics (Rayleigh; Courant and Hilbert, Methods of Mathematical Physics I,
chapter VI).
"""

from __future__ import annotations

import numpy as np

from solidgear.core.quantity import COMPLIANCE, Quantity
from solidgear.core.scene import Scene
from solidgear.two_designs.two_shafts import two_shafts
from validation.campaign.case import Case, Run
from validation.campaign.rows import CLAIM, Found, Row
from validation.campaign.scenes.shafts import between, random_scene

STIFFER, HEAVIER = "stiffer", "heavier"
#: relative size of a change, from far below the bars to far above
SMALLEST, LARGEST = 1e-9, 0.1


class Pairs(Case):
    """Signs of changes, by theorems; a bar is that of the difference."""

    name, question = "pairs", "signs of what `compare A B` resolves"
    parts = ((), ("verdict",), ("changed",))
    widths = False
    seeds = (1, 200)

    def judge(self, run: Run, seed: int) -> Found:
        return run.found(f"seed {seed}", judged, seed)


def changed(scene: Scene, seed: int) -> tuple[Scene, str, str, float]:
    """A scene with one thing stiffer or heavier, what it is, which of the two, and by how much."""
    rng = np.random.default_rng([seed, 3])
    by = between(rng, SMALLEST, LARGEST)
    held = [k for k, bearing in enumerate(scene.bearings) if np.any(bearing.stiffness)]
    what = str(rng.choice(["bearing", "modulus", "density"] if held else ["modulus", "density"]))
    if what == "bearing":
        k = int(rng.choice(held))
        bearings = list(scene.bearings)
        bearings[k] = bearings[k].scaled(1 + by)
        return scene.with_changes(bearings=tuple(bearings)), what, STIFFER, by
    segments = list(scene.segments)
    k = int(rng.integers(len(segments)))
    material = segments[k].material
    field = "E" if what == "modulus" else "density"
    other = material.with_changes(**{field: (1 + by) * getattr(material, field)})
    segments[k] = segments[k].with_changes(material=other)
    sense = STIFFER if what == "modulus" else HEAVIER
    return scene.with_changes(segments=tuple(segments)), what, sense, by


def judged(seed: int) -> Found:
    """How far each number goes the wrong way, beside the bar of its difference."""
    scene = random_scene(seed)
    other, what, sense, by = changed(scene, seed)
    rows = []
    for change in two_shafts([scene, other]).changes:
        wrong = _wrong_way(Quantity(change.name), sense, change.change.difference)
        if change.name == "mass" or wrong is None or change.change.band is None:
            continue
        rows.append(
            Row(
                body=f"seed {seed}",
                quantity=change.name,
                tags={"verdict": change.verdict, "changed": what},
                bar=change.change.band / change.scale,
                error=wrong / change.scale,
                how=f"{what} {sense} by {by:.1e}",
                rule=CLAIM,
            )
        )
    return Found(rows)


def _wrong_way(name: Quantity, sense: str, difference: float) -> float | None:
    """How far a number moved against the theorem; None where that tells nothing of it."""
    if name.is_frequency:
        against = -difference if sense == STIFFER else difference
    elif sense == HEAVIER:
        return abs(difference)
    elif name.row != name.column:
        return None
    else:
        against = difference if name.kind == COMPLIANCE else -difference
    return max(against, 0.0)
