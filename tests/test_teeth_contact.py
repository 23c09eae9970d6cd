"""Contact of teeth beside energy that an optimiser makes least, and what must hold of any contact.

The teeth here give way by a made-up law, smooth and positive definite: what is tested is the contact.
"""

from dataclasses import dataclass
from math import radians

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize

from solidgear.core import SolidgearError
from solidgear.core.gears.flank_shape import FlankGrid, FlankShape, Relief, shape_gap
from solidgear.core.gears.norm import norm_face_load_factor, norm_stiffness
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.contact.cycle import mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair, corner_gap
from solidgear.teeth.contact.frame import RigidSupports
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.teeth.contact.solver import RIGID, loads

STEEL = Elasticity(2.06e11, 0.3)
LAW = LineContact((STEEL, STEEL), (1e-3, 1e-3))


@dataclass(frozen=True)
class MadeUp:
    """Teeth that give way the more the nearer to the tip, and carry neighbours along."""

    size: float = 2e-9  #: m/N at one place
    spread: float = 5e-3  #: along the face, m
    depth: float = 1e-3

    def matrix(self, tooth, r, z):
        lean = 1 + 20 * (r - r.min())
        along = np.exp(-np.abs(z[:, None] - z[None, :]) / self.spread)
        beside = 0.15 ** np.abs(tooth[:, None] - tooth[None, :])
        return self.size * along * beside * np.outer(lean, lean)


def tilted(slope):
    """Shapes of flanks of which the first misses more towards larger z, by so much per length."""
    return FlankShape(face_width=20e-3, slope=slope * 20e-3), FlankShape()


def pair_of(helix=0.0, face=20e-3, **kw):
    wheels = WheelPair(
        Wheel(23, 4e-3, helix, face_width=face), Wheel(57, 4e-3, helix, face_width=face)
    )
    return CylindricalPair(wheels, (MadeUp(), MadeUp(1.5e-9)), LAW, **{"slices": 12, **kw})


def supports_of(seed, motion=(0, 0, 0, 0, 0, 0)):
    """Shafts that give way at random, m/N and rad/(N m)."""
    rows = np.random.default_rng(seed).normal(size=(8, 6)) * [1, 1, 1, 20, 20, 20]
    return RigidSupports(1e-10 * rows.T @ rows, np.array(motion, float))


def test_local_law_is_the_strain_under_a_hertz_pressure_summed_to_the_depth():
    """Stress on the axis of a line pressure (Johnson 4.46), integrated: no closed form shared."""
    material, load, radius, depth = Elasticity(2e11, 0.28), 2e5, 12e-3, 0.7e-3
    law = LineContact((material, material), (depth, depth))
    half = float(law.half_width(load, radius))
    peak = float(law.pressure(load, radius))

    def strain(y):
        t = y / half
        root = np.sqrt(1 + t * t)
        across = -peak * ((1 + 2 * t * t) / root - 2 * t)
        along = -peak / root
        e, nu = material.youngs, material.poisson
        return -((1 - nu**2) * along - nu * (1 + nu) * across) / e

    approach = 2 * quad(strain, 0, depth, epsrel=1e-10)[0]
    assert load * law.compliances(load, radius)[0] == pytest.approx(approach, rel=1e-8)


@pytest.mark.parametrize("load", [1e2, 1e5, 1e8])
def test_tangent_of_the_local_law_is_its_slope(load):
    law = LineContact((Elasticity(2e11, 0.25), Elasticity(7e10, 0.33)), (1e-3, 0.4e-3))

    def approach(q):
        return q * law.compliances(q, 8e-3)[0]

    slope = (approach(load * 1.0001) - approach(load * 0.9999)) / (2e-4 * load)
    assert law.compliances(load, 8e-3)[1] == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize("lean", [0.0, 1e-3, 0.05])
