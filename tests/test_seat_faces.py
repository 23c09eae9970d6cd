"""Seats in meshes of one's own: their area is that of the cylinder, whatever meshers did to edges."""

import math
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

import solidgear as sg
from solidgear.core.meshing.tetrahedra import tetrahedra
from solidgear.core.models.solid.mesh import _isoparametric
from solidgear.core.models.solid.seat_faces import Seats
from solidgear.core.scene.outline import Outline
from solidgear.parts.mesh_file import _hexes

RADIUS, WIDTH = 0.03, 0.06
ROD = sg.Segment.cylinder("rod", length=0.12, diameter=2 * RADIUS)
PORT = sg.Port(y=0.06, lo=0.03, hi=0.09)


@pytest.fixture(scope="module")
def curved():
    """Tetrahedra of some sixteen to a turn."""
    return tetrahedra(Outline([ROD]), size=0.012).mesh


def bent(mesh, share, part, seed=3):
    """A mesh whose edges keep only a part of their sagitta, at random a share of them."""
    straight = mesh.p[:, mesh.edges].mean(axis=1)
    at = mesh.dofs.edge_dofs[0]
    chosen = np.random.default_rng(seed).random(len(at)) < share
    places = mesh.doflocs.copy()
    places[:, at[chosen]] = (straight + part * (places[:, at] - straight))[:, chosen]
    return replace(mesh, doflocs=places)


def share_of(mesh, element, segment=ROD):
    """Area of the seat over 2 pi r b."""
    solid = _isoparametric(mesh, element, np.zeros(mesh.t.shape[1], int))
    facets = Seats(solid, [segment], True)(PORT, "average")
    area = sum(a.sum() for _, _, a, _ in solid.over_facets(facets, (PORT.lo, PORT.hi)))
    return area / (2 * math.pi * RADIUS * WIDTH)


# a half and a quarter of the sagitta are what is left of the edges of folded elements
@pytest.mark.parametrize("straightened", [0.0, 0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("part", [0.0, 0.25, 0.5])
def test_straightened_edges_take_nothing_from_a_seat(straightened, part, curved):
    """Chords of sixteen to a turn lack 0.64 % of the area, and no face may be lost."""
    share = share_of(bent(curved, straightened, part), "tet10")
    assert 1 - 6.5e-3 < share < 1 + 1e-3


def test_faces_off_the_surface_are_refused(curved):
    """Middle nodes beyond the surface by four tenths of the sagitta, of a third of the edges."""
    with pytest.raises(sg.SolidgearError, match="'port': .. % of the faces of its seat are not on"):
        share_of(bent(curved, 0.3, 1.4), "tet10")


AROUND, RINGS = 12, 12
HOLLOW = sg.Segment.cylinder("rod", length=0.12, diameter=2 * RADIUS, bore=0.024)


def ring(straight, order=2):
    """Hexahedra of a hollow rod; edges around at ``straight(place around, place along)`` are chords."""
    corner = {}
    points: list = []

    def node(r, turn, y):
        key = tuple(np.round([r * math.sin(turn), y, r * math.cos(turn)], 12))
        if key not in corner:
            corner[key] = len(points)
            points.append(key)
        return corner[key]

    pitch, step = 2 * math.pi / AROUND, 0.12 / RINGS
    pairs = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    pairs += [(0, 4), (1, 5), (2, 6), (3, 7)]
    cells = []
    for i in range(AROUND):
        for k in range(RINGS):
            places = [
                (r, (i + a) % AROUND, k + b)
                for r in (RADIUS, 0.012)
                for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))
            ]
            cell = [node(r, pitch * a, step * b) for r, a, b in places]
            for first, other in pairs[: 12 if order == 2 else 0]:
                (r, _, b), (r1, _, b1) = places[first], places[other]
                if r == r1 and b == b1:  # around
                    lie = r * (math.cos(pitch / 2) if straight(i, b) else 1.0)
                    cell.append(node(lie, pitch * (i + 0.5), step * b))
                else:
                    middle = np.mean([points[cell[first]], points[cell[other]]], axis=0)
                    cell.append(node(math.hypot(*middle[::2]), math.atan2(*middle[::2]), middle[1]))
            cells.append(cell)
    return _hexes(np.array(points).T, np.array(cells).T)


CHORD = math.sin(math.pi / AROUND) / (math.pi / AROUND)


def test_a_flat_one_element_wide_is_no_seat():
    """Its edges are straight from end to end; straight edges here and there are those of the cylinder,
    and a mesh of straight edges alone has no other seat.
    """
    whole = share_of(ring(lambda i, k: False), "hex20", HOLLOW)
    assert whole == pytest.approx(1.0, abs=2e-4)
    flat = share_of(ring(lambda i, k: i == 3), "hex20", HOLLOW)
    assert flat == pytest.approx(1 - 1 / AROUND, abs=2e-4)
    some = share_of(ring(lambda i, k: (i + k) % 3 == 0), "hex20", HOLLOW)
    assert CHORD < some < 1 and some > 0.99
    for mesh, element in ((ring(lambda i, k: True), "hex20"), (ring(None, order=1), "hex8")):
        assert share_of(mesh, element, HOLLOW) == pytest.approx(CHORD, abs=2e-4)


def scene_of(folder, points, cells, seat="30 mm"):
    meshio.write(folder / "part.vtu", meshio.Mesh(points, [("tetra", cells)]))
    path = folder / "scene.toml"
    path.write_text(
        f"""
[material]
E = "207 GPa"
nu = 0.3
density = 7850
[body]
mesh = "part.vtu"
unit = "mm"
[port]
name = "gear"
seat = {{ diameter = "60 mm", from = "{seat}", to = "90 mm" }}
"""
    )
    return sg.load(path)


def test_what_is_missing_from_a_seat_is_said(tmp_path: Path, curved):
    """Elements over a fifth of a turn are taken away; a whole seat says nothing."""
    points, cells = 1e3 * curved.p.T, curved.t.T
    assert not scene_of(tmp_path, points, cells).body.remarks
    x, y, z = points[cells].mean(axis=1).T
    kept = (z < 22) | (abs(x) > 16) | (y < 20) | (y > 100)
    (told, *_) = (
        s for s in scene_of(tmp_path, points, cells[kept]).body.remarks if "2 pi r b" in s
    )
    assert "the seat of 'gear' has" in told
    found = float(told.split("has ")[1].split(" %")[0])
    assert 75 < found < 90


def test_coordinates_of_too_few_digits_are_told(tmp_path: Path, curved):
    """Nodes a hundredth of a millimetre apart lie on no common cylinder."""
    with pytest.raises(sg.SceneError, match="coordinates of the file are rounded to 0.01 mm"):
        scene_of(tmp_path, np.round(1e3 * curved.p.T, 2), curved.t.T)
