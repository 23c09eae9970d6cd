"""Block assembly against scikit-fem's own vector forms, and patch tests on distorted meshes.

The forms below are written as in a textbook and assembled by scikit-fem; they share elements and
mesh with the library, and nothing of its tabulation, its reference integrals, its Gram matrices or
its scatter.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from skfem import Basis, BilinearForm, ElementVector, MeshHex1, MeshHex2, MeshTet1, MeshTet2
from skfem.element import ElementHexS2
from skfem.helpers import ddot, dot, sym_grad, trace
from skfem.quadrature import get_quadrature
from skfem.refdom import RefQuad

import solidgear as sg
from solidgear.core.kernel.assembly import STRAIGHT, straight
from solidgear.core.models.solid import matrices as solid_matrices
from solidgear.core.models.solid import mesh as solid_mesh
from solidgear.core.scene import STEEL, Material, Port, Scene, Segment

SOLID = ("tet4", "tet10", "hex8", "hex20", "hex27")

# Same sums in another order: a few hundred products an entry, some of which cancel.  1e-15 is what
# one sees here; another BLAS may add in yet another order.
SAME_SUM = 1e-13


def relative_difference(a, b):
    return abs(a - b).max() / abs(b).max()


@dataclass(repr=False)
class MeshHex20(MeshHex2):
    """Twenty-node geometry; scikit-fem ships none."""

    elem: type = ElementHexS2


def own_mesh(geometry):
    """The library's isoparametric mesh as a scikit-fem mesh with the same geometry."""
    t = geometry.mesh.t
    kind = {
        "tet4": MeshTet1,
        "tet10": MeshTet2,
        "hex8": MeshHex1,
        "hex20": MeshHex20,
        "hex27": MeshHex2,
    }[geometry.name]
    return kind(geometry.nodes, t)


def skfem_elasticity(geometry, materials, quadrature=None, intorder=None):
    """Stiffness and mass by scikit-fem's forms."""
    mesh = own_mesh(geometry)
    options = {"quadrature": quadrature} if quadrature is not None else {"intorder": intorder}
    basis = Basis(mesh, ElementVector(geometry.element), **options)
    e, nu, rho = (
        np.array([getattr(m, k) for m in materials])[geometry.segment][:, None]
        for k in ("E", "nu", "density")
    )
    lame, mu = e * nu / (1 + nu) / (1 - 2 * nu), e / 2 / (1 + nu)

    @BilinearForm
    def stiffness(u, v, w):
        return lame * trace(sym_grad(u)) * trace(sym_grad(v)) + 2 * mu * ddot(
            sym_grad(u), sym_grad(v)
        )

    @BilinearForm
    def mass(u, v, w):
        return rho * dot(u, v)

    return stiffness.assemble(basis), mass.assemble(basis)


def assert_same(geometry, materials, within=SAME_SUM):
    """Stiffness and mass of the library are those of scikit-fem by the same quadrature."""
    own = solid_matrices._matrices(geometry, materials)
    rule = solid_matrices._cell_rule(geometry.name)
    for found, wanted in zip(own, skfem_elasticity(geometry, materials, quadrature=rule)):
        assert relative_difference(found, wanted) < within


# --------------------------------------------------------------------------- distorted boxes
def box(element, seed=3, curved=False):
    """Unit-free box of 3 x 3 x 3 cells with interior nodes moved at random; mid nodes too if
    curved.
    """
    lines = (np.linspace(0, 1, 4), np.linspace(0, 2, 4), np.linspace(0, 3, 4))
    rng = np.random.default_rng(seed)
    size = np.array([[1.0], [2.0], [3.0]])
    if element.startswith("tet"):
        mesh = MeshTet1.init_tensor(*lines)
        p, t = mesh.p.copy(), mesh.t.copy()
        move(p, size, 0.04, rng)
        left_handed = MeshTet1(p, t).orientation() < 0
        t[:2, left_handed] = t[1::-1, left_handed]
        mesh = MeshTet1(p, t)
        if element == "tet10":
            mesh = MeshTet2.from_mesh(mesh)
    else:
        mesh = MeshHex1.init_tensor(*lines)
        p = mesh.p.copy()
        move(p, size, 0.06, rng)
        mesh = MeshHex2.from_mesh(MeshHex1(p, mesh.t[[0, 2, 1, 3, 4, 6, 5, 7]]))
    if curved:
        located = mesh.doflocs.copy()
        move(located, size, 0.015, rng)
        mesh = replace(mesh, doflocs=located)
    return mesh


