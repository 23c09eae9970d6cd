"""The reference of triangles: closed forms, rigid motion, and the harmonic solid, with which it
shares no mesh, no element and no attachment.
"""

import math

import numpy as np
import pytest

import solidgear as sg
from solidgear.judge.quantities import measure, size
from solidgear.scene import STEEL, Bearing, Port, Scene, Segment
from validation.bounds.triangle_mesh import sharpened, triangle_mesh
from validation.bounds.triangle_solid import FAMILIES, Solid
from validation.bounds.triangles import triangle_reference

#: a second for all families, and five digits
COARSE = {"order": 3, "finest": 1e-5, "growth": 0.6}
SPRINGS = {"kxx": 4e8, "kyy": 2e8, "kzz": 4e8, "kthy": 1e4}


def stepped(tie: str = "average", **springs: float) -> Scene:
    """Two diameters, the lumped point beside the shoulder, a bearing near each end."""
    segments = [
        Segment(name="neck", y0=0.0, y1=0.06, outer0=0.02, outer1=0.02),
        Segment(name="body", y0=0.06, y1=0.14, outer0=0.03, outer1=0.03, inner0=0.01, inner1=0.01),
    ]
    seats = [
        Bearing(name=name, y=y, seat_width=0.01, stiffness=SPRINGS | springs, attachment=tie)
        for name, y in (("A", 0.01), ("B", 0.125))
    ]
    port = Port(name="p", y=0.05, lo=0.04, hi=0.058, attachment=tie)
    return Scene.from_parts(segments, bearings=seats, port=port)


def test_torsion_of_a_bar_is_a_standing_wave():
    bar = Scene.from_parts([Segment.cylinder("bar", length=0.2, diameter=0.04)])
    found = triangle_reference(bar, families=["torsion"], modes=2)
    speed = math.sqrt(STEEL.shear_modulus / STEEL.density)
    for k in (1, 2):
        number, wave = found[f"torsion {k}"], k * speed / (2 * 0.2)
        assert abs(number.value - wave) <= number.uncertainty * wave < 1e-8 * wave
    # nothing resists a turn
    assert set(found) == {"torsion 1", "torsion 2"}


def test_a_shaft_stands_on_its_axial_springs():
    """Of two soft springs in parallel hardly anything but the springs is left, to their ratio to
    the shaft: rounding of the shaft's stiffness does not show.
    """
    soft = 1e3
    found = triangle_reference(stepped(kyy=soft), families=["axial"], modes=0, **COARSE)
    give = found["C_yy"].value * 2 * soft
    assert 0 < give - 1 < soft / (STEEL.E * 0.02)
    assert found["C_yy"].uncertainty < 1e-8


def test_two_discretisations_that_share_nothing_agree():
    """All three attachments on one shaft: the harmonic solid as it comes is good to 1e-4."""
    scene = stepped()
    first, last = scene.bearings
    rigid = scene.port.with_changes(attachment="rigid")
    scene = scene.with_changes(
        bearings=(first, last.with_changes(attachment="section")), port=rigid
    )
    found = triangle_reference(scene, modes=1, **COARSE)
    values = {name: number.value for name, number in found.items()}
    body = sg.build(scene, "harmonic")
    product = measure(sg.condense(body, scene, port="p"), sg.modes(body, scene, n=4))
    assert set(found) - set(product) == set() and len(found) == 13
    for name, number in found.items():
        assert number.uncertainty < 3e-5
        assert abs(product[name] - number.value) < 1e-4 * size(values, name)


def test_rigid_motion_strains_nothing_and_is_its_own_mean():
    scene = stepped("section").with_changes(port=stepped().port)
    solid = Solid(scene, triangle_mesh(scene, finest=1e-2), 3)
    for family in FAMILIES.values():
        parts = list(family.parts)
        for k, component in enumerate(family.components):
            motion = solid.rigid(component, scene.port.y)[parts].ravel()
            assert abs(solid.energy(family, motion[:, None])) < 1e-20
            mean = solid.mean(family, scene.port) @ motion
            assert mean == pytest.approx(np.eye(len(mean))[k], abs=1e-12)


def test_energies_are_those_of_the_matrices():
    scene = stepped()
    solid = Solid(scene, triangle_mesh(scene, finest=1e-2), 2)
    draw = np.random.default_rng(3)
    for family in FAMILIES.values():
        stiffness, _ = solid.matrices(family)
        moved = draw.standard_normal((stiffness.shape[0], 2))
        if family.waves != 1 and 0 in family.parts:  # no hoop strain at the axis without bounds
            moved.reshape(len(family.parts), -1, 2)[:, solid.axis] = 0.0
        expected = moved.T @ stiffness @ moved
        assert solid.energy(family, moved) == pytest.approx(expected, rel=1e-10)


def test_a_rigid_seat_stays_round():
    """Where rings hold the wall, no ovalising is as slow as without."""
    loose, held = (
        triangle_reference(stepped(tie), families=["n=2"], modes=1, order=3, finest=1e-3)["n=2 1"]
        for tie in ("average", "rigid")
    )
    assert held.value > 1.01 * loose.value


def test_parting_triangles_at_a_corner_keeps_the_area_and_the_seat():
    scene = stepped("rigid")
    mesh = triangle_mesh(scene, finest=1e-2)
    corner = int(np.argmin(np.hypot(*(mesh.points - [[2 / 3], [2.0]]))))
    finer = sharpened(mesh, np.array([corner]))
    added = finer.triangles.shape[1] - mesh.triangles.shape[1]
    assert added == 2 * (mesh.triangles == corner).sum()

    def area(of):
        (a, b, c), (d, e, f) = (of.points[k][of.triangles] for k in (0, 1))
        return abs((b - a) * (f - d) - (c - a) * (e - d)).sum() / 2

    assert area(finer) == pytest.approx(area(mesh), rel=1e-14)
    assert area(mesh) == pytest.approx(2 / 3 * 2 + 2 / 3 * 8 / 3, rel=1e-12)


def test_what_it_does_not_read_is_refused():
    with pytest.raises(sg.SolidgearError, match="couples planes"):
        triangle_reference(stepped(kxz=1e7))
    with pytest.raises(sg.SolidgearError, match="housing_axial"):
        triangle_reference(stepped().with_changes(housing_axial=1e8))
    with pytest.raises(sg.SolidgearError, match="no family"):
        triangle_reference(stepped(), families=["breathing"])
    at_step = stepped().port.with_changes(y=0.06, attachment="section")
    with pytest.raises(sg.SolidgearError, match="two sizes"):
        triangle_mesh(stepped().with_changes(port=at_step))
    with pytest.raises(sg.SolidgearError, match="slivers"):
        triangle_mesh(stepped(), finest=1e-14)
