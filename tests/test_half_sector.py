"""Half a sector, where teeth and holes are even about a plane: against the whole sector on the same
elements and their images, pictures, further waves, and what is no half.
"""

import math

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import eigsh
from test_sector import BOLTS, SPIRAL, STEEL, TEETH, apart, shaft

import solidgear as sg
from solidgear.core.frames import rotation
from solidgear.core.ladder.registry import LADDER
from solidgear.core.models.solid.matrices import _matrices
from solidgear.cuts.features import Spline
from solidgear.cuts.features.around import mirror_angle
from solidgear.cuts.sector.body import meshed_sector, sector, whole
from solidgear.cuts.sector.half import HalfSector, basis, half_sector_solid
from solidgear.cuts.sector.meshing import mirrored

#: equal to rounding whatever the mesh
COARSE = 0.1
SPLINE = Spline(
    name="spline", segment="disc", count=5, addendum=0.5, dedendum=0.5, angle=0.2, model="sector"
)
SIX, THREE = (
    BOLTS.with_changes(name=name, count=count, diameter=0.014, angle=angle)
    for name, count, angle in (("six", 6, 0.0), ("three", 3, math.pi / 6))
)
PARTS = {
    "teeth": shaft(TEETH),
    "spline": shaft(SPLINE),
    "bolts": shaft(BOLTS.with_changes(angle=0.3)),
    # the middle plane lies between two of six holes and through one of three
    "bolts between bolts": shaft(SIX, THREE),
    "rigid seats": shaft(TEETH, bore=0.02).with_attachment("rigid"),
}


def wanted(scene):
    return [(s, s.attachment) for s in scene.stations]


MARKS = {
    "bolts between bolts": pytest.mark.slow,
    "bolts": pytest.mark.slow,
    "rigid seats": pytest.mark.slow,
}


@pytest.mark.parametrize("name", [pytest.param(n, marks=MARKS.get(n, ())) for n in PARTS])
def test_half_a_sector_is_the_whole_one(name):
    """The same elements: real matrices of half the sector against complex ones of all of it. What is
    left is rounding; a sign on the cut face would be of order one.
    """
    scene = PARTS[name]
    half, full = (sector(scene, refinement=COARSE, half=own) for own in (True, False))
    assert half.mesh["solved_part"] == "half a sector"
    assert half.mesh["elements"] == full.mesh["elements"]
    # one of each pair of twins, and two families apart: a third of the matrices' rows is gone, and
    # what is left falls into blocks of a half, a half and one of the real sector
    sizes, (still, waves) = [b.size for b in half.blocks], [b.size for b in full.blocks]
    assert sizes[0] + sizes[1] == sizes[2] == sizes[3]
    if "rigid" not in name:
        assert sizes[2] == still == waves / 2
    assert half.rigid_residual() < 1e-14
    mass = full.mass_matrix()
    assert np.abs(half.mass_matrix() - mass).max() < 1e-13 * np.abs(mass).max()
    a, b = (sg.condense(body, scene, "gear").compliance for body in (half, full))
    assert apart(a, b) < 1e-12
    f, g = (sg.modes(body, scene, n=8) for body in (half, full))
    assert [m.name for m in f.modes] == [m.name for m in g.modes]
    assert np.abs(f.frequency_hz[1:] / g.frequency_hz[1:] - 1).max() < 1e-12
    assert np.abs(f.gram - g.gram).max() < 1e-12 * np.abs(g.gram).max()


