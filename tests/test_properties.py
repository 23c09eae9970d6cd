"""What must hold for any shaft on any bearings, whatever the numbers: bounds, orders and symmetries
of elasticity.

Every property is stated once, on a scene and a way to build its body, and tried on random scenes:
many beams, some harmonic solids, on request 3D solids. No reference value is used; what is compared
are two results of the program that theory ties to each other.
"""

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse as sp
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from strategies import scenes, stiffnesses

import solidgear as sg
from solidgear.core.body import Supports, as_supports
from solidgear.core.frames import rotation
from solidgear.core.solve.statics import condense, flexibility
from solidgear.core.solve.supported import Supported

# the same examples every time; a failing one is shown as found, since making it smaller takes
# minutes
settings.register_profile(
    "properties",
    derandomize=True,
    deadline=None,
    database=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)
BEAMS = settings(settings.get_profile("properties"), max_examples=5)
HARMONICS = settings(settings.get_profile("properties"), max_examples=2)
SOLIDS = settings(settings.get_profile("properties"), max_examples=2)

COUNT = 8  # elastic shapes that are compared
HELD = dict(least_bearings=2, least_rank=3)  # bearings that usually leave nothing free


def beams(scene, theory):
    return sg.build(scene, theory, elements=12)


def harmonic(scene):
    return sg.build(scene, "harmonic", order=2, layers=1)


def solid(scene):
    return sg.build(scene, "solid", element="hex8")


theories = st.sampled_from(("euler", "timoshenko"))


def on_all_models(kind, **more):
    """One property on beams, (long) harmonic solids and (slow) 3D solids: registers the tests, named after
    it.

    ``kind`` restricts the scenes, ``more`` are strategies of further arguments of the property.
    """

    def register(claim):
        def on_beams(scene, theory, **rest):
            claim(scene, lambda s: beams(s, theory), **rest)

        def on_harmonic_solids(scene, **rest):
            claim(scene, harmonic, **rest)

        def on_solids(scene, **rest):
            claim(scene, solid, **rest)

        few = scenes(**{"most_segments": 2} | kind)
        tests = (
            BEAMS(given(scene=scenes(**kind), theory=theories, **more)(on_beams)),
            pytest.mark.slow(HARMONICS(given(scene=few, **more)(on_harmonic_solids))),
            pytest.mark.slow(SOLIDS(given(scene=few, **more)(on_solids))),
        )
        for test in tests:
            name = f"test_{claim.__name__}_{test.__name__}"
            test.__name__ = test.__qualname__ = name
            globals()[name] = test
        return claim

    return register


# ------------------------------------------------------------------------------------------------- what is compared
def frequencies(body, supports, n=COUNT):
    """All shapes in Hz, ascending, rigid ones first and pairs written twice; no coupling left out."""
    found = sg.modes(body, supports, n=n, coupling_tolerance=0.0)
    return np.sort([m.frequency_hz for m in found.modes for _ in range(m.multiplicity)])


def told(body):
    """A pair is told as its mean: members may be off that by the tolerance within which the body
    takes twins for one.
    """
    return RTOL + body.mesh.get("pair_tolerance", 0.0)


def both(a, b):
    """Two lists of frequencies, cut to the length they share."""
    n = min(len(a), len(b))
    return a[:n], b[:n]


def floor(body):
    """Hz^2 below which a squared frequency is rounding: 1e-9 of where the elastic spectrum begins
    (1e-12 of its shift times a condition of 1e6).
    """
    return 1e-9 * body.scale / (2 * np.pi) ** 2


def never_falls(low, high, noise, rtol):
    """Each of the frequencies ``high`` is at least its partner in ``low``."""
    low, high = both(low, high)
    assert (high**2 >= low**2 * (1 - 2 * rtol) - noise).all(), (low, high)


def same(a, b, noise, rtol):
    """Frequencies agree; ``noise`` in Hz^2."""
    a, b = both(a, b)
    np.testing.assert_allclose(a**2, b**2, rtol=2 * rtol, atol=noise)


