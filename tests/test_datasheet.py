"""The data sheet of one page: statics by hand, two languages, drawing, files."""

import html
import math
import re
from dataclasses import replace
from pathlib import Path
from string import Formatter

import pytest
from command import command
from made_up_sheet import made_up_shaft, made_up_sheet

import solidgear as sg
from solidgear.datasheet import command as command_module
from solidgear.datasheet import page
from solidgear.datasheet.at_rest import cautions_of_notch, motions
from solidgear.datasheet.browser import PROGRAMS, browser, pages_of
from solidgear.datasheet.drawing import WIDE, shaft_svg
from solidgear.datasheet.facts import (
    DrawnShaft,
    Force,
    Frequency,
    MotionFact,
    Remark,
    Trust,
    UnratedCorner,
)
from solidgear.datasheet.language import Language
from solidgear.datasheet.messages import LANGUAGES, MESSAGES
from solidgear.datasheet.sections import sections, tiles
from solidgear.datasheet.shaft import resonances
from solidgear.datasheet.train import MODES, train_sheet
from solidgear.show.sketch import SEAT, SPAN
from solidgear.show.units import ENGINEERING
from solidgear.strength.deflection.at_rest import deflect
from solidgear.strength.stress.at_rest import StressSettings
from solidgear.trains.assembly.assembly import Assembly

GEARBOX = Path(__file__).parent.parent / "geometry" / "gearbox_train.toml"
PACKAGE = Path(__file__).parent.parent / "solidgear" / "datasheet"
E, DIAMETER, LENGTH, PLACE = 206e9, 0.03, 0.5, 0.2
FORCE, TORQUE = (300.0, 400.0), 40.0
#: slender on stiff short bearings
ROD = {
    "material": {"E": E, "nu": 0.3, "density": 7850},
    "segment": [{"kind": "cylinder", "name": "rod", "length": 0.52, "diameter": DIAMETER}],
    "bearing": [
        {"name": name, "position": y, "seat_width": 0.004, "stiffness": stiffness}
        for name, y, stiffness in (
            ("A", 0.01, {"kxx": 1e11, "kyy": 1e11, "kzz": 1e11}),
            ("B", 0.51, {"kxx": 1e11, "kzz": 1e11}),
        )
    ],
    "port": {"name": "wheel", "position": 0.01 + PLACE, "span": [0.205, 0.215]},
    "load": [{"name": "gear", "on": "wheel", "x": FORCE[0], "z": FORCE[1], "torque": TORQUE}],
    "torque_at": "B",
    "attachment": "section",
}


@pytest.fixture(scope="module")
def rod():
    return sg.sheet(ROD, speed="3000 rpm")


def test_reactions_are_those_of_a_simple_beam(rod):
    (drawn,) = rod.drawn
    by_name = {force.name: force for force in drawn.forces if force.by_bearing}
    loads = {force.name: force.six for force in drawn.forces if not force.by_bearing}
    assert [force.y for force in drawn.forces] == pytest.approx([0.01, 0.21, 0.51, 0.51])
    assert loads["gear"] == (*FORCE[:1], 0.0, *FORCE[1:], 0.0, TORQUE, 0.0)
    assert loads["B"] == pytest.approx([0, 0, 0, 0, -TORQUE, 0])
    at_a, at_b = (LENGTH - PLACE) / LENGTH, PLACE / LENGTH
    for name, share in (("A", at_a), ("B", at_b)):
        # 4 mm of seat hold a slope with next to no moment
        assert by_name[name].six[0] == pytest.approx(-share * FORCE[0], rel=2e-3)
        assert by_name[name].six[2] == pytest.approx(-share * FORCE[1], rel=2e-3)
    assert [b.radial for b in rod.bearings] == pytest.approx([at_a * 500, at_b * 500], rel=2e-3)


