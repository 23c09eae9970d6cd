"""Fillets and chamfers: geometry in closed form, meshes of all solids, convergence, bad input."""

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse.linalg as spla

import solidgear as sg
from solidgear import Port, Scene, SceneError, Segment
from solidgear.core.bounds.harmonic import richer_space
from solidgear.core.ladder.registry import LADDER
from solidgear.core.scene import Chamfer, Fillet
from solidgear.core.scene.closed_form import mass_properties, volume_of
from solidgear.core.scene.coned import coned
from solidgear.guards import elements
from solidgear.guards.edges import fillets
from solidgear.guards.probe import Probe

HEAD, SHAFT = ("head", 0.068, 0.134), ("shaft", 0.208, 0.09)


def stepped(*blends, turned=False, bore=0.0):
    """D134 over 68 mm on D90, 276 mm in all; end for end if turned."""
    parts, y = [], 0.0
    for name, length, diameter in (SHAFT, HEAD) if turned else (HEAD, SHAFT):
        parts.append(Segment.cylinder(name, length=length, diameter=diameter, bore=bore, y0=y))
        y += length
    lo, hi = (y - 0.034, y - 0.014) if turned else (0.014, 0.034)
    port = Port(y=(lo + hi) / 2, lo=lo, hi=hi)
    return Scene.from_parts(parts, port=port, blends=blends)


def root(radius, turned=False):
    return Fillet(name="root", y=0.208 if turned else 0.068, radius=radius)


def everywhere():
    """Fillets and chamfers at roots and rims, outside and in the bore, on either side of a joint."""
    a = Segment.cylinder("a", length=0.08, diameter=0.05, bore=0.02)
    b = Segment.cylinder("b", length=0.05, diameter=0.1, bore=0.03, y0=0.08)
    c = Segment.cylinder("c", length=0.1, diameter=0.06, bore=0.016, y0=0.13)
    blends = [
        Fillet(name="1", y=0.08, radius=0.004),
        Chamfer(name="2", y=0.08, edge="rim", length=0.003),
        Fillet(name="3", y=0.13, radius=0.005),
        Fillet(name="4", y=0.13, edge="rim", radius=0.006),
        Chamfer(name="5", y=0, length=0.002, angle="30 deg"),
        Fillet(name="6", y=0.23, radius=0.003),
        Fillet(name="7", y=0.08, surface="bore", radius=0.002),
        Chamfer(name="8", y=0.13, surface="bore", edge="rim", length=0.002),
        Fillet(name="9", y=0.13, surface="bore", radius=0.003),
        Chamfer(name="10", y=0.23, surface="bore", length=0.002),
    ]
    return Scene.from_parts([a, b, c], port=Port(y=0.1, lo=0.09, hi=0.12), blends=blends)


def first_bending(scene, **mesh):
    """First free bending of the harmonic solid, Hz, to rounding."""
    body = sg.build(scene, "harmonic", families=("bending",), attachments=("section",), **mesh)
    k, m = body.blocks[0].stiffness.tocsc(), body.blocks[0].mass.tocsc()
    shifted = (k + (2 * np.pi * 500) ** 2 * m).tocsc()
    # symmetric and definite: no pivoting, and an ordering for that
    options = {"SymmetricMode": True}
    solve = spla.splu(shifted, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options).solve
    x = np.random.default_rng(0).normal(size=(k.shape[0], 5))
    for _ in range(12):
        x = np.linalg.qr(solve(m @ x))[0]
        values, shapes = sla.eigh(x.T @ (k @ x), x.T @ (m @ x))
        x = x @ shapes
    return float(np.sqrt(values[2])) / (2 * np.pi)


def inertias(body):
    m = body.mass_matrix()
    centre = m[3, 2] / m[0, 0]
    return np.array([m[0, 0], m[4, 4], m[3, 3] - centre**2 * m[0, 0]])


def exact(scene):
    e = mass_properties(scene.outline)
    return np.array([e.mass, e.iyy, e.ixx])


