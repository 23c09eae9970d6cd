"""Meshes of a harmonic solid that follow where its bars come from: what is cut, what is not, how soon
they do, and that they stay meshes of the same body.
"""

import json
from collections import Counter
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.bounds.refining import Corners, Meshed, refined
from solidgear.core.judge.answer import answer
from solidgear.core.kernel.cell_shapes import Shapes
from solidgear.core.meshing.lobatto import gauss
from solidgear.core.scene import Fillet
from solidgear.core.scene.closed_form import mass_properties
from tests.test_bounds import shaft

MM = 1e-3
#: what is asked of each shaft, and how sure
ASKED = {
    "plain bar": (lambda: shaft((120, 40)), 1e-2, ["C_zz", "C_yy", "bending 1", "axial 1"]),
    "step": (lambda: shaft((60, 40), (60, 60)), 1e-4, ["C_zz", "bending 1"]),
    "fillet": (
        lambda: shaft((60, 40), (60, 60), blends=[Fillet(name="f", y=60 * MM, radius=MM)]),
        1e-4,
        ["C_zz"],
    ),
    "rigid seats 0.04 mm apart": (
        lambda: shaft((100, 40), port=(40, 60), seat=(60.04, 80), tie="rigid", held="rigid"),
        1e-3,
        ["axial 1"],
    ),
    "disc of 0.005 diameters": (
        lambda: shaft((40, 40), (1, 200), (40, 40), port=(40, 41), seat=(15, 25)),
        1e-3,
        ["C_thx", "bending 1"],
    ),
    "free tube": (
        lambda: shaft((200, 60, 60, 54)).with_changes(bearings=()),
        1e-5,
        ["bending 1", "bending 2"],
    ),
}


@cache
def climbed(name):
    """A shaft, the options of all meshes that were tried, and what came of it."""
    make, tol, asked = ASKED[name]
    scene = make()
    found = answer(scene, tol, asked)
    assert found.reached and found.bar <= tol
    return scene, [step.options for step in found.steps if step.valid], found


@cache
def body_of(name):
    """On the last mesh; torsion is the lightest to build."""
    scene, options, _ = climbed(name)
    return sg.build(scene, "harmonic", **{**options[-1], "families": ("torsion",)})


def cut_at(options):
    """Corners that are cut: y and r in mm."""
    return {(round(y / MM, 6), round(r / MM, 6)) for y, r, _ in options["cuts"]}


def test_an_easy_shaft_is_answered_by_one_cell_a_band_and_strip():
    _, options, found = climbed("plain bar")
    assert len(options) == 1 and not options[0]["cuts"] and not options[0]["across"]
    # between the ends of the bar and of two seats five strips of one cell, the longest one halved
    assert body_of("plain bar").mesh["cells"] <= 10
    assert all(v.how == "local problems" for v in found.values)


def test_a_shoulder_is_cut_and_ends_that_nothing_loads_are_not():
    _, options, _ = climbed("step")
    last = cut_at(options[-1])
    assert not options[0]["cuts"] and (60, 20) in last
    # beside it only ends of seats: not the rim of the shoulder, nor the edges of both faces
    assert last <= {(60, 20), (20, 20), (40, 20), (80, 30), (100, 30)}
    most = max(options[-1]["cuts"], key=lambda cut: cut[2])
    assert most[2] == next(count for y, _, count in options[-1]["cuts"] if abs(y - 60 * MM) < 1e-9)


def test_without_a_load_and_without_a_corner_only_the_order_rises():
    _, options, _ = climbed("free tube")
    assert len(options) > 1 and options[-1]["order"] > options[0]["order"]
    assert not any(level["cuts"] or level["across"] for level in options)


def slender_at(name, options, place):
    """Longest side over the shortest one that ends in a corner, before it is cut."""
    scene = climbed(name)[0]
    body = sg.build(scene, "harmonic", **{**options, "families": ("torsion",)})
    flat = body.geometry.uncut
    vertex = int(np.linalg.norm(flat.points.T - np.array(place) * MM, axis=1).argmin())
    length = [
        np.linalg.norm(flat.points[:, vertex] - flat.points[:, cell[(k + turn) % 4]])
        for cell in flat.cells.T
        for k in np.flatnonzero(cell == vertex)
        for turn in (1, 3)
    ]
    return max(length) / min(length)


def test_slender_cells_at_a_corner_are_cut_across_before_they_are_cut_towards_it():
    name, corner = "rigid seats 0.04 mm apart", (20, 60)
    _, options, _ = climbed(name)
    assert slender_at(name, options[0], corner) > 400  # 20 mm over 0.04
    assert (60, 20) in cut_at(options[-1]) and options[-1]["across"]
    assert slender_at(name, options[-1], corner) < 20


@pytest.mark.long
def test_a_disc_of_a_two_hundredth_of_its_diameter_takes_four_meshes_at_most():
    _, options, _ = climbed("disc of 0.005 diameters")
    assert len(options) <= 4


