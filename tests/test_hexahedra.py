"""The O-grid of hexahedra: exact volume, conforming, right-handed."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree
from shafts import NASTY, shaft
from skfem.quadrature import get_quadrature

import solidgear as sg
from solidgear.core.meshing.grading import Grading
from solidgear.core.meshing.hexahedra import hexahedra
from solidgear.core.meshing.layout import layout
from solidgear.core.meshing.quality import MeshError

GEOMETRY = Path(__file__).parent.parent / "geometry"
PLAN = {"size": 0.03, "layers": 1, "edge_layers": 1, "ratio": 0.35, "core": True}


def nasty():
    return shaft(*NASTY)


SCENES = {
    name: (lambda n=name: sg.load(GEOMETRY / f"{n}.toml"))
    for name in ("pinion_overhung", "shaft_hollow")
} | {"nasty": nasty}


@pytest.fixture(
    scope="module",
    params=[
        ("nasty", 8),
        ("nasty", 12),
        ("nasty", 16),
        ("shaft_hollow", 8),
        ("pinion_overhung", 12),
    ],
    ids=lambda p: f"{p[0]}-{p[1]}",
)
def case(request):
    name, around = request.param
    scene = SCENES[name]()
    mesh, segment = hexahedra(scene, layout(scene, Grading(**PLAN)), around)
    return scene, around, mesh, segment


def integrals(mesh):
    """Jacobian determinants, volumes and polar second moments of volume of all elements."""
    points, weights = get_quadrature(
        mesh.refdom, 9
    )  # det J r^2 of triquadratic hexahedra: degree 5 + 4 in each direction
    mapping = mesh.mapping()
    det = mapping.detDF(points)
    x = mapping.F(points)
    return det, det @ weights, (det * (x[0] ** 2 + x[2] ** 2)) @ weights


def frustum(s, power):
    """Integral of r^power over the length, closed form, bore taken off."""
    n = power
    return (
        s.length
        / (n + 1)
        * sum(
            sign * sum(a ** (n - k) * b**k for k in range(n + 1))
            for sign, a, b in ((1, s.outer0, s.outer1), (-1, s.inner0, s.inner1))
        )
    )


def test_volume_is_exact_segment_by_segment(case):
    scene, _, mesh, segment = case
    _, volume, _ = integrals(mesh)
    assert volume.min() > 0
    for k, s in enumerate(scene.segments):
        # circles of piecewise quadratics with the area of the true circle, cones straight: rounding
        # (measured 2e-14)
        assert volume[segment == k].sum() == pytest.approx(np.pi * frustum(s, 2), rel=1e-12)


def test_polar_inertia_closes_with_the_eighth_power_of_the_cells_around(case):
    scene, around, mesh, segment = case
    _, _, polar = integrals(mesh)
    # with the area exact, what is left of the quadratic circle is of high order:
    # measured 2.55e-7, 1.03e-8 and 1.04e-9 of every section, bores and cones alike
    limit = {8: 2.6e-7, 12: 1.1e-8, 16: 1.1e-9}[around]
    for k, s in enumerate(scene.segments):
        assert abs(polar[segment == k].sum() / (np.pi / 2 * frustum(s, 4)) - 1) < limit


def test_conforming(case):
    scene, around, mesh, _ = case
    # facets belong to one or two elements by the data structure; a mesh that is torn has nodes
    # twice in one place
    scale = min(min(s.outer0, s.outer1) for s in scene.segments)
    # the thinnest layers are some per cent of the smallest radius
    assert not cKDTree(mesh.doflocs.T).query_pairs(1e-6 * scale)
    # ... and facets inside that see only one element: then the surface would be larger than the
    # shaft's
    surface = facet_area(mesh, mesh.boundary_facets()).sum()
    # flat facets make polygons of circles: their area is 2 pi^2 / 3 / around^2 too small, their
    # circumference less so
    assert surface == pytest.approx(skin(scene), rel=7 / around**2)
    inside = np.sum(mesh.f2t[1] != -1)
    assert 2 * inside + len(mesh.boundary_facets()) == 6 * mesh.t.shape[1]


def facet_area(mesh, facets):
    a, b, c, d = np.moveaxis(mesh.p[:, mesh.facets[:, facets]], 1, 0)
    # corners of facets are sorted, so any two may be opposite: the area of the hull of four points
    # in a plane is the largest of the three quadrilaterals' cross products
    pairs = (
        np.cross(c - a, d - b, axis=0),
        np.cross(b - a, d - c, axis=0),
        np.cross(d - a, c - b, axis=0),
    )
    return np.max([np.linalg.norm(p, axis=0) for p in pairs], axis=0) / 2


def skin(scene):
    """Area of the surface, closed form."""
    first, last = scene.segments[0], scene.segments[-1]
    total = first.outer0**2 - first.inner0**2 + last.outer1**2 - last.inner1**2
    for s in scene.segments:
        total += (s.outer0 + s.outer1) * np.hypot(s.length, s.outer1 - s.outer0)
        total += (s.inner0 + s.inner1) * np.hypot(s.length, s.inner1 - s.inner0)
    for a, b in pairwise(scene.segments):
        total += abs(a.outer1**2 - b.outer0**2) + abs(a.inner1**2 - b.inner0**2)
    return np.pi * total


def test_all_nodes_lie_inside_the_inflated_shaft_and_surface_nodes_on_it(case):
    scene, around, mesh, segment = case
    half = np.pi / around
    # the quadratic through the ends and the middle of an arc encloses sin(h) (4 - cos(h)) / 3 per h
    # of the unit circle's sector
    inflate = np.sqrt(half / (np.sin(half) * (4 - np.cos(half)) / 3))
    r, y = np.hypot(mesh.doflocs[0], mesh.doflocs[2]), mesh.doflocs[1]
    for s in scene.segments:
        inside = (y > s.y0 + 1e-9) & (y < s.y1 - 1e-9)
        inner, outer = np.array([s.radius_at(v) for v in y[inside]]).T
        # rounding
        assert np.all(r[inside] <= outer * inflate * (1 + 1e-12))
        assert np.all(r[inside] >= inner * inflate * (1 - 1e-12))
        # every ring of nodes of this shaft has 2 * around of them on the outer surface
        on = np.abs(r[inside] - outer * inflate) < 1e-9
        assert on.sum() == 2 * around * len(np.unique(y[inside].round(9)))


@pytest.mark.parametrize("around", [4, 6, 9, 10, 14, 0, -8])
def test_numbers_around_that_fit_no_grid_are_refused(around):
    scene = shaft((0.1, 0.03, 0.03, 0.0, 0.0))
    with pytest.raises(MeshError, match="multiple of 4, at least 8"):
        hexahedra(scene, layout(scene, Grading(**PLAN)), around)


@pytest.mark.parametrize("bore", [(0.02, 0.0), (0.0, 0.02)])
def test_bore_that_closes_to_a_point_is_refused(bore):
    scene = shaft((0.1, 0.03, 0.03, *bore))
    with pytest.raises(MeshError) as caught:
        hexahedra(scene, layout(scene, Grading(**PLAN)), 8)
    assert (
        "'s0'" in str(caught.value)
        and "closes to a point" in str(caught.value)
        and "tet10" in str(caught.value)
    )