def test_deflection_and_stress_are_those_of_a_simple_beam(rod):
    force, inertia = math.hypot(*FORCE), math.pi * DIAMETER**4 / 64
    left, right = PLACE, LENGTH - PLACE
    bent = force * left**2 * right**2 / (3 * E * inertia * LENGTH)
    (motion,) = rod.motions
    # shear adds about 1 % at this slenderness
    assert bent < motion.radial < 1.03 * bent
    assert motion.radial_bar < 0.05 * motion.radial
    stress = force * left * right / LENGTH * 32 / (math.pi * DIAMETER**3)
    assert rod.section.bending == pytest.approx(stress, rel=3e-3)
    torsion = TORQUE * 16 / (math.pi * DIAMETER**3)
    assert abs(rod.section.torsion) == pytest.approx(torsion, rel=1e-6)
    von_mises = math.sqrt(stress**2 + 3 * torsion**2)
    assert rod.section.equivalent == pytest.approx(von_mises, rel=3e-3)
    assert rod.notch is None and "notch" in rod.absent


def test_a_resonance_is_where_the_shaft_turns_as_fast_as_it_vibrates(rod):
    by_order = {(r.mode, r.order): r for r in rod.resonances}
    first = next(f for f in rod.frequencies if f.mode == "bending 1")
    assert by_order["bending 1", 1].speed == pytest.approx(2 * math.pi * first.hz)
    assert by_order["bending 1", 2].speed == pytest.approx(math.pi * first.hz)
    assert rod.speed == pytest.approx(100 * math.pi)
    # pinned ends, Euler: pi/2 sqrt(E I / (m L^4)); overhangs and shear change little
    mass = 7850 * math.pi * DIAMETER**2 / 4
    euler = math.pi / 2 * math.sqrt(E * math.pi * DIAMETER**4 / 64 / mass / LENGTH**4)
    assert first.hz == pytest.approx(euler, rel=0.03)


def test_open_data_widen_the_range_to_avoid():
    (one, two) = resonances((Frequency("bending 1", 50.0, 0.01, (-0.1, 0.2)),), 300.0)
    assert (one.order, two.order) == (1, 2)
    assert one.low == pytest.approx(100 * math.pi * 0.9 * 0.99)
    assert one.high == pytest.approx(100 * math.pi * 1.2 * 1.01)
    assert one.distance == pytest.approx(300 / (100 * math.pi) - 1)


def test_numbers_of_an_unloaded_shaft_stand_alone():
    shaft = {key: value for key, value in ROD.items() if key not in ("load", "torque_at")}
    facts = sg.sheet(shaft, tol=0.05)
    assert {key: remark.key for key, remark in facts.absent.items()} == {
        "worst": "absent load",
        "motions": "absent load",
        "speeds": "absent speed",
    }
    assert facts.figures and facts.trust.reached and not facts.motions
    said = str(facts)
    assert said.count("Not computed: the file has no load.") == 2
    assert "Deflection: Not computed" in said and "Speeds to avoid: Not computed" in said


# ------------------------------------------------------------------------------ languages


def text_of(page_):
    """Text that a reader of a page sees."""
    page_ = re.sub(r"(?s)<style>.*?</style>|<!--.*?-->|<script.*?</script>", " ", page_)
    page_ = " ".join([*re.findall(r'aria-label="([^"]*)"', page_), re.sub(r"<[^>]*>", " ", page_)])
    return " ".join(html.unescape(page_).split())


def words(text):
    return set(re.findall(r"[A-Za-zÄÖÜäöüß]{3,}", text))


def test_every_message_has_the_same_places_in_every_language():
    for key, texts in MESSAGES.items():
        assert len(texts) == len(LANGUAGES), key
        names = [{name for _, name, *_ in Formatter().parse(text) if name} for text in texts]
        assert all(each == names[0] for each in names), key
        assert all(texts), key


#: equal in both languages
EQUAL = {"radial", "axial", "hours", "static"}


def test_no_message_is_left_in_english():
    same = {key for key, texts in MESSAGES.items() if texts[0] == texts[1]}
    assert same == EQUAL


#: beginnings of keys that are put together
MADE_KEYS = (
    *("assumed", "caution", "note", "tile", "trust", "model", "quantity", "measure", "family"),
    *("under", "absent", "section"),
)


def test_every_message_is_written_somewhere():
    sources = "".join(
        path.read_text(encoding="utf-8")
        for path in PACKAGE.iterdir()
        if path.suffix in (".py", ".html") and path.name != "messages.py"
    )
    unused = [k for k in MESSAGES if f'"{k}"' not in sources and f"'{k}'" not in sources]
    assert [key for key in unused if key.split()[0] not in MADE_KEYS] == []


