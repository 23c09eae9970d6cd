"""Layers held on both sides: what one order more finds of the error at their free rims."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from skfem import MeshHex, MeshTet

import solidgear as sg
from solidgear import Scene, Segment
from solidgear.core.bounds.layers import Held, Layers
from solidgear.core.bounds.narrow import mesh_of
from solidgear.core.bounds.solid import share_of_error, solid_bounds
from solidgear.core.errors import NoBounds
from solidgear.core.safety import LOCAL, RIM
from solidgear.core.scene import Material
from solidgear.parts.own_mesh import solid_body

PAD = Path(__file__).parent / "found/parts/rubber_pad_block.toml"
#: m/N, by plane-strain elements of order 5 written apart, and rad/(N m), by a graded mesh of 266000
#: unknowns, both within 0.1 %
RIGHT = {"C_zz": 5.027e-7, "C_thy": 3.0155e-4}
PLACES = {"C_zz": (2, 2), "C_thy": (4, 4)}
STEEL = Material(E=2.07e11, nu=0.3, density=7850.0)
RUBBER = Material(E=5e6, nu=0.499, density=1200.0)


def ends(scene, body):
    """The least and the most that compliances may be."""
    bounds = solid_bounds(scene, body, statics=True)
    low, high = (
        sg.condense(bounds.softer(more), scene, "top").compliance
        for more in (bounds.least, LOCAL * bounds.more)
    )
    return {name: (low[place], high[place]) for name, place in PLACES.items()}


def even(kind, across, along, nu=0.49):
    """The pad on even boxes, or on tetrahedra, so many across and along it, as others mesh it."""
    scene = sg.load(PAD)
    scene = scene.with_changes(material=scene.material.with_changes(nu=nu))
    half = np.linspace(-0.05, 0.05, along + 1)
    boxes = kind.init_tensor(half, np.linspace(0, 0.005, across + 1), half)
    # those of scikit-fem are left-handed
    mesh = boxes if kind is MeshTet else MeshHex(boxes.p * [[-1.0], [1.0], [1.0]], boxes.t)
    y = mesh.p[1, mesh.facets]
    patches = {"-y": np.flatnonzero(y.max(axis=0) < 1e-9)}
    patches["+y"] = np.flatnonzero(y.min(axis=0) > 0.005 - 1e-9)
    element = "tet10" if kind is MeshTet else "hex20"
    facts = {"refinement": 1.0, "axis": False}
    body = solid_body(mesh, scene, element=element, patches=patches, facts=facts, clipped=False)
    return scene, body


def test_the_bar_of_a_rubber_pad_holds():
    """It printed C_zz 4.973e-7 +- 0.71 %: wide cells see little of how the rim gives way."""
    scene = sg.load(PAD)
    body = sg.build(scene, "solid", refinement=0.5)
    for name, (low, high) in ends(scene, body).items():
        assert low < RIGHT[name] < high < 1.02 * low


@pytest.mark.parametrize("kind", [MeshHex, MeshTet])
def test_bars_hold_on_even_meshes_of_others(kind):
    """Where cells at the rim are 2.5 times as wide as the layer is thick, bars were a third to a half
    of the error.
    """
    scene, body = even(kind, 2, 8)
    bounds = solid_bounds(scene, body, statics=True)
    narrow = replace(bounds, share=bounds.share - Layers.of(scene, body, mesh_of(body)).added_share)
    z = PLACES["C_zz"]
    most, without = (
        sg.condense(b.softer(LOCAL * b.more), scene, "top").compliance[z] for b in (bounds, narrow)
    )
    assert without < RIGHT["C_zz"] < most


def test_the_rim_counts_by_width_over_thickness_and_by_poissons_ratio():
    """Boxes 12.5 mm wide at a rim of 5 mm."""
    shares = {nu: added(*even(MeshHex, 2, 8, nu)) for nu in (0.3, 0.49)}
    for nu, share in shares.items():
        assert share == pytest.approx(RIM * (2 * nu) ** 4 * 2.5**2)


def added(scene, body):
    """What rims add to the share of a body."""
    return Layers.of(scene, body, mesh_of(body)).added_share


@pytest.mark.parametrize("kind", [MeshHex, MeshTet])
def test_a_layer_one_cell_thick_near_a_half_has_no_bar(kind):
    with pytest.raises(NoBounds, match="the body, of Poisson's ratio 0.49, is held on both") as why:
        share_of_error(*even(kind, 1, 8))
    assert why.value.finer_helps
    # nothing locks at 0.3
    assert share_of_error(*even(kind, 1, 8, nu=0.3)) > 1


def test_a_ring_between_two_others_is_a_layer_and_a_bar_is_none():
    """A clamped disc at an end: held by its rigid seat and by the joint."""
    parts = [
        Segment.cylinder("a", length=0.03, diameter=0.04, material=STEEL),
        Segment.cylinder("layer", y0=0.03, length=0.004, diameter=0.04, material=RUBBER),
        Segment.cylinder("b", y0=0.034, length=0.03, diameter=0.04, material=STEEL),
    ]
    coarse = {"element": "hex20", "layers": 0, "radial_layers": 0, "edge_layers": 0, "around": 8}
    scene = Scene.from_parts(parts, port=sg.Port(y=0.008, lo=0.003, hi=0.013), bearings=[])
    layered = sg.build(scene, "solid", relative_size=0.2, **coarse)
    assert added(scene, layered) > 0
    steel = [part.with_changes(material=STEEL) for part in parts]
    scene = Scene.from_parts(steel, port=scene.port, bearings=[])
    assert added(scene, sg.build(scene, "solid", **coarse)) == 0


def test_modes_of_a_thin_layer_come_in_twins():
    """Its clamp left the foot in motion by the difference of two rigid motions: an error of 20 % was
    said of a mode, and a beam advised for a pad. A square pad shears both ways alike.
    """
    scene = sg.load(PAD)
    first, second, *_ = sg.modes(sg.build(scene, "solid", refinement=0.5), scene, 4).modes
    assert first.frequency_hz == pytest.approx(second.frequency_hz, rel=1e-8)
    assert max(first.error, second.error) < 1e-9


def strip(whole):
    """Tetrahedra of a layer of 20 x 1 x 1 mm between held faces, with nodes halfway up on the first
    columns of its meridian: with so many of 20 there two cells lie across, on the others one.
    """

    def place(x, level):
        return 3 * x + level

    triangles = []
    for x in range(20):
        low, high = (place(x, 0), place(x + 1, 0)), (place(x, 2), place(x + 1, 2))
        left, right = (place(x, 1), place(x + 1, 1))
        if x + 1 <= whole:
            triangles += [(*low, left), (low[1], left, right), (left, right, high[0])]
            triangles += [(right, *high)]
        elif x == whole:
            triangles += [(*low, left), (low[1], left, high[1]), (left, *high)]
        else:
            triangles += [(*low, high[0]), (low[1], *high)]
    flat = np.array([(x, level / 2, 0.0) for x in range(21) for level in range(3)])
    points = np.vstack([flat, flat + [0.0, 0.0, 1.0]])
    cells = []
    for a, b, c in np.sort(triangles, axis=1):
        d, e, f = len(flat) + np.array([a, b, c])
        cells += [(a, b, c, f), (a, b, e, f), (a, d, e, f)]
    used, number = np.unique(cells, return_inverse=True)
    mesh = MeshTet(1e-3 * points[used].T, number.reshape(-1, 4).T)
    y = mesh.p[1, mesh.facets]
    facets = np.flatnonzero((np.ptp(y, axis=0) < 1e-9) & np.isin(y[0], (0.0, 1e-3)))
    out = np.zeros((3, len(facets)))
    out[1] = np.sign(y[0, facets] - 5e-4)
    held = Held(facets, mesh.f2t[0, facets], out, (out[1] > 0).astype(int))
    return SimpleNamespace(mesh=mesh, segment=np.zeros(mesh.t.shape[1], int)), held


@pytest.mark.parametrize(
    ("nu", "whole", "locks"),
    [
        (0.3, 0, False),
        (0.49, 0, True),
        (0.49, 20, False),
        (0.4999, 20, False),
        (0.49, 18, False),
        (0.4999, 18, True),
    ],
)
def test_a_few_cells_from_face_to_face_lock_a_layer_that_keeps_its_volume(nu, whole, locks):
    """A bonded bush of rubber 5 mm long and 1 mm thick, cells of 0.55 mm, of which 6 % reach across:
    the bar of C_thx was 1.9 errors at nu = 0.49, and 0.6 at 0.4999, against mixed elements. With cells of
    0.5 mm, of which none does, 1.6 and 1.8.
    """
    mesh, held = strip(whole)
    layers = Layers(mesh, (Material(E=6e6, nu=nu, density=1100),), ("the layer",), (), held, False)
    if not locks:
        layers.refuse_locked()
        return
    with pytest.raises(NoBounds, match="one cell thick") as refused:
        layers.refuse_locked()
    assert refused.value.finer_helps and ("in places" in str(refused.value)) == (whole > 0)