def quadrature(scene):
    """Volume, axial and polar second moment of a solid stepped shaft by its outline alone."""
    y, w = np.polynomial.legendre.leggauss(100)
    cuts = sorted({0.0, 0.276, *(v for c in scene.corners for v in c.span), 0.068})
    total = np.zeros(2)
    for a, b in zip(cuts, cuts[1:]):
        # the root of a half circle is smooth in an angle
        t = (1 - np.cos(np.pi * (y + 1) / 2)) / 2
        at, weight = a + (b - a) * t, w * (b - a) * np.pi / 4 * np.sin(np.pi * (y + 1) / 2)
        r = np.where(at < 0.068, 0.067, 0.045)
        for c in scene.corners:
            lo, hi = c.span
            if (lo <= (a + b) / 2) & ((a + b) / 2 <= hi):
                s = np.abs(at - c.on_cylinder[1])
                rise = s * c.radial / c.axial
                if c.centre:
                    rise = c.radial - np.sqrt(np.maximum(c.radial**2 - s**2, 0.0))
                r = c.r + c.out * rise
        total += np.pi * (weight @ r**2), np.pi / 2 * (weight @ r**4)
    return total


def test_closed_forms_against_quadrature_along_the_outline():
    """An integral of the outline in an angle, where it is smooth, has no error but rounding."""
    scene = stepped(
        root(0.006),
        Fillet(name="rim", y=0.068, edge="rim", radius=0.004),
        Chamfer(name="start", y=0.0, length=0.005, angle="30 deg"),
        Chamfer(name="end", y="276 mm", length=0.003),
    )
    volume, polar = quadrature(scene)
    assert volume_of(scene.outline) == pytest.approx(volume, rel=1e-12)
    assert exact(scene)[1] == pytest.approx(7850 * polar, rel=1e-12)


def beside_a_step(parts, **kind):
    ends = [
        sg.Bearing(name=n, y=y, seat_width=0.015, stiffness={"kxx": 5e8, "kyy": 2e8, "kzz": 5e8})
        for n, y in (("A", 0.03), ("B", 0.27))
    ]
    port = Port(y=0.12, lo=0.11, hi=0.13)
    return Scene.from_parts(parts, port=port, bearings=ends, **kind)


def chamfer_and_cone():
    """A chamfer in a shoulder, and the same outline in three segments."""
    rise = 0.002 * np.tan(np.radians(70))
    thick = Segment.cylinder("b", length=0.15, diameter=0.06, y0=0.15)
    whole = Segment.cylinder("a", length=0.15, diameter=0.04)
    part = Segment.cylinder("a", length=0.148, diameter=0.04)
    cone = Segment(name="c", y0=0.148, y1=0.15, outer0=0.02, outer1=0.02 + rise)
    chamfer = Chamfer(name="f", y=0.15, length=0.002, angle="70 deg")
    return beside_a_step([whole, thick], blends=[chamfer]), beside_a_step([part, cone, thick])


def test_a_chamfer_in_a_shoulder_is_meshed_as_a_cone():
    """The harmonic solid of either is the same, so that layers lead to both corners; a rim, and a
    chamfer whose cone another one needs, stay what they are.
    """
    scene, cones = chamfer_and_cone()
    found, same = (sg.build(s, "harmonic", order=3, layers=1) for s in (scene, cones))
    assert found.size == same.size
    a, b = (sg.condense(body, scene, "port").compliance for body in (found, same))
    assert a[2, 2] == pytest.approx(b[2, 2], rel=1e-12)
    assert coned(cones) is cones
    shaft = coned(scene)
    assert not shaft.corners and [s.length for s in shaft.segments] == pytest.approx(
        [s.length for s in cones.segments]
    )
    rim = scene.with_changes(blends=[Chamfer(name="r", y=0.15, edge="rim", length="2 mm")])
    assert coned(rim) is rim


@pytest.mark.slow
def test_bars_beside_a_chamfer_hold_against_the_same_outline_as_a_cone():
    # its two corners are cut as those of a cone are
    scene, cones = chamfer_and_cone()
    asked = ["C_zz", "C_thx"]
    found = sg.answer(scene, tol=1e-3, ask=asked)
    fine = sg.build(cones, "harmonic", order=6, layers=4, edge_layers=3, relative_size=4.0)
    c = sg.condense(fine, cones, "port").compliance
    assert found.reached
    for one, truth in zip(found.values, (c[2, 2], c[3, 3])):
        assert abs(one.value / truth - 1) <= one.bar < 1e-3