def german_sheets():
    """Sheets that have all of their messages between them."""
    sheet = made_up_sheet(language="de")
    yield sheet
    absent = {
        "worst": Remark("absent load"),
        "motions": Remark("absent operation"),
        "notch": Remark("absent strength", {"names": ("L1",)}),
        "speeds": Remark("absent speed"),
    }
    bare = {"notch": None, "section": None, "motions": (), "speed": None, "figures": ()}
    yield made_up_sheet(language="de", **bare, absent=absent, bearings=(), elsewhere=0)
    far = made_up_sheet().resonances[:1]
    yield made_up_sheet(
        language="de",
        resonances=tuple(type(r)(**vars(r) | {"distance": -0.9}) for r in far),
        notch=replace(made_up_sheet().notch, bar=None),
        trust=Trust("solid", 0.05, False, None, None, demand="within misalignment"),
        drawn=tuple(made_up_shaft() for _ in range(6)),
        train=True,
    )


@pytest.mark.parametrize("sheet", list(german_sheets()), ids=("whole", "bare", "train"))
def test_a_german_sheet_has_no_english_word_of_the_table(sheet):
    german = set().union(*(words(text) for _, text in MESSAGES.values()))
    english = set().union(*(words(text) for text, _ in MESSAGES.values())) - german
    assert {"bearing", "trust", "safety"} <= {word.lower() for word in english}
    page_ = text_of(sheet.to_html())
    assert words(page_) & english == set()
    assert words(str(sheet)) & english == set()
    numbers = page_.replace(f"solidgear {sheet.version}", "").replace("27.11.2026", "")
    assert re.findall(r"\d\.\d", numbers) == []
    assert 'lang="de"' in sheet.to_html()


def numbers_of(sheet):
    """Numbers of a page in the order of reading, without decimal marks."""
    page_ = text_of(sheet.to_html()).replace("\u00a0", "")
    for day in ("2026-11-27", "27.11.2026"):
        page_ = page_.replace(day, "")
    return sorted(re.sub(r"[.,]", "", number) for number in re.findall(r"\d[\d.,]*", page_))


def test_both_languages_have_the_same_numbers():
    english, german = (made_up_sheet(language=code) for code in LANGUAGES)
    assert numbers_of(english) == numbers_of(german)
    assert re.findall(r"\d,\d", text_of(english.to_html())) == []


@pytest.mark.parametrize(
    ("name", "german"),
    [
        ("bending 1", "Biegung 1"),
        ("Rad bending x 2", "Rad Biegung x 2"),
        ("pinion axial + gear torsion 3", "pinion Längsschwingung + gear Torsion 3"),
        ("gear ovalising n=2 1", "gear Ovalisierung n=2 1"),
        ("train rotation", "freie Drehung"),
        ("something else", "something else"),
    ],
)
def test_names_of_modes_in_german(name, german):
    assert Language("de", ENGINEERING).mode(name) == german
    assert Language("en", ENGINEERING).mode(name) == name


# ------------------------------------------------------------------------------ drawing


def heads(svg, colour):
    """Tips and feet of arrow heads of a colour, px."""
    found = re.findall(rf'<path d="M([\d.,\-L]+)Z" fill="{colour}"/>', svg)
    corners = [[tuple(map(float, p.split(","))) for p in text.split("L")] for text in found]
    return [points for points in corners if len(points) == 3]


def drawn(shaft):
    return shaft_svg("x-", "wide", shaft, Language("en", ENGINEERING), WIDE, (0.105, 0.021))


def test_arrows_point_where_forces_act():
    svg = drawn(made_up_shaft())
    points = heads(svg, SPAN)
    down = [p for p in points if p[0][1] > p[1][1] + 1 and p[0][1] > p[2][1] + 1]
    left = [p for p in points if p[0][0] < p[1][0] - 1 and p[0][0] < p[2][0] - 1]
    assert (len(points), len(down), len(left)) == (2, 1, 1)  # z -900 N and y -350 N
    reactions = heads(svg, SEAT)
    up = [p for p in reactions if p[0][1] < p[1][1] - 1 and p[0][1] < p[2][1] - 1]
    right = [p for p in reactions if p[0][0] > p[1][0] + 1 and p[0][0] > p[2][0] + 1]
    assert (len(up), len(right)) == (2, 1)
    assert "Fz −900 N" in svg and "T 25.0 N m" in svg and "Fx −800 N" in svg


