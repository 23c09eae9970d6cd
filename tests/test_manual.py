"""The validation manual: every case by every model, the pages on file, and cases that must fail."""

import ast
from dataclasses import replace

import pytest

import solidgear as sg
from solidgear.core.models.beam import element as beam_element
from validation.manual import CASES
from validation.manual import __main__ as command
from validation.manual.case import Answer, CaseError, Model, Reference
from validation.manual.cases import (
    free_beams,
    held_beams,
    pinion,
    printed_bearings,
    printed_countershaft,
    printed_notches,
    printed_shafts,
    spur_train,
    thesis,
)
from validation.manual.page import FOLDER, INDEX, SAME_SIZE, index, lines, read, render
from validation.thesis.krylov import from_scene


def models(without=(), others=()):
    """Every case with every letter; the slow ones are left to the slow tests, and the others are marked."""
    out = []
    for case in CASES.values():
        for letter, model in case.lettered:
            if case.name not in without:
                marks = [pytest.mark.slow] if model.slow else others
                out.append(pytest.param(case, letter, id=f"{case.name}-{letter}", marks=marks))
    return out


every_case = pytest.mark.parametrize("case", CASES.values(), ids=CASES)


def model_of(case, letter):
    return dict(case.lettered)[letter]


def on_file(case):
    return (FOLDER / f"{case.name}.md").read_text()


def judged(name, letter):
    """Lines of one model of a case, solved now."""
    case = CASES[name]
    model = model_of(case, letter)
    return case.lines(model, model.solve().values)


# --------------------------------------------------------------------------- the cases
@pytest.mark.parametrize("case, letter", models())
def test_case(case, letter):
    model = model_of(case, letter)
    answer = model.solve()
    told = read(on_file(case), case)[letter]
    for line in case.lines(model, answer.values):
        name = line.reference.quantity
        assert line.ok, f"{name}: {line.value} instead of {line.reference.value}"
        # the page may differ from a fresh value by the tolerance, and by no more
        gap = abs(told.values[name] - line.value)
        assert gap <= line.tolerance * abs(line.reference.value), name
    assert abs(told.unknowns - answer.unknowns) <= SAME_SIZE * answer.unknowns


@pytest.mark.parametrize("file", sorted(FOLDER.glob("exact*.py")), ids=lambda p: p.stem)
def test_references_share_no_code_with_the_models(file):
    seen = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom):
            seen.add(node.module)
        elif isinstance(node, ast.Import):
            seen |= {alias.name for alias in node.names}
    roots = {name.split(".")[0] for name in seen - {"validation.manual.exact"}}
    assert roots <= {"__future__", "collections", "dataclasses", "numpy", "scipy"}


# --------------------------------------------------------------------------- the pages
@every_case
def test_page_is_what_its_case_renders(case):
    page = on_file(case)
    told = read(page, case)
    assert page == render(case, told)
    assert all(line.ok for _, line in lines(case, told))


def test_index_lists_the_pages():
    told = {name: read(on_file(case), case) for name, case in CASES.items()}
    assert (FOLDER / INDEX).read_text() == index(CASES, told)
    assert {p.stem for p in FOLDER.glob("*.md")} == {*CASES, "README"}


def test_index_counts_numbers_that_are_equal_to_the_printed_digits():
    case = CASES["printed_two_belts"]  # 223 and 127 lbf
    values = {"F_A y": 223.4, "F_D y": 127.6}
    told = {case.name: {"A": Answer(values, 6)}}
    (row,) = (line for line in index({case.name: case}, told).splitlines() if "two_belts" in line)
    assert "| 1 of 2 | F_D y: +0.472 % |" in row and "NOT OK" in row


@pytest.mark.parametrize(
    "old, new",
    [
        ("45.7130551 |", "45.7130552 |"),  # a reference
        ("| 0.25 | OK |", "| 0.35 | OK |"),  # a tolerance
        ("-0.026", "-0.025"),  # a per cent that is not that of its value
        ("247.029646", "247.129646"),  # a value out of tolerance called OK
        ("Blevins", "Nobody"),  # a source
        ("## Modelling B", "## Modelling E"),
    ],
)
def test_a_page_that_tells_something_else_is_noticed(old, new):
    case = CASES["free_euler_beam"]
    assert old in on_file(case)
    page = on_file(case).replace(old, new, 1)
    assert page != render(case, read(page, case))


