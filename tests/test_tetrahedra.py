"""Curved tetrahedra: the true volume and inertia, planes and circles kept, the same mesh every
time.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from skfem import MeshTet1, MeshTet2

from solidgear.core.meshing.quality import MeshError, check_mesh
from solidgear.core.meshing.tetrahedra import tetrahedra
from solidgear.core.scene.closed_form import mass_properties, volume_of
from solidgear.core.scene.outline import Outline


def piece(y0, y1, outer0, outer1=None, inner0=0.0, inner1=None):
    return SimpleNamespace(
        y0=y0,
        y1=y1,
        outer0=outer0,
        outer1=outer0 if outer1 is None else outer1,
        inner0=inner0,
        inner1=inner0 if inner1 is None else inner1,
        material=SimpleNamespace(density=7850.0),
    )


# a cone, a shoulder down to a solid neck, and a hollow end whose bore opens conically
SHAFT = [
    piece(-0.05, 0.0, 0.03, 0.05),
    piece(0.0, 0.06, 0.03),
    piece(0.06, 0.11, 0.03, 0.03, 0.01, 0.015),
]
PLANES = (-0.02, 0.03, 0.085)
CIRCLES = (0.02, 0.045, 0.09)


def outer_radius(s, y):
    return s.outer0 + (s.outer1 - s.outer0) * (y - s.y0) / (s.y1 - s.y0)


def inner_radius(s, y):
    return s.inner0 + (s.inner1 - s.inner0) * (y - s.y0) / (s.y1 - s.y0)


@pytest.fixture(scope="module")
def meshed():
    return tetrahedra(Outline(SHAFT), PLANES, CIRCLES, size=0.02, graded_size=0.008, around=16)


def element_volumes(mesh):
    """Volume and centre of each curved element, through scikit-fem's own mapping."""
    from skfem import Basis, ElementTetP2

    basis = Basis(mesh, ElementTetP2(), intorder=5)
    return basis.dx, basis.mapping.F(basis.X)


def test_curved_volume_is_the_closed_form(meshed):
    exact = volume_of(Outline(SHAFT))
    curved = abs(meshed.quality.volume / exact - 1.0)
    straight = abs(check_mesh(MeshTet1.from_mesh(meshed.mesh)).volume / exact - 1.0)
    # an arc over 1/16 of a circle loses a^4/30 = 5e-5 of its area, a = pi/16; gmsh's edges vary,
    # hence twice that
    assert curved < 1e-4
    # a chord loses 2a^2/3 = 2.6e-2, and only mid nodes on the true surface win it back
    assert straight > 5.0 * curved
    assert straight > 5e-4


def test_curved_inertia_is_the_closed_form(meshed):
    dx, (x, y, z) = element_volumes(meshed.mesh)
    exact = mass_properties(Outline(SHAFT))
    density = 7850.0
    mass = density * dx.sum()
    centre = density * (y * dx).sum() / mass
    # inertia goes with the fourth power of the radius: about twice the loss of the volume, hence
    # 2e-4
    assert density * ((x**2 + z**2) * dx).sum() == pytest.approx(exact.iyy, rel=2e-4)
    assert density * (((y - centre) ** 2 + z**2) * dx).sum() == pytest.approx(exact.ixx, rel=2e-4)
    # a length of 0.16 m weighted with volumes that are each right to 1e-4
    assert centre == pytest.approx(exact.centre, abs=0.16e-4)
    # round about the axis: the centre lies on it to the same measure
    assert abs((x * dx).sum()) < 1e-4 * 0.05 * dx.sum()


def test_every_plane_and_interface_is_made_of_facets(meshed):
    mesh = meshed.mesh
    for y in (*PLANES, 0.0, 0.06):
        on = np.all(np.abs(mesh.p[1][mesh.facets] - y) < 1e-9, axis=0)
        corners = mesh.p[:, mesh.facets[:, on]]
        area = (
            0.5
            * np.linalg.norm(
                np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], axis=0),
                axis=0,
            ).sum()
        )
        below = next(s for s in SHAFT if s.y0 < y <= s.y1)
        above = next((s for s in SHAFT if s.y0 <= y < s.y1), below)
        # at an interface the face covers the material of both sides: out to the larger radius, in
        # to the smaller bore
        outer = max(outer_radius(below, y), outer_radius(above, y))
        inner = min(inner_radius(below, y), inner_radius(above, y))
        # straight facets lose the segments between chord and circle; add them from the rim's own
        # edges
        area += rim_segments(mesh, y, outer) - rim_segments(mesh, y, inner)
        # then only rounding is left
        assert area == pytest.approx(np.pi * (outer**2 - inner**2), rel=1e-9)


