"""Sweeps over any entry of a scene: what is changed, solved and told."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.core.bounds import harmonic
from solidgear.core.bounds.patches import local_energies
from solidgear.strength.stress import at_rest
from solidgear.variants.sweep.bearing_variants import bearing_variants
from tests.command import command, table

SHAFT = "geometry/shaft_stepped.toml"
BEAM = {"model": "timoshenko", "n": 2}


def by_hand(tmp_path, *changes):
    """The same file with texts replaced, as a person would."""
    text = open(SHAFT, encoding="utf-8").read()
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = tmp_path / "by_hand.toml"
    path.write_text(text, encoding="utf-8")
    return sg.load(path)


def test_a_row_is_what_the_file_changed_by_hand_gives(tmp_path):
    rows = sg.sweep(SHAFT, "segment.left.diameter=52 mm,54 mm", **BEAM)
    scene = by_hand(tmp_path, ('diameter = "50 mm"', 'diameter = "54 mm"'))
    body = sg.build(scene, "timoshenko")
    statics = sg.condense(body, scene, scene.port.name)
    assert rows["C_zz"][1] == pytest.approx(statics.compliance[2, 2], rel=1e-12)
    assert rows["f1_hz"][1] == pytest.approx(sg.modes(body, scene, n=2).frequency_hz[-2], rel=1e-9)


def test_local_problems_of_a_row_are_solved_once(monkeypatch):
    solved = []

    def counted(space, block, loading):
        solved.append(block.name)
        return local_energies(space, block, loading)

    monkeypatch.setattr(harmonic, "local_energies", counted)
    sg.sweep(SHAFT, "bearing.A.seat_width=20 mm", tolerance=0.1, n=2)
    # those of the mesh, and of the modes of the row with them
    assert len(solved) == len({*solved}) == 3


def test_rows_of_stress_solve_no_grooves_which_no_rating_reads(monkeypatch):
    def refused(*_):
        raise AssertionError("a solid of a groove")

    monkeypatch.setattr(at_rest, "solid_notches", refused)
    tables = tomllib.loads(Path("tests/found/design/notches.toml").read_text())
    tables["feature"] = [part for part in tables["feature"] if part["kind"] != "fillet"]
    rows = sg.sweep(tables, "segment.c.length=100 mm", ask="stress")
    # by DIN 743 by hand: keyway, ring groove and press fit
    assert rows["worst_notch"][0] == "key"
    assert rows["fatigue_safety"][0] == pytest.approx(5.96, abs=0.01)


@pytest.mark.slow
def test_a_bar_holds_what_a_tighter_tolerance_changes():
    vary = "bearing.A.seat_width=20 mm"
    loose, tight = (sg.sweep(SHAFT, vary, tolerance=tol, n=2) for tol in (0.1, 5e-3))
    for name in ("C_zz", "f1_hz", "f2_hz"):
        off = abs(loose[name] - tight[name])
        assert off <= loose[f"{name} bar"] + tight[f"{name} bar"]
        assert tight[f"{name} bar"] < 0.2 * loose[f"{name} bar"]


def test_bearings_alone_are_swept_by_one_body_from_python_as_by_the_command(tmp_path):
    varied, rows = "bearing.A.kzz=1e8,2e8", tmp_path / "rows.csv"
    swept = sg.sweep(SHAFT, varied, **BEAM)
    assert list(swept["how"]) == ["reduced"] * 2
    chosen = ("-f", "timoshenko", "-n", 2, "--vary", varied)
    assert command("sweep", SHAFT, *chosen, "--out", rows).exit_code == 0
    files = {path.name for path in swept.write(tmp_path / "study")}
    assert files == {"sweep.html", "sweep.json", "rows.csv", "sweep.png", "sweep.svg"}
    # the very digits, of the command and of the folder
    assert table(rows) == table(tmp_path / "study" / "rows.csv")
    with pytest.raises(sg.SolidgearError, match="one body for many bearing sets"):
        sg.sweep(SHAFT, "material.E=200 GPa", reduction_tolerance=1e-3, **BEAM)


def test_entries_with_a_plus_have_one_value_and_a_sum_is_kept():
    both = "segment.left.diameter+segment.right.diameter=48 mm:52 mm:3"
    rows = sg.sweep(SHAFT, both, **BEAM)
    assert rows.varied == ("segment.left.diameter+segment.right.diameter",)
    alone = sg.sweep(SHAFT, ["segment.left.diameter=52 mm", "segment.right.diameter=52 mm"], **BEAM)
    assert rows["f1_hz"][2] == alone["f1_hz"][0]
    kept = sg.sweep(
        SHAFT,
        "segment.left.length=110 mm,130 mm",
        keep_sum=["segment.left.length+segment.middle.length"],
        **BEAM,
    )
    assert kept["segment.middle.length"] == pytest.approx([0.17, 0.15], rel=1e-12)


def test_one_at_a_time_begins_with_the_file_and_leaves_the_others_as_they_are():
    vary = ["segment.left.diameter=45 mm,55 mm", "segment.middle.diameter=90 mm"]
    rows = sg.sweep(SHAFT, vary, one_at_a_time=True, **BEAM)
    assert len(rows) == 4
    assert rows["segment.left.diameter"].tolist() == [0.05, 0.045, 0.055, 0.05]
    assert rows["segment.middle.diameter"].tolist() == [0.08, 0.08, 0.08, 0.09]


def test_a_table_of_ones_own_says_every_variant_and_an_empty_cell_leaves_the_file(tmp_path):
    mine = tmp_path / "mine.csv"
    mine.write_text("segment.left.diameter,bearing.A.seat_width\n52 mm,\n,20 mm\n-1 mm,\n")
    rows = sg.sweep(SHAFT, table=mine, **BEAM)
    assert rows["segment.left.diameter"].tolist() == [0.052, 0.05, -0.001]
    assert rows["bearing.A.seat_width"].tolist() == [0.025, 0.02, 0.025]
    (why,) = rows.whys
    assert "must be greater than zero" in why and math.isnan(rows["f1_hz"][2])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--vary", "segment.left.diamter=1 mm,2 mm"], "did you mean .segment.left.diameter"),
        (["--vary", "segment.lef.diameter=1 mm,2 mm"], "there is no segment.lef"),
        (["--vary", "bearing.A.kxq=1e8,2e8"], "did you mean .bearing.A.stiffness.kxx"),
        (
            ["--vary", "segment.left.diameter=1 mm:2 s:3"],
            "are units of different quantities|1 mm:2 s:3",
        ),
        (
            ["--vary", "segment.left.diameter=50 mm", "--keep-sum", "segment.left.length"],
            "--keep-sum",
        ),
        (["--table", "nowhere.csv"], "nowhere.csv: cannot be read"),
        (["--one-at-a-time"], "nothing is varied"),
        (["--vary", "title=a,b", "--chart", "x.png"], "varies by words"),
    ],
)
def test_bad_input_ends_in_a_sentence_and_leaves_nothing(tmp_path, arguments, said):
    failed = command("sweep", SHAFT, "-o", tmp_path / "rows.csv", *arguments)
    assert failed.exit_code == 1
    with pytest.raises(sg.SolidgearError, match=said):
        raise failed.exception
    assert not list(tmp_path.iterdir())


def test_the_command_says_what_was_solved_and_why_variants_were_refused(tmp_path):
    rows = tmp_path / "rows.csv"
    vary = ("--vary", "segment.left.length=40 mm:60 mm:3", "-f", "timoshenko", "-o", rows)
    told = " ".join(command("sweep", SHAFT, *vary).output.split())
    assert "Wrote 3 rows to" in told and "3 variants in" in told
    assert "Refused:" in told and "across the step of the outer radius at 0.04 m" in told
    assert [row["status"] == "ok" for row in table(rows)] == [False, True, True]
    again = " ".join(command("sweep", SHAFT, *vary).output.split())
    assert "all 3 rows were there already" in again


def test_springs_alone_go_the_way_of_one_body(tmp_path):
    springs = bearing_variants(SHAFT, ["bearing.A.kzz=1e8,2e8"])
    assert springs.entries[0].label == "bearing.A.stiffness.kzz"
    both = ["bearing.A.kzz=1e8,2e8", "material.E=200 GPa,210 GPa"]
    assert bearing_variants(SHAFT, both) is None
    told = command(
        "sweep",
        SHAFT,
        "--vary",
        "bearing.A.stiffness.kzz=1e8,2e8",
        "-f",
        "euler",
        "-o",
        tmp_path / "r.csv",
    )
    assert "one body does for all" in told.output
    assert "Over bearing.A.stiffness.kzz" in told.output and "bending 1" in told.output


GEARBOX = "geometry/gearbox_catalogue.toml"


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("bearing.B.catalogue.designation", ("7208 B", "7310 B")),  # B is a byte as well
        ("bearing.A.catalogue.designation", ("NU 207", "NU207 m")),
        ("title", ("20 mm", "3 kN")),
        ("segment.left.name", ("4 m", "5 m")),
        ("port.name", ("10 K", "20 K")),
    ],
)
def test_a_key_of_words_is_no_quantity_whatever_it_looks_like(entry, words):
    rows = sg.sweep(GEARBOX, f"{entry}={','.join(words)}", **BEAM)
    assert rows[entry].tolist() == list(words)


def test_a_word_in_a_table_of_ones_own_is_a_word(tmp_path):
    mine = tmp_path / "mine.csv"
    mine.write_text("bearing.B.catalogue.designation,bearing.A.position\n7310 B,15 mm\n,16 mm\n")
    rows = sg.sweep(GEARBOX, table=mine, **BEAM)
    assert rows["bearing.B.catalogue.designation"].tolist() == ["7310 B", "7208 B"]
    assert rows["bearing.A.position"].tolist() == [0.015, 0.016]


def test_inner_dimensions_of_one_bearing_are_left_out_for_another():
    rows = sg.sweep(GEARBOX, "bearing.B.catalogue.designation=7208 B,7310 B", **BEAM)
    (sentence,) = rows.task.variants.followed
    assert "elements, element_diameter, pitch_diameter" in sentence and '"7208 B"' in sentence
    assert rows["segment.right.diameter"].tolist() == [0.04, 0.05]
    assert (
        sg.sweep(GEARBOX, "bearing.B.catalogue.elements=14,15", **BEAM).task.variants.followed == ()
    )


def test_a_material_by_name_is_its_numbers(tmp_path):
    scene = by_hand(tmp_path, ('E = "207 GPa"', 'E = "210 GPa"'))
    own = sg.build(scene, "timoshenko")
    want = sg.modes(own, scene, n=2).frequency_hz[-2]
    named = tmp_path / "named.toml"
    text = open(SHAFT, encoding="utf-8").read()
    start, end = text.index("[material]"), text.index("[[segment]]")
    named.write_text('material = "42CrMo4"\n' + text[:start] + text[end:])
    rows = sg.sweep(named, "material.E=210 GPa,190 GPa", **BEAM)
    assert rows["f1_hz"][0] == pytest.approx(want, rel=1e-12)
    assert rows["f1_hz"][1] < rows["f1_hz"][0]
    words = sg.sweep(named, "material=42CrMo4,aluminium", **BEAM)
    assert words["material"].tolist() == ["42CrMo4", "aluminium"]
    assert words["f1_hz"][0] == rows["f1_hz"][0]


def test_a_free_shaft_has_frequencies_and_no_compliances():
    swept = sg.sweep("geometry/cylinder_free.toml", "segment.rod.length=300 mm", tolerance=0.1, n=1)
    (row,) = swept.rows
    assert row["status"] == "ok" and row["mode1"] == "bending 1" and row["f1_hz bar"] > 0
    assert row["C_zz"] is None and row["C_zz bar"] is None