@pytest.mark.parametrize("name", ASKED)
def test_a_refined_mesh_is_one_of_the_same_body(name):
    """No hanging nodes, nothing folded, nothing lost."""
    scene, body = climbed(name)[0], body_of(name)
    flat = body.geometry.meridian
    sides = Counter(
        frozenset((int(a), int(b)))
        for cell in flat.cells.T
        for a, b in zip(cell, np.roll(cell, -1))
    )
    assert max(sides.values()) == 2
    # a hanging node would have a long side and its halves among those of one cell alone
    if not scene.corners:
        lone = np.array([sorted(side) for side, times in sides.items() if times == 1]).T
        length = np.linalg.norm(np.diff(flat.points[:, lone], axis=1), axis=(0, 1)).sum()
        first, last = scene.segments[0], scene.segments[-1]
        outline = 2 * scene.length + first.outer0 - first.inner0 + last.outer1 - last.inner1
        outline += sum(abs(a.outer1 - b.outer0) for a, b in pairwise(scene.segments))
        assert length == pytest.approx(outline, rel=1e-12)
    # every map has a positive determinant, also beside arcs, and all cells make up the volume
    x, w = gauss(8)
    at = np.array(np.meshgrid(x, x)).reshape(2, -1)
    weight, volume = np.outer(w, w).ravel(), 0.0
    shapes = Shapes(flat, body.geometry.element)
    for kind in shapes.kinds:
        mapped = shapes.on(kind, kind.cells, at)
        assert mapped.det.min() > 0
        volume += 2 * np.pi * (mapped.det * mapped.x[0] * weight).sum()
    exact = mass_properties(scene.outline).mass / scene.segments[0].material.density
    # arcs are polynomials of the order of the elements: of a quarter of a circle 1e-6 at most
    assert volume == pytest.approx(exact, rel=1e-6 if scene.corners else 1e-12)
    # bodies on it move freely, so that unknowns on shared sides are one
    assert body.rigid_residual() < 1e-10


def test_options_of_an_answer_build_its_body_again():
    scene, options, found = climbed("step")
    told = json.loads(json.dumps(options[-1]))
    one, again = (sg.build(scene, "harmonic", **given) for given in (options[-1], told))
    for a, b in zip(one.blocks, again.blocks):
        assert abs(a.stiffness - b.stiffness).max() == 0.0 and abs(a.ports - b.ports).max() == 0.0
    # what was not solved again there is of an earlier mesh
    value = sg.condense(one, scene, "p").compliance[2, 2]
    assert value == pytest.approx(found["C_zz"], rel=1e-9)


@pytest.mark.parametrize("tol", [1e-2, 1e-6])
def test_the_next_mesh_is_always_another(tol):
    """Also where next to nothing is left of a bar, and where all orders and cuts are spent."""
    scene = climbed("step")[0]
    mesh = Meshed()
    body = sg.build(scene, "harmonic", **mesh.options())
    count = body.mesh["cells"]
    for share in (np.zeros(count), np.full(count, 1.0), np.eye(count)[0] * tol):
        assert refined(scene, body, mesh, share, tol).options() != mesh.options()
    spent = replace(mesh, order=8)
    body = sg.build(scene, "harmonic", **spent.options())
    assert refined(scene, body, spent, np.full(count, 1.0), tol).options() != spent.options()


def test_orders_are_asked_for_by_what_they_took_before_and_cells_are_halved_where_they_run_out():
    """A bar of three aims away from corners: an order takes a ninth of it or, as two did before,
    half of it.
    """
    scene, tol = climbed("free tube")[0], 1e-3
    for order, wanted, halved in ((5, 7, False), (7, 8, True)):
        mesh = Meshed(order=order)
        body = sg.build(scene, "harmonic", **mesh.options())
        score = np.zeros(body.mesh["cells"])
        score[0] = 2e-3
        assert refined(scene, body, mesh, score, tol).order == order + 1
        slow = replace(mesh, smooth=4 * score[0], raised=2)
        found = refined(scene, body, slow, score, tol)
        assert found.order == wanted and bool(found.across) == halved


def test_cells_of_a_needle_grow_with_its_radius():
    """A cone from 1 to 40 mm: a tip that sets all sizes would ask for 800 cells."""
    scene = shaft((80, 1, 40), (40, 40), seat=(90, 110), port=(55, 65))
    body = sg.build(scene, "harmonic", **Meshed().options())
    assert body.mesh["cells"] < 80
    found = answer(scene, 1e-2, ["C_zz"])
    assert found.reached and found.seconds < 60


def test_a_cell_at_two_corners_is_cut_towards_the_sharper_one_first():
    scene = climbed("step")[0]
    mesh = Meshed()
    body = sg.build(scene, "harmonic", **mesh.options())
    corners = Corners(scene, body, np.full(body.mesh["cells"], 1e-3), 3)
    sharp, _ = corners.worst()
    assert corners.exponents[sharp] == min(corners.exponents.values())
    before = corners.left.sum()
    corners.cut(sharp)
    assert corners.left.sum() < before and corners.smooth() > 0
