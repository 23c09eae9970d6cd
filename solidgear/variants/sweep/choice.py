"""The mesh of a sweep: the cheapest whose error bars are within a tolerance for all bearings.

The error of a mesh depends on the bearings: the stiffer they are, the more of the compliance is
the shaft's.  So the mesh is judged on the scene and at both ends of everything that varies, and the
finest that one of these needs serves all.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import Quantity, SceneError, Settled, bars_of_modes, build, modes, settle
from solidgear.variants.sweep.bench import surface

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.judge.refinement import Progress
    from solidgear.variants.sweep.bearing_variants import BearingVariants

#: bearing sets, beside that of the scene, on which a mesh is judged
MOST = 8
#: modes beyond those of a row, which error bars of the last of a family need
SPARE = 6


def settled_for_sweep(
    variants: BearingVariants,
    tol: float | None = None,
    *,
    progress: Progress = lambda _: None,
) -> Settled:
    """Return the cheapest body whose error bars are within a tolerance on the scene and at the ends
    of a sweep: the finest mesh that one of these bearing sets needs, with the largest error bar of
    each quantity over all of them. The tolerance is relative, that of the scene by default.

    Examples
    --------
    >>> from solidgear.variants.sweep.bearing_variants import bearing_variants
    >>> scales = ["bearing.A.scale=log:0.1:10:9"]
    >>> variants = bearing_variants("geometry/shaft_stepped.toml", scales)
    >>> settled = settled_for_sweep(variants, 0.05)
    >>> settled.judged_on, settled.reached
    (3, True)
    """
    scenes = [variants.scene, *_ends(variants)]
    each: list[Settled] = []
    last: dict[Hashable, Settled] = {}
    for k, scene in enumerate(scenes, start=1):
        numbered = partial(_numbered, progress, k, len(scenes))
        # bearings that sit where others did are other springs on the same body
        body = surface(scene)
        last[body] = settle(scene, tol, "all", before=last.get(body), progress=numbered)
        each.append(last[body])
    finest = max(each, key=lambda settled: settled.body.size)
    bars: dict[Quantity, float] = {}
    for settled in each:
        for quantity, bar in settled.bars.items():
            bars[quantity] = max(bar, bars.get(quantity, 0.0))
    return replace(
        finest,
        bars=bars,
        reached=all(settled.reached for settled in each),
        judged_on=len(each),
    )


def bars_of_rows(variants: BearingVariants, settled: Settled, n: int) -> dict[str, float]:
    """Return relative error bars of the numbers of rows and of `n` natural frequencies by their names:
    the largest over the scene and the ends of a sweep, on the mesh that was settled on.
    """
    bars: dict[str, float] = {str(name): bar for name, bar in settled.bars.items()}
    everywhere: set[str] | None = None
    for scene in [variants.scene, *_ends(variants)]:
        body = build(scene, settled.rung, **settled.options)
        shapes = modes(body, scene, n + SPARE, ovalising=False)
        of_scene = {
            str(name): bar for name, bar in bars_of_modes(scene, body, shapes, settled).items()
        }
        everywhere = {*of_scene} if everywhere is None else everywhere & {*of_scene}
        for name, bar in of_scene.items():
            bars[name] = max(bar, bars.get(name, 0.0))
    assert everywhere is not None
    everywhere |= {*map(str, settled.bars)}
    return {name: bar for name, bar in bars.items() if name in everywhere and math.isfinite(bar)}


def _ends(variants: BearingVariants) -> list[Scene]:
    """Return the variants with the lowest and the highest value of every entry that varies."""
    # the ends of all at once first, then of one after the other
    ranks = variants.values.argsort(axis=0).argsort(axis=0).sum(axis=1)
    wanted = [int(ranks.argmin()), int(ranks.argmax())]
    for column in variants.values.T:
        wanted += [int(np.argmin(column)), int(np.argmax(column))]
    out: list[Scene] = []
    for index in list(dict.fromkeys(wanted))[:MOST]:
        try:
            out.append(variants.variant(index))
        except SceneError:
            continue  # its row will say why
    return out


def _numbered(progress: Progress, k: int, count: int, text: str) -> None:
    progress(f"bearing set {k} of {count}: {text}")
