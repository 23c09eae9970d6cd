"""Teeth, splines and bolt circles by one cyclic sector: against the whole in 3D, closed forms, the
harmonic solid, and the scenes that are refused.
"""

import math
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

import solidgear as sg
from solidgear.core.frames import rotation
from solidgear.core.ladder.registry import LADDER
from solidgear.core.models.solid.plan import tetrahedra_plan
from solidgear.core.scene import Fillet
from solidgear.core.scene.closed_form import volume_of
from solidgear.core.scene.outline import Outline
from solidgear.cuts.features import BoltCircle, Keyway, Spline, Teeth
from solidgear.cuts.features.around import no_common_sector
from solidgear.cuts.sector.body import meshed_sector, sector, whole
from solidgear.cuts.sector.cyclic import Sector, basis, doubled
from solidgear.cuts.sector.meshing import volume_of_sector
from solidgear.cuts.sector.teeth import half_outline, outline, section_area, section_polar
from solidgear.cuts.solid.featured import featured_body, meshed

ROOT = Path(__file__).parent.parent
TOOTHED = ROOT / "geometry" / "pinion_toothed.toml"
STEEL = sg.Material(E=2.07e11, nu=0.3, density=7850.0)
TEETH = Teeth(name="teeth", segment="head", count=7, dedendum=0.6, model="sector")
BOLTS = BoltCircle(
    name="bolts", segment="disc", count=5, diameter=0.02, circle=0.065, depth=0.012, side="end"
)
COARSE = 0.2


def shaft(*features, bore=0.0):
    """A toothed cone, a disc and a rod on two bearings."""
    head = sg.Segment.cone(
        "head", length=0.04, start_diameter=0.05, end_diameter=0.07, bore=bore, material=STEEL
    )
    disc = sg.Segment.cylinder("disc", length=0.02, diameter=0.09, bore=bore, y0=0.04)
    rod = sg.Segment.cylinder("rod", length=0.08, diameter=0.04, bore=bore, y0=0.06)
    firm = {"kxx": 1e9, "kyy": 1e8, "kzz": 1e9, "kthx": 1e6, "kthz": 1e6}
    return sg.Scene.from_parts(
        [head, disc.with_changes(material=STEEL), rod.with_changes(material=STEEL)],
        STEEL,
        [
            sg.Bearing(name=name, y=y, seat_width=0.02, stiffness=firm)
            for name, y in (("a", 0.08), ("b", 0.13))
        ],
        sg.Port(name="gear", y=0.02, lo=0.0, hi=0.04),
        features=features,
    )


def filleted(radius=None, **teeth):
    """A gear between two shafts, with fillets of a radius on both of its faces."""
    ends = (("left", 0.0, 0.06, 0.04), ("rim", 0.06, 0.02, 0.07), ("right", 0.08, 0.06, 0.04))
    firm = {"kxx": 1e9, "kyy": 1e8, "kzz": 1e9}
    cut = Teeth(name="teeth", segment="rim", count=14, model="sector").with_changes(**teeth)
    edges = (("before", 0.06), ("behind", 0.08)) if radius else ()
    return sg.Scene.from_parts(
        [sg.Segment.cylinder(n, y0=y, length=long, diameter=d) for n, y, long, d in ends],
        STEEL,
        [
            sg.Bearing(name=name, y=y, seat_width=0.015, stiffness=firm)
            for name, y in (("a", 0.015), ("b", 0.125))
        ],
        sg.Port(name="gear", y=0.07, lo=0.06, hi=0.08),
        features=(cut,),
        blends=[Fillet(name=name, y=y, radius=radius) for name, y in edges],
    )


