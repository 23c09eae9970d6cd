"""Edges of volume meshes: what meets there, whatever the mesh is of, and what bars make of it."""

import math

import numpy as np
import pytest
from skfem import MeshHex, MeshTet

import solidgear as sg
from solidgear.core.bounds.solid import share_of_error, solid_bounds
from solidgear.core.errors import NoBounds
from solidgear.core.judge.cell_places import CellPlaces
from solidgear.core.meshing.wedge import wedge_exponent
from solidgear.core.models.solid.edges import sharp_edges
from solidgear.core.models.solid.mesh import _isoparametric
from solidgear.core.safety import LOCAL
from solidgear.core.scene import Material
from validation.mesh_files import write_boxes

STEEL = Material(E=2.07e11, nu=0.3, density=7850)
SOFT = Material(E=2.07e10, nu=0.3, density=1400)
QUARTER = math.pi / 2
KINDS = {MeshHex: "hex20", MeshTet: "tet10"}


def cube(kind, held=None, soft=None, hollow=None):
    """Sharp edges of a cube of four cells a side: what is held of its faces, soft and left out of its
    cells are functions of middles.
    """
    lines = np.linspace(0.0, 1.0, 5)
    mesh = kind.init_tensor(lines, lines, lines)
    if hollow is not None:
        mesh = mesh.remove_elements(np.flatnonzero(hollow(mesh.p[:, mesh.t].mean(axis=1))))
    inside = mesh.p[:, mesh.t].mean(axis=1)
    materials = np.zeros(mesh.t.shape[1], int) if soft is None else soft(inside).astype(int)
    outside = mesh.boundary_facets()
    middle = mesh.p[:, mesh.facets[:, outside]].mean(axis=1)
    facets = outside[:0] if held is None else outside[held(middle)]
    solid = _isoparametric(mesh, KINDS[kind], materials)
    edges = sharp_edges(solid, [STEEL, SOFT], facets)
    return {
        (tuple(mesh.p[:, ends].mean(axis=1).round(9))): exponent
        for ends, exponent in zip(mesh.edges[:, edges.numbers].T, edges.exponents)
    }


def wedges(*parts, **rest):
    return pytest.approx(wedge_exponent([(turns * QUARTER, m) for turns, m in parts], **rest))


@pytest.mark.parametrize("kind", KINDS)
def test_a_cube_has_none_and_a_corner_cut_out_three(kind):
    assert not cube(kind)
    edges = cube(kind, hollow=lambda m: (m > 0.5).all(axis=0))
    assert len(edges) == 6  # two edges of cells each
    assert list(edges.values()) == 6 * [pytest.approx(0.5444837, abs=1e-7)]


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_held_ends_in_a_face_or_at_an_edge(kind):
    """On a smooth face stress goes with the root; a right angle held on one side is less sharp."""
    edges = cube(kind, held=lambda m: (m[1] < 1e-9) & (m[0] < 0.5))
    for (x, y, _), exponent in edges.items():
        assert y == 0
        assert exponent == (pytest.approx(0.5) if x == 0.5 else wedges((1, STEEL), held=1))
    assert len(edges) == 4 + 4 + 2 + 2


@pytest.mark.parametrize("kind", KINDS)
def test_a_held_face_that_ends_at_a_joint_sees_both_materials(kind):
    """The soft one under it: across the plane tan^2(a pi / 2) is the ratio of the shear moduli."""
    ratio = SOFT.shear_modulus / STEEL.shear_modulus
    expected = 2 / math.pi * math.atan(math.sqrt(ratio))
    for sides in (1, -1):
        edges = cube(
            kind,
            held=lambda m, s=sides: (m[1] < 1e-9) & (s * (m[0] - 0.5) < 0),
            soft=lambda m, s=sides: s * (m[0] - 0.5) < 0,
        )
        met = [a for (x, y, _), a in edges.items() if (x, y) == (0.5, 0)]
        assert met == 4 * [pytest.approx(expected, rel=1e-6)]
        # elsewhere the joint ends at a free face
        above = [a for (x, y, _), a in edges.items() if (x, y) == (0.5, 1)]
        assert above == 4 * [wedges((1, SOFT), (1, STEEL))]


