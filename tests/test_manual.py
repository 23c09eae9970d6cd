"""The validation manual: every case by every model, the pages on file, and cases that must fail."""

import ast
from dataclasses import replace
from pathlib import Path

import pytest

import solidgear as sg
from validation.manual import CASES, exact
from validation.manual import __main__ as command
from validation.manual.case import Answer, Case, CaseError, Model, Reference
from validation.manual.page import FOLDER, INDEX, SAME_SIZE, index, lines, read, render

MODELS = [
    pytest.param(
        case, letter, id=f"{case.name}-{letter}", marks=[pytest.mark.slow] if model.slow else []
    )
    for case in CASES.values()
    for letter, model in case.lettered
]
every_model = pytest.mark.parametrize("case, letter", MODELS)
every_case = pytest.mark.parametrize("case", CASES.values(), ids=CASES)


def model_of(case, letter):
    return dict(case.lettered)[letter]


def on_file(case):
    return (FOLDER / f"{case.name}.md").read_text()


# --------------------------------------------------------------------------- the cases
@every_model
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
