"""References of campaigns: meshes, elements and extrapolation against closed forms, rigid motion and
solutions with which they share nothing.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.judge.quantities import measure, size
from solidgear.core.scene import STEEL, Bearing, Port, Scene, Segment
from solidgear.core.scene.closed_form import mass_properties
from solidgear.core.scene.outline import Outline
from solidgear.cuts.features import BoltCircle, CrossHole, Flat, Keyway, Teeth
from solidgear.cuts.sector.teeth import section_area, section_polar
from validation.campaign.truths import elsewhere
from validation.campaign.truths import reference as spectral_levels
from validation.campaign.truths.corner_mesh import corner_mesh, singular_points
from validation.campaign.truths.reference import SURE, settle, spectral_reference
from validation.campaign.truths.spectral import spectral
from validation.campaign.truths.triangle_mesh import sharpened, triangle_mesh
from validation.campaign.truths.triangle_solid import FAMILIES, Solid
from validation.campaign.truths.triangles import triangle_reference
from validation.campaign.truths.volumes import removed_mass, toothed_area

#: a second for all families, and five digits
COARSE = {"order": 3, "finest": 1e-5, "growth": 0.6}
SPRINGS = {"kxx": 4e8, "kyy": 2e8, "kzz": 4e8, "kthy": 1e4}


def stepped(tie: str = "average", bore: float = 0.0, **springs: float) -> Scene:
    """Two diameters, the lumped point beside the shoulder, a bearing near each end."""
    segments = [
        Segment(name="neck", y0=0.0, y1=0.06, outer0=0.02, outer1=0.02, inner0=bore, inner1=bore),
        Segment(name="body", y0=0.06, y1=0.14, outer0=0.03, outer1=0.03, inner0=0.01, inner1=0.01),
    ]
    seats = [
        Bearing(name=name, y=y, seat_width=0.01, stiffness=SPRINGS | springs, attachment=tie)
        for name, y in (("A", 0.01), ("B", 0.125))
    ]
    port = Port(name="p", y=0.05, lo=0.04, hi=0.058, attachment=tie)
    return Scene.from_parts(segments, bearings=seats, port=port)


# ------------------------------------------------------------------------------------------------
# - corners and spectral elements
def test_corner_cuts_keep_the_mesh_whole():
    mesh = corner_mesh(stepped(bore=0.01), 3, 2.0, 0.2)
    x, y = np.moveaxis(mesh.points[mesh.cells], 2, 0)
    area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    assert area.min() > 0
    # the meridian without its bore, in closed form
    assert area.sum() == pytest.approx(0.06 * 0.01 + 0.08 * 0.02, rel=1e-12)
    ends = np.stack([mesh.cells, np.roll(mesh.cells, -1, axis=1)], axis=2)
    edges, count = np.unique(np.sort(ends, axis=2).reshape(-1, 2), axis=0, return_counts=True)
    assert count.max() == 2
    # no hanging nodes: the edges of one cell only close to the outline
    outline = np.linalg.norm(np.diff(mesh.points[edges[count == 1]], axis=1)[:, 0], axis=1).sum()
    assert outline == pytest.approx(2 * 0.14 + 0.01 + 0.02 + 0.01, rel=1e-12)


@pytest.mark.long
def test_layers_shrink_by_the_ratio_at_every_corner():
    scene = stepped()
    shortest = [
        [
            np.sort(np.linalg.norm(corner_mesh(scene, layers, 2.0, 0.2).points - point, axis=1))[1]
            for point in singular_points(scene)
        ]
        for layers in (2, 3)
    ]
    assert len(shortest[0]) >= 5 and np.allclose(np.divide(*shortest[::-1]), 0.2)


def test_spectral_elements_twist_a_bar_exactly():
    """Between section means in a uniform bar, torsion is Saint-Venant's solution, linear along
    the shaft: 1/k + l / (G J).
    """
    matrix = np.diag([1e8, 1e8, 1e8, 1e4, 3e5, 1e4])
    seat = Bearing(name="1", y=0.05, seat_width=0.02, matrix=matrix, attachment="section")
    port = Port(y=0.25, lo=0.2, hi=0.3, attachment="section")
    bar = [Segment.cylinder("bar", length=0.3, diameter=0.05)]
    scene = Scene.from_parts(bar, bearings=[seat], port=port)
    body = spectral(scene, corner_mesh(scene, 2, 2.0, 0.2), 4)
    twist = sg.condense(body, scene, "port").compliance[4, 4]
    exact = 1 / 3e5 + 0.2 / (scene.material.shear_modulus * math.pi / 2 * 0.025**4)
    # rounding: the free body is factored near its rigid motion
    assert twist == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize(
    "tie",
    [
        pytest.param("rigid", marks=pytest.mark.long),
        *(pytest.param(t, marks=pytest.mark.slow) for t in ("average", "section")),
    ],
)
def test_spectral_elements_agree_with_the_product(tie):
    scene = stepped(tie, bore=0.01)
    mine = spectral(scene, corner_mesh(scene, 5, 2.0, 0.2), 4)
    options = {"order": 4, "layers": 3, "edge_layers": 3, "ratio": 0.2, "size": 0.04}
    theirs = sg.build(scene, "harmonic", refinement=1.0, **options)
    exact = mass_properties(Outline(scene.segments))
    assert mine.mass_matrix()[0, 0] == pytest.approx(exact.mass, rel=1e-12)
    assert mine.mass_matrix()[4, 4] == pytest.approx(exact.iyy, rel=1e-12)
    assert mine.rigid_residual() < 1e-13
    a, b = (sg.condense(body, as_supports(scene), "p").compliance for body in (mine, theirs))
    # three layers of the product at a rigid seat leave 2e-4; a wrong tie, sign or strain shows in
    # per cents
    assert np.allclose(np.diag(a), np.diag(b), rtol=5e-4)
    assert abs(a[2, 3] - b[2, 3]) < 5e-4 * math.sqrt(b[2, 2] * b[3, 3])


def test_settling_extrapolates_what_falls_geometrically():
    a, b, c = (2.0 + 0.3**k for k in (3, 4, 5))
    value, doubt = settle(a, b, c, a, 2.0)
    assert value == pytest.approx(2.0, rel=1e-12)
    # Aitken's own step is what the last value lacks
    assert doubt == pytest.approx(SURE * 0.3**5 / 2.0, rel=1e-9)


def test_settling_doubts_what_does_not():
    value, doubt = settle(1.0, 1.1, 0.9, 1.0, 1.0)
    assert value == 0.9 and doubt == pytest.approx(SURE * 0.3)
    # two layers less that move a value by 0.1 leave at most 0.2^2 of it for the layers not there
    assert settle(1.0, 1.0, 1.0, 1.1, 1.0)[1] == pytest.approx(0.1 * 0.04 / 0.96)
    assert settle(1.0, 1.0, 1.0, 1.0, 1.0, noise=1e-5) == (1.0, 1e-5)


@pytest.mark.slow
def test_the_spectral_reference_is_as_good_as_it_says(monkeypatch):
    monkeypatch.setattr(spectral_levels, "LEVELS", ((2, 2), (3, 3)))
    scene = stepped("rigid")
    light, fine = (spectral_reference(scene, level, 100_000) for level in (0, 1))
    assert light.setting == [4, 2] and fine.setting == [5, 3]
    for name, value in light.values.items():
        apart = abs(value - fine.values[name]) / size(fine.values, name)
        assert apart <= light.uncertainty[name] + fine.uncertainty[name], name
    assert spectral_reference(scene, 0, limit=1000) is None


# ------------------------------------------------------------------------------------------------
# - triangles
def test_torsion_of_a_bar_is_a_standing_wave():
    bar = Scene.from_parts([Segment.cylinder("bar", length=0.2, diameter=0.04)])
    found = triangle_reference(bar, families=["torsion"], modes=2)
    speed = math.sqrt(STEEL.shear_modulus / STEEL.density)
    for k in (1, 2):
        number, wave = found[f"torsion {k}"], k * speed / (2 * 0.2)
        assert abs(number.value - wave) <= number.uncertainty * wave < 1e-8 * wave
    # nothing resists a turn
    assert set(found) == {"torsion 1", "torsion 2"}


@pytest.mark.long
def test_a_shaft_stands_on_its_axial_springs():
    """Of two soft springs in parallel hardly anything but the springs is left, to their ratio to
    the shaft: rounding of the shaft's stiffness does not show.
    """
    soft = 1e3
    found = triangle_reference(stepped(kyy=soft), families=["axial"], modes=0, **COARSE)
    give = found["C_yy"].value * 2 * soft
    assert 0 < give - 1 < soft / (STEEL.E * 0.02)
    assert found["C_yy"].uncertainty < 1e-8


@pytest.mark.slow
def test_two_discretisations_that_share_nothing_agree():
    """All three attachments on one shaft: the harmonic solid as it comes is good to 1e-4."""
    scene = stepped()
    first, last = scene.bearings
    rigid = scene.port.with_changes(attachment="rigid")
    mixed = (first, last.with_changes(attachment="section"))
    scene = scene.with_changes(bearings=mixed, port=rigid)
    found = triangle_reference(scene, modes=1, **COARSE)
    values = {name: number.value for name, number in found.items()}
    body = sg.build(scene, "harmonic")
    product = measure(sg.condense(body, scene, port="p"), sg.modes(body, scene, n=4))
    assert set(found) <= set(product) and len(found) == 13
    for name, number in found.items():
        assert number.uncertainty < 3e-5
        assert abs(product[name] - number.value) < 1e-4 * size(values, name)


def test_rigid_motion_strains_nothing_and_energies_are_those_of_the_matrices():
    scene = stepped("section").with_changes(port=stepped().port)
    solid = Solid(scene, triangle_mesh(scene, finest=1e-2), 3)
    dice = np.random.default_rng(3)
    for family in FAMILIES.values():
        parts = list(family.parts)
        for k, component in enumerate(family.components):
            motion = solid.rigid(component, scene.port.y)[parts].ravel()
            assert abs(solid.energy(family, motion[:, None])) < 1e-20
            mean = solid.mean(family, scene.port) @ motion
            assert mean == pytest.approx(np.eye(len(mean))[k], abs=1e-12)
        stiffness, _ = solid.matrices(family)
        moved = dice.standard_normal((stiffness.shape[0], 2))
        if family.waves != 1 and 0 in parts:  # no hoop strain at the axis without bounds
            moved.reshape(len(parts), -1, 2)[:, solid.axis] = 0.0
        assert solid.energy(family, moved) == pytest.approx(moved.T @ stiffness @ moved, rel=1e-10)


@pytest.mark.long
def test_a_rigid_seat_stays_round():
    """Rings hold the wall there: no ovalising is as slow as without."""
    loose, kept = (
        triangle_reference(stepped(tie), families=["n=2"], modes=1, order=3, finest=1e-3)["n=2 1"]
        for tie in ("average", "rigid")
    )
    assert kept.value > 1.01 * loose.value


def test_parting_triangles_at_a_corner_keeps_the_area():
    mesh = triangle_mesh(stepped("rigid"), finest=1e-2)
    corner = int(np.argmin(np.hypot(*(mesh.points - [[2 / 3], [2.0]]))))
    finer = sharpened(mesh, np.array([corner]))
    added = finer.triangles.shape[1] - mesh.triangles.shape[1]
    assert added == 2 * (mesh.triangles == corner).sum()

    def area(of):
        (a, b, c), (d, e, f) = (of.points[k][of.triangles] for k in (0, 1))
        return abs((b - a) * (f - d) - (c - a) * (e - d)).sum() / 2

    assert area(finer) == pytest.approx(area(mesh), rel=1e-14)
    assert area(mesh) == pytest.approx(2 / 3 * 2 + 2 / 3 * 8 / 3, rel=1e-12)


def test_shafts_unknown_to_triangles_are_refused():
    with pytest.raises(sg.SolidgearError, match="couples planes"):
        triangle_reference(stepped(kxz=1e7))
    with pytest.raises(sg.SolidgearError, match="housing_axial"):
        triangle_reference(stepped().with_changes(housing_axial=1e8))
    at_step = stepped().port.with_changes(y=0.06, attachment="section")
    with pytest.raises(sg.SolidgearError, match="two sizes"):
        triangle_mesh(stepped().with_changes(port=at_step))


# ------------------------------------------------------------------------------------------------
# - mass of features
def test_points_are_counted_as_closed_forms_say():
    """A quarter of a million points of a low-discrepancy sequence: some 1e-3 of what is cut out."""
    rod = sg.Segment.cylinder("rod", length=0.3, diameter=0.06)
    key = Keyway(name="k", segment="rod", y=0.1, length=0.05, width=0.015, depth=0.006, angle=0.7)
    flat = Flat(name="f", segment="rod", y=0.2, length=0.05, depth=0.004)
    bolts = BoltCircle(name="b", segment="rod", count=5, diameter=0.008, circle=0.03)
    hole = CrossHole(
        name="h", segment="rod", y=0.1, diameter=0.012, inclination="50 deg", offset="-9 mm"
    )
    for feature, taken in (
        (hole, hole.volume(0.03, 0.0)),
        (key, key.volume(0.03, 0.0)),
        (flat, flat.volume(0.03, 0.0)),
        (bolts, 5 * math.pi * 0.004**2 * 0.3),
    ):
        mass = removed_mass(sg.Scene.from_parts([rod], features=(feature,)))
        assert mass[0, 0] == pytest.approx(7850 * taken, rel=4e-3)
    # a key at a quarter turn takes mass at +x, so that a turn about z moves it along +y
    side = key.with_changes(angle=math.pi / 2)
    mass = removed_mass(sg.Scene.from_parts([rod], features=(side,)))
    assert mass[1, 5] > 0 and abs(mass[1, 3]) < 1e-2 * mass[1, 5]


def test_teeth_from_their_definition_have_the_section_of_the_mesh():
    for more in ({}, {"flank_angle": 0.2, "half_thickness": 0.2}, {"addendum": 0.5}):
        teeth = Teeth(name="t", segment="s", count=14, **more)
        own = section_area(teeth), section_polar(teeth)
        assert np.allclose(toothed_area(teeth), own, rtol=1e-12)


# --------------------------------------------------------------------------- drawn bodies
@pytest.mark.parametrize("shape", ["Box", "Cylinder"])
def test_elements_elsewhere_pull_bend_and_twist_a_beam_as_books_say(shape):
    """Without contraction across, pull and pure bending are of second order, and the elements exact but for
    the roundness of the cylinder, as is its torsion; the first frequency of a rigid end on springs
    alone, f = sqrt(k / m) / 2 pi, lies 1 % above that of the beam, which gives way too.
    """
    length, side = 60.0, 10.0
    sizes = {"Box": (-side / 2, 0, -side / 2, side, length, side)}
    sizes["Cylinder"] = (0, 0, 0, 0, length, 0, side / 2)
    foot = elsewhere.Seat("foot", "rigid", plane=1, at=0.0, clamped=True)
    eye = elsewhere.Seat("eye", "average", plane=1, at=length)
    beam = elsewhere.Drawing((("add", shape, sizes[shape], 0.0),), (foot, eye), 8.0, nu=0.0)
    mesh = elsewhere.meshed(beam, 8.0)
    found = elsewhere.numbers(beam, mesh)
    area, inertia = (side**2, side**4 / 12) if shape == "Box" else (25 * math.pi, 625 * math.pi / 4)
    modulus = beam.E / 1e6  # N/mm^2
    assert found["C_yy"] == pytest.approx(length / (modulus * area) / 1e3, rel=1e-4)
    assert found["C_thx"] == pytest.approx(1e3 * length / (modulus * inertia), rel=3e-4)
    if shape == "Cylinder":
        twist = 1e3 * length / (modulus / 2 * 2 * inertia)
        assert found["C_thy"] == pytest.approx(twist, rel=3e-4)
    held = replace(foot, clamped=False, springs=(1e4, 1e9, 1e9, 1e6, 1e6, 1e6))
    soft = elsewhere.numbers(replace(beam, seats=(held, eye)), mesh)
    mass = beam.density * area * length * 1e-9
    assert soft["f1"] == pytest.approx(math.sqrt(1e4 / mass) / 2 / math.pi, rel=0.01)
    assert soft["C_xx"] - found["C_xx"] == pytest.approx(1e-4 + (length / 1e3) ** 2 / 1e6, rel=1e-6)