def test_a_shaft_that_turns_about_plus_y_moves_down_on_the_side_of_the_reader():
    axis = {}
    for sense in ("+y", "-y"):
        tips = [points[0] for points in heads(drawn(made_up_shaft(sense)), "#222222")]
        axis[sense] = max(tips)[1]  # the last arrow along the shaft
    assert axis["+y"] > axis["-y"] + 10
    assert len(heads(drawn(made_up_shaft("")), "#222222")) < len(
        heads(drawn(made_up_shaft("+y")), "#222222")
    )


def test_every_diameter_and_place_is_written():
    svg = drawn(made_up_shaft())
    for text in ("⌀30", "⌀42", "⌀36", "bore 9", "40", "60", "105", "15", "95"):
        assert f">{text}<" in svg, text


def test_a_name_that_is_markup_is_written_as_text():
    shaft = made_up_shaft()
    forces = (Force("<b>&", 0.075, (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), False),)
    page_ = made_up_sheet(
        title="<script>x</script>", drawn=(DrawnShaft("<i>", shaft.scene, forces),)
    ).to_html()
    assert "<b>&" not in page_ and "<script>x" not in page_


# ------------------------------------------------------------------------------ files


@pytest.fixture
def solved(monkeypatch):
    """The command without a solution."""
    monkeypatch.setattr(
        command_module, "solved", lambda *_, language, **__: made_up_sheet(language=language)
    )


def test_the_command_writes_a_page_or_prints_json(solved, tmp_path):
    out = tmp_path / "new" / "sheet.html"
    result = command("sheet", "welle7.toml", "--out", out, "--language", "de")
    assert result.exit_code == 0 and f"Written: {out}" in result.stdout.replace("\n", "")
    assert "Eigenfrequenzen" in out.read_text(encoding="utf-8")
    assert command("sheet", "welle7.toml", "--json").exit_code == 0  # held to its schema
    assert made_up_sheet().write(tmp_path / "folder") == [tmp_path / "folder" / "sheet.html"]


def test_other_endings_and_languages_are_refused_before_anything_is_solved(solved, tmp_path):
    result = command("sheet", "welle7.toml", "--out", tmp_path / "sheet.docx")
    assert "--out" in str(result.exception) and ".html or .pdf" in str(result.exception)
    assert command("sheet", "welle7.toml", "--language", "fr").exit_code == 2
    with pytest.raises(sg.SolidgearError, match='`language` "fr": there are en and de'):
        sg.sheet(ROD, language="fr")
    assert [*tmp_path.iterdir()] == []


def test_without_a_browser_there_is_a_page_and_a_sentence(solved, tmp_path, monkeypatch):
    monkeypatch.setattr(page, "browser", lambda: None)
    result = command("sheet", "welle7.toml", "--out", tmp_path / "sheet.pdf")
    assert result.exit_code == 0
    assert "caution: no PDF" in result.stdout and "named by BROWSER" in result.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["sheet.html"]