def sizes(k):
    """(6,) scale of every component of a 6x6; what is 1e-9 of its kind is rounding of a free motion
    and gets no scale of its own.
    """
    diagonal = np.diag(k)
    push, tilt = diagonal[:3].max(), diagonal[3:].max()
    lever = 0.1  # m, of the order of these shafts: what a tilt stiffness resists as a translation
    kinds = np.repeat((max(push, tilt / lever**2), max(tilt, push * lever**2)), 3)
    d = np.sqrt(np.maximum(diagonal, 1e-9 * kinds))
    return np.where(d > 0, d, 1.0)


def dominates(high, low, tol):
    """``high - low`` is positive semidefinite, relative to the diagonal of ``high``."""
    d = sizes(high)
    assert np.linalg.eigvalsh((high - low) / np.outer(d, d)).min() > -tol


def near(a, b, rtol):
    """Two symmetric 6x6 agree relative to their diagonal."""
    d = sizes(b)
    assert np.abs((a - b) / np.outer(d, d)).max() < rtol


def at_port(body, supports):
    return condense(body, supports, "port")


# Relative rounding. In frequency: a factor of K + sigma M has a condition number of 1e8 here
# (highest over lowest of a beam or of a light mesh), times 1e-16, with room for ten unlucky ones.
# In statics: bearings side by side differ by up to 1e8 in stiffness, times 1e-16.
RTOL = STATIC = 1e-7


def with_moduli(scene, factor):
    """The scene with every E times a factor."""
    segments = tuple(
        s.with_changes(material=s.material.with_changes(E=s.material.E * factor))
        for s in scene.segments
    )
    return scene.with_changes(segments=segments)


# ------------------------------------------------------------------------------------------------- stiffness
@on_all_models(HELD)
def everything_stiffer_scales_exactly(scene, build):
    stiff = with_moduli(scene, 4.0).with_bearing_scale(4.0)
    stiff = stiff.with_changes(
        housing_axial=4 * scene.housing_axial if scene.housing_axial else None
    )
    soft_body, stiff_body = build(scene), build(stiff)
    # four is a power of two: not even rounding differs, up to iterations that stop elsewhere
    near(at_port(stiff_body, stiff).stiffness, 4 * at_port(soft_body, scene).stiffness, 1e-12)
    same(
        frequencies(stiff_body, stiff), 2 * frequencies(soft_body, scene), floor(stiff_body), 1e-10
    )


@on_all_models(HELD, factor=st.floats(1.01, 3.0))
def a_stiffer_material_lowers_no_frequency(scene, build, factor):
    stiff = with_moduli(scene, factor)
    soft_body, stiff_body = build(scene), build(stiff)
    never_falls(
        frequencies(soft_body, scene),
        frequencies(stiff_body, stiff),
        floor(stiff_body),
        told(stiff_body),
    )
    dominates(at_port(stiff_body, stiff).stiffness, at_port(soft_body, scene).stiffness, STATIC)


@on_all_models(dict(least_bearings=1), more=stiffnesses(least=1), which=st.integers(0, 2))
def a_stiffer_bearing_lowers_no_frequency(scene, build, more, which):
    body, supports = build(scene), as_supports(scene)
    at = 6 * (which % len(scene.bearings)) + np.arange(6)
    stiffness = supports.stiffness.copy()
    stiffness[np.ix_(at, at)] += more
    stiffer = Supports(supports.ports, stiffness)
    never_falls(frequencies(body, supports), frequencies(body, stiffer), floor(body), told(body))
    soft, stiff = at_port(body, supports), at_port(body, stiffer)
    dominates(stiff.stiffness, soft.stiffness, STATIC)
    if np.isfinite(soft.compliance).all():
        dominates(soft.compliance, stiff.compliance, STATIC)


@on_all_models(dict(least_bearings=1))
def frequencies_lie_between_free_and_clamped(scene, build):
    body, supports = build(scene), as_supports(scene)
    rank = 6 * len(supports.ports)
    clamp = Supports(supports.ports, 1e15 * np.eye(rank))  # far above any bearing drawn here
    free, held, clamped = (frequencies(body, s, COUNT + rank) for s in ((), supports, clamp))
    never_falls(free, held, floor(body), told(body))
    never_falls(held, clamped, floor(body), told(body))
    # r springs lift eigenvalue k no higher than free eigenvalue k + r (Courant and Fischer)
    for found, r in ((held, supports.root.shape[1]), (clamped, rank)):
        never_falls(found[: len(free) - r], free[r:], floor(body), told(body))
    # springs of a 1e-12th are no springs: they change an elastic eigenvalue by their size over the
    # stiffness of the shaft
    soft = frequencies(body, Supports(supports.ports, 1e-12 * supports.stiffness), COUNT)
    same(soft[6:], free[6:], 0.0, RTOL)