def test_motions_of_the_half_are_motions_of_the_sector():
    """Any motion in the basis, given to the mirrored half by ``V = conj(S V S)``, takes one cut face
    to the other with the phase; and energies of the sector are those of the basis.
    """
    scene = PARTS["bolts between bolts"]
    made = meshed_sector(scene, wanted(scene), scene.features, refinement=COARSE)
    mesh = half_sector_solid(made)
    n, angle = mesh.nodes.shape[1], 2 * np.pi / made.count
    mirror = np.array([-1.0, 1.0, 1.0])
    whole_mesh = mirrored(made)
    assert whole_mesh.mesh.t.shape[1] == 2 * made.mesh.t.shape[1]
    assert whole_mesh.quality.volume == pytest.approx(2 * made.quality.volume, rel=1e-14)
    k, _ = _matrices(mesh, [s.material for s in scene.segments])
    dice = np.random.default_rng(3)
    for h in (0, 1):
        t, node = basis(mesh.sector, n, h)
        assert np.abs(t.T @ t - sp.identity(t.shape[1])).max() < 1e-14
        a, b = (t @ dice.standard_normal(t.shape[1])).reshape(2, n, 3)
        here, image = a + 1j * b, (a - 1j * b) * mirror
        # the image of the cut face is the other one, and nodes of the middle are their own
        turn = np.exp(1j * h * angle) * rotation(1, angle)[:3, :3]
        cut = mesh.sector.cut
        assert np.abs(here[cut] - image[cut] @ turn.T).max() < 1e-13
        middle, axis = mesh.sector.middle, mesh.sector.axis
        assert np.abs(here[middle] - image[middle]).max() == 0.0
        assert np.abs(here[axis] - image[axis] @ turn.T).max() < 1e-13
        assert len(node) == t.shape[1]
    # rigid motions are free of energy on the half too
    assert abs(k @ np.tile([0.0, 1.0, 0.0], n)).max() < 1e-12 * abs(k).max()


@pytest.mark.long
def test_what_is_uneven_takes_the_whole_sector():
    """Spiral teeth have no plane; holes beside teeth, or beside other holes, lie in one or not."""
    several = TEETH.with_changes(count=14)
    with_teeth = BOLTS.with_changes(count=7)
    uneven = {
        "spiral": (SPIRAL,),
        "turned": (several, with_teeth.with_changes(angle=0.1)),
        "bolts": (SIX, THREE.with_changes(angle=0.5)),
    }
    for features in uneven.values():
        body = sector(shaft(*features), refinement=COARSE)
        assert body.mesh["solved_part"] == "a whole sector"
        assert [b.components for b in body.blocks] == [(1, 4), (0, 2, 3, 5)]
    even = (several, with_teeth.with_changes(angle=several.angle + math.pi / 14))
    assert mirror_angle(even, 7) == pytest.approx(math.pi / 14)
    # near misses of a plane: 1e-4 rad off
    for features in (even, (SIX, THREE)):
        holes = features[1].with_changes(angle=features[1].angle + 1e-4)
        count = 7 if features is even else 3
        assert mirror_angle(features, count) is not None
        assert mirror_angle((features[0], holes), count) is None


def test_holes_are_where_they_are_said_to_be():
    """Whichever plane is the middle, nodes of the surface lie on the holes and none lies in them."""
    for name in ("bolts", "bolts between bolts"):
        scene = PARTS[name]
        body = sector(scene, refinement=COARSE)
        surface = body.surface({})
        x, y, z = surface.points.T
        for f in scene.features:
            lo, hi = f.reach(next(s for s in scene.segments if s.name == f.segment))
            inside = (y > lo + 1e-6) & (y < hi + 1e-9)  # no floor of a blind hole
            for k in range(f.count):
                at = f.angle + 2 * np.pi * k / f.count
                away = np.hypot(x - f.circle / 2 * np.sin(at), z - f.circle / 2 * np.cos(at))
                # edges of curved elements leave the circle by 1e-3 of it, and one of the eight that
                # had to be straightened by 1 - cos 22.5 degrees
                assert away[inside].min() > 0.46 * f.diameter
                assert (np.abs(away[inside] - f.diameter / 2) < 1e-9).sum() > 8


