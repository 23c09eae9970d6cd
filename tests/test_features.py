"""Keyways, flats and cross holes: volume, mass and symmetry against closed forms, halves against the
whole, and the scenes that are refused.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from skfem import MeshTet1, MeshTet2

import solidgear as sg
from solidgear.core.judge.record import ModelRecord, ModeRecord
from solidgear.core.meshing.quality import MeshError, check_mesh
from solidgear.core.models.solid.mesh import _isoparametric
from solidgear.core.models.solid.plan import tetrahedra_plan
from solidgear.core.models.solid.seat_faces import Seats
from solidgear.cuts.features import CrossHole, Flat, Keyway
from solidgear.cuts.solid.cuts import mirror_plane
from solidgear.cuts.solid.featured import featured_body, meshed
from solidgear.cuts.solid.halves import half_blocks
from solidgear.cuts.solid.meshing import FeaturedMesh, submesh
from validation.campaign.truths.volumes import removed_mass

ROOT = Path(__file__).parent.parent
KEYED = ROOT / "geometry" / "pinion_keyed.toml"
STEEL = sg.Material(E=2.07e11, nu=0.3, density=7850.0)


def shaft(*features, bore=0.0):
    rod = sg.Segment.cylinder("rod", length=0.2, diameter=0.06, bore=bore, material=STEEL)
    return sg.Scene.from_parts(
        [rod],
        STEEL,
        [
            sg.Bearing(
                name=name, y=y, seat_width=0.03, stiffness={"kxx": 1e9, "kyy": 1e8, "kzz": 1e9}
            )
            for name, y in (("a", 0.02), ("b", 0.18))
        ],
        sg.Port(name="gear", y=0.1, lo=0.04, hi=0.055),
        features=features,
    )


KEY = Keyway(name="key", segment="rod", y=0.07, length=0.06, width=0.018, depth=0.007)
FLAT = Flat(name="flat", segment="rod", y=0.08, length=0.04, depth=0.006)
HOLE = CrossHole(name="oil", segment="rod", y=0.1, diameter=0.012)
OBLIQUE = HOLE.with_changes(inclination="30 deg")
SKEW = OBLIQUE.with_changes(inclination="-45 deg", offset="5 mm", angle="40 deg")


def mesh_of(scene, refinement=0.6, around=16, seats=True):
    """Stations that its mesh ends at, and the mesh."""
    wanted = [(s, s.attachment) for s in scene.stations] if seats else []
    sizes = {"size": None, "graded_size": None, "refinement": refinement, "around": around}
    return wanted, meshed(scene, tetrahedra_plan(scene, wanted, **sizes), refinement, True)


@pytest.mark.parametrize(
    "feature",
    [
        KEY,
        FLAT,
        *(
            pytest.param(f, marks=pytest.mark.long)
            for f in (KEY.with_changes(ends="square"), OBLIQUE)
        ),
    ],
    ids=str,
)
def test_volume_against_closed_form(feature):
    """OCC's own volume to 1e-5, the mesh to what its curved elements leave of an arc."""
    scene = shaft(feature)
    wanted, made = mesh_of(scene)
    exact = feature.volume(0.03, 0.0)
    assert made.removed == pytest.approx(exact, rel=1e-5)
    body = featured_body(scene, wanted, made, 0.6)
    whole = math.pi * 0.03**2 * 0.2
    # ten elements around lose (pi/10)^4/30 of the volume at most
    assert body.mesh["volume"] == pytest.approx(whole - exact, rel=3e-4)
    # nothing is lost or doubled between the two blocks of the halves
    mass = body.mass_matrix()
    for c in range(3):
        assert mass[c, c] == pytest.approx(7850 * body.mesh["volume"], rel=1e-12)
    assert body.rigid_residual() < 1e-14


