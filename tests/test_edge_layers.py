"""Layers of tetrahedra towards lines: the same body in cells that fit together, and smaller errors."""

import numpy as np
import pytest
from skfem import MeshTet1, MeshTet2

import solidgear as sg
from solidgear import Bearing, Material, Port, Scene, Segment
from solidgear.core.bounds.solid import solid_bounds
from solidgear.core.ladder.registry import LADDER
from solidgear.core.meshing.edge_layers import layered
from solidgear.core.meshing.quality import check_mesh, element_ratios, element_volumes
from solidgear.core.meshing.tetrahedra import tetrahedra
from solidgear.core.models.solid.lines import singular_lines, with_layers
from solidgear.core.models.solid.mesh import _isoparametric
from solidgear.core.models.solid.seat_faces import Seats
from solidgear.core.solve.statics import condense, flexibility
from solidgear.cuts.features import Keyway

STEEL = Material(E=2.1e11, nu=0.3, density=7850.0)
SOFT = Material(E=7e10, nu=0.3, density=2700.0)
RUBBER = Material(E=1e7, nu=0.49, density=1100.0)


def stepped(tie="average", features=()):
    """A shaft whose radius falls at y = 60 mm."""
    segments = [
        Segment.cylinder("thick", length=0.06, diameter=0.05, material=STEEL),
        Segment.cylinder("thin", length=0.08, diameter=0.03, y0=0.06, material=STEEL),
    ]
    springs = np.diag([2e8, 1e8, 2e8, 1e4, 0.0, 1e4]).tolist()
    bearings = [
        Bearing(name=name, y=y, seat_width=0.01, attachment=tie, matrix=springs)
        for name, y in (("A", 0.015), ("B", 0.12))
    ]
    port = Port(name="gear", y=0.04, lo=0.035, hi=0.045)
    return Scene.from_parts(segments, bearings=bearings, port=port, features=features)


@pytest.fixture(scope="module")
def mesh():
    outline = stepped().outline
    seats = (0.01, 0.02, 0.035, 0.045, 0.115, 0.125)
    return tetrahedra(outline, (), seats, size=0.02, graded_size=0.01, around=10).mesh


@pytest.fixture(scope="module")
def solid(mesh):
    return _isoparametric(mesh, "tet10", (mesh.p[1][mesh.t].mean(axis=0) > 0.06).astype(int))


def same_body(split):
    """Assert that cells fit together and fill what they filled before, none worse than before."""
    before = check_mesh(split.before)
    assert check_mesh(split.mesh).volume == pytest.approx(before.volume, rel=1e-12)
    volumes = np.bincount(split.parents, element_volumes(split.mesh))
    assert np.allclose(volumes, element_volumes(split.before), rtol=1e-9)
    assert element_ratios(split.mesh).min() > element_ratios(split.before).min() - 1e-6
    # a face without a neighbour lies on the surface
    surface = split.facets_in(split.before.boundary_facets())
    assert np.array_equal(surface, np.sort(split.mesh.boundary_facets()))


@pytest.mark.parametrize("layers", [1, 3])
def test_layers_fill_the_same_body(mesh, solid, layers):
    lines = singular_lines(solid, [STEEL, STEEL], [])
    split = layered(mesh, lines, layers, 0.2)
    same_body(split)
    # cells at a line are thinner in two directions, those at a vertex of it in three
    coarse = np.isin(mesh.t, mesh.edges[:, lines]).any(axis=0)
    fine = np.isin(split.mesh.t, mesh.edges[:, lines]).any(axis=0)
    share = element_volumes(split.mesh)[fine].sum() / element_volumes(mesh)[coarse].sum()
    assert 0.5 * 0.2 ** (2 * layers) < share < 3 * 0.2 ** (2 * layers)


def test_lines_may_cross_and_close_and_lie_inside(mesh):
    drawn = np.random.default_rng(4).choice(mesh.edges.shape[1], 60, replace=False)
    for lines in (drawn, mesh.t2e[:, 7], np.unique(mesh.t2e[:, :20])):
        same_body(layered(mesh, lines, 2, 0.3))


def test_without_lines_a_mesh_stays_as_it_is(mesh):
    split = layered(mesh, np.zeros(0, int), 2, 0.3)
    assert split.mesh is mesh
    assert np.array_equal(split.facets_in(np.array([3, 8])), [3, 8])