@pytest.mark.parametrize(
    ("order", "tolerance"),
    # isoparametric arcs: the area is off by the square of what order p leaves of a 45 degree arc
    [(2, 1e-4), (3, 1e-6), (5, 1e-11)],
)
def test_harmonic_solid_has_the_mass_of_the_closed_form(order, tolerance):
    scene = everywhere()
    body = sg.build(scene, "harmonic", order=order, layers=1)
    assert inertias(body) == pytest.approx(exact(scene), rel=tolerance)
    assert body.rigid_residual() < 1e-14  # it moves freely whatever the order


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(
    ("diameters", "bores", "surface"),
    [
        ((0.055, 0.045), (0.02, 0.0), "outer"),
        ((0.055, 0.045), (0.012, 0.02), "outer"),
        ((0.055, 0.045), (0.02, 0.012), "bore"),
    ],
)
def test_a_step_without_a_fillet_stays_in_its_plane_beside_one_with(
    diameters, bores, surface, turned
):
    """The line of a joint moves to the end of a fillet, but not where it is a face."""
    ends = [*zip(("a", "b"), diameters, bores)][:: -1 if turned else 1]
    parts = [Segment.cylinder(n, length=0.08, diameter=d, bore=b) for n, d, b in ends]
    fillet = Fillet(name="f", y=0.08, radius=0.002, surface=surface)
    scene = Scene.from_parts(parts, port=Port(y=0.03, lo=0.02, hi=0.04), blends=[fillet])
    body = sg.build(scene, "harmonic", order=3, layers=1)
    assert inertias(body) == pytest.approx(exact(scene), rel=1e-7)


def test_hexahedra_have_it_within_the_gate_and_are_counted():
    scene = everywhere()
    options = {"element": "hex20", "layers": 1, "radial_layers": 1}
    options |= {"around": 8, "relative_size": 1.0}
    body = sg.build(scene, "solid", **options)
    # quadratic sides of 45 degrees on a small part of the volume
    assert inertias(body) == pytest.approx(exact(scene), rel=3e-4)
    assert body.size == LADDER["solid"].size(scene, options).unknowns


@pytest.mark.slow
def test_tetrahedra_fold_nowhere_and_have_it_within_the_gate():
    scene = everywhere()
    body = sg.build(scene, "solid", element="tet10", refinement=0.35)
    assert inertias(body) == pytest.approx(exact(scene), rel=2e-3)  # eight elements around


def test_a_scene_without_blends_is_the_same():
    """Not nearly: the very same matrices."""
    plain, emptied = stepped(), stepped(root(0.004)).with_changes(blends=())
    a, b = (sg.build(s, "harmonic", order=3, layers=2) for s in (plain, emptied))
    for one, other in zip(a.blocks, b.blocks):
        assert abs(one.stiffness - other.stiffness).max() == 0.0
        assert abs(one.mass - other.mass).max() == 0.0
    assert "blends" not in plain.as_dict()


@pytest.mark.parametrize(("radius", "least"), [(0.0045, 4.0), (0.009, 4.0)])
def test_first_bending_falls_exponentially_with_the_order(radius, least):
    """A sharp shoulder gives a power of the order; a fillet at least a factor an order (r / d 0.05
    and 0.10: 8 measured).
    """
    scene = stepped(root(radius))
    f = [first_bending(scene, order=p, layers=1, edge_layers=0) for p in (2, 3, 4, 6)]
    errors = np.array(f[:3]) / f[3] - 1
    assert np.all(errors > 0)  # from above, as an energy method does
    assert np.all(errors[:-1] > least * errors[1:])


@pytest.mark.long
def test_a_sharp_shoulder_does_not():
    f = [first_bending(stepped(), order=p, layers=0, edge_layers=0) for p in (3, 4, 5)]
    reference = first_bending(stepped(), order=5, layers=5, edge_layers=0)
    errors = np.array(f) / reference - 1
    assert np.all(errors[:-1] < 2.5 * errors[1:])


@pytest.mark.parametrize("kind", ["fillet", "chamfer"])
def test_end_for_end_gives_the_same_frequency(kind):
    """Where faces look towards y = 0 odd edge functions change their sign; with the wrong sign the
    seam from Q to M tears open and the frequency falls.
    """
    found = []
    for turned in (False, True):
        y, end = (0.208, 0.0) if turned else (0.068, 0.276)
        blends = [
            Fillet(name="f", y=y, radius=0.006)
            if kind == "fillet"
            else Chamfer(name="f", y=y, length=0.006),
            Fillet(name="g", y=end, radius=0.006),
            Fillet(name="h", y=y, edge="rim", radius=0.003),
        ]
        scene = stepped(*blends, turned=turned)
        found.append(first_bending(scene, order=5, layers=1, edge_layers=0))
    assert found[0] == pytest.approx(found[1], rel=1e-11)


