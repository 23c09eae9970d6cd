"""What REXS files of others leave open or say twice: filled and listed, doubted, or refused by the
attribute of the file; nothing is written that cannot be loaded.
"""

import re
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core import SolidgearError
from solidgear.exchange.rexs.frames import frame_of
from solidgear.exchange.rexs.importing import imported
from solidgear.exchange.rexs.loadable import with_loadable
from solidgear.exchange.rexs.reading import document_of
from solidgear.trains.file.tooth_fit import fit_of
from tests.command import command

FOUND = Path(__file__).parent / "found" / "exchange"
OK = (FOUND / "ok.rexs").read_text()
SHIFT = '<attribute id="addendum_modification_coefficient" unit="none">{}</attribute>'


def edited(*edits, text=OK):
    """Return the text of a gearbox with edits, each (old, new) or (old, new, count)."""
    for old, new, *count in edits:
        assert old in text, old
        text = text.replace(old, new, *count)
    return text


def made(text):
    """Return what is made of the text of a gearbox."""
    return imported(document_of(text.encode()), "train")


def written(text, folder):
    """Write the files of a gearbox into a folder; return the path of the train."""
    files = made(text).files
    for name, content in files.items():
        (folder / name).write_text(content, encoding="utf-8")
    return folder / next(iter(files))


def lines(text, heading):
    """Return the lines of a heading of an import."""
    return dict(made(text).notes.groups).get(heading, [])


def bare(text):
    """Return the files of a gearbox without comments and title, by name."""
    strip = re.compile(r"\s*#.*|title = .*")
    return {
        name: [line for row in content.splitlines() if (line := strip.sub("", row).strip())]
        for name, content in made(text).files.items()
    }


# --------------------------------------------------------------------------- profile shifts
def test_a_profile_shift_that_is_left_open_follows_from_the_centre_distance(tmp_path):
    """24 and 74 teeth of 2 mm at 100 mm: inv 23.3 deg - inv 20 deg = 2 tan 20 deg (x1 + x2) / 98, so
    that x2 is 0.57208 beside x1 = 0.5; without it the contact ratio is 1.11.
    """
    one_left = edited((SHIFT.format("0.572077"), ""))
    pair = sg.load_train(written(one_left, tmp_path)).pairs[0]
    angle = np.arccos(98 * np.cos(np.radians(20)) / 100)
    involutes = [np.tan(a) - a for a in (angle, np.radians(20))]
    due = (involutes[0] - involutes[1]) * 98 / 2 / np.tan(np.radians(20)) - 0.5
    assert due == pytest.approx(0.57208, abs=1e-5)
    assert pair.gear.profile_shift == pytest.approx(due, abs=1e-8)
    assert fit_of(pair).contact_ratio == pytest.approx(1.57, abs=0.005)
    assert abs(fit_of(pair).backlash) < 1e-10
    listed = [line for line in lines(one_left, "Assumed") if "addendum_modification" in line]
    assert listed == [
        "gear 2: no addendum_modification_coefficient is given: 0.572077, as the centre distance of "
        "stage asks for"
    ]


def test_both_profile_shifts_open_share_the_sum(tmp_path):
    both = edited((SHIFT.format("0.572077"), ""), (SHIFT.format("0.5"), ""))
    pair = sg.load_train(written(both, tmp_path)).pairs[0]
    assert pair.pinion.profile_shift == pair.gear.profile_shift == pytest.approx(0.53604, abs=1e-5)
    assert "half of what the centre distance of stage asks for" in " ".join(lines(both, "Assumed"))
    # 98 mm is where teeth without profile shift roll
    plain = edited(('unit="mm">100.0</attribute>\n    </component>\n    <component id="15"',
                    'unit="mm">98.0</attribute>\n    </component>\n    <component id="15"'),
                   ("<c>-100.0</c>", "<c>-98.0</c>"), text=both)  # fmt: skip
    assert {"profile_shift"} & {row.split(" ")[0] for row in bare(plain)["train.toml"]} == set()
    assert "addendum_modification_coefficient is given: 0" in " ".join(lines(plain, "Assumed"))