KEY = Keyway(
    name="key", segment="right", y=0.09, length=0.03, width=0.012, depth=0.006, angle="20 deg"
)
SPIRAL = TEETH.with_changes(spiral_angle="30 deg", hand="right")
PARTS = {
    "straight": shaft(TEETH),
    "spiral": shaft(SPIRAL),
    "bolts": shaft(BOLTS),
    "rigid seats in a bore": shaft(SPIRAL, bore=0.02).with_attachment("rigid"),
    "two teeth in a sector": shaft(
        TEETH.with_changes(count=14), BOLTS.with_changes(count=7, angle=0.1)
    ),
}
#: one tooth in a sector tells what two do, holes what straight teeth do, and seats that average what rigid ones do
MARKS = {
    "two teeth in a sector": pytest.mark.slow,
    "straight": pytest.mark.slow,
    "rigid seats in a bore": pytest.mark.slow,
    "bolts": pytest.mark.long,
}


@cache
def both(name):
    """A part as one sector and as all of its copies."""
    scene = PARTS[name]
    wanted = [(s, s.attachment) for s in scene.stations]
    coarse = {"refinement": 0.1 if scene.port.attachment == "rigid" else COARSE}
    return sector(scene, **coarse), whole(scene, wanted, **coarse)


def apart(one, other):
    """Largest difference of compliances over the largest of their kind."""
    on = np.isfinite(one)
    assert (on == np.isfinite(other)).all()
    size = np.sqrt(np.nan_to_num(np.diag(other)))
    scale = np.outer(size, size)
    use = on & (scale > 0)
    return (np.abs(one - other)[use] / scale[use]).max()


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=MARKS.get(n, ())) for n in PARTS],
)
def test_a_sector_is_the_whole(name):
    """The same elements, once as one sector with phases and once as all of its copies: rounding is
    all that is left. A wrong phase, turn, axis or port would be of order one.
    """
    scene, (one, other) = PARTS[name], both(name)
    half = ((1,), (4,), (2, 3), (0, 5))
    even = name in ("straight", "bolts")
    assert tuple(b.components for b in one.blocks) == (half if even else ((1, 4), (0, 2, 3, 5)))
    assert one.rigid_residual() < 1e-14
    mass = other.mass_matrix()
    assert np.abs(one.mass_matrix() - mass).max() < 1e-13 * np.abs(mass).max()
    a, b = (sg.condense(body, scene, "gear").compliance for body in (one, other))
    assert apart(a, b) < 1e-12
    f, g = (sg.modes(body, scene, n=6) for body in (one, other))
    first, second = (np.repeat(m.frequency_hz, m.multiplicity)[1:7] for m in (f, g))
    assert np.abs(first / second - 1).max() < 1e-11
    assert f.named("bending 1").multiplicity == 2
    # section motions weigh the same mass
    assert np.abs(f.gram - g.gram).max() < 1e-12 * np.abs(g.gram).max()


@pytest.mark.parametrize("name", ["straight", "spiral", "bolts"])
def test_volume_mass_and_inertia(name):
    """OCC's volume against the closed form to 1e-12; the mesh to what its arcs lose. Teeth have plane
    faces and lose nothing, so that the head alone is exact: straight to rounding, spiral ones to
    what curved elements leave of the helix.
    """
    scene = PARTS[name]
    features = scene.features
    wanted = [(s, s.attachment) for s in scene.stations]
    made = meshed_sector(scene, wanted, features, refinement=0.5)
    exact = volume_of_sector(scene.outline, features, made.count) * made.count / made.parts
    assert made.drawn == pytest.approx(exact, rel=1e-9)
    # edges of a seventh of a turn lose (pi/7)^4/30 of an arc
    assert made.quality.volume == pytest.approx(exact, rel=2e-3)
    if name != "bolts":
        from solidgear.cuts.sector.half import half_sector_solid
        from solidgear.cuts.sector.mesh import sector_solid

        mesh = (half_sector_solid if made.half else sector_solid)(made)
        pieces = mesh.over_cells(np.flatnonzero(made.segment == 0))
        parts = [(w.sum(), (w * (x[0] ** 2 + x[2] ** 2)).sum()) for _, x, w, _ in pieces]
        volume, polar = made.parts * np.sum(parts, axis=0)
        a, b = 0.025, 0.035
        area = section_area(TEETH)
        tight = 1e-12 if name == "straight" else 1e-4
        assert volume == pytest.approx(area * 0.04 * (a * a + a * b + b * b) / 3, rel=tight)
        fourth = (a**4 + a**3 * b + a**2 * b**2 + a * b**3 + b**4) / 5
        assert polar == pytest.approx(section_polar(TEETH) * 0.04 * fourth, rel=tight)


