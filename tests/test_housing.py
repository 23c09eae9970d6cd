"""What bearings stand in: a common housing and one at a seat, against a dense assembly that shares
no code, in its limits, under catalogue bearings and in a sweep.
"""

from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.bearings.balance import Linear, Mounted
from solidgear.bearings.equilibrium import equilibrium
from solidgear.bearings.solved import solved
from solidgear.core.body import as_supports
from solidgear.core.scene import Bearing, Elastic, Housing
from solidgear.core.springs import in_series
from solidgear.variants.sweep.bearing_task import bearing_task
from solidgear.variants.sweep.bearing_variants import bearing_variants
from solidgear.variants.sweep.file_task import run
from tests.command import table
from tests.dense import relative, rigid_at, whole

GEOMETRY = Path(__file__).parent.parent / "geometry"
PATH = GEOMETRY / "intermediate_shaft.toml"
COARSE = {"harmonic": {"order": 2, "layers": 0}}
DOFS = ("x", "y", "z", "thx", "thy", "thz")
FULL = {
    "kxx": 1.5e9,
    "kyy": 5e8,
    "kzz": 8e8,
    "kthx": 1e7,
    "kthy": 2e6,
    "kthz": 3e7,
    "kxz": 1e8,
    "kz_thx": 1e7,
    "kx_thz": -2e7,
    "ky_thx": 3e6,
}


@pytest.fixture(scope="module")
def shaft():
    return sg.load(PATH)


def gives(entries):
    names = [f"k{d}{d}" if k < 3 else f"k{d}" for k, d in enumerate(DOFS)]
    return [k for k, name in enumerate(names) if name in entries]


def dense(body, scene, ports):
    """Whole beam or solid with rings and housing as unknowns of their own, everything dense;
    turning about the axis left out. Returns K, M and the rows of some ports.
    """
    k, m, g = whole(body, without=("torsion",))
    n = len(k)
    names = [p.name for p in body.ports]
    around = gives(scene.housing.entries) if scene.housing else []
    rings = [gives(b.housing.entries) if b.housing else [] for b in scene.bearings]
    total = n + len(around) + sum(map(len, rings))
    big = np.zeros((total, total))
    big[:n, :n] = k
    if around:
        own = np.array(scene.housing.matrix)[np.ix_(around, around)]
        big[n : n + len(around), n : n + len(around)] += own
    at = n + len(around)
    for bearing, ring in zip(scene.bearings, rings):
        stretch = np.zeros((6, total))
        p = names.index(bearing.name)
        stretch[:, :n] = g[6 * p : 6 * p + 6]
        if around:
            stretch[:, n : n + len(around)] = -rigid_at(bearing.y - scene.housing.y)[:, around]
        for c in ring:
            stretch[c, at] -= 1.0
            at += 1
        if ring:
            own = np.array(bearing.housing.matrix)[np.ix_(ring, ring)]
            big[at - len(ring) : at, at - len(ring) : at] += own
        five = np.delete(np.arange(6), 4)
        matrix = np.array(bearing.matrix)[np.ix_(five, five)]
        big += stretch[five].T @ matrix @ stretch[five]
    mass = np.zeros_like(big)
    mass[:n, :n] = m
    rows = np.zeros((6 * len(ports), total))
    for i, name in enumerate(ports):
        p = names.index(name)
        rows[6 * i : 6 * i + 6, :n] = g[6 * p : 6 * p + 6]
    keep = np.abs(big).sum(axis=1) > 0  # a housing's turning that nothing resists
    return big[np.ix_(keep, keep)], mass[np.ix_(keep, keep)], rows[:, keep]


HOUSINGS = {
    "as shipped": None,
    "all couplings": Housing(stiffness=FULL, y=0.08),
    "free to shift along x": Housing(stiffness={"kxx": 0.0, "kthx": 1e6}, y=0.2),
}


