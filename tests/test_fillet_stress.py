"""Stress of fillets by the harmonic solid: bars, convergence, symmetry, published factors, corners."""

import numpy as np
import pytest
from filleted import STRONG, shoulder

import solidgear as sg
from solidgear import SolidgearError
from solidgear.core.frames import rotation
from solidgear.core.models.harmonic.body import harmonic
from solidgear.core.scene import Chamfer, Fillet
from solidgear.core.solve.backends.matrix import FactorError
from solidgear.core.solve.statics import flexibility
from solidgear.strength.stress import notch
from solidgear.strength.stress.arc_stress import Arc, RootArc
from solidgear.strength.stress.notch import UNIT_LOADS, fillet_factors, piece_around
from solidgear.strength.stress.published import CHARTS
from solidgear.strength.stress.shaft import shaft_stress, sharp_corners
from validation.manual.exact_fillets import finite_elements

LOADS = UNIT_LOADS[:3]


@pytest.fixture(scope="module")
def found():
    return fillet_factors(shoulder(), "fillet")


@pytest.fixture(scope="module")
def loaded():
    """Stress of the shaft under the loads of :func:`loads_on`, by coarse bars."""
    return shaft_stress(shoulder(), loads_on(shoulder()), tolerance=0.05).notches[0]


@pytest.fixture(scope="module")
def fine():
    """A quarter more cells either way and an order more; orders 5 and 6 differ by less than 4e-3."""
    return fillet_factors(shoulder(), "fillet", orders=(6,), refinement=1.25)


@pytest.fixture(scope="module")
def orders():
    return fillet_factors(shoulder(), "fillet", 1e-9, orders=(4, 5, 6, 7)).steps


def errors(steps, fine, load):
    return [abs(step.factors[load] / fine.factors[load].value - 1) for step in steps]


@pytest.mark.parametrize("load", UNIT_LOADS)
def test_a_bar_holds_what_a_finer_mesh_changes(load, found, fine):
    one, truth = found.factors[load], fine.factors[load]
    assert abs(one.value - truth.value) < one.bar
    assert load == "shear" or one.bar < 0.01 * one.value
    assert abs(one.gradient - truth.gradient) < one.gradient_bar


@pytest.mark.long
@pytest.mark.parametrize("load", ["tension", "bending"])
def test_errors_fall_with_the_order(load, orders):
    """By a factor of two and more an order, which is what exponential convergence is."""
    fine = fillet_factors(shoulder(), "fillet", orders=(6,), refinement=1.5)
    fallen = errors(orders, fine, load)
    assert fallen[0] / fallen[2] > 4 and fallen[1] / fallen[3] > 4
    assert orders[-1].unknowns < 30000


@pytest.mark.parametrize("load", LOADS)
def test_published_factors_are_met(load, found):
    """Fits to another program's elements: 1 % of tension and bending, 2.5 % of torsion."""
    limit = 0.025 if load == "torsion" else 0.012
    assert found.factors[load].value == pytest.approx(finite_elements(load, 1.5, 0.1), rel=limit)


@pytest.mark.parametrize("key", CHARTS)
def test_coefficients_of_charts_are_typed_as_they_are_printed(key):
    """An endlessly deep shoulder has no notch at all: over D all four sum to one, their slopes to none."""
    total = np.sum(CHARTS[key], axis=0)
    assert total == pytest.approx([1.0, 0.0, 0.0], abs=0.06)


@pytest.mark.long
def test_ends_of_the_piece_do_not_matter(found):
    """At four radii they change nothing, at half a radius what Saint-Venant's principle leaves."""
    same = {"orders": (4, 5), "tolerance": 1e-9}
    usual, longer, short = (
        fillet_factors(shoulder(), "fillet", reach=reach, **same).factors for reach in (4, 6, 0.5)
    )
    for load in UNIT_LOADS:
        assert usual[load].value == pytest.approx(longer[load].value, rel=1e-4)
    assert abs(short["tension"].value / usual["tension"].value - 1) > 1e-3