@pytest.mark.long
def test_a_cone_without_teeth_is_the_harmonic_solid():
    """Two elements of order two across a radius and graded seat ends: the harmonic solid, which
    shares no mesh with it, lies within 2.5 % of the compliance (tilt is the worst) and 0.5 % of
    frequencies.
    """
    scene = shaft()
    one = sector(scene, refinement=0.7, count=8)
    other = sg.build(scene, "harmonic", order=4, layers=2)
    a, b = (sg.condense(body, scene, "gear").compliance for body in (one, other))
    on = [0, 1, 2, 3, 5]
    assert np.diag(a)[on] == pytest.approx(np.diag(b)[on], rel=2.5e-2)
    assert (np.diag(a)[on] < np.diag(b)[on]).all()  # displacement elements are too stiff
    f, g = (sg.modes(body, scene, n=6, ovalising=False) for body in (one, other))
    for name in ("bending 1", "axial 1", "torsion 1"):
        assert f.named(name).frequency_hz == pytest.approx(g.named(name).frequency_hz, rel=5e-3)
        assert f.named(name).frequency_hz > g.named(name).frequency_hz


def coupling(feature):
    """C_y,thy of the head on firm bearings, over the root of its diagonal."""
    scene = shaft(feature)
    firm = {"kxx": 1e9, "kyy": 1e8, "kzz": 1e9, "kthx": 1e6, "kthy": 1e6, "kthz": 1e6}
    held = [
        b.with_changes(matrix=sg.Bearing(name="k", y=0.1, seat_width=0.01, stiffness=firm).matrix)
        for b in scene.bearings
    ]
    c = sg.condense(sector(scene, refinement=0.35), held, "gear").compliance
    return c[1, 4] / math.sqrt(c[1, 1] * c[4, 4])


@pytest.mark.long
def test_spiral_teeth_couple_axial_motion_and_torsion():
    """A mirror plane through the axis forbids C_y,thy, and the other hand turns its sign."""
    right, left = (coupling(SPIRAL.with_changes(hand=hand)) for hand in ("right", "left"))
    straight = coupling(TEETH)
    assert abs(right) > 20 * abs(straight)
    assert right == pytest.approx(-left, rel=0.1)


def test_a_right_hand_turns_about_y_along_y():
    """Vertices of the tooth's middle at both ends of the head, by its closed form."""
    scene = shaft(SPIRAL)
    made = meshed_sector(scene, [(s, s.attachment) for s in scene.stations], (SPIRAL,))
    x, y, z = made.mesh.p[:, np.unique(made.mesh.t)]
    turned = np.arctan2(x, z)
    slope = 0.25
    full = math.tan(math.radians(30)) * math.hypot(1, slope) / slope * math.log(0.035 / 0.025)
    for place, wanted in ((0.0, 0.0), (0.04, full)):
        at = (np.abs(y - place) < 1e-9) & (np.hypot(x, z) > 0.0101)
        # a sector is even about its middle
        assert (turned[at].max() + turned[at].min()) / 2 == pytest.approx(wanted, abs=1e-9)


@pytest.mark.long
def test_pictures_are_of_all_copies():
    """The surface of the sector's copies moves as that of the whole, point by point."""
    from scipy.spatial import cKDTree

    scene, (one, other) = PARTS["spiral"], both("spiral")
    for name in ("bending 1", "torsion 1"):
        moved = []
        for body in (one, other):
            found = sg.modes(body, scene, n=6).named(name)
            moved.append([body.surface(v) for v in found.vectors])
        gap, at = cKDTree(moved[0][0].points).query(moved[1][0].points)
        assert gap.max() < 1e-12
        a, b = (
            np.array([s.displacement[k].ravel() for s in own]).T
            for own, k in ((moved[0], at), (moved[1], slice(None)))
        )
        left = b - a @ np.linalg.lstsq(a, b, rcond=None)[0]
        assert np.linalg.norm(left) < 1e-6 * np.linalg.norm(b)
        faces = len(moved[1][0].triangles)
        assert len(moved[0][0].triangles) == faces


