"""Quadrilaterals cut towards corners and along lines: what is left is a mesh of the same body."""

from collections import Counter

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.meshing.corner_layers import cut_towards, side_at
from solidgear.core.meshing.grading import Grading
from solidgear.core.meshing.layout import layout
from solidgear.core.meshing.meridian import CUT_RATIO, cut_meridian, drawn_across, meridian
from solidgear.core.scene import Fillet, Port
from tests.shafts import NASTY, shaft

#: three squares around a re-entrant corner, and a slender one beside; the corner is vertex 4
POINTS = np.array(
    [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [0, 2], [1, 2], [0, 3.0], [1, 3]]
)
CELLS = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [6, 7, 9, 8]])
CORNER = 4
PLAN = Grading(layers=0, edge_layers=0, relative_size=4.0, plain=True)


def area(points):
    """Of polygons, from (..., corners, 2)."""
    x, y = points[..., 0], points[..., 1]
    return (x * np.roll(y, -1, axis=-1) - np.roll(x, -1, axis=-1) * y).sum(axis=-1) / 2


def lone_sides(cells):
    """Sides that one cell alone has."""
    sides = Counter(
        frozenset((int(a), int(b))) for cell in cells for a, b in zip(cell, np.roll(cell, -1))
    )
    assert max(sides.values()) == 2
    return [sorted(side) for side, times in sides.items() if times == 1]


def length(points, sides):
    return np.linalg.norm(np.diff(points[np.array(sides)], axis=1), axis=(1, 2)).sum()


def placed(found, cells=CELLS, points=POINTS):
    """Vertices of all pieces from their places in the parents."""
    s, t = np.moveaxis(found.local, -1, 0)
    weights = np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t], axis=-1)
    return np.einsum("mch,mhx->mcx", weights, points[cells[found.parent]])


ACROSS = (np.array([0.0, 0.5]), np.array([1.0, 2.75]))
CUTS = {"once": {CORNER: 1}, "thrice": {CORNER: 3}, "two corners of a cell": {CORNER: 2, 7: 3}}


@pytest.mark.parametrize("across", [(), ACROSS], ids=["", "lines first"])
@pytest.mark.parametrize("cuts", CUTS.values(), ids=CUTS)
def test_pieces_are_a_mesh_of_the_same_cells(cuts, across):
    found = cut_towards(CELLS, POINTS, cuts, CUT_RATIO, across)
    corners = found.points[found.corners]
    assert corners == pytest.approx(placed(found), abs=1e-15)
    # none is folded, and every parent is filled by its own
    assert area(corners).min() > 0
    filled = np.bincount(found.parent, area(corners))
    assert filled == pytest.approx(area(POINTS[CELLS]), rel=1e-13)
    # at a hanging node the long side and its halves would be there once each
    assert length(found.points, lone_sides(found.corners)) == pytest.approx(
        length(POINTS, lone_sides(CELLS)), rel=1e-13
    )
    # and the vertices of the mesh keep their numbers
    assert np.array_equal(found.points[: len(POINTS)], POINTS)


def test_every_cut_adds_two_pieces_a_cell_and_leaves_its_share_of_the_sides():
    for count in (1, 2, 4):
        found = cut_towards(CELLS, POINTS, {CORNER: count}, 0.15)
        assert len(found.parent) == len(CELLS) + 3 * 2 * count
        around = found.points[found.corners[(found.corners == CORNER).any(axis=1)]]
        away = np.linalg.norm(around - POINTS[CORNER], axis=2)
        assert away[away > 0].min() == pytest.approx(0.15**count)
        assert away.max() == pytest.approx(0.15**count * 2**0.5)


@pytest.mark.parametrize("long", [1.0, 3.0, 30.0, 1000.0])
def test_the_small_cell_at_a_corner_is_not_slender(long):
    strip = np.array([[0.0, 0.0], [long, 0.0], [long, 1.0], [0.0, 1.0]])
    found = cut_towards(np.array([[0, 1, 2, 3]]), strip, {0: 1}, 0.15)
    small = found.points[found.corners[0]]
    wide, high = np.ptp(small, axis=0)
    assert high == pytest.approx(0.15) and wide <= 5 * high
    if long <= 3:  # as long as its cell is for its width
        assert wide == pytest.approx(0.15 * long)


def test_a_line_goes_from_side_to_opposite_side_through_all_in_its_way():
    # in at the lower left, up through the first column, which is three cells high
    found = cut_towards(CELLS, POINTS, {}, 0.15, [np.array([0.25, 0.0])])
    assert sorted(found.parent) == [0, 0, 1, 2, 2, 3, 3]
    new = found.points[len(POINTS) :]
    assert new[:, 0] == pytest.approx(0.25) and sorted(new[:, 1]) == pytest.approx([0, 1, 2, 3])
    # across the row below the corner, two cells wide
    found = cut_towards(CELLS, POINTS, {}, 0.15, [np.array([1.0, 0.5])])
    assert sorted(found.parent) == [0, 0, 1, 1, 2, 3]


