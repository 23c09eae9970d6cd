"""Examples in docstrings run, and every noun that the package exports has one."""

import doctest
import functools
import importlib
import inspect
from pathlib import Path

import pytest

import solidgear as sg

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "solidgear"
WITH_EXAMPLES = sorted(p for p in PACKAGE.rglob("*.py") if ">>>" in p.read_text())
#: a second and a half and more; others show what these do, and the tests of their rooms do the same
DEAREST = {
    PACKAGE / name
    for name in (
        "trains/judge/study.py",
        "trains/judge/check.py",
        "teeth/study.py",
        "variants/sweep/file_task.py",
        "variants/optimise/optimise.py",
        "backlash/train.py",
        "backlash/nonlinear.py",
        "parts/body_file.py",
    )
}
#: half a second and more; the tests of their rooms do the same by default
DEAR = {
    PACKAGE / name
    for name in (
        "two_designs/two_trains.py",
        "core/judge/answer.py",
        "measured/identify.py",
        "parts/own_mesh.py",
        "strength/deflection/at_rest.py",
        "strength/stress/study.py",
        "teeth/compliance/solid.py",
        "teeth/over_points.py",
        "teeth/pair_contact.py",
        "trains/assembly/meshes.py",
        "guards/check_study.py",
        "trains/response/receptance.py",
        "trains/response/study.py",
        "variants/sweep/bearing_task.py",
        "comparison/models.py",
        "strength/stress/shaft.py",
        "variants/sweep/command.py",
    )
}
MARKS = dict.fromkeys(DEAR, pytest.mark.long) | dict.fromkeys(DEAREST, pytest.mark.slow)
NOUNS = [name for name in sg.__all__ if callable(getattr(sg, name))]


@functools.cache
def examples_of(module):
    """Docstrings of a module that hold examples."""
    return [case for case in doctest.DocTestFinder().find(module) if case.examples]


def module_of(path):
    """The imported module of a file of the package."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return importlib.import_module(".".join(parts).removesuffix(".__init__"))


@pytest.mark.parametrize(
    "path",
    [pytest.param(p, marks=MARKS.get(p, ())) for p in WITH_EXAMPLES],
    ids=lambda p: "-".join(p.relative_to(PACKAGE).with_suffix("").parts),
)
def test_examples_run(path, monkeypatch):
    monkeypatch.chdir(ROOT)  # scenes are named as a user names them, geometry/...
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    words = []
    for case in examples_of(module_of(path)):
        runner.run(case, out=words.append)
    assert runner.tries > 0
    assert runner.failures == 0, "".join(words)


@pytest.mark.parametrize("name", NOUNS)
def test_a_noun_that_is_exported_has_an_example(name):
    noun = getattr(sg, name)
    assert "\nExamples\n---" in inspect.getdoc(noun)
    module = importlib.import_module(inspect.unwrap(noun).__module__)
    assert f"{module.__name__}.{noun.__qualname__}" in {case.name for case in examples_of(module)}