@pytest.mark.slow
def test_higher_harmonics_are_those_of_the_whole():
    """Two waves around: in neither block of the ports, and a pair in the whole."""
    scene = shaft(TEETH, bore=0.034)
    wanted = [(s, s.attachment) for s in scene.stations]
    one = sector(scene, refinement=COARSE, ovalising=(2,), half=False)
    assert [b.name for b in one.blocks] == ["cyclic_0", "cyclic_1", "cyclic_2"]
    f, g = (sg.modes(b, scene, n=16) for b in (one, whole(scene, wanted, refinement=COARSE)))
    oval = next(m for m in f.modes if m.waves == 2)
    assert oval.name == "ovalising n=2 1" and oval.multiplicity == 2
    assert np.abs(g.frequency_hz / oval.frequency_hz - 1).min() < 1e-9
    with pytest.raises(sg.SolidgearError, match="not below half of the 7 sectors"):
        sector(scene, refinement=COARSE, ovalising=(4,))


def test_a_node_on_the_axis():
    """What a turn by a sector leaves of it: axial motion, one complex number, nothing."""
    around = Sector(7, np.zeros(0, int), np.zeros(0, int), np.array([0]))
    for h, size in ((0, 1), (1, 1), (2, 0), (3, 0)):
        assert basis(around, 1, h)[0].shape == (3, size)
    motion = basis(around, 1, 1)[0].toarray()[:, 0]
    angle = 2 * np.pi / 7
    turned = rotation(1, angle)[:3, :3] @ motion
    assert np.abs(np.exp(1j * angle) * turned - motion).max() < 1e-15
    assert doubled(basis(around, 1, 1)[0]).shape == (6, 2)


@pytest.mark.long
def test_smeared_teeth_change_no_model_of_revolution():
    """The default is the segment as it is; the sector resolves teeth where it is asked by name."""
    smeared = TEETH.with_changes(model="pitch_cone")
    scene = shaft(smeared)
    for rung in ("timoshenko", "harmonic"):
        a, b = (sg.condense(sg.build(s, rung), s, "gear") for s in (scene, shaft()))
        assert np.array_equal(a.compliance, b.compliance, equal_nan=True)
    assert sg.build(scene, "solid", layers=1, radial_layers=1).mesh["element"] == "hex20"
    assert sg.build(scene, "sector", refinement=COARSE).mesh["features"] == ["teeth"]
    from solidgear.core.ladder.registry import LADDER

    assert "sector" not in LADDER.fit(scene) and "sector" in LADDER.fit(shaft(TEETH))
    assert "solid" not in LADDER.fit(shaft(TEETH))  # copies of the sector are no second opinion


def test_who_holds_what():
    key = Keyway(name="key", segment="rod", y=0.1, length=0.03, width=0.01, depth=0.005)
    both = shaft(TEETH, key)
    for rung, says in (
        ("harmonic", 'of revolution and the scene has teeth "teeth", keyway "key"'),
        (
            "sector",
            'one sector that repeats itself around the axis, and the scene has keyway "key"',
        ),
        ("corrected", 'made of two meshes, with cuts and without, and the scene has teeth "teeth"'),
    ):
        with pytest.raises(sg.SolidgearError) as caught:
            sg.build(both, rung)
        assert says in str(caught.value) and len(str(caught.value).splitlines()) == 1
    with pytest.raises(sg.SolidgearError, match="the scene has none of: bolt circle, .*spline"):
        sg.build(shaft(), "sector")
    with pytest.raises(sg.SolidgearError, match="7 of teeth .* no sector"):
        sg.build(shaft(TEETH, BOLTS), "sector")