def test_a_browser_is_looked_for_by_variable_and_path(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("BROWSER", "")
    monkeypatch.setattr("solidgear.datasheet.browser.INSTALLED", {})
    assert browser() is None
    for name in ("chromium", "firefox", "msedge"):
        (tmp_path / name).write_text("#!/bin/sh\n")
        (tmp_path / name).chmod(0o755)
    assert Path(browser()).name == "chromium"
    monkeypatch.setenv("BROWSER", "msedge")
    assert Path(browser()).name == "msedge"
    monkeypatch.setenv("BROWSER", "firefox")  # prints by other options
    assert Path(browser()).name == "chromium"
    assert "firefox" not in PROGRAMS


def test_a_browser_that_prints_nothing_is_named(tmp_path, monkeypatch):
    program = tmp_path / "chromium"
    program.write_text("#!/bin/sh\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr(page, "browser", lambda: str(program))
    with pytest.raises(sg.SolidgearError, match="did not print the page; write .html"):
        made_up_sheet().save(tmp_path / "sheet.pdf")
    assert not (tmp_path / "sheet.pdf").exists()


def test_a_page_is_printed_smaller_until_it_is_one_sheet(tmp_path, monkeypatch):
    zooms = []

    def printed(program, text, name):
        zooms.append(re.search(r"zoom: ([\d.]+)", text)[1])
        return b"/Type /Page\n" * (2 if len(zooms) < 3 else 1) + b"/Type /Pages\n"

    monkeypatch.setattr(page, "browser", lambda: "chromium")
    monkeypatch.setattr(page, "print_pdf", printed)
    made_up_sheet().save(tmp_path / "sheet.pdf")
    assert zooms == ["1.0", "0.93", "0.86"]
    assert pages_of((tmp_path / "sheet.pdf").read_bytes()) == 1


# ---------------------------------------------------------------------------- what a page must say
def test_a_page_names_corners_without_a_rating_the_least_of_every_kind_and_the_whole_motion():
    """24 um across and 49 um along are 54.7 um; two of five numbers would read better than all."""
    page = made_up_sheet(corners=(UnratedCorner("Welle", 0.045),))
    for code, corner, weak in (
        ("en", "not rated: corner at 45 mm", "Against yielding R1 at y = 12 mm has less: 1.12."),
        (
            "de",
            "ohne Nachweis: Kante bei 45 mm",
            "Gegen Fließen hat R1 bei y = 12 mm weniger: 1,12.",
        ),
    ):
        words = Language(code, ENGINEERING)
        shown = {tile.label: tile for tile in tiles(page, words)}
        assert corner in shown[words.say("tile fatigue")].place
        assert shown[words.say("tile motion")].value.startswith(words.local("54.7"))
        worst = next(s for s in sections(page, words) if s.key == "worst")
        assert weak in worst.sentences and any("45 mm" in text for text in worst.sentences)
    below = [remark.values["place"] for remark in cautions_of_notch(page.notch)]
    assert below == ["R2", "R2", "R1", "R3"]


@pytest.mark.slow
def test_the_german_page_of_a_shaft_names_its_sharp_corner():
    found = sg.sheet(Path(__file__).parent / "found" / "design" / "sharp_corner.toml")
    words = Language("de", ENGINEERING)
    assert [corner.y for corner in found.corners] == pytest.approx([0.1])
    assert "Kante bei 100 mm" in next(tiles(found, words)).place


def test_frequencies_of_a_train_are_those_of_its_list_of_modes():
    """To all digits: the modes that a page leaves out decide the meshes as well."""
    train = sg.load_train(GEARBOX)
    page_, listed = train_sheet(train, None, train.point, StressSettings(), print), {}
    for mode in sg.system_modes(train):
        listed[mode.name] = mode.frequency_hz
    assert len(page_.frequencies) == MODES < len(listed)
    assert {f.mode: f.hz for f in page_.frequencies}.items() <= listed.items()


def test_a_motion_inside_its_bar_is_zero_with_the_bar_in_its_unit():
    """What symmetry forbids is left by the mesh: no share of it says anything."""
    words = Language("en", ENGINEERING)
    assert words.measured(2e-6, "m moved", 0.1) == ("2.000 µm", "± 10.0 %")
    zero, bar = words.measured(-2e-12, "m moved", 3.0)
    assert (float(zero.split()[0]), float(bar.split()[1])) == pytest.approx((0.0, 8e-6))
    motion = MotionFact("gear", 1e-12, 2e-9, 1e-4, 1e-6)
    page_ = made_up_sheet(motions=(motion,)).to_html()
    assert "&gt; 100 %" not in page_ and "± 0.002" in page_


def test_a_motion_that_is_rounding_is_zero():
    """Along y nothing loads the shaft; 1e-9 um with an error bar of a per cent would be a number."""
    scene = sg.load("geometry/shaft_stepped.toml").with_changes(load={"z": 1e3})
    motion, *_ = motions(deflect(Assembly.of(scene), models=["timoshenko"]))
    assert motion.axial == 0.0 < motion.radial


def test_a_train_whose_shafts_have_no_error_bars_in_modes_says_so():
    cut = Trust("corrected", 0.02, True, None, None)
    shown = made_up_sheet(train=True, trust=cut, frequencies=(Frequency("bending 1", 500.0, None),))
    assert "What the meshes leave is not known" in shown.to_html()
    assert "What the meshes leave" not in made_up_sheet().to_html()