def move(p, size, amount, rng):
    """Move points strictly inside the box."""
    inside = np.all((p > 1e-9 * size) & (p < size * (1 - 1e-9)), axis=0)
    assert inside.any()
    p[:, inside] += amount * size * rng.uniform(-1, 1, (3, inside.sum()))


def assembled_box(element, curved=False):
    mesh = box(element, curved=curved)
    geometry = solid_mesh._isoparametric(mesh, element, np.zeros(mesh.t.shape[1], int))
    k, m = solid_matrices._matrices(geometry, [STEEL])
    return geometry, k, m


@pytest.mark.parametrize("element", SOLID)
def test_distorted_solid_matches_skfem_with_its_own_quadrature(element):
    # The mass is a polynomial on straight-sided elements and the tetrahedral stiffness too, so any
    # rule of sufficient order gives the same entries; the stiffness of a distorted brick is
    # rational and depends on the rule.
    geometry, k, m = assembled_box(element)
    stiffness, mass = skfem_elasticity(geometry, [STEEL], intorder=7)
    assert relative_difference(m, mass) < SAME_SUM
    if element.startswith("tet"):
        assert relative_difference(k, stiffness) < SAME_SUM
    if element in (
        "hex20",
        "hex27",
    ):  # order 7 is the four Gauss points a direction that the library means to use
        assert relative_difference(k, stiffness) < SAME_SUM


@pytest.mark.parametrize(
    "element, curved",
    [(e, c) for e in SOLID for c in (False, True) if not (c and e in ("tet4", "hex8"))],
)
def test_patch_of_constant_stress(element, curved):
    geometry, k, _ = assembled_box(element, curved)
    rng = np.random.default_rng(11)
    gradient = 1e-3 * rng.standard_normal((3, 3))  # with a rotation in it, which must not matter
    u = (gradient @ geometry.nodes).T.ravel()
    force = (k @ u).reshape(-1, 3)
    size = np.array([1.0, 2.0, 3.0])
    interior = np.all(
        (geometry.nodes > 1e-9) & (geometry.nodes < (1 - 1e-9) * size[:, None]), axis=0
    )
    assert interior.sum() >= 8
    # The rules integrate grad N det J exactly on these elements (degree at most 6 a direction for
    # curved bricks, 4 Gauss points do 7), so nothing but rounding of the products K_ij u_j is left:
    # 4e-16 and a margin.
    scale = (abs(k) @ abs(u)).max()
    assert np.abs(force[interior]).max() / scale < 1e-14
    # ... and the faces carry the stress of Hooke's law times their area
    strain = (gradient + gradient.T) / 2
    lame, mu = (
        STEEL.E * STEEL.nu / (1 + STEEL.nu) / (1 - 2 * STEEL.nu),
        STEEL.E / 2 / (1 + STEEL.nu),
    )
    stress = lame * np.trace(strain) * np.eye(3) + 2 * mu * strain
    # shear on the side faces shares the edge nodes, so look at the virial: sum of x f = volume
    # times stress
    virial = force.T @ geometry.nodes.T
    assert np.abs(virial - stress * size.prod()).max() / np.abs(stress).max() / size.prod() < 1e-11