BAD = {
    "count = 14 ": ("count = 2 ", "greater than or equal to 3"),
    "addendum = 1.0": ("addendum = 9", "between 0 and 3 modules"),
    "dedendum = 1.2": ("dedendum = 3", "roots"),
    "addendum = 1.0 ": ("addendum = 2.9", "edge"),
    "half_thickness = 0.25": ("half_thickness = 0.6", "between 0.1 and 0.4"),
    'segment = "head"\ncount': ('segment = "hub"\ncount', "unknown segment"),
    'kind = "teeth"': ('kind = "spline"', "a spline is cut into a cylinder"),
    'model = "sector"': ('model = "cone"', "pitch_cone"),
    'model = "sector"\n': ('position = "3 mm"\n', "unknown key"),
}


@pytest.mark.parametrize("old", BAD)
def test_bad_teeth_are_one_sentence(old, refused):
    text = TOOTHED.read_text()
    new, says = BAD[old]
    old = old if old in text else old.strip()
    refused(text, old, new, says)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"circle": 0.075}, "out of"),
        ({"circle": 0.02}, "into the axis"),
        ({"diameter": 0.05}, "out of"),
        ({"count": 40}, "run into each other"),
        ({"depth": 0.03}, "deeper than"),
        ({"side": "start"}, 'covers the holes at the start of "disc"'),
        ({"diameter": 1e-5}, "under a hundredth"),
    ],
)
def test_bad_bolt_circles(change, says):
    with pytest.raises(sg.SceneError, match=says):
        shaft(BOLTS.with_changes(**change))


def test_teeth_without_height_are_refused():
    with pytest.raises(sg.SceneError, match="leave the feature out"):
        Teeth(name="t", segment="head", count=14, addendum=0, dedendum=0)


def with_arcs(teeth):
    """Area and polar moment of the section with arcs for tips and lands: ``r^2 / 2`` and ``r^4 / 4``
    over the angle, the flank by its line.
    """
    half = math.pi / teeth.count
    ends = np.array([[teeth.root, teeth.root_half], [teeth.tip, teeth.tip_half]])
    (x, z), (tx, tz) = ((r * math.sin(t), r * math.cos(t)) for r, t in ends)
    across = np.array([tz - z, x - tx])

    def flank(angle, power):
        return (across @ [x, z] / (across @ [math.sin(angle), math.cos(angle)])) ** power

    found = []
    for power in (2, 4):
        between = quad(flank, teeth.tip_half, teeth.root_half, args=(power,))[0]
        arcs = teeth.tip**power * teeth.tip_half + teeth.root**power * (half - teeth.root_half)
        found.append(2 * teeth.count * (between + arcs) / power)
    return np.array(found)


def test_what_chords_take_from_few_and_many_teeth_is_as_told():
    """The numbers of the guide and of the limits."""
    usual = TEETH.with_changes(count=14, dedendum=1.2)
    lack = 1 - np.array([section_area(usual), section_polar(usual)]) / with_arcs(usual)
    assert lack == pytest.approx([0.0010, 0.0025], abs=5e-5)
    low = {"addendum": 0.1, "dedendum": 0.1, "flank_angle": 0.0}
    for count in (3, 4, 5, 7, 12, 20, 60):
        few = Teeth(name="t", segment="s", count=count, **low)
        lack = 1 - np.array([section_area(few), section_polar(few)]) / with_arcs(few)
        assert (0 < lack).all()
        assert (lack < [0.004, 0.008]).all()


def test_a_border_and_a_mirror_plane_meet_a_row_of_chords_in_the_middle_of_one():
    few = Teeth(name="t", segment="s", count=6, addendum=0.2, dedendum=0.2)
    for count in (6, 3):
        angle, radius = outline(few, count)
        assert np.allclose(angle, -angle[::-1])
        assert np.allclose(radius, radius[::-1])
        assert angle[-1] == pytest.approx(math.pi / count)
        spans = np.diff(angle[(radius == few.tip) | (radius == few.root)])
        assert spans.max() <= 0.15
        half_angle, half_radius = half_outline(few, count)
        turned = half_radius * np.cos(half_angle), half_radius * np.sin(half_angle)
        twice = (turned[0][1:] * turned[1][:-1] - turned[0][:-1] * turned[1][1:]).sum()
        assert abs(twice) * count == pytest.approx(section_area(few))