@pytest.mark.long
def test_a_shaft_that_is_turned_around_has_the_same_factors(found):
    turned = fillet_factors(shoulder(turned=True), "fillet").factors
    for load in UNIT_LOADS:
        assert turned[load].value == pytest.approx(found.factors[load].value, rel=1e-9)
        assert turned[load].angle == pytest.approx(found.factors[load].angle, abs=1e-9)


@pytest.mark.long
def test_stress_grows_without_end_where_the_radius_goes_to_nothing():
    """As r^-0.456: Williams's exponent of a right-angled corner, 1 - 0.544."""
    values = [
        fillet_factors(shoulder(2.0, r), "fillet", 0.02, orders=(3, 4)).factors["tension"].value
        for r in (0.004, 0.002)
    ]
    assert np.log(values[1] / values[0]) / np.log(2) == pytest.approx(0.456, abs=0.025)


def loads_on(scene, turn=0.0):
    """10 kN across the gear, 2 kN along and 300 N m through it, turned about the axis."""
    a, b = (bearing.y for bearing in scene.bearings)
    share = (scene.port.y - a) / (b - a)
    six = np.array([0, 2e3, -1e4, 0, 300.0, 0])
    first, second = np.array([0, 0, 1e4, 0, 0, 0]), np.array([0, 0, 1e4, 0, 0, 0])
    first, second = first * (1 - share), second * share
    first[1], first[4] = -2e3, -300.0
    given = {"gear": six, "A": first, "B": second}
    return {name: rotation(1, turn) @ load for name, load in given.items()}


@pytest.mark.long
def test_amplitude_does_not_depend_on_the_direction_of_the_load(loaded):
    """Both planes are one; shear counts with the sign that it has beside bending."""
    scene = shoulder()
    turned = shaft_stress(scene, loads_on(scene, 0.7), tolerance=0.05).notches[0].local
    for name in ("amplitude", "mean", "shear", "amplitude_bar", "angle"):
        assert getattr(loaded.local, name) == pytest.approx(getattr(turned, name), rel=1e-9)


@pytest.mark.parametrize(
    "turned",
    [pytest.param(False, marks=pytest.mark.long), pytest.param(True, marks=pytest.mark.slow)],
)
def test_the_piece_has_the_stress_of_the_whole_shaft(turned):
    """Loads on the seats of the whole shaft, without section forces, pieces or superposition: the
    same stress on the fillet, by both meshes' bars; leaving the shear out would be off by 2 %.
    """
    scene = shoulder(turned=turned)
    loads = loads_on(scene)
    (notch,) = shaft_stress(scene, loads, tolerance=0.005).notches
    body = harmonic(scene, order=6, layers=3, edge_layers=0)
    fields = flexibility(body).fields
    arc = Arc(scene, body, RootArc.of(scene.corners[0]))
    six = np.array([loads[port.name] for port in body.ports])
    whole = {}
    for name, components in (("bending_z", [2, 3]), ("axial", [1]), ("torsion", [4])):
        index = [block.name for block in body.blocks].index(name)
        stress = arc.stress(body.blocks[index], fields[index] @ six[:, components].ravel())
        at = int(np.abs(stress.angle - notch.local.angle).argmin())
        whole[name] = (stress.shear if name == "torsion" else stress.along)[at]
    assert notch.local.amplitude == pytest.approx(abs(whole["bending_z"]), rel=0.006)
    assert notch.local.mean == pytest.approx(whole["axial"], rel=0.006, abs=100.0)
    assert notch.local.shear == pytest.approx(whole["torsion"], rel=0.006, abs=100.0)
    plain = notch.found.factors["bending"].value * notch.nominal.bending
    assert abs(notch.local.amplitude / plain - 1) > 0.015