def mirrored_whole(made: FeaturedMesh) -> FeaturedMesh:
    """The whole part made of the elements of its half and their images, joined on the plane."""
    mesh, axis = made.mesh, made.plane
    flip = np.ones((3, 1))
    flip[axis] = -1
    n = mesh.p.shape[1]
    on = np.abs(mesh.p[axis]) < 1e-10
    number = np.where(on, np.arange(n), n + np.cumsum(~on) - 1)
    points = np.hstack([mesh.p, (mesh.p * flip)[:, ~on]])
    image = number[mesh.t][[1, 0, 2, 3]]  # right-handed again
    joined = MeshTet2.from_mesh(
        MeshTet1(
            np.ascontiguousarray(points),
            np.ascontiguousarray(np.hstack([mesh.t, image]).astype(np.int32)),
        )
    )
    middles = mesh.doflocs[:, mesh.dofs.edge_dofs[0]]
    total = points.shape[1]
    known = {}
    for ends, places in ((mesh.edges, middles), (number[mesh.edges], middles * flip)):
        for key, place in zip(np.sort(ends, axis=0).T @ [total, 1], places.T):
            known[key] = place
    doflocs = joined.doflocs.copy()
    keys = np.sort(joined.edges.astype(np.int64), axis=0).T @ [total, 1]
    doflocs[:, joined.dofs.edge_dofs[0]] = np.array([known[key] for key in keys]).T
    both = replace(joined, doflocs=doflocs)
    return FeaturedMesh(
        both, np.tile(made.segment, 2), np.tile(made.cut, 2), None, made.quality, made.removed
    )


@pytest.mark.parametrize("angle", [pytest.param(0.0, marks=pytest.mark.slow), math.pi / 2])
def test_two_halves_equal_the_whole(angle):
    """The same elements mirrored and joined: compliance and frequencies to rounding."""
    scene = shaft(KEY.with_changes(angle=angle))
    wanted, made = mesh_of(scene, 0.2)
    halves = featured_body(scene, wanted, made, 0.2)
    whole = featured_body(scene, wanted, mirrored_whole(made), 0.2)
    assert [b.components for b in halves.blocks] == (
        [(1, 2, 3), (0, 4, 5)] if angle == 0 else [(0, 1, 5), (2, 3, 4)]
    )
    a, b = (sg.condense(body, scene, "gear") for body in (halves, whole))
    on = np.isfinite(a.compliance)
    scale = np.sqrt(np.outer(*[np.nan_to_num(np.diag(b.compliance))] * 2)) + 1e-30
    difference = np.abs(np.nan_to_num(a.compliance) - np.nan_to_num(b.compliance)) / scale
    assert difference[on].max() < 1e-12
    one, other = (sg.modes(body, scene, n=8) for body in (halves, whole))
    f, g = (np.repeat(m.frequency_hz, m.multiplicity)[1:9] for m in (one, other))
    assert np.abs(f / g - 1).max() < 1e-11
    # whichever way the key looks, and whether or not a mirror plane names bending by its planes
    assert {"bending z 1", "bending x 1"} < set(one.names) and "bending z 1" not in other.names
    told = ModelRecord(
        modes=[ModeRecord(name=m.name, frequency_hz=m.frequency_hz) for m in one.modes]
    )
    for name in ("bending 1", "bending 2", "bending 3"):
        hertz = one.named(name).frequency_hz
        assert hertz == pytest.approx(other.named(name).frequency_hz, rel=1e-11)
        assert told.mode(name).frequency_hz == hertz  # on pages as well
    assert max(one.multiplicity) == max(other.multiplicity) == 1  # a split pair stays split


@pytest.mark.slow
def test_the_plane_of_the_key_is_the_softer_one():
    scene = shaft(KEY)
    body = sg.build(scene, "solid", refinement=0.6)
    found = sg.modes(body, scene, n=6)
    compliance = sg.condense(body, scene, "gear").compliance
    assert compliance[2, 2] > 1.001 * compliance[0, 0]
    assert found.named("bending 1") is found.named("bending z 1")
    assert found.named("bending z 1").family == "bending"
    turned = shaft(KEY.with_changes(angle=math.pi / 2))
    other = sg.condense(sg.build(turned, "solid", refinement=0.6), turned, "gear").compliance
    # a quarter turn of the part takes x to z; meshes of the two differ, by less than 5 % of the
    # effect
    assert other[0, 0] == pytest.approx(compliance[2, 2], rel=1e-3)


@pytest.mark.long
def test_no_plane_no_halves():
    crossed = shaft(KEY, Keyway(**KEY.model_dump() | {"name": "k2", "angle": "50 deg", "y": 0.075}))
    body = sg.build(crossed, "solid", refinement=0.25)
    assert len(body.blocks) == 1 and body.mesh["mirror_plane"] == "none"
    assert body.rigid_residual() < 1e-14
    assert max(sg.modes(body, crossed, n=6).multiplicity) == 1