def test_a_spline_is_a_cylinder_with_teeth():
    """Volume of low teeth of equal height and depth: the cylinder's own, but for the chords."""
    spline = Spline(name="s", segment="rod", count=30, addendum=0.5, dedendum=0.5, model="sector")
    scene = shaft(spline)
    exact = 30 * volume_of_sector(scene.outline, (spline,), 30)
    assert exact == pytest.approx(volume_of(Outline(scene.segments)), rel=1e-2)
    body = sg.build(scene, "sector", refinement=COARSE)
    assert body.mesh["volume"] == pytest.approx(exact, rel=1e-4)


@pytest.mark.long
def test_check_says_what_smearing_costs():
    """Bounds of the rule hold for what the sector says of one pinion, and the tolerance decides."""
    from solidgear.cuts.sector.smearing import expected
    from solidgear.guards.check import check_scene

    smeared = TEETH.with_changes(model="pitch_cone")
    scene = shaft(smeared)
    stiffness, frequency = expected(scene)
    teeth, cone = (
        sector(s, refinement=COARSE, count=7, material_port=True) for s in (scene, scene.plain)
    )
    a, b = (np.diag(sg.condense(body, scene, "gear").compliance) for body in (teeth, cone))
    assert (np.abs(b / a - 1)[[0, 2, 3, 5]] < stiffness).all()
    f, g = (sg.modes(body, scene, n=6) for body in (teeth, cone))
    for name in ("bending 1", "axial 1"):
        apart = g.named(name).frequency_hz / f.named(name).frequency_hz - 1
        assert abs(apart) < frequency, name
    # mass and inertia by the closed form against those of the mesh of the head
    from solidgear.cuts.sector.teeth import lacking

    mass, polar = lacking(smeared, scene.segments[0])
    more = teeth.mass_matrix() - cone.mass_matrix()
    # arcs of the cone lose (pi/7)^4/30 of it
    whole = cone.mass_matrix()
    assert abs(more[0, 0] - mass) < 2e-3 * whole[0, 0]
    assert abs(more[4, 4] - polar) < 4e-3 * whole[4, 4]
    body = sg.build(scene, "timoshenko")
    for tolerance, level in ((0.2, "fact"), (1e-3, "caution")):
        asked = scene.with_changes(ask=sg.Ask(tolerance=tolerance))
        said = check_scene(asked, body).records
        (own,) = [r for r in said if "smeared" in r.sentence]
        assert own.level == level


def test_features_that_meet_on_one_segment():
    """Where two features cannot both be there, one sentence says so; none is dropped, or twisted
    with spiral teeth, in silence.
    """
    drilled = BoltCircle(name="oil", segment="head", count=7, diameter=0.004, circle=0.03)
    twice = TEETH.with_changes(name="more", count=14)
    for features, says in (
        ((TEETH, twice), 'has the teeth "teeth" already'),
        ((TEETH, drilled.with_changes(circle=0.04)), 'into the teeth "teeth", whose roots lie'),
        ((SPIRAL, drilled), "spiral teeth .* straight holes"),
        ((BOLTS, BOLTS.with_changes(name="b", angle=0.05)), 'run into those of "bolts"'),
        ((BOLTS, BOLTS.with_changes(name="b", count=7)), 'run into those of "bolts"'),
    ):
        with pytest.raises(sg.SceneError, match=says) as caught:
            shaft(*features)
        assert len(str(caught.value).splitlines()) == 1
    # near misses: the teeth are a cone here, the holes lie between others, or below the roots
    shaft(SPIRAL.with_changes(model="pitch_cone"), drilled)
    small = BOLTS.with_changes(diameter=0.01)
    shaft(small, small.with_changes(name="b", count=10, angle=math.pi / 10, diameter=0.005))
    shaft(TEETH, drilled.with_changes(circle=0.02, diameter=0.003))