@pytest.mark.long
def test_fillet_chamfer_and_cones_enclose_each_other():
    """Stiffness grows with the material in a corner: nothing, chamfer, and a fillet of twice that
    area around it; a chain of cones inside an arc is between.
    """
    options = {"order": 4, "layers": 3, "edge_layers": 0}
    sharp, cut, whole = (
        first_bending(stepped(*b), **options)
        for b in ((), (Chamfer(name="c", y=0.068, length=0.004),), (root(0.009),))
    )
    assert sharp < cut < whole
    # the same chamfer as a cone of its own: another mesh, another scene
    parts = [
        Segment.cylinder("head", length=0.068, diameter=0.134),
        Segment.cone("cone", length=0.004, start_diameter=0.098, end_diameter=0.09, y0=0.068),
        Segment.cylinder("shaft", length=0.204, diameter=0.09, y0=0.072),
    ]
    cone = Scene.from_parts(parts, port=Port(y=0.024, lo=0.014, hi=0.034))
    # 4e-5 measured: only the cone has layers right up to its two corners
    assert cut == pytest.approx(first_bending(cone, **options), rel=1e-4)


@pytest.mark.slow
def test_solids_agree_within_what_their_meshes_leave():
    """Harmonic, hexahedra and tetrahedra on one filleted shaft, first bending."""
    scene = stepped(root(0.0045))
    reference = first_bending(scene, order=7, layers=1, edge_layers=0)
    for options, tolerance in (
        ({"layers": 3, "radial_layers": 3, "around": 8, "relative_size": 0.5}, 1e-3),
        ({"element": "tet10", "refinement": 0.95}, 1e-3),
    ):
        body = sg.build(scene, "solid", **options)
        found = sg.modes(body, n=2, ovalising=False).named("bending 1").frequency_hz
        assert found == pytest.approx(reference, rel=tolerance)


def test_what_is_singular_knows_fillets():
    """A fillet leaves no corner on the meridian, a chamfer two in place of one."""

    def corners(*blends):
        scene = stepped(*blends)
        options = {"order": 3, "layers": 0, "edge_layers": 0, "families": ("torsion",)}
        body = sg.build(scene, "harmonic", **options)
        places = richer_space(coned(scene), body).corners.values()
        return sorted(
            (round(place.y, 9), round(place.r, 9), round(place.exponent, 3))
            for place in places
            if place.what.startswith(("shoulder", "concave kink"))
        )

    # at right angles and at half of them beyond a straight one (Williams 1952)
    assert corners() == [(0.068, 0.045, 0.544)]
    assert corners(root(0.004)) == []
    chamfer = Chamfer(name="c", y=0.068, length=0.004)
    assert corners(chamfer) == [(0.068, 0.049, 0.674), (0.072, 0.045, 0.674)]


@pytest.mark.parametrize(
    ("radius", "levels"), [(0.001, []), (0.003, ["fact"]), (0.01, ["caution"])]
)
def test_beams_say_what_they_leave_out(radius, levels):
    """Below r / d 0.02 a thousandth is not passed, from 0.07 on a hundredth is."""
    scene = stepped(root(radius))
    probe = Probe(scene, sg.build(scene, "timoshenko"))
    assert [notice.level for notice in fillets(probe)] == levels


REFUSED = [
    (Fillet(name="f", y=0.068, radius=0.03), "does not fit the face of 0.022 m"),
    (Fillet(name="f", y=0.068, radius=0.0215), "less than a twentieth of the face"),
    (Fillet(name="f", y=0.05, radius=0.004), "no segment begins or ends at y = 0.05 m"),
    (Fillet(name="f", y=0.0, edge="root", radius=0.004), "an end face has no root"),
    (Fillet(name="f", y=0.0, edge="rim", radius=0.02), "into the seat of"),
    (Fillet(name="f", y=0.068, surface="bore", radius=0.004), "has no step"),
    (Fillet(name="f", y=0.068, radius=1e-5), "is too small"),
    (Chamfer(name="c", y=0.276, length=0.12, angle="10 deg"), "beyond half its length"),
]


@pytest.mark.parametrize(("blend", "sentence"), REFUSED)
def test_what_does_not_fit_is_refused(blend, sentence):
    with pytest.raises(SceneError, match=sentence):
        stepped(blend)


