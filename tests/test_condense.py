"""Condensation to a port: limits that can be worked out by hand, exact transformations, and a
direct dense solution.
"""

from decimal import Context, Decimal, localcontext
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.body import Supports, as_supports
from solidgear.core.scene import Bearing, Port, Scene, Segment
from solidgear.core.solve.condensed import Condensed
from solidgear.core.solve.statics import flexibility
from tests.dense import bearing_by_hand, relative, whole

GEOMETRY = Path(__file__).parent.parent / "geometry"
OPTIONS = {
    "timoshenko": {},
    "harmonic": {"order": 2},
    "solid": {"element": "hex8", "refinement": 0.5},
}


def shipped(name):
    return sg.load(GEOMETRY / f"{name}.toml")


@pytest.fixture(scope="module", params=list(OPTIONS))
def body(request, overhung):
    return sg.build(overhung, request.param, **OPTIONS[request.param])


def moved(stiffness, d):
    """6x6 at y0 + d of a spring at y0 + 0, both on the axis, from the work of a rigid motion; by
    hand, no library code.
    """
    # motion of the spring's point for a motion of a point d further along y: thx carries -d to z,
    # thz +d to x
    t = np.eye(6)
    t[2, 3], t[0, 5] = -d, d
    return t.T @ stiffness @ t


def rigid_sum(scene):
    """Bearings seen from the port through a rigid shaft (no housing)."""
    return sum(moved(bearing_by_hand(b), scene.port.y - b.y) for b in scene.bearings)


# --------------------------------------------------------------------------- form of the result
def test_stiffness_is_symmetric_and_positive_semidefinite(body, overhung):
    k = sg.condense(body, overhung, "pinion").stiffness
    assert relative(k, k.T) < 1e-10  # symmetrised on the way; anything else would be a slip
    eigenvalues = np.linalg.eigvalsh(k / np.abs(k).max())
    assert eigenvalues.min() > -1e-12  # rounding of an exact zero, the free torsion
    assert (eigenvalues > 1e-9).sum() == 5


def test_free_torsion_is_an_exact_zero(body, overhung):
    c = sg.condense(body, overhung, "pinion")
    assert not c.stiffness[4].any() and not c.stiffness[:, 4].any()
    assert np.isnan(c.compliance[4]).all() and np.isnan(c.compliance[:, 4]).all()
    assert c.free_names == ("thy",)
    on = [0, 1, 2, 3, 5]
    product = c.stiffness[np.ix_(on, on)] @ c.compliance[np.ix_(on, on)]
    scale = np.sqrt(np.diag(c.compliance)[on])
    # inverse of a matrix whose scaled condition number is below 100
    assert np.abs(product * scale[None] / scale[:, None] - np.eye(5)).max() < 1e-10


def test_body_is_reciprocal(body):
    flexible = flexibility(body)
    # two solutions with one symmetric factor, before symmetrising: where the refinement stops
    assert flexible.asymmetry < 1e-10
    # the last step; what is left after it is a thousand times smaller
    assert flexible.residual < 1e-9


# --------------------------------------------------------------------------- against a direct solution
def direct_stiffness(body, scene):
    """K + G' Kb G of the whole beam, dense, torsion left out; then the port's 5x5 compliance,
    inverted.
    """
    k, _, g = whole(body, without=("torsion",))
    springs = sla.block_diag(*(bearing_by_hand(b) for b in scene.bearings))
    seats = g[6 : 6 + len(springs)]
    k = k + seats.T @ springs @ seats
    on = [0, 1, 2, 3, 5]
    d = 1 / np.sqrt(np.diag(k))
    u = d[:, None] * sla.solve(k * np.outer(d, d), d[:, None] * g[on].T, assume_a="pos")
    out = np.zeros((6, 6))
    out[np.ix_(on, on)] = np.linalg.inv(g[on] @ u)
    return out


@pytest.mark.parametrize("fidelity", ["euler", "timoshenko"])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_against_a_direct_dense_solution(overhung, fidelity, scale):
    scene = overhung.with_bearing_scale(scale)
    body = sg.build(scene, fidelity, elements=20)
    found = sg.condense(body, scene, "pinion").stiffness
    # the direct matrix has a condition number near 1e6 after scaling, more with soft bearings: 1e-8
    # is what *it* can do
    assert relative(found, direct_stiffness(body, scene)) < 1e-8


