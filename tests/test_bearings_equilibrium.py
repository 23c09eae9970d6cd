"""Shafts in equilibrium with their bearings, scenes with catalogue bearings, and their command."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.bearings.balance import Linear, Mounted
from solidgear.bearings.ball import BallRow
from solidgear.bearings.equilibrium import equilibrium
from solidgear.bearings.roller import RollerRow
from solidgear.bearings.rolling import RollingBearing
from solidgear.bearings.sliding import condense_y
from solidgear.bearings.solved import solved
from solidgear.bearings.study import over_load
from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.scene.file import load as read
from tests.command import command
from tests.dense import whole

PNG = b"\x89PNG"
SCENE = "geometry/gearbox_catalogue.toml"
BALLS = RollingBearing((BallRow(count=9, diameter=9.525e-3, pitch=46e-3, clearance=8e-6),))
ROLLERS = RollingBearing((RollerRow(13, 9e-3, 46.5e-3, length=10e-3, clearance=15e-6),))
PAIR = RollingBearing(
    tuple(
        BallRow(14, 11.9e-3, 60e-3, 0.698, side, preload=4e-6, height=9e-3 * -side)
        for side in (1, -1)
    )
)


@pytest.fixture(scope="module")
def three():
    """A shaft on three seats: statically indeterminate."""
    rod = sg.Segment.cylinder("rod", length=0.4, diameter=0.03)
    seat = {"seat_width": 0.01, "stiffness": {"kxx": 1e8}}
    seats = [sg.Bearing(name=n, y=y, **seat) for n, y in (("A", 0.02), ("B", 0.2), ("C", 0.38))]
    port = sg.Port(name="mesh", y=0.29, lo=0.28, hi=0.3)
    return sg.Scene.from_parts([rod], bearings=seats, port=port)


def by_hand(body, bearings, port, load):
    """Picard's iteration on the full matrices of a beam: springs stand still, what contacts press
    beyond them is a load.
    """
    stiffness, _, ports = whole(body)
    rows = {p.name: ports[6 * k : 6 * k + 6] for k, p in enumerate(body.ports)}
    turning = np.zeros(6)
    turning[4] = 1e3  # thy is free: a spring that takes nothing
    held = stiffness + rows[port].T @ np.diag(turning) @ rows[port]
    # no stiffer than needed, or the iteration crawls; no softer than half, or it runs away
    springs = {n: b.tangent(b.motion(np.array(f, float))) for n, (b, f) in bearings.items()}
    for name, spring in springs.items():
        held = held + rows[name].T @ spring @ rows[name]
    inverse = np.linalg.inv(held)
    u = np.zeros(len(stiffness))
    for _ in range(4000):
        force = rows[port].T @ np.asarray(load, float)
        for name, (bearing, _) in bearings.items():
            q = rows[name] @ u
            force += rows[name].T @ (springs[name] @ q - bearing.load(q))
        following = u + 0.6 * (inverse @ force - u)
        if np.abs(following - u).max() < 1e-19:
            break
        u = following
    return {name: row @ u for name, row in rows.items()}


@pytest.mark.long
def test_three_bearings_against_springs_iterated_by_hand(three):
    body = sg.build(three, "euler")
    load = np.array([300.0, 500.0, 2500.0, 20.0, 0, -5.0])
    mounts = {"A": (BALLS, [0, 0, 3e3, 0, 0, 0]), "B": (ROLLERS, [0, 0, 9e3, 0, 0, 0])}
    mounts["C"] = (PAIR, [0, 0, 4e3, 0, 0, 0])
    found = equilibrium(body, [Mounted(n, b) for n, (b, _) in mounts.items()], {"mesh": load})
    hand = by_hand(body, mounts, "mesh", load)
    for name in ("A", "B", "C", "mesh"):
        keep = [0, 1, 2, 3, 5]
        scale = np.abs(hand[name][keep]) + 1e-3 * np.array([1e-5, 1e-5, 1e-5, 1e-4, 1e-4])
        assert np.all(np.abs(found.motion[name] - hand[name])[keep] < 1e-8 * scale + 1e-14)
    total = sum(found.load.values())[:3]
    assert total == pytest.approx(load[:3], rel=1e-9)


def test_linear_bearings_give_what_condense_gives(three):
    body = sg.build(three, "timoshenko")
    stiffness = np.diag([1e8, 5e7, 2e8, 1e4, 0, 1e4])
    linear = [Mounted(n, Linear(stiffness)) for n in ("A", "B", "C")]
    load = np.array([100.0, -50.0, 700.0, 3.0, 0, 1.0])
    found = equilibrium(body, linear, {"mesh": load}, housing=4e8)
    scene = three.with_changes(
        bearings=[b.with_changes(matrix=stiffness) for b in three.bearings], housing_axial=4e8
    )
    at = sg.condense(body, scene, port="mesh")
    keep = [0, 1, 2, 3, 5]
    expected = at.compliance[np.ix_(keep, keep)] @ load[keep]
    assert found.motion["mesh"][keep] == pytest.approx(expected, rel=1e-8)


def test_a_preloaded_pair_settles_without_load(three):
    # its contacts press 14 x 2 times some 20 N and cancel: rounding of that is no load left over
    body = sg.build(three, "timoshenko")
    mounts = [Mounted("A", PAIR), Mounted("B", ROLLERS), Mounted("C", PAIR)]
    at_rest = PAIR.tangent(np.zeros(6))
    for load in (0.0, 1e-9):
        found = equilibrium(body, mounts, {"mesh": [load, 0, 0, 0, 0, 0]})
        assert max(np.abs(motion).max() for motion in found.motion.values()) < 1e-16
        assert found.tangent["A"] == pytest.approx(at_rest, rel=1e-9, abs=1e-6)
    assert PAIR.at_work(np.zeros(6)) > 100 and found.lost == ("B",)
    assert np.abs(PAIR.motion(np.zeros(6))).max() < 1e-16


def test_a_scene_without_load_is_told_without_rounding(tmp_path):
    path = tmp_path / "idle.toml"
    load = ('x = "3.8 kN"', 'y = "-1.0 kN"', 'z = "1.4 kN"')
    text = open(SCENE).read()
    for line in load:
        text = text.replace(line, line[:5] + '0 N"')
    path.write_text(text)
    done = command("bearing", path)
    assert done.exit_code == 0, done.output
    assert done.output.count("Load: none") == 2 and "e-" not in done.output


def test_series_spring_and_housing_take_the_bearings_load(three):
    body = sg.build(three, "timoshenko")
    mounts = [Mounted("A", ROLLERS), Mounted("C", PAIR, spring=2e7)]
    load = {"mesh": [0, 800.0, 1500.0, 0, 0, 0]}
    found = equilibrium(body, mounts, load, housing=5e7)
    ring = found.motion["C"][1] - found.relative["C"][1]
    assert ring == pytest.approx(800.0 / 2e7 + 800.0 / 5e7, rel=1e-8)


def test_lost_load_is_told(three):
    body = sg.build(three, "timoshenko")
    loose = RollingBearing((BallRow(9, 9.525e-3, 46e-3, clearance=2e-3),))
    mounts = [Mounted("A", BALLS), Mounted("B", loose), Mounted("C", BALLS)]
    assert equilibrium(body, mounts, {"mesh": [0, 0, 300.0, 0, 0, 0]}).lost == ("B",)
    with pytest.raises(SolidgearError, match="no bearing holds the shaft in y under 500 N in y"):
        equilibrium(body, [Mounted(n, ROLLERS) for n in "ABC"], {"mesh": [0, 500.0, 0, 0, 0, 0]})


def test_a_scene_is_data_until_it_is_loaded():
    scene = read(SCENE)
    assert scene.bearings[0].matrix is None and scene.bearings[0].status == "estimated"
    assert scene.bearings[1].status == "calculated"
    with pytest.raises(SceneError, match="read the scene with solidgear.load"):
        _ = scene.bearings[0].stiffness
    loaded = sg.load(SCENE)
    assert loaded.bearings[0].catalogue == scene.bearings[0].catalogue
    again = json.loads(json.dumps(loaded.as_dict(), allow_nan=False))
    assert again["bearings"][1]["catalogue"]["preload"]["force"] == 400.0


def test_the_equilibrium_carries_the_load_of_the_scene():
    scene = read(SCENE)
    body = sg.build(scene, "timoshenko")
    found = solved(scene, body).equilibrium
    assert sum(found.load.values())[:3] == pytest.approx([3800.0, -1000.0, 1400.0], rel=1e-9)
    assert found.lost == () and found.unbalanced < 1e-9
    # solids find the same loads: those of a shaft on two seats are statics
    light = sg.build(scene, "harmonic", order=2, layers=1)
    other = solved(scene, light).equilibrium
    assert other.load["A"][:3] == pytest.approx(found.load["A"][:3], rel=0.02)


def test_more_load_makes_stiffer_bearings():
    scene = read(SCENE)
    curves = over_load(scene, sg.build(scene, "timoshenko"), factors=(0.25, 0.5, 1.0, 2.0))
    for k in (0, 2):
        assert np.all(np.diff(curves["A"].middle[:, k]) > 0)
        assert np.all(curves["A"].low[:, k] <= curves["A"].middle[:, k])


def test_the_command(tmp_path):
    chart = tmp_path / "bearings.png"
    done = command("bearing", SCENE, "--out", chart)
    assert done.exit_code == 0, done.output
    assert "4 of 13 elements carry" in done.output and chart.read_bytes().startswith(PNG)
    both = json.loads(command("bearing", SCENE, "--json").stdout)["bearings"]
    assert [row["no_spread"] for row in both] == ["", "all inner dimensions are given"]
    assert both[0]["spread"] and both[1]["spread"] is None
    other = command("bearing", SCENE, "--bearing", "A", "--load", "z=9 kN", "--json")
    (row,) = json.loads(other.stdout)["bearings"]
    assert row["load"][2] == pytest.approx(9e3) and row["status"] == "estimated"


@pytest.mark.parametrize(
    "args, sentence",
    [
        (("--load", "z"), "write components such as"),
        (("--load", "w=3"), "unknown key"),
        (("--bearing", "Q"), "no bearing of catalogue data has this name"),
        (("--out", "a.pdf"), "give a picture a name that ends in"),
    ],
)
def test_bad_options_end_in_one_sentence(args, sentence):
    done = command("bearing", SCENE, *args)
    assert done.exit_code != 0 and sentence in str(done.exception)


def test_a_pair_that_is_pushed_apart_is_told(tmp_path):
    path = tmp_path / "loose.toml"
    text = open(SCENE).read().partition("[uncertain]")[0]  # a preload that is none has no range
    text = text.replace(
        'speed = "1500 rpm"', ""
    )  # at speed inertia keeps its balls between the rings
    path.write_text(text.replace('preload = "400 N"', 'load = {y = "2 kN"}'))
    done = command("bearing", path, "--bearing", "B")
    assert "the row at the upper end of y carries nothing" in " ".join(done.output.split())


def test_scenes_without_catalogue_bearings_say_so():
    done = command("bearing", "geometry/shaft_stepped.toml")
    assert "no bearing is described by catalogue data" in str(done.exception)


def test_a_bad_file_names_the_key(tmp_path):
    text = open(SCENE).read()
    for old, new, sentence in (
        ('clearance = "CN"', 'clearance = "C7"', 'bearing[1] "A".catalogue.clearance = "C7"'),
        ('preload = "400 N"', 'preload = "2 s"', 'bearing[2] "B".catalogue.preload = "2 s"'),
        ('load_rating = "48 kN"', 'load_rating = "4 N"', 'bearing[1] "A".catalogue.static'),
        ('x = "3.8 kN"', 'thy = "3 N*m"', 'load.thy = "3 N*m": bearings carry no moment about'),
        ('x = "3.8 kN"', 'torque = "3 N*m"', "the torques do not add up to zero: 3 N m of"),
        ('x = "3.8 kN"', 'Mx = "3 N*m"', 'did you mean "thx"'),
    ):
        path = tmp_path / "bad.toml"
        path.write_text(text.replace(old, new))
        with pytest.raises(SceneError) as refused:
            if "static" in sentence:
                path.write_text(
                    path.read_text().replace('static_rating = "48 kN"', 'static_rating = "4 N"')
                )
            sg.load(path)
        assert sentence in str(refused.value), str(refused.value)


def test_a_bearing_without_load_tells_no_empty_range(tmp_path):
    text = open(SCENE).read()
    text = text[: text.index("[load]")].replace('preload = "400 N"', "")
    path = tmp_path / "idle.toml"
    path.write_text(text + '[load]\nx = "0 N"\n')
    told = command("bearing", path, "--bearing", "A").output
    (basic,) = [line.split() for line in told.splitlines() if "basic L10" in line]
    assert basic == ["basic", "L10", "endless", "endless", "endless"]
    assert (
        "carries nothing" in told
        and "Range over the estimated inside, from soft to stiff" not in told
    )


# ------------------------------------------------------------------------------- one ball carries
FOUND = Path(__file__).parent / "found" / "design"
LIGHT = FOUND / "light_ball_c3.toml"


@pytest.mark.parametrize("support", ["floating", "locating"])
@pytest.mark.parametrize("load", ["x=200 N", "x=2 N", "z=50 N", "z=-7 N", "x=3 N, z=4 N"])
def test_a_ball_bearing_on_one_ball_has_a_life(load, support):
    """Nothing holds the shaft across its load but for rounding; P is half of the load in a radial
    bearing, and L10 = (C/P)^3.
    """
    tables = tomllib.loads(LIGHT.read_text("utf-8"))
    tables["bearing"][1]["support"] = support
    total = np.hypot(
        *(float(part.split("=")[1][:-2]) for part in (f"{load}, y=0 N").split(", ")[:2])
    )
    found = sg.bearing(tables, load=load)
    for fact in found.facts:
        life = fact.life.life
        assert life.equivalent.load == pytest.approx(total / 2, rel=1e-6)
        ratio = life.rated.dynamic / life.equivalent.load
        assert fact.life.lives["basic"] == pytest.approx(1e6 * ratio**3, rel=1e-9)


def test_a_shaft_on_one_ball_a_bearing_has_no_error_bar_across_its_load():
    deflected = sg.deflect(LIGHT, load="z=50 N")
    x, _, z, *_ = deflected.judge.displacement["g"]
    assert abs(x.value) < 1e-15 and x.bar is None
    # 25 N on one ball press 12 um through half of the clearance, 10.25 um
    assert 10e-6 < z.value < 15e-6 and 0 < z.bar < 1e-8
    assert sum("nothing holds it across its load" in note for note in deflected.judge.notes) == 2


def test_one_ball_holds_no_tilt_of_a_ring_that_slides():
    """Along y and about z a ball at any angle is one spring: with y condensed nothing is left."""
    angles = np.linspace(0.1, 1.0, 50)
    zero = np.zeros(50)
    arms = np.array([zero, np.sin(angles), zero, zero, zero, 0.0137 * np.cos(angles)]).T
    assert not condense_y(3e5 * arms[:, :, None] * arms[:, None, :]).any()


def test_rounding_of_a_stiffness_is_judged_by_its_largest_entry():
    """-3e-14 N m/rad beside 4e7 N/m is none; -3 N m/rad is refused, and so is a spring too soft to
    couple.
    """
    matrix = np.diag([4e7, 2e5, 1e7, 0.0, 0.0, -3e-14])
    assert sg.Bearing(name="A", y=0.1, seat_width=0.01, matrix=matrix).matrix[5][5] == 0
    turned = np.zeros((6, 6))
    turned[:3:2, :3:2] = [[8e-26, 1.3e-9], [1.3e-9, 2e7]]  # along z but for the last digit
    assert sg.Bearing(name="A", y=0.1, seat_width=0.01, matrix=turned).matrix[0] == (0.0,) * 6
    for entries in ({"kxx": 4e7, "kthz": -3.0}, {"kxx": 4e7, "kx_thz": 1.0, "kthz": 1e-12}):
        with pytest.raises(SceneError, match="must not be negative"):
            sg.Bearing(name="A", y=0.1, seat_width=0.01, stiffness=entries)


def test_a_catalogue_bearing_on_a_segment_has_its_own_width():
    """A 6207 is 17 mm wide, on a segment of 60 mm, in whose middle it sits."""
    scene = sg.load(FOUND / "bearing_on_segment.toml")
    for bearing, middle in zip(scene.bearings, (0.03, 0.15)):
        assert (bearing.y, bearing.seat_width) == pytest.approx((middle, 0.017))
    tables = tomllib.loads((FOUND / "bearing_on_segment.toml").read_text("utf-8"))
    del tables["bearing"][0]["catalogue"]
    tables["bearing"][0]["stiffness"] = {"kxx": 1e8, "kyy": 1e8, "kzz": 1e8}
    assert sg.load(tables).bearings[0].seat_width == pytest.approx(0.06)
