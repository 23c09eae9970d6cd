"""Quality gates on small meshes whose figures are known in closed form."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad
from skfem import MeshHex, MeshHex2, MeshQuad, MeshTet, MeshTet2

from solidgear.core.errors import SolidgearError
from solidgear.core.meshing.quality import MeshError, check_mesh, element_ratios
from solidgear.core.scene.closed_form import mass_properties, volume_of
from solidgear.core.scene.outline import Outline


def box(kind, n=3):
    a, b, c = (np.linspace(0.0, length, n + 1) for length in (1.0, 2.0, 3.0))
    # scikit-fem's tensor meshes are left-handed, wholly or in part
    if kind.startswith("tet"):
        mesh = MeshTet.init_tensor(a, b, c)
        t = mesh.t.copy()
        negative = mesh.orientation() < 0
        t[:2, negative] = t[1::-1, negative]
        mesh = MeshTet(mesh.p, t)
        return MeshTet2.from_mesh(mesh) if kind == "tet2" else mesh
    mesh = right_handed(MeshHex.init_tensor(a, b, c))
    return MeshHex2.from_mesh(mesh) if kind == "hex2" else mesh


def right_handed(mesh):
    """A hexahedral mesh with two of its local axes exchanged."""
    return MeshHex(mesh.p, mesh.t[[0, 2, 1, 3, 4, 6, 5, 7]])


@pytest.mark.parametrize("kind", ["tet1", "tet2", "hex1", "hex2"])
def test_a_box_has_its_volume(kind):
    quality = check_mesh(box(kind), volume=6.0)
    assert quality.n_vertices == 64
    assert quality.n_elements == (27 if kind.startswith("hex") else 162)
    # affine elements: nothing but rounding
    assert quality.volume == pytest.approx(6.0, rel=1e-13)
    assert quality.min_ratio == pytest.approx(1.0, rel=1e-12)
    assert quality.min_det_j == pytest.approx(quality.max_det_j, rel=1e-12)
    assert quality.min_det_j == pytest.approx(6.0 / 27, rel=1e-12)
    assert quality.min_volume_ratio == pytest.approx(1.0, rel=1e-12)


def test_the_ratio_is_that_of_a_known_bend():
    mesh = MeshTet2.from_mesh(MeshTet.init_refdom())
    doflocs = mesh.doflocs.copy()
    edge = np.flatnonzero((mesh.edges.min(axis=0) == 0) & (mesh.edges.max(axis=0) == 1))[0]
    doflocs[0, mesh.dofs.edge_dofs[0, edge]] += 0.1
    # x = X + 0.1 * 4 X (1 - X - Y - Z): det J = 1 + 0.4 (1 - 2X - Y - Z), 1.4 at the origin and 0.6
    # at (1, 0, 0)
    quality = check_mesh(replace(mesh, doflocs=doflocs))
    assert quality.min_ratio == pytest.approx(0.6 / 1.4, rel=1e-12)
    assert quality.max_det_j == pytest.approx(1.4, rel=1e-12)


@pytest.mark.parametrize("kind", ["tet2", "hex2"])
def test_inversion_at_a_corner_only_is_seen(kind):
    mesh = box(kind, 2)
    doflocs = mesh.doflocs.copy()
    edge = mesh.t2e[0, 3]
    a, b = mesh.edges[:, edge]
    # a mid node at 0.24 of its edge: det J at the near end is 4 * 0.24 - 1 = -0.04 of the straight
    # one, and positive at every Gauss point
    doflocs[:, mesh.dofs.edge_dofs[0, edge]] = 0.76 * doflocs[:, a] + 0.24 * doflocs[:, b]
    bad = replace(mesh, doflocs=doflocs)
    from skfem import Basis

    assert np.all(bad.mapping().detDF(Basis(bad, bad.elem(), intorder=3).X) > 0.0)
    touched = int((mesh.t2e == edge).any(axis=0).sum())
    with pytest.raises(MeshError) as refused:
        check_mesh(bad)
    assert str(refused.value).startswith(f"{touched} of {mesh.t.shape[1]} elements")
    assert "inverted" in str(refused.value) and "det J -" in str(refused.value)


def pressed(amount):
    """One triquadratic cube with det J = 1 - amount z (1 - 8 (x - 1/4)^2): least, 1 - amount, at x
    = 1/4 on its top face.
    """
    mesh = MeshHex2.from_mesh(right_handed(MeshHex.init_tensor(*3 * [np.array([0.0, 1.0])])))
    x, y, z = mesh.doflocs
    return replace(
        mesh, doflocs=np.array([x, y, z - amount * z**2 / 2 * (1 - 8 * (x - 0.25) ** 2)])
    )


def bent():
    """One curved tetrahedron with det J = (x - 0.37) (x - 0.48): negative in a slice of it that
    holds no node.
    """
    mesh = MeshTet2.from_mesh(MeshTet.init_refdom())
    x, y, z = mesh.doflocs
    return replace(mesh, doflocs=np.array([x**2 / 2 - 0.37 * x, y * (x - 0.48), z]))


@pytest.mark.parametrize("mesh, name", [(bent(), "tet10"), (pressed(1.1), "hex27")])
def test_inversion_between_all_samples_is_seen(mesh, name):
    from solidgear.core.kernel.assembly import tabulate
    from solidgear.core.models.solid.matrices import _cell_rule

    element, nodes = mesh.elem(), mesh.doflocs[:, mesh.dofs.element_dofs]
    for points in (
        _cell_rule(name)[0],
        element.doflocs.T,
    ):  # where the stiffness is integrated, and the nodes
        assert tabulate(element, nodes, element, points).det.min() > 0.0
    assert element_ratios(mesh)[0] < 0.0
    with pytest.raises(MeshError, match="1 of 1 elements is inverted"):
        check_mesh(mesh)


@pytest.mark.parametrize("amount", [0.85, 0.9, 0.97])
def test_the_least_jacobian_is_that_of_the_polynomial(amount):
    # greatest at x = 1, z = 1; the bound is good to 1e-3 of it where it matters, and no valid
    # element is refused
    quality = check_mesh(pressed(amount))
    assert quality.max_det_j == pytest.approx(1.0 + 3.5 * amount, rel=1e-12)
    assert quality.min_ratio == pytest.approx((1.0 - amount) / (1.0 + 3.5 * amount), abs=1.5e-3)


@pytest.mark.parametrize("kind, name", [("tet2", "tet10"), ("hex2", "hex27")])
def test_the_volume_of_any_curved_element_is_exact(kind, name):
    from solidgear.core.kernel.assembly import tabulate
    from solidgear.core.models.solid.matrices import _cell_rule

    mesh = box(kind, 1)
    # every node moved at random: det J has all the terms it can have, and the rule of the stiffness
    # integrates them exactly
    bad = replace(
        mesh,
        doflocs=mesh.doflocs + np.random.default_rng(3).uniform(-0.05, 0.05, mesh.doflocs.shape),
    )
    points, weights = _cell_rule(name)
    det = tabulate(bad.elem(), bad.doflocs[:, bad.dofs.element_dofs], bad.elem(), points).det
    assert check_mesh(bad).volume == pytest.approx((det @ weights).sum(), rel=1e-13)


@pytest.mark.parametrize("kind", ["tet1", "hex1"])
def test_the_sentence_names_the_element(kind):
    mesh = box(kind)
    t = mesh.t.copy()
    t[[0, 1], 5] = t[[1, 0], 5]
    x, y, z = mesh.p[:, mesh.t[:, 5]].mean(axis=1)
    with pytest.raises(MeshError) as refused:
        check_mesh(type(mesh)(mesh.p, t))
    assert isinstance(refused.value, SolidgearError)
    text = str(refused.value)
    assert "1 of" in text and "element 5" in text and f"({x:.4g}, {y:.4g}, {z:.4g})" in text
    assert "\n" not in text


def test_a_left_handed_mesh_is_told_so():
    with pytest.raises(MeshError, match="27 of 27 .* left-handed"):
        check_mesh(MeshHex.init_tensor(*3 * [np.linspace(0.0, 1.0, 4)]))


def test_a_missing_part_is_refused():
    mesh = box("hex1")
    # one of 27 equal elements is 3.7e-2 of the volume, far above rtol = 1e-3
    with pytest.raises(MeshError, match=r"-3\.70e-02"):
        check_mesh(mesh.remove_elements(np.array([13])), volume=6.0)
    check_mesh(mesh, volume=6.0 * (1.0 + 0.9e-3))
    with pytest.raises(MeshError, match="instead of"):
        check_mesh(mesh, volume=6.0 * (1.0 + 1.1e-3))


def test_a_nearly_folded_element_is_refused():
    mesh = MeshTet2.from_mesh(MeshTet.init_refdom())
    doflocs = mesh.doflocs.copy()
    edge = np.flatnonzero((mesh.edges.min(axis=0) == 0) & (mesh.edges.max(axis=0) == 1))[0]
    doflocs[0, mesh.dofs.edge_dofs[0, edge]] += (
        0.24995  # det J from 2e-4 to 2: positive, but 1e-4 in ratio
    )
    bad = replace(mesh, doflocs=doflocs)
    with pytest.raises(MeshError, match="nearly folded"):
        check_mesh(bad)
    assert check_mesh(bad, min_ratio=1e-5).min_ratio == pytest.approx(1e-4, rel=1e-2)


def test_nan_and_flat_meshes_are_refused():
    mesh = box("hex1")
    p = mesh.p.copy()
    p[0, 0] = np.nan
    with pytest.raises(MeshError, match="1 of 27 elements"):
        check_mesh(MeshHex(p, mesh.t))
    with pytest.raises(MeshError, match="dimension 2"):
        check_mesh(MeshQuad())


def piece(y0, y1, outer0, outer1, inner0=0.0, inner1=0.0, density=7850.0):
    return SimpleNamespace(
        y0=y0,
        y1=y1,
        outer0=outer0,
        outer1=outer1,
        inner0=inner0,
        inner1=inner1,
        material=SimpleNamespace(density=density),
    )


def test_volume_and_inertia_against_quadrature():
    shaft = [
        piece(-0.2, 0.1, 0.03, 0.05, 0.01, 0.02),
        piece(0.1, 0.3, 0.02, 0.02, 0.0, 0.015, 2700.0),
    ]

    def integral(function):
        def one(s):
            def at(y):
                u = (y - s.y0) / (s.y1 - s.y0)
                outer, inner = (
                    s.outer0 + u * (s.outer1 - s.outer0),
                    s.inner0 + u * (s.inner1 - s.inner0),
                )
                return function(y, outer, inner, s.material.density)

            return quad(at, s.y0, s.y1, epsrel=1e-13)[0]

        return sum(one(s) for s in shaft)

    def ring(r):
        return np.pi * r**2

    exact = mass_properties(Outline(shaft))
    # polynomials on both sides: rounding only
    tight = dict(rel=1e-12)
    assert volume_of(Outline(shaft)) == pytest.approx(
        integral(lambda y, a, b, d: ring(a) - ring(b)), **tight
    )
    assert exact.mass == pytest.approx(
        integral(lambda y, a, b, d: d * (ring(a) - ring(b))), **tight
    )
    assert exact.centre == pytest.approx(
        integral(lambda y, a, b, d: d * y * (ring(a) - ring(b))) / exact.mass, **tight
    )
    assert exact.iyy == pytest.approx(
        integral(lambda y, a, b, d: d * np.pi / 2 * (a**4 - b**4)), **tight
    )
    assert exact.ixx == pytest.approx(
        integral(
            lambda y, a, b, d: (
                d * (np.pi / 4 * (a**4 - b**4) + (ring(a) - ring(b)) * (y - exact.centre) ** 2)
            )
        ),
        **tight,
    )


def test_a_cylinder_is_the_textbooks():
    exact = mass_properties(Outline([piece(1.0, 1.4, 0.05, 0.05)]))
    mass = 7850.0 * np.pi * 0.05**2 * 0.4
    assert (exact.mass, exact.centre) == pytest.approx((mass, 1.2), rel=1e-13)
    assert exact.iyy == pytest.approx(mass * 0.05**2 / 2, rel=1e-13)
    # far from the origin a shift would lose digits if it were done about y = 0
    assert exact.ixx == pytest.approx(mass * (3 * 0.05**2 + 0.4**2) / 12, rel=1e-12)
