"""Error bars of the finest mesh of a list, by the rule that the meshes allow."""

from __future__ import annotations

from collections.abc import Sequence as Listed
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

from solidgear.core.body.mode_names import BENDING, ModeName
from solidgear.core.bounds.safety import LAYERS, REFINEMENT
from solidgear.core.judge.bars import ErrorBar, left_over, shrinkage, step_bars
from solidgear.core.judge.quantities import Values, size
from solidgear.core.judge.solving import solve
from solidgear.core.ladder.meshes import HARMONIC
from solidgear.core.meshing.corners import SHOULDER, sharpest_corner
from solidgear.core.quantity import Quantity
from solidgear.core.solve.statics import condense

if TYPE_CHECKING:
    from solidgear.core.bounds.safety import Safety
    from solidgear.core.ladder.meshes import Sequence
    from solidgear.core.ladder.model import Model
    from solidgear.core.scene import Scene

#: exponent at the end of a rigid seat, a clamp on a smooth surface (Williams 1952, clamped-free at
#: 180 degrees)
RIGID_EDGE = 0.5
#: model by which changes by features are computed, on the usual mesh
PLAIN = "harmonic"


def sequence_bars(
    scene: Scene,
    plan: Sequence,
    model: Model,
    levels: Listed[Values],
    solver: Values,
    sizes: Listed[Listed[float]],
    around: Values | None = None,
    shape: float = 0.0,
) -> dict[Quantity, ErrorBar]:
    """Compute error bars of the finest of some meshes by :func:`~solidgear.core.judge.bars.step_bars`;
    empty for a single level, for meshes that are not ever finer, and for layered hexahedra beside a
    fillet or a chamfer, where no layers lead to the corners.

    The scene is tied as the levels are, which are of the plan; `sizes` are those of the cells of
    every level, m (:func:`~solidgear.core.judge.bars.sizes_of`).
    """
    if len(levels) < 2 or scene.outline.corners and plan.turned is not None:
        return {}
    safety = model.safety or (LAYERS if plan.layered else REFINEMENT)
    if plan.layered:
        effect = feature_effect(scene, safety, levels[-1])
        return step_bars(levels, solver, safety, around=around, effect=effect)
    shrunk = [shrinkage(a, b) for a, b in pairwise(sizes[-3:])]
    if 1.0 in shrunk:
        return {}
    share = left_over(shrunk[-1], sharpest(scene))
    return step_bars(levels, solver, safety, left_over=share, shape=shape)


def sharpest(scene: Scene) -> float:
    """Return the exponent of displacement at the sharpest corner: of shoulders, features and rigid
    seats.
    """
    rigid_seat = any(s.attachment == "rigid" for s in scene.stations)
    notched = any(f.notched for f in scene.features)
    return min(
        sharpest_corner(scene)[1], RIGID_EDGE if rigid_seat else 1.0, SHOULDER if notched else 1.0
    )


def feature_effect(scene: Scene, safety: Safety, values: Values) -> dict[Quantity, float]:
    """Compute the changes by features of the quantities that a model has shares of, relative and
    positive; empty where it has none.

    A bending frequency is compared with the nearest one of the plain part: features may change
    their order and their names.
    """
    if not safety.share:
        return {}
    pairs = {point for q in values for point in q.pair or ()}
    names = tuple(port.name for port in scene.ports if port.name in pairs)
    plain, bending = _plain(scene.plain, names)
    out = {}
    for name in values:
        plain_values = [plain[name]] if name in plain else []
        if name.is_frequency and ModeName(name).family == BENDING:
            plain_values = bending
        if plain_values:
            nearest = min(abs(values[name] - v) for v in plain_values)
            out[name] = float(nearest / size(values, name))
    return out


@lru_cache(maxsize=8)
def _plain(plain: Scene, points: tuple[str, ...]) -> tuple[Values, list[float]]:
    """Solve a plain part for all quantities, those between some points included, and all bending
    frequencies; every finer mesh needs them.
    """
    answer = solve(plain, PLAIN, **HARMONIC)
    bending = [
        m.frequency_hz for m in answer.modes.modes if m.family == BENDING and m.frequency_hz > 0
    ]
    coupled = condense(answer.body, plain, points) if points else None
    return answer.quantities | replace(answer.statics, coupled=coupled).values(), bending
