"""The mesh of a sweep: the cheapest whose bars are within a tolerance wherever the sweep goes.

How much a mesh errs depends on the bearings: the stiffer they are, the more of the compliance is
the shaft's.  So the mesh is judged on the scene and at both ends of everything that varies, and the
finest that one of these needs serves all.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.errors import SceneError
from solidgear.core.judge.settle import Settled, bars_of_modes, settle
from solidgear.core.ladder import build
from solidgear.core.quantity import Quantity
from solidgear.core.solve.modes import modes
from solidgear.variants.sweep.bench import surface

if TYPE_CHECKING:
    from solidgear.core.judge.refinement import Progress
    from solidgear.core.scene import Scene
    from solidgear.variants.sweep.bearing_variants import BearingVariants

#: bearing sets, beside that of the scene, on which a mesh is judged
MOST = 8
#: modes beyond those of a row, which bars of the last of a family need
SPARE = 6


def settled_for_sweep(
    variants: BearingVariants,
    tol: float | None = None,
    *,
    progress: Progress = lambda _: None,
) -> Settled:
    """The cheapest body whose error bars are within a tolerance on the scene and at the ends of a sweep.

    The tolerance is relative, that of the scene by default. What is settled is of the finest mesh
    that one of the bearing sets needs, with the largest bar of each quantity over all of them;
    ``judged_on`` says how many there were.

    Examples
    --------
    >>> from solidgear.variants.sweep.bearing_variants import bearing_variants
    >>> scales = ["bearing.A.scale=log:0.1:10:9"]
    >>> variants = bearing_variants("geometry/shaft_stepped.toml", scales)
    >>> found = settled_for_sweep(variants, 0.05)
    >>> found.judged_on, found.reached
    (3, True)
    """
    scenes = [variants.scene, *_ends(variants)]
    found: list[Settled] = []
    last: dict[Hashable, Settled] = {}
    for k, one in enumerate(scenes, start=1):
        told = _numbered(progress, k, len(scenes))
        # bearings that sit where others did are other springs on the same body
        own = settle(one, tol, "all", before=last.get(surface(one)), progress=told)
        last[surface(one)] = own
        found.append(own)
    finest = max(found, key=lambda settled: settled.body.size)
    bars: dict[Quantity, float] = {}
    for settled in found:
        for quantity, bar in settled.bars.items():
            bars[quantity] = max(bar, bars.get(quantity, 0.0))
    return replace(
        finest,
        bars=bars,
        reached=all(settled.reached for settled in found),
        judged_on=len(found),
    )


def bars_of_rows(variants: BearingVariants, settled: Settled, n: int) -> dict[str, float]:
    """Relative bars of the numbers of rows by their names, those of `n` natural frequencies with them:
    the largest over the scene and the ends of a sweep, on the mesh that was settled on.
    """
    bars: dict[str, float] = {str(name): bar for name, bar in settled.bars.items()}
    judged = [variants.scene, *_ends(variants)]
    known: list[set[str]] = []
    for one in judged:
        body = build(one, settled.rung, **settled.options)
        told = bars_of_modes(one, body, modes(body, one, n + SPARE, ovalising=False), settled)
        known.append({*map(str, told)})
        for name, bar in told.items():
            bars[str(name)] = max(bar, bars.get(str(name), 0.0))
    everywhere = set.intersection(*known) | {*map(str, settled.bars)}
    return {name: bar for name, bar in bars.items() if name in everywhere and math.isfinite(bar)}


def _ends(variants: BearingVariants) -> list[Scene]:
    """Scenes of the variants with the lowest and the highest value of everything that varies."""
    # the ends of all at once first, then of one after the other
    ranks = variants.values.argsort(axis=0).argsort(axis=0).sum(axis=1)
    wanted = [int(ranks.argmin()), int(ranks.argmax())]
    for column in variants.values.T:
        wanted += [int(np.argmin(column)), int(np.argmax(column))]
    out: list[Scene] = []
    for index in list(dict.fromkeys(wanted))[:MOST]:
        try:
            out.append(variants.of(index))
        except SceneError:
            continue  # its row will say why
    return out


def _numbered(progress: Progress, k: int, count: int) -> Progress:
    return lambda text: progress(f"bearing set {k} of {count}: {text}")