@pytest.mark.long
def test_a_cross_hole_and_a_bore():
    hole = CrossHole(name="oil", segment="rod", y=0.1, diameter=0.008)
    scene = shaft(hole, bore=0.02)
    wanted, made = mesh_of(scene, 0.35)
    assert made.removed == pytest.approx(hole.volume(0.03, 0.01), rel=1e-5)
    assert made.plane == 0
    body = sg.build(scene, "solid", refinement=0.35)
    assert body.mesh["volume"] < math.pi * (0.03**2 - 0.01**2) * 0.2


@pytest.mark.long
def test_a_hole_beside_the_axis_takes_its_mass_where_it_is():
    """All moments of what an oblique hole beside the axis takes, through a bore, against points that
    know nothing of meshes: some 1e-3 of it, and elements of eight to a circle 4e-3.
    """
    scene = shaft(SKEW, bore=0.02)
    wanted, made = mesh_of(scene, 0.35)
    assert made.plane is None
    whole, cut = (featured_body(scene, wanted, made, 0.35, plain=p) for p in (True, False))
    gone, counted = whole.mass_matrix() - cut.mass_matrix(), removed_mass(scene)
    assert counted[0, 0] == pytest.approx(7850 * SKEW.volume(0.03, 0.01), rel=4e-3)
    # about where the hole passes the axis, so that turns tell how it lies and not where
    shift = np.eye(6)
    shift[2, 3], shift[0, 5] = -SKEW.y, SKEW.y
    gone, counted = (shift.T @ m @ shift for m in (gone, counted))
    size = np.sqrt(np.diag(counted))
    assert np.abs((gone - counted) / np.outer(size, size)).max() < 1e-2
    assert counted[4, 5] > 0.5 * size[4] * size[5]


@pytest.mark.slow
def test_a_hole_that_leans_the_other_way_couples_the_other_way():
    """Half a turn of the shaft takes one to the other: compliances stay, and axial motion under a
    force across changes its sign. Meshes differ, by 2e-3; the hole makes C_zz 12 % softer.
    """
    found = []
    for lean in (0.8, -0.8):
        scene = shaft(HOLE.with_changes(diameter=0.016, inclination=lean))
        body = sg.build(scene, "solid", refinement=0.25)
        compliance = sg.condense(body, scene, "gear").compliance
        size = np.sqrt(np.nan_to_num(np.diag(compliance)))
        found.append((size, compliance[1, 2] / size[1] / size[2]))
    (one, ahead), (other, back) = found
    assert one == pytest.approx(other, rel=4e-3)
    assert ahead > 1e-3 and back == pytest.approx(-ahead, abs=2e-4)


def test_mirror_planes_of_holes():
    """Straight ones have two, oblique ones that along them, ones beside the axis that across."""
    beside = HOLE.with_changes(offset="5 mm")
    for turn, own, other in ((0.0, 0, 2), (math.pi / 2, 2, 0)):
        turned = [f.with_changes(angle=turn) for f in (OBLIQUE, beside, SKEW, KEY)]
        assert [mirror_plane((f,)) for f in turned] == [own, other, None, own]
        assert mirror_plane((turned[3], HOLE)) == own
        assert mirror_plane((turned[3], turned[1])) is None


@pytest.mark.parametrize(
    "changes, says",
    [
        ({"y": 0.04, "inclination": "55 deg"}, "reaches from -0.0133"),
        ({"inclination": "61 deg"}, "between -60 and 60"),
        ({"offset": "24 mm"}, "out of the side .* may be 0.0237 m"),
        ({"offset": "-16.1 mm"}, "grazes the bore"),
        ({"y": 0.0386, "inclination": "45 deg"}, "from an end .* leave 0.0003 m"),
        ({"inclination": 30}, "between"),
    ],
    ids=str,
)
def test_a_bad_hole_is_one_sentence(changes, says):
    with pytest.raises(sg.SceneError, match=says):
        shaft(HOLE.with_changes(**changes), bore=0.02)


def test_seats_do_not_take_floors_of_keyways_for_their_own():
    """Area of a seat that the keyway crosses: the cylinder less the opening of the slot."""
    key = KEY.with_changes(y=0.02, length=0.05, ends="square")
    scene = shaft(key)
    wanted, made = mesh_of(scene)

    solid = _isoparametric(submesh(made.mesh, ~made.cut), "tet10", made.segment[~made.cut])
    seats = Seats(solid, scene.segments, clipped=False)
    facets = seats(scene.bearings[0], "average")
    area = 2 * sum(a.sum() for _, _, a, _ in solid.over_facets(facets))
    opening = 2 * math.asin(0.009 / 0.03) * 0.03 * (0.035 - 0.02)
    assert area == pytest.approx(2 * math.pi * 0.03 * 0.03 - opening, rel=1e-4)
    assert half_blocks(solid, scene, wanted, seats, 0)