def test_a_chain_of_open_profile_shifts_is_filled_from_the_given_one(tmp_path):
    """A third gear on a third shaft: its shift follows from that of the second, which follows from that
    of the first, whatever the order of stages in the file.
    """
    third = OK[OK.index('<component id="20"') : OK.index('<component id="30"')]
    for old, new in ((r'id="2(\d+)"', r'id="6\1"'), ("gear 2", "gear 3"), ("shaft 2", "shaft 3"),
                     ("<c>-100.0</c>", "<c>-200.0</c>"), (">74<", ">24<")):  # fmt: skip
        third = re.sub(old, new, third)
    relations = OK[OK.index('    <relation id="15"') : OK.index('    <relation id="26"')]
    relations = re.sub(r'ref id="2(\d+)"', r'ref id="6\1"', relations)
    stage = (
        '<relation id="99" type="stage"><ref id="31" role="stage"/><ref id="21" role="gear_1"/>'
        '<ref id="61" role="gear_2"/></relation>'
    )
    first = '<component id="31" type="cylindrical_stage" name="second"/>'
    text = edited((SHIFT.format("0.572077"), ""))
    third = third.replace(SHIFT.format("0.572077"), "")
    text = edited(
        ('    <relation id="26"', relations + stage + '\n    <relation id="26"'),
        ('<component id="20"', first + third + '<component id="20"'),
        text=text,
    )
    train = sg.load_train(written(text, tmp_path))
    shifts = {pair.name: pair.gear.profile_shift for pair in train.pairs}
    assert shifts == pytest.approx({"mesh stage": 0.572077, "mesh second": 0.5}, abs=1e-6)


# --------------------------------------------------------------------------- doubted
@pytest.mark.parametrize(
    "edits, doubt",
    [
        ([('<attribute id="u_coordinate_on_shaft_inner_side" unit="mm">20.0', '<attribute id="u_coordinate_on_shaft_inner_side" unit="mm">30.0', 1)],
         "bearing 105: lies at 30 mm of shaft 1 by u_coordinate_on_shaft_inner_side and at 20 mm by its support_vector; the first is taken"),
        ([('unit="deg">20.0</attribute>\n      ' + SHIFT.format("0.572077"), 'unit="deg">25.0</attribute>\n      ' + SHIFT.format("0.572077"))],
         "stage: normal_pressure_angle of gear 1 and gear 2 are 20 deg and 25 deg, and such teeth do not mesh: the first is taken"),
        ([("-308.3333333333333", "-290.0")], "torques (as given): do not balance: 5.94595 N m remain on shaft 1"),
        ([('<attribute id="length" unit="mm">80.0', '<attribute id="length" unit="mm">79.96', 1)],
         "section 101: ends 0.04 mm before the place where section 102 begins: it is made to end there"),
        ([('<attribute id="length" unit="mm">80.0', '<attribute id="length" unit="mm">80.04', 1)], "section 101: ends 0.04 mm behind"),
    ],
)  # fmt: skip
def test_a_contradiction_is_named_with_what_is_taken(edits, doubt):
    text = edited(*edits)
    assert len(found := lines(text, "Contradictory")) == 1
    assert found[0].startswith(doubt)
    assert lines(OK, "Contradictory") == []


@pytest.mark.parametrize("torque", ["308.3333333333333", "-308.3333333333333"])
def test_balanced_torques_are_no_contradiction_whatever_sign_a_file_gives_what_leaves(torque):
    assert lines(edited(("-308.3333333333333", torque)), "Contradictory") == []


# --------------------------------------------------------------------------- the same gearbox
def test_what_does_no_harm_is_the_same_gearbox():
    """A gap of rounding that is closed, a relation with the number of another, and a gear on a fit."""
    same = {
        "gap": edited(('<attribute id="length" unit="mm">80.0', '<attribute id="length" unit="mm">79.96', 1)),
        "number": edited(('<relation id="29"', '<relation id="1"')),
        "fit": (FOUND / "press_fit.rexs").read_text(),
    }  # fmt: skip
    for text in same.values():
        assert bare(text) == bare(OK)
    assert "press fit: holds its gear to its shaft as if both were one piece" in lines(
        same["fit"], "Assumed"
    )
    keyed = same["fit"].replace("cylindrical_interference_fit", "feather_key_connection")
    assert bare(keyed) == bare(OK)


