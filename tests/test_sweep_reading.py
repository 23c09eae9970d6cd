"""One reading of what varies: a row that holds the file's own value is the file."""

import re

import pytest

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.variants.sweep.bearing_variants import bearing_variants

#: a head, two cylinders; bearing "front" stands in all cases at 90 mm, "rear" at 220 mm
SHAFT = """
material = {{ E = "207 GPa", nu = 0.3, density = "7850 kg/m^3" }}
segment = [
    {{ kind = "bevel_head", name = "head", pitch_radius = "40 mm", pitch_angle = "22 deg", face_width = "38 mm", backcone = "6 mm", toe = "start" }},
    {{ kind = "cylinder", name = "neck", length = "100 mm", diameter = "55 mm" }},
    {{ kind = "cylinder", name = "tail", length = "100 mm", diameter = "45 mm" }},
]
[[bearing]]
name = "front"
{front}
seat_width = "20 mm"
{springs}
[[bearing]]
name = "rear"
{rear}
seat_width = "20 mm"
stiffness = {{ kxx = "4e8 N/m", kzz = "4e8 N/m" }}
[port]
name = "pinion"
at = "head.mid_face"
attach_to = "head"
"""
NAMED = 'stiffness = { kxx = "5e8 N/m", kyy = "2e8 N/m", kzz = "5e8 N/m" }'
ROWS = (
    "matrix = [[5e8,0,0,0,0,0],[0,2e8,0,0,0,0],[0,0,5e8,0,0,0],"
    "[0,0,0,0,0,0],[0,0,0,0,0,0],[0,0,0,0,0,0]]"
)
DATUMS = (
    "start",
    "end",
    "head.start",
    "head.mid_face",
    "head.end",
    "neck.start",
    "neck.middle",
    "neck.end",
    "tail.start",
    "tail.middle",
    "tail.end",
)
BEAM = {"model": "timoshenko", "n": 1, "options": {"elements": 20}}
#: relative, by which seats that are meshed for other rows move a beam's number; another datum moves
#: it by more than a hundredth
MESH = 1e-4


def placed(y, datum, written):
    """Words for a place in m, counted from a datum."""
    there = sg.load(written)
    at = {"start": 0.0, "end": there.length}
    ends = {s.name: (s.y0, s.y1) for s in there.segments if s.name in ("neck", "tail")}
    for name, (lo, hi) in ends.items():
        at |= {f"{name}.start": lo, f"{name}.middle": (lo + hi) / 2, f"{name}.end": hi}
    at |= {"head.start": 0.0, "head.end": ends["neck"][0], "head.mid_face": there.port.y}
    return f'position = {round(y - at[datum], 9)!r}\nfrom = "{datum}"'


def written(path, front="position = 0.09", rear="position = 0.22", springs=NAMED):
    path.write_text(SHAFT.format(front=front, rear=rear, springs=springs), encoding="utf-8")
    return path


def of_the_file(path):
    """K_zz of a file as it is."""
    scene = sg.load(path)
    return sg.condense(sg.build(scene, "timoshenko", elements=20), scene, "pinion").stiffness[2, 2]


def by_every_way(path, entry, value, other, folder):
    """K_zz of the row that holds the file's own value, by every way of sweeping."""
    both = f"{entry}={value},{other}"
    table = folder / "mine.csv"
    table.write_text(f"{entry}\n{value}\n{other}\n", encoding="utf-8")
    own = {"alone": sg.sweep(path, both, **BEAM)["K_zz"][0]}
    beside = [both, "segment.tail.length=100 mm,101 mm"]
    own["beside"] = sg.sweep(path, beside, **BEAM)["K_zz"][0]
    own["in turn"] = sg.sweep(path, both, one_at_a_time=True, **BEAM)["K_zz"]
    assert own["in turn"][0] == pytest.approx(own["in turn"][1], rel=1e-9)
    own["in turn"] = own["in turn"][0]
    own["table"] = sg.sweep(path, table=table, **BEAM)["K_zz"][0]
    return own


@pytest.mark.parametrize("datum", DATUMS)
def test_the_row_of_the_files_own_position_is_the_file(datum, tmp_path):
    usual = written(tmp_path / "usual.toml")
    path = written(tmp_path / "shaft.toml", placed(0.09, datum, usual))
    want = of_the_file(path)
    assert want == pytest.approx(of_the_file(usual), rel=1e-6)
    at = re.search(r"position = (\S+)", path.read_text())[1]
    rows = by_every_way(path, "bearing.front.position", at, float(at) + 2e-3, tmp_path)
    assert rows == {way: pytest.approx(want, rel=MESH) for way in rows}