def rim_segments(mesh, y, radius):
    """Area between the circle and the chords the mesh has on it."""
    if radius == 0.0:
        return 0.0
    on = np.isclose(np.hypot(mesh.p[0], mesh.p[2]), radius, rtol=1e-9) & (
        np.abs(mesh.p[1] - y) < 1e-9
    )
    vertices = np.intersect1d(np.flatnonzero(on), mesh.t)
    angles = np.sort(np.arctan2(mesh.p[2][vertices], mesh.p[0][vertices]))
    steps = np.diff(np.append(angles, angles[0] + 2.0 * np.pi))
    assert len(vertices) >= 16  # what `around` promises
    return 0.5 * radius**2 * (steps - np.sin(steps)).sum()


def lateral_facets(mesh):
    """Boundary facets on the outer surface: every vertex and mid node at the outer radius of one
    segment.
    """
    facets = mesh.facets[:, mesh.boundary_facets()]
    y, r = mesh.p[1][facets], np.hypot(mesh.p[0], mesh.p[2])[facets]
    found = np.zeros(facets.shape[1], bool)
    for s in SHAFT:
        inside = np.all((y > s.y0 - 1e-9) & (y < s.y1 + 1e-9), axis=0)
        # not an annular face, whose vertices share one y
        found |= (
            inside
            & np.all(np.abs(r - outer_radius(s, y)) < 1e-9, axis=0)
            & (np.ptp(y, axis=0) > 1e-6)
        )
    return facets[:, found]


def test_no_lateral_facet_straddles_a_circle(meshed):
    facets = lateral_facets(meshed.mesh)
    y = meshed.mesh.p[1][facets]
    # the lateral area proves that the facets looked at are all there are; chords of 1/16 lose 1 %
    # at most
    corners = meshed.mesh.p[:, facets]
    area = (
        0.5
        * np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], axis=0), axis=0
        ).sum()
    )
    exact = sum(
        np.pi * (s.outer0 + s.outer1) * np.hypot(s.y1 - s.y0, s.outer1 - s.outer0) for s in SHAFT
    )
    assert area == pytest.approx(exact, rel=1e-2)
    for circle in CIRCLES:
        assert not np.any((y.min(axis=0) < circle - 1e-9) & (y.max(axis=0) > circle + 1e-9))
    # the test can fail: where no circle was asked for, facets do straddle
    assert np.any((y.min(axis=0) < 0.0137) & (y.max(axis=0) > 0.0137))


def test_a_circle_makes_no_plane(meshed):
    mesh = meshed.mesh
    for y in CIRCLES:
        corner_y = mesh.p[1][mesh.t]
        assert np.any((corner_y.min(axis=0) < y - 1e-4) & (corner_y.max(axis=0) > y + 1e-4))


def test_segments_hold_their_own_volume(meshed):
    dx, (_, y, _) = element_volumes(meshed.mesh)
    assert meshed.segment.shape == (meshed.mesh.t.shape[1],)
    for i, s in enumerate(SHAFT):
        mine = meshed.segment == i
        assert y[mine].min() > s.y0 - 1e-12 and y[mine].max() < s.y1 + 1e-12
        # the same measure as for the whole, per segment; an element counted to its neighbour would
        # be 1e-3
        assert dx[mine].sum() == pytest.approx(volume_of(Outline([s])), rel=1e-4)


def test_mid_nodes_lie_on_the_true_surface(meshed):
    mesh = meshed.mesh
    edges = np.sort(mesh.edges, axis=0)
    boundary = np.unique(mesh.t2e[:, mesh.f2t[0, mesh.boundary_facets()]])
    middle = mesh.doflocs[:, mesh.dofs.edge_dofs[0, boundary]]
    ends = mesh.p[:, edges[:, boundary]]
    neck = np.all((np.abs(np.hypot(ends[0], ends[2]) - 0.03) < 1e-9) & (ends[1] > 1e-6), axis=0)
    on_surface = np.abs(np.hypot(middle[0], middle[2]) - 0.03)[neck]
    assert neck.sum() > 100
    # beyond it only by what keeps the volume, a hundredth of a sagitta of 0.1 to 0.3 mm; a mid node
    # given to the wrong edge would be off by a good part of the edge length of 8 mm
    assert np.quantile(on_surface, 0.95) < 2e-6


def test_the_same_call_gives_the_same_mesh(meshed):
    again = tetrahedra(Outline(SHAFT), PLANES, CIRCLES, size=0.02, graded_size=0.008, around=16)
    assert np.array_equal(again.mesh.doflocs, meshed.mesh.doflocs)
    assert np.array_equal(again.mesh.t, meshed.mesh.t)
    assert np.array_equal(again.segment, meshed.segment)


def test_grading_refines_where_it_was_asked(meshed):
    mesh = meshed.mesh
    ends = mesh.p[:, mesh.edges]
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=0)
    middle = ends.mean(axis=1)
    near = np.hypot(np.hypot(middle[0], middle[2]) - 0.03, middle[1]) < 0.006
    # edges vary by a third about the target: 8 mm at the shoulder against 17 mm in the bulk
    assert length[near].mean() < 1.35 * 0.008
    assert length.max() > 0.015