def test_corner_law_is_that_of_the_pressure_between_half_planes(lean):
    """The pressure as a discrete problem of two half-planes that touch from an edge on."""
    load, radius, depth = 2e5, 12e-3, 1e-3
    law = LineContact((STEEL, STEEL), (depth, depth))
    cells = 400
    softness = 2 / (np.pi * STEEL.plane)

    def edge(width):  # pressures on even cells that close the gap up to one approach
        x = (np.arange(cells) + 0.5) * width / cells
        half = width / cells / 2
        apart = np.subtract.outer(x, x)
        left, right = apart + half, apart - half
        potential = left * np.log(np.abs(left)) - right * np.log(np.abs(right)) - 2 * half
        gap = lean * x + x**2 / (2 * radius)
        matrix = np.block(
            [[-2 * softness * potential, -np.ones((cells, 1))], [np.full((1, cells), 2 * half), 0]]
        )
        solved = np.linalg.solve(matrix, np.append(-gap, load))
        return solved[:-1], solved[-1]

    half = float(law.half_width(load, radius))
    width = brentq(lambda b: edge(b)[0][-1], 1e-3 * half, 3 * half)
    approach = edge(width)[1]
    # at the depth a half-plane moves as under a line of the same load
    side = STEEL.poisson / (1 - STEEL.poisson)
    approach += 2 * softness * load * (np.log(depth) - 0.5 - side / 2)
    secant, _ = law.compliances(load, radius, np.array([lean]))
    assert secant[0] > 1.05 * law.compliances(load, radius)[0]
    assert load * secant[0] == pytest.approx(approach, rel=2e-3)


@pytest.mark.parametrize("lean", [0.0, 1e-3, 0.05])
def test_tangent_of_the_corner_law_is_its_slope(lean):
    def approach(q):
        return q * LAW.compliances(q, 8e-3, np.array([lean]))[0]

    slope = (approach(1e5 * 1.0001) - approach(1e5 * 0.9999)) / 20
    assert LAW.compliances(1e5, 8e-3, np.array([lean]))[1] == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize("beyond", [None, 2e-3, 4e-3])
def test_relieved_flanks_touch_beside_the_line_of_action(beyond):
    """Points of a relieved flank, turned with its wheel, and their angles from the mate's flank: on
    the path, and so many pitches beyond its end.
    """
    wheels = pair_of().wheels
    relief = Relief(20e-6, 18e-3, wheels.ends[1])
    pair = pair_of(shapes=(FlankShape(tip=relief), FlankShape()), slices=1)
    end = (wheels.ends[1] - wheels.pitch_point) / wheels.pitch
    phase = 0.3 if beyond is None else end + beyond
    first, second = wheels.first, wheels.second
    place = np.array([wheels.pitch_point + phase * wheels.pitch])
    r = np.linspace(first.form, first.tip, 20001)
    points, normals = first.flank_points(r)
    points += relief.missing(np.sqrt(r**2 - first.base**2))[:, None] * normals
    turn = phase * first.pitch_angle - first.half_angle(wheels.first_radius(wheels.pitch_point))
    c, s = np.cos(turn), np.sin(turn)
    x, y = (points @ np.array([[c, -s], [s, c]]) - [0, wheels.distance]).T
    at_mate = second.half_angle(wheels.second_radius(wheels.pitch_point))
    ahead = np.arctan2(-x, -y) + phase * second.pitch_angle + at_mate
    # involutes of one base circle are parallel curves
    least = second.base * (ahead - second.half_angle(np.hypot(x, y))).min()
    inside, parted = np.minimum(place, wheels.ends[1]), corner_gap(wheels, place)
    gap = pair.least_gap(inside, np.zeros(1), parted)[0]
    assert gap == pytest.approx(least, abs=0.01e-6)
    assert gap < (shape_gap(pair.wheels, pair.shapes, inside, np.zeros(1)) + parted)[0] - 0.02e-6