@pytest.mark.parametrize("cut", [False, True])
def test_seats_keep_straightened_faces_beside_a_flat(cut):
    """Wedges at the rim of a flat fold on coarse meshes and have their edges straightened: 11 % of the
    area of this seat. With the flat left in all of it is there; with it cut out, the rest.
    """
    head = sg.Segment.cylinder("head", length=0.06069, diameter=0.06755, bore=0.01613)
    stub = sg.Segment.cylinder("stub", length=0.04736, diameter=0.05038, bore=0.01613, y0=0.06069)
    flat = Flat(name="f", segment="head", y=0.0103, length=0.04009, depth=0.008274)
    port = sg.Port(y=0.03, lo=0.0, hi=0.06069)
    bearings = [sg.Bearing(name="A", y=0.0948, seat_width=0.012, hold="clamped")]
    scene = sg.Scene.from_parts([head, stub], port=port, bearings=bearings, features=(flat,))
    _, made = mesh_of(scene, 0.35, around=12)
    keep = ~made.cut | (not cut)
    solid = _isoparametric(submesh(made.mesh, keep), "tet10", made.segment[keep])
    facets = Seats(solid, scene.segments, clipped=False)(port, "average")
    area = sum(a.sum() for _, _, a, _ in solid.over_facets(facets)) * (1 + (made.plane is not None))
    r = 0.06755 / 2
    gone = 2 * math.acos(1 - flat.depth / r) * r * flat.length * cut
    assert area == pytest.approx(2 * math.pi * r * port.hi - gone, rel=6e-3)


@pytest.mark.parametrize("rung", ["euler", "timoshenko", "harmonic"])
def test_models_of_revolution_refuse_it_in_one_sentence(rung):
    with pytest.raises(sg.SolidgearError, match='of revolution and the scene has keyway "key"'):
        sg.build(shaft(KEY), rung)
    assert sg.build(shaft(KEY).plain, rung).size > 0


BAD = {
    'depth = "9 mm"': ('depth = "46 mm"', "cuts through the radius"),
    'length = "100 mm"': ('length = "160 mm"', "reaches from"),
    'width = "25 mm"': ('width = "110 mm"', "wider than the radius"),
    'ends = "round"': ('ends = "oval"', "ends"),
    'angle = "0 deg"\n': ("angle = 90\n", 'write "90 deg"'),
    'segment = "shaft"': ('segment = "shift"', "unknown segment"),
    'kind = "keyway"': ('kind = "slot"', "kind"),
    'angle = "0 deg"': ('angle = "12 mm"', "not a unit of angle"),
    'segment = "shaft"\n': ('segment = "head"\n', "is a cone"),
    'length = "100 mm"\n': ('length = "20 mm"\n', "longer than it is wide"),
    'depth = "9 mm"\n': ('depth = "1 mm"\n', "below its floor"),
    'name = "key"': ('name = "k.ey"', "name"),
}


@pytest.mark.parametrize("old", BAD)
def test_a_bad_feature_is_one_sentence(old, refused):
    text = KEYED.read_text()
    new, says = BAD[old]
    refused(text, old, new, says)


KEY_TABLE = """
[[feature]]
kind = "keyway"
name = "key"
segment = "right"
position = "40 mm"
length = "30 mm"
width = "10 mm"
depth = "5 mm"
"""


def test_bearings_of_catalogue_data_settle_on_the_plain_part(tmp_path):
    """A keyway does not keep a scene from being read; its bearings are those of the plain shaft."""
    file = tmp_path / "keyed.toml"
    plain = ROOT / "geometry" / "gearbox_catalogue.toml"
    file.write_text(plain.read_text(encoding="utf-8") + KEY_TABLE, encoding="utf-8")
    keyed, bare = sg.load(file), sg.load(plain)
    assert [f.name for f in keyed.features] == ["key"]
    for a, b in zip(keyed.bearings, bare.bearings):
        assert np.array_equal(a.stiffness, b.stiffness)