# ------------------------------------------------------------------------------------------------- symmetry
#: what a reflection along y does to motions: rotations are axial vectors
MIRROR = np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


def mirrored(scene):
    """The shaft the other way round."""
    end = scene.length
    segments = tuple(
        s.with_changes(
            y0=end - s.y1,
            y1=end - s.y0,
            outer0=s.outer1,
            outer1=s.outer0,
            inner0=s.inner1,
            inner1=s.inner0,
        )
        for s in reversed(scene.segments)
    )
    bearings = tuple(
        b.with_changes(y=end - b.y, matrix=MIRROR @ np.array(b.matrix) @ MIRROR)
        for b in scene.bearings
    )
    port = scene.port.with_changes(
        y=end - scene.port.y, lo=end - scene.port.hi, hi=end - scene.port.lo
    )
    return scene.with_changes(segments=segments, bearings=bearings, port=port)


@on_all_models(HELD)
def a_reversed_shaft_is_the_same_shaft(scene, build):
    other = mirrored(scene)
    here, there = build(scene), build(other)
    near(at_port(there, other).stiffness, MIRROR @ at_port(here, scene).stiffness @ MIRROR, STATIC)
    same(frequencies(there, other), frequencies(here, scene), floor(here), told(here))


def turned(scene, r):
    """The bearings turned about the shaft by a rotation (6, 6), and that."""
    return scene.with_changes(
        bearings=tuple(b.with_changes(matrix=r @ np.array(b.matrix) @ r.T) for b in scene.bearings)
    ), r


@on_all_models(HELD, quarters=st.integers(1, 3))
def turned_bearings_turn_the_stiffness(scene, build, quarters):
    other, r = turned(scene, np.rint(rotation(1, quarters * np.pi / 2)))
    body = build(scene)
    near(at_port(body, other).stiffness, r @ at_port(body, scene).stiffness @ r.T, STATIC)
    same(frequencies(body, other), frequencies(body, scene), floor(body), told(body))


@BEAMS
@given(scenes(**HELD), theories, st.integers(1, 62))
def test_no_angle_is_special_to_a_body_of_revolution(scene, theory, tenths):
    other, r = turned(scene, rotation(1, tenths / 10))
    body = beams(scene, theory)
    near(at_port(body, other).stiffness, r @ at_port(body, scene).stiffness @ r.T, STATIC)
    same(frequencies(body, other), frequencies(body, scene), floor(body), told(body))


def magnified(scene, s):
    """Every length times s, every stress at equal strain the same."""
    segments = tuple(
        p.with_changes(
            **{k: s * getattr(p, k) for k in ("y0", "y1", "outer0", "outer1", "inner0", "inner1")}
        )
        for p in scene.segments
    )
    unit = np.sqrt(s) * np.repeat((1.0, s), 3)
    bearings = tuple(
        b.with_changes(
            y=s * b.y,
            seat_width=s * b.seat_width,
            matrix=np.array(b.matrix) * np.outer(unit, unit),
            axial_series=tuple(s * k for k in b.axial_series),
        )
        for b in scene.bearings
    )
    port = scene.port.with_changes(y=s * scene.port.y, lo=s * scene.port.lo, hi=s * scene.port.hi)
    housing = s * scene.housing_axial if scene.housing_axial else None
    return scene.with_changes(
        segments=segments, bearings=bearings, port=port, housing_axial=housing
    ), unit