def test_a_value_that_does_not_exist_is_told():
    case = CASES["free_euler_beam"]
    page = render(case, {"A": Answer({"bending 1": float("nan")}, 7)})
    assert "| bending 1 | 45.7130551 | nan | none | 0.0001 | NOT OK |" in page
    assert "| bending 2 | 126.009797 | none | none | 0.0001 | NOT OK |" in page
    assert page == render(case, read(page, case))
    answers = {name: read(on_file(c), c) for name, c in CASES.items()}
    told = index(CASES, answers | {case.name: read(page, case)})
    assert "| none | NOT OK |" in told


def test_numbers_do_not_depend_on_rounding():
    # two processors differ by about 1e-12 in a frequency
    case = CASES["stepped_shaft_on_springs"]
    told = read(on_file(case), case)
    moved = {
        letter: Answer({q: v * (1 + 1e-12) for q, v in answer.values.items()}, answer.unknowns)
        for letter, answer in told.items()
    }
    assert render(case, moved) == on_file(case)


# --------------------------------------------------------------------------- cases that must fail
#: numbers that no material moves: published or identified stiffness and masses, ratios
NO_MATERIAL = ("thesis_geared_pair", "pinion_seat_ties", "pinion_beam_over_solid")
#: no body at all; tests/test_bearings_rows.py spoils them
NO_MATERIAL += ("ball_bearing_displacement", "angular_contact_218", "roller_row")
#: two shafts, and elements that know no scene; spoilt by a test of its own
NO_MATERIAL += ("spur_train",)
#: of books: statics, charts and ratings; spoilt by tests of their own
NO_MATERIAL += tuple(name for name, case in CASES.items() if case.printed)


def spoilt(monkeypatch, key, factor):
    """Every body and exact beam of a scene from now on has one property of its material scaled."""
    built, spans = sg.build, from_scene

    def other(scene):
        return scene.with_material(**{key: factor * getattr(scene.material, key)})

    def build(scene, *args, **options):
        return built(other(scene), *args, **options)

    monkeypatch.setattr(sg, "build", build)
    for module in (free_beams, held_beams):
        monkeypatch.setattr(module, "from_scene", lambda scene: spans(other(scene)))


@pytest.mark.parametrize("case, letter", models(without=NO_MATERIAL, others=[pytest.mark.long]))
def test_another_material_is_not_ok(case, letter, monkeypatch):
    model = model_of(case, letter)
    # A frequency sees half of a change, and the model may be near the other end of its tolerance:
    # one per cent, or five tolerances where those are wider.
    judged_by = model.tolerances(case.quantities)
    factor = 1 + max(0.01, 5 * max(judged_by.values()))
    frequencies = "Hz" in {r.unit for r in case.references}
    # the thesis gives stiffness, or a mass that is not the scene's
    key = "density" if frequencies and not case.name.startswith("thesis") else "E"
    spoilt(monkeypatch, key, factor)
    shares = [line.share for line in case.lines(model, model.solve().values)]
    assert max(shares) > 1


@pytest.mark.parametrize("letter", ["A", "B"])
def test_two_shafts_of_another_steel_are_not_ok(letter, monkeypatch):
    case, model = spur_train.SPUR, model_of(spur_train.SPUR, letter)
    modulus, *rest = spur_train.EXAMPLE
    monkeypatch.setattr(spur_train, "EXAMPLE", (1.01 * modulus, *rest))
    assert max(line.share for line in case.lines(model, model.solve().values)) > 1


def far(cases):
    """Names of cases with a fast model that is out of its tolerance."""
    fast = [(case.name, letter) for case in cases for letter, m in case.lettered if not m.slow]
    return {name for name, letter in fast if not all(line.ok for line in judged(name, letter))}


def test_printed_shafts_notice_a_bearing_five_millimetres_off(monkeypatch):
    def moved(study):
        def study_of_moved(source, *args, **options):
            scene = source if isinstance(source, sg.Scene) else sg.Scene.from_dict(source)
            first, *rest = scene.bearings
            other = first.with_changes(y=first.y - 5e-3)
            return study(scene.with_changes(bearings=(other, *rest)), *args, **options)

        return study_of_moved

    for name in ("deflect", "stress"):
        monkeypatch.setattr(sg, name, moved(getattr(sg, name)))
    shafts = (*printed_countershaft.CASES, *printed_shafts.CASES)
    assert far(shafts) == {case.name for case in shafts}


#: the factor of a V groove is held with a solid beside it, which takes seconds
BY_A_SOLID = (printed_notches.V_GROOVE,)


