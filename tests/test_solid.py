"""The full 3D solid: mass, rigid motions, and convergence to the axisymmetric-harmonic solid from
above.
"""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.scene import Scene, Segment
from tests.dense import mass_matrix

GEOMETRY = Path(__file__).parent.parent / "geometry"
SMALL = {
    "tet4": {"size": 0.03, "graded_size": 0.03},
    "tet10": {"size": 0.03, "graded_size": 0.03},
    "hex8": {"refinement": 0.5},
    "hex20": {"refinement": 0.5},
    "hex27": {"refinement": 0.5},
}

# harmonic solid on the overhung pinion, order 10 with five graded layers, confirmed by a second
# code
K_ZZ, FIRST_BENDING = 4.70996e9, 2758.003


@pytest.fixture(scope="module")
def light(overhung):
    return sg.build(
        overhung,
        "solid",
        element="hex27",
        layers=2,
        radial_layers=2,
        edge_layers=0,
        relative_size=0.6,
        around=8,
    )


# --------------------------------------------------------------------------- mass
@pytest.mark.parametrize("element", ["tet10", "hex20", "hex27"])
def test_mass_centre_and_inertia(element):
    scene = sg.load(GEOMETRY / "shaft_hollow.toml")
    m = sg.build(scene, "solid", element=element, **SMALL[element]).mass_matrix()
    expected = mass_matrix(scene)
    size = np.sqrt(np.diag(expected))
    error = np.abs((m - expected) / np.outer(size, size))
    # 16 quadratic edges around lose a^4 / 30 = 5e-5 of the area (half angle a = pi / 16) and twice
    # that of the polar inertia; the O-grid has the area of the circle by construction and errs by
    # 3e-7 in the polar inertia only.
    assert error.max() < (1e-4 if element == "tet10" else 1e-6)
    if element != "tet10":
        assert error[0, 0] < 1e-12  # straight generators, exact area: rounding


def test_mass_of_straight_sides_is_short():
    # straight-sided elements lie inside the circle: the gate above would notice if geometry were
    # not curved
    scene = Scene.from_parts([Segment.cylinder("rod", length=0.1, diameter=0.06)])
    m = sg.build(scene, "solid", element="tet4", size=0.02, graded_size=0.02).mass_matrix()
    # sixteen and more chords around: short by less than 1 - sin(2 pi / 16) / (2 pi / 16), which is
    # 2.5 %
    assert 0.002 < 1 - m[0, 0] / mass_matrix(scene)[0, 0] < 0.026


# --------------------------------------------------------------------------- rigid motions
@pytest.mark.parametrize("element", list(SMALL))
def test_rigid_motions_cost_no_energy(element):
    scene = sg.load(GEOMETRY / "shaft_hollow.toml")
    body = sg.build(scene, "solid", element=element, **SMALL[element])
    # isoparametric elements hold every rigid motion: rounding of |K| |R|
    assert body.rigid_residual() < 1e-14


@pytest.mark.parametrize(
    "element",
    [pytest.param(e, marks=pytest.mark.long if e in ("tet4", "hex27") else ()) for e in SMALL],
)
def test_free_cylinder_has_six_rigid_modes_and_no_spurious_one(element):
    scene = sg.load(GEOMETRY / "cylinder_free.toml")
    found = sg.modes(sg.build(scene, "solid", element=element, **SMALL[element]), scene, n=6)
    assert [m.frequency_hz for m in found.modes[:6]] == [0.0] * 6
    assert found.evidence["rigid_modes"] == 6
    exact = sg.modes(sg.build(scene, "harmonic", order=6), scene, n=6)
    elastic, wanted = (
        [(m.name, m.multiplicity, m.frequency_hz) for m in x.modes[6:]] for x in (found, exact)
    )
    # A spurious mode would stand between these.  Quadratic elements reach 0.3 % on these coarse
    # meshes; linear ones are far too stiff in bending, so that for them only the first is looked
    # at: it must lie above the exact one.
    if element in ("tet4", "hex8"):
        assert elastic[0][0] == "bending 1" and wanted[0][2] < elastic[0][2] < 1.6 * wanted[0][2]
    else:
        assert [e[:2] for e in elastic] == [w[:2] for w in wanted]
        ratio = np.array([e[2] / w[2] for e, w in zip(elastic, wanted)])
        assert np.all(
            ratio > 1 - 5e-5
        )  # from above, but for the mass and inertia of the polygonal circle
        assert np.all(ratio < 1.005)


@pytest.mark.long
def test_smallest_eigenvalues_of_one_stiffness():
    # the raw matrix of a short cylinder: six zeros, then a gap; hourglass modes of an
    # under-integrated element would fill it
    scene = Scene.from_parts([Segment.cylinder("disc", length=0.05, diameter=0.06)])
    for element in SMALL:
        size = (
            {"size": 0.02, "graded_size": 0.02}
            if element.startswith("tet")
            else {"size": 0.05, "layers": 0, "edge_layers": 0, "radial_layers": 0}
        )
        block = sg.build(scene, "solid", element=element, half=False, **size).blocks[0]
        d = 1 / np.sqrt(block.stiffness.diagonal())
        values = np.linalg.eigvalsh((block.stiffness.toarray() * d[:, None]) * d)
        assert np.abs(values[:6]).max() < 1e-12, (
            element
        )  # rounding of a matrix of norm of order ten
        assert values[6] > 1e-3, element  # the softest strain of a few elements: 0.01 to 0.1


# --------------------------------------------------------------------------- convergence on the pinion
@pytest.mark.long
def test_light_hexahedra_are_near_the_reference(overhung, light):
    k = sg.condense(light, overhung, "pinion").stiffness
    # 14k unknowns: the graded mesh is above the reference, as displacement elements are, by less
    # than half a per cent
    assert 0 < k[2, 2] / K_ZZ - 1 < 5e-3


@pytest.mark.long
def test_light_hexahedra_bend_near_the_reference(overhung, light):
    f = sg.modes(light, overhung, n=3).named("bending 1").frequency_hz
    # frequencies feel the singular corners less than the port's stiffness does: a quarter of that
    # error
    assert 0 < f / FIRST_BENDING - 1 < 2e-3


@pytest.mark.long
def test_hexahedra_approach_the_reference_from_above(overhung):
    coarse, fine = (
        sg.condense(
            sg.build(overhung, "solid", element="hex20", around=8, refinement=r), overhung, "pinion"
        ).stiffness[2, 2]
        for r in (0.5, 0.75)
    )
    assert coarse > fine > K_ZZ
    # more layers towards the shoulder as well as more cells: 0.6 % becomes 0.24 %
    assert fine / K_ZZ - 1 < 0.5 * (coarse / K_ZZ - 1)
    assert fine / K_ZZ - 1 < 4e-3


@pytest.mark.slow
def test_tetrahedra_are_near_the_reference(overhung):
    body = sg.build(overhung, "solid", element="tet10", size=0.025, graded_size=0.0055)
    assert 4e4 < body.size < 6e4
    k = sg.condense(body, overhung, "pinion").stiffness
    # graded to 5.5 mm at seats and shoulder: 0.6 % above in stiffness, 0.1 % in frequency
    assert 0 < k[2, 2] / K_ZZ - 1 < 1e-2
    f = sg.modes(body, overhung, n=3).named("bending 1")
    assert f.multiplicity == 2
    assert 0 < f.frequency_hz / FIRST_BENDING - 1 < 3e-3