# --------------------------------------------------------------------------- reference point
@pytest.mark.parametrize("attachment", ["average", "rigid"])
@pytest.mark.parametrize("fidelity", ["harmonic", "solid"])
def test_moving_the_reference_point_is_an_adjoint(overhung, attachment, fidelity):
    # The port's motion is a rigid motion fitted to the same surface, so its reference point is a
    # matter of book-keeping. Mesh lines through the port move with it, hence both points are chosen
    # on existing lines: seat ends of the head.
    here = overhung.with_port(attachment=attachment)
    y0, y1 = here.port.lo, here.port.hi
    a, b = here.with_port(y=y0), here.with_port(y=y1)
    options = OPTIONS[fidelity]
    ka = sg.condense(sg.build(a, fidelity, **options), a, "pinion").stiffness
    kb = sg.condense(sg.build(b, fidelity, **options), b, "pinion").stiffness
    # the same numbers in another order: where the static refinement stops, 1e-12, times the lever's
    # amplification
    assert relative(moved(ka, y1 - y0), kb) < 1e-10


# --------------------------------------------------------------------------- limits
@pytest.mark.parametrize("fidelity", list(OPTIONS))
def test_stiff_shaft_leaves_the_bearings(overhung, fidelity):
    expected = rigid_sum(overhung)
    error = []
    for modulus in (2e15, 2e17):
        scene = overhung.with_material(E=modulus)
        k = sg.condense(sg.build(scene, fidelity, **OPTIONS[fidelity]), scene, "pinion").stiffness
        error.append(relative(k, expected))
    # In the stiffest direction of the rigid lever the bearings are some 40 times stiffer than the
    # steel shaft, so a shaft 1e6 times stiffer leaves 4e-5 of it
    assert error[1] < 1e-4
    # ... and proportionally to 1/E
    assert error[0] / error[1] == pytest.approx(100, rel=0.02)


def test_soft_bearings_leave_their_rigid_sum(body, overhung):
    soft = overhung.with_bearing_scale(1e-3 / 8.823e9)  # radial stiffness of bearing 1: 1e-3 N/m
    k = sg.condense(body, soft, "pinion").stiffness
    # the bearings are about as stiff as the shaft, so scaled by 1e-13 they leave 1e-11 of elastic
    # compliance; nothing larger than the result is subtracted on the way
    assert relative(k, rigid_sum(soft)) < 1e-10


def test_soft_bearings_lengthen_the_compliance_of_a_beam_exactly(overhung):
    # the soft limit tests nothing but rigid motions; at equal stiffness the two parts add: C =
    # C_rigid + C_elastic(Kb)
    body = sg.build(overhung, "timoshenko")
    soft, softer = overhung.with_bearing_scale(1e-6), overhung.with_bearing_scale(1e-8)
    on = np.ix_([0, 1, 2, 3, 5], [0, 1, 2, 3, 5])
    elastic = []
    for scene in (soft, softer):
        c = sg.condense(body, scene, "pinion").compliance[on]
        elastic.append(c - np.linalg.inv(rigid_sum(scene)[on]))
    # what is left after the springs' own compliance is the shaft under statically determined
    # bearing shares: independent of the scale; the subtraction costs the ratio of the compliances,
    # 1e8
    assert relative(elastic[1], elastic[0]) < 1e-4


def test_very_stiff_bearings_stay_finite_and_clamp_the_seats(body, overhung):
    values = []
    for scale in (1e12, 1e14):
        scene = overhung.with_bearing_scale(scale)  # up to 1e24 N/m
        k = sg.condense(body, scene, "pinion").stiffness
        assert np.all(np.isfinite(k))
        values.append(k)
    # both are clamps as seen from the shaft: compliances of 1e-22 and 1e-24 m/N against 1e-10
    assert relative(values[0], values[1]) < 1e-8


def test_stiffness_grows_with_the_bearings(body, overhung):
    scales = 10.0 ** np.arange(-6, 7)
    previous = None
    for scale in scales:
        k = sg.condense(body, overhung.with_bearing_scale(scale), "pinion").stiffness
        if previous is not None:
            d = 1 / np.sqrt(np.where(np.diag(k) > 0, np.diag(k), 1.0))
            # adding springs adds a positive semidefinite part; 1e-11 of the larger matrix is
            # rounding once all is clamped
            assert np.linalg.eigvalsh((k - previous) * np.outer(d, d)).min() > -1e-11, scale
        previous = k


def test_free_body_resists_nothing(body):
    c = sg.condense(body, (), "pinion")
    assert not c.stiffness.any()
    assert np.isnan(c.compliance).all()
    assert c.free.shape == (6, 6)


