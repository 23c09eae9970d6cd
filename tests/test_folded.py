"""Factors by mirror planes: the same answers from pieces, and none where there is no mirror."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.models.solid.block import mirrored
from solidgear.core.solve.factor import factorise
from solidgear.core.solve.shifted import SHIFT, factors
from solidgear.core.solve.symmetry import planned_by_symmetry

GEOMETRY = Path(__file__).parent.parent / "geometry"
COARSE = {"refinement": 0.5, "layers": 1, "edge_layers": 0, "radial_layers": 1, "around": 8}


@pytest.fixture(scope="module")
def scene():
    return sg.load(GEOMETRY / "pinion_overhung.toml")


@pytest.fixture(scope="module")
def body(scene):
    return sg.build(scene, "solid", **COARSE)


@pytest.fixture(scope="module")
def matrix(body):
    block = body.blocks[0]
    return (block.stiffness + SHIFT * body.scale * block.mass).tocsr()


def without_planes(scene):
    body = sg.build(scene, "solid", **COARSE)
    return replace(body, blocks=(replace(body.blocks[0], reflections=()),))


def test_hexahedra_have_three_planes_and_are_factored_by_them(body):
    assert len(body.blocks[0].reflections) == 3
    assert factors(body)[0].reason.endswith("in 3 pieces by mirror planes")


@pytest.mark.parametrize("planes", [1, 2, 3])
def test_pieces_solve_as_the_whole_does(body, matrix, planes):
    found = planned_by_symmetry(matrix, body.blocks[0].reflections[:planes]).make()
    load = np.random.default_rng(3).standard_normal((matrix.shape[0], 3))
    whole = factorise(matrix).solve(load)
    # what rounding leaves of a matrix whose condition is about 1e7
    assert np.abs(found.solve(load) - whole).max() < 1e-8 * np.abs(whole).max()
    # back ends add up one right-hand side in another order than several
    one, several = found.solve(load[:, 0]), found.solve(load)[:, 0]
    assert np.abs(one - several).max() < 1e-8 * np.abs(several).max()


def test_a_matrix_that_one_entry_spoils_is_not_folded(body, matrix):
    off_the_planes = int(np.argmax(np.abs(body.geometry.nodes[0]) + np.abs(body.geometry.nodes[2])))
    spoilt = matrix.tolil()
    spoilt[3 * off_the_planes, 3 * off_the_planes] *= 1 + 1e-6
    assert planned_by_symmetry(spoilt.tocsr(), body.blocks[0].reflections) is None
    assert planned_by_symmetry(matrix, ()) is None


def test_nodes_without_an_image_are_in_no_mirror():
    lone = np.array([[1.0, -1.0, 0.3], [0.0, 0.0, 0.0], [1.0, 1.0, 0.2]])
    nodes, planes = mirrored(lone, 1e-7)
    assert not planes and np.array_equal(nodes, lone)


def test_rounding_is_taken_from_nodes():
    nodes = np.array([[1.0, -1.0 + 1e-15], [0.0, 0.0], [0.0, 1e-16]])
    found, planes = mirrored(nodes, 1e-7)
    assert len(planes) == 2
    assert found[0, 0] == -found[0, 1] and np.abs(found - nodes).max() < 1e-15


def test_answers_do_not_know_of_it(scene, body):
    plain = without_planes(scene)
    assert "pieces" not in factors(plain)[0].reason
    pairs = zip(
        *((sg.condense(b, scene, "pinion"), sg.modes(b, scene, n=8)) for b in (body, plain))
    )
    statics, shapes = pairs
    # both stand on the whole matrix: rounding is all that may differ
    size = np.sqrt(np.diag(statics[1].compliance))
    apart = (statics[0].compliance - statics[1].compliance) / np.outer(size, size)
    assert np.nanmax(np.abs(apart)) < 1e-9
    assert shapes[0].names == shapes[1].names
    assert np.allclose(shapes[0].frequency_hz, shapes[1].frequency_hz, rtol=1e-9)