@pytest.mark.long
def test_a_sweep_over_a_shaft_with_features_ends_well(tmp_path, run):
    """Rows are written, cautions are those of the plain part, and the exit code is that of success."""
    file = tmp_path / "keyed.toml"
    text = (ROOT / "geometry" / "pinion_keyed.toml").read_text(encoding="utf-8")
    file.write_text(text, encoding="utf-8")
    rows = tmp_path / "rows.csv"
    coarse = ("--set", "size=0.04", "--set", "graded_size=0.04", "--set", "refinement=0.5")
    vary = ("--vary", "bearing.1.scale=1,2", "-o", str(rows))
    code, _, err = run("-q", "sweep", file, "-f", "solid", *coarse, *vary)
    assert code == 0, err
    assert len(rows.read_text().splitlines()) == 3


def test_ends_of_a_keyway_are_round_on_coarse_meshes_too():
    """A deep key with wide ends at the coarsest refinement: eight curved edges to a circle lose 3e-3
    of it; with two to an end, which the depth alone would ask for, 2e-2 went in silence.
    """
    key = Keyway(name="k", segment="rod", y=0.1, length=0.044, width=0.021, depth=0.0158)
    rod = sg.Segment.cylinder("rod", length=0.3, diameter=0.095)
    scene = sg.Scene.from_parts([rod], features=(key,))
    _, made = mesh_of(scene, 0.25, around=12, seats=False)
    cut = 2 * check_mesh(submesh(made.mesh, made.cut)).volume
    assert cut == pytest.approx(key.volume(0.0475, 0.0), rel=4e-3)


@pytest.mark.parametrize("refinement", [0.25, 0.5])
def test_a_wide_hole_is_meshed_at_every_refinement(refinement):
    """Elements of eight to a circle fold beside it, and straightened they lack 1 to 2 % of the hole; a
    little finer ones have all of it to what straightening leaves.
    """
    rod = sg.Segment.cylinder("rod", length=0.2, diameter=0.06)
    hole = CrossHole(name="h", segment="rod", y=0.1, diameter=0.02)
    scene = sg.Scene.from_parts([rod], features=(hole,))
    _, made = mesh_of(scene, refinement, around=12, seats=False)
    cut = 2 * check_mesh(submesh(made.mesh, made.cut)).volume
    assert cut == pytest.approx(made.removed, rel=3e-3)


def test_a_cut_of_another_volume_is_refused(monkeypatch):
    """Elements that are left out of the cut, a tenth of them, are told in a sentence."""
    from solidgear.cuts.solid import meshing as featured

    def loses_some(mesh, keep):
        keep = keep.copy()
        keep[np.flatnonzero(keep)[::10]] = False
        return submesh(mesh, keep)

    scene = shaft(KEY)
    mesh_of(scene, 0.4, around=12, seats=False)
    monkeypatch.setattr(featured, "submesh", loses_some)
    with pytest.raises(
        MeshError, match=r'elements of "key" miss [\d.]+ % of .* more than 1%: raise'
    ):
        mesh_of(scene, 0.4, around=12, seats=False)


def test_elements_keep_their_middle_nodes_in_large_meshes():
    """Numbers of two vertices make one key of an edge: from 46,341 vertices on it does not fit 32 bits.
    Here two elements have the last of 70,000 numbers, and every middle node is where no other is.
    """
    many = 70_000
    points = np.zeros((3, many))
    points[:, -5:] = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]).T
    cells = (many - 5 + np.array([[0, 1, 2, 3], [1, 2, 3, 4]]).T).astype(np.int32)
    mesh = MeshTet2.from_mesh(MeshTet1(points, cells))
    middles = mesh.dofs.edge_dofs[0]
    nodes = mesh.doflocs.copy()
    nodes[:, middles] += 0.01 * np.arange(middles.size)
    mesh = replace(mesh, doflocs=nodes)
    part = submesh(mesh, np.array([False, True]))
    ends = part.p[:, part.edges]
    own = part.doflocs[:, part.dofs.edge_dofs[0]]
    for k in range(part.edges.shape[1]):
        same = [
            i
            for i in range(mesh.edges.shape[1])
            if {tuple(p) for p in mesh.p[:, mesh.edges[:, i]].T}
            == {tuple(p) for p in ends[:, :, k].T}
        ]
        assert (own[:, k] == mesh.doflocs[:, middles[same[0]]]).all()