def test_bearings_of_no_stiffness_are_no_bearings(body, overhung):
    nothing = [b.with_changes(matrix=np.zeros((6, 6)), axial_series=()) for b in overhung.bearings]
    c = sg.condense(body, nothing, "pinion")
    assert not c.stiffness.any() and np.isnan(c.compliance).all()


def test_one_spring_leaves_its_own_motion_only():
    # a single lateral spring at the port: its stiffness in z, and nothing about any other motion
    segment = Segment.cylinder("rod", length=0.3, diameter=0.06)
    k = np.zeros((6, 6))
    k[2, 2] = 1e7
    spring = Bearing(name="spring", y=0.15, seat_width=0.02, matrix=k)
    scene = Scene.from_parts([segment], bearings=[spring], port=Port(y=0.15, lo=0.14, hi=0.16))
    c = sg.condense(sg.build(scene, "timoshenko"), scene, "port")
    expected = np.zeros((6, 6))
    expected[2, 2] = 1e7
    assert (
        np.abs(c.stiffness - expected).max() < 1e-9 * 1e7
    )  # port and spring share a node: no elasticity in between


# --------------------------------------------------------------------------- housing
@pytest.mark.parametrize("fidelity", ["timoshenko", "harmonic"])
def test_axial_chain_of_bearings_and_housing(fidelity):
    scene = shipped("pinion_straddle").with_material(E=2e19)
    assert scene.housing_axial == 7.71e9
    # bearing 0 carries no axial load; bearing 2 has K_c in series; both side by side, then the
    # housing in series
    second = 1 / (1 / 1.721e9 + 1 / 4.1e8)
    expected = 1 / (1 / (8.887e8 + second) + 1 / 7.71e9)
    k = sg.condense(sg.build(scene, fidelity, **OPTIONS[fidelity]), scene, "pinion").stiffness
    # a shaft 1e8 times stiffer than steel leaves 1e-9; weak couplings (100 N/m in 1e9) enter
    # squared
    assert k[1, 1] == pytest.approx(expected, rel=1e-8)


def test_housing_spring_has_the_limits_it_must_have():
    scene = shipped("pinion_straddle")
    body = sg.build(scene, "timoshenko")
    k = {
        h: sg.condense(body, scene.with_changes(housing_axial=h), "pinion").stiffness
        for h in (None, 1e24, 7.71e9)
    }
    assert relative(k[1e24], k[None]) < 1e-12  # a rigid housing is none
    assert k[7.71e9][1, 1] < k[None][1, 1] * 0.95  # K_hb takes 15 % of this chain
    # the housing is axial: radial stiffness feels it through the weak couplings only (1e2 of 1e9
    # N/m, squared)
    assert k[7.71e9][2, 2] == pytest.approx(k[None][2, 2], rel=1e-9)


# --------------------------------------------------------------------------- one soft bearing, one stiff
def decimal_solve(a, b):
    """Gauss elimination with row pivoting in sixty digits."""
    with localcontext(Context(prec=60)):
        rows = [
            [Decimal(float(v)) if not isinstance(v, Decimal) else v for v in (*ra, *rb)]
            for ra, rb in zip(a, b)
        ]
        n = len(rows)
        for i in range(n):
            p = max(range(i, n), key=lambda r: abs(rows[r][i]))
            rows[i], rows[p] = rows[p], rows[i]
            for r in range(n):
                if r != i and rows[r][i]:
                    f = rows[r][i] / rows[i][i]
                    rows[r] = [x - f * y for x, y in zip(rows[r], rows[i])]
        return [[v / rows[i][i] for v in rows[i][n:]] for i in range(n)]


