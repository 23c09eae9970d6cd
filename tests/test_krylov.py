"""Exact beam bending against classical frequency equations, the thesis's own determinant, and the
finite elements.

Where the shaft has E I = m = L = 1, ``(k L)^2`` is the circular frequency. Frequency equations are
divided by cosh, so that the references themselves do not overflow.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import solidgear as sg
from solidgear.core.scene import Fillet, Scene, Segment
from validation.thesis.krylov import Span, Station, from_scene, krylov, krylov_duncan

GEOMETRY = Path(__file__).parents[1] / "geometry"
UNIT = Span(1.0, 1.0, 1.0)
STIFF = 1e20  # moves the roots of a unit beam by 1e-16 or so: a clamp to rounding


def held(y, z=0.0, tilt=0.0):
    return Station(y, np.diag([z, tilt]))


def kl(modes):
    return np.sqrt(2 * np.pi * modes.frequency_hz)


def roots_near(equation, guesses, width):
    return np.array(
        [brentq(equation, g - width, g + width, xtol=1e-14, rtol=1e-15) for g in guesses]
    )


def counted(modes):
    k = np.arange(len(modes.frequency_hz))
    return np.all((modes.counts[:, 0] <= k) & (k < modes.counts[:, 1]))


# ------------------------------------------------------------------------------------------- closed forms
CLAMPED = roots_near(lambda x: np.cos(x) - 1 / np.cosh(x), (np.arange(1, 21) + 0.5) * np.pi, 0.5)
PROPPED = roots_near(lambda x: np.tan(x) - np.tanh(x), (np.arange(1, 21) + 0.25) * np.pi, 0.2)
CANTILEVER = roots_near(lambda x: np.cos(x) + 1 / np.cosh(x), (np.arange(20) + 0.5) * np.pi, 0.5)


@pytest.mark.parametrize(
    "left, right, rigid, reference",
    [
        (held(0), held(1), 2, CLAMPED),
        (held(0, STIFF, STIFF), held(1, STIFF, STIFF), 0, CLAMPED),
        (held(0, STIFF, STIFF), held(1), 0, CANTILEVER),
        (held(0, STIFF, STIFF), held(1, STIFF), 0, PROPPED),
        (held(0, STIFF), held(1), 1, PROPPED),
        (held(0, STIFF), held(1, STIFF), 0, np.pi * np.arange(1, 21)),
        (held(0, 0, STIFF), held(1, STIFF), 0, np.pi * (np.arange(1, 21) - 0.5)),
    ],
    ids=[
        "free-free",
        "clamped",
        "cantilever",
        "propped",
        "pinned-free",
        "simply supported",
        "guided-pinned",
    ],
)
def test_uniform_beams(left, right, rigid, reference):
    modes = krylov([UNIT], [left, right], 20 + rigid)
    assert modes.rigid == rigid and np.all(modes.frequency_hz[:rigid] == 0)
    # References are good to 1e-15, roots to a few eps; 1e-12 leaves room for other machines.
    np.testing.assert_allclose(kl(modes)[rigid:], reference, rtol=1e-12)
    assert counted(modes)


def test_all_modes_up_to_kl_200():
    top = 200.0**2 / (2 * np.pi)
    modes = krylov([UNIT], [held(0, STIFF), held(1, STIFF)], None, max_frequency=top)
    assert len(modes.frequency_hz) == 63  # 63 pi = 197.9, 64 pi = 201.1
    np.testing.assert_allclose(kl(modes), np.pi * np.arange(1, 64), rtol=1e-13)  # 1e-15 was seen


# ------------------------------------------------------------------------------------------- the thesis's case
@pytest.mark.parametrize("mass, inertia", [(0.0, 0.0), (0.7, 0.05), (20.0, 3.0)])
def test_overhung_shaft_of_the_thesis(mass, inertia):
    """Two simple supports, one lumped mass and inertia at the overhung end, by initial parameters
    in plain S, T, U, V.
    """
    c, b = 0.4, 1.0  # overhang, distance of the supports

    def determinant(k):
        # Unknown z and phi at the overhung end and the two reactions. At that end M = -J w^2 phi
        # and M' = +M w^2 z (E I = m = 1, w^2 = k^4); a reaction r at the first support adds r to
        # M'.
        s, t, u, v = krylov_duncan(k * c)
        s2, t2, u2, v2 = krylov_duncan(k * (c + b))
        s3, t3, _, v3 = krylov_duncan(k * b)
        w2 = k**4

        z1 = [s + mass * w2 * v / k**3, t / k - inertia * w2 * u / k**2]
        z2 = [s2 + mass * w2 * v2 / k**3, t2 / k - inertia * w2 * u2 / k**2]
        m2 = [k**2 * u2 + mass * w2 * t2 / k, k * v2 - inertia * w2 * s2]
        shear2 = [k**3 * t2 + mass * w2 * s2, k**2 * u2 - inertia * w2 * k * v2]
        # Rows: no deflection at both supports, no moment and no shear beyond the second.
        rows = np.array([[*z1, 0, 0], [*z2, v3 / k**3, 0], [*m2, t3 / k, 0], [*shear2, s3, 1.0]])
        return np.linalg.det(rows / np.abs(rows).max(axis=1, keepdims=True))

    grid = np.linspace(
        0.05, 14.0, 2000
    )  # exp(14 * 1.4) costs eight of sixteen digits at the upper end
    values = [determinant(k) for k in grid]
    found = [
        brentq(determinant, x, y, xtol=1e-14, rtol=1e-14)
        for x, y, f, g in zip(grid, grid[1:], values, values[1:])
        if f * g < 0
    ][:4]
    end = Station(0.0, mass=mass, inertia=inertia)
    modes = krylov([Span(c + b, 1.0, 1.0)], [held(c, STIFF), held(c + b, STIFF), end], 4)
    # At the fourth root k L is near 12: the plain determinant is good to eps exp(12) / 12, about
    # 3e-12.
    np.testing.assert_allclose(kl(modes), found, rtol=1e-9)


# ------------------------------------------------------------------------------------------- segments
STEPPED = [Span(0.3, 2.0, 1.0), Span(0.2, 30.0, 4.0), Span(0.5, 1.0, 0.7)]
# One bearing nearly of rank one, one stiffer against tilt than against deflection.
HELD = [
    Station(0.1, np.array([[500.0, 140.0], [140.0, 40.0]])),
    Station(0.8, np.array([[40.0, -30.0], [-30.0, 900.0]])),
    Station(0.0, mass=0.3, inertia=0.01),
    Station(0.55, mass=0.2),
]


def test_splitting_changes_nothing():
    whole = krylov(STEPPED, HELD, 8)
    parts = [
        Span(s.length / 20, s.bending_stiffness, s.mass_per_length)
        for s in STEPPED
        for _ in range(20)
    ]
    split = krylov(parts, HELD, 8)
    # Rounding of 60 transfers instead of a dozen.
    np.testing.assert_allclose(split.frequency_hz, whole.frequency_hz, rtol=1e-12)


def test_a_very_short_span_costs_no_digits():
    # The dynamic stiffness of the short pieces is 12 E I / l^3 = 1e19: assembled, it would leave no
    # digit of the first mode.
    modes = krylov([Span(1e-6, 1, 1), Span(1 - 2e-6, 1, 1), Span(1e-6, 1, 1)], [], 6)
    np.testing.assert_allclose(kl(modes)[2:], CLAMPED[:4], rtol=1e-12)


# ------------------------------------------------------------------------------------------- springs, multiplicity
def test_frequencies_rise_with_the_spring_from_nothing_to_a_clamp():
    before = krylov([UNIT], [held(0.3, 0.0), held(1, 5.0)], 6).frequency_hz
    first = []
    for spring in 10.0 ** np.arange(-10, 21, 2):
        now = krylov([UNIT], [held(0.3, spring), held(1, 5.0)], 6).frequency_hz
        assert np.all(now >= before * (1 - 1e-13))  # rounding of a root
        before = now
        first.append(now[0])
    # A soft spring bears nearly rigid motion: energy of the one motion that leaves the other spring
    # alone, z = 1 - y, with the modal mass 1/3. Weaker by 1e10 than the other, so exact to 1e-9.
    np.testing.assert_allclose((2 * np.pi * first[0]) ** 2, 1e-10 * 0.7**2 * 3, rtol=1e-9)
    limit = krylov([UNIT], [held(0.3, 1e24), held(1, 5.0)], 6).frequency_hz
    np.testing.assert_allclose(before, limit, rtol=1e-12)


@pytest.mark.parametrize("reach", [0.1, 0.25, 0.3, 0.7, -0.15, 3.0])
def test_one_coupled_spring_leaves_one_rigid_motion(reach):
    # A point spring at the end of a stiff arm: rank one, although rounded, and rotation about that
    # point is free.
    arm = np.array([1.0, reach])
    modes = krylov([UNIT], [Station(0.2, 1e5 * np.outer(arm, arm))], 3)
    assert modes.rigid == 1 and modes.frequency_hz[1] > 0 and counted(modes)
    # A second one whose arm ends at the same point leaves that rotation free, one that ends
    # elsewhere does not.
    other = np.array([1.0, reach - 0.4])
    assert (
        krylov(
            [UNIT], [Station(0.2, np.outer(arm, arm)), Station(0.6, np.outer(other, other))], 3
        ).rigid
        == 1
    )
    assert (
        krylov(
            [UNIT], [Station(0.2, np.outer(arm, arm)), Station(0.6, np.outer(arm, arm))], 3
        ).rigid
        == 0
    )


def test_modes_that_stand_still_at_every_support():
    """Three equal spans: sin(n pi y) has no deflection at any support, and is simple."""
    modes = krylov([Span(3.0, 1.0, 1.0)], [held(y, STIFF) for y in range(4)], 9)
    assert counted(modes)
    np.testing.assert_allclose(kl(modes)[[0, 3, 6]], np.pi * np.arange(1, 4), rtol=1e-12)
    # Clamped spans that tilt nowhere at the supports either appear only among clamped ones; each
    # three times.
    walls = krylov([Span(1.0, 1.0, 1.0)] * 3, [held(y, STIFF, STIFF) for y in range(4)], 9)
    np.testing.assert_allclose(kl(walls), np.repeat(CLAMPED[:3], 3), rtol=1e-12)
    np.testing.assert_array_equal(walls.counts, np.repeat([[0, 3], [3, 6], [6, 9]], 3, axis=0))


# ------------------------------------------------------------------------------------------- scenes
def bending_z(scene, **options):
    """The finite elements' bending frequencies; both planes are alike here, and a pair is listed
    once.
    """
    found = sg.modes(sg.build(scene, "euler", **options), scene, n=14)
    pairs = [m for m in found.modes if m.family == "bending"]
    assert all(m.multiplicity == 2 for m in pairs)  # or the comparison would mean nothing
    return np.array([m.frequency_hz for m in pairs])


def test_stepped_shaft_against_elements():
    scene = sg.load(GEOMETRY / "shaft_stepped.toml").with_attachment("section")
    modes = krylov(*from_scene(scene), 4)
    # Few elements err by (k l)^4 / 720, 2e-7 at the fourth mode.  Many err by rounding: their
    # stiffness grows with the cube of their number against the lowest eigenvalue (1e-6 at 200 and
    # 6e-6 at 300 were seen).
    np.testing.assert_allclose(modes.frequency_hz, bending_z(scene, elements=60)[:4], rtol=1e-6)
    np.testing.assert_allclose(modes.frequency_hz, bending_z(scene, elements=200)[:4], rtol=1e-5)


def test_coupled_springs_against_elements():
    # Bearings that couple z and thx: the sign of the coupling matters by several per cent.
    # Their weak couplings out of the plane (1e-9 of the main entries) are left out.
    scene = sg.load(GEOMETRY / "thesis_overhung.toml")
    np.testing.assert_allclose(
        krylov(*from_scene(scene), 3).frequency_hz, bending_z(scene, elements=60)[:3], rtol=1e-6
    )


@pytest.mark.parametrize("name", ["pinion_overhung", "shaft_hollow"])
def test_cones_converge_to_tapered_elements(name):
    scene = sg.load(GEOMETRY / f"{name}.toml").with_attachment("section")
    reference = bending_z(scene, elements=60)[:3]
    error = np.array(
        [krylov(*from_scene(scene, pieces=p), 3).frequency_hz / reference - 1 for p in (4, 8, 16)]
    )
    # Means over a piece are of second order; Richardson of the last two leaves the fourth order and
    # the elements' own error.
    assert np.all(np.abs(error[0] / error[1] - 4) < 0.2), error
    assert np.all(np.abs(error[2] - (error[1] - error[2]) / 3) < 3e-6), error


def rod_with(**more):
    rod = Segment.cylinder("rod", length=1.0, diameter=0.04)
    clamp = sg.Bearing(name="wall", y=0.0, seat_width=0.02, hold="clamped", face="start")
    port = sg.Port(name="tip", y=1.0, lo=0.98, hi=1.0)
    return Scene.from_parts([rod], bearings=[clamp], port=port, **more)


def test_a_held_end_and_a_mass_at_the_other_are_those_of_the_scene():
    """Roots of ``1 + cos b cosh b + m b (cos b sinh b - sin b cosh b)``, m the mass at the tip over
    that of the rod.
    """
    scene = rod_with(masses=[sg.PointMass(name="lump", mass=7.0, on="tip")])
    (span,), stations = from_scene(scene)
    share = 7.0 / span.mass_per_length
    roots = [
        brentq(
            lambda b: (
                1
                + np.cos(b) * np.cosh(b)
                + share * b * (np.cos(b) * np.sinh(b) - np.sin(b) * np.cosh(b))
            ),
            *limits,
        )
        for limits in ((0.5, 2.0), (3.5, 5.0))
    ]
    wave = np.sqrt(span.bending_stiffness / span.mass_per_length) / (2 * np.pi)
    found = krylov([span], stations, 2).frequency_hz
    assert found == pytest.approx(np.square(roots) * wave, rel=1e-9)


def test_a_mass_with_a_seat_of_its_own_is_there_with_its_inertia():
    disc = sg.PointMass(name="disc", mass=5.0, inertia=(0.02, 0.03, 0.02), y=0.6, seat_width=0.01)
    scene = rod_with(masses=[disc]).with_attachment("section")
    found = krylov(*from_scene(scene), 3).frequency_hz
    np.testing.assert_allclose(found, bending_z(scene, elements=60)[:3], rtol=1e-6)


def test_what_the_model_has_no_place_for_is_refused():
    off = sg.PointMass(name="off", mass=5.0, offset=(0.0, 0.01, 0.0), on="tip")
    stand = sg.Housing(stiffness={"kxx": 1e8, "kyy": 1e8, "kzz": 1e8, "kthx": 1e6, "kthz": 1e6})
    cases = {"offset": {"masses": [off]}, "housing": {"housing": stand}}
    for words, more in cases.items():
        with pytest.raises(sg.SolidgearError, match=words):
            from_scene(rod_with(**more))
    rod = Segment.cylinder("rod", length=1.0, diameter=0.04)
    middle = sg.Port(y=0.5, lo=0.4, hi=0.6)
    edge = Fillet(name="edge", y=1.0, radius=0.002)
    with pytest.raises(sg.SolidgearError, match="fillets"):
        from_scene(Scene.from_parts([rod], port=middle, blends=[edge]))


def test_a_station_off_the_shaft_is_refused():
    with pytest.raises(sg.SolidgearError, match="outside the shaft"):
        krylov([UNIT], [Station(1.1)])