@on_all_models(HELD, s=st.sampled_from((4.0, 0.25, 0.1, 7.3)))
def no_unit_of_length_is_special(scene, build, s):
    other, unit = magnified(scene, s)
    here, there = build(scene), build(other)
    # by a power of four nothing is rounded anew; otherwise positions are, to a picometre
    near(
        at_port(there, other).stiffness,
        np.outer(unit, unit) * at_port(here, scene).stiffness,
        1e-12 if s in (4.0, 0.25) else STATIC,
    )
    same(
        s * frequencies(there, other),
        frequencies(here, scene),
        floor(here),
        1e-10 if s in (4.0, 0.25) else RTOL,
    )


# ------------------------------------------------------------------------------------------------- energy
@on_all_models(HELD)
def loads_and_motions_are_reciprocal(scene, build):
    body, supports = build(scene), as_supports(scene)
    # one factor, used on both sides of the diagonal and not symmetrised: what the refinement leaves
    assert flexibility(body).asymmetry < 1e-9
    held = at_port(body, supports)
    if held.free.shape[1]:
        return
    whole = Supported(body, supports, supports.stiffness, list(range(len(body.blocks))))
    rows = np.concatenate([body.rows(b) for b in body.blocks])
    load = sp.block_diag([b.ports for b in body.blocks]).toarray()[np.argsort(rows)].T
    moved = load.T @ whole.static(load)
    d = np.sqrt(np.diag(moved))
    moved = moved / np.outer(d, d)
    assert np.abs(moved - moved.T).max() < STATIC
    assert np.linalg.eigvalsh(moved + moved.T).min() > -STATIC  # no load does negative work
    # the same compliance by displacement fields and by the condensed formulas
    near(moved[:6, :6] * np.outer(d[:6], d[:6]), held.compliance, STATIC)


@on_all_models({})
def an_unheld_body_is_free_in_six_ways_only(scene, build):
    body = build(scene)
    assert body.rigid_residual() < 1e-10  # rounding of K R, of the size of |K| |R|
    found = frequencies(body, ())
    assert not found[:6].any() and found[6] ** 2 > 1e6 * floor(body)
    assert not at_port(body, ()).stiffness.any()


@BEAMS
@given(scenes(), theories)
def test_a_beam_has_no_mechanism_and_no_negative_energy(scene, theory):
    for block in beams(scene, theory).blocks:
        values = sla.eigh(block.stiffness.toarray(), block.mass.toarray(), eigvals_only=True)
        rounding = 1e-13 * values[-1]
        assert values[0] > -rounding
        assert (values < rounding).sum() == len(block.components)


# ------------------------------------------------------------------------------------------------- refinement
def halved(scene):
    """The same shaft described by segments half as long."""
    segments = []
    for s in scene.segments:
        middle = (s.y0 + s.y1) / 2
        inner, outer = s.radius_at(middle)
        segments.append(s.with_changes(name=s.name + ".1", y1=middle, outer1=outer, inner1=inner))
        segments.append(s.with_changes(name=s.name + ".2", y0=middle, outer0=outer, inner0=inner))
    return scene.with_changes(segments=tuple(segments))


@BEAMS
@given(scenes(), theories)
def test_refined_beams_converge_from_above(scene, theory):
    """One element between two marks: those of the halved shaft hold the fields of the whole one."""
    scene = scene.with_attachment(
        "section"
    )  # point loads: what an averaged seat spreads over an element, its nodal fields follow to 1e-5 only
    coarse, fine = (sg.build(s, theory, elements=1) for s in (scene, halved(scene)))
    # elements are exact in statics, but for the quadrature of steep cones
    near(at_port(fine, scene).stiffness, at_port(coarse, scene).stiffness, 1e-6)
    never_falls(frequencies(fine, scene), frequencies(coarse, scene), floor(fine), told(fine))


@pytest.mark.long
@HARMONICS
@given(scenes(most_segments=2, least_bearings=1))
def test_refined_harmonic_solids_converge_from_above(scene):
    """Rising order on one mesh: hierarchic spaces that hold one another."""
    coarse, middle, fine = (sg.build(scene, "harmonic", order=p, layers=0) for p in (3, 4, 5))
    for low, high in ((middle, coarse), (fine, middle)):
        never_falls(frequencies(low, scene), frequencies(high, scene), floor(low), told(low))
        dominates(at_port(high, scene).stiffness, at_port(low, scene).stiffness, STATIC)
