"""Bands of the finest mesh of a sequence, by the rule that its meshes allow."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence as Listed
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

from solidgear.evidence.answer import solve
from solidgear.evidence.bands import Band, layered_bands, refined_bands, rough_bands
from solidgear.evidence.quantities import AT, measure, measure_across, points_of, size
from solidgear.fidelity.edges import (
    acute,
    beside_a_step,
    chamfered_roots,
    crowded,
    is_plate,
    sharpest_edge,
    steepest_kink,
    thin_walled,
)
from solidgear.fidelity.ladder import LADDER
from solidgear.meshing.corners import SHOULDER, sharpest_corner
from solidgear.scene.coned import coned
from solidgear.solve.statics import condense

if TYPE_CHECKING:
    from solidgear.fidelity.levels import Sequence
    from solidgear.fidelity.rung import BandFactors
    from solidgear.scene import Scene

#: exponent at the end of a rigid seat, a clamp on a smooth surface (Williams 1952, clamped-free at
#: 180 degrees)
RIGID_EDGE = 0.5
#: kinds of features with right-angled re-entrant corners, where the meridian has none: teeth end at
#: the next segment or in its face, holes and keyways have a bottom
NOTCHED = frozenset({"teeth", "spline", "bolt_circle", "keyway", "flat"})
#: bands of shafts with acute cells, over those of others: of some 50 wild shafts, each solved on
#: other meshes too and once finer (validation/attack/twins.py), ten had errors of up to 5 times
#: their band, all of them in discs that are all cone or beside a narrow notch
ACUTE = 8.0
#: the same where a cone rises from a cylinder, over its rise: cones of 20, 45, 65 and 75 degrees have
#: 0.23, 0.15, 0.28 and 0.45 of the last step after three meshes
KINK = 0.75
#: the same of a chamfer in a shoulder that no cone could stand for: against the same outline as a
#: cone, compliances of nine shafts erred by 2.2 to 6 times their bands
CHAMFERED = 8.0
#: the same of one that is meshed as a cone: three shafts erred by 0.7 times the bars of other shoulders
#: at most, one with a chamfer of 60 degrees and half the diameter by 1.7 times on the third mesh
CONED = 2.0
#: the same beside a step: a seat that ends 0.01 to 0.1 mm from the shoulder of a 40 mm shaft has 1.1
#: to 1.4 times the error over its last step of one that ends there, a random shaft 1.44 times its bar
BESIDE = 1.5
#: least band of a plate: rounding of what thin cells resist takes up to 7e-7 of the modes of a disc of
#: 0.006 diameters, on meshes whose steps are a tenth of it
PLATE_LEAST = 2e-6
#: bands of pairs up to which a step counts twice, by place: steps as small as that may be accidents
ACCIDENT = (1e-4, 1e-5, 1e-6, 1e-7)
#: least share of a pair's changes of both diagonal entries that the change of a coupling counts for: of
#: 55 random shafts and ten of strangers 0.2 left out five couplings, by 5 to 26 %
PAIR_DIAGONAL = 0.35
#: least factors of the first pairs where a wall is a shell: tubes of walls of 0.02 and 0.05 radii left
#: 0.88 and 0.78 of a step. Their cells are as short as layers anyway, so that both meshes are one
SHELL = (1.1, 1.1)
#: mesh of the plain part, coarse to fine: good to some 1e-4, of which shares are taken
PLAIN_MESH = 1


def sequence_bands(
    scene: Scene,
    plan: Sequence,
    factors: BandFactors,
    levels: Listed[Mapping[str, float]],
    solver: Mapping[str, float],
    sizes: Listed[float | None],
    around: Mapping[str, float] | None = None,
) -> dict[str, Band]:
    """Bands of the finest of some meshes.

    Parameters
    ----------
    scene : Scene
        Tied as the levels are.
    plan : Sequence
        That the meshes are of: layered ones and rough ones have bands from two levels on, others
        from three.
    factors : BandFactors
        Of the rung.
    levels : sequence of mappings
        Quantity to value, coarse to fine.
    solver : mapping
        Relative error the solver may have left in the finest level.
    sizes : sequence of float
        Representative size of the cells of every level, m.
    around : mapping, optional
        Relative error that the cells around leave.

    Returns
    -------
    dict of str to Band
        Empty where there are too few levels (of tetrahedra below three, of sectors below two), or
        they are not ever finer; and for layered hexahedra beside a fillet or a chamfer, where no
        factors of bands hold.
    """
    if scene.corners and plan.turned is not None:  # what only layered hexahedra have
        return {}
    if plan.layered:
        if len(levels) < 2:
            return {}
        cones = coned(scene)  # as the harmonic solid is meshed
        edge = sharpest_edge(cones)
        effect = feature_effect(scene, factors, levels[-1])
        found = layered_bands(levels, solver, factors, edge=edge, around=around, effect=effect)
        return _widened(scene, cones, found)
    last = [size or 0.0 for size in sizes[-3:]]
    least = 2 if factors.rough else 3
    if len(levels) < least or not all(a > b > 0 for a, b in zip(last, last[1:])):
        return {}
    held = any(s.attachment == "rigid" for s in scene.stations)
    notched = bool({f.kind for f in scene.features} & NOTCHED)
    exponent = min(
        sharpest_corner(scene)[1], RIGID_EDGE if held else 1.0, SHOULDER if notched else 1.0
    )
    if factors.rough:
        return rough_bands(levels, solver, last, exponent, factors.rough)
    return refined_bands(levels, solver, last, exponent, singular=factors.singular)


def pair_bands(
    scene: Scene,
    factors: BandFactors,
    pair: int,
    orders: Listed[Mapping[str, float]],
    solver: Mapping[str, float],
) -> dict[str, Band]:
    """Bands of the higher of two orders on one mesh.

    Parameters
    ----------
    scene : Scene
    factors : BandFactors
        Of the rung.
    pair : int
        Place of the mesh among :data:`solidgear.fidelity.levels.PAIRS`.
    orders : (mapping, mapping)
        Quantity to value, of the lower order and of the higher one.
    solver : mapping
        Relative error the solver may have left with the higher order.

    Returns
    -------
    dict of str to Band
    """
    cones = coned(scene)
    edge = sharpest_edge(cones)
    usual = factors.same_mesh[edge][pair]
    if thin_walled(scene) and pair < len(SHELL):
        usual = max(usual, SHELL[pair])
    usual *= BESIDE if crowded(scene) else 1.0
    small = ACCIDENT[min(pair, len(ACCIDENT) - 1)]
    own = replace(factors, first={edge: (2 * usual, small, usual)}, first_of_modes={})
    found = layered_bands(orders, solver, own, edge=edge, diagonal=PAIR_DIAGONAL)
    return _widened(scene, cones, found)


def _widened(scene: Scene, cones: Scene, found: dict[str, Band]) -> dict[str, Band]:
    """Bands of a shaft as wide as its cells ask for; ``cones``: the shaft as it is meshed."""
    more = _widening(cones) * (CONED if cones is not scene else 1.0)
    least = PLATE_LEAST if is_plate(scene) else 0.0
    return {
        name: replace(band, gci=max(more * band.gci, least), factor=more * band.factor)
        for name, band in found.items()
    }


def _widening(scene: Scene) -> float:
    """Bands of a shaft over those of others with the same sharpest edge."""
    more = ACUTE if acute(scene) else max(1.0, KINK * steepest_kink(scene))
    more *= BESIDE if beside_a_step(scene) else 1.0
    return more * (CHAMFERED if chamfered_roots(scene) else 1.0)


def feature_effect(
    scene: Scene, factors: BandFactors, values: Mapping[str, float]
) -> dict[str, float]:
    """What features change of the quantities that a rung has shares of.

    Parameters
    ----------
    scene : Scene
        With features.
    factors : BandFactors
        Of the rung.
    values : mapping
        What it says of the quantities.

    Returns
    -------
    dict of str to float
        Relative and positive; empty where the rung has no shares. A bending frequency is held
        against the nearest one of the plain part: features may change their order and their names.
    """
    asked = [q for q in values if q.partition(AT)[0] in factors.effect]
    if not asked:
        return {}
    pairs = {point for q in asked for point in points_of(q) or ()}
    both = tuple(port.name for port in scene.ports if port.name in pairs)
    plain, bending = _plain(scene.plain, factors.plain, both)
    out = {}
    for name in asked:
        known = bending if name.startswith("bending") else [plain[name]] if name in plain else []
        if known:
            out[name] = float(min(abs(values[name] - v) for v in known) / size(values, name))
    return out


@lru_cache(maxsize=8)
def _plain(
    plain: Scene, rung: str, points: tuple[str, ...]
) -> tuple[dict[str, float], list[float]]:
    """Quantities of a plain part, those between some points included, and all bending frequencies;
    every finer mesh asks for them.
    """
    meshes = LADDER[rung].meshes
    assert meshes is not None  # of a solid
    found = solve(plain, rung, **meshes({}).levels[PLAIN_MESH])
    bending = [m.frequency_hz for m in found.modes.modes if m.name.startswith("bending")]
    coupled = condense(found.body, plain, points) if points else None
    across = measure_across(found.further, coupled)
    return found.quantities | measure(None, None, None, coupled) | across, bending