def circles(solid, lines):
    """The places of lines along the axis, mm, and the turns that they make around it."""
    x, y, z = solid.mesh.p[:, solid.mesh.edges[:, lines]]
    turn = np.angle((x[1] + 1j * z[1]) / (x[0] + 1j * z[0]))
    assert np.allclose(y[0], y[1], atol=1e-12)
    height = np.round(1e3 * y[0], 6)
    return {h: round(float(np.abs(turn[height == h]).sum() / (2 * np.pi)), 6) for h in set(height)}


def test_stress_is_singular_at_shoulders_rigid_seats_and_joints(solid):
    seats = Seats(solid, stepped().segments, clipped=False)
    (station,) = [s for s in stepped().stations if s.name == "A"]
    steel = [STEEL, STEEL]
    assert circles(solid, singular_lines(solid, steel, [])) == {60: 1}
    rigid = singular_lines(solid, steel, [seats(station, "rigid")])
    assert circles(solid, rigid) == {10: 1, 20: 1, 60: 1}


def test_a_joint_of_materials_on_a_smooth_surface_is_a_line():
    outline = Scene.from_parts([Segment.cylinder("rod", length=0.1, diameter=0.04)]).outline
    mesh = tetrahedra(outline, (0.05,), (), size=0.02, around=8).mesh
    solid = _isoparametric(mesh, "tet10", (mesh.p[1][mesh.t].mean(axis=0) > 0.05).astype(int))
    # aluminium on steel: 0.92, nearly smooth; rubber: 0.60, as a notch of 260 degrees
    for other in (STEEL, SOFT):
        assert not len(singular_lines(solid, [STEEL, other], []))
    assert circles(solid, singular_lines(solid, [STEEL, RUBBER], [])) == {50: 1}


def test_a_bracket_has_its_concave_edges_and_a_bore_none():
    quarters = np.linspace(0.0, 1.0, 5)
    cube = MeshTet1.init_tensor(quarters, quarters, quarters)
    volume = np.linalg.det((cube.p[:, cube.t[1:]] - cube.p[:, cube.t[:1]]).T)
    cube = MeshTet1(cube.p, np.where(volume > 0, cube.t, cube.t[[1, 0, 2, 3]]))
    corner = (cube.p[:, cube.t].mean(axis=1) > 0.5).all(axis=0)
    cut = MeshTet2.from_mesh(cube.remove_elements(np.flatnonzero(corner)))
    solid = _isoparametric(cut, "tet10", np.zeros(cut.t.shape[1], int))
    lines = singular_lines(solid, [STEEL], [])
    start, end = np.sort(cut.p[:, cut.edges[:, lines]], axis=1).transpose(1, 0, 2)
    assert len(lines) == 6  # two edges of cells each
    assert ((start == 0.5).sum(axis=0) >= 2).all() and ((end > 0.5).sum(axis=0) == 1).all()
    same_body(layered(cut, lines, 2, 0.3))
    tube = Scene.from_parts([Segment.cylinder("t", length=0.05, diameter=0.04, bore=0.02)])
    bored = tetrahedra(tube.outline, (), (), size=0.02, around=8).mesh
    solid = _isoparametric(bored, "tet10", np.zeros(bored.t.shape[1], int))
    assert not len(singular_lines(solid, [STEEL], []))


def test_seats_keep_their_faces(solid):
    scene = stepped("rigid")
    seats = Seats(solid, scene.segments, clipped=False)
    wanted = [(station, station.attachment) for station in scene.stations]
    fine = with_layers(
        solid, check_mesh(solid.mesh), seats, wanted, [STEEL, STEEL], layers=2, ratio=0.3
    )
    for station, attachment in wanted:
        before, after = seats(station, attachment), fine.facets(station, attachment)
        areas = [
            sum(area.sum() for _, _, area, _ in m.over_facets(facets))
            for m, facets in ((solid, before), (fine.mesh, after))
        ]
        assert areas[1] == pytest.approx(areas[0], rel=1e-7)
        assert len(after) > len(before) or attachment == "average"


@pytest.mark.parametrize("tie", ["average", "rigid"])
def test_what_a_mesh_can_do_it_can_do_with_layers(tie):
    # displacements with fewer layers are some of those with more, so that flexibility grows
    coarse, fine = (
        flexibility(
            sg.build(stepped(tie), "solid", element="tet10", refinement=0.2, layers=k)
        ).matrix
        for k in (1, 3)
    )
    size = np.sqrt(np.diag(fine))
    ends = np.linalg.eigvalsh((fine - coarse) / np.outer(size, size))
    assert ends.min() > -1e-7 and ends.max() > 1e-3