def test_smeared_teeth_stay_smeared_beside_bolts():
    """The segment of revolution stands for them in every model that the scene fits, so that their
    count asks for no common sector.
    """
    from solidgear.core.ladder.registry import LADDER

    smeared = TEETH.with_changes(model="pitch_cone", count=14)
    scene, bare = shaft(smeared, BOLTS), shaft(BOLTS)
    assert LADDER["sector"].unfit(scene) == LADDER["solid"].unfit(scene) == ""
    a, b = (sg.build(s, "sector", refinement=COARSE) for s in (scene, bare))
    assert np.array_equal(a.mass_matrix(), b.mass_matrix())


@pytest.mark.parametrize(
    "segment, spiral, says",
    [
        ("rod", "20 deg", 'a mesh with spline "s" is twisted'),
        ("disc", "0 deg", 'keyway "key" is cut into the segment of spline "s"'),
    ],
)
def test_teeth_and_a_keyway_are_refused_with_the_words_that_let_models_hold_both(
    segment, spiral, says
):
    """Spiral ones on one shaft, and any on their very segment."""
    at = {"rod": 0.1, "disc": 0.044}[segment]
    key = Keyway(name="key", segment=segment, y=at, length=0.012, width=0.006, depth=0.004)
    spline = Spline(name="s", segment="disc", count=19, model="sector", spiral_angle=spiral)
    assert says in LADDER["solid"].unfit(shaft(spline, key))
    with pytest.raises(sg.SolidgearError) as caught:
        sg.answer(shaft(spline, key), 0.1, "C_zz")
    assert 'write model = "pitch_cone" for spline "s", which replaces teeth' in str(caught.value)
    assert str(caught.value).endswith("use corrected or solid")
    assert str(caught.value).count("no model") == 1
    taught = shaft(spline.with_changes(model="pitch_cone"), key)
    assert not any(LADDER[name].unfit(taught) for name in ("corrected", "solid"))


def keyed_and_bare(**teeth):
    """A gear on a keyed shaft, on one mesh with the keyway and without; it looks between two of an odd
    number of teeth.
    """
    scene = filleted(count=9, dedendum=0.8, angle="7 deg", **teeth)
    scene = scene.with_changes(features=(*scene.features, KEY))
    wanted = [(s, s.attachment) for s in scene.stations]
    options = {"size": None, "graded_size": None, "refinement": 0.3, "around": 12}
    made = meshed(scene, tetrahedra_plan(scene, wanted, **options), 0.3, False, edges=True)
    return scene, *(featured_body(scene, wanted, made, 0.3, plain=p) for p in (True, False))


@pytest.mark.long
def test_teeth_and_a_keyway_in_one_solid():
    """Volumes of both are closed, tips lie where teeth do, and what is gone where the keyway looks."""
    scene, bare, cut = keyed_and_bare()
    gone = bare.mass_matrix() - cut.mass_matrix()
    assert gone[0, 0] == pytest.approx(7850 * KEY.volume(0.02, 0.0), rel=2e-3)
    assert math.atan2(gone[1, 5], -gone[1, 3]) == pytest.approx(math.radians(20), abs=2e-3)
    whole = volume_of_sector(scene.outline, scene.features[:1], 1)
    assert bare.mesh["volume"] == pytest.approx(whole, rel=1e-3)
    x, _, z = bare.geometry.mesh.p
    tips = np.arctan2(x, z)[np.hypot(x, z) > 0.035 * scene.features[0].tip - 1e-6] * 9
    middle = np.angle(np.exp(1j * tips).sum())
    assert middle == pytest.approx(9 * scene.features[0].angle, abs=1e-6) and len(tips) >= 36
    assert not LADDER["solid"].unfit(scene) and LADDER["corrected"].unfit(scene)


@pytest.mark.slow
def test_a_keyway_does_beside_teeth_what_it_does_beside_their_cone():
    """To the 3 % that meshes and what one leaves of the other change of it."""
    effect = []
    for model in ("sector", "pitch_cone"):
        scene, *both = keyed_and_bare(model=model)
        bare, cut = (sg.condense(body, scene, "gear").compliance for body in both)
        effect.append((cut - bare)[np.ix_([0, 2, 3], [0, 2, 3])])
    size = np.sqrt(np.diag(effect[1]))
    assert np.abs((effect[0] - effect[1]) / np.outer(size, size)).max() < 0.06