# --------------------------------------------------------------------------- straight and curved elements
def bent_box(element, amount, every=3):
    """A box of straight elements of two materials with one mid node of every third element moved,
    by a share of the element's size.
    """
    mesh = box(element)
    geometry = solid_mesh._isoparametric(mesh, element, np.arange(mesh.t.shape[1]) % 2)
    touched = geometry.dofs[
        -1 if element == "hex27" else geometry.mesh.p.shape[0] + 1 if element == "tet10" else 8,
        ::every,
    ]
    size = np.ptp(geometry.nodes[:, geometry.dofs], axis=1).min()
    geometry.nodes[:, touched] += amount * size * np.array([[0.6], [0.0], [0.8]])
    bent = np.isin(geometry.dofs, touched).any(axis=0)
    return geometry, bent


SOFT = Material(E=7e10, nu=0.4, density=2700.0)
TWO = [STEEL, SOFT]


@pytest.mark.parametrize("amount", [0.0, 1e-12, 1e-11, 1e-9, 1e-6, 1e-2])
def test_bends_large_and_small_match_skfem(amount):
    geometry, bent = bent_box("tet10", amount)
    assert 0.2 < bent.mean() < 1  # both ways of assembly in one mesh
    found, _ = straight(geometry.element, geometry.nodes[:, geometry.dofs])
    assert found[~bent].all()
    if amount == 0:
        assert found.all()
    if amount >= 1e-11:
        assert not found[bent].any()
    # whatever is taken for straight may change entries by less than this
    assert_same(geometry, TWO, within=1e-12)


def test_taking_a_slightly_bent_element_for_straight_would_be_seen(monkeypatch):
    geometry, _ = bent_box("tet10", 1e-9)
    right, _ = solid_matrices._matrices(geometry, TWO)
    monkeypatch.setattr("solidgear.core.kernel.assembly.STRAIGHT", 1e-3)
    wrong, _ = solid_matrices._matrices(geometry, TWO)
    assert 1e-11 < relative_difference(wrong, right) < 1e-7


def test_straightness_is_measured_against_the_least_extent():
    # A flat element: a bend that is small beside its length and not beside its height changes its
    # stiffness.
    element = solid_mesh.basis_of("tet10")
    flat = (np.diag([1.0, 1.0, 1e-2]) @ element.doflocs.T)[:, :, None]
    assert straight(element, flat)[0].all()
    flat[2, 4] += 30 * STRAIGHT * 1e-2
    assert not straight(element, flat)[0].any()


def cubes():
    """Eight right-handed cubes."""
    mesh = MeshHex1.init_tensor(*[np.linspace(0, 1, 3)] * 3)
    return MeshHex2.from_mesh(MeshHex1(mesh.p, mesh.t[[0, 2, 1, 3, 4, 6, 5, 7]]))


@pytest.mark.parametrize("element", ["hex8", "hex20", "hex27"])
def test_parallelepipeds_match_skfem(element):
    # affine bricks take the reference integrals, as straight tetrahedra do
    mesh = cubes()
    mesh = replace(
        mesh, doflocs=np.array([[1.0, 0.3, 0.1], [0.0, 1.2, -0.2], [0.1, 0.0, 0.7]]) @ mesh.doflocs
    )
    geometry = solid_mesh._isoparametric(mesh, element, np.arange(8) % 2)
    assert straight(geometry.element, geometry.nodes[:, geometry.dofs])[0].all()
    assert_same(geometry, TWO)


@pytest.mark.parametrize("element", ["hex20", "hex27"])
def test_one_bent_brick_among_straight_ones(element):
    mesh = cubes()
    geometry = solid_mesh._isoparametric(mesh, element, np.arange(8) % 2)
    geometry.nodes[:, geometry.dofs[-1, 2]] += 0.02
    found, _ = straight(geometry.element, geometry.nodes[:, geometry.dofs])
    assert 0 < found.sum() < 8
    assert_same(geometry, TWO)


# --------------------------------------------------------------------------- harmonic blocks
def stepped(bore=0.0):
    segments = (
        Segment.cylinder("a", length=0.05, diameter=0.06, bore=bore),
        Segment.cone(
            "b",
            length=0.03,
            start_diameter=0.09,
            end_diameter=0.07,
            bore=bore,
            y0=0.05,
            material=Material(E=7e10, nu=0.33, density=2700.0),
        ),
    )
    return Scene.from_parts(segments, material=STEEL)