@pytest.mark.slow
def test_layers_leave_less_error_of_which_one_order_more_finds_more():
    scene = stepped()
    exact = condense(
        sg.build(scene, "harmonic", order=5, layers=3, edge_layers=2), scene, "gear"
    ).compliance[3, 3]
    errors, shares = [], []
    for layers in (0, 2):
        body = sg.build(scene, "solid", element="tet10", refinement=0.25, layers=layers)
        bounds = solid_bounds(scene, body, statics=True)
        value = condense(body, scene, "gear").compliance[3, 3]
        found = condense(bounds.softer(bounds.reached), scene, "gear").compliance[3, 3] - value
        errors.append(exact - value)
        shares.append(found / errors[-1])
    assert errors[1] < 0.75 * errors[0]
    # at an edge of a plain mesh 0.587, of smooth displacements nearly all
    assert 1 / bounds.share < min(shares) and max(shares) < 1.0
    assert shares[1] > shares[0]


@pytest.mark.long
def test_layers_in_a_half_with_a_keyway_are_counted():
    key = Keyway(name="key", segment="thin", y=0.1, length=0.02, width=0.008, depth=0.004)
    scene = stepped(features=[key])
    options = {"element": "tet10", "refinement": 0.2, "layers": 1}
    body = sg.build(scene, "solid", **options)
    finer = sg.build(scene, "solid", **(options | {"layers": 2}))
    assert len(body.blocks) == 2
    model = LADDER["solid"]
    assert model.size(scene, options).unknowns == body.size < finer.size / 1.2
    assert 1 / 3 < model.rough_unknowns(scene, options) / body.size < 3
    coarse, fine = (np.diag(flexibility(b).matrix) for b in (body, finer))
    assert (fine > coarse * (1 - 1e-9)).all() and (fine > coarse * (1 + 1e-3)).any()


def test_layers_are_counted_before_a_mesh_is_made():
    scene = stepped()
    options = {"element": "tet10", "refinement": 0.35, "layers": 2}
    model = LADDER["solid"]
    body = sg.build(scene, "solid", **options)
    assert model.size(scene, options).unknowns == body.size
    assert 1 / 3 < model.rough_unknowns(scene, options) / body.size < 3
    more = [model.rough_unknowns(scene, options | {"layers": k}) for k in (0, 1, 2)]
    assert more[2] - more[1] == pytest.approx(more[1] - more[0])
    assert more[1] > more[0]


@pytest.mark.slow
def test_a_step_part_has_layers():
    scene = sg.load("geometry/shaft_step.toml")
    coarse, fine = (
        sg.build(scene, "solid", element="tet10", refinement=0.2, layers=k) for k in (1, 2)
    )
    assert fine.mesh["elements"] > 1.1 * coarse.mesh["elements"]
    assert fine.mesh["volume"] == pytest.approx(coarse.mesh["volume"], rel=1e-12)
    seats = [[port.name for port in body.ports] for body in (coarse, fine)]
    assert seats[0] == seats[1] == [station.name for station in scene.stations]


def test_meshes_of_a_list_have_layers_where_there_are_lines():
    model = LADDER["solid"]

    def layers(scene, **options):
        levels = model.meshes_of(scene, {"element": "tet10", **options}).levels
        return [level.get("layers", 0) for level in levels]

    smooth = Scene.from_parts([Segment.cylinder("rod", length=0.1, diameter=0.04)])
    assert set(layers(smooth)) == {0}
    assert layers(stepped()) == sorted(layers(stepped())) and min(layers(stepped())) > 0
    seated = Scene.from_parts(
        smooth.segments, port=Port(name="p", y=0.05, lo=0.04, hi=0.06, attachment="rigid")
    )
    assert min(layers(seated)) > 0
    assert layers(stepped(), refinement=0.5) == [0]  # one that was asked for stays as it is
    assert set(layers(sg.load("geometry/pinion_toothed.toml"))) == {0}
    first, *finer = layers(sg.load("geometry/shaft_step.toml"))
    assert first == 0 and min(finer) > 0  # a part of many edges has its first numbers without