@pytest.mark.parametrize("kind", KINDS)
def test_a_joint_that_turns_inside_counts_and_a_flat_one_does_not(kind):
    edges = cube(kind, soft=lambda m: (m[0] < 0.5) & (m[1] < 0.5))
    inner = {place: a for place, a in edges.items() if place[:2] == (0.5, 0.5)}
    assert list(inner.values()) == 4 * [wedges((1, SOFT), (3, STEEL), closed=True)]
    assert all(0 in (x, y) or 0 in (z, 1 - z) for x, y, z in edges if (x, y) != (0.5, 0.5))


def beside(folder, cells, bricks=True, soft=SOFT.E):
    """A steel block with a softer one beside it, 10 mm each, the foot of which is clamped up to the
    joint, loaded at the far face of the steel.
    """
    lines = np.linspace(-0.01, 0.01, 2 * cells + 1), *2 * [np.linspace(0, 0.01, cells + 1)]
    patches = {
        "foot": lambda m: (m[1] < 1e-9) & (m[0] < 0),
        "end": lambda m: m[0] > 0.01 - 1e-9,
    }
    parts = {"soft": lambda m: m[0] < 0, "hard": lambda m: m[0] > 0}
    write_boxes(folder / "two.msh", lines, patches, bricks=bricks, parts=parts)
    path = folder / "two.toml"
    path.write_text(
        f"""
material = {{ E = 2.07e11, nu = 0.3, density = 7850 }}
[body]
mesh = "two.msh"
unit = "mm"
axis = "none"
[body.materials]
soft = {{ E = {soft}, nu = 0.3, density = 1400 }}
[[bearing]]
name = "wall"
patch = "foot"
attachment = "rigid"
hold = "clamped"
[[port]]
name = "tip"
patch = "end"
"""
    )
    scene = sg.load(path)
    return scene, sg.build(scene, "solid")


#: m/N, along x, y and z, by hexahedra of scikit-fem alone, cut towards the joint's end
RIGHT = {0: 8.01e-9, 1: 3.91e-8, 2: 2.77e-8}


@pytest.mark.parametrize("bricks", [True, False])
def test_bars_hold_where_a_clamp_ends_at_a_joint(tmp_path, bricks):
    """Both meshes are too stiff by 10 to 150 %; with the exponent of a smooth face bars were a third of
    that, and excluded each other.
    """
    ranges = []
    for cells in (1, 2):
        scene, body = beside(tmp_path, cells, bricks)
        bounds = solid_bounds(scene, body, statics=True)
        low, high = (
            sg.condense(bounds.softer(more), scene, "tip").compliance.diagonal()
            for more in (bounds.least, LOCAL * bounds.more)
        )
        for way, right in RIGHT.items():
            assert low[way] < right < high[way]
            assert high[way] - low[way] < 3 * (right - low[way])
        ranges.append((low, high))
        exponent = 2 / math.pi * math.atan(math.sqrt(0.1))
        # of the clamp's end alone; a clamp no wider than a few cells adds to it
        alone = 1 / (1 - (2 / 3) ** (4 * exponent))
        assert alone <= share_of_error(scene, body) < 1.4 * alone
    (low, high), (finer, softer) = ranges
    assert (finer < high).all() and (low < softer).all()


def test_there_is_no_bar_where_no_cell_is_small_enough(tmp_path):
    """Rubber on steel: half of what the end of the clamp gives way lies within a billionth of the body."""
    with pytest.raises(NoBounds, match="no mesh resolves the edge at x = 0, y = 0, z = "):
        share_of_error(*beside(tmp_path, 1, soft=1e7))


def test_places_of_a_mesh_have_the_exponent_of_what_meets_there(tmp_path):
    scene, body = beside(tmp_path, 2)
    places = {place.what: place for place in CellPlaces.of_body(scene, body).places}
    assert set(places) == {"end of patch foot", "end of patch end", "change of material"}
    exponent = 2 / math.pi * math.atan(math.sqrt(0.1))
    assert places["end of patch foot"].exponent == pytest.approx(exponent)
    assert places["end of patch end"].exponent == 1.0
    assert places["change of material"].exponent == wedges((1, SOFT), (1, STEEL))