def test_a_bearing_counted_from_another_moves_with_it(tmp_path):
    path = written(tmp_path / "s.toml", rear='position = "130 mm"\nfrom = "bearing.front"')
    rows = by_every_way(path, "bearing.front.position", "90 mm", "92 mm", tmp_path)
    assert rows == {way: pytest.approx(of_the_file(path), rel=MESH) for way in rows}
    moved = bearing_variants(path, ["bearing.front.position=92 mm"]).variant(0)
    assert [round(b.y, 9) for b in moved.bearings] == [0.092, 0.222]


@pytest.mark.parametrize("springs", [NAMED, ROWS, NAMED + '\naxial_series = ["4e8 N/m"]'])
@pytest.mark.parametrize(
    ("entry", "value", "other"),
    [
        ("bearing.front.kzz", "5e8", "6e8"),
        ("bearing.front.scale", "1", "2"),
        ("bearing.rear.stiffness.kzz", "4e8 N/m", "5e8 N/m"),
    ],
)
def test_the_row_of_the_files_own_spring_is_the_file(entry, value, other, springs, tmp_path):
    path = written(tmp_path / "s.toml", springs=springs)
    rows = by_every_way(path, entry, value, other, tmp_path)
    assert rows == {way: pytest.approx(of_the_file(path), rel=MESH) for way in rows}


def test_every_way_of_sweeping_gives_the_other_rows_as_well(tmp_path):
    """A factor two is a bearing twice as stiff, series springs included, beside what else varies."""
    path = written(tmp_path / "s.toml", springs=NAMED + '\naxial_series = ["4e8 N/m"]')
    scene = sg.load(path)
    front, rear = scene.bearings
    twice = scene.with_changes(bearings=(front.scaled(2), rear))
    want = sg.condense(sg.build(twice, "timoshenko", elements=20), twice, "pinion").stiffness
    rows = sg.sweep(path, ["bearing.front.scale=2", "segment.tail.length=100 mm,101 mm"], **BEAM)
    assert rows["K_zz"][0] == pytest.approx(want[2, 2], rel=1e-9)
    assert rows["K_yy"][0] == pytest.approx(want[1, 1], rel=1e-9)
    alone = sg.sweep(path, ["bearing.front.scale=2,3"], **BEAM)
    assert alone["how"][0] == "reduced" and alone["K_yy"][0] == pytest.approx(want[1, 1], rel=MESH)


def test_what_hangs_on_a_bearing_that_moves_is_no_sweep_of_bearings_alone(tmp_path):
    text = SHAFT.format(front="position = 0.09", rear="position = 0.22", springs=NAMED)
    text = text.replace('at = "head.mid_face"', 'position = "-50 mm"\nfrom = "bearing.front"')
    path = tmp_path / "s.toml"
    path.write_text(text, encoding="utf-8")
    assert bearing_variants(path, ["bearing.front.position=90 mm,92 mm"]) is None
    rows = sg.sweep(path, "bearing.front.position=90 mm,92 mm", **BEAM)
    assert rows["K_zz"][0] == pytest.approx(of_the_file(path), rel=1e-9)


def test_a_face_and_a_seat_have_no_position(tmp_path):
    path = written(tmp_path / "s.toml", rear='face = "end"')
    with pytest.raises(SolidgearError, match="give either face, or position with from"):
        bearing_variants(path, ["bearing.rear.position=5 mm"]).first_sound()


def test_a_factor_of_a_housing_is_in_every_sweep(tmp_path):
    walls = NAMED + '\nhousing = { kxx = "2e9 N/m", kzz = "2e9 N/m" }'
    path = written(tmp_path / "s.toml", springs=walls)
    rows = by_every_way(path, "bearing.front.housing.scale", "1", "3", tmp_path)
    assert rows == {way: pytest.approx(of_the_file(path), rel=MESH) for way in rows}
    stiff = written(tmp_path / "t.toml", springs=walls.replace("2e9", "6e9"))
    three = sg.sweep(path, "bearing.front.housing.scale=3", **BEAM)
    assert three["K_zz"][0] == pytest.approx(of_the_file(stiff), rel=1e-9)