@pytest.mark.parametrize("soft", [1e-5, 1e-3, 1e3, 1e16, 1e24])
def test_bearings_of_very_different_stiffness(overhung, soft):
    """Equilibrium of bearing forces and rigid motion in sixty digits, from the same flexibility:
    what is left is the condensation's own rounding.
    """
    body = sg.build(overhung, "timoshenko")
    stiff = Supports(
        as_supports(overhung).ports,
        sla.block_diag(np.diag([5e8, 5e8, 5e8, 0, 0, 0]), np.diag([soft, 0, soft, 0, 0, 0])),
    )
    here, there = 6 * body.port_index("pinion") + np.arange(6), stiff.rows(body)
    f, p, k = flexibility(body).matrix, body.rigid_ports, stiff.stiffness
    exact = [[Decimal(float(v)) for v in row] for row in k]

    def times(x):
        return [
            [sum(a * Decimal(float(v)) for a, v in zip(row, column)) for column in x.T]
            for row in exact
        ]

    with localcontext(Context(prec=60)):
        m = len(there)
        top = [
            [Decimal(int(i == j)) + v for j, v in enumerate(row)]
            for i, row in enumerate(times(f[np.ix_(there, there)]))
        ]
        matrix = [a + b for a, b in zip(top, times(p[there]))] + [
            [*p[there][:, j], *(float(i == j == 4) for i in range(6))] for j in range(6)
        ]
        load = [[-v for v in row] for row in times(f[np.ix_(there, here)])] + (-p[here].T).tolist()
        found = decimal_solve(matrix, load)
        force, rigid = np.array(found[:m], float), np.array(found[m:], float)
    want = f[np.ix_(here, here)] + f[np.ix_(here, there)] @ force + p[here] @ rigid
    on = [0, 1, 2, 3, 5]
    got = sg.condense(body, stiff, "pinion").compliance
    np.testing.assert_allclose(got[on, on], want[on, on], rtol=1e-12)


def test_a_free_direction_between_the_axes_is_named_as_one():
    """A bearing that resists all but (1, 0, 1): no component alone is free, and none has a zero
    row.
    """
    v = np.array([1.0, 0.0, 1.0])
    k = np.zeros((6, 6))
    k[:3, :3] = 1e9 * np.eye(3) - 0.5e9 * np.outer(v, v)
    k[3:, 3:] = 1e6 * np.eye(3)
    scene = shipped("cylinder_free")
    scene = scene.with_changes(
        bearings=(Bearing(name="1", y=scene.length / 2, seat_width=0.01, matrix=k),)
    )
    found = sg.condense(sg.build(scene, "timoshenko"), scene, scene.port.name)
    assert found.free_names == ()
    np.testing.assert_allclose(np.abs(found.oblique.T), [[1, 0, 1, 0, 0, 0]], atol=1e-9)


def test_a_free_motion_is_told_with_one_sign_whatever_the_solver_gives():
    """A shear of two equal entries, and one whose largest entry a solver may give as -1."""
    free = np.array([[0.3, 0.0, -0.3, 0.0, 0.0, 0.0], [0.0, 1e-3, 0.0, 0.0, 0.0, -0.9]]).T
    wanted = np.array([[1.0, 0.0, -1.0, 0.0, 0.0, 0.0], [0.0, -1e-3 / 0.9, 0.0, 0.0, 0.0, 1.0]]).T
    stiffness = np.eye(6)
    for signs in ((1, 1), (-1, 1), (1, -1)):
        found = Condensed("p", "average", stiffness, stiffness, free * signs)
        np.testing.assert_allclose(found.oblique, wanted, rtol=1e-14, atol=0)
    assert Condensed("p", "average", stiffness, stiffness, free[:, :0]).oblique.shape == (6, 0)


def test_one_free_motion_more_takes_only_its_own_compliances():
    """Without a second kxx the stub turns about A in the x plane as well as about its axis: what
    neither motion moves keeps its compliance to the digit, and torsion is an exact zero still.
    """

    def bearing(name, y, diagonal):
        return Bearing(name=name, y=y, seat_width=0.01, matrix=np.diag([*diagonal, 0, 0, 0]))

    b = bearing("B", 0.037, (2e8, 0, 2e8))
    held = Scene.from_parts(
        [Segment.cylinder("stub", length="45 mm", diameter="80 mm")],
        bearings=[bearing("A", 0.008, (3e8, 1e8, 2e8)), b],
        port=Port(name="mid", y=0.0225, lo=0.018, hi=0.027),
    )
    loose = held.with_changes(bearings=(bearing("A", 0.008, (0, 1e8, 2e8)), b))
    body = sg.build(held, "timoshenko")
    want, got = (sg.condense(body, scene, "mid") for scene in (held, loose))
    assert got.free_names == ("thy",) and not got.stiffness[4].any()
    # x = thz (y_mid - y_B): the shaft turns about B
    np.testing.assert_allclose(got.oblique.T, [[0.0145, 0, 0, 0, 0, 1]], rtol=1e-9)
    on, off = [1, 2, 3], [0, 4, 5]
    np.testing.assert_allclose(
        got.compliance[np.ix_(on, on)], want.compliance[np.ix_(on, on)], rtol=1e-12
    )
    assert np.isnan(got.compliance[off]).all() and np.isnan(got.compliance[:, off]).all()
    both = sg.condense(body, loose, ("mid",))
    np.testing.assert_array_equal(np.isnan(both.compliance), np.isnan(got.compliance))