def test_places_on_no_side_are_refused():
    assert side_at(CELLS, POINTS, np.array([1.0, 0.25])) == (1, 4, 0.25)
    with pytest.raises(
        SolidgearError, match="across: no side of the mesh passes y = 0.5 m, r = 0.5"
    ):
        side_at(CELLS, POINTS, np.array([0.5, 0.5]))
    flat = meridian(shaft((0.1, 0.02, 0.02, 0, 0)), layout(shaft((0.1, 0.02, 0.02, 0, 0)), PLAN))
    with pytest.raises(SolidgearError, match="cuts: no corner of the mesh is at y = 0.03 m"):
        cut_meridian(flat, [(0.03, 0.02, 1)])


def test_a_line_where_there_is_one_changes_nothing():
    """Another one would leave cells without an area, and matrices without a number in them."""
    found = cut_towards(CELLS, POINTS, {}, 0.15, [np.array([1.0, 1.0])])
    assert np.array_equal(found.corners, CELLS)


# --------------------------------------------------------------------------- meridians
@pytest.fixture(scope="module")
def nasty():
    scene = shaft(*NASTY)
    return scene, meridian(scene, layout(scene, PLAN))


def corners_of(flat):
    """Every vertex with a surface on both sides, y and r."""
    return [(float(y), float(r)) for r, y in flat.points.T]


def test_a_shaft_cut_everywhere_is_still_that_shaft(nasty):
    scene, flat = nasty
    # a line across the first strip, and one along all that lies outside of a band
    r, y = flat.points[:, flat.cells[:, 0]]
    lined = drawn_across(
        flat, [(y[0] + 0.3 * (y[3] - y[0]), r[0]), (y[0], r[0] + 0.3 * (r[1] - r[0]))]
    )
    assert lined.cells.shape[1] > flat.cells.shape[1]
    cut, parent = cut_meridian(lined, [(y, r, 2) for y, r in corners_of(lined)[::3]])
    corners = cut.points.T[cut.cells.T]
    assert area(corners).min() > 0
    by_segment = np.bincount(cut.segment, area(corners))
    exact = [s.length * (s.outer0 + s.outer1 - s.inner0 - s.inner1) / 2 for s in scene.segments]
    assert by_segment == pytest.approx(exact, rel=1e-12)
    assert np.array_equal(cut.segment, lined.segment[parent])
    assert length(cut.points.T, lone_sides(cut.cells.T)) == pytest.approx(
        length(flat.points.T, lone_sides(flat.cells.T)), rel=1e-12
    )
    # cells know their surfaces: outer sides are as long as the outer surface is
    for which, (a, b) in ((cut.outer, (1, 2)), (cut.inner, (0, 3))):
        sides = cut.cells[[a, b]][:, which].T
        whole = flat.cells[[a, b]][:, flat.outer if a == 1 else flat.inner].T
        assert length(cut.points.T, sides) == pytest.approx(length(flat.points.T, whole), rel=1e-12)


def test_cells_that_share_a_side_agree_on_its_sense_or_say_so(nasty):
    _, flat = nasty
    cut, _ = cut_meridian(flat, [(y, r, 1) for y, r in corners_of(flat)])
    sense = {}
    ends = ((0, 1), (1, 2), (3, 2), (0, 3))
    for k, cell in enumerate(cut.cells.T):
        for side, (a, b) in enumerate(ends):
            key = frozenset((int(cell[a]), int(cell[b])))
            start = int(cell[b] if cut.flip[side, k] else cell[a])
            assert sense.setdefault(key, start) == start


def test_sides_on_a_fillet_stay_on_it():
    scene = shaft(
        (0.1, 0.02, 0.02, 0, 0),
        (0.1, 0.03, 0.03, 0, 0),
        port=Port(y=0.04, lo=0.03, hi=0.05),
        blends=(Fillet(name="f", y=0.1, radius=0.004),),
    )
    flat = meridian(scene, layout(scene, PLAN))
    at = np.flatnonzero(flat.arc >= 0)
    ends = ((0, 1), (1, 2), (2, 3), (3, 0))
    on = {int(v) for k in at for v in flat.cells[list(ends[flat.arc[k]]), k]}
    places = [(float(flat.points[1, v]), float(flat.points[0, v])) for v in sorted(on)]
    cut, _ = cut_meridian(flat, [(*place, 2) for place in places])
    curved = np.flatnonzero(cut.arc >= 0)
    assert len(curved) > len(at)
    for k in curved:
        own = cut.points[:, cut.cells[list(ends[cut.arc[k]]), k]]
        radius = np.linalg.norm(own - cut.centre[:, [k]], axis=0)
        assert radius == pytest.approx(0.004, rel=1e-12)
    # turned as a whole the sides make up the quarter of a circle that they were
    body, before = (
        sg.build(scene, "harmonic", order=6, layers=0, edge_layers=0, plain=True, cuts=cuts)
        for cuts in (tuple((*place, 2) for place in places), ())
    )
    assert body.mass_matrix()[0, 0] == pytest.approx(before.mass_matrix()[0, 0], rel=1e-9)
