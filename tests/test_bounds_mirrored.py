"""Errors of hexahedra in one order more from a part of the mesh: mirror images of cells and functions,
and the same energies as from all of it.
"""

from dataclasses import replace

import numpy as np
import pytest

import solidgear as sg
from solidgear import Bearing, Port, Scene, Segment
from solidgear.core.body.cache import Cache
from solidgear.core.bounds import solid as bounds_solid
from solidgear.core.bounds.pieces import independent
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


def unlike(body):
    """Displacements, forces and inertia of no symmetry at all."""
    random = np.random.default_rng(3)
    block = body.blocks[0]
    fields = random.standard_normal((block.size, 3))
    return fields, random.standard_normal((block.ports.shape[0], 3)), 0.1 * fields


def apart(body):
    """The same body, whose enrichment does not know of mirror planes."""
    block = body.blocks[0]
    whole = replace(block, enrich=lambda: block.enrich.func(*block.enrich.args))
    return replace(body, blocks=(whole,), cache=Cache())


@pytest.mark.parametrize(("around", "tie"), [(8, "average"), (12, "average"), (8, "rigid")])
def test_a_part_of_the_mesh_has_the_energies_of_all(around, tie, monkeypatch):
    monkeypatch.setattr(bounds_solid, "MISSING", 1e-5)
    body = sg.build(short(tie), "solid", element="hex20", around=around, **MESH)
    loads = unlike(body)
    bodies = body, apart(body)
    folded, whole = (enriched_errors(b, 0, *loads) for b in bodies)
    scale = np.sqrt(np.diag(whole.energies))
    # what is missing at the end, and what is expected of it, is not the same to the last digit
    assert np.abs((folded.energies - whole.energies) / np.outer(scale, scale)).max() < 1e-4
    assert np.abs(folded.fields - whole.fields).max() < 1e-2 * np.abs(whole.fields).max()
    on_part, on_all = (on_mesh(b, 0, folded) for b in bodies)
    assert np.abs(on_part - on_all).max() < 1e-9 * np.abs(on_all).max()


def test_a_quarter_of_the_cells_is_summed_up_and_twins_are_solved_once():
    body = sg.build(short(), "solid", element="hex20", around=8, **MESH)
    more, pieces = bounds_solid._enriched(body, 0)
    assert len(more.summed) < 0.4 * len(more.moves)
    assert [len(piece.parts) for piece in pieces] == [1, 2, 1]
    assert sum(len(part.fold.T @ more.moves) for piece in pieces for part in piece.parts) == len(
        more.moves
    )


@pytest.mark.parametrize("around", [8, 12])
def test_functions_take_their_values_in_the_mirror(around):
    body = sg.build(short(), "solid", element="hex20", around=around, **MESH)
    mesh, further = body.geometry, Further.beyond("hex20")
    numbers, signs = further.numbered(mesh)
    for (partner, _), turn in zip(body.blocks[0].reflections, ([0, 1, 2], [0, 1, 2], [2, 1, 0])):
        images = Images(mesh.mesh.t, partner[::3] // 3)
        there, sign = images.of_functions(further, numbers, signs)
        assert np.array_equal(there[there], np.arange(len(there)))  # twice is nothing
        assert np.array_equal(sign[there], sign)
        middle = mesh.nodes[:, mesh.dofs[:8]].mean(axis=1)
        size = np.abs(middle[turn])  # places may change their sign
        assert np.allclose(np.abs(middle[:, images.cells]), size, atol=1e-9)
    cells, times = orbits([], mesh.dofs.shape[1])
    assert np.array_equal(cells, np.arange(mesh.dofs.shape[1])) and np.all(times == 1)


def test_columns_that_follow_from_others_are_found():
    random = np.random.default_rng(5)
    base, mix = random.standard_normal((50, 3)), random.standard_normal((3, 7))
    columns, weight = base @ mix, random.uniform(0.5, 2, 50)
    chosen, how = independent(columns, weight, np.zeros(7))
    assert len(chosen) == 3
    assert np.allclose(columns[:, chosen] @ how, columns)


def test_an_estimate_without_room_says_what_it_needs(monkeypatch):
    body = sg.build(short(), "solid", element="hex20", around=8, **MESH)
    bounds_solid.factors(body)
    monkeypatch.setattr(memory, "SMALL_MB", 0.0)
    monkeypatch.setattr(memory, "available_mb", lambda: 0.5)
    with pytest.raises(NoRoom, match=r"error bars of the solid model: .*; use a coarser mesh"):
        enriched_errors(body, 0, *unlike(body))