@pytest.mark.long
def test_pictures_of_all_copies():
    """The surface of the copies of a half moves as that of the whole part, point by point, also where
    its middle looks elsewhere than along z.
    """
    from scipy.spatial import cKDTree

    scene = PARTS["bolts"]
    one, other = sector(scene, refinement=COARSE), whole(scene, wanted(scene), refinement=COARSE)
    # so firm in one plane that planes are told apart
    firm = {"kxx": 1e9, "kyy": 1e8, "kzz": 1e8, "kthx": 1e6, "kthz": 1e6}
    held = [
        b.with_changes(matrix=sg.Bearing(name="k", y=0.1, seat_width=0.01, stiffness=firm).matrix)
        for b in scene.bearings
    ]
    found = [sg.modes(body, held, n=8) for body in (one, other)]
    for name in ("bending 1", "bending 2", "torsion 1", "axial 1"):
        a, b = (body.surface(own.named(name).vectors[0]) for body, own in zip((one, other), found))
        gap, at = cKDTree(a.points).query(b.points)
        assert gap.max() < 1e-12
        u, v = a.displacement[at].ravel(), b.displacement.ravel()
        assert np.linalg.norm(v - u * (u @ v) / (u @ u)) < 1e-6 * np.linalg.norm(v)
        assert len(a.triangles) == len(b.triangles)
        # normals point outwards: the volume under the triangles is that of the part
        corner = a.points[a.triangles]
        volume = np.einsum("ij,ij->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6
        assert volume == pytest.approx(one.mesh["volume"], rel=1e-2)


@pytest.mark.slow
def test_further_waves():
    """Two and three waves around: the pairs of the whole sector, of which the half has one each."""
    scene = shaft(TEETH, bore=0.034)
    half, full = (
        sector(scene, refinement=COARSE, ovalising=(2, 3), half=own) for own in (True, False)
    )
    assert [b.name for b in half.blocks][4:] == ["ovalising_2", "ovalising_3"]
    for one, other in zip(half.blocks[4:], full.blocks[2:]):
        found, pairs = (
            np.sort(eigsh(b.stiffness, k, b.mass, sigma=half.scale, return_eigenvectors=False))
            for b, k in ((one, 2), (other, 4))
        )
        assert np.repeat(found, 2) == pytest.approx(pairs, rel=1e-11)
    f = sg.modes(half, scene, n=14)
    assert f.named("ovalising n=2 1").multiplicity == 2
    surface = half.surface(f.named("ovalising n=2 1").vectors[0])
    assert np.isfinite(surface.displacement).all() and np.abs(surface.displacement).max() > 0


def test_the_mean_of_the_material():
    """A port that follows the material of its span, by half and by the whole sector."""
    scene = PARTS["teeth"]
    a, b = (
        sg.condense(sector(scene, refinement=COARSE, material_port=True, half=own), scene, "gear")
        for own in (True, False)
    )
    assert apart(a.compliance, b.compliance) < 1e-12


def test_a_node_on_the_axis_of_a_half():
    """It moves along the axis, and with one wave as a translation along z is seen in turned axes."""
    none = np.zeros(0, int)
    alone = HalfSector(7, none, none, np.array([0]))
    assert [basis(alone, 1, h)[0].shape[1] for h in (0, 1, 2, 3)] == [1, 1, 0, 0]
    a, b = basis(alone, 1, 1)[0].toarray().reshape(2, 3) * np.sqrt(2)
    for k in range(7):
        turn, angle = rotation(1, 2 * np.pi * k / 7)[:3, :3], 2 * np.pi * k / 7
        assert turn @ (np.cos(angle) * a - np.sin(angle) * b) == pytest.approx([0, 0, 1], abs=1e-15)


@pytest.mark.long
def test_half_the_memory():
    """Of the matrices and of the factors of a half, a half that a part which has none does not know."""
    scene = PARTS["bolts"]
    half, full = (LADDER["sector"].size(scene, {"half": own}) for own in (True, False))
    assert half.unknowns == full.unknowns
    # two matrices of a half and one of the real sector for one of it and one of all pairs: 0.4 of the
    # entries, and more on the faces that they share
    assert half.entries < 0.5 * full.entries
    assert half.factors_mb < 0.65 * full.factors_mb
    uneven = shaft(SPIRAL)
    same = [LADDER["sector"].size(uneven, {"half": own}) for own in (True, False)]
    assert same[0] == same[1]


@pytest.mark.long
def test_thin_wedges_are_straightened_until_none_folds():
    """Sixty teeth: elements that fill a wedge of three degrees fold where edges are curved, and
    straight ones fold their neighbours in turn.
    """
    body = sg.build(shaft(TEETH.with_changes(count=60, dedendum=1.2)), "sector", refinement=1.0)
    assert body.mesh["min_jacobian_ratio"] > 0.05


def test_one_material_each():
    """Segments of a half keep their own materials: mass by the closed form of a cone of teeth."""
    scene = shaft(TEETH)
    heavy = sg.Material(E=STEEL.E, nu=STEEL.nu, density=2 * STEEL.density)
    double = scene.with_changes(
        segments=tuple(s.with_changes(material=heavy) for s in scene.segments)
    )
    a, b = (sector(s, refinement=COARSE).mass_matrix() for s in (scene, double))
    assert b == pytest.approx(2 * a, rel=1e-12)
