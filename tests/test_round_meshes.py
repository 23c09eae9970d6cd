"""Mesh files of parts that are round but for their facets, and of bars that are many-sided."""

import re

import numpy as np
import pytest

import solidgear as sg
from solidgear.app.answer import _of_round_part
from solidgear.core.ladder.registry import LADDER
from solidgear.guards import elements
from solidgear.guards.probe import Probe
from solidgear.guards.round_part import described
from solidgear.parts.round_part import round_part
from validation.mesh_files import rod, write_mesh

SCENE = """
material = "42CrMo4"
body = { mesh = "part.msh", unit = "mm" }
port = { name = "end", position = "100 mm", span = ["0 mm", "100 mm"] }
"""
EDGES = np.array(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)))


def curved(points, cells, radius):
    """Second-order tetrahedra of first-order ones, with sides on the circle of their corners."""
    pairs = np.sort(cells[:, EDGES], axis=2)
    edges, place = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    middle = points[edges].mean(axis=1)
    r = np.hypot(points[:, 0], points[:, 2])
    on = (np.abs(r[edges] - radius) < 1e-9).all(axis=1)
    own = np.hypot(middle[on, 0], middle[on, 2])
    middle[on] *= np.column_stack([radius / own, 1 + 0 * own, radius / own])
    return np.vstack([points, middle]), np.hstack([cells, len(points) + place.reshape(-1, 6)])


def scene_of(folder, around, second=False):
    points, cells = rod((0.0, 10.0), (0, 20, 40, 60, 80, 100), around)
    kind = "tetra"
    if second:
        points, cells = curved(points, cells, 10.0)
        kind = "tetra10"
    write_mesh(folder / "part.msh", points, kind, cells, {})
    (folder / "scene.toml").write_text(SCENE)
    return sg.load(folder / "scene.toml")


@pytest.mark.parametrize(
    "around, second, is_round",
    [(12, False, True), (8, True, True), (8, False, False)],
)
def test_facets_of_a_round_part_are_no_feature(around, second, is_round, tmp_path):
    """A chord polygon has n / 2 sin(2 pi / n) r^2; sides through the circle leave less than a
    hundredth of that beside it. A bar of eight flat sides is no shaft.
    """
    scene = scene_of(tmp_path, around, second)
    body = scene.body
    assert body.round_share == pytest.approx(1.0, abs=1e-12)
    assert body.round is is_round
    assert bool(LADDER["harmonic"].unfit(scene)) is not is_round
    if is_round:
        polygon = around / 2 * np.sin(2 * np.pi / around)
        chords = np.pi / polygon - 1
        off = body.round_volume - 1
        if second:
            assert 0 < off < chords / 100
        else:
            assert off == pytest.approx(chords, rel=1e-6)
        said = next(described(scene)).sentence
        assert "as facets of its mesh explain" in said
        assert "1 segment is the round part" in said
        assert "the volume of the segment is" in said
        # second moment with the square of the area, within what a polygon differs from a circle
        lost = "so much lighter, and its second moment of area about twice as much lower"
        assert (lost in said) is not second
        # coarse linear hexahedra of the same facets bend less than the round part all the same
        assert "bends about" not in said
        assert ("its bending depends on its elements too" in said) is not second


def test_a_wide_facet_among_narrow_ones_is_a_flat():
    """The corners of a flat from end to end lie on the circle too."""
    turn = 2 * np.pi * np.arange(36) / 36

    def share_of_facets(turn):
        n = len(turn)
        ring = np.array([np.cos(turn), 0 * turn, np.sin(turn)])
        points = np.hstack([ring, ring + [[0], [3], [0]], [[0, 0], [0, 3], [0, 0]]])
        here, there = np.arange(n), (np.arange(n) + 1) % n
        sides = [[here, there, n + here], [there, n + there, n + here]]
        ends = [[here, there, 2 * n + 0 * here], [n + here, n + there, 2 * n + 1 + 0 * here]]
        found = round_part(points, np.hstack(sides + ends))
        assert found.share == pytest.approx(1.0, abs=1e-12)
        return found.facets / (3 * n / 2 * np.sin(2 * np.pi / n))

    whole = np.pi / (18 * np.sin(np.pi / 18)) - 1
    assert share_of_facets(turn) == pytest.approx(whole, rel=1e-6)
    assert share_of_facets(np.delete(turn, [4, 5, 6])) < 0.1 * whole


@pytest.mark.long
def test_an_axis_beside_the_origin_is_told_as_it_can_be_written(tmp_path):
    """The point leaves places along the shaft where they count from without one: the lower end."""
    points, cells = rod((0.0, 10.0), (0, 20, 40, 60, 80, 100), 24)
    write_mesh(tmp_path / "part.msh", points + [30.25, 500.0, -20.0], "tetra", cells, {})
    path = tmp_path / "scene.toml"
    wrong = SCENE.replace('unit = "mm"', 'unit = "mm", axis = "z"')
    path.write_text(wrong)
    with pytest.raises(sg.SceneError, match="write that point as origin") as error:
        sg.load(path)
    told = re.search(r"(?:one|\"y\") through \((.*?)\) mm", str(error.value))[1].split(", ")
    assert [float(v) for v in told] == [30.25, 500.0, -20.0]
    point = ", ".join(f'"{v} mm"' for v in told)
    path.write_text(SCENE.replace('unit = "mm"', f'unit = "mm", origin = [{point}]'))
    scene = sg.load(path)
    assert scene.body.round and scene.port.y == pytest.approx(0.1)


def test_a_round_part_from_a_mesh_file_is_answered_as_its_segments_are(tmp_path):
    # revolution is meshed coarse to fine whatever the mesh of the file, which the solid alone has
    scene = scene_of(tmp_path, 24)
    assert len(LADDER["solid"].meshes_of(scene, {}).levels) == 1
    assert LADDER["harmonic"].follows
    plain = sg.answer(scene.plain, 0.01, "bending")
    found = sg.answer(scene, 0.01, "bending")
    assert found.reached and found.rung == "harmonic"
    assert found.bar == pytest.approx(plain.bar, rel=1e-6)
    assert found["bending 1"] == pytest.approx(plain["bending 1"], rel=1e-9)
    (told,) = _of_round_part(scene, found)
    # chords of 24 sides leave out 1.1 % of the circle
    assert "These numbers are for the round part of part.msh, whose volume differs by +1.1" in told
    assert not _of_round_part(scene.plain, plain)


def test_check_tells_of_the_mesh_of_the_file(tmp_path):
    # which is the only one that a 3D solid of it has; hexahedra in its segments would be several times it
    scene = scene_of(tmp_path, 24)
    probe = Probe(scene.plain, sg.build(scene.plain, "timoshenko"), whole=scene)
    fact = next(elements.memory(probe)).sentence
    assert f"the 3D solid, {sg.build(scene, 'solid').size} unknowns" in fact
    assert LADDER["solid"].size(scene.plain, {}).unknowns > 3 * probe.solid_size.unknowns
