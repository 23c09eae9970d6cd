"""Compliance of teeth in plane strain beside rings solved as a whole and figures from elsewhere."""

from math import pi, radians

import numpy as np
import pytest
from skfem import ElementQuad2
from skfem.quadrature import get_quadrature
from skfem.refdom import RefQuad

from solidgear.core.errors import SolidgearError
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.kernel.assembly import tabulate
from solidgear.teeth.compliance.mesh import Fineness, pitch_mesh

PINION, WHEEL, RING = Wheel(23, 4e-3), Wheel(57, 4e-3), Wheel(-60, 2e-3)


def hold(wheel, modules=4.0):
    """Radius some modules below the root."""
    return wheel.root - wheel.sign * modules * wheel.module


def area(wheel, mesh):
    """Area of the cells, m2."""
    points, weights = get_quadrature(RefQuad, 6)
    nodes = mesh.points[mesh.cells].transpose(2, 1, 0)
    return float((tabulate(ElementQuad2(), nodes, ElementQuad2(), points).det @ weights).sum())


def polygon(wheel, radius):
    """Area of a pitch between its contour and a circle, by a polygon of many corners, m2."""
    fillet = wheel.fillet(4001)
    flank, _ = wheel.flank_points(np.linspace(wheel.form, wheel.tip, 4001))
    x, y = np.concatenate([fillet, flank]).T
    angle = np.arctan2(x, y)
    r = np.hypot(x, y)
    # the contour as r over the angle from the middle of the tooth; land and tip are arcs
    half = np.sum((r[1:] ** 2 + r[:-1] ** 2) / 4 * -np.diff(angle))
    half += wheel.root**2 / 2 * (pi / wheel.count - angle[0]) + wheel.tip**2 / 2 * angle[-1]
    return abs(2 * half - radius**2 * pi / wheel.count)


@pytest.mark.parametrize(
    "wheel",
    [
        PINION,
        RING,
        Wheel(10, 4e-3),
        Wheel(17, 4e-3, radians(30), 0.3),
        Wheel(216, 4e-3, rack=Rack(root_radius=0.02)),
        Wheel(-40, 4e-3, shift=0.3),
    ],
    ids=["pinion", "ring", "undercut", "helical", "sharp", "shifted ring"],
)
def test_mesh_of_a_pitch(wheel):
    radius = hold(wheel, 2.0)
    mesh = pitch_mesh(wheel, radius)
    # curved by parabolas through nodes on the contour
    assert area(wheel, mesh) == pytest.approx(polygon(wheel, radius), rel=2e-5)
    finer = pitch_mesh(wheel, radius, Fineness().finer(2))
    assert area(wheel, finer) == pytest.approx(polygon(wheel, radius), rel=1e-6)
    on_flank, _ = wheel.flank_points(mesh.radii)
    assert mesh.points[mesh.flank] == pytest.approx(on_flank, abs=1e-15)
    assert mesh.radii[[0, -1]] == pytest.approx([wheel.form, wheel.tip], rel=1e-14)
    c, s = np.cos(wheel.pitch_angle), np.sin(wheel.pitch_angle)
    turned = mesh.points[mesh.sides[0]] @ np.array([[c, -s], [s, c]])
    assert mesh.points[mesh.sides[1]] == pytest.approx(turned, abs=1e-14 * wheel.root)
    assert np.hypot(*mesh.points[mesh.circle].T) == pytest.approx(radius, rel=1e-14)


def test_shapes_without_a_mesh_are_refused():
    with pytest.raises(SolidgearError, match="no thickness"):
        pitch_mesh(PINION, PINION.root)
    with pytest.raises(SolidgearError, match="no thickness"):
        pitch_mesh(RING, RING.root - 1e-3)
    with pytest.raises(SolidgearError, match="pointed"):
        pitch_mesh(Wheel(6, 4e-3, shift=0.7), 5e-3)