def test_a_coupling_may_be_placed_by_its_own_frame():
    """200 mm on the wheel's shaft, whose place and that of the coupling differ by so much along u."""
    rows = bare((FOUND / "coupling_without_coordinate.rexs").read_text())["shaft_2.toml"]
    assert rows[rows.index('name = "spline"') + 1] == 'position = "200 mm"'


def test_an_empty_vector_may_be_written_as_false():
    text = """{"model": {"version": "1.5", "components": [{"id": 1, "type": "gear_unit", "attributes":
      [{"id": "support_vector", "unit": "mm", "boolean": false}]}]}}"""
    document = document_of(text.encode())
    assert frame_of(document, document.components[1]) is None


# --------------------------------------------------------------------------- refused
REFUSED = {
    "one hand": (
        [('reference_diameter" unit="deg">0.0', 'reference_diameter" unit="deg">10.0')],
        r'cylindrical_gear 21 "gear 2": helix_angle_reference_diameter = 10.0 deg: .* both right-handed',
    ),
    "crossed shafts": (
        [('<c>-100.0</c></array></attribute>\n      <attribute id="u_axis_vector" unit="mm"><array><c>1.0</c><c>0.0</c>',
          '<c>-100.0</c></array></attribute>\n      <attribute id="u_axis_vector" unit="mm"><array><c>0.0</c><c>1.0</c>', 1)],
        r'cylindrical_stage 30 "stage": its shafts cross',
    ),
    "no face width": (
        [('<attribute id="face_width" unit="mm">30.0</attribute>', "")],
        r'"gear 1": face_width: is missing',
    ),
    "a profile shift of no train": (
        [(SHIFT.format("0.572077"), SHIFT.format("2.9"))],
        r'cylindrical_gear_flank 2100 "left of gear 2": addendum_modification_coefficient '
        r"\(shaft.shaft_2.gears.gear_2.profile_shift\) = 2.9: must be less than 2.5",
    ),
    "a worm": (
        [('type="cylindrical_stage"', 'type="worm_stage"')],
        r"worm_stage 30 \"stage\": trains here have no such stage",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_refusal_names_the_attribute_of_the_file_and_writes_nothing(case, tmp_path):
    edits, words = REFUSED[case]
    source, out = tmp_path / "box.rexs", tmp_path / "out"
    source.write_text(edited(*edits))
    run = command("import", source, "--out", out)
    assert run.exit_code and re.search(words, str(run.exception)), run.exception
    assert not out.exists()


def test_a_shaft_outside_the_train_of_which_no_scene_can_be_made_is_left_out():
    """A third shaft that no teeth join, on bearings of negative stiffness; the train is written."""
    third = OK[OK.index('<component id="20"') : OK.index('<component id="21"')]
    third = re.sub(r'id="2(\d+)"', r'id="8\1"', third).replace("200000000.0", "-2e8")
    relations = OK[OK.index('    <relation id="14"') : OK.index('    <relation id="23"')]
    relations = re.sub(r'ref id="2(\d+)"', r'ref id="8\1"', relations)
    text = edited(
        ('    <relation id="26"', relations + '    <relation id="26"'),
        ('<component id="30"', third + '<component id="30"'),
    )
    result = with_loadable(made(text), "box.rexs")
    assert [*result.files] == ["train.toml", "shaft_1.toml", "shaft_2.toml"]
    left_out = " ".join(dict(result.notes.groups)["Left out"])
    assert 'no scene can be made of it (concept_bearing 805 "bearing 205"' in left_out


def test_an_entry_of_a_single_gear_is_named_by_its_key(tmp_path):
    """The gear of a shaft stands in the table ``gears`` where the file puts it there."""
    path = written(OK, tmp_path)
    helix = 'teeth = {0}\nhelix_angle = "10 deg"\nhand = "right"'
    text = path.read_text()
    for teeth in ("teeth = 24", "teeth = 74"):
        text = text.replace(teeth, helix.format(teeth[-2:]))
    path.write_text(text)
    with pytest.raises(
        SolidgearError, match=r"shaft\.shaft_2\.gears\.gear_2\.hand = \"right\": both wheels"
    ):
        sg.load_train(path)


def test_the_command_prints_what_was_doubted(tmp_path):
    source = tmp_path / "box.rexs"
    source.write_text(edited(("-308.3333333333333", "-290.0")))
    run = command("import", source, "--out", tmp_path / "out")
    assert run.exit_code == 0 and "do not balance" in run.stdout
