"""Geometry of a 3D mesh beside that of the shaft: moments of its parts, and what they cost a bar."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

import solidgear as sg
from solidgear import Bearing, Port, Scene, Segment
from solidgear.core.body import as_supports
from solidgear.core.judge.bounded import bounded, geometry_share
from solidgear.core.judge.quantities import size
from solidgear.core.judge.solving import Statics, numbers, search_modes
from solidgear.core.ladder import build
from solidgear.core.meshing import geometry, tetrahedra
from solidgear.core.meshing.geometry import geometry_error, misshapen, moments_of
from solidgear.core.meshing.quality import MeshError
from solidgear.core.quantity import Quantity
from solidgear.core.scene.closed_form import moments_of_parts, parts_of
from solidgear.core.scene.outline import Frustum, Outline
from solidgear.cuts.features import BoltCircle
from solidgear.cuts.sector.body import cyclic_features, meshed_sector
from solidgear.cuts.sector.meshing import sector_shapes

NAMES = [Quantity(name) for name in ("C_zz", "C_thx", "C_yy", "bending 1", "axial 1", "torsion 1")]
FEW_CELLS = {"layers": 1, "radial_layers": 1, "edge_layers": 0, "relative_size": 1.0}
#: a wide disc on a thin shaft: edges between the two circles of the step beside it fold
RADII = (0.0108, 0.0135, 0.0553, 0.0135, 0.0108)
ENDS = (0.0, 0.0987, 0.1146, 0.1605, 0.1801, 0.1946)
STEEP = Outline([Frustum(a, b, r, r, 0.0, 0.0) for a, b, r in zip(ENDS, ENDS[1:], RADII)])
SIZES = {"planes": [0.1284, 0.1381], "circles": [0.0, 0.018], "size": 0.0615, "around": 8}


def steep(**sizes):
    return tetrahedra.tetrahedra(STEEP, **SIZES, graded_size=0.0615 / 4, **sizes)


def radius(piece, y):
    """Radius of a line or arc of the meridian at a place."""
    if piece.corner is None or piece.corner.centre is None:
        return piece.r0 + (piece.r1 - piece.r0) * (y - piece.y0) / (piece.y1 - piece.y0)
    r, middle = piece.corner.centre
    away = np.sqrt(max(piece.corner.radial**2 - (y - middle) ** 2, 0.0))
    return r - piece.corner.out * away


def under(piece, middle, along, out):
    """Integral of powers of y and of the radius below a piece of the meridian, times pi."""

    def height(y):
        return np.pi * (y - middle) ** along * radius(piece, y) ** out

    return quad(height, piece.y0, piece.y1, epsabs=1e-16, epsrel=1e-10)[0]


def test_moments_of_cones_bores_and_fillets_are_integrals_along_the_axis():
    """The part with a fillet takes in the segments on both sides of it."""
    outline = sg.load("geometry/pinion_filleted.toml").outline
    cone = Outline([Frustum(0.1, 0.3, 0.05, 0.02, 0.01, 0.015)])
    for shaft in (outline, cone):
        parts, exact = parts_of(shaft), moments_of_parts(shaft)
        summed = np.zeros((len(parts.middles), 4))
        for piece in shaft.pieces:
            part = parts.of_segments[piece.segment]
            sign = 1 if piece.surface == "outer" else -1
            middle = parts.middles[part]
            for k, (along, out) in enumerate(((0, 2), (1, 2), (2, 2), (0, 4))):
                summed[part, k] += sign * under(piece, middle, along, out)
        of_places = np.stack(
            [exact[:, 0, 0], exact[:, 0, 2], exact[:, 2, 2], 4 * exact[:, 1, 1]], 1
        )
        assert of_places == pytest.approx(summed, rel=1e-8, abs=1e-8 * summed.max())
    assert list(parts_of(outline).of_segments) == [0, 1, 1]


def test_steps_are_meshed_finer_until_no_segment_lacks_anything(monkeypatch):
    """Straight edges take 1e-3 of segments and more; one mesh alone leaves it, and says so."""
    mended = steep()
    assert mended.quality.geometry < 3e-4
    monkeypatch.setattr(tetrahedra, "FINER", (1.0,))
    alone = steep()
    assert alone.quality.geometry > 1e-3
    # volumes that other edges give back are not the second moments that were lost
    assert abs(alone.quality.volume / mended.quality.volume - 1) < 1e-4


@pytest.mark.long
def test_volume_that_a_mesh_of_a_small_motor_loses_is_in_its_facts(monkeypatch):
    """Cutting folded elements in two keeps it; straight edges take 1e-3 of the volume without."""
    ends, radii = (0.0, 4e-3, 10e-3, 13e-3), (0.5e-3, 1e-3, 0.4e-3)
    motor = Outline([Frustum(a, b, r, r, 0.0, 0.0) for a, b, r in zip(ends, ends[1:], radii)])
    circles = [0.7e-3, 1.3e-3, 6.5e-3, 7.5e-3, 11.5e-3, 12.1e-3]
    size = 1e-3 / 3 / 0.4
    sizes = {"size": size, "graded_size": size / 4, "around": 8}
    monkeypatch.setattr(tetrahedra, "FINER", (1.0,))
    assert tetrahedra.tetrahedra(motor, [], circles, **sizes).quality.geometry < 2e-4
    monkeypatch.setattr(tetrahedra, "bisected", lambda filling: filling)
    assert tetrahedra.tetrahedra(motor, [], circles, **sizes).quality.geometry > 1e-3


def test_a_mesh_far_from_the_shaft_is_refused(monkeypatch):
    monkeypatch.setattr(geometry, "REFUSED", 1e-3)
    monkeypatch.setattr(tetrahedra, "FINER", (1.0,))
    with pytest.raises(MeshError, match="off in volume or second moments.*raise refinement"):
        steep()


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_displaced_node_shows(axis):
    outline = Outline([Frustum(0.0, 0.05, 0.02, 0.02, 0.0, 0.0)])
    made = tetrahedra.tetrahedra(outline, size=0.01, around=16)
    exact = moments_of_parts(outline)
    before = geometry_error(misshapen(moments_of(made.mesh, made.segment, outline), exact))
    places = made.mesh.doflocs.copy()
    x, y, z = places[:, : made.mesh.p.shape[1]]
    # on the rim of a section, or in the middle of an end
    farthest = (x, y - np.hypot(x, z), z)[axis]
    places[axis, np.argmax(farthest)] += 1e-3
    moved = replace(made.mesh, doflocs=places)
    shapes = misshapen(moments_of(moved, made.segment, outline), exact)
    assert before < 5e-5 and geometry_error(shapes) > 10 * before


def dumbbell():
    """Two bodies on a thin shaft, on two bearings."""
    ends, diameters = (0.0, 0.04, 0.1, 0.14), (0.06, 0.03, 0.06)
    segments = [
        Segment.cylinder(f"s{k}", length=b - a, diameter=d, y0=a)
        for k, (a, b, d) in enumerate(zip(ends, ends[1:], diameters))
    ]
    springs = np.diag([2e8, 1e8, 2e8, 1e4, 0.0, 1e4]).tolist()
    bearings = [
        Bearing(name=n, y=y, seat_width=0.01, matrix=springs) for n, y in (("A", 0.02), ("B", 0.12))
    ]
    return Scene.from_parts(
        segments, bearings=bearings, port=Port(name="gear", y=0.07, lo=0.065, hi=0.075)
    )


def judged(scene, body):
    supports = as_supports(scene)
    statics = Statics.for_quantities(scene, body, supports, NAMES)
    modes = search_modes(body, supports, 10, NAMES[3:], spare=True)
    values = numbers(statics, modes)
    bars = bounded(scene, body, supports, statics, modes, NAMES, values.solver).error_bars
    return values.quantities, bars


@pytest.mark.long
def test_bars_of_straight_elements_hold_on_both_sides():
    """Polygons of eight and of sixteen sides: frequencies lie below the exact ones by up to a tenth of
    them, softer bodies being too heavy by less than they are soft, so that a bar without geometry, which
    is one for bodies too stiff, does not hold.
    """
    scene = dumbbell()
    exact = {v.quantity: v.value for v in sg.answer(scene, 1e-3, ask=NAMES).values}
    body = build(scene, "solid", element="hex8", around=8, **FEW_CELLS)
    # an octagon has 0.90 of the area of its circle, and 0.81 of the second moment
    assert body.mesh["geometry"] == pytest.approx(0.19, abs=0.02)
    values, bars = judged(scene, body)
    error = {q: abs(values[q] - exact[q]) / size(values, q) for q in NAMES}
    assert all(error[q] < bars[q].width for q in NAMES)
    assert sum(error[q] > bars[q].width - bars[q].geometry for q in NAMES) >= 2


@pytest.mark.long
def test_statics_have_all_of_it_and_frequencies_half():
    scene = dumbbell()
    body = build(scene, "solid", element="tet10", refinement=0.3)
    assert 0 < body.mesh["geometry"] < 2e-4
    lacking = replace(body, mesh={**body.mesh, "geometry": 0.2})
    assert geometry_share(lacking) == pytest.approx(0.25)
    _, narrow = judged(scene, body)
    _, wide = judged(scene, lacking)
    for name in NAMES:
        part = 0.5 if name.is_frequency else 1.0
        added = wide[name].width - narrow[name].width
        assert added == pytest.approx(part * (0.25 - geometry_share(body)), rel=1e-6)


@pytest.mark.parametrize("file", ["pinion_toothed.toml", "pinion_spiral.toml"])
def test_teeth_have_closed_forms(file):
    """Their faces are planes: a straight toothed segment is exact to rounding."""
    scene = sg.load(f"geometry/{file}")
    features = cyclic_features(scene)
    ports = [(s, s.attachment) for s in scene.stations]
    made = meshed_sector(scene, ports, features, refinement=0.4)
    shapes = sector_shapes(made, scene.outline, features)
    assert (
        made.quality.geometry == pytest.approx(geometry_error(shapes))
        and geometry_error(shapes) < 2e-5
    )
    if file == "pinion_toothed.toml":
        assert shapes[0].error < 1e-12


def test_bolt_circles_have_closed_forms():
    holes = BoltCircle(name="b", segment="rod", count=5, diameter=0.008, circle=0.03)
    rod = Segment.cylinder("rod", length=0.03, diameter=0.05)
    scene = Scene.from_parts([rod], features=[holes])
    body = build(scene, "sector", refinement=0.7)
    # left out of the closed form they are a tenth of the second moment
    assert 0 < body.mesh["geometry"] < 3e-4


def test_cut_shafts_are_compared_with_their_cuts_filled():
    """Halves with their images, and what the cut itself lacks beside them."""
    scene = sg.load("geometry/pinion_keyed.toml")
    halves = build(scene, "solid", element="tet10", refinement=0.35)
    whole = build(scene, "solid", element="tet10", refinement=0.35, half=False)
    assert halves.mesh["mirror_plane"] != "none" == whole.mesh["mirror_plane"]
    assert 0 < halves.mesh["geometry"] < 3e-4 and 0 < whole.mesh["geometry"] < 3e-4