@pytest.mark.parametrize(
    "cases",
    [
        pytest.param(BY_A_SOLID, id="solid", marks=pytest.mark.slow),
        pytest.param([c for c in printed_notches.CASES if c not in BY_A_SOLID], id="charts"),
    ],
)
def test_printed_notches_notice_one_per_cent_of_the_load(cases, monkeypatch):
    stress = sg.stress

    def more(scene, *args, **options):
        loads = [
            {key: 1.01 * v if key in ("thx", "torque", "y") else v for key, v in load.items()}
            for load in scene["load"]
        ]
        return stress(scene | {"load": loads}, *args, **options)

    monkeypatch.setattr(sg, "stress", more)
    monkeypatch.setitem(printed_notches.LOAD_1, "moment", 1.01 * printed_notches.LOAD_1["moment"])
    without_load = (printed_notches.BOOK_SHOULDER, printed_notches.HUB_ON_SHAFT)
    assert far(cases) == {case.name for case in cases if case not in without_load}


def test_printed_bearings_notice_another_rating(monkeypatch):
    catalogue = printed_bearings.Catalogue

    def other(**data):
        rating = float(data.pop("load_rating").removesuffix(" kN"))
        return catalogue(load_rating=f"{1.01 * rating} kN", **data)

    monkeypatch.setattr(printed_bearings, "Catalogue", other)
    told = {"printed_ball_bearing_life", "printed_pair_rating"}
    assert far(printed_bearings.CASES) == told


def test_one_per_cent_of_the_shear_coefficient_is_not_ok(monkeypatch):
    right = beam_element.shear_coefficient
    monkeypatch.setattr(beam_element, "shear_coefficient", lambda nu, a, b: 1.01 * right(nu, a, b))
    for name, letter in (
        ("cantilever", "B"),
        ("tapered_cantilever", "B"),
        ("free_timoshenko_beam", "A"),
        ("hinged_beam", "B"),
        ("stepped_shaft_on_springs", "C"),
        ("overhung_disc", "A"),
        ("overhung_pinion", "G"),
    ):
        assert not all(line.ok for line in judged(name, letter)), name


@pytest.mark.slow
def test_ratios_notice_a_tie_and_a_shear_coefficient(monkeypatch):
    right = beam_element.shear_coefficient
    monkeypatch.setattr(beam_element, "shear_coefficient", lambda nu, a, b: 1.01 * right(nu, a, b))
    assert not all(line.ok for line in judged("pinion_beam_over_solid", "B"))
    monkeypatch.setattr(pinion, "attached", lambda scene, _: scene)
    assert not any(line.ok for line in judged("pinion_seat_ties", "A"))


def test_one_per_cent_of_the_rotary_inertia_is_not_ok(monkeypatch):
    section = beam_element.Section.__init__

    def heavier(self, *args):
        section(self, *args)
        self.rotary = 1.01 * self.rotary

    monkeypatch.setattr(beam_element.Section, "__init__", heavier)
    for name, letter in (
        ("rigid_rotor", "B"),
        ("overhung_disc", "A"),
    ):
        assert not all(line.ok for line in judged(name, letter)), name


def test_a_bearing_one_millimetre_off_is_not_ok(monkeypatch):
    built = sg.build

    def moved(scene, *args, **options):
        first, *rest = scene.bearings
        return built(
            scene.with_changes(bearings=(first.with_changes(y=first.y + 1e-3), *rest)),
            *args,
            **options,
        )

    monkeypatch.setattr(sg, "build", moved)
    for name, letter in (
        ("rigid_rotor", "C"),
        ("stepped_shaft_on_springs", "A"),
        ("overhung_disc", "A"),
        ("thesis_stiffness", "A"),
    ):
        assert not all(line.ok for line in judged(name, letter)), name


def test_a_mesh_spring_a_quarter_off_is_not_ok(monkeypatch):
    stiffness = thesis.SPRINGS["mesh stiffness"]
    monkeypatch.setitem(thesis.SPRINGS, "mesh stiffness", 1.25 * stiffness)
    assert not all(line.ok for line in judged("thesis_geared_pair", "A"))


@every_case
def test_another_reference_is_not_ok(case):
    # each number on file lies nowhere near another reference: three tolerances away it is red
    told = read(on_file(case), case)
    for letter, line in lines(case, told):
        for sign in (-1, 1):
            value = line.reference.value * (1 + sign * 3 * line.tolerance)
            assert not replace(line, reference=replace(line.reference, value=value)).ok, letter