@pytest.mark.parametrize("kind", list(HOUSINGS))
@pytest.mark.parametrize("model", ["timoshenko", "harmonic"])
def test_against_a_dense_assembly(model, kind, shaft):
    scene = shaft if HOUSINGS[kind] is None else shaft.with_changes(housing=HOUSINGS[kind])
    scene = scene.with_material(E="100 GPa")  # what it is made of shows
    body = sg.build(scene, model, **COARSE.get(model, {}))
    ports = ("wheel", "pinion")
    found = sg.condense(body, scene, port=ports)
    k, m, rows = dense(body, scene, ports)
    on = np.flatnonzero(~np.isnan(found.compliance).all(axis=1))
    expected = 10 if kind != "free to shift along x" else 8
    assert len(on) == expected
    if expected == 10:
        c = rows[on] @ np.linalg.solve(k, rows[on].T)
        # the dense matrix has a condition of 1e8 to 1e10
        assert relative(found.compliance[np.ix_(on, on)], c) < 1e-7
    else:  # one free motion: the rest by a spring that no load in it stretches
        u = np.linalg.pinv(k, rcond=1e-13, hermitian=True)
        c = rows[on] @ u @ rows[on].T
        assert found.free_names == ("x", "thy")
        bending = [i for i, c6 in enumerate(on % 6) if c6 in (2, 3)]
        own = found.compliance[np.ix_(on[bending], on[bending])]
        assert relative(own, c[np.ix_(bending, bending)]) < 1e-6
    # massless unknowns have no frequency of their own: the highest of the pencil in 1/f^2
    least = sla.eigh(m, k + 1e-3 * m * body.scale, eigvals_only=True)[::-1][:6]
    hz = np.sqrt(1 / least - 1e-3 * body.scale) / (2 * np.pi)
    elastic = sg.modes(body, scene, n=12)
    ours = np.array(
        [
            f
            for f, name in zip(elastic.frequency_hz, elastic.names)
            if f > 0 and "torsion" not in name
        ]
    )
    mine = np.array([f for f in hz if f > 1.0])
    assert ours[:4] == pytest.approx(mine[:4], rel=1e-6)


# --------------------------------------------------------------------------- limits
def test_without_one_and_with_a_rigid_one(shaft):
    body = sg.build(shaft, "timoshenko")
    none = shaft.with_changes(housing=None)
    hard = Housing(stiffness={name: 1e24 for name in ("kxx", "kyy", "kzz", "kthx", "kthy", "kthz")})
    k0 = sg.condense(body, none, "wheel").stiffness
    assert (
        relative(sg.condense(body, none.with_changes(housing=hard), "wheel").stiffness, k0) < 1e-12
    )
    rigid = Housing(stiffness=np.zeros((6, 6)), rigid=DOFS)
    same = sg.condense(body, none.with_changes(housing=rigid), "wheel").stiffness
    assert (same == k0).all()  # nothing gives: nothing is computed


def test_a_spring_along_the_axis_is_the_entry_kyy():
    scene = sg.load(GEOMETRY / "pinion_straddle.toml")
    other = scene.with_changes(
        housing_axial=None, housing=Housing(stiffness={"kyy": scene.housing_axial}, y=0.3)
    )
    a, b = (as_supports(s).stiffness for s in (scene, other))
    # two formulas for one elimination: rounding, however far the point is
    assert relative(b, a) < 1e-12


def test_what_is_not_held_is_free(shaft):
    body = sg.build(shaft, "timoshenko")
    loose = shaft.with_changes(housing=Housing(stiffness={"kzz": 0.0}, y=0.1))
    found = sg.condense(body, loose, "wheel")
    assert found.free_names == ("z", "thy") and not found.stiffness[2].any()
    # the bearings still hold each other apart: it cannot tilt about x without stretching them
    assert found.stiffness[3, 3] > 1e6
    assert (sg.modes(body, loose, n=3).frequency_hz == 0.0).sum() == 2
    stiffness = [
        sg.condense(body, shaft.with_changes(housing=Housing(stiffness={"kzz": h}, y=0.1)), "wheel")
        for h in (1e3, 1e5)
    ]
    for h, at in zip((1e3, 1e5), stiffness):  # it carries the force of the shaft as a whole
        assert 1 / at.compliance[2, 2] == pytest.approx(h, rel=1e-3)
    with pytest.raises(sg.SolidgearError, match="too much softer than the bearings in it"):
        sg.condense(body, shaft.with_changes(housing=Housing(stiffness={"kzz": 1e-4})), "wheel")