@pytest.mark.long
def test_a_fillet_in_a_bore_has_factors_of_its_own():
    scene = shoulder(1.2, 0.05)
    thick = scene.segments[1].with_changes(inner0=0.012, inner1=0.012)
    thin = scene.segments[0].with_changes(inner0=0.018, inner1=0.018)
    bore = Fillet(name="inside", y=thin.y1, surface="bore", radius=0.002)
    scene = scene.with_changes(segments=(thin, thick), blends=(*scene.blends, bore))
    found = fillet_factors(scene, "inside", 0.03)
    assert (found.section.outer, found.radius) == (0.025, 0.025)  # of the thin side, outside
    # a plain tube has 18 / 25 of the outer shear in its bore
    assert found.factors["torsion"].value * 25 / 18 > 1.05
    assert 1.05 < found.factors["tension"].value < 4


def test_sharp_corners_are_told_and_get_no_number():
    scene = shoulder()
    assert list(sharp_corners(scene)) == []
    bare = scene.with_changes(blends=())
    (corner,) = sharp_corners(bare)
    place = scene.segments[0].y1
    assert corner == (place, "outer", ("s0", "s1"), False)
    chamfered = bare.with_changes(blends=(Chamfer(name="c", y=place, length=0.002),))
    assert list(sharp_corners(chamfered)) == [corner._replace(chamfered=True)]
    assert shaft_stress(chamfered, loads_on(scene)).notches == ()


def test_an_arc_is_asked_for_where_there_is_one():
    piece = piece_around(shoulder(), "fillet")
    chamfer = Chamfer(name="c", y=0.3, length=0.002).corner(shoulder().segments)
    with pytest.raises(SolidgearError, match='chamfer "c" is no arc'):
        RootArc.of(chamfer)
    with pytest.raises(SolidgearError, match="the mesh has no arc"):
        Arc(piece, sg.build(shoulder().with_changes(blends=()), "harmonic", order=2), piece.root)


@pytest.mark.long
def test_a_load_that_enters_beside_a_fillet_is_told(loaded):
    scene = shoulder()
    shift = scene.port.lo - scene.segments[0].y1 - 0.01
    near = scene.with_port(
        y=scene.port.y - shift, lo=scene.port.lo - shift, hi=scene.port.hi - shift
    )
    close = shaft_stress(near, loads_on(near), tolerance=0.05)
    assert loaded.remark == ""
    assert "a load enters 0.2 diameters away" in close.notches[0].remark


def test_a_tolerance_beyond_all_meshes_is_refused():
    with pytest.raises(SolidgearError, match="tolerance = 1e-06"):
        shaft_stress(shoulder(), {}, tolerance=1e-6)


def test_without_strength_there_are_form_factors_only(loaded):
    assert loaded.rating is None and loaded.fatigue == {}
    strong = shoulder().with_material(strength=STRONG)
    rated = shaft_stress(strong, loads_on(strong), tolerance=0.05).notches[0]
    assert 1.0 < rated.fatigue["bending"].notch < rated.fatigue["bending"].form


def test_a_fillet_whose_mesh_folds_is_told_and_the_rest_goes_on(monkeypatch):
    def folds(*_, **__):
        raise FactorError("the system matrix holds NaN")

    monkeypatch.setattr(notch, "harmonic", folds)
    notch._kept.cache_clear()  # of the same shoulder
    scene = shoulder()
    found = shaft_stress(scene, loads_on(scene))
    assert found.notches == () and len(found.nominal) > 4
    (told,) = found.remarks
    assert told.startswith('no stress there: fillet "fillet": cells of order')


def test_rims_on_other_faces_are_left_sharp():
    """No stress flows round them, and every one would cost cells."""
    scene = shoulder(turned=True)
    own = Fillet(name="own", y=scene.segments[0].y1, edge="rim", radius=0.002)
    far = Fillet(name="far", y=0, edge="rim", radius=0.002)
    scene = scene.with_changes(blends=(*scene.blends, own, far))
    assert [corner.name for corner in piece_around(scene, "fillet", 12.0).outline.corners] == [
        "fillet",
        "own",
    ]
