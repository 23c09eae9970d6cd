"""Errors of hexahedra in one order more from a part of the mesh: mirror images of cells and functions,
and the same energies as from all of it.
"""

import numpy as np
import pytest

import solidgear as sg
from solidgear import Bearing, Port, Scene, Segment
from solidgear.core.bounds import solid as bounds_solid
from solidgear.core.bounds.enriched_block import independent
from solidgear.core.bounds.solid import enriched_errors, on_mesh
from solidgear.core.machine import memory
from solidgear.core.machine.memory import NoRoom
from solidgear.core.models.solid.enriched import Further
from solidgear.core.models.solid.images import Images, orbits

#: few cells; planes cut some of twelve around, and none of eight
MESH = {"layers": 1, "radial_layers": 1, "edge_layers": 0, "relative_size": 4.0}


def short(tie="average"):
    """A short rod with a bearing at one end and a port at the other."""
    rod = Segment.cylinder("rod", length=0.03, diameter=0.05)
    springs = np.diag([1e8, 1e8, 1e8, 0.0, 0.0, 0.0]).tolist()
    bearing = Bearing(name="A", y=0.025, seat_width=0.01, attachment=tie, matrix=springs)
    return Scene.from_parts([rod], bearings=[bearing], port=Port(name="P", y=0.01, lo=0.0, hi=0.02))


def unlike(block):
    """Displacements, forces and inertia of a block without any order."""
    random = np.random.default_rng(3)
    fields = random.standard_normal((block.size, 3))
    return fields, random.standard_normal((block.ports.shape[0], 3)), 0.1 * fields


def on_whole_mesh(block, fields, forces, carried):
    """The same of the one block that holds all motions."""
    ports = block.ports.shape[0] // len(block.components)
    of_ports = np.zeros((ports, 6, forces.shape[1]))
    of_ports[:, list(block.components)] = forces.reshape(ports, -1, forces.shape[1])
    return block.expand @ fields, of_ports.reshape(6 * ports, -1), block.expand @ carried


@pytest.mark.parametrize("index", range(4))
@pytest.mark.parametrize("around", [8, 12])
def test_a_part_of_the_mesh_has_the_energies_of_all(around, index, monkeypatch):
    monkeypatch.setattr(bounds_solid, "MISSING", 1e-5)
    build = {"element": "hex20", "around": around, **MESH}
    body, whole = (sg.build(short(), "solid", half=half, **build) for half in (True, False))
    block = body.blocks[index]
    loads = unlike(block)
    by_block = enriched_errors(body, index, *loads)
    of_all = enriched_errors(whole, 0, *on_whole_mesh(block, *loads))
    # half of the twins of bending is that of the other plane, turned
    scale = np.sqrt(np.diag(of_all.energies))
    # what is missing at the end, and what is expected of it, is not the same to the last digit
    assert np.abs((by_block.energies - of_all.energies) / np.outer(scale, scale)).max() < 1e-4
    if block.mirror is not None:
        return  # functions are those of the block that it repeats
    assert np.abs(by_block.fields - of_all.fields).max() < 1e-2 * np.abs(of_all.fields).max()
    on_part, on_all = on_mesh(body, index, by_block), on_mesh(whole, 0, by_block)
    assert np.abs(on_part - on_all).max() < 1e-9 * np.abs(on_all).max()


def test_a_quarter_of_the_cells_is_summed_up_once_for_all_blocks():
    body = sg.build(short(), "solid", element="hex20", around=8, **MESH)
    enriched = [bounds_solid._enriched(body, index) for index in (0, 2, 3)]
    more = enriched[0].more
    assert all(one.more is more for one in enriched)
    assert len(more.summed) < 0.4 * len(more.moves)
    # both kinds of bending are as many
    counts = [len(one.inverse) for one in enriched]
    assert counts[0] + sum(counts) == len(more.moves)


@pytest.mark.parametrize("around", [8, 12])
def test_functions_take_their_values_in_the_mirror(around):
    body = sg.build(short(), "solid", element="hex20", around=around, **MESH)
    mesh, further = body.geometry, Further.beyond("hex20")
    numbers, signs = further.numbered(mesh)
    for (partner, _), turn in zip(
        body.blocks[0].enrich.keywords["reflections"], ([0, 1, 2], [0, 1, 2], [2, 1, 0])
    ):
        images = Images(mesh.mesh.t, partner[::3] // 3)
        there, sign = images.of_functions(further, numbers, signs)
        assert np.array_equal(there[there], np.arange(len(there)))  # twice is nothing
        assert np.array_equal(sign[there], sign)
        middle = mesh.nodes[:, mesh.dofs[:8]].mean(axis=1)
        size = np.abs(middle[turn])  # places may change their sign
        assert np.allclose(np.abs(middle[:, images.cells]), size, atol=1e-9)
    cells, times = orbits([], mesh.dofs.shape[1])
    assert np.array_equal(cells, np.arange(mesh.dofs.shape[1])) and np.all(times == 1)


def test_cells_without_an_image_are_seen():
    """A square cut along one diagonal, which the mirror turns into the other."""
    partner, kinds = np.array([1, 0, 3, 2]), np.array([0, 0])
    cut = np.array([[0, 0], [1, 2], [2, 3]])
    assert not Images(cut, partner).are_alike(kinds)
    bars, turned_round = np.array([[0, 1], [1, 2]]), np.array([2, 1, 0])
    images = Images(bars, turned_round)
    assert images.are_alike(kinds)
    assert not images.are_alike(np.array([0, 1]))


def test_columns_that_follow_from_others_are_found():
    random = np.random.default_rng(5)
    base, mix = random.standard_normal((50, 3)), random.standard_normal((3, 7))
    columns, weight = base @ mix, random.uniform(0.5, 2, 50)
    chosen, how = independent(columns, weight)
    assert len(chosen) == 3
    assert np.allclose(columns[:, chosen] @ how, columns)


def test_an_estimate_without_room_says_what_it_needs(monkeypatch):
    body = sg.build(short(), "solid", element="hex20", around=8, **MESH)
    bounds_solid.factors(body)
    monkeypatch.setattr(memory, "SMALL_MB", 0.0)
    monkeypatch.setattr(memory, "available_mb", lambda: 0.5)
    with pytest.raises(NoRoom, match=r"error bars of the solid model: .*; use a coarser mesh"):
        enriched_errors(body, 0, *unlike(body.blocks[0]))
