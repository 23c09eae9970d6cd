"""Pixels of surfaces and lines: what is nearer hides, areas and colours are those of the geometry."""

import numpy as np
import pytest

from solidgear.show.raster import FINE, Aim, Canvas, facets, rgb

#: seen along -z, 10 px a metre
AIM = Aim(*np.eye(3)[[0, 1, 2]], np.zeros(3), 10.0)
NEAR = np.array([[-3.0, -2.0, 1.0], [3.0, -2.0, 1.0], [-3.0, 2.0, 1.0]])
FAR = NEAR * [1.0, 1.0, -1.0] + [2.0, 0.0, 0.0]


def canvas():
    return Canvas(100, 80, AIM)


def plain(colour):
    return np.broadcast_to(rgb(colour), (1, 3, 3)), lambda value: value


@pytest.mark.parametrize("order", [(NEAR, FAR), (FAR, NEAR)])
def test_the_nearer_surface_hides_the_other_whichever_is_drawn_first(order):
    drawn = canvas()
    for points in order:
        drawn.fill(
            points, np.array([[0, 1, 2]]), *plain("#ff0000" if points is NEAR else "#0000ff")
        )
    red, _, blue = drawn.pixels().transpose(2, 0, 1).astype(int)
    near, far = (red > blue + 100).sum(), (blue > red + 100).sum()
    # 12 m^2 of the near one; of the far one what reaches beyond it, but for pixels at the edges
    assert near == pytest.approx(1200, abs=60)
    assert far == pytest.approx(1200 - 1200 * (2 / 3) ** 2, abs=60)


def test_numbers_are_linear_over_a_triangle():
    drawn, values = canvas(), np.array([[[0.0], [1.0], [0.0]]])
    drawn.fill(NEAR, np.array([[0, 1, 2]]), values, lambda value: np.repeat(value, 3, axis=1))
    row = drawn.pixels()[55, 21:60, 0] / 255
    # the middle of pixel k is k + 0.5 px from the left edge, 20 px from the corner
    np.testing.assert_allclose(row, (np.arange(21, 60) + 0.5 - 20) / 60, atol=0.01)


def test_a_line_behind_a_surface_is_hidden_and_one_on_it_is_not():
    middle = np.array([[-2.0, -1.5, 0.5], [0.0, -1.5, 0.5]])
    for nearer, hidden in ((0.0, True), (1.0, False)):
        drawn = canvas()
        drawn.fill(NEAR, np.array([[0, 1, 2]]), *plain("#ff0000"))
        drawn.lines(middle, np.array([[0, 1]]), "#000000", 1.0, nearer=nearer)
        dark = (drawn.colour.max(axis=1) < 0.5).sum()
        assert dark == 0 if hidden else dark >= 20 * FINE


def tube(count=24):
    """A closed tube without ends, as quadrilaterals: points, faces."""
    turn = 2 * np.pi * np.arange(count) / count
    ring = np.column_stack([np.cos(turn), 0 * turn, np.sin(turn)])
    k = np.arange(count)
    faces = np.column_stack([k, (k + 1) % count, count + (k + 1) % count, count + k])
    return np.vstack([ring, ring + [0.0, 2.0, 0.0]]), faces


def test_a_tube_is_smooth_round_about_and_has_a_horizon_on_both_sides():
    points, faces = tube()
    surface = facets(points, faces, np.empty((0, 3), int))
    assert (
        len(surface.edges) == 24 and not len(surface.creases(20)) and len(surface.creases(10)) == 24
    )
    corners = points[surface.triangles] * [1.0, 0.0, 1.0]
    assert np.abs((surface.smooth(20) * corners).sum(axis=2)).min() > 0.999
    # without smoothing a corner has the normal of its face, 7.5 degrees from there
    flat = np.abs((surface.smooth(10) * corners).sum(axis=2))
    np.testing.assert_allclose(flat, np.cos(np.pi / 24), atol=1e-9)
    assert len(surface.horizon(np.array([0.1, 0.0, 1.0]))) == 2
