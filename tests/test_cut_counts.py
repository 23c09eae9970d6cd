"""Meshes at keyways, flats and cross holes: how large they are, and where elements are small."""

import numpy as np
import pytest
from test_features import FLAT, KEY, mesh_of, shaft

import solidgear as sg
from solidgear.core.ladder.registry import LADDER
from solidgear.core.models.solid.plan import tetrahedra_plan
from solidgear.core.scene.closed_form import volume_of
from solidgear.core.scene.outline import Outline
from solidgear.cuts.corrected.mesh import meshed_cuts, sizes
from solidgear.cuts.features import CrossHole
from solidgear.cuts.solid.cuts import edge_size, feature_size
from solidgear.cuts.solid.featured import meshed
from solidgear.cuts.solid.meshing import submesh
from solidgear.guards import elements
from solidgear.guards.probe import Probe

SMALL = CrossHole(name="small", segment="rod", y=0.12, diameter=0.002)
WIDE = SMALL.with_changes(diameter=0.012)
NARROW = KEY.with_changes(width=0.004, depth=0.0025, length=0.03)
PARTS = {
    "small hole": shaft(SMALL),
    "wide hole through a bore": shaft(WIDE, bore=0.02),
    "keyway": shaft(KEY),
    "narrow keyway with square ends": shaft(NARROW.with_changes(ends="square")),
    "flat": shaft(FLAT),
    "three that share no plane": shaft(
        NARROW, SMALL.with_changes(angle=0.4), FLAT.with_changes(y=0.14, length=0.03, angle=2.0)
    ),
}


def unknowns(scene, refinement):
    """Of the cut part, as its mesh has them: both halves, what lies on the mirror plane once."""
    return of_whole(mesh_of(scene, refinement)[1])


def of_whole(made):
    """Unknowns of a cut part from the mesh of it or of its half."""
    nodes = submesh(made.mesh, ~made.cut).doflocs
    if made.plane is None:
        return 3 * nodes.shape[1]
    return 3 * (2 * nodes.shape[1] - int((np.abs(nodes[made.plane]) < 1e-9).sum()))


@pytest.mark.parametrize(
    "name",
    [
        "small hole",
        "narrow keyway with square ends",
        "flat",
        pytest.param("three that share no plane", marks=pytest.mark.slow),
    ],
)
def test_the_size_is_counted_on_the_mesh_without_what_is_cut(name):
    given = {"refinement": 0.25}
    found = LADDER["solid"].size(PARTS[name], given).unknowns
    assert found == unknowns(PARTS[name], 0.25)
    # the rough number that absurd meshes are refused by: the plain part has a fifth of the unknowns of
    # the one with a small hole
    assert 1 / 4 < LADDER["solid"].rough_unknowns(PARTS[name], given) / found < 4


@pytest.mark.parametrize(
    "name",
    [pytest.param(p, marks=pytest.mark.long if p == "keyway" else pytest.mark.slow) for p in PARTS],
)
def test_check_tells_of_the_part_with_its_features(name):
    scene = PARTS[name]
    probe = Probe(scene.plain, sg.build(scene.plain, "timoshenko"), whole=scene)
    fact = next(elements.memory(probe)).sentence
    assert f"the default 3D solid, {unknowns(scene, 1.0)} unknowns" in fact


def test_check_tells_of_both_halves():
    """The solid that is asked for, of which each half is factored by itself."""
    scene = PARTS["flat"]
    body = sg.build(scene, "solid", element="tet10", refinement=0.25)
    assert len(body.blocks) == 2
    probe = Probe(scene.plain, body, whole=scene)
    assert f"the 3D solid, {body.size} unknowns" in next(elements.memory(probe)).sentence
    assert [n for n, _ in probe.solid_size.matrices] == [b.size for b in body.blocks]


@pytest.mark.parametrize("name", ["wide hole through a bore", "keyway", "flat"])
def test_the_size_of_a_corrected_solid_is_counted(name):
    """On the mesh that is graded towards edges of features and holes, with cuts and without."""
    scene = PARTS[name]
    found = LADDER["corrected"].size(scene, {"refinement": 0.5})
    made = meshed_cuts(scene, 0.5, None)
    assert found.unknowns == of_whole(made)
    assert len(found.matrices) == (2 if made.plane is None else 4)


def on_the_floor_of_a_key(x, y, z):
    straight = (y > KEY.y + KEY.width / 2) & (y < KEY.y + KEY.length - KEY.width / 2)
    return straight & near(np.abs(x), KEY.width / 2) & near(z, 0.03 - KEY.depth)


def at_the_ends_of_a_flat(x, y, z):
    return (near(y, FLAT.y) | near(y, FLAT.y + FLAT.length)) & near(z, 0.03 - FLAT.depth)


def on_the_wall_of_a_hole(x, y, z):
    return near(np.hypot(x, y - WIDE.y), WIDE.diameter / 2) & near(np.hypot(x, z), 0.03)


def near(a, b):
    return np.abs(a - b) < 1e-6


@pytest.mark.parametrize(
    "feature, there",
    [(KEY, on_the_floor_of_a_key), (FLAT, at_the_ends_of_a_flat), (WIDE, on_the_wall_of_a_hole)],
    ids=["key", "flat", "hole"],
)
def test_elements_are_smaller_at_edges_where_they_are_asked_to_be(feature, there):
    """Edges of elements along those of features are as long as asked for, but for whole numbers of
    them, and longer without.
    """
    scene = shaft(feature)
    plan = {"planes": [], "circles": [], "size": 0.02, "graded_size": None, "around": 8}
    mean = []
    for edges in (True, False):
        mesh = meshed(scene, plan, 1.0, True, edges=edges).mesh
        ends = mesh.p[:, mesh.edges]
        own = ends[:, :, there(*ends).all(axis=0)]
        mean.append(np.linalg.norm(own[:, 0] - own[:, 1], axis=0).mean())
    asked = [size(feature, 0.03, 1.0)[1] for size in (edge_size, feature_size)]
    assert mean == pytest.approx(asked, rel=0.3)
    assert asked[1] > 1.4 * asked[0]


def test_a_small_step_is_meshed_with_smaller_elements():
    """Rings of 0.05 mm: edges between their circles would fold, and the volume be 0.5 % short."""
    steps = [
        sg.Segment.cylinder("a", y0=0.0, length=0.054, diameter=0.0694),
        sg.Segment.cylinder("rod", y0=0.054, length=0.07, diameter=0.0693),
        sg.Segment.cylinder("c", y0=0.124, length=0.05, diameter=0.092),
    ]
    scene = sg.Scene.from_parts(
        steps, features=[FLAT.with_changes(y=0.08, length=0.03, depth=0.01)]
    )
    plan = tetrahedra_plan(scene, [], refinement=0.25, around=12, **sizes(scene))
    made = meshed(scene, plan, 0.25, True, edges=True)
    true = volume_of(Outline(scene.segments)) / 2
    assert made.quality.volume == pytest.approx(true, rel=3.2e-3)