def test_edges_are_taken_once_and_leave_a_cylinder():
    with pytest.raises(SceneError, match='has "root" already'):
        stepped(root(0.004), root(0.005).with_changes(name="again"))
    with pytest.raises(SceneError, match='beside "root"'):
        stepped(root(0.012), Fillet(name="rim", y=0.068, edge="rim", radius=0.01))
    with pytest.raises(SceneError, match="where no section is plane"):
        stepped(root(0.004)).with_port(y=0.07)


def test_a_cone_or_another_material_is_refused():
    cone = Segment.cone("cone", length=0.1, start_diameter=0.06, end_diameter=0.04)
    disc = Segment.cylinder("disc", length=0.05, diameter=0.1, y0=0.1)
    with pytest.raises(SceneError, match='"cone" is a cone there'):
        Scene.from_parts([cone, disc], blends=[Fillet(name="f", y=0.1, radius=0.003)])
    rod = Segment.cylinder("rod", length=0.1, diameter=0.04)
    light = disc.with_changes(material=sg.Material(E=70e9, nu=0.33, density=2700))
    with pytest.raises(SceneError, match="of two materials"):
        Scene.from_parts([rod, light], blends=[Fillet(name="f", y=0.1, radius=0.003)])


@pytest.mark.parametrize(
    ("entry", "sentences"),
    [
        ('kind = "fillet"\nat = "head.nose"\nradius = "4 mm"', ["feature[1]", "unknown datum"]),
        ('kind = "fillet"\nat = "head.end"\nradius = "0 mm"', ["feature[1]", "radius"]),
        ('kind = "fillet"\nat = "head.end"\nradius = "9 mm"', ["radius", "stay a cylinder"]),
        ('kind = "chamfer"\nat = "end"\nlength = "2 mm"\nangle = "95 deg"', ["angle", "5 and 85"]),
        ('kind = "fillet"\nat = "head.end"\nlength = "4 mm"', ["feature[1]", "length"]),
    ],
)
def test_bad_files_are_told_by_file_and_key(tmp_path, entry, sentences):
    with open("geometry/pinion_overhung.toml", encoding="utf-8") as file:
        text = file.read()
    path = tmp_path / "bad.toml"
    path.write_text(f"{text}\n[[feature]]\n{entry}\n", encoding="utf-8")
    with pytest.raises(SceneError) as found:
        sg.load(path)
    assert all(sentence in str(found.value) for sentence in sentences)


def test_the_shipped_scene():
    scene = sg.load("geometry/pinion_filleted.toml")
    fillet, chamfer = scene.corners
    assert (fillet.root, chamfer.root) == (True, False)
    assert fillet.on_cylinder[1] == pytest.approx(scene.steps[0] + 0.004, abs=1e-12)
    assert chamfer.on_face[0] == pytest.approx(0.042, abs=1e-12)
    assert [row["edge"] for row in scene.as_dict()["blends"]] == ["root", "rim"]


@pytest.mark.long
def test_check_tells_of_the_mesh_that_holds_a_chamfer():
    """Of tetrahedra, and not of the hexahedra whose blocks the end of a seat would fall into: that was
    no matter of memory, and the solid asked for by default is meshed without them.
    """
    scene = stepped(Chamfer(name="root", y=0.068, length=0.01, angle="30 deg")).with_changes(
        port=Port(y=0.04, lo=0.014, hi=0.066)
    )
    with pytest.raises(sg.SolidgearError, match="inside the cells of the chamfer"):
        LADDER["solid"].size(scene, {"element": "hex20"})
    counted = LADDER["solid"].size(scene, {"element": "tet10"}).unknowns
    fact = next(elements.memory(Probe(scene, sg.build(scene, "timoshenko")))).sentence
    assert f"the default 3D solid, {counted} unknowns" in fact


def test_a_face_is_full_though_its_two_segments_miss_one_another_by_a_hair():
    """The root and the rim would meet, and cells between them fold."""
    thin = Segment.cylinder("thin", length=0.1 + 4e-10, diameter=0.03)
    thick = Segment.cylinder("thick", y0=0.1, length=0.1, diameter=0.04)
    blends = [Fillet(name=e, y=0.1, edge=e, radius=0.0027) for e in ("root", "rim")]
    with pytest.raises(SceneError, match="leaves less than a twentieth of the face"):
        Scene.from_parts([thin, thick], port=Port(y=0.2, lo=0.19, hi=0.2), blends=blends)