def harmonic_by_skfem(scene, body, order, n):
    """Stiffness and mass of harmonic n in the cylindrical strains of U, V, W; unknowns (p, q, w),
    (u_r, u_y) for n = 0.
    """
    mesh, element = body.geometry.mesh, body.geometry.element
    rule = get_quadrature(RefQuad, 2 * (order + 2) - 1)
    c = 2 if n == 0 else 3
    basis = Basis(mesh, ElementVector(element, dim=c), quadrature=rule)
    of = body.geometry.meridian.segment
    mats = [s.material for s in scene.segments]
    e, nu, rho = (
        np.array([getattr(m, k) for m in mats])[of][:, None] for k in ("E", "nu", "density")
    )
    lame, mu = e * nu / (1 + nu) / (1 - 2 * nu), e / 2 / (1 + nu)

    def strain(u, r):
        d, g = u, u.grad  # g[component, direction], directions (r, y)
        if n == 0:
            return g[0, 0], d[0] / r, g[1, 1], 0 * r, 0 * r, g[0, 1] + g[1, 0]
        U, V, W = d[0] + d[1], d[0] - d[1], d[2]
        dU, dV, dW = g[0] + g[1], g[0] - g[1], g[2]
        return (
            dU[0],
            (U - n * V) / r,
            dW[1],
            -n * U / r - dV[0] + V / r,
            -dV[1] - n * W / r,
            dU[1] + dW[0],
        )

    around = 2 * np.pi if n == 0 else np.pi

    @BilinearForm
    def stiffness(u, v, w):
        r = w.x[0]
        a, b = strain(u, r), strain(v, r)
        normal = sum(x * y for x, y in zip(a[:3], b[:3]))
        shear = sum(x * y for x, y in zip(a[3:], b[3:]))
        return around * r * (lame * sum(a[:3]) * sum(b[:3]) + 2 * mu * normal + mu * shear)

    @BilinearForm
    def mass(u, v, w):
        a, b = u, v
        if n:
            same = (a[0] + a[1]) * (b[0] + b[1]) + (a[0] - a[1]) * (b[0] - b[1]) + a[2] * b[2]
        else:
            same = a[0] * b[0] + a[1] * b[1]
        return around * w.x[0] * rho * same

    k, m = stiffness.assemble(basis), mass.assemble(basis)
    keep = np.ones((k.shape[0] // c, c), bool)
    axis = mesh.facets_satisfying(lambda x: x[0] < 1e-9)
    if len(axis):
        on = Basis(mesh, element, quadrature=rule).get_dofs(axis).all()
        keep[on] = {0: [False, True], 1: [True, False, False]}.get(n, [False] * 3)
    keep = np.flatnonzero(keep.ravel())
    return k[keep][:, keep], m[keep][:, keep]


@pytest.mark.parametrize("bore", [0.0, 0.02])
@pytest.mark.parametrize(
    "order",
    [1, 2, *(pytest.param(order, marks=pytest.mark.slow) for order in (4, 6))],
)
def test_harmonic_blocks_match_skfem(order, bore):
    scene = stepped(bore)
    further = (2, 3) if order < 4 else ()  # scikit-fem's own vector forms take seconds from order 4
    body = sg.build(
        scene, "harmonic", order=order, layers=1 if order < 4 else 0, size=0.05, ovalising=further
    )
    names = {"bending_z": 1, "axial": 0} | {f"ovalising_{n}": n for n in further}
    seen = set()
    for block in body.blocks:
        if block.name in names:
            k, m = harmonic_by_skfem(scene, body, order, names[block.name])
            seen.add(block.name)
            assert relative_difference(block.stiffness, k) < SAME_SUM
            assert relative_difference(block.mass, m) < SAME_SUM
    assert seen == set(names)


@pytest.mark.parametrize("bore", [0.0, 0.02])
@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_torsion_block_matches_skfem(order, bore):
    scene = stepped(bore)
    body = sg.build(scene, "harmonic", order=order, layers=1)
    basis = Basis(
        body.geometry.mesh,
        body.geometry.element,
        quadrature=get_quadrature(RefQuad, 2 * (order + 2) - 1),
    )
    of = body.geometry.meridian.segment
    shear = np.array([s.material.shear_modulus for s in scene.segments])[of][:, None]
    rho = np.array([s.material.density for s in scene.segments])[of][:, None]
    k = BilinearForm(
        lambda u, v, w: 2 * np.pi * w.x[0] ** 3 * shear * dot(u.grad, v.grad)
    ).assemble(basis)
    m = BilinearForm(lambda u, v, w: 2 * np.pi * w.x[0] ** 3 * rho * u * v).assemble(basis)
    assert relative_difference(body.blocks[3].stiffness, k) < SAME_SUM
    assert relative_difference(body.blocks[3].mass, m) < SAME_SUM


def nodal_field(body, field, components):
    """Unknowns of a field given at vertices and (order 2) edge points; higher hierarchical unknowns
    are zero.
    """
    geometry = body.geometry
    element, flat = geometry.element, geometry.meridian
    n = int(geometry.dofs.max()) + 1
    out = np.zeros((n, components))
    x = np.full((2, n), np.nan)
    x[:, geometry.dofs[:4]] = flat.points[:, flat.cells]
    if element.maxdeg == 4 and len(element.doflocs) == 9:  # biquadratic Lagrange
        corner = flat.points[:, flat.cells]
        for i, (a, b) in enumerate(element.doflocs):
            shape = np.array([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b])
            x[:, geometry.dofs[i]] = np.einsum("dce,c->de", corner, shape)
    known = ~np.isnan(x[0])
    out[known] = np.column_stack(field(*x[:, known]))
    return out


@pytest.mark.parametrize("bore", [0.0, 0.02])
@pytest.mark.parametrize("order", [1, 2, 4, 6])
def test_uniform_axial_stretch_with_poisson_contraction_is_in_equilibrium(order, bore):
    # u_y = e y, u_r = -nu e r: sigma_yy = E e and nothing else, so only the end faces carry load: e
    # E A in all.
    rod = Segment.cylinder("rod", length=0.2, diameter=0.06, bore=bore)
    scene = Scene.from_parts([rod], port=Port(y=0.1, lo=0.05, hi=0.12))
    body = sg.build(scene, "harmonic", order=order, layers=1)
    block = body.blocks[2]
    assert block.name == "axial"
    e = 1e-3
    u = nodal_field(body, lambda r, y: (-STEEL.nu * e * r, e * y), 2)
    ends = np.zeros(len(u), bool)
    basis = Basis(body.geometry.mesh, body.geometry.element)
    for face in (0.0, 0.2):
        ends[
            basis.get_dofs(
                body.geometry.mesh.facets_satisfying(lambda x, at=face: abs(x[1] - at) < 1e-9)
            ).all()
        ] = True
    keep = np.ones_like(u, bool)
    if bore == 0.0:
        axis = body.geometry.mesh.facets_satisfying(lambda x: x[0] < 1e-9)
        keep[basis.get_dofs(axis).all(), 0] = False
    end_axial = (ends[:, None] & np.array([False, True]))[keep]
    force = block.stiffness @ u[keep]
    scale = (abs(block.stiffness) @ abs(u[keep])).max()
    assert np.abs(force[~end_axial]).max() / scale < 1e-13  # rounding of K u
    area = np.pi * (0.03**2 - bore**2 / 4)
    y = np.repeat(nodal_field(body, lambda r, y: (y,), 1)[:, 0], 2)[keep.ravel()]
    total = force[end_axial & (y > 0.1)].sum()
    if (
        order <= 2
    ):  # Lagrange functions sum to one over a face; hierarchical ones do so over vertices only
        assert total == pytest.approx(STEEL.E * e * area, rel=1e-10)
    # energy: 1/2 E e^2 A L whatever the basis; rounding of a sum over the mesh
    assert u[keep] @ force == pytest.approx(STEEL.E * e**2 * area * 0.2, rel=1e-11)