def test_two_walls_of_their_own_are_one_housing_where_only_one_bearing_holds():
    """A single bearing in a housing about its own place, and in a wall at its seat."""
    scene = sg.load(GEOMETRY / "intermediate_shaft.toml").with_changes(housing=None)
    full = np.diag([4e8, 1e8, 4e8, 1e5, 0.0, 1e5])
    one = scene.bearings[0].with_changes(matrix=full)
    wall = Elastic(stiffness=FULL)
    a = scene.with_changes(bearings=(one.with_changes(housing=wall),))
    b = scene.with_changes(bearings=(one,), housing=Housing(stiffness=FULL, y=one.y))
    assert relative(as_supports(b).stiffness, as_supports(a).stiffness) < 1e-13
    soft = Elastic(stiffness={"kzz": 3e8})
    held = Bearing(name="A", y=0.02, seat_width=0.02, hold="clamped", housing=soft)
    assert held.stiffness[2, 2] == pytest.approx(3e8, rel=1e-9)  # nothing but the wall gives
    assert held.stiffness[0, 0] == pytest.approx(1e22, rel=1e-12)


def test_series_by_compliances():
    rng = np.random.default_rng(1)
    a, b = (m @ m.T for m in rng.standard_normal((2, 6, 6)))
    expected = np.linalg.inv(np.linalg.inv(a) + np.linalg.inv(b))
    # of matrices that can be inverted the sum of compliances; theirs have conditions of 1e3
    assert relative(in_series(a, np.eye(6), b), expected) < 1e-11
    out = in_series(a, np.eye(6), np.zeros((6, 6)))
    assert not out.any()


# --------------------------------------------------------------------------- under load, and varied
@pytest.mark.parametrize("kind", ["as shipped", "all couplings"])
def test_equilibrium_of_linear_bearings_is_condensation(kind, shaft):
    scene = shaft if HOUSINGS[kind] is None else shaft.with_changes(housing=HOUSINGS[kind])
    body = sg.build(scene, "timoshenko")
    bare = [b.with_changes(housing=None) for b in scene.bearings]
    mounts = [
        Mounted(b.name, Linear(np.array(b.stiffness)), housing=own.housing)
        for b, own in zip(bare, scene.bearings)
    ]
    load = np.array([1200.0, 800.0, -500.0, 30.0, 0.0, -20.0])
    found = equilibrium(body, mounts, {"wheel": load}, housing=scene.housing)
    at = sg.condense(body, scene, "wheel")
    on = [0, 1, 2, 3, 5]
    expected = at.compliance[np.ix_(on, on)] @ load[on]
    # forces are balanced to 1e-8; the torque about y that a full housing couples is the drive's
    assert found.motion["wheel"][on] == pytest.approx(expected, rel=1e-7)
    carried = sum(found.load[b.name] for b in scene.bearings)
    assert carried[:3] == pytest.approx(load[:3], rel=1e-7)


def test_catalogue_bearings_settle_in_their_housing():
    scene = sg.load(GEOMETRY / "gearbox_catalogue.toml")
    around = Housing(stiffness={"kzz": 2e7, "kthx": 2e5}, y=0.05)
    soft = scene.with_changes(housing=around)
    body = sg.build(scene, "timoshenko")
    hard, found = solved(scene, body), solved(soft, body)
    one, two = hard.equilibrium, found.equilibrium
    port = scene.port.name
    assert abs(two.motion[port][2]) > 1.5 * abs(one.motion[port][2])
    # the rings carry all of the load, and each its own with what the tilting box leaves it
    push = np.array(scene.load.six)
    assert sum(two.load.values())[2] == pytest.approx(push[2], rel=1e-6)
    force = sum(two.load.values())
    moment = sum(v[3] + (b.y - around.y) * v[2] for b, v in zip(scene.bearings, two.load.values()))
    h = [force[2] / 2e7, moment / 2e5]
    for bearing in scene.bearings:
        out = two.motion[bearing.name] - two.relative[bearing.name]
        assert out[2] == pytest.approx(h[0] + (bearing.y - around.y) * h[1], rel=1e-6)
        assert (
            out[3] == pytest.approx(h[1], rel=1e-6) and abs(out[0]) < 1e-15
        )  # m; rounding of 1e-5


def test_a_sweep_over_the_housing(shaft, tmp_path):
    out = tmp_path / "rows.csv"
    texts = ["housing.kzz=4e8,1e9", "bearing.B.kzz=3e8,5e8"]
    run(bearing_task(bearing_variants(PATH, texts), model="timoshenko", n=2), out)
    rows = table(out)
    body = sg.build(shaft, "timoshenko")
    assert len(rows) == 4
    for row in rows:
        entries = shaft.housing.entries | {"kzz": float(row["housing.stiffness.kzz"])}
        matrix = np.array(shaft.bearings[1].matrix)
        matrix[2, 2] = float(row["bearing.B.stiffness.kzz"])
        bearings = (shaft.bearings[0], shaft.bearings[1].with_changes(matrix=matrix))
        there = shaft.with_changes(
            bearings=bearings, housing=Housing(stiffness=entries, y=shaft.housing.y)
        )
        c = sg.condense(body, there, "wheel").compliance[2, 2]
        assert float(row["C_zz"]) == pytest.approx(c, rel=1e-9)  # the same formulas