@pytest.mark.parametrize("helix, phase", [(0.0, 0.1), (radians(15), 0.6)])
def test_forces_make_the_energy_least(helix, phase):
    """An optimiser with bounds, which knows neither Newton nor active cells, finds no less."""
    pair = pair_of(helix, slices=5, shapes=tilted(3e-4))
    supports = supports_of(1, (0, 0, 0, 1e-5, 2e-5, 0))
    result = loads(pair, 80.0, phase, supports)
    cells = result.cells
    bulk = pair.bulk(cells) + cells.rows @ supports.compliance @ cells.rows.T
    gap = cells.gap + cells.rows @ supports.motion

    def local(force):  # work of a law q G(t), by its own quadrature
        points, weights = np.polynomial.legendre.leggauss(24)
        s = (points + 1) / 2
        at = np.outer(force, s**2)  # denser near nothing
        secant = LAW.compliances(
            at / cells.length[:, None], cells.radius[:, None], cells.lean[:, None]
        )[0]
        return (at * secant / cells.length[:, None] * force[:, None] * 2 * s * weights / 2).sum()

    scale = result.force.max()

    def energy(x):
        force = x * scale
        return 1e3 * (force @ bulk @ force / 2 + gap @ force + local(force))

    least = minimize(
        energy,
        np.full(len(gap), 80.0 / cells.lever.sum() / scale),
        bounds=[(0, None)] * len(gap),
        constraints={"type": "eq", "fun": lambda x: (cells.lever @ x * scale - 80.0) / 80.0},
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    assert energy(result.force / scale) <= least.fun + 1e-7 * abs(least.fun)
    assert result.force / scale == pytest.approx(least.x, abs=2e-3)


def random_cases(count):
    generator = np.random.default_rng(4)
    for _ in range(count):
        helix = radians(generator.choice([0.0, 12.0, 30.0]))
        torque = 10 ** generator.uniform(-1, 4)
        tilt = generator.uniform(-1, 1) * 10 ** generator.uniform(-6, -3.3) / 20e-3
        yield helix, torque, tilt, generator.uniform(), generator.integers(0, 99)


def contact_holds(helix, torque, tilt, phase, seed):
    pair = pair_of(helix, shapes=tilted(tilt))
    supports = supports_of(seed)
    result = loads(pair, torque, phase, supports)
    cells = result.cells
    bulk = pair.bulk(cells) + cells.rows @ supports.compliance @ cells.rows.T
    secant = LAW.compliances(result.line_load, cells.radius, cells.lean)[0] / cells.length
    apart = bulk @ result.force + secant * result.force + cells.gap - cells.lever * result.rotation
    size = abs(result.rotation) * cells.lever.mean() + np.ptp(cells.gap)
    assert result.force.min() >= 0
    assert cells.lever @ result.force == pytest.approx(torque, rel=1e-12)
    touching = result.force > 1e-9 * result.force.max()
    assert np.abs(apart[touching]).max() <= 1e-9 * size
    assert apart.min() >= -1e-9 * size


def test_contact_holds_in_random_cases():
    for case in random_cases(60):
        contact_holds(*case)


@pytest.mark.slow
def test_contact_holds_in_a_thousand_random_cases():
    for case in random_cases(1002):
        contact_holds(*case)


@pytest.mark.parametrize("helix", [0.0, radians(20)])
def test_unloaded_conjugate_flanks_have_no_transmission_error(helix):
    cycle = mesh_cycle(pair_of(helix), 1e-6, 43e-3, 12, positions=8)
    assert np.abs(cycle.free_error).max() < 1e-15


def test_first_touch_is_the_smallest_gap_and_comes_off_the_secant():
    """Flanks that stand back by 5 um everywhere are as stiff as before, and turn 5 um further."""

    grid = FlankGrid((-1.0, 1.0), (0.0, 1.0), ((5e-6, 5e-6), (5e-6, 5e-6)))
    shapes = FlankShape(grid=grid), FlankShape()
    plain, back = (loads(pair_of(shapes=s), 100.0, 0.3) for s in (tilted(0.0), shapes))
    assert back.rotation - plain.rotation == pytest.approx(5e-6 / plain.cells.lever[0], rel=1e-9)
    assert back.secant == pytest.approx(plain.secant, rel=1e-9)


def test_tangent_is_the_slope_of_rotation_by_torque():
    pair, supports = pair_of(radians(12), shapes=tilted(1e-3)), supports_of(3)
    low, middle, high = (loads(pair, t, 0.4, supports) for t in (99.9, 100.0, 100.1))
    slope = (high.rotation - low.rotation) / 0.2
    assert middle.supported_slope == pytest.approx(slope, rel=1e-4)
    assert middle.supported_tangent < middle.tangent


def test_supports_that_do_not_give_change_nothing_and_those_that_do_make_softer():
    pair = pair_of()
    rigid, soft = loads(pair, 100.0, 0.2, RIGID), loads(pair, 100.0, 0.2, supports_of(2))
    alone = loads(pair, 100.0, 0.2)
    assert rigid.force == pytest.approx(alone.force, rel=1e-12)
    assert rigid.supported_secant == pytest.approx(alone.secant, rel=1e-12)
    assert soft.supported_secant < 0.9 * soft.secant


def test_gap_of_corners_is_that_of_involutes_turned_back():
    """Figures by another route, points of both flanks and Newton: 1.2, 7.8, 30.9, 124 um."""
    wheels = WheelPair(Wheel(23, 4e-3), Wheel(57, 4e-3))
    before = wheels.ends[0] - wheels.pitch * np.array([0.02, 0.05, 0.1, 0.2])
    assert 1e6 * corner_gap(wheels, before) == pytest.approx([1.2, 7.8, 30.9, 124], rel=0.05)
    inside = np.linspace(*wheels.ends, 5)
    assert np.all(corner_gap(wheels, inside) == 0)


def test_corners_carry_under_load_and_soften_the_steps_of_the_error():
    with_corners, path_alone = (
        mesh_cycle(pair_of(beyond=b), 270.0, 43e-3, 12) for b in (0.15, 0.0)
    )
    assert with_corners.corner_share > 0.05 and path_alone.corner_share == 0
    assert with_corners.mean_lines > path_alone.mean_lines
    assert abs(with_corners.orders(1)[0]) < abs(path_alone.orders(1)[0])


def test_orders_rebuild_the_error():
    cycle = mesh_cycle(pair_of(), 100.0, 43e-3, 12, positions=16)
    angle = 2 * np.pi * cycle.phases
    waves = [a * np.exp(1j * n * angle) for n, a in enumerate(cycle.orders(7), start=1)]
    last = np.fft.rfft(cycle.error)[8].real / 16 * np.cos(8 * angle)
    rebuilt = cycle.error.mean() + np.real(sum(waves)) + last
    assert rebuilt == pytest.approx(cycle.error, rel=1e-12)


def test_face_load_factor_rises_with_tilt_and_is_the_same_from_either_end():
    straight, askew, other = (
        mesh_cycle(pair_of(shapes=tilted(s)), 100.0, 43e-3, 12, positions=4)
        for s in (0.0, 5e-4, -5e-4)
    )
    assert straight.face_load_factor < askew.face_load_factor
    assert other.face_load_factor == pytest.approx(askew.face_load_factor, rel=1e-9)


def test_a_torque_that_lifts_the_flanks_is_refused():
    with pytest.raises(SolidgearError, match="lifts these flanks"):
        loads(pair_of(), -1.0, 0.0)


def test_stiffness_by_the_norm():
    """The printed value of ISO 6336-1 for a rack of 1.2 modules; another rack and a low load."""
    usual = Rack(dedendum=1.2)
    wheels = WheelPair(Wheel(23, 4e-3, rack=usual), Wheel(57, 4e-3, rack=usual))
    norm = norm_stiffness(wheels)
    assert norm.theoretical / 1e9 == pytest.approx(17.089, abs=5e-4)
    assert norm.single / 1e9 == pytest.approx(13.671, abs=5e-4)
    deeper = norm_stiffness(WheelPair(Wheel(23, 4e-3), Wheel(57, 4e-3)))
    assert deeper.single == pytest.approx(0.975 * norm.single, rel=1e-12)
    assert norm_stiffness(wheels, 50e3).single == pytest.approx(0.5**0.25 * norm.single)


def test_stiffness_by_the_norm_is_that_of_the_material():
    """E / E_steel with the harmonic mean of both moduli (ISO 6336-1), either way round."""
    wheels = WheelPair(Wheel(23, 4e-3), Wheel(57, 4e-3))
    steel = norm_stiffness(wheels).mesh
    for youngs, factor in ((3e9, 0.02871), (110e9, 0.6962)):
        for moduli in ((206e9, youngs), (youngs, 206e9)):
            assert norm_stiffness(wheels, moduli=moduli).mesh / steel == pytest.approx(
                factor, rel=2e-4
            )


def test_face_load_factor_by_the_norm_meets_where_load_ends_within_the_face():
    stiffness, load = 20e9, 300e3
    meets = 2 * load / (0.85 * stiffness)
    below, above = (norm_face_load_factor(meets * f, load, stiffness) for f in (0.9999, 1.0001))
    assert below == pytest.approx(2, rel=1e-4) and above == pytest.approx(2, rel=1e-4)
