"""Blocks by mirror planes: the same answers as from the whole mesh, and one block where there is no
mirror.
"""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.body.parity import symmetric_basis
from solidgear.core.models.solid.block import mirrored

GEOMETRY = Path(__file__).parent.parent / "geometry"
COARSE = {"refinement": 0.5, "layers": 1, "edge_layers": 0, "radial_layers": 1}


@pytest.fixture(scope="module")
def scene():
    return sg.load(GEOMETRY / "pinion_overhung.toml")


def bodies(scene, **options):
    """A body by blocks, and the same in one block."""
    build = {**COARSE, "around": 8, **options}
    return sg.build(scene, "solid", **build), sg.build(scene, "solid", **build, half=False)


def whole(body, name):
    """A matrix of a body by blocks in the unknowns of the mesh."""
    return sum(b.expand @ (getattr(b, name).tocsr() @ b.expand.T) for b in body.blocks)


def test_hexahedra_have_four_blocks_and_two_share_their_matrices(scene):
    body, one = bodies(scene)
    assert [b.name for b in body.blocks] == ["bending_z", "bending_x", "axial", "torsion"]
    assert body.blocks[1].stiffness is body.blocks[0].stiffness and body.size == one.size
    assert [b.name for b in one.blocks] == ["full"]


@pytest.mark.parametrize("around", [8, 12])  # planes cut some cells of twelve around
@pytest.mark.parametrize("matrix", ["stiffness", "mass"])
def test_blocks_hold_the_matrices_of_the_whole_mesh(scene, around, matrix):
    body, one = bodies(scene, around=around)
    exact = getattr(one.blocks[0], matrix).tocsr()
    # rounding of assembly, which adds up cells in another order
    assert abs(whole(body, matrix) - exact).max() < 1e-12 * abs(exact).max()


def test_ports_move_as_on_the_whole_mesh(scene):
    body, one = bodies(scene)
    exact = one.blocks[0].ports.toarray()
    for block in body.blocks:
        rows = [6 * p + c for p in range(len(body.ports)) for c in block.components]
        found = (block.ports @ block.expand.T).toarray()
        assert np.allclose(found, exact[rows], atol=1e-12 * np.abs(exact).max())


def test_bases_hold_every_motion_once():
    reflection = np.array([2, 1, 0]), np.array([1.0, -1.0, 1.0])
    parities = 1.0, -1.0
    bases = [symmetric_basis(3, [reflection], [parity]).toarray() for parity in parities]
    together = np.hstack(bases)
    assert np.allclose(together.T @ together, np.eye(3))
    for basis, parity in zip(bases, parities):
        assert np.allclose(reflection[1][:, None] * basis[reflection[0]], parity * basis)


def test_nodes_without_an_image_are_in_no_mirror():
    lone = np.array([[1.0, -1.0, 0.3], [0.0, 0.0, 0.0], [1.0, 1.0, 0.2]])
    nodes, planes = mirrored(lone, 1e-7)
    assert not planes and np.array_equal(nodes, lone)


def test_rounding_is_taken_from_nodes():
    nodes = np.array([[1.0, -1.0 + 1e-15], [0.0, 0.0], [0.0, 1e-16]])
    found, planes = mirrored(nodes, 1e-7)
    assert len(planes) == 2
    assert found[0, 0] == -found[0, 1] and np.abs(found - nodes).max() < 1e-15


@pytest.mark.parametrize("tie", ["average", "rigid"])
def test_answers_do_not_know_of_it(scene, tie):
    tied = scene.with_attachment(tie)
    statics, shapes = zip(
        *((sg.condense(b, tied, "pinion"), sg.modes(b, tied, n=12)) for b in bodies(tied))
    )
    size = np.sqrt(np.diag(statics[1].compliance))
    apart = (statics[0].compliance - statics[1].compliance) / np.outer(size, size)
    assert np.nanmax(np.abs(apart)) < 1e-9  # rounding of matrices whose condition is about 1e7
    assert shapes[0].names == shapes[1].names
    assert shapes[0].multiplicity == shapes[1].multiplicity
    assert np.allclose(shapes[0].frequency_hz, shapes[1].frequency_hz, rtol=1e-9)
    # each bending motion of the one body is a combination of a pair of the other
    by_name = [s.named("bending 1") for s in shapes]
    motions = [m.motions.reshape(2, -1) for m in by_name]
    projected = motions[0] @ np.linalg.pinv(motions[1]) @ motions[1]
    assert np.abs(projected - motions[0]).max() < 1e-6 * np.abs(motions[0]).max()


def test_springs_that_couple_both_planes_couple_the_blocks(scene):
    springs = np.diag([2e8, 1e8, 3e8, 0.0, 0.0, 0.0])
    springs[0, 2] = springs[2, 0] = 1e8
    slanted = [
        sg.Bearing(name=b.name, y=b.y, seat_width=b.seat_width, matrix=springs.tolist())
        for b in scene.bearings
    ]
    tied = sg.Scene.from_parts(scene.segments, bearings=slanted, port=scene.port)
    found, exact = (sg.modes(b, tied, n=8) for b in bodies(tied))
    assert found.names == exact.names
    assert np.allclose(found.frequency_hz, exact.frequency_hz, rtol=1e-9)