@pytest.mark.long
def test_a_sweep_over_what_one_bearing_stands_in(shaft, tmp_path):
    """Its entries, a coupling that the file leaves out, all of it together, and the box beside it."""
    out = tmp_path / "rows.csv"
    texts = [
        "bearing.B.housing.kzz=3e8,2e9",
        "bearing.B.housing.kxz=0,2e8",
        "bearing.B.housing.scale=0.5,3",
        "housing.scale=1,4",
    ]
    variants = bearing_variants(PATH, texts)
    run(bearing_task(variants, options=COARSE["harmonic"], n=2), out)
    rows = table(out)
    assert len(rows) == 16 and {row["how"] for row in rows} == {"reduced"}  # nothing factored anew
    body = sg.build(shaft, "harmonic", **COARSE["harmonic"])
    a, b = shaft.bearings
    for row in rows:
        entries = b.housing.entries | {
            name: float(row[f"bearing.B.housing.{name}"]) for name in ("kzz", "kxz")
        }
        factor = float(row["bearing.B.housing.scale"])
        wall = Elastic(stiffness={name: factor * k for name, k in entries.items()})
        box = {name: float(row["housing.scale"]) * k for name, k in shaft.housing.entries.items()}
        there = shaft.with_changes(
            bearings=(a, b.with_changes(housing=wall)),
            housing=Housing(stiffness=box, y=shaft.housing.y),
        )
        fresh = sg.condense(body, there, "wheel")
        # the same low-rank formulas, on springs that are put in series another way
        assert float(row["C_zz"]) == pytest.approx(fresh.compliance[2, 2], rel=1e-9)
        assert float(row["K_thx"]) == pytest.approx(fresh.stiffness[3, 3], rel=1e-9)
        first = next(m for m in sg.modes(body, there, 4).modes if m.frequency_hz > 0)
        # what a sweep promises of frequencies
        assert float(row["f1_hz"]) == pytest.approx(first.frequency_hz, rel=1e-6)


def test_a_motion_that_was_rigid_gives_as_the_file_would_say(shaft, tmp_path):
    """An entry that the file leaves out: the row is the scene of a file that has it."""
    variants = bearing_variants(PATH, ["housing.kthz=1e6,2e6"])
    run(bearing_task(variants, model="timoshenko", n=2), tmp_path / "b.csv")
    row = table(tmp_path / "b.csv")[0]
    entries = shaft.housing.entries | {"kthz": 1e6}
    there = shaft.with_changes(housing=Housing(stiffness=entries, y=shaft.housing.y))
    c = sg.condense(sg.build(shaft, "timoshenko"), there, "wheel").compliance[0, 0]
    assert float(row["C_xx"]) == pytest.approx(c, rel=1e-9)  # the same formulas


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("bearing.B.housing.kx_thz=1e9", "couples thz, which is rigid unless kthz is given"),
        ("bearing.B.housing.kzq=1e9", "unknown stiffness entry"),
        ("bearing.B.housing=1e9", "no single entry; add one of"),
        ("bearing.C.housing.kzz=1e9", "there is no bearing.C"),
        ("bearing.B.housing.kzz=1e9 N", "is not a unit of force per length"),
    ],
)
def test_what_a_housing_cannot_vary_is_refused_at_once(text, word):
    with pytest.raises(sg.SolidgearError, match=word):
        bearing_variants(PATH, [text]).first_sound()


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("bearing.B.housing.scale=0", "scale = 0: must be greater than zero"),
        ("bearing.B.housing.kzz=-1", r"bearing\[2\].*housing.*in z is -1; it must not be negative"),
        ("bearing.B.housing.kxz=1e10", r"bearing\[2\].*housing.*the stiffness is indefinite"),
        ("housing.kzz=1e3", "housing.stiffness.*the stiffness is indefinite"),
    ],
)
def test_a_housing_that_a_file_would_be_refused_for_is_refused_as_a_variant(text, word):
    with pytest.raises(sg.SceneError, match=word):
        bearing_variants(PATH, [text]).variant(0)
