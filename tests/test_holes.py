"""Holes along the axis: meshes are fine beside them and nowhere else, and their size is foretold."""

import math

import numpy as np
import pytest
from test_sector import BOLTS, shaft

from solidgear.core.ladder.registry import LADDER
from solidgear.cuts.sector.body import meshed_sector, sector
from solidgear.cuts.solid.holes import FULL_SHARE, hole_of, hole_places, hole_size

SMALL = BOLTS.with_changes(count=4, diameter=0.003, depth=0.008, angle=0.3)
SCENE = shaft(SMALL)
DISC = next(s for s in SCENE.segments if s.name == SMALL.segment)


def read(formula):
    """What gmsh reads, as numpy does."""
    known = {"Sqrt": np.sqrt, "Max": np.maximum, "Min": np.minimum, "__builtins__": {}}
    return eval(f"lambda x, y, z: {formula}".replace("^", "**"), known)


def test_elements_are_fine_beside_a_hole_and_coarse_between_two():
    """On the circle of middles, an element halfway to the next hole is as large as away from holes. A
    size that did not know the angle would make the whole ring as fine as the walls.
    """
    made = meshed_sector(
        SCENE, [(s, s.attachment) for s in SCENE.stations], (SMALL,), refinement=0.3
    )
    middle = made.mesh.p[:, made.mesh.t].mean(axis=1)
    corners = made.mesh.p[:, made.mesh.t]
    edge = np.linalg.norm(corners[:, 0] - corners[:, 1], axis=0)
    lo, hi = SMALL.reach(DISC)
    ring = (
        (np.abs(np.hypot(middle[0], middle[2]) - SMALL.circle / 2) < SMALL.diameter / 2)
        & (middle[1] > lo)
        & (middle[1] < hi)
    )
    angle = np.arctan2(middle[0], middle[2]) - made.turn * (not made.half)
    # the middle of the sector is that of a hole, or of the land between two
    from_hole = np.abs(angle) if made.half else np.abs((angle - SMALL.angle) % (math.pi / 2))
    away = SMALL.circle / 2 * np.minimum(from_hole, math.pi / 2 - from_hole)
    near, far = edge[ring & (away < SMALL.diameter)], edge[ring & (away > 3 * SMALL.diameter)]
    assert len(far) and np.median(far) > 3 * np.median(near)


def test_the_nearest_hole_counts():
    """Also one beyond the border of the sector; the least edge is on every wall."""
    hole = hole_of(SMALL, DISC, 1.0)
    places = hole_places(SMALL, DISC, [], 0.0, 1.5 * math.pi / 2)
    size = read(hole_size(hole, places))
    y = (hole.lo + hole.hi) / 2
    for x, z in places:
        assert size(x, y, z + hole.radius) == pytest.approx(hole.least)
    assert len(places) > 1
    between = math.pi / 4 + math.atan2(*places[0])
    there = size(hole.circle * math.sin(between), y, hole.circle * math.cos(between))
    assert there == pytest.approx(
        hole.least + 2 * hole.circle * math.sin(math.pi / 8) - hole.radius, rel=1e-9
    )


def test_elements_at_holes_are_refined_by_the_share_they_take():
    """Eight edges at least; holes of a tenth of the section are refined as all else is."""
    eighth = math.pi * SMALL.diameter / 8
    assert hole_of(SMALL, DISC, 1.0).least == pytest.approx(eighth)
    many = SMALL.with_changes(diameter=0.015)
    share = many.count * many.diameter**2 / 4 / DISC.outer0**2
    assert share > FULL_SHARE
    assert hole_of(many, DISC, 2.0).least == pytest.approx(math.pi * many.diameter / 8 / 4)


@pytest.mark.parametrize("half", [True, pytest.param(False, marks=pytest.mark.long)])
def test_the_size_is_counted_on_the_mesh(half):
    scene = shaft(SMALL.with_changes(depth=None, diameter=0.002))
    given = {"refinement": 0.3, "half": half}
    found = LADDER["sector"].size(scene, given)
    assert found.unknowns == sector(scene, **given).size
    # the rough number that it is refused by before: most of this mesh is at its holes
    assert 1 / 4 < LADDER["sector"].rough_unknowns(scene, given) / found.unknowns < 4