@pytest.mark.parametrize("teeth", [{}, {"spiral_angle": "20 deg"}], ids=["half", "whole"])
def test_fillets_beside_teeth_are_drawn(teeth):
    """Of OCC to rounding; of elements as coarse as this some 1e-3 of the sector, 3 % of the fillets."""
    scene = filleted(0.004, **teeth)
    made = meshed_sector(scene, [(s, s.attachment) for s in scene.stations], scene.features)
    exact = volume_of_sector(scene.outline, scene.features, 14) * 14 / made.parts
    assert made.drawn == pytest.approx(exact, rel=1e-9)
    added = volume_of(scene.outline) - volume_of(filleted().outline)
    ring = 2 * math.pi * (1 - math.pi / 4) * 0.004**2 * (0.02 + 0.223 * 0.004)
    assert added == pytest.approx(2 * ring, rel=1e-3)
    assert abs(made.quality.volume - exact) < 0.05 * added / made.parts


@pytest.mark.slow
def test_a_fillet_beside_teeth_does_what_one_at_the_pitch_cone_does():
    """It takes 5 % of C_zz and 11 % of C_thx of the body of revolution, and a tenth to a fifth less of
    each from the part whose face ends at the roots, by 4 elements to a radius.
    """
    effect = []
    for model, options in (
        ("harmonic", {"order": 3, "layers": 1}),
        ("sector", {"refinement": 0.6}),
    ):
        found = []
        for scene in (filleted(), filleted(0.004)):
            own = scene.plain if model == "harmonic" else scene
            found.append(sg.condense(sg.build(own, model, **options), own, "gear").compliance)
        effect.append(np.diag(found[1] - found[0])[[2, 3]] / np.diag(found[0])[[2, 3]])
    assert effect[0] == pytest.approx([-0.05, -0.11], rel=0.05)
    assert effect[1] == pytest.approx(effect[0], rel=0.25)


def test_a_model_that_says_it_fits_can_be_built():
    """Fillets, counts and phases that leave no sector are told before anything is meshed."""
    from solidgear.core.ladder import way_out

    high = filleted(0.0124)
    spline = Spline(name="s", segment="rod", count=7, angle=0.1, dedendum=0.5, model="sector")
    scenes = {
        'fillet "before" reaches 0.0324 m.* roots of "rim" lie at 0.0289': high,
        "no sector of a third": shaft(TEETH, BOLTS),
        "gaps of spline .*write angle": shaft(TEETH, spline),
    }
    for says, scene in scenes.items():
        for rung in ("sector", "solid"):
            with pytest.raises(sg.SolidgearError, match=says) as caught:
                sg.build(scene, rung)
            assert LADDER[rung].unfit(scene) in str(caught.value)
        assert "no model solves all features of the scene" in str(caught.value)
    told = no_common_sector((TEETH, spline))
    turned = spline.with_changes(angle=re.search('angle = "(.*)"', told)[1])
    assert no_common_sector((TEETH, turned)) == ""  # as it was printed
    assert 'write model = "pitch_cone" for teeth' in way_out(high)
    cone = high.with_changes(features=(high.features[0].with_changes(model="pitch_cone"),))
    assert "roots of" in LADDER["sector"].unfit(cone) and not LADDER["solid"].unfit(cone)


def test_a_seat_keeps_the_faces_whose_edges_had_to_be_straightened():
    """Wide cells of a wedge fold when their edges follow the surface, and are given chords. Without
    those faces the seat of the cone was a fifth of itself, and C_yy 2 % above the exact one, where
    displacement elements have none.
    """
    scene = sg.load(ROOT / "geometry" / "pinion_toothed.toml").plain
    exact = sg.condense(sg.build(scene, "harmonic", order=3, layers=2), scene, scene.port.name)
    body = sector(scene, count=14, refinement=0.5)
    found = sg.condense(body, scene, scene.port.name)
    for i in (1, 2):
        off = found.compliance[i, i] / exact.compliance[i, i] - 1
        assert -0.01 < off < 0, (i, off)