def test_a_callers_gmsh_is_left_alone():
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.ElementOrder", 1)
        gmsh.model.add("mine")
        made = tetrahedra(Outline(SHAFT[:1]), size=0.02)
        assert gmsh.isInitialized()
        assert gmsh.model.getCurrent() == "mine"
        assert "solidgear0" not in gmsh.model.list()
        assert gmsh.option.getNumber("Mesh.ElementOrder") == 1
    finally:
        gmsh.finalize()
    alone = tetrahedra(Outline(SHAFT[:1]), size=0.02)
    assert not gmsh.isInitialized()
    assert np.array_equal(made.mesh.doflocs, alone.mesh.doflocs)


def test_nothing_is_printed_and_progress_is_told(capfd):
    told = []
    tetrahedra(
        Outline(SHAFT[:1]), size=0.02, progress=lambda fraction, message: told.append(fraction)
    )
    assert capfd.readouterr() == ("", "")
    assert told == sorted(told) and told[0] == 0.0 and told[-1] == 1.0


@pytest.mark.parametrize(
    "shaft",
    [
        [piece(0.0, 0.05, 0.0, 0.03)],
        [
            piece(-0.05, 0.0, 0.03, 0.03, 0.01),
            piece(0.0, 0.006, 0.03, 0.03, 0.01, 0.0),
            piece(0.006, 0.03, 0.03),
        ],
        [piece(-0.02, 0.02, 0.03, 0.03, 0.0295)],
    ],
    ids=["tip", "drilled", "thin wall"],
)
def test_awkward_shapes(shaft):
    made = tetrahedra(Outline(shaft), size=0.015)
    # straightened tips cost less than what the arcs lose
    assert made.quality.volume == pytest.approx(volume_of(Outline(shaft)), rel=1e-4)
    # straightening starts at 0.05, so nothing is left below
    assert made.quality.min_ratio >= 0.05


@pytest.mark.parametrize(
    "shaft, planes, size, words",
    [
        ([], (), 0.02, "no segment"),
        ([piece(0.0, 0.1, 0.03), piece(0.11, 0.2, 0.03)], (), 0.02, "end to end"),
        ([piece(0.0, 0.1, 0.02), piece(0.1, 0.2, 0.04, 0.04, 0.03)], (), 0.02, "share no material"),
        ([piece(0.0, 0.1, 0.02, 0.02, 0.03)], (), 0.02, "no wall"),
        ([piece(0.0, 0.1, 0.02)], (0.2,), 0.02, "outside the shaft"),
        ([piece(0.0, 0.1, 0.02)], (), -1.0, "positive length"),
    ],
)
def test_bad_input_is_refused_in_a_sentence(shaft, planes, size, words):
    with pytest.raises(MeshError, match=words):
        tetrahedra(Outline(shaft), planes, size=size)


def test_a_missing_system_library_names_the_apt_line(monkeypatch):
    import builtins

    real = builtins.__import__

    def without_gmsh(name, *args, **kwargs):
        if name == "gmsh":
            raise OSError("libGLU.so.1: cannot open shared object file")
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without_gmsh)
    with pytest.raises(MeshError, match="libGLU.so.1.*apt-get install libglu1-mesa libgl1"):
        tetrahedra(Outline(SHAFT), size=0.02)


def test_a_mesh_pulled_inside_out_is_refused(meshed):
    mesh = meshed.mesh
    assert isinstance(mesh, MeshTet2)
    doflocs = mesh.doflocs.copy()
    edge = mesh.t2e[0, 7]
    a, b = mesh.edges[:, edge]
    doflocs[:, mesh.dofs.edge_dofs[0, edge]] = doflocs[:, a] + 1.5 * (doflocs[:, b] - doflocs[:, a])
    with pytest.raises(MeshError, match="inverted, the worst is element"):
        check_mesh(replace(mesh, doflocs=doflocs))


@pytest.mark.parametrize("change", [1e-5, 5e-5, 2e-4])
def test_a_shallow_cone_is_no_cylinder(change):
    """OCC turns a line whose radius changes by less than a tenth of a millimetre into a cylinder: its
    nodes lay half of the change off, and its seats had no faces.
    """
    cone = SimpleNamespace(y0=0.0, y1=0.038, outer0=0.05, outer1=0.05 + change, inner0=0, inner1=0)
    made = tetrahedra(Outline([cone]), circles=[0.012, 0.026], size=0.02)
    mesh = made.mesh
    corners = np.unique(mesh.facets[:, mesh.boundary_facets()])
    y, r = mesh.p[1, corners], np.hypot(*mesh.p[[0, 2]][:, corners])
    true = 0.05 + change * y / 0.038
    lateral = r > 0.0495
    assert lateral.sum() > 60
    assert np.abs(r - true)[lateral].max() < 1e-9
    assert made.quality.volume == pytest.approx(volume_of(Outline([cone])), rel=1e-5)