# --------------------------------------------------------------------------- the command
def a_case(values, tolerance=1e-3):
    """The slender beam with one model that gives what it is told to."""
    case = CASES["free_euler_beam"]
    model = Model("made up", lambda: Answer(values, 1), tolerance, "a thousandth")
    return replace(case, models=(model,))


@pytest.mark.parametrize("factor, code", [(1.0, 0), (1.0005, 0), (1.002, 1), (None, 1)])
def test_command_ends_with_one_if_a_number_is_not_ok(factor, code, monkeypatch, tmp_path, capsys):
    case = CASES["free_euler_beam"]
    values = {r.quantity: r.value * (factor or 1) for r in case.references}
    if factor is None:
        del values["bending 2"]
    monkeypatch.setattr(command, "CASES", {case.name: a_case(values)})
    assert command.main(["--case", case.name], tmp_path) == code
    assert ("NOT OK" in (tmp_path / f"{case.name}.md").read_text()) == bool(code)
    assert ("| NOT OK |" in (tmp_path / INDEX).read_text()) == bool(code)
    assert ("NOT OK" in capsys.readouterr().out) == bool(code)


def test_command_goes_on_after_a_model_that_cannot_be_solved(monkeypatch, tmp_path, capsys):
    def fails():
        raise sg.SolidgearError("the shaft is made of cheese")

    case = replace(a_case({}), models=(Model("made up", fails, 1e-3, "a thousandth"),))
    monkeypatch.setattr(command, "CASES", {case.name: case})
    assert command.main([], tmp_path) == 1
    assert "made of cheese" in capsys.readouterr().out


def test_command_writes_the_page_on_file(tmp_path):
    name = "tapered_cantilever"
    command.write(tmp_path, [name])
    assert (tmp_path / f"{name}.md").read_text() == on_file(CASES[name])


def test_words_are_written_anew_without_solving(monkeypatch, tmp_path):
    monkeypatch.setattr(command, "solved", None)
    page = tmp_path / "cantilever.md"
    page.write_text(on_file(CASES["cantilever"]).replace("## Problem", "## Puzzle"))
    assert command.main(["--case", "cantilever", "--words"], tmp_path) == 0
    assert page.read_text() == on_file(CASES["cantilever"])


# --------------------------------------------------------------------------- refusals
GOOD = Reference("f", 10.0, "Hz", "closed_form", "a book, equation 1", 1e-6, "digits")


@pytest.mark.parametrize(
    "change, words",
    [
        ({"source": " "}, "source"),
        ({"unit": ""}, "unit"),
        ({"limits": ""}, "limits"),
        ({"kind": "guess"}, "closed_form, literature"),
        ({"value": 0.0}, "not zero"),
        ({"value": float("nan")}, "finite"),
        ({"uncertainty": -1e-3}, "uncertainty"),
        ({"uncertainty": 0.5}, "uncertainty"),
    ],
)
def test_reference_that_says_nothing_is_refused(change, words):
    with pytest.raises(CaseError, match=words):
        replace(GOOD, **change)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"why": ""}, "why"),
        ({"name": ""}, "name"),
        ({"tolerance": 0.2}, "tolerance 0.2"),
        ({"tolerance": 1e-10}, "tolerance 1e-10"),
        ({"tolerance": {}}, "judged by nothing"),
        ({"tolerance": {"bending 7": 1e-3}}, "bending 7"),
        ({"known": {"bending 7": 1e-3}}, "bending 7"),
    ],
)
def test_model_that_would_accept_anything_is_refused(change, words):
    case = CASES["free_euler_beam"]
    model = replace(case.models[0], **change)
    with pytest.raises(CaseError, match=words):
        replace(case, models=(model,))


@pytest.mark.parametrize(
    "change, words",
    [
        ({"problem": ""}, "problem"),
        ({"references": ()}, "quantities"),
        ({"references": (GOOD, GOOD)}, "quantities"),
        ({"models": ()}, "0 models"),
    ],
)
def test_case_that_says_nothing_is_refused(change, words):
    with pytest.raises(CaseError, match=words):
        replace(CASES["free_euler_beam"], **change)


def test_tolerance_below_the_uncertainty_of_the_reference_is_refused():
    case = CASES["free_euler_beam"]
    rough = tuple(replace(r, uncertainty=1e-2) for r in case.references)
    with pytest.raises(CaseError, match="below the uncertainty"):
        replace(case, references=rough)
